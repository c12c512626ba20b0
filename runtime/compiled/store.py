"""Loops on disk: written whole or not at all, and compiled once for all processes."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from ..._files import write_whole
from ...derive.spec import cache_folder
from ..core.errors import bad
from .rewriting import Loop

# Number of points, where arguments and outputs lie, and the two.
_SIGNATURE = "void(int64, int64[::1], float64[::1], float64[::1])"
_MADE: list[Any] = []


def require_numba(where: str) -> None:
    """Refuse to compile where numba is not installed, or told not to.

    Parameters
    ----------
    where : str
        What was asked for.

    Raises
    ------
    BadInput
        With the command that installs it.
    """
    try:
        import numba
    except ImportError as missing:
        fix = "install the extra: pip install 'elastolink[fast]'"
        raise bad(where, "numba is not installed", "the extra fast", fix) from missing
    if numba.config.DISABLE_JIT:
        fix = "unset NUMBA_DISABLE_JIT, or do without"
        raise bad(where, "numba, told to compile nothing", "numba that compiles", fix)


def version() -> str:
    """Return numba's version."""
    import numba

    return str(numba.__version__)


def folder() -> Path:
    """Return the user's folder of loops, beside that of emitted modules."""
    return cache_folder().parent / "compiled"


def compile_loop(loop: Loop) -> Any:
    """Return a loop compiled by numba, or loaded as a process before compiled it.

    Where the folder cannot be written it is compiled for this process alone.

    Parameters
    ----------
    loop : Loop
        The loop.

    Returns
    -------
    callable
        ``loop(points, layout, values, out)``.
    """
    import numba

    digest = hashlib.sha256(f"numba {version()}\n{loop.text}".encode()).hexdigest()
    name = f"{loop.module}_{loop.name}_{digest[:16]}"
    path = folder() / f"{name}.py"
    kept = _kept(path, loop.text.encode())
    module = _loaded(f"elastolink_compiled_{name}", path, loop.text, kept=kept)
    options = {"error_model": "numpy", "nogil": True}
    try:
        made = numba.njit(cache=kept, **options)(module.loop)
    except RuntimeError:  # numba finds no folder for what it compiles
        made = numba.njit(**options)(module.loop)
    made.compile(_SIGNATURE)
    made.disable_compile()
    _MADE.append(made)
    return made


def compilations() -> int:
    """Return how many loops this process has compiled itself, not loaded from the folder."""
    return sum(len(made.overloads) - sum(made.stats.cache_hits.values()) for made in _MADE)


def _kept(path: Path, content: bytes) -> bool:
    """Return True where the file is there as it should be, written now if need be.

    A file that is right is left alone: numba takes a newer one for another function.
    """
    try:
        if path.is_file() and path.read_bytes() == content:
            return True
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, content)
    except OSError:
        return False
    return True


def _loaded(name: str, path: Path, text: str, *, kept: bool) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path) if kept else None
    if spec is None or spec.loader is None:
        module = ModuleType(name)
        exec(compile(text, f"<{name}>", "exec"), module.__dict__)
    else:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    sys.modules[name] = module  # where numba looks for a loop that it loads
    return module
