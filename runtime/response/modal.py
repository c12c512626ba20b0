"""Steady states by uncoupled modes at each angle, (6.12), after Midha: method ``modal``.

The period is cut into intervals of constant coefficients; in each the equations are taken apart by
the modes of M and the stiffness there, what damping and gyroscopic terms couple is left out, and
each mode is solved exactly.  Displacement and velocity go on from interval to interval, and close.
What is neglected does not vanish with the intervals: the error is the difference to the motion of
the whole equation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.results import Check
from ..core.trigonometric import even_angles
from ..integrators.expm import expm
from ..periodic.first_order import CanonicalForm
from ..periodic.ring import solve_ring
from ..simulation.second_order import even_count, second_order
from .harmonic_balance import by_harmonic_balance
from .request import Found, Request, peaks, resampled, whole_option

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_INTERVALS = 256
_MOST = 2**14
_REFERENCE = 1e-6


def by_modes(request: Request) -> Found:
    """Return periodic motions by uncoupled modes in each interval."""
    form, n = request.form, request.form.system.size
    given = whole_option(request.options, "intervals", 4, _MOST)
    intervals = _INTERVALS if given is None else given
    kept = whole_option(request.options, "modes", 1, n)
    modes = n if kept is None else kept
    whole = by_harmonic_balance(replace(request, rtol=_REFERENCE, options={}))
    q, slope = (np.empty((len(form.speed), intervals, n)) for _ in range(2))
    sensitivity = np.empty(len(form.speed))
    errors = np.empty((len(form.speed), n))
    for place in range(len(form.speed)):
        one = form.take(slice(place, place + 1))
        maps, loads = modal_maps(one, intervals, modes)
        nodes, spread = solve_ring(maps[None], loads[None])
        q[place], slope[place] = nodes[0, :, :n], nodes[0, :, n:]
        sensitivity[place] = spread[0]
        exact = _at(whole.q[place], intervals)
        gap = np.max(np.abs(q[place] - exact), axis=0) / peaks(exact)
        # Between the angles both are somewhat larger.
        errors[place] = 1.02 * gap + whole.error[place]
    single = whole.checks["single"].value
    doubt = _EPS * np.where(np.isfinite(sensitivity), sensitivity, 1 / _EPS)
    lost = ~np.isfinite(errors).all(axis=1) | (16 * doubt >= 1.0)
    q[lost], slope[lost], errors[lost], sensitivity[lost] = np.nan, np.nan, np.inf, np.inf
    return Found(
        method=f"{modes} of {n} modes at {intervals} angles, uncoupled, against harmonic balance",
        theta=even_angles(form.system.period, intervals),
        q=q,
        slope=slope,
        error=errors,
        allowed=np.full_like(errors, request.rtol),
        sensitivity=sensitivity,
        checks={"single": Check(max(16 * float(np.max(doubt)), single), 1.0)},
    )


def _at(values: Array, count: int) -> Array:
    """Return the samples of a smooth periodic motion at fewer or more even angles."""
    if not np.all(np.isfinite(values)):
        return np.full((count, values.shape[1]), np.nan)
    times = -(-len(values) // count)
    return resampled(values, times * count)[::times]


def modal_maps(form: CanonicalForm, intervals: int, modes: int) -> tuple[Array, Array]:
    """Return maps and loads of the intervals on (q, q'), of a batch of one.

    Parameters
    ----------
    form : CanonicalForm
        The system.
    intervals : int
        Number of intervals N; coefficients are those at their middles.
    modes : int
        How many of the lowest modes are kept.

    Raises
    ------
    BadInput
        If a mass matrix is not positive definite.
    """
    n = form.system.size
    every = -(-even_count(form.system) // (2 * intervals))
    found = second_order(form, 2 * intervals * every, every)
    mass, rate, stiffness, force = (
        np.broadcast_to(a[0], (2 * intervals, *a.shape[2:]))[1::2]
        for a in (found.mass, found.rate, found.stiffness, found.force)
    )
    try:
        factor = np.linalg.inv(np.linalg.cholesky(mass))
    except np.linalg.LinAlgError as indefinite:
        raise bad("mass matrix M", "not positive definite", "a mass", "check it") from indefinite
    turned = np.swapaxes(factor, -1, -2)
    even = 0.5 * (stiffness + np.swapaxes(stiffness, -1, -2))
    squares, vectors = np.linalg.eigh(factor @ even @ turned)
    shapes = (turned @ vectors)[..., :modes]
    squares = squares[:, :modes]
    drag = np.einsum("kri,krc,kci->ki", shapes, rate, shapes)
    push = np.einsum("kri,kr->ki", shapes, force)
    ahead = _one_freedom(squares, drag, push, form.system.period / intervals)
    back = np.swapaxes(shapes, -1, -2) @ mass
    maps = np.empty((intervals, 2 * n, 2 * n))
    loads = np.empty((intervals, 2 * n))
    for i in range(2):
        rows = slice(i * n, (i + 1) * n)
        loads[:, rows] = np.einsum("kri,ki->kr", shapes, ahead[..., i, 2])
        for j in range(2):
            columns = slice(j * n, (j + 1) * n)
            maps[:, rows, columns] = (shapes * ahead[:, None, :, i, j]) @ back
    return maps, loads


def _one_freedom(squares: Array, drag: Array, push: Array, step: float) -> Array:
    """Return the exact steps of ``x'' + drag x' + square x = push`` on (x, x', 1)."""
    generator = np.zeros((*squares.shape, 3, 3))
    generator[..., 0, 1] = step
    generator[..., 1, 0], generator[..., 1, 1] = -step * squares, -step * drag
    generator[..., 1, 2] = step * push
    # A like size of displacement and velocity keeps the squarings few.
    size = np.sqrt(np.maximum(np.abs(squares), 1.0))
    scale = np.stack([1 / size, np.ones_like(size), np.ones_like(size)], axis=-1)
    own = generator / scale[..., :, None] * scale[..., None, :]
    steps: Array = expm(own) * scale[..., :, None] / scale[..., None, :]
    return steps
