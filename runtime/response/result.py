"""What a steady state is: the periodic motion, its error, its stability."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.deferred import DeferredField
from ..core.errors import bad
from ..core.inputs import numbers
from ..core.results import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Fields that may be worked out when they are first looked at.
_LATER = {name: DeferredField() for name in ("multipliers", "stable", "distance")}


@dataclass(frozen=True, kw_only=True)
class SteadyState(Result):
    """Periodic motion of a forced linear periodic system, of the period of its coefficients.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    theta : ndarray
        Crank angles [rad] that divide the period evenly, from 0, shape ``(nt,)``; nt is a power
        of two where a method chooses its angles itself.
    q, qd : ndarray
        Coordinates and their time derivatives [1/s], shape ``(*batch, nt, n)``; NaN where there is
        no single periodic motion (``distance`` within its error).
    error : ndarray
        Largest error of each coordinate over its own peak, shape ``(*batch, n)``; inf where q is
        NaN.
    multipliers : ndarray of complex or None
        Floquet multipliers, shape ``(*batch, 2n)``, by falling modulus, or fewer, of the slow
        modes of a stiff system; None where they were not computed.
    stable : ndarray of bool or None
        Whether nearby motions stay near: no multiplier outside the unit circle by more than its
        error; shape ``batch``.  Without it the motion exists, and no machine would show it.  None
        where the multipliers were not computed.
    distance : ndarray
        Distance of the closest multiplier from 1, shape ``batch``: the response grows like its
        inverse.  NaN where the multipliers were not computed.
    sensitivity : ndarray
        Relative change of the motion over a relative change of what it is solved from, the flow
        or the balanced equation, shape ``batch``.
    period : float
        Period [rad].
    labels : tuple of str
        Names of the coordinates.
    reference_length : float
        Length [m] that turns shapes times coordinates into deflections.
    shapes : callable or None
        From places x/length ``(nx,)`` and crank angles ``(nt,)`` to the mode shapes
        ``(nt, nx, n)``; None where the system has none.
    cycles : ndarray of int or None
        Periods that a march took to settle, shape ``batch``; -1 where it did not.  None of a
        method that does not march.

    Notes
    -----
    Multipliers that the method has no need of, and nobody asked for, are computed when one of
    ``multipliers``, ``stable`` and ``distance`` is first looked at.
    """

    speed: Array
    theta: Array
    q: Array
    qd: Array
    multipliers: Any = _LATER["multipliers"]  # ComplexArray | None
    stable: Any = _LATER["stable"]  # NDArray[np.bool_] | None
    distance: Any = _LATER["distance"]  # Array
    sensitivity: Array
    period: float
    labels: tuple[str, ...]
    reference_length: float
    shapes: Callable[[Array, Array], Array | None] | None = field(default=None, repr=False)
    cycles: NDArray[np.int64] | None = None

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {"theta": ("sample",)}

    @property
    def coefficients(self) -> ComplexArray:
        """Fourier coefficients c of q, shape ``(*batch, nt/2 + 1, n)``.

        ``q(theta) = Re(c_0 + 2 sum_k c_k exp(2 pi i k theta/period))``, the last one once where nt
        is even.
        """
        values: ComplexArray = np.fft.rfft(self.q, axis=-2) / len(self.theta)
        return values

    def deflection(self, x: ArrayLike = 1.0) -> Array:
        """Return the deflection [m] at places x/length ``(nx,)``, shape ``(*batch, nt, nx)``.

        The axis of places is left out where ``x`` is one number, at the end by default.

        Raises
        ------
        BadInput
            If the system has no mode shapes, or a place is not a number from 0 to 1.
        """
        places = numbers("x", x)
        found = self._shapes_at(np.atleast_1d(places))
        value: Array = self.reference_length * np.einsum("txn,...tn->...tx", found, self.q)
        return value[..., 0] if places.ndim == 0 else value

    def _shapes_at(self, places: Array) -> Array:
        if places.ndim > 1 or not np.all((places >= 0) & (places <= 1)):
            raise bad("x", str(places), "places x/length from 0 to 1", "divide by the length")
        found = None if self.shapes is None else self.shapes(places, self.theta)
        if found is None:
            raise bad(
                "deflection",
                "a system without mode shapes",
                "LinearPeriodic.shape or moving_shape",
                "use q",
            )
        return found

    def peak(self, x: ArrayLike = 1.0) -> Array:
        """Return the largest size of the deflection [m] over the period, at places x/length.

        Shape ``(*batch, nx)``, or ``batch`` where ``x`` is one number; it is taken at the given
        angles.

        Raises
        ------
        BadInput
            As :meth:`deflection`.
        """
        places = numbers("x", x)
        shapes = self._shapes_at(np.atleast_1d(places))
        flat = self.q.reshape(-1, *self.q.shape[-2:])
        # One motion at a time: all of them at all places would fill the memory.
        found = [np.max(np.abs(np.einsum("txn,tn->tx", shapes, one)), axis=0) for one in flat]
        value: Array = self.reference_length * np.reshape(found, (*self.q.shape[:-2], -1))
        return value[..., 0] if places.ndim == 0 else value

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over the crank angle and return the axes; the first of a batch."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        first = self.q.reshape(-1, *self.q.shape[-2:])[0]
        angles = np.degrees(np.append(self.theta, self.period))
        for label, values in zip(self.labels, np.vstack([first, first[:1]]).T, strict=True):
            ax.plot(angles, values, label=label, linewidth=0.9)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("coordinate")
        if len(self.labels) > 1:
            ax.legend()
        return ax
