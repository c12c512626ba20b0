"""What is linear in the motion of a structure of beams, separated in powers of the crank speed.

At constant speed w a quantity is ``sum_k w^k (q_k q + v_k dq/dtheta + r_k) + a w^2 d2q/dtheta2``
with rows that depend on the crank angle alone: found once, they serve every speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# What a part multiplies, with the power of the speed: the coordinates (q), their derivatives by the
# crank angle (dq, ddq), or one.
Key = tuple[str, int]
RIGID = "1"


@dataclass(frozen=True)
class LinearForm:
    """Rows linear in the coordinates and their derivatives at given crank angles.

    The parts go by what they multiply (``q``, ``dq``, ``ddq`` or ``1``) and the power of the crank
    speed: ``(nt, rows, n)`` each, of ``1`` ``(nt, rows)``.
    """

    parts: Mapping[Key, Array] = field(default_factory=dict)

    def __add__(self, other: LinearForm) -> LinearForm:
        total = dict(self.parts)
        for key, value in other.parts.items():
            total[key] = total[key] + value if key in total else value
        return LinearForm(total)

    def __sub__(self, other: LinearForm) -> LinearForm:
        return self + other.scaled(-1.0)

    def scaled(self, factor: float) -> LinearForm:
        """Return it times a number."""
        return LinearForm({key: value * factor for key, value in self.parts.items()})

    def turned(self, matrix: Array) -> LinearForm:
        """Return a matrix ``(rows, rows)`` or ``(nt, rows, rows)`` times it."""
        found = {}
        for key, value in self.parts.items():
            flat = value[..., None] if key[0] == RIGID else value
            product = np.matmul(matrix, flat)
            found[key] = product[..., 0] if key[0] == RIGID else product
        return LinearForm(found)

    def ordered(self, rows: NDArray[np.int64]) -> LinearForm:
        """Return it with its rows in another order."""
        return LinearForm({key: value[:, rows] for key, value in self.parts.items()})

    def faster(self, power: int) -> LinearForm:
        """Return it times a power of the speed."""
        return LinearForm({(name, k + power): value for (name, k), value in self.parts.items()})

    def eliminated(self, acceleration: LinearForm) -> LinearForm:
        """Return it with ``w^2 d2q/dtheta2`` replaced by a form in the rest."""
        kept = {key: value for key, value in self.parts.items() if key[0] != "ddq"}
        total = LinearForm(kept)
        for (name, power), value in self.parts.items():
            if name == "ddq":
                total = total + acceleration.turned(value).faster(power - 2)
        return total

    def at_speed(self, speed: float) -> dict[str, Array]:
        """Return the rows at one speed, by what they multiply."""
        found: dict[str, Array] = {}
        for (name, power), value in self.parts.items():
            term = value * speed**power
            found[name] = found[name] + term if name in found else term
        return found

    def values(self, speed: float, q: Array, dq: Array, ddq: Array | None = None) -> Array:
        """Return the rows' values ``(nt, rows)`` in a motion, arrays ``(nt, n)`` by angle."""
        given = {"q": q, "dq": dq, "ddq": ddq}
        total: Array = np.zeros(())
        for name, rows in self.at_speed(speed).items():
            vector = given.get(name)
            if name == RIGID:
                total = total + rows
            elif vector is not None:
                total = total + np.matmul(rows, vector[..., None])[..., 0]
        return total


def stacked(forms: list[LinearForm]) -> LinearForm:
    """Return forms below each other; what one lacks is zero."""
    keys = dict.fromkeys(key for form in forms for key in form.parts)
    found = {}
    for key in keys:
        heights = [next(iter(form.parts.values())).shape[1] for form in forms]
        sample = next(form.parts[key] for form in forms if key in form.parts)
        blocks = [
            form.parts.get(key, np.zeros((len(sample), height, *sample.shape[2:])))
            for form, height in zip(forms, heights, strict=True)
        ]
        found[key] = np.concatenate(blocks, axis=1)
    return LinearForm(found)
