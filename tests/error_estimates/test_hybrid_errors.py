"""Bounds of the first frequency of hybrid matrices, against determinants in 60 digits.

Which root of the determinant is the first one says the count of Wittrick and Williams; the random
frames have soft members between heavy nodes among them, whose cubic element lies far too high.
"""

from __future__ import annotations

import frame_truth
import frequency_truth
import mpmath
import numpy as np
import pytest
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.frequencies import (
    dynamic_stiffness,
    wittrick_williams,
)
from elastolink.runtime.gallery.aannaque_hybrid import hybrid_matrices
from honesty import SCENES, verdict

DIGITS = 40
CLAMPED = ("x", "y", "rotation")


@SCENES
def test_bounds_hold_and_are_not_idle(scenes):
    """Against frequencies with bounds of 1e-13, themselves held against determinants elsewhere."""
    rng = np.random.default_rng(31)
    ratios, far = [], 0
    for _ in range(scenes):
        structure = frame_truth.random_frame(rng)
        found = hybrid_matrices(structure, 0.0, rtol=float(10.0 ** rng.uniform(-5.0, -1.0)))
        assert found.passed
        exact = wittrick_williams(dynamic_stiffness(structure), count=1)
        actual = abs(found.first[0] - exact.frequencies[0])
        assert actual <= found.error[0] + exact.error[0]
        ratios.append(found.error / max(actual - exact.error[0], 1e-17 * found.first[0]))
        far += found.polynomial[0] > 1.5 * exact.frequencies[0]
    verdict(ratios, scenes)
    # Where cubic elements alone would lead to another frequency, or to a pole of D.
    assert far > 0.1 * scenes


@SCENES
def test_last_digits_against_determinants(scenes):
    """One secant between two determinants next to the frequency: what is left is its square."""
    rng = np.random.default_rng(32)
    ratios = []
    for _ in range(scenes):
        structure = frame_truth.random_frame(rng)
        problem = dynamic_stiffness(structure)
        found = hybrid_matrices(structure, 0.0, rtol=float(10.0 ** rng.uniform(-13.0, -5.0)))
        first, bound = mpmath.mpf(float(found.first[0])), mpmath.mpf(float(found.error[0]))
        frequency_truth.stiffness.cache_clear()
        frequency_truth.amplitudes.cache_clear()
        with mpmath.workdps(DIGITS):
            low, high = (
                mpmath.det(frame_truth.exact_stiffness(problem, place))
                for place in (first - bound, first + bound)
            )
            assert low * high < 0
            actual = float(abs(bound * (low + high) / (low - high)))
        # It is the first root: the plain count is right a little away.
        assert problem.count(found.first[0] - found.error[0] - 1e-6 * found.first[0]) == 0
        ratios.append(found.error / max(actual, 1e-17 * found.first[0]))
    verdict(ratios, scenes)


@pytest.mark.parametrize("heavy", [1.0, 30.0, 1e3, 1e5, 1e8])
def test_heavy_nodes_do_not_hide_the_first_frequency(heavy):
    """A soft bar between two stiff stubs; with inertia on the nodes they hardly move."""
    soft = Section.rectangle(0.02, 0.001, modulus=2e11, density=7800.0)
    stiff = Section.rectangle(0.02, 0.02, modulus=2e11, density=7800.0)
    places = {"A": (0, 0), "B": (0.1, 0), "C": (1.1, 0), "D": (1.2, 0)}
    members = {"left": ("A", "B"), "bar": ("B", "C"), "right": ("C", "D")}
    structure = frame(
        places,
        members,
        {"left": stiff, "bar": soft, "right": stiff},
        supports={"A": CLAMPED, "D": CLAMPED},
        nodes={name: {"mass": heavy, "inertia": 1e-3 * heavy} for name in "BC"},
    )
    exact = wittrick_williams(dynamic_stiffness(structure), count=1)
    for rtol in (1e-2, 1e-3, 1e-9):
        found = hybrid_matrices(structure, 0.0, rtol=rtol)
        assert abs(found.first[0] - exact.frequencies[0]) <= found.error[0] + exact.error[0]
        assert found.passed


def test_nodes_that_stand_still_are_refused():
    """A long bar clamped at both ends beside a short one: no matrix of nodes knows of it."""
    section = Section.rectangle(0.02, 0.001, modulus=2e11, density=7800.0)
    places = {"A": (0, 0), "B": (2, 0), "C": (2.1, 0)}
    members = {"long": ("A", "B"), "short": ("B", "C")}
    structure = frame(places, members, section, supports={"A": CLAMPED, "B": CLAMPED})
    with pytest.raises(BadInput, match="stands still"):
        hybrid_matrices(structure, 0.0)
