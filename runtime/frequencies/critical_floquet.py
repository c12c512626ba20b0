"""Critical speeds from the equation without its forcing: multipliers, Meissner's functions."""

from __future__ import annotations

import numpy as np

from ..core.results import provenance
from ..floquet import MarkedSpeeds, meissner_speeds, multiplier_maxima
from ..floquet.first_order import even_angles
from .critical_result import Array, CriticalSpeeds, Request
from .eigenproblem import held_frequencies
from .natural import natural_frequencies

# Intervals of Meissner's functions.
_INTERVALS = 64


def by_multipliers(request: Request) -> CriticalSpeeds:
    """Return the local maxima of the real part of each mode's multiplier (Aannaque 7.2.3)."""
    found = multiplier_maxima(request.system, (request.low, request.high), request.count)
    mean = natural_frequencies(request.system, 0.0, request.count).mean
    return _marked(request, found, mean, "real part of the multiplier")


def by_meissner(request: Request) -> CriticalSpeeds:
    """Return the local maxima of J_N of each mode by itself, N = 64 (Aannaque 7.11)."""
    theta = even_angles(request.system.period, _INTERVALS)
    frequency = held_frequencies(request.system, theta, {})[0][:, : request.count]
    found = meissner_speeds(frequency, (request.low, request.high))
    mean = natural_frequencies(request.system, 0.0, request.count).mean
    return _marked(request, found, mean, "J_N")


def _marked(request: Request, found: MarkedSpeeds, mean: Array, quantity: str) -> CriticalSpeeds:
    """Return marked speeds as critical ones."""
    order = np.argsort(found.speed, kind="stable")
    speed, mode = found.speed[order], found.mode[order]
    # A multiplier tells the frequency of its mode but for multiples of the speed.
    n = np.maximum(1, np.round(mean[mode - 1] / speed)).astype(np.int64)
    return CriticalSpeeds(
        method=found.method,
        error=np.asarray(found.error)[order],
        error_norm="absolute, of each speed [rad/s], as this method defines it",
        checks=found.checks,
        provenance=provenance(request.system.provenance),
        speed=speed,
        mode=mode,
        order=n,
        ratio=mean[mode - 1] / (n * speed),
        height=found.value[order],
        mean_frequency=mean,
        scan_speed=np.zeros(0),
        scan=np.zeros(0),
        quantity=quantity,
    )
