"""Systems of beams: structure of the equations, frames of closed form, other lengths, copies."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from beam_motions import SECTIONS, damped_four_bar, four_bar
from elastolink.runtime.beams import frame, linkage_system
from elastolink.runtime.linkages import QuickReturn
from periodic_systems import hamiltonian_gap

VISCOUS = {name: replace(section, retardation=2e-5) for name, section in SECTIONS.items()}


def sliding():
    bars = {name: SECTIONS["crank"] for name in ("crank", "rod")}
    return linkage_system(QuickReturn(frame=0.6, crank=0.13, rod=1.0), bars, elements=1)


def test_the_full_form_is_hamiltonian_and_the_instantaneous_is_not():
    angles = np.linspace(0.0, 6.0, 7)
    # A high speed keeps the elastic forces from hiding the gyroscopic ones.
    assert hamiltonian_gap(four_bar(2), 1e5, angles) < 1e-14
    assert hamiltonian_gap(sliding(), 1e5, angles) < 1e-13
    assert hamiltonian_gap(four_bar(2, form="instantaneous"), 1e5, angles) > 1e-3


def test_a_torsion_damper_bends_the_end_of_a_beam():
    # Its moment needs a curvature at the end: without damper, spring or inertia there is none.
    bare, damped = (
        frame(
            {"A": (0.0, 0.0), "B": (0.0, 1.0)},
            {"a": ("A", "B")},
            SECTIONS["crank"],
            supports={"A": ("x", "y", "rotation")},
            kind="curvature",
            elements=1,
            nodes={"B": values},
        )
        for values in ({}, {"damping": {"rotation": 0.1}})
    )
    assert set(damped.labels) - set(bare.labels) == {"B.a.curvature"}


@pytest.mark.parametrize(
    "system",
    [four_bar(1, VISCOUS, rayleigh=(1.0, 1e-5)), damped_four_bar(form="instantaneous"), sliding()],
)
def test_systems_travel_to_other_processes(system):
    theta = np.array([0.3, 4.0])
    copy = pickle.loads(pickle.dumps(system))
    for name in ("M", "A", "C", "K", "Kg", "f", "g"):
        if system.has(name):
            assert np.array_equal(copy.array(name, theta), system.array(name, theta))
    assert copy.labels == system.labels
    assert copy.with_geometry(frame=0.62).geometry["frame"] == 0.62
