"""Forces by another route: multipliers of Lagrange's equations with a constraint for each joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from inspect import signature
from typing import Any

import numpy as np

from .blocks import Array
from .force_modules import MECHANISMS
from .machine import Machine

# What sines, cosines, products and the elimination are off by, at least.
_LEAST = 16.0 * float(np.finfo(float).eps)


def multipliers(
    machine: Machine, theta: Array, speed: Array, acceleration: Array
) -> tuple[dict[str, Array], Array]:
    """Return joint forces and torque as multipliers of Lagrange's equations (Smith 4.4-4.6).

    Each link moves freely; what holds the joints together, and the drive to its course, are the
    multipliers: the equations are solved as a whole, without the closed forms.

    Parameters
    ----------
    machine : Machine
        The machine.
    theta, speed, acceleration : ndarray, shape (n,)
        Crank angle [rad], speed [rad/s], acceleration [rad/s^2].

    Returns
    -------
    values : dict of str to ndarray, shape (n,)
        ``x12`` ... ``y41`` and the couple of a sliding joint, and ``torque``.
    error : ndarray, shape (n,)
        By how much the worst of them may be off [N], couples over the longest link, from the error
        figure of the angles and the round-off of the solution; not finite where there is none.
    """
    name = MECHANISMS[type(machine.linkage).__name__]
    module = _module(name)
    motion = machine.linkage.motion(theta, speed, acceleration)
    numbers = _numbers(machine, motion, speed)
    numbers |= {"drive": theta, "drive_d1": speed, "drive_d2": acceleration}
    turned = [not item.startswith(("x", "y", "normal")) for item in module.MULTIPLIERS]
    longest = max(abs(size) for size in machine.linkage.lengths.values())
    solver = _Solver(module, turned, longest, np.maximum(motion.error, _LEAST))
    with np.errstate(all="ignore"):
        solved, error = solver.solve(numbers)
    found = dict(zip(module.MULTIPLIERS, solved.T, strict=True))
    # Along its guide a slide holds nothing; its multiplier is the force across.
    if "normal41" in found:
        normal = found.pop("normal41")
        found |= {"x41": np.zeros_like(normal), "y41": normal}
    if "normal34" in found:
        normal, angle = found.pop("normal34"), motion.link("rod").angle
        found |= {"x34": -normal * np.sin(angle), "y34": normal * np.cos(angle)}
        error = error + np.maximum(motion.error, _LEAST) * np.abs(normal)
    return found, error


@lru_cache(maxsize=3)
def _module(mechanism: str) -> Any:
    from ...derive.spec import ModelSpec
    from ..core.modules import find_module

    return find_module(ModelSpec(mechanism, "multibody")).module


def _numbers(machine: Machine, motion: Any, speed: Array) -> dict[str, Any]:
    """Return places, speeds, masses and wrenches of the links, as the emitted function calls them.

    Lengths and masses that an argument does not name are left out by the caller.
    """
    numbers: dict[str, Any] = {**machine.linkage.lengths, "t": 0.0}
    acting = machine.wrenches(motion, speed)
    for n, link in enumerate(machine.linkage.links, start=2):
        moving, mass = motion.link(link), machine.mass(link)
        places = (*np.moveaxis(moving.origin, -1, 0), moving.angle)
        rates = (*np.moveaxis(moving.velocity, -1, 0), moving.speed)
        for axis, place, rate in zip(("x", "y", "angle"), places, rates, strict=True):
            numbers |= {f"{axis}{n}": place, f"{axis}{n}_dot": rate}
        for part in ("mass", "along", "across", "inertia"):
            numbers[f"{part}{n}"] = getattr(mass, part)
        wrench = acting.get(link, (0.0, 0.0, 0.0))
        numbers |= {f"{p}{n}": w for p, w in zip(("fx", "fy", "couple"), wrench, strict=True)}
    return numbers


class _Solver:
    """The equations at n places, in units in which angles and places are comparable.

    The constraints hold every coordinate, that of the drive among them: they give the speeds and
    the accelerations, and these the multipliers, for links without a mass as well.

    Parameters
    ----------
    module : module
        Emitted.
    turned : sequence of bool
        Which of the multipliers are couples: their constraints hold angles.
    longest : float
        Longest link [m].
    blur : ndarray, shape (n,)
        By how much the angles, and sines and cosines, may be off.
    """

    def __init__(self, module: Any, turned: Sequence[bool], longest: float, blur: Array) -> None:
        self.module, self.longest, self.blur = module, longest, blur[:, np.newaxis]
        self.angles = np.arange(9) % 3 == 2
        self.columns = np.where(self.angles, 1.0 / longest, 1.0)
        self.rows = np.where(turned, longest, 1.0)

    def solve(self, numbers: dict[str, Any]) -> tuple[Array, Array]:
        """Return the multipliers, shape (n, multipliers), and their error [N], shape (n,)."""
        first = self._filled(numbers)
        jacobian = first["jacobian"] * self.rows[:, np.newaxis] * self.columns
        try:
            inverse = np.asarray(np.linalg.inv(jacobian), dtype=float)
        except np.linalg.LinAlgError:  # some place is singular to the last digit
            none = np.zeros(jacobian.shape[:2])
            return none, np.full(none.shape[:1], np.inf)
        rates = _times(inverse, first["velocity_rhs"][..., 0] * self.rows)
        for place, name in enumerate(self.module.COORDINATES):
            numbers[f"{name}_dot"] = rates[:, place] * self.columns[place]
        filled = self._filled(numbers)
        gamma = filled["gamma"][..., 0] * self.rows
        mass = filled["mass"] * self.columns[:, np.newaxis] * self.columns
        rest, forces = (filled[name][..., 0] * self.columns for name in ("rest", "forces"))
        changes = _times(inverse, gamma)
        solution = _times(np.swapaxes(inverse, 1, 2), _times(mass, changes) + rest - forces)
        # To first order, without regard to signs.
        away, held, heavy = np.abs(inverse), self._widened(jacobian), self._widened(mass)
        spin = np.max(np.abs(rates[:, self.angles]), axis=1, keepdims=True) / self.longest
        off = _times(away, self.blur * _times(held, np.abs(rates)))
        spin_off = np.max(off[:, self.angles], axis=1, keepdims=True) / self.longest
        bent = _times(held, np.abs(rates)) * (self.blur * spin + spin_off)
        bent += _times(held, off) * spin + self.blur * np.abs(gamma)
        off = _times(away, self.blur * _times(held, np.abs(changes)) + bent)
        thrown = np.abs(rates) * self.angles * (self.blur * spin + 2.0 * spin_off)
        lacking = _times(heavy, off + self.blur * np.abs(changes) + thrown)
        lacking += self.blur * np.abs(forces)
        lacking += self.blur * _times(np.swapaxes(held, 1, 2), np.abs(solution))
        error = np.max(_times(np.swapaxes(away, 1, 2), lacking), axis=1)
        return solution * self.rows, np.asarray(error)

    def _filled(self, numbers: Mapping[str, Any]) -> dict[str, Array]:
        """Return the arrays of the emitted function at each place, shape (n, rows, columns)."""
        taken = signature(self.module.dynamics).parameters
        values = self.module.dynamics(**{item: numbers.get(item, 0.0) for item in taken})
        filled = {}
        for name, (shape, entries) in self.module.ARRAYS["dynamics"].items():
            filled[name] = np.zeros((self.blur.size, *shape))
            for row, column, place in entries:
                filled[name][:, row, column] = values[place]
        return filled

    def _widened(self, matrix: Array) -> Array:
        """Return magnitudes; an arm's components each count as large as the larger one."""
        wide = np.abs(matrix)
        most = np.max(wide, axis=1, keepdims=True)
        return np.where(self.angles & np.any(wide > 0.0, axis=0), most, wide)


def _times(matrices: Array, vectors: Array) -> Array:
    return np.asarray((matrices @ vectors[..., np.newaxis])[..., 0])
