"""Frequencies from beam elements: order of convergence by slope, against independent references."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from beam_reference import cantilever, pinned, rotating, timoshenko
from elastolink.runtime.beams.elements import NODAL_VALUES, element_arrays
from orders import slopes

HELD = {"pinned": ("u0", "v0", "vn"), "cantilever": ("u0", "v0", "r0"), "free": ()}


def assembled(kind, count, support="cantilever", speed=0.0, without=(), **changes):
    """Return mass, coupling, centripetal, stiffness of a beam of unit length of equal elements.

    The tension of a steady rotation about its first end is part of the stiffness.
    """
    numbers = {"mass_per_length": 1.0, "axial_stiffness": 1e4, "bending_stiffness": 1.0, **changes}
    h = 1.0 / count
    arrays = element_arrays(kind, length=h, **numbers)
    nodes = [[f"{name}{i}" for name in "uvr"] for i in range(count + 1)]
    nodes = [[*node, f"k{i}"] if kind == "curvature" else node for i, node in enumerate(nodes)]
    inner = [[f"v{i}m", f"r{i}m"] if kind == "internal_node" else [] for i in range(count)]
    names = [name for node in nodes for name in node] + [name for more in inner for name in more]
    at = {name: place for place, name in enumerate(names)}
    whole = np.zeros((4, len(names), len(names)))
    for e in range(count):
        local = [
            nodes[e + int(n[1]) - 1]["uvrk".index(n[0])] if n[1] != "3" else n[0] + f"{e}m"
            for n in NODAL_VALUES[kind]
        ]
        rows = np.ix_([at[name] for name in local], [at[name] for name in local])
        a = e * h
        tension = speed**2 / 2 * np.array([1 - a**2, -2 * a * h, -(h**2)])
        stiffness = arrays.stiffness + np.tensordot(tension, arrays.geometric, 1)
        for k, m in enumerate((arrays.mass, arrays.coupling, arrays.centripetal, stiffness)):
            whole[k][rows] += m
    held = {name.replace("n", str(count)) for name in HELD[support]} | set(without)
    kept = [at[n] for n in names if n not in held and not (without == "u" and n[0] == "u")]
    return whole[:, kept][:, :, kept]


def frequencies(kind, count, support, **changes):
    mass, _, _, stiffness = assembled(kind, count, support, without="u", **changes)
    return np.sqrt(scipy.linalg.eigvalsh(stiffness, mass))


def whirling(kind, count, speed, **changes):
    """Return the frequencies of a turning beam, Coriolis and centripetal forces included."""
    mass, coupling, centripetal, stiffness = assembled(kind, count, speed=speed, **changes)
    n = len(mass)
    spring = stiffness - speed**2 * centripetal
    left = np.block([[np.zeros((n, n)), np.eye(n)], [-spring, -2 * speed * coupling]])
    roots = scipy.linalg.eigvals(left, scipy.linalg.block_diag(np.eye(n), mass))
    assert np.max(np.abs(roots.real)) < 1e-7 * np.max(np.abs(roots))
    return np.sort(roots.imag[roots.imag > 0])


# The square of a frequency errs by the square of the curvature's error: 2 (p - 1) with degree p.
CASES = [
    ("cubic", 4, 2, (8, 16, 32), 0.1),
    ("internal_node", 8, 3, (6, 8, 10, 12), 0.25),
    ("curvature", 8, 3, (6, 8, 10, 12), 0.25),
]


@pytest.mark.parametrize(("support", "reference"), [("pinned", pinned), ("cantilever", cantilever)])
@pytest.mark.parametrize(("kind", "order", "mode", "counts", "margin"), CASES)
def test_order_of_the_squared_frequency(kind, order, mode, counts, margin, support, reference):
    exact = reference(mode) ** 2
    found = np.array([frequencies(kind, n, support)[mode - 1] ** 2 for n in counts])
    errors = found / exact - 1.0
    assert np.all(errors > 0)  # Rayleigh: from above
    np.testing.assert_allclose(-slopes(counts, errors), order, atol=margin)


# ---------------------------------------------------------------- shear and rotary inertia


@pytest.mark.parametrize(("ratio", "slimness", "order"), [(1e-9, 1e-9, 4.0), (0.03, 0.01, 2.0)])
def test_timoshenkos_beam_does_not_lock(ratio, slimness, order):
    """Slender: fourth order.  Thick: second, for the angle of shear is constant in an element."""
    exact = timoshenko(1, ratio, slimness) ** 2
    counts = (8, 16, 32)
    changes = {"shear_stiffness": 1.0 / ratio, "rotary_inertia": slimness}
    found = [frequencies("timoshenko", n, "pinned", **changes)[0] ** 2 for n in counts]
    errors = np.array(found) / exact - 1.0
    np.testing.assert_allclose(-slopes(counts, errors), order, atol=0.1)
    assert 0 < errors[0] < ratio / 10 + 1e-4


# ---------------------------------------------------------------- rotation


def test_turning_beam_converges_with_fourth_order_while_stretch_is_stiff():
    speed, counts = 6.0, (8, 16, 32)
    exact = rotating(speed, 1e10, 4.3) ** 2
    found = np.array([whirling("cubic", n, speed, axial_stiffness=1e10)[0] ** 2 for n in counts])
    np.testing.assert_allclose(-slopes(counts, np.abs(found / exact - 1)), 4.0, atol=0.1)


def test_a_soft_stretch_brings_the_axial_elements_second_order():
    """Linear along the axis: a quintic element does not help where stretch takes part."""
    speed, counts = 3.0, (4, 8, 16)
    guess = whirling("curvature", 24, speed, axial_stiffness=200.0)[0]
    exact = rotating(speed, 200.0, float(guess)) ** 2
    found = [whirling("curvature", n, speed, axial_stiffness=200.0)[0] ** 2 for n in counts]
    errors = np.abs(np.array(found) / exact - 1)
    np.testing.assert_allclose(-slopes(counts, errors), 2.0, atol=0.1)
