"""Random linkages within tolerances: what the spread of lengths and masses really does."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from ..core.errors import bad
from ..core.inputs import is_whole
from ..core.results import Check, Result
from .linkage import Array

if TYPE_CHECKING:
    from .length_tolerances import Tolerances

Distribution = Literal["normal", "uniform"]
# Standard deviations over the tolerance.
_SPREADS = {"normal": 1.0 / 3.0, "uniform": 1.0 / math.sqrt(3.0)}
# Numbers in one array at a time.
_CHUNK = 200_000
# Chance that one of all the comparisons fails where both sides are right.
_CHANCE = 1e-6


@dataclass(frozen=True, kw_only=True)
class ToleranceTrial(Result):
    """Mean and standard deviation of every output over random linkages.

    ``error`` holds the statistical error of ``standard_deviation`` in 99 of 100 trials; its shape.

    Attributes
    ----------
    outputs : tuple of str
        Names of the outputs.
    mean_shift : ndarray, shape (outputs, ...)
        Mean of each output less its nominal value: second-order, and statistical error.
    standard_deviation : ndarray, shape (outputs, ...)
        Of each output.
    expected : ndarray, shape (outputs, ...)
        Standard deviation to first order.
    least, greatest : ndarray, shape (outputs, ...)
        Extremes of the deviations.
    samples, lost : int
        How many linkages were drawn, and how many could not reach an angle and were left out.
    distribution : str
        Of the parameters.
    """

    outputs: tuple[str, ...]
    mean_shift: Array
    standard_deviation: Array
    expected: Array
    least: Array
    greatest: Array
    samples: int
    lost: int
    distribution: str

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("mean_shift", "standard_deviation", "expected", "least", "greatest", "error"),
        ("output", "angle"),
    )


def trial(
    nominal: Tolerances, samples: int, seed: int, distribution: Distribution
) -> ToleranceTrial:
    """Return the outcome of a Monte Carlo trial; see :meth:`Tolerances.monte_carlo`."""
    if distribution not in _SPREADS:
        raise bad("distribution", repr(distribution), f"one of {sorted(_SPREADS)}", "choose one")
    for name, number, fewest in (("samples", samples, 2), ("seed", seed, 0)):
        if not is_whole(number, fewest):
            raise bad(name, repr(number), f"an integer of at least {fewest}", "correct it")
    random = np.random.default_rng(seed)
    # Deviations over the worst case: their squares neither overflow nor vanish.
    unit = np.where(nominal.worst_case > 0.0, nominal.worst_case, 1.0)
    total = np.zeros_like(unit)
    squares, kept, done = np.zeros_like(total), 0, 0
    least, greatest = np.full_like(total, np.inf), np.full_like(total, -np.inf)
    chunk = max(1, _CHUNK // max(1, nominal.theta2.size))
    while done < samples:
        count = min(chunk, samples - done)
        deviation = _deviations(nominal, random, count, distribution) / unit
        good = np.all(np.isfinite(deviation), axis=tuple(range(1, deviation.ndim)))
        deviation = deviation[good]
        total += np.sum(deviation, axis=0)
        squares += np.sum(np.square(deviation), axis=0)
        least = np.minimum(least, np.min(deviation, axis=0, initial=np.inf))
        greatest = np.maximum(greatest, np.max(deviation, axis=0, initial=-np.inf))
        kept, done = kept + int(np.count_nonzero(good)), done + count
    if kept < 2:
        found = f"{kept} linkages that reach every angle"
        raise bad("tolerances", found, "at least 2", "narrow the tolerances")
    mean = total / kept
    spread = unit * np.sqrt(np.maximum(squares - kept * np.square(mean), 0.0) / (kept - 1))
    shift = unit * mean
    expected = nominal.root_sum_square * _SPREADS[distribution]
    error = _quantile(kept - 1) * spread
    return ToleranceTrial(
        outputs=nominal.outputs,
        mean_shift=shift,
        standard_deviation=spread,
        expected=expected,
        least=unit * least,
        greatest=unit * greatest,
        samples=samples,
        lost=samples - kept,
        distribution=distribution,
        method=f"Monte Carlo, seed {seed}",
        error=error,
        error_norm="standard deviation of each output, absolute, entrywise",
        checks=_checks(nominal, shift, spread, expected, kept),
        provenance=nominal.provenance,
    )


def _quantile(freedom: int) -> float:
    """Return what holds the error of 99 of 100 standard deviations, relative; chi-square law."""
    from scipy.special import chdtri

    low, high = (float(chdtri(freedom, share)) for share in (0.995, 0.005))
    return max(math.sqrt(freedom / low) - 1.0, 1.0 - math.sqrt(freedom / high))


def _deviations(
    nominal: Tolerances, random: np.random.Generator, count: int, distribution: Distribution
) -> Array:
    """Return deviations of the outputs of random linkages, shape (count, outputs, ...)."""
    model = nominal.model
    shape = (count, len(nominal.parameters))
    drawn = (
        random.normal(0.0, _SPREADS["normal"], shape)
        if distribution == "normal"
        else random.uniform(-1.0, 1.0, shape)
    )
    numbers = {}
    for place, name in enumerate(nominal.parameters):
        column = model.values[name] + nominal.tolerance[place] * drawn[:, place]
        numbers[name] = np.reshape(column, (count,) + (1,) * model.theta.ndim)
    values = model.evaluate(numbers)
    full = (count, *model.theta.shape)
    deviation = np.stack([np.broadcast_to(values[name], full) for name in nominal.outputs], axis=1)
    deviation = deviation - nominal.nominal
    for row, name in enumerate(nominal.outputs):
        if name in ("theta3", "theta4"):
            # A linkage of the other type counts its turns from elsewhere.
            deviation[:, row] = np.remainder(deviation[:, row] + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(deviation)


def _checks(
    nominal: Tolerances, shift: Array, spread: Array, expected: Array, kept: int
) -> dict[str, Check]:
    """Compare with the first order: within the statistical error and the error."""
    # |Z| exceeds z with a chance below exp(-z^2/2); every output and angle is one comparison.
    quantile = math.sqrt(2.0 * math.log(max(spread.size, 1) / _CHANCE))
    axes = tuple(range(1, nominal.nominal.ndim))
    size = np.max(np.abs(nominal.nominal), axis=axes, initial=0.0, keepdims=True)
    allowed = np.asarray(nominal.error) + 64.0 * np.finfo(float).eps * size
    allowed = np.maximum(allowed, np.finfo(float).tiny)
    off_spread = np.abs(spread - expected) / (
        quantile * np.maximum(spread, expected) / math.sqrt(2.0 * (kept - 1)) + allowed
    )
    off_mean = np.abs(shift) / (quantile * spread / math.sqrt(kept) + allowed)
    return {
        "spread within its statistical error and the bound": Check(
            float(np.max(off_spread, initial=0.0)), 1.0
        ),
        "mean within its statistical error and the bound": Check(
            float(np.max(off_mean, initial=0.0)), 1.0
        ),
    }
