"""Benchmark of stability boundaries: regions 1-6 of slices of the chart."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig_banded

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check
from ..hill import Boundaries, hill_boundaries
from ..hill.certified import certified_boundaries
from .bisection import bisections
from .records import Benchmark, Contender, Row, compare, functions, one_thread

Array = NDArray[np.float64]

_REGIONS = (1, 2, 3, 4, 5, 6)
_WANTED, _NARROW = 1e-12, 1e-14
_MU = 1.0
_OURS = "elastolink"
_CERTIFIED = "elastolink, certified"
_RIVAL = "ten lines with eig_banded"


def benchmark_slices(
    slices: int = 1000, rounds: int = 25, problems: tuple[str, ...] | None = None
) -> Benchmark:
    """Time the boundaries of regions 1-6 of one slice, and of many, beside ten lines of SciPy.

    Parameters
    ----------
    slices : int
        Number of slices in the batch, mu from 1/slices to 1.
    rounds : int
        How often each contender runs, in turn (the batch: a fifth as often).
    problems : tuple of str, optional
        Some of the functions of :func:`.records.functions`, by name; all by default.

    Returns
    -------
    Benchmark
        ``error`` is the largest deviation of our boundaries from the reference.

    Raises
    ------
    BadInput
        If a number is less than 1, or a problem is unknown.

    Notes
    -----
    The ten lines build the banded Hermitian matrix in exp(i k theta), cut at the smallest harmonic
    that gives 1e-12 (found beforehand, not timed), and give no error figure.  Their batch is a loop
    over a sample of the slices.  The reference diagonalises a larger matrix, the last step in
    extended precision.

    The certified boundaries are proved in exact integer arithmetic.

    Bisection of the half trace runs with heyoka, end by end and all ends in one batch, and with
    solve_ivp, each fed with brackets; ends of regions narrower than 0.001 are left out, since they
    are double roots to an integrator.
    """
    if slices < 1 or rounds < 1:
        raise bad("benchmark_slices", f"{slices}, {rounds}", "at least 1 each", "take more")
    known = functions()
    unknown = sorted(set(problems or ()) - set(known))
    if unknown:
        raise bad("benchmark_slices", unknown, f"some of {sorted(known)}", "correct the name")
    return one_thread(_measure, slices, rounds, problems or tuple(known))


def _measure(slices: int, rounds: int, problems: tuple[str, ...]) -> Benchmark:
    rows: list[Row] = []
    worst = widest = 0.0
    known = functions()
    for name in problems:
        f = known[name]
        one = _Slices(f, np.array([_MU]))
        worst = max(worst, one.error(one.ours()))
        widest = max(widest, one.widest())
        problem = f"{name}, one slice"
        rows += compare(problem, [one.contender(), one.rival()], rounds)
        rivals, left_out = bisections(problem, f, _MU, one.truth)
        rivals = [one.contender(repeats=20), one.certified(), *rivals]
        found = compare(problem, rivals, max(1, rounds // 8))
        rows += found[1:] + left_out
        many = _Slices(f, np.linspace(1.0 / slices, _MU, slices))
        contenders = [many.contender(), many.rival(1 + slices // 20)]
        rows += compare(f"{name}, {slices} slices", contenders, max(1, rounds // 5))
    return Benchmark(
        method="interleaved timing",
        error=worst,
        error_norm="boundaries in lam2, absolute, against extended precision",
        checks={
            "error of the boundaries": Check(worst, _WANTED),
            "widest certified enclosure": Check(widest, _NARROW),
        },
        title=f"Boundaries of regions 1-6, |mu| <= {_MU:g}",
        rows=tuple(rows),
    )


class _Slices:
    """The boundaries at some mu; the last one, mu = 1, is compared with the reference."""

    def __init__(self, f: PeriodicFunction, mu: Array) -> None:
        self.f, self.mu = f, mu
        self.truth = reference_ends(f)
        self.harmonic = next(
            n
            for n in range(7, 200)
            if np.abs(banded_boundaries(f, _MU, n) - self.truth).max() < 0.9 * _WANTED
        )

    def ours(self) -> Boundaries:
        return hill_boundaries(self.f, self.mu, _REGIONS)

    def error(self, found: Boundaries) -> float:
        both = np.stack([found.lower[:, -1], found.upper[:, -1]])
        return float(np.abs(both - self.truth).max())

    def contender(self, repeats: int = 1) -> Contender:
        """Return ours; repeated, where what ran before would weigh on a single short run."""
        run: Callable[[], Boundaries] = lambda: [self.ours() for _ in range(repeats)][-1]  # noqa: E731
        note = f"figure {self.ours().error.max():.1e}"
        return Contender(_OURS, run, self.error, float(repeats), note)

    def certified(self) -> Contender:
        """Return ours with proofs; its error is measured against the same rounded reference."""
        run = partial(hill_boundaries, self.f, self.mu, _REGIONS, certified=True)
        note = f"proved, enclosures narrower than {self.widest():.0e}"
        return Contender(_CERTIFIED, run, self.error, note=note)

    def widest(self) -> float:
        """Return the widest enclosure of the last slice."""
        found = certified_boundaries(self.f, self.mu[-1:], np.zeros(1), _REGIONS)
        return 2.0 * float(max(found.lower_radius.max(), found.upper_radius.max()))

    def rival(self, count: int | None = None) -> Contender:
        some = self.mu if count is None else self.mu[:: -max(1, self.mu.size // count)][::-1]
        run: Callable[[], Array] = lambda: [  # noqa: E731 - the loop is the rival
            banded_boundaries(self.f, float(mu), self.harmonic) for mu in some
        ][-1]
        return Contender(
            _RIVAL,
            run,
            lambda found: float(np.abs(found - self.truth).max()),
            some.size / self.mu.size,
            f"cut at k = {self.harmonic}",
        )


def banded_boundaries(f: PeriodicFunction, mu: float, harmonic: int) -> Array:
    """Return the ends of regions 1-6, shape ``(2, 6)``: what a user would write with SciPy."""
    width, ends = min(f.harmonics, 2 * harmonic - 1), np.empty((2, 6))
    for odd in (0, 1):
        k = np.arange(-harmonic, harmonic + 1 - odd) + 0.5 * odd
        bands = np.empty((width + 1, k.size), dtype=complex)
        bands[0] = k * k - mu * f.a[0]
        bands[1:] = (-0.5 * mu) * (f.a[1 : width + 1] - 1j * f.b[1 : width + 1])[:, None]
        values = eig_banded(bands, lower=True, eigvals_only=True, check_finite=False)
        first = 1 - odd
        ends[:, first::2] = values[first : first + 6].reshape(3, 2).T
    return ends


@lru_cache(maxsize=8)
def reference_ends(f: PeriodicFunction) -> Array:
    """Return the ends of regions 1-6 at mu = 1, rounded from extended precision."""
    ends = np.empty((2, 6))
    for odd in (0, 1):
        values = _extended_eigenvalues(f, odd, f.harmonics + 12)
        first = 1 - odd
        ends[:, first::2] = values[first : first + 6].reshape(3, 2).T
    ends.setflags(write=False)
    return ends


def _extended_eigenvalues(f: PeriodicFunction, odd: int, harmonic: int) -> Array:
    """Return eigenvalues of the full Hermitian matrix, the last step in extended precision.

    The matrix is brought to the basis of its computed eigenvectors, where what is off the diagonal
    is round-off: it matters only between the two ends of one region, which may nearly coincide.
    """
    k = (np.arange(-harmonic, harmonic + 1 - odd) + 0.5 * odd).astype(np.longdouble)
    apart = k[:, None] - k
    number = np.abs(apart).astype(int)
    inside = np.minimum(number, f.harmonics)
    c = np.where(number > f.harmonics, 0.0, f.a[inside] - 1j * np.sign(apart) * f.b[inside])
    matrix = np.asarray(-0.5 * _MU * c, dtype=np.clongdouble)
    np.fill_diagonal(matrix, k * k - _MU * np.longdouble(f.a[0]))
    vectors = np.linalg.eigh(matrix.astype(complex))[1].astype(np.clongdouble)
    inner = vectors.conj().T @ matrix @ vectors
    excess = vectors.conj().T @ vectors - np.eye(len(k))
    inner -= 0.5 * (excess @ inner + inner @ excess)
    levels = inner.diagonal().real.copy()
    # Pairs (1, 2), (3, 4), ... of the whole problem, (0, 1), (2, 3), ... of the other.
    for i in range(1 - odd, len(k) - 1, 2):
        middle, half = 0.5 * (levels[i] + levels[i + 1]), 0.5 * (levels[i + 1] - levels[i])
        reach = np.sqrt(half * half + np.abs(inner[i, i + 1]) ** 2)
        levels[i], levels[i + 1] = middle - reach, middle + reach
    return levels.astype(float)
