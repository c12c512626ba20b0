"""The largest stress of each link against the crank speed, at a thousand speeds at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.element_forms import required_structure
from ..beams.recovery import METHODS
from ..core.errors import LINEAR_RANGE, bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.results import Check, Result, provenance
from ..floquet.first_order import numbers
from .balance import Balance
from .condensed import Condensed
from .growth import MultiplierSweep
from .ranges import Grid, Range, grid_of, last_harmonics, ranges_of
from .residuals import corrected_motion, corrected_peaks
from .stress_rows import Fibres, Peaks, StressRows, fibres, peaks, stress_rows
from .sweeping import Motions, motions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Run = Callable[[Callable[..., Any], Iterable[Any]], Iterable[Any]]

# Stations per link where none are asked for: with three elements their ends and middles.
_STATIONS = 7
# Share of the wanted error that a motion's last correction may have: it is a norm of the whole
# motion, of which a link is a part.
_SHARE = 0.02
# Norm of the last four harmonics kept, over the wanted error, that asks for more of them.
_LAST = 0.1
# Speeds that differ by less, over themselves, are taken for the same.
_EQUAL = 1e-9
# Parts of a range of speeds in each of which a motion is put into the full equation.
_PARTS = 3
# Angles beyond which no more harmonics are sought.
_MOST_ANGLES = 512
# Speeds worked on at a time.
_TOGETHER = 64
# A correction stresses a link as the motion does, times this at the most.
_MARGIN = 3.0
# How far above what is excited the modes reach at first: the shapes' curvatures ask for more.
_REACH = {"equilibrium": 1.0, "shape": 1.2}
# Change by putting the motion into the full equation, at a few speeds: how much larger it may be
# at others.
_ELSEWHERE = 4.0


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
    harmonics : ndarray of int
        Harmonics kept at each speed, ``(ns,)``.
    nodes : ndarray
        The speeds at which matrices were factorised [rad/s].
    multiplier, multiplier_error : ndarray or None
        Modulus of the largest Floquet multiplier, and its absolute error, ``(ns,)``; None where
        that was not asked for.
    """

    speed: Array
    links: tuple[str, ...]
    maximum: Array
    theta: Array
    place: Array
    fibre: Array
    modes: NDArray[np.int64]
    harmonics: NDArray[np.int64]
    nodes: Array
    multiplier: Array | None = None
    multiplier_error: Array | None = None

    exported: ClassVar[tuple[str, ...]] = ("stable",)
    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "speed": ("speed",),
        "modes": ("speed",),
        "harmonics": ("speed",),
        "nodes": ("node",),
        "stable": ("speed",),
        "multiplier": ("speed",),
        "multiplier_error": ("speed",),
        **dict.fromkeys(("maximum", "theta", "place", "fibre", "error"), ("speed", "link")),
    }

    @property
    def stable(self) -> NDArray[np.bool_] | None:
        """Whether nearby motions stay near, ``(ns,)``; None where that was not asked for.

        The largest multiplier is then within the unit circle by more than its error: what the
        error leaves open is not called stable (see ``undecided``).
        """
        if self.multiplier is None or self.multiplier_error is None:
            return None
        return np.asarray(self.multiplier + self.multiplier_error < 1.0)

    @property
    def undecided(self) -> NDArray[np.bool_] | None:
        """Where the error leaves open on which side of the unit circle the multiplier lies."""
        if self.multiplier is None or self.multiplier_error is None:
            return None
        return np.asarray(np.abs(self.multiplier - 1.0) <= self.multiplier_error)

    @property
    def unstable_ranges(self) -> tuple[tuple[float, float], ...]:
        """Ranges not known to be stable [rad/s], rising, from stable speed to stable speed.

        None are told where stability was not asked for.
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

        Raises
        ------
        BadInput
            If the link has no station.
        """
        if link not in self.links:
            fix = "choose one with stations"
            raise bad("link", repr(link), f"one of {', '.join(self.links)}", fix)
        return np.asarray(self.maximum[:, self.links.index(link)])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of each link over the speed, unstable ranges shaded."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        order = np.argsort(self.speed)
        for link, values in zip(self.links, self.maximum.T, strict=True):
            ax.semilogy(self.speed[order], values[order] / 1e6, label=link, linewidth=0.9)
        shade_unstable(ax, self.unstable_ranges)
        ax.set_xlabel("crank speed [rad/s]")
        ax.set_ylabel("largest stress [MPa]")
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
    stations: int | Mapping[str, ArrayLike] | None = None,
    rtol: float = 1e-4,
    modes: int | None = None,
    method: str = "equilibrium",
    stability: bool = True,
    executor: Executor | None = None,
) -> StressCurve:
    """Return the largest stress of each link of a structure of beams against the crank speed.

    The motion is sought on the lowest modes of the mechanism, which move with it, all others
    answering quasi-statically and to their inertia once more; as a Fourier series whose
    coefficients are rational functions of the speed between some tens of speeds (Aannaque 8.5,
    Figs. 8.24-8.26, at all speeds).

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
    modes : int, optional
        Modes kept; by default as few as each range of speeds needs.
    method : str
        ``"equilibrium"`` or ``"shape"``, as :func:`elastolink.stress` takes it.
    stability : bool
        Whether the largest multiplier is found at each speed, at about a fifth of the cost.
    executor : concurrent.futures.Executor, optional
        Works on independent pieces; threads do, since the linear algebra leaves the interpreter
        free.  The answer does not depend on it.

    Returns
    -------
    StressCurve
        Its checks: ``converged``, the largest error over ``rtol``; ``equation``, the largest
        relative change of a maximum by putting the motion into the full equation, at some speeds;
        ``linear range``, the largest deflection over the length of its link.

    Raises
    ------
    BadInput
        If an argument is unusable, the system is not one of beams, nothing acts on it, or no
        subspace of modes is smooth.
    """
    given = _checked(system, speeds, rtol, method)
    run: Run = map if executor is None else executor.map
    order = np.argsort(given, kind="stable")
    rising = given[order]
    places = _STATIONS if stations is None else stations
    grid = grid_of(system, modes)
    _require_damped(grid)
    reaches = [_REACH[method], 1.5, 2.2] if modes is None else [1.0]
    while True:
        form = fibres(system, grid.still.theta, places, method)
        found = [
            _one_range(piece, form, rising[piece.part], rtol, run)
            for piece in ranges_of(system, grid, rising, rtol, reaches[0])
        ]
        changed = _ELSEWHERE * max(float(np.max(part.change)) for part in found)
        angles = 2 * len(grid.still.theta)
        if changed > rtol and len(reaches) > 1:
            reaches = reaches[1:]
        elif not all(part.resolved for part in found) and angles <= _MOST_ANGLES:
            grid = grid_of(system, modes, angles)
        else:
            break
    curve = _assembled(system, form, given, order, found, rtol)
    return _with_multipliers(curve, system, grid, found, run) if stability else curve


def _with_multipliers(
    curve: StressCurve, system: LinearPeriodic, grid: Grid, found: list[_Found], run: Run
) -> StressCurve:
    """Return a curve with its largest multipliers."""
    speeds, back = np.unique(curve.speed, return_inverse=True)
    sweep = MultiplierSweep(system, grid, [part.solved.condensed for part in found])
    growth = sweep.refined(sweep.growth(speeds, run), speeds)
    return replace(curve, multiplier=growth.modulus[back], multiplier_error=growth.error[back])


@dataclass(frozen=True)
class _Solved:
    """A range's reduced system, its balanced equation and the motions."""

    condensed: Condensed
    balance: Balance
    motions: Motions


@dataclass(frozen=True)
class _Found:
    """What one range gives: peaks ``(links, ns)``, errors, motions."""

    solved: _Solved
    peaks: Peaks
    error: Array
    change: Array
    resolved: bool
    speeds: Array
    table: Array


def _one_range(piece: Range, form: Fibres, speeds: Array, rtol: float, run: Run) -> _Found:
    """Return the largest stresses at the speeds of one range."""
    ends = (float(speeds[0]), float(speeds[-1]))
    harmonics = piece.harmonics
    while True:
        balance = piece.whole.truncated(harmonics)
        moving = motions(balance, speeds, _SHARE * rtol, run)
        left = float(np.max(last_harmonics(balance, moving.series)))
        if left <= _LAST * rtol or harmonics == piece.whole.harmonics:
            break
        harmonics = min(harmonics + max(8, harmonics // 4), piece.whole.harmonics)
    rows = stress_rows(form.form, piece.condensed, harmonics, ends, piece.rate)
    blocks = [slice(k, k + _TOGETHER) for k in range(0, len(speeds), _TOGETHER)]
    work = _Block(rows, balance, piece.condensed.period, form)
    parts = list(run(work, [(moving.series[:, b], speeds[b]) for b in blocks]))
    found = Peaks(
        np.concatenate([part.size for part in parts], axis=1),
        np.concatenate([part.theta for part in parts], axis=1),
        np.concatenate([part.row for part in parts], axis=1),
        np.concatenate([part.error for part in parts], axis=1),
    )
    solved = _Solved(piece.condensed, balance, moving)
    change = _changes(solved, form, rows, speeds, found)
    return _Found(
        solved,
        found,
        _errors(solved, found, change),
        change,
        left <= _LAST * rtol,
        speeds,
        rows.table,
    )


class _Block:
    """From motions at some speeds to their largest stresses."""

    def __init__(self, rows: StressRows, balance: Balance, period: float, form: Fibres) -> None:
        self.rows, self.balance, self.period, self.form = rows, balance, period, form

    def __call__(self, job: tuple[Array, Array]) -> Peaks:
        values = self.rows.values(self.balance, job[0], job[1], forced=True)
        return peaks(values, self.form.link, len(self.form.links), self.period)


def _changes(solved: _Solved, form: Fibres, rows: StressRows, speeds: Array, found: Peaks) -> Array:
    """Return relative changes of the maxima by the full equation at a few speeds, ``(k, links)``.

    At the highest speed, at the highest stress over the squared speed, and in each part of the
    speeds where a stress changes fastest with the speed.
    """
    last = len(speeds) - 1
    picked = {last}
    over = np.max(found.size, axis=0) / speeds**2
    picked.add(int(np.argmax(over)))
    if last > 1:
        gaps = np.maximum(np.diff(np.log(speeds)), _EQUAL)
        steep = np.max(np.abs(np.diff(np.log(found.size), axis=1)), axis=0) / gaps
        for part in np.array_split(np.arange(last), min(_PARTS, last)):
            picked.add(int(part[np.argmax(steep[part])]))
    changes = []
    for k in sorted(picked):
        before, after = corrected_peaks(
            form.form,
            solved.condensed,
            solved.balance,
            solved.motions.series[:, k],
            float(speeds[k]),
            table=rows.table,
            link=form.link,
        )
        own = np.abs(found.size[:, k] - after)
        changes.append(np.maximum(own, np.abs(before - after)) / after)
    return np.array(changes)


def _errors(solved: _Solved, found: Peaks, change: Array) -> Array:
    """Return the relative error of each maximum, ``(links, ns)``."""
    moving = solved.motions
    norm = np.linalg.norm(moving.series, axis=0)
    share = found.size / norm
    # A link that happens to be at rest is moved by an error as at its worst speed.
    weight = np.max(share, axis=1, keepdims=True) / share
    left = moving.error + last_harmonics(solved.balance, moving.series)
    largest = _ELSEWHERE * np.max(change, axis=0)
    return np.asarray(_MARGIN * weight * left + largest[:, None] + found.error)


def _linear_range(system: LinearPeriodic, found: list[_Found]) -> dict[str, Check]:
    """Return the check of the largest deflection over its link, where the motion is largest."""
    if system.relative_deflection is None:
        return {}
    largest = 0.0
    for part in found:
        solved, speeds = part.solved, part.speeds
        k = int(np.argmax(np.linalg.norm(solved.motions.series, axis=0)))
        x, speed = solved.motions.series[:, k], float(speeds[k])
        q = corrected_motion(solved.condensed, solved.balance, x, speed, part.table)[0]
        rows = system.relative_deflection(solved.condensed.theta)
        largest = max(largest, float(np.max(np.abs(np.einsum("tkn,tn->tk", rows, q)))))
    return {"linear range": Check(largest, LINEAR_RANGE)}


def _assembled(
    system: LinearPeriodic,
    form: Fibres,
    given: Array,
    order: NDArray[np.intp],
    found: list[_Found],
    rtol: float,
) -> StressCurve:
    back = np.argsort(order, kind="stable")

    def joined(parts: list[Any]) -> Any:
        return np.concatenate(parts, axis=-1).T[back]

    rows = joined([part.peaks.row for part in found])
    error = joined([part.error for part in found])
    counts = [part.peaks.size.shape[1] for part in found]
    modes = np.repeat([part.solved.balance.modes for part in found], counts)[back]
    harmonics = np.repeat([part.solved.balance.harmonics for part in found], counts)[back]
    changes = np.concatenate([part.change for part in found])
    return StressCurve(
        method="harmonic balance on moving modes, rational in the speed between nodes",
        error=error,
        error_norm="of each link's largest stress, relative",
        checks={
            "converged": Check(float(np.max(error)), rtol),
            "equation": Check(float(np.max(changes)), rtol),
            **_linear_range(system, found),
        },
        provenance=provenance(system.provenance),
        speed=given,
        links=form.links,
        maximum=joined([part.peaks.size for part in found]),
        theta=joined([part.peaks.theta for part in found]),
        place=form.place[rows],
        fibre=form.sign[rows],
        modes=modes,
        harmonics=harmonics,
        nodes=np.concatenate([part.solved.motions.nodes for part in found]),
    )


def _require_damped(grid: Grid) -> None:
    """Refuse a system whose resonances nothing bounds."""
    damping = [v for name in DAMPING for v in grid.arrays.get(name, {}).values()]
    if not any(np.any(values) for values in damping):
        found, fix = "a system without damping", "add some, with_modal_damping for example"
        raise bad("system", found, "damping, which bounds the resonances", fix)


def _checked(system: LinearPeriodic, speeds: ArrayLike, rtol: float, method: str) -> Array:
    """Return the speeds; refuse arguments that are unusable."""
    required_structure(system)
    given = np.atleast_1d(numbers("speeds", speeds))
    if given.ndim != 1 or not given.size or not np.all(np.isfinite(given) & (given > 0)):
        raise bad("speeds", speeds, "positive finite speeds [rad/s], one row", "correct them")
    if not (isinstance(rtol, Real) and 1e-6 <= rtol <= 1e-2):
        raise bad("rtol", repr(rtol), "a number from 1e-6 to 1e-2", "choose 1e-4")
    if method not in METHODS:
        raise bad("method", repr(method), f"one of {METHODS}", "choose 'equilibrium'")
    return given
