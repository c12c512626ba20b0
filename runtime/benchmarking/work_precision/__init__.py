"""Work against precision: every method and every peer on every problem, at every level of error."""

from __future__ import annotations

from .benchmark import PROBLEMS, benchmark_work_precision, selected
from .guard import compared, load_ratios, store_ratios
from .method import Method, Point, Problem, fastest, measured
from .peers import PEERS
from .problems import TASKS
from .result import LEVELS, Lead, WorkPrecision, leads, ratios
from .systems import SYSTEMS

__all__ = [
    "LEVELS",
    "PEERS",
    "PROBLEMS",
    "SYSTEMS",
    "TASKS",
    "Lead",
    "Method",
    "Point",
    "Problem",
    "WorkPrecision",
    "benchmark_work_precision",
    "compared",
    "fastest",
    "leads",
    "load_ratios",
    "measured",
    "ratios",
    "selected",
    "store_ratios",
]
