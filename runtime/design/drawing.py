"""A scene and those of its numbers that may change, with their bounds, and what changes say."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.errors import BadInput, Problem, bad, refuse, shown
from ..core.families import MATRICES, VECTORS, Array, LinearPeriodic
from ..core.inputs import are_finite, names_in_a_row, require_mapping
from ..core.units import DIMENSIONS, to_si
from ..scenes import Scene, scene_from_document

# Factor either way that a number may change by, and the part of critical damping that may be added.
_FACTOR, _DAMPING = 1.5, 0.2
# Powers of its thickness that the numbers of a bar of constant width grow by.
_CUBES = ("bending_stiffness", "second_moment")
_LINEAR = ("area", "mass_per_length", "thickness", "shear_stiffness", "inertia", "first_moment")
_USUAL = ("follower.inertia", "coupler.damping", "damping.ratio", "rod.damping_ratio")


@dataclass(frozen=True)
class Number:
    """One number of a drawing; its shift is the logarithm of the factor that it changes by.

    Of damping that is 0 it is the part of the critical one.
    """

    key: str  # of the scene, or the thickness of a link of which that gives only what follows
    value: float  # at present [SI]; 1 for such a thickness
    critical: float  # what damping that is 0 is measured by
    bounds: tuple[float, float]
    powers: Mapping[str, float]  # keys of the scene that change, each with the power

    @property
    def ends(self) -> list[float]:
        """Least and greatest shift."""
        if not self.value:
            return [end / self.critical for end in self.bounds]
        return sorted(math.log(end / self.value) for end in self.bounds)

    @property
    def damping(self) -> bool:
        """Whether it is one of damping, which closes regions in place of moving them."""
        return any(word in self.key for word in ("damping", "retard", "relax", "rayleigh"))


@dataclass(frozen=True)
class Drawing:
    """A scene and the numbers of it that may change.

    ``fixed``: the coupler's mass per length where the scene gives its frequency, which is that of a
    beam of the present length and stiffness.
    """

    scene: Scene
    numbers: tuple[Number, ...]
    fixed: Mapping[str, float]

    def values(self, shifts: Iterable[float]) -> dict[str, float]:
        """Return the keys of the scene that change, with their values [SI]."""
        found: dict[str, float] = {}
        for number, shift in zip(self.numbers, shifts, strict=True):
            for key, power in number.powers.items() if shift else ():
                present = found.get(key, self.scene.get(key, 0.0))
                grown = present * math.exp(power * shift)
                found[key] = grown if number.value else shift * number.critical
        return found

    def settings(self, shifts: Iterable[float]) -> dict[str, str]:
        """Return overrides of the scene that do it, in the units of the drawing, to six digits."""
        values = self.values(shifts)
        if {"links.coupler", "coupler.bending_stiffness"} & set(values):
            values = {**self.fixed, **values}
        return {key: self.written(key, value) for key, value in values.items()}

    def changed(self, shifts: Iterable[float]) -> Scene:
        """Return the scene with shifted numbers."""
        return self.loaded({**self.fixed, **self.values(shifts)})

    def loaded(self, overrides: Mapping[str, Any]) -> Scene:
        """Return the scene with other values."""
        return scene_from_document(self.scene.name, self.scene.document, overrides)

    def written(self, key: str, value: float) -> str:
        """Return a value [SI] of a key in the unit that the drawing has it in."""
        dimension = self.scene.dimension(key)
        if self.scene.get(key, None) is None and dimension in (None, "length"):
            return f"{value:.6g} times the present one"
        given: Any = self.scene.document
        for name in key.split("."):
            given = given.get(name) if isinstance(given, Mapping) else None
        unit = DIMENSIONS[dimension or "dimensionless"].si
        if isinstance(given, str):
            unit = re.sub(r"^\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*", "", given)
        size = to_si(f"1 {unit}".strip(), dimension or "dimensionless", key)
        return f"{value / size:.6g} {unit}".strip()

    def words(self, shifts: Sequence[float]) -> Iterator[str]:
        """Yield what changes, number by number: by how much, from which value to which."""
        for number, shift in zip(self.numbers, shifts, strict=True):
            if shift:
                new = self.values(shift if one is number else 0.0 for one in self.numbers)
                pairs = [
                    f"{key if key != number.key else ''} "
                    f"{self.written(key, self.scene.get(key, 0.0))} -> {self.written(key, value)}"
                    for key, value in new.items()
                ]
                by = f"{100 * math.expm1(shift):+.2f} %" if number.value else f"+{shift:.3g} crit."
                yield f"{number.key} {by} ({', '.join(map(str.strip, pairs))})"


def drawing_of(
    scene: Scene, change: Sequence[str] | None, bounds: Mapping[str, tuple[float, float]] | None
) -> Drawing:
    """Return the numbers to change, by default the usual ones, refused where they do not do."""
    given = {} if bounds is None else bounds
    require_mapping("bounds", given, 'say {"links.crank": (0.07, 0.08)}, for example')
    system, usual = scene.linear_system(), _usual(scene)
    names = usual if change is None else names_in_a_row("change", change)
    if not names or len(set(names)) < len(names):
        raise bad("change", shown(names), "different keys, at least one", "name some")
    fixed = {}
    if "natural_frequency" in scene.document.get("coupler", {}):
        fixed = {"coupler.mass_per_length": scene.get("coupler.mass_per_length")}
    fixed = {} if "coupler.natural_frequency" in names else fixed
    problems = [
        Problem(f"bounds of {key}", "a key that is not changed", f"one of {names}", "mend it")
        for key in given
        if key not in names
    ]
    numbers = []
    for name in names:
        try:
            number = _number(scene, name, given.get(name), usual)
        except BadInput as refusal:
            problems += refusal.problems
            continue
        if _matters(system, Drawing(scene, (number,), fixed)):
            numbers.append(number)
        elif change is not None:
            expected = "a number that the equations depend on"
            problems.append(Problem(name, "a key without effect", expected, "leave it out"))
    refuse(problems)
    drawing = Drawing(scene, tuple(numbers), fixed)
    drawing.changed([1e-9] * len(numbers))  # keys of one meaning
    return drawing


def _usual(scene: Scene) -> tuple[str, ...]:
    keys = [f"links.{name}" for name in scene.document.get("links", {})]
    keys += [f"joints.{joint}.mass" for joint in scene.document.get("joints", {})] + [*_USUAL]
    thick = (f"{link}.thickness" for link in scene.layout.flexible)
    return (*(key for key in keys if scene.dimension(key) is not None), *thick)


def _number(
    scene: Scene, key: str, bounds: tuple[float, float] | None, usual: Sequence[str]
) -> Number:
    """Return one number, refused where it is none or its bounds do not hold it."""
    table, _, name = key.rpartition(".")
    powers, value, critical = {key: 1.0}, scene.get(key, 0.0), 1.0
    if name == "thickness" and table in scene.layout.flexible:
        given, value = set(scene.document[table]), value or 1.0
        given |= {"mass_per_length"} if "natural_frequency" in given else set()
        powers = {f"{table}.{one}": 3.0 for one in _CUBES if one in given}
        powers |= {f"{table}.{one}": 1.0 for one in _LINEAR if one in given}
    elif scene.dimension(key) is None:
        raise bad(key, shown(scene.get(key, None)), f"a number, such as {usual}", "correct the key")
    if key == "coupler.damping":
        critical = 2.0 * scene["coupler"]["mass_per_length"] * scene["coupler"]["natural_frequency"]
    elif not key.endswith("ratio") and not value:
        critical = 0.0
    if isinstance(value, tuple) or not (value or critical):
        raise bad(key, shown(value), "one number that is not 0", "leave it out")
    usually = (value / _FACTOR, value * _FACTOR) if value else (0.0, _DAMPING * critical)
    low, high = usually if bounds is None else bounds
    if not (are_finite((low, high), 2) and low <= value <= high and (not value or low / value > 0)):
        expected = f"two values of one sign that hold the present one, {value:g}"
        raise bad(f"bounds of {key}", shown(bounds), expected, "widen them")
    return Number(key, float(value), critical, (float(low), float(high)), powers)


def _matters(system: LinearPeriodic, drawing: Drawing) -> bool:
    """Return whether the equations change with the one number of a drawing."""
    shift = 0.01 * np.sign(max(drawing.numbers[0].ends, key=abs))
    try:
        other = drawing.changed([shift]).linear_system()
    except BadInput:
        return True
    first, second = _entries(system), _entries(other)
    if first.shape != second.shape:
        return True
    return bool(np.max(np.abs(first - second)) > 1e-13 * np.max(np.abs(first)))


def _entries(system: LinearPeriodic) -> Array:
    """Return all matrices and loads over a turn in a row."""
    angles = np.linspace(0.0, system.period, 8, endpoint=False)
    names = [name for name in (*MATRICES, *VECTORS) if system.has(name)]
    return np.concatenate([np.asarray(system.array(name, angles)).ravel() for name in names])
