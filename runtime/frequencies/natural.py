"""Natural frequencies and shapes over the crank angle, followed from angle to angle, and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.assembly import in_own_axes
from ..beams.element_forms import required_structure
from ..beams.elements import shapes_of
from ..beams.structure import Structure
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import is_finite, require_whole
from ..core.plotting import Axes, axes_or_new, new_figure
from ..core.results import Check, Result, provenance
from ..core.trigonometric import even_angles
from .held import HeldCrank, assurance, crank_angles, cycle_mean
from .tracking import CLEAR, Curves, Encounter, followed_shapes, walk

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ComplexArray = NDArray[np.complex128]

_ENCOUNTERS = ("encounter_angle", "encounter_rank", "encounter_gap", "encounter_width")


@dataclass(frozen=True, kw_only=True)
class NaturalFrequencies(Result):
    """Natural frequencies of a linear periodic system with its crank held, mode by mode.

    Attributes
    ----------
    theta : ndarray
        Crank angles [rad], shape ``(nt,)``.
    frequency : ndarray
        Natural frequencies [rad/s], rising, shape ``(nt, count)``.
    tracked : ndarray
        The same along the curves that begin at the first angle, in their order there: where two
        cross each keeps to its own, shape ``(nt, count)`` [rad/s].
    branch : ndarray of int
        Number of the curve at each rank, from 1, shape ``(nt, count)``.
    shape : ndarray
        Shapes along the curves, of unit modal mass and steady sign, ``(nt, n, count)``.
    mac : ndarray
        Mass-weighted modal assurance of each shape and that of its curve at the first angle,
        ``(nt, count)``: how much of it is left.
    encounters : tuple of Encounter
        Crossings and veerings over the period, by angle, of these modes and with the next one.
    closure : ndarray of int
        Which curve each becomes after a whole turn, from 1, shape ``(count,)``.
    sign : ndarray
        1 or -1: whether its shape comes back as itself or turned over, ``(count,)``; 0 where the
        curve does not come back.
    mean : ndarray
        Means over the period, rank by rank [rad/s], ``(count,)``.
    mean_error : ndarray
        Their errors [rad/s], ``(count,)``: of the integral and of round-off.
    branch_mean, branch_mean_error : ndarray
        The same of the curves, each over the turns after which it comes back, ``(count,)``.
    error : ndarray
        Round-off of ``frequency`` [rad/s], ``(nt, count)``; that of the elements is not in it.
    speed : float
        Crank speed [rad/s] of the axial forces.
    labels : tuple of str
        Names of the coordinates.
    """

    theta: Array
    frequency: Array
    tracked: Array
    branch: NDArray[np.int64]
    shape: Array
    mac: Array
    encounters: tuple[Encounter, ...]
    closure: NDArray[np.int64]
    sign: Array
    mean: Array
    mean_error: Array
    branch_mean: Array
    branch_mean_error: Array
    speed: float
    labels: tuple[str, ...]

    arrays_along: ClassVar = {
        "angle": "theta",
        "angle coordinate curve": "shape",
        "angle rank": "frequency error branch",
        "angle curve": "tracked mac",
        "rank": "mean mean_error",
        "curve": "closure sign branch_mean branch_mean_error",
        "encounter": " ".join(_ENCOUNTERS),
    }
    exported: ClassVar[tuple[str, ...]] = _ENCOUNTERS
    column_units: ClassVar = {
        "rad/s": "error encounter_gap",
        "rad": "encounter_angle encounter_width",
    }

    @property
    def encounter_angle(self) -> Array:
        """Crank angles of the encounters [rad]."""
        return np.array([one.angle for one in self.encounters], dtype=float)

    @property
    def encounter_rank(self) -> NDArray[np.int64]:
        """Lower rank of each encounter, from 1."""
        return np.array([one.lower for one in self.encounters], dtype=np.int64)

    @property
    def encounter_gap(self) -> Array:
        """Least gap of each encounter [rad/s]."""
        return np.array([one.gap for one in self.encounters], dtype=float)

    @property
    def encounter_width(self) -> Array:
        """Width of each veering [rad]; 0 of a crossing."""
        return np.array([one.width for one in self.encounters], dtype=float)

    @property
    def crossings(self) -> tuple[Encounter, ...]:
        """Where curves cross."""
        return tuple(found for found in self.encounters if found.kind == "crossing")

    @property
    def veerings(self) -> tuple[Encounter, ...]:
        """Where curves veer away from each other."""
        return tuple(found for found in self.encounters if found.kind == "veering")

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curves over the crank angle, crossings and veerings marked."""
        ax = axes_or_new(ax)
        for k in range(self.tracked.shape[1]):
            ax.plot(np.degrees(self.theta), self.tracked[:, k], lw=1.2, label=f"mode {k + 1}")
        low, high = np.min(self.theta), np.max(self.theta)
        veering: dict[str, Any] = {"marker": "o", "edgecolors": "0.35", "facecolors": "none"}
        for name, style, found in (
            ("crossing", {"marker": "x", "color": "k"}, self.crossings),
            ("veering", veering, self.veerings),
        ):
            seen = [one for one in found if low <= one.angle <= high]
            if seen:
                places = np.degrees([one.angle for one in seen])
                ax.scatter(
                    places, [one.frequency for one in seen], s=36, label=name, zorder=3, **style
                )
        ax.set(xlabel="crank angle [deg]", ylabel="natural frequency [rad/s]")
        ax.set_ylim(bottom=0.0)
        ax.legend(fontsize=8, ncols=2)
        return ax


def natural_frequencies(
    system: LinearPeriodic,
    theta: ArrayLike | None = None,
    count: int | None = None,
    *,
    speed: float = 0.0,
    **parameters: float,
) -> NaturalFrequencies:
    """Return natural frequencies and shapes with the crank held at angles (Aannaque 4.40).

    ``(K + Kg) u = omega^2 M u`` at each angle.  The shapes are followed from angle to angle by
    their mass-weighted modal assurance; angles are added until it is clear which goes on as which.
    Where two frequencies all but meet, the least gap decides: none beyond round-off is a crossing,
    each shape going on along its own curve; else it is a veering, and the curves keep apart.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    theta : array_like, optional
        Crank angles [rad], shape ``(nt,)``; 361 over a period by default.  The curves are numbered
        by rank at the first; they are followed over a whole period in any case.
    count : int, optional
        Number of modes, the lowest; 6, or all of fewer, by default.
    speed : float
        Crank speed [rad/s] whose axial forces stiffen or soften; neither Coriolis nor centrifugal
        terms play a part: see :func:`~.campbell.campbell`.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    NaturalFrequencies
        Its checks: ``assured``, what is lacking to 1 of the least assurance between neighbouring
        angles; ``mean``, the largest error of a mean over itself.

    Raises
    ------
    BadInput
        If an angle, the count or the speed is unusable, a parameter is unknown, or mass or
        stiffness is not positive definite at some angle.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.natural_frequencies(system, theta=[0.0, 1.0], count=2)
    >>> print(found.frequency.round())
    [[176. 279.]
     [187. 421.]]
    """
    require_system(system)
    angles = crank_angles(system, theta)
    if count is None:
        count = min(system.size, 6)
    count = require_whole("count", count, 1, system.size)
    # Beyond that its square, times a mass, is no number.
    if not (is_finite(speed) and 0.0 <= speed <= 1e100):
        raise bad("speed", repr(speed), "a crank speed [rad/s], 0 or more", "correct it")
    period, start = system.period, float(angles[0])
    crank = HeldCrank(system, parameters, float(speed))
    watched = count
    while True:
        # So many modes that no requested curve leaves them.
        path = walk(crank, watched)
        curves = Curves(path, start, system.size, count, period)
        if curves.highest < watched or watched == system.size:
            break
        watched = min(watched + 4, system.size)
    held = crank.modes(angles)
    tracked, branch = curves.follow(angles, held.frequency), curves.labels(angles)[:, :count]
    shape, sign = followed_shapes(crank, curves, angles)
    breaks = [one.angle for one in path.encounters]
    means, errors = cycle_mean(partial(_values, crank, curves), period, breaks)
    closure = curves.closure
    kept = assurance(shape[:1], shape, 0.5 * (held.mass[:1] + held.mass))
    return NaturalFrequencies(
        method="generalised eigenvalue problem of K + Kg and M, followed by modal assurance",
        error=held.error[:, :count],
        error_norm="absolute, of each frequency [rad/s], round-off alone",
        checks={
            "assured": Check(1.0 - path.assured, 1.0 - CLEAR),
            "mean": Check(float(np.max(errors / means)), 1e-9),
        },
        provenance=provenance(system.changed_provenance(**parameters)),
        theta=angles,
        frequency=held.frequency[:, :count],
        tracked=tracked,
        branch=branch + 1,
        shape=shape,
        mac=np.diagonal(kept, axis1=-2, axis2=-1),
        encounters=path.encounters,
        closure=closure + 1,
        sign=np.where(closure == np.arange(count), sign, 0.0),
        mean=means[:count],
        mean_error=errors[:count],
        branch_mean=means[count:],
        branch_mean_error=errors[count:],
        speed=float(speed),
        labels=system.labels,
    )


def _values(crank: HeldCrank, curves: Curves, theta: Array) -> tuple[Array, Array]:
    """Return frequencies by rank and by curve, and their round-off, ``(nt, 2 count)`` each."""
    held = crank.modes(theta)
    both = []
    for part in (held.frequency, held.error):
        # A curve that comes back only after several turns has its mean over all of them.
        turns = [curves.follow(theta + k * curves.period, part) for k in range(curves.turns)]
        both.append(np.concatenate([part[:, : curves.count], np.mean(turns, axis=0)], axis=1))
    return both[0], both[1]


def _deflected(structure: Structure, theta: float, shape: Array) -> dict[str, ComplexArray]:
    """Return places on each rigid link and their displacements in a shape, ``(2, np)`` [m]."""
    full = np.zeros(len(structure.freedoms.all))
    full[structure.freedoms.free] = shape
    motion = structure.configuration(np.array([theta]))
    found: dict[str, ComplexArray] = {}
    places = np.linspace(0.0, 1.0, 17)
    for element in structure.elements:
        name = element.beam.name
        shapes = shapes_of(element, places)
        turn = np.exp(1j * float(motion[name].angle[0]))
        local = in_own_axes(full[None, element.indices], turn.real, turn.imag)[0]
        rigid = complex(*motion[name].origin[0]) + (element.start + element.length * places) * turn
        both = np.stack([rigid, (shapes["u"] @ local + 1j * (shapes["v"] @ local)) * turn])
        found[name] = np.concatenate([found.get(name, both[:, :0]), both], axis=1)
    return found


def draw_mode(
    system: LinearPeriodic,
    theta: float = 0.0,
    mode: int = 1,
    ax: Axes | None = None,
    *,
    found: NaturalFrequencies | None = None,
) -> Axes:
    """Draw a mode, counted from 1, of the held linkage over its rigid position; return the axes.

    The system is a linkage or frame of beams, ``theta`` the crank angle [rad].  With ``found``,
    its natural frequencies at angles that include this one, the mode is that curve, its sign
    steady from angle to angle.  BadInput is raised if the system has no beams, or the mode or the
    angle is not there.
    """
    structure = required_structure(system)
    require_whole("mode", mode, 1, system.size)
    if not is_finite(theta):
        raise bad("theta", repr(theta), "one number [rad]", "choose a crank angle")
    held = natural_frequencies(system, float(theta), mode) if found is None else found
    at = int(np.argmin(np.abs(held.theta - theta)))
    if abs(held.theta[at] - theta) > 1e-9 or mode > held.shape.shape[-1]:
        raise bad("found", "no such angle or mode", "frequencies that have both", "leave it out")
    links = _deflected(structure, float(theta), held.shape[at, :, mode - 1])
    longest = max(beam.length for beam in structure.beams)
    largest = max(float(np.max(np.abs(bent))) for _, bent in links.values())
    # The largest deflection is drawn as an eighth of the longest link.
    factor = 0.12 * longest / largest
    ax = axes_or_new(ax)
    for rigid, bent in links.values():
        drawn = rigid + factor * bent
        ax.plot(rigid.real, rigid.imag, "--", color="0.6", lw=0.8)
        ax.plot(drawn.real, drawn.imag, color="C0", lw=1.5)
    for place in structure.places(np.array([theta])).values():
        ax.plot(*place[0], "o", color="0.3", ms=3, mfc="w")
    ax.set_aspect("equal")
    ax.set_axis_off()
    frequency = held.tracked[at, mode - 1]
    title = f"{np.degrees(theta):.0f} deg, mode {mode}: {frequency:.1f} rad/s"
    ax.set_title(title, fontsize=7)
    return ax


def draw_modes(
    system: LinearPeriodic, theta: Sequence[float] | Array | None = None, modes: int = 3
) -> Figure:
    """Return a figure of modes, a row to a crank angle.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    theta : sequence of float, optional
        Crank angles [rad], by default every 36 degrees.
    modes : int
        How many, from the lowest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> print(len(el.frequencies.draw_modes(system, theta=[0.0, 1.0], modes=2).axes))
    4
    """
    required_structure(system)
    angles = crank_angles(system, even_angles(system.period, 10) if theta is None else theta)
    found = natural_frequencies(system, angles, require_whole("modes", modes, 1, system.size))
    figure = new_figure(2.6 * modes, 1.7 * len(angles))
    axes = figure.subplots(len(angles), modes, squeeze=False)
    for row, angle in zip(axes, angles, strict=True):
        for k, ax in enumerate(row):
            draw_mode(system, float(angle), k + 1, ax, found=found)
    return figure
