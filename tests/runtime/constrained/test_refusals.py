"""What constrained motions and their initial values refuse: one line that names the argument."""

from __future__ import annotations

import numpy as np
import pytest
from constrained_truth import Circle
from elastolink.runtime.constrained import consistent_state, constrained_motion
from elastolink.runtime.core.errors import BadInput

# A start that meets the constraint, of a motion or to be made consistent.
GIVEN = {"q": [0.0, -1.0], "qd": [1.0, 0.0]}
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


@pytest.mark.parametrize(
    ("call", "changes", "words"), [(call, *case) for call, cases in CASES.items() for case in cases]
)
def test_bad_input_is_refused_in_one_line(call, changes, words):
    span = {"span": 1.0} if call is constrained_motion else {}
    with pytest.raises(BadInput, match=words) as told:
        call(Circle().system, **{**GIVEN, **span, **changes})
    assert "\n" not in str(told.value)
