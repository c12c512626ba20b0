"""Bloch's recursion by machine: the words solve the equation, and nothing else would."""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from math import comb

import numpy as np
import pytest
from elastolink.derive import bloch, latex
from elastolink.derive.bloch import Element, H, P, R, V, effective_words, wave_words

ORDERS = range(1, 8)


def test_the_rules_are_those_of_a_projector_and_its_resolvent():
    one = Element({(): 1})
    assert P @ P == P
    assert not P @ R and not R @ P and not H @ P and not P @ H
    assert H @ R == R @ H == P - one
    assert V @ V != V and R @ R != R
    assert R @ H @ R == -R
    assert not V - V and len(V + R) == 2 and hash(V + R) == hash(R + V)


@pytest.mark.parametrize("order", ORDERS)
def test_the_words_solve_the_equation_of_their_order(order):
    assert bloch.remainder(0) == bloch.ZERO
    assert bloch.remainder(order) == bloch.ZERO
    assert P @ wave_words(order) == bloch.ZERO  # P Omega = P
    assert wave_words(order) @ P == wave_words(order)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_no_other_sign_of_a_word_would_do(order):
    """The guard of the test above: each word is needed with just its coefficient."""
    for kind, right in (("O", wave_words(order)), ("h", effective_words(order))):
        for word, value in right.terms.items():
            spoiled = Element({**right.terms, word: -value})

            def values(letter, kind=kind, spoiled=spoiled):
                if letter == (kind, order):
                    return spoiled
                return bloch._earlier(letter)

            assert bloch.equation(order).put(values)


@pytest.mark.parametrize("order", range(1, 9))
def test_there_are_catalans_number_of_words(order):
    found = effective_words(order)
    assert len(found) == comb(2 * order - 2, order - 1) // order
    for word, value in found.terms.items():
        assert word[0] == word[-1] == "P"
        assert word.count("V") == order and word.count("R") == order - 1
        # One sign for each P between the ends.
        assert value == (-1) ** (word.count("P") - 2 if order > 1 else 0)


def test_the_third_order_is_the_one_of_the_textbooks():
    """Bloch, Nucl. Phys. 6 (1958) 329: a V S V S V a - a V S^2 V a V a, with S for R."""
    first = {("P", "V", "R", "V", "R", "V", "P"): 1}
    second = {("P", "V", "R", "R", "V", "P", "V", "P"): -1}
    assert effective_words(3) == Element(first | second)


def test_with_matrices_the_equation_holds_to_the_order():
    """Five states, two of them resonant, a full perturbation without symmetry."""
    levels, rows, columns = [0, 0, 2, -3, 7], *np.indices((5, 5))
    known = {
        "H": np.diag(levels),
        "P": np.diag([1, 1, 0, 0, 0]),
        "R": np.diag([Fraction(-1, level) if level else 0 for level in levels]),
        "V": (3 * rows**2 + 5 * columns + rows * columns) % 7 - 3,
    }
    known = {name: matrix.astype(object) + Fraction(0) for name, matrix in known.items()}

    def value(element):
        products = (
            factor * reduce(np.matmul, map(known.get, word))
            for word, factor in element.terms.items()
        )
        return sum(products, np.zeros((5, 5), dtype=object))

    omega = [value(wave_words(k)) for k in range(6)]
    h = [None, *(value(effective_words(k)) for k in range(1, 6))]
    for k in range(1, 6):
        left = known["H"] @ omega[k] + known["V"] @ omega[k - 1]
        assert np.all(left == sum(omega[j] @ h[k - j] for j in range(k)))
    assert np.any(h[5] != 0)


def test_an_unknown_is_found_only_where_it_stands_alone():
    unknown = bloch.letter_of(("O", 2))
    assert (unknown + unknown + V).solved_for(("O", 2)) == Element({("V",): Fraction(-1, 2)})
    for bad in (V, unknown + V @ unknown):
        with pytest.raises(ValueError, match="does not determine"):
            bad.solved_for(("O", 2))


def test_assignments_count_and_refuse():
    steps = bloch.assignments(3)
    wanted = [f"{x}{k}" for k in (1, 2, 3) for x in ("v", "h", "omega")]
    assert [step.target for step in steps] == wanted
    # k calls of act, project and resolve each, k (k-1)/2 products and as many differences.
    for order in range(1, 11):
        count = sum(step.operations for step in bloch.assignments(order))
        assert count == 3 * order + order * (order - 1)
    with pytest.raises(ValueError, match="begin with P"):
        bloch._common_letter(V @ P)
    with pytest.raises(ValueError, match="expected 1 or -1"):
        bloch._sign(Fraction(2))
    with pytest.raises(ValueError, match="a column"):
        bloch._names(("V", "V"))
    with pytest.raises(ValueError, match="whole number"):
        bloch._whole(Fraction(1, 2))


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


def test_latex_lines_of_the_recursion():
    system = bloch.Recursion((1, 2), 2)
    assert list(latex.recursion_lines(system)) == [
        ("h_{1}", ["P V P"]),
        (r"\Omega_{1}", ["R V P"]),
        ("h_{2}", [r"P V \Omega_{1}"]),
        (r"\Omega_{2}", [r"R V \Omega_{1}", r"- R \Omega_{1} h_{1}"]),
    ]
    assert list(latex.word_lines(system)) == [("h_{1}", ["P V P"]), ("h_{2}", ["P V R V P"])]
