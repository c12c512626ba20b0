"""Derivatives of motion and forces by a complex step, against sixty digits and differences."""

from dataclasses import replace

import elastolink as el
import mpmath
import numpy as np
import pytest
from elastolink.runtime.rigid.evaluation import ParametricMachine
from forces_truth import forces as exact_forces
from linkage_truth import motion as four_bar_motion
from sliding_truth import rod_motion, slider_motion

THETA = np.linspace(0.0, 2.0 * np.pi, 37)
FOUR_BAR = el.FourBar(0.5, 0.1, 0.45, 0.22)
DRAG_LINK = el.FourBar(2.0, 4.0, 5.0, 4.5, "crossed")
SLIDER = el.SliderCrank(0.04, 0.14, 0.01)
SHAPER = el.QuickReturn(0.25, 0.1, 0.5)
LINKAGES = (FOUR_BAR, DRAG_LINK, SLIDER, SHAPER)
BODY = el.MassDistribution.about_centre(0.7, 0.06, 0.01, 0.004)


MOTIONS = {
    el.FourBar: ("four_bar", four_bar_motion),
    el.SliderCrank: ("slider_crank", slider_motion),
    el.QuickReturn: ("quick_return", rod_motion),
}
EVERY = pytest.mark.parametrize("linkage", LINKAGES, ids=lambda item: type(item).__name__)


def machine_of(linkage, **more):
    return el.Machine(linkage, dict.fromkeys(linkage.links, BODY), **more)


def springs_of(linkage):
    """Springs and dampers of both kinds between all links and the frame."""
    second, third, fourth = linkage.links
    return (
        el.Spring(("frame", 0.1, 2.0), (third, 0.05, 0.02), 30.0, 0.1, damping=2.0, preload=3.0),
        el.Spring((second, 0.02, -0.01), (fourth, 0.03, 1.5), 20.0, 0.2),
        el.Spring(("frame", 0.0, -0.3), (fourth, 0.1, 0.0), 5.0),
        el.TorsionSpring(second, fourth, 2.0, 0.3, damping=0.1),
        el.TorsionSpring("frame", third, 1.0, preload=0.2),
    )


def exact(machine, theta, speed, acceleration):
    """Return numbers by parameter's name, and the exact outputs as their function."""
    mechanism, motion = MOTIONS[type(machine.linkage)]
    numbers = {name: mpmath.mpf(size) for name, size in machine.linkage.lengths.items()}
    numbers["theta2"] = mpmath.mpf(theta)
    for link in machine.linkage.links:
        numbers |= {f"{link}.{k}": mpmath.mpf(v) for k, v in vars(machine.mass(link)).items()}

    def outputs(values):
        given = {name: values[name] for name in machine.linkage.lengths}
        given |= {"theta2": values["theta2"], "assembly": mpmath.mpf(machine.linkage.branch)}
        m = dict(motion(given))
        for place, link in enumerate(machine.linkage.links, start=2):
            for name in vars(machine.mass(link)):
                given[f"{name}{place}"] = values[f"{link}.{name}"]
        given |= {"speed": mpmath.mpf(speed), "acceleration": mpmath.mpf(acceleration)}
        for w in {"omega3", "omega4", "slider_velocity", "slide_velocity"} & set(m):
            a = w.replace("omega", "alpha").replace("velocity", "acceleration")
            m[w], m[a] = m[w] * speed, m[a] * speed**2 + m[w] * acceleration
        return m | exact_forces(mechanism)(given)

    return numbers, outputs


def model_of(machine, theta, speed, acceleration):
    """Return motion and forces of a machine as functions of its numbers."""
    drive = (np.full(len(theta), one) for one in (speed, acceleration))
    return ParametricMachine(machine.linkage, theta, *drive, machine=machine)


@EVERY
def test_every_derivative_against_sixty_digits(linkage):
    machine = machine_of(linkage)
    angles, speed, acceleration = np.array([0.3, 4.4]), 7.0, -11.0
    model = model_of(machine, angles, speed, acceleration)
    parameters = tuple(model.values)
    nominal, slopes = model.derivatives(model.values, parameters)
    with mpmath.workdps(60):
        step = mpmath.mpf(10) ** -30
        for at, theta in enumerate(angles):
            numbers, outputs = exact(machine, theta, speed, acceleration)
            here = outputs(numbers)
            for place, parameter in enumerate(parameters):
                there = outputs({**numbers, parameter: numbers[parameter] + step})
                for name, found in slopes.items():
                    slope = float((there[name] - here[name]) / step)
                    size = np.abs(found[:, at]).max() + abs(nominal[name][at])
                    assert found[place, at] == pytest.approx(slope, rel=1e-11, abs=1e-12 * size), (
                        name,
                        parameter,
                    )


@EVERY
def test_values_and_slopes_are_those_of_motion_and_forces(linkage):
    """With weights, loads and springs: nominal values, and their differences over the crank."""
    loads = (
        el.Load(linkage.links[1], (3.0, -2.0), couple=0.4, along=0.05, across=0.02),
        el.Load(linkage.links[2], (1.0, 5.0), along=0.03, axes="link"),
    )

    def built(crank):
        moved = replace(linkage, crank=crank)
        springs = springs_of(linkage)
        return machine_of(moved, gravity=(0.3, -9.81), loads=loads, springs=springs)

    size = linkage.lengths["crank"]
    model = model_of(built(size), THETA, 9.0, 4.0)
    nominal, slopes = model.derivatives(model.values, ("crank",))
    motion = linkage.motion(THETA, 9.0, 4.0)
    forces = el.rigid_forces(built(size), THETA, 9.0, 4.0).values
    for name, values in nominal.items():
        expected = forces[name] if name in forces else getattr(motion, name)
        np.testing.assert_allclose(values, expected, rtol=1e-11, atol=1e-11)
    step = 1e-5 * size
    above, below = (
        el.rigid_forces(built(size + sign * step), THETA, 9.0, 4.0).values for sign in (1, -1)
    )
    for name in forces:
        slope = (above[name] - below[name]) / (2.0 * step)
        # Third order: step^2 over the crank's square, 1e-10; round-off: 1e-16 over the step.
        atol = 1e-8 * np.abs(slope).max() + 1e-9 * np.abs(above[name]).max() / size
        np.testing.assert_allclose(slopes[name][0], slope, rtol=0, atol=atol)
