"""What constrained motions and their initial values refuse: one line that names the argument."""

import numpy as np
from constrained_truth import Circle
from elastolink.runtime.constrained import consistent_state, constrained_motion
from refusals import each_of, refused

# A start that meets the constraint, of a motion or to be made consistent.
START = {"q": [0.0, -1.0], "qd": [1.0, 0.0]}
GIVEN = {constrained_motion: {**START, "span": 1.0}, consistent_state: START}
CASES = {
    constrained_motion: [
        ({"span": -1.0}, "span: found -1.0"),
        ({"span": (0.0, np.inf)}, "span: found"),
        ({"span": "long"}, "span: found 'long'"),
        ({"span": None}, "the system has no period"),
        ({"q": None}, "the system has no reference motion"),
        ({"rtol": 0.0}, "rtol: found 0.0"),
        ({"rtol": "x"}, "rtol: found 'x'"),
        ({"samples": 0}, "samples: found 0"),
        ({"samples": [0.5, 0.2]}, "samples: found times"),
        ({"bound": 0.5}, "bound: found 0.5"),
        ({"q": [0.0, -1.1]}, "off the constraints"),
        ({"qd": [1.0, 1.0]}, "qd: found a start 1 off"),
        ({"q": [[0.0, -1.0]]}, "one motion at a time"),
        ({"q": [np.nan, -1.0]}, "q: found a number that is not finite"),
    ],
    consistent_state: [
        ({"q": [np.nan, 0.0]}, "q: found a number that is not finite"),
        ({"qd": [0.0, np.inf]}, "qd: found a number that is not finite"),
        ({"t": np.nan}, "t: found a number that is not finite"),
        ({"q": [0.6]}, r"q: found shape \(1,\)"),
        ({"q": 0.6}, r"q: found shape \(\)"),
        ({"q": ["x", "y"]}, "q: found"),
        ({"qd": np.zeros((3, 2)), "t": [0.0, 1.0]}, "shapes that broadcast"),
        ({"hold": ("c",)}, "hold: found 'c'"),
        ({"hold": (2,)}, "hold: found 2"),
        ({"hold": ("a", "b")}, "at most 1"),
        ({"q": [2.6, -0.8], "hold": ("a",)}, "no state nearby"),
    ],
}


test_bad_input_is_refused_in_one_line = refused(
    lambda call, changes: call(Circle().system, **{**GIVEN[call], **changes}), each_of(CASES)
)
