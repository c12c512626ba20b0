"""Slow driving: tongues of high order, and the practical range of the rod."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import scene_rod
from elastolink.runtime.stability import tongue_curves
from scipy.integrate import quad


def relative_widths(system, name, value, orders, frequency):
    """Return the measured widths over speed of ``2 w1 = n w``; NaN below what doubles resolve."""
    span = (2.0 * frequency / (orders[-1] + 0.5), 2.0 * frequency / (orders[0] - 0.5))
    found = tongue_curves(system, name, [value], span, highest=orders[-1], modes=1)
    width, least = found.upper - found.lower, found.error
    fine = np.where(width > 50.0 * least, 2.0 * width / (found.lower + found.upper), np.nan)
    rows = dict(zip(found.harmonic.tolist(), fine[:, 0], strict=True))
    return np.array([rows.get(n, np.nan) for n in orders])


def carried_on(orders, widths, lowest):
    """Return the slope of ``ln(n width)`` and the width at a higher order, lifted by its doubt.

    The slope is still settling: the upper half of the orders shows more of those to come, and by as
    much as it differs from that of the lower half it may settle further.
    """
    kept = np.isfinite(widths)
    n, logs = np.array(orders, dtype=float)[kept], np.log(np.array(orders) * widths)[kept]
    half = len(n) // 2
    (late, spread), (early, _), (_, whole) = (
        np.polyfit(n[part], logs[part], 1, cov="unscaled")
        for part in (slice(half, None), slice(half), slice(None))
    )
    rest = logs - np.polyval(np.polyfit(n, logs, 1), n)
    doubt = np.sqrt(max(spread[0, 0], whole[0, 0]) * np.sum(rest**2) / max(len(n) - 2, 1))
    ahead = lowest - np.mean(n[half:])
    lift = (3.0 * doubt + abs(late[0] - early[0])) * ahead + np.max(np.abs(rest))
    return late[0], np.exp(np.polyval(late, lowest) + lift) / lowest


ORDERS = tuple(range(4, 13))
SHARE = 0.5
COSINE = el.PeriodicFunction([0.0, 1.0])


@pytest.fixture(scope="module")
def mathieu():
    """Relative widths in speed of q'' + (1 + share cos theta) q / w^2 = 0, by Hill's matrix.

    There lam2 = 1/w^2 and mu = share lam2.
    """
    widths = []
    for n in ORDERS:
        lam2 = np.full(2, 0.25 * n * n)
        for _ in range(60):
            ends = el.hill_boundaries(COSINE, SHARE * lam2, (n,))
            lam2 = np.array([ends.lower[0, 0], ends.upper[0, 1]])
        speed = 1.0 / np.sqrt(lam2)
        widths.append((speed[0] - speed[1]) / speed.mean())
    return np.array(widths)


def test_slope_is_that_of_the_complex_turning_point(mathieu):
    """WKB: ln(width) falls by Im of the integral of omega to where it is zero, over its mean.

    omega^2 = 1 + share cos theta is zero at pi + i acosh(1/share).
    """
    barrier, _ = quad(lambda y: np.sqrt(1 - SHARE * np.cosh(y)), 0.0, np.arccosh(1 / SHARE))
    mean, _ = quad(lambda theta: np.sqrt(1 + SHARE * np.cos(theta)) / np.pi, 0.0, np.pi)
    # A factor of the width that is a power of n still bends the line: by 1/8 or so at n = 8.
    assert carried_on(ORDERS, mathieu, 12)[0] == pytest.approx(-barrier / mean, abs=0.15)


def test_the_estimate_lies_above_a_tongue_left_out(mathieu):
    """Orders 4 to 9 alone promise more than what order 12 has."""
    _, estimate = carried_on(ORDERS[:6], mathieu[:6], 12)
    actual = mathieu[ORDERS.index(12)]
    assert actual < estimate < 20 * actual


@pytest.mark.slow
def test_practical_range_of_the_rod():
    """Speeds to 20 rad/s, ratio 0.3: the lowest order is 86, its tongue below 1e-18 rad/s."""
    orders = tuple(range(8, 16))
    widths = relative_widths(scene_rod(0.3), "crank_ratio", 0.3, orders, 858.23)
    assert np.all(np.isfinite(widths))
    assert widths[-1] < 1e-5
    slope, estimate = carried_on(orders, widths, 86)
    assert int(np.ceil(2 * 858.23 / 20.0)) == 86
    assert 0.55 < -slope < 0.8
    assert 20.0 * estimate < 1e-18


@pytest.mark.parametrize(
    ("ratio", "modes"),
    [(0.3, 2), *(pytest.param(*c, marks=pytest.mark.slow) for c in ((0.1, 2), (0.3, 4)))],
)
def test_multipliers_of_the_practical_range_are_on_the_circle(ratio, modes):
    """Every one of a definite signature, which no small change can bring off the circle."""
    speed = np.array([4.1, 7.7, 12.3, 16.9, 20.0])[modes - 2 :]
    rod = scene_rod(ratio, modes)
    found = el.floquet_multipliers(rod, speed, rtol=1e-10)
    assert found.signatures is not None
    assert np.all(np.abs(found.signatures) == 1)
    assert np.all(np.abs(np.log(np.abs(found.multipliers))) <= 2 * found.error)
    assert np.max(found.error) < 1e-9
