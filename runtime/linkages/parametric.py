"""A motion as a function of its numbers, and derivatives by a complex step.

An emitted function is evaluated beside a number, a step off along the imaginary axis.  The square
of a step of 1e-40 of the number vanishes beside what follows from it, so that nothing is
subtracted: the derivative is good to the round-off of the function itself (Squire and Trapp 1998).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from .linkage import Array, Linkage, Motion, driven, emitted

ANGLE = "theta2"


@dataclass(frozen=True)
class Parametric:
    """The motion of a linkage at given crank angles as a function of its lengths.

    The numbers may be arrays (of samples), complex ones (of derivatives), or Taylor models.
    """

    linkage: Linkage  # lengths and assembly
    # theta, speed, acceleration: (...): crank angle [rad], speed [rad/s], acceleration
    # [rad/s^2], of one shape
    theta: Array
    speed: Array
    acceleration: Array

    @property
    def values(self) -> dict[str, float]:
        """Every number by name: lengths, and how far the crank angle is off."""
        lengths = {name: float(size) for name, size in self.linkage.lengths.items()}
        return {**lengths, ANGLE: 0.0}

    def evaluate(self, numbers: Mapping[str, Any]) -> dict[str, Any]:
        """Return every output of the numbers; what cannot close is not finite."""
        with np.errstate(all="ignore"):
            return self._moved(self._angle(numbers), numbers)

    def derivatives(
        self, numbers: Mapping[str, float], names: tuple[str, ...]
    ) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return values of shape (...) and derivatives by the named numbers, shape (n, ...)."""
        count, batch = len(names), self.theta.shape
        rows = (count, *(1,) * len(batch))
        # Of the size of a number.
        steps = np.array([1e-40 * self._size(name) for name in names])
        ahead = dict(numbers)
        for name, step in zip(names, 1j * np.diag(steps), strict=True):
            ahead[name] = numbers[name] + step.reshape(rows)
        values, slopes = {}, {}
        for name, number in self.evaluate(ahead if count else numbers).items():
            full = np.broadcast_to(number, (max(count, 1), *batch))
            values[name] = full[0].real.copy()
            slopes[name] = full[:count].imag / steps.reshape(rows)
        return values, slopes

    def _size(self, name: str) -> float:
        return 1.0 if name == ANGLE else max(abs(size) for size in self.linkage.lengths.values())

    def _angle(self, numbers: Mapping[str, Any]) -> Any:
        """Return the crank angle; complex beside complex numbers, for its functions."""
        theta = self.theta + numbers[ANGLE]
        stepped = any(np.iscomplexobj(number) for number in numbers.values())
        return np.asarray(theta).astype(complex).view(_Stepped) if stepped else theta

    def _moved(self, theta: Any, numbers: Mapping[str, Any]) -> dict[str, Any]:
        scale = 2.0**self.linkage.scale
        lengths = {name: numbers[name] * scale for name in self.linkage.names}
        m = emitted(self.linkage, self.linkage.moves.kinematics, "motion", theta, lengths)
        return {
            name: value / scale if self.linkage.moves.unit_of(name).startswith("m") else value
            for name, value in driven(m, self.speed, self.acceleration).items()
        }

    def _motion(self, theta: Any, numbers: Mapping[str, Any], moved: Mapping[str, Any]) -> Motion:
        """Return what :meth:`_moved` has computed as a motion, for points of the links."""
        lengths = {name: numbers[name] for name in self.linkage.names}
        linkage: Any = SimpleNamespace(lengths=lengths, links=self.linkage.links)
        drive: Any = {"omega2": self.speed, "alpha2": self.acceleration}
        result: Any = {"method": "", "error": 0.0, "error_norm": ""}
        return self.linkage.moves(
            linkage=linkage, theta2=np.asarray(theta), **drive, **moved, **result
        )


class _Stepped(np.ndarray[Any, Any]):
    """Complex angles: what emitted functions take their namespace from."""

    def __array_namespace__(self, *, api_version: str | None = None) -> Any:
        return _Functions


class _Functions:
    """The functions of emitted modules beside the real axis."""

    sin, cos, tan = staticmethod(np.sin), staticmethod(np.cos), staticmethod(np.tan)

    @staticmethod
    def sqrt(square: Any) -> Any:
        # What cannot close stays no number.
        return np.where(np.real(square) < 0.0, np.nan, np.sqrt(square))

    @staticmethod
    def atan2(y: Any, x: Any) -> Any:
        height, width = np.real(y), np.real(x)
        turned = (width * np.imag(y) - height * np.imag(x)) / (height * height + width * width)
        return np.arctan2(height, width) + 1j * turned
