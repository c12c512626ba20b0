"""Transmission angle and its extremes, dead centres, toggles, swing and mechanical advantage.

Each special angle x comes as ``2 atan(sqrt(n/d))`` where ``1 - cos x`` and ``1 + cos x`` are to
each other as n to d, and both factor into correctly rounded sums of lengths: nothing cancels.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import fsum, pi, tau
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad, shown
from ..core.inputs import are_finite
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from .four_bar import FourBar
from .linkage import EPS, Array, require_linkage
from .quick_return import QuickReturn
from .slider_crank import SliderCrank

_RECOMMENDED = (math.radians(40.0), math.radians(140.0))
# The half-angle formulas: every sum is rounded once, and so are two roots, their products, a
# quotient and the arctangent, to 3.5 eps in all; the rest is for the library's arctangent.
_ROUND_OFF = 5.0 * EPS


@dataclass(frozen=True, kw_only=True)
class TransmissionAngle(Result):
    """Extremes of the transmission angle, and the positions that a designer asks for with them.

    Crank angles lie from -pi (exclusive) to pi.  The output is the follower (its angle theta4), the
    slider (its position) or the rod (its angle).  ``error`` is that of the extremes, given the
    lengths as they are.

    Attributes
    ----------
    mechanism : str
        "four-bar", "slider-crank" or "quick-return".
    least, greatest : float
        Extremes of the transmission angle over all that the crank can reach [rad]: between coupler
        and follower, or coupler and the normal to the guide; a block on a rod always keeps pi/2.
    at_least, at_greatest : ndarray
        Crank angles where they occur [rad]; empty where the angle never changes.
    band : tuple of 2 floats
        Recommended band [rad].
    within_band : bool
        True where both extremes lie in it.
    crank_ranges : ndarray, shape (n, 2)
        First and last crank angle of each range that the crank can reach [rad].
    dead_centres : mapping of str to float
        Crank angles at which the output stands still [rad]: "extended" and "folded", where crank
        and coupler lie in one line; for the rod "upper" and "lower".  The mechanical advantage is
        infinite there (toggle).
    output_at_dead_centres : mapping of str to float
        Output there [rad or length].
    toggles : mapping of str to ndarray
        Crank angles at which coupler and follower lie in one line, or the coupler stands normal to
        the guide: the crank stands still, and cannot drive.  "folded" (transmission angle 0) and
        "extended" (pi).
    output_range : tuple of 2 floats, or None
        Range of the output [rad or length] in one circuit, None where it turns fully.  Of the two
        circuits of a double rocker, that with C above the frame (open) or below it (crossed).
    swing : float or None
        Length of that range: swing of the follower or rod, stroke of the slider.
    time_ratio : float or None
        Crank turn during the slower stroke of the output over that during the quicker one; with
        a turning rod, of its halves before and behind the normal to the frame.  None where the
        output has no two strokes.
    """

    mechanism: str
    least: float
    greatest: float
    at_least: Array
    at_greatest: Array
    band: tuple[float, float]
    within_band: bool
    crank_ranges: Array
    dead_centres: Mapping[str, float]
    output_at_dead_centres: Mapping[str, float]
    toggles: Mapping[str, Array]
    output_range: tuple[float, float] | None
    swing: float | None
    time_ratio: float | None
    lengths: Mapping[str, float]
    linkage: FourBar | SliderCrank | QuickReturn = field(repr=False)
    arrays_along: ClassVar = {
        "place": "at_least",
        "place_1": "at_greatest",
        "range end": "crank_ranges",
    }
    column_units: ClassVar = {"rad": "least greatest error output_range"}

    @property
    def worst(self) -> float:
        """Acute angle between coupler and follower where it is least: the quality of motion."""
        return min(self.least, math.pi - self.greatest)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the transmission angle against the crank angle, with its band and extremes."""
        ax = axes_or_new(ax)
        for first, last in self.crank_ranges:
            theta = np.linspace(first, last, 721)
            ax.plot(np.degrees(theta), np.degrees(self.angle(theta)), color="#2b5c8a")
        ax.axhspan(*np.degrees(self.band), color="#3a7d44", alpha=0.12, label="recommended band")
        for angles, value in ((self.at_least, self.least), (self.at_greatest, self.greatest)):
            degrees = math.degrees(value)
            text = f"extreme: {degrees:.4g} deg"
            ax.plot(np.degrees(angles), [degrees] * len(angles), "o", color="#8c2d04", label=text)
        for name, angle in self.dead_centres.items():
            at = math.degrees(angle)
            ax.axvline(at, color="0.5", ls=":", label=f"dead centre, {name}: {at:.4g} deg")
        ax.set(xlabel="crank angle [deg]", ylabel="transmission angle [deg]")
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, fontsize=8)
        return ax

    def angle(self, theta: ArrayLike) -> Array:
        """Return the transmission angle [rad] at crank angles within the ranges (Aannaque 3.9)."""
        return np.asarray(np.arccos(_cosine(self.linkage, np.asarray(theta, dtype=float))))

    def mechanical_advantage(self, theta: ArrayLike) -> MechanicalAdvantage:
        """Return the mechanical advantage at crank angles (Aannaque 3.1, corrected).

        T4/T2 = omega2/omega4 = follower sin(transmission angle)/(crank sin(beta)), beta between
        crank and coupler; printed (3.1) has the frame in the place of the crank.

        Parameters
        ----------
        theta : array_like
            Crank angles [rad], any shape.

        Raises
        ------
        BadInput
            If an angle is not a finite number, or the linkage cannot reach it or folds there.
        """
        motion = self.linkage.motion(theta)
        rate = "slider_velocity" if isinstance(self.linkage, SliderCrank) else "omega4"
        ratio = getattr(motion, rate)
        with np.errstate(divide="ignore"):
            advantage = 1.0 / ratio
        return MechanicalAdvantage(
            theta2=motion.theta2,
            advantage=advantage,
            speed_ratio=ratio,
            poles=np.array([*self.dead_centres.values()]),
            method=motion.method,
            # With the round-off of the reciprocal.
            error=motion.errors[rate] + EPS * np.abs(ratio),
            error_norm="speed ratio, absolute, entrywise",
            checks=motion.checks,
            provenance=motion.provenance,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        return {name: value for name, value in super().to_dict().items() if name != "linkage"}


@dataclass(frozen=True, kw_only=True)
class MechanicalAdvantage(Result):
    """Torque on the output over torque on the crank, without friction and inertia.

    Attributes
    ----------
    theta2 : ndarray
        Crank angles [rad].
    advantage : ndarray
        Torque (for a slider: force) that the output gives, over the torque on the crank: crank
        speed over speed of the output.  Infinite exactly at a dead centre.  ``error`` is that of
        its reciprocal, which is bounded there.
    speed_ratio : ndarray
        Its reciprocal: speed of the output over that of the crank.
    poles : ndarray
        Crank angles of the dead centres [rad].
    """

    theta2: Array
    advantage: Array
    speed_ratio: Array
    poles: Array
    arrays_along: ClassVar = {"...": "theta2 advantage speed_ratio error", "pole": "poles"}
    column_units: ClassVar = {"rad": "poles"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the mechanical advantage against the crank angle, its poles dotted."""
        ax = axes_or_new(ax)
        order = np.argsort(self.theta2, axis=None)
        shown = np.where(np.abs(self.advantage) < 50.0, self.advantage, np.nan)
        ax.plot(np.degrees(np.ravel(self.theta2)[order]), np.ravel(shown)[order])
        for pole in self.poles:
            ax.axvline(math.degrees(pole % math.tau), color="0.5", ls=":", lw=1.0)
        ax.axhline(0.0, color="0.8", lw=0.8)
        ax.set(xlabel="crank angle [deg]", ylabel="mechanical advantage")
        return ax


def transmission_angle(
    linkage: FourBar | SliderCrank | QuickReturn, band: tuple[float, float] = _RECOMMENDED
) -> TransmissionAngle:
    """Return the extremes of the transmission angle and the positions beside them.

    A crank that turns fully meets them at 0 and pi (Aannaque 3.10; slider-crank: at pi/2 and
    -pi/2); any other one at the ends of its range, where coupler and follower lie in one line.  All
    angles come from half-angle formulas whose factors are correctly rounded sums of lengths, so
    that nothing cancels next to a change point.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        The linkage.
    band : tuple of 2 floats
        Recommended least and greatest angle [rad]; 40 and 140 degrees by default (Aannaque 3.3).

    Returns
    -------
    TransmissionAngle
        Angles [rad], lengths in the unit of the linkage.

    Raises
    ------
    BadInput
        If the band is not two rising angles between 0 and pi, or this is no linkage.

    Examples
    --------
    >>> import elastolink as el
    >>> found = el.transmission_angle(el.FourBar(12.0, 6.0, 12.0, 12.0))
    >>> print(round(found.least, 4), round(found.greatest, 4), found.within_band)
    0.5054 1.6961 False
    """
    if not (are_finite(band, 2) and 0.0 <= band[0] < band[1] <= pi):
        raise bad("band", shown(band), "two angles, 0 <= low < high <= pi", "give radians, rising")
    band = float(band[0]), float(band[1])
    require_linkage(linkage)
    if isinstance(linkage, SliderCrank):
        return _slider_crank(linkage, band)
    if isinstance(linkage, QuickReturn):
        return _quick_return(linkage, band)
    return _four_bar(linkage, band)


def _result(
    linkage: FourBar | SliderCrank | QuickReturn,
    band: tuple[float, float],
    least: float,
    greatest: float,
    at_least: tuple[float, ...],
    at_greatest: tuple[float, ...],
    round_off: float = 0.0,
    **positions: Any,
) -> TransmissionAngle:
    """Return the result; ``round_off`` is that of a cosine by the plain law of cosines."""
    ends = ((at_least, least), (at_greatest, greatest))
    gaps = [abs(_cosine(linkage, angle) - math.cos(x)) for angles, x in ends for angle in angles]
    worst = Check(float(max(gaps, default=0.0)), round_off)
    lengths = {name: float(size) for name, size in linkage.lengths.items()}
    return TransmissionAngle(
        mechanism=linkage.mechanism.replace("_", "-"),
        least=least,
        greatest=greatest,
        at_least=np.array(at_least),
        at_greatest=np.array(at_greatest),
        band=band,
        within_band=band[0] <= least and greatest <= band[1],
        crank_ranges=np.array(linkage.crank_ranges()),
        toggles={
            "folded": np.array(at_least if least == 0.0 else ()),
            "extended": np.array(at_greatest if greatest == pi else ()),
        },
        **positions,
        lengths=lengths,
        linkage=linkage,
        method="half-angle formulas of correctly rounded sums",
        error=_ROUND_OFF * greatest,
        error_norm="least and greatest transmission angle [rad], absolute, worst",
        error_kind="bound",
        checks={"cosines of the extremes by the law of cosines": worst},
        provenance=provenance({f"links.{name}": repr(size) for name, size in lengths.items()}),
    )


def _four_bar(linkage: FourBar, band: tuple[float, float]) -> TransmissionAngle:
    """Return the positions of a four-bar linkage (Aannaque 3.9, 3.10, and the triangles ACD)."""
    _, crank, coupler, follower = linkage.unit_lengths.values()
    s, branch = linkage.sums, linkage.branch
    # Transmission angle 0 or pi at the folds, else from the diagonal frame -+ crank.
    inner, outer = linkage.limits.ends
    turns = not inner and outer in (None, pi)
    far = _angle((s.less_coupler, s.less_follower), (s.two, s.total)) if outer is None else pi
    # Where crank and coupler lie in one line.  Open, C lies to the left of the line from B to D:
    # above the frame when extended, and when folded above it if the coupler is the longer one.
    centres, outputs = {}, {}
    if s.four >= 0:
        centres["extended"] = branch * _angle((s.less_frame, s.four), (s.less_follower, s.total))
        outputs["extended"] = branch * _angle((s.four, s.total), (s.less_frame, s.less_follower))
    if s.two * s.three <= 0 and not s.two == s.three == 0:
        centres["folded"] = -branch * _angle((s.three, s.less_crank), (s.two, s.less_coupler))
        side = branch if coupler > crank else -branch
        outputs["folded"] = side * _angle((s.less_coupler, s.less_crank), (s.two, s.three))
    centres = {name: _turned(angle) for name, angle in centres.items()}
    # The follower has an outer limit, an inner one, both or none.
    outer_end = abs(outputs["extended"]) if s.four > 0 else None
    inner_end = abs(outputs["folded"]) if s.two * s.three < 0 else None
    output_range = None
    if outer_end is not None and inner_end is not None:
        output_range = (outer_end, inner_end) if branch > 0 else (-inner_end, -outer_end)
    elif outer_end is not None:
        output_range = outer_end, tau - outer_end
    elif inner_end is not None:
        output_range = -inner_end, inner_end
    return _result(
        linkage,
        band,
        least=0.0 if inner is not None else _angle((s.three, s.four), (s.less_frame, s.less_crank)),
        greatest=far,
        at_least=_mirrored(0.0, -(inner or 0.0)),
        at_greatest=_mirrored(0.0, -pi if outer is None else -outer),
        dead_centres=centres,
        output_at_dead_centres=outputs,
        output_range=output_range,
        swing=None if output_range is None else output_range[1] - output_range[0],
        time_ratio=_time_ratio(centres) if turns else None,
        round_off=8.0 * EPS * s.total**2 / (coupler * follower),
    )


def _slider_crank(linkage: SliderCrank, band: tuple[float, float]) -> TransmissionAngle:
    """Return the positions of a slider-crank linkage."""
    # The cosine of the transmission angle is (offset - crank sin(theta2))/coupler.
    crank, coupler, offset = linkage.unit_lengths.values()
    over, under = fsum((coupler, offset, -crank)), fsum((coupler, -offset, -crank))
    reach = fsum((coupler, crank, -offset)), fsum((coupler, crank, offset))
    axis, (lower, upper) = linkage.fold_axis, linkage.limits.ends
    turns = over > 0 and under > 0
    far = math.sqrt(reach[0]) * math.sqrt(reach[1])
    branch, round_off = linkage.branch, 8.0 * EPS * reach[1 if offset >= 0 else 0] / coupler
    centres, outputs = {"extended": math.atan2(offset, branch * far)}, {"extended": branch * far}
    if over * under >= 0 and crank != coupler:
        folded = _root(over, under)
        ahead = 1.0 if coupler > crank else -1.0
        centres["folded"] = _turned(math.atan2(-ahead * offset, -branch * folded))
        outputs["folded"] = branch * ahead * folded
    # The circuit ends at the folded position, or goes on to the other side of the crank pivot.
    near = _root(over, under) if over * under > 0 else -far
    # Far less near, without cancellation where the crank turns.
    stroke = 4.0 * crank * coupler / (far + near) if turns else far - near

    def lengthened(value: float) -> float:
        return math.ldexp(value, -linkage.scale)

    return _result(
        linkage,
        band,
        least=0.0 if lower is not None else _angle((under,), (reach[1],)),
        greatest=pi if upper is not None else _angle((reach[0],), (over,)),
        at_least=_mirrored(axis, lower or 0.0),
        at_greatest=_mirrored(axis, pi if upper is None else upper),
        dead_centres=centres,
        output_at_dead_centres={name: lengthened(value) for name, value in outputs.items()},
        output_range=tuple(map(lengthened, (near, far) if branch > 0 else (-far, -near))),
        swing=lengthened(stroke),
        time_ratio=_time_ratio(centres) if over >= 0 and under >= 0 else None,
        round_off=round_off,
    )


def _quick_return(linkage: QuickReturn, band: tuple[float, float]) -> TransmissionAngle:
    """Return the positions of a quick-return linkage: the block presses at right angles."""
    frame, crank, _ = linkage.unit_lengths.values()
    shorter, longer = min(frame, crank), max(frame, crank)
    root = _root(fsum((longer, -shorter)), fsum((longer, shorter)))
    lean = math.atan2(shorter, root)
    swings = crank < frame
    at = pi / 2 + lean
    return _result(
        linkage,
        band,
        least=pi / 2,
        greatest=pi / 2,
        at_least=(),
        at_greatest=(),
        dead_centres={"upper": at, "lower": -at} if swings else {},
        output_at_dead_centres={"upper": lean, "lower": -lean} if swings else {},
        output_range=(-lean, lean) if swings else None,
        swing=2.0 * lean if swings else None,
        time_ratio=at / math.atan2(root, shorter) if root else None,
    )


def _angle(numerator: tuple[float, ...], denominator: tuple[float, ...]) -> float:
    """Return twice the arctangent of the root of the ratio of two products, from 0 to pi."""
    return 2.0 * math.atan2(_root(*numerator), _root(*denominator))


def _root(*factors: float) -> float:
    """Return the root of a product; each factor's sign is known to cancel."""
    return math.prod(math.sqrt(abs(factor)) for factor in factors)


def _turned(angle: float) -> float:
    """Return the angle within (-pi, pi]."""
    if -pi < angle <= pi:
        return angle
    return angle - tau if angle > pi else angle + tau


def _mirrored(axis: float, angle: float) -> tuple[float, ...]:
    """Return the crank angles on either side of an axis; the axis and its end are their own."""
    one, other = _turned(axis + angle), _turned(axis - angle)
    return (one,) if angle == 0.0 or abs(angle) == pi else (one, other)


def _time_ratio(centres: Mapping[str, float]) -> float | None:
    """Return the quick-return ratio, at least 1, of a fully turning crank."""
    if set(centres) != {"extended", "folded"}:
        return None
    stroke = (centres["folded"] - centres["extended"]) % tau
    quicker = min(stroke, tau - stroke)
    return (tau - quicker) / quicker if quicker else None


def _cosine(linkage: FourBar | SliderCrank | QuickReturn, theta: Any) -> Any:
    """Return the cosine of the transmission angle by the plain law of cosines."""
    if isinstance(linkage, QuickReturn):
        return np.zeros(np.shape(theta))
    size = linkage.unit_lengths
    crank, coupler = size["crank"], size["coupler"]
    if isinstance(linkage, SliderCrank):
        return np.clip((size["offset"] - crank * np.sin(theta)) / coupler, -1.0, 1.0)
    frame, follower = size["frame"], size["follower"]
    diagonal = frame**2 + crank**2 - 2.0 * frame * crank * np.cos(theta)
    cosine = (coupler**2 + follower**2 - diagonal) / (2.0 * coupler * follower)
    return np.clip(cosine, -1.0, 1.0)
