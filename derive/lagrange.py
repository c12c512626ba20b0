"""Lagrange's equations by machine, and the linear arrays of quadratic Lagrangians or equations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.core.function import AppliedUndef

from .arrays import MATRICES, VECTORS, CrankMotion, DiscreteSystem
from .records import EquationsOfMotion, Lagrangian, VariationalEquations
from .variational import in_crank_angle


class NotRepresentable(ValueError):  # noqa: N818 - reads as what it is
    """A Lagrangian has terms that the arrays of the family cannot hold; the message shows them."""


def _plain_names(
    coordinates: Sequence[sp.Expr], t: sp.Symbol
) -> tuple[list[sp.Symbol], list[sp.Symbol], dict[sp.Expr, sp.Symbol]]:
    names = [coordinate.func.__name__ for coordinate in coordinates]
    positions = [sp.Symbol(name) for name in names]
    velocities = [sp.Symbol(f"{name}_dot") for name in names]
    table: dict[sp.Expr, sp.Symbol] = dict(zip(coordinates, positions, strict=True))
    table |= {
        sp.Derivative(coordinate, t): velocity
        for coordinate, velocity in zip(coordinates, velocities, strict=True)
    }
    return positions, velocities, table


def _enter(
    expression: sp.Expr, table: Mapping[sp.Expr, sp.Symbol], coordinates: Iterable[sp.Expr]
) -> sp.Expr:
    """Replace coordinates and velocities by plain symbols."""
    expression = sp.sympify(expression).doit(integrals=False)
    unknown = set(coordinates)
    wrong = [d for d in expression.atoms(sp.Derivative) if d.expr in unknown and d not in table]
    if wrong:
        raise ValueError(f"{wrong[0]}: only first time derivatives of coordinates may occur")
    entered = expression.xreplace(table)
    kinds = {coordinate.func for coordinate in unknown}
    stray = [f for f in entered.atoms(AppliedUndef) if f.func in kinds]
    if stray:
        raise ValueError(f"{stray[0]}: coordinates may be taken at the present time only")
    return entered


def euler_lagrange(lagrangian: Lagrangian) -> EquationsOfMotion:
    """Derive ``M qdd + c = Phi_q^T lam + Q`` with its constraints from a Lagrangian.

    Parameters
    ----------
    lagrangian : Lagrangian
        Energies, holonomic constraints, generalised forces, prescribed motions.

    Returns
    -------
    EquationsOfMotion
        In plain symbols; the velocity of the coordinate ``s(t)`` is called ``s_dot``.  Functions
        of time that are not coordinates count as prescribed and are differentiated as such.

    Raises
    ------
    ValueError
        If accelerations occur in the Lagrangian, or velocities in a constraint.
    """
    t, unknowns = lagrangian.t, lagrangian.coordinates
    q, qd, table = _plain_names(unknowns, t)

    def enter(expression: sp.Expr) -> sp.Expr:
        given = sp.sympify(expression).subs(dict(lagrangian.prescribed))
        return _enter(given, table, unknowns)

    energy = enter(lagrangian.expression)
    momenta = [sp.diff(energy, velocity) for velocity in qd]
    mass = sp.ImmutableDenseMatrix(len(q), len(q), lambda i, j: sp.diff(momenta[i], qd[j]))
    rest = [
        _along(momentum, q, qd, t) - sp.diff(energy, position)
        for momentum, position in zip(momenta, q, strict=True)
    ]
    forces = [enter(lagrangian.forces.get(unknown, sp.S.Zero)) for unknown in unknowns]
    phi = [enter(constraint) for constraint in lagrangian.constraints]
    if any(constraint.has(*qd) for constraint in phi):
        raise ValueError("constraints must be holonomic: a velocity occurs in one")
    rate = [_along(constraint, q, qd, t) for constraint in phi]
    gamma = [-_along(expression, q, qd, t) for expression in rate]
    return EquationsOfMotion(
        t=t,
        coordinates=tuple(q),
        velocities=tuple(qd),
        multipliers=lagrangian.multipliers,
        mass=mass,
        rest=_column(rest),
        forces=_column(forces),
        constraints=_column(phi),
        jacobian=sp.ImmutableDenseMatrix(len(phi), len(q), lambda i, j: sp.diff(phi[i], q[j])),
        velocity_rhs=_column([-sp.diff(constraint, t) for constraint in phi]),
        gamma=_column(gamma),
        lagrangian=lagrangian,
    )


def _along(
    expression: sp.Expr, q: Sequence[sp.Symbol], qd: Sequence[sp.Symbol], t: sp.Symbol
) -> sp.Expr:
    """Differentiate in time at fixed velocities."""
    total = sp.diff(expression, t)
    for position, velocity in zip(q, qd, strict=True):
        total += sp.diff(expression, position) * velocity
    return total


def _column(entries: Sequence[sp.Expr]) -> sp.ImmutableDenseMatrix:
    return sp.ImmutableDenseMatrix(len(entries), 1, list(entries))


def variational_equations(equations: EquationsOfMotion) -> VariationalEquations:
    """Linearise constrained equations about a motion.

    Parameters
    ----------
    equations : EquationsOfMotion
        Nonlinear equations.

    Returns
    -------
    VariationalEquations
        Damping and stiffness of the linearised motion, and the rates of the Jacobian along the
        motion; the acceleration of ``s`` is ``s_ddot``.
    """
    accelerations = tuple(sp.Symbol(f"{q.name}_ddot") for q in equations.coordinates)
    q, qdd = list(equations.coordinates), _column(accelerations)
    residual = equations.mass * qdd + equations.rest - equations.forces
    damping = residual.jacobian(list(equations.velocities))
    rate = acceleration = sp.zeros(0, len(q))
    if equations.multipliers:
        residual -= equations.jacobian.T * _column(equations.multipliers)
        velocity = equations.jacobian * _column(equations.velocities) - equations.velocity_rhs
        rate = velocity.jacobian(q)
        acceleration = (equations.jacobian * qdd - equations.gamma).jacobian(q)
    return VariationalEquations(
        accelerations,
        sp.ImmutableDenseMatrix(damping),
        sp.ImmutableDenseMatrix(residual.jacobian(q)),
        sp.ImmutableDenseMatrix(rate),
        sp.ImmutableDenseMatrix(acceleration),
    )


def quadratic_form(
    lagrangian: sp.Expr,
    coordinates: Sequence[sp.Expr],
    crank: CrankMotion,
    t: sp.Symbol,
    *,
    forces: Mapping[sp.Expr, sp.Expr] | None = None,
    geometric: Iterable[sp.Symbol] = (),
) -> DiscreteSystem:
    """Read the arrays of the linear periodic family off a quadratic Lagrangian.

    Parameters
    ----------
    lagrangian : Expr
        At most quadratic in the coordinates and their first time derivatives; the prescribed
        motion already in plain symbols (see :func:`.variational.in_crank_angle`).
    coordinates : sequence of Expr
        Applied functions of time.
    crank : CrankMotion
        Crank angle and rates.
    t : Symbol
        Time.
    forces : mapping, optional
        Coordinate to generalised force, linear in coordinates and velocities.
    geometric : iterable of Symbol
        Stiffness terms that contain one of these symbols go to Kg instead of K.

    Returns
    -------
    DiscreteSystem
        Explicit matrices.

    Raises
    ------
    NotRepresentable
        If reassembling the arrays does not give back the Lagrangian or the forces, for example
        because of a cubic term or an unknown power of the crank's rate.
    """
    q, qd, table = _plain_names(coordinates, t)
    found = _Arrays(len(q), crank)
    for term in _terms(_enter(lagrangian, table, coordinates), q, qd, crank):
        found.add_energy(term)
    for i, coordinate in enumerate(coordinates):
        force = _enter((forces or {}).get(coordinate, sp.S.Zero), table, coordinates)
        for term in _terms(force, q, qd, crank):
            found.add_force(i, term)
    found.refuse_lost()
    arrays = found.matrices(tuple(geometric))
    return DiscreteSystem(crank, len(q), arrays, tuple(symbol.name for symbol in q))


_RATE_POWERS = {(2, 0): "B", (0, 1): "S", (0, 0): "K"}
_FORCE_POWERS = {(2, 0): "f", (1, 0): "h", (0, 1): "g", (0, 0): "p"}


@dataclass(frozen=True)
class _Term:
    """A product of an expanded polynomial: what it is made of."""

    whole: sp.Expr
    coefficient: sp.Expr
    positions: tuple[int, ...]
    velocities: tuple[int, ...]
    rates: tuple[int, int]

    @property
    def order(self) -> tuple[int, int]:
        return len(self.velocities), len(self.positions)


def _terms(
    expression: sp.Expr, q: Sequence[sp.Symbol], qd: Sequence[sp.Symbol], crank: CrankMotion
) -> Iterator[_Term]:
    """Yield the terms of a polynomial in coordinates, velocities and the rates of the crank."""
    every = [*q, *qd, crank.rate, crank.acceleration]
    index = {symbol: place for place, symbol in enumerate(every)}
    n = len(q)
    for term in sp.Add.make_args(sp.expand(expression)):
        places, rest = [], []
        for factor in sp.Mul.make_args(term):
            base, exponent = factor.as_base_exp()
            if base in index and exponent.is_Integer and exponent > 0:
                places += [index[base]] * int(exponent)
            else:
                rest.append(factor)
        coefficient = sp.Mul(*rest)
        if coefficient.free_symbols & set(every[: 2 * n]):
            raise NotRepresentable(f"these terms have no place in the arrays: {term}")
        yield _Term(
            term,
            coefficient,
            tuple(place for place in places if place < n),
            tuple(place - n for place in places if n <= place < 2 * n),
            (places.count(2 * n), places.count(2 * n + 1)),
        )


class _Arrays:
    """The arrays of a quadratic Lagrangian as they are read off, term by term."""

    def __init__(self, size: int, crank: CrankMotion) -> None:
        self._size, self._crank = size, crank
        self._entries: dict[tuple[str, int, int], list[sp.Expr]] = {}
        self._lost: dict[str, list[sp.Expr]] = {"terms": [], "forces": []}

    def _add(self, name: str, i: int, j: int, value: sp.Expr) -> None:
        self._entries.setdefault((name, i, j), []).append(value)

    def add_energy(self, term: _Term) -> None:
        """Add a term of the Lagrangian."""
        c, rates = term.coefficient, term.rates
        if term.order == (2, 0) and rates == (0, 0):
            self._symmetric("M", term.velocities, c)
        elif term.order == (1, 1) and rates == (1, 0):
            self._add("A", term.velocities[0], term.positions[0], c)
        elif term.order == (0, 2) and rates in _RATE_POWERS:
            name = _RATE_POWERS[rates]
            self._symmetric(name, term.positions, -c if name == "K" else c)
        elif term.order == (0, 1) and rates in _FORCE_POWERS:
            self._add(_FORCE_POWERS[rates], term.positions[0], 0, c)
        elif term.order == (1, 0) and rates in ((0, 0), (1, 0)):
            # A momentum c, or td c, acts as minus its rate.
            i, turned = term.velocities[0], rates == (1, 0)
            self._add("f" if turned else "h", i, 0, -self._crank.derivative(c))
            if turned:
                self._add("g", i, 0, -c)
        elif term.order != (0, 0):
            self._lost["terms"].append(term.whole)

    def _symmetric(self, name: str, places: tuple[int, ...], value: sp.Expr) -> None:
        i, j = places
        self._add(name, i, j, value)
        self._add(name, j, i, value)

    def add_force(self, i: int, term: _Term) -> None:
        """Add a term of a generalised force: damping to C, displacements to K, D, B, S."""
        c, rates = term.coefficient, term.rates
        if term.order == (1, 0):
            powers = (self._crank.rate, self._crank.acceleration)
            rated = sp.Mul(*(r**k for r, k in zip(powers, rates, strict=True)))
            self._add("C", i, term.velocities[0], -c * rated)
        elif term.order == (0, 1) and rates in {**_RATE_POWERS, (1, 0): "D"}:
            name = {**_RATE_POWERS, (1, 0): "D"}[rates]
            self._add(name, i, term.positions[0], c if name in "BS" else -c)
        elif term.order == (0, 0) and rates in _FORCE_POWERS:
            self._add(_FORCE_POWERS[rates], i, 0, c)
        else:
            self._lost["forces"].append(term.whole)

    def refuse_lost(self) -> None:
        """Refuse what the arrays cannot hold.

        Raises ``NotRepresentable`` with the terms that are left over.
        """
        for what, lost in self._lost.items():
            if (left := sp.expand(sp.Add(*lost))) != 0:
                raise NotRepresentable(f"these {what} have no place in the arrays: {left}")

    def matrices(self, geometric: tuple[sp.Symbol, ...]) -> dict[str, sp.ImmutableDenseMatrix]:
        """Return the arrays; stiffness terms with one of the symbols go to Kg."""
        found = {name: sp.zeros(self._size, self._size) for name in MATRICES}
        found |= {name: sp.zeros(self._size, 1) for name in VECTORS}
        for (name, i, j), values in self._entries.items():
            if name == "K":
                moved = [value for value in values if geometric and value.has(*geometric)]
                found["Kg"][i, j] = sp.Add(*moved)
                values = [value for value in values if value not in moved]
            found[name][i, j] = sp.Add(*values)
        return {name: sp.ImmutableDenseMatrix(matrix) for name, matrix in found.items()}


_DISPLACEMENT = {"K": (0, 0), "D": (1, 0), "H": (2, 0), "E": (0, 1)}
_FORCE_ARRAYS = {"f": (2, 0), "h": (1, 0), "g": (0, 1), "p": (0, 0)}


def linear_periodic(
    equations: EquationsOfMotion,
    crank: CrankMotion,
    geometric: Iterable[sp.Symbol] = (),
    *,
    followers: Mapping[sp.Expr, sp.Expr] | None = None,
) -> DiscreteSystem:
    """Return the arrays of equations that are linear in the coordinates and velocities.

    Parameters
    ----------
    equations : EquationsOfMotion
        Without constraints.
    crank : CrankMotion
        Crank angle and rates.
    geometric : iterable of Symbol
        Stiffness terms that contain one of these symbols go to Kg instead of K.
    followers : mapping, optional
        Prescribed function of time to its value in plain symbols of the crank.

    Returns
    -------
    DiscreteSystem
        The gyroscopic matrix is held as ``A = (G - M' - its transpose) / 4``.

    Raises
    ------
    NotRepresentable
        If the equations are constrained or something is left over after reassembly.
    """
    if equations.constraints.rows:
        raise NotRepresentable("constrained equations are not a linear periodic system")
    q, qd = list(equations.coordinates), list(equations.velocities)

    def plain(matrix: sp.Matrix) -> sp.Matrix:
        values = followers or {}
        return matrix.applyfunc(lambda e: in_crank_angle(e, crank, equations.t, values).expand())

    mass, residual = plain(equations.mass), plain(equations.rest - equations.forces)
    found, forcing, damping, turning = _read_off(residual, q, qd, crank)
    slope = mass.applyfunc(crank.derivative)
    gyroscopic = turning - slope
    a = (gyroscopic - gyroscopic.T) / 4
    marks = set(geometric)
    stressed = found["K"].applyfunc(
        lambda e: sp.Add(*(i for i in sp.Add.make_args(e) if i.free_symbols & marks))
    )
    arrays = {
        "M": mass,
        "A": a,
        "B": a.applyfunc(crank.derivative) - found["H"],
        "S": a - found["E"],
        "C": damping + (gyroscopic + gyroscopic.T) * crank.rate / 2,
        "D": found["D"],
        "K": found["K"] - stressed,
        "Kg": stressed,
        **forcing,
    }
    frozen = {name: sp.ImmutableDenseMatrix(m.applyfunc(sp.expand)) for name, m in arrays.items()}
    return DiscreteSystem(crank, len(q), frozen, tuple(symbol.name for symbol in q))


def _read_off(
    residual: sp.Matrix, q: list[sp.Symbol], qd: list[sp.Symbol], crank: CrankMotion
) -> tuple[dict[str, sp.Matrix], dict[str, sp.Matrix], sp.Matrix, sp.Matrix]:
    """Return stiffness and forcing arrays by name, damping, and the factor of ``td qd``."""
    rates = (crank.rate, crank.acceleration)
    velocity, position = residual.jacobian(qd), residual.jacobian(q)
    at_rest = residual.subs(dict.fromkeys([*q, *qd], 0))
    found = {name: _part(position, rates, p) for name, p in _DISPLACEMENT.items()}
    forcing = {name: -_part(at_rest, rates, p) for name, p in _FORCE_ARRAYS.items()}
    damping, turning = _part(velocity, rates, (0, 0)), _part(velocity, rates, (1, 0))
    back = (damping + turning * crank.rate) * sp.Matrix(qd)
    for name, (i, j) in _DISPLACEMENT.items():
        back += found[name] * rates[0] ** i * rates[1] ** j * sp.Matrix(q)
    for name, (i, j) in _FORCE_ARRAYS.items():
        back -= forcing[name] * rates[0] ** i * rates[1] ** j
    lost = (residual - back).applyfunc(sp.expand)
    if any(item != 0 for item in lost):
        raise NotRepresentable(f"these terms have no place in the arrays: {list(lost)}")
    return found, forcing, damping, turning


def _part(
    matrix: sp.Matrix, rates: tuple[sp.Symbol, sp.Symbol], powers: tuple[int, int]
) -> sp.Matrix:
    return matrix.applyfunc(
        lambda e: sp.expand(e).coeff(rates[0], powers[0]).coeff(rates[1], powers[1])
    )
