"""Stability charts over two parameters."""

from __future__ import annotations

from .boundaries import BoundaryCurves
from .chart import StabilityChart, stability_chart

__all__ = ["BoundaryCurves", "StabilityChart", "stability_chart"]
