"""Steady states by marching from a start until the motion repeats: method ``time_marching``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.inputs import numbers
from ..core.results import Check
from ..integrators.newmark import StepRule, acceleration
from ..periodic.first_order import CanonicalForm
from ..simulation.second_order import even_count, second_order
from .request import Found, Request, number_option, peaks, whole_option
from .stepped import Item, joined, period_maps, refined, ring_closing, rule_from

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_MOST = 2**15


def by_marching(request: Request) -> Found:
    """Return the motions that marches settle to, revolution after revolution."""
    form, options = request.form, dict(request.options)
    rule = rule_from(options)
    tolerance = number_option(options, "tolerance", 1e-4, 1e-12, 0.1)
    most = whole_option(options, "most_cycles", 1, 10**6) or 1000
    fixed = whole_option(options, "intervals", 8, _MOST)
    start = start_from(form, options.get("initial"))
    items: list[Item] = []
    cycles = np.full(len(form.speed), -1, dtype=np.int64)
    growth, left = np.zeros((2, len(form.speed)))
    for place in range(len(form.speed)):
        one = form.take(slice(place, place + 1))
        item = refined(one, rule, ring_closing, request.rtol, fixed)
        run = Marching(one, rule, len(item[0]))
        first = np.array([start[0], start[1] / form.speed[place]])
        growth[place] = run.growth
        motion, cycles[place], left[place] = run.settled(first, tolerance, most)
        items.append(_settled(item, motion, cycles[place] >= 0))
        if request.tick is not None:
            request.tick(place + 1)
    name = f"time marching to a change of {tolerance:.3g} in a period, {rule.words}"
    found = joined(request, name, items, cycles)
    checks = {
        **found.checks,
        "growth": Check(float(np.max(growth)), 1.0),
        "settled": Check(float(np.max(left)) / tolerance, 1.0),
    }
    return replace(found, checks=checks)


def _settled(item: Item, motion: tuple[Array, Array], ended: bool) -> Item:
    """Return the marched motion with what is left of its start added to the error."""
    exact, _, error, allowed, sensitivity, rounding = item
    q, slope = motion
    if not ended:
        return np.full_like(q, np.nan), slope, error, allowed, sensitivity, rounding
    gap = np.max(np.abs(q - exact), axis=0)
    total = error + gap / peaks(exact)
    return q, slope, total, allowed, sensitivity, rounding


def start_from(form: CanonicalForm, given: object) -> tuple[Array, Array]:
    """Return q and qd to march from; rest where none is given.

    Raises
    ------
    BadInput
        If it is not a pair of finite numbers, one for each coordinate.
    """
    n = form.system.size
    if given is None:
        return np.zeros(n), np.zeros(n)
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise bad("option initial", repr(given), "a pair (q, qd)", "give both")
    parts = []
    for name, part in zip(("q", "qd"), given, strict=True):
        value: ArrayLike = part
        values = numbers(f"initial {name}", value)
        if values.shape not in ((), (n,)) or not np.all(np.isfinite(values)):
            raise bad(f"initial {name}", repr(part), f"{n} finite numbers", "correct it")
        parts.append(np.broadcast_to(values, (n,)))
    return parts[0], parts[1]


class Marching:
    """A march through the periods of one system, its steps made once.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    rule : StepRule
        The scheme.
    intervals : int
        Steps in a period.
    """

    def __init__(self, form: CanonicalForm, rule: StepRule, intervals: int) -> None:
        maps, loads = period_maps(form, rule, intervals)
        m = loads.shape[1]
        self._size = form.system.size
        self._flows = np.empty((intervals, m, m + 1))
        flow = np.concatenate([np.eye(m), np.zeros((m, 1))], axis=1)
        with np.errstate(over="ignore", invalid="ignore"):
            for k, (matrix, load) in enumerate(zip(maps, loads, strict=True)):
                flow = matrix @ flow
                flow[:, -1] += load
                self._flows[k] = flow
        self.multipliers = (
            np.linalg.eigvals(flow[:, :-1])
            if np.all(np.isfinite(flow))
            else np.full(m, np.inf + 0j)
        )
        self._first = self._start_acceleration(form, intervals) if m > 2 * self._size else None

    @staticmethod
    def _start_acceleration(form: CanonicalForm, intervals: int) -> Array:
        every = -(-even_count(form.system) // intervals)
        found = second_order(form, every * intervals, every)
        arrays = (found.mass[0, 0], found.rate[0, 0], found.stiffness[0, 0], found.force[0, 0])
        return acceleration(*arrays)

    @property
    def growth(self) -> float:
        """Factor per period of what is left of a start, the largest modulus of a multiplier."""
        return float(np.max(np.abs(self.multipliers)))

    def settled(
        self, start: Array, tolerance: float, most: int
    ) -> tuple[tuple[Array, Array], int, float]:
        """March until a period repeats the one before.

        Parameters
        ----------
        start : ndarray
            q and q' at the first angle, shape ``(2, n)``.
        tolerance : float
            Largest change of a coordinate at an angle from one period to the next, over its peak.
        most : int
            Most periods.

        Returns
        -------
        motion : tuple of ndarray
            q and q' over the last period, shape ``(N, n)`` each.
        cycles : int
            Periods marched, the last one included; -1 where the march has not settled.
        change : float
            The change in the last period.
        """
        n = self._size
        state = start.ravel()
        if self._first is not None:
            state = np.concatenate([state, self._first @ np.append(state, 1.0)])
        before = np.zeros((len(self._flows), n))
        change = np.inf
        for cycle in range(1, most + 1):
            with np.errstate(over="ignore", invalid="ignore"):
                ends = self._flows[..., :-1] @ state + self._flows[..., -1]
            now = np.concatenate([state[None], ends[:-1]])
            if not np.all(np.isfinite(ends)) or np.max(np.abs(ends)) > 1e150:
                return (now[:, :n], now[:, n : 2 * n]), -1, np.inf
            change = float(np.max(np.abs(now[:, :n] - before) / peaks(now[:, :n])))
            if cycle > 1 and change <= tolerance and self.growth < 1.0:
                return (now[:, :n], now[:, n : 2 * n]), cycle, change
            before, state = now[:, :n], ends[-1]
        return (now[:, :n], now[:, n : 2 * n]), -1, change


def cycles_to_settle(
    multiplier: ArrayLike, tolerance: float, *, norm: str = "change"
) -> NDArray[np.int64]:
    """Return how many periods a march from rest takes, by the slowest multiplier alone.

    After k periods the motion from rest is ``y_s - rho^k y_s`` where y_s lies along the mode of
    the multiplier rho; what else the start holds has died away before.

    Parameters
    ----------
    multiplier : array_like of complex
        The Floquet multiplier nearest to the unit circle.
    tolerance : float
        Where it has settled, over the size of the motion.
    norm : str
        ``"change"``: of the last period from the one before, ``abs(1 - rho) abs(rho)^(k - 2)``.
        ``"remaining"``: the rest of the start in the last period, ``abs(rho)^(k - 1)``.

    Returns
    -------
    ndarray of int
        Periods, the last one included; -1 where the motion does not settle.

    Raises
    ------
    BadInput
        If the tolerance is not between 0 and 1, or the norm is unknown.
    """
    if not 0.0 < tolerance < 1.0:
        raise bad("tolerance", tolerance, "a number between 0 and 1", "choose 1e-4")
    if norm not in ("change", "remaining"):
        raise bad("norm", repr(norm), "'change' or 'remaining'", "choose 'change'")
    rho = np.asarray(multiplier, dtype=complex)
    size = np.abs(rho)
    first = np.abs(1.0 - rho) if norm == "change" else np.ones_like(size)
    with np.errstate(divide="ignore", invalid="ignore"):
        before = 2.0 if norm == "change" else 1.0
        needed = before + np.log(tolerance / np.maximum(first, 1e-300)) / np.log(size)
    # The change of a first period from none is no change.
    least = 2.0 if norm == "change" else 1.0
    whole = np.ceil(np.where(size > 0.0, np.maximum(needed, least), least))
    return np.where(size < 1.0, whole, -1.0).astype(np.int64)
