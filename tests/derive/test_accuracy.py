"""Every emitted function at 80 digits: the measure, the machinery behind it, and the page."""

import importlib
import inspect
import math

import array_api_strict
import numpy as np
import pytest
import sympy as sp
from emitted_accuracy import EXCEPTIONS, INDEXED, PAGE, bound, emitted_functions, page_bounds, rows
from free_free_truth import ROD_MODULE
from judging import ALLOWED, ROUNDOFF, Point, exact_at, judge, reference_of

QUICK = 3  # points of a function in the first stage


# Derivations or exact roots that take seconds, however few points are asked for.
LONG = {
    "quick_return_overhang_modes",
    "quick_return_rod_free_free",
    "quick_return_rod_moving_basis",
    "four_bar_coupler_complete",
    "four_bar_coupler_inextensible",
    "four_bar_coupler_printed",
    "beam_element_curvature",
    "beam_element_internal_node",
    "beam_element_timoshenko",
    "beam_amplitude_law",
    "slider_crank_coupler_inextensible",
    "slider_crank_coupler_inextensible_cubic_1_modes",
    "slider_crank_coupler_inextensible_cubic_2_modes",
    "four_bar_coupler_inextensible_cubic_2_modes",
}


@pytest.mark.parametrize(
    ("module", "most"),
    [
        *((module, QUICK) for module in emitted_functions() if module not in LONG),
        *(pytest.param(m, None, marks=pytest.mark.slow) for m in emitted_functions()),
    ],
)
def test_every_output_is_within_the_measure(module, most):
    """And within twice what docs/accuracy.md states, which is rounded up to a power of two."""
    found = {row.key: row.judgement for row in rows(module, most)}
    if module not in INDEXED:  # whose entries are as many as modes or stations say
        names = emitted_functions()[module].items()
        assert set(found) == {(module, f, name) for f, returned in names for name in returned}
    beyond = {key: judgement for key, judgement in found.items() if not judgement.passed}
    assert set(beyond) <= set(EXCEPTIONS), beyond
    worst_kept = max(j.measure for key, j in found.items() if key not in EXCEPTIONS)
    stated = page_bounds(PAGE.read_text())[module]
    assert worst_kept <= 2 * stated, "run tests/derive/emitted_accuracy.py"
    if most is None:
        assert bound(worst_kept) >= stated / 2, "run tests/derive/emitted_accuracy.py"
        needed = {key for key in EXCEPTIONS if key[0] == module}
        assert needed <= set(beyond)


def test_the_page_lists_every_module():
    assert set(page_bounds(PAGE.read_text())) == set(emitted_functions())


def test_the_measure_sees_cancellation_and_forgives_conditioning():
    x = sp.Symbol("x")
    reference = reference_of((x,), [("f", sp.exp(x) - 1)])
    exact = exact_at(reference, Point("small", {"x": 1e-9}))
    (careless,) = judge(lambda x: math.exp(x) - 1.0, ("f",), exact)
    (careful,) = judge(lambda x: math.expm1(x), ("f",), exact)
    assert careless.measure > 1e6 > ALLOWED > 2.0 > careful.measure
    assert not careless.passed
    # cos near pi/2 has no relative accuracy, and none is asked for.
    exact = exact_at(reference_of((x,), [("f", sp.cos(x))]), Point("zero", {"x": math.pi / 2}))
    (judged,) = judge(lambda x: math.cos(x) * (1 + 1e-3) + ROUNDOFF, ("f",), exact)
    assert judged.passed


GEOMETRY = {"frame": 5.0, "crank": 1.0, "coupler": 4.5, "follower": 2.0}
ANY = {**GEOMETRY, "offset": 0.5, "assembly": -1.0, "winding": 0.0}


PAIRS = [(module, f) for module, functions in emitted_functions().items() for f in functions]


@pytest.mark.parametrize("shared", [True, False], ids=["first is an array", "all are arrays"])
@pytest.mark.parametrize("module, function", [p for p in PAIRS if p[0] != ROD_MODULE])
def test_every_function_runs_in_any_array_namespace(module, function, shared):
    """The same numbers as with NumPy, from arrays that cannot be written to.

    Vector loops may round the last digit differently with the alignment of an array.
    """
    home = importlib.import_module(f"elastolink.generated.{module}")
    emitted = getattr(home, function)
    shared = shared and home.FAMILY != "constrained"  # there the whole state is one shape
    values = {}
    for i, name in enumerate(inspect.signature(emitted).parameters):
        value = ANY.get(name, 0.25 + i)
        array = np.arange(1.0, 8.0) if name in ("m", "n", "theta2") else np.full(7, value)
        array.flags.writeable = False
        values[name] = array if i == 0 or not shared or name == "n" else value
    expected = emitted(**values)
    xp = array_api_strict
    strict = emitted(**{k: xp.asarray(v) if np.ndim(v) else v for k, v in values.items()})
    plain, other = (r if isinstance(r, tuple) else (r,) for r in (expected, strict))
    for one, two in zip(plain, other, strict=True):
        size = 4 * np.finfo(float).eps * np.max(np.abs(one))
        np.testing.assert_allclose(np.asarray(two), one, rtol=0, atol=size)
