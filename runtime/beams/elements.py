"""Beam elements of four kinds: their matrices, shape functions, and nodal values of rigid motions.

Every number comes from emitted closed forms (``elastolink.generated.beam_element_...`` and
``beam_shapes_...``), derived by Hamilton's principle from the energies of a beam in a turning
frame.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad, refuse
from ..core.families.emitted import array_function
from ..core.inputs import number_problems, numbers_in_a_row, require_one_of, require_positive

if TYPE_CHECKING:
    from .structure import PlacedElement

Array: TypeAlias = NDArray[np.float64]

KINDS = ("cubic", "internal_node", "curvature", "timoshenko")

_END_VALUES = ("u1", "v1", "r1", "u2", "v2", "r2")
NODAL_VALUES: Mapping[str, tuple[str, ...]] = {
    "cubic": _END_VALUES,
    "internal_node": (*_END_VALUES, "v3", "r3"),
    "curvature": (*_END_VALUES, "k1", "k2"),
    "timoshenko": _END_VALUES,
}
_ALONG = ("u", "strain")
_ACROSS = ("v", "slope", "curvature", "third")
_SECTION = ("rotation", "rotation_slope", "rotation_second")


@dataclass(frozen=True)
class ElementArrays:
    """Matrices of one element in its local axes, n nodal values in the order of ``NODAL_VALUES``.

    In axes that turn at the rate w the element has ``mass qdd + 2 w coupling qd + (stiffness + Kg -
    w^2 centripetal + wd coupling) q``, with ``Kg = sum_k P_k geometric[k]`` for an axial force
    ``P_0 + P_1 s + P_2 s^2`` [N], tension positive, s from 0 to 1.
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
    _require_sizes(sizes)
    refuse(number_problems("element", inertias, "not negative"))
    found = _in_range(array_function(_emitted("element", kind), "element"), **sizes, **inertias)
    arrays = {name: value for name, value in found.items() if not name.startswith("geometric")}
    geometric = np.stack([found[f"geometric_{k}"] for k in range(3)])
    return ElementArrays(
        **{name: _fixed(value) for name, value in arrays.items()}, geometric=_fixed(geometric)
    )


def shape_functions(
    kind: str,
    xi: ArrayLike,
    length: float,
    derivative: int = 0,
    *,
    bending_stiffness: float | None = None,
    shear_stiffness: float | None = None,
) -> tuple[Array, Array]:
    """Return the shape functions of displacements along and across an element (Aannaque 4.3-4.10).

    At places ``xi`` over the element's length [m], 0 to 1, shape ``(nx,)``, or their derivative by
    x, to the third: two arrays ``(nx, n)`` per nodal value, ``u = u_shapes @ q_local``.  The kind
    "timoshenko" needs EI [N m^2] and k G A [N].  Also (A.1), (A.2), (A.5), (A.6).
    """
    rows = _shape_rows(kind, xi, length, bending_stiffness, shear_stiffness)
    if derivative not in range(4):
        raise bad("derivative", derivative, "0, 1, 2 or 3", "give one of these")
    across = rows[_ACROSS[derivative]]
    along = rows[_ALONG[derivative]] if derivative < len(_ALONG) else np.zeros_like(across)
    return along, across


def section_rotation(
    kind: str,
    xi: ArrayLike,
    length: float,
    derivative: int = 0,
    *,
    bending_stiffness: float | None = None,
    shear_stiffness: float | None = None,
) -> Array:
    """Return the shape functions of the rotation of the cross-section, ``(nx, n)``.

    The rotation is the slope v' where there is no shear deformation.  Its first derivative by x
    times EI is the bending moment, its second times EI less the shear force.  The arguments are
    those of :func:`shape_functions`.
    """
    rows = _shape_rows(kind, xi, length, bending_stiffness, shear_stiffness)
    if derivative not in range(3):
        raise bad("derivative", derivative, "0, 1 or 2", "give one of these")
    names = _SECTION if kind == "timoshenko" else _ACROSS[1:]
    return rows[names[derivative]]


def _emitted(what: str, kind: str) -> ModuleType:
    """Return the emitted module of a kind; those of the other kinds are not loaded."""
    return import_module(f"...generated.beam_{what}_{kind}", __package__)


def _shape_rows(
    kind: str,
    xi: ArrayLike,
    length: float,
    bending_stiffness: float | None,
    shear_stiffness: float | None,
) -> dict[str, Array]:
    require_one_of("kind", kind, KINDS)
    place = numbers_in_a_row("xi", xi)
    if not np.all((place >= 0.0) & (place <= 1.0)):
        raise bad("xi", xi, "places from 0 to 1", "divide by the element's length")
    numbers: dict[str, Any] = {"length": length}
    if kind == "timoshenko":
        numbers |= {"bending_stiffness": bending_stiffness, "shear_stiffness": shear_stiffness}
    _require_sizes(numbers)
    found = _in_range(array_function(_emitted("shapes", kind), "shapes"), place, **numbers)
    return {name: value[..., 0, :] for name, value in found.items()}


def _require_sizes(sizes: Mapping[str, Any]) -> None:
    """Refuse the first length or stiffness that is not positive."""
    for name, value in sizes.items():
        require_positive("element", **{name: value})


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


def placed_shapes(placed: PlacedElement, xi: ArrayLike, derivative: int = 0) -> tuple[Array, Array]:
    """Return :func:`shape_functions` of an element of a beam."""
    return shape_functions(placed.beam.kind, xi, placed.length, derivative, **_stiffness(placed))


def placed_rotation(placed: PlacedElement, xi: ArrayLike, derivative: int = 0) -> Array:
    """Return :func:`section_rotation` of an element of a beam."""
    return section_rotation(placed.beam.kind, xi, placed.length, derivative, **_stiffness(placed))


def _stiffness(placed: PlacedElement) -> dict[str, float | None]:
    section = placed.beam.section
    return {
        "bending_stiffness": section.bending_stiffness,
        "shear_stiffness": section.shear_stiffness,
    }
