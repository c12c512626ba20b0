"""Steady state: the periodic motion of a forced linear periodic system at constant crank speed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import LinearRangeWarning, bad
from ..families import LinearPeriodic
from ..floquet.first_order import CanonicalForm, canonical_form, even_angles, numbers
from ..floquet.monodromy_matrix import FloquetMultipliers, floquet_multipliers
from ..progress import bar
from ..results import Check, Result, provenance
from ..simulation.trajectory import LINEAR_RANGE
from .shooting import Orbit, first_segments, periodic_orbits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

METHODS = ("shooting",)
# Methods that are planned: a request for one is told apart from a slip of the pen.
_PLANNED = (
    "transition_matrix",
    "closed_form",
    "cyclic",
    "harmonic_balance",
    "modal",
    "time_marching",
)
_FEWEST_SAMPLES = 256
_MOST_SAMPLES = 2**20
# Places along the link at which the linear range is watched.
_PLACES = np.linspace(0.0, 1.0, 26)
_BLOCK_FLOATS = 4_000_000
# Motions found at a time, after which the progress bar moves.
_TOGETHER = 64
# Numbers in q of a batch, half a GiB; qd and what they are made of take as much each.
_MOST_FLOATS = 2**26
# Collocation maps, times the cube of their size, of half an hour or so.
_MOST_WORK = 3e10
# The first try and its refinement, in segments of the first.
_TRIES = 3
# Motions whose rates are found at a time.
_RATES = 2048


@dataclass(frozen=True, kw_only=True)
class SteadyState(Result):
    """Periodic motion of a forced linear periodic system, of the period of its coefficients.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    theta : ndarray
        Crank angles [rad] that divide the period evenly, from 0, shape ``(nt,)``; nt is a power
        of two.
    q, qd : ndarray
        Coordinates and their time derivatives [1/s], shape ``(*batch, nt, n)``; NaN where there is
        no single periodic motion (``distance`` within its error).
    error : ndarray
        Largest error of each coordinate over its own peak, shape ``(*batch, n)``; inf where q is
        NaN.
    multipliers : ndarray of complex
        Floquet multipliers, shape ``(*batch, 2n)``, by falling modulus.
    stable : ndarray of bool
        Whether nearby motions stay near: no multiplier outside the unit circle by more than its
        error; shape ``batch``.  Without it the motion exists, and no machine would show it.
    distance : ndarray
        Distance of the closest multiplier from 1, shape ``batch``: the response grows like its
        inverse.
    sensitivity : ndarray
        Relative change of the motion over a relative change of the flow, shape ``batch``.
    period : float
        Period [rad].
    labels : tuple of str
        Names of the coordinates.
    reference_length : float
        Length [m] that turns shapes times coordinates into deflections.
    shapes : callable or None
        From places x/length ``(nx,)`` and crank angles ``(nt,)`` to the mode shapes
        ``(nt, nx, n)``; None where the system has none.
    """

    speed: Array
    theta: Array
    q: Array
    qd: Array
    multipliers: ComplexArray
    stable: NDArray[np.bool_]
    distance: Array
    sensitivity: Array
    period: float
    labels: tuple[str, ...]
    reference_length: float
    shapes: Callable[[Array, Array], Array | None] | None = field(default=None, repr=False)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {"theta": ("sample",)}

    @property
    def coefficients(self) -> ComplexArray:
        """Fourier coefficients c of q, shape ``(*batch, nt/2 + 1, n)``.

        ``q(theta) = Re(c_0 + 2 sum_k c_k exp(2 pi i k theta/period))``, the last one once.
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
        from ..plotting import axes_or_new

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


def steady_state(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    method: str = "shooting",
    rtol: float = 1e-9,
    samples: int = _FEWEST_SAMPLES,
    progress: bool = False,
    **parameters: ArrayLike,
) -> SteadyState:
    """Return the periodic motion of a forced linear periodic system.

    With y = (q, p = M q' + A q) and y' = L y + g, the flow of one period is y -> X y + z; the
    periodic motion starts from ``(I - X) y = z``.  The period is cut into segments, each solved by
    Gauss-Legendre collocation of order 16, and the ring of their maps is closed by orthogonal
    elimination, so that neither growth nor strong damping spoils it.

    Parameters
    ----------
    system : LinearPeriodic
        The system, with forcing f, h or p.
    speed : array_like
        Crank speeds w [rad/s], positive.
    method : str
        ``"shooting"``.
    rtol : float
        Wanted error of each coordinate over its own peak, 1e-12 to 1e-2.  Near a resonance
        round-off may keep it from being reached: see ``error``.
    samples : int
        Least number of crank angles that are given; rounded up to a power of two, and raised
        where the motion needs more.
    progress : bool
        Whether to show a progress bar (extra ``progress``).
    **parameters : array_like
        Parameter values that replace the system's own; they broadcast with ``speed``.

    Returns
    -------
    SteadyState
        Its checks: ``converged``, the error at the worst place over what was asked or what
        round-off allows there; ``single``, the error of the multiplier closest to 1 over its
        distance, at the worst place: beyond 1 no single periodic motion is told apart there, and
        q is NaN; ``residual``, of the equation between the angles at the place of the largest
        error; ``linear range``, the largest deflection over the reference length.

    Warns
    -----
    LinearRangeWarning
        If the deflection passes 5 % of the reference length.

    Raises
    ------
    BadInput
        If an argument is unusable, no forcing acts (none is there, or all of it is zero), a speed
        is too low for the highest mode, or the motions would fill the memory or take more than
        half an hour or so.

    Notes
    -----
    Where a multiplier is 1 the answer is NaN even if the forcing lacks the harmonic in question,
    as for q'' + 4 q = cos t: a periodic motion exists then, but it is not the only one, and any
    disturbance of the forcing leads far away.

    Strong damping costs most in the multipliers, which resolve each decay.
    """
    _check_arguments(method, rtol, samples)
    if not numbers("speed", speed).size:
        raise bad("speed", "no speed at all", "at least one speed [rad/s]", "give some")
    form = canonical_form(system, speed, parameters, forcing=True)
    _check_forcing(form)
    _check_memory(form, int(samples))
    first = first_segments(form)
    check_work(form, first)
    _check_memory(form, max(int(samples), 2 * int(np.max(first))))
    count = len(form.speed)
    with bar(progress, 2 * count) as tick:
        multipliers = floquet_multipliers(system, speed, rtol=1e-11, **parameters)
        distance, doubt = _nearness(multipliers, count)
        single = doubt < distance
        if tick is not None:
            tick(count)
        states, error, floor, sensitivity = _orbits(form, first, rtol, int(samples), single, tick)
        if tick is not None:
            tick(2 * count)
    theta = even_angles(system.period, states.shape[1])
    n, batch = system.size, form.batch
    slopes = _slopes(form, theta, states)
    q = states[..., :n] * form.scale[:, None, :n]
    allowed = np.maximum(np.maximum(rtol, 4 * floor), 1e-11 * sensitivity[:, None])
    checks = _checks(form, theta, states, error, np.minimum(allowed, 1e-2))
    checks["single"] = _single(distance, doubt)
    largest = _largest(system, theta, q)
    if largest is not None:
        checks["linear range"] = Check(largest, LINEAR_RANGE)
        warn_beyond(largest)
    return SteadyState(
        method=f"{method}, by Gauss-Legendre collocation of order 16",
        error=error.reshape(*batch, n),
        error_norm="largest error of a coordinate over its own peak",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=form.speed.reshape(batch),
        theta=theta,
        q=q.reshape(*batch, *q.shape[1:]),
        qd=slopes.reshape(*batch, *q.shape[1:]),
        multipliers=multipliers.multipliers,
        stable=np.asarray(multipliers.stable),
        distance=distance.reshape(batch),
        sensitivity=sensitivity.reshape(batch),
        period=system.period,
        labels=system.labels,
        reference_length=system.reference_length,
        shapes=system.shapes,
    )


def _check_arguments(method: str, rtol: float, samples: int) -> None:
    if method not in METHODS:
        planned = method in _PLANNED
        raise bad(
            "method",
            repr(method) + (", which is not there yet" if planned else ""),
            f"one of {METHODS}",
            "choose 'shooting'",
        )
    if not (isinstance(rtol, Real) and 1e-12 <= rtol <= 1e-2):
        raise bad("rtol", repr(rtol), "a number from 1e-12 to 1e-2", "choose 1e-9")
    whole = isinstance(samples, Real) and 1 <= samples <= _MOST_SAMPLES and samples % 1 == 0
    if not whole:
        fix = "choose 256"
        raise bad("samples", repr(samples), f"a whole number from 1 to {_MOST_SAMPLES}", fix)


def _check_forcing(form: CanonicalForm) -> None:
    """Refuse a system on which nothing acts."""
    acting = any(
        term.array in ("f", "h", "p") and bool(np.any(factor)) and bool(np.any(amplitude))
        for term, factor, amplitude in zip(
            form.system.terms, form.factors, form.system.spectra, strict=True
        )
    )
    if not acting:
        found = "forcing that is zero" if form.forced else "a system without forcing f, h, p"
        raise bad("steady_state", found, "a forced system", "add the forcing")


def in_parts(form: CanonicalForm) -> list[CanonicalForm]:
    """Return a large batch in parts whose means over the period do not fill the memory."""
    count = len(form.speed)
    if count <= _RATES:
        return [form]
    return [form.take(slice(k, k + _RATES)) for k in range(0, count, _RATES)]


def check_work(form: CanonicalForm, first: NDArray[np.int64]) -> None:
    """Refuse motions that would take too long, by the segments they begin with."""
    # The multipliers resolve decays too.
    rates = [part.rate for part in in_parts(form)]
    resolved = np.maximum(np.concatenate(rates) * form.system.period / 3.0, first)
    work = float(_TRIES * np.sum(first + resolved)) * form.size**3
    if work > _MOST_WORK:
        raise bad(
            "steady_state",
            f"{len(first)} motions of {form.system.size} modes, up to "
            f"{float(np.max(resolved)):.2g} segments each",
            f"at most {_MOST_WORK / work:.2g} of that",
            "give fewer speeds, higher ones, fewer modes, or less damping",
        )


def _check_memory(form: CanonicalForm, angles: int) -> None:
    floats = len(form.speed) * angles * 2 * form.system.size
    if floats > _MOST_FLOATS:
        raise bad(
            "steady_state",
            f"{len(form.speed)} motions at {angles} angles",
            f"at most {_MOST_FLOATS // (angles * 2 * form.system.size)} of them at a time",
            "take the speeds in parts, the slow ones by themselves, or steady_peaks",
        )


def _nearness(found: FloquetMultipliers, count: int) -> tuple[Array, Array]:
    """Return the distance of the closest multiplier from 1 and its error, ``(nb,)`` each."""
    values = found.multipliers.reshape(count, -1)
    gaps = np.abs(values - 1.0)
    closest = np.argmin(gaps, axis=-1)[:, None]
    doubt = np.take_along_axis(found.error.reshape(count, -1), closest, axis=-1)
    return np.take_along_axis(gaps, closest, axis=-1)[:, 0], doubt[:, 0]


def _orbits(
    form: CanonicalForm,
    first: NDArray[np.int64],
    rtol: float,
    samples: int,
    single: NDArray[np.bool_],
    tick: Callable[[int], None] | None,
) -> tuple[Array, Array, Array, Array]:
    """Return scaled states on one grid for the batch, errors, their floors, sensitivities.

    NaN and inf where there is no single periodic motion.
    """
    count, n = len(form.speed), form.system.size
    orbits: dict[int, tuple[int, Orbit]] = {}

    def tell(done: int) -> None:
        if tick is not None:
            tick(count + len(orbits) + done)

    for number in np.unique(first):
        group = np.flatnonzero((first == number) & single)
        for begin in range(0, len(group), _TOGETHER):
            part = group[begin : begin + _TOGETHER]
            found = periodic_orbits(form.take(part), int(number), rtol, tell)
            orbits.update(zip(part.tolist(), found, strict=True))
    wanted = max([2 ** int(np.ceil(np.log2(samples))), *(used for used, _ in orbits.values())])
    _check_memory(form, wanted)
    states = np.full((count, wanted, 2 * n), np.nan)
    error, floor = np.full((2, count, n), np.inf)
    sensitivity = np.full(count, np.inf)
    for place, (_, orbit) in orbits.items():
        states[place] = _resampled(orbit.states[0], wanted)
        error[place], floor[place] = orbit.error[0], orbit.floor[0]
        sensitivity[place] = orbit.sensitivity[0]
    return states, error, floor, sensitivity


def _resampled(values: Array, count: int) -> Array:
    """Return periodic samples ``(nt, m)`` on a finer even grid, by their Fourier series."""
    old = len(values)
    if old == count or not np.all(np.isfinite(values)):
        return values if old == count else np.full((count, values.shape[1]), np.nan)
    half = np.fft.rfft(values, axis=0)
    # The highest one stands for two, which the finer grid tells apart.
    half[-1] *= 0.5
    finer: Array = np.fft.irfft(half, n=count, axis=0) * (count / old)
    return finer


def _blocks(form: CanonicalForm, count: int) -> list[slice]:
    together = max(1, _BLOCK_FLOATS // (count * form.size**2))
    return [slice(k, k + together) for k in range(0, len(form.speed), together)]


def _slopes(form: CanonicalForm, theta: Array, states: Array) -> Array:
    """Return the time derivatives of q, ``(nb, nt, n)``, from the equation itself."""
    n = form.system.size
    out = np.empty((*states.shape[:2], n))
    for part in _blocks(form, len(theta)):
        own = form.take(part)
        rows = own.generator(theta)[..., :n, :-1]
        out[part] = (rows @ states[part][..., None])[..., 0]
    return out * (form.scale[:, None, :n] * form.speed[:, None, None])


def _checks(
    form: CanonicalForm, theta: Array, states: Array, error: Array, allowed: Array
) -> dict[str, Check]:
    worst = np.max(error, axis=-1, initial=0.0)
    known = np.flatnonzero(np.isfinite(worst))
    if not len(known):
        return {}
    ratio = error[known] / allowed[known]
    checks = {"converged": Check(float(np.max(ratio)), 1.0)}
    place = int(known[np.argmax(worst[known])])
    one = slice(place, place + 1)
    checks["residual"] = _residual(form.take(one), theta, states[one], float(worst[place]))
    return checks


def _residual(form: CanonicalForm, theta: Array, states: Array, error: float) -> Check:
    """Put the motion's Fourier series into the equation half-way between the angles.

    The series' derivative has nothing to do with the collocation.  Limit: an error of the highest
    harmonic kept, over the rate of the system.
    """
    count, m = states.shape[1:]
    waves = np.arange(count // 2 + 1) * (2 * np.pi / form.system.period)
    shift = np.exp(0.5j * waves * (theta[1] - theta[0]))[:, None]
    half = np.fft.rfft(states[0], axis=0) * shift
    half[-1] = 0.0
    between = np.fft.irfft(half, n=count, axis=0)
    slope = np.fft.irfft(1j * waves[:, None] * half, n=count, axis=0)
    generator = form.generator(theta + 0.5 * (theta[1] - theta[0]))[0]
    expected = (generator[:, :m, :m] @ between[..., None])[..., 0] + generator[:, :m, -1]
    size = np.max(np.abs(states)) * (waves[-1] + float(form.rate[0]))
    value = float(np.max(np.abs(slope - expected)) / size)
    return Check(value, 10 * error)


def _single(distance: Array, doubt: Array) -> Check:
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(doubt > 0, doubt / distance, 0.0)
    return Check(float(np.max(ratio, initial=0.0)), 1.0)


def _largest(system: LinearPeriodic, theta: Array, q: Array) -> float | None:
    """Return the largest deflection over the reference length; None where there are no shapes."""
    shapes = system.shapes(_PLACES, theta)
    if shapes is None:
        return None
    found = 0.0
    for one in q:
        if np.all(np.isfinite(one)):
            values = np.einsum("txn,tn->tx", shapes, one)
            found = max(found, float(np.max(np.abs(values))))
    return found


def warn_beyond(largest: float) -> None:
    """Warn whoever called the caller where a deflection over the length is beyond 5 %."""
    if largest > LINEAR_RANGE:
        warnings.warn(
            f"deflection reaches {largest:.3g} of the reference length; the linear equations "
            f"hold to about {LINEAR_RANGE}: leave out resonant speeds or add damping",
            LinearRangeWarning,
            stacklevel=3,
        )
