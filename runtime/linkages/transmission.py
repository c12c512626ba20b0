"""Transmission angle and its extremes, dead centres, toggles, swing and mechanical advantage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.results import Check, Result, provenance
from . import FourBar, QuickReturn, SliderCrank, dead_centres
from .dead_centres import Positions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
_EPS = float(np.finfo(float).eps)
_RECOMMENDED = (math.radians(40.0), math.radians(140.0))
# The half-angle formulas: every sum is rounded once, and so are two roots, their products, a
# quotient and the arctangent, to 3.5 eps in all; the rest is for the library's arctangent.
_ROUND_OFF = 5.0 * _EPS


@dataclass(frozen=True, kw_only=True)
class TransmissionAngle(Result):
    """Extremes of the transmission angle, and the positions that a designer asks for with them.

    Crank angles lie from -pi (exclusive) to pi.  The output is the follower (its angle theta4), the
    slider (its position) or the rod (its angle).  ``error`` is the figure of the extremes, given
    the lengths as they are.

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

    @property
    def worst(self) -> float:
        """Acute angle between coupler and follower where it is least: the quality of motion."""
        return min(self.least, math.pi - self.greatest)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the transmission angle against the crank angle, with its band and extremes."""
        from ..core.plotting import axes_or_new

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
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("transmission angle [deg]")
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, fontsize=8)
        return ax

    def angle(self, theta: ArrayLike) -> Array:
        """Return the transmission angle [rad] at crank angles within the ranges (Aannaque 3.9)."""
        theta = np.asarray(theta, dtype=float)
        sizes = self.lengths
        if self.mechanism == "quick-return":
            return np.full(theta.shape, math.pi / 2)
        crank, coupler = sizes["crank"], sizes["coupler"]
        if self.mechanism == "slider-crank":
            cosine = (sizes["offset"] - crank * np.sin(theta)) / coupler
        else:
            frame, follower = sizes["frame"], sizes["follower"]
            diagonal = frame**2 + crank**2 - 2.0 * frame * crank * np.cos(theta)
            cosine = (coupler**2 + follower**2 - diagonal) / (2.0 * coupler * follower)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


@dataclass(frozen=True, kw_only=True)
class MechanicalAdvantage(Result):
    """Torque on the output over torque on the crank, without friction and inertia.

    Attributes
    ----------
    theta2 : ndarray
        Crank angles [rad].
    advantage : ndarray
        Torque (for a slider: force) that the output gives, over the torque on the crank: crank
        speed over speed of the output.  Infinite exactly at a dead centre.  ``error`` is the figure
        of its reciprocal, which is bounded there.
    speed_ratio : ndarray
        Its reciprocal: speed of the output over that of the crank.
    poles : ndarray
        Crank angles of the dead centres [rad].
    """

    theta2: Array
    advantage: Array
    speed_ratio: Array
    poles: Array

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the mechanical advantage against the crank angle, its poles dotted."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        order = np.argsort(self.theta2, axis=None)
        shown = np.where(np.abs(self.advantage) < 50.0, self.advantage, np.nan)
        ax.plot(np.degrees(np.ravel(self.theta2)[order]), np.ravel(shown)[order])
        for pole in self.poles:
            ax.axvline(math.degrees(pole % math.tau), color="0.5", ls=":", lw=1.0)
        ax.axhline(0.0, color="0.8", lw=0.8)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("mechanical advantage")
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

    Raises
    ------
    BadInput
        If the band is not two rising angles between 0 and pi, or this is no linkage.
    """
    low, high = _checked_band(band)
    found = positions(linkage)
    deviation, limit = found.cosine_check
    return TransmissionAngle(
        mechanism=found.mechanism,
        least=found.least,
        greatest=found.greatest,
        at_least=np.array(found.at_least),
        at_greatest=np.array(found.at_greatest),
        band=(low, high),
        within_band=low <= found.least and found.greatest <= high,
        crank_ranges=np.array(found.crank_ranges),
        dead_centres=found.dead_centres,
        output_at_dead_centres=found.outputs,
        toggles={name: np.array(angles) for name, angles in found.toggles.items()},
        output_range=found.output_range,
        swing=found.swing,
        time_ratio=found.time_ratio,
        lengths={name: float(size) for name, size in linkage.lengths.items()},
        method="half-angle formulas of correctly rounded sums",
        error=_ROUND_OFF * found.greatest,
        error_norm="least and greatest transmission angle [rad], absolute, worst",
        error_kind="bound",
        checks={"cosines of the extremes by the law of cosines": Check(deviation, limit)},
        provenance=provenance({f"links.{k}": repr(v) for k, v in linkage.lengths.items()}),
    )


def positions(linkage: FourBar | SliderCrank | QuickReturn) -> Positions:
    """Return the extremes and special positions of a linkage.

    Raises
    ------
    BadInput
        If this is no linkage.
    """
    if not isinstance(linkage, (FourBar, SliderCrank, QuickReturn)):
        found_text = repr(linkage)[:60]
        raise bad("linkage", found_text, "FourBar, SliderCrank or QuickReturn", "give one")
    sizes = linkage.lengths
    exponent = -math.frexp(max(map(abs, sizes.values())))[1]
    # Lengths below 1 by a power of two: their digits stay, their products are safe.
    unit = {name: math.ldexp(float(size), exponent) for name, size in sizes.items()}
    if isinstance(linkage, SliderCrank):
        found = dead_centres.slider_crank(**unit, branch=linkage.branch)
        return _lengthened(found, -exponent)
    if isinstance(linkage, QuickReturn):
        return dead_centres.quick_return(unit["frame"], unit["crank"])
    return dead_centres.four_bar(**unit, branch=linkage.branch)


def mechanical_advantage(
    linkage: FourBar | SliderCrank | QuickReturn, theta: ArrayLike
) -> MechanicalAdvantage:
    """Return the mechanical advantage at crank angles (Aannaque 3.1, corrected).

    T4/T2 = omega2/omega4 = follower sin(transmission angle)/(crank sin(beta)), beta between crank
    and coupler; printed (3.1) has the frame in the place of the crank.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        The linkage.
    theta : array_like
        Crank angles [rad], any shape.

    Raises
    ------
    BadInput
        If this is no linkage, an angle is not a finite number, or the linkage cannot reach it or
        folds there.
    """
    found = positions(linkage)
    motion: Any = linkage.motion(theta)
    ratio, error = _SPEEDS[found.mechanism](linkage, motion)
    with np.errstate(divide="ignore"):
        advantage = 1.0 / ratio
    return MechanicalAdvantage(
        theta2=motion.theta2,
        advantage=advantage,
        speed_ratio=ratio,
        poles=np.array([*found.dead_centres.values()]),
        method=motion.method,
        error=error,
        error_norm="speed ratio, absolute, entrywise",
        checks=motion.checks,
        provenance=motion.provenance,
    )


def _four_bar_speed(linkage: FourBar, motion: Any) -> tuple[Array, Array]:
    """Return omega4 over omega2, and what the error of the angles does to it."""
    ratio = np.asarray(motion.omega4)
    sine = np.abs(np.sin(motion.transmission_angle))
    aligned = np.abs(np.cos(motion.theta4 - motion.theta3))
    passed_on = linkage.crank / linkage.follower + np.abs(ratio) * aligned
    return ratio, np.asarray(2.0 * motion.error * passed_on / sine + 4.0 * _EPS * np.abs(ratio))


def _slider_speed(linkage: SliderCrank, motion: Any) -> tuple[Array, Array]:
    """Return the slider's speed over the crank's, and what the error of theta3 does to it."""
    ratio = np.asarray(motion.link("slider").velocity[..., 0])
    cosine = np.abs(np.cos(motion.theta3))
    turned = _EPS * (np.abs(motion.theta2) + 8.0 / cosine)
    return ratio, np.asarray(linkage.crank * 2.0 * turned / cosine**2 + 4.0 * _EPS * np.abs(ratio))


def _rod_speed(linkage: QuickReturn, motion: Any) -> tuple[Array, Array]:
    """Return the rod's speed over the crank's; the distance of block and pivot passes errors on."""
    ratio = np.asarray(motion.link("rod").speed)
    distance = np.hypot(
        linkage.frame + linkage.crank * np.cos(motion.theta2),
        linkage.crank * np.sin(motion.theta2),
    )
    turned = _EPS * (np.abs(motion.theta2) + 4.0)
    lever = (linkage.frame + linkage.crank) / distance
    return ratio, np.asarray(turned * lever**2 * (1.0 + np.abs(ratio)))


_SPEEDS: dict[str, Any] = {
    "four-bar": _four_bar_speed,
    "slider-crank": _slider_speed,
    "quick-return": _rod_speed,
}


def _checked_band(band: tuple[float, float]) -> tuple[float, float]:
    """Return the band as two floats, or raise BadInput."""
    try:
        low, high = map(float, band)
    except (TypeError, ValueError) as refusal:
        raise bad("band", repr(band)[:60], "two angles [rad]", "give (low, high)") from refusal
    if not 0 <= low < high <= math.pi:
        raise bad("band", repr(band)[:60], "0 <= low < high <= pi", "give radians, rising")
    return low, high


def _lengthened(found: Positions, exponent: int) -> Positions:
    """Return the positions of a slider in the unit of the lengths."""
    low, high = found.output_range or (0.0, 0.0)
    return replace(
        found,
        outputs={name: math.ldexp(value, exponent) for name, value in found.outputs.items()},
        output_range=(math.ldexp(low, exponent), math.ldexp(high, exponent)),
        swing=math.ldexp(found.swing or 0.0, exponent),
    )
