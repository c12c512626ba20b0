"""Shape functions of an element of a beam, by the section of its beam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .elements import Array, section_rotation, shape_functions

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .freedoms import PlacedElement


def placed_shapes(placed: PlacedElement, xi: ArrayLike, derivative: int = 0) -> tuple[Array, Array]:
    """Return the shape functions along and across an element of a beam.

    Parameters
    ----------
    placed : PlacedElement
        The element.
    xi : array_like, shape (nx,)
        Places over the element's length, 0 to 1.
    derivative : int
        0 to 3 derivatives by x.

    Returns
    -------
    u_shapes, v_shapes : ndarray, shape (nx, n)
        As :func:`~elastolink.runtime.beams.elements.shape_functions` returns them.

    Raises
    ------
    BadInput
        As that function.
    """
    section = placed.beam.section
    return shape_functions(
        placed.beam.kind,
        xi,
        placed.length,
        derivative,
        bending_stiffness=section.bending_stiffness,
        shear_stiffness=section.shear_stiffness,
    )


def placed_rotation(placed: PlacedElement, xi: ArrayLike, derivative: int = 0) -> Array:
    """Return the shape functions of the rotation of the cross-section of an element of a beam.

    Parameters
    ----------
    placed, xi
        As :func:`placed_shapes`.
    derivative : int
        0 to 2 derivatives by x.

    Returns
    -------
    ndarray, shape (nx, n)
        As :func:`~elastolink.runtime.beams.elements.section_rotation` returns it.

    Raises
    ------
    BadInput
        As that function.
    """
    section = placed.beam.section
    return section_rotation(
        placed.beam.kind,
        xi,
        placed.length,
        derivative,
        bending_stiffness=section.bending_stiffness,
        shear_stiffness=section.shear_stiffness,
    )
