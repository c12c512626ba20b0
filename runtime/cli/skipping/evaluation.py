"""Which arrays of a system are never evaluated, and which all points of a sweep share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...core.families import MATRICES, VECTORS, LinearPeriodic
from ...periodic.equation import SPEED_POWER, equation_of
from .emitted import EmittedCost


@dataclass(frozen=True)
class Evaluated:
    """What a system evaluates; fields as in :class:`.explanation.Explanation`."""

    arrays: Mapping[str, str] = field(default_factory=dict)
    powers: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    samples: int = 0
    angles: int = 0
    harmonics: int = 0


def of_linear(system: LinearPeriodic, speed: float) -> Evaluated:
    """Tell the arrays of a linear-periodic system apart.

    Parameters
    ----------
    system : LinearPeriodic
        At its own parameters: what they make zero counts as zero.
    speed : float
        Crank speed [rad/s] at which harmonics are judged.
    """
    alive = _alive(system)
    arrays = {}
    for array in MATRICES + VECTORS:
        own = [row for row, term in enumerate(system.terms) if term.array == array]
        acting = [system.terms[row] for row in own if row in alive]
        if not own:
            arrays[array] = "absent"
        elif not acting:
            arrays[array] = "zero"
        else:
            constant = all(term.constant for term in acting)
            arrays[array] = "constant" if constant else "periodic"
    steady = [row for row in alive if system.terms[row].array in SPEED_POWER]
    moving = [row for row in steady if not system.terms[row].constant]
    equation = equation_of(system, speed, forcing=True) if moving else None
    return Evaluated(
        arrays=arrays,
        powers=_powers(system, alive),
        samples=len(steady),
        angles=len(equation.even_angles()) if equation else 0,
        harmonics=equation.reach if equation else 0,
    )


def _alive(system: LinearPeriodic) -> list[int]:
    """Return the rows of the terms that are not zero at the system's parameters."""
    scales = system.scale_values()
    return [
        row
        for row, (term, amplitude) in enumerate(zip(system.terms, system.spectra, strict=True))
        if np.any(amplitude) and (term.scale is None or np.any(scales[term.scale]))
    ]


def _powers(system: LinearPeriodic, alive: list[int]) -> dict[str, tuple[str, ...]]:
    """Return the monomials by the power of the speed in the equation of motion in time.

    ``M qdd`` with ``qdd = w^2 q''`` counts as power 2; what acts only while the crank accelerates
    stands apart.
    """
    found: dict[str, set[str]] = {}
    for row in alive:
        term = system.terms[row]
        known = SPEED_POWER.get(term.array)
        key = "acceleration" if known is None else str(known + 2 + term.power)
        monomial = "1" if term.scale is None else term.scale
        found.setdefault(key, set()).add(f"{term.array}: {monomial}")
    return {key: tuple(sorted(names)) for key, names in sorted(found.items(), reverse=True)}


def of_entries(costs: Mapping[str, EmittedCost]) -> Evaluated:
    """Count the entries that constrained systems evaluate; the rest is zero."""
    return Evaluated(
        arrays={
            array: f"{filled} of {entries}"
            for cost in costs.values()
            if cost.family == "constrained"
            for array, (filled, entries) in cost.entries.items()
        }
    )
