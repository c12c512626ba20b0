"""How far clearances let the output of a linkage move: exact ranges without cancellation.

With the crank's direction given, every pin adds to the loop a vector up to half its diametral
clearance long, in any direction.  Such vectors add up to a disc, so that the play of the loop is
one radius, whichever pins it comes from.  Lengths are below 1 here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .linkage import EPS, Array

Flags = NDArray[np.bool_]
Sizes = Mapping[str, float]

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
    # error, nominal_error: of ``below`` and ``above`` (the worse), and of ``nominal``
    error: Array
    nominal_error: Array
    # radius of the play at which the linkage first folds; negative where it cannot close
    margin: Array
    blur: Array  # round-off of ``margin``
    place: Array  # the variable that the play depends on: diagonal, gap or slide


Kernel = Callable[[ArrayLike, ArrayLike, ArrayLike], Play]


@dataclass(frozen=True)
class Route:
    """One output of one linkage."""

    at: Kernel  # play at crank angles: (theta, radius, guide)
    measure: Kernel  # play at values of the one variable that it depends on, its direction left out
    interval: tuple[float, float]  # ends of that variable
    # values of the variable where the play may be extreme: (radius, guide)
    candidates: Callable[[float, float], tuple[float, ...]]
    crank: Callable[[float], float]  # crank angle of a value of the variable


@dataclass(frozen=True)
class _Half:
    """Sine and cosine of half an angle with their errors, and where it is at its end, 0 or pi."""

    sine: Array
    cosine: Array
    sine_error: Array
    cosine_error: Array
    least: Flags
    greatest: Flags

    @classmethod
    def of(cls, sine2: Array, cosine2: Array, error: tuple[Array, Array]) -> _Half:
        """Return it from its squares and their absolute errors, each cut to 0 and 1."""
        sine, cosine = (np.sqrt(np.clip(part, 0.0, 1.0)) for part in (sine2, cosine2))
        sine_error, cosine_error = _root_error(sine, error[0]), _root_error(cosine, error[1])
        return cls(sine, cosine, sine_error, cosine_error, sine2 <= 0.0, cosine2 <= 0.0)

    def angle(self) -> Array:
        return np.asarray(2.0 * np.arctan2(self.sine, self.cosine))

    def rest(self) -> Array:
        """Return pi less the angle."""
        return np.asarray(2.0 * np.arctan2(self.cosine, self.sine))

    def error(self) -> Array:
        """Return the error of the angle, or of pi less the angle, before their own rounding."""
        return np.asarray(2.0 * (self.cosine * self.sine_error + self.sine * self.cosine_error))


def _root_error(root: Array, blur: Array) -> Array:
    """Return the error of a root whose square is uncertain by ``blur``.

    |sqrt(x + e) - sqrt(x)| is less than e/sqrt(x), and than sqrt(e).
    """
    steep = np.maximum(np.maximum(root, np.sqrt(blur)), _TINY)
    return np.asarray(blur / steep + EPS * root)


def _over(part: Array, whole: Array, otherwise: float = 0.0) -> Array:
    """Return a quotient, something else where there is nothing to divide by."""
    held = np.full(np.shape(whole), otherwise)
    return np.asarray(np.divide(part, whole, out=held, where=whole > 0.0))


def _apart(low: _Half, high: _Half, rise: Array) -> tuple[Array, Array]:
    """Return the difference of two angles and its error; ``rise`` is that of sin^2 of the halves.

    sin^2 x - sin^2 y = sin(x - y) sin(x + y): small differences keep all their digits.
    """
    total = high.sine * low.cosine + high.cosine * low.sine
    cosine = high.cosine * low.cosine + high.sine * low.sine
    angle = 2.0 * np.arctan2(_over(rise, total), cosine)
    blur = high.sine * low.cosine_error + low.cosine * high.sine_error
    blur = blur + high.cosine * low.sine_error + low.sine * high.cosine_error
    relative = np.minimum(_over(blur, total, 1.0), 1.0)
    return angle, np.asarray(angle * (relative + 6.0 * EPS))


def _turned(
    least: _Half, nominal: _Half, greatest: _Half, rises: tuple[Array, Array]
) -> tuple[tuple[Array, Array], tuple[Array, Array], Flags, Flags]:
    """Return how far an angle may fall and rise, with errors, and whether it folds or turns.

    An angle that reaches 0 goes on to minus the greatest one, one that reaches pi to 2 pi less the
    least one.
    """
    fall, fall_error = _apart(least, nominal, rises[0])
    rise, rise_error = _apart(nominal, greatest, rises[1])
    inner, outer = least.least, greatest.greatest
    through = nominal.angle() + greatest.angle()
    around = nominal.rest() + least.rest()
    still = nominal.error()
    fall_error = np.where(inner, still + greatest.error() + 3 * EPS * through, fall_error)
    rise_error = np.where(outer, still + least.error() + 3 * EPS * around, rise_error)
    fall, rise = np.where(inner, through, fall), np.where(outer, around, rise)
    free = inner & outer
    fall, rise = (np.where(free, np.pi, part) for part in (fall, rise))
    fall_error, rise_error = (np.where(free, EPS * np.pi, e) for e in (fall_error, rise_error))
    return (fall, fall_error), (rise, rise_error), inner | outer, free


def four_bar(sizes: Sizes, branch: float, link: str) -> Route:
    """Return the play of follower or coupler: an angle in the triangle BCD (Smith 3.1, 3.2)."""
    frame, crank = sizes["frame"], sizes["crank"]
    side, other = sizes["follower"], sizes["coupler"]
    if link == "coupler":
        side, other = other, side
    short, long = abs(frame - crank), frame + crank
    triangle = partial(_triangle, side=side, other=other)

    def at(theta: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
        angle = np.asarray(theta, dtype=float)
        half, gap = np.sin(angle / 2.0), frame - crank
        diagonal = np.sqrt(gap**2 + 4.0 * frame * crank * half**2)
        # Direction of B from D, continuous in the crank angle as in FourBar.motion.
        if crank > frame:
            y, x = frame * np.sin(angle), -gap + 2.0 * frame * half**2
            toward = angle + np.arctan2(y, x)
        else:
            y, x = crank * np.sin(angle), gap + 2.0 * crank * half**2
            toward = branch * np.pi - np.arctan2(y, x)
        play = triangle(diagonal, radius, guide)
        turn = -branch if link == "coupler" else branch
        nominal = toward - turn * play.nominal
        if link == "coupler":
            # Seen from B, and between -pi and pi at the crank angle 0.
            nominal = nominal - branch * np.pi
        error = play.nominal_error + EPS * (3.0 + np.abs(toward) + np.abs(nominal))
        return _placed(play, nominal, error, turn, min(frame, crank) * (2.0 + np.abs(angle)))

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
    return Route(at, triangle, ends, candidates, crank_at)


def _together(*values: ArrayLike) -> tuple[Array, ...]:
    return np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values))


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
    return _of_angles(
        (least, nominal, greatest),
        rises,
        small=np.where(r == 0.0, 0.0, small),
        margin=np.minimum((other + side) - d, d - abs(other - side)),
        blur=4.0 * EPS * (d + other + side),
        place=d,
    )


def _of_angles(
    halves: tuple[_Half, _Half, _Half], rises: tuple[Array, Array], **others: Array
) -> Play:
    """Return the play of an angle from its least, nominal and greatest half."""
    nominal = halves[1]
    (fall, fall_error), (rise, rise_error), folds, free = _turned(*halves, rises)
    return Play(
        nominal=nominal.angle(),
        below=fall,
        above=rise,
        folds=folds,
        free=free,
        error=np.maximum(fall_error, rise_error),
        nominal_error=nominal.error() + 2 * EPS * nominal.angle(),
        **others,
    )


def _opened(d: Array, side: float, other: float, change: Array, scale: Array) -> _Half:
    """Return the angle between sides d and ``own`` opposite to a side ``other + change``."""
    excess, around = (other - side) + change, (other + side) + change
    near = EPS * (2.5 * d + 1.5 * np.abs(excess))
    far = EPS * (2.5 * d + 1.5 * np.abs(around))
    error = (
        (far * np.abs(d + excess) + near * np.abs(around - d)) / scale,
        (near * np.abs(around + d) + far * np.abs(d - excess)) / scale,
    )
    sine2 = (around - d) * (d + excess) / scale
    cosine2 = (d - excess) * (around + d) / scale
    # A side below zero sets no limit, whatever the signs of the factors.
    none = other + change <= 0.0
    return _Half.of(np.where(none, -1.0, sine2), np.where(none, 1.0, cosine2), error)


def slider_crank(sizes: Sizes, branch: float, link: str) -> Route:
    """Return the play of the slider along the guide, or of the coupler's angle."""
    crank, coupler, offset = sizes["crank"], sizes["coupler"], sizes["offset"]
    gap_blur = EPS * (abs(offset) + 2.0 * crank)
    measure = _across_slider if link == "slider" else _across_coupler
    across = partial(measure, coupler=coupler, gap_blur=gap_blur)

    def at(theta: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
        angle = np.asarray(theta, dtype=float)
        play = across(offset - crank * np.sin(angle), radius, guide)
        moved = crank * np.abs(angle)
        if link == "slider":
            start = crank * np.cos(angle)
            nominal = start + branch * play.nominal
            error = play.nominal_error + 2 * EPS * (np.abs(start) + np.abs(nominal))
            return _placed(play, nominal, error, -branch, moved)
        nominal = np.pi / 2.0 - branch * play.nominal
        return _placed(play, nominal, play.nominal_error + 4.0 * EPS * np.pi, branch, moved)

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        edge = coupler - radius - guide
        return (0.0, edge, -edge)

    def crank_at(gap: float) -> float:
        return np.pi / 2.0 - _angle_of(crank - offset + gap, crank + offset - gap)

    ends = max(offset - crank, -coupler), min(offset + crank, coupler)
    return Route(at, across, ends, candidates, crank_at)


def _across_slider(
    gap: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, coupler: float, gap_blur: float
) -> Play:
    """Return the play of the slider's distance from B along the guide, B a gap beside it."""
    g, r, w = _together(gap, radius, guide)
    g = np.abs(g)
    shed = np.minimum(w, g)
    near, far = g - shed, g + w
    roots, blurs = [], []
    for length, side in ((coupler - r, far), (coupler + 0.0 * r, g), (coupler + r, near)):
        square = np.where(length > 0.0, (length - side) * (length + side), 0.0)
        root = np.sqrt(np.maximum(square, 0.0))
        blur = (EPS * (np.abs(length) + side) + 2.0 * gap_blur) * (np.abs(length) + side)
        roots.append(root)
        blurs.append(_root_error(root, blur))
    least, nominal, greatest = roots
    folds = (coupler - r) <= far
    fall, fall_error = _legs_apart(
        r * (2.0 * coupler - r) + w * (2.0 * g + w), least + nominal, blurs[0] + blurs[1]
    )
    rise, rise_error = _legs_apart(
        r * (2.0 * coupler + r) + shed * (2.0 * g - shed), nominal + greatest, blurs[1] + blurs[2]
    )
    through = nominal + greatest
    swayed = 2.0 * w * gap_blur
    fall_error = fall_error + _over(swayed, least + nominal)
    rise_error = rise_error + _over(swayed, through)
    fall_error = np.where(folds, blurs[1] + blurs[2] + 2 * EPS * through, fall_error)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = 2.0 * (r * coupler + w * g) / nominal
    return Play(
        nominal=nominal,
        below=np.where(folds, through, fall),
        above=rise,
        small=np.where((r == 0.0) & (w * g == 0.0), 0.0, small),
        folds=folds,
        free=np.zeros(g.shape, dtype=bool),
        error=np.maximum(fall_error, rise_error),
        nominal_error=blurs[1],
        margin=coupler - g,
        blur=EPS * (coupler + g) + 2.0 * gap_blur,
        place=g,
    )


def _legs_apart(change: Array, total: Array, blur: Array) -> tuple[Array, Array]:
    """Return the difference of two legs from that of their squares and their sum."""
    moved = _over(change, total)
    relative = np.minimum(_over(blur, total, 1.0), 1.0)
    return moved, np.asarray(moved * (relative + 6.0 * EPS))


def _across_coupler(
    gap: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, coupler: float | Array, gap_blur: float
) -> Play:
    """Return the play of the angle between the normal of the guide and the coupler.

    Along the guide the slider follows; across it, pins and guide add up.
    """
    g, r, w = _together(gap, radius, guide)
    play, scale = r + w, 2.0 * coupler
    error = ((2.0 * EPS * (coupler + np.abs(g) + play) + gap_blur) / scale,) * 2
    least, nominal, greatest = (
        _Half.of((coupler - g - change) / scale, (coupler + g + change) / scale, error)
        for change in (play, 0.0 * play, -play)
    )
    rises = play / scale, play / scale
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = play / (coupler * nominal.sine * nominal.cosine)
    return _of_angles(
        (least, nominal, greatest),
        rises,
        small=np.where(play == 0.0, 0.0, small),
        margin=coupler - np.abs(g),
        blur=EPS * (coupler + np.abs(g)) + 2.0 * gap_blur,
        place=g,
    )


def quick_return(sizes: Sizes, nominal: Callable[[ArrayLike], tuple[Array, Array]]) -> Route:
    """Return the play of the rod's angle."""
    frame, crank, rod = sizes["frame"], sizes["crank"], sizes["rod"]
    short, long = abs(frame - crank), frame + crank

    def at(theta: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
        angle = np.asarray(theta, dtype=float)
        place, error = nominal(angle)
        slide = np.sqrt((frame - crank) ** 2 + 4.0 * frame * crank * np.cos(angle / 2.0) ** 2)
        return _placed(_beside(slide, radius, guide), place, error, 1.0, np.zeros_like(slide))

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        return (radius + guide,)

    def crank_at(slide: float) -> float:
        sine2 = (long - slide) * (long + slide)
        return _angle_of(sine2, (slide - short) * (slide + short))

    return Route(at, _beside, (short, min(long, rod)), candidates, crank_at)


def _beside(slide: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
    """Return the play of a line about D that passes B at most so far beside it.

    As of a coupler as long as the slide, whose end is free as far across a guide through D.
    """
    x, r, w = _together(slide, radius, guide)
    play = _across_coupler(np.zeros_like(x), r, w, coupler=np.maximum(x, _TINY), gap_blur=0.0)
    # The slide is uncertain by 5 round-offs of itself; the sine of the angle is play over slide.
    unsure = 5.0 * EPS
    slope = np.minimum(np.tan(np.minimum(play.above, np.pi / 2.0)), unsure**-0.5)
    error = np.where(play.free, EPS * np.pi, play.error + unsure * slope)
    none = np.zeros_like(x)
    return replace(play, nominal=none, nominal_error=none, error=error, blur=4.0 * EPS * x, place=x)


def _placed(play: Play, nominal: Array, error: Array, turn: float, moved: Array) -> Play:
    """Return the play about a place; with ``turn`` positive, a greater angle lowers the output.

    ``moved`` is how far a change of the crank angle by one round-off changes the margin, over it.
    """
    below, above = (play.above, play.below) if turn > 0.0 else (play.below, play.above)
    return replace(
        play,
        nominal=np.asarray(nominal),
        below=below,
        above=above,
        nominal_error=np.asarray(error),
        blur=play.blur + EPS * moved,
    )


def _angle_of(sine2: float, cosine2: float) -> float:
    """Return the angle from the squares of sine and cosine of its half, or what is as they."""
    return float(2.0 * np.arctan2(np.sqrt(max(sine2, 0.0)), np.sqrt(max(cosine2, 0.0))))
