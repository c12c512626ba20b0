"""``elastolink curve`` and ``elastolink harmonics``: paths of points, and Fourier coefficients."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from .. import linkages
from ..core.errors import bad
from . import options as opt
from .linkages import animation, speed_of

if TYPE_CHECKING:
    from ..linkages.curves import CouplerCurve
    from ..scenes import Scene


def add(commands: Any) -> None:
    """Add the two subcommands."""
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
