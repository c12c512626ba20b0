"""Wittrick and Williams' algorithm: every natural frequency of a frame, none missed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..beams._checks import is_finite
from ..core.errors import BadInput, Problem, bad
from ..core.families import Transcendental
from ..core.inputs import is_whole
from ..core.results import Check, provenance
from .bisection import bisected
from .frames import DynamicStiffness
from .inertia import quadratic_forms
from .result import FrameFrequencies
from .solutions import Interval, Mode, certain_count, isolate, solve

Array = NDArray[np.float64]

_MOST_DOUBLINGS = 200
# Motions whose strain energy is below this, over the sizes of its terms, meet no stiffness.
_RIGID = 1e-11


def wittrick_williams(
    problem: Transcendental,
    *,
    upto: float | None = None,
    count: int | None = None,
    rtol: float = 1e-12,
) -> FrameFrequencies:
    """Return the natural frequencies of a transcendental eigenproblem, all of them.

    The number of frequencies below any trial frequency is that of the clamped members plus the
    number of negative eigenvalues of the dynamic stiffness (Aannaque (5.21)).  Bisection on that
    number isolates each frequency; Newton's method on the eigenvalue that goes through zero brings
    it to the last digits, with members divided where the nodes would stand still; counts on both
    sides confirm it.

    Parameters
    ----------
    problem : Transcendental
        From :func:`dynamic_stiffness`; of another one, an emitted one say, frequencies are found
        by bisection alone and there are no shapes.
    upto : float, optional
        All frequencies below this one [rad/s].
    count : int, optional
        That many frequencies, the lowest ones; give one of the two.
    rtol : float
        Relative width that is asked for where there is bisection alone.

    Returns
    -------
    FrameFrequencies
        A frequency stands as often as its multiplicity; motions that meet no stiffness stand as
        frequencies 0 in front.

    Raises
    ------
    BadInput
        If not exactly one of ``upto`` and ``count`` is given, or one is not usable.
    """
    _check(upto, count, rtol)
    if not isinstance(problem, Transcendental):
        found = type(problem).__name__
        raise bad("problem", found, "a Transcendental", "make one with dynamic_stiffness")
    if not isinstance(problem, DynamicStiffness):
        return bisected(problem, upto, count, rtol)
    rigid = rigid_motions(problem)
    low = _below_all(problem, len(rigid))
    high = upto if upto is not None else _above(problem, low, count or 1)
    modes = list(rigid)
    total = len(rigid)
    if high > low:
        high, total = certain_count(problem, high)
        for item in isolate(problem, Interval(low, high, len(rigid), total)):
            modes += solve(problem, item)
    kept = [mode for mode in modes if upto is None or mode.omega < upto]
    kept = kept if count is None else kept[:count]
    return _result(problem, kept, len(modes), total)


def rigid_motions(problem: DynamicStiffness) -> list[Mode]:
    """Return the motions that meet no stiffness, as modes of frequency 0."""
    from scipy.linalg import eigh

    still = 0.0
    stiffness, mass = problem.assembly.stiffness(still), problem.mass(still)
    scale = 1.0 / np.sqrt(np.diagonal(mass))
    both = np.outer(scale, scale)
    _, turned = eigh(stiffness * both, mass * both)
    vectors = scale[:, None] * turned
    forms, _, sizes = quadratic_forms(problem.assembly, still, vectors)
    soft = np.abs(np.diagonal(forms)) <= _RIGID * sizes
    return [Mode(0.0, 0.0, problem, vector, True) for vector in vectors.T[soft]]


def _scale(problem: DynamicStiffness) -> float:
    """Return a frequency of the size of the members' own."""
    length, bending, _, mass = problem.assembly.data
    return float(np.min(np.sqrt(bending / mass) / length**2))


def _below_all(problem: DynamicStiffness, rigid: int) -> float:
    """Return a frequency below all that are not 0."""
    low = _scale(problem)
    for _ in range(_MOST_DOUBLINGS):
        low, found = certain_count(problem, low)
        if found <= rigid:
            return low
        low /= 4.0
    raise bad(
        "structure",
        "a motion that meets next to no stiffness",
        "frequencies well above 0",
        "hold the structure, or stiffen the soft spring",
    )


def _above(problem: DynamicStiffness, low: float, count: int) -> float:
    """Return a frequency with at least so many below."""
    high = low
    for _ in range(_MOST_DOUBLINGS):
        high, found = certain_count(problem, 1.7 * high)
        if found >= count:
            return high
    raise bad("count", str(count), "fewer frequencies", "ask for fewer")


def _result(
    problem: DynamicStiffness, modes: list[Mode], found: int, total: int
) -> FrameFrequencies:
    omega = np.array([mode.omega for mode in modes])
    error = np.array([mode.error for mode in modes])
    uncertain = sum(not mode.certified for mode in modes)
    return FrameFrequencies(
        frequencies=omega,
        multiplicity=multiplicities(omega, error),
        modes=tuple(modes),
        problem=problem,
        method="Wittrick-Williams count, Newton's method on the eigenvalue of D",
        error=error,
        error_norm="each frequency, absolute [rad/s]",
        error_kind="bound",
        checks={
            "frequencies not found": Check(float(abs(found - total)), 0.0),
            "frequencies that counts do not confirm": Check(float(uncertain), 0.0),
        },
        provenance=provenance(problem.provenance),
    )


def multiplicities(omega: Array, error: Array) -> NDArray[np.int64]:
    """Return for each frequency how many are no farther from each other than their errors."""
    found = np.ones(len(omega), dtype=np.int64)
    start = 0
    for i in range(1, len(omega) + 1):
        ends = i == len(omega) or omega[i] - omega[i - 1] > error[i] + error[i - 1]
        if ends:
            found[start:i] = i - start
            start = i
    return found


def _check(upto: float | None, count: int | None, rtol: float) -> None:
    problems = []
    if (upto is None) == (count is None):
        found = "neither" if upto is None else "both"
        problems.append(Problem("upto, count", found, "one of the two", "choose"))
    if upto is not None and not (is_finite(upto) and upto > 0):
        problems.append(Problem("upto", repr(upto), "a positive frequency [rad/s]", "correct it"))
    if count is not None and not is_whole(count, 1):
        problems.append(Problem("count", repr(count), "a whole number from 1", "correct it"))
    if not (is_finite(rtol) and 1e-15 <= rtol < 1.0):
        problems.append(Problem("rtol", repr(rtol), "between 1e-15 and 1", "choose 1e-12"))
    if problems:
        raise BadInput(*problems)
