"""What tolerances do, as a result: sensitivities, worst case, root sum square, picture, trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.results import Result
from .subject import Subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .tolerance_trial import Distribution, ToleranceTrial

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Tolerances(Result):
    """What tolerances do to the motion, and for a machine to the forces, to first order.

    ``error``, shape (outputs, ...), is the figure of ``worst_case``: a bound of what the first
    order leaves out anywhere within the tolerances, from the exact sensitivities at the corners of
    the box that they span; it rests on the sensitivities being extreme at a corner.  The same
    figure holds for the deviation of any single linkage within the tolerances from its prediction.

    Attributes
    ----------
    theta2, omega2, alpha2 : ndarray, shape (...)
        Crank angle [rad], speed [rad/s] and acceleration [rad/s^2].
    outputs, parameters : tuple of str
        Names: ``theta3``, ``omega4``, ``x34``, ``torque`` ...; ``frame``, ``crank`` ..., the crank
        angle ``theta2``, and of a machine ``coupler.mass``, ``coupler.along`` ...
    nominal : ndarray, shape (outputs, ...)
        The values without deviations, in the units of :meth:`unit`.
    sensitivity : ndarray, shape (outputs, parameters, ...)
        Derivatives of every output by every parameter, the other parameters being fixed.
    tolerance : ndarray, shape (parameters,)
        Greatest deviation of each parameter from its nominal value, to either side.
    keeps_turning : bool
        True where the crank of every linkage within the tolerances turns fully.
    """

    theta2: Array
    omega2: Array
    alpha2: Array
    outputs: tuple[str, ...]
    parameters: tuple[str, ...]
    nominal: Array
    sensitivity: Array
    tolerance: Array
    keeps_turning: bool
    subject: Subject = field(repr=False)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta2": ("angle",),
        "omega2": ("angle",),
        "alpha2": ("angle",),
        "tolerance": ("parameter",),
        "nominal": ("output", "angle"),
        "error": ("output", "angle"),
        "worst_case": ("output", "angle"),
        "root_sum_square": ("output", "angle"),
        "sensitivity": ("output", "parameter", "angle"),
    }
    exported: ClassVar[tuple[str, ...]] = ("worst_case", "root_sum_square")

    @property
    def deviations(self) -> Array:
        """What each tolerance alone does, with its sign, shape (outputs, parameters, ...)."""
        return self.sensitivity * np.reshape(self.tolerance, (1, -1) + (1,) * self.theta2.ndim)

    @property
    def worst_case(self) -> Array:
        """Greatest deviation of each output, all tolerances at their worst, (outputs, ...)."""
        return np.asarray(np.sum(np.abs(self.deviations), axis=1))

    @property
    def root_sum_square(self) -> Array:
        """Root of the sum of the squared deviations, shape (outputs, ...).

        With tolerances that are standard deviations of independent parameters, or a fixed multiple
        of them, the standard deviation of the output, or the same multiple of it.
        """
        shares, largest = self._relative
        return np.asarray(largest[:, 0] * np.sqrt(np.sum(np.square(shares), axis=1)))

    @property
    def contribution(self) -> Array:
        """Share of each parameter in the squared root-sum-square, (outputs, parameters, ...)."""
        squares = np.square(self._relative[0])
        total = np.sum(squares, axis=1, keepdims=True)
        return np.asarray(squares / np.where(total > 0.0, total, 1.0))

    @property
    def _relative(self) -> tuple[Array, Array]:
        """Deviations over the largest of each output, and that: squares of any size are safe."""
        size = np.abs(self.deviations)
        largest = np.max(size, axis=1, keepdims=True)
        return size / np.where(largest > 0.0, largest, 1.0), largest

    def place(self, output: str) -> int:
        """Return the place of an output on the first axis.

        Raises
        ------
        BadInput
            If there is no such output.
        """
        if output not in self.outputs:
            found = f"one of {', '.join(self.outputs)}"
            raise bad("output", repr(output), found, "choose one; forces need a machine")
        return self.outputs.index(output)

    def by(self, output: str, parameter: str) -> Array:
        """Return the derivative of an output by a parameter, shape (...).

        Raises
        ------
        BadInput
            If there is no such output or parameter.
        """
        if parameter not in self.parameters:
            found = f"one of {', '.join(self.parameters)}"
            raise bad("parameter", repr(parameter), found, "choose one; masses need a machine")
        return np.asarray(self.sensitivity[self.place(output), self.parameters.index(parameter)])

    def unit(self, output: str) -> str:
        """Return the unit of an output; rates without a crank speed are over the crank's.

        Raises
        ------
        BadInput
            If there is no such output.
        """
        return self.subject.unit(self.outputs[self.place(output)])

    def monte_carlo(
        self, samples: int = 2000, seed: int = 0, distribution: Distribution = "normal"
    ) -> ToleranceTrial:
        """Return mean, standard deviation and extremes of every output over random parameters.

        Parameters
        ----------
        samples : int
            How many linkages are drawn.
        seed : int
            Of the generator; the same seed gives the same numbers.
        distribution : {"normal", "uniform"}
            Normal, the tolerance being three standard deviations, or uniform within the tolerance.

        Returns
        -------
        ToleranceTrial
            Its checks compare it with the first order, within the statistical error and the error
            figure.

        Raises
        ------
        BadInput
            If a number is out of range or the distribution is unknown.
        """
        from .tolerance_trial import trial

        return trial(self, samples, seed, distribution)

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        found = super().to_dict()
        del found["subject"]
        return {**found, "units": {name: self.unit(name) for name in self.outputs}}

    def plot(self, ax: Axes | None = None, output: str | None = None) -> Axes:
        """Draw the error band of an output against the crank angle.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        output : str, optional
            By default the angle of the follower or the rod, or the slider's place.

        Raises
        ------
        BadInput
            If there is no such output, or the crank angles are not a one-dimensional array.
        """
        from .tolerance_plots import draw

        return draw(self, ax, output)
