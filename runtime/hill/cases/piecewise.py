"""Hill's equation with a piecewise constant coefficient (Meissner; Hsu and Pipes): exact matrices.

On an interval of constant q the equation y'' + 2 K y' + q y = 0 is solved in closed form; the
monodromy matrix is the product over the intervals.  The formulas are emitted from a derivation and
hold for q of either sign and for q = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import TYPE_CHECKING, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, Result, provenance
from ..half_trace import HalfTrace, arguments, check_function, discriminant, finite
from .interval_products import Products

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Rule = Literal["midpoint", "mean"]

MOST_INTERVALS = 2**16
# cosh of more leaves the range of doubles; longer intervals are cut.
_STEEPEST = 300.0
_DETERMINANT_LIMIT = 1e-10


@dataclass(frozen=True, kw_only=True)
class PiecewiseMonodromy(Result):
    """Monodromy matrix of an equation whose coefficient is constant on each interval.

    Attributes
    ----------
    half_trace : ndarray, shape (...)
        Half the trace of ``matrix``: J_N of Aannaque (7.11), times exp(-K T) with damping.
    error : ndarray, shape (...)
        Estimate of the absolute error of ``half_trace``, the levels and lengths taken as exact.
    margin : ndarray, shape (...)
        Boundary level less ``|half_trace|``: positive where the motion is stable.  It keeps its
        digits next to a boundary.
    margin_error : ndarray, shape (...)
        Estimate of its absolute error.
    matrix : ndarray, shape (..., 2, 2)
        What (y, y') becomes over all intervals; infinite beyond the range of doubles.
    matrix_error : ndarray, shape (..., 2, 2)
        Estimate of the absolute error of each entry.
    multipliers : ndarray of complex, shape (..., 2)
        Eigenvalues of ``matrix``, the larger one first, of a pair on a circle the one above.
    multiplier_error : ndarray, shape (..., 2)
        Estimate of their absolute error; next to a boundary the square root of that of the margin.
    levels : ndarray, shape (..., N)
        q of each interval.
    lengths : ndarray, shape (N,)
        Lengths [rad].
    damping : ndarray
        K, in a shape that broadcasts with ``half_trace``.
    """

    half_trace: Array
    margin: Array
    margin_error: Array
    matrix: Array
    matrix_error: Array
    multipliers: NDArray[np.complex128]
    multiplier_error: Array
    levels: Array = field(repr=False)
    lengths: Array = field(repr=False)
    damping: Array = field(repr=False)

    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where both multipliers lie inside the unit circle (on it, when undamped)."""
        return np.asarray(self.margin > 0.0)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the steps of q over the period.

        Raises
        ------
        BadInput
            If the result holds more than one equation.
        """
        from ...core.plotting import axes_or_new

        if self.levels.ndim != 1:
            raise bad(
                "PiecewiseMonodromy.plot", f"shape {self.half_trace.shape}", "one equation", "pick"
            )
        ax = axes_or_new(ax)
        ends = np.concatenate([[0.0], np.cumsum(self.lengths)])
        ax.stairs(self.levels, ends, baseline=None)
        ax.set_xlim(0.0, float(ends[-1]))
        ax.set_xlabel(r"$\theta$ [rad]")
        ax.set_ylabel("q")
        ax.set_title(f"half trace {float(self.half_trace):.6g}")
        return ax


def piecewise_monodromy(
    levels: ArrayLike, lengths: ArrayLike, damping: ArrayLike = 0.0
) -> PiecewiseMonodromy:
    """Return the monodromy matrix of y'' + 2 K y' + q(theta) y = 0 for piecewise constant q.

    Parameters
    ----------
    levels : array_like, shape (..., N)
        q on each interval, of either sign; the first interval acts first.
    lengths : array_like, shape (N,)
        Their lengths [rad], positive; together the period.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with the leading axes of ``levels``.

    Returns
    -------
    PiecewiseMonodromy
        Its check compares the determinant with exp(-2 K T).

    Raises
    ------
    BadInput
        If an argument is not finite, shapes do not fit, a length is not positive, K is negative,
        or the intervals, cut where the solution grows more than exp(300), are more than 65536.

    Notes
    -----
    Aannaque (7.9)-(7.11) and 7.2.2, after Meissner, Pipes and Hsu.  With y = exp(-K theta) u the
    equation becomes u'' + (q - K^2) u = 0.
    """
    q, t = finite("levels", levels), finite("lengths", lengths)
    if t.ndim != 1 or t.size == 0 or np.any(t <= 0.0):
        raise bad(
            "lengths", f"shape {t.shape}", "a flat sequence of positive lengths", "correct it"
        )
    if q.ndim == 0 or q.shape[-1] != t.size:
        raise bad(
            "levels", f"shape {q.shape}", f"{t.size} levels along the last axis", "one per length"
        )
    (_, k), shape = arguments(levels=q[..., 0], damping=damping)
    full = np.broadcast_to(q, (*shape, t.size)).reshape(-1, t.size)
    drag = np.broadcast_to(k, shape).ravel()
    inner = full - (drag * drag)[:, None]
    inner, cut = _cut(inner, t)
    work = Products.of(inner, cut, drag * drag)
    found = work.damped(drag, float(t.sum()))
    shaped = {name: value.reshape(shape + value.shape[1:]) for name, value in found.items()}
    beyond = float(np.count_nonzero(~np.isfinite(found["half_trace"])))
    return PiecewiseMonodromy(
        method="product of exact matrices of intervals",
        error=shaped.pop("error"),
        error_norm="absolute, entrywise, of the half trace",
        checks={
            "determinant over exp(-2 K T)": Check(work.defect, _DETERMINANT_LIMIT),
            "entries beyond the range of doubles": Check(beyond, 0.0),
        },
        provenance=provenance(),
        half_trace=shaped["half_trace"],
        margin=shaped["margin"],
        margin_error=shaped["margin_error"],
        matrix=shaped["matrix"],
        matrix_error=shaped["matrix_error"],
        multipliers=shaped["multipliers"],
        multiplier_error=shaped["multiplier_error"],
        levels=np.broadcast_to(q, (*shape, t.size)),
        lengths=t,
        damping=k,
    )


def _cut(q: Array, t: Array) -> tuple[Array, Array]:
    """Cut intervals over which a solution would grow too much for one matrix."""
    growth = np.sqrt(np.maximum(-q.min(axis=0, initial=0.0), 0.0)) * t
    parts = np.maximum(np.ceil(growth / _STEEPEST), 1.0)
    if not parts.sum() <= MOST_INTERVALS:
        raise bad(
            "levels", f"{parts.sum():.3g} intervals", f"at most {MOST_INTERVALS}", "take fewer"
        )
    if np.all(parts == 1.0):
        return q, t
    times = parts.astype(int)
    return np.repeat(q, times, axis=1), np.repeat(t / parts, times)


# ---------------------------------------------------------------- a smooth coefficient


@dataclass(frozen=True, kw_only=True)
class PiecewiseApproximation(Result):
    """Half trace of Hill's equation with its coefficient replaced by steps.

    Attributes
    ----------
    half_trace : ndarray
        Of the stepped equation, in the broadcast shape of the arguments.
    error : ndarray
        Absolute error as that of the smooth equation: the distance from its own half trace, found
        by another method, and round-off.
    exact : HalfTrace
        That half trace.
    monodromy : PiecewiseMonodromy
        The stepped equation's matrices and multipliers.
    intervals : int
        Number of equal intervals.
    rule : str
        Which value stands for an interval.
    """

    half_trace: Array
    exact: HalfTrace = field(repr=False)
    monodromy: PiecewiseMonodromy = field(repr=False)
    intervals: int
    rule: Rule

    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where the stepped equation is stable."""
        return self.monodromy.stable

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw half trace and true half trace along a line of lam2 or mu.

        Raises
        ------
        BadInput
            If the values are no line.
        """
        from ...core.plotting import axes_or_new

        if self.half_trace.ndim != 1:
            raise bad(
                "PiecewiseApproximation.plot",
                f"shape {self.half_trace.shape}",
                "a line",
                "slice it",
            )
        ax = axes_or_new(ax)
        lam2 = np.squeeze(self.exact.lam2)
        across = lam2 if lam2.ndim == 1 else np.squeeze(self.exact.mu)
        ax.plot(across, self.exact.value, label="exact")
        ax.plot(across, self.half_trace, "--", label=f"{self.intervals} intervals, {self.rule}")
        ax.set_xlabel(r"$\lambda^2$" if lam2.ndim == 1 else r"$\mu$")
        ax.set_ylabel("half trace")
        ax.legend()
        return ax


def piecewise_approximation(
    f: PeriodicFunction,
    lam2: ArrayLike,
    mu: ArrayLike,
    intervals: int,
    rule: Rule = "midpoint",
    damping: ArrayLike = 0.0,
) -> PiecewiseApproximation:
    """Return the half trace of y'' + 2 K y' + (lam2 + mu f) y = 0 with f replaced by steps.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    lam2, mu, damping : array_like
        Of any shapes that broadcast; K at least zero.
    intervals : int
        Number of equal intervals, from 1.
    rule : {"midpoint", "mean"}
        The value in the middle of an interval, or the mean over it.

    Returns
    -------
    PiecewiseApproximation

    Raises
    ------
    BadInput
        If an argument is not finite, shapes do not broadcast, K is negative, or ``intervals`` or
        ``rule`` is not one of those.

    Notes
    -----
    The method of Pipes, Hsu, and Nagarajan and Turcic (Aannaque 7.2.2).  Of the second order in
    the length of an interval, by either rule.
    """
    check_function(f)
    steps = interval_values(f, intervals, rule)
    (lam, amp, k), _ = arguments(lam2=lam2, mu=mu, damping=damping)
    levels = lam[..., None] + amp[..., None] * steps
    found = piecewise_monodromy(levels, np.full(intervals, 2.0 * pi / intervals), k)
    exact = discriminant(f, lam, amp, k)
    return PiecewiseApproximation(
        method=f"piecewise constant coefficient, {rule} rule",
        error=np.abs(found.half_trace - exact.value) + found.error + exact.error,
        error_norm="absolute, entrywise, as the half trace of the smooth equation",
        checks={**found.checks, **{f"exact: {name}": c for name, c in exact.checks.items()}},
        provenance=provenance(),
        half_trace=found.half_trace,
        exact=exact,
        monodromy=found,
        intervals=intervals,
        rule=rule,
    )


def interval_values(f: PeriodicFunction, intervals: int, rule: Rule = "midpoint") -> Array:
    """Return the values that stand for f on equal intervals of the turn, shape ``(intervals,)``.

    Raises
    ------
    BadInput
        If ``intervals`` is no whole number from 1 to 65536, or the rule is unknown.
    """
    if not is_whole(intervals, 1, MOST_INTERVALS):
        raise bad("intervals", repr(intervals), f"a whole number, 1 to {MOST_INTERVALS}", "try 180")
    if rule not in get_args(Rule):
        raise bad("rule", repr(rule), f"one of {get_args(Rule)}", "correct it")
    length = 2.0 * pi / intervals
    middles = length * (np.arange(intervals) + 0.5)
    if rule == "midpoint":
        return f(middles)
    # The mean of a wave over an interval is its value in the middle times sin(x) / x.
    share = np.sinc(np.arange(f.harmonics + 1) / intervals)
    return PeriodicFunction(f.a * share, f.b * share)(middles)
