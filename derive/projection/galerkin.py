"""Galerkin projection of linear continua on mode bases, closed in mode indices where it can be."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

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
from .bases import Basis
from .sums import ArraySum, Powers, mapped, plus, transposed, vanishes


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
