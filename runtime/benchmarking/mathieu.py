"""Benchmark of Mathieu's characteristic values: ours and SciPy's against certified enclosures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check
from ..hill import hill_boundaries
from .records import Benchmark, Contender, Row, compare, one_thread

Array = NDArray[np.float64]

_ORDERS = (*range(61), 80, 100)
_STRENGTHS = (1.0, 15.525, 20.85, 31.325, 100.0, 300.0, 1e3, 3e3, 1e4)
_WANTED = 1e-12
# Deviations beyond this share of the scale are another branch, not lost digits.
_JUMP = 1e-6


def benchmark_mathieu(
    orders: Sequence[int] = _ORDERS, strengths: Sequence[float] = _STRENGTHS, rounds: int = 5
) -> Benchmark:
    """Compare the characteristic values a_r and b_r of y'' + (a - 2 q cos 2x) y = 0.

    Parameters
    ----------
    orders : sequence of int
        Orders r >= 0 (b_0 does not exist and is left out).
    strengths : sequence of float
        Values of q > 0.
    rounds : int
        How often each contender runs, in turn.

    Returns
    -------
    Benchmark
        Errors are relative to ``max(|a|, 2 q)``, the larger of the value itself and half the range
        of the potential: close to its zeros, no absolute digits beyond those of q can be had.
        ``error`` is our worst.

    Raises
    ------
    BadInput
        If a number is out of range.

    Notes
    -----
    With theta = 2x these are the boundaries ``lam2 = a/4`` at ``mu = -q/2``, f = cos theta: region
    r reaches from b_r to a_r.  The reference are certified enclosures, narrower than a rounding.
    SciPy's ``mathieu_a`` and ``mathieu_b`` jump to the values of other orders: at first (1.17) in
    narrow windows of q, such as a_3 at q = 15.525, later at most orders.  The remark counts
    these and names the first.
    """
    if rounds < 1 or not all(q > 0.0 for q in strengths) or not all(r >= 0 for r in orders):
        raise bad(
            "benchmark_mathieu",
            f"orders {list(orders)}, q {list(strengths)}, {rounds} rounds",
            "orders >= 0, q > 0, at least one round",
            "take other numbers",
        )
    return one_thread(_measure, tuple(orders), tuple(strengths), rounds)


def _measure(orders: tuple[int, ...], strengths: tuple[float, ...], rounds: int) -> Benchmark:
    rows: list[Row] = []
    worst = 0.0
    for q in strengths:
        values = _Values(orders, q)
        ours, theirs = values.deviations(values.ours()), values.deviations(values.scipy())
        worst = max(worst, float(ours.max()))
        contenders = [
            Contender("elastolink", values.ours, values.error),
            Contender(
                "scipy.special", values.scipy, values.error, note=_remark(theirs, values.names)
            ),
        ]
        rows += compare(f"q = {q:g}", contenders, rounds)
    return Benchmark(
        method="against certified enclosures",
        error=worst,
        error_norm="characteristic values, relative to max(|a|, 2 q)",
        checks={"error of the characteristic values": Check(worst, _WANTED)},
        title=f"Mathieu's a_r and b_r, r up to {max(orders)}",
        rows=tuple(rows),
    )


class _Values:
    """The characteristic values of some orders at one q, as an array: all a_r, then all b_r."""

    def __init__(self, orders: tuple[int, ...], q: float) -> None:
        self.orders, self.q = orders, q
        self.odd = [r for r in orders if r]
        self.names = [f"a_{r}" for r in orders] + [f"b_{r}" for r in self.odd]
        self.truth = self.ours(certified=True)
        self.scale = np.maximum(np.abs(self.truth), 2.0 * q)

    def ours(self, certified: bool = False) -> Array:
        found = hill_boundaries(
            PeriodicFunction([0.0, 1.0]), -0.5 * self.q, self.orders, certified=certified
        )
        return 4.0 * np.concatenate([found.upper, found.lower[np.array(self.orders) > 0]])

    def scipy(self) -> Array:
        from scipy import special

        calls: Callable[..., Any] = partial(np.asarray, dtype=float)
        return np.concatenate(
            [
                calls(special.mathieu_a(self.orders, self.q)),
                calls(special.mathieu_b(self.odd, self.q)),
            ]
        )

    def deviations(self, found: Array) -> Array:
        gaps: Array = np.abs(found - self.truth) / self.scale
        return np.where(np.isnan(gaps), np.inf, gaps)

    def error(self, found: Array) -> float:
        return float(self.deviations(found).max())


def _remark(deviations: Array, names: list[str]) -> str:
    """Say which values are another branch's."""
    jumps = [name for name, gap in zip(names, deviations, strict=True) if gap > _JUMP]
    if not jumps:
        return ""
    shown = ", ".join(jumps[:6]) + (", ..." if len(jumps) > 6 else "")
    return f"{len(jumps)} of {len(names)} wrong: {shown}"
