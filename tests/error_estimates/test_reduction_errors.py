"""Errors of systems on moving modes: arrays against their definition, modes that are known.

Oscillators of given rates are seen through random coordinates that wave with the crank, so that
modes and mean products are known without any solver; their arrays and the projections are
evaluated in long doubles at angles of their own.
"""

import numpy as np
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic import reduced_system
from honesty import over_scenes
from periodic_systems import system_of, wave
from wavy_springs import WavyCoordinates

ANGLES = 40
MASS = np.array([[2.0, 0.3], [0.3, 1.0]])


class Coordinates:
    """Damped oscillators in coordinates ``x = T(theta) q``."""

    def __init__(self, rng):
        n = int(rng.integers(2, 6))
        # Wide ranges of frequencies, and neighbours a few per cent apart.
        steps = 1.0 + 10.0 ** rng.uniform(-1.3, 0.8, n)
        self.natural = rng.uniform(3.0, 10.0) * np.cumprod(steps)
        fixed = np.eye(n) + 0.15 * rng.standard_normal((n, n))
        # Some coordinates come near to being dependent at some angle: their series are long.
        count = int(rng.integers(1, 4))
        waves = rng.uniform(0.02, 0.35) / np.sqrt(n) * rng.standard_normal((2, count, n, n))
        self.drag = float(rng.choice([0.0, 0.3]))
        push = rng.standard_normal((2, n))
        coordinates = WavyCoordinates(fixed, waves)

        def force(theta):
            pushed = push[0] + np.multiply.outer(np.cos(theta), push[1])
            return (np.swapaxes(coordinates.turn(theta), 1, 2) @ pushed[..., None])[..., 0]

        self.exact = coordinates.arrays(self.natural**2, self.drag) | {"f": force}
        self.system = system_of(**self.exact)

    def condition(self):
        """Return the largest condition of K over a revolution."""
        theta = np.linspace(0.0, 2 * np.pi, 48)
        return float(np.max(np.linalg.cond(self.exact["K"](theta))))


def reduced(rng):
    """Return a random system, it on fewer modes or all; coordinates that do not do are passed."""
    while True:
        scene = Coordinates(rng)
        try:
            return scene, reduced_system(scene.system, int(rng.integers(1, scene.system.size + 1)))
        except BadInput:
            continue


def wide(values):
    return np.asarray(values).astype(np.longdouble)


def exact_parts(scene, small, theta):
    """Return the products whose sums are the arrays, in long doubles, the basis as it is."""
    at = {name: function(wide(theta)) for name, function in scene.exact.items()}
    phi, slope = wide(small.basis(theta)), wide(small.basis.derivative(theta))
    across, turning = np.swapaxes(phi, 1, 2), np.swapaxes(slope, 1, 2)
    mixed = turning @ at["A"] @ phi
    found = {
        "M": [across @ at["M"] @ phi],
        "K": [across @ at["K"] @ phi],
        "A": [across @ at["M"] @ slope, across @ at["A"] @ phi],
        "B": [turning @ at["M"] @ slope, mixed + np.swapaxes(mixed, 1, 2), across @ at["B"] @ phi],
        "f": [(across @ at["f"][..., None])[..., 0]],
    }
    if scene.drag:
        found["C"] = [across @ at["C"] @ phi]
        found["D"] = [across @ at["C"] @ slope, across @ at["D"] @ phi]
    return found


@over_scenes(9100, floor=1e-17, median=200.0)
def test_arrays_and_squared_frequencies(rng):
    scene, small = reduced(rng)
    theta = rng.uniform(0.0, 2 * np.pi, ANGLES)
    worst = 0.0
    for name, parts in exact_parts(scene, small, theta).items():
        gap = np.max(np.abs(small.array(name, theta, 1.0) - sum(parts)))
        worst = max(worst, float(gap / max(np.max(np.abs(part)) for part in parts)))
    # Modes held still at any angle are the oscillators themselves.
    squares = np.linalg.eigvals(
        np.linalg.solve(small.array("M", theta), small.array("K", theta))
    ).real
    largest = scene.natural[small.size - 1] ** 2
    off = np.max(np.abs(np.sort(squares, axis=1) - scene.natural[: small.size] ** 2)) / largest
    # Entries of M and of K are off, and the basis rounds what it was made from: a bound of both.
    allowed = np.sqrt(small.size) * small.error + 1e-15 * scene.condition()
    return {"arrays": (small.error, worst), "squares": (allowed, off)}


def test_the_estimate_sees_arrays_that_no_series_resolves():
    """A mass whose waves hold more harmonics than angles are taken: what is lost is told."""

    def mass(theta):
        sharp = 1.0 / (1.0 - 0.9998 * np.cos(theta))
        return MASS + sharp[:, None, None] * np.diag([1.0, 0.0])

    springs = np.array([[4.0, 0.5], [0.5, 90.0]])
    system = system_of(M=MASS, K=[1.5 * springs, wave(springs)], Kg=(None, mass, 2))
    small = reduced_system(system, 1)
    theta = np.random.default_rng(3).uniform(0.0, 2 * np.pi, 400)
    phi = small.basis(theta)
    exact = np.swapaxes(phi, 1, 2) @ mass(theta) @ phi
    actual = np.max(np.abs(small.array("Kg", theta, 1.0) - exact)) / np.max(np.abs(exact))
    assert 1e-10 < actual <= small.error < 1e3 * actual
