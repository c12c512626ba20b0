"""Files that appear whole or not at all, and Python files run as they are now.

Standard library only; both sides of the house use it.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType
from typing import BinaryIO


def write_whole(path: Path, content: bytes) -> Path:
    """Write a file beside its final place and move it there in one step, over an older one.

    An OSError, where the folder does not exist or cannot be written, leaves nothing behind.
    """
    with whole_file(path) as stream:
        stream.write(content)
    return path


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Open a file beside its final place; what was written moves there when the block ends well."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            yield stream
        mask = os.umask(0)
        os.umask(mask)
        Path(temporary).chmod(0o666 & ~mask)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


class _Text(SourceFileLoader):
    """Compiles the text; bytecode of another may be as old, to the second, and as long."""

    def get_code(self, fullname: str) -> CodeType:
        return self.source_to_code(self.get_data(self.path), self.path)


def run_module(name: str, path: Path) -> ModuleType:
    """Return a Python file run as the module of a name; no bytecode is read or written.

    Where it raises an exception, no module of that name is kept.
    """
    spec = spec_from_file_location(name, path, loader=_Text(name, str(path)))
    assert spec is not None and spec.loader is not None
    sys.modules[name] = module = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        sys.modules.pop(name, None)
        raise
    return module
