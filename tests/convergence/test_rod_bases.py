"""The bases of the rod against the number of modes: observed orders, one limit, the page."""

from __future__ import annotations

import pytest
from documented_tables import DOCS, compare, filled
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis, TwoSegmentBasis
from orders import slope
from rod_bases import (
    BASES,
    RODS,
    deflection_error,
    frequency_error,
    tongue,
)
from rod_convergence_tables import PLACES, TABLES


@pytest.mark.slow
@pytest.mark.parametrize("place", PLACES)
def test_orders_of_the_frozen_frequencies(place):
    """Over three doublings: 1/n for one polynomial, n^-3 for modes whose shear cannot jump."""
    counts = (6, 12, 24, 48)
    found = {
        name: -slope(counts, [frequency_error(BASES[name](n), place, 1) for n in counts])
        for name in ("polynomial", "free_free_linear")
    }
    assert found["polynomial"] == pytest.approx(1.0, abs=0.15)
    assert found["free_free_linear"] == pytest.approx(3.0, abs=0.3)


@pytest.mark.parametrize(("place", "mode"), [(0.4, 1), (0.6, 2), (0.8, 3)])
def test_two_segments_converge_spectrally(place, mode):
    """The order itself grows: faster than any power, until round-off."""
    counts = (8, 12, 16)
    errors = [frequency_error(TwoSegmentBasis(n), place, mode) for n in counts]
    assert errors[2] < 1e-6
    if errors[2] > 1e-8:
        assert -slope(counts[1:], errors[1:]) > -slope(counts[:2], errors[:2]) > 6
    else:
        assert -slope(counts[:2], errors[:2]) > 6


def test_overhang_modes_are_the_frozen_modes():
    for place in PLACES:
        for mode in (1, 2, 3):
            assert frequency_error(OverhangBasis(3), place, mode) < 1e-11


@pytest.mark.parametrize("rod", RODS)
def test_all_bases_have_one_limit(rod):
    """The steady tip deflection; what is allowed is twice what the page states."""
    assert deflection_error(rod, TwoSegmentBasis(12), "steady") < 1e-11
    assert deflection_error(rod, OverhangBasis(12), "steady") < 1e-5
    assert deflection_error(rod, BASES["free_free_linear"](16), "steady") < 4e-4
    assert deflection_error(rod, PolynomialBasis(16), "steady") < 3e-2


@pytest.mark.parametrize("rod", RODS)
def test_three_polynomial_modes_are_far_from_it(rod):
    assert 0.1 < deflection_error(rod, PolynomialBasis(3), "steady") < 0.2
    errors = [deflection_error(rod, PolynomialBasis(n), "steady") for n in (4, 8, 16)]
    assert -slope((4, 8, 16), errors) == pytest.approx(1.1, abs=0.25)


@pytest.mark.slow
def test_combination_tongue_of_three_polynomial_modes_is_a_fifth_too_high():
    """Both regions about omega1 + omega2, of growth beyond 1 % a turn; they do not even meet."""
    converged = tongue(TwoSegmentBasis(6), 3530.0)
    three = tongue(PolynomialBasis(3), 4320.0)
    assert three[0] > converged[1] * 1.1
    assert 0.2 < sum(three) / sum(converged) - 1 < 0.25


@pytest.mark.slow
def test_page_is_current():
    """Errors to 15 %, which another library may change; other numbers to their last place."""
    written = (DOCS / "rod_convergence.md").read_text()
    compare(
        written,
        filled(written, TABLES),
        lambda number: {"rel": 0.15} if "e" in number else {"rel": 5e-4, "abs": 0.11},
    )
