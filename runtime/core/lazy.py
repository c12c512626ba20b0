"""Public names of a package that load with their module on first use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def on_first_use(
    namespace: dict[str, Any], public: Mapping[str, tuple[str, ...]]
) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__all__``, ``__getattr__`` and ``__dir__`` of a package whose names load when used.

    ``namespace`` is ``globals()`` of the package, where a name that was loaded is kept; ``public``
    takes each module, as it is imported from the package, to its public names.
    """
    package = namespace["__name__"]
    modules = {name: module for module, names in public.items() for name in names}

    def load(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(f".{modules[name]}", package), name)
        namespace[name] = value
        return value

    def names() -> list[str]:
        return sorted({*namespace, *modules})

    return sorted(modules), load, names
