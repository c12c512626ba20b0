"""The sections of a report: each asks some solvers of the toolkit, and says what they answer."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput, ElastolinkError, ElastolinkWarning, one_line
from ..core.families import Array, LinearPeriodic
from ..core.maxima import polished
from ..core.plotting import RPM, Axes
from ..core.units import DIMENSIONS, describe
from ..design import diagnose
from ..design.diagnosis import Diagnosis
from ..frequencies import natural_frequencies
from ..linkages import Linkage, Motion, classify, transmission_angle
from ..periodic import SteadyState, floquet_multipliers, steady_state
from ..recovery import elastic_coupler_curve, stress
from ..rigid import Machine, force_peaks, rigid_forces, torque_fluctuation
from ..rigid.peaks import LABELS
from ..scenes import Scene
from ..scenes.pictures import draw_scene
from ..scenes.scene import LINKAGES
from ..scenes.tolerances import flat
from ..stability import stability_chart
from ..stability.chart_axes import axis_of_scene, measured_marks
from .moving import SECONDS, moving_machine, positions
from .parts import (
    COLOURS,
    Checked,
    Markup,
    Part,
    Section,
    Table,
    figure,
    known,
    number,
    set_unit,
    small,
)

# Points of a chart along an axis at the most, modes that are told of, crank angles of a turn.
_POINTS, _MODES, _ANGLES = 201, 6, 720
# Part of a link's length that its largest deflection is drawn as.
_DRAWN = 0.08


@dataclass(frozen=True)
class Subject:
    """What a report is of: a scene and what it describes; None for what it has not."""

    scene: Scene
    speed: float  # of the crank [rad/s]; 0 where none is given
    linkage: Any  # a Linkage
    machine: Machine | None  # of rigid links that have masses
    system: LinearPeriodic | None
    vibrates: bool  # by equations of any kind

    @property
    def kind(self) -> str:
        """The mechanism of the scene."""
        return str(self.scene.model["mechanism"])

    @property
    def steady(self) -> SteadyState | None:
        """The steady motion, where something forces one."""
        if self.system is None or not self.speed > 0.0:
            return None
        forced = any(self.system.has(name) for name in "fhp")
        return steady_state(self.system, self.speed) if forced else None


def subject_of(scene: Scene) -> Subject:
    """Return what a scene describes; a scene whose equations are missing is refused."""
    packaged = bool(scene.layout.formulations)
    rigid = packaged and "links" in scene and not scene.layout.flexible
    linkage = scene.mechanism() if packaged and scene.model["mechanism"] in LINKAGES else None
    try:
        machine = scene.machine() if rigid else None
    except BadInput:  # no link has a mass
        machine = None
    system = None if rigid else scene.system()
    linear = system if isinstance(system, LinearPeriodic) else None
    speed = float(scene.get("operation.speed", 0.0))
    return Subject(scene, speed, linkage, machine, linear, system is not None)


def sections(of: Subject) -> Iterator[Section]:
    """Yield the sections that a scene has; where a solver refuses, the section ends with that."""
    seen: set[str] = set()
    for heading, make in _MAKERS.items():
        parts, failed = list[Part](), ""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", ElastolinkWarning)
            try:
                for part in make(of):
                    if isinstance(part, Checked):
                        dict(part.result.checks)  # made when they are looked at
                    parts.append(part)
            except (ElastolinkError, ArithmeticError, np.linalg.LinAlgError) as error:
                failed = one_line(str(error), 400)
        if parts or failed:
            told = dict.fromkeys(one_line(str(one.message), 400) for one in caught)
            yield Section(heading, tuple(parts), tuple(k for k in told if k not in seen), failed)
            seen.update(told)


def _picture(of: Subject) -> Iterator[Part]:
    scene, linkage = of.scene, of.linkage
    kind = "Hill's equation" if of.kind == "hill" else of.kind.replace("_", " ").capitalize()
    bends = f"; what bends: {', '.join(scene.layout.flexible)}" if scene.layout.flexible else ""
    yield f"{kind}{bends}; formulation: {scene.model['formulation']}."
    if scene.source:
        yield f"Source: {scene.source}."
    if of.speed:
        yield f"Running speed: {describe(of.speed, 'frequency')}."
    elif linkage is not None:
        yield "The scene gives no operation.speed; what needs a running speed is left out."
    if of.vibrates and of.system is None:
        yield "Its equations are not linear: what is said of linear vibration is left out."
    if linkage is None:
        what = {"members": "Frame.", "function": "Function of the equation."}
        for caption in (what[table] for table in what if table in scene):
            yield figure(caption, f"{caption} Scene {scene.name}", partial(draw_scene, scene))
        return
    found: Any = classify(linkage)
    yield f"Class: {found.described}."
    yield Checked("class", found)
    told, bent = f"The linkage moving once around in {SECONDS:g} s", _bent(of)
    if of.speed:
        slower = SECONDS * abs(of.speed) / (2.0 * np.pi)
        told += f", {slower:.3g} times slower than at the running speed"
    for link, (factor, _) in bent.items():
        told += f"; the steady deflection of the {link} is drawn {factor:g} times as large"
    places = {link: line for link, (_, line) in bent.items()}
    yield Markup(moving_machine(linkage, f"{told}.", places))


def _bent(of: Subject) -> dict[str, tuple[float, NDArray[np.complex128]]]:
    """Return the one link that bends: how much enlarged, and its places at every position."""
    links, motion = of.scene.layout.flexible, of.steady
    if of.linkage is None or len(links) != 1 or motion is None or not _shaped(motion):
        return {}
    angles, along = positions(of.linkage), np.linspace(0.0, 1.0, 25)
    columns, turn = motion.deflection(along).T, motion.period
    across = np.array([np.interp(angles, motion.theta, one, period=turn) for one in columns])
    largest = float(np.max(np.abs(across)))
    if not (motion.stable and largest > 0.0):
        return {}
    size = motion.reference_length
    factor = float(f"{max(_DRAWN * size / largest, 1.0):.1g}")
    link = of.linkage.motion(angles).link(links[0])
    local = np.exp(1j * link.angle) * (size * along[:, None] + 1j * factor * across)
    return {links[0]: (factor, (link.origin @ [1.0, 1j] + local).T)}


def _shaped(motion: SteadyState) -> bool:
    return motion.shapes is not None and motion.shapes(np.zeros(1), motion.theta[:1]) is not None


def _numbers(of: Subject) -> Iterator[Part]:
    scene = of.scene
    yield "All numbers of the scene in SI units, as they are given and what follows from them."
    for name, layout, values in scene.described():
        rows = []
        for key, value in values.items():
            where = f"{name}.{key}"
            if name == "chart" or value == ():
                continue
            told, width = layout.key(key) if layout else None, scene.tolerances.get(where)
            each = value if isinstance(value, tuple) else (value,)
            text = ", ".join(number(v) if isinstance(v, float) else str(v) for v in each)
            text += f" ± {number(width)}" if width else ""
            dimension = scene.dimension(where)
            text += f" {set_unit(DIMENSIONS[dimension].si)}" if dimension else ""
            rows.append((key, text, _as_given(scene, where), told.meaning if told else ""))
        if rows:
            meaning = f": {layout.meaning}" if layout else ""
            yield Table(f"[{name}]{meaning}", "key|value|as given|meaning", rows)


def _as_given(scene: Scene, where: str) -> str:
    """Return a number as the file has it; else where it comes from."""
    value, filled = (dict(flat(tables)).get(where) for tables in (scene.document, scene.given))
    if value is None:
        return "follows" if filled is None else "by default"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _angles(linkage: Linkage) -> Array:
    """Return the crank angles of a turn, or of what the crank reaches but for its ends."""
    low, high = (0.0, 2.0 * np.pi) if linkage.crank_turns else linkage.crank_ranges()[-1]
    inset = 0.0 if linkage.crank_turns else 0.01 * (high - low)
    return np.linspace(low + inset, high - inset, _ANGLES + 1)


def _motion(of: Subject) -> Iterator[Part]:
    linkage = of.linkage
    if linkage is None:
        return
    over = "a turn of the crank" if linkage.crank_turns else "what the crank reaches"
    passed_on = transmission_angle(linkage)
    if passed_on.least < passed_on.greatest:  # that of a sliding block stays
        low, high = (number(math.degrees(a)) for a in (passed_on.least, passed_on.greatest))
        yield f"The transmission angle goes from {low} to {high} deg."
        told = f"Curve of the transmission angle, from {low} to {high} degrees"
        yield figure(f"Transmission angle over {over}, and what is advised.", told, passed_on.plot)
        yield Checked("transmission angle", passed_on)
    motion = linkage.motion(_angles(linkage), *([of.speed] if of.speed else []))
    if motion.relative:
        yield "Rates are over the crank speed, or its square, at constant crank speed."
    told = f"Curves of {', '.join(motion.drawn)} over the crank angle; extremes in the table"
    yield figure(f"Motion over {over}.", told, motion.plot)
    rows = [_extremes(motion, name) for name in (*motion.places, *motion.rates)]
    heads = "quantity|unit|least|at crank [deg]|greatest|at crank [deg]|error"
    yield Table(f"Extremes over {over}", heads, rows)
    yield Checked("motion", motion)


def _extremes(motion: Motion, name: str) -> tuple[str, ...]:
    """Return a row of a table: least and greatest value of a place or rate, and where."""
    values, error, unit = getattr(motion, name), motion.errors[name], motion.unit(name)
    if unit == "rad":
        values, error, unit = np.degrees(values), np.degrees(error), "deg"
    kinds = {"theta": "angle", "omega": "angular speed", "alpha": "angular acceleration"}
    words = name.replace("_", " ")
    if name[-1].isdigit() and name[:-1] in kinds:
        words = f"{kinds[name[:-1]]} of the {motion.linkage.links[int(name[-1]) - 2]}"
    low, at_low, missed_low = _top(motion, -values)
    high, at_high, missed_high = _top(motion, values)
    doubt = float(np.max(error)) + max(missed_low, missed_high)
    ends = number(-low, doubt), at_low, number(high, doubt), at_high
    return words, set_unit(unit), *ends, small(doubt)


def _top(motion: Motion, values: Array) -> tuple[float, str, float]:
    """Return the largest value, the crank angle there, and its error between the angles."""
    theta, closed = motion.theta2, motion.linkage.crank_turns
    closed = closed and bool(np.isclose(values[0], values[-1], rtol=1e-9, atol=1e-9))
    count = len(values) - closed
    k = int(np.argmax(values[:count]))
    place, height, missed = np.array(0.0), values[k], np.array(0.0)
    if closed or 2 <= k < count - 2:
        place, height, missed = polished(values[(k + np.arange(-2, 3)) % count])
    at = math.degrees(theta[k] + float(place) * (theta[1] - theta[0]))
    return float(height), f"{at:z.2f}", float(missed)


def _forces(of: Subject) -> Iterator[Part]:
    machine, speed = of.machine, of.speed
    if machine is None or not speed:
        return
    acceleration = float(of.scene.get("operation.acceleration", 0.0))
    theta = _angles(machine.linkage)
    found = rigid_forces(machine, theta, speed, acceleration)
    peaks = force_peaks(machine, speed, acceleration, span=(float(theta[0]), float(theta[-1])))
    rows, doubt = [], float(np.max(found.error))
    for name, peak in peaks.items():
        words, unit = LABELS[name]
        value, error = known(peak.value, peak.error + doubt)
        rows.append((words, value, unit, f"{math.degrees(peak.crank_angle):z.2f}", error))
    most = {name: number(abs(peak.value)) for name, peak in peaks.items()}
    shaking, torque = most["shaking_force"], most["torque"]
    yield f"Force on the frame up to {shaking} N, driving torque up to {torque} N m, links rigid."
    yield Table("Largest sizes", "quantity|peak|unit|at crank [deg]|error", rows)
    if machine.linkage.crank_turns:
        even = torque_fluctuation(machine, speed)
        mean = number(even.mean_torque, 1e-14 * abs(peaks["torque"].value))
        energy, error = known(even.energy_fluctuation, float(even.error))
        yield f"Mean driving torque {mean} N m; energy fluctuation {energy} J (error {error} J)."
        yield Checked("energy", even)
    told = "over the crank angle, or with its direction and crank angles marked; peak in the table"
    for joint, words in (
        ("torque", "Driving torque"),
        ("frame", "Force on the frame"),
        ("23", "Force of the crank on the next link"),
        ("34", "Force of the third link on the fourth"),
    ):
        yield figure(f"{words}.", f"{words} {told}", partial(found.plot, joint=joint))
    yield Checked("forces", found)


def _frequencies(of: Subject) -> Iterator[Part]:
    if of.system is None or of.kind == "hill":
        return
    found = natural_frequencies(of.system, count=min(_MODES, of.system.size))
    rows = []
    for k, (mean, error) in enumerate(zip(found.mean, found.mean_error, strict=True)):
        ends = (number(float(end(found.frequency[:, k])), error) for end in (np.min, np.max))
        rows.append((str(k + 1), *known(mean, error), number(mean / (2.0 * np.pi), error), *ends))
    yield f"Lowest natural frequency: {rows[0][3]} Hz ({rows[0][1]} rad/s)."
    if found.crossings or found.veerings:
        yield f"Crossings: {len(found.crossings)}; veerings: {len(found.veerings)}."
    heads = "mode|mean [rad/s]|error [rad/s]|[Hz]|least [rad/s]|greatest [rad/s]"
    yield Table("Means over the crank angle, the crank held", heads, rows)
    if np.any(np.ptp(found.frequency, axis=0) > 1e-6 * found.mean):
        told = f"Curves of {len(rows)} natural frequencies over the crank angle"
        yield figure("Natural frequencies with the crank held.", told, found.plot)
    yield Checked("natural frequencies", found)


def _stability(of: Subject) -> Iterator[Part]:
    system, rows = of.system, list[tuple[str, ...]]()
    if system is None or of.kind == "frame":
        return
    if of.kind == "hill":
        found = floquet_multipliers(system, 1.0)
        yield f"At its parameters the equation is {'' if found.stable else 'un'}stable."
        largest = float(np.max(np.abs(found.multipliers)))
        rows.append(("largest modulus of a multiplier", *known(largest, found.error[0]), ""))
        yield Checked("multipliers", found)
    elif of.speed > 0.0:
        said = diagnose(of.scene, of.speed)
        verdict = said.lines[0].replace(of.scene.name, "the machine", 1)
        yield from (f"{line[:1].upper()}{line[1:]}." for line in (verdict, *said.lines[1:]))
        rows.append(("growth in a turn, logarithm", *known(said.growth, said.error), ""))
        if near := said.nearest:
            for i, name in enumerate(near.region):
                end, width, far = near.end[i], near.width[i], near.distance[i]
                error = near.error[i]
                rows.append((f"{name}: nearer end", *known(end, error, 1.0 / RPM), "rpm"))
                rows.append((f"{name}: width", *known(width, 2.0 * error, 1.0 / RPM), "rpm"))
                rows.append((f"{name}: margin", *known(far, error / of.speed, 0.01), "%"))
            told = "Bars: unstable regions near the running speed; dashed line: the running speed"
            if near.region:
                # Its own label is too long for so small a figure: the caption has it.
                yield figure(f"{told}.", told, partial(_regions, said), height=2.4)
        yield Checked("diagnosis", said)
    if rows:
        yield Table("At the running point", "quantity|value|error|unit", rows)
    yield from _chart(of, system)


def _regions(said: Diagnosis, ax: Axes) -> None:
    said.plot(ax).set_xlabel("crank speed [rpm]")


def _chart(of: Subject, system: LinearPeriodic) -> Iterator[Part]:
    """Yield the chart that the scene asks for, the running point in it."""
    axes = [axis_of_scene(of.scene, axis) for axis in ("x", "y")]
    if None in axes:
        return
    x, y = (
        (name, np.linspace(values[0], values[-1], min(len(values), _POINTS)))
        for name, values in filter(None, axes)
    )
    fixed = None if "speed" in (x[0], y[0]) else of.speed or None
    marks = measured_marks(of.scene, y)
    found = stability_chart(system, x=x, y=y, speed=fixed, marks=marks)
    here = {"speed": of.speed, **system.parameters, **system.geometry}
    inside = all(values[0] <= here.get(name, math.nan) <= values[-1] for name, values in (x, y))
    place = [here.get(name, 0.0) * (RPM if name == "speed" else 1.0) for name, _ in (x, y)]

    def draw(ax: Axes) -> None:
        if inside:
            ax.plot(*place, "*", ms=11, color=COLOURS[4], mec="k", label="running point", zorder=9)
        found.plot(ax)

    part = f"{100.0 * float(np.mean(~found.stable)):.3g} %"
    where = f"the running point is {'marked by a star' if inside else 'outside the chart'}"
    yield f"Of the chart {part} is unstable; {where}."
    names = f"{x[0]} and {y[0]}".replace("_", " ")
    told = f"Stability over {names}: unstable regions shaded, {part} of the area; {where}"
    yield figure(f"Stability chart over {names}.", told, draw)
    yield Checked("chart", found)


def _steady(of: Subject) -> Iterator[Part]:
    motion = of.steady
    if motion is None:
        return
    if not np.all(np.isfinite(motion.q)):
        yield "At the running speed there is no single periodic motion."
        return
    part = motion.checks.get("linear range")
    yield (
        "Periodic motion"
        if part is None
        else (f"The steady motion bends a link by {100.0 * part.value:.3g} % of its length.")
    )
    if not motion.stable:
        yield "Disturbances of it grow: no machine would show this motion."
    yield Checked("steady motion", motion)
    if _shaped(motion):
        yield from _deflection(motion)
    elif of.system and of.system.structure and of.linkage and "coupler" in of.linkage.links:
        path = elastic_coupler_curve(of.system, motion)
        row = ("middle of the coupler", *known(path.largest, float(path.error), 1e-3))
        heads = "point|largest displacement [mm]|error, but for the mesh [mm]"
        yield Table("Elastic displacement", heads, [row])
        told = "Path of the coupler's middle, of the elastic linkage and of the rigid one"
        yield figure(f"{told} (dashed).", told, path.plot)
        yield Checked("path", path)


def _deflection(motion: SteadyState) -> Iterator[Part]:
    places = np.array([0.25, 0.5, 0.75, 1.0])
    peaks = motion.peak(places)
    places, peaks = (values[peaks > 1e-9 * np.max(peaks)] for values in (places, peaks))
    errors = peaks * motion.peak_error(places)
    rows = [
        (f"{place:g}", *known(peak, error, 1e-3))
        for place, peak, error in zip(places, peaks, errors, strict=True)
    ]

    def draw(ax: Axes) -> None:
        angles = np.degrees(np.append(motion.theta, motion.period))
        for place, column in zip(places, motion.deflection(places).T, strict=True):
            ax.plot(angles, 1e3 * np.append(column, column[:1]), label=f"x/length = {place:g}")
        ax.set(xlabel="crank angle [deg]", ylabel="deflection [mm]")
        ax.legend()

    heads = "place x/length|largest deflection [mm]|error [mm]"
    yield Table("Largest deflection across the link", heads, rows)
    told = "Curves of the deflection over the crank angle; largest sizes in the table"
    yield figure("Deflection over a turn of the crank.", told, draw)


def _stresses(of: Subject) -> Iterator[Part]:
    structure = None if of.system is None else of.system.structure
    if of.system is None or structure is None or not (of.speed > 0.0 or of.kind == "frame"):
        return
    if any(beam.section.thickness is None for beam in structure.beams):
        return
    found = stress(of.system, None if of.kind == "frame" else of.speed)
    error, rows = float(found.error), []
    for link, peak in found.maxima.items():
        at = "-" if of.kind == "frame" else f"{math.degrees(peak.theta):.1f}"
        rows.append((link, *known(peak.value, error, 1e6), f"{peak.place:.3g}", at, peak.fibre))
    largest = known(abs(found.maximum.value), error, 1e6)[0]
    yield f"Largest stress: {largest} MPa, in the {found.maximum.link}."
    heads = "link|stress, tension positive [MPa]|error [MPa]|at x/length|at crank [deg]|fibre"
    yield Table("Largest stress of each link", heads, rows)
    told = f"Stress at the worst place of each link; the largest is {largest} MPa"
    yield figure("Stress at the worst fibre of each link.", told, found.plot)
    yield Checked("stress", found)


_MAKERS: Mapping[str, Callable[[Subject], Iterator[Part]]] = {
    "The machine": _picture,
    "Its numbers": _numbers,
    "Motion": _motion,
    "Forces": _forces,
    "Natural frequencies": _frequencies,
    "Stability": _stability,
    "Steady deflection": _steady,
    "Stress": _stresses,
}
