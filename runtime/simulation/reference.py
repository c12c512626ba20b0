"""The other solution that the error of a simulation is told by."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..integrators.gauss_legendre import gauss_legendre
from ..periodic.first_order import CanonicalForm
from .marching import Grid, March, Tick, march, steps_for
from .power_series import PowerSeries

Array = NDArray[np.float64]

_COLLOCATION = gauss_legendre(8)


class Reference:
    """Solutions of one system from one start.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    start : pair of ndarray
        Coordinates and d/dtheta at the start, ``(n,)`` each.
    bound : float
        Size of a coordinate at which to stop.
    """

    def __init__(self, form: CanonicalForm, start: tuple[Array, Array], bound: float) -> None:
        self._form, self._start, self._bound = form, start, bound
        self._last: tuple[Grid, int, March] | None = None
        self.name = ""

    @cached_property
    def _solver(self) -> PowerSeries | None:
        return PowerSeries.of(self._form)

    def power_series(
        self, grid: Grid, fineness: float, tick: Tick | None = None
    ) -> tuple[March, int] | None:
        """Return the motion by power series and its stretches; None where they do not serve."""
        if self._solver is None:
            return None
        count = self._solver.stretches(grid, fineness)
        while count is not None:
            found = self._solver.march(grid, self._start, self._bound, count, tick)
            if found is not None:
                return found, count
            count = self._solver.stretches(grid, fineness, above=count)
        return None

    def march(self, grid: Grid, beside: int = 0, *, slopes: bool = False) -> March:
        """Return the motion on a grid.

        Parameters
        ----------
        grid : Grid
            Given angles; of its steps nothing is taken over.
        beside : int
            Stretches of a solution by power series that this one is compared with.
        slopes : bool
            Whether d/dtheta is wanted too.
        """
        # The same while the steps of another method are halved.
        kept = replace(grid, substeps=1)
        if self._last is None or self._last[:2] != (kept, beside):
            self._last = kept, beside, self._other(kept, beside, slopes=slopes)
        return self._last[2]

    def _other(self, grid: Grid, beside: int, *, slopes: bool) -> March:
        if self._solver is not None:
            count = self._solver.another(grid, beside)
            while count is not None:
                found = self._solver.march(grid, self._start, self._bound, count, slopes=slopes)
                if found is not None:
                    self.name = "power series on other stretches"
                    return found
                count = self._solver.stretches(grid, 1.0, above=max(count, beside))
        self.name = "Gauss-Legendre collocation of order 16"
        steps = steps_for(self._form, 1.0, grid.per_revolution)
        fine = replace(grid, substeps=steps // grid.per_revolution)
        return march(_COLLOCATION, self._form, fine, *self._start, self._bound)
