"""Motions of beams that forces are recovered from: computed ones, or arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..beams.assembly import Array
from ..beams.element_forms import required_structure
from ..core.errors import Problem, bad, refuse
from ..core.families import LinearPeriodic
from ..core.inputs import numbers
from ..core.results import Check

if TYPE_CHECKING:
    from ..periodic import SteadyState, Trajectory

Motion: TypeAlias = "BeamMotion | SteadyState | Trajectory"


@dataclass(frozen=True, kw_only=True)
class BeamMotion:
    """Motion of the coordinates of a structure of beams.

    Refused are shapes that do not agree, values that are not finite, and a speed that is not
    positive.
    """

    theta: Array  # crank angles [rad], (nt,)
    # coordinates and their time derivatives, (nt, n)
    q: Array
    qd: Array
    speed: float  # crank speed [rad/s]
    error: Array | None = None  # absolute, of each coordinate, (n,)
    period: float | None = None  # [rad], divided evenly by the angles, from 0; None: not periodic
    solved: str | None = None  # method of :func:`steady_state` that found it
    frozen: bool = False  # True: without accelerations, whatever the equation of motion says
    provenance: Mapping[str, str] = field(default_factory=dict)
    checks: Mapping[str, Check] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = []
        theta, q, qd = self.theta.shape, self.q.shape, self.qd.shape
        if self.q.ndim != 2 or q != qd or theta != q[:1]:
            found = f"shapes {theta}, {q}, {qd}"
            expected = "(nt,), (nt, n) and (nt, n)"
            problems.append(Problem("theta, q, qd", found, expected, "give one row per angle"))
        if not (np.isfinite(self.speed) and self.speed > 0):
            problems.append(Problem("speed", repr(self.speed), "a positive number", "correct it"))
        for name in ("theta", "q", "qd"):
            if not np.all(np.isfinite(getattr(self, name))):
                found = "a value that is not finite"
                fix = "look at the motion's own checks: there may be no single periodic one"
                problems.append(Problem(name, found, "finite numbers", fix))
        refuse(problems)

    @property
    def slope(self) -> Array:
        """Dq/dtheta, ``(nt, n)``."""
        return self.qd / self.speed

    @property
    def doubt(self) -> Array:
        """Absolute error of each coordinate, ``(n,)``."""
        return np.zeros(self.q.shape[1]) if self.error is None else self.error


def beam_motion(system: LinearPeriodic, motion: Motion | float | None) -> BeamMotion:
    """Return a motion of a structure of beams in one form.

    It may be computed, at one speed; a crank speed [rad/s], for the steady state there; or None,
    for the equilibrium of a structure that stands still.
    """
    # Loaded here: the response knows frequencies, and these know beams.
    from ..periodic import SteadyState, Trajectory
    from ..periodic.periodic_motion import quiet_state

    structure = required_structure(system)
    if motion is None or not structure.moving:
        return standing(system, motion)
    if isinstance(motion, Real) and not isinstance(motion, bool):
        # Mesh and equations err far more than this.
        motion = quiet_state(system, float(numbers("motion", motion)), 1e-7)
    if isinstance(motion, (SteadyState, Trajectory)):
        if np.size(motion.speed) != 1:
            found = f"{np.size(motion.speed)} speeds"
            raise bad("motion", found, "one", "take them one by one, or the curve over speeds")
        q, qd = (value.reshape(value.shape[-2:]) for value in (motion.q, motion.qd))
        steady = isinstance(motion, SteadyState)
        made = BeamMotion(
            theta=motion.theta,
            q=q,
            qd=qd,
            speed=float(np.reshape(motion.speed, ())),
            error=np.ravel(motion.error) * np.max(np.abs(q), axis=0),
            period=motion.period if isinstance(motion, SteadyState) else None,
            solved=motion.method if steady else None,
            provenance=motion.provenance,
            # Less the linear range, which is checked anew; ask the motion whether it is stable.
            checks={f"motion {k}": v for k, v in motion.checks.items() if k != "linear range"},
        )
    elif isinstance(motion, BeamMotion):
        made = motion
    else:
        expected = "a SteadyState, a Trajectory, a BeamMotion or a speed"
        raise bad("motion", type(motion).__name__, expected, "compute one first")
    if made.q.shape[1] != system.size:
        found = f"{made.q.shape[1]} coordinates"
        raise bad("motion", found, f"{system.size}", "give the motion of this system")
    return made


def chunks(motion: BeamMotion) -> list[slice]:
    """Return pieces of 256 angles of a motion, so that the arrays of one fit the memory."""
    return [slice(start, start + 256) for start in range(0, len(motion.theta), 256)]


def standing(system: LinearPeriodic, motion: object) -> BeamMotion:
    """Return the equilibrium of a structure that stands still under constant loads."""
    structure = required_structure(system)
    if structure.moving or motion is not None:
        found = "none of a linkage" if structure.moving else "one of a structure that stands still"
        fix = "give a speed" if structure.moving else "leave it out"
        raise bad("motion", found, "a motion of a linkage; None for a frame", fix)
    theta = np.zeros(1)
    stiffness = system.array("K", theta)[0] + system.array("Kg", theta)[0]
    q = np.linalg.solve(stiffness, system.array("p", theta)[0])
    return BeamMotion(theta=theta, q=q[None, :], qd=np.zeros((1, len(q))), speed=1.0)
