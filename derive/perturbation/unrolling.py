"""Bloch's recursion lowered to the intermediate representation: one function per order."""

from __future__ import annotations

from ..describe import Description
from ..ir import UNBROKEN, Kernel, ModuleSpec, Result, Statement
from ..spec import ModelSpec
from .bloch import COMBINE, Assignment, Recursion, Term, assignments, function_name


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
        words=recursion.words(),
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
    last = "" if order == 1 else f" to ``{{}}_{order}``"
    return Kernel(
        name=function_name(order),
        summary=f"Return the effective operators and the columns up to order {order}",
        arguments=description.arguments,
        results=tuple(
            Result(name, f"tuple of {order}", "", f"``{word}_1``{last.format(word)}, {source}")
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
