"""Speeds marked by multipliers, by Meissner's functions and by mean frequencies."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.frequencies.marked_speeds import (
    mean_frequency_speeds,
    meissner_speeds,
    multiplier_maxima,
)

ANGLES = 2.0 * np.pi * np.arange(360) / 360
SPAN = (0.9, 3.2)


def varying(drag=0.0):
    """Return one freedom whose frequency is 10 + 0.8 cos theta [rad/s]."""

    def stiffness(theta):
        return ((10.0 + 0.8 * np.cos(theta)) ** 2)[:, None, None]

    terms = (
        Term("M", None, np.eye(1)),
        Term("K", None, stiffness),
        Term("C", None, np.array([[drag]])),
    )
    return LinearPeriodic(1, terms, {}, lambda values: {})


def test_maxima_of_a_constant_system_are_the_whole_divisions():
    system = LinearPeriodic(
        1,
        (Term("M", None, np.eye(1)), Term("K", None, np.array([[100.0]]))),
        {},
        lambda values: {},
    )
    found = multiplier_maxima(system, SPAN)
    expected = 10.0 / np.arange(4, 12)
    np.testing.assert_allclose(np.sort(found.speed)[::-1], expected, rtol=1e-6)
    assert np.all(np.abs(np.sort(found.speed)[::-1] - expected) <= np.sort(found.error)[::-1])
    np.testing.assert_allclose(found.value, 1.0, atol=1e-9)
    assert sorted(found.order.tolist()) == list(range(4, 12))
    assert found.labels[0].startswith("mode 1, n = ")


def test_the_three_ways_agree_for_a_frequency_that_varies_little():
    frequency = (10.0 + 0.8 * np.cos(ANGLES))[:, None]
    exact = multiplier_maxima(varying(0.05), SPAN)
    steps = meissner_speeds(frequency, SPAN)
    means = mean_frequency_speeds(frequency, SPAN)
    assert len(exact.speed) == len(steps.speed) == len(means.speed) == 8
    for found in (steps, means):
        gap = np.abs(np.sort(found.speed) - np.sort(exact.speed))
        assert np.max(gap / np.sort(exact.speed)) < 0.01
    assert np.all(np.abs(np.sort(means.speed) - np.sort(exact.speed)) <= np.sort(means.error))


def test_few_intervals_say_how_far_they_are_off():
    frequency = (10.0 + 0.8 * np.cos(ANGLES))[:, None]
    fine = meissner_speeds(frequency, SPAN)
    rough = meissner_speeds(frequency, SPAN, 4)
    nearest = np.min(np.abs(rough.speed[:, None] - fine.speed), axis=1)
    assert np.all(nearest <= rough.error * (1.0 + 1e-9))
    assert np.max(fine.error) < np.max(rough.error)


def test_mean_frequencies_alone_give_speeds_without_a_figure():
    found = mean_frequency_speeds([10.0, 31.0], (2.0, 16.0), most=3)
    assert found.labels[:3] == ("mode 1, n = 1", "mode 1, n = 2", "mode 1, n = 3")
    np.testing.assert_allclose(found.speed, [10.0, 5.0, 10.0 / 3.0, 15.5, 31.0 / 3.0])
    assert np.all(np.isinf(found.error))


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: multiplier_maxima(varying(), (2.0, 1.0)), "speed_range"),
        (lambda: multiplier_maxima(varying(), (1e-4, 1.0)), "speed_range"),
        (lambda: multiplier_maxima(varying(), (1.0, 2.0), 2), "count"),
        (lambda: meissner_speeds([[1.0], [-1.0]], (1.0, 2.0)), "frequencies"),
        (lambda: meissner_speeds([[1.0], [1.0]], (1.0, 2.0), 3), "intervals"),
        (lambda: mean_frequency_speeds([1.0], (1.0, 2.0), 0), "most"),
        (lambda: mean_frequency_speeds([0.0], (1.0, 2.0)), "frequencies"),
    ],
)
def test_unusable_arguments_are_told(call, word):
    with pytest.raises(BadInput, match=word):
        call()
