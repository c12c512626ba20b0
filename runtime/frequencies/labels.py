"""Naming critical speeds by the mean frequency that they divide."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def label_speeds(mean: Array, speed: Array) -> tuple[Indices, Indices]:
    """Return mode (from 1) and order of each speed: whose mean frequency over n is nearest.

    The pairs that fit best choose first, and no label is given twice where another is left.

    Parameters
    ----------
    mean : ndarray
        Mean frequencies [rad/s], ``(modes,)``.
    speed : ndarray
        Speeds [rad/s], ``(ns,)``.
    """
    ratio = mean / speed[:, None]
    orders = np.maximum(1, np.round(ratio)).astype(np.int64)
    # How far the speed is from the fraction, over itself: of high orders all are near.
    misfit = np.abs(ratio - orders) / orders
    mode, order = np.zeros((2, len(speed)), dtype=np.int64)
    taken: set[tuple[int, int]] = set()
    for place, column in zip(
        *np.unravel_index(np.argsort(misfit, axis=None, kind="stable"), misfit.shape), strict=True
    ):
        label = int(column) + 1, int(orders[place, column])
        if not mode[place] and label not in taken:
            taken.add(label)
            mode[place], order[place] = label
    rest = mode == 0
    nearest = np.argmin(misfit, axis=1)
    mode[rest], order[rest] = nearest[rest] + 1, orders[rest, nearest[rest]]
    return mode, order
