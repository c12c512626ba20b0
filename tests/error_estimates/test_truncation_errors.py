"""Error estimates of exponents of modal truncations, over 100 random stiff systems."""

import numpy as np
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.lowest_modes import LowestModes
from honesty import over_scenes
from periodic_systems import system_of


def random_system(generator):
    """Return one slow and two stiff coupled freedoms on a turning basis."""
    levels = np.array([1.0, generator.uniform(30.0, 40.0), generator.uniform(60.0, 80.0)]) ** 2
    modulation = generator.uniform(-0.3, 0.3, (3, 2))
    swing = generator.uniform(-0.4, 0.4, (2, 2))
    drag = generator.choice([0.0, 1e-3])

    def turn(theta):
        out = np.broadcast_to(np.eye(3), (len(theta), 3, 3)).copy()
        for other, (a, b) in zip((1, 2), swing, strict=True):
            angle = a * np.sin(theta) + b * np.cos(theta)
            part = np.broadcast_to(np.eye(3), (len(theta), 3, 3)).copy()
            part[:, 0, 0] = part[:, other, other] = np.cos(angle)
            part[:, 0, other], part[:, other, 0] = -np.sin(angle), np.sin(angle)
            out = out @ part
        return out

    def stiffness(theta):
        waves = np.stack([np.cos(theta), np.sin(theta)])
        rows = levels * (1.0 + (modulation @ waves).T)
        r = turn(theta)
        return np.swapaxes(r, -1, -2) @ (rows[:, :, None] * r)

    damping = {"C": lambda theta: drag * stiffness(theta)} if drag else {}
    return system_of(M=np.eye(3), K=stiffness, **damping)


@over_scenes(7, few=None, many=100, floor=1e-11)
def test_exponents_lie_within_their_estimates(rng):
    """The half sum of the slow oscillator's two, and away from resonances each of them."""
    system = random_system(rng)
    speed = rng.uniform(0.25, 0.7)
    truncated, estimate = LowestModes(system, 1).required(speed, 1)
    few = floquet_multipliers(truncated, speed, rtol=1e-12).multipliers
    whole = floquet_multipliers(system, speed, rtol=1e-12).multipliers
    gaps = np.abs(few[:, None] - whole)
    near = np.argsort(np.min(gaps, axis=0))[:2]
    # The slow oscillator turns through 2 pi / speed in a period.
    unit = 2.0 * np.pi / speed * np.max(np.abs(few))
    gap = 0.5 * np.abs(np.sum(few) - np.sum(whole[near]))
    # Where both are nearly 1 or -1 they part by a root.
    if np.min(np.abs(few.imag)) > 0.1:
        gap = max(gap, np.max(np.min(gaps, axis=1)))
    return estimate, gap / unit
