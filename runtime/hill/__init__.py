"""Hill's equation ``y'' + 2 K y' + (lam2 + mu f(theta)) y = 0``, f of period 2 pi.

It is unstable in regions that start at ``lam2 = n^2/4``.  ``docs/hill.md`` says when to use what:

- :func:`discriminant`: the half trace, at a point or a million of them;
- :func:`characteristic_exponents`: exponents at given lam2, or the lam2 of a given exponent;
- :func:`hill_boundaries`: exact boundaries of the regions, proved ones with ``certified=True``;
- :func:`boundary_derivatives`, :func:`boundary_solution`: how they move with a parameter, and the
  periodic solutions on them, exactly or to an order;
- :func:`perturbation_boundaries`, :func:`boundary_series`: boundaries to any order in one or more
  parameters and K; their coefficients and formulas;
- :func:`critical_damping`: the damping that closes a region, the parameter that opens it;
- :class:`Mathieu`, :class:`Meissner`: two classical equations;
- :func:`hill_form`: a single mode of a machine as Hill's equation.

The names load on first use: a half trace needs nothing of the certified boundaries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .boundaries import Boundaries, hill_boundaries
    from .certified import CertifiedBoundaries
    from .derivatives import BoundaryDerivatives, boundary_derivatives
    from .exponents import CharacteristicExponents, characteristic_exponents
    from .form import HillForm, hill_form
    from .half_trace import HalfTrace, discriminant
    from .mathieu import Mathieu, MathieuCharacteristic
    from .meissner import Meissner
    from .perturbation import PerturbationBoundaries, perturbation_boundaries
    from .series import BoundarySeries, boundary_series
    from .solutions import BoundarySolution, boundary_solution
    from .thresholds import Thresholds, critical_damping

_PUBLIC = {
    "Boundaries": "boundaries",
    "BoundaryDerivatives": "derivatives",
    "BoundarySeries": "series",
    "BoundarySolution": "solutions",
    "CertifiedBoundaries": "certified",
    "CharacteristicExponents": "exponents",
    "HalfTrace": "half_trace",
    "HillForm": "form",
    "Mathieu": "mathieu",
    "MathieuCharacteristic": "mathieu",
    "Meissner": "meissner",
    "PerturbationBoundaries": "perturbation",
    "Thresholds": "thresholds",
    "boundary_derivatives": "derivatives",
    "boundary_series": "series",
    "boundary_solution": "solutions",
    "characteristic_exponents": "exponents",
    "critical_damping": "thresholds",
    "discriminant": "half_trace",
    "hill_boundaries": "boundaries",
    "hill_form": "form",
    "perturbation_boundaries": "perturbation",
}

__all__ = [
    "Boundaries",
    "BoundaryDerivatives",
    "BoundarySeries",
    "BoundarySolution",
    "CertifiedBoundaries",
    "CharacteristicExponents",
    "HalfTrace",
    "HillForm",
    "Mathieu",
    "MathieuCharacteristic",
    "Meissner",
    "PerturbationBoundaries",
    "Thresholds",
    "boundary_derivatives",
    "boundary_series",
    "boundary_solution",
    "characteristic_exponents",
    "critical_damping",
    "discriminant",
    "hill_boundaries",
    "hill_form",
    "perturbation_boundaries",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
