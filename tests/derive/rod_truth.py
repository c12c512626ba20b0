"""What the emitted modules of the flexible rod should return, in many digits.

The kinematics are those of the closed loop (``sliding_truth``); what each term is worth follows
from Newton's law: the mass per length times the acceleration of a point at ``x e1 + v e2``, e1
turning with the rod.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from functools import cache, partial

import numpy as np
from elastolink import generated
from judging import Exact, Point, exact_at
from sliding_truth import nasty_rods, random_rods, rod_motion

PREFIX = "quick_return_rod_moving_basis"
MODULES = (PREFIX,)
PARAMETERS = (
    "bending_stiffness",
    "mass_per_length",
    "damping",
    "internal_damping",
    "length",
)


def _scales(module: str, n: Mapping) -> dict:
    """Return the factors made of parameters, for arrays divided by m L^3."""
    mass, inertia = n["mass_per_length"], n["mass_per_length"] * n["length"] ** 4
    of_mode = {
        "overlap": n["damping"] / mass,
        "drift": n["damping"] / mass,
        "bending": n["internal_damping"] / inertia,
        "bending_drift": n["internal_damping"] / inertia,
    }
    return {
        name: n["bending_stiffness"] / inertia if array == "K" else of_mode[mode]
        for array, _, name, _, mode in _terms(module)
        if name is not None
    }


def _angles(module: str, n: Mapping) -> dict:
    """Return the factors of the terms that follow the angle."""
    k = rod_motion(n)
    sliding, square = k["slide_velocity"] / n["length"], k["omega4"] ** 2
    roles = {
        **{("A", "drift"): sliding, ("D", "drift"): sliding, ("D", "bending_drift"): sliding},
        **{("B", "drift_drift"): sliding**2, ("B", "overlap"): square, ("B", "tension"): -square},
        **{("f", "moment"): -k["alpha4"], ("g", "moment"): -k["omega4"]},
    }
    return {name: roles[array, mode] for array, _, _, name, mode in _terms(module) if name}


def _terms(module: str) -> tuple:
    return importlib.import_module(f"{generated.__name__}.{module}").TERMS


def _place(numbers: Mapping) -> dict:
    return {"place": rod_motion(numbers)["slide"] / numbers["length"]}


def _frame(numbers: Mapping) -> dict:
    """Return ``24 c c' - 6 (c m' + m c')``, m the mean and c the moment about the middle."""
    (m, c), (m2, c2) = (
        (numbers[f"mean_{end}"], numbers[f"moment_{end}"] - numbers[f"mean_{end}"] / 2)
        for end in ("row", "column")
    )
    return {"frame": 24 * c * c2 - 6 * (c * m2 + m * c2)}


def _with_length(points: list[Point]) -> list[Point]:
    """Return the points with a rod that just reaches the block, or is longer."""
    random = np.random.default_rng(41)
    return [
        Point(
            p.name,
            {**p.inputs, "length": (p.inputs["frame"] + p.inputs["crank"]) * random.choice([1, 3])},
        )
        for p in points
    ]


def _vectors() -> list[Point]:
    """Return random integrals, those of nearly rigid shapes among them."""
    random = np.random.default_rng(42)
    points = []
    for i in range(200):
        mean = random.standard_normal(2)
        # The moment is half the mean of even shapes, 2/3 of it for those that turn about the pin.
        moment = mean * random.choice([0.5, 2 / 3, 0.75, 1.5], 2)
        moment += random.choice([0.0, 1e-15, 1e-8, 1.0]) * random.standard_normal(2)
        values = dict(zip(("mean_row", "mean_column"), mean.tolist(), strict=True))
        values |= dict(zip(("moment_row", "moment_column"), moment.tolist(), strict=True))
        points.append(Point(f"random integrals {i}", values))
    return points


@cache
def exact_moving(module: str, function: str) -> tuple[Exact, ...]:
    """Return the exact values of one emitted function at all its points."""
    if function == "basis_products":
        return tuple(exact_at(_frame, point) for point in _vectors())
    if function == "scales":
        random = np.random.default_rng(43)
        drawn = 10.0 ** random.uniform(-6, 6, (200, len(PARAMETERS)))
        points = [
            Point(f"random {i}", dict(zip(PARAMETERS, row, strict=True)))
            for i, row in enumerate(drawn.tolist())
        ]
        return tuple(exact_at(partial(_scales, module), point) for point in points)
    reference = _place if function == "place" else partial(_angles, module)
    return tuple(exact_at(reference, p) for p in _with_length(random_rods(60, 44) + nasty_rods()))
