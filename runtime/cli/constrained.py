"""``elastolink simulate`` and ``stability`` of scenes whose equations are constrained."""

from __future__ import annotations

import argparse
from math import pi
from typing import TYPE_CHECKING

from ..core.errors import bad
from . import options as opt

if TYPE_CHECKING:
    from ..constrained.multipliers import ConstrainedMultipliers
    from ..constrained.orbits import PeriodicOrbit
    from ..scenes import Scene
    from ..systems.rod import FreeFreeRod


def is_constrained(scene: Scene) -> bool:
    """Return True where the scene's formulation leads to a constrained system."""
    return bool(scene.model["formulation"] == "free_free")


def at_speed(options: argparse.Namespace, scene: Scene) -> FreeFreeRod:
    """Return the scene's system at the one crank speed of the option or of the scene."""
    from .linkages import speed_of

    if options.speed is not None and ":" in options.speed:
        fix = "give one, or use formulation 'free_free_linear'"
        raise bad(
            "--speed", repr(options.speed), "one speed: each has its own periodic motion", fix
        )
    moved = opt.load(options, **{"operation.speed": speed_of(options, scene)})
    system: FreeFreeRod = moved.system()  # type: ignore[assignment]
    return system


def stability(options: argparse.Namespace, scene: Scene) -> int:
    """Find the periodic motion by shooting, and the multipliers about it."""
    from ..constrained import orbit_multipliers, periodic_orbit

    orbit = periodic_orbit(at_speed(options, scene))
    if not orbit.converged:
        return opt.finish(options, orbit, [f"no periodic motion: {orbit.message}"])
    result = orbit_multipliers(orbit)
    lines = [
        *opt.multipliers("physical multiplier", result.physical),
        "",
        f"{_verdict(orbit, result)}; largest deflection {orbit.deflection:.3g} of the "
        f"length; {len(result.others)} more multipliers belong to the constraints and are 1",
    ]
    return opt.finish(options, result, lines, beside=(orbit,))


def _verdict(orbit: PeriodicOrbit, found: ConstrainedMultipliers) -> str:
    """Return the verdict, and whether the equations hold where it was found."""
    told = ("stable" if found.stable else "unstable") + " about the periodic motion"
    reached = orbit.checks["linear range"]
    if not orbit.checks["accuracy"].passed:
        return f"not known: the periodic motion is known to {orbit.error:.2g} only"
    if not reached.passed:
        return (
            f"no verdict on the rod: the motion leaves the linear range, {reached.limit:g} of the "
            f"length, where the equations hold; by them it is {told}"
        )
    return told


def simulate(options: argparse.Namespace, scene: Scene) -> int:
    """Integrate the constrained equations from the undeformed rod."""
    from ..constrained import constrained_motion

    if options.initial is not None:
        fix = "leave it out: the motion starts from the undeformed rod"
        raise bad("--initial", "a value", "none for constrained equations", fix)
    if options.method not in (None, "collocation"):
        raise bad("--method", repr(options.method), "collocation alone", "leave it out")
    rod = at_speed(options, scene)
    result = constrained_motion(
        rod,
        span=options.revolutions * (2.0 * pi / abs(rod.speed)),
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
