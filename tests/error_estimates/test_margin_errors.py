"""Errors of margins and of a diagnosis, against laws that hold exactly."""

import elastolink as el
import numpy as np
from elastolink.runtime.design import diagnose, margins
from honesty import over_scenes

SCENE = "smith_1972_5152_sixteenth_inch"


@over_scenes(511, few=2, many=30, floor=5e-15)
def test_changes_of_stiffness(rng):
    """Speeds of an undamped machine go with the root of its stiffness."""
    system = el.load_scene(SCENE).system()
    speed = float(rng.uniform(70.0, 90.0))
    found = margins(system, speed, ["bending_stiffness"])
    exact = (speed / found.end) ** 2 - 1.0
    known = np.isfinite(found.change[:, 0])
    if not np.any(known):
        return None
    return found.change_error[known, 0], (found.change[:, 0] - exact)[known]


@over_scenes(521, few=2, many=30, floor=1e-15)
def test_growth_of_a_stable_machine_of_one_freedom(rng):
    """Both motions of y'' + 2 K y' + ... decay by K a radian where they oscillate."""
    damping = float(rng.uniform(0.02, 0.2))
    scene = el.load_scene("mathieu", {"parameters.damping": damping, "parameters.mu": 0.1})
    found = diagnose(scene, 1.0)
    exponents = el.floquet_multipliers(scene.system(), 1.0).exponents
    if abs(exponents[0].real - exponents[1].real) > 1e-6:
        return None
    return found.error, found.growth + damping * scene.system().period
