"""The rod in Buckens' frame: constraints, balances by quadrature, and the linear formulation."""

import free_free_loads
import numpy as np
import pytest
from elastolink.runtime.core.families import Constrained
from elastolink.runtime.systems.rod import FreeFreeBasis, free_free_rod

ROD = {"crank_ratio": 0.3, **free_free_loads.ROD, "length": 1.1}
SPEED = 140.0
DROPS = [(), ("tension",)]


def made(modes, drop=(), **changes):
    return free_free_rod(modes, **{**ROD, "speed": SPEED, **changes}, drop=drop)


def bent_state(rod, t, size=0.01, seed=0):
    """Return a state that meets the constraints with given amplitudes and their rates."""
    random = np.random.default_rng(seed)
    q, qd = rod.undeformed(t)
    n = np.arange(1, rod.modes.size + 1)
    q[3:] = size * random.normal(size=len(n)) / n**2
    qd[3:] = rod.speed * size * random.normal(size=len(n)) / n**2
    for _ in range(8):  # Newton's steps
        held = rod.violation(q, t)
        q[:3] -= np.linalg.solve(held["jacobian"][:, :3], held["constraints"][:, 0])
    at = rod.dynamics(q, qd, t)
    right = at["velocity_rhs"][:, 0] - at["jacobian"][:, 3:] @ qd[3:]
    qd[:3] = np.linalg.solve(at["jacobian"][:, :3], right)
    return q, qd


@pytest.mark.smoke
@pytest.mark.parametrize("drop", DROPS)
@pytest.mark.parametrize("modes", [1, 2, 5])
def test_the_undeformed_rod_meets_the_constraints(modes, drop):
    rod = made(modes, drop)
    assert isinstance(rod, Constrained)
    assert rod.labels == ("R1", "R2", "gamma", *(f"f{i}" for i in range(1, modes + 1)))
    theta = np.linspace(-7.0, 7.0, 40)
    q, qd = rod.undeformed(theta / rod.speed)
    at = rod.dynamics(q, qd, theta / SPEED)
    assert np.max(np.abs(rod.violation(q, theta / SPEED)["constraints"])) < 1e-14
    rates = (at["jacobian"] @ qd[..., None] - at["velocity_rhs"])[..., 0]
    assert np.max(np.abs(rates)) < 1e-13 * SPEED
    assert rod.period == pytest.approx(2 * np.pi / SPEED)


@pytest.mark.parametrize("drop", DROPS)
def test_the_modes_follow_the_block(drop):
    """Jacobians and variations against differences through the modes at the moving block.

    Central differences with a step of 1e-6 keep nine digits.
    """
    rod, t = made(3, drop), 0.013
    q, qd = bent_state(rod, t)
    qdd, lam = rod.accelerations(q, qd, t)

    def slopes(function, at, step=1e-6):
        moves = np.eye(len(at)) * step
        columns = [(function(at + h) - function(at - h)) / (2 * step) for h in moves]
        return np.stack(columns, axis=-1)

    def close(found, exact):
        assert np.max(np.abs(found - exact)) < 1e-7 * np.max(np.abs(exact))

    constraints = slopes(lambda x: rod.violation(x, t)["constraints"][:, 0], q)
    close(rod.dynamics(q, qd, t)["jacobian"], constraints)
    found = rod.variations(q, qd, qdd, lam, t)
    close(found["stiffness"], slopes(lambda x: residual(rod, x, qd, qdd, lam, t), q))
    # Quadratic in the velocities: differences are exact at any step.
    by_hand = slopes(lambda x: residual(rod, q, x, 0 * qdd, 0 * lam, t), qd, step=1.0)
    close(found["damping"], by_hand)

    def rate(x):
        a = rod.dynamics(x, qd, t)
        return a["jacobian"] @ qd - a["velocity_rhs"][:, 0]

    def acceleration(x):
        a = rod.dynamics(x, qd, t)
        return a["jacobian"] @ qdd - a["gamma"][:, 0]

    close(found["jacobian_rate"], slopes(rate, q))
    close(found["jacobian_acceleration"], slopes(acceleration, q))


def residual(rod, q, qd, qdd, lam, t):
    a = rod.dynamics(q, qd, t)
    return a["mass"] @ qdd + (a["rest"] - a["forces"])[:, 0] - a["jacobian"].T @ lam


def test_batches_and_single_states_agree():
    rod = made(2)
    theta = np.linspace(0.0, 6.0, 12).reshape(3, 4)
    q, qd = rod.undeformed(theta / rod.speed)
    q[..., 3:] = 1e-3
    t = theta / SPEED
    together, multipliers = rod.accelerations(q, qd, t)
    assert together.shape == (3, 4, 5)
    assert multipliers.shape == (3, 4, 3)
    for i in np.ndindex(3, 4):
        # In turns, so that nothing remembered from one state serves another.
        other = rod.accelerations(q[::-1, ::-1][i], qd[::-1, ::-1][i], t[::-1, ::-1][i])[0]
        alone = rod.accelerations(q[i], qd[i], t[i])[0]
        np.testing.assert_allclose(alone, together[i], rtol=1e-9)
        np.testing.assert_allclose(other, together[::-1, ::-1][i], rtol=1e-9)


class ByQuadrature:
    """Energy and momenta of the material points of the rod, tension left out."""

    def __init__(self, rod):
        x, weights = np.polynomial.legendre.leggauss(60)
        self.rod, self.s, self.weights = rod, x / 2, weights / 2
        self.shapes = rod.modes((1 + x) / 2)

    def points(self, q, qd):
        length = self.rod.linkage.rod
        along = np.array([np.cos(q[2]), np.sin(q[2])])[:, None]
        across = np.array([-np.sin(q[2]), np.cos(q[2])])[:, None]
        u, ud = length * self.shapes[0] @ q[3:], length * self.shapes[0] @ qd[3:]
        place = q[:2, None] + along * self.s * length + across * u
        speed = qd[:2, None] + across * (qd[2] * self.s * length + ud) - along * qd[2] * u
        return place, speed

    def integral(self, values):
        mass = ROD["mass_per_length"] * self.rod.linkage.rod
        return mass * np.sum(self.weights * values, axis=-1)

    def energy(self, q, qd):
        curvature = self.shapes[2] @ q[3:]
        bending = np.sum(self.weights * curvature**2) / self.rod.linkage.rod
        _, speed = self.points(q, qd)
        return self.integral(np.sum(speed**2, 0)) / 2 + ROD["bending_stiffness"] / 2 * bending

    def momenta(self, q, qd):
        """Return momentum, and moment of momentum about the pin."""
        place, speed = self.points(q, qd)
        turning = place[0] * speed[1] - place[1] * speed[0]
        return np.array([*self.integral(speed), self.integral(turning)])


@pytest.mark.parametrize("t", [0.0, 0.011, 0.031])
@pytest.mark.parametrize("modes", [1, 3, 5])
def test_newton_euler_and_the_power_of_the_crank(modes, t):
    """The block's force is normal to the bent rod; pin and block balance what the points do."""
    rod = made(modes, ("tension",))
    q, qd = bent_state(rod, t, seed=modes)
    qdd, lam = rod.accelerations(q, qd, t)
    points, step = ByQuadrature(rod), 1e-7

    def rate(function):
        ends = [function(q + h * qd + h * h / 2 * qdd, qd + h * qdd) for h in (step, -step)]
        return (ends[0] - ends[1]) / (2 * step)

    along = np.array([np.cos(q[2]), np.sin(q[2])])
    across = np.array([-along[1], along[0]])
    linkage, theta = rod.linkage, SPEED * t
    place = linkage.crank * np.cos(q[2] - theta) + linkage.frame * np.cos(q[2])
    slope = rod.modes(place / linkage.rod)[1] @ q[3:]
    force = lam[2] * (across - slope * along)
    pin = (lam[0] + lam[2] * slope) * along + lam[1] * across
    block = linkage.crank * np.array([np.cos(theta), np.sin(theta)]) + [linkage.frame, 0.0]
    moment = block[0] * force[1] - block[1] * force[0]
    changes = rate(points.momenta)
    scale = np.max(np.abs(lam))
    # Differences with this step keep seven digits of momenta that forces change within 1/speed.
    assert np.max(np.abs(changes - [*(force + pin), moment])) < 1e-6 * scale
    velocity = SPEED * linkage.crank * np.array([-np.sin(theta), np.cos(theta)])
    assert abs(rate(points.energy) - force @ velocity) < 1e-6 * scale * SPEED * linkage.crank


@pytest.mark.parametrize("drop", DROPS)
def test_the_crank_gives_the_energy(drop):
    """With the tension too; without it the energy is that of the material points."""
    rod, t, step = made(4, drop), 0.009, 1e-7
    q, qd = bent_state(rod, t, seed=3)
    qdd, lam = rod.accelerations(q, qd, t)
    ends = [rod.energy(q + h * qd + h * h / 2 * qdd, qd + h * qdd) for h in (step, -step)]
    power = lam[2] * rod.dynamics(q, qd, t)["velocity_rhs"][2, 0]
    assert abs((ends[0] - ends[1]) / (2 * step) - power) < 1e-6 * abs(power)
    if drop:
        exact = ByQuadrature(rod).energy(q, qd)
        assert rod.energy(q, qd) == pytest.approx(exact, rel=1e-12)
    assert rod.energy(np.stack([q, q]), np.stack([qd, 0 * qd]), np.array([t, t])).shape == (2,)


def test_deflection_is_measured_from_the_line_of_the_block():
    rod, t = made(3, ("tension",)), 0.017
    for size in (1e-3, 1e-4):
        q, _ = bent_state(rod, t, size)
        place = float(rod.linkage.motion(SPEED * t).slide) / ROD["length"]
        shapes = FreeFreeBasis(3).shapes(np.array([0.4, 1.0]), np.array([place]))[0]
        linear = ROD["length"] * shapes @ q[3:]
        found = rod.deflection(q, t, [0.0, place, 0.4, 1.0])
        # The pin exactly, all else to the order of what the linear formulation leaves out.
        assert abs(found[0]) < 1e-14
        assert abs(found[1]) < 100 * size**2
        np.testing.assert_allclose(found[2:], linear, atol=100 * size**2)
        assert rod.deflection(q, t, 1.0)[0] == found[3]
    q, _ = rod.undeformed(np.array([0.1, 0.2]) / SPEED)
    assert np.max(np.abs(rod.deflection(q, np.array([0.1, 0.2]) / SPEED, 1.0))) < 1e-15
