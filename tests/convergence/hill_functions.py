"""Functions of Hill's equation that tests and benchmarks share."""

import elastolink as el
import numpy as np

COSINE = el.PeriodicFunction([0.0, 1.0])
# Three harmonics with sines and a mean.
GENERAL = el.PeriodicFunction([0.3, 1.0, -0.4, 0.2], [0.0, 0.5, 0.7, -0.1])
ANOTHER = el.PeriodicFunction([0.3, 1.0, -0.4, 0.25], [0.0, -0.5, 0.3, 0.1])


def functions():
    """A general function of 24 harmonics, and f3 = -alpha4/sin(theta3 - theta4), Smith (6.16)."""
    rng = np.random.default_rng(1972)
    fall = 0.7 ** np.arange(25)
    a, b = rng.uniform(-1.0, 1.0, 25) * fall, rng.uniform(-1.0, 1.0, 25) * fall
    b[0] = 0.0
    out = {"24 harmonics": el.PeriodicFunction(a, b)}
    for lengths in ((5, 1, 5, 2), (10, 1, 10, 4), (2, 1, 2, 2)):
        name = f"f3 ({','.join(map(str, lengths))})"
        out[name] = el.PeriodicFunction.from_callable(end_load(*lengths))
    return out


def general(harmonics, fall=0.7, seed=0):
    """Return a random function whose coefficients fall geometrically."""
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(-1, 1, (2, harmonics + 1)) * fall ** np.arange(harmonics + 1)
    b[0] = 0.0
    return el.PeriodicFunction(a, b)


def end_load(*lengths):
    """Return Smith's f3 of a four-bar as a function of the crank angle."""
    linkage = el.FourBar(*map(float, lengths))

    def f3(theta):
        at = linkage.motion(theta)
        return -at.alpha4 / np.sin(at.theta3 - at.theta4)

    return f3
