"""Transition matrices of a period, segment by segment: the engine of everything periodic.

Over a segment of length h the slopes V = q' at the nodes of a collocation method are unknown, the
coordinates are Q = q0 + h a V, and the momenta P = M V + A Q obey P = p0 + h a P':

    (a^-1 P)_l - h (A^T - C/w)_l V_l - h N_l Q_l = (a^-1 1)_l p0 + h F_l.

These are s n equations, for n coordinates and s nodes, and not 2 s n; the mass is never inverted.
All segments are solved in one batch, with 2n + 1 right sides.  Without damping Gauss's nodes keep
the flow symplectic.  With damping Radau's let modes that are dead after a period vanish even where
no segment resolves them, so that the number of segments follows from the modes that are still
alive: see :func:`levels_for`.

What comes out is checked by itself: on a ladder of numbers of segments, 8, 12, 16, 24, 32 ...,
each step is compared with the one before (:func:`refined`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from math import lgamma
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.collocation import gauss_tableau, radau_tableau
from ..core.errors import BadInput, bad
from .equation import Equation, waves

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_EPS = float(np.finfo(float).eps)
# Steps of the ladder, and the largest: its last rungs have a million segments.
_RUNGS, _MOST_SEGMENTS = 36, 2**20
# Segments from which coefficients that are not smooth are taken as they are.
_ROUGH_SEGMENTS = 2**14
# What the errors of two rungs may be over their predicted ratio, and the least share of the
# difference that is taken for the error of the finer one: over 200 springs seen in wavy coordinates
# and five tolerances 99 of 100 errors are covered, the worst by half (five and 0.01 cover 96).
_MARGIN, _LEAST = 12.0, 0.025
# The same over the ratio of the segments to the power of the order that was seen, at most the
# stages, where modes that no segment resolves count; half the stages before an order is seen.
# Of 1800 coordinates of a four-bar at five tolerances 99.7 % are covered, ten times in the middle.
_STIFF = 3.0
# Floats of the collocation matrices that are solved in one batch: they stay in the cache.  With
# eight times as many, nine and 27 freedoms take a fifth longer.  Floats of the equations of all
# segments up to which they are kept beside their solutions.
_BLOCK, _KEPT = 500_000, 2_000_000
# Power of the length of a segment that a field carries in the equations.
_POWER = {"mass": 0, "gyroscopic": 1, "feedback": 1, "stiffness": 2}


def rung(level: int) -> int:
    """Return the number of segments on a rung of the ladder: 8, 12, 16, 24, 32, 48 ..."""
    return int((2 + level % 2) << (level // 2 + 2))


_LADDER = np.array([rung(level) for level in range(_RUNGS)])


@dataclass(frozen=True, eq=False)
class Method:
    """Collocation in the slopes."""

    stages: int  # number s of nodes
    order: int  # order of the transition matrices in the length of a segment
    # Nodes and weights, shape (s,).
    c: Array
    b: Array
    # Stage weights and their inverse, shape (s, s).
    a: Array
    inverse: Array
    ends: bool  # whether the last node is the end of the step

    @cache  # noqa: B019
    def weights(self, fields: tuple[str, ...]) -> Array:
        """Return what each field at each node adds to the equations, ``(s s, s fields)``.

        Rows are unknown slope and equation, columns field and node; fields are times ``h`` to the
        power of :data:`_POWER`.
        """
        s = self.stages
        node = np.eye(s)
        each = {
            "mass": np.einsum("lj,jp->jlp", self.inverse, node),
            "stiffness": -np.einsum("lj,lp->jlp", self.a, node),
            "gyroscopic": np.einsum("lp,pj->jlp", self.inverse, self.a),
            "feedback": -np.einsum("jl,lp->jlp", node, node),
        }
        return np.concatenate([each[name] for name in fields], axis=2).reshape(s * s, -1)


@cache
def method(kind: str, stages: int) -> Method:
    """Return collocation at Gauss's or Radau's points, ``kind`` "gauss" or "radau"."""
    tableau = gauss_tableau(stages) if kind == "gauss" else radau_tableau(stages)
    inverse: Array = np.asarray(np.linalg.inv(tableau.a), dtype=np.float64)
    inverse.flags.writeable = False
    return Method(stages, tableau.order, tableau.c, tableau.b, tableau.a, inverse, kind == "radau")


@dataclass(frozen=True)
class Segments:
    """Transition matrices of the segments of a period, of all members of an equation."""

    # From the scaled state at the left end of a segment to that at its right end, shape
    # (nb, segments, m, m), m = 2n, or 2n + 1 with a last component 1 that the force acts on.
    maps: Array
    # From the state at the left end, by columns, to the scaled slopes at the nodes,
    # (nb, segments, m, n, s); empty unless they were wanted.
    slopes: Array
    # Where these are wanted of a damped system: their equations by blocks, if small.
    stages: list[Stages] = field(default_factory=list)


def segments_of(equation: Equation, count: int, way: Method, *, slopes: bool = False) -> Segments:
    """Return the transition matrices of equal segments of the period."""
    h = equation.period / count
    return segments_from(equation, h * np.arange(float(count)), h, way, slopes=slopes)


def segments_from(
    equation: Equation, left: Array, h: float, way: Method, *, slopes: bool = False
) -> Segments:
    """Return the transition matrices of segments of one length h [rad].

    ``left`` has their left ends [rad], ``(ns,)``; ``slopes`` asks for the slopes at the nodes too.
    """
    s = way.stages
    nb, n, ns = len(equation.speed), equation.size, len(left)
    m = 2 * n + equation.forced
    whole = Segments(np.empty((nb, ns, m, m)), np.empty((nb, ns, m, n, s) if slopes else 0))
    kept = slopes and way.ends and nb * ns * (s * n) ** 2 <= _KEPT
    for part in blocks(equation, way, ns):
        stages = stages_of(equation, left[part], h, way)
        ends, unknown = _solved(equation, stages, h, way)
        whole.maps[:, part] = ends
        if kept:
            whole.stages.append(stages)
        if slopes:
            whole.slopes[:, part] = unknown
    return whole


def blocks(equation: Equation, way: Method, segments: int) -> list[slice]:
    """Return which segments are solved at once, so that their equations stay in the cache."""
    together = max(1, _BLOCK // ((way.stages * equation.size) ** 2 * len(equation.speed)))
    return [slice(begin, begin + together) for begin in range(0, segments, together)]


@dataclass(frozen=True)
class Stages:
    """The equations of the slopes at the nodes of segments, and what they are made of."""

    # Their matrix by columns: unknown slope (coordinate, node), equation (node, coordinate), shape
    # (nb, ns, s n, s n).
    columns: Array
    # Fields times h to the power of _POWER by columns, (nb, ns, n, s, n).
    at_nodes: Mapping[str, Array]
    angles: Array  # the nodes [rad], (ns s,)
    table: Array | None  # what waves gives there, where the equation has Fourier series


def stages_of(equation: Equation, left: Array, h: float, way: Method) -> Stages:
    """Return the equations of the slopes of segments that begin at angles ``(ns,)`` [rad].

    The matrix is one product: the weights of the method times the fields at the nodes.
    """
    n, s = equation.size, way.stages
    angles = (left[:, None] + way.c * h).ravel()
    table: Array | None = None
    if equation.harmonics >= 0:
        table = waves(equation.harmonics, angles * (2 * np.pi / equation.period))
    nb, ns = len(equation.speed), len(left)
    fields = {
        name: equation.at(name, angles, table)
        for name in ("mass", "stiffness", "gyroscopic")
        if name in equation.fields
    }
    turning = fields.get("gyroscopic")
    if (feedback := equation.feedback(angles, table, turning)) is not None:
        fields["feedback"] = feedback
    # Indices: member, segment, column of a field, field, node, row.
    stack = np.empty((nb, ns, n, len(fields), s, n))
    at_nodes = {}
    for place, (name, one) in enumerate(fields.items()):
        # A constant field has one angle.
        values = one.reshape(nb, ns, s, n, n) if one.shape[1] > 1 else one[:, :, None]
        turned = values.transpose(0, 1, 4, 2, 3)
        np.multiply(turned, h ** _POWER[name], out=stack[:, :, :, place])
        at_nodes[name] = stack[:, :, :, place]
    columns = way.weights(tuple(fields)) @ stack.reshape(nb, ns, n, len(fields) * s, n)
    return Stages(columns.reshape(nb, ns, s * n, s * n), at_nodes, angles, table)


def _solved(equation: Equation, stages: Stages, h: float, way: Method) -> tuple[Array, Array]:
    """Return maps and slopes of segments that are solved in one batch of linear equations."""
    # Matrices are made by columns, as LAPACK wants them, and so are right sides and solutions.
    n, s = equation.size, way.stages
    (nb, ns), m = stages.columns.shape[:2], 2 * n + equation.forced
    at_nodes = stages.at_nodes
    # Indices: member, segment, column, node, row.
    right = np.zeros((nb, ns, m, s, n))
    right[:, :, n : 2 * n] = np.eye(n)[:, None] * np.sum(way.inverse, axis=1)[:, None]
    if "stiffness" in at_nodes:
        right[:, :, :n] = at_nodes["stiffness"] / h
    if "gyroscopic" in at_nodes:
        right[:, :, :n] -= way.inverse @ at_nodes["gyroscopic"] / h
    if equation.forced:
        force = np.broadcast_to(equation.at("force", stages.angles, stages.table), (nb, ns * s, n))
        right[:, :, 2 * n] = h * force.reshape(nb, ns, s, n)
    # Slopes at the nodes: member, segment, column, coordinate, node.
    solved = _solution(stages.columns, right.reshape(nb, ns, m, s * n))
    unknown = solved.reshape(nb, ns, m, n, s)
    # By columns too: the state at the right end.
    ends = np.zeros((nb, ns, m, m))
    ends[..., :n] = (unknown.reshape(-1, s) @ (h * way.b)).reshape(nb, ns, m, n)
    if way.ends:
        # The last node is the end: its momentum is M q' + A q.
        rise = unknown[..., -1] @ at_nodes["mass"][..., -1, :]
        if "gyroscopic" in at_nodes:
            moved = ends[..., :n].copy()
            moved[..., :n, :] += np.eye(n)
            rise += moved @ at_nodes["gyroscopic"][..., -1, :] / h
        ends[..., n : 2 * n] = rise
    else:
        places = (unknown.reshape(-1, s) @ (h * way.a.T)).reshape(unknown.shape)
        places[..., :n, :, :] += np.eye(n)[..., None]
        # Gauss's weights add up the rate of the momentum, N q + (A^T - C/w) q' + F, at the nodes.
        for name, vectors in (("stiffness", places), ("feedback", unknown)):
            if name in at_nodes:
                summed = (way.b[:, None] * at_nodes[name]).reshape(nb, ns, n * s, n)
                rate = vectors.reshape(nb, ns, m, n * s) @ summed
                ends[..., n : 2 * n] += rate * h ** (1 - _POWER[name])
        if equation.forced:
            ends[..., 2 * n, n : 2 * n] += h * (way.b @ force.reshape(nb, ns, s, n))
        ends[..., n : 2 * n, n : 2 * n] += np.eye(n)
    ends[..., :n, :n] += np.eye(n)
    if equation.forced:
        ends[..., 2 * n, 2 * n] = 1.0
    return ends.mT, unknown


def _solution(columns: Array, right: Array) -> Array:
    """Return solutions ``(..., m, k)`` of systems given by columns, both stacked alike."""
    # LAPACK itself saves large systems the copies that NumPy makes.
    # From so many unknowns on system by system: a quarter quicker at 270 of them.
    if columns.shape[-1] < 100:
        return np.ascontiguousarray(np.linalg.solve(columns.mT, right.mT).mT)
    from scipy.linalg.lapack import dgesv

    for place in np.ndindex(columns.shape[:-2]):
        *_, failed = dgesv(columns[place].T, right[place].T, overwrite_a=1, overwrite_b=1)
        if failed:
            raise np.linalg.LinAlgError("Singular matrix")
    return right


def product(maps: Array) -> tuple[Array, Whole]:
    """Return ``maps[:, -1] @ ... @ maps[:, 0]`` by pairs, powers of two taken out.

    Of maps ``(nb, segments, m, m)`` the product is ``matrix * 2**exponent``, ``(nb, m, m)`` and
    ``(nb,)``; the exponent is 0 unless entries passed 1e60 or 1e-60.
    """
    exponent = np.zeros(len(maps), dtype=np.int64)
    while maps.shape[1] > 1:
        even = maps.shape[1] - maps.shape[1] % 2
        pairs = maps[:, 1:even:2] @ maps[:, 0:even:2]
        maps = np.concatenate([pairs, maps[:, even:]], axis=1) if even < maps.shape[1] else pairs
        top = np.max(np.abs(maps), axis=(-2, -1))
        if not (np.max(top) <= 1e60 and np.min(top) >= 1e-60):
            extreme = ((top > 1e60) | (top < 1e-60)) & (top > 0) & np.isfinite(top)
            _, power = np.frexp(np.where(extreme, top, 0.5))
            maps = np.ldexp(maps, -power[..., None, None])
            exponent += power.sum(axis=1)
    return maps[:, 0], exponent


def choose(equation: Equation, rtol: float) -> Method:
    """Return the method for a wanted error: Gauss without damping, Radau with it."""
    if equation.damped:
        return method("radau", 7 if rtol > 1e-5 else 10)
    return method("gauss", 6 if rtol > 1e-5 else 8 if rtol > 1e-10 else 10)


def predicted_error(equation: Equation, way: Method, segments: NDArray[Any]) -> Array:
    """Return the error of the multipliers that a number of segments is likely to leave.

    A mode of frequency w, whose amplitude falls by exp(-d) in a period, gets the error of
    :func:`_mode_error`; it enters a multiplier with exp(-d).  The segments are ``(nb,)``, and so is
    the error; or ``(1, k)``, for several numbers at once, and the error is ``(nb, k)``.
    """
    frequency, number, decay = equation.frequency, np.asarray(segments), equation.decay
    if number.ndim > 1:
        frequency, decay = frequency[:, None], decay[:, None]
    size = _mode_error(way, frequency * equation.period, number[..., None], equation.period)
    value: Array = np.exp(np.max(size - decay, axis=-1))
    return value


def _mode_error(way: Method, turned: Array, segments: NDArray[Any], period: float) -> Array:
    """Return the logarithm of the relative error of a mode that turns so far in a period [rad]."""
    # Over S segments of phase x = turned/S it is S k x^(order + 1), at most 1; k = (s!)^2/((2s)!
    # (2s+1)!) is the constant of Pade's approximation of the exponential.
    s, power = way.stages, way.order + 1
    constant = 2 * lgamma(s + 1) - lgamma(2 * s + 1) - lgamma(2 * s + 2)
    # The coefficients' waves turn the state too: about one radian per radian.
    size = constant + power * np.log(turned + period) - (power - 1) * np.log(segments)
    value: Array = np.minimum(size, 0.0)
    return value


def least_share(equation: Equation, way: Method, coarse: Any, fine: Any, order: Any) -> Array:
    """Return the least part of the difference of two rungs that the finer one's error may be.

    Where all modes are resolved it is what the fastest lets expect; ``order`` is that with which
    differences fall.  One rung, ``(nb,)``; several, ``(nb, k)`` with numbers of segments ``(k,)``.
    """
    coarse = np.asarray(coarse)
    if not way.ends:
        return np.full((len(equation.fastest), *coarse.shape), _LEAST)
    turned = (equation.fastest * equation.period).reshape(-1, *(1,) * coarse.ndim)
    ahead, behind = (_mode_error(way, turned, count, equation.period) for count in (fine, coarse))
    resolved = np.maximum(_MARGIN * np.exp(ahead - behind), _LEAST)
    value: Array = np.minimum(resolved, _STIFF * (coarse / fine) ** order)
    return np.minimum(value, 1.0)


def share(equation: Equation, way: Method, level: int, predicted: Array, order: Array) -> Array:
    """Return which part of the difference to the rung below the error of a rung is, ``(nb,)``.

    ``predicted`` are errors of all rungs, ``(nb, rungs)``.  Twelve times what they say, between the
    least and one; of coefficients that are not smooth four times the difference.
    """
    if equation.harmonics < 0:
        return np.full(len(predicted), 4.0)
    least = least_share(equation, way, rung(level - 1), rung(level), order)
    ratio = predicted[:, level] / np.maximum(predicted[:, level - 1], 1e-300)
    return np.clip(_MARGIN * ratio, least, 1.0)


def levels_for(equation: Equation, way: Method, rtol: float) -> tuple[NDArray[np.intp], Array]:
    """Return the rung on which each member is likely solved, and known to be, to a wanted error.

    With it the error that each rung of the ladder is likely to leave, ``(nb, rungs)``.  A mode that
    asks for more than a million segments is refused.
    """
    coarse, fine = _LADDER[:-1], _LADDER[1:]
    errors = predicted_error(equation, way, _LADDER[None])
    enough = _MARGIN * errors[:, 1:] <= rtol
    enough &= least_share(equation, way, coarse, fine, 0.5 * way.stages) * errors[:, :-1] <= rtol
    enough &= fine <= _MOST_SEGMENTS
    # The nodes of the rung below too have to see every wave of the coefficients twice.
    enough &= way.stages * coarse >= 2 * equation.reach
    if not np.all(np.any(enough, axis=1)):
        raise _too_fast(equation, int(np.argmin(np.any(enough, axis=1))))
    return 1 + np.argmax(enough, axis=1), errors


def cheapest(
    equation: Equation, rtol: float, multiple: int, *, fewest: int = 1, stiff: bool = True
) -> tuple[Method, int]:
    """Return method and number of segments that likely solve all members with the least work.

    The number is a multiple of a given one, and at least ``fewest``.  Modes that no segment
    resolves follow what the polynomial through the s nodes makes of their load: of its highest wave
    R that misses ``2 (R h/4)^s / s!``.  Of a truncated system, ``stiff`` False, there are none.  A
    mode that asks for more than a million segments is refused.
    """
    kind = "radau" if equation.damped else "gauss"
    counts = multiple * np.array([1, *(_LADDER // 4)])
    counts = counts[(counts >= fewest) & (counts <= max(_MOST_SEGMENTS, multiple, fewest))]
    best, least = None, np.inf
    for stages in range(4, 13):
        way = method(kind, stages)
        errors = np.max(predicted_error(equation, way, counts[None]), axis=0)
        wave = 0.25 * equation.reach * equation.period / counts
        missed = 2.0 * np.exp(stages * np.log(np.maximum(wave, 1e-9)) - lgamma(stages + 1))
        enough = (_MARGIN * errors <= rtol) & (missed <= rtol if stiff else True)
        enough &= stages * counts >= 2 * equation.reach
        if np.any(enough):
            # Solving the stages of a segment: measured with nine and 27 freedoms.
            count = int(counts[np.argmax(enough)])
            if count * stages**2.2 < least:
                best, least = (way, count), count * stages**2.2
    if best is None:
        raise _too_fast(equation, int(np.argmax(np.max(equation.frequency, axis=1))))
    return best


def _too_fast(equation: Equation, member: int) -> BadInput:
    turned = float(np.max(equation.frequency[member])) * equation.period
    return bad(
        "speed",
        f"{equation.speed[member]:.6g} rad/s, where the highest mode turns through "
        f"{turned:.3g} rad in a period",
        f"at most about {4.0 * _MOST_SEGMENTS:.3g} rad",
        "raise the speed or leave out the highest modes",
    )


def refined(
    equation: Equation,
    way: Method,
    rtol: float,
    solve: Callable[[Equation, int], tuple[Array, ...]],
    distance: Callable[[tuple[Array, ...], tuple[Array, ...]], tuple[Array, Array]],
    *,
    tick: Callable[[int], None] | None = None,
) -> tuple[list[tuple[Array, ...]], Array, Whole]:
    """Solve every member on two neighbouring rungs, and on finer ones until they agree.

    ``solve`` goes from the equation of some members and a number of segments to arrays with one row
    each; ``distance`` from two solutions of some members, coarse and fine, to their difference and
    to what round-off adds to the errors of the fine ones, ``(nb, k)`` each; ``tick`` is called with
    how many members are done.  Returned are one solution for each member, the errors, ``(nb, k)``:
    the :func:`share` of the difference, and round-off, 1 where that is no number; and the number of
    segments that each solution has, ``(nb,)``.
    """
    nb = len(equation.speed)
    solutions: list[tuple[Array, ...]] = [()] * nb
    error: list[Array] = [np.zeros(0)] * nb
    segments = np.zeros(nb, dtype=np.int64)
    level, predicted = levels_for(equation, way, rtol)
    together = max(1, _BLOCK // (way.stages * equation.size) ** 2)
    finished, most = 0, _MOST_SEGMENTS if equation.harmonics >= 0 else _ROUGH_SEGMENTS
    for first in np.unique(level):
        group = np.flatnonzero(level == first)
        for begin in range(0, len(group), together):
            members = group[begin : begin + together]
            part = equation if len(members) == nb else equation.take(members)
            coarse, at = solve(part, rung(int(first) - 1)), int(first)
            before = earlier = np.full(len(members), np.inf)
            order = np.full(len(members), 0.5 * way.stages)
            while len(members):
                fine, likely = solve(part, rung(at)), predicted[members]
                change, rounding = distance(coarse, fine)
                whole = np.max(_finite(change + rounding), axis=1)
                if at > first:
                    fall = np.log(before / whole) / np.log(rung(at - 1) / rung(at - 2))
                    order = np.clip(fall, 0.0, way.stages)
                gaps = _finite(share(part, way, at, likely, order)[:, None] * change + rounding)
                gap = np.max(gaps, axis=1)
                # Round-off, where all modes are resolved and two rungs gained nothing.
                stuck = (whole > 0.5 * np.minimum(before, earlier)) & (likely[:, at] < rtol)
                stuck &= before > 0.5 * earlier
                done = (gap <= rtol) | (stuck & (equation.harmonics >= 0))
                done |= at + 1 >= _RUNGS or rung(at + 1) > most
                for i in np.flatnonzero(done):
                    solutions[members[i]] = tuple(array[i] for array in fine)
                    error[members[i]], segments[members[i]] = gaps[i], rung(at)
                finished += int(np.count_nonzero(done))
                if tick is not None:
                    tick(finished)
                if np.all(done):
                    break
                keep = np.flatnonzero(~done)
                members, before, earlier = members[keep], whole[keep], before[keep]
                order, at, part = order[keep], at + 1, part.take(keep)
                coarse = tuple(array[keep] for array in fine)
    return solutions, np.array(error), segments


def _finite(error: Array) -> Array:
    """Return errors; 1 where they are no numbers."""
    return np.where(np.isfinite(error), error, 1.0)
