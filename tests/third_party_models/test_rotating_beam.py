"""The linear-periodic family, many modes: a blade of emitted elements, joined at run time."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families import LinearPeriodic, Term, array_function
from elastolink.runtime.periodic import floquet_multipliers, simulate
from scipy.integrate import solve_ivp

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


def blade(
    element, count: int = 2, *, gravity=0.0, damping=0.0, forcing=False, **changes
) -> LinearPeriodic:
    """Return a clamped blade of unit length on a hub of no radius, its axis horizontal."""
    numbers = {**UNIT, **changes}
    length = np.full(count, 1.0 / count)
    inner = np.arange(count) / count

    def arrays(tension_0=0.0, tension_1=0.0, tension_2=0.0):
        return element(length, inner, tension_0, tension_1, tension_2, **numbers)

    whole = {name: joined(value) for name, value in arrays().items()}
    # mu w^2 (1 - r^2)/2 of the rotation, and -mu g (1 - r) cos theta of the weight
    spun = joined(arrays((1 - inner**2) / 2, -inner * length, -(length**2) / 2)["Kg"])
    hung = joined(arrays(-(1 - inner), length)["Kg"])
    terms = [Term(name, None, whole[name]) for name in ("M", "A", "B", "K")]
    terms += [
        Term("Kg", None, spun, power=2),
        Term("Kg", "gravity", lambda theta: np.cos(theta)[:, None, None] * hung),
        Term("C", "damping", whole["C"]),
    ]
    if forcing:
        terms.append(Term("f", None, whole["f"]))
    return LinearPeriodic(
        size=5 * count,
        terms=tuple(terms),
        parameters={"gravity": gravity, "damping": damping},
        scales=lambda values: {name: np.asarray(values[name]) for name in ("gravity", "damping")},
        labels=tuple(f"{label}{node + 1}" for node in range(count) for label in LABELS),
    )


def second_order(system: LinearPeriodic, speed: float, theta: float = 0.0):
    """Return M, the factor of qd, and that of q; every array but Kg is constant here."""
    m, a, b, c, k, kg = (
        system.array(name, theta, speed)[0] for name in ("M", "A", "B", "C", "K", "Kg")
    )
    return m, c + speed * (a - a.T), k + kg - speed**2 * b


def flap_frequencies(system: LinearPeriodic, speed: float) -> np.ndarray:
    m, _, k = second_order(system, speed)
    rows = [i for i, label in enumerate(system.labels) if label.startswith("w")]
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
    system = blade(element, 8, forcing=True)
    speed = 0.5
    _, _, k = second_order(system, speed)
    f = system.array("f", 0.0)[0]
    steady = np.linalg.solve(k, speed**2 * f)
    # u'' = -w^2 (r + u)/EA by hand: u = sin(kr)/(k cos k) - r, k = w/sqrt(EA)
    wave = speed / np.sqrt(UNIT["axial_stiffness"])
    tip = np.sin(wave) / (wave * np.cos(wave)) - 1.0
    assert steady[system.labels.index("u8")] == pytest.approx(tip, rel=2e-3)


def nearest(found: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest distance from a found number to an expected one, and the reverse."""
    distance = np.abs(found[:, None] - expected[None, :])
    return float(max(distance.min(axis=0).max(), distance.min(axis=1).max()))


def test_multipliers_under_gravity_against_plain_integration(element):
    system, speed = blade(element, gravity=9.0, damping=0.4), 5.0
    n = system.size

    def rate(t, y):
        m, first, k = second_order(system, speed, speed * t)
        q, qd = y.reshape(2, n, -1)
        return np.concatenate([qd, np.linalg.solve(m, -first @ qd - k @ q)]).ravel()

    period = 2 * np.pi / speed
    run = solve_ivp(rate, (0.0, period), np.eye(2 * n).ravel(), "DOP853", rtol=1e-10, atol=1e-11)
    expected = np.linalg.eigvals(run.y[:, -1].reshape(2 * n, 2 * n))
    found = floquet_multipliers(system, speed)
    assert found.checks["product"].passed
    assert nearest(found.multipliers, expected) < 1e-7
    start = np.linspace(-1.0, 1.0, n) * 1e-3
    moved = simulate(system, speed, 1.0, initial=(start, np.zeros(n)))
    final = run.y[:, -1].reshape(2 * n, 2 * n)[:, :n] @ start
    np.testing.assert_allclose(moved.q[-1], final[:n], atol=1e-9)
    np.testing.assert_allclose(moved.qd[-1], final[n:], atol=1e-7)
