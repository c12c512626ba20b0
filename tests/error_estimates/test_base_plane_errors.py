"""Bound of the corners of base planes, against meeting points of their lines in 50 digits."""

from itertools import combinations, product

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.base_planes import base_plane
from elastolink.runtime.linkages.classification import SYMBOLS, classify
from honesty import over_scenes

LEAST, MIDDLE = 3.0**-0.5, 3.0**0.5


def distance_of_plane(rng):
    """Return a distance anywhere, or a hair's breadth from where regions appear and vanish."""
    kind = int(rng.integers(4))
    if kind == 0:
        return float(rng.uniform(LEAST, 4.0))
    if kind == 1:
        return LEAST * (1.0 + 10.0 ** rng.uniform(-14.0, -1.0))
    if kind == 2:
        return MIDDLE * (1.0 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-14.0, -1.0))
    return float(10.0 ** rng.uniform(0.3, 12.0))


def meeting_points(conditions, total):
    """Return the corners of what satisfies ``sign (x_i - at) >= 0`` on ``sum x = total``."""
    corners = []
    for (i, a, _), (j, b, _) in combinations(conditions, 2):
        if i == j:
            continue
        point = [total - a - b] * 3
        point[i], point[j] = a, b
        # Three of the lines meet in corners.
        if all(sign * (point[axis] - at) >= -1e-40 for axis, at, sign in conditions):
            corners.append(point)
    return corners


def exact_plane(lam):
    """Return the outline and the regions with an inside."""
    total = mpmath.mpf(lam) * mpmath.sqrt(3)
    far, half = (1 + total) / 2, (total - 1) / 2
    around = [(i, at, sign) for i in range(3) for at, sign in ((mpmath.mpf(0), 1), (far, -1))]
    regions = {}
    for sides in product((1, -1), repeat=3):
        corners = meeting_points([*around, *((i, half, s) for i, s in enumerate(sides))], total)
        if len(corners) < 3:
            continue
        middle = [sum(column) / len(corners) for column in zip(*corners, strict=True)]
        inside = min(min(abs(x - half), x, far - x) for x in middle)
        regions[sides] = (corners, middle, float(inside))
    return meeting_points(around, total), regions


def apart(ours, exact):
    """Return how far each corner of either list is from the nearest one of the other."""

    def between(one, other):
        return max(abs(mpmath.mpf(float(a)) - b) for a, b in zip(one, other, strict=True))

    gaps = [[between(one, other) for other in exact] for one in ours]
    return [float(min(row)) for row in gaps] + [float(min(c)) for c in zip(*gaps, strict=True)]


def errors_of(plane):
    """Return the distances of all corners, and how large the exact regions left out are."""
    outline, regions = exact_plane(plane.lam)
    actual = apart(plane.outline, outline)
    left_out = []
    seen = set()
    for corners, middle, inside in regions.values():
        coupler, output, frame = (float(x) for x in middle)
        symbol = SYMBOLS[int(classify(np.array([[frame, 1.0, coupler, output]]))[0])]
        if symbol in plane.regions:
            actual += apart(plane.regions[symbol], corners)
            seen.add(symbol)
        else:
            left_out.append(inside)
    assert seen == set(plane.regions)
    return max(actual), max(left_out, default=0.0)


@over_scenes(33, floor=1e-20)
def test_bound_of_all_corners(rng):
    with mpmath.workdps(50):
        plane = base_plane(distance_of_plane(rng), 2)
        assert plane.error_kind == "bound"
        actual, left_out = errors_of(plane)
    # Regions are left out only where rounding could close them.
    assert left_out <= 1.1 * plane.error
    assert actual <= plane.error
    return plane.error, actual


def test_the_least_plane_and_the_largest():
    """Next to the end of the range all but one region are below rounding; nothing is NaN."""
    for lam in (float(np.nextafter(LEAST, 1.0)), MIDDLE, 1e16, 9e99):
        plane = base_plane(lam, 3)
        for corners in (plane.outline, *plane.regions.values()):
            assert np.all(np.isfinite(corners))
        assert sum(plane.shares.values()) == pytest.approx(1.0, abs=1e-7)
    with pytest.raises(BadInput, match="lam"):
        base_plane(LEAST)


@pytest.mark.parametrize(
    "given",
    [
        *((lam,) for lam in (None, "a", True, [1.2], np.nan, 0.5)),
        *((1.2, points) for points in (1, 2.5, "a", 10**9)),
    ],
)
def test_unusable_arguments_are_refused_in_one_line(given):
    with pytest.raises(BadInput) as caught:
        base_plane(*given)
    assert "\n" not in str(caught.value)
