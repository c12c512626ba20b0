"""One exact element for each link, its matrices taken at the first natural frequency (7.4.1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.structure import Structure
from ..core.errors import bad
from ..core.families import LinearPeriodic, Term
from ..core.inputs import is_finite, numbers_in_a_row, require_kind
from ..core.results import Check, Result, provenance
from ..frequencies.counting import modal, quadratic_forms, rigid_motions, rounding
from ..frequencies.frames import DynamicStiffness, dynamic_stiffness
from ..systems import with_modal_damping
from .aannaque_models import beams, structure_of

Array = NDArray[np.float64]

_MOST_STEPS = 200
# Relative width of an interval that holds both the frequency and one with all nodes held.
_STANDS_STILL = 1e-11


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
        Bound of the error of the first frequency [rad/s]; a count confirms that none is lower.
    """

    theta: Array
    mass: Array
    stiffness: Array
    first: Array
    polynomial: Array
    iterations: NDArray[np.int64]
    labels: tuple[str, ...]


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
        If the angles are no numbers in a row, the tolerance is not between 1e-14 and 1, a motion
        meets no stiffness, or every node stands still in the first mode.

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
        error=np.array([row.error for row in rows]),
        error_norm="first frequency at each angle, absolute [rad/s]",
        error_kind="bound",
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
    error: float


def _at_angle(structure: Structure, theta: float, rtol: float) -> _Row:
    from scipy.linalg import eigh

    problem = dynamic_stiffness(structure, theta)

    def matrices(omega: float) -> tuple[Array, Array]:
        mass = problem.mass(omega)
        return mass, problem.stiffness(omega) + omega**2 * mass

    if rigid_motions(problem):
        found = "a motion that meets no stiffness"
        raise bad("structure", found, "a held structure", "hold a node")
    mass, stiffness = matrices(0.0)
    square = float(eigh(stiffness, mass, eigvals_only=True, subset_by_index=(0, 0))[0])
    start = float(np.sqrt(max(square, 0.0)))
    formed, omega, steps, error = _first(problem, start, rtol)
    mass, stiffness = matrices(formed)
    return _Row(mass, stiffness, omega, start, abs(omega - formed), steps, error)


def _first(problem: DynamicStiffness, start: float, rtol: float) -> tuple[float, float, int, float]:
    """Return the last two trial frequencies, how many steps there were, and the error of the last.

    Below the first frequency with all nodes held, D falls and bends downward with the squared
    frequency: no step passes the frequency wanted from above.  The cubic element or a step from
    far below may lie beyond, where D tells nothing of it; then the interval is halved.
    """
    low, high, omega, steps = 0.0, np.inf, start, 0
    formed = np.nan
    for _ in range(_MOST_STEPS):
        if problem.poles(omega) > 0:
            high = min(high, omega)
            if high - low <= _STANDS_STILL * high:
                break
            omega, formed = 0.5 * (low + high), np.nan
            continue
        new, rounded = _newton(problem, omega)
        if abs(omega - formed) <= rtol * omega:
            # What is left is Newton's next step, but for its square; next to a pole steps are
            # short as well, but the count there tells.
            error = 2.0 * abs(new - omega) + rounded
            if modal(problem.assembly, max(omega - error, 0.0)).negative == 0:
                return formed, omega, steps, error
        low = omega if new > omega else low
        formed, omega, steps = omega, new, steps + 1
    found = "a first mode in which every node stands still"
    raise bad("structure", found, "nodes that move", "add a node within the beam that bends")


def _newton(problem: DynamicStiffness, omega: float) -> tuple[float, float]:
    """Return the first frequency by M and K at another one, and what rounding does to it."""
    found = modal(problem.assembly, omega)
    new = float(np.sqrt(max(omega**2 + float(found.values[0]), 0.0)))
    _, mass, sizes = quadratic_forms(problem.assembly, omega, found.vectors[:, :1])
    spread = float(rounding(sizes)[0]) / float(mass[0, 0])
    return new, spread / (2.0 * max(new, np.sqrt(spread)))


_ANGLES = 128


@lru_cache(maxsize=2)
def hybrid(rtol: float) -> HybridMatrices:
    """Return the matrices of the beams of Table 4.1 at even crank angles."""
    return hybrid_matrices(
        structure_of(beams(1)), 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES, rtol=rtol
    )


def fourier_sum(coefficients: NDArray[np.complex128], order: int, theta: Array) -> Array:
    """Return a Fourier series, or its derivative of an order, ``(nt, ...)``."""
    harmonics = np.arange(len(coefficients))
    factors = (1j * harmonics) ** order * np.where(harmonics, 2.0, 1.0)
    waves = np.exp(1j * np.outer(theta, harmonics)) * factors
    return np.asarray(np.tensordot(waves, coefficients, axes=1).real)


@lru_cache(maxsize=1)
def hybrid_model() -> LinearPeriodic:
    """Return the thesis' "exact" model: one element for each link, M and K at the first frequency.

    Damping 2 %, the form of the thesis; the inertia of the rigid motion by the same masses.
    """
    base, found = beams(1), hybrid(1e-10)
    order = [found.labels.index(label) for label in base.labels]
    places = np.ix_(range(_ANGLES), order, order)
    mass, stiffness = found.mass[places], found.stiffness[places]
    cubic, force = base.array("M", found.theta), base.array("f", found.theta)
    push = mass @ np.linalg.solve(cubic, force[..., None])
    kept = _ANGLES // 2
    m, k, f = (np.fft.rfft(a, axis=0)[:kept] / _ANGLES for a in (mass, stiffness, push[..., 0]))
    terms = (
        Term("M", None, partial(fourier_sum, m, 0)),
        # The family's own M' is taken out, as of any instantaneous form.
        Term("C", None, partial(fourier_sum, -m, 1), power=1),
        Term("K", None, partial(fourier_sum, k, 0)),
        Term("f", None, partial(fourier_sum, f, 0)),
    )
    bare = LinearPeriodic(
        base.size,
        terms,
        {},
        lambda values: {},
        labels=base.labels,
        relative_deflection=base.relative_deflection,
        structure=base.structure,
    )
    return with_modal_damping(bare, 0.02)
