"""What a steady state is refused for beforehand, and what it is checked by afterwards."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning, bad
from ..core.families import LinearPeriodic
from ..core.results import Check
from ..periodic import FloquetMultipliers
from ..periodic.first_order import CanonicalForm
from ..simulation.trajectory import LINEAR_RANGE
from .request import Found

Array = NDArray[np.float64]

# Places along the link at which the linear range is watched.
_PLACES = np.linspace(0.0, 1.0, 26)
# Angles, half-way between those given, at which the equation is looked at.
_PLACES_BETWEEN = 64
# Numbers in q of a batch, half a GiB; qd and what they are made of take as much each.
_MOST_FLOATS = 2**26


def check_forcing(form: CanonicalForm) -> None:
    """Refuse a system on which nothing acts."""
    acting = any(
        term.array in ("f", "h", "p")
        and bool(np.any(factor))
        and bool(np.any(form.system.spectrum(row)))
        for row, (term, factor) in enumerate(zip(form.system.terms, form.factors, strict=True))
    )
    if not acting:
        found = "forcing that is zero" if form.forced else "a system without forcing f, h, p"
        raise bad("steady_state", found, "a forced system", "add the forcing")


def check_memory(form: CanonicalForm, angles: int) -> None:
    """Refuse motions that would fill the memory."""
    floats = len(form.speed) * angles * 2 * form.system.size
    if floats > _MOST_FLOATS:
        raise bad(
            "steady_state",
            f"{len(form.speed)} motions at {angles} angles",
            f"at most {_MOST_FLOATS // (angles * 2 * form.system.size)} of them at a time",
            "take the speeds in parts, the slow ones by themselves, or steady_peaks",
        )


def nearness(found: FloquetMultipliers, count: int) -> tuple[Array, Array]:
    """Return the distance of the closest multiplier from 1 and its error, ``(nb,)`` each."""
    values = found.multipliers.reshape(count, -1)
    gaps = np.abs(values - 1.0)
    closest = np.argmin(gaps, axis=-1)[:, None]
    doubt = np.take_along_axis(found.error.reshape(count, -1), closest, axis=-1)
    return np.take_along_axis(gaps, closest, axis=-1)[:, 0], doubt[:, 0]


def checks_of(form: CanonicalForm, found: Found) -> dict[str, Check]:
    """Return the checks that all methods share: convergence, and the equation itself."""
    worst = np.max(found.error, axis=-1, initial=0.0)
    known = np.flatnonzero(np.isfinite(worst))
    if not len(known):
        return dict(found.checks)
    ratio = found.error[known] / found.allowed[known]
    checks = {"converged": Check(float(np.max(ratio)), 1.0)}
    place = int(known[np.argmax(worst[known])])
    if len(found.theta) % 2 == 0:
        one = slice(place, place + 1)
        checks["residual"] = _residual(
            form.take(one), found.theta, found.q[place], found.slope[place], float(worst[place])
        )
    return {**checks, **found.checks}


def _residual(form: CanonicalForm, theta: Array, q: Array, slope: Array, error: float) -> Check:
    """Put the motion's Fourier series into the equation half-way between some of the angles.

    The series' derivative has nothing to do with the method.  Limit: an error of the highest
    harmonic kept, over the rate of the system.
    """
    count, m = len(theta), 2 * form.system.size
    mass, gyro = form.require_mass(form.assemble("M", theta)), form.assemble("A", theta)
    p = _times(mass[0], slope) + (0.0 if gyro is None else _times(gyro[0], q))
    states = np.concatenate([q, p], axis=1) / form.scale[0, :m]
    waves = np.arange(count // 2 + 1) * (2 * np.pi / form.system.period)
    shift = np.exp(0.5j * waves * (theta[1] - theta[0]))[:, None]
    half = np.fft.rfft(states, axis=0) * shift
    half[-1] = 0.0
    every = max(1, count // _PLACES_BETWEEN)
    between = np.fft.irfft(half, n=count, axis=0)[::every]
    rise = np.fft.irfft(1j * waves[:, None] * half, n=count, axis=0)[::every]
    generator = form.generator(theta[::every] + 0.5 * (theta[1] - theta[0]))[0]
    expected = _times(generator[:, :m, :m], between) + generator[:, :m, -1]
    size = np.max(np.abs(states)) * (waves[-1] + float(form.rate[0]))
    value = float(np.max(np.abs(rise - expected)) / size)
    return Check(value, 10 * error)


def _times(matrices: Array, vectors: Array) -> Array:
    value: Array = (matrices @ vectors[..., None])[..., 0]
    return value


def largest_deflection(system: LinearPeriodic, theta: Array, q: Array) -> float | None:
    """Return the largest deflection over the length; None where the system knows of none."""
    watched: Callable[[Array], Array] | None = getattr(system, "relative_deflection", None)
    shapes = None if watched is None else np.asarray(watched(theta), dtype=float)
    if shapes is None:
        shapes = system.shapes(_PLACES, theta)
    if shapes is None:
        return None
    found = 0.0
    for one in q:
        if np.all(np.isfinite(one)):
            values = np.einsum("txn,tn->tx", shapes, one)
            found = max(found, float(np.max(np.abs(values))))
    return found


def warn_beyond(largest: float) -> None:
    """Warn whoever called the caller where a deflection over the length is beyond 5 %."""
    if largest > LINEAR_RANGE:
        warnings.warn(
            f"deflection reaches {largest:.3g} of the reference length; the linear equations "
            f"hold to about {LINEAR_RANGE}: leave out resonant speeds or add damping",
            LinearRangeWarning,
            stacklevel=3,
        )
