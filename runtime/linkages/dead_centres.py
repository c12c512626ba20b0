"""Extreme and special positions of the linkages, from correctly rounded sums of their lengths.

Each angle x comes as ``2 atan(sqrt(n/d))`` where ``1 - cos x`` and ``1 + cos x`` are to each other
as n to d, and both factor into sums of lengths: nothing cancels.  Lengths below 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from math import fsum, pi, tau

_EPS = 2.0**-52


@dataclass(frozen=True)
class Positions:
    """What :class:`~.transmission.TransmissionAngle` is made from; its words apply here.

    Attributes
    ----------
    cosine_check : tuple of 2 floats
        Largest difference from the plain law of cosines, and its round-off.
    """

    mechanism: str
    least: float
    greatest: float
    at_least: tuple[float, ...]
    at_greatest: tuple[float, ...]
    crank_ranges: tuple[tuple[float, float], ...]
    dead_centres: Mapping[str, float]
    outputs: Mapping[str, float]
    toggles: Mapping[str, tuple[float, ...]]
    output_range: tuple[float, float] | None
    swing: float | None
    time_ratio: float | None
    cosine_check: tuple[float, float]


@dataclass(frozen=True)
class _Sums:
    """Sums of the four lengths of a loop ABCD, each correctly rounded.

    ``less_x`` is the sum of the other three less x, ``two``, ``three`` and ``four`` are frame +
    crank, frame + coupler and frame + follower less the other two.
    """

    total: float
    less_frame: float
    less_crank: float
    less_coupler: float
    less_follower: float
    two: float
    three: float
    four: float

    @classmethod
    def of(cls, a: float, b: float, c: float, d: float) -> _Sums:
        return cls(
            fsum((a, b, c, d)),
            fsum((-a, b, c, d)),
            fsum((a, -b, c, d)),
            fsum((a, b, -c, d)),
            fsum((a, b, c, -d)),
            fsum((a, b, -c, -d)),
            fsum((a, -b, c, -d)),
            fsum((a, -b, -c, d)),
        )


def four_bar(
    frame: float, crank: float, coupler: float, follower: float, branch: float
) -> Positions:
    """Return the positions of a four-bar linkage (Aannaque 3.9, 3.10, and the triangles ACD)."""
    s = _Sums.of(frame, crank, coupler, follower)
    inner, outer = s.three * s.four < 0, s.two > 0
    # Transmission angle 0 or pi at the folds, else from the diagonal frame -+ crank.
    fold_0 = _angle((s.three, s.four), (s.less_coupler, s.less_follower)) if inner else 0.0
    fold_pi = _angle((s.less_frame, s.less_crank), (s.two, s.total)) if outer else pi
    least = 0.0 if inner else _angle((s.three, s.four), (s.less_frame, s.less_crank))
    greatest = pi if outer else _angle((s.less_coupler, s.less_follower), (s.two, s.total))
    centres, outputs = _four_bar_centres(s, crank, coupler, branch)
    output_range = _follower_range(s, branch)
    squares = fsum((coupler**2, follower**2, -(frame**2), -(crank**2)))
    plain = [
        (squares + sign * 2.0 * frame * crank) / (2.0 * coupler * follower)
        for sign, fold in ((1.0, inner), (-1.0, outer))
        if not fold
    ]
    shown = [angle for angle, fold in ((least, inner), (greatest, outer)) if not fold]
    return Positions(
        mechanism="four-bar",
        least=least,
        greatest=greatest,
        at_least=_mirrored(fold_0),
        at_greatest=_mirrored(fold_pi),
        crank_ranges=_symmetric_ranges(fold_0, fold_pi, inner, outer),
        dead_centres=centres,
        outputs=outputs,
        toggles={
            "folded": _mirrored(fold_0) if least == 0.0 else (),
            "extended": _mirrored(fold_pi) if greatest == pi else (),
        },
        output_range=output_range,
        swing=None if output_range is None else output_range[1] - output_range[0],
        time_ratio=None if inner or outer else _time_ratio(centres),
        cosine_check=(
            max((abs(math.cos(x) - y) for x, y in zip(shown, plain, strict=True)), default=0.0),
            8.0 * _EPS * s.total**2 / (coupler * follower),
        ),
    )


def _four_bar_centres(
    s: _Sums, crank: float, coupler: float, branch: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return crank and follower angles where crank and coupler lie in one line.

    Open, C lies to the left of the line from B to D: above the frame when extended, and when folded
    above it if the coupler is the longer one.
    """
    centres, outputs = {}, {}
    if s.four >= 0:
        centres["extended"] = branch * _angle((s.less_frame, s.four), (s.less_follower, s.total))
        outputs["extended"] = branch * _angle((s.four, s.total), (s.less_frame, s.less_follower))
    if s.two * s.three <= 0 and not s.two == s.three == 0:
        centres["folded"] = -branch * _angle((s.three, s.less_crank), (s.two, s.less_coupler))
        side = branch if coupler > crank else -branch
        outputs["folded"] = side * _angle((s.less_coupler, s.less_crank), (s.two, s.three))
    return {name: _turned(angle) for name, angle in centres.items()}, outputs


def _follower_range(s: _Sums, branch: float) -> tuple[float, float] | None:
    """Return the follower's range: an outer limit, an inner one, both or none."""
    outer = _angle((s.four, s.total), (s.less_frame, s.less_follower)) if s.four > 0 else None
    folded = s.two * s.three < 0
    inner = _angle((s.less_coupler, s.less_crank), (s.two, s.three)) if folded else None
    if outer is not None and inner is not None:
        return (outer, inner) if branch > 0 else (-inner, -outer)
    if outer is not None:
        return outer, tau - outer
    return None if inner is None else (-inner, inner)


def slider_crank(crank: float, coupler: float, offset: float, branch: float) -> Positions:
    """Return the positions of a slider-crank linkage.

    The cosine of the transmission angle is (offset - crank sin(theta2))/coupler.
    """
    over, under = fsum((coupler, offset, -crank)), fsum((coupler, -offset, -crank))
    reach = fsum((coupler, crank, -offset)), fsum((coupler, crank, offset))
    upper, lower = over < 0, under < 0
    high = _arcsine(offset + coupler, over, reach[1]) if upper else pi / 2
    low = _arcsine(offset - coupler, under, reach[0]) if lower else -pi / 2
    greatest = pi if upper else _angle((reach[0],), (over,))
    least = 0.0 if lower else _angle((under,), (reach[1],))
    at_greatest = (high, _turned(pi - high)) if upper else (high,)
    at_least = (low, _turned(pi - low)) if lower else (low,)
    centres, outputs = _slider_centres(crank, coupler, offset, over, under, reach, branch)
    # The circuit ends at the folded position, or goes on to the other side of the crank pivot.
    far = math.sqrt(reach[0]) * math.sqrt(reach[1])
    near = _root(over, under) if over * under > 0 else -far
    plain = [(offset + crank) / coupler] * (not lower) + [(offset - crank) / coupler] * (not upper)
    shown = [least] * (not lower) + [greatest] * (not upper)
    return Positions(
        mechanism="slider-crank",
        least=least,
        greatest=greatest,
        at_least=at_least,
        at_greatest=at_greatest,
        crank_ranges=_slider_ranges(low, high, lower, upper),
        dead_centres=centres,
        outputs=outputs,
        toggles={
            "folded": at_least if least == 0.0 else (),
            "extended": at_greatest if greatest == pi else (),
        },
        output_range=(near, far) if branch > 0 else (-far, -near),
        swing=far - near,
        time_ratio=None if upper or lower else _time_ratio(centres),
        cosine_check=(
            max((abs(math.cos(x) - y) for x, y in zip(shown, plain, strict=True)), default=0.0),
            8.0 * _EPS * reach[1 if offset >= 0 else 0] / coupler,
        ),
    )


def _slider_centres(
    crank: float,
    coupler: float,
    offset: float,
    over: float,
    under: float,
    reach: tuple[float, float],
    branch: float,
) -> tuple[dict[str, float], dict[str, float]]:
    """Return crank angles and positions where crank and coupler lie in one line."""
    far = math.sqrt(reach[0]) * math.sqrt(reach[1])
    centres = {"extended": math.atan2(offset, branch * far)}
    outputs = {"extended": branch * far}
    if over * under >= 0 and crank != coupler:
        near = _root(over, under)
        ahead = 1.0 if coupler > crank else -1.0
        centres["folded"] = math.atan2(-ahead * offset, -branch * near)
        outputs["folded"] = branch * ahead * near
    return {name: _turned(angle) for name, angle in centres.items()}, outputs


def quick_return(frame: float, crank: float) -> Positions:
    """Return the positions of a quick-return linkage: the block presses at right angles."""
    shorter, longer = min(frame, crank), max(frame, crank)
    root = _root(fsum((longer, -shorter)), fsum((longer, shorter)))
    lean = math.atan2(shorter, root)
    swings = crank < frame
    at = pi / 2 + lean
    return Positions(
        mechanism="quick-return",
        least=pi / 2,
        greatest=pi / 2,
        at_least=(),
        at_greatest=(),
        crank_ranges=((-pi, pi),),
        dead_centres={"upper": at, "lower": -at} if swings else {},
        outputs={"upper": lean, "lower": -lean} if swings else {},
        toggles={"folded": (), "extended": ()},
        output_range=(-lean, lean) if swings else None,
        swing=2.0 * lean if swings else None,
        time_ratio=at / math.atan2(root, shorter) if root else None,
        cosine_check=(0.0, 0.0),
    )


def _angle(numerator: tuple[float, ...], denominator: tuple[float, ...]) -> float:
    """Return twice the arctangent of the root of the ratio of two products, from 0 to pi."""
    return 2.0 * math.atan2(_root(*numerator), _root(*denominator))


def _root(*factors: float) -> float:
    """Return the root of a product; each factor's sign is known to cancel."""
    return math.prod(math.sqrt(abs(factor)) for factor in factors)


def _arcsine(height: float, less: float, plus: float) -> float:
    """Return the angle of a link that reaches ``height``; link -+ height are given apart."""
    return math.atan2(height, _root(less, plus))


def _turned(angle: float) -> float:
    """Return the angle within (-pi, pi]."""
    if -pi < angle <= pi:
        return angle
    return angle - tau if angle > pi else angle + tau


def _mirrored(angle: float) -> tuple[float, ...]:
    """Return the crank angles that are mirror images in the frame; 0 and pi are their own."""
    return (angle,) if angle in (0.0, pi) else (-angle, angle)


def _symmetric_ranges(
    low: float, high: float, inner: bool, outer: bool
) -> tuple[tuple[float, float], ...]:
    """Return the crank's ranges between the folds at -+low and -+high."""
    if inner and outer:
        return (-high, -low), (low, high)
    if inner:
        return ((low, tau - low),)
    return ((-high, high),)


def _slider_ranges(
    low: float, high: float, lower: bool, upper: bool
) -> tuple[tuple[float, float], ...]:
    """Return the crank's ranges, its sine between those of low and high."""
    if lower and upper:
        return (low, high), (pi - high, pi - low)
    if lower:
        return ((low, pi - low),)
    if upper:
        return ((-pi - high, high),)
    return ((-pi, pi),)


def _time_ratio(centres: Mapping[str, float]) -> float | None:
    """Return the quick-return ratio, at least 1, of a fully turning crank."""
    if set(centres) != {"extended", "folded"}:
        return None
    stroke = (centres["folded"] - centres["extended"]) % tau
    quicker = min(stroke, tau - stroke)
    return (tau - quicker) / quicker if quicker else None
