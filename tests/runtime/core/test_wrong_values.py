"""Wrong values in every argument of public names: one complaint of the package's own, or an answer.

What is never right (text, complex, masked, a date, NaN) is never answered.
"""

import decimal

import elastolink as el
import numpy as np
import pytest

RIG = el.load_scene("smith_1972_5152_sixteenth_inch")
SYSTEM = el.with_modal_damping(RIG.system(), 0.02)
FOUR_BAR = el.FourBar(frame=0.4, crank=0.1, coupler=0.35, follower=0.3)
BAR = el.MassDistribution.uniform_bar(mass=1.0, length=0.3)
MACHINE = el.Machine(FOUR_BAR, {"coupler": BAR, "follower": BAR})
F = el.PeriodicFunction(a=[0.0, 1.0])
SECTION = el.Section.rectangle(density=2700.0, modulus=7e10, width=0.02, thickness=0.003)
SECTIONS = dict.fromkeys(FOUR_BAR.links, SECTION)
BEAMS = el.with_modal_damping(el.linkage_system(FOUR_BAR, SECTIONS, elements=1), 0.02)
ROD = {"crank_ratio": 0.4, "frame": 0.3, "length": 1.2, "bending_stiffness": 100.0}
ROD["mass_per_length"] = 1.0
AT = {"theta": 0.1, "speed": 10.0, "acceleration": 0.0}

# By name: arguments that are right.
RIGHT = {
    "FourBar": {"frame": 0.4, "crank": 0.1, "coupler": 0.35, "follower": 0.3, "assembly": "open"},
    "SliderCrank": {"crank": 0.1, "coupler": 0.3, "offset": 0.01, "assembly": "open"},
    "MassDistribution": {"mass": 1.0, "along": 0.1, "across": 0.0, "inertia": 0.1},
    "Mathieu": {"a": 1.0, "q": 0.5},
    "PeriodicFunction": {"a": [0.0, 1.0], "b": [0.0, 0.5]},
    "balance": {"machine": MACHINE, "speed": 10.0, "weights": {"torque": 1.0}}
    | {"links": ("follower",), "limits": {"f23": 3.0}, "angles": [0.0, 2.0, 4.0]},
    "boundary_solution": {"f": F, "mu": 0.3, "n": 1, "end": "lower"},
    "clearance_range": {"linkage": FOUR_BAR, "clearances": 1e-4, "theta": [0.1], "joint": "23"},
    "coupler_curve": {"linkage": FOUR_BAR, "along": 0.1, "across": 0.1, "link": "coupler"},
    "discriminant": {"f": F, "lam2": 1.0, "mu": 0.3, "damping": 0.1},
    "floquet_multipliers": {"system": SYSTEM, "speed": 50.0, "rtol": 1e-6, "damping": 0.1},
    "flywheel_inertia": {"machine": MACHINE, "speed": 10.0, "fluctuation": 0.02},
    "harmonics": {"source": (FOUR_BAR, "theta4"), "order": 3},
    "hill_boundaries": {"f": F, "mu": 0.3, "regions": (1, 2)},
    "linkage_system": {"linkage": FOUR_BAR, "sections": SECTIONS, "elements": 1},
    "load_scene": {"name_or_path": "mathieu", "overrides": {}},
    "mobility": {"pins": (("frame", "crank"), ("crank", "rod"), ("rod", "frame"))},
    "monodromy": {"system": SYSTEM, "speed": 50.0, "rtol": 1e-6},
    "natural_frequencies": {"system": BEAMS, "theta": [0.0, 1.0], "count": 2, "speed": 0.0},
    "prepare": {"system": SYSTEM, "speeds": (40.0, 50.0), "samples": 32, "rtol": 1e-6},
    "quiet_speeds": {"limits": 1e9, "system": BEAMS, "speeds": (10.0, 10.5)},
    "recover": {"system": BEAMS, "motion": 20.0, "stations": 3, "method": "equilibrium"},
    "resonance_curve": {"system": SYSTEM, "speed": [20.0, 25.0, 30.0]},
    "rigid_forces": {"machine": MACHINE, **AT, "outputs": ("pins",)},
    "run_through": {"system": BEAMS, "profile": el.SpeedProfile.ramp(5.0, 6.0, 0.1)},
    "run_up": {"machine": MACHINE, "torque": 1.0, "duration": 0.01},
    "shaking_force": {"machine": MACHINE, **AT},
    "simulate": {"system": SYSTEM, "speed": 50.0, "revolutions": 1, "rtol": 1e-6, "samples": 8},
    "stability_chart": {"system": SYSTEM, "x": ("speed", [30.0, 40.0])}
    | {"y": ("bending_stiffness", [40.0, 50.0]), "rtol": 1e-9},
    "steady_state": {"system": SYSTEM, "speed": 50.0, "method": "auto", "samples": 32},
    "sweep": {"what": "floquet_multipliers", "subject": SYSTEM, "values": {"speed": [50.0]}}
    | {"options": {}},
    "transmission_angle": {"linkage": FOUR_BAR, "band": (0.7, 2.4)},
    "with_modal_damping": {"system": RIG.system(), "ratio": 0.02},
}
NEVER = {
    "text": "a\0b",
    "complex": np.array([1.0 + 1.0j, 2.0]),
    "masked": np.ma.masked_array([1.0, 2.0], mask=[False, True]),
    "date": np.datetime64("2020-01-01"),
    "NaN": np.nan,
    "objects": np.array([None, 1], dtype=object),
    "class": el.FourBar,
    "lengths": (1.0, "b", 3.0, 4.0),
}
ODD = {
    "None": None,
    "whole": 10**400,
    "huge": 1e300,
    "tiny": 1e-320,
    "negative": -1.0,
    "truth": True,
    "empty": [],
    "ragged": [[1, 2], [3]],
    "cube": np.ones((2, 2, 2)),
    "keys": {1: 2},
    "decimal": decimal.Decimal("1.5"),
    "scene": RIG,
    "linkage": FOUR_BAR,
    "machine": MACHINE,
}


# Slow, and right: a motion of any length, limits that are far away.
SLOW = {("quiet_speeds", "limits", "huge"), ("run_up", "duration", "huge")}


@pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
@pytest.mark.parametrize("name", RIGHT)
def test_wrong_values_are_refused_in_words(name):
    call, right = getattr(el, name), RIGHT[name]
    call(**right)
    for argument in right:
        for label, value in (NEVER | ODD).items():
            if (name, argument, label) in SLOW:
                continue
            try:
                call(**{**right, argument: value})
            except el.ElastolinkError as refusal:
                assert all(line.isprintable() for line in str(refusal).splitlines())
                assert "found" in str(refusal) and "expected" in str(refusal)
                continue
            assert label in ODD, (argument, label)
