"""The balanced single link of Smith chapter 5: its inertia, and the offset that makes it least.

A thin uniform rod (length L, mass M) turns about one end.  Beyond the pivot the same section goes
on for ``l = delta L`` (mass ``delta M``) and carries at its end a cylinder of mass m_c, thickness h
and density rho, such that the centre of mass lies on the pivot.  Then::

    m_c = (M/2) (1/delta - delta)
    I = M L^2 [1/3 + delta/2 - delta^3/6 + (K/4) (1/delta - delta)^2],  K = M/(2 pi L^2 h rho)
    dI/d(delta) = (M L^2/2) (1 - delta^2) [1 - K (1 + delta^2)/delta^3]

Smith prints ``M L^2 (1 + delta^2)/2`` for the two bars; they have ``M L^2 (1 + delta^3)/3``.  His
derivative, his K and ``K = delta^3/(1 + delta^2)`` follow from the latter.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

_CUBE_ROOT_BELOW = 1e-60


@dataclass(frozen=True)
class BalancedLink:
    """A link balanced on its pivot; every array has the shape of offset and density number.

    Attributes
    ----------
    offset, density_number : array_like
        delta, above 0 and at most 1; K, zero or more.
    """

    offset: Any
    density_number: Any

    @property
    def inertia(self) -> Any:
        """Moment of inertia about the pivot over ``M L^2``."""
        delta, k = np.asarray(self.offset), self.density_number
        bars = 1.0 / 3.0 + delta * (0.5 - delta * delta / 6.0)
        return bars + k / 4.0 * ((1.0 - delta) * (1.0 + delta) / delta) ** 2

    @property
    def slope(self) -> Any:
        """Derivative of the inertia by the offset."""
        delta = np.asarray(self.offset)
        rest = 1.0 - self.density_number / offset_function(delta)
        return (1.0 - delta) * (1.0 + delta) / 2.0 * rest

    @property
    def counterweight(self) -> Any:
        """Mass of the counterweight over that of the link."""
        delta = np.asarray(self.offset)
        return (1.0 - delta) * (1.0 + delta) / (2.0 * delta)

    @property
    def radius(self) -> Any:
        """Radius of the counterweight over the length of the link."""
        return np.sqrt(2.0 * self.density_number * self.counterweight)


def density_number(mass: float, length: float, thickness: float, density: float) -> float:
    """Return K of a link [kg, m] and its counterweight [m, kg/m^3]."""
    return mass / (2.0 * np.pi * length * length * thickness * density)


def offset_function(delta: Any) -> Any:
    """Return ``delta^3/(1 + delta^2)``, the K for which delta is best (Smith Fig. 23 a)."""
    return delta * delta * delta / (1.0 + delta * delta)


def optimal_offset(density_number: Any) -> Any:
    """Return the offset over length that makes the balanced link's inertia least.

    For K < 1/2 it is the one real root of ``delta^3 = K (1 + delta^2)``, a minimum; ``delta = 1``
    is a maximum then.  For K >= 1/2 the inertia falls all the way to ``delta = 1``: the
    counterweight vanishes and the least inertia is that of a bar of twice the length.  With s =
    1/delta the root of ``s^3 + s = 1/K`` is ``s = (2/sqrt 3) sinh(asinh(3 sqrt 3/(2 K))/3)``, and
    one step of Newton's method mends the round-off that sinh amplifies.
    """
    k = np.asarray(density_number, dtype=float)
    # Far below round-off 1 + delta^2 is 1, and 1/K might overflow.
    safe = np.clip(k, _CUBE_ROOT_BELOW, 0.5)
    s = 2.0 / np.sqrt(3.0) * np.sinh(np.arcsinh(1.5 * np.sqrt(3.0) / safe) / 3.0)
    s = s - (s * s * s + s - 1.0 / safe) / (3.0 * s * s + 1.0)
    return np.where(k >= 0.5, 1.0, np.where(k < _CUBE_ROOT_BELOW, np.cbrt(k), 1.0 / s))
