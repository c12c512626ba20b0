"""Error estimates of response curves: motions, multipliers, special points and peaks.

The reference are the same motions on twice the steps, and on more where these do not agree; that
twice the steps suffice is told by DOP853 (tests/runtime/nonlinear/test_known_answers.py).
"""

from __future__ import annotations

from dataclasses import replace

import elastolink as el
import numpy as np
from elastolink.runtime.nonlinear import sweep_response
from elastolink.runtime.nonlinear.branch import TESTS
from elastolink.runtime.nonlinear.orbit import STAGES, changed
from elastolink.runtime.nonlinear.response import extremes
from honesty import over_scenes
from oscillators import extremes as marched_extremes
from oscillators import marched, shot
from random_systems import curve_of, random_oscillators, random_rig

# Below these the reference is not known: rounding of the state, and of its matrix.
FLOOR = 5e-15
WATCHED = 6  # motions of a curve


def finer(solver, orbit):
    """Return the motion opposite to one on the branch, on twice the steps."""
    motion = orbit.motion.resampled(2 * len(orbit.motion.x), STAGES)
    exact, _ = solver.corrected(orbit.value, motion, orbit.tangent)
    for _ in range(8):
        # The tangent on other steps is not the same to the last digit: some times, then.
        along = orbit.tangent.dot(difference(orbit, exact))
        if abs(along) <= FLOOR:
            break
        exact, _ = solver.corrected(*changed(exact, exact.tangent, -along), exact.tangent)
    return exact


def difference(orbit, exact):
    """Return what leads from a motion to the exact one, where its steps meet."""
    states = exact.motion.states[::2] - orbit.motion.states
    return replace(orbit.tangent, states=states, value=exact.value - orbit.value)


def distance(solver, orbit, exact) -> float:
    """Return how far a motion is from the exact one, as its error estimate counts."""
    change = difference(orbit, exact)
    away = float(np.max(np.abs(change.states) / solver.scale(orbit.motion)))
    return max(away, abs(change.value) / solver.span)


def matched(values, exact):
    """Return the distances of values from the nearest exact ones, each taken once."""
    left, found = list(exact), []
    for value in values:
        nearest = min(left, key=lambda other, value=value: abs(other - value))
        left.remove(nearest)
        found.append(abs(value - nearest))
    return found


def special_value(solver, kind, orbit) -> float:
    """Return the parameter at a special point on more steps, by the secant rule."""
    exact = finer(solver, orbit)
    test, step = TESTS[kind], 1e-4
    for _ in range(3):
        beside, _ = solver.corrected(*changed(exact, exact.tangent, step), exact.tangent)
        slope = (test(beside) - test(exact)) / step
        length = float(np.clip(-test(exact) / slope, -1e-3, 1e-3))
        exact, _ = solver.corrected(*changed(exact, exact.tangent, length), exact.tangent)
    return exact.value


def ratios(rng, curve):
    """Return estimates and errors of some motions of a curve, by what is estimated."""
    solver, found = curve.source, {}
    chosen = rng.choice(len(curve.orbits), min(WATCHED, len(curve.orbits)), replace=False)

    def add(name, estimates, errors, floor=FLOOR):
        pair = found.setdefault(name, ([], []))
        pair[0].extend(np.ravel(estimates).tolist())
        pair[1].extend(np.maximum(np.ravel(errors), floor).tolist())

    for i in chosen.tolist():
        orbit = curve.orbits[i]
        exact = finer(solver, orbit)
        add("motions", curve.error[i], distance(solver, orbit, exact))
        size = float(np.linalg.norm(exact.matrix))
        gaps = matched(orbit.multipliers, exact.multipliers)
        add("multipliers", curve.multiplier_error[i], gaps, FLOOR * max(size, 1.0))
        low, high = extremes(solver.problem, exact)
        off = [abs(curve.lowest[i] - low), abs(curve.highest[i] - high)]
        if max(abs(low), abs(high)) > 1e-6:
            add("peaks", [curve.peak_error[i]] * 2, off, 4 * FLOOR * max(abs(low), abs(high)))
    return found


def special_ratios(curve):
    """Return estimates and errors of all special points of a curve."""
    rows = zip(curve.special, curve.special_orbits, curve.special_error, strict=True)
    pairs = []
    for kind, orbit, error in rows:
        value = special_value(curve.source, kind, orbit)
        pairs.append((error, max(abs(value - orbit.value), FLOOR * abs(value))))
    return list(zip(*pairs, strict=True))


@over_scenes(181, few=2, many=14)
def test_estimates_of_rigs_hold_and_are_not_idle(rng):
    drawn = random_rig(rng)
    curve = drawn and curve_of(rng, drawn, turns=int(rng.choice([1, 2])))
    return curve and ratios(rng, curve)


@over_scenes(182, few=4, many=30)
def test_estimates_of_oscillators_hold_and_are_not_idle(rng):
    curve = curve_of(rng, random_oscillators(rng), turns=2)
    return curve and ratios(rng, curve)


@over_scenes(183, few=3, many=20)
def test_estimates_of_special_points_hold_and_are_not_idle(rng):
    curve = curve_of(rng, random_oscillators(rng), turns=2)
    return special_ratios(curve) if curve and curve.special else None


@over_scenes(9184, few=2, many=12, floor=1e-13)
def test_estimates_of_sweeps_hold_and_are_not_idle(rng):
    system, (low, high) = random_oscillators(rng)
    speed, n = rng.uniform(low, high) / rng.choice([1.0, 3.0]), system.size
    rise = speed**2 * rng.uniform(1e-5, 1e-3)
    reached = np.sqrt(speed**2 + 4.0 * np.pi * rise * 1.5)  # after one revolution and a half
    try:
        found = sweep_response(system, (speed, reached), rise, "up", kicks=0.0, rtol=1e-5)
    except el.BadInput:
        return None
    # The motion that it begins with is the one near rest, where DOP853 finds it from there.
    try:
        state, multipliers = shot(system, speed, np.zeros(2 * n))
    except ArithmeticError:
        return None
    if max(abs(multipliers)) > 0.99 or len(found.speed) != 1:
        return None
    path = marched(system, speed, state, 1, samples=2048, rise=rise)
    exact = marched_extremes(path, 1)  # the deflection is the first coordinate
    off = np.abs([found.lowest[0] - exact[0], found.highest[0] - exact[1]])
    size = np.max(np.abs(path[:, :n]))
    reference = 1e-11 * size + 1e-13  # what is wrong with it
    return [found.error[0] * size + reference] * 2, off
