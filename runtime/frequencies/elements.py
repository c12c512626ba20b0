"""The finite-element model of the same structure, for comparison: inextensible beams too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..beams.assembly import AngleArrays
from ..beams.linear import lumped_values
from ..beams.structure import Structure
from .frames import rigid_beams, turning_matrix, without_stretch

Array = NDArray[np.float64]


def element_matrices(
    structure: Structure,
    theta: float = 0.0,
    *,
    inextensible: bool | tuple[str, ...] = False,
) -> tuple[Array, Array, Array]:
    """Return mass and stiffness of the structure's own elements at one position.

    Parameters
    ----------
    structure : Structure
        With the elements that its beams name.
    theta : float
        Crank angle [rad].
    inextensible : bool or tuple of str
        Beams that cannot stretch: True for all.

    Returns
    -------
    mass, stiffness : ndarray, shape (size, size)
        On the coordinates that are left.
    reduction : ndarray, shape (structure.size, size)
        The free coordinates by those that are left.

    Raises
    ------
    BadInput
        If an argument is unusable, or nothing is left that moves.
    """
    rigid = rigid_beams("element_matrices", structure, theta, inextensible)
    arrays, angle = AngleArrays(structure), np.array([float(theta)])
    lumped, springs, _ = lumped_values(structure)
    free = structure.freedoms.free
    mass = arrays.mass(angle)[0] + np.diag(lumped[free])
    stiffness = arrays.stiffness(angle)[0] + np.diag(springs[free])
    place = np.full(len(structure.freedoms.all), -1)
    place[free] = np.arange(len(free))
    motion = structure.configuration(angle)
    local = np.zeros((len(structure.elements), 6, len(free)))
    for k, element in enumerate(structure.elements):
        turn = turning_matrix(float(motion[element.beam.name].angle[0]))
        for column, index in enumerate(element.indices[:6]):
            if place[index] >= 0:
                local[k, :, place[index]] += turn[:, column]
    stiff = np.array([element.beam.name in rigid for element in structure.elements])
    reduction = without_stretch(local, stiff)
    return reduction.T @ mass @ reduction, reduction.T @ stiffness @ reduction, reduction
