"""Linkages with an inextensible coupler, and what is known of their motions from elsewhere.

``bent_rigs.toml`` has numbers by another author; ``Shape`` places the coupler in the plane by
Gauss's rule, without the equations under test.
"""

import tomllib
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import elastolink as el
import numpy as np
from elastolink.runtime.nonlinear.orbit import Solver
from elastolink.runtime.nonlinear.response import first_motion
from elastolink.runtime.nonlinear.segments import Problem
from elastolink.runtime.scenes import scene_from_document
from numpy.polynomial import legendre

REFERENCE = tomllib.loads((Path(__file__).parent / "bent_rigs.toml").read_text())
RPM = np.pi / 30
BENT = {"model.formulation": "inextensible"}
SLIDER_CRANK = """
title = "Slider-crank with a flexible connecting rod"
[model]
mechanism = "slider_crank"
formulation = "inextensible"
flexible = ["coupler"]
modes = 2
[links]
crank = "60 mm"
coupler = "300 mm"
offset = "10 mm"
assembly = "open"
[coupler]
bending_stiffness = "4.2 N*m**2"
mass_per_length = "0.471 kg/m"
damping = 0.6
[slider]
mass = "0.2 kg"
"""


def slider_crank(modes=2, **changes):
    """Return the system of the slider-crank, with changes of its scene."""
    document = tomllib.loads(SLIDER_CRANK)
    return scene_from_document("slider", document, {"model.modes": modes, **changes}).system()


@cache
def rig(name: str, modes: int):
    """Return one of Smith's rigs as the reference has it."""
    file = (
        "smith_1972_5152_sixteenth_inch" if name == "B58" else "smith_1972_101104_thirtysecond_inch"
    )
    system = el.load_scene(file, {**BENT, "model.modes": modes}).system()
    return system.with_parameters(**REFERENCE["rigs"][name])


def natural_frequency(parameters) -> float:
    """Return the first natural frequency of the pinned coupler [rad/s]."""
    ratio = parameters["bending_stiffness"] / parameters["mass_per_length"]
    return float((np.pi / parameters["coupler"]) ** 2 * np.sqrt(ratio))


@dataclass(frozen=True)
class Shape:
    """Where the coupler is, how it moves and accelerates, at Gauss points from B to C.

    Places are complex numbers, x + i y; ``values``, ``rates``, ``accelerations`` have shape
    ``(*batch, count)``, those of the end C and of the crank pin B ``batch``.
    """

    weights: np.ndarray
    places: tuple[np.ndarray, np.ndarray, np.ndarray]  # with rates and accelerations
    end: tuple[np.ndarray, np.ndarray, np.ndarray]
    pin: tuple[np.ndarray, np.ndarray, np.ndarray]
    driven: np.ndarray  # (3, *batch): follower's angle or slider's place, with both rates
    turn: np.ndarray  # (3, *batch): mean angle of the tangent

    @classmethod
    def of(cls, parameters, whole, q, qd, qdd, theta, speed, acceleration, count=48):
        """Return the shape at amplitudes with their rates ``(*batch, n)``.

        ``whole`` are the driven coordinate and the mean angle, whose rates follow from the loop.
        """
        nodes, weights = legendre.leggauss(count)
        s, weights = (nodes + 1) / 2, weights / 2
        length = parameters["coupler"]
        cosines = np.cos(np.pi * np.multiply.outer(np.arange(1, q.shape[-1] + 1), s))
        angle = whole[..., 1, None] + q @ cosines
        rate, bend = qd @ cosines, qdd @ cosines
        along = np.exp(1j * angle)
        turning = 1j * speed
        pin = parameters["crank"] * np.exp(1j * theta)
        pins = (pin, turning * pin, (1j * acceleration + turning**2) * pin)

        def total(values):
            return length * (values @ weights)

        # The loop, differentiated: pin + coupler = driven, rates of driven and mean angle unknown.
        if "slider_mass" in parameters:
            way, curved = np.ones_like(pin), np.zeros_like(pin)
        else:
            way = 1j * parameters["follower"] * np.exp(1j * whole[..., 0])
            curved = 1j * way
        arm = total(1j * along)

        def solved(left):
            """Return real x, y with ``x way - y arm = left``."""
            determinant = (np.conj(way) * -arm).imag
            x = (np.conj(left) * -arm).imag / determinant
            return x, (np.conj(way) * left).imag / determinant

        first = pins[1] + total(1j * rate * along)
        driven_rate, turn_rate = solved(first)
        rate = rate + turn_rate[..., None]
        second = pins[2] + total((1j * bend - rate**2) * along) - curved * driven_rate**2
        driven_bend, turn_bend = solved(second)
        bend = bend + turn_bend[..., None]
        fields = (along, 1j * rate * along, (1j * bend - rate**2) * along)
        inner = _running(nodes)
        places = tuple(
            p[..., None] + length * (f @ inner.T) for p, f in zip(pins, fields, strict=True)
        )
        ends = tuple(p + total(f) for p, f in zip(pins, fields, strict=True))
        driven = np.stack([whole[..., 0], driven_rate, driven_bend])
        turn = np.stack([whole[..., 1], turn_rate, turn_bend])
        return cls(weights * length, places, ends, pins, driven, turn)

    def integral(self, values):
        """Return the integral along the coupler, with its length."""
        return values @ self.weights


@cache
def _integration(count: int) -> np.ndarray:
    nodes, weights = legendre.leggauss(count)
    series = (
        (2 * np.arange(count) + 1)[:, None]
        / 2
        * (legendre.legvander(nodes, count - 1) * weights[:, None]).T
    )
    rows = [legendre.legval(nodes, legendre.legint(column, lbnd=-1)) / 2 for column in series.T]
    return np.array(rows).T


def _running(nodes: np.ndarray) -> np.ndarray:
    """Return the matrix that integrates values at Gauss points from the beginning to each."""
    return _integration(len(nodes))


def motions_at(curve, value: float, turns: int):
    """Return the motions of a response curve at a value of the parameter, with their errors."""
    solver, found = curve.source, []
    points = list(zip(curve.orbits, curve.branch, strict=True))
    for (one, branch), (other, same) in pairwise(points):
        within = min(one.value, other.value) <= value <= max(one.value, other.value)
        if within and branch == same and one.motion.turns == turns:
            near = min(one, other, key=lambda orbit: abs(orbit.value - value))
            motion = solver.settled(value, near.motion)
            orbit, _ = solver.fine(value, motion, solver.along_parameter(motion))
            # As many steps a turn: then every turn begins with a step.
            steps = turns * -(-len(orbit.motion.x) // turns)
            motion = solver.settled(value, orbit.motion.resampled(steps, orbit.motion.a.shape[1]))
            found.append(solver.fine(value, motion, solver.along_parameter(motion)))
    return found


def smallest_motion(system, speed: float, rtol: float = 1e-8):
    """Return the motion that Newton reaches from none, with its error, and the solver."""
    problem = Problem(system, "speed", 0.0)
    solver = Solver(problem, 0.1 * speed, rtol)
    motion = solver.settled(speed, first_motion(problem))
    return solver.fine(speed, motion, solver.along_parameter(motion)), solver
