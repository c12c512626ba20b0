"""Write the tables of docs/unstable_bands.md to the screen: by hand, some minutes a table.

Arguments: elements a link, 0 or 1 for the geometric stiffness, lowest and highest speed [rad/s].
"""

from __future__ import annotations

import sys

import elastolink as el
import numpy as np
from elastolink.runtime.periodic.decoupled import slow_system
from elastolink.runtime.stability import StabilityEdges, stability_edges

WIDTHS = (1e-7, 1e-5, 1e-3)
WIDEST = 10


def bands(elements: int, geometric_stiffness: bool, low: float, high: float) -> StabilityEdges:
    """Return the unstable bands of the undamped four-bar of Table 4.1."""
    overrides: dict[str, object] = {"mesh.elements": elements, "damping.ratio": 0.0}
    if not geometric_stiffness:
        overrides["model.drop"] = ["geometric_stiffness"]
    system = el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()
    slow = slow_system(system, (low / 1.05, high * 1.05))
    sys.stdout.write(f"{slow.modes} slow modes, known to {slow.error:.1e}\n")
    return stability_edges(slow, (low, high))


def lines(found: StabilityEdges) -> list[str]:
    """Return counts by width, contradictions, and the widest bands."""
    width = np.nan_to_num(found.width)
    mixed = np.array([kind != "principal" for kind in found.kind], dtype=bool)
    out = [
        f"wider than {least:g} rad/s: {np.sum(width > least)}, "
        f"combination {np.sum(mixed & (width > least))}"
        for least in WIDTHS
    ]
    out.append(f"in all {np.sum(width):.3f} rad/s, widest {np.max(width, initial=0.0):.1e} rad/s")
    seen = int(np.sum(width > 2 * found.error))
    out.append(f"pairs that meet: {len(width)}; wider than twice the error of an end: {seen}")
    out += [f"{name}: {check.value:g}" for name, check in found.checks.items()]
    for i in np.sort(np.argsort(-width)[:WIDEST]):
        doubt = ", doubtful" if found.doubtful[i] else ""
        out.append(f"{found.lower[i]:.4f} | {found.upper[i]:.4f} | {found.labels[i]}{doubt}")
    return out


if __name__ == "__main__":
    elements, stiffness, low, high = sys.argv[1:]
    found = bands(int(elements), stiffness == "1", float(low), float(high))
    sys.stdout.write("\n".join(lines(found)) + "\n")
