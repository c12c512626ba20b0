"""A pendulum in oblique Cartesian coordinates, its pivot moving evenly, and its exact motion."""

from dataclasses import dataclass, field

import mpmath
import numpy as np
from elastolink.generated import four_bar_multibody as multibody
from elastolink.runtime.core.families import Constrained
from scipy.integrate import solve_ivp

LENGTHS = {"frame": 1.0, "crank": 0.3, "coupler": 0.9, "follower": 0.8}


@dataclass(frozen=True)
class Circle:
    """A bob on a rod of unit length about a pivot that moves evenly, in coordinates z = R^-1 x.

    The angle is 0 below the pivot at t = 0.
    """

    gravity: float = 10.0
    start: float = 3.0  # angular velocity below the pivot [rad/s]
    mass: float = 2.0
    oblique: np.ndarray = field(default_factory=lambda: np.eye(2))
    pivot: np.ndarray = field(default_factory=lambda: np.zeros(2))
    row: float = 1.0  # factor of the constraint

    @property
    def system(self) -> Constrained:
        matrix, metric = self.oblique, self.mass * self.oblique.T @ self.oblique

        def arm(z, t):
            return np.asarray(z) @ matrix.T - np.asarray(t)[..., None] * self.pivot

        def violation(z, t):
            a = arm(z, t)
            return {
                "constraints": (self.row * (np.sum(a * a, axis=-1) - 1) / 2)[..., None, None],
                "jacobian": (self.row * a @ matrix)[..., None, :],
            }

        def dynamics(z, zd, t):
            a, relative = arm(z, t), np.asarray(zd) @ matrix.T - self.pivot
            weight = matrix.T @ np.array([0.0, -self.mass * self.gravity])
            batch = a.shape[:-1]
            return {
                "mass": np.broadcast_to(metric, (*batch, 2, 2)),
                "rest": np.zeros((*batch, 2, 1)),
                "forces": np.broadcast_to(weight[:, None], (*batch, 2, 1)),
                "jacobian": (self.row * a @ matrix)[..., None, :],
                "velocity_rhs": (self.row * a @ self.pivot)[..., None, None],
                "gamma": (-self.row * np.sum(relative**2, axis=-1))[..., None, None],
            }

        def variations(z, zd, zdd, lam, t):
            slope = -self.row * np.asarray(lam)[..., None] * (matrix.T @ matrix)
            relative = np.asarray(zd) @ matrix.T - self.pivot
            return {
                "damping": np.zeros_like(slope),
                "stiffness": slope,
                "jacobian_rate": (self.row * relative @ matrix)[..., None, :],
                "jacobian_acceleration": (self.row * zdd @ matrix.T @ matrix)[..., None, :],
            }

        return Constrained(2, 1, dynamics, violation, variations, labels=("a", "b"))

    @property
    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at t = 0."""
        return self.of(0.0, self.start, 0.0)

    def of(self, angle, turning, t):
        """Coordinates and velocities at an angle and its rate."""
        sin, cos = np.sin(angle), np.cos(angle)
        x = np.stack([sin, -cos], axis=-1) + np.asarray(t)[..., None] * self.pivot
        xd = np.asarray(turning)[..., None] * np.stack([cos, sin], axis=-1) + self.pivot
        inverse = np.linalg.inv(self.oblique)
        return x @ inverse.T, xd @ inverse.T

    def angle(self, t):
        """Angle and rate by elliptic functions, 30 digits, as floats of the reduced angle."""
        with mpmath.workdps(30):
            w, g, t = mpmath.mpf(self.start), mpmath.mpf(self.gravity), mpmath.mpf(float(t))
            ratio = w * w / (4 * g)
            if ratio > 1:  # over the top: sin(angle/2) = sn(w t/2 | 1/ratio)
                u, m = w * t / 2, 1 / ratio
                sn, cn, dn = (mpmath.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
                return float(2 * mpmath.atan2(sn, cn)), float(w * dn)
            u, m = mpmath.sqrt(g) * t, ratio
            sn, cn, dn = (mpmath.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
            return float(2 * mpmath.atan2(mpmath.sqrt(m) * sn, dn)), float(w * cn)

    def exact(self, times):
        """Coordinates and velocities at several times, ``(nt, 2)`` each."""
        angles, rates = np.array([self.angle(t) for t in times]).T
        return self.of(angles, rates, np.asarray(times))

    def multiplier(self, angle, turning):
        """Multiplier by hand: the rod pulls with m (g cos + turning^2)."""
        return -self.mass * (self.gravity * np.cos(angle) + np.asarray(turning) ** 2) / self.row

    def energy(self, z, zd, t):
        """Energy in the frame of the pivot, constant."""
        x = z @ self.oblique.T - np.asarray(t)[..., None] * self.pivot
        xd = zd @ self.oblique.T - self.pivot
        return self.mass * (np.sum(xd**2, axis=-1) / 2 + self.gravity * x[..., 1])


def random_circle(rng: np.random.Generator) -> Circle:
    """Return a pendulum of random size, swinging or turning, in random coordinates."""
    gravity = 10.0 ** rng.uniform(-1, 2)
    return Circle(
        gravity=gravity,
        # Twice the root of gravity parts swinging from turning.
        start=2.0 * np.sqrt(gravity) * rng.choice([rng.uniform(0.1, 0.95), rng.uniform(1.05, 2)]),
        mass=10.0 ** rng.uniform(-2, 2),
        oblique=np.diag(10.0 ** rng.uniform(-2, 2, 2)) + 0.003 * rng.standard_normal((2, 2)),
        pivot=rng.standard_normal(2) * np.sqrt(gravity) * 0.2,
        row=10.0 ** rng.uniform(-3, 3),
    )


def by_explicit_steps(system: Constrained, q, qd, times, rtol=1e-11):
    """Return coordinates ``(nt, n)`` and the number of steps, by DOP853 on the accelerations.

    Nothing holds the constraints: they drift by some ``rtol`` a step.
    """
    n = system.size

    def rate(t, y):
        return np.concatenate([y[n:], system.accelerations(y[:n], y[n:], t)[0]])

    start, span = np.concatenate([q, qd]), (times[0], times[-1])
    run = solve_ivp(rate, span, start, "DOP853", times, rtol=rtol, atol=1e-3 * rtol)
    return run.y[:n].T, run.nfev // 12


def unconstrained(push, slope=None) -> Constrained:
    """Return one free coordinate, x'' = push(x, x') or push(x, x', t); slope is -dpush/dx."""
    timed = push.__code__.co_argcount == 3

    def none(q):
        return np.zeros((*np.shape(q)[:-1], 0, 1))

    def dynamics(q, qd, t):
        q, qd = np.asarray(q), np.asarray(qd)
        force = push(q, qd, np.asarray(t)[..., None]) if timed else push(q, qd)
        whole = {"mass": np.ones((*q.shape, 1)), "rest": np.zeros((*q.shape, 1))}
        held = dict.fromkeys(("jacobian", "velocity_rhs", "gamma"), none(q))
        return {**whole, "forces": force[..., None], **held}

    def violation(q, t):
        return dict.fromkeys(("constraints", "jacobian"), none(q))

    def variations(q, qd, qdd, lam, t):
        stiffness = slope(np.asarray(q))[..., None]
        held = dict.fromkeys(("jacobian_rate", "jacobian_acceleration"), none(q))
        return {"damping": 0.0 * stiffness, "stiffness": stiffness, **held}

    return Constrained(1, 0, dynamics, violation, variations if slope else None)


def driven_four_bar(speed):
    """Return the four-bar of uniform links with a driven crank: nothing of it is free."""
    values = dict.fromkeys(multibody.PARAMETERS, 0.0) | LENGTHS
    for n, length in ((2, 0.3), (3, 0.9), (4, 0.8)):
        values[f"mass{n}"] = length
        values[f"along{n}"] = length**2 / 2
        values[f"inertia{n}"] = length**3 / 3
    drive = {
        "drive": lambda q, t: speed * t,
        "drive_d1": lambda q, t: speed,
        "drive_d2": lambda q, t: 0.0,
    }
    return Constrained.from_module(multibody, values, external=drive)
