"""Finding emitted modules: by the hash of their spec, through the manifests of known folders."""

from __future__ import annotations

import hashlib
import importlib
import json
import os
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import ModuleType

from ... import generated
from ..._files import run_module
from ...derive.spec import MANIFEST, Entry, ModelSpec, cache_folder, read_manifest
from .errors import bad


@dataclass(frozen=True)
class EmittedModule:
    """A loaded module with what its manifest says of it, and where it lies.

    What is ``dropped`` are terms that the wanted model leaves out and the module still has: its
    ``DROPS`` says what has to vanish.
    """

    entry: Entry
    folder: Path
    module: ModuleType
    dropped: tuple[str, ...] = ()

    def __reduce__(self) -> tuple[object, ...]:
        """Make pickled and copied ones load the module, which is no value itself."""
        return _loaded, (self.entry, self.folder, self.dropped)

    @property
    def provenance(self) -> dict[str, str]:
        """Name and content hash, for results."""
        return {"module": self.entry.module, "module_hash": self.module.CONTENT}


def _loaded(entry: Entry, folder: Path, dropped: tuple[str, ...]) -> EmittedModule:
    return EmittedModule(entry, folder, _load(folder, entry), dropped)


def search_path(folders: Sequence[str | Path] = ()) -> Iterator[Path]:
    """Yield the folders that may hold modules, in the order in which they are asked.

    The given ones, ``$ELASTOLINK_GENERATED``, the user's cache folder, the packaged modules.
    """
    yield from (Path(folder) for folder in folders)
    if "ELASTOLINK_GENERATED" in os.environ:
        yield Path(os.environ["ELASTOLINK_GENERATED"])
    yield cache_folder()
    yield Path(generated.__path__[0])


def find_module(spec: ModelSpec, folders: Sequence[str | Path] = ()) -> EmittedModule:
    """Return the emitted module of a spec, the given folders searched first.

    A module for the spec's own number of modes is preferred to one for any number, and one without
    the terms that the spec drops to a general one that can leave them out.  Outside the packaged
    modules, one that today's sources would emit differently counts as missing, so that a cache that
    an older version filled is never used by mistake.

    Parameters
    ----------
    spec : ModelSpec
        Of the wanted model.
    folders : sequence of path
        Folders of emitted modules.

    Returns
    -------
    EmittedModule
        With the ``module`` and its ``provenance``.

    Raises
    ------
    BadInput
        If no manifest lists it (the message has the command that makes it), its model cannot make
        it, or the file is not as it was emitted.

    Examples
    --------
    >>> import elastolink as el
    >>> from elastolink.derive.spec import ModelSpec
    >>> found = el.systems.find_module(ModelSpec("four_bar", "complete", flexible=("coupler",)))
    >>> print(found.entry.module, found.module.FAMILY)
    four_bar_coupler_complete linear_periodic
    """
    candidates = (spec, spec.with_(modes=None)) if spec.modes is not None else (spec,)
    outdated = ""
    manifests = {folder: _entries(folder) for folder in search_path(folders)}
    for dropped in ((), spec.drop) if spec.drop else ((),):
        for folder, known in manifests.items():
            for candidate in candidates:
                wanted = candidate.with_(drop=()) if dropped else candidate
                entry = known.get(wanted.key())
                if entry is None or not (folder / f"{entry.module}.py").is_file():
                    continue
                if _outdated(folder, entry):
                    outdated = f", only an outdated one in {folder}"
                    continue
                _refuse_edited(folder, entry)
                module = _load(folder, entry)
                if not dropped or dropped in getattr(module, "DROPS", {}):
                    return EmittedModule(entry, folder, module, dropped)
    found = f"no emitted module {spec.name()}{outdated}"
    raise bad("model", found, "one listed in a manifest", f"run: {_command(spec, folders)}")


def _entries(folder: Path) -> Mapping[str, Entry]:
    """Return the entries of a manifest, which is parsed anew where its text has changed."""
    try:
        return _parsed(folder, (folder / MANIFEST).read_bytes())
    except OSError:
        return {}


@lru_cache(maxsize=8)
def _parsed(folder: Path, text: bytes) -> Mapping[str, Entry]:
    return read_manifest(folder)


def _outdated(folder: Path, entry: Entry) -> bool:
    """Return True where a packaged model would emit something else now."""
    if folder == Path(generated.__path__[0]):
        return False
    from ...derive.catalogue import find
    from ...derive.manifest import content_hash

    try:
        paths = find(entry.spec).paths()
    except LookupError:  # a user's model, whose file is not known here
        return False
    return entry.content != content_hash(entry.spec, paths)


def _refuse_edited(folder: Path, entry: Entry) -> None:
    path = folder / f"{entry.module}.py"
    if hashlib.sha256(path.read_bytes()).hexdigest() != entry.text:
        found = "a file that was changed by hand"
        fix = "move it away and run regenerate-equations again"
        raise bad(f"module {path}", found, "the text that was emitted", fix)


def _command(spec: ModelSpec, folders: Sequence[str | Path]) -> str:
    """Return the command that makes a module, where :func:`find_module` will see it."""
    from ...derive.catalogue import find
    from ...derive.manifest import checkout

    try:
        wrong = find(spec).choices.unknown(spec)
        if wrong is not None:
            part, found, expected = wrong
            raise bad(f"model.{part}", found, expected, "correct it")
        table = {k: v for k, v in json.loads(spec.canonical()).items() if v not in ([], None)}
        command = f"regenerate-equations --spec {shlex.quote(json.dumps(table, sort_keys=True))}"
    except LookupError:
        command = f"regenerate-equations --model FILE.py, with the file of {spec.mechanism}"
    target = (checkout() or cache_folder()).resolve()
    if target not in {folder.resolve() for folder in search_path(folders)}:
        out = shlex.quote(str(cache_folder()))
        command = command.replace("equations", f"equations --out {out}", 1)
    return command


def _load(folder: Path, entry: Entry) -> ModuleType:
    packaged = Path(generated.__path__[0])
    if folder == packaged:
        return importlib.import_module(f"{generated.__name__}.{entry.module}")
    name = f"elastolink_emitted_{entry.module}_{entry.text[:16]}"  # equal texts load once
    # Not those of sys.modules: another thread's may not be whole yet.
    if name not in _LOADED:
        _LOADED[name] = run_module(name, folder / f"{entry.module}.py")
    return _LOADED[name]


_LOADED: dict[str, ModuleType] = {}
