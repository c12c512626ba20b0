"""All natural frequencies of a transcendental eigenproblem (Aannaque 5.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .divisions import divided_for, narrow_enough
from .frames import DynamicStiffness
from .inertia import UNIT, modal, projected, quadratic_forms, rounding, signs

Array = NDArray[np.float64]
Count = Callable[[float], int]

# Frequencies nearer than this, relatively, are found together, in the span of their vectors.
_TOGETHER = 1e-7
_STEPS = 100
_CLOSE = 1e-8
_NUDGE = 1.0 + 1e-7


@dataclass(frozen=True)
class Mode:
    """One natural frequency of a structure.

    Attributes
    ----------
    omega : float
        Frequency [rad/s].
    error : float
        Bound of its error [rad/s].
    problem : DynamicStiffness
        The structure, divided so that the frequency is no pole.
    vector : ndarray, shape (problem.size,)
        Coordinates of that, of unit generalised mass.
    certified : bool
        Whether the counts on both sides confirm the bound.
    """

    omega: float
    error: float
    problem: DynamicStiffness
    vector: Array
    certified: bool


@dataclass(frozen=True)
class Interval:
    """Frequencies number ``first + 1`` to ``last`` lie between two frequencies."""

    low: float
    high: float
    first: int
    last: int


def certain_count(problem: DynamicStiffness, omega: float) -> tuple[float, int]:
    """Return how many frequencies lie below one close to ``omega``, and that one."""
    for _ in range(3):
        negative, certain = signs(problem.assembly, omega)
        if certain:
            return omega, round(float(problem.poles(omega))) + negative
        omega *= _NUDGE
    finer = divided_for(problem, omega)
    return omega, round(float(finer.poles(omega))) + modal(finer.assembly, omega).negative


def isolate(problem: DynamicStiffness, whole: Interval) -> list[Interval]:
    """Return narrow intervals with all frequencies of one, in ascending order."""
    found, pending = [], [whole]
    while pending:
        item = pending.pop()
        if item.first == item.last:
            continue
        width = (item.high - item.low) / item.high
        narrow = narrow_enough(problem, item.high)
        if width <= narrow and (item.last == item.first + 1 or width <= narrow**2):
            found.append(item)
            continue
        middle = ((np.sqrt(item.low) + np.sqrt(item.high)) / 2.0) ** 2
        place, count = certain_count(problem, float(middle))
        count = min(max(count, item.first), item.last)
        pending.append(Interval(place, item.high, count, item.last))
        pending.append(Interval(item.low, place, item.first, count))
    return found


def solve(problem: DynamicStiffness, item: Interval) -> list[Mode]:
    """Return the modes of an interval to full precision."""
    finer = divided_for(problem, item.low, item.high)
    numbers = range(item.first + 1, item.last + 1)
    rough = sorted(_newton(finer, item, number) for number in numbers)
    modes: list[Mode] = []
    done = 0
    while done < len(rough):
        end = done + 1
        while end < len(rough) and rough[end] - rough[end - 1] < _TOGETHER * rough[end]:
            end += 1
        modes += _together(finer, rough[done:end], item.first + done)
        done = end
    return modes


def _newton(finer: DynamicStiffness, item: Interval, number: int) -> float:
    """Return a frequency by its number, counted from 1.

    The eigenvalue of that number of ``D x = mu M x`` falls steadily through zero, and mu is
    Newton's step of the squared frequency.
    """
    low, high = item.low, item.high
    omega = (low + high) / 2.0
    for _ in range(_STEPS):
        found = modal(finer.assembly, omega)
        index = number - round(float(finer.poles(omega))) - 1
        step = float(found.values[min(max(index, 0), finer.size - 1)])
        low, high = (omega, high) if step > 0.0 else (low, omega)
        square = omega**2 + step
        if abs(step) <= _CLOSE * omega**2:  # Newton's error is the square of this
            return float(np.sqrt(square))
        new = float(np.sqrt(square)) if square > 0.0 else low
        omega = new if low < new < high else (low + high) / 2.0
    return omega


def _together(finer: DynamicStiffness, rough: list[float], before: int) -> list[Mode]:
    """Return modes that are close, or a single one, with error bounds that counts confirm."""
    omega = float(np.mean(rough))
    found = modal(finer.assembly, omega)
    index = before - round(float(finer.poles(omega)))
    index = min(max(index, 0), finer.size - len(rough))
    chosen = found.vectors[:, index : index + len(rough)]
    values, vectors = projected(finer.assembly, omega, chosen)
    places = np.sqrt(np.maximum(omega**2 + values, 0.0))
    _, mass, sizes = quadratic_forms(finer.assembly, omega, vectors)
    spread = rounding(sizes) / (2.0 * omega * np.diagonal(mass))
    width, certified = _confirmed(finer, places, before, np.max(spread))
    return [
        Mode(float(place), float(width + own), finer, _signed(vector), certified)
        for place, own, vector in zip(places, spread, vectors.T, strict=True)
    ]


def _confirmed(
    finer: DynamicStiffness, places: Array, before: int, least: float
) -> tuple[float, bool]:
    """Return the smallest distance on either side of frequencies that counts confirm."""
    width = max(4.0 * UNIT * places[-1], least / 8.0)
    for _ in range(12):
        low, high = places[0] - width, places[-1] + width
        below, above = (
            round(float(finer.poles(place))) + modal(finer.assembly, float(place)).negative
            for place in (low, high)
        )
        if below == before and above == before + len(places):
            return float(width), True
        width *= 4.0
    return float(width), False


def _signed(vector: Array) -> Array:
    """Return a vector with its largest component positive."""
    return np.asarray(vector * np.sign(vector[np.argmax(np.abs(vector))]))
