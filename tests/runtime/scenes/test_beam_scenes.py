"""Scenes whose links are beams: what they hold, refuse and become."""

import numpy as np
import pytest
from elastolink import BadInput, load_scene
from elastolink.derive.spec import ModelSpec

TABLE = "aannaque_1996_table_4_1"


@pytest.mark.parametrize(
    ("elements", "kind", "freedoms"),
    [(3, "cubic", 27), (1, "cubic", 9), (1, "curvature", 10), (1, "timoshenko", 9)],
)
def test_the_freedoms_are_those_of_the_document_and_the_element_the_model(elements, kind, freedoms):
    # Aannaque section 4.3: 27 degrees of freedom against 10 of p-version 2.
    changes = {"model.formulation": f"{kind}_beams", "mesh.elements": elements}
    scene = load_scene(TABLE, overrides={**changes, "material.poisson": 0.3})
    assert scene.model_spec() == ModelSpec("beam_element", kind)
    assert scene.system().size == scene.system().structure.size == freedoms
    assert scene.system().parameters["damping_ratio"] == 0.02


def test_lengths_are_geometry_and_damping_follows():
    system = load_scene(TABLE).system().with_parameters(elasticity=1.5)
    wider = system.with_geometry(frame=0.632)
    assert wider.geometry["frame"] == 0.632
    assert wider.parameters == system.parameters
    made = load_scene(TABLE, overrides={"links.frame": 0.632}).system()
    made = made.with_parameters(elasticity=1.5)
    theta = np.array([0.3, 2.0, 4.4])
    for name in ("M", "A", "B", "C", "K", "Kg", "f"):
        np.testing.assert_allclose(wider.array(name, theta), made.array(name, theta), rtol=1e-12)


def test_terms_are_left_out_by_name():
    full = load_scene(TABLE).system()
    assert full.has("A") and full.has("Kg")
    printed = load_scene(TABLE, overrides={"model.drop": ["as_printed"]}).system()
    assert not printed.has("A") and not printed.has("B") and not printed.has("Kg")
    instantaneous = load_scene(TABLE, overrides={"model.drop": ["instantaneous"]}).system()
    assert not instantaneous.has("A") and instantaneous.has("Kg")


def test_joints_take_springs_and_masses():
    changes = {"joints.D": {"held": ["y"], "stiffness_x": "2e6 N/m", "mass": 0.2}}
    system = load_scene(TABLE, overrides=changes).system()
    assert "D.x" in system.labels
    place = system.labels.index("D.x")
    of_beams = next(t for t in system.terms if t.array == "K" and t.scale == "elasticity")
    spring = system.array("K", np.zeros(1)) - of_beams(np.zeros(1))
    assert spring[0, place, place] == 2e6


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("model.drop", ["tension"], "model.drop: found"),
        ("model.flexible", ["coupler"], "model.flexible"),
        ("crank.area", -1.0, "crank.area: found -1.0; expected a positive value"),
        ("mesh.elements", 0, "mesh.elements"),
        ("links.crank", "0.6 m", "crank cannot turn fully"),
        ("joints.E.mass", 0.1, "nodes: found E; expected some of"),
        ("model.formulation", "timoshenko_beams", "crank.shear_stiffness: found nothing"),
    ],
)
def test_what_cannot_be_is_refused(key, value, words):
    with pytest.raises(BadInput, match=words):
        load_scene(TABLE, overrides={key: value}).system()
