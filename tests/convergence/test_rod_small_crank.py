"""The rod's tongues for a small crank: perturbation in the crank ratio against the exact ends."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.stability import resonances, tongue
from geometry_series import taylor_in_geometry

# Frequencies [rad/s] of the rod held still on the block at 0.59997 L: roots of the pinned beam
# with an overhang, six digits.
FIRST, SECOND = 858.227967, 2630.179473
RATIOS = np.array([0.0015, 0.003, 0.006])


def _rod(ratio=0.1, modes=2):
    return el.load_scene(
        "beale_1992_flexible_rod",
        overrides={"links.crank_ratio": ratio, "model.modes": modes},
    ).linear_system()


@pytest.fixture(scope="module")
def rod():
    return _rod()


@pytest.fixture(scope="module")
def series(rod):
    return taylor_in_geometry(rod, "crank_ratio", 6)


# ---------------------------------------------------------------- the expanded system


@pytest.mark.parametrize("order", [1, 4])
def test_the_expanded_system_is_the_system_to_its_order(rod, order):
    """What is left out falls like the next power of the ratio, in every array."""
    theta = np.linspace(0.0, 6.0, 11)
    expanded = taylor_in_geometry(rod, "crank_ratio", order)
    for name in "ABK":
        gaps = []
        for ratio in (0.01, 0.02):
            exact = rod.with_geometry(crank_ratio=ratio).array(name, theta)
            gap = expanded.array(name, theta, crank_ratio=ratio) - exact
            gaps.append(np.max(np.abs(gap)))
        slope = np.log2(gaps[1] / gaps[0])
        # B starts at the second order; between 0.01 and 0.02 the next power but one still shows.
        assert order + 0.8 < slope < order + 1.6, name


# ---------------------------------------------------------------- feet and ends


def test_feet_are_where_the_paper_says(series):
    """Beale & Scott, section 3.1: 2 w1/n, (w1 + w2)/n and 2 w2/n, n = 1, 2, 3."""
    found = resonances(
        series, (400.0, 6000.0), kinds=("principal", "sum"), highest=3, crank_ratio=0.0
    )
    expected = {
        f"{left} = {'' if n == 1 else f'{n} '}w": total / n
        for left, total in (
            ("2 w1", 2 * FIRST),
            ("w1 + w2", FIRST + SECOND),
            ("2 w2", 2 * SECOND),
        )
        for n in (1, 2, 3)
    }
    got = {one.label: one.speed for one in found}
    assert got.keys() == expected.keys()
    for label, speed in expected.items():
        assert got[label] == pytest.approx(speed, rel=1e-8), label
    assert all(one.opens for one in found)


def _foot(series, label):
    found = resonances(series, (400.0, 6000.0), kinds=("principal",), highest=3, crank_ratio=0.0)
    return next(one for one in found if one.label == label)


def _exact(rod, window, sign):
    """Return the two ends in a window of speeds at each ratio, ``(2, ratios)``: Fourier."""
    found = []
    for ratio in RATIOS:
        made = rod.with_geometry(crank_ratio=float(ratio))
        ends = el.speed_boundaries(made, sign, speed_range=window).speed
        assert len(ends) == 2
        found.append(np.sort(ends))
    return np.array(found).T


@pytest.fixture(scope="module")
def first_ends(rod):
    return _exact(rod, (1660.0, 1735.0), -1)


@pytest.mark.parametrize(
    "order", [2, *[pytest.param(p, marks=pytest.mark.slow) for p in (1, 3, 4)]]
)
def test_first_tongue_converges_with_the_order(series, first_ends, order):
    """2 w1 = w: the error of order p falls like power p + 1 of the crank ratio."""
    found = tongue(
        series, _foot(series, "2 w1 = w"), parameter=("crank_ratio", RATIOS), order=order
    )
    assert found.expansion == "parameter"
    assert np.all(found.open)
    gap = np.max(np.abs(np.stack([found.lower, found.upper]) - first_ends), axis=0)
    slope = np.log2(gap[1:] / gap[:-1])
    # w1 + w2 = 2 w stands 1.6 % away, so powers follow each other like ratio/0.016: with x of the
    # second to the first omitted one the slope is off by log2((1 + 2 x)/(1 + x)), 0.1 to 0.3.
    assert abs(slope[1] - (order + 1)) < 0.35
    if order == 4:
        # At the least ratio the error is about the round-off of the ends, 1e-11.
        assert gap[0] < 1e-9
    else:
        assert abs(slope[0] - (order + 1)) < 0.25
        # What is left out is the next power: the next order brings nearly all of it.
        better = tongue(
            series, _foot(series, "2 w1 = w"), parameter=("crank_ratio", RATIOS), order=order + 1
        )
        brought = np.stack([better.lower - found.lower, better.upper - found.upper])
        missing = first_ends - np.stack([found.lower, found.upper])
        np.testing.assert_allclose(brought[:, 0], missing[:, 0], rtol=0.0, atol=0.15 * gap[0])
    assert np.all(gap <= found.error)


def test_second_tongue_opens_at_second_order(rod, series):
    """2 w1 = 2 w: closed at first order, width as the ratio squared; ends right at order 4."""
    foot = _foot(series, "2 w1 = 2 w")
    exact = _exact(rod, (856.0, 860.0), 1)
    closed = tongue(series, foot, parameter=("crank_ratio", RATIOS), order=1)
    assert np.all(closed.lower == closed.upper)
    found = tongue(series, foot, parameter=("crank_ratio", RATIOS), order=4)
    width = exact[1] - exact[0]
    np.testing.assert_allclose(np.log2(width[1:] / width[:-1]), 2.0, atol=0.02)
    gap = np.abs(np.stack([found.lower, found.upper]) - exact)
    assert np.all(gap <= found.error)
    assert np.all(gap[:, 0] < 1e-4 * width[0])
