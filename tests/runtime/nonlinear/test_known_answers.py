"""Response curves of problems with known answers, each by a route that shares no solver with them.

The references are closed forms, or motions shot by DOP853 (rtol 3e-14, derivatives by differences;
tests/convergence/oscillators.py): known to 1e-12 in the speed and in the extremes, where nothing
else is said.  What is allowed is that and the error estimate that the curve tells.
"""

from __future__ import annotations

from itertools import pairwise

import elastolink as el
import numpy as np
import pytest
from driven_rod import driven_rod
from elastolink.runtime.core.families import Drive, Nonlinear, Varied
from elastolink.runtime.nonlinear.branch import special_points
from elastolink.runtime.nonlinear.orbit import STAGES, Solver
from elastolink.runtime.nonlinear.response import extremes as extremes_of
from elastolink.runtime.nonlinear.response import tops
from elastolink.runtime.nonlinear.segments import Motion, Problem
from elastolink.runtime.systems import free_free_rod
from elastolink.runtime.systems.rod import FreeFreeBasis, rod_system
from free_free_loads import ROD
from orders import slope
from oscillators import extremes, marched, oscillators, shot, shot_special, shot_where
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, j1, mathieu_a, mathieu_b

KNOWN = 1e-12  # of a shot motion
HARD, SOFT = 1.0, -0.08


def special(curve, kind):
    """Return values, errors and motions of the special points of a kind."""
    at = [i for i, found in enumerate(curve.special) if found == kind]
    return curve.special_value[at], curve.special_error[at], [curve.special_orbits[i] for i in at]


def assert_shot(system, curve, numbers):
    """Compare motions of a curve with shot ones: state, multipliers, extremes, stability."""
    for i in numbers:
        speed, turns, motion = curve.value[i], int(curve.turns[i]), curve.orbits[i].motion
        state, multipliers = shot(system, speed, 1.001 * motion.states[0], turns)
        size = np.max(np.abs(motion.states))
        gap = np.max(np.abs(motion.states[0] - state))
        amplified = 1.0 / np.min(np.abs(multipliers - 1.0))  # of what marching leaves of a period
        assert gap <= size * (curve.error[i] + KNOWN * amplified)
        apart = np.abs(np.sort_complex(multipliers) - np.sort_complex(curve.multipliers[i]))
        known = KNOWN * max(1.0, np.max(np.abs(multipliers)), amplified)
        assert np.max(apart) <= np.max(curve.multiplier_error[i]) + known
        assert curve.stable[i] == (np.max(np.abs(multipliers)) <= 1.0 + known)
        low, high = extremes(marched(system, speed, state, turns, samples=2048), turns)
        allowed = curve.peak_error[i] + size * KNOWN * amplified
        assert abs(curve.lowest[i] - low) <= allowed
        assert abs(curve.highest[i] - high) <= allowed


# ---------------------------------------------------------------- Duffing's equation

DUFFING = {  # cubic, force, range
    "hardening": (HARD, 0.1, (0.9, 1.5)),
    "softening": (SOFT, 0.15, (0.75, 1.1)),
}


@pytest.fixture(
    scope="module", params=["hardening", pytest.param("softening", marks=pytest.mark.slow)]
)
def duffing(request):
    cubic, force, bounds = DUFFING[request.param]
    system = oscillators(damping=0.04, cubic=cubic, force=force)
    return system, el.response_curve(system, "speed", bounds)


def test_folds_of_duffings_equation(duffing):
    system, curve = duffing
    assert curve.special == ("fold", "fold")
    shown = np.stack([curve.special_lowest, curve.special_highest], axis=1)
    rows = zip(curve.special_value, curve.special_error, curve.special_orbits, shown, strict=True)
    for value, error, orbit, both in rows:
        exact, state = shot_special(system, "fold", 1.001 * value, 1.01 * orbit.motion.states[0])
        assert abs(value - exact) <= error + KNOWN
        # Along the branch a fold is known to 1e-9 only, where its speed no longer changes.
        off = extremes(marched(system, exact, state, 1, samples=2048), 1) - both
        assert np.max(np.abs(off)) <= 1e-9


def test_motions_of_duffings_equation(duffing):
    system, curve = duffing
    unstable = np.flatnonzero(~curve.stable)
    chosen = {
        len(curve.value) // 8,
        int(np.argmax(curve.highest)),
        int(unstable[len(unstable) // 2]),
    }
    assert_shot(system, curve, chosen)
    # Multipliers multiply to exp(-4 pi damping / speed).
    product = np.prod(curve.multipliers, axis=1)
    sizes = np.max(np.abs(curve.multipliers), axis=1)
    exact = np.exp(-4.0 * np.pi * system.parameters["damping"] / curve.value)
    assert np.all(np.abs(product - exact) <= 2.0 * np.sum(curve.multiplier_error, axis=1) * sizes)


def backbone(amplitude: float, cubic: float) -> float:
    """Return the frequency of ``q'' + q + cubic q^3 = 0``, by the complete elliptic integral."""
    square = 1.0 + cubic * amplitude**2
    return np.pi / 2.0 * np.sqrt(square) / ellipk(cubic * amplitude**2 / (2.0 * square))


@pytest.mark.parametrize(
    ("cubic", "force", "bounds"),
    [(SOFT, 0.06, (0.87, 1.02)), (HARD, 0.05, (0.9, 1.4))],
)
@pytest.mark.slow
def test_the_backbone_is_approached(cubic, force, bounds):
    """Damping and force halved, the fold at the top nears the free motion by a quarter."""
    away = []
    for part in (0.5, 0.25, 0.125):
        system = oscillators(damping=0.02 * part, cubic=cubic, force=force * part)
        curve = el.response_curve(system, "speed", bounds)
        top = np.argmax(curve.special_highest)
        away.append(curve.special_value[top] - backbone(curve.special_highest[top], cubic))
    first = np.array(away)
    assert np.sign(first).tolist() == [np.sign(cubic)] * 3
    np.testing.assert_allclose(first[:-1] / first[1:], 4.0, rtol=0.02)
    # What is left when the square of the damping is extrapolated falls by its fourth power.
    second = (4.0 * first[1:] - first[:-1]) / 3.0
    assert second[0] / second[1] == pytest.approx(16.0, rel=0.05)


# ---------------------------------------------------------------- periodic stiffness


def pendulum(q, qd, qdd, drive, parameters, derivatives=True):
    """``q'' + 2 damping q' + (1 + shaking cos(theta)) sin(q) = 0``, as a user writes it."""
    damping = 2.0 * parameters["damping"]
    pull = 1.0 + parameters["shaking"] * np.cos(drive.angle)[..., None]
    left = qdd + damping * qd + pull * np.sin(q)
    if not derivatives:
        return Varied(left)
    one = np.ones((*q.shape, 1))
    return Varied(left, one, damping * one, (pull * np.cos(q))[..., None])


def shaken(damping: float, shaking: float = 0.3) -> Nonlinear:
    """Return a pendulum whose pivot is shaken."""
    return Nonlinear(1, pendulum, {"damping": damping, "shaking": shaking})


def meets_minus_one(multipliers) -> float:
    """Return what vanishes where a multiplier is -1."""
    return float(np.prod(multipliers + 1.0).real)


def largest(multipliers) -> float:
    """Return what vanishes where the largest multiplier passes the unit circle."""
    return float(np.max(np.abs(multipliers)) - 1.0)


def assert_tongue(system, curve, edges):
    """Compare the edges of the main tongue, and the motions of two turns that begin there."""
    values, errors, _ = special(curve, "doubling")
    assert set(curve.special) == {"doubling"}  # no torus where pairs stay on the circle
    assert np.all(np.abs(np.sort(values) - edges) <= errors + KNOWN)
    assert curve.turns[curve.branch > 0].tolist() == [2] * int(np.sum(curve.branch > 0))
    # Each branch of two turns begins with next to no amplitude at an edge, as a parabola.
    for number, edge in zip((1, 2), values, strict=True):
        (at,) = np.nonzero(curve.branch == number)
        size, moved = curve.highest[at[:8]], np.abs(curve.value[at[:8]] - edge)
        assert size[0] < 1e-4
        assert np.all(np.diff(size) > 0.0)
        assert np.ptp((moved / size**2)[3:]) < 0.01 * (moved / size**2)[-1]
        assert_shot(system, curve, at[[len(at) // 2, len(at) - 2]])


@pytest.mark.slow
def test_the_main_tongue_of_a_pendulum_is_mathieus():
    """With theta = 2 z: y'' + (4 / speed^2) (1 + shaking cos(2 z)) y = 0, by SciPy's values."""
    system = shaken(damping=0.0)
    curve = el.response_curve(system, "speed", (1.6, 2.4), turns=2)
    square = 2.0 * system.parameters["shaking"]

    def edge(characteristic):
        return brentq(lambda w: 4.0 / w**2 - characteristic(1, square / w**2), 1.6, 2.4, xtol=1e-14)

    assert_tongue(system, curve, [edge(mathieu_a), edge(mathieu_b)])


DAMPED = {
    "pendulum": shaken(damping=0.01),
    "cubic": oscillators(damping=0.02, cubic=0.5, excitation=0.3),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", DAMPED)
def test_a_damped_tongue_and_what_grows_in_it(name):
    system = DAMPED[name]
    curve = el.response_curve(system, "speed", (1.6, 2.4), turns=2)
    edges = [shot_where(meets_minus_one, system, guess, np.zeros(2))[0] for guess in (1.85, 2.14)]
    assert_tongue(system, curve, edges)


def test_two_coupled_ones_lose_their_rest_by_a_torus_at_the_sum_of_frequencies():
    squares = np.array([1.0, 2.6])
    system = oscillators(
        np.diag(squares), [[0.3, 1.0], [1.0, -0.4]], damping=0.02, cubic=0.5, excitation=0.3
    )
    both = float(np.sum(np.sqrt(squares)))
    curve = el.response_curve(system, "speed", (0.92 * both, 1.08 * both))
    values, errors, orbits = special(curve, "torus")
    assert len(values) == len(curve.special) == 2
    assert values[0] < both < values[1]
    for value, error, orbit in zip(values, errors, orbits, strict=True):
        exact, _ = shot_where(largest, system, 1.002 * value, np.zeros(4))
        assert abs(value - exact) <= error + KNOWN
        assert np.min(np.abs(orbit.multipliers.imag)) > 0.1  # a pair, and no real one
    inside = (curve.value > values[0] + 1e-9) & (curve.value < values[1] - 1e-9)
    at_edge = np.min(np.abs(curve.value[:, None] - values), axis=1) < 1e-9
    assert np.array_equal(curve.stable[~at_edge], ~inside[~at_edge])


# ---------------------------------------------------------------- extremes


@pytest.mark.parametrize("count", [10, 13, 24])
def test_extremes_are_right_from_a_few_samples_on(count):
    """Of ``exp(sin) cos``, whose tops lean: where ``sin = cos^2``, wherever the samples are.

    And of twice that beside it.
    """
    sine = (np.sqrt(5.0) - 1.0) / 2.0
    top, width = np.exp(sine) * np.sqrt(1.0 - sine**2), 2.0 * np.pi / count

    def deflection(row, angle):
        return (1.0 + row) * np.exp(np.sin(angle)) * np.cos(angle)

    for begin in np.linspace(0.0, width, 21):
        angles = begin + width * np.arange(count)
        around = np.concatenate([angles[:1] - width, angles, angles[-1:] + width])
        values = deflection(np.array([[0], [1]]), around)
        found = tops(deflection, angles, values, width)
        assert found == pytest.approx(np.array([[-top, top], [-2.0 * top, 2.0 * top]]), rel=1e-11)


@pytest.mark.parametrize("name", ["speed", "force"])
def test_motions_corrected_side_by_side_are_those_of_one_at_a_time(name):
    """At other values of what is varied, with errors and extremes."""
    system = oscillators(damping=0.04, cubic=HARD, force=0.1)
    value = 1.1 if name == "speed" else system.parameters["force"]
    solver = Solver(Problem(system, name, 1.1), value)
    begun = solver.settled(value, Motion.rest(system, 1, 9, STAGES))
    along = solver.along_parameter(begun)
    guesses = [(part * value, begun, along) for part in (1.0, 1.01, 0.98)]
    orbits, _ = solver.all_corrected(guesses)
    for guess, orbit, measure in zip(guesses, orbits, solver.all_measured(orbits), strict=True):
        alone, _ = solver.corrected(*guess)
        assert orbit.value == pytest.approx(guess[0], rel=1e-14)
        assert orbit.motion.states == pytest.approx(alone.motion.states, rel=1e-12, abs=1e-13)
        assert orbit.multipliers == pytest.approx(alone.multipliers, rel=1e-9)
        assert measure.error == pytest.approx(solver.measure(alone).error, rel=0.01)
        assert extremes_of(solver.problem, orbit) == pytest.approx(
            extremes_of(solver.problem, alone), rel=1e-11
        )


# ---------------------------------------------------------------- the elastica

EULER = np.pi**2  # of a column with EI = l = 1
PLACES, PARTS = (part / 2.0 for part in np.polynomial.legendre.leggauss(24))
PLACES = PLACES + 0.5


class Column:
    """A column on pins under an axial load, inextensible: EI = l = 1, moving as in a thick oil.

    The tangent's angle is ``sum_k q_k cos(k pi s)``, k odd, and the potential
    ``int phi_s^2 / 2 + load (cos(phi) - 1) ds``; mass and damping do not matter to its equilibria.
    """

    def __init__(self, count: int) -> None:
        orders = np.arange(1, 2 * count, 2)
        self.shapes = np.cos(np.pi * np.outer(PLACES, orders))
        self.half = np.cos(np.pi * np.outer(PLACES / 2.0, orders))
        self.stiffness = np.diag((np.pi * orders) ** 2 / 2.0)

    def __call__(self, q, qd, qdd, drive, parameters, derivatives=True):
        angle, load = q @ self.shapes.T, parameters["load"]
        left = qdd + qd + q @ self.stiffness - load * (PARTS * np.sin(angle)) @ self.shapes
        if not derivatives:
            return Varied(left)
        one = np.broadcast_to(np.eye(q.shape[-1]), (*q.shape, q.shape[-1]))
        softer = load * (self.shapes.T * (PARTS * np.cos(angle))[..., None, :]) @ self.shapes
        return Varied(left, one, one, self.stiffness - softer)

    def deflection(self, q, parameters):
        """Return the deflection of the middle."""
        return np.sin(q @ self.half.T) @ PARTS / 2.0

    def shortening(self, q):
        """Return by how much the ends approach."""
        return 1.0 - np.cos(q @ self.shapes.T) @ PARTS


def elastica(load: float) -> tuple[float, float, float]:
    """Return deflection and shortening of a buckled column, and the nome of its shape.

    With m the square of the sine of half the angle at the pins, ``load = (2 K(m))^2``.
    """
    m = brentq(lambda m: 4.0 * ellipk(m) ** 2 - load, 1e-9, 0.999, xtol=1e-15)
    nome = np.exp(-np.pi * ellipk(1.0 - m) / ellipk(m))
    return np.sqrt(m) / ellipk(m), 2.0 - 2.0 * ellipe(m) / ellipk(m), nome


def buckled(count: int):
    """Return the response of a column to its load, and its last motion on either bent branch."""
    column = Column(count)
    system = Nonlinear(count, column, {"load": 1.0}, deflection=column.deflection)
    curve = el.response_curve(system, "load", (0.95 * EULER, 1.3 * EULER), speed=1.0)
    assert curve.special == ("branch point",)
    assert abs(curve.special_value[0] - EULER) <= curve.special_error[0] < 1e-9
    straight = curve.branch == 0
    assert np.all(curve.highest[straight] == 0.0)
    assert np.all(curve.stable[straight & (curve.value < EULER - 1e-9)])
    assert not np.any(curve.stable[straight & (curve.value > EULER + 1e-9)])
    # The column goes to either side, and stays there.
    assert np.all(curve.stable[~straight])
    ends = [np.flatnonzero(curve.branch == number)[-1] for number in (1, 2)]
    assert abs(curve.highest[ends[0]] + curve.lowest[ends[1]]) <= np.sum(curve.peak_error[ends])
    return column, curve, ends


def test_a_column_of_one_harmonic_buckles_at_eulers_load():
    """With the angle ``q cos(pi s)`` it bears ``EULER q / (2 J_1(q))``, J_1 of Bessel."""
    _, curve, ends = buckled(1)
    for number in (1, 2):
        at = np.flatnonzero(curve.branch == number)
        q = np.array([curve.orbits[i].motion.x[0, 0] for i in at])
        slack = curve.source.span * curve.error[at] + KNOWN * EULER
        assert np.all(np.abs(curve.value[at] - EULER * q / (2.0 * j1(q))) <= slack)
    assert np.all(np.abs(curve.highest[ends]) > 0.3)


@pytest.mark.slow
def test_more_harmonics_come_to_the_elastica():
    """Harmonics of an elastica fall like powers of its nome, and with them what is left out."""
    left_out = []
    for count in (1, 2, 3, 4):
        column, curve, ends = buckled(count)
        deflection, shortening, nome = elastica(curve.value[ends[0]])
        q = curve.orbits[ends[0]].motion.x[0]
        gaps = abs(curve.highest[ends]) - deflection, column.shortening(q) - shortening
        left_out.append([np.max(np.abs(gap)) for gap in gaps])
    ratios = np.array(left_out)[1:] / np.array(left_out)[:-1]
    assert np.all(ratios < nome)


def pitchfork(q, qd, qdd, drive, parameters, derivatives=True):
    """``q'' + q' + stiffness q + q^3 = 0``: beside rest ``q^2 = -stiffness``."""
    stiffness = parameters["stiffness"]
    left = qdd + qd + stiffness * q + q**3
    if not derivatives:
        return Varied(left)
    one = np.ones((*q.shape, 1))
    return Varied(left, one, one, (stiffness + 3.0 * q**2)[..., None])


def test_a_pitchfork_at_zero():
    """There the error is none of the value's, and the equations are singular to the last digit."""
    system = Nonlinear(1, pitchfork, {"stiffness": 1.0})
    curve = el.response_curve(system, "stiffness", (-0.3, 0.5), speed=1.0)
    assert curve.special == ("branch point",)
    assert abs(curve.special_value[0]) <= curve.special_error[0] < 1e-9
    for number in (1, 2):
        at = np.flatnonzero(curve.branch == number)
        size, value = curve.highest[at], curve.value[at]
        slack = 2.0 * np.abs(size) * curve.peak_error[at] + curve.error[at] * curve.source.span
        assert np.all(np.abs(size**2 + value) <= slack)
    solver, rest = curve.source, curve.orbits[0].motion
    upwards = solver.along_parameter(rest)
    below, here, above = (solver.corrected(v, rest, upwards)[0] for v in (-0.1, 0.0, 0.1))
    assert here.value == here.border == 0.0
    assert here.tangent.value == pytest.approx(solver.span, rel=1e-15)
    # A step that ends there, and the next one: one of both has the branch point.
    for ends in (below, here, above), (above.turned(), here.turned(), below.turned()):
        points = [point for step in pairwise(ends) for point in special_points(solver, *step)]
        assert [point.kind for point in points] == ["branch point"]
        assert abs(points[0].orbit.value) <= points[0].value_error


# ---------------------------------------------------------------- the rod of a quick return


@pytest.mark.parametrize("modes", [1, pytest.param(3, marks=pytest.mark.slow)])
def test_a_rod_that_is_driven_little_moves_as_its_linear_equations_say(modes):
    """Deflections are of the order of the crank ratio, what they lack is of its third power."""
    speed, ratios = 150.0, (0.004, 0.02)
    bare = free_free_rod(modes, crank_ratio=0.1, speed=speed, **ROD)
    driven = driven_rod(bare)
    curve = el.response_curve(driven, "crank_ratio", ratios, speed=speed, rtol=1e-11)
    assert curve.special == ()
    off, sizes, known = [], [], []
    for i in (0, len(curve.value) - 1):
        ratio = curve.value[i]
        linear = rod_system(FreeFreeBasis(modes), crank_ratio=ratio, **ROD)
        steady = el.steady_state(linear, speed, rtol=1e-12)
        q = curve.orbits[i].motion.at(steady.theta)[0]
        numbers = {**driven.parameters, "crank_ratio": ratio}
        whole = driven.equations.whole(q, Drive(steady.theta, speed), numbers)
        # The tip's deflection from the line through pin and block, of both.
        rod = free_free_rod(modes, crank_ratio=ratio, speed=speed, **ROD)
        tip = rod.deflection(whole, steady.theta / speed, [1.0])[:, 0]
        sizes.append(np.max(np.abs(tip)))
        off.append(np.max(np.abs(tip - steady.deflection(1.0))) / sizes[-1])
        known.append(curve.error[i] + np.max(steady.error))
    assert np.all(np.array(off) > 100.0 * np.array(known))
    assert slope(ratios, sizes) == pytest.approx(1.0, abs=0.05)
    assert slope(ratios, off) == pytest.approx(2.0, abs=0.1)
