"""Tongues of the rod over the crank ratio: feet, ends, growth, bases, tension, lost ones."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import scene_rod
from elastolink.runtime.stability import tongue_curves

SPEEDS = (500.0, 4000.0)
# Six digits: roots of the pinned beam with an overhang, block at 0.59997 L.
FIRST, SECOND = 858.228, 2630.18


@pytest.fixture(scope="module")
def rod():
    return scene_rod(0.1)


@pytest.fixture(scope="module")
def curves(rod):
    return tongue_curves(rod, "crank_ratio", [0.02, 0.05, 0.1], SPEEDS)


def _growth(system, speed):
    values = el.floquet_multipliers(system, speed).multipliers
    return np.log(np.max(np.abs(values), axis=-1)) * speed / (2 * np.pi)


def test_every_tongue_stands_on_its_foot(curves):
    """2 w1/n, (w1 + w2)/n, 2 w2/n, n to 3, as far as they reach the range; none is lost."""
    totals = {"2 w1": 2 * FIRST, "w1 + w2": FIRST + SECOND, "2 w2": 2 * SECOND}
    expected = {
        f"{left} = {'' if n == 1 else f'{n} '}w": total / n
        for left, total in totals.items()
        for n in (1, 2, 3)
        if total / n < 4000.0
    }
    assert set(curves.labels) == set(expected)
    for label, foot in zip(curves.labels, curves.foot, strict=True):
        assert foot == pytest.approx(expected[label], rel=1e-6)
    assert np.all(np.isfinite(curves.lower + curves.upper))
    assert curves.passed
    assert np.all(np.diff(curves.foot) > 0)


def test_ends_are_where_the_multipliers_leave_the_circle(rod, curves):
    """The growth alone, on either side of both ends of every tongue of ratio 0.05."""
    system = rod.with_geometry(crank_ratio=0.05)
    beside = 1e-5 * curves.width[:, 1]
    for ends, outward in ((curves.lower[:, 1], -1.0), (curves.upper[:, 1], 1.0)):
        assert np.all(_growth(system, ends + outward * beside) < 1e-7)
        # Growth starts like a root: so near there is far more of it.
        assert np.all(_growth(system, ends - outward * beside) > 1e-7)


def test_growth_is_that_of_the_multipliers(rod, curves):
    system = rod.with_geometry(crank_ratio=0.1)
    for row in range(len(curves.labels)):
        low, high = curves.lower[row, 2], curves.upper[row, 2]
        speed = np.linspace(low, high, 41)[1:-1]
        best = np.max(_growth(system, speed))
        # Nine places across miss the top of a parabola by 0.6 % at most, usually.
        assert curves.growth[row, 2] == pytest.approx(best, rel=0.02)
        assert curves.growth[row, 2] <= best * 1.0001


def test_width_grows_like_the_power_of_the_harmonic(curves):
    """Tongue n opens like the n-th power of the crank ratio (to the next order)."""
    power = np.log(curves.width[:, 1] / curves.width[:, 0]) / np.log(2.5)
    # Not those about 1750 rad/s, three beside each other.
    own_powers = {"w1 + w2 = w": 1, "2 w1 = 2 w": 2, "2 w1 = 3 w": 3, "w1 + w2 = 3 w": 3}
    for label, own in own_powers.items():
        assert power[curves.labels.index(label)] == pytest.approx(own, abs=0.1)


@pytest.mark.slow
def test_without_tension_the_chart_is_another(rod):
    """As printed: at ratio 0.1 the first tongue's upper end is 40 rad/s lower, at 0.02 only 2."""
    values = [0.02, 0.1]
    found = [
        tongue_curves(system, "crank_ratio", values, (1400.0, 1800.0), highest=1)
        for system in (rod, scene_rod(0.1, **{"model.drop": ["as_printed"]}))
    ]
    row = [one.labels.index("2 w1 = w") for one in found]
    upper = [one.upper[i] for one, i in zip(found, row, strict=True)]
    np.testing.assert_allclose(upper[0] - upper[1], [2.24, 42.8], rtol=0.02)


@pytest.mark.slow
def test_a_tongue_that_reaches_beyond_the_range_keeps_its_lower_end(rod):
    """w1 + w2 = w opens to half its speed; the averaged equation has no modes to name it after."""
    values = [0.05, 0.1, 0.2, 0.3]
    found = tongue_curves(rod, "crank_ratio", values, (3000.0, 4000.0), highest=1)
    row = found.labels.index("w1 + w2 = w")
    assert np.all(np.isfinite(found.lower[row]))
    assert np.isfinite(found.upper[row]).tolist() == [True, True, False, False]
    assert np.isnan(found.growth[row, 3])
    grows = _growth(
        rod.with_geometry(crank_ratio=0.3), found.lower[row, 3] * np.array([0.999, 1.001])
    )
    assert grows[0] < 1e-6 < grows[1]


def test_picture(curves):
    assert curves.plot().get_xlabel().startswith("crank speed")
