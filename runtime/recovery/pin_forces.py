"""Pin forces, ground reactions and driving torque of a structure of beams in a motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from ..beams.assembly import Array
from ..beams.element_forms import ElementForms, required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check
from .beam_forces import Recovered
from .beam_motion import BeamMotion, Motion, beam_motion
from .beam_result import BeamResult, MotionValues, in_motion, over_motion
from .finer_mesh import ROUNDING, with_mesh

_PARTS = ("x", "y", "moment")


@dataclass(frozen=True, kw_only=True)
class PinReactions(BeamResult):
    """Forces at the nodes of a structure of beams, linear in its elastic motion.

    Speed and crank angles: see :class:`BeamResult`.

    Attributes
    ----------
    on_beams : mapping of (str, str) to ndarray
        By node and beam, what the node does to the end of the beam: force along the fixed axes
        [N] and moment [N m], shape ``(nt, 3)``.
    of_ground : mapping of str to ndarray
        By node, what the ground does to it through supports, springs and dampers, likewise; only
        nodes that the ground holds.
    drag : ndarray
        Forces [N] without a counterpart in the structure, such as those of modal damping: what
        they do to the structure, shape ``(nt, 2)``.
    error : float
        Largest error of a force [N], moments over the longest beam's length: by the error of the
        motion and, where it was found on a finer mesh too, by that of the mesh.
    """

    on_beams: Mapping[tuple[str, str], Array]
    of_ground: Mapping[str, Array]
    drag: Array

    arrays_along: ClassVar = {"sample direction": "drag"}

    def arrays(self) -> dict[str, Array]:
        """Return the numeric fields, and the forces by node and beam."""
        found = super().arrays()
        for (node, beam), value in self.on_beams.items():
            found |= {f"{node} on {beam} {p}": value[:, k] for k, p in enumerate(_PARTS)}
        for node, value in self.of_ground.items():
            found |= {f"ground on {node} {p}": value[:, k] for k, p in enumerate(_PARTS)}
        return found

    def _dimensions(self) -> dict[str, tuple[str, ...]]:
        return {**dict.fromkeys(self.arrays(), ("sample",)), **self.dimensions}

    def _own_units(self) -> dict[str, str]:
        forces = (name for name in self.arrays() if " on " in name)
        units = {name: "N m" if name.endswith("moment") else "N" for name in forces}
        return {**units, "drag": "N", "error": "N"}

    def force(self, node: str, beam: str) -> Array:
        """Return the force of a node on a beam [N], ``(nt, 2)``.

        Raises ``BadInput`` if no beam of that name ends at that node.
        """
        if (node, beam) not in self.on_beams:
            known = ", ".join(" on ".join(pair) for pair in self.on_beams)
            raise bad("force", f"{node} on {beam}", f"one of {known}", "correct the names")
        return self.on_beams[node, beam][:, :2]

    def torque(self, node: str = "A") -> Array:
        """Return the moment of the ground on a node [N m], ``(nt,)``: of a crank's shaft the drive.

        Raises ``BadInput`` if the ground does not hold the node.
        """
        if node not in self.of_ground:
            known = ", ".join(self.of_ground)
            raise bad("node", repr(node), f"one that the ground holds: {known}", "choose one")
        return self.of_ground[node][:, 2]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the sizes of the forces of the ground and of the pins over the crank angle."""
        ax = axes_or_new(ax)
        degrees = np.degrees(self.theta)
        for node, value in self.of_ground.items():
            size = np.hypot(value[:, 0], value[:, 1])
            ax.plot(degrees, size, label=f"ground on {node}", linewidth=0.9)
        for (node, beam), value in self.on_beams.items():
            if node not in self.of_ground:
                size = np.hypot(value[:, 0], value[:, 1])
                ax.plot(degrees, size, "--", label=f"{node} on {beam}", linewidth=0.9)
        ax.set(xlabel="crank angle [deg]", ylabel="force [N]")
        ax.legend()
        return ax


def pin_reactions(system: LinearPeriodic, motion: Motion | float | None = None) -> PinReactions:
    """Return the forces at the nodes of a structure of beams, and of its ground.

    They come from the end forces of the elements: stiffness, inertia of the rigid and the elastic
    motion, geometric stiffness, weight.  A crank that is clamped to its shaft is driven by the
    moment of the clamp.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    motion : SteadyState, Trajectory, BeamMotion, float or None
        A computed motion; a crank speed [rad/s], for the steady state there; None for a frame.

    Returns
    -------
    PinReactions
        Its check ``balance`` compares the sum of all forces from outside with the rate of change
        of the momentum, over the largest force: to round-off.  Moments balance only as far as
        forces at displaced places are small of second order: linear equations know no more.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.pin_reactions(system, 20.0)
    >>> print(found.force("B", "coupler").shape, abs(found.torque()).max().round(1))
    (256, 2) 8.5
    """
    moving = beam_motion(system, motion)
    on_beams, of_ground, joined = _forces(system, moving)
    drag, rate = joined["drag "], joined["momentum "]
    total = sum((value[:, :2] for value in of_ground.values()), np.zeros_like(drag))
    largest = max(float(np.max(np.abs(v[:, :2]))) for v in on_beams.values())
    gap = float(np.max(np.abs(total + drag - rate)))
    # Round-off of the balance, over the largest end force of an element.
    checks = {"balance": Check(gap / largest if largest else gap, 1e-9)}
    doubt = partial(_doubt, system, moving, on_beams)
    return PinReactions(
        method="end forces of the elements",
        on_beams=on_beams,
        of_ground=of_ground,
        drag=drag,
        **in_motion(system, moving, doubt, checks),
    )


def _forces(
    system: LinearPeriodic, motion: BeamMotion
) -> tuple[dict[tuple[str, str], Array], dict[str, Array], dict[str, Array]]:
    """Return forces by node and beam, of the ground by node, and all of them with the sums."""
    joined = over_motion(system, motion, _at_nodes)
    structure = required_structure(system)
    on_beams = {
        (node.name, beam.name): joined[f"{node.name} {beam.name}"]
        for node in structure.nodes
        for beam in structure.beams
        if node.name in (beam.start, beam.end)
    }
    of_ground = {node.name: joined[node.name] for node in structure.nodes if node.name in joined}
    return on_beams, of_ground, joined


def _at_nodes(forms: ElementForms, values: MotionValues) -> dict[str, Array]:
    """Return forces by node and beam, of the ground by node, drag and rate of momentum."""
    structure, places, outside = forms.structure, forms.structure.freedoms.places, forms.outside
    found: dict[str, Array] = {}
    share = forms.factor["distributed_mass"]
    mass = forms.factor["lumped_mass"] * forms.lumped
    lumped = np.broadcast_to(
        values(forms.node_inertia() - forms.node_loads()), (len(forms.theta), forms.arrays.count)
    )
    resisted = lumped.copy()
    # What drag from outside takes is counted among the inertia.
    momentum, drag = np.zeros((2, len(forms.theta), 2))
    for element in forms.elements:
        placed = element.placed
        fixed = values(element.end_forces().turned(element.fixed))
        resisted[:, placed.indices] += fixed
        momentum += fixed[:, [0, 1]] + fixed[:, [3, 4]]
        if outside.parts:
            inertia = element.fixed @ (share * element.arrays.mass) @ element.own
            taken = values(outside.turned(inertia))
            drag -= taken[:, [0, 1]] + taken[:, [3, 4]]
        if placed.number == 0:
            found[f"{placed.beam.start} {placed.beam.name}"] = fixed[:, :3]
        if placed.number == len(placed.beam.places) - 2:
            found[f"{placed.beam.end} {placed.beam.name}"] = fixed[:, 3:6]
    taken = values(outside.turned(mass[:, None] * forms.spread))
    for node in structure.nodes:
        x, y = (places[node.name, part] for part in ("x", "y"))
        momentum += lumped[:, [x, y]]
        if outside.parts:
            drag -= taken[:, [x, y]]
        if node.held or node.stiffness or node.damping:
            meeting = (b.name for b in structure.beams if node.name in (b.start, b.end))
            turning = {places[node.name, name] for name in meeting}
            moments = sum(resisted[:, place] for place in turning)
            found[node.name] = np.stack([resisted[:, x], resisted[:, y], moments], axis=-1)
    return found | {"drag ": drag, "momentum ": momentum + drag}


def _doubt(
    system: LinearPeriodic, motion: BeamMotion, on_beams: Mapping[tuple[str, str], Array]
) -> dict[str, float | str]:
    longest = max(beam.length for beam in required_structure(system).beams)
    scale = np.array([1.0, 1.0, 1.0 / longest])
    own = np.stack(list(on_beams.values())) * scale
    axial, shear, moment = Recovered(system, motion, 2, "shape").propagated()
    by_motion = float(np.hypot(axial, shear) + moment / longest)

    def change(finer: LinearPeriodic, motion: BeamMotion) -> float:
        better = np.stack(list(_forces(finer, motion)[0].values())) * scale
        return float(np.max(np.linalg.norm(better - own, axis=-1)))

    norm = "largest error of a force [N]; of a moment, over the longest beam's length"
    rounding = ROUNDING * float(np.max(np.abs(own)))
    return with_mesh(system, motion, norm, by_motion + rounding, change)
