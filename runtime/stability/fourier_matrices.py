"""Fourier matrices of a linear periodic system: its equation on periodic motions, per speed power.

A motion ``q = sum_k q_k exp(i kappa_k 2 pi theta/T)`` with whole kappa is periodic (multiplier +1),
with half-odd kappa antiperiodic (multiplier -1).  The weak form of the Lagrangian,

    w^2 [d M d + d A - A^T d - B] q + w (C d + D) q + (K + Kg) q = 0,   d = d/dtheta,

needs no derivative of a coefficient, and is symmetric where the system is undamped.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..periodic.equation import SPEED_POWER, sampled

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Wave:
    """Fourier coefficients of the terms of one array that carry one power of the speed.

    Of shape ``(2 r + 1, n, n)``, for harmonics -r to r of the period.
    """

    array: str
    exponent: int
    coefficients: ComplexArray

    @property
    def reach(self) -> int:
        """Highest harmonic r."""
        return len(self.coefficients) // 2


def waves(system: LinearPeriodic, parameters: Mapping[str, ArrayLike]) -> tuple[Wave, ...]:
    """Return the Fourier coefficients of the terms that act at constant speed without forcing.

    A parameter that is not one number is refused, and a term not smooth enough to have a series.
    """
    for name, value in parameters.items():
        if np.ndim(value) != 0 or not np.isfinite(np.asarray(value, dtype=float)):
            raise bad(name, value, "one finite number", "treat one parameter value at a time")
    scales = system.scale_values(**parameters)
    known = sampled(system)
    if known.harmonics < 0:
        raise bad(
            "LinearPeriodic.terms",
            "a function whose Fourier series does not end",
            "smooth periodic functions",
            "check it for jumps and kinks",
        )
    # Harmonics from 0 on, like terms added up.
    sums: dict[tuple[str, int], ComplexArray] = {}
    for place, term in enumerate(system.terms):
        factor = 1.0 if term.scale is None else float(scales[term.scale])
        if term.array not in SPEED_POWER or term.array in "fhp" or factor == 0.0:
            continue
        series = known.series.get(place)
        if series is None:
            series = np.asarray(term(np.zeros(1)), dtype=float)
        half = len(series) // 2
        key = term.array, 2 + SPEED_POWER[term.array] + term.power
        total = sums.setdefault(
            key, np.zeros((known.harmonics + 1, system.size, system.size), dtype=complex)
        )
        total[0] += factor * series[0]
        total[1 : half + 1] += 0.5 * factor * (series[1 : half + 1] - 1j * series[half + 1 :])
    found = []
    for (array, exponent), total in sums.items():
        size = np.max(np.abs(total), axis=(1, 2))
        # Below this, over the largest, the last harmonics are round-off.
        reach = int(np.flatnonzero(size > 4e-16 * np.max(size))[-1]) if np.any(size) else 0
        upper = total[: reach + 1]
        found.append(Wave(array, exponent, np.concatenate([np.conj(upper[:0:-1]), upper])))
    return tuple(found)


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
        for shift, block in enumerate(wave.coefficients, start=-wave.reach):
            # Row k, column l = k - shift.
            rows = np.arange(max(0, shift), min(count, count + shift))
            columns = rows - shift
            left, right = (rate[index][:, None, None] for index in (rows, columns))
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
