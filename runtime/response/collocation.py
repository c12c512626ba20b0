"""Steady states by the cyclic system of a one-step scheme, (6.22): method ``cyclic``.

Collocation on intervals of the period, in canonical variables: with the stage velocities V_i,

    M_i V_i + A_i Q_i = p + h sum_j a_ij R_j,   Q_i = q + h sum_j a_ij V_j,
    R_j = (A_j^T - C_j/w) V_j + (B - (K + Kg)/w^2 - D/w)_j Q_j + F_j,

n unknowns a stage, and no derivative of a coefficient.  Radau's points damp what an interval does
not resolve, so that few intervals serve a stiff system whose motion is smooth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.results import Check
from ..core.trigonometric import even_angles
from ..integrators.radau import legendre_integrals as integrals
from ..integrators.radau import radau_tableau
from ..integrators.tableau import gauss_tableau
from ..periodic.first_order import CanonicalForm
from ..periodic.ring import solve_ring
from ..simulation.second_order import combined, even_samples, term_samples
from .request import Found, Request, peaks, resampled, whole_option, word_option
from .stepped import ring_closing, stepped

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_STAGES = 8
_FEWEST = 8
_MOST = 1024
# Floats of the stage equations held together, and of all a ring's maps.
_BLOCK_FLOATS = 2**23
_RING_FLOATS = 2**25
_MARGIN = 8.0


@dataclass(frozen=True)
class Stages:
    """Coefficients at the stages of all intervals, and the nodes they belong to.

    Attributes
    ----------
    mass, gyro, feedback, inertia : ndarray
        M, A, A^T - C/w, B - (K + Kg)/w^2 - D/w, shape ``(nb, N, s, n, n)``.
    force : ndarray
        F, shape ``(nb, N, s, n)``.
    """

    mass: Array
    gyro: Array
    feedback: Array
    inertia: Array
    force: Array


@dataclass(frozen=True)
class Points:
    """Nodes, weights and stage weights of collocation on [0, 1]."""

    name: str
    c: Array
    a: Array
    b: Array


def points(scheme: str, stages: int = _STAGES) -> Points:
    """Return the collocation points of a scheme: ``radau`` or ``gauss_legendre``."""
    if scheme == "radau":
        found = radau_tableau(stages)
        return Points(scheme, found.c, found.a, found.b)
    gauss = gauss_tableau(stages)
    return Points(scheme, gauss.c, gauss.a, gauss.b)


def by_cyclic_system(request: Request) -> Found:
    """Return periodic motions by the cyclic system of a one-step scheme."""
    schemes = ("radau", "gauss_legendre", "newmark", "generalized_alpha")
    scheme = word_option(request.options, "scheme", "radau", schemes)
    if scheme in ("newmark", "generalized_alpha"):
        return stepped(request, "cyclic system (6.22)", ring_closing)
    fixed = whole_option(request.options, "intervals", 2, _MOST)
    form = request.form
    nt = 2 ** int(np.ceil(np.log2(request.samples)))
    rule = points(scheme)
    found = [
        _adapted(form.take(slice(k, k + 1)), rule, request, fixed, k)
        for k in range(len(form.speed))
    ]
    nt = max([nt, *(len(item[0]) for item in found)])
    q = np.stack([resampled(item[0], nt) for item in found])
    slope = np.stack([resampled(item[1], nt) for item in found])
    error, floor = (np.stack([item[k] for item in found]) for k in (2, 3))
    sensitivity = np.array([item[4] for item in found])
    doubt = _EPS * np.where(np.isfinite(sensitivity), sensitivity, 1 / _EPS)
    lost = (16 * doubt >= 1.0) | ~np.all(np.isfinite(q), axis=(1, 2))
    q[lost], slope[lost], error[lost], sensitivity[lost] = np.nan, np.nan, np.inf, np.inf
    order = 15 if scheme == "radau" else 16
    return Found(
        method=f"cyclic system of {scheme} collocation of order {order}",
        theta=even_angles(form.system.period, nt),
        q=q,
        slope=slope,
        error=error,
        allowed=np.minimum(np.maximum(request.rtol, 4 * floor), 1e-2),
        sensitivity=sensitivity,
        checks={"single": Check(16 * float(np.max(doubt)), 1.0)},
    )


Item = tuple[Array, Array, Array, Array, float]


def _adapted(
    form: CanonicalForm, rule: Points, request: Request, fixed: int | None, place: int
) -> Item:
    """Double the intervals until two motions agree."""
    intervals = _FEWEST if fixed is None else max(1, fixed // 2)
    least = 2 ** int(np.ceil(np.log2(request.samples)))
    before, _, _ = ring_motion(form, rule, intervals, least)
    before_gap = np.ones(form.system.size)
    while True:
        intervals = 2 * intervals if fixed is None else fixed
        least = max(least, 2 * intervals)
        q, slope, sensitivity = ring_motion(form, rule, intervals, least)
        size = peaks(q)
        gap = np.max(np.abs(q - resampled(before, len(q))), axis=0) / size
        floor = np.full(len(size), _EPS * np.sqrt(intervals) * sensitivity) * np.max(size) / size
        # A change is believed to shrink on as it has, in the coordinate where it does least.
        gain = 1.0
        if np.max(gap) < 1e-4:
            gain = float(np.clip(_MARGIN * np.max(gap / before_gap), 2.0**-4, 1.0))
        error = gap * gain + floor
        stuck = np.max(gap) > 0.5 * np.max(before_gap) and np.max(gap) < 1e-6
        ended = bool(np.all(error <= np.maximum(request.rtol, 2 * floor))) or stuck
        if ended or fixed is not None or 2 * intervals > _MOST or not np.isfinite(sensitivity):
            if request.tick is not None:
                request.tick(place + 1)
            return q, slope, np.where(np.isfinite(error), error, np.inf), floor, sensitivity
        before, before_gap = q, np.maximum(gap, floor + _EPS)


def ring_motion(
    form: CanonicalForm, rule: Points, intervals: int, samples: int
) -> tuple[Array, Array, float]:
    """Return q and q' of one periodic motion at even angles, and its sensitivity.

    Between the ends of the intervals the collocation polynomials are taken.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    rule : Points
        The collocation points.
    intervals : int
        Intervals of the period.
    samples : int
        Least number of angles; they divide the intervals evenly.
    """
    n = form.system.size
    each = -(-samples // intervals)
    step = form.system.period / intervals
    stages = stages_of(form, rule, intervals)
    maps, spread = interval_maps(stages, rule, step)
    scale = form.scale[0, : 2 * n]
    own = maps[0] / scale[:, None]
    nodes, sensitivity = solve_ring(own[None, ..., :-1] * scale, own[None, ..., -1])
    start = nodes[0] * scale
    full = np.concatenate([start, np.ones((intervals, 1))], axis=1)
    velocity = np.einsum("kirc,kc->kir", spread[0], full)
    inside = np.arange(each) / each
    lagrange = np.linalg.inv(np.polynomial.legendre.legvander(2 * rule.c - 1, len(rule.c) - 1))
    weights = step * (0.5 * integrals(2 * inside - 1, len(rule.c)) @ lagrange)
    q = (start[:, None, :n] + np.einsum("ei,kir->ker", weights, velocity)).reshape(-1, n)
    places = start[:, None, :n] + step * np.einsum("ij,kjr->kir", rule.a, velocity)
    push = stages.force[0] + np.einsum("kirc,kic->kir", stages.feedback[0], velocity)
    push += np.einsum("kirc,kic->kir", stages.inertia[0], places)
    p = (start[:, None, n:] + np.einsum("ei,kir->ker", weights, push)).reshape(-1, n)
    return q, _velocity(form, q, p), float(sensitivity[0])


def _velocity(form: CanonicalForm, q: Array, p: Array) -> Array:
    """Return ``q' = M^-1 (p - A q)`` at even angles, one more power of the step than V itself."""
    values = even_samples(form.system, len(q))
    mass, gyro = (combined(form, values, (name,), (1,))[0] for name in "MA")
    momentum = p - (gyro @ q[..., None])[..., 0]
    slope: Array = np.linalg.solve(mass, momentum[..., None])[..., 0]
    return slope


def stages_of(form: CanonicalForm, rule: Points, intervals: int) -> Stages:
    """Return the coefficients at the stages of all intervals of a batch."""
    period, s, n = form.system.period, len(rule.c), form.system.size
    key = ("stages", rule.name, s, intervals)

    def angles() -> Array:
        left = np.arange(intervals)[:, None] + rule.c
        return (left * (period / intervals)).ravel()

    values = term_samples(form.system, key, angles)

    def laid(array: Array) -> Array:
        lead = (len(form.speed), intervals * s)
        whole = np.broadcast_to(array, (*lead, *array.shape[2:]))
        return whole.reshape(len(form.speed), intervals, s, *array.shape[2:])

    gyro = combined(form, values, ("A",), (1,))
    feedback = np.swapaxes(gyro, -1, -2) - combined(form, values, ("C",), (1,))
    force = combined(form, values, ("f", "h", "p"), (1, 1, 1))
    return Stages(
        mass=laid(combined(form, values, ("M",), (1,))),
        gyro=laid(gyro),
        feedback=laid(feedback),
        inertia=laid(combined(form, values, ("B", "K", "Kg", "D"), (1, -1, -1, -1))),
        force=laid(force).reshape(len(form.speed), intervals, s, n),
    )


def interval_maps(stages: Stages, rule: Points, step: float) -> tuple[Array, Array]:
    """Return the maps of all intervals and the stage velocities.

    Returns
    -------
    maps : ndarray
        From (q, p, 1) at the left ends to (q, p) at the right ones, ``(nb, N, 2n, 2n + 1)``.
    velocity : ndarray
        From (q, p, 1) to the stage velocities, ``(nb, N, s, n, 2n + 1)``.
    """
    count, intervals, s, n = stages.force.shape
    together = max(1, _BLOCK_FLOATS // (3 * (s * n) ** 2))
    flat = [
        getattr(stages, name).reshape(count * intervals, s, *([n] * axes))
        for name, axes in (("mass", 2), ("gyro", 2), ("feedback", 2), ("inertia", 2), ("force", 1))
    ]
    pieces = [
        _maps_of([part[k : k + together] for part in flat], rule, step)
        for k in range(0, count * intervals, together)
    ]
    maps, velocity = (np.concatenate([piece[i] for piece in pieces]) for i in (0, 1))
    return (
        maps.reshape(count, intervals, 2 * n, 2 * n + 1),
        velocity.reshape(count, intervals, s, n, 2 * n + 1),
    )


def _maps_of(arrays: list[Array], rule: Points, step: float) -> tuple[Array, Array]:
    mass, gyro, feedback, inertia, force = arrays
    number, s, n = force.shape
    a, b = step * rule.a, step * rule.b
    # Block (i, k): delta_ik M_i + a_ik (A_i - (A^T - C)_k) - sum_j a_ij a_jk B_j.
    twice = np.einsum("ij,jk->ikj", a, a).reshape(s * s, s)
    system = -(twice @ inertia.reshape(number, s, n * n)).reshape(number, s, s, n, n)
    if np.any(gyro) or np.any(feedback):
        system += a[:, :, None, None] * (gyro[:, :, None] - feedback[:, None])
    place = np.arange(s)
    system[:, place, place] += mass
    right = np.zeros((number, s, n, 2 * n + 1))
    push = (a @ inertia.reshape(number, s, n * n)).reshape(number, s, n, n)
    right[..., :n] = push - gyro
    right[..., n : 2 * n] = np.eye(n)
    right[..., -1] = a @ force
    square = np.moveaxis(system, 3, 2).reshape(number, s * n, s * n)
    velocity = np.linalg.solve(square, right.reshape(number, s * n, 2 * n + 1))
    velocity = velocity.reshape(number, s, n, 2 * n + 1)
    places = (a @ velocity.reshape(number, s, -1)).reshape(velocity.shape)
    places[..., :n] += np.eye(n)
    slope = feedback @ velocity + inertia @ places
    slope[..., -1] += force
    maps = np.empty((number, 2 * n, 2 * n + 1))
    maps[:, :n] = (b @ velocity.reshape(number, s, -1)).reshape(number, n, 2 * n + 1)
    maps[:, n:] = (b @ slope.reshape(number, s, -1)).reshape(number, n, 2 * n + 1)
    maps[..., :-1] += np.eye(2 * n)
    return maps, velocity
