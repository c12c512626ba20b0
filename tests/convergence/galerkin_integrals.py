"""The integrals of Galerkin's method on the exact overhang modes, in Beale & Scott's notation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from elastolink.runtime.linkages import QuickReturn
from elastolink.runtime.systems.rod import OverhangBasis


class GalerkinIntegrals(NamedTuple):
    """Integrals (8)-(11) at crank angles theta, the block at place x1/L.

    ``error`` is that of the worst entry of ``b_bar``: a round-off of xi turns the modes by beta
    times as much.
    """

    theta: np.ndarray
    place: np.ndarray
    roots: np.ndarray
    delta: np.ndarray
    a_bar: np.ndarray
    b_bar: np.ndarray
    g_bar: np.ndarray
    error: np.ndarray


def galerkin_integrals(theta, modes, *, crank_ratio, frame, length) -> GalerkinIntegrals:
    """Return Delta_kk, a_kn, b_kn and g_k of Galerkin's equations (Beale & Scott (7)-(11)).

    With ' for d/dtheta and xi = x1/L, ``a = 2 xi' drift`` and ``b = xi'' drift + xi'^2
    (d drift/dxi - drift_drift)``: only the second-order form of the equations wants a second
    derivative of the modes, and that is the derivative of an integral over first ones.
    """
    angles = np.atleast_1d(np.asarray(theta, dtype=float))
    basis = OverhangBasis(modes)
    motion = QuickReturn(frame=frame, crank=crank_ratio * frame, rod=length).motion(angles)
    xi, speed, change = (
        values / length
        for values in (motion.slide, motion.slide_velocity, motion.slide_acceleration)
    )
    drift = basis.array("drift", xi)
    second = basis.drift_rate(xi) - basis.array("drift_drift", xi)
    roots = basis.roots(xi)
    size = np.abs(change) * roots[:, -1] ** 2 + speed**2 * roots[:, -1] ** 3
    return GalerkinIntegrals(
        theta=angles,
        place=xi,
        roots=roots,
        delta=np.ones_like(roots),
        a_bar=2 * speed[:, None, None] * drift,
        b_bar=change[:, None, None] * drift + (speed**2)[:, None, None] * second,
        g_bar=basis.array("moment", xi),
        error=16 * np.finfo(float).eps * size,
    )
