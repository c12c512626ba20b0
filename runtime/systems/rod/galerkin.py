"""The integrals of Galerkin's method on the exact overhang modes, in Beale & Scott's notation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.results import Check, DeferredChecks, Result, provenance
from ...linkages import QuickReturn
from .inputs import as_floats, require_numbers
from .overhang import OverhangBasis

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_ROUND = float(np.finfo(float).eps)
# Errors of the closed forms over round-off times their size beta^2, and beta^3 by beta; measured.
_CLOSED = 16.0


@dataclass(frozen=True, kw_only=True)
class GalerkinIntegrals(Result):
    """Integrals (8)-(11) of Beale & Scott at given crank angles.

    ``error`` has the shape of ``theta``: the figure for the worst entry of ``b_bar``.

    Attributes
    ----------
    theta : ndarray, shape (nt,)
        Crank angles [rad].
    place : ndarray, shape (nt,)
        Place of the block x1/L.
    roots : ndarray, shape (nt, n)
        beta of each mode; ``omega_k^2 = beta_k^4 EI / (m L^4)``.
    delta : ndarray, shape (nt, n)
        (8): 1, for the modes have unit square.
    a_bar, b_bar : ndarray, shape (nt, n, n)
        (9) and (10): twice the integrals of e_k with the first, and the integrals with the second
        derivatives of e_n by theta.
    g_bar : ndarray, shape (nt, n)
        (11): first moments.
    """

    theta: Array
    place: Array
    roots: Array
    delta: Array
    a_bar: Array
    b_bar: Array
    g_bar: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta": ("theta",),
        "place": ("theta",),
        "error": ("theta",),
        "roots": ("theta", "mode"),
        "delta": ("theta", "mode"),
        "g_bar": ("theta", "mode"),
        "a_bar": ("theta", "mode", "column"),
        "b_bar": ("theta", "mode", "column"),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the entries of ``a_bar`` and ``b_bar`` over the crank angle."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        n = self.roots.shape[1]
        for name, array in (("a", self.a_bar), ("b", self.b_bar)):
            for k, j in np.ndindex(n, n):
                style = "-" if name == "a" else "--"
                label = rf"$\bar {name}_{{{k + 1}{j + 1}}}$"
                ax.plot(np.degrees(self.theta), array[:, k, j], style, label=label)
        ax.set(xlabel="crank angle [deg]", ylabel="integral")
        if n <= 3:
            ax.legend(ncols=2)
        return ax


def galerkin_integrals(
    theta: ArrayLike, modes: int, *, crank_ratio: float, frame: float, length: float
) -> GalerkinIntegrals:
    """Return Delta_kk, a_kn, b_kn and g_k of Galerkin's equations (Beale & Scott (7)-(11)).

    With ' for d/dtheta and xi = x1/L, ``a = 2 xi' drift`` and ``b = xi'' drift + xi'^2
    (d drift/dxi - drift_drift)``: only the second-order form of the equations wants a second
    derivative of the modes, and that is the derivative of an integral over first ones.  The sum
    ``b + b^T`` has the closed form ``-2 xi'^2 drift_drift``, for the drift is antisymmetric.

    Parameters
    ----------
    theta : array_like
        Crank angles [rad], shape ``(nt,)`` or a number.
    modes : int
        Number n of modes, from 1.
    crank_ratio : float
        Crank length over base length, epsilon = G/a_x, positive.
    frame : float
        Base length a_x [m].
    length : float
        Length L of the rod [m].

    Raises
    ------
    BadInput
        If a number is not positive and finite, the block is not on the rod at one of the angles
        (at others it need not be), or the number of modes is not a whole one from 1.
    """
    angles = _angles(theta)
    require_numbers({"crank_ratio": crank_ratio, "frame": frame, "length": length})
    basis = OverhangBasis(modes)
    linkage = QuickReturn(frame=frame, crank=crank_ratio * frame, rod=length)
    motion = linkage.motion(angles)
    xi, speed, change = (
        values / length
        for values in (motion.slide, motion.slide_velocity, motion.slide_acceleration)
    )
    drift = basis.array("drift", xi)
    second = basis.drift_rate(xi) - basis.array("drift_drift", xi)
    b_bar = change[:, None, None] * drift + (speed**2)[:, None, None] * second
    roots = basis.roots(xi)
    # A round-off of xi turns the modes by beta times as much.
    size = np.abs(change) * roots[:, -1] ** 2 + speed**2 * roots[:, -1] ** 3
    return GalerkinIntegrals(
        method="closed forms by Green's identity",
        error=_CLOSED * _ROUND * size,
        error_norm="largest entry of b_bar at each angle, absolute",
        checks=DeferredChecks(_Quadrature(basis, float(xi[np.argmax(np.abs(speed))]))),
        provenance=provenance({"module": "quick_return_overhang_modes"}),
        theta=angles,
        place=xi,
        roots=roots,
        delta=np.ones_like(roots),
        a_bar=2 * speed[:, None, None] * drift,
        b_bar=b_bar,
        g_bar=basis.array("moment", xi),
    )


def _angles(theta: ArrayLike) -> Array:
    expected = "a vector of finite angles"
    angles = as_floats("theta", theta, expected, alone=True)
    if angles.ndim != 1 or not angles.size or not np.all(np.isfinite(angles)):
        raise bad("theta", f"shape {angles.shape}", expected, "correct it")
    return angles


@dataclass(frozen=True)
class _Quadrature:
    """Compares closed forms with Gauss's quadrature where the block is fastest."""

    basis: OverhangBasis
    place: float

    def __call__(self) -> dict[str, Check]:
        """Return the largest differences over the largest entries."""
        xi, n = np.array([self.place]), self.basis.size
        s, weights = np.polynomial.legendre.leggauss(2 * n + 24)
        s, weights = (1 + s) / 2, weights / 2
        total = {"overlap": np.zeros((n, n)), "drift": np.zeros((n, n))}
        total["drift_drift"] = np.zeros((n, n))
        for start, end in ((0.0, self.place), (self.place, 1.0)):
            x = np.minimum(start + (end - start) * s, 1.0)
            mode, moved = self.basis.shapes(x, xi)[0], self.basis.drift(x, xi)[0]
            for name, one, two in (
                ("overlap", mode, mode),
                ("drift", mode, moved),
                ("drift_drift", moved, moved),
            ):
                total[name] += (end - start) * (one.T * weights) @ two
        found = {}
        for name, by_quadrature in total.items():
            gap = self.basis.array(name, xi)[0] - by_quadrature
            size = float(self.basis.roots(xi)[0, -1]) ** name.count("drift")
            found[f"{name} by quadrature"] = Check(float(np.max(np.abs(gap))) / size, 1e-11)
        return found
