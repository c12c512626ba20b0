"""Critical speeds from the mean natural frequencies (Aannaque 7.2.3)."""

from __future__ import annotations

import numpy as np

from ..core.errors import bad
from .buckling import buckling_speed
from .critical_result import CriticalSpeeds, Request, listed
from .natural import natural_frequencies

# Speeds at which the means are taken; between them they are interpolated.
_NODES = 12
# The means end this far before the held mechanism buckles: there they lose their smoothness.
_SHORT = 0.98


def by_mean_frequency(request: Request) -> CriticalSpeeds:
    """Return the means of the natural frequencies over n = 1, 2, ..., crank held."""
    found = natural_frequencies(request.system, 0.0, request.count)
    rows = [
        (float(mean / n), mode, n, float(error / n))
        for mode, (mean, error) in enumerate(zip(found.mean, found.mean_error, strict=True), 1)
        for n in range(1, int(np.floor(mean / request.low)) + 1)
    ]
    return listed(request, found.mean, rows, "mean natural frequencies over n")


def by_running_mean(request: Request) -> CriticalSpeeds:
    """Return the speeds w = mean(w)/n, the means with the axial forces of the speed itself.

    They end where those forces buckle the held mechanism at some angle.
    """
    found = natural_frequencies(request.system, 0.0, request.count)
    limit = _SHORT * buckling_speed(request.system).speed
    if limit <= request.low:
        raise bad(
            "speed_range",
            f"a lowest speed of {request.low:.6g} rad/s, buckled at {limit / _SHORT:.6g} rad/s",
            "speeds below that",
            "use another method: beyond it there are no natural frequencies",
        )
    low, high = request.low, min(request.high, limit)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    place = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    runs = [
        natural_frequencies(request.system, 0.0, request.count, speed=float(middle + half * x))
        for x in place
    ]
    rows = []
    for mode in range(1, request.count + 1):
        values = np.array([run.mean[mode - 1] for run in runs])
        curve = np.polynomial.Chebyshev.fit(place, values, _NODES - 1, domain=[-1, 1])
        # The mean is smooth in the square of the speed: its last terms tell what is left out.
        doubt = float(np.sum(np.abs(curve.coef[-2:])))
        doubt += max(float(run.mean_error[mode - 1]) for run in runs)
        for n in range(1, int(np.floor(np.max(values) / low)) + 1):
            line = np.polynomial.Chebyshev([n * middle, n * half], domain=[-1, 1])
            roots = (curve - line).roots()
            real = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1.0)].real
            rows += [(float(middle + half * x), mode, n, doubt / n) for x in real]
    return listed(request, found.mean, rows, "mean natural frequencies at the speed over n")
