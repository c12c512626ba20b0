"""Real functions of period 2 pi as finite Fourier series, with the error of the representation.

Convention, everywhere in the toolkit (Smith (7.20)):

    f(theta) = a[0] + sum over m >= 1 of ( a[m] cos m theta + b[m] sin m theta )

``a[0]`` is the mean itself, without a factor 1/2; ``b[0]`` is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .chebyshev import length
from .errors import bad, shown
from .inputs import is_finite, numbers_in_a_row
from .trigonometric import finite_angles, irregular_angles, values_at

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_FEWEST, _MOST = 32, 2**16
# A callable whose tail no longer falls when the samples are doubled has met the round-off of its
# own evaluation; above this fraction of its largest coefficient that is not round-off any more.
_NOISE = 1e-11
_FLAT = 2.5
# Angles off every grid: about 0.02 apart, so that a peak of width 0.002 does not slip between.
_PROBES = 512


@dataclass(frozen=True, eq=False)
class PeriodicFunction:
    """A real function of period 2 pi, ``a[0] + sum_m a[m] cos m theta + b[m] sin m theta``.

    Parameters
    ----------
    a : array_like, shape (na,)
        Cosine coefficients; ``a[0]`` is the mean itself (no factor 1/2).
    b : array_like, shape (nb,), optional
        Sine coefficients; ``b[0]`` must be zero.  The shorter of ``a`` and ``b`` is filled with
        zeros: both are kept as read-only arrays of shape ``(harmonics + 1,)``.
    error : float
        Estimate of the largest deviation, over all angles, from the function that is meant; zero
        where the coefficients define the function.

    Raises
    ------
    BadInput
        If a coefficient is no finite number, they are not in a row, or ``b[0]`` is not zero.

    Notes
    -----
    Smith (7.20).  Two functions compare equal only where they are the same object.

    Examples
    --------
    >>> import elastolink as el
    >>> print(el.PeriodicFunction(a=[0.0, 1.0, 0.2], b=[0.0, 0.1])([0.0, 1.0]).round(4))
    [1.2    0.5412]
    """

    a: Array
    b: Array
    error: float

    def __init__(self, a: ArrayLike = (0.0,), b: ArrayLike = (0.0,), error: float = 0.0) -> None:
        cos = numbers_in_a_row("PeriodicFunction.a", a)
        sin = numbers_in_a_row("PeriodicFunction.b", b)
        if sin[0] != 0.0:
            raise bad("PeriodicFunction.b[0]", sin[0], "0", "b[m] belongs to sin m theta")
        if not (is_finite(error) and error >= 0.0):
            raise bad("PeriodicFunction.error", shown(error), "a finite number >= 0", "correct it")
        size = max(len(cos), len(sin))
        object.__setattr__(self, "a", _filled(cos, size))
        object.__setattr__(self, "b", _filled(sin, size))
        object.__setattr__(self, "error", float(error))

    @classmethod
    def from_samples(cls, values: ArrayLike) -> PeriodicFunction:
        """Interpolate samples at the angles 2 pi j / N, j = 0 ... N - 1.

        Parameters
        ----------
        values : array_like, shape (N,)
            One period, the end point not repeated.  For even N the highest harmonic, N/2, has a
            cosine alone (its sine vanishes at every sample).

        Returns
        -------
        PeriodicFunction
            Its ``error`` is an estimate of what the samples cannot show: the energy of the highest
            eighth of the harmonics, taken as the size of what was folded down, and round-off.

        Raises
        ------
        BadInput
            If the samples are not a non-empty one-dimensional array of finite numbers.
        """
        samples = numbers_in_a_row("PeriodicFunction.values", values)
        a, b = _analyse(samples)
        size = np.hypot(a, b)
        top = size[-max(1, len(size) // 8) :] if len(samples) > 2 else np.zeros(1)
        noise = 4.0 * _EPS * float(np.max(np.abs(samples)))
        return cls(a, b, error=2.0 * float(np.sum(top)) + noise)

    @classmethod
    def from_callable(
        cls, f: Callable[[Array], ArrayLike], tol: float | None = None
    ) -> PeriodicFunction:
        """Find the Fourier series of a function, doubling the samples until the tail is small.

        Parameters
        ----------
        f : callable
            Vectorised: angles [rad], shape ``(N,)``, to values of the same shape.
        tol : float, optional
            Wanted size of the tail, relative to the largest coefficient; ``error`` is larger, the
            more so the slower the coefficients fall.  By default round-off:
            the doubling stops at 8 machine epsilons, or where the tail is below 1e-11 and does not
            fall any more (the round-off of ``f`` itself); the level reached enters ``error``.

        Returns
        -------
        PeriodicFunction
            Coefficients up to the last one above the tail.  ``error`` estimates what is dropped
            and what lies beyond the samples (from the decay of the last octaves), and is at least
            twice the largest deviation at 512 irregular angles; a peak narrower than about 0.002
            rad may still pass unseen.

        Raises
        ------
        BadInput
            If values are not finite or of the wrong shape, or the tail is still too large with
            65536 samples (the function, or a derivative of it, jumps).
        """
        label = getattr(f, "__name__", type(f).__name__)
        if tol is not None and not 0.0 < tol < 1.0:
            raise bad("tol", tol, "a number between 0 and 1", "leave it out for round-off")
        count, before, settled = _FEWEST, np.inf, False
        while True:
            values = values_at(f, 2.0 * np.pi * np.arange(count) / count, label)
            a, b = _analyse(values)
            size = np.hypot(a, b)
            scale = max(float(np.max(size)), _EPS * float(np.max(np.abs(values))), 5e-324)
            tail = float(np.max(size[len(size) // 2 :])) / scale
            goal = 8.0 * _EPS if tol is None else tol
            flat = tol is None and tail < _NOISE and tail * _FLAT > before
            small = tail <= goal or flat
            # One small tail may be chance; two doublings have to agree, as far as they may go.
            if small and (settled or count >= _MOST):
                # Noise reaches a few times higher than it does in the upper half.
                level = max(4.0 * tail, goal) if tol is None else goal
                found = _chopped(cls, a, b, level * scale, values, coherent=tol is not None)
                # At angles off every grid: samples alone cannot tell 32 theta from 0 theta.
                theta = irregular_angles(_PROBES)
                gap = float(np.max(np.abs(values_at(f, theta, label) - found(theta))))
                # Where f itself cancels, its noise is that of its largest values.
                if gap <= 1e3 * max(tail, goal) * max(scale, float(np.max(np.abs(values)))):
                    return cls(found.a, found.b, max(found.error, 2.0 * gap))
                tail, small = max(tail, gap / scale), False
            if count >= _MOST:
                given = f"a Fourier tail of {tail:.1e} of its largest coefficient"
                given += f" at {count} samples"
                fix = "give a smooth function of period 2 pi, or a larger tol"
                raise bad(f"function {label!r}", given, f"at most {goal:.1e}", fix)
            count, before, settled = 2 * count, tail, small

    @property
    def harmonics(self) -> int:
        """Highest harmonic that the series holds."""
        return len(self.a) - 1

    @property
    def mean(self) -> float:
        """The mean over a period, ``a[0]``."""
        return float(self.a[0])

    @property
    def amplitudes(self) -> Array:
        """Amplitude ``sqrt(a[m]^2 + b[m]^2)`` of each harmonic, shape ``(harmonics + 1,)``."""
        return np.hypot(self.a, self.b)

    def __call__(self, theta: ArrayLike) -> Array:
        """Evaluate at angles [rad] of any shape; the result has the same shape."""
        angles = finite_angles(theta)
        # Horner in exp(i theta): one complex exponential per angle, whatever the harmonics.
        z = np.exp(1j * angles)
        coefficients = self.a - 1j * self.b
        total = np.zeros(angles.shape, dtype=complex)
        for c in coefficients[:0:-1]:
            total += c
            total *= z
        return np.asarray(total.real + coefficients[0].real)

    def __add__(self, other: PeriodicFunction | float) -> PeriodicFunction:
        if isinstance(other, (int, float, np.integer, np.floating)):
            other = PeriodicFunction([float(other)])
        if not isinstance(other, PeriodicFunction):
            return NotImplemented
        size = max(len(self.a), len(other.a))
        a = _filled(self.a, size) + _filled(other.a, size)
        b = _filled(self.b, size) + _filled(other.b, size)
        return PeriodicFunction(a, b, self.error + other.error)

    __radd__ = __add__

    def __mul__(self, factor: float) -> PeriodicFunction:
        if not isinstance(factor, (int, float, np.integer, np.floating)):
            return NotImplemented
        c = float(factor)
        return PeriodicFunction(c * self.a, c * self.b, abs(c) * self.error)

    __rmul__ = __mul__

    def __neg__(self) -> PeriodicFunction:
        return self * -1.0

    def __sub__(self, other: PeriodicFunction | float) -> PeriodicFunction:
        return self + (-1.0) * other

    def derivative(self) -> PeriodicFunction:
        """Return df/d theta.

        Its ``error`` is ``max(harmonics, 1)`` times that of the function (Bernstein's inequality
        for the part of the error that lies within the retained harmonics).
        """
        m = np.arange(len(self.a))
        return PeriodicFunction(m * self.b, -m * self.a, self.error * max(self.harmonics, 1))

    def truncated(self, tol: float = 0.0) -> PeriodicFunction:
        """Drop the highest harmonics whose amplitudes together are at most ``tol``.

        Parameters
        ----------
        tol : float
            Largest absolute change of the function that is allowed; 0 drops exact zeros alone.

        Returns
        -------
        PeriodicFunction
            ``error`` is enlarged by the sum of the amplitudes dropped, a bound of the change.
        """
        if not (np.isfinite(tol) and tol >= 0.0):
            raise bad("tol", tol, "a finite number >= 0", "correct it")
        tails = np.cumsum(self.amplitudes[::-1])[::-1]
        keep = max(1, int(np.count_nonzero(tails > tol)))
        if keep == len(self.a):
            return self
        dropped = float(tails[keep])
        return PeriodicFunction(self.a[:keep], self.b[:keep], self.error + dropped)

    def bound(self) -> float:
        """Return ``sum of the amplitudes + error``: the function never exceeds it in size."""
        return float(np.sum(self.amplitudes)) + self.error


def segment_values(f: PeriodicFunction, segments: int, nodes: tuple[float, ...]) -> Array:
    """Evaluate at nodes in ``[-1, 1]`` of equal segments of the circle, by one short FFT per node.

    Returns an array of shape ``(segments, len(nodes))``.
    """
    turned = (f.a - 1j * f.b) * _phases(f.harmonics, segments, nodes)
    # Harmonics that differ by a multiple of the number of segments agree at equal nodes.
    layers = -(-turned.shape[1] // segments)
    folded = np.zeros((len(nodes), layers * segments), dtype=complex)
    folded[:, : turned.shape[1]] = turned
    spectrum = folded.reshape(len(nodes), layers, segments).sum(axis=1)
    return np.ascontiguousarray(np.fft.ifft(spectrum, norm="forward").real.T)


@lru_cache(maxsize=32)
def _phases(harmonics: int, segments: int, nodes: tuple[float, ...]) -> NDArray[np.complex128]:
    """Return ``exp(i m theta)`` at the nodes of the first segment, shape (nodes, harmonics + 1)."""
    within = 0.5 * (1.0 + np.asarray(nodes)) / segments
    turns = within[:, None] * np.arange(harmonics + 1)
    out: NDArray[np.complex128] = np.exp(2j * np.pi * (turns - np.rint(turns)))
    out.setflags(write=False)
    return out


def _filled(values: Array, size: int) -> Array:
    """Return values, filled with zeros, read-only."""
    out = np.zeros(size)
    out[: len(values)] = values
    out.setflags(write=False)
    return out


def _analyse(samples: Array) -> tuple[Array, Array]:
    """Return the coefficients of the trigonometric interpolant of equidistant samples."""
    n = len(samples)
    spectrum = np.fft.rfft(samples) / n
    # The mean, and of an even number the highest harmonic, have no sine.
    plain = [0, -1] if n % 2 == 0 else [0]
    weight = np.full(len(spectrum), 2.0)
    weight[plain] = 1.0
    a, b = weight * spectrum.real, -weight * spectrum.imag
    b[plain] = 0.0
    return a, b


def _chopped(
    cls: type[PeriodicFunction], a: Array, b: Array, level: float, values: Array, coherent: bool
) -> PeriodicFunction:
    """Drop what lies beyond the last coefficient above ``level`` and state the error."""
    # `coherent` says that what is dropped is the function's own, not the noise of its evaluation.
    size = np.hypot(a, b)
    keep = length(size, level)
    largest = float(np.max(np.abs(values)))
    rest = size[keep:]
    if coherent:
        dropped = float(np.sum(rest)) + _unseen(size, largest)
    else:
        # Noise adds as a random sum; what stands out from it may add in step.
        loud = rest > 8.0 * float(np.median(size[-(len(size) // 4) :]))
        top = max(float(np.max(rest, initial=0.0)), 5e-324)
        dropped = float(np.sum(rest[loud])) + 3.0 * top * float(np.linalg.norm(rest[~loud] / top))
        dropped = min(dropped, float(np.sum(rest)))
    # What is folded down is about as large as what is dropped.
    return cls(a[:keep], b[:keep], error=2.0 * dropped + 4.0 * _EPS * largest)


def _unseen(size: Array, largest: float) -> float:
    """Extrapolate the sum of the harmonics beyond the samples from the decay of two octaves."""
    # The last octave is left out: what is folded down has raised it.  A series that falls no faster
    # than those of functions that jump may be off by as much as the function is large.
    n = len(size) - 1
    before, last = (float(np.sum(size[n // k : 2 * n // k])) for k in (8, 4))
    if last >= 0.9 * before:
        return largest if last > 4.0 * _EPS * largest else last
    ratio = last / before
    return min(last * ratio * ratio / (1.0 - ratio), largest)
