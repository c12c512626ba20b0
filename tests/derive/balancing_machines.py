"""Machines that the rigid tests share, and their forces from the equations of free bodies."""

import elastolink as el
import numpy as np

INCH = 0.0254
# The weights of Smith's example become masses with g = 384 in/s^2, the value with which a uniform
# bar of 1 lbf and 12 in has the printed 0.125 lbf in s^2 about its end.
POUND = 4.4482216152605 / (384.0 * INCH)


def smith():
    """Return the machine of Smith Figs. 12-16 and 20-23."""
    linkage = el.FourBar(*(INCH * length for length in (12.0, 6.0, 12.0, 12.0)))
    weights = zip(linkage.links, (0.5 * POUND, POUND, POUND), strict=True)
    bars = {k: el.MassDistribution.uniform_bar(m, linkage.lengths[k]) for k, m in weights}
    return el.Machine(linkage, bars)


def crooked_bodies(linkage):
    """Return a body for each link of any linkage, its centre beside the link."""
    bodies = ((0.4, 0.03, 0.01, 0.002), (0.7, 0.15, -0.04, 0.006), (0.6, 0.1, 0.02, 0.004))
    return {
        link: el.MassDistribution.about_centre(*body)
        for link, body in zip(linkage.links, bodies, strict=True)
    }


def random_machine(rng):
    """Return a crank-rocker or double crank with links of any shape."""
    while True:
        lengths = rng.uniform(0.2, 1.0, 4)
        lengths[1] = 0.1
        try:
            linkage = el.FourBar(*lengths, assembly=str(rng.choice(["open", "crossed"])))
        except el.BadInput:
            continue
        if linkage.crank_turns:
            break
    bodies = {}
    for link in linkage.links:
        mass, along, across = rng.uniform([0.1, -0.5, -0.5], [2.0, 0.5, 0.5])
        bodies[link] = el.MassDistribution.about_centre(mass, along, across, rng.uniform(0.0, 0.2))
    return el.Machine(linkage, bodies)


def with_crank_counterweight(machine, speed):
    """Return the optimum of a counterweight on the crank, by the root mean square of the force."""
    return el.balance(
        machine,
        speed,
        weights={"shaking_force": 1.0},
        links=("crank",),
        bounds=el.Bounds(mass=50.0, offset=1.0),
        measure="rms",
    )


def nine_equations(machine, theta, speed, acceleration=0.0):
    """Return the forces of a machine by name, the three links' equations solved at once.

    Moments are taken about the centres of mass.
    """
    motion = machine.linkage.motion(theta, speed, acceleration)
    count = np.broadcast(theta, speed, acceleration).size
    matrix, right = np.zeros((count, 9, 9)), np.zeros((count, 9))
    for i, link in enumerate(machine.linkage.links):
        body, spin = machine.mass(link), motion.link(link).angular_acceleration
        centre = motion.point(link, *body.centre)
        for sign, joint in ((1.0, i), (-1.0, i + 1)):
            arm = motion.joints["ABCD"[joint]] - centre.position
            matrix[:, 3 * i, 2 * joint] = matrix[:, 3 * i + 1, 2 * joint + 1] = sign
            matrix[:, 3 * i + 2, 2 * joint] = -sign * arm[..., 1]
            matrix[:, 3 * i + 2, 2 * joint + 1] = sign * arm[..., 0]
        right[:, 3 * i : 3 * i + 2] = body.mass * centre.acceleration
        right[:, 3 * i + 2] = body.inertia_about_centre * spin
    matrix[:, 2, 8] = 1.0
    solution = np.linalg.solve(matrix, right[..., None])[..., 0]
    torque = solution[:, 8]
    found = {f"f{pin}": solution[:, 2 * i : 2 * i + 2] for i, pin in enumerate((12, 23, 34, 41))}
    found["shaking_force"] = found["f41"] - found["f12"]
    # Frame: -f12 at A, f41 at D, and the drive's reaction -T.
    moment = machine.linkage.frame * found["f41"][:, 1] - torque
    return {**found, "torque": torque, "shaking_moment": moment}


def sampled_peaks(machine, theta, speed, acceleration=0.0):
    """Return the greatest magnitude of each force over the samples."""
    return {
        name: float(np.max(np.linalg.norm(v, axis=1) if v.ndim == 2 else np.abs(v)))
        for name, v in nine_equations(machine, theta, speed, acceleration).items()
    }
