"""Counterweights as design variables: what they add to their links, with exact derivatives.

A design maps its variables x to scaled parameters p, four for each link.  The optimiser knows no
more of it than :class:`Design` says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .barrier import PER_LINK, Array, Room


class Design(Protocol):
    """A map from variables x to parameters p, within a box and other conditions."""

    @property
    def box(self) -> tuple[Array, Array]:
        """Least and greatest value of each variable."""
        ...

    def parameters(self, x: Array) -> Array:
        """Return p."""
        ...

    def jacobian(self, x: Array) -> Array:
        """Return dp/dx."""
        ...

    def curvature(self, x: Array, price: Array) -> Array:
        """Return the Hessian of ``price . p(x)``."""
        ...

    def conditions(self, x: Array) -> tuple[Array, Array, Array]:
        """Return c(x), to be zero or more; its Jacobian; its constant Hessians."""
        ...

    def equations(self, x: Array) -> tuple[Array, Array, Array]:
        """Return e(x), to be zero; its Jacobian; its constant Hessians."""
        ...


@dataclass(frozen=True)
class PointDesign:
    """One counterweight on each link: mass, place along and across, own inertia over mass.

    Variables of a link are ``(m, u, v)`` and, where the radius is free, q: half its square; all
    scaled by greatest mass and offset.

    Attributes
    ----------
    rooms : sequence of Room
        One per link.
    """

    rooms: Sequence[Room]

    @property
    def _starts(self) -> list[int]:
        sizes = [3 + (room.own > 0.0) for room in self.rooms]
        return [sum(sizes[:i]) for i in range(len(sizes) + 1)]

    @property
    def box(self) -> tuple[Array, Array]:
        """Least and greatest value of each variable."""
        low: list[float] = []
        high: list[float] = []
        for room in self.rooms:
            low += [0.0, -1.0, -1.0]
            high += [1.0, 1.0, 1.0]
            if room.own > 0.0:
                low.append(0.0)
                high.append(room.own)
        return np.array(low), np.array(high)

    def parameters(self, x: Array) -> Array:
        """Return p: mass, first moments, inertia of each link's counterweight."""
        p: list[float] = []
        for room, start in zip(self.rooms, self._starts, strict=False):
            m, u, v = (float(item) for item in x[start : start + 3])
            own = room.stiffness * m + (float(x[start + 3]) if room.own > 0.0 else 0.0)
            p += [m, m * u, m * v, m * (u * u + v * v + own)]
        return np.array(p)

    def jacobian(self, x: Array) -> Array:
        """Return dp/dx."""
        starts = self._starts
        found = np.zeros((PER_LINK * len(self.rooms), starts[-1]))
        for i, (room, start) in enumerate(zip(self.rooms, starts, strict=False)):
            m, u, v = (float(item) for item in x[start : start + 3])
            own = 2.0 * room.stiffness * m + (float(x[start + 3]) if room.own > 0.0 else 0.0)
            block = found[PER_LINK * i : PER_LINK * (i + 1), start:]
            block[0, 0] = 1.0
            block[1, :2] = u, m
            block[2, [0, 2]] = v, m
            block[3, :3] = u * u + v * v + own, 2.0 * m * u, 2.0 * m * v
            if room.own > 0.0:
                block[3, 3] = m
        return found

    def curvature(self, x: Array, price: Array) -> Array:
        """Return the Hessian of ``price . p(x)``."""
        starts = self._starts
        found = np.zeros((starts[-1], starts[-1]))
        for i, (room, start) in enumerate(zip(self.rooms, starts, strict=False)):
            m, u, v = (float(item) for item in x[start : start + 3])
            _, along, across, inertia = (float(g) for g in price[PER_LINK * i :][:PER_LINK])
            block = found[start:, start:]
            block[0, 0] = 2.0 * room.stiffness * inertia
            block[0, 1] = block[1, 0] = along + 2.0 * u * inertia
            block[0, 2] = block[2, 0] = across + 2.0 * v * inertia
            block[1, 1] = block[2, 2] = 2.0 * m * inertia
            if room.own > 0.0:
                block[0, 3] = block[3, 0] = inertia
        return found

    def conditions(self, x: Array) -> tuple[Array, Array, Array]:
        """Return how far each counterweight is inside its greatest and beyond its least offset."""
        n = self._starts[-1]
        values, slopes, bends = [], [], []
        for room, start in zip(self.rooms, self._starts, strict=False):
            u, v = (float(item) for item in x[start + 1 : start + 3])
            for sign, level in ((-1.0, 1.0), (1.0, room.nearest)):
                if sign > 0.0 and level == 0.0:
                    continue
                slope, bend = np.zeros(n), np.zeros((n, n))
                slope[start + 1 : start + 3] = 2.0 * sign * u, 2.0 * sign * v
                bend[start + 1, start + 1] = bend[start + 2, start + 2] = 2.0 * sign
                values.append(sign * (u * u + v * v - level * level))
                slopes.append(slope)
                bends.append(bend)
        return np.array(values), np.array(slopes), np.array(bends)

    def equations(self, x: Array) -> tuple[Array, Array, Array]:
        """Return nothing: a counterweight may be anywhere within its bounds."""
        n = len(x)
        return np.zeros(0), np.zeros((0, n)), np.zeros((0, n, n))

    def realised(self, p: Array, unfelt: Sequence[bool]) -> Array:
        """Return counterweights with the mass and first moments p, and the inertia if they can.

        Parameters
        ----------
        p : ndarray
            In the convex hull.
        unfelt : sequence of bool
            Links of which only the first moments matter: these get the least mass.
        """
        x: list[float] = []
        for i, room in enumerate(self.rooms):
            m, a, b, j = (float(item) for item in p[PER_LINK * i : PER_LINK * (i + 1)])
            moment = float(np.hypot(a, b))
            if unfelt[i]:
                m = min(moment, 1.0)
            m = min(max(m, moment, 0.0), 1.0)
            u, v = (a / m, b / m) if m > 0.0 else (0.0, 0.0)
            offset = float(np.hypot(u, v))
            wanted = min(max(offset, room.nearest), 1.0)
            u, v = (u * wanted / offset, v * wanted / offset) if offset > 0.0 else (wanted, 0.0)
            x += [m, u, v]
            if room.own > 0.0:
                spare = j / m - (u * u + v * v) - room.stiffness * m if m > 0.0 else 0.0
                x.append(0.0 if unfelt[i] else min(max(spare, 0.0), room.own))
        return np.array(x)


@dataclass(frozen=True)
class BalancedLinkDesign:
    """The single link of Smith chapter 5: offset and mass of the cylinder that balances it.

    Variables ``(delta, m)`` are offset over length and counterweight over mass of the link; the
    one parameter with a price is the inertia over ``M L^2``, and the centre of mass must lie on
    the pivot.  It leads the optimiser to the answer that :func:`optimal_offset` has in closed form.

    Attributes
    ----------
    density_number : float
        K = M / (2 pi L^2 h rho).
    """

    density_number: float

    @property
    def box(self) -> tuple[Array, Array]:
        """Offset from far below any best one to the length; any mass that may be needed."""
        return np.array([1e-6, 0.0]), np.array([1.0, 1e6])

    def parameters(self, x: Array) -> Array:
        """Return mass, first moments and inertia of the whole link."""
        d, m = (float(item) for item in x)
        inertia = (1.0 + d**3) / 3.0 + m * d * d + self.density_number * m * m
        return np.array([1.0 + d + m, 0.5 - 0.5 * d * d - m * d, 0.0, inertia])

    def jacobian(self, x: Array) -> Array:
        """Return dp/dx."""
        d, m = (float(item) for item in x)
        last = [d * d + 2.0 * m * d, d * d + 2.0 * self.density_number * m]
        return np.array([[1.0, 1.0], [-d - m, -d], [0.0, 0.0], last])

    def curvature(self, x: Array, price: Array) -> Array:
        """Return the Hessian of ``price . p(x)``."""
        d, m = (float(item) for item in x)
        moment = price[1] * np.array([[-1.0, -1.0], [-1.0, 0.0]])
        second = [[2.0 * d + 2.0 * m, 2.0 * d], [2.0 * d, 2.0 * self.density_number]]
        return np.asarray(moment + price[3] * np.array(second))

    def conditions(self, x: Array) -> tuple[Array, Array, Array]:
        """Return nothing."""
        return np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2, 2))

    def equations(self, x: Array) -> tuple[Array, Array, Array]:
        """Return the first moment about the pivot."""
        moment, slope = self.parameters(x)[1:2], self.jacobian(x)[1:2]
        return moment, slope, self.curvature(x, np.array([0.0, 1.0, 0.0, 0.0]))[None]
