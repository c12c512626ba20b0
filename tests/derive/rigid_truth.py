"""Forces of a machine in many digits: free bodies as in ``forces_truth``, gravity and loads."""

import mpmath
import numpy as np
from forces_truth import cross, inertia_pushes, links, reactions

DIGITS = 60
_NAMES = {"FourBar": "four_bar", "SliderCrank": "slider_crank", "QuickReturn": "quick_return"}


def forces(machine, theta, speed, acceleration, outside):
    """Return every force by name, as mpmath numbers.

    Masses and gravity are the machine's; ``outside`` is, by link, force and couple at its first
    joint.
    """
    mechanism = _NAMES[type(machine.linkage).__name__]
    numbers = {**machine.linkage.geometry, "theta2": theta}
    numbers |= {"speed": speed, "acceleration": acceleration}
    for n, link in enumerate(machine.linkage.links, start=2):
        mass = machine.mass(link)
        numbers |= {f"{x}{n}": getattr(mass, x) for x in ("mass", "along", "across", "inertia")}
    with mpmath.workdps(DIGITS):
        numbers = {name: mpmath.mpf(float(value)) for name, value in numbers.items()}
        bodies, _ = links(mechanism, numbers)
        gravity = mpmath.mpc(*machine.gravity)
        pushes = []
        for n, (link, body, (force, moment)) in enumerate(
            zip(machine.linkage.links, bodies, inertia_pushes(numbers, bodies), strict=True), 2
        ):
            fx, fy, couple = map(mpmath.mpf, outside.get(link, (0.0, 0.0, 0.0)))
            arm = mpmath.mpc(numbers[f"along{n}"], numbers[f"across{n}"]) * body[2]
            push = force - numbers[f"mass{n}"] * gravity - mpmath.mpc(fx, fy)
            pushes.append((push, moment - cross(arm, gravity) - couple))
        return reactions(mechanism, numbers, pushes)


def errors(machine, found, outside=None):
    """Return the actual error at each angle in the norm of the error estimate, and the estimate."""
    longest = max(abs(length) for length in machine.linkage.lengths.values())
    worst = []
    for i, theta in enumerate(found.theta2):
        speed = np.broadcast_to(found.speed, found.theta2.shape)[i]
        acceleration = np.broadcast_to(found.acceleration, found.theta2.shape)[i]
        with mpmath.workdps(DIGITS):
            exact = forces(machine, theta, speed, acceleration, outside or {})
            gaps = [
                abs(mpmath.mpf(float(value[i])) - exact[name])
                / (longest if name in ("torque", "shaking_moment", "couple34", "couple41") else 1)
                for name, value in found.values.items()
            ]
            worst.append(float(max(gaps)))
    return np.array(worst), np.asarray(found.error)
