"""Points at which Meissner's matrices are judged, and an interval by complex square roots."""

import math

import mpmath
import numpy as np
from elastolink.generated import hill_meissner
from judging import Point

COUNTS = {"two_intervals": 2, "three_intervals": 3, "four_intervals": 4}


def interval(numbers):
    """Return cos(v t) and sin(v t) / v with v the complex root of the level."""
    level, length = numbers["level"], numbers["length"]
    if level == 0:
        return {"cosine": mpmath.mpf(1), "sine": length}
    v = mpmath.sqrt(mpmath.mpc(level))
    return {"cosine": mpmath.cos(v * length).real, "sine": (mpmath.sin(v * length) / v).real}


def _interval_points():
    random = np.random.default_rng(71)
    for i in range(200):
        # Phases v t up to 1e6, hyperbolic ones up to 600.
        sign = random.choice([1.0, -1.0])
        length = 10.0 ** random.uniform(-6, 3)
        phase = 10.0 ** random.uniform(-9, 6 if sign > 0 else math.log10(600.0))
        inputs = {"level": float(sign * (phase / length) ** 2), "length": float(length)}
        yield Point(f"random {i}", inputs)
    for level in (0.0, -0.0, 5e-324, -5e-324, 1e-300, -1e-300, 1e-16, -1e-16, 1e8):
        yield Point(f"level {level:g}", {"level": level, "length": math.pi})
    yield Point("no length", {"level": 2.0, "length": 0.0})
    yield Point("length 1e-300", {"level": -3.0, "length": 1e-300})
    for j in range(1, 9):
        for nudge in (0.0, 1e-9, -1e-15):
            level = (0.5 * j * (1.0 + nudge)) ** 2
            name = f"{j} quarter turns, off by {nudge:g}"
            yield Point(name, {"level": level, "length": math.pi})


def _state(levels, lengths):
    """Return the arguments of several intervals, rounded to doubles."""
    found = {}
    for i, (level, length) in enumerate(zip(levels, lengths, strict=True), start=1):
        with mpmath.workdps(60):
            at = interval({"level": mpmath.mpf(level), "length": mpmath.mpf(length)})
        found |= {f"c{i}": float(at["cosine"]), f"s{i}": float(at["sine"]), f"q{i}": float(level)}
    return found


def _interval_states(count):
    random = np.random.default_rng(72 + count)
    for i in range(120):
        scale = 10.0 ** random.uniform(-6, 2)
        levels = scale * random.uniform(-0.3, 1.0, count)
        lengths = random.dirichlet(np.ones(count)) * 2.0 * math.pi
        yield f"random {i}", _state(levels, lengths)
    even = [2.0 * math.pi / count] * count
    yield "no level", _state([0.0] * count, even)
    yield "equal levels at an edge", _state([1.0] * count, even)
    yield "a hair from one edge", _state([1.0 + 1e-9 * k for k in range(count)], even)
    yield "opposite levels", _state([(-1.0) ** k for k in range(count)], even)
    yield "levels far apart", _state([10.0 ** (3 * k - 4) for k in range(count)], even)
    # v t = j pi in every interval: both ends of a region at one place.
    both = [(j * count / 2.0) ** 2 for j in range(1, count + 1)]
    yield "coexistence", _state(both, even)


def meissner_points(function):
    """Yield random and nasty points of one emitted function."""
    if function == "interval":
        yield from _interval_points()
        return
    count = {"half_turn": 2, "one_more_interval": 1}.get(function) or COUNTS[function]
    random = np.random.default_rng(77)
    for name, state in _interval_states(count):
        if function == "one_more_interval":
            given = _state(random.uniform(-1.0, 9.0, 3), [2.0, 2.0, 2.0])
            parts = hill_meissner.three_intervals(**given)
            before = dict(zip(hill_meissner.RETURNS["three_intervals"], parts, strict=True))
            state = {**{f"{key}_before": float(v) for key, v in before.items()}, **state}
        yield Point(name, state)
