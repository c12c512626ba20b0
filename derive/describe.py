"""The words of an emitted module: title, arguments, units, meanings, equations of the documents."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .ir import Argument, Result


@dataclass(frozen=True)
class Description:
    """What the derivation cannot know about a module.

    Attributes
    ----------
    title : str
        First line of the module's docstring, without the full stop.
    references : tuple of str
        Equations of the documents.
    arguments : tuple of Argument
        Arguments of the functions of angle or of a closed form, the array that sets the namespace
        first; of a constrained system, the coordinates and what else deserves a unit and words.
    kernel, summary : str
        Name and first docstring line of the function of a closed form.
    results : mapping of str to Result
        Returned quantities of a closed form by name.
    parameters : tuple of Argument
        Inertial and elastic parameters.
    notes : tuple of str
        Further paragraphs of the module's docstring.
    """

    title: str
    references: tuple[str, ...]
    arguments: tuple[Argument, ...] = ()
    kernel: str = ""
    summary: str = ""
    results: Mapping[str, Result] = field(default_factory=dict)
    parameters: tuple[Argument, ...] = ()
    notes: tuple[str, ...] = ()


def array_results(words: Mapping[str, tuple[str, str]]) -> dict[str, Result]:
    """Return results that have the shape of the crank angle, from unit and meaning by name."""
    return {name: Result(name, "ndarray, shape (...)", *pair) for name, pair in words.items()}
