"""Matrices of a uniform beam that vibrates harmonically, exact at every frequency."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...generated import beam_dynamic_stiffness
from ..core.errors import Problem, bad, refuse

Array: TypeAlias = NDArray[Any]

functions: Any = beam_dynamic_stiffness

# Places in the local matrix (row, column, sign, number of the function, power of the length);
# coordinates u1, v1, r1, u2, v2, r2.
_BENDING = (
    (1, 1, 1, 5, 0),
    (1, 2, -1, 3, 1),
    (1, 4, 1, 4, 0),
    (1, 5, 1, 2, 1),
    (2, 2, 1, 1, 2),
    (2, 4, -1, 2, 1),
    (2, 5, 1, 0, 2),
    (4, 4, 1, 5, 0),
    (4, 5, 1, 3, 1),
    (5, 5, 1, 1, 2),
)
_AXIAL = ((0, 0, 0), (0, 3, 1), (3, 3, 0))


def phases(
    omega: ArrayLike,
    length: ArrayLike,
    bending_stiffness: ArrayLike,
    axial_stiffness: ArrayLike,
    mass_per_length: ArrayLike,
) -> tuple[Array, Array]:
    """Return ``z = lambda L`` (Aannaque (5.4)) and ``b = beta L`` (5.9) of beams, ``(..., n)``."""
    rate = np.asarray(omega)[..., None]
    mass, span = np.asarray(mass_per_length), np.asarray(length)
    z = np.sqrt(rate) * (span * np.sqrt(np.sqrt(mass / np.asarray(bending_stiffness))))
    b = rate * (span * np.sqrt(mass / np.asarray(axial_stiffness)))
    # Phases are kept above these; the functions are at their static values long before.
    return np.where(np.abs(z) < 1e-30, 1e-30, z), np.where(np.abs(b) < 1e-100, 1e-100, b)


def member_matrices(
    omega: ArrayLike,
    length: ArrayLike,
    bending_stiffness: ArrayLike,
    axial_stiffness: ArrayLike,
    mass_per_length: ArrayLike,
) -> tuple[Array, Array]:
    """Return dynamic stiffness and mass of uniform beams in their own axes, ``(..., n, 6, 6)``.

    Aannaque (5.18) and (5.19): ``D(omega)`` gives the end forces of a harmonic motion, and ``M =
    -dD/d(omega^2)`` its generalised mass; ``K = D + omega^2 M`` (5.17).  Rows are u1, v1, r1, u2,
    v2, r2: displacement along and across the beam, rotation, of either end.

    Frequencies [rad/s] have any shape; L [m], EI [N m^2], EA [N] and rho A [kg/m] shape ``(n,)``.
    Complex stiffnesses stand for sections that lose energy.  An infinite EA gives an inextensible
    beam: of the axial part the mass alone is left, for displacements that are equal at both ends.
    Refused are frequencies that are not finite, and other numbers that are not positive.
    """
    rates = np.asarray(omega)
    if rates.dtype.kind not in "fciu" or not rates.size or not np.all(np.isfinite(rates)):
        raise bad("omega", repr(omega), "finite frequencies [rad/s]", "correct them")
    names = ("length", "bending_stiffness", "axial_stiffness", "mass_per_length")
    given = (length, bending_stiffness, axial_stiffness, mass_per_length)
    _require_positive(dict(zip(names, given, strict=True)))
    span, ei, ea, m = np.broadcast_arrays(*(np.atleast_1d(np.asarray(v)) for v in given))
    z, b = phases(omega, span, ei, ea, m)
    weight = m * span
    stretch, stretch_rates = np.array(functions.axial(b)), np.array(functions.axial_rates(b))
    rigid = np.isinf(ea)
    square = np.asarray(omega)[..., None] ** 2
    elastic = np.where(rigid, 1.0, ea) / span * stretch
    along = np.where(rigid, -square * weight * stretch_rates, elastic)
    stiffness = _placed((ei / span**3) * np.array(functions.bending(z)), along, span)
    bend_rates = np.array(functions.bending_rates(z))
    return stiffness, _placed(weight * bend_rates, weight * stretch_rates, span)


def member_inertias(
    omega: float,
    length: Array,
    bending_stiffness: Array,
    axial_stiffness: Array,
    mass_per_length: Array,
) -> Array:
    """Return ``H = (D(0) - D(omega)) / omega^2`` of beams, no difference of large numbers."""
    given = (length, bending_stiffness, axial_stiffness, mass_per_length)
    z, b = phases(omega, *given)
    weight = mass_per_length * length
    across, along = functions.bending_inertias(z), functions.axial_inertias(b)
    return _placed(weight * np.array(across), weight * np.array(along), length)


def _placed(across: Array, along: Array, length: Array) -> Array:
    """Return matrices ``(..., n, 6, 6)`` of the functions of bending and of axial motion."""
    found = np.zeros((*across.shape[1:], 6, 6), np.result_type(across, along))
    for row, column, sign, which, power in _BENDING:
        found[..., row, column] = found[..., column, row] = sign * length**power * across[which]
    for row, column, which in _AXIAL:
        found[..., row, column] = found[..., column, row] = along[which]
    return found


def _require_positive(values: dict[str, ArrayLike]) -> None:
    problems = []
    for name, value in values.items():
        array = np.asarray(value)
        usable = array.dtype.kind in "fciu" and array.size
        if not usable or not bool(np.all(array.real > 0)):
            fix = "give SI units; a beam of no length joins its nodes"
            problems.append(Problem(name, repr(value), "positive numbers", fix))
    refuse(problems)
