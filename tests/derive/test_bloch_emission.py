"""The emitted recursion says what was derived, in any algebra that it is handed."""

from __future__ import annotations

import ast
import inspect

import numpy as np
import pytest
from elastolink.derive import bloch
from elastolink.derive.latex import latex_document
from elastolink.derive.models.hill import RECURSION as MODEL
from elastolink.derive.pipeline import module_text
from elastolink.derive.spec import ModelSpec
from elastolink.generated import hill_recursion

SPEC = ModelSpec("hill", "recursion")
ORDERS = range(1, 11)


def run(order, start, act, resolve, project, combine, module=hill_recursion):
    return getattr(module, f"order_{order}")(start, act, resolve, project, combine)


def run_in(algebra, order):
    calls = (algebra.act, algebra.resolve, algebra.project, algebra.combine)
    return run(order, algebra.start, *calls)


@pytest.mark.parametrize("order", range(1, 8))
def test_with_words_for_its_algebra_it_returns_the_words(order):
    """Operators are letters, columns are sums of words: the emitted text proves itself."""
    effective, wave = run(
        order,
        bloch.P,
        lambda x: bloch.V @ x,
        lambda x: bloch.R @ x,
        lambda x: bloch.P @ x,
        lambda x, h: x @ h,
    )
    assert list(effective) == [bloch.effective_words(k) for k in range(1, order + 1)]
    assert list(wave) == [bloch.wave_words(k) for k in range(1, order + 1)]


class Plain:
    """Plain matrices, as the module's docstring describes them, without any symmetry."""

    def __init__(self, levels, v):
        self.levels, self.v = levels, v
        self.resonant = np.flatnonzero(levels == 0.0)
        self.start = np.eye(len(levels))[:, self.resonant]
        away = np.where(levels == 0.0, np.inf, levels)
        self.r = np.diag(-1.0 / away)

    def act(self, x):
        return self.v @ x

    def resolve(self, x):
        return self.r @ x

    def project(self, x):
        return x[self.resonant]

    def combine(self, x, h):
        return x @ h


def slopes(found, exact):
    return np.log2(np.abs(found[0] - exact[0]).max() / np.abs(found[1] - exact[1]).max())


def resonant_eigenvalues(h):
    return np.sort_complex(np.linalg.eigvals(h))


@pytest.mark.parametrize("order", [1, 2, 3, 5])
def test_resonant_states_of_different_levels_need_another_resolve_alone(order):
    """As the docstring says: resolve solves y h_0 - H y = (1 - P) x."""
    rng = np.random.default_rng(4)
    levels = np.array([0.1, -0.2, 1.5, -2.0, 3.0])
    v = rng.uniform(-1.0, 1.0, (5, 5))

    class Split(Plain):
        def resolve(self, x):
            out = x / (levels[:2] - levels[:, None] + np.eye(5, 2))
            out[:2] = 0.0
            return out

    algebra = Split(np.where(np.arange(5) < 2, 0.0, levels), v)
    effective, _ = run_in(algebra, order)
    found, exact = [], []
    for t in (0.04, 0.02):
        h = np.diag(levels[:2]) + sum(t**k * h for k, h in enumerate(effective, 1))
        found.append(resonant_eigenvalues(h))
        whole = np.linalg.eigvals(np.diag(levels) + t * v)
        exact.append(np.sort_complex(whole[np.argsort(np.abs(whole))[:2]]))
    assert slopes(found, exact) == pytest.approx(order + 1, abs=0.35)


# ---------------------------------------------------------------- the module as a text


def test_the_module_is_short_documented_and_needs_nothing():
    source = inspect.getsource(hill_recursion)
    tree = ast.parse(source)
    assert not [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
    assert max(map(len, source.splitlines())) <= 99
    assert source.isascii()
    assert hill_recursion.FAMILY == "recursion"
    assert list(hill_recursion.RETURNS) == [f"order_{k}" for k in ORDERS]
    assert {"start", "act", "resolve", "project", "combine"} <= set(hill_recursion.QUANTITIES)
    assert "order_4: 24 operations" in hill_recursion.__doc__


def test_a_single_order_stands_on_its_own():
    wanted = SPEC.with_(outputs=("order_4", "order_2"))
    text = module_text(wanted, MODEL, "0" * 32)
    space = {}
    exec(compile(text, "emitted", "exec"), space)
    assert space["__all__"] == ["order_2", "order_4"]
    levels = np.array([0.0, 0.0, 1.0, 2.0])
    algebra = Plain(levels, np.arange(16.0).reshape(4, 4) % 5 - 2)
    calls = (algebra.act, algebra.resolve, algebra.project, algebra.combine)
    for order in (2, 4):
        found = space[f"order_{order}"](algebra.start, *calls)
        for one, other in zip(found, run_in(algebra, order), strict=True):
            np.testing.assert_array_equal(one, other)
    with pytest.raises(ValueError, match="unknown outputs"):
        module_text(SPEC.with_(outputs=("order_11",)), MODEL, "0" * 32)


def test_the_latex_document_sets_the_recursion_and_the_words():
    text = latex_document([(SPEC, MODEL)])
    assert r"\Omega_{2} ={} &R V \Omega_{1} - R \Omega_{1} h_{1}" in text
    assert r"h_{3} ={} &- P V R^{2} V P V P + P V R V R V P" in text
    assert text.count("{") - text.count(r"\{") == text.count("}") - text.count(r"\}")
