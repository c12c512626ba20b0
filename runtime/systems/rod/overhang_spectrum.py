"""Roots and natural frequencies of the rod with an overhang: every one found, none missed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....generated import quick_return_overhang_modes as emitted
from ...core.errors import bad
from ...core.results import Check, DeferredChecks, Result, provenance
from .inputs import as_floats, require_modes, require_numbers, require_places

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_characteristic: Callable[..., tuple[Array, Array]] = emitted.characteristic
_ROUND = float(np.finfo(float).eps)
_NEWTON_STEPS = 80  # halving alone needs fewer than that
_LAST_STEP = 1e-10  # the next of Newton's corrections is its square, times a factor
# Error of a root over its own round-off: that of the residual over its slope, measured.
_ROOT_ERROR = 1.0
MOST = 1000  # modes
WHY = "the beam has long ceased to be slender for such modes"
_LARGEST = 1e5  # value below which roots are counted
_TINY = float(np.finfo(float).tiny)


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
    modes = require_modes(modes, MOST, WHY)
    xi = require_places(place, alone=True)
    lower, upper = (bound.ravel() for bound in _brackets(xi, modes))
    where = np.repeat(xi, modes)
    # The residual is positive below the first root and changes its sign at each.
    sign = np.tile(1.0 - 2.0 * (np.arange(modes) % 2), len(xi))
    found = (lower + upper) / 2
    active = np.arange(found.size)
    beta = found.copy()
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
        found[active] = np.where(done, np.clip(beta - correction, low, high), step)
        going = ~done
        if not np.any(going):
            break
        lower[active], upper[active] = low, high
        active, beta = active[going], step[going]
    return found.reshape(len(xi), modes)


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
    expected = f"numbers from 0 to {_LARGEST:g}"
    places, values = as_floats("place", place, "numbers"), as_floats("beta", beta, expected)
    if not np.all((values >= 0.0) & (values <= _LARGEST)):
        raise bad("beta", repr(beta), expected, "correct it")
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

    ``error`` has the shape of ``frequencies``: the absolute figure [rad/s] from round-off.

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


def overhang_frequencies(
    place: ArrayLike,
    modes: int,
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
    modes : int
        How many, from 1.
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
    given = {
        "length": length,
        "bending_stiffness": bending_stiffness,
        "mass_per_length": mass_per_length,
    }
    require_numbers(given)
    xi = require_places(place, alone=True)
    roots = overhang_roots(xi, modes)
    with np.errstate(all="ignore"):
        unit = np.sqrt(np.float64(bending_stiffness) / mass_per_length) / np.float64(length) ** 2
        frequencies = np.asarray(roots**2 * unit)
    if not np.all((frequencies > _TINY) & (frequencies < np.inf)):
        expected = "length, stiffness and mass per length of one rod, in SI units"
        raise bad("length", repr(length), expected, "its frequencies are beyond a double")
    return OverhangFrequencies(
        method="Newton's method in brackets of the bays held at the block",
        error=(2 * _ROOT_ERROR + 3) * _ROUND * frequencies,
        error_norm="each natural frequency, absolute [rad/s]",
        checks=DeferredChecks(_CountCheck(xi, roots)),
        provenance=provenance({"module": "quick_return_overhang_modes"}),
        place=xi,
        roots=roots,
        frequencies=frequencies,
    )


@dataclass(frozen=True)
class _CountCheck:
    """Counts the roots on both sides of each one found."""

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
