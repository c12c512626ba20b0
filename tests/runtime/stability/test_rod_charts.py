"""Stability charts over crank speed and crank ratio, and what their verdicts rest on."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import flexible_rod as rod
from elastolink.runtime.core.families import Term
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.stability.chart_lines import is_mirrored
from elastolink.runtime.stability.invariants import from_sum, largest_modulus, surely_stable
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis

SPEEDS = np.linspace(500.0, 4000.0, 160)
RATIOS = np.linspace(0.01, 0.2, 60)


@pytest.fixture(scope="module", params=["polynomial", "overhang"])
def case(request):
    system = rod(PolynomialBasis(3) if request.param == "polynomial" else OverhangBasis(3))
    chart = el.stability_chart(system, ("speed", SPEEDS), ("crank_ratio", RATIOS))
    return system, chart


def test_points_agree_with_multipliers(case):
    """Growth to 1e-8 at points taken anywhere, each from a rod made for its own crank."""
    system, chart = case
    rng = np.random.default_rng(1992)
    grown = 0
    for _ in range(25):
        i, j = rng.integers(len(RATIOS)), rng.integers(len(SPEEDS))
        direct = el.floquet_multipliers(
            system.with_geometry(crank_ratio=RATIOS[i]), SPEEDS[j], rtol=1e-12
        )
        modulus = np.max(np.abs(direct.multipliers))
        assert bool(direct.stable) == chart.stable[i, j]
        if not chart.stable[i, j]:
            assert abs(chart.largest[i, j] - modulus) <= 1e-8
            grown += 1
    assert grown >= 2
    assert chart.passed
    assert chart.error < 1e-9


def test_hardly_a_point_is_undecided(case):
    """Everywhere else the verdict is proved, so that the slack is zero where stable."""
    _, chart = case
    assert np.mean(chart.undecided) < 1e-3
    assert np.all(chart.slack[chart.stable & ~chart.undecided] == 0.0)
    assert np.all(chart.largest[chart.stable & ~chart.undecided] == 1.0)
    # The geometry changes the frequency.
    assert np.isnan(chart.natural_frequency)


def test_axes_may_change_places():
    system = rod(PolynomialBasis(2))
    speeds, ratios = ("speed", SPEEDS[::16]), ("crank_ratio", RATIOS[::12])
    one = el.stability_chart(system, speeds, ratios)
    other = el.stability_chart(system, ratios, speeds)
    assert np.allclose(one.invariants, np.swapaxes(other.invariants, 0, 1), atol=1e-11)
    assert np.array_equal(one.stable, other.stable.T)


def test_two_axes_of_geometry():
    """A rod soft enough to be no faster than its crank, which turns at 1 rad/s."""
    system = rod(PolynomialBasis(1)).with_parameters(bending_stiffness=0.05)
    frames = np.array([0.55, 0.6, 0.65])
    chart = el.stability_chart(system, ("crank_ratio", RATIOS[::20]), ("frame", frames), speed=1.0)
    assert chart.nodes == (0, 0)
    for i, frame in enumerate(frames):
        for j, ratio in enumerate(RATIOS[::20]):
            direct = el.monodromy(system, 1.0, frame=frame, crank_ratio=ratio)
            assert chart.invariants[i, j, 0] == pytest.approx(-np.trace(direct.matrix), abs=1e-11)
    assert np.isnan(chart.natural_frequency)


@pytest.mark.parametrize("modes", [1, 2, 3, 4])
def test_signs_prove_only_what_is_true(modes):
    """Random roots about the ends: the roots themselves tell."""
    rng = np.random.default_rng(modes)
    z = rng.uniform(-2.1, 2.1, (4000, modes))
    polynomial = np.array([np.poly(row)[1:] for row in z])
    sure = surely_stable(polynomial, np.full(len(z), 1e-12))
    inside = np.all(np.abs(z) < 2.0, axis=1)
    assert not np.any(sure & ~inside)
    # Undecided is what lies within the error of a double root or an end.
    assert np.mean(inside & ~sure) < 2e-3


def test_complex_sums_are_never_proved_stable():
    rng = np.random.default_rng(5)
    for modes in (2, 3, 4):
        z = rng.uniform(-1.9, 1.9, (500, modes)).astype(complex)
        away = rng.uniform(1e-4, 1.0, 500)
        z[:, 1] = np.conj(z[:, 0] + 1j * away)
        z[:, 0] = np.conj(z[:, 1])
        polynomial = np.array([np.poly(row)[1:].real for row in z])
        assert not np.any(surely_stable(polynomial, np.full(500, 1e-13)))


def test_signs_of_five_modes_want_places():
    with pytest.raises(ValueError, match="places"):
        surely_stable(np.zeros((3, 5)), np.zeros(3))
    z = np.array([-1.5, -0.7, 0.1, 0.9, 1.8])
    largest, stable, slack = largest_modulus(from_sum(np.poly(z)[1:]), reduced=True, error=1e-12)
    assert stable
    assert largest == 1.0
    assert slack == 0.0


def test_damping_is_never_taken_for_a_mirror_image():
    """A moving wave of stiffness has no mirrored half either."""
    plain, wavy = rod(PolynomialBasis(3)), lambda t: np.sin(t)[:, None, None] * np.eye(3)
    assert is_mirrored(equation_of(plain, 500.0))
    for other in (rod(PolynomialBasis(3), damping=20.0), plain.with_terms(Term("Kg", None, wavy))):
        assert not is_mirrored(equation_of(other, 500.0))
