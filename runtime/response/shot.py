"""Steady states by multiple shooting, closed by orthogonal elimination: method ``shooting``."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.results import Check
from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm
from .checks import check_memory, nearness
from .request import Found, Request, resampled
from .shooting import Orbit, first_segments, periodic_orbits

Array = NDArray[np.float64]

_BLOCK_FLOATS = 4_000_000
# Motions found at a time, after which the progress bar moves.
_TOGETHER = 64
# Collocation maps, times the cube of their size, of half an hour or so.
_MOST_WORK = 3e10
# The first try and its refinement, in segments of the first.
_TRIES = 3
# Motions whose rates are found at a time.
_RATES = 2048


def by_shooting(request: Request) -> Found:
    """Return periodic motions by multiple shooting with collocation of order 16."""
    form = request.form
    first = first_segments(form)
    check_work(form, first)
    check_memory(form, max(request.samples, 2 * int(np.max(first))))
    multipliers = request.multipliers()
    count, n = len(form.speed), form.system.size
    distance, doubt = nearness(multipliers, count)
    if request.tick is not None:
        request.tick(count)
    states, error, floor, sensitivity = _orbits(request, first, doubt < distance)
    theta = even_angles(form.system.period, states.shape[1])
    scale = form.scale[:, None, :n]
    allowed = np.maximum(np.maximum(request.rtol, 4 * floor), 1e-11 * sensitivity[:, None])
    return Found(
        method="shooting, by Gauss-Legendre collocation of order 16",
        theta=theta,
        q=states[..., :n] * scale,
        slope=_slopes(form, theta, states) * scale,
        error=error,
        allowed=np.minimum(allowed, 1e-2),
        sensitivity=sensitivity,
        checks={"single": _single(distance, doubt)},
        multipliers=multipliers,
    )


def in_parts(form: CanonicalForm) -> list[CanonicalForm]:
    """Return a large batch in parts whose means over the period do not fill the memory."""
    count = len(form.speed)
    if count <= _RATES:
        return [form]
    return [form.take(slice(k, k + _RATES)) for k in range(0, count, _RATES)]


def work_of(form: CanonicalForm, first: NDArray[np.int64] | int) -> float:
    """Return the collocation maps that motions and multipliers need, times their size cubed."""
    # The multipliers resolve decays too.
    rates = [part.rate for part in in_parts(form)]
    resolved = np.maximum(np.concatenate(rates) * form.system.period / 3.0, first)
    return float(_TRIES * np.sum(first + resolved)) * form.size**3


def check_work(form: CanonicalForm, first: NDArray[np.int64]) -> None:
    """Refuse motions that would take too long, by the segments they begin with."""
    work = work_of(form, first)
    if work > _MOST_WORK:
        resolved = max(float(np.max(part.rate)) for part in in_parts(form)) * form.system.period / 3
        raise bad(
            "steady_state",
            f"{len(first)} motions of {form.system.size} modes, up to "
            f"{max(resolved, float(np.max(first))):.2g} segments each",
            f"at most {_MOST_WORK / work:.2g} of that",
            "give fewer speeds, higher ones, fewer modes, or less damping; or take "
            "method='harmonic_balance'",
        )


def _orbits(
    request: Request, first: NDArray[np.int64], single: NDArray[np.bool_]
) -> tuple[Array, Array, Array, Array]:
    """Return scaled states on one grid for the batch, errors, their floors, sensitivities.

    NaN and inf where there is no single periodic motion.
    """
    form, tick = request.form, request.tick
    count, n = len(form.speed), form.system.size
    orbits: dict[int, tuple[int, Orbit]] = {}
    for number in np.unique(first):
        group = np.flatnonzero((first == number) & single)
        for begin in range(0, len(group), _TOGETHER):
            part = group[begin : begin + _TOGETHER]
            tell = None if tick is None else _told(tick, count + len(orbits))
            found = periodic_orbits(form.take(part), int(number), request.rtol, tell)
            orbits.update(zip(part.tolist(), found, strict=True))
    least = 2 ** int(np.ceil(np.log2(request.samples)))
    wanted = max([least, *(used for used, _ in orbits.values())])
    check_memory(form, wanted)
    states = np.full((count, wanted, 2 * n), np.nan)
    error, floor = np.full((2, count, n), np.inf)
    sensitivity = np.full(count, np.inf)
    for place, (_, orbit) in orbits.items():
        states[place] = resampled(orbit.states[0], wanted)
        error[place], floor[place] = orbit.error[0], orbit.floor[0]
        sensitivity[place] = orbit.sensitivity[0]
    return states, error, floor, sensitivity


def _told(tick: Callable[[int], None], before: int) -> Callable[[int], None]:
    def tell(done: int) -> None:
        tick(before + done)

    return tell


def _slopes(form: CanonicalForm, theta: Array, states: Array) -> Array:
    """Return q' over its scale, ``(nb, nt, n)``, from the equation itself."""
    n = form.system.size
    out = np.empty((*states.shape[:2], n))
    together = max(1, _BLOCK_FLOATS // (len(theta) * form.size**2))
    for begin in range(0, len(form.speed), together):
        part = slice(begin, begin + together)
        rows = form.take(part).generator(theta)[..., :n, :-1]
        out[part] = (rows @ states[part][..., None])[..., 0]
    return out


def _single(distance: Array, doubt: Array) -> Check:
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(doubt > 0, doubt / distance, 0.0)
    return Check(float(np.max(ratio, initial=0.0)), 1.0)
