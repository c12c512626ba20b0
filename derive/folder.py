"""Folders of emitted modules: bringing one up to date, and comparing it with what is derived now.

Whatever happens in between, a module on disk is whole, and what the manifest says of it is true.
"""

from __future__ import annotations

import difflib
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from .._files import write_whole
from .jobs import Job, UsageError
from .manifest import is_current, manifest_text, text_hash
from .spec import MANIFEST, Entry, read_manifest

# What every emitted module says of itself: files without it are not replaced.
_MARK = b"Emitted by regenerate-equations"


def update(
    folder: Path, jobs: Sequence[Job], processes: int, *, whole: bool, force: bool = False
) -> None:
    """Derive and write what is not current, and say so.

    ``folder``: made where it does not exist; ``jobs``: what the folder shall hold; ``processes``:
    how many modules are derived at a time; ``whole``: true where the folder shall hold nothing
    else: the rest is removed; ``force``: derive also what is current. Raises ``UsageError`` if the
    folder cannot be written, or a model refuses its spec.
    """
    entries = read_manifest(folder)
    stale = [
        job
        for job in jobs
        if force or not is_current(folder, entries.get(job.spec.key()), job.content)
    ]
    left_over = _left_over(folder, jobs) if whole else []
    if not stale and not left_over:
        print(f"nothing to do: all is current in {folder} ({len(jobs)} modules)")
        return
    foreign = [path for job in stale if _is_foreign(path := folder / f"{job.name}.py")]
    # A manifest may be damaged or in conflict: beside emitted modules it is theirs all the same.
    manifest = folder / MANIFEST
    if manifest.exists() and not entries and not any(map(_is_emitted, folder.glob("*.py"))):
        foreign.append(manifest)
    for path in foreign:
        raise UsageError(f"{path}: found a file that was not emitted; choose another --out")
    _make(folder)
    with _derived(stale, processes) as texts:
        for count, (job, text) in enumerate(zip(stale, texts, strict=True), start=1):
            _write_one(folder, entries, job, text)
            print(f"[{count}/{len(stale)}] {job.name}", flush=True)
    if whole:
        wanted = {job.spec.key() for job in jobs}
        _write_manifest(folder, {key: e for key, e in entries.items() if key in wanted})
    for name in left_over:
        (folder / name).unlink(missing_ok=True)
        print(f"removed {name}")


def check(folder: Path, jobs: Sequence[Job], processes: int, *, whole: bool) -> int:
    """Derive everything anew, compare byte for byte, and print unified diffs.

    ``folder``, ``jobs``, ``processes``: as for :func:`update`; ``whole``: true where the folder
    shall hold nothing else: a stale file differs from no file, and the manifest is compared, too.
    Result: number of files that differ, are missing, or are stale.
    """
    expected: dict[str, str] = {}
    entries: dict[str, Entry] = {}
    with _derived(jobs, processes) as texts:
        for job, text in zip(jobs, texts, strict=True):
            expected[f"{job.name}.py"] = text
            entries[job.spec.key()] = _entry(job, text)
    if whole:
        expected[MANIFEST] = manifest_text(entries)
        expected |= dict.fromkeys(_left_over(folder, jobs), "")
    differing = 0
    for name, text in sorted(expected.items()):
        path = folder / name
        found = path.read_bytes() if path.exists() else b""
        if found != text.encode():
            differing += 1
            sys.stdout.writelines(_diff(name, found, text))
    print(f"{len(expected)} files checked in {folder}, {differing} differ")
    return differing


def _diff(name: str, found: bytes, text: str) -> Iterator[str]:
    old = found.decode(errors="backslashreplace").splitlines(keepends=True)
    new = text.splitlines(keepends=True)
    for line in difflib.unified_diff(old, new, f"{name} (found)", f"{name} (derived)"):
        yield line if line.endswith("\n") else f"{line}\n"


def _left_over(folder: Path, jobs: Sequence[Job]) -> list[str]:
    """Return the emitted modules in a folder that none of the jobs makes; others are let be."""
    wanted = {f"{job.name}.py" for job in jobs} | {"__init__.py"}
    rest = (path for path in folder.glob("*.py") if path.name not in wanted)
    return sorted(path.name for path in rest if _is_emitted(path))


def _is_emitted(path: Path) -> bool:
    return path.is_file() and _MARK in path.read_bytes()


def _is_foreign(path: Path) -> bool:
    """Return whether something lies there that no run of this command wrote."""
    return (
        path.exists() and not _is_emitted(path) and not (path.is_file() and not path.read_bytes())
    )


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise UsageError(f"{folder}: found a file, not a folder; choose another --out") from None
    except OSError as problem:
        raise UsageError(f"{folder}: {problem.strerror}; choose another --out") from None
    if not os.access(folder, os.W_OK):
        raise UsageError(f"{folder}: cannot be written; choose another --out")


def _entry(job: Job, text: str) -> Entry:
    return Entry(job.name, job.spec, job.content, text_hash(text))


def _write_one(folder: Path, entries: dict[str, Entry], job: Job, text: str) -> None:
    """Write a module and its entry, so that an interrupt at any point leaves no false entry.

    The old entry goes first; until the new one is there, the module counts as missing.
    """
    outdated = [key for key, entry in entries.items() if entry.module == job.name]
    for key in outdated:
        del entries[key]
    if outdated:
        _write_manifest(folder, entries)
    write_whole(folder / f"{job.name}.py", text.encode())
    entries[job.spec.key()] = _entry(job, text)
    _write_manifest(folder, entries)


def _write_manifest(folder: Path, entries: dict[str, Entry]) -> None:
    write_whole(folder / MANIFEST, manifest_text(entries).encode())


@contextmanager
def _derived(jobs: Sequence[Job], processes: int) -> Iterator[Iterator[str]]:
    """Yield the texts in the order of the jobs, whatever the number of processes."""
    if processes <= 1 or len(jobs) <= 1:
        yield map(Job.text, jobs)
        return
    pool = ProcessPoolExecutor(min(processes, len(jobs)), initializer=_leave_interrupts_to_parent)
    try:
        yield pool.map(Job.text, jobs)
    finally:
        pool.shutdown(cancel_futures=True)


def _leave_interrupts_to_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
