"""Signs and small eigenvalues of a dynamic stiffness, to nearly the last digit.

Axial stiffness exceeds bending stiffness a millionfold, and a plain eigenvalue solver leaves
errors of the largest eigenvalue's size times the machine's precision.  Its eigenvectors are good
enough: quadratic forms in them, summed member by member in the member's own axes, are exact but
for rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .frames import Assembly

Array = NDArray[np.float64]

UNIT = 2.0**-53
# Scaled eigenvalues below this, over the largest, may have the wrong sign.
_DOUBTFUL = 1e-11
# Modes whose eigenvalue is within this, over omega^2, are brought in order by quadratic forms.
_NEAR = 30.0
# Rounding of an entry of a local matrix, over u times its allowed size: functions, products, turn.
_ENTRY = 32.0


def quadratic_forms(
    assembly: Assembly, omega: float, vectors: Array, mass: Array | None = None
) -> tuple[Array, Array, Array]:
    """Return ``X^T D X``, ``X^T M X`` and the sizes of the terms of the first one's diagonal.

    Parameters
    ----------
    assembly : Assembly
        The members.
    omega : float
        Frequency [rad/s].
    vectors : ndarray, shape (size, k)
        Columns.
    mass : ndarray, optional
        Local mass matrices where they are known.

    Returns
    -------
    stiffness, mass : ndarray, shape (k, k)
    sizes : ndarray, shape (k,)
        Sum of the sizes of everything that is added, mass included: u times it is what rounding
        does.
    """
    if mass is None:
        _, mass = assembly.local_matrices(omega)
    inertia = assembly.local_inertias(omega)
    ends = assembly.local @ vectors
    felt = np.abs(assembly.local) @ np.abs(vectors)  # what rounding sees
    nodes = assembly.reduction @ vectors
    strained, strained_sizes = _strain_forms(assembly, ends, felt)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    moved = nodes.T @ (lumps[:, None] * nodes)
    plain = strained - omega**2 * _forms(inertia, ends) + moved
    heavy = _forms(mass, ends) + nodes.T @ (assembly.lumped_mass[:, None] * nodes)
    # omega dH/d(omega) is of the size of M: what a rounded length or section does.
    entries = omega**2 * (np.abs(inertia) + 4.0 * np.abs(mass))
    sizes = strained_sizes + np.einsum("nak,nab,nbk->k", felt, entries, felt, optimize=True)
    weights = assembly.springs + omega**2 * assembly.lumped_mass
    sizes = sizes + np.sum(weights[:, None] * nodes**2, axis=0)
    return _symmetric(plain), _symmetric(heavy), sizes


def _strain_forms(assembly: Assembly, ends: Array, felt: Array) -> tuple[Array, Array]:
    """Return the static strain energy, twice, by stretch and turning against the chord."""
    length, bending, axial, _ = assembly.data
    stiff = np.where(np.isinf(axial), 0.0, axial) / length
    span = length[:, None]
    stretch = ends[:, 3] - ends[:, 0]
    chord = (ends[:, 4] - ends[:, 1]) / span
    first, second = ends[:, 2] - chord, ends[:, 5] - chord
    turn = (bending / length)[:, None]
    moments = turn * (4.0 * first + 2.0 * second), turn * (2.0 * first + 4.0 * second)
    forms = stretch.T @ (stiff[:, None] * stretch) + first.T @ moments[0] + second.T @ moments[1]
    seen = felt[:, 2] + felt[:, 5] + 2.0 * (felt[:, 1] + felt[:, 4]) / span
    sizes = stiff[:, None] * np.abs(stretch) * (felt[:, 0] + felt[:, 3])
    sizes = sizes + (np.abs(moments[0]) + np.abs(moments[1])) * seen
    return np.asarray(forms), np.asarray(np.sum(sizes, axis=0))


def _forms(matrices: Array, ends: Array) -> Array:
    count = ends.shape[-1]
    return np.asarray(ends.reshape(-1, count).T @ (matrices @ ends).reshape(-1, count))


def _symmetric(matrix: Array) -> Array:
    return np.asarray((matrix + matrix.T) / 2.0)


def rounding(sizes: Array) -> Array:
    """Return a bound, to first order, of what rounding does to quadratic forms of those sizes."""
    return np.asarray(_ENTRY * UNIT * sizes)


def signs(assembly: Assembly, omega: float) -> tuple[int, bool]:
    """Return the number of negative eigenvalues of D at a frequency, and whether it is certain."""
    local, _ = assembly.local_matrices(omega)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    matrix = assembly.assembled(local, lumps)
    if not np.all(np.isfinite(matrix)):
        return 0, False  # on a pole
    sizes = np.einsum(
        "nai,nab,nbi->i", np.abs(assembly.local), np.abs(local), np.abs(assembly.local)
    )
    sizes = sizes + (np.abs(lumps)[:, None] * assembly.reduction**2).sum(axis=0)
    scale = 1.0 / np.sqrt(sizes)
    values = np.linalg.eigvalsh(matrix * np.outer(scale, scale))
    certain = bool(np.min(np.abs(values)) > _DOUBTFUL * np.max(np.abs(values)))
    return int(np.sum(values < 0.0)), certain


@dataclass(frozen=True)
class Modal:
    """``D x = mu M x`` at one frequency: mu is what is missing to the squares of frequencies.

    Attributes
    ----------
    values : ndarray, shape (n,)
        mu, ascending.
    vectors : ndarray, shape (size, n)
        x, of unit generalised mass.
    """

    values: Array
    vectors: Array

    @property
    def negative(self) -> int:
        """How many of the values are negative."""
        return int(np.sum(self.values < 0.0))


def modal(assembly: Assembly, omega: float) -> Modal:
    """Solve ``D x = mu M x`` at a frequency [rad/s] away from the poles."""
    from scipy.linalg import eigh

    local, local_mass = assembly.local_matrices(omega)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    stiffness = assembly.assembled(local, lumps)
    mass = assembly.assembled(local_mass, assembly.lumped_mass)
    scale = 1.0 / np.sqrt(np.diagonal(mass))
    both = np.outer(scale, scale)
    values, turned = eigh(stiffness * both, mass * both)
    vectors = scale[:, None] * turned
    near = np.abs(values) <= _NEAR * omega**2
    if near.any():
        values[near], vectors[:, near] = projected(assembly, omega, vectors[:, near], local_mass)
    return Modal(values, vectors)


def projected(
    assembly: Assembly, omega: float, vectors: Array, mass: Array | None = None
) -> tuple[Array, Array]:
    """Return the values and vectors of :class:`Modal` within the span of some columns."""
    from scipy.linalg import eigh

    stiffness, heavy, _ = quadratic_forms(assembly, omega, vectors, mass)
    values, inner = eigh(stiffness, heavy)
    return values, np.asarray(vectors @ inner)
