"""Frequencies from beam elements: order of convergence by slope, against independent references."""

import numpy as np
import pytest
import scipy.linalg
from beam_reference import cantilever, pinned, timoshenko
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.frequencies import element_matrices
from orders import slopes

SUPPORTS = {"pinned": {"O": ("x", "y"), "P": ("y",)}, "cantilever": {"O": ("x", "y", "rotation")}}


def frequencies(kind, count, support, **changes):
    """Return those of a bar of unit length, mass and bending stiffness in equal elements."""
    numbers = {"area": 1.0, "second_moment": 1e-4, "modulus": 1e4, "density": 1.0, **changes}
    structure = frame(
        {"O": (0.0, 0.0), "P": (1.0, 0.0)},
        {"bar": ("O", "P")},
        Section(**numbers),
        supports=SUPPORTS[support],
        elements=count,
        kind=kind,
    )
    mass, stiffness, _ = element_matrices(structure, inextensible=True)
    return np.sqrt(scipy.linalg.eigvalsh(stiffness, mass))


# The square of a frequency errs by the square of the curvature's error: 2 (p - 1) with degree p.
CASES = [
    ("cubic", 4, 2, (8, 16, 32), 0.1),
    ("internal_node", 8, 3, (6, 8, 10, 12), 0.25),
    ("curvature", 8, 3, (10, 12, 14), 0.25),
]


@pytest.mark.parametrize(("support", "reference"), [("pinned", pinned), ("cantilever", cantilever)])
@pytest.mark.parametrize(("kind", "order", "mode", "counts", "margin"), CASES)
def test_order_of_the_squared_frequency(kind, order, mode, counts, margin, support, reference):
    exact = reference(mode) ** 2
    found = np.array([frequencies(kind, n, support)[mode - 1] ** 2 for n in counts])
    errors = found / exact - 1.0
    assert np.all(errors > 0)  # Rayleigh: from above
    np.testing.assert_allclose(-slopes(counts, errors), order, atol=margin)


@pytest.mark.parametrize(("ratio", "slimness", "order"), [(1e-9, 1e-9, 4.0), (0.03, 0.01, 2.0)])
def test_timoshenkos_beam_does_not_lock(ratio, slimness, order):
    """Slender: fourth order.  Thick: second, for the angle of shear is constant in an element."""
    exact = timoshenko(1, ratio, slimness) ** 2
    counts = (8, 16, 32)
    changes = {"second_moment": slimness, "modulus": 1.0 / slimness, "shear_stiffness": 1.0 / ratio}
    found = [frequencies("timoshenko", n, "pinned", **changes)[0] ** 2 for n in counts]
    errors = np.array(found) / exact - 1.0
    np.testing.assert_allclose(-slopes(counts, errors), order, atol=0.1)
    assert 0 < errors[0] < ratio / 10 + 1e-4
