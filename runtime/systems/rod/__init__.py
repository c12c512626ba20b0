"""The flexible rod of a quick-return mechanism: moving bases, and the systems made from them.

``rod_system`` is linear, on one of four bases or on shapes of your own; ``free_free_rod`` is the
nonlinear rod in a floating frame, with constraints.  The names load on first use: one basis needs
nothing of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.lazy import on_first_use

if TYPE_CHECKING:
    from .basis import MovingBasis
    from .floating import FreeFreeRod, free_free_rod
    from .free_free import FreeFreeBasis, FreeFreeModes
    from .linear import rod_system
    from .overhang import OverhangBasis, OverhangFrequencies, overhang_roots
    from .polynomials import PolynomialBasis, TwoSegmentBasis

_PUBLIC = {
    "FreeFreeBasis": "free_free",
    "FreeFreeModes": "free_free",
    "FreeFreeRod": "floating",
    "MovingBasis": "basis",
    "OverhangBasis": "overhang",
    "OverhangFrequencies": "overhang",
    "PolynomialBasis": "polynomials",
    "TwoSegmentBasis": "polynomials",
    "free_free_rod": "floating",
    "overhang_roots": "overhang",
    "rod_system": "linear",
}

__all__ = [
    "FreeFreeBasis",
    "FreeFreeModes",
    "FreeFreeRod",
    "MovingBasis",
    "OverhangBasis",
    "OverhangFrequencies",
    "PolynomialBasis",
    "TwoSegmentBasis",
    "free_free_rod",
    "overhang_roots",
    "rod_system",
]


__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
