"""Perturbation boundaries along one axis of a chart, to any order, all rows at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...core.families import Array
from ...core.periodic_function import PeriodicFunction
from ...hill import HillForm, perturbation_boundaries

# More functions than this cost more together than row by row.
_MOST_FUNCTIONS = 2
# Steps towards the K that belongs to the lam2 of an end, and the change that ends them.
_STEPS, _SETTLED = 60, 1e-13

Ends = tuple[Array, Array, Array]
Solve = Callable[[int, Array], Ends]


def overlay_ends(
    form: HillForm, along: str, other: str, rows: Array, regions: tuple[int, ...], order: int
) -> Array:
    """Return lower ends, upper ends and errors in the units of the axis.

    Parameters
    ----------
    form : HillForm
        One mode.
    along, other : str
        The axis that the ends lie on, and the other one.
    rows : ndarray, shape (n,)
        Values of the other axis.
    regions : tuple of int
        Numbers from 0, along the speed from 1.
    order : int
        1 to 8.

    Returns
    -------
    ndarray, shape (3, len(regions), n)
        NaN where damping closes a region, where the orders do not converge, and at the end of one
        that reaches on to infinite speed.
    """
    points = [{} if other == "speed" else {other: float(v)} for v in rows]
    speed = rows if other == "speed" else np.ones_like(rows)
    stiffness = np.array([form.stiffness(**p) for p in points])
    damping = np.array([form.damping(**p) for p in points])
    solve = _solver(form, other, rows, order)
    out = np.full((3, len(regions), len(rows)), np.nan)
    for i, n in enumerate(regions):
        if along != "speed":
            found = np.stack(solve(n, damping / (2 * speed))) * speed**2
            out[:, i] = np.where(np.isfinite(found), found, np.nan)
            continue
        out[:, i] = _along_speed(solve, n, stiffness, damping)
    return out


def _along_speed(solve: Solve, n: int, stiffness: Array, damping: Array) -> Array:
    """Return the ends of one region in speed, where lam2 and K both depend on it.

    At crank speed w, lam2 = k / w^2 and K = c / (2 w) = r sqrt(lam2): an end is where the lam2
    that belongs to K gives that K again.
    """
    out = np.full((3, len(stiffness)), np.nan)
    usable = stiffness > 0.0
    ratio = np.where(usable, damping / (2 * np.sqrt(np.where(usable, stiffness, 1.0))), 0.0)
    sharp = solve(n, np.zeros_like(damping))
    for side in (0, 1):
        lam2, error, slow = np.array(sharp[side]), np.array(sharp[2]), np.zeros_like(ratio)
        if np.any(ratio > 0.0):
            lam2, error, slow = _settled(solve, n, ratio, lam2, side)
        with np.errstate(invalid="ignore", divide="ignore"):
            lam2 = np.where(usable & (lam2 > 0.0), lam2, np.nan)
            out[side] = np.sqrt(stiffness / lam2)
            spread = error / (1.0 - slow) * out[side] / (2 * lam2)
        out[2] = np.fmax(out[2], spread)
    return out


def _settled(solve: Solve, n: int, ratio: Array, start: Array, side: int) -> Ends:
    """Return lam2, its error and the rate of the steps; NaN where they do not settle."""
    lam2, change, slow = start, np.full_like(start, np.inf), np.zeros_like(start)
    error = np.full_like(start, np.nan)
    for _ in range(_STEPS):
        with np.errstate(invalid="ignore"):
            found = solve(n, np.where(lam2 > 0.0, ratio * np.sqrt(np.maximum(lam2, 0.0)), 0.0))
            new, error = np.where(lam2 > 0.0, found[side], np.nan), found[2]
            before, change = change, np.abs(new - lam2)
            rate = np.where(before > 0, change / before, 0.0)
            slow = np.where(np.isfinite(rate) & (change > 1e-11), rate, slow)
            lam2 = new
            if not np.any(change > _SETTLED * np.abs(lam2)):
                break
    with np.errstate(invalid="ignore"):
        settled = (change <= 1e-9 * np.abs(lam2)) & (slow < 0.9)
    return np.where(settled, lam2, np.nan), np.where(settled, error, np.nan), slow


def _solver(form: HillForm, other: str, rows: Array, order: int) -> Solve:
    """Return lower and upper ends in lam2 and their error, of all rows for one region and K."""
    functions, factors = _functions(form, other, rows)
    if len(functions) <= _MOST_FUNCTIONS:

        def together(n: int, damping: Array) -> Ends:
            found = perturbation_boundaries(functions, factors, (n,), order, damping)
            return found.lower[0], found.upper[0], found.error[0]

        return together
    single = [_total(functions, [f[j] for f in factors]) for j in range(len(rows))]

    def apart(n: int, damping: Array) -> Ends:
        found = [
            perturbation_boundaries(f, 1.0, (n,), order, float(k))
            for f, k in zip(single, damping, strict=True)
        ]
        ends = np.array([[r.lower[0], r.upper[0], r.error[0]] for r in found], dtype=float)
        return ends[:, 0], ends[:, 1], ends[:, 2]

    return apart


def _functions(
    form: HillForm, other: str, rows: Array
) -> tuple[list[PeriodicFunction], list[Array]]:
    """Return functions and factors, one for each row, whose sum is the periodic part.

    Parts that change in proportion are one function.
    """
    scales = form.system.scale_values(**({} if other == "speed" else {other: rows}))
    points = [{} if other == "speed" else {other: float(v)} for v in rows]
    mass = np.array([form.system.array("M", 0.0, **p)[0, 0, 0] for p in points])
    divisor = rows**2 if other == "speed" else np.ones_like(rows)
    functions: list[PeriodicFunction] = []
    factors: list[Array] = []
    for parts, over in ((form.inertial, np.ones_like(rows)), (form.elastic, divisor)):
        for scale, part in parts:
            value = 1.0 if scale is None else np.asarray(scales[scale], dtype=float)
            factor = np.broadcast_to(value, rows.shape) / (over * mass)
            size = float(np.max(np.abs(factor), initial=0.0))
            if size == 0.0:
                continue
            unit = factor / size
            for i, known in enumerate(factors):
                if np.max(np.abs(unit - known)) <= 1e-15:
                    functions[i] = functions[i] + part * size
                    break
            else:
                functions.append(part * size)
                factors.append(unit)
    if not functions:
        return [PeriodicFunction()], [np.zeros_like(rows)]
    return functions, factors


def _total(functions: Sequence[PeriodicFunction], factors: Sequence[float]) -> PeriodicFunction:
    total = PeriodicFunction()
    for function, factor in zip(functions, factors, strict=True):
        total = total + function * float(factor)
    return total
