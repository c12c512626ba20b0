"""Periodic motions of Smith's rigs: shooting by another author, the constrained form, energy."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from bent_rigs import REFERENCE, RPM, Shape, motions_at, natural_frequency, rig, smallest_motion
from constrained_coupler import turning, with_constraints
from elastolink.runtime.constrained import orbit_multipliers, periodic_orbit
from elastolink.runtime.core.families.nonlinear import Drive
from elastolink.runtime.nonlinear import response_curve
from elastolink.runtime.nonlinear.response import extremes
from elastolink.runtime.systems import inextensible
from more_modes import RIGS, found, with_more
from oscillators import shot_special

# To what the reference is known: special points, relative; multipliers by the number of modes, for
# the control of steps looks at the motion, not at its derivatives.
KNOWN = 1e-11
KNOWN_MULTIPLIERS = {1: 1e-9, 2: 1e-8, 3: 1e-6}


@dataclass(frozen=True)
class Case:
    """A range of the speed of a rig [rpm], and how far the reference is known within."""

    rig: str
    modes: int
    low: float
    high: float
    turns: int = 1
    largest: float = np.inf  # peak to peak of what the range's own branch reaches

    @property
    def special(self):
        return [
            row
            for row in REFERENCE["special"]
            if row[:2] == [self.rig, self.modes]
            and self.low < row[4] < self.high
            and row[2] <= self.turns
        ]

    @property
    def motions(self):
        return [
            motion
            for motion in REFERENCE["motions"]
            if (motion["rig"], motion["modes"]) == (self.rig, self.modes)
            and self.low < motion["speed"] < self.high
            and motion["turns"] <= self.turns
            and motion["peak_to_peak"] <= self.largest
        ]

    def __str__(self) -> str:
        return f"{self.rig}, {self.modes} modes, {self.low:g} to {self.high:g} rpm"


HALF, WINDOW = Case("A58", 1, 352, 358), Case("A58", 1, 440, 490, turns=2, largest=0.1)
LONG = (
    Case("A58", 1, 300, 530, turns=2),
    Case("A58", 2, 345, 365),
    Case("A58", 2, 440, 490, turns=2),
    Case("A58", 3, 350, 360),
    Case("A79", 1, 330, 500, turns=2),
    Case("A79", 2, 336, 352),
    Case("B58", 1, 650, 700, largest=0.1),
    Case("B58", 2, 600, 700),
)


@pytest.mark.parametrize(
    "case",
    [HALF, WINDOW, *(pytest.param(case, marks=pytest.mark.slow) for case in LONG)],
    ids=str,
)
def test_it_is_what_shooting_finds(case):
    """Folds and doublings to 1e-9, motions and multipliers to their errors, extremes to 1e-8."""
    system = rig(case.rig, case.modes)
    bounds = case.low * RPM, case.high * RPM
    curve = response_curve(system, "speed", bounds, turns=case.turns)
    assert case.special and curve.passed
    found = [
        (orbit.motion.turns, kind, value / RPM, error / RPM, high - low)
        for orbit, kind, value, error, low, high in zip(
            curve.special_orbits,
            curve.special,
            curve.special_value,
            curve.special_error,
            curve.special_lowest,
            curve.special_highest,
            strict=True,
        )
    ]
    for _, _, turns, kind, speed, span in case.special:
        near = [row for row in found if row[:2] == (turns, kind) and abs(row[2] - speed) < 1e-3]
        assert len(near) == 1, (kind, speed)
        _, _, value, error, peak_to_peak = near[0]
        assert abs(value - speed) <= error + KNOWN * speed
        assert value == pytest.approx(speed, rel=1e-9)
        assert peak_to_peak == pytest.approx(span, rel=1e-8)
    for motion in case.motions:
        assert_known(motion, curve)
    if case in (HALF, WINDOW):
        assert len(found) == len(case.special)


def assert_known(known, curve) -> None:
    """Assert that a motion of the reference is one of a curve's, with multipliers and extremes."""
    system = curve.source.problem.system
    n, speed = system.size, known["speed"] * RPM
    candidates = motions_at(curve, speed, known["turns"])
    state = [*known["q"], *np.array(known["rates"]) * natural_frequency(system.parameters) / speed]
    away = []
    for orbit, measure in candidates:
        scale = curve.source.scale(orbit.motion)
        for turn in range(known["turns"]):
            x, v, _ = orbit.motion.at(2 * np.pi * turn)
            difference = (np.concatenate([x[0], v[0]]) - state) / scale
            away.append((float(np.max(np.abs(difference))), orbit, measure))
    distance, orbit, measure = min(away, key=lambda row: row[0])
    assert distance <= measure.error + 1e-10, known
    expected = [complex(*pair) for pair in known["multipliers"]]
    for value, error in zip(orbit.multipliers, measure.multiplier_errors, strict=True):
        nearest = min(expected, key=lambda other, value=value: abs(other - value))
        expected.remove(nearest)
        assert abs(value - nearest) <= error + KNOWN_MULTIPLIERS[n]
    low, high = extremes(curve.source.problem, orbit)
    assert high - low == pytest.approx(known["peak_to_peak"], rel=1e-7)


@pytest.mark.slow
def test_the_first_fold_of_the_rig_without_a_reference_is_that_of_dop853():
    rig = replace(RIGS["C"], ranges=((490, 510, 1),))
    (point,) = found(rig, 1)
    guess = 1.0001 * point.speed * RPM, 1.001 * point.orbit.motion.states[0]
    speed, _ = shot_special(rig.system(1), "fold", *guess, rtol=1e-10)
    assert abs(speed / RPM - point.speed) <= point.error + 1e-11 * point.speed


# ---------------------------------------------------------------- modes and stations


@pytest.mark.slow
def test_folds_are_settled_with_five_modes(monkeypatch):
    """To 1e-6 in the speed and 1e-4 in the deflection; on twice the stations to 1e-10."""
    rig = replace(RIGS["A"], ranges=((350, 360, 1),))
    for point in found(rig, 3):
        four, five, *_, seven = with_more(rig, point, 7)
        assert any(abs(four.speed - other.speed) <= 1e-8 for other in found(rig, 4))
        assert five.speed == pytest.approx(seven.speed, rel=1e-6)
        assert five.size == pytest.approx(seven.size, rel=1e-4)
        with monkeypatch.context() as patch:
            patch.setattr(inextensible, "_LEAST", 16)
            patch.setattr(inextensible, "_PER_MODE", 8)
            inextensible.coupler_stations.cache_clear()
            (dense,) = with_more(replace(rig, title="more stations"), point, 4)
        inextensible.coupler_stations.cache_clear()
        assert dense.speed == pytest.approx(four.speed, rel=1e-10)


# ---------------------------------------------------------------- energy


def test_the_cranks_power_balances_along_a_motion():
    """At every Gauss point, and over the period what the crank does is what damping takes."""
    system, speed = rig("B58", 2), 640.0 * RPM
    (orbit, _), _ = smallest_motion(system, speed)
    motion, numbers = orbit.motion, system.parameters
    theta = motion.angles.ravel()
    (x, v), a = motion.stages(), motion.a
    q, qd, qdd = (part.reshape(-1, 2) * speed**k for k, part in enumerate((x, v, a)))
    drive = Drive(theta, np.full_like(theta, speed), np.zeros_like(theta))
    made = with_constraints(system)
    whole = made.whole(q, drive, numbers)
    shape = Shape.of(numbers, whole, q, qd, qdd, *drive)
    density, length = numbers["mass_per_length"], numbers["coupler"]
    constrained = made.make(numbers, drive)
    rates = np.stack([shape.driven[1], shape.turn[1]], axis=-1)
    _, force = constrained.accelerations(whole, np.concatenate([rates, qd], axis=-1), theta / speed)
    pull = force[:, 0] + 1j * force[:, 1]
    _, speeds, bends = shape.places
    power = (np.conj(density * shape.integral(bends) - pull) * shape.pin[1]).real
    wave = np.pi * np.arange(1, 3)
    drag = numbers["damping"] * length**3 / 2 * np.sum((qd / wave) ** 2, axis=-1)
    kinetic = density * shape.integral((np.conj(bends) * speeds).real)
    kinetic += numbers["follower_inertia"] * shape.driven[1] * shape.driven[2]
    strain = numbers["bending_stiffness"] / length / 2 * np.sum(wave**2 * q * qd, axis=-1)
    size = np.max(np.abs([power, kinetic, strain]))
    assert np.max(np.abs(power - kinetic - strain - drag)) <= 1e-12 * size
    weights = np.tile(motion.points.b, len(motion.x)) * motion.step / speed
    assert np.sum(weights * power) == pytest.approx(np.sum(weights * drag), rel=1e-9)
    assert np.sum(weights * drag) > 0.0


# ---------------------------------------------------------------- a second route


@pytest.mark.parametrize(
    ("name", "modes", "speed"),
    [("A58", 1, 470.0), pytest.param("B58", 3, 655.0, marks=pytest.mark.slow)],
)
def test_the_constrained_form_gives_the_same_motion_and_multipliers(name, modes, speed):
    """All coordinates with the loop's constraints, by their own collocation and shooting."""
    system, speed = rig(name, modes), speed * RPM
    (orbit, measure), solver = smallest_motion(system, speed)
    numbers = system.parameters

    class Turning:
        """The crank angle or a rate of it, as a function of time."""

        def __init__(self, order: int) -> None:
            self.order = order

        def __call__(self, q, time):
            return (speed * np.asarray(time), speed, 0.0)[self.order] + 0.0 * np.asarray(time)

    names = system.equations.module.EXTERNAL
    external = {name: Turning(order) for order, name in enumerate(names)}
    constrained = turning(system, numbers, external)
    x, v, _ = orbit.motion.at(0.0)
    drive = Drive(0.0, speed)
    whole = with_constraints(system).whole(x[0], drive, numbers)
    shape = Shape.of(numbers, whole, x[0], speed * v[0], 0 * x[0], *map(np.asarray, drive))
    rates = np.array([shape.driven[1], shape.turn[1], *(speed * v[0])])
    period = 2 * np.pi / speed
    motion = periodic_orbit(constrained, period, whole, rates, rtol=1e-11)
    where = orbit.motion.step * np.arange(len(orbit.motion.x))
    away = motion.at(where / speed)[0][:, 2:] - orbit.motion.x
    scale = solver.scale(orbit.motion)[0]
    assert np.max(np.abs(away)) <= (measure.error + 1e-10) * scale
    theta = np.linspace(0.0, 2 * np.pi, 4001)[:-1]
    shown = system.shown(motion.at(theta / speed)[0][:, 2:])
    tops = np.array(extremes(solver.problem, orbit))
    # A top between two of 4000 angles is missed by 1e-6 of the swing.
    assert tops == pytest.approx([np.min(shown), np.max(shown)], abs=3e-6 * np.ptp(shown))
    result = orbit_multipliers(motion)
    expected = list(result.physical)
    assert len(expected) == len(orbit.multipliers)
    for value, error in zip(orbit.multipliers, measure.multiplier_errors, strict=True):
        nearest = min(expected, key=lambda other, value=value: abs(other - value))
        expected.remove(nearest)
        assert abs(value - nearest) <= error + np.max(result.error) + 1e-9
