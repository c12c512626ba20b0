"""The inextensible coupler at three stations, derived for just these, in many digits.

The emitted functions are closed in the stations: derived at two, valid for any number.  Here each
is evaluated as its family evaluates it, with the angles at the stations for coordinates, and all
its arguments and results are scalars.
"""

import importlib
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from itertools import chain, combinations_with_replacement
from types import ModuleType

import numpy as np
from constrained_coupler import constrained
from elastolink import generated
from elastolink.derive.models import inextensible_coupler as coupler
from elastolink.runtime.core.families import Constrained
from judging import Exact, Point, Reference, exact_at
from scalar_entries import ScalarEntries, derived_reference

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
    lagrangian = coupler.lagrangian(module.removesuffix("_coupler_inextensible"), count)
    return derived_reference(lagrangian, dict.fromkeys(chain(*FUNCTIONS.values())))


class AtEachStation(ScalarEntries):
    """A function of an emitted module, as its family evaluates it at so many stations."""

    def __init__(self, module: str, function: str, count: int = COUNT) -> None:
        super().__init__(emitted_module(module), function, count)

    def components(self, name: str) -> list[str]:
        if name in coupler.STATIONS.matrices:
            return [f"{name}_{i}_{j}" for i, j in combinations_with_replacement(self.every, 2)]
        if name in coupler.STATIONS.tangent:
            return []  # follows from the angles
        if name in coupler.STATIONS.vectors:
            return [f"{name}_{i}" for i in self.every]
        if name.startswith("phi"):
            return [f"phi{i}{name.removeprefix('phi')}" for i in self.every]
        return [name]

    def system(self, given: Mapping[str, float], row: Callable[..., np.ndarray]) -> Constrained:
        numbers = {name: row(name) for name in coupler.STATIONS.vectors}
        numbers |= {name: self.square(given, name) for name in coupler.STATIONS.matrices}
        external = {name: lambda q, t, name=name: given[name] for name in self.module.EXTERNAL}
        return constrained(self.module, given, np.eye(self.count), numbers, external)


def station_points(module: str, count: int = COUNT) -> Iterator[Point]:
    """Yield states of any size, one of them straight and at rest in itself."""
    case = AtEachStation(module, "variations", count)
    positive = {*case.module.PARAMETERS} - {"offset", "gravity_x", "gravity_y"}

    def straight(inputs):
        still = [name for name in inputs if name.startswith("phi") and "_d" in name]
        return dict.fromkeys(still, 0.0) | {f"phi{i}": inputs["phi1"] for i in case.every}

    yield from case.states(183, positive, "straight", straight)


def exact_stations(module: str) -> tuple[Exact, ...]:
    """Return exact values of an emitted module of the inextensible coupler."""
    return tuple(exact_at(explicit(module, COUNT), point) for point in station_points(module))
