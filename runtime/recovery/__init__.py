"""What beams have to bear: forces, stresses, pin reactions and energies from a computed motion.

``recover``, ``stress``
    Axial force, shear, moment and displacement along the beams; stresses of the outer fibres.
``pin_reactions``
    Forces of the joints on the links.
``stress_curve``
    The largest stress of each link at a thousand speeds.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .beam_forces import BeamForces, recover
    from .beam_motion import BeamMotion
    from .elastic_curve import ElasticCurve, elastic_coupler_curve
    from .pin_forces import PinReactions, pin_reactions
    from .strain_energy import BeamEnergies, beam_energies
    from .stress_over_speed import StressCurve, stress_curve
    from .stresses import StressPeak, StressResult, stress, stress_operator

_PUBLIC = {
    "BeamEnergies": "strain_energy",
    "BeamForces": "beam_forces",
    "BeamMotion": "beam_motion",
    "ElasticCurve": "elastic_curve",
    "PinReactions": "pin_forces",
    "StressCurve": "stress_over_speed",
    "StressPeak": "stresses",
    "StressResult": "stresses",
    "beam_energies": "strain_energy",
    "elastic_coupler_curve": "elastic_curve",
    "pin_reactions": "pin_forces",
    "recover": "beam_forces",
    "stress": "stresses",
    "stress_curve": "stress_over_speed",
    "stress_operator": "stresses",
}

__all__ = [
    "BeamEnergies",
    "BeamForces",
    "BeamMotion",
    "ElasticCurve",
    "PinReactions",
    "StressCurve",
    "StressPeak",
    "StressResult",
    "beam_energies",
    "elastic_coupler_curve",
    "pin_reactions",
    "recover",
    "stress",
    "stress_curve",
    "stress_operator",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
