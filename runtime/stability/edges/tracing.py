"""Speeds at which a periodic system enters or leaves instability: each tongue with its ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.families import DAMPING, LinearPeriodic
from ...core.inputs import numbers, speed_span
from ...core.results import Result, provenance
from ...periodic import floquet_multipliers
from ...periodic.equation import at_geometry
from ...periodic.first_order import canonical_form
from ..boundary_speeds import SpeedBoundaries, speed_boundaries
from .checks import edge_checks
from .crossings import damped_regions, mended
from .mode_labels import (
    Modes,
    averaged_modes,
    boundary_units,
    meeting_labels,
    unit_labels,
    whole_range_labels,
)
from .pair_roots import Edges, PairFunction, refined_edges
from .phase_events import Events, meetings, sampled_phases
from .regions import Regions, joined

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Whole = NDArray[np.int64]
Described = Callable[[Array, ComplexArray], tuple[Modes, Array]]

# Relative width from which a tongue gets samples of its own on either side.
_WIDE = 1e-6
# Sine of the argument up to which two multipliers meet at +-1.
REAL = 1e-4
_RPM = 30.0 / np.pi
_CLOSED = "closed: too narrow to be told from none"
_COLOURS = {"principal": "#c05a1f", "sum": "#6b3d8f", "difference": "#2b7a78"}


@dataclass(frozen=True, kw_only=True)
class StabilityEdges(Result):
    """Unstable regions along the speed; all arrays over the regions, by rising speed.

    Attributes
    ----------
    lower, upper : ndarray, shape (k,)
        Speeds [rad/s] at which the region begins and ends; equal where it is narrower than what
        can be told from none; NaN where it reaches far beyond the range, or goes over into
        another region without a multiplier passing the unit circle.
    multiplier : ndarray of complex, shape (k,)
        On the unit circle, where the region begins (in the upper half plane): +1, -1 or neither.
    modes : ndarray of int, shape (k, 2)
        The two modes, from 1, the same twice in a principal region; 0 where the averaged equation
        has none, or none is like it.
    harmonic : ndarray of int, shape (k,)
        n of ``Omega_i + Omega_j = n`` (sum; 2 Omega_j = n in a principal region) or
        ``Omega_j - Omega_i = n`` (difference), in turns per period.
    detuning : ndarray, shape (k,)
        How far the frequencies of the averaged equation are from that, in turns; the labels are
        those that suit best, and a detuning beyond 1/2 makes them a matter of words.
    kind : tuple of str
        ``"principal"``, ``"sum"`` or ``"difference"``.
    error : ndarray, shape (k,)
        Absolute error of either end [rad/s]; where the two coincide, half the width that the
        region may have.
    least_width : float
        Width [rad/s] that each pair of multipliers that meets was searched down to.
    speed_range : tuple of float
        The range [rad/s].
    """

    lower: Array
    upper: Array
    multiplier: ComplexArray
    modes: Whole
    harmonic: Whole
    detuning: Array
    kind: tuple[str, ...]
    least_width: float
    speed_range: tuple[float, float]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(
            ("lower", "upper", "multiplier", "harmonic", "detuning", "error"), ("region",)
        ),
        "modes": ("region", "mode"),
        "kind": ("region",),
    }
    exported: ClassVar[tuple[str, ...]] = ("width",)

    @property
    def width(self) -> Array:
        """Widths [rad/s], shape ``(k,)``; 0 where closed, NaN where an end is missing."""
        return self.upper - self.lower

    @property
    def doubtful(self) -> NDArray[np.bool_]:
        """True where the label is a matter of words: no modes, or a detuning beyond 1/2."""
        return np.asarray((np.abs(self.detuning) > 0.5) | (self.modes[:, 0] == 0))

    @property
    def labels(self) -> tuple[str, ...]:
        """In words: ``region 4 of mode 1``, ``sum of modes 1 and 2, harmonic 9``."""
        return tuple(
            f"region {n} of mode {i}" if kind == "principal" else f"{kind} of {i} and {j}, n = {n}"
            for kind, (i, j), n in zip(
                self.kind, self.modes.tolist(), self.harmonic.tolist(), strict=True
            )
        )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the regions as bars over the speed, one row for each pair of modes."""
        return draw_edges(self, ax)


def stability_edges(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    rtol: float = 1e-11,
    margin: float = 1.15,
    **parameters: float,
) -> StabilityEdges:
    """Return all regions of parametric instability in a range of speeds, each with its ends.

    Principal regions end where a multiplier is +1 or -1 (:func:`speed_boundaries`); combination
    regions where two multipliers of opposite Krein signature leave the unit circle elsewhere.
    Meetings of such multipliers are found from their arguments, however narrow the region; then
    ``2 - r/s - s/r`` of the two, smooth in the speed, is solved for zero.  Where more than two
    meet, the number of multipliers off the circle decides.  With damping the ends are where the
    m-th largest modulus, continuous in the speed, is 1; samples are dense about the regions of the
    undamped system, which lend their labels.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative but for damping.
    speed_range : pair of float
        Lowest and highest speed [rad/s], the lowest positive.
    rtol : float
        Wanted error of the monodromy matrices.
    margin : float
        Factor beyond the range up to which is searched, so that regions are seen whole.
    **parameters : float
        Parameter values that replace the system's own; geometry too, where it can be changed.

    Returns
    -------
    StabilityEdges
        Regions that overlap the range.  Undamped, those too narrow to be seen are listed too,
        closed; with damping they are not.  What may be missed: a region between two samples in
        which multipliers meet twice, a hair-thin one before which one of the two is off the circle,
        and, with damping, a region that damping itself opens, narrower than a sample.  Among the
        checks: ``verdicts``, how many
        regions do not grow as their width promises, and at how many places beside and between ends
        not as many multipliers grow as regions cover them; ``samples``, how
        many of 64 speeds are unstable outside all regions or stable well inside one; those of
        :func:`speed_boundaries` are of the undamped system.

    Raises
    ------
    BadInput
        If an argument is unusable, the system has circulatory forces or damping that feeds energy,
        or the range needs too many samples.
    """
    low, high = speed_span(speed_range)
    rtol, margin = (_number(name, value) for name, value in (("rtol", rtol), ("margin", margin)))
    if not 1e-13 <= rtol <= 1e-6:
        raise bad("rtol", rtol, "a number from 1e-13 to 1e-6", "choose 1e-11")
    system, values = at_geometry(system, parameters)
    parameters = {name: float(numbers(name, value)) for name, value in values.items()}
    form = canonical_form(system, low, parameters)
    sharp = system.without(*DAMPING)
    if not canonical_form(sharp, low, parameters).conservative:
        raise bad(
            "system",
            "stiffness or centrifugal terms that are not symmetric",
            "a system conservative but for damping",
            "use floquet_multipliers or stability_chart",
        )
    if form.damped:
        _check_damping(system, parameters)
    if not 1.0 < margin <= 10.0:
        raise bad("margin", margin, "a factor between 1 and 10", "leave it out")
    span = (low / margin, high * margin)
    ends = speed_boundaries(sharp, (1, -1), speed_range=span, harmonics=None, **parameters)
    regions, least = _undamped(sharp, ends, span, rtol, parameters, whole=not form.damped)
    checks = dict(ends.checks)
    if form.damped:
        regions = damped_regions(system, regions, span, rtol, parameters)
    regions = regions.overlapping(low, high)
    checks.update(edge_checks(system, regions, (low, high), parameters))
    return StabilityEdges(
        method="modulus 1 of a multiplier"
        if form.damped
        else "multiplier +-1, and gap of multipliers of opposite Krein signature",
        error=regions.error,
        error_norm="absolute, of either end [rad/s]",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        lower=regions.lower,
        upper=regions.upper,
        multiplier=regions.multiplier,
        modes=regions.modes,
        harmonic=regions.harmonic,
        detuning=regions.detuning,
        kind=regions.kind,
        least_width=least,
        speed_range=(low, high),
    )


def _check_damping(system: LinearPeriodic, parameters: Mapping[str, float]) -> None:
    """Refuse damping that feeds energy: then every speed is unstable, or nearly."""
    angles = np.linspace(0.0, system.period, 65)[:-1]
    drag = np.asarray(system.array("C", angles, **parameters))
    rates = np.linalg.eigvalsh(drag + np.swapaxes(drag, -1, -2))
    if np.min(rates) < -1e-12 * np.max(np.abs(rates)):
        raise bad(
            "system",
            "damping that feeds energy",
            "damping of no direction below zero",
            "use floquet_multipliers or stability_chart",
        )


def _number(name: str, value: object) -> float:
    found = numbers(name, value)
    if found.ndim:
        raise bad(name, value, "one number", "leave it out")
    return float(found)


def _undamped(
    system: LinearPeriodic,
    ends: SpeedBoundaries,
    span: tuple[float, float],
    rtol: float,
    parameters: Mapping[str, float],
    *,
    whole: bool,
) -> tuple[Regions, float]:
    """Return the regions of a conservative system and the width they were searched down to.

    Where not ``whole``, as places and labels of damped ones, those of single pairs are enough.
    """
    principal = _principal(system, ends, span, parameters)
    if system.size == 1:
        return principal, float(np.max(principal.error, initial=0.0))
    with np.errstate(invalid="ignore"):
        wide = ~(principal.upper - principal.lower <= _WIDE * principal.middle)
    beside = np.concatenate(
        [principal.lower[wide] * (1 - 0.1 * _WIDE), principal.upper[wide] * (1 + 0.1 * _WIDE)]
    )
    # A missing end is NaN, which is in no range.
    beside = beside[(beside > span[0]) & (beside < span[1])]
    events = meetings(sampled_phases(system, span, parameters, rtol, beside))
    edges = refined_edges(PairFunction(system, parameters, rtol), events)
    combined = combined_regions(system, events, edges, parameters)
    near = np.concatenate(
        [principal.lower, principal.upper, edges.lower, edges.upper, events.inside]
    )
    # A pair that leaves the circle at +-1 belongs to a principal region.
    usable = np.abs(np.sin(edges.phase)) > REAL
    if whole:
        combined = mended(system, combined, usable, (span, near), rtol, parameters)
    else:
        combined = combined.take(np.flatnonzero(usable))
    return joined(principal, combined), float(np.max(edges.least[usable], initial=0.0))


def combined_regions(
    system: LinearPeriodic,
    events: Events,
    edges: Edges,
    parameters: Mapping[str, float],
    described: Described | None = None,
) -> Regions:
    """Return the combination regions in which pairs meet, with labels.

    ``described`` takes speeds and multipliers, and returns modes and how much of the motion each
    has; without it, frequencies and phases of the averaged equation alone decide.
    """
    lower, upper, phase = edges.lower, edges.upper, edges.phase
    inner = np.mean(events.reach, axis=1)
    middle = np.where(np.isfinite(lower + upper), 0.5 * (lower + upper), inner)
    shares: Array | None = None
    if described is None:
        modes = averaged_modes(system, middle, parameters)
    else:
        modes, shares = described(middle, np.exp(1j * phase))
    pair, harmonic, off = meeting_labels(modes, phase, phase, shares)
    rows = np.arange(len(middle))
    signs = [np.sign(modes.turns[rows, pair[:, c] - 1]) for c in (0, 1)] if len(middle) else [rows]
    kind = tuple(
        "sum" if a == b else "difference" for a, b in zip(signs[0], signs[-1], strict=True)
    )
    return Regions(
        lower,
        upper,
        edges.error,
        np.exp(1j * np.abs(phase)),
        pair,
        np.abs(harmonic),
        off,
        np.where(np.isfinite(lower), lower, events.reach[:, 0]),
        np.where(np.isfinite(upper), upper, events.reach[:, 1]),
        kind,
    )


def _principal(
    system: LinearPeriodic,
    found: SpeedBoundaries,
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> Regions:
    """Return the regions between pairs of boundaries with multiplier +-1."""
    modes = averaged_modes(system, found.speed, parameters)
    units = boundary_units(system, modes, found, parameters)
    mode, number, off = unit_labels(modes, found, units)
    ends, error = np.full((2, len(units)), np.nan), np.zeros(len(units))
    multiplier = np.zeros(len(units), dtype=complex)
    for column, unit in enumerate(units):
        for side, row in enumerate(unit):
            if row >= 0:
                ends[side, column], multiplier[column] = found.speed[row], found.multiplier[row]
                error[column] = max(error[column], found.error[row])
    bounded = Regions(
        ends[0],
        ends[1],
        error,
        multiplier,
        np.stack([mode, mode], axis=1),
        number,
        off,
        np.where(np.isfinite(ends[0]), ends[0], span[0]),
        np.where(np.isfinite(ends[1]), ends[1], span[1]),
        ("principal",) * len(units),
    )
    return joined(bounded, _endless(system, found, span, parameters))


def _endless(
    system: LinearPeriodic,
    found: SpeedBoundaries,
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> Regions:
    """Return principal regions in which all of the range lies, for multipliers without boundary."""
    middle = np.array([0.5 * (span[0] + span[1])])
    values = floquet_multipliers(system, middle, **parameters)
    real = np.abs(values.multipliers.imag) <= 4 * values.error
    count = {}
    for sign in (1, -1):
        beyond = sign * values.multipliers.real > 1.0 + 4 * values.error
        own = 0 if np.any(found.multiplier == sign) else int(np.sum(real & beyond))
        count[sign] = own
    turn = np.repeat(np.array([1, -1]), [count[1], count[-1]])
    mode, number, off = whole_range_labels(averaged_modes(system, middle, parameters), turn)
    k = len(turn)
    return Regions(
        np.full(k, np.nan),
        np.full(k, np.nan),
        np.zeros(k),
        turn.astype(complex),
        np.stack([mode, mode], axis=1),
        number,
        off,
        np.full(k, span[0]),
        np.full(k, span[1]),
        ("principal",) * k,
    )


def draw_edges(found: StabilityEdges, ax: Axes | None) -> Axes:
    """Draw each region as a bar, closed ones as a grey dot, one row for each pair of modes."""
    from ...core.plotting import axes_or_new

    ax = axes_or_new(ax)
    low, high = (speed * _RPM for speed in found.speed_range)
    pairs = sorted({tuple(pair) for pair in found.modes.tolist()})
    seen: set[str] = set()
    order = np.argsort(found.lower, kind="stable")
    last = dict.fromkeys(pairs, -np.inf)
    for i in order:
        kind, pair = found.kind[i], tuple(found.modes[i].tolist())
        row = pairs.index(pair)
        begin = found.lower[i] * _RPM if np.isfinite(found.lower[i]) else low
        end = found.upper[i] * _RPM if np.isfinite(found.upper[i]) else high
        closed = bool(found.upper[i] - found.lower[i] <= 2 * found.error[i])
        kind = _CLOSED if closed else kind
        label = None if kind in seen else kind
        seen.add(kind)
        if closed:
            ax.plot(begin, row, ".", color="0.6", ms=2.5, label=label)
            continue
        ax.fill_between([begin, end], row - 0.3, row + 0.3, color=_COLOURS[kind], lw=0)
        ax.plot([begin, begin], [row - 0.3, row + 0.3], color=_COLOURS[kind], lw=0.8, label=label)
        middle = 0.5 * (max(begin, low) + min(end, high))
        # Numbers that would run into each other are left out.
        if middle - last[pair] > 0.03 * (high - low):
            ax.text(middle, row + 0.36, f"{found.harmonic[i]}", fontsize=7, ha="center")
            last[pair] = middle
    ax.set_yticks(range(len(pairs)), [_name(pair) for pair in pairs])
    ax.set_ylim(-0.6, len(pairs) - 0.3)
    ax.set_xlim(low, high)
    ax.set_xlabel("crank speed [rpm]")
    ax.set_title("unstable regions; the numbers are harmonics", fontsize=9)
    if seen:
        ax.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, fontsize=8, frameon=False
        )
    return ax


def _name(pair: tuple[int, ...]) -> str:
    return f"mode {pair[0]}" if pair[0] == pair[1] else f"modes {pair[0]}, {pair[1]}"
