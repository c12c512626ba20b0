"""Unstable bands of stiff systems over the speed, from Krein collisions of the slow modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.inputs import speed_span
from ..core.results import Check, provenance
from ..core.trigonometric import even_angles
from ..periodic import floquet_multipliers, monodromy
from ..periodic.decoupled.reduced import SlowSystem, slow_system
from ..periodic.first_order import canonical_form
from .edges.checks import contradictions, edge_checks
from .edges.crossings import damped_regions, mended
from .edges.mode_labels import Modes, principal_labels
from .edges.pair_roots import Edges, PairFunction, refined_edges
from .edges.phase_events import Events, meetings, sampled_phases
from .edges.regions import Regions, joined
from .edges.tracing import REAL, Described, StabilityEdges, combined_regions

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_MARGIN = 1.05
_TOGETHER = 256
# Angles and speeds at which frequencies are worked out; between speeds they change little.
_ANGLES, _SPEEDS = 64, 65
# Log modulus from which a multiplier has left the circle, not by the noise of a double one.
_OFF = 1e-5


def unstable_bands(
    system: LinearPeriodic | SlowSystem,
    speed_range: tuple[float, float],
    modes: int | None = None,
    *,
    rtol: float = 1e-11,
    thorough: bool = True,
    **parameters: float,
) -> StabilityEdges:
    """Return the unstable bands of the slow modes of a stiff system in a range of speeds.

    As :func:`stability_edges`, which needs matrices of all harmonics of all modes, but on the
    decoupled slow modes, and from their multipliers alone: principal bands begin and end where a
    mode's own two multipliers meet at +1 or -1, combination bands where those of two modes with
    opposite Krein signatures meet elsewhere.  Bands in which a mode that was left out takes part
    are not looked for: their harmonics are the gap over the speed and more, and they are as
    narrow as the coefficients' harmonics of that number are small.

    Parameters
    ----------
    system : LinearPeriodic or SlowSystem
        Conservative but for damping; or what :func:`slow_system` made of it.
    speed_range : pair of float
        Lowest and highest speed [rad/s], the lowest positive.
    modes : int, optional
        Number of slow modes, see :func:`slow_system`.
    rtol : float
        Wanted error of the monodromy matrices.
    thorough : bool
        Whether, undamped, each crossing of the circle is looked for around the speeds where the
        bands that single pairs make contradict the number of multipliers off it, because more
        than two meet.
    **parameters : float
        Parameter values that replace the system's own; geometry too.

    Returns
    -------
    StabilityEdges
        Its errors hold what decoupling costs; its further check ``decoupled`` is that relative
        error of the exponents.

    Raises
    ------
    BadInput
        As :func:`slow_system`, or if the range needs more than 40 000 samples.
    """
    low, high = speed_span(speed_range)
    if not 1e-13 <= rtol <= 1e-6:
        raise bad("rtol", rtol, "a number from 1e-13 to 1e-6", "choose 1e-11")
    span = (low / _MARGIN, high * _MARGIN)
    if not isinstance(system, SlowSystem):
        slow = slow_system(system, span, modes, **parameters)
    else:
        slow = system
    if low < slow.speed_range[0] or high > slow.speed_range[1]:
        raise bad(
            "speed_range",
            f"{low:.4g} to {high:.4g} rad/s",
            f"speeds within {slow.speed_range[0]:.4g} to {slow.speed_range[1]:.4g} rad/s",
            "make the slow system for a wider range",
        )
    span = max(span[0], slow.speed_range[0]), min(span[1], slow.speed_range[1])
    own = slow.system
    damped = own.is_damped()
    sharp = own.without(*DAMPING)
    pairs = _Pairs(sharp, span, rtol)
    regions = pairs.regions()
    if damped:
        regions = damped_regions(own, regions, span, rtol, {})
    elif thorough:
        regions = pairs.mended(regions, (low, high))
    regions = regions.overlapping(low, high)
    checks = edge_checks(own, regions, (low, high), {})
    checks["decoupled"] = Check(slow.error, 1e-3)
    return StabilityEdges(
        method="modulus 1 of a multiplier of the slow modes"
        if damped
        else "gap of multipliers of opposite Krein signature, slow modes",
        error=regions.error + slow.error * regions.end,
        error_norm="absolute, of either end [rad/s]",
        checks=checks,
        provenance=provenance(own.provenance),
        lower=regions.lower,
        upper=regions.upper,
        multiplier=regions.multiplier,
        modes=regions.modes,
        harmonic=regions.harmonic,
        detuning=regions.detuning,
        kind=regions.kind,
        least_width=pairs.least,
        speed_range=(low, high),
    )


class _Pairs:
    """The bands of a conservative system, from pairs of its multipliers that meet.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    span : pair of float
        The range [rad/s].
    rtol : float
        Of the monodromy matrices.
    """

    def __init__(self, system: LinearPeriodic, span: tuple[float, float], rtol: float) -> None:
        self._system, self._span, self._rtol = system, span, rtol
        samples = sampled_phases(system, span, {}, rtol, np.zeros(0))
        function = PairFunction(system, {}, rtol)
        own = meetings(samples, principal=True)
        edges = refined_edges(function, own)
        self._principal = _principal(own, edges, self._described)
        self._events = meetings(samples)
        pairs = refined_edges(function, self._events)
        self._combined = combined_regions(system, self._events, pairs, {}, self._described)
        self._usable = np.abs(np.sin(pairs.phase)) > REAL
        # Width that each pair was searched down to.
        self.least = float(np.max(np.concatenate([edges.least, pairs.least]), initial=0.0))

    def _described(self, speed: Array, met: ComplexArray) -> tuple[Modes, Array]:
        modes = held_modes_at(self._system, speed)
        return modes, pair_shares(self._system, modes, speed, met, self._rtol)

    def regions(self) -> Regions:
        """Return the bands as single pairs make them."""
        return joined(self._principal, self._combined.take(np.flatnonzero(self._usable)))

    def mended(self, regions: Regions, span: tuple[float, float]) -> Regions:
        """Return the bands set right where they contradict the number of multipliers off it.

        Around each such place, if that leaves fewer contradictions there.
        """
        wrong = np.concatenate(contradictions(self._system, regions, span, {}))
        ends = np.concatenate([self._span, regions.begin, regions.end, self._events.inside])
        ends = np.unique(ends[(ends >= self._span[0]) & (ends <= self._span[1])])
        best, combined, usable = regions, self._combined, self._usable
        for low, high in self._stretches(ends, wrong):
            where = (low, high), ends[(ends > low) & (ends < high)]
            tried = mended(self._system, combined, usable, where, self._rtol, {})
            found = joined(self._principal, tried)
            if self._wrong(found, low, high) < self._wrong(best, low, high):
                best, combined = found, tried
                usable = np.ones(len(combined.kind), dtype=bool)
        return best

    def _wrong(self, regions: Regions, low: float, high: float) -> int:
        """Return the number of contradictions in a stretch."""
        own = regions.overlapping(low, high)
        return sum(len(w) for w in contradictions(self._system, own, (low, high), {}))

    def _stretches(self, ends: Array, wrong: Array) -> list[tuple[float, float]]:
        """Return stretches around speeds, from one where nothing grows to another, apart."""
        if not len(wrong):
            return []
        middle = 0.5 * (ends[1:] + ends[:-1])
        calm = middle[floquet_multipliers(self._system, middle, rtol=self._rtol).stable]
        around = np.concatenate([[self._span[0]], calm, [self._span[1]]])
        after = np.searchsorted(around, np.clip(wrong, *self._span), side="right")
        after = np.clip(after, 1, len(around) - 1)
        found: list[tuple[float, float]] = []
        for low, high in np.unique(np.stack([around[after - 1], around[after]], axis=1), axis=0):
            if found and low <= found[-1][1]:
                found[-1] = found[-1][0], float(high)
            else:
                found.append((float(low), float(high)))
        return found


def _principal(events: Events, edges: Edges, described: Described) -> Regions:
    """Return the bands in which a mode's own multipliers meet, with labels."""
    kept = np.abs(np.sin(edges.phase)) <= np.sqrt(REAL)
    index = _single(edges, np.flatnonzero(kept))
    lower, upper, phase = edges.lower[index], edges.upper[index], edges.phase[index]
    reach = events.reach[index]
    middle = np.where(np.isfinite(lower + upper), 0.5 * (lower + upper), np.mean(reach, axis=1))
    real = np.where(np.cos(phase) > 0, 1.0, -1.0)
    modes, shares = described(middle, real.astype(complex))
    mode, number, off = principal_labels(modes, real, shares)
    return Regions(
        lower,
        upper,
        edges.error[index],
        real.astype(complex),
        np.stack([mode, mode], axis=1),
        number,
        off,
        np.where(np.isfinite(lower), lower, reach[:, 0]),
        np.where(np.isfinite(upper), upper, reach[:, 1]),
        ("principal",) * len(index),
    )


def _single(edges: Edges, index: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the numbers of bands without those open ones that another event has led to too."""
    found: list[int] = []
    for row in index.tolist():
        ends = edges.lower[row], edges.upper[row]
        slack = 4 * (edges.error[row] + np.finfo(float).eps * edges.upper[row])
        same = [
            i
            for i in found
            if abs(edges.lower[i] - ends[0]) <= slack and abs(edges.upper[i] - ends[1]) <= slack
        ]
        if not same or not ends[1] - ends[0] > 2 * slack:
            found.append(row)
    return np.array(found, dtype=np.intp)


def held_modes_at(system: LinearPeriodic, speed: Array) -> Modes:
    """Return the modes with the crank held: mean frequencies in turns, shapes at angle 0.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    speed : ndarray, shape (k,)
        Speeds [rad/s].
    """
    n = system.size
    if not len(speed):
        return Modes(np.zeros((0, n)), np.zeros((0, n, n), dtype=complex), np.zeros((0, n, n)))
    some = np.linspace(np.min(speed), np.max(speed), _SPEEDS)
    turns, _, _ = _held(system, some, even_angles(system.period, _ANGLES))
    mean = np.mean(turns, axis=1) * some[:, None]
    frequency = np.stack([np.interp(speed, some, mean[:, j]) for j in range(n)], axis=1)
    _, shapes, mass = _held(system, speed, np.zeros(1))
    rows = np.swapaxes(shapes[:, 0], -1, -2).astype(complex)
    whole = system.period / (2 * np.pi)
    return Modes(frequency / speed[:, None] * whole, rows, mass[:, 0])


def _held(system: LinearPeriodic, speed: Array, theta: Array) -> tuple[Array, Array, Array]:
    """Return frequencies over the speed ``(k, nt, n)``, modes in columns, and the mass."""
    form = canonical_form(system, speed, {})
    shape = (len(speed), len(theta), system.size, system.size)
    mass = np.broadcast_to(form.require_mass(form.assemble("M", theta)), shape)
    held = np.zeros(shape)
    for names, sign in ((("K", "Kg"), 1.0), ("B", -1.0)):
        part = form.assemble(names, theta)
        held = held if part is None else held + sign * part
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    moved = inverse @ held @ np.swapaxes(inverse, -1, -2)
    square, vectors = np.linalg.eigh(0.5 * (moved + np.swapaxes(moved, -1, -2)))
    return np.sqrt(np.maximum(square, 0.0)), np.swapaxes(inverse, -1, -2) @ vectors, mass


def pair_shares(
    system: LinearPeriodic, modes: Modes, speed: Array, met: ComplexArray, rtol: float
) -> Array:
    """Return the shares of the modes in the action of pairs of motions, each row of sum 1.

    The action, energy over frequency, does not favour the high modes that a motion drags along.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    modes : Modes
        From :func:`held_modes_at`, at the speeds.
    speed : ndarray, shape (k,)
        Speeds within the bands [rad/s].
    met : ndarray of complex, shape (k,)
        Where on the unit circle the two multipliers of each band meet, in one half plane.
    rtol : float
        Of the monodromy matrices.

    Returns
    -------
    ndarray, shape (k, n)
    """
    k, n = modes.turns.shape
    shares = np.zeros((k, n))
    for start in range(0, k, _TOGETHER):
        part = slice(start, start + _TOGETHER)
        found = monodromy(system, speed[part], rtol=rtol)
        values, vectors = np.linalg.eig(np.ldexp(found.scaled, found.exponent[:, None, None]))
        values = values.astype(complex)
        chosen = _chosen(values, met[part])
        rows = np.arange(len(values))
        for column in chosen.T:
            motion = (vectors[rows, :, column] * found.scale)[:, :n]
            along = np.einsum("kjn,knh,kh->kj", modes.shapes[part].conj(), modes.mass[part], motion)
            action = np.abs(along) ** 2 * modes.turns[part]
            total = np.sum(action, axis=1, keepdims=True)
            shares[part] += 0.5 * action / np.where(total > 0.0, total, 1.0)
    return shares


def _chosen(values: ComplexArray, met: ComplexArray) -> NDArray[np.intp]:
    """Return the numbers of the two multipliers of each pair, shape ``(k, 2)``."""
    size = np.abs(np.log(np.abs(values)))
    away = np.abs(np.angle(values / met[:, None]))
    off = size > _OFF
    nearest = np.argsort(np.abs(values - met[:, None]), axis=1)[:, :2]
    # Off the circle: the one of nearest argument, of like ones the largest, and its inverse.
    first = np.argmin(np.where(off, np.round(away, 6) - 1e-9 * size, np.inf), axis=1)
    own = values[np.arange(len(values)), first]
    second = np.argmin(np.abs(values - (1.0 / own.conj())[:, None]), axis=1)
    gone = np.any(off, axis=1) & (away[np.arange(len(values)), first] < 0.5)
    pairs: NDArray[np.intp] = np.where(gone[:, None], np.stack([first, second], axis=1), nearest)
    return pairs
