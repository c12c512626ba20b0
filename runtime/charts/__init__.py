"""Stability charts over two parameters."""

from __future__ import annotations

from .boundaries import BoundaryCurves
from .chart import StabilityChart, stability_chart
from .edge_rows import EdgeCurves

__all__ = ["BoundaryCurves", "EdgeCurves", "StabilityChart", "stability_chart"]
