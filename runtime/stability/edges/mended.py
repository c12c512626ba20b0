"""Combination regions set right where more than two multipliers meet at once.

Two multipliers alone are followed by their gap, to round-off.  Where others are near, at +-1 or
where a sum and a difference region lie in each other, the pair may be the wrong one: there the
number of multipliers off the circle decides.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...core.families import LinearPeriodic
from .crossings import Crossings, Span
from .damped_edges import labelled
from .phase_events import phase_grid
from .regions import Regions, joined

Array = NDArray[np.float64]


def mended(
    system: LinearPeriodic,
    regions: Regions,
    usable: NDArray[np.bool_],
    where: tuple[tuple[float, float], Array],
    rtol: float,
    parameters: Mapping[str, float],
) -> Regions:
    """Return combination regions that agree with the multipliers off the circle.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    regions : Regions
        As pairs of multipliers make them.
    usable : ndarray of bool, shape (k,)
        False where the pair meets at +-1: kept for its label only.
    where : tuple
        The range, and speeds of interest [rad/s].
    rtol : float
        Of the monodromy matrices.
    parameters : mapping
        Parameter values that replace the system's own.
    """
    span, near = where
    ends = np.unique(np.concatenate([span, near[np.isfinite(near)]]))
    ends = ends[(ends >= span[0]) & (ends <= span[1])]
    speed = phase_grid(system, span, parameters, 0.5 * (ends[1:] + ends[:-1]))
    speed[[0, -1]] = span
    truth = [
        s
        for s in Crossings(system, parameters, rtol, speed, sharp=True).spans()
        if s.multiplier.imag != 0.0 and not s.upper - s.lower <= 4 * s.error
    ]
    kept, new = np.array(usable), list[Span]()
    own: set[int] = set()
    for one in truth:
        free = [int(i) for i in np.flatnonzero(usable) if int(i) not in own]
        same = [i for i in free if _same(regions, i, one)]
        own.update(same[:1])
        if not same:
            new.append(one)
    for one in new:
        over = (regions.begin < one.end) & (regions.end > one.begin)
        kept &= ~over | np.isin(np.arange(len(kept)), list(own))
    if not new:
        return regions.take(np.flatnonzero(kept))
    pool = regions.take(np.flatnonzero(~kept))
    return joined(regions.take(np.flatnonzero(kept)), labelled(new, pool))


def _same(regions: Regions, index: int, span: Span) -> bool:
    """Return True where both ends agree within their errors."""
    slack = float(regions.error[index]) + span.error
    pairs = [(float(regions.lower[index]), span.lower), (float(regions.upper[index]), span.upper)]
    return all(abs(a - b) <= slack or (np.isnan(a) and np.isnan(b)) for a, b in pairs)
