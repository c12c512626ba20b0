"""Errors and warnings of the toolkit, each saying what is wrong and how to mend it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

# Deflection over the length of its link beyond which linear equations are no longer believed.
LINEAR_RANGE = 0.05
# Characters of what was given that a message shows.
_LONGEST = 200


class ElastolinkError(Exception):
    """Base of every error that elastolink raises on purpose."""


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input."""

    where: str  # the object or key concerned, for example ``links.crank``
    found: str  # what was given
    expected: str  # what would have been accepted
    fix: str  # the likely remedy, in one sentence

    def __str__(self) -> str:
        """Return the one-line form shown to the user."""
        # Arrays and records print on many lines.
        found = " ".join(self.found.split())
        if len(found) > _LONGEST:
            found = f"{found[:_LONGEST]} ..."
        return f"{self.where}: found {found}; expected {self.expected}; {self.fix}"


class BadInput(ElastolinkError, ValueError):  # noqa: N818 - reads as what it is
    """An input is unusable; every problem with it is listed.

    Parameters
    ----------
    *problems : Problem
        At least one problem.
    """

    def __init__(self, *problems: Problem) -> None:
        self.problems = problems
        super().__init__("\n".join(str(problem) for problem in problems))


class RedundantConstraints(BadInput):
    """Constraints repeat or contradict each other, or leave a motion without inertia free."""


class SelfCheckFailed(ElastolinkError):  # noqa: N818
    """A result does not pass its own checks."""


class ElastolinkWarning(UserWarning):
    """Base of every warning that elastolink issues."""


class LinearRangeWarning(ElastolinkWarning):
    """A deflection left the range in which the linear equations hold."""


def bad(where: str, found: object, expected: str, fix: str) -> BadInput:
    """Return a :class:`BadInput` with one problem."""
    return BadInput(Problem(where, str(found), expected, fix))


def warn_of_large_deflection(
    largest: float | None,
    length: str = "the reference length",
    fix: str = "leave out resonant speeds or add damping",
    *,
    stacklevel: int = 3,
) -> None:
    """Warn whoever called the caller where a deflection over the length is beyond 5 %."""
    if largest is not None and largest > LINEAR_RANGE:
        warnings.warn(
            f"deflection reaches {largest:.3g} of {length}; the linear equations hold to about "
            f"{LINEAR_RANGE}: {fix}",
            LinearRangeWarning,
            stacklevel=stacklevel,
        )
