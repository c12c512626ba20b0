"""Planar linkages and frames of beams: elements, sections, structures and their equations.

What a linkage does not need of it, such as layered sections, loads on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .elements import KINDS as KINDS
    from .elements import element_arrays as element_arrays
    from .frames import frame as frame
    from .frames import without_stretching as without_stretching
    from .layered import ElasticLayer as ElasticLayer
    from .layered import ViscoelasticLayer as ViscoelasticLayer
    from .layered import sandwich_section as sandwich_section
    from .linear import linear_system as linear_system
    from .linkages import beam_linkage as beam_linkage
    from .linkages import linkage_system as linkage_system
    from .section import Section as Section
    from .structure import Beam as Beam
    from .structure import Node as Node
    from .structure import Structure as Structure

__all__ = on_first_use(globals())
