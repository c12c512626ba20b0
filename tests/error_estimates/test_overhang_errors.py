"""Error estimates of the overhang modes' frequencies, over random scenes."""

import mpmath
import numpy as np
import overhang_truth
from elastolink.runtime.systems.rod import OverhangBasis
from honesty import over_scenes


@over_scenes(81)
def test_frequencies(rng, monkeypatch):
    monkeypatch.setattr(overhang_truth, "DIGITS", 120)
    place = float(rng.choice([rng.uniform(0.03, 1.0), 1.0 - 10.0 ** rng.uniform(-9, -1)]))
    mode = int(rng.integers(1, 21))
    rod = {
        name: float(10.0 ** rng.uniform(-3, 3))
        for name in ("length", "bending_stiffness", "mass_per_length")
    }
    found = OverhangBasis(mode).frequencies(place, **rod)
    with mpmath.workdps(120):
        beta = overhang_truth.exact_root(place, mode)
        length, stiffness, mass = (mpmath.mpf(value) for value in rod.values())
        exact = beta**2 * mpmath.sqrt(stiffness / mass) / length**2
        return found.error[0, -1], float(exact - float(found.frequencies[0, -1]))


def test_the_basis_at_a_place_that_is_a_node():
    """The estimate of a root holds where both bays, held at the block, vibrate alike."""
    place = overhang_truth.NAMED["a node of slope"]
    roots = OverhangBasis(4).roots(np.array([place]))[0]
    for mode, root in enumerate(roots, start=1):
        exact = overhang_truth.exact_root(place, mode)
        assert abs(float(exact) - root) <= np.finfo(float).eps * root
