"""Rigid linkages in redundant coordinates by hand, in many digits, and the solution by elimination.

Bodies and joints are written as complex numbers; the terms of acceleration level come from the
second derivative of the constraints along a straight path of the coordinates.
"""

from __future__ import annotations

from functools import lru_cache

import mpmath
import numpy as np
from judging import Exact, Point, exact_at

LENGTHS = {
    "four_bar": ("frame", "crank", "coupler", "follower"),
    "slider_crank": ("crank", "coupler", "offset"),
    "quick_return": ("frame", "crank"),
}
BODY = ("x", "y", "angle")
MOMENTS = ("mass", "along", "across", "inertia")
LOADS = ("fx", "fy", "couple")


def _poses(q):
    return [(mpmath.mpc(q[3 * n], q[3 * n + 1]), mpmath.expj(q[3 * n + 2])) for n in range(3)]


def _split(*values):
    return [part for value in values for part in (mpmath.re(value), mpmath.im(value))]


def joints(mechanism, numbers, q):
    """Return what the joints hold at zero, in the order of the multipliers."""
    (r2, e2), (r3, e3), (r4, e4) = _poses(q)
    crank = numbers["crank"]
    pins = _split(r2, r3 - r2 - crank * e2)
    if mechanism == "four_bar":
        meeting = r4 + numbers["follower"] * e4 - r3 - numbers["coupler"] * e3
        return [*pins, *_split(meeting, numbers["frame"] - r4)]
    if mechanism == "slider_crank":  # the frame is the second link of 41, the slider the first
        meeting = r4 - r3 - numbers["coupler"] * e3
        return [*pins, *_split(meeting), -(r4.imag - numbers["offset"]), -q[8]]
    across = mpmath.im((r3 - r4) * mpmath.conj(e4))  # the block is the first link of 34
    return [*pins, -across, -(q[5] - q[8]), *_split(-numbers["frame"] - r4)]


def _slopes(mechanism, numbers, q):
    """Return the Jacobian, by differences that have no error in this many digits."""
    step = mpmath.mpf(10) ** -30
    columns = []
    for i in range(9):
        with mpmath.workdps(3 * 80):
            up, down = ([*q[:i], q[i] + s * step, *q[i + 1 :]] for s in (1, -1))
            high, low = joints(mechanism, numbers, up), joints(mechanism, numbers, down)
            cubic = [(a - b) / (2 * step) for a, b in zip(high, low, strict=True)]
        columns.append(cubic)
    return columns


def arrays(mechanism):
    """Return the emitted arrays of a linkage as a function of mpmath numbers by name."""

    def reference(numbers):
        q = [numbers[f"{name}{n}"] for n in (2, 3, 4) for name in BODY]
        qd = [numbers[f"{name}{n}_dot"] for n in (2, 3, 4) for name in BODY]
        found = {}
        zero = mpmath.mpf(0)
        for i, n in enumerate((2, 3, 4)):
            mass, along, across, inertia = (numbers[f"{name}{n}"] for name in MOMENTS)
            arm = mpmath.mpc(along, across) * mpmath.expj(q[3 * i + 2])
            rows = (
                (mass, zero, -arm.imag),
                (zero, mass, arm.real),
                (-arm.imag, arm.real, inertia),
            )
            for j, row in enumerate(rows):
                for k, value in enumerate(row):
                    found[f"mass_{3 * i + j + 1}_{3 * i + k + 1}"] = value
            pull = -(qd[3 * i + 2] ** 2) * arm
            for j, value in enumerate((pull.real, pull.imag, zero)):
                found[f"rest_{3 * i + j + 1}_1"] = value
            for j, name in enumerate(LOADS):
                found[f"forces_{3 * i + j + 1}_1"] = numbers[f"{name}{n}"]
        held = joints(mechanism, numbers, q)
        columns = _slopes(mechanism, numbers, q)
        bent = _curvature(mechanism, numbers, q, qd)
        rates = [zero] * len(held)
        gamma = [-value for value in bent]
        held.append(q[2] - numbers["drive"])
        for i, column in enumerate(columns):
            column.append(mpmath.mpf(i == 2))
        rates.append(numbers["drive_d1"])
        gamma.append(numbers["drive_d2"])
        for row, value in enumerate(held):
            found[f"constraints_{row + 1}_1"] = value
            found[f"gamma_{row + 1}_1"] = gamma[row]
            found[f"velocity_rhs_{row + 1}_1"] = rates[row]
            for i, column in enumerate(columns):
                found[f"jacobian_{row + 1}_{i + 1}"] = column[row]
        return found

    return reference


def _curvature(mechanism, numbers, q, qd):
    """Return the second derivative of the joints' constraints along ``q + s qd``."""
    step = mpmath.mpf(10) ** -40
    with mpmath.workdps(4 * 80):
        ends = [
            joints(mechanism, numbers, [a + s * step * b for a, b in zip(q, qd, strict=True)])
            for s in (1, 0, -1)
        ]
        return [(a - 2 * b + c) / step**2 for a, b, c in zip(*ends, strict=True)]


@lru_cache(maxsize=12)
def exact_points(module) -> tuple[Exact, ...]:
    """Return exact arrays at random states: coordinates of any size, joints open."""
    mechanism = module.split("_multibody")[0]
    random = np.random.default_rng(41)
    names = [f"{name}{n}{dot}" for dot in ("", "_dot") for n in (2, 3, 4) for name in BODY]
    names += LENGTHS[mechanism]
    names += [f"{name}{n}" for n in (2, 3, 4) for name in (*MOMENTS, *LOADS)]
    names += ["drive", "drive_d1", "drive_d2"]
    found = []
    for i in range(12):
        inputs = {
            name: float(random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-2, 2))
            for name in names
        }
        point = Point(f"random state {i}", inputs, {"t": 0.0})
        found.append(exact_at(arrays(mechanism), point))
    return tuple(found)


def solve(module, numbers):
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
