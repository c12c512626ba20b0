"""Torque fluctuation over a revolution, and the flywheel that keeps the speed even."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from ..core.errors import bad, shown
from ..core.inputs import is_finite
from ..core.maxima import polished, summits
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, DeferredChecks, Result, provenance
from ..core.trigonometric import interpolated
from ..linkages.linkage import EPS, TURN, Array
from .forces import driving_torque
from .machine import Machine, require_machine
from .one_freedom import OneFreedom

_FEWEST, _MOST = 1024, 2**15
# The speeds have settled where they move by no more, relative; the check allows for jitter.
_SETTLED, _UNSETTLED = 16.0 * EPS, 1e-12
# Turns between which a torque must repeat, and angles that no regular pattern meets twice.
_TURNS = np.array([0.0, 1.0, 2.0, 3.0, 7.0])
_SCATTERED = TURN * np.mod(np.sqrt(2.0) * np.arange(1.0, 32.0), 1.0)


@dataclass(frozen=True, kw_only=True)
class TorqueFluctuation(Result):
    """Driving torque over a revolution at constant speed, and the energy that it stores.

    ``error`` is that of the energy fluctuation [J].

    Attributes
    ----------
    theta, torque : ndarray, shape (n,)
        Crank angles of one revolution, the end not repeated [rad], and driving torque [N m].
    speed : float
        Crank speed [rad/s].
    mean_torque : float
        Its mean [N m]; mean power over speed.
    energy : ndarray, shape (n,)
        Integral of torque less mean [J], of zero mean.
    energy_fluctuation : float
        Its greatest less its least value [J].
    slowest, fastest : float
        Crank angles [rad] where a machine under constant torque runs slowest and fastest.
    """

    theta: Array
    torque: Array
    speed: float
    mean_torque: float
    energy: Array
    energy_fluctuation: float
    slowest: float
    fastest: float

    arrays_along: ClassVar = {"theta": "theta torque energy"}
    column_units: ClassVar = {"rad": "slowest fastest", "J": "error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the torque and its mean against the crank angle."""
        ax = axes_or_new(ax)
        degrees = np.degrees(np.append(self.theta, self.theta[0] + TURN))
        ax.plot(degrees, np.append(self.torque, self.torque[0]))
        ax.axhline(self.mean_torque, color="0.5", linestyle="--", label="mean")
        ax.set(xlabel="crank angle [deg]", ylabel="driving torque [N m]")
        ax.legend()
        return ax


def torque_fluctuation(machine: Machine, speed: float) -> TorqueFluctuation:
    """Return how the driving torque varies over a revolution at constant crank speed [rad/s].

    The integral is taken harmonic by harmonic; samples are doubled until the harmonics end in
    round-off.  Where a load jumps they do not, and ``error`` says what is left.  With a flywheel
    the motor need give the mean torque only (Aannaque 3.7).  Refused are a crank that cannot turn
    fully, a speed that is zero or not finite, and a torque that does not repeat after a revolution.
    """
    return _with_tail(machine, speed)[0]


def _with_tail(machine: Machine, speed: float) -> tuple[TorqueFluctuation, float]:
    """Return the torque's fluctuation, and what of its error is not round-off [J]."""
    require_machine(machine)
    machine.linkage.require_full_turn()
    if not (is_finite(speed) and speed * speed):
        raise bad("speed", shown(speed), "a finite crank speed, not zero", "give one in rad/s")
    turns = driving_torque(machine, _SCATTERED + TURN * _TURNS[:, np.newaxis], speed).torque
    if not np.allclose(turns, turns[:1], rtol=1e-6, atol=1e-6 * float(np.max(np.abs(turns)))):
        fix = "check torsion springs and loads that depend on the angle"
        raise bad("machine", "a torque that changes turn by turn", "one that repeats", fix)
    theta, torque, tail = _sampled(machine, speed)
    mean, energy = float(np.mean(torque)), _integral(torque)
    (low, slowest), (high, fastest) = _extreme(-energy), _extreme(energy)
    size = float(np.max(np.abs(torque)))
    found = TorqueFluctuation(
        theta=theta,
        torque=torque,
        speed=float(speed),
        mean_torque=mean,
        energy=energy,
        energy_fluctuation=high + low,
        # Where the machine has taken up most energy beyond the motor's, it is slowest.
        slowest=fastest,
        fastest=slowest,
        method=f"{theta.size} samples, integrated by harmonics",
        error=tail + 32.0 * EPS * size,
        error_norm="energy fluctuation [J]",
        checks=DeferredChecks(partial(_mean_check, machine, speed, mean, size)),
        provenance=provenance(machine.provenance),
    )
    return found, tail


@dataclass(frozen=True, kw_only=True)
class Flywheel(Result):
    """The flywheel that a machine needs, under a constant motor torque.

    ``error`` is that of the inertia [kg m^2].

    Attributes
    ----------
    machine : Machine
        Without the flywheel.
    inertia : float
        Inertia to be added to the crank [kg m^2], the least of those that will do; zero where the
        machine is even enough.
    first_order : float
        The textbook's ``energy fluctuation / (fluctuation speed^2)`` [kg m^2], which leaves out
        what the links themselves store at a varying speed.
    fluctuation : float
        Coefficient of speed fluctuation reached, (greatest - least) / mean of the two.
    motor_torque : float
        The constant torque [N m] that keeps the speed.
    theta, speeds : ndarray, shape (n,)
        Crank angle [rad] and the speed there with the flywheel [rad/s].
    torque : TorqueFluctuation
        At constant speed.
    """

    machine: Machine
    inertia: float
    first_order: float
    fluctuation: float
    motor_torque: float
    theta: Array
    speeds: Array
    torque: TorqueFluctuation

    arrays_along: ClassVar = {"theta": "theta speeds"}
    column_units: ClassVar = {"kg m^2": "error first_order"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the crank speed with the flywheel against the crank angle."""
        ax = axes_or_new(ax)
        ax.plot(np.degrees(self.theta), self.speeds)
        ax.set(xlabel="crank angle [deg]", ylabel="crank speed [rad/s]")
        return ax


def flywheel_inertia(machine: Machine, speed: float, fluctuation: float = 0.02) -> Flywheel:
    """Return the flywheel that holds the crank speed within a coefficient of fluctuation.

    Parameters
    ----------
    machine : Machine
        Linkage, masses, gravity, loads, springs.
    speed : float
        Mean of greatest and least crank speed [rad/s].
    fluctuation : float
        Wanted coefficient, (greatest - least speed) / speed, between 0 and 1.

    Returns
    -------
    Flywheel
        From the balance of energy with the speed as it varies, loads and dampers included.  The
        checks are a revolution of forward dynamics, to what ``error`` admits, and that the speeds
        have settled.

    Raises
    ------
    BadInput
        As :func:`torque_fluctuation`, or if the coefficient is not between 0 and 1.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> wheel = el.flywheel_inertia(machine, speed=10.0, fluctuation=0.02)
    >>> print(round(wheel.inertia, 3), round(wheel.fluctuation, 6))
    0.803 0.02
    """
    if not (is_finite(fluctuation) and 1e-100 < fluctuation < 1):
        raise bad("fluctuation", shown(fluctuation), "a number between 0 and 1", "0.02 is usual")
    steady, tail = _with_tail(machine, speed)
    first_order = steady.energy_fluctuation / (fluctuation * speed**2)
    motion = _motion(machine, steady, fluctuation)
    inertia, speeds = motion.inertia, motion.speeds
    reached = (_extreme(speeds)[0] + _extreme(-speeds)[0]) / abs(speed)
    speeds = np.sign(speed) * speeds
    size = float(np.max(motion.reduced)) * speed**2 + steady.energy_fluctuation
    size += float(np.max(np.abs(steady.torque)))
    # The energies' extremes are known to some last digits: of 300 machines the worst needed 1.7.
    slope = (tail + 8.0 * EPS * size) / (fluctuation * speed**2)
    error = slope + (8.0 * EPS + 8.0 * motion.moved / fluctuation) * inertia
    # The fluctuation goes with the inverse of the whole inertia; it is off by its error's share.
    share = error / (inertia + float(np.mean(motion.reduced)))
    confirmed = (machine, motion, float(speeds[0]), reached, share)
    return Flywheel(
        machine=machine,
        inertia=inertia,
        first_order=first_order,
        fluctuation=reached,
        motor_torque=motion.torque,
        theta=steady.theta,
        speeds=speeds,
        torque=steady,
        method="balance of energy",
        error=error,
        error_norm="inertia [kg m^2]",
        checks=DeferredChecks(partial(_confirmed, *confirmed)),
        provenance=provenance(machine.provenance),
    )


@dataclass(frozen=True)
class _Motion:
    """A revolution under a constant torque: flywheel, and speeds (n,) that it allows."""

    inertia: float
    reduced: Array  # inertia of the links [kg m^2]
    speeds: Array  # sizes
    torque: float
    moved: float  # by how much the speeds still move, relative


def _motion(machine: Machine, steady: TorqueFluctuation, fluctuation: float) -> _Motion:
    """Return the least flywheel that keeps within a coefficient of fluctuation, and the motion."""
    # With S the work stored in the loads, E a constant and I the flywheel, omega^2 = 2 (E + S)/(J +
    # I).  Its greatest value is high^2 where the greatest of 2 (E + S) - (J + I) high^2 is zero,
    # its least low^2 where the least of the same with low is: two linear equations for E and
    # I.  Loads that depend on the speed are taken at the last speeds.
    theta, speed = steady.theta, abs(steady.speed)
    system, sign = OneFreedom(machine), np.sign(steady.speed)
    reduced = system.coefficients(theta)[0]
    high, low = (speed * (1.0 + part * fluctuation / 2.0) for part in (1.0, -1.0))
    speeds: Array = np.full(theta.shape, speed)
    for _ in range(60):
        load = system.load(theta, sign * speeds)
        stored = -_integral(load)
        top = _extreme(2.0 * stored - reduced * high**2)[0]
        bottom = -_extreme(reduced * low**2 - 2.0 * stored)[0]
        inertia = (top - bottom) / (2.0 * fluctuation * speed**2)
        energy = (inertia * high**2 - top) / 2.0
        if inertia <= 0.0:
            inertia, energy = 0.0, _even_energy(reduced, stored, speed)
        changed = np.sqrt(2.0 * (energy + stored) / (reduced + inertia))
        moved = float(np.max(np.abs(changed - speeds))) / speed if system.hasty else 0.0
        speeds = changed
        if moved <= _SETTLED:
            break
    return _Motion(inertia, reduced, speeds, float(np.mean(load)), moved)


def _even_energy(reduced: Array, stored: Array, speed: float) -> float:
    """Return the constant energy with which the links alone keep to the mean speed."""
    from scipy.optimize import brentq

    def excess(energy: float) -> float:
        speeds = np.sqrt(np.maximum(2.0 * (energy + stored) / reduced, 0.0))
        return (_extreme(speeds)[0] - _extreme(-speeds)[0]) / 2.0 - speed

    # At the ends the greatest and the least speed are the mean one.
    ends = reduced * speed**2 / 2.0 - stored
    span = 4.0 * EPS * float(np.max(np.abs(ends)))
    least, most = float(np.min(ends)) - span, float(np.max(ends)) + span
    return float(brentq(excess, least, most, xtol=EPS * most, rtol=4.0 * EPS))


def _sampled(machine: Machine, speed: float) -> tuple[Array, Array, float]:
    """Return angles, torques, and what the harmonics beyond the samples do to the energy [J]."""
    count = _FEWEST
    while True:
        theta = TURN * np.arange(count) / count
        torque = driving_torque(machine, theta, speed).torque
        size = np.abs(np.fft.rfft(torque)) * (2.0 / count)
        top = size[-max(1, size.size // 8) :]
        # The tail of the torque's harmonics is taken as round-off below this share of the largest
        # one.
        if float(np.sum(top)) <= 1e-12 * float(np.max(np.abs(torque))):
            return theta, torque, 0.0
        if count >= _MOST:
            # Folded down, each is added to a lower harmonic k, and divided by k: a sum of 1/k.
            return theta, torque, 4.0 * float(np.max(top)) * (1.0 + float(np.log(count)))
        count *= 2


def _integral(values: Array) -> Array:
    """Return the integral of evenly many samples over a turn less their mean, of zero mean."""
    harmonics = np.fft.rfft(values)
    harmonics[1:] /= 1j * np.arange(1.0, harmonics.size)
    harmonics[[0, -1]] = 0.0  # the highest one has no sine among the samples
    return np.fft.irfft(harmonics, n=values.size)


def _extreme(values: Array) -> tuple[float, float]:
    """Return the greatest value of a periodic function between its samples, and its angle."""
    # By Newton's method on the trigonometric interpolant, from every sample that may be beside it.
    tops = summits(values)
    series = interpolated(values, TURN).coefficients
    waves, step = 1j * np.arange(series.size), TURN / values.size
    at = start = tops * step
    for _ in range(6):
        terms = np.exp(np.multiply.outer(at, waves)) * series
        slope, bend = (terms @ waves).real, (terms @ waves**2).real
        moved = at - slope / np.where(bend < 0.0, bend, -np.inf)
        at = np.clip(moved, start - step, start + step)
    reached = np.maximum((np.exp(np.multiply.outer(at, waves)) @ series).real, values[tops])
    best = int(np.argmax(reached))
    return float(reached[best]), float(at[best] % TURN)


def _mean_check(machine: Machine, speed: float, mean: float, size: float) -> dict[str, Check]:
    """Take the mean again from the work of loads and dampers over the revolution."""
    theta = TURN * np.arange(_MOST // 8) / (_MOST // 8)
    work = -float(np.mean(machine.power(theta, np.full(theta.shape, speed)))) / speed
    gap = abs(mean - work) / (size or 1.0)
    return {"mean torque against the loads' work, relative": Check(gap, 1e-3)}


def _confirmed(
    machine: Machine, motion: _Motion, start: float, reached: float, share: float
) -> dict[str, Check]:
    from .motor_run import run_up

    fine: dict[str, Any] = {"tolerance": 1e-11, "samples": 4001}
    torque, inertia = motion.torque, motion.inertia
    run = run_up(machine, torque, revolutions=1.0, speed0=start, flywheel=inertia, **fine)
    speeds = np.abs(run.speed)
    high, low = _summit(speeds), -_summit(-speeds)
    gap = abs((high - low) / ((high + low) / 2.0) - reached) / max(reached, 1e-12)
    # Forward dynamics confirm the coefficient of fluctuation to this share of it.
    return {
        "fluctuation by forward dynamics, relative": Check(float(gap), 1e-5 + share),
        "speeds not settled, relative": Check(motion.moved, _UNSETTLED),
    }


def _summit(values: Array) -> float:
    """Return the greatest value of a motion between its even samples."""
    place = int(np.clip(np.argmax(values), 2, values.size - 3))
    height = float(polished(values[place - 2 : place + 3])[1])
    return max(height, float(np.max(values)))
