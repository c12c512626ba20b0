"""Slow modes of stiff systems: multipliers, reduced systems and bands against the whole system."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.decoupled import characteristic_exponents, slow_system
from elastolink.runtime.stability import unstable_bands
from stiff_linkage import stiff_four_bar

FREQUENCIES = np.array([1.0, 2.3, 45.0, 160.0])


def stiff_chain(drag=0.0, swing=0.4, modulation=0.3):
    """Return oscillators whose modes swing to and fro between slow and stiff coordinates."""

    def turn(theta):
        angle = swing * np.sin(theta)
        out = np.broadcast_to(np.eye(4), (len(theta), 4, 4)).copy()
        for a, b, share in ((0, 2, 1.0), (1, 3, 0.6), (0, 1, 0.5)):
            part = np.broadcast_to(np.eye(4), (len(theta), 4, 4)).copy()
            c, s = np.cos(share * angle), np.sin(share * angle)
            part[:, a, a], part[:, a, b], part[:, b, a], part[:, b, b] = c, -s, s, c
            out = out @ part
        return out

    def stiffness(theta):
        r = turn(theta)
        levels = np.broadcast_to(FREQUENCIES**2, (len(theta), 4)).copy()
        levels[:, 0] *= 1.0 + modulation * np.cos(theta)
        levels[:, 1] *= 1.0 + 0.5 * modulation * np.sin(theta)
        return np.swapaxes(r, -1, -2) @ (levels[:, :, None] * r)

    terms = [Term("M", None, np.eye(4)), Term("K", None, stiffness)]
    if drag:
        terms.append(Term("C", None, lambda theta: drag * stiffness(theta)))
    return LinearPeriodic(4, tuple(terms), {}, lambda values: {})


def apart(slow, whole):
    """Return the distance of each multiplier to the nearest of the whole system."""
    return np.min(np.abs(slow.multipliers[..., :, None] - whole.multipliers[..., None, :]), axis=-1)


@pytest.mark.parametrize("drag", [0.0, 2e-3])
def test_slow_multipliers_are_those_of_the_whole_system(drag):
    system = stiff_chain(drag)
    speeds = np.array([0.31, 0.6, 0.97])
    slow = characteristic_exponents(system, speeds, 2)
    whole = floquet_multipliers(system, speeds, rtol=1e-13)
    assert np.all(slow.retained == 2)
    gap = apart(slow, whole)
    assert np.all(gap <= slow.error)
    assert np.all(gap <= 1e-9)
    assert slow.passed
    # Round-off moves them by 1e-13; the figure says no more than a thousand times that.
    assert np.median(slow.error) <= 1e-9


def test_undamped_multipliers_stay_on_the_circle():
    slow = characteristic_exponents(stiff_chain(), [0.31, 0.43, 0.6], 2)
    assert np.max(np.abs(np.abs(slow.multipliers) - 1.0)) <= 1e-12
    assert np.array_equal(np.sort(slow.signatures, axis=-1), np.tile([-1, -1, 1, 1], (3, 1)))
    assert np.all(slow.stable)
    np.testing.assert_allclose(slow.frequency[:, ::2], [[1.0, 2.3]] * 3, rtol=0.1)


def test_signatures_are_those_of_the_whole_system():
    system = stiff_chain()
    slow = characteristic_exponents(system, 0.43, 2)
    whole = floquet_multipliers(system, 0.43)
    nearest = np.argmin(np.abs(slow.multipliers[:, None] - whole.multipliers), axis=1)
    assert np.array_equal(slow.signatures, whole.signatures[nearest])


def test_all_modes_are_kept_where_no_gap_is_wide_enough():
    system = stiff_chain()
    slow = characteristic_exponents(system, 30.0, 2)
    assert slow.retained == 4
    assert np.all(apart(slow, floquet_multipliers(system, 30.0)) <= slow.error)


def test_the_reduced_system_has_the_multipliers_of_the_whole_one():
    system = stiff_chain()
    slow = slow_system(system, (0.3, 1.0), 2)
    assert slow.modes == slow.system.size == 2
    assert slow.error < 1e-7
    for speed in (0.3, 0.55, 1.0):
        found = floquet_multipliers(slow.system, speed)
        gap = apart(found, floquet_multipliers(system, speed))
        # Turns in a period: 2 pi 2.3 / 0.3 = 48 at the most.
        assert np.max(gap) <= 50 * slow.error + 1e-10
        assert np.max(np.abs(np.abs(found.multipliers) - 1.0)) <= 1e-10


def test_bands_of_the_slow_modes_are_those_of_the_whole_system():
    system = stiff_chain(modulation=0.5)
    bands = unstable_bands(system, (1.7, 2.2), 2)
    assert bands.checks["decoupled"].passed
    assert bands.checks["samples"].passed
    wide = np.flatnonzero(bands.width > 1e-3)
    assert [bands.labels[i] for i in wide] == ["region 1 of mode 1", "region 2 of mode 2"]
    ends = np.stack([bands.lower[wide], bands.upper[wide]])
    step = np.array([[1e-5], [-1e-5]])
    whole = floquet_multipliers(system, np.stack([ends + step, ends - step]))
    largest = np.max(np.abs(whole.multipliers), axis=-1)
    assert np.all(largest[0] > 1.0 + 1e-4)
    assert np.all(largest[1] < 1.0 + 1e-8)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda s: characteristic_exponents(s, 1.0, 5), "count"),
        (lambda s: characteristic_exponents(s, 1.0, 0), "count"),
        (lambda s: characteristic_exponents(s, 1.0, rtol=1.0), "rtol"),
        (lambda s: characteristic_exponents(s, -1.0), "speed"),
        (lambda s: slow_system(s, (0.3, 1.0), 4), "modes"),
        (lambda s: slow_system(s, (0.3, 400.0)), "speed"),
        (lambda s: slow_system(s, (1.0, 0.3)), "speed_range"),
        (lambda s: unstable_bands(s, (0.3, 1.0), rtol=1.0), "rtol"),
    ],
)
def test_unusable_arguments_are_told(call, word):
    with pytest.raises(BadInput, match=word):
        call(stiff_chain())


def test_bands_outside_the_range_of_a_reduced_system_are_refused():
    slow = slow_system(stiff_chain(), (0.5, 0.8), 2)
    with pytest.raises(BadInput, match="speed_range"):
        unstable_bands(slow, (0.4, 0.7))


def test_the_flexible_four_bar_has_its_slow_modes_on_the_circle():
    found = characteristic_exponents(stiff_four_bar(), [30.0, 62.0])
    assert np.all(found.retained <= 5)
    assert np.max(np.abs(np.abs(found.multipliers) - 1.0)) <= 1e-10
    assert found.passed


@pytest.mark.slow
def test_slow_modes_of_the_flexible_four_bar_against_all_of_them():
    system = stiff_four_bar()
    slow = characteristic_exponents(system, 120.0, rtol=1e-8)
    gap = apart(slow, floquet_multipliers(system, 120.0))
    assert np.all(gap <= slow.error)
    assert slow.retained < 9


@pytest.mark.slow
def test_slow_modes_of_three_elements_a_link():
    system = stiff_four_bar(3)
    found = characteristic_exponents(system, 10.0, 4)
    assert found.retained < 12
    assert np.max(np.abs(np.abs(found.multipliers) - 1.0)) <= 1e-10
    # Another cut between slow and fast leaves the same multipliers.
    more = characteristic_exponents(system, 10.0, 6)
    assert more.retained > found.retained
    assert np.all(apart(found, more) <= found.error + np.max(more.error))
