"""Every emitted function as a loop: the same operations, interpreted and compiled."""

from __future__ import annotations

import inspect
import types
from functools import cache
from pathlib import Path

import elastolink.generated
import numpy as np
import pytest
from compiled_loops import NEEDS_NUMBA, emitted
from elastolink.runtime.compiled import compiled_function, compiled_module
from elastolink.runtime.compiled.rewriting import loop_of
from elastolink.runtime.core.errors import BadInput

pytestmark = pytest.mark.usefixtures("loop_cache")

# Modules whose functions are no arithmetic on numbers, and why.
NOT_COMPILED = {"hill_recursion": "its functions are an algebra that the caller passes in"}
MODULES = sorted(
    path.stem
    for path in Path(elastolink.generated.__path__[0]).glob("*.py")
    if path.stem != "__init__" and path.stem not in NOT_COMPILED
)
# Rods with four and five modes have more entries of the same kind, and take half of the time.
COMPILED = [name for name in MODULES if "_4_modes" not in name and "_5_modes" not in name]
SHORT = {"crank": 0.1, "frame": 1.2}
# Nasty values: zero, ends of turns, a hair beside them, coincidences, far out, and beyond.
NASTY = (0.0, 1.0, -1.0, np.pi, -np.pi / 2, 2 * np.pi, 1e-9, -1e-9, 40.0, 1e6, np.inf, np.nan)


def _functions(name: str) -> list[tuple[str, object]]:
    """Return what a module emits; a function whose entries are all zero is not there."""
    module = emitted(name)
    return [(own, getattr(module, own)) for own in module.RETURNS if hasattr(module, own)]


def _tuple(returned: object) -> tuple:
    return returned if isinstance(returned, tuple) else (returned,)


def _arguments(function: object, size: int) -> list[np.ndarray]:
    """Return random points, then nasty ones: each argument in turn, and some of them together."""
    names = list(inspect.signature(function).parameters)
    count = len(names)
    rng = np.random.default_rng(count)
    # A short crank, so that most angles are within reach.
    scale = np.array([[SHORT.get(name, 1.0)] for name in names])
    plain = scale * rng.uniform(0.3, 1.7, (count, size))
    rough = scale * rng.uniform(0.3, 1.7, (count, 3 * len(NASTY)))
    for k, value in enumerate(NASTY):
        rough[k % count, 3 * k] = value
        rough[rng.integers(count, size=2), 3 * k + 1] = value
        rough[:, 3 * k + 2] = rng.choice(NASTY[:9], count)
    return list(np.concatenate([plain, rough], axis=1))


class _Interpreted:
    """A loop run by Python, on NumPy's functions of one number."""

    def __init__(self, function: object) -> None:
        self.loop = loop_of(function)
        space: dict[str, object] = {}
        exec(self.loop.text, space)
        own = ("cos", "cosh", "exp", "expm1", "sin", "sinh", "sqrt", "tan")
        of_one = {name: getattr(np, name) for name in own}
        space["_math"] = types.SimpleNamespace(**of_one, atan2=np.arctan2, fabs=np.abs)
        self.run = space["loop"]

    def __call__(self, arguments: list[np.ndarray]) -> np.ndarray:
        count, returned, points = len(arguments), len(self.loop.outputs), len(arguments[0])
        places = np.ones(2 * (count + returned), dtype=np.int64)
        places[::2] = points * np.array([*range(count), *range(returned)])
        out = np.empty(returned * points)
        self.run(points, places, np.concatenate(arguments), out)
        return out.reshape(returned, points)


@pytest.mark.parametrize("name", MODULES)
def test_every_emitted_function_becomes_the_same_operations(name) -> None:
    """Bit by bit at random and nasty points: run by Python, a loop is the emitted function."""
    for own, function in _functions(name):
        arguments = _arguments(function, 3)
        with np.errstate(all="ignore"):
            found = _Interpreted(function)(arguments)
            for k, point in enumerate(zip(*arguments, strict=True)):
                wanted = np.array(_tuple(function(*point)), dtype=float)
                np.testing.assert_array_equal(found[:, k], wanted, err_msg=own)
        assert np.isfinite(found).any(), own


def test_the_modules_that_are_not_compiled_are_those_of_the_list() -> None:
    """A new kind of module has to be thought of here."""
    for name in NOT_COMPILED:
        module = emitted(name)
        for own in module.RETURNS:
            with pytest.raises(BadInput, match="expected elementwise arithmetic of an emitted"):
                loop_of(getattr(module, own))
        with pytest.raises(BadInput, match="algebra of the caller"):
            compiled_module(module)
    families = {emitted(name).FAMILY for name in MODULES}
    assert families == {"closed_form", "constrained", "linear_periodic"}


def _same(function: object, arguments: list[np.ndarray]) -> None:
    """Compare to 1e-13 of ``|f| + sum |x_i df/dx_i|``, by differences of relative size 1e-6."""
    with np.errstate(all="ignore"):
        wanted = np.array(
            [np.broadcast_to(v, arguments[0].shape) for v in _tuple(function(*arguments))]
        )
        size = np.abs(wanted)
        for k, own in enumerate(arguments):
            ends = []
            for step in (1e-6, -1e-6):
                moved = [*arguments[:k], own * (1.0 + step), *arguments[k + 1 :]]
                ends.append(
                    np.array([np.broadcast_to(v, own.shape) for v in _tuple(function(*moved))])
                )
            size = size + np.nan_to_num(np.abs(ends[0] - ends[1]) / 2e-6, posinf=0.0)
        found = np.array(
            [np.broadcast_to(v, own.shape) for v in _tuple(compiled_function(function)(*arguments))]
        )
    assert np.array_equal(np.isnan(found), np.isnan(wanted))
    assert np.array_equal(np.isinf(found), np.isinf(wanted))
    finite = np.isfinite(wanted)
    assert finite.any()
    gap = np.abs(found[finite] - wanted[finite])
    assert np.all(gap <= 1e-13 * size[finite]), function.__qualname__


SAMPLE = (
    ("four_bar_coupler_complete", "angle_functions"),  # sines and roots
    ("four_bar_kinematics", "motion"),  # arc tangents
    ("beam_element_cubic", "element"),  # some entries are constants
    ("beam_dynamic_stiffness", "axial_poles"),  # floors, remainders, comparisons as numbers
    ("beam_dynamic_stiffness", "axial_rates"),  # branches
    ("hill_meissner", "interval"),  # hyperbolic functions
)


@NEEDS_NUMBA
@pytest.mark.parametrize(("module", "name"), SAMPLE)
def test_compiled_functions_give_the_same_values(module, name) -> None:
    function = getattr(emitted(module), name)
    _same(function, _arguments(function, 200))


@cache
def _different() -> set[tuple[str, str]]:
    """Return module and name of every function whose statements no module before it has."""
    found: dict[str, tuple[str, str]] = {}
    for name in MODULES:
        for own, function in _functions(name):
            statements = loop_of(function).text.partition("def loop")[2]
            found.setdefault(statements, (name, own))
    return set(found.values())


@NEEDS_NUMBA
@pytest.mark.slow
@pytest.mark.parametrize("name", COMPILED)
def test_every_compiled_function_gives_the_same_values(name) -> None:
    """Those with the same statements once: the test of operations has read them all."""
    for own, function in _functions(name):
        if (name, own) in _different():
            _same(function, _arguments(function, 200))
