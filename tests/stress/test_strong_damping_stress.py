"""Multipliers from 1 down to 1e-1200, each to relative digits, on a turning basis."""

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet import floquet_multipliers, relative_multipliers

FREQUENCIES = np.array([3.0, 5.0, 40.0])
DRAGS = np.array([0.4, 30.0, 900.0])
# Exact: the oscillators rest on fixed axes, only their coordinates turn.
RATES = np.concatenate([np.roots([1.0, c, k * k]) for c, k in zip(DRAGS, FREQUENCIES, strict=True)])


def turned():
    """Return three damped oscillators seen from axes that turn with the crank."""
    spin = np.zeros((3, 3))
    spin[0, 1], spin[1, 0] = -1.0, 1.0

    def seen(matrix, after=None):
        def function(theta):
            c, s = np.cos(theta), np.sin(theta)
            r = np.broadcast_to(np.eye(3), (len(theta), 3, 3)).copy()
            r[:, 0, 0], r[:, 0, 1], r[:, 1, 0], r[:, 1, 1] = c, -s, s, c
            found = np.swapaxes(r, -1, -2) @ matrix @ r
            return found if after is None else found @ after

        return function

    drag = np.diag(DRAGS)
    terms = (
        Term("M", None, np.eye(3)),
        Term("A", None, spin),
        Term("B", None, spin.T @ spin),
        Term("K", None, seen(np.diag(FREQUENCIES**2))),
        Term("C", None, seen(drag)),
        Term("D", None, seen(drag, spin)),
    )
    return LinearPeriodic(3, terms, {}, lambda values: {})


@pytest.mark.parametrize("speed", [2.0, 20.0])
def test_small_multipliers_keep_their_relative_digits(speed):
    expected = np.sort((RATES * 2.0 * np.pi / speed).real)
    found = relative_multipliers(turned(), speed)
    np.testing.assert_allclose(np.sort(found.exponents.real), expected, rtol=1e-10)
    assert np.min(expected) < -250.0
    assert found.passed


def test_without_them_the_absolute_error_holds():
    found = floquet_multipliers(turned(), 2.0)
    expected = np.exp(np.sort(RATES.real * np.pi))
    gap = np.abs(np.sort(np.abs(found.multipliers)) - expected)
    assert np.all(gap <= np.max(found.error) + 1e-15)
    assert found.passed
