"""Aannaque's algorithms of chapter 6: Newmark's steps, uncoupled modes, the transition matrix.

They are redrawn, not recommended: :func:`~..periodic.steady_state` is what the library solves with.
"""

from __future__ import annotations

import numpy as np

from ..core.families import Array, LinearPeriodic
from ..core.trigonometric import differentiated, even_angles
from ..periodic.ring import solve_ring
from .historic_steps import newmark_matrices


def second_order_form(
    system: LinearPeriodic, speed: float, count: int
) -> tuple[Array, Array, Array, Array]:
    """Return M, G, H ``(nt, n, n)`` and F ``(nt, n)`` at even angles: ``M q'' + G q' + H q = F``.

    With ' = d/dtheta, ``G = M' + A - A^T + C/w``, ``H = A' - B + (K + Kg)/w^2 + D/w`` and
    ``F = f + h/w + p/w^2``.
    """
    theta, period = even_angles(system.period, count), system.period

    def at(name: str) -> Array:
        return system.array(name, theta, speed)

    mass, gyro = at("M"), at("A")
    rate = differentiated(mass, period) + gyro - np.swapaxes(gyro, -1, -2) + at("C") / speed
    stiffness = differentiated(gyro, period) - at("B") + at("D") / speed
    stiffness += (at("K") + at("Kg")) / speed**2
    return mass, rate, stiffness, at("f") + at("h") / speed + at("p") / speed**2


def newmark_maps(system: LinearPeriodic, speed: float, intervals: int) -> tuple[Array, Array]:
    """Return maps ``(N, 2n, 2n)`` and loads ``(N, 2n)`` on (q, q') of Newmark's steps (6.5)."""
    arrays = second_order_form(system, speed, intervals)
    mass, rate, stiffness, force = (np.concatenate([array, array[:1]]) for array in arrays)
    return newmark_matrices(mass, rate, stiffness, force, system.period / intervals)


def transition_nodes(maps: Array, loads: Array) -> Array:
    """Return the states of a period by its transition matrix, algorithm 1, (6.15)-(6.19).

    The period is passed through from the unit matrix and from rest at once, which gives R and
    y_c(T); ``y_s(0) = (I - R)^-1 y_c(T)`` (6.18); and once more from there.
    """
    m = loads.shape[1]
    whole = np.concatenate([np.eye(m), np.zeros((m, 1))], axis=1)
    for matrix, load in zip(maps, loads, strict=True):
        whole = matrix @ whole
        whole[:, -1] += load
    nodes = np.empty_like(loads)
    state = np.linalg.solve(np.eye(m) - whole[:, :-1], whole[:, -1])
    for k, (matrix, load) in enumerate(zip(maps, loads, strict=True)):
        nodes[k] = state
        state = matrix @ state + load
    return nodes


def modal_motion(system: LinearPeriodic, speed: float, intervals: int, modes: int) -> Array:
    """Return q ``(N, n)`` at even angles by uncoupled modes of each interval, (6.12), after Midha.

    In each interval of constant coefficients the lowest modes of M and the stiffness are solved
    exactly; what damping and gyroscopic terms couple is left out.  Displacement and velocity go on
    from interval to interval, and close.
    """
    n = system.size
    middles = (part[1::2] for part in second_order_form(system, speed, 2 * intervals))
    mass, rate, stiffness, force = middles
    factor = np.linalg.inv(np.linalg.cholesky(mass))
    back = np.swapaxes(factor, -1, -2)
    even = 0.5 * (stiffness + np.swapaxes(stiffness, -1, -2))
    squares, vectors = np.linalg.eigh(factor @ even @ back)
    shapes = (back @ vectors)[..., :modes]
    drag = np.einsum("kri,krc,kci->ki", shapes, rate, shapes)
    push = np.einsum("kri,kr->ki", shapes, force)
    ahead = _oscillator_steps(squares[:, :modes], drag, push, system.period / intervals)
    momenta = np.swapaxes(shapes, -1, -2) @ mass
    # Blocks of q and q' from q and q', and from the load.
    maps = np.einsum("kri,kiab,kic->karbc", shapes, ahead[..., :2, :2], momenta)
    loads = np.einsum("kri,kia->kar", shapes, ahead[..., :2, 2])
    nodes, _ = solve_ring(
        maps.reshape(1, intervals, 2 * n, 2 * n), loads.reshape(1, intervals, 2 * n)
    )
    return nodes[0, :, :n]


def _oscillator_steps(squares: Array, drag: Array, push: Array, step: float) -> Array:
    """Return the exact steps of ``x'' + drag x' + square x = push`` on (x, x', 1)."""
    from scipy.linalg import expm

    generator = np.zeros((*squares.shape, 3, 3))
    generator[..., 0, 1] = step
    generator[..., 1, 0], generator[..., 1, 1] = -step * squares, -step * drag
    generator[..., 1, 2] = step * push
    # A like size of displacement and velocity keeps the squarings few.
    size = np.sqrt(np.maximum(np.abs(squares), 1.0))
    scale = np.stack([1 / size, np.ones_like(size), np.ones_like(size)], axis=-1)
    scaled = generator / scale[..., :, None] * scale[..., None, :]
    return np.asarray(expm(scaled) * scale[..., :, None] / scale[..., None, :])
