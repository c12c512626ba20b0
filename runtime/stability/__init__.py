"""Where linear periodic systems are unstable.

``resonances``, ``tongue``
    Speeds at which exponents of the mean system meet; the unstable range that starts at one of
    them, as a series to an order.
``speed_boundaries``, ``stability_edges``
    Speeds with a periodic or antiperiodic motion; all regions of instability in a range of speeds,
    each with its ends.
``tongue_curves``
    All regions from their feet over a parameter or a geometry.
``stability_chart``
    The stability over two parameters, with its boundaries.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .boundary_speeds import SpeedBoundaries, speed_boundaries
    from .chart import EdgeCurves, StabilityChart, stability_chart
    from .chart_boundaries import BoundaryCurves
    from .edges import StabilityEdges, stability_edges
    from .from_feet import TongueCurves, tongue_curves
    from .meetings import Resonance, resonances
    from .tongues import Tongue, tongue

_PUBLIC = {
    "BoundaryCurves": "chart_boundaries",
    "EdgeCurves": "chart",
    "Resonance": "meetings",
    "SpeedBoundaries": "boundary_speeds",
    "StabilityChart": "chart",
    "StabilityEdges": "edges",
    "Tongue": "tongues",
    "TongueCurves": "from_feet",
    "resonances": "meetings",
    "speed_boundaries": "boundary_speeds",
    "stability_chart": "chart",
    "stability_edges": "edges",
    "tongue": "tongues",
    "tongue_curves": "from_feet",
}

__all__ = [
    "BoundaryCurves",
    "EdgeCurves",
    "Resonance",
    "SpeedBoundaries",
    "StabilityChart",
    "StabilityEdges",
    "Tongue",
    "TongueCurves",
    "resonances",
    "speed_boundaries",
    "stability_chart",
    "stability_edges",
    "tongue",
    "tongue_curves",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
