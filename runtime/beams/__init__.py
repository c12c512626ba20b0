"""Planar linkages and frames of beams: elements, sections, structures and their equations."""

from __future__ import annotations

from .beam_motion import BeamMotion
from .elastic_curve import ElasticCurve, elastic_coupler_curve
from .elements import (
    KINDS,
    NODAL_VALUES,
    ElementArrays,
    element_arrays,
    rigid_field,
    section_rotation,
    shape_functions,
)
from .frames import frame
from .inextensible import without_stretching
from .layered import (
    ElasticLayer,
    SandwichSection,
    SandwichStudy,
    ViscoelasticLayer,
    sandwich_section,
    sandwich_study,
)
from .linear import FORMS, linear_system
from .linkages import beam_linkage, linkage_system
from .pin_reactions import PinReactions, pin_reactions
from .recovered import BeamForces, recover
from .recovery_forms import LinearForm
from .section import Section
from .strain_energy import BeamEnergies, beam_energies
from .stress import StressPeak, StressResult, stress, stress_operator
from .structure import Beam, Node, Structure

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
    "SandwichStudy",
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
    "sandwich_study",
    "section_rotation",
    "shape_functions",
    "stress",
    "stress_operator",
    "without_stretching",
]
