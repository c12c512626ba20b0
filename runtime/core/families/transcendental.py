"""Eigenproblems whose matrix depends on the frequency through transcendental functions."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from .emitted import Values, array_function, parameter_values
from .linear_periodic import Array


@dataclass(frozen=True)
class Transcendental:
    """``D(Omega) u = 0`` with the number of poles of D below each frequency."""

    size: int  # order n of D
    stiffness: Callable[[ArrayLike], Array]  # Omega (...) [rad/s] to D (..., n, n), symmetric
    poles: Callable[[ArrayLike], Array]  # Omega (...) to the number of poles below it
    provenance: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def from_module(
        cls,
        module: ModuleType,
        parameters: Values,
        *,
        geometry: Values | None = None,
        provenance: Mapping[str, str] | None = None,
    ) -> Transcendental:
        """Return the problem of an emitted module with ``FAMILY = "transcendental"``.

        Its parameters are in SI units, arrays broadcast with the frequency; ``geometry`` are its
        further arguments beside the frequency, for example a crank angle [rad].  A module of
        another family is refused, and a parameter or argument that is missing.
        """
        values = parameter_values(module, "transcendental", parameters)
        wanted = list(inspect.signature(module.dynamic_stiffness).parameters)[1:]
        missing = sorted(set(wanted) - set(values) - set(geometry or {}))
        if missing:
            raise bad("geometry", f"none for {missing}", "a value each", "supply them")
        values |= {name: value for name, value in (geometry or {}).items() if name in wanted}
        function = array_function(module, "dynamic_stiffness")

        def arrays(frequency: ArrayLike) -> Mapping[str, Array]:
            return function(np.asarray(frequency, dtype=float), **values)

        return cls(
            module.SIZE,
            lambda frequency: arrays(frequency)["stiffness"],
            lambda frequency: arrays(frequency)["poles"][..., 0, 0],
            dict(provenance or {}),
        )

    def count(self, frequency: ArrayLike) -> NDArray[np.int64]:
        """Return how many natural frequencies lie below each frequency (Wittrick and Williams)."""
        negative = np.sum(np.linalg.eigvalsh(self.stiffness(frequency)) < 0, axis=-1)
        return np.asarray(np.rint(self.poles(frequency)) + negative, dtype=np.int64)
