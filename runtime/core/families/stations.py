"""Emitted equations of a bent link, its tangent's angle taken at stations, in amplitudes alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import SelfCheckFailed
from .linear_periodic import Array
from .nonlinear import CLOSING, Drive, Varied, is_last

# What of the emitted functions is used.
_WANTED = {
    "constraints": ("constraints", "jacobian", "velocity_rhs"),
    "dynamics": ("mass", "rest", "forces", "gamma"),
    "variations": ("damping", "stiffness", "jacobian_rate", "jacobian_acceleration"),
}
# Parts of the module's coordinates: the one that the end of the link moves, and the angles.
_PARTS = slice(0, 1), slice(1, None)


@dataclass(frozen=True)
class Stations:
    """Places along a link, and the shapes by which the angle of its tangent changes there."""

    shapes: Array  # angles at the Q stations per amplitude, beside their mean, (n, Q)
    # What the module wants of each station, (Q,), and of pairs of them, symmetric (Q, Q).
    numbers: Mapping[str, Array]


@dataclass(frozen=True)
class AtStations:
    """The equations of an emitted module, closed in stations, in amplitudes of the angle there.

    The module's coordinates z are one that the end of the link moves, such as a follower's angle,
    and the angles at the stations.  Its two constraints give the one and the mean of the others by
    the amplitudes: ``z' = E^T q' + b``.  All is projected where it stands, at the stations::

        r = E (M z'' + c - Q),     dr/dq'' = E M E^T,
        dr/dq' = E (2 M E'^T + D E^T),     dr/dq = E (M E''^T + D E'^T + K E^T).

    Arrays have the N states on their last axis: z is ``(1 + Q, N)``, E ``(n, 1 + Q, N)``.
    """

    module: ModuleType  # emitted, with variations
    stations: Callable[[Mapping[str, float]], Stations]  # parameters to the stations
    # (chord, drive, parameters) to the first coordinate and the mean angle near states, (2, N),
    # from the link's chord over its length, x + i y at no mean angle, (N,).
    guess: Callable[[Array, Drive, Mapping[str, float]], Array]

    def __call__(
        self,
        q: Array,
        qd: Array,
        qdd: Array,
        drive: Drive,
        parameters: Mapping[str, float],
        derivatives: bool = True,
    ) -> Varied:
        """Return the residual at states ``(*batch, n)``, with its derivatives where wanted."""
        *batch, n = q.shape
        q, qd, qdd = (np.ascontiguousarray(part.reshape(-1, n).T) for part in (q, qd, qdd))
        drive = Drive(*(_flat(part, tuple(batch)) for part in drive))
        at = _Evaluated(self.module, self.stations(parameters), drive, parameters)
        z, closed, inverse = self._closed(at, q, drive, parameters)
        shapes = at.stations.shapes
        basis = at.moved(-_solved(inverse, shapes @ closed["jacobian"][:, 1:]))
        basis[:, 1:] += shapes[..., None]

        def rates(free: Array, constant: Array) -> Array:
            found: Array = np.add.reduce(basis * free[:, None], axis=0)
            return found + at.moved(_solved(inverse, constant))

        zd = rates(qd, closed["velocity_rhs"])
        terms = at("dynamics", z, zd)
        zdd = rates(qdd, terms["gamma"])
        left = terms["mass"](zdd[None], {})[0] + terms["rest"] - terms["forces"]
        residual = np.einsum("ksn,sn->nk", basis, left).reshape(*batch, n)
        if not derivatives:
            return Varied(residual)
        varied = at("variations", z, zd, zdd, np.einsum("ijn,in->jn", inverse, _held(left)))
        turning, bending = varied["jacobian_rate"], varied["jacobian_acceleration"]
        rate = -_solved(inverse, np.einsum("ksn,isn->ikn", basis, turning))
        changed = np.einsum("ksn,isn->ikn", basis, bending)
        changed += 2.0 * np.einsum("hkn,hin->ikn", rate, _held(turning))
        change = -_solved(inverse, changed)
        across: dict[tuple[int, str], Array] = {}
        by_mass, by_damping = terms["mass"](basis, {}), varied["damping"](basis, across)
        held_mass, held_damping = _held(by_mass), _held(by_damping)
        matrices = (
            _products(by_mass, basis),
            _products(by_damping, basis) + 2.0 * _by_held(held_mass, rate),
            _products(varied["stiffness"](basis, across), basis)
            + _by_held(held_mass, change)
            + _by_held(held_damping, rate),
        )
        return Varied(residual, *(matrix.reshape(*batch, n, n) for matrix in matrices))

    def _closed(
        self, at: _Evaluated, q: Array, drive: Drive, parameters: Mapping[str, float]
    ) -> tuple[Array, Mapping[str, Any], Array]:
        """Return the module's coordinates on the constraints, and the arrays of these there."""
        # With the inverse of their derivatives by what they give, (2, 2, N).
        angles = at.stations.shapes.T @ q
        x, y = np.cos(angles), np.sin(angles)
        chord = (np.add.reduce(x, axis=0) + 1j * np.add.reduce(y, axis=0)) / len(angles)
        held, last = self.guess(chord, drive, parameters), np.inf
        for _ in range(CLOSING):
            cosine, sine = np.cos(held[1]), np.sin(held[1])
            at.tangent = x * cosine - y * sine, y * cosine + x * sine
            z = at.moved(held)
            z[1:] += angles
            found = at("constraints", z)
            (a, c), (b, d) = _held(found["jacobian"])
            inverse = np.stack([d, -b, -c, a]).reshape(2, 2, -1) / (a * d - b * c)
            change = _solved(inverse, found["constraints"])
            held = held - change
            size = float(np.max(np.abs(change), initial=0.0))
            if is_last(size, last):
                z -= at.moved(change)
                return z, found, inverse
            last = size
        raise SelfCheckFailed("the loop of the linkage cannot be closed at a state")


class _Evaluated:
    """The emitted functions of a module at numbers and angles of the drive ``(N,)``."""

    def __init__(
        self, module: ModuleType, stations: Stations, drive: Drive, parameters: Mapping[str, float]
    ) -> None:
        self.module, self.stations = module, stations
        self.tangent: tuple[Array, Array]  # cosines and sines of the angles, (Q, N)
        numbers = (stations.numbers[name] for name in module.STATIONS[2])
        # First the time, which nothing hangs on.
        self._given = 0.0, *drive, *(parameters[name] for name in module.PARAMETERS)
        self._numbers = [n if n.ndim == 2 else n[:, None] for n in numbers]

    def moved(self, held: Array) -> Array:
        """Return what the first coordinate and the mean angle ``(2, ..., N)`` move.

        Shape ``(..., 1 + Q, N)``.
        """
        *batch, states = held.shape[1:]
        z = np.empty((*batch, 1 + self.stations.shapes.shape[1], states))
        z[...] = held[1][..., None, :]
        z[..., 0, :] = held[0]
        return z

    def __call__(self, name: str, *vectors: Array) -> dict[str, Any]:
        """Evaluate at vectors ``(1 + Q, N)``, the multipliers ``(2, N)`` behind three of them.

        Returns vectors; by constraint values ``(2, N)`` and derivatives ``(2, 1 + Q, N)``; and of
        square arrays what vectors times them are.
        """
        taken = [part for vector in vectors[:3] for part in (vector[0], vector[1:])]
        taken += [multiplier for each in vectors[3:] for multiplier in each]
        returned = getattr(self.module, name)(*taken, *self._given, *self.tangent, *self._numbers)
        arrays: dict[str, Any] = {}
        for array in _WANTED[name]:
            entries = self.module.ARRAYS[name][array][1]
            if array in ("mass", "damping", "stiffness"):
                arrays[array] = partial(_rows, entries, returned, self.stations.numbers)
            elif array in ("rest", "forces"):
                made = arrays[array] = np.zeros_like(vectors[0])
                for i, _, at in entries:
                    made[_PARTS[i]] = returned[at]
            elif array.startswith("jacobian"):
                made = arrays[array] = np.zeros((2, *vectors[0].shape))
                for i, j, at in entries:
                    made[i, _PARTS[j]] = returned[at]
            else:
                made = arrays[array] = np.zeros((2, vectors[0].shape[1]))
                for i, _, at in entries:
                    made[i] = returned[at]
        return arrays


def _rows(
    entries: tuple[tuple[Any, ...], ...],
    returned: tuple[Any, ...],
    kernels: Mapping[str, Array],
    vectors: Array,
    across: dict[tuple[int, str], Array],
) -> Array:
    """Return vectors ``(k, 1 + Q, N)`` times a square array of the module's coordinates."""
    # `across` keeps the vectors times left factors and kernels, which arrays of a function share.
    rows = np.zeros_like(vectors)
    for i, j, at, *product in entries:
        part = vectors[:, _PARTS[i]]
        if not product:
            rows[:, _PARTS[j]] += part * returned[at]
            continue
        kernel, place = product
        if (at, kernel) not in across:
            across[at, kernel] = kernels[kernel] @ (part * returned[at])
        rows[:, _PARTS[j]] += across[at, kernel] * returned[place]
    return rows


def _flat(values: ArrayLike, batch: tuple[int, ...]) -> Array:
    """Return what broadcasts to a batch as a row."""
    array = np.asarray(values, dtype=float)
    return (array if array.shape == batch else np.broadcast_to(array, batch)).reshape(-1)


def _held(rows: Array) -> Array:
    """Return what rows ``(..., 1 + Q, N)`` do to what the constraints give: ``(2, ..., N)``."""
    held = np.empty((2, *rows.shape[:-2], rows.shape[-1]))
    held[0] = rows[..., 0, :]
    np.add.reduce(rows[..., 1:, :], axis=-2, out=held[1])
    return held


def _solved(inverse: Array, right: Array) -> Array:
    """Return an inverse ``(2, 2, N)`` times right-hand sides ``(2, ..., N)``."""
    return np.asarray(np.einsum("ijn,j...n->i...n", inverse, right))


def _products(rows: Array, vectors: Array) -> Array:
    """Return all products of rows and vectors ``(n, 1 + Q, N)``, ``(N, n, n)``."""
    return np.asarray(np.einsum("ksn,lsn->nkl", rows, vectors))


def _by_held(rows: Array, held: Array) -> Array:
    """Return the same where both stand for what the constraints give alone, ``(2, n, N)``."""
    return np.asarray(np.einsum("hkn,hln->nkl", rows, held))
