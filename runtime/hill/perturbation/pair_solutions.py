"""Periodic solutions on the ends of a region from its two resonant harmonics, however close.

Where the region is narrow, the direction of the solution in the plane of ``exp(+-i n theta/2)``
hangs on a coupling far below the round-off of Hill's matrix.  Elimination of all other harmonics
gives that coupling as a sum over paths, each factor of which is known to round-off: its own
relative error is small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.periodic_function import PeriodicFunction
from ..transfer import EPS

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Roundings of one factor of a path: the coefficient, the elimination, its way back.
_ROUNDINGS = 4.0
_LARGEST = 512
# Largest answer of the others to forces of size 1.
_FARTHEST = 1e3
# What the harmonics beyond the cut may hold, relative to the resonant ones.
_TAIL = 1e-18


@dataclass(frozen=True)
class Reduced:
    """Coefficients of ``exp(i (m - n/2) theta)``, m = -r ... n + r, and their figure.

    Attributes
    ----------
    coefficients : ndarray, complex
        With ``exp(+-i n theta/2)`` of size 1.
    error : float
        Largest deviation over theta from the solution with the same size of these two.
    degenerate : bool
        True where nothing is left to tell the two ends apart.
    """

    coefficients: Complex
    error: float
    degenerate: bool


def reduced_solution(
    f: PeriodicFunction, n: int, lam2: float, slack: float, damping: float, end: str
) -> Reduced | None:
    """Return the solution on an end of region n >= 1 that is known to ``slack``.

    None where the other harmonics are not far enough from resonance: with their couplings all
    taken positive they have to stay stable.
    """
    harmonic = n + 8 + f.harmonics
    while harmonic <= _LARGEST:
        others = _Others(f, n, harmonic, lam2, slack, damping)
        if not others.stable:
            return None
        if others.edge <= _TAIL:
            return others.joined(end)
        harmonic += max(harmonic // 2, f.harmonics)
    return None


class _Others:
    """All harmonics but ``k = +-n/2``, what the upper one of these calls forth, and its majorant.

    ``(H - lam2) y = -H_up`` among the others, ``y = 1`` at ``k = n/2``.  The majorant takes all
    couplings as negative and the levels as positive: where that matrix is an M-matrix, its inverse
    bounds the true one entrywise, and so its solutions bound y and every sum over paths.
    """

    def __init__(
        self, f: PeriodicFunction, n: int, harmonic: int, lam2: float, slack: float, damping: float
    ) -> None:
        self.k = k = np.arange(-harmonic - n, harmonic + 1) + 0.5 * n
        self.up, self.down = harmonic + n, harmonic
        self.rest = rest = (np.arange(k.size) != self.up) & (np.arange(k.size) != self.down)
        self.drag = -2.0 * damping * k
        self.slack, self.given = slack + f.error, f.error
        self.steps = _ROUNDINGS * (n + 2.0) * EPS
        self.coupling = _couplings(f, k.size)
        self.sizes = np.abs(self.coupling)
        inner = np.ix_(rest, rest)
        matrix, here = self.coupling[inner], np.diag_indices(k.size - 2)
        levels = (k * k - lam2 - f.mean)[rest]
        matrix[here] += levels + 1j * self.drag[rest]
        self.positive = -(self.sizes[inner] + f.error)
        self.positive[here] += np.abs(levels) - self.slack + f.error
        size = k * k + abs(lam2) + abs(f.mean)
        called = self.sizes[rest, self.up]
        reach, self.weight = np.zeros(k.size), np.zeros(k.size)
        reach[rest] = self._solved(np.ones(k.size - 2))
        # A positive vector that stays positive makes an M-matrix of it.  With the levels on their
        # own sides, as many eigenvalues lie below as without f: the ends are the two that meet
        # there.
        self.stable = bool(np.all(np.isfinite(reach)) and reach[rest].min() > 0.0)
        self.stable &= bool(reach.max() < _FARTHEST)
        self.stable &= bool(np.all((levels > 0.0) == (np.abs(k[rest]) > 0.5 * n)))
        if not self.stable:
            return
        self.weight[rest] = np.maximum(self._solved(called + f.error), 0.0)
        self.y = np.zeros(k.size, dtype=complex)
        self.y[rest] = np.linalg.solve(matrix, -self.coupling[rest, self.up])
        self.y[self.up] = 1.0
        ends = np.abs(self.y[[*range(f.harmonics + 1), *range(-f.harmonics - 1, 0)]])
        self.edge = float(ends.max())
        # Round-off, the doubt of the boundary and of the data.
        own = self.weight[rest]
        loss = self.steps * (size[rest] * own + self.sizes[inner] @ own + called)
        loss += self.slack * own + f.error * (1.0 + own.sum())
        self.doubt = np.zeros(k.size)
        self.doubt[rest] = self._solved(loss)

    def _solved(self, right: Array) -> Array:
        try:
            return np.asarray(np.linalg.solve(self.positive, right))
        except np.linalg.LinAlgError:
            return np.full(right.shape, np.nan)

    def joined(self, end: str) -> Reduced:
        """Return the solution: ``u y`` and its mirror, with ``u = exp(i phase)``."""
        weight, drag = self.weight, np.abs(self.drag)
        b = complex(self.coupling[self.down] @ self.y).conjugate()
        # The Hermitian part of H leaves A real: no round-off of it enters.
        a = float(self.drag @ np.abs(self.y) ** 2)
        lost_a = self.steps * float(drag[self.up] + drag @ weight**2)
        lost_a += 2.0 * float(drag @ (weight * self.doubt))
        paths = float(self.sizes[self.down, self.up] + self.sizes[self.down] @ weight)
        lost_b = self.steps * paths + self.slack * float(weight @ weight[::-1])
        lost_b += self.given * float(1.0 + weight.sum()) ** 2
        phase, turn, degenerate = direction(a, b, (lost_a, lost_b), end)
        v = np.exp(1j * phase) * self.y
        v = v + v[::-1].conj()
        error = 4.0 * float(self.doubt.sum()) + (turn + 8.0 * EPS) * float(np.abs(v).sum())
        return Reduced(v, error, degenerate)


def direction(
    a: float, b: complex, lost: tuple[float, float], end: str
) -> tuple[float, float, bool]:
    """Return the phase of the eigenvector, its error, and whether it is arbitrary.

    ``A u + B conj(u) = (Re A -+ sqrt(|B|^2 - (Im A)^2)) u`` with ``u = exp(i phase)``.

    Parameters
    ----------
    a, b : float, complex
        Im A and B.
    lost : pair of float
        Their errors.
    end : {"lower", "upper"}
        Which sign.
    """
    size, (lost_a, lost_b) = abs(b), lost
    if size <= lost_b:
        return (0.0 if end == "upper" else 0.5 * np.pi), 0.0, True
    half = float(np.sqrt(max((size - a) * (size + a), 0.0)))
    phase = -0.5 * float(np.angle(complex(half if end == "upper" else -half, -a) / b))
    near = np.arcsin(min(1.0, abs(a) / size))
    far = np.arcsin(min(1.0, (abs(a) + lost_a) / (size - lost_b)))
    return phase, 0.5 * float(np.arcsin(lost_b / size) + far - near), False


def _couplings(f: PeriodicFunction, size: int) -> Complex:
    """Return ``-c_(k-l)`` for all pairs of harmonics, the mean left out."""
    c = np.zeros(size, dtype=complex)
    kept = min(f.harmonics + 1, size)
    c[:kept] = -0.5 * (f.a - 1j * f.b)[:kept]
    c[0] = 0.0
    apart = np.subtract.outer(np.arange(size), np.arange(size))
    return np.where(apart >= 0, c[np.abs(apart)], c[np.abs(apart)].conj())
