"""Hamilton's principle by machine: field equations, natural and jump conditions of a continuum.

The derivatives of the fields become plain jet symbols; the density is differentiated with respect
to them, and every integration by parts is a total derivative with the opposite sign.  The boundary
terms are the partial sums that the integrations leave behind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import sympy as sp

from .arrays import CrankMotion
from .integrals import antiderivative
from .jets import Flux, JetSpace, linearise, order_part
from .records import ActionDensity, BoundaryCondition, FieldEquations, JumpCondition, PointTerm

__all__ = [
    "drag_by_order",
    "hamilton",
    "in_crank_angle",
    "linearise",
    "order_part",
    "quadratic_action",
    "solve_end_value",
    "solve_tension",
]


def hamilton(action: ActionDensity) -> FieldEquations:
    """Derive field equations, natural conditions and jump conditions from an action.

    Parameters
    ----------
    action : ActionDensity
        Densities, point terms, forces and prescribed values.

    Returns
    -------
    FieldEquations
        Expressions that vanish; ``d density / d field - ... + force density``.

    Raises
    ------
    ValueError
        If a point term or force works on a derivative that the density does not make continuous,
        or a value is prescribed at an interior point.
    """
    space = JetSpace(action.fields)
    variation = space.vary(space.enter(action.density))
    for item in action.fields:
        for k, drag in drag_by_order(action, item):
            known = variation[item].get((k, 0), sp.S.Zero)
            variation[item][k, 0] = known + space.enter(drag)
    equations: dict[sp.Expr, sp.Expr] = {}
    fluxes: dict[sp.Expr, tuple[Flux, Flux]] = {}
    for item in action.fields:
        euler, in_x, in_t = space.parts(variation[item])
        equations[item] = space.leave(euler) + action.force_density.get(item, sp.S.Zero)
        fluxes[item] = in_x, in_t
    ends = (sp.S.Zero, sp.sympify(action.length))
    inner = _interior_points(action, ends)
    natural: list[BoundaryCondition] = []
    jumps: list[JumpCondition] = []
    for position in (*ends, *inner):
        applied = _applied(action, space, position)
        for item in action.fields:
            flux = _boundary_flux(action, space, fluxes[item], position)
            _check_traces(applied[item], variation[item], item, position)
            if position in ends:
                sign = -1 if position == ends[0] else 1
                natural += _natural(action, space, item, position, sign, flux, applied[item])
            else:
                jumps += _jumps(action, space, item, position, flux, applied[item])
    return FieldEquations(action, equations, tuple(natural), tuple(jumps))


def drag_by_order(action: ActionDensity, item: sp.Expr) -> list[tuple[int, sp.Expr]]:
    """Return what dissipation works on each varied x derivative of a field: (order, force).

    Raises ``ValueError`` if the dissipation is no function of first time derivatives.
    """
    if action.dissipation == 0:
        return []
    space = JetSpace(action.fields)
    entered = space.enter(action.dissipation)
    if any(jet.j != 1 for _, jet in space.present(entered)):
        raise ValueError(f"dissipation {action.dissipation} is not one of first rates alone")
    return [
        (jet.k, space.leave(-sp.diff(entered, symbol)))
        for symbol, jet in space.present(entered)
        if jet.field == item
    ]


def _interior_points(action: ActionDensity, ends: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
    groups = (action.supports, action.point_terms, action.end_forces)
    points = [sp.sympify(item.position) for group in groups for item in group]
    inner = tuple(dict.fromkeys(point for point in points if point not in ends))
    for item in action.essential:
        if sp.sympify(item.position) not in ends:
            raise ValueError(f"{item} is not at an end; use a Support for an interior point")
    for support in action.supports:
        if sp.sympify(support.position) in ends:
            raise ValueError(f"{support} is at an end; use an Essential")
    return inner


def _applied(
    action: ActionDensity, space: JetSpace, position: sp.Expr
) -> dict[sp.Expr, dict[int, sp.Expr]]:
    """Collect what point terms and forces contribute to each varied trace at a point."""
    speed = sp.diff(position, action.t)
    table: dict[sp.Expr, dict[int, sp.Expr]] = {item: {} for item in action.fields}
    for term in action.point_terms:
        if sp.sympify(term.position) != position:
            continue
        for item, flux in space.vary(space.enter(term.expression)).items():
            for k, value in space.on_trace(flux, speed).items():
                table[item][k] = table[item].get(k, sp.S.Zero) + value
    for force in action.end_forces:
        if sp.sympify(force.position) == position:
            row = table[force.field]
            row[force.order] = row.get(force.order, sp.S.Zero) + space.enter(force.force)
    return table


def _boundary_flux(
    action: ActionDensity, space: JetSpace, fluxes: tuple[Flux, Flux], position: sp.Expr
) -> dict[int, sp.Expr]:
    """Return what an integration by parts leaves at a point that may move."""
    in_x, in_t = fluxes
    speed = sp.diff(position, action.t)
    total = dict(in_x)
    if speed != 0:
        for order, value in in_t.items():
            total[order] = total.get(order, sp.S.Zero) - speed * value
    return space.on_trace(total, speed)


def _check_traces(
    applied: Mapping[int, sp.Expr], variation: Flux, item: sp.Expr, position: sp.Expr
) -> None:
    continuous = max((k for k, _ in variation), default=0)
    wrong = sorted(k for k, value in applied.items() if k >= continuous and value != 0)
    if wrong:
        raise ValueError(
            f"a term at {position} works on x derivative {wrong[0]} of {item}, but the density "
            f"keeps only derivatives below {continuous} continuous"
        )


def _natural(
    action: ActionDensity,
    space: JetSpace,
    item: sp.Expr,
    position: sp.Expr,
    sign: int,
    flux: Mapping[int, sp.Expr],
    applied: Mapping[int, sp.Expr],
) -> Iterator[BoundaryCondition]:
    fixed = {
        entry.order
        for entry in action.essential
        if entry.field == item and sp.sympify(entry.position) == position
    }
    for order in sorted({*flux, *applied} - fixed):
        value = sign * flux.get(order, sp.S.Zero) + applied.get(order, sp.S.Zero)
        if value != 0:
            yield BoundaryCondition(position, item, order, space.leave(value))


def _jumps(
    action: ActionDensity,
    space: JetSpace,
    item: sp.Expr,
    position: sp.Expr,
    flux: Mapping[int, sp.Expr],
    applied: Mapping[int, sp.Expr],
) -> Iterator[JumpCondition]:
    reaction = sum(
        (
            s.reaction
            for s in action.supports
            if s.field == item and sp.sympify(s.position) == position
        ),
        sp.S.Zero,
    )
    for order in sorted({*flux, *applied}):
        yield JumpCondition(
            position,
            item,
            order,
            space.leave(flux.get(order, sp.S.Zero)),
            space.leave(applied.get(order, sp.S.Zero)),
            reaction if order == 0 else sp.S.Zero,
        )


def solve_tension(
    equation: sp.Expr, tension: sp.Expr, x: sp.Symbol, end: sp.Expr, value: sp.Expr
) -> sp.Expr:
    """Solve a first-order linear equation ``a dN/dx + r(x) = 0`` with an end value.

    Parameters
    ----------
    equation : Expr
        Vanishes; linear in ``dN/dx`` and free of N itself.
    tension : Expr
        The applied function N.
    x : Symbol
        Running coordinate.
    end, value : Expr
        ``N(end) = value``; where the value contains x, as natural conditions do, it is taken at
        the end.

    Returns
    -------
    Expr
        N as a function of x and of whatever the equation contains.

    Raises
    ------
    ValueError
        If the equation is not of that kind.
    """
    slope = sp.Dummy("slope")
    plain = sp.sympify(equation).xreplace({sp.Derivative(tension, x): slope})
    factor = sp.expand(sp.diff(plain, slope))
    rest = sp.expand(plain.xreplace({slope: sp.S.Zero}))
    if factor == 0 or factor.has(slope) or factor.has(x) or rest.has(tension):
        raise ValueError(f"{equation} is not of the form a d({tension})/dx + r(x) = 0")
    primitive = antiderivative(sp.expand(-rest / factor), x)
    return sp.expand(primitive + (value - primitive).subs(x, end))


def solve_end_value(condition: sp.Expr, unknown: sp.Expr) -> sp.Expr:
    """Solve a condition that is linear in an unknown for it, for example ``F - N = 0`` for N.

    Raises
    ------
    ValueError
        If the condition is not linear in the unknown.
    """
    symbol = sp.Dummy("unknown")
    plain = sp.sympify(condition).xreplace({unknown: symbol})
    factor = sp.expand(sp.diff(plain, symbol))
    if factor == 0 or factor.has(symbol):
        raise ValueError(f"{condition} is not linear in {unknown}")
    return sp.expand(-plain.xreplace({symbol: sp.S.Zero}) / factor)


def undeflected_tension(equations: FieldEquations, along: sp.Expr, tension: sp.Expr) -> sp.Expr:
    """Return the tension in an undeflected link, from its slope and the condition at the far end.

    ``equations``: with the equation of the displacement along the link; ``along``, ``tension``:
    that displacement, and the multiplier that is the tension. Raises ``ValueError`` if either is
    not linear in the tension.
    """
    action = equations.action
    x, end, orders = action.x, action.length, action.orders
    at_end = linearise(equations.condition(end, along, 0), orders, 0)
    value = solve_end_value(at_end.subs(x, end), tension.subs(x, end))
    slope = linearise(equations.equations[along], orders, 0)
    return solve_tension(slope, tension, x, end, value)


def quadratic_action(
    action: ActionDensity,
    values: Mapping[sp.Expr, sp.Expr],
    dependent: Iterable[sp.Expr],
) -> ActionDensity:
    """Return the action up to second order in the remaining fields, constraint fields eliminated.

    Multiplier fields are replaced by their leading-order values.  What is then linear in the
    dependent fields (of second order themselves, such as the foreshortening) must be a null
    Lagrangian: that is verified, not assumed, boundary terms and end forces included.

    Parameters
    ----------
    action : ActionDensity
        With ``orders`` of the fields.
    values : mapping
        Multiplier field to its leading-order value.
    dependent : iterable of Expr
        Fields of second order that the constraints tie to the others.

    Raises
    ------
    ValueError
        If the values do not make the action stationary in the dependent fields.
    """
    gone = tuple(dependent)
    kept = tuple(f for f in action.fields if f not in gone and f not in values)
    orders = {f: action.orders.get(f, 1) for f in (*kept, *gone)}

    def split(expression: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        full = linearise(sp.sympify(expression).subs(values).doit(), orders, 2)
        rest = order_part(full, dict.fromkeys(gone, 1), 0) if gone else full
        return sp.expand(rest), sp.expand(full - rest)

    density, remainder = split(action.density)
    points = [(p.position, *split(p.expression)) for p in action.point_terms]
    if gone:
        check = action.with_(
            fields=gone,
            density=remainder,
            point_terms=tuple(PointTerm(at, part) for at, _, part in points),
            force_density={f: v for f, v in action.force_density.items() if f in gone},
            end_forces=tuple(e for e in action.end_forces if e.field in gone),
            essential=tuple(e for e in action.essential if e.field in gone),
            supports=(),
            orders={},
            dissipation=sp.S.Zero,
        )
        _require_stationary(hamilton(check))
    return action.with_(
        fields=kept,
        density=density,
        point_terms=tuple(PointTerm(at, part) for at, part, _ in points if part != 0),
        force_density={f: v for f, v in action.force_density.items() if f in kept},
        end_forces=tuple(e for e in action.end_forces if e.field in kept),
        essential=tuple(e for e in action.essential if e.field in kept),
        supports=tuple(s for s in action.supports if s.field in kept),
        orders={f: action.orders.get(f, 1) for f in kept},
    )


def _require_stationary(equations: FieldEquations) -> None:
    x = equations.action.x
    for item, expression in equations.equations.items():
        if sp.expand(expression) != 0:
            raise ValueError(f"not stationary in {item}: {expression} does not vanish")
    for condition in equations.natural:
        if sp.expand(condition.expression.subs(x, condition.position)) != 0:
            raise ValueError(f"not stationary at an end: {condition}")
    for jump in equations.jumps:
        if sp.expand(jump.applied.subs(x, jump.position)) != 0:
            raise ValueError(f"not stationary at a point: {jump}")


def in_crank_angle(
    expression: sp.Expr,
    crank: CrankMotion,
    t: sp.Symbol,
    followers: Mapping[sp.Expr, sp.Expr],
) -> sp.Expr:
    """Rewrite functions of time that follow the crank in plain symbols, td and tdd.

    Parameters
    ----------
    expression : Expr
        With applied functions of time and their first and second derivatives.
    crank : CrankMotion
        Crank angle, rates, and the derivatives of the followers with respect to the angle.
    t : Symbol
        Time.
    followers : mapping
        Applied function of time to its value in plain symbols, for example
        ``{th2(t): theta, th3(t): theta3}``; a force may be an expression in td and tdd.

    Returns
    -------
    Expr
        ``d theta3/dt = omega3 td`` and ``d^2 theta3/dt^2 = alpha3 td^2 + omega3 tdd``.

    Raises
    ------
    ValueError
        If a derivative occurs whose value the chain does not know, or beyond the second.
    """
    expression = sp.sympify(expression).doit()
    table: dict[sp.Expr, sp.Expr] = dict(followers)
    for derivative in expression.atoms(sp.Derivative):
        if derivative.expr not in followers:
            continue
        value = sp.sympify(followers[derivative.expr])
        order = derivative.derivative_count
        unknown = value.is_Symbol and value != crank.theta and value not in crank.chain
        if unknown or value.has(crank.rate, crank.acceleration):
            raise ValueError(f"the chain gives no derivative of {value} for {derivative}")
        first = crank.derivative(value)
        if order == 1:
            table[derivative] = first * crank.rate
        elif order == 2:
            second = crank.derivative(first)
            table[derivative] = second * crank.rate**2 + first * crank.acceleration
        else:
            raise ValueError(f"{derivative}: derivatives beyond the second are not known")
    return expression.xreplace(table)
