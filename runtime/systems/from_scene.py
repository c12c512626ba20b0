"""From scenes to systems: the coupler of a four-bar, Hill's equation, the rod of a quick-return."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.errors import bad
from ..core.families import Array, Constrained, LinearPeriodic
from ..core.families.modal_damping import with_modal_damping
from ..core.modules import find_module
from ..core.periodic_function import PeriodicFunction
from .assembly import assemble

if TYPE_CHECKING:
    from ..scenes import Scene


# As in the tables of a scene; a first moment may have either sign.
COUPLER_LIMITS = {
    **dict.fromkeys(("bending_stiffness", "mass_per_length"), "positive"),
    **dict.fromkeys(("damping", "coupler_inertia", "follower_inertia"), "non-negative"),
}


def coupler_system(scene: Scene) -> LinearPeriodic:
    """Return the transverse vibration of the coupler (Smith 6.6, corrected; 6.17; 6.18).

    The coordinates are ``Y_m / l3``; the parameters are those of the emitted module.
    """
    linkage = scene.mechanism()
    linkage.require_full_turn()
    emitted = find_module(scene.model_spec())
    modes = int(scene.model["modes"])
    return assemble(
        emitted.module,
        geometry={**linkage.lengths, "assembly": linkage.branch},
        parameters=coupler_parameters(scene),
        modes=modes,
        labels=tuple(f"Y{m}/l3" for m in range(1, modes + 1)),
        limits=COUPLER_LIMITS,
        reference_length=linkage.lengths["coupler"],
        shape=partial(_pinned_modes, modes),
        provenance={**origin(scene), **emitted.provenance, "nonlinear": "inextensible"},
    )


def coupler_parameters(scene: Scene) -> dict[str, Any]:
    """Return the inertial and elastic parameters of a coupler, those of the emitted module."""
    coupler = scene["coupler"]
    return {
        **{name: coupler[name] for name in ("bending_stiffness", "mass_per_length", "damping")},
        "coupler_inertia": coupler["inertia"],
        "coupler_first_moment": coupler["first_moment"],
        "follower_inertia": scene["follower"]["inertia"],
    }


def _pinned_modes(modes: int, x: Array) -> Array:
    """Return mode shapes ``sin(m pi x / l)`` of a pinned beam at x over length, ``(nx, modes)``."""
    m = np.arange(1, modes + 1)
    return np.asarray(np.sin(np.pi * np.multiply.outer(np.asarray(x, dtype=float), m)))


def hill_system(scene: Scene) -> LinearPeriodic:
    """Return ``y'' + 2 K y' + (lam2 + mu f) y = 0`` (Smith 7.38); the speed that suits it is 1."""
    emitted = find_module(scene.model_spec())
    return assemble(
        emitted.module,
        geometry={},
        parameters=dict(scene["parameters"]),
        external={"f": fourier_series(scene)},
        limits={"damping": "non-negative"},
        labels=("y",),
        provenance={**origin(scene), **emitted.provenance},
    )


def fourier_series(scene: Scene) -> PeriodicFunction:
    """Return the function f of a scene of Hill's equation."""
    return PeriodicFunction(a=scene["function"]["a"], b=scene["function"]["b"])


def rod_of_scene(scene: Scene) -> LinearPeriodic | Constrained:
    """Return the rod of a scene in the formulation that it names.

    Linear on a moving basis, or nonlinear with constraints (``free_free``), which has no damping
    and wants a speed.
    """
    scene.mechanism().require_full_turn()
    links, rod = scene["links"], scene["rod"]
    given = {
        "crank_ratio": links["crank"] / links["frame"],
        "frame": links["frame"],
        "length": links["rod"],
        "bending_stiffness": rod["bending_stiffness"],
        "mass_per_length": rod["mass_per_length"],
        "drop": tuple(scene.model["drop"]),
        "provenance": origin(scene),
    }
    free_free = scene.model["formulation"] == "free_free"
    return _floating_rod(scene, given) if free_free else _linear_rod(scene, given)


def _linear_rod(scene: Scene, given: dict[str, Any]) -> LinearPeriodic:
    from .rod.linear import rod_system

    rod = scene["rod"]
    damping = rod["damping"]
    internal = rod["relaxation_time"] * rod["bending_stiffness"]
    ratio, law = rod["damping_ratio"], rod["damping_law"]
    if ratio and law != "modal":
        from .rod.overhang import OverhangBasis

        # The first natural frequency [rad/s] of the rod held still at the base length.
        still = {name: given[name] for name in ("length", "bending_stiffness", "mass_per_length")}
        found = OverhangBasis(1).frequencies(given["frame"] / given["length"], **still)
        first = float(found.frequencies[0, 0])
        if law == "viscous":
            damping = 2.0 * ratio * first * rod["mass_per_length"]
        else:
            internal = 2.0 * ratio / first * rod["bending_stiffness"]
    basis, modes = scene.model["formulation"].removesuffix("_linear"), int(scene.model["modes"])
    system = rod_system(basis, modes, **given, damping=damping, internal_damping=internal)
    return with_modal_damping(system, ratio) if ratio and law == "modal" else system


def _floating_rod(scene: Scene, given: dict[str, Any]) -> Constrained:
    from .rod.floating import free_free_rod

    rod = scene["rod"]
    damped = [key for key in ("damping", "relaxation_time", "damping_ratio") if rod[key]]
    if damped:
        expected = "0 with formulation 'free_free', which has no damping"
        fix = "leave it out, or use formulation 'free_free_linear'"
        raise bad(f"rod.{damped[0]}", f"{rod[damped[0]]:g}", expected, fix)
    speed = scene.get("operation.speed", None)
    if speed is None:
        fix = "add it: the constrained equations hold at one crank speed"
        raise bad("operation.speed", "nothing", "the crank speed, such as '100 rad/s'", fix)
    return free_free_rod(int(scene.model["modes"]), **given, speed=speed)


def origin(scene: Scene) -> dict[str, str]:
    """Return what results of a scene say of it."""
    return {"scene": scene.name, "scene_digest": scene.digest()}


def pull_of_gravity(scene: Scene) -> tuple[float, float]:
    """Return the acceleration of free fall [m/s^2] along x and y; 0 where the machine lies flat."""
    gravity = scene["gravity"]
    if "direction" not in gravity:
        return 0.0, 0.0
    size, direction = gravity["acceleration"], gravity["direction"]
    return size * math.cos(direction), size * math.sin(direction)
