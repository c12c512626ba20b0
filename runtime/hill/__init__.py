"""Hill's equation: half traces, exact and perturbation boundaries.

The names load on first use: a half trace needs nothing of the certified boundaries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
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
    from .cases.strutt import StruttChart, strutt_chart
    from .cases.surfaces import MultiplierSurfaces, multiplier_surfaces
    from .exact.certified import CertifiedBoundaries
    from .exact.derivatives import BoundaryDerivatives, boundary_derivatives
    from .exact.matrix import Boundaries, hill_boundaries
    from .exact.quasi import (
        BlochBands,
        CharacteristicExponents,
        bloch_bands,
        characteristic_exponents,
    )
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

_PUBLIC = {
    "BlochBands": "exact.quasi",
    "Boundaries": "exact.matrix",
    "BoundaryDerivatives": "exact.derivatives",
    "BoundarySolution": "perturbation.solutions",
    "CertifiedBoundaries": "exact.certified",
    "CharacteristicExponents": "exact.quasi",
    "CriticalDamping": "perturbation.thresholds",
    "EffectiveOperator": "perturbation.effective",
    "HalfTrace": "half_trace",
    "LeastParameter": "perturbation.thresholds",
    "Mathieu": "cases.named",
    "MathieuCharacteristic": "cases.named",
    "Meissner": "cases.named",
    "MultiplierSurfaces": "cases.surfaces",
    "PerturbationBoundaries": "perturbation.boundaries",
    "PiecewiseApproximation": "cases.piecewise",
    "PiecewiseMonodromy": "cases.piecewise",
    "StruttChart": "cases.strutt",
    "SystemExponents": "exact.systems",
    "WhittakerHill": "cases.named",
    "bloch_bands": "exact.quasi",
    "boundary_derivatives": "exact.derivatives",
    "boundary_latex": "perturbation.formulas",
    "boundary_solution": "perturbation.solutions",
    "characteristic_exponents": "exact.quasi",
    "coexistence_points": "cases.meissner",
    "critical_damping": "perturbation.thresholds",
    "discriminant": "half_trace",
    "discriminant_grid": "half_trace",
    "effective_operator": "perturbation.effective",
    "hill_boundaries": "exact.matrix",
    "hill_exponents": "exact.systems",
    "least_parameter": "perturbation.thresholds",
    "mathieu_characteristic": "cases.named",
    "meissner_boundaries": "cases.meissner",
    "multiplier_surfaces": "cases.surfaces",
    "perturbation_boundaries": "perturbation.boundaries",
    "piecewise_approximation": "cases.piecewise",
    "piecewise_monodromy": "cases.piecewise",
    "solution_latex": "perturbation.formulas",
    "strutt_chart": "cases.strutt",
}

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


__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
