"""Aannaque (4.15)-(4.31): the moving element, its change to ground axes, the assembly."""

import numpy as np
import pytest
import sympy as sp
from elastolink.runtime.beams.elements import element_arrays, rigid_field, shape_functions
from seed_elements import L, arrays, integral, letters, rho, same, shape_rows, symmetric
from seed_ledger import establishes

NUMBERS = {
    "length": 0.4,
    "mass_per_length": 0.7,
    "axial_stiffness": 2e5,
    "bending_stiffness": 9.0,
}
ELEMENT = element_arrays("cubic", **NUMBERS)
J = np.array([[0.0, -1.0], [1.0, 0.0]])
# Gauss points integrate products of two shapes exactly.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(6)
XI, DX = (POINTS + 1) / 2, WEIGHTS * NUMBERS["length"] / 2


def turn(angle):
    """Return T of (4.15): components along and across the element to those along X and Y."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def rotation(angle):
    """Return R of (4.26), nodal values in the element's own order: ground to local."""
    whole = np.eye(6)
    for node in (0, 3):
        whole[node : node + 2, node : node + 2] = turn(angle).T
    return whole


def shapes():
    """Return N at the Gauss points, shape (points, 2, 6)."""
    return np.stack(shape_functions("cubic", XI, NUMBERS["length"]), axis=1)


def path(t):
    """Return origin, angle and local nodal values at a time: any smooth functions."""
    origin = np.array([0.3 * np.sin(2 * t), 0.2 * np.cos(3 * t)])
    angle = 0.4 + 1.1 * t + 0.3 * np.sin(1.7 * t)
    return origin, angle, 1e-2 * np.sin(np.arange(1, 7) + np.arange(2, 8) * t)


def derivative(function, t, order=1, h=1e-3):
    """Return a derivative by central differences of sixth order."""
    weights = {1: [-1, 9, -45, 0, 45, -9, 1], 2: [2, -27, 270, -490, 270, -27, 2]}[order]
    scale = {1: 60.0, 2: 180.0}[order]
    values = [w * function(t + k * h) for w, k in zip(weights, range(-3, 4), strict=True)]
    return sum(values) / (scale * h**order)


def places(t):
    """Return the ground positions of the Gauss points, straight from (4.15), shape (points, 2)."""
    origin, angle, q = path(t)
    local = shapes() @ q + np.stack([XI * NUMBERS["length"], 0 * XI], axis=-1)
    return origin + local @ turn(angle).T


def rates(t):
    """Return w, wd, q, qd, qdd and the nodal values of the rigid velocity and acceleration."""
    _, angle, q = path(t)
    w, wd = (derivative(lambda s: path(s)[1], t, k) for k in (1, 2))
    qd, qdd = (derivative(lambda s: path(s)[2], t, k) for k in (1, 2))
    ends = []
    for k in (1, 2):
        moved = [
            derivative(lambda s, a=a: path(s)[0] + turn(path(s)[1]) @ [a, 0.0], t, k)
            for a in (0.0, NUMBERS["length"])
        ]
        ends.append([turn(angle).T @ value for value in moved])
    velocity, acceleration = (
        rigid_field("cubic", *ends[i], spin) for i, spin in enumerate((w, wd))
    )
    return w, wd, q, qd, qdd, velocity, acceleration


TIME = 0.37


@establishes(
    "Aannaque",
    "4.15",
    printed=r"r = r_0 + T d",
    verdict="agrees",
    derived=r"T = \begin{bmatrix}\cos\theta & -\sin\theta\\ \sin\theta & \cos\theta\end{bmatrix}",
)
@establishes(
    "Aannaque",
    "4.16",
    printed=r"\dot r = \dot r_0 + \dot T d + T\dot d",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.17",
    printed=r"d = \dots",
    verdict="not legible",
    derived=r"d = N q,\; \dot d = N\dot q",
    remark="The scan has lost it; the sentence before says what it must be.",
)
@establishes(
    "Aannaque",
    "4.18",
    printed=r"\dot r_0 = T N \dot q_r",
    verdict="agrees",
    remark="With the local components of the true velocity of the ends, and the angular speed at "
    "both rotations, for the dotted vector; it is not the derivative of local coordinates.",
)
def test_velocity_of_a_point_of_the_moving_element():
    w, _, q, qd, _, velocity, _ = rates(TIME)
    angle = path(TIME)[1]
    n = shapes()
    found = n @ velocity + (n @ q) @ (w * J).T + n @ qd
    expected = derivative(places, TIME) @ turn(angle)
    np.testing.assert_allclose(found, expected, atol=1e-9)
    still = derivative(
        lambda t: path(t)[0] + np.stack([XI * 0.4, 0 * XI], axis=-1) @ turn(path(t)[1]).T, TIME
    )
    np.testing.assert_allclose(n @ velocity, still @ turn(angle), atol=1e-9)


def kinetic(q, qd, w, velocity):
    m, c, b = ELEMENT.mass, ELEMENT.coupling, ELEMENT.centripetal
    total = velocity @ m @ velocity + 2 * w * velocity @ c @ q + 2 * velocity @ m @ qd
    return (total + w**2 * q @ b @ q + 2 * w * qd @ c @ q + qd @ m @ qd) / 2


@establishes(
    "Aannaque",
    "4.19",
    printed=r"T = \frac12\int_0^L \rho A\,\dot r^T\dot r\,dx",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.20",
    printed=r"T = \frac12\int_0^L\rho A(\dot q_r^T N^T N\dot q_r + "
    r"2\dot q_r^T N^T T^T\dot T N q + \dots)\,dx",
    verdict="not legible",
    derived=r"\dot q_r^T N^T N\dot q_r + 2\dot q_r^T N^T T^T\dot T N q + 2\dot q_r^T N^T N\dot q + "
    r"q^T N^T\dot T^T\dot T N q + 2\dot q^T N^T T^T\dot T N q + \dot q^T N^T N\dot q",
    remark="The scan repeats one term and has products of three dotted T; six terms belong there.",
)
def test_kinetic_energy_has_six_terms():
    w, _, q, qd, _, velocity, _ = rates(TIME)
    speeds = derivative(places, TIME)
    expected = 0.5 * 0.7 * DX @ np.sum(speeds**2, axis=-1)
    assert kinetic(q, qd, w, velocity) == pytest.approx(expected, rel=1e-9)
    # The term that the scan repeats, counted twice, is seen.
    twice = kinetic(q, qd, w, velocity) + w * velocity @ ELEMENT.coupling @ q
    assert abs(twice / expected - 1) > 1e-3


def inertia(t):
    """Return the generalised inertia forces of the points, by differences of their positions."""
    push = derivative(places, t, 2) @ turn(path(t)[1])
    return 0.7 * np.einsum("p,pc,pcn->n", DX, push, shapes())


@establishes(
    "Aannaque",
    "4.21",
    printed=r"M\ddot q + 2M_c\dot q + (M_a + K)q = p - M\ddot q_r",
    verdict="slip",
    derived=r"M\ddot q + 2M_c\dot q + (M_a + K)q = p - M a_r,\; "
    r"a_r = \ddot q_r + T^T\dot T\dot q_r \text{ at the displacements}",
    remark="The derivative of the dotted vector of (4.18) is not the acceleration: for a bar that "
    "turns steadily about its end at 1 rad/s it is 0, and the centripetal -1 m/s^2 per metre is "
    "lost. Right with the components of the true acceleration.",
)
def test_equation_of_the_moving_element():
    w, wd, q, qd, qdd, velocity, acceleration = rates(TIME)
    m, c, b = ELEMENT.mass, ELEMENT.coupling, ELEMENT.centripetal
    left = m @ qdd + 2 * w * c @ qd + (wd * c - w**2 * b) @ q + m @ acceleration
    np.testing.assert_allclose(left, inertia(TIME), atol=1e-7)

    def local_velocity(t):
        return rates(t)[5]

    printed = derivative(local_velocity, TIME)
    for node in (0, 3):
        across = printed[node : node + 2] + w * J @ velocity[node : node + 2]
        np.testing.assert_allclose(across, acceleration[node : node + 2], atol=1e-6)
    assert np.linalg.norm(m @ (printed - acceleration)) > 0.05 * np.linalg.norm(m @ acceleration)
    # The bar of the remark: constant local velocities, yet an acceleration towards its end.
    steady = rigid_field("cubic", [0.0, 0.0], [-1.0, 0.0], 0.0)
    assert (ELEMENT.mass @ steady)[3] == pytest.approx(-0.7 * 0.4 / 3)


@establishes(
    "Aannaque",
    "4.22",
    printed=r"M = \int\rho A N^T N dx,\; M_c = \int\rho A N^T T^T\dot T N dx,\; "
    r"M_a = \int\rho A N^T T^T\ddot T N dx",
    verdict="agrees",
    derived=r"T^T\dot T = \dot\theta\begin{bmatrix}0 & -1\\1 & 0\end{bmatrix},\; "
    r"M_a = \ddot\theta\,\frac{M_c}{\dot\theta} - \dot\theta^2 M",
)
def test_matrices_of_the_moving_element():
    def turned(t):
        return turn(path(t)[1])

    w, wd, *_ = rates(TIME)
    first, second = (turned(TIME).T @ derivative(turned, TIME, k) for k in (1, 2))
    np.testing.assert_allclose(first, w * J, atol=1e-9)
    n = shapes()
    whole = [
        0.7 * np.einsum("p,pcn,cd,pdm->nm", DX, n, middle, n)
        for middle in (np.eye(2), first, second)
    ]
    np.testing.assert_allclose(whole[0], ELEMENT.mass, rtol=1e-12)
    np.testing.assert_allclose(whole[1], w * ELEMENT.coupling, atol=1e-9)
    expected = wd * ELEMENT.coupling - w**2 * ELEMENT.mass
    np.testing.assert_allclose(whole[2], expected, atol=1e-7)


@establishes(
    "Aannaque",
    "4.23",
    printed=r"M = \begin{bmatrix}M_1 & \\ & M_2\end{bmatrix}",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.24",
    printed=r"M_1 = \dots,\; M_2 = \dots",
    verdict="not legible",
    derived=lambda: letters(arrays("cubic")["mass"]),
    remark="The scan has lost both matrices; these are the consistent ones.",
)
def test_consistent_mass():
    mass = arrays("cubic")["mass"]
    assert mass[:2, 2:].is_zero_matrix
    along, across = shape_rows("cubic")
    assert same(mass[:2, :2], integral(along[:, :2], rho * L))
    assert same(mass[2:, 2:], integral(across[:, 2:], rho * L))
    known = [
        [156, 22 * L, 54, -13 * L],
        [4 * L**2, 13 * L, -3 * L**2],
        [156, -22 * L],
        [4 * L**2],
    ]
    assert same(mass[2:, 2:], rho * L / 420 * symmetric(known))
    assert same(mass[:2, :2], rho * L / 6 * sp.Matrix([[2, 1], [1, 2]]))


# ---------------------------------------------------------------- ground axes


@establishes(
    "Aannaque",
    "4.25",
    printed=r"\begin{Bmatrix}x_e\\y_e\end{Bmatrix} = \begin{bmatrix}\cos\theta & \sin\theta\\ "
    r"-\sin\theta & \cos\theta\end{bmatrix}\begin{Bmatrix}X\\Y\end{Bmatrix}",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.26",
    printed=r"q = R\,q_g,\; R = \begin{bmatrix}c & 0 & s & 0 & 0 & 0\\ 0 & c & 0 & 0 & s & 0\\ "
    r"-s & 0 & c & 0 & 0 & 0\\ 0 & 0 & 0 & 1 & 0 & 0\\ 0 & -s & 0 & 0 & c & 0\\ "
    r"0 & 0 & 0 & 0 & 0 & 1\end{bmatrix}",
    verdict="agrees",
    remark="Both axial displacements first, as in (4.14).",
)
def test_change_of_axes():
    c, s = np.cos(0.7), np.sin(0.7)
    printed = np.array(
        [
            [c, 0, s, 0, 0, 0],
            [0, c, 0, 0, s, 0],
            [-s, 0, c, 0, 0, 0],
            [0, 0, 0, 1, 0, 0],
            [0, -s, 0, 0, c, 0],
            [0, 0, 0, 0, 0, 1],
        ]
    )
    order = [0, 3, 1, 2, 4, 5]
    np.testing.assert_allclose(rotation(0.7)[np.ix_(order, order)], printed)
    np.testing.assert_allclose(printed @ printed.T, np.eye(6), atol=1e-15)
    # A vector along the element has no component across.
    np.testing.assert_allclose(turn(0.7).T @ [2 * c, 2 * s], [2.0, 0.0], atol=1e-15)


@establishes(
    "Aannaque",
    "4.27",
    printed=r"M_g\ddot q_g + K_g q_g = p_g - M_g\ddot q_{gr} - M_{gc}\dot q_g - M_{ga}q_g",
    verdict="agrees",
    remark="Along fixed axes the acceleration is the second derivative, so that the slip of (4.21) "
    "does not enter here.",
)
@establishes(
    "Aannaque",
    "4.28",
    printed=r"M_g = R^T M R,\; K_g = R^T K R,\; M_{gc} = 2(R^T M_c R + R^T M\dot R),\; "
    r"M_{ga} = R^T M_a R + 2R^T M_c\dot R + R^T M\ddot R",
    verdict="agrees",
)
def test_equation_along_fixed_axes():
    """Ground values of the same motion, differentiated as they are."""

    def ground(t):
        _, angle, q = path(t)
        return rotation(angle).T @ q

    def rigid(t):
        origin, angle, _ = path(t)
        end = origin + turn(angle) @ [NUMBERS["length"], 0.0]
        return np.concatenate([origin, [angle], end, [angle]])

    def turned(t):
        return rotation(path(t)[1])

    w, wd, *_ = rates(TIME)
    r, rd, rdd = turned(TIME), *(derivative(turned, TIME, k) for k in (1, 2))
    m, c = ELEMENT.mass, w * ELEMENT.coupling
    a = wd * ELEMENT.coupling - w**2 * ELEMENT.mass
    gyric = 2 * (r.T @ c @ r + r.T @ m @ rd)
    static = r.T @ a @ r + 2 * r.T @ c @ rd + r.T @ m @ rdd
    left = r.T @ m @ r @ (derivative(ground, TIME, 2) + derivative(rigid, TIME, 2))
    left += gyric @ derivative(ground, TIME) + static @ ground(TIME)
    np.testing.assert_allclose(left, r.T @ inertia(TIME), atol=1e-7)
    # The same from the energy: G = M' + A - A^T, with A = R^T M R' + R^T W R.
    energy = r.T @ m @ rd + r.T @ c @ r
    slope = rd.T @ m @ r + r.T @ m @ rd
    np.testing.assert_allclose(slope + energy - energy.T, gyric, atol=1e-9)


# ---------------------------------------------------------------- assembly


@establishes(
    "Aannaque",
    "4.29",
    printed=r"q_e = L_e q",
    verdict="agrees",
    remark="A row of zeros holds a displacement; rows of two elements with a one in the same "
    "column share it.",
)
@establishes(
    "Aannaque",
    "4.30",
    printed=r"M = \sum_e L_e^T M_e L_e,\; K = \sum_e L_e^T K_e L_e,\; \dots",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.31",
    printed=r"M\ddot q + Kq = p_{ext} - M\ddot q_r - M_c\dot q - M_a q",
    verdict="agrees",
    remark="For the links; lumped masses at joints add to M alone, and their own acceleration to "
    "the right side.",
)
def test_assembly_of_two_bars_at_a_pin():
    """Energies add up, and the forces at the pin cancel: static deflection of a two-bar truss.

    Both bars held at their feet but free to turn there, at +-45 degrees to the load's line: the
    tip moves by F L/(2 EA cos^2 45).
    """
    angles = (np.pi / 4, 3 * np.pi / 4)
    # Shared: x, y of the tip; own rotations at the feet and at the tip.
    columns = [{2: 2, 3: 0, 4: 1, 5: 3}, {2: 4, 3: 0, 4: 1, 5: 5}]
    mass, stiffness = np.zeros((6, 6)), np.zeros((6, 6))
    q = np.random.default_rng(3).normal(size=6)
    energies = np.zeros(2)
    for angle, chosen in zip(angles, columns, strict=True):
        selector = np.zeros((6, 6))
        for row, column in chosen.items():
            selector[row, column] = 1.0
        r = rotation(angle)
        own = [r.T @ matrix @ r for matrix in (ELEMENT.mass, ELEMENT.stiffness)]
        mass += selector.T @ own[0] @ selector
        stiffness += selector.T @ own[1] @ selector
        local = r @ selector @ q
        energies += [local @ ELEMENT.mass @ local, local @ ELEMENT.stiffness @ local]
    np.testing.assert_allclose([q @ mass @ q, q @ stiffness @ q], energies, rtol=1e-12)
    tip = np.linalg.solve(stiffness, [0.0, 1.0, 0, 0, 0, 0])
    assert tip[1] == pytest.approx(0.4 / (2 * 2e5 * 0.5), rel=1e-9)
    assert abs(tip[0]) < 1e-12 * tip[1] + 1e-20
