"""Every public function of frames, frequencies and beams, given what it cannot use: one clear line.

Each argument in turn becomes nothing, text, a number that is none, an empty row, a problem of
another family, and a structure where a system belongs (or the other way round).
"""

from functools import cache

import numpy as np
import pytest
from elastolink.runtime import beams, frequencies, recovery
from elastolink.runtime import frequencies as dynamic_stiffness
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Transcendental
from elastolink.runtime.linkages import FourBar

# The longest line of a refusal that can still be read at a glance.
_LONGEST = 450
LINKS = FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
BAR = beams.Section.rectangle(0.02, 0.005, modulus=210e9, density=7850.0)
BARS = dict.fromkeys(("crank", "coupler", "follower"), BAR)
OUTER = beams.ElasticLayer(0.002, 70e9, 2700.0)
CORE = beams.ViscoelasticLayer(0.001, 1e6, 1.0, 1000.0)
CLAMP = ("x", "y", "rotation")
MEMBER = {
    **dict.fromkeys(("length", "bending_stiffness", "axial_stiffness", "mass_per_length"), 1.0)
}


@cache
def structure():
    return beams.beam_linkage(LINKS, BARS, elements=1)


@cache
def system():
    return beams.linkage_system(LINKS, BARS, elements=1)


@cache
def problem():
    return dynamic_stiffness.dynamic_stiffness(structure(), 0.3)


def standing():
    places, members = {"A": (0, 0), "B": (1, 0)}, {"bar": ("A", "B")}
    return beams.linear_system(beams.frame(places, members, BAR, supports={"A": CLAMP}))


def shape(**given):
    return dynamic_stiffness.wittrick_williams(problem(), count=2).shape(**given)


def divided(pieces):
    return problem().divided(pieces)


# Function, a good value (or what makes it) for each argument; where None is good too: "argument?".
CALLS = (
    (frequencies.buckling_speed, {"system": system}),
    (frequencies.campbell, {"system": system, "speed": [10.0, 11.0, 12.0, 13.0], "modes?": 1}),
    (
        frequencies.critical_speeds,
        {"system": system, "speed_range": (9.0, 10.0), "method": "mean_frequency", "modes?": 1},
    ),
    (frequencies.draw_mode, {"system": system, "theta": 0.0, "mode": 1}),
    (frequencies.draw_modes, {"system": system, "theta?": [0.0], "modes": 1}),
    (
        frequencies.link_frequencies,
        {"system": system, "link": "coupler", "quantity": "length", "value": [0.33], "count": 1},
    ),
    (
        frequencies.natural_frequencies,
        {"system": system, "theta?": [0.1], "count?": 1, "speed": 0.0},
    ),
    (dynamic_stiffness.dynamic_stiffness, {"structure": structure, "theta": 0.1}),
    (dynamic_stiffness.element_matrices, {"structure": structure, "theta": 0.1}),
    (dynamic_stiffness.log_determinant, {"problem": problem, "omega": [10.0]}),
    (dynamic_stiffness.wittrick_williams, {"problem": problem, "count": 1}),
    (shape, {"mode": 0, "beam": "crank", "eta": [0.5]}),
    (recovery.beam_energies, {"system": system, "motion": 10.0}),
    (recovery.stress, {"system": system, "motion": 10.0, "stations?": 3}),
    (recovery.recover, {"system": system, "motion": 10.0, "stations?": 3}),
    (recovery.pin_reactions, {"system": system, "motion": 10.0}),
    (
        recovery.elastic_coupler_curve,
        {"system": system, "motion": 10.0, "along?": 0.1, "across": 0.0, "link": "coupler"},
    ),
    (
        recovery.stress_operator,
        {"system": system, "theta": [0.1], "stations?": 3, "method": "equilibrium"},
    ),
    (beams.without_stretching, {"system": standing}),
    (
        beams.linear_system,
        {"structure": structure, "form": "full", "rayleigh": (0.0, 0.0), "gravity": (0.0, 0.0)},
    ),
    (beams.beam_linkage, {"linkage": LINKS, "sections": BARS, "elements": 1, "kind": "cubic"}),
    (beams.linkage_system, {"linkage": LINKS, "sections": BARS, "form": "full", "elements": 1}),
    (
        beams.frame,
        {
            "places": {"A": (0, 0), "B": (1, 0)},
            "members": {"bar": ("A", "B")},
            "sections": BAR,
            "supports": {"A": CLAMP},
        },
    ),
    (beams.element_arrays, {"kind": "cubic", **MEMBER}),
    (
        beams.sandwich_section,
        {"base": OUTER, "core": CORE, "cover": OUTER, "width": 0.02, "frequency": 100.0},
    ),
)
BAD = {
    "nothing": None,
    "text": "what",
    "no number": np.nan,
    "empty": [],
    "another family": Transcendental(1, lambda w: np.ones((1, 1)), lambda w: np.zeros(())),
    "structure or system": None,
}
# Another transcendental problem is one; the first frequency of every mechanism is given without.
FINE = {
    ("log_determinant", "problem", "another family"),
    ("wittrick_williams", "problem", "another family"),
    ("wittrick_williams", "count", "nothing"),
}


def made(value):
    """Return a value, or what a function of this module makes."""
    return value() if callable(value) else value


@pytest.mark.parametrize(("call", "given"), CALLS, ids=lambda item: getattr(item, "__name__", ""))
def test_unusable_arguments_are_refused_in_one_line(call, given):
    values = {key.rstrip("?"): made(value) for key, value in given.items()}
    for argument in given:
        name = argument.rstrip("?")
        for bad, wrong in BAD.items():
            fine = bad == "nothing" and (argument.endswith("?") or name == "motion")
            if fine or (call.__name__, name, bad) in FINE:
                continue
            if bad == "structure or system":
                wrong = system() if values[name] is structure() else structure()
            with pytest.raises(BadInput) as refusal:
                call(**{**values, name: wrong})
            line = str(refusal.value)
            assert "\n" not in line and len(line) <= _LONGEST, line


@pytest.mark.parametrize("bad", ["what", np.nan, [0.5], structure])
def test_pieces_and_beams_without_stretch_are_refused(bad):
    wrong = made(bad)
    for call in (
        lambda: dynamic_stiffness.dynamic_stiffness(structure(), pieces=wrong),
        lambda: dynamic_stiffness.dynamic_stiffness(structure(), inextensible=wrong),
        lambda: dynamic_stiffness.element_matrices(structure(), inextensible=wrong),
        lambda: divided(wrong),
        lambda: beams.beam_linkage(LINKS, BARS, joint_masses=wrong),
    ):
        with pytest.raises(BadInput):
            call()


def test_what_is_refused_is_good_otherwise():
    """The values that each case starts from are fine: it is the one argument that is refused."""
    slow = {"campbell", "critical_speeds"}
    for call, given in CALLS:
        if call.__name__ not in slow and "motion" not in given:
            call(**{key.rstrip("?"): made(value) for key, value in given.items()})


def test_a_long_value_is_cut_short_in_the_message():
    with pytest.raises(BadInput) as refusal:
        frequencies.natural_frequencies(system(), np.full((50, 50), 0.1))
    line = str(refusal.value)
    assert "\n" not in line and "..." in line and len(line) <= _LONGEST
