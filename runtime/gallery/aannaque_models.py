"""The beams of Aannaque's Table 4.1 as the gallery uses them: models, motions and midpoints."""

from __future__ import annotations

import warnings
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning
from ..core.families import Array, LinearPeriodic
from ..scenes import load_scene

if TYPE_CHECKING:
    from ..periodic import SteadyState
    from ..recovery.stress_over_speed import StressCurve

SCENE = "aannaque_1996_table_4_1"
# The thesis' form (7.1), without stiffening; and the whole of the equations.
THESIS: tuple[str, ...] = ("as_printed",)
FULL: tuple[str, ...] = ()
FRAME = 0.547
CRITICAL = 62.0
LINKS = ("crank", "coupler", "follower")
# What the thesis' text does not say, said below each figure of its curves.
FORM_NOTE = (
    "Lines of the thesis' form: M q'' + C q' + K q = f, without Coriolis and centripetal terms and "
    "without stiffening."
)
RANGE_NOTE = (
    "Deflections beyond 5 % of a link are outside the linear range: at and above the critical "
    "speeds the curves are the equations' answer, not a machine's."
)


@lru_cache(maxsize=24)
def beams(
    elements: int = 3,
    drop: tuple[str, ...] = THESIS,
    *,
    kind: str = "cubic_beams",
    ratio: float = 0.02,
    frame: float = FRAME,
) -> LinearPeriodic:
    """Return the mechanism of Table 4.1 with modal damping.

    Parameters
    ----------
    elements : int
        Elements for each link.
    drop : tuple of str
        :data:`THESIS` or :data:`FULL`.
    kind : str
        Formulation of the scene: which elements.
    ratio : float
        Damping ratio of every mode.
    frame : float
        L4 [m].
    """
    overrides = {
        "mesh.elements": elements,
        "model.drop": list(drop),
        "model.formulation": kind,
        "damping.ratio": ratio,
        "links.frame": f"{frame} m",
    }
    return load_scene(SCENE, overrides=overrides).linear_system()


def stresses(system: LinearPeriodic, speeds: Array, rtol: float = 1e-3) -> StressCurve:
    """Return the largest stresses over the speed, by the shapes as in the thesis."""
    from ..recovery.stress_over_speed import stress_curve

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        return stress_curve(system, speeds, rtol=rtol, method="shape")


def periodic(system: LinearPeriodic, speed: Array | float, rtol: float = 1e-5) -> SteadyState:
    """Return steady states, whatever their deflections."""
    from ..periodic import steady_state

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        return steady_state(system, speed, rtol=rtol)


def midpoint(system: LinearPeriodic, link: str, theta: Array) -> Array:
    """Return what turns coordinates into the displacement across a link's midpoint [m], (nt, n)."""
    structure, own = system.structure, system.relative_deflection
    assert structure is not None and own is not None
    placed = structure.elements
    at = [i for i, item in enumerate(placed) if item.beam.name == link]
    count = len(at)
    # Two places to each element: its middle and its end.
    row = 2 * at[count // 2] if count % 2 else 2 * at[count // 2 - 1] + 1
    return np.asarray(own(theta)[:, row] * placed[at[0]].beam.length)


def moved(system: LinearPeriodic, link: str, theta: Array, q: Array) -> Array:
    """Return the displacement across a link's midpoint [m], shape ``(..., nt)``."""
    return np.asarray(np.einsum("tn,...tn->...t", midpoint(system, link, theta), q))


def rms(values: Array) -> Array:
    """Return the root of the mean square along the last axis."""
    return np.asarray(np.sqrt(np.mean(np.square(values), axis=-1)))


def maxima(speed: Array, values: Array, prominence: float = 0.02) -> Array:
    """Return the speeds of local maxima that stand out of a curve by a part of their height.

    The place is that of the parabola through the logarithms of three values.
    """
    from scipy.signal import find_peaks

    level = np.log(values)
    return _tops_of_parabolas(speed, level, find_peaks(level, prominence=prominence)[0])


def tops(speed: Array, values: Array) -> Array:
    """Return the speeds of all local maxima of a smooth curve, each refined by a parabola."""
    at = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    return _tops_of_parabolas(speed, values, at)


def _tops_of_parabolas(speed: Array, values: Array, at: NDArray[np.intp]) -> Array:
    before, here, after = values[at - 1], values[at], values[at + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * here + after)
    return np.asarray(speed[at] + shift * (speed[1] - speed[0]))


def nearest(places: Array, speed: float) -> float:
    """Return the place nearest to a speed."""
    return float(places[np.argmin(np.abs(places - speed))])
