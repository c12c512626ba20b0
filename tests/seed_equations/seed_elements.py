"""Derived arrays of the beam elements in the order and with the letters of Aannaque."""

from __future__ import annotations

from functools import cache

import sympy as sp
from elastolink.derive.models import beam_elements as elements
from elastolink.derive.models import beam_shapes as shapes
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton

x, L = shapes.x, shapes.length
zeta = sp.Symbol("zeta", real=True)
rho, EA, EI = elements.density, elements.axial, shapes.bending
# Axial displacements first, then deflection and rotation node by node; the inner node between.
ORDERS = {
    "cubic": ("u1", "u2", "v1", "r1", "v2", "r2"),
    "internal_node": ("v1", "r1", "v3", "r3", "v2", "r2"),
    "curvature": ("v1", "r1", "k1", "v2", "r2", "k2"),
}


@cache
def places(kind: str) -> list[int]:
    """Return where the document's nodal values stand among those of the element."""
    labels = [value.label for value in shapes.nodal_values(kind)]
    return [labels.index(name) for name in ORDERS[kind]]


@cache
def arrays(kind: str) -> dict[str, sp.Matrix]:
    """Return the derived arrays by name, nodal values in the document's order."""
    derived = elements.MODEL.discretise(
        ModelSpec("beam_element", kind), hamilton(elements.beam_action(kind))
    )
    order = places(kind)
    return {
        name: sp.Matrix(matrix.extract(order, order if name != "load" else range(4)))
        for name, matrix in derived.arrays
    }


@cache
def shape_rows(kind: str) -> tuple[sp.Matrix, sp.Matrix]:
    """Return the derived shapes of u and v as rows, functions of zeta, in the document's order."""
    found = shapes.field_shapes(kind)
    rows = []
    for item in (shapes.u, shapes.v):
        values = [sp.expand(sp.sympify(e).subs(x, zeta * L)) for e in found[item]]
        rows.append(sp.Matrix([[values[i] for i in places(kind)]]))
    return rows[0], rows[1]


def integral(row: sp.Matrix, factor: sp.Expr) -> sp.Matrix:
    """Return ``int_0^1 factor row^T row dzeta`` of a row of polynomials."""

    def moments(product: sp.Expr) -> sp.Expr:
        powers = sp.Poly(product, zeta).all_coeffs()[::-1]
        return factor * sp.Add(*(c / (k + 1) for k, c in enumerate(powers)))

    return (row.T * row).applyfunc(moments)


def symmetric(upper: list[list[object]]) -> sp.Matrix:
    """Return a symmetric matrix from the rows of its upper triangle."""
    n = len(upper)
    return sp.Matrix(n, n, lambda i, j: upper[min(i, j)][max(i, j) - min(i, j)])


def same(one: object, other: object) -> bool:
    """Return True where two matrices are equal identically."""
    return (sp.Matrix(one) - sp.Matrix(other)).applyfunc(sp.simplify).is_zero_matrix


def letters(expression: object) -> str:
    """Return LaTeX with the document's letters."""
    names = {
        L: sp.Symbol("L"),
        rho: sp.Symbol(r"\rho A"),
        EA: sp.Symbol("EA"),
        EI: sp.Symbol("EI"),
    }
    return sp.latex(sp.sympify(expression).subs(names))
