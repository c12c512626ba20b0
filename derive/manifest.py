"""Which emitted modules are current: content hashes, the manifest, and where modules live.

Standard library only, so that finding nothing to do costs no SymPy import.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path

from .ir import IR_VERSION
from .spec import Entry, ModelSpec

_HERE = Path(__file__).parent
_NAMED = b'name = "elastolink"'
# What can change an emitted byte: all here and in the folders of every model, but the bookkeeping.
_FOLDERS = ("projection", "rigid")
_BOOKKEEPING = {
    "__init__.py",
    "catalogue.py",
    "folder.py",
    "jobs.py",
    "latex.py",
    "manifest.py",
    "regenerate.py",
}


@lru_cache(maxsize=1)
def _shared_sources() -> str:
    digest = hashlib.sha256(f"ir {IR_VERSION}".encode())
    folders = (_HERE, *(_HERE / name for name in _FOLDERS))
    found = [path for folder in folders for path in folder.glob("*.py")]
    own = [path for path in sorted(found) if path.name not in _BOOKKEEPING]
    templates = sorted((_HERE.parent / "templates").glob("*.j2"))
    for path in own + templates:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def content_hash(spec: ModelSpec, sources: Iterable[Path]) -> str:
    """Return the hash of all that an emitted module depends on.

    ``spec``: the model; ``sources``: files that derive this model, beside those that serve every
    model.
    """
    digest = hashlib.sha256(_shared_sources().encode())
    digest.update(spec.canonical().encode())
    for path in sorted(sources, key=lambda p: p.name):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:32]


def text_hash(text: str) -> str:
    """Return the hash by which an edited file is told."""
    return hashlib.sha256(text.encode()).hexdigest()


def manifest_text(entries: Mapping[str, Entry]) -> str:
    """Return the manifest as text, in one order whatever the order of the entries."""
    rows = {key: asdict(entry) for key, entry in sorted(entries.items())}
    return json.dumps({"ir": IR_VERSION, "modules": rows}, indent=1, sort_keys=True) + "\n"


def is_current(folder: Path, entry: Entry | None, content: str) -> bool:
    """Return True where the module on disk is the one that its sources would give now."""
    if entry is None or entry.content != content:
        return False
    path = folder / f"{entry.module}.py"
    return path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == entry.text


def checkout() -> Path | None:
    """Return the ``generated`` folder of the checkout that holds the working folder, if any."""
    here = Path.cwd()
    for folder in (here, *here.parents):
        project = folder / "pyproject.toml"
        generated = folder / "generated"
        if project.is_file() and generated.is_dir() and _NAMED in project.read_bytes():
            return generated
    return None
