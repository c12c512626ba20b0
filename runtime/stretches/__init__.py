"""Solutions over short stretches of the angle, as polynomials of one variable, and their products.

A linear equation ``y' = L(theta, x) y`` is solved for many values of one variable x at once:

1. the angle is cut into stretches that hardly turn the state;
2. over each the solution is a power series about the middle (:mod:`~.power_series`);
3. it is found at a few Chebyshev nodes of x, stretches multiplied together as far as polynomials
   of x follow, until neither coefficients nor polynomials miss anything (:mod:`~.solving`);
4. for each x what is left is to evaluate polynomials and multiply (:mod:`~.tabulated`).

Who uses it says which equation, which variable, how long the stretches and how good the result:

====================================  =========================  ==================================
module                                variable                   solution of a stretch
====================================  =========================  ==================================
``prepared.table``                    1/w                        power series, at angles inside too
``reduction.growth`` (stress curves)  1/w                        Magnus, order six: 1e-4 is enough
``simulation.power_series``           none                       power series from Fourier series
====================================  =========================  ==================================
"""

from __future__ import annotations

from .power_series import stretch_maps
from .solving import Equation, Flows, solved
from .tabulated import Tabulated, coefficients, mixed, nodes, running_products

__all__ = [
    "Equation",
    "Flows",
    "Tabulated",
    "coefficients",
    "mixed",
    "nodes",
    "running_products",
    "solved",
    "stretch_maps",
]
