"""Critical speeds as local maxima of the steady state over the speed (Aannaque 7.3)."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning, bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.progress import bar
from ..core.results import Check, provenance
from .critical_result import CriticalSpeeds, Measure, Request
from .critical_scan import scanned_deflections
from .labels import label_speeds
from .natural import natural_frequencies

Array = NDArray[np.float64]

_RTOL, _FINE = 1e-6, 1e-9
# Speeds solved together, and speeds within the bracket of a maximum.
_TOGETHER = 16
_WITHIN = 7
# The second look spans this part of the first bracket.
_CLOSER = 0.25


def by_response(request: Request) -> CriticalSpeeds:
    """Return the speeds of the local maxima of a measure of the periodic motion.

    About a maximum one over the square of the measure is nearly a parabola of the speed; a
    polynomial through seven speeds gives its least value, and one through seven closer speeds
    gives it again.
    """
    system = request.system
    if not any(system.has(name) for name in DAMPING) or not system.is_damped():
        raise bad(
            "system",
            "no damping",
            "a damped system: without damping the maxima are infinite",
            "add some with with_modal_damping",
        )
    measure = request.measure or _deflection_measure(system)
    speeds = np.linspace(request.low, request.high, request.speeds)
    mean = natural_frequencies(system, 0.0, request.count).mean
    values = scanned_deflections(system, speeds) if request.measure is None else None
    if values is None:
        values, _ = _measured(system, speeds, measure, request.progress)
    top = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    if not len(top):
        found = height = error = np.zeros(0)
    else:
        found, height, error = _maxima(system, measure, speeds[top - 1], speeds[top + 1])
    mode, order = label_speeds(mean, found)
    return CriticalSpeeds(
        method=f"local maxima of the steady state, {len(speeds)} speeds scanned",
        error=error,
        error_norm="absolute, of the place of each maximum [rad/s]",
        checks={"placed": Check(float(np.max(error / found, initial=0.0)), 1e-3)},
        provenance=provenance(system.provenance),
        speed=found,
        mode=mode,
        order=order,
        ratio=mean[mode - 1] / (order * found),
        height=height,
        mean_frequency=mean,
        scan_speed=speeds,
        scan=values,
        quantity="response" if request.measure else "r.m.s. deflection over length",
    )


def _deflection_measure(system: LinearPeriodic) -> Measure:
    """Return the largest root of the mean square of the deflections over the length."""
    relative = system.relative_deflection
    if relative is None and system.shape is None and system.moving_shape is None:
        raise bad(
            "measure",
            "a system whose deflections are not known",
            "mode shapes or relative_deflection",
            "give a measure",
        )

    def measure(state: object) -> Array:
        theta, q = state.theta, state.q  # type: ignore[attr-defined]
        if relative is not None:
            rows = relative(theta)
        else:
            found = system.shapes(np.linspace(0.0, 1.0, 21), theta)
            rows = np.zeros((len(theta), 1, system.size)) if found is None else found
        # One speed at a time: deflections of all would fill the memory.
        squares = [np.mean(np.einsum("tkn,tn->tk", rows, one) ** 2, axis=0) for one in q]
        return np.asarray(np.sqrt(np.max(squares, axis=1)))

    return measure


def _measured(
    system: LinearPeriodic, speeds: Array, measure: Measure, progress: bool = False
) -> tuple[Array, Array]:
    """Return the measure at speeds and the relative error of the motions, part by part."""
    from ..periodic import steady_state

    rtol = _FINE if system.structure is None else _RTOL
    out, error = np.empty((2, len(speeds)))
    with warnings.catch_warnings(), bar(progress, len(speeds)) as tick:
        # At a critical speed the linear range is left as a matter of course.
        warnings.simplefilter("ignore", LinearRangeWarning)
        for begin in range(0, len(speeds), _TOGETHER):
            part = slice(begin, min(begin + _TOGETHER, len(speeds)))
            state = steady_state(system, speeds[part], rtol=rtol)
            out[part] = measure(state)
            error[part] = np.max(np.reshape(state.error, (len(state.q), -1)), axis=1)
            if tick is not None:
                tick(part.stop)
    if not np.all(np.isfinite(out)):
        worst = float(speeds[int(np.argmin(np.isfinite(out)))])
        raise bad(
            "speed_range",
            f"no single periodic motion at {worst:.6g} rad/s",
            "speeds with one each",
            "move the range or add damping",
        )
    return out, error


def _maxima(
    system: LinearPeriodic, measure: Measure, low: Array, high: Array
) -> tuple[Array, Array, Array]:
    """Return place, height and error of the place of the maxima within brackets."""
    node = np.cos(np.pi * (np.arange(_WITHIN) + 0.5) / _WITHIN)
    found = []
    for _ in range(2):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        inside = middle[:, None] + half[:, None] * node
        values, error = (
            part.reshape(inside.shape) for part in _measured(system, inside.ravel(), measure)
        )
        fitted = [_least(node, 1.0 / row**2, own) for row, own in zip(values, error, strict=True)]
        found.append(
            (
                middle + half * np.array([place for place, _, _ in fitted]),
                np.array([_height(value) for _, value, _ in fitted]),
                half * np.array([doubt for _, _, doubt in fitted]),
            )
        )
        place = found[-1][0]
        low, high = place - _CLOSER * half, place + _CLOSER * half
    (first, _, _), (place, height, doubt) = found
    # The first place is off by the fifth power of its bracket and more.
    return place, height, np.abs(place - first) * _CLOSER**3 + doubt


def _least(node: Array, values: Array, error: Array) -> tuple[float, float, float]:
    """Return place in [-1, 1], value and doubt of the place of the least value of a polynomial.

    ``error`` is the relative error of the motions that the values come from.
    """
    curve = np.polynomial.Chebyshev.fit(node, values, len(node) - 1, domain=[-1, 1])
    slope = curve.deriv()
    roots = slope.roots()
    inner = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1.0)].real
    places = np.concatenate([inner, [-1.0, 1.0]])
    best = float(places[int(np.argmin(curve(places)))])
    bend = abs(float(slope.deriv()(best)))
    # What the next terms, as they fall, and the error of the motions tilt the curve by.
    sizes = [float(np.sum(np.abs(curve.coef[k : k + 2]))) for k in (-4, -2)]
    fall = min(1.0, (sizes[1] / sizes[0]) ** 0.5) if sizes[0] > 0.0 else 1.0
    tilt = sizes[1] * fall * len(node)
    tilt += 2.0 * float(np.max(error * np.abs(values))) * len(node)
    doubt = min(tilt / bend, 1.0) if bend > 0.0 else 1.0
    return best, float(curve(best)), doubt


def _height(square: float) -> float:
    """Return the height of a maximum from one over its square; none has a bound at 0 and below."""
    return square**-0.5 if square > 0.0 else np.inf
