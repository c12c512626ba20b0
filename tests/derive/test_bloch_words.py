"""Bloch's recursion by machine: the words solve the equation, and nothing else would."""

from __future__ import annotations

from fractions import Fraction

import pytest
from elastolink.derive import bloch, latex
from elastolink.derive.bloch import Element, P, R, V, effective_words, wave_words

ORDERS = range(1, 8)


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


def test_assignments_are_counted():
    steps = bloch.assignments(3)
    wanted = [f"{x}{k}" for k in (1, 2, 3) for x in ("v", "h", "omega")]
    assert [step.target for step in steps] == wanted
    # k calls of act, project and resolve each, k (k-1)/2 products and as many differences.
    for order in range(1, 11):
        count = sum(step.operations for step in bloch.assignments(order))
        assert count == 3 * order + order * (order - 1)


def test_words_as_text_and_as_latex():
    assert bloch.word_text(("P", "V", "R", "R", "V", ("O", 3))) == "P V R^2 V O_3"
    assert repr(V @ R @ R - P) == "-1 P + 1 V R^2"
    assert repr(bloch.ZERO) == "0"
    assert latex.element_latex(bloch.ZERO) == ["0"]
    assert latex.element_latex(Element({("V",): Fraction(-3, 2), ("V", "V"): 2, (): 1})) == [
        "1",
        r"- \frac{3}{2} V",
        "+ 2 V^{2}",
    ]
    assert latex.word_latex(("H", ("O", 2), ("h", 1))) == r"H_{0} \Omega_{2} h_{1}"
