"""Random systems with response curves: crank-rockers with a soft coupler, and oscillators."""

import elastolink as el
import numpy as np
from bent_rigs import rig
from oscillators import oscillators


def random_rig(rng):
    """Return a crank-rocker with an inextensible coupler, and a range about a resonance."""
    modes = int(rng.choice([1, 1, 2, 3]))
    system = rig("A58", modes)
    coupler = system.parameters["coupler"]
    lengths = {
        "crank": coupler * rng.uniform(0.05, 0.2),
        "follower": coupler * rng.uniform(0.35, 0.7),
        "frame": coupler * rng.uniform(0.85, 1.1),
    }
    shortest, *_, longest = sorted([coupler, *lengths.values()])
    if shortest + longest >= 0.48 * 2 * (sum(lengths.values()) + coupler) / 2:
        return None
    mass, own = rng.uniform(0.02, 0.2), 2 * np.pi * rng.uniform(8.0, 40.0)
    stiffness = own**2 * mass * (coupler / np.pi) ** 4
    inertia = rng.uniform(0.2, 1.0) * mass * coupler * lengths["follower"] ** 2
    decrement = 10.0 ** rng.uniform(-1.3, -0.5)
    system = system.with_parameters(
        **lengths,
        mass_per_length=mass,
        bending_stiffness=stiffness,
        follower_inertia=inertia,
        damping=decrement * mass * own / np.pi,
    )
    part = rng.choice([0.5, 1.0 / 3.0])
    centre = own * part * rng.uniform(0.85, 1.0)
    return system, (0.97 * centre, 1.03 * centre)


def random_oscillators(rng):
    """Return one or two oscillators under a force or a periodic stiffness, and a range."""
    n = int(rng.choice([1, 1, 2]))
    stiffness = np.diag([1.0, rng.uniform(1.5, 5.0)][:n])
    parametric = rng.normal(size=(n, n))
    system = oscillators(
        stiffness,
        parametric + parametric.T,
        rng.normal(size=n),
        damping=10.0 ** rng.uniform(-2.0, -1.0),
        cubic=rng.choice([-0.1, 0.3, 1.0]),
        quadratic=rng.choice([0.0, 0.2]),
        force=rng.uniform(0.02, 0.15),
        excitation=rng.choice([0.0, 0.2]),
    )
    centre = rng.choice([0.5, 1.0, 1.2, 2.0])
    return system, (0.85 * centre, 1.15 * centre)


def curve_of(rng, drawn, turns):
    """Return the response curve of a draw; None where there is no motion to begin with."""
    system, bounds = drawn
    try:
        return el.response_curve(system, "speed", bounds, turns=turns)
    except el.BadInput:
        return None
