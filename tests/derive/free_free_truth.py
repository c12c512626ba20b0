"""Free-free modes by hand in many digits, and the rod in Buckens' frame before its lowering.

Modes are sums of four growing and decaying exponentials on roots refined to the last digit, their
integrals those of polynomials times exponentials.
"""

import importlib
import inspect
import itertools
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache

import mpmath
import numpy as np
from elastolink import generated
from elastolink.derive.models import free_free_rod as rod
from elastolink.runtime.core.families import Constrained
from frequency_truth import clamped_root
from judging import Exact, Point, Reference
from scalar_entries import ScalarEntries, derived_reference

MODES_MODULE = "beam_free_free_modes"
ROD_MODULE = "quick_return_rod_free_free"
DIGITS = 140
NUMBERS = (*range(1, 13), 30, 59, 60)


def parity(i: int) -> int:
    return 1 if i % 2 else -1


@lru_cache(maxsize=64)
def root(i: int):
    """Return the i-th positive root of ``cos b cosh b = 1``."""
    with mpmath.workdps(DIGITS):
        return clamped_root(i)


@lru_cache(maxsize=64)
def exponentials(i: int):
    """Return psi_i as pairs (factor, exponent) in s from the middle; psi_i is 2 at s = 1/2."""
    with mpmath.workdps(DIGITS):
        b = root(i)
        swing, rise = (
            (mpmath.cos(b / 2), mpmath.cosh(b / 2))
            if parity(i) > 0
            else (mpmath.sin(b / 2), mpmath.sinh(b / 2))
        )
        j, p = mpmath.mpc(0, 1), parity(i)
        turned = swing if p > 0 else swing * j
        return (
            (1 / (2 * turned), j * b),
            (p / (2 * turned), -j * b),
            (1 / (2 * rise), b),
            (p / (2 * rise), -b),
        )


def mode(i: int, s, order: int = 0):
    """Return a derivative of psi_i at s."""
    with mpmath.workdps(DIGITS):
        return mpmath.re(sum(a * r**order * mpmath.exp(r * s) for a, r in exponentials(i)))


def _moment(power: int, rate):
    """Return ``int s^power exp(rate s) ds`` over the beam."""
    half = mpmath.mpf(1) / 2
    if abs(rate) < mpmath.mpf(10) ** -100:
        return (half ** (power + 1) - (-half) ** (power + 1)) / (power + 1)
    total, sign, factor = mpmath.mpc(0), 1, mpmath.mpf(1)
    for k in range(power + 1):
        ends = half ** (power - k) * mpmath.exp(rate * half)
        ends -= (-half) ** (power - k) * mpmath.exp(-rate * half)
        total += sign * factor * ends / rate ** (k + 1)
        sign, factor = -sign, factor * (power - k)
    return total


@lru_cache(maxsize=4096)
def integral(power: int, i: int, j: int, orders: tuple[int, int]):
    """Return ``int s^power psi_i^(k) psi_j^(l) ds``."""
    with mpmath.workdps(DIGITS):
        total = mpmath.mpc(0)
        for a, r in exponentials(i):
            for c, q in exponentials(j):
                total += a * c * r ** orders[0] * q ** orders[1] * _moment(power, r + q)
        return mpmath.re(total)


def fair(function: Callable, names: tuple[str, ...], point: Point) -> dict[str, float]:
    """Return ``|f| + sum |x df/dx|``: a scale, from differences in double precision."""
    taken = inspect.signature(function).parameters
    arguments = {k: v for k, v in point.arguments.items() if k in taken}

    def values(changes: dict[str, float]) -> np.ndarray:
        return np.array(function(**{**arguments, **changes}), dtype=float)

    total, step = abs(values({})), 1e-6
    for name in point.inputs:
        if name in arguments and arguments[name] != 0.0:
            ends = [values({name: arguments[name] * (1 + sign * step)}) for sign in (1, -1)]
            total = total + abs(ends[0] - ends[1]) / (2 * step)
    return dict(zip(names, total, strict=True))


def mode_points(function: str) -> Iterator[Point]:
    """Yield points of one emitted function of the modes: theirs, to double precision."""
    if function == "slope_products":
        for i, j in itertools.permutations((1, 2, 3, 4, 11, 30, 59, 60), 2):
            slopes = {"end_slope": _end_slope(i), "other_end_slope": _end_slope(j)}
            inputs = {"root": float(root(i)), "other": float(root(j)), **slopes}
            fixed = {"parity": float(parity(i)), "other_parity": float(parity(j))}
            yield Point(f"modes {i}, {j}", inputs, fixed)
        return
    for i in NUMBERS:
        b, p, name = root(i), parity(i), f"mode {i}"
        fixed, start = {"parity": float(p)}, float((i + mpmath.mpf(1) / 2) * mpmath.pi)
        if function == "root_defect":
            for offset in (float(b - start), 0.1, -0.2):
                yield Point(name, {"offset": offset, "start": start}, fixed)
        elif function == "mode_constants":
            yield Point(name, {"root": float(b)}, fixed)
        elif function == "slope_squares":
            yield Point(name, {"end_slope": _end_slope(i)})
        else:
            rise = mpmath.cosh(b / 2) if p > 0 else mpmath.sinh(b / 2)
            inputs = {
                "root": float(b),
                "amplitude": float(mpmath.sqrt(mpmath.cosh(b)) / rise),
                "weight": float(1 / (1 + p * mpmath.exp(-b))),
                "phase": float((i + 1) % 4 * mpmath.pi / 2),
            }
            for eta in (0.0, 1e-9, 0.11, 0.5, 0.77, 1.0 - 2.0**-40, 1.0):
                yield Point(f"{name} at {eta:g}", {"eta": eta, **inputs}, fixed)


def _end_slope(i: int) -> float:
    return float(mode(i, mpmath.mpf(1) / 2, 1))


# ---------------------------------------------------------------- the rod


@lru_cache(maxsize=4)
def rod_reference(count: int) -> Reference:
    """Return the equations of a number of modes, derived for just that number, in many digits."""
    return derived_reference(rod.lagrangian(count), _ARRAYS)


_ARRAYS = ("constraints", "jacobian", "mass", "rest", "velocity_rhs", "gamma")
_ARRAYS += ("damping", "stiffness", "jacobian_rate", "jacobian_acceleration")
_SQUARES, _ROWS = ("inward", "retreat"), ("left", "stiffness")


class WithModes(ScalarEntries):
    """A function of the rod's equations, as its family evaluates it for so many modes."""

    def __init__(self, function: str, count: int) -> None:
        super().__init__(
            importlib.import_module(f"{generated.__name__}.{ROD_MODULE}"), function, count
        )

    def components(self, name: str) -> list[str]:
        if name in _SQUARES:
            return [f"{name}_{i}_{j}" for i in self.every for j in self.every if i <= j]
        if name in _ROWS:
            return [f"{name}_{i}" for i in self.every]
        if name.startswith("psi"):
            return [f"psi_{i}{name.removeprefix('psi')}" for i in self.every]
        if name == "f" or name.startswith("f_"):
            return [f"f{i}{name.removeprefix('f')}" for i in self.every]
        return [name]

    def system(self, given: Mapping[str, float], row: Callable[..., np.ndarray]) -> Constrained:
        pairs = {name: self.square(given, name).tolist() for name in _SQUARES}
        return Constrained.from_module(
            self.module,
            {name: given[name] for name in self.module.PARAMETERS},
            external={name: lambda q, t, name=name: row(name) for name in self.module.EXTERNAL},
            modes={**{name: row(name) for name in _ROWS}, **pairs},
        )


@lru_cache(maxsize=4)
def _rod_points(count: int) -> tuple[tuple[Point, dict], ...]:
    case = WithModes("variations", count)

    def at_rest(inputs):
        return {name: 0.0 for name in inputs if name.startswith("f") and name[1:2].isdigit()}

    made = []
    for point in case.states(57, case.module.PARAMETERS, "undeformed", at_rest):
        with mpmath.workdps(80):
            exact = rod_reference(count)({n: mpmath.mpf(v) for n, v in point.inputs.items()})
        made.append((point, exact))
    return tuple(made)


def exact_rod(function: WithModes) -> tuple[Exact, ...]:
    def compute(point: Point, values: dict) -> Callable:
        return lambda: (values, fair(function, function.names, point))

    return tuple(Exact(point, compute(point, v)) for point, v in _rod_points(function.count))
