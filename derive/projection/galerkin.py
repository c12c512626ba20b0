"""Galerkin projection of linear continua on mode bases, closed in the mode indices where it can be.

Two independent routes lead to the same arrays: the strong field equation with its natural
conditions as residuals (:func:`project`), and the quadratic action itself
(:func:`project_action`).
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from ..arrays import BasisEntry
from ..jets import linear_jets, quadratic_jets
from ..lagrange import NotRepresentable
from ..records import (
    ActionDensity,
    ArrayEntry,
    CrankMotion,
    DiscreteSystem,
    FieldEquations,
    IndexedEntry,
    IndexedVector,
)
from ..variational import drag_by_order
from .bases import Basis, FiniteBasis, IndexedBasis, sine_basis
from .sums import ArraySum, Powers, mapped, plus, transposed, vanishes

__all__ = [
    "Basis",
    "FiniteBasis",
    "IndexedBasis",
    "antisymmetric_gauge",
    "divided",
    "mass_normalised",
    "modal_terms",
    "project",
    "project_action",
    "sine_basis",
    "tidy",
]


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


def project_action(
    action: ActionDensity,
    item: sp.Expr,
    basis: Basis,
    crank: CrankMotion,
    *,
    followers: Mapping[sp.Expr, sp.Expr] | None = None,
    geometric: Iterable[sp.Symbol] = (),
) -> DiscreteSystem:
    """Substitute the expansion into a quadratic action and read off the arrays.

    Parameters
    ----------
    action : ActionDensity
        At most quadratic in the field, whose first time derivative is the highest (see
        :func:`.variational.quadratic_action`).
    item, basis, crank, followers, geometric
        As for :func:`project`.

    Raises
    ------
    ValueError
        If the action is not quadratic, or the basis violates an essential condition.
    NotRepresentable
        If a term has no place in the family.
    """
    _check_essential(action, item, basis)
    arrays = ArraySum(crank, action.t, followers or {}, tuple(geometric))
    momenta = ArraySum(crank, action.t, followers or {}, ())
    _add_energy(arrays, momenta, basis, action.density, item, None)
    for term in action.point_terms:
        _add_energy(arrays, momenta, basis, term.expression, item, sp.sympify(term.position))
    for name, entry in momenta.entries.items():
        slope = mapped(entry, lambda e: sp.expand(-crank.derivative(e)))
        arrays.add("f" if name == "td qd" else "h", slope)
        if name == "td qd":
            arrays.add("g", mapped(entry, lambda e: -e))
    side = _ForceSide(arrays, basis, item)
    if item in action.force_density:
        side.add(action.force_density[item], 0, None)
    for k, drag in drag_by_order(action, item):
        side.add(drag, k, None)
    for force in action.end_forces:
        if force.field == item:
            side.add(force.force, force.order, sp.sympify(force.position))
    return side.system()


def _add_energy(
    arrays: ArraySum,
    momenta: ArraySum,
    basis: Basis,
    energy: sp.Expr,
    item: sp.Expr,
    at: sp.Expr | None,
) -> None:
    """Add a part of the Lagrangian; momenta collects what is linear in the velocities."""
    if at is not None and sp.diff(at, arrays.t) != 0:
        raise NotRepresentable(f"a point term that moves along the link ({at}) is not projected")
    quadratic, linear = quadratic_jets(energy, item)
    for ((k, j), (k_2, j_2)), coefficient in sorted(quadratic.items()):
        if max(j, j_2) > 1:
            raise NotRepresentable(f"second time derivatives of {item} in the action")
        if (j, j_2) == (0, 1):
            continue
        for powers, weight in arrays.by_powers(coefficient).items():
            for name, value in _energy_targets(arrays, weight, (j, j_2), powers):
                arrays.add(name, basis.bilinear(value, (k, k_2), at))
    for (k, j), coefficient in sorted(linear.items()):
        for powers, weight in arrays.by_powers(coefficient).items():
            if j == 0:
                arrays.add(arrays.forcing(powers, weight), basis.single(weight, k, at))
            elif powers in ((0, 0), (1, 0)) and j == 1:
                name = "td qd" if powers[0] else "qd"
                momenta.add(name, basis.single(weight, k, at))
            else:
                raise NotRepresentable(f"momentum {weight} with rate powers {powers}")


def _energy_targets(
    arrays: ArraySum, weight: sp.Expr, rates: tuple[int, int], powers: Powers
) -> list[tuple[str, sp.Expr]]:
    if rates == (0, 0):
        return arrays.stiffness(weight, powers)
    name = {((1, 1), (0, 0)): "M", ((1, 0), (1, 0)): "A"}.get((rates, powers))
    if name is None:
        raise NotRepresentable(f"{weight}: time derivatives {rates} with rate powers {powers}")
    return [(name, weight)]


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


def modal_terms(entry: ArrayEntry) -> tuple[tuple[sp.Expr, ArrayEntry], ...]:
    """Split indexed entries into (factor free of the indices) times (array of the indices alone).

    ``entry``: an array of a projected system. Result: their products sum up to the entries; factors
    that share an array are put together. Raises ``TypeError`` if the entry is an explicit matrix.
    """
    if isinstance(entry, IndexedVector):
        vector = _by_shape(_by_cofactor(entry.entry, (entry.m,)))
        return tuple((outer, IndexedVector(shape, entry.m)) for shape, outer in vector.items())
    if not isinstance(entry, IndexedEntry):
        raise TypeError("an explicit matrix has no mode indices")
    indices = (entry.m, entry.n)
    diagonal = _by_cofactor(entry.diagonal, indices)
    other = _by_cofactor(entry.off_diagonal, indices)
    grouped: dict[tuple[sp.Expr, sp.Expr], sp.Expr] = {}
    for outer in dict.fromkeys([*diagonal, *other]):
        on, off = diagonal.get(outer, sp.S.Zero), other.get(outer, sp.S.Zero)
        number = (on if on != 0 else off).as_coeff_Mul()[0]
        if number == 0:
            continue
        key = (on / number, off / number)
        grouped[key] = grouped.get(key, sp.S.Zero) + number * outer
    return tuple(
        (outer, IndexedEntry(on, off, entry.m, entry.n)) for (on, off), outer in grouped.items()
    )


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


def antisymmetric_gauge(system: DiscreteSystem) -> DiscreteSystem:
    """Remove the symmetric part of A, which is a total time derivative up to B and S.

    The Lagrangian changes by ``d/dt (td q^T P q / 2)`` with ``P = (A + A^T)/2``: A, B and S become
    ``A - P``, ``B - P'`` and ``S - P``, and the equation of motion stays the same.
    """
    if not system.has("A"):
        return system
    crank, entries = system.crank, dict(system.arrays)
    even = mapped(plus(entries["A"], transposed(entries["A"])), lambda e: sp.expand(e / 2))
    if vanishes(even):
        return system
    slope = mapped(even, lambda e: sp.expand(crank.derivative(e)))
    for name, part in (("A", even), ("B", slope), ("S", even)):
        minus = mapped(part, lambda e: -e)
        entries[name] = tidy(plus(entries[name], minus) if name in entries else minus)
    return system.with_(arrays=entries)
