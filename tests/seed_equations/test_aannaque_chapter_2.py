"""Aannaque (2.1): the equation of the whole mechanism, from (4.28) element by element."""

import numpy as np
from elastolink import load_scene
from elastolink.runtime.beams.assembly import AngleArrays
from seed_ledger import establishes


def rotation(angle):
    """Return R of (4.26) in the element's own order: u, v and rotation at both ends."""
    whole = np.eye(6)
    c, s = np.cos(angle), np.sin(angle)
    for node in (0, 3):
        whole[node : node + 2, node : node + 2] = [[c, s], [-s, c]]
    return whole


@establishes(
    "Aannaque",
    "2.1",
    printed=r"M\ddot q + (M_c + C)\dot q + (K + M_a) q = p - M\ddot q_r",
    verdict="agrees",
    remark="With M_c, M_a as in (4.28), at any crank speed and acceleration; geometric stiffness "
    "is left out, 11 % of the response at 20 rad/s.",
)
def test_the_whole_equation_is_the_sum_of_the_elements():
    """Compare the family's G and td^2 H + tdd E with (4.28) by second derivatives of R."""
    changes = {"mesh.elements": 2, "model.drop": ["geometric_stiffness"], "damping.ratio": 0.0}
    system = load_scene("aannaque_1996_table_4_1", overrides=changes).system()
    structure = system.structure
    arrays = AngleArrays(structure)
    theta, speed, acceleration, h = 0.7, 3.0, -5.0, 1e-4
    motion = structure.configuration(np.array([theta]))
    coriolis, convected = (np.zeros((arrays.count, arrays.count)) for _ in range(2))
    quarter = np.pi / 2
    for placed, own in arrays.local:
        link = motion[placed.beam.name]
        angle = float(link.angle[0])
        rate = speed * float(link.speed[0])
        hurry = acceleration * link.speed[0] + speed**2 * link.angular_acceleration[0]
        r = rotation(angle)
        # A quarter turn more is the derivative by the angle, of what turns.
        turned = rotation(angle + quarter)
        turned[[2, 5], [2, 5]] = 0.0
        straight = r.copy()
        straight[[2, 5], [2, 5]] = 0.0
        first, second = rate * turned, hurry * turned - rate**2 * straight
        m_c, m_a = rate * own.coupling, hurry * own.coupling - rate**2 * own.mass
        at = np.ix_(placed.indices, placed.indices)
        coriolis[at] += 2 * (r.T @ m_c @ r + r.T @ own.mass @ first)
        convected[at] += r.T @ m_a @ r + 2 * r.T @ m_c @ first + r.T @ own.mass @ second
    free = np.ix_(arrays.free, arrays.free)
    angles = theta + h * np.arange(-3, 4)
    weights = np.array([-1, 9, -45, 0, 45, -9, 1]) / (60 * h)
    mass, drift = (system.array(name, angles) for name in ("M", "A"))
    slope = np.einsum("t,tij->ij", weights, mass)
    changing = np.einsum("t,tij->ij", weights, drift)
    a, b = drift[3], system.array("B", [theta])[0]
    gyroscopic = speed * (slope + a - a.T)
    rest = speed**2 * (changing - b) + acceleration * a
    # Sixth-order differences with steps of 1e-4: round-off 1e-11 of the arrays.
    for found, expected in ((gyroscopic, coriolis[free]), (rest, convected[free])):
        scale = np.max(np.abs(expected))
        np.testing.assert_allclose(found, expected, atol=1e-9 * scale)
