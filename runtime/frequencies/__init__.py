"""Natural frequencies, critical speeds and resonance curves, of finite elements and exact members.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .campbell_diagram import campbell as campbell
    from .counting import wittrick_williams as wittrick_williams
    from .critical import critical_speeds as critical_speeds
    from .frames import dynamic_stiffness as dynamic_stiffness
    from .frames import element_matrices as element_matrices
    from .frames import log_determinant as log_determinant
    from .held import buckling_speed as buckling_speed
    from .link_study import LinkFrequencies as LinkFrequencies
    from .link_study import link_frequencies as link_frequencies
    from .natural import NaturalFrequencies as NaturalFrequencies
    from .natural import draw_mode as draw_mode
    from .natural import draw_modes as draw_modes
    from .natural import natural_frequencies as natural_frequencies
    from .resonance_curves import ResonanceCurve as ResonanceCurve
    from .resonance_curves import resonance_curve as resonance_curve

__all__ = on_first_use(globals())
