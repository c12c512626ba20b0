"""Aannaque's Fig. 3.11: input link, coupler and follower cut free, with their forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import degrees, pi, radians
from typing import TYPE_CHECKING

import numpy as np

from ..scenes import load_scene
from .aannaque_kinematics import SCENE
from .free_bodies import Body, draw_body, free_bodies, round_force, scale_bar
from .records import Drawn, Quoted, Table
from .sketches import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_INPUT = radians(105.0)
_BALANCE = 1e-11
# Letters of the joints and the centre, and the names of what acts there.
_NAMES = {
    "crank": (
        "OAG",
        {"O": "$F_{01}$", "A": "$F_{21}$", "G": "$F_{1}$", "torque": "$C$"},
    ),
    "coupler": (
        "ABG",
        {"A": "$F_{12}$", "B": "$F_{32}$", "G": "$F_{2}$", "couple": r"$-J_2\alpha_2$"},
    ),
    "follower": (
        "CBG",
        {"C": "$F_{03}$", "B": "$F_{23}$", "G": "$F_{3}$", "couple": r"$-J_3\alpha_3$"},
    ),
}
_PARTS = {"crank": "input link", "coupler": "coupler", "follower": "follower"}


def body_figure(link: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws one link cut free (Fig. 3.11)."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        scene = load_scene(SCENE)
        machine, speed = scene.machine(), scene["operation"]["speed"]
        body = free_bodies(machine, _INPUT, speed)[0][link]
        letters, names = _NAMES[link]
        largest = max(float(np.hypot(*force)) for force in body.forces)
        length = float(np.hypot(*(body.places[1] - body.places[0])))
        scale = 0.55 * length / largest
        canvas(ax)
        draw_body(ax, body, letters, names, scale)
        heads = np.array(body.places) + scale * np.array(body.forces)
        low = np.min([*body.places, *heads], axis=0) - 0.22 * length
        scale_bar(ax, low, scale, round_force(largest))
        turn = np.linspace(0.0, 2.0 * pi, 361)
        cycle = free_bodies(machine, turn, speed)[0][link]
        note = (
            f"Drawn at the input angle {degrees(_INPUT):g} deg and {speed:g} rad/s, which the "
            "figure does not state; forces to scale, couples in sense only. The inertia forces "
            "act at the centres of mass. Joints have no mass of their own in Table 3.2."
        )
        return Drawn(tuple(_rows(link, cycle)), (note,), (_table(body, letters, names),))

    return draw


def _rows(link: str, cycle: Body) -> list[Quoted]:
    part = _PARTS[link]
    meaning = "round-off; closed form against the accelerations of the centre, over a whole turn"
    rows = [
        Quoted(
            f"sum of the forces on the {part}, over the largest",
            0.0,
            cycle.unbalanced_force,
            _BALANCE,
            meaning,
            "3.7",
        ),
        Quoted(
            f"sum of the moments on the {part} about its centre, over the largest term",
            0.0,
            cycle.unbalanced_moment,
            _BALANCE,
            meaning,
            "3.7",
        ),
    ]
    if link == "crank":
        rows.append(
            Quoted(
                "least torque over the cycle",
                0.0,
                float(np.min(cycle.torque)),
                0.0,
                "'can even become negative'",
                "3.7",
                relation="<",
                unit="N m",
            )
        )
    return rows


def _table(body: Body, letters: str, names: dict[str, str]) -> Table:
    rows = [
        (
            names[letter].replace("$", "").replace("{", "").replace("}", ""),
            f"{force[0]:.4f}",
            f"{force[1]:.4f}",
            f"{float(np.hypot(*force)):.4f}",
        )
        for letter, force in zip(letters, body.forces, strict=True)
    ]
    return Table("Forces at this angle [N]", ("force", "x", "y", "size"), tuple(rows))
