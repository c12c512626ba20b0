"""What a sweep was asked for, as a digest: the same request, and no other, goes on in a store."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import partial
from pathlib import PurePath
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType
from typing import Any, Protocol

import numpy as np

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.trigonometric import GOLDEN
from .pieces import Grid
from .tasks import Task

FORMAT = 4

# What a function may take from its file and is known by its content, beside records.
_CONSTANTS = (bool, int, float, complex, str, tuple, list, dict, set, np.generic, np.ndarray)


class _Hash(Protocol):
    def update(self, data: bytes, /) -> None: ...


def request_of(
    task: Task,
    subject: object,
    grid: Grid,
    options: Mapping[str, object],
    outputs: tuple[str, ...] | None,
) -> dict[str, Any]:
    """Return what a manifest says of a request: names, counts and digests, ready for JSON."""
    from ... import __version__

    axes = [
        {
            "name": name,
            "count": len(axis),
            "first": float(axis[0]),
            "last": float(axis[-1]),
            "digest": digest(axis),
        }
        for name, axis in zip(grid.names, grid.axes, strict=True)
    ]
    return {
        "format": FORMAT,
        "task": task.name,
        "function": None if task.function is None else digest(task.function),
        "subject": digest(subject),
        "values": axes,
        "pieces": list(grid.parts),
        "options": {name: digest(value) for name, value in sorted(options.items())},
        "outputs": None if outputs is None else list(outputs),
        "elastolink": __version__,
        "numpy": np.__version__,
    }


def digest(value: object) -> str:
    """Return a digest that depends on content alone, not on addresses or the order of sets."""
    found = hashlib.sha256()
    _feed(found, value, ())
    return found.hexdigest()


def _feed(found: _Hash, value: object, above: tuple[int, ...]) -> None:
    """Add a value to a hash; ``above`` are those that hold it."""
    if id(value) in above:
        found.update(b"<again>")
        return
    inner = (*above, id(value))
    found.update(f"<{type(value).__module__}.{type(value).__qualname__}>".encode())
    if value is None or isinstance(value, (bool, int, str, bytes, PurePath)):
        found.update(repr(value).encode())
    elif isinstance(value, (float, complex, np.generic, np.ndarray)):
        _feed_numbers(found, np.asarray(value))
    elif isinstance(value, LinearPeriodic):
        _feed_system(found, value, inner)
    elif isinstance(value, Mapping):
        for key in sorted(value, key=str):
            _feed(found, key, inner)
            _feed(found, value[key], inner)
    elif isinstance(value, (tuple, list)):
        found.update(str(len(value)).encode())
        for item in value:
            _feed(found, item, inner)
    elif isinstance(value, (set, frozenset)):
        found.update("".join(sorted(digest(item) for item in value)).encode())
    elif is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            found.update(item.name.encode())
            _feed(found, getattr(value, item.name), inner)
    elif callable(value):
        _feed_callable(found, value, inner)
    else:
        _feed_pickled(found, value)


def _feed_numbers(found: _Hash, values: np.ndarray[Any, Any]) -> None:
    if values.dtype == object:
        raise _untold(values)
    found.update(f"{values.dtype.str}{values.shape}".encode())
    found.update(np.ascontiguousarray(values).tobytes())


def _feed_system(found: _Hash, system: LinearPeriodic, inner: tuple[int, ...]) -> None:
    """Add what a system does: its numbers, and its functions at some angles and parameters."""
    numbers = (system.size, system.period, system.labels, system.reference_length)
    _feed(found, (*numbers, dict(system.parameters), dict(system.geometry)), inner)
    # By the golden section: functions of the angle are told apart there.
    theta = np.asarray(system.period * (np.arange(16) * GOLDEN % 1.0), dtype=np.float64)
    for term in system.terms:
        _feed(found, (term.array, term.scale, term.power, term.constant), inner)
        _feed_numbers(found, _rounded(term(theta)))
    # How monomials depend on parameters: at two points beside their own.
    for k, factor in enumerate((1.0, 1.25)):
        moved = {
            name: factor * value + 0.125 * k * (i + 1)
            for i, (name, value) in enumerate(sorted(system.parameters.items()))
        }
        for name, value in sorted(system.scales(moved).items()):
            found.update(name.encode())
            _feed_numbers(found, _rounded(np.asarray(value, dtype=float)))


def _rounded(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return values to nine digits of the largest; no negative zeros."""
    size = float(np.max(np.abs(values), initial=0.0))
    if not np.isfinite(size) or size == 0.0:
        return np.asarray(values, dtype=float)
    # A power of two: dividing by it loses nothing.
    unit = 2.0 ** np.ceil(np.log2(size))
    # Digits to which they are compared: of what another machine computes the last may differ.
    return np.asarray(np.round(values / unit, 9) + 0.0)


def _feed_callable(found: _Hash, value: Callable[..., Any], inner: tuple[int, ...]) -> None:
    if isinstance(value, partial):
        _feed(found, (value.func, value.args, dict(value.keywords)), inner)
    elif isinstance(value, MethodType):
        _feed(found, (value.__func__.__qualname__, value.__self__), inner)
    elif isinstance(value, FunctionType):
        found.update(f"{value.__module__}.{value.__qualname__}".encode())
        _feed_function(found, value, inner)
        for name, held in sorted(_reached(value).items()):
            found.update(name.encode())
            if isinstance(held, FunctionType):
                _feed_function(found, held, inner)
            else:
                _feed(found, held, inner)
    elif isinstance(value, (type, BuiltinFunctionType, np.ufunc)):
        name = getattr(value, "__qualname__", "") or value.__name__
        found.update(f"{getattr(value, '__module__', '')}.{name}".encode())
    else:
        _feed_pickled(found, value)


def _feed_function(found: _Hash, function: FunctionType, inner: tuple[int, ...]) -> None:
    """Add what a function does by itself; not its docstring, nor where it stands in its file."""
    for code in _codes(function.__code__):
        found.update(code.co_code)
        constants = (c for c in code.co_consts if not isinstance(c, CodeType))
        told = tuple(c for c in constants if c is None or c != function.__doc__)
        _feed(found, (code.co_names, code.co_varnames, code.co_freevars, told), inner)
    cells = tuple(cell.cell_contents for cell in function.__closure__ or ())
    _feed(found, (cells, function.__defaults__, function.__kwdefaults__), inner)


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Yield the code of a function and of those inside it."""
    yield code
    for held in code.co_consts:
        if isinstance(held, CodeType):
            yield from _codes(held)


def _reached(function: FunctionType) -> dict[str, object]:
    """Return by name the functions and constants of its file that a function uses, near or far."""
    found: dict[str, object] = {}
    left = [function]
    while left:
        codes = _codes(left.pop().__code__)
        for name in {name for code in codes for name in code.co_names} - {*found}:
            held = function.__globals__.get(name)
            if isinstance(held, FunctionType) and held.__module__ == function.__module__:
                left.append(held)
            elif not isinstance(held, _CONSTANTS) and (
                isinstance(held, type) or not is_dataclass(held)
            ):
                continue
            found[name] = held
    return found


def _feed_pickled(found: _Hash, value: object) -> None:
    state = getattr(value, "__dict__", None)
    if state is not None and type(value).__reduce__ is object.__reduce__:
        # A plain object is what its attributes are.
        _feed(found, dict(state), (id(value),))
        return
    try:
        found.update(pickle.dumps(value, protocol=4))
    except (pickle.PicklingError, AttributeError, TypeError) as reason:
        raise _untold(value) from reason


def _untold(value: object) -> Exception:
    found = f"an argument of type {type(value).__name__}, whose content cannot be told"
    expected = "numbers, texts, arrays, systems, scenes and functions of a module"
    return bad("sweep", found, expected, "leave out the store, or give something simpler")
