"""Errors of every moving basis of the rod against the number of modes, on equal physics.

Frozen frequencies are compared with the roots of the pinned beam with an overhang; tip deflections
with those of sixteen two-segment polynomials, which agree with twelve to ten digits and, from rest,
with a fixed mesh (``test_rod_tip_deflection.py``).
"""

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np
from elastolink.runtime.linkages import QuickReturn
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.systems import rod as rods
from marching import marched
from rod_reference import Rod, flexible, stiff
from scipy.linalg import eigh

BASES: Mapping[str, Callable] = {
    "overhang": rods.OverhangBasis,
    "polynomial": rods.PolynomialBasis,
    "two_segment": rods.TwoSegmentBasis,
    "free_free_linear": rods.FreeFreeBasis,
}
RODS: Mapping[str, Callable[[], Rod]] = {"flexible": lambda: flexible(0.01, 100.0), "stiff": stiff}
# Angles of the steady motion, and steps of the one from rest: twice as many change nothing here.
_SAMPLES = 64
STEPS = 512
REFERENCE = 16


def frequencies(basis, place: float) -> np.ndarray:
    """Return omega sqrt(m L^4/EI) of the rod held still with the block at x1/L."""
    at = np.array([place])
    squares = eigh(basis.array("bending", at)[0], basis.array("overlap", at)[0], eigvals_only=True)
    return np.sqrt(squares)


def frequency_error(basis, place: float, mode: int) -> float:
    """Return the relative error of one frozen frequency; mode from 1."""
    exact = rods.OverhangBasis(mode).roots(np.array([place]))[0, -1] ** 2
    return float(abs(frequencies(basis, place)[mode - 1] / exact - 1))


def made(rod: Rod, basis):
    """Return the linear periodic system of a rod on a basis."""
    return rods.rod_system(
        basis,
        crank_ratio=rod.crank / rod.frame,
        frame=rod.frame,
        length=rod.length,
        bending_stiffness=rod.bending_stiffness,
        mass_per_length=rod.mass_per_length,
        drop=() if rod.tension else ("frame", "tension"),
    )


def _tip(rod: Rod, basis, theta: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return the tip deflection over the rod's length."""
    linkage = QuickReturn(frame=rod.frame, crank=rod.crank, rod=rod.length)
    shapes = basis.shapes(np.array([1.0]), linkage.motion(theta).slide / rod.length)
    return np.einsum("tn,tn->t", shapes[:, 0], q)


def steady_tip(rod: Rod, basis) -> np.ndarray:
    """Return the periodic tip deflection at even angles."""
    found = steady_state(made(rod, basis), rod.speed, rtol=1e-11, samples=_SAMPLES)
    return found.deflection(1.0) / rod.length


def transient_tip(rod: Rod, basis, turns: int = 1) -> np.ndarray:
    """Return the tip deflection from rest, at the end of each step."""
    q = marched(6, made(rod, basis), rod.speed, STEPS, turns)
    return _tip(rod, basis, 2 * np.pi / STEPS * np.arange(len(q)), q)


@lru_cache(maxsize=8)
def reference(rod_name: str, kind: str) -> np.ndarray:
    """Return the tip deflection that the others are compared with."""
    return _deflection(rod_name, rods.TwoSegmentBasis(REFERENCE), kind)


def _deflection(rod_name: str, basis, kind: str) -> np.ndarray:
    rod = RODS[rod_name]()
    if kind == "steady":
        return steady_tip(rod, basis)
    return transient_tip(rod, basis)


def deflection_error(rod_name: str, basis, kind: str) -> float:
    """Return the largest error of the tip deflection over its peak.

    The motion is ``steady``, or ``from rest`` over the first turn.
    """
    truth = reference(rod_name, kind)
    ours = _deflection(rod_name, basis, kind)
    return float(np.max(np.abs(ours - truth)) / np.max(np.abs(truth)))


def condition(basis, place: float) -> float:
    """Return the condition of the mass matrix, scaled to a unit diagonal."""
    mass = basis.array("overlap", np.array([place]))[0]
    scale = 1 / np.sqrt(np.diag(mass))
    return float(np.linalg.cond(mass * scale * scale[:, None]))


def tongue(basis, around: float, ratio: float = 0.05, growth: float = 1.01) -> tuple[float, float]:
    """Return the crank speeds between which the flexible rod grows by more than a factor a turn.

    The region about a speed [rad/s] inside it, its ends to 0.13 rad/s.
    """
    system = made(flexible(ratio, around), basis)

    def grows(speeds: np.ndarray) -> np.ndarray:
        found = floquet_multipliers(system, speeds, rtol=1e-8).multipliers
        return np.abs(found).max(axis=-1) > growth

    ends = []
    for direction in (-1.0, 1.0):
        inside, width = around, 16.0
        while width > 0.05:
            speeds = inside + direction * width * np.arange(9)
            still = grows(speeds)
            if not still[0]:
                raise ValueError(f"no growth at {inside:g} rad/s")
            if still.all():
                inside = speeds[-1]
            else:
                inside = speeds[np.argmin(still) - 1]
                width /= 8
        ends.append(float(inside + direction * width * 4))
    return ends[0], ends[1]
