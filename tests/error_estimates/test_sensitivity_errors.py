"""Errors of derivatives against those of Taylor series with 70 digits, by their differences.

The references are known to 40 digits: steps of 1e-24, symmetric.
"""

import elastolink as el
import mpmath as mp
import numpy as np
import pytest
from elastolink.runtime.core.trigonometric import differentiated, interpolated
from elastolink.runtime.design import sensitivities
from elastolink.runtime.rigid.evaluation import ParametricMachine
from honesty import over_scenes
from variation_truth import random_truth, slope


def _eigenvalues(matrix):
    if matrix.rows == 1:
        return [matrix[0, 0]]
    return mp.eig(matrix, left=False, right=False)


def _multipliers(truth, like, speed, changes):
    """Return the multipliers in the order of those that they are like."""
    m = 2 * truth.size
    values = _eigenvalues(truth.map(speed, changes)[:m, :m])
    return mp.matrix([min(values, key=lambda value: abs(value - one)) for one in like])


@over_scenes(411, few=1, many=60)
def test_derivatives_of_multipliers(rng):
    truth = random_truth(rng)
    speed = float(rng.uniform(0.6, 2.0))
    system, name = truth.system(), str(rng.choice([*truth.values]))
    answer = el.floquet_multipliers(system, speed)
    found = sensitivities(system, answer, ["speed", name])
    like = answer.multipliers.tolist()
    by_speed = slope(lambda w: _multipliers(truth, like, w, {}), speed)
    value = truth.values[name]
    by_name = slope(lambda x: _multipliers(truth, like, speed, {name: x}), value)
    exact = np.array([[complex(a), complex(b)] for a, b in zip(by_speed, by_name, strict=True)])
    kept = ~found.collided
    return found.error[kept], np.abs(found.derivative - exact)[kept]


def _distance_from_edge(truth, like, speed, changes):
    """Return what vanishes where multipliers leave the unit circle as one of the answer does."""
    m = 2 * truth.size
    matrix = truth.map(speed, changes)[:m, :m]
    if "c" in truth.values:
        values = _eigenvalues(matrix)
        return mp.log(abs(min(values, key=lambda value: abs(value - like))))
    trace = sum(matrix[i, i] for i in range(m))
    if m == 2:
        return trace - 2 * round(like.real)
    square = matrix * matrix
    second = (trace**2 - sum(square[i, i] for i in range(m))) / 2
    # The pairs' sums s solve s^2 - trace s + second - 2 = 0.
    if abs(like.imag) < 1e-5:
        return 2 + second - 2 * round(like.real) * trace
    return trace**2 - 4 * (second - 2)


@over_scenes(421, few=None, many=20)
def test_derivatives_of_ends_of_regions(rng):
    truth = random_truth(rng)
    system, name = truth.system(), str(rng.choice([*truth.values]))
    try:
        answer = el.stability_edges(system, (0.7, 2.5))
    except el.BadInput:
        return None
    found = sensitivities(system, answer, [name])
    known = np.argwhere(np.isfinite(found.error[..., 0]))
    if not len(known):
        return None
    region, end = known[rng.integers(len(known))]
    start = float(found.value[region, end])
    values = el.floquet_multipliers(system, start, rtol=1e-10).multipliers
    like = complex(values[np.argmin(np.abs(np.abs(values) - 1.0))])
    if "c" not in truth.values:
        near = np.abs(values[:, None] - values[None, :]) + 4.0 * np.eye(len(values))
        like = complex(values[np.unravel_index(np.argmin(near), near.shape)[0]])

    def gap(speed, changes):
        return _distance_from_edge(truth, like, speed, changes)

    speed = mp.mpf(start)
    for _ in range(2):
        by_speed = slope(lambda w: gap(w, {}), speed)
        speed -= gap(speed, {}) / by_speed
    assert abs(speed - start) < 1e-8
    by_name = slope(lambda x: gap(speed, {name: x}), truth.values[name])
    exact = float(-by_name / by_speed)
    return found.error[region, end, 0], abs(found.derivative[region, end, 0] - exact)


@over_scenes(431, few=None, many=12)
def test_derivatives_of_peaks(rng):
    truth = random_truth(rng, damped=True, forced=True)
    speed = float(rng.uniform(0.6, 2.0))
    system, name = truth.system(), str(rng.choice([*truth.values]))
    answer = el.steady_state(system, speed)
    found = sensitivities(system, answer, ["speed", name])
    coordinate = int(rng.integers(truth.size))
    fine = el.steady_state(system, speed, rtol=1e-11, samples=2048)
    # The angle of the peak by the series of doubles, then twice by the reference: to 1e-40.
    rate, bend = (interpolated(history, fine.period) for history in _derivatives(fine, coordinate))
    start = fine.theta[[int(np.argmax(np.abs(fine.q[:, coordinate])))]]
    for _ in range(4):
        start = start - (rate(start) / bend(start))[:, 0]
    start = mp.mpf(float(start[0]))

    def motion(angle, speed, changes):
        m = 2 * truth.size
        matrix = truth.map(speed, changes, angle)
        state = mp.lu_solve(mp.eye(m) - matrix[:m, :m], matrix[:m, m])
        mass, turned = (truth.array(name, angle, changes) for name in "MA")
        rate = mass**-1 * (state[truth.size :] - turned * state[: truth.size])
        return state[coordinate], rate[coordinate]

    angle = start
    for _ in range(2):
        bend = slope(lambda a: motion(a, speed, {})[1], angle)
        angle -= motion(angle, speed, {})[1] / bend
    by_speed = slope(lambda w: motion(angle, w, {})[0], speed)
    by_name = slope(lambda x: motion(angle, speed, {name: x})[0], truth.values[name])
    exact = np.array([float(by_speed), float(by_name)])
    return found.error[coordinate], np.abs(found.derivative[coordinate] - exact)


def _derivatives(motion, coordinate):
    first = differentiated(motion.q[:, [coordinate]], motion.period)
    return first, differentiated(first, motion.period)


@over_scenes(441, few=10, many=200)
def test_derivatives_of_natural_frequencies(rng):
    truth = random_truth(rng, damped=False)
    system, name = truth.system(), str(rng.choice(["m", "v", "k", "e", "g"]))
    answer = el.natural_frequencies(system, np.array([0.3, 2.0, 4.4]))
    found = sensitivities(system, answer, [name])
    exact = np.empty(found.value.shape)
    for i, angle in enumerate(answer.theta):
        like = answer.tracked[i].tolist()

        def frequencies(x, angle=angle, like=like):
            mass, stiffness = (truth.array(array, angle, {name: x}) for array in "MK")
            squares = _eigenvalues(mass**-1 * stiffness)
            roots = [mp.sqrt(mp.re(square)) for square in squares]
            return mp.matrix([min(roots, key=lambda root: abs(root - one)) for one in like])

        exact[i] = [float(x) for x in slope(frequencies, truth.values[name])]
    kept = ~found.collided
    return found.error[kept][..., 0], np.abs(found.derivative[..., 0] - exact)[kept]


@over_scenes(443, few=6, many=100)
@pytest.mark.parametrize("name", ["slider_crank_example", "aannaque_1996_table_3_2"])
def test_derivatives_of_motion_and_forces(rng, name):
    """By complex steps in the machine's own numbers, which were checked to sixty digits."""
    links = {k: v for k, v in el.load_scene(name).given["links"].items() if isinstance(v, float)}
    moved = {f"links.{k}": v * rng.uniform(0.9, 1.1) for k, v in links.items()}
    moved["links.offset" if "offset" in links else "links.frame"] *= rng.uniform() < 0.7 or 1.0
    scene = el.load_scene(name, moved)
    machine, linkage = scene.machine(), scene.mechanism()
    theta = rng.uniform(0.0, 2.0 * np.pi, 5)
    drive = [np.full(5, rng.uniform(1.0, 200.0)), np.full(5, rng.uniform(-50.0, 50.0))]
    model = ParametricMachine(linkage, theta, *drive, machine=machine)
    _, slopes = model.derivatives(model.values, tuple(model.values))
    place = {number: i for i, number in enumerate(model.values)}
    given = name != "slider_crank_example"  # whether masses follow from lengths and density

    def exact(row, key):
        """Return the derivative by a key, through the numbers that follow from it."""
        table, number = key.split(".")
        link = number if table == "links" else table
        powers = {"mass": 1, "along": 2, "inertia": 3} if table == "links" else {}
        through = {number: 1.0} if table == "links" else {}
        if number == "density":
            powers = dict.fromkeys(("mass", "along", "inertia"), 1)
        if (given or number == "density") and link in machine.masses:
            mass = machine.mass(link)
            value = scene.get(key)
            through |= {f"{link}.{k}": p * getattr(mass, k) / value for k, p in powers.items()}
        if number == "mass":
            centre = scene.given[link].get("centre_along", 0.0)
            through = {f"{link}.mass": 1.0, f"{link}.along": centre, f"{link}.inertia": centre**2}
        return sum(slopes[row][place[k]] * factor for k, factor in through.items())

    keys = [*moved, "coupler.density" if given else "coupler.mass"]
    found = {}
    for kind, answer in (
        ("motion", linkage.motion(theta, *drive)),
        ("forces", el.rigid_forces(machine, theta, *drive)),
    ):
        told = sensitivities(scene, answer, keys)
        truth = np.array([[exact(row, key) for key in keys] for row in told.answer.split(", ")])
        gap = np.abs(told.derivative - np.moveaxis(truth, 1, -1))
        found[kind] = told.error[gap > 0.0], gap[gap > 0.0]
    return found
