"""Unstable regions beside a dense line of multipliers where regions touch, nest and meet."""

import numpy as np
import pytest
from edge_truth import contradictions, rig
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.stability import stability_edges
from periodic_systems import system_of, wave

SWAP = np.array([[0.0, 1.0], [1.0, 0.0]])
NONE = np.zeros((2, 2))


def _system(stiffness, waves, damping=None) -> LinearPeriodic:
    """Return unit masses on springs with a sum of waves (harmonic, cosine, sine matrices)."""
    pull = [wave(cosine, harmonic) for harmonic, cosine, _ in waves]
    pull += [wave(sine, harmonic, -np.pi / 2) for harmonic, _, sine in waves]
    drag = {} if damping is None else {"C": damping}
    return system_of(M=np.eye(len(stiffness)), K=np.diag(stiffness), Kg=pull, **drag)


def _busy(strength, damping):
    rng = np.random.default_rng(0)

    def matrix():
        base = rng.normal(size=(2, 2))
        return strength * (base + base.T) / np.sqrt(2)

    waves = [(1, matrix(), matrix()), (2, 0.5 * matrix(), 0.2 * matrix())]
    return _system([1.0, 5.29], waves, damping * np.eye(2))


@pytest.mark.parametrize("strength", [0.6, pytest.param(0.9, marks=pytest.mark.slow)])
def test_damped_regions_leave_stable_gaps_open(strength):
    """Regions 3 of mode 2 and of the sum, n = 2, lie side by side; one may not bridge the gap."""
    system = _busy(strength, 0.02)
    found = stability_edges(system, (1.2, 5.0))
    assert found.passed, found.checks
    assert contradictions(system, found, np.linspace(1.2, 5.0, 600)) == 0
    upper = found.upper[found.labels.index("region 3 of mode 2")]
    lower = found.lower[found.labels.index("sum of 1 and 2, n = 2")]
    assert floquet_multipliers(system, 0.5 * (lower + upper)).stable


def test_tiny_damping_changes_next_to_nothing():
    pull = [(1, 0.1 * SWAP, NONE)]
    sharp = stability_edges(_system([1.0, 5.29], pull), (3.0, 3.6))
    found = stability_edges(_system([1.0, 5.29], pull, 1e-15 * np.eye(2)), (3.0, 3.6))
    i, j = (e.labels.index("sum of 1 and 2, n = 1") for e in (sharp, found))
    assert abs(found.lower[j] - sharp.lower[i]) < 1e-11
    assert abs(found.upper[j] - sharp.upper[i]) < 1e-11


@pytest.mark.parametrize("span", [(1.2, 6.0), (3.0, 3.6)])
def test_damped_labels_do_not_depend_on_the_range(span):
    found = stability_edges(_system([1.0, 5.29], [(1, 0.1 * SWAP, NONE)], 0.003 * np.eye(2)), span)
    assert "sum of 1 and 2, n = 1" in found.labels
    assert np.all(found.detuning < 0.5)
    assert found.passed, found.checks


@pytest.mark.parametrize("span", [(0.6, 2.5), (0.95, 1.3)])
def test_boundaries_that_touch_within_a_region_do_not_split_it(span):
    """A rotating stiffness: one region, in which another pair touches +1 at a double boundary."""
    system = _system([1.0, 1.0], [(2, 0.1 * np.diag([1.0, -1.0]), 0.1 * SWAP)])
    found = stability_edges(system, span)
    assert found.passed, found.checks
    assert np.all(np.isfinite(found.width))
    wide = np.flatnonzero(found.width > 1e-3)
    assert len(wide) == 1
    # Seen from the turning axes the coefficients rest: w^2 = 1 -+ 0.1.
    assert found.lower[wide[0]] == pytest.approx(np.sqrt(0.9), rel=1e-12)
    assert found.upper[wide[0]] == pytest.approx(np.sqrt(1.1), rel=1e-12)


@pytest.mark.parametrize(("pull", "width"), [(1e-3, 2.36e-4), (1e-4, 2.36e-5)])
def test_sum_region_at_a_multiplier_of_one(pull, width):
    """At w = 1 both modes turn through whole turns: four multipliers meet at +1."""
    system = _system([1.0, 4.0], [(3, pull * SWAP, NONE)])
    found = stability_edges(system, (0.9, 1.1))
    at = found.labels.index("sum of 1 and 2, n = 3")
    assert found.passed, found.checks
    assert found.width[at] == pytest.approx(width, rel=0.01)
    assert np.all(found.detuning < 0.5)
    for end, sign in ((found.lower[at], 1), (found.upper[at], -1)):
        step = sign * (10 * found.error[at] + 1e-4 * width)
        sides = floquet_multipliers(system, end + np.array([-step, step]), rtol=1e-13)
        grown = np.max(np.abs(sides.multipliers), axis=-1) - 1.0
        assert grown[1] > 3 * grown[0]


def test_nested_regions_of_a_rig_do_not_depend_on_the_range():
    """A wide region of Smith's rig with narrow ones in it, speeds in rpm."""
    system, rpm = rig(**{"model.modes": 2}), np.pi / 30
    for low, high in ((1050, 2200), (1000, 1800)):
        found = stability_edges(system, (low * rpm, high * rpm))
        assert found.passed, found.checks
        at = int(np.argmin(np.abs(found.lower / rpm - 1099.485)))
        assert found.kind[at] == "principal"
        assert found.lower[at] / rpm == pytest.approx(1099.485, abs=1e-3)
        assert found.upper[at] / rpm == pytest.approx(2031.401, abs=1e-3)


@pytest.mark.parametrize("damping", [None, 1e-3 * np.eye(1)])
def test_a_range_within_a_region_is_a_region_without_ends(damping):
    system = _system([1.0], [(1, 0.9 * np.eye(1), np.zeros((1, 1)))], damping)
    found = stability_edges(system, (1.9, 1.95), margin=1.01)
    assert found.labels == ("region 1 of mode 1",) or damping is not None
    assert len(found.kind) == 1
    assert np.isnan(found.lower[0])
    assert np.isnan(found.upper[0])
    assert found.passed, found.checks


def test_closed_regions_are_drawn_apart_from_open_ones():
    found = stability_edges(_system([1.0, 5.29], [(1, 0.1 * SWAP, NONE)]), (1.2, 6.0))
    axes = found.plot()
    assert axes.get_xlabel() == "crank speed [rpm]"
    wide = found.width > 2 * found.error
    assert 0 < wide.sum() < len(wide)
    assert len(axes.collections) == wide.sum()
    assert any("closed" in text for text in axes.get_legend_handles_labels()[1])
