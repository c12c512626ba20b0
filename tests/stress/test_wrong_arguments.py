"""Wrong arguments of every public name: one refusal, or an answer; never another error."""

import inspect

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput

SCENE = el.load_scene("smith_1972_5152_sixteenth_inch")
LINES = np.linspace(40.0, 50.0, 4)
# What does for required arguments, by name; all others get 1.
RIGHT = {
    "system": SCENE.system(),
    "speed": 45.0,
    "speeds": LINES,
    "speed_range": (40.0, 50.0),
    "f": el.PeriodicFunction([0.0, 1.0]),
    "mu": 0.1,
    "lam2": 0.3,
    "linkage": el.FourBar(frame=0.254, crank=0.108, coupler=0.2794, follower=0.2705),
    "lengths": (4.0, 1.0, 3.0, 3.0),
    "theta": 0.3,
    "revolutions": 1.0,
    "point": (0.1, 0.1),
    "x": ("speed", LINES),
    "y": ("follower_inertia", np.linspace(1e-3, 2e-3, 3)),
}
WRONG = [
    *(None, "abc", SCENE, float("nan"), float("inf"), -1.0, 1 + 2j, 10**400, object(), b"no"),
    *([], [[1, 2], [3]], np.array(["a", "b"]), {"a": 1}, {"x"}),
]


def public():
    """Return every public callable that is no error, with its arguments by name."""
    for name in el.__all__:
        call = getattr(el, name)
        if callable(call) and not (inspect.isclass(call) and issubclass(call, BaseException)):
            rows = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
            arguments = inspect.signature(call).parameters.values()
            yield name, call, [one for one in arguments if one.kind not in rows]


@pytest.mark.filterwarnings("ignore")
def test_wrong_arguments_are_refused_in_order():
    """One wrong argument at a time, among right ones."""
    tried = refused = 0
    for name, call, arguments in public():
        needed = {one.name: 1.0 for one in arguments if one.default is one.empty}
        needed |= {key: RIGHT[key] for key in needed if key in RIGHT}
        for one in arguments:
            for wrong in WRONG:
                tried += 1
                try:
                    call(**{**needed, one.name: wrong})
                except BadInput:
                    refused += 1
                except Exception as error:
                    pytest.fail(f"{name}({one.name}={wrong!r:.40}): {error!r}")
    # Names and descriptions may be any text, and None is often what stands there anyway.
    assert tried > 5000 and refused > 0.9 * tried
