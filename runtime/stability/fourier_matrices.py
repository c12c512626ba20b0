"""Fourier matrices of a linear periodic system: its equation on periodic motions, per speed power.

A motion ``q = sum_k q_k exp(i kappa_k 2 pi theta/T)`` with whole kappa is periodic (multiplier +1),
with half-odd kappa antiperiodic (multiplier -1).  The weak form of the Lagrangian,

    w^2 [d M d + d A - A^T d - B] q + w (C d + D) q + (K + Kg) q = 0,   d = d/dtheta,

needs no derivative of a coefficient, and is symmetric where the system is undamped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic, Term
from ..core.trigonometric import even_angles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

SPEED_EXPONENT = {"M": 2, "A": 2, "B": 2, "C": 1, "D": 1, "K": 0, "Kg": 0}
_MOST_SAMPLES = 8192


@dataclass(frozen=True)
class Wave:
    """Fourier coefficients of one term, its parameter factor included.

    Attributes
    ----------
    array : str
        The array that the term belongs to.
    exponent : int
        Power of the speed in the equation.
    coefficients : ndarray of complex
        Shape ``(2 r + 1, n, n)``, for harmonics -r to r of the period.
    """

    array: str
    exponent: int
    coefficients: ComplexArray

    @property
    def reach(self) -> int:
        """Highest harmonic r."""
        return len(self.coefficients) // 2

    def placed(
        self, rate: Array
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], ComplexArray, Array, Array]]:
        """Yield rows and columns among a motion's harmonics, the block, and the rates of both."""
        count = len(rate)
        for shift, block in enumerate(self.coefficients, start=-self.reach):
            # Row k, column l = k - shift.
            rows = np.arange(max(0, shift), min(count, count + shift))
            columns = rows - shift
            yield rows, columns, block, rate[rows][:, None, None], rate[columns][:, None, None]


def waves(system: LinearPeriodic, parameters: Mapping[str, ArrayLike]) -> tuple[Wave, ...]:
    """Return the Fourier coefficients of the terms that act at constant speed without forcing.

    Raises
    ------
    BadInput
        If a parameter is not one number, or a term is not smooth enough for 8192 samples.
    """
    for name, value in parameters.items():
        if np.ndim(value) != 0 or not np.isfinite(np.asarray(value, dtype=float)):
            raise bad(name, value, "one finite number", "treat one parameter value at a time")
    scales = system.scale_values(**parameters)
    found = []
    for term in system.terms:
        if term.array not in SPEED_EXPONENT:
            continue
        factor = 1.0 if term.scale is None else float(scales[term.scale])
        if factor != 0.0:
            coefficients = factor * _coefficients(term, system.period)
            found.append(Wave(term.array, SPEED_EXPONENT[term.array] + term.power, coefficients))
    return _merged(found)


def _merged(found: list[Wave]) -> tuple[Wave, ...]:
    """Add up the waves of like array and power."""
    sums: dict[tuple[str, int], ComplexArray] = {}
    for wave in found:
        old = sums.get((wave.array, wave.exponent))
        long, short = wave.coefficients, old
        if short is None:
            sums[wave.array, wave.exponent] = long
            continue
        if len(short) > len(long):
            long, short = short, long
        total = np.array(long)
        margin = (len(long) - len(short)) // 2
        total[margin : margin + len(short)] += short
        sums[wave.array, wave.exponent] = total
    return tuple(Wave(array, power, value) for (array, power), value in sums.items())


def _coefficients(term: Term, period: float) -> ComplexArray:
    """Return the coefficients of one term, those at round-off left out."""
    if term.constant:
        return np.asarray(term(np.zeros(1)), dtype=complex)
    count = 512
    while True:
        values = np.asarray(term(even_angles(period, count)), dtype=float)
        half = np.fft.rfft(values, axis=0) / count
        size = np.max(np.abs(half), axis=(1, 2))
        kept = size > 4e-16 * np.max(size)
        reach = int(np.flatnonzero(kept)[-1]) if np.any(kept) else 0
        if 3 * reach < count:
            break
        # Round-off in the samples leaves a floor that no further sampling lowers.
        if np.max(size[count // 3 :]) < 1e-14 * np.max(size) and count >= 256:
            reach = min(reach, count // 3)
            break
        count *= 2
        if count > _MOST_SAMPLES:
            raise bad(
                f"term {term.array} ({term.scale})",
                f"a function that {_MOST_SAMPLES} samples do not resolve",
                "a smooth periodic function",
                "check it for jumps and kinks",
            )
    upper = half[: reach + 1]
    return np.concatenate([np.conj(upper[:0:-1]), upper])


def real_matrices(
    found: tuple[Wave, ...], size: int, period: float, harmonics: int, multiplier: int
) -> dict[int, Array]:
    """Return the matrices of the equation by power of the speed, in a real basis.

    The basis is, per coordinate, ``1`` (periodic motions only), then ``sqrt(2) cos`` and
    ``sqrt(2) sin`` of each harmonic, ordered by harmonic and, within it, by coordinate.
    """
    highest = harmonics if multiplier == 1 else harmonics - 0.5
    kappa = np.arange(-highest, highest + 0.25, dtype=np.float64)
    rate: Array = 2 * np.pi / period * kappa
    count = len(kappa)
    totals: dict[int, ComplexArray] = {}
    for wave in found:
        total = totals.setdefault(
            wave.exponent, np.zeros((count, size, count, size), dtype=complex)
        )
        for rows, columns, block, left, right in wave.placed(rate):
            total[rows, :, columns, :] += _entry(wave.array, block, left, right)
    return {exponent: _in_real_basis(total) for exponent, total in totals.items()}


def _entry(array: str, block: ComplexArray, left: Array, right: Array) -> ComplexArray:
    """Return the entries that one harmonic of one array adds; left, right are -i d/dtheta."""
    if array == "M":
        return -left * right * block
    if array == "A":
        return 1j * (left * block - right * block.T)
    if array == "B":
        return np.broadcast_to(-block, (len(left), *block.shape))
    if array == "C":
        return 1j * right * block
    return np.broadcast_to(block, (len(left), *block.shape))


def _in_real_basis(total: ComplexArray) -> Array:
    """Carry a matrix ``(K, n, K, n)``, kappa rising, to cosines and sines; ``(K n, K n)``.

    The entries at -kappa, -lambda are conjugate to those at kappa, lambda, so the rows of positive
    kappa say everything.
    """
    count, n = total.shape[:2]
    middle, odd = divmod(count, 2)
    rows = total[middle + odd :]
    same, cross = rows[:, :, middle + odd :], rows[:, :, :middle][:, :, ::-1]
    out = np.empty((count, n, count, n))
    cosine, sine = slice(odd, None, 2), slice(odd + 1, None, 2)
    out[cosine, :, cosine] = (same + cross).real
    out[sine, :, sine] = (same - cross).real
    out[cosine, :, sine] = (same - cross).imag
    out[sine, :, cosine] = -(same + cross).imag
    if odd:
        root = np.sqrt(2.0)
        above, beside = total[middle, :, middle + 1 :], rows[:, :, middle]
        out[0, :, 0] = total[middle, :, middle].real
        out[0, :, cosine], out[0, :, sine] = root * above.real, root * above.imag
        out[cosine, :, 0], out[sine, :, 0] = root * beside.real, -root * beside.imag
    return out.reshape(count * n, count * n)
