"""Unstable regions along the speed: first-order widths, labels, damping, random systems."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import contradictions, region_of, rig
from periodic_systems import system_of, wave

LOW, HIGH = 1.0, 2.3


def _pair(pull=0.02, own=0.0, damping=(0.0, 0.0)) -> el.LinearPeriodic:
    """Two oscillators, 1 and 2.3 rad/s, coupled (and each pulled, by ``own``) by pull cos."""
    matrix = np.array([[own, 1.0], [1.0, own]])
    return system_of(
        {"pull": pull, "c1": damping[0], "c2": damping[1]},
        M=np.eye(2),
        K=np.diag([LOW**2, HIGH**2]),
        Kg=("pull", wave(matrix)),
        C=[("c1", np.diag([1.0, 0.0])), ("c2", np.diag([0.0, 1.0]))],
    )


@pytest.mark.parametrize(
    ("system", "span", "least"),
    [(_pair(0.3, own=1.0), (1.3, 6.0), 4), (rig(**{"model.modes": 2}), (81.0, 81.7), 1)],
)
def test_the_edges_are_where_multipliers_leave_the_circle(system, span, least):
    """Multipliers from another tolerance, a hair on either side of each end."""
    found = el.stability_edges(system, span)
    checked = 0
    for i in range(len(found.kind)):
        if not found.width[i] > 1e-5:
            continue
        step = 1e-4 * found.width[i]
        ends = np.array([found.lower[i], found.upper[i]])
        outside = el.floquet_multipliers(system, ends + step * np.array([-1, 1]), rtol=1e-13)
        inside = el.floquet_multipliers(system, ends + step * np.array([1, -1]), rtol=1e-13)
        assert outside.stable.tolist() == [True, True]
        assert inside.stable.tolist() == [False, False]
        checked += 1
    assert checked >= least
    assert found.passed, found.checks


def test_closed_meetings_are_listed_and_labelled():
    """Second and third sum resonances of a pull of one harmonic are of higher order, not lost."""
    found = el.stability_edges(_pair(0.02), (1.05, 3.6))
    for harmonic in (1, 2, 3):
        at = region_of(found, "sum", harmonic)
        middle = 0.5 * (found.lower[at] + found.upper[at])
        assert middle == pytest.approx((LOW + HIGH) / harmonic, rel=1e-3)
    third = region_of(found, "sum", 3)
    # Of third order in the pull: (e/2)^3 over distances of order 1.
    assert 1e-9 < found.width[third] < 1e-5
    assert found.width[region_of(found, "sum", 2)] <= 2 * found.error[region_of(found, "sum", 2)]
    assert found.least_width < 1e-9


def test_uncoupled_oscillators_have_only_closed_regions():
    found = el.stability_edges(_pair(0.0), (0.9, 5.0))
    assert np.all(found.width <= 2 * found.error)
    expected = sorted(
        [2 * w / n for w in (LOW, HIGH) for n in range(1, 8)] + [3.3 / n for n in range(1, 8)]
    )
    expected = [w for w in expected if 0.9 <= w <= 5.0]
    np.testing.assert_allclose(np.sort(found.lower), expected, rtol=1e-9)
    assert found.passed, found.checks
    assert np.all(found.detuning < 1e-9)


@pytest.mark.parametrize(("first", "second"), [(0.004, 0.004), (0.004, 0.0004)])
def test_damping_draws_a_sum_region_in_and_if_unequal_widens_it(first, second):
    """Mettler; Schmidt and Weidenhammer.

    |speed - w1 - w2| < (c1 + c2)/(2 sqrt(c1 c2)) sqrt(e^2/(4 w1 w2) - c1 c2).
    """
    pull, system = 0.02, _pair(0.02, damping=(first, second))
    found = el.stability_edges(system, (3.2, 3.4))
    at = region_of(found, "sum", 1)
    sharp = pull / (2 * np.sqrt(LOW * HIGH))
    half = 0.5 * (first + second) / np.sqrt(first * second) * np.sqrt(sharp**2 - first * second)
    assert 0.5 * found.width[at] == pytest.approx(half, rel=0.02)
    assert found.passed, found.checks
    ends = el.floquet_multipliers(system, [found.lower[at], found.upper[at]]).multipliers
    np.testing.assert_allclose(np.max(np.abs(ends), axis=-1), 1.0, rtol=0, atol=1e-11)


def test_strong_damping_closes_every_region():
    found = el.stability_edges(_pair(0.02, damping=(0.05, 0.05)), (1.3, 5.0))
    assert len(found.kind) == 0
    assert found.passed, found.checks


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.0, 1e-5])
def test_narrow_regions_within_wide_ones(damping):
    """The thinnest coupler, the heaviest follower: regions of mode 2 within those of mode 1."""
    name = "smith_1972_5152_thirtysecond_inch"
    scene = el.load_scene(name, overrides={"model.modes": 2, "coupler.damping_ratio": damping})
    found = el.stability_edges(scene.system(), (23.56, 47.12), follower_inertia=2.14671e-3)
    assert found.passed, found.checks
    wide = found.labels.index("region 3 of mode 1")
    assert found.lower[wide] == pytest.approx(40.328, abs=1e-3)
    assert np.isnan(found.upper[wide])
    nested = found.labels.index("region 17 of mode 2")
    around = found.labels.index("region 4 of mode 1")
    assert found.lower[around] < found.lower[nested] < found.upper[nested] < found.upper[around]
    # Of like multiplier as the wider region, told by the number of those off the circle.
    assert "region 15 of mode 2" in found.labels


def _random(seed, strength) -> el.LinearPeriodic:
    """Two modes with gyroscopic terms, a periodic mass and two harmonics of stiffness."""
    rng = np.random.default_rng(seed)

    def symmetric(size):
        base = rng.normal(size=(2, 2))
        return (base + base.T) * size / 2

    bulge, skew = symmetric(1.0), rng.normal(size=(2, 2)) * 0.3
    return system_of(
        M=[np.eye(2) + 0.1 * bulge @ bulge, wave(symmetric(0.05 * strength), 1, 0.3)],
        A=skew - skew.T,
        B=wave(symmetric(0.1 * strength), 1, rng.uniform(0, 6)),
        K=np.diag(rng.uniform(1, 20, 2)) + symmetric(0.5),
        Kg=[wave(symmetric(strength), n, rng.uniform(0, 6)) for n in (1, 2)],
    )


def _whirl(pull) -> el.LinearPeriodic:
    """Return a mass on a spring seen from the crank, of negative energy above sqrt(2) rad/s."""
    matrix = pull * np.array([[1.0, 0.3], [0.3, -0.5]])
    return system_of(
        M=np.eye(2),
        A=np.array([[0.0, -1.0], [1.0, 0.0]]),
        B=np.eye(2),
        K=2.0 * np.eye(2),
        Kg=wave(matrix, 1, 0.2),
    )


@pytest.mark.parametrize(
    "system",
    [
        _random(6, 3.0),
        *(
            pytest.param(system, marks=pytest.mark.slow)
            for system in (_random(1, 0.5), _random(2, 2.0), _whirl(1.0))
        ),
    ],
)
def test_every_unstable_speed_is_in_a_region_and_no_other(system):
    found = el.stability_edges(system, (1.2, 9.0))
    assert contradictions(system, found, np.linspace(1.2, 9.0, 1501)) == 0
    assert np.nansum(found.width) > 0.15
    assert found.passed, found.checks


def _pulled(frequencies, matrix) -> el.LinearPeriodic:
    return system_of(M=np.eye(len(matrix)), K=np.diag(frequencies) ** 2, Kg=wave(matrix))


@pytest.mark.parametrize(
    ("system", "span", "label"),
    [
        (
            _pulled([1.0, np.sqrt(12.0)], np.array([[0.9, 0.05], [0.05, 0.3]])),
            (1.95, 2.05),
            "region 1 of mode 1",
        ),
        (
            el.load_scene(
                "smith_1972_5152_thirtysecond_inch", overrides={"model.modes": 2}
            ).system(),
            (84.0, 92.0),
            "region 2 of mode 1",
        ),
    ],
)
def test_a_region_wider_than_the_search_is_found(system, span, label):
    found = el.stability_edges(system, span)
    assert label in found.labels
    assert found.passed, found.checks
    speeds = np.linspace(*span, 101)
    assert contradictions(system, found, speeds) == 0


def test_four_multipliers_that_leave_at_minus_one_are_a_sum_of_their_modes():
    """Two modes of nearly one frequency: between their principal regions lies their sum's."""
    rng = np.random.default_rng(1)
    matrix = rng.normal(size=(3, 3))
    phase, turned = rng.uniform(0, 6), rng.normal(size=(3, 3))
    system = _pulled([2.546, 3.415, 3.424], (matrix + matrix.T) / 2).with_terms(
        el.Term("K", None, wave((turned + turned.T) / 2, 1, phase))
    )
    found = el.stability_edges(system, (6.5, 7.2))
    assert found.passed, found.checks
    at = region_of(found, "sum", 1)
    assert found.modes[at].tolist() == [2, 3]
    # Where the region begins: at those of the two modes, not at what stays on the circle.
    assert abs(found.multiplier[at] + 1.0) < 0.1
    assert contradictions(system, found, np.linspace(6.5, 7.2, 501)) == 0


def test_a_mode_of_negative_energy_makes_a_difference_region():
    """In turns the whirl w0/w - 1 is negative above w0; with an oscillator w3/w it sums to 1."""
    pull, stiff = 0.05, np.diag([2.0, 2.0, 16.0])
    cross = np.zeros((3, 3))
    cross[0, 2] = cross[2, 0] = pull
    gyro, whirl = np.zeros((3, 3)), np.diag([1.0, 1.0, 0.0])
    gyro[0, 1], gyro[1, 0] = -1.0, 1.0
    system = system_of(M=np.eye(3), A=gyro, B=whirl, K=stiff, Kg=wave(cross))
    found = el.stability_edges(system, (2.6, 2.8))
    assert found.passed, found.checks
    at = region_of(found, "difference", 1)
    assert 0.5 * (found.lower[at] + found.upper[at]) == pytest.approx(
        (np.sqrt(2) + 4) / 2, rel=1e-3
    )
    inside = el.floquet_multipliers(system, 0.5 * (found.lower[at] + found.upper[at]))
    assert not inside.stable
    assert abs(inside.multipliers[0].imag) > 0.1
    assert found.width[at] > 1e-3


def test_boundaries_without_modes_are_paired():
    """The averaged whirl diverges between its two natural frequencies, 1.41 and 1.52 rad/s."""
    split = el.Term("K", None, np.diag([0.3, 0.0]))
    found = el.stability_edges(_whirl(0.0).with_terms(split), (1.3, 1.7))
    at = int(np.argmin(found.modes[:, 0]))
    assert found.modes[at].tolist() == [0, 0]
    assert found.lower[at] == pytest.approx(np.sqrt(2.0), rel=1e-12)
    assert found.upper[at] == pytest.approx(np.sqrt(2.3), rel=1e-12)
