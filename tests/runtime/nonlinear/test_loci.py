"""Folds and doublings in two parameters, against exact boundaries of Hill's equation."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.nonlinear import special_curve
from planted import duffing

DAMPING = 0.05


def test_doublings_of_rest_lie_on_the_boundaries_of_mathieus_equation():
    # q'' + c q' + (1 + p cos(w t)) q: lam2 = 1 / w^2, mu = p / w^2, 2 K = c / w.
    system = duffing(DAMPING, 0.2, 0.0, pumped=0.3)
    curve = el.response_curve(system, "speed", (1.7, 2.3))
    assert curve.special == ("doubling", "doubling")
    locus = special_curve(curve, 0, "pumping", (0.2, 1.2))
    # It goes round the tip of the tongue, and up on the other side.
    assert locus.first.min() < 1.9 < 2.1 < locus.first.max()
    f = el.PeriodicFunction(a=[0.0, 1.0])
    for speed, pumping, error in list(zip(locus.first, locus.second, locus.error, strict=True))[
        ::5
    ]:
        mu = 0.3 * pumping / speed**2
        exact = el.hill_boundaries(f, mu, regions=(1,), damping=DAMPING / (2.0 * speed))
        ends = 1.0 / np.sqrt(np.array([exact.lower[0], exact.upper[0]]))
        # The boundary depends on the speed through mu and K, too: a small residue of lam2 decides.
        residue = np.min(np.abs(ends - speed)) / speed
        assert residue < 1e-9 + 10.0 * error, (speed, pumping)


@pytest.fixture(scope="module")
def curve():
    return el.response_curve(duffing(), "speed", (0.8, 1.6))


def test_the_two_folds_of_a_resonance_are_one_curve(curve):
    # Folds of Duffing's equation meet in a cusp where the force gets small.
    system = duffing()
    assert curve.special == ("fold", "fold")
    ends = []
    for number in (0, 1):
        locus = special_curve(curve, number, "force", (0.05, 1.5))
        assert np.all(np.isfinite(locus.error))
        assert locus.error.max() < 1e-6
        at = np.argmin(locus.second)
        ends.append((locus.first[at], locus.second[at]))
        # Each fold at another force is that of the response curve there.
        some = len(locus.first) // 3
        moved = system.with_parameters(force=float(locus.second[some]))
        again = el.response_curve(moved, "speed", (0.8, 1.6))
        gap = np.min(np.abs(again.special_value - locus.first[some]))
        assert gap < 1e-8
    assert ends[0] == pytest.approx(ends[1], rel=0.05)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ((7, "force", (0.5, 1.5)), "number"),
        ((0, "speed", (0.5, 1.5)), "parameter"),
        ((0, "mass", (0.5, 1.5)), "parameter"),
        ((0, "force", (1.5, 0.5)), "bounds"),
        ((0, "force", (1.2, 1.5)), "bounds"),
    ],
)
def test_refusals(curve, arguments, word):
    with pytest.raises(BadInput, match=word):
        special_curve(curve, *arguments)
