"""Options that the subcommands share, and the way each one finishes: text, JSON and a picture."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from inspect import cleandoc
from typing import TYPE_CHECKING, Any

from .. import scenes
from ..core.errors import bad, printable

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ..core.families import Array
    from ..core.results import Check, Result

# Revolutions per minute of one radian per second.
RPM = 30.0 / math.pi
# Rows of a table of maxima at the most.
MOST_ROWS = 25
_COUNT = re.compile(r"\s*(\d+)\s*(.*)")


class HelpFormatter(argparse.RawDescriptionHelpFormatter):
    """Keep line breaks, and leave room for the longest command's name."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=28, width=96)


def command(
    commands: Any,
    name: str,
    run: Callable[[argparse.Namespace], int],
    *,
    scene: bool = True,
    draws: bool = True,
    saves: bool = True,
) -> argparse.ArgumentParser:
    """Add a subcommand that ``run`` does, on a scene, with a picture and a result to keep.

    The docstring of ``run`` is its help: a line, and below it worked examples.
    """
    summary, _, examples = cleandoc(run.__doc__ or "").partition("\n\n")
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=summary,
        description=summary,
        epilog="example:\n  " + examples.replace("\n", "\n  "),
        formatter_class=HelpFormatter,
    )
    parser.set_defaults(run=run, command=name, plot=None, save=None)
    switches(parser, {"--json": "print JSON instead of text"})
    if draws:
        add(parser, {"--plot FILE": "draw it: a .png, .svg or .pdf file"})
    if saves:
        kept = "keep all numbers: a .csv table, or .npz, .json, .nc, which el.load gives back"
        add(parser, {"--save FILE": kept})
    if scene:
        scene_options(parser)
    return parser


def add(parser: argparse.ArgumentParser, told: Mapping[str, str], **common: Any) -> None:
    """Add options of one kind, by what the help shows: ``{"--mass MASS": "of one of them"}``."""
    for words, meaning in told.items():
        name, *shown = words.split()
        kind = {**common, "metavar": shown[0]} if shown else common
        parser.add_argument(name, help=meaning, **kind)


def switches(parser: argparse.ArgumentParser, told: Mapping[str, str]) -> None:
    """Add options without a value."""
    add(parser, told, action="store_true")


def angles(default: str) -> dict[str, str]:
    """Return the option of crank angles; ``default`` says which hold without it."""
    return {"--angles START:STOP:COUNT[UNIT]": f"crank angles; default {default}"}


def scene_options(parser: argparse.ArgumentParser, nargs: str | None = None) -> None:
    """Add the scene, overrides of its keys, and the folder of emitted modules."""
    add(parser, {"scene SCENE": "a built-in name or a .toml file"}, nargs=nargs)
    override = "override a key, e.g. --set links.crank='0.12 m'; may be repeated"
    add(parser, {"--set KEY=VALUE": override}, action="append", default=[])
    add(parser, {"--modules DIR": "look for emitted modules in this folder first"})


def load(options: argparse.Namespace, **more: Any) -> scenes.Scene:
    """Return the scene that the options name, with its overrides and ``more``."""
    return scenes.load_scene(options.scene, overrides={**settings(options.set), **more})


def settings(pairs: Sequence[str]) -> dict[str, Any]:
    """Turn ``KEY=VALUE`` texts into overrides.

    A value that TOML can read (``3``, ``[1, 2]``, ``"15 in"``) is taken as such, any other one
    (``15 in``) as text.
    """
    split = (pair(text, "--set", "KEY=VALUE", "links.crank='0.12 m'") for text in pairs)
    return {key: _value(value) for key, value in split}


def pair(text: str, where: str, form: str, example: str) -> tuple[str, str]:
    """Return the two sides of ``NAME=VALUE``; ``form`` and ``example`` say what is wanted."""
    name, sign, value = (part.strip() for part in text.partition("="))
    if not sign or not name:
        raise bad(where, repr(text), form, f"write {where} {example}")
    return name, value


def quantity(text: str, dimension: str, where: str) -> float:
    """Return one quantity of the command line in SI units."""
    from ..core.units import to_si

    return to_si(text, dimension, where)


def size(text: str, dimension: str, where: str) -> float:
    """Return a quantity that has to name its unit: a clearance of 0.1 would be of metres."""
    value = quantity(text, dimension, where)
    if value and re.fullmatch(r"[-+.eE\d\s]+", text):
        from ..core.units import DIMENSIONS

        fix = f"write it like '{DIMENSIONS[dimension].example}'"
        raise bad(where, repr(text), "a number with its unit", fix)
    return value


def given(options: argparse.Namespace, name: str, dimension: str) -> float | None:
    """Return the quantity of an option in SI units; None where it was not given."""
    text = getattr(options, name.replace("-", "_"))
    return None if text is None else quantity(text, dimension, f"--{name}")


def positive(options: argparse.Namespace, name: str, dimension: str) -> float | None:
    """Return the quantity of an option, refused where it is not above 0; None without it."""
    value = given(options, name, dimension)
    if value is not None and not value > 0.0:
        text = repr(getattr(options, name))
        raise bad(f"--{name}", text, f"a positive {dimension}", "correct the sign")
    return value


def values(text: str, dimension: str, where: str) -> Array:
    """Return evenly spaced values from ``START:STOP:COUNT[UNIT]``.

    The unit may also stand with the ends: ``100rpm:900rpm:200``.
    """
    parts = text.split(":")
    match = _COUNT.fullmatch(parts[-1]) if len(parts) == 3 else None
    if match is None:
        raise bad(where, repr(text), "START:STOP:COUNT[UNIT]", "write it like 100:900:201rpm")
    digits, unit = match.group(1).lstrip("0") or "0", match.group(2)
    # Python reads no numbers of thousands of digits.
    count = int(digits[:7])
    ends = [part if not unit else f"{part} {unit}" for part in parts[:2]]
    start, stop = (quantity(end, dimension, where) for end in ends)
    if not (stop > start and 2 <= count <= 100_000):
        raise bad(where, repr(text), "rising ends and a count from 2 to 100000", "correct it")
    return spaced(start, stop, count)


def span(text: str, dimension: str, where: str, example: str) -> tuple[float, float]:
    """Return two rising values from ``LOW:HIGH``; a unit behind both holds for both."""
    parts = [part.strip() for part in text.split(":")]
    unit = re.search(r"[^-+.\deE\s].*$", parts[-1])
    if len(parts) == 2 and unit and re.fullmatch(r"[-+.\deE]+", parts[0]):
        parts[0] = f"{parts[0]} {unit.group()}"
    ends = [quantity(part, dimension, where) for part in parts]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise bad(where, repr(text), "LOW:HIGH, rising", f"write it like {example}")
    return ends[0], ends[1]


def spaced(start: float, stop: float, count: int) -> Array:
    """Return evenly spaced values, both ends included."""
    import numpy as np

    return np.linspace(start, stop, count)


def picture(options: argparse.Namespace) -> Path | None:
    """Return the path of the wanted picture, refused here if it cannot be written."""
    if options.plot is None:
        return None
    from ..core.plotting import check_picture_path

    return check_picture_path(options.plot)


def kept_file(options: argparse.Namespace) -> Path | None:
    """Return the path of the file for the result, refused here if it cannot be written."""
    if options.save is None:
        return None
    from pathlib import Path

    from ..core.plotting import require_writable

    target, endings = Path(options.save), (".csv", ".json", ".nc", ".npz")
    if target.suffix not in endings:
        expected = f"an ending of {list(endings)}"
        raise bad("--save", repr(target.suffix), expected, "rename the file")
    return require_writable(target)


def refuse_unused(options: argparse.Namespace, names: Sequence[str], without: str) -> None:
    """Refuse an option that was given and does nothing but with what ``without`` names."""
    for name in names:
        given = getattr(options, name)
        if given is not None and given is not False:
            where = "--" + name.replace("_", "-")
            raise bad(where, "an option that does nothing here", without, "leave it out")


def finish(
    options: argparse.Namespace,
    result: Result,
    lines: Sequence[str],
    draw: Callable[[Axes], Any] | None = None,
    *,
    more: Mapping[str, Any] | None = None,
    beside: Sequence[Result] = (),
) -> int:
    """Write and keep a result as wanted and return the exit status: 1 where a self-check failed.

    The ``lines`` say the same for people, to which the error and the checks are added; the picture
    is ``result.plot`` where nothing else draws; the JSON holds ``more`` beside the result; and the
    self-checks of the results ``beside`` count too.
    """
    from ..core.results import worst_checks

    draw_into(options, draw or result.plot)
    if (path := kept_file(options)) is not None:
        result.save(path)
    checks = worst_checks(one.checks for one in (result, *beside))
    passed = all(check.passed for check in checks.values())
    content = {**result.to_dict(), **(more or {}), "passed": passed} if options.json else None
    say(options, content, "\n".join([*lines, *_verdict(result, checks)]))
    return exit_status(options, [checks])


def draw_into(options: argparse.Namespace, draw: Callable[[Axes], Any]) -> None:
    """Write the requested picture, if any."""
    path = picture(options)
    if path is not None:
        from ..core.plotting import new_figure, save_figure

        figure = new_figure()
        draw(figure.add_subplot())
        save_figure(figure, path)


def exit_status(options: argparse.Namespace, found: Iterable[Mapping[str, Check]]) -> int:
    """Tell each self-check that failed and return the exit status: 1 where one did."""
    failed = [pair for checks in found for pair in checks.items() if not pair[1].passed]
    for name, check in failed:
        text = f"self-check failed: {name}: {check.value:.3g} exceeds {check.limit:.3g}"
        print(f"elastolink {options.command}: {text}", file=sys.stderr)
    return int(bool(failed))


def say(options: argparse.Namespace, content: Any, text: str) -> int:
    """Print the content as JSON, or else the text, and return the exit status.

    Keys are sorted; what is not finite becomes null, for JSON has no word for it.
    """
    if options.json:
        text = json.dumps(_finite(content), sort_keys=True, indent=1, allow_nan=False)
    # Titles and names are the scene's: what they hold must not steer the terminal.
    print("\n".join(map(printable, text.split("\n"))))
    return 0


def even_rows(count: int) -> NDArray[np.intp]:
    """Return at most 13 places among ``count``, evenly spread, the ends included."""
    import numpy as np

    return np.unique(np.linspace(0, count - 1, min(13, count)).round().astype(int))


def highest(values: Array, most: int = MOST_ROWS) -> NDArray[np.intp]:
    """Return the places of the local maxima inside a row, rising, the highest ``most`` of them."""
    import numpy as np

    from ..core.maxima import local_maxima

    inner = local_maxima(values)
    return np.sort(inner[np.argsort(-values[inner], kind="stable")[:most]])


def progress(options: argparse.Namespace) -> bool:
    """Return whether a progress bar is shown: on a terminal, and not beside JSON."""
    return sys.stderr.isatty() and not options.json


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a table, columns aligned, the first to the left."""
    columns = list(zip(header, *rows, strict=True))
    widths = [max(len(cell) for cell in column) for column in columns]
    lines = []
    for row in (header, *rows):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  ".join(cells).rstrip())
    return lines


def columns(*columns: tuple[str, str, Iterable[Any]]) -> list[str]:
    """Return the lines of a table of columns: heading, format of its cells, values."""
    header = [heading for heading, _, _ in columns]
    cells = ([format(value, form) for value in values] for _, form, values in columns)
    return table(header, list(zip(*cells, strict=True)))


def multipliers(heading: str, values: Iterable[complex]) -> list[str]:
    """Return the lines of a table of Floquet multipliers, with their moduli."""
    rows = [(f"{value.real:+.9f} {value.imag:+.9f}i", f"{abs(value):.9f}") for value in values]
    return table((heading, "modulus"), rows)


def ranges(result: Result) -> list[str]:
    """Return one line per array of a result: shape, least and greatest value."""
    import numpy as np

    rows = []
    for name, value in sorted(result.arrays().items()):
        if name == "error" or value.dtype.kind not in "fiu" or value.size == 0:
            continue
        finite = value[np.isfinite(value)]
        ends = ("", "") if finite.size == 0 else (f"{finite.min():.6g}", f"{finite.max():.6g}")
        rows.append((name, "x".join(map(str, value.shape)) or "-", *ends))
    return table(("quantity", "shape", "least", "greatest"), rows) if rows else []


def _verdict(result: Result, checks: Mapping[str, Check]) -> list[str]:
    import numpy as np

    error = np.asarray(result.error, dtype=float)
    finite = error[np.isfinite(error)]
    worst = f"{finite.max():.2g}" if finite.size else "not known"
    # Where nothing was found, nothing has an error.
    error_line = f"error:  {worst} ({result.error_kind}; {result.error_norm})"
    return [
        f"method: {result.method}",
        *([error_line] if error.size else []),
        *(
            f"check:  {name}: {check.value:.2g} (limit {check.limit:.2g})"
            for name, check in checks.items()
        ),
    ]


def _value(text: str) -> Any:
    import tomllib

    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    # A text with line breaks could smuggle in more keys than one.
    return parsed["value"] if set(parsed) == {"value"} else text


def _finite(content: Any) -> Any:
    if isinstance(content, dict):
        return {str(key): _finite(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_finite(value) for value in content]
    if isinstance(content, float) and not math.isfinite(content):
        return None
    return content
