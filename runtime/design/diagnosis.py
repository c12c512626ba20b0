"""What a machine does at its running speed, what lies near, and what to change, in words."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.errors import LINEAR_RANGE, BadInput, LinearRangeWarning
from ..core.families import LinearPeriodic
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers, steady_state
from ..recovery import stress
from ..scenes import Scene, with_numbers
from .nearest_regions import FASTEST, Margins, fastest_mode, margins

# Tables that tell how a machine is run, seen or was measured, and not how it is made.
_NOT_MADE = ("model", "operation", "measured", "chart", "loads", "motor")
# How far from the running speed, over it, a region is wished to be; the largest change that is
# spoken of; up to which growth per turn a motion neither grows nor dies out; and how far about a
# speed branches of motions are followed: from where these are small, mostly.
_AWAY, _LARGEST, _STILL, _AROUND = 0.1, 0.2, 1e-9, 0.3


@dataclass(frozen=True, kw_only=True)
class Diagnosis(Result):
    """What a machine does at a speed.

    ``error`` is that of ``growth``.

    Attributes
    ----------
    speed : float
        Crank speed [rad/s].
    growth : float
        Largest logarithm of a multiplier's modulus: growth per turn, negative where motions decay.
    stable : bool
        Whether no disturbance grows.
    deflection : float
        Largest steady deflection over the length of its link; NaN where nothing forces it, no
        shapes are known or no steady motion is stable.
    largest_stress : float
        Largest steady stress [Pa]; NaN where the scene has no beams with a thickness.
    nearest : Margins or None
        Regions next to the speed; None where they were not looked for.
    lines : tuple of str
        All of it in words.
    """

    speed: float
    growth: float
    stable: bool
    deflection: float
    largest_stress: float
    nearest: Margins | None
    lines: tuple[str, ...]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the regions next to the speed as bars, and the speed as a line."""
        ax = axes_or_new(ax)
        near = self.nearest
        for i, name in enumerate(near.region if near else ()):
            assert near is not None
            # The nearest end is the upper one of a region below, or of one that ends soon.
            upper = (near.end[i] > near.speed) == (near.distance[i] < 0.0)
            left = near.end[i] - near.width[i] if upper else near.end[i]
            # A hair's breadth is drawn as one.
            width = max(near.width[i], 2e-3 * near.speed)
            ax.barh(name, width * RPM, left=left * RPM, height=0.5, color="#c05a1f")
        ax.use_sticky_edges = False
        if near is None or not near.region:
            told = "no unstable region in this range" if near else "regions were not looked for"
            words: Any = {"ha": "center", "color": "0.4", "backgroundcolor": "white"}
            ax.text(0.5, 0.5, told, transform=ax.transAxes, **words)
            ax.set_yticks([])
        if near is not None:
            ax.set_xlim(near.window[0] * RPM, near.window[1] * RPM)
        ax.axvline(self.speed * RPM, color="0.2", linestyle="--", linewidth=0.9)
        ax.set(xlabel="crank speed [rpm]; dashed: running speed, bars: unstable regions")
        return ax


def diagnose(scene: Scene, speed: float, *, window: float = 0.3) -> Diagnosis:
    """Return what a machine does at a running speed, what lies near, and what would help.

    Parameters
    ----------
    scene : Scene
        A machine with a flexible link, in a linear formulation.
    speed : float
        Crank speed [rad/s].
    window : float
        Part of the speed within which unstable regions are looked for (:func:`margins`).

    Returns
    -------
    Diagnosis
        Its checks: those of the multipliers, of the steady motion, and of the margins.

    Raises
    ------
    BadInput
        If the scene has no linear system, or an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping": 0.3})
    >>> print(el.design.diagnose(scene, speed=73.3).lines[0])
    smith_1972_5152_sixteenth_inch at 700 rpm is stable: 86 % of a disturbance is left after a turn
    """
    system = scene.linear_system()
    multipliers = floquet_multipliers(system, speed, rtol=1e-9)
    exponents = multipliers.exponents.real
    top = int(np.argmax(exponents))
    growth, error = float(exponents[top]), float(multipliers.error[top] / np.exp(exponents[top]))
    stable = bool(multipliers.stable)
    checks = {f"multipliers: {name}": check for name, check in multipliers.checks.items()}
    near = None
    if fastest_mode(system, speed) <= FASTEST:
        by = numbers_of(scene, system)
        near = margins(scene, speed, by, window=window, changes=False)
        checks |= {f"margins: {name}": check for name, check in near.checks.items()}
    deflection, largest = math.nan, math.nan
    if stable and any(system.has(name) for name in "fhp"):
        deflection, largest, more = _steady(system, speed)
        checks |= more
    lines = [
        _verdict(scene, speed, growth, stable),
        *_nearby(scene, near, system, speed, stable),
        *_motion(scene, system, speed, deflection, largest, stable),
        *_remedies(scene, near),
    ]
    return Diagnosis(
        method="multipliers, steady motion, and margins",
        error=error,
        error_norm="absolute, of the growth per turn",
        checks=checks,
        provenance=provenance(system.provenance),
        speed=float(speed),
        growth=growth,
        stable=stable,
        deflection=deflection,
        largest_stress=largest,
        nearest=near,
        lines=tuple(lines),
    )


def numbers_of(scene: Scene, system: LinearPeriodic) -> tuple[str, ...]:
    """Return the keys of what a machine is made of: numbers that its file gives, not 0."""
    found = []
    for table, values in scene.document.items():
        if table in _NOT_MADE or not hasattr(values, "items"):
            continue
        for key in values:
            value: Any = scene.get(f"{table}.{key}", None)
            if isinstance(value, float) and value != 0.0:
                found.append(f"{table}.{key}")
    return tuple(found)


def _steady(system: LinearPeriodic, speed: float) -> tuple[float, float, dict[str, Check]]:
    """Return the largest steady deflection over the length, the largest stress, and checks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        motion = steady_state(system, speed)
        checks = {f"steady state: {name}": check for name, check in motion.checks.items()}
        # Told in words, not as a failure.
        range_check = checks.pop("steady state: linear range", None)
        deflection = math.nan if range_check is None else range_check.value
        structure = system.structure
        if structure is None or any(b.section.thickness is None for b in structure.beams):
            return deflection, math.nan, checks
        found = stress(system, motion)
    told = {name: check for name, check in found.checks.items() if name != "linear range"}
    checks |= {f"stress: {name}": check for name, check in told.items()}
    return deflection, float(np.max(np.abs(found.bending))), checks


def _verdict(scene: Scene, speed: float, growth: float, stable: bool) -> str:
    at = f"{scene.name} at {speed * RPM:.4g} rpm"
    if not stable:
        return f"{at} is unstable: disturbances grow {math.exp(growth):.3g}-fold in every turn"
    if growth > -_STILL:
        return f"{at} is stable, but nothing damps it: disturbances neither grow nor die out"
    kept = math.exp(growth)
    return f"{at} is stable: {100.0 * kept:.3g} % of a disturbance is left after a turn"


def _nearby(
    scene: Scene, near: Margins | None, system: LinearPeriodic, speed: float, stable: bool
) -> Iterator[str]:
    if near is None:
        turns = fastest_mode(system, speed)
        rest = "regions of so high an order are closed by very little damping"
        if not stable:
            rest = "see elastolink chart for the region that this is"
        told = f"unstable regions were not looked for: a mode turns {turns:.3g} times"
        yield f"{told} per revolution; {rest}"
        return
    low, high = (end * RPM for end in near.window)
    wide = not stable and not np.any(near.distance < 0.0)
    if wide:
        ends = f"elastolink boundaries {scene.name} --speed {low:.5g}:{high:.5g}rpm"
        far = f"reaches far beyond {low:.4g} to {high:.4g} rpm"
        yield f"the region that contains this speed {far}: {ends}"
    elif not near.region:
        yield f"no unstable region wide enough to matter between {low:.4g} and {high:.4g} rpm"
    for i, name in enumerate(near.region):
        end, width = near.end[i] * RPM, near.width[i] * RPM
        side = "above" if near.end[i] > speed else "below"
        held = near.distance[i] < 0.0
        place = "contains this speed and ends" if held else "begins" if side == "above" else "ends"
        far = f"at {end:.5g} rpm, {100.0 * abs(near.distance[i]):.2g} % {side}"
        fed = f"; what feeds it: {near.feeding[i]}" if near.feeding[i] else ""
        yield f"{name} {place} {far}; it is {width:.3g} rpm wide{fed}"
    if near.narrow == 1 and not wide:
        yield "1 more region there is so narrow that any damping closes it"
    if near.narrow > 1:
        yield f"{near.narrow} more regions there are so narrow that any damping closes them"


def _motion(
    scene: Scene,
    system: LinearPeriodic,
    speed: float,
    deflection: float,
    largest: float,
    stable: bool,
) -> Iterator[str]:
    beyond = ""
    if "nonlinear" in system.provenance:
        beyond = f": elastolink response {scene.name} --speed {_about(speed, _AROUND)}"
    if not stable:
        yield f"how large the motion becomes a linear equation does not tell{beyond}"
    if math.isfinite(deflection):
        word = "linear theory holds"
        if deflection > LINEAR_RANGE:
            word = f"more than linear theory bears{beyond}"
        yield f"steady motion: the link bends by {100.0 * deflection:.2g} % of its length; {word}"
    if math.isfinite(largest):
        yield f"largest steady stress: {largest / 1e6:.3g} MPa"


def _about(speed: float, part: float) -> str:
    """Return the range of speeds about one, as commands take it."""
    low, high = ((1.0 + sign * part) * speed * RPM for sign in (-1.0, 1.0))
    return f"{low:.5g}:{high:.5g}rpm"


def _remedies(scene: Scene, near: Margins | None) -> Iterator[str]:
    """Tell the three smallest single changes that move the nearest region away from the speed."""
    if near is None or not near.region:
        return
    held, away = near.distance[0] < 0.0, np.sign(near.end[0] - near.speed)
    # From within, the nearer end has to pass the speed, and go on.
    wanted = abs(near.distance[0]) + 0.01 if held else max(_AWAY - near.distance[0], 0.0)
    if not wanted:
        return
    with np.errstate(divide="ignore"):
        change = (-away if held else away) * wanted / near.shift[0]
    told: list[str] = []
    for m in np.argsort(np.abs(change)).tolist():
        helps = abs(change[m]) <= _LARGEST
        if helps and held:
            helps = _stable(scene, near.by[m], float(change[m]), near.speed)
        if helps and len(told) < 3:
            told.append(f"{near.by[m]} {100.0 * change[m]:+.2g} %")
    goal = "out of it" if held else f"some {100.0 * _AWAY:.0f} % away from it"
    if told:
        span = _about(near.speed, 0.01 if held else _AWAY)
        least = f"elastolink stabilise {scene.name} --speed {span}"
        yield f"{goal} with one of ({least} finds the least): {', '.join(told)}"
    else:
        yield f"no single number brings the machine {goal} by {100.0 * _LARGEST:.0f} % or less"


def _stable(scene: Scene, name: str, change: float, speed: float) -> bool:
    """Return whether a machine with a changed number is stable at a speed."""
    value = scene.get(name) * (1.0 + change)
    try:
        changed = with_numbers(scene, {name: value}).linear_system()
        return bool(floquet_multipliers(changed, speed).stable)
    except BadInput:  # it does not turn
        return False
