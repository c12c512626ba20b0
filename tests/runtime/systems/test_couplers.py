"""From a scene to the system of the flexible coupler."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.scenes import load_scene
from elastolink.runtime.systems.from_scene import coupler_system

RIG = "smith_1972_5152_sixteenth_inch"
INCH, POUND = 0.0254, 4.4482216152605
THETA = np.linspace(0.0, 6.0, 13)


def system(**overrides):
    return coupler_system(load_scene(RIG, overrides=overrides))


def test_system_of_a_rig_in_si_units():
    """Smith's (5,1,5,2) linkage with the 1/16 in coupler: 171.5 lbf in^2, 26 Hz, 15 in."""
    found = system(**{"model.modes": 3})
    assert found.size == 3 and found.labels == ("Y1/l3", "Y2/l3", "Y3/l3")
    assert found.period == pytest.approx(2 * np.pi)
    assert found.reference_length == pytest.approx(15 * INCH)
    stiffness = found.array("K", np.zeros(1))[0]
    frequencies = np.sqrt(np.diag(stiffness))
    np.testing.assert_allclose(frequencies / frequencies[0], [1.0, 4.0, 9.0], rtol=1e-14)
    assert frequencies[0] == pytest.approx(2 * np.pi * 26.0, rel=1e-3)
    assert found.parameters["bending_stiffness"] == pytest.approx(171.5 * POUND * INCH**2)
    assert found.is_constant("M") and found.is_constant("K") and not found.is_constant("B")
    assert found.provenance["scene"] == RIG and len(found.provenance["module_hash"]) == 32


def test_parameters_move_what_they_should():
    found = system()
    base = found.array("B", THETA)
    doubled = found.array("B", THETA, follower_inertia=2 * found.parameters["follower_inertia"])
    nothing = found.array("B", THETA, follower_inertia=0.0)
    np.testing.assert_allclose(doubled - base, base - nothing, rtol=1e-10, atol=1e-12)
    heavy = found.with_parameters(mass_per_length=2 * found.parameters["mass_per_length"])
    np.testing.assert_allclose(heavy.array("K", THETA), found.array("K", THETA) / 2, rtol=1e-14)
    np.testing.assert_allclose(heavy.array("f", THETA), found.array("f", THETA), rtol=1e-14)


def test_formulations_of_one_scene():
    whole, printed, reduced = (
        system(**{"model.formulation": name}) for name in ("complete", "printed", "reduced")
    )
    assert np.abs(whole.array("B", THETA) - printed.array("B", THETA)).max() > 1e-3
    for array in ("M", "K", "f", "g"):
        for other in (printed, reduced):
            np.testing.assert_allclose(
                other.array(array, THETA), whole.array(array, THETA), rtol=1e-12, atol=1e-14
            )
    assert len(reduced.terms) < len(printed.terms) < len(whole.terms)


def test_a_crank_that_cannot_turn_is_refused():
    with pytest.raises(BadInput, match="the crank cannot turn fully"):
        system(**{"links.crank": "12 in"})


def test_a_model_that_was_not_emitted_names_the_command():
    with pytest.raises(BadInput, match="regenerate-equations"):
        system(**{"model.drop": ["axial_inertia"]})
