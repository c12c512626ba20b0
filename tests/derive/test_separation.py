"""Separation of arrays into scales, functions of angle and modal arrays, on small systems."""

from collections import namedtuple

import numpy as np
import pytest
import sympy as sp
from derivations import loaded
from elastolink.derive.arrays import (
    MATRICES,
    CrankMotion,
    DiscreteSystem,
    IndexedEntry,
    IndexedVector,
)
from elastolink.derive.emission import emit
from elastolink.derive.ir import Argument, Description
from elastolink.derive.separation import NotSeparable, StagedSystem, lower_linear_periodic
from elastolink.derive.spec import ModelSpec
from elastolink.derive.staged import Steps
from elastolink.runtime.systems import assemble
from hypothesis import given, settings
from hypothesis import strategies as st

theta, rate, acceleration = sp.symbols("theta rate acceleration", real=True)
mass, stiff, length, gravity = sp.symbols("mass stiff length gravity", positive=True)
turned, external = sp.symbols("turned load", real=True)
m, n = sp.symbols("m n", integer=True, positive=True)
STEPS = Steps(((turned, sp.sin(theta) / length),))
PARAMETERS = (mass, stiff)
VALUES = {mass: 1.7, stiff: 0.4, length: 2.5, gravity: 9.81}
THETA = np.array([-0.3, 0.9, 4.0])
SPEC = ModelSpec("test", "separation")


Row = namedtuple("Row", "array power scale angle modal")


def rows_of(module):
    """Return the separated terms of a module."""
    return [Row(*row) for table in module.tables if table.name == "TERMS" for row in table.value]


def staged(arrays, external_symbols=(), steps=STEPS):
    modes = None if any(isinstance(e, IndexedEntry) for e in arrays.values()) else 2
    system = DiscreteSystem(CrankMotion(theta, rate, acceleration), modes, arrays, ())
    geometry = (theta, length, gravity)
    return StagedSystem(system, steps, PARAMETERS, geometry, external_symbols)


def described():
    words = {"theta": "ndarray, shape (...)", "length": "float", "gravity": "float"}
    return Description(
        title="A test",
        references=("none",),
        arguments=tuple(Argument(name, shape, "", name) for name, shape in words.items()),
        parameters=tuple(Argument(str(p), "float", "", str(p)) for p in PARAMETERS),
    )


def lowered(arrays, **options):
    return lower_linear_periodic(SPEC, staged(arrays, **options), described())


def assembled(module, modes=None, **options):
    return assemble(
        loaded(emit(module, "0" * 32)),
        geometry={"length": VALUES[length], "gravity": VALUES[gravity]},
        parameters={"mass": VALUES[mass], "stiff": VALUES[stiff]},
        modes=modes,
        **options,
    )


def by_sympy(matrix, steps=STEPS, **more):
    """Evaluate a matrix of expressions at the angles, without separating anything."""
    plain = matrix.applyfunc(steps.inline).subs({**VALUES, **more})
    return np.array([np.array(plain.subs(theta, angle), dtype=float) for angle in THETA])


SCALES = (sp.Integer(1), mass, stiff / mass, 1 / mass, mass * stiff)
ANGLES = (sp.Integer(1), turned, sp.cos(theta), turned**2 * sp.cos(theta))
GEOMETRY = (sp.Integer(1), length, gravity / length)
NUMBERS = (sp.Integer(0), sp.Integer(1), -sp.Rational(2, 3), sp.sqrt(2), sp.pi)
TERM = st.tuples(
    st.sampled_from(("M", "B", "K", "Kg", "C", "f")),
    st.sampled_from(SCALES),
    st.sampled_from(ANGLES),
    st.sampled_from(GEOMETRY),
    st.lists(st.sampled_from(NUMBERS), min_size=4, max_size=4),
)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.lists(TERM, min_size=1, max_size=5))
def test_any_sum_of_products_is_reproduced(terms):
    arrays = {"M": sp.eye(2)}
    for array, scale, angle, geometry, numbers in terms:
        shape = (2, 2) if array in MATRICES else (2, 1)
        added = sp.Matrix(*shape, numbers[: shape[0] * shape[1]]) * scale * angle * geometry
        arrays[array] = arrays.get(array, sp.zeros(*shape)) + added
    arrays = {k: sp.ImmutableDenseMatrix(v) for k, v in arrays.items() if any(v)}
    found = assembled(lowered(arrays))
    for name, matrix in arrays.items():
        expected = by_sympy(matrix)
        expected = expected if name in MATRICES else expected[..., 0]
        np.testing.assert_allclose(found.array(name, THETA), expected, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("number", [-1, 3, -sp.Rational(2, 3)])
def test_a_constant_term_stays_constant_whatever_its_number(number):
    explicit = {
        "M": sp.ImmutableDenseMatrix(sp.eye(2)),
        "K": sp.ImmutableDenseMatrix(sp.eye(2) * (number * stiff + mass * sp.cos(theta))),
    }
    closed = {
        "M": IndexedEntry(sp.Integer(1), sp.Integer(0), m, n),
        "K": IndexedEntry(number * stiff * m**2 + mass * sp.cos(theta), sp.Integer(0), m, n),
    }
    for arrays, modes in ((explicit, None), (closed, 2)):
        module = lowered(arrays)
        rows = {(r.scale, r.angle) for r in rows_of(module) if r.array == "K"}
        assert rows == {("stiff", None), ("mass", "angle_theta")}
        found = assembled(module, modes=modes)
        expected = float(number) * 0.4 + 1.7 * np.cos(THETA)
        np.testing.assert_allclose(found.array("K", THETA)[:, 0, 0], expected, rtol=1e-14)


def test_what_is_constant_is_declared_so_and_zero_is_absent():
    arrays = {
        "M": sp.ImmutableDenseMatrix(sp.eye(2) * mass),
        "K": sp.ImmutableDenseMatrix([[gravity / length, 0], [0, stiff]]),
        "S": sp.ImmutableDenseMatrix(sp.eye(2) * sp.sin(theta)),
    }
    module = lowered(arrays)
    assert {r.angle for r in rows_of(module) if r.array != "S"} == {None}
    scales = next(k for k in module.kernels if k.name == "scales")
    assert {r.name for r in scales.results} == {"mass", "stiff", "gravity_over_length"}
    assert "angle_functions" not in {k.name for k in module.kernels}
    found = assembled(module)
    assert found.is_constant("M") and found.is_constant("K") and not found.is_constant("S")
    assert not found.has("C") and not found.has("f")
    expected = np.diag([9.81 / 2.5, 0.4])
    np.testing.assert_allclose(found.array("K", THETA)[1], expected, rtol=1e-15)


def test_a_supplied_function_of_angle_is_named_and_not_emitted():
    arrays = {
        "M": sp.ImmutableDenseMatrix(sp.eye(2)),
        "Kg": sp.ImmutableDenseMatrix([[0, mass * external], [mass * external, 0]]),
    }
    module = lowered(arrays, external_symbols=(external,))
    assert [r.angle for r in rows_of(module) if r.array == "Kg"] == ["load"]
    assert {k.name for k in module.kernels} == {"scales"}
    found = assembled(module, external={"load": np.cos})
    np.testing.assert_allclose(found.array("Kg", THETA)[:, 0, 1], 1.7 * np.cos(THETA), rtol=1e-15)


@pytest.mark.parametrize(
    "entry", [sp.sqrt(mass + sp.cos(theta)), sp.cos(stiff * theta), mass ** sp.cos(theta)]
)
def test_parameters_tangled_with_the_angle_are_refused(entry):
    unit = sp.ImmutableDenseMatrix(sp.eye(2))
    arrays = {"M": unit, "K": unit * entry}
    with pytest.raises(NotSeparable, match="mixes"):
        lowered(arrays)


def test_a_symbol_that_nothing_defines_is_refused():
    stray = sp.Symbol("stray")
    arrays = {"M": sp.ImmutableDenseMatrix(sp.eye(2) * stray)}
    with pytest.raises(TypeError, match="stray"):
        lowered(arrays)


def closed_arrays():
    off = (-1) ** (m + n) * m * n / (m**2 - n**2)
    return {
        "M": IndexedEntry(sp.Integer(1), sp.Integer(0), m, n),
        "K": IndexedEntry(stiff / length * m**4, sp.Integer(0), m, n),
        "B": IndexedEntry(turned * m**2 + 2, off * turned - 3 * off * mass * sp.cos(theta), m, n),
        "f": IndexedVector((1 - (-1) ** m) / m * turned * mass, m),
    }


def test_closed_entries_serve_any_number_of_modes():
    arrays = closed_arrays()
    module = lowered(arrays)
    for modes in (1, 2, 7):
        found = assembled(module, modes=modes)
        assert found.size == modes
        for name, entry in arrays.items():
            expected = by_sympy(entry.matrix(modes))
            expected = expected if name in MATRICES else expected[..., 0]
            np.testing.assert_allclose(found.array(name, THETA), expected, rtol=1e-13, atol=1e-14)
