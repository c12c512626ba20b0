"""An emitted module seen with its functions compiled."""

from __future__ import annotations

import functools
import importlib
import sys
from types import ModuleType
from typing import Any

from ..core.errors import bad
from .functions import compiled_function
from .rewriting import is_emitted
from .store import require_numba


class CompiledModule(ModuleType):
    """An emitted module whose functions are compiled when they are looked at.

    Everything else is the emitted module's own.  Make it with :func:`compiled_module`.
    """

    def __init__(self, emitted: ModuleType) -> None:
        super().__init__(emitted.__name__, emitted.__doc__)
        self.emitted = emitted

    def __getattr__(self, name: str) -> Any:
        """Return what the emitted module has under a name, a function of points compiled."""
        if name.startswith("__") or name == "emitted":
            raise AttributeError(name)
        found = getattr(self.emitted, name)
        if name in self.emitted.RETURNS and is_emitted(found):
            found = compiled_function(found)
        setattr(self, name, found)
        return found

    def __reduce__(self) -> tuple[object, ...]:
        """Make copies and pickled ones by the emitted module's name."""
        return _by_name, (self.emitted.__name__,)


def compiled_module(module: ModuleType) -> ModuleType:
    """Return an emitted module with its functions compiled, each when it is first looked at.

    It serves wherever an emitted module does: ``assemble``, ``Constrained.from_module``,
    ``Transcendental.from_module``, ``array_function``.

    Parameters
    ----------
    module : module
        Emitted.

    Raises
    ------
    BadInput
        If numba is not installed (extra ``fast``), or the module was not emitted or holds nothing
        to compile.
    """
    if isinstance(module, CompiledModule):
        return module
    returns = getattr(module, "RETURNS", None)
    if not (isinstance(module, ModuleType) and isinstance(returns, dict)):
        found = getattr(module, "__name__", repr(module))
        raise bad("module", found, "an emitted module", "pass one that find_module gives")
    if module.FAMILY == "recursion":
        found = f"{module.__name__}, whose functions are an algebra of the caller's"
        raise bad("module", found, "functions of numbers", "use the module as it is")
    require_numba("compiled")
    return _made(module)


@functools.cache
def _made(module: ModuleType) -> CompiledModule:
    """Return the one compiled form that a module has in this process."""
    return CompiledModule(module)


def _by_name(name: str) -> ModuleType:
    return compiled_module(sys.modules.get(name) or importlib.import_module(name))
