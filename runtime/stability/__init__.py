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
    from .boundary_speeds import speed_boundaries as speed_boundaries
    from .chart import StabilityChart as StabilityChart
    from .chart import stability_chart as stability_chart
    from .edges import StabilityEdges as StabilityEdges
    from .edges import stability_edges as stability_edges
    from .from_feet import tongue_curves as tongue_curves
    from .meetings import resonances as resonances
    from .tongues import tongue as tongue

__all__ = on_first_use(globals())
