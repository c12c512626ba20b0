"""Beam elements of four kinds: their matrices, shape functions, and nodal values of rigid motions.

Every number comes from emitted closed forms (``elastolink.generated.beam_element_...`` and
``beam_shapes_...``), derived by Hamilton's principle from the energies of a beam in a turning
frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad, refuse
from ..core.families.emitted import array_function
from ..core.inputs import number_problems, require_one_of, require_positive

if TYPE_CHECKING:
    from .structure import PlacedElement

Array: TypeAlias = NDArray[np.float64]

KINDS = ("cubic", "internal_node", "curvature", "timoshenko")


@dataclass(frozen=True)
class ElementArrays:
    """Matrices of one element in its local axes, by its n nodal values.

    These are displacements along and across the element and the rotation at its first end, then
    those at its second; of "internal_node" also those across and the rotation in the middle, of
    "curvature" the curvatures of both ends.  In axes that turn at the rate w the element has ``mass
    qdd + 2 w coupling qd + (stiffness + Kg - w^2 centripetal + wd coupling) q``, with ``Kg = sum_k
    P_k geometric[k]`` for an axial force ``P_0 + P_1 s + P_2 s^2`` [N], tension positive, s from 0
    to 1.
    """

    mass: Array  # M, (n, n): [kg] for displacements, [kg m], [kg m^2] where rotations enter
    coupling: Array  # W, skew, (n, n): ``int rho A N^T J N dx``, J = [[0, -1], [1, 0]]
    centripetal: Array  # mass without rotary inertia, (n, n): as M but for "timoshenko"
    stiffness: Array  # K, (n, n) [N/m], [N], [N m]
    # (3, n, n) [1/m], ...: per constant, linear, quadratic part of the axial force
    geometric: Array
    # (n, 4): nodal forces [N], [N m] per end values px1, px2, py1, py2 [N/m] of a force per length
    # along (x) and across (y) the element, linear between its ends
    load: Array


def element_arrays(
    kind: str,
    *,
    length: float,
    mass_per_length: float,
    axial_stiffness: float,
    bending_stiffness: float,
    shear_stiffness: float | None = None,
    rotary_inertia: float = 0.0,
) -> ElementArrays:
    """Return the matrices of a beam element, in local axes.

    The kinds are "cubic" (Hermite), "internal_node" (quintic, with a node in the middle),
    "curvature" (quintic, with the curvatures of the ends) and "timoshenko" (shear and rotary
    inertia, free of locking); axially all are linear.  From the element's length [m], rho A [kg/m],
    EA [N] and EI [N m^2]; "timoshenko" alone needs k G A [N] and uses rho I [kg m] per length.
    Refused are sizes that are not positive, inertias that are negative, and entries beyond doubles.

    Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8), the slips mended.
    """
    require_one_of("kind", kind, KINDS)
    sizes: dict[str, Any] = {
        "length": length,
        "axial_stiffness": axial_stiffness,
        "bending_stiffness": bending_stiffness,
    }
    inertias = {"mass_per_length": mass_per_length}
    if kind == "timoshenko":
        sizes["shear_stiffness"], inertias["rotary_inertia"] = shear_stiffness, rotary_inertia
    for name, value in sizes.items():
        require_positive("element", **{name: value})
    refuse(number_problems("element", inertias, "not negative"))
    found = _in_range(array_function(_emitted("element", kind), "element"), **sizes, **inertias)
    arrays = {name: value for name, value in found.items() if not name.startswith("geometric")}
    geometric = np.stack([found[f"geometric_{k}"] for k in range(3)])
    return ElementArrays(
        **{name: _fixed(value) for name, value in arrays.items()}, geometric=_fixed(geometric)
    )


def _emitted(what: str, kind: str) -> ModuleType:
    """Return the emitted module of a kind; those of the other kinds are not loaded."""
    return import_module(f"...generated.beam_{what}_{kind}", __package__)


def _in_range(
    function: Callable[..., dict[str, Array]], *places: Array, **numbers: float
) -> dict[str, Array]:
    """Return what an emitted function gives, and refuse what doubles cannot hold."""
    with np.errstate(all="ignore"):
        found = function(*places, **{name: np.float64(value) for name, value in numbers.items()})
    if not all(np.all(np.isfinite(value)) for value in found.values()):
        given = f"entries beyond the range of doubles for {numbers}"
        fix = "choose other units"
        raise bad("element", given, "lengths and stiffnesses of ordinary size", fix)
    return found


def _fixed(array: Array) -> Array:
    array.flags.writeable = False
    return array


def shapes_of(placed: PlacedElement, xi: Array) -> dict[str, Array]:
    """Return the shape functions of an element of a beam, by name (Aannaque 4.3-4.10).

    At places ``(...)`` over the element's length, 0 to 1; each is ``(..., n)`` by nodal values:
    ``u`` along the element, with its derivative by x ``strain``; ``v`` across it, with ``slope``,
    ``curvature`` and ``third``; ``rotation`` of the cross-section, the slope where there is no
    shear deformation.  Curvature and third are derivatives of the rotation, too: times EI the
    bending moment, and less the shear force.  Also (A.1), (A.2), (A.5), (A.6).
    """
    section, kind = placed.beam.section, placed.beam.kind
    numbers: dict[str, Any] = {"length": placed.length}
    if kind == "timoshenko":
        numbers["bending_stiffness"] = section.bending_stiffness
        numbers["shear_stiffness"] = section.shear_stiffness
    found = _in_range(array_function(_emitted("shapes", kind), "shapes"), xi, **numbers)
    rows = {name: value[..., 0, :] for name, value in found.items()}
    return {"rotation": rows["slope"], **rows}
