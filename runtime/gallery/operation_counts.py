"""Operation counts of the algorithms for the steady state, as printed and as counted (section 6.8).

The printed formulas of Tables 6.1 and 6.3 are evaluated as they stand; beside them stands a count
of their steps, operation by operation: an addition or a
multiplication is one, a product of matrices ``(a, b) (b, c)`` takes ``(2 b - 1) a c``, a
triangular decomposition ``(4 n^3 - 3 n^2 - n)/6``, each solution with it ``2 n^2 - n``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

# Tables 6.2 and 6.3 as printed, in millions: (N, n, cycles) to marching, algorithms 1 and 2 with
# storage, the same without; (N, harmonics, n) to the Fourier series and algorithm 1.
TABLE_6_2: Mapping[tuple[int, int, int], tuple[float, ...]] = MappingProxyType(
    {
        (90, 10, 5): (2.43, 3.78, 5.93, 11.4, 7.71, 9.96),
        (90, 10, 100): (6.02, 3.78, 5.93, 228, 7.71, 9.96),
        (90, 50, 5): (259, 438, 707, 1270, 893, 1170),
        (90, 50, 100): (345, 438, 707, 25500, 893, 1170),
        (720, 10, 5): (19.5, 30.1, 47.4, 91.3, 61.8, 79.8),
        (720, 10, 100): (48.2, 30.1, 47.4, 1830, 61.8, 79.8),
        (720, 50, 5): (2070, 3490, 5650, 10200, 7160, 9340),
        (720, 50, 100): (2760, 3490, 5650, 204000, 7160, 9340),
    }
)
TABLE_6_3: Mapping[tuple[int, int, int], tuple[float, float]] = MappingProxyType(
    {
        (90, 6, 10): (2.50, 3.78),
        (90, 6, 50): (277, 438),
        (90, 10, 10): (11.6, 3.78),
        (90, 10, 50): (1200, 438),
        (720, 6, 10): (2.59, 30.1),
        (720, 6, 50): (277, 3490),
        (720, 10, 10): (11.8, 30.1),
        (720, 10, 50): (1200, 3490),
        (720, 15, 10): (39.7, 30.1),
        (720, 15, 50): (3920, 3490),
    }
)


def printed_count(
    algorithm: str,
    *,
    intervals: int,
    freedoms: int,
    cycles: int = 1,
    harmonics: int = 1,
    storage: bool = True,
) -> int:
    """Return the number of operations by the printed formula of an algorithm.

    Parameters
    ----------
    algorithm : str
        ``time_marching``, ``transition_matrix`` (algorithm 1), ``closed_form`` (algorithm 2), or
        ``harmonic_balance`` (the Fourier series analysis).
    intervals, freedoms : int
        N and n.
    cycles : int
        Revolutions marched, n_c.
    harmonics : int
        N_h.
    storage : bool
        Whether the matrices of the intervals are kept.

    """
    big, n, c, h = intervals, freedoms, cycles, harmonics
    tail = 14 * n**3 + 21 * n**2
    formulas = {
        ("time_marching", True): big * (22 * n**3 + (29 + 4 * c) * n**2 + (3 + 2 * c) * n),
        ("time_marching", False): big * c * (22 * n**3 + 33 * n**2 + 5 * n),
        ("transition_matrix", True): big * (38 * n**3 + 37 * n**2 + 7 * n) + 16 * n**3 + 8 * n**2,
        ("transition_matrix", False): big * (78 * n**3 + 77 * n**2 + 10 * n) - tail - 3 * n,
        ("closed_form", True): big * (62 * n**3 + 37 * n**2 + 9 * n)
        + (8 * n**3 + 8 * n**2 + 2 * n),
        ("closed_form", False): big * (102 * n**3 + 87 * n**2 + 10 * n) - tail - n,
    }
    fourier = (
        h**3 * (8 * n**3 + 32 * n**2)
        + h**2 * (12 * n**3 - 120 * n**2 + 8 * n + 32)
        + h * (6 * n**3 + 270 * n**2 + 10 * n + 4 * n * big)
        + (n**3 - 135 * n**2 + 4 * n)
    )
    formulas[("harmonic_balance", True)] = fourier
    return formulas[(algorithm, storage)]


@dataclass
class Tally:
    """Counts the operations of matrix steps as they are taken."""

    operations: int = 0
    steps: dict[str, int] = field(default_factory=dict)

    def _add(self, name: str, number: int) -> None:
        self.operations += number
        self.steps[name] = self.steps.get(name, 0) + number

    def product(self, a: int, b: int, c: int, times: int = 1) -> None:
        """Count products of matrices ``(a, b) (b, c)``."""
        self._add("products", times * (2 * b - 1) * a * c)

    def sum(self, entries: int, times: int = 1) -> None:
        """Count additions, or multiplications by a number, of all entries."""
        self._add("sums", times * entries)

    def solve(self, n: int, columns: int, times: int = 1) -> None:
        """Count solutions of n equations, the decomposition included."""
        self._add("decompositions", times * ((4 * n**3 - 3 * n**2 - n) // 6))
        self._add("solutions", times * columns * (2 * n**2 - n))


def operation_count(
    algorithm: str,
    *,
    intervals: int,
    freedoms: int,
    cycles: int = 1,
    harmonics: int = 1,
    storage: bool = True,
) -> Tally:
    """Return the operations of an algorithm, counted from its steps.

    As for the printed formulas the coefficients of the equation are given at all angles.

    Parameters
    ----------
    algorithm : str
        ``time_marching``, ``transition_matrix`` or ``closed_form`` with Newmark's steps, or
        ``harmonic_balance``.
    intervals, freedoms, cycles, harmonics, storage
        As :func:`printed_count`.
    """
    tally, n, m = Tally(), freedoms, 2 * freedoms
    if algorithm == "harmonic_balance":
        size = (2 * harmonics + 1) * n
        # Entries H + i kappa G - kappa^2 M at k - l and at k + l.
        tally.sum(10 * size * size)
        tally.solve(size, 1)
        return tally
    # Marching takes its steps in each revolution anew where they are not kept, algorithm 1 in
    # both of its revolutions, algorithm 2 in the sum and in the recursion.
    passes = 1 if storage else {"time_marching": cycles}.get(algorithm, 2)
    newmark_steps(tally, n, passes * intervals)
    if algorithm == "time_marching":
        tally.product(m, m, 1, cycles * intervals)
        tally.sum(m, cycles * intervals)
    elif algorithm == "transition_matrix":
        tally.product(m, m, m + 1, intervals)
        tally.sum(m, 2 * intervals)
        tally.sum(m)
        tally.solve(m, 1)
        tally.product(m, m, 1, intervals)
    else:
        tally.solve(m, m, passes * intervals)
        tally.product(m, m, m + 1, intervals)
        tally.product(m, m, 1, intervals)
        tally.sum(m, 2 * intervals)
        tally.sum(m)
        tally.solve(m, 1)
    return tally


def newmark_steps(tally: Tally, n: int, intervals: int) -> None:
    """Count the maps of Newmark steps, as :func:`~.historic_steps.newmark_matrices` takes them."""
    wide = 2 * n + 1
    # q'' at the left end, then q and v without the new acceleration.
    tally.solve(n, wide, intervals)
    tally.sum(n * wide, 4 * intervals)
    # M + gamma h G + beta h^2 H, and the right-hand side.
    tally.sum(n * n, 4 * intervals)
    tally.product(n, n, wide, 2 * intervals)
    tally.sum(n * wide, intervals)
    tally.sum(n, intervals)
    tally.solve(n, wide, intervals)
    tally.sum(n * wide, 4 * intervals)
