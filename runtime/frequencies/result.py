"""Natural frequencies of a frame with their shapes, between the nodes too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Transcendental
from ..core.plotting import axes_or_new
from ..core.results import Result
from .frames import DynamicStiffness
from .shapes import MemberShape, member_shape

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .solutions import Mode

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class FrameFrequencies(Result):
    """Natural frequencies of a structure of beams.

    Attributes
    ----------
    frequencies : ndarray, shape (n,)
        Ascending [rad/s], each as often as its multiplicity.
    multiplicity : ndarray, shape (n,)
        How many cannot be told apart within their errors.
    modes : tuple of Mode
        Their shapes; empty where the problem has no members.
    problem : Transcendental
        What they are frequencies of.
    error : ndarray, shape (n,)
        Bound of the error of each [rad/s].
    """

    frequencies: Array
    multiplicity: NDArray[np.int64]
    modes: tuple[Mode, ...]
    problem: Transcendental

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "frequencies": ("mode",),
        "multiplicity": ("mode",),
        "error": ("mode",),
        "hertz": ("mode",),
    }
    exported: ClassVar[tuple[str, ...]] = ("hertz",)

    @property
    def hertz(self) -> Array:
        """The frequencies in Hz."""
        return self.frequencies / (2.0 * np.pi)

    def vectors(self) -> Array:
        """Return the displacements of the nodes in each mode, ``(n, free)``.

        In the order of ``problem.labels`` [m, rad], of unit generalised mass; all zero where the
        nodes stand still.

        Raises
        ------
        BadInput
            If there are no shapes.
        """
        problem = self._members()
        places = {label: i for i, label in enumerate(problem.labels)}
        found = np.zeros((len(self.modes), len(places)))
        for row, mode in zip(found, self.modes, strict=True):
            inner = mode.problem.assembly.reduction @ mode.vector
            for label, value in zip(mode.problem.labels, inner, strict=True):
                if label in places:
                    row[places[label]] = value
        return found

    def shape(self, mode: int, beam: str, eta: ArrayLike) -> MemberShape:
        """Return the exact shape of a beam in a mode.

        Parameters
        ----------
        mode : int
            Which of the modes, from 0.
        beam : str
            Its name.
        eta : array_like, shape (m,)
            Places along it, in lengths, 0 to 1.

        Raises
        ------
        BadInput
            If there are no shapes, no such mode or beam, or a place lies outside.
        """
        self._members()
        known = isinstance(mode, (int, np.integer)) and not isinstance(mode, bool)
        if not known or not 0 <= mode < len(self.modes):
            raise bad("mode", repr(mode), f"0 to {len(self.modes) - 1}", "ask for more frequencies")
        chosen = self.modes[mode]
        return member_shape(chosen.problem.assembly, chosen.omega, chosen.vector, beam, eta)

    def _members(self) -> DynamicStiffness:
        if not isinstance(self.problem, DynamicStiffness):
            fix = "build it with dynamic_stiffness()"
            raise bad("problem", "one without members", "a structure of beams", fix)
        return self.problem

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies [Hz] over their number, those of several modes marked."""
        axes = axes_or_new(ax)
        number = np.arange(1, len(self.frequencies) + 1)
        axes.plot(number, self.hertz, "o", ms=4)
        several = self.multiplicity > 1
        axes.plot(number[several], self.hertz[several], "s", ms=9, mfc="none", label="multiple")
        if several.any():
            axes.legend()
        axes.set_xlabel("mode")
        axes.set_ylabel("natural frequency [Hz]")
        return axes
