"""The package's own derivation against the ledger's, and against numeric truth."""

import numpy as np
import pytest
import seed_machine as machine
import sympy as sp
from seed_derivations import (
    EI,
    alpha3,
    alpha4,
    force_x,
    l2,
    l3,
    l4,
    linear_beam,
    mu,
    omega2,
    omega3,
    projected,
    theta2,
    theta3,
    theta4,
)
from seed_truth import (
    CRANK_ROCKERS,
    pin_force_on_coupler,
)


def test_field_equation_and_tension():
    assert sp.expand(sp.expand(machine.tension()) - sp.expand(linear_beam()["tension"])) == 0
    assert sp.expand(machine.equation() - linear_beam()["equation"]) == 0
    for condition in machine.end_conditions():
        assert sp.expand(condition**2 - EI**2 * machine.y_xx**2) == 0
    assert len(machine.end_conditions()) == 2


@pytest.mark.smoke
def test_pin_force():
    lengths = CRANK_ROCKERS["5,1,5,2"]
    masses, places, follower, speed = (0.2, 0.5, 0.3), (0.7, 2.8, 4.6), 0.4, 3.0
    force, m = pin_force_on_coupler(lengths, follower, masses, places, speed)
    true = force * np.exp(-1j * m.theta3)
    symbols = (machine.inertia3, machine.first_moment, machine.inertia4, l2, l3, l4, omega2)
    symbols += (alpha3, alpha4, theta2, theta3, theta4)
    second = sum(a * b**2 for a, b in zip(masses, places, strict=True))
    first = sum(a * b for a, b in zip(masses, places, strict=True))
    values = (second, first, follower, *lengths[1:], speed, 9 * m.alpha3, 9 * m.alpha4)
    found = sp.lambdify(symbols, list(machine.pin_force()))(*values, m.theta2, m.theta3, m.theta4)
    assert np.abs(found[0] - true.real).max() < 1e-8 * np.abs(true).max()
    assert np.abs(found[1] - true.imag).max() < 1e-8 * np.abs(true).max()


def number(expression):
    """Evaluate at one set of arbitrary values."""
    values = {EI: 3.1, mu: 0.7, force_x: 0.0, l2: 1.3, l3: 4.0, omega2: 1.7, omega3: -0.6}
    return float(expression.subs({**values, alpha3: 0.9, theta2: 0.8, theta3: 0.3}))


def test_modes():
    coefficient, phi = machine.mode_coefficient()
    for m in (1, 2):
        _, ours, right = projected(m, m)
        theirs = coefficient.subs({machine.mode: m, phi: omega3**2 / omega2**2})
        assert number(theirs) == pytest.approx(number(ours / omega2**2), rel=1e-13)
        forcing = machine.mode_forcing().subs(machine.mode, m)
        assert number(forcing) == pytest.approx(number(right / (l3 * omega2**2)), rel=1e-13)
    coupling = machine.coupling_coefficient(1, 2)
    assert number(coupling) == pytest.approx(number(projected(1, 2)[1] / omega2**2), rel=1e-12)
    assert mu not in coefficient.subs(EI, 0).free_symbols
