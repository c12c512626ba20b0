"""One exact element for each link, its matrices taken at the first natural frequency (7.4.1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams._checks import is_finite, numbers_in_a_row, require_kind
from ..beams.structure import Structure
from ..errors import bad
from ..plotting import axes_or_new
from ..results import Check, Result, provenance
from .frames import dynamic_stiffness
from .wittrick_williams import rigid_motions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_MOST_STEPS = 50


@dataclass(frozen=True, kw_only=True)
class HybridMatrices(Result):
    """Mass and stiffness of one element for each link, corrected for the frequency.

    Attributes
    ----------
    theta : ndarray, shape (nt,)
        Crank angles [rad].
    mass, stiffness : ndarray, shape (nt, n, n)
        M and K at the first natural frequency (Aannaque (5.16), (5.17)).
    first : ndarray, shape (nt,)
        That frequency [rad/s].
    polynomial : ndarray, shape (nt,)
        The frequency of the cubic element, where the iteration starts [rad/s].
    iterations : ndarray, shape (nt,)
        How often the matrices were formed anew.
    labels : tuple of str
        Names of the coordinates.
    error : ndarray, shape (nt,)
        Estimate of the error of the first frequency [rad/s].
    """

    theta: Array
    mass: Array
    stiffness: Array
    first: Array
    polynomial: Array
    iterations: NDArray[np.int64]
    labels: tuple[str, ...]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta": ("theta",),
        "mass": ("theta", "row", "column"),
        "stiffness": ("theta", "row", "column"),
        "first": ("theta",),
        "polynomial": ("theta",),
        "iterations": ("theta",),
        "error": ("theta",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first frequency [Hz] over the crank angle, exact and of the cubic element."""
        axes = axes_or_new(ax)
        degrees = np.degrees(self.theta)
        axes.plot(degrees, self.first / (2.0 * np.pi), label="exact")
        axes.plot(degrees, self.polynomial / (2.0 * np.pi), "--", label="cubic element")
        axes.set_xlabel("crank angle [deg]")
        axes.set_ylabel("first natural frequency [Hz]")
        axes.legend()
        return axes


def hybrid_matrices(
    structure: Structure, theta: ArrayLike, *, rtol: float = 1e-3
) -> HybridMatrices:
    """Return the matrices of the thesis' "exact" model at crank angles.

    At each angle the first frequency of the cubic elements gives M(omega) and K(omega), these a
    better frequency, and so on.  That is Newton's method on the exact eigenproblem, so that few
    steps suffice and the frequency that remains is the exact one.

    Parameters
    ----------
    structure : Structure
        Linkage or frame; each beam becomes one element.
    theta : array_like, shape (nt,)
        Crank angles [rad].
    rtol : float
        Relative change of the frequency at which the iteration stops; 1e-3 in the thesis.

    Returns
    -------
    HybridMatrices

    Raises
    ------
    BadInput
        If the angles are no numbers in a row, or the tolerance is not between 1e-14 and 1.

    References
    ----------
    Aannaque 7.4.1.
    """
    require_kind("structure", structure, Structure, "make one with beam_linkage or frame")
    angles = numbers_in_a_row("theta", theta, " [rad]")
    structure.require_pinned("hybrid_matrices")
    if not (is_finite(rtol) and 1e-14 <= rtol < 1.0):
        raise bad("rtol", repr(rtol), "between 1e-14 and 1", "choose 1e-3")
    rows = [_at_angle(structure, float(angle), rtol) for angle in angles]
    last = max(row.change / row.first for row in rows)
    problem = dynamic_stiffness(structure, float(angles[0]))
    return HybridMatrices(
        theta=angles,
        mass=np.array([row.mass for row in rows]),
        stiffness=np.array([row.stiffness for row in rows]),
        first=np.array([row.first for row in rows]),
        polynomial=np.array([row.start for row in rows]),
        iterations=np.array([row.steps for row in rows], dtype=np.int64),
        labels=problem.labels,
        method="matrices of the exact element at its own first frequency",
        # The step after the last would be of the size of its square: Newton's method.
        error=np.array([4.0 * row.change**2 / row.first + 1e-9 * row.first for row in rows]),
        error_norm="first frequency at each angle, absolute [rad/s]",
        error_kind="estimate",
        checks={"last relative change": Check(float(last), rtol)},
        provenance=provenance(structure.provenance),
    )


@dataclass(frozen=True)
class _Row:
    mass: Array
    stiffness: Array
    first: float
    start: float
    change: float
    steps: int


def _at_angle(structure: Structure, theta: float, rtol: float) -> _Row:
    from scipy.linalg import eigh

    problem = dynamic_stiffness(structure, theta)

    def matrices(omega: float) -> tuple[Array, Array]:
        mass = problem.mass(omega)
        return mass, problem.stiffness(omega) + omega**2 * mass

    def lowest(mass: Array, stiffness: Array) -> float:
        values = eigh(stiffness, mass, eigvals_only=True, subset_by_index=(0, 0))
        return float(np.sqrt(max(values[0], 0.0)))

    if rigid_motions(problem):
        found = "a motion that meets no stiffness"
        raise bad("structure", found, "a held structure", "hold a node")
    start = omega = lowest(*matrices(0.0))
    mass, stiffness = matrices(omega)
    change, steps = np.inf, 0
    while change > rtol * omega and steps < _MOST_STEPS:
        mass, stiffness = matrices(omega)
        new = lowest(mass, stiffness)
        change, omega, steps = abs(new - omega), new, steps + 1
    return _Row(mass, stiffness, omega, start, change, steps)
