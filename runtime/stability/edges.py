"""Speeds at which a periodic system enters or leaves instability: each tongue with its ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput, bad
from ..core.families import DAMPING, Array, LinearPeriodic
from ..core.inputs import is_finite, numbers, require_between, speed_span
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic.equation import at_geometry, equation_of
from ..periodic.lowest_modes import LowestModes
from ..periodic.over_speed import MatricesOverSpeed
from .boundary_speeds import SpeedBoundaries, speed_boundaries
from .crossings import damped_regions, edge_checks, mended
from .labels import (
    Regions,
    averaged_modes,
    boundary_units,
    held_modes,
    joined,
    meeting_labels,
    pair_shares,
    principal_labels,
    real_beyond,
    unit_labels,
)
from .pairs import meetings, refined_edges, sampled_phases

ComplexArray = NDArray[np.complex128]
Whole = NDArray[np.int64]

# Relative width from which a tongue gets samples of its own on either side; factor beyond the range
# up to which a region is followed that is wider than the search; sine of the argument up to which
# two multipliers meet at +-1.
_WIDE, _WIDEST, _REAL = 1e-6, 5.0, 1e-4
_GAP = "multiplier +-1, and gap of multipliers of opposite Krein signature"
_TOLD = ("lower", "upper", "multiplier", "modes", "harmonic", "detuning")
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
        How far the turns of these modes, each alone, are from that; the labels are those that suit
        best, and a detuning beyond 1/2 makes them a matter of words.
    kind : tuple of str
        ``"principal"``, ``"sum"`` or ``"difference"``.
    error : ndarray, shape (k,)
        Absolute error of either end [rad/s]; where the two coincide, half the width that the
        region may have and the shift.
    shift : ndarray, shape (k,)
        How far the modes left out move both ends together [rad/s], a part of the error; 0 where all
        modes are kept.  The error of a width is twice the error without it: of regions wide enough
        to compare, five of nine modes change the width by less than 1e-4 of it.
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
    shift: Array
    kind: tuple[str, ...]
    least_width: float
    speed_range: tuple[float, float]

    arrays_along: ClassVar = {
        "region": "lower upper multiplier harmonic detuning shift error width kind",
        "region mode": "modes",
    }
    exported: ClassVar[tuple[str, ...]] = ("width",)
    column_units: ClassVar = {"rad/s": "lower upper shift error width least_width"}

    @property
    def width(self) -> Array:
        """Widths [rad/s], shape ``(k,)``; 0 where closed, NaN where an end is missing."""
        return self.upper - self.lower

    @property
    def doubtful(self) -> NDArray[np.bool_]:
        """True where the label is a matter of words: no modes, or a detuning beyond 1/2."""
        return np.asarray((np.abs(self.detuning) > 0.5) | (self.modes[:, 0] == 0))

    @property
    def names(self) -> list[tuple[str, int, int, int]]:
        """Kind, both modes and harmonic of each region."""
        rows = zip(self.kind, self.modes.tolist(), self.harmonic.tolist(), strict=True)
        return [(kind, i, j, n) for kind, (i, j), n in rows]

    @property
    def labels(self) -> tuple[str, ...]:
        """In words: ``region 4 of mode 1``, ``sum of modes 1 and 2, harmonic 9``."""
        return tuple(
            f"region {n} of mode {i}" if kind == "principal" else f"{kind} of {i} and {j}, n = {n}"
            for kind, i, j, n in self.names
        )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the regions as bars over the speed, closed ones as dots, a row for each pair."""
        ax = axes_or_new(ax)
        low, high = (speed * RPM for speed in self.speed_range)
        pairs = sorted({tuple(pair) for pair in self.modes.tolist()})
        seen: set[str] = set()
        last = dict.fromkeys(pairs, -np.inf)
        for i in np.argsort(self.lower, kind="stable"):
            pair = tuple(self.modes[i].tolist())
            row = pairs.index(pair)
            begin = self.lower[i] * RPM if np.isfinite(self.lower[i]) else low
            end = self.upper[i] * RPM if np.isfinite(self.upper[i]) else high
            closed = bool(self.width[i] <= 2 * (self.error[i] - self.shift[i]))
            kind = _CLOSED if closed else self.kind[i]
            label = None if kind in seen else kind
            seen.add(kind)
            if closed:
                ax.plot(begin, row, ".", color="0.6", ms=2.5, label=label)
                continue
            foot, top, colour = row - 0.3, row + 0.3, _COLOURS[kind]
            ax.fill_between([begin, end], foot, top, color=colour, lw=0)
            ax.plot([begin, begin], [foot, top], color=colour, lw=0.8, label=label)
            middle = 0.5 * (max(begin, low) + min(end, high))
            # Numbers that would run into each other are left out.
            if middle - last[pair] > 0.03 * (high - low):
                ax.text(middle, row + 0.36, f"{self.harmonic[i]}", fontsize=7, ha="center")
                last[pair] = middle
        names = [f"mode {i}" if i == j else f"modes {i}, {j}" for i, j in pairs]
        ax.set_yticks(range(len(pairs)), names)
        ax.set(xlim=(low, high), ylim=(-0.6, len(pairs) - 0.3), xlabel="crank speed [rpm]")
        ax.set_title("unstable regions; the numbers are harmonics", fontsize=9)
        if seen:
            below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.12)}
            ax.legend(**below, ncols=3, fontsize=8, frameon=False)
        return ax


def stability_edges(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    modes: int | str | None = None,
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
    modes : int or 'auto', optional
        Number of lowest modes that a stiff system is truncated to, at least 4 by ``'auto'``, which
        chooses it by the error that it makes.  Principal regions are found from the multipliers too
        then, labels from the modes with the crank held.  Regions in which a mode that was left out
        takes part are not looked for: their harmonics are the gap over the speed and more.  By
        default all modes are kept.
    rtol : float
        Wanted error of the monodromy matrices.
    margin : float
        Factor beyond the range up to which is searched, so that regions are seen whole; up to five
        where the checks tell of one that is wider.
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
        :func:`speed_boundaries` are of the undamped system; ``truncated`` is the relative error of
        exponents by the modes left out at the highest speed.

    Raises
    ------
    BadInput
        If an argument is unusable, the system has circulatory forces or damping that feeds energy,
        the modes left out change exponents by more than 1e-3, or the range needs too many samples.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> edges = el.stability_edges(system, (75.0, 85.0))
    >>> print(edges.labels, edges.lower.round(2), edges.upper.round(2))
    ('region 4 of mode 1',) [78.84] [80.54]
    """
    low, high = speed_span(speed_range)
    require_between("rtol", rtol, 1e-13, 1e-6, "choose 1e-11")
    if not (is_finite(margin) and 1.0 < margin <= 10.0):
        raise bad("margin", margin, "a factor between 1 and 10", "leave it out")
    system, values = at_geometry(system, parameters)
    parameters = {name: float(numbers(name, value)) for name, value in values.items()}
    sharp = system.without(*DAMPING)
    if equation_of(sharp, low, parameters).damped:
        found = "stiffness or centrifugal terms that are not symmetric"
        fix = "use floquet_multipliers or stability_chart"
        raise bad("system", found, "a system conservative but for damping", fix)
    damped = system.is_damped(**parameters)
    if damped:
        _check_damping(system, parameters)
    change, rounding = None, np.zeros(system.size)
    if modes is not None:
        if isinstance(modes, str) and modes != "auto":
            raise bad("modes", modes, "a number of modes or 'auto'", "leave it out for all modes")
        lowest = LowestModes(system.with_parameters(**parameters))
        system, change = lowest.required(high, None if isinstance(modes, str) else modes)
        parameters, rounding = {}, lowest.rounding
    search = partial(_searched, system, change, (low, high), parameters, rtol)
    regions, least, checks = search(margin)
    while margin < _WIDEST and not all(checks[name].passed for name in ("samples", "verdicts")):
        # What is unstable beyond all regions belongs to one that is wider than the search.
        margin = min(1.0 + 3.0 * (margin - 1.0), _WIDEST)
        try:
            wider = search(margin)
        except BadInput:  # too slow for a search
            break
        if _contradicted(wider[2]) < _contradicted(checks):
            regions, least, checks = wider
    shift = (change or 0.0) * (regions.end / high) ** 2 * regions.end
    rounded = np.max(rounding[regions.modes - 1], axis=1) * regions.end
    return StabilityEdges(
        method=("modulus 1 of a multiplier" if damped else _GAP)
        + (f", of {system.size} modes" if modes is not None else ""),
        error=np.maximum(regions.error, rounded) + shift,
        shift=shift,
        error_norm="absolute, of either end [rad/s]",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        **{name: getattr(regions, name) for name in _TOLD},
        kind=tuple(regions.kind.tolist()),
        least_width=least,
        speed_range=(low, high),
    )


def _searched(
    system: LinearPeriodic,
    change: float | None,
    wanted: tuple[float, float],
    parameters: Mapping[str, float],
    rtol: float,
    margin: float,
) -> tuple[Regions, float, dict[str, Check]]:
    """Return the regions that overlap a range, the least width, and the checks."""
    span = wanted[0] / margin, wanted[1] * margin
    sharp, damped = system.without(*DAMPING), system.is_damped(**parameters)
    matrices = MatricesOverSpeed(sharp, span, parameters, rtol)
    checks: dict[str, Check] = {}
    if change is None:
        ends = speed_boundaries(sharp, (1, -1), speed_range=span, **parameters)
        checks.update(ends.checks)
        regions, least = _undamped(matrices, _bounded(matrices, ends, span), span, whole=not damped)
    else:
        regions, least = _undamped(matrices, None, span, whole=not damped)
        checks["truncated"] = Check(change, 1e-3)
    if damped:
        matrices = MatricesOverSpeed(system, span, parameters, rtol)
        regions = damped_regions(matrices, regions, span)
    regions = regions.overlapping(*wanted)
    checks.update(edge_checks(system, regions, wanted, parameters))
    return regions, least, checks


def _contradicted(checks: Mapping[str, Check]) -> float:
    return checks["samples"].value + checks["verdicts"].value


def _check_damping(system: LinearPeriodic, parameters: Mapping[str, float]) -> None:
    """Refuse damping that feeds energy: then every speed is unstable, or nearly."""
    angles = np.linspace(0.0, system.period, 65)[:-1]
    drag = np.asarray(system.array("C", angles, **parameters))
    rates = np.linalg.eigvalsh(drag + np.swapaxes(drag, -1, -2))
    if np.min(rates) < -1e-12 * np.max(np.abs(rates)):
        fix = "use floquet_multipliers or stability_chart"
        raise bad("system", "damping that feeds energy", "damping of no direction below zero", fix)


def _undamped(
    matrices: MatricesOverSpeed, bounded: Regions | None, span: tuple[float, float], *, whole: bool
) -> tuple[Regions, float]:
    """Return the regions of a conservative system and the width they were searched down to."""
    # `bounded` are the principal regions; without them they too are found from pairs that meet.
    # Where not `whole`, as places and labels of damped ones, those of single pairs are enough.
    least = np.zeros(0)
    if bounded is None:
        samples = sampled_phases(matrices, span, np.zeros(0))
        met, middle, least = refined_edges(matrices, meetings(samples, principal=True))
        principal = _met(matrices, met, middle)
    elif matrices.system.size == 1:
        return bounded, float(np.max(bounded.error, initial=0.0))
    else:
        principal = bounded
        with np.errstate(invalid="ignore"):
            wide = ~(bounded.upper - bounded.lower <= _WIDE * bounded.middle)
        beside = [bounded.lower[wide] * (1 - 0.1 * _WIDE), bounded.upper[wide] * (1 + 0.1 * _WIDE)]
        # A missing end is NaN, which is in no range.
        samples = sampled_phases(matrices, span, np.concatenate(beside))
    events = meetings(samples)
    found, middle, width = refined_edges(matrices, events)
    combined = _combined(matrices, found, middle, held=bounded is None)
    # A pair that leaves the circle at +-1 belongs to a principal region.
    usable = found.multiplier.imag > _REAL
    if whole:
        near = [principal.lower, principal.upper, found.lower, found.upper, events.inside]
        combined = mended(matrices, combined, usable, span, np.concatenate(near))
    else:
        combined = combined.take(usable)
    least = np.concatenate([least, width[usable]])
    return joined(principal, combined), float(np.max(least, initial=0.0))


def _combined(matrices: MatricesOverSpeed, found: Regions, middle: Array, *, held: bool) -> Regions:
    """Return the combination regions in which pairs meet, with labels."""
    # With `held` from modes with the crank held and how much of the motion each has; else from
    # frequencies and phases of the averaged equation alone.
    shares = None
    if held:
        modes = held_modes(matrices, middle)
        shares = pair_shares(matrices, modes, middle, found.multiplier)
    else:
        modes = averaged_modes(matrices, middle)
    labels = meeting_labels(modes, np.angle(found.multiplier), shares)
    signs = np.sign(np.take_along_axis(modes.turns, labels[0] - 1, axis=1))
    kind = np.where(signs[:, 0] == signs[:, 1], "sum", "difference")
    return found.labelled(*labels)._replace(kind=kind)


def _met(matrices: MatricesOverSpeed, found: Regions, middle: Array) -> Regions:
    """Return the principal regions, in which a mode's own two multipliers meet, with labels."""
    kept = _single(found, np.flatnonzero(found.multiplier.imag <= np.sqrt(_REAL)))
    found, middle = found.take(kept), middle[kept]
    real = np.where(found.multiplier.real > 0, 1.0, -1.0)
    modes = held_modes(matrices, middle)
    lack = 1.0 - pair_shares(matrices, modes, middle, real.astype(complex))
    labels = principal_labels(modes.turns, real, lack)
    kind = np.full(len(real), "principal")
    return found.labelled(*labels)._replace(multiplier=real.astype(complex), kind=kind)


def _single(regions: Regions, index: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the numbers of regions without those open ones that another event has led to too."""
    kept: list[int] = []
    for row in index.tolist():
        ends = regions.lower[row], regions.upper[row]
        slack = 4 * (regions.error[row] + np.finfo(float).eps * regions.upper[row])
        same = [
            i
            for i in kept
            if abs(regions.lower[i] - ends[0]) <= slack and abs(regions.upper[i] - ends[1]) <= slack
        ]
        if not same or not ends[1] - ends[0] > 2 * slack:
            kept.append(row)
    return np.array(kept, dtype=np.intp)


def _bounded(
    matrices: MatricesOverSpeed, boundaries: SpeedBoundaries, span: tuple[float, float]
) -> Regions:
    """Return the regions between pairs of boundaries with multiplier +-1."""
    modes = averaged_modes(matrices, boundaries.speed)
    units = boundary_units(matrices, modes, boundaries)
    ends, reach = (
        np.where(units >= 0, boundaries.speed[units], other)
        for other in (np.nan, np.array(span)[:, None])
    )
    error = np.max(np.where(units >= 0, boundaries.error[units], 0.0), axis=0)
    real = boundaries.multiplier[np.max(units, axis=0)]
    regions = Regions.unlabelled(ends, error, reach, real)
    regions = regions.labelled(*unit_labels(modes, boundaries, units))
    return joined(regions, _endless(matrices, boundaries, span))


def _endless(
    matrices: MatricesOverSpeed, boundaries: SpeedBoundaries, span: tuple[float, float]
) -> Regions:
    """Return principal regions in which all of the range lies, for multipliers without boundary."""
    middle = np.array([0.5 * (span[0] + span[1])])
    missing = [sign for sign in (1, -1) if sign not in boundaries.multiplier]
    counts = [real_beyond(matrices, middle, sign)[0] for sign in missing]
    real = np.repeat(np.array(missing, dtype=float), np.array(counts, dtype=int))
    k = len(real)
    turns = np.repeat(averaged_modes(matrices, middle).turns, k, axis=0)
    labels = principal_labels(turns, real, np.zeros_like(turns))
    reach = np.repeat(np.array(span)[:, None], k, axis=1)
    regions = Regions.unlabelled(np.full((2, k), np.nan), np.zeros(k), reach, real)
    return regions.labelled(*labels)
