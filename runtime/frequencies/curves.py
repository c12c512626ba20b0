"""Curves of natural frequencies over the crank angle, relabelled at each crossing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .eigenproblem import assurance
from .encounters import Modes
from .tracking import Walk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Shapes at a crossing are taken this far from it, over the period: there any mixture is one.
_ASIDE = 1e-7


@dataclass(frozen=True)
class Curves:
    """Which curve each rank belongs to; curves are numbered from 0 by rank at a first angle.

    Attributes
    ----------
    path : Walk
        A turn with its crossings.
    start : float
        First angle [rad].
    size, count : int
        Number of ranks, and of curves asked for.
    period : float
        Period [rad].
    """

    path: Walk
    start: float
    size: int
    count: int
    period: float

    @cached_property
    def _passed(self) -> tuple[Array, Indices]:
        """Angles of the crossings after the first angle, and the labels between them."""
        crossings = [one for one in self.path.encounters if one.kind == "crossing"]
        after = np.array([(one.angle - self.start) % self.period for one in crossings])
        order = np.argsort(after, kind="stable")
        label = [np.arange(self.size)]
        for index in order:
            new = label[-1].copy()
            k = crossings[index].lower - 1
            new[[k, k + 1]] = new[[k + 1, k]]
            label.append(new)
        return after[order], np.stack(label)

    @property
    def highest(self) -> int:
        """Highest rank, from 0, that a curve asked for reaches."""
        _, label = self._passed
        ranks = np.argsort(label, axis=1)
        return int(np.max(ranks[:, : self.count]))

    @property
    def closure(self) -> Indices:
        """Which curve each of those asked for becomes after a whole turn."""
        # The curve that ends at rank r goes on as the curve that begins there.
        ranks: Indices = np.argsort(self._passed[1][-1])
        return ranks[: self.count]

    @property
    def turns(self) -> int:
        """Whole turns after which every curve asked for has come back."""
        step = np.argsort(self._passed[1][-1])
        found = 1
        for curve in range(self.count):
            length, at = 1, int(step[curve])
            while at != curve:
                length, at = length + 1, int(step[at])
            found = math.lcm(found, length)
        return found

    def labels(self, theta: Array) -> Indices:
        """Return the curve at each rank at crank angles, ``(nt, size)``."""
        after, label = self._passed
        turns = np.floor((theta - self.start) / self.period).astype(int)
        rest = theta - self.start - turns * self.period
        out = label[np.searchsorted(after, rest, side="right")]
        begun = label[-1]
        for turn in np.unique(turns[turns != 0]):
            step = begun if turn > 0 else np.argsort(begun)
            whole = np.arange(self.size)
            for _ in range(abs(int(turn))):
                whole = step[whole]
            rows = turns == turn
            out[rows] = whole[out[rows]]
        return out

    def follow(self, theta: Array, values: Array) -> Array:
        """Return values by rank ``(nt, size)`` along the curves asked for, ``(nt, count)``."""
        ranks = np.argsort(self.labels(theta), axis=1)[:, : self.count]
        return np.take_along_axis(values, ranks, axis=1)


def followed_shapes(modes: Modes, curves: Curves, theta: Array) -> tuple[Array, Array]:
    """Return shapes along the curves, ``(nt, n, count)``, and their sign after a turn.

    Their sign is steady within a turn from the first angle on.
    """
    period = curves.period
    turns = np.floor((theta - curves.start) / period)
    rest = theta - curves.start - turns * period
    rest = np.where((rest == 0.0) & (turns == 1.0), period, rest)
    own = (curves.path.theta - curves.start) % period
    places = np.unique(np.concatenate([rest, own, [0.0, period]]))
    aside = curves.start + places
    for one in curves.path.encounters:
        off = (aside - one.angle + period / 2) % period - period / 2
        near = (one.kind == "crossing") & (np.abs(off) < _ASIDE * period)
        aside = np.where(near, aside - off + _ASIDE * period * np.where(off < 0, -1, 1), aside)
    held = modes(aside)
    ranks = np.argsort(curves.labels(aside), axis=1)[:, : curves.count]
    shape = np.take_along_axis(held.shape, ranks[:, None, :], axis=2)
    middle = 0.5 * (held.mass[1:] + held.mass[:-1])
    root = assurance(shape[:-1], shape[1:], middle, squared=False)
    step = np.where(np.diagonal(root, axis1=-2, axis2=-1) < 0, -1.0, 1.0)
    sign = np.concatenate([np.ones((1, curves.count)), np.cumprod(step, axis=0)])
    shape = shape * sign[:, None, :]
    back = assurance(shape[0], shape[-1], held.mass[0], squared=False)
    turned = np.where(np.diagonal(back) < 0, -1.0, 1.0)
    return shape[np.searchsorted(places, rest)], turned
