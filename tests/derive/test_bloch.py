"""Bloch's recursion by machine: the words solve the equation, and the emitted text returns them."""

import numpy as np
import pytest
from elastolink.derive import bloch
from elastolink.derive.bloch import Element, P, R, V, effective_words, wave_words
from elastolink.generated import hill_recursion

ORDERS = range(1, 8)


def run(order, start, act, resolve, project):
    recursion = getattr(hill_recursion, f"order_{order}")
    return recursion(start, act, resolve, project, lambda x, h: x @ h)


@pytest.mark.parametrize("order", ORDERS)
def test_the_words_solve_the_equation_of_their_order(order):
    assert bloch.equation(0).put(bloch._earlier) == bloch.ZERO
    assert bloch.equation(order).put(bloch._earlier) == bloch.ZERO
    assert P @ wave_words(order) == bloch.ZERO  # P Omega = P
    assert wave_words(order) @ P == wave_words(order)


def test_the_third_order_is_the_one_of_the_textbooks():
    """Bloch, Nucl. Phys. 6 (1958) 329: a V S V S V a - a V S^2 V a V a, with S for R."""
    first = {("P", "V", "R", "V", "R", "V", "P"): 1}
    second = {("P", "V", "R", "R", "V", "P", "V", "P"): -1}
    assert effective_words(3) == Element(first | second)


@pytest.mark.parametrize("order", ORDERS)
def test_with_words_for_its_algebra_it_returns_the_words(order):
    """Operators are letters, columns are sums of words: the emitted text proves itself."""
    effective, wave = run(order, P, lambda x: V @ x, lambda x: R @ x, lambda x: P @ x)
    assert list(effective) == [effective_words(k) for k in range(1, order + 1)]
    assert list(wave) == [wave_words(k) for k in range(1, order + 1)]


@pytest.mark.parametrize("order", [1, 2, 3, 5])
def test_resonant_states_of_different_levels_need_another_resolve_alone(order):
    """As the docstring says: resolve solves y h_0 - H y = (1 - P) x."""
    levels = np.array([0.1, -0.2, 1.5, -2.0, 3.0])
    v = np.random.default_rng(4).uniform(-1.0, 1.0, (5, 5))

    def resolve(x):
        out = x / (levels[:2] - levels[:, None] + np.eye(5, 2))
        out[:2] = 0.0
        return out

    effective, _ = run(order, np.eye(5, 2), lambda x: v @ x, resolve, lambda x: x[:2])
    errors = []
    for t in (0.04, 0.02):
        h = np.diag(levels[:2]) + sum(t**k * h for k, h in enumerate(effective, 1))
        whole = np.linalg.eigvals(np.diag(levels) + t * v)
        exact = np.sort_complex(whole[np.argsort(np.abs(whole))[:2]])
        errors.append(np.abs(np.sort_complex(np.linalg.eigvals(h)) - exact).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order + 1, abs=0.35)
