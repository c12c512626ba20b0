"""What the stability tests of the rod in Buckens' frame share: loads, multipliers, differences."""

from collections.abc import Callable, Collection
from dataclasses import replace

import numpy as np
from elastolink.runtime.constrained import orbit_multipliers, periodic_orbit
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.systems.rod import FreeFreeBasis, FreeFreeRod, free_free_rod, rod_system

# Beale & Scott, section 2.1: the very flexible rod.
ROD = {
    "frame": 0.59997,
    "length": 1.0,
    "bending_stiffness": 0.7e11 * 0.5208e-6,
    "mass_per_length": 7.15,
}
Load = Callable[[np.ndarray, object], np.ndarray]


def rod(modes: int, ratio: float, speed: float, drop: Collection[str] = ()) -> FreeFreeRod:
    return free_free_rod(modes, crank_ratio=ratio, speed=speed, drop=drop, **ROD)


def linear(modes: int, ratio: float, speed: float, drop: Collection[str] = ()):
    """Multipliers of the linear form on the small-angle basis that the paper conjectures."""
    system = rod_system(FreeFreeBasis(modes), crank_ratio=ratio, drop=drop, **ROD)
    return floquet_multipliers(system, speed, rtol=1e-13)


def loaded(bare: FreeFreeRod, load: Load) -> FreeFreeRod:
    """Return the rod with a load ``load(theta, motion) x`` per length, across the line OB.

    It is a dead load, given over time; on the free-free modes, which have neither mean nor moment,
    it does no work.
    """
    length = bare.linkage.rod

    def at(t):
        theta = bare.speed * np.asarray(t, dtype=float)
        motion = bare.linkage.motion(theta, bare.speed)
        return motion.theta4, load(theta, motion)

    def dynamics(q, qd, t):
        arrays = dict(bare.dynamics(q, qd, t))
        line, size = at(t)
        forces = arrays["forces"].copy()
        forces[..., 0, 0] -= size * length**2 / 2 * np.sin(line)
        forces[..., 1, 0] += size * length**2 / 2 * np.cos(line)
        forces[..., 2, 0] += size * length**3 / 12 * np.cos(q[..., 2] - line)
        return {**arrays, "forces": forces}

    def variations(q, qd, qdd, lam, t):
        arrays = dict(bare.variations(q, qd, qdd, lam, t))
        line, size = at(t)
        stiffness = arrays["stiffness"].copy()
        stiffness[..., 2, 2] += size * length**3 / 12 * np.sin(q[..., 2] - line)
        return {**arrays, "stiffness": stiffness}

    return replace(bare, dynamics=dynamics, variations=variations)


def part_of_inertia(part: float) -> Load:
    """A load that leaves ``part`` of the inertia load -m phi'' x: none at 0, all at 1."""
    return lambda theta, motion: (1.0 - part) * ROD["mass_per_length"] * motion.alpha4


def in_step(size: float, speed: float) -> Load:
    """No inertia load, but one in step with cos theta: even in time, as phi'' is odd."""
    push = size * ROD["mass_per_length"] * speed**2

    def load(theta, motion):
        return ROD["mass_per_length"] * motion.alpha4 + push * np.cos(theta)

    return load


def about(system: FreeFreeRod):
    """Return orbit and multipliers of a rod, both having passed their checks."""
    orbit = periodic_orbit(system)
    orbit.require()
    found = orbit_multipliers(orbit)
    found.require()
    return orbit, found


def phases(multipliers: np.ndarray) -> np.ndarray:
    """Arguments of the upper half of multipliers on the unit circle, sorted."""
    upper = multipliers[multipliers.imag > 0]
    assert 2 * len(upper) == len(multipliers)
    return np.sort(np.angle(upper))


def difference(found: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Differences of the phases of two sets of multipliers, signed."""
    return phases(found) - phases(other)
