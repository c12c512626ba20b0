"""The error figure of the forces against 60 digits, over random machines of every linkage."""

from __future__ import annotations

import numpy as np
import pytest
import rigid_truth
from elastolink.runtime.dynamics import Load, Machine, MassDistribution, rigid_forces
from elastolink.runtime.errors import BadInput
from elastolink.runtime.mechanisms import FourBar, QuickReturn, SliderCrank

MACHINES, ANGLES = 80, 2


def random_linkage(kind, random):
    while True:
        scale = 10.0 ** random.uniform(-3, 3)
        try:
            if kind == "four-bar":
                lengths = random.uniform(0.1, 1.0, 4) * scale
                return FourBar(*map(float, lengths), random.choice(["open", "crossed"]))
            if kind == "slider-crank":
                crank, coupler = random.uniform(0.1, 1.0, 2) * scale
                offset = random.uniform(-0.5, 0.5) * scale
                branch = random.choice(["open", "crossed"])
                return SliderCrank(float(crank), float(coupler), float(offset), branch)
            frame, crank = (float(size) for size in random.uniform(0.1, 1.0, 2) * scale)
            return QuickReturn(frame, crank, 1.5 * (frame + crank))
        except BadInput:
            continue


def random_machine(kind, random):
    linkage = random_linkage(kind, random)
    size = max(linkage.lengths.values())
    masses = {}
    for link in linkage.links:
        if random.random() < 0.2:
            continue
        mass = 10.0 ** random.uniform(-2, 2)
        along, across = random.uniform(-0.7, 1.0) * size, random.uniform(-0.3, 0.3) * size
        across = 0.0 if random.random() < 0.3 else across
        inertia = mass * size**2 * random.uniform(0.0, 0.2)
        masses[link] = MassDistribution.about_centre(mass, along, across, inertia)
    if not masses:
        masses["coupler" if "coupler" in linkage.links else "rod"] = MassDistribution(inertia=1.0)
    wrenches = {}
    if random.random() < 0.4:
        wrenches[linkage.links[2]] = tuple(random.normal(size=3) * (1.0, 1.0, size))
    loads = tuple(Load(link, force[:2], force[2]) for link, force in wrenches.items())
    gravity = (0.0, -9.81) if random.random() < 0.4 else (0.0, 0.0)
    return Machine(linkage, masses, gravity, loads), wrenches


def random_angles(linkage, random):
    low, high = linkage.crank_ranges()[int(random.integers(len(linkage.crank_ranges())))]
    # Now and then a hair's breadth from the fold, or from where a full turn comes nearest to one.
    share = random.uniform(0.001, 0.999, ANGLES)
    if random.random() < 0.2:
        share[0] = 10.0 ** random.uniform(-6, -3)
    return low + share * (high - low)


@pytest.mark.parametrize("kind", ["four-bar", "slider-crank", "quick-return"])
def test_the_figure_covers_the_error_and_is_not_idle(kind) -> None:
    random = np.random.default_rng(20260)
    covered, ratios = [], []
    for _ in range(MACHINES):
        machine, wrenches = random_machine(kind, random)
        theta = random_angles(machine.linkage, random)
        speed = 10.0 ** random.uniform(-1, 3)
        acceleration = float(random.choice([0.0, 1.0])) * random.normal() * speed**2
        found = rigid_forces(machine, theta, speed, acceleration)
        actual, figure = rigid_truth.errors(machine, found, outside=wrenches)
        covered += list(actual <= figure)
        ratios += list(figure / np.maximum(actual, np.finfo(float).tiny))
        assert found.passed
    assert np.mean(covered) >= 0.99
    assert np.median(ratios) <= 1e3


def test_the_parts_have_the_same_figure() -> None:
    random = np.random.default_rng(7)
    machine, _ = random_machine("four-bar", random)
    theta = random_angles(machine.linkage, random)
    whole = rigid_forces(machine, theta, 3.0)
    part = rigid_forces(machine, theta, 3.0, outputs=("torque",))
    np.testing.assert_array_equal(whole.error, part.error)
    assert whole.error.shape == theta.shape
    assert np.all(whole.error > 0)
