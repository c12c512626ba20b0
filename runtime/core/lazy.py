"""Modules, and public names of a package with their module, that load on first use."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib import import_module
from importlib.util import find_spec
from typing import Any


class ModuleOnUse:
    """Stands for a module of an extra, which loads with the first use of one of its names."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # what inspection asks of any object
            raise AttributeError(name)
        value = vars(self)[name] = getattr(import_module(self._name), name)
        return value


def unknown_name(package: str, name: str, names: Iterable[str]) -> AttributeError:
    """Return the error of a name that a package lacks, with the nearest of those that it has.

    Case and underscores count little; of a dotted name the last part is compared.  The error does
    not hold the package: where it does, Python's tracebacks add a suggestion of their own.
    """
    message = f"module {package!r} has no attribute {name!r}"
    # Python asks for a module of the package here, too, before it imports it.
    if name.isidentifier() and name[0] != "_" and not find_spec(f"{package}.{name}"):
        from difflib import SequenceMatcher

        def likeness(other: str) -> tuple[float, float]:
            last = other.rpartition(".")[2]
            plain, other = (text.replace("_", "").lower() for text in (name, last))
            alike, exactly = SequenceMatcher(None, plain, other), SequenceMatcher(None, name, last)
            return alike.ratio(), exactly.ratio()

        nearest = max(names, key=likeness)
        if likeness(nearest)[0] >= 0.75:
            message += f"; did you mean {nearest!r}?"
    return AttributeError(message, name=name)


_IMPORTED = re.compile(r"^    from (\.[.\w]+) import (\w+) as \2$", re.MULTILINE)


def on_first_use(namespace: dict[str, Any]) -> list[str]:
    """Return ``__all__`` of a package whose names load when they are used.

    The names are those that its file imports for type checkers, ``if TYPE_CHECKING``, each on a
    line of its own, ``from .module import name as name``: what these see is what there is, and a
    misspelt name is refused.  ``namespace`` is ``globals()`` of the package: it is given
    ``__getattr__``, which keeps there what it loads, and ``__dir__``, the public names.
    """
    package, spec = namespace["__name__"], namespace["__spec__"]
    source = spec.loader.get_data(spec.origin).decode()
    modules = {name: module for module, name in _IMPORTED.findall(source)}

    def load(name: str) -> Any:
        if name not in modules:
            raise unknown_name(package, name, modules)
        value = getattr(import_module(modules[name], package), name)
        namespace[name] = value
        return value

    namespace["__getattr__"] = load
    namespace["__dir__"] = lambda: sorted(modules)
    return sorted(modules)
