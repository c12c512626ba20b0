import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.rigid import (
    MassDistribution,
    balance,
    balance_case,
    case_counterweights,
    fully_balanced,
    reciprocating_balance,
)
from elastolink.runtime.rigid.machine import Machine

SPEED = 20.0
TURN = 2.0 * np.pi * np.arange(240) / 240


def bodies(links, seed, across=1.0):
    rng = np.random.default_rng(seed)
    found = {}
    for link in links:
        mass, x, y = rng.uniform([0.2, -0.05, -0.05], [1.0, 0.15, 0.05])
        found[link] = MassDistribution.about_centre(mass, x, across * y, 0.002)
    return found


def slider_crank(seed=1, offset=0.02, across=1.0):
    linkage = SliderCrank(0.1, 0.35, offset)
    return Machine(linkage, bodies(linkage.links, seed, across))


def quick_return(seed=2):
    linkage = QuickReturn(0.3, 0.1, 0.5)
    return Machine(linkage, bodies(linkage.links, seed))


def momentum(machine):
    """Linear momentum of all links from the motion of their centres of mass."""
    motion = machine.linkage.motion(TURN, SPEED)
    total = np.zeros((len(TURN), 2))
    for link in machine.linkage.links:
        own = machine.mass(link)
        if own.mass > 0:
            total += own.mass * motion.point(link, *own.centre).velocity
    return total


@pytest.mark.parametrize(
    ("machine", "case"),
    [
        (slider_crank(), "c"),
        (slider_crank(3, 0.0), "c"),
        (quick_return(), "c"),
        (quick_return(), "d"),
    ],
)
def test_full_balance_leaves_no_momentum(machine, case):
    before = np.ptp(momentum(machine), axis=0).max()
    after = momentum(balance_case(machine, case, 0.08))
    assert np.ptp(after, axis=0).max() < 1e-13 * before
    assert len(case_counterweights(machine, case)) == 2


def test_full_balance_of_each_linkage():
    for machine in (slider_crank(), quick_return()):
        left = momentum(fully_balanced(machine))
        assert np.ptp(left, axis=0).max() < 1e-13


def test_case_b_of_a_slider_crank_is_the_crank_alone():
    assert set(case_counterweights(slider_crank(), "b", 0.1)) == {"crank"}


def test_reciprocating_balance_turns_the_primary_force_across_the_guide():
    machine = slider_crank(offset=0.0, across=0.0)
    amplitude = None
    for fraction in (0.0, 0.4, 1.0):
        found = reciprocating_balance(machine, SPEED, fraction, offset=0.05)
        found.require()
        amplitude = found.reciprocating_mass * 0.1 * SPEED**2
        assert found.along[1] == pytest.approx((1.0 - fraction) * amplitude, abs=1e-10 * amplitude)
        assert found.across[1] == pytest.approx(fraction * amplitude, abs=1e-10 * amplitude)
        # The secondary force, m r omega^2 (r/l + (r/l)^3/4 + 15 (r/l)^5/128), stays.
        ratio = 0.1 / 0.35
        second = amplitude * (ratio + ratio**3 / 4 + 15 * ratio**5 / 128)
        assert found.along[2] == pytest.approx(second, rel=2e-4)  # of the next term's order
        assert found.across[2] < 1e-10 * amplitude
    assert found.plot().lines


def test_best_crank_counterweight_beats_the_usual_fractions():
    machine = slider_crank(offset=0.0, across=0.0)
    best = balance(machine, SPEED, weights={"shaking_force": 1.0}, links=("crank",))
    best.require()
    for fraction in (0.0, 0.5, 2.0 / 3.0, 1.0):
        force = reciprocating_balance(machine, SPEED, fraction).balanced_force
        peak = np.linalg.norm(force, axis=1).max() / best.unbalanced["shaking_force"]
        assert best.value < peak * (1.0 + 1e-12)


def test_quick_return_can_be_optimised():
    found = balance(quick_return(), SPEED, weights={"torque": 1.0, "shaking_force": 1.0})
    found.require()
    assert set(found.counterweights) <= {"crank", "rod"}
    assert found.value < 2.0


@pytest.mark.parametrize(
    "call",
    [
        lambda: balance_case(slider_crank(), "d"),
        lambda: balance_case(slider_crank(), "b", {"slider": -0.1, "crank": -0.1}),
        lambda: reciprocating_balance(Machine(FourBar(0.3, 0.1, 0.3, 0.3)), SPEED),
        lambda: reciprocating_balance(slider_crank(), np.inf),
        lambda: reciprocating_balance(slider_crank(), SPEED, np.nan),
        lambda: reciprocating_balance(slider_crank(), SPEED, offset=0.0),
        lambda: balance(slider_crank(), SPEED, links=("slider",)),
    ],
)
def test_bad_input_is_one_line(call):
    with pytest.raises(BadInput) as caught:
        call()
    assert "\n" not in str(caught.value)
