"""Modes of the rod pinned at one end and held at the block, free at the tip: a moving basis.

The modes of Beale & Scott's section 2.1.  Every integral over them is closed: Green's identity
leaves values at pin, block and tip.
"""

from __future__ import annotations

import inspect
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....generated import quick_return_overhang_modes as emitted
from ...core.errors import bad
from .inputs import require_modes, require_places, require_points
from .overhang_spectrum import (
    MOST,
    WHY,
    OverhangFrequencies,
    overhang_frequencies,
    overhang_roots,
    root_count,
)
from .segments import require_array

__all__ = [
    "OverhangBasis",
    "OverhangFrequencies",
    "overhang_frequencies",
    "overhang_roots",
    "root_count",
]

Array = NDArray[np.float64]

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


def _inputs(function: Callable[..., object]) -> tuple[str, ...]:
    return tuple(inspect.signature(function).parameters)


_Emitted = Callable[..., tuple[Array, ...]]
_end_values: _Emitted = emitted.end_values
_own_integrals: _Emitted = emitted.own_integrals
_pair_integrals: _Emitted = emitted.pair_integrals
_OF_OWN = _inputs(_own_integrals)
_OF_PAIR = _inputs(_pair_integrals)


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
        found: Array = np.zeros((nt, n, n))
        index = np.arange(n)
        found[:, index, index] = 1.0 if name == "overlap" else self.roots**4
        self._keep(name, found)

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
            found: Array = np.zeros((nt, n, n))
            if name in own:  # of the others, the modes' unit square leaves nothing
                found[:, index, index] = own[name]
            if of_pair:
                found[:, first, second] = of_pair[f"{name}_12"]
                found[:, second, first] = sign * of_pair[f"{name}_12"]
            self._keep(name, found)

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
        self.size = require_modes(size, MOST, WHY)
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
        if derivative not in range(4):
            raise bad("derivative", derivative, "0, 1, 2 or 3", "ask for a derivative by eta")
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
        if derivative not in range(3):
            raise bad("derivative", derivative, "0, 1 or 2", "ask for a derivative by eta")
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
        found = []
        for function, point, wanted in zip(
            both, (np.minimum(eta, xi), np.maximum(eta, xi)), names, strict=True
        ):
            factors = (modes.ends[name][:, None, :] for name in wanted)
            # Far from the tip of a high mode the form that holds near it, which is not chosen
            # there, divides by an exponential that has underflowed.
            with np.errstate(divide="ignore", invalid="ignore"):
                found.append(function(beta, point, xi, *factors)[which])
        return np.asarray(np.where(eta <= xi, *found))

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
