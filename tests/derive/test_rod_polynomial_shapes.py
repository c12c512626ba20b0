"""Emitted piecewise polynomial shapes: from their definition, on both sides of the block."""

from __future__ import annotations

import pytest
import sympy as sp
from elastolink.derive.models.rod_polynomials import MODEL
from elastolink.derive.spec import ModelSpec

eta, xi = sp.symbols("eta xi", positive=True)
SPEC = ModelSpec("quick_return", "rod_polynomials")
KERNELS = {kernel.name: kernel.form for kernel in MODEL.energies(SPEC).kernels}
FREE = eta**3 - 2 * eta + sp.Rational(1, 3)  # any polynomial will do
LENGTH = {"bay": xi, "tail": 1 - xi}
LOCAL = {"bay": eta / xi, "tail": (eta - xi) / (1 - xi)}


def definition(name):
    """Return the whole shape in (eta, xi) with a polynomial chosen, and the kernel's arguments."""
    kind, side = name.split("_")
    s = LOCAL[side]
    place = {"eta": eta, "gap": eta - xi, "xi": xi, "s": s, "length": LENGTH[side]}
    if kind == "through":
        rates = {f"p_d{k}": sp.diff(FREE, eta, k) for k in (1, 2, 3)}
        factor = eta if side == "bay" else xi
        return factor * (eta - xi) * FREE, {**place, "p": FREE, **rates}
    rates = {f"j_d{k}": sp.diff(FREE, eta, k).subs(eta, s) for k in (1, 2, 3)}
    factors = {"turn_bay": s * (s - 1), "turn_tail": s}
    factors |= {"bubble_bay": s * (1 - s) ** 2, "bubble_tail": s**2}
    local = FREE.subs(eta, s)
    return LENGTH[side] * factors[name] * local, {**place, "j": local, **rates}


@pytest.mark.parametrize("name", sorted(KERNELS))
def test_kernels_are_the_derivatives_of_the_shape(name):
    shape, arguments = definition(name)
    expected = {
        "value": shape,
        "slope": sp.diff(shape, eta),
        "curvature": sp.diff(shape, eta, 2),
        "shear": sp.diff(shape, eta, 3),
        "drift": sp.diff(shape, xi),
        "drift_curvature": sp.diff(shape, xi, eta, eta),
    }
    for output, formula in KERNELS[name].outputs:
        chosen = {symbol: arguments[symbol.name] for symbol in formula.free_symbols}
        assert sp.simplify(formula.subs(chosen, simultaneous=True) - expected[output]) == 0
