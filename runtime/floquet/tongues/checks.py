"""Checks of a tongue from a perturbation series against multipliers from integration."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core.families import DAMPING, LinearPeriodic, Term
from ...core.results import Check
from ...periodic import floquet_multipliers
from .ends import expected
from .operator import ResonantOperator
from .resonances import Resonance

if TYPE_CHECKING:
    from .series import Tongue

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_TESTED = 3
# Places at which the series is asked whether a range is closed.
_LOOKED = 101
# Distance from the ends, over the width, at the least.
_MARGIN = 0.05
# Growth at the margin, over that in the middle, that an unstable range has at the least.
_GROWTH = 0.02


@dataclass(frozen=True)
class Places:
    """Points of a tongue.

    Attributes
    ----------
    values, damping : ndarray
        Values of the parameter and factors on the damping, of the shape of the result.
    which : ndarray of int
        Number of the operator that belongs to each, flat.
    eps : ndarray
        Size of the periodic part in that operator's terms, flat.
    """

    values: Array
    damping: Array
    which: NDArray[np.intp]
    eps: Array


@dataclass(frozen=True)
class TongueChecks:
    """Makes the checks when it is called.

    Attributes
    ----------
    system : LinearPeriodic
        The system.
    resonance : Resonance
        The resonance.
    parameters : mapping
        Parameter values that replace the system's own.
    speed : float
        Crank speed [rad/s] where a parameter is detuned.
    tongue : Tongue
        The result.
    places : Places
        Its points.
    ends : callable
        From an operator with its centre, the periodic part's size and the factor on the damping to
        lower and upper end, whether open, and the error.
    """

    system: LinearPeriodic
    resonance: Resonance
    parameters: Mapping[str, float]
    speed: float
    tongue: Tongue
    places: Places
    ends: Callable[[tuple[ResonantOperator, float], float, float], tuple[float, float, bool, float]]

    def __call__(self) -> Mapping[str, Check]:
        """Return the checks by name."""
        found = self.tongue
        width, error = found.width.ravel(), found.error.ravel()
        opened = np.flatnonzero(found.open.ravel())
        checks = {"told apart": Check(float(self._lost()), 0.0)}
        if not len(opened):
            return checks
        with np.errstate(invalid="ignore"):
            share = 2 * error[opened] / width[opened]
        worst = float(np.max(np.where(np.isnan(share), np.inf, share)))
        checks["error over half the width"] = Check(worst, 1.0)
        opened = opened[share < 1]
        if not len(opened):
            return checks
        picked = opened[np.unique(np.linspace(0, len(opened) - 1, _TESTED).round().astype(int))]
        wrong = [self._contradictions(int(place)) for place in picked]
        for name, counts in zip(
            ("stable inside", "unstable outside"), zip(*wrong, strict=True), strict=True
        ):
            checks[name] = Check(float(sum(counts)), 0.0)
        return checks

    def _lost(self) -> int:
        """Count the ranges that are not found although damping does not close them."""
        found = self.tongue
        missing = np.isnan(found.lower).ravel()
        undamped = missing & (self.places.damping.ravel() == 0.0)
        if not self.system.is_damped(**self.parameters):
            undamped = missing
        closed = np.flatnonzero(missing & ~undamped)
        if not len(closed):
            return int(np.sum(undamped))
        at = [self._within(int(place)) for place in closed]
        told = [
            np.max(np.abs(self._told(int(k), x)), axis=-1) for k, x in zip(closed, at, strict=True)
        ]
        # All that the series doubts, and a few others.
        picked = {k for k in range(len(closed)) if np.max(told[k]) > 1.0}
        picked |= set(np.linspace(0, len(closed) - 1, _TESTED).round().astype(int).tolist())
        return int(np.sum(undamped)) + sum(
            self._grows(int(closed[k]), at[k], told[k]) for k in sorted(picked)
        )

    def _within(self, place: int) -> Array:
        """Return places, the middle first, all over the range that damping is said to close."""
        which, eps = int(self.places.which[place]), float(self.places.eps[place])
        operator, at = self.tongue.operators[which], float(self.tongue.centres[which])
        low, high, _, error = self.ends((operator, at), eps, 0.0)
        if not np.all(np.isfinite([low, high, error])):
            centre, half = expected(operator.polynomials(eps, 0.0, 1))
            sigma = np.array([centre - half, centre + half])
            speed = self.resonance.detuning == "speed"
            low, high = np.sort(at / (1 + sigma) if speed else at * (1 + sigma)).tolist()
            error = 0.0
        within = np.linspace(low - error, high + error, _LOOKED)
        return np.concatenate([[(low + high) / 2], within])

    def _grows(self, place: int, at: Array, told: Array) -> bool:
        """Return True where a multiplier is outside the circle, at the middle or the likeliest."""
        modulus, error = self._modulus(place, at[[0, int(np.argmax(told))]])
        return bool(np.any(modulus > 1 + error))

    def _contradictions(self, place: int) -> tuple[int, int]:
        """Count wrong verdicts just inside and just outside at one value."""
        found = self.tongue
        low, high = float(found.lower.ravel()[place]), float(found.upper.ravel()[place])
        margin = max(3 * float(found.error.ravel()[place]), _MARGIN * (high - low))
        inner = np.array([low + margin, high - margin])
        outer = np.array([low - margin, high + margin])
        modulus, error = self._modulus(place, outer)
        beyond = int(np.sum(modulus > 1 + error))
        if inner[0] > inner[1]:
            return 0, beyond
        middle = (np.abs(self._told(place, np.array([(low + high) / 2]))).max() - 1) * _GROWTH
        modulus, error = self._modulus(place, inner)
        return int(np.sum((modulus - 1 <= middle) & (error <= middle))), beyond

    def _modulus(self, place: int, at: Array) -> tuple[Array, Array]:
        """Return the largest modulus of the multipliers that the series tells of, and its error."""
        given: dict[str, float | Array] = dict(self.parameters)
        if self.tongue.parameter:
            given[self.tongue.parameter] = float(self.places.values.ravel()[place])
        speed: Array = at
        if self.resonance.detuning != "speed":
            speed, given[self.resonance.detuning] = np.full(len(at), self.speed), at
        factor = float(self.places.damping.ravel()[place])
        damped = self.system.with_changed_terms(partial(_damped, factor=factor))
        exact = floquet_multipliers(damped, speed, rtol=1e-11, **given)
        told = self._told(place, at)
        nearest = np.argmin(np.abs(told[:, :, None] - exact.multipliers[:, None, :]), axis=-1)
        modulus = np.take_along_axis(np.abs(exact.multipliers), nearest, axis=-1)
        error = np.take_along_axis(exact.error, nearest, axis=-1) + 1e-10
        best = np.argmax(modulus, axis=-1)[:, None]
        return (
            np.take_along_axis(modulus, best, axis=-1)[:, 0],
            np.take_along_axis(error, best, axis=-1)[:, 0],
        )

    def _told(self, place: int, at: Array) -> ComplexArray:
        """Return the multipliers of the series, two orders beyond the tongue's; ``(nb, r)``."""
        which = int(self.places.which[place])
        operator, centre = self.tongue.operators[which], float(self.tongue.centres[which])
        matrices = operator.polynomials(
            float(self.places.eps[place]), float(self.places.damping.ravel()[place]), operator.order
        )
        speed = self.resonance.detuning == "speed"
        sigma = centre / at - 1 if speed else at / centre - 1
        powers = sigma[:, None] ** np.arange(len(matrices))
        values = operator.centre + np.linalg.eigvals(np.tensordot(powers, matrices, axes=1))
        told: ComplexArray = np.exp(values * self.system.period)
        return told


def _damped(term: Term, factor: float) -> Term:
    """Return a term, multiplied by a factor where it is damping."""
    if term.array not in DAMPING or factor == 1.0:
        return term
    given = term.function
    scaled = (lambda theta: factor * given(theta)) if callable(given) else factor * given
    return replace(term, function=scaled)
