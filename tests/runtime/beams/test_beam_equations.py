"""Systems of beams: structure of the equations, frames of closed form, other lengths, copies."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from beam_motions import FOUR_BAR, JOINT_MASSES, SECTIONS
from elastolink.runtime.beams import (
    Section,
    beam_linkage,
    frame,
    linear_system,
    linkage_system,
)
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.systems import with_modal_damping
from periodic_systems import hamiltonian_gap

VISCOUS = {name: replace(section, retardation=2e-5) for name, section in SECTIONS.items()}


def undamped(form, elements=2):
    return linkage_system(
        FOUR_BAR, SECTIONS, form=form, elements=elements, joint_masses=JOINT_MASSES
    )


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
        beam_linkage(
            other, {b.name: b.section for b in sections}, elements=1, joint_masses=JOINT_MASSES
        )
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
        linkage_system(
            FOUR_BAR, VISCOUS, elements=1, joint_masses=JOINT_MASSES, rayleigh=(1.0, 1e-5)
        ),
        with_modal_damping(undamped("instantaneous", 1), 0.02),
    ):
        copy = pickle.loads(pickle.dumps(system))
        for name in ("M", "A", "C", "K", "Kg", "f", "g"):
            assert np.array_equal(copy.array(name, theta), system.array(name, theta))
        assert copy.structure.labels == system.structure.labels
        assert copy.with_geometry(frame=0.6).geometry["frame"] == 0.6
