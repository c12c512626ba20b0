"""Perturbation boundaries of Hill's equation to any order up to 8, with their error figures.

Smith 7.1.3, 7.1.4 and chapter 8.  Order 1 is (7.46), (7.49), order 2 the uniform form of (7.37).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import comb
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, provenance
from ..exact.matrix import Boundaries, check_regions
from ..half_trace import arguments, check_function
from ..transfer import EPS
from .effective import EffectiveOperator, effective_operator
from .orders import BEYOND, Components, Ends, series, uniform

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Form = Literal["uniform", "series"]

HIGHEST = 8
_FORMS: Mapping[str, Callable[[Components], Ends]] = {"uniform": uniform, "series": series}
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
    form : str
        ``"uniform"`` or ``"series"``.
    parameters : ndarray, shape (p, *mu.shape)
        Values of the parameters; ``mu`` is the first of them.
    outside : ndarray of bool, shape (len(regions), *mu.shape)
        True where the entry is flagged: the orders do not visibly converge there.
    closed : ndarray of bool, shape (len(regions), *mu.shape)
        True where the ends are NaN because damping closes the region.
    undecided : ndarray of bool, shape (len(regions), *mu.shape)
        True where open and closed are both within the error figure.
    """

    order: int
    form: str
    parameters: Array
    outside: Mask
    closed: Mask
    undecided: Mask

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **Boundaries.dimensions,
        "parameters": ("parameter", "mu"),
        "outside": ("region", "mu"),
        "closed": ("region", "mu"),
        "undecided": ("region", "mu"),
    }


def perturbation_boundaries(
    f: PeriodicFunction | Sequence[PeriodicFunction],
    mu: ArrayLike | Sequence[ArrayLike],
    regions: Sequence[int] = (1, 2),
    order: int = 1,
    damping: ArrayLike = 0.0,
    form: Form = "uniform",
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
    form : {"uniform", "series"}
        ``"uniform"``: ``lam2 = n^2/4 + Re A -+ sqrt(|B|^2 - (Im A)^2)`` with A and B to the
        order, which holds right through the tip of a damped tongue and where c_n vanishes.
        ``"series"``: the root is expanded as well, ``n^2/4 + alpha_1 mu + alpha_2 mu^2 ...``.
    outside : {"nan", "value"}
        What stands where the orders do not visibly converge: NaN, or the number all the same,
        with an infinite error figure.

    Returns
    -------
    PerturbationBoundaries
        ``lower``, ``upper`` and ``error`` of shape ``(len(regions), *shape)``, where shape is
        the broadcast shape of the parameters and damping.  NaN where damping closes the region
        (``closed``) and where the entry is flagged (``outside``); ``undecided`` where the figure
        cannot tell open from closed.  Checks: the largest error over half the width that the
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
    recursion (:mod:`.effective`).  The error figure is made of the two orders that follow, of a
    geometric remainder at the ratio at which the orders are seen to fall, of round-off and of the
    error of f, all carried through the square root.  An entry is flagged where that ratio, with a
    margin of a quarter, reaches 0.9, or the figure half the distance to the neighbouring level of
    the same period.
    """
    functions, values = parameters_of(f, mu)
    numbers = check_regions(regions)
    check_order(order)
    _check_options(form, outside)
    amps, k, shape = amplitudes_of(values, damping)
    flat = np.stack([np.broadcast_to(item, shape).ravel() for item in (*amps, k)])
    work = _Work(functions, flat, int(order), form)
    count = flat.shape[1]
    lower, upper, error = np.empty((3, len(numbers), count))
    flagged, closed, undecided = np.empty((3, len(numbers), count), dtype=bool)
    share = 0.0
    with np.errstate(all="ignore"):
        for i, n in enumerate(numbers):
            rows = _Rows(lower[i], upper[i], error[i], flagged[i], closed[i], undecided[i])
            share = max(share, work.region(n, rows, outside))
    full = (len(numbers), *shape)
    points = flat.reshape(len(flat), *shape)
    return PerturbationBoundaries(
        method=f"perturbation, order {order}, {form}",
        error=error.reshape(full),
        error_norm="absolute, entrywise, for either end",
        checks=_checks(share, flagged),
        provenance=provenance(),
        lower=lower.reshape(full),
        upper=upper.reshape(full),
        regions=numbers,
        mu=np.asarray(points[0]),
        damping=np.asarray(points[-1]),
        order=int(order),
        form=form,
        parameters=points[:-1],
        outside=flagged.reshape(full),
        closed=closed.reshape(full),
        undecided=undecided.reshape(full),
    )


@dataclass(frozen=True)
class _Rows:
    """Where the entries of one region go, each ``(n,)``."""

    lower: Array
    upper: Array
    error: Array
    outside: Mask
    closed: Mask
    undecided: Mask

    def put(self, part: slice, n: int, ends: Ends, outside: str) -> None:
        """Write what was found at some points."""
        half, error = ends.half, ends.error
        if ends.outside.any():
            if outside == "nan":
                half = np.where(ends.outside, np.nan, half)
            error = np.where(ends.outside, np.inf, error)
        np.add(ends.centre, half, out=self.upper[part])
        self.lower[part] = ends.centre - half if n else -np.inf
        self.error[part] = error
        self.outside[part], self.undecided[part] = ends.outside, ends.undecided
        gone = np.isnan(self.upper[part])
        if gone.any():
            self.error[part][gone] = np.nan
            self.lower[part][gone] = np.nan
        self.closed[part] = gone & ~ends.outside


class _Work:
    """The points of one call, ``(p + 1, n)`` with K last, and what all regions share."""

    def __init__(
        self, functions: tuple[PeriodicFunction, ...], points: Array, order: int, form: str
    ) -> None:
        self.order, self.form = order, form
        self.damped = bool(np.any(points[-1] > 0.0))
        functions, points = _joined(functions, points)
        size = np.abs(points[:-1])
        bounds = np.array([[item.bound()] for item in functions])
        errors = np.array([[item.error] for item in functions])
        means = np.array([[abs(item.mean)] for item in functions])
        with np.errstate(over="ignore"):
            self.reach = (bounds * size).sum(axis=0)
            self.strength = ((bounds - means) * size).sum(axis=0)
            self.data = (errors * size).sum(axis=0)
        self.functions, self.points = functions, points

    def operator(self, n: int) -> EffectiveOperator:
        """Return the effective operator of region n, or refuse where it would be too large."""
        order, count = self.order + BEYOND, len(self.functions) + self.damped
        harmonics = max(item.harmonics for item in self.functions)
        size = comb(order + count - 1, count - 1) * (order * harmonics + n + 1)
        if size > _MOST_COEFFICIENTS:
            raise bad(
                "perturbation_boundaries",
                f"order {self.order}, {harmonics} harmonics, {count} parameters",
                f"at most {_MOST_COEFFICIENTS} coefficients ({size} would be needed)",
                "truncate the functions, lower the order or combine the parameters",
            )
        return effective_operator(self.functions, n, order, self.damped)

    def region(self, n: int, rows: _Rows, outside: str) -> float:
        """Fill the rows of one region; return the largest share of error over half width."""
        operator = self.operator(n)
        share = 0.0
        for start in range(0, self.points.shape[1], _CHUNK):
            part = slice(start, start + _CHUNK)
            ends, split = self._ends(operator, part)
            rows.put(part, n, ends, outside)
            share = max(share, split)
        return share

    def _ends(self, operator: EffectiveOperator, part: slice) -> tuple[Ends, float]:
        points = self.points[:, part] if self.damped else self.points[:-1, part]
        k, n = self.points[-1, part], operator.n
        if not np.all(np.isfinite(points)):
            raise bad("mu", "an entry that is not finite", "finite numbers", "correct the input")
        a, b = operator.components(points)
        noise = 4.0 * EPS * (0.25 * n * n + self.reach[part] + n * k) + self.data[part]
        strength = self.strength[part] + 2.0 * k * (n + 1)
        parts = Components(n, self.order, a, b, noise, strength, k > 0.0)
        ends = _FORMS[self.form](parts)
        split = np.abs(b[: self.order].sum(axis=0))
        wide = (split > noise) & ~ends.outside & np.isfinite(ends.half)
        shares = np.where(wide, ends.error / split, 0.0)
        return ends, float(shares.max(initial=0.0)) if n else 0.0


def _joined(
    functions: tuple[PeriodicFunction, ...], points: Array
) -> tuple[tuple[PeriodicFunction, ...], Array]:
    """Make one function with one parameter of several parameters at a single point."""
    if len(functions) == 1 or points.shape[1] != 1:
        return functions, points
    largest = max(item.bound() * abs(v) for item, v in zip(functions, points[:-1, 0], strict=True))
    if not largest < 1e100:
        return functions, points
    return (combined(functions, points[:-1, 0]),), np.stack([np.ones(1), points[-1]])


def combined(functions: tuple[PeriodicFunction, ...], values: Array) -> PeriodicFunction:
    """Return the sum of functions times their parameters, with the rounding in its error."""
    parts = [item * float(v) for item, v in zip(functions, values, strict=True)]
    if len(parts) == 1:
        return parts[0]
    whole = sum(parts[1:], parts[0])
    # The parts may cancel: their rounding is an error of what is left.
    rounding = EPS * sum(item.bound() for item in parts)
    return PeriodicFunction(whole.a, whole.b, whole.error + rounding)


def _checks(share: float, flagged: Mask) -> dict[str, Check]:
    """Return the largest error figure over half the undamped width, and what is flagged."""
    checks = {"entries outside the estimated range": Check(float(np.count_nonzero(flagged)), 0.0)}
    if share > 0.0:
        checks["error over half the width"] = Check(share, 1.0)
    return checks


def parameters_of(
    f: PeriodicFunction | Sequence[PeriodicFunction], mu: ArrayLike | Sequence[ArrayLike]
) -> tuple[tuple[PeriodicFunction, ...], tuple[ArrayLike, ...]]:
    """Return functions and the values of their parameters, one each."""
    if isinstance(f, PeriodicFunction):
        return (f,), (mu,)  # type: ignore[return-value]
    if not isinstance(f, Sequence) or not f:
        check_function(f)
    functions = tuple(f)
    for item in functions:
        check_function(item)
    if not isinstance(mu, Sequence | np.ndarray) or len(mu) != len(functions):
        raise bad(
            "mu",
            f"{len(mu)} entries" if isinstance(mu, Sequence | np.ndarray) else "one number",
            f"one entry for each of the {len(functions)} functions",
            "pass mu=[eps_1, eps_2, ...]",
        )
    return functions, tuple(mu)


def amplitudes_of(
    values: tuple[ArrayLike, ...], damping: ArrayLike
) -> tuple[list[Array], Array, tuple[int, ...]]:
    """Return the parameters as arrays, the damping, and the shape that they broadcast to."""
    named = {f"mu[{i}]" if len(values) > 1 else "mu": v for i, v in enumerate(values)}
    (*amps, k), shape = arguments(**named, damping=damping)
    return amps, k, shape


def check_order(order: object) -> None:
    """Refuse an order that is not a whole number from 1 to 8."""
    if not is_whole(order, 1, HIGHEST):
        raise bad(
            "order",
            repr(order),
            f"a whole number from 1 to {HIGHEST}",
            "use hill_boundaries for the exact boundaries",
        )


def _check_options(form: object, outside: object) -> None:
    if not isinstance(form, str) or form not in _FORMS:
        raise bad("form", repr(form), "'uniform' or 'series'", "choose one")
    if outside not in ("nan", "value"):
        raise bad("outside", repr(outside), "'nan' or 'value'", "choose one")
