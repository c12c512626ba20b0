"""Stresses of links from the shapes of their elements, for motions whose speed changes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..beams.assembly import in_own_axes, products
from ..beams.element_forms import required_structure
from ..beams.elements import placed_rotation, placed_shapes
from ..core.errors import bad
from ..core.families import LinearPeriodic
from .speed_profile import Array


def largest_by_shape(
    system: LinearPeriodic,
    theta: Array,
    q: Array,
    stations: int,
    directions: Mapping[str, Array] | None = None,
) -> Array:
    """Return the largest stress of each link, ``E (|u'| + h/2 |v''|)``, at points of a motion.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams whose sections have a thickness.
    theta : ndarray, shape (nt,)
        Crank angles [rad].
    q : ndarray, shape (nt, n)
        Coordinates.
    stations : int
        Places on each element, its ends included.
    directions : mapping of str to ndarray, optional
        Cosine and sine of each link's angle, ``(nt, 2)``, where they are not those of the system.

    Returns
    -------
    ndarray
        Shape ``(nt, links)`` [Pa].

    Raises
    ------
    BadInput
        If a section has no thickness.
    """
    structure = required_structure(system)
    full = np.zeros((len(theta), len(structure.freedoms.all)))
    full[:, structure.freedoms.free] = q
    links = [beam.name for beam in structure.beams]
    if directions is None:
        motion = structure.configuration(theta)
        directions = {name: products(motion[name].angle)[:, 1:3] for name in links}
    largest = np.zeros((len(theta), len(links)))
    xi = np.linspace(0.0, 1.0, stations)
    for placed in structure.elements:
        section = placed.beam.section
        if section.thickness is None:
            fix = "give Section.thickness"
            raise bad(f"beam {placed.beam.name}", "no thickness", "one, for its stresses", fix)
        stretch, _ = placed_shapes(placed, xi, 1)
        bend = placed_rotation(placed, xi, 1)
        local = in_own_axes(full[:, placed.indices], *directions[placed.beam.name].T)
        half = section.thickness / 2.0
        value = np.abs(local @ stretch.T) + half * np.abs(local @ bend.T)
        k = links.index(placed.beam.name)
        largest[:, k] = np.maximum(largest[:, k], section.modulus * np.max(value, axis=1))
    return largest
