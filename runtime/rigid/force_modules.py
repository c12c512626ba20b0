"""The emitted modules of forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from inspect import signature
from types import ModuleType
from typing import Any

from .machine import Machine


@dataclass(frozen=True)
class ForceModule:
    """An emitted module of forces: which arguments it takes, and what it returns.

    Attributes
    ----------
    module : module
        Emitted.
    geometry_names : tuple of str
        Its geometry arguments.
    returned : mapping of str to tuple of str
        Names of what each function returns.
    """

    module: ModuleType
    geometry_names: tuple[str, ...]
    returned: Mapping[str, tuple[str, ...]]

    def geometry(self, linkage: Any) -> list[tuple[str, float]]:
        """Return the geometry arguments of a linkage, by name and in order."""
        given = dict(linkage.geometry)
        if "winding" in self.geometry_names:
            given["winding"] = float(linkage.crank > linkage.frame)
        return [(name, float(given[name])) for name in self.geometry_names]


def force_module(machine: Machine) -> ForceModule:
    """Return the emitted module that serves a machine.

    Parameters
    ----------
    machine : Machine
        The machine.

    Raises
    ------
    BadInput
        If there is none.
    """
    return _module(MECHANISMS[type(machine.linkage).__name__])


@lru_cache(maxsize=3)
def _module(mechanism: str) -> ForceModule:
    from ...derive.spec import ModelSpec
    from ..systems.modules import find_module

    module = find_module(ModelSpec(mechanism, "forces")).module
    names = tuple(signature(module.forces).parameters)
    return ForceModule(
        module=module,
        geometry_names=tuple(
            name for name in names[1 : names.index("mass2")] if name not in _DRIVE
        ),
        returned=module.RETURNS,
    )


_DRIVE = ("speed", "acceleration")
MECHANISMS = {
    "FourBar": "four_bar",
    "SliderCrank": "slider_crank",
    "QuickReturn": "quick_return",
}
