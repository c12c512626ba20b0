"""Monodromy matrices at many speeds of a range, from tables of segments."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, log

import numpy as np

from ..core.families import Array, LinearPeriodic
from .equation import sampled
from .multipliers import monodromy
from .prepared import TableErrors, TableMaker
from .tables import Table


class MatricesOverSpeed:
    """Scaled monodromy matrices of one system over the speed; tables are made where first needed.

    Beyond the span of the tables [rad/s] each matrix is solved for itself.
    """

    def __init__(
        self,
        system: LinearPeriodic,
        span: tuple[float, float],
        parameters: Mapping[str, float],
        rtol: float,
    ) -> None:
        low, high = span
        self.system, self.parameters, self.rtol = system, parameters, rtol
        # A table spans a ratio of at most 1.5, which up to 72 Chebyshev nodes resolve.
        count = max(1, ceil(log(high / low) / log(1.5) - 1e-9))
        self._edges = low * (high / low) ** (np.arange(count + 1) / count)
        self._edges[[0, -1]] = low, high
        self.known = sampled(system, forcing=False)
        self._maker = TableMaker(self.known, (low * high) ** 0.5, parameters)
        self._tables: dict[int, tuple[Table, TableErrors]] = {}

    @property
    def scale(self) -> Array:
        """Units of the scaled variables, ``(2n,)``."""
        return self._maker.scale

    def __call__(self, speed: Array) -> tuple[Array, Array]:
        """Return matrices ``(nb, 2n, 2n)`` and their errors over the largest entries ``(nb,)``.

        The variables are canonical, (q, p), in scales that make the entries alike.
        """
        m = 2 * self.system.size
        matrices, error = np.empty((len(speed), m, m)), np.empty(len(speed))
        inner = len(self._edges) - 1
        place = np.searchsorted(self._edges, speed, side="right") - 1
        place[speed == self._edges[-1]] = inner - 1
        for number in np.unique(place).tolist():
            rows = np.flatnonzero(place == number)
            if 0 <= number < inner:
                table, errors = self._table(number)
                plain, power = table.products(1.0 / speed[rows])
                with np.errstate(over="ignore"):
                    matrices[rows] = np.ldexp(plain, power[:, None, None])
                error[rows] = errors.of_matrices(speed[rows])
                continue
            single = monodromy(self.system, speed[rows], rtol=self.rtol, **self.parameters)
            with np.errstate(over="ignore"):
                matrices[rows] = np.ldexp(single.scaled, single.exponent[:, None, None])
            error[rows] = single.error
        return matrices, error

    def _table(self, number: int) -> tuple[Table, TableErrors]:
        if number not in self._tables:
            low, high = self._edges[number], self._edges[number + 1]
            # In a range as narrow as 1.05 twelve nodes are enough for eight modes.
            nodes = 12 if high <= 1.05 * low else None
            made = self._maker.table(float(1.0 / high), float(1.0 / low), 1, self.rtol, nodes)
            self._tables[number] = made[:2]
        return self._tables[number]
