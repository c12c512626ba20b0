"""The effective operator of a region of Hill's equation: all orders of its boundaries at once.

The equation ``y'' + 2 K y' + (lam2 + F(theta)) y = 0`` with ``F = sum_l eps_l f_l`` has, on the
boundary of region n, a solution ``y = sum_m v_m exp(i k theta)`` with ``k = m - n/2``:

    lam2 v_m = (k^2 - 2 i K k) v_m - sum_j F_(m - j) v_j

that is ``lam2 v = (H0 + V) v`` with ``H0 = k^2`` and ``V = -F* - 2 i K k``, where K counts as one
more parameter.  Without V the harmonics ``m = 0`` and ``m = n`` share the level ``n^2/4``; all the
others lie ``E_m = m (m - n)`` away.  Let P project on the two and ``R = -(1 - P)/E``.  Bloch's
wave operator carries the two into an invariant subspace, ``(H0 + V) Omega = Omega h`` with
``P Omega = P``, and equating powers of the parameters gives (``n^2/4`` apart)

    h_k = P V Omega_(k-1),   Omega_k = R (V Omega_(k-1) - sum_(0<j<k) Omega_j h_(k-j)).

The equation is real, so that v may be replaced by its mirror, ``v_m -> conj v_(n-m)``.  One column
of Omega, that of ``m = n``, is therefore enough, and with the harmonic ``exp(+i n theta/2)`` first

    h = [[A, B], [conj B, conj A]],   lam2 = n^2/4 + Re A -+ sqrt(|B|^2 - (Im A)^2).

A and B are polynomials in the parameters; to first order ``A = -a0 - i n K`` and ``B = -c_n``.
Region 0 has one resonant harmonic, and ``lam2 = A`` is real.

A homogeneous component of degree k is an array over its monomials (and harmonics).  Convolutions
are summed term by term, not by FFT, so that small coefficients keep their digits.  A path of N
steps that begins and ends at a resonant harmonic never strays by more than ``N/2`` steps of the
highest harmonic of f: what lies beyond is left out without any effect on h.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....generated import hill_recursion
from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Couple = tuple[NDArray[Any], NDArray[Any]]

HIGHEST_ORDER = len(hill_recursion.RETURNS)

_Key = tuple[tuple[bytes, bytes], ...]


def check_region(n: object) -> None:
    """Refuse a number of a region that is no whole number from 0."""
    if not is_whole(n, 0):
        raise bad("region", repr(n), "a whole number >= 0", "correct it")


@dataclass(frozen=True, eq=False)
class EffectiveOperator:
    """A and B of one region as polynomials in the parameters, homogeneous component by component.

    Attributes
    ----------
    n : int
        Number of the region.
    order : int
        Highest total degree.
    damped : bool
        True where the last parameter is K.
    exponents : tuple of ndarray, shape (M_k, p)
        For the degrees k = 1 ... order: the exponents of the monomials, read-only.
    diagonal, coupling : tuple of ndarray, shape (M_k,), complex
        Coefficients of A and of B, likewise.
    """

    n: int
    order: int
    damped: bool
    exponents: tuple[Index, ...]
    diagonal: tuple[Complex, ...]
    coupling: tuple[Complex, ...]
    _key: _Key = field(repr=False)

    @property
    def parameters(self) -> int:
        """Number of parameters, K included."""
        return int(self.exponents[0].shape[1])

    def components(self, parameters: ArrayLike) -> tuple[Complex, Complex]:
        """Evaluate the homogeneous components of A and B.

        Parameters
        ----------
        parameters : array_like, shape (p, *batch)
            Values of ``eps_1 ... eps_p``, and of K last where damped.

        Returns
        -------
        A_k, B_k : ndarray, shape (order, *batch), complex
            Component k stands at place k - 1; the sum over the first N is the value to order N.

        Raises
        ------
        BadInput
            If the number of parameters is wrong or a value is not finite.
        """
        values = self._checked(parameters)
        flat = values.reshape(len(values), -1)
        both = np.empty((2, self.order, flat.shape[1]), dtype=complex)
        powers = _monomial_values(flat, self.order)
        for k, (monomials, a, b) in enumerate(
            zip(powers, self.diagonal, self.coupling, strict=True)
        ):
            found = np.stack([a.real, a.imag, b.real, b.imag]) @ monomials
            both[:, k].real, both[:, k].imag = found[::2], found[1::2]
        shape = (self.order, *values.shape[1:])
        return both[0].reshape(shape), both[1].reshape(shape)

    def solution(self, parameters: ArrayLike) -> tuple[Index, Complex]:
        """Evaluate the column of Omega that belongs to ``exp(+i n theta/2)``.

        Parameters
        ----------
        parameters : array_like, shape (p, *batch)
            As for :meth:`components`.

        Returns
        -------
        harmonics : ndarray, shape (L,)
            Numbers m; the wave number is ``m - n/2``.
        columns : ndarray, shape (order + 1, L, *batch), complex
            Component k at place k: ``v^+_m``, with 1 at m = n and 0 at m = 0.  The column that
            belongs to ``exp(-i n theta/2)`` is its mirror ``conj v^+_(n-m)``, which is
            ``columns[:, ::-1].conj()``.

        Notes
        -----
        On a boundary ``y = sum_m (u v^+_m + w conj v^+_(n-m)) exp(i (m - n/2) theta)`` with an
        eigenvector ``(u, w)`` of h.
        """
        values = self._checked(parameters)
        flat = values.reshape(len(values), -1)
        harmonics, columns = _columns(self._key, self.n, self.order, self.damped)
        out = np.empty((self.order + 1, len(harmonics), flat.shape[1]), dtype=complex)
        out[0] = columns[0][0][:, None]
        for k, monomials in enumerate(_monomial_values(flat, self.order), start=1):
            out[k] = columns[k].T @ monomials
        return harmonics, out.reshape(*out.shape[:2], *values.shape[1:])

    def _checked(self, parameters: ArrayLike) -> Array:
        values = np.asarray(parameters, dtype=float)
        if values.ndim == 0 or len(values) != self.parameters:
            raise bad(
                "parameters",
                f"an array of shape {values.shape}",
                f"{self.parameters} rows" + (", K last" if self.damped else ""),
                "give one row per part" + (" and one for K" if self.damped else ""),
            )
        if not np.all(np.isfinite(values)):
            raise bad("parameters", "a value that is not finite", "finite numbers", "correct it")
        return values


def effective_operator(
    parts: Sequence[PeriodicFunction], n: int, order: int, damped: bool = False
) -> EffectiveOperator:
    """Return A and B of region n as polynomials in the parameters, to a total degree.

    Parameters
    ----------
    parts : sequence of PeriodicFunction
        The functions ``f_1 ... f_p`` that the parameters multiply.
    n : int
        Number of the region, at least 0.
    order : int
        Highest total degree, 1 to 10.
    damped : bool
        True to have K of ``2 K y'`` as the last parameter.

    Returns
    -------
    EffectiveOperator
        The same object again for functions of the same coefficients.

    Raises
    ------
    BadInput
        If there is no part, n or the order is out of range, or coefficients overflow.

    Notes
    -----
    Smith (7.16)-(7.36) and (8.39)-(8.43) to any order and number of parameters, by Bloch's
    recursion (the module's docstring).
    """
    if not parts or not all(isinstance(part, PeriodicFunction) for part in parts):
        raise bad("parts", repr(parts)[:60], "periodic functions", "pass a list, even of one")
    check_region(n)
    if not is_whole(order, 1, HIGHEST_ORDER):
        raise bad("order", repr(order), f"a whole number from 1 to {HIGHEST_ORDER}", "correct it")
    key = tuple((part.a.tobytes(), part.b.tobytes()) for part in parts)
    return _operator(key, int(n), int(order), bool(damped))


@lru_cache(maxsize=256)
def _operator(key: _Key, n: int, order: int, damped: bool) -> EffectiveOperator:
    algebra = _Algebra(key, n, order // 2, damped)
    with np.errstate(over="ignore", invalid="ignore"):
        effective, _ = _recursion(algebra, order)
    diagonal = [np.array(a, dtype=complex) for a, _ in effective]
    coupling = [np.array(b, dtype=complex) for _, b in effective]
    # The mean of f commutes with everything: it moves lam2 and nothing else.
    diagonal[0][: len(algebra.means)] -= algebra.means
    if not all(np.all(np.isfinite(item)) for item in (*diagonal, *coupling)):
        raise bad(
            "effective_operator",
            "coefficients that overflow",
            "functions of moderate size",
            "move a common factor into the parameter",
        )
    count = len(key) + damped
    exponents = tuple(_monomials(count, k) for k in range(1, order + 1))
    for item in (*diagonal, *coupling):
        item.setflags(write=False)
    return EffectiveOperator(
        n, order, damped, exponents, tuple(diagonal), tuple(coupling), _key=key
    )


@lru_cache(maxsize=32)
def _columns(key: _Key, n: int, order: int, damped: bool) -> tuple[Index, tuple[Complex, ...]]:
    """Return the numbers of the harmonics and the whole columns of degree 0 ... order."""
    algebra = _Algebra(key, n, order, damped)
    _, omega = _recursion(algebra, order)
    columns = [np.array(item, dtype=complex) for item in (algebra.start, *omega)]
    for item in (algebra.harmonics, *columns):
        item.setflags(write=False)
    return algebra.harmonics, tuple(columns)


def _recursion(algebra: _Algebra, order: int) -> tuple[list[Couple], list[NDArray[Any]]]:
    """Run the emitted recursion; return ``h_1 ... h_order`` and ``Omega_1 ... Omega_order``."""
    emitted: Callable[..., tuple[list[Couple], list[NDArray[Any]]]]
    emitted = getattr(hill_recursion, f"order_{order}")
    return emitted(algebra.start, algebra.act, algebra.resolve, algebra.project, algebra.combine)


class _Algebra:
    """What the recursion acts on: one column of Omega, an array over monomials x harmonics.

    The harmonics run from ``-reach * H`` to ``n + reach * H`` with H the highest harmonic of the
    parts, those with ``reach`` steps from a resonant one.
    """

    def __init__(self, key: _Key, n: int, reach: int, damped: bool) -> None:
        pairs = [(np.frombuffer(a), np.frombuffer(b)) for a, b in key]
        self.means = np.array([a[0] for a, _ in pairs])
        self.taps = [_taps(a, b) for a, b in pairs]
        self.damped, self.count = damped, len(pairs) + damped
        radius = reach * max(len(taps) // 2 for taps in self.taps)
        self.harmonics = np.arange(-radius, n + radius + 1)
        self.resonant = (radius + n, radius) if n else (radius,)
        self.real = not damped and not any(np.iscomplexobj(taps) for taps in self.taps)
        self.start = np.zeros((1, len(self.harmonics)), dtype=float if self.real else complex)
        self.start[0, radius + n] = 1.0
        self.drag = -2j * (self.harmonics - 0.5 * n)
        levels = (self.harmonics * (self.harmonics - n)).astype(float)
        levels[list(self.resonant)] = -np.inf
        self.resolvent = -1.0 / levels

    def act(self, column: NDArray[Any]) -> NDArray[Any]:
        """Return V applied to a column: its degree rises by one."""
        rows, size = column.shape
        degree = _degree(rows, self.count)
        out = np.zeros((len(_monomials(self.count, degree + 1)), size), dtype=column.dtype)
        raised = _raised(self.count, degree)
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
        if len(self.resonant) == 1:
            own = column[:, self.resonant[0]]
            return own.real.copy(), np.zeros(len(own))
        return column[:, self.resonant[0]].copy(), column[:, self.resonant[1]].conj()

    def resolve(self, column: NDArray[Any]) -> NDArray[Any]:
        """Return R applied to a column."""
        out: NDArray[Any] = column * self.resolvent
        return out

    def combine(self, column: NDArray[Any], couple: Couple) -> NDArray[Any]:
        """Return ``Omega_j h_i``, for which the mirror of the column stands for the other one."""
        a, b = couple
        degrees = _degree(len(column), self.count), _degree(len(a), self.count)
        if self.count == 1:
            out: NDArray[Any] = a[0] * column
            if len(self.resonant) == 2:
                out += b[0].conj() * column[:, ::-1].conj()
            return out
        table = _product_table(self.count, *degrees)
        places = np.arange(len(column))[:, None]
        matrix = np.zeros((len(_monomials(self.count, sum(degrees))), len(column)), dtype=a.dtype)
        matrix[table, places] = a
        out = matrix @ column
        if len(self.resonant) == 2:
            matrix[table, places] = b.conj()
            out += matrix @ column[:, ::-1].conj()
        return out


def _taps(a: Array, b: Array) -> NDArray[Any]:
    """Return the Fourier coefficients c_-H ... c_H, real where all are, the mean left out."""
    c = 0.5 * (a - 1j * b) if np.any(b) else 0.5 * a
    c[0] = 0.0
    found = np.flatnonzero(c)
    c = c[: int(found[-1]) + 1 if found.size else 1]
    return np.concatenate([c[:0:-1].conj(), c])


@lru_cache(maxsize=256)
def _monomials(count: int, degree: int) -> Index:
    """Return the exponents of all monomials of a degree, the highest power of the first first."""
    chosen = list(combinations_with_replacement(range(count), degree))
    out = np.zeros((len(chosen), count), dtype=np.intp)
    for row, factors in zip(out, chosen, strict=True):
        for factor in factors:
            row[factor] += 1
    out.setflags(write=False)
    return out


@lru_cache(maxsize=256)
def _degree(size: int, count: int) -> int:
    """Return the degree that has so many monomials; with one parameter every degree has one."""
    if count == 1:
        return 1
    return next(k for k in range(2 * HIGHEST_ORDER) if len(_monomials(count, k)) == size)


@lru_cache(maxsize=1024)
def _product_table(count: int, first: int, second: int) -> Index:
    """Return the place of each product of two monomials, shape (M_first, M_second)."""
    place = {tuple(row): i for i, row in enumerate(_monomials(count, first + second).tolist())}
    sums = _monomials(count, first)[:, None] + _monomials(count, second)[None]
    return np.array([[place[tuple(row)] for row in rows] for rows in sums.tolist()], dtype=np.intp)


@lru_cache(maxsize=256)
def _raised(count: int, degree: int) -> Index:
    """Return the places of the monomials of a degree times each parameter, (count, M)."""
    return _product_table(count, 1, degree)


def _monomial_values(parameters: Array, order: int) -> Iterator[Array]:
    """Yield the values of the monomials of degree 1 ... order, shape (M_k, batch)."""
    count = len(parameters)
    values = parameters
    yield values
    for degree in range(2, order + 1):
        # A monomial is its first parameter times one of the degree before.
        first = np.argmax(_monomials(count, degree) > 0, axis=1)
        table = _raised(count, degree - 1)
        rest = np.empty(len(first), dtype=np.intp)
        for parameter in range(count):
            chosen = first == parameter
            rest[chosen] = np.argmax(table[parameter][:, None] == np.flatnonzero(chosen), axis=0)
        values = parameters[first] * values[rest]
        yield values
