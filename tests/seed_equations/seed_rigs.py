"""Smith's rigs of chapter 9: parameters, functions, regions and the damping that closes one."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy as sp
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import critical_damping
from seed_derivations import EI, l2, l3, mode, mode_coefficient, theta2, theta3
from seed_truth import CRANK_ROCKERS, TURN, boundaries, coupler_functions, motion, named


@dataclass(frozen=True)
class Rig:
    """One of Smith's rigs, with the 1/16 in coupler: inches, lbf, seconds (his chapter 9).

    The mass per length follows from the stiffness and the frequency of 26 Hz that he observed.
    """

    lengths: tuple[float, float, float, float]
    stiffness: float = 171.5
    frequency: float = TURN * 26.0
    inertias: tuple[float, float] = (0.0058, 0.0190)

    @property
    def mass_per_length(self):
        """Return the mass per length [lbf s^2 / in^2]."""
        return self.stiffness * (np.pi / self.lengths[2]) ** 4 / self.frequency**2

    def epsilon(self, inertia4):
        """Return (epsilon1, epsilon2, epsilon3) of a uniform coupler, by their dimensions."""
        _, l2, l3, l4 = self.lengths
        scale = np.pi**2 / l3**2
        follower = inertia4 / (self.mass_per_length * l4)
        return scale * l3**2 / 3.0, scale * (l3 / 2.0) * l2, scale * follower


RIGS = {"5,1,5,2": Rig((15.0, 3.0, 15.0, 6.0)), "10,1,10,4": Rig((15.0, 1.5, 15.0, 6.0))}


def thinner(name, sixty_fourths):
    """Return a rig with a thinner coupler: its frequency is in proportion to the thickness."""
    part = sixty_fourths / 4
    return Rig(RIGS[name].lengths, 171.5 * part**3, TURN * 26.0 * part)


def parts(rig, inertia4):
    """Return what (6.18) keeps, what (6.17) adds, and what the complete first mode adds."""
    m = motion(rig.lengths)
    phi, *functions = coupler_functions(m)
    eps = rig.epsilon(inertia4)
    coefficient, speed2 = mode_coefficient()
    frame_free = coefficient.subs({EI: 0, mode: 1})
    whole = sp.lambdify([l2, l3, speed2, theta2, theta3], frame_free)
    rigid = whole(*rig.lengths[1:3], phi, m.theta2, m.theta3)
    point = {f"eps{k}": e for k, e in enumerate(eps, 1)} | {"phi": phi, "alpha3": m.alpha3}
    point |= {f"f{k}": f for k, f in enumerate(functions, 1)}
    point |= {"omega2": 1.0, "theta2": m.theta2, "theta3": m.theta3} | named(rig.lengths)
    return point, sum(e * f for e, f in zip(eps, functions, strict=True)) + rigid


def speeds(rig, coefficient, region):
    """Return the crank speeds [rpm] that bound a region."""
    return rig.frequency / np.sqrt(boundaries(coefficient, region)) * 60 / TURN


@cache
def linkage_function(name):
    return coupler_functions(motion(CRANK_ROCKERS[name]))[3]


def critical(name, mu, region):
    """Return the damping that closes a region."""
    function = PeriodicFunction.from_samples(linkage_function(name))
    return critical_damping(function, mu, (region,)).damping.item()
