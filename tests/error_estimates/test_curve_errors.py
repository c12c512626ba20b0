"""The estimates of coupler curves and harmonics against many digits, over random linkages."""

import math

import mpmath
import numpy as np
from elastolink.runtime.linkages.curves import coupler_curve
from elastolink.runtime.linkages.harmonic_analysis import harmonics
from honesty import over_scenes
from random_linkages import random_linkage


def exact_place(linkage, theta, branch, place):
    """Return the coupler point from the crank angle by intersecting two circles."""
    f, c, m, n = (mpmath.mpf(v) for v in linkage.lengths.values())
    pin = c * mpmath.expj(mpmath.mpf(theta))
    line = f - pin
    square = abs(line) ** 2
    along = (square + m**2 - n**2) / 2
    across = mpmath.sqrt(m**2 * square - along**2) * branch
    return pin + mpmath.mpc(place) * line * mpmath.mpc(along, across) / (square * m)


@over_scenes(5, few=None, many=50)
def test_positions_of_turning_cranks(rng):
    linkage = random_linkage(rng, "four-bar", 3.0)
    if not linkage.crank_turns:
        return None
    place = complex(*rng.uniform(-2, 2, 2))
    curve = coupler_curve(linkage, place.real, place.imag, points=97)
    gaps, picked = [], rng.integers(0, 97, 3)
    with mpmath.workdps(40):
        for i in picked:
            exact = exact_place(linkage, curve.theta2[i], curve.branch[i], place)
            gaps.append(float(abs(mpmath.mpc(*map(float, curve.position[i])) - exact)))
    return curve.error[picked], gaps


@over_scenes(6, few=5, many=40, median=np.inf)
def test_lengths_and_areas(rng):
    """By the trapezoidal rule, which converges geometrically on a closed analytic path."""
    linkage = random_linkage(rng, "four-bar", 3.0)
    if not linkage.crank_turns:
        return None
    curve = coupler_curve(linkage, *rng.uniform(-2, 2, 2), points=2**11)
    if curve.slowest < 0.05:
        return None
    step = 2 * np.pi / 2**11
    length = math.fsum(np.hypot(*curve.velocity.T)) * step
    turned = curve.position[:, 0] * curve.velocity[:, 1]
    turned -= curve.position[:, 1] * curve.velocity[:, 0]
    area = 0.5 * math.fsum(turned) * step
    # The velocities bring a round-off of their own, averaged over 2048 of them.
    own = 0.4 * float(np.max(curve.error))
    return {
        "length": (curve.length_error, max(abs(curve.length - length) - own, 0)),
        "area": (curve.area_error, max(abs(curve.area - area) - own, 0)),
    }


@over_scenes(7)
def test_harmonics_of_known_series(rng):
    # 1/(1 - 2 r cos(t - s) + r^2): coefficients 2 r^m cos ms/(1 - r^2), and with sines.
    r, s, size = rng.uniform(0.05, 0.97), rng.uniform(0, 6), 10 ** rng.uniform(-6, 6)

    def f(theta):
        return size / ((1 - r) ** 2 + 4 * r * np.sin((theta - s) / 2) ** 2)

    found = harmonics(f, order=6, accuracy=10 ** rng.uniform(-13, -3))
    with mpmath.workdps(30):
        worst = mpmath.mpf(0)
        for m in range(7):
            scale = (1 if m == 0 else 2) * mpmath.mpf(size) / (1 - mpmath.mpf(r) ** 2)
            exact = scale * mpmath.mpf(r) ** m * mpmath.expj(m * mpmath.mpf(s))
            worst = max(worst, abs(found.a[m] - exact.real), abs(found.b[m] - exact.imag))
    return float(found.error), float(worst)
