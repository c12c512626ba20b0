"""Random machines, their states in redundant coordinates, calls by name."""

import importlib
import inspect

import mpmath
import numpy as np
from elastolink.runtime.core.families.emitted import array_function
from forces_truth import links, points

LENGTHS = ("frame", "crank", "coupler", "follower", "offset")


def emitted(name):
    return importlib.import_module(f"elastolink.generated.{name}")


def call(module, function, numbers):
    """Return what an emitted function returns, by name."""
    kernel = getattr(module, function)
    values = kernel(**{name: numbers[name] for name in inspect.signature(kernel).parameters})
    values = values if isinstance(values, tuple) else (values,)
    return dict(zip(module.RETURNS[function], values, strict=True))


def random_machines(mechanism, *, loaded=False):
    """Yield numbers of random linkages with cranks of 1 m, all masses or all loads at random."""
    for point in points(mechanism, loaded=loaded)[:80:3]:
        size = point.inputs["crank"]
        lengths = {k: v / size for k, v in point.inputs.items() if k in LENGTHS}
        yield dict(point.arguments) | lengths


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
    names = inspect.signature(module.dynamics).parameters
    filled = array_function(module, "dynamics")(**{name: numbers.get(name, 0.0) for name in names})
    jacobian = filled["jacobian"]
    rows = len(jacobian)
    whole = np.block([[filled["mass"], -jacobian.T], [jacobian, np.zeros((rows, rows))]])
    right = np.concatenate([filled["forces"] - filled["rest"], filled["gamma"]])[:, 0]
    solution = np.linalg.solve(whole, right)
    return solution[:9], dict(zip(module.MULTIPLIERS, solution[9:], strict=True))
