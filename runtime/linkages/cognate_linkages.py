"""The theorem of Roberts and Chebyshev: two other four-bars trace the same coupler curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.errors import bad
from .circuits import Circuit, planar
from .curves import CouplerCurve, coupler_curve
from .four_bar import FourBar
from .linkage import Array


@dataclass(frozen=True, eq=False)
class Cognate:
    """A four-bar that traces the coupler curve of another one.

    Attributes
    ----------
    linkage : FourBar
        In axes of its own.
    along, across : float
        The tracing point in its coupler's axes [m].
    pivot : ndarray, shape (2,)
        Where its crank's pivot lies in the axes of the first linkage [m].
    turn : float
        Angle of its frame there [rad].
    circuit : int
        On which of its circuits it traces the circuit of the first linkage.
    """

    linkage: FourBar
    along: float
    across: float
    pivot: Array
    turn: float
    circuit: int

    def curve(self, points: int = 720) -> CouplerCurve:
        """Return its coupler curve, in its own axes."""
        return coupler_curve(
            self.linkage, self.along, self.across, points=points, circuit=self.circuit
        )

    def placed(self, position: Array) -> Array:
        """Return places in the axes of the first linkage, shape (..., 2)."""
        own = np.asarray(position)[..., 0] + 1j * np.asarray(position)[..., 1]
        return np.asarray(self.pivot + planar(own * np.exp(1j * self.turn)))


def cognates(
    linkage: FourBar, along: float, across: float = 0.0, *, circuit: int = 0
) -> tuple[Cognate, Cognate]:
    """Return the two other four-bars that trace the path of a coupler point.

    Parameters
    ----------
    linkage : FourBar
        The four-bar.
    along, across : float
        Place of the tracing point in the coupler's axes [m].
    circuit : int
        The linkage's circuit (see :func:`~.coupler_curve.coupler_curve`).

    Returns
    -------
    tuple of Cognate
        The first has its frame between A and the third focus, its crank parallel to the line from
        B to the tracing point; the second between D and the third focus.

    Raises
    ------
    BadInput
        If the linkage is no four-bar, is at a change point, or the point is a joint of the
        coupler.

    Notes
    -----
    With u the direction of the coupler, g the point in it, k = g/l3: A + g u is one corner of a
    parallelogram A-B-P, and A + g u + k l2 exp(i theta2) keeps the distance |k| l4 from the third
    focus k l1.
    """
    if not isinstance(linkage, FourBar):
        raise bad("linkage", type(linkage).__name__, "a FourBar", "other linkages have no cognates")
    motion = Circuit(linkage, circuit)
    motion.check()
    f, c, m, n = (float(linkage.lengths[name]) for name in linkage.names)
    place = complex(along, across)
    if not np.isfinite(place) or min(abs(place), abs(m - place)) <= 1e-12 * m:
        raise bad(
            "along, across", f"{along:g}, {across:g}", "no joint of the coupler", "choose another"
        )
    s = np.array([0.3])
    at = motion.links(s, 0)
    e2, u, e4 = (complex(at[link].direction.c[0, 0]) for link in ("crank", "coupler", "follower"))
    k, rest = place / m, m - place
    j = rest / m
    first = _cognate(0j, k * f, place * u, k * c * e2, c * e2)
    second = _cognate(complex(f), k * f, -rest * u, j * n * e4, n * e4)
    return first, second


def _cognate(
    pivot: complex, focus: complex, crank: complex, coupler: complex, point: complex
) -> Cognate:
    """Build a four-bar from its vectors at one position; ``point`` from the crank's pin."""
    frame = focus - pivot
    to_pivot = frame - crank
    side = (to_pivot.conjugate() * coupler).imag
    lengths = (abs(frame), abs(crank), abs(coupler), abs(frame - crank - coupler))
    linkage = FourBar(*lengths, assembly="open" if side > 0 else "crossed")
    own = Circuit(linkage)
    upper = (crank / frame).imag > 0
    # Of two ranges of the crank the upper one comes first; a crank that turns has its assembly.
    circuit = int(not upper) if all(own.swings) else 0
    place = point * abs(coupler) / coupler
    return Cognate(
        linkage,
        place.real,
        place.imag,
        np.array([pivot.real, pivot.imag]),
        float(np.angle(frame)),
        circuit,
    )
