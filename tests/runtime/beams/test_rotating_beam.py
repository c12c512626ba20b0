"""A beam that turns with its clamp: frequencies against power series and published figures."""

import numpy as np
import pytest
from beam_reference import rotating
from elastolink.runtime.beams import KINDS, Beam, Node, Section, Structure, linear_system
from elastolink.runtime.linkages.linkage import LinkMotion
from periodic_systems import second_order

SECOND = 1e-8  # m^4
# Wright, Smith, Thresher and Wang, J. Appl. Mech. 49 (1982): the lowest frequency across the plane
# of turning, without hub, both over sqrt(EI / (m L^4)); five digits.  In the plane the square of
# the speed is taken away.
PUBLISHED = {1.0: 3.6817, 2.0: 4.1373, 4.0: 5.5850, 10.0: 11.2023}


def turned(theta):
    """Return the motion of a beam along x that turns about its start."""
    none, unit = np.zeros((len(theta), 2)), np.ones(len(theta))
    return {"arm": LinkMotion(none, none, none, theta, unit, 0.0 * unit)}


def arm(kind, elements):
    """Return a slender beam of unit length, EI and mass per length."""
    # Out of reach of shear, so that all kinds mean the same beam.
    section = Section(
        area=1.0, second_moment=SECOND, modulus=1.0 / SECOND, density=1.0, shear_stiffness=1e9
    )
    division = {"elements": elements, "kind": kind}
    return Structure(
        beams=(Beam(name="arm", start="A", end="B", section=section, length=1.0, **division),),
        nodes=(Node(name="A", held=("x", "y", "rotation")), Node(name="B")),
        configuration=turned,
    )


def exponents(system, speed):
    """Return the eigenvalues as seen by one who turns with the beam."""
    stiffness, damping, mass, _ = (part[0] for part in second_order(system, 0.0, speed))
    # q = T(theta) y: at theta = 0 the two are one, and qd = yd + speed P y.
    turning = np.zeros_like(mass)
    for i, label in enumerate(system.labels):
        stem, part = label.rsplit(".", 1)
        if part == "x":
            j = system.labels.index(f"{stem}.y")
            turning[i, j], turning[j, i] = -1.0, 1.0
    seen = stiffness + speed * damping @ turning + speed**2 * mass @ turning @ turning
    rates = np.hstack([seen, damping + 2 * speed * mass @ turning])
    n = len(mass)
    return np.linalg.eigvals(np.vstack([np.eye(2 * n)[n:], -np.linalg.solve(mass, rates)]))


def frequencies(structure, speed):
    values = exponents(linear_system(structure), speed)
    return np.sort(values.imag[values.imag > 0.0])


@pytest.mark.parametrize("speed", list(PUBLISHED))
def test_the_power_series_repeats_the_published_figures(speed):
    published = np.sqrt(PUBLISHED[speed] ** 2 - speed**2)
    # Half a unit of the last digit before the square was taken away.
    allowed = 0.6e-4 * PUBLISHED[speed] / published
    assert abs(rotating(speed, 1e10, published) - published) < allowed


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("speed", [2.0, 10.0])
def test_a_turning_beam_has_the_frequencies_of_the_power_series(kind, speed):
    known = rotating(speed, 1.0 / SECOND, np.sqrt(PUBLISHED[speed] ** 2 - speed**2))
    errors = [frequencies(arm(kind, n), speed)[0] / known - 1.0 for n in (4, 8, 16)]
    # Cubic elements are of fourth order in the frequency.
    if kind in ("cubic", "timoshenko"):
        assert errors[1] < errors[0] / 8 and errors[2] < errors[1] / 8, errors
    assert abs(errors[2]) < (2e-5 if kind in ("cubic", "timoshenko") else 1e-6), errors


def test_without_geometric_stiffness_the_beam_flies_apart():
    structure = arm("cubic", 4)
    plain = linear_system(structure, geometric_stiffness=False)
    # Centripetal softening alone: growth at the rate sqrt(10^2 - 3.516^2), 1.875104^4 = 3.516^2.
    rate = np.max(exponents(plain, 10.0).real)
    assert abs(rate - np.sqrt(100.0 - 1.875104068711961**4)) < 1e-3
    assert np.max(np.abs(exponents(linear_system(structure), 10.0).real)) < 1e-6
