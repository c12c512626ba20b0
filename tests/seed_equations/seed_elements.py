"""Derived arrays of the beam elements in the order and with the letters of Aannaque."""

from __future__ import annotations

from functools import cache

import sympy as sp
from elastolink.derive.models import beam_elements as elements
from elastolink.derive.models import beam_shapes as shapes

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


@cache
def arrays(kind: str) -> dict[str, sp.Matrix]:
    """Return the matrices by name: energies of the derived shapes."""
    along, across = shape_rows(kind)
    strains = [row.diff(zeta, k) / L**k for row, k in ((along, 1), (across, 2), (across, 1))]
    mass, stiffness, geometric = (
        integral(along, rho * L) + integral(across, rho * L),
        integral(strains[0], EA * L) + integral(strains[1], EI * L),
        integral(strains[2], L),
    )
    return {"mass": mass, "stiffness": stiffness, "geometric_0": geometric}


def letters(expression: object) -> str:
    """Return LaTeX with the document's letters."""
    names = {
        L: sp.Symbol("L"),
        rho: sp.Symbol(r"\rho A"),
        EA: sp.Symbol("EA"),
        EI: sp.Symbol("EI"),
    }
    return sp.latex(sp.sympify(expression).subs(names))
