"""What solves the steady state of a linkage of beams one speed at a time: marching, collocation."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..floquet.first_order import even_angles
from ..reduction.stress_rows import fibres, peaks
from ..reduction.trigonometric import differentiated

Array = NDArray[np.float64]

# Stresses as the thesis has them, from the curvature of the shape functions.
_METHOD = "shape"
_ANGLES = 256


class SecondOrder:
    """Arrays of ``M qdd + (C + w G) qd + (K + w^2 H) q = w^2 f`` at even angles, found once.

    Parameters
    ----------
    system : LinearPeriodic
        A linkage of beams on which its own inertia alone acts.
    angles : int
        Their number.
    """

    def __init__(self, system: LinearPeriodic, angles: int) -> None:
        self.period = system.period
        theta = even_angles(system.period, angles)
        at = {name: system.array(name, theta) for name in ("M", "A", "B", "C", "K", "Kg", "f")}
        self.mass, self.damping, self.stiffness, self.force = at["M"], at["C"], at["K"], at["f"]
        slope = differentiated(at["M"], system.period)
        self.gyroscopic = slope + at["A"] - np.swapaxes(at["A"], -1, -2)
        # The geometric stiffness carries a square of the speed of its own.
        self.circulatory = differentiated(at["A"], system.period) - at["B"] + at["Kg"]


class StressMaxima:
    """Largest stress of each link in a periodic motion.

    Parameters
    ----------
    system : LinearPeriodic
        A linkage of beams.
    stations : int
        Places on each link.
    """

    def __init__(self, system: LinearPeriodic, stations: int) -> None:
        self.period = system.period
        self.form = fibres(system, even_angles(system.period, _ANGLES), stations, _METHOD)

    def __call__(self, q: Array) -> Array:
        """Return the maxima ``(links,)`` [Pa] of a motion ``(nt, n)`` at any even angles."""
        wave = np.fft.rfft(q, axis=0)[: _ANGLES // 2]
        at = np.fft.irfft(wave, n=_ANGLES, axis=0) * (_ANGLES / len(q))
        values = np.einsum("trn,tn->tr", self.form.form.parts["q", 0], at)
        return peaks(values[..., None], self.form.link, len(self.form.links), self.period).size[
            :, 0
        ]


def collocated(problem: SecondOrder, speed: float) -> Array:
    """Return the periodic motion by Fourier collocation at an odd number of angles, ``(nt, n)``."""
    nt, n = problem.force.shape
    first, second = _differentiation(nt)
    rates = problem.damping / speed + problem.gyroscopic
    whole = second[:, None, :, None] * problem.mass[:, :, None, :]
    whole += first[:, None, :, None] * rates[:, :, None, :]
    each = np.arange(nt)
    whole[each, :, each, :] += problem.stiffness / speed**2 + problem.circulatory
    size = nt * n
    found = np.linalg.solve(whole.reshape(size, size), problem.force.reshape(size))
    return np.asarray(found.reshape(nt, n))


def _differentiation(count: int) -> tuple[Array, Array]:
    """Return the matrices of the first and second derivative at even angles, an odd number."""
    waves = np.fft.fftfreq(count, 1.0 / count)
    unit = np.fft.fft(np.eye(count), axis=0)
    first = np.fft.ifft(1j * waves[:, None] * unit, axis=0).real
    second = np.fft.ifft(-(waves[:, None] ** 2) * unit, axis=0).real
    return first, second


def newmark_march() -> Callable[..., Any] | None:
    """Return Newmark's march by constant average acceleration, compiled; None without numba.

    What it returns takes ``(inverse, force, mass, damping, step, cycles)``: at the end of each step
    of the cycle the inverse of the effective stiffness, found once for all cycles, and the arrays
    that the step needs; and returns the displacements of the last cycle.
    """
    try:
        import numba
    except ImportError:
        return None

    @numba.njit(fastmath=True)  # type: ignore[untyped-decorator]
    def march(
        inverse: Array, force: Array, mass: Array, damping: Array, step: float, cycles: int
    ) -> Array:
        steps, n = force.shape
        q, v, a = np.zeros(n), np.zeros(n), np.zeros(n)
        m, c, r = np.zeros(n), np.zeros(n), np.zeros(n)
        out = np.zeros((steps, n))
        for _ in range(cycles):
            for k in range(steps):
                for i in range(n):
                    m[i] = 4.0 / (step * step) * q[i] + 4.0 / step * v[i] + a[i]
                    c[i] = 2.0 / step * q[i] + v[i]
                for i in range(n):
                    total = force[k, i]
                    for j in range(n):
                        total += mass[k, i, j] * m[j] + damping[k, i, j] * c[j]
                    r[i] = total
                for i in range(n):
                    new = 0.0
                    for j in range(n):
                        new += inverse[k, i, j] * r[j]
                    q[i] = new
                    a[i] = 4.0 / (step * step) * new - m[i]
                    v[i] = 2.0 / step * new - c[i]
                    out[k, i] = new
        return out

    one = np.zeros((2, 2, 2))
    march(one, one[0], one, one, 0.1, 1)
    return march  # type: ignore[no-any-return]


def marched(problem: SecondOrder, speed: float, cycles: int, march: Callable[..., Any]) -> Array:
    """Return the last of some cycles from rest by Newmark's method, at the angles, ``(nt, n)``."""
    steps = len(problem.force)
    step = problem.period / speed / steps
    damping = problem.damping + speed * problem.gyroscopic
    effective = problem.stiffness + speed**2 * problem.circulatory
    effective += (2.0 / step) * damping + (4.0 / step**2) * problem.mass
    inverse = np.linalg.inv(effective)
    # The march starts at angle 0: its first step ends at the second angle.
    ends = [
        np.roll(x, -1, axis=0) for x in (inverse, speed**2 * problem.force, problem.mass, damping)
    ]
    return np.roll(march(*ends, step, cycles), 1, axis=0)
