"""Run time and error beside what a user would pick instead, measured in one run."""

from .chart import benchmark_chart
from .forces import benchmark_forces
from .mathieu import benchmark_mathieu
from .perturbation import benchmark_perturbation
from .records import Benchmark, Row
from .rod import benchmark_rod
from .scaling import benchmark_scaling
from .slices import benchmark_slices
from .stress_curve import benchmark_stress_curve

__all__ = [
    "Benchmark",
    "Row",
    "benchmark_chart",
    "benchmark_forces",
    "benchmark_mathieu",
    "benchmark_perturbation",
    "benchmark_rod",
    "benchmark_scaling",
    "benchmark_slices",
    "benchmark_stress_curve",
]
