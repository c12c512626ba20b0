"""What charts, regions and tongues refuse: one line that names the argument."""

from dataclasses import replace

import elastolink as el
import numpy as np
from edge_truth import flexible_rod
from elastolink.runtime.stability import resonances, tongue, tongue_curves
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis
from periodic_systems import system_of, wave
from refusals import each_of, refused

PAIR = system_of(
    {"eps": 0.1}, M=np.eye(2), K=[np.diag([1.0, 5.3]), ("eps", wave([[0.4, 1.0], [1.0, -0.3]]))]
)
SKEW = PAIR.with_terms(el.Term("K", None, np.array([[0.0, 0.1], [-0.1, 0.0]])))
FED = PAIR.with_terms(el.Term("C", None, -0.01 * np.eye(2)))
SUM = next(one for one in resonances(PAIR, (3.0, 4.0)) if one.kind == "sum")
MATHIEU = {
    "system": el.load_scene("mathieu").system(),
    "x": ("lam2", [0.1, 0.6]),
    "y": ("mu", [0.01, 0.02]),
}
ROD = {
    "system": flexible_rod(PolynomialBasis(1)),
    "x": ("crank_ratio", [0.1, 0.2]),
    "y": ("mass_per_length", [7.0, 8.0]),
}

SLOW = {"x": ("speed", [1e-3, 1.0]), "y": ("crank_ratio", [0.1, 0.2])}
MANY = {"x": ("crank_ratio", np.linspace(0.05, 0.2, 50)), "speed": 800.0}
MANY["y"] = ("frame", np.linspace(0.5, 0.6, 20000))


def rooted(geometry):
    """Return a system with a wave of the root of 0.5 - r."""

    def pull(theta):
        with np.errstate(invalid="ignore"):
            return (np.sqrt(0.5 - geometry["r"]) * np.cos(theta))[:, None, None] * np.eye(2)

    made = system_of(M=np.eye(2), K=np.diag([1.0, 3.3]), Kg=pull)
    return replace(made, geometry=geometry, rebuild=rooted)


# What is given where a case does not change it.
GIVEN = {
    tongue: {"resonance": SUM, "parameter": ("eps", [0.1, 0.2, 0.3])},
    resonances: {"speed_range": (1.0, 5.0)},
    el.stability_edges: {"speed_range": (3.0, 4.0)},
    el.speed_boundaries: {"speed_range": (1.0, 2.0)},
    tongue_curves: {"name": "eps", "values": [0.1, 0.2], "speed_range": (1.0, 5.0)},
    el.stability_chart: {"x": ("speed", [1.0, 2.0]), "y": ("eps", [0.1, 0.2])},
}
CASES = {
    tongue: [
        ({"order": 9}, "order"),
        ({"parameter": ("eps", [0.1, np.nan, 0.2])}, "finite"),
        ({"parameter": ("epsilon", 0.1)}, "epsilon"),
        ({"parameter": "eps"}, "pair"),
        ({"eps": 0.1}, "once"),
        ({"d3": 0.1}, "d3"),
        ({"resonance": replace(SUM, modes=(1, 3))}, "modes"),
        ({"resonance": SUM.label}, "a Resonance"),
        ({"resonance": replace(SUM, harmonic=30)}, "no such resonance"),
    ],
    resonances: [
        ({"speed_range": (5.0, 2.0)}, "speed_range"),
        ({"speed_range": (0.0, 5.0)}, "speed_range"),
        ({"speed_range": (1.0, np.inf)}, "speed_range"),
        ({"highest": 0}, "highest"),
        ({"kinds": ("sums",)}, "sums"),
        ({"kinds": None}, "kinds"),
        ({"push": 1.0}, "push"),
    ],
    el.stability_edges: [
        ({"speed_range": (0.0, 1.0)}, "speed_range"),
        ({"speed_range": (1e-4, 1.0)}, "speed_range"),
        ({"rtol": 1.0}, "rtol"),
        ({"margin": 1.0}, "margin"),
        ({"margin": "a"}, "margin"),
        ({"mass": 1.0}, "mass"),
        ({"system": SKEW}, "not symmetric"),
        ({"system": FED}, "feeds energy"),
    ],
    el.speed_boundaries: [
        ({"multiplier": 2}, "multiplier"),
        ({"multiplier": ()}, "multiplier"),
        ({"speed_range": (2.0, 1.0)}, "speed_range"),
        ({"speed_range": (1e-4, 1.0)}, "speed_range"),
        ({"rtol": 0.0}, "rtol"),
        ({"mass": 2.0}, "mass"),
        ({"eps": np.array([1.0, 2.0])}, "eps"),
    ],
    tongue_curves: [
        ({"name": "crank"}, "crank"),
        ({"values": [0.2, 0.1]}, "values"),
        ({"values": [0.0, 0.1]}, "values"),
        ({"speed_range": (4.0, 0.5)}, "speed_range"),
    ],
    el.stability_chart: [
        ({"x": ("speeed", [1.0, 2.0])}, "speeed"),
        ({"y": ("speed", [1.0, 2.0])}, "another parameter"),
        ({"x": ("speed", [-1.0, 2.0])}, "positive speeds"),
        ({"x": ("speed", [2.0, 1.0])}, "rising"),
        ({"x": ("speed", [np.nan, 2.0])}, "finite"),
        ({"x": ("speed", [2.0])}, "at least two"),
        ({"order": 3}, "order"),
        ({**MATHIEU, "order": 9}, "order"),
        ({**MATHIEU, "order": True}, "order"),
        ({**MATHIEU, "edges": True}, "edges"),
        ({**MATHIEU, "rtol": 0.5}, "rtol"),
        (ROD, "give speed"),
        ({**ROD, "x": ("damping", [0.0, 1.0])}, "give speed"),
        ({**ROD, "x": ("speed", [900.0, 1000.0]), "speed": 100.0}, "leave it out"),
        ({**SLOW, "system": flexible_rod(PolynomialBasis(3))}, r"raise the (lowest )?speed"),
        ({**MANY, "system": flexible_rod(OverhangBasis(4))}, "fewer modes or points"),
        ({"system": rooted({"r": 0.1}), "y": ("r", [0.1, 0.9])}, "not finite"),
        *(({**ROD, "speed": value}, "positive number") for value in (-5.0, np.nan, "fast")),
    ],
}


test_bad_input_is_refused_in_one_line = refused(
    lambda call, changes: call(**{"system": PAIR, **GIVEN[call], **changes}), each_of(CASES)
)
