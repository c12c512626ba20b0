"""The ``regenerate-equations`` command: derive and emit what is not current, and nothing else.

Imports the standard library alone until there is something to derive.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from .._files import write_whole
from .folder import check, update
from .jobs import Job, UsageError, jobs_of
from .manifest import checkout, is_current
from .spec import cache_folder, read_manifest

_PROGRAM = "regenerate-equations"
_DIFFERS, _MISUSE, _INTERRUPTED = 1, 2, 130
# SymPy reads it when it is imported; its default of 1000 results costs a tenth of the time.
os.environ.setdefault("SYMPY_CACHE_SIZE", "20000")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; status 1 where ``--check`` finds a difference, 2 on misuse, else 0."""
    options = _parser().parse_args(arguments)
    try:
        return _run(options)
    except UsageError as problem:
        print(f"{_PROGRAM}: {problem}", file=sys.stderr)
        return _MISUSE
    except OSError as problem:
        where = f"{problem.filename}: " if problem.filename else ""
        print(f"{_PROGRAM}: {where}{problem.strerror or problem}", file=sys.stderr)
        return _MISUSE
    except KeyboardInterrupt:
        print(f"{_PROGRAM}: interrupted; finished files are whole", file=sys.stderr)
        return _INTERRUPTED


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Say what is wrong in one line."""
        self.exit(_MISUSE, f"{self.prog}: {message}; see --help\n")


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise ValueError(text)
    return value


_count.__name__ = "number of processes"  # argparse names the type in its message


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog=_PROGRAM,
        description="Derive the equations of motion and emit them as NumPy modules.",
        epilog="Modules go to generated/ inside a checkout, else to the user's cache folder.",
    )
    add = parser.add_argument
    add("models", nargs="*", metavar="MODEL", help="names as --list prints them; all by default")
    add("--scene", action="append", default=[], metavar="FILE", help="what this scene needs")
    add("--spec", action="append", default=[], metavar="JSON", help="a [model] table as JSON")
    add("--model", metavar="FILE.py", help="your own model file, defining MODEL and SPECS")
    add("--out", type=Path, metavar="DIR", help="write there")
    add("--check", action="store_true", help="write nothing; show what is not as derived now")
    add("--jobs", type=_count, default=os.cpu_count() or 1, metavar="N", help="processes")
    add("--list", action="store_true", help="list the modules and whether each is current")
    add("--latex", type=Path, metavar="FILE", help="write the equations of motion as LaTeX")
    add("--force", action="store_true", help="derive even what is current")
    return parser


def _run(options: argparse.Namespace) -> int:
    jobs = jobs_of(options.models, options.scene, options.spec, options.model)
    if options.latex:
        return _latex(options.latex, jobs)
    home = checkout()
    folder = options.out or home or cache_folder()
    everything = not (options.models or options.scene or options.spec or options.model)
    # Only a checkout's own folder holds nothing but what the catalogue lists.
    whole = everything and home is not None and folder.resolve() == home.resolve()
    if options.list:
        return _list(folder, jobs)
    if options.check:
        return _DIFFERS if check(folder, jobs, options.jobs, whole=whole) else 0
    update(folder, jobs, options.jobs, whole=whole, force=options.force)
    return 0


def _list(folder: Path, jobs: Sequence[Job]) -> int:
    known = read_manifest(folder)
    for job in jobs:
        entry = known.get(job.spec.key())
        if entry is None:
            state = "missing"
        else:
            state = "current" if is_current(folder, entry, job.content) else "stale"
        print(f"{state:8} {job.name}")
    return 0


def _latex(file: Path, jobs: Sequence[Job]) -> int:
    from .latex import latex_document

    write_whole(file, latex_document([(job.spec, job.model()) for job in jobs]).encode())
    print(f"wrote {file}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
