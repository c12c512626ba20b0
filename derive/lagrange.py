"""Lagrange's equations by machine: constrained systems, and the arrays of quadratic Lagrangians."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from .records import (
    CrankMotion,
    DiscreteSystem,
    EquationsOfMotion,
    Lagrangian,
    VariationalEquations,
)


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
    energy = sp.expand(_enter(lagrangian, table, coordinates))
    work = {
        i: _enter((forces or {}).get(c, 0), table, coordinates) for i, c in enumerate(coordinates)
    }
    arrays, linear = _collect(energy, q, qd, crank)
    _verify(energy, _reassemble(arrays, linear, q, qd, crank), q, qd)
    _add_linear_terms(arrays, linear, crank)
    for i, expression in work.items():
        _add_force(arrays, sp.expand(expression), i, q, qd, crank)
    _split_geometric(arrays, geometric)
    frozen = {name: sp.ImmutableDenseMatrix(matrix) for name, matrix in arrays.items()}
    return DiscreteSystem(crank, len(q), frozen, tuple(symbol.name for symbol in q))


_RATE_POWERS = {"B": (2, 0), "S": (0, 1), "K": (0, 0)}
_FORCE_POWERS = {"f": (2, 0), "h": (1, 0), "g": (0, 1), "p": (0, 0)}


def _rate_coefficient(expression: sp.Expr, crank: CrankMotion, powers: tuple[int, int]) -> sp.Expr:
    return sp.expand(expression).coeff(crank.rate, powers[0]).coeff(crank.acceleration, powers[1])


def _at_zero(expression: sp.Expr, symbols: Sequence[sp.Symbol]) -> sp.Expr:
    return expression.xreplace(dict.fromkeys(symbols, sp.S.Zero))


def _collect(
    energy: sp.Expr, q: Sequence[sp.Symbol], qd: Sequence[sp.Symbol], crank: CrankMotion
) -> tuple[dict[str, sp.Matrix], dict[str, sp.Matrix]]:
    """Read second-order and first-order coefficients off the Lagrangian."""
    size, every = len(q), [*q, *qd]
    arrays = {name: sp.zeros(size, size) for name in ("M", "A", "B", "S", "C", "D", "K", "Kg")}
    arrays |= {name: sp.zeros(size, 1) for name in _FORCE_POWERS}
    linear = {name: sp.zeros(size, 1) for name in ("td qd", "qd", *_FORCE_POWERS)}
    for i in range(size):
        momentum, push = sp.diff(energy, qd[i]), sp.diff(energy, q[i])
        for j in range(size):
            inertia = _at_zero(sp.diff(momentum, qd[j]), every)
            arrays["M"][i, j] = _rate_coefficient(inertia, crank, (0, 0))
            mixed = _at_zero(sp.diff(momentum, q[j]), every)
            arrays["A"][i, j] = _rate_coefficient(mixed, crank, (1, 0))
            stiff = _at_zero(sp.diff(push, q[j]), every)
            for name, powers in _RATE_POWERS.items():
                sign = -1 if name == "K" else 1
                arrays[name][i, j] = sign * _rate_coefficient(stiff, crank, powers)
        at_rest = _at_zero(momentum, every)
        linear["td qd"][i] = _rate_coefficient(at_rest, crank, (1, 0))
        linear["qd"][i] = _rate_coefficient(at_rest, crank, (0, 0))
        for name, powers in _FORCE_POWERS.items():
            linear[name][i] = _rate_coefficient(_at_zero(push, every), crank, powers)
    return arrays, linear


def _reassemble(
    arrays: Mapping[str, sp.Matrix],
    linear: Mapping[str, sp.Matrix],
    q: Sequence[sp.Symbol],
    qd: Sequence[sp.Symbol],
    crank: CrankMotion,
) -> sp.Expr:
    x, v, td, tdd = sp.Matrix(q), sp.Matrix(qd), crank.rate, crank.acceleration
    half = sp.Rational(1, 2)
    total = half * (v.T * arrays["M"] * v)[0] + td * (v.T * arrays["A"] * x)[0]
    total += half * (x.T * (td**2 * arrays["B"] + tdd * arrays["S"] - arrays["K"]) * x)[0]
    total += (v.T * (td * linear["td qd"] + linear["qd"]))[0]
    for name, (first, second) in _FORCE_POWERS.items():
        total += td**first * tdd**second * (x.T * linear[name])[0]
    return total


def _verify(
    energy: sp.Expr, assembled: sp.Expr, q: Sequence[sp.Symbol], qd: Sequence[sp.Symbol]
) -> None:
    every = [*q, *qd]
    lost = sp.expand(energy - assembled)
    lost -= _at_zero(lost, every)
    lost = sp.expand(lost)
    if lost != 0:
        raise NotRepresentable(f"these terms have no place in the arrays: {lost}")


def _add_linear_terms(
    arrays: dict[str, sp.Matrix], linear: Mapping[str, sp.Matrix], crank: CrankMotion
) -> None:
    """Turn terms linear in the coordinates into forces: -d/dt of momenta, plus direct terms."""
    for name in _FORCE_POWERS:
        arrays[name] += linear[name]
    for i, momentum in enumerate(linear["td qd"]):
        if momentum != 0:
            arrays["f"][i] -= crank.derivative(momentum)
            arrays["g"][i] -= momentum
    for i, momentum in enumerate(linear["qd"]):
        if momentum != 0:
            arrays["h"][i] -= crank.derivative(momentum)


def _add_force(
    arrays: dict[str, sp.Matrix],
    force: sp.Expr,
    row: int,
    q: Sequence[sp.Symbol],
    qd: Sequence[sp.Symbol],
    crank: CrankMotion,
) -> None:
    """Add a generalised force: damping to C, displacement terms to K, D, B, S, the rest to p..g."""
    every = [*q, *qd]
    accounted = sp.S.Zero
    for j, (position, velocity) in enumerate(zip(q, qd, strict=True)):
        damping = _at_zero(sp.diff(force, velocity), every)
        arrays["C"][row, j] -= damping
        accounted += damping * velocity
        stiff = _at_zero(sp.diff(force, position), every)
        for name, powers in {**_RATE_POWERS, "D": (1, 0)}.items():
            part = _rate_coefficient(stiff, crank, powers)
            arrays[name][row, j] += -part if name in ("K", "D") else part
            accounted += part * crank.rate ** powers[0] * crank.acceleration ** powers[1] * position
    constant = _at_zero(force, every)
    for name, powers in _FORCE_POWERS.items():
        part = _rate_coefficient(constant, crank, powers)
        arrays[name][row] += part
        accounted += part * crank.rate ** powers[0] * crank.acceleration ** powers[1]
    lost = sp.expand(force - accounted)
    if lost != 0:
        raise NotRepresentable(f"these forces have no place in the arrays: {lost}")


def _split_geometric(arrays: dict[str, sp.Matrix], geometric: Iterable[sp.Symbol]) -> None:
    marks = tuple(geometric)
    if not marks:
        return
    for i, entry in enumerate(arrays["K"]):
        terms = sp.Add.make_args(sp.expand(entry))
        moved = sp.Add(*(term for term in terms if term.has(*marks)))
        arrays["Kg"][i] += moved
        arrays["K"][i] = sp.expand(entry - moved)
