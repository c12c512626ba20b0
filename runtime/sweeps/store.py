"""Pieces of a sweep on disk: each written whole, taken up again, and joined at the end."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import prod
from pathlib import Path
from typing import IO, Any

import numpy as np

from ..._files import whole_file
from ..core.errors import BadInput, bad
from ..core.files import write_whole
from .pieces import Grid
from .requests import digest
from .tasks import AnyArray, Piece, blank

_MANIFEST = "manifest.json"
_ABOUT = "about"
_CHECKSUM = "checksum"
# Files that a killed process had begun to write.
_BEGUN = re.compile(r"\.(.+)\.[a-z0-9_]{8}")


class Store:
    """A folder with one array per file, or one ``.npz`` file, and what leads there.

    A path that ends in ``.npz`` becomes such a file at the end, its pieces lying in a folder beside
    it until then; any other one is a folder.  Manifests and pieces bear checksums, and each piece
    its number and request: what was damaged, copied or put there by others is never believed, and
    never removed unless it has a name that the sweep writes itself.
    """

    def __init__(self, path: Path, request: Mapping[str, Any], grid: Grid) -> None:
        self.path, self.request, self.grid = path, dict(request), grid
        self.single = path.suffix == ".npz"
        self.folder = path.with_name(path.name + ".parts") if self.single else path
        self.damaged: list[str] = []
        self._parts = self.folder / "pieces"

    def finished(self) -> Piece | None:
        """Return the sweep where it is complete and undamaged; refuse another one's."""
        about = self._about()
        if about is None:
            return None
        self._require_same(about)
        if not about["complete"]:
            return None
        whole = self._whole(about)
        if self._damage(whole, about):
            return None
        # Killed after the last step it has left its pieces.
        self._clean()
        return Piece.from_about(whole, about)

    def _about(self) -> dict[str, Any] | None:
        """Return the manifest of what lies there; None where nothing does."""
        if self.single and self.path.exists():
            with self._reading(self.path), self.path.open("rb") as stream, np.load(stream) as held:
                return _unsealed(bytes(held[_ABOUT]))
        return self._begun()

    def _begun(self) -> dict[str, Any] | None:
        """Return the manifest of the folder; None where there is none, nor anything else."""
        manifest = self.folder / _MANIFEST
        if not manifest.exists():
            if self._taken():
                fix = "give a new place, or remove what lies there"
                raise bad(str(self.path), "something that is no sweep", "a store or nothing", fix)
            return None
        with self._reading(manifest):
            return _unsealed(manifest.read_bytes())

    def _taken(self) -> bool:
        """Return whether something lies there that no sweep has begun."""
        if not self.folder.exists():
            return False
        if not self.folder.is_dir():
            return True
        # A process killed at its very beginning leaves no more than these.
        left = [entry for entry in self.folder.iterdir() if _begun_of(entry) != _MANIFEST]
        if left == [self._parts] and self._parts.is_dir():
            return any(self._parts.iterdir())
        return bool(left)

    @contextmanager
    def _reading(self, path: Path) -> Iterator[None]:
        try:
            yield
        except Exception as reason:  # a file that others wrote or damaged fails in any way
            fix = "give a new place, or remove what lies there"
            why = str(reason).partition("\n")[0][:80]
            raise bad(str(path), f"no store of a sweep ({why})", "a manifest", fix) from reason

    def _require_same(self, about: Mapping[str, Any]) -> None:
        held = about["request"]
        keys = sorted({*held, *self.request})
        differing = [key for key in keys if held.get(key) != self.request.get(key)]
        if differing:
            found = f"a sweep that differs in {', '.join(differing)}"
            fix = "give another store, or the request that this one was begun with"
            raise bad(str(self.path), found, "the store of this request", fix)

    def _whole(self, about: Mapping[str, Any]) -> dict[str, AnyArray]:
        """Return the arrays of a complete store that can be read, of a folder as maps."""
        found: dict[str, AnyArray] = {}
        for name, told in about["arrays"].items():
            read = self._from_file if self.single else self._from_folder
            # Missing or damaged in any way.
            with suppress(Exception):
                found[name] = read(name, tuple(told["shape"]), told["type"])
        return found

    def _from_file(self, name: str, shape: tuple[int, ...], kind: str) -> AnyArray:
        with np.load(self.path) as held:
            array: AnyArray = held[name]
        if array.shape != shape or array.dtype.str != kind:
            raise ValueError(name)
        return array

    def _from_folder(self, name: str, shape: tuple[int, ...], kind: str) -> AnyArray:
        """Return a map of an array's file, whose header and length are as they were written."""
        path, header = self.folder / f"{name}.npy", _header(shape, kind)
        size = len(header) + prod(shape) * np.dtype(kind).itemsize
        with path.open("rb") as stream:
            if stream.read(len(header)) != header or path.stat().st_size != size:
                raise ValueError(name)
        return np.memmap(path, dtype=kind, mode="r", offset=len(header), shape=shape)

    def _damage(
        self, whole: Mapping[str, AnyArray], about: Mapping[str, Any]
    ) -> dict[str, list[int]]:
        """Return by array the pieces of a complete store that are not as they were written."""
        found = {}
        for name, told in about["arrays"].items():
            wrong = [
                number
                for number, known in enumerate(told["pieces"])
                if name not in whole or _checksum(self._run(whole[name], number)) != known
            ]
            if wrong:
                found[name] = wrong
        return found

    def _run(self, array: AnyArray, number: int) -> AnyArray:
        """Return what a piece holds of a whole array."""
        rest = array.shape[len(self.grid.shape) :]
        return array.reshape(self.grid.points, *rest)[self.grid.run(number)]

    @contextmanager
    def opened(self) -> Iterator[Store]:
        """Begin the store, or take it up again; refuse a second process, where one can be told."""
        manifest = self.folder / _MANIFEST
        if self._begun() is None:
            try:
                self._parts.mkdir(parents=True, exist_ok=True)
            except (OSError, ValueError) as refusal:
                fix = "choose another path"
                found = str(getattr(refusal, "strerror", refusal))
                raise bad(str(self.path), found, "a writable place", fix) from refusal
            self._write_manifest({"request": self.request, "complete": False})
        with manifest.open("rb") as stream:
            _lock(stream, self.path)
            self._parts.mkdir(exist_ok=True)
            about = self._about()
            if about is not None and about["complete"]:
                self._take_apart(about)
            yield self

    def _take_apart(self, about: Mapping[str, Any]) -> None:
        """Make pieces again of what is sound in a damaged store; the others are done anew."""
        whole = self._whole(about)
        damage = self._damage(whole, about)
        for name, numbers in damage.items():
            place = f"{name} in {self.path.name}" if self.single else f"{name}.npy"
            self.damaged.append(f"{place} ({len(numbers)} of {self.grid.pieces} pieces)")
        lost = {number for numbers in damage.values() for number in numbers}
        for number in sorted(set(range(self.grid.pieces)) - lost):
            arrays = {name: np.asarray(self._run(array, number)) for name, array in whole.items()}
            piece, run = Piece.from_about(arrays, about), self.grid.run(number)
            within = range(run.start, run.stop)
            own = {k - run.start: told for k, told in piece.failures.items() if k in within}
            self.write(number, replace(piece, failures=own))
        self._write_manifest({"request": self.request, "complete": False})

    def _write_manifest(self, about: Mapping[str, Any]) -> None:
        write_whole(self.folder / _MANIFEST, _sealed(about))

    def _piece(self, number: int) -> Path:
        return self._parts / f"{number:08d}.npz"

    def write(self, number: int, piece: Piece) -> None:
        """Write one piece, whole or not at all."""
        buffer = io.BytesIO()
        sums = {name: _checksum(array) for name, array in piece.arrays.items()}
        told = {"piece": number, "request": self.request, "arrays": sums, **piece.about()}
        about = np.frombuffer(_sealed(told), dtype=np.uint8)
        np.savez(buffer, **{_ABOUT: about}, **piece.arrays)  # type: ignore[arg-type]
        write_whole(self._piece(number), buffer.getvalue())

    def read(self, number: int, only: str | None = None) -> Piece | None:
        """Return a piece, or one of its arrays; None where there is none that is as written."""
        path = self._piece(number)
        if not path.exists():
            return None
        try:
            # A stream of our own: one that cannot be read is closed all the same.
            with path.open("rb") as stream, np.load(stream) as held:
                about = _unsealed(bytes(held[_ABOUT]))
                names = [name for name in sorted(about["arrays"]) if only in (None, name)]
                arrays = {name: held[name] for name in names}
            if (about["piece"], about["request"]) != (number, self.request):
                raise ValueError("another piece")
            if any(_checksum(array) != about["arrays"][name] for name, array in arrays.items()):
                raise ValueError("another array")
        except Exception:  # a damaged archive fails in any way
            self.damaged.append(f"pieces/{path.name}")
            return None
        return Piece.from_about(arrays, about)

    def join(self, shapes: Mapping[str, tuple[tuple[int, ...], str]], found: Piece) -> Piece:
        """Join the pieces, one by one through memory, and remove them."""
        about = {"request": self.request, "complete": True, "arrays": {}, **found.about()}
        if self.single:
            self._join_file(shapes, about)
        else:
            for name in sorted(shapes):
                with whole_file(self.folder / f"{name}.npy") as stream:
                    about["arrays"][name] = self._copy(stream, name, *shapes[name])
            self._write_manifest(about)
        self._clean()
        return replace(found, arrays=self._whole(about))

    def _join_file(
        self, shapes: Mapping[str, tuple[tuple[int, ...], str]], about: dict[str, Any]
    ) -> None:
        with whole_file(self.path) as stream, zipfile.ZipFile(stream, "w") as archive:
            # An entry made from its name has a fixed date: the same sweep, the same bytes.
            for name, axis in zip(self.grid.names, self.grid.axes, strict=True):
                with archive.open(zipfile.ZipInfo(f"axis_{name}.npy"), "w") as entry:
                    np.lib.format.write_array(entry, axis)
            for name in sorted(shapes):
                place = zipfile.ZipInfo(f"{name}.npy")
                with archive.open(place, "w", force_zip64=True) as entry:
                    about["arrays"][name] = self._copy(entry, name, *shapes[name])
            with archive.open(zipfile.ZipInfo(f"{_ABOUT}.npy"), "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, np.frombuffer(_sealed(about), dtype=np.uint8))

    def _copy(
        self, stream: IO[bytes], name: str, rest: tuple[int, ...], kind: str
    ) -> dict[str, Any]:
        """Write one array in NumPy's format, the pieces being runs of it; return what it is."""
        shape = (*self.grid.shape, *rest)
        stream.write(_header(shape, kind))
        sums = []
        for number in range(self.grid.pieces):
            piece = self.read(number, name)
            if piece is None:
                fix = "start the sweep again"
                raise bad(str(self._piece(number)), "no piece", "the one that was written", fix)
            run = self.grid.run(number)
            whole = blank((run.stop - run.start, *rest), np.dtype(kind))
            array = np.asarray(piece.arrays.get(name, whole), dtype=kind, order="C")
            stream.write(array.tobytes())
            sums.append(_checksum(array))
        return {"shape": list(shape), "type": kind, "pieces": sums}

    def _clean(self) -> None:
        """Remove the pieces, and what a killed run had begun to write, and nothing else."""
        if self.single:
            _remove(self.path.parent, (), (self.path.name,))
            try:
                begun = self._begun()
            except BadInput:
                begun = None
            if begun is None or begun["request"] != self.request:
                return
        pieces = [self._piece(number).name for number in range(self.grid.pieces)]
        _remove(self._parts, pieces, pieces)
        if self.single:
            _remove(self.folder, (_MANIFEST,), (_MANIFEST,))
        else:
            arrays = [path.name for path in self.folder.glob("*.npy")]
            _remove(self.folder, (), (_MANIFEST, *arrays))


def _sealed(about: Mapping[str, Any]) -> bytes:
    """Return JSON that bears its own checksum."""
    told = {**about, _CHECKSUM: digest(json.dumps(about, sort_keys=True))}
    return (json.dumps(told, indent=1, sort_keys=True) + "\n").encode()


def _unsealed(text: bytes) -> dict[str, Any]:
    """Undo :func:`_sealed`; refuse what it did not write."""
    held = json.loads(text)
    known = held.pop(_CHECKSUM, None) if isinstance(held, dict) else None
    if known is None or known != digest(json.dumps(held, sort_keys=True)):
        raise ValueError("its checksum is not that of its content")
    return dict(held)


def _checksum(array: AnyArray) -> str:
    # Of the plain array: a map of a file has another type.
    return digest(np.asarray(array))


def _header(shape: tuple[int, ...], kind: str) -> bytes:
    """Return how a ``.npy`` file of an array begins."""
    stream = io.BytesIO()
    told = {"descr": kind, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, told)
    return stream.getvalue()


def _begun_of(path: Path) -> str | None:
    """Return for which file a process had begun to write this one; None for any other."""
    found = _BEGUN.fullmatch(path.name)
    return found.group(1) if found else None


def _remove(folder: Path, names: Collection[str], begun: Collection[str]) -> None:
    """Remove files by name, files begun for such, and the folder if named ones left it empty."""
    if not folder.is_dir():
        return
    own = set(names), set(begun)
    for path in folder.iterdir():
        if path.name in own[0] or _begun_of(path) in own[1]:
            path.unlink(missing_ok=True)
    if names:
        with suppress(OSError):  # it holds what others put there
            folder.rmdir()


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
