"""Integrators of constrained systems, one file each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from .collocation import Window, collocation
from .coordinate_partitioning import coordinate_partitioning
from .dormand_prince import ORDER as _EXPLICIT_ORDER
from .gear_gupta_leimkuhler import gear_gupta_leimkuhler
from .lobatto import lobatto
from .projection import projection, unprojected
from .protocol import Control, Step, Stepper, StoppedEarly
from .variations import VariedMotion, jacobian_rate, motion_with_variations, tangent_basis

__all__ = [
    "METHODS",
    "Control",
    "Method",
    "Step",
    "Stepper",
    "StoppedEarly",
    "VariedMotion",
    "Window",
    "collocation",
    "coordinate_partitioning",
    "gear_gupta_leimkuhler",
    "jacobian_rate",
    "lobatto",
    "motion_with_variations",
    "projection",
    "tangent_basis",
    "unprojected",
]


@dataclass(frozen=True)
class Method:
    """An integrator by name.

    Attributes
    ----------
    march : Stepper
        Yields steps.
    order : callable
        Order of the global error in the step, by the number of stages.
    fixed : bool
        Whether it takes fixed steps where asked.
    even : bool
        Whether it keeps to even steps under a tolerance too.
    gridded : bool
        Whether it takes the ends of its steps where given.
    stages : tuple of int
        Least and largest number of stages.
    judged : bool
        Whether its steps bring their error figure with them, so that no second run is made.
    """

    march: Stepper
    order: Callable[[int], int]
    fixed: bool = True
    even: bool = False
    gridded: bool = False
    stages: tuple[int, int] = (2, 20)
    judged: bool = False


def _explicit(stages: int) -> int:
    return _EXPLICIT_ORDER


METHODS: Mapping[str, Method] = {
    "collocation": Method(collocation, lambda stages: 2 * stages, stages=(6, 32), judged=True),
    "projection": Method(projection, _explicit, gridded=True),
    "coordinate_partitioning": Method(coordinate_partitioning, _explicit, gridded=True),
    "lobatto": Method(lobatto, lambda stages: 2 * stages - 2, even=True),
    "gear_gupta_leimkuhler": Method(gear_gupta_leimkuhler, lambda stages: 5, fixed=False),
}
