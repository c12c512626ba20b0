"""Monodromy matrices and multipliers: hand cases, structure, growth, what is hard to see."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
from edge_truth import flexible_rod
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import floquet_multipliers, monodromy
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.multipliers import graded_multipliers
from elastolink.runtime.periodic.transition import choose, segments_of
from elastolink.runtime.systems.rod import (
    FreeFreeBasis,
    OverhangBasis,
    PolynomialBasis,
    TwoSegmentBasis,
)
from periodic_systems import mathieu, system_of, wave


def _whirling(stiffness: float, damping: float = 0.0) -> LinearPeriodic:
    """Return a mass on a spring, seen from the turning crank: Coriolis and centrifugal terms."""
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    # Damping acts on the velocity in space, whose Coriolis part is a stiffness here.
    springs = [stiffness * np.eye(2), (None, damping * turn, 1)]
    return system_of(M=np.eye(2), A=turn, B=np.eye(2), K=springs, C=damping * np.eye(2))


def _general() -> LinearPeriodic:
    """Two degrees of freedom with every kind of term, all of them periodic."""
    return system_of(
        {"load": 1.0, "C": 0.0},
        M=[np.array([[2.0, 0.3], [0.3, 1.0]]), wave([[0.5, 0.1], [0.1, 0.2]], 1, 0.3)],
        A=[np.array([[0.1, -0.6], [0.7, 0.0]]), wave([[0.2, 0.5], [-0.1, 0.3]], 2, 1.0)],
        B=wave([[1.0, 0.2], [0.2, -0.5]]),
        K=np.array([[20.0, 3.0], [3.0, 9.0]]),
        Kg=("load", wave([[2.0, 1.0], [1.0, 3.0]], 1, -0.4)),
        C=[("C", np.array([[0.4, 0.1], [0.1, 0.3]])), ("C", wave([[0.1, 0.0], [0.0, 0.2]]))],
    )


# Undamped systems, speeds, and how far from symplectic, over the square of the norm.
UNDAMPED = {"every kind of term": (_general(), np.linspace(0.5, 9.0, 40), 1e-13)} | {
    type(basis).__name__ + suffix: (flexible_rod(basis, 0.2), [500.0, 900.0, 4000.0], 1e-12)
    for basis, suffix in (
        (PolynomialBasis(3), ""),
        (PolynomialBasis(3, orthogonal=False), ", powers"),
        (OverhangBasis(4), ""),
        (TwoSegmentBasis(4), ""),
        (FreeFreeBasis(4), ""),
    )
}


@pytest.mark.parametrize("damping", [0.0, 0.6])
def test_whirling_mass_has_the_multipliers_of_the_resting_one(damping):
    k, speed = 7.0, 1.9
    found = floquet_multipliers(_whirling(k, damping), speed)
    root = -damping / 2 + 1j * np.sqrt(k - damping**2 / 4)
    # A whole turn of the frame changes nothing.
    exact = np.exp(root * 2 * np.pi / speed)
    expected = np.array([exact, exact, np.conj(exact), np.conj(exact)])
    got = found.multipliers
    assert np.max(np.min(np.abs(got[:, None] - expected), axis=1)) < 1e-12
    assert found.stable
    assert found.passed, found.checks
    if damping:
        assert found.growth == pytest.approx(-damping / 2, rel=1e-12)


def test_circulatory_force_is_not_mistaken_for_a_conservative_one():
    # A skew stiffness has no potential: undamped, volume kept, yet not symplectic.
    skew = np.array([[0.0, 0.3], [-0.3, 0.0]])
    found = floquet_multipliers(system_of(M=np.eye(2), K=7.0 * np.eye(2) + skew), 2.0)
    assert "symplectic" not in found.checks
    assert found.passed, found.checks
    # w^2 = 7 +- 0.3 i: flutter.
    growth = 2 * np.pi / 2.0 * abs(np.sqrt(7 + 0.3j).imag)
    assert np.log(abs(found.multipliers[0])) == pytest.approx(growth, rel=1e-12)


def test_damped_determinant_is_liouvilles():
    found = monodromy(_general(), 2.5, C=np.array([0.5, 1.0, 2.0]))
    theta = np.arange(256) * 2 * np.pi / 256
    system = _general()
    for index, factor in enumerate((0.5, 1.0, 2.0)):
        mass, damping = system.array("M", theta), factor * system.array("C", theta, C=1.0)
        rate = np.trace(np.linalg.solve(mass, damping), axis1=1, axis2=2).mean()
        expected = np.exp(-rate * 2 * np.pi / 2.5)
        assert found.determinant[index] == pytest.approx(expected, rel=1e-12)
    assert found.passed
    assert set(found.checks) == {"converged", "liouville"}


@pytest.mark.parametrize("name", UNDAMPED)
def test_undamped_matrices_are_symplectic(name):
    """At speeds of the charts, of the rod also at the largest crank."""
    system, speeds, limit = UNDAMPED[name]
    found = monodromy(system, speeds)
    unit, scaled = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(system.size)), found.scaled
    defect = np.swapaxes(scaled, -1, -2) @ unit @ scaled - unit
    norm = np.linalg.norm(scaled, axis=(-2, -1))
    assert np.max(np.linalg.norm(defect, axis=(-2, -1)) / norm**2) < limit
    assert found.checks["symplectic"].value < limit
    assert found.passed


def test_multipliers_come_in_reciprocal_pairs():
    found = floquet_multipliers(_general(), np.linspace(0.5, 9.0, 40), load=6.0, rtol=1e-11)
    assert not np.all(found.stable)
    assert np.any(found.stable)
    assert found.checks["reciprocal pairs"].passed
    assert found.passed, found.checks
    product = np.prod(found.multipliers, axis=-1)
    np.testing.assert_allclose(product, 1.0, atol=1e-9)


def test_speed_and_parameters_broadcast():
    system = _general()
    speed = np.array([[1.5], [2.5], [4.0]])
    load = np.array([0.5, 1.0])
    found = monodromy(system, speed, load=load, C=0.1)
    assert found.matrix.shape == (3, 2, 4, 4)
    assert found.error.shape == (3, 2)
    alone = monodromy(system.with_parameters(load=1.0, C=0.1), 2.5)
    np.testing.assert_allclose(found.matrix[1, 1], alone.matrix, rtol=0, atol=1e-12)
    multipliers = floquet_multipliers(system, speed, load=load, C=0.1)
    assert multipliers.multipliers.shape == (3, 2, 4)
    assert multipliers.stable.shape == (3, 2)


def test_order_of_multipliers():
    found = floquet_multipliers(_general(), 3.0, C=1.0).multipliers
    modulus = np.abs(found)
    assert np.all(np.diff(modulus) < 1e-6)
    upper = np.flatnonzero(found.imag > 1e-9)
    assert len(upper)
    np.testing.assert_allclose(found[upper + 1], np.conj(found[upper]), rtol=1e-12)


def test_semisimple_double_multiplier_keeps_a_small_error():
    found = floquet_multipliers(mathieu(), 1.0, lam2=4.0, mu=0.0)
    assert np.all(np.abs(found.multipliers - 1) <= found.error)
    assert np.all(found.error < 1e-12)


def test_growth_beyond_double_precision():
    found = monodromy(mathieu(), 1.0, lam2=-1e6)
    assert found.exponent > 1024
    assert np.all(np.isfinite(found.matrix))
    multipliers = floquet_multipliers(mathieu(), 1.0, lam2=-1e6, mu=0.0)
    assert not multipliers.stable
    assert np.isinf(multipliers.multipliers[0])
    assert multipliers.multipliers[1] == 0
    np.testing.assert_allclose(multipliers.exponents, [2e3 * np.pi, -2e3 * np.pi], rtol=1e-12)
    assert multipliers.passed


def test_picture():
    found = floquet_multipliers(_general(), [1.0, 2.0])
    assert found.plot().get_xlabel() == "real part of multiplier"


def _single(spring=None) -> LinearPeriodic:
    """Return a spring of 2, with a further one that may depend on the angle."""
    more = {} if spring is None else {"Kg": lambda theta: spring(theta)[:, None, None]}
    return system_of(M=np.eye(1), K=2.0 * np.eye(1), **more)


def _spike(width):
    return lambda theta: np.exp(-((((theta % (2 * np.pi)) - 1.0345) / width) ** 2)) / width


def _dipping(theta):
    """Return a mass that is negative over a sixtieth of the turn, between the first angles."""
    dip = np.exp(-((np.mod(theta - 2.0, 2 * np.pi) / 0.03) ** 2))
    return np.eye(2) - 1.5 * dip[:, None, None] * np.diag([0.0, 1.0])


@pytest.mark.parametrize(
    "mass",
    [
        lambda theta: (1.0 + 1.2 * np.cos(8 * theta))[:, None, None],
        lambda theta: (1.0 - 1.2 * np.sin(8 * theta))[:, None, None],
        _dipping,
    ],
)
def test_mass_negative_between_even_angles_is_refused(mass):
    with pytest.raises(BadInput, match="mass matrix M"):
        floquet_multipliers(system_of(M=mass, K=2.0 * np.eye(mass(np.zeros(1)).shape[-1])), 1.0)


@pytest.mark.parametrize("width", [0.03, 0.01, 0.005])
def test_a_narrow_spike_is_seen(width):
    found = floquet_multipliers(_single(spring=_spike(width)), 1.0)
    # Independent: Runge-Kutta of order 8 with steps that cannot pass over the spike.
    spike, turn = _spike(width), (0.0, 2 * np.pi)

    def slope(theta, y):
        return [*y[2:], *(-(2.0 + spike(theta)) * y[:2])]

    fine = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12, "max_step": width}
    exact = scipy.integrate.solve_ivp(slope, turn, [1.0, 0.0, 0.0, 1.0], **fine).y[:, -1]
    trace = np.sum(found.multipliers).real
    assert abs(trace - (exact[0] + exact[3])) < np.max(found.error) + 1e-9
    assert found.passed, found.checks


def test_what_does_not_converge_fails_its_check():
    # A jump at no angle that halving meets.
    system = _single(spring=lambda theta: np.sign(np.sin(theta - 0.3) + 0.4))
    found = floquet_multipliers(system, 1.0)
    assert not found.checks["converged"].passed
    assert not found.passed
    assert floquet_multipliers(system, 1.0, rtol=1e-2).passed


def test_an_error_that_says_nothing_is_not_called_stable():
    found = floquet_multipliers(_single(), 1.0)
    assert found.stable
    for error in (0.5, 800.0, np.inf):
        assert not replace(found, error=np.full(2, error)).stable
    # Far inside the circle it may.
    inside = replace(found, multipliers=np.array([0.1, 0.1 + 0j]), error=np.full(2, 0.5))
    assert inside.stable


def test_provenance_tells_changes_and_versions():
    system = mathieu().with_parameters(mu=0.5)
    found = monodromy(system, 1.0, K2=np.array([0.0, 0.1]))
    assert found.provenance["changed"] == "mu=0.5, K2=2 values from 0.0 to 0.1"
    assert found.provenance["numpy"] == np.__version__
    assert "elastolink" in found.provenance
    assert "changed" not in monodromy(mathieu(), 1.0).provenance


def test_damping_counts_only_where_it_is_not_zero():
    system = mathieu()
    assert not system.is_damped()
    assert system.is_damped(K2=0.1)
    assert system.is_damped(K2=np.array([0.0, 0.1]))
    zero = _single().with_terms(Term("C", None, np.zeros((1, 1))))
    assert not zero.is_damped()
    assert "symplectic" in monodromy(zero, 1.0).checks
    wave = _single().with_terms(Term("C", None, lambda theta: np.sin(theta)[:, None, None]))
    assert wave.is_damped()
    with pytest.raises(BadInput, match="mass"):
        system.is_damped(mass=1.0)


def test_multipliers_at_another_geometry():
    system = flexible_rod(PolynomialBasis(3))
    direct = floquet_multipliers(flexible_rod(PolynomialBasis(3), 0.15), 900.0)
    changed = floquet_multipliers(system, 900.0, crank_ratio=0.15)
    assert np.array_equal(direct.multipliers, changed.multipliers)
    with pytest.raises(BadInput, match="one number"):
        monodromy(system, 900.0, crank_ratio=[0.1, 0.2])
    with pytest.raises(BadInput, match="crank_ratioo"):
        monodromy(system, 900.0, crank_ratioo=0.1)


def test_multipliers_from_1_to_1e_1200_keep_their_relative_digits():
    """Three damped oscillators seen from turning axes, whose rates are roots of quadratics.

    The last decays by 1e-1200 in a period; no entry of the monodromy matrix shows it.
    """
    frequencies, drags, spin = np.array([3.0, 5.0, 40.0]), np.array([0.4, 30.0, 900.0]), np.zeros(9)
    spin[[1, 3]] = -1.0, 1.0
    spin = spin.reshape(3, 3)

    def seen(matrix, after=None):
        def function(theta):
            r = scipy.linalg.expm(theta[:, None, None] * spin)
            turned = np.swapaxes(r, -1, -2) @ matrix @ r
            return turned if after is None else turned @ after

        return function

    system = system_of(
        M=np.eye(3),
        A=spin,
        B=spin.T @ spin,
        K=seen(np.diag(frequencies**2)),
        C=seen(np.diag(drags)),
        D=seen(np.diag(drags), spin),
    )
    rates = [np.roots([1.0, c, k * k]) for c, k in zip(drags, frequencies, strict=True)]
    expected = np.sort(np.concatenate(rates).real * np.pi)
    found = floquet_multipliers(system, 2.0)
    gap = np.abs(np.sort(np.abs(found.multipliers)) - np.exp(expected))
    assert np.all(gap <= np.max(found.error) + 1e-15)
    assert found.passed
    equation = equation_of(system, 2.0)
    way = choose(equation, 1e-10)
    logarithm, _ = graded_multipliers(segments_of(equation, 1024, way).maps)
    np.testing.assert_allclose(np.sort(logarithm[0]), expected, rtol=1e-9)
