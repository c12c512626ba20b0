"""The bases of the rod against the number of modes: observed orders, one limit, the page."""

from functools import partial

import pytest
from documented import documented_rows
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis, TwoSegmentBasis
from orders import slope
from rod_bases import BASES, REFERENCE, RODS, condition, deflection_error, frequency_error, tongue

PAGE, PLACES = "rod_convergence", (0.4, 0.6, 0.8)
COUNTS = (2, 3, 4, 6, 8, 12, 16)
# Below this a difference is round-off, or of the steps of the motion from rest.
FLOORS = {"frequency": 1e-8, "steady": 1e-11, "from rest": 1e-5}


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


def assert_written(cells, counts, error, floor):
    """Compare errors with a row of the page to 15 %, which another library may change."""
    for cell, n in zip(cells, counts, strict=True):
        found = error(n)
        assert found < floor if cell == "-" else found == pytest.approx(float(cell), rel=0.15)


@pytest.mark.slow
def test_the_errors_of_the_page():
    for place, mode, name, *cells in documented_rows(PAGE, "frequencies"):

        def error(n, at=(float(place), int(mode)), basis=BASES[name]):
            return frequency_error(basis(n), *at)

        assert_written(cells, COUNTS, error, FLOORS["frequency"])
    for rod, motion, name, *cells in documented_rows(PAGE, "deflections"):

        def error(n, rod=rod, motion=motion, name=name):
            itself = (name, n) == ("two_segment", REFERENCE)
            return 0.0 if itself else deflection_error(rod, BASES[name](n), motion)

        assert_written(cells, COUNTS, error, FLOORS[motion])


@pytest.mark.slow
def test_the_tongues_of_the_page():
    truth = sum(tongue(BASES["two_segment"](8), 3530.0))
    for name, n, low, high, off in documented_rows(PAGE, "tongue"):
        written = float(low), float(high)
        ends = tongue(BASES[name](int(n)), sum(written) / 2.0)
        assert ends == pytest.approx(written, rel=5e-4)
        shift = 100.0 * (sum(ends) / truth - 1.0)
        assert shift == pytest.approx(float(off.removesuffix(" %")), abs=0.11)


@pytest.mark.slow
def test_the_conditions_of_the_page():
    makers = (partial(PolynomialBasis, orthogonal=False), PolynomialBasis, TwoSegmentBasis)
    for make, (_, *cells) in zip(makers, documented_rows(PAGE, "conditions"), strict=True):
        for cell, n in zip(cells, (3, 6, 12, 20), strict=True):
            worst = max(condition(make(n), place) for place in PLACES)
            assert worst > 1e15 if cell == "singular" else worst == pytest.approx(float(cell), 0.15)
