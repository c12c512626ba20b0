"""Zeros of many functions at once between brackets."""

import numpy as np
from elastolink.runtime.core.maxima import bracketed_roots

POWERS, WANTED = np.array([1.0, 3.0, 7.0, 2.0]), np.array([0.3, 0.5, 0.9, 1e-3])


def powers(which, at):
    return at ** POWERS[which] - WANTED[which] ** POWERS[which], 0.0


def test_zeros_are_found_to_round_off_from_either_side():
    first, second = np.zeros(4), np.array([1.0, 2.0, 1.5, 5.0])
    for ends in ((first, second), (second, first)):
        roots, width, _ = bracketed_roots(powers, *ends)
        assert np.max(np.abs(roots / WANTED - 1.0)) < 1e-14
        assert np.all(width <= 4e-15 * roots)


def test_a_value_that_is_all_error_ends_the_search_there():
    def blurred(which, at):
        value = at - WANTED[which]
        return np.where(np.abs(value) < 1e-3, 0.0, value), np.full(len(at), 1e-3)

    roots, width, slope = bracketed_roots(blurred, np.zeros(4), np.ones(4))
    assert np.all(np.abs(roots - WANTED) <= 1e-3)
    assert np.all(width == 0.0)
    np.testing.assert_allclose(slope, 1.0, rtol=1e-12)


def test_an_end_that_is_a_zero_and_no_function_at_all():
    roots, width, _ = bracketed_roots(powers, WANTED, WANTED)
    np.testing.assert_array_equal(roots, WANTED)
    assert not np.any(width)
    assert not len(bracketed_roots(powers, np.zeros(0), np.zeros(0))[0])
