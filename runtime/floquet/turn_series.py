"""Monodromy matrices of many values of one variable at once: short stretches of the turn as series.

The turn is cut into stretches that hardly turn the state.  Over each the solution is a power
series in the angle, found at a few Chebyshev nodes of the variable and interpolated between them:
a stretch is so short that a dozen nodes fix it for all values.  What remains for each value is a
product.  Where the system is the same after a reversal of the crank, half a turn is enough.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import bad
from ..series import chebyshev
from .first_order import CanonicalForm, even_angles
from .period_products import ordered_product

Array = NDArray[np.float64]
# From values of the variable (n,) to the canonical form of the systems there.
FormAt = Callable[[Array], CanonicalForm]

_EPS = float(np.finfo(float).eps)
# How far the fastest mode turns within a stretch, half of it either way of the middle [rad].
_PHASE = 4.0
# Chebyshev nodes of the angle in a stretch, and of the variable to begin with.
_ANGLES, _LEAVES = 16, 15
_MOST_LEAVES, _MOST_TERMS, _MOST_STRETCHES = 80, 64, 2**17
# Where a series is cut, relative to its largest term.
_CUT = 2e-16
# How much of the coefficients and of the series in the variable may be missed.
_ROUGH = 64 * _EPS
# Last terms beyond which a series has not ended.
_FAR_OFF = 1e-13
_BLOCK_FLOATS = 2_000_000
# Even angles at which symmetry and rates are judged: a prime number, which no harmonic divides.
_PROBES = 67
_ALIKE = 1e-13


@dataclass(frozen=True)
class TurnSeries:
    """The solution over stretches of the turn, as Chebyshev series in one variable.

    Attributes
    ----------
    maps : ndarray
        Chebyshev coefficients of the matrices of the stretches, shape ``(k, stretches, m, m)``, in
        scaled modal coordinates.
    low, high : float
        Ends of the variable.
    half : bool
        Whether the stretches fill half a turn, the other half being its mirror image.
    missed : float
        What the series leave out, summed over the stretches, relative to the matrices.
    """

    maps: Array
    low: float
    high: float
    half: bool
    missed: float

    def products(self, values: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the products of all stretches, and the powers of two taken out of them.

        Parameters
        ----------
        values : ndarray
            Values of the variable, shape ``(n,)``.

        Returns
        -------
        matrices : ndarray
            Shape ``(n, m, m)``: over the turn, or over half of it.
        power : ndarray of int
            Shape ``(n,)``.
        """
        count, stretches, m, _ = self.maps.shape
        basis = chebyshev.basis(chebyshev.unit(values, self.low, self.high), count)
        flat = self.maps.reshape(count, -1)
        found = np.empty((len(values), m, m))
        power = np.zeros(len(values), dtype=np.int64)
        together = max(1, _BLOCK_FLOATS // (stretches * m * m))
        for start in range(0, len(values), together):
            part = slice(start, start + together)
            single = (basis[:, part].T @ flat).reshape(-1, stretches, m, m)
            found[part], power[part] = ordered_product(single)
        return found, power


def mirrored_sums(halves: Array) -> Array:
    """Return P with ``X + X^-1 = diag(2 P, 2 P^T)``, X over a turn that is its own mirror image.

    With F = [[a, b], [c, d]] over half a turn and R = diag(1, -1), ``X = R F^-1 R F``; F is
    symplectic, so that the upper left block of X is ``1 + 2 b^T c``, and X^-1 = R X R.

    Parameters
    ----------
    halves : ndarray
        F, shape ``(..., 2n, 2n)``.

    Returns
    -------
    ndarray, shape (..., n, n)
        Its eigenvalues are those of ``(rho + 1/rho) / 2``, each once.
    """
    n = halves.shape[-1] // 2
    cross = np.swapaxes(halves[..., :n, n:], -1, -2) @ halves[..., n:, :n]
    value: Array = np.eye(n) + 2.0 * cross
    return value


class Turn:
    """How to solve a system over a turn for all values of one variable between two ends.

    Parameters
    ----------
    form_at : callable
        From values of the variable to the canonical form of the systems there.
    low, high : float
        Ends of the variable; ``low`` may equal ``high``.
    symplectic : bool
        Whether the flow is known to be so; only then half a turn may do.
    fineness : float
        Factor on the number of stretches: another one gives another solution, to compare.
    modes : tuple of ndarray, optional
        :attr:`modes` of another turn to be used here: all matrices are in those coordinates.
    degree : int, optional
        Degree of the generator where it is known to be a polynomial of the variable.
    """

    def __init__(
        self,
        form_at: FormAt,
        low: float,
        high: float,
        *,
        symplectic: bool = False,
        fineness: float = 1.0,
        modes: tuple[Array, Array] | None = None,
        degree: int | None = None,
    ) -> None:
        self.form_at, self.low, self.high, self.fineness = form_at, low, high, fineness
        self.symplectic = symplectic
        self.degree = degree
        self._modes = modes
        self.ends = form_at(np.array([low, high]))
        self.period = self.ends.system.period

    def nodes(self, count: int) -> Array:
        """Return Chebyshev nodes of the variable."""
        half = 0.5 * (self.high - self.low)
        value: Array = 0.5 * (self.low + self.high) + half * chebyshev.nodes(count)
        return value

    @cached_property
    def modes(self) -> tuple[Array, Array]:
        """Modes of the mean mass and stiffness, scaled: ``q = T Q``, and the inverse of T.

        In them the matrix of a stretch is nearly a rotation, whatever the coordinates were.
        """
        if self._modes is not None:
            return self._modes
        mass, stiff = (_mean(self.ends.assemble(a, self._probes)) for a in ("M", ("K", "Kg")))
        lower = np.linalg.cholesky(self.ends.require_mass(mass))
        if stiff is None:
            stiff = np.zeros_like(lower)
        reduced = np.linalg.solve(lower, np.linalg.solve(lower, 0.5 * (stiff + stiff.T)).T)
        squares, vectors = np.linalg.eigh(0.5 * (reduced + reduced.T))
        size = np.maximum(np.abs(squares), 1.0) ** -0.25
        return np.linalg.solve(lower.T, vectors) * size, (vectors / size).T @ lower.T

    @cached_property
    def _probes(self) -> Array:
        return even_angles(self.period, _PROBES)

    def generator(self, form: CanonicalForm, theta: Array) -> Array:
        """Return L of y' = L y in modal coordinates, shape ``(nb, nt, m, m)``."""
        modes, inverse = self.modes
        n = len(modes)
        left, right = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
        left[:n, :n], left[n:, n:] = inverse, modes.T
        right[:n, :n], right[n:, n:] = modes, inverse.T
        value: Array = left @ form.plain_generator(theta) @ right
        return value

    @cached_property
    def probed(self) -> Array:
        """The generator at both ends of the variable and even angles, ``(2, nt, m, m)``.

        Raises
        ------
        BadInput
            If it is not finite.
        """
        values = self.generator(self.ends, self._probes)
        if not np.all(np.isfinite(values)):
            raise bad(
                "LinearPeriodic.terms",
                "a value that is not finite at some angle",
                "finite numbers at every angle",
                "check the functions, their domain and the geometry",
            )
        return values

    @cached_property
    def mirrored(self) -> bool:
        """True where ``L(-theta) = -R L(theta) R`` with R = diag(1, -1) at even angles."""
        if not self.symplectic:
            return False
        n = self.probed.shape[-1] // 2
        back = self.probed[:, -np.arange(_PROBES)]
        sign = np.repeat([1.0, -1.0], n)
        back = back * (sign[:, None] * sign)
        return bool(np.max(np.abs(self.probed + back)) <= _ALIKE * np.max(np.abs(self.probed)))

    @property
    def span(self) -> float:
        """The angle that has to be solved for: a turn, or half of one."""
        return 0.5 * self.period if self.mirrored else self.period

    def stretches(self) -> int:
        """Return a number of stretches that the fastest mode allows.

        Raises
        ------
        BadInput
            If that is more than a hundred thousand.
        """
        rate = float(np.max(np.abs(np.linalg.eigvals(self.probed.mean(axis=1)))))
        # Where the waves outweigh the mean, what they do at their strongest.
        n = self.probed.shape[-1] // 2
        blocks = self.probed[..., :n, n:], self.probed[..., n:, :n]
        first, second = (np.sqrt(np.sum(block**2, axis=(-2, -1))) for block in blocks)
        rate = max(rate, 0.5 * float(np.sqrt(np.max(first * second))))
        wanted = self.fineness * rate * self.span / _PHASE
        if wanted > _MOST_STRETCHES:
            raise bad(
                "stability_chart",
                f"a mode that turns through {rate * self.period:.3g} rad in a period",
                f"at most {_PHASE * _MOST_STRETCHES:.3g} rad",
                "raise the lowest speed or leave out the highest modes",
            )
        # The least number too is raised: two finenesses never share their stretches.
        return max(int(np.ceil(8 * self.fineness)), int(np.ceil(wanted)))

    def series(
        self,
        stretches: int | None = None,
        leaves: int = _LEAVES,
        *,
        before: float = np.inf,
    ) -> TurnSeries:
        """Return the stretches as series, their numbers raised until nothing is missed.

        ``before`` is the tail with fewer nodes: round-off, where another try did not halve it.
        """
        count = self.stretches() if stretches is None else stretches
        if self.low == self.high:
            leaves = 1
        maps, missed, rough = self._stretch_maps(count, leaves)
        finer = self.fineness == 1.0
        while maps is None:
            # Stretches too long for the coefficients, which hold high harmonics: what polynomials
            # miss falls like a power of the width.
            factor = 1.1 * (rough / _ROUGH) ** (1.0 / (_ANGLES - 1))
            count = min(int(np.ceil(min(max(factor, 1.15), 2.0) * count)), _MOST_STRETCHES)
            maps, missed, rough = self._stretch_maps(count, leaves)
            if maps is not None and not finer:
                # Found so, the number hardly depends on where it began; another fineness is to
                # give another one.
                finer, count = True, min(int(np.ceil(self.fineness * count)), _MOST_STRETCHES)
                maps, missed, rough = self._stretch_maps(count, leaves)
        table = (chebyshev.analysis(leaves) @ maps.reshape(leaves, -1)).reshape(maps.shape)
        tail = 0.0
        if leaves > 1:
            tail = float(np.max(np.abs(table[-2:])))
            if tail > _ROUGH and tail < 0.5 * before and leaves < _MOST_LEAVES:
                return self.series(count, leaves + leaves // 4, before=tail)
        missed = (missed + rough + tail) * count
        return TurnSeries(table, self.low, self.high, self.mirrored, missed)

    def _stretch_maps(self, count: int, leaves: int) -> tuple[Array | None, float, float]:
        """Return the matrices of the stretches at nodes of the variable, ``(leaves, count, m, m)``.

        With what the power series miss, and how much of the coefficients their polynomials miss;
        where that is too much and more stretches are allowed, no matrices.
        """
        # A generator that is a polynomial of the variable is known from few of its values.
        own = leaves if self.degree is None else min(leaves, self.degree + 1)
        form = self.form_at(self.nodes(own))
        spread = chebyshev.basis(chebyshev.nodes(leaves), own).T @ chebyshev.analysis(own)
        m = form.size
        together = max(1, _BLOCK_FLOATS // (leaves * _ANGLES * m * m))
        width = self.span / count
        found, missed, rough = [], 0.0, 0.0
        # In two steps: the coefficients by Chebyshev polynomials fall, and with them the round-off
        # of those by powers.
        analysis, powers = chebyshev.analysis(_ANGLES), by_powers(_ANGLES)
        for start in range(0, count, together):
            middles = (np.arange(start, min(count, start + together)) + 0.5) * width
            angles = middles[:, None] + 0.5 * width * chebyshev.nodes(_ANGLES)
            values = self.generator(form, angles.ravel())
            values = values.reshape(own, len(middles), _ANGLES, m * m)
            values *= 0.5 * width
            values = analysis @ values
            rough = max(rough, float(np.max(np.abs(values[..., -2:, :]))))
            if rough > _ROUGH and count < _MOST_STRETCHES:
                return None, missed, rough
            coefficients = np.moveaxis(powers @ values, 2, 0).reshape(_ANGLES, own, -1)
            if own < leaves:
                coefficients = spread @ coefficients
            maps, left_out = _maps(coefficients.reshape(_ANGLES, leaves, -1, m, m))
            if maps is None:
                if count < _MOST_STRETCHES:
                    return None, missed, np.inf
                raise bad(
                    "stability_chart",
                    f"terms too large for {count} stretches of the turn",
                    "a motion that is slower",
                    "raise the lowest speed or leave out the highest modes",
                )
            found.append(maps)
            missed = max(missed, left_out)
        return np.concatenate(found, axis=1), missed, rough


def _mean(values: Array | None) -> Array | None:
    return None if values is None else np.asarray(values.mean(axis=(0, 1)))


def by_powers(count: int) -> Array:
    """Return the matrix from coefficients by Chebyshev polynomials to those by powers."""
    table = np.zeros((count, count))  # T_k by powers, column k
    table[0, 0] = table[1, 1] = 1.0
    for k in range(2, count):
        table[1:, k] = 2.0 * table[:-1, k - 1]
        table[:, k] -= table[:, k - 2]
    return table


def _maps(coefficients: Array) -> tuple[Array | None, float]:
    """Return the matrices from the left to the right ends of stretches, and what they miss.

    ``Y' = sum_j L_j tau^j Y`` on -1 < tau < 1 with Y(0) = 1 is solved by powers of tau;
    coefficients ``(nodes, ..., m, m)``.  None where the series has not ended after all
    its terms: the mean rate, zero in a system that only its waves move, says too little there.
    """
    terms, last = power_terms(coefficients)
    if not last <= _FAR_OFF:
        return None, float("inf")
    even, odd = (np.sum(terms[k::2], axis=0) for k in (0, 1))
    forward, backward = even + odd, even - odd
    # X (left end to right end) = forward @ backward^-1.
    maps = np.linalg.solve(np.swapaxes(backward, -1, -2), np.swapaxes(forward, -1, -2))
    return np.ascontiguousarray(np.swapaxes(maps, -1, -2)), 2.0 * last


def power_terms(coefficients: Array) -> tuple[list[Array], float]:
    """Return the terms of ``Y = sum_k Y_k tau^k`` with ``Y' = sum_j L_j tau^j Y``, Y(0) = 1.

    Coefficients ``(powers, ..., m, m)``; also returned is the size of the last two terms, which
    says whether the series has ended at |tau| = 1.
    """
    m = coefficients.shape[-1]
    sizes = [float(np.max(np.abs(part))) for part in coefficients]
    used = max(1, chebyshev.length(np.array(sizes), _EPS * max(sizes)))
    terms: list[Array] = [np.broadcast_to(np.eye(m), coefficients.shape[1:])]
    last = [1.0, 1.0]
    while max(last) > _CUT and len(terms) < _MOST_TERMS:
        k = len(terms)
        term = coefficients[0] @ terms[k - 1]
        for j in range(1, min(k, used)):
            term += coefficients[j] @ terms[k - 1 - j]
        term *= 1.0 / k
        terms.append(term)
        last = [last[1], float(np.max(np.abs(term)))]
    return terms, max(last)
