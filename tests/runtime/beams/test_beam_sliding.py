"""The quick-return as a structure of beams: the crank pin slides along the bent rod."""

import numpy as np
from beam_energies import slope
from elastolink.runtime.beams import Section, beam_linkage, frame, linear_system
from elastolink.runtime.linkages import QuickReturn
from refusals import refused

ANGLES = (0.4, 2.4, 4.4)


def section(width, thickness, retardation=0.0):
    return Section.rectangle(
        width, thickness, modulus=70e9, density=2700.0, poisson=0.3, retardation=retardation
    )


def made(**nodes):
    """Return the quick-return of two cubic elements a link."""
    linkage = QuickReturn(frame=0.6, crank=0.13, rod=1.0)
    sections = {"crank": section(0.02, 0.01, 2e-5), "rod": section(0.015, 0.012, 3e-5)}
    given = {"B": {"inertia": 2e-4, "mass": 0.3, "force": (3.0, -2.0)}, "C": {"mass": 0.1}, **nodes}
    return beam_linkage(linkage, sections, elements=2, nodes=given)


def lever(pin=(0.6, 0.0)):
    """Return a rod nearly rigid, pinned at D, loaded at its tip C, on a pin of a clamped bar."""
    stiff, lithe = section(0.5, 0.5), section(0.02, 0.01)
    return frame(
        {"A": (0.6, -0.3), "B": pin, "C": (1.0, 0.0), "D": (0.0, 0.0)},
        {"crank": ("A", "B"), "rod": ("D", "C")},
        {"crank": lithe, "rod": stiff},
        supports={"A": ("x", "y", "rotation"), "D": ("x", "y")},
        elements=1,
        nodes={"B": {"slides_on": "rod"}, "C": {"force": (0.0, 12.0)}},
    )


def test_the_contact_force_stiffens_like_a_lever_on_a_pin():
    # The pin B carries F = load 1.0/0.6.
    system = linear_system(lever())
    kept = system.array("Kg", 0.0)[0]
    turned = np.zeros(system.size)
    for label, value in (("D.rod", 1.0), ("C.rod", 1.0), ("C.y", 1.0)):
        turned[system.labels.index(label)] = value
    along = np.zeros(system.size)
    along[system.labels.index("B.along")] = 1.0
    # The crank presses the rod down with 20 N; turned by psi the rod pushes the pin along with
    # -20 psi, and the pin that has gone ahead by r turns the rod back with 20 r more.
    assert abs(turned @ kept @ along - 20.0) < 1e-9
    # The pin presses the crank up: its pull of 20 N stiffens it, by 6/5 of it over the length.
    assert abs(along @ kept @ along - 6.0 / 5.0 * 20.0 / 0.3) < 1e-7


def test_the_instantaneous_form_has_no_rates_of_the_mass():
    structure = made()
    system, full = linear_system(structure, form="instantaneous"), linear_system(structure)
    assert "B.along" in system.labels and "B.y" not in system.labels
    assert not any(system.has(name) for name in "AB")
    for theta in ANGLES:
        changing = slope(lambda angle: system.array("M", angle)[0], theta)
        rest = system.array("C", theta, speed=30.0)[0] + 30.0 * changing
        rest -= full.array("C", theta)[0]
        assert np.max(np.abs(rest)) < 1e-9 * 30.0 * np.max(np.abs(changing))


test_a_pin_that_cannot_slide_is_refused = refused(
    lambda make, given: make(**given),
    [
        (made, {"B": {"slides_on": "coupler"}}, "coupler"),
        (made, {"B": {"slides_on": "rod", "held": ("x",)}}, "held"),
        (made, {"C": {"slides_on": "crank"}}, "slide"),
        (lever, {"pin": (0.6, 0.1)}, "away from beam rod"),
    ],
)
