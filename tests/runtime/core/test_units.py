"""Quantities at the edge: exact conversions, the two rules on rates, and every refusal."""

import math
import subprocess
import sys

import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.units import (
    _BASE,
    _USUAL,
    DIMENSIONS,
    _unit,
    _unit_of_pint,
    describe,
    expected,
    to_si,
)
from hypothesis import given
from hypothesis import strategies as st

# Exact by definition: the international inch and pound, and standard gravity.
INCH, POUND, GRAVITY = 0.0254, 0.45359237, 9.80665
LBF = POUND * GRAVITY
ALMOST = st.text(alphabet="0123456789.eE+- */()^minskgHzrpadlbf", max_size=25)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("15 in", "length", 15 * INCH),
        ("-2.5e1 mm", "length", -0.025),
        ("171.5 lbf*in**2", "bending_stiffness", 171.5 * LBF * INCH**2),
        ("171.5 lbf in^2", "bending_stiffness", 171.5 * LBF * INCH**2),
        ("0.0058 lbf*in*s**2", "inertia", 0.0058 * LBF * INCH),
        ("1 lbm/in", "mass_per_length", POUND / INCH),
        ("3 N*s/(m*m)", "damping_per_length", 3.0),
        ("3 kg/m/s", "damping_per_length", 3.0),
        ("3 1/m*m**2", "length", 3.0),
        ("26 Hz", "frequency", 52 * math.pi),
        ("2 kHz", "frequency", 4000 * math.pi),
        ("500 rpm", "frequency", 500 * math.pi / 30),
        ("180 deg/s", "frequency", math.pi),
        ("3 turn/min", "frequency", math.pi / 10),
        ("30 deg", "angle", math.pi / 6),
        ("2 percent", "dimensionless", 0.02),
        ("2 yards", "length", 72 * INCH),
        ("60 arcminute", "angle", math.pi / 180),
        ("6 revolutions_per_minute", "frequency", math.pi / 5),
        ("0.02", "dimensionless", 0.02),
        (3, "length", 3.0),
        (2.5, "mass", 2.5),
    ],
)
def test_conversion(text, dimension, value):
    assert to_si(text, dimension) == pytest.approx(value, rel=4e-16)


@given(
    st.decimals(min_value="0.001", max_value="1000", places=3),
    st.sampled_from([("mm", "0.001"), ("in", "0.0254"), ("ft", "0.3048"), ("cm", "0.01")]),
)
def test_a_decimal_length_is_rounded_once(number, unit):
    name, factor = unit
    exact = number * type(number)(factor)
    assert to_si(f"{number} {name}", "length") == float(exact)


def test_every_dimension_reads_its_own_unit_and_example():
    for name, kind in DIMENSIONS.items():
        assert to_si(f"2 {kind.si}".strip(), name) == pytest.approx(2.0, rel=1e-15)
        assert math.isfinite(to_si(kind.example, name))
        assert kind.example in expected(name)


@pytest.mark.parametrize(
    ("value", "dimension", "part"),
    [
        ("15 inn", "length", "did you mean in"),
        ("5 RPM", "frequency", "did you mean rpm?"),
        ("5 foo*bar", "length", "unknown unit 'foo'"),
        ("15 kg", "length", "[mass]"),
        ("15 lbf", "mass", "weight"),
        ("3 1/s", "frequency", "cycles or radians"),
        ("3 rad", "frequency", "dimensionless"),
        ("hello", "length", "a length"),
        ("", "length", "a length"),
        ("1,5 m", "length", "a length"),
        ("1/16 in", "length", "one number and one unit"),
        ("1 m + 2 m", "length", "one number and one unit"),
        ("5 m*", "length", "one number and one unit"),
        ("5 m)", "length", "one number and one unit"),
        ("5 m*/s", "length", "one number and one unit"),
        ("5 m**999", "length", "one number and one unit"),
        ("5 **2", "length", "one number and one unit"),
        ("5 degC", "length", "[temperature]"),
        ("5 dB", "dimensionless", "unknown unit"),
        ("5 " + "m*" * 200 + "m", "length", "a length"),
        ("nan", "length", "a length"),
        ("1e9999 m", "length", "finite"),
        (math.inf, "length", "finite"),
        (10**400, "length", "finite"),
        (True, "length", "a length"),
        (None, "length", "a length"),
    ],
)
def test_refusals_say_what_is_wrong(value, dimension, part):
    with pytest.raises(BadInput) as caught:
        to_si(value, dimension, "links.crank")
    assert part in str(caught.value)
    assert all(problem.where == "links.crank" for problem in caught.value.problems)
    assert "\n" not in str(caught.value.problems[0])


def test_an_unknown_dimension_is_refused():
    with pytest.raises(BadInput, match="a dimension of"):
        to_si(1.0, "lenght")


@given(st.one_of(st.text(max_size=40), ALMOST), st.sampled_from(sorted(DIMENSIONS)))
def test_any_text_gives_a_finite_number_or_bad_input(text, dimension):
    try:
        assert math.isfinite(to_si(text, dimension))
    except BadInput as error:
        assert error.problems


def test_description_shows_rpm_beside_radians():
    assert describe(math.pi, "frequency") == "3.14159 rad/s (30 rpm)"
    assert describe(0.5, "length") == "0.5 m"
    assert describe(0.5, "dimensionless") == "0.5"


def test_pint_is_imported_only_for_an_unusual_unit():
    code = (
        "import sys; from elastolink.runtime.core.units import to_si;"
        "to_si('3 lbf/in', 'stiffness'); assert 'pint' not in sys.modules;"
        "assert to_si('2 furlongs', 'length') > 402; assert 'pint' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("name", sorted({*_BASE, *_USUAL} - {"lbm", "rev"}))
def test_definitions_are_those_of_pint(name):
    ours, theirs = _unit(name), _unit_of_pint(name)
    assert float(ours.factor) == float(theirs.factor)
    assert (ours.powers, ours.counts) == (theirs.powers, theirs.counts)
