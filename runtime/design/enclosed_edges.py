"""Ends of unstable regions within tolerances, by Taylor models of Hill's infinite determinant.

Without damping, a motion at an end has one period or two, and its Fourier coefficients y follow
``T y = K y / w^2``: T is the kinetic energy's, K, positive definite, that of the stiffness.  Of the
one or two eigenvalues that lie close together, a region's ends, vectors that follow the numbers to
first order give a pencil of one or two unknowns, to third.  What couples it to all others is of
second order, and enters squared, over their distance (Schur's complement, Weyl's inequality).  The
series end where the motions' harmonics have faded.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..core.families import Array
from ..core.taylor_models import TaylorModel, UndecidedError
from ..core.trigonometric import even_angles

Models = Mapping[str, TaylorModel]
# Harmonics beyond the modes' own turns in a period; even angles for each; unknowns at
# most; relative distance of an end from its eigenvalue; last harmonics over the largest, which
# enter squared; part of the distance to other eigenvalues that is left free.
_MORE, _ANGLES, _MOST, _ALIKE, _FADED, _FREE = 24, 8, 200, 1e-8, 1e-9, 0.1


def harmonics_for(ends: Array, fastest: float, period: float) -> int:
    """Return how many harmonics motions at ends ``(k,)`` [rad/s] have.

    ``fastest`` is the largest natural frequency [rad/s], ``period`` the coefficients' [rad].
    """
    return _MORE + int(np.ceil(fastest / np.min(ends) * period / (2.0 * np.pi)))


def angles_for(harmonics: int, period: float) -> Array:
    """Return even angles [rad] that see all products of two harmonics."""
    return even_angles(period, _ANGLES * harmonics)


def enclosed_ends(models: Models, ends: Array, harmonics: int, period: float) -> list[TaylorModel]:
    """Return ends of unstable regions [rad/s] within the bounds of some numbers.

    Parameters
    ----------
    models : mapping
        Arrays of the equation at the angles of :func:`angles_for`, ``(nt, n, n)``, by name; nt is 1
        of what is constant.
    ends : ndarray
        The ends where all numbers are in the middle [rad/s], ``(k,)``.
    harmonics : int
        Of the motions.
    period : float
        Of the coefficients [rad].

    Raises
    ------
    UndecidedError
        If the system is damped, an end is of a combination of modes, or no bound is of use.
    """
    damped = [name for name in ("C", "D") if name in models and np.any(models[name].coefficients)]
    if damped or models["M"].coefficients.shape[1] * (2 * harmonics + 1) > _MOST:
        raise UndecidedError("a damped system, or too many unknowns")
    found: dict[int, TaylorModel] = {}
    for shift in (0.0, 0.5):
        order = np.arange(shift, harmonics + 0.5)
        order = np.concatenate([order, -order[order > 0.0]])
        pencil = _pencil(models, order, 2.0 * np.pi / period)
        try:
            squares, vectors = scipy.linalg.eigh(*(part.middle for part in pencil))
        except np.linalg.LinAlgError:
            raise UndecidedError("a stiffness that may be negative") from None
        kinetic, stiffness = (_congruent(part, vectors) for part in pencil)
        last = np.repeat(np.abs(order) > harmonics - 2.0, len(vectors) // len(order))
        for i, end in enumerate(ends.tolist()):
            place = int(np.argmin(np.abs(squares - end**-2)))
            part = np.abs(vectors[:, place]) / np.max(np.abs(vectors[:, place]))
            if abs(squares[place] * end**2 - 1.0) < _ALIKE and np.max(part[last]) < _FADED:
                speed = 1.0 / np.sqrt(_eigenvalue(kinetic, stiffness, squares, place))
                off = np.abs(speed.middle - end)
                found[i] = TaylorModel(speed.coefficients, speed.rest + off, speed.n)
    if len(found) < len(ends):
        raise UndecidedError("an end of a combination of modes, or one that is not found anew")
    return [found[i] for i in range(len(ends))]


def _pencil(models: Models, order: Array, turn: float) -> tuple[TaylorModel, TaylorModel]:
    """Return T and K of motions in cosines and sines, whose harmonics have both signs.

    ``turn`` is the first harmonic over the crank angle.
    """
    rate, count = turn * order, len(order)
    size = models["M"].coefficients.shape[1]
    # Cosines and sines of exponential functions.
    real = np.zeros((count, count), dtype=complex)
    for row, one in enumerate(order):
        other = int(np.argmin(np.abs(order + one)))
        real[row, min(row, other)] = 1.0 if row == other else np.sqrt(0.5)
        if row != other:
            real[row, max(row, other)] = -1j * np.sign(one) * np.sqrt(0.5)
    whole = np.kron(real, np.eye(size))

    def block(name: str, weight: NDArray[Any], transposed: bool = False) -> tuple[Array, Array]:
        """Return the coefficients, features first, and the rests of an array times a weight."""
        model = models[name]
        values, rest = model.coefficients, np.mean(model.rest, axis=0)
        values, rest = (values.swapaxes(1, 2), rest.T) if transposed else (values, rest)
        table = np.fft.fft(values, axis=0) / len(values)
        gap = np.round(order[:, None] - order).astype(int)
        alone = (gap == 0) | (len(values) > 1)
        entries = (weight * alone)[..., None, None, None] * table[gap % len(values)]
        turned = entries.transpose(4, 0, 2, 1, 3).reshape(-1, count * size, count * size)
        rests = np.kron(np.abs(weight) * alone, rest)
        return np.asarray((whole.conj().T @ turned @ whole).real), abs(whole).T @ rests @ abs(whole)

    one = np.ones((count, count))
    kinetic = [block("M", rate[:, None] * rate)]
    if "A" in models:
        kinetic += [block("A", -1j * rate[:, None] * one), block("A", 1j * rate * one, True)]
    kinetic += [block("B", one)] if "B" in models else []
    stiffness = [block(name, one) for name in ("K", "Kg") if name in models]
    n = models["M"].n
    pair = []
    for parts in (kinetic, stiffness):
        values, rests = (sum(each) for each in zip(*parts, strict=True))
        pair.append(TaylorModel(np.moveaxis(values, 0, -1), rests, n))
    return pair[0], pair[1]


def _congruent(part: TaylorModel, vectors: Array) -> TaylorModel:
    """Return a matrix in coordinates that belong to vectors, the columns."""
    turned = np.moveaxis(part.coefficients, -1, 0)
    size, bound = np.abs(vectors), np.sum(np.abs(turned), axis=0)
    rest = part.rest + len(vectors) * np.finfo(float).eps * bound
    values = vectors.T @ turned @ vectors
    return TaylorModel(np.moveaxis(values, 0, -1), size.T @ rest @ size * (1.0 + 1e-9), part.n)


def _eigenvalue(
    kinetic: TaylorModel, stiffness: TaylorModel, squares: Array, place: int
) -> TaylorModel:
    """Return one of the eigenvalues of a pencil that is diagonal, with unit K, in the middle."""
    group = np.argsort(np.abs(squares - squares[place]), kind="stable")[:2].tolist()
    others = np.setdiff1d(np.arange(len(squares)), group)
    pushed, held, vectors = [], [], []
    for one in group:
        values = np.zeros((len(squares), kinetic.coefficients.shape[-1]))
        values[one, 0] = 1.0
        coupling = kinetic.slope[others, one] - squares[one] * stiffness.slope[others, one]
        apart = squares[others] - squares[one]
        values[others, 1 : kinetic.n + 1] = -coupling / apart[:, None]
        vectors.append(TaylorModel(values, 0.0, kinetic.n))
        pushed.append((kinetic * vectors[-1][None]).sum(1))
        held.append((stiffness * vectors[-1][None]).sum(1))
    t = [[(a * b).sum(0) for b in pushed] for a in vectors]
    k = [[(a * b).sum(0) for b in held] for a in vectors]
    quotients = [t[i][i] / k[i][i] for i in range(len(group))]
    bounds = [quotient.bounds() for quotient in quotients]
    low, high = min(float(low) for low, _ in bounds), max(float(high) for _, high in bounds)
    gap = float(np.min(np.maximum(low - squares[others], squares[others] - high)))
    low, high = low - _FREE * gap, high + _FREE * gap
    # What changes among the others, and what couples the vectors to them, over their distance.
    distance = np.maximum(low - squares[others], squares[others] - high)
    scale = 1.0 / np.sqrt(distance) if gap > 0.0 else np.full(len(others), np.nan)
    some = np.ix_(others, others)
    moved = kinetic[some].reach() + max(abs(low), abs(high)) * stiffness[some].reach()
    spread = np.max(np.sum(scale[:, None] * moved * scale, axis=1))
    coupled = [
        (p[others] - quotient * h[others]).largest() + (high - low) * h[others].largest()
        for quotient, p, h in zip(quotients, pushed, held, strict=True)
    ]
    least = min(
        row[i].middle - row[i].reach() - sum(row[j].largest() for j in range(len(row)) if j != i)
        for i, row in enumerate(k)
    )
    beside = sum(float(np.sum(np.square(scale * each))) for each in coupled)
    if not (gap > 0.0 and spread < 1.0 and least > 0.0):
        raise UndecidedError("other ends too near, for numbers that wide")
    beside = beside / (1.0 - spread) / least * (1.0 + 1e-9)
    # The pencil of two, less the first quotient, whose own entry vanishes.
    value = quotients[0]
    mixed, other = (t[i][1] - value * k[i][1] for i in range(2))
    middle = other * k[0][0] - 2.0 * mixed * k[0][1]
    product = k[0][0] * k[1][1] - k[0][1] ** 2
    root = np.sqrt(middle**2 + 4.0 * product * mixed**2)
    value = value - 2.0 * mixed**2 / (middle + np.sign(middle.middle) * root)
    if not beside + 2.0 * mixed.largest() / least < _FREE * gap:
        raise UndecidedError("other ends too near, for numbers that wide")
    return TaylorModel(value.coefficients, value.rest + beside, value.n)
