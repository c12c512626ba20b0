"""Which modes and which harmonic a boundary of instability belongs to.

The modes are those of the averaged equation (mean coefficients) at the speed in question, numbered
by the size of their frequencies.  A mode's turns in a period are those of its own Hill equation,
all other modes at rest: where the periodic part is large its mean frequency is off by whole turns.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.trigonometric import even_angles
from ..periodic import floquet_multipliers
from ..periodic.equation import Equation, equation_of
from ..periodic.over_speed import MatricesOverSpeed
from .boundary_speeds import SpeedBoundaries
from .meetings import mean_exponents

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Whole = NDArray[np.int64]

# How far from its whole number a label may be [turns in a period].
_REACH = 2
_FORBIDDEN = 1e6
# Relative distance beside a boundary at which growth is looked for, and of boundaries that are
# the ends of a region too narrow to show it.
_BESIDE = 1e-8
# What it costs, in turns, that none of the motion at the ends of a region is of a mode.
_LACK = 4.0


class Modes(NamedTuple):
    """Modes at k speeds.

    ``turns`` ``(k, n)`` are those in a period of each multiplier of positive signature, negative
    where the mode has negative energy, NaN where the averaged equation is not stable; ``shapes``
    ``(k, n, n)`` the displacements in rows, of unit norm by the mean ``mass``.
    """

    turns: Array
    shapes: ComplexArray
    mass: Array


class Regions(NamedTuple):
    """Regions with their ends and labels, see :class:`~.edges.StabilityEdges`.

    ``begin`` and ``end`` are as far as the region is known to reach: its ends where it has them,
    else the last speed at which it was seen.
    """

    lower: Array
    upper: Array
    error: Array
    begin: Array
    end: Array
    multiplier: ComplexArray
    modes: Whole
    harmonic: Whole
    detuning: Array
    kind: NDArray[np.str_]

    @classmethod
    def unlabelled(cls, ends: Array, error: Array, reach: Array, multiplier: Array) -> Regions:
        """Return regions without modes, principal ones where the multiplier is real.

        ``ends`` and ``reach``, from begin to end, are of shape ``(2, k)``.
        """
        k, turn = len(error), multiplier.astype(complex)
        modes, harmonic = np.zeros((k, 2), dtype=np.int64), np.zeros(k, dtype=np.int64)
        kind = np.where(turn.imag == 0.0, "principal", "sum")
        off = np.full(k, np.nan)
        (lower, upper), (begin, end) = ends, reach
        return cls(lower, upper, error, begin, end, turn, modes, harmonic, off, kind)

    def labelled(self, modes: Whole, harmonic: Whole, detuning: Array) -> Regions:
        """Return the same with labels."""
        return self._replace(modes=modes, harmonic=harmonic, detuning=detuning)

    @property
    def middle(self) -> Array:
        """Middle of each, or the one end that there is, or of where it was seen."""
        low = np.where(np.isfinite(self.lower), self.lower, self.upper)
        high = np.where(np.isfinite(self.upper), self.upper, self.lower)
        seen = 0.5 * (self.begin + self.end)
        return np.asarray(np.where(np.isfinite(low + high), 0.5 * (low + high), seen))

    def take(self, which: NDArray[Any]) -> Regions:
        """Return some of the regions, by their numbers, in the order given, or by a mask."""
        columns: Sequence[Any] = self
        return Regions(*(values[which] for values in columns))

    def overlapping(self, low: float, high: float) -> Regions:
        """Return those that reach into a range, by rising speed."""
        kept = np.flatnonzero((self.end >= low) & (self.begin <= high))
        return self.take(kept[np.argsort(self.middle[kept], kind="stable")])


def joined(first: Regions, second: Regions) -> Regions:
    """Return the regions of both."""
    return Regions(*(np.concatenate(both) for both in zip(first, second, strict=True)))


def averaged_modes(matrices: MatricesOverSpeed, speed: Array) -> Modes:
    """Return the modes of the averaged equation at speeds of shape ``(k,)``."""
    n = matrices.system.size
    if not len(speed):
        return Modes(np.zeros((0, n)), np.zeros((0, n, n), dtype=complex), np.zeros((0, n, n)))
    equation = equation_of(matrices.known, speed, matrices.parameters)
    values, vectors, sign = mean_exponents(equation)
    size, mass = np.abs(values), equation.mean("mass")
    own = (sign > 0) & (np.abs(values.real) <= 1e-7 * np.max(size, axis=1, keepdims=True))
    chosen = np.argsort(np.where(own, size, np.inf), axis=1, kind="stable")[:, :n]
    stable = np.flatnonzero(np.count_nonzero(own, axis=1) == n)
    turns, shapes = np.full((len(speed), n), np.nan), np.zeros((len(speed), n, n), dtype=complex)
    vectors, chosen = vectors[stable], chosen[stable]
    duals = np.take_along_axis(np.linalg.inv(vectors), chosen[:, :, None], axis=1).astype(complex)
    vectors = np.take_along_axis(vectors, chosen[:, None], axis=2)
    turns[stable] = _own_turns(equation.take(stable), vectors, duals)
    rows = np.swapaxes(vectors[:, :n], 1, 2)
    norm = np.sqrt(np.real(np.einsum("kji,kil,kjl->kj", rows.conj(), mass[stable], rows)))
    unit = equation.scale
    shapes[stable] = rows / norm[:, :, None] * unit[stable, None]
    return Modes(turns, shapes, mass / unit[:, :, None] / unit[:, None, :])


def _own_turns(equation: Equation, vectors: ComplexArray, duals: ComplexArray) -> Array:
    """Return the turns of each mode in a period, all others at rest, ``(k, n)``."""
    # With the motion v of a mode, and its row of the inverse as dual, y = c v + conj(c v) leaves c'
    # = i a c + b conj c of y' = L y.  In region n of this equation c makes n/2 turns.
    turned = np.zeros(vectors.shape[::2])
    if not len(turned):
        return turned
    fastest = max(float(np.max(part)) for part in (equation.frequency, equation.rate()))
    # Steps of constant coefficients, in which no mode turns by half a turn.
    count = max(len(equation.even_angles()), int(fastest * equation.period))
    step = equation.period / count
    # Images of c = 1 and of c = i.
    images = np.broadcast_to(np.array([1.0, 1.0j]), (*turned.shape, 2))
    for angles in np.array_split(step * (np.arange(count) + 0.5), count // 16):
        rates = equation.generator(angles)
        both = [
            np.einsum("kji,ktil,klj->tkj", duals, rates, part, optimize=True)
            for part in (vectors, vectors.conj())
        ]
        for a, b in zip(both[0].imag, both[1], strict=True):
            root = np.sqrt(np.abs(b) ** 2 - a**2 + 0j)
            even, odd = np.cosh(step * root).real, step * np.sinc(1j * step / np.pi * root).real
            slope = 1j * a[..., None] * images + b[..., None] * images.conj()
            moved = even[..., None] * images + odd[..., None] * slope
            turned += np.angle(moved[..., 0] / images[..., 0])
            # Their size tells nothing, and may overflow.
            images = moved / np.max(np.abs(moved), axis=-1, keepdims=True)
    # One motion turns as the multiplier does, to half a turn.
    (a, b), (c, d) = np.moveaxis(np.stack([images.real, images.imag]), -1, 1)
    sine = np.sqrt(np.maximum(-0.25 * (a - d) ** 2 - b * c, 0.0))
    phase = np.arctan2(sine, 0.5 * (a + d))
    near = [p + 2 * np.pi * np.round((turned - p) / (2 * np.pi)) for p in (phase, -phase)]
    first = np.abs(near[0] - turned) <= np.abs(near[1] - turned)
    return np.asarray(np.where(first, *near) / (2 * np.pi))


def meeting_labels(
    modes: Modes, phase: Array, shares: Array | None = None
) -> tuple[Whole, Whole, Array]:
    """Return modes ``(k, 2)`` from 1, the harmonic, and how far off, of meetings of two modes.

    The sum of the turns of the two is nearest to the harmonic, and their phases, of opposite signs,
    are nearest to that at which they meet; no two meetings get the same label.  0 where there is
    none.
    """
    pairs = np.stack(np.triu_indices(modes.turns.shape[1], 1))
    turns = modes.turns[:, pairs]
    total = np.sum(turns, axis=1)
    phases = [
        _apart(turns[:, a], phase[:, None]) + _apart(turns[:, b], -phase[:, None])
        for a, b in ((0, 1), (1, 0))
    ]
    cost = 0.5 * np.minimum(*phases)
    if shares is not None:
        cost = cost + _LACK * (1.0 - np.sum(shares[:, pairs], axis=1))
    numbers = np.round(total)[:, :, None] + np.arange(-_REACH, _REACH + 1)
    return _assigned(pairs, total, numbers, cost[:, :, None])


def principal_labels(turns: Array, real: Array, lack: Array) -> tuple[Whole, Whole, Array]:
    """Return modes ``(k, 2)``, number and how far off, of regions in which a mode meets itself.

    Region n of mode j has 2 Omega_j = n, below zero for negative energy.  No two regions get the
    same label; 0 where none is left, or the averaged equation has no modes.  Given are the turns
    ``(k, n)``, the multiplier +1 or -1, and what the motion lacks of being of each mode ``(k, n)``.
    """
    total, odd = 2 * turns, (real < 0)[:, None]
    numbers = (2 * np.round((total - odd) / 2) + odd)[:, :, None] + np.arange(-6, 7, 2)
    # Beyond one turn rather another mode than another number.
    beyond = np.maximum(0.0, np.abs(total[:, :, None] - numbers) - 1.0)
    pairs = np.tile(np.arange(turns.shape[1]), (2, 1))
    return _assigned(pairs, total, numbers, _LACK * (lack[:, :, None] + beyond))


def _assigned(
    pairs: NDArray[np.intp], total: Array, numbers: Array, cost: Array
) -> tuple[Whole, Whole, Array]:
    """Give each row a pair of modes ``(2, p)`` and a number, a label of its own, at least cost.

    It is that by which the turns of the pair in all, ``(k, p)``, are off the number, one of
    ``(k, p, c)``, and a further ``cost`` of each.
    """
    from scipy.optimize import linear_sum_assignment

    k = len(total)
    row, pair, choice = np.nonzero(np.isfinite(numbers))
    options = np.stack([pair, numbers[row, pair, choice].astype(np.int64)], axis=1)
    labels, column = np.unique(options, axis=0, return_inverse=True)
    table = np.full((k, len(labels)), _FORBIDDEN)
    table[row, column.ravel()] = (np.abs(total[:, :, None] - numbers) + cost)[row, pair, choice]
    rows, columns = linear_sum_assignment(table)
    known = table[rows, columns] < _FORBIDDEN
    rows, (pair, number) = rows[known], labels[columns[known]].T
    modes, harmonic = np.zeros((k, 2), dtype=np.int64), np.zeros(k, dtype=np.int64)
    off = np.full(k, np.nan)
    modes[rows], harmonic[rows] = pairs[:, pair].T + 1, np.abs(number)
    off[rows] = np.abs(total[rows, pair] - number)
    return modes, harmonic, off


def boundary_units(
    matrices: MatricesOverSpeed, modes: Modes, found: SpeedBoundaries
) -> NDArray[np.intp]:
    """Return the lower and the upper boundary of each principal region; -1 where one is missing."""
    owner = np.argmax(_shares(modes, found), axis=-1) if len(found.speed) else np.zeros(0, int)
    units: list[tuple[int, int]] = []
    for sign in (1, -1):
        own = np.flatnonzero(found.multiplier == sign)
        if len(own):
            # Before, between and behind the boundaries.
            speed = found.speed[own]
            ends = [speed[:1] * (1 - _BESIDE), speed[-1:] * (1 + _BESIDE)]
            places = np.concatenate([ends[0], 0.5 * (speed[1:] + speed[:-1]), ends[1]])
            units.extend(_paired(found, own, owner, real_beyond(matrices, places, sign)))
    return np.array(units, dtype=np.intp).reshape(-1, 2).T


def real_beyond(matrices: MatricesOverSpeed, speed: Array, sign: int) -> list[int]:
    """Return how many real multipliers of a sign are off the circle at some speeds."""
    values = floquet_multipliers(matrices.system, speed, **matrices.parameters)
    real = np.abs(values.multipliers.imag) <= 4 * values.error
    beyond = sign * values.multipliers.real > 1.0 + 4 * values.error
    return [int(number) for number in np.sum(real & beyond, axis=-1)]


def _paired(
    found: SpeedBoundaries, own: NDArray[np.intp], owner: NDArray[np.intp], count: list[int]
) -> list[tuple[int, int]]:
    """Pair boundaries so that as many regions cover each interval as multipliers are off there."""
    # A boundary behind which one more is off begins a region, another ends the last one begun,
    # rather one whose motion is mostly of the same mode.  Two that nearly coincide and change
    # nothing are a region of their own, or the end of one and the beginning of the next.
    begun, units = [-1] * count[0], list[tuple[int, int]]()

    def same(row: int) -> list[int]:
        return [k for k, first in enumerate(begun) if first >= 0 and owner[first] == owner[row]]

    def end(row: int) -> None:
        alike = same(row)
        first = begun.pop(alike[-1] if alike else -1) if begun else -1
        units.append((first, row))

    rows = own.tolist()
    i = 0
    while i < len(rows):
        row, step = rows[i], count[i + 1] - count[i]
        other = rows[i + 1] if i + 1 < len(rows) else row
        apart = found.speed[other] - found.speed[row]
        if other == row or apart > _BESIDE * found.speed[other]:
            # Growth may be too small to be seen.
            if step < 0 or (step == 0 and same(row)):
                end(row)
            else:
                begun.append(row)
            i += 1
            continue
        step = count[i + 2] - count[i]
        i += 2
        if step > 1:
            begun.extend((row, other))
        elif step < -1:
            end(row)
            end(other)
        # At a double boundary only rounding chooses the motions.
        elif owner[row] != owner[other] and same(row) and apart > sum(found.error[[row, other]]):
            end(row)
            begun.append(other)
        else:
            units.append((row, other))
    return units + [(row, -1) for row in begun if row >= 0]


def unit_labels(
    modes: Modes, found: SpeedBoundaries, units: NDArray[np.intp]
) -> tuple[Whole, Whole, Array]:
    """Return modes, number and how far off, of regions between pairs of boundaries ``(2, k)``."""
    known = units >= 0
    # A missing end is about where the outermost boundaries are, or beyond.
    turns = np.mean(modes.turns[np.where(known, units, [[0], [-1]])], axis=0)
    shares = _shares(modes, found)
    shares = shares / np.maximum(np.sum(shares, axis=-1, keepdims=True), 1e-300)
    lower, upper = np.where(known, units, units[::-1])
    lack = 1.0 - 0.5 * (shares[lower] + shares[upper])
    return principal_labels(turns, found.multiplier[upper], lack)


def _shares(modes: Modes, found: SpeedBoundaries) -> Array:
    """Return how much of the motion at each boundary each mode has, shape ``(k, n)``."""
    coefficients = 0.5 * (found.cosine - 1j * found.sine)
    weighted = coefficients @ modes.mass
    along = np.abs(np.einsum("kjn,khn->kjh", modes.shapes.conj(), weighted)) ** 2
    against = np.abs(np.einsum("kjn,khn->kjh", modes.shapes, weighted)) ** 2
    # A motion of negative turns has its shape at the harmonics below zero.
    share = np.where(modes.turns[:, :, None] < 0, against, along)
    # Two modes of one shape, whirling to and fro, differ by their harmonics.
    shift = np.where(found.multiplier == 1, 0.0, 0.5)
    number = np.arange(share.shape[-1]) + shift[:, None]
    gap = number[:, None, :] - np.abs(modes.turns)[:, :, None]
    return np.asarray(np.sum(share / (1.0 + gap**2), axis=-1))


def _apart(turns: Array, phase: Array) -> Array:
    """Return the distance of two phases in turns."""
    gap = turns - phase / (2 * np.pi)
    return np.abs(gap - np.round(gap))


# ---------------------------------------------------------------- modes with the crank held


def held_modes(matrices: MatricesOverSpeed, speed: Array) -> Modes:
    """Return the modes with the crank held: mean frequencies in turns, shapes at angle 0."""
    known, n, period = matrices.known, matrices.system.size, matrices.system.period
    if not len(speed):
        return Modes(np.zeros((0, n)), np.zeros((0, n, n), dtype=complex), np.zeros((0, n, n)))
    # Speeds at which frequencies with the crank held are computed; they change little.
    some = np.linspace(np.min(speed), np.max(speed), 65)
    squares, _ = equation_of(known, some).frozen_modes(even_angles(period, 64))
    mean = np.mean(np.sqrt(np.maximum(squares, 0.0)), axis=1) * some[:, None]
    frequency = np.stack([np.interp(speed, some, mean[:, j]) for j in range(n)], axis=1)
    equation, start = equation_of(known, speed), np.zeros(1)
    shapes, unit = equation.frozen_modes(start)[1][:, 0], equation.scale
    rows = np.swapaxes(unit[:, :, None] * shapes, -1, -2).astype(complex)
    mass = equation.at("mass", start)[:, 0] / unit[:, :, None] / unit[:, None, :]
    whole = period / (2 * np.pi)
    return Modes(frequency / speed[:, None] * whole, rows, np.broadcast_to(mass, rows.shape))


def pair_shares(
    matrices: MatricesOverSpeed, modes: Modes, speed: Array, met: ComplexArray
) -> Array:
    """Return the shares of the modes in the action of pairs of motions, each row of sum 1.

    The action, energy over frequency, does not favour the high modes that a motion drags along.
    """
    k, n = modes.turns.shape
    shares = np.zeros((k, n))
    values, vectors = np.linalg.eig(matrices(speed)[0])
    values, rows = values.astype(complex), np.arange(k)
    for column in _chosen(values, met).T:
        motion = (vectors[rows, :, column] * matrices.scale)[:, :n]
        along = np.einsum("kjn,knh,kh->kj", modes.shapes.conj(), modes.mass, motion)
        action = np.abs(along) ** 2 * modes.turns
        total = np.sum(action, axis=1, keepdims=True)
        shares += 0.5 * action / np.where(total > 0.0, total, 1.0)
    return shares


def _chosen(values: ComplexArray, met: ComplexArray) -> NDArray[np.intp]:
    """Return the numbers of the two multipliers of each pair, shape ``(k, 2)``."""
    size = np.abs(np.log(np.abs(values)))
    away = np.abs(np.angle(values / met[:, None]))
    # Log modulus from which a multiplier has left the circle, not by the noise of a double one.
    off = size > 1e-5
    nearest = np.argsort(np.abs(values - met[:, None]), axis=1)[:, :2]
    # Off the circle: the one of nearest argument, of like ones the largest, and its inverse.
    first = np.argmin(np.where(off, np.round(away, 6) - 1e-9 * size, np.inf), axis=1)
    own = values[np.arange(len(values)), first]
    second = np.argmin(np.abs(values - (1.0 / own.conj())[:, None]), axis=1)
    gone = np.any(off, axis=1) & (away[np.arange(len(values)), first] < 0.5)
    return np.asarray(np.where(gone[:, None], np.stack([first, second], axis=1), nearest))
