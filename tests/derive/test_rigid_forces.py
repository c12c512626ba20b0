"""Forces of rigid linkages: derivations of the same numbers, and what each of them refuses."""

from dataclasses import replace
from types import SimpleNamespace

import mpmath
import pytest
import sympy as sp
from derivations import namespace_of
from elastolink.derive.models import four_bar_forces
from elastolink.derive.rigid.newton_euler import balances, solve, unknowns_of
from elastolink.derive.rigid.planar import ETA, XI, MassMoments, Pin
from elastolink.derive.spec import ModelSpec
from force_machines import call, cartesian, eliminate, emitted, random_machines, state_of
from forces_truth import LOADS, MECHANISMS, MOMENTS, forces, loads

FULL = ModelSpec("four_bar", "forces")


@pytest.mark.parametrize("loaded", [False, True], ids=["moving", "loads alone"])
@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_multipliers_and_free_bodies_agree(mechanism, loaded):
    """The emitted closed forms have the digits of the free bodies: ``emitted_accuracy``."""
    reference = (loads if loaded else forces)(mechanism)
    redundant = emitted(f"{mechanism}_multibody")
    for numbers in random_machines(mechanism, loaded=loaded):
        absent = ("speed", "acceleration", *MOMENTS) if loaded else LOADS
        numbers |= dict.fromkeys(absent, 0.0)
        with mpmath.workdps(30):
            exact = reference({name: mpmath.mpf(value) for name, value in numbers.items()})
        size = max(abs(float(value)) for value in exact.values())
        drive = {"drive_d1": numbers["speed"], "drive_d2": numbers["acceleration"]}
        state = numbers | drive | state_of(mechanism, numbers)
        multipliers = cartesian(mechanism, eliminate(redundant, state)[1], numbers)
        assert len(multipliers) == (9 if mechanism == "four_bar" else 10)
        for name, value in multipliers.items():
            assert abs(value - float(exact[name])) < 1e-12 * size, name


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_the_free_linkage_follows_its_torque(mechanism):
    """Forward dynamics under the closed form's torque gives back the acceleration put into it."""
    module = emitted(f"{mechanism}_forces")
    free = namespace_of(ModelSpec(mechanism, "multibody", drop=("drive",)))
    free = SimpleNamespace(**free)
    for numbers in random_machines(mechanism):
        for n in (2, 3, 4):  # a mass that exists: the equations are to be solved for motion
            numbers |= {f"mass{n}": 3.0, f"inertia{n}": 40.0}
        numbers |= dict.fromkeys(LOADS, 0.0)
        numbers["torque"] = call(module, "driving_torque", numbers)["torque"]
        found, _ = eliminate(free, numbers | state_of(mechanism, numbers))
        assert abs(found[2] - numbers["acceleration"]) < 1e-9 * (200 + numbers["speed"] ** 2)


def test_four_numbers_describe_no_other_integral():
    moments = MassMoments(*sp.symbols("m a b j"))
    assert moments.integral(XI**2 + ETA**2 + 3) == sp.Symbol("j") + 3 * sp.Symbol("m")
    for density in (XI**2, XI * ETA, XI**3):
        with pytest.raises(ValueError, match="do not determine"):
            moments.integral(density)


def test_an_indeterminate_linkage_is_refused():
    linkage = four_bar_forces.linkage(FULL)
    zero = (sp.S.Zero, sp.S.Zero)
    doubled = replace(linkage, joints=(*linkage.joints, Pin(1, 3, zero, zero)))
    with pytest.raises(ValueError, match="not determined by statics"):
        solve(balances(doubled), unknowns_of(doubled))
