"""What a structure of beams cannot be: one clear line each."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.beams import beam_linkage, linear_system
from elastolink.runtime.linkages.linkage import LinkMotion
from refusals import refused

BAR = el.Section.rectangle(0.02, 0.005, modulus=210e9, density=7850.0)
FOUR_BAR = el.FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
ROCKER = el.FourBar(crank=0.5, coupler=0.328, follower=0.3, frame=0.547)
BARS = dict.fromkeys(("crank", "coupler", "follower"), BAR)
CLAMP, PIN = ("x", "y", "rotation"), ("x", "y")
PLACES = {"A": (0.0, 0.0), "B": (0.0, 1.0), "C": (1.0, 1.0), "D": (1.0, 0.0)}
MEMBERS = {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")}
SUPPORTS = {"A": CLAMP, "D": CLAMP}
HINGED = {"supports": {"A": PIN, "D": PIN}, "pins": ("B", "C")}
HELD = {"supports": dict.fromkeys("ABCD", CLAMP), "elements": 1}
FAR = {**MEMBERS, "far": ("E", "F")}
UNCONNECTED = {"members": FAR, "places": {**PLACES, "E": (3.0, 0.0), "F": (4.0, 0.0)}}


def section(**changes):
    given = {"area": 1e-4, "second_moment": 1e-9, "modulus": 2e11, "density": 7850.0}
    return el.Section(**{**given, **changes})


def beam(**changes):
    given = {"name": "bar", "start": "A", "end": "B", "section": BAR, "length": 1.0}
    return el.Beam(**{**given, **changes})


def node(**values):
    return el.Node(name="B", **values)


def portal(**changes):
    given = {"places": PLACES, "members": MEMBERS, "sections": BAR, "supports": SUPPORTS}
    given |= changes
    return el.frame(given.pop("places"), given.pop("members"), given.pop("sections"), **given)


def standing_portal(**changes):
    return linear_system(portal(**changes))


def linkage(linkage=FOUR_BAR, sections=BARS, **changes):
    return beam_linkage(linkage, sections, **changes)


def system(**options):
    return el.linkage_system(FOUR_BAR, BARS, elements=1, **options)


def structure(beams, nodes):
    """Return beams, each "name start end", between nodes; bar and tail lie at the origin."""

    def lying(theta):
        none, nothing = np.zeros((len(theta), 2)), np.zeros(len(theta))
        bar = LinkMotion(none, none, none, nothing, nothing, nothing)
        return {"bar": bar, "tail": bar}

    keys = ("name", "start", "end")
    made = tuple(beam(**dict(zip(keys, text.split(), strict=True))) for text in beams)
    return el.Structure(
        beams=made, nodes=tuple(el.Node(name=n) for n in nodes), configuration=lying
    )


def on_a_sliding_pin():
    made = el.QuickReturn(frame=0.6, crank=0.13, rod=1.0)
    return el.dynamic_stiffness(beam_linkage(made, {"crank": BAR, "rod": BAR}, elements=1))


# What makes it, from which values, and the words of the refusal.
REFUSED = [
    *(
        (section, {name: 0.0}, f"{name}.*positive")
        for name in ("area", "second_moment", "modulus", "density", "thickness")
    ),
    (beam, {"length": 0.0}, "bar.*length"),
    (beam, {"end": "A"}, "bar.*both ends"),
    (beam, {"kind": "timoshenko"}, "bar.*shear stiffness"),
    (beam, {"elements": 0}, "bar.*elements"),
    (beam, {"elements": (0.5, 0.0, 0.5)}, "bar.*empty element"),
    (beam, {"elements": (0.5, 0.6)}, "bar.*1.1"),
    (node, {"mass": -0.1}, "node B.*mass"),
    (node, {"damping": {"x": -1.0}}, "node B.*damping along x"),
    (node, {"stiffness": {"y": -1.0}}, "node B.*stiffness along y"),
    (node, {"stiffness": {"z": 1.0}}, "node B.*z"),
    (node, {"held": ("turn",)}, "node B.*turn"),
    (node, {"force": (1.0, np.inf)}, "node B.*force"),
    (node, {"stiffness": 1.0}, "node B.*stiffness"),
    (portal, {"members": FAR}, "E"),
    (portal, UNCONNECTED, "nothing connects"),
    (portal, {"places": {**PLACES, "E": (3.0, 0.0)}}, "no beam"),
    (portal, {"places": {**PLACES, "C": PLACES["B"]}}, "no length"),
    (portal, {"places": {**PLACES, "C": (np.nan, 1.0)}}, "place of C"),
    (portal, {"supports": {"Q": CLAMP}}, "Q"),
    (portal, {"sections": {"left": BAR}}, "beam"),
    (portal, {"nodes": {"B": {"joined": ("right",)}}}, "right"),
    (portal, {"nodes": {"B": {"carried_by": "right"}}}, "right"),
    (portal, {"members": {}}, "no beam"),
    # Nothing holds it at all; one pin alone; four hinges make a mechanism.
    (standing_portal, {"supports": {}}, "nothing resists"),
    (standing_portal, {"supports": {"A": PIN}}, "nothing resists"),
    (standing_portal, HINGED, "nothing resists"),
    (standing_portal, {"pins": ("B", "C"), "nodes": {"B": {"inertia": 1e-3}}}, "carried_by"),
    (lambda: portal(**HELD).size, {}, "every coordinate held"),
    (linkage, {"sections": {"crank": BAR}}, "coupler, follower"),
    (linkage, {"sections": {**BARS, "rod": BAR}}, "rod"),
    (linkage, {"joint_masses": {"Q": 1.0}}, "Q"),
    (linkage, {"nodes": {"Q": {}}}, "Q"),
    (linkage, {"elements": {"crank": 1}}, "elements"),
    (linkage, {"kind": "quintic"}, "kind"),
    (linkage, {"linkage": ROCKER}, "crank"),
    (system, {"nodes": {"A": {"held": PIN}}}, "A.crank.*nothing resists"),
    (system, {"form": "exact"}, "form"),
    (system, {"rayleigh": (-1.0, 0.0)}, "rayleigh"),
    (system, {"gravity": (0.0, np.inf)}, "gravity"),
    (lambda: system().with_parameters(elasticity=0.0), {}, "elasticity"),
    (lambda: system().with_parameters(lumped=1.0), {}, "lumped"),
    (lambda: system().with_geometry(frame=-1.0), {}, "frame"),
    (lambda: system().with_geometry(frame=0.9), {}, "crank"),
    (lambda: linkage().beam("rod"), {}, "rod.*crank"),
    (lambda: linkage().node("E"), {}, "E"),
    (structure, {"beams": (), "nodes": ()}, "no beam"),
    (structure, {"beams": ("bar A B", "bar B A"), "nodes": "AB"}, "bar"),
    (structure, {"beams": ("bar A B",), "nodes": "AAB"}, "A"),
    (structure, {"beams": ("bar A B",), "nodes": "A"}, "end at B"),
    (structure, {"beams": ("bar A B", "bar2 B C"), "nodes": "ABC"}, "motion of beam bar2"),
    (structure, {"beams": ("bar A B", "bar2 A B"), "nodes": "AB"}, "bar2"),
    (structure, {"beams": ("bar A B", "tail B C"), "nodes": "ABC"}, "1 m away"),
    (on_a_sliding_pin, {}, "slides along beam rod"),
]


test_what_cannot_be_is_refused_in_one_line = refused(lambda make, values: make(**values), REFUSED)


def test_every_problem_of_a_section_is_told_at_once():
    with pytest.raises(el.BadInput) as caught:
        section(area=-1.0, density=np.nan)
    first, second = str(caught.value).splitlines()
    assert "area" in first and "density" in second


def test_a_frame_on_hinges_stands_once_a_spring_holds_it():
    sprung = standing_portal(**HINGED, nodes={"B": {"stiffness": {"x": 1e3}}})
    assert np.all(np.linalg.eigvalsh(sprung.array("K", 0.0)[0]) > 0.0)
