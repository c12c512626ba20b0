"""Natural frequencies of several models of one mechanism over the cycle (Aannaque 4.3, 5.4.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..beams import Structure
from ..core.families import LinearPeriodic
from ..frequencies import dynamic_stiffness, wittrick_williams
from ..frequencies.held import held_frequencies

Array = NDArray[np.float64]

EXACT = "exact"


@dataclass(frozen=True)
class ModelComparison:
    """Natural frequencies of several models of a mechanism held at the same crank angles.

    Attributes
    ----------
    names : tuple of str
        The models; ``exact`` is that of dynamic stiffness.
    size : ndarray of int
        Numbers of coordinates, ``(models,)``; 0 of the exact one.
    theta : ndarray
        Crank angles [rad], ``(nt,)``.
    frequency : ndarray
        Natural frequencies [rad/s], rising, ``(models, nt, count)``.
    """

    names: tuple[str, ...]
    size: NDArray[np.int64]
    theta: Array
    frequency: Array

    def difference(self, model: str, reference: str = EXACT) -> Array:
        """Return a model's frequencies over those of another, less 1, ``(nt, count)``."""
        one, other = (self.frequency[self.names.index(name)] for name in (model, reference))
        return np.asarray(one / other - 1.0)


def compare_models(
    models: Mapping[str, LinearPeriodic], theta: Array, count: int = 4, *, exact: bool = True
) -> ModelComparison:
    """Return the frequencies of several models and, by the first one's structure, the exact ones.

    Parameters
    ----------
    models : mapping of str to LinearPeriodic
        The models, for example with different elements.
    theta : ndarray
        Crank angles [rad], ``(nt,)``.
    count : int
        Number of frequencies.
    exact : bool
        Whether those of dynamic stiffness are computed too.
    """
    names, sizes = list(models), [system.size for system in models.values()]
    rows = [held_frequencies(system, theta, {})[0][:, :count] for system in models.values()]
    structure = next(iter(models.values())).structure
    if exact and structure is not None:
        names, sizes = [*names, EXACT], [*sizes, 0]
        rows.append(exact_frequencies(structure, theta, count))
    return ModelComparison(
        tuple(names), np.array(sizes, dtype=np.int64), np.asarray(theta), np.stack(rows)
    )


def exact_frequencies(structure: Structure, theta: Array, count: int) -> Array:
    """Return the lowest natural frequencies [rad/s] by dynamic stiffness, ``(nt, count)``."""
    problems = (dynamic_stiffness(structure, float(angle)) for angle in theta)
    return np.stack([wittrick_williams(one, count=count).frequencies[:count] for one in problems])
