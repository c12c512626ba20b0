"""Monodromy matrices of many values of one variable at once, from stretches of the turn.

The state is that of scaled modes, in which each stretch is nearly a rotation.  Where the system is
the same after a reversal of the crank, half a turn is enough.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.trigonometric import even_angles
from ...periodic.first_order import CanonicalForm
from ...stretches import Equation, Tabulated, solved
from ...stretches.solving import MOST_STRETCHES

Array = NDArray[np.float64]
# From values of the variable (n,) to the canonical form of the systems there.
FormAt = Callable[[Array], CanonicalForm]

# How far the fastest mode turns within a stretch, half of it either way of the middle [rad], and
# stretches that are multiplied into one.
_PHASE, _TOGETHER = 4.0, 2
# Even angles at which symmetry and rates are judged: a prime number, which no harmonic divides.
_PROBES = 67
_ALIKE = 1e-13


@dataclass(frozen=True)
class TurnSeries(Tabulated):
    """The solution over stretches of the turn, in scaled modal coordinates.

    Attributes
    ----------
    half : bool
        Whether the stretches fill half a turn, the other half being its mirror image.
    missed : float
        What the series leave out, summed over the stretches, relative to the matrices.
    """

    half: bool
    missed: float


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
    def _transforms(self) -> tuple[Array, Array]:
        """From the state (q, p) to modal coordinates, and back; ``(m, m)`` each."""
        modes, inverse = self.modes
        n = len(modes)
        there, back = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
        there[:n, :n], there[n:, n:] = inverse, modes.T
        back[:n, :n], back[n:, n:] = modes, inverse.T
        return there, back

    @cached_property
    def _probes(self) -> Array:
        return even_angles(self.period, _PROBES)

    def generator(self, form: CanonicalForm, theta: Array) -> Array:
        """Return L of y' = L y in modal coordinates, shape ``(nb, nt, m, m)``."""
        to_modes, back = self._transforms
        value: Array = to_modes @ form.plain_generator(theta) @ back
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
        if wanted > MOST_STRETCHES:
            raise bad(
                "stability_chart",
                f"a mode that turns through {rate * self.period:.3g} rad in a period",
                f"at most {_PHASE * MOST_STRETCHES:.3g} rad",
                "raise the lowest speed or leave out the highest modes",
            )
        # The least number too is raised: two finenesses never share their stretches.
        return max(int(np.ceil(8 * self.fineness)), int(np.ceil(wanted)))

    def series(self, leaves: int | None = None, finer: int | None = None) -> TurnSeries:
        """Return the stretches as series, their numbers raised until nothing is missed.

        Parameters
        ----------
        leaves : int, optional
            Chebyshev nodes of the variable to begin with.
        finer : int, optional
            How many times :meth:`stretches` there may be at the most, rough or not.

        Raises
        ------
        BadInput
            If more than a hundred thousand stretches would be needed.
        """
        count = self.stretches()
        equation = Equation(
            lambda values: partial(self.generator, self.form_at(values)),
            self.ends.size,
            self.low,
            self.high,
            self.span,
            degree=self.degree,
            together=_TOGETHER,
            most_stretches=MOST_STRETCHES if finer is None else finer * count,
        )
        found = solved(equation, count, leaves, fineness=self.fineness)
        return TurnSeries(self.low, self.high, found.stretches, self.mirrored, found.missed)


def _mean(values: Array | None) -> Array | None:
    return None if values is None else np.asarray(values.mean(axis=(0, 1)))
