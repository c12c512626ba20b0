"""Arrays in closed form: those of the system, and their derivatives by numbers of the scene."""

import elastolink as el
import flint
import numpy as np
import pytest
from elastolink.runtime.design import coefficient_changes as changes_module
from elastolink.runtime.design.coefficient_changes import coefficient_changes
from elastolink.runtime.design.enclosures import Ball
from elastolink.runtime.periodic.equation import SPEED_POWER
from elastolink.runtime.scenes import with_numbers
from elastolink.runtime.systems.closed_form import closed_form

COUPLER = "smith_1972_5152_sixteenth_inch"
ANGLES = np.linspace(0.1, 6.0, 7)
BY = ["links.frame", "links.crank", "links.coupler", "links.follower", "follower.inertia"]
SCENES = [
    (COUPLER, {"model.modes": 3}, [*BY, "coupler.natural_frequency", "coupler.bending_stiffness"]),
    (
        COUPLER,
        {"model.formulation": "printed", "coupler.mass_per_length": "0.2 kg/m"},
        [*BY, "coupler.mass_per_length"],
    ),
    (COUPLER, {"model.formulation": "reduced", "coupler.damping_ratio": 0.02}, BY),
    ("hill_example", {}, ["parameters.lam2", "parameters.mu"]),
]


@pytest.mark.parametrize(("name", "more", "by"), SCENES)
def test_arrays_are_those_of_the_system(name, more, by):
    scene = el.load_scene(name, more)
    closed, system = closed_form(scene), scene.linear_system()
    found = closed.arrays(closed.numbers(scene), ANGLES, SPEED_POWER)
    assert {array for array, _ in found} == {t.array for t in system.terms} & set(SPEED_POWER)
    for array in {array for array, _ in found}:
        total = sum(value * 2.0**power for (kind, power), value in found.items() if kind == array)
        expected = system.array(array, ANGLES, 2.0)
        whole = np.broadcast_to(total, expected.shape)
        assert whole == pytest.approx(expected, rel=1e-14, abs=1e-13 * np.max(np.abs(expected)))


@pytest.mark.parametrize(("name", "more", "by"), SCENES)
def test_derivatives_are_those_of_differences_of_systems(name, more, by, monkeypatch):
    scene = el.load_scene(name, more)
    system = scene.linear_system()
    found = coefficient_changes(scene, system, by)
    monkeypatch.setattr(changes_module, "closed_form", lambda scene: None)
    expected, moving = coefficient_changes(scene, system, by), []
    for part, slopes in expected.slopes.items():
        size = found.number[:, None, None] * np.abs(slopes).reshape(len(by), len(slopes[0]), -1)
        gap = found.number[:, None, None] * np.abs(found.slopes[part] - slopes).reshape(size.shape)
        assert np.all(gap <= 1e-11 * np.max(np.abs(expected.parts[part])) + 1e-11 * np.max(size))
        moving.append(np.max(size) > 0.1 * np.max(np.abs(expected.parts[part])))
    assert sum(moving) >= (3 if "mass_per_length" in by[-1] else 2)


def random_couplers(count):
    random, found = np.random.default_rng(0), []
    while len(found) < count:
        frame, coupler = 0.381 * random.uniform(0.7, 1.3, 2)
        crank, follower = 0.0762 * random.uniform(0.5, 1.6), 0.1524 * random.uniform(0.9, 2.0)
        lengths = {"frame": frame, "crank": crank, "coupler": coupler, "follower": follower}
        try:
            found.append(el.load_scene(COUPLER, {f"links.{k}": v for k, v in lengths.items()}))
        except el.BadInput:
            continue
    return found


def balls(values):
    row = np.empty(len(values), dtype=object)
    row[:] = [Ball(flint.acb(value)) for value in values]
    return row


def test_derivatives_by_a_complex_step_are_off_by_the_round_off_that_is_told():
    """Against the same step in balls of 300 bits."""
    told = changes_module._ROUNDED
    for scene in random_couplers(8):
        closed = closed_form(scene)
        for name in BY:
            value, step = scene.get(name), 1e-40
            moved = with_numbers(scene, {name: complex(value, step)}, checked=False)
            found = closed.arrays(closed.numbers(moved), ANGLES, ("B", "f"))
            with flint.ctx.workprec(300):
                moved = with_numbers(scene, {name: Ball(flint.acb(value, step))}, checked=False)
                numbers = closed.numbers(moved)
                numbers = {
                    k: v if isinstance(v, Ball) else balls([v])[0] for k, v in numbers.items()
                }
                exact = closed.arrays(numbers, balls(ANGLES.tolist()), ("B", "f"))
            for part, slope in found.items():
                reference = [float(x.value.imag.mid()) for x in exact[part].ravel()]
                if np.iscomplexobj(slope) and np.any(reference):
                    gap = np.abs(slope.imag.ravel() - reference)
                    assert np.max(gap) <= told * np.max(np.abs(reference))


def test_parameters_that_are_held_stay():
    scene = el.load_scene(COUPLER)
    held = {"follower_inertia": 3e-4}
    system = scene.linear_system().with_parameters(**held)
    found = coefficient_changes(scene, system, ["links.crank"], held)
    other = el.load_scene(COUPLER, {"follower.inertia": "3e-4 kg*m**2"})
    expected = coefficient_changes(other, other.linear_system(), ["links.crank"])
    for part, slopes in expected.slopes.items():
        assert found.slopes[part] == pytest.approx(slopes, rel=1e-12, abs=1e-12)


def test_rods_and_beams_have_none():
    for name in ("beale_1992_flexible_rod", "aannaque_1996_long_coupler"):
        assert closed_form(el.load_scene(name)) is None
    bent = el.load_scene(COUPLER, {"model.formulation": "inextensible"})
    assert closed_form(bent) is None
