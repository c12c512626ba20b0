"""How far clearances let the output of a linkage move: exact ranges without cancellation.

With the crank's direction given, every pin adds to the loop a vector up to half its diametral
clearance long, in any direction.  Such vectors add up to a disc, so that the play of the loop is
one radius, whichever pins it comes from.  Lengths are below 1 here.

The play depends on one variable of the crank angle: the diagonal BD, the gap from B to the guide,
or the slide DB.  Its error is how far the round-off of that variable moves it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .four_bar import FourBar
from .linkage import EPS, Array
from .quick_return import QuickReturn
from .slider_crank import SliderCrank

Flags = NDArray[np.bool_]

_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Play:
    """Nominal place of an output, and how far play lets it move to either side."""

    nominal: Array  # without play [rad or length]
    # below, above: way from there to the least and to the greatest place
    below: Array
    above: Array
    small: Array  # the whole way by the approximation of the first order; infinite at a fold
    # folds, free: True where the play reaches the other assembly, and where it reaches it on both
    # ways
    folds: Flags
    free: Flags
    # radius of the play at which the linkage first folds; negative where it cannot close
    margin: Array


@dataclass(frozen=True)
class CrankPosition:
    """Where the crank is, for the output: with the errors that its round-off makes."""

    variable: Array  # what the play depends on: diagonal, gap or slide
    error: Array | float
    start: Array  # place from which that of the output is counted [rad or length]
    start_error: Array | float
    margin_error: Array


# Play at values of the variable: (variable, radius, guide).
Kernel = Callable[[ArrayLike, ArrayLike, ArrayLike], Play]


@dataclass(frozen=True)
class Route:
    """One output of one linkage."""

    measure: Kernel
    position: Callable[[Array], CrankPosition]  # at crank angles
    turn: float  # +1 where the output falls as the place of ``measure`` rises, else -1
    interval: tuple[float, float]  # ends of the variable
    # values of the variable where the play may be extreme: (radius, guide)
    candidates: Callable[[float, float], tuple[float, ...]]
    crank: Callable[[float], float]  # crank angle of a value of the variable

    def at(self, position: CrankPosition, radius: ArrayLike, guide: ArrayLike) -> Play:
        """Return the play of the output at positions of the crank."""
        play = self.measure(position.variable, radius, guide)
        below, above = play.below, play.above
        if self.turn > 0.0:
            below, above = above, below
        nominal = position.start - self.turn * play.nominal
        return replace(play, nominal=nominal, below=below, above=above)

    def errors(
        self, position: CrankPosition, radius: ArrayLike, guide: ArrayLike, play: Play
    ) -> tuple[Array, Array]:
        """Return the errors of below and above, the worse, and of the nominal place."""
        ends = [
            self.at(replace(position, variable=position.variable + shift), radius, guide)
            for shift in (-position.error, position.error)
        ]
        below, above, nominal = (
            np.maximum(*(np.abs(getattr(end, name) - getattr(play, name)) for end in ends))
            for name in ("below", "above", "nominal")
        )
        # Beside the variable's, the round-off of the last few operations.
        error = np.maximum(below + 8.0 * EPS * play.below, above + 8.0 * EPS * play.above)
        return error, nominal + position.start_error + 4.0 * EPS * np.abs(play.nominal)


@dataclass(frozen=True)
class _Half:
    """Sine and cosine of half an angle, and where it is at its end, 0 or pi."""

    sine: Array
    cosine: Array
    least: Flags
    greatest: Flags

    @classmethod
    def of(cls, sine2: Array, cosine2: Array) -> _Half:
        """Return it from its squares, each cut to 0 and 1."""
        sine, cosine = (np.sqrt(np.clip(part, 0.0, 1.0)) for part in (sine2, cosine2))
        return cls(sine, cosine, sine2 <= 0.0, cosine2 <= 0.0)

    def angle(self) -> Array:
        return np.asarray(2.0 * np.arctan2(self.sine, self.cosine))

    def rest(self) -> Array:
        """Return pi less the angle."""
        return np.asarray(2.0 * np.arctan2(self.cosine, self.sine))


def _over(part: Array, whole: Array) -> Array:
    """Return a quotient, zero where there is nothing to divide by."""
    return np.asarray(np.divide(part, whole, out=np.zeros(np.shape(whole)), where=whole > 0.0))


def _apart(low: _Half, high: _Half, rise: Array) -> Array:
    """Return the difference of two angles; ``rise`` is that of sin^2 of the halves.

    sin^2 x - sin^2 y = sin(x - y) sin(x + y): small differences keep all their digits.
    """
    total = high.sine * low.cosine + high.cosine * low.sine
    cosine = high.cosine * low.cosine + high.sine * low.sine
    return np.asarray(2.0 * np.arctan2(_over(rise, total), cosine))


def _of_angles(
    halves: tuple[_Half, _Half, _Half], rises: tuple[Array, Array], small: Array, margin: Array
) -> Play:
    """Return the play of an angle from its least, nominal and greatest half.

    An angle that reaches 0 goes on to minus the greatest one, one that reaches pi to 2 pi less the
    least one.
    """
    least, nominal, greatest = halves
    inner, outer = least.least, greatest.greatest
    through = nominal.angle() + greatest.angle()
    around = nominal.rest() + least.rest()
    fall = np.where(inner, through, _apart(least, nominal, rises[0]))
    rise = np.where(outer, around, _apart(nominal, greatest, rises[1]))
    free = inner & outer
    fall, rise = (np.where(free, np.pi, part) for part in (fall, rise))
    return Play(nominal.angle(), fall, rise, small, inner | outer, free, margin)


def _together(*values: ArrayLike) -> tuple[Array, ...]:
    return np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values))


def _four_bar(linkage: FourBar, link: str) -> Route:
    """Return the play of follower or coupler: an angle in the triangle BCD (Smith 3.1, 3.2)."""
    frame, crank, other, side = linkage.unit_lengths.values()
    branch, turn = linkage.branch, linkage.branch
    if link == "coupler":
        side, other, turn = other, side, -branch
    short, long = abs(frame - crank), frame + crank

    def position(theta: Array) -> CrankPosition:
        half, gap = np.sin(theta / 2.0), frame - crank
        diagonal = np.sqrt(gap**2 + 4.0 * frame * crank * half**2)
        # Direction of B from D, continuous in the crank angle as in FourBar.motion.
        if crank > frame:
            y, x = frame * np.sin(theta), -gap + 2.0 * frame * half**2
            toward = theta + np.arctan2(y, x)
        else:
            y, x = crank * np.sin(theta), gap + 2.0 * crank * half**2
            toward = branch * np.pi - np.arctan2(y, x)
        # The coupler is seen from B, and between -pi and pi at the crank angle 0.
        start = toward - branch * np.pi if link == "coupler" else toward
        unsure = diagonal + other + side + min(frame, crank) * (2.0 + np.abs(theta)) / 4.0
        error = EPS * (3.0 + np.abs(toward))
        return CrankPosition(diagonal, 4.0 * EPS * diagonal, start, error, 4.0 * EPS * unsure)

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        longer, shorter = other + radius, other - radius
        # Equal angles opposite D's side, and right ones where one length makes both ends.
        squares = (side**2 + longer * shorter, side**2 - longer**2, side**2 - shorter**2)
        still = [float(np.sqrt(square)) for square in squares if square > 0.0]
        return (*still, side - shorter, side + shorter, longer - side)

    def crank_at(diagonal: float) -> float:
        sine2 = (diagonal - short) * (diagonal + short)
        return _angle_of(sine2, (long - diagonal) * (long + diagonal))

    ends = (max(short, abs(side - other)), min(long, side + other))
    triangle = partial(_triangle, side=side, other=other)
    return Route(triangle, position, turn, ends, candidates, crank_at)


def _triangle(
    diagonal: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, side: float, other: float
) -> Play:
    """Return the play of the angle at D between DB and DC; BC is ``other`` give or take."""
    d, r, _ = _together(diagonal, radius, guide)
    scale = np.maximum(4.0 * d * side, _TINY)
    least, nominal, greatest = (
        _opened(d, side, other, change, scale) for change in (-r, np.zeros_like(r), r)
    )
    rises = r * (2.0 * other - r) / scale, r * (2.0 * other + r) / scale
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = (r / d) * (other / side) / (nominal.sine * nominal.cosine)
    small = np.where(r == 0.0, 0.0, small)
    margin = np.minimum((other + side) - d, d - abs(other - side))
    return _of_angles((least, nominal, greatest), rises, small, margin)


def _opened(d: Array, side: float, other: float, change: Array, scale: Array) -> _Half:
    """Return the angle between two sides, ``d`` and ``side``, opposite to ``other + change``."""
    excess, around = (other - side) + change, (other + side) + change
    sine2 = (around - d) * (d + excess) / scale
    cosine2 = (d - excess) * (around + d) / scale
    # A side below zero sets no limit, whatever the signs of the factors.
    none = other + change <= 0.0
    return _Half.of(np.where(none, -1.0, sine2), np.where(none, 1.0, cosine2))


def _slider_crank(linkage: SliderCrank, link: str) -> Route:
    """Return the play of the slider along the guide, or of the coupler's angle."""
    crank, coupler, offset = linkage.unit_lengths.values()
    along = link == "slider"

    def position(theta: Array) -> CrankPosition:
        gap = offset - crank * np.sin(theta)
        sum_error = EPS * (abs(offset) + 2.0 * crank)
        margin_error = EPS * (coupler + np.abs(gap) + crank * np.abs(theta)) + 2.0 * sum_error
        # Of the gap, and of the lengths that it is compared with.
        error = sum_error + 2.0 * EPS * (coupler + np.abs(gap))
        if along:
            start = crank * np.cos(theta)
            return CrankPosition(gap, error, start, 2.0 * EPS * np.abs(start), margin_error)
        return CrankPosition(gap, error, np.full_like(gap, np.pi / 2.0), EPS * np.pi, margin_error)

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        edge = coupler - radius - guide
        return (0.0, edge, -edge)

    def crank_at(gap: float) -> float:
        return np.pi / 2.0 - _angle_of(crank - offset + gap, crank + offset - gap)

    turn = -linkage.branch if along else linkage.branch
    ends = max(offset - crank, -coupler), min(offset + crank, coupler)
    across = partial(_across_slider if along else _across_coupler, coupler=coupler)
    return Route(across, position, turn, ends, candidates, crank_at)


def _across_slider(gap: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, coupler: float) -> Play:
    """Return the play of the slider's distance from B along the guide, B a gap beside it."""
    g, r, w = _together(gap, radius, guide)
    g = np.abs(g)
    shed = np.minimum(w, g)
    near, far = g - shed, g + w
    least, nominal, greatest = (
        np.sqrt(np.maximum(np.where(length > 0.0, (length - side) * (length + side), 0.0), 0.0))
        for length, side in ((coupler - r, far), (coupler + 0.0 * r, g), (coupler + r, near))
    )
    folds = (coupler - r) <= far
    # The differences of the legs from those of their squares: small ones keep their digits.
    fall = _over(r * (2.0 * coupler - r) + w * (2.0 * g + w), least + nominal)
    rise = _over(r * (2.0 * coupler + r) + shed * (2.0 * g - shed), nominal + greatest)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = 2.0 * (r * coupler + w * g) / nominal
    small = np.where((r == 0.0) & (w * g == 0.0), 0.0, small)
    through, free = nominal + greatest, np.zeros(g.shape, dtype=bool)
    return Play(nominal, np.where(folds, through, fall), rise, small, folds, free, coupler - g)


def _across_coupler(
    gap: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, coupler: float | Array
) -> Play:
    """Return the play of the angle between the normal of the guide and the coupler.

    Along the guide the slider follows; across it, pins and guide add up.
    """
    g, r, w = _together(gap, radius, guide)
    play, scale = r + w, 2.0 * coupler
    least, nominal, greatest = (
        _Half.of((coupler - g - change) / scale, (coupler + g + change) / scale)
        for change in (play, 0.0 * play, -play)
    )
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = play / (coupler * nominal.sine * nominal.cosine)
    small, margin = np.where(play == 0.0, 0.0, small), coupler - np.abs(g)
    return _of_angles((least, nominal, greatest), (play / scale, play / scale), small, margin)


def _quick_return(linkage: QuickReturn, link: str) -> Route:
    frame, crank, rod = linkage.unit_lengths.values()
    short, long = abs(frame - crank), frame + crank

    def position(theta: Array) -> CrankPosition:
        motion = linkage.motion(theta)
        slide = np.sqrt((frame - crank) ** 2 + 4.0 * frame * crank * np.cos(theta / 2.0) ** 2)
        return CrankPosition(
            slide, 5.0 * EPS * slide, motion.theta4, motion.error, 4.0 * EPS * slide
        )

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        return (radius + guide,)

    def crank_at(slide: float) -> float:
        sine2 = (long - slide) * (long + slide)
        return _angle_of(sine2, (slide - short) * (slide + short))

    return Route(_beside, position, 1.0, (short, min(long, rod)), candidates, crank_at)


def _beside(slide: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
    """Return the play of a line about D that passes B at most so far beside it.

    As of a coupler as long as the slide, whose end is free as far across a guide through D.
    """
    x, r, w = _together(slide, radius, guide)
    none = np.zeros_like(x)
    return replace(_across_coupler(none, r, w, coupler=np.maximum(x, _TINY)), nominal=none)


def _angle_of(sine2: float, cosine2: float) -> float:
    """Return the angle from the squares of sine and cosine of its half, or what is as they."""
    return float(2.0 * np.arctan2(np.sqrt(max(sine2, 0.0)), np.sqrt(max(cosine2, 0.0))))


@dataclass(frozen=True)
class Outputs:
    """What of a kind of linkage can be ranged."""

    links: tuple[str, ...]  # the output first
    sliding: str  # joint that slides, and does not turn: its clearance is across its guide
    route: Callable[[Any, str], Route]  # to the play of one of the links


OUTPUTS: Mapping[type, Outputs] = {
    FourBar: Outputs(("follower", "coupler"), "", _four_bar),
    SliderCrank: Outputs(("slider", "coupler"), "41", _slider_crank),
    QuickReturn: Outputs(("rod",), "34", _quick_return),
}
