"""Charts under strain: hidden damping, mass axes, growth, weak resonances, tips, long work."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.stability import chart
from periodic_systems import system_of, wave

ONE, TWO = np.eye(1), np.eye(2)
RIG = "smith_1972_5152_sixteenth_inch"


def one(m=1.0, c=0.0, k=2.0, b=0.5):
    numbers = {"m": m, "c": c, "k": k, "b": b}
    return system_of(numbers, M=("m", ONE), C=("c", ONE), K=("k", ONE), Kg=("b", wave(ONE)))


def two(c=0.0, b=0.5, damping=TWO, pull=((1.0, 0.4), (0.4, 0.7)), squares=(1.0, 3.3)):
    springs = {"K": np.diag(squares), "Kg": ("b", wave(pull))}
    return system_of({"c": c, "b": b}, M=TWO, C=("c", damping), **springs)


def _fading(theta):
    return np.sin(theta)[:, None, None] ** 2 * TWO


CASES = {
    "damping axis": (one(), ("c", np.linspace(0, 0.2, 21)), ("b", np.linspace(0, 1, 15))),
    "mass axis": (one(), ("m", np.linspace(0.5, 2, 21)), ("b", np.linspace(0, 1, 15))),
    "mass, damped": (one(c=0.1), ("m", np.linspace(0.5, 2, 21)), ("k", np.linspace(0.5, 2, 15))),
    "two, damping axis": (two(), ("speed", np.linspace(1, 4, 30)), ("c", np.linspace(0, 0.5, 9))),
    "two, no damping at 0": (
        two(c=0.1, damping=_fading),
        ("speed", np.linspace(1, 4, 40)),
        ("b", np.linspace(0, 1, 30)),
    ),
    "circulatory": (
        two(pull=((0.0, 0.8), (-0.5, 0.0))),
        ("speed", np.linspace(1, 4, 30)),
        ("b", np.linspace(0, 1, 9)),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_verdicts_are_those_of_the_multipliers(case):
    system, x, y = CASES[case]
    found = el.stability_chart(system, x, y, boundaries=False)
    point = {x[0]: x[1][None, :], y[0]: y[1][:, None]}
    direct = el.floquet_multipliers(system, point.pop("speed", 1.0), **point)
    modulus = np.max(np.abs(direct.multipliers), axis=-1)
    assert np.all(np.abs(found.largest - modulus) <= 4 * found.slack + 1e-9 * modulus)
    clear = np.abs(modulus - 1.0) > 1e-6
    assert np.array_equal(found.stable[clear], direct.stable[clear])
    assert found.passed


def test_large_half_traces_pass():
    system = el.load_scene("mathieu").system()
    found = el.stability_chart(
        system, ("lam2", np.linspace(-5.0, 5.0, 101)), ("mu", np.linspace(0.0, 4.0, 81))
    )
    assert np.max(np.abs(found.invariants)) > 1e5
    assert found.passed


@pytest.mark.parametrize("eps", [1e-3, 1e-5])
def test_weak_combination_resonance_is_seen(eps):
    """Antisymmetric pull of two modes: the sum resonance grows by about eps / 2 in a turn."""
    system = two(b=eps, pull=((0.0, 1.0), (1.0, 0.0)), squares=(1.0, 3.0))
    middle = 1.0 + np.sqrt(3.0)
    speeds = np.linspace(middle - 0.6 * eps, middle + 0.6 * eps, 41)
    found = el.stability_chart(system, ("speed", speeds), ("b", [eps, 1.001 * eps]))
    direct = el.floquet_multipliers(system, speeds)
    assert np.array_equal(found.stable[0], direct.stable)
    assert 10 < np.sum(found.stable[0]) < 31
    assert np.max(found.slack) < eps


def test_spot_check_catches_a_slack_that_hides_a_resonance(monkeypatch):
    sharp = chart.largest_modulus

    def blunt(coefficients, **options):
        largest, _, slack = sharp(coefficients, **options)
        return np.where(largest < 1.01, 1.0, largest), largest < 1.01, slack + 0.01

    monkeypatch.setattr(chart, "largest_modulus", blunt)
    system = two(b=1e-3, pull=((0.0, 1.0), (1.0, 0.0)), squares=(1.0, 3.0))
    middle = 1.0 + np.sqrt(3.0)
    speeds = np.linspace(middle - 1e-4, middle + 1e-4, 21)
    found = el.stability_chart(system, ("speed", speeds), ("b", [1e-3, 1.001e-3]))
    assert not found.checks["spot check"].passed


def test_no_damped_end_is_lost_and_each_lies_on_the_level():
    """The ends found, against the verdict on a fine line of speeds, and against multipliers."""
    overrides = {"follower.inertia": 0.0022, "coupler.damping_ratio": 0.01}
    system = el.load_scene(RIG, overrides).system()
    speeds = np.linspace(40.0, 160.0, 4001)
    damping = np.linspace(0.6, 12.0, 6)
    found = el.stability_chart(system, ("speed", speeds), ("damping", damping))
    curves = found.exact
    for j, c in enumerate(curves.at):
        change = speeds[np.flatnonzero(np.diff(found.stable[j].astype(int)))]
        ends = np.concatenate([curves.lower[:, j], curves.upper[:, j]])
        ends = np.sort(ends[(ends > speeds[0]) & (ends < speeds[-1])])
        assert len(ends) == len(change) > 0
        assert np.all((ends >= change) & (ends <= change + 0.0301))
        direct = el.floquet_multipliers(system, ends, damping=c)
        assert np.max(np.min(np.abs(np.abs(direct.multipliers) - 1.0), axis=-1)) < 1e-8


def test_regions_beyond_the_limit_are_counted():
    system = el.load_scene("mathieu").system()
    lam2 = np.linspace(0.1, 400.0, 51)
    found = el.stability_chart(system, ("lam2", lam2), ("mu", np.linspace(0.1, 1.0, 3)))
    # Region 0, of divergence, comes before the 24 that are counted.
    assert found.exact.regions == tuple(range(25))
    assert found.exact.left_out >= 2 * 20 - 24


def test_frequency_that_the_other_axis_changes_is_not_shown():
    speeds = ("speed", np.linspace(0.5, 3.0, 12))
    moved = el.stability_chart(one(), speeds, ("k", np.linspace(1.0, 2.0, 5)))
    kept = el.stability_chart(one(), speeds, ("b", np.linspace(0.0, 1.0, 5)))
    assert np.isnan(moved.natural_frequency)
    assert kept.natural_frequency == pytest.approx(np.sqrt(2.0), rel=1e-14)
