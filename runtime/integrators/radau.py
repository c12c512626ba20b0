"""Radau IIA collocation with any number of stages: order 2s - 1, stiffly accurate, L-stable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import ClassVar

import numpy as np

from .collocation import Array, CollocationTableau


@dataclass(frozen=True)
class RadauTableau(CollocationTableau):
    """Collocation at the right Radau points of [0, 1]: ``stages`` stages, order ``2 stages - 1``.

    The constructor also checks that the last stage is the step itself.
    """

    method: ClassVar[str] = "radau"

    @property
    def order(self) -> int:
        """Order of the method."""
        return 2 * self.stages - 1

    def _own_gaps(self) -> Mapping[str, Array]:
        return {"last stage": np.abs(self.a[-1] - self.b)}


@cache
def radau_tableau(stages: int) -> RadauTableau:
    """Return the Radau IIA coefficients for a number of stages, at least 1.

    The nodes are the zeros of P_s - P_{s-1}; the stage weights are the integrals of the Lagrange
    polynomials, by their Legendre expansion.
    """
    legendre = np.polynomial.legendre
    ends = np.zeros(stages + 1)
    ends[-2:] = -1.0, 1.0
    x = np.sort(legendre.legroots(ends).real)
    for _ in range(3):
        x = x - legendre.legval(x, ends) / legendre.legval(x, legendre.legder(ends))
    x[-1] = 1.0
    a = 0.5 * legendre_integrals(x) @ np.linalg.inv(legendre.legvander(x, stages - 1))
    for array in (x, a):
        array.flags.writeable = False
    return RadauTableau(stages, (1 + x) / 2, a[-1], a)


def legendre_integrals(x: Array, stages: int | None = None) -> Array:
    """Return the integrals from -1 to x of the Legendre polynomials 0 to s - 1, ``(nx, s)``."""
    count = len(x) if stages is None else stages
    values = np.polynomial.legendre.legvander(x, count)
    out = np.empty((len(x), count))
    out[:, 0] = 1 + x
    for k in range(1, count):
        out[:, k] = (values[:, k + 1] - values[:, k - 1]) / (2 * k + 1)
    return out
