"""Gauss and Radau collocation: coefficients that prove their order when they are made, and steps.

Gauss collocation with s stages is symplectic, A-stable and of order 2s; Radau IIA is stiffly
accurate, L-stable and of order 2s - 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .errors import SelfCheckFailed

Array = NDArray[np.float64]
Generator = Callable[[Array], Array]


@dataclass(frozen=True)
class CollocationTableau:
    """Coefficients of collocation at ``stages`` points of [0, 1].

    The constructor checks Butcher's simplifying assumptions B(order), C(s) and D(order - s), which
    together give the order, and what the family adds to them: ``b_i a_ij + b_j a_ji = b_i b_j`` of
    the symplectic Gauss methods, a last stage that is the step itself of Radau's.

    Where one of the conditions does not hold to round-off, it raises `SelfCheckFailed`.
    """

    family: Literal["gauss", "radau"]
    stages: int
    c: Array  # nodes, (s,)
    b: Array  # weights, (s,)
    a: Array  # stage weights, (s, s)

    @property
    def order(self) -> int:
        """Order of the method."""
        return 2 * self.stages - (self.family == "radau")

    def __post_init__(self) -> None:
        a, b, c, s = self.a, self.b, self.c, self.stages
        if self.family == "gauss":
            gaps = {"symplectic": b[:, None] * a + (b[:, None] * a).T - np.outer(b, b)}
        else:
            gaps = {"last stage": a[-1] - b}
        for k in range(1, self.order + 1):
            gaps[f"B({k})"] = b @ c ** (k - 1) - 1 / k
        for k in range(1, s + 1):
            gaps[f"C({k})"] = a @ c ** (k - 1) - c**k / k
        for k in range(1, self.order - s + 1):
            gaps[f"D({k})"] = (b * c ** (k - 1)) @ a - b * (1 - c**k) / k
        limit = 64 * s * np.finfo(float).eps
        failed = [name for name, gap in gaps.items() if np.max(np.abs(gap)) > limit]
        if failed:
            raise SelfCheckFailed(f"{self.family} with {s} stages: {', '.join(failed)}")
        for array in (a, b, c):
            array.flags.writeable = False


@cache
def gauss_tableau(stages: int) -> CollocationTableau:
    """Return the Gauss collocation coefficients for a number of stages, at least 1.

    The stage weights are the integrals of the Lagrange polynomials, by their Legendre expansion,
    which stays accurate for many stages.
    """
    x, w = np.polynomial.legendre.leggauss(stages)
    values = np.polynomial.legendre.legvander(x, stages)
    rise = values[:, 2:] - values[:, :-2]
    a = w / 4 * ((1 + x)[:, None] + rise @ values[:, 1:stages].T)
    return CollocationTableau("gauss", stages, (1 + x) / 2, w / 2, a)


@cache
def radau_tableau(stages: int) -> CollocationTableau:
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
    return CollocationTableau("radau", stages, (1 + x) / 2, a[-1], a)


def legendre_integrals(x: Array, stages: int | None = None) -> Array:
    """Return the integrals from -1 to x of the Legendre polynomials 0 to s - 1, ``(nx, s)``."""
    count = len(x) if stages is None else stages
    legendre = np.polynomial.legendre
    return np.asarray(legendre.legvander(x, count) @ legendre.legint(np.eye(count), lbnd=-1.0))


def gauss_maps(stages: int, generator: Generator, theta: Array, step: float) -> Array:
    """Return the matrices of Gauss collocation steps of ``y' = L(theta) y``.

    The stage slopes solve the linear system ``K_i = L_i (I + h sum_j a_ij K_j)``, all steps at
    once.  Forcing enters as one more state that stays 1.

    ``generator`` takes angles ``(nt,)`` to L, ``(*batch, nt, m, m)``; the steps begin at ``theta``
    ``(ns,)`` [rad], all of one length.  Returns ``(*batch, ns, m, m)`` with
    ``y(theta + step) = matrix y(theta)``.
    """
    tableau = gauss_tableau(stages)
    angles = theta[:, None] + step * tableau.c
    values = generator(angles.ravel())
    m = values.shape[-1]
    lead, whole = (*values.shape[:-3], len(theta)), stages * m
    values = values.reshape(*lead, stages, m, m)
    # (..., i, j) block of the system: delta_ij I - h a_ij L_i, laid out as (..., i, row, j, column)
    coefficients = tableau.a[:, None, :, None]
    system = -step * (coefficients * values[..., :, :, None, :]).reshape(*lead, whole, whole)
    diagonal = np.arange(whole)
    system[..., diagonal, diagonal] += 1.0
    slopes = np.linalg.solve(system, values.reshape(*lead, whole, m))
    weights = step * tableau.b
    result: Array = np.einsum("i,...irc->...rc", weights, slopes.reshape(*lead, stages, m, m))
    return result + np.eye(m)
