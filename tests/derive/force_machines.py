"""Random machines, their states in redundant coordinates, calls by name."""

from __future__ import annotations

import importlib

import mpmath
import numpy as np
from forces_truth import LOADS, MOMENTS, links


def emitted(name):
    return importlib.import_module(f"elastolink.generated.{name}")


def call(module, function, numbers):
    """Return what an emitted function returns, by name."""
    kernel = getattr(module, function)
    wanted = kernel.__code__.co_varnames[: kernel.__code__.co_argcount]
    values = kernel(**{name: numbers[name] for name in wanted})
    values = values if isinstance(values, tuple) else (values,)
    return dict(zip(module.RETURNS[function], values, strict=True))


def random_machine(mechanism, random):
    """Return numbers of a linkage of any class and assembly, well inside its range."""
    while True:
        lengths = 10.0 ** random.uniform(-0.7, 0.7, 4)
        numbers = dict(zip(("frame", "crank", "coupler", "follower"), lengths, strict=True))
        numbers |= {
            "theta2": random.uniform(-7.0, 7.0),
            "assembly": random.choice([-1.0, 1.0]),
            "offset": random.uniform(-0.5, 0.5),
            "speed": random.uniform(0.5, 20.0),
            "acceleration": random.uniform(-200.0, 200.0),
        }
        numbers |= {name: random.uniform(-2.0, 2.0) for name in (*MOMENTS, *LOADS)}
        if _inside(mechanism, numbers):
            return {name: float(value) for name, value in numbers.items()}


def _inside(mechanism, n):
    if mechanism == "quick_return":
        return abs(n["frame"] + n["crank"] * np.exp(1j * n["theta2"])) > 0.1 * n["crank"]
    if mechanism == "slider_crank":
        return abs(n["offset"] - n["crank"] * np.sin(n["theta2"])) < 0.95 * n["coupler"]
    diagonal = abs(n["frame"] - n["crank"] * np.exp(1j * n["theta2"]))
    cosine = (n["coupler"] ** 2 + n["follower"] ** 2 - diagonal**2) / (
        2 * n["coupler"] * n["follower"]
    )
    return abs(cosine) < 0.95 and diagonal > 0.1 * n["crank"]


def state_of(mechanism, numbers):
    """Return coordinates and velocities of the free bodies, from the exact pose."""
    with mpmath.workdps(30):
        exact = {name: mpmath.mpf(v) for name, v in numbers.items()}
        bodies, _ = links(mechanism, exact)
        step = mpmath.mpf(10) ** -12
        ahead = {**exact, "theta2": exact["theta2"] + step}
        behind = {**exact, "theta2": exact["theta2"] - step}
        state = {}
        for n, body in enumerate(bodies, start=2):
            after, before = (links(mechanism, e)[0][n - 2] for e in (ahead, behind))
            moved = (after[0] - before[0]) / (2 * step) * exact["speed"]
            turned = mpmath.im((after[2] - before[2]) / body[2]) / (2 * step) * exact["speed"]
            state |= {
                f"x{n}": body[0].real,
                f"y{n}": body[0].imag,
                f"angle{n}": mpmath.arg(body[2]),
                f"x{n}_dot": moved.real,
                f"y{n}_dot": moved.imag,
                f"angle{n}_dot": turned,
            }
        return {name: float(value) for name, value in state.items()}


def cartesian(mechanism, found, numbers):
    """Return multipliers as the forces are named: a slide's normal as components."""
    if mechanism == "slider_crank":
        found = {**found, "x41": 0.0, "y41": found["normal41"]}
    if mechanism == "quick_return":
        angle = state_of(mechanism, numbers)["angle4"]
        normal = found["normal34"]
        found = {**found, "x34": -normal * np.sin(angle), "y34": normal * np.cos(angle)}
    return {name: value for name, value in found.items() if not name.startswith("normal")}


def eliminate(module, numbers):
    """Return accelerations and multipliers of an emitted module at one state, by elimination."""
    kernel, table = module.dynamics, module.ARRAYS["dynamics"]
    wanted = kernel.__code__.co_varnames[: kernel.__code__.co_argcount]
    values = kernel(**{name: numbers.get(name, 0.0) for name in wanted})
    filled = {}
    for name, (shape, entries) in table.items():
        filled[name] = np.zeros(shape)
        for i, j, place in entries:
            filled[name][i, j] = values[place]
    jacobian = filled["jacobian"]
    rows = len(jacobian)
    whole = np.block([[filled["mass"], -jacobian.T], [jacobian, np.zeros((rows, rows))]])
    right = np.concatenate([filled["forces"] - filled["rest"], filled["gamma"]])[:, 0]
    solution = np.linalg.solve(whole, right)
    return solution[:9], dict(zip(module.MULTIPLIERS, solution[9:], strict=True))
