"""Aannaque (4.32)-(4.41): damping, modal coordinates, stiffening, frequencies at a standstill."""

import numpy as np
import pytest
import scipy.linalg
import sympy as sp
from elastolink.runtime.beams.elements import element_arrays
from elastolink.runtime.linkages import FourBar
from seed_elements import L, arrays, integral, letters, same, shape_rows, symmetric
from seed_ledger import establishes

# Table 4.1: the follower, 0.525 m; its first frequency pinned at both ends, 168 rad/s.
FOLLOWER = {"mass": 7850.0 * 78.75e-6, "bending": 210e9 * 65.12e-12, "length": 0.525}
LINKAGE = FourBar(frame=0.547, crank=0.170, coupler=0.328, follower=0.525)
SPEED = 62.0
# Angular speed and acceleration of the follower, (speed/frequency)^2, speed/frequency.
SIZES = (28.07, 2360.0, 0.0278, 0.1667)
# What (4.35) as printed loses over a turn of two springs.
LOST = 0.96


def follower_frequency():
    return (np.pi / FOLLOWER["length"]) ** 2 * np.sqrt(FOLLOWER["bending"] / FOLLOWER["mass"])


def turning():
    """Return the largest angular speed and acceleration of the follower at 62 rad/s."""
    motion = LINKAGE.motion(np.linspace(0.0, 2 * np.pi, 721))
    return (
        SPEED * float(np.max(np.abs(motion.omega4))),
        SPEED**2 * float(np.max(np.abs(motion.alpha4))),
    )


def pinned(count, *names):
    """Return arrays of a pinned beam without stretch, of unit length, mass and stiffness."""
    found = element_arrays(
        "cubic",
        length=1.0 / count,
        mass_per_length=1.0,
        axial_stiffness=1.0,
        bending_stiffness=1.0,
    )
    whole = np.zeros((len(names), 2 * count + 2, 2 * count + 2))
    bent = np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    for e in range(count):
        rows = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
        for array, name in zip(whole, names, strict=True):
            array[rows] += getattr(found, name).reshape(-1, 6, 6)[0][bent]
    kept = [i for i in range(2 * count + 2) if i not in (0, 2 * count)]
    return [array[np.ix_(kept, kept)] for array in whole]


@establishes(
    "Aannaque",
    "4.32",
    printed=r"M\ddot q + C\dot q + Kq = f',\; f' \text{ holding the right side of (4.31)}",
    verdict="approximation",
    derived=r"M\ddot q + (C + M_c)\dot q + (K + M_a)q = p_{ext} - M\ddot q_r",
    remark="The grouped right side holds the unknown. With it given, as from chapter 6 on, M_c and "
    "M_a are dropped: at 62 rad/s the follower turns at up to 28 rad/s and 2360 rad/s^2, and the "
    "centripetal term is 2.8 % of K in its first mode.",
)
def test_terms_on_the_right_side_are_not_known():
    speed, rate = turning()
    frequency = follower_frequency()
    assert frequency == pytest.approx(168.4, abs=0.1)
    assert speed == pytest.approx(SIZES[0], rel=0.01)
    assert rate == pytest.approx(SIZES[1], rel=0.01)
    # M_a = wd W - w^2 M: in a mode, w^2 M over K is (w/omega)^2.
    assert (speed / frequency) ** 2 == pytest.approx(SIZES[2], rel=0.02)
    mass, stiffness = pinned(4, "mass", "stiffness")
    values = scipy.linalg.eigvalsh(stiffness, mass)
    shifted = scipy.linalg.eigvalsh(stiffness - speed**2 / frequency**2 * values[0] * mass, mass)
    assert 1 - shifted[0] / values[0] == pytest.approx(SIZES[2], rel=0.02)


@establishes(
    "Aannaque",
    "4.33",
    printed=r"q = \Phi\eta",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.34",
    printed=r"\dot q = \Phi\dot\eta,\; \ddot q = \Phi\ddot\eta",
    verdict="approximation",
    derived=r"\dot q = \Phi\dot\eta + \dot\Phi\eta,\; "
    r"\ddot q = \Phi\ddot\eta + 2\dot\Phi\dot\eta + \ddot\Phi\eta",
    remark="Exact at a standstill. Over the cycle the modes change: one that turns with the "
    "follower at 62 rad/s drops up to 17 % of the rate of its first mode.",
)
@establishes(
    "Aannaque",
    "4.35",
    printed=r"\ddot\eta + \Phi^T C\Phi\dot\eta + [\omega^2]\eta = \Phi^T f'",
    verdict="approximation",
    derived=r"\ddot\eta + \Phi^T(C\Phi + 2M\dot\Phi)\dot\eta + "
    r"([\omega^2] + \Phi^T C\dot\Phi + \Phi^T M\ddot\Phi)\eta = \Phi^T f'",
    remark="Exact for constant modes of unit modal mass. In the example of the test, two springs "
    "that turn at 0.2 of the lower frequency, (4.35) is off by 96 % after one turn.",
)
def test_modal_coordinates_of_a_structure_that_turns():
    speed, _ = turning()
    assert speed / follower_frequency() == pytest.approx(SIZES[3], rel=0.02)
    mass, stiffness = pinned(4, "mass", "stiffness")
    values, modes = scipy.linalg.eigh(stiffness, mass)
    np.testing.assert_allclose(modes.T @ mass @ modes, np.eye(len(mass)), atol=1e-10)
    np.testing.assert_allclose(modes.T @ stiffness @ modes, np.diag(values), atol=1e-6 * values[-1])
    complete, printed, exact = turned_springs()
    np.testing.assert_allclose(complete, exact, rtol=1e-8)
    lost = np.linalg.norm(printed - exact) / np.linalg.norm(exact)
    assert lost == pytest.approx(LOST, rel=0.01)


def turned_springs(w=0.2):
    """Return q after a turn: modal with every term, modal as printed, and without modes.

    Unit mass on springs 1 and 9 along axes that turn with the rate w; its place is seen from
    the ground.
    """
    from scipy.integrate import solve_ivp

    square = np.diag([1.0, 9.0])
    spin = np.array([[0.0, -w], [w, 0.0]])

    def modes(t):
        return np.array([[np.cos(w * t), -np.sin(w * t)], [np.sin(w * t), np.cos(w * t)]])

    def ground(t, y):
        phi = modes(t)
        return np.concatenate([y[2:], -phi @ square @ phi.T @ y[:2]])

    def modal(t, y, whole):
        # Phi' = Phi spin
        extra = 2 * spin @ y[2:] + spin @ spin @ y[:2] if whole else 0.0
        return np.concatenate([y[2:], -square @ y[:2] - extra])

    end, start, rate = 2 * np.pi / w, np.array([1.0, 0.3]), np.array([0.2, -0.1])
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12}
    exact = solve_ivp(ground, (0, end), np.concatenate([start, rate]), **options).y[:2, -1]
    found = []
    for whole in (True, False):
        first = rate - spin @ start if whole else rate
        run = solve_ivp(modal, (0, end), np.concatenate([start, first]), args=(whole,), **options)
        found.append(modes(end) @ run.y[:2, -1])
    return found[0], found[1], exact


@establishes(
    "Aannaque",
    "4.36",
    printed=r"\phi_n^T C\phi_m = 0 \; (n \ne m),\; \phi_n^T C\phi_n = \alpha_n",
    verdict="agrees",
    derived=r"C M^{-1} K = K M^{-1} C;\; C = M\Phi\,[2\zeta_n\omega_n]\,\Phi^T M",
    remark="A demand on C, not a result; alpha_n = 2 zeta_n omega_n with unit modal masses.",
)
def test_damping_that_leaves_the_modes_apart():
    mass, stiffness = pinned(4, "mass", "stiffness")
    values, modes = scipy.linalg.eigh(stiffness, mass)
    omega = np.sqrt(values)
    modal = mass @ modes @ np.diag(2 * 0.02 * omega) @ modes.T @ mass
    rayleigh = 0.3 * mass + 1e-4 * stiffness
    point = np.zeros_like(mass)
    point[1, 1] = 1.0

    def apart(c):
        seen = modes.T @ c @ modes
        return np.linalg.norm(seen - np.diag(np.diag(seen))) / np.linalg.norm(seen)

    def commutes(c):
        one = c @ np.linalg.solve(mass, stiffness)
        return np.linalg.norm(one - one.T) / np.linalg.norm(one)

    for c in (modal, rayleigh):
        assert apart(c) < 1e-9 and commutes(c) < 1e-9
    assert apart(point) > 0.5 and commutes(point) > 0.1
    np.testing.assert_allclose(np.diag(modes.T @ modal @ modes), 2 * 0.02 * omega, rtol=1e-9)


# ---------------------------------------------------------------- stiffening


@establishes(
    "Aannaque",
    "4.37",
    printed=r"\varepsilon = B_1 q + \frac12 q^T B_n^T B_n q",
    verdict="agrees",
    derived=r"\sqrt{(1 + u_x)^2 + v_x^2} - 1 = u_x + \frac12 v_x^2 + O(3),\; B_n = N_2'",
    remark="To second order in the slopes.",
)
@establishes(
    "Aannaque",
    "4.38",
    printed=r"K_n = \int_0^L f_a B_n^T B_n\,dx",
    verdict="agrees",
    remark="Tension positive.",
)
def test_strain_of_a_deflected_beam():
    a, b, small = sp.symbols("a b small", real=True)
    stretch = sp.sqrt((1 + small * a) ** 2 + (small * b) ** 2) - 1
    series = sp.series(stretch, small, 0, 3).removeO()
    assert sp.expand(series - small * a - small**2 * b**2 / 2) == 0
    slope = shape_rows("cubic")[1].diff(sp.Symbol("zeta", real=True)) / L
    assert same(arrays("cubic")["geometric_0"], integral(slope, L))


@establishes(
    "Aannaque",
    "4.39",
    printed=r"K_n = \dots",
    verdict="not legible",
    derived=lambda: letters(30 * L * arrays("cubic")["geometric_0"]) + r"\cdot\frac{f_a}{30L}",
    remark="The scan has lost it; this is for a constant axial force. One that varies has further "
    "matrices.",
)
def test_geometric_stiffness_by_buckling():
    """Known entries; and the load of Euler from above, 12 instead of pi^2 with one element."""
    found = arrays("cubic")["geometric_0"]
    known = [[36, 3 * L, -36, 3 * L], [4 * L**2, -3 * L, -(L**2)], [36, -3 * L], [4 * L**2]]
    assert same(found[2:, 2:], symmetric(known) / (30 * L))
    assert found[:2, :].is_zero_matrix
    for count, expected, margin in ((1, 12.0, 1e-12), (8, np.pi**2, 1e-4)):
        stiffness, geometric = pinned(count, "stiffness", "geometric")
        load = 1 / scipy.linalg.eigvalsh(geometric, stiffness)[-1]
        assert load == pytest.approx(expected, rel=margin)
        assert load >= np.pi**2


# ---------------------------------------------------------------- frequencies


@establishes(
    "Aannaque",
    "4.40",
    printed=r"(K - \omega^2 M)\,q = 0",
    verdict="agrees",
    remark="At a standstill; in motion the terms of (4.31) belong to it.",
)
@establishes(
    "Aannaque",
    "4.41",
    printed=r"\dots = 0",
    verdict="not legible",
    derived=r"\det(K - \omega^2 M) = 0",
    remark="The scan has lost it; the sentence before names it the characteristic equation.",
)
def test_free_vibration_at_a_standstill():
    mass, stiffness = pinned(6, "mass", "stiffness")
    values, modes = scipy.linalg.eigh(stiffness, mass)
    scale = np.linalg.det(stiffness)
    for value, mode in zip(values[:3], modes.T[:3], strict=True):
        residual = stiffness @ mode - value * mass @ mode
        assert np.linalg.norm(residual) < 1e-9 * np.linalg.norm(stiffness @ mode) + 1e-9
        # The determinant changes its sign there.
        signs = [np.linalg.det(stiffness - value * f * mass) / scale for f in (0.999, 1.001)]
        assert signs[0] * signs[1] < 0
    assert np.sqrt(values[0]) == pytest.approx(np.pi**2, rel=1e-4)
    exact = np.pi**2 * np.arange(1, 4) ** 2
    assert np.all(np.sqrt(values[:3]) >= exact)
