"""What the functions of Hill's equation refuse: one line that names the argument."""

import elastolink as el
import numpy as np
from elastolink.runtime.hill.series import boundary_latex
from hill_functions import COSINE
from refusals import each_of, refused

TURN = 2.0 * np.pi
LONG = el.PeriodicFunction(np.ones(1001))


def certified(**given):
    return el.hill_boundaries(**given, certified=True)


def steps(levels=(1.0, -1.0), lengths=(np.pi, np.pi), **given):
    return el.hill_boundaries(**given | {"f": el.Meissner(levels, lengths)})


def mathieu(m=1, q=1.0, kind="a"):
    return el.Mathieu.characteristic(m, q, kind)


def bands(**given):
    return el.characteristic_exponents(lam2=None, **given)


def latex(order=1, region=None):
    return boundary_latex(order, region)


# What is given where a case does not change it.
GIVEN = {
    el.hill_boundaries: {"f": COSINE, "mu": 0.1},
    certified: {"f": COSINE, "mu": 0.1},
    steps: {"mu": 0.1},
    el.perturbation_boundaries: {"f": COSINE, "mu": 0.1},
    el.discriminant: {"f": COSINE, "lam2": 1.0, "mu": 0.1},
    bands: {"f": COSINE, "mu": 1.0, "nu": 0.1},
    el.boundary_solution: {"f": COSINE, "mu": 0.1, "n": 1},
    el.boundary_series: {"f": COSINE, "region": 1},
    el.critical_damping: {"f": COSINE},
}

BOUNDARIES = [
    ({"mu": np.nan}, "mu"),
    ({"mu": "much"}, "mu"),
    ({"mu": np.ones(2), "damping": np.ones(3)}, "broadcast"),
    ({"regions": (1.5,)}, "regions"),
    ({"regions": 3}, "regions"),
    ({"damping": -0.1}, "damping"),
    ({"damping": np.inf}, "damping"),
    ({"mu": 1e9}, "2048 harmonics"),
    ({"mu": 1e301}, "2048 harmonics"),
    ({"regions": (5000,)}, "at most 2048"),
]
CASES = {
    el.hill_boundaries: [*BOUNDARIES, ({"certified": "no"}, "certified")],
    certified: BOUNDARIES,
    steps: [
        ({"mu": np.nan}, "mu"),
        ({"mu": 1e9}, "mu"),
        ({"levels": (1.0, 2.0, 3.0), "lengths": (1.0, 1.0, TURN - 2.0)}, "two"),
        ({"damping": -1.0}, "damping"),
        ({"regions": (-1,)}, "regions"),
        ({"lengths": (-1.0, TURN + 1.0)}, "lengths"),
        ({"lengths": (1.0, 2.0)}, "2 pi"),
        ({"levels": (1.0, np.inf)}, "levels"),
        ({"levels": (1.0, 0.0, 2.0)}, "Meissner"),
    ],
    el.perturbation_boundaries: [
        ({"mu": np.nan}, "mu"),
        ({"mu": 1j}, "mu"),
        ({"mu": [[1.0], [1.0, 2.0]]}, "mu"),
        ({"f": "cos"}, "f: found"),
        ({"f": []}, "f: found"),
        ({"f": [COSINE, "cos"], "mu": [0.1, 0.2]}, "f: found str"),
        ({"f": [COSINE, COSINE], "mu": [0.1]}, "mu"),
        ({"f": [COSINE, COSINE], "mu": [np.ones(2), np.ones(3)]}, "mu"),
        ({"f": [LONG] * 3, "mu": [np.zeros(2)] * 3, "order": 8, "damping": 0.1}, "coefficients"),
        ({"damping": -1e-300}, "damping"),
        ({"damping": np.ones(3), "mu": np.ones(2)}, "damping"),
        ({"order": 9}, "order"),
        ({"order": True}, "order"),
        ({"regions": (-1,)}, "regions"),
        ({"regions": (10**9,)}, "regions"),
        ({"outside": None}, "outside"),
    ],
    el.discriminant: [
        ({"lam2": [np.nan]}, "lam2"),
        ({"lam2": 1e13}, "scale the equation"),
        ({"mu": np.inf}, "mu"),
        ({"damping": -0.1}, "K >= 0"),
        ({"lam2": np.ones(3), "mu": np.ones(4)}, "broadcast"),
    ],
    bands: [
        ({"mu": np.nan}, "mu"),
        ({"mu": 1e9}, "2048"),
        ({"nu": np.inf}, "nu"),
        ({"bands": 3}, "bands"),
        ({"bands": (9999,)}, "bands"),
        ({"damping": -1.0}, "damping"),
    ],
    el.boundary_solution: [
        ({"n": 0, "end": "lower"}, "end"),
        ({"end": "middle"}, "end"),
        ({"mu": [0.1, 0.2]}, "mu"),
        ({"mu": 1e200}, "mu"),
        ({"order": 9}, "order"),
        ({"damping": -1.0}, "damping"),
        ({"damping": 1.0}, "closed by damping"),
        ({"damping": 1.0, "order": 3}, "closed by damping|converge"),
        ({"mu": 30.0, "order": 3}, "converge"),
        ({"n": -1}, "regions"),
    ],
    el.boundary_series: [({"damping_ratio": 2.0}, "damping")],
    el.critical_damping: [
        ({}, "mu"),
        ({"mu": np.nan}, "mu"),
        ({"mu": 0.1, "regions": (0, 1)}, "regions"),
        ({"mu": 0.1, "damping": 0.1}, "mu"),
        ({"damping": -0.1}, "damping"),
    ],
    mathieu: [
        ({"kind": "c"}, "kind"),
        ({"m": -1}, "m"),
        ({"m": 501}, "m"),
        ({"q": 1e7}, "q"),
        ({"q": np.nan}, "q"),
    ],
    latex: [
        ({"order": 0}, "order"),
        ({"order": 7}, "use perturbation_boundaries"),
        ({"region": -1}, "region"),
        ({"region": 0.5}, "region"),
    ],
}


test_bad_input_is_refused_in_one_line = refused(
    lambda call, changes: call(**GIVEN.get(call, {}) | changes), each_of(CASES)
)
