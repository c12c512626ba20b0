"""Forces in a four-bar linkage from the nine equations of its three free bodies, solved at once.

The independent route beside the emitted closed forms: Smith (4.4)-(4.6) as they stand, for links
of any mass distribution, one 9 x 9 system for each crank angle.
"""

from __future__ import annotations

import numpy as np
from elastolink.runtime.linkages import FourBar

INCH = 0.0254
# One pound-force [N]; the weights of Smith's example become masses with g = 384 in/s^2, the value
# with which a uniform bar of 1 lbf and 12 in has the printed 0.125 lbf in s^2 about its end.
POUND_FORCE = 4.4482216152605
POUND = POUND_FORCE / (384.0 * INCH)


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _turned(angle, along, across):
    """Return a vector of the link's frame in the fixed frame."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * along - s * across, s * along + c * across], axis=-1)


def forces(lengths, masses, theta2, speed, acceleration=0.0, branch=1.0):
    """Return all forces by name, for masses (mass, along, across, inertia) of the three links.

    ``theta2`` has one axis.  The inertia is about the first joint: A, B, D.
    """
    l1, l2, l3, l4 = lengths
    theta2 = np.asarray(theta2, dtype=float)
    linkage = FourBar(*lengths, assembly="open" if branch > 0 else "crossed")
    moved = linkage.motion(theta2, speed, acceleration)
    t3, w3, a3, t4, w4, a4 = (
        getattr(moved, f"{name}{link}") for link in (3, 4) for name in ("theta", "omega", "alpha")
    )
    one = np.ones_like(theta2)
    zero = np.zeros((*theta2.shape, 2))
    ab = _turned(theta2, l2, 0.0)
    bc, dc = _turned(t3, l3, 0.0), _turned(t4, l4, 0.0)
    acc_b = _turned(theta2, -l2 * speed**2, l2 * acceleration)
    links = (
        (masses[0], theta2, speed * one, acceleration * one, zero),
        (masses[1], t3, w3, a3, acc_b),
        (masses[2], t4, w4, a4, zero),
    )
    momentum, spin = [], []  # d(linear)/dt, and d(angular)/dt + r x m a about the first joint
    for (mass, along, across, inertia), angle, w, a, base in links:
        moment = _turned(angle, along, across)
        quarter = _turned(angle, -across, along)
        momentum.append(mass * base + a[:, None] * quarter - (w**2)[:, None] * moment)
        spin.append(inertia * a + _cross(moment, base))
    # unknowns: x12 y12 x23 y23 x34 y34 x41 y41 T
    matrix = np.zeros((len(theta2), 9, 9))
    known = np.zeros((len(theta2), 9))
    for link in range(3):
        for axis in range(2):
            row = 3 * link + axis
            matrix[:, row, 2 * link + axis] = 1.0
            matrix[:, row, 2 * link + 2 + axis] = -1.0
            known[:, row] = momentum[link][:, axis]
    for link, arm, sign, column in ((0, ab, -1.0, 2), (1, bc, -1.0, 4), (2, dc, 1.0, 4)):
        row = 3 * link + 2
        matrix[:, row, column] = -sign * arm[:, 1]
        matrix[:, row, column + 1] = sign * arm[:, 0]
        known[:, row] = spin[link]
    matrix[:, 2, 8] = 1.0
    found = np.linalg.solve(matrix, known[..., None])[..., 0]
    named = {f"f{p}": found[:, 2 * i : 2 * i + 2] for i, p in enumerate(("12", "23", "34", "41"))}
    named["torque"] = found[:, 8]
    named["shaking_force"] = named["f41"] - named["f12"]
    # Frame: -f12 at A, f41 at D, and the drive's reaction -T.
    named["shaking_moment"] = l1 * named["f41"][:, 1] - named["torque"]
    return named


def smith_bars():
    """Return lengths [m] and bars of the linkage of Smith Figs. 12-16 and 20-23."""
    lengths = tuple(INCH * x for x in (12.0, 6.0, 12.0, 12.0))
    weights = (0.5 * POUND, 1.0 * POUND, 1.0 * POUND)
    bars = [
        (m, m * size / 2, 0.0, m * size**2 / 3)
        for m, size in zip(weights, lengths[1:], strict=True)
    ]
    return lengths, bars
