"""Words in operators, and from them Bloch's recursion and the terms of the effective operator.

An operator equation is solved in powers of a parameter by keeping account of words: products of
letters that do not commute, with rational coefficients.  The letters are

``H``
    the unperturbed operator, measured from the level of the resonant states;
``V``
    the perturbation;
``P``
    the projector on the resonant states, so that ``H P = P H = 0``;
``R``
    the reduced resolvent, ``-1/H`` beyond the resonant states and zero on them:
    ``H R = R H = P - 1`` and ``P R = R P = 0``;
``O`` and ``h`` with an index
    the unknown coefficients of the wave operator and of the effective operator.

What is known of the letters is a list of rules that shorten words; everything else is found from
``(H + t V) Omega = Omega h`` and ``P Omega = P`` by equating powers of t.

As straight-line assignments the words ``Omega_2 = R V Omega_1 - R Omega_1 h_1`` are

    v2 = act(omega1);  h2 = project(v2);  omega2 = resolve(v2 - combine(omega1, h1))

in an algebra that is handed in: V is ``act``, R ``resolve``, P ``project``, and a column times an
effective operator ``combine``.  That is what is emitted, a function per order, and what is run
exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Any, TypeAlias

from .ir import UNBROKEN, Description, Kernel, ModuleSpec, Result, Statement, Table
from .spec import ModelSpec

Letter: TypeAlias = str | tuple[str, int]
Word: TypeAlias = tuple[Letter, ...]


class Element:
    """A sum of words with rational coefficients, always in shortest form.

    Parameters
    ----------
    terms : mapping of tuple to Fraction
        Words and their coefficients; they are shortened by the rules, zeros dropped.
    """

    __slots__ = ("terms",)

    def __init__(self, terms: Mapping[Word, Fraction | int]) -> None:
        found: dict[Word, Fraction] = {}
        pending = [(word, Fraction(value)) for word, value in terms.items()]
        while pending:
            word, value = pending.pop()
            place, rule = _rule(word)
            if rule is None:
                found[word] = found.get(word, Fraction(0)) + value
            else:
                head, tail = word[:place], word[place + 2 :]
                pending += [(head + middle + tail, value * sign) for middle, sign in rule.items()]
        kept = {word: value for word, value in found.items() if value}
        self.terms: dict[Word, Fraction] = dict(sorted(kept.items(), key=_in_order))

    def __add__(self, other: Element) -> Element:
        """Return the sum."""
        found = dict(self.terms)
        for word, value in other.terms.items():
            found[word] = found.get(word, Fraction(0)) + value
        return Element(found)

    def __neg__(self) -> Element:
        """Return the element with its signs changed."""
        return Element({word: -value for word, value in self.terms.items()})

    def __sub__(self, other: Element) -> Element:
        """Return the difference."""
        return self + (-other)

    def __matmul__(self, other: Element) -> Element:
        """Return the product, this element to the left."""
        found: dict[Word, Fraction] = {}
        for left, first in self.terms.items():
            for right, second in other.terms.items():
                found[left + right] = found.get(left + right, Fraction(0)) + first * second
        return Element(found)

    def __eq__(self, other: object) -> bool:
        """Compare term by term."""
        return isinstance(other, Element) and self.terms == other.terms

    def __hash__(self) -> int:
        """Agree with the comparison."""
        return hash(frozenset(self.terms.items()))

    def __bool__(self) -> bool:
        """Return False for zero."""
        return bool(self.terms)

    def __len__(self) -> int:
        """Return the number of words."""
        return len(self.terms)

    def __repr__(self) -> str:
        """Return the words as text."""
        parts = (f"{value} {word_text(word)}" for word, value in self.terms.items())
        return " + ".join(parts) or "0"

    def put(self, values: Callable[[Letter], Element | None]) -> Element:
        """Return the element with elements in the place of letters.

        ``values``: a letter to what stands for it, or to None where it stays.
        """
        total = ZERO
        for word, value in self.terms.items():
            product = Element({(): value})
            for letter in word:
                found = values(letter)
                product = product @ (letter_of(letter) if found is None else found)
            total = total + product
        return total

    def solved_for(self, letter: Letter) -> Element:
        """Return what a letter has to be for the element to vanish.

        Raises ``ValueError`` if the letter does not occur as a word of its own, or occurs in others
        too.
        """
        own = self.terms.get((letter,), Fraction(0))
        rest = {word: value for word, value in self.terms.items() if word != (letter,)}
        if not own or any(letter in word for word in rest):
            raise ValueError(f"{self!r} does not determine {letter}")
        return Element({word: -value / own for word, value in rest.items()})


def _in_order(item: tuple[Word, Fraction]) -> tuple[tuple[str, int], ...]:
    """Sort by letters; a letter without index comes before those with one."""
    order = {"P": 0, "R": 1, "V": 2, "H": 3, "O": 4, "h": 5}
    return tuple(
        (str(order[letter[0]]), letter[1] if isinstance(letter, tuple) else 0) for letter in item[0]
    )


def _rule(word: Word) -> tuple[int, dict[Word, int] | None]:
    """Return the first place where a rule applies, and what replaces the pair of letters there."""
    for place, pair in enumerate(pairwise(word)):
        found = _shorter(*pair)
        if found is not None:
            return place, found
    return 0, None


def _shorter(first: Letter, second: Letter) -> dict[Word, int] | None:
    """Return what two neighbouring letters amount to, None where nothing is known of them."""
    kinds = first[0] + second[0]
    if kinds == "PP":
        return {("P",): 1}
    if kinds in ("PR", "RP", "PH", "HP", "PO", "Rh", "hR", "Hh", "hH", "OR", "OH"):
        # O maps from the resonant states to the others, h from the resonant ones to them.
        return {}
    if kinds in ("HR", "RH"):
        return {("P",): 1, (): -1}
    if kinds in ("Ph", "OP", "hP"):
        return {(second if kinds == "Ph" else first,): 1}
    return None


def letter_of(letter: Letter) -> Element:
    """Return a letter as an element."""
    return Element({(letter,): 1})


ZERO = Element({})
H, V, P, R = (letter_of(name) for name in "HVPR")


@dataclass(frozen=True)
class Step:
    """One order of the recursion.

    Attributes
    ----------
    order : int
        Power of the parameter.
    effective : Element
        ``h_k`` in terms of V, P and ``Omega_(k-1)``.
    wave : Element
        ``Omega_k`` in terms of V, R and the earlier ``Omega_j``, ``h_j``.
    """

    order: int
    effective: Element
    wave: Element


def equation(order: int) -> Element:
    """Return the coefficient of ``t^order`` in ``(H + t V) Omega - Omega h``.

    The unknowns are left as letters, but for what ``P Omega = P`` says: ``Omega_0 = P``.
    ``h_0`` vanishes, because H does on the resonant states.
    """
    left = H @ _unknown("O", order)
    if order:
        left = left + V @ _unknown("O", order - 1)
    right = ZERO
    for j in range(order + 1):
        right = right + _unknown("O", j) @ _unknown("h", order - j)
    return left - right


def _unknown(kind: str, order: int) -> Element:
    if order == 0:
        return P if kind == "O" else ZERO
    return letter_of((kind, order))


@lru_cache(maxsize=32)
def recursion(order: int) -> tuple[Step, ...]:
    """Derive Bloch's recursion up to an order, by equating powers of the parameter.

    The part of each equation on the resonant states determines ``h_k``, the rest, inverted by the
    resolvent, determines ``Omega_k``.

    ``order``: highest power, at least 1.
    """
    steps = []
    for k in range(1, order + 1):
        whole = equation(k)
        effective = (P @ whole).solved_for(("h", k))
        # R H Omega_k = (P - 1) Omega_k = -Omega_k, for P Omega_k vanishes.
        wave = (R @ whole).solved_for(("O", k))
        steps.append(Step(k, effective, wave))
    return tuple(steps)


@lru_cache(maxsize=32)
def wave_words(order: int) -> Element:
    """Return ``Omega_order`` as words in P, V and R alone."""
    if order == 0:
        return P
    return recursion(order)[-1].wave.put(_earlier)


@lru_cache(maxsize=32)
def effective_words(order: int) -> Element:
    """Return ``h_order`` as words in P, V and R alone (Bloch's brackets).

    There are 1, 1, 2, 5, 14, 42 ... of them, Catalan's numbers.
    """
    return recursion(order)[-1].effective.put(_earlier)


def _earlier(letter: Letter) -> Element | None:
    if not isinstance(letter, tuple):
        return None
    kind, order = letter
    return wave_words(order) if kind == "O" else effective_words(order)


def word_text(word: Word) -> str:
    """Return a word as text, repeated resolvents as a power: ``P V R^2 V P V P``."""
    parts: list[str] = []
    power = 0
    for letter in (*word, ""):
        if letter == "R":
            power += 1
            continue
        if power:
            parts.append("R" if power == 1 else f"R^{power}")
            power = 0
        if letter:
            parts.append(letter if isinstance(letter, str) else f"{letter[0]}_{letter[1]}")
    return " ".join(parts)


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

        Raises ``ValueError`` if one is not there.
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

    Raises ``ValueError`` if the derived words are not of the form that the algebra serves.
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


def lower_recursion(spec: ModelSpec, recursion: Recursion, description: Description) -> ModuleSpec:
    """Return the module of the recursion: each function goes on from the one before it."""
    before = (0, *recursion.orders)
    return ModuleSpec(
        spec=spec,
        family="recursion",
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=tuple(
            _kernel(order, known, description)
            for known, order in zip(before, recursion.orders, strict=False)
        ),
        tables=(Table("WORDS", dict(recursion.words()), _WORDS),),
    )


_WORDS = (
    "The effective operator written out: order, then coefficient and word of each term.  Between "
    "two V stands P, or a power of R."
)


def _kernel(order: int, known: int, description: Description) -> Kernel:
    """Return the function up to an order, given the one up to a known order (0: none)."""
    steps = assignments(order)
    new = steps[len(assignments(known)) if known else 0 :]
    statements = [Statement(step.target, _text(step)) for step in new]
    made = range(known + 1, order + 1)
    returned = [[f"{letter}{k}" for k in made] for letter, _ in _RETURNED]
    if known:
        arguments = ", ".join(argument.name for argument in description.arguments)
        names = ", ".join(name for _, name in _RETURNED)
        unpacked = [
            Statement(_listed([f"{letter}{k}" for k in range(1, known + 1)]), name)
            for letter, name in _RETURNED
        ]
        call = Statement(names, f"{function_name(known)}({arguments})")
        statements = [call, *unpacked, *statements]
        returned = [[f"*{name}", *new] for (_, name), new in zip(_RETURNED, returned, strict=True)]
    return Kernel(
        name=function_name(order),
        summary=f"Return the effective operators and the columns up to order {order}",
        arguments=description.arguments,
        results=tuple(
            Result(name, f"tuple of {order}", "", f"``{word}_1`` and on, {source}")
            for name, word, source in (
                ("effective", "h", "each as ``project`` gives it"),
                ("wave", "Omega", "each as ``resolve`` gives it"),
            )
        ),
        statements=tuple(statements),
        returns=tuple(
            f"({', '.join(names)}{',' if len(names) == 1 else ''})" for names in returned
        ),
        operations=sum(step.operations for step in steps),
    )


# Letters of the values, and names of the tuples that hold them.
_RETURNED = (("h", "effective"), ("omega", "wave"))


def _listed(names: list[str]) -> str:
    """Return names with commas between; a single one as a tuple."""
    return ", ".join(names) if len(names) > 1 else f"({names[0]},)"


def _text(step: Assignment) -> str:
    """Return the right side; a line may be broken between terms, nowhere else."""
    first, *others = step.terms
    parts = ["" if first.sign > 0 else "-", _product(first)]
    for term in others:
        parts += [" +" if term.sign > 0 else " -", UNBROKEN, _product(term)]
    return f"{step.call}({''.join(parts)})"


def _product(term: Term) -> str:
    if len(term.names) == 1:
        return term.names[0]
    return f"{COMBINE}({f',{UNBROKEN}'.join(term.names)})"
