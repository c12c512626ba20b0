"""Ends of the unstable range of the detuning, from the effective operator of a resonance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from ..core.maxima import local_maxima

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Largest detuning, relatively, that is looked at.
MOST_DETUNING = 0.4
# Imaginary parts of the undamped equation for the exponents up to this, relatively, are round-off,
# and a coupling over the detuning's own effect.
_ROUND, _NO_COUPLING = 1e-11, 1e-14
# Share of a growing motion from which it is that of one mode.
_PRINCIPAL = 0.75


class Ends(NamedTuple):
    """Two ends of a range of the detuning, and whether the range between is unstable.

    Conjugate complex where damping closes the range or none opens.
    """

    low: complex
    high: complex
    open: bool


CLOSED = Ends(complex(np.nan), complex(np.nan), False)
# Unstable as far as the series can be trusted.
UNBOUNDED = Ends(complex(-np.inf), complex(np.inf), True)


def expected(matrices: Complex) -> tuple[float, float]:
    """Return centre and half-width of the range to first order, both positive or zero.

    From the coefficients of the powers of the detuning, ``(2, r, r)``, degree 1 alone; the first
    two rows and columns are those of the resonance.
    """
    y = -1j * matrices[:, :2, :2]
    gap = (y[:, 0, 0] - y[:, 1, 1]).real
    slope = float(gap[1])
    if slope == 0.0:
        return 0.0, 0.0
    coupling = float(np.sqrt(abs(y[0, 0, 1] * y[0, 1, 0])))
    return float(-gap[0] / slope), 2 * coupling / abs(slope)


# ---------------------------------------------------------------- two exponents


def two_exponents(matrices: Complex, centre: float, lossless: bool | None) -> Ends:
    """Return where an exponent of a 2 x 2 effective operator has a real part of zero.

    With y = -i s the exponents are ``m +- sqrt(D)``.  Undamped, m and D are real and D < 0 is
    unstable; else the condition of Routh and Hurwitz, ``4 m2^2 (m2^2 + D1) - D2^2 < 0`` with
    m2 = Im m, D = D1 + i D2.
    """
    ends = _two_ends(matrices, centre, lossless)
    if max(abs(ends.low), abs(ends.high)) > MOST_DETUNING:
        return UNBOUNDED if ends.open else CLOSED
    return ends


def _two_ends(matrices: Complex, centre: float, lossless: bool | None) -> Ends:
    y = -1j * matrices
    centre = _middle((y[:, 0, 0] - y[:, 1, 1]).real, centre)
    y = _shifted(y, centre)
    mean: Complex = (y[:, 0, 0] + y[:, 1, 1]) / 2
    half_gap: Complex = (y[:, 0, 0] - y[:, 1, 1]) / 2
    inner = np.asarray(polynomial.polymul(y[:, 0, 1], y[:, 1, 0]), dtype=complex)
    if lossless is None:
        pairs = ((mean, half_gap), (half_gap, half_gap), (inner, inner))
        lossless = all(np.max(np.abs(v.imag)) <= _ROUND * np.max(np.abs(s)) for v, s in pairs)
        if not lossless:
            # Without damping the real parts add up to zero: some exponent grows.
            return UNBOUNDED
    discriminant = polynomial.polyadd(polynomial.polymul(half_gap, half_gap), inner)
    if lossless:
        if abs(inner[0]) <= (_NO_COUPLING * float(np.max(np.abs(half_gap)))) ** 2:
            # The order is too low to open the range, or nothing opens it.
            return Ends(complex(centre), complex(centre), False)
        ends = _near_roots(np.asarray(discriminant.real, dtype=float), centre)
        if ends.low.imag != 0.0 and np.isfinite(ends.low):
            middle = complex((ends.low + ends.high).real / 2)
            return Ends(middle, middle, False)
        return ends
    loss = polynomial.polymul(mean.imag, mean.imag)
    condition = polynomial.polysub(
        4 * polynomial.polymul(loss, polynomial.polyadd(loss, discriminant.real)),
        polynomial.polymul(discriminant.imag, discriminant.imag),
    )
    ends = _near_roots(np.asarray(condition, dtype=float), centre)
    # Both exponents may grow: then there is no end between one and none.
    growing = float(mean[0].imag) < -_ROUND * float(np.max(np.abs(half_gap)))
    return UNBOUNDED if growing and not ends.open else ends


def _middle(gap: Array, centre: float) -> float:
    """Return where the diagonal entries agree, by Newton from an expected place."""
    slope = polynomial.polyder(gap)
    at = centre
    for _ in range(20):
        gradient = float(polynomial.polyval(at, slope))
        if gradient == 0.0:
            return centre
        step = float(polynomial.polyval(at, gap)) / gradient
        at -= step
        if abs(at - centre) > MOST_DETUNING:
            return centre
        if abs(step) <= 1e-16 + 4e-16 * abs(at):
            break
    return at


def _near_roots(condition: Array, centre: float) -> Ends:
    """Return the two roots nearest to zero of a polynomial, beyond a centre."""
    if len(condition) < 3 or condition[2] == 0.0:
        return CLOSED
    # The quadratic part shows how far the ends are from the centre.
    scale = max(float(np.max(np.abs(polynomial.polyroots(condition[:3])))), 1e-14)
    scaled = condition * scale ** np.arange(len(condition))
    # Powers that round-off hides where the ends can lie, up to eight times as far as the quadratic
    # part shows, would only blur the others' roots.
    weight = np.abs(scaled) * 8.0 ** np.arange(len(scaled))
    last = max(2, int(np.flatnonzero(weight > 1e-17 * np.max(np.abs(scaled)))[-1]))
    roots = polynomial.polyroots(scaled[: last + 1]).astype(complex)
    near = _polished(scaled, roots[np.argsort(np.abs(roots), kind="stable")[:2]])
    low, high = sorted((complex(root) for root in near), key=lambda root: (root.real, root.imag))
    real = low.imag == 0.0 and high.imag == 0.0
    inside = float(polynomial.polyval((low.real + high.real) / 2, scaled)) < 0
    if inside and not real:
        return UNBOUNDED
    return Ends(centre + scale * low, centre + scale * high, real and inside)


def _polished(coefficients: Array, roots: Complex) -> Complex:
    """Return roots after a few steps of Newton; far roots blur those of the companion matrix."""
    slope = polynomial.polyder(coefficients)
    for _ in range(3):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = polynomial.polyval(roots, coefficients) / polynomial.polyval(roots, slope)
        # Near a double root the quotient has no meaning.
        roots = np.where(np.abs(step) < 1e-2 * (1 + np.abs(roots)), roots - step, roots)
    return roots


def _shifted(coefficients: Complex, centre: float) -> Complex:
    """Return the coefficients in t of a polynomial in ``centre + t``."""
    out = np.zeros_like(coefficients)
    for value in coefficients[::-1]:
        out[1:] = centre * out[1:] + out[:-1]
        out[0] = centre * out[0] + value
    return out


# ---------------------------------------------------------------- more than two


@dataclass(frozen=True)
class Several:
    """Effective operator of any dimension at given parameters, as a function of the detuning.

    ``matrices`` ``(order + 1, r, r)`` are the coefficients of the detuning's powers, ``members``
    the mode, from 1, of each basis function, ``modes`` the two of the resonance, None where all
    exponents meet exactly, so that no motion belongs to some of the modes.  Where ``lossless``,
    exponents can leave the imaginary axis in pairs alone; up to ``noise``, over the size of the
    operator, an exponent does not count as growing.
    """

    matrices: Complex
    members: tuple[int, ...]
    modes: tuple[int, int] | None
    lossless: bool
    noise: float

    def ends(self, centre: float, half: float) -> Ends:
        """Return the unstable range of the resonance's modes that is nearest to a centre."""
        y = -1j * self.matrices
        slope = abs(complex(y[1, 0, 0] - y[1, 1, 1]))
        if slope == 0.0:
            return CLOSED
        reach = min(4 * float(np.linalg.norm(y[0], ord=2)) / slope, MOST_DETUNING)
        sigma = self._search_points(centre, half, reach)
        growth = self._growth(sigma)
        unstable = np.concatenate([[False], growth > self._limit, [False]])
        starts = np.flatnonzero(unstable[1:] & ~unstable[:-1])
        stops = np.flatnonzero(unstable[:-1] & ~unstable[1:]) - 1
        best, out = np.inf, CLOSED
        for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
            unbounded = start == 0 or stop == len(sigma) - 1
            if unbounded and self.lossless:
                continue
            # Without an end the range holds other tongues too, and their tops.
            inside = sigma[start : stop + 1]
            best_of = -np.abs(inside - centre) if unbounded else growth[start : stop + 1]
            top = float(inside[int(np.argmax(best_of))])
            apart = max(float(sigma[start]) - centre, centre - float(sigma[stop]), 0.0)
            if not (apart < best and self._belongs(top)):
                continue
            best, out = apart, UNBOUNDED
            if not unbounded:
                outer, inner = sigma[[start - 1, stop + 1]], sigma[[start, stop]]
                for _ in range(60):
                    middle = (outer + inner) / 2
                    grows = self._growth(middle) > self._limit
                    outer, inner = np.where(grows, outer, middle), np.where(grows, middle, inner)
                low, high = (outer + inner) / 2
                out = Ends(complex(low), complex(high), True)
        return out

    @property
    def _limit(self) -> float:
        """Growth from which an exponent counts as growing."""
        return self.noise * float(np.max(np.abs(self.matrices[0]), initial=1e-300))

    def _at(self, sigma: Array) -> Complex:
        powers = sigma[:, None] ** np.arange(len(self.matrices))
        return np.asarray(-1j * np.tensordot(powers, self.matrices, axes=1))

    def _growth(self, sigma: Array) -> Array:
        """Return the largest real part of an exponent, ``(nb,)``."""
        return np.asarray(np.max(-np.linalg.eigvals(self._at(sigma)).imag, axis=-1))

    def _distances(self, sigma: Array) -> Array:
        """Return the distances of the turnings of neighbouring exponents, ``(nb, r - 1)``."""
        turning = np.sort(np.linalg.eigvals(self._at(sigma)).real, axis=-1)
        return np.asarray(np.diff(turning, axis=-1))

    def _belongs(self, sigma: float) -> bool:
        """Return True where the growing motion is that of the resonance's modes.

        Looked at is the power that each mode takes up, its action times the growth and what damping
        takes: two modes of one tongue share it alike, whereas of the actions the lightly damped
        mode has nearly all.
        """
        if self.modes is None:
            return True
        matrix = self._at(np.array([sigma]))[0]
        values, vectors = np.linalg.eig(matrix)
        top = int(np.argmin(values.imag))
        action = np.abs(vectors[:, top]) ** 2
        first, second = (np.equal(self.members, mode) for mode in self.modes)
        if self.modes[0] == self.modes[1]:
            return float(np.sum(action[first])) >= _PRINCIPAL * float(np.sum(action))
        # With y = -i s the growth is -Im y.
        power = action * np.abs(np.diagonal(matrix).imag - values[top].imag)
        least = min(float(np.sum(power[first])), float(np.sum(power[second])))
        return least >= (1 - _PRINCIPAL) * float(np.sum(power))

    def _search_points(self, centre: float, half: float, reach: float) -> Array:
        """Return points all over, dense about the centre and where exponents nearly meet."""
        fine = max(half, 1e-3 * reach) / 8
        spread = np.linspace(-1.0, 1.0, 401)
        dense = fine * np.sinh(spread * np.arcsinh(reach / fine))
        sigma = np.unique(centre + np.concatenate([dense, reach * spread]))
        parts = [sigma]
        if not self.lossless:
            # A narrow range between two points shows as a high of the growth.
            growth = self._growth(sigma)
            for high in local_maxima(growth).tolist():
                if growth[high] <= self._limit:
                    parts += self._zoomed(sigma, high, lambda x: -self._growth(x))
            return np.unique(np.concatenate(parts))
        # Or as a low of the distance of neighbouring exponents.
        distance = self._distances(sigma)
        for column in range(distance.shape[1]):
            gap = distance[:, column]
            for low in local_maxima(-gap).tolist():
                # Exponents that coincide all along differ by round-off alone.
                if gap[low] > 1e-12 * np.max(gap):
                    parts += self._zoomed(sigma, low, partial(self._distance, column))
        return np.unique(np.concatenate(parts))

    def _distance(self, column: int, sigma: Array) -> Array:
        return self._distances(sigma)[:, column]

    def _zoomed(self, sigma: Array, place: int, function: Callable[[Array], Array]) -> list[Array]:
        """Return points that close in on a low of a function, until the growth there is seen."""
        left, right = float(sigma[place - 1]), float(sigma[place + 1])
        parts = []
        for _ in range(12):
            inner = np.linspace(left, right, 17)
            parts.append(inner)
            best = int(np.argmin(function(inner)))
            if self._growth(inner[best : best + 1])[0] > self._limit:
                break
            left, right = float(inner[max(best - 1, 0)]), float(inner[min(best + 1, 16)])
        return parts
