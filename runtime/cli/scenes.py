"""``elastolink scenes``, ``show``, ``explain``: what there is, numbers and needs of one scene."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from . import options as opt

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from matplotlib.axes import Axes

    from ..scenes import Scene
    from ..scenes.schema import Table


def add(commands: Any) -> None:
    """Add the three subcommands."""
    listing = opt.command(commands, "scenes", _scenes, scene=False)
    opt.switches(listing, {"--long": "with the source of each"})
    opt.command(commands, "show", _show)
    opt.command(commands, "explain", _explain)


def _scenes(options: argparse.Namespace) -> int:
    """List the built-in scenes.

    elastolink scenes
    elastolink scenes --plot scenes.pdf   (each one drawn)
    """
    from ..scenes import list_scenes, load_scene, scene_titles

    path = opt.picture(options)
    if path is not None:
        from ..core.plotting import new_figure, save_figure

        names = list_scenes()
        rows = -(-len(names) // 3)
        figure = new_figure(12.0, 3.0 * rows)
        for place, name in enumerate(names, start=1):
            draw_scene(load_scene(name), figure.add_subplot(rows, 3, place))
        save_figure(figure, path)
    titles = scene_titles()
    width = max(map(len, titles))
    content, lines = [], []
    for name, (title, source) in sorted(titles.items()):
        content.append({"name": name, "title": title, "source": source})
        lines.append(f"{name.ljust(width)}  {title}")
        lines += [f"{' ' * width}  {source}"] * options.long
    return opt.say(options, content, "\n".join(lines))


def _show(options: argparse.Namespace) -> int:
    """Show a scene: every number in SI units, with what follows from the given ones.

    elastolink show smith_1972_5152_sixteenth_inch --set coupler.damping_ratio=0.01
    """
    scene = opt.load(options)
    opt.draw_into(options, lambda ax: draw_scene(scene, ax))
    return opt.say(options, scene.to_dict(), "\n".join(_lines(scene)))


def _explain(options: argparse.Namespace) -> int:
    """Tell what a scene needs, and what is not derived, emitted, imported or evaluated.

    elastolink explain smith_1972_5152_sixteenth_inch --set model.modes=2
    """
    from .explanation import explain

    result = explain(options.scene, opt.settings(options.set))
    return opt.finish(options, result, result.lines())


def _lines(scene: Scene) -> list[str]:
    from ..core.units import DIMENSIONS, describe

    lines = [scene.title, f"source: {scene.source}", f"module: {scene.model_spec().name()}"]
    for name, layout, table in _all_tables(scene):
        lines += ["", f"[{name}]" + (f"  {layout.meaning}" if layout else "")]
        for key, value in table.items():
            dimension = scene.dimension(f"{name}.{key}")
            known = layout.key(key) if layout else None
            if isinstance(value, float) and dimension is not None:
                text = describe(value, dimension)
                width = scene.tolerances.get(f"{name}.{key}")
                text += f" +- {width:.6g}" if width else ""
            elif isinstance(value, tuple) and dimension is not None:
                listed = ", ".join(f"{number:.6g}" for number in value)
                text = f"[{listed}] {DIMENSIONS[dimension].si}".rstrip()
            else:
                text = ", ".join(map(str, value)) if isinstance(value, tuple) else str(value)
            meaning = f"  ({known.meaning})" if known else ""
            lines.append(f"  {key} = {text or 'none'}{meaning}")
    return lines


def _all_tables(scene: Scene) -> Iterator[tuple[str, Table | None, Mapping[str, Any]]]:
    """Yield every table with its description; those under a name of their own one by one."""
    for name, table in scene.tables.items():
        layout = scene.layout.table(name)
        if layout is None or not layout.named:
            yield name, layout, table
            continue
        for inner, content in table.items():
            yield f"{name}.{inner}", layout, content


def draw_scene(scene: Scene, ax: Axes) -> Axes:
    """Draw a scene's linkage at several crank angles, its frame, or a Hill equation's function."""
    from ..scenes.scene import LINKAGES

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
    import numpy as np

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
    import numpy as np

    from ..core.periodic_function import PeriodicFunction

    theta = np.linspace(0.0, 2 * np.pi, 361)
    ax.plot(np.degrees(theta), PeriodicFunction(**scene["function"])(theta))
    ax.set(xlabel="theta [deg]", ylabel="f(theta)")
    return ax
