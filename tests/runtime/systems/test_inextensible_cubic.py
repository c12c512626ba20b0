"""The inextensible coupler to third order against the exact equations."""

import numpy as np
import pytest
from bent_rigs import slider_crank
from elastolink import load_scene
from elastolink.runtime.core.families import Drive
from elastolink.runtime.nonlinear import response_curve

SCENE = "smith_1972_101104_thirtysecond_inch"
RPM = np.pi / 30.0
# Everything that the equations know: damping, an initial bow, gravity across the frame.
ALL = {"coupler.damping": "3 N s/m^2", "coupler.bow": "1 mm", "gravity.direction": "-70 deg"}
MACHINES = ["four-bar, open", "four-bar, crossed", "slider-crank, open", "slider-crank, crossed"]
MODES = [1, 2]
SPEED, ACCELERATION = 40.0, 300.0


def system(machine, formulation, modes):
    kind, assembly = machine.split(", ")
    changes = {**ALL, "model.formulation": formulation, "links.assembly": assembly}
    if kind == "slider-crank":
        return slider_crank(modes, **changes)
    more = {"model.modes": modes, "follower.first_moment": "0.01 kg m"}
    return load_scene(SCENE, {**changes, **more}).system()


def pair(machine, modes):
    return [system(machine, f, modes) for f in ("inextensible", "inextensible_cubic")]


def states(modes, count=200, seed=18):
    """Return states of order one, their rates over the crank's speed, and crank angles."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(3, count, modes)), rng.uniform(0.0, 2.0 * np.pi, count)


def varied(one, amplitude, modes):
    (q, qd, qdd), theta = states(modes)
    rates = amplitude * SPEED * qd, amplitude * SPEED**2 * qdd
    drive = Drive(theta, SPEED, ACCELERATION)
    return one.equations(amplitude * q, *rates, drive, one.parameters)


@pytest.mark.parametrize("modes", MODES)
@pytest.mark.parametrize("machine", MACHINES)
def test_what_is_left_out_is_of_fourth_order(machine, modes):
    """And of third order in the derivatives by the state.

    The next order is left out by taking states of either sign together.
    """
    exact, cubic = pair(machine, modes)

    def gap(name, amplitude):
        return getattr(varied(exact, amplitude, modes), name) - getattr(
            varied(cubic, amplitude, modes), name
        )

    sizes = np.array([2.0**-6, 2.0**-7, 2.0**-8])
    for name, order in {"residual": 4, "mass": 3, "damping": 3, "stiffness": 3}.items():
        sign = (-1) ** order
        gaps = [np.linalg.norm(gap(name, a) + sign * gap(name, -a)) for a in sizes]
        slopes = np.diff(np.log(gaps)) / np.diff(np.log(sizes))
        assert slopes == pytest.approx(order, abs=0.1), name


@pytest.mark.parametrize("modes", MODES)
@pytest.mark.parametrize("machine", MACHINES)
def test_linear_parts_are_equal(machine, modes):
    exact, cubic = (varied(one, 0.0, modes) for one in pair(machine, modes))
    for name in ("residual", "mass", "damping", "stiffness"):
        expected, found = getattr(exact, name), getattr(cubic, name)
        np.testing.assert_allclose(found, expected, rtol=0, atol=2e-12 * np.abs(expected).max())


@pytest.mark.parametrize("modes", MODES)
@pytest.mark.parametrize("machine", MACHINES)
def test_derivatives_are_those_of_the_residual(machine, modes):
    """By complex steps through the emitted function, at amplitudes of one."""
    cubic = system(machine, "inextensible_cubic", modes)
    (q, qd, qdd), theta = states(modes, count=5)
    drive = Drive(theta, SPEED, ACCELERATION)
    rates = SPEED * qd, SPEED**2 * qdd
    found = cubic.equations(q, *rates, drive, cubic.parameters)
    module = cubic.equations.make(cubic.parameters, drive).dynamics.module
    values = cubic.equations.make(cubic.parameters, drive).dynamics.values

    def residual(*state):
        vectors = [list(np.moveaxis(v, -1, 0)) for v in state]
        returned = module.dynamics(*vectors[0], *vectors[1], 0.0, *drive, *values.values())
        arrays = {}
        for name in ("mass", "rest", "forces"):
            shape, filled = module.ARRAYS["dynamics"][name]
            arrays[name] = np.zeros((len(theta), *shape), dtype=complex)
            for i, j, at in filled:
                arrays[name][:, i, j] = returned[at]
        inertia = arrays["mass"] @ state[2][..., None]
        return (inertia + arrays["rest"] - arrays["forces"])[..., 0]

    state = [q.astype(complex), *(rate.astype(complex) for rate in rates)]
    np.testing.assert_allclose(found.residual, residual(*state).real, rtol=1e-12)
    for place, name in enumerate(("stiffness", "damping", "mass")):
        for k in range(modes):
            moved = [part.copy() for part in state]
            moved[place][:, k] += 1e-30j
            column = residual(*moved).imag / 1e-30
            scale = np.abs(getattr(found, name)).max()
            gap = np.abs(getattr(found, name)[..., k] - column).max()
            assert gap <= 1e-12 * scale


@pytest.mark.parametrize("machine", MACHINES)
def test_held_still_without_damping_it_keeps_its_energy(machine):
    """The rate of the kinetic energy is the power of the inertia forces, at any amplitude."""
    cubic = system(machine, "inextensible_cubic", 2).with_parameters(damping=0.0)
    (q, qd, qdd), theta = states(2, count=20)
    drive = Drive(theta, 0.0)
    step = 1e-5

    def at(place, rate, acceleration):
        return cubic.equations(place, rate, acceleration, drive, cubic.parameters)

    none = np.zeros_like(q)
    power = np.sum(qd * (at(q, qd, qdd).residual - at(q, none, none).residual), axis=-1)
    before, mass, after = (at(q + s * qd, qd, none).mass for s in (-step, 0.0, step))
    slope = (after - before) / (2.0 * step)  # exact: the mass is of second order in q
    expected = np.einsum("bi,bij,bj->b", qd, mass, qdd)
    expected += np.einsum("bi,bij,bj->b", qd, slope, qd) / 2.0
    np.testing.assert_allclose(power, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


def test_other_numbers_of_modes_are_derived_on_demand():
    with pytest.raises(ValueError, match=r'regenerate-equations .*"modes": 3'):
        system("four-bar, open", "inextensible_cubic", 3)


@pytest.mark.slow
def test_folds_lie_within_a_thousandth_of_the_exact_ones():
    """Smith's 1/32 in rig at 3 % damping, one mode: 356.058 and 351.440 rpm."""
    folds = []
    for formulation in ("inextensible", "inextensible_cubic"):
        scene = load_scene(SCENE, {"model.formulation": formulation})
        coupler, length = scene["coupler"], scene["links"]["coupler"]
        stiffness, density = coupler["bending_stiffness"], coupler["mass_per_length"]
        frequency = (np.pi / length) ** 2 * np.sqrt(stiffness / density)
        one = scene.system().with_parameters(damping=2.0 * 0.03 * frequency * density)
        curve = response_curve(one, "speed", (300.0 * RPM, 400.0 * RPM))
        assert curve.special == ("fold", "fold")
        folds.append(curve.special_value / RPM)
    exact, cubic = folds
    np.testing.assert_allclose(exact, [356.17070, 351.75525], rtol=0, atol=1e-5)
    gap = 1.0 - cubic / exact
    assert gap == pytest.approx([3.2e-4, 9.0e-4], abs=1e-5)
