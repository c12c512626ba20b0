"""Steady state: the periodic motion of a forced linear periodic system at constant crank speed.

By harmonic balance, with ``q = sum_k q_k exp(i k nu theta)``, nu = 2 pi / period, the equation
``(M q' + A q)' = (A^T - C/w) q' + N q + F`` becomes

    sum_l (i nu k (i nu l M_{k-l} + A_{k-l}) - i nu l (A^T - C/w)_{k-l} - N_{k-l}) q_l = F_k

(Aannaque, section 6.4, with the series of every coefficient).  High modes that the motion does not
excite cost nothing: the harmonics are those of the motion, however stiff the system is.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache, partial
from numbers import Real
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.collocation import legendre_integrals
from ..core.errors import LINEAR_RANGE, LinearRangeWarning, bad, warn_of_large_deflection
from ..core.families import Array, LinearPeriodic
from ..core.files import NOT_SAVED, NotSaved
from ..core.inputs import is_one_of, numbers, require_between
from ..core.maxima import largest_size
from ..core.plotting import Axes, axes_or_new, draw_coordinates
from ..core.progress import bar
from ..core.results import Check, DeferredChecks, DeferredField, DeferredGroup, Result, provenance
from .equation import Equation, equation_of
from .multipliers import floquet_multipliers
from .ring import solve_ring
from .transition import Method, method, refined, segments_of

ComplexArray = NDArray[np.complex128]

METHODS = ("auto", "harmonic_balance")
_EPS = float(np.finfo(float).eps)
_SAMPLES, _MOST_SAMPLES = 256, 2**20
# Numbers in q of a batch, half a GiB.
_MOST_FLOATS = 2**26
# Harmonics that the motion is likely to have: where the first rung of the ladder lies.
_LIKELY = 12.0
# Errors of rates over their peaks that are allowed, over those of the coordinates.
_RATES = 10.0
# Angles at which the motions of two rungs are compared, at the least: 16 of them lay where a rung
# happened to be exact, and the error was fifteen times the estimate.
_COMPARED = 128
# Round-off over the unit of round-off times the sensitivity: near resonances up to 26 was seen.
_ROUNDED = 48.0
# Change of a motion over that of the flow, times the unit of round-off, from which it is lost.
_LOST = 1.0 / 16.0

# Fields that are computed when they are first looked at.
LATER = {
    name: DeferredField() for name in ("multipliers", "multiplier_error", "stable", "distance")
}


@dataclass(frozen=True, kw_only=True)
class SteadyState(Result):
    """Periodic motion of a forced linear periodic system, of the period of its coefficients.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    theta : ndarray
        Crank angles [rad] that divide the period evenly, from 0, shape ``(nt,)``.
    q, qd : ndarray
        Coordinates and their time derivatives [1/s], shape ``(*batch, nt, n)``; NaN where there is
        no single periodic motion.  Rates over their peaks are within ten times ``error``.
    error : ndarray
        Largest error of each coordinate over its peak, shape ``(*batch, n)``; inf where q is NaN.
    multipliers : ndarray of complex
        Floquet multipliers, shape ``(*batch, 2n)``, by falling modulus.
    multiplier_error : ndarray
        Absolute error of each multiplier, shape ``(*batch, 2n)``.
    stable : ndarray of bool
        Whether nearby motions stay near: no multiplier outside the unit circle by more than its
        error; shape ``batch``.  Without it the motion exists, and no machine would show it.
    distance : ndarray
        Distance of the closest multiplier from 1, shape ``batch``: the response grows like its
        inverse.
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

    Notes
    -----
    ``multipliers``, ``multiplier_error``, ``stable`` and ``distance`` are computed when one of them
    is first looked at.
    """

    speed: Array
    theta: Array
    q: Array
    qd: Array
    multipliers: Any = LATER["multipliers"]
    multiplier_error: Any = LATER["multiplier_error"]
    stable: Any = LATER["stable"]
    distance: Any = LATER["distance"]
    sensitivity: Array
    period: float
    labels: tuple[str, ...]
    reference_length: float
    shapes: Callable[[Array, Array], Array | None] | None = field(
        default=None, repr=False, metadata=NOT_SAVED
    )

    arrays_along: ClassVar = {
        "...": "speed stable distance sensitivity",
        "... multiplier": "multipliers multiplier_error",
        "... sample coordinate": "q qd",
        "sample": "theta",
        "... coordinate": "error",
    }
    column_units: ClassVar = {"1/s": "qd", "rad": "period", "m": "reference_length"}

    @property
    def coefficients(self) -> ComplexArray:
        """Fourier coefficients c of q, shape ``(*batch, nt/2 + 1, n)``.

        ``q(theta) = Re(c_0 + 2 sum_k c_k exp(2 pi i k theta/period))``, the last one once where nt
        is even.
        """
        values: ComplexArray = np.fft.rfft(self.q, axis=-2) / len(self.theta)
        return values

    @property
    def place(self) -> float:
        """Place x/length of deflections by default: the end of the link, or its middle.

        The middle is taken where the end is held, as that of a coupler between two pins.
        """
        end, middle = np.max(np.abs(self._shapes_at(np.array([1.0, 0.5]))), axis=(0, 2))
        return 1.0 if end > 1e-9 * middle else 0.5

    def deflection(self, x: ArrayLike | None = None) -> Array:
        """Return the deflection [m] at places x/length ``(nx,)``, shape ``(*batch, nt, nx)``.

        The axis of places is left out where ``x`` is one number, :attr:`place` by default.

        Raises ``BadInput`` if the system has no mode shapes, or a place is not a number from 0 to
        1.
        """
        places = numbers("x", self.place if x is None else x)
        shapes = self._shapes_at(np.atleast_1d(places))
        value: Array = self.reference_length * np.einsum("txn,...tn->...tx", shapes, self.q)
        return value[..., 0] if places.ndim == 0 else value

    def _shapes_at(self, places: Array) -> Array:
        if places.ndim > 1 or not np.all((places >= 0) & (places <= 1)):
            raise bad("x", str(places), "places x/length from 0 to 1", "divide by the length")
        values = None if self.shapes is None else self.shapes(places, self.theta)
        if values is None:
            found = "a system without mode shapes"
            raise bad("deflection", found, "LinearPeriodic.shape or moving_shape", "use q")
        return values

    def peak(self, x: ArrayLike | None = None) -> Array:
        """Return the largest size of the deflection [m] over the period, at places x/length.

        Shape ``(*batch, nx)``, or ``batch`` where ``x`` is one number, :attr:`place` by default.
        It may lie between the given angles; :meth:`peak_error` tells how well it is known.

        Raises
        ------
        BadInput
            As :meth:`deflection`.
        """
        return self.reference_length * self._peaks(x)[0]

    def peak_error(self, x: ArrayLike | None = None) -> Array:
        """Return the error of :meth:`peak` over itself: of the motion, and between the angles.

        Of its shape; infinite where nothing moves or there is no single motion.
        """
        return self._peaks(x)[1]

    def _peaks(self, x: ArrayLike | None) -> tuple[Array, Array]:
        """Return the largest sizes of the shapes' sums, and their errors over themselves."""
        places = numbers("x", self.place if x is None else x)
        shapes = self._shapes_at(np.atleast_1d(places))
        moved = np.max(np.abs(self.q), axis=-2) * self.error @ np.max(np.abs(shapes), axis=0).T
        # One motion at a time: all of them at all places would fill the memory.
        bent = (
            np.einsum("txn,tn->xt", shapes, one) for one in self.q.reshape(-1, *self.q.shape[-2:])
        )
        found = np.array([[largest_size(row) for row in rows] for rows in bent])
        top, between = np.moveaxis(found.reshape(*self.speed.shape, places.size, 2), -1, 0)
        error = np.divide(moved + between, top, out=np.full(top.shape, np.inf), where=top > 0.0)
        return (top[..., 0], error[..., 0]) if places.ndim == 0 else (top, error)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over the crank angle and return the axes.

        Of motions at several speeds of a system with mode shapes the largest deflections are drawn
        over the speed, else the first motion.
        """
        ends = np.array([0.0, 1.0])
        shapes = None if isinstance(self.shapes, NotSaved) else self.shapes
        deflects = shapes is not None and shapes(ends, self.theta[:1]) is not None
        if self.speed.ndim == 1 and self.speed.size > 1 and deflects:
            return self._plot_peaks(axes_or_new(ax))
        first = self.q.reshape(-1, *self.q.shape[-2:])[0]
        angles = np.degrees(np.append(self.theta, self.period))
        whole = np.vstack([first, first[:1]])
        return draw_coordinates(ax, angles, whole, self.labels, "crank angle [deg]")

    def _plot_peaks(self, ax: Axes) -> Axes:
        shapes = self.reference_length * self._shapes_at(np.linspace(0.0, 1.0, 41))
        bent = (np.einsum("txn,tn->tx", shapes, one) for one in self.q)
        peaks = 1e3 * np.array([np.max(np.abs(one)) for one in bent])
        ax.semilogy(self.speed, peaks, linewidth=0.9)
        unstable = ~self.stable
        if np.any(unstable):
            ax.semilogy(self.speed[unstable], peaks[unstable], "r.", markersize=3, label="unstable")
            ax.legend()
        ax.set(xlabel="crank speed [rad/s]", ylabel="largest deflection [mm]")
        return ax


def steady_state(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    method: str = "auto",
    rtol: float = 1e-6,
    samples: int = _SAMPLES,
    progress: bool = False,
    **parameters: ArrayLike,
) -> SteadyState:
    """Return the periodic motion of a forced linear periodic system.

    With y = (q, p = M q' + A q), a segment of the period takes y to ``X_k y + z_k``; the ring of
    segments is closed by orthogonal elimination, so that neither growth nor strong damping spoils
    it.  Radau's collocation lets fast modes follow their load where no segment resolves them, so
    that there are as few segments as the motion needs, however stiff the system is.

    Parameters
    ----------
    system : LinearPeriodic
        The system, with forcing f, h or p.
    speed : array_like
        Crank speeds w [rad/s], positive.
    method : str
        ``"auto"``: as above.  ``"harmonic_balance"``: the Fourier series of motion and
        coefficients (Aannaque 6.13, 6.14), as many harmonics as the motion has.
    rtol : float
        Wanted error of each coordinate over its peak, 1e-12 to 1e-2.  Near a resonance round-off
        may keep it from being reached: see ``error``.
    samples : int
        Number of crank angles that are given.
    progress : bool
        Whether to show a progress bar.
    **parameters : array_like
        Parameter values that replace the system's; they broadcast with ``speed``.  Geometry too,
        one number each, where the system can be made anew for it.

    Returns
    -------
    SteadyState
        Its checks: ``converged``, the error at the worst place over what was asked or what
        round-off allows there; ``single``, round-off times the sensitivity, at the worst place:
        beyond 1 no single periodic motion is told apart there, and q is NaN; ``residual``, of the
        equation between the angles at the place of the largest error; ``linear range``, the
        largest deflection over the reference length.

    Warns
    -----
    LinearRangeWarning
        If the deflection passes 5 % of the reference length.

    Raises
    ------
    BadInput
        If an argument is unusable, no forcing acts (none is there, or all of it is zero), or the
        motions would fill the memory.

    Notes
    -----
    Where a multiplier is 1 the answer is NaN even if the forcing lacks the harmonic in question,
    as for q'' + 4 q = cos t: a periodic motion exists then, but it is not the only one, and any
    disturbance of the forcing leads far away.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping_ratio": 0.02})
    >>> steady = el.steady_state(scene.system(), speed=30.0)
    >>> print(steady.stable, (1000.0 * steady.peak(0.5)).round(2))
    True 2.67
    """
    _check_arguments(method, rtol, samples)
    if not numbers("speed", speed).size:
        raise bad("speed", "no speed at all", "at least one speed [rad/s]", "give some")
    equation = equation_of(system, speed, parameters, forcing=True)
    _check_forcing(equation)
    _check_memory(equation, samples)
    count, n = len(equation.speed), equation.size
    with bar(progress, count) as tick:
        solve = by_segments if method == "auto" else _by_balance
        q, slope, error, sensitivity = solve(equation, rtol, int(samples), tick)
    lost = ~(_EPS * sensitivity < _LOST) | ~np.all(np.isfinite(q), axis=(1, 2))
    lost |= ~(np.max(error, axis=1, initial=0.0) < 1.0)
    allowed = np.minimum(np.maximum(rtol, _ROUNDED * _EPS * sensitivity), 1e-2)
    single = Check(16.0 * _EPS * float(np.max(np.where(lost, np.inf, sensitivity))), 1.0)
    q[lost], slope[lost], error[lost] = np.nan, np.nan, np.inf
    theta = equation.period * np.arange(float(samples)) / samples
    largest = equation.system.largest_deflection(theta, q)
    warn_of_large_deflection(largest, nonlinear=equation.system.provenance.get("nonlinear", ""))
    later = DeferredGroup(partial(_stability, system, speed, dict(parameters)))
    checks = partial(_checks, equation, (theta, q, slope), error, allowed, single, largest)
    batch = equation.batch
    return SteadyState(
        method="segments by collocation, closed to a ring" if method == "auto" else method,
        error=error.reshape(*batch, n),
        error_norm="largest error of a coordinate over its peak",
        checks=DeferredChecks(checks),
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=equation.speed.reshape(batch),
        theta=theta,
        q=q.reshape(*batch, samples, n),
        qd=(slope * equation.speed[:, None, None]).reshape(*batch, samples, n),
        **later.fields(LATER),
        sensitivity=sensitivity.reshape(batch),
        period=equation.period,
        labels=system.labels,
        reference_length=equation.system.reference_length,
        shapes=equation.system.shapes,
    )


_Motion = tuple[Array, Array, Array, Array]


def by_segments(
    equation: Equation, rtol: float, samples: int, tick: Callable[[int], None] | None = None
) -> _Motion:
    """Return q and dq/dtheta ``(nb, nt, n)``, errors ``(nb, n)`` and sensitivities ``(nb,)``."""
    way = method("radau", 7 if rtol > 1e-5 else 10)
    likely = equation.with_slow_modes(_LIKELY)
    # A few angles may lie where the polynomials of a rung happen to be exact.
    finer = -(-_COMPARED // samples)
    solve = partial(ring_motion, way, finer * samples)
    solutions, error, _ = refined(likely, way, rtol, solve, _change, tick=tick)
    q, slope, sensitivity = (np.array(part) for part in zip(*solutions, strict=True))
    return q[:, ::finer], slope[:, ::finer], error, sensitivity


def ring_motion(way: Method, samples: int, equation: Equation, count: int) -> tuple[Array, ...]:
    """Return q and dq/dtheta ``(nb, nt, n)`` at even angles and sensitivities ``(nb,)``."""
    n = equation.size
    segments = segments_of(equation, count, way, slopes=True)
    flow, load = segments.maps[..., : 2 * n, : 2 * n], segments.maps[..., : 2 * n, 2 * n]
    nodes, sensitivity = solve_ring(flow, load)
    whole = np.concatenate([nodes, np.ones((*nodes.shape[:2], 1))], axis=-1)
    by_column = segments.slopes.reshape(*whole.shape, -1)
    slopes = (whole[:, :, None] @ by_column).reshape(*whole.shape[:2], n, way.stages).mT
    q, slope = along_segments(way, equation.period, nodes[..., :n], slopes, samples)
    unit = equation.scale[:, None, :]
    return q * unit, slope * unit, sensitivity


def along_segments(
    way: Method, period: float, starts: Array, slopes: Array, samples: int
) -> tuple[Array, Array]:
    """Return coordinates and slopes at even angles of the period from 0, ``(nb, samples, n)`` each.

    ``starts`` holds the coordinates at the left ends of the segments, ``(nb, segments, n)``, and
    ``slopes`` dq/dtheta at the nodes, ``(nb, segments, s, n)``, the last at the right end; that of
    the segment before is the slope at the left end, one node more.
    """
    count = starts.shape[1]
    places, rise, values = _dense_output(way, count, samples)
    before = np.roll(slopes[:, :, -1:], 1, axis=1)
    chosen = np.concatenate([before, slopes], axis=2)[:, places]
    q = starts[:, places] + (period / count) * np.sum(rise[:, :, None] * chosen, axis=2)
    return q, np.sum(values[:, :, None] * chosen, axis=2)


@lru_cache(maxsize=24)
def _dense_output(way: Method, count: int, samples: int) -> tuple[NDArray[np.intp], Array, Array]:
    """Return the segment of each sample, and what slopes at its nodes add to q and give there."""
    at = np.arange(float(samples)) * count / samples
    places = np.minimum(at.astype(np.intp), count - 1)
    inside = 2.0 * (at - places) - 1.0
    nodes = np.concatenate([[-1.0], 2.0 * way.c - 1.0])
    back = np.linalg.inv(np.polynomial.legendre.legvander(nodes, way.stages))
    rise = 0.5 * legendre_integrals(inside, way.stages + 1) @ back
    values = np.polynomial.legendre.legvander(inside, way.stages) @ back
    return places, rise, values


def _change(coarse: tuple[Array, ...], fine: tuple[Array, ...]) -> tuple[Array, Array]:
    """Return the difference of two motions and rates over the finer's peaks, and round-off."""
    with np.errstate(invalid="ignore"):
        gap, rate = (np.max(np.abs(coarse[k] - fine[k]), axis=1) / peaks(fine[k]) for k in (0, 1))
    rounding = _ROUNDED * _EPS * np.minimum(fine[2], 1.0 / _EPS)[:, None]
    return np.maximum(gap, rate / _RATES), rounding


def peaks(q: Array) -> Array:
    """Return the largest size of each coordinate, ``(nb, n)``; never 0.

    A coordinate that hardly moves beside the others has no peak of its own.
    """
    size = np.abs(q).max(axis=1)
    size = np.maximum(size, _EPS * size.max(axis=1, keepdims=True, initial=0.0))
    value: Array = np.where(size > 0.0, size, 1.0)
    return value


def _by_balance(
    equation: Equation, rtol: float, samples: int, tick: Callable[[int], None] | None = None
) -> _Motion:
    rows = []
    for member in range(len(equation.speed)):
        part = equation.take(np.array([member]))
        rows.append(balanced_motion(part, rtol, samples))
        if tick is not None:
            tick(member + 1)
    q, slope, error, sensitivity = zip(*rows, strict=True)
    return np.array(q), np.array(slope), np.array(error), np.array(sensitivity)


def _stability(
    system: LinearPeriodic, speed: ArrayLike, parameters: Mapping[str, Any]
) -> dict[str, Any]:
    """Return multipliers, stability and distance of a batch of motions."""
    result = floquet_multipliers(system, speed, **parameters)
    return {
        "multipliers": result.multipliers,
        "multiplier_error": result.error,
        "stable": np.asarray(result.stable),
        "distance": np.min(np.abs(result.multipliers - 1.0), axis=-1),
    }


def _checks(
    equation: Equation,
    motion: tuple[Array, Array, Array],
    error: Array,
    allowed: Array,
    single: Check,
    largest: float | None,
) -> Mapping[str, Check]:
    theta, q, slope = motion
    worst = np.max(error, axis=-1, initial=0.0)
    known = np.flatnonzero(np.isfinite(worst))
    checks = {"single": single}
    if len(known):
        checks["converged"] = Check(float(np.max(worst[known] / allowed[known])), 1.0)
        place = int(known[np.argmax(worst[known])])
        part = equation.take(np.array([place]))
        checks["residual"] = _residual(part, theta, q[place], slope[place], float(worst[place]))
    if largest is not None:
        checks["linear range"] = Check(largest, LINEAR_RANGE)
    return checks


def _residual(equation: Equation, theta: Array, q: Array, slope: Array, error: float) -> Check:
    """Put the motion's Fourier series into the equation half-way between the angles."""
    # The derivative of the series has nothing to do with the method.  Limit: an error of the
    # highest harmonic kept, over the largest rate.
    count = len(theta)
    states = equation.states(theta, q, slope)
    waves = np.arange(count // 2 + 1) * (2 * np.pi / equation.period)
    half_step = np.exp(0.5j * waves * equation.period / count)[:, None]
    series = np.fft.rfft(states, axis=0) * half_step
    if count % 2 == 0:
        series[-1] = 0.0
    between = np.fft.irfft(series, n=count, axis=0)
    rise = np.fft.irfft(1j * waves[:, None] * series, n=count, axis=0)
    generator = equation.generator(theta + 0.5 * equation.period / count)[0]
    expected = (generator[:, :-1, :-1] @ between[..., None])[..., 0] + generator[:, :-1, -1]
    # Drag counts as well as springs: a rate is in error by as much times what multiplies it.
    fastest = waves[-1] + float(np.max(np.abs(generator[:, :-1, :-1])))
    value = float(np.max(np.abs(rise - expected)) / (np.max(np.abs(states)) * fastest))
    return Check(value, 10 * error + 1e-12)


def _check_arguments(chosen: str, rtol: float, samples: int) -> None:
    if not is_one_of(chosen, METHODS):
        raise bad("method", repr(chosen), f"one of {METHODS}", "choose 'auto'")
    require_between("rtol", rtol, 1e-12, 1e-2, "choose 1e-6")
    whole = isinstance(samples, Real) and 4 <= samples <= _MOST_SAMPLES and samples % 1 == 0
    if not whole:
        fix = "choose 256"
        raise bad("samples", repr(samples), f"a whole number from 4 to {_MOST_SAMPLES}", fix)


def _check_forcing(equation: Equation) -> None:
    if not equation.forced or not np.any(equation.largest_force()):
        there = any(term.array in "fhp" for term in equation.system.terms)
        found = "forcing that is zero" if there else "a system without forcing f, h, p"
        raise bad("steady_state", found, "a forced system", "add the forcing")


def _check_memory(equation: Equation, angles: int) -> None:
    each = angles * 2 * equation.size
    if len(equation.speed) * each > _MOST_FLOATS:
        found = f"{len(equation.speed)} motions at {angles} angles"
        fix = "take the speeds in parts, by sweep"
        raise bad("steady_state", found, f"at most {_MOST_FLOATS // each} of them at a time", fix)


def quiet_state(
    system: LinearPeriodic,
    speeds: ArrayLike,
    rtol: float,
    parameters: Mapping[str, float] | None = None,
) -> SteadyState:
    """Return the steady state without a warning of the linear range; its check tells."""
    with warnings.catch_warnings():
        # At a resonance it is left as a matter of course.
        warnings.simplefilter("ignore", LinearRangeWarning)
        changes: dict[str, Any] = dict(parameters or {})
        return steady_state(system, speeds, rtol=rtol, **changes)


def balanced_motion(
    equation: Equation, rtol: float, samples: int
) -> tuple[Array, Array, Array, float]:
    """Return the periodic motion of the first member at even angles, its error and condition.

    q and dq/dtheta have shape ``(samples, n)``.  The error of each coordinate over its peak,
    ``(n,)``, is the difference to a motion of two thirds of the harmonics, times what the last
    third is expected to leave of it, and round-off; the condition number is that of the equations
    in scaled coordinates, infinite where they are singular.
    """
    harmonics = 12
    before = _series(equation, 2 * harmonics // 3)[0]
    while True:
        waves, condition = _series(equation, harmonics)
        q, slope = _motion(equation, waves, samples)
        size = np.max(np.abs(q), axis=0)
        size = np.where(size > 0.0, size, 1.0)
        gap = np.max(np.abs(q - _motion(equation, before, samples)[0]), axis=0) / size
        # The last third tells how they fall where no mode answers in it or beyond.
        highest = np.max(equation.frequency[0]) * equation.period / (2.0 * np.pi)
        gap = _left(waves) * gap if highest < 2 * harmonics // 3 else gap
        error = gap + 8.0 * _EPS * min(condition, 1.0 / _EPS)
        more = (3 * harmonics) // 2
        enough = bool(np.all(error <= rtol)) or not np.isfinite(condition)
        # Unknowns up to which harmonics are added: a matrix of 400 MiB.
        if enough or (2 * more + 1) * equation.size > 5000:
            return q, slope, error, condition
        before, harmonics = waves, more


def _left(waves: ComplexArray) -> Array:
    """Return what share of an error the last third of the harmonics leaves, at most 1."""
    # Twice the root of the fall from the third before it: harmonics beyond may fall half as fast.
    third = len(waves) // 3
    middle, last = (
        np.max(np.abs(part), axis=0) for part in (waves[-2 * third : -third], waves[-third:])
    )
    share: Array = np.minimum(1.0, 2.0 * np.sqrt(last / np.maximum(middle, np.finfo(float).tiny)))
    return share


def _series(equation: Equation, harmonics: int) -> tuple[ComplexArray, float]:
    """Return harmonics 0 to H of q in scaled coordinates, ``(H + 1, n)``, and the condition."""
    n, size = equation.size, 2 * harmonics + 1
    order = np.arange(-harmonics, harmonics + 1)
    rate = 2j * np.pi / equation.period * order
    angles = equation.even_angles()
    count = len(angles)
    feedback = equation.feedback(angles)

    def window(values: Array | None) -> ComplexArray | float:
        """Return the blocks of harmonic k - l, ``(size, size, n, n)``."""
        if values is None:
            return 0.0
        table = np.fft.fft(np.broadcast_to(values[0], (count, n, n)), axis=0) / count
        gaps = order[:, None] - order
        kept: ComplexArray = np.where(
            (2 * np.abs(gaps) < count)[..., None, None], table[gaps % count], 0.0
        )
        return kept

    fields = {
        name: window(equation.at(name, angles) if name in equation.fields else None)
        for name in ("mass", "gyroscopic", "stiffness")
    }
    outer, inner = rate[:, None, None, None], rate[None, :, None, None]
    blocks = outer * (inner * fields["mass"] + fields["gyroscopic"])
    blocks = blocks - inner * window(feedback) - fields["stiffness"]
    matrix = np.swapaxes(blocks, 1, 2).reshape(size * n, size * n)
    force = np.fft.fft(np.broadcast_to(equation.at("force", angles)[0], (count, n)), axis=0) / count
    load = np.where((2 * np.abs(order) < count)[:, None], force[order % count], 0.0)
    # Rows are weighed by their largest entry: inertia grows with the square of the harmonic.
    largest = np.max(np.abs(matrix), axis=1)
    if not np.all(largest > 0.0):
        return np.full((harmonics + 1, n), np.nan + 0j), float("inf")
    weights = 1.0 / largest
    weighed = weights[:, None] * matrix
    condition = float(np.linalg.cond(weighed)) if size * n <= 600 else _estimate(weighed)
    if not condition < 1.0 / _EPS:
        return np.full((harmonics + 1, n), np.nan + 0j), float("inf")
    waves = np.linalg.solve(weighed, weights * load.ravel()).reshape(size, n)
    half: ComplexArray = waves[harmonics:]
    return half, condition


def _estimate(matrix: ComplexArray) -> float:
    """Return an estimate of the condition number in the 1-norm."""
    from scipy.linalg.lapack import zgecon, zgetrf

    factors, _, info = zgetrf(matrix)
    if info:
        return float("inf")
    reciprocal, _ = zgecon(factors, float(np.max(np.sum(np.abs(matrix), axis=0))))
    return 1.0 / reciprocal if reciprocal else float("inf")


def _motion(equation: Equation, waves: ComplexArray, samples: int) -> tuple[Array, Array]:
    """Return coordinates and slopes at even angles from harmonics 0 to H."""
    rate = 2j * np.pi / equation.period * np.arange(len(waves))[:, None]
    turns = np.exp(2j * np.pi * np.outer(np.arange(samples), np.arange(len(waves))) / samples)
    weights = np.where(np.arange(len(waves)) == 0, 1.0, 2.0)[:, None]
    q = (turns @ (weights * waves)).real * equation.scale[0]
    slope = (turns @ (weights * rate * waves)).real * equation.scale[0]
    return q, slope
