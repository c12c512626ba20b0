"""Error estimates of periodic orbits on constraints, against a bead on a cycloid in closed form."""

import numpy as np
from cycloid_truth import Cycloid
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.constrained import orbit_multipliers, periodic_orbit
from elastolink.runtime.core.families import Constrained
from honesty import over_scenes


def random_bead(rng: np.random.Generator) -> Cycloid:
    """Return a bead that swings through up to 2 rad of rolling, from damped to hardly so."""
    mass, radius, gravity = rng.uniform(0.1, 5.0), rng.uniform(0.05, 2.0), rng.uniform(1.0, 20.0)
    own = np.sqrt(gravity / (4 * radius))
    speed = own * np.exp(rng.uniform(np.log(0.2), np.log(5.0)))
    drag = 2 * mass * own * 10.0 ** rng.uniform(-3.0, -0.3)
    reply = abs(mass * (own**2 - speed**2) + 1j * drag * speed)
    arc = 4 * radius * rng.uniform(0.05, 0.84)
    return Cycloid(mass, radius, gravity, drag, arc * reply, speed)


@over_scenes(20)
def test_estimates_hold_and_are_not_idle(rng, emit):
    module = emit("cycloid", ModelSpec("cycloid", "multiplier")).module
    bead = random_bead(rng)
    system = Constrained.from_module(module, bead.numbers)
    guess = [0.9 * values for values in bead.state(np.arange(24) * (bead.period / 24))]
    orbit = periodic_orbit(system, bead.period, *guess)
    assert not orbit.message
    shooting = orbit.source.shooting
    columns = shooting.equations.columns
    state, exact = (
        shooting.state(q / columns, qd / columns)
        for q, qd in ((orbit.q, orbit.qd), bead.state(orbit.t))
    )
    away = np.max(np.abs(state - exact)) / np.max(np.abs(exact))
    found = orbit_multipliers(orbit)
    gap = np.abs(found.physical[:, None] - bead.multipliers()).min(axis=1)
    return {"orbit": (orbit.error, away), "multipliers": (found.error, gap)}
