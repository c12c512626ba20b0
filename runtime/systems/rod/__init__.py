"""The flexible rod of a quick-return mechanism: moving bases, and the systems made from them.

The names load on first use: one basis needs nothing of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.lazy import on_first_use

if TYPE_CHECKING:
    from .basis import MovingBasis
    from .constrained import FreeFreeRod, free_free_rod, rigid_state, tip_deflection
    from .free_free import FreeFreeBasis, FreeFreeModes, free_free_roots
    from .galerkin import GalerkinIntegrals, galerkin_integrals
    from .linear import rod_system
    from .overhang import OverhangBasis
    from .overhang_spectrum import OverhangFrequencies, overhang_frequencies, overhang_roots
    from .polynomial import PolynomialBasis
    from .two_segment import TwoSegmentBasis

_PUBLIC = {
    "FreeFreeBasis": "free_free",
    "FreeFreeModes": "free_free",
    "FreeFreeRod": "constrained",
    "GalerkinIntegrals": "galerkin",
    "MovingBasis": "basis",
    "OverhangBasis": "overhang",
    "OverhangFrequencies": "overhang_spectrum",
    "PolynomialBasis": "polynomial",
    "TwoSegmentBasis": "two_segment",
    "free_free_rod": "constrained",
    "free_free_roots": "free_free",
    "galerkin_integrals": "galerkin",
    "overhang_frequencies": "overhang_spectrum",
    "overhang_roots": "overhang_spectrum",
    "rigid_state": "constrained",
    "rod_system": "linear",
    "tip_deflection": "constrained",
}

__all__ = [
    "FreeFreeBasis",
    "FreeFreeModes",
    "FreeFreeRod",
    "GalerkinIntegrals",
    "MovingBasis",
    "OverhangBasis",
    "OverhangFrequencies",
    "PolynomialBasis",
    "TwoSegmentBasis",
    "free_free_rod",
    "free_free_roots",
    "galerkin_integrals",
    "overhang_frequencies",
    "overhang_roots",
    "rigid_state",
    "rod_system",
    "tip_deflection",
]


__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
