"""Planar linkages and frames of beams: elements, sections, structures and their equations.

What a linkage does not need of it, such as layered sections, loads on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use
from .elements import (
    KINDS,
    NODAL_VALUES,
    ElementArrays,
    element_arrays,
    section_rotation,
    shape_functions,
)
from .frames import frame, without_stretching
from .linear import FORMS, linear_system
from .linkages import beam_linkage, linkage_system
from .recovery_forms import LinearForm
from .section import Section
from .structure import Beam, Node, Structure

if TYPE_CHECKING:
    from .layered import ElasticLayer, SandwichSection, ViscoelasticLayer, sandwich_section

_PUBLIC = {
    "ElasticLayer": "layered",
    "SandwichSection": "layered",
    "ViscoelasticLayer": "layered",
    "sandwich_section": "layered",
}

__all__ = [
    "FORMS",
    "KINDS",
    "NODAL_VALUES",
    "Beam",
    "ElasticLayer",
    "ElementArrays",
    "LinearForm",
    "Node",
    "SandwichSection",
    "Section",
    "Structure",
    "ViscoelasticLayer",
    "beam_linkage",
    "element_arrays",
    "frame",
    "linear_system",
    "linkage_system",
    "sandwich_section",
    "section_rotation",
    "shape_functions",
    "without_stretching",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
