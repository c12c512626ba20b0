"""The documents' algorithms: one-step methods, uncoupled modes, operations of each.

De Vogelaere's and Kutta and Merson's steps are Smith's, Newmark's and all that follows Aannaque's
(chapter 6).  They are redrawn, not recommended: :func:`~..periodic.steady_state` and
:func:`~..periodic.simulate` are what the library solves with.

Operations: an addition or a multiplication is one, a product of matrices ``(a, b) (b, c)`` takes
``(2 b - 1) a c``, a triangular decomposition ``(4 n^3 - 3 n^2 - n)/6``, each solution with it
``2 n^2 - n``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import expm

from ..core.families import Array, LinearPeriodic
from ..core.trigonometric import differentiated, even_angles
from ..periodic.ring import solve_ring

Generator = Callable[[Array], Array]


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


def de_vogelaere_maps(generator: Generator, theta: Array, half_step: float) -> Array:
    """Return de Vogelaere's steps of ``y'' = P(theta) y`` as matrices (Smith, appendix 4).

    With h the *half* step, the values of y'' = f(theta, y) at -h, 0, h and 2h are used:

        y(h)   = y(0) + h y'(0) + h^2/6 (4 f(0) - f(-h)),
        y(2h)  = y(0) + 2h y'(0) + h^2/3 (2 f(0) + 4 f(h)),
        y'(2h) = y'(0) + h/3 (f(0) + 4 f(h) + f(2h)),

    and f(h) serves the next step as its f(-h).  From P ``(nt, n, n)`` at angles, the left ends
    ``(ns,)`` of the steps and h to matrices ``(ns, 3 n, 3 n)`` on (y, h y', h^2 f(-h)); forcing
    enters as a last component of y that stays 1.
    """
    angles = theta[:, None] + half_step * np.arange(3.0)
    values = half_step**2 * generator(angles.ravel())
    n = values.shape[-1]
    f0, f1, f2 = np.moveaxis(values.reshape(len(theta), 3, n, n), 1, 0)
    y, slope, past = np.eye(3 * n).reshape(3, n, 3 * n)
    start = f0 @ y
    middle = f1 @ (y + slope + (4 * start - past) / 6)
    end = y + 2 * slope + (2 * start + 4 * middle) / 3
    end_slope = slope + (start + 4 * middle + f2 @ end) / 3
    return np.concatenate([end, end_slope, middle], axis=-2)


def de_vogelaere_start(
    generator: Generator, theta: float, half_step: float, y: Array, slope: Array
) -> Array:
    """Return the first state ``(3 n,)`` of de Vogelaere's method from y and y' at an angle.

    The value at -h comes from the Taylor polynomial y - h y' + h^2/2 y''; its third-order error
    leaves the order of the method at four.
    """
    before, here = generator(np.array([theta - half_step, theta]))
    past = y - half_step * slope + half_step**2 / 2 * (here @ y)
    return np.concatenate([y, half_step * slope, half_step**2 * (before @ past)])


def kutta_merson(
    generator: Generator, theta: Array, state: Array, rtol: float, atol: Array, *, first: float
) -> Array:
    """Integrate ``y' = L(theta) y`` with steps chosen by Merson's estimate of the local error.

    From a state ``(m,)`` at the first of the output's angles, on all of which steps end, to the
    states ``(nt, m)`` at them; with the relative and absolute tolerance ``(m,)`` of one step, and
    the first step to try.
    """
    states = [state]
    step, here = first, float(theta[0])
    for target in theta[1:]:
        while here < target:
            remaining = float(target) - here
            pieces = max(1, int(np.ceil(remaining / step * (1 - 1e-12))))
            trial = remaining / pieces
            new, estimate = merson_step(generator, here, trial, state)
            allowed = atol + rtol * np.maximum(np.abs(state), np.abs(new))
            ratio = float(np.max(np.abs(estimate) / allowed))
            proposal = trial * min(4.0, max(0.1, 0.9 * max(ratio, 1e-10) ** -0.2))
            if ratio > 1.0:
                step = proposal
                continue
            here = float(target) if pieces == 1 else here + trial
            state = new
            # A step cut short to meet the angle says little about how long the next may be.
            step = proposal if ratio > 0.5 else max(step, proposal)
        states.append(state)
    return np.array(states)


def merson_step(
    generator: Generator, here: float, step: float, state: Array
) -> tuple[Array, Array]:
    """Return the new state and Merson's estimate of the local error of one step.

    The estimate is a fifth of the difference between the two solutions of the pair.  With constant
    coefficients it is the local error to leading order; else the second solution is of order three
    only, and the estimate is larger than the error.
    """
    nodes = here + step * np.array([0.0, 1 / 3, 1 / 2, 1.0])
    first, third, half, last = generator(nodes)
    k1 = first @ state
    k2 = third @ (state + step / 3 * k1)
    k3 = third @ (state + step / 6 * (k1 + k2))
    k4 = half @ (state + step / 8 * (k1 + 3 * k3))
    k5 = last @ (state + step / 2 * (k1 - 3 * k3 + 4 * k4))
    new = state + step / 6 * (k1 + 4 * k4 + k5)
    return new, step / 30 * (2 * k1 - 9 * k3 + 8 * k4 - k5)


def newmark_matrices(
    mass: Array,
    rate: Array,
    stiffness: Array,
    force: Array,
    step: float,
    *,
    gamma: float = 0.5,
    beta: float = 0.25,
) -> tuple[Array, Array]:
    """Return Newmark's steps of ``M q'' + G q' + H q = F`` as matrices (Aannaque 6.5).

    Displacement and velocity at the end of a step come from accelerations at both ends,

        q+ = q + h v + h^2 ((1/2 - beta) a + beta a+),   v+ = v + h ((1 - gamma) a + gamma a+).

    From M, G, H ``(N + 1, n, n)`` and F ``(N + 1, n)`` at the ends of the steps to matrices
    ``(N, 2n, 2n)`` on the state (q, q') and what the force adds, ``(N, 2n)``.
    """
    n, count = mass.shape[-1], len(mass) - 1
    # Columns: what multiplies q, q' and 1 at the start of a step.
    right = np.concatenate([-stiffness, -rate, force[..., None]], axis=-1)
    a = np.linalg.solve(mass[:-1], right[:-1])
    q, v = np.broadcast_to(np.eye(2 * n, 2 * n + 1).reshape(2, 1, n, -1), (2, count, n, 2 * n + 1))
    q = q + step * v + (0.5 - beta) * step**2 * a
    v = v + (1.0 - gamma) * step * a
    load = -(rate[1:] @ v + stiffness[1:] @ q)
    load[..., -1] += force[1:]
    system = mass[1:] + gamma * step * rate[1:] + beta * step**2 * stiffness[1:]
    new = np.linalg.solve(system, load)
    whole = np.concatenate([q + beta * step**2 * new, v + gamma * step * new], axis=1)
    return whole[..., :-1], whole[..., -1]


def newmark_maps(system: LinearPeriodic, speed: float, intervals: int) -> tuple[Array, Array]:
    """Return maps ``(N, 2n, 2n)`` and loads ``(N, 2n)`` on (q, q') of Newmark's steps (6.5)."""
    arrays = second_order_form(system, speed, intervals)
    mass, rate, stiffness, force = (np.concatenate([array, array[:1]]) for array in arrays)
    return newmark_matrices(mass, rate, stiffness, force, system.period / intervals)


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
    generator = np.zeros((*squares.shape, 3, 3))
    generator[..., 0, 1] = step
    generator[..., 1, 0], generator[..., 1, 1] = -step * squares, -step * drag
    generator[..., 1, 2] = step * push
    # A like size of displacement and velocity keeps the squarings few.
    size = np.sqrt(np.maximum(np.abs(squares), 1.0))
    scale = np.stack([1 / size, np.ones_like(size), np.ones_like(size)], axis=-1)
    scaled = generator / scale[..., :, None] * scale[..., None, :]
    return np.asarray(expm(scaled) * scale[..., :, None] / scale[..., None, :])


def newmark_limit(gamma: ArrayLike, beta: ArrayLike) -> Array:
    """Return the largest stable phase ``omega h`` of an undamped step; parameters broadcast.

    By Routh's margins of a step (Aannaque (6.9)-(6.11)) a pair of multipliers leaves the unit
    circle where gamma < 1/2, a real one passes -1 where ``2 + (2 beta - gamma) p^2`` is negative.
    Infinite where no step is too long, 0 where none is short enough.
    """
    g, b = np.broadcast_arrays(np.asarray(gamma, dtype=float), np.asarray(beta, dtype=float))
    with np.errstate(divide="ignore"):
        flip = np.sqrt(2.0 / np.maximum(g - 2.0 * b, 0.0))
    return np.where(g < 0.5, 0.0, flip)


def printed_count(
    algorithm: str,
    intervals: int,
    freedoms: int,
    cycles: int = 1,
    *,
    harmonics: int = 1,
    storage: bool = True,
) -> int:
    """Return the number of operations by the printed formula of an algorithm.

    ``time_marching``, ``transition_matrix`` (algorithm 1), ``closed_form`` (algorithm 2) or
    ``harmonic_balance`` (the Fourier series analysis); N intervals and n freedoms, n_c cycles
    marched, N_h harmonics; ``storage`` of the intervals' matrices or not.
    """
    # Python's integers, as the numbers of operations may pass those of an array.
    big, n, c, h = int(intervals), int(freedoms), int(cycles), harmonics
    tail = 14 * n**3 + 21 * n**2
    formulas = {
        ("time_marching", True): big * (22 * n**3 + (29 + 4 * c) * n**2 + (3 + 2 * c) * n),
        ("time_marching", False): big * c * (22 * n**3 + 33 * n**2 + 5 * n),
        ("transition_matrix", True): big * (38 * n**3 + 37 * n**2 + 7 * n) + 16 * n**3 + 8 * n**2,
        ("transition_matrix", False): big * (78 * n**3 + 77 * n**2 + 10 * n) - tail - 3 * n,
        ("closed_form", True): big * (62 * n**3 + 37 * n**2 + 9 * n)
        + (8 * n**3 + 8 * n**2 + 2 * n),
        ("closed_form", False): big * (102 * n**3 + 87 * n**2 + 10 * n) - tail - n,
    }
    fourier = (
        h**3 * (8 * n**3 + 32 * n**2)
        + h**2 * (12 * n**3 - 120 * n**2 + 8 * n + 32)
        + h * (6 * n**3 + 270 * n**2 + 10 * n + 4 * n * big)
        + (n**3 - 135 * n**2 + 4 * n)
    )
    formulas[("harmonic_balance", True)] = fourier
    return formulas[(algorithm, storage)]


def operation_count(
    algorithm: str, intervals: int, freedoms: int, cycles: int = 1, *, storage: bool = True
) -> int:
    """Return the operations of one of the algorithms but the last, counted from its steps.

    As for the printed formulas the coefficients of the equation are given at all angles.
    """
    n, m = freedoms, 2 * freedoms
    # Marching takes its steps in each revolution anew where they are not kept, algorithm 1 in
    # both of its revolutions, algorithm 2 in the sum and in the recursion.
    passes = 1 if storage else {"time_marching": cycles}.get(algorithm, 2)
    # The map of a step as newmark_matrices takes it: q'' at the left end, then q and v without the
    # new acceleration; M + gamma h G + beta h^2 H and the right-hand side; the new acceleration.
    wide = 2 * n + 1
    left = new = _solve(n, wide) + 4 * n * wide
    middle = 4 * n * n + 2 * _product(n, n, wide) + n * wide + n
    steps = passes * intervals * (left + middle + new)
    once = _product(m, m, 1) + m
    if algorithm == "time_marching":
        return steps + cycles * intervals * once
    # The transition matrix with its load, the start, the recursion.
    ends = intervals * (_product(m, m, m + 1) + m + once) + m + _solve(m, 1)
    inverses = passes * intervals * _solve(m, m) if algorithm == "closed_form" else 0
    return steps + inverses + ends


def _product(a: int, b: int, c: int) -> int:
    return (2 * b - 1) * a * c


def _solve(n: int, columns: int) -> int:
    return (4 * n**3 - 3 * n**2 - n) // 6 + columns * (2 * n**2 - n)
