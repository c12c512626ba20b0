"""The error of the distance to the nearest region, against multipliers of the changed machine."""

import elastolink as el
import numpy as np
from elastolink.runtime.design import stabilise
from honesty import covers
from scipy.optimize import brentq

SCENE = "smith_1972_5152_sixteenth_inch"
RANGE = (740.0 * np.pi / 30.0, 780.0 * np.pi / 30.0)


def test_distances_to_the_nearest_region():
    """That ends where the trace of the matrix of a turn is 2 in size: known to some 1e-12."""
    found = stabilise(el.load_scene(SCENE), RANGE, ["coupler.thickness", "links.coupler"])
    actual = []
    for change, distance in zip(found.changes, found.distance, strict=True):
        system = el.load_scene(SCENE, change.settings).system()

        def excess(speed, system=system):
            return abs(np.trace(el.monodromy(system, speed, rtol=1e-13).matrix)) - 2.0

        low, high = RANGE
        if "begins" in change.nearest:
            end = brentq(excess, high, high * (1.005 + distance), xtol=1e-14)
            actual.append(end / high - 1.0 - distance)
        else:
            end = brentq(excess, low * (0.995 - distance), low, xtol=1e-14)
            actual.append(1.0 - end / low - distance)
    assert np.all(found.error < 1e-12)
    covers(found.error + 2e-12, actual, least=4, median=np.inf)
