"""What damping and a length do to the stresses: curves over the speed for several values."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..beams.element_forms import required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import numbers
from ..core.results import Check, Result
from ..linkages import FourBar, transmission_angle
from ..recovery.stress_over_speed import ELSEWHERE, StressCurve, stress_curve
from .speed_profile import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
        "maximum": ("value", "speed", "link"),
        "error": ("value", "speed", "link"),
        "transmission": ("value", "end"),
    }
    exported: ClassVar[tuple[str, ...]] = ("change",)

    @property
    def change(self) -> Array:
        """Largest stress over that of the first value, ``(nv, ns, links)``: below 1 it helps."""
        return np.asarray(self.maximum / self.maximum[:1])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of all links over the speed, a line for each value."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for value, rows in zip(self.values, self.maximum, strict=True):
            ax.semilogy(self.speed, np.max(rows, axis=1) / 1e6, label=f"{value:g}", linewidth=0.9)
        ax.set_xlabel("crank speed [rad/s]")
        ax.set_ylabel("largest stress [MPa]")
        ax.legend(title=self.name)
        return ax


def damping_effect(
    system: LinearPeriodic,
    speeds: ArrayLike,
    ratios: Sequence[float],
    *,
    rtol: float = 1e-3,
) -> StressEffect:
    """Return the largest stresses for several ratios of modal damping (Aannaque 7.4.2).

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams with modal damping: ``with_modal_damping``.
    speeds : array_like
        Crank speeds [rad/s].
    ratios : sequence of float
        Damping ratios, positive.
    rtol : float
        Wanted error of the stresses, relative.

    Raises
    ------
    BadInput
        If the system has no modal damping, or a value is unusable.
    """
    required_structure(system)
    if "damping_ratio" not in system.parameters:
        fix = "add it with with_modal_damping"
        raise bad("damping_effect", "a system without modal damping", "damping_ratio", fix)
    values = _values("ratios", ratios)
    systems = [system.with_parameters(damping_ratio=float(ratio)) for ratio in values]
    first = stress_curve(systems[0], speeds, rtol=rtol, stability=False)
    return effect_of("damping_ratio", values, systems, first, rtol)


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
        Of a linkage of beams with geometry to vary.
    name : str
        The length: ``frame`` is the distance of the ground pivots, L4.
    values : sequence of float
        Its values [m].
    speeds : array_like
        Crank speeds [rad/s].
    rtol : float
        Wanted error of the stresses, relative.

    Raises
    ------
    BadInput
        If the system has no such length, or the crank cannot turn at a value.
    """
    required_structure(system)
    lengths = _values("values", values)
    systems = [system.with_geometry(**{name: float(value)}) for value in lengths]
    first = stress_curve(systems[0], speeds, rtol=rtol, stability=False)
    return with_transmission(effect_of(name, lengths, systems, first, rtol), system)


def with_transmission(effect: StressEffect, system: LinearPeriodic) -> StressEffect:
    """Return the effect of a length with the transmission angles, where there is a four-bar."""
    if not set(_LENGTHS) <= set(system.geometry):
        return effect
    angles = []
    for value in effect.values:
        lengths = {name: system.geometry[name] for name in _LENGTHS} | {effect.name: float(value)}
        frame, crank, coupler, follower = lengths.values()
        angles.append(transmission_angle(FourBar(frame, crank, coupler, follower)))
    return replace(
        effect, transmission=np.array([[angle.least, angle.greatest] for angle in angles])
    )


def _values(where: str, values: Sequence[float]) -> Array:
    array = np.atleast_1d(numbers(where, values))
    if array.ndim != 1 or not array.size or not np.all(np.isfinite(array) & (array > 0)):
        raise bad(where, str(values), "positive numbers", "correct them")
    return array


def effect_of(
    name: str,
    values: Array,
    systems: Iterable[LinearPeriodic],
    first: StressCurve,
    rtol: float,
    *,
    enough: Callable[[StressCurve], bool] = lambda curve: False,
    tick: Callable[[int], None] | None = None,
) -> StressEffect:
    """Return the curves of systems, the first one known, up to the first that is enough.

    The whole equation was solved for the first value alone: :data:`.ELSEWHERE` times what it
    changed there is part of the errors of the others.
    """
    curves: list[StressCurve] = []
    for system in systems:
        curve = first
        if curves:
            curve = stress_curve(system, first.speed, rtol=rtol, stability=False, whole=False)
        curves.append(curve)
        if tick is not None:
            tick(len(curves))
        if enough(curve):
            break
    change = first.checks["equation"]
    errors = np.array([curve.error for curve in curves])
    errors[1:] += ELSEWHERE * change.value
    return StressEffect(
        method=first.method,
        error=errors,
        error_norm="each largest stress, relative",
        checks={"converged": Check(float(np.max(errors)) / rtol, 1.0), "equation": change},
        provenance=dict(first.provenance),
        name=name,
        values=values[: len(curves)],
        speed=first.speed,
        links=first.links,
        maximum=np.array([curve.maximum for curve in curves]),
    )
