"""Where the numbers themselves are ill-conditioned: the estimate grows with it, or a clear refusal.

Each test names its danger and the estimate it guards.
"""

import numpy as np
import pytest
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.frequencies import dynamic_stiffness, wittrick_williams
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from periodic_systems import system_of, wave

CLAMPED = ("x", "y", "rotation")
BAR = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)


@pytest.mark.parametrize("exponent", [1, 3, 5, pytest.param(7, marks=pytest.mark.slow), 8])
def test_coordinates_that_hardly_differ(exponent):
    """Danger: a basis nearly dependent.  Estimate: that of the multipliers."""
    squares, speed = np.array([2.0, 5.3]), 1.1
    basis = np.array([[1.0, 1.0], [0.0, 10.0**-exponent]])
    system = system_of(M=basis.T @ basis, K=basis.T @ np.diag(squares) @ basis)
    try:
        found = floquet_multipliers(system, speed)
    except BadInput:
        # The mass is positive definite no more in doubles.
        assert exponent >= 7
        return
    phase = np.sqrt(squares) * 2 * np.pi / speed
    exact = np.exp(1j * np.concatenate([phase, -phase]))
    # The arrays themselves are rounded: relative to the condition of the mass.
    data = 4 * np.finfo(float).eps * np.linalg.cond(basis) ** 2 * np.max(phase)
    for value, error in zip(found.multipliers, found.error, strict=True):
        assert np.isfinite(value) or np.isinf(error)
        if np.isfinite(error):
            assert np.min(np.abs(exact - value)) <= error + data


def test_every_mode_from_the_first_to_the_hundredth():
    """Danger: cosh and sinh lose every digit by mode 12.  Estimate: the bound of each frequency."""
    structure = frame({"A": (0, 0), "B": (1, 0)}, {"bar": ("A", "B")}, BAR, supports={"A": CLAMPED})
    problem = dynamic_stiffness(structure, inextensible=True)
    found = wittrick_williams(problem, count=100)
    assert found.passed
    number = np.arange(1, 101)
    root = ((number - 0.5) * np.pi).astype(np.longdouble)
    side = np.where(number % 2, 1, -1)
    for _ in range(30):
        # cos z = -1/cosh z, solved for the angle beside each whole and a half.
        root = (number - 0.5) * (4 * np.arctan(np.longdouble(1))) + side * np.arcsin(
            1 / np.cosh(root)
        )
    gap = np.abs(found.frequencies - root**2).astype(float)
    assert np.all(gap <= found.error)
    shape = found.shape(99, "bar", np.linspace(0.0, 1.0, 401))
    # Unit mass of the whole bar: 2 over the square root of it at the tip.
    assert abs(shape.across[-1]) == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize("exponent", range(1, 16, 2))
def test_a_hair_from_an_undamped_resonance(exponent):
    """Danger: a motion that grows without bound.  Estimate: that of the steady state."""
    speed = 1.0 + 10.0**-exponent
    found = steady_state(system_of(M=np.eye(1), K=np.eye(1), p=wave([1.0])), speed)
    exact = 1.0 / ((1.0 - np.longdouble(speed)) * (1.0 + np.longdouble(speed)))
    error = float(np.max(found.error))
    if not np.isfinite(error):
        assert exponent >= 12
        return
    gap = np.max(np.abs(found.q[:, 0] - exact * np.cos(found.theta))) / abs(exact)
    # Not idle: the loss of digits is the distance's.
    assert float(gap) <= error <= 1e-9 + 1e4 * np.finfo(float).eps * 10.0**exponent
