"""Helpers of the tests of unstable regions: systems, a region, a line of multipliers."""

import elastolink as el
import numpy as np
from elastolink.runtime.systems.rod import rod_system
from free_free_loads import ROD

RIG = "smith_1972_5152_sixteenth_inch"


def rig(**overrides):
    """Return Smith's 1/16 in rig."""
    return el.load_scene(RIG, overrides=overrides).system()


def flexible_rod(basis, crank_ratio=0.1, **changes):
    """Return Beale & Scott's very flexible rod."""
    return rod_system(basis, crank_ratio=crank_ratio, **ROD, **changes)


def scene_rod(crank_ratio=0.2, modes=2, **more):
    """Return the linear system of the same rod's scene."""
    changes = {"links.crank_ratio": crank_ratio, "model.modes": modes, **more}
    return el.load_scene("beale_1992_flexible_rod", overrides=changes).linear_system()


def region_of(found, kind, harmonic):
    """Return the place of the first region of a kind and harmonic."""
    for i, label in enumerate(found.kind):
        if label == kind and found.harmonic[i] == harmonic:
            return i
    raise AssertionError((kind, harmonic, found.labels))


def contradictions(system, found, speeds):
    """Return how many speeds of a line lie within a region and are stable, or the other way."""
    direct = el.floquet_multipliers(system, speeds)
    grows = np.any(np.abs(direct.multipliers) > 1 + 4 * direct.error, axis=-1)
    begin = np.where(np.isnan(found.lower), -np.inf, found.lower) - found.error
    end = np.where(np.isnan(found.upper), np.inf, found.upper) + found.error
    inside = np.any((speeds[:, None] >= begin) & (speeds[:, None] <= end), axis=1)
    return int(np.sum(grows != inside))
