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
    from .beam_forces import recover as recover
    from .beam_motion import BeamMotion as BeamMotion
    from .elastic_curve import ElasticCurve as ElasticCurve
    from .elastic_curve import elastic_coupler_curve as elastic_coupler_curve
    from .pin_forces import pin_reactions as pin_reactions
    from .strain_energy import beam_energies as beam_energies
    from .stress_over_speed import stress_curve as stress_curve
    from .stresses import stress as stress
    from .stresses import stress_operator as stress_operator

__all__ = on_first_use(globals())
