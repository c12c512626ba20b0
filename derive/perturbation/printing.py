"""Bloch's recursion and its words in operator notation, as LaTeX.

The sums over harmonics that the words stand for are set at run time, from the emitted table:
``elastolink.runtime.hill.series``.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import groupby

from .bloch import Recursion
from .words import Element, Letter, Word, effective_words, recursion

Line = tuple[str, list[str]]
_LETTERS = {"H": "H_{0}", "O": r"\Omega", "h": "h"}


def word_latex(word: Word) -> str:
    """Return a word, repeated letters as powers."""
    parts = []
    for letter, run in groupby(word):
        count = len(list(run))
        text = _letter(letter)
        parts.append(text if count == 1 else f"{text}^{{{count}}}")
    return " ".join(parts) or "1"


def _letter(letter: Letter) -> str:
    if isinstance(letter, tuple):
        return f"{_LETTERS[letter[0]]}_{{{letter[1]}}}"
    return _LETTERS.get(letter, letter)


def element_latex(element: Element) -> list[str]:
    """Return the terms of an element, each after the first with its sign; ``0`` for none."""
    terms = []
    for place, (word, value) in enumerate(element.terms.items()):
        sign = "-" if value < 0 else "+" if place else ""
        terms.append(f"{sign} {_size(abs(value))}{word_latex(word)}".lstrip())
    return terms or ["0"]


def _size(value: Fraction) -> str:
    if value == 1:
        return ""
    if value.denominator == 1:
        return f"{value.numerator} "
    return rf"\frac{{{value.numerator}}}{{{value.denominator}}} "


def recursion_lines(system: Recursion) -> Iterator[Line]:
    """Yield ``h_k`` and ``Omega_k`` in terms of the earlier ones: left sides, signed terms."""
    for step in recursion(max(system.orders)):
        yield f"h_{{{step.order}}}", element_latex(step.effective)
        yield rf"\Omega_{{{step.order}}}", element_latex(step.wave)


def word_lines(system: Recursion) -> Iterator[Line]:
    """Yield the ``h_k`` written out in P, V and R."""
    for order in range(1, system.listed + 1):
        yield f"h_{{{order}}}", element_latex(effective_words(order))
