"""The motion of the rod in Buckens' frame from the paper's start, watched and guarded."""

from __future__ import annotations

from functools import partial
from numbers import Real

from ...constrained import ConstrainedMotion, Guard, constrained_motion
from ...core.errors import bad
from .constrained import FreeFreeRod, largest_deflection, place_of_block, rigid_state

# Deflections over the length beyond which the equations mean nothing any more.
_BENT = 0.5
_MOST_SAMPLES = 2**20


def rod_motion(
    rod: FreeFreeRod,
    revolutions: float = 1.0,
    *,
    method: str = "collocation",
    rtol: float = 1e-9,
    samples: int = 360,
    progress: bool = False,
) -> ConstrainedMotion:
    """Return the motion that starts from the undeformed rod (Beale & Scott, section 2.3).

    At crank angle 0 every point of the rod has the place and the velocity of the rigid rod.

    Parameters
    ----------
    rod : FreeFreeRod
        The system; its crank turns evenly.
    revolutions : float
        Length of the motion in revolutions of the crank.
    method : str
        As for :func:`~elastolink.runtime.constrained.constrained_motion`.
    rtol : float
        Relative tolerance of one step.
    samples : int
        Given times per revolution.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    ConstrainedMotion
        Stopped, with the reason as message, where the block leaves the rod's end or the deflection
        passes half of the rod's length.  The check ``linear range`` fails beyond 5 % of it.

    Raises
    ------
    BadInput
        If an argument is unusable.
    """
    if not (isinstance(revolutions, Real) and 0 < revolutions <= 1e6):
        raise bad("revolutions", repr(revolutions), "a number above 0, at most 1e6", "correct it")
    if not (isinstance(samples, Real) and 1 <= samples <= _MOST_SAMPLES):
        raise bad("samples", repr(samples), f"a number from 1 to {_MOST_SAMPLES}", "try 360")

    watch = partial(largest_deflection, rod)
    guards = (
        Guard(
            lambda t, q, qd: float(1.0 - place_of_block(rod, q, t)),
            "the block left the end of the rod",
        ),
        Guard(
            lambda t, q, qd: _BENT - float(watch(q, t)),
            f"the deflection passed {_BENT:g} of the rod's length",
        ),
    )
    start = rigid_state(rod, 0.0)
    return constrained_motion(
        rod,
        start.q,
        start.qd,
        revolutions * rod.period,
        method=method,
        rtol=rtol,
        samples=max(1, round(samples * revolutions)),
        guards=guards,
        watch=watch,
        progress=progress,
    )
