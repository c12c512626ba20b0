"""Invariants of several modes, line by line: a whole line of speeds from one table of segments."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.families import Array
from ...periodic.equation import Equation, SampledSystem, equation_of, sampled
from ...periodic.tables import Table, table_of
from ...periodic.transition import levels_for, method, rung
from .characteristic import weighed_characteristic
from .invariants import from_sum, sum_weights_back
from .sampling import Sampler

# Another number of segments gives another solution; the difference, over-estimated, is the error.
_OTHER, _MARGIN = 1.37, 4.0
# Wanted error of the matrices, and what mirrored coefficients may differ, over the largest.
_RTOL, _ALIKE = 1e-12, 1e-13
# Places along a line at which the number of segments is judged.
_JUDGED = 5
# Stages among which the cheapest are taken.
_STAGES = (4, 5, 6, 8, 10)
# Chebyshev nodes of a line to begin with.
_NODES = 20


@dataclass(frozen=True)
class Piece:
    """Transition matrices over values of the variable, of a period or of half of one."""

    table: Table
    segments: int
    half: bool


@dataclass(frozen=True)
class Line:
    """The system at one value of the outer axis, for all values of the inner one."""

    pieces: tuple[Piece, ...]
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

    def _of(self, piece: Piece, values: Array) -> tuple[Array, Array]:
        plain, power = piece.table.products(values)
        with np.errstate(over="ignore", invalid="ignore"):
            matrices = np.ldexp(plain, power[:, None, None])
            if piece.half:
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
            sign = _sign_of_trace(plain, piece.half)
            found[~finite], weight[~finite] = np.nan, np.inf
            found[grown] = np.where(sign[grown] > 0, -np.inf, np.inf)[:, None]
        return found, weight


def mirrored_sums(halves: Array) -> Array:
    """Return P with ``X + X^-1 = diag(2 P, 2 P^T)``, X over a period that is its own mirror image.

    With F = [[a, b], [c, d]] over half a period and R = diag(1, -1), ``X = R F^-1 R F``; F is
    symplectic, so that the upper left block of X is ``1 + 2 b^T c``, and X^-1 = R X R.

    Parameters
    ----------
    halves : ndarray
        F, shape ``(..., 2n, 2n)``.

    Returns
    -------
    ndarray, shape (..., n, n)
        Its eigenvalues are those of ``(rho + 1/rho) / 2``, each once.
    """
    n = halves.shape[-1] // 2
    cross = np.swapaxes(halves[..., :n, n:], -1, -2) @ halves[..., n:, :n]
    value: Array = np.eye(n) + 2.0 * cross
    return value


def is_mirrored(equation: Equation) -> bool:
    """Return whether a system is the same after a reversal of the crank.

    Mass and stiffness are even functions of the angle then, A is odd, and nothing is damped.
    """
    if equation.damped or equation.harmonics < 0:
        return False
    angles = equation.even_angles()
    for name in equation.fields:
        value = equation.at(name, angles)
        # A constant has one place.
        back = value if value.shape[1] == 1 else np.roll(value[:, ::-1], 1, axis=1)
        odd = -1.0 if name == "gyroscopic" else 1.0
        if not np.max(np.abs(value - odd * back)) <= _ALIKE * np.max(np.abs(value)):
            return False
    return True


def _norm(matrices: Array) -> Array:
    value: Array = np.sqrt(np.sum(matrices * matrices, axis=(-2, -1)))
    return value


def _sign_of_trace(matrices: Array, half: bool) -> Array:
    """Return the sign of the trace of matrices, or of what half a period's are half of."""
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
        self.back, self.reduced = sampler.back, sampler.reduced
        self.inner = self.names.index("speed") if "speed" in self.names else 0
        if self.names[self.inner] in self.system.geometry:
            self.inner = 1
        # The system of all lines; none where each line has its own.
        self.known: SampledSystem | None = None

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

        One number per value; 0 where either overflows, infinite where either is NaN.
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
                self._piece({**fixed, inner_name: float(v)}, None, v, v, fineness) for v in values
            )
            return Line(pieces, self.reduced)
        return Line((self._piece(fixed, inner_name, low, high, fineness),), self.reduced)

    def _sampled(self, geometry: dict[str, float]) -> SampledSystem:
        """Return the system at a geometry with its Fourier series."""
        if geometry:
            return sampled(self.system.with_geometry(**geometry))
        if self.known is None:
            self.known = sampled(self.system)
        return self.known

    def _piece(
        self,
        fixed: dict[str, float],
        inner: str | None,
        low: float,
        high: float,
        fineness: float,
    ) -> Piece:
        geometry = {k: v for k, v in fixed.items() if k in self.system.geometry}
        known = self._sampled(geometry)
        rest = {k: v for k, v in fixed.items() if k not in geometry}

        def plain(values: Array) -> Equation:
            point: dict[str, Any] = {**rest}
            if inner is not None:
                point[inner] = self.back(inner, values)
            speed = np.broadcast_to(point.pop("speed", 1.0), values.shape)
            return equation_of(known, speed, point)

        judged = plain(np.linspace(low, high, _JUDGED if high > low else 1))
        unit = judged.scale[len(judged.scale) // 2]
        ways = [method("radau" if judged.damped else "gauss", stages) for stages in _STAGES]
        counts = [rung(int(np.max(levels_for(judged, way, _RTOL)))) for way in ways]
        # Solving the stages of a segment: between the square and the cube of their number.
        work = [count * way.stages**2.5 for count, way in zip(counts, ways, strict=True)]
        best = int(np.argmin(work))
        way, count = ways[best], counts[best]
        # A multiple of 16 can be multiplied by pairs, of half a period too.
        count = 16 * int(np.ceil(fineness * count / 16))

        def equation_at(values: Array) -> Equation:
            made = plain(values)
            return replace(made, scale=np.broadcast_to(unit, made.scale.shape))

        half = self.reduced and is_mirrored(judged)
        table = table_of(equation_at, (low, high), count, way, _RTOL, half=half, nodes=_NODES)
        return Piece(table, count, half)
