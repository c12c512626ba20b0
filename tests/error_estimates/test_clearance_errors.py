"""The error estimate of clearance ranges against 50 digits, over random linkages and near folds."""

import mpmath
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.clearance import clearance_range
from honesty import over_scenes
from random_linkages import random_linkage


def within(cosine):
    return min(max(cosine, mpmath.mpf(-1)), mpmath.mpf(1))


def exact_four_bar(linkage, play, theta, link):
    """Return below and above of a link by the law of cosines, its range with both assemblies."""
    frame, crank, coupler, follower = (mpmath.mpf(v) for v in linkage.lengths.values())
    own, other = (follower, coupler) if link == "follower" else (coupler, follower)
    square = frame**2 + crank**2 - 2 * frame * crank * mpmath.cos(mpmath.mpf(theta))
    base = mpmath.sqrt(square)

    def angle(side):
        return mpmath.acos(within((square + own**2 - side**2) / (2 * base * own)))

    here, most, least = angle(other), angle(other + play), angle(other - play)
    opened, closed = most - here, here - least
    if least == 0:
        closed = here + most
    if most == mpmath.pi:
        opened = (mpmath.pi - here) + (mpmath.pi - least)
    raises = (link == "coupler") == (linkage.assembly == "open")
    return (closed, opened) if raises else (opened, closed)


def exact_slider(linkage, play, theta):
    """Return below and above of the slider by Pythagoras, its range with both assemblies."""
    crank, coupler, offset = (mpmath.mpf(v) for v in linkage.lengths.values())
    height = offset - crank * mpmath.sin(mpmath.mpf(theta))

    def leg(length):
        return mpmath.sqrt(max(length**2 - height**2, mpmath.mpf(0)))

    here, most, least = leg(coupler), leg(coupler + play), leg(coupler - play)
    outward, inward = most - here, here - least if least > 0 else here + most
    return (inward, outward) if linkage.assembly == "open" else (outward, inward)


def exact_rod(linkage, play, theta):
    """Return below and above of the rod: the block lies off its middle line by the play."""
    frame, crank = mpmath.mpf(linkage.frame), mpmath.mpf(linkage.crank)
    square = frame**2 + crank**2 + 2 * frame * crank * mpmath.cos(mpmath.mpf(theta))
    turned = mpmath.asin(play / mpmath.sqrt(square))
    return turned, turned


def exact_range(linkage, clearance, theta, link):
    play = mpmath.mpf(clearance) / 2
    if link == "slider":
        return exact_slider(linkage, play, theta)
    if link == "rod":
        return exact_rod(linkage, play, theta)
    return exact_four_bar(linkage, play, theta, link)


KINDS = {"follower": "four-bar", "coupler": "four-bar"}
KINDS |= {"slider": "slider-crank", "rod": "quick-return"}


@over_scenes(41)
@pytest.mark.parametrize("link", KINDS)
def test_estimate_covers_the_error_and_is_not_idle(rng, link):
    """Plays from 1e-9 to a fifth of the shortest link, any angle; the worse of below and above."""
    linkage = random_linkage(rng, KINDS[link], 3.0)
    shortest = min(size for name, size in linkage.lengths.items() if name != "offset")
    try:
        low, high = linkage.crank_ranges()[0]
        theta = float(rng.uniform(low, high))
        # Half of the cases next to an end, where play folds the linkage.
        if not linkage.crank_turns and rng.random() < 0.5:
            theta = float(low + (high - low) * 10.0 ** rng.uniform(-9, -1))
        clearance = float(0.2 * shortest * 10.0 ** rng.uniform(-8, 0))
        linkage.motion(theta)
        found = clearance_range(linkage, clearance, theta, link=link)
    except BadInput:
        return None
    if found.free:
        return None
    with mpmath.workdps(50):
        exact = exact_range(linkage, clearance, theta, link)
        given = float(found.below), float(found.above)
        gaps = [abs(mpmath.mpf(a) - b) for a, b in zip(given, exact, strict=True)]
    return float(found.error), float(max(gaps))
