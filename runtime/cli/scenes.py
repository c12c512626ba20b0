"""``elastolink scenes``, ``show``, ``explain``: what there is, numbers and needs of one scene."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from . import options as opt

if TYPE_CHECKING:
    from ..scenes import Scene


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
        from ..scenes.pictures import draw_scene

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
    if options.plot is not None:
        from ..scenes.pictures import draw_scene

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
    for name, layout, table in scene.described():
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
