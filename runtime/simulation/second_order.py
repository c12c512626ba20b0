"""Second-order form of a linear periodic system, its terms sampled once for all speeds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.families import MATRICES, LinearPeriodic
from ..core.trigonometric import even_angles
from ..periodic.equation import SPEED_POWER
from ..periodic.first_order import CanonicalForm

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# What round-off leaves of a harmonic that is not there, over the largest: always, at most.
_NOISE = 32 * _EPS
_MOST_NOISE = 1e-11
_FEWEST = 64
_MOST = 4096
# Numbers kept with a system, 128 MiB.
_MOST_KEPT = 2**24


def even_count(system: LinearPeriodic, least: int = _FEWEST) -> int:
    """Return how many even angles see every harmonic that the terms have, a power of two."""
    reach = 0
    for row, term in enumerate(system.terms):
        amplitude = system.spectrum(row) if term.array in SPEED_POWER else np.zeros(1)
        if len(amplitude) > 1:
            top = float(np.max(amplitude, initial=0.0))
            # Where the upper harmonics are noise, it is theirs.
            floor = 10 * float(np.median(amplitude[len(amplitude) // 2 :]))
            least_seen = max(_NOISE * top, min(floor, _MOST_NOISE * top))
            seen = np.flatnonzero(amplitude > least_seen)
            reach = max(reach, int(seen[-1]) if len(seen) else 0)
    wanted = max(least, 2 * reach + 2)
    power = int(np.ceil(np.log2(wanted)))
    return int(min(2**power, _MOST))


def term_samples(
    system: LinearPeriodic, key: tuple[object, ...], angles: Callable[[], Array]
) -> tuple[Array, ...]:
    """Return the values of all terms at angles, kept with the system under a key.

    Shapes as :func:`_values` has them.
    """
    known = system.kept.get(key)
    if known is None:
        theta = angles()
        known = _values(system, theta)
        keep(system, key, known)
    return known


def _values(system: LinearPeriodic, theta: Array) -> tuple[Array, ...]:
    """Return the values of the terms at angles, ``(nt, n, n)`` or ``(nt, n)``.

    One value where a term is constant, none where it acts only while the crank accelerates.
    """
    return tuple(
        np.asarray(term(theta[:1] if term.constant else theta), dtype=float)
        if term.array in SPEED_POWER
        else np.zeros((0, *(system.size,) * (2 if term.array in MATRICES else 1)))
        for term in system.terms
    )


def keep(system: LinearPeriodic, key: tuple[object, ...], values: tuple[Array, ...]) -> None:
    """Leave arrays with a system for the next solver; older ones go where they grow too many."""
    size = sum(value.size for value in values)
    # A list: another thread may add to it meanwhile.
    held = sum(value.size for group in list(system.kept.values()) for value in group)
    if held + size > _MOST_KEPT:
        system.kept.clear()
    if size <= _MOST_KEPT:
        system.kept[key] = values


def even_samples(system: LinearPeriodic, count: int) -> tuple[Array, ...]:
    """Return the values of all terms at even angles, kept with the system."""
    return term_samples(system, ("even", count), lambda: even_angles(system.period, count))


def _slopes(system: LinearPeriodic, count: int) -> tuple[Array, ...]:
    """Return the derivatives of M and A at even angles, by their Fourier series."""
    key = ("even slopes", count)
    known = system.kept.get(key)
    if known is None:
        values = even_samples(system, count)
        known = tuple(
            _slope(value, system.period) if term.array in ("M", "A") else value[:0]
            for term, value in zip(system.terms, values, strict=True)
        )
        keep(system, key, known)
    return known


def _slope(values: Array, period: float) -> Array:
    count = len(values)
    if count == 1:
        return np.zeros_like(values)
    series = np.fft.rfft(values, axis=0)
    if count % 2 == 0:
        series[-1] = 0.0
    waves = 1j * (2 * np.pi / period) * np.arange(len(series))
    slope: Array = np.fft.irfft(waves.reshape(-1, 1, 1) * series, n=count, axis=0)
    return slope


def combined(
    form: CanonicalForm, values: tuple[Array, ...], names: tuple[str, ...], signs: tuple[int, ...]
) -> Array:
    """Return a signed sum of arrays from samples of their terms.

    Shape ``(nb, nt, n, n)`` or ``(nb, nt, n)``, nt 1 where all that acts is constant.
    """
    n = form.system.size
    sign = dict(zip(names, signs, strict=True))
    rows = [
        (sign[term.array] * factor, value)
        for term, factor, value in zip(form.system.terms, form.factors, values, strict=True)
        if term.array in sign and np.any(factor) and len(value)
    ]
    shape = (n, n) if names[0] in MATRICES else (n,)
    count = len(form.speed)
    if not rows:
        return np.zeros((count, 1, *shape))
    nt = max(len(value) for _, value in rows)
    total: Array = np.zeros((count, nt, *shape))
    for group in (True, False):
        part = [(factor, value) for factor, value in rows if (len(value) == 1) == group]
        if part:
            factors = np.stack([factor for factor, _ in part], axis=1)
            stacked = np.stack([value for _, value in part])
            flat = factors @ stacked.reshape(len(part), -1)
            total += flat.reshape(count, *stacked.shape[1:])
    return total


@dataclass(frozen=True)
class SecondOrder:
    """Coefficients of ``M q'' + G q' + H q = F`` at angles, ' = d/dtheta.

    ``G = M' + A - A^T + C/w``, ``H = A' - B + (K + Kg)/w^2 + D/w``, ``F = f + h/w + p/w^2``.

    Attributes
    ----------
    mass, rate, stiffness : ndarray
        M, G, H, shape ``(nb, nt, n, n)``; nt is 1 where constant.
    force : ndarray
        F, shape ``(nb, nt, n)``.
    """

    mass: Array
    rate: Array
    stiffness: Array
    force: Array


def second_order(form: CanonicalForm, count: int, every: int = 1) -> SecondOrder:
    """Return the coefficients at every so many of ``count`` even angles."""
    system = form.system
    values = tuple(_thin(value, every) for value in even_samples(system, count))
    slopes = tuple(_thin(value, every) for value in _slopes(system, count))
    return _coefficients(form, values, slopes)


def _coefficients(
    form: CanonicalForm, values: tuple[Array, ...], slopes: tuple[Array, ...]
) -> SecondOrder:
    gyro = combined(form, values, ("A",), (1,))
    return SecondOrder(
        mass=combined(form, values, ("M",), (1,)),
        rate=combined(form, slopes, ("M",), (1,))
        + gyro
        - np.swapaxes(gyro, -1, -2)
        + combined(form, values, ("C",), (1,)),
        stiffness=combined(form, slopes, ("A",), (1,))
        + combined(form, values, ("B", "K", "Kg", "D"), (-1, 1, 1, 1)),
        force=combined(form, values, ("f", "h", "p"), (1, 1, 1)),
    )


def second_order_at(form: CanonicalForm, theta: Array) -> SecondOrder:
    """Return the coefficients at any angles ``(nt,)``; the slopes of M and A by their series."""
    system = form.system
    values = _values(system, theta)
    count = even_count(system)
    waves = np.exp(1j * np.outer(theta, np.arange(count // 2 + 1)) * (2 * np.pi / system.period))
    # Each harmonic but the mean stands for two.
    waves[:, 1:] *= 2.0
    slopes = tuple(
        value if len(value) <= 1 else _summed(waves, value) for value in _slopes(system, count)
    )
    return _coefficients(form, values, slopes)


def _summed(waves: ComplexArray, samples: Array) -> Array:
    series = np.fft.rfft(samples, axis=0).reshape(len(samples) // 2 + 1, -1) / len(samples)
    total: Array = (waves @ series).real.reshape(len(waves), *samples.shape[1:])
    return total


def _thin(values: Array, every: int) -> Array:
    return values if len(values) <= 1 else values[::every]


@dataclass(frozen=True)
class Series:
    """Fourier coefficients of ``M q'' + G q' + H q = F`` at one speed, harmonics 0 to r.

    Attributes
    ----------
    mass, rate, stiffness : ndarray of complex
        Shape ``(r + 1, n, n)``; a real array has the conjugates at the negative ones.
    force : ndarray of complex
        Shape ``(s + 1, n)``.
    aliased : float
        Amplitude of the highest harmonics sampled over the largest: what those beyond are mistaken
        for, where a coefficient is not smooth; 0 where they are round-off.
    """

    mass: ComplexArray
    rate: ComplexArray
    stiffness: ComplexArray
    force: ComplexArray
    aliased: float


def series_of(form: CanonicalForm, count: int) -> list[Series]:
    """Return the Fourier coefficients of each of a batch, what is round-off cut off."""
    found = second_order(form, count)
    arrays = [
        np.fft.rfft(np.broadcast_to(a, (len(a), count, *a.shape[2:])), axis=1) / count
        for a in (found.mass, found.rate, found.stiffness, found.force)
    ]
    out = []
    for mass, rate, stiffness, force in zip(*arrays, strict=True):
        reach = max(_reach(part) for part in (mass, rate, stiffness))
        cut = slice(0, reach + 1)
        own = slice(0, _reach(force) + 1)
        aliased = max(_aliased(part) for part in (mass, rate, stiffness, force))
        out.append(Series(mass[cut], rate[cut], stiffness[cut], force[own], aliased))
    return out


def _aliased(series: ComplexArray) -> float:
    size = np.max(np.abs(series.reshape(len(series), -1)), axis=1, initial=0.0)
    top, highest = float(np.max(size)), float(np.max(size[7 * len(size) // 8 :]))
    return highest / top if highest > _MOST_NOISE * top else 0.0


def _reach(series: ComplexArray) -> int:
    """Return the highest harmonic above round-off, the one that stands for two left out."""
    size = np.max(np.abs(series.reshape(len(series), -1)), axis=1, initial=0.0)[:-1]
    seen = np.flatnonzero(size > _EPS * np.max(size, initial=0.0))
    return int(seen[-1]) if len(seen) else 0
