"""Steady state: the periodic motion of a forced linear periodic system at constant crank speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.deferred import DeferredGroup
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import numbers
from ..core.progress import bar
from ..core.results import Check, provenance
from ..periodic import FloquetMultipliers, floquet_multipliers
from ..periodic.decoupled.exponents import SlowMultipliers, characteristic_exponents
from ..periodic.first_order import CanonicalForm, canonical_form
from ..simulation.trajectory import LINEAR_RANGE
from .checks import (
    check_forcing,
    check_memory,
    checks_of,
    largest_deflection,
    nearness,
    warn_beyond,
)
from .closed_form import by_closed_form
from .collocation import by_cyclic_system
from .harmonic_balance import by_harmonic_balance
from .modal import by_modes
from .request import Found, Request
from .result import SteadyState
from .settling import by_marching
from .shot import by_shooting, work_of
from .transition import by_transition_matrix

if TYPE_CHECKING:
    from concurrent.futures import Executor

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 256
_MOST_SAMPLES = 2**20
# Work of the multipliers, in collocation maps times the cube of their size, that an answer by
# another method waits for unasked: some seconds.
_UNASKED_WORK = 1e8
# Work from which on the multipliers of a stiff system's slow modes alone are found: a minute.
_ASKED_WORK = 1e9


@dataclass(frozen=True)
class _Method:
    """A method, the error that it is asked for unless told otherwise, and what it can be told."""

    solve: Callable[[Request], Found]
    rtol: float
    options: tuple[str, ...] = ()


_STEPS = ("intervals", "scheme", "gamma", "beta", "rho_inf")
_METHODS: Mapping[str, _Method] = {
    "shooting": _Method(by_shooting, 1e-9),
    "harmonic_balance": _Method(by_harmonic_balance, 1e-9, ("harmonics",)),
    "cyclic": _Method(by_cyclic_system, 1e-9, _STEPS),
    "transition_matrix": _Method(by_transition_matrix, 1e-3, _STEPS),
    "closed_form": _Method(by_closed_form, 1e-3, ("intervals", "gamma", "beta")),
    "modal": _Method(by_modes, 1e-2, ("intervals", "modes")),
    "time_marching": _Method(by_marching, 1e-3, (*_STEPS, "tolerance", "most_cycles", "initial")),
}
METHODS = tuple(_METHODS)
# Fields of the result that multipliers tell.
_STABILITY = ("multipliers", "stable", "distance")


def steady_state(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    method: str | None = None,
    rtol: float | None = None,
    samples: int = _FEWEST_SAMPLES,
    stability: bool | None = None,
    options: Mapping[str, object] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    **parameters: ArrayLike,
) -> SteadyState:
    """Return the periodic motion of a forced linear periodic system.

    With y = (q, p = M q' + A q) and y' = L y + g, the flow of one period is y -> X y + z; the
    periodic motion starts from ``(I - X) y = z``.

    Parameters
    ----------
    system : LinearPeriodic
        The system, with forcing f, h or p.
    speed : array_like
        Crank speeds w [rad/s], positive.
    method : str, optional
        By default ``"cyclic"`` of a structure of beams, whose axial modes are far too fast to be
        followed, otherwise ``"shooting"``.
        ``"shooting"``: segments short enough for the highest mode, each by Gauss-Legendre
        collocation of order 16, the ring of their maps closed by orthogonal elimination, so that
        neither growth nor strong damping spoils it.
        ``"harmonic_balance"``: the Fourier series of motion and coefficients, as many harmonics
        as the motion has (Aannaque 6.13, 6.14, with every coefficient's series); for stiff
        systems, whose high modes the motion does not excite.  From six freedoms on the balance of
        the slow modes steers that of all, where there are such modes: the fastest method then.
        ``"cyclic"``: the cyclic system (Aannaque 6.22) of a one-step scheme, solved by orthogonal
        elimination; as few intervals as the motion needs.
        ``"transition_matrix"``: Aannaque's algorithm 1 (6.15)-(6.19).
        ``"closed_form"``: his algorithm 2 as printed (6.20)-(6.25), by products of inverses of
        contracting maps: round-off grows with the intervals, and no answer is given where it has
        grown too large.
        ``"modal"``: modes of each interval, uncoupled, constant within it (Midha; Aannaque 6.12).
        ``"time_marching"``: revolution after revolution until the motion repeats.
    rtol : float, optional
        Wanted error of each coordinate over its own peak, 1e-12 to 1e-2; by default 1e-9, of
        ``transition_matrix``, ``closed_form`` and ``time_marching`` 1e-3, of ``modal`` 1e-2.  Near
        a resonance round-off may keep it from being reached: see ``error``.
    samples : int
        Least number of crank angles that are given; rounded up to a power of two, and raised
        where the motion needs more.  With ``intervals`` their ends are given instead.
    stability : bool, optional
        Whether the multipliers are computed; of a stiff system those of its slow modes, and that
        no fast mode grows (check ``fast modes``).  By default where the method needs them
        (``shooting``), and where they cost little, once they are looked at; where they are left
        out unasked the check ``stability not computed`` fails.
    options : mapping, optional
        More for a method.  ``harmonics``: a fixed number of them.  ``intervals``: a fixed number
        of intervals (``modal``: 256).  ``scheme``: of ``cyclic`` ``"radau"`` (order 15, the
        default), ``"gauss_legendre"`` (order 16), ``"newmark"`` or ``"generalized_alpha"``; of
        ``time_marching`` and ``transition_matrix`` one of the last two, Newmark's the default;
        ``closed_form`` is Newmark's.  ``gamma``, ``beta``: Newmark's, 1/2 and 1/4.  ``rho_inf``:
        of generalized-alpha, 0.9.  ``modes``: how many are kept.  ``tolerance``: change in a
        revolution, over the peak, at which a march has settled, 1e-4.  ``most_cycles``: 1000.
        ``initial``: pair of q and qd to march from.
    executor : concurrent.futures.Executor, optional
        Threads, processes or Dask's ``client.get_executor()``, for fixed pieces of the batch: the
        answer does not depend on which, nor on the number of workers.
    progress : bool
        Whether to show a progress bar (extra ``progress``).
    **parameters : array_like
        Parameter values that replace the system's own; they broadcast with ``speed``.

    Returns
    -------
    SteadyState
        Its checks: ``converged``, the error at the worst place over what was asked or what
        round-off allows there; ``single``, the error of the multiplier closest to 1 over its
        distance, or round-off times the condition of the equations, at the worst place: beyond 1
        no single periodic motion is told apart there, and q is NaN; ``residual``, of the equation
        between the angles at the place of the largest error; ``linear range``, the largest
        deflection over the reference length; of marching ``growth``, the factor per revolution
        of what is left of the start: beyond 1 the march leaves the periodic motion.

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
    asked: dict[str, Any] = {"method": method, "rtol": rtol, "samples": samples}
    asked |= {"stability": stability, "options": options}
    if executor is None:
        found = without_warning(system, speed, asked, parameters, progress=progress)
    else:
        from ..sweeps.batches import steady_in_pieces

        found = steady_in_pieces(system, speed, parameters, asked, executor, progress=progress)
    if "linear range" in found.checks:
        warn_beyond(found.checks["linear range"].value)
    return found


def without_warning(
    system: LinearPeriodic,
    speed: ArrayLike,
    asked: Mapping[str, Any],
    parameters: Mapping[str, ArrayLike],
    *,
    progress: bool = False,
) -> SteadyState:
    """Return what :func:`steady_state` does, which alone warns where the linear range is left.

    Parameters
    ----------
    system, speed, parameters, progress
        Its own.
    asked : mapping
        Its ``method``, ``rtol``, ``samples``, ``stability`` and ``options``, all of them.

    Raises
    ------
    BadInput
        As it does.
    """
    method, rtol, samples = asked["method"], asked["rtol"], asked["samples"]
    stability = asked["stability"]
    told = dict(asked["options"] or {})
    chosen = _chosen(_method_for(system, method), rtol, samples, told)
    if not numbers("speed", speed).size:
        raise bad("speed", "no speed at all", "at least one speed [rad/s]", "give some")
    form = canonical_form(system, speed, parameters, forcing=True)
    check_forcing(form)
    check_memory(form, int(samples))
    count = len(form.speed)
    wanted = chosen.rtol if rtol is None else float(rtol)
    given: dict[str, Any] = dict(parameters)
    find = partial(floquet_multipliers, system, speed, rtol=1e-11, **given)
    slow = partial(characteristic_exponents, system, speed, **given)
    with bar(progress, 2 * count) as tick:
        found = chosen.solve(Request(form, wanted, int(samples), told, find, tick))
        multipliers = found.multipliers
        later = multipliers is None and stability is None and work_of(form, 0) <= _UNASKED_WORK
        if multipliers is None and not later:
            multipliers = _multipliers(form, stability, find, slow)
        if tick is not None:
            tick(2 * count)
    checks = checks_of(form, found)
    if multipliers is None and not later:
        # A failing check where the stability was left open without being told to.
        checks["stability not computed"] = Check(np.nan if stability is None else 0.0, 0.0)
    elif isinstance(multipliers, SlowMultipliers):
        # Of the modes left out, that none of them grows.
        checks["fast modes"] = multipliers.checks["fast"]
    largest = largest_deflection(system, found.theta, found.q)
    if largest is not None:
        checks["linear range"] = Check(largest, LINEAR_RANGE)
    told_by = find if later else partial(_itself, multipliers)
    group = DeferredGroup(partial(_stability, told_by, form.batch))
    # Of those at hand nothing is put off.
    values = {name: group.later(name) if later else group.value(name) for name in _STABILITY}
    return _assembled(found, values, checks, form, parameters)


def _itself(multipliers: FloquetMultipliers | None) -> FloquetMultipliers | None:
    return multipliers


def _stability(
    find: Callable[[], FloquetMultipliers | None], batch: tuple[int, ...]
) -> dict[str, Any]:
    """Return multipliers, stability and distance of a batch of motions."""
    multipliers = find()
    if multipliers is None:
        return {"multipliers": None, "stable": None, "distance": np.full(batch, np.nan)}
    return {
        "multipliers": multipliers.multipliers,
        "stable": np.asarray(multipliers.stable),
        "distance": nearness(multipliers, int(np.prod(batch)))[0].reshape(batch),
    }


def _assembled(
    found: Found,
    stability: Mapping[str, Any],
    checks: Mapping[str, Check],
    form: CanonicalForm,
    parameters: Mapping[str, ArrayLike],
) -> SteadyState:
    _, nt, n = found.q.shape
    system, speed, batch = form.system, form.speed, form.batch
    return SteadyState(
        method=found.method,
        error=found.error.reshape(*batch, n),
        error_norm="largest error of a coordinate over its own peak",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=speed.reshape(batch),
        theta=found.theta,
        q=found.q.reshape(*batch, nt, n),
        qd=(found.slope * speed[:, None, None]).reshape(*batch, nt, n),
        **stability,
        sensitivity=found.sensitivity.reshape(batch),
        period=system.period,
        labels=system.labels,
        reference_length=system.reference_length,
        shapes=system.shapes,
        cycles=None if found.cycles is None else found.cycles.reshape(batch),
    )


def _multipliers(
    form: CanonicalForm,
    stability: bool | None,
    find: Callable[[], FloquetMultipliers],
    slow: Callable[[], SlowMultipliers],
) -> FloquetMultipliers | None:
    """Return the multipliers where they are wanted, of a stiff system those of its slow modes."""
    if stability is False:
        return None
    work = work_of(form, 0)
    if work <= _UNASKED_WORK:
        return find()
    if stability is None:
        return None
    return find() if work <= _ASKED_WORK else slow()


def _method_for(system: LinearPeriodic, method: str | None) -> str:
    """Return the method asked for, or the one that suits the system."""
    if method is not None:
        return method
    return "shooting" if system.structure is None else "cyclic"


def _chosen(
    method: str, rtol: float | None, samples: int, options: Mapping[str, object]
) -> _Method:
    """Return the method; refuse arguments that are unusable."""
    if method not in _METHODS:
        raise bad("method", repr(method), f"one of {METHODS}", "choose 'harmonic_balance'")
    chosen = _METHODS[method]
    if rtol is not None and not (isinstance(rtol, Real) and 1e-12 <= rtol <= 1e-2):
        raise bad("rtol", repr(rtol), "a number from 1e-12 to 1e-2", "choose 1e-9")
    whole = isinstance(samples, Real) and 1 <= samples <= _MOST_SAMPLES and samples % 1 == 0
    if not whole:
        fix = "choose 256"
        raise bad("samples", repr(samples), f"a whole number from 1 to {_MOST_SAMPLES}", fix)
    unknown = sorted(set(options) - set(chosen.options))
    if unknown:
        expected = f"some of {chosen.options}" if chosen.options else "none"
        raise bad(f"options of {method}", unknown, expected, "leave them out")
    return chosen
