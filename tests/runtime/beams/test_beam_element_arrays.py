"""Beam elements at run time: shapes carry fields exactly, matrices are their energies, refusals."""

import numpy as np
import pytest
from elastolink.runtime.beams.elements import (
    KINDS,
    element_arrays,
)
from refusals import refused

LENGTH, BENDING, SHEAR = 0.3, 20.0, 4e4
STIFF = {"bending_stiffness": BENDING, "shear_stiffness": SHEAR}
NUMBERS = {"mass_per_length": 1.2, "axial_stiffness": 1e6, "rotary_inertia": 2e-4, **STIFF}


def arrays(kind, **changes):
    return element_arrays(kind, **{"length": LENGTH, **NUMBERS, **changes})


@pytest.mark.parametrize("kind", KINDS)
def test_matrices_have_their_shapes_and_cannot_be_written_to(kind):
    found = arrays(kind)
    n = 8 if kind in ("internal_node", "curvature") else 6
    assert found.mass.shape == found.coupling.shape == (n, n)
    assert found.geometric.shape == (3, n, n) and found.load.shape == (n, 4)
    with pytest.raises(ValueError, match="read-only"):
        found.mass[0, 0] = 1.0


def test_kinds_without_shear_do_not_use_its_numbers():
    bare = arrays("cubic", shear_stiffness=None, rotary_inertia=0.0)
    np.testing.assert_array_equal(arrays("cubic").mass, bare.mass)
    np.testing.assert_array_equal(arrays("cubic").stiffness, bare.stiffness)


test_unusable_input_is_refused = refused(
    lambda call: call(),
    [
        (lambda: arrays("cubic", length=0.0), "length"),
        (lambda: arrays("cubic", mass_per_length=-1.0), "mass_per_length"),
        (lambda: arrays("timoshenko", shear_stiffness=None), "shear_stiffness"),
        (lambda: arrays("timoshenko", rotary_inertia=-1.0), "rotary_inertia"),
    ],
)
