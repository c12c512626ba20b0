"""From the source of an emitted function to that of a loop over points: same operations and order.

Nothing is derived again and no template is filled in: the statements are the emitted ones, with
the functions of the array namespace replaced by those of one number.
"""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NoReturn

from ..core.errors import bad

# Functions of the array namespace, and those of one number.
_OF_ONE = {
    "abs": "_math.fabs",
    "atan2": "_math.atan2",
    "cos": "_math.cos",
    "cosh": "_math.cosh",
    "exp": "_math.exp",
    "expm1": "_math.expm1",
    "floor": "_np.floor",
    "sin": "_math.sin",
    "sinh": "_math.sinh",
    "sqrt": "_math.sqrt",
    "tan": "_math.tan",
}
_OPERATIONS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Mod, ast.Pow)
_COMPARISONS = (ast.Gt, ast.GtE, ast.Lt, ast.LtE, ast.Eq, ast.NotEq)
_KIND = "elementwise arithmetic of an emitted module"
_FIX = "use the function as it is"
# What NumPy makes of numbers alone: plain ones of plain ones, its own scalar in any case, an array
# without axes; and comparisons, of which no arithmetic is made.
PLAIN, SCALAR, ARRAY, _TRUTH = "plain", "scalar", "array", "truth"


@dataclass(frozen=True)
class Output:
    """What one of the returned values depends on.

    Attributes
    ----------
    arguments : tuple of int
        Places of the arguments that it depends on, rising.
    kind : str
        What NumPy returns where these are numbers: ``plain`` numbers from plain numbers, its
        ``scalar`` in any case, or an ``array`` without axes.
    bare : bool
        True where it is an argument itself.
    constant : int, float or None
        Its value, where that is a plain number whatever the arguments.
    """

    arguments: tuple[int, ...]
    kind: str
    bare: bool = False
    constant: float | None = None


@dataclass(frozen=True)
class Loop:
    """An emitted function as a loop over points.

    Attributes
    ----------
    module, name : str
        Of the emitted function; the module's last name.
    arguments : tuple of str
        Its arguments.
    outputs : tuple of Output
        What it returns.
    single : bool
        True where it returns one value, not a tuple.
    text : str
        Source of a module with the function ``loop(points, layout, values, out)``.  Argument k
        starts in ``values`` at ``layout[2 k]`` and moves on by ``layout[2 k + 1]`` per point;
        the outputs follow alike in ``out``.
    """

    module: str
    name: str
    arguments: tuple[str, ...]
    outputs: tuple[Output, ...]
    single: bool
    text: str


def loop_of(function: Callable[..., Any]) -> Loop:
    """Return the loop over points of an emitted function.

    Parameters
    ----------
    function : callable
        A function of an emitted module.

    Raises
    ------
    BadInput
        If it is none, its file has changed since it was loaded, or it does anything else than
        arithmetic on each point.
    """
    module = emitted_module(function)
    name: str = function.__name__
    where = f"{module.__name__}.{name}"
    try:
        text = Path(inspect.getsourcefile(module) or "").read_text(encoding="utf-8")
    except (OSError, TypeError):
        raise bad(where, "no source", "an emitted module with its file", _FIX) from None
    if f'CONTENT = "{module.CONTENT}"' not in text:
        fix = "start Python again"
        raise bad(where, "a file that changed since it was loaded", "the same file", fix)
    found = [
        node
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef) and node.name == name
    ]
    if not found:
        raise bad(where, "no such function in the file", _KIND, _FIX)
    return _Rewriting(where, found[0]).loop(module, name)


def emitted_module(function: object) -> ModuleType:
    """Return the emitted module that a function belongs to.

    Raises
    ------
    BadInput
        If it belongs to none.
    """
    module = sys.modules.get(getattr(function, "__module__", None) or "")
    if module is None or not is_emitted(function):
        found = getattr(function, "__qualname__", repr(function))
        raise bad("function", found, "a function of an emitted module", _FIX)
    return module


def is_emitted(function: object) -> bool:
    """Return True for a function of an emitted module."""
    if not isinstance(function, FunctionType):
        return False
    module = sys.modules.get(function.__module__)
    return (
        all(hasattr(module, name) for name in ("CONTENT", "RETURNS"))
        and getattr(module, function.__name__, None) is function
    )


class _Rewriting(ast.NodeTransformer):
    """One function on its way: what each of its names depends on, and its statements."""

    def __init__(self, where: str, tree: ast.FunctionDef) -> None:
        self._where, self._tree = where, tree
        given = tree.args
        if given.vararg or given.kwarg or given.kwonlyargs or given.defaults or given.posonlyargs:
            self._refuse("arguments that are not plain")
        self.arguments = tuple(argument.arg for argument in given.args)
        if not self.arguments:
            self._refuse("no argument")
        # Of each name: the arguments that it depends on, what NumPy makes of it, and whether it is
        # one of them.
        self._known = {
            name: Output((place,), PLAIN, True) for place, name in enumerate(self.arguments)
        }
        self._namespace = ""

    def loop(self, module: ModuleType, name: str) -> Loop:
        """Return the loop."""
        *body, closing = self._tree.body
        if not isinstance(closing, ast.Return) or closing.value is None:
            self._refuse("no value returned at the end")
        lines = [line for statement in body for line in self._statement(statement)]
        single = not isinstance(closing.value, ast.Tuple)
        values = closing.value.elts if isinstance(closing.value, ast.Tuple) else [closing.value]
        outputs = tuple(self._facts(value) for value in values)
        if any(output.kind == _TRUTH for output in outputs):
            self._refuse("a comparison returned")
        moved = len(self.arguments)
        for place, value in enumerate(values):
            start, step = 2 * (moved + place), 2 * (moved + place) + 1
            made = ast.unparse(self.visit(value))
            lines.append(f"_out[_layout[{start}] + _k * _layout[{step}]] = {made}")
        given = [
            f"{own} = _values[_layout[{2 * k}] + _k * _layout[{2 * k + 1}]]"
            for k, own in enumerate(self.arguments)
        ]
        text = "\n".join(
            (
                f'"""Loop over the points of {module.__name__}.{name}; made, not written."""',
                "",
                "import math as _math",
                "",
                "import numpy as _np",
                "",
                f'CONTENT = "{module.CONTENT}"',
                "",
                "",
                "def loop(_points, _layout, _values, _out):",
                "    for _k in range(_points):",
                *(f"        {line}" for line in given + lines),
                "",
            )
        )
        last = module.__name__.rpartition(".")[2]
        return Loop(last, name, self.arguments, outputs, single, text)

    def _statement(self, statement: ast.stmt) -> Iterator[str]:
        match statement:
            case ast.Expr(value=ast.Constant(value=str())) | ast.Delete():
                return  # the docstring, and memory that single numbers need not give back
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id="_namespace"))
            ):
                self._namespace = name
                return
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                facts = self._facts(value)
                made = ast.unparse(self.visit(value))
                self._known[name] = facts
                yield f"{name} = {made}"
            case _:
                self._refuse(f"line {statement.lineno}: {ast.unparse(statement)[:60]}")

    def _facts(self, node: ast.expr) -> Output:
        """Return what a value depends on; refuse what is no arithmetic on each point."""
        match node:
            case ast.Name(id=name) if name in self._known and not name.startswith("_"):
                return self._known[name]
            case ast.Constant(value=(int() | float()) as value):
                return Output((), PLAIN, constant=value)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self._valued(node, self._joined(operand))
            case ast.BinOp(left=left, op=operation, right=right) if isinstance(
                operation, _OPERATIONS
            ):
                return self._valued(node, self._joined(left, right))
            case ast.Compare(left=left, ops=[operation], comparators=[right]) if isinstance(
                operation, _COMPARISONS
            ):
                return self._joined(left, right, kind=_TRUTH)
            case ast.Call(func=ast.Attribute(value=ast.Name(id=owner), attr=name)) if (
                owner == self._namespace
            ):
                return self._call(node, name)
        self._refuse(f"line {node.lineno}: {ast.unparse(node)[:60]}")

    def _valued(self, node: ast.expr, facts: Output) -> Output:
        """Return what is known of arithmetic, its value included where it is one of constants."""
        if facts.arguments or facts.kind != PLAIN:
            return facts
        known = {name: own.constant for name, own in self._known.items()}
        value = eval(compile(ast.Expression(node), "<constant>", "eval"), {}, known)
        return replace(facts, constant=value)

    def _call(self, node: ast.Call, name: str) -> Output:
        keywords = {word.arg: ast.unparse(word.value) for word in node.keywords}
        match name, node.args:
            case "asarray", [tested] if keywords == {"dtype": f"{self._namespace}.float64"}:
                return self._joined(kind=ARRAY, tested=tested)
            case "where", [tested, *values] if len(values) == 2 and not keywords:
                return self._joined(*values, kind=ARRAY, tested=tested)
            case _ if name in _OF_ONE and len(node.args) == 1 + (name == "atan2") and not keywords:
                return self._joined(*node.args, kind=SCALAR)
        self._refuse(f"line {node.lineno}: {ast.unparse(node)[:60]}")

    def _joined(self, *parts: ast.expr, kind: str = "", tested: ast.expr | None = None) -> Output:
        found = [self._facts(part) for part in parts]
        for part, facts in zip(parts, found, strict=True):
            if facts.kind == _TRUTH:
                self._refuse(f"line {part.lineno}: arithmetic with {ast.unparse(part)[:60]}")
        if tested is not None:
            found.append(self._facts(tested))
            if found[-1].kind != _TRUTH:
                self._refuse(f"line {tested.lineno}: a choice by {ast.unparse(tested)[:60]}")
        # Arithmetic turns arrays without axes into NumPy's scalars.
        own = PLAIN if all(part.kind == PLAIN for part in found) else SCALAR
        needed = sorted({place for part in found for place in part.arguments})
        return Output(tuple(needed), kind or own)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """Replace a function of the array namespace by that of one number."""
        self.generic_visit(node)
        assert isinstance(node.func, ast.Attribute)  # as _facts has seen
        if node.func.attr == "where":
            return ast.IfExp(*node.args)
        if node.func.attr == "asarray":
            return ast.IfExp(node.args[0], ast.Constant(1.0), ast.Constant(0.0))
        return ast.Call(ast.parse(_OF_ONE[node.func.attr], mode="eval").body, node.args, [])

    def _refuse(self, found: str) -> NoReturn:
        raise bad(self._where, found, _KIND, _FIX)
