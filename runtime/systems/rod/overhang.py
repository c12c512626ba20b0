"""Modes of the rod pinned at one end and held at the block, free at the tip: a moving basis.

The modes of Beale & Scott's section 2.1.  Every root is bracketed and none missed; every integral
over the modes is closed: Green's identity leaves values at pin, block and tip.
"""

from __future__ import annotations

import inspect
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....generated import quick_return_overhang_modes as emitted
from ...core.errors import bad
from ...core.inputs import numbers
from ...core.results import Check, DeferredChecks, Result, provenance
from .basis import (
    Array,
    require_array,
    require_derivative,
    require_modes,
    require_numbers,
    require_places,
    require_points,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_Emitted = Callable[..., tuple[Array, ...]]
_characteristic: Callable[..., tuple[Array, Array]] = emitted.characteristic
_end_values: _Emitted = emitted.end_values
_own_integrals: _Emitted = emitted.own_integrals
_pair_integrals: _Emitted = emitted.pair_integrals
_OF_OWN, _OF_PAIR = (
    tuple(inspect.signature(function).parameters) for function in (_own_integrals, _pair_integrals)
)
_MOST = 1000
_WHY = "the beam has long ceased to be slender for such modes"
_ROUND = float(np.finfo(float).eps)
_TINY = float(np.finfo(float).tiny)
_NEWTON_STEPS = 80  # halving alone needs fewer than that
_LAST_STEP = 1e-10  # the next of Newton's corrections is its square, times a factor
_LARGEST = 1e5  # value below which roots are counted
# Errors of a frequency, in roundings: twice that of the root, one, and three of the factors.
_FREQUENCY_ERROR = 5.0
_KEPT = 8  # arrays of places whose modes a basis remembers
# Over two modes: name, and the sign that an exchange of the modes brings.
_PAIRS = {
    "drift": -1,
    "drift_drift": 1,
    "bending_drift": -1,
    "tension": 1,
    "drift_rate": -1,
}
_OWN_NAMES = {"moment": "moment_integral", "mean": "mean"}


@lru_cache(maxsize=8)
def _held_bays(count: int) -> tuple[Array, Array]:
    """Return the first roots of either bay where the rod is held without slope at the block.

    The bay at the pin: ``tan a = tanh a``; the free one: ``1 + cos b cosh b = 0``.
    """
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
    """Return what lies below and above each root, shape ``(nt, modes)``.

    The stiffness against a slope at the block falls from one root of a held bay to the next
    from plus to minus infinity: exactly one root of the rod lies between two neighbours, and on
    them where both coincide.  Below the first one there is one more.
    """
    pinned, free = _held_bays(modes)
    xi = place[:, None]
    with np.errstate(divide="ignore"):
        held = np.concatenate([pinned / xi, free / (1 - xi)], axis=1)
    held.sort(axis=1)
    upper = held[:, :modes]
    # The sorted values are right to round-off only.
    lower = np.concatenate([np.zeros_like(xi), upper[:, :-1]], axis=1)
    return lower * (1 - 4 * _ROUND), upper * (1 + 4 * _ROUND)


def overhang_roots(place: ArrayLike, modes: int) -> Array:
    """Return the roots beta of the rod pinned at an end, held at the block and free at the tip.

    Each lies alone in a bracket (Wittrick and Williams' count with the two bays held at the
    block); Newton's method, halving where it leaves the bracket, goes on to round-off.

    Parameters
    ----------
    place : array_like
        Places xi = x1/L of the block, shape ``(nt,)`` or a number; above 0, to 1.
    modes : int
        Number of roots, from 1 to 1000.

    Returns
    -------
    ndarray
        Shape ``(nt, modes)``, ascending; mode n solves ``e'''' = beta_n^4 e``.

    Raises
    ------
    BadInput
        If the block is not on the rod, or the number is not a whole one from 1 to 1000.
    """
    modes = require_modes(modes, _MOST, _WHY)
    xi = require_places(place, alone=True)
    lower, upper = (bound.ravel() for bound in _brackets(xi, modes))
    where = np.repeat(xi, modes)
    # The residual is positive below the first root and changes its sign at each.
    sign = np.tile(1.0 - 2.0 * (np.arange(modes) % 2), len(xi))
    roots = (lower + upper) / 2
    active = np.arange(roots.size)
    beta = roots.copy()
    for _ in range(_NEWTON_STEPS):
        residual, slope = _characteristic(beta, where[active])
        above = residual * sign[active] > 0
        low = np.where(above, beta, lower[active])
        high = np.where(above, upper[active], beta)
        with np.errstate(divide="ignore", invalid="ignore"):
            correction = residual / slope
        step = beta - correction
        step = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        # The last correction is quadratically small before the next one, but for round-off.
        done = (np.abs(correction) <= _LAST_STEP * beta) | (high - low <= 4 * _ROUND * beta)
        roots[active] = np.where(done, np.clip(beta - correction, low, high), step)
        going = ~done
        if not np.any(going):
            break
        lower[active], upper[active] = low, high
        active, beta = active[going], step[going]
    return roots.reshape(len(xi), modes)


def root_count(place: ArrayLike, beta: ArrayLike) -> NDArray[np.int64]:
    """Return how many roots lie below a value: Wittrick and Williams' count.

    Parameters
    ----------
    place : array_like
        Places xi of the block; broadcasts with ``beta``.
    beta : array_like
        Values, from 0 to 1e5.

    Returns
    -------
    ndarray of int
        Roots of the two bays held at the block, and one more where the stiffness against a slope
        at the block is negative.

    Raises
    ------
    BadInput
        If the block is not on the rod, or a value is not from 0 to 1e5.
    """
    places, values = numbers("place", place), numbers("beta", beta)
    if not np.all((values >= 0.0) & (values <= _LARGEST)):
        raise bad("beta", repr(beta), f"numbers from 0 to {_LARGEST:g}", "correct it")
    xi, b = np.broadcast_arrays(require_places(places.ravel()).reshape(places.shape), values)
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

    Attributes
    ----------
    place : ndarray, shape (nt,)
        Places xi = x1/L of the block.
    roots : ndarray, shape (nt, modes)
        beta of each mode.
    frequencies : ndarray, shape (nt, modes)
        Natural frequencies [rad/s].
    """

    place: Array
    roots: Array
    frequencies: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "place": ("place",),
        "roots": ("place", "mode"),
        "frequencies": ("place", "mode"),
        "error": ("place", "mode"),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies against the block's place."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        order = np.argsort(self.place)
        for mode in range(self.frequencies.shape[1]):
            ax.plot(self.place[order], self.frequencies[order, mode], label=f"mode {mode + 1}")
        ax.set(xlabel="block's place x1/L", ylabel="natural frequency [rad/s]")
        ax.legend()
        return ax


@dataclass(frozen=True)
class _CountCheck:
    """Counts the roots on both sides of each."""

    place: Array
    roots: Array

    def __call__(self) -> dict[str, Check]:
        """Return the largest difference from the number that each root should have."""
        number = np.arange(1, self.roots.shape[1] + 1)
        margin = 64 * _ROUND
        above = root_count(self.place[:, None], self.roots * (1 + margin))
        below = root_count(self.place[:, None], self.roots * (1 - margin))
        worst = max(np.max(np.abs(above - number)), np.max(np.abs(below - number + 1)))
        return {"roots counted": Check(float(worst), 0.0)}


@dataclass
class _Modes:
    """Roots and end values of the modes at an array of places, and integrals once made."""

    place: Array
    roots: Array
    ends: dict[str, Array]
    arrays: dict[str, Array] = field(default_factory=dict)

    @classmethod
    def at(cls, place: Array, size: int) -> _Modes:
        roots = overhang_roots(place, size)
        column = place[:, None]
        values = _end_values(roots, column)
        ends = dict(zip(emitted.RETURNS["end_values"], values, strict=True))
        return cls(place, roots, {"place": column, "beta": roots, **ends})

    def array(self, name: str) -> Array:
        if name not in self.arrays:
            if name in ("overlap", "bending"):
                self._diagonal(name)
            else:
                self._integrals()
        return self.arrays[name]

    def _diagonal(self, name: str) -> None:
        """Keep what is diagonal because the modes are orthogonal, and of unit square."""
        nt, n = self.roots.shape
        matrix: Array = np.zeros((nt, n, n))
        index = np.arange(n)
        matrix[:, index, index] = 1.0 if name == "overlap" else self.roots**4
        self._keep(name, matrix)

    def _integrals(self) -> None:
        """Keep all other integrals, from the emitted closed forms."""
        nt, n = self.roots.shape
        own_values = _own_integrals(*(self.ends[name] for name in _OF_OWN))
        own = dict(zip(emitted.RETURNS["own_integrals"], own_values, strict=True))
        for name, emitted_name in _OWN_NAMES.items():
            self._keep(name, own[emitted_name])
        first, second = np.triu_indices(n, 1)
        of_pair = {}
        if len(first):
            chosen = {"_1": first, "_2": second}
            given = (
                self.ends[name[:-2]][:, chosen[name[-2:]]] if name != "place" else self.ends[name]
                for name in _OF_PAIR
            )
            values = _pair_integrals(*given)
            of_pair = dict(zip(emitted.RETURNS["pair_integrals"], values, strict=True))
        index = np.arange(n)
        for name, sign in _PAIRS.items():
            matrix: Array = np.zeros((nt, n, n))
            if name in own:  # of the others, the modes' unit square leaves nothing
                matrix[:, index, index] = own[name]
            if of_pair:
                matrix[:, first, second] = of_pair[f"{name}_12"]
                matrix[:, second, first] = sign * of_pair[f"{name}_12"]
            self._keep(name, matrix)

    def _keep(self, name: str, array: Array) -> None:
        array.setflags(write=False)
        self.arrays[name] = array


class OverhangBasis:
    """Modes of the beam pinned at the pin, held at the block and free at the tip.

    Mode n has unit square and is positive at the tip; this sign is continuous as the block moves,
    for the tip of no mode is ever at rest.  The slope at the pin has the sign of ``(-1)^n``.

    Parameters
    ----------
    size : int
        Number n of modes, from 1 to 1000.

    Raises
    ------
    BadInput
        If the number is not a whole one from 1 to 1000.

    Notes
    -----
    The arrays are read-only: a basis remembers them for the last few arrays of places.
    """

    def __init__(self, size: int) -> None:
        self.size = require_modes(size, _MOST, _WHY)
        self._known: OrderedDict[bytes, _Modes] = OrderedDict()

    def __repr__(self) -> str:
        """Return how the basis is made."""
        return f"OverhangBasis({self.size})"

    @property
    def labels(self) -> tuple[str, ...]:
        """One name per mode."""
        return tuple(f"overhang {k + 1}" for k in range(self.size))

    def roots(self, place: Array) -> Array:
        """Return beta of each mode at places xi of the block, shape ``(nt, n)``."""
        return self._modes(place).roots

    def frequencies(
        self,
        place: ArrayLike,
        *,
        length: float,
        bending_stiffness: float,
        mass_per_length: float,
    ) -> OverhangFrequencies:
        """Return the natural frequencies of the rod with the block held still.

        ``omega_k`` of Beale & Scott (7).

        Parameters
        ----------
        place : array_like
            Places xi = x1/L of the block, shape ``(nt,)`` or a number; above 0, to 1.
        length : float
            Length L of the rod [m].
        bending_stiffness : float
            EI [N m^2].
        mass_per_length : float
            Mass per length [kg/m].

        Raises
        ------
        BadInput
            If the block is not on the rod, or a number is not positive and finite.
        """
        require_numbers(
            {
                "length": length,
                "bending_stiffness": bending_stiffness,
                "mass_per_length": mass_per_length,
            }
        )
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
            error=_FREQUENCY_ERROR * _ROUND * frequencies,
            error_norm="each natural frequency, absolute [rad/s]",
            checks=DeferredChecks(_CountCheck(xi, roots)),
            provenance=provenance({"module": "quick_return_overhang_modes"}),
            place=xi,
            roots=roots,
            frequencies=frequencies,
        )

    def root_rates(self, place: Array) -> Array:
        """Return dbeta/dxi of each mode at places xi of the block, shape ``(nt, n)``."""
        modes = self._modes(place)
        return modes.roots * modes.ends["rate"]

    def end_values(self, place: Array) -> dict[str, Array]:
        """Return amplitudes and values at pin, block and tip by name, each ``(nt, n)``.

        The names are those of the emitted function ``end_values``.
        """
        return dict(self._modes(place).ends)

    def shapes(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the shapes or a derivative by eta, to the third; see :class:`MovingBasis`.

        At the block itself the third derivative is that on the side of the pin.

        Raises
        ------
        BadInput
            If a point or the block is not on the rod, or for a higher derivative.
        """
        derivative = require_derivative(derivative)
        values = (("left_amplitude",), ("right_amplitude",))
        both = (emitted.modes_before, emitted.modes_beyond)
        return self._on_rod(x, place, both, values, derivative)

    def drift(self, x: Array, place: Array, derivative: int = 0) -> Array:
        """Return the derivative of the shapes by the block's place xi, at fixed eta.

        Parameters
        ----------
        x : ndarray
            Places eta on the rod, from 0 to 1, shape ``(nx,)``.
        place : ndarray
            Places xi of the block, shape ``(nt,)``.
        derivative : int
            Which further derivative by eta, to the second.

        Returns
        -------
        ndarray
            Shape ``(nt, nx, n)``.

        Raises
        ------
        BadInput
            If a point or the block is not on the rod, or for a higher derivative.
        """
        derivative = require_derivative(derivative, most=2)
        values = (
            ("left_amplitude", "left_growth", "rate", "span_rate"),
            ("right_amplitude", "right_growth", "rate", "hang_rate"),
        )
        both = (emitted.drift_before, emitted.drift_beyond)
        return self._on_rod(x, place, both, values, derivative)

    def array(self, name: str, place: Array) -> Array:
        """Return the integrals of one name at places xi; see :class:`MovingBasis`.

        Beale & Scott (8), (9), (11), and what else the canonical form needs.

        Raises
        ------
        BadInput
            If there is no array of that name, or the block is not on the rod.
        """
        require_array(name)
        return self._modes(place).array(name)

    def drift_rate(self, place: Array) -> Array:
        """Return the derivative of the array ``drift`` by xi, shape ``(nt, n, n)``.

        Less ``drift_drift`` it is ``int e_i d^2 e_j / dxi^2``, for Beale & Scott (10).
        """
        return self._modes(place).array("drift_rate")

    def _on_rod(
        self,
        x: Array,
        place: Array,
        both: tuple[Callable[..., tuple[Array, ...]], ...],
        names: tuple[tuple[str, ...], ...],
        which: int,
    ) -> Array:
        """Evaluate one function up to the block and another beyond it."""
        modes = self._modes(place)
        eta = require_points(x)
        xi, beta = modes.place[:, None, None], modes.roots[:, None, :]
        eta = eta[None, :, None]
        sides = []
        for function, point, wanted in zip(
            both, (np.minimum(eta, xi), np.maximum(eta, xi)), names, strict=True
        ):
            factors = (modes.ends[name][:, None, :] for name in wanted)
            # Far from the tip of a high mode the form that holds near it, which is not chosen
            # there, divides by an exponential that has underflowed.
            with np.errstate(divide="ignore", invalid="ignore"):
                sides.append(function(beta, point, xi, *factors)[which])
        return np.asarray(np.where(eta <= xi, *sides))

    def _modes(self, place: Array) -> _Modes:
        xi = require_places(place)
        key = xi.tobytes()
        modes = self._known.pop(key, None)
        if modes is None:
            modes = _Modes.at(xi.copy(), self.size)
            while len(self._known) >= _KEPT:
                self._known.popitem(last=False)
        self._known[key] = modes
        return modes
