"""Characteristic exponents of Hill's equation at given lam2, and the lam2 of a given exponent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import pi
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes
from ..core.results import Check, DeferredChecks, Result, provenance
from .boundaries import half_trace_check, sample_of
from .checks import EPS, LARGEST, Array, Mask, axes_over, check_function, check_regions, points
from .fourier_matrix import chunks, couplings, truncation
from .half_trace import discriminant
from .meissner import Meissner


@dataclass(frozen=True, kw_only=True)
class CharacteristicExponents(Result):
    """Exponents of the solutions ``exp((growth +- i nu) theta) p(theta)`` of Hill's equation.

    Attributes
    ----------
    growth : ndarray
        Real part of the larger exponent: -K within the bands, above it in the unstable regions of
        the undamped equation.  The other exponent has ``-2 K - growth``.
    nu : ndarray, same shape
        Imaginary part, in [0, 1/2]; as given where it was.
    error : ndarray, same shape
        Estimate of the absolute error of the exponent, which grows like a square root near nu = 0
        and 1/2; of lam2 where nu was given.
    lam2, mu, damping : ndarray
        In shapes that broadcast to it; lam2 has the bands as first axis where nu was given.
    bands : tuple of int
        Numbers of the bands where nu was given, else empty.
    """

    growth: Array
    nu: Array
    lam2: Array
    mu: Array
    damping: Array
    bands: tuple[int, ...] = ()

    arrays_along: ClassVar = {"...": "growth nu error lam2 mu damping stable", "band": "bands"}
    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def stable(self) -> Mask:
        """True where no solution grows."""
        return np.asarray(self.growth < 0.0) | (np.asarray(self.growth == 0.0) & (self.nu > 0.0))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the bands over nu, or growth and nu over a line of lam2.

        Raises ``BadInput`` if nu, or lam2, is not a line.
        """
        across = self.nu if self.bands else np.squeeze(self.lam2)
        name = "nu" if self.bands else "lam2"
        ax = axes_over(ax, "CharacteristicExponents.plot", name, across)
        if self.bands:
            ax.plot(across, self.lam2.T)
            ax.set(xlabel=r"$\nu$", ylabel=r"$\lambda^2$")
            return ax
        ax.plot(across, np.ravel(self.growth), label="growth")
        ax.plot(across, np.ravel(self.nu), label=r"$\nu$")
        ax.set(xlabel=r"$\lambda^2$", ylabel="parts of the exponent [1/rad]")
        ax.legend()
        return ax


def characteristic_exponents(
    f: PeriodicFunction | Meissner,
    lam2: ArrayLike | None,
    mu: ArrayLike,
    damping: ArrayLike = 0.0,
    *,
    nu: ArrayLike | None = None,
    bands: Sequence[int] = (0, 1, 2),
) -> CharacteristicExponents:
    """Return the characteristic exponents of y'' + 2 K y' + (lam2 + mu f) y = 0, or invert them.

    Parameters
    ----------
    f : PeriodicFunction or Meissner
        Coefficient of period 2 pi; a PeriodicFunction where ``nu`` is given.
    lam2 : array_like or None
        None to have it from ``nu``: the values with solutions ``exp((i nu - K) theta)`` times a
        periodic function, quasi-periodic but for the decay that damping brings.
    mu, damping : array_like
        Any shapes that broadcast with each other and lam2 or nu; K at least zero.
    nu : array_like, optional
        In place of lam2; nu + 1 and -nu mean the same as nu, and 0 and 1/2 give the boundaries of
        the undamped regions.
    bands : sequence of int
        With ``nu``: numbers from 0; band j lies between the unstable regions j and j + 1.

    Returns
    -------
    CharacteristicExponents
        Infinite growth where the half trace exceeds the range of doubles, which fails a check.
        With ``nu`` the check compares the half trace with ``exp(-2 pi K) cos(2 pi nu)`` at up to
        24 points.

    Raises
    ------
    BadInput
        If both or neither of lam2 and nu are given, or a band is not a whole number >= 0; as
        :func:`.half_trace.discriminant` and :func:`.boundaries.hill_boundaries`.

    Notes
    -----
    The multipliers are ``exp(-2 pi K)`` times the roots of ``rho + 1/rho = 2 x`` with x the half
    trace of the undamped equation at lam2 - K^2 (Smith (7.9), (7.39)).  The other way the matrix
    in the harmonics of the periodic function is Hermitian, ``(m + nu)^2`` on its diagonal and
    ``-mu c_j`` beside it; K^2 only shifts lam2.  What its truncation leaves out is bounded as that
    of the boundaries, its rows counted by the whole part of ``|m + nu|``.

    Examples
    --------
    >>> import elastolink as el
    >>> cosine = el.PeriodicFunction(a=[0.0, 1.0])
    >>> found = el.characteristic_exponents(cosine, lam2=[0.25, 0.6], mu=0.1)
    >>> print(found.growth.round(4), found.stable)
    [0.0498 0.    ] [False  True]
    """
    if (lam2 is None) == (nu is None):
        given = "neither" if nu is None else "both"
        raise bad("lam2, nu", given, "one of them", "pass lam2=None to have it from nu")
    if nu is not None:
        return _bands(check_function(f), mu, damping, nu, bands)
    half = discriminant(f, lam2 if lam2 is not None else 0.0, mu, damping)
    k = half.damping
    growth, turn = _exponent(half.value, k)
    error = np.zeros(half.value.shape)
    with np.errstate(invalid="ignore"):
        for side in (-1.0, 1.0):
            other, turned = _exponent(half.value + side * half.error, k)
            error = np.maximum(error, np.hypot(other - growth, turned - turn))
    error = np.where(np.isfinite(growth), error + EPS * (np.abs(growth) + 2.0 * k + 1.0), np.inf)
    return CharacteristicExponents(
        method="half trace by " + half.method,
        error=error,
        error_norm="absolute, entrywise, of the complex exponent",
        checks=half.checks,
        provenance=provenance(),
        growth=growth,
        nu=turn,
        lam2=half.lam2,
        mu=half.mu,
        damping=k,
    )


def _exponent(half: Array, k: Array) -> tuple[Array, Array]:
    """Return growth and nu from the damped half trace."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        # log |x|, with x = half exp(2 pi K), cannot overflow.
        log = np.log(np.abs(half)) + 2.0 * pi * k
        outside = log > 0.0
        x = np.where(outside, np.sign(half), np.sign(half) * np.exp(np.minimum(log, 0.0)))
        inverse = np.exp(-2.0 * np.maximum(log, 0.0))
        rise = np.maximum(log, 0.0) + np.log1p(np.sqrt(1.0 - inverse))
    growth = np.where(outside, rise, 0.0) / (2.0 * pi) - k
    return growth, np.arccos(np.clip(x, -1.0, 1.0)) / (2.0 * pi)


def _bands(
    f: PeriodicFunction, mu: ArrayLike, damping: ArrayLike, nu: ArrayLike, bands: Sequence[int]
) -> CharacteristicExponents:
    """Return the lam2 of each band with a given multiplier ``exp(2 pi (i nu - K))``."""
    numbers = check_regions(bands, most=LARGEST - 1, name="bands")
    (flat, turn, friction), shape = points(mu=mu, nu=nu, damping=damping)
    lam2, error = np.zeros((2, len(numbers), flat.size))
    if lam2.size:
        cut = truncation(f, float(np.abs(flat).max()), max(numbers) + 1)
        mean, shift = -f.a[0] * flat, friction * friction
        # Between 0 and 1/2: a reflection of theta, or another count of the harmonics.
        folded = np.abs(turn - np.rint(turn))
        m = np.arange(-cut.harmonic - 1, cut.harmonic + 1)
        coupling = couplings(f, m.size)
        for part in chunks(flat.size, m.size):
            stack = flat[part, None, None] * coupling
            stack[:, np.arange(m.size), np.arange(m.size)] += np.square(m + folded[part, None])
            lam2[:, part] = np.linalg.eigvalsh(stack)[:, list(numbers)].T
        lam2 += mean + shift
        # nu itself is rounded when it is folded.
        slopes = (np.array(numbers)[:, None] + 1.0) * EPS * np.maximum(1.0, np.abs(turn))
        error = cut.left_out + cut.rounding + EPS * (np.abs(mean) + shift) + slopes
        error += f.error * np.abs(flat)
    full = (len(numbers), *shape)
    return CharacteristicExponents(
        method="Hermitian Hill matrix",
        error=error.reshape(full),
        error_norm="absolute, entrywise, of lam2",
        checks=DeferredChecks(partial(_checks, f, flat, turn, friction, lam2, error)),
        provenance=provenance(),
        growth=np.broadcast_to(-friction.reshape(shape), full),
        nu=turn.reshape(shape),
        lam2=lam2.reshape(full),
        mu=flat.reshape(shape),
        damping=friction.reshape(shape),
        bands=numbers,
    )


def _checks(
    f: PeriodicFunction, mu: Array, nu: Array, k: Array, lam2: Array, error: Array
) -> Mapping[str, Check]:
    """Compare half traces at a sample with their value for the multiplier."""
    places = np.argwhere(np.isfinite(lam2))
    if not len(places):
        return {}
    row, column = sample_of(places)
    level = np.exp(-2.0 * pi * k[column]) * np.cos(2.0 * pi * nu[column])
    check = half_trace_check(f, lam2[row, column], error[row, column], mu[column], k[column], level)
    return {"half trace over what the errors explain": check}
