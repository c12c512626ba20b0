"""What Smith's section 9.5.3 says of each frequency response, against the computed ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .records import Quoted
from .smith_linkages import RPM, Array
from .smith_responses import (
    RESPONSE,
    Response,
    coupler,
    decrements,
    envelope,
    quiet_state,
    resonance,
)

_SCALE = 0.05
_SPEEDS = "5 %: motor scale 1.5 %, frequency 2 %, speeds in tens of rpm"
_SOFTER = (
    "the observed resonances of this coupler lie lower than by linear equations: a spring softens "
    "as its vibration grows, and its frequency, 13 Hz, is half of that at 1/16 in, not measured"
)
_DECAYING = (
    "no periodic motion resonates in this region: what is seen is a vibration of period 4 pi that "
    "is slow to die out"
)


def response_rows(one: Response) -> tuple[Quoted, ...]:
    """Return the rows of one frequency response."""
    rows = [_resonance(one, speed, order) for speed, order in one.resonances]
    return (*rows, *_SPECIAL.get(one.figure, _none)(one))


def _speed(number: str, printed: float, computed: float, differs: str = "") -> Quoted:
    far = abs(computed - printed) > _SCALE * printed
    return Quoted(
        number,
        printed,
        computed,
        _SCALE * printed,
        _SPEEDS,
        "9.5.3",
        unit="rpm",
        differs=differs if far else "",
    )


def _resonance(one: Response, speed: float, order: int) -> Quoted:
    differs = _SOFTER if one.chart == "85" else ""
    return _speed(f"resonance at Omega/{order}", speed, resonance(one.figure, speed), differs)


def _none(one: Response) -> list[Quoted]:
    del one
    return []


def _harmonics(one: Response) -> list[Quoted]:
    """Return how near to Omega/n each harmonic is greatest, n from 3 to 10."""
    return [_worst(one, range(3, 11), "from one tenth up to one third of the natural frequency")]


def _lower(one: Response) -> list[Quoted]:
    return [_worst(one, range(4, 8), "'the resonance detected at the lower speeds'")]


def _worst(one: Response, orders: range, words: str) -> Quoted:
    system = coupler(one.rig.scene, one.inertia, decrements(one.rig)[0])
    apart = []
    for order in orders:
        factor = np.linspace(0.94, 1.06, 61)
        motion = quiet_state(system, factor * one.rig.frequency / order)
        size = np.abs(np.fft.rfft(motion.q[..., 0], axis=-1)[:, order])
        apart.append(abs(float(factor[np.argmax(size)]) - 1.0))
    return Quoted(
        f"n-th harmonic, the farthest maximum from Omega/n, n = {orders[0]} to {orders[-1]}",
        100.0 * _SCALE,
        100.0 * max(apart),
        0.0,
        f"{words}; {_SPEEDS}",
        "9.5.3",
        relation="<",
        unit="%",
    )


def _unstable(one: Response, decrement: float) -> Array:
    """Return the speeds [rpm] drawn at which the motion is unstable."""
    found = envelope(one.figure, decrement)
    return np.asarray(found.speed[~found.stable])


def _increment(one: Response) -> list[Quoted]:
    """Return how a first increment of the inertia raises the amplitude near 300 rpm."""
    before = _size(RESPONSE["56"], 300.0)
    return [
        Quoted(
            "amplitude near 300 rpm over that with I4 = 0.0069 lbf in s2",
            1.5,
            _size(one, 300.0) / before,
            0.0,
            "'a most considerable increase' by a single increment: by half at least",
            "9.5.3",
            relation=">",
            differs="the periodic motion grows little; " + _DECAYING,
        )
    ]


def _size(one: Response, speed: float) -> float:
    found = envelope(one.figure, decrements(one.rig)[0])
    return float(np.interp(speed, found.speed, found.greatest - found.least))


def _region(one: Response) -> list[Quoted]:
    """Return the middle of the unstable region 2 Omega/5 below 300 rpm."""
    unstable = _unstable(one, decrements(one.rig)[0])
    here = unstable[(unstable > 245.0) & (unstable < 291.0)]
    row = _speed(
        "middle of the unstable speeds of 2 Omega/5",
        270.0,
        0.5 * float(here[0] + here[-1]),
        "the region moves down as the inertia grows: at this one it lies above 280 rpm",
    )
    return [row]


def _passed(one: Response) -> list[Quoted]:
    """Return place and end of the unstable region 2 Omega/3 at the least inertia."""
    unstable = _unstable(one, decrements(one.rig)[1])
    middle = 0.5 * float(unstable[0] + unstable[-1])
    return [
        _speed("vibration of period 4 pi, middle of 2 Omega/3", 460.0, middle, _SOFTER),
        _speed("end of the unstable region 2 Omega/3", 480.0, float(unstable[-1]), _SOFTER),
    ]


def _onset(one: Response) -> list[Quoted]:
    unstable = _unstable(one, decrements(one.rig)[1])
    return [_speed("onset of instability, 2 Omega/3", 450.0, float(unstable[0]))]


def _between(one: Response) -> list[Quoted]:
    """Return whether the periodic motion is largest somewhere about 500 rpm."""
    found = envelope(one.figure, decrements(one.rig)[0])
    height = found.greatest - found.least
    near = np.abs(found.speed - 500.0) < 15.0
    inside = np.flatnonzero(near)
    rises = height[inside] > np.maximum(height[inside - 1], height[inside + 1])
    return [
        Quoted(
            "maxima of the periodic motion within 15 rpm of 500 rpm, in 2 Omega/5",
            1.0,
            float(np.count_nonzero(rises)),
            0.0,
            "'resonances at 300, 400 and 500 rpm'",
            "9.5.3",
            differs=_DECAYING,
        )
    ]


def _calculated(one: Response) -> list[Quoted]:
    """Return the resonances against fractions of the calculated frequency."""
    whole = 26.5 * 60.0
    return [
        Quoted(
            f"resonance at Omega/{order} of the calculated frequency",
            whole / order,
            resonance(one.figure, whole / order),
            0.03 * whole / order,
            "26.5 Hz calculated, 26 Hz seen: 2 %, and 1 % for the follower's load",
            "9.5.3",
            unit="rpm",
        )
        for order in (3, 4, 5, 6)
    ]


def _above(one: Response) -> list[Quoted]:
    unstable = _unstable(one, decrements(one.rig)[1])
    onset = float(unstable[unstable > 1.2 * one.rig.frequency / RPM / 2][0])
    return [_speed("onset of instability, 2 Omega/3", 900.0, onset)]


_SPECIAL: dict[str, Callable[[Response], list[Quoted]]] = {
    "52": _harmonics,
    "57": _increment,
    "58": _region,
    "59": _region,
    "60": _region,
    "63": _passed,
    "65": _onset,
    "66": _passed,
    "68": _onset,
    "75": _between,
    "76": _lower,
    "79": _calculated,
    "80": _above,
}
