"""The error of every emitted function, measured against 80 digits.

After a change of a model or of the lowering:  python tests/derive/emitted_accuracy.py
writes the tables of docs/accuracy.md, a line a module, and prints every output.
"""

import importlib
import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from elastolink import generated
from forces_truth import exact_points as exact_forces
from free_free_truth import ROD_MODULE, WithModes, exact_rod
from frequency_truth import MODULE as FREQUENCY_FUNCTIONS
from frequency_truth import exact_frequency_functions
from judging import Exact, Judgement, judge, worst
from linkage_truth import exact_points
from sliding_truth import EXACT as SLIDING
from stations_truth import STATION_MODULES, AtEachStation, exact_stations
from unlowered import exact_unlowered, judged_unlowered

PAGE = Path(__file__).resolve().parents[2] / "docs" / "accuracy.md"
MANIFEST = Path(generated.__path__[0]) / "manifest.json"
_SHORT_FRAME = (
    "frame 1e-6 of the links, crank in line with it: link 3 moves as one with the crank, and the "
    "components across of its inertia and of force 34 cancel but for 1e-8 of either"
)
# Outputs that may exceed the measure, with the reason.
EXCEPTIONS: dict[tuple[str, str, str], str] = {
    (f"{mechanism}_forces", function, output): _SHORT_FRAME
    for mechanism, output in (("four_bar", "y12"), ("four_bar", "y23"), ("quick_return", "y23"))
    for function in ("forces", "pin_forces")
}
COUNTS = (1, 3)  # numbers of modes that a module for any number is judged with
# Modules for any number of modes or stations, judged entry by entry.
INDEXED = frozenset({ROD_MODULE, *STATION_MODULES})


@dataclass(frozen=True)
class Row:
    """One output of one emitted function and the worst of its judgements."""

    module: str
    function: str
    points: int
    judgement: Judgement

    @property
    def key(self) -> tuple[str, str, str]:
        return self.module, self.function, self.judgement.output


@cache
def emitted_functions() -> dict[str, dict[str, tuple[str, ...]]]:
    """Return the names of what each function of each packaged module returns.

    Without the recursions: their functions take an algebra, not numbers.  What they compute in
    double precision is compared with 90 digits in ``tests/runtime/hill/test_series.py``.
    """
    entries = json.loads(MANIFEST.read_text())["modules"].values()
    names = sorted(entry["module"] for entry in entries)
    modules = {name: importlib.import_module(f"{generated.__name__}.{name}") for name in names}
    return {name: m.RETURNS for name, m in modules.items() if m.FAMILY != "recursion"}


def _function(module: str, function: str) -> Callable:
    return getattr(importlib.import_module(f"{generated.__name__}.{module}"), function)


def _exact(module: str, function: str) -> tuple[Exact, ...]:
    if judged_unlowered(module, function):
        return exact_unlowered(module, function)
    if module == FREQUENCY_FUNCTIONS:
        return exact_frequency_functions(function)
    if module.endswith("_forces"):
        return exact_forces(module, function)
    return SLIDING[module]() if module in SLIDING else exact_points()


@cache
def rows(module: str, most: int | None = None) -> tuple[Row, ...]:
    """Judge the functions of a module, each at most at so many of its points, evenly chosen."""
    found = []
    for function, names in emitted_functions()[module].items():
        cases: list[tuple[Callable, tuple[str, ...], tuple[Exact, ...]]]
        if module == ROD_MODULE:
            called = [WithModes(function, count) for count in COUNTS]
            cases = [(c, c.names, exact_rod(c)) for c in called]
        elif module in STATION_MODULES:
            case = AtEachStation(module, function)
            cases = [(case, case.names, exact_stations(module))]
        else:
            cases = [(_function(module, function), names, _exact(module, function))]
        judged: dict[str, Judgement] = {}
        points = 0
        for emitted, outputs, exact in cases:
            chosen = exact[:: 1 if most is None else -(-len(exact) // most)]
            made = worst(j for at in chosen for j in judge(emitted, outputs, at))
            judged = worst([*judged.values(), *made.values()])
            points += len(chosen)
        found += [Row(module, function, points, judged[name]) for name in sorted(judged)]
    return tuple(found)


def bound(measure: float) -> int:
    """Return a measure rounded up to a power of two: what another processor leaves alone."""
    return 2 ** max(0, math.ceil(math.log2(measure))) if measure else 1


@cache
def _judged() -> dict[str, tuple[Row, ...]]:
    return {module: rows(module) for module in emitted_functions()}


def _modules() -> str:
    """Return the table of the worst measure of each module."""
    lines = ["| module | outputs | points | worst measure at most | of |", "| --- " * 5 + "|"]
    for module, judged in _judged().items():
        kept = [row for row in judged if row.key not in EXCEPTIONS]
        last = max(kept, key=lambda row: row.judgement.measure)
        points = max(row.points for row in judged)
        of = f"`{last.function}`: `{last.judgement.output}`"
        worst_of = bound(last.judgement.measure)
        lines.append(f"| {module} | {len(judged)} | {points} | {worst_of} | {of} |")
    return "\n".join(lines)


def _exceptions() -> str:
    """Return the outputs that exceed the measure, below their reasons."""
    lines = []
    for reason in sorted(set(EXCEPTIONS.values())):
        keys = [" ".join(key) for key, why in EXCEPTIONS.items() if why == reason]
        lines += [f"- {reason}:", *(f"  - {key}" for key in keys)]
    return "\n".join(lines) or "None."


def page_bounds(text: str) -> dict[str, int]:
    """Return the bounds that the page states, by module."""
    lines = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {module: int(most) for module, _, _, most, _ in lines[2:]}


def main() -> None:
    """Write the page, and print every output with its measure."""
    text = PAGE.read_text()
    for name, made in (("modules", _modules()), ("exceptions", _exceptions())):
        pattern = rf"(<!-- {name} -->\n).*?(\n<!-- end -->)"
        text = re.sub(pattern, lambda m, t=made: m[1] + t + m[2], text, flags=re.S)
    PAGE.write_text(text)
    for row in (row for judged in _judged().values() for row in judged):
        j = row.judgement
        at = j.point.name if j.measure else "exact everywhere"
        print(f"{row.module:30} {row.function:30} {j.output:30} {j.measure:7.2g}  {at}")


if __name__ == "__main__":
    main()
