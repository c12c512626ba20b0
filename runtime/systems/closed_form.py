"""Arrays of the equation of a flexible coupler, and of Hill's, as functions of a scene's numbers.

The numbers may be of any kind that emitted functions take: complex ones, a step off the real axis
for derivatives, or Taylor models.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.families import Array
from ..core.modules import find_module
from ..linkages.linkage import arguments
from .assembly import by_name, modal_arrays
from .from_scene import coupler_parameters, fourier_series

if TYPE_CHECKING:
    from ..scenes import Scene


@dataclass(frozen=True)
class ClosedForm:
    """An emitted module, and what its functions are given besides the numbers of a scene."""

    module: ModuleType  # with separated terms whose modal arrays are constant
    modes: int | None  # number of modes, where it serves any
    # By name, of the crank angle, what the module wants passed in.
    functions: Mapping[str, Callable[[Array], Array]]
    # From a scene, with numbers of any kind, to the arguments of the emitted functions.
    numbers: Callable[[Scene], Mapping[str, Any]]

    def arrays(
        self, numbers: Mapping[str, Any], theta: Array, wanted: Collection[str]
    ) -> dict[tuple[str, int], Any]:
        """Return the wanted arrays of the equation by name and extra power of the speed.

        For ``numbers`` as the field tells, some of them changed, at crank angles ``(nt,)`` [rad]:
        ``(nt, n, n)`` each, or ``(nt, n)``; nt is 1 where it is constant.
        """
        rows = [row for row in self.module.TERMS if row[0] in wanted]
        modal: Any = modal_arrays(self.module, self.modes, rows)
        factors: dict[Any, Any] = {None: np.ones(1)}
        factors |= {name: function(theta) for name, function in self.functions.items()}
        for kernel, names in self.module.RETURNS.items():
            if any(name in names for row in rows for name in row[2:4]):
                function = getattr(self.module, kernel)
                known = {**numbers, "theta2": theta}
                values = function(*(known[name] for name in arguments(function)))
                factors |= by_name(names, values)
        found: dict[tuple[str, int], Any] = {}
        for array, power, scale, angle, mode in rows:
            factor, shape = factors[scale] * factors[angle], modal[mode]
            value = factor[(slice(None), *(None,) * shape.ndim)] * shape
            found[array, power] = value + found.get((array, power), 0.0)
        return found


def closed_form(scene: Scene) -> ClosedForm | None:
    """Return the closed form of a scene's linear system; None where there is none."""
    mechanism = scene.model["mechanism"]
    if mechanism == "hill":
        return ClosedForm(
            find_module(scene.model_spec()).module,
            None,
            {"f": fourier_series(scene)},
            lambda one: one["parameters"],
        )
    if mechanism != "four_bar" or scene.layout.flexible != ("coupler",):
        return None
    emitted, linkage = find_module(scene.model_spec()), scene.mechanism()
    if emitted.module.FAMILY != "linear_periodic":
        return None

    def numbers(one: Scene) -> Mapping[str, Any]:
        lengths = {name: one["links"][name] for name in linkage.names}
        return {**lengths, "assembly": linkage.branch, **coupler_parameters(one)}

    return ClosedForm(emitted.module, int(scene.model["modes"]), {}, numbers)
