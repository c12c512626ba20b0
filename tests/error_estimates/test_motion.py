"""The estimates of the motions of all linkages against 80 digits, random and nasty ones."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from honesty import covers
from judging import Point
from linkage_truth import LENGTHS, nasty_points, random_points
from linkage_truth import motion as four_bar_motion
from sliding_truth import (
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)

OPEN = {"assembly": 1.0}
TRUTHS = {FourBar: four_bar_motion, SliderCrank: slider_motion, QuickReturn: rod_motion}
SPEED, ACCELERATION = 3.0, -2.0


def compared(kind, point):
    """Return the motion, and how far each of its places and rates is off."""
    lengths = {name: value for name, value in point.inputs.items() if name != "theta2"}
    if kind is QuickReturn:
        lengths["rod"] = lengths["frame"] + lengths["crank"]
    else:
        lengths["assembly"] = "open" if point.fixed["assembly"] > 0 else "crossed"
    motion = kind(**lengths).motion(point.inputs["theta2"])
    actual = {}
    with mpmath.workdps(80):
        truth = TRUTHS[kind]({name: mpmath.mpf(v) for name, v in point.arguments.items()})
        for name in set(truth) & set(motion.errors):
            apart, turn = mpmath.mpf(float(getattr(motion, name))) - truth[name], 2 * mpmath.pi
            if name in ("theta3", "theta4"):
                apart -= turn * mpmath.nint(apart / turn)
            actual[name] = float(abs(apart))
    return motion, actual


def short_followers(count, seed):
    """Return linkages whose follower is short, at angles near their folds and far from them."""
    random = np.random.default_rng(seed)
    found = []
    while len(found) < count:
        lengths = [*random.uniform(0.1, 1.0, 3), 10.0 ** random.uniform(-4.0, -2.5)]
        # The follower closes what is left: the links are about as long as each other in pairs.
        lengths[2] = abs(lengths[0] + random.choice([-1.0, 1.0]) * lengths[1])
        lengths[2] += random.uniform(-0.9, 0.9) * lengths[3]
        assembly = random.choice(["open", "crossed"])
        try:
            low, high = FourBar(*map(float, lengths), assembly).crank_ranges()[0]
        except BadInput:
            continue
        theta = low + random.uniform(0.001, 0.999) * (high - low)
        inputs = {**dict(zip(LENGTHS, map(float, lengths), strict=True)), "theta2": float(theta)}
        sign = {"assembly": 1.0 if assembly == "open" else -1.0}
        found.append(Point("short follower", inputs, sign))
    return found


# Without the round-off of the diagonal the estimate was a ninth and a twentieth of the error.
KNOWN = [
    Point("short follower", {**dict(zip(LENGTHS, lengths, strict=True)), "theta2": theta}, OPEN)
    for theta, *lengths in (
        (
            -1.0777686207770751,
            0.741033130955611,
            0.6482593665690473,
            0.7160953146978349,
            0.0017731521690162362,
        ),
        (
            -3.141459496765695,
            987635.9984780651,
            690374.4558117427,
            1675199.272225518,
            2811.182003136147,
        ),
    )
]
RANDOM = {
    "four-bar": (FourBar, random_points, 31),
    "slider-crank": (SliderCrank, random_sliders, 32),
    "quick-return": (QuickReturn, random_rods, 33),
    "short follower": (FourBar, short_followers, 3),
}
NASTY = {
    "four-bar": (FourBar, lambda: nasty_points() + KNOWN),
    "slider-crank": (SliderCrank, nasty_sliders),
    "quick-return": (QuickReturn, nasty_rods),
}


def every_error_is_known(kind, points):
    """Ask for the error itself, but for the round-off of pi and what is beyond 32 digits.

    Return estimates and actual errors of all places together.
    """
    estimates, worst = [], []
    for point in points:
        motion, actual = compared(kind, point)
        assert len(actual) >= 5
        for name, error in actual.items():
            size = abs(float(getattr(motion, name)))
            told = float(motion.errors[name])
            assert error <= 1.001 * told + 1e-19 * size + 1e-300, name
            angle = motion.unit_of(name) == "rad"
            rounding = (2.3e-16 if angle else 1e-19) * size
            assert told <= 1.001 * error + rounding + 1e-300, name
        sizes = {"theta3": 1.0, "theta4": 1.0, "slide": motion.linkage.lengths.get("rod")}
        sizes["position"] = max(map(abs, motion.linkage.lengths.values()))
        estimates.append(float(motion.error))
        worst.append(max(actual[name] / sizes[name] for name in set(actual) & set(sizes)))
    return estimates, worst


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", RANDOM)
def test_estimates_cover_the_errors_and_are_not_idle(kind, count):
    linkage, points, seed = RANDOM[kind]
    covers(*every_error_is_known(linkage, points(count, seed)), count)


def points_of_links(kind, point, along, across):
    """Return told and actual errors of a point of each link that the truth knows, driven."""
    linkage, told, actual = compared(kind, point)[0].linkage, [], []
    motion = linkage.motion(point.inputs["theta2"], SPEED, ACCELERATION)
    with mpmath.workdps(80):
        truth = TRUTHS[kind]({name: mpmath.mpf(v) for name, v in point.arguments.items()})

        def driven(place, first, second):
            return [place, SPEED * first, SPEED**2 * second + ACCELERATION * first]

        turn = {"crank": driven(mpmath.mpf(point.inputs["theta2"]), 1, 0)}
        for name, number in (("coupler", "3"), ("follower", "4"), ("rod", "4"), ("block", "4")):
            if name in linkage.links and f"theta{number}" in truth:
                turn[name] = driven(*(truth[rate + number] for rate in ("theta", "omega", "alpha")))
        pin = _turning(*turn["crank"], mpmath.mpf(linkage.lengths["crank"]))
        frame = mpmath.mpf(linkage.lengths.get("frame", 0))
        origins = {"crank": [0, 0, 0], "coupler": pin, "block": pin}
        origins |= {"follower": [frame, 0, 0], "rod": [-frame, 0, 0]}
        if kind is SliderCrank:
            turn["slider"] = [0, 0, 0]
            rates = (truth[f"slider_{rate}"] for rate in ("velocity", "acceleration"))
            origins["slider"] = driven(mpmath.mpc(truth["position"], linkage.offset), *rates)
        for name, rates in turn.items():
            exact = _turning(*rates, mpmath.mpc(along, across))
            exact = [
                one + more for one, more in zip(exact, origins.get(name, [0] * 3), strict=True)
            ]
            found = vars(motion.point(name, along, across))
            errors = vars(motion.point_errors(name, along, across))
            for (field, value), true in zip(found.items(), exact, strict=True):
                for k, part in enumerate((true.real, true.imag)):
                    actual.append(float(abs(mpmath.mpf(float(value[k])) - part)))
                    told.append(float(errors[field][k]))
    return told, actual


def _turning(angle, speed, change, vector):
    """Return place, velocity and acceleration of a complex vector that turns."""
    vector = mpmath.mpc(vector) * mpmath.expj(angle)
    return [vector, 1j * speed * vector, (1j * change - speed**2) * vector]


@pytest.mark.parametrize("count", [20, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", RANDOM)
def test_points_of_links_tell_their_errors(kind, count):
    linkage, points, seed = RANDOM[kind]
    random = np.random.default_rng(seed)
    told, actual = [], []
    for point in points(count, seed):
        size = max(abs(v) for name, v in point.inputs.items() if name != "theta2")
        more = points_of_links(linkage, point, *map(float, size * random.uniform(-2.0, 2.0, 2)))
        told += more[0]
        actual += more[1]
    covers(told, actual)


@pytest.mark.parametrize("kind", NASTY)
def test_estimates_cover_the_errors_at_every_nasty_point(kind):
    linkage, points = NASTY[kind]
    estimates, worst = every_error_is_known(linkage, points())
    assert np.all(np.array(worst) <= estimates)
    covers(estimates, worst)
