"""The flexible rod of a quick-return mechanism: moving bases, and the systems made from them.

``rod_system`` is linear, on one of four bases or on shapes of your own; ``free_free_rod`` is the
nonlinear rod in a floating frame, with constraints.  The names load on first use: one basis needs
nothing of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.lazy import on_first_use

if TYPE_CHECKING:
    from .basis import MovingBasis as MovingBasis
    from .floating import FreeFreeRod as FreeFreeRod
    from .floating import free_free_rod as free_free_rod
    from .free_free import FreeFreeBasis as FreeFreeBasis
    from .free_free import FreeFreeModes as FreeFreeModes
    from .linear import rod_system as rod_system
    from .overhang import OverhangBasis as OverhangBasis
    from .polynomials import PolynomialBasis as PolynomialBasis
    from .polynomials import TwoSegmentBasis as TwoSegmentBasis

__all__ = on_first_use(globals())
