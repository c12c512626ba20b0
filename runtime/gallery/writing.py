"""Several files that appear together: all of them, or none where something goes wrong."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from ..core.errors import bad


def write_together(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files into a folder; on an error or an interrupt it is left as it was.

    The files are written beside the folder first, then moved.  Other files in the folder stay.

    Parameters
    ----------
    folder : Path
        Made where it does not exist.
    contents : mapping of str to bytes
        By file name.

    Raises
    ------
    BadInput
        If the folder cannot be made or written.
    """
    made = _missing(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        staging = Path(tempfile.mkdtemp(prefix=".gallery.", dir=folder))
    except OSError as refusal:
        _remove(made)
        reason = refusal.strerror or "an error"
        raise bad(
            str(folder), reason, "a folder that can be written", "choose another"
        ) from refusal
    try:
        _stage_and_move(folder, staging, contents)
    except BaseException:
        shutil.rmtree(staging, ignore_errors=True)
        _remove(made)
        raise
    shutil.rmtree(staging)


def _stage_and_move(folder: Path, staging: Path, contents: Mapping[str, bytes]) -> None:
    mask = os.umask(0)
    os.umask(mask)
    new, old = staging / "new", staging / "old"
    new.mkdir()
    old.mkdir()
    for name, content in contents.items():
        (new / name).write_bytes(content)
        (new / name).chmod(0o666 & ~mask)
    moved: list[str] = []
    try:
        for name in contents:
            target = folder / name
            moved.append(name)
            if target.exists():
                target.replace(old / name)
            (new / name).replace(target)
    except BaseException:
        for name in moved:
            if (old / name).exists():
                (old / name).replace(folder / name)
            elif not (new / name).exists():
                (folder / name).unlink(missing_ok=True)
        raise


def _missing(folder: Path) -> list[Path]:
    """Return the folders that would have to be made, the innermost first."""
    found = []
    while not folder.exists():
        found.append(folder)
        folder = folder.parent
    return found


def _remove(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
