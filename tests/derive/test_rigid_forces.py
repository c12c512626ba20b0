"""Forces of rigid linkages: derivations of the same numbers, and what each of them refuses."""

import importlib
import inspect
from dataclasses import replace
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
import sympy as sp
from derivations import namespace_of
from elastolink.derive.models import four_bar_forces
from elastolink.derive.rigid.newton_euler import balances, solve, unknowns_of
from elastolink.derive.rigid.planar import ETA, XI, MassMoments, Pin
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families.emitted import array_function
from forces_truth import LOADS, MECHANISMS, MOMENTS, forces, links, loads, points

LENGTHS = ("frame", "crank", "coupler", "follower", "offset")
FULL = ModelSpec("four_bar", "forces")


def emitted(name):
    return importlib.import_module(f"elastolink.generated.{name}")


def call(module, function, numbers):
    """Return what an emitted function returns, by name."""
    kernel = getattr(module, function)
    values = kernel(**{name: numbers[name] for name in inspect.signature(kernel).parameters})
    values = values if isinstance(values, tuple) else (values,)
    return dict(zip(module.RETURNS[function], values, strict=True))


def random_machines(mechanism, *, loaded=False):
    """Yield numbers of random linkages with cranks of 1 m, all masses or all loads at random."""
    for point in points(mechanism, loaded=loaded)[:80:3]:
        size = point.inputs["crank"]
        lengths = {k: v / size for k, v in point.inputs.items() if k in LENGTHS}
        yield dict(point.arguments) | lengths


def state_of(mechanism, numbers):
    """Return coordinates and velocities of the free bodies, from the exact pose."""
    with mpmath.workdps(30):
        exact = {name: mpmath.mpf(v) for name, v in numbers.items()}
        bodies, _ = links(mechanism, exact)
        step = mpmath.mpf(10) ** -12
        ahead = {**exact, "theta2": exact["theta2"] + step}
        behind = {**exact, "theta2": exact["theta2"] - step}
        state = {}
        for n, body in enumerate(bodies, start=2):
            after, before = (links(mechanism, e)[0][n - 2] for e in (ahead, behind))
            moved = (after[0] - before[0]) / (2 * step) * exact["speed"]
            turned = mpmath.im((after[2] - before[2]) / body[2]) / (2 * step) * exact["speed"]
            state |= {
                f"x{n}": body[0].real,
                f"y{n}": body[0].imag,
                f"angle{n}": mpmath.arg(body[2]),
                f"x{n}_dot": moved.real,
                f"y{n}_dot": moved.imag,
                f"angle{n}_dot": turned,
            }
        return {name: float(value) for name, value in state.items()}


def cartesian(mechanism, found, numbers):
    """Return multipliers as the forces are named: a slide's normal as components."""
    if mechanism == "slider_crank":
        found = {**found, "x41": 0.0, "y41": found["normal41"]}
    if mechanism == "quick_return":
        angle = state_of(mechanism, numbers)["angle4"]
        normal = found["normal34"]
        found = {**found, "x34": -normal * np.sin(angle), "y34": normal * np.cos(angle)}
    return {name: value for name, value in found.items() if not name.startswith("normal")}


def eliminate(module, numbers):
    """Return accelerations and multipliers of an emitted module at one state, by elimination."""
    names = inspect.signature(module.dynamics).parameters
    filled = array_function(module, "dynamics")(**{name: numbers.get(name, 0.0) for name in names})
    jacobian = filled["jacobian"]
    rows = len(jacobian)
    whole = np.block([[filled["mass"], -jacobian.T], [jacobian, np.zeros((rows, rows))]])
    right = np.concatenate([filled["forces"] - filled["rest"], filled["gamma"]])[:, 0]
    solution = np.linalg.solve(whole, right)
    return solution[:9], dict(zip(module.MULTIPLIERS, solution[9:], strict=True))


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
