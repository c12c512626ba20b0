"""From the file of a model of one's own to its response curve: a pendulum on a shaken pivot.

By hand, W the speed of the crank, Y its acceleration::

    bob rod^2 angle'' + friction angle' + bob rod (g - y) sin(angle) = 0,
    y = stroke (W^2 cos(theta) + Y sin(theta))

Without friction its rest is Mathieu's equation, with the main tongue from ``2 w / sqrt(a_1)`` to
``2 w / sqrt(b_1)``, characteristic values at ``2 stroke / rod``, ``w^2 = g / rod``; by SciPy, right
to 1e-13.
"""

from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from command_runs import told
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.families import Drive, Nonlinear, Varied
from oscillators import extremes, marched, shot
from scipy.special import mathieu_a, mathieu_b

SCENE = """
title = "Pendulum on a shaken pivot"
source = "textbook"

[model]
mechanism = "shaken_pendulum"
formulation = "minimal"

[schema.pendulum]
rod = { dimension = "length", limit = "positive" }
bob = { dimension = "mass", limit = "positive" }
friction = { dimension = "rotational_damping", limit = "non-negative" }
gravity = "acceleration"

[schema.crank]
stroke = { dimension = "length", limit = "non-negative" }

[pendulum]
rod = "400 mm"
bob = "1.3 kg"
friction = 0.0
gravity = 9.81

[crank]
stroke = "30 mm"
"""


@pytest.fixture(scope="module")
def scene(emit, tmp_path_factory):
    """Return the path of the scene, its module emitted where it is looked for."""
    emitted = emit("shaken_pendulum", ModelSpec("shaken_pendulum", "minimal"))
    path = tmp_path_factory.mktemp("scene") / "shaken_pendulum.toml"
    path.write_text(SCENE)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ELASTOLINK_GENERATED", str(Path(emitted.module.__file__).parent))
        yield path


@pytest.fixture(scope="module")
def system(scene):
    made = el.load_scene(scene).system()
    assert isinstance(made, Nonlinear)
    assert made.labels == ("angle",)
    return made


def by_hand(q, qd, qdd, drive, parameters, derivatives=True):
    """Return what is left of the equation above."""
    turn, numbers = np.asarray(drive.angle)[..., None], parameters
    speed, rise = np.asarray(drive.speed)[..., None], np.asarray(drive.acceleration)[..., None]
    lift = numbers["stroke"] * (speed**2 * np.cos(turn) + rise * np.sin(turn))
    pull = numbers["bob"] * numbers["rod"] * (numbers["gravity"] - lift)
    mass = numbers["bob"] * numbers["rod"] ** 2
    left = mass * qdd + numbers["friction"] * qd + pull * np.sin(q)
    one = np.ones((*q.shape, 1))
    return Varied(left, mass * one, numbers["friction"] * one, (pull * np.cos(q))[..., None])


def test_the_emitted_equation_is_that_by_hand(system):
    rng = np.random.default_rng(3)
    states, angle = rng.normal(size=(3, 20, 1)), rng.uniform(0.0, 6.0, 20)
    parameters = {**system.parameters, "friction": 0.2}
    for rise in (0.0, 4.0):
        drive = Drive(angle, 11.0, rise)
        found = system.equations(*states, drive, parameters)
        for one, other in zip(found, by_hand(*states, drive, parameters), strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-13, atol=1e-13)


def tongue(system):
    """Return the edges of the main tongue [rad/s]."""
    numbers = system.parameters
    own = np.sqrt(numbers["gravity"] / numbers["rod"])
    ratio = 2.0 * numbers["stroke"] / numbers["rod"]
    return 2.0 * own / np.sqrt([mathieu_a(1, ratio), mathieu_b(1, ratio)])


def test_its_response_curve(system):
    edges = tongue(system)
    curve = el.response_curve(system, "speed", (0.85 * edges[0], 1.1 * edges[1]), turns=2)
    assert curve.special == ("doubling", "doubling")
    assert np.all(np.abs(curve.special_value - edges) <= curve.special_error + 1e-12 * edges)
    # The motion of two turns against the equation by hand, by DOP853.
    hand = Nonlinear(1, by_hand, system.parameters)
    for i in np.flatnonzero(curve.turns == 2)[[20, -2]]:
        state, _ = shot(hand, curve.value[i], curve.orbits[i].motion.states[0] * 1.001, 2)
        path = marched(hand, curve.value[i], state, 2, samples=2048)
        off = np.abs(extremes(path, 2) - [curve.lowest[i], curve.highest[i]])
        assert np.max(off) <= curve.peak_error[i] + 1e-11


def test_its_response_by_the_command(scene, system, capsys):
    edge = tongue(system)[0]
    found = told(capsys, "response", scene, "--speed", f"{0.99 * edge}:{1.01 * edge}")
    assert found["special"] == ["doubling"]
    assert found["special_value"] == pytest.approx([edge], rel=1e-11)
