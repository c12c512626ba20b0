"""Benchmark of perturbation boundaries: high order at one value, low order at very many."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check
from ..hill import Boundaries, hill_boundaries, perturbation_boundaries
from .records import Benchmark, Contender, Row, compare, functions, one_thread
from .slices import reference_ends

Array = NDArray[np.float64]

_REGIONS = (1, 2, 3, 4, 5, 6)
# mu goes up to here: the first regions of the function are some tenths wide there.
_MU = 0.1
_COMPARED = 5
_MATRICES = 2000
_BATCH = 250


def benchmark_perturbation(values: int = 100_000, rounds: int = 15) -> Benchmark:
    """Time perturbation boundaries beside the eigenvalues of Hill's matrix by NumPy.

    Parameters
    ----------
    values : int
        Number of values of mu in the batch, from ``0.1/values`` to 0.1.
    rounds : int
        How often each contender runs, in turn (the batch: a third as often).

    Returns
    -------
    Benchmark
        ``error`` is the largest amount by which an error exceeds its figure, or zero.

    Raises
    ------
    BadInput
        If a number is less than 1.

    Notes
    -----
    The function has 24 harmonics; regions 1-6.  First order 8 at mu = 0.1, for a function not seen
    before and with its coefficients at hand; then order 4 at all values.  The rival builds Hill's
    Hermitian matrix in exp(i k theta), cut at the smallest harmonic that is as exact as ours at the
    compared values (found beforehand, not timed), for ``numpy.linalg.eigvalsh``, one or many at a
    time; it carries no error figure.  The reference is that of the slices, in extended precision.
    """
    if values < 1 or rounds < 1:
        raise bad("benchmark_perturbation", f"{values}, {rounds}", "at least 1 each", "take more")
    return one_thread(_measure, values, rounds)


def _measure(values: int, rounds: int) -> Benchmark:
    f = functions()["24 harmonics"]
    one = _Problem(f, np.array([_MU]), 8)
    rows: list[Row] = compare(
        f"order 8, mu = {_MU:g}",
        [one.ours(anew=True), one.ours(), one.matrix(), one.rival()],
        rounds,
    )
    many = _Problem(f, np.linspace(_MU / values, _MU, values), 4)
    rows += compare(
        f"order 4, {values} values",
        [many.ours(), many.matrix(), many.rival(_BATCH), many.rival()],
        max(1, rounds // 3),
    )
    excess = max(one.excess(), many.excess())
    return Benchmark(
        method="interleaved timing",
        error=excess,
        error_norm="boundaries in lam2: actual error less its figure, against extended precision",
        checks={"error beyond its figure": Check(excess, 0.0)},
        title=f"Perturbation boundaries of regions 1-6, 24 harmonics, mu <= {_MU:g}",
        rows=tuple(rows),
    )


class _Problem:
    """Boundaries at some mu; a few of them are compared with the reference."""

    def __init__(self, f: PeriodicFunction, mu: Array, order: int) -> None:
        self.f, self.mu, self.order = f, mu, order
        self.seen = np.unique(np.linspace(0, mu.size - 1, _COMPARED).astype(int))
        self.truth = np.stack([reference_ends(f * float(v)) for v in mu[self.seen]], axis=-1)
        self.changes = 0
        self.found = self.boundaries()
        goal = max(self._largest(self.found), 1e-13)
        self.harmonic = next(
            n for n in range(4, 200) if self._gap(matrix_ends(f, mu[self.seen], n)) <= goal
        )

    def boundaries(self) -> Boundaries:
        return perturbation_boundaries(self.f, self.mu, _REGIONS, self.order)

    def anew(self) -> Boundaries:
        """Return those of a function that differs in the last digits: nothing is at hand for it."""
        self.changes += 1
        f = self.f * (1.0 + self.changes * 2.0**-50)
        return perturbation_boundaries(f, self.mu, _REGIONS, self.order)

    def _ends(self, found: Boundaries) -> Array:
        return np.stack([found.lower, found.upper])[..., self.seen]

    def _gap(self, ends: Array) -> float:
        return float(np.abs(ends - self.truth).max())

    def _largest(self, found: Boundaries) -> float:
        return self._gap(self._ends(found))

    def excess(self) -> float:
        """Return the largest amount by which an error exceeds its figure; zero if none does."""
        gaps = np.abs(self._ends(self.found) - self.truth)
        return float(np.maximum(gaps - self.found.error[:, self.seen], 0.0).max())

    def ours(self, anew: bool = False) -> Contender:
        return Contender(
            "elastolink" + (", a new function" if anew else ""),
            self.anew if anew else self.boundaries,
            self._largest,
            note=f"figure {self.found.error[:, self.seen].max():.1e}",
        )

    def matrix(self) -> Contender:
        """Return our own exact boundaries, at a sample of the values."""
        some = self._sample()
        known = hill_boundaries(self.f, self.mu[self.seen], _REGIONS)
        return Contender(
            "hill_boundaries",
            lambda: hill_boundaries(self.f, some, _REGIONS),
            lambda found: self._gap(np.stack([known.lower, known.upper])),
            some.size / self.mu.size,
            f"figure {known.error.max():.1e}",
        )

    def rival(self, together: int = 1) -> Contender:
        """Return NumPy's eigenvalues of so many matrices at a time, at a sample of the values."""
        some = self._sample()

        def run() -> list[Array]:
            return [
                matrix_ends(self.f, some[i : i + together], self.harmonic)
                for i in range(0, some.size, together)
            ]

        how = f", {together} at a time" if together > 1 else ""
        return Contender(
            f"numpy.linalg.eigvalsh{how}",
            run,
            lambda found: self._gap(matrix_ends(self.f, self.mu[self.seen], self.harmonic)),
            some.size / self.mu.size,
            f"cut at k = {self.harmonic}",
        )

    def _sample(self) -> Array:
        return self.mu[:: -max(1, self.mu.size // _MATRICES)][::-1]


def matrix_ends(f: PeriodicFunction, mu: Array, harmonic: int) -> Array:
    """Return the ends of regions 1-6, shape ``(2, 6, n)``: what a user would write with NumPy."""
    ends = np.empty((2, 6, mu.size))
    c = np.concatenate([[2.0 * f.a[0]], f.a[1:] - 1j * f.b[1:], np.zeros(2 * harmonic)])
    for odd in (0, 1):
        k = np.arange(-harmonic, harmonic + 1 - odd) + 0.5 * odd
        apart = np.arange(k.size)[:, None] - np.arange(k.size)
        periodic = np.where(apart >= 0, c[np.abs(apart)], c[np.abs(apart)].conj())
        matrices = np.diag(k * k) - 0.5 * mu[:, None, None] * periodic
        first = 1 - odd
        values = np.linalg.eigvalsh(matrices)[:, first : first + 6].reshape(-1, 3, 2)
        ends[:, first::2] = values.transpose(2, 1, 0)
    return ends
