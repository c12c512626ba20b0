"""Multiple shooting for periodic motions on a constraint manifold, every step a segment."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.errors import BadInput
from ..core.families import Constrained
from .gauss_steps import Ring, Sweep, sweep
from .variational import Array, Scale, Tangent, linearised, onto_manifold, tangent

_EPS = float(np.finfo(float).eps)
_MOST_STEPS = 40
_LEAST_DAMPING = 1.0 / 256
# Newton has arrived where its step, relative to the orbit, is rounding ...
_ROUNDING = 64 * _EPS
# ... or where it stops shrinking below this.
_SMALL = 1e-8


@dataclass(frozen=True)
class Shot:
    """Where the iteration came to.

    Attributes
    ----------
    ring : Ring
        The motion.
    sweep : Sweep
        Its linearisation.
    residual : float
        Largest defect of a stage or junction, relative to the motion's size.
    iterations : int
        Newton steps.
    reason : str
        Empty where the iteration converged, else why not.
    """

    ring: Ring
    sweep: Sweep
    residual: float
    iterations: int
    reason: str


def shoot(system: Constrained, ring: Ring, scale: Scale) -> Shot:
    """Return the periodic motion near a ring, by damped Newton in tangent coordinates.

    The unknowns are the stage accelerations of all steps and the tangent coordinates of the
    states where steps meet; after each Newton step these states are moved onto the constraints.
    """
    here = Shot(ring, sweep(system, ring, scale), np.inf, 0, "")
    size = _size(ring, scale)
    before = np.inf
    for count in range(_MOST_STEPS):
        here = replace(here, residual=here.sweep.defect / size, iterations=count)
        if not np.isfinite(here.residual):
            return replace(here, reason="diverging shooting: the motion is not finite")
        step = _newton_step(system, here, scale)
        if step is None:
            return replace(
                here, reason="diverging shooting: singular, a multiplier of the motion is 1"
            )
        length = step.length / size
        if length < _SMALL and length > before / 2:
            return here
        taken = _damped(system, here, step, scale)
        if isinstance(taken, str):
            return replace(here, reason=f"diverging shooting: {taken}")
        if length <= _ROUNDING:
            last = taken[0]
            return replace(last, residual=last.sweep.defect / size, iterations=count + 1)
        here, part = taken
        before = length if part == 1.0 else np.inf
        size = _size(here.ring, scale)
    return replace(here, reason=f"diverging shooting: not there after {_MOST_STEPS} steps")


def _size(ring: Ring, scale: Scale) -> float:
    state = np.abs(scale.state(ring.q, ring.qd))
    return float(max(np.max(state), np.finfo(float).tiny))


@dataclass(frozen=True)
class _Step:
    """Changes of states and stage accelerations of a whole Newton step."""

    q: Array
    qd: Array
    slope: Array
    length: float


def _newton_step(system: Constrained, here: Shot, scale: Scale) -> _Step | None:
    ring, swept = here.ring, here.sweep
    meeting = junctions(system, ring, scale)
    joined = ring.following(meeting.along)
    reduced = np.swapaxes(joined, -1, -2) @ swept.maps @ meeting.along
    wrong = (np.swapaxes(joined, -1, -2) @ swept.gap[..., None])[..., 0]
    solved = closed_chain(reduced, wrong[..., None])
    if solved is None:
        return None
    change = (meeting.along @ solved)[..., 0]
    slope = swept.slopes + (swept.response @ change[:, None, :, None])[..., 0]
    dq, dqd = scale.physical(change)
    inner = np.max(np.abs(slope * scale.size)) * ring.step / scale.rate
    return _Step(dq, dqd, slope, float(max(np.max(np.abs(change), initial=0.0), inner)))


def junctions(system: Constrained, ring: Ring, scale: Scale) -> Tangent:
    """Return the tangent spaces where the steps meet."""
    return tangent(linearised(system, ring.q, ring.qd, ring.start), scale)


def closed_chain(maps: Array, wrong: Array) -> Array | None:
    """Solve ``e_{j+1} - G_j e_j = r_j`` round a ring; None where it is singular.

    The equations stand together (sparse), not multiplied up, so that growth does no harm.

    Parameters
    ----------
    maps : ndarray, shape (m, p, p)
        G_j.
    wrong : ndarray, shape (m, p, r)
        Right-hand sides.
    """
    from scipy import sparse
    from scipy.sparse.linalg import splu

    m, p, _ = maps.shape
    if p == 0:
        return np.zeros_like(wrong)
    index = np.arange(m * p).reshape(m, p)
    row = np.broadcast_to(index[:, :, None], (m, p, p))
    column = np.broadcast_to(index[:, None, :], (m, p, p))
    ahead = np.roll(index, -1, axis=0)
    values = np.concatenate([-maps.ravel(), np.ones(m * p)])
    places = (
        np.concatenate([row.ravel(), index.ravel()]),
        np.concatenate([column.ravel(), ahead.ravel()]),
    )
    matrix = sparse.csc_matrix((values, places), shape=(m * p, m * p))
    try:
        found: Array = splu(matrix).solve(np.ascontiguousarray(wrong.reshape(m * p, -1)))
    except RuntimeError:
        return None
    if not np.all(np.isfinite(found)):
        return None
    return found.reshape(wrong.shape)


def _damped(system: Constrained, here: Shot, step: _Step, scale: Scale) -> tuple[Shot, float] | str:
    """Return the motion after the step and the part taken; or why none lessens the defect."""
    part, reason = 1.0, "no shortened Newton step lessens the defect"
    while part >= _LEAST_DAMPING:
        try:
            taken = _moved(system, here.ring, step, part, scale)
        except (BadInput, np.linalg.LinAlgError) as refusal:
            reason = str(refusal)
        else:
            limit = (1.0 - part / 4) * here.sweep.defect
            rounding = _SMALL * _size(taken.ring, scale)
            if taken.sweep.defect <= max(limit, rounding if part == 1.0 else 0.0):
                return taken, part
        part /= 2
    return reason


def _moved(system: Constrained, ring: Ring, step: _Step, part: float, scale: Scale) -> Shot:
    with np.errstate(all="ignore"):
        q, qd = onto_manifold(
            system, ring.q + part * step.q, ring.qd + part * step.qd, ring.start, scale
        )
        moved = replace(ring, q=q, qd=qd, slope=ring.slope + part * step.slope)
        return Shot(moved, sweep(system, moved, scale), np.inf, 0, "")
