"""Pictures of scenes: a linkage at several crank angles, a frame, the function of an equation."""

from __future__ import annotations

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes
from .scene import LINKAGES, Scene


def draw_scene(scene: Scene, ax: Axes) -> Axes:
    """Draw a scene's linkage at several crank angles, its frame, or a Hill equation's function."""
    ax.set_title(scene.name, fontsize="medium")
    if scene.model["mechanism"] in LINKAGES and scene.layout.formulations:
        return _draw_linkage(scene, ax)
    if "members" in scene:
        return _draw_frame(scene, ax)
    if "function" in scene:
        return _draw_function(scene, ax)
    ax.set_axis_off()
    return ax


def _draw_linkage(scene: Scene, ax: Axes) -> Axes:
    linkage = scene.mechanism()
    low, high = linkage.crank_ranges()[0]
    # Well inside a range that ends in folds.
    inset = 0.0 if linkage.crank_turns else 0.02 * (high - low)
    motion = linkage.motion(np.linspace(low + inset, high - inset, 13)[:-1])
    joints = motion.joints
    for i in range(motion.theta2.size):
        colour, width = ("C0", 1.8) if i == 2 else ("0.75", 0.7)
        for ends in linkage.bars.values():
            x, y = np.transpose([joints[end][i] for end in ends])
            ax.plot(x, y, "-o", markersize=3, color=colour, linewidth=width, zorder=2 + (i == 2))
    fixed = [place[0] for place in joints.values() if np.ptp(place, axis=0).max() == 0.0]
    ax.plot(*np.transpose(fixed), "^", color="black", markersize=7, zorder=4)
    return _to_scale(ax)


def _draw_frame(scene: Scene, ax: Axes) -> Axes:
    nodes = scene["nodes"]
    for name, member in scene["members"].items():
        ends = (nodes[member["start"]]["place"], nodes[member["end"]]["place"])
        ax.plot(*zip(*ends, strict=True), "-o", color="C0", markersize=3, linewidth=1.8)
        x, y = (sum(pair) / 2.0 for pair in zip(*ends, strict=True))
        ax.annotate(name, (x, y), xytext=(4, 4), textcoords="offset points", fontsize="small")
    for table in nodes.values():
        if table.get("held"):
            ax.plot(*table["place"], "^", color="black", markersize=7, zorder=4)
    return _to_scale(ax)


def _to_scale(ax: Axes) -> Axes:
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="x [m]", ylabel="y [m]")
    return ax


def _draw_function(scene: Scene, ax: Axes) -> Axes:
    theta = np.linspace(0.0, 2 * np.pi, 361)
    ax.plot(np.degrees(theta), PeriodicFunction(**scene["function"])(theta))
    ax.set(xlabel="theta [deg]", ylabel="f(theta)")
    return ax
