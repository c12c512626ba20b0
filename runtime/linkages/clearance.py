"""Clearance at the joints: the exact range over which it lets the output of a linkage move.

With the crank's direction given, every pin adds to the loop a vector up to half its diametral
clearance long, in any direction.  Such vectors add up to a disc, so that the play of the loop is
one radius, whichever pins it comes from.  Lengths are below 1 where the play is computed.

The play depends on one variable of the crank angle: the diagonal BD, the gap from B to the guide,
or the slide DB.  Its error is how far the round-off of that variable moves it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import Problem, bad, refuse, shown
from ..core.inputs import is_finite, require_kind, require_one_of
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, DeferredChecks, DeferredField, DeferredGroup, Result, provenance
from .four_bar import FourBar
from .linkage import EPS, JOINTS, Array, finite_array, over, require_linkage
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


@dataclass(frozen=True)
class Route:
    """One output of one linkage."""

    # play at values of the variable: (variable, radius, guide)
    measure: Callable[[ArrayLike, ArrayLike, ArrayLike], Play]
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


def _apart(low: _Half, high: _Half, rise: Array) -> Array:
    """Return the difference of two angles; ``rise`` is that of sin^2 of the halves."""
    # sin^2 x - sin^2 y = sin(x - y) sin(x + y): small differences keep all their digits.
    total = high.sine * low.cosine + high.cosine * low.sine
    cosine = high.cosine * low.cosine + high.sine * low.sine
    return np.asarray(2.0 * np.arctan2(over(rise, total), cosine))


def _of_angles(
    halves: tuple[_Half, _Half, _Half], rises: tuple[Array, Array], small: Array, margin: Array
) -> Play:
    """Return the play of an angle from its least, nominal and greatest half."""
    # An angle that reaches 0 goes on to minus the greatest one, one that reaches pi to 2 pi less
    # the least one.
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

    greatest = min(long, side + other)
    # A diagonal of no length has no angle.
    ends = (max(short, abs(side - other), 64.0 * EPS * greatest), greatest)
    triangle = partial(_triangle, side=side, other=other)
    return Route(triangle, position, turn, ends, candidates, crank_at)


def _triangle(
    diagonal: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, side: float, other: float
) -> Play:
    """Return the play of the angle at D between DB and DC; BC is ``other`` give or take."""
    d, r, _ = _together(diagonal, radius, guide)
    scale = np.maximum(4.0 * d * side, _TINY)

    def opened(change: Array) -> _Half:
        """Return the angle between ``d`` and ``side``, opposite to ``other + change``."""
        excess, around = (other - side) + change, (other + side) + change
        sine2 = (around - d) * (d + excess) / scale
        cosine2 = (d - excess) * (around + d) / scale
        # A side below zero sets no limit, whatever the signs of the factors.
        none = other + change <= 0.0
        return _Half.of(np.where(none, -1.0, sine2), np.where(none, 1.0, cosine2))

    least, nominal, greatest = (opened(change) for change in (-r, np.zeros_like(r), r))
    rises = r * (2.0 * other - r) / scale, r * (2.0 * other + r) / scale
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = (r / d) * (other / side) / (nominal.sine * nominal.cosine)
    small = np.where(r == 0.0, 0.0, small)
    margin = np.minimum((other + side) - d, d - abs(other - side))
    return _of_angles((least, nominal, greatest), rises, small, margin)


def _slider_crank(linkage: SliderCrank, link: str) -> Route:
    """Return the play of the slider along the guide, or of the coupler's angle."""
    crank, coupler, offset = linkage.unit_lengths.values()
    along = link == "slider"

    def position(theta: Array) -> CrankPosition:
        gap = offset - crank * np.sin(theta)
        start = crank * np.cos(theta) if along else np.full_like(gap, np.pi / 2.0)
        sum_error, size = EPS * (abs(offset) + 2.0 * crank), coupler + np.abs(gap)
        margin_error = EPS * (size + crank * np.abs(theta)) + 2.0 * sum_error
        # Of the gap, and of the lengths that it is compared with.
        error = sum_error + 2.0 * EPS * size
        return CrankPosition(gap, error, start, 2.0 * EPS * np.abs(start), margin_error)

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
    fall = over(r * (2.0 * coupler - r) + w * (2.0 * g + w), least + nominal)
    rise = over(r * (2.0 * coupler + r) + shed * (2.0 * g - shed), nominal + greatest)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        small = 2.0 * (r * coupler + w * g) / nominal
    small = np.where((r == 0.0) & (w * g == 0.0), 0.0, small)
    through, free = nominal + greatest, np.zeros(g.shape, dtype=bool)
    return Play(nominal, np.where(folds, through, fall), rise, small, folds, free, coupler - g)


def _across_coupler(
    gap: ArrayLike, radius: ArrayLike, guide: ArrayLike, *, coupler: float | Array
) -> Play:
    """Return the play of the angle between the normal of the guide and the coupler."""
    # Along the guide the slider follows; across it, pins and guide add up.
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
        error, unsure = 5.0 * EPS * slide, 4.0 * EPS * slide
        return CrankPosition(slide, error, motion.theta4, motion.error, unsure)

    def candidates(radius: float, guide: float) -> tuple[float, ...]:
        return (radius + guide,)

    def crank_at(slide: float) -> float:
        sine2 = (long - slide) * (long + slide)
        return _angle_of(sine2, (slide - short) * (slide + short))

    return Route(_beside, position, 1.0, (short, min(long, rod)), candidates, crank_at)


def _beside(slide: ArrayLike, radius: ArrayLike, guide: ArrayLike) -> Play:
    """Return the play of a line about D that passes B at most so far beside it."""
    # As of a coupler as long as the slide, whose end is free as far across a guide through D.
    x, r, w = _together(slide, radius, guide)
    none = np.zeros_like(x)
    return replace(_across_coupler(none, r, w, coupler=np.maximum(x, _TINY)), nominal=none)


def _angle_of(sine2: float, cosine2: float) -> float:
    """Return the angle from the squares of sine and cosine of its half, or what is as they."""
    return float(2.0 * np.arctan2(np.sqrt(max(sine2, 0.0)), np.sqrt(max(cosine2, 0.0))))


# Of a kind of linkage the links that can be ranged, the output first; the joint that slides and
# does not turn: its clearance is across its guide; and what makes the route to the play of a link.
_OUTPUTS: Mapping[str, tuple[tuple[str, ...], str, Callable[[Any, str], Route]]] = {
    "four_bar": (("follower", "coupler"), "", _four_bar),
    "slider_crank": (("slider", "coupler"), "41", _slider_crank),
    "quick_return": (("rod",), "34", _quick_return),
}


# Fields that are computed when they are first looked at.
_LATER = {name: DeferredField() for name in ("error", "nominal_error")}
# Of the play at which the linkage folds: the terms beyond the first order are of its square.
_SMALL_PLAY = 1e-4


@dataclass(frozen=True)
class WidthExtreme:
    """An extreme of the output's free movement over all that the crank can reach.

    Attributes
    ----------
    theta2 : float
        Crank angle [rad].  For the four-bar and the quick-return from 0 to pi, and the same at the
        opposite angle; for the slider-crank from -pi/2 to pi/2, and the same at pi less it.
    width : float
        Movement there [rad, or m for a slider].
    """

    theta2: float
    width: float


@dataclass(frozen=True, kw_only=True)
class ClearanceRange(Result):
    """Range of the output that clearances leave at given crank angles.

    Arrays have the shape of the crank angles; places are angles [rad], or for a slider lengths in
    the unit of the linkage's.  ``error`` is that of ``below``, ``above`` and ``width``, which
    stay accurate to their own size however small the clearance; ``nominal``, and with it ``lower``
    and ``upper``, carry ``nominal_error`` as well; both are computed when they are first read.

    Attributes
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        What moves.
    link : str
        The link whose place is ranged: follower, slider, rod, or coupler.
    clearances : mapping of str to float
        Diametral clearance by joint, or the clearance across the guide of a joint that slides.
    theta2 : ndarray
        Crank angles [rad].
    nominal : ndarray
        Place without clearance.
    lower, upper : ndarray
        Least and greatest place.
    below, above : ndarray
        ``nominal - lower`` and ``upper - nominal``, without cancellation.
    width : ndarray
        The whole movement, ``below + above``.
    small : ndarray
        The same to the first order (Smith 3.3); infinite where the linkage folds.
    folds : ndarray of bool
        True where the clearance lets the linkage pass its dead position: the range runs on through
        the other assembly to the end of that.
    free : ndarray of bool
        True where it passes both ways: an angle is not limited at all, and its width 2 pi.
    nominal_error : ndarray
        Error of ``nominal``.
    greatest, least : WidthExtreme
        Extremes of the width over the crank's whole range, its ends included.
    """

    linkage: FourBar | SliderCrank | QuickReturn
    link: str
    clearances: Mapping[str, float]
    theta2: Array
    nominal: Array
    lower: Array
    upper: Array
    below: Array
    above: Array
    width: Array
    small: Array
    folds: NDArray[np.bool_]
    free: NDArray[np.bool_]
    error: Any = _LATER["error"]
    nominal_error: Any = _LATER["nominal_error"]
    greatest: WidthExtreme
    least: WidthExtreme

    arrays_along: ClassVar = {
        "...": "theta2 nominal lower upper below above width small folds free nominal_error error"
    }

    @property
    def unit(self) -> str:
        """Unit of the places: rad, or m for a slider."""
        return "m" if self.link == "slider" else "rad"

    def _own_units(self) -> dict[str, str]:
        names = "nominal lower upper below above width small nominal_error error"
        return dict.fromkeys(names.split(), self.unit)

    def plot(self, ax: Axes | None = None, *, label: str | None = None) -> Axes:
        """Draw the width against the crank angle, as in Smith's Fig. 10.

        Parameters
        ----------
        ax : Axes, optional
            Those of another clearance, for several curves.
        label : str, optional
            By default the clearances.
        """
        ax = axes_or_new(ax)
        if label is None:
            label = ", ".join(f"c{joint} = {c:.4g}" for joint, c in self.clearances.items())
        to_shown = np.degrees if self.unit == "rad" else np.asarray
        order = np.argsort(self.theta2, axis=None, kind="stable")
        degrees = np.degrees(np.ravel(self.theta2)[order])
        width, small = (np.ravel(part)[order] for part in (self.width, self.small))
        small = np.where(small < 2.0 * np.max(width, initial=0.0), small, np.nan)
        # The curve breaks where the crank cannot go, and jumps where a fold begins.
        breaks = np.flatnonzero(np.diff(self._pieces()[order])) + 1
        color = None
        for part in np.split(np.arange(order.size), breaks):
            curve = degrees[part], to_shown(width[part])
            dot = "." if part.size == 1 else ""
            (line,) = ax.plot(*curve, dot or "-", color=color, label=None if color else label)
            color = line.get_color()
            ax.plot(degrees[part], to_shown(small[part]), ls=":", lw=1.0, color=color)
        at = np.degrees(self.greatest.theta2)
        if order.size and degrees[0] <= at <= degrees[-1]:
            ax.plot(at, to_shown(self.greatest.width), "o", ms=4.0, color=color)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel(f"free movement of the {self.link} [{'m' if self.unit == 'm' else 'deg'}]")
        ax.set_title("exact; dotted: small clearance; dot: greatest", fontsize="medium")
        ax.legend()
        return ax

    def _pieces(self) -> Array:
        """Return a number for each crank angle, the same for those that one curve joins."""
        theta, pieces = np.ravel(self.theta2), np.ravel(self.folds).astype(float)
        for low, _ in () if self.linkage.crank_turns else self.linkage.crank_ranges():
            # Of the ranges, as many as have begun.
            pieces += 2.0 * np.floor((theta - low + 1e-6) / math.tau)
        return pieces


def clearance_range(
    linkage: FourBar | SliderCrank | QuickReturn,
    clearances: float | Mapping[str, float],
    theta: ArrayLike | None = None,
    *,
    joint: str | None = None,
    link: str | None = None,
) -> ClearanceRange:
    """Return the exact range of the output that clearances leave (Smith 3.1, 3.2).

    A pin is free within a disc of half the diametral clearance about the centre of its hole; crank
    angles are those of the crank itself.  The vectors of all pins add up to one disc, whose radius
    r is half the sum of the clearances: at whichever joint they are, they act as a coupler between
    ``coupler - r`` and ``coupler + r``.  The joint that slides (41 of the slider-crank, 34 of the
    quick-return) has its clearance across the guide, and does not tilt.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        The linkage.
    clearances : float or mapping of str to float
        Diametral clearance, in the unit of the lengths, of one joint or by joint: "12" (crank's
        pivot), "23", "34", "41" (output's pivot).
    theta : array_like, optional
        Crank angles [rad], any shape; a dead position is allowed.  By default 361 over a turn, or
        181 over each range that the crank reaches, its ends included.
    joint : str, optional
        The joint that one clearance is at; "34" by default.
    link : str, optional
        The link to be ranged: "follower", "slider" or "rod" by default, or "coupler".

    Returns
    -------
    ClearanceRange
        Checks: the loop closes at both ends of the range with all clearances taken up; a small
        part of these clearances moves the output as the first order says.

    Raises
    ------
    BadInput
        If a clearance is negative, not finite or longer than the longest link, a joint or link
        is not among those named, or the linkage cannot reach a crank angle.

    Notes
    -----
    Half-angles of the triangle BCD, and differences of its angles from those of their squared
    sines: for a vanishing clearance full relative accuracy remains.  The angle of the coupler does
    not depend on the joint either; its points do.

    Examples
    --------
    >>> import elastolink as el
    >>> play = el.clearance_range(el.FourBar(10, 8, 10, 10), 0.1, 0.0)
    >>> print(play.width.round(4), play.small.round(4))
    0.0503 0.0503
    """
    require_linkage(linkage)
    links, sliding, _ = _OUTPUTS[linkage.mechanism]
    link = links[0] if link is None else link
    require_one_of("link", link, links)
    plays = _checked(linkage, clearances, joint)
    if theta is None and linkage.crank_turns:
        theta = np.linspace(0.0, math.tau, 361)
    elif theta is None:
        theta = np.concatenate([np.linspace(*ends, 181) for ends in linkage.crank_ranges()])
    halves = {name: math.ldexp(c / 2.0, linkage.scale) for name, c in plays.items()}
    guide = halves.pop(sliding, 0.0)
    slack = math.fsum(halves.values()), guide
    angles = finite_array("theta", theta, "angles [rad]")
    task = _Task(linkage, link, slack, angles)
    play = task.play
    errors = DeferredGroup(task.errors)
    nominal, below, above, small = (
        task.in_units(part) for part in (play.nominal, play.below, play.above, play.small)
    )
    least, greatest = _extremes(task)
    given = {f"clearances.{name}": repr(c) for name, c in plays.items()}
    unit = "m" if link == "slider" else "rad"
    return ClearanceRange(
        linkage=linkage,
        link=link,
        clearances=plays,
        theta2=angles,
        nominal=nominal,
        lower=nominal - below,
        upper=nominal + above,
        below=below,
        above=above,
        width=below + above,
        small=small,
        folds=play.folds,
        free=play.free,
        nominal_error=errors.later("nominal_error"),
        greatest=greatest,
        least=least,
        method="differences of half-angles, from those of their squared sines",
        error=errors.later("error"),
        error_norm=f"below, above and width [{unit}], absolute, entrywise",
        checks=DeferredChecks(partial(_checks, task)),
        provenance=provenance({**linkage.provenance, **given}),
    )


@dataclass(frozen=True)
class _Task:
    """A request, checked; radius, guide and sizes below 1 by a power of two."""

    linkage: FourBar | SliderCrank | QuickReturn
    link: str
    slack: tuple[float, float]  # radius of the play of all pins, half the clearance of the guide
    theta: Array

    @property
    def route(self) -> Route:
        """The way to the play of this output, made anew: its functions bear no pickling."""
        return _OUTPUTS[self.linkage.mechanism][2](self.linkage, self.link)

    @cached_property
    def position(self) -> CrankPosition:
        """The crank at its angles."""
        return self.route.position(self.theta)

    @cached_property
    def play(self) -> Play:
        """The play there; refused where the linkage cannot be."""
        play = self.route.at(self.position, *self.slack)
        reached = play.margin >= -self.position.margin_error
        if isinstance(self.linkage, FourBar):
            # With the crank's pin on the follower's pivot, every follower angle is the nominal one.
            reached &= self.position.variable > self.position.margin_error
        self.linkage.require(reached, self.theta)
        return play

    def errors(self) -> dict[str, Array]:
        """Return the errors as fields of the result."""
        error, nominal = self.route.errors(self.position, *self.slack, self.play)
        return {"error": self.in_units(2.0 * error), "nominal_error": self.in_units(nominal)}

    def in_units(self, value: Array | float) -> Array:
        """Return places in the linkage's unit: those of a slider are lengths."""
        return np.asarray(np.ldexp(value, -self.linkage.scale if self.link == "slider" else 0))


def _checked(
    linkage: FourBar | SliderCrank | QuickReturn,
    clearances: float | Mapping[str, float],
    joint: str | None,
) -> dict[str, float]:
    if isinstance(clearances, Mapping):
        if joint is not None:
            raise bad("joint", shown(joint), "none beside clearances by joint", "leave it out")
        given = dict(clearances)
    else:
        require_kind("joint", joint, (str, type(None)), 'name it by its links, as "23"')
        given = {"34" if joint is None else joint: clearances}
    longest = max(abs(size) for size in linkage.lengths.values())
    problems = []
    for name, value in given.items():
        where = f"clearances[{name!r}]"
        if name not in JOINTS:
            fix = "name the joint by its two links"
            problems.append(Problem(where, shown(name), f"one of {', '.join(JOINTS)}", fix))
        if not (is_finite(value) and 0.0 <= value <= longest):
            expected = f"a clearance from 0 to the longest length, {longest:g}"
            problems.append(Problem(where, shown(value), expected, "correct it"))
    refuse(problems)
    return {name: float(given[name]) for name in JOINTS if name in given}


def _extremes(task: _Task) -> tuple[WidthExtreme, WidthExtreme]:
    """Return least and greatest width over the crank's range."""
    # The width depends on one variable, the diagonal, the gap or the slide, and can be extreme
    # where its derivative vanishes, where the play begins to fold, and at the ends.
    route = task.route
    low, high = route.interval
    places = [low, high]
    for place in route.candidates(*task.slack):
        # The width jumps where a fold begins, so that both sides of the place count.
        nudge = 16.0 * EPS * max(abs(low), abs(high))
        places += [place - nudge, place, place + nudge]
    inside = np.unique([place for place in places if low <= place <= high])
    play = route.measure(inside, *task.slack)
    width = play.below + play.above
    least, greatest = (
        WidthExtreme(route.crank(float(inside[i])), float(task.in_units(width[i])))
        for i in (int(np.argmin(width)), int(np.argmax(width)))
    )
    return least, greatest


def _checks(task: _Task) -> dict[str, Check]:
    return {
        "loop closure at both ends over its round-off": Check(_gap(task), 1.0),
        "small clearances against the first order": Check(_first_order(task), 1.0),
    }


def _gap(task: _Task) -> float:
    """Return how far the loop with all clearance taken up stays open, over its round-off."""
    play = task.play
    error = np.add(*task.route.errors(task.position, *task.slack, play))
    longest = max(abs(size) for size in task.linkage.unit_lengths.values())
    limit = 64.0 * EPS * longest * np.maximum(np.abs(task.theta), 1.0)
    ends = (play.nominal - play.below, play.nominal + play.above)
    missing = [np.where(play.free, 0.0, _missing(task, end)) for end in ends]
    return float(np.max(np.abs(missing) / (limit + longest * error), initial=0.0))


def _missing(task: _Task, end: Array) -> Array:
    """Return by how much the loop at an end of the range leaves or exceeds the play."""
    (play, guide), sizes = task.slack, task.linkage.unit_lengths
    pin = sizes["crank"] * np.exp(1j * task.theta)
    if isinstance(task.linkage, QuickReturn):
        away = np.abs(((pin + sizes["frame"]) * np.exp(-1j * end)).imag)
        return np.asarray(away - (play + guide))
    if isinstance(task.linkage, FourBar):
        side, other, span = sizes["follower"], sizes["coupler"], pin - sizes["frame"]
        if task.link == "coupler":
            side, other, span = other, side, -span
        bridged = np.abs(side * np.exp(1j * end) - span)
        return _nearest(bridged - (other + play), bridged - (other - play))
    gap = sizes["offset"] - pin.imag
    if task.link == "coupler":
        height = sizes["coupler"] * np.sin(end) - gap
        return _nearest(height - (play + guide), height + (play + guide))
    along, coupler = end - pin.real, sizes["coupler"]
    near, far = np.maximum(np.abs(gap) - guide, 0.0), np.abs(gap) + guide
    reach = np.hypot(along, near), np.hypot(along, far)
    return _nearest(reach[0] - (coupler + play), reach[1] - (coupler - play))


def _nearest(one: Any, other: Any) -> Array:
    return np.asarray(np.minimum(np.abs(one), np.abs(other)))


def _first_order(task: _Task) -> float:
    """Return how far small clearances leave the first order, over what the next order may do."""
    # The series in the radius of play converges up to the first fold; its next term but one is of
    # the second power of that ratio.
    radius, guide = task.slack
    if radius + guide == 0.0 or task.theta.size == 0:
        return 0.0
    margin = np.maximum(task.play.margin, 0.0)
    part = _SMALL_PLAY * margin / (radius + guide)
    given = task.position, radius * part, guide * part
    small = task.route.at(*given)
    error, _ = task.route.errors(*given, small)
    apart = np.abs(small.below + small.above - small.small)
    allowed = 8.0 * _SMALL_PLAY**2 * small.small + 4.0 * error
    if task.link == "slider":
        # Across the guide the first order vanishes where the coupler lies along it.
        leg = np.sqrt(task.linkage.unit_lengths["coupler"] * np.maximum(margin, EPS))
        allowed = allowed + 2.0 * (guide * part) ** 2 / leg
    clear = task.play.margin > 1e6 * task.position.margin_error
    return float(np.max(apart[clear] / allowed[clear], initial=0.0))
