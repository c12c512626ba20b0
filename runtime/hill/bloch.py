"""Bloch's recursion: the one perturbation series of this house, to any order.

An operator ``H0 + V`` has a few resonant states on one level of H0.  With P their projector and
``R = -(1 - P)/(H0 - level)``, the wave operator Omega carries them into an invariant subspace,
``(H0 + V) Omega = Omega h`` with ``P Omega = P``.  Equating powers of the parameters in V gives

    h_k = P V Omega_(k-1),   Omega_k = R (V Omega_(k-1) - sum_(0<j<k) Omega_j h_(k-j)),

which :func:`recursion` runs as it was derived and emitted, for whatever columns it is given.  A
homogeneous component of degree k is an array whose first axis counts the monomials of that degree
(:func:`monomials`).  Here the operator is that of Hill's equation with several parameters;
:mod:`..stability.operators` has that of coupled modes.

``y'' + 2 K y' + (lam2 + F(theta)) y = 0`` with ``F = sum_l eps_l f_l`` has, on the boundary of
region n, a solution ``y = sum_m v_m exp(i k theta)`` with ``k = m - n/2``:

    lam2 v_m = (k^2 - 2 i K k) v_m - sum_j F_(m - j) v_j

so that ``H0 = k^2`` and ``V = -F* - 2 i K k``, where K counts as one more parameter.  Without V
the harmonics ``m = 0`` and ``m = n`` share the level ``n^2/4``; all the others lie ``m (m - n)``
away.  The equation is real, so that v may be replaced by its mirror, ``v_m -> conj v_(n-m)``.  One
column of Omega, that of ``m = n``, is therefore enough, and with ``exp(+i n theta/2)`` first

    h = [[A, B], [conj B, conj A]],   lam2 = n^2/4 + Re A -+ sqrt(|B|^2 - (Im A)^2).

A and B are polynomials in the parameters; to first order ``A = -a0 - i n K`` and ``B = -c_n``.
Region 0 has one resonant harmonic, and ``lam2 = A`` is real.

Convolutions are summed term by term, not by FFT, so that small coefficients keep their digits.  A
path of N steps that begins and ends at a resonant harmonic never strays by more than ``N/2`` steps
of the highest harmonic of f: what lies beyond is left out without any effect on h.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations_with_replacement
from math import comb
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...generated import hill_recursion
from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from .checks import Array, Complex, Index

Couple = tuple[NDArray[Any], NDArray[Any]]

# What was emitted, and what a public order leaves for the estimate of its error.
HIGHEST_ORDER, BEYOND = len(hill_recursion.RETURNS), 2
HIGHEST = HIGHEST_ORDER - BEYOND


def recursion(algebra: Any, order: int) -> tuple[Sequence[Any], Sequence[Any]]:
    """Return ``h_1 ... h_order`` and ``Omega_1 ... Omega_order``.

    Of an algebra ``start`` is the column of degree 0, and columns can be subtracted; ``act`` gives
    the part of V Omega that is one degree higher than a column, ``resolve`` R applied to it,
    ``project`` P of it, and ``combine`` ``Omega_j h_i``.
    """
    emitted = getattr(hill_recursion, f"order_{order}")
    effective, columns = emitted(
        algebra.start, algebra.act, algebra.resolve, algebra.project, algebra.combine
    )
    return effective, columns


# ---------------------------------------------------------------- polynomials


@lru_cache(maxsize=256)
def monomials(count: int, degree: int) -> Index:
    """Return the exponents of all monomials of a degree, the highest power of the first first."""
    chosen = list(combinations_with_replacement(range(count), degree))
    out = np.array([[c.count(i) for i in range(count)] for c in chosen], dtype=np.intp)
    return _frozen(out.reshape(len(chosen), count))


@lru_cache(maxsize=256)
def degree_of(size: int, count: int) -> int:
    """Return the degree that has so many monomials; with one parameter every degree has one."""
    return 1 if count == 1 else next(k for k in range(99) if len(monomials(count, k)) == size)


@lru_cache(maxsize=1024)
def product_table(count: int, first: int, second: int) -> Index:
    """Return the place of each product of two monomials, shape (M_first, M_second)."""
    place = {tuple(row): i for i, row in enumerate(monomials(count, first + second).tolist())}
    sums = monomials(count, first)[:, None] + monomials(count, second)[None]
    return np.array([[place[tuple(row)] for row in rows] for rows in sums.tolist()], dtype=np.intp)


def monomial_values(parameters: Array, order: int) -> Iterator[Array]:
    """Yield the values of the monomials of degree 1 ... order, shape (M_k, batch)."""
    values = parameters
    yield values
    for degree in range(2, order + 1):
        # Those that begin with a parameter: it times the last ones below, which have none before.
        sizes = (comb(degree - 2 + m, m - 1) for m in range(len(parameters), 0, -1))
        values = np.concatenate([x * values[-k:] for x, k in zip(parameters, sizes, strict=True)])
        yield values


def _frozen(item: NDArray[Any]) -> NDArray[Any]:
    item.setflags(write=False)
    return item


# ---------------------------------------------------------------- Hill's equation


def level_distance(n: int) -> float:
    """Return how far the level of region n is from the nearest one of the same period."""
    return float({0: 1, 1: 2}.get(n, n - 1))


@dataclass(frozen=True, eq=False)
class EffectiveOperator:
    """A and B of region n as polynomials in the parameters, homogeneous component by component.

    ``diagonal`` and ``coupling`` hold their coefficients by monomial, ``(M_k,)``, for the degrees
    k = 1 ... order; where ``damped`` the last parameter is K.
    """

    n: int
    order: int
    damped: bool
    diagonal: tuple[Complex, ...]
    coupling: tuple[Complex, ...]

    def components(self, parameters: ArrayLike) -> tuple[Complex, Complex]:
        """Return the homogeneous components of A and B, ``(order, *batch)`` each, complex.

        ``parameters``, ``(p, *batch)``, has K last where damped.  Component k stands at place
        k - 1; the sum over the first N is the value to order N.
        """
        values = np.asarray(parameters, dtype=float)
        flat = values.reshape(len(values), -1)
        both = np.empty((2, self.order, flat.shape[1]), dtype=complex)
        for k, rows in enumerate(monomial_values(flat, self.order)):
            a, b = self.diagonal[k], self.coupling[k]
            sums = np.stack([a.real, a.imag, b.real, b.imag]) @ rows
            both[:, k].real, both[:, k].imag = sums[::2], sums[1::2]
        shape = (self.order, *values.shape[1:])
        return both[0].reshape(shape), both[1].reshape(shape)


# Damping and thresholds call for one operator again and again: 2 ms instead of 8 at order 8.
@lru_cache(maxsize=256)
def effective_operator(
    parts: tuple[PeriodicFunction, ...], n: int, order: int, damped: bool = False
) -> EffectiveOperator:
    """Return A and B of region n as polynomials in the parameters, to a total degree up to 10.

    The parameters multiply the functions ``parts``; where ``damped``, K of ``2 K y'`` is the last
    one.  Smith (7.16)-(7.36) and (8.39)-(8.43) to any order and number of parameters.
    """
    algebra = _Columns(parts, n, order // 2, damped)
    with np.errstate(over="ignore", invalid="ignore"):
        effective, _ = recursion(algebra, order)
    diagonal = [np.array(a, dtype=complex) for a, _ in effective]
    coupling = [_frozen(np.array(b, dtype=complex)) for _, b in effective]
    # The mean of f commutes with everything: it moves lam2 and nothing else.
    diagonal[0][: len(algebra.means)] -= algebra.means
    if not all(np.all(np.isfinite(item)) for item in (*diagonal, *coupling)):
        found = "coefficients that overflow"
        fix = "move a common factor into the parameter"
        raise bad("effective_operator", found, "functions of moderate size", fix)
    return EffectiveOperator(n, order, damped, tuple(map(_frozen, diagonal)), tuple(coupling))


def wave_columns(f: PeriodicFunction, n: int, order: int, damping: float) -> Complex:
    """Return the column of Omega that belongs to ``exp(+i n theta/2)``, with f itself as V.

    Shape ``(order + 1, L)``: component k at place k, harmonics ``exp(i (m - n/2) theta)`` for
    m = -r ... n + r, with 1 at m = n and 0 at m = 0.  The column that belongs to
    ``exp(-i n theta/2)`` is its mirror ``columns[:, ::-1].conj()``.
    """
    damped = damping > 0.0
    algebra = _Columns((f,), n, order, damped)
    _, columns = recursion(algebra, order)
    at = np.array([[1.0], [damping]] if damped else [[1.0]])
    values = (row[:, 0] for row in monomial_values(at, order))
    sums = [row @ column for row, column in zip(values, columns, strict=True)]
    return np.array([algebra.start[0], *sums], dtype=complex)


class _Columns:
    """One column of Omega for Hill's equation, an array over monomials x harmonics.

    The harmonics run from ``-reach * H`` to ``n + reach * H`` with H the highest harmonic of the
    parts, those with ``reach`` steps from a resonant one.
    """

    def __init__(
        self, parts: tuple[PeriodicFunction, ...], n: int, reach: int, damped: bool
    ) -> None:
        self.means = np.array([part.mean for part in parts])
        self.taps = [_taps(part.a, part.b) for part in parts]
        self.damped, self.count = damped, len(parts) + damped
        radius = reach * max(len(taps) // 2 for taps in self.taps)
        harmonics = np.arange(-radius, n + radius + 1)
        self.resonant = (radius + n, radius) if n else (radius,)
        real = not damped and not any(np.iscomplexobj(taps) for taps in self.taps)
        self.start = np.zeros((1, len(harmonics)), dtype=float if real else complex)
        self.start[0, radius + n] = 1.0
        self.drag = -2j * (harmonics - 0.5 * n)
        levels = (harmonics * (harmonics - n)).astype(float)
        levels[list(self.resonant)] = -np.inf
        self.resolvent = -1.0 / levels

    def act(self, column: NDArray[Any]) -> NDArray[Any]:
        """Return V applied to a column: its degree rises by one."""
        rows, size = column.shape
        degree = degree_of(rows, self.count)
        out = np.zeros((len(monomials(self.count, degree + 1)), size), dtype=column.dtype)
        raised = product_table(self.count, 1, degree)
        for part, taps in enumerate(self.taps):
            half = len(taps) // 2
            if half:
                # One long convolution, the rows kept apart by zeros.
                apart = np.zeros((rows, size + 2 * half), dtype=column.dtype)
                apart[:, :size] = column
                moved = np.convolve(apart.reshape(-1), taps)[half : half + apart.size]
                out[raised[part]] -= moved.reshape(rows, -1)[:, :size]
        if self.damped:
            out[raised[-1]] += self.drag * column
        return out

    def project(self, column: NDArray[Any]) -> Couple:
        """Return P of a column: A and B, monomial by monomial."""
        first = column[:, self.resonant[0]]
        if len(self.resonant) == 1:
            return first.real.copy(), np.zeros(len(first))
        return first.copy(), column[:, self.resonant[1]].conj()

    def resolve(self, column: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(column * self.resolvent)

    def combine(self, column: NDArray[Any], couple: Couple) -> NDArray[Any]:
        """Return ``Omega_j h_i``, for which the mirror of the column stands for the other one."""
        a, b = couple
        mirror = column[:, ::-1].conj() if len(self.resonant) == 2 else None
        degrees = degree_of(len(column), self.count), degree_of(len(a), self.count)
        table = product_table(self.count, *degrees)
        places = np.arange(len(column))[:, None]
        matrix = np.zeros((len(monomials(self.count, sum(degrees))), len(column)), dtype=a.dtype)
        matrix[table, places] = a
        out: NDArray[Any] = matrix @ column
        if mirror is not None:
            matrix[table, places] = b.conj()
            out += matrix @ mirror
        return out


def _taps(a: Array, b: Array) -> NDArray[Any]:
    """Return the Fourier coefficients c_-H ... c_H, real where all are, the mean left out."""
    c = 0.5 * (a - 1j * b) if np.any(b) else 0.5 * a
    c[0] = 0.0
    nonzero = np.flatnonzero(c)
    c = c[: int(nonzero[-1]) + 1 if nonzero.size else 1]
    return np.concatenate([c[:0:-1].conj(), c])
