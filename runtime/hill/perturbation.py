"""Perturbation boundaries of Hill's equation to any order up to 8, with error estimates.

Smith 7.1.3, 7.1.4 and chapter 8.  With A and B of the effective operator (:mod:`.bloch`) summed up
to the order N, ``lam2 = n^2/4 + Re A -+ sqrt(S)`` and ``S = |B|^2 - (Im A)^2``: order 1 is (7.46),
(7.49), order 2 the uniform form of (7.37).  The two orders beyond are known as well; they, and the
ratio at which the components fall, show what is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad, shown
from ..core.inputs import is_one_of, require_whole
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check, provenance
from .bloch import BEYOND, HIGHEST, EffectiveOperator, effective_operator, level_distance
from .boundaries import Boundaries
from .checks import EPS, Array, Complex, Mask, check_function, check_regions, points

# The series is taken to converge while its components fall at least so fast from one to the next,
# and while what is left out stays below this share of the distance to the next level.
CONTRACTION, _SHARE = 0.9, 0.5
# Factor on the two orders beyond: their sum is the larger part of what is left out.
_DOUBT = 2.0
# Points at a time, so that the components stay in the cache.
_CHUNK = 2**13
# Largest number of coefficients of the highest order: about a second of work.
_MOST_COEFFICIENTS = 2_000_000


@dataclass(frozen=True, kw_only=True)
class PerturbationBoundaries(Boundaries):
    """Boundaries of unstable regions to some order in the parameters.

    Attributes
    ----------
    order : int
        Highest total degree kept; K counts as a parameter of the first order.
    parameters : ndarray, shape ``(p, *mu.shape)``
        Values of the parameters; ``mu`` is the first of them.
    outside : ndarray of bool, shape ``(len(regions), *mu.shape)``
        True where the entry is flagged: the orders do not visibly converge there.
    closed : ndarray of bool, shape ``(len(regions), *mu.shape)``
        True where the ends are NaN because damping closes the region.
    undecided : ndarray of bool, shape ``(len(regions), *mu.shape)``
        True where open and closed are both within the error.
    """

    order: int
    parameters: Array
    outside: Mask
    closed: Mask
    undecided: Mask

    arrays_along: ClassVar = {"parameter mu": "parameters", "region mu": "outside closed undecided"}


def perturbation_boundaries(
    f: PeriodicFunction | Sequence[PeriodicFunction],
    mu: ArrayLike | Sequence[ArrayLike],
    regions: Sequence[int] = (1, 2),
    order: int = 1,
    damping: ArrayLike = 0.0,
    outside: Literal["nan", "value"] = "nan",
) -> PerturbationBoundaries:
    """Return the boundaries of unstable regions to an order in the parameters (and K).

    The equation is ``y'' + 2 K y' + (lam2 + mu f) y = 0``, or with several parameters
    ``y'' + 2 K y' + (lam2 + sum_k mu[k] f[k]) y = 0``.

    Parameters
    ----------
    f : PeriodicFunction or sequence of PeriodicFunction
        Coefficient of period 2 pi, or one for each parameter.
    mu : array_like or sequence of array_like
        Any shape, any sign; with several functions one entry for each, which broadcast.
    regions : sequence of int
        Numbers n >= 0; region 0 has ``lower`` = -inf.
    order : int
        1 to 8: highest total degree in the parameters and K that is kept.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with mu.
    outside : {"nan", "value"}
        What stands where the orders do not visibly converge: NaN, or the number all the same,
        with an infinite error.

    Returns
    -------
    PerturbationBoundaries
        ``lower``, ``upper`` and ``error`` of shape ``(len(regions), *shape)``, where shape is
        the broadcast shape of the parameters and damping.  NaN where damping closes the region
        (``closed``) and where the entry is flagged (``outside``); ``undecided`` where the error
        covers both open and closed.  Checks: the largest error over half the width that the
        region has without drag, and the number of flagged entries.

    Raises
    ------
    BadInput
        If an argument is not finite, a region is not a whole number >= 0, K is negative, the
        order is not 1 to 8, functions and parameters do not match, or the coefficients to the
        order would be too many to hold.

    Notes
    -----
    Smith (7.23)-(7.25), (7.35), (7.37), (7.46)-(7.50), (8.39)-(8.43), to any order by Bloch's
    recursion (:mod:`.bloch`): ``lam2 = n^2/4 + Re A -+ sqrt(|B|^2 - (Im A)^2)`` with A and B to the
    order, which holds right through the tip of a damped tongue and where c_n vanishes, unlike the
    power series of the root (:func:`.boundary_series`).  The error is made of the two orders that
    follow, of a geometric remainder at the ratio at which the orders are seen to fall, of round-off
    and of the error of f, all carried through the square root.  An entry is flagged where that
    ratio, with a margin of a quarter, reaches 0.9, or the error half the distance to the
    neighbouring level of the same period.

    Examples
    --------
    >>> import elastolink as el
    >>> cosine = el.PeriodicFunction(a=[0.0, 1.0])
    >>> found = el.perturbation_boundaries(cosine, mu=0.1, regions=(1, 2), order=4)
    >>> print(found.lower.round(6), found.upper.round(6))
    [0.198781 0.999167] [0.298718 1.004145]
    """
    functions, flat, shape = parameters_of(f, mu, damping)
    numbers = check_regions(regions)
    check_order(order)
    if not is_one_of(outside, ("nan", "value")):
        raise bad("outside", shown(outside), "'nan' or 'value'", "choose one")
    size = (3, len(numbers), flat.shape[1])
    found, flags, share = np.empty(size), np.empty(size, dtype=bool), 0.0
    with np.errstate(all="ignore"):
        problem = _Points(functions, flat, int(order))
        for i, n in enumerate(numbers):
            operator = problem.operator(n)
            for start in range(0, size[2], _CHUNK):
                part = slice(start, start + _CHUNK)
                ends, split = problem.ends(operator, part)
                share = max(share, split)
                half = np.where(ends.outside, np.nan, ends.half) if outside == "nan" else ends.half
                gone = np.isnan(ends.centre + half)
                low = ends.centre - half if n else np.where(gone, np.nan, -np.inf)
                error = np.where(ends.outside, np.inf, ends.error)
                found[:, i, part] = low, ends.centre + half, np.where(gone, np.nan, error)
                flags[:, i, part] = ends.outside, gone & ~ends.outside, ends.undecided
    lower, upper, error = found.reshape(3, len(numbers), *shape)
    flagged, closed, undecided = flags.reshape(3, len(numbers), *shape)
    checks = {"entries outside the estimated range": Check(float(np.count_nonzero(flagged)), 0.0)}
    if share > 0.0:
        checks["error over half the width"] = Check(share, 1.0)
    at = flat.reshape(len(flat), *shape)
    return PerturbationBoundaries(
        method=f"perturbation, order {order}",
        error=error,
        error_norm="absolute, entrywise, for either end",
        checks=checks,
        provenance=provenance(),
        lower=lower,
        upper=upper,
        regions=numbers,
        mu=np.asarray(at[0]),
        damping=np.asarray(at[-1]),
        order=int(order),
        parameters=at[:-1],
        outside=flagged,
        closed=closed,
        undecided=undecided,
    )


def check_order(order: object) -> None:
    """Refuse an order that is not a whole number from 1 to 8."""
    require_whole("order", order, 1, HIGHEST, "use hill_boundaries for the exact boundaries")


def parameters_of(
    f: PeriodicFunction | Sequence[PeriodicFunction],
    mu: ArrayLike | Sequence[ArrayLike],
    damping: ArrayLike,
) -> tuple[tuple[PeriodicFunction, ...], Array, tuple[int, ...]]:
    """Return the functions, their parameters with K last at all points, and the shape of these."""
    if isinstance(f, PeriodicFunction):
        flat, shape = points(mu=mu, damping=damping)  # type: ignore[arg-type]
        return (f,), np.stack(flat), shape
    if not isinstance(f, Sequence) or not f:
        check_function(f)
    functions = tuple(check_function(item) for item in f)
    if not isinstance(mu, Sequence | np.ndarray) or len(mu) != len(functions):
        found = f"{len(mu)} entries" if isinstance(mu, Sequence | np.ndarray) else "one number"
        expected = f"one entry for each of the {len(functions)} functions"
        raise bad("mu", found, expected, "pass mu=[eps_1, eps_2, ...]")
    named = {f"mu[{i}]" if len(mu) > 1 else "mu": value for i, value in enumerate(mu)}
    flat, shape = points(**named, damping=damping)
    return functions, np.stack(flat), shape


def combined(functions: tuple[PeriodicFunction, ...], values: Array) -> PeriodicFunction:
    """Return the sum of functions times their parameters, with the rounding in its error."""
    parts = [item * float(v) for item, v in zip(functions, values, strict=True)]
    if len(parts) == 1:
        return parts[0]
    whole = sum(parts[1:], parts[0])
    # The parts may cancel: their rounding is an error of what is left.
    rounding = EPS * sum(item.bound() for item in parts)
    return PeriodicFunction(whole.a, whole.b, whole.error + rounding)


class _Points:
    """The points of one call, ``(p + 1, n)`` with K last, and what all regions share."""

    def __init__(self, functions: tuple[PeriodicFunction, ...], points: Array, order: int) -> None:
        self.order = order
        self.damped = bool(np.any(points[-1] > 0.0))
        if len(functions) > 1 and points.shape[1] == 1:
            # Several parameters at a single point are one.
            sizes = [
                item.bound() * abs(v) for item, v in zip(functions, points[:-1, 0], strict=True)
            ]
            if max(sizes) < 1e100:
                functions = (combined(functions, points[:-1, 0]),)
                points = np.stack([np.ones(1), points[-1]])
        size = np.abs(points[:-1])
        self.reach = np.array([part.bound() for part in functions]) @ size
        self.strength = np.array([part.bound() - abs(part.mean) for part in functions]) @ size
        self.data = np.array([part.error for part in functions]) @ size
        self.functions, self.points = functions, points

    def operator(self, n: int) -> EffectiveOperator:
        """Return the effective operator of region n, or refuse where it would be too large."""
        order, count = self.order + BEYOND, len(self.functions) + self.damped
        harmonics = max(item.harmonics for item in self.functions)
        size = comb(order + count - 1, count - 1) * (order * harmonics + n + 1)
        if size > _MOST_COEFFICIENTS:
            found = f"order {self.order}, {harmonics} harmonics, {count} parameters"
            expected = f"at most {_MOST_COEFFICIENTS} coefficients ({size} would be needed)"
            fix = "truncate the functions, lower the order or combine the parameters"
            raise bad("perturbation_boundaries", found, expected, fix)
        return effective_operator(self.functions, n, order, self.damped)

    def ends(self, operator: EffectiveOperator, part: slice) -> tuple[SeriesEnds, float]:
        """Return the ends at some points, and the largest share of the error in half the width."""
        points = self.points[:, part] if self.damped else self.points[:-1, part]
        k, n = self.points[-1, part], operator.n
        if not np.all(np.isfinite(points)):
            raise bad("mu", "an entry that is not finite", "finite numbers", "correct the input")
        a, b = operator.components(points)
        noise = 4.0 * EPS * (0.25 * n * n + self.reach[part] + n * k) + self.data[part]
        strength = self.strength[part] + 2.0 * k * (n + 1)
        sums = Sums.of(n, self.order, a, b, noise, strength)
        ends = sums.ends(k > 0.0)
        wide = (sums.split > noise) & ~ends.outside & np.isfinite(ends.half)
        shares = np.where(wide, ends.error / sums.split, 0.0)
        return ends, float(shares.max(initial=0.0)) if n else 0.0


# ---------------------------------------------------------------- from components to ends


class SeriesEnds(NamedTuple):
    """Ends of one region at points ``(n,)``."""

    centre: Array  # real part of the diagonal, n^2/4 included
    half: Array  # half the width; NaN where damping closes the region
    error: Array  # estimate of the absolute error of ``centre - half`` and ``centre + half``
    outside: Mask  # where the series does not converge visibly: ``error`` means nothing there
    undecided: Mask  # where open and closed are both within what is left out


class Sums(NamedTuple):
    """Sums of the components to the order, and estimates of what is left out of them."""

    region: int
    centre: Array  # ``n^2/4 + Re A``
    drag: Array  # ``|Im A|``
    split: Array  # ``|B|``
    moved: Array  # error of Re A
    turned: Array  # error of Im A
    spread: Array  # error of B
    ratio: Array  # at which the components fall, with its margin

    @classmethod
    def of(cls, n: int, order: int, a: Complex, b: Complex, noise: Array, strength: Array) -> Sums:
        """Sum up A and B of region n from their components ``(N + 2, n)``.

        ``noise`` is their error from round-off and from the data, ``strength`` a majorant of the
        periodic part and the drag.
        """
        distance, sizes = level_distance(n), np.abs(a) + np.abs(b)
        # The real part of the first one is the shift by the mean, which is exact.
        sizes[0] = np.abs(a[0].imag) + np.abs(b[0])
        # The observed ratio is that of few orders: the ratio of those to come may be larger.
        ratio = 1.25 * contraction(sizes, distance)
        # Orders of one parity say nothing of the other: a step of V and R at its largest does.
        step = np.minimum(2.0 * strength / distance, 0.2)
        rest = _geometric(sizes, np.maximum(ratio, step)) + noise
        moved = _DOUBT * np.abs(a[order:].real).sum(axis=0) + rest
        turned = _DOUBT * np.abs(a[order:].imag).sum(axis=0) + rest
        spread = _DOUBT * np.abs(b[order:]).sum(axis=0) + rest
        centre = 0.25 * n**2 + a[:order].real.sum(axis=0)
        drag, split = np.abs(a[:order].imag.sum(axis=0)), np.abs(b[:order].sum(axis=0))
        return cls(n, centre, drag, split, moved, turned, spread, ratio)

    def ends(self, damped: Mask) -> SeriesEnds:
        """Return the ends, right through the tip of a tongue; only where damped may one close."""
        half, error = np.zeros_like(self.centre), self.moved
        undecided = np.zeros(half.shape, dtype=bool)
        if self.region:
            square = _square(self.split, self.drag)
            least = _square(np.maximum(self.split - self.spread, 0.0), self.drag + self.turned)
            most = _square(self.split + self.spread, np.maximum(self.drag - self.turned, 0.0))
            inner, half, outer = (np.sqrt(np.maximum(s, 0.0)) for s in (least, square, most))
            error = self.moved + np.maximum(outer - half, half - inner)
            half[damped & (square < 0.0)] = np.nan
            undecided = damped & (least < 0.0) & (most >= 0.0)
        inside = (self.ratio < CONTRACTION) & (error < _SHARE * level_distance(self.region))
        inside &= np.isfinite(self.centre)
        return SeriesEnds(self.centre, half, error, ~inside, undecided & inside)


def _square(split: Array, drag: Array) -> Array:
    """Return ``S = |B|^2 - (Im A)^2`` as a product: nothing cancels beyond the data."""
    return (split - drag) * (split + drag)


def contraction(sizes: Array, reference: Array | float) -> Array:
    """Return the ratio at which components fall, from their sizes ``(M, n)``.

    The larger of two measures, each of which takes the last two components together since every
    other one may vanish: the roots of their ratios to a ``reference`` of order zero, and the root
    of their ratio to the two before.
    """
    count = len(sizes)
    ratio: Array = np.zeros(sizes.shape[1:])
    for k in (count - 1, count):
        ratio = np.maximum(ratio, (sizes[k - 1] / reference) ** (1.0 / k))
    last = np.maximum(sizes[-1], sizes[-2])
    before = np.maximum(sizes[-3], sizes[-4] if count > 3 else reference)
    return np.asarray(np.maximum(ratio, np.sqrt(last / np.maximum(before, np.finfo(float).tiny))))


def _geometric(sizes: Array, ratio: Array) -> Array:
    """Return the sum of what follows the last component at a ratio, infinite from 1 on."""
    # The last two may both be small by chance: those before them count as well.
    last = np.maximum(sizes[-1], sizes[-2])
    for k in range(3, min(len(sizes), 4) + 1):
        last = np.maximum(last, sizes[-k] * ratio ** (k - 1))
    below = np.minimum(ratio, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(last > 0.0, _DOUBT * last * below / (1.0 - below), 0.0))
