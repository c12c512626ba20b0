"""Periodic motions at many speeds from a few factorisations.

At some speeds, the nodes, the balanced matrix is factorised and the motion's Taylor series in the
speed found.  Between two nodes the equation is projected on both series: a rational function of
the speed, exact to their orders at both ends.  What it leaves of the equation, answered by the
nearer factorisation, is added, and tells the error; where that is too large a node is put in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .balance import Balance
from ..core.trigonometric import Array

# Vectors of each node's Taylor series.
_ORDERS = 16
# Speeds over the lowest of two nodes apart to begin with.
_FIRST_STEP = 0.07
_MOST_NODES = 2000
# Beyond it a Taylor vector is taken for a combination of others.
_DEPENDENT = 1e-9

Map = Callable[[Callable[..., Any], Iterable[Any]], Iterable[Any]]


@dataclass(frozen=True)
class Motions:
    """Fourier series of periodic motions.

    Attributes
    ----------
    series : ndarray
        Coefficients in the balance's basis, shape ``(d, ns)``.
    error : ndarray
        Norm of the last correction over that of the motion, shape ``(ns,)``.
    nodes : ndarray
        The speeds at which a matrix was factorised.
    """

    series: Array
    error: Array
    nodes: Array


@dataclass(frozen=True)
class _Node:
    """A factorised speed: LU, Taylor vectors, and every P_k times them."""

    speed: float
    factors: tuple[Array, NDArray[np.int32]]
    vectors: Array
    images: dict[int, Array]

    def solve(self, right: Array, trans: Literal[0, 1] = 0) -> Array:
        """Solve with the factorised matrix, or with its transpose."""
        from scipy.linalg import lu_solve

        # SciPy counts the pivots up and down again in place: two threads must not share them.
        lower, pivots = self.factors
        found = lu_solve((lower, pivots.copy()), right, trans=trans, check_finite=False)
        return np.asarray(found)


def motions(balance: Balance, speeds: Array, rtol: float, run: Map = map) -> Motions:
    """Return the periodic motions at speeds.

    Parameters
    ----------
    balance : Balance
        The balanced equation.
    speeds : ndarray, shape (ns,)
        Speeds [rad/s], rising.
    rtol : float
        Wanted norm of the last correction over that of the motion.
    run : callable
        Maps a function over independent pieces of work, in order; as :func:`map` does.
    """
    ends = float(speeds[0]), float(speeds[-1])
    count = 2 + int(np.log(ends[1] / ends[0]) / _FIRST_STEP)
    wanted = [float(w) for w in np.geomspace(*ends, count)] if ends[1] > ends[0] else [ends[0]]
    nodes: dict[float, _Node] = {}
    series, error = np.empty((balance.size, len(speeds))), np.full(len(speeds), np.inf)
    fresh = wanted
    while fresh and len(nodes) + len(fresh) <= _MOST_NODES:
        made = run(_Factoriser(balance), fresh)
        nodes.update(zip(fresh, made, strict=True))
        known = sorted(nodes)
        pairs = list(pairwise(known)) or [(known[0], known[0])]
        due = [p for p in pairs if p[0] in fresh or p[1] in fresh]
        pieces = [_inside(speeds, pair, known[-1]) for pair in due]
        jobs = [
            (nodes[a], nodes[b], speeds[piece]) for (a, b), piece in zip(due, pieces, strict=True)
        ]
        fresh = []
        for pair, piece, found in zip(due, pieces, run(_Between(balance), jobs), strict=True):
            series[:, piece], error[piece] = found
            worst = _worst(speeds[piece], error[piece], pair)
            if worst is not None and worst[1] > rtol:
                fresh.append(worst[0])
    return Motions(series, error, np.array(sorted(nodes)))


def _inside(speeds: Array, pair: tuple[float, float], last: float) -> slice:
    begin = int(np.searchsorted(speeds, pair[0], side="left"))
    side: Literal["left", "right"] = "right" if pair[1] == last else "left"
    return slice(begin, int(np.searchsorted(speeds, pair[1], side=side)))


def _worst(speeds: Array, error: Array, pair: tuple[float, float]) -> tuple[float, float] | None:
    """Return the speed of the largest error between two nodes and that error."""
    inner = (speeds > pair[0]) & (speeds < pair[1])
    if not np.any(inner):
        return None
    place = int(np.argmax(np.where(inner, error, -1.0)))
    return float(speeds[place]), float(error[place])


class _Factoriser:
    """From a speed to its node."""

    def __init__(self, balance: Balance) -> None:
        self.balance = balance

    def __call__(self, speed: float) -> _Node:
        from scipy.linalg import lu_factor, lu_solve

        balance = self.balance
        # Of the Taylor series of the matrix two derivatives are nearly all: the vectors need not
        # be exact.
        matrix, first, second = balance.taylor(speed, 3)
        factors = lu_factor(matrix, overwrite_a=True, check_finite=False)
        vectors: list[Array] = []
        for order in range(_ORDERS):
            right = balance.load(speed, order)
            if order:
                right = right - first @ vectors[-1]
            if order > 1:
                right = right - second @ vectors[-2]
            vectors.append(lu_solve(factors, right, check_finite=False))
        stacked = np.stack(vectors, axis=1)
        stacked /= np.linalg.norm(stacked, axis=0)
        images = dict(zip(balance.powers, balance.matrices @ stacked, strict=True))
        return _Node(speed, factors, stacked, images)


class _Between:
    """From two nodes and the speeds between to the motions there and their corrections."""

    def __init__(self, balance: Balance) -> None:
        self.balance = balance

    def __call__(self, job: tuple[_Node, _Node, Array]) -> tuple[Array, Array]:
        left, right, speeds = job
        if not len(speeds):
            return np.empty((len(left.vectors), 0)), np.empty(0)
        span = np.hstack([left.vectors, right.vectors])
        basis, sizes, turned = np.linalg.svd(span, full_matrices=False)
        kept = sizes > _DEPENDENT * sizes[0]
        basis = basis[:, kept]
        mixed = turned[kept].T / sizes[kept]
        images = {
            k: np.hstack([image, right.images[k]]) @ mixed for k, image in left.images.items()
        }
        middle = np.sqrt(left.speed * right.speed)
        found, error = np.empty((len(span), len(speeds))), np.empty(len(speeds))
        for node, part in ((left, speeds < middle), (right, speeds >= middle)):
            if np.any(part):
                found[:, part], error[part] = self._near(node, basis, images, speeds[part])
        return found, error

    def _near(
        self, node: _Node, basis: Array, images: dict[int, Array], speeds: Array
    ) -> tuple[Array, Array]:
        # Tested with what the factorisation turns into the basis: the projected matrix is near
        # to the unit matrix near the node, so that no resonance is made up.
        test = node.solve(basis, trans=1).T
        loads = self.balance.loads
        matrix = sum(
            (speeds[:, None, None] ** k * (test @ image) for k, image in images.items()),
            start=np.zeros(()),
        )
        load = sum(
            (speeds[:, None] ** k * (test @ v) for k, v in loads.items()), start=np.zeros(())
        )
        weights = np.linalg.solve(matrix, load[..., None])[..., 0]
        rest = sum((np.outer(v, speeds**k) for k, v in loads.items()), start=np.zeros(()))
        for k, image in images.items():
            rest = rest - image @ (weights * speeds[:, None] ** k).T
        correction = node.solve(rest)
        motion = basis @ weights.T + correction
        size = np.linalg.norm(motion, axis=0)
        return motion, np.linalg.norm(correction, axis=0) / size
