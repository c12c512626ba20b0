"""Hill's method for coupled modes: exponents of quasi-periodic solutions from Fourier matrices."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.results import Check, Result, provenance
from ..transfer import EPS
from .damped import left_and_right

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...core.families import LinearPeriodic
    from ...floquet.fourier_matrices import Wave

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LARGEST = 800
_WANTED = 1e-9


@dataclass(frozen=True, kw_only=True)
class SystemExponents(Result):
    """Characteristic exponents of a linear periodic system at one speed.

    Attributes
    ----------
    exponents : ndarray of complex, shape (2n,)
        sigma of the solutions ``exp(sigma theta) p(theta)`` [1/rad], by falling real part; their
        imaginary parts lie within one turn per period.
    error : ndarray, shape (2n,)
        Estimate of the absolute error: the change with the number of harmonics, and round-off
        times the condition of each.
    speed, period : float
        Speed [rad/s] and period [rad].
    harmonics : int
        Highest harmonic that was kept.
    """

    exponents: ComplexArray
    speed: float
    period: float
    harmonics: int

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "exponents": ("exponent",),
        "error": ("exponent",),
        "multipliers": ("exponent",),
    }
    exported: ClassVar[tuple[str, ...]] = ("multipliers",)

    @property
    def multipliers(self) -> ComplexArray:
        """The Floquet multipliers ``exp(sigma period)``."""
        with np.errstate(over="ignore"):
            return np.asarray(np.exp(self.exponents * self.period))


def hill_exponents(system: LinearPeriodic, speed: float, **parameters: float) -> SystemExponents:
    """Return the characteristic exponents of coupled modes by Hill's method.

    A second route to :func:`~elastolink.runtime.floquet.monodromy_matrix.floquet_multipliers`,
    without integration: the weak form of the equation on ``exp(sigma theta)`` times a Fourier
    series is a quadratic eigenvalue problem in sigma.  The number of harmonics is raised until the
    exponents settle.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : float
        Crank speed w [rad/s], positive.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    SystemExponents
        Its check: the largest error, against 1e-9.

    Raises
    ------
    BadInput
        If the speed is not a positive number, a parameter is unusable, or the exponents do not
        settle with matrices of 800 rows.
    """
    from ...floquet.fourier_matrices import waves

    if np.ndim(speed) != 0 or not (np.isfinite(speed) and speed > 0.0):
        raise bad("speed", repr(speed)[:60], "one positive number [rad/s]", "take one at a time")
    found = waves(system, parameters)
    reach = max(wave.reach for wave in found)
    harmonics, before = max(6, reach + 2), None
    while 2 * system.size * (2 * harmonics + 1) <= _LARGEST:
        now = _exponents(found, system, float(speed), harmonics)
        if now is not None and before is not None:
            change = _change(now[0], before[0], system.period)
            error = change + now[1]
            if change.max() <= max(_WANTED * 0.1, 4.0 * float(now[1].max())):
                return SystemExponents(
                    method="Hill's method, quadratic eigenvalue problem",
                    error=error,
                    error_norm="absolute, of each exponent",
                    checks={"largest error": Check(float(error.max()), _WANTED)},
                    provenance=provenance(system.changed_provenance(**parameters)),
                    exponents=now[0],
                    speed=float(speed),
                    period=system.period,
                    harmonics=harmonics,
                )
        before, harmonics = now, harmonics + max(4, harmonics // 3)
    raise bad(
        "hill_exponents",
        f"exponents that {harmonics} harmonics do not settle",
        f"a problem of at most {_LARGEST} equations",
        "use floquet_multipliers",
    )


def _exponents(
    found: tuple[Wave, ...], system: LinearPeriodic, speed: float, harmonics: int
) -> tuple[ComplexArray, Array] | None:
    """Return one exponent of each ladder and its round-off; None where they cannot be told."""
    zero, first, second = _matrices(found, system, speed, harmonics)
    size = len(zero)
    companion = np.zeros((2 * size, 2 * size), dtype=complex)
    companion[:size, size:] = np.eye(size)
    companion[size:] = -np.linalg.solve(second, np.hstack([zero, first]))
    values, lefts, rights = left_and_right(companion)
    overlap = np.abs(np.sum(lefts.conj() * rights, axis=0))
    norm = float(np.linalg.norm(companion, 2))
    rounding = EPS * norm / np.maximum(overlap, 1e-300)
    # Near a double exponent the error is the square root instead.
    rounding = np.minimum(rounding, np.sqrt(EPS) * norm**0.5)
    turns = values.imag * system.period / (2.0 * pi)
    # Every exponent returns at each whole turn: cut the circle of turns at its widest gap.
    inner = np.sort(turns[np.abs(turns) <= min(2.0, 0.5 * harmonics)] % 1.0)
    if not inner.size:
        return None
    gaps = np.diff(np.append(inner, inner[0] + 1.0))
    widest = int(gaps.argmax())
    cut = (inner[widest] + 0.5 * gaps[widest]) % 1.0
    kept = np.flatnonzero((turns >= cut - 1.0) & (turns < cut))
    if kept.size != 2 * system.size:
        return None
    order = kept[np.lexsort((values[kept].imag, -np.round(values[kept].real, 9)))]
    return values[order], rounding[order]


def _matrices(
    found: tuple[Wave, ...], system: LinearPeriodic, speed: float, harmonics: int
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return the factors of 1, sigma and sigma^2, each ``(n (2H + 1), n (2H + 1))``."""
    n, count = system.size, 2 * harmonics + 1
    numbers = np.arange(-harmonics, harmonics + 1, dtype=np.float64)
    rate: Array = 2.0 * pi / system.period * numbers
    out = np.zeros((3, count, n, count, n), dtype=complex)
    for wave in found:
        scale = speed**wave.exponent
        for rows, columns, block, *sides in wave.placed(rate):
            left, right = (np.asarray(1j * side, dtype=complex) for side in sides)
            for power, entry in enumerate(_powers(wave.array, block, left, right)):
                out[power, rows, :, columns, :] += scale * entry
    zero, first, second = out.reshape(3, count * n, count * n)
    return zero, first, second


def _powers(
    array: str, block: ComplexArray, left: ComplexArray, right: ComplexArray
) -> list[ComplexArray]:
    """Return what one harmonic of one array adds to the factors of 1, sigma, sigma^2."""
    if array == "M":
        return [left * right * block, (left + right) * block, block + 0.0 * left]
    if array == "A":
        return [left * block - right * block.T, block - block.T + 0.0 * left]
    if array == "B":
        return [-block + 0.0 * left]
    if array == "C":
        return [right * block, block + 0.0 * left]
    return [block + 0.0 * left]


def _change(now: ComplexArray, before: ComplexArray, period: float) -> Array:
    """Return how far each exponent is from its own one before, whole turns apart."""
    from scipy.optimize import linear_sum_assignment

    apart = now[:, None] - before
    turn = 2.0 * pi / period
    apart = apart.real + 1j * (apart.imag - turn * np.rint(apart.imag / turn))
    rows, columns = linear_sum_assignment(np.abs(apart))
    return np.asarray(np.abs(apart[rows, columns]))
