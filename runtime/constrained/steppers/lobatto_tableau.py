"""Coefficients of the pair Lobatto IIIA and IIIB, which prove themselves when they are made."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from ...core.errors import SelfCheckFailed
from ..equations import Array


@dataclass(frozen=True)
class LobattoPair:
    """Lobatto IIIA for positions and IIIB for velocities: symplectic as a pair, symmetric.

    The constructor checks ``B(2s - 2)``, collocation of IIIA, ``C(s - 2)`` of IIIB, the condition
    ``b_i â_ij + b_j a_ji = b_i b_j`` of symplectic pairs, and symmetry.

    Attributes
    ----------
    c, b : ndarray, shape (s,)
        Nodes, the ends of the step among them, and weights.
    first, second : ndarray, shape (s, s)
        Stage weights of IIIA and of IIIB.

    Raises
    ------
    SelfCheckFailed
        If one of the conditions does not hold to round-off.
    """

    c: Array
    b: Array
    first: Array
    second: Array

    @property
    def order(self) -> int:
        """Order of the method, ``2 s - 2``."""
        return 2 * len(self.c) - 2

    def __post_init__(self) -> None:
        s, a, hat, b, c = len(self.c), self.first, self.second, self.b, self.c
        pair = b[:, None] * hat + (b[:, None] * a).T - np.outer(b, b)
        gaps = {
            "symplectic": pair,
            "symmetric IIIA": a + a[::-1, ::-1] - b,
            "symmetric IIIB": hat + hat[::-1, ::-1] - b,
        }
        for k in range(1, 2 * s - 1):
            gaps[f"B({k})"] = np.atleast_1d(b @ c ** (k - 1) - 1 / k)
        for k in range(1, s + 1):
            gaps[f"C({k}) of IIIA"] = a @ c ** (k - 1) - c**k / k
        for k in range(1, s - 1):
            gaps[f"C({k}) of IIIB"] = hat @ c ** (k - 1) - c**k / k
        limit = 64 * s * np.finfo(float).eps
        failed = [name for name, gap in gaps.items() if np.max(np.abs(gap)) > limit]
        if failed:
            raise SelfCheckFailed(f"lobatto with {s} stages: {', '.join(failed)}")


@cache
def lobatto_pair(stages: int) -> LobattoPair:
    """Return the coefficients for a number of stages, at least 2.

    The stage weights are integrals of Lagrange polynomials by their Legendre expansion, which
    stays accurate for many stages.

    Raises
    ------
    ValueError
        If ``stages`` is below 2.
    """
    if stages < 2:
        raise ValueError(f"{stages} stages; a Lobatto pair has at least 2")
    legendre = np.polynomial.legendre
    highest = np.zeros(stages)
    highest[-1] = 1.0
    inner = np.sort(legendre.legroots(legendre.legder(highest)).real)
    inner = 0.5 * (inner - inner[::-1])
    x = np.concatenate([[-1.0], inner, [1.0]])
    weights = 2.0 / (stages * (stages - 1) * legendre.legval(x, highest) ** 2)
    values = legendre.legvander(x, stages)
    integral = np.empty((stages, stages))
    integral[:, 0] = x + 1.0
    for k in range(1, stages):
        integral[:, k] = (values[:, k + 1] - values[:, k - 1]) / (2 * k + 1)
    a: Array = 0.5 * np.asarray(np.linalg.solve(values[:, :stages].T, integral.T).T, dtype=float)
    a[0] = 0.0
    a[-1] = b = 0.5 * weights
    hat = b * (1.0 - a.T / b[:, None])
    hat[:, -1] = 0.0
    hat[:, 0] = b[0]
    for array in (x, a, b, hat):
        array.flags.writeable = False
    return LobattoPair(0.5 * (1.0 + x), b, a, hat)
