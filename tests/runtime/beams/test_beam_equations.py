"""The equation of motion of beams in a linkage, against Lagrange's by numerical differentiation."""

from __future__ import annotations

import pickle
from functools import partial

import numpy as np
import pytest
from beam_energies import Energies, places_of
from elastolink.runtime.beams import (
    KINDS,
    Section,
    beam_linkage,
    frame,
    linear_system,
    linkage_system,
)
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.systems import with_modal_damping
from periodic_systems import hamiltonian_gap

FOUR_BAR = FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
# Aannaque's Table 4.1.
SECTIONS = {
    link: Section(
        area=area * 1e-6,
        second_moment=second * 1e-12,
        modulus=210e9,
        density=7850.0,
        thickness=thickness * 1e-3,
        shear_stiffness=5.0 / 6.0 * 80e9 * area * 1e-6,
        retardation=2e-5,
    )
    for link, area, second, thickness in (
        ("crank", 157.5, 520.47, 6.35),
        ("coupler", 85.5, 83.34, 3.42),
        ("follower", 78.75, 65.12, 3.15),
    )
}
ARRAYS = ("M", "A", "B", "C", "D", "K", "f", "g", "p")
MASSES = {"B": 0.174, "C": 0.174}
# Central differences of order 8.
STEP, DIFFERENCES = 0.01, (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)


def derivative(function, at):
    """Return the derivative of a function of one number."""
    return sum(
        weight * (function(at + k * STEP) - function(at - k * STEP)) / STEP
        for k, weight in enumerate(DIFFERENCES, start=1)
    )


@pytest.mark.parametrize(
    "kind",
    ["curvature", *(pytest.param(k, marks=pytest.mark.slow) for k in KINDS if k != "curvature")],
)
def test_the_equation_of_motion_is_lagranges(kind):
    structure = beam_linkage(FOUR_BAR, SECTIONS, elements=1, kind=kind, joint_masses=MASSES)
    system = linear_system(structure, gravity=(0.0, -9.81))
    energies = Energies(structure, partial(places_of, FOUR_BAR))
    rng = np.random.default_rng(7)
    first, second = rng.normal(size=(2, system.size))

    def crank(t):
        # Speed and acceleration both change.
        return 0.7 + 1.3 * t + 0.4 * t**2, 1.3 + 0.8 * t, 0.8

    def path(t):
        return first * np.cos(t) + second * np.sin(2.0 * t)

    def momentum(t):
        theta, speed, _ = crank(t)
        known = energies.kinetic(theta)
        return known["M"] @ derivative(path, t) + speed * (known["A"] @ path(t) + known["b"])

    for t in (0.2, 1.1):
        theta, speed, change = crank(t)
        known = {**energies.kinetic(theta), **energies.elastic(theta)}
        q, qd = path(t), derivative(path, t)
        qdd = derivative(lambda s: derivative(path, s), t)
        kept = system.array("Kg", theta, speed=speed)[0]
        # d/dt dL/dqd - dL/dq, less the forces that have no potential.
        expected = derivative(momentum, t) - speed * known["A"].T @ qd
        expected -= speed**2 * (known["B"] @ q + known["a"]) - (known["K"] + kept) @ q
        expected += known["C"] @ qd + speed * known["D"] @ q
        expected -= energies.weight(theta, (0.0, -9.81))

        at = {name: system.array(name, theta)[0] for name in ARRAYS}
        slope = {
            name: derivative(lambda x, name=name: system.array(name, x)[0], theta) for name in "MA"
        }
        turned = slope["M"] + at["A"] - at["A"].T
        found = at["M"] @ qdd + (at["C"] + speed * turned) @ qd
        found += (at["K"] + kept + speed * at["D"]) @ q
        found += (speed**2 * (slope["A"] - at["B"]) + change * at["A"]) @ q
        found -= speed**2 * at["f"] + change * at["g"] + at["p"]
        size = np.sqrt(np.diag(known["M"]))
        # Without K, whose size would hide the rest; the differences leave about ten digits.
        known_rest = (expected - known["K"] @ q) / size
        rest = (found - at["K"] @ q) / size
        assert np.max(np.abs(rest - known_rest)) < 1e-9 * np.max(np.abs(known_rest))


def undamped(form, elements=2):
    sections = {k: Section(**{**vars(v), "retardation": 0.0}) for k, v in SECTIONS.items()}
    return linkage_system(FOUR_BAR, sections, form=form, elements=elements, joint_masses=MASSES)


def test_the_full_form_is_hamiltonian_and_the_instantaneous_is_not():
    angles = np.linspace(0.0, 6.0, 7)
    # A high speed keeps the elastic forces from hiding the gyroscopic ones.
    assert hamiltonian_gap(undamped("full"), 1e5, angles) < 1e-14
    assert hamiltonian_gap(undamped("instantaneous"), 1e5, angles) > 1e-3


@pytest.mark.smoke
def test_a_frame_that_stands_still_keeps_its_frequencies_of_closed_form():
    bar = Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    beam = frame(
        {"A": (0.2, 0.1), "B": (0.2 + 0.6, 0.1 + 0.8)},
        {"bar": ("A", "B")},
        bar,
        supports={"A": ("x", "y", "rotation")},
        elements=6,
        kind="internal_node",
    )
    system = linear_system(beam)
    assert all(term.constant for term in system.terms)
    mass, stiffness = (system.array(name, 0.0)[0] for name in "MK")
    found = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.min())
    # First root of cos x cosh x = -1, to 16 digits.
    root = 1.875104068711961
    exact = root**2 * np.sqrt(bar.bending_stiffness / bar.mass_per_length)
    assert abs(found / exact - 1.0) < 1e-7


def test_another_length_makes_the_system_anew_and_keeps_its_parameters():
    damped = with_modal_damping(undamped("full", 1), 0.02).with_parameters(elasticity=1.5)
    changed = damped.with_geometry(frame=0.6)
    other = FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.6)
    sections = changed.structure.beams
    expected = linear_system(
        beam_linkage(other, {b.name: b.section for b in sections}, elements=1, joint_masses=MASSES)
    )
    assert changed.parameters["elasticity"] == 1.5
    assert changed.parameters["damping_ratio"] == 0.02
    assert changed.geometry["frame"] == 0.6
    theta = np.array([0.3, 4.0])
    for name in ("M", "K"):
        found, known = changed.array(name, theta), expected.array(name, theta, **elastic(name))
        assert np.array_equal(found, known)
    again = with_modal_damping(expected, 0.02)
    gap = changed.array("C", theta) - again.array("C", theta)
    assert np.max(np.abs(gap)) <= 1e-12 * np.max(np.abs(again.array("C", theta)))


def elastic(name):
    return {"elasticity": 1.5} if name == "K" else {}


def test_systems_travel_to_other_processes():
    theta = np.array([0.3, 4.0])
    for system in (
        linkage_system(FOUR_BAR, SECTIONS, elements=1, joint_masses=MASSES, rayleigh=(1.0, 1e-5)),
        with_modal_damping(undamped("instantaneous", 1), 0.02),
    ):
        copy = pickle.loads(pickle.dumps(system))
        for name in ("M", "A", "C", "K", "Kg", "f", "g"):
            assert np.array_equal(copy.array(name, theta), system.array(name, theta))
        assert copy.structure.labels == system.structure.labels
        assert copy.with_geometry(frame=0.6).geometry["frame"] == 0.6
