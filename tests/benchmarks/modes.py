"""How many modes of the coupler the folds and doublings of Smith's rigs take.

    python tests/benchmarks/modes.py [--shooting] [A] [B] [C]

Prints the table "How many modes" of docs/nonlinear.md, a rig after another: with one to three modes
from response curves, with more from these, mode by mode.  ``--shooting`` adds how far the speeds
with three modes are from those by shooting with SciPy's DOP853, relative (half an hour).
"""

from __future__ import annotations

import sys
from pathlib import Path

from peers import one_thread

sys.path.insert(0, str(Path(__file__).parents[1] / "convergence"))
from bent_rigs import RPM
from more_modes import RIGS, Found, Rig, found, third, with_more
from oscillators import shot_special

MOST = 9
SHOWN = (1, 2, 3, 4, 5, 6, 7, MOST)
SPEEDS, SIZES = 1e-6, 1e-4  # relative, to which they are to settle


def settled(values: dict[int, float], rtol: float) -> int:
    """Return from how many modes on values differ from the last by less."""
    off = [n for n, value in values.items() if abs(value / values[MOST] - 1.0) > rtol]
    return max(off, default=0) + 1


def cells(values: dict[int, float], digits: int) -> list[str]:
    """Return the values that are shown."""
    return [f"{values[n]:.{digits}f}" if n in values else "-" for n in SHOWN]


def shot(rig: Rig, point: Found) -> float:
    """Return how far a speed is from the one that shooting finds, relative."""
    state = (1.0 + 1e-5) * point.orbit.motion.states[0]
    guess = point.orbit.value * (1.0 + 1e-6), state, point.turns
    speed, _ = shot_special(rig.system(3), point.kind, *guess, rtol=1e-12)
    return abs(speed / RPM / point.speed - 1.0)


def rows(rig: Rig, shooting: bool) -> list[list[str]]:
    """Return the rows of a rig."""
    few, lines = {n: found(rig, n) for n in (1, 2, 3)}, []
    for point in sorted(few[3], key=lambda point: point.speed):
        same = {3: point}
        for n in (1, 2):
            alike = [other for other in few[n] if other.is_like(point)]
            gaps = [abs(other.speed - point.speed) for other in alike]
            same |= {n: alike[gaps.index(min(gaps))]} if alike else {}
        same |= {more.orbit.motion.x.shape[1]: more for more in with_more(rig, point, MOST)}
        speeds = {n: p.speed for n, p in same.items()}
        sizes = {n: 1e3 * p.size for n, p in same.items()}
        line = [rig.title, point.kind, str(point.turns), *cells(speeds, 5)]
        line += [str(settled(speeds, SPEEDS)), f"{sizes[MOST]:.3f}", str(settled(sizes, SIZES))]
        lines.append([*line, f"{shot(rig, point):.0e}" if shooting else ""])
    return lines


def main() -> None:
    """Print the tables."""
    one_thread()
    options = sys.argv[1:]
    rigs = [RIGS[name] for name in options if name in RIGS] or list(RIGS.values())
    head = ["linkage, coupler", "", "turns", *map(str, SHOWN), "1e-6 from", "mm", "1e-4 from", ""]
    for rig in rigs:
        lines = rows(rig, "--shooting" in options)
        for line in (head, ["---"] * len(head), *lines):
            print("|", " | ".join(line), "|", flush=True)
        sizes = {n: 1e3 * size for n, size in enumerate(third(rig, MOST), 1)}
        words = f"at a third, {rig.third:g} rpm, peak to peak [mm]:", *cells(sizes, 5)
        print(*words, "settled to 1e-4 from", settled(sizes, SIZES), flush=True)


if __name__ == "__main__":
    main()
