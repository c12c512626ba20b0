"""Arrays of the linear periodic family, explicit or closed in the mode indices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TypeAlias

import sympy as sp

MATRICES = ("M", "A", "B", "S", "C", "D", "K", "Kg")
VECTORS = ("f", "h", "g", "p")


@dataclass(frozen=True)
class CrankMotion:
    """The prescribed crank angle theta(t), and how other prescribed quantities follow it.

    Attributes
    ----------
    theta : Symbol
        Crank angle [rad].
    rate, acceleration : Symbol
        ``td = d theta / dt`` [rad/s] and ``tdd = d^2 theta / dt^2`` [rad/s^2].
    chain : mapping
        Symbol that depends on theta to its derivative with respect to theta; for example
        ``{theta3: omega3, omega3: alpha3}`` with omega3 and alpha3 per unit crank speed.
    """

    theta: sp.Symbol
    rate: sp.Symbol
    acceleration: sp.Symbol
    chain: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Freeze the mapping."""
        object.__setattr__(self, "chain", MappingProxyType(dict(self.chain)))

    def derivative(self, expression: sp.Expr) -> sp.Expr:
        """Return the total derivative of ``expression`` with respect to the crank angle.

        ``expression``: in theta, the symbols of the chain and constants. Raises ``ValueError`` if
        the expression contains a symbol at which the chain ends.
        """
        stuck = sorted(str(s) for s in expression.free_symbols & set(self.chain_ends()))
        if stuck:
            raise ValueError(f"no derivative with respect to {self.theta} is known of {stuck}")
        total = sp.diff(expression, self.theta)
        for symbol, slope in self.chain.items():
            total += sp.diff(expression, symbol) * slope
        return total

    def chain_ends(self) -> tuple[sp.Symbol, ...]:
        """Return the symbols that follow the crank but whose derivative is not known."""
        slopes = {slope for slope in self.chain.values() if slope.is_Symbol}
        unknown = slopes - {self.theta, *self.chain}
        return tuple(sorted(unknown, key=lambda s: s.name))


@dataclass(frozen=True)
class IndexedEntry:
    """Entries of a matrix closed in the mode indices.

    Attributes
    ----------
    diagonal : Expr
        Entry (m, m) as a function of the integer symbol ``m >= 1``.
    off_diagonal : Expr
        Entry (m, n), valid for integers ``m != n``.
    m, n : Symbol
        The index symbols.
    """

    diagonal: sp.Expr
    off_diagonal: sp.Expr
    m: sp.Symbol
    n: sp.Symbol

    def matrix(self, modes: int) -> sp.ImmutableDenseMatrix:
        """Return the explicit matrix of shape ``(modes, modes)``."""
        return sp.ImmutableDenseMatrix(
            modes,
            modes,
            lambda i, j: (
                self.diagonal.subs(self.m, i + 1)
                if i == j
                else self.off_diagonal.subs({self.m: i + 1, self.n: j + 1}, simultaneous=True)
            ),
        )

    def map(self, function: Callable[[sp.Expr], sp.Expr]) -> IndexedEntry:
        """Return the entries with a function applied to each."""
        return replace(
            self, diagonal=function(self.diagonal), off_diagonal=function(self.off_diagonal)
        )

    def plus(self, other: IndexedEntry) -> IndexedEntry:
        """Return the sum with another matrix in the same index symbols."""
        if (self.m, self.n) != (other.m, other.n):
            raise ValueError(f"index symbols differ: {(self.m, self.n)}, {(other.m, other.n)}")
        return replace(
            self,
            diagonal=self.diagonal + other.diagonal,
            off_diagonal=self.off_diagonal + other.off_diagonal,
        )

    def transposed(self) -> IndexedEntry:
        """Return the transposed matrix."""
        swap = {self.m: self.n, self.n: self.m}
        return replace(self, off_diagonal=self.off_diagonal.subs(swap, simultaneous=True))

    @property
    def is_zero(self) -> bool:
        """True where every entry vanishes identically."""
        return bool(self.diagonal == 0 and self.off_diagonal == 0)


@dataclass(frozen=True)
class IndexedVector:
    """Entries of a vector closed in the mode index.

    Attributes
    ----------
    entry : Expr
        Entry m as a function of the integer symbol ``m >= 1``.
    m : Symbol
        The index symbol.
    """

    entry: sp.Expr
    m: sp.Symbol

    def matrix(self, modes: int) -> sp.ImmutableDenseMatrix:
        """Return the explicit column of shape ``(modes, 1)``."""
        return sp.ImmutableDenseMatrix(modes, 1, lambda i, _: self.entry.subs(self.m, i + 1))

    def map(self, function: Callable[[sp.Expr], sp.Expr]) -> IndexedVector:
        """Return the entries with a function applied to each."""
        return replace(self, entry=function(self.entry))

    def plus(self, other: IndexedVector) -> IndexedVector:
        """Return the sum with another vector in the same index symbol."""
        if self.m != other.m:
            raise ValueError(f"index symbols differ: {self.m}, {other.m}")
        return replace(self, entry=self.entry + other.entry)

    @property
    def is_zero(self) -> bool:
        """True where every entry vanishes identically."""
        return bool(self.entry == 0)


@dataclass(frozen=True)
class BasisIntegral:
    """An integral from 0 to 1 over shapes ``e_i(eta; xi)`` that are passed in.

    ``int weight d^(k+l) e_i/(d eta^k d xi^l) d^(m+n) e_j/(d eta^m d xi^n) d eta``, eta and xi being
    fractions of a length; or the integrand at a point; or, without the second factor, a vector.

    Attributes
    ----------
    name : str
        Under which the caller passes it in.
    weight : Expr
        Polynomial in ``eta``, the integration variable.
    eta : Symbol
        The integration variable.
    row : tuple of int
        Derivatives (k, l) of the first factor.
    column : tuple of int or None
        Derivatives (m, n) of the second factor; None where there is none.
    at : Expr or None
        The value of eta at which the integrand is taken; None for an integral.
    """

    name: str
    weight: sp.Expr
    eta: sp.Symbol
    row: tuple[int, int]
    column: tuple[int, int] | None = None
    at: sp.Expr | None = None


@dataclass(frozen=True)
class BasisProduct:
    """A matrix made of products of integrals with one factor each.

    Attributes
    ----------
    name : str
        Of the matrix.
    form : Expr
        Entry (i, j), bilinear in the symbols of the two factors below.
    rows, columns : mapping
        Symbol to the integral whose entry i (or j) it stands for.
    """

    name: str
    form: sp.Expr
    rows: Mapping[sp.Symbol, BasisIntegral]
    columns: Mapping[sp.Symbol, BasisIntegral]

    def __post_init__(self) -> None:
        """Freeze the mappings."""
        object.__setattr__(self, "rows", MappingProxyType(dict(self.rows)))
        object.__setattr__(self, "columns", MappingProxyType(dict(self.columns)))

    def __hash__(self) -> int:
        """Return the hash of name and form."""
        return hash((self.name, self.form))


@dataclass(frozen=True)
class BasisEntry:
    """An array as a sum of coefficients times integrals over shapes that are passed in.

    Attributes
    ----------
    terms : tuple of (Expr, BasisIntegral or BasisProduct)
        Coefficients, free of the shapes, and what they multiply.
    """

    terms: tuple[tuple[sp.Expr, BasisIntegral | BasisProduct], ...]

    def map(self, function: Callable[[sp.Expr], sp.Expr]) -> BasisEntry:
        """Return the entries with a function applied to each coefficient."""
        return BasisEntry(tuple((function(value), what) for value, what in self.terms))

    def plus(self, other: BasisEntry) -> BasisEntry:
        """Return the sum; coefficients of the same integral are added up."""
        total: dict[BasisIntegral | BasisProduct, sp.Expr] = {}
        for value, what in (*self.terms, *other.terms):
            total[what] = total.get(what, sp.S.Zero) + value
        return BasisEntry(tuple((value, what) for what, value in total.items()))

    @property
    def is_zero(self) -> bool:
        """True where every coefficient vanishes identically."""
        return all(value == 0 for value, _ in self.terms)


ArrayEntry: TypeAlias = "IndexedEntry | IndexedVector | BasisEntry | sp.ImmutableDenseMatrix"


@dataclass(frozen=True)
class DiscreteSystem:
    """Arrays of the linear periodic family, from a quadratic Lagrangian.

    ::

        L2 = 1/2 qd^T M qd + td qd^T A q + 1/2 td^2 q^T B q + 1/2 tdd q^T S q
             - 1/2 q^T (K + Kg) q,      forces  -C qd - td D q + td^2 f + td h + tdd g + p

    with td, tdd the rate and acceleration of the crank angle; then

    ::

        M qdd + (C + td G) qd + (K + Kg + td D + td^2 H + tdd E) q = td^2 f + td h + tdd g + p,
        G = M' + A - A^T,   H = A' - B,   E = A - S,   ' = d/d theta.

    Attributes
    ----------
    crank : CrankMotion
        The crank angle, its rates, and the quantities that follow it.
    modes : int or None
        Number of degrees of freedom; None where the arrays are closed in the mode indices or made
        of integrals over shapes that are passed in.
    arrays : mapping
        Name (``M A B S C D K Kg f h g p``) to explicit matrix, indexed entries or integrals over
        shapes; an array that is not listed is zero.
    labels : tuple of str
        One name per degree of freedom, where their number is known.
    """

    crank: CrankMotion
    modes: int | None
    arrays: Mapping[str, ArrayEntry]
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse unknown arrays and wrong shapes; drop arrays that vanish."""
        kept: dict[str, ArrayEntry] = {}
        for name, entry in self.arrays.items():
            if name not in MATRICES + VECTORS:
                raise ValueError(f"unknown array {name!r}; expected one of {MATRICES + VECTORS}")
            if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
                zero = entry.is_zero
            else:
                width = self.modes if name in MATRICES else 1
                if entry.shape != (self.modes, width):
                    raise ValueError(f"array {name}: shape {entry.shape}, not {self.modes, width}")
                zero = all(item == 0 for item in entry)
            if not zero:
                kept[name] = entry
        ordered = {name: kept[name] for name in MATRICES + VECTORS if name in kept}
        object.__setattr__(self, "arrays", MappingProxyType(ordered))

    def has(self, name: str) -> bool:
        """Return True where the array is not zero."""
        return name in self.arrays

    def matrix(self, name: str, modes: int | None = None) -> sp.ImmutableDenseMatrix:
        """Return an array as an explicit matrix, zeros where it is absent.

        ``name``: name of the array; ``modes``: number of modes; needed where the arrays are closed
        in the mode indices. Raises ``ValueError`` if the number of modes is needed and not given,
        or contradicts the system's own, or the array consists of integrals over shapes that are
        passed in.
        """
        size = self.modes if modes is None else modes
        if size is None:
            raise ValueError(f"array {name} is closed in the mode indices; say how many modes")
        if self.modes is not None and size != self.modes:
            raise ValueError(f"the system has {self.modes} modes, not {size}")
        if name not in self.arrays:
            return sp.ImmutableDenseMatrix.zeros(size, size if name in MATRICES else 1)
        entry = self.arrays[name]
        if isinstance(entry, BasisEntry):
            raise ValueError(f"array {name} consists of integrals over shapes that are passed in")
        if isinstance(entry, IndexedEntry | IndexedVector):
            return entry.matrix(size)
        return entry

    def with_(self, **changes: object) -> DiscreteSystem:
        """Return a copy with some attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]
