"""Certified boundaries: every end with an interval that is proved to hold it.

Isolation: the float eigenvectors X need not be orthonormal, since Sylvester's and Ostrowski's
theorems relate the eigenvalues of A to those of X^T A X, which is nearly diagonal, and the rounding
of every product is bounded a priori (n u / (1 - n u) times the product of the absolute values).

Enclosure: a group of trial functions close to the eigenfunctions of a group of eigenvalues gives
the matrix P of the operator in their span and the norm r of what leaves the span, both from exact
integers.  Where all other eigenvalues keep a distance g from the group, each eigenvalue of the
group differs from its own one of P by no more than ``r^2 / (g - 2 r)`` (Kato and Temple).

With damping the operator is not symmetric: there each eigenvalue is proved by Newton's method in
the space of its eigenvector (Kantorovich), and where a region is closed the operator is proved to
be invertible for every lam2 in it.  Both rest on a bound of the norm of an inverse: an approximate
one for the low harmonics, checked by multiplication, and a Neumann series for the rest.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from math import inf, isqrt, nextafter, sqrt
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput, bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check, provenance
from .boundaries import Boundaries
from .checks import Array, Mask
from .fourier_matrix import by_parity, squares, stacked, truncation

# Integers of any length.  A wave holds real and imaginary parts, ``(2, L)``, of the coefficients of
# exp(i k theta), k = -(L-1)/2 ... (L-1)/2, which is whole or half-whole.
Exact = NDArray[Any]

_U = 0.5 * float(np.finfo(float).eps)
# What the eigenvectors leave out shall not be seen beside the rounding of the trial vectors.
_GOAL, _LOOSEST = 1e-26, 1e-3
# Binary digits of trial vectors, of the coefficients mu a_m and mu b_m, of a rotation.
_VECTOR_BITS, _FUNCTION_BITS, _TURN_BITS = 62, 160, 60
# What inner products count in, and products of the operator (which is taken four times).
_SQUARE_UNIT, _UNIT = 1 << (2 * _VECTOR_BITS), 4 << _FUNCTION_BITS


class Ball(NamedTuple):
    """A proved enclosure: the value lies within ``radius`` of ``middle``."""

    middle: Fraction
    radius: Fraction


Ends = tuple[Ball | None, Ball]


@dataclass(frozen=True, kw_only=True)
class CertifiedBoundaries(Boundaries):
    """Boundaries with proved enclosures, for the equation with the coefficients of f as given.

    ``lower + lower_rest``, added without rounding, lies within ``lower_radius`` of the end, and
    likewise for the upper one; ``error`` bounds what ``lower`` and ``upper`` alone are off by.

    Attributes
    ----------
    lower_rest, upper_rest : ndarray, shape (len(regions), *mu.shape)
        What the doubles ``lower`` and ``upper`` lack, as doubles.
    lower_radius, upper_radius : ndarray, same shape
        Half-widths of the enclosures.
    pair : ndarray of bool, same shape
        True where the enclosures of the two ends overlap: the region is closed, or open by no
        more than their widths.  Where it is false, and the ends are numbers, the region is open.
    closed : ndarray of bool, same shape
        True where damping is proved to have closed the region: the ends are NaN there.  They are
        NaN as well where neither could be proved (close to the tip), which fails a check.
    function_error : ndarray, shape of mu
        ``|mu| f.error``: how much further the ends of the function that is meant may lie.  It is
        as good as ``f.error``, mostly an estimate, and not part of the bounds.
    """

    lower_rest: Array
    upper_rest: Array
    lower_radius: Array
    upper_radius: Array
    pair: Mask
    closed: Mask
    function_error: Array

    arrays_along: ClassVar = {
        "region mu": "lower_rest upper_rest lower_radius upper_radius pair closed",
        "mu": "function_error",
    }

    def enclosure(self, end: str, *index: int) -> tuple[Fraction, Fraction]:
        """Return the exact ends of one interval.

        Parameters
        ----------
        end : {"lower", "upper"}
            Which end of the region.
        *index : int
            Place in ``lower`` or ``upper``.

        Raises
        ------
        BadInput
            If the end is neither, or is not a number there.
        """
        if end not in ("lower", "upper"):
            raise bad("enclosure", repr(end), "'lower' or 'upper'", "name one of them")
        parts = [float(getattr(self, end + tail)[index]) for tail in ("", "_rest", "_radius")]
        if not np.isfinite(parts[0]):
            raise bad("enclosure", f"an end of {parts[0]}", "a finite end", "choose another")
        middle, radius = Fraction(parts[0]) + Fraction(parts[1]), Fraction(parts[2])
        return middle - radius, middle + radius


def certified_boundaries(
    f: PeriodicFunction, mu: Array, damping: Array, regions: tuple[int, ...]
) -> CertifiedBoundaries:
    """Return proved enclosures of the ends, of mu and K of one shape, all checked."""
    size = (len(regions), *mu.shape)
    # Value, rest and radius of the lower and of the upper end.
    found = np.full((*size, 2, 3), np.nan)
    pair, closed = np.zeros((2, *size), dtype=bool)
    for at in np.ndindex(mu.shape):
        mean = Fraction(float(mu[at])) * Fraction(float(f.a[0]))
        for row, ends in enumerate(_slice(f, float(mu[at]), float(damping[at]), regions)):
            place = (row, *at)
            if not isinstance(ends, tuple):
                closed[place] = ends is True
                continue
            found[place] = [_in_doubles(ball, mean) for ball in ends]
            lower, upper = ends
            if lower is not None:
                pair[place] = upper.middle - lower.middle <= upper.radius + lower.radius
    names = [side + tail for side in ("lower", "upper") for tail in ("", "_rest", "_radius")]
    arrays = dict(zip(names, np.moveaxis(found, (-2, -1), (0, 1)).reshape(6, *size), strict=True))
    # What the doubles alone are off by.
    left = np.max(np.abs(found[..., 1]) + found[..., 2], axis=-1)
    undecided = float(np.count_nonzero(np.isnan(arrays["upper"]) & ~closed))
    return CertifiedBoundaries(
        method="Hill matrix, certified: exact residuals, Kato-Temple bounds",
        error=np.nextafter(left, np.inf),
        error_norm="absolute, entrywise, for either end",
        error_kind="bound",
        checks={"regions that damping may have closed, undecided": Check(undecided, 0.0)},
        provenance=provenance(),
        regions=regions,
        mu=mu,
        damping=damping,
        function_error=np.abs(mu) * f.error,
        **arrays,
        pair=pair,
        closed=closed,
    )


def _in_doubles(ball: Ball | None, mean: Fraction) -> tuple[float, float, float]:
    """Return the middle less the mean as the sum of two doubles, and a double above the radius."""
    if ball is None:
        return -inf, 0.0, 0.0
    middle = ball.middle - mean
    value = float(middle)
    rest = float(middle - Fraction(value))
    radius = ball.radius + abs(middle - Fraction(value) - Fraction(rest))
    return value, rest, nextafter(float(radius), inf) if radius else 0.0


def _slice(
    f: PeriodicFunction, mu: float, k: float, regions: tuple[int, ...]
) -> list[Ends | bool | None]:
    """Return the balls of both ends of each region at one mu, without the mean of f."""
    # There is no lower one for region 0.
    # With damping: True where the region is proved closed, None where nothing is proved.
    out: dict[int, Ends | bool | None] = {}
    for odd, rows in by_parity(regions):
        numbers = sorted({regions[i] for i in rows})
        coarse = spectrum(f, mu, odd, numbers[-1] + 2, k * k)
        if k > 0.0:
            problem = DampedProblem(f, mu, k, coarse)
            out.update((n, problem.ends(n)) for n in numbers)
            continue
        operator, known = HillOperator(f, mu), dict[int, Ball]()
        for n in numbers:
            for j in (n - 1, n) if n else (0,):
                if j not in known:
                    coarse, first, last = _group(f, mu, coarse, j)
                    balls = enclosures(coarse, operator, first, last)
                    known.update(zip(range(first, last + 1), balls, strict=True))
            out[n] = known.get(n - 1), known[n]
    return [out[n] for n in regions]


def _group(f: PeriodicFunction, mu: float, coarse: Spectrum, j: int) -> tuple[Spectrum, int, int]:
    """Return the group of eigenvalue j, with more of the spectrum where it takes that."""
    for _ in range(6):
        group = coarse.cluster(j)
        if group is not None:
            return coarse, *group
        coarse = spectrum(f, mu, coarse.odd, 2 * len(coarse.values) + coarse.odd)
    raise refusal(f"{len(coarse.values)} eigenvalues close together")


def refusal(reason: str) -> BadInput:
    """Return the error for a problem that cannot be certified."""
    expected = "eigenvalues that double precision tells apart"
    fix = "take a smaller mu, lower regions or fewer harmonics"
    return bad("hill_boundaries(certified=True)", reason, expected, fix)


# ---------------------------------------------------------------- coarse positions


class Spectrum(NamedTuple):
    """Low eigenvalues of the equation without its mean and damping, in one of the two problems."""

    # Approximate eigenvalues, rising, ``(count,)``; each true one lies within ``reach`` of its own
    # (proved).
    values: Array
    vectors: Array  # in the basis of :func:`.fourier_matrix.squares`, ``(size, count)``
    reach: float
    norm: float
    odd: int
    harmonic: int

    def cluster(self, wanted: int) -> tuple[int, int] | None:
        """Return the first and last index of the group of one that stands clear of all others.

        None where the group reaches the end of what is known.
        """
        values = self.values
        defect = 64.0 * _U * self.norm
        # The square of the residual over the gap shall stay below a thousandth of a rounding,
        # unless that would join what is well apart.
        sharp = min(defect * defect / (1e-21 * (1.0 + abs(values[wanted]))), 0.05)
        clear = max(1e-3, 64.0 * self.reach, sharp)
        first = last = wanted
        while first > 0 and values[first] - values[first - 1] < clear:
            first -= 1
        while last + 1 < len(values) and values[last + 1] - values[last] < clear:
            last += 1
        return None if last + 1 >= len(values) else (first, last)


def spectrum(
    f: PeriodicFunction, mu: float, odd: int, highest: int, shift: float = 0.0
) -> Spectrum:
    """Return the eigenvalues that belong to regions up to ``highest``, with a proved reach.

    ``highest`` is even for the whole problem and odd for the half-whole one; ``shift`` asks for
    harmonics enough for eigenvalues that damping moves up by so much.
    """
    first = _GOAL * (1.0 + abs(mu) * float(f.amplitudes[1:].sum()))
    for goal in (min(_LOOSEST, 1e4**step * first) for step in range(6)):
        with suppress(BadInput):
            cut = truncation(f, abs(mu), highest, shift, goal)
            break
    else:
        cut = truncation(f, abs(mu), highest, shift, _LOOSEST)
    harmonic = cut.harmonic + odd
    matrix = stacked(f, odd, harmonic, np.array([mu]))[0]
    values, vectors = np.linalg.eigh(matrix)
    size = len(values)
    wide = float(np.linalg.norm(squares(odd, harmonic)))
    wide += np.sqrt(size) * abs(mu) * float(f.amplitudes[1:].sum())
    # Products of n terms, a few roundings more for the entries of the matrix and the scaling.
    gamma = 1.01 * (size + 16) * _U
    overlap = vectors.T @ vectors - np.eye(size)
    tilt = float(np.linalg.norm(overlap)) + 2.0 * gamma * size
    residual = matrix @ vectors - vectors * values
    defect = float(np.linalg.norm(residual)) + 2.0 * gamma * wide * np.sqrt(size)
    largest = float(np.abs(values).max())
    reach = cut.left_out + 1.1 * (tilt * 2.0 * largest + (1.0 + tilt) * defect) / (1.0 - tilt)
    if not (tilt < 0.1 and np.isfinite(reach)):
        raise refusal(f"|mu| = {abs(mu):.3g} with {size} equations")
    count = min(highest + 1, size)
    return Spectrum(values[:count], vectors[:, :count], reach, cut.norm, odd, harmonic)


# ---------------------------------------------------------------- exact products


class HillOperator:
    """``4 (k^2 - mu (f - mean) - 2 K d/d theta)`` on waves, in units of ``2**-160``."""

    def __init__(self, f: PeriodicFunction, mu: float, damping: float = 0.0) -> None:
        factor, unit = Fraction(mu), 1 << _FUNCTION_BITS
        cos, sin = (
            [round(factor * Fraction(float(x)) * unit) for x in part[1:]] for part in (f.a, f.b)
        )
        self._real: Exact = np.array([*cos[::-1], 0, *cos], dtype=object)
        self._imaginary: Exact = np.array([*sin[::-1], 0, *(-x for x in sin)], dtype=object)
        drag = 4 * Fraction(damping) * unit
        # K = m 2^-e with a long e has digits beyond the unit: they count as rounding as well.
        self._drag = round(drag)
        self._drag_rounding = Fraction(0 if drag == self._drag else 1, unit)
        self._rounding = Fraction(2 * f.harmonics, unit)

    def __call__(self, x: Exact) -> Exact:
        """Apply the operator; the result reaches as many harmonics further as f has."""
        reach, count = len(self._real) // 2, x.shape[1] + len(self._real) - 1
        wide = np.zeros((2, count + 2 * reach), dtype=object)
        wide[:, 2 * reach : 2 * reach + x.shape[1]] = x
        # The upper half; what multiplies exp(-i k theta) is its conjugate.
        upper, here = wide[:, count // 2 :], wide[:, count // 2 + reach : count + reach]
        twice = np.arange(1 - count, count, 2)[count // 2 :].astype(object)
        out = ((twice * twice) << _FUNCTION_BITS) * here
        out -= 2 * np.stack([np.convolve(part, self._real, "valid") for part in upper])
        if self._imaginary.any():
            turned = np.stack([np.convolve(part, self._imaginary, "valid") for part in upper])
            out += 2 * np.stack([turned[1], -turned[0]])
        if self._drag:
            out += self._drag * twice * np.stack([here[1], -here[0]])
        lower = out[:, ::-1][:, : count // 2]
        return np.concatenate([np.stack([lower[0], -lower[1]]), out], axis=1)

    def doubt(self, x: Exact) -> Fraction:
        """Bound what rounding changes in a quarter of the product with a wave of norm 1.

        ``x`` is as long as the wave.
        """
        return self._rounding + self._drag_rounding * int(x.shape[1] // 2 + 2)


def wave(odd: int, column: Array) -> Exact:
    """Round an eigenvector in the basis of :func:`.fourier_matrix.squares` to integers."""
    # From coefficients of 1, sqrt 2 cos k theta, sqrt 2 sin k theta to those of exp(i k theta).
    pairs = column[1 - odd :].reshape(-1, 2)
    positive = np.sqrt(0.5) * (pairs[:, 0] - 1j * pairs[:, 1])
    middle = np.zeros(0) if odd else column[:1]
    z = np.concatenate([positive[::-1].conj(), middle, positive]) * 2.0**_VECTOR_BITS
    return np.array([np.rint(z.real), np.rint(z.imag)]).astype(np.int64).astype(object)


def inner(x: Exact, y: Exact) -> int:
    """Return the inner product of two waves, y at least as long as x."""
    reach = (y.shape[1] - x.shape[1]) // 2
    return int((x * y[:, reach : reach + x.shape[1]]).sum())


def _norm(x: Exact, bits: int) -> Fraction:
    """Return an upper bound of the norm of a wave in units of ``2**-bits``."""
    return _root_above(Fraction(inner(x, x), 1 << (2 * bits)))


def _size(x: Exact) -> Fraction:
    """Return the norm of a product of the operator with a trial function, from above."""
    return _norm(x, _VECTOR_BITS + _FUNCTION_BITS + 2)


def _less(image: Exact, x: Exact, factor: int) -> Exact:
    """Return ``image - factor x``, the image being longer."""
    reach = (image.shape[1] - x.shape[1]) // 2
    out: Exact = image.copy()
    out[:, reach : reach + x.shape[1]] -= factor * x
    return out


def _root_above(value: Fraction) -> Fraction:
    """Return an upper bound of the square root, a hair above it."""
    shift = max(0, 128 + value.denominator.bit_length() - value.numerator.bit_length())
    shift += shift % 2
    scaled = -((-value.numerator << shift) // value.denominator)
    return Fraction(isqrt(scaled) + 1, 1 << (shift // 2))


# ---------------------------------------------------------------- without damping


def enclosures(coarse: Spectrum, operator: HillOperator, first: int, last: int) -> list[Ball]:
    """Enclose the eigenvalues number first ... last, which stand clear of all others."""
    waves = [wave(coarse.odd, coarse.vectors[:, j]) for j in range(first, last + 1)]
    images = [operator(x) for x in waves]
    coupling = np.array([[inner(x, h) for h in images] for x in waves], dtype=object)
    overlap = np.array([[inner(x, y) for y in waves] for x in waves], dtype=object)
    residual = _residual(waves, images, coupling, overlap)
    values = [Fraction(float(v)) for v in coarse.values]
    rounding = operator.doubt(waves[0])
    reach = Fraction(coarse.reach) + rounding
    gaps = [values[last + 1] - values[last]]
    if first:
        gaps.append(values[first] - values[first - 1])
    gap = min(gaps) - 2 * reach
    balls = _inside(coupling, overlap)
    low, high = values[first] - reach - gap / 2, values[last] + reach + gap / 2
    # The eigenvalues of P must be those next to the group, and nothing else there.
    there = all(low <= b.middle - b.radius and b.middle + b.radius <= high for b in balls)
    if not (there and 4 * residual < gap):
        raise refusal(f"a residual of {float(residual):.1e} beside a gap of {float(gap):.1e}")
    spread = residual * residual / (gap - 2 * residual) + rounding
    return [Ball(ball.middle, ball.radius + spread) for ball in balls]


def _residual(waves: list[Exact], images: list[Exact], coupling: Exact, overlap: Exact) -> Fraction:
    """Bound the norm of what the operator takes out of the span of the trial functions."""
    total = 0
    for i, image in enumerate(images):
        # Any combination may be taken off; the projection would be best.
        rest = image << _VECTOR_BITS
        for j, x in enumerate(waves):
            rest = _less(rest, x, (coupling[j, i] << _VECTOR_BITS) // overlap[j, j])
        total += inner(rest, rest)
    # How far the trial functions are from an orthonormal set.
    deviation = np.abs(overlap - _SQUARE_UNIT * np.eye(len(waves), dtype=object))
    tilt = Fraction(int(deviation.sum(axis=1).max()), _SQUARE_UNIT)
    # Units: those of the trial functions, twice, and those of the operator.
    unit = Fraction(1, _UNIT << (2 * _VECTOR_BITS))
    return _root_above(Fraction(total) * unit * unit / (1 - tilt))


def _inside(coupling: Exact, overlap: Exact) -> list[Ball]:
    """Enclose the eigenvalues of the operator within the span, rising."""
    ritz = [Fraction(c, o) for c, o in zip(coupling.diagonal(), overlap.diagonal(), strict=True)]
    if len(ritz) == 1:
        return [Ball(ritz[0] / _UNIT, Fraction(0))]
    # About their mean the values are small, and so are the errors of a rotation in doubles.
    mean = round(sum(ritz) / len(ritz))
    shifted = coupling - mean * overlap
    scale = int(np.abs(shifted).max()) or 1
    floats = np.array([[v / scale for v in row] for row in shifted])
    vectors = np.linalg.eigh(0.5 * (floats + floats.T))[1]
    turn = np.rint(vectors * 2.0**_TURN_BITS).astype(np.int64).astype(object)
    turned, metric = turn.T @ shifted @ turn, turn.T @ overlap @ turn
    values = [Fraction(c, o) for c, o in zip(turned.diagonal(), metric.diagonal(), strict=True)]
    # Off the diagonal, with the diagonal of the metric taken to 1.
    off, tilt = _off_norm(turned, metric), _off_norm(metric, metric)
    spread = max(abs(v) for v in values) + off
    # A thousandth more, for the fractions that bound something.
    radius = (off + tilt / (1 - tilt) * spread) * Fraction(1001, 1000)
    return [Ball((mean + value) / _UNIT, radius / _UNIT) for value in sorted(values)]


def _off_norm(matrix: Exact, metric: Exact) -> Fraction:
    """Bound the norm of what is off the diagonal after scaling the metric's diagonal to 1."""
    size = np.abs(matrix)
    rows = size.sum(axis=1) - size.diagonal()
    return Fraction(int(rows.max()), int(metric.diagonal().min()))


# ---------------------------------------------------------------- with damping


class DampedProblem:
    """The damped matrix in one of the two problems, without its mean, cut and uncut."""

    def __init__(self, f: PeriodicFunction, mu: float, k: float, coarse: Spectrum) -> None:
        from scipy.linalg import eig

        self.coarse, self.k = coarse, k
        odd, harmonic = coarse.odd, coarse.harmonic
        size = len(squares(odd, harmonic))
        reach = harmonic + max(1, f.harmonics)
        # The damping couples no harmonics to those beyond.
        wide = stacked(f, odd, reach, np.array([mu]), k)[0]
        self._low, self._across = wide[:size, :size].copy(), wide[:size, size:]
        # k^2 of the first harmonic beyond, and a bound of the norm of mu (f - mean).
        self._beyond = (harmonic + (0.5 if odd else 1.0)) ** 2
        self._bound = abs(mu) * float(f.amplitudes[1:].sum()) * (1.0 + 1e-12)
        self._right, self._left = HillOperator(f, mu, k), HillOperator(f, mu, -k)
        values, lefts, rights = eig(self._low, left=True, check_finite=False)
        self._real = [
            (float(values[i].real), rights[:, i].real, lefts[:, i].real)
            for i in np.flatnonzero(values.imag == 0.0)
        ]

    def ends(self, n: int) -> tuple[Ball | None, Ball] | bool | None:
        """Return the enclosed ends of region n; True where it is proved closed, None if undecided.

        Region n without damping stands at numbers n - 1 and n of the spectrum; with damping its
        ends are the real eigenvalues there, moved up by K^2: two or none (one in region 0).
        """
        values, reach, k = self.coarse.values, self.coarse.reach, self.k
        low, high = values[n - 1] if n else -inf, values[n]
        slack = reach + 1e-9 * (1.0 + abs(high))
        # Only the neighbours of the same problem matter: ends lie in regions of this problem alone.
        below = values[n - 2] + reach if n >= 2 else -inf
        above = values[n + 1] - reach
        balls = []
        for value, right, left in self._real:
            if not low - slack <= value - k * k <= high + slack:
                continue
            ball = self._eigenvalue(value, *(v / np.linalg.norm(v) for v in (right, left)))
            if ball is None:
                continue
            place = ball.middle - Fraction(k) ** 2
            inside = n < 2 or place - ball.radius > Fraction(below)
            if inside and place + ball.radius < Fraction(above):
                balls.append(ball)
        balls.sort(key=lambda ball: ball.middle)
        if n == 0:
            return (None, balls[0]) if len(balls) == 1 else None
        if len(balls) == 2:
            first, last = balls
            if first.middle + first.radius < last.middle - last.radius:
                return first, last
        bottom = low - reach + k * k * (1.0 - 1e-14)
        closed = not balls and self._has_none(bottom, high + reach + k * k * (1.0 + 1e-14))
        return True if closed else None

    def _inverse_norm(self, lam2: float, border: Array | None = None) -> float:
        """Bound the norm of the inverse of the whole operator less lam2; infinite if that fails."""
        # `border` joins one row and one column, (H - lam2) u - s border and border . u.
        size = len(self._low)
        matrix, across = self._low - lam2 * np.eye(size), self._across
        if border is not None:
            matrix = np.block([[matrix, -border[:, None]], [border[None], np.zeros((1, 1))]])
            across = np.vstack([across, np.zeros((1, across.shape[1]))])
        gap = self._beyond - lam2 - self._bound
        try:
            inverse = np.linalg.inv(matrix)
        except np.linalg.LinAlgError:
            return inf
        norm = float(np.linalg.norm(inverse))
        if not (gap > 0.0 and np.isfinite(norm)):
            return inf
        gamma = 1.01 * (size + 24) * _U
        weight = float(np.linalg.norm(matrix)) + sqrt(size) * (self._bound + abs(lam2))
        defect = float(np.linalg.norm(inverse @ matrix - np.eye(len(matrix))))
        defect += 3.0 * gamma * norm * weight
        if not defect < 0.5:
            return inf
        leaving = float(np.linalg.norm(inverse @ across))
        leaving += 2.0 * gamma * norm * self._bound * sqrt(size)
        share = leaving / (1.0 - defect) * self._bound / gap
        if not share < 0.9:
            return inf
        schur = norm / (1.0 - defect) / (1.0 - share)
        # A hair for the rounding of these few operations.
        return 1.001 * (schur * (1.0 + self._bound / gap) ** 2 + 1.0 / gap)

    def _eigenvalue(self, value: float, right: Array, left: Array) -> Ball | None:
        """Enclose a real eigenvalue from approximations of it and of its vectors, if that works."""
        norm = self._inverse_norm(value, right)
        if norm == inf:
            return None
        y, z = wave(self.coarse.odd, right), wave(self.coarse.odd, left)
        image = self._right(y)
        guess = round(Fraction(inner(y, image), inner(y, y)))
        # Rounding in the coefficients acts like a residual.
        rounding = self._right.doubt(image)
        size_y, size_z = _norm(y, _VECTOR_BITS), _norm(z, _VECTOR_BITS)
        residual = _size(_less(image, y, guess)) + rounding * size_y
        kappa = Fraction(norm)
        # The matrix was bounded at the value in doubles, with the vector in doubles.
        moved = abs(Fraction(guess, _UNIT) - Fraction(float(value))) + Fraction(1, 1 << 50)
        if kappa * moved >= Fraction(1, 2):
            return None
        kappa = kappa / (1 - kappa * moved)
        if 2 * kappa * kappa * residual >= 1:
            return None
        reach = 2 * kappa * residual
        other = _size(_less(self._left(z), z, guess)) + rounding * size_z
        product = inner(z, y)
        if not product:
            return None
        middle = Fraction(inner(z, image), product) / _UNIT
        error = (other + reach * size_z) * reach + rounding * size_y * size_z
        return Ball(middle, error / Fraction(abs(product), _SQUARE_UNIT))

    def _has_none(self, low: float, high: float) -> bool:
        """Prove that no eigenvalue lies between two numbers; False where that does not succeed."""
        pending = [(low, high)]
        # How often an interval is halved before a region counts as undecided.
        for _ in range(400):
            if not pending:
                return True
            start, end = pending.pop()
            middle = 0.5 * (start + end)
            half = 1.01 * max(end - middle, middle - start)
            norm = self._inverse_norm(middle)
            if norm == inf or (norm * half >= 1.0 and end - start < 1e-13 * (1.0 + abs(middle))):
                return False
            if norm * half >= 1.0:
                pending += [(start, middle), (middle, end)]
        return False
