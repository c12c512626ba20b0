"""Coefficients of collocation methods, which prove their order when they are made."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import SelfCheckFailed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CollocationTableau(ABC):
    """Coefficients of collocation at ``stages`` points of [0, 1].

    The constructor checks Butcher's simplifying assumptions B(order), C(s) and D(order - s), which
    together give the order, and what the method adds to them.

    Attributes
    ----------
    stages : int
        Number s of stages.
    c, b : ndarray
        Nodes and weights, shape ``(s,)``.
    a : ndarray
        Stage weights, shape ``(s, s)``.

    Raises
    ------
    SelfCheckFailed
        If one of the conditions does not hold to round-off.
    """

    stages: int
    c: Array
    b: Array
    a: Array

    method: ClassVar[str]

    @property
    @abstractmethod
    def order(self) -> int:
        """Order of the method."""

    @abstractmethod
    def _own_gaps(self) -> Mapping[str, Array]:
        """Return by name what is 0 in this method beside the simplifying assumptions."""

    def __post_init__(self) -> None:
        limit = 64 * self.stages * np.finfo(float).eps
        a, b, c, s = self.a, self.b, self.c, self.stages
        gaps = dict(self._own_gaps())
        for k in range(1, self.order + 1):
            gaps[f"B({k})"] = np.abs(b @ c ** (k - 1) - 1 / k)
        for k in range(1, s + 1):
            gaps[f"C({k})"] = np.abs(a @ c ** (k - 1) - c**k / k)
        for k in range(1, self.order - s + 1):
            gaps[f"D({k})"] = np.abs((b * c ** (k - 1)) @ a - b * (1 - c**k) / k)
        failed = [name for name, gap in gaps.items() if np.max(gap) > limit]
        if failed:
            raise SelfCheckFailed(f"{self.method} with {s} stages: {', '.join(failed)}")
