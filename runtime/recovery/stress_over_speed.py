"""The largest stress of each link against the crank speed, at a thousand speeds at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.element_forms import required_structure
from ..beams.recovery_forms import RIGID, LinearForm
from ..core.errors import LINEAR_RANGE, bad
from ..core.families import DAMPING, Array, LinearPeriodic
from ..core.inputs import numbers, require_between, require_one_of
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.trigonometric import differentiated, even_angles
from ..periodic.equation import equation_of
from ..periodic.multipliers import floquet_multipliers
from ..periodic.periodic_motion import by_segments
from ..periodic.swept_motions import Growth, Trial, Truncations, speed_ranges
from ..periodic.truncation import arrays_at
from .beam_forces import Stations, require_method
from .stresses import Peaks, largest_of, stress_operator

# Angles of a revolution at first and at the most, and the upper quarter of a motion's harmonics,
# over the largest, times the wanted error, that asks for more of them.
_ANGLES, _MOST_ANGLES, _TAIL = 64, 1024, 0.01
# At a few speeds a motion on the next larger number of modes tells what truncation changes; how
# much larger it may be at other speeds (up to 1.5 times the fourfold in 216 random ones).
ELSEWHERE = 8.0
# The same of what the whole equation changes at some speeds.
_WHOLE = 4.0


@dataclass(frozen=True, kw_only=True)
class StressCurve(Result):
    """The largest stress of each link against the crank speed.

    The motion is the periodic one, stable or not: ``stable`` tells, at the speeds themselves.
    What lies between two of them is seen where it is wider than their distance.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``(ns,)``.
    links : tuple of str
        The beams.
    maximum : ndarray
        Largest size of the stress [Pa] over stations, fibres and the cycle, ``(ns, links)``.
    theta : ndarray
        Crank angle of it [rad], ``(ns, links)``.
    place : ndarray
        x over the beam's length of its station, ``(ns, links)``.
    fibre : ndarray
        1 on the beam's positive side, to the left of its direction, -1 on the other.
    error : ndarray
        Of each maximum, relative, ``(ns, links)``: of the solution of the system's own equations,
        not of its elements or of the choice of stations.
    modes : ndarray of int
        Modes kept at each speed, ``(ns,)``.
    deflection : ndarray or None
        Largest deflection over the length of its link, ``(ns,)``; None where links have none.
    multiplier, multiplier_error : ndarray or None
        Modulus of the largest Floquet multiplier, and its absolute error, ``(ns,)``; None where
        that was not requested.
    """

    speed: Array
    links: tuple[str, ...]
    maximum: Array
    theta: Array
    place: Array
    fibre: Array
    modes: NDArray[np.int64]
    deflection: Array | None = None
    multiplier: Array | None = None
    multiplier_error: Array | None = None

    exported: ClassVar[tuple[str, ...]] = ("stable",)
    arrays_along: ClassVar = {
        "speed": "speed modes deflection stable multiplier multiplier_error",
        "speed link": "maximum theta place fibre error",
    }
    column_units: ClassVar = {"Pa": "maximum"}

    @property
    def stable(self) -> NDArray[np.bool_] | None:
        """Whether nearby motions stay near, ``(ns,)``; None where that was not requested.

        The largest multiplier is then within the unit circle by more than its error: what the
        error leaves open is not called stable.
        """
        if self.multiplier is None or self.multiplier_error is None:
            return None
        return np.asarray(self.multiplier + self.multiplier_error < 1.0)

    @property
    def unstable_ranges(self) -> tuple[tuple[float, float], ...]:
        """Ranges not known to be stable [rad/s], rising, from stable speed to stable speed.

        None are given where stability was not requested.
        """
        if self.stable is None:
            return ()
        order = np.argsort(self.speed, kind="stable")
        speed, off = self.speed[order], ~self.stable[order]
        edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
        last = len(speed) - 1
        return tuple(
            (float(speed[max(a - 1, 0)]), float(speed[min(b, last)]))
            for a, b in zip(edges[::2], edges[1::2], strict=True)
        )

    def of(self, link: str) -> Array:
        """Return the largest stress of one link at each speed [Pa], ``(ns,)``.

        Raises ``BadInput`` if the link has no station.
        """
        require_one_of("link", link, self.links, "choose one with stations")
        return np.asarray(self.maximum[:, self.links.index(link)])

    def at(self, places: NDArray[np.intp]) -> StressCurve:
        """Return the same at some of the speeds, by their places."""
        rows = {
            name: value[places]
            for name, axes in self.dimensions.items()
            if axes[0] == "speed" and name != "stable"
            for value in (getattr(self, name),)
            if value is not None
        }
        return replace(self, **rows)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of each link over the speed, unstable ranges shaded."""
        ax = axes_or_new(ax)
        order = np.argsort(self.speed)
        for link, values in zip(self.links, self.maximum.T, strict=True):
            ax.semilogy(self.speed[order], values[order] / 1e6, label=link, linewidth=0.9)
        shade_unstable(ax, self.unstable_ranges)
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest stress [MPa]")
        ax.legend()
        return ax


def shade_unstable(ax: Axes, ranges: Iterable[tuple[float, float]]) -> None:
    """Shade ranges of speeds [rad/s] in a picture; the first one is named."""
    for k, (low, high) in enumerate(ranges):
        # A colour that none of the lines has, with an edge that a narrow range needs.
        label = None if k else "unstable"
        ax.axvspan(low, high, color="tab:red", alpha=0.2, linewidth=0.5, label=label)


def stress_curve(
    system: LinearPeriodic,
    speeds: ArrayLike,
    *,
    stations: Stations = None,
    rtol: float = 1e-4,
    method: str = "equilibrium",
    stability: bool = True,
    whole: bool = True,
) -> StressCurve:
    """Return the largest stress of each link of a structure of beams against the crank speed.

    The motion is sought on the lowest modes of the mechanism, which move with it; all others
    follow in equilibrium with their inertia.  The transition matrices of what is left are
    polynomials of the inverse speed in ranges of it (Aannaque 8.5, Figs. 8.24-8.26, at all
    speeds).

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams, damped: at a resonance without damping there is no answer.
    speeds : array_like, shape (ns,)
        Crank speeds [rad/s].
    stations : int or mapping of str to array_like, optional
        Places on each beam: how many, or by beam the places x/length; by default 7.
    rtol : float
        Wanted relative error of each maximum, 1e-6 to 1e-2.
    method : str
        ``"equilibrium"`` or ``"shape"``, as :func:`elastolink.stress` takes it.
    stability : bool
        Whether the largest multiplier is computed at each speed too.
    whole : bool
        Whether the whole equation is solved too, at up to three speeds of each range; a multiple of
        what this changes is part of the error.

    Returns
    -------
    StressCurve
        Its checks: ``converged``, the largest error over ``rtol``; ``equation``, if ``whole``, the
        largest relative change of a maximum by solving the whole equation, at some speeds;
        ``linear range``, the largest deflection over the length of its link.

    Raises
    ------
    BadInput
        If an argument is unusable, the system is not one of beams, nothing acts on it, or no
        subspace of modes is smooth.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> curve = el.stress_curve(system, [20.0, 25.0], whole=False)
    >>> print(curve.links, (curve.maximum / 1e6).round().tolist())
    ('crank', 'coupler', 'follower') [[52.0, 10.0, 39.0], [91.0, 16.0, 77.0]]
    """
    required_structure(system)
    given = np.atleast_1d(numbers("speeds", speeds))
    if given.ndim != 1 or not given.size or not np.all(np.isfinite(given) & (given > 0)):
        raise bad("speeds", speeds, "positive finite speeds [rad/s], one row", "correct them")
    require_between("rtol", rtol, 1e-6, 1e-2, "choose 1e-4")
    require_method(method)
    # Nothing else bounds the resonances.
    if not any(name in DAMPING for name, _ in arrays_at(system, even_angles(system.period, 16))):
        found, fix = "a system without damping", "add some, with_modal_damping for example"
        raise bad("system", found, "damping, which bounds the resonances", fix)
    rising, back = np.unique(given, return_inverse=True)
    # Stations per link by default: with three elements their ends and middles.
    places = 7 if stations is None else stations
    work = _Work(system, Fibres(system, places, method), rtol, whole)
    parts = [work.range_of(rising[part]) for part in speed_ranges(rising)]
    peaks = Peaks.joined(part.peaks for part in parts)
    size, error = peaks.size, peaks.error
    checks, deflection = {}, None
    if whole:
        checks["equation"] = Check(max(part.changed for part in parts), rtol)
    checks["converged"] = Check(float(np.max(error)), rtol)
    if system.relative_deflection is not None:
        deflection = np.concatenate([part.deflection for part in parts])[back]
        checks["linear range"] = Check(float(np.max(deflection)), LINEAR_RANGE)
    growth = _growth(system, parts, rising) if stability else None
    return StressCurve(
        method="modal truncation, transition matrices in tables of the inverse speed",
        error=error.T[back],
        error_norm="of each link's largest stress, relative",
        checks=checks,
        provenance=provenance(system.provenance),
        speed=given,
        links=work.fibres.links,
        maximum=size.T[back],
        theta=peaks.theta.T[back],
        place=work.fibres.place[peaks.row.T[back]],
        fibre=work.fibres.sign[peaks.row.T[back]],
        modes=np.concatenate([np.full(len(part.deflection), part.modes) for part in parts])[back],
        deflection=deflection,
        multiplier=None if growth is None else growth[0][back],
        multiplier_error=None if growth is None else growth[1][back],
    )


class Fibres:
    """Stresses of both outer fibres at stations, as forms of the motion.

    Of each row ``link``, ``place`` (x over its length) and ``sign`` of the fibre: first all
    positive fibres, then the negative ones.
    """

    def __init__(self, system: LinearPeriodic, stations: Stations, method: str) -> None:
        self._system, self._stations, self._method = system, stations, method
        self._forms: dict[int, LinearForm] = {}
        where = stress_operator(system, np.zeros(1), stations, method=method)[1]
        self.links = tuple(dict.fromkeys(station.beam for station in where))
        link = np.array([self.links.index(station.beam) for station in where])
        place = np.array([station.place for station in where])
        self.link, self.place = np.tile(link, 2), np.tile(place, 2)
        self.sign = np.repeat([1.0, -1.0], len(place))

    def form(self, theta: Array) -> LinearForm:
        """Return the stresses [Pa] at even angles of the period as a form of the motion."""
        if len(theta) not in self._forms:
            self._forms[len(theta)], _ = stress_operator(
                self._system, theta, self._stations, method=self._method, accelerations=True
            )
        return self._forms[len(theta)]

    def peaks(self, theta: Array, q: Array, speeds: Array) -> Peaks:
        """Return the largest stresses of motions ``(ns, nt, n)`` at even angles."""
        values = self._values(theta, q, speeds)
        return largest_of(values, self.link, len(self.links), self._system.period)

    def of_errors(self, theta: Array, q: Array, speeds: Array) -> Array:
        """Return how much errors of motions ``(ns, nt, n)`` stress links, ``(links, ns)``."""
        size = np.max(np.abs(self._values(theta, q, speeds, rigid=False)), axis=0)
        return np.array([np.max(size[self.link == k], axis=0) for k in range(len(self.links))])

    def _values(self, theta: Array, q: Array, speeds: Array, *, rigid: bool = True) -> Array:
        motion = {"q": np.moveaxis(q, 0, -1)}
        motion["dq"] = differentiated(motion["q"], self._system.period)
        motion["ddq"] = differentiated(motion["dq"], self._system.period)
        total = np.zeros((len(theta), len(self.link), len(speeds)))
        for (name, power), rows in self.form(theta).parts.items():
            if name != RIGID:
                total += (rows @ motion[name]) * speeds**power
            elif rigid:
                total += rows[..., None] * speeds**power
        return total


@dataclass(frozen=True)
class _Range:
    peaks: Peaks  # their errors with those of the motion and of the truncation
    modes: int
    growth: Growth  # the largest multipliers
    defect: float  # what the modes left out change of one, over its condition
    changed: float  # largest relative change of a maximum by solving the whole equation
    deflection: Array  # largest at each speed, (ns,)


class _Work:
    """One call's work: range after range, with the numbers of modes and of angles reached so far.

    ``angles`` of a revolution at which motions are computed at present; ``least``, the number of
    modes that the next range begins with.
    """

    def __init__(self, system: LinearPeriodic, fibres: Fibres, rtol: float, whole: bool) -> None:
        self.system, self.fibres, self.rtol, self.whole = system, fibres, rtol, whole
        self.truncations = Truncations(system)
        # Error of the transition matrices over the wanted error of the stress.
        self.flow = max(1e-11, 1e-4 * rtol)
        self.angles, self.least = _ANGLES, self.truncations.numbers[0]

    def range_of(self, speeds: Array) -> _Range:
        """Return what one range of rising speeds gives."""
        span = float(speeds[0]), float(speeds[-1])
        few, many, change = self._trials(np.unique(speeds[[len(speeds) // 2, -1]]))
        shift = np.abs(few.growth.modulus - many.growth.modulus)
        defect = float(np.max(shift / many.growth.condition))
        moving = self.truncations.motions(many.truncated.size, self.angles, span, self.flow)
        theta = moving.truncated.theta
        peaks, errors, norms, left, deflection = [], [], [], [], []
        for part, q, error, rest in moving.blocks(speeds):
            peaks.append(self.fibres.peaks(theta, q, speeds[part]))
            left.append(self.fibres.of_errors(theta, rest, speeds[part]))
            errors.append(error)
            norms.append(np.max(np.abs(q), axis=(1, 2)))
            deflection.append(self._deflection(theta, q))
        found = Peaks.joined(peaks)
        # A link that happens to be at rest is moved by an error as at its worst speed.
        share = found.size / np.concatenate(norms)
        weight = np.max(share, axis=1, keepdims=True) / share
        # An error of the motion stresses a link as the motion does, times this at the most.
        changed = self._changed(speeds, found.size) if self.whole else np.zeros(1)
        truncation = _WHOLE * changed if self.whole else ELSEWHERE * change
        # Stiff directions count by the forces: of the motion's size they are next to nothing.
        resting = np.concatenate(left, axis=1) / found.size
        error = 3.0 * weight * np.concatenate(errors) + resting + found.error
        error += truncation[:, None]
        return _Range(
            peaks=replace(found, error=error),
            modes=many.truncated.size,
            growth=moving.growth(speeds),
            defect=defect,
            changed=float(np.max(changed)),
            deflection=np.concatenate(deflection),
        )

    def _changed(self, speeds: Array, size: Array) -> Array:
        """Return the largest relative change of stresses by solving the whole equation, by link."""
        # At the highest speed, in the middle, and where the modes answer most.
        most = int(np.argmax(np.max(size, axis=0) / speeds**2))
        theta = even_angles(self.system.period, max(self.angles, 4 * _ANGLES))
        changes = []
        for k in {len(speeds) - 1, (len(speeds) - 1) // 2, most}:
            equation = equation_of(self.system, float(speeds[k]), {}, forcing=True)
            q, *_ = by_segments(equation, max(1e-9, 0.01 * self.rtol), len(theta))
            exact = self.fibres.peaks(theta, q, speeds[k : k + 1]).size[:, 0]
            changes.append(np.abs(size[:, k] / exact - 1.0))
        return np.asarray(np.max(changes, axis=0))

    def _trials(self, speeds: Array) -> tuple[Trial, Trial, Array]:
        """Return two numbers of modes that agree at some speeds, and what stresses change by."""
        # That is relative, the largest of the speeds, of each link.
        while True:
            offered = self.truncations.usable(self.least, self.angles)
            if not offered:
                found = f"no smooth and periodic subspace of {self.least} modes or more"
                expected = "modes whose frequencies keep their distance over the revolution"
                raise bad("system", found, expected, "take stress() speed by speed")
            trials = [
                self.truncations.trial(number, self.angles, speeds, self.flow) for number in offered
            ]
            few, many = trials[0], trials[-1]
            if self.angles < _MOST_ANGLES and many.tail > _TAIL * self.rtol:
                self.angles *= 2
                continue
            first, last = (
                self.fibres.peaks(tried.truncated.theta, tried.q, speeds).size
                for tried in (few, many)
            )
            change = np.max(np.abs(first / last - 1.0), axis=1)
            if many.truncated.size == self.system.size:
                change = np.zeros_like(change)  # nothing is left out
            most = many.truncated.size == self.truncations.numbers[-1]
            if most or ELSEWHERE * np.max(change) <= 0.5 * self.rtol:
                return few, many, change
            self.least = many.truncated.size

    def _deflection(self, theta: Array, q: Array) -> Array:
        if self.system.relative_deflection is None:
            return np.zeros(len(q))
        rows = self.system.relative_deflection(theta)
        return np.asarray(np.max(np.abs(rows @ np.moveaxis(q, 0, -1)), axis=(0, 1)))


def _growth(system: LinearPeriodic, parts: list[_Range], speeds: Array) -> tuple[Array, Array]:
    """Return the largest multipliers and their errors, by the whole equation at the last speed."""
    modulus, condition, error = (
        np.concatenate([getattr(part.growth, name) for part in parts])
        for name in ("modulus", "condition", "error")
    )
    whole = floquet_multipliers(system, float(speeds[-1]), rtol=1e-8)
    gap = abs(float(np.max(np.abs(whole.multipliers))) - modulus[-1]) / condition[-1]
    defect = max(ELSEWHERE * max(part.defect for part in parts), 2.0 * gap)
    return modulus, error + defect * condition
