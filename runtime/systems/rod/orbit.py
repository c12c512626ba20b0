"""The periodic motion of the rod in Buckens' frame at a steady crank speed."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from numbers import Real

import numpy as np

from ...constrained.orbits import PeriodicOrbit, periodic_orbit
from ...core.errors import bad
from ...core.results import Check
from .constrained import FreeFreeRod, largest_deflection, rigid_state

_MOST_SAMPLES = 2**16


def rod_orbit(rod: FreeFreeRod, *, rtol: float = 1e-10, samples: int = 64) -> PeriodicOrbit:
    """Return the periodic motion of the rod, sought from the motion of the undeformed one.

    Parameters
    ----------
    rod : FreeFreeRod
        The system; its crank turns evenly.
    rtol : float
        Wanted error of the motion relative to its size.
    samples : int
        Crank angles at which the undeformed motion is given, at least 8.

    Returns
    -------
    PeriodicOrbit
        With the deflection from the line of pin and block, over the rod's length, watched: the
        check ``linear range`` fails beyond 5 %, the check ``block on the rod`` where the block
        leaves its end.  Where the shooting diverges, ``message`` says so; how far the motion is
        from that of the undeformed rod is told by ``moved`` and, as a deflection, ``deflection``.

    Raises
    ------
    BadInput
        If ``samples`` or ``rtol`` is unusable.
    """
    if not (isinstance(samples, Real) and 8 <= samples <= _MOST_SAMPLES and samples % 1 == 0):
        raise bad("samples", repr(samples), f"a whole number from 8 to {_MOST_SAMPLES}", "try 64")
    theta = np.arange(int(samples)) * (2.0 * np.pi / samples) * np.sign(rod.speed)
    state = rigid_state(rod, theta)
    # A crank longer than the base takes the rod round with it.
    turns = np.sign(rod.speed) if rod.linkage.crank > rod.linkage.frame else 0.0
    advance = np.zeros(rod.size)
    advance[2] = 2.0 * np.pi * turns
    state.q[:, 2] = np.unwrap(state.q[:, 2])

    watch = partial(largest_deflection, rod)
    orbit = periodic_orbit(
        rod, rod.period, state.q, state.qd, advance=advance, rtol=rtol, watch=watch
    )
    on_rod = Check(_farthest(rod, orbit), 1.0)
    return replace(orbit, checks={**orbit.checks, "block on the rod": on_rod})


def _farthest(rod: FreeFreeRod, orbit: PeriodicOrbit) -> float:
    """Return the largest distance of the block from the pin, over the rod's length."""
    crank, frame = rod.linkage.crank, rod.linkage.frame
    gamma = orbit.q[:, 2]
    place = crank * np.cos(gamma - rod.speed * orbit.t) + frame * np.cos(gamma)
    return float(np.max(place) / rod.linkage.rod)
