"""The quick-return of beams against the flexible rod on a fixed mesh, from rest."""

import numpy as np
import pytest
from elastolink.runtime.beams import Section, beam_linkage, linear_system
from elastolink.runtime.linkages import QuickReturn
from marching import marched
from rod_reference import CASES, TIPS

NAME = "flexible, ratio 0.2, 300 rad/s"


def _error(elements, kind, steps, tension=True):
    """Return the error of the tip's deflection over its peak, at eight angles of a revolution."""
    rod = CASES[NAME]
    # Stretch, which the reference does not have, is kept out of reach.
    area, stiffer = 0.05**2, 100.0
    rods = Section(
        area=area,
        second_moment=rod.bending_stiffness / 0.7e11 / stiffer,
        modulus=0.7e11 * stiffer,
        density=rod.mass_per_length / area,
    )
    crank = Section(area=0.02, second_moment=2e-4, modulus=0.7e12, density=2700.0)
    linkage = QuickReturn(frame=rod.frame, crank=rod.crank, rod=rod.length)
    structure = beam_linkage(
        linkage, {"crank": crank, "rod": rods}, elements={"crank": 1, "rod": elements}, kind=kind
    )
    system = linear_system(structure, geometric_stiffness=tension)
    moved = marched(3, system, rod.speed, steps, 1)[steps // 8 :: steps // 8]
    angle = linkage.motion(np.arange(1, 9) * np.pi / 4).theta4
    x, y = (moved[:, structure.labels.index(label)] for label in ("C.x", "C.y"))
    tip = (np.cos(angle) * y - np.sin(angle) * x) / rod.length
    exact = TIPS[NAME, tension]
    return np.max(np.abs(tip - exact)) / np.max(np.abs(exact))


@pytest.mark.slow
def test_the_tip_converges_to_that_of_the_fixed_mesh():
    errors = [_error(n, "cubic", 200) for n in (2, 4, 8)]
    # Third order on the whole (16 elements: 1.2e-4), though not from mesh to mesh: the contact
    # force makes v''' jump within an element, and its place there matters.
    assert errors[1] < errors[0] / 5 and errors[2] < errors[1] / 3, errors
    assert errors[2] < 1.5e-3, errors
    assert _error(6, "curvature", 200) < 3e-4


@pytest.mark.parametrize("tension", [True, False])
def test_centrifugal_tension_is_the_geometric_stiffness(tension):
    assert _error(4, "cubic", 200, tension) < 8e-3
