"""The intermediate representation: what an emitted module consists of, in plain text and tables.

No SymPy object gets past this point.  Standard library only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .spec import Family, ModelSpec

IR_VERSION = 2
UNBROKEN = "\u00a0"  # a space of an expression at which its line is not to be broken


@dataclass(frozen=True)
class Argument:
    """One argument of an emitted function: its name, shape, unit and meaning."""

    name: str
    shape: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Result:
    """One returned array of an emitted function; without a meaning where its name says it."""

    name: str
    shape: str
    unit: str
    meaning: str


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


@dataclass(frozen=True)
class Statement:
    """One finished assignment, ``target = expression``.

    Attributes
    ----------
    target, expression : str
        Finished text.
    release : tuple of str
        Arrays that no later line needs: deleted here, so that their memory is used again.
    """

    target: str
    expression: str
    release: tuple[str, ...] = ()


@dataclass(frozen=True)
class Kernel:
    """One emitted function: straight-line code of finished statements.

    Attributes
    ----------
    name, summary : str
        Name of the function and first line of its docstring.
    arguments, results : tuple
        What goes in and what comes out, in order.
    statements : tuple of Statement
        The body, in order of evaluation.
    returns : tuple of str
        Finished expressions, one per result.
    operations : int
        Arithmetic operations per evaluation.
    """

    name: str
    summary: str
    arguments: tuple[Argument, ...]
    results: tuple[Result, ...]
    statements: tuple[Statement, ...]
    returns: tuple[str, ...]
    operations: int = 0


@dataclass(frozen=True)
class Table:
    """A constant of an emitted module: nested tuples and mappings of numbers, text and None.

    Attributes
    ----------
    name : str
        Under which the module holds it.
    value : tuple, dict, str, float or int
        What it holds.
    comment : str
        What a reader has to know of it.
    """

    name: str
    value: object
    comment: str = ""


def drops_table(dropped: Mapping[tuple[str, ...], object]) -> tuple[Table, ...]:
    """Return the table of terms that a module's user may leave out, if there are any."""
    return (Table("DROPS", dict(dropped), _DROPS),) if dropped else ()


_DROPS = (
    "Terms of the energies that may be left out, to the names of what then vanishes, or to the "
    "separated terms that go and those that come."
)


@dataclass(frozen=True)
class ModuleSpec:
    """Everything that the template needs to lay out one module.

    Attributes
    ----------
    spec : ModelSpec
        The model that was asked for.
    family : str
        System family.
    title : str
        First line of the module's docstring.
    notes : tuple of str
        Sentences for the module's docstring.
    references : tuple of str
        Equations of the documents.
    kernels : tuple of Kernel
        The functions, in order.
    parameters : tuple of Argument
        Inertial and elastic parameters, with units.
    tables : tuple of Table
        Constants: separated terms, places of entries, numbers.
    """

    spec: ModelSpec
    family: Family
    title: str
    notes: tuple[str, ...]
    references: tuple[str, ...]
    kernels: tuple[Kernel, ...]
    parameters: tuple[Argument, ...] = ()
    tables: tuple[Table, ...] = ()

    @property
    def operations(self) -> int:
        """Arithmetic operations of all kernels together."""
        return sum(kernel.operations for kernel in self.kernels)
