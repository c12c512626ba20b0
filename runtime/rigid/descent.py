"""Local optimum of a weighted sum of peaks in the design variables, polished to full precision.

The epigraph form: minimise ``cost . t`` subject to ``|F_k(theta_j; p(x))|^2 <= t_k^2``.  SciPy's
SLSQP finds the active forces, Newton's method on the conditions of Karush, Kuhn and Tucker then
makes the last digits right.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .barrier import Array, PeakProblem
from .designs import Design

Indices = NDArray[np.intp]

_ACTIVE = 1e-7
_STEPS = 12
_LONGEST_STEP = 1e-3  # a longer one has left the active set


@dataclass(frozen=True)
class Descent:
    """A local optimum: variables, bounds t, value, KKT residual, and the lower bound it proves."""

    x: Array
    t: Array
    value: float
    residual: float
    bound: float


def local_minimum(problem: PeakProblem, design: Design, start: Array) -> Descent:
    """Return the local optimum that SLSQP and Newton's method reach from a start.

    Parameters
    ----------
    problem : PeakProblem
        Forces, costs and ceilings; its rooms serve the lower bound alone, for the design has
        bounds of its own.
    design : Design
        Map from variables to parameters.
    start : ndarray
        Variables within the box.
    """
    from scipy import optimize

    frame = _Frame(problem, design)
    t0 = np.minimum(problem.lifted(design.parameters(start), 0.0), problem.ceilings)
    z0 = np.concatenate([start, t0])
    constraints: list[Any] = [
        {
            "type": "ineq",
            "fun": lambda z: frame.slacks(z)[0],
            "jac": lambda z: frame.slacks(z)[1],
        }
    ]
    if len(frame.equations(z0)):
        constraints.append({"type": "eq", "fun": frame.equations, "jac": frame.equation_slopes})
    minimize: Any = optimize.minimize
    found = minimize(
        lambda z: float(frame.cost @ z),
        z0,
        jac=lambda z: frame.cost,
        bounds=frame.box,
        constraints=constraints,
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 300},
    )
    low, high = frame.ends
    # SLSQP may break down where constraints are all but dependent: its start then stays.
    reached = found.x if np.all(np.isfinite(found.x)) else z0
    z = _polished(frame, np.clip(reached, low, high))
    x = np.clip(z[: frame.n], low[: frame.n], high[: frame.n])
    t = problem.lifted(design.parameters(x), 0.0)
    z = np.concatenate([x, t])
    residual = frame.residual(z)
    # Without rooms nothing is known of what other designs could do.
    bound = frame.lower_bound(z) if problem.rooms else -np.inf
    return Descent(x, t, float(problem.cost @ t), residual, bound)


class _Frame:
    """Constraints of the epigraph form in z = (x, t), with their derivatives."""

    def __init__(self, problem: PeakProblem, design: Design) -> None:
        self.problem, self.design = problem, design
        low, high = design.box
        self.n = len(low)
        self.cost = np.concatenate([np.zeros(self.n), problem.cost])
        tops = [None if np.isinf(c) else float(c) for c in problem.ceilings]
        self.box: list[Any] = [*zip(low.tolist(), high.tolist(), strict=True)]
        self.box += [(0.0, top) for top in tops]
        self._key, self._kept = b"", (np.zeros(0), np.zeros((0, 0)))

    @property
    def ends(self) -> tuple[Array, Array]:
        """Return lower and upper ends of z, ``inf`` where there is none."""
        low = [end[0] for end in self.box]
        return np.array(low), np.array([np.inf if end[1] is None else end[1] for end in self.box])

    def slacks(self, z: Array) -> tuple[Array, Array]:
        """Return t^2 - |F|^2 of every force, and the design's conditions; with Jacobian.

        The last ones are kept: SLSQP asks for values and Jacobian one after the other.
        """
        key = z.tobytes()
        if self._key != key:
            self._key, self._kept = key, self._fresh_slacks(z)
        return self._kept

    def _fresh_slacks(self, z: Array) -> tuple[Array, Array]:
        x, t = z[: self.n], z[self.n :]
        p, slope = self.design.parameters(x), self.design.jacobian(x)
        values, rows = [], []
        for cone in self.problem.cones:
            force = cone.values(p)
            values.append(t[cone.bound] ** 2 - np.sum(force * force, axis=1))
            row = np.zeros((len(force), len(z)))
            row[:, : self.n] = -2.0 * np.einsum("nd,ndp->np", force, cone.basis) @ slope
            row[:, self.n + cone.bound] = 2.0 * t[cone.bound]
            rows.append(row)
        own, own_slope, _ = self.design.conditions(x)
        if len(own):
            values.append(own)
            rows.append(np.pad(own_slope, ((0, 0), (0, len(t)))))
        return np.concatenate(values), np.concatenate(rows)

    def equations(self, z: Array) -> Array:
        """Return the design's equations."""
        return self.design.equations(z[: self.n])[0]

    def equation_slopes(self, z: Array) -> Array:
        """Return their Jacobian."""
        return np.pad(self.design.equations(z[: self.n])[1], ((0, 0), (0, len(z) - self.n)))

    def active(self, z: Array) -> tuple[Indices, Array, Array]:
        """Return the active constraints: indices, values (zero where met), Jacobian.

        Counted through: slacks, equations, lower ends, upper ends.
        """
        slack, slope = self.slacks(z)
        equal, equal_slope = self.equations(z), self.equation_slopes(z)
        low, high = self.ends
        unit = np.eye(len(z))
        values = np.concatenate([slack, equal, z - low, high - z])
        slopes = np.concatenate([slope, equal_slope, unit, -unit])
        chosen = np.abs(values) <= _ACTIVE
        chosen[len(slack) : len(slack) + len(equal)] = True
        which = np.flatnonzero(chosen)
        return which, values[which], slopes[which]

    def multipliers(self, z: Array) -> tuple[Indices, Array, Array, Array]:
        """Return active constraints with their multipliers, zero or more but for equations."""
        from scipy.optimize import nnls

        which, values, slopes = self.active(z)
        count = len(self.slacks(z)[0])
        free = (which >= count) & (which < count + len(self.equations(z)))
        columns = np.concatenate([slopes, -slopes[free]])
        if not len(columns):
            return which, values, slopes, np.zeros(0)
        found, _ = nnls(columns.T, self.cost)
        prices = found[: len(which)].copy()
        prices[free] -= found[len(which) :]
        return which, values, slopes, prices

    def residual(self, z: Array) -> float:
        """Return the residual of the KKT conditions: stationarity over the cost, and equations."""
        _, values, slopes, prices = self.multipliers(z)
        rest = self.cost - (prices @ slopes if len(prices) else 0.0)
        gap = np.max(np.abs(values[prices != 0.0]), initial=0.0)
        return float(max(np.max(np.abs(rest)) / np.max(np.abs(self.cost)), gap))

    def lower_bound(self, z: Array) -> float:
        """Return what the multipliers at z prove that no counterweight can undercut."""
        which, _, _, prices = self.multipliers(z)
        full = np.zeros(len(self.slacks(z)[0]) + len(self.equations(z)) + 2 * len(z))
        full[which] = prices
        p = self.design.parameters(z[: self.n])
        pulls, place = [], 0
        for cone in self.problem.cones:
            own = full[place : place + len(cone.fixed)]
            pulls.append(2.0 * own[:, None] * cone.values(p))
            place += len(cone.fixed)
        return self.problem.lower_bound(pulls, full[len(full) - len(z) + self.n :])

    def curvature(self, z: Array, which: Indices, prices: Array) -> Array:
        """Return the Hessian of the Lagrangian."""
        x = z[: self.n]
        p, slope = self.design.parameters(x), self.design.jacobian(x)
        total = np.zeros((len(z), len(z)))
        weights = dict(zip(which.tolist(), prices.tolist(), strict=True))
        place = 0
        for cone in self.problem.cones:
            for j in range(len(cone.fixed)):
                price = weights.get(place + j, 0.0)
                if price == 0.0:
                    continue
                force = cone.fixed[j] + cone.basis[j] @ p
                moved = cone.basis[j] @ slope
                total[: self.n, : self.n] += 2.0 * price * moved.T @ moved
                total[: self.n, : self.n] += price * self.design.curvature(
                    x, 2.0 * force @ cone.basis[j]
                )
                total[self.n + cone.bound, self.n + cone.bound] -= 2.0 * price
            place += len(cone.fixed)
        for group in (self.design.conditions(x), self.design.equations(x)):
            for bend in group[2]:
                total[: self.n, : self.n] -= weights.get(place, 0.0) * bend
                place += 1
        return total


def _polished(frame: _Frame, z: Array) -> Array:
    """Return the best point that Newton steps on the KKT conditions reach from z."""
    best, least = z, frame.residual(z)
    for _ in range(_STEPS):
        which, values, slopes, prices = frame.multipliers(z)
        used = prices != 0.0
        which, values, slopes, prices = which[used], values[used], slopes[used], prices[used]
        n, m = len(z), len(which)
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n] = frame.curvature(z, which, prices)
        matrix[:n, n:], matrix[n:, :n] = -slopes.T, slopes
        right = np.concatenate([prices @ slopes - frame.cost, -values])
        step = np.linalg.lstsq(matrix, right, rcond=1e-13)[0][:n]
        if not np.max(np.abs(step)) < _LONGEST_STEP:
            break
        z = z + step
        residual = frame.residual(z)
        if np.min(frame.slacks(z)[0], initial=0.0) < -_ACTIVE or residual > 1e3 * least + 1e-9:
            break
        if residual <= least:
            best, least = z, residual
    return best
