"""Self-checks of prepared answers, made when they are looked at."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..core.families import LinearPeriodic
from ..core.results import Check
from ..response.checks import largest_deflection
from ..simulation.trajectory import LINEAR_RANGE
from .table import Array

# Error of a coordinate over its peak with which an answer still passes.
_FAIR = 1e-6


def motion_checks(
    system: LinearPeriodic, theta: Array, q: Array, error: Array, single: Check | None = None
) -> Mapping[str, Check]:
    """Return the accuracy and the linear range of motions ``(ns, nt, n)`` at angles ``(nt,)``."""
    largest = Check(float(np.max(error)), _FAIR)
    checks = {"accuracy": largest} if single is None else {"converged": largest, "single": single}
    deflection = largest_deflection(system, theta, q)
    if deflection is not None:
        checks["linear range"] = Check(deflection, LINEAR_RANGE)
    return checks
