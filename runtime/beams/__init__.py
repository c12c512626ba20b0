"""Planar linkages and frames of beams: elements, sections, structures and their equations.

What a linkage does not need of it, such as layered sections, loads on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use
from .beam_motion import BeamMotion
from .elements import (
    KINDS,
    NODAL_VALUES,
    ElementArrays,
    element_arrays,
    rigid_field,
    section_rotation,
    shape_functions,
)
from .frames import frame, without_stretching
from .linear import FORMS, linear_system
from .linkages import beam_linkage, linkage_system
from .pin_reactions import PinReactions, pin_reactions
from .recovery import BeamForces, recover
from .recovery_forms import LinearForm
from .section import Section
from .stress import StressPeak, StressResult, stress, stress_operator
from .structure import Beam, Node, Structure

if TYPE_CHECKING:
    from .elastic_curve import ElasticCurve, elastic_coupler_curve
    from .layered import ElasticLayer, SandwichSection, ViscoelasticLayer, sandwich_section
    from .strain_energy import BeamEnergies, beam_energies

_PUBLIC = {
    "BeamEnergies": "strain_energy",
    "ElasticCurve": "elastic_curve",
    "ElasticLayer": "layered",
    "SandwichSection": "layered",
    "ViscoelasticLayer": "layered",
    "beam_energies": "strain_energy",
    "elastic_coupler_curve": "elastic_curve",
    "sandwich_section": "layered",
}

__all__ = [
    "FORMS",
    "KINDS",
    "NODAL_VALUES",
    "Beam",
    "BeamEnergies",
    "BeamForces",
    "BeamMotion",
    "ElasticCurve",
    "ElasticLayer",
    "ElementArrays",
    "LinearForm",
    "Node",
    "PinReactions",
    "SandwichSection",
    "Section",
    "StressPeak",
    "StressResult",
    "Structure",
    "ViscoelasticLayer",
    "beam_energies",
    "beam_linkage",
    "elastic_coupler_curve",
    "element_arrays",
    "frame",
    "linear_system",
    "linkage_system",
    "pin_reactions",
    "recover",
    "rigid_field",
    "sandwich_section",
    "section_rotation",
    "shape_functions",
    "stress",
    "stress_operator",
    "without_stretching",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
