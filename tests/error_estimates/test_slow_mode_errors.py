"""Error estimates of slow multipliers and reduced systems, over 100 random stiff systems."""

import numpy as np
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.decoupled import SlowModes, slow_system
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
    return system_of(M=np.eye(3), K=stiffness, **damping), bool(drag)


@over_scenes(7, few=None, many=100, floor=1e-14)
def test_slow_multipliers_lie_within_their_estimates(rng):
    system, damped = random_system(rng)
    speed = rng.uniform(0.25, 0.7)
    values, error = SlowModes(system).motions(speed, 1).multipliers()
    # All modes resolved; where both are exact to round-off the reference's error counts too.
    reference = floquet_multipliers(system, speed, rtol=1e-12)
    gaps = np.abs(values[:, None] - reference.multipliers)
    nearest, actual = np.argmin(gaps, axis=1), np.min(gaps, axis=1)
    pairs = {"multipliers": (error + reference.error[nearest], actual)}
    if not damped:
        reduced = slow_system(system, (0.9 * speed, 1.1 * speed), 1)
        own = floquet_multipliers(reduced.system, speed).multipliers
        gap = np.max(np.min(np.abs(own[:, None] - reference.multipliers), axis=1))
        assert gap <= 2.0 * np.pi / speed * reduced.error + 1e-10
    return pairs
