"""Scalars folded before they meet an array, and arrays released when they are done with."""

from __future__ import annotations

import ast
from pathlib import Path

import sympy as sp
from elastolink import generated
from elastolink.derive.lowering import fold_scalars, to_line
from elastolink.derive.staged import Steps

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
