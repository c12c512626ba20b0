"""Energies of beams: the balance of power, and strain energies by hand."""

from dataclasses import replace

import beam_motions as motions
import numpy as np
import pytest
from elastolink.runtime.beams import KINDS
from elastolink.runtime.recovery.strain_energy import beam_energies
from elastolink.runtime.systems import with_modal_damping

VISCOUS = {name: replace(s, retardation=3e-5) for name, s in motions.SECTIONS.items()}
SPRUNG = {
    "D": {"held": ("y",), "stiffness": {"x": 1e6}, "damping": {"x": 200.0}, "force": (3.0, 4.0)}
}
CASES = {
    "modal": (motions.SECTIONS, {}, 0.02),
    "without axial forces": (motions.SECTIONS, {"geometric_stiffness": False}, 0.02),
    "weight and Rayleigh": (
        motions.SECTIONS,
        {"rayleigh": (3.0, 1e-4), "gravity": (0.0, -9.81)},
        None,
    ),
    "viscous on springs": (VISCOUS, {"nodes": SPRUNG}, None),
}


@pytest.mark.parametrize("case", CASES)
def test_power_of_the_drive_is_rate_of_energy_and_loss(case):
    sections, options, ratio = CASES[case]
    system = motions.four_bar(1, sections, **options)
    if ratio is not None:
        system = with_modal_damping(system, ratio)
    found = beam_energies(system, motions.periodic_motion(system, 20.0, 128))
    # Virtual work against the Fourier series of the energy, of 63 harmonics of squares of q.
    assert found.checks["balance"].value <= 1e-6
    assert np.mean(found.dissipated) > 0.0
    # Over a cycle the drive and the loads pay for the loss.
    paid = np.mean(found.drive + found.loads)
    assert paid == pytest.approx(np.mean(found.dissipated), rel=1e-6)
    # Elements with rotary inertia, without a loss.
    bar = motions.turning_bar(motions.rocking, kind="timoshenko", elements=2)
    assert beam_energies(bar, motions.periodic_motion(bar, 8.0, 64)).checks["balance"].value <= 1e-9


@pytest.mark.parametrize("kind", KINDS)
def test_strain_energy_of_a_cantilever_by_hand(kind):
    # F^2 L^3 / 6EI and N^2 L / 2EA; of shear F^2 L / 2kGA.
    found = beam_energies(motions.cantilever(kind, force=(700.0, 4.0)))
    expected = 16.0 / (6.0 * motions.BAR.bending_stiffness) + 700.0**2 / (
        2.0 * motions.BAR.axial_stiffness
    )
    if kind == "timoshenko":
        expected += 16.0 / (2.0 * motions.BAR.shear_stiffness)
    assert found.peak == pytest.approx(expected, rel=1e-7)
    assert found.kinetic[0] == 0.0


def test_kinetic_energy_of_stiff_links_is_that_of_rigid_ones():
    system = motions.four_bar().with_parameters(elasticity=1e8)
    found = beam_energies(system, motions.periodic_motion(system, 10.0))
    masses = {"crank": motions.JOINT_MASSES["B"], "follower": motions.JOINT_MASSES["C"]}
    rigid = motions.rigid_machine(motions.FOUR_BAR, masses).kinetic_energy(found.theta, 10.0)
    np.testing.assert_allclose(found.kinetic, rigid, rtol=1e-8)


def test_instantaneous_form_has_no_balance_and_a_picture_all_links():
    system = motions.four_bar(form="instantaneous")
    found = beam_energies(system, motions.periodic_motion(system, 10.0))
    assert "balance" not in found.checks
    labels = [text.get_text() for text in found.plot().get_legend().get_texts()]
    assert labels == ["crank", "coupler", "follower", "all"]
