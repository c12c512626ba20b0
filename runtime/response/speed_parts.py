"""A system's equation in parts, one for each power of the crank speed, kept with the system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..periodic.equation import SPEED_POWER
from ..periodic.first_order import CanonicalForm
from ..simulation.second_order import keep, second_order

Array = NDArray[np.float64]

# Place of F among the arrays.
_FORCE = 3
# Digits to which a factor is told apart, after the speed has been divided out of it.
_DIGITS = 13


@dataclass(frozen=True)
class SpeedParts:
    """Parts of ``M q'' + G q' + H q = F`` at even angles.

    Attributes
    ----------
    arrays : mapping of (int, int) to ndarray
        By place and power of the speed that they are multiplied by: H (0), G (1), M (2),
        ``(nt, n, n)``, and F (3), ``(nt, n)``; nt is 1 where constant.
    key : tuple
        What they depend on beside the system: the number of angles, the parameters.
    """

    arrays: Mapping[tuple[int, int], Array]
    key: tuple[object, ...]

    def at(self, speed: float, count: int) -> tuple[Array, Array]:
        """Return H, G, M side by side ``(nt, n, 3n)``, and F ``(nt, n)``, at a speed [rad/s]."""
        n = next(iter(self.arrays.values())).shape[1]
        stacked, force = np.zeros((count, n, 3 * n)), np.zeros((count, n))
        for (place, power), part in self.arrays.items():
            target = force if place == _FORCE else stacked[:, :, place * n : (place + 1) * n]
            target += speed**power * part
        return stacked, force


def speed_parts(form: CanonicalForm, count: int) -> SpeedParts:
    """Return the parts of the first of a batch at even angles.

    Parameters
    ----------
    form : CanonicalForm
        Its terms.
    count : int
        Number of angles.
    """
    system, speed = form.system, float(form.speed[0])
    powers = [SPEED_POWER.get(term.array, 0) + term.power for term in system.terms]
    plain = [float(row[0]) / speed**e for row, e in zip(form.factors, powers, strict=True)]
    told = [float(f"{value:.{_DIGITS}g}") for value in plain]
    key = ("speed parts", count, *told)
    used = tuple(sorted({e for e, value in zip(powers, told, strict=True) if value != 0.0}))
    known = system.kept.get(key)
    if known is None:
        before = set(system.kept)
        known = tuple(part for e in used for part in _parts(form, told, powers, e, count))
        # The samples of the terms one by one are not needed again.
        for name in set(system.kept) - before:
            del system.kept[name]
        keep(system, key, known)
    names = ((place, e) for e in used for place in range(_FORCE + 1))
    return SpeedParts({k: a for k, a in zip(names, known, strict=True) if a.size}, key)


def _parts(
    form: CanonicalForm, plain: list[float], powers: list[int], power: int, count: int
) -> tuple[Array, ...]:
    """Return H, G, M, F of the terms of one power of the speed; empty what is not there."""
    own = [value if e == power else 0.0 for value, e in zip(plain, powers, strict=True)]
    found = second_order(
        replace(form, speed=form.speed[:1], factors=np.array(own)[:, None], batch=(1,)), count
    )
    arrays = (found.stiffness[0], found.rate[0], found.mass[0], found.force[0])
    return tuple(a if np.any(a) else np.zeros(0) for a in arrays)
