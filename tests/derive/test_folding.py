"""Scalars folded before they meet an array, and arrays released when they are done with."""

from __future__ import annotations

import ast
import importlib
import inspect
import json

import numpy as np
import sympy as sp
from elastolink import generated
from elastolink.derive.ir import Argument, Result
from elastolink.derive.lowering import fold_scalars, lower_kernel, to_line
from elastolink.derive.staged import Steps
from emitted_accuracy import MANIFEST

a, b, c, x, y = sp.symbols("a b c x y")


def test_a_product_of_scalars_is_named_once():
    steps, (one, two) = fold_scalars(Steps(((y, a * b * sp.sin(x)),)), [a * b * y, a * b], "abc")
    named = dict(steps.steps)
    (name,) = (s for s, value in named.items() if value == a * b)
    assert named[y] == name * sp.sin(x)
    assert (one, two) == (name * y, a * b)
    assert steps.inline(one) == a**2 * b**2 * sp.sin(x)


def test_signs_and_lone_symbols_stay_where_they_are():
    steps, outputs = fold_scalars(Steps(), [-a * x, a * x, 2 * x, -2 * a * x, a + b + x], "abc")
    values = [steps.inline(output) for output in outputs]
    assert values == [-a * x, a * x, 2 * x, -2 * a * x, a + b + x]
    assert outputs[:3] == [-a * x, a * x, 2 * x]
    assert [value for _, value in steps.steps] == [2 * a, a + b]


def test_scalars_lead_a_product_and_carry_its_sign():
    assert to_line(x * a * y * b, (a, b)) == "a * b * x * y"
    assert to_line(a * (-x - y), (a,)) == "-a * (x + y)"
    assert to_line(-x - a * y, (a,)) == "-a * y - x"
    assert to_line(y - x) == "y - x"


def test_arrays_are_released_after_their_last_use_and_never_used_again():
    entries = json.loads(MANIFEST.read_text())["modules"].values()
    released = 0
    for entry in entries:
        module = importlib.import_module(f"{generated.__name__}.{entry['module']}")
        for name in module.RETURNS:
            released += _check_releases(getattr(module, name))
    assert released > 1000


def _check_releases(function):
    (tree,) = ast.parse(inspect.getsource(function)).body
    gone: set[str] = set()
    for statement in tree.body:
        if isinstance(statement, ast.Delete):
            names = {target.id for target in statement.targets}
            assert not names & gone
            gone |= names
            continue
        used = {node.id for node in ast.walk(statement) if isinstance(node, ast.Name)}
        assert not used & gone, (function, used & gone)
    return len(gone)


def test_a_released_kernel_still_computes():
    argument = Argument("x", "ndarray, shape (...)", "", "x")
    steps = Steps(tuple((sp.Symbol(f"s{i}"), sp.sin(x + i)) for i in range(8)))
    total = sum((s * sp.Symbol(f"s{i + 1}") for i, (s, _) in enumerate(steps.steps[:-1])), x)
    kernel = lower_kernel("k", "Return", (argument,), steps, [(Result("f", "", "", ""), total)])
    assert not any(set(s.release) & set(kernel.returns[0].split()) for s in kernel.statements)
    scope = {"xp": np, "x": np.linspace(0.0, 1.0, 5)}
    for statement in kernel.statements:
        scope[statement.target] = eval(statement.expression, scope)
        for name in statement.release:
            del scope[name]
    found = eval(kernel.returns[0], scope)
    expected = sp.lambdify(x, steps.inline(total))(np.linspace(0.0, 1.0, 5))
    np.testing.assert_allclose(found, expected, rtol=1e-14)
