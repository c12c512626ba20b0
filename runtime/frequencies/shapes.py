"""Shapes of members between their ends, exact at any frequency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams._checks import numbers_in_a_row
from ..core.errors import bad
from .frames import Assembly
from .members import functions, phases

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MemberShape:
    """Displacement of a beam along its length.

    Attributes
    ----------
    eta : ndarray, shape (m,)
        Places, in lengths.
    along, across : ndarray, shape (m,)
        Displacement in the beam's own axes [m].
    slope, curvature, third : ndarray, shape (m,)
        Derivatives of ``across`` by the place [rad, 1/m, 1/m^2].
    strain : ndarray, shape (m,)
        Derivative of ``along`` by the place.
    displacement : ndarray, shape (m, 2)
        In the fixed axes [m].
    """

    eta: Array
    along: Array
    across: Array
    slope: Array
    curvature: Array
    third: Array
    strain: Array
    displacement: Array


def member_shape(
    assembly: Assembly, omega: float, vector: Array, beam: str, eta: ArrayLike
) -> MemberShape:
    """Return the shape of a beam in a harmonic motion.

    Parameters
    ----------
    assembly : Assembly
        The members.
    omega : float
        Frequency [rad/s].
    vector : ndarray, shape (size,)
        Coordinates.
    beam : str
        Name of the beam.
    eta : array_like, shape (m,)
        Places along the beam, in lengths, 0 to 1.

    Raises
    ------
    BadInput
        If there is no such beam, or a place lies outside.
    """
    places = numbers_in_a_row("eta", eta)
    if not np.all((places >= 0.0) & (places <= 1.0)):
        raise bad("eta", repr(eta), "places from 0 to 1 in a row", "divide by the length")
    own = [k for k, piece in enumerate(assembly.pieces) if piece.beam.name == beam]
    if not own:
        known = ", ".join(dict.fromkeys(piece.beam.name for piece in assembly.pieces))
        raise bad("beam", repr(beam), f"one of {known}", "correct the name")
    z, b = phases(omega, *assembly.data)
    whole = assembly.pieces[own[0]].beam.length
    starts = np.array([assembly.pieces[k].start for k in own]) / whole
    which = np.clip(np.searchsorted(starts, places, side="right") - 1, 0, len(own) - 1)
    rows = np.zeros((6, len(places)))
    for number, k in enumerate(own):
        here = which == number
        length = assembly.pieces[k].length
        inner = np.clip((places[here] - starts[number]) * whole / length, 0.0, 1.0)
        ends = assembly.local[k] @ vector
        rows[:4, here] = _across(inner, float(z[k]), length, ends)
        rows[4:, here] = _along(inner, float(b[k]), length, ends)
    angle = assembly.angles[own[0]]
    turned = (rows[4] + 1j * rows[0]) * np.exp(1j * angle)
    return MemberShape(
        eta=places,
        along=rows[4],
        across=rows[0],
        slope=rows[1],
        curvature=rows[2],
        third=rows[3],
        strain=rows[5],
        displacement=np.stack([turned.real, turned.imag], axis=-1),
    )


def _across(xi: Array, z: float, length: float, ends: Array) -> Array:
    """Return deflection and three derivatives: the left end's shapes are mirrored ones."""
    phase = np.full_like(xi, z)
    right = np.array(functions.bending_shapes(phase, xi))
    left = np.array(functions.bending_shapes(phase, 1.0 - xi))
    mirror = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    total = right[:4] * ends[4] + right[4:] * (length * ends[5])
    total += mirror * (left[:4] * ends[1] - left[4:] * (length * ends[2]))
    return np.asarray(total / length ** np.arange(4.0)[:, None])


def _along(xi: Array, b: float, length: float, ends: Array) -> Array:
    phase = np.full_like(xi, b)
    right = np.array(functions.axial_shapes(phase, xi))
    left = np.array(functions.axial_shapes(phase, 1.0 - xi))
    total = right * ends[3] + np.array([[1.0], [-1.0]]) * left * ends[0]
    return np.asarray(total / length ** np.arange(2.0)[:, None])
