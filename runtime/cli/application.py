"""Entry of the ``elastolink`` command: the parser, and what becomes of errors and interrupts.

Exit status: 0 where all is well, 1 where a self-check failed, 2 on bad input, 130 when
interrupted.  Bad input gives one line per problem, never a traceback; an unexpected exception is
a bug of this toolkit and keeps its traceback.
"""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from ... import __version__
from ..core.errors import BadInput, ElastolinkError, ElastolinkWarning, bad, one_line
from ..core.progress import time_taken
from ..core.threads import environment, use_one_thread
from .options import HelpFormatter, add, kept_file, picture

# Files of subcommands, in the order of the help.
_GROUPS = (
    *("scenes", "linkages", "clearance", "forces", "response"),
    *("beams", "stability", "boundaries", "studies", "design", "pages"),
)
_BAD_INPUT = 2
# Characters of a complaint; the longest list of choices has half as many.
_LONGEST = 1200


class _Parser(argparse.ArgumentParser):
    """A parser whose complaints are one line, like every other complaint of the command."""

    def error(self, message: str) -> NoReturn:
        """Write the complaint and leave with status 2."""
        told = one_line(message, _LONGEST)
        told += "" if told.endswith("?") else ";"
        self.exit(_BAD_INPUT, f"{self.prog}: {told} `{self.prog} --help` explains\n")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Name the nearest of the choices in place of all, where one is near."""
        known = list(action.choices or ())
        if known and value not in known and (hint := _nearest(str(value), known)):
            raise argparse.ArgumentError(action, f"invalid choice: {value!r}; {hint}")
        super()._check_value(action, value)

    def parse_known_args(  # type: ignore[no-untyped-def]
        self, args=None, namespace=None
    ):
        """Refuse ``--option=--``, of which argparse makes an empty list, and unknown arguments.

        A subcommand's are refused here, not by the whole command: it knows the nearest option.
        """
        for text in sys.argv[1:] if args is None else args:
            if text.startswith("--") and text.endswith("=--"):
                self.error(f"argument {text[:-3]}: expected one argument")
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            options = [text.partition("=")[0] for text in unknown if text.startswith("--")]
            hints = (_nearest(one, self._option_string_actions, most=1) for one in options)
            told = f"unrecognized arguments: {' '.join(unknown)}"
            self.error("; ".join([told, *filter(None, hints)]))
        return found, unknown


def _nearest(word: str, known: Iterable[str], most: int = 3) -> str:
    """Return ``did you mean ...?``, empty where nothing is near."""
    from ..scenes.validation import nearest

    return nearest(word, known, "", most)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command; nothing but the standard library is imported."""
    parser = _Parser(
        prog="elastolink",
        description="Dynamics of elastic linkages: motion, vibration and stability, each checked.",
        epilog=(
            "example: elastolink chart smith_1972_5152_sixteenth_inch --plot chart.png\n"
            "Each command explains itself and gives an example: elastolink chart --help"
        ),
        formatter_class=HelpFormatter,
    )
    told = {"--version": "print the version and leave"}
    add(parser, told, action="version", version=f"elastolink {__version__}")
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", required=True, parser_class=_Parser
    )
    for group in _GROUPS:
        import_module(f".{group}", __package__).add(commands)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line, ``sys.argv`` by default, and return the exit status."""
    options = build_parser().parse_args(arguments)
    prefix = f"elastolink {options.command}"
    use_one_thread()
    folder = getattr(options, "modules", None)
    try:
        with _module_folder(folder), _short_warnings(prefix), time_taken():
            for refused in (picture, kept_file):  # before the work starts
                refused(options)
            status: int = options.run(options)
            sys.stdout.flush()
            return status
    except BadInput as error:
        for line in error.lines():
            _complain(prefix, line)
    except BrokenPipeError:
        # The reader of our output has left; a second attempt at exit would complain again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (ElastolinkError, OSError) as error:
        _complain(prefix, str(error))
    except MemoryError:
        _complain(prefix, "out of memory; ask for fewer points, modes or steps")
    except KeyboardInterrupt:
        _complain(prefix, "interrupted; no file is left half written")
        return 130  # as a shell says of an interrupt
    return _BAD_INPUT


def _complain(prefix: str, message: str) -> None:
    print(f"{prefix}: {one_line(message, _LONGEST)}", file=sys.stderr)


def _module_folder(folder: str | None) -> AbstractContextManager[None]:
    """Let emitted modules be sought in a folder first, for the time of one command."""
    if folder is None:
        return nullcontext()
    if not (Path(folder) / "manifest.json").is_file():
        fix = "regenerate-equations writes one"
        raise bad("--modules", repr(folder), "a folder with a manifest.json", fix)
    return environment({"ELASTOLINK_GENERATED": folder})


@contextmanager
def _short_warnings(prefix: str) -> Iterator[None]:
    """Show the toolkit's warnings as one line each, without the place in the source."""

    def show(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
        _complain(prefix, f"warning: {message}")

    with warnings.catch_warnings():
        warnings.simplefilter("always", ElastolinkWarning)
        warnings.showwarning = show
        yield
