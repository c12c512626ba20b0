"""The flexible rod of a quick-return mechanism: from a scene to its system."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...core.errors import bad
from ...core.families import Constrained, LinearPeriodic
from ..modal_damping import with_modal_damping
from .basis import MovingBasis

if TYPE_CHECKING:
    from ...scenes import Scene


def rod_of_scene(scene: Scene) -> LinearPeriodic | Constrained:
    """Return the rod of a scene in the formulation that it names.

    Parameters
    ----------
    scene : Scene
        With mechanism ``quick_return`` and flexible ``rod``.  ``model.formulation`` is
        ``overhang``, ``polynomial``, ``two_segment`` or ``free_free_linear``, linear on a moving
        basis, or ``free_free``, nonlinear with constraints.

    Raises
    ------
    BadInput
        If the crank cannot turn fully, a module was not emitted, or ``free_free`` is asked for
        with damping or without a speed.
    """
    scene.mechanism().require_full_turn()
    return _constrained(scene) if scene.model["formulation"] == "free_free" else _linear(scene)


def moving_basis(formulation: str, modes: int) -> MovingBasis:
    """Return the basis that a linear formulation is named after.

    Parameters
    ----------
    formulation : {"overhang", "polynomial", "two_segment", "free_free_linear"}
        As in a scene.
    modes : int
        How many functions.
    """
    if formulation == "overhang":
        from .overhang import OverhangBasis

        return OverhangBasis(modes)
    if formulation == "polynomial":
        from .polynomial import PolynomialBasis

        return PolynomialBasis(modes)
    if formulation == "two_segment":
        from .two_segment import TwoSegmentBasis

        return TwoSegmentBasis(modes)
    if formulation == "free_free_linear":
        from .free_free import FreeFreeBasis

        return FreeFreeBasis(modes)
    known = ["overhang", "polynomial", "two_segment", "free_free_linear"]
    raise bad("formulation", repr(formulation), f"one of {known}", "choose one")


def _shared(scene: Scene) -> dict[str, float]:
    links, rod = scene["links"], scene["rod"]
    return {
        "crank_ratio": links["crank"] / links["frame"],
        "frame": links["frame"],
        "length": links["rod"],
        "bending_stiffness": rod["bending_stiffness"],
        "mass_per_length": rod["mass_per_length"],
    }


def _linear(scene: Scene) -> LinearPeriodic:
    from .linear import rod_system

    rod, numbers = scene["rod"], _shared(scene)
    damping = rod["damping"]
    internal = rod["relaxation_time"] * rod["bending_stiffness"]
    ratio, law = rod["damping_ratio"], rod["damping_law"]
    if ratio and law != "modal":
        first = first_frequency(
            numbers["frame"] / numbers["length"],
            length=numbers["length"],
            bending_stiffness=numbers["bending_stiffness"],
            mass_per_length=numbers["mass_per_length"],
        )
        if law == "viscous":
            damping = 2.0 * ratio * first * rod["mass_per_length"]
        else:
            internal = 2.0 * ratio / first * rod["bending_stiffness"]
    system = rod_system(
        moving_basis(scene.model["formulation"], int(scene.model["modes"])),
        **numbers,
        damping=damping,
        internal_damping=internal,
        drop=tuple(scene.model["drop"]),
        provenance={"scene": scene.name, "scene_digest": scene.digest()},
    )
    return with_modal_damping(system, ratio) if ratio and law == "modal" else system


def first_frequency(
    place: float, *, length: float, bending_stiffness: float, mass_per_length: float
) -> float:
    """Return the first natural frequency [rad/s] of the rod at rest with the block at a place.

    Parameters
    ----------
    place : float
        Distance of the block from the rod's pivot over the rod's length.
    length : float
        Of the rod [m].
    bending_stiffness : float
        EI [N m^2].
    mass_per_length : float
        [kg/m].
    """
    import numpy as np

    from .overhang import overhang_roots

    root = float(overhang_roots(np.array([place]), 1)[0, 0])
    return (root / length) ** 2 * math.sqrt(bending_stiffness / mass_per_length)


def _constrained(scene: Scene) -> Constrained:
    from .constrained import free_free_rod

    rod = scene["rod"]
    damped = [key for key in ("damping", "relaxation_time", "damping_ratio") if rod[key]]
    if damped:
        raise bad(
            f"rod.{damped[0]}",
            f"{rod[damped[0]]:g}",
            "0 with formulation 'free_free', which has no damping",
            "leave it out, or use formulation 'free_free_linear'",
        )
    speed = scene.get("operation.speed", None)
    if speed is None:
        fix = "add it: the constrained equations hold at one crank speed"
        raise bad("operation.speed", "nothing", "the crank speed, such as '100 rad/s'", fix)
    return free_free_rod(
        int(scene.model["modes"]),
        **_shared(scene),
        speed=speed,
        drop=tuple(scene.model["drop"]),
        provenance={"scene": scene.name, "scene_digest": scene.digest()},
    )
