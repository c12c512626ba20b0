"""Files: written whole or not at all; values as records of plain JSON, and back.

A record is a tree of numbers, texts, lists and tagged objects.  Reading one makes dataclasses of
elastolink, field by field: nothing that a file names is called.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..._files import write_whole as _write_whole
from .errors import bad

# From name and array to the object that stands for it in a record, and back.
Keep = Callable[[str, NDArray[Any]], dict[str, Any]]
Find = Callable[[Mapping[str, Any]], NDArray[Any]]

# Metadata of a dataclass field that stays out of files: functions, or what is made of them.
NOT_SAVED = {"saved": False}


class NotSaved:
    """Stands for what no file holds, functions above all; its use is refused."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __repr__(self) -> str:
        return f"NotSaved({self._name!r})"

    def _refuse(self) -> NoReturn:
        expected = "a result that was computed here: a file holds no functions"
        raise bad(self._name, "a result that was loaded", expected, "compute it anew")

    def __call__(self, *given: object, **more: object) -> NoReturn:
        """Refuse to be called."""
        self._refuse()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        self._refuse()


def write_whole(path: Path, content: bytes) -> Path:
    """Write a file whole or not at all; refuse a place that cannot be written."""
    try:
        return _write_whole(path, content)
    except OSError as refusal:
        found, fix = refusal.strerror or "an error", "choose another path"
        raise bad(str(path), found, "a writable place", fix) from refusal


def pack(value: object, keep: Keep, path: str = "") -> Any:
    """Return the record of a value; ``keep`` is asked for each array."""
    if value is None or type(value) in (bool, int, str):
        return value
    if type(value) is float:
        return value if np.isfinite(value) else {"kind": "float", "of": repr(value)}
    if type(value) is complex:
        return {"kind": "complex", "of": [pack(part, keep) for part in (value.real, value.imag)]}
    if isinstance(value, np.ndarray | np.generic) and _plain_type(value.dtype):
        if isinstance(value, np.ndarray):
            return keep(path, value)
        return {**inline(path, np.asarray(value)), "kind": "scalar"}
    if isinstance(value, Mapping):
        pairs = [[pack(k, keep), pack(v, keep, f"{path}.{k}")] for k, v in value.items()]
        return {"kind": "mapping", "of": pairs}
    if isinstance(value, list | tuple):
        parts = [pack(part, keep, f"{path}.{i}") for i, part in enumerate(value)]
        return {"kind": "list" if isinstance(value, list) else "tuple", "of": parts}
    if isinstance(value, Path):
        return {"kind": "path", "of": str(value)}
    own = not path or type(value).__module__.startswith("elastolink.")
    if own and is_dataclass(value) and not isinstance(value, type):
        of = {}
        for item in fields(value):
            place = f"{path}.{item.name}" if path else item.name
            of[item.name] = (
                pack(getattr(value, item.name), keep, place)
                if item.metadata.get("saved", True)
                else {"kind": "not saved", "of": place}
            )
        return {"kind": "record", "class": class_name(type(value)), "of": of}
    return {"kind": "not saved", "of": path}


def unpack(tree: Any, find: Find, known: Mapping[str, type]) -> Any:
    """Return the value of a record; ``known``: classes that need not be elastolink's, by name.

    Raises ``ValueError``, ``KeyError`` or ``TypeError`` if it is not such a record, or a class is
    not there or has other fields.
    """
    if not isinstance(tree, dict):
        return tree
    kind: str = tree["kind"]
    of: Any = tree.get("of")
    if kind == "record":
        made_of = _class_of(tree["class"], known)
        own = [item.name for item in fields(made_of)]
        if sorted(own) != sorted(of):
            raise ValueError(f"fields {sorted({*own} ^ {*of})} of {made_of.__name__}")
        value: Any = object.__new__(made_of)
        for name in own:
            object.__setattr__(value, name, unpack(of[name], find, known))
        return value
    if kind == "mapping":
        return {unpack(k, find, known): unpack(v, find, known) for k, v in of}
    if kind in ("list", "tuple"):
        parts = (unpack(part, find, known) for part in of)
        return list(parts) if kind == "list" else tuple(parts)
    if kind in ("array", "scalar"):
        array = (inlined if "of" in tree else find)(tree)
        if array.dtype.str != tree["type"] or list(array.shape) != tree["shape"]:
            raise ValueError(f"an array of {array.dtype} and shape {array.shape}")
        array.flags.writeable = False
        return array if kind == "array" else array[()]
    if kind == "complex":
        return complex(*(unpack(part, find, known) for part in of))
    return {"float": float, "path": Path, "not saved": NotSaved}[kind](of)


def inline(path: str, array: NDArray[Any]) -> dict[str, Any]:
    """Return an array as JSON that holds all its numbers, to the last bit."""
    flat = array.ravel()
    if array.dtype.kind in "cf":
        flat = flat.view(f"f{array.dtype.alignment}")
        of = [value if np.isfinite(value) else repr(value) for value in flat.tolist()]
    else:
        of = flat.tolist()
    return {**told(array), "of": of}


def inlined(tree: Mapping[str, Any]) -> NDArray[Any]:
    """Return the array of :func:`inline`."""
    kind = np.dtype(tree["type"])
    if not _plain_type(kind):
        raise ValueError(f"an array of {kind}")
    if kind.kind in "cf":
        flat = np.array([float(value) for value in tree["of"]], f"f{kind.alignment}")
    else:
        flat = np.array(tree["of"], kind)
    array: NDArray[Any] = flat.view(kind).reshape(tree["shape"])
    return array


def told(array: NDArray[Any]) -> dict[str, Any]:
    """Return what a record says of each array."""
    return {"kind": "array", "type": array.dtype.str, "shape": list(array.shape)}


def class_name(kind: type) -> str:
    """Return the name of a class in records."""
    return f"{kind.__module__}:{kind.__qualname__}"


def _plain_type(kind: np.dtype[Any]) -> bool:
    return kind.kind in "biufcU" and kind.alignment <= 8


def _class_of(name: str, known: Mapping[str, type]) -> type:
    """Return a dataclass by name: of ``known``, or one that a module of elastolink defines."""
    module, _, kind = name.partition(":")
    if name not in known and re.fullmatch(r"elastolink\.runtime(\.[a-z]\w*)+", module):
        import_module(module)
        found = getattr(sys.modules[module], kind, None)
        if isinstance(found, type) and is_dataclass(found) and class_name(found) == name:
            return found
    if name not in known:
        raise ValueError(f"class {name}")
    return known[name]
