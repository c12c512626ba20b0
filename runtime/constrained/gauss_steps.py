"""Gauss-Legendre steps round a period, all at once: defects, sensitivities, dense output."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.families import Constrained
from ..integrators.tableau import GaussTableau, gauss_tableau
from .variational import Array, Linearised, Scale, linearised

STAGES = 12
# Numbers that stay in a cache while they are worked on.
_CACHE = 1 << 18


@dataclass(frozen=True)
class Ring:
    """A motion over one period as even collocation steps, each from a state of its own.

    Attributes
    ----------
    period : float
        Period [s].
    advance : ndarray, shape (n,)
        What the coordinates gain over a period (a link that turns gains 2 pi).
    q, qd : ndarray, shape (m, n)
        States at the beginnings of the steps.
    slope : ndarray, shape (m, s, n)
        Accelerations at the Gauss points of each step.
    """

    period: float
    advance: Array
    q: Array
    qd: Array
    slope: Array

    @property
    def step(self) -> float:
        """Length of a step [s]."""
        return self.period / len(self.q)

    @property
    def start(self) -> Array:
        """Times at which the steps begin [s]."""
        return np.asarray(np.arange(len(self.q)) * self.step, dtype=np.float64)

    @property
    def tableau(self) -> GaussTableau:
        """Coefficients of the collocation."""
        return gauss_tableau(self.slope.shape[1])

    @property
    def times(self) -> Array:
        """Times of the Gauss points, shape ``(m, s)``."""
        times: Array = self.start[:, None] + self.step * self.tableau.c
        return times

    def stages(self) -> tuple[Array, Array]:
        """Return coordinates and velocities at the Gauss points, shape ``(m, s, n)``."""
        h, a = self.step, self.tableau.a
        push = h * (a @ self.slope)
        qd = self.qd[:, None, :] + push
        steps = h * self.tableau.c[:, None]
        return self.q[:, None, :] + steps * self.qd[:, None, :] + h * (a @ push), qd

    def ends(self) -> tuple[Array, Array]:
        """Return the states at the ends of the steps, shape ``(m, n)``."""
        h, b, c = self.step, self.tableau.b, self.tableau.c
        rise = np.einsum("i,min->mn", h * b * (1.0 - c), self.slope)
        qd = self.qd + np.einsum("i,min->mn", h * b, self.slope)
        return self.q + h * (self.qd + rise), qd

    def following(self, values: Array, advance: bool = False) -> Array:
        """Return what stands at the beginning of the next step."""
        turned = np.roll(values, -1, axis=0)
        if advance:
            turned[-1] += self.advance
        return turned

    def at(self, t: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities at any times ``(nt,)``, by the collocation itself."""
        turns = np.floor(t / self.period)
        within = (t - turns * self.period) / self.step
        j = np.clip(within.astype(int), 0, len(self.q) - 1)
        c = (within - j)[:, None]
        s = self.slope.shape[1]
        legendre = np.polynomial.legendre
        nodes = legendre.legvander(2.0 * self.tableau.c - 1.0, s - 1)
        # Twice integrated from the beginning of the step, by the Legendre series in 2 c - 1.
        once = legendre.legint(np.eye(s), scl=0.5, lbnd=-1.0)
        twice = legendre.legint(once, scl=0.5, lbnd=-1.0)
        series = np.linalg.solve(nodes, self.slope[j])
        speed = np.einsum("tk,ks,tsn->tn", legendre.legvander(2 * c[:, 0] - 1, s), once, series)
        place = np.einsum(
            "tk,ks,tsn->tn", legendre.legvander(2 * c[:, 0] - 1, s + 1), twice, series
        )
        h = self.step
        q = self.q[j] + h * c * self.qd[j] + h**2 * place + turns[:, None] * self.advance
        return q, self.qd[j] + h * speed

    def refined(self) -> Ring:
        """Return the same motion on twice as many steps."""
        s, m = self.slope.shape[1], 2 * len(self.q)
        q, qd = self.at(np.asarray(np.arange(m) * (self.period / m), dtype=np.float64))
        legendre = np.polynomial.legendre.legvander
        c = self.tableau.c
        nodes = legendre(2.0 * c - 1.0, s - 1)
        halves = np.concatenate([c / 2, (1.0 + c) / 2])
        spread = np.linalg.solve(nodes.T, legendre(2.0 * halves - 1.0, s - 1).T).T
        slope = (spread @ self.slope).reshape(m, s, -1)
        return replace(self, q=q, qd=qd, slope=slope)


@dataclass(frozen=True)
class Sweep:
    """The steps of a ring linearised: what each passes on, and what is wrong with it.

    Attributes
    ----------
    found : Linearised
        At the Gauss points, shape ``(m, s)`` in front.
    maps : ndarray, shape (m, 2n, 2n)
        Derivative of the end of each step by its beginning, in scaled states.
    gap : ndarray, shape (m, 2n)
        End of each step, its stages corrected, less the beginning of the next, scaled.
    slopes, response : ndarray, shape (m, s, n), (m, s, n, 2n)
        Correction of the stage accelerations, and their derivative by the scaled beginning.
    defect : float
        Largest defect of a stage or a junction, in scaled states.
    """

    found: Linearised
    maps: Array
    gap: Array
    slopes: Array
    response: Array
    defect: float


def sweep(system: Constrained, ring: Ring, scale: Scale) -> Sweep:
    """Linearise all steps of a ring at once.

    The stage accelerations are the unknowns of a step:
    ``A_i = f(q + c_i h qd + h^2 sum_j (a a)_ij A_j, qd + h sum_j a_ij A_j)``.
    """
    q, qd = ring.stages()
    found = linearised(system, q, qd, ring.times)
    m, s, n = ring.slope.shape
    h, b, c = ring.step, ring.tableau.b, ring.tableau.c
    wrong = found.qdd - ring.slope
    right = np.empty((m, s, n, 1 + 2 * n))
    right[..., 0] = wrong
    right[..., 1 : 1 + n] = found.by_q / scale.size
    late = found.by_q * (h * c)[:, None, None] + found.by_qd
    right[..., 1 + n :] = late * (scale.rate / scale.size)
    solved = _stage_slopes(ring, found, right)
    rise = h * np.einsum("i,minx->mnx", b, solved)
    move = h**2 * np.einsum("i,minx->mnx", b * (1.0 - c), solved)
    effect = np.concatenate(
        [move * scale.size[:, None], rise * (scale.size / scale.rate)[:, None]], axis=1
    )
    maps = effect[..., 1:] + np.eye(2 * n)
    row = np.arange(n)
    maps[:, row, n + row] += h * scale.rate
    end = ring.ends()
    junction = scale.state(
        end[0] - ring.following(ring.q, advance=True), end[1] - ring.following(ring.qd)
    )
    worst = max(
        float(np.max(np.abs(junction))), float(np.max(np.abs(wrong * scale.size))) * h / scale.rate
    )
    return Sweep(found, maps, junction + effect[..., 0], solved[..., 0], solved[..., 1:], worst)


def _stage_slopes(ring: Ring, found: Linearised, right: Array) -> Array:
    """Solve for the stage accelerations of each step, as many steps at once as a cache holds."""
    m, s, n, columns = right.shape
    h, a = ring.step, ring.tableau.a
    place, speed = (h**2 * (a @ a))[:, None, :, None], (h * a)[:, None, :, None]
    solved = np.empty_like(right)
    chunk = max(_CACHE // (s * n) ** 2, 1)
    unit = np.arange(s * n)
    for first in range(0, m, chunk):
        part = slice(first, first + chunk)
        blocks = -place * found.by_q[part][:, :, :, None, :]
        blocks -= speed * found.by_qd[part][:, :, :, None, :]
        matrix = blocks.reshape(-1, s * n, s * n)
        matrix[:, unit, unit] += 1.0
        flat = right[part].reshape(-1, s * n, columns)
        solved[part] = np.linalg.solve(matrix, flat).reshape(-1, s, n, columns)
    return solved
