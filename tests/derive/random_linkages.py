"""Random linkages of every kind."""

from __future__ import annotations

from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank

KINDS = ("four-bar", "slider-crank", "quick-return")


def random_linkage(rng, kind="four-bar", size=1.0):
    """Return a linkage of a kind that closes, its crank free to turn or not; lengths to 3 sizes."""
    while True:
        first, second, third, last = (float(size * part) for part in rng.uniform(0.1, 3.0, 4))
        assembly = str(rng.choice(["open", "crossed"]))
        try:
            if kind == "four-bar":
                return FourBar(first, second, third, last, assembly)
            if kind == "slider-crank":
                offset = 0.0 if last < 0.5 * size else third - 1.5 * size
                return SliderCrank(first, second, offset, assembly)
            # The rod may be too short for a whole turn.
            return QuickReturn(first, second, max(third, last) + min(first, second))
        except BadInput:
            continue
