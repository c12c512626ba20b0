"""Counterweights that make a weighted sum of peaks least: conic hull, descent, a proved bound.

Every force is linear in what a counterweight adds to its link, ``p = (m, m u, m v, m (u^2 + v^2) +
inertia about its centre)``, so that the peak of its magnitude over the crank angle is convex in p.
The counterweights themselves form no convex set, for the last entry is a product; their convex hull
is an intersection of second-order cones.  The least sum over the hull, from Clarabel, and weak
duality prove how low any counterweight can come; SciPy's SLSQP descends from the hull's optimum
among the counterweights themselves.  The peaks between sampled angles are added at each optimum
(Remez's exchange), until none is higher than the bound that the problem has for it.

Per link, masses are scaled by the greatest mass and lengths by the greatest offset; forces by their
peak without counterweights, or by what is allowed of it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg, optimize, sparse

from ..core.errors import BadInput, bad
from ..core.trigonometric import even_angles, tail
from ..linkages.linkage import TURN, Array, finite_array
from .machine import Machine
from .masses import MassDistribution
from .peaks import TERMS, forces_of, highest

Measure: TypeAlias = Literal["peak", "rms"]
Peaks: TypeAlias = Mapping[str, tuple[Array, Array]]  # angles (k,) and sizes (k,) of each force

PER_LINK = 4  # parameters: mass, two first moments, inertia
_PLACES = 3  # variables of a design: mass, place along and across
_ROUNDS = 12
# Every sample of a peak is a cone of the programme, all those of a mean are one.
_MOST_SAMPLES = {"peak": 2**13, "rms": 2**16}
# What a peak may be above its bound: of the hull as Clarabel solves, of the descent near round-off.
_HULL_EXCESS, _EXCESS = 1e-9, 1e-11
_GAP = 1e-7  # other starts are tried where more than this is unproved, over the unit
# Newton steps on the KKT conditions; step of the differences, and what leaves the active set.
_POLISHING, _STEP, _LONGEST_STEP = 4, 1e-5, 1e-3


def least(gradient: Array, stiffness: float) -> float:
    """Return the least of ``gradient . p`` over all counterweights of a link.

    ``stiffness`` is the inertia about the centre over mass squared: that of a cylinder is
    ``1/(2 pi h rho)``, of a point mass zero.
    """
    g_mass, g_along, g_across, g_inertia = (float(g) for g in gradient)
    pull = float(np.hypot(g_along, g_across))
    offsets = [0.0, 1.0]
    if g_inertia > 0.0:
        offsets.append(min(pull / (2.0 * g_inertia), 1.0))
    linear = g_mass + min((g_inertia * r - pull) * r for r in offsets)
    square = g_inertia * stiffness
    masses = [0.0, 1.0]
    if square > 0.0:
        masses.append(min(max(-linear / (2.0 * square), 0.0), 1.0))
    return min((linear + square * m) * m for m in masses)


@dataclass(frozen=True)
class Cones:
    """``|fixed + basis p| <= t[bound]`` at n angles, the force having d components."""

    bound: int  # which of the bounds t
    # fixed, basis: (n, d), ndarray (n, d, 4 links): force without counterweights, and of each
    # unit parameter
    fixed: Array
    basis: Array

    def values(self, p: Array) -> Array:
        """Return the force (n, d) with the parameters p."""
        return np.asarray(self.fixed + self.basis @ p)

    def joined(self, more: Cones) -> Cones:
        """Return the same with more angles."""
        fixed, basis = ((self.fixed, more.fixed), (self.basis, more.basis))
        return Cones(self.bound, np.concatenate(fixed), np.concatenate(basis))


@dataclass(frozen=True)
class Design:
    """One counterweight on each link: variables x of mass, place along and across."""

    stiffness: Array  # of each link's counterweight, see :func:`least`

    @property
    def count(self) -> int:
        """Number of parameters p."""
        return PER_LINK * len(self.stiffness)

    def parameters(self, x: Array) -> Array:
        """Return p: mass, first moments, inertia of each link's counterweight."""
        m, u, v = x.reshape(-1, _PLACES).T
        inertia = m * (u * u + v * v + self.stiffness * m)
        return np.stack([m, m * u, m * v, inertia], axis=1).ravel()

    def jacobian(self, x: Array) -> Array:
        """Return dp/dx."""
        blocks = [
            [
                [1.0, 0.0, 0.0],
                [u, m, 0.0],
                [v, 0.0, m],
                [u * u + v * v + 2.0 * c * m, 2.0 * m * u, 2.0 * m * v],
            ]
            for (m, u, v), c in zip(x.reshape(-1, _PLACES), self.stiffness, strict=True)
        ]
        return np.asarray(linalg.block_diag(*blocks))

    def conditions(self, x: Array) -> tuple[Array, Array]:
        """Return how far each counterweight is within its greatest offset, and the slopes."""
        places = x.reshape(-1, _PLACES)[:, 1:]
        links = len(places)
        slopes = np.zeros((links, links, _PLACES))
        slopes[range(links), range(links), 1:] = -2.0 * places
        return 1.0 - np.sum(places**2, axis=1), slopes.reshape(links, -1)

    def within(self, x: Array) -> Array:
        """Return variables whose offsets keep their bounds, first moments kept where they can be.

        A descent leaves a condition by what it does not feel of it.
        """
        parts = x.reshape(-1, _PLACES).copy()
        beyond = np.maximum(np.hypot(parts[:, 1], parts[:, 2]), 1.0)
        parts[:, 0] = np.minimum(parts[:, 0] * beyond, 1.0)
        parts[:, 1:] /= beyond[:, np.newaxis]
        return parts.ravel()

    def realised(self, p: Array, unfelt: Sequence[bool]) -> Array:
        """Return counterweights with the mass and first moments p, and the inertia if they can.

        Links that are ``unfelt``, of which only the first moments matter, get the least mass.
        """
        m, a, b, _ = p.reshape(-1, PER_LINK).T
        moment = np.hypot(a, b)
        mass = np.clip(np.where(unfelt, moment, np.maximum(m, moment)), 0.0, 1.0)
        place = np.stack([a, b], axis=1) / np.where(mass > 0.0, mass, 1.0)[:, np.newaxis]
        return self.within(np.column_stack([mass, place]).ravel())


@dataclass(frozen=True)
class PeakProblem:
    """Minimise ``cost . t`` over the counterweights of all links, t the bounds of the peaks."""

    design: Design
    cones: Sequence[Cones]  # the forces
    # cost, ceilings: weight of each bound t, and its greatest value, ``inf`` where free
    cost: Array
    ceilings: Array

    def bounds(self, p: Array) -> Array:
        """Return the least t with the parameters p."""
        t = np.zeros(len(self.cost))
        for cone in self.cones:
            peak = float(np.max(np.linalg.norm(cone.values(p), axis=1)))
            t[cone.bound] = max(t[cone.bound], peak)
        return t

    def lower_bound(self, pulls: Sequence[Array], ceiling_prices: Array) -> float:
        """Return what no counterweight can undercut, whatever the multipliers are.

        ``pulls``, (n, d) each, are those of the forces of each of the cones, scaled down where they
        exceed what cost and ceiling prices allow; ``ceiling_prices`` those of the ceilings.
        """
        capped = np.isfinite(self.ceilings)
        prices = np.where(capped, np.maximum(ceiling_prices, 0.0), 0.0)
        spent = np.zeros(len(self.cost))
        for cone, pull in zip(self.cones, pulls, strict=True):
            spent[cone.bound] += float(np.sum(np.linalg.norm(pull, axis=1)))
        tiny = np.finfo(float).tiny
        scale = np.minimum(1.0, (self.cost + prices) / np.maximum(spent, tiny))
        constant = -float(prices[capped] @ self.ceilings[capped])
        gradient = np.zeros(self.design.count)
        for cone, pull in zip(self.cones, pulls, strict=True):
            fair = scale[cone.bound] * pull
            constant += float(np.sum(fair * cone.fixed))
            gradient += np.einsum("nd,ndp->p", fair, cone.basis)
        return constant + sum(map(least, gradient.reshape(-1, PER_LINK), self.design.stiffness))


def hull_minimum(problem: PeakProblem) -> tuple[Array, float] | None:
    """Return the parameters that are best in the convex hull, and a lower bound.

    None where no parameters meet the ceilings.
    """
    import clarabel

    design = problem.design
    count, bounds = design.count, len(problem.cost)
    # Variables: p, t, and the square of its mass for each link where that counts.
    stiff = np.flatnonzero(design.stiffness).tolist()
    size = count + bounds + len(stiff)
    rows: list[Array] = []
    right: list[Array] = []
    cones: list[Any] = []

    def add(matrix: Array, constant: Array, *kinds: Any) -> None:
        """Ask for ``constant + matrix z`` in cones."""
        rows.append(-matrix)
        right.append(constant)
        cones.extend(kinds)

    for cone in problem.cones:
        n, d = cone.fixed.shape
        matrix, constant = np.zeros((n, d + 1, size)), np.zeros((n, d + 1))
        matrix[:, 0, count + cone.bound] = 1.0
        matrix[:, 1:, :count] = cone.basis
        constant[:, 1:] = cone.fixed
        kinds = [clarabel.SecondOrderConeT(d + 1)] * n
        add(matrix.reshape(-1, size), constant.ravel(), *kinds)
    unit = np.eye(size)
    capped = np.flatnonzero(np.isfinite(problem.ceilings))
    if len(capped):
        kind = clarabel.NonnegativeConeT(len(capped))
        add(-unit[count + capped], problem.ceilings[capped], kind)
    for i, stiffness in enumerate(design.stiffness):
        m, a, b, j = unit[PER_LINK * i : PER_LINK * (i + 1)]
        square = unit[count + bounds + stiff.index(i)] if stiffness else np.zeros(size)
        reach = j - stiffness * square
        placed = np.array([m + reach, m - reach, 2 * a, 2 * b])
        add(placed, np.zeros(4), clarabel.SecondOrderConeT(4))
        add(np.array([m, a, b]), np.zeros(3), clarabel.SecondOrderConeT(3))
        sides = np.array([-m, (1.0 + stiffness) * m - j, reach])
        add(sides, np.eye(3)[0], clarabel.NonnegativeConeT(3))
        if stiffness:
            squared, one = np.array([square, square, 2 * m]), np.array([1.0, -1.0, 0.0])
            add(squared, one, clarabel.SecondOrderConeT(3))
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    # Clarabel's tolerances: beyond 1e-10 round-off leads it astray, and the gap no longer shrinks.
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-10
    cost = np.concatenate([np.zeros(count), problem.cost, np.zeros(len(stiff))])
    matrix = sparse.csc_matrix(np.concatenate(rows))
    empty = sparse.csc_matrix((size, size))
    solver = clarabel.DefaultSolver(empty, cost, matrix, np.concatenate(right), cones, settings)
    solved = solver.solve()
    if "Infeasible" in str(solved.status):
        return None
    prices, place, pulls = np.array(solved.z), 0, []
    for cone in problem.cones:
        n, d = cone.fixed.shape
        pulls.append(-prices[place : place + n * (d + 1)].reshape(n, d + 1)[:, 1:])
        place += n * (d + 1)
    ceiling_prices = np.zeros(bounds)
    ceiling_prices[capped] = prices[place : place + len(capped)]
    p = np.array(solved.x[:count])
    return _within(design.stiffness, p), problem.lower_bound(pulls, ceiling_prices)


def _within(stiffness: Array, p: Array) -> Array:
    """Return parameters that bodies can have: the solver leaves its cones by round-off."""
    m, a, b, j = p.reshape(-1, PER_LINK).T
    moment = np.hypot(a, b)
    short = np.minimum(1.0, 1.0 / np.maximum(moment, 1.0))
    m = np.clip(np.maximum(m, moment), 0.0, 1.0)
    least = (moment * short) ** 2 / np.where(m > 0.0, m, 1.0)
    j = np.maximum(j, least + stiffness * m * m)
    return np.stack([m, a * short, b * short, j], axis=1).ravel()


@dataclass(frozen=True)
class Candidate:
    """Counterweights: variables of the design, value, proved lower bound, KKT residual.

    ``slope`` is by how much the value falls over a relative rise of the limits.
    """

    x: Array
    value: float
    bound: float
    residual: float
    slope: float


class _Epigraph:
    """The descent in ``z = (x, t)``: minimise ``cost . t`` with ``|F|^2 <= t^2`` at every angle."""

    def __init__(self, problem: PeakProblem) -> None:
        self.problem, self.design = problem, problem.design
        links = len(self.design.stiffness)
        low, high = np.tile([0.0, -1.0, -1.0], links), np.ones(_PLACES * links)
        self.n = len(low)
        self.cost = np.concatenate([np.zeros(self.n), problem.cost])
        self.low = np.concatenate([low, np.zeros(len(problem.cost))])
        self.high = np.concatenate([high, problem.ceilings])

    def minimum(self, start: Array) -> Array:
        """Return the local optimum that SLSQP reaches from variables x."""
        t = np.minimum(self.problem.bounds(self.design.parameters(start)), self.high[self.n :])
        z = np.concatenate([start, t])
        minimize: Any = optimize.minimize
        reached = minimize(
            lambda z: float(self.cost @ z),
            z,
            jac=lambda z: self.cost,
            bounds=optimize.Bounds(self.low, self.high),
            constraints={"type": "ineq", "fun": self.slacks, "jac": self.slopes},
            method="SLSQP",
            options={"ftol": 1e-15, "maxiter": 300},
        ).x
        # SLSQP may break down where constraints are all but dependent: its start then stays.
        z = reached if np.all(np.isfinite(reached)) else z
        return np.asarray(np.clip(z, self.low, self.high)[: self.n])

    def slacks(self, z: Array) -> Array:
        """Return t^2 - |F|^2 of every force, then the design's conditions."""
        p, t = self.design.parameters(z[: self.n]), z[self.n :]
        forces = [
            t[cone.bound] ** 2 - np.sum(cone.values(p) ** 2, axis=1) for cone in self.problem.cones
        ]
        return np.concatenate([*forces, self.design.conditions(z[: self.n])[0]])

    def slopes(self, z: Array) -> Array:
        """Return their Jacobian."""
        x, t = z[: self.n], z[self.n :]
        p, turned = self.design.parameters(x), self.design.jacobian(x)
        rows = []
        for cone in self.problem.cones:
            row = np.zeros((len(cone.fixed), len(z)))
            row[:, : self.n] = -2.0 * np.einsum("nd,ndp->np", cone.values(p), cone.basis) @ turned
            row[:, self.n + cone.bound] = 2.0 * t[cone.bound]
            rows.append(row)
        conditions = self.design.conditions(x)[1]
        return np.concatenate([*rows, np.pad(conditions, ((0, 0), (0, len(t))))])

    def _constraints(self, z: Array) -> tuple[Array, Array]:
        """Return all that must be zero or more, the ends of the variables last; with Jacobian."""
        unit = np.eye(len(z))
        values = np.concatenate([self.slacks(z), z - self.low, self.high - z])
        return values, np.concatenate([self.slopes(z), unit, -unit])

    def _multipliers(self, z: Array) -> tuple[Array, float]:
        """Return the multipliers of all constraints, and the residual of the KKT conditions."""
        values, slopes = self._constraints(z)
        active = np.flatnonzero(np.abs(values) <= 1e-7)
        prices = np.zeros(len(values))
        if len(active):
            prices[active] = optimize.nnls(slopes[active].T, self.cost)[0]
        rest = np.max(np.abs(self.cost - prices @ slopes)) / np.max(np.abs(self.cost))
        return prices, float(max(rest, np.max(np.abs(values[prices > 0.0]), initial=0.0)))

    def polished(self, x: Array) -> Array:
        """Return x after Newton's method on the KKT conditions, where SLSQP leaves flat directions.

        The second derivatives are central differences of the exact first ones.
        """
        z = np.concatenate([x, self.problem.bounds(self.design.parameters(x))])
        prices, least = self._multipliers(z)
        best = z
        for _ in range(_POLISHING):
            used = np.flatnonzero(prices)
            values, slopes = (part[used] for part in self._constraints(z))
            bend = []
            for e in _STEP * np.eye(len(z)):
                ahead, behind = (self._constraints(at)[1] for at in (z + e, z - e))
                bend.append(prices @ (ahead - behind) / (-2.0 * _STEP))
            none = np.zeros((len(used), len(used)))
            matrix = np.block([[np.array(bend), -slopes.T], [slopes, none]])
            right = np.concatenate([prices @ self._constraints(z)[1] - self.cost, -values])
            step = np.linalg.lstsq(matrix, right, rcond=1e-9)[0][: len(z)]
            if not np.max(np.abs(step)) < _LONGEST_STEP:
                break
            z = z + step
            prices, residual = self._multipliers(z)
            if residual < least:
                best, least = z, residual
        return np.asarray(np.clip(best, self.low, self.high)[: self.n])

    def proof(self, x: Array) -> tuple[float, float, float]:
        """Return the residual of the KKT conditions, and the lower bound of their multipliers.

        With them the slope of the least value over a relative rise of the ceilings.
        """
        p = self.design.parameters(x)
        prices, residual = self._multipliers(np.concatenate([x, self.problem.bounds(p)]))
        pulls, place = [], 0
        for cone in self.problem.cones:
            price = prices[place : place + len(cone.fixed)]
            pulls.append(2.0 * price[:, np.newaxis] * cone.values(p))
            place += len(cone.fixed)
        ceiling_prices = prices[len(prices) - len(self.problem.cost) :]
        capped = np.isfinite(self.problem.ceilings)
        slope = float(ceiling_prices[capped] @ self.problem.ceilings[capped])
        return residual, self.problem.lower_bound(pulls, ceiling_prices), slope


@dataclass(frozen=True)
class ForceBasis:
    """A machine at one speed: the forces at any angle, and what each unit of mass adds."""

    machine: Machine  # without the counterweights
    # speed, acceleration: of the crank [rad/s, rad/s^2]
    speed: float
    acceleration: float
    links: Sequence[str] = ()  # links that carry counterweights
    # masses, lengths: units of mass [kg] and length [m] of each link's parameters
    masses: Array = field(default_factory=partial(np.zeros, 0))
    lengths: Array = field(default_factory=partial(np.zeros, 0))
    # what counts of each force: its peak, or its root mean square over the sampled angles
    measure: Measure = "peak"
    theta: Array = field(default_factory=partial(np.zeros, 0))  # sampled angles
    whole: bool = False  # True where they stand for a whole turn

    def sampled(self, angles: ArrayLike | None) -> ForceBasis:
        """Return it with the angles that count: those given, or a turn by equal steps.

        These are dense enough for the peaks between them, or for means.
        """
        if angles is not None:
            theta = finite_array("angles", angles, "angles [rad]").ravel()
            if theta.size == 0:
                raise bad("angles", "none", "finite angles [rad]", "give one or more")
            return replace(self, theta=theta)
        if not self.machine.linkage.crank_turns:
            fix = "give angles that the crank can reach"
            raise bad("angles", "a crank that cannot turn fully", "angles [rad]", fix)
        count, most = 256, _MOST_SAMPLES[self.measure]
        while count <= most:
            theta = even_angles(TURN, count)
            count *= 2
            # The tail of the forces' spectrum at which the peaks between samples are safe.
            if max(map(tail, self.forces(theta).values())) < 1e-10:
                break
        return replace(self, theta=theta, whole=True)

    @property
    def between(self) -> bool:
        """True where peaks between the samples count; a mean over them has none."""
        return self.whole and self.measure == "peak"

    def forces(
        self, theta: Array, p: Array | None = None, terms: Sequence[str] = TERMS
    ) -> dict[str, Array]:
        """Return each term (n, d) at n angles, with the parameters p of the counterweights."""
        machine = self.machine
        if p is not None:
            masses = dict(machine.masses)
            for i, link in enumerate(self.links):
                added = self._distribution(i, p[PER_LINK * i : PER_LINK * (i + 1)])
                masses[link] = masses.get(link, MassDistribution()) + added
            machine = replace(machine, masses=masses)
        return forces_of(machine, theta, self.speed, self.acceleration, terms)

    def unit_forces(self, theta: Array, terms: Sequence[str]) -> dict[str, Array]:
        """Return what each scaled parameter adds: (n, d, 4 links) for each term.

        The unit vectors are differences of bodies that exist: a point at the first joint, a ring
        about it, and points beside it.
        """
        bodies = ((1, 0, 0, 0), (1, 1, 0, 1), (1, 0, 1, 1), (1, 0, 0, 1))
        columns: dict[str, list[Array]] = {term: [] for term in terms}
        drive = (self.speed, self.acceleration, terms)
        for i, link in enumerate(self.links):
            masses = ({link: self._distribution(i, np.array(body, float))} for body in bodies)
            alone = (replace(self.machine, masses=m, loads=(), springs=()) for m in masses)
            mass, along, across, ring = (forces_of(one, theta, *drive) for one in alone)
            for term, parts in columns.items():
                parts += [mass[term], along[term] - ring[term], across[term] - ring[term]]
                parts += [ring[term] - mass[term]]
        return {term: np.stack(parts, axis=-1) for term, parts in columns.items()}

    def sizes(
        self, p: Array | None = None, terms: Sequence[str] = TERMS
    ) -> dict[str, tuple[Array, Array]]:
        """Return angles and sizes of the highest peaks of each term with parameters p [N; N m].

        The root mean square counts as one peak, at the highest of the samples.
        """
        theta, peaked = self.theta, self.measure == "peak"
        if self.between:
            peaks = highest(lambda at: self.forces(at, p, terms), theta, around=True)
            return {term: (at, np.linalg.norm(each, axis=1)) for term, (at, each) in peaks.items()}
        sizes = {}
        for term, force in self.forces(theta, p, terms).items():
            size = np.linalg.norm(force, axis=1)
            top = int(np.argmax(size))
            whole = size[top] if peaked else np.sqrt(np.mean(size**2))
            sizes[term] = (theta[top : top + 1], np.array([whole]))
        return sizes

    def _distribution(self, i: int, p: Array) -> MassDistribution:
        m, a, b, j = (float(x) for x in p)
        mass, length = float(self.masses[i]), float(self.lengths[i])
        moment = mass * length
        return MassDistribution(m * mass, a * moment, b * moment, j * moment * length)


@dataclass(frozen=True)
class Search:
    """Everything about one search that stays as it is."""

    basis: ForceBasis
    unbalanced: Mapping[str, float]  # peaks of every force without counterweights [N; N m]
    design: Design
    # weights, limits: of the relative peaks
    weights: Mapping[str, float]
    limits: Mapping[str, float]

    @property
    def terms(self) -> tuple[str, ...]:
        """Forces with a weight or a limit."""
        return tuple(term for term in TERMS if term in {*self.weights, *self.limits})

    @property
    def unit(self) -> float:
        """Weighted sum of the relative peaks of the unbalanced linkage."""
        return sum(self.weights.values())

    def _unit_of(self, term: str) -> float:
        """Return the unit of a term's bound t, of relative peaks: a low limit counts as 1."""
        return min(1.0, self.limits.get(term, 1.0))

    def problem(self, theta: Mapping[str, Array]) -> PeakProblem:
        """Return the problem with the peaks at angles of each term's."""
        terms = self.terms
        units = np.array([self._unit_of(term) for term in terms])
        cost = units * [self.weights.get(term, 0.0) for term in terms]
        tops = np.array([self.limits.get(term, np.inf) for term in terms]) / units
        joined = np.concatenate([theta[term] for term in terms])
        fixed, basis = self.basis.forces(joined, None, terms), self.basis.unit_forces(joined, terms)
        cones, first = [], 0
        for k, term in enumerate(terms):
            rows = slice(first, first + len(theta[term]))
            size = self.unbalanced[term] * units[k]
            cone = Cones(k, fixed[term][rows] / size, basis[term][rows] / size)
            cones.append(cone if self.basis.measure == "peak" else _mean_square(cone))
            first += len(theta[term])
        return PeakProblem(self.design, cones, cost, tops)

    def start(self) -> PeakProblem:
        """Return the problem with some of the samples, or all that count."""
        # A search starts with every eighth sample.
        theta = self.basis.theta[:: 8 if self.basis.between else 1]
        return self.problem(dict.fromkeys(self.terms, theta))

    def peaks(self, p: Array) -> dict[str, tuple[Array, Array]]:
        """Return angles and relative sizes of the highest peaks with parameters p."""
        sizes = self.basis.sizes(p, self.terms)
        return {term: (at, size / self.unbalanced[term]) for term, (at, size) in sizes.items()}

    def value(self, peaks: Peaks) -> float:
        """Return the weighted sum of relative peaks."""
        return sum(weight * float(peaks[term][1].max()) for term, weight in self.weights.items())

    def broken(self, peaks: Peaks) -> float:
        """Return how far a peak is above its limit, over the limit."""
        over = [float(peaks[term][1].max()) / top - 1.0 for term, top in self.limits.items()]
        return max(over, default=0.0)

    def penalised(self, p: Array) -> float:
        """Return the value; infinite where a limit is passed by more than round-off."""
        peaks = self.peaks(p)
        # A limit passed by less, relative, is met.
        return self.value(peaks) if self.broken(peaks) < 1e-8 else math.inf

    def exchanged(self, problem: PeakProblem, p: Array) -> tuple[PeakProblem, float]:
        """Return the problem with the high peaks among its angles, and how far they are above it.

        The excess is in units of the bounds t.
        """
        if not self.basis.between:
            return problem, 0.0
        peaks, t, chosen, excess = self.peaks(p), problem.bounds(p), {}, 0.0
        for k, term in enumerate(self.terms):
            at, size = peaks[term][0], peaks[term][1] / self._unit_of(term)
            excess = max(excess, float(size.max() - t[k]))
            high = size >= min((1.0 - 1e-3) * t[k], float(size.max()))
            chosen[term] = at[high]
        more = self.problem(chosen).cones
        cones = [old.joined(new) for old, new in zip(problem.cones, more, strict=True)]
        return replace(problem, cones=cones), excess


def _mean_square(cone: Cones) -> Cones:
    """Return one force of a few components whose magnitude is the root mean square of many."""
    count = cone.basis.shape[-1]
    columns = np.concatenate([cone.basis, cone.fixed[..., None]], axis=-1).reshape(-1, count + 1)
    short = np.asarray(np.linalg.qr(columns / np.sqrt(len(cone.fixed)), mode="r"))
    return Cones(cone.bound, short[None, :, count], short[None, :, :count])


def best_counterweights(search: Search) -> Candidate:
    """Return the best counterweights that are known, and the proof of how good they are."""
    problem, p, bound = _hull(search)
    design = search.design
    # Of some links' counterweights nothing but the first moments matters.
    felt = np.max([np.max(np.abs(cone.basis), axis=(0, 1)) for cone in problem.cones], axis=0)
    unfelt = [bool(max(link[0], link[3]) < 1e-9) for link in felt.reshape(-1, PER_LINK)]
    candidates = [_descended(search, problem, bound, design.realised(p, unfelt))]
    if candidates[0].value - candidates[0].bound > _GAP * search.unit:
        # Further starts, the same ones each time: nothing, and four directions.
        for u, v in ((0.0, 0.0), (-0.7, 0.0), (0.7, 0.0), (0.0, 0.7), (0.0, -0.7)):
            start = np.tile([0.5 if u or v else 0.0, u, v], len(design.stiffness))
            candidates.append(_descended(search, problem, bound, start))
    chosen = min(candidates, key=lambda each: each.value)
    bound = max(each.bound for each in candidates)
    x = _lightened(search, problem, chosen, unfelt)
    value = search.value(search.peaks(design.parameters(x)))
    return Candidate(x, value, min(bound, value), chosen.residual, chosen.slope)


def _hull(search: Search) -> tuple[PeakProblem, Array, float]:
    """Return the optimum over the convex hull, true peaks included: problem, p, lower bound."""
    problem, bound = search.start(), 0.0  # no sum of magnitudes is less
    for _ in range(_ROUNDS):
        solved = hull_minimum(problem)
        if solved is None:
            raise _out_of_reach(search, problem)
        p, bound = solved[0], max(bound, solved[1])
        problem, excess = search.exchanged(problem, p)
        if excess < _HULL_EXCESS:
            break
    return problem, p, bound


def _out_of_reach(search: Search, problem: PeakProblem) -> BadInput:
    """Return the complaint about limits that can be met only so many times higher."""
    limits, free = search.limits, np.full(1, np.inf)
    for _ in range(_ROUNDS):
        capped = [cone for cone in problem.cones if np.isfinite(problem.ceilings[cone.bound])]
        tops = problem.ceilings[[cone.bound for cone in capped]]
        shared = [Cones(0, c.fixed / t, c.basis / t) for c, t in zip(capped, tops, strict=True)]
        solved = hull_minimum(PeakProblem(search.design, shared, np.ones(1), free))
        p = np.zeros(search.design.count) if solved is None else solved[0]
        problem, excess = search.exchanged(problem, p)
        if excess < _HULL_EXCESS:
            break
    times = max(1.0, 1.0 + search.broken(search.peaks(p)))
    names = ", ".join(f"{term} {top:g}" for term, top in limits.items())
    least = []
    for term, top in limits.items():
        # In four digits, rounded up: what is named can be given.
        unit = 10.0 ** (math.floor(math.log10(times * top)) - 3)
        least.append(f"{term} at least {math.ceil(times * top / unit) * unit:.4g}")
    together = "" if len(limits) == 1 else " where all are raised alike"
    fix = "raise a limit, or allow more mass or offset"
    return bad("limits", names, ", ".join(least) + together, fix)


def _descended(search: Search, problem: PeakProblem, bound: float, start: Array) -> Candidate:
    """Return the local optimum near a start, true peaks included, or that where it is no worse."""
    design = search.design
    problem, _ = search.exchanged(problem, design.parameters(start))
    x = start
    for _ in range(_ROUNDS):
        x = _Epigraph(problem).minimum(x)
        problem, excess = search.exchanged(problem, design.parameters(x))
        if excess < _EXCESS:
            break
    # The last peaks alone: of several angles beside one peak the multipliers would be a mixture.
    epigraph = _Epigraph(search.exchanged(search.start(), design.parameters(x))[0])
    best = design.within(epigraph.polished(x))
    value = search.penalised(design.parameters(best))
    if not value - bound <= _GAP * search.unit:
        for other in (design.within(x), start):
            least = search.penalised(design.parameters(other))
            if least < value:
                value, best = least, other
    residual, proved, slope = epigraph.proof(best)
    return Candidate(best, value, max(bound, proved), residual, slope)


def _lightened(
    search: Search, problem: PeakProblem, candidate: Candidate, unfelt: Sequence[bool]
) -> Array:
    """Return the design with the least mass that serves as well."""
    design, x = search.design, candidate.x
    allowed = candidate.value + 1e-12 * search.unit
    lighter = design.realised(design.parameters(x), unfelt)
    for place in range(0, len(x), _PLACES):
        rows = slice(place, place + _PLACES)
        for trial in (lighter[rows], np.zeros(_PLACES)):
            changed = x.copy()
            changed[rows] = trial
            p = design.parameters(changed)
            promising = changed[place] < x[place] and problem.cost @ problem.bounds(p) <= allowed
            if promising and search.penalised(p) <= allowed:
                x = changed
    return x
