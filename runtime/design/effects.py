"""What damping and a length do to the stresses over the speed; a quick screen of them (9.2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..beams.element_forms import required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import is_finite, numbers
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..frequencies import natural_frequencies
from ..linkages import FourBar, transmission_angle
from ..recovery.stress_over_speed import ELSEWHERE, StressCurve, stress_curve
from ..recovery.stresses import stress_operator
from .speed_profile import Array

_LENGTHS = ("frame", "crank", "coupler", "follower")


@dataclass(frozen=True, kw_only=True)
class StressEffect(Result):
    """Largest stresses over the speed for several values of one quantity.

    Attributes
    ----------
    name : str
        The quantity: ``damping_ratio``, or a length such as ``frame``.
    values : ndarray, shape (nv,)
        Its values.
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s].
    links : tuple of str
        Links.
    maximum, error : ndarray, shape (nv, ns, links)
        Largest stress [Pa], and the error of each, relative.
    transmission : ndarray or None
        Of a four-bar whose length changes: least and greatest transmission angle [rad],
        ``(nv, 2)``.
    """

    name: str
    values: Array
    speed: Array
    links: tuple[str, ...]
    maximum: Array
    transmission: Array | None = None

    dimensions: ClassVar[dict[str, tuple[str, ...]]] = {
        "values": ("value",),
        "speed": ("speed",),
        **dict.fromkeys(("maximum", "error", "change"), ("value", "speed", "link")),
        "transmission": ("value", "end"),
    }
    exported: ClassVar[tuple[str, ...]] = ("change",)
    column_units: ClassVar = {"Pa": "maximum", "rad": "transmission"}

    @property
    def change(self) -> Array:
        """Largest stress over that of the first value, ``(nv, ns, links)``: below 1 it helps."""
        return np.asarray(self.maximum / self.maximum[:1])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of all links over the speed, a line for each value."""
        ax = axes_or_new(ax)
        for value, rows in zip(self.values, self.maximum, strict=True):
            ax.semilogy(self.speed, np.max(rows, axis=1) / 1e6, label=f"{value:g}", linewidth=0.9)
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest stress [MPa]")
        ax.legend(title=self.name.replace("_", " "))
        return ax


def damping_effect(
    system: LinearPeriodic, speeds: ArrayLike, ratios: Sequence[float], *, rtol: float = 1e-3
) -> StressEffect:
    """Return the largest stresses for several ratios of modal damping (Aannaque 7.4.2).

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams with modal damping.
    speeds : array_like, shape (ns,)
        Crank speeds [rad/s].
    ratios : sequence of float
        Damping ratios, positive.
    rtol : float
        Wanted relative error of the stresses.

    Returns
    -------
    StressEffect

    Raises
    ------
    BadInput
        If an argument is unusable, or the system has no modal damping.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.design.damping_effect(system, [30.7], ratios=[0.06])
    >>> print(found.links, (found.maximum[0, 0] / 1e6).round())
    ('crank', 'coupler', 'follower') [158.  28. 160.]
    """
    required_structure(system)
    if "damping_ratio" not in system.parameters:
        fix = "add it with with_modal_damping"
        raise bad("damping_effect", "a system without modal damping", "damping_ratio", fix)
    return effect_of(system, "damping_ratio", positive_row("ratios", ratios), speeds, rtol)


def length_effect(
    system: LinearPeriodic,
    name: str,
    values: Sequence[float],
    speeds: ArrayLike,
    *,
    rtol: float = 1e-3,
) -> StressEffect:
    """Return the largest stresses for several values of a length (Aannaque 7.3, 7.5, 8.5).

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams.
    name : str
        A length of its geometry: ``frame`` is the distance of the ground pivots, L4.
    values : sequence of float
        [m].
    speeds, rtol
        As :func:`damping_effect`.

    Returns
    -------
    StressEffect

    Raises
    ------
    BadInput
        If the system has no such length, or with a value the crank cannot turn.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.design.length_effect(system, "coupler", [0.35], speeds=[20.0])
    >>> print(found.links, (found.maximum[0, 0] / 1e6).round())
    ('crank', 'coupler', 'follower') [52. 12. 38.]
    """
    required_structure(system)
    return effect_of(system, name, positive_row("values", values), speeds, rtol)


def positive_row(where: str, values: ArrayLike, what: str = "numbers") -> Array:
    """Return positive numbers in a row; refuse anything else."""
    array = np.atleast_1d(numbers(where, values))
    if array.ndim != 1 or not array.size or not np.all(np.isfinite(array) & (array > 0)):
        raise bad(where, str(values), f"positive {what}", "correct them")
    return array


def effect_of(
    system: LinearPeriodic,
    name: str,
    values: Array,
    speeds: ArrayLike | StressCurve,
    rtol: float,
    *,
    enough: Callable[[StressCurve], bool] = lambda curve: False,
    tick: Callable[[int], None] | None = None,
) -> StressEffect:
    """Return the curves for values of a damping ratio or length, up to the first that is enough.

    The curve of the first value may be known: it then stands for the speeds.  The whole equation is
    solved for that value alone: :data:`.ELSEWHERE` times what it changed there is part of the
    errors of the others.
    """
    change = system.with_parameters if name == "damping_ratio" else system.with_geometry
    systems = [change(**{name: float(value)}) for value in values]
    if isinstance(speeds, StressCurve):
        first = speeds
    else:
        first = stress_curve(systems[0], speeds, rtol=rtol, stability=False)
    curves: list[StressCurve] = []
    for made in systems:
        curve = first
        if curves:
            curve = stress_curve(made, first.speed, rtol=rtol, stability=False, whole=False)
        curves.append(curve)
        if tick is not None:
            tick(len(curves))
        if enough(curve):
            break
    equation = first.checks["equation"]
    errors = np.array([curve.error for curve in curves])
    errors[1:] += ELSEWHERE * equation.value
    return StressEffect(
        method=first.method,
        error=errors,
        error_norm="each largest stress, relative",
        checks={"converged": Check(float(np.max(errors)) / rtol, 1.0), "equation": equation},
        provenance=dict(first.provenance),
        name=name,
        values=values[: len(curves)],
        speed=first.speed,
        links=first.links,
        maximum=np.array([curve.maximum for curve in curves]),
        transmission=_transmission(system, name, values[: len(curves)]),
    )


def _transmission(system: LinearPeriodic, name: str, values: Array) -> Array | None:
    if name not in system.geometry or not set(_LENGTHS) <= set(system.geometry):
        return None
    angles = []
    for value in values:
        lengths = {key: system.geometry[key] for key in _LENGTHS} | {name: float(value)}
        frame, crank, coupler, follower = (lengths[key] for key in _LENGTHS)
        angle = transmission_angle(FourBar(frame, crank, coupler, follower))
        angles.append([angle.least, angle.greatest])
    return np.array(angles)


_ANGLES = 256


@dataclass(frozen=True, kw_only=True)
class Screening(Result):
    """Estimated largest stresses over the crank speed.

    ``error`` is NaN: a screen knows no bound of what it leaves out; compare it with the maxima of
    :func:`elastolink.stress_curve`.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s].
    links : tuple of str
        Links.
    maximum : ndarray, shape (ns, links)
        Estimated largest stress [Pa].
    quasi_static : ndarray, shape (ns, links)
        Largest quasi-static stress [Pa].
    mean_frequency : float
        Mean of the lowest natural frequency over the cycle [rad/s].
    """

    speed: Array
    links: tuple[str, ...]
    maximum: Array
    quasi_static: Array
    mean_frequency: float

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "speed": ("speed",),
        **dict.fromkeys(("maximum", "quasi_static"), ("speed", "link")),
    }
    column_units: ClassVar = {"Pa": "maximum"}


def screen(system: LinearPeriodic, speeds: ArrayLike, *, damping: float) -> Screening:
    """Return estimated largest stresses over crank speeds, without solving equations.

    The quasi-static stress is a function of the crank angle times the squared speed, found once,
    and another of the constant loads.  Its n-th harmonic is taken to be carried by the lowest mode
    alone, as a single mass of the mean natural frequency W: it grows by ``1 / (1 - (n w/W)^2 + 2 i
    z n w/W)``, z the damping ratio.  Resonances at W/n are in it, infinite without damping;
    parametric terms and the other modes are not.

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams.
    speeds : array_like, shape (ns,)
        Crank speeds [rad/s].
    damping : float
        z.

    Returns
    -------
    Screening

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.design.screen(system, [10.0, 20.0], damping=0.02)
    >>> print((found.maximum / 1e6).round().tolist())
    [[12.0, 2.0, 7.0], [60.0, 8.0, 28.0]]
    """
    given = positive_row("speeds", speeds, "crank speeds")
    if not (is_finite(damping) and damping >= 0):
        raise bad("damping", repr(damping), "a ratio, 0 or more", "correct it")
    structure = required_structure(system)
    mean = float(natural_frequencies(system, count=1).mean[0])
    theta = system.period * np.arange(_ANGLES) / _ANGLES
    form, stations = stress_operator(system, theta, 7, method="shape")
    stiffness = system.array("K", theta)
    unit, constant = (
        form.values(1.0, still, np.zeros_like(still))
        for still in (
            np.asarray(np.linalg.solve(stiffness, system.array(name, theta)[..., None])[..., 0])
            for name in ("f", "p")
        )
    )
    spectra = np.fft.rfft(unit, axis=0), np.fft.rfft(constant, axis=0)
    links = tuple(beam.name for beam in structure.beams)
    named = np.array([station.beam for station in stations] * 2)
    n = np.arange(len(spectra[0]))
    maximum, static = np.empty((2, len(given), len(links)))
    for i, speed in enumerate(given):
        ratio = n * speed / mean
        below = 1.0 - ratio**2 + 2j * damping * ratio
        still = speed**2 * unit + constant
        static[i] = [np.max(np.abs(still[:, named == link])) for link in links]
        if not np.all(below):
            maximum[i] = np.inf
            continue
        series = (speed**2 * spectra[0] + spectra[1]) / below[:, None]
        history = np.fft.irfft(series, n=_ANGLES, axis=0)
        maximum[i] = [np.max(np.abs(history[:, named == link])) for link in links]
    return Screening(
        method="quasi-static stress times the factor of one mode, by harmonics",
        error=np.nan,
        error_norm="none",
        provenance=provenance(dict(system.provenance)),
        speed=given,
        links=links,
        maximum=maximum,
        quasi_static=static,
        mean_frequency=mean,
    )
