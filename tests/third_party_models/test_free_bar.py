"""The transcendental family: a bar's dynamic stiffness and its count of frequencies."""

import mpmath
import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families import Transcendental

UNIT = {"axial_stiffness": 1.0, "mass_per_length": 1.0, "length": 1.0}


@pytest.fixture(scope="module")
def bar(emit):
    found = emit("free_bar", ModelSpec("free_bar", "dynamic_stiffness"))
    return Transcendental.from_module(found.module, UNIT, provenance=found.provenance)


def test_count_has_no_spurious_step(bar):
    """A fine sweep over the poles of D, too: the count never falls and steps by one."""
    phases = np.linspace(1e-3, 12.4 * np.pi, 40_001)
    count = bar.count(phases)
    assert set(np.diff(count)) == {0, 1}
    np.testing.assert_array_equal(count, 1 + np.floor(phases / np.pi))  # at rest it moves freely


@pytest.mark.parametrize("phase", [1e-3, 0.5, 1.0, 1.001, 3.0, 4.0, 20.3, 301.0, 3001.0])
def test_entries_against_the_textbook_at_50_digits(bar, phase):
    with mpmath.workdps(50):
        exact = mpmath.mpf(phase)
        near, far = exact * mpmath.cot(exact), -exact * mpmath.csc(exact)
        expected = np.array([[near, far], [far, near]], dtype=float)
    np.testing.assert_allclose(bar.stiffness(phase), expected, rtol=1e-13)


def test_static_limit(bar):
    np.testing.assert_allclose(bar.stiffness(0.0), [[1, -1], [-1, 1]], rtol=1e-15)
