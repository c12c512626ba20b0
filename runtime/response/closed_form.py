"""Steady states by products of inverses as printed, algorithm 2, (6.20)-(6.25): ``closed_form``.

The maps of a damped system contract, their inverses stretch, and the products of many inverses
keep no digits of what is needed: at some number of intervals the answer is lost.  What is left of
the digits is measured, and no answer is given where none are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .request import Found, Request
from .stepped import stepped

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_MARGIN = 10.0


def by_closed_form(request: Request) -> Found:
    """Return periodic motions by the printed algorithm, with what round-off does to them."""
    return stepped(request, "closed form (algorithm 2 as printed)", printed_closing)


def printed_closing(maps: Array, loads: Array) -> tuple[Array, float, float]:
    """Return the states of a period by (6.24) and (6.25).

    With G = -map, ``y_1 = (I - (-1)^N prod G_k^-1)^-1 sum_k (-1)^(k+1) (G_1^-1 ... G_k^-1) f_k``,
    the sum from its inner end, and ``y_k = G_k^-1 (f_k - y_(k+1))`` from the last to the second.
    The recursion ends beside its start: the equation between both, ``y_2 + G_1 y_1 = f_1``, was
    not used, and tells what round-off has grown to.
    """
    count, m = loads.shape
    nothing = np.full_like(loads, np.nan)
    try:
        inverses = -np.linalg.inv(maps)
    except np.linalg.LinAlgError:
        return nothing, np.inf, np.inf
    with np.errstate(over="ignore", invalid="ignore"):
        product, total = np.eye(m), np.zeros(m)
        for inverse, load in zip(inverses[::-1], loads[::-1], strict=True):
            total = inverse @ (load - total)
            product = inverse @ product
        whole = np.eye(m) - (-1.0) ** count * product
    if not np.all(np.isfinite(whole)) or not np.all(np.isfinite(total)):
        return nothing, np.inf, np.inf
    spread = np.linalg.svd(whole, compute_uv=False)
    if not spread[-1] > 0.0:
        return nothing, np.inf, np.inf
    nodes = np.empty_like(loads)
    nodes[0] = ahead = np.linalg.solve(whole, total)
    for k in range(count - 1, 0, -1):
        nodes[k] = ahead = inverses[k] @ (loads[k] - ahead)
    size = float(np.max(np.abs(nodes))) or 1.0
    missed = float(np.max(np.abs(nodes[1] - maps[0] @ nodes[0] - loads[0]))) / size
    condition = float(spread[0] / spread[-1])
    rounding = _MARGIN * missed + _EPS * condition
    return nodes, 1.0, min(rounding, np.inf)
