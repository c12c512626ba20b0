"""Ends of a region from the components of its effective operator, with what the orders leave out.

``lam2 = n^2/4 + Re A -+ sqrt(S)`` with ``S = |B|^2 - (Im A)^2``, A and B summed up to the order N.
The two orders beyond are known as well; they, and the ratio at which the components fall, tell
what is left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Mask = NDArray[np.bool_]

# How many orders beyond the wanted one are computed for the estimate.
BEYOND = 2
# The series is taken to converge while its components fall at least so fast from one to the next.
CONTRACTION = 0.9
# ... and while what is left out stays below this share of the distance to the next level.
_SHARE = 0.5
# The observed ratio is that of few orders: the ratio of those to come may be larger.
_CAUTION = 1.25
# Factor on the two orders beyond: their sum is the larger part of what is left out.
_DOUBT = 2.0
# A coupling below so much of the largest that it could be is taken for round-off of zero.
_CANCELLED = 1e-14


@dataclass(frozen=True)
class Ends:
    """Ends of one region at points ``(n,)``.

    Attributes
    ----------
    centre, half : ndarray
        Real part of the diagonal (n^2/4 included) and half the width; ``half`` is NaN where
        damping closes the region.
    error : ndarray
        Estimate of the absolute error of ``centre - half`` and ``centre + half``.
    outside : ndarray of bool
        True where the series does not converge visibly, so that ``error`` means nothing.
    undecided : ndarray of bool
        True where open and closed are both within what is left out.
    """

    centre: Array
    half: Array
    error: Array
    outside: Mask
    undecided: Mask


@dataclass(frozen=True)
class Components:
    """Components of A and B at points, and what is known about their errors.

    Attributes
    ----------
    region, order : int
        Numbers n and N.
    diagonal, coupling : ndarray, shape (N + 2, n), complex
        ``A_k`` and ``B_k``; the real part of ``A_1`` is the shift ``-mean``, which is exact.
    noise : ndarray, shape (n,)
        Error of A and B from round-off and from the data.
    strength : ndarray, shape (n,)
        Majorant of the periodic part and the drag.
    damped : ndarray of bool, shape (n,)
        Where K > 0: there alone may a region be closed.
    """

    region: int
    order: int
    diagonal: Complex
    coupling: Complex
    noise: Array
    strength: Array
    damped: Mask

    @property
    def distance(self) -> float:
        """Distance of the resonant level from the nearest one of the same period."""
        return float({0: 1, 1: 2}.get(self.region, self.region - 1))


def contraction(sizes: Array, reference: Array | float) -> Array:
    """Return the ratio at which components fall, from their sizes ``(M, n)``.

    The larger of two measures, each of which takes the last two components together since every
    other one may vanish: the roots of their ratios to a ``reference`` of order zero, and the root
    of their ratio to the two before.
    """
    count = len(sizes)
    tiny = np.finfo(float).tiny
    found: Array = np.zeros(sizes.shape[1:])
    for k in (count - 1, count):
        found = np.maximum(found, (sizes[k - 1] / reference) ** (1.0 / k))
    last = np.maximum(sizes[-1], sizes[-2])
    before = np.maximum(sizes[-3], sizes[-4] if count > 3 else reference)
    return np.asarray(np.maximum(found, np.sqrt(last / np.maximum(before, tiny))))


def uniform(parts: Components) -> Ends:
    """Return the ends from the sums of A and B themselves, right through the tip of a tongue."""
    known = Sums.of(parts)
    if parts.region == 0:
        return _judged(parts, known, np.zeros_like(known.centre), known.moved, known.ratio)
    half, figure = known.root()
    half[parts.damped & (known.square < 0.0)] = np.nan
    return _judged(parts, known, half, known.moved + figure, known.ratio)


def series(parts: Components) -> Ends:
    """Return the ends from the root of S expanded along the ray of the parameters.

    Smith's alpha_1, alpha_2, ...; S begins with the degree 2 s, and the expansion fails where that
    first component is not the dominant one: near the tip of a damped tongue, and where c_n almost
    vanishes.
    """
    order, count = parts.order, len(parts.diagonal)
    known = Sums.of(parts)
    left, ratio = np.zeros_like(known.centre), known.ratio.copy()
    half = np.zeros_like(known.centre)
    leading = _leading(parts) if parts.region else np.full(half.shape, count + 1)
    for s in range(1, count + 1):
        here = leading == s
        if not here.any():
            continue
        # A slice costs no copy.
        these = slice(None) if here.all() else here
        roots, sign, ripple = root_components(
            parts.diagonal[:, these].imag, parts.coupling[:, these], s
        )
        kept = max(order - s + 1, 0)
        terms = np.abs(roots)
        own = _CAUTION * _root_ratio(terms)
        beyond = _DOUBT * terms[kept:].sum(axis=0) + _geometric(terms, own)
        left[these] = beyond + ripple * parts.noise[these]
        total = np.asarray(roots[:kept].sum(axis=0))
        half[these] = np.where((sign < 0.0) & (kept > 0), np.nan, total)
        ratio[these] = np.maximum(ratio[these], own)
    # The first component decides by its sign; where the sums are sure of the opposite it misleads.
    misled = parts.damped & np.where(np.isnan(half), known.fewest > 0.0, known.most < 0.0)
    ratio[misled] = np.inf
    if parts.region:
        # The uniform form is at hand: what lies between the two, and its own figure.
        other, figure = known.root()
        left = np.maximum(left, np.abs(np.nan_to_num(half) - other) + figure)
    return _judged(parts, known, half, known.moved + left, ratio)


@dataclass(frozen=True)
class Sums:
    """Sums of the components to the order, and what is left out of them.

    Attributes
    ----------
    centre : ndarray, shape (n,)
        ``n^2/4 + Re A``.
    drag, split : ndarray
        ``|Im A|`` and ``|B|``.
    moved, turned, spread : ndarray
        Estimates of the errors of ``Re A``, ``Im A`` and ``B``.
    ratio : ndarray
        Ratio at which the components fall, with its margin.
    """

    centre: Array
    drag: Array
    split: Array
    moved: Array
    turned: Array
    spread: Array
    ratio: Array

    @property
    def square(self) -> Array:
        """``S = |B|^2 - (Im A)^2``; as a product, so that nothing cancels beyond the data."""
        return (self.split - self.drag) * (self.split + self.drag)

    @property
    def fewest(self) -> Array:
        """The least that S may be."""
        low, high = np.maximum(self.split - self.spread, 0.0), self.drag + self.turned
        return np.asarray((low - high) * (low + high))

    @property
    def most(self) -> Array:
        """The most that S may be."""
        high, low = self.split + self.spread, np.maximum(self.drag - self.turned, 0.0)
        return np.asarray((high - low) * (high + low))

    def root(self) -> tuple[Array, Array]:
        """Return the root of S, 0 where that is negative, and the figure of its error."""
        half = np.sqrt(np.maximum(self.square, 0.0))
        outer = np.sqrt(np.maximum(self.most, 0.0)) - half
        inner = half - np.sqrt(np.maximum(self.fewest, 0.0))
        return half, np.maximum(outer, inner)

    @classmethod
    def of(cls, parts: Components) -> Sums:
        """Sum up."""
        order, a, b = parts.order, parts.diagonal, parts.coupling
        sizes = np.abs(a) + np.abs(b)
        sizes[0] = np.abs(a[0].imag) + np.abs(b[0])
        ratio = _CAUTION * contraction(sizes, parts.distance)
        # Orders of one parity tell nothing of the other: a step of V and R at its largest does.
        step = np.minimum(2.0 * parts.strength / parts.distance, 0.2)
        rest = _geometric(sizes, np.maximum(ratio, step)) + parts.noise
        moved = _DOUBT * np.abs(a[order:].real).sum(axis=0) + rest
        turned = _DOUBT * np.abs(a[order:].imag).sum(axis=0) + rest
        spread = _DOUBT * np.abs(b[order:]).sum(axis=0) + rest
        centre = 0.25 * parts.region**2 + a[:order].real.sum(axis=0)
        drag, split = np.abs(a[:order].imag.sum(axis=0)), np.abs(b[:order].sum(axis=0))
        return cls(centre, drag, split, moved, turned, spread, ratio)


def _leading(parts: Components) -> NDArray[np.intp]:
    """Return the degree s at which S begins, one more than there are where it vanishes."""
    b, drag = np.abs(parts.coupling), np.abs(parts.diagonal.imag)
    share = parts.strength / parts.distance
    floor = np.empty_like(b)
    floor[0] = 0.0
    for k in range(1, len(b)):
        floor[k] = _CANCELLED * parts.strength * share**k
    # Without damping Im A is of higher order than B.
    there = (b > floor) | ((drag > floor) & parts.damped)
    return np.where(there.any(axis=0), there.argmax(axis=0) + 1, len(b) + 1)


def root_components(drag: Array, coupling: Complex, s: int) -> tuple[Array, Array, Array]:
    """Return the components s ... M of the root of +-S, that sign, and what magnifies errors."""
    count, first = len(drag) - s + 1, s - 1
    scale = np.abs(coupling[first]) + np.abs(drag[first])
    # A power of two, so that squares stay within the range of doubles and no digit changes.
    unit = np.ldexp(1.0, np.frexp(scale)[1])
    real, imaginary, drag = coupling.real / unit, coupling.imag / unit, drag / unit
    squares = np.zeros((count, drag.shape[1]))
    for j in range(count):
        for i in range(first, first + j // 2 + 1):
            other = 2 * first + j - i
            product = real[i] * real[other] + imaginary[i] * imaginary[other]
            product -= drag[i] * drag[other]
            squares[j] += product if i == other else 2.0 * product
    # The root of a negative first component is imaginary, and with it all the others.
    sign = np.sign(squares[0])
    out = np.zeros(squares.shape)
    out[0] = np.sqrt(np.abs(squares[0]))
    for j in range(1, count):
        inner = sum((out[i] * out[j - i] for i in range(1, j)), np.zeros(drag.shape[1]))
        out[j] = (sign * squares[j] - inner) / (2.0 * out[0])
    return out * unit, sign, np.asarray(scale / unit / out[0])


def _root_ratio(terms: Array) -> Array:
    """Return the ratio at which the components of the root fall, relative to its first one."""
    first = np.maximum(terms[0], np.finfo(float).tiny)
    found: Array = np.zeros(terms.shape[1:])
    for k in {1, len(terms) - 2, len(terms) - 1} & set(range(1, len(terms))):
        share = terms[k] / first
        found = np.maximum(found, share if k == 1 else share ** (1.0 / k))
    return found


def _geometric(sizes: Array, ratio: Array) -> Array:
    """Return the sum of what follows the last component at a ratio, infinite from 1 on."""
    # The last two may both be small by chance: those before them tell as well.
    last = sizes[-1]
    for k in range(2, min(len(sizes), 4) + 1):
        last = np.maximum(last, sizes[-k] if k == 2 else sizes[-k] * ratio ** (k - 1))
    below = np.minimum(ratio, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(last > 0.0, _DOUBT * last * below / (1.0 - below), 0.0))


def _judged(parts: Components, known: Sums, half: Array, error: Array, ratio: Array) -> Ends:
    inside = (ratio < CONTRACTION) & (error < _SHARE * parts.distance)
    inside &= np.isfinite(known.centre)
    undecided = inside & parts.damped & (known.fewest < 0.0) & (known.most >= 0.0)
    if parts.region == 0:
        undecided = np.zeros(half.shape, dtype=bool)
    return Ends(known.centre, half, error, ~inside, undecided)
