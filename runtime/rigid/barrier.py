"""Least weighted sum of peaks as a convex problem: barrier method, and a proved lower bound.

Every force is linear in what a counterweight adds to its link, ``p = (m, m u, m v, m (u^2 + v^2) +
own inertia)``, so that the peak of its magnitude over the crank angle is convex in p.  The
counterweights themselves form no convex set, for the last entry is a product; their convex hull is
a box with a second-order cone.  The least sum over the hull is found by Newton's method on a
logarithmic barrier; weak duality then proves how low any counterweight can come.

All quantities are scaled: per link, masses by the greatest mass, lengths by the greatest offset.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PER_LINK = 4  # mass, two first moments, inertia
_NEWTON_STEPS = 200
_GROWTH = 4.0
_ZERO = 1e-9
_SHRINK = 0.3  # of a slack in one step, at most
_CENTRED = 1e-5  # Newton decrement squared: the gap is then the centre's within 1 %


@dataclass(frozen=True)
class Room:
    """Where a link's counterweight may be, in scaled lengths: greatest mass and offset are 1.

    Attributes
    ----------
    nearest : float
        Least offset, from 0 to 1.
    stiffness : float
        Own inertia over mass squared: ``1/(2 pi h rho)`` of a cylinder, scaled; 0 for a point.
    own : float
        Greatest own inertia over mass of a disc with free radius: half its square.
    """

    nearest: float = 0.0
    stiffness: float = 0.0
    own: float = 0.0

    @property
    def rigid(self) -> bool:
        """True where the inertia follows from the mass alone: points at one offset."""
        return self.nearest >= 1.0 and self.stiffness == 0.0 and self.own == 0.0

    @property
    def slope(self) -> float:
        """Greatest inertia over mass in the convex hull."""
        return 1.0 + self.stiffness + self.own

    def least(self, gradient: Array) -> float:
        """Return the least of ``gradient . p`` over the counterweights themselves."""
        g_mass, g_along, g_across, g_inertia = (float(g) for g in gradient)
        pull = float(np.hypot(g_along, g_across))
        offsets = [self.nearest, 1.0]
        if g_inertia > 0.0:
            offsets.append(min(max(pull / (2.0 * g_inertia), self.nearest), 1.0))
        linear = g_mass + min((g_inertia * r - pull) * r for r in offsets)
        linear += min(g_inertia, 0.0) * self.own
        square = g_inertia * self.stiffness
        masses = [0.0, 1.0]
        if square > 0.0:
            masses.append(min(max(-linear / (2.0 * square), 0.0), 1.0))
        return min((linear + square * m) * m for m in masses)


@dataclass(frozen=True)
class Cones:
    """``|fixed + basis p| <= t[bound]`` at a number of angles: one force, or several that share t.

    Attributes
    ----------
    bound : int
        Which of the bounds t.
    fixed : ndarray (n, d)
        Force without counterweights at n angles, d components.
    basis : ndarray (n, d, 4 links)
        Force of each unit parameter.
    """

    bound: int
    fixed: Array
    basis: Array

    def values(self, p: Array) -> Array:
        """Return the force (n, d) with the parameters p."""
        return np.asarray(self.fixed + self.basis @ p)

    def joined(self, fixed: Array, basis: Array) -> Cones:
        """Return the same with more angles."""
        both = np.concatenate
        return replace(self, fixed=both([self.fixed, fixed]), basis=both([self.basis, basis]))


@dataclass(frozen=True)
class PeakProblem:
    """Minimise ``cost . t`` over the hulls of all links and bounds t of all peaks.

    Attributes
    ----------
    rooms : sequence of Room
        One per link.
    cones : sequence of Cones
        The forces.
    cost : ndarray
        Weight of each bound t.
    ceilings : ndarray
        Greatest t that is allowed, ``inf`` where free.
    """

    rooms: Sequence[Room]
    cones: Sequence[Cones]
    cost: Array
    ceilings: Array

    @property
    def count(self) -> int:
        """Number of parameters p."""
        return PER_LINK * len(self.rooms)

    def lifted(self, p: Array, margin: float) -> Array:
        """Return bounds t above every force with p, by a relative margin."""
        t = np.zeros(len(self.cost))
        for cone in self.cones:
            peak = np.max(np.linalg.norm(cone.values(p), axis=1))
            t[cone.bound] = max(t[cone.bound], float(peak))
        return (1.0 + margin) * t + 1e-12 * margin

    def centre(self) -> Array:
        """Return parameters well inside every hull: no first moment, half the mass."""
        p = []
        for room in self.rooms:
            least = max(room.nearest**2, 0.0) * 0.5 + room.stiffness * 0.25
            p += [0.5, 0.0, 0.0, 0.5 if room.rigid else 0.5 * (least + 0.5 * room.slope)]
        return np.array(p)

    def lower_bound(self, pulls: Sequence[Array], ceiling_prices: Array) -> float:
        """Return what no counterweight can undercut, whatever the multipliers are.

        Parameters
        ----------
        pulls : sequence of ndarray (n, d)
            Multipliers of the forces of each of the cones; scaled down where they exceed
            what cost and ceiling prices allow.
        ceiling_prices : ndarray
            Multipliers of the ceilings, zero or more.
        """
        prices = np.where(np.isfinite(self.ceilings), np.maximum(ceiling_prices, 0.0), 0.0)
        allowed = self.cost + prices
        spent = np.zeros(len(self.cost))
        for cone, pull in zip(self.cones, pulls, strict=True):
            spent[cone.bound] += float(np.sum(np.linalg.norm(pull, axis=1)))
        scale = np.minimum(1.0, allowed / np.maximum(spent, np.finfo(float).tiny))
        constant = -float(np.sum(prices[prices > 0] * self.ceilings[prices > 0]))
        gradient = np.zeros(self.count)
        for cone, pull in zip(self.cones, pulls, strict=True):
            fair = scale[cone.bound] * pull
            constant += float(np.sum(fair * cone.fixed))
            gradient += np.einsum("nd,ndp->p", fair, cone.basis)
        return constant + least_over(self.rooms, gradient)


def least_over(rooms: Sequence[Room], gradient: Array) -> float:
    """Return the least of ``gradient . p`` over the counterweights of all links."""
    return sum(
        room.least(gradient[PER_LINK * i : PER_LINK * (i + 1)]) for i, room in enumerate(rooms)
    )


@dataclass(frozen=True)
class HullOptimum:
    """Optimum over the hull: parameters, bounds, and a value that is proved to be a lower bound."""

    p: Array
    t: Array
    value: float
    bound: float


def hull_minimum(
    problem: PeakProblem, start: tuple[Array, Array] | None = None, tolerance: float = 1e-7
) -> HullOptimum:
    """Return the optimum over the convex hull by a logarithmic barrier.

    Parameters
    ----------
    problem : PeakProblem
        What to minimise.
    start : tuple of ndarray, optional
        Parameters and bounds strictly inside; needed where there are ceilings.
    tolerance : float
        Wanted gap between the value and the lower bound, over the value.  Round-off keeps it
        above 1e-8 or so; the multipliers of a polished optimum close it further.
    """
    barrier = _Barrier(problem)
    p, t = start or (problem.centre(), problem.lifted(problem.centre(), 0.5))
    z = barrier.free(p, t)
    value = float(problem.cost @ t)
    # One parameter of the barrier for each unit of its degree: the gap is degree / price.
    price = barrier.degree / max(value, np.finfo(float).tiny)
    # A sum that can be brought to zero is never near its bound relative to itself.
    floor = _ZERO * value
    best = HullOptimum(p, t, value, -np.inf)
    while True:
        z = barrier.centred(z, price)
        p, t = barrier.parts(z)
        pulls, ceiling_prices = barrier.multipliers(z, price)
        bound = max(best.bound, problem.lower_bound(pulls, ceiling_prices))
        value = float(problem.cost @ t)
        best = HullOptimum(p, t, value, bound)
        wanted = max(tolerance * value, floor)
        if value - bound <= wanted or barrier.degree / price <= wanted:
            return best
        price *= _GROWTH


class _Barrier:
    """The barrier of a problem, its gradient and Hessian, in the free variables."""

    def __init__(self, problem: PeakProblem) -> None:
        self.problem = problem
        n, nt = problem.count, len(problem.cost)
        # z holds the free parameters, then t; the inertia of a rigid room is its mass.
        columns = []
        for link, room in enumerate(problem.rooms):
            for entry in range(PER_LINK - (1 if room.rigid else 0)):
                column = np.zeros(n)
                column[PER_LINK * link + entry] = 1.0
                if room.rigid and entry == 0:
                    column[PER_LINK * link + 3] = 1.0
                columns.append(column)
        self.spread = np.array(columns).T.reshape(n, len(columns))
        self.size = len(columns)
        self.cost = np.concatenate([np.zeros(self.size), problem.cost])
        self.bases = [cone.basis @ self.spread for cone in problem.cones]
        self.capped = np.flatnonzero(np.isfinite(problem.ceilings))
        self.degree = float(
            sum(2 * len(cone.fixed) for cone in problem.cones)
            + 6 * len(problem.rooms)
            + len(self.capped)
        )
        self.total = self.size + nt

    def free(self, p: Array, t: Array) -> Array:
        """Return the free variables of parameters and bounds."""
        kept = self.spread != 0.0
        first = np.argmax(kept, axis=0)
        return np.concatenate([p[first], t])

    def parts(self, z: Array) -> tuple[Array, Array]:
        """Return parameters and bounds."""
        return self.spread @ z[: self.size], z[self.size :]

    def multipliers(self, z: Array, price: float) -> tuple[list[Array], Array]:
        """Return the multipliers that the central path offers."""
        t = z[self.size :]
        pulls = []
        for cone, basis in zip(self.problem.cones, self.bases, strict=True):
            force = cone.fixed + basis @ z[: self.size]
            slack = t[cone.bound] ** 2 - np.sum(force * force, axis=1)
            pulls.append(2.0 * force / (price * slack[:, None]))
        prices = np.zeros(len(t))
        prices[self.capped] = 1.0 / (price * (self.problem.ceilings - t)[self.capped])
        return pulls, prices

    def centred(self, z: Array, price: float) -> Array:
        """Return the point of the central path for a price, by damped Newton steps."""
        slacks = self.slacks(z)
        for _ in range(_NEWTON_STEPS):
            gradient, hessian = self.derivatives(z, price)
            scale = 1.0 / np.sqrt(np.diag(hessian))
            scaled = scale[:, None] * hessian * scale
            step = -scale * np.linalg.lstsq(scaled, scale * gradient, rcond=1e-15)[0]
            decrement = float(-gradient @ step)
            if not decrement > _CENTRED:
                return z
            length = 1.0
            while length > 1e-12:
                trial = z + length * step
                ahead = self.slacks(trial)
                # A slack that all but vanishes would take many steps to come back.
                if np.all(ahead > _SHRINK * slacks):
                    fall = np.sum(np.log(ahead / slacks)) - price * length * (self.cost @ step)
                    if fall > 0.1 * length * decrement or decrement < 0.05:
                        break
                length *= 0.5
            else:
                return z
            z, slacks = trial, ahead
        return z

    def slacks(self, z: Array) -> Array:
        """Return every slack that has a logarithm in the barrier: all positive inside."""
        p, t = self.parts(z)
        found = [(self.problem.ceilings - t)[self.capped]]
        for cone, basis in zip(self.problem.cones, self.bases, strict=True):
            force = cone.fixed + basis @ z[: self.size]
            size = np.sqrt(np.sum(force * force, axis=1))
            found.append((t[cone.bound] - size) * abs(t[cone.bound] + size))
        for link, room in enumerate(self.problem.rooms):
            found.append(_room_slacks(room, p[PER_LINK * link : PER_LINK * (link + 1)]))
        return np.concatenate(found)

    def derivatives(self, z: Array, price: float) -> tuple[Array, Array]:
        """Return gradient and Hessian of cost and barrier."""
        p, t = self.parts(z)
        gradient = price * self.cost
        hessian = np.zeros((self.total, self.total))
        n = self.size
        for cone, basis in zip(self.problem.cones, self.bases, strict=True):
            k = n + cone.bound
            force = cone.fixed + basis @ z[:n]
            size = np.sqrt(np.sum(force * force, axis=1))
            slack = (t[cone.bound] - size) * (t[cone.bound] + size)
            # slack = t^2 - |F|^2: its gradient has -2 F.dF and 2 t
            towards = -2.0 * np.einsum("nd,ndp->np", force, basis)
            whole = np.concatenate([towards, np.full((len(slack), 1), 2.0 * t[cone.bound])], axis=1)
            scaled = whole / slack[:, None]
            which = np.append(np.arange(n), k)
            gradient[which] -= scaled.sum(axis=0)
            hessian[np.ix_(which, which)] += scaled.T @ scaled
            flat = (basis / np.sqrt(slack)[:, None, None]).reshape(-1, n)
            hessian[:n, :n] += 2.0 * flat.T @ flat
            hessian[k, k] -= 2.0 * np.sum(1.0 / slack)
        for k in self.capped.tolist():
            slack_t = self.problem.ceilings[k] - t[k]
            gradient[n + k] += 1.0 / slack_t
            hessian[n + k, n + k] += 1.0 / slack_t**2
        for link, room in enumerate(self.problem.rooms):
            rows = slice(PER_LINK * link, PER_LINK * (link + 1))
            own_gradient, own_hessian = _room_derivatives(room, p[rows])
            part = self.spread[rows]
            gradient[:n] += part.T @ own_gradient
            hessian[:n, :n] += part.T @ own_hessian @ part
        return gradient, hessian


def _room_slacks(room: Room, p: Array) -> Array:
    """Return the slacks of a link's hull, all positive inside."""
    m, a, b, j = (float(x) for x in p)
    # Outside, where the mass is negative, the first slack already says so.
    square = (a * a + b * b) / m if m > 0.0 else 0.0
    slacks = [m, 1.0 - m]
    if room.rigid:
        return np.array([*slacks, m - square])
    slacks += [j - room.stiffness * m * m - square, room.slope * m - j]
    if room.nearest > 0.0:
        slacks.append(j - room.nearest**2 * m - room.stiffness * m * m)
    return np.array(slacks)


def _room_derivatives(room: Room, p: Array) -> tuple[Array, Array]:
    """Return gradient and Hessian of minus the sum of the logarithms of the slacks."""
    m, a, b, _ = (float(x) for x in p)
    square = (a * a + b * b) / m
    bend = np.zeros((PER_LINK, PER_LINK))
    bend[:3, :3] = np.array([[-square, a, b], [a, -m, 0.0], [b, 0.0, -m]]) * (2.0 / (m * m))
    lean = np.array([square / m, -2.0 * a / m, -2.0 * b / m, 0.0])
    unit = np.eye(PER_LINK)
    none = np.zeros((PER_LINK, PER_LINK))
    c, flat = room.stiffness, np.diag([-2.0 * room.stiffness, 0.0, 0.0, 0.0])
    slacks = _room_slacks(room, p)
    terms = [(unit[0], none), (-unit[0], none)]
    if room.rigid:
        terms.append((lean + unit[0], bend))
    else:
        terms.append((lean + unit[3] - 2.0 * c * m * unit[0], bend + flat))
        terms.append((room.slope * unit[0] - unit[3], none))
        if room.nearest > 0.0:
            terms.append((unit[3] - (room.nearest**2 + 2.0 * c * m) * unit[0], flat))
    gradient, hessian = np.zeros(PER_LINK), np.zeros((PER_LINK, PER_LINK))
    for slack, (first, second) in zip(slacks, terms, strict=True):
        gradient -= first / slack
        hessian += np.outer(first, first) / slack**2 - second / slack
    return gradient, hessian
