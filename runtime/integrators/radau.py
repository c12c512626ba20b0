"""Radau IIA collocation with any number of stages: order 2s - 1, stiffly accurate, L-stable."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ..errors import SelfCheckFailed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RadauTableau:
    """Collocation at the right Radau points of [0, 1]: ``stages`` stages, order ``2 stages - 1``.

    The constructor checks Butcher's simplifying assumptions B(2s - 1), C(s) and D(s - 1), which
    together give the order, and that the last stage is the step itself.

    Attributes
    ----------
    stages : int
        Number s of stages.
    c, b : ndarray
        Nodes and weights, shape ``(s,)``.
    a : ndarray
        Stage weights, shape ``(s, s)``.

    Raises
    ------
    SelfCheckFailed
        If one of the conditions does not hold to round-off.
    """

    stages: int
    c: Array
    b: Array
    a: Array

    @property
    def order(self) -> int:
        """Order of the method."""
        return 2 * self.stages - 1

    def __post_init__(self) -> None:
        limit = 64 * self.stages * np.finfo(float).eps
        a, b, c, s = self.a, self.b, self.c, self.stages
        gaps = {"last stage": np.abs(a[-1] - b)}
        for k in range(1, 2 * s):
            gaps[f"B({k})"] = np.abs(b @ c ** (k - 1) - 1 / k)
        for k in range(1, s + 1):
            gaps[f"C({k})"] = np.abs(a @ c ** (k - 1) - c**k / k)
        for k in range(1, s):
            gaps[f"D({k})"] = np.abs((b * c ** (k - 1)) @ a - b * (1 - c**k) / k)
        failed = [name for name, gap in gaps.items() if np.max(gap) > limit]
        if failed:
            raise SelfCheckFailed(f"radau with {s} stages: {', '.join(failed)}")


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
    a = 0.5 * integrals(x) @ np.linalg.inv(legendre.legvander(x, stages - 1))
    for array in (x, a):
        array.flags.writeable = False
    return RadauTableau(stages, (1 + x) / 2, a[-1], a)


def integrals(x: Array, stages: int | None = None) -> Array:
    """Return the integrals from -1 to x of the Legendre polynomials 0 to s - 1, ``(nx, s)``."""
    count = len(x) if stages is None else stages
    values = np.polynomial.legendre.legvander(x, count)
    out = np.empty((len(x), count))
    out[:, 0] = 1 + x
    for k in range(1, count):
        out[:, k] = (values[:, k + 1] - values[:, k - 1]) / (2 * k + 1)
    return out
