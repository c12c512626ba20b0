"""Steady states on even intervals of Newmark's family, refined, with Richardson's estimate."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.results import Check
from ..core.trigonometric import even_angles
from ..integrators.newmark import StepRule, generalized_alpha_rule, newmark_rule, step_maps
from ..periodic.first_order import CanonicalForm
from ..periodic.ring import solve_ring
from ..simulation.second_order import even_count, second_order
from .request import Found, Request, number_option, peaks, resampled, whole_option, word_option

Array = NDArray[np.float64]

# From maps (N, m, m) and loads (N, m) of a period to the states at its N angles, their
# sensitivity, and what round-off makes of them over their peak.
Closing = Callable[[Array, Array], tuple[Array, float, float]]

_FIRST = 64
_MOST = 2**15
_MOST_FLOATS = 2**26
_EPS = float(np.finfo(float).eps)
# Margin of Richardson's estimate: coordinates do not all shrink alike.
_MARGIN = 2.5
# Error that intervals told by the caller may leave.
_FAIR = 1e-2


def rule_from(options: dict[str, object]) -> StepRule:
    """Return the scheme that options ask for; Newmark's with constant acceleration by default."""
    name = word_option(options, "scheme", "newmark", ("newmark", "generalized_alpha"))
    strange = {"rho_inf"} if name == "newmark" else {"gamma", "beta"}
    for key in sorted(strange & set(options)):
        raise bad(f"option {key}", repr(options[key]), f"none with {name}", "leave it out")
    if name == "generalized_alpha":
        return generalized_alpha_rule(number_option(options, "rho_inf", 0.9, 0.0, 1.0))
    gamma = number_option(options, "gamma", 0.5, 0.0, 2.0)
    return newmark_rule(gamma, number_option(options, "beta", 0.25, 0.0, 1.0))


def period_maps(form: CanonicalForm, rule: StepRule, intervals: int) -> tuple[Array, Array]:
    """Return the maps and loads of the intervals of a period, of a batch of one.

    Returns
    -------
    maps : ndarray
        Shape ``(N, m, m)`` on (q, q') or (q, q', a), ' = d/dtheta.
    loads : ndarray
        Shape ``(N, m)``.
    """
    _check_size(form, rule, intervals)
    every = -(-even_count(form.system) // intervals)
    found = second_order(form, every * intervals, every)
    arrays = [
        np.broadcast_to(a[0], (intervals, *a.shape[2:]))
        for a in (found.mass, found.rate, found.stiffness, found.force)
    ]
    mass, rate, stiffness, force = (np.concatenate([a, a[:1]]) for a in arrays)
    whole = step_maps(rule, mass, rate, stiffness, force, form.system.period / intervals)
    return whole[:, :-1, :-1], whole[:, :-1, -1]


def _check_size(form: CanonicalForm, rule: StepRule, intervals: int) -> None:
    size = (3 if rule.carries_acceleration else 2) * form.system.size
    if intervals * size**2 > _MOST_FLOATS:
        raise bad(
            "option intervals",
            f"{intervals} of {form.system.size} coordinates",
            f"at most {_MOST_FLOATS // size**2}",
            "lower them, or take method='harmonic_balance'",
        )


def stepped(request: Request, name: str, close: Closing) -> Found:
    """Return periodic motions of a scheme of Newmark's family, closed in one way or another.

    The error is Richardson's: of the change from half the intervals, a third, where the change
    before was four times as large; else more.
    """
    form = request.form
    rule = rule_from(dict(request.options))
    fixed = whole_option(request.options, "intervals", 8, _MOST)
    found = []
    for place in range(len(form.speed)):
        one = form.take(slice(place, place + 1))
        found.append(refined(one, rule, close, request.rtol, fixed))
        if request.tick is not None:
            request.tick(place + 1)
    return joined(request, f"{name}, {rule.words}", found)


Item = tuple[Array, Array, Array, Array, float, float]


def refined(
    form: CanonicalForm, rule: StepRule, close: Closing, rtol: float, fixed: int | None
) -> Item:
    """Return q, q', error, allowance, sensitivity and round-off of one motion."""
    n = form.system.size
    size = (3 if rule.carries_acceleration else 2) * n
    most = min(_MOST, 2 ** int(np.log2(_MOST_FLOATS / (2 * size**2))))
    first = _FIRST if fixed is None else fixed // 2
    states: list[Array] = []
    numbers: list[int] = []
    for intervals in (first // 2, first):
        states.append(close(*period_maps(form, rule, intervals))[0])
        numbers.append(intervals)
    while True:
        intervals = 2 * numbers[-1] if fixed is None else fixed
        nodes, sensitivity, rounding = close(*period_maps(form, rule, intervals))
        states, numbers = [*states[-2:], nodes], [*numbers[-2:], intervals]
        error = _richardson([s[:, :n] for s in states], numbers)
        total = error + rounding
        ended = bool(np.all(total <= rtol)) or not np.all(np.isfinite(nodes))
        # Where inverses have spoilt it, more of them spoil it more.
        ended |= bool(rounding > np.max(error))
        if ended or fixed is not None or 2 * intervals > most:
            allowed = np.full(n, rtol if fixed is None else max(rtol, _FAIR))
            return nodes[:, :n], nodes[:, n : 2 * n], total, allowed, sensitivity, rounding


def _richardson(motions: list[Array], numbers: list[int]) -> Array:
    """Return the error of the last of three motions, of each coordinate over its peak."""
    fine = motions[-1]
    if not all(np.all(np.isfinite(motion)) for motion in motions):
        return np.full(fine.shape[1], np.inf)
    size = peaks(fine)
    gaps = [
        np.max(np.abs(resampled(coarse, len(finer)) - finer), axis=0) / size
        for coarse, finer in itertools.pairwise(motions)
    ]
    gain = (numbers[-1] / numbers[-2]) ** 2
    # An order below 2 is believed, one above it is luck.
    with np.errstate(divide="ignore", invalid="ignore"):
        seen = np.where(gaps[1] > 0, np.max(gaps[0]) / np.max(gaps[1]), gain)
    shrunk = np.clip(seen, 1.25, gain)
    error: Array = _MARGIN * gaps[1] / (shrunk - 1.0) + 64 * _EPS
    return error


def joined(
    request: Request, name: str, found: list[Item], cycles: NDArray[np.int64] | None = None
) -> Found:
    """Return the motions of a batch on one grid; NaN where round-off has spoilt one."""
    form = request.form
    nt = max(len(item[0]) for item in found)
    q = np.stack([resampled(item[0], nt) for item in found])
    slope = np.stack([resampled(item[1], nt) for item in found])
    error, allowed = (np.stack([item[k] for item in found]) for k in (2, 3))
    sensitivity, rounding = (np.array([item[k] for item in found]) for k in (4, 5))
    doubt = _EPS * np.where(np.isfinite(sensitivity), sensitivity, 1 / _EPS)
    spoilt = ~(rounding < 0.1) | ~np.all(np.isfinite(q), axis=(1, 2)) | (16 * doubt >= 1.0)
    q[spoilt], slope[spoilt], error[spoilt] = np.nan, np.nan, np.inf
    worst = float(np.max(np.where(np.isfinite(rounding), rounding, np.inf)))
    checks = {
        "single": Check(16 * float(np.max(doubt)), 1.0),
        "round-off": Check(worst, 1e-3),
    }
    theta = even_angles(form.system.period, nt)
    return Found(name, theta, q, slope, error, allowed, sensitivity, checks, cycles=cycles)


def ring_closing(maps: Array, loads: Array) -> tuple[Array, float, float]:
    """Close the period by orthogonal elimination of the cyclic system (6.22)."""
    nodes, sensitivity = solve_ring(maps[None], loads[None])
    found = float(sensitivity[0])
    return nodes[0], found, _EPS * np.sqrt(len(maps)) * min(found, 1 / _EPS)
