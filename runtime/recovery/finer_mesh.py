"""The same structure in the same motion on a finer mesh: how far the given mesh has it wrong.

What counts as true is the beams' own model, the mesh refined without end, with the same law of
damping: of modal damping the same ratio in every mode of the finer mesh too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..beams.assembly import Array
from ..beams.structure import Beam, Structure
from ..core.errors import BadInput
from ..core.families import LinearPeriodic
from ..core.trigonometric import differentiated, even_angles
from .beam_motion import BeamMotion, standing

# The finer mesh is not the last one: where a resonance is near both may be off to one side.
CAUTION = 3.0
# Round-off of stiff structures, over the largest value.
ROUNDING = 1e-10
_KEPT = "steady state on a finer mesh"


def finer_structure(structure: Structure) -> Structure:
    """Return the structure with more elements: a third more, two at least.

    A single cubic becomes two quintics: of two cubics the lowest modes are still too far off.
    More elements, and not only better ones, as the axial displacement is linear in all of them.
    """
    return replace(structure, beams=tuple(_finer(beam) for beam in structure.beams))


def _finer(beam: Beam) -> Beam:
    if isinstance(beam.elements, tuple) and len(beam.elements) > 1:
        return replace(beam, elements=tuple(0.5 * x for x in beam.elements for _ in range(2)))
    count = beam.elements if isinstance(beam.elements, int) else 1
    kind = "internal_node" if count == 1 and beam.kind == "cubic" else beam.kind
    return replace(beam, kind=kind, elements=count + (count + 2) // 3)


def finer_system(system: LinearPeriodic) -> LinearPeriodic | None:
    """Return the same system on a finer mesh; None where its terms tell no other mesh."""
    if system.remesh is None or not system.has_terms_of(system.remesh(lambda same: same)):
        return None
    try:
        return system.remeshed(finer_structure)
    except (BadInput, ValueError):
        # Terms of this mesh alone were added to the system.
        return None


def on_finer_mesh(
    system: LinearPeriodic, motion: BeamMotion
) -> tuple[LinearPeriodic, BeamMotion] | None:
    """Return the system on a finer mesh, and its motion at the same angles.

    None where the motion is neither a computed steady state nor a standing equilibrium, or the
    system tells no other mesh.
    """
    still = system.structure is not None and not system.structure.moving
    if not still and motion.solved is None:
        return None
    finer = finer_system(system)
    if finer is None:
        return None
    if still:
        return finer, standing(finer, None)
    # The steady state of the last speed is kept.
    kept = system.kept.get(_KEPT)
    if kept is None or kept[0][0] != motion.speed or len(kept[1]) != len(motion.theta):
        found = solved(finer, motion.speed, intervals_for(motion.q), len(motion.theta))
        kept = system.kept[_KEPT] = (np.array([motion.speed]), *found)
    return finer, BeamMotion(
        theta=motion.theta, q=kept[1], qd=kept[2], speed=motion.speed, period=motion.period
    )


def with_mesh(
    system: LinearPeriodic,
    motion: BeamMotion,
    norm: str,
    error: float,
    change: Callable[[LinearPeriodic, BeamMotion], float],
) -> dict[str, float | str]:
    """Return an error estimate and its norm, with what a finer mesh changes where there is one."""
    finer = on_finer_mesh(system, motion)
    if finer is None:
        return {"error": error, "error_norm": f"{norm}, by that of the motion; the mesh apart"}
    return {"error": error + CAUTION * change(*finer), "error_norm": norm}


def intervals_for(q: Array) -> int:
    """Return how many intervals of collocation follow a periodic motion ``(nt, n)``: 8 or more.

    One of order 15 for each harmonic whose amplitude is a thousandth of a coordinate's peak or
    more: what they miss is a thousandth of a coordinate or less.
    """
    amplitude = np.abs(np.fft.rfft(q, axis=0))
    largest = np.max(amplitude, axis=0)
    seen = np.max(amplitude / np.where(largest > 0.0, largest, 1.0), axis=1) > 1e-3
    return max(8, int(np.max(np.flatnonzero(seen), initial=1)))


def solved(system: LinearPeriodic, speed: float, intervals: int, count: int) -> tuple[Array, Array]:
    """Return q and qd ``(count, n)`` of the steady state at even angles, on so many intervals."""
    # Loaded here: only this error estimate of the beams needs motions.
    from ..periodic.equation import equation_of
    from ..periodic.periodic_motion import ring_motion
    from ..periodic.transition import method

    equation = equation_of(system, speed, {}, forcing=True)
    q = answered(system, speed, ring_motion(method("radau", 8), count, equation, intervals)[0][0])
    return q, speed * differentiated(q, system.period)


def answered(system: LinearPeriodic, speed: float, q: Array) -> Array:
    """Return a periodic motion ``(nt, n)`` with what it leaves of the equation answered statically.

    A displacement that is wrong by a millionth, across the beams, may stretch them by far more
    than they are: stiff directions are taken from the forces instead.
    """
    from ..periodic.truncation import arrays_at, unmet_forces

    theta, speeds = even_angles(system.period, len(q)), np.array([speed])
    rest = unmet_forces(arrays_at(system, theta), system.period, q[..., None], speeds)
    stiffness = system.array("K", theta) + system.array("Kg", theta, speed)
    return np.asarray(q + np.linalg.solve(stiffness, rest)[..., 0])
