"""Arrays with explicit entries: what is emitted, what is left out, what is passed in."""

import numpy as np
import pytest
import sympy as sp
from derivations import loaded
from elastolink.derive import authoring as au
from elastolink.derive.emission import emit
from elastolink.derive.entries import (
    ConstrainedSystem,
    MatrixForm,
    TranscendentalSystem,
    lower_constrained,
    lower_matrices,
)
from elastolink.derive.external import external_values
from elastolink.derive.ir import ModuleSpec
from elastolink.derive.lowering import CannotPrint
from elastolink.derive.pipeline import Model, module_text
from elastolink.runtime.core.families.emitted import array_function

t, m, k = sp.symbols("t m k", real=True)
a, b = sp.symbols("a b", real=True)
SPEC = au.ModelSpec("some", "thing")
PARAMETERS = (au.scalar("m", "kg", "Mass"), au.scalar("k", "N/m", "Stiffness"))
WORDS = au.Description(title="Some thing", references=("hand",), parameters=PARAMETERS)


def emitted(spec: ModuleSpec):
    return loaded(emit(spec, "0"))


def motion(energy: sp.Expr, *coordinates: sp.Expr, constraints=(), forces=None):
    return au.euler_lagrange(
        au.Lagrangian(coordinates, t, energy, tuple(constraints), forces=forces or {})
    )


def coordinate(name: str) -> sp.Expr:
    return sp.Function(name)(t)


def matrices(*arrays: tuple[str, sp.Matrix]) -> ModuleSpec:
    words = au.Description(
        title="Matrices",
        references=("hand",),
        arguments=(au.scalar("a", "", "First"), au.scalar("b", "", "Second")),
        kernel="element",
        summary="Return matrices",
    )
    form = MatrixForm(tuple((name, sp.ImmutableDenseMatrix(value)) for name, value in arrays))
    return lower_matrices(SPEC, form, words)


def test_equal_entries_are_returned_once_and_zeros_never():
    spec = matrices(("K", sp.Matrix([[a, -b, 0], [-b, a, 0]])), ("f", sp.Matrix([a])))
    assert len(spec.kernels[0].returns) == 2
    function = array_function(emitted(spec), "element")
    found = function(2.0, np.array([3.0, 4.0]))
    np.testing.assert_array_equal(found["K"][1], [[2, -4, 0], [-4, 2, 0]])
    np.testing.assert_array_equal(found["f"], [[[2.0]], [[2.0]]])


def test_entries_without_arguments_take_the_batch():
    function = array_function(emitted(matrices(("I", sp.eye(2)), ("O", sp.zeros(1, 3)))), "element")
    found = function(np.zeros((4, 1)), np.zeros(5))
    assert found["I"].shape == (4, 5, 2, 2)
    assert found["O"].shape == (4, 5, 1, 3)
    np.testing.assert_array_equal(found["I"][2, 3], np.eye(2))


def test_a_function_of_zeros_is_not_emitted():
    spec = matrices(("O", sp.zeros(2, 2)))
    assert spec.kernels == ()
    np.testing.assert_array_equal(array_function(emitted(spec), "element")(1.0, 2.0)["O"], 0.0)


def test_an_undeclared_symbol_is_refused():
    with pytest.raises(CannotPrint, match="stray"):
        matrices(("K", sp.Matrix([a + sp.Symbol("stray")])))


def test_open_functions_are_passed_in():
    """A bead on a wire y = shape(x) that is lifted by y0(t)."""
    x, lift = coordinate("x"), sp.Function("lift")(t)
    y = lift + sp.Function("shape")(x)
    equations = motion(m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) - k * y, x)
    module = emitted(lower_constrained(SPEC, ConstrainedSystem(equations), WORDS))
    assert module.EXTERNAL == ("lift_d1", "lift_d2", "shape_d1", "shape_d2")
    passed = {"lift_d1": 0.3, "lift_d2": -1.1, "shape_d1": 0.7, "shape_d2": 0.4}
    found = array_function(module, "dynamics")(0.2, 1.5, 0.0, **passed, m=2.0, k=5.0)
    # m (1 + y'^2) x.. + m y' (y'' x.^2 + lift..) + k y' = 0 by hand
    assert found["mass"][0, 0] == pytest.approx(2.0 * (1 + 0.7**2), rel=1e-15)
    by_hand = 2.0 * 0.7 * (0.4 * 1.5**2 - 1.1) + 5.0 * 0.7
    assert found["rest"][0, 0] == pytest.approx(by_hand, rel=1e-14)


def test_one_open_function_has_one_argument():
    x = coordinate("x")
    f = sp.Function("f")
    with pytest.raises(ValueError, match="f is applied to"):
        external_values([f(x) + f(2 * x)])
    with pytest.raises(ValueError, match="one argument"):
        external_values([sp.Function("g")(x, t)])


def test_dynamic_stiffness_is_square():
    with pytest.raises(ValueError, match="not square"):
        TranscendentalSystem(a, sp.ImmutableDenseMatrix([[a, b]]), sp.S.Zero)


def test_a_continuum_does():
    x = sp.Symbol("x")
    y = sp.Function("y")(x, t)
    action = au.ActionDensity(x, t, sp.S.One, (y,), y.diff(t) ** 2 - y.diff(x) ** 2)
    model = Model("some", ("thing",), lambda spec: action, lambda spec: WORDS)
    with pytest.raises(TypeError, match="discretise"):
        module_text(SPEC, model, "0")
