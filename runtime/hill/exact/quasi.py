"""Quasi-periodic solutions of Hill's equation: bands lam2(nu), and exponents at given lam2."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import pi
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import BadInput, bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import BROADCAST, Check, DeferredChecks, Result, provenance
from ..half_trace import arguments, check_function, discriminant
from ..transfer import EPS
from .layout import LARGEST, truncation
from .verification import LIMIT, half_trace_near, sample_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_CHUNK = 2**18


@dataclass(frozen=True, kw_only=True)
class BlochBands(Result):
    """Values of lam2 with a solution ``exp((i nu - K) theta) p(theta)``, p of period 2 pi.

    Attributes
    ----------
    lam2 : ndarray, shape (len(bands), *shape)
        Rising with the band, where shape is the broadcast one of mu, nu and damping.
    error : ndarray, same shape
        Estimate of the absolute error; the part of the truncation is proved.
    bands : tuple of int
        Numbers from 0.
    mu, nu, damping : ndarray, shape ``shape``
        As given.
    """

    lam2: Array
    bands: tuple[int, ...]
    mu: Array
    nu: Array
    damping: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "lam2": ("band", "point"),
        "error": ("band", "point"),
        "bands": ("band",),
        "mu": ("point",),
        "nu": ("point",),
        "damping": ("point",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the bands over nu.

        Raises
        ------
        BadInput
            If nu is not a line.
        """
        from ...core.plotting import axes_or_new

        if self.nu.ndim != 1:
            raise bad("BlochBands.plot", f"nu of shape {self.nu.shape}", "a line", "slice it")
        ax = axes_or_new(ax)
        for band in self.lam2:
            ax.plot(self.nu, band)
        ax.set_xlabel(r"$\nu$")
        ax.set_ylabel(r"$\lambda^2$")
        return ax


def bloch_bands(
    f: PeriodicFunction,
    mu: ArrayLike,
    nu: ArrayLike,
    bands: Sequence[int] = (0, 1, 2),
    damping: ArrayLike = 0.0,
) -> BlochBands:
    """Return the lam2 for which y'' + 2 K y' + (lam2 + mu f) y = 0 has a given multiplier.

    The multiplier over 2 pi is ``exp(2 pi (i nu - K))``: for real nu the solution is
    quasi-periodic but for the decay that damping brings.  nu = 0 and 1/2 give the boundaries of
    the undamped regions.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    mu, nu, damping : array_like
        Any shapes that broadcast; K at least zero.  nu + 1 and -nu mean the same as nu.
    bands : sequence of int
        Numbers from 0; band j lies between the unstable regions j and j + 1.

    Returns
    -------
    BlochBands
        Its check compares the half trace with ``exp(-2 pi K) cos(2 pi nu)`` at up to 24 points.

    Raises
    ------
    BadInput
        If an argument is not finite, shapes do not broadcast, K is negative, a band is not a
        whole number >= 0, or the matrix would need more than 2048 harmonics.

    Notes
    -----
    With ``y = exp((i nu - K) theta) p`` the matrix in the harmonics of p is Hermitian,
    ``(m + nu)^2`` on its diagonal and ``-mu c_j`` beside it; K^2 only shifts lam2.  The bound of
    what its truncation leaves out is that of :func:`.layout.truncation`, whose rows are counted by
    the whole part of ``|m + nu|``.
    """
    check_function(f)
    numbers = _check_bands(bands)
    (amp, phase, k), shape = arguments(mu=mu, nu=nu, damping=damping)
    flat, turn, friction = (np.broadcast_to(item, shape).ravel() for item in (amp, phase, k))
    lam2, error = _bands(f, flat, turn, numbers)
    lam2 = lam2 + friction * friction
    error = error + EPS * friction * friction
    full = (len(numbers), *shape)
    return BlochBands(
        method="Hermitian Hill matrix",
        error=error.reshape(full),
        error_norm="absolute, entrywise",
        checks=DeferredChecks(partial(_checks, f, flat, turn, friction, lam2, error)),
        provenance=provenance(),
        lam2=lam2.reshape(full),
        bands=numbers,
        mu=flat.reshape(shape),
        nu=turn.reshape(shape),
        damping=friction.reshape(shape),
    )


def _check_bands(bands: Sequence[int]) -> tuple[int, ...]:
    try:
        numbers = tuple(int(n) for n in bands)
        good = all(n == given and n >= 0 for n, given in zip(numbers, bands, strict=True))
    except (TypeError, ValueError):
        good = False
    if not good:
        raise bad("bands", repr(bands), "whole numbers >= 0", "for example (0, 1)")
    if numbers and max(numbers) >= LARGEST:
        raise bad("bands", max(numbers), f"less than {LARGEST}", "ask for lower bands")
    return numbers


def _bands(
    f: PeriodicFunction, mu: Array, nu: Array, bands: tuple[int, ...]
) -> tuple[Array, Array]:
    if not bands or not mu.size:
        return np.zeros((len(bands), mu.size)), np.zeros((len(bands), mu.size))
    cut = truncation(f, float(np.abs(mu).max()), max(bands) + 1)
    mean = -f.a[0] * mu
    # Between 0 and 1/2: a reflection of theta, or another count of the harmonics.
    folded = np.abs(nu - np.rint(nu))
    m = np.arange(-cut.harmonic - 1, cut.harmonic + 1)
    apart = m[:, None] - m
    inside = np.minimum(np.abs(apart), f.harmonics)
    c = 0.5 * (f.a[inside] - 1j * np.sign(apart) * f.b[inside])
    c[(np.abs(apart) > f.harmonics) | (apart == 0)] = 0.0
    lam2 = np.empty((len(bands), mu.size))
    step = max(1, _CHUNK // (m.size * m.size))
    for start in range(0, mu.size, step):
        part = slice(start, start + step)
        stack = -mu[part, None, None] * c
        stack[:, np.arange(m.size), np.arange(m.size)] += np.square(m + folded[part, None])
        lam2[:, part] = np.linalg.eigvalsh(stack)[:, list(bands)].T
    # As for the boundaries; nu itself is rounded when it is folded.
    rounding = EPS * max(4.0, 0.25 * m.size**0.5) * cut.norm
    slopes = (np.array(bands)[:, None] + 1.0) * EPS * np.maximum(1.0, np.abs(nu))
    error = cut.left_out + rounding + EPS * np.abs(mean) + f.error * np.abs(mu) + slopes
    return lam2 + mean, error


def _checks(
    f: PeriodicFunction, mu: Array, nu: Array, k: Array, lam2: Array, error: Array
) -> Mapping[str, Check]:
    """Compare the half trace with its value for the multiplier, over what the figures explain."""
    places = np.argwhere(np.isfinite(lam2))
    if not len(places):
        return {}
    row, column = sample_of(places)
    x, figure = lam2[row, column], error[row, column]
    name = "half trace over what the figures explain"
    try:
        found, explained = half_trace_near(f, x, figure, mu[column], k[column])
    except BadInput:
        return {name: Check(np.nan, LIMIT)}
    with np.errstate(invalid="ignore", over="ignore"):
        level = np.exp(-2.0 * pi * k[column]) * np.cos(2.0 * pi * nu[column])
        share = np.abs(found.value[1] - level) / (explained + 4.0 * EPS)
    return {name: Check(float(share.max()), LIMIT)}


@dataclass(frozen=True, kw_only=True)
class CharacteristicExponents(Result):
    """Exponents of the solutions ``exp((growth +- i nu) theta) p(theta)`` of Hill's equation.

    Attributes
    ----------
    growth : ndarray
        Real part of the larger exponent: -K within the bands, above it in the unstable regions of
        the undamped equation.  The other exponent has ``-2 K - growth``.
    nu : ndarray, same shape
        Imaginary part, in [0, 1/2].
    error : ndarray, same shape
        Estimate of the absolute error of the exponent; it grows like a square root near nu = 0
        and 1/2.
    lam2, mu, damping : ndarray
        In shapes that broadcast to it.
    """

    growth: Array
    nu: Array
    lam2: Array
    mu: Array
    damping: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("growth", "nu", "error", "lam2", "mu", "damping", "stable"), BROADCAST
    )
    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where no solution grows."""
        return np.asarray(self.growth < 0.0) | (np.asarray(self.growth == 0.0) & (self.nu > 0.0))


def characteristic_exponents(
    f: PeriodicFunction, lam2: ArrayLike, mu: ArrayLike, damping: ArrayLike = 0.0
) -> CharacteristicExponents:
    """Return the characteristic exponents of y'' + 2 K y' + (lam2 + mu f) y = 0.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    lam2, mu, damping : array_like
        Any shapes that broadcast; K at least zero.

    Returns
    -------
    CharacteristicExponents
        Infinite growth where the half trace exceeds the range of doubles, which fails a check.

    Raises
    ------
    BadInput
        As :func:`.half_trace.discriminant`.

    Notes
    -----
    The multipliers are ``exp(-2 pi K)`` times the roots of ``rho + 1/rho = 2 x`` with x the half
    trace of the undamped equation at lam2 - K^2 (Smith (7.9), (7.39)).
    """
    found = discriminant(f, lam2, mu, damping)
    k = found.damping
    growth, nu = _exponent(found.value, k)
    figure = np.zeros(found.value.shape)
    with np.errstate(invalid="ignore"):
        for side in (-1.0, 1.0):
            other, turn = _exponent(found.value + side * found.error, k)
            figure = np.maximum(figure, np.hypot(other - growth, turn - nu))
    figure = np.where(np.isfinite(growth), figure, np.inf)
    return CharacteristicExponents(
        method="half trace by " + found.method,
        error=figure + EPS * (np.abs(np.where(np.isfinite(growth), growth, 0.0)) + 2.0 * k + 1.0),
        error_norm="absolute, entrywise, of the complex exponent",
        checks=found.checks,
        provenance=provenance(),
        growth=growth,
        nu=nu,
        lam2=found.lam2,
        mu=found.mu,
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
