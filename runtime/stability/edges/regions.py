"""Unstable regions along the speed as plain arrays, before they become a result."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Regions:
    """Regions with their ends and labels, see :class:`~.tracing.StabilityEdges`.

    ``begin`` and ``end`` are as far as the region is known to reach: its ends where it has them,
    else the last speed at which it was seen.
    """

    lower: Array
    upper: Array
    error: Array
    multiplier: NDArray[np.complex128]
    modes: NDArray[np.int64]
    harmonic: NDArray[np.int64]
    detuning: Array
    begin: Array
    end: Array
    kind: tuple[str, ...]

    @property
    def middle(self) -> Array:
        """Middle of each, or the one end that there is, or of where it was seen."""
        low = np.where(np.isfinite(self.lower), self.lower, self.upper)
        high = np.where(np.isfinite(self.upper), self.upper, self.lower)
        seen = 0.5 * (self.begin + self.end)
        value: Array = np.where(np.isfinite(low + high), 0.5 * (low + high), seen)
        return value

    def take(self, index: NDArray[np.intp]) -> Regions:
        """Return some of the regions, in the order given."""
        values = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "kind"}
        kind = tuple(self.kind[i] for i in index)
        return Regions(**{name: value[index] for name, value in values.items()}, kind=kind)

    def overlapping(self, low: float, high: float) -> Regions:
        """Return those that reach into a range, by rising speed."""
        kept = np.flatnonzero((self.end >= low) & (self.begin <= high))
        return self.take(kept[np.argsort(self.middle[kept], kind="stable")])


def joined(first: Regions, second: Regions) -> Regions:
    """Return the regions of both."""
    names = [f.name for f in fields(Regions) if f.name != "kind"]
    both = {n: np.concatenate([getattr(first, n), getattr(second, n)]) for n in names}
    return Regions(**both, kind=first.kind + second.kind)
