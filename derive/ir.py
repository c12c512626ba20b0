"""The intermediate representation: what an emitted module consists of, in plain text and tables.

No SymPy object gets past this point.  Standard library only.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .spec import Family, ModelSpec

IR_VERSION = 1
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
    """One returned array of an emitted function."""

    name: str
    shape: str
    unit: str
    meaning: str


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
    references : tuple of str
        Equations of the documents that the function stands for.
    operations : int
        Arithmetic operations per evaluation.
    """

    name: str
    summary: str
    arguments: tuple[Argument, ...]
    results: tuple[Result, ...]
    statements: tuple[Statement, ...]
    returns: tuple[str, ...]
    references: tuple[str, ...] = ()
    operations: int = 0
    broadcast: tuple[str, ...] = ()


@dataclass(frozen=True)
class TermRow:
    """One separated term of a linear-periodic system: which pieces multiply to what.

    Attributes
    ----------
    array : str
        ``M A B S C D K Kg`` or ``f h g p`` (design: system forms).
    power : int
        Power of the crank speed that multiplies the term in the equation of motion in time.
    scale, angle, modal : str or None
        Names of the parameter monomial, the function of angle and the modal array; None means 1
        (for ``modal``: the identity, or a vector of ones).  Where ``modal`` is an integral over
        shapes that the caller passes in, it stands among the module's basis rows, or is returned
        by its function ``basis_products``.
    """

    array: str
    power: int
    scale: str | None
    angle: str | None
    modal: str | None


@dataclass(frozen=True)
class BasisRow:
    """An integral over shapes that the caller passes in (see :class:`.arrays.BasisIntegral`).

    Attributes
    ----------
    name : str
        Its name in the terms.
    weight : tuple of float
        Coefficients of the weight by powers of eta, from the constant one on.
    row, column : tuple of int
        Derivatives by eta and xi of the two factors; ``column`` is None for a vector.
    at : float or None
        Value of eta where it is no integral.
    """

    name: str
    weight: tuple[float, ...]
    row: tuple[int, int]
    column: tuple[int, int] | None
    at: float | None


@dataclass(frozen=True)
class ModuleSpec:
    """Everything that a template needs to lay out one module.

    Attributes
    ----------
    spec : ModelSpec
        The model that was asked for.
    family : str
        System family; chooses the template.
    title : str
        First line of the module's docstring.
    notes : tuple of str
        Sentences for the module's docstring.
    references : tuple of str
        Equations of the documents.
    kernels : tuple of Kernel
        The functions, in order.
    terms : tuple of TermRow
        Separated terms; linear-periodic family only.
    parameters : tuple of Argument
        Inertial and elastic parameters, with units.
    basis : tuple of BasisRow
        Integrals over shapes that the caller passes in; linear-periodic family only.
    words : tuple of (int, tuple of (int, str))
        Words of the effective operator and their coefficients by order; recursion family only.
    """

    spec: ModelSpec
    family: Family
    title: str
    notes: tuple[str, ...]
    references: tuple[str, ...]
    kernels: tuple[Kernel, ...]
    terms: tuple[TermRow, ...] = ()
    parameters: tuple[Argument, ...] = ()
    tables: tuple[tuple[str, str], ...] = field(default=())
    basis: tuple[BasisRow, ...] = ()
    words: tuple[tuple[int, tuple[tuple[int, str], ...]], ...] = ()

    @property
    def operations(self) -> int:
        """Arithmetic operations of all kernels together."""
        return sum(kernel.operations for kernel in self.kernels)
