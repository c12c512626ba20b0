"""Emitted constrained modules under a drive as nonlinear systems: models of one's own, too."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from ..core.errors import bad
from ..core.families import Array, Constrained, Drive, Nonlinear
from ..core.families.emitted import check_module
from ..core.families.nonlinear import Reduced
from ..core.modules import EmittedModule

# What a module may want passed in: the drive's angle and its rates.
DRIVE = ("theta", "theta_d1", "theta_d2")


def _whatever_the_state(value: Any, q: Array, time: Array) -> Any:
    """Return an argument of emitted functions that does not depend on coordinates and time."""
    return value


@dataclass(frozen=True)
class Driven:
    """Makes the constrained system of an emitted module at numbers and a drive.

    ``fixed`` are parameters of the module that are none of the system's.
    """

    emitted: EmittedModule
    fixed: Mapping[str, float] = field(default_factory=dict)

    def __call__(self, parameters: Mapping[str, float], drive: Drive) -> Constrained:
        """Return the system; a parameter that is called ``speed`` is the drive's."""
        module = self.emitted.module
        given = dict(zip(DRIVE, drive, strict=True))
        external = {name: partial(_whatever_the_state, given[name]) for name in module.EXTERNAL}
        values = {**parameters, **self.fixed, "speed": drive.speed}
        return Constrained.from_module(
            module, {name: values[name] for name in module.PARAMETERS}, external=external
        )


def driven_system(
    emitted: EmittedModule,
    parameters: Mapping[str, float],
    *,
    free: tuple[str, ...] | None = None,
    closing: Callable[[Array, Drive, Mapping[str, float]], Array] | None = None,
    limits: Mapping[str, str] | None = None,
    provenance: Mapping[str, str] | None = None,
) -> Nonlinear:
    """Return the nonlinear system of an emitted module of the constrained family.

    Its dependence on time is that on the drive's angle: through ``theta`` and its rates, left open
    in the model, or through ``speed t``.

    Parameters
    ----------
    emitted : EmittedModule
        With variations.
    parameters : mapping
        Its parameters, in SI units, but for the speed.
    free : tuple of str, optional
        Coordinates that move freely; by default all, of a system without constraints.
    closing : callable, optional
        ``(q, drive, parameters)`` to the other coordinates near a state, in the module's order;
        needed where there are constraints.
    limits : mapping, optional
        Parameters that have to be ``positive`` or ``non-negative``.
    provenance : mapping, optional
        What to record.

    Raises
    ------
    BadInput
        If the module is of another family, wants something else passed in, or its constraints do
        not determine the coordinates that are not free.
    """
    module = emitted.module
    names = check_module(module, "constrained", {**parameters, "speed": 1.0})
    unknown = sorted(set(module.EXTERNAL) - set(DRIVE))
    if unknown:
        raise bad(module.__name__, f"arguments {unknown}", f"at most {DRIVE}", "close them")
    if "variations" not in module.ARRAYS:
        fix = "emit the model with the output 'variations'"
        raise bad(module.__name__, "no variational equations", "a module with them", fix)
    coordinates = tuple(module.COORDINATES)
    chosen = coordinates if free is None else tuple(free)
    held = tuple(name for name in coordinates if name not in chosen)
    if set(chosen) - set(coordinates) or len(held) != len(module.MULTIPLIERS):
        count = len(coordinates) - len(module.MULTIPLIERS)
        raise bad("free", chosen, f"{count} of {coordinates}", "as many as no constraint holds")
    if held and closing is None:
        raise bad("closing", "none", f"a function to {held}", "say where the loop closes")
    place = coordinates.index
    return Nonlinear(
        size=len(chosen),
        equations=Reduced(
            Driven(emitted),
            tuple(map(place, chosen)),
            tuple(map(place, held)),
            closing or nothing_held,
        ),
        parameters={name: float(parameters[name]) for name in names if name != "speed"},
        labels=chosen,
        limits=limits or {},
        provenance={**(provenance or {}), **emitted.provenance},
    )


def nothing_held(q: Array, drive: Drive, parameters: Mapping[str, float]) -> Array:
    """Return the other coordinates of a system without constraints."""
    return q[..., :0]
