"""The package's emitted forces of the four-bar against this ledger's Newton and Euler."""

from inspect import signature

import numpy as np
import pytest
from elastolink.generated import four_bar_forces
from seed_rigid import SMITH_LENGTHS, Link, forces, motion
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK

SPEED, UNSTEADY, COUNT = 10.0, 0.2, 1024
LINKS = (Link(0.7, 1.3, 4.0, 0.4), Link(1.1, 2.7, 9.0, -0.8), Link(0.9, -1.6, 6.5, 0.5))
KINDS = [
    (SMITH_LENGTHS, "open"),
    (SMITH_LENGTHS, "crossed"),
    (CRANK_ROCKERS["5,1,5,2"], "open"),
    (LONG_CRANK, "crossed"),
    (DRAG_LINK, "open"),
]


def emitted(lengths, assembly, kernel="forces"):
    """Return what a kernel of the emitted module gives along the uneven turn, by name."""
    m = motion(lengths, assembly, COUNT, UNSTEADY)
    given = {
        "theta2": m.theta2,
        "speed": SPEED * m.omega2,
        "acceleration": SPEED**2 * m.alpha2,
        "assembly": 1.0 if assembly == "open" else -1.0,
        "winding": float(lengths[1] > lengths[0]),
    }
    given |= dict(zip(("frame", "crank", "coupler", "follower"), lengths, strict=True))
    for number, link in zip("234", LINKS, strict=True):
        for name in ("mass", "along", "across", "inertia"):
            given[name + number] = getattr(link, name)
    function = getattr(four_bar_forces, kernel)
    found = function(*(given[name] for name in signature(function).parameters))
    found = found if isinstance(found, tuple) else (found,)
    return dict(zip(four_bar_forces.RETURNS[kernel], found, strict=True))


@pytest.mark.parametrize(("lengths", "assembly"), KINDS)
def test_emitted_forces(lengths, assembly):
    true = forces(lengths, LINKS, SPEED, assembly, UNSTEADY, COUNT)
    found = emitted(lengths, assembly)
    size = np.abs(true.f12).max()
    for pin in ("12", "23", "34", "41"):
        ours = found["x" + pin] + 1j * found["y" + pin]
        assert np.abs(ours - getattr(true, "f" + pin)).max() < 2e-8 * size
    shaking = found["shaking_x"] + 1j * found["shaking_y"]
    assert np.abs(shaking - true.shaking_force).max() < 2e-8 * size
    size *= sum(lengths)
    assert np.abs(found["torque"] - true.torque).max() < 2e-8 * size
    assert np.abs(found["shaking_moment"] + true.momentum_rate).max() < 2e-8 * size


@pytest.mark.parametrize(
    "kernel", ["pin_forces", "driving_torque", "shaking_force", "shaking_moment"]
)
def test_each_kernel_by_its_own_route(kernel):
    whole = emitted(SMITH_LENGTHS, "open")
    for name, values in emitted(SMITH_LENGTHS, "open", kernel).items():
        assert np.allclose(values, whole[name], rtol=1e-10, atol=1e-10 * np.abs(whole[name]).max())
