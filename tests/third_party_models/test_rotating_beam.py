"""The linear-periodic family, many modes: a blade of emitted elements, joined at run time."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families import LinearPeriodic, array_function
from periodic_systems import second_order, system_of

UNIT = {
    "mass_per_length": 1.0,
    "axial_stiffness": 400.0,
    "lag_stiffness": 1.0,
    "flap_stiffness": 1.0,
    "damping": 1.0,
}
LABELS = ("u", "v", "v_slope", "w", "w_slope")
# Element degrees of freedom as (node of the element, label of the node).
PLACES = [(0, 0), (1, 0), (0, 1), (0, 2), (1, 1), (1, 2), (0, 3), (0, 4), (1, 3), (1, 4)]


@pytest.fixture(scope="module")
def element(emit):
    found = emit("rotating_beam_element", ModelSpec("rotating_beam", "element"))
    return array_function(found.module, "element")


def joined(matrices: np.ndarray) -> np.ndarray:
    """Sum element arrays ``(count, 10, columns)`` up over the nodes; node 0 is clamped."""
    count = len(matrices)
    place = np.array([[5 * (e + node) + label for node, label in PLACES] for e in range(count)])
    size = 5 * (count + 1)
    if matrices.shape[-1] == 1:
        vector = np.zeros(size)
        np.add.at(vector, place, matrices[..., 0])
        return vector[5:]
    matrix = np.zeros((size, size))
    np.add.at(matrix, (place[:, :, None], place[:, None, :]), matrices)
    return matrix[5:, 5:]


def blade(element, count: int = 2) -> LinearPeriodic:
    """Return a clamped blade of unit length on a hub of no radius."""
    length = np.full(count, 1.0 / count)
    inner = np.arange(count) / count

    def arrays(*tension):
        return {k: joined(v) for k, v in element(length, inner, *tension, **UNIT).items()}

    whole = arrays(0.0, 0.0, 0.0)
    # Of unit density and damping per length.
    np.testing.assert_allclose(whole["C"], whole["M"], rtol=1e-14)
    # mu w^2 (1 - r^2)/2 of the rotation
    spun = arrays((1 - inner**2) / 2, -inner * length, -(length**2) / 2)["Kg"]
    return system_of(Kg=(None, spun, 2), **{name: whole[name] for name in "MABKf"})


def flap_frequencies(system: LinearPeriodic, speed: float) -> np.ndarray:
    k, _, m, _ = (part[0] for part in second_order(system, 0.0, speed))
    rows = [i for i in range(system.size) if LABELS[i % 5].startswith("w")]
    return np.sqrt(scipy.linalg.eigvalsh(k[np.ix_(rows, rows)], m[np.ix_(rows, rows)]))


# ``w'''' - speed^2/2 ((1 - x^2) w')' = omega^2 w``, clamped and free: the two lowest by the power
# series about the hub in 40 digits.  To 4 decimals they are those of Wright, Smith, Thresher and
# Wang 1982, uniform beam without hub.
@pytest.mark.parametrize(
    ("speed", "exact"),
    [
        (0, (3.5160152685, 22.0344915647)),
        (3, (4.7972785324, 23.3202636743)),
        (6, (7.3603730193, 26.8090816785)),
        (12, (13.1701504875, 37.6031123312)),
    ],
)
def test_flap_frequencies_against_the_power_series(element, speed, exact):
    fine = flap_frequencies(blade(element, 24), float(speed))[:2]
    np.testing.assert_allclose(fine, exact, rtol=2e-6)
    # Two elements: Rayleigh's bound from above, within the cubic's error.
    excess = flap_frequencies(blade(element), float(speed))[:2] / exact - 1.0
    assert np.all(excess > 0.0)
    assert np.all(excess < 1.2e-2)


def test_stretch_of_the_steady_rotation(element):
    system, speed = blade(element, 8), 0.5
    k, _, _, force = (part[0] for part in second_order(system, 0.0, speed))
    steady = np.linalg.solve(k, force)
    # u'' = -w^2 (r + u)/EA by hand: u = sin(kr)/(k cos k) - r, k = w/sqrt(EA)
    wave = speed / np.sqrt(UNIT["axial_stiffness"])
    tip = np.sin(wave) / (wave * np.cos(wave)) - 1.0
    assert steady[5 * 7 + LABELS.index("u")] == pytest.approx(tip, rel=2e-3)
