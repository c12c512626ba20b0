"""Records that the symbolic stages hand to one another: actions, equations, projected systems."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import sympy as sp
from sympy.core.function import AppliedUndef


def _frozen_map(items: Mapping[sp.Expr, sp.Expr]) -> Mapping[sp.Expr, sp.Expr]:
    return MappingProxyType(dict(items))


@dataclass(frozen=True)
class PointTerm:
    """Part of the Lagrangian that sits at one point of the link.

    Attributes
    ----------
    position : Expr
        Where it sits: 0, the length, an interior point, or a function of time.
    expression : Expr
        Lagrangian [J] in the fields at the running coordinate x; it is taken at ``x = position``.
    """

    position: sp.Expr
    expression: sp.Expr


@dataclass(frozen=True)
class EndForce:
    """Generalised force at a point, with virtual work ``force * delta(d^order field / dx^order)``.

    Attributes
    ----------
    position : Expr
        Where it acts.
    field : Expr
        The applied function that it works on.
    order : int
        Number of x derivatives: 0 for a force [N], 1 for a moment [N m].
    force : Expr
        Its value; may depend on time and on the fields at the point.
    """

    position: sp.Expr
    field: sp.Expr
    order: int
    force: sp.Expr


@dataclass(frozen=True)
class Essential:
    """Prescribed boundary value: ``d^order field / dx^order = 0`` at ``position``."""

    position: sp.Expr
    field: sp.Expr
    order: int


@dataclass(frozen=True)
class Support:
    """Interior point at which a field is held at zero.

    Attributes
    ----------
    position : Expr
        Place of the support; a function of time where it slides.
    field : Expr
        The applied function that is held.
    reaction : Symbol
        Name of the force that the support exerts, positive along the field.
    """

    position: sp.Expr
    field: sp.Expr
    reaction: sp.Symbol


@dataclass(frozen=True)
class ActionDensity:
    """Action of a one-dimensional continuum: everything that Hamilton's principle needs.

    ``delta int (int_0^length density dx + sum point terms) dt + int (virtual work) dt = 0``

    Attributes
    ----------
    x, t : Symbol
        Coordinate along the link [m] and time [s].
    length : Expr
        The link reaches from ``x = 0`` to ``x = length``.
    fields : tuple of Expr
        Unknown applied functions of ``(x, t)``, multiplier fields included.
    density : Expr
        Lagrangian per length [J/m] in the fields, their derivatives, x and functions of time.
    point_terms : tuple of PointTerm
        Concentrated masses, springs and the like.
    force_density : mapping
        Field to non-conservative force per length [N/m], for example ``-c*y_t``.
    end_forces : tuple of EndForce
        Forces and moments at points.
    essential : tuple of Essential
        Prescribed boundary values, all zero.
    supports : tuple of Support
        Interior points where a field is held at zero.
    orders : mapping
        Field to its power of the small parameter; 1 where it is not listed.
    dissipation : Expr
        Rayleigh's function per length [W/m], half the power lost, quadratic in the rates of the
        fields and of their derivatives in x: ``c*y_t**2/2 + c_i*y_xxt**2/2``.  Its virtual work is
        ``-(dR/dy_t) delta y - (dR/dy_xxt) delta y_xx``.
    """

    x: sp.Symbol
    t: sp.Symbol
    length: sp.Expr
    fields: tuple[sp.Expr, ...]
    density: sp.Expr
    point_terms: tuple[PointTerm, ...] = ()
    force_density: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)
    end_forces: tuple[EndForce, ...] = ()
    essential: tuple[Essential, ...] = ()
    supports: tuple[Support, ...] = ()
    orders: Mapping[sp.Expr, int] = field(default_factory=dict)
    dissipation: sp.Expr = sp.S.Zero

    def __post_init__(self) -> None:
        """Refuse fields that are not functions of (x, t), and names of fields that do not exist."""
        for item in self.fields:
            if not isinstance(item, AppliedUndef) or item.args != (self.x, self.t):
                raise ValueError(f"field {item} is not an applied function of {(self.x, self.t)}")
        named = [item.field for item in self.end_forces]
        named += [item.field for item in self.essential]
        named += [item.field for item in self.supports]
        unknown = {*named, *self.force_density, *self.orders} - set(self.fields)
        if unknown:
            raise ValueError(
                f"unknown fields {sorted(map(str, unknown))}; expected some of {self.fields}"
            )
        object.__setattr__(self, "force_density", _frozen_map(self.force_density))
        object.__setattr__(self, "orders", _frozen_map(self.orders))

    def held(self, item: sp.Expr) -> list[tuple[sp.Expr, int]]:
        """Return where a field, or which of its derivatives by x, is held at zero."""
        ends = [(end.position, end.order) for end in self.essential if end.field == item]
        return ends + [(point.position, 0) for point in self.supports if point.field == item]

    def with_(self, **changes: object) -> ActionDensity:
        """Return a copy with some attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]


@dataclass(frozen=True)
class BoundaryCondition:
    """Natural condition ``expression = 0`` at an end.

    Attributes
    ----------
    position : Expr
        0 or the length.
    field : Expr
        Field whose variation was free.
    order : int
        Number of x derivatives of that variation: 0 gives forces, 1 moments.
    expression : Expr
        In the running coordinate x; to be taken at ``x = position``.
    """

    position: sp.Expr
    field: sp.Expr
    order: int
    expression: sp.Expr


@dataclass(frozen=True)
class JumpCondition:
    """Condition at an interior point: ``value(a+) - value(a-) = applied + reaction``.

    Attributes
    ----------
    position : Expr
        The point a, possibly a function of time.
    field, order
        Field and number of x derivatives of the variation that was free (or held, at a support).
    value : Expr
        Quantity that jumps, for example the shear ``EI y_xxx``, in the running coordinate.
    applied : Expr
        Contribution of point terms and forces, to be taken at ``x = position``.
    reaction : Expr
        The force of a support, or 0.
    """

    position: sp.Expr
    field: sp.Expr
    order: int
    value: sp.Expr
    applied: sp.Expr
    reaction: sp.Expr


@dataclass(frozen=True)
class FieldEquations:
    """Result of Hamilton's principle for a continuum.

    Attributes
    ----------
    action : ActionDensity
        What it was derived from.
    equations : mapping
        Field to expression; ``expression = 0`` is the field equation, with the sign of
        ``d density / d field - ... + force``.
    natural : tuple of BoundaryCondition
        Natural conditions at both ends.
    jumps : tuple of JumpCondition
        Conditions at interior supports, point terms and forces.
    """

    action: ActionDensity
    equations: Mapping[sp.Expr, sp.Expr]
    natural: tuple[BoundaryCondition, ...]
    jumps: tuple[JumpCondition, ...] = ()

    def __post_init__(self) -> None:
        """Freeze the mapping."""
        object.__setattr__(self, "equations", _frozen_map(self.equations))

    def condition(self, position: sp.Expr, field_: sp.Expr, order: int) -> sp.Expr:
        """Return the natural condition of one kind.

        Raises ``KeyError`` if there is no such condition (the value is prescribed, or does not
        occur).
        """
        for item in self.natural:
            if (item.position, item.field, item.order) == (sp.sympify(position), field_, order):
                return item.expression
        raise KeyError(f"no natural condition of order {order} for {field_} at {position}")


@dataclass(frozen=True)
class Lagrangian:
    """A discrete system before it is derived.

    Attributes
    ----------
    coordinates : tuple of Expr
        Unknown applied functions of time.
    t : Symbol
        Time [s].
    expression : Expr
        Kinetic less potential energy [J].
    constraints : tuple of Expr
        Holonomic ``Phi(q, t)``, each to vanish.
    multipliers : tuple of Symbol
        One per constraint; named ``lam_1, lam_2, ...`` where none are given.
    forces : mapping
        Coordinate to non-conservative generalised force.
    prescribed : mapping
        Applied function of time to its value; other functions of time that are not coordinates
        stay as they are and count as prescribed.
    """

    coordinates: tuple[sp.Expr, ...]
    t: sp.Symbol
    expression: sp.Expr
    constraints: tuple[sp.Expr, ...] = ()
    multipliers: tuple[sp.Symbol, ...] = ()
    forces: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)
    prescribed: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Name the multipliers and refuse inconsistent input."""
        for item in self.coordinates:
            if not isinstance(item, AppliedUndef) or item.args != (self.t,):
                raise ValueError(f"coordinate {item} is not an applied function of {self.t}")
        unknown = sorted(str(item) for item in set(self.forces) - set(self.coordinates))
        if unknown:
            raise ValueError(f"forces on unknown coordinates {unknown}")
        if not self.multipliers:
            names = tuple(sp.Symbol(f"lam_{i + 1}") for i in range(len(self.constraints)))
            object.__setattr__(self, "multipliers", names)
        if len(self.multipliers) != len(self.constraints):
            raise ValueError(
                f"{len(self.multipliers)} multipliers for {len(self.constraints)} constraints"
            )
        object.__setattr__(self, "forces", _frozen_map(self.forces))
        object.__setattr__(self, "prescribed", _frozen_map(self.prescribed))


@dataclass(frozen=True)
class EquationsOfMotion:
    """``M(q, t) qdd + c(q, qd, t) = Phi_q^T lam + Q(q, qd, t)``, ``Phi(q, t) = 0``.

    Attributes
    ----------
    t : Symbol
        Time.
    coordinates, velocities : tuple of Symbol
        Plain symbols q and qd in which everything below is written.
    multipliers : tuple of Symbol
        Names of lam.
    mass : Matrix, (n, n)
        M, symmetric.
    rest : Matrix, (n, 1)
        c.
    forces : Matrix, (n, 1)
        Q, generalised non-conservative forces.
    constraints : Matrix, (k, 1)
        Phi.
    jacobian : Matrix, (k, n)
        Phi_q.
    velocity_rhs : Matrix, (k, 1)
        ``Phi_q qd = velocity_rhs``, which is minus the partial time derivative of Phi.
    gamma : Matrix, (k, 1)
        ``Phi_q qdd = gamma``.
    lagrangian : Lagrangian or None
        What the equations were derived from.
    """

    t: sp.Symbol
    coordinates: tuple[sp.Symbol, ...]
    velocities: tuple[sp.Symbol, ...]
    multipliers: tuple[sp.Symbol, ...]
    mass: sp.ImmutableDenseMatrix
    rest: sp.ImmutableDenseMatrix
    forces: sp.ImmutableDenseMatrix
    constraints: sp.ImmutableDenseMatrix
    jacobian: sp.ImmutableDenseMatrix
    velocity_rhs: sp.ImmutableDenseMatrix
    gamma: sp.ImmutableDenseMatrix
    lagrangian: Lagrangian | None = None


@dataclass(frozen=True)
class VariationalEquations:
    """Linearisation of constrained equations about a motion that satisfies them.

    ::

        M dqdd + D dqd + K dq = Phi_q^T dlam,      Phi_q dq = 0

    whose constraint, differentiated twice along the motion, is with the rates of J = Phi_q

        J dqd + Jd dq = 0,      J dqdd + 2 Jd dqd + Jdd dq = 0

    Attributes
    ----------
    accelerations : tuple of Symbol
        Names of qdd, which enter K.
    damping : Matrix, (n, n)
        ``D = d(c - Q)/d qd``.
    stiffness : Matrix, (n, n)
        ``K = d(M qdd + c - Phi_q^T lam - Q)/d q`` at fixed qdd and lam.
    jacobian_rate, jacobian_acceleration : Matrix, (k, n)
        ``Jd = d(Phi_q qd + Phi_t)/d q`` and ``Jdd = d(Phi_q qdd - gamma)/d q``, the first and
        second time derivative of the Jacobian along the motion.
    """

    accelerations: tuple[sp.Symbol, ...]
    damping: sp.ImmutableDenseMatrix
    stiffness: sp.ImmutableDenseMatrix
    jacobian_rate: sp.ImmutableDenseMatrix
    jacobian_acceleration: sp.ImmutableDenseMatrix
