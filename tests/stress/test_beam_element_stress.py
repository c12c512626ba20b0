"""Beam elements and layered sections over the range of doubles: right, or refused in words."""

from types import SimpleNamespace

import numpy as np
import pytest
from beam_reference import rigid_field
from elastolink.runtime.beams.elements import (
    KINDS,
    element_arrays,
    shapes_of,
)
from elastolink.runtime.beams.layered import ElasticLayer, ViscoelasticLayer, sandwich_section
from elastolink.runtime.core.errors import BadInput
from hypothesis import given, settings
from hypothesis import strategies as st

ANY = st.floats(-320.0, 308.0).map(lambda power: 10.0**power)
SANE = st.floats(-12.0, 12.0).map(lambda power: 10.0**power)
SOME = settings(max_examples=30, deadline=None, derandomize=True)
LENGTH = st.floats(-6.0, 6.0).map(lambda power: 10.0**power)


def numbers(draw, size):
    names = ("mass_per_length", "axial_stiffness", "bending_stiffness", "shear_stiffness")
    return {name: draw(size) for name in (*names, "rotary_inertia")}


@given(st.data(), st.sampled_from(KINDS))
@SOME
def test_any_positive_numbers_are_taken_or_refused(data, kind):
    given_numbers = numbers(data.draw, ANY)
    length = data.draw(ANY)
    try:
        found = element_arrays(kind, length=length, **given_numbers)
    except BadInput as refusal:
        assert "\n" not in str(refusal)
        return
    assert all(np.all(np.isfinite(value)) for value in vars(found).values())


@given(st.data(), st.sampled_from(KINDS))
@SOME
def test_rigid_motions_and_mass_whatever_the_size(data, kind):
    """No strain in rigid motions, to the rounding of the entries that cancel; the whole mass."""
    given_numbers = numbers(data.draw, SANE)
    length = data.draw(LENGTH)
    found = element_arrays(kind, length=length, **given_numbers)
    motions = [
        rigid_field(kind, (1.0, 0.0), (1.0, 0.0), 0.0),
        rigid_field(kind, (0.0, 1.0), (0.0, 1.0), 0.0),
        rigid_field(kind, (0.0, 0.0), (0.0, length), 1.0),
    ]
    for motion in motions:
        size = np.abs(found.stiffness) @ np.abs(motion)
        assert np.all(np.abs(found.stiffness @ motion) <= 1e-14 * size)
    total = given_numbers["mass_per_length"] * length
    for motion in motions[:2]:
        assert motion @ found.centripetal @ motion == pytest.approx(total, rel=1e-13)
        # Rotary inertia cancels in a translation.
        size = np.abs(motion) @ np.abs(found.mass) @ np.abs(motion)
        assert abs(motion @ found.mass @ motion - total) <= 1e-14 * size
    assert np.all(np.diag(found.mass) > 0) and np.all(np.diag(found.stiffness) > 0)


@given(st.data(), st.sampled_from(KINDS), st.floats(0.0, 1.0), ANY)
@SOME
def test_shapes_anywhere(data, kind, place, length):
    section = SimpleNamespace(bending_stiffness=data.draw(ANY), shear_stiffness=data.draw(ANY))
    placed = SimpleNamespace(length=length, beam=SimpleNamespace(kind=kind, section=section))
    try:
        found = shapes_of(placed, np.array([place]))
    except BadInput as refusal:
        assert "\n" not in str(refusal)
        return
    assert np.sum(found["u"]) == pytest.approx(1.0, rel=1e-14)
    across = rigid_field(kind, (0.0, 1.0), (0.0, 1.0), 0.0)
    assert (found["v"] @ across)[0] == pytest.approx(1.0, rel=1e-12)
    assert found["rotation"].shape == (1, len(across))


def sandwich(drawn, name="frequency"):
    return sandwich_section(
        ElasticLayer(*drawn[:3]),
        ViscoelasticLayer(*drawn[3:7]),
        ElasticLayer(*drawn[7:10]),
        width=drawn[10],
        **{name: drawn[11]},
    )


@given(st.lists(ANY, min_size=12, max_size=12), st.sampled_from(["wave_number", "frequency"]))
@SOME
def test_layers_of_any_size_are_taken_or_refused(drawn, name):
    try:
        found = sandwich(drawn, name)
    except BadInput as refusal:
        assert "\n" not in str(refusal)
        return
    assert found.slack * (1 - 1e-14) <= found.bending_stiffness <= found.bonded * (1 + 1e-14)
    assert found.loss_factor >= 0.0
    for value in (found.mass_per_length, found.frequency, found.axial_stiffness, found.area):
        assert np.isfinite(value) and value > 0.0


@given(st.lists(SANE, min_size=12, max_size=12))
@SOME
def test_free_waves_through_layers_of_any_ordinary_size(drawn):
    found = sandwich(drawn)
    load = found.mass_per_length * drawn[11] ** 2
    assert found.bending_stiffness * found.wave_number**4 == pytest.approx(load, rel=1e-10)
