"""Pieces of a sweep on disk: each written whole, taken up again, and joined at the end."""

from __future__ import annotations

import io
import json
import re
import shutil
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from ..._files import whole_file
from ..core.errors import bad
from ..core.results import write_whole
from .pieces import Grid
from .tasks import AnyArray, Piece

_MANIFEST = "manifest.json"
_ABOUT = "about"
# Files that a killed process had begun to write.
_BEGUN = re.compile(r"\.(.+)\.[a-z0-9_]{8}")


class Store:
    """A folder with one array per file, or one ``.npz`` file, and what leads there.

    A path that ends in ``.npz`` becomes such a file at the end, its pieces lying in a folder beside
    it until then; any other one is a folder.
    """

    def __init__(self, path: Path, request: Mapping[str, Any], grid: Grid) -> None:
        self.path, self.request, self.grid = path, dict(request), grid
        self.single = path.suffix == ".npz"
        self.folder = path.with_name(path.name + ".parts") if self.single else path
        self._parts = self.folder / "pieces"

    def finished(self) -> Piece | None:
        """Return the sweep where it is complete; refuse another one's."""
        about = self._about()
        if about is None:
            return None
        self._require_same(about)
        if not about.get("complete"):
            return None
        # Killed after the last step it has left its pieces.
        self._clean()
        return Piece.from_about(self._whole(about), about)

    def _about(self) -> dict[str, Any] | None:
        """Return the manifest of what lies there; None where nothing does."""
        if self.single and self.path.exists():
            with self._reading(self.path), self.path.open("rb") as stream, np.load(stream) as held:
                found: dict[str, Any] = json.loads(bytes(held[_ABOUT]))
                return found
        manifest = self.folder / _MANIFEST
        if not manifest.exists():
            if self._taken():
                fix = "give a new place, or remove what lies there"
                raise bad(str(self.path), "something that is no sweep", "a store or nothing", fix)
            return None
        with self._reading(manifest):
            loaded: dict[str, Any] = json.loads(manifest.read_text())
            return loaded

    def _taken(self) -> bool:
        """Return whether something lies there that no sweep has begun."""
        if not self.folder.exists():
            return False
        if not self.folder.is_dir():
            return True
        own = {self._parts.name}
        return any(
            entry.name not in own and not _BEGUN.fullmatch(entry.name)
            for entry in self.folder.iterdir()
        )

    @contextmanager
    def _reading(self, path: Path) -> Iterator[None]:
        try:
            yield
        except (OSError, KeyError, ValueError, zipfile.BadZipFile) as reason:
            fix = "give a new place, or remove what lies there"
            raise bad(str(path), f"no store of a sweep ({reason})", "a manifest", fix) from reason

    def _require_same(self, about: Mapping[str, Any]) -> None:
        held = about.get("request", {})
        keys = sorted({*held, *self.request})
        differing = [key for key in keys if held.get(key) != self.request.get(key)]
        if differing:
            found = f"a sweep that differs in {', '.join(differing)}"
            fix = "give another store, or the request that this one was begun with"
            raise bad(str(self.path), found, "the store of this request", fix)

    def _whole(self, about: Mapping[str, Any]) -> dict[str, AnyArray]:
        """Return the arrays of a complete store, of a folder as maps of its files."""
        if self.single:
            with self._reading(self.path), np.load(self.path) as held:
                return {name: held[name] for name in about["outputs"]}
        with self._reading(self.path):
            return {
                name: np.load(self.folder / f"{name}.npy", mmap_mode="r")
                for name in about["outputs"]
            }

    @contextmanager
    def opened(self) -> Iterator[Store]:
        """Begin the store, or take it up again; refuse a second process, where one can be told."""
        manifest = self.folder / _MANIFEST
        try:
            self._parts.mkdir(parents=True, exist_ok=True)
        except OSError as refusal:
            fix = "choose another path"
            raise bad(str(self.path), str(refusal.strerror), "a writable place", fix) from refusal
        if not manifest.exists():
            self._write_manifest({"request": self.request, "complete": False})
        with manifest.open("rb") as stream:
            _lock(stream, self.path)
            yield self

    def _write_manifest(self, about: Mapping[str, Any]) -> None:
        text = json.dumps(about, indent=1, sort_keys=True) + "\n"
        write_whole(self.folder / _MANIFEST, text.encode())

    def _piece(self, number: int) -> Path:
        return self._parts / f"{number:08d}.npz"

    def write(self, number: int, piece: Piece) -> None:
        """Write one piece, whole or not at all."""
        buffer = io.BytesIO()
        about = np.frombuffer(json.dumps(piece.about(), sort_keys=True).encode(), dtype=np.uint8)
        np.savez(buffer, **{_ABOUT: about}, **piece.arrays)  # type: ignore[arg-type]
        write_whole(self._piece(number), buffer.getvalue())

    def read(self, number: int) -> Piece | None:
        """Return a piece; None where there is none, or none that can be read."""
        path = self._piece(number)
        if not path.exists():
            return None
        try:
            # A stream of our own: one that cannot be read is closed all the same.
            with path.open("rb") as stream, np.load(stream) as held:
                about = json.loads(bytes(held[_ABOUT]))
                arrays = {name: held[name] for name in held.files if name != _ABOUT}
        except (OSError, KeyError, ValueError, zipfile.BadZipFile):
            return None
        run = self.grid.run(number)
        if any(len(array) != run.stop - run.start for array in arrays.values()):
            return None
        return Piece.from_about(arrays, about)

    def join(self, shapes: Mapping[str, tuple[tuple[int, ...], str]], found: Piece) -> Piece:
        """Join the pieces, one by one through memory, and remove them."""
        about = {
            "request": self.request,
            "complete": True,
            "outputs": sorted(shapes),
            **found.about(),
        }
        if self.single:
            self._join_file(shapes, about)
        else:
            for name in sorted(shapes):
                with whole_file(self.folder / f"{name}.npy") as stream:
                    self._copy(stream, name, *shapes[name])
            self._write_manifest(about)
        self._clean()
        return replace(found, arrays=self._whole(about))

    def _join_file(
        self, shapes: Mapping[str, tuple[tuple[int, ...], str]], about: Mapping[str, Any]
    ) -> None:
        text = json.dumps(about, sort_keys=True).encode()
        with whole_file(self.path) as stream, zipfile.ZipFile(stream, "w") as archive:
            # An entry made from its name has a fixed date: the same sweep, the same bytes.
            with archive.open(zipfile.ZipInfo(f"{_ABOUT}.npy"), "w") as entry:
                np.lib.format.write_array(entry, np.frombuffer(text, dtype=np.uint8))
            for name, axis in zip(self.grid.names, self.grid.axes, strict=True):
                with archive.open(zipfile.ZipInfo(f"axis_{name}.npy"), "w") as entry:
                    np.lib.format.write_array(entry, axis)
            for name in sorted(shapes):
                place = zipfile.ZipInfo(f"{name}.npy")
                with archive.open(place, "w", force_zip64=True) as entry:
                    self._copy(entry, name, *shapes[name])

    def _copy(self, stream: IO[bytes], name: str, rest: tuple[int, ...], kind: str) -> None:
        """Write one array in NumPy's format, the pieces being runs of it."""
        header = {"descr": kind, "fortran_order": False, "shape": (*self.grid.shape, *rest)}
        np.lib.format.write_array_header_1_0(stream, header)
        for number in range(self.grid.pieces):
            piece = self.read(number)
            if piece is None or name not in piece.arrays:
                fix = "start the sweep again"
                raise bad(str(self._piece(number)), "no piece", "the one that was written", fix)
            stream.write(np.ascontiguousarray(piece.arrays[name]).tobytes())

    def _clean(self) -> None:
        """Remove the pieces, and what a killed run had begun to write."""
        shutil.rmtree(self.folder if self.single else self._parts, ignore_errors=True)
        where = self.path.parent if self.single else self.folder
        for path in where.iterdir():
            begun = _BEGUN.fullmatch(path.name)
            if begun and (not self.single or begun.group(1) == self.path.name):
                path.unlink(missing_ok=True)


def _lock(stream: IO[bytes], path: Path) -> None:
    """Hold a store while the process lives, where the system can."""
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        fix = "wait for it, or give another store"
        raise bad(str(path), "another process at work on it", "one at a time", fix) from None
    except OSError:
        # A file system without locks.
        return
