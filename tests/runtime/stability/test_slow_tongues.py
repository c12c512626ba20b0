"""Slow driving: tongues of high order, the estimate below a speed, the practical range."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.slow_driving import slow_tongues


def _rod(ratio, **more):
    return el.load_scene(
        "beale_1992_flexible_rod",
        overrides={"links.crank_ratio": ratio, "model.modes": 2, **more},
    ).linear_system()


def _mathieu():
    """One oscillator of 1 rad/s, its stiffness pulled by a share cos theta."""
    return LinearPeriodic(
        1,
        (
            Term("M", None, np.eye(1)),
            Term("K", None, np.eye(1)),
            Term("K", "share", lambda theta: np.cos(theta)[:, None, None] * np.eye(1)),
        ),
        {"share": 0.3},
        lambda values: {"share": np.asarray(values["share"], dtype=float)},
    )


@pytest.fixture(scope="module")
def mathieu():
    return slow_tongues(_mathieu(), 0.1, "share", [0.3, 0.5], orders=range(4, 13))


def test_widths_are_those_of_fouriers_method(mathieu):
    """Orders 4 to 6 at a share of 0.5, ends of periodic solutions."""
    system = _mathieu().with_parameters(share=0.5)
    for n in (4, 5, 6):
        ends = el.speed_boundaries(
            system, 1 if n % 2 == 0 else -1, speed_range=(1.85 / n, 2.02 / n)
        ).speed
        assert len(ends) == 2
        width = (ends[1] - ends[0]) / np.mean(ends)
        found = mathieu.relative_width[0, 1, mathieu.order.tolist().index(n)]
        assert found == pytest.approx(width, rel=1e-6)


def test_slope_is_that_of_the_complex_turning_point(mathieu):
    """WKB: ln(width) falls by Im of the integral of omega to where it is zero, over its mean.

    omega^2 = 1 + share cos theta is zero at pi + i acosh(1/share).
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for column, share in enumerate((0.3, 0.5)):
        depth = np.arccosh(1 / share)
        # y = depth sin s takes the root at the end away.
        s = 0.25 * np.pi * (nodes + 1)
        inside = np.sqrt(np.maximum(1 - share * np.cosh(depth * np.sin(s)), 0.0))
        barrier = float(np.sum(0.25 * np.pi * weights * inside * depth * np.cos(s)))
        theta = 2 * np.pi * np.arange(256) / 256
        mean = float(np.mean(np.sqrt(1 + share * np.cos(theta))))
        # A factor of the width that is a power of n still bends the line: by 1/8 or so at n = 8.
        assert mathieu.slope[0, column] == pytest.approx(-barrier / mean, abs=0.15)


def test_the_estimate_lies_above_a_tongue_left_out(mathieu):
    """Orders 4 to 9 alone promise more than what orders 11 and 12 have."""
    few = slow_tongues(_mathieu(), 2 / 11.5, "share", [0.5], orders=range(4, 10))
    assert few.lowest[0] == 12
    row = mathieu.order.tolist().index(12)
    actual = mathieu.relative_width[0, 1, row] * 2 / 11.5
    assert actual < few.largest_width[0, 0] < 20 * actual


@pytest.mark.slow
def test_practical_range_of_the_rod():
    """Speeds to 20 rad/s, ratio 0.3: the lowest order is 86, its tongue below 1e-18 rad/s."""
    found = slow_tongues(_rod(0.3), 20.0, "crank_ratio", [0.3], orders=range(8, 19))
    assert found.passed
    assert found.lowest[0] == 86
    assert np.all(np.isfinite(found.relative_width))
    assert found.relative_width[0, 0, -1] < 1e-6
    assert 0.55 < -found.slope[0, 0] < 0.8
    assert found.largest_width[0, 0] < 1e-18


@pytest.mark.parametrize("modes", [2, 4])
@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_multipliers_of_the_practical_range_are_on_the_circle(ratio, modes):
    """Every one of a definite signature, which no small change can bring off the circle."""
    speed = np.array([4.1, 7.7, 12.3, 16.9, 20.0])[modes - 2 :]
    rod = _rod(ratio, **{"model.modes": modes})
    found = el.floquet_multipliers(rod, speed, rtol=1e-10)
    assert found.signatures is not None
    assert np.all(np.abs(found.signatures) == 1)
    assert np.all(np.abs(np.log(np.abs(found.multipliers))) <= 2 * found.error)
    assert np.max(found.error) < 1e-9


@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_viscous_damping_takes_its_rate_from_every_growth(ratio):
    """0.2 percent: the slowest decay in the practical range is zeta w1 itself, 1.716 1/s."""
    damped = _rod(ratio, **{"rod.damping_ratio": 0.002, "rod.damping_law": "viscous"})
    speed = np.array([5.3, 11.0, 20.0])
    values = el.floquet_multipliers(damped, speed, rtol=1e-9).multipliers
    rate = np.log(np.abs(values)) * speed[:, None] / (2 * np.pi)
    np.testing.assert_allclose(rate, -0.002 * 858.228, rtol=1e-5)


@pytest.mark.parametrize(
    "changes",
    [
        {"speed": -1.0},
        {"speed": 1.0},
        {"orders": ()},
        {"orders": (0, 1)},
        {"pairs": ((1, 2),)},
        {"name": "stiffness"},
    ],
)
def test_bad_arguments_are_refused(changes):
    given = {"speed": 0.1, "name": "share", "values": [0.3], "orders": (4, 5, 6, 7), **changes}
    with pytest.raises(BadInput):
        slow_tongues(_mathieu(), **given)
