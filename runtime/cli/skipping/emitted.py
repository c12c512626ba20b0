"""What an emitted module costs, read from its text: nothing of it is imported or run."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...core.errors import bad

_COUNT = re.compile(r"^ {4}(\w+): (\d+) operations?$", re.MULTILINE)
_LEFT_OUT = re.compile(r"Left out of the energies: ([^.]*)\.")
_TABLES = ("FAMILY", "TERMS", "ARRAYS")


@dataclass(frozen=True)
class EmittedCost:
    """What one emitted module costs.

    Attributes
    ----------
    module : str
        Its name.
    family : str
        System family, empty where it names none.
    size : int
        Bytes of its text.
    operations : mapping of str to int
        Arithmetic operations per evaluation of each function, from its header.
    terms : tuple of tuple
        Rows of a linear-periodic module: array, power of the speed, scale, function of angle,
        modal array.
    entries : mapping of str to (int, int)
        Of each array of explicit entries, by ``function.array``: entries that are evaluated, and
        entries in all; the others are zero.
    left_out : tuple of str
        Terms that the formulation left out of the energies, from its header.
    """

    module: str
    family: str
    size: int
    operations: Mapping[str, int]
    terms: tuple[tuple[Any, ...], ...]
    entries: Mapping[str, tuple[int, int]]
    left_out: tuple[str, ...]

    @property
    def total(self) -> int:
        """Operations of all functions together."""
        return sum(self.operations.values())


def read_cost(path: Path) -> EmittedCost:
    """Read the cost of an emitted module from its header and tables.

    Parameters
    ----------
    path : Path
        Of the ``.py`` file.

    Raises
    ------
    BadInput
        If it is no emitted module.
    """
    text = path.read_text()
    tree = ast.parse(text)
    header = ast.get_docstring(tree, clean=False) or ""
    counts = {name: int(count) for name, count in _COUNT.findall(header)}
    if not counts:
        raise bad(str(path), "no operation counts", "an emitted module", "choose another file")
    left_out = _LEFT_OUT.search(header)
    tables = _tables(tree)
    return EmittedCost(
        module=path.stem,
        family=tables.get("FAMILY", ""),
        size=len(text.encode()),
        operations=MappingProxyType(counts),
        terms=tuple(tables.get("TERMS", ())),
        entries=MappingProxyType(_entries(tables.get("ARRAYS", {}))),
        left_out=tuple(left_out.group(1).split(", ")) if left_out else (),
    )


def _tables(tree: ast.Module) -> dict[str, Any]:
    """Return the literal tables of a module by name."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            if name in _TABLES:
                found[name] = ast.literal_eval(node.value)
    return found


def _entries(arrays: Mapping[str, Any]) -> dict[str, tuple[int, int]]:
    return {
        f"{function}.{name}": (len(filled), rows * columns)
        for function, tables in arrays.items()
        for name, ((rows, columns), filled) in tables.items()
    }
