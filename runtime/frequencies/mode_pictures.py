"""Pictures of mode shapes on the held linkage (Aannaque Figs. 8.9-8.18)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..beams.assembly import in_own_axes
from ..beams.element_forms import required_structure
from ..beams.elements import placed_shapes
from ..beams.structure import Structure
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import is_finite, require_whole
from ..core.plotting import Axes, axes_or_new, new_figure
from .held import crank_angles
from .natural import NaturalFrequencies, natural_frequencies

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def deflected_links(
    structure: Structure, theta: float, shape: Array
) -> dict[str, tuple[Array, Array]]:
    """Return places on each rigid link and their displacements in a shape, ``(np, 2)`` each [m]."""
    full = np.zeros(len(structure.freedoms.all))
    full[structure.freedoms.free] = shape
    motion = structure.configuration(np.array([theta]))
    found: dict[str, tuple[list[Array], list[Array]]] = {}
    places = np.linspace(0.0, 1.0, 17)
    for element in structure.elements:
        beam = element.beam
        along, across = placed_shapes(element, places)
        own = motion[beam.name]
        angle = float(own.angle[0])
        axes = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        local = in_own_axes(full[None, element.indices], axes[0, 0], axes[0, 1])[0]
        moved = np.stack([along @ local, across @ local], axis=-1) @ axes
        at = element.start + element.length * places
        rigid, bent = found.setdefault(beam.name, ([], []))
        rigid.append(own.origin[0] + at[:, None] * axes[0])
        bent.append(moved)
    return {name: (np.concatenate(a), np.concatenate(b)) for name, (a, b) in found.items()}


def draw_mode(
    system: LinearPeriodic,
    theta: float = 0.0,
    mode: int = 1,
    ax: Axes | None = None,
    *,
    found: NaturalFrequencies | None = None,
) -> Axes:
    """Draw a mode, counted from 1, of the held linkage over its rigid position; return the axes.

    The system is a linkage or frame of beams, ``theta`` the crank angle [rad].  With ``found``,
    its natural frequencies at angles that include this one, the mode is that curve, its sign
    steady from angle to angle.  BadInput is raised if the system has no beams, or the mode or the
    angle is not there.
    """
    structure = required_structure(system)
    require_whole("mode", mode, 1, system.size)
    if not is_finite(theta):
        raise bad("theta", repr(theta), "one number [rad]", "choose a crank angle")
    held = natural_frequencies(system, float(theta), mode) if found is None else found
    at = int(np.argmin(np.abs(held.theta - theta)))
    if abs(held.theta[at] - theta) > 1e-9 or mode > held.shape.shape[-1]:
        raise bad("found", "no such angle or mode", "frequencies that have both", "leave it out")
    links = deflected_links(structure, float(theta), held.shape[at, :, mode - 1])
    longest = max(beam.length for beam in structure.beams)
    largest = max(float(np.max(np.linalg.norm(bent, axis=1))) for _, bent in links.values())
    # The largest deflection is drawn as an eighth of the longest link.
    factor = 0.12 * longest / largest
    ax = axes_or_new(ax)
    for rigid, bent in links.values():
        ax.plot(*rigid.T, "--", color="0.6", lw=0.8)
        ax.plot(*(rigid + factor * bent).T, color="C0", lw=1.5)
    for place in structure.places(np.array([theta])).values():
        ax.plot(*place[0], "o", color="0.3", ms=3, mfc="w")
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title(
        f"{np.degrees(theta):.0f} deg, mode {mode}: {held.tracked[at, mode - 1]:.1f} rad/s",
        fontsize=7,
    )
    return ax


def draw_modes(
    system: LinearPeriodic, theta: Sequence[float] | Array | None = None, modes: int = 3
) -> Figure:
    """Return a figure of modes, a row to a crank angle [rad], every 36 degrees by default."""
    required_structure(system)
    if theta is None:
        angles = np.linspace(0.0, system.period, 10, endpoint=False)
    else:
        angles = crank_angles(system, theta)
    found = natural_frequencies(system, angles, require_whole("modes", modes, 1, system.size))
    figure = new_figure(2.6 * modes, 1.7 * len(angles))
    axes = figure.subplots(len(angles), modes, squeeze=False)
    for row, angle in zip(axes, angles, strict=True):
        for k, ax in enumerate(row):
            draw_mode(system, float(angle), k + 1, ax, found=found)
    return figure
