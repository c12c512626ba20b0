"""What a structure of beams cannot be: one clear line each."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.beams import (
    Beam,
    Node,
    Section,
    Structure,
    beam_linkage,
    frame,
    linear_system,
    linkage_system,
)
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.frequencies import dynamic_stiffness
from elastolink.runtime.linkages import FourBar, QuickReturn
from elastolink.runtime.linkages.linkage import LinkMotion

BAR = Section.rectangle(0.02, 0.005, modulus=210e9, density=7850.0)
FOUR_BAR = FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
BARS = dict.fromkeys(("crank", "coupler", "follower"), BAR)
CLAMP = ("x", "y", "rotation")
PLACES = {"A": (0.0, 0.0), "B": (0.0, 1.0), "C": (1.0, 1.0), "D": (1.0, 0.0)}
MEMBERS = {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")}
SUPPORTS = {"A": CLAMP, "D": CLAMP}


def portal(**changes):
    given = {"places": PLACES, "members": MEMBERS, "sections": BAR, "supports": SUPPORTS}
    given |= changes
    return frame(given.pop("places"), given.pop("members"), given.pop("sections"), **given)


def section(**changes):
    given = {"area": 1e-4, "second_moment": 1e-9, "modulus": 2e11, "density": 7850.0}
    return Section(**{**given, **changes})


def refused(make, *told):
    """Make something that cannot be, and look for words in the one line that says so."""
    with pytest.raises(BadInput) as caught:
        make()
    line = str(caught.value)
    assert "\n" not in line and all(word in line for word in told), line


@pytest.mark.parametrize("name", ["area", "second_moment", "modulus", "density", "thickness"])
@pytest.mark.parametrize("value", [0.0, np.nan])
def test_sections(name, value):
    refused(lambda: section(**{name: value}), name, "positive")


def test_every_problem_of_a_section_is_told_at_once():
    with pytest.raises(BadInput) as caught:
        section(area=-1.0, density=np.nan)
    first, second = str(caught.value).splitlines()
    assert "area" in first and "density" in second


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"length": 0.0}, "length"),
        ({"end": "A"}, "both ends"),
        ({"kind": "quartic"}, "kind"),
        ({"kind": "timoshenko"}, "shear stiffness"),
        ({"elements": 0}, "elements"),
        ({"elements": 2.5}, "elements"),
        ({"elements": (0.5, 0.0, 0.5)}, "empty element"),
        ({"elements": (0.5, 0.6)}, "1.1"),
    ],
)
def test_beams(values, told):
    given = {"name": "bar", "start": "A", "end": "B", "section": BAR, "length": 1.0}
    refused(lambda: Beam(**{**given, **values}), "bar", told)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"mass": -0.1}, "mass"),
        ({"damping": {"x": -1.0}}, "damping along x"),
        ({"stiffness": {"y": -1.0}}, "stiffness along y"),
        ({"stiffness": {"z": 1.0}}, "z"),
        ({"held": ("turn",)}, "turn"),
        ({"force": (1.0, np.inf)}, "force"),
        ({"stiffness": 1.0}, "stiffness"),
    ],
)
def test_nodes(values, told):
    refused(lambda: Node(name="B", **values), "node B", told)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"members": {**MEMBERS, "far": ("E", "F")}}, "E"),
        (
            {
                "places": {**PLACES, "E": (3.0, 0.0), "F": (4.0, 0.0)},
                "members": {**MEMBERS, "far": ("E", "F")},
            },
            "nothing connects",
        ),
        ({"places": {**PLACES, "E": (3.0, 0.0)}}, "no beam"),
        ({"places": {**PLACES, "C": PLACES["B"]}}, "no length"),
        ({"places": {**PLACES, "C": (np.nan, 1.0)}}, "place of C"),
        ({"supports": {"Q": CLAMP}}, "Q"),
        ({"supports": {"A": ("z",)}}, "z"),
        ({"sections": {"left": BAR}}, "beam"),
        ({"nodes": {"B": {"joined": ("right",)}}}, "right"),
        ({"nodes": {"B": {"carried_by": "right"}}}, "right"),
        ({"members": {}}, "no beam"),
    ],
)
def test_frames(changes, told):
    refused(lambda: portal(**changes), told)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        # Nothing holds it at all.
        ({"supports": {}}, "nothing resists"),
        # Two pins: it turns about the line of neither, but four hinges make a mechanism.
        ({"supports": {"A": ("x", "y"), "D": ("x", "y")}, "pins": ("B", "C")}, "nothing resists"),
        # One pin alone.
        ({"supports": {"A": ("x", "y")}}, "nothing resists"),
        ({"pins": ("B", "C"), "nodes": {"B": {"inertia": 1e-3}}}, "carried_by"),
    ],
)
def test_frames_that_nothing_holds(changes, told):
    refused(lambda: linear_system(portal(**changes)), told)


def test_a_frame_on_hinges_stands_once_a_spring_holds_it():
    hinged = {"supports": {"A": ("x", "y"), "D": ("x", "y")}, "pins": ("B", "C")}
    sprung = portal(**hinged, nodes={"B": {"stiffness": {"x": 1e3}}})
    system = linear_system(sprung)
    assert np.all(np.linalg.eigvalsh(system.array("K", 0.0)[0]) > 0.0)


def test_everything_held():
    bar = {"bar": ("A", "B")}
    places = {name: PLACES[name] for name in "AB"}
    held = {"A": CLAMP, "B": CLAMP}
    refused(
        lambda: frame(places, bar, BAR, supports=held, elements=1).size, "every coordinate held"
    )


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"sections": {"crank": BAR}}, "coupler, follower"),
        ({"sections": {**BARS, "rod": BAR}}, "rod"),
        ({"joint_masses": {"Q": 1.0}}, "Q"),
        ({"joint_masses": {"B": -1.0}}, "mass"),
        ({"nodes": {"Q": {}}}, "Q"),
        ({"elements": {"crank": 1}}, "elements"),
        ({"elements": 0}, "elements"),
        ({"kind": "quintic"}, "kind"),
    ],
)
def test_linkages(changes, told):
    given = {"sections": BARS, **changes}
    refused(lambda: beam_linkage(FOUR_BAR, given.pop("sections"), **given), told)


def test_a_crank_that_cannot_turn():
    rocker = FourBar(crank=0.5, coupler=0.328, follower=0.3, frame=0.547)
    refused(lambda: beam_linkage(rocker, BARS), "crank")
    refused(lambda: linkage_system(FOUR_BAR, BARS).with_geometry(frame=0.9))


def test_a_crank_on_a_shaft_that_nothing_turns():
    loose = {"A": {"held": ("x", "y")}}
    refused(lambda: linkage_system(FOUR_BAR, BARS, nodes=loose), "A.crank", "nothing resists")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"form": "exact"}, "form"),
        ({"rayleigh": (-1.0, 0.0)}, "rayleigh"),
        ({"gravity": (0.0, np.inf)}, "gravity"),
    ],
)
def test_systems(options, told):
    refused(lambda: linkage_system(FOUR_BAR, BARS, elements=1, **options), told)


@pytest.mark.parametrize(("name", "value"), [("elasticity", 0.0), ("lumped", 1.0)])
def test_factors_and_lengths(name, value):
    system = linkage_system(FOUR_BAR, BARS, elements=1)
    refused(lambda: system.with_parameters(**{name: value}), name)
    refused(lambda: system.with_geometry(frame=-1.0), "frame")


def test_unknown_names_of_a_structure():
    structure = beam_linkage(FOUR_BAR, BARS, elements=1)
    refused(lambda: structure.beam("rod"), "rod", "crank")
    refused(lambda: structure.node("E"), "E")


def standing(theta, length=1.0):
    none, nothing = np.zeros((len(theta), 2)), np.zeros(len(theta))
    return {"bar": LinkMotion(none, none, none, nothing, nothing, nothing)}


@pytest.mark.parametrize(
    ("beams", "nodes", "told"),
    [
        ((), (), "no beam"),
        ((("bar", "A", "B"), ("bar", "B", "A")), "AB", "bar"),
        ((("bar", "A", "B"),), "AAB", "A"),
        ((("bar", "A", "B"),), "A", "end at B"),
        ((("bar", "A", "B"), ("tail", "B", "C")), "ABC", "no motion of beam tail"),
        ((("bar", "A", "B"), ("bar2", "A", "B")), "AB", "bar2"),
    ],
)
def test_structures(beams, nodes, told):
    made = tuple(
        Beam(name=name, start=start, end=end, section=BAR, length=1.0) for name, start, end in beams
    )
    held = tuple(Node(name=name) for name in nodes)
    refused(lambda: Structure(beams=made, nodes=held, configuration=standing), told)


def test_ends_that_do_not_meet():
    def apart(theta):
        bar = standing(theta)["bar"]
        return {"bar": bar, "tail": bar}

    made = [("bar", "A", "B"), ("tail", "B", "C")]
    beams = tuple(Beam(name=n, start=s, end=e, section=BAR, length=1.0) for n, s, e in made)
    nodes = tuple(Node(name=name) for name in "ABC")
    refused(lambda: Structure(beams=beams, nodes=nodes, configuration=apart), "1 m away")


def test_a_sliding_pin_has_no_exact_frequencies():
    linkage = QuickReturn(frame=0.6, crank=0.13, rod=1.0)
    structure = beam_linkage(linkage, {"crank": BAR, "rod": BAR}, elements=1)
    refused(lambda: dynamic_stiffness(structure), "slides along beam rod")
