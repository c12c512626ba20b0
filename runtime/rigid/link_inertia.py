"""The balanced single link of Smith chapter 5: its inertia, and the offset that makes it least."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.results import BROADCAST, Result, provenance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_TURNING_POINT = 0.5  # the K beyond which no counterweight at all is best
_CUBE_ROOT_BELOW = 1e-60


@dataclass(frozen=True, kw_only=True)
class BalancedLink(Result):
    """Inertia of a link balanced on its pivot, over the counterweight's offset and density.

    Every array has the shape to which ``offset`` and ``density_number`` broadcast.

    Attributes
    ----------
    offset : ndarray
        Offset delta of the counterweight over the length of the link.
    density_number : ndarray
        K = M / (2 pi L^2 h rho).
    inertia : ndarray
        Moment of inertia about the pivot over ``M L^2``.
    slope : ndarray
        Its derivative with respect to delta.
    counterweight : ndarray
        Mass of the counterweight over that of the link.
    radius : ndarray
        Radius of the counterweight over the length of the link.
    """

    offset: Array
    density_number: Array
    inertia: Array
    slope: Array
    counterweight: Array
    radius: Array

    dimensions = dict.fromkeys(
        ("offset", "density_number", "inertia", "slope", "counterweight", "radius", "error"),
        BROADCAST,
    )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw inertia over offset, a curve for each density, minima marked (Smith Fig. 23 b)."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        shape = self.inertia.shape
        curves = [np.reshape(v, (-1, *shape[-1:])) for v in (self.offset, self.inertia)]
        numbers = np.reshape(self.density_number, (-1, *shape[-1:]))
        for x, y, k in zip(*curves, numbers, strict=True):
            order = np.argsort(np.atleast_1d(x))
            constant = np.ptp(k) == 0
            label = f"K = {np.ravel(k)[0]:.3g}" if constant else None
            (line,) = ax.plot(np.atleast_1d(x)[order], np.atleast_1d(y)[order], label=label)
            if constant:
                best = optimal_offset(float(np.ravel(k)[0]))
                least = _inertia(best, np.ravel(k)[0])
                ax.plot(best, least, "o", color=line.get_color())
        ax.set_xlabel(r"offset $\delta = \ell/L$")
        ax.set_ylabel(r"$I_G/(M L^2)$")
        ax.legend()
        return ax


def balanced_link_inertia(offset: ArrayLike, density_number: ArrayLike) -> BalancedLink:
    """Return the inertia of a link that a cylinder on its extension balances (Smith chapter 5).

    A thin uniform rod (length L, mass M) turns about one end.  Beyond the pivot the same section
    goes on for ``l = delta L`` (mass ``delta M``) and carries at its end a cylinder of mass m_c,
    thickness h and density rho, such that the centre of mass lies on the pivot.  Then::

        m_c = (M/2) (1/delta - delta)
        I = M L^2 [1/3 + delta/2 - delta^3/6 + (K/4) (1/delta - delta)^2]
        dI/d(delta) = (M L^2/2) (1 - delta^2) [1 - K (1 + delta^2)/delta^3]

    Parameters
    ----------
    offset : array_like
        delta, above 0 and at most 1.
    density_number : array_like
        K = M / (2 pi L^2 h rho), zero (a point mass) or more; see :func:`density_number`.

    Returns
    -------
    BalancedLink
        Arrays of the broadcast shape.

    Raises
    ------
    BadInput
        If a value is not a number in these ranges, or the two do not broadcast.

    Notes
    -----
    Smith prints ``M L^2 (1 + delta^2)/2`` for the two bars; they have ``M L^2 (1 + delta^3)/3``.
    His derivative, his K and ``K = delta^3/(1 + delta^2)`` follow from the latter.
    """
    delta = _numbers(offset, "offset", "numbers above 0, at most 1")
    k = _numbers(density_number, "density_number", "numbers of zero or more")
    if not np.all((delta > 0) & (delta <= 1)):
        raise bad("offset", f"{delta.min():g} to {delta.max():g}", "above 0, at most 1", "scale it")
    if np.any(k < 0):
        raise bad("density_number", f"{k.min():g}", "zero or more", "correct the sign")
    try:
        delta, k = (np.array(v) for v in np.broadcast_arrays(delta, k))
    except ValueError as refusal:
        found = f"shapes {delta.shape} and {k.shape}"
        raise bad("offset", found, "shapes that broadcast", "add axes to one") from refusal
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        inertia = _inertia(delta, k)
        slope = (1.0 - delta) * (1.0 + delta) / 2.0 * (1.0 - k / _number_of(delta))
        weight = (1.0 - delta) * (1.0 + delta) / (2.0 * delta)
        radius = np.sqrt(2.0 * k * weight)
        error = 8.0 * _EPS * inertia
    if not all(np.all(np.isfinite(v)) for v in (inertia, slope, weight)):
        raise bad("offset", f"{delta.min():g}", "an inertia within range", "use a larger offset")
    return BalancedLink(
        offset=delta,
        density_number=k,
        inertia=inertia,
        slope=slope,
        counterweight=weight,
        radius=radius,
        method="closed form",
        error=error,
        error_norm="inertia over M L^2, absolute, entrywise",
        error_kind="bound",
        provenance=provenance(),
    )


def density_number(mass: float, length: float, thickness: float, density: float) -> float:
    """Return K = M / (2 pi L^2 h rho) of a link [kg, m] and its counterweight [m, kg/m^3].

    Raises
    ------
    BadInput
        If a value is not a positive number.
    """
    given = {"mass": mass, "length": length, "thickness": thickness, "density": density}
    for name, value in given.items():
        if not (_numbers(value, name, "a positive number").ndim == 0 and value > 0):
            raise bad(name, repr(value)[:60], "a positive number", "correct it")
    return mass / (2.0 * np.pi * length * length * thickness * density)


def optimal_offset(density_number: ArrayLike) -> Any:
    """Return the offset over length that makes the balanced link's inertia least.

    For K < 1/2 it is the one real root of ``delta^3 = K (1 + delta^2)``, a minimum; ``delta = 1``
    is a maximum then.  For K >= 1/2 the inertia falls all the way to ``delta = 1``: the
    counterweight vanishes and the least inertia is that of a bar of twice the length.  The other
    roots of Smith's quintic are -1 and a complex pair.

    Parameters
    ----------
    density_number : array_like
        K, zero or more, any shape.

    Returns
    -------
    float or ndarray
        delta, in full precision: with s = 1/delta the root of ``s^3 + s = 1/K`` is
        ``s = (2/sqrt 3) sinh(asinh(3 sqrt 3/(2 K))/3)``, free of cancellation, and one step of
        Newton's method mends the round-off that sinh amplifies.

    Raises
    ------
    BadInput
        If a value is not a number of zero or more.
    """
    k = _numbers(density_number, "density_number", "numbers of zero or more")
    if np.any(k < 0):
        raise bad("density_number", f"{k.min():g}", "zero or more", "correct the sign")
    # Far below round-off 1 + delta^2 is 1, and 1/K might overflow.
    safe = np.clip(k, _CUBE_ROOT_BELOW, _TURNING_POINT)
    s = 2.0 / np.sqrt(3.0) * np.sinh(np.arcsinh(1.5 * np.sqrt(3.0) / safe) / 3.0)
    s = s - (s * s * s + s - 1.0 / safe) / (3.0 * s * s + 1.0)
    below = np.where(k < _CUBE_ROOT_BELOW, np.cbrt(k), 1.0 / s)
    delta = np.where(k >= _TURNING_POINT, 1.0, below)
    return float(delta) if delta.ndim == 0 else delta


def offset_function(offset: ArrayLike) -> Array:
    """Return ``delta^3/(1 + delta^2)``, the K for which delta is best (Smith Fig. 23 a).

    Raises
    ------
    BadInput
        If a value is not a finite number of zero or more.
    """
    delta = _numbers(offset, "offset", "numbers of zero or more")
    if np.any(delta < 0):
        raise bad("offset", f"{delta.min():g}", "zero or more", "correct the sign")
    return np.asarray(_number_of(delta))


def _number_of(delta: Any) -> Any:
    return delta * delta * delta / (1.0 + delta * delta)


def _inertia(delta: Any, k: Any) -> Any:
    bars = 1.0 / 3.0 + delta * (0.5 - delta * delta / 6.0)
    return bars + k / 4.0 * ((1.0 - delta) * (1.0 + delta) / delta) ** 2


def _numbers(value: ArrayLike, where: str, expected: str) -> Array:
    try:
        found = np.asarray(value, dtype=float)
    except (TypeError, ValueError) as refusal:
        raise bad(where, repr(value)[:60], expected, "correct it") from refusal
    if found.size == 0 or not np.all(np.isfinite(found)):
        raise bad(where, "nothing finite" if found.size else "nothing", expected, "correct it")
    return found
