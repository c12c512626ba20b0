"""Errors and warnings of the toolkit, each saying what is wrong and how to mend it."""

from __future__ import annotations

import unicodedata
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

# Deflection over the length of its link beyond which linear equations are no longer believed.
LINEAR_RANGE = 0.05
# Characters of what was given that a message shows.
_LONGEST = 200
# Problems of one input that are listed; a file of another kind may have a hundred thousand.
_MOST_TOLD = 20


def printable(text: str) -> str:
    """Return text without control characters, which could steer a terminal: they come escaped."""
    if text.isprintable():
        return text
    return "".join(c if unicodedata.category(c)[0] != "C" else repr(c)[1:-1] for c in text)


def one_line(text: str, longest: int = _LONGEST) -> str:
    """Return text as one printable line, cut where it is too long."""
    line = printable(" ".join(text.split()))
    return line if len(line) <= longest else f"{line[:longest]} ..."


def shown(value: object, longest: int = 60) -> str:
    """Return how a value is written, short enough for a message."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no whole number of more than 4300 digits
        return "a number of thousands of digits"
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


class ElastolinkError(Exception):
    """Base of every error that elastolink raises on purpose.

    Examples
    --------
    >>> import elastolink as el
    >>> print(issubclass(el.BadInput, el.ElastolinkError))
    True
    """


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input."""

    where: str  # the object or key concerned, for example ``links.crank``
    found: str  # what was given
    expected: str  # what would have been accepted
    fix: str  # the likely remedy, in one sentence

    def __str__(self) -> str:
        """Return the one-line form shown to the user."""
        # Arrays and records print on many lines, and names are the user's.
        where, found = one_line(self.where), one_line(self.found)
        return f"{where}: found {found}; expected {self.expected}; {self.fix}"


class BadInput(ElastolinkError, ValueError):  # noqa: N818 - reads as what it is
    """An input is unusable; ``problems`` holds all that is wrong, the message twenty of them.

    Parameters
    ----------
    *problems : Problem
        At least one problem.

    Examples
    --------
    >>> import elastolink as el
    >>> try:
    ...     el.FourBar(frame=1.0, crank=1.0, coupler=-5.0, follower=1.0)
    ... except el.BadInput as error:
    ...     print(error)
    FourBar.coupler: found -5.0; expected a positive finite length; correct it
    """

    def __init__(self, *problems: Problem) -> None:
        self.problems = problems
        super().__init__("\n".join(self.lines()))

    def lines(self) -> list[str]:
        """Return a line for each problem, and how many more there are beyond twenty."""
        told = [str(problem) for problem in self.problems[:_MOST_TOLD]]
        left = len(self.problems) - len(told)
        return [*told, f"and {left} more problems of this kind"] if left else told


class RedundantConstraints(BadInput):
    """Constraints repeat or contradict each other, or leave a motion without inertia free."""


class SelfCheckFailed(ElastolinkError):  # noqa: N818
    """A result does not pass its own checks."""


class ElastolinkWarning(UserWarning):
    """Base of every warning that elastolink issues."""


class LinearRangeWarning(ElastolinkWarning):
    """A deflection left the range in which the linear equations hold.

    Examples
    --------
    >>> import elastolink as el
    >>> import warnings
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping_ratio": 0.01})
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", el.LinearRangeWarning)
    ...     steady = el.steady_state(scene.system(), speed=70.0)
    >>> print((steady.peak(0.5) / scene.get("links.coupler")).round(2))
    0.08
    """


def bad(where: str, found: object, expected: str, fix: str) -> BadInput:
    """Return a :class:`BadInput` with one problem."""
    return BadInput(Problem(where, str(found), expected, fix))


def refuse(problems: Sequence[Problem]) -> None:
    """Raise :class:`BadInput` with all that is wrong, if anything is."""
    if problems:
        raise BadInput(*problems)


_beyond: ContextVar[list[float] | None] = ContextVar("beyond", default=None)


@contextmanager
def deflections_beyond() -> Iterator[list[float]]:
    """Collect the deflections of which this thread would warn here, in place of the warnings."""
    found: list[float] = []
    token = _beyond.set(found)
    try:
        yield found
    finally:
        _beyond.reset(token)


def warn_of_large_deflection(
    largest: float | None,
    length: str = "the reference length",
    fix: str = "leave out resonant speeds or add damping",
    *,
    nonlinear: str = "",
    stacklevel: int = 3,
) -> None:
    """Warn whoever called the caller where a deflection over the length is beyond 5 %.

    ``nonlinear``: the formulation, if any, in which the same scene has nonlinear equations.
    """
    if largest is not None and largest > LINEAR_RANGE:
        if (beyond := _beyond.get()) is not None:
            beyond.append(largest)
            return
        if nonlinear:
            fix += f"; formulation '{nonlinear}' goes on: `elastolink response`, docs/nonlinear.md"
        warnings.warn(
            f"deflection reaches {largest:.3g} of {length}; the linear equations hold to about "
            f"{LINEAR_RANGE}: {fix}",
            LinearRangeWarning,
            stacklevel=stacklevel,
        )
