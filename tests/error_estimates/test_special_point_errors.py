"""Derivatives of folds, doublings and tori by numbers, against references of 40 digits.

Folds of an oscillator of two equal coordinates under a turning force, whose amplitude is the root
of a polynomial; doublings and tori at rest, where the equation is linear: Taylor series of 70
digits (variation_truth.py); and, where the motion moves with the numbers, folds and doublings of
random oscillators by differences of their places, known to what two steps differ by.
"""

import elastolink as el
import mpmath as mp
import numpy as np
from elastolink.runtime.core.families import Nonlinear
from elastolink.runtime.core.families.nonlinear import Varied
from elastolink.runtime.design import sensitivities
from elastolink.runtime.nonlinear.loci import special_near
from honesty import over_scenes
from random_systems import curve_of, random_oscillators
from variation_truth import WAVES, random_truth, slope


class Turning:
    """``q'' + 2 c q' + k q + g |q|^2 q = f (cos theta, sin theta)``."""

    def __call__(self, q, qd, qdd, drive, numbers, derivatives=True):
        angle = np.broadcast_to(drive.angle, q.shape[:-1])
        load = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        c, k, g, f = (numbers[name] for name in "ckgf")
        own = k + g * np.sum(q * q, axis=-1)[..., None]
        left = qdd + 2.0 * c * qd + own * q - f * load
        if not derivatives:
            return Varied(left)
        one = np.broadcast_to(np.eye(2), (*q.shape, 2))
        bent = own[..., None] * one + 2.0 * g * q[..., :, None] * q[..., None, :]
        return Varied(left, one, 2.0 * c * one, bent)


@over_scenes(451, few=1, many=60)
def test_derivatives_of_folds(rng):
    hardening = rng.choice([-1.0, 1.0])
    damping = 10.0 ** rng.uniform(-2.0, -1.2)
    force = rng.uniform(1.5, 4.0) * damping**1.5
    values = {"c": damping, "k": 1.0, "g": hardening * rng.uniform(0.5, 2.0), "f": force}
    system = Nonlinear(2, Turning(), values)
    span = (0.8, 1.05) if hardening < 0 else (0.95, 1.2)
    curve = el.response_curve(system, "speed", span, rtol=1e-10)
    folds = [i for i, kind in enumerate(curve.special) if kind == "fold"]
    if not folds:
        return None
    i = folds[int(rng.integers(len(folds)))]
    start = float(np.sum(curve.special_orbits[i].motion.x[0] ** 2)), float(curve.special_value[i])

    def left(square, speed, c, k, g, f):
        return ((k - speed**2 + g * square) ** 2 + (2 * c * speed) ** 2) * square - f**2

    def fold(name, value):
        numbers = [mp.mpf(v) for v in {**values, name: value}.values()]

        def equations(square, speed):
            rate = mp.diff(lambda x: left(x, speed, *numbers), square)
            return [left(square, speed, *numbers), rate]

        return mp.findroot(equations, start, tol=1e-100)[1]

    found = sensitivities(system, curve, [*values])
    exact = [float(slope(lambda x, name=name: fold(name, x), values[name])) for name in values]
    return found.error[i], np.abs(found.derivative[i] - exact)


class AtRest:
    """A linear periodic system of two freedoms or one, with cubic springs."""

    def __init__(self, matrices):
        self.matrices = matrices

    def __call__(self, q, qd, qdd, drive, numbers, derivatives=True):
        angle = np.broadcast_to(drive.angle, q.shape[:-1])[..., None, None]
        w = np.broadcast_to(drive.speed, q.shape[:-1])[..., None, None]
        one = np.eye(q.shape[-1])
        mass, damping, stiffness = (np.zeros((*q.shape, q.shape[-1])) for _ in range(3))
        for name, matrix in self.matrices.items():
            array, k, cosine, sine = WAVES[name]
            wave = numbers[name] ** 2 * (cosine * np.cos(k * angle) + sine * np.sin(k * angle))
            rate = numbers[name] ** 2 * k * (sine * np.cos(k * angle) - cosine * np.sin(k * angle))
            if array == "M":
                mass, damping = mass + wave * matrix, damping + w * rate * matrix
            elif array == "A":
                damping = damping + w * wave * (matrix - matrix.T)
                stiffness = stiffness + w**2 * rate * matrix
            elif array == "C":
                damping = damping + wave * matrix
            else:  # the speed stands with B
                sign = -(w**2) if array == "B" else 1.0
                stiffness = stiffness + sign * wave * matrix
        left = sum(
            (part @ state[..., None])[..., 0]
            for part, state in ((mass, qdd), (damping, qd), (stiffness, q))
        )
        left = left + q**3
        if not derivatives:
            return Varied(left)
        return Varied(left, mass, damping, stiffness + 3.0 * (q**2)[..., None] * one)


@over_scenes(461, few=None, many=10)
def test_derivatives_of_doublings_and_tori_at_rest(rng):
    truth = random_truth(rng, damped=True)
    truth.matrices["c"] = truth.matrices["c"] * 0.3
    system = Nonlinear(truth.size, AtRest(truth.matrices), dict(truth.values))
    curve = el.response_curve(system, "speed", (0.7, 2.5))
    known = [i for i, kind in enumerate(curve.special) if kind in ("doubling", "torus")]
    known = [i for i in known if curve.special_branch[i] == 0]
    if not known:
        return None
    i = known[int(rng.integers(len(known)))]
    name = str(rng.choice([*truth.values]))
    start, m = mp.mpf(float(curve.special_value[i])), 2 * truth.size
    like = mp.mpc(-1)
    if curve.special[i] == "torus":
        values = curve.special_orbits[i].multipliers
        like = mp.mpc(complex(values[np.argmin(np.abs(np.abs(values) - 1.0) - (values.imag > 0))]))

    def gap(speed, changes):
        matrix = truth.map(speed, changes)[:m, :m]
        values = mp.eig(matrix, left=False, right=False)
        return mp.log(abs(min(values, key=lambda value: abs(value - like))))

    speed = start
    for _ in range(2):
        by_speed = slope(lambda w: gap(w, {}), speed)
        speed -= gap(speed, {}) / by_speed
    assert abs(speed - start) < 1e-8
    exact = float(-slope(lambda x: gap(speed, {name: x}), truth.values[name]) / by_speed)
    found = sensitivities(system, curve, [name])
    return found.error[i, 0], abs(found.derivative[i, 0] - exact)


@over_scenes(471, few=1, many=12, floor=1e-9)
def test_derivatives_of_special_points_of_random_oscillators(rng):
    system, _ = drawn = random_oscillators(rng)
    curve = curve_of(rng, drawn, turns=1)
    known = [i for i, k in enumerate(curve.special) if k in ("fold", "doubling")] if curve else []
    if not known:
        return None
    i = known[int(rng.integers(len(known)))]
    kind, orbit, solver = curve.special[i], curve.special_orbits[i], curve.source
    name = str(rng.choice([name for name, value in system.parameters.items() if value]))
    value = system.parameters[name]

    def place(part):
        moved = system.with_parameters(**{name: value * (1.0 + part)})
        problem = type(solver.problem)(moved, "speed", 0.0)
        near = type(solver)(problem, solver.span, 1e-11)
        return special_near(near, orbit, orbit.value, kind).value

    def difference(step):
        ends = [place(step * at) for at in (2.0, 1.0, -1.0, -2.0)]
        weights = (-1.0, 8.0, -8.0, 1.0)
        return sum(w * end for w, end in zip(weights, ends, strict=True)) / (12.0 * step * value)

    rough, exact = difference(2e-3), difference(1e-3)
    known = abs(exact - rough) + 1e-9 * abs(exact)  # to which the reference is
    found = sensitivities(system, curve, [name])
    size = abs(exact) or 1.0
    return (found.error[i, 0] + known) / size, abs(found.derivative[i, 0] - exact) / size
