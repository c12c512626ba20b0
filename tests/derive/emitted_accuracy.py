"""The error of every emitted function, measured against 80 digits.

After a change of a model or of the lowering:  python tests/derive/emitted_accuracy.py
writes docs/accuracy.md, a line a module;  with --table  it prints every output instead.
"""

from __future__ import annotations

import importlib
import json
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from elastolink import generated
from forces_truth import exact_points as exact_forces
from free_free_truth import MODES_MODULE, ROD_MODULE, WithModes, exact_modes, exact_rod
from frequency_truth import MODULE as FREQUENCY_FUNCTIONS
from frequency_truth import exact_frequency_functions
from judging import ALLOWED, Exact, Judgement, judge, worst
from linkage_truth import exact_points
from sensitivity_truth import EXACT as SENSITIVITIES
from sliding_truth import EXACT as SLIDING
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
    double precision is compared with exact fractions in
    ``tests/convergence/test_boundary_orders_in_doubles.py``.
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
    if module == MODES_MODULE:
        return exact_modes(function)
    motions = {**SENSITIVITIES, **SLIDING}
    return motions[module]() if module in motions else exact_points()


@cache
def rows(module: str, most: int | None = None) -> tuple[Row, ...]:
    """Judge the functions of a module, each at most at so many of its points, evenly chosen."""
    found = []
    for function, names in emitted_functions()[module].items():
        if module == ROD_MODULE:
            called = [WithModes(function, count) for count in COUNTS]
            cases = [(c, c.names, exact_rod(c)) for c in called]
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


def _page(found: dict[str, tuple[Row, ...]]) -> str:
    lines = [
        "# Accuracy of the emitted functions",
        "",
        "Written by `python tests/derive/emitted_accuracy.py`; a test compares it.",
        "",
        "Each function is evaluated in double precision and compared in 80 digits at the doubles",
        "that were passed in: with loop closure and its derivatives, the balance of moments and",
        "integrals of exponentials, or with the derived expressions before they are lowered.",
        "The measure is the error over `u (|f| + sum_i |x_i df/dx_i|)`, `u = 2^-53`: what rounding",
        f"the result and each input once would do.  At most {ALLOWED:g} is allowed.",
        "",
        "Points: 200 random ones (crank rockers and drag links, both assemblies, link ratios to",
        "100, lengths from 1e-4 to 1e4; parameters over twelve decades), and named nasty ones:",
        "every quarter turn, angles down to 5e-324, 1e-8 around the dead centres, 1000 turns,",
        "Smith's linkages, equal links, crank or frame 1e-6 of the others, change points, kites,",
        "rhombi and parallelograms a hair's breadth from folding; mode numbers to 60.",
        "Slider-cranks also with cranks that cannot turn, and a hair's breadth",
        "from crank + offset = coupler; quick-returns a hair's breadth from crank = frame.  Forces",
        "at 80 random and many nasty poses, masses or loads all drawn at random, or one of them",
        "alone; equations in redundant coordinates at 12 random states.  Intervals of Meissner's",
        "equation with phases to 1e6 and growth to exp(600), levels down to 5e-324, whole quarter",
        "turns, and several intervals where both ends of a region meet.  Beam elements: lengths",
        "and stiffnesses over twelve decades, their shapes at nodes, a hair's breadth from nodes,",
        "and where they change sign; beams of Timoshenko with next to no shear and next to no",
        "bending.",
        "",
        "Rounded up to a power of two, for mathematics libraries differ in the last digit.  Every",
        "output with its measure: `python tests/derive/emitted_accuracy.py --table`.",
        "",
        "| module | outputs | points | worst measure at most | of |",
        "| --- | ---: | ---: | ---: | --- |",
    ]
    for module, judged in found.items():
        kept = [row for row in judged if row.key not in EXCEPTIONS]
        last = max(kept, key=lambda row: row.judgement.measure)
        of = f"`{last.function}`: `{last.judgement.output}`"
        points = max(row.points for row in judged)
        lines.append(
            f"| {module} | {len(judged)} | {points} | {bound(last.judgement.measure)} | {of} |"
        )
    lines += ["", "## Exceptions", ""]
    if EXCEPTIONS:
        for reason in sorted(set(EXCEPTIONS.values())):
            keys = [" ".join(key) for key, why in EXCEPTIONS.items() if why == reason]
            lines += [f"- {reason}:", *(f"  - {key}" for key in keys)]
    else:
        lines.append("None.")
    lines += [
        "",
        "## Not in the table",
        "",
        "`hill_recursion` is generic: its functions take the operations of an algebra.  With words",
        "for an algebra they return the derived words; with doubles, the coefficients of Hill's",
        "equation are within 8 u of exact fractions, relative to the sum of the sizes of the terms",
        "(`tests/derive/test_bloch_emission.py`, `tests/convergence/test_boundary_orders_in_doubles.py`).",
    ]
    return "\n".join(lines) + "\n"


def page_bounds(text: str) -> dict[str, int]:
    """Return the bounds that the page states, by module."""
    table = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {module: int(most) for module, _, _, most, _ in table[2:]}


def main() -> None:
    """Write the page, or print the whole table."""
    found = {module: rows(module) for module in emitted_functions()}
    if "--table" not in sys.argv:
        PAGE.write_text(_page(found))
        return
    for row in (row for judged in found.values() for row in judged):
        j = row.judgement
        at = j.point.name if j.measure else "exact everywhere"
        print(f"{row.module:30} {row.function:30} {j.output:30} {j.measure:7.2g}  {at}")


if __name__ == "__main__":
    main()
