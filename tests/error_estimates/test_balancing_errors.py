"""Error estimate of the optimiser: a proved bound, and no idle one."""

from dataclasses import replace

import numpy as np
from balancing_machines import nine_equations, random_machine, with_crank_counterweight
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.rigid import Bounds, Machine, MassDistribution, balance
from elastolink.runtime.rigid.counterweights import with_counterweights
from honesty import over_scenes

SPEED = 10.0
THETA = np.linspace(0.0, 2.0 * np.pi, 4097)[:-1]


def exact(machine):
    """Least root mean square of the shaking force with a crank counterweight, by least squares."""
    force = nine_equations(machine, THETA, SPEED)["shaking_force"].astype(np.longdouble)
    turned = np.exp(1j * THETA)
    along = np.stack([turned.real, turned.imag], axis=-1).astype(np.longdouble)
    across = along[:, ::-1] * np.array([-1.0, 1.0])
    left = force
    for column in (along, across):  # at right angles to each other over a whole turn
        left = left - column * (np.sum(column * left) / np.sum(column * column))
    return float(np.sqrt(np.sum(left**2) / np.sum(force**2)))


@over_scenes(0, few=4, many=80, floor=np.finfo(float).eps)
def test_error_bounds_the_distance_from_the_optimum_and_is_not_idle(rng):
    """Both are of the order of 1: no difference below its round-off means anything."""
    machine = random_machine(rng)
    found = with_crank_counterweight(machine, SPEED)
    return found.error, found.value - exact(machine)


def near_change_point(rng):
    """Return a crank-rocker that all but stretches at pi, as a function of the unit of length."""
    crank, coupler, follower = 0.1, *map(float, rng.uniform(0.3, 0.6, 2))
    frame = coupler + follower - crank - 10.0 ** float(rng.uniform(-9.0, -2.0))
    bodies = rng.uniform([0.1, -0.5, -0.5, 0.0], [2.0, 0.5, 0.5, 0.2], (3, 4))

    def made(unit):
        linkage = FourBar(*(float(unit * size) for size in (frame, crank, coupler, follower)))
        masses = {}
        for link, (mass, along, across, inertia) in zip(linkage.links, bodies, strict=True):
            about = mass, unit * along, unit * across, unit**2 * inertia
            masses[link] = MassDistribution.about_centre(*about)
        return Machine(linkage, masses)

    return made if made(1.0).linkage.crank_turns else None


@over_scenes(1, few=10, many=70, floor=np.finfo(float).eps, median=200.0)
def test_values_do_not_hang_on_the_unit_of_length_beyond_the_error(rng):
    """Where the last digits of the lengths change forces; two estimates cover one difference."""
    made = near_change_point(rng)
    if made is None:
        return None
    offsets = 10.0 ** rng.uniform(-5.0, 0.0, 12)
    angles = np.pi + np.concatenate([offsets, -offsets])
    units = 1.0, float(rng.uniform(0.3, 3.0))
    given = {"weights": {"shaking_force": 1.0, "torque": 1.0}, "links": ("crank",)}
    one, other = (
        balance(
            made(unit), SPEED, angles=angles, bounds=Bounds(mass=2.0, offset=0.1 * unit), **given
        )
        for unit in units
    )
    # Errors are over the unbalanced linkage's weighted sum, that of the weights.
    return one.error + other.error, (one.value - other.value) / sum(given["weights"].values())


def mean_squares(machine, speed):
    """Return root mean squares of shaking force and torque over a turn, by panels towards pi."""
    ends = np.pi * (1.0 - np.concatenate([[1.0], 0.5 ** np.arange(1.0, 26.0), [0.0]]))
    node, weight = np.polynomial.legendre.leggauss(24)
    half = 0.5 * np.diff(ends)[:, None]
    near = (0.5 * (ends[1:] + ends[:-1])[:, None] + half * node).ravel()
    theta = np.concatenate([near, 2.0 * np.pi - near])
    weights = np.tile((half * weight).ravel(), 2) / (2.0 * np.pi)
    forces = nine_equations(machine, theta, speed)
    rows = [np.reshape(forces[name], (len(theta), -1)) for name in ("shaking_force", "torque")]
    return np.array([np.sqrt(weights @ np.sum(row**2, axis=1)) for row in rows])


@over_scenes(2, few=10, many=70, floor=1e-15)
def test_means_near_a_change_point_count_what_the_samples_miss(rng):
    """Below 1e-8 of the lengths no even row of samples resolves the motion.

    The truth is that of another unit of length: what its rounding changes is in the error too.
    """
    made = near_change_point(rng)
    if made is None:
        return None
    machine, unit = made(1.0), float(rng.uniform(0.3, 3.0))
    found = balance(
        machine,
        SPEED,
        measure="rms",
        bounds=Bounds(mass=2.0, offset=0.1),
        weights={"shaking_force": 1.0, "torque": 1.0},
        links=("crank",),
    )
    scaled = [
        replace(
            each, **{name: unit * getattr(each, name) for name in ("along", "across", "radius")}
        )
        for each in found.counterweights.values()
    ]
    other = made(unit)
    pair = (mean_squares(each, SPEED) for each in (with_counterweights(other, scaled), other))
    after, before = pair
    return found.error, 0.5 * (found.value - float(np.sum(after / before)))


def test_samples_that_miss_the_motion_are_told():
    """At 1e-10 of the lengths the means hang on where the samples lie."""
    links = {"frame": 0.7 - 1e-11, "crank": 0.1, "coupler": 0.4, "follower": 0.4}
    machine = Machine(
        FourBar(**links), {"coupler": MassDistribution.about_centre(1.0, 0.2, 0.1, 0.1)}
    )
    weights = {"shaking_force": 1.0}
    found = balance(machine, SPEED, measure="rms", weights=weights, links=("crank",))
    assert found.error > found.checks["samples"].value > 1e-6 and not found.passed


@over_scenes(3, few=10, many=70, floor=np.finfo(float).eps)
def test_cases_do_not_hang_on_the_unit_of_length_beyond_the_error(rng):
    made = near_change_point(rng)
    if made is None:
        return None
    case = str(rng.choice(["b", "c"]))
    one, other = (balance(made(unit), SPEED, case=case) for unit in (1.0, rng.uniform(0.3, 3.0)))
    gaps = [abs(one.relative[term] - other.relative[term]) for term in one.relative]
    return one.error + other.error, max(gaps) / max(one.relative.values())
