"""Nonlinear systems under a periodic drive: periodic motions over a parameter, sweeps, jumps.

``response_curve``: branches of periodic motions over a parameter, with stability and special
points; ``special_curve`` follows one of these in a second parameter.
``coexisting_motions``: what else there is at one value; ``basins``: which of them is reached.
``amplitude_law``: how the frequency falls with the amplitude, the crank held still.
``sweep_response``: slow run-up and coast-down by marching, as on a test bench.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .amplitude import AmplitudeLaw as AmplitudeLaw
    from .amplitude import amplitude_law as amplitude_law
    from .loci import SpecialCurve as SpecialCurve
    from .loci import special_curve as special_curve
    from .response import ResponseCurve as ResponseCurve
    from .response import response_curve as response_curve
    from .search import CoexistingMotions as CoexistingMotions
    from .search import coexisting_motions as coexisting_motions
    from .swept import Basins as Basins
    from .swept import SweepResponse as SweepResponse
    from .swept import basins as basins
    from .swept import sweep_response as sweep_response

__all__ = on_first_use(globals())
