"""The emitted modules of forces: the smallest one that serves a machine."""

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
    accelerated, straight : bool
        Whether it takes a crank acceleration, and whether it leaves out ``across``.
    geometry_names : tuple of str
        Its geometry arguments.
    returned : mapping of str to tuple of str
        Names of what each function returns.
    """

    module: ModuleType
    accelerated: bool
    straight: bool
    geometry_names: tuple[str, ...]
    returned: Mapping[str, tuple[str, ...]]

    def geometry(self, linkage: Any) -> list[tuple[str, float]]:
        """Return the geometry arguments of a linkage, by name and in order."""
        given = dict(linkage.geometry)
        if "winding" in self.geometry_names:
            given["winding"] = float(linkage.crank > linkage.frame)
        return [(name, float(given[name])) for name in self.geometry_names]


def force_module(machine: Machine, steady: bool) -> ForceModule:
    """Return the smallest emitted module that serves a machine.

    Parameters
    ----------
    machine : Machine
        The machine.
    steady : bool
        Whether the crank acceleration is zero everywhere.

    Raises
    ------
    BadInput
        If there is none.
    """
    straight = all(mass.across == 0.0 for mass in machine.masses.values())
    drops: tuple[str, ...] = ()
    if steady:
        drops = ("across", "crank_acceleration") if straight else ("crank_acceleration",)
    return _module(MECHANISMS[type(machine.linkage).__name__], drops)


@lru_cache(maxsize=16)
def _module(mechanism: str, drop: tuple[str, ...]) -> ForceModule:
    from ...derive.spec import ModelSpec
    from ..core.modules import find_module

    module = find_module(ModelSpec(mechanism, "forces", drop=drop)).module
    names = tuple(signature(module.forces).parameters)
    return ForceModule(
        module=module,
        accelerated="acceleration" in names,
        straight="across2" not in names,
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
