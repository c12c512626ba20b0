"""Where multipliers of opposite Krein signature meet on the unit circle as the speed changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.families import LinearPeriodic
from ...periodic import monodromy
from ...periodic.first_order import canonical_form
from ..krein import krein_signatures

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Turn of the fastest mode from one sample to the next [rad].
_TURN = 0.3
_MOST_SAMPLES = 40_000
_TOGETHER = 256
# How far a sum of phases may lie from a whole turn where the multipliers are taken for locked.
_LOCKED = 1e-4
_TURN_ROUND = 2.0 * np.pi


@dataclass(frozen=True)
class Events:
    """Meetings of multipliers, each between two sampled speeds; arrays of shape ``(k,)``.

    Attributes
    ----------
    low, high : ndarray
        Speeds on either side, where the pair is apart; NaN where the range ends first, or where
        one of the two is then at +-1 and off the circle.
    inside : ndarray
        A sampled speed where the pair was found off the circle or not told apart; NaN where none.
    reach : ndarray, shape (k, 2)
        First and last sampled speed inside, or low and high where there is none.
    plus, minus : ndarray, shape (k, 2)
        Arguments of the multipliers of positive and of negative signature at low and high.
    """

    low: Array
    high: Array
    inside: Array
    reach: Array
    plus: Array
    minus: Array


@dataclass(frozen=True)
class Samples:
    """Lifted arguments of the multipliers of positive signature over the speed.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Rising.
    phase : ndarray, shape (ns, n)
        Followed from sample to sample; up to a whole number of turns.
    open : ndarray of bool, shape (ns, n)
        True where the multiplier is off the circle or its signature open.
    """

    speed: Array
    phase: Array
    open: Flags


def phase_grid(
    system: LinearPeriodic,
    span: tuple[float, float],
    parameters: Mapping[str, float],
    more: Array,
) -> Array:
    """Return speeds from one to the next of which no mode turns far, and further ones, rising.

    Raises
    ------
    BadInput
        If the range needs more than 40 000 of them.
    """
    low, high = span
    ends = canonical_form(system, np.array([low, high]), parameters)
    fastest = float(np.max(ends.rate * ends.speed))
    count = int(np.ceil(fastest * system.period * (1 / low - 1 / high) / _TURN)) + 2
    if count > _MOST_SAMPLES:
        raise bad(
            "speed_range",
            f"a lowest speed of {low:.4g} rad/s, which needs {count} samples",
            f"at most {_MOST_SAMPLES}",
            "raise the lowest speed or leave out the highest modes",
        )
    # Phases grow with the inverse speed.
    even = 1.0 / np.linspace(1 / low, 1 / high, max(count, 8))
    speed: Array = np.unique(np.concatenate([even, more]))
    return speed


def sampled_phases(
    system: LinearPeriodic,
    span: tuple[float, float],
    parameters: Mapping[str, float],
    rtol: float,
    more: Array,
) -> Samples:
    """Return the phases of a conservative system over a range of speeds.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    span : pair of float
        Speeds [rad/s].
    parameters : mapping
        Parameter values that replace the system's own.
    rtol : float
        Of the monodromy matrices.
    more : ndarray
        Further speeds to be sampled [rad/s].

    Raises
    ------
    BadInput
        If the range needs more than 40 000 samples.
    """
    speed = phase_grid(system, span, parameters, more)
    phases, flags = [], []
    for start in range(0, len(speed), _TOGETHER):
        result = monodromy(system, speed[start : start + _TOGETHER], rtol=rtol, **parameters)
        with np.errstate(over="ignore"):
            scaled = np.ldexp(result.scaled, result.exponent[:, None, None])
        if not np.all(np.isfinite(scaled)):
            raise bad(
                "speed_range",
                "growth beyond double precision within a turn",
                "speeds of moderate growth",
                "raise the lowest speed",
            )
        found = krein_signatures(scaled, result.error)
        for values, signs in zip(found.multipliers, found.signatures, strict=True):
            angle, undecided = _positive(np.angle(values), signs)
            phases.append(angle)
            flags.append(undecided)
    return Samples(speed, *_followed(np.array(phases), np.array(flags)))


def _positive(angle: Array, signs: NDArray[np.int8]) -> tuple[Array, Flags]:
    """Return the n arguments of positive signature, rising, and which of them are open.

    Multipliers whose signature is open come in groups of like argument, half of them positive.
    """
    decided = angle[signs == 1]
    rest = np.sort(np.mod(angle[signs == 0], _TURN_ROUND))[::2]
    both = np.mod(np.concatenate([decided, rest]), _TURN_ROUND)
    undecided = np.concatenate([np.zeros(len(decided), bool), np.ones(len(rest), bool)])
    order = np.argsort(both, kind="stable")
    return both[order], undecided[order]


def _followed(phases: Array, flags: Flags) -> tuple[Array, Flags]:
    """Order the phases so that each follows its own, which keeps the order round the circle."""
    n = phases.shape[1]
    lifted, ordered = np.array(phases), np.array(flags)
    place = np.arange(n)
    for t in range(1, len(phases)):
        best: tuple[float, Array, NDArray[np.intp]] | None = None
        for shift in range(n):
            target = np.roll(place, -shift)
            step = phases[t][target] - lifted[t - 1]
            step = step - _TURN_ROUND * np.round(step / _TURN_ROUND)
            cost = float(np.sum(np.abs(step)))
            if best is None or cost < best[0]:
                best = cost, step, target
        if best is not None:
            lifted[t] = lifted[t - 1] + best[1]
            ordered[t] = flags[t][best[2]]
            # Positions on the circle rotate with what was matched.
            phases[t] = phases[t][best[2]]
    return lifted, ordered


def meetings(samples: Samples, principal: bool = False) -> Events:
    """Return where sums of the phases of two modes pass a whole number of turns.

    With ``principal`` a mode meets itself instead: its two multipliers, at +1 or -1.

    A multiplier of positive signature at phase a meets one of negative signature at -b, the
    conjugate of b, where a + b is a whole number of turns.  Meetings while one of the two is off
    the circle at +-1 are none: it is not there to be met.
    """
    n = samples.phase.shape[1]
    rows: list[tuple[float, float, float, Array, Array, Array]] = []
    real = samples.open & (_off_turn(2 * samples.phase) < _LOCKED)
    for k in range(n):
        for other in (k,) if principal else range(k + 1, n):
            total = samples.phase[:, k] + samples.phase[:, other]
            locked = samples.open[:, k] & samples.open[:, other] & (_off_turn(total) < _LOCKED)
            hidden = np.zeros_like(locked) if principal else real[:, k] | real[:, other]
            for first, last, run in _passages(total / _TURN_ROUND, locked & ~hidden, hidden):
                inside = run[len(run) // 2] if run else None
                low, high, middle = (_at(samples.speed, i) for i in (first, last, inside))
                reach = samples.speed[[run[0], run[-1]]] if run else np.array([low, high])
                kept = [i for i in (first, last) if i is not None] or [inside or 0]
                at = [kept[0], kept[-1]]
                plus, minus = samples.phase[at, k], -samples.phase[at, other]
                rows.append((low, high, middle, reach, plus, minus))
    columns = list(zip(*rows, strict=True)) if rows else [()] * 6
    ends = [np.array(column, dtype=float) for column in columns[:3]]
    angles = [np.array(column, dtype=float).reshape(-1, 2) for column in columns[3:]]
    return Events(*ends, *angles)


def _at(values: Array, index: int | None) -> float:
    return float("nan") if index is None else float(values[index])


def _off_turn(phase: Array) -> Array:
    turns = phase / _TURN_ROUND
    distance: Array = np.abs(turns - np.round(turns)) * _TURN_ROUND
    return distance


Passage = tuple[int | None, int | None, list[int]]


def _passages(turns: Array, locked: Flags, hidden: Flags) -> list[Passage]:
    """Return samples before, after and those inside each passage of a whole number of turns."""
    found: list[Passage] = []
    before: int | None = None
    run: list[int] = []
    for t in range(len(turns)):
        if locked[t]:
            run.append(t)
            continue
        if run:
            found.append((before, None if hidden[t] else t, run))
        elif before is not None and not hidden[t] and np.floor(turns[t]) != np.floor(turns[before]):
            found.append((before, t, []))
        before, run = None if hidden[t] else t, []
    if run:
        found.append((before, None, run))
    return found
