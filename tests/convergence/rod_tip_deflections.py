"""Tip deflections v(L)/L of the flexible rod from rest, as ``rod_reference.py`` computes them.

Crank angles pi/4, pi/2, ... over one revolution.  Printed by ``python rod_reference.py``; known to
the given absolute error, an eighth of the change from half the elements and half the steps (the
elements near the block converge in third order, the steps in fifth).
"""

from __future__ import annotations

import numpy as np


def _tips(error: float, values: str) -> tuple[float, np.ndarray]:
    return error, np.array(values.split(), dtype=float)


# Case, with tension or not: the error, then the values.
TIPS = {
    ("flexible, ratio 0.01, 100 rad/s", True): _tips(
        5e-11,
        "8.727844473e-05 1.314370068e-04 9.474358088e-05 -1.430485840e-05 "
        "-1.210567202e-04 -1.513582184e-04 -9.582529733e-05 6.973050921e-06",
    ),
    ("flexible, ratio 0.01, 100 rad/s", False): _tips(
        5e-11,
        "8.727882385e-05 1.314370253e-04 9.474380409e-05 -1.430510876e-05 "
        "-1.210575585e-04 -1.513589371e-04 -9.582639130e-05 6.972173574e-06",
    ),
    ("flexible, ratio 0.2, 300 rad/s", True): _tips(
        5e-10,
        "2.368682027e-03 1.507538039e-02 5.222700332e-02 7.418780656e-02 "
        "-6.423087472e-02 -1.275204513e-01 1.045885837e-01 -8.629103295e-02",
    ),
    ("flexible, ratio 0.2, 300 rad/s", False): _tips(
        4e-10,
        "2.373776867e-03 1.511018969e-02 5.226948572e-02 7.608785717e-02 "
        "-6.033447582e-02 -1.309026097e-01 1.061002789e-01 -8.589334211e-02",
    ),
    ("stiff, 90 rad/s", True): _tips(
        3e-11,
        "6.107421323e-06 3.290465312e-05 1.417532977e-04 -3.426060007e-08 "
        "-1.417104760e-04 -3.293025608e-05 -6.081298181e-06 3.537151703e-08",
    ),
    ("stiff, 90 rad/s", False): _tips(
        3e-11,
        "6.107483373e-06 3.290474094e-05 1.417554085e-04 -3.435249003e-08 "
        "-1.417125824e-04 -3.293028452e-05 -6.081153584e-06 3.530829531e-08",
    ),
}
