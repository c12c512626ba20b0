"""Hill's equation: half traces, exact and perturbation boundaries."""

from __future__ import annotations

from .cases.meissner import coexistence_points, meissner_boundaries
from .cases.named import (
    Mathieu,
    MathieuCharacteristic,
    Meissner,
    WhittakerHill,
    mathieu_characteristic,
)
from .cases.piecewise import (
    PiecewiseApproximation,
    PiecewiseMonodromy,
    piecewise_approximation,
    piecewise_monodromy,
)
from .cases.strutt import MultiplierSurfaces, StruttChart, multiplier_surfaces, strutt_chart
from .exact.certified import CertifiedBoundaries
from .exact.derivatives import BoundaryDerivatives, boundary_derivatives
from .exact.matrix import Boundaries, hill_boundaries
from .exact.quasi import BlochBands, CharacteristicExponents, bloch_bands, characteristic_exponents
from .exact.systems import SystemExponents, hill_exponents
from .half_trace import HalfTrace, discriminant, discriminant_grid
from .perturbation.boundaries import PerturbationBoundaries, perturbation_boundaries
from .perturbation.effective import EffectiveOperator, effective_operator
from .perturbation.formulas import boundary_latex, solution_latex
from .perturbation.solutions import BoundarySolution, boundary_solution
from .perturbation.thresholds import (
    CriticalDamping,
    LeastParameter,
    critical_damping,
    least_parameter,
)

__all__ = [
    "BlochBands",
    "Boundaries",
    "BoundaryDerivatives",
    "BoundarySolution",
    "CertifiedBoundaries",
    "CharacteristicExponents",
    "CriticalDamping",
    "EffectiveOperator",
    "HalfTrace",
    "LeastParameter",
    "Mathieu",
    "MathieuCharacteristic",
    "Meissner",
    "MultiplierSurfaces",
    "PerturbationBoundaries",
    "PiecewiseApproximation",
    "PiecewiseMonodromy",
    "StruttChart",
    "SystemExponents",
    "WhittakerHill",
    "bloch_bands",
    "boundary_derivatives",
    "boundary_latex",
    "boundary_solution",
    "characteristic_exponents",
    "coexistence_points",
    "critical_damping",
    "discriminant",
    "discriminant_grid",
    "effective_operator",
    "hill_boundaries",
    "hill_exponents",
    "least_parameter",
    "mathieu_characteristic",
    "meissner_boundaries",
    "multiplier_surfaces",
    "perturbation_boundaries",
    "piecewise_approximation",
    "piecewise_monodromy",
    "solution_latex",
    "strutt_chart",
]
