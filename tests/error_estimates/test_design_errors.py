"""Error estimates of the design tools over random bars that rock: stresses, quiet speeds, fatigue.

The reference solves the full equations of the same elements speed by speed, by dense Fourier
collocation of the second-order form (``beam_motions``), and looks for the largest stress at 4096
angles; it shares no mode, no node in the speed and no rational function with the curves.  Fatigue
is compared with a rainflow count of its own, on the stresses of many elements.
"""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from beam_motions import FIRST, of_history, peaks, periodic_motion, rocking_bar, turning_bar
from elastolink.runtime.core.trigonometric import differentiated, interpolated, resampled
from elastolink.runtime.design import sensitivities
from elastolink.runtime.design.procedure import effect_of
from elastolink.runtime.periodic.periodic_motion import quiet_state
from honesty import over_scenes

# Angles of the reference's motion, and those at which its stresses are looked at.
COUNT, FINE = 64, 4096
STATIONS = 7
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
# The reference has round-off of its own.
FLOOR = 1e-13


def rocker(rng):
    """Return a bar driven by a pin of a crank in its slot, with the frame's length to vary."""
    crank, frame = 0.1, float(rng.uniform(0.25, 0.8))
    pinned = bool(rng.integers(2))
    loss = 10.0 ** rng.uniform(-2.0, -0.7) * FIRST[pinned]

    def made(geometry):
        length = geometry["frame"]

        def angle(theta):
            # The pin at L + r exp(i theta): its angle is Im log, with two derivatives.
            z, turn = length + crank * np.exp(1j * theta), crank * np.exp(1j * theta)
            slope = 1j * turn / z
            return np.angle(z), slope.imag, (-turn / z - slope**2).imag

        bar = turning_bar(angle, pinned=pinned, drag=loss, elements=1)
        return replace(bar, geometry=dict(geometry), rebuild=made)

    return made({"frame": frame}), frame, FIRST[pinned]


def random_speeds(rng, first, count):
    """Return increasing speeds, some of them at fractions of the first frequency."""
    low = rng.uniform(0.1, 0.3)
    speeds = first * rng.uniform(low, low + rng.uniform(0.02, 0.3), count)
    if rng.integers(2):
        speeds[0] = first / int(rng.integers(2, 6)) * rng.uniform(0.99, 1.01)
    return np.sort(speeds)


def exact_maximum(system, speed, method="equilibrium"):
    """Return the largest stress of a bar at one speed by dense collocation."""
    found = el.stress(
        system, periodic_motion(system, speed, COUNT), stations=STATIONS, method=method
    )
    return max(np.max(peaks(found.fibre(name), FINE)) for name in ("positive", "negative"))


@over_scenes(7200, few=2, many=20, floor=FLOOR)
def test_quiet_speeds(rng):
    """Each with ten stresses."""
    system, first = rocking_bar(rng)
    speeds = random_speeds(rng, first, 10)
    found = el.quiet_speeds(system, speeds, 1e8, rtol=10.0 ** rng.uniform(-5, -2.5))
    exact = np.array([exact_maximum(system, speed) / 1e8 for speed in speeds])
    return found.error, found.worst / exact - 1.0


@over_scenes(7250, few=1, many=10, floor=FLOOR)
def test_running_and_quiet_speeds(rng):
    """The error of the result, and of the quiet speeds that it holds."""
    system, frame, first = rocker(rng)
    speeds = random_speeds(rng, first, 3)
    exact = np.array([exact_maximum(system, speed) for speed in speeds])
    limit = float(np.max(exact)) * rng.uniform(1.1, 3.0)
    found = el.running_speed(
        system, speeds, limit, values=[frame], rtol=10.0 ** rng.uniform(-5, -2.5)
    )
    place = int(np.argmin(np.abs(speeds - found.speed)))
    assert speeds[place] == found.speed
    assert found.checks["within limits"].value >= exact[place] / limit * (1.0 - 1e-13)
    actual = np.abs(found.quiet.worst * limit / exact - 1.0)
    return {"running": (found.error, np.max(actual)), "quiet": (found.quiet.error, actual)}


@over_scenes(7200, few=2, many=20, floor=FLOOR)
def test_damping_effects(rng):
    bare, first = rocking_bar(rng, drag=False)
    system = el.with_modal_damping(bare, 0.02)
    speeds, values = random_speeds(rng, first, 5), np.sort(10.0 ** rng.uniform(-3, -0.7, 2))
    rtol = 10.0 ** rng.uniform(-5, -2.5)
    found = effect_of(system, "damping_ratio", values, speeds, rtol)
    exact = [
        [exact_maximum(system.with_parameters(damping_ratio=value), w) for w in speeds]
        for value in values
    ]
    return found.error[..., 0], found.maximum[..., 0] / exact - 1.0


@over_scenes(7200, few=1, many=12, floor=FLOOR)
def test_length_effects(rng):
    system, frame, first = rocker(rng)
    speeds = random_speeds(rng, first, 5)
    values = np.array([frame, frame * rng.uniform(0.7, 1.5)])
    found = effect_of(system, "frame", values, speeds, 10.0 ** rng.uniform(-5, -2.5))
    exact = [
        [exact_maximum(system.with_geometry(frame=value), w) for w in speeds] for value in values
    ]
    return found.error[..., 0], found.maximum[..., 0] / exact - 1.0


@over_scenes(7290, few=2, many=40, median=1e3)
def test_derivatives_of_largest_stresses(rng):
    """By differences of the reference at the angle of the peak, of three counts and steps.

    Four times what they differ by tells how well they are known: of sharp resonances to 1e-7, of
    others to 1e-11.
    """
    system, frame, first = rocker(rng)
    speed = float(random_speeds(rng, first, 1)[0])
    answer = el.stress(system, speed, stations=STATIONS)
    found = sensitivities(system, answer, ["speed", "frame"])
    peak = answer.maximum
    weights = {1: 5 / 6, 2: -5 / 21, 3: 5 / 84, 4: -5 / 504, 5: 1 / 1260}

    def stress(angle, count, pace, length, order=0):
        """Return it, or a derivative by the angle, at a speed and a length over the own ones."""
        other = system.with_geometry(frame=length * frame)
        motion = periodic_motion(other, pace * speed, count)
        history = el.stress(other, motion, stations={"bar": [peak.place]}).fibre(peak.fibre)
        for _ in range(order):
            history = differentiated(history, other.period)
        return interpolated(history, other.period)(angle)[:, 0]

    angle = np.array([peak.theta])
    for _ in range(3):
        angle -= stress(angle, COUNT, 1.0, 1.0, 1) / stress(angle, COUNT, 1.0, 1.0, 2)
    exact = np.zeros((3, 2))
    counts = COUNT, 3 * COUNT // 2, 5 * COUNT // 4
    for row, (count, step) in enumerate(zip(counts, (2e-4, 4e-4, 3e-4), strict=True)):
        for j, weight in weights.items():
            for side in (j * step, -j * step):
                moved = [stress(angle, count, *one)[0] for one in ((1 + side, 1), (1, 1 + side))]
                exact[row] += np.sign(side) * weight / step * np.array(moved)
    size = np.max(np.abs(exact))
    error = (found.error[0] * found.number + 4.0 * np.ptp(exact, axis=0)) / size
    return error, (found.derivative[0] * found.number - exact[0]) / size


def counted(history):
    """Return ranges and means of the closed cycles of a periodic history, by four points."""
    start = int(np.argmax(history))
    turned = np.append(np.roll(history, -start), history[start])
    rises = np.diff(turned)
    corner = np.append(np.append(True, rises[:-1] * rises[1:] < 0), True)
    stack, cycles = [], []
    for value in turned[corner]:
        stack.append(value)
        # An inner pair that its neighbours enclose is a cycle.
        while len(stack) >= 4:
            a, b, c, d = stack[-4:]
            if not (min(a, d) <= min(b, c) and max(b, c) <= max(a, d)):
                break
            cycles.append((abs(c - b), (b + c) / 2))
            del stack[-3:-1]
    assert len(stack) == 3
    cycles.append((stack[0] - stack[1], (stack[0] + stack[1]) / 2))
    return np.array(cycles).T


def least_safety(histories, material):
    """Return the endurance limit over the largest amplitude of Goodman's line."""
    worst = 0.0
    for history in histories.T:
        size, mean = counted(history)
        amplitude = size / 2 / (1 - np.maximum(mean, 0.0) / material.tensile_strength)
        worst = max(worst, float(np.max(amplitude)))
    return material.endurance_limit / worst


def waves(rng, harmonics, places):
    """Return a random series as a function of the angle, ``(nt, places)``, largest about 1."""
    parts = rng.standard_normal((2, harmonics + 1, places)) * rng.uniform(0.4, 0.9) ** np.arange(
        harmonics + 1
    ).reshape(-1, 1)
    parts /= np.sum(np.abs(parts), axis=(0, 1)).max()

    def function(theta):
        angle = np.multiply.outer(theta, np.arange(harmonics + 1))
        return np.cos(angle) @ parts[0] + np.sin(angle) @ parts[1]

    return function


@over_scenes(7400, few=3, floor=FLOOR)
def test_safeties_of_histories(rng):
    """Histories off by no more than their error estimate."""
    places = int(rng.integers(1, 4))
    exact, off = waves(rng, int(rng.integers(1, 9)), places), waves(rng, 6, places)
    size, doubt = 10.0 ** rng.uniform(6, 8.3), 10.0 ** rng.uniform(-6, -1.5)
    fine = 2 * np.pi * np.arange(FINE) / FINE
    push = doubt / np.max(np.abs(off(fine)))
    theta = 2 * np.pi * np.arange(64) / 64
    given = of_history(size * (exact(theta) + push * off(theta)), size * doubt)
    material = el.Material(tensile_strength=6e8, endurance_limit=2e8)
    found = el.fatigue(given, material)
    truth = least_safety(size * exact(fine), material)
    return found.error, np.min(found.safety) / truth - 1.0


@over_scenes(7300, few=3, many=30, floor=FLOOR)
def test_safeties_of_bars(rng):
    """Stresses of one element, against those of many."""
    system, first = rocking_bar(rng)
    speed = first * rng.uniform(0.03, 0.4)
    material = el.Material(tensile_strength=1e12, endurance_limit=2e8)
    found = el.fatigue(el.stress(system, quiet_state(system, speed, 1e-7), stations=3), material)

    def meshed(structure):
        return replace(structure, beams=tuple(replace(b, elements=4) for b in structure.beams))

    motion = periodic_motion(system.remesh(meshed), speed, 32)
    fine = el.stress(system.remesh(meshed), motion, stations=3)
    values = np.hstack([resampled(fine.fibre(name), FINE) for name in ("positive", "negative")])
    return found.error, np.min(found.safety) / least_safety(values, material) - 1.0


def test_cycles_are_counted_as_they_are():
    """Peaks 300, valley 100, peak 200, valley -300: one cycle of 600, one of 100 within."""
    size, mean = counted(np.array([300.0, 100.0, 200.0, -300.0]))
    assert sorted(zip(size, mean, strict=True)) == [(100.0, 150.0), (600.0, 0.0)]
