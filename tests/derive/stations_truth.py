"""The inextensible coupler at three stations, derived for just these, in many digits.

The emitted functions are closed in the stations: derived at two, valid for any number.  Here each
is evaluated as its family evaluates it, with the angles at the stations for coordinates, and all
its arguments and results are scalars.
"""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import combinations_with_replacement
from types import ModuleType

import numpy as np
from elastolink import generated
from elastolink.derive.external import external_values
from elastolink.derive.lagrange import euler_lagrange, variational_equations
from elastolink.derive.models import inextensible_coupler as coupler
from elastolink.runtime.core.families import Constrained
from elastolink.runtime.core.families.stations import Stations
from judging import Exact, Point, Reference, exact_at, reference_of

STATION_MODULES = tuple(f"{name}_coupler_inextensible" for name in ("four_bar", "slider_crank"))
COUNT = 3
FUNCTIONS = {
    "constraints": ("constraints", "jacobian", "velocity_rhs"),
    "dynamics": ("mass", "rest", "forces", "jacobian", "velocity_rhs", "gamma"),
    "variations": ("damping", "stiffness", "jacobian_rate", "jacobian_acceleration"),
}


def emitted_module(name: str) -> ModuleType:
    return importlib.import_module(f"{generated.__name__}.{name}")


@lru_cache(maxsize=8)
def explicit(module: str, count: int) -> Reference:
    """Return all entries of the equations derived for a number of stations, in many digits."""
    equations = euler_lagrange(
        coupler.lagrangian(module.removesuffix("_coupler_inextensible"), count)
    )
    varied = variational_equations(equations)
    arrays = {
        name: getattr(equations, name, None) or getattr(varied, name)
        for names in FUNCTIONS.values()
        for name in names
    }
    values = external_values(arrays.values())
    outputs = [
        (f"{name}_{i + 1}_{j + 1}", values.plain(matrix)[i, j])
        for name, matrix in arrays.items()
        for i in range(matrix.rows)
        for j in range(matrix.cols)
    ]
    inputs = set().union(*(value.free_symbols for _, value in outputs))
    return reference_of(sorted(inputs, key=str), outputs)


class AtEachStation:
    """A function of an emitted module, as its family evaluates it at so many stations."""

    def __init__(self, module: str, function: str, count: int = COUNT) -> None:
        self.module, self.function, self.count = emitted_module(module), function, count
        self.scalars = self._scalars(inspect.signature(self.module.variations).parameters)
        kind = inspect.Parameter.KEYWORD_ONLY
        self.__signature__ = inspect.Signature([inspect.Parameter(n, kind) for n in self.scalars])
        generic = self._entries({name: 1.0 + 0.1 * k for k, name in enumerate(self.scalars)})
        self.names = tuple(name for name, value in generic.items() if value != 0.0)

    def __call__(self, **given: float) -> tuple[float, ...]:
        entries = self._entries(given)
        return tuple(entries[name] for name in self.names)

    def _scalars(self, parameters) -> list[str]:
        """Return the names of the components of parameters of the emitted function."""
        every = range(1, self.count + 1)
        names: list[str] = []
        for name in parameters:
            if name in coupler.STATIONS.matrices:
                pairs = combinations_with_replacement(every, 2)
                names += [f"{name}_{i}_{j}" for i, j in pairs]
            elif name in coupler.STATIONS.vectors:
                names += [f"{name}_{i}" for i in every]
            elif name.startswith("phi"):
                names += [f"phi{i}{name.removeprefix('phi')}" for i in every]
            else:
                names.append(name)
        return names

    def _entries(self, given: Mapping[str, float]) -> dict[str, float]:
        module, every = self.module, range(1, self.count + 1)

        def row(*names: str) -> np.ndarray:
            return np.array([given[name] for name in self._scalars(names)])

        numbers = {name: row(name) for name in coupler.STATIONS.vectors}
        for name in coupler.STATIONS.matrices:
            pairs = [[given[f"{name}_{min(i, j)}_{max(i, j)}"] for j in every] for i in every]
            numbers[name] = np.array(pairs)
        system = Constrained.at_stations(
            module,
            {name: given[name] for name in module.PARAMETERS},
            Stations(np.eye(self.count), numbers),
            {name: lambda q, t, name=name: given[name] for name in module.EXTERNAL},
        )
        state = [
            row(*(f"{name}{order}" for name in module.COORDINATES))
            for order in ("", "_dot", "_ddot")
        ]
        called, vectors = {
            "constraints": (system.violation, state[:1]),
            "dynamics": (system.dynamics, state[:2]),
            "variations": (system.variations, [*state, row(*module.MULTIPLIERS)]),
        }[self.function]
        return {
            f"{array}_{i + 1}_{j + 1}": float(value)
            for array, matrix in called(*vectors, given["t"]).items()
            for (i, j), value in np.ndenumerate(matrix)
        }


def station_points(module: str, count: int = COUNT) -> Iterator[Point]:
    """Yield states of any size, one of them straight and at rest in itself."""
    case = AtEachStation(module, "variations", count)
    positive = {*case.module.PARAMETERS} - {"offset", "gravity_x", "gravity_y"}
    random = np.random.default_rng(183 + count)
    for k in range(3):
        inputs = {}
        for name in case.scalars:
            size = 10.0 ** random.uniform(-2, 2)
            inputs[name] = float(size if name in positive else random.choice((-1, 1)) * size)
        if k == 0:
            still = [name for name in inputs if name.startswith("phi") and "_d" in name]
            angles = {f"phi{i}": inputs["phi1"] for i in range(1, count + 1)}
            inputs |= {**dict.fromkeys(still, 0.0), **angles}
        yield Point("straight" if k == 0 else f"random {k}", inputs)


def exact_stations(module: str) -> tuple[Exact, ...]:
    """Return exact values of an emitted module of the inextensible coupler."""
    return tuple(exact_at(explicit(module, COUNT), point) for point in station_points(module))
