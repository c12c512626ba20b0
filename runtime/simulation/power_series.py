"""Marching by power series: stretches as long as the motion allows, any angle inside them given.

A revolution is cut into stretches over which the fastest mode turns by some radians.  Over each the
matrix solution is a power series about the middle, all stretches found together; the given angles
inside a stretch, or the stretches between two given angles, are products.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..periodic.first_order import CanonicalForm
from ..periodic.transition import product as ordered_product
from ..stretches import stretch_maps
from ..stretches.power_series import MOST_TERMS
from .generator_series import Expansion, GeneratorSeries, expansion, generator_series
from .marching import MODERATE, Grid, March, Tick, cyclic, scaled_state, symplectic_defect, up_to

Array = NDArray[np.float64]

# How far the fastest mode turns within a stretch [rad]: in the motion, and in the other one that
# tells its error.
_PHASE, _LONG_PHASE = 4.0, 6.0
# Stretches of a revolution: fewest, and most.
_FEWEST, _MOST_STRETCHES = 4.0, 2**20
# Numbers held in one part of the work.
_BLOCK_FLOATS = 600_000
_CHUNK_FLOATS = 4_000_000


@dataclass(frozen=True)
class PowerSeries:
    """How to solve one system by power series.

    Attributes
    ----------
    form : CanonicalForm
        A batch of one.
    series : GeneratorSeries
        Its generator.
    unit : float
        Power of two that the last component of a forced state is divided by, so that its column
        of the generator is as large as the rates.
    """

    form: CanonicalForm
    series: GeneratorSeries
    unit: float

    @classmethod
    def of(cls, form: CanonicalForm) -> PowerSeries | None:
        """Return it for a system; None where no Fourier series resolves the generator."""
        series = generator_series(form)
        return None if series is None else _with_unit(form, series)

    def stretches(self, grid: Grid, fineness: float = 1.0, above: int = 0) -> int | None:
        """Return how many stretches a revolution needs: a divisor or a multiple of its intervals.

        None where even a great many are too long for the coefficients.

        Parameters
        ----------
        grid : Grid
            Given angles.
        fineness : float
            Factor on their number.
        above : int
            A number that is too few.
        """
        return self._count(grid, _PHASE / fineness, above)

    def another(self, grid: Grid, beside: int) -> int | None:
        """Return another number that does as well: if possible a smaller one."""
        count = self._count(grid, _LONG_PHASE, 0)
        return count if count != beside else self.stretches(grid, above=beside)

    def _count(self, grid: Grid, phase: float, above: int) -> int | None:
        each, rate = grid.per_revolution, float(self.form.rate[0])
        count = _admissible(each, max(2 * pi * rate / phase, _FEWEST, 1.5 * above, above + 1.0))
        while count <= _MOST_STRETCHES:
            if self.series.powers(pi / count) is not None:
                return count
            count = _admissible(each, max(1.15 * count, count + 1.0))
        return None

    def march(
        self,
        grid: Grid,
        start: tuple[Array, Array],
        bound: float,
        count: int,
        tick: Tick | None = None,
        *,
        slopes: bool = True,
    ) -> March | None:
        """March from a start; None where the series of some stretch does not end.

        Parameters
        ----------
        grid : Grid
            Given angles; its steps are not used.
        start : pair of ndarray
            Coordinates and d/dtheta, ``(n,)`` each.
        bound : float
            Where to stop: the first state beyond is the last that is given, if it is finite.
        count : int
            Stretches of a revolution, of :meth:`stretches`.
        tick : callable, optional
            Told the number of intervals done.
        slopes : bool
            Whether all of the motion is wanted, or its coordinates alone.
        """
        n = self.form.system.size
        powers = self.series.powers(pi / count)
        if powers is None:
            return None
        made = expansion(self.series, pi / count, powers)
        run = _Run(self, grid, made, count, bound / self.form.scale[0][:n])
        state = scaled_state(self.form, grid.start, *start)
        if self.form.forced:
            state[-1] = 1.0 / self.unit
        states = run.run(state, tick)
        if states is None:
            return None
        coordinates = states[:, :n] * self.form.scale[0][:n]
        if not slopes:
            return March(coordinates, states[:0, :n], None, float("nan"))
        return March(coordinates, self._slopes(grid, states), run.volume(), run.defect(n))

    def _slopes(self, grid: Grid, states: Array) -> Array:
        """Return dq/dtheta at the given angles, ``(nt, n)``."""
        n, each = self.form.system.size, grid.per_revolution
        theta = grid.theta[: len(states)]
        repeats = cyclic(self.form)
        found = np.empty((len(states), n))
        together = max(1, _CHUNK_FLOATS // self.form.size**2)
        for first in range(0, min(each, len(theta)) if repeats else len(theta), together):
            last = min(first + together, each) if repeats else first + together
            rows = self.series(theta[first:last])[:, :n]
            step = each if repeats else len(theta)
            for begin in range(first, len(theta), step):
                own = slice(begin, min(begin + last - first, len(theta)))
                part = states[own]
                found[own] = (rows[: len(part)] @ part[:, :, None])[:, :, 0]
        scaled: Array = found * self.form.scale[0][:n]
        return scaled


def _with_unit(form: CanonicalForm, series: GeneratorSeries) -> PowerSeries:
    if not form.forced:
        return PowerSeries(form, series, 1.0)
    m = form.size
    column = slice(m - 1, m * m, m)
    largest = np.abs(series.mean[column]) + np.sum(np.abs(series.waves[:, column]), axis=0)
    top = float(np.max(largest))
    unit = float(2.0 ** np.round(np.log2(float(form.rate[0]) / top))) if top > 0.0 else 1.0
    factors = np.ones((m, m))
    factors[:, -1], factors[-1] = unit, 0.0
    flat = factors.ravel()
    scaled = GeneratorSeries(
        series.mean * flat,
        series.waves * flat,
        series.period,
        m,
        series.missed,
        np.where(flat > 0.0, series.tops * flat, 1.0),
    )
    return PowerSeries(form, scaled, unit)


def _admissible(each: int, wanted: float) -> int:
    """Return the smallest divisor of the intervals, or multiple of them, that is enough."""
    if wanted > each:
        return each * int(np.ceil(wanted / each))
    return next(k for k in range(int(np.ceil(wanted)), each + 1) if each % k == 0)


class _Run:
    """Maps of the blocks of a revolution, made once where they repeat, and the states."""

    def __init__(
        self, solver: PowerSeries, grid: Grid, made: Expansion, count: int, bound: Array
    ) -> None:
        self._grid, self._bound, self._expansion = grid, bound, made
        self._repeats = cyclic(solver.form)
        self._count = count
        # A block is a stretch with some given angles, or several stretches up to the next one.
        self._inside = max(1, grid.per_revolution // count)
        self._merged = max(1, count // grid.per_revolution)
        self._blocks: Array | None = None
        self._flows: Array | None = None
        self._determinants: list[Array] = []
        self._state = 2 * solver.form.system.size

    def run(self, state: Array, tick: Tick | None) -> Array | None:
        """Return the scaled states at the given angles, fewer where one passed the bound."""
        grid, m = self._grid, len(state)
        pieces, done = [state[None]], 0
        while done < grid.intervals:
            number = min(grid.per_revolution, grid.intervals - done)
            if self._blocks is None or not self._repeats:
                self._determinants.clear()
                self._blocks = self._maps(done, number)
                if self._blocks is None:
                    return None
                self._flows = _flows(self._blocks)
            if self._repeats and self._flows is not None:
                turns = max(1, _CHUNK_FLOATS // (m * grid.per_revolution))
                number = min(turns * grid.per_revolution, grid.intervals - done)
            piece = self._advance(state, number)
            piece, stopped = up_to(piece, self._bound)
            pieces.append(piece)
            if stopped:
                break
            state = piece[-1]
            done += number
            if tick is not None:
                tick(done)
        return np.concatenate(pieces)

    def volume(self) -> float:
        """Return the logarithm of the determinant over the whole march."""
        stretches = self._merged * self._grid.intervals / self._inside
        return float(np.mean(np.concatenate(self._determinants))) * stretches

    def defect(self, n: int) -> float:
        """Return the largest relative symplectic defect of a block."""
        return 0.0 if self._blocks is None else symplectic_defect(self._blocks[:, -1], n)

    def _advance(self, state: Array, number: int) -> Array:
        blocks, flows = self._blocks, self._flows
        assert blocks is not None
        m = len(state)
        with np.errstate(over="ignore", invalid="ignore"):
            if flows is not None:
                turns = -(-number // len(flows))
                starts = np.empty((m, turns))
                for k in range(turns):
                    starts[:, k] = state
                    state = flows[-1] @ state
                ahead = (flows.reshape(-1, m) @ starts).reshape(-1, m, turns)
                return np.moveaxis(ahead, 2, 0).reshape(-1, m)[:number]
            states = np.empty((len(blocks), self._inside, m))
            for k, block in enumerate(blocks):
                states[k] = block @ state
                state = states[k, -1]
        return states.reshape(-1, m)[:number]

    def _maps(self, done: int, number: int) -> Array | None:
        """Return the matrices from the left end of each block to its given angles.

        Shape ``(blocks, inside, m, m)``; None where a series does not end.
        """
        grid, m = self._grid, self._expansion.series.size
        width = 2 * pi / self._count
        blocks = -(-number // self._inside)
        tau = np.arange(1.0, self._inside + 1) * (2.0 / self._inside) - 1.0
        held = max(MOST_TERMS + self._expansion.powers, self._inside) * self._merged * m * m
        together = max(1, _BLOCK_FLOATS // held)
        first = grid.start + 2 * pi * (done / grid.per_revolution)
        found = np.empty((blocks, self._inside, m, m))
        for left in range(0, blocks, together):
            right = min(left + together, blocks)
            places = np.arange(left * self._merged, right * self._merged, dtype=np.float64)
            coefficients = self._expansion.about(first + width * (places + 0.5))
            maps = stretch_maps(coefficients, tau)
            if maps is None:
                return None
            # Of each stretch: that of several may be too small for a number.
            single = maps[:, -1, : self._state, : self._state]
            self._determinants.append(np.linalg.slogdet(single)[1])
            if self._merged > 1:
                product, power = ordered_product(maps.reshape(right - left, self._merged, m, m))
                maps = np.ldexp(product, power[:, None, None])[:, None]
            found[left:right] = maps
        return found


def _flows(blocks: Array) -> Array | None:
    """Return the matrices from the start of a revolution to each angle; None where they grow."""
    flow = np.eye(blocks.shape[-1])
    flows = np.empty_like(blocks)
    with np.errstate(over="ignore", invalid="ignore"):
        for k, block in enumerate(blocks):
            flows[k] = block @ flow
            flow = flows[k, -1]
    flat: Array = flows.reshape(-1, *flow.shape)
    return flat if np.max(np.abs(flat)) <= MODERATE else None
