"""The error of the amplitude law's coefficient is covered, next to dead positions too."""

import elastolink as el
import mpmath
import numpy as np
from elastolink.runtime.nonlinear import amplitude_law
from honesty import over_scenes

SCENE = "smith_1972_101104_thirtysecond_inch"


def coefficient(scene, theta, mode, modes):
    """Return the coefficient from the numbers of a scene in 40 digits, by the law of cosines."""
    number = mpmath.mpf
    crank, coupler, follower, frame = (
        number(scene["links"][name]) for name in ("crank", "coupler", "follower", "frame")
    )
    square = frame**2 + crank**2 - 2 * frame * crank * mpmath.cos(number(theta))
    cosine = (coupler**2 + follower**2 - square) / (2 * coupler * follower)
    sine2 = 1 - cosine**2
    driven = number(scene["follower"]["inertia"]) / follower**2
    mass = driven / (number(scene["coupler"]["mass_per_length"]) * coupler)
    k = mode * mpmath.pi
    total = -(k**2) / 64 - k**2 / 8 * ((mass + number(1) / 3) * k**2 - 2) / sine2
    for m in range(1, modes + 1):
        if m != mode:
            share = mpmath.pi**2 * number(mode) ** 8 / (m**2 * (4 * mode**4 - m**4))
            total += share * cosine**2 / sine2
    return total


@over_scenes(184, few=40, many=None)
def test_estimate_covers(rng):
    # A crank-rocker; the nearer 0 the gap, the nearer to a dead position it comes.
    frame, coupler, follower = rng.uniform(0.2, 1.0, 3)
    spare = frame + coupler + follower - 2 * max(frame, coupler, follower)
    if spare <= 0.0:
        return None
    crank = min(spare, frame, coupler, follower) * (1.0 - 10.0 ** rng.uniform(-9.0, -0.1))
    lengths = {"frame": frame, "crank": crank, "coupler": coupler, "follower": follower}
    changes = {f"links.{name}": f"{float(size)!r} m" for name, size in lengths.items()}
    scene = el.load_scene(SCENE, {"model.formulation": "inextensible", **changes})
    angles = np.concatenate([rng.uniform(0.0, 2.0 * np.pi, 4), [1e-7, np.pi - 1e-7]])
    mode, modes = int(rng.integers(1, 6)), 8
    law = amplitude_law(scene, angles, mode, modes)
    with mpmath.workdps(40):
        exact = [coefficient(scene, theta, mode, modes) for theta in angles]
        gaps = [
            float(x - mpmath.mpf(float(y))) for x, y in zip(exact, law.coefficient, strict=True)
        ]
    assert np.all(np.abs(gaps) <= law.error)
    return law.error, gaps
