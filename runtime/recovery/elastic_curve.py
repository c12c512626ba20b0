"""Curves of points of elastic links beside those of the rigid linkage (Aannaque 8.3)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from ..beams.assembly import Array
from ..beams.element_forms import required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import is_finite
from ..core.plotting import Axes, axes_or_new
from .beam_forces import recovery, stations_of
from .beam_motion import BeamMotion, Motion, beam_motion, chunks
from .beam_result import BeamResult, checked_forms, in_motion
from .finer_mesh import with_mesh


@dataclass(frozen=True, kw_only=True)
class ElasticCurve(BeamResult):
    """Curve that a point of an elastic link draws, and that of the rigid linkage.

    Speed and crank angles: see :class:`BeamResult`.  The error is the largest of a place [m]: by
    the error of the motion and, where it was found on a finer mesh too, by that of the mesh.
    """

    link: str
    # place of the point in the link's own axes [m]
    along: float
    across: float
    # places of the point in the fixed axes [m], (nt, 2)
    rigid: Array
    elastic: Array

    arrays_along: ClassVar = {"sample direction": "rigid elastic"}
    column_units: ClassVar = {"m": "rigid elastic along across error"}

    @property
    def displacement(self) -> Array:
        """Elastic displacement of the point along the fixed axes [m], ``(nt, 2)``."""
        return np.asarray(self.elastic - self.rigid)

    @property
    def largest(self) -> float:
        """Largest displacement [m]."""
        return float(np.max(np.hypot(*self.displacement.T)))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw both curves, the rigid one dashed."""
        ax = axes_or_new(ax)
        for values, style, label in ((self.rigid, "--", "rigid"), (self.elastic, "-", "elastic")):
            closed = np.vstack([values, values[:1]])
            ax.plot(closed[:, 0], closed[:, 1], style, label=label, linewidth=0.9)
        ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
        ax.set_title(f"{self.speed:.4g} rad/s", fontsize="medium")
        ax.legend()
        return ax


def elastic_coupler_curve(
    system: LinearPeriodic,
    motion: Motion | float,
    along: float | None = None,
    across: float = 0.0,
    *,
    link: str = "coupler",
) -> ElasticCurve:
    """Return the curve of a point of an elastic link, beside that of the rigid linkage.

    Parameters
    ----------
    system, motion
        As :func:`elastolink.recover`.
    along, across : float, optional
        Place in the link's own axes [m], by default the middle of the axis; off the axis it is
        carried by the section at its foot, beyond the ends by the end section.
    link : str
        The link.

    Returns
    -------
    ElasticCurve

    Raises
    ------
    BadInput
        If an argument is unusable, or the structure stands still.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> curve = el.recovery.elastic_coupler_curve(system, 20.0)
    >>> print(curve.elastic.shape, round(1000.0 * float(curve.largest), 2))
    (256, 2) 0.75
    """
    structure = required_structure(system)
    beam = structure.beam(link)
    foot = 0.5 * beam.length if along is None else along
    for name, value in (("along", foot), ("across", across)):
        if not is_finite(value):
            raise bad(name, repr(value), "a finite length [m]", "correct it")
    moving = beam_motion(system, motion)
    if not structure.moving:
        raise bad("system", "a structure that stands still", "a linkage", "use recover()")
    place = link, float(foot), float(across)
    shift, doubt = _shift(system, moving, *place)
    rigid = structure.configuration(moving.theta)[link].point(*place[1:]).position
    return ElasticCurve(
        method="shape functions",
        link=link,
        along=place[1],
        across=place[2],
        rigid=rigid,
        elastic=rigid + shift,
        **in_motion(system, moving, partial(_doubt, system, moving, place, shift, doubt)),
    )


def _doubt(
    system: LinearPeriodic,
    moving: BeamMotion,
    place: tuple[str, float, float],
    shift: Array,
    doubt: float,
) -> dict[str, float | str]:
    def change(finer: LinearPeriodic, motion: BeamMotion) -> float:
        better, _ = _shift(finer, motion, *place)
        return float(np.max(np.hypot(*(better - shift).T)))

    error = float(np.sqrt(2.0)) * doubt
    return with_mesh(system, moving, "largest error of a place [m]", error, change)


def _shift(
    system: LinearPeriodic, motion: BeamMotion, link: str, along: float, across: float
) -> tuple[Array, float]:
    """Return the displacement of the point ``(nt, 2)``, and what the motion's error does to it."""
    structure = required_structure(system)
    length = structure.beam(link).length
    nearest = min(max(along, 0.0), length)
    foot = stations_of(structure, {link: nearest / length})
    found, doubt = [], 0.0
    for chunk in chunks(motion):
        theta = motion.theta[chunk]
        made = recovery(checked_forms(system, theta), foot, "shape")
        u, v, turn = (made[name].parts["q", 0][:, 0] for name in ("along", "across", "slope"))
        own_x, own_y = u - across * turn, v + (along - nearest) * turn
        angle = structure.configuration(theta)[link].angle[:, None]
        x = np.cos(angle) * own_x - np.sin(angle) * own_y
        y = np.sin(angle) * own_x + np.cos(angle) * own_y
        rows = np.stack([x, y], axis=1)  # from the coordinates, (nt, 2, n)
        found.append(np.einsum("txn,tn->tx", rows, motion.q[chunk]))
        doubt = max(doubt, float(np.max(np.abs(rows) @ motion.doubt)))
    return np.concatenate(found), doubt
