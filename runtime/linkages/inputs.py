"""What linkages are given: lengths, crank angles and the drive, checked before any work starts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from numbers import Real
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import Problem, bad

Array = NDArray[np.float64]
Assembly = Literal["open", "crossed"]


def drive_of(
    theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike
) -> tuple[Array, tuple[Array, Array]]:
    """Return the angles, and speed and acceleration in the shape of all three.

    Raises
    ------
    BadInput
        If one of them is no array of finite numbers, or their shapes do not fit together.
    """
    angles = _finite("theta", theta, "angles [rad]")
    given = (
        _finite("speed", speed, "crank speeds [rad/s]"),
        _finite("acceleration", acceleration, "crank accelerations [rad/s^2]"),
    )
    try:
        shape = np.broadcast_shapes(angles.shape, *(item.shape for item in given))
    except ValueError as refusal:
        shapes = ", ".join(str(item.shape) for item in (angles, *given))
        raise bad(
            "theta, speed, acceleration", f"shapes {shapes}", "shapes that broadcast", "correct one"
        ) from refusal
    first, second = (np.array(np.broadcast_to(item, shape)) for item in given)
    return angles, (first, second)


def by_name(angles: Array, names: Iterable[str], values: Iterable[Any]) -> dict[str, Array]:
    """Return what an emitted motion gives as arrays by name, the crank angle as ``theta2``."""
    return {"theta2": angles, **dict(zip(names, map(np.asarray, values), strict=True))}


def spread(value: Array, drive: tuple[Array, Array]) -> Array:
    """Return an array in the shape of the drive."""
    shape = drive[0].shape
    return value if value.shape == shape else np.array(np.broadcast_to(value, shape))


def rates_of(drive: tuple[Array, Array], first: Array, second: Array) -> tuple[Array, Array]:
    """Return speed and acceleration from derivatives by the crank angle (Smith 2.10)."""
    speed, acceleration = drive
    return speed * first, speed**2 * second + acceleration * first


def _finite(name: str, value: ArrayLike, meaning: str) -> Array:
    """Return an array of finite numbers, or raise BadInput."""
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError) as refusal:
        found = repr(value)[:60]
        raise bad(name, found, f"an array of {meaning}", "correct it") from refusal
    if not np.all(np.isfinite(array)):
        raise bad(name, "a value that is not finite", f"finite {meaning}", "remove it")
    return array


def length_problems(owner: str, lengths: Mapping[str, Any]) -> list[Problem]:
    """Return what is wrong with lengths that must be positive."""
    return [
        Problem(f"{owner}.{name}", repr(value), "a positive finite length", "correct it")
        for name, value in lengths.items()
        if not (isinstance(value, Real) and 0.0 < float(value) < np.inf)
    ]


def assembly_problems(owner: str, assembly: object) -> list[Problem]:
    """Return what is wrong with the name of an assembly."""
    if assembly in ("open", "crossed"):
        return []
    return [Problem(f"{owner}.assembly", repr(assembly), "'open' or 'crossed'", "choose one")]
