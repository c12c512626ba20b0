"""Boundaries by bisection of the half trace, as a rival of the Hill matrix."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

from ..core.periodic_function import PeriodicFunction
from ..hill import hill_boundaries
from .chart import batched_heyoka, one_half_trace
from .records import Contender, Row, missing

Array = NDArray[np.float64]
HalfTraces = Callable[[Array, Array], Array]

# Ends of regions narrower than this are double roots to the integrators: they are left out.
_NARROW = 1e-3
_TOLERANCE = 1e-12
_ONE_BY_ONE = "heyoka, bisection end by end"
_TOGETHER = "heyoka, bisection of all ends at once"
_SCIPY = "solve_ivp (DOP853, rtol 1e-12), bisection"


@dataclass(frozen=True)
class Brackets:
    """Ends of regions with brackets around them, given to the rivals without charge.

    Attributes
    ----------
    inside, outside : ndarray, shape (n,)
        lam2 in the middle of the region, and a quarter of the way to the next one.
    sign : ndarray, shape (n,)
        Sign of the half trace in the region.
    truth : ndarray, shape (n,)
        The ends.
    whole : int
        How many ends the problem has, those that cannot be bisected included.
    """

    inside: Array
    outside: Array
    sign: Array
    truth: Array
    whole: int

    @classmethod
    def of(cls, ends: Array, floor: float) -> Brackets:
        """Return them for the ends of regions 1, 2, ..., shape ``(2, regions)``, above region 0."""
        low, high = ends
        before = np.concatenate([[floor], high[:-1]])
        after = np.concatenate([low[1:], [high[-1] + 0.4]])
        outside = np.stack([low - 0.25 * (low - before), high + 0.25 * (after - high)])
        inside = np.broadcast_to(0.5 * (low + high), outside.shape)
        sign = np.broadcast_to(np.where(np.arange(low.size) % 2 == 0, -1.0, 1.0), outside.shape)
        wide = np.broadcast_to(high - low > _NARROW, outside.shape)
        return cls(inside[wide], outside[wide], sign[wide], ends[wide], ends.size)

    def first(self, count: int) -> Brackets:
        """Return the first few."""
        return self._part(slice(0, count))

    def bisect(self, half_traces: HalfTraces, mu: float) -> Array:
        """Return the ends to 1e-12, all bisected at once."""
        inside, outside = self.inside.copy(), self.outside.copy()
        steps = ceil(log2(np.abs(inside - outside).max() / _TOLERANCE))
        values = np.full(inside.size, mu)
        for _ in range(steps):
            middle = 0.5 * (inside + outside)
            unstable = self.sign * half_traces(middle, values) > 1.0
            inside = np.where(unstable, middle, inside)
            outside = np.where(unstable, outside, middle)
        return np.asarray(0.5 * (inside + outside))

    def one_by_one(self, half_traces: HalfTraces, mu: float) -> Array:
        """Return the same, one end after the other."""
        each = [self._part(slice(i, i + 1)) for i in range(self.inside.size)]
        return np.concatenate([one.bisect(half_traces, mu) for one in each])

    def _part(self, part: slice) -> Brackets:
        return Brackets(
            self.inside[part], self.outside[part], self.sign[part], self.truth[part], self.whole
        )

    def error(self, found: Array) -> float:
        """Return the largest deviation from the reference."""
        return float(np.abs(found - self.truth[: found.size]).max())


def bisections(
    problem: str, f: PeriodicFunction, mu: float, ends: Array
) -> tuple[list[Contender], list[Row]]:
    """Return the rivals that bisect, and rows for those that are not installed.

    The time of the ends that could be bisected is scaled to all of them; solve_ivp does one.
    """
    floor = float(hill_boundaries(f, mu, (0,)).upper[0])
    brackets = Brackets.of(ends, floor)
    share = brackets.inside.size / brackets.whole
    contenders, left_out = [], []
    single, batch = batched_heyoka(f, 1), batched_heyoka(f)
    if single is None or batch is None:
        left_out = [missing(problem, name, "not installed") for name in (_ONE_BY_ONE, _TOGETHER)]
    else:
        setting = f"tol {_TOLERANCE:g}, {brackets.inside.size} ends, brackets given"
        for name, run in (
            (_ONE_BY_ONE, partial(brackets.one_by_one, single, mu)),
            (_TOGETHER, partial(brackets.bisect, batch, mu)),
        ):
            contenders.append(Contender(name, run, brackets.error, share, setting))
    one, short = brackets.first(1), f.truncated(_TOLERANCE)

    def half_traces(lam2: Array, values: Array) -> Array:
        return np.array([one_half_trace(short, x, y) for x, y in zip(lam2, values, strict=True)])

    contenders.append(
        Contender(
            _SCIPY,
            partial(one.bisect, half_traces, mu),
            one.error,
            1.0 / brackets.whole,
            "one end, bracket given",
        )
    )
    return contenders, left_out
