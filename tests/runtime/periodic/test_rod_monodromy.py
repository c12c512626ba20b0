"""Monodromy matrices of the flexible rod: symplectic, by two methods, mirrored halves."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import Term
from elastolink.runtime.periodic.first_order import canonical_form
from elastolink.runtime.stability.charts.invariants import characteristic, from_sum, in_sum
from elastolink.runtime.stability.charts.turn_series import Turn, mirrored_sums
from elastolink.runtime.systems.rod import (
    FreeFreeBasis,
    OverhangBasis,
    PolynomialBasis,
    TwoSegmentBasis,
    rod_system,
)

BASES = {
    "polynomial": lambda: PolynomialBasis(3),
    "powers": lambda: PolynomialBasis(3, orthogonal=False),
    "overhang": lambda: OverhangBasis(4),
    "two_segment": lambda: TwoSegmentBasis(4),
    "free_free_linear": lambda: FreeFreeBasis(4),
}


def rod(basis=None, crank_ratio=0.2, **changes):
    """Beale & Scott's very flexible rod."""
    return rod_system(
        basis or PolynomialBasis(3),
        crank_ratio=crank_ratio,
        frame=0.59997,
        length=1.0,
        bending_stiffness=0.7e11 * 0.5208e-6,
        mass_per_length=7.15,
        **changes,
    )


def turn(system, low=500.0, high=4000.0, **options):
    """The system at all speeds of a range, the variable 1/w^2."""

    def form_at(values):
        return canonical_form(system, 1.0 / np.sqrt(values))

    return Turn(form_at, high**-2.0, low**-2.0, **options)


@pytest.mark.parametrize("symplectic", [True, False])
@pytest.mark.parametrize("basis", ["polynomial", "overhang"])
def test_series_of_the_turn_agree_with_collocation(basis, symplectic):
    """Power series over half a turn, or the whole of it, against Gauss-Legendre collocation."""
    system = rod(BASES[basis]())
    speeds = np.array([500.0, 611.3, 1234.5, 4000.0])
    series = turn(system, symplectic=symplectic).series()
    assert series.half is symplectic
    matrices, power = series.products(speeds**-2.0)
    assert not power.any()
    if symplectic:
        found = from_sum(characteristic(2.0 * mirrored_sums(matrices), reduced=False))
    else:
        found = characteristic(matrices, reduced=True)
    direct = el.monodromy(system, speeds, rtol=1e-13)
    wanted = characteristic(direct.scaled, reduced=True)
    size = np.max(np.abs(wanted))
    # Invariants move with the matrices, whose errors are below 1e-12 by either method.
    assert np.max(np.abs(found - wanted)) <= 1e-11 * size
    assert series.missed <= 1e-11


def test_damping_is_never_taken_for_a_mirror_image():
    """A moving wave of stiffness has no mirrored half either."""
    assert turn(rod(), symplectic=True).mirrored
    damped = turn(rod(damping=20.0), symplectic=False)
    assert not damped.mirrored
    skew = rod().with_terms(Term("Kg", None, lambda t: np.sin(t)[:, None, None] * np.eye(3)))
    assert not turn(skew, symplectic=True).mirrored


def test_other_stretches_give_the_same():
    system = rod(OverhangBasis(4))
    values = np.array([500.0, 1700.0]) ** -2.0
    one, other = (turn(system, symplectic=True, fineness=f).series() for f in (1.0, 1.7))
    assert one.stretches.shape[1] != other.stretches.shape[1]
    first, second = (
        characteristic(2.0 * mirrored_sums(s.products(values)[0]), reduced=False)
        for s in (one, other)
    )
    assert np.allclose(first, second, rtol=0.0, atol=1e-11 * np.max(np.abs(first)))


def test_a_known_degree_changes_nothing():
    """L is linear in 1/w^2: two values of it tell all."""
    values = np.array([500.0, 1700.0]) ** -2.0
    plain, known = (turn(rod(), symplectic=True, degree=d).series() for d in (None, 1))
    first, second = (s.products(values)[0] for s in (plain, known))
    assert np.allclose(first, second, rtol=0.0, atol=1e-12 * np.max(np.abs(first)))


def test_too_long_a_turn_is_refused():
    with pytest.raises(el.BadInput, match="raise the lowest speed"):
        turn(rod(), low=1e-3, high=1.0).series()


def test_sums_and_coefficients_are_two_forms_of_one_polynomial():
    """Hand case: rho = exp(+-i a) has z = 2 cos a."""
    z = 2.0 * np.cos([0.3, 1.1, 2.9])
    polynomial = np.poly(z)[1:]
    whole = np.poly(np.exp(1j * np.array([0.3, 1.1, 2.9, -0.3, -1.1, -2.9]))).real
    assert np.allclose(from_sum(polynomial), whole[1:4], atol=1e-14)
    assert np.allclose(in_sum(whole[1:4]), polynomial, atol=1e-14)
