"""Quiet speeds above limiting critical speeds, from the stresses over a range (Aannaque 7.5)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import ClassVar

import numpy as np

from ..beams.element_forms import required_structure
from ..core.errors import Problem, bad, refuse
from ..core.families import LinearPeriodic
from ..core.inputs import is_finite, numbers
from ..core.maxima import local_maxima
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result
from ..recovery.stress_over_speed import StressCurve, shade_unstable, stress_curve
from .speed_profile import Array


@dataclass(frozen=True)
class Band:
    """A range of speeds in which every link stays within its limit and the motion is stable.

    Attributes
    ----------
    low, high : float
        Ends [rad/s]: of the range that was looked at, where a limit is met, or the last speed
        known to be stable.
    best : float
        Speed at which the largest stress over its limit is least [rad/s].
    ratio : float
        That ratio.
    above : float or None
        The limiting critical speed that the machine must pass to get there [rad/s], or where
        there is none the end of what it must pass; None where there is nothing below.
    """

    low: float
    high: float
    best: float
    ratio: float
    above: float | None


@dataclass(frozen=True, kw_only=True)
class QuietSpeeds(Result):
    """Critical, limiting and quiet speeds of a linkage of beams.

    ``error`` is that of the ratio at each speed, relative.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s], increasing.
    links : tuple of str
        Links with a limit.
    ratio : ndarray, shape (ns, links)
        Largest stress over its limit.
    critical : ndarray
        Speeds at which the largest ratio of all links has a local maximum [rad/s].
    limiting : ndarray
        Those of them at which a limit is passed [rad/s].
    bands : tuple of Band
        Ranges within all limits, less those not known to be stable, by rising speed.
    curve : StressCurve
        What they come from.
    """

    speed: Array
    links: tuple[str, ...]
    ratio: Array
    critical: Array
    limiting: Array
    bands: tuple[Band, ...]
    curve: StressCurve = field(repr=False)

    arrays_along: ClassVar = {
        "speed": "speed error",
        "speed link": "ratio",
        "critical": "critical",
        "limiting": "limiting",
    }
    column_units: ClassVar = {"rad/s": "critical limiting"}

    @property
    def worst(self) -> Array:
        """Largest ratio of all links, ``(ns,)``."""
        return np.asarray(np.max(self.ratio, axis=1))

    @property
    def unstable(self) -> tuple[tuple[float, float], ...]:
        """Ranges of speeds not known to be stable [rad/s]: no band is there."""
        return self.curve.unstable_ranges

    @property
    def quiet(self) -> tuple[Band, ...]:
        """The bands beyond a limiting critical speed."""
        return tuple(band for band in self.bands if band.above is not None)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the ratios over the speed, the limit, the bands, and what is unstable."""
        ax = axes_or_new(ax)
        for link, values in zip(self.links, self.ratio.T, strict=True):
            ax.semilogy(self.speed, values, label=link, linewidth=0.9)
        ax.axhline(1.0, color="0.3", linewidth=0.8)
        for band in self.bands:
            ax.axvspan(band.low, band.high, color="tab:green", alpha=0.12, linewidth=0.0)
        shade_unstable(ax, self.unstable)
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest stress over its limit")
        ax.legend()
        return ax


def quiet_speeds(
    system: LinearPeriodic,
    speeds: tuple[float, float] | Array,
    limits: float | Mapping[str, float],
    *,
    rtol: float = 1e-3,
) -> QuietSpeeds:
    """Return the speeds at which a linkage may run, and those that it must pass quickly.

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams whose sections have a thickness, with damping.
    speeds : pair of float, or array_like
        Lowest and highest crank speed [rad/s], of which 1000 are taken; or all of them.
    limits : float or mapping of str to float
        Allowed stress [Pa], of all links or by link; links that are not named are not watched.
    rtol : float
        Wanted error of the stresses, relative.

    Returns
    -------
    QuietSpeeds
        Its check ``resolved``: the change of the largest ratio between neighbouring speeds, at
        the worst place, against 0.5: beyond it peaks may hide between the speeds.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.quiet_speeds(system, np.linspace(28.0, 36.0, 12), limits=200e6, rtol=1e-2)
    >>> print([(round(band.low, 1), round(band.high, 1)) for band in found.quiet])
    [(31.2, 33.5)]
    """
    links = [beam.name for beam in required_structure(system).beams]
    named = _limits(limits, links)
    given = numbers("speeds", speeds)
    if given.shape == (2,):
        given = np.linspace(given[0], given[1], 1000)
    if given.ndim != 1 or len(given) < 3 or not (given[0] > 0 and np.all(np.diff(given) > 0)):
        fix = "give the lowest and the highest, or increasing ones"
        raise bad("speeds", str(speeds), "increasing crank speeds above 0", fix)
    curve = stress_curve(system, given, rtol=rtol)
    chosen = [curve.links.index(link) for link in named]
    ratio = curve.maximum[:, chosen] / np.array(list(named.values()))
    worst = np.max(ratio, axis=1)
    critical = _maxima(given, worst)
    limiting = np.array([w for w, height in critical if height > 1.0])
    jump = float(np.max(np.abs(np.diff(np.log(np.maximum(worst, np.finfo(float).tiny))))))
    return QuietSpeeds(
        method=f"local maxima and level crossings of {len(given)} speeds",
        error=np.max(curve.error[:, chosen], axis=1),
        error_norm="largest stress over its limit at each speed, relative",
        checks={**curve.checks, "resolved": Check(jump, 0.5)},
        provenance=dict(curve.provenance),
        speed=given,
        links=tuple(named),
        ratio=ratio,
        critical=np.array([w for w, _ in critical]),
        limiting=limiting,
        bands=_bands(given, worst, limiting, curve.unstable_ranges),
        curve=curve,
    )


def _limits(limits: float | Mapping[str, float], links: list[str]) -> dict[str, float]:
    named = dict(limits) if isinstance(limits, Mapping) else dict.fromkeys(links, limits)
    problems = []
    strange = sorted(map(str, set(named) - set(links)))
    if strange or not named:
        found = ", ".join(strange) or "no link"
        problems.append(Problem("limits", found, f"some of {links}", "correct the name"))
    for link, value in named.items():
        if not (is_finite(value) and value > 1e-100):
            fix = "give a stress in Pa"
            problems.append(Problem(f"limits of {link}", repr(value), "a positive stress", fix))
    refuse(problems)
    return {link: float(value) for link, value in named.items()}


def _maxima(speed: Array, values: Array) -> list[tuple[float, float]]:
    """Return local maxima with their heights, each refined by a parabola in the logarithm."""
    found = []
    for k in local_maxima(values):
        a, b, c = np.log(values[k - 1 : k + 2])
        left, right = speed[k] - speed[k - 1], speed[k + 1] - speed[k]
        first, second = (b - a) / left, (c - b) / right
        bend = (second - first) / (left + right)
        slope = (first * right + second * left) / (left + right)
        shift = float(np.clip(-slope / (2.0 * bend), -left, right)) if bend < 0 else 0.0
        found.append((float(speed[k]) + shift, float(np.exp(b + slope * shift + bend * shift**2))))
    return found


def _bands(
    speed: Array, worst: Array, limiting: Array, unstable: tuple[tuple[float, float], ...] = ()
) -> tuple[Band, ...]:
    """Return the stable ranges where the worst ratio is below 1, their ends interpolated."""
    within = worst < 1.0
    k = np.flatnonzero(within[1:] != within[:-1])
    a, b = np.log(worst[k]), np.log(worst[k + 1])
    crossings = speed[k] + (speed[k + 1] - speed[k]) * a / (a - b)
    ends = [float(speed[0]), *crossings.tolist(), float(speed[-1])]
    allowed = [pair for i, pair in enumerate(pairwise(ends)) if within[0] == (i % 2 == 0)]
    bands = []
    for low, high in _without(allowed, unstable):
        inside = np.flatnonzero((speed >= low) & (speed <= high))
        if not inside.size:
            continue
        best = inside[int(np.argmin(worst[inside]))]
        below = limiting[limiting < low]
        passed = float(below[-1]) if below.size else (low if low > speed[0] else None)
        bands.append(Band(low, high, float(speed[best]), float(worst[best]), passed))
    return tuple(bands)


def _without(
    ranges: list[tuple[float, float]], taken: tuple[tuple[float, float], ...]
) -> list[tuple[float, float]]:
    """Return what is left of ranges; one that begins or ends among the taken is cut there."""
    for begin, end in taken:
        pieces = [((a, min(b, begin)), (max(a, end), b)) for a, b in ranges]
        ranges = [(a, b) for pair in pieces for a, b in pair if a < b]
    return ranges
