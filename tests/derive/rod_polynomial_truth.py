"""Piecewise polynomial shapes in many digits, by numerical derivatives of their definition."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import mpmath
import numpy as np
from judging import Exact, Point, exact_at

MODULE = "quick_return_rod_polynomials"
# Which derivatives by (eta, xi) each output is.
_ORDERS = {
    "value": (0, 0),
    "slope": (1, 0),
    "curvature": (2, 0),
    "shear": (3, 0),
    "drift": (0, 1),
    "drift_curvature": (2, 1),
}
# End conditions that multiply the polynomial of s, on a side of length 1.
_FACTORS = {
    "turn_bay": lambda s: s * (s - 1),
    "turn_tail": lambda s: s,
    "bubble_bay": lambda s: s * (1 - s) ** 2,
    "bubble_tail": lambda s: s**2,
}


def _cubic(numbers, letter, centre):
    """Return the cubic with given value and derivatives at a point."""
    rates = [numbers[letter], *(numbers[f"{letter}_d{k}"] for k in (1, 2, 3))]

    def cubic(x):
        return sum(rate * (x - centre) ** k / mpmath.factorial(k) for k, rate in enumerate(rates))

    return cubic


def _shape(function, numbers):
    """Return the shape as a function of (eta, xi), and the point at which it is wanted."""
    if function.startswith("through"):
        bay = function == "through_bay"
        eta = numbers["eta"] if bay else numbers["gap"] + numbers["xi"]
        xi = eta - numbers["gap"] if bay else numbers["xi"]
        p = _cubic(numbers, "p", eta)
        return lambda e, x: (e if bay else x) * (e - x) * p(e), (eta, xi)
    s, length, factor = numbers["s"], numbers["length"], _FACTORS[function]
    j = _cubic(numbers, "j", s)
    if function.endswith("bay"):
        return lambda e, x: x * factor(e / x) * j(e / x), (s * length, length)

    def tail(e, x):
        local = (e - x) / (1 - x)
        return (1 - x) * factor(local) * j(local)

    return tail, (1 - length + s * length, 1 - length)


def _reference(function):
    def values(numbers):
        shape, at = _shape(function, numbers)
        # Differences leave 1e-80 where a derivative vanishes.
        found = {name: mpmath.diff(shape, at, orders) for name, orders in _ORDERS.items()}
        return {name: mpmath.chop(value, 1e-60) for name, value in found.items()}

    return values


def _places(function) -> Iterator[tuple[str, dict[str, float]]]:
    random = np.random.default_rng(91)
    through = function.startswith("through")
    for i in range(40):
        u, v = random.uniform(0.0, 1.0, 2) if i % 2 else 10.0 ** random.uniform(-9, 0, 2)
        yield f"random {i}", _place(function, float(u), float(v))
    for name, s in (("pin or block", 0.0), ("other end", 1.0), ("near it", 1.0 - 2.0**-40)):
        yield name, _place(function, s, 0.6)
    if not through:
        for root in (1 / 3, 0.4, 2 / 3, 0.75, 4 / 7):
            yield f"at a change of sign, {root:.3f}", {"s": root, "length": 0.37}


def _place(function, s, length):
    if function == "through_bay":
        return {"eta": s * length, "gap": -length * (1.0 - s)}
    if function == "through_tail":
        return {"gap": s * (1.0 - length), "xi": length}
    return {"s": s, "length": length}


@lru_cache(maxsize=8)
def exact_polynomials(function: str) -> tuple[Exact, ...]:
    """Return the exact values of one emitted function at random and nasty points."""
    random = np.random.default_rng(92)
    letter = "p" if function.startswith("through") else "j"
    found = []
    for name, place in _places(function):
        size = random.normal(size=4) * np.array([1.0, 10.0, 1e3, 1e5])
        values = dict(zip((letter, *(f"{letter}_d{k}" for k in (1, 2, 3))), size, strict=True))
        inputs = {**place, **{key: float(value) for key, value in values.items()}}
        found.append(exact_at(_reference(function), Point(name, inputs)))
    return tuple(found)
