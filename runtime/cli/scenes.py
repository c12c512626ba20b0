"""``elastolink scenes``, ``show``, ``explain``, ``new``, ``schema``: scenes and their keys."""

from __future__ import annotations

import argparse
from typing import Any

from .. import scenes
from ..core.errors import bad
from . import options as opt


def add(commands: Any) -> None:
    """Add the five subcommands."""
    listing = opt.command(commands, "scenes", _scenes, scene=False, saves=False)
    opt.switches(listing, {"--long": "with the source of each"})
    show = opt.command(commands, "show", _show, saves=False)
    opt.switches(show, {"--toml": "as a scene file, numbers in the units that they were given in"})
    opt.command(commands, "explain", _explain)
    new = opt.command(commands, "new", _new, scene=False, saves=False)
    opt.add(new, {"kind KIND": "what it is of; without it the kinds are listed"}, nargs="?")
    opt.switches(new, {"--model": "of own_model the file of energies that the scene needs"})
    schema = opt.command(commands, "schema", _schema, scene=False, draws=False, saves=False)
    opt.switches(schema, {"--page": "the keys as a page in Markdown instead"})


def _scenes(options: argparse.Namespace) -> int:
    """List the built-in scenes.

    elastolink scenes
    elastolink scenes --plot scenes.pdf   (each one drawn)
    """
    path = opt.picture(options)
    if path is not None:
        from ..core.plotting import new_figure, save_figure
        from ..scenes.pictures import draw_scene

        names = scenes.list_scenes()
        rows = -(-len(names) // 3)
        figure = new_figure(12.0, 3.0 * rows)
        for place, name in enumerate(names, start=1):
            draw_scene(scenes.load_scene(name), figure.add_subplot(rows, 3, place))
        save_figure(figure, path)
    titles = scenes.scene_titles()
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
    elastolink show smith_1972_5152_sixteenth_inch --set links.crank='80 mm' --toml > mine.toml
    """
    if options.toml:
        opt.refuse_unused(options, ("json",), "without --toml")
    scene = opt.load(options)
    if options.plot is not None:
        from ..scenes.pictures import draw_scene

        opt.draw_into(options, lambda ax: draw_scene(scene, ax))
    if options.toml:
        return opt.say(options, None, scene.to_toml())
    return opt.say(options, scene.to_dict(), "\n".join(_lines(scene)))


def _explain(options: argparse.Namespace) -> int:
    """Tell what a scene needs, and what is not derived, emitted, imported or evaluated.

    elastolink explain smith_1972_5152_sixteenth_inch --set model.modes=2
    """
    from .explanation import explain

    result = explain(options.scene, opt.settings(options.set))
    return opt.finish(options, result, result.lines())


def _new(options: argparse.Namespace) -> int:
    """Write a commented scene file to begin one's own with; without KIND, list the kinds.

    elastolink new coupler > mine.toml
    elastolink new own_model --model > mine.py
    """
    from ..scenes.beginning import new_kinds, new_model, new_scene

    kind = options.kind
    if options.model and kind != "own_model":
        raise bad("--model", repr(kind), "own_model, which takes two files", "leave it out")
    if kind is None:
        opt.refuse_unused(options, ("plot",), "a KIND")
        kinds = new_kinds()
        width = max(map(len, kinds))
        lines = (f"{name.ljust(width)}  {title}" for name, title in kinds.items())
        return opt.say(options, kinds, "\n".join(lines))
    text = new_model() if options.model else new_scene(kind)
    if options.plot:
        import tomllib

        from ..scenes.pictures import draw_scene

        scene = scenes.scene_from_document(kind, tomllib.loads(new_scene(kind)))
        opt.draw_into(options, lambda ax: draw_scene(scene, ax))
    return opt.say(options, {"kind": kind, "text": text}, text.rstrip())


def _schema(options: argparse.Namespace) -> int:
    """Print the JSON Schema of scene files, by which editors complete and check them.

    elastolink schema > scene.schema.json
    elastolink schema --page > scene_keys.md
    """
    import json

    from ..scenes.descriptions import keys_page, scene_schema

    if options.page:
        opt.refuse_unused(options, ("json",), "without --page")
        return opt.say(options, None, keys_page())
    schema = scene_schema()
    return opt.say(options, schema, json.dumps(schema, indent=1, ensure_ascii=False))


def _lines(scene: scenes.Scene) -> list[str]:
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
