"""The damping that closes a region, and its derivatives, against half traces of Hill's equation.

With y = exp(-K theta) z the damped equation is an undamped one in lam2 - K^2: at each speed the
damping that just holds a motion follows from its exponent, and the one that closes the region is
the largest of these.  The half trace exceeds 1 by x^2/2 where the exponent is x/2 pi: its error is
as much over x^2 of the damping.
"""

import elastolink as el
import numpy as np
from elastolink.runtime.design import closing_damping, sensitivities
from honesty import over_scenes
from scipy.optimize import minimize_scalar


def mathieu(stiffness, depth):
    """Return ``q'' + c q' + (k + e cos(w t)) q = 0`` as a system."""
    one = np.eye(1)
    return el.LinearPeriodic(
        size=1,
        terms=(
            el.Term("M", None, one),
            el.Term("C", "c", one),
            el.Term("K", "k", one),
            el.Term("K", "e", lambda theta: np.cos(theta)[:, None, None]),
        ),
        parameters={"c": 0.0, "k": stiffness, "e": depth},
        scales=dict,
    )


COSINE = el.PeriodicFunction(a=[0.0, 1.0])


def needed(speed, stiffness, depth):
    """Return the damping that holds the motion at a speed."""
    k = 0.0
    for _ in range(200):
        half = el.discriminant(COSINE, stiffness / speed**2 - k * k, depth / speed**2).value
        new = np.arccosh(max(abs(float(half)), 1.0)) / (2.0 * np.pi)
        if abs(new - k) <= 1e-16:
            break
        k = new
    return 2.0 * speed * k


def exact(stiffness, depth, low, high):
    found = minimize_scalar(
        lambda w: -needed(w, stiffness, depth), bounds=(low, high), options={"xatol": 1e-9 * low}
    )
    return -found.fun


@over_scenes(511, few=4, many=60, median=1e3)
def test_closing_damping(rng):
    stiffness, share = 10.0 ** rng.uniform(-1.0, 3.0), rng.uniform(0.05, 0.5)
    n, root = int(rng.integers(1, 4)), np.sqrt(stiffness)
    system = mathieu(stiffness, share * stiffness)
    edges = el.stability_edges(system, (1.7 * root / n, 2.6 * root / n))
    row = int(np.argmax(edges.harmonic == n))
    low, high = float(edges.lower[row]), float(edges.upper[row])
    if edges.harmonic[row] != n or not high - low > 1e-4 * low:
        return None
    found = closing_damping(system, edges, "c")
    truth = exact(stiffness, share * stiffness, low, high)
    slopes = sensitivities(system, found, ["k", "e"])
    # By its dimension the damping goes with the root of both stiffnesses.
    total = np.sum(slopes.relative[row])
    relative = slopes.error[row] * slopes.number / found.damping[row]
    speed, k = found.speed[row], 0.5 * truth / found.speed[row]
    half = el.discriminant(COSINE, stiffness / speed**2 - k * k, share * stiffness / speed**2)
    known = float(half.error) / (2.0 * np.pi * k) ** 2
    return {
        "damping": (found.error[row] / truth + known, found.damping[row] / truth - 1.0),
        "derivatives": (np.sum(relative), total - 0.5),
    }
