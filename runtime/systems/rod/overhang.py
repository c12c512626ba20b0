"""Modes of the rod pinned at one end and held at the block, free at the tip: a moving basis.

The modes of Beale & Scott's section 2.1.  Every root is bracketed and none missed; every integral
over the modes is closed: Green's identity leaves values at pin, block and tip.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....generated import quick_return_overhang_modes as emitted
from ...core.errors import bad
from ...core.inputs import require_whole
from ...core.plotting import Axes, axes_or_new
from ...core.results import Check, DeferredChecks, Result, provenance
from .basis import Array, require_array, require_numbers, require_places, require_points

_Emitted = Callable[..., tuple[Array, ...]]
_characteristic: Callable[..., tuple[Array, Array]] = emitted.characteristic
_end_values: _Emitted = emitted.end_values
_own_integrals: _Emitted = emitted.own_integrals
_pair_integrals: _Emitted = emitted.pair_integrals
_OF_OWN, _OF_PAIR = (
    tuple(inspect.signature(function).parameters) for function in (_own_integrals, _pair_integrals)
)
# Functions up to the block and beyond it, and the values at the ends that they take.
_Sides = tuple[tuple[_Emitted, tuple[str, ...]], ...]
_SHAPES: _Sides = (
    (emitted.modes_before, ("left_amplitude",)),
    (emitted.modes_beyond, ("right_amplitude",)),
)
_DRIFT: _Sides = (
    (emitted.drift_before, ("left_amplitude", "left_growth", "rate", "span_rate")),
    (emitted.drift_beyond, ("right_amplitude", "right_growth", "rate", "hang_rate")),
)
_MOST = 1000
_FEWER = "take fewer: the beam has long ceased to be slender for such modes"
_OFFERED = "higher ones are not offered"
_ROUND = float(np.finfo(float).eps)
_TINY = float(np.finfo(float).tiny)
_KEPT = 8  # arrays of places whose modes and integrals are remembered
# Over two modes: name, and the sign that an exchange of the modes brings.
_PAIRS = {"drift": -1, "drift_drift": 1, "bending_drift": -1, "tension": 1, "drift_rate": -1}


@lru_cache(maxsize=8)
def _held_bays(count: int) -> tuple[Array, Array]:
    """Return the first roots of either bay where the rod is held without slope at the block."""
    # The bay at the pin: tan a = tanh a; the free one: 1 + cos b cosh b = 0.
    k = np.arange(1, count + 1)
    turns, halves = np.asarray(k * np.pi), np.asarray((k - 0.5) * np.pi)
    side = np.where(k % 2 == 1, 1.0, -1.0)
    pinned, free = turns, halves
    for _ in range(60):  # contracts by a third at worst
        pinned = np.asarray(turns + np.arctan(np.tanh(pinned)))
        free = np.asarray(halves + side * np.arcsin(1 / np.cosh(np.minimum(free, 700.0))))
    pinned.setflags(write=False)
    free.setflags(write=False)
    return pinned, free


def _brackets(place: Array, modes: int) -> tuple[Array, Array]:
    """Return what lies below and above each root, shape ``(nt, modes)``."""
    # The stiffness against a slope at the block falls from one root of a held bay to the next from
    # plus to minus infinity: exactly one root of the rod lies between two neighbours, and on them
    # where both coincide.  Below the first one there is one more.
    pinned, free = _held_bays(modes)
    xi = place[:, None]
    with np.errstate(divide="ignore"):
        held = np.concatenate([pinned / xi, free / (1 - xi)], axis=1)
    held.sort(axis=1)
    upper = held[:, :modes]
    # The sorted values are right to round-off only.
    lower = np.concatenate([np.zeros_like(xi), upper[:, :-1]], axis=1)
    return lower * (1 - 4 * _ROUND), upper * (1 + 4 * _ROUND)


def _roots(xi: Array, modes: int) -> Array:
    """Return the roots beta, ascending, ``(nt, modes)``; of mode n ``e'''' = beta_n^4 e``."""
    # Each root lies alone in its bracket (Wittrick and Williams' count with the two bays held at
    # the block); Newton's method, halving where it leaves the bracket, goes on to round-off.
    lower, upper = (bound.ravel() for bound in _brackets(xi, modes))
    where = np.repeat(xi, modes)
    # The residual is positive below the first root and changes its sign at each.
    sign = np.tile(1.0 - 2.0 * (np.arange(modes) % 2), len(xi))
    roots = (lower + upper) / 2
    active = np.arange(roots.size)
    beta = roots.copy()
    for _ in range(80):  # halving alone needs fewer
        residual, slope = _characteristic(beta, where[active])
        above = residual * sign[active] > 0
        low = np.where(above, beta, lower[active])
        high = np.where(above, upper[active], beta)
        with np.errstate(divide="ignore", invalid="ignore"):
            correction = residual / slope
        step = beta - correction
        step = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        # The next of Newton's corrections is the square of this, times a factor.
        done = (np.abs(correction) <= 1e-10 * beta) | (high - low <= 4 * _ROUND * beta)
        roots[active] = np.where(done, np.clip(beta - correction, low, high), step)
        going = ~done
        if not np.any(going):
            break
        lower[active], upper[active] = low, high
        active, beta = active[going], step[going]
    return roots.reshape(len(xi), modes)


def root_count(place: Array, beta: Array) -> NDArray[np.int64]:
    """Return how many roots lie below values: Wittrick and Williams' count.

    The roots of the two bays held at the block, and one more where the stiffness against a slope
    at the block is negative; ``place`` and ``beta`` broadcast.
    """
    xi, b = np.broadcast_arrays(place, beta)
    most = max(1, int(np.max(b, initial=0.0) / np.pi) + 2)
    pinned, free = _held_bays(most)
    below = np.sum(pinned < (b * xi)[..., None], axis=-1)
    below = below + np.sum(free < (b * (1 - xi))[..., None], axis=-1)
    residual, _ = _characteristic(b, xi)
    # Its sign is that of the stiffness times one sign change for each root of a held bay.
    negative = residual * (1.0 - 2.0 * (below % 2)) < 0
    return np.asarray(below + negative, dtype=np.int64)


@dataclass(frozen=True, kw_only=True)
class OverhangFrequencies(Result):
    """Natural frequencies of the rod with the block held still, over the block's place.

    ``error`` has the shape of ``frequencies``: the absolute error [rad/s] from round-off.
    """

    place: Array  # places xi = x1/L of the block, (nt,)
    roots: Array  # beta of each mode, (nt, modes)
    frequencies: Array  # [rad/s], (nt, modes)

    arrays_along: ClassVar = {"place": "place", "place mode": "roots frequencies error"}
    column_units: ClassVar = {"rad/s": "error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies against the block's place."""
        ax = axes_or_new(ax)
        order = np.argsort(self.place)
        for mode in range(self.frequencies.shape[1]):
            ax.plot(self.place[order], self.frequencies[order, mode], label=f"mode {mode + 1}")
        ax.set(xlabel="block's place x1/L", ylabel="natural frequency [rad/s]")
        ax.legend()
        return ax


def _counted(place: Array, roots: Array) -> dict[str, Check]:
    """Return the largest difference between a root's number and the count on both sides of it."""
    number = np.arange(1, roots.shape[1] + 1)
    margin = 64 * _ROUND
    above = root_count(place[:, None], roots * (1 + margin))
    below = root_count(place[:, None], roots * (1 - margin))
    worst = max(np.max(np.abs(above - number)), np.max(np.abs(below - number + 1)))
    return {"roots counted": Check(float(worst), 0.0)}


@lru_cache(maxsize=_KEPT)
def _modes(size: int, places: bytes) -> dict[str, Array]:
    """Return what the emitted ``end_values`` gives, with places, a column, and roots ``beta``."""
    # All arrays are read-only.
    place = np.frombuffer(places)
    column, roots = place[:, None], _roots(place, size)
    values = _end_values(roots, column)
    ends = dict(zip(emitted.RETURNS["end_values"], values, strict=True))
    ends |= {"place": column, "beta": roots}
    for array in ends.values():
        array.setflags(write=False)
    return ends


@lru_cache(maxsize=_KEPT)
def _integrals(size: int, places: bytes) -> dict[str, Array]:
    """Return the integrals that are not diagonal, from the emitted closed forms."""
    ends = _modes(size, places)
    own_values = _own_integrals(*(ends[name] for name in _OF_OWN))
    own = dict(zip(emitted.RETURNS["own_integrals"], own_values, strict=True))
    found = {"moment": own["moment_integral"], "mean": own["mean"]}
    first, second = np.triu_indices(size, 1)
    chosen = {"_1": first, "_2": second}
    given = (
        ends[name[:-2]][:, chosen[name[-2:]]] if name != "place" else ends[name]
        for name in _OF_PAIR
    )
    of_pair = dict(zip(emitted.RETURNS["pair_integrals"], _pair_integrals(*given), strict=True))
    for name, sign in _PAIRS.items():
        # Of those not among the integrals of one mode its unit square leaves nothing.
        found[name] = _diagonal(own.get(name, np.zeros_like(ends["beta"])))
        found[name][:, first, second] = of_pair[f"{name}_12"]
        found[name][:, second, first] = sign * of_pair[f"{name}_12"]
    for array in found.values():
        array.setflags(write=False)
    return found


def _diagonal(values: Array) -> Array:
    """Return diagonal matrices ``(nt, n, n)`` from their diagonals."""
    return np.asarray(values[:, :, None] * np.eye(values.shape[1]))


@dataclass(frozen=True)
class OverhangBasis:
    """1 to 1000 modes of the beam pinned at the pin, held at the block and free at the tip.

    Mode n has unit square and is positive at the tip; this sign is continuous as the block moves,
    for the tip of no mode is ever at rest.  The slope at the pin has the sign of ``(-1)^n``.  The
    arrays are read-only: they are remembered for the last few arrays of places.
    """

    size: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", require_whole("modes", self.size, 1, _MOST, _FEWER))

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per mode."""
        return tuple(f"overhang {k + 1}" for k in range(self.size))

    def roots(self, place: Array) -> Array:
        """Return beta of each mode at places xi of the block, shape ``(nt, n)``."""
        return self._modes(place)["beta"]

    def frequencies(
        self, place: ArrayLike, *, length: float, bending_stiffness: float, mass_per_length: float
    ) -> OverhangFrequencies:
        """Return the natural frequencies of the rod with the block held still (Beale & Scott 7).

        For places xi = x1/L of the block, above 0, to 1, ``(nt,)`` or a number; the length L [m],
        EI [N m^2] and mass per length [kg/m] are positive.
        """
        stiff = {"length": length, "bending_stiffness": bending_stiffness}
        require_numbers({**stiff, "mass_per_length": mass_per_length})
        xi = require_places(place, alone=True)
        roots = self.roots(xi)
        with np.errstate(all="ignore"):
            unit = np.sqrt(np.float64(bending_stiffness) / mass_per_length)
            frequencies = np.asarray(roots**2 * (unit / np.float64(length) ** 2))
        if not np.all((frequencies > _TINY) & (frequencies < np.inf)):
            expected = "length, stiffness and mass per length of one rod, in SI units"
            raise bad("length", repr(length), expected, "its frequencies are beyond a double")
        return OverhangFrequencies(
            method="Newton's method in brackets of the bays held at the block",
            # Roundings: twice that of the root, one, and three of the factors.
            error=5.0 * _ROUND * frequencies,
            error_norm="each natural frequency, absolute [rad/s]",
            checks=DeferredChecks(partial(_counted, xi, roots)),
            provenance=provenance({"module": "quick_return_overhang_modes"}),
            place=xi,
            roots=roots,
            frequencies=frequencies,
        )

    def end_values(self, place: Array) -> dict[str, Array]:
        """Return amplitudes and values at pin, block and tip by name, each ``(nt, n)``.

        The names are those of the emitted function ``end_values``.
        """
        return dict(self._modes(place))

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`.

        At the block itself the third derivative is that on the side of the pin.
        """
        order = require_whole("derivative", derivative, 0, 3, _OFFERED)
        return self._on_rod(_SHAPES, x, place, order)

    def drift(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the derivative of the shapes by the block's place xi ``(nt, nx, n)``.

        And its derivatives by eta, to the second; the places are those of :meth:`shapes`.
        """
        order = require_whole("derivative", derivative, 0, 2, _OFFERED)
        return self._on_rod(_DRIFT, x, place, order)

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; see :class:`MovingBasis`.

        Beale & Scott (8), (9), (11), and what else the canonical form needs.
        """
        require_array(name)
        if name in ("overlap", "bending"):
            # The modes are orthogonal, of unit square.
            roots = self.roots(place)
            return _diagonal(np.ones_like(roots) if name == "overlap" else roots**4)
        return _integrals(self.size, require_places(place).tobytes())[name]

    def drift_rate(self, place: Array) -> Array:
        """Return the derivative of the array ``drift`` by xi, shape ``(nt, n, n)``.

        Less ``drift_drift`` it is ``int e_i d^2 e_j / dxi^2``, for Beale & Scott (10).
        """
        return _integrals(self.size, require_places(place).tobytes())["drift_rate"]

    def _on_rod(self, sides: _Sides, x: Array, place: Array, order: int) -> Array:
        modes = self._modes(place)
        eta = require_points(x)[None, :, None]
        xi, beta = modes["place"][:, :, None], modes["beta"][:, None, :]
        found = []
        for (function, names), point in zip(
            sides, (np.minimum(eta, xi), np.maximum(eta, xi)), strict=True
        ):
            factors = (modes[name][:, None, :] for name in names)
            # Far from the tip of a high mode the form that holds near it, which is not chosen
            # there, divides by an exponential that has underflowed.
            with np.errstate(divide="ignore", invalid="ignore"):
                found.append(function(beta, point, xi, *factors)[order])
        return np.asarray(np.where(eta <= xi, *found))

    def _modes(self, place: Array) -> dict[str, Array]:
        return _modes(self.size, require_places(place).tobytes())
