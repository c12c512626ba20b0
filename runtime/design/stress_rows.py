"""A stress of a beam as a function of the state at one angle, and of the numbers of the machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..beams.element_forms import required_structure
from ..beams.recovery_forms import RIGID
from ..core.families import Array, LinearPeriodic
from ..core.trigonometric import interpolated
from ..periodic.equation import Equation
from ..periodic.periodic_motion import SteadyState
from ..recovery.beam_forces import Recovered, stations_of
from ..recovery.beam_motion import beam_motion
from ..recovery.stresses import FIBRES, fibre_factors, stress_operator, stresses
from ..scenes import Scene
from .coefficient_changes import moved_systems

# Step of the differences by the angle [rad], and units of the last place that a stress may be off.
_BESIDE, _ROUNDING = 1e-4, 32.0 * np.finfo(float).eps


@dataclass(frozen=True)
class StressRow:
    """The stress [Pa] of one outer fibre at one place x/length of a beam."""

    link: str
    place: float
    fibre: str
    method: str  # how forces are recovered: see :func:`.stress`

    @property
    def _stations(self) -> dict[str, list[float]]:
        return {self.link: [self.place]}

    def history(self, system: LinearPeriodic, motion: SteadyState) -> tuple[Array, float]:
        """Return the stress over the angles of a motion, and what the motion's error does to it."""
        asked = Recovered(system, beam_motion(system, motion), self._stations, self.method)
        factors = fibre_factors(system, stations_of(required_structure(system), self._stations))
        axial, bending = stresses(asked, factors)
        sign = 1.0 if self.fibre == FIBRES[0] else -1.0
        doubt = asked.propagated()
        return (axial + sign * bending)[:, 0], doubt[0] * factors[0][0] + doubt[2] * factors[1][0]

    def _parts(self, system: LinearPeriodic, angles: Array, speed: float) -> tuple[Array, ...]:
        """Return the rows on q and dq/dtheta, ``(nt, n)``, and what is without motion."""
        form, _ = stress_operator(system, angles, self._stations, method=self.method)
        rows, row = form.at_speed(speed), FIBRES.index(self.fibre)
        blank = np.zeros((len(angles), 2, system.size))
        on_q, on_slope = (rows.get(name, blank)[:, row] for name in ("q", "dq"))
        return on_q, on_slope, rows.get(RIGID, blank[..., 0])[:, row]

    def rows(self, system: LinearPeriodic, angle: float, equation: Equation) -> Array:
        """Return the stress and its rate as rows of the scaled state, ``(1, 2, m)``."""
        n, unit = equation.size, equation.scale[0]
        angles = angle + _BESIDE * np.arange(-1.0, 2.0)
        on_q, on_slope, rest = self._parts(system, angles, float(equation.speed[0]))
        flow = equation.generator(angles)[0]
        told = np.einsum("tn,tnm->tm", on_slope * unit, flow[:, :n])
        told[:, :n] += on_q * unit
        told[:, 2 * n] += rest
        before, here, after = told
        rate = (after - before + _BESIDE * (after + before) @ flow[1]) / (2.0 * _BESIDE)
        return np.stack([here, rate])[None, :, : 2 * n]

    def value(self, system: LinearPeriodic, angle: float, speed: float, state: State) -> float:
        """Return the stress [Pa] in a state at an angle [rad]."""
        place = np.array([angle])
        mass, gyro = (system.array(name, place)[0] for name in "MA")
        on_q, on_slope, rest = self._parts(system, place, speed)
        slope = np.linalg.solve(mass, state.momentum - gyro @ state.q)
        return float((on_q @ state.q + on_slope @ slope + rest)[0])


class State(NamedTuple):
    """Coordinates and their momenta ``M dq/dtheta + A q``, ``(n,)`` each."""

    q: Array
    momentum: Array

    @classmethod
    def of(cls, system: LinearPeriodic, motion: SteadyState, angle: float) -> State:
        """Return that of a motion at an angle."""
        place = np.array([angle])
        q, qd = (
            interpolated(rows.reshape(-1, system.size), motion.period)(place)[0]
            for rows in (motion.q, motion.qd)
        )
        mass, gyro = (system.array(name, place)[0] for name in "MA")
        return cls(q, mass @ (qd / float(motion.speed.reshape(()))) + gyro @ q)


def slopes_in_one_state(
    machine: LinearPeriodic | Scene,
    system: LinearPeriodic,
    motion: SteadyState,
    told: Sequence[tuple[StressRow, float]],
    by: Sequence[str],
) -> tuple[Array, Array]:
    """Return derivatives of stresses ``(rows, k)`` where the states stay, and their errors.

    Each row is told with its angle [rad].
    """
    speed = float(motion.speed.reshape(()))
    states = [State.of(system, motion, angle) for _, angle in told]
    slopes, errors = np.empty((2, len(told), len(by)))
    for i, name in enumerate(by):
        made, (fine, coarse) = moved_systems(machine, system, name, speed)
        values = np.array(
            [
                [row.value(one, angle, pace, state) for one, pace in made]
                for (row, angle), state in zip(told, states, strict=True)
            ]
        )
        slopes[:, i] = values @ fine
        errors[:, i] = np.abs(slopes[:, i] - values @ coarse)
        errors[:, i] += _ROUNDING * np.sum(np.abs(fine)) * np.max(np.abs(values), axis=1)
    return slopes, errors
