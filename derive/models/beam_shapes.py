"""Shape functions of beam elements, from their nodal conditions, and their derivatives as emitted.

The deflection of the cubic and quintic kinds is the polynomial that takes the nodal values; that of
Timoshenko's beam solves its static equations without load, which keeps it free of locking.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import sympy as sp

from ..entries import MatrixForm
from ..ir import Argument, Description
from ..pipeline import Model
from ..records import ActionDensity
from ..spec import ModelSpec
from ..staged import Steps
from ..variational import hamilton

KINDS = ("cubic", "internal_node", "curvature", "timoshenko")

x, t, xi, centred, beyond = sp.symbols("x t xi centred beyond", real=True)
shear_ratio = sp.Symbol("shear_ratio", real=True, nonnegative=True)
length, bending, shear = sp.symbols(
    "length bending_stiffness shear_stiffness", real=True, positive=True
)
u, v, psi = (sp.Function(name)(x, t) for name in ("u", "v", "psi"))


@dataclass(frozen=True)
class Condition:
    """A nodal value: a field, or one of its derivatives by x, at a fraction of the length.

    ``label``: name of the nodal value; ``field``: field that it belongs to; ``order``: number of
    derivatives; ``place``: fraction of the length, 0 to 1.
    """

    label: str
    field: sp.Expr
    order: int
    place: sp.Rational


def nodal_values(kind: str) -> tuple[Condition, ...]:
    """Return the nodal values of an element in their order: both ends, then what is inside."""
    turn = (psi, 0) if kind == "timoshenko" else (v, 1)
    found = []
    for node, place in ((1, sp.S.Zero), (2, sp.S.One)):
        found += [Condition(f"u{node}", u, 0, place), Condition(f"v{node}", v, 0, place)]
        found.append(Condition(f"r{node}", *turn, place))
    if kind == "internal_node":
        found += [Condition(f"{name}3", v, k, sp.Rational(1, 2)) for k, name in enumerate("vr")]
    if kind == "curvature":
        found += [Condition(f"k{1 + i}", v, 2, place) for i, place in enumerate((sp.S.Zero, 1))]
    return tuple(found)


@cache
def field_shapes(kind: str) -> Mapping[sp.Expr, tuple[sp.Expr, ...]]:
    """Return for each field its shape functions of x, one per nodal value.

    ``kind``: one of ``KINDS``. Result: u and v, and for Timoshenko's beam psi, to as many shapes as
    there are nodal values; these contain ``shear_ratio``.
    """
    values = nodal_values(kind)
    fields = (u, v, psi) if kind == "timoshenko" else (u, v)
    groups = ((u,), fields[1:])
    shapes = {item: [sp.S.Zero] * len(values) for item in fields}
    for group in groups:
        places = [i for i, value in enumerate(values) if value.field in group]
        general, unknowns = _general(group, len(places))
        matrix = sp.Matrix(
            [
                [_at(sp.diff(general[value.field], c), value) for c in unknowns]
                for value in (values[i] for i in places)
            ]
        )
        solved = matrix.inv()
        for column, place in enumerate(places):
            found = {c: solved[row, column] for row, c in enumerate(unknowns)}
            for item in group:
                shape = general[item].xreplace(found).subs(bending, by_ratio())
                shapes[item][place] = sp.cancel(shape)
    return MappingProxyType({item: tuple(listed) for item, listed in shapes.items()})


def by_ratio() -> sp.Expr:
    """Return the bending stiffness by ``shear_ratio = EI/(k G A length^2)``."""
    return shear_ratio * shear * length**2


def shear_steps() -> Steps:
    """Return the definition of ``shear_ratio``."""
    (value,) = sp.solve(by_ratio() - bending, shear_ratio)
    return Steps(((shear_ratio, value),))


def _at(expression: sp.Expr, value: Condition) -> sp.Expr:
    return sp.diff(expression, x, value.order).subs(x, value.place * length)


def _general(
    group: Sequence[sp.Expr], count: int
) -> tuple[dict[sp.Expr, sp.Expr], tuple[sp.Symbol, ...]]:
    """Return fields with as many free coefficients as there are nodal values.

    A single field is a polynomial; v and psi together satisfy the static field equations, whose
    polynomial solutions have as many coefficients as there are nodal values.
    """
    if len(group) == 1:
        unknowns = sp.symbols(f"a0:{count}")
        return {group[0]: sp.Add(*(c * x**k for k, c in enumerate(unknowns)))}, unknowns
    names = {item: sp.symbols(f"{item.func.__name__}0:{count}") for item in group}
    trial = {item: sp.Add(*(c * x**k for k, c in enumerate(names[item]))) for item in group}
    conditions = []
    for equation in hamilton(static_action()).equations.values():
        residual = sp.expand(equation.subs(trial).doit())
        conditions += sp.Poly(residual, x).coeffs()
    every = [c for item in group for c in names[item]]
    (solution,) = sp.solve(conditions, every[::-1], dict=True)
    free = tuple(c for c in every if c not in solution)
    if len(free) != count:
        raise ValueError(f"{len(free)} free coefficients for {count} nodal values")
    return {item: trial[item].xreplace(solution) for item in group}, free


def static_action() -> ActionDensity:
    """Return less the strain energy of bending and shear, per length."""
    energy = bending * psi.diff(x) ** 2 / 2 + shear * (v.diff(x) - psi) ** 2 / 2
    return ActionDensity(x=x, t=t, length=length, fields=(v, psi), density=-energy)


def _form(spec: ModelSpec) -> MatrixForm:
    shapes = field_shapes(spec.formulation)
    rows = {
        "u": (u, 0),
        "strain": (u, 1),
        "v": (v, 0),
        "slope": (v, 1),
        "curvature": (v, 2),
        "third": (v, 3),
    }
    if psi in shapes:
        rows |= {"rotation": (psi, 0), "rotation_slope": (psi, 1), "rotation_second": (psi, 2)}
    arrays = []
    for name, (item, order) in rows.items():
        entries = (sp.diff(shape, x, order).subs(x, xi * length) for shape in shapes[item])
        arrays.append((name, sp.ImmutableDenseMatrix([[_safe(entry) for entry in entries]])))
    steps = shear_steps() if psi in shapes else Steps()
    return MatrixForm(tuple(arrays), steps.then((centred, 2 * xi - 1), (beyond, 1 - xi)))


def _safe(entry: sp.Expr) -> sp.Expr:
    """Return a polynomial in xi in factors that keep their digits.

    Linear factors hold the zeros at nodes.  Of the others those without shear do not vanish at the
    ends; about the middle their coefficients are smallest.  With next to no shear they may: then
    their values at the ends are coefficients of Bernstein's polynomials.
    """
    over, under = sp.fraction(sp.factor(entry))
    constant, factors = sp.factor_list(over, xi)
    kept = [constant / under]
    for factor, power in factors:
        if sp.degree(factor, xi) > 1:
            plain = sp.expand(factor.subs(xi, (centred + 1) / 2))
            factor = _bernstein(factor) if factor.has(shear_ratio) else plain
        kept.append(factor**power)
    return sp.Mul(*kept)


def _bernstein(polynomial: sp.Expr) -> sp.Expr:
    """Return a polynomial in xi in products of powers of xi and ``beyond = 1 - xi``."""
    listed = sp.Poly(polynomial, xi).all_coeffs()[::-1]
    n = len(listed) - 1
    total = sp.S.Zero
    for j in range(n + 1):
        value = sp.Add(*(sp.binomial(n - k, j - k) * listed[k] for k in range(j + 1)))
        total += sp.factor(value) * xi**j * beyond ** (n - j)
    return total


def _describe(spec: ModelSpec) -> Description:
    arguments = [
        Argument("xi", "ndarray, shape (...)", "", "Place in the element over its length, 0 to 1"),
        Argument("length", "float", "m", "Length of the element"),
    ]
    if spec.formulation == "timoshenko":
        arguments.append(Argument("bending_stiffness", "float", "N m^2", "EI"))
        arguments.append(Argument("shear_stiffness", "float", "N", "k G A"))
    labels = ", ".join(value.label for value in nodal_values(spec.formulation))
    return Description(
        title=f"Shape functions of the beam element {spec.formulation}",
        references=("Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6)",),
        arguments=tuple(arguments),
        kernel="shapes",
        summary="Return the shape functions and their derivatives by x",
        notes=(
            f"Nodal values, the columns: {labels}; u along the axis and v across it, r rotations, "
            "k curvatures; node 3 is the middle.",
        ),
    )


MODEL = Model(
    mechanism="beam_shapes",
    formulations=KINDS,
    energies=_form,
    describe=_describe,
)
