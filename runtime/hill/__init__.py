"""Hill's equation ``y'' + 2 K y' + (lam2 + mu f(theta)) y = 0``, f of period 2 pi.

It is unstable in regions that start at ``lam2 = n^2/4``.  ``docs/hill.md`` says when to use what:

- :func:`discriminant`: the half trace, at a point or a million of them;
- :func:`characteristic_exponents`: exponents at given lam2, or the lam2 of a given exponent;
- :func:`hill_boundaries`: exact boundaries of the regions, proved ones with ``certified=True``;
- :func:`boundary_solution`: the periodic solutions on them, exactly or to an order;
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
    from .boundaries import Boundaries as Boundaries
    from .boundaries import hill_boundaries as hill_boundaries
    from .exponents import characteristic_exponents as characteristic_exponents
    from .form import HillForm as HillForm
    from .form import hill_form as hill_form
    from .half_trace import discriminant as discriminant
    from .mathieu import Mathieu as Mathieu
    from .meissner import Meissner as Meissner
    from .perturbation import PerturbationBoundaries as PerturbationBoundaries
    from .perturbation import perturbation_boundaries as perturbation_boundaries
    from .series import BoundarySeries as BoundarySeries
    from .series import boundary_series as boundary_series
    from .solutions import boundary_solution as boundary_solution
    from .thresholds import critical_damping as critical_damping

__all__ = on_first_use(globals())
