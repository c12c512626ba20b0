"""Printing, common subexpressions, order and layout of what the pipeline emits."""

import ast
from pathlib import Path
from types import SimpleNamespace

import array_api_strict
import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink import generated
from elastolink.derive.ir import Argument, Result
from elastolink.derive.lowering import CannotPrint, count_operations, lower_kernel, to_line
from elastolink.derive.staged import Steps
from hypothesis import assume, given, settings
from hypothesis import strategies as st

x, y, z = sp.symbols("x y z", positive=True)
m, n = sp.symbols("m n", integer=True, positive=True)
MPMATH = SimpleNamespace(**{**vars(mpmath), "abs": abs})


class _Exact(ast.NodeTransformer):
    """Turn every literal of a line into a call, so that 1 / 3 is not rounded."""

    def visit_Constant(self, node):
        return ast.Call(ast.Name("number", ast.Load()), [ast.Constant(repr(node.value))], [])


def evaluate(line, values):
    """Evaluate a printed line in the working precision of mpmath."""
    tree = ast.fix_missing_locations(_Exact().visit(ast.parse(line, mode="eval")))
    scope = {"xp": MPMATH, "number": mpmath.mpf, **values}
    return eval(compile(tree, "line", "eval"), {"__builtins__": {}}, scope)


def run(line, **values):
    return eval(line, {"xp": np, **values})


LEAVES = st.one_of(
    st.sampled_from([x, y, z]),
    st.integers(-4, 4).map(sp.Integer),
    st.builds(sp.Rational, st.integers(-7, 7), st.integers(2, 9)),
)


def _grow(inner):
    return st.one_of(
        st.builds(sp.Add, inner, inner),
        st.builds(sp.Mul, inner, inner),
        st.builds(lambda a, b: a - b, inner, inner),
        st.builds(lambda a, b: a / b if b != 0 else a, inner, inner),
        st.builds(lambda a, k: a**k if a != 0 else a, inner, st.integers(-3, 3)),
        st.builds(lambda a: sp.sqrt(a**2 + 1), inner),
        st.builds(lambda a: (a**2 + 2) ** sp.Rational(3, 2), inner),
        st.builds(lambda a: (a**2 + 2) ** sp.Rational(-5, 3), inner),
        st.builds(sp.sin, inner),
        st.builds(lambda a: sp.exp(-(a**2)), inner),
        st.builds(lambda a, b: sp.atan2(a, b**2 + 1), inner, inner),
        st.builds(sp.Abs, inner),
    )


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.recursive(LEAVES, _grow, max_leaves=12))
def test_a_printed_line_means_the_expression(expression):
    assume(expression.is_finite is not False and not expression.has(sp.zoo, sp.nan, sp.oo))
    values = {"x": "0.73", "y": "1.9", "z": "3.1"}
    with mpmath.workdps(60):
        numbers = {name: mpmath.mpf(value) for name, value in values.items()}
        expected = sp.lambdify((x, y, z), expression, "mpmath")(*numbers.values())
        assume(mpmath.isfinite(expected) and abs(expected) < 1e30)
        found = evaluate(to_line(expression), numbers)
        # Numbers such as sqrt(2) are printed as doubles.
        assert abs(found - expected) <= 1e-9 * (1 + abs(expected)) or abs(expected) < 1e-9
        if not any(a.is_number and not a.is_Rational for a in sp.preorder_traversal(expression)):
            assert abs(found - expected) <= mpmath.mpf(10) ** -40 * (1 + abs(expected))


def test_numbers_are_rounded_once():
    """pi^4 squared up from a rounded pi is off by more than one rounding."""
    for number in (sp.pi, sp.pi**4, sp.pi**2 / 3, sp.sqrt(2) * sp.pi, sp.exp(1) + 1, sp.sin(1)):
        assert float(to_line(number)) == float(sp.N(number, 40))
    assert run(to_line(-sp.sqrt(3))) == -float(sp.sqrt(3).n(40))


@pytest.mark.parametrize("first, second", [(1, 0), (0, 1), (3, 1), (-2, sp.Rational(1, 2))])
def test_a_choice_between_numbers_runs_in_every_namespace(first, second):
    line = to_line(sp.Piecewise((sp.sympify(first), sp.Eq(x, y)), (sp.sympify(second), True)))
    one, other = np.array([1.0, 2.0]), np.array([1.0, 3.0])
    expected = np.array([float(first), float(second)])
    np.testing.assert_array_equal(run(line, x=one, y=other), expected)
    xp = array_api_strict
    strict = eval(line, {"xp": xp, "x": xp.asarray(one), "y": xp.asarray(other)})
    np.testing.assert_array_equal(np.asarray(strict), expected)


@pytest.mark.parametrize(
    "expression",
    [
        sp.gamma(x),
        sp.Function("f")(x),
        x**y,
        sp.I,
        sp.oo,
        sp.zoo * x,
        sp.Derivative(sp.Function("f")(x), x),
        sp.Integral(x, x),
        sp.Piecewise((1, x > 2), (2, x > 1), (3, True)),
        sp.Piecewise((x, sp.Ne(m, n)), (y, True)),
        sp.Matrix([x]),
    ],
)
def test_what_has_no_emitted_form_is_refused(expression):
    with pytest.raises(CannotPrint):
        to_line(expression)


def kernel(outputs, steps=None, arguments=("x", "y", "z")):
    made = tuple(Argument(name, "float", "", name) for name in arguments)
    results = [(Result(f"r{i}", "float", "", ""), e) for i, e in enumerate(outputs)]
    return lower_kernel("k", "Return", made, steps or Steps(), results)


def call(made, **values):
    scope = dict(values, xp=np)
    for statement in made.statements:
        scope[statement.target] = eval(statement.expression, scope)
    return [eval(text, scope) for text in made.returns]


def test_steps_that_no_output_needs_are_pruned_and_the_rest_stands_in_order():
    a, b, c = sp.symbols("a b c")
    steps = Steps(((a, x + y), (b, sp.sin(a)), (c, sp.cos(x))))
    made = kernel([b * z], steps)
    assert [s.target for s in made.statements] == ["a", "b"]
    assert call(made, x=1.0, y=2.0, z=3.0) == [3.0 * np.sin(3.0)]


def test_a_symbol_from_nowhere_is_refused():
    with pytest.raises(CannotPrint, match="w is neither an argument nor a step"):
        kernel([x * sp.Symbol("w")])


def test_a_sign_that_alternates_needs_an_integer():
    made = kernel([(-1) ** (m + n) * x], arguments=("m", "n", "x"))
    assert call(made, m=2.0, n=3.0, x=5.0) == [-5.0]
    with pytest.raises(CannotPrint, match="for integers alone"):
        kernel([(-1) ** x])


def test_operations_are_counted_by_what_is_evaluated():
    assert count_operations([x + y * z]) == 2
    assert count_operations([sp.sin(x)]) == 1
    assert count_operations([sp.pi**2 * x / 3]) == 1
    assert count_operations([]) == 0


def test_no_statement_of_an_emitted_function_is_idle_and_arrays_are_released():
    released = 0
    for path in Path(generated.__path__[0]).glob("*.py"):
        for function in ast.parse(path.read_text()).body:
            if not isinstance(function, ast.FunctionDef) or function.name.startswith("_"):
                continue
            names = [node for node in ast.walk(function) if isinstance(node, ast.Name)]
            stored, loaded, gone = (
                {node.id for node in names if isinstance(node.ctx, kind)}
                for kind in (ast.Store, ast.Load, ast.Del)
            )
            assert stored - {"xp"} <= loaded, (path.name, function.name)
            released += len(gone)
    assert released > 1000
