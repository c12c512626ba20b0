"""The transcendental family: a pinned beam's dynamic stiffness and its count of frequencies."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families import Transcendental

UNIT = {"bending_stiffness": 1.0, "mass_per_length": 1.0, "length": 1.0}


@pytest.fixture(scope="module")
def emitted(emit):
    return emit("pinned_beam", ModelSpec("pinned_beam", "dynamic_stiffness"))


@pytest.fixture(scope="module")
def beam(emitted):
    return Transcendental.from_module(emitted.module, UNIT, provenance=emitted.provenance)


def bisect(system: Transcendental, number: int, low: float, high: float) -> float:
    """Return the frequency below which there are just ``number - 1``."""
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        if system.count(middle) < number:
            low = middle
        else:
            high = middle


def test_count_has_no_spurious_step(beam):
    """A fine sweep over the poles of D, too: the count never falls and steps by one."""
    waves = np.linspace(0.0, 12.4 * np.pi, 40_001)
    count = beam.count(waves**2)
    assert set(np.diff(count)) == {0, 1}
    np.testing.assert_array_equal(count, np.floor(waves / np.pi))


@pytest.mark.parametrize("number", [1, 2, 3, 17, 60])
def test_frequencies_by_bisection(beam, number):
    found = bisect(beam, number, 1.0, 1e5)
    assert found == pytest.approx((number * np.pi) ** 2, rel=1e-12)


@pytest.mark.parametrize("wave", [1e-3, 0.5, 1.0, 1.001, 3.0, 4.0, 4.7, 5.0, 20.3, 301.0])
def test_entries_against_the_textbook_at_50_digits(beam, wave):
    """Smith-free formula with cosh and sinh, as in Clough and Penzien, evaluated in 50 digits."""
    with mpmath.workdps(60 + int(wave)):
        b = mpmath.sqrt(mpmath.mpf(wave**2))
        below = 1 - mpmath.cos(b) * mpmath.cosh(b)
        near = b * (mpmath.sin(b) * mpmath.cosh(b) - mpmath.cos(b) * mpmath.sinh(b)) / below
        far = b * (mpmath.sinh(b) - mpmath.sin(b)) / below
        expected = np.array([[near, far], [far, near]], dtype=float)
    np.testing.assert_allclose(beam.stiffness(wave**2), expected, rtol=1e-13)


def test_static_limit(beam):
    np.testing.assert_allclose(beam.stiffness(0.0), [[4, 2], [2, 4]], rtol=1e-15)
    assert beam.count(0.0) == 0


def test_no_overflow_far_beyond_cosh(beam):
    with np.errstate(all="raise", under="ignore"):
        stiffness = beam.stiffness(np.array([1e3, 3e3]) ** 2)
        count = beam.count(np.array([1e3, 3e3]) ** 2)
    assert np.all(np.isfinite(stiffness))
    np.testing.assert_array_equal(count, np.floor(np.array([1e3, 3e3]) / np.pi))
