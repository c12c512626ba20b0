"""Invariants of several modes, line by line: a whole line of speeds from one series of the turn."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.families import DAMPING, Array
from ...periodic.equation import SPEED_POWER
from ...periodic.first_order import CanonicalForm, canonical_form
from .characteristic import weighed_characteristic
from .invariants import from_sum, sum_weights_back
from .sampling import Sampler
from .turn_series import Turn, TurnSeries, mirrored_sums

# Another number of stretches gives another solution; the difference, over-estimated, is the error.
_OTHER, _MARGIN = 1.37, 4.0


State = tuple[int | None, tuple[Array, Array] | None]


@dataclass(frozen=True)
class Line:
    """The system at one value of the outer axis, for all values of the inner one."""

    pieces: tuple[TurnSeries, ...]
    reduced: bool

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Return invariants ``(n, k)`` at values of the variable, and the weight of errors of each.

        The weight is by how much an error of relative size 1 in the matrices moves an invariant.
        Where the growth overflows the invariants are infinite, with the sign of the first.
        """
        if len(self.pieces) == 1:
            return self._of(self.pieces[0], values)
        found = [
            self._of(piece, values[i : i + 1]) for i, piece in enumerate(self.pieces)
        ]  # one piece per value
        return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])

    def _of(self, series: TurnSeries, values: Array) -> tuple[Array, Array]:
        plain, power = series.products(values)
        with np.errstate(over="ignore", invalid="ignore"):
            matrices = np.ldexp(plain, power[:, None, None])
            if series.half:
                n = plain.shape[-1] // 2
                sums = 2.0 * mirrored_sums(matrices)
                change = n + 4.0 * _norm(matrices[:, :n, n:]) * _norm(matrices[:, n:, :n])
                found, weight = weighed_characteristic(sums, n, change)
                found, weight = from_sum(found), weight @ sum_weights_back(n)
            else:
                wanted = plain.shape[-1] // (2 if self.reduced else 1)
                found, weight = weighed_characteristic(matrices, wanted)
        finite = np.all(np.isfinite(found) & np.isfinite(weight), axis=-1)
        if not np.all(finite):
            grown = ~finite & np.all(np.isfinite(plain), axis=(-2, -1))
            sign = _sign_of_trace(plain, series.half)
            found[~finite], weight[~finite] = np.nan, np.inf
            found[grown] = np.where(sign[grown] > 0, -np.inf, np.inf)[:, None]
        return found, weight


def _norm(matrices: Array) -> Array:
    value: Array = np.sqrt(np.sum(matrices * matrices, axis=(-2, -1)))
    return value


def _sign_of_trace(matrices: Array, half: bool) -> Array:
    """Return the sign of the trace of matrices, or of what half a turn's are half of."""
    if half:
        matrices = mirrored_sums(matrices) - np.eye(matrices.shape[-1] // 2)
    value: Array = np.sign(np.trace(matrices, axis1=-2, axis2=-1))
    return value


class Lines:
    """Makes the lines of a chart.

    The inner axis is the speed where that is one of the axes; of two others one that is no
    geometry, for which the system is made anew at each value.
    """

    def __init__(self, sampler: Sampler) -> None:
        self.system, self.names = sampler.system, sampler.names
        self.back, self.reduced, self.damped = sampler.back, sampler.reduced, sampler.damped
        self.inner = self.names.index("speed") if "speed" in self.names else 0
        if self.names[self.inner] in self.system.geometry:
            self.inner = 1
        self.degree = self._degree()
        self.leaves: int | None = None
        self.modes: tuple[Array, Array] | None = None

    @property
    def state(self) -> State:
        """What one line leaves for the next: its modal coordinates and number of nodes."""
        return self.leaves, self.modes

    @state.setter
    def state(self, state: State) -> None:
        self.leaves, self.modes = state

    def begun(self, state: State) -> Lines:
        """Return the same lines with what another one has left."""
        found = copy(self)
        found.state = state
        return found

    @property
    def inner_is_geometry(self) -> bool:
        """Whether the system is made anew at each point."""
        return self.names[self.inner] in self.system.geometry

    def line(self, outer: float, low: float, high: float, values: Array | None = None) -> Line:
        """Return the line at a value of the outer axis.

        Parameters
        ----------
        outer : float
            Value of the outer axis.
        low, high : float
            Ends of the variable of the inner axis.
        values : ndarray, optional
            Where both axes are geometry: the values at which the line will be wanted.
        """
        return self._line(outer, low, high, values, 1.0)

    def error(self, outer: float, low: float, high: float, values: Array, found: Array) -> Array:
        """Return by how much another solution differs from invariants, over the weight of errors.

        One figure per value; 0 where either overflows, infinite where either is NaN.
        """
        again, weight = self._line(outer, low, high, values, _OTHER)(values)
        grown = np.isinf(again) | np.isinf(found)
        with np.errstate(invalid="ignore"):
            gap = np.where(grown, 0.0, np.abs(again - found) / weight)
        worst: Array = np.max(np.where(np.isnan(gap), np.inf, gap), axis=-1)
        return _MARGIN * worst

    def _line(
        self, outer: float, low: float, high: float, values: Array | None, fineness: float
    ) -> Line:
        inner_name, outer_name = self.names[self.inner], self.names[1 - self.inner]
        fixed = {outer_name: float(outer)}
        if inner_name in self.system.geometry:
            if values is None:
                raise ValueError("a line along geometry wants its values beforehand")
            pieces = tuple(
                self._series({**fixed, inner_name: float(v)}, None, v, v, fineness) for v in values
            )
            return Line(pieces, self.reduced)
        return Line((self._series(fixed, inner_name, low, high, fineness),), self.reduced)

    def _degree(self) -> int | None:
        """Return the degree of the generator in the variable of the speed; None where unknown."""
        if self.names[self.inner] != "speed":
            return None
        found = {
            -(SPEED_POWER[term.array] + term.power)
            for term in self.system.terms
            if term.array in ("B", "K", "Kg") or (self.damped and term.array in DAMPING)
        }
        fixed = all(term.power == 0 for term in self.system.terms if term.array in ("M", "A"))
        if not fixed or min(found, default=0) < 0:
            return None
        if self.damped:
            return max(found, default=0)
        return max(found) // 2 if found and all(k % 2 == 0 for k in found) else None

    def _series(
        self,
        fixed: dict[str, float],
        inner: str | None,
        low: float,
        high: float,
        fineness: float,
    ) -> TurnSeries:
        shape = {k: v for k, v in fixed.items() if k in self.system.geometry}
        system = self.system.with_geometry(**shape) if shape else self.system
        rest = {k: v for k, v in fixed.items() if k not in shape}

        def form_at(values: Array) -> CanonicalForm:
            point: dict[str, Any] = {**rest}
            if inner is not None:
                point[inner] = self.back(inner, values)
            speed = np.broadcast_to(point.pop("speed", 1.0), values.shape)
            return canonical_form(system, speed, point, probed=not shape)

        turn = Turn(
            form_at,
            low,
            high,
            symplectic=self.reduced,
            fineness=fineness,
            modes=self.modes,
            degree=self.degree,
        )
        self.modes = turn.modes
        series = turn.series(self.leaves)
        if series.low < series.high:
            self.leaves = len(series.stretches)
        return series
