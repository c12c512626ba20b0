"""Functions as series: Fourier in the crank angle, Chebyshev in the parameters."""

from __future__ import annotations

from .periodic import PeriodicFunction

__all__ = ["PeriodicFunction"]
