"""The mesh's part of the error estimates: which finer mesh, what is done where there is none."""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from beam_motions import (
    FOUR_BAR,
    SECTIONS,
    damped_four_bar,
    periodic_motion,
    rocking,
    steadily,
    turning_bar,
)
from elastolink.runtime.recovery import beam_energies, elastic_coupler_curve
from elastolink.runtime.recovery.finer_mesh import finer_structure, finer_system, solved

APART = "apart"


@pytest.mark.parametrize(
    ("elements", "kind", "expected"),
    [
        (1, "cubic", (2, "internal_node")),
        (2, "cubic", (3, "cubic")),
        (4, "cubic", (6, "cubic")),
        (1, "curvature", (2, "curvature")),
        ((1.0,), "cubic", (2, "internal_node")),
        ((0.25, 0.75), "cubic", ((0.125, 0.125, 0.375, 0.375), "cubic")),
    ],
)
def test_finer_elements(elements, kind, expected):
    made = finer_structure(turning_bar(rocking, elements=elements, kind=kind).structure)
    assert (made.beams[0].elements, made.beams[0].kind) == expected


def test_the_finer_system_has_parameters_and_damping_of_its_own_modes():
    system = damped_four_bar(2, gravity=(0.0, -9.81)).with_parameters(
        elasticity=0.9, damping_ratio=0.03
    )
    found = finer_system(system)
    made = damped_four_bar(3, gravity=(0.0, -9.81))
    made = made.with_parameters(elasticity=0.9, damping_ratio=0.03)
    theta = np.array([0.3, 2.0, 5.1])
    for name in ("M", "A", "B", "C", "K", "Kg", "f", "p"):
        np.testing.assert_array_equal(found.array(name, theta), made.array(name, theta))


def test_terms_taken_away_are_missing_there_too():
    system = damped_four_bar().without("Kg").with_changed_terms(lambda term: replace(term, power=0))
    found = finer_system(system)
    assert not found.has("Kg") and found.has("C") and found.size == 30


@pytest.mark.parametrize("form", ["full", "instantaneous"])
def test_another_form_and_geometry_go_along(form):
    system = el.linkage_system(FOUR_BAR, SECTIONS, elements=1, form=form, rayleigh=(1.0, 1e-5))
    found = finer_system(system.with_geometry(frame=0.6))
    assert found.has("A") == (form == "full")
    places = found.structure.places(np.zeros(1))
    assert places["D"][0, 0] == pytest.approx(0.6)


def test_terms_of_one_mesh_have_no_other_mesh():
    system = turning_bar(rocking, elements=1, drag=1.0)
    own = system.with_terms(el.Term("C", None, np.eye(system.size)))
    assert finer_system(system) is not None
    assert finer_system(own) is None
    assert finer_system(replace(system, terms=own.terms)) is None
    assert finer_system(replace(system, remesh=None)) is None
    assert APART in el.stress(own, 8.0).error_norm


@pytest.mark.slow
def test_every_result_counts_the_mesh_where_it_can():
    system = turning_bar(rocking, elements=1, drag=2.0)
    given = periodic_motion(system, 8.0, 32)
    for call in (
        el.stress,
        el.pin_reactions,
        el.recover,
        beam_energies,
        lambda *args, **more: elastic_coupler_curve(*args, link="bar", **more),
    ):
        found = call(system, 8.0)
        assert APART not in found.error_norm and APART in call(system, given).error_norm
        assert np.all(np.asarray(found.error) > 0.0)


def test_stretch_comes_from_the_forces():
    # A bar that turns steadily is stretched by its centrifugal force; on few intervals too.
    # The drag bends it, by a thousandth of the stretch.
    system = turning_bar(steadily, elements=2, drag=0.1)
    q, qd = solved(system, 30.0, 4, 64)
    tip = 7850.0 * 30.0**2 / (3 * 210e9)
    place = system.labels.index("P.x"), system.labels.index("P.y")
    np.testing.assert_allclose(np.hypot(*q[:, place].T), tip, rtol=1e-4)
    np.testing.assert_allclose(np.hypot(*qd[:, place].T), 30.0 * tip, rtol=1e-4)
