"""Several models of one mechanism compared over the cycle (Aannaque 4.3, 5.4.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams._checks import numbers_in_a_row, require_kind, require_mapping
from ..beams.structure import Structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import require_whole
from ..core.progress import bar
from ..core.results import Result, provenance
from ..floquet.first_order import even_angles
from .held import crank_angles, held_frequencies, require_system

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_ANGLES = 72
# Exact frequencies at an angle that can be asked for.
_MOST_EXACT = 1000
EXACT = "exact"


@dataclass(frozen=True, kw_only=True)
class ModelComparison(Result):
    """Natural frequencies of several models of a mechanism held at the same crank angles.

    Attributes
    ----------
    names : tuple of str
        The models; ``exact`` is that of dynamic stiffness.
    size : ndarray of int
        Numbers of coordinates, ``(nm,)``.
    theta : ndarray
        Crank angles [rad], ``(nt,)``; means are over them.
    frequency : ndarray
        Natural frequencies [rad/s], rising, ``(nm, nt, count)``.
    error : ndarray
        Of each frequency [rad/s], as that of its model, ``(nm, nt, count)``.
    """

    names: tuple[str, ...]
    size: NDArray[np.int64]
    theta: Array
    frequency: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "size": ("model",),
        "theta": ("angle",),
        **dict.fromkeys(("frequency", "error"), ("model", "angle", "mode")),
    }

    def difference(self, model: str, reference: str = EXACT) -> Array:
        """Return a model's frequencies over those of another, less 1, ``(nt, count)``.

        Raises
        ------
        BadInput
            If a model is not among the names.
        """
        rows = []
        for name in (model, reference):
            if name not in self.names:
                raise bad("model", repr(name), f"one of {self.names}", "correct the name")
            rows.append(self.frequency[self.names.index(name)])
        return np.asarray(rows[0] / rows[1] - 1.0)

    def mean_difference(self, model: str, reference: str = EXACT) -> Array:
        """Return the mean of :meth:`difference` over the angles, ``(count,)``."""
        return np.asarray(np.mean(self.difference(model, reference), axis=0))

    def largest_difference(self, model: str, reference: str = EXACT) -> Array:
        """Return the largest size of :meth:`difference` over the angles, ``(count,)``."""
        return np.asarray(np.max(np.abs(self.difference(model, reference)), axis=0))

    def plot_mode(self, mode: int = 1, ax: Axes | None = None) -> Axes:
        """Draw one natural frequency of all models over the crank angle (Figs. 4.6, 5.3)."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for name, size, values in zip(self.names, self.size, self.frequency, strict=True):
            dashed = "--" if name == EXACT else "-"
            label = name if name == EXACT else f"{name} ({size})"
            ax.plot(np.degrees(self.theta), values[:, mode - 1], dashed, lw=1.1, label=label)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel(f"natural frequency {mode} [rad/s]")
        ax.legend(fontsize=8)
        return ax

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first natural frequency of all models and return the axes."""
        return self.plot_mode(1, ax)


def compare_models(
    models: Mapping[str, LinearPeriodic],
    theta: ArrayLike | None = None,
    count: int = 4,
    *,
    exact: bool = True,
    progress: bool = False,
) -> ModelComparison:
    """Return the natural frequencies of several models of a mechanism, and the exact ones.

    Parameters
    ----------
    models : mapping of str to LinearPeriodic
        The models, for example with different elements.
    theta : array_like, optional
        Crank angles [rad]; 72 even ones by default.
    count : int
        Number of frequencies.
    exact : bool
        Whether the exact ones are found by dynamic stiffness, from the first model's structure.
    progress : bool
        Whether to show a progress bar (extra ``progress``) for the exact ones.

    Returns
    -------
    ModelComparison

    Raises
    ------
    BadInput
        If there is no model, one has fewer freedoms than are asked for or, for the exact ones, no
        structure, or an angle is unusable.
    """
    require_mapping("models", models, "give systems by name")
    if not models:
        raise bad("models", "none", "at least one", "give some by name")
    for system in models.values():
        require_system(system)
    first = next(iter(models.values()))
    angles = even_angles(first.period, _ANGLES) if theta is None else crank_angles(first, theta)
    smallest = min(system.size for system in models.values())
    require_whole("count", count, 1, smallest)
    pairs = [held_frequencies(system, angles, {}) for system in models.values()]
    frequency, error = ([pair[k][:, :count] for pair in pairs] for k in (0, 1))
    names, sizes = list(models), [system.size for system in models.values()]
    if exact:
        if first.structure is None:
            raise bad("models", "a first one without beams", "one made of beams", "exact=False")
        found, bound = exact_frequencies(first.structure, angles, count, progress=progress)
        frequency, error = [*frequency, found], [*error, bound]
        names, sizes = [*names, EXACT], [*sizes, 0]
    return ModelComparison(
        method="each model's generalised eigenvalue problem; dynamic stiffness",
        error=np.stack(error),
        error_norm="absolute, of each frequency [rad/s] as its model has it",
        provenance=provenance(first.provenance),
        names=tuple(names),
        size=np.array(sizes, dtype=np.int64),
        theta=angles,
        frequency=np.stack(frequency),
    )


def exact_frequencies(
    structure: Structure, theta: ArrayLike, count: int, *, progress: bool = False
) -> tuple[Array, Array]:
    """Return the exact natural frequencies of a held linkage and their errors, ``(nt, count)``.

    Parameters
    ----------
    structure : Structure
        Beams and nodes; numbers and kinds of elements play no part.
    theta : array_like
        Crank angles [rad], ``(nt,)``.
    count : int
        Number of frequencies, the lowest.
    progress : bool
        Whether to show a progress bar.

    Raises
    ------
    BadInput
        If the structure is none, an angle is unusable, or the count no whole number from 1 to 1000.
    """
    from . import dynamic_stiffness, wittrick_williams

    require_kind("structure", structure, Structure, "make one with beam_linkage or frame")
    angles = numbers_in_a_row("theta", theta, " [rad]")
    require_whole("count", count, 1, _MOST_EXACT)
    frequency, error = np.empty((2, len(angles), count))
    with bar(progress, len(angles)) as tick:
        for k, angle in enumerate(angles):
            found = wittrick_williams(dynamic_stiffness(structure, float(angle)), count=count)
            frequency[k], error[k] = found.frequencies[:count], found.error[:count]
            if tick is not None:
                tick(k + 1)
    return frequency, error
