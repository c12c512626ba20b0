"""Forces of rigid linkages: derivations of the same numbers, and what each of them refuses."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
import sympy as sp
from derivations import namespace_of
from elastolink.derive.lagrange import euler_lagrange
from elastolink.derive.models import four_bar_forces
from elastolink.derive.rigid.multibody import lagrangian
from elastolink.derive.rigid.newton_euler import (
    balances,
    solve,
    unknowns_of,
)
from elastolink.derive.rigid.planar import ETA, XI, MassMoments, Pin
from elastolink.derive.spec import ModelSpec
from force_machines import (
    call,
    cartesian,
    eliminate,
    emitted,
    random_machine,
    state_of,
)
from forces_truth import LOADS, MECHANISMS, forces, loads

FULL = ModelSpec("four_bar", "forces")


# ---------------------------------------------------------------- three ways to the same numbers


@pytest.mark.parametrize("loaded", [False, True], ids=["moving", "loads alone"])
@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_multipliers_and_free_bodies_agree(mechanism, loaded):
    """The emitted closed forms have the digits of the free bodies: ``emitted_accuracy``."""
    random = np.random.default_rng(8 if loaded else 7)
    reference = (loads if loaded else forces)(mechanism)
    redundant = emitted(f"{mechanism}_multibody")
    for _ in range(30):
        numbers = random_machine(mechanism, random)
        numbers |= {"speed": 0.0, "acceleration": 0.0} if loaded else dict.fromkeys(LOADS, 0.0)
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
    random = np.random.default_rng(9)
    module = emitted(f"{mechanism}_forces")
    free = namespace_of(ModelSpec(mechanism, "multibody", drop=("drive",)))
    free = SimpleNamespace(**free)
    for _ in range(20):
        numbers = random_machine(mechanism, random)
        for n in (2, 3, 4):  # a mass that exists: the equations are to be solved for motion
            numbers |= {f"mass{n}": 3.0, f"inertia{n}": 40.0}
        numbers |= dict.fromkeys(LOADS, 0.0)
        numbers["torque"] = call(module, "driving_torque", numbers)["torque"]
        found, _ = eliminate(free, numbers | state_of(mechanism, numbers))
        assert abs(found[2] - numbers["acceleration"]) < 1e-9 * (200 + numbers["speed"] ** 2)


# ---------------------------------------------------------------- derived means derived


def test_a_point_mass_in_the_energies_moves_the_forces_as_its_moments_do():
    """Only the kinetic energy is changed; the multipliers follow as by hand."""
    m, a, b = 0.7, 1.3, -0.4
    plain = lagrangian(FULL, four_bar_forces.linkage(FULL))
    coupler = [sp.Function(name)(plain.t) for name in ("x3", "y3", "angle3")]
    place = (
        coupler[0] + a * sp.cos(coupler[2]) - b * sp.sin(coupler[2]),
        coupler[1] + a * sp.sin(coupler[2]) + b * sp.cos(coupler[2]),
    )
    speed2 = sum(part.diff(plain.t) ** 2 for part in place)
    heavier = replace(plain, expression=plain.expression + sp.Float(m) / 2 * speed2)
    found = _multipliers(euler_lagrange(heavier))
    numbers = _hand_machine()
    numbers |= {
        "mass3": numbers["mass3"] + m,
        "along3": numbers["along3"] + m * a,
        "across3": numbers["across3"] + m * b,
        "inertia3": numbers["inertia3"] + m * (a**2 + b**2),
    }
    expected = call(emitted("four_bar_forces"), "forces", numbers)
    for name, value in found.items():
        assert value == pytest.approx(expected[name], rel=1e-11), name


def _hand_machine():
    return random_machine("four_bar", np.random.default_rng(12))


def _multipliers(equations):
    """Solve symbolic equations of motion numerically at the pose of :func:`_hand_machine`."""
    numbers = _hand_machine() | dict.fromkeys(LOADS, 0.0)
    state = numbers | state_of("four_bar", numbers)
    drive = sp.Function("drive")(equations.t)
    values = {
        drive.diff(equations.t, 2): numbers["acceleration"],
        drive.diff(equations.t): numbers["speed"],
        drive: numbers["theta2"],
    }

    def number(matrix):
        matrix = matrix.subs(values)
        named = {s: state[s.name] for s in matrix.free_symbols if s.name in state}
        return np.array(matrix.subs(named).evalf(), dtype=float)

    mass, jacobian = number(equations.mass), number(equations.jacobian)
    right = [number(equations.forces) - number(equations.rest), number(equations.gamma)]
    zero = np.zeros((len(jacobian), len(jacobian)))
    whole = np.block([[mass, -jacobian.T], [jacobian, zero]])
    solution = np.linalg.solve(whole, np.concatenate(right)[:, 0])[9:]
    return {m.name: value for m, value in zip(equations.multipliers, solution, strict=True)}


# ---------------------------------------------------------------- refusals


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
