"""Pin forces and driving torque of elastic linkages: the rigid limit, and balances."""

from itertools import product

import beam_motions as motions
import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.beams import linear_system
from elastolink.runtime.recovery.strain_energy import beam_energies

SLIDER = el.SliderCrank(crank=0.1, coupler=0.37, offset=0.06)


def gaps_to_rigid(elasticity):
    """Return the largest differences from the rigid machine, over the largest force or torque."""
    system = motions.damped_four_bar(gravity=(0.0, -9.81)).with_parameters(elasticity=elasticity)
    found = el.pin_reactions(system, motions.periodic_motion(system, 30.0))
    masses = {"crank": motions.JOINT_MASSES["B"], "follower": motions.JOINT_MASSES["C"]}
    rigid = el.rigid_forces(motions.rigid_machine(motions.FOUR_BAR, masses), found.theta, 30.0)
    pairs = {
        "A": (found.of_ground["A"][:, :2], rigid.f12),
        "B": (found.force("B", "coupler"), rigid.f23),
        "C": (-found.force("C", "coupler"), rigid.f34),
        "D": (-found.of_ground["D"][:, :2], rigid.f41),
    }
    size = np.max(np.abs(rigid.f12))
    gaps = [np.max(np.abs(ours - theirs)) / size for ours, theirs in pairs.values()]
    torque = np.max(np.abs(found.torque() - rigid.torque)) / np.max(np.abs(rigid.torque))
    return np.array([*gaps, torque])


def test_rigid_limit_of_the_four_bar():
    # (w/w_1)^2 = (30/184)^2 = 0.027 over the factor of the modulus.
    softer, stiffer = gaps_to_rigid(1e4), gaps_to_rigid(1e6)
    assert np.all(stiffer <= 1e-6)
    np.testing.assert_allclose(softer / stiffer, 100.0, rtol=0.05)


def test_rigid_limit_of_the_slider_crank():
    system = el.linkage_system(
        SLIDER,
        {name: motions.SECTIONS[name] for name in ("crank", "coupler")},
        joint_masses={"C": 0.3},
        elements=2,
        gravity=(0.0, -9.81),
    ).with_parameters(elasticity=1e6)
    found = el.pin_reactions(system, motions.periodic_motion(system, 30.0))
    rigid = el.rigid_forces(motions.rigid_machine(SLIDER, {"slider": 0.3}), found.theta, 30.0)
    size = np.max(np.abs(rigid.f12))
    assert np.max(np.abs(found.force("B", "coupler") - rigid.f23)) <= 1e-5 * size
    # The guide pushes across alone, and the ground there takes nothing along.
    assert np.max(np.abs(found.of_ground["C"][:, 1] + rigid.f41[:, 1])) <= 1e-5 * size
    assert np.max(np.abs(found.of_ground["C"][:, 0])) <= 1e-8 * size
    assert np.max(np.abs(found.torque() - rigid.torque)) <= 1e-5 * np.max(np.abs(rigid.torque))


@pytest.mark.parametrize("kind", ["cubic", "internal_node", "curvature"])
def test_forces_balance_to_round_off(kind):
    system = motions.damped_four_bar(kind=kind, gravity=(0.0, -9.81))
    found = el.pin_reactions(system, motions.periodic_motion(system, 25.0))
    assert found.checks["balance"].value <= 1e-10
    # Action and reaction with the joint's inertia: the coupler's and the follower's pin.
    lumped = motions.JOINT_MASSES["C"]
    total = found.force("C", "coupler") + found.force("C", "follower")
    assert np.max(np.abs(total)) > 0.01 * lumped * 25.0**2


def test_reactions_of_a_frame_by_hand():
    # A portal's support forces: weight of 3 bars and a push of 5 N at a corner.
    structure = el.frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        motions.BAR,
        supports={"A": ("x", "y", "rotation"), "D": ("x", "y", "rotation")},
        nodes={"B": {"force": (5.0, 0.0)}},
    )
    system = linear_system(structure, gravity=(0.0, -9.81), geometric_stiffness=False)
    found = el.pin_reactions(system)
    total = found.of_ground["A"][0] + found.of_ground["D"][0]
    weight = 3.0 * motions.BAR.mass_per_length * 9.81
    np.testing.assert_allclose(total[:2], [-5.0, weight], rtol=1e-7)
    # Moments about A: the push at height 1, the weight at x = 1/2, the support at D.
    moment = total[2] + found.of_ground["D"][0, 1] * 1.0
    assert moment == pytest.approx(5.0 * 1.0 + 0.5 * weight, rel=1e-7)


def test_torque_is_that_of_the_energy_to_second_order_with_the_axial_forces():
    # With geometric stiffness the moment at the clamp and the generalised force of the crank
    # angle differ by squares of the displacement; without it by its first power.
    gaps = {}
    for stiffening, elasticity in product((True, False), (10.0, 100.0)):
        system = motions.four_bar(geometric_stiffness=stiffening).with_parameters(
            elasticity=elasticity
        )
        motion = motions.periodic_motion(system, 10.0, 96)
        gap = el.pin_reactions(system, motion).torque() - beam_energies(system, motion).torque
        gaps[stiffening, elasticity] = np.max(np.abs(gap))
    assert gaps[True, 10.0] / gaps[True, 100.0] == pytest.approx(100.0, rel=0.5)
    assert gaps[False, 10.0] / gaps[False, 100.0] == pytest.approx(10.0, rel=0.1)
    assert gaps[True, 100.0] < 1e-3 * gaps[False, 100.0]


def test_names_that_are_not_there_are_refused():
    system = motions.turning_bar(motions.rocking, elements=1)
    found = el.pin_reactions(system, motions.periodic_motion(system, 5.0, 16))
    with pytest.raises(el.BadInput, match="force"):
        found.force("P", "rod")
    with pytest.raises(el.BadInput, match="node"):
        found.torque("P")
    assert "ground on O moment" in found.arrays()
    assert found.plot().get_ylabel() == "force [N]"
