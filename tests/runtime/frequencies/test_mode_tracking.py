"""Modes followed over the crank angle: known crossings, known veerings, turns that permute."""

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.frequencies import natural_frequencies
from periodic_systems import system_of


def _system(stiffness, size=2) -> LinearPeriodic:
    """Return a system of unit mass with a stiffness over the crank angle."""
    return system_of(M=np.eye(size), K=stiffness)


def _matrix(a, b, c):
    """Return [[a, c], [c, b]] over the angle."""
    a, b, c = np.broadcast_arrays(a, b, c)
    return np.moveaxis(np.array([[a, c], [c, b]], dtype=float), (0, 1), (-2, -1))


def _diagonal(t, *squares):
    """Return a diagonal matrix over the angle."""
    columns = [np.broadcast_to(each, t.shape) for each in squares]
    return np.stack(columns, axis=-1)[:, :, None] * np.eye(len(squares))


def _oscillators(coupling=0.0):
    """Two oscillators, 10 + 3 cos theta and 10.5: they meet where cos theta = 1/6."""
    return _system(lambda t: _matrix(10.0 + 3.0 * np.cos(t), 10.5, coupling))


def test_uncoupled_oscillators_cross_and_keep_their_curves():
    found = natural_frequencies(_oscillators())
    angle = np.arccos(1.0 / 6.0)
    assert [one.kind for one in found.encounters] == ["crossing", "crossing"]
    np.testing.assert_allclose(
        [one.angle for one in found.encounters], [angle, 2 * np.pi - angle], atol=1e-11
    )
    for one in found.encounters:
        # d(sqrt(10 + 3 cos))/dtheta at the crossing, the other being constant.
        slope = 1.5 * np.sin(angle) / np.sqrt(10.5)
        assert one.slope == pytest.approx(slope, rel=1e-4)
        assert one.lower == 1 and one.coupling == 0.0 == one.width == one.trade
        assert one.gap <= one.gap_error < 1e-9
    # At the first angle the second curve is the oscillator that varies.
    np.testing.assert_allclose(found.tracked[:, 0], np.sqrt(10.5), rtol=1e-14)
    np.testing.assert_allclose(
        found.tracked[:, 1], np.sqrt(10.0 + 3.0 * np.cos(found.theta)), rtol=1e-14
    )
    assert np.all(np.diff(found.frequency, axis=1) >= 0.0)
    np.testing.assert_allclose(found.mac, 1.0, rtol=1e-12)
    assert list(found.closure) == [1, 2] and found.passed
    # The shapes do not mix, even at the crossing.
    found = natural_frequencies(_oscillators(), np.array([0.0, angle - 1e-9, angle, 1.0, 2.0]))
    np.testing.assert_allclose(np.abs(found.shape[:, [1, 0], [0, 1]]), 1.0, rtol=1e-9)


@pytest.mark.parametrize("coupling", [0.3, 1e-2, 1e-4, 1e-7])
def test_a_hand_solved_veering(coupling):
    found = natural_frequencies(_oscillators(coupling))
    # Squares m +- sqrt(d^2 + c^2), d = (3 cos theta - 0.5)/2: at d = 0 least, apart from m's slope.
    angle = np.arccos(1.0 / 6.0)
    low, high = np.sqrt(10.5 - coupling), np.sqrt(10.5 + coupling)
    assert [one.kind for one in found.encounters] == ["veering", "veering"]
    first = found.encounters[0]
    loose = 0.2 * coupling
    assert first.angle == pytest.approx(angle, abs=loose + 1e-7)
    assert first.gap == pytest.approx(high - low, rel=coupling)
    # The curves apart from the veering: slopes of the two uncoupled oscillators.
    slope = 1.5 * np.sin(angle) / np.sqrt(10.5)
    assert first.slope == pytest.approx(slope, rel=0.2 * coupling + 1e-3)
    # tan(2 alpha) = c/d: alpha' = -d'/(2 c) where d = 0.
    assert first.coupling == pytest.approx(1.5 * np.sin(angle) / (2 * coupling), rel=loose + 1e-6)
    assert first.trade == pytest.approx(1.0, rel=loose + 2e-3)
    np.testing.assert_array_equal(found.tracked, found.frequency)
    # The shapes trade: the first curve begins as one oscillator and is the other at 180 degrees.
    assert found.mac[180, 0] < 0.05 and found.mac[-1, 0] > 1 - 1e-12


def test_curvature_of_a_symmetric_veering():
    # Squares 16 +- sqrt(sin^2 + c^2): curvature of omega at 0 is +-(1/c)/(2 omega).
    c = 0.05
    found = natural_frequencies(_system(lambda t: _matrix(16 + np.sin(t), 16 - np.sin(t), c)))
    first = min(found.encounters, key=lambda one: min(one.angle, 2 * np.pi - one.angle))
    assert first.curvature == pytest.approx(1 / (2 * c * 4.0), rel=2e-2)
    assert first.width == pytest.approx(c, rel=1e-3)


def test_one_crossing_a_turn_permutes_the_curves():
    # [[1 + cos, sin], [sin, -1 - cos]]/2 has the eigenvalues +- cos(theta/2): they meet once.
    def stiffness(t):
        return _matrix(10 + (1 + np.cos(t)) / 2, 10 - (1 + np.cos(t)) / 2, np.sin(t) / 2)

    theta = np.linspace(0.0, 4 * np.pi, 81)
    found = natural_frequencies(_system(stiffness), theta)
    assert len(found.crossings) == 1
    assert found.crossings[0].angle == pytest.approx(np.pi, abs=1e-10)
    assert list(found.closure) == [2, 1] and list(found.sign) == [0.0, 0.0]
    np.testing.assert_allclose(found.tracked[:, 1], np.sqrt(10 + np.cos(theta / 2)), rtol=1e-13)
    np.testing.assert_allclose(found.tracked[:, 0], np.sqrt(10 - np.cos(theta / 2)), rtol=1e-13)
    # Over a turn each curve is both: means of cos(theta/2) over half its period.
    fine = (np.arange(4000) + 0.5) / 4000 * np.pi
    expected = np.sqrt(10 - np.abs(np.cos(fine)))
    assert found.mean[0] == pytest.approx(np.mean(expected), rel=1e-6)
    assert found.mean_error[0] < 1e-10
    np.testing.assert_allclose(found.branch_mean, np.mean(np.sqrt(10 + np.cos(fine))), rtol=1e-6)


def test_shapes_that_come_back_turned_over():
    def stiffness(t):
        return _matrix(10 + np.cos(t), 10 - np.cos(t), np.sin(t))

    found = natural_frequencies(_system(stiffness))
    assert not found.encounters and list(found.closure) == [1, 2]
    assert list(found.sign) == [-1.0, -1.0]
    steps = np.einsum("tik,tik->tk", found.shape[1:], found.shape[:-1])
    assert np.min(steps) > 0.99


def test_two_crossings_within_a_hair_of_each_other():
    # 10 + cos theta dips below 11 - 1.25e-7 but for 1e-3 about 0.
    def stiffness(t):
        return _matrix(10 + np.cos(t), 11 - 1.25e-7, 0.0)

    found = natural_frequencies(_system(stiffness))
    # cos t = 1 - x: t = +- sqrt(2 x) = +- 5e-4.
    angles = np.sort([(one.angle + np.pi) % (2 * np.pi) - np.pi for one in found.crossings])
    np.testing.assert_allclose(angles, [-5e-4, 5e-4], rtol=1e-5)
    assert np.all(found.mac > 1 - 1e-9)


def test_three_that_meet_at_one_angle():
    # 10 + k cos theta for k = -1, 0, 1: all meet at 90 and 270 degrees.
    def stiffness(t):
        return _diagonal(t, 10.0 - np.cos(t), 10.0, 10.0 + np.cos(t))

    found = natural_frequencies(_system(stiffness, 3))
    for k in range(3):
        np.testing.assert_allclose(
            found.tracked[:, k], np.sqrt(10 + (k - 1) * np.cos(found.theta)), rtol=1e-12
        )


def test_a_curve_that_leaves_the_ranks_asked_for():
    def stiffness(t):
        return _diagonal(t, 10 - 9 * np.cos(t), 6.0, 9.0, 12.0)

    found = natural_frequencies(_system(stiffness, 4), count=1)
    np.testing.assert_allclose(
        found.tracked[:, 0], np.sqrt(10 - 9 * np.cos(found.theta)), rtol=1e-13
    )
    assert set(found.branch[:, 0]) == {1, 2}
    assert found.branch_mean[0] > found.mean[0]


@pytest.mark.parametrize("cases", [1, pytest.param(8, marks=pytest.mark.slow)])
def test_random_diagonal_systems_are_followed_exactly(cases):
    rng = np.random.default_rng(5)
    for _ in range(cases):
        wave, phase = rng.uniform(0.5, 3.0, 4), rng.uniform(0, 2 * np.pi, 4)
        turn = np.linalg.qr(rng.normal(size=(4, 4)))[0]

        def stiffness(t, wave=wave, phase=phase, turn=turn):
            squares = 10.0 + wave * np.cos(np.outer(t, [1, 2, 1, 3]) - phase)
            return turn @ (squares[:, :, None] * turn.T)

        theta = np.linspace(0.3, 0.3 + 2 * np.pi, 50)
        found = natural_frequencies(_system(stiffness, 4), theta)
        expected = np.sqrt(10.0 + wave * np.cos(np.outer(theta, [1, 2, 1, 3]) - phase))
        order = np.argsort(expected[0])
        np.testing.assert_allclose(found.tracked, expected[:, order], rtol=1e-11)
        assert not found.veerings
