"""Whether every linkage whose lengths lie within given limits can reach a crank angle."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Limits: TypeAlias = tuple[float, float]
Box: TypeAlias = Mapping[str, Limits]


def box_of(lengths: Mapping[str, float], tolerances: Mapping[str, float]) -> dict[str, Limits]:
    """Return the limits of each length."""
    return {
        name: (size - tolerances.get(name, 0.0), size + tolerances.get(name, 0.0))
        for name, size in lengths.items()
    }


def margin(box: Box, theta: Array, width: float = 0.0) -> Array:
    """Return how far the worst linkage of a box is from folding, in lengths.

    Parameters
    ----------
    box : mapping of str to (float, float)
        Limits of each length; their names tell the mechanism.
    theta : ndarray
        Crank angles [rad].
    width : float
        Tolerance of the crank angles [rad], less than a quarter turn.

    Returns
    -------
    ndarray
        Positive where every linkage of the box reaches the angle; exact, for the distances are
        convex functions of the lengths, and extreme in the angle at dead centres alone.
    """
    if width > 0.0:
        start = np.pi / 2 if "offset" in box else 0.0
        extreme = start + np.pi * np.round((theta - start) / np.pi)
        low, high = theta - width, theta + width
        angles = low, high, np.clip(extreme, low, high)
        return np.asarray(np.min([margin(box, angle) for angle in angles], axis=0))
    if "offset" in box:
        heights = [
            np.abs(offset - crank * np.sin(theta))
            for crank, offset in itertools.product(box["crank"], box["offset"])
        ]
        return np.asarray(box["coupler"][0] - np.max(heights, axis=0))
    if "rod" in box:
        near, far = _distances(box["frame"], box["crank"], theta + np.pi)
        return np.minimum(near, box["rod"][0] - far)
    near, far = _distances(box["frame"], box["crank"], theta)
    coupler, follower = box["coupler"], box["follower"]
    folded = max(coupler[1] - follower[0], follower[1] - coupler[0])
    return np.minimum(near - folded, coupler[0] + follower[0] - far)


def turns(box: Box) -> bool:
    """Return True where the crank of every linkage of the box turns fully."""
    extremes = np.array([np.pi / 2, -np.pi / 2] if "offset" in box else [0.0, np.pi])
    return bool(np.all(margin(box, extremes) > 0.0))


def _distances(first: Limits, second: Limits, angle: Array) -> tuple[Array, Array]:
    """Return least and greatest distance of the ends of two arms that enclose an angle."""

    def distance(a: Array | float, b: Array | float) -> Array:
        return np.asarray(np.hypot(a - b * np.cos(angle), b * np.sin(angle)))

    far = np.max([distance(a, b) for a, b in itertools.product(first, second)], axis=0)
    # For one arm given, the distance is least at the foot of the perpendicular.
    near = [distance(np.clip(b * np.cos(angle), *first), b) for b in second]
    near += [distance(a, np.clip(a * np.cos(angle), *second)) for a in first]
    return np.min(near, axis=0), far
