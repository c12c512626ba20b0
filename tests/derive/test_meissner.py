"""Meissner's half traces: the digits next to coexistence, and half turns."""

import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import hill_meissner as model
from elastolink.derive.safe import UnsafeRewriting
from elastolink.generated import hill_meissner
from meissner_truth import interval


def test_a_half_turn_that_is_wrong_is_refused(monkeypatch):
    monkeypatch.setattr(model, "monodromy", lambda count: model.Parts.of(2 * sp.eye(2)))
    with pytest.raises(UnsafeRewriting, match="is not"):
        model.half_turn_matrix()


def test_the_edge_keeps_its_digits_next_to_coexistence():
    """J^2 - 1 is of the order 1e-16 here: from J alone nothing of it is left."""
    levels = np.array([9.0 * (1.0 + 1e-9), 1.0 - 2e-9])
    c, s = hill_meissner.interval(levels, np.pi)
    j, d, upper, lower = hill_meissner.two_intervals(c[0], s[0], levels[0], c[1], s[1], levels[1])
    with mpmath.workdps(60):
        whole = mpmath.eye(2)
        for level in map(mpmath.mpf, levels.tolist()):
            at = interval({"level": level, "length": mpmath.mpf(float(np.pi))})
            c_, s_ = at["cosine"], at["sine"]
            whole = mpmath.matrix([[c_, s_], [-level * s_, c_]]) * whole
        exact = ((whole[0, 0] + whole[1, 1]) / 2) ** 2 - 1
        # Two multiplications of numbers of order 1e-8, each known to a few 1e-16.
        assert abs(d * d + upper * lower - float(exact)) < 1e-23
        assert 1e-17 < abs(exact) < 1e-15
    assert abs(j * j - 1.0 - float(exact)) < 1e-15


def test_a_half_turn_factors_the_distance_from_both_edges():
    q = np.linspace(-1.0, 20.0, 40)
    first, second = q[:, None], q[None, :]
    (c1, s1), (c2, s2) = (hill_meissner.interval(x, 0.5 * np.pi) for x in (first, second))
    y1, y2, slope1, slope2 = hill_meissner.half_turn(c1, s1, first, c2, s2, second)
    (c1, s1), (c2, s2) = (hill_meissner.interval(x, np.pi) for x in (first, second))
    j = hill_meissner.two_intervals(c1, s1, first, c2, s2, second)[0]
    np.testing.assert_allclose(1.0 + 2.0 * slope1 * y2, j, rtol=0.0, atol=2e-12)
    np.testing.assert_allclose(2.0 * y1 * slope2 - 1.0, j, rtol=0.0, atol=2e-12)
