"""Bounds of trade-off points, against circles: the crank's counterweight turns with the crank.

Seen from the crank its force is one complex number c, the same at every angle, and the least peak
of ``F(theta) + c`` under a limit to another peak a question of circles in the plane.  All centres
that two or three of them determine are tried, in extended precision.
"""

from itertools import combinations

import numpy as np
from balancing_machines import nine_equations, random_machine
from elastolink.runtime.rigid import Bounds, trade_off
from honesty import extended, over_scenes

pytestmark = extended
POINTS = 5  # of each curve: 210 estimates in all


def seen_from_crank(machine, theta, speed, acceleration):
    """Return both forces as complex numbers in the axes of the crank, over their peaks."""
    found = nine_equations(machine, theta, speed, acceleration)
    turned = []
    for name in ("shaking_force", "f12"):
        force = found[name].astype(np.longdouble)
        turned.append((force[:, 0] + 1j * force[:, 1]) * np.exp(-1j * theta.astype(np.longdouble)))
    return turned


def on_two_circles(one, first, two, second):
    """Return where two circles meet: centres and radii, arrays or numbers."""
    apart = two - one
    distance = np.abs(apart)
    along = (distance**2 + first**2 - second**2) / (2 * distance)
    across = np.sqrt(np.maximum(first**2 - along**2, 0))
    unit = apart / distance
    return np.concatenate([one + unit * (along + 1j * across), one + unit * (along - 1j * across)])


def with_bisectors(a, b, centre, radius):
    """Return the points of a circle that are as far from a as from b."""
    unit = 1j * (b - a) / np.abs(b - a)
    middle = (a + b) / 2 - centre
    along = (middle * np.conj(unit)).real
    square = along**2 - np.abs(middle) ** 2 + radius**2
    root = np.sqrt(np.maximum(square, 0))
    return np.concatenate([centre + middle + unit * (-along + s * root) for s in (1, -1)])


def circumcentres(a, b, c):
    p, q = b - a, c - a
    cross = 2 * (p.real * q.imag - p.imag * q.real)
    return a - 1j * (p * np.abs(q) ** 2 - q * np.abs(p) ** 2) / cross


def least_radius(points, circles):
    """Return the least radius about a place within all circles that holds all points.

    An optimum in the plane has two or three circles through it: of points, or limits.
    """
    i, j = (np.array(v) for v in zip(*combinations(range(len(points)), 2), strict=True))
    i3, j3, k3 = (np.array(v) for v in zip(*combinations(range(len(points)), 3), strict=True))
    tried = [(points[i] + points[j]) / 2, circumcentres(points[i3], points[j3], points[k3])]
    for centre, radius in circles:
        tried.append(with_bisectors(points[i], points[j], centre, radius))
        away = points - centre
        tried.append(centre + away / np.abs(away) * radius)
    for (one, first), (two, second) in combinations(circles, 2):
        if first + second >= abs(two - one) >= abs(first - second):
            tried.append(on_two_circles(np.array([one]), first, np.array([two]), second))
    places = np.concatenate(tried)
    places = places[np.isfinite(places)]
    outside = np.max([np.abs(places - c) / r - 1 for c, r in circles], axis=0)
    places = places[outside < 1e-17]
    return float(np.min(np.max(np.abs(places[:, None] - points), axis=1)))


def scene(rng):
    """Return a machine, angles, speed, acceleration and bounds, tight ones among them."""
    machine = random_machine(rng)
    theta = np.sort(rng.uniform(0.0, 2.0 * np.pi, int(rng.integers(6, 17))))
    speed = float(10.0 ** rng.uniform(-2.0, 3.0))
    acceleration = float(rng.choice([0.0, 0.3])) * speed**2
    bounds = Bounds(mass=float(10.0 ** rng.uniform(-1.0, 2.0)), offset=1.0)
    return machine, theta, speed, acceleration, bounds


@over_scenes(34, few=4, many=24, floor=np.finfo(float).eps)
def test_bounds_of_points_hold_and_are_not_idle(rng):
    """All are of the order of 1: no difference below its round-off means anything."""
    return bounds_and_errors(*scene(rng))


def test_a_point_that_passes_its_limit_by_the_last_digits_tells_what_that_is_worth():
    """The second of five is 4e-11 over its limit, and 2e-12 above the least at its first peak."""
    rng = np.random.default_rng(121034)
    *_, chosen = (scene(rng) for _ in range(17))
    bounds_and_errors(*chosen)


def bounds_and_errors(machine, theta, speed, acceleration, bounds):
    """Return the bounds of all points, which hold, and how far these are from the least ones."""
    found = trade_off(
        machine,
        speed,
        "shaking_force",
        "f12",
        POINTS,
        acceleration=acceleration,
        links=("crank",),
        bounds=bounds,
        angles=theta,
    )
    assert found.passed
    first, second = seen_from_crank(machine, theta, speed, acceleration)
    # A mass m at r pulls with m r (w^2 - i alpha) along the crank.
    reach = bounds.mass * bounds.offset * np.hypot(speed**2, acceleration)
    peak, size = np.max(np.abs(first)), np.max(np.abs(second))
    above = []
    for x, y, error in zip(found.first_values, found.second_values, found.error, strict=True):
        # f12 is the pull of the frame on the crank, the shaking force that on the frame.
        limits = [(-z / size, x * peak / size) for z in first]
        least = least_radius(second / size, [*limits, (0 * peak, reach / size)])
        assert y - least <= error
        # The bound is of what lies above.
        above.append(max(y - least, 0.0))
    return found.error, above
