"""Largest Floquet multipliers of condensed systems at a thousand speeds.

Over a stretch of the crank angle in which no mode turns far, the transition matrix is a smooth
function of the inverse speed: a polynomial through few speeds gives it at all others.  At those
few it is found by Magnus' expansion, whose moments over each step are exact Fourier sums.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..floquet.eigenvalues import conditions, spectrum
from ..floquet.period_products import ordered_product
from ..floquet.refined_products import distance
from ..stretches import Tabulated, coefficients, nodes, running_products
from .condensed import Condensed
from .ranges import Grid, limits, wider
from ..core.trigonometric import Array

Run = Callable[[Callable[..., Any], Iterable[Any]], Iterable[Any]]

# Ratio of the speeds of one table; speeds that its polynomials go through; phase that the highest
# mode turns in a step, at the table's lowest speed; steps in a stretch.
_RATIO, _NODES, _PHASE, _MERGED = 2.0, 12, 1.25, 8
# Powers of the speed kept in the equation solved for the acceleration: 0 to 4, as condensed.
_POWERS = 5
# What the error at the speeds tried is multiplied by.
_MARGIN = 4.0
# Turns of the lowest mode in one of the crank from which its mean damping alone decides.
_SLOW = 200.0
_WIDER = 1.001
# Multipliers over the largest that tell what the modes left out change.
_SEEN = 0.1
# How much faster the fastest mode may be of the modes that tell what those left out change.
_FARTHER = 4.0
# Place of a speed that is tried, among those of a table.
_TRIED = 0.381966
# Speeds at the most that are found from the full system, and the error wanted there.
_REFINED, _SHARP = 32, 1e-8
# A multiple of the steps in a stretch.
_TOGETHER = 4096
_BLOCK_FLOATS = 1_000_000


@dataclass(frozen=True)
class Growth:
    """Largest multipliers at some speeds.

    Attributes
    ----------
    modulus : ndarray
        Of the largest multiplier, shape ``(ns,)``.
    error : ndarray
        Its absolute error, shape ``(ns,)``.
    """

    modulus: Array
    error: Array


@dataclass(frozen=True)
class FreeMotion:
    """``z' = L(theta, w) z``, z = (eta, xd): a condensed system without its forces.

    With ``eta = G x``, x coordinates of about unit mass, L is 1/w times
    ``[[0, G], [-sum w^k A_k, -sum w^k B_k]]``.

    Attributes
    ----------
    root : ndarray
        G, shape ``(m, m)``.
    series : ndarray of complex
        Fourier coefficients of (A_k, B_k), shape ``(powers, harmonics + 1, m, 2m)``.
    period : float
        Period [rad].
    rate : float
        Highest frequency [rad/s].
    """

    root: Array
    series: NDArray[np.complex128]
    period: float
    rate: float

    @classmethod
    def of(cls, condensed: Condensed, rate: float, *, answers: bool = True) -> FreeMotion:
        """Return the free motion of a condensed system.

        Parameters
        ----------
        condensed : Condensed
            The reduced system.
        rate : float
            Highest frequency that it keeps [rad/s].
        answers : bool
            Whether with the inertia and damping of what the modes left out answer.
        """
        m, count = condensed.basis.shape[-1], len(condensed.theta)
        # By order of the derivative in time and power of the speed.
        by: dict[int, dict[int, Array]] = {0: {}, 1: {}, 2: {}}
        for (power, order), values in condensed.operator.items():
            if answers or power <= 2:
                by[order][power - order] = values
        inverse = _inverse_series(by[2])
        mean = np.mean(inverse[0], axis=0)
        root = np.linalg.cholesky(0.5 * (mean + mean.T))
        back = np.linalg.inv(root)
        solved = np.zeros((_POWERS, count, m, 2 * m))
        for order, after in ((0, np.eye(m)), (1, root)):
            for own, values in by[order].items():
                for power in range(own, _POWERS):
                    part = back @ (inverse[power - own] @ values) @ after
                    solved[power, :, :, order * m : (order + 1) * m] += part
        series = np.fft.rfft(solved, axis=1)[:, : (count + 1) // 2] / count
        return cls(root, series, condensed.period, rate)

    def moments(self, steps: int) -> Array:
        """Return means over even steps of (A_k, B_k), of them times t and times t^2.

        t is the place in the step, -1/2 to 1/2; shape ``(3, powers, steps, m, 2m)``.
        """
        from scipy.special import spherical_jn

        powers, harmonics, m, wide = self.series.shape
        half = np.pi * np.arange(harmonics) / steps
        j0, j1, j2 = (spherical_jn(n, half) for n in range(3))
        weights = np.stack([j0 + 0j, 0.5j * j1, (j0 - 2.0 * j2) / 12.0]) * np.exp(1j * half)
        spectra = np.zeros((3, powers, steps // 2 + 1, m, wide), dtype=complex)
        spectra[:, :, :harmonics] = weights[:, None, :, None, None] * self.series
        return np.asarray(np.fft.irfft(spectra, n=steps, axis=2)) * steps

    def steps(self, speed: float) -> int:
        """Return how many steps a turn wants, a multiple of those of a stretch."""
        phase = self.rate * self.period / speed
        # All harmonics of the coefficients lie below half the steps.
        least = max(phase / _PHASE, 2 * self.series.shape[1])
        return _MERGED * int(np.ceil(least / _MERGED))

    def stretches(self, moments: Array, speed: float) -> Array:
        """Return the transition matrices of stretches, ``(stretches, 2m, 2m)``."""
        count, m = moments.shape[2], len(self.root)
        reach = self.period / (count * speed)
        powers = reach * speed ** np.arange(moments.shape[1])
        out = []
        for begin in range(0, count, _TOGETHER):
            part = moments[:, :, begin : begin + _TOGETHER]
            rows = np.tensordot(powers, part, axes=(0, 1))
            maps = _exponential(_magnus(rows, reach * self.root))
            out.append(running_products(maps, _MERGED)[_MERGED - 1 :: _MERGED])
        return np.concatenate(out).reshape(-1, 2 * m, 2 * m)

    def turn(self, speed: float, finer: int = 1) -> Array:
        """Return the monodromy matrix at one speed, in as many times the steps; ``(2m, 2m)``."""
        own = np.tensordot(speed ** np.arange(len(self.series)), self.series, axes=1)[None]
        moments = replace(self, series=own).moments(finer * self.steps(speed))
        return np.asarray(_plain(*ordered_product(self.stretches(moments, speed)[None]))[0])


def _inverse_series(masses: Mapping[int, Array]) -> list[Array]:
    """Return the power series in the speed of the inverse of one."""
    first: Array = np.asarray(np.linalg.inv(masses[0]), dtype=np.float64)
    found = [first]
    for power in range(1, _POWERS):
        parts = [masses[q] @ found[power - q] for q in range(1, power + 1) if q in masses]
        found.append(np.asarray(-first @ sum(parts, start=np.zeros_like(first)), dtype=np.float64))
    return found


def _magnus(rows: Array, upper: Array) -> Array:
    """Return the exponents of steps, of order six.

    Parameters
    ----------
    rows : ndarray, shape (3, ns, m, 2m)
        Moments of the lower half of the generator's negative, times the step.
    upper : ndarray, shape (m, m)
        Its upper right block, which does not change.

    Notes
    -----
    The self-adjoint basis of Blanes, Casas, Oteo and Ros (2009), *The Magnus expansion and some of
    its applications*, from the moments.
    """
    m = len(upper)

    def lower(values: Array) -> Array:
        out = np.zeros((len(values), 2 * m, 2 * m))
        out[:, m:] = values
        return out

    mean, first, second = -rows
    a1, a2, a3 = (
        lower(2.25 * mean - 15.0 * second),
        lower(12.0 * first),
        lower(180.0 * second - 15.0 * mean),
    )
    a1[:, :m, m:] = upper
    inner = _commutator(a1, a2)
    outer = a2 - _commutator(a1, 2.0 * a3 + inner) / 60.0
    return np.asarray(a1 + a3 / 12.0 + _commutator(inner - 20.0 * a1 - a3, outer) / 240.0)


def _commutator(a: Array, b: Array) -> Array:
    return np.asarray(a @ b - b @ a)


def _exponential(exponents: Array) -> Array:
    """Return exponentials of matrices of about unit size: Taylor's polynomial of degree 12."""
    square = exponents @ exponents
    cube = square @ exponents
    factors = 1.0 / np.cumprod([1.0, *range(1, 13)])
    unit = np.eye(exponents.shape[-1])
    out = factors[12] * cube
    for k in (9, 6, 3, 0):
        out = out if k == 9 else out @ cube
        out = out + factors[k + 2] * square + factors[k + 1] * exponents + factors[k] * unit
    return np.asarray(out)


def _plain(product: Array, power: NDArray[np.int64]) -> Array:
    """Return products without the powers of two taken out of them."""
    return np.asarray(np.ldexp(product, np.clip(power, -1000, 1000)[:, None, None]))


class MultiplierSweep:
    """Largest multipliers of one system at many speeds.

    Parameters
    ----------
    system : LinearPeriodic
        The full system.
    grid : Grid
        Its angles, arrays and modes there.
    known : iterable of Condensed
        Condensed systems that are made already.
    """

    def __init__(self, system: LinearPeriodic, grid: Grid, known: Iterable[Condensed] = ()) -> None:
        self.system, self.grid = system, grid
        self._known = {one.basis.shape[-1]: one for one in known}
        self._frequency = np.sqrt(np.max(grid.still.squares, axis=0))

    def growth(self, speeds: Array, run: Run = map) -> Growth:
        """Return the largest multipliers at rising speeds.

        As many modes are kept as reach beyond all that excites them; those left out answer
        quasi-statically and decay by their mean damping.  The error holds that of the tables,
        tried between their speeds and with half the steps, and what more modes change.

        Parameters
        ----------
        speeds : ndarray, shape (ns,)
            Speeds [rad/s], rising.
        run : callable
            As :func:`map`, over independent pieces of work.

        Returns
        -------
        Growth
            Where even the lowest mode turns through more than 200 turns in one of the crank, the
            mean damping alone decides.
        """
        held = self._held(speeds, 0)
        modulus, error = held.copy(), 0.5 * np.abs(1.0 - held)
        lowest = float(np.sqrt(np.min(self.grid.still.squares[:, 0])))
        turns = lowest * self.system.period / (2.0 * np.pi * _SLOW)
        begin = int(np.searchsorted(speeds, turns))
        for part in self._ranges(speeds, begin):
            found, kept = self._of_range(speeds[part], run)
            whole = self._with_fast(found, speeds[part], kept)
            modulus[part], error[part] = whole.modulus, whole.error
        return Growth(modulus, error)

    def refined(self, growth: Growth, speeds: Array) -> Growth:
        """Return the same with speeds that the error leaves undecided found from the full system.

        Parameters
        ----------
        growth : Growth
            From :meth:`growth`.
        speeds : ndarray, shape (ns,)
            Its speeds [rad/s].

        Returns
        -------
        Growth
            At 32 speeds at the most: the rest, or what the full system leaves open, stays as it
            is.
        """
        from ..floquet.decoupled.exponents import SlowModes

        open_ = (np.abs(growth.modulus - 1.0) <= growth.error) & (growth.error > 0.0)
        unclear = np.flatnonzero(open_)[:_REFINED]
        if not len(unclear):
            return growth
        modulus, error = growth.modulus.copy(), growth.error.copy()
        slow = SlowModes(self.system, {})
        kept = wider(self.system, self.grid, float(speeds[unclear[-1]]), 0, self._known)
        assert kept is not None
        count = kept.basis.shape[-1]
        found = slow.exponents(speeds[unclear], count, rtol=_SHARP)
        values = np.abs(found.multipliers)
        largest = np.max(values, axis=-1)
        own = Growth(largest, np.max(values + found.error, axis=-1) - largest)
        sharp = self._with_fast(own, speeds[unclear], count)
        better = sharp.error < error[unclear]
        modulus[unclear[better]] = sharp.modulus[better]
        error[unclear[better]] = sharp.error[better]
        return Growth(modulus, error)

    def _ranges(self, speeds: Array, begin: int) -> list[slice]:
        """Return rising speeds from one on in ranges that share a number of modes."""
        inner = np.searchsorted(speeds, limits(self.grid)).tolist()
        bounds = sorted({begin, len(speeds), *(k for k in inner if k > begin)})
        return [slice(a, b) for a, b in pairwise(bounds)]

    def _with_fast(self, found: Growth, speeds: Array, kept: int) -> Growth:
        """Return what some modes give with those left out, which decay as if held."""
        fast = self._held(speeds, kept)
        modulus = np.maximum(found.modulus, fast)
        return Growth(modulus, np.maximum(found.modulus + found.error, fast) - modulus)

    def _of_range(self, speeds: Array, run: Run) -> tuple[Growth, int]:
        """Return what the speeds of one range give, and how many modes they took."""
        condensed = wider(self.system, self.grid, float(speeds[-1]), 0, self._known)
        assert condensed is not None
        kept = condensed.basis.shape[-1]
        free = FreeMotion.of(condensed, float(self._frequency[kept - 1]))
        left = self._left(free, condensed, speeds) * speeds / speeds[-1]
        count = max(1, int(np.ceil(np.log(speeds[-1] / speeds[0]) / np.log(_RATIO) - 1e-9)))
        ends = speeds[0] * (speeds[-1] / speeds[0]) ** (np.arange(count) / count)
        bounds = [*np.searchsorted(speeds, ends).tolist(), len(speeds)]
        modulus, error = np.empty(len(speeds)), np.empty(len(speeds))
        for part in (slice(a, b) for a, b in pairwise(bounds) if b > a):
            matrices, off = _turns(free, speeds[part], run)
            found = _largest(matrices, off + left[part])
            modulus[part], error[part] = found.modulus, found.error
        return Growth(modulus, error), kept

    def _left(self, free: FreeMotion, condensed: Condensed, speeds: Array) -> float:
        """Return the error of a matrix at the highest speed that the modes left out make."""
        kept, n = condensed.basis.shape[-1], self.system.size
        if kept == n:
            return 0.0
        top, fastest = float(speeds[-1]), _FARTHER * free.rate
        more = wider(self.system, self.grid, top, kept, self._known, fastest)
        if more is not None:
            rate = float(self._frequency[more.basis.shape[-1] - 1])
            return _MARGIN * _changed(free, FreeMotion.of(more, rate), speeds)
        # Each answer of the modes left out is smaller than the one before by as much.
        squares = self.grid.still.squares
        ratio = float(np.max(squares[:, kept - 1] / squares[:, kept]))
        return ratio * _changed(free, FreeMotion.of(condensed, free.rate, answers=False), speeds)

    def _held(self, speeds: Array, first: int) -> Array:
        """Return the largest multiplier of modes from one on by their mean damping, as if held."""
        shapes = self.grid.still.shapes[:, :, first:]
        rates = np.zeros((len(speeds), shapes.shape[-1]))
        for power, values in self.grid.arrays.get("C", {}).items():
            drag = np.mean(np.sum(shapes * (values @ shapes), axis=1), axis=0)
            rates -= 0.5 * drag * speeds[:, None] ** (power - 2)
        return np.asarray(np.exp(self.system.period * np.max(rates, axis=1, initial=-np.inf)))


def _changed(free: FreeMotion, other: FreeMotion, speeds: Array) -> float:
    """Return the change of a matrix at the highest speed from one reduced system to another.

    That of the larger multipliers, each over its condition.
    """
    top = float(speeds[-1])
    worst = 0.0
    for speed in (top, float(speeds[int(_TRIED * (len(speeds) - 1))])):
        matrix = free.turn(speed)
        values, vectors = np.linalg.eig(matrix)
        changed = np.linalg.eigvals(other.turn(speed))
        gap = np.min(np.abs(values[:, None] - changed), axis=1)
        own = conditions(vectors.astype(complex)[None])[0]
        seen = np.abs(values) > _SEEN * np.max(np.abs(values))
        size = len(matrix) * float(np.max(np.abs(matrix)))
        shift = float(np.max((gap / np.where(np.isfinite(own), own, 1.0))[seen])) / size
        worst = max(worst, shift * top / speed)
    return worst


def _turns(free: FreeMotion, speeds: Array, run: Run) -> tuple[Array, float]:
    """Return monodromy matrices at rising speeds, and their error over their largest entry."""
    low, high = float(speeds[0]), float(speeds[-1])
    if len(speeds) <= _NODES:
        found = np.stack(list(run(_Turner(free), [(w, 1) for w in speeds.tolist()])))
        fine = free.turn(low, 2)
        return found, _MARGIN * _distance(found[0], fine)
    # Speeds that lie close together do not leave the nodes without room.
    slowest, fastest = _WIDER / low, 1.0 / (_WIDER * high)
    inverse = nodes(fastest, slowest, _NODES)
    moments = free.moments(free.steps(low))
    maps = np.stack(list(run(_Stretcher(free, moments), (1.0 / inverse).tolist())))
    middle = int(_TRIED * len(speeds))
    tried = list(run(_Turner(free), [(low, 2), (float(speeds[middle]), 1)]))
    table = Tabulated(fastest, slowest, coefficients(maps))
    together = max(1, _BLOCK_FLOATS // maps[0].size)
    blocks = [1.0 / speeds[k : k + together] for k in range(0, len(speeds), together)]
    looked = _Looker(table)
    found = np.concatenate(list(run(looked, blocks)))
    off = max(_distance(found[0], tried[0]), _distance(found[middle], tried[1]))
    return found, _MARGIN * off


class _Turner:
    """From a speed, and how much finer the steps are to be, to its monodromy matrix."""

    def __init__(self, free: FreeMotion) -> None:
        self.free = free

    def __call__(self, job: tuple[float, int]) -> Array:
        return self.free.turn(*job)


class _Stretcher:
    """From a speed to the transition matrices of stretches."""

    def __init__(self, free: FreeMotion, moments: Array) -> None:
        self.free, self.moments = free, moments

    def __call__(self, speed: float) -> Array:
        return self.free.stretches(self.moments, speed)


class _Looker:
    """From inverse speeds to monodromy matrices."""

    def __init__(self, table: Tabulated) -> None:
        self.table = table

    def __call__(self, inverse: Array) -> Array:
        return _plain(*self.table.products(inverse))


def _distance(first: Array, second: Array) -> float:
    none = np.zeros(1, dtype=np.int64)
    return float(distance(first[None], none, second[None], none)[0])


def _largest(matrices: Array, off: Array) -> Growth:
    """Return the largest moduli of eigenvalues; infinite where a matrix is not finite."""
    modulus, error = np.full(len(matrices), np.inf), np.zeros(len(matrices))
    finite = np.all(np.isfinite(matrices), axis=(-2, -1))
    if np.any(finite):
        none = np.zeros(np.count_nonzero(finite), dtype=np.int64)
        logarithm, _, uncertain = spectrum(matrices[finite], none, off[finite])
        values = np.exp(logarithm)
        largest = np.max(values, axis=-1)
        modulus[finite] = largest
        error[finite] = np.max(values + np.exp(uncertain), axis=-1) - largest
    return Growth(modulus, error)
