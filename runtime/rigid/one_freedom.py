"""The machine as one degree of freedom: reduced inertia, and the torque that the loads require."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..core.errors import bad, shown
from ..core.inputs import is_finite
from ..core.maxima import narrowed
from ..core.trigonometric import even_angles, interpolated, tail
from ..linkages.linkage import TURN, Array
from .evaluation import Evaluation
from .machine import Machine, Part, power_of, wrenches

# Angles of a scan: every half degree of a turn.
_SCANNED = 720
_PROBES = (0.37, 1.91, 4.05, 5.83, 7.77)


class OneFreedom:
    """``(J + flywheel) alpha + J'/2 omega^2 + load(theta, omega) = motor torque``.

    J and J'/2 are what the emitted driving torque becomes at crank acceleration 1 and speed 0, and
    at speed 1 and acceleration 0: it is linear in acceleration and square of the speed.
    """

    def __init__(self, machine: Machine, flywheel: float = 0.0) -> None:
        if not (is_finite(flywheel) and flywheel >= 0):
            raise bad("flywheel", shown(flywheel), "a finite inertia, zero or more", "correct it")
        self.machine, self.flywheel = machine, float(flywheel)
        self.hasty = any(load.given == "motion" for load in machine.loads)
        self.hasty |= any(spring.damping != 0.0 for spring in machine.springs)
        self._bare = Machine(machine.linkage, machine.masses)

    def coefficients(self, theta: Any) -> tuple[Array, Array]:
        """Return J and J'/2 [kg m^2] at crank angles [rad]."""
        angles = np.asarray(theta, dtype=float)[..., np.newaxis]
        batch = (*angles.shape[:-1], 2)
        # At rest with unit acceleration, and at unit speed without any.
        speed, acceleration = np.array([0.0, 1.0]), np.array([1.0, 0.0])
        evaluation = Evaluation(self._bare, angles, speed, acceleration, batch)
        torque = evaluation.values(("torque",))["torque"]
        return torque[..., 0], torque[..., 1]

    def load(self, theta: Any, speed: Any) -> Array:
        """Return the torque [N m] that weights, loads, springs and dampers require."""
        return self._required(theta, speed, "all")[0]

    def _required(self, theta: Any, speed: Any, *parts: Part) -> list[Array]:
        """Return the torques [N m] that parts of the wrenches require."""
        angles, speeds = np.asarray(theta, dtype=float), np.asarray(speed, dtype=float)
        none = np.zeros(np.broadcast_shapes(angles.shape, speeds.shape))
        if not self.machine.loaded:
            return [none] * len(parts)
        unit = self.machine.linkage.motion(angles)
        motion = self.machine.linkage.motion(angles, speeds) if self.hasty else unit
        return [
            none - power_of(wrenches(self.machine, motion, speeds, part), unit) for part in parts
        ]

    def tables(
        self,
    ) -> tuple[Callable[[float], float], Callable[[float, float], tuple[float, float]]]:
        """Return what an integrator evaluates often.

        The inertia [kg m^2] with the flywheel by the angle; and, by angle and speed, the torques
        [N m] that everything requires, and that loads and dampers require, which no potential
        energy accounts for.  They are Fourier series where the crank turns fully and these are
        short, the inertia nearly vanishes nowhere, and the torque depends on the angle alone.
        """
        inertia: Callable[[float], float] | None = None
        if self.machine.linkage.crank_turns:
            scanned = self.coefficients(self._scan())[0]
            # A series is good to 1e-12 of the largest inertia: below this share it is not used.
            if np.min(scanned) + self.flywheel >= 1e-5 * np.max(scanned):
                inertia = _series(lambda theta: self.coefficients(theta)[0])
        exact = inertia or (lambda theta: float(self.coefficients(theta)[0]))
        return (lambda theta: exact(theta) + self.flywheel), self._torques(inertia is not None)

    def _torques(self, series: bool) -> Callable[[float, float], tuple[float, float]]:
        loads = self.machine.loads
        # A callable may do something new in a later turn.
        lawful = not any(callable(item.force) or callable(item.couple) for item in loads)
        if series and lawful and not self.hasty:
            every = _series(lambda theta: self.load(theta, 0.0))
            given = _series(lambda theta: self._required(theta, 0.0, "nonconservative")[0])
            if every and given:
                return lambda theta, speed: (every(theta), given(theta) if loads else 0.0)
        parts: tuple[Part, ...] = ("all", "nonconservative") if loads or self.hasty else ("all",)

        def torques(theta: float, speed: float) -> tuple[float, float]:
            required = [float(value) for value in self._required(theta, speed, *parts)]
            return required[0], required[1] if len(required) > 1 else 0.0

        return torques

    def acceleration(self, theta: Any, speed: Any, torque: Any) -> Array:
        """Return the crank acceleration [rad/s^2] under a motor torque [N m]."""
        inertia, half_slope = self.coefficients(theta)
        rest = torque - half_slope * np.square(speed) - self.load(theta, speed)
        return np.asarray(rest / (inertia + self.flywheel))

    def energy(self, theta: Any, speed: Any) -> Array:
        """Return kinetic and potential energy [J], that of the flywheel among them."""
        turning = self.flywheel / 2.0 * np.square(speed)
        kinetic = self.machine.kinetic_energy(theta, speed)
        return np.asarray(kinetic + turning + self.machine.potential_energy(theta))

    def range_about(self, theta: float) -> tuple[float, float]:
        """Return the ends of the crank's range [rad] about an angle, infinite where it turns."""
        linkage = self.machine.linkage
        if linkage.crank_turns:
            return -np.inf, np.inf
        for low, high in linkage.crank_ranges():
            turns = TURN * np.floor((theta - low) / TURN)
            # A fold at whole turns is none for the interval.
            if high - low < TURN and low + turns <= theta <= high + turns:
                return float(low + turns), float(high + turns)
        return -np.inf, np.inf

    def require_inertia(self, theta: float) -> None:
        """Raise BadInput where the reduced inertia vanishes in the crank's range about an angle.

        Its least values are sought between the angles of a scan, for a massless crank has its
        zeros at single angles: where the moving links stand still.
        """
        low, high = self.range_about(theta)
        angles = self._scan(low, high)
        inertia = self.coefficients(angles)[0]
        spacing = float(angles[1] - angles[0])
        middle = float(np.median(inertia))
        dips = (inertia <= np.roll(inertia, 1)) & (inertia <= np.roll(inertia, -1))
        # Within half a degree of a zero nearly nothing is left.
        dips &= inertia + self.flywheel <= 0.05 * middle
        # The ends of the range are folds.
        inside = low + 1e-9 * spacing, high - 1e-9 * spacing
        first, last = (np.clip(angles[dips] + side, *inside) for side in (-spacing, spacing))
        at = np.mean(narrowed(lambda tried: -self.coefficients(tried)[0], first, last, 19), axis=0)
        # A reduced inertia below this share of its median gives no usable acceleration.
        zeros = at[~(self.coefficients(at)[0] + self.flywheel > 1e-12 * middle)]
        if zeros.size:
            none = f"none at {zeros[0]:.6g} rad, where the links that have mass stand still"
            fix = "give the crank an inertia, or add a flywheel"
            raise bad("Machine.masses", none, "inertia at every crank angle", fix)

    def _scan(self, low: float = -np.inf, high: float = np.inf) -> Array:
        """Return angles over a turn or a range; they miss its ends, and special positions."""
        if not np.isfinite(high - low):
            low, high = 0.0, TURN
        return low + (high - low) * (np.arange(_SCANNED) + 0.5) / _SCANNED


def _series(function: Callable[[Array], Array]) -> Callable[[float], float] | None:
    """Return a function of the crank angle as its harmonics down to round-off."""
    # None where there are too many.

    def series(theta: float) -> float:
        return float((terms @ np.exp(orders * theta)).real)

    for count in (64, 128, 256, 512, 1024):
        values = np.asarray(function(even_angles(TURN, count)))
        # A series ends in round-off, and meets its function off the samples, or is not used.
        if tail(values) <= 1e-14:
            terms = interpolated(values, TURN).coefficients
            orders = 1j * np.arange(len(terms))
            gap = max(abs(series(at) - float(function(np.array(at)))) for at in _PROBES)
            return series if gap <= 1e-12 * float(np.max(np.abs(values))) else None
    return None
