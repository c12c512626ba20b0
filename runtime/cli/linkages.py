"""``elastolink kinematics``, ``classify``, ``simulate``, ``curve``, ``harmonics``: motions."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .. import constrained, linkages, periodic
from ..core.errors import BadInput, bad
from . import options as opt

if TYPE_CHECKING:
    from ..core.families import Array
    from ..linkages.curves import CouplerCurve
    from ..scenes import Scene
    from ..systems.rod import FreeFreeRod


def add(commands: Any) -> None:
    """Add the five subcommands."""
    kinematics = opt.command(commands, "kinematics", _kinematics)
    opt.add(kinematics, opt.angles("%(default)s"), default="0:360:361deg")
    drive = drive_options("without a drive in option or scene, rates are over it")
    opt.add(kinematics, {**drive, "--animate FILE": "draw the moving linkage: a .gif file"})

    classify = opt.command(commands, "classify", _classify, scene=False)
    opt.scene_options(classify, nargs="?")
    lengths = "frame, crank, coupler, follower, instead of a scene"
    opt.add(classify, {"--lengths A,B,C,D": lengths})
    driven = {"--input": "driven link of a four-bar; default crank"}
    opt.add(classify, driven, choices=("crank", "follower"))
    opt.add(
        classify, {"--tolerance": "relative, of every length; default 0"}, type=float, default=0.0
    )
    plane = "draw Barker's base plane instead of the transmission angle"
    opt.switches(classify, {"--base-plane": plane})

    simulate = opt.command(commands, "simulate", _simulate)
    opt.add(simulate, speed_option("default operation.speed"))
    opt.add(simulate, {"--revolutions N": "default %(default)s"}, type=float, default=2.0)
    opt.add(
        simulate, {"--method NAME": "auto (default), or SciPy's RK45, DOP853, Radau, BDF, LSODA"}
    )
    start = "coordinates and their rates [1/s] at the start, e.g. 0.001,0; default at rest"
    opt.add(simulate, {"--initial Q,QD": start}, type=_pair)
    _add_curves(commands)


def _pair(text: str) -> tuple[float, float]:
    with suppress(ValueError):
        q, qd = map(float, text.split(","))
        if math.isfinite(q) and math.isfinite(qd):
            return q, qd
    found = f"found {text!r}; expected two finite numbers, such as 0.001,0"
    raise argparse.ArgumentTypeError(found)


def _kinematics(options: argparse.Namespace) -> int:
    """Angles and places, speeds and accelerations of all links, in closed form.

    elastolink kinematics smith_1972_2122 --angles 0:360:13deg
    elastolink kinematics smith_1972_2122 --set links.assembly=crossed --plot a.png
    elastolink kinematics slider_crank_example --speed '1500 rpm' --animate engine.gif
    """
    write = animation(options)
    theta = opt.values(options.angles, "angle", "--angles")
    scene = opt.load(options)
    linkage = scene.mechanism()
    given = options.speed is not None or options.acceleration is not None
    driven = given or scene.get("operation.acceleration", 0.0)
    motion = linkage.motion(theta, *(drive_of(options, scene) if driven else ()))
    write(linkage)
    return opt.finish(options, motion, _table(motion))


def _classify(options: argparse.Namespace) -> int:
    """Grashof's and Barker's class, change points, transmission angle, dead centres.

    elastolink classify smith_1972_12_6_12_12 --plot transmission.png
    elastolink classify --lengths 12,6,12,12 --base-plane --plot plane.png
    """
    if options.plot is None:
        opt.refuse_unused(options, ("base_plane",), "--plot FILE beside it")
    linkage: Any = _linkage(options)
    four_bar = isinstance(linkage, linkages.FourBar)
    if not four_bar:
        opt.refuse_unused(options, ("input",), "a four-bar linkage")
    driven: Any = options.input or "crank"
    found: Any = linkages.classify(linkage, input=driven, tolerance=options.tolerance)
    passed_on = linkages.transmission_angle(linkage)
    if options.base_plane and not four_bar:
        raise bad("--base-plane", found.mechanism, "a four-bar linkage", "leave it out")
    draw = found.plot if options.base_plane else passed_on.plot
    lines = [*_class_lines(found), "", *_transmission_lines(passed_on)]
    more = {"transmission": passed_on.to_dict()}
    return opt.finish(options, found, lines, draw, more=more, beside=(passed_on,))


def _linkage(options: argparse.Namespace) -> Any:
    """Return the linkage of the scene or of ``--lengths``."""
    if (options.scene is None) == (options.lengths is None):
        expected = "either SCENE or --lengths A,B,C,D"
        raise bad("classify", "both or neither", expected, "give one of them")
    if options.scene is not None:
        return opt.load(options).mechanism()
    try:
        lengths = [float(text) for text in options.lengths.split(",")]
    except ValueError as refusal:
        fix = "write --lengths 12,6,12,12"
        raise bad("--lengths", repr(options.lengths), "four numbers", fix) from refusal
    checked = linkages.classify(lengths)
    return linkages.FourBar(checked.frame, checked.crank, checked.coupler, checked.follower)


def _class_lines(found: Any) -> list[str]:
    turning = ", ".join(link for link, full in found.turns.items() if full) or "no link"
    lines = [found.described]
    if hasattr(found, "inversions"):
        lines.append(f"marked by: {found.characteristic}")
        kinds = ", ".join(f"{link} {kind}" for link, kind in found.inversions.items())
        lines.append(f"inversions, by fixed link: {kinds}")
    lines.append(f"turning fully against the frame: {turning}")
    lines.append(
        f"change point {found.nearest_change}: {found.distance:+.6g} of the sum of lengths away"
    )
    return lines


def _transmission_lines(found: Any) -> list[str]:
    low, high = (math.degrees(value) for value in (found.least, found.greatest))
    band = "within" if found.within_band else "outside"
    first, last = (math.degrees(value) for value in found.band)
    lines = [f"transmission angle: {low:.6g} to {high:.6g} deg, {band} {first:g} to {last:g} deg"]
    for name, angle in found.dead_centres.items():
        at = math.degrees(angle)
        lines.append(f"dead centre, {name}: crank at {at:.6g} deg")
    for name, angles in found.toggles.items():
        if len(angles):
            shown = ", ".join(f"{math.degrees(angle):.6g}" for angle in angles)
            lines.append(f"coupler and follower in line, {name}: crank at {shown} deg")
    if found.swing is not None:
        slides = found.mechanism == "slider-crank"
        size = f"{found.swing:.6g}" if slides else f"{math.degrees(found.swing):.6g} deg"
        lines.append(f"{'stroke' if slides else 'swing'} of the output: {size}")
    if found.time_ratio is not None:
        lines.append(f"time ratio: {found.time_ratio:.6g}")
    return lines


def animation(options: argparse.Namespace) -> Callable[..., object]:
    """Return what writes ``--animate``, if that was given; a wrong file is refused here."""
    if options.animate is None:
        return lambda linkage, **_: None
    from ..linkages.pictures import animate, check_animation_path

    path = check_animation_path(options.animate)
    return lambda linkage, **more: animate(linkage, path, **more)


def _table(motion: linkages.Motion) -> list[str]:
    """Return the lines that show a motion: some of its angles, and how it is to be read."""
    import numpy as np

    count = motion.theta2.size
    chosen = opt.even_rows(count)
    columns = []
    for name in ("theta2", *motion.places, *motion.rates):
        unit = "rad" if name == "theta2" else motion.unit(name)
        values = getattr(motion, name)[chosen]
        if unit == "rad":
            unit, values = "deg", np.degrees(values)
        form = ".4f" if unit == "deg" else ".6f" if name in motion.rates else ".6g"
        # No minus before a zero.
        columns.append((name if unit == "1" else f"{name} [{unit}]", f"z{form}", values))
    lines = [*opt.columns(*columns), ""]
    crossing = getattr(motion, "transmission_angle", None)
    if crossing is not None:
        low, high = np.degrees([crossing.min(), crossing.max()])
        lines.append(f"transmission angle from {low:.4f} to {high:.4f} deg over {count} angles")
    if motion.relative:
        lines.append("speeds over omega2, accelerations over omega2^2, at constant crank speed")
    return lines


def speed_option(default: str) -> dict[str, str]:
    """Return the option of the crank speed; ``default`` says what holds without it."""
    return {"--speed SPEED": f"crank speed, e.g. '195 rpm', rad/s without a unit; {default}"}


def speeds_option(default: str) -> dict[str, str]:
    """Return the option of one crank speed or many."""
    told = f"'500 rpm', or START:STOP:COUNT[UNIT], rad/s without a unit; default {default}"
    return {"--speed SPEED": told}


def drive_options(default: str) -> dict[str, str]:
    """Return crank speed and acceleration; ``default`` says which speed holds without it."""
    told = "e.g. '25 rad/s**2', the unit of a plain number; default operation.acceleration"
    return {**speed_option(default), "--acceleration ALPHA": f"crank acceleration, {told}"}


def drive_of(options: argparse.Namespace, scene: Scene) -> tuple[float, float]:
    """Return crank speed and acceleration [rad/s, rad/s^2], from the options or the scene.

    Both may have either sign, or be zero.
    """
    acceleration = opt.given(options, "acceleration", "angular_acceleration")
    if acceleration is None:
        acceleration = float(scene.get("operation.acceleration", 0.0))
    return _speed(options, scene), acceleration


def speed_of(options: argparse.Namespace, scene: Scene) -> float:
    """Return the crank speed [rad/s]: the option, or ``operation.speed`` of the scene."""
    speed = _speed(options, scene)
    if not speed > 0:
        raise bad("--speed", repr(options.speed), "a positive crank speed", "correct the sign")
    return speed


def speeds_of(options: argparse.Namespace, scene: Scene) -> Array:
    """Return the crank speeds [rad/s] of ``--speed``: many, one, or that of the scene."""
    if options.speed is None or ":" not in options.speed:
        speed = speed_of(options, scene)
        return opt.spaced(speed, speed, 1)
    speeds = opt.values(options.speed, "frequency", "--speed")
    if speeds[0] <= 0:
        raise bad("--speed", repr(options.speed), "positive speeds", "raise the lower end")
    return speeds


def speed_range(text: str | None, scene: Scene, where: str) -> tuple[float, float]:
    """Return a range of crank speeds [rad/s]: the option's, or ``operation.speed_range``."""
    if text is None:
        span = scene.get("operation.speed_range", None)
        if span is None:
            raise bad(where, "nothing", "a range of speeds", f"give {where} LOW:HIGH")
        return float(span[0]), float(span[1])
    low, high = opt.span(text, "frequency", where, "300:900rpm")
    if not low > 0.0:
        raise bad(where, repr(text), "two rising speeds", "write it like 300:900rpm")
    return low, high


def around(name: str, value: float, dimension: str) -> tuple[float, float, str]:
    """Return half and one and a half times a scene's value, and the line that says so."""
    from ..core.units import describe

    low, high = 0.5 * value, 1.5 * value
    ends = (describe(end, dimension) for end in (low, high))
    told = "operation.speed" if name == "speed" else "its value"
    return low, high, f"{name} {' to '.join(ends)}, chosen: 0.5 to 1.5 times {told} in the scene"


def moving_scene(options: argparse.Namespace) -> Scene:
    """Return the scene that the options name; one without a crank is refused."""
    scene = opt.load(options)
    if scene.model["mechanism"] == "frame":
        fix = "use frequencies or stress"
        raise bad(f"scene {scene.name}", "a frame, which has no crank", "a linkage", fix)
    return scene


def _speed(options: argparse.Namespace, scene: Scene) -> float:
    speed = opt.given(options, "speed", "frequency")
    if speed is None:
        speed = scene.get("operation.speed", None)
    if speed is None:
        raise bad("--speed", "nothing", "a crank speed", "give --speed '500 rpm'")
    return float(speed)


def _simulate(options: argparse.Namespace) -> int:
    r"""Vibration of a flexible link in the time domain.

    elastolink simulate smith_1972_5152_sixteenth_inch --speed '195 rpm' --revolutions 3 \
        --method DOP853 --plot wave.png
    """
    if not 0 < options.revolutions <= 1e6:
        found = f"{options.revolutions:g}"
        raise bad("--revolutions", found, "a number above 0, at most 1e6", "correct it")
    scene = opt.load(options)
    if is_constrained(scene):
        return _simulate_constrained(options, scene)
    speed = 1.0 if without_crank(options, scene) else speed_of(options, scene)
    system = scene.linear_system()
    chosen = {name: getattr(options, name) for name in ("method", "initial")}
    given = {name: value for name, value in chosen.items() if value is not None}
    shown = opt.progress(options)
    try:
        result = periodic.simulate(system, speed, options.revolutions, **given, progress=shown)
    except BadInput as error:
        fix = "give --initial Q,QD, such as --initial 0.001,0"
        told = (replace(p, fix=fix) if p.where == "initial" else p for p in error.problems)
        raise BadInput(*told) from error
    return opt.finish(options, result, [*opt.ranges(result), "", f"status: {result.message}"])


def _simulate_constrained(options: argparse.Namespace, scene: Scene) -> int:
    """Integrate the constrained equations from the undeformed rod."""
    if options.initial is not None:
        fix = "leave it out: the motion starts from the undeformed rod"
        raise bad("--initial", "a value", "none for constrained equations", fix)
    if options.method not in (None, "collocation"):
        raise bad("--method", repr(options.method), "collocation alone", "leave it out")
    rod = at_speed(options, scene)
    result = constrained.constrained_motion(
        rod,
        span=options.revolutions * (2.0 * math.pi / abs(rod.speed)),
        samples=max(1, round(360 * options.revolutions)),
        progress=opt.progress(options),
    )
    norms = [
        (name, f"{float(getattr(result, f'{name}_norm').max()):.2e}")
        for name in ("position", "velocity", "acceleration")
    ]
    lines = [
        *opt.ranges(result),
        "",
        *opt.table(("constraints, level of", "largest scaled defect"), norms),
        "",
        f"status: {result.message}",
    ]
    return opt.finish(options, result, lines)


def is_constrained(scene: Scene) -> bool:
    """Return True where the scene's formulation leads to a constrained system."""
    return bool(scene.model["formulation"] == "free_free")


def at_speed(options: argparse.Namespace, scene: Scene) -> FreeFreeRod:
    """Return the scene's system at the one crank speed of the option or of the scene."""
    if options.speed is not None and ":" in options.speed:
        expected = "one speed: each has its own periodic motion"
        fix = "give one, or use formulation 'free_free_linear'"
        raise bad("--speed", repr(options.speed), expected, fix)
    moved = opt.load(options, **{"operation.speed": speed_of(options, scene)})
    system: FreeFreeRod = moved.system()
    return system


def without_crank(options: argparse.Namespace, scene: Scene) -> bool:
    """Return True for a plain Hill equation, whose variable is the angle itself."""
    return scene.model["mechanism"] == "hill" and options.speed is None


def _add_curves(commands: Any) -> None:
    curve = opt.command(commands, "curve", _curve)
    place = (
        "place in the link, from its first joint: plain numbers in lengths of the link, or with "
        "units, '6 in,2 in'; default %(default)s"
    )
    opt.add(curve, {"--point ALONG,ACROSS": place}, default="0.5,0")
    opt.add(curve, {"--link NAME": "moving link; default coupler, or the rod"})
    opt.add(curve, {"--points N": "positions; default %(default)s"}, type=int, default=720)
    circuit = "1 for the other assembly of a crank that turns, or its other range; default 0"
    opt.add(curve, {"--circuit N": circuit}, type=int, default=0)
    opt.add(curve, {"--animate FILE": "write the motion as a .gif file"})

    series = opt.command(commands, "harmonics", _harmonics)
    of = "a place or rate (theta4, omega3, position ...) or a force (x34, torque ...)"
    opt.add(series, {"--of NAME": of}, required=True)
    opt.add(series, {"--order N": "highest harmonic; default %(default)s"}, type=int, default=8)
    accuracy = "of each coefficient, over the largest value; default %(default)s"
    opt.add(series, {"--accuracy EPS": accuracy}, type=float, default=1e-12)
    speed = "constant crank speed for forces, e.g. '195 rpm'; default operation.speed"
    opt.add(series, {"--speed SPEED": speed})


def _curve(options: argparse.Namespace) -> int:
    """Path of a point of a moving link: length, area, cusps and double points.

    elastolink curve smith_1972_2122 --point 0.5,-0.75 --plot curve.png
    elastolink curve slider_crank_example --point 0.5,0.2 --animate motion.gif
    """
    write = animation(options)
    linkage = opt.load(options).mechanism()
    link = options.link or ("coupler" if "coupler" in linkage.links else linkage.links[-1])
    along, across = _point(options.point, linkage, link)
    curve = linkages.coupler_curve(
        linkage, along, across, link=link, points=options.points, circuit=options.circuit
    )
    write(linkage, curves=(curve,), circuit=options.circuit)
    return opt.finish(options, curve, _described(curve))


def _point(text: str, linkage: linkages.Linkage, link: str) -> tuple[float, float]:
    along, comma, across = text.partition(",")
    if not comma or "," in across:
        raise bad("--point", repr(text), "ALONG,ACROSS", "write it like 0.5,0.3 or '6 in,2 in'")
    if link not in linkage.links:
        raise bad("--link", repr(link), f"one of {', '.join(linkage.links)}", "choose one")
    return _coordinate(along, linkage, link), _coordinate(across, linkage, link)


def _coordinate(text: str, linkage: linkages.Linkage, link: str) -> float:
    try:
        share = float(text)
    except ValueError:
        return opt.quantity(text.strip(), "length", "--point")
    if share == 0.0:
        return 0.0
    if link not in linkage.lengths:
        expected = f"a length with a unit: the {link} has none"
        raise bad("--point", repr(text), expected, "write '20 mm'")
    return share * float(linkage.lengths[link])


def _described(curve: CouplerCurve) -> list[str]:
    import numpy as np

    lines = [
        f"length {curve.length:.9g} m (error {curve.length_error:.1g}), "
        f"area {curve.area:.9g} m^2 (error {curve.area_error:.1g})",
        f"least speed over the largest: {curve.slowest:.3g}",
    ]
    rows = []
    for i, place in enumerate(curve.cusp_position):
        angle = f"{np.degrees(curve.cusp_theta2[i]):.6f}"
        rows.append(("cusp", *(f"{x:.9g}" for x in place), angle, "", ""))
    for i, place in enumerate(curve.double_position):
        angles = [f"{angle:.6f}" for angle in np.degrees(curve.double_theta2[i])]
        crossing = f"{np.degrees(curve.crossing_angle[i]):.4f}"
        rows.append(("double point", *(f"{x:.9g}" for x in place), *angles, crossing))
    if rows:
        header = ("point", "x [m]", "y [m]", "crank [deg]", "and [deg]", "crossing [deg]")
        return [*opt.table(header, rows), "", *lines]
    return [*lines, "no cusp and no double point"]


def _harmonics(options: argparse.Namespace) -> int:
    """Harmonics of any place, rate or force over a turn of the crank.

    elastolink harmonics smith_1972_10_8_10_10 --of theta4 --plot fig7.png
    elastolink harmonics smith_1972_12_6_12_12 --of torque --speed '10 rad/s'
    """
    source = _source(options, opt.load(options))
    found = linkages.harmonics(source, order=options.order, accuracy=options.accuracy)
    lines = opt.columns(
        ("harmonic", "", range(len(found.a))),
        ("cosine", ".12g", found.a),
        ("sine", ".12g", found.b),
        ("amplitude", ".6g", found.amplitude),
        ("phase [rad]", ".4f", found.phase),
    )
    if found.secular:
        lines.append(f"beside {found.secular:g} times the crank angle")
    return opt.finish(options, found, [*lines, "", f"{found.evaluations} angles"])


def _source(options: argparse.Namespace, scene: Scene) -> tuple[Any, ...]:
    """Return what is to be analysed: a field of the motion, or else a force."""
    linkage = scene.mechanism()
    linkage.require_full_turn()
    motion = linkage.motion([0.0])
    known = [*motion.places, *motion.rates]
    if options.of in known:
        opt.refuse_unused(options, ("speed",), "a force: places and rates are over the speed")
        return linkage, options.of
    if options.of not in _FORCES:
        expected = f"one of {', '.join(known)}; or a force: {', '.join(_FORCES)}"
        raise bad("--of", repr(options.of), expected, "choose one")
    return scene.machine(), options.of, speed_of(options, scene)


_FORCES = (
    *(axis + joint for joint in ("12", "23", "34", "41") for axis in "xy"),
    *("couple34", "couple41", "torque", "shaking_x", "shaking_y", "shaking_moment"),
)
