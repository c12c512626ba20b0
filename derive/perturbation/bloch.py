"""Bloch's recursion as straight-line assignments: what is emitted, and what is run exactly.

The words say ``Omega_2 = R V Omega_1 - R Omega_1 h_1``; the assignments say

    v2 = act(omega1);  h2 = project(v2);  omega2 = resolve(v2 - combine(omega1, h1))

in an algebra that is handed in: V is ``act``, R ``resolve``, P ``project``, and a column times an
effective operator ``combine``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

from .words import Element, Letter, Word, effective_words, recursion, word_text

CALLS = {"V": "act", "R": "resolve", "P": "project"}
COMBINE = "combine"
HIGHEST_ORDER = 10
LISTED_ORDER = 6  # 42 words; the next order has 132


@dataclass(frozen=True)
class Term:
    """One term of a sum: a named value, or two of them combined.

    Attributes
    ----------
    sign : int
        1 or -1.
    names : tuple of str
        One name, or a column and an effective operator.
    """

    sign: int
    names: tuple[str, ...]


@dataclass(frozen=True)
class Assignment:
    """``target = call(sum of terms)``."""

    target: str
    call: str
    terms: tuple[Term, ...]

    @property
    def operations(self) -> int:
        """Operations of the algebra: the call, the products, the additions."""
        return 1 + sum(len(term.names) - 1 for term in self.terms) + len(self.terms) - 1


@dataclass(frozen=True)
class Recursion:
    """Bloch's recursion up to each of several orders, and the words that it amounts to.

    Attributes
    ----------
    orders : tuple of int
        Up to which orders it is wanted.
    listed : int
        Up to which order the words are listed.
    """

    orders: tuple[int, ...]
    listed: int

    def only(self, names: tuple[str, ...]) -> Recursion:
        """Return the recursion to some of the orders, by the names of the functions.

        Raises
        ------
        ValueError
            If one is not there.
        """
        known = {function_name(order): order for order in self.orders}
        unknown = sorted(set(names) - set(known))
        if unknown:
            raise ValueError(f"unknown outputs {unknown}; expected some of {list(known)}")
        return Recursion(tuple(known[name] for name in known if name in names), self.listed)

    def words(self) -> tuple[tuple[int, tuple[tuple[int, str], ...]], ...]:
        """Return the words of ``h_k`` and their coefficients, order by order."""
        return tuple(
            (k, tuple((_whole(v), word_text(w)) for w, v in effective_words(k).terms.items()))
            for k in range(1, self.listed + 1)
        )


def function_name(order: int) -> str:
    """Return the name of the function that goes up to an order."""
    return f"order_{order}"


def _whole(value: Any) -> int:
    if value.denominator != 1:
        raise ValueError(f"coefficient {value}: expected a whole number")
    return int(value)


@lru_cache(maxsize=32)
def assignments(order: int) -> tuple[Assignment, ...]:
    """Return the recursion up to an order as assignments, in order of evaluation.

    Raises
    ------
    ValueError
        If the derived words are not of the form that the algebra serves.
    """
    found: list[Assignment] = []
    for step in recursion(order):
        for target, element in (("h", step.effective), ("omega", step.wave)):
            call, rest = _common_letter(element)
            terms = []
            for word, value in rest.items():
                if word[0] == "V":
                    moved = Assignment(f"v{step.order}", "act", (Term(1, _names(word[1:])),))
                    if moved not in found:
                        found.append(moved)
                    terms.append(Term(_sign(value), (moved.target,)))
                else:
                    terms.append(Term(_sign(value), _names(word)))
            found.append(Assignment(f"{target}{step.order}", call, tuple(terms)))
    return tuple(found)


def _sign(value: Any) -> int:
    if abs(value) != 1:
        raise ValueError(f"coefficient {value}: expected 1 or -1")
    return int(value)


def _common_letter(element: Element) -> tuple[str, dict[Word, Any]]:
    """Return the call that stands for the first letter of all words, and the words after it."""
    first = {word[0] for word in element.terms}
    if len(first) != 1 or not first <= {"P", "R"}:
        raise ValueError(f"{element!r}: expected words that all begin with P, or all with R")
    return CALLS[str(*first)], {word[1:]: value for word, value in element.terms.items()}


def _names(word: Word) -> tuple[str, ...]:
    """Return the names of the values of a word of known letters: ``Omega_j`` or ``Omega_j h_i``."""
    kinds = "".join(letter[0] for letter in word)
    if kinds not in ("P", "O", "Oh"):
        raise ValueError(f"{word_text(word)}: expected a column, or one times h")
    return tuple(map(_name, word))


def _name(letter: Letter) -> str:
    if not isinstance(letter, tuple):
        return "start"  # Omega_0, which is P
    return {"O": "omega", "h": "h"}[letter[0]] + str(letter[1])


class Algebra(Protocol):
    """What the recursion acts on; its columns can be added and subtracted."""

    start: Any

    def act(self, column: Any) -> Any:
        """Return V applied to a column."""

    def resolve(self, column: Any) -> Any:
        """Return R applied to a column."""

    def project(self, column: Any) -> Any:
        """Return P of a column as an effective operator."""

    def combine(self, column: Any, effective: Any) -> Any:
        """Return a column times an effective operator."""


def run(algebra: Algebra, order: int) -> dict[str, Any]:
    """Carry out the assignments; return all values by name (``h1``, ``omega1``, ...)."""
    values: dict[str, Any] = {"start": algebra.start}
    for assignment in assignments(order):
        total: Any = None
        for term in assignment.terms:
            item = values[term.names[0]]
            if len(term.names) == 2:
                item = algebra.combine(item, values[term.names[1]])
            if total is None:
                total = item if term.sign > 0 else -item
            else:
                total = total + item if term.sign > 0 else total - item
        values[assignment.target] = getattr(algebra, assignment.call)(total)
    return values
