"""Aannaque's "exact" model (7.4.1): one element for each link at its first natural frequency."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from ..beams import Structure
from ..core.families import Array, LinearPeriodic, Term
from ..frequencies import dynamic_stiffness
from ..systems import with_modal_damping
from .aannaque_models import beams, structure_of

_ANGLES = 128


@dataclass(frozen=True)
class HybridMatrices:
    """Mass and stiffness of one element for each link at crank angles [rad], at their first mode.

    M and K ``(nt, n, n)`` as in (5.16) and (5.17), that frequency [rad/s], how often the matrices
    were formed anew, and the names of the coordinates.
    """

    theta: Array
    mass: Array
    stiffness: Array
    first: Array
    iterations: NDArray[np.int64]
    labels: tuple[str, ...]


def hybrid_matrices(structure: Structure, theta: Array, rtol: float = 1e-3) -> HybridMatrices:
    """Return the matrices of the thesis' "exact" model at crank angles.

    At each angle the first frequency of the cubic elements gives M(omega) and K(omega), these a
    better frequency, and so on until it changes by less than ``rtol``.  That is Newton's method on
    the exact eigenproblem, so that few steps suffice; it needs a cubic element that is not far off.
    """
    from scipy.linalg import eigh

    rows = []
    for angle in theta:
        problem = dynamic_stiffness(structure, float(angle))
        omega, formed, steps = 0.0, -1.0, -1
        while steps < 1 or abs(omega - formed) > rtol * omega:
            formed, steps = omega, steps + 1
            mass = problem.mass(formed)
            stiffness = problem.stiffness(formed) + formed**2 * mass
            square = eigh(stiffness, mass, eigvals_only=True, subset_by_index=(0, 0))[0]
            omega = float(np.sqrt(square))
        rows.append((mass, stiffness, omega, steps))
    mass, stiffness, first, iterations = (np.array(part) for part in zip(*rows, strict=True))
    return HybridMatrices(theta, mass, stiffness, first, iterations, problem.labels)


@lru_cache(maxsize=2)
def hybrid(rtol: float) -> HybridMatrices:
    """Return the matrices of the beams of Table 4.1 at even crank angles."""
    angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    return hybrid_matrices(structure_of(beams(1)), angles, rtol)


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
    base, exact = beams(1), hybrid(1e-10)
    order = [exact.labels.index(label) for label in base.labels]
    places = np.ix_(range(_ANGLES), order, order)
    mass, stiffness = exact.mass[places], exact.stiffness[places]
    cubic, force = base.array("M", exact.theta), base.array("f", exact.theta)
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
