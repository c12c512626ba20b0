"""Galerkin projection of linear continua on mode bases, closed in mode indices where it can be."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

import sympy as sp

from ..arrays import (
    ArrayEntry,
    BasisEntry,
    CrankMotion,
    DiscreteSystem,
    IndexedEntry,
    IndexedVector,
)
from ..jets import linear_jets
from ..lagrange import NotRepresentable
from ..records import ActionDensity, FieldEquations
from ..variational import in_crank_angle
from .bases import Basis

Powers: TypeAlias = tuple[int, int]
_STIFFNESS: dict[Powers, str] = {(0, 0): "K", (2, 0): "B", (0, 1): "S"}
_FORCING: dict[Powers, str] = {(2, 0): "f", (1, 0): "h", (0, 1): "g", (0, 0): "p"}


@dataclass
class ArraySum:
    """Arrays being summed up, by name."""

    crank: CrankMotion
    t: sp.Symbol
    followers: Mapping[sp.Expr, sp.Expr]
    geometric: tuple[sp.Symbol, ...]
    entries: dict[str, ArrayEntry] = field(default_factory=dict)

    def by_powers(self, weight: sp.Expr) -> dict[Powers, sp.Expr]:
        """Split a coefficient by powers of the crank's rate and acceleration."""
        plain = in_crank_angle(weight, self.crank, self.t, self.followers)
        rates = (self.crank.rate, self.crank.acceleration)
        split: dict[Powers, sp.Expr] = {}
        for term in sp.Add.make_args(sp.expand(plain)):
            rest, powers = term, [0, 0]
            for index, rate in enumerate(rates):
                rest, exponent = rest.as_coeff_exponent(rate)
                if rest.has(rate) or not (exponent.is_Integer and exponent >= 0):
                    raise NotRepresentable(f"{term} is no polynomial in {rates}")
                powers[index] = int(exponent)
            key = (powers[0], powers[1])
            split[key] = split.get(key, sp.S.Zero) + rest
        return {key: value for key, value in split.items() if value != 0}

    def add(self, name: str, entry: ArrayEntry) -> None:
        """Add to an array."""
        known = self.entries.get(name)
        self.entries[name] = entry if known is None else plus(known, entry)

    def stiffness(self, weight: sp.Expr, powers: Powers) -> list[tuple[str, sp.Expr]]:
        """Return where a displacement term of the force side goes, with its sign."""
        name = _STIFFNESS.get(powers)
        if name is None:
            raise NotRepresentable(f"stiffness {weight} with rate powers {powers} has no array")
        if name != "K":
            return [(name, weight)]
        terms = sp.Add.make_args(sp.expand(weight))
        moved = sp.Add(*(e for e in terms if self.geometric and e.has(*self.geometric)))
        parts = [("K", -sp.expand(weight - moved)), ("Kg", -moved)]
        return [(key, value) for key, value in parts if value != 0]

    def forcing(self, powers: Powers, what: sp.Expr) -> str:
        """Return where a force goes."""
        name = _FORCING.get(powers)
        if name is None:
            raise NotRepresentable(f"force {what} with rate powers {powers} has no array")
        return name


def plus(a: ArrayEntry, b: ArrayEntry) -> ArrayEntry:
    """Return the sum of two arrays of one kind."""
    if isinstance(a, IndexedEntry) and isinstance(b, IndexedEntry):
        return a.plus(b)
    if isinstance(a, IndexedVector) and isinstance(b, IndexedVector):
        return a.plus(b)
    if isinstance(a, BasisEntry) and isinstance(b, BasisEntry):
        return a.plus(b)
    return _explicit(a) + _explicit(b)


def _explicit(entry: ArrayEntry) -> sp.ImmutableDenseMatrix:
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        raise TypeError(f"{entry} is not an explicit matrix")
    return entry


def mapped(entry: ArrayEntry, function: Callable[[sp.Expr], sp.Expr]) -> ArrayEntry:
    """Return an array with a function applied to each entry."""
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        return entry.map(function)
    return entry.applyfunc(function)


def transposed(entry: ArrayEntry) -> ArrayEntry:
    """Return the transposed matrix."""
    return entry.transposed() if isinstance(entry, IndexedEntry) else _explicit(entry).T


def vanishes(entry: ArrayEntry) -> bool:
    """Return True where every entry vanishes identically."""
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        return entry.is_zero
    return all(item == 0 for item in entry)


def project(
    equations: FieldEquations,
    item: sp.Expr,
    basis: Basis,
    crank: CrankMotion,
    *,
    followers: Mapping[sp.Expr, sp.Expr] | None = None,
    geometric: Iterable[sp.Symbol] = (),
) -> DiscreteSystem:
    """Project the strong field equation on a basis (Galerkin).

    The residual of the field equation is weighted with each shape function; the residuals of the
    natural conditions, and what acts at interior points, are weighted with its end values.

    Parameters
    ----------
    equations : FieldEquations
        Linear in the field.
    item : Expr
        The field.
    basis : Basis
        Shape functions that satisfy the essential conditions.
    crank : CrankMotion
        Crank angle and rates.
    followers : mapping, optional
        Applied function of time to its value in plain symbols.
    geometric : iterable of Symbol
        Stiffness terms that contain one of these symbols go to Kg instead of K.

    Returns
    -------
    DiscreteSystem
        Its gyroscopic matrix is held as ``A = (G - G^T)/4``; a symmetric part of G beyond M' is
        damping proportional to the crank's rate.

    Raises
    ------
    ValueError
        If the equation is not linear, or the basis violates an essential condition.
    NotRepresentable
        If a term has no place in the family.
    """
    action = equations.action
    _check_essential(action, item, basis)
    arrays = ArraySum(crank, action.t, followers or {}, tuple(geometric))
    side = _ForceSide(arrays, basis, item)
    side.add(equations.equations[item], 0, None)
    for condition in equations.natural:
        if condition.field == item:
            side.add(condition.expression, condition.order, condition.position)
    for jump in equations.jumps:
        if jump.field == item:
            side.add(jump.applied, jump.order, jump.position)
    return side.system()


@dataclass
class _ForceSide:
    """Sums up ``-M qdd - (C + td G) qd - ... + forces``, and reads the arrays off the sum."""

    arrays: ArraySum
    basis: Basis
    item: sp.Expr

    def add(self, expression: sp.Expr, varied: int, at: sp.Expr | None) -> None:
        """Add an expression that works on derivative ``varied`` of the varied field."""
        coefficients, rest = linear_jets(expression, self.item)
        for (k, j), coefficient in sorted(coefficients.items()):
            for powers, weight in self.arrays.by_powers(coefficient).items():
                for name, value in self._targets(weight, j, powers):
                    self.arrays.add(name, self.basis.bilinear(value, (varied, k), at))
        for powers, weight in self.arrays.by_powers(rest).items():
            name = self.arrays.forcing(powers, weight)
            self.arrays.add(name, self.basis.single(weight, varied, at))

    def _targets(self, weight: sp.Expr, j: int, powers: Powers) -> list[tuple[str, sp.Expr]]:
        if j == 0 and powers == (1, 0):
            return [("D", -weight)]
        if j == 0:
            return self.arrays.stiffness(weight, powers)
        if j == 1 and powers == (1, 0):
            return [("G", -weight)]
        if j == 1 and powers[1] == 0:
            return [("C", -weight * self.arrays.crank.rate ** powers[0])]
        if j == 2 and powers == (0, 0):
            return [("M", -weight)]
        raise NotRepresentable(f"{weight}: time derivative {j} with rate powers {powers}")

    def system(self) -> DiscreteSystem:
        """Return the arrays; H and E of the second-order form become B and S."""
        arrays, entries = self.arrays, self.arrays.entries
        crank = arrays.crank
        gyroscopic = entries.pop("G", None)
        if "M" in entries:
            slope = mapped(entries["M"], lambda e: sp.expand(crank.derivative(e)))
            if not vanishes(slope):
                minus = mapped(slope, lambda e: -e)
                gyroscopic = minus if gyroscopic is None else plus(gyroscopic, minus)
        if gyroscopic is not None:
            flipped = transposed(gyroscopic)
            half = mapped(plus(gyroscopic, mapped(flipped, lambda e: -e)), _quarter)
            even = mapped(plus(gyroscopic, flipped), lambda e: sp.expand(e * crank.rate / 2))
            if not vanishes(half):
                arrays.add("A", half)
                arrays.add("S", half)
                slope = mapped(half, lambda e: sp.expand(crank.derivative(e)))
                arrays.add("B", slope)
            if not vanishes(even):
                arrays.add("C", even)
        return _finished(arrays, self.basis)


def _quarter(expression: sp.Expr) -> sp.Expr:
    return sp.expand(expression / 4)


def _check_essential(action: ActionDensity, item: sp.Expr, basis: Basis) -> None:
    for position, order in action.held(item):
        values = basis.single(sp.S.One, order, sp.sympify(position))
        if not vanishes(mapped(values, sp.expand)):
            raise ValueError(
                f"the basis does not vanish at {position} (derivative {order}): {values}"
            )


def _finished(arrays: ArraySum, basis: Basis) -> DiscreteSystem:
    modes = basis.modes
    entries = {name: tidy(entry) for name, entry in arrays.entries.items()}
    labels = () if modes is None else tuple(f"q{i + 1}" for i in range(modes))
    return DiscreteSystem(arrays.crank, modes, entries, labels)


def tidy(entry: ArrayEntry) -> ArrayEntry:
    """Return the same entries with like terms collected and functions of the indices factored."""
    if isinstance(entry, IndexedEntry):
        indices = (entry.m, entry.n)
        return entry.map(lambda e: _tidy(e, indices))
    if isinstance(entry, IndexedVector):
        index = (entry.m,)
        return entry.map(lambda e: _tidy(e, index))
    if isinstance(entry, BasisEntry):
        return entry.map(sp.factor_terms)
    return entry.applyfunc(sp.expand)


def _by_cofactor(expression: sp.Expr, indices: tuple[sp.Symbol, ...]) -> dict[sp.Expr, sp.Expr]:
    """Split into sum of (factor free of the indices) times (factored function of the indices)."""
    rough: dict[sp.Expr, sp.Expr] = {}
    for term in sp.Add.make_args(sp.expand(expression)):
        outer, inner = term.as_independent(*indices, as_Add=False)
        number, outer = outer.as_coeff_Mul()
        rough[outer] = rough.get(outer, sp.S.Zero) + number * inner
    table: dict[sp.Expr, sp.Expr] = {}
    for outer, inner in rough.items():
        more, shape = sp.factor(inner).as_independent(*indices, as_Add=False)
        number, more = more.as_coeff_Mul()
        known = table.get(outer * more)
        table[outer * more] = number * shape if known is None else sp.factor(known + number * shape)
    return table


def _tidy(expression: sp.Expr, indices: tuple[sp.Symbol, ...]) -> sp.Expr:
    grouped = _by_shape(_by_cofactor(expression, indices))
    return sp.Add(*(sp.factor_terms(outer) * shape for shape, outer in grouped.items()))


def _by_shape(table: dict[sp.Expr, sp.Expr]) -> dict[sp.Expr, sp.Expr]:
    """Turn the split around: function of the indices to its cofactor."""
    grouped: dict[sp.Expr, sp.Expr] = {}
    for outer, inner in table.items():
        number, shape = inner.as_coeff_Mul()
        grouped[shape] = grouped.get(shape, sp.S.Zero) + number * outer
    return grouped


def divided(system: DiscreteSystem, divisor: sp.Expr) -> DiscreteSystem:
    """Return the system with every array divided by the same quantity."""

    def divide(expression: sp.Expr, indices: tuple[sp.Symbol, ...]) -> sp.Expr:
        total = sp.S.Zero
        for term in sp.Add.make_args(expression):
            outer, shape = term.as_independent(*indices, as_Add=False)
            total += sp.factor_terms(sp.expand(outer / divisor)) * shape
        return total

    arrays: dict[str, ArrayEntry] = {}
    for name, entry in system.arrays.items():
        indices: tuple[sp.Symbol, ...] = ()
        if isinstance(entry, IndexedEntry):
            indices = (entry.m, entry.n)
        elif isinstance(entry, IndexedVector):
            indices = (entry.m,)
        arrays[name] = mapped(entry, functools.partial(divide, indices=indices))
    return system.with_(arrays=arrays)


def mass_normalised(system: DiscreteSystem) -> DiscreteSystem:
    """Divide by the modal mass, so that M becomes the identity.

    Raises
    ------
    ValueError
        If M is not a multiple of the identity.
    """
    mass = system.arrays["M"]
    if isinstance(mass, IndexedEntry):
        value = mass.diagonal
        ok = mass.off_diagonal == 0 and not value.has(mass.m)
    else:
        explicit = system.matrix("M")
        value = explicit[0, 0]
        ok = explicit == value * sp.eye(explicit.shape[0])
    if not ok:
        raise ValueError(f"the mass matrix {mass} is not a multiple of the identity")
    return divided(system, value)
