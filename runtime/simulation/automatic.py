"""Which method a simulation takes by itself, and the length of the default steps of each."""

from __future__ import annotations

POWER_SERIES = "power_series"
# Takes its place where the coefficients are not smooth: A-stable, of order 12.
FALLBACK = "gauss_legendre"
# Phase of the highest mode that a default step covers [rad]: a quarter of the step limit of
# Smith's rule in explicit methods, and near round-off in those of order 12 and more.
_PHASE = {
    **{"gauss_legendre": 0.5, "gauss_legendre8": 0.3, "gauss_legendre10": 0.4},
    **{"gauss_legendre12": 0.5, "gauss_legendre14": 0.75, "gauss_legendre16": 1.0},
    **{"magnus6": 0.25, "magnus8": 0.4, "cf6": 0.25},
}
_SHORT_PHASE = 0.15


def default_phase(method: str) -> float:
    """Return the phase of the highest mode [rad] that a default step of a method covers."""
    return _PHASE.get(method, _SHORT_PHASE)
