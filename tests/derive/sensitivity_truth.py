"""Sensitivities and clearances of the four-bar linkage in many digits.

Nothing here shares a formula with the package.  The motion is that of ``linkage_truth``, and its
derivatives are forward differences with a relative step of 1e-60 in 200 digits; the ranges are
differences of arc cosines.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import mpmath
from judging import Exact, Point, exact_at
from linkage_truth import LENGTHS, motion, nasty_points, random_points

QUANTITIES = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
INPUTS = (*LENGTHS, "theta2")
_DIGITS = 200


def sensitivities(numbers):
    """Return the derivatives of the motion by lengths and crank angle, by name."""
    with mpmath.workdps(_DIGITS):
        here = motion(numbers)
        found = {}
        longest = max(numbers[name] for name in LENGTHS)
        for by in INPUTS:
            step = mpmath.mpf(10) ** -60 * (1 if by == "theta2" else longest)
            there = motion({**numbers, by: numbers[by] + step}, here)
            for quantity in QUANTITIES:
                found[f"{quantity}_by_{by}"] = (there[quantity] - here[quantity]) / step
    return found


@lru_cache(maxsize=1)
def exact_sensitivities() -> tuple[Exact, ...]:
    """Return the exact sensitivities at 60 random and a third of the nasty points.

    Crank angles below 1e-100 are left out: some sensitivities are in proportion to the angle, and
    then below the error of the differences.
    """
    points = random_points(60, seed=27) + nasty_points()[::3]
    points = [point for point in points if not 0 < abs(point.inputs["theta2"]) < 1e-100]
    return tuple(exact_at(sensitivities, point) for point in points)


def clearance_range(numbers):
    """Return the range of an angle of the triangle by the law of cosines alone."""
    base2 = numbers["frame"] ** 2 + numbers["crank"] ** 2
    base2 -= 2 * numbers["frame"] * numbers["crank"] * mpmath.cos(numbers["theta2"])
    turning, opposite, play = (numbers[name] for name in ("turning", "opposite", "play"))

    def angle(side):
        twice = 2 * mpmath.sqrt(base2) * turning
        cosine = (base2 + turning**2 - side**2) / twice
        return mpmath.acos(min(max(cosine, mpmath.mpf(-1)), mpmath.mpf(1)))

    found = {"angle": angle(opposite)}
    found["opened"] = angle(opposite + play) - found["angle"]
    found["closed"] = found["angle"] - angle(opposite - play)
    sine = mpmath.sin(found["angle"])
    found["small"] = 2 * play * opposite / (mpmath.sqrt(base2) * turning * sine)

    def area(side):
        # Heron's formula.
        half = (mpmath.sqrt(base2) + turning + side) / 2
        product = half * (half - turning) * (half - side) * (half - mpmath.sqrt(base2))
        return mpmath.sqrt(max(product, mpmath.mpf(0)))

    found["free"] = area(opposite + play) * area(opposite - play)
    return found


def _with_play(point, share):
    inputs = {
        "theta2": point.inputs["theta2"],
        "frame": point.inputs["frame"],
        "crank": point.inputs["crank"],
        "turning": point.inputs["follower"],
        "opposite": point.inputs["coupler"],
    }
    inputs["play"] = share * min(inputs["turning"], inputs["opposite"])
    return Point(f"{point.name}, play {share:g}", inputs)


@lru_cache(maxsize=1)
def exact_ranges() -> tuple[Exact, ...]:
    """Return exact ranges for plays from 1e-12 to half of a link."""
    points = []
    for i, point in enumerate(random_points(200, seed=28) + nasty_points()):
        points.append(_with_play(point, (1e-12, 1e-6, 1e-3, 1e-2, 0.1, 0.5)[i % 6]))
    return tuple(exact_at(clearance_range, point) for point in points)


EXACT: dict[str, Callable[[], tuple[Exact, ...]]] = {
    "four_bar_clearance": exact_ranges,
    "four_bar_sensitivities": exact_sensitivities,
}
