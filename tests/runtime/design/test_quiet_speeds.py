"""Quiet speeds, damping, lengths, fatigue: hand cases, and the document's machine."""

from contextlib import nullcontext
from functools import cache

import elastolink as el
import numpy as np
import pytest
from beam_motions import of_history
from elastolink import BadInput, load_scene
from elastolink.runtime.design import procedure
from elastolink.runtime.design.quiet import _bands, _maxima
from refusals import refused

TABLE = "aannaque_1996_table_4_1"
STEEL = el.Material(tensile_strength=600e6, endurance_limit=200e6, exponent=9.0, knee=1e6)
PI = np.pi
UNSTABLE = ((3.0, 3.5), (4.0, 4.5), (6.0, 7.0), (9.9, 10.0))
WAVE = np.cos(2 * np.pi * np.arange(64) / 64)


@cache
def system():
    return load_scene(TABLE, overrides={"mesh.elements": 1}).system()


@pytest.mark.parametrize(
    ("unstable", "ends", "best", "above"),
    [
        ((), [(PI, 2 * PI), (3 * PI, 10.0)], [1.5 * PI, 10.0], [0.5 * PI, 2.5 * PI]),
        (
            UNSTABLE,
            [(3.5, 4.0), (4.5, 6.0), (3 * PI, 9.9)],
            [4.0, 1.5 * PI, 9.9],
            [3.5, 4.5, 3 * PI],
        ),
    ],
)
def test_bands_end_where_the_limit_is_met_or_it_is_unstable(unstable, ends, best, above):
    speed = np.linspace(0.5, 10.0, 1901)
    worst = np.exp(np.sin(speed))
    limiting = np.array([w for w, height in _maxima(speed, worst) if height > 1])
    bands = _bands(speed, worst, np.array([]) if unstable else limiting, unstable)
    assert [(band.low, band.high) for band in bands] == [pytest.approx(e, abs=1e-5) for e in ends]
    assert [band.best for band in bands] == pytest.approx(best, abs=5e-3)
    assert [band.above for band in bands] == pytest.approx(above, abs=1e-4)


def test_an_unstable_speed_is_never_quiet():
    """With limits that nothing meets; unstable from 86.92 to 95.64 rad/s by the multipliers."""
    found = el.quiet_speeds(system(), np.linspace(84.0, 98.0, 57), 1e15, rtol=1e-2)
    assert found.unstable == ((86.75, 95.75),)
    assert [(band.low, band.high) for band in found.bands] == [(84.0, 86.75), (95.75, 98.0)]
    assert found.quiet == found.bands[1:] and found.quiet[0].above == 95.75
    assert "unstable" in [text.get_text() for text in found.plot().get_legend().get_texts()]


def test_a_range_within_the_limits_is_one_band():
    found = el.quiet_speeds(system(), np.linspace(15.0, 20.0, 12), 1e12)
    assert len(found.bands) == 1 and found.bands[0].above is None
    assert not found.limiting.size and not found.quiet


def asked(call, given):
    given = {"system": system(), "speeds": (5.0, 20.0), "limit": 1e8, **given}
    first = [given.pop(name) for name in ("system", "speeds", "limit")]
    return call(*first, **given)


NOWHERE = {"speeds": np.linspace(40.0, 45.0, 8), "limit": 1e6, "rtol": 1e-2}
test_what_cannot_be_quiet_is_refused = refused(
    asked,
    [
        (el.quiet_speeds, {"limit": {"crank": -1.0}}, "limits of crank"),
        (el.quiet_speeds, {"limit": {"rod": 1e8}}, "limits: found rod"),
        (el.quiet_speeds, {"speeds": ("a", 20.0)}, "speeds"),
        (el.quiet_speeds, {"speeds": [5.0, 4.0, 3.0]}, "increasing crank speeds"),
        (el.quiet_speeds, {"system": None}, "without beams"),
        # Refused before the work, and after it.
        (el.running_speed, {"length": "crankk"}, "length"),
        (el.running_speed, {"values": []}, "values"),
        (el.running_speed, NOWHERE, "beyond their limits everywhere"),
    ],
)


def test_damping_helps_at_a_critical_speed_and_hurts_a_link_at_a_quiet_one():
    # Aannaque 7.4.2; the machine of Table 4.1 with one element: critical at 61.4, quiet at 41.
    little, much = (
        el.stress_curve(system().with_parameters(damping_ratio=ratio), [41.0, 61.4])
        for ratio in (0.02, 0.06)
    )
    change = much.maximum / little.maximum
    assert np.all(change[1] < 0.8)
    assert np.any(change[0] > 1.0 + little.error[0] + much.error[0])


def test_a_longer_frame_lowers_the_stresses_up_to_a_length():
    # Aannaque 7.3 and 8.5.1: lower with L4 up to about 0.66 m, then higher again.
    frames = [system().with_geometry(frame=length) for length in (0.547, 0.632, 0.667)]
    worst = [np.max(el.stress_curve(one, [30.0]).maximum) for one in frames]
    assert worst[1] < 0.7 * worst[0] and worst[2] > worst[1]
    angles = el.transmission_angle(el.FourBar(**frames[2].geometry))
    assert angles.greatest > np.radians(150)


@pytest.mark.slow
def test_the_design_method_finds_a_quiet_speed_and_a_way_up(monkeypatch):
    ticks = []
    monkeypatch.setattr(procedure, "bar", lambda wanted, total: nullcontext(ticks.append))
    found = el.running_speed(
        system(), np.linspace(28.0, 36.0, 120), 200e6, values=[0.547, 0.632], rtol=5e-3
    )
    # Five damping ratios, then lengths up to the first that does.
    assert ticks == list(range(1, len(ticks) + 1)) and 5 < len(ticks) <= 7
    assert found.band.above is not None and found.band.ratio < 1.0
    assert found.quiet.limiting.size and np.min(found.quiet.limiting) < found.speed
    assert found.run_up_length == 0.632
    assert found.passed and 0.0 < found.checks["stable"].value < 1.0
    ratio = found.checks["within limits"].value
    assert found.band.ratio < ratio < found.band.ratio * 1.01


def test_one_harmonic_is_one_cycle_on_goodmans_line():
    found = el.fatigue(of_history(100e6 + 250e6 * WAVE), STEEL)
    amplitude = 250e6 / (1 - 100.0 / 600.0)
    np.testing.assert_allclose(found.amplitude, amplitude, rtol=1e-12)
    np.testing.assert_allclose(found.safety, 200e6 / amplitude, rtol=1e-12)
    np.testing.assert_allclose(found.damage, (amplitude / 200e6) ** 9 / 1e6, rtol=1e-12)
    np.testing.assert_allclose(found.revolutions, 1e6 / (amplitude / 200e6) ** 9, rtol=1e-12)
    np.testing.assert_allclose(found.hours, found.revolutions * 2 * np.pi / 10 / 3600, rtol=1e-12)


def test_the_error_of_the_safety_covers_that_of_amplitude_and_mean():
    mean, size, off = 500e6, 20e6, 2e6
    found = el.fatigue(of_history(mean + size * WAVE, error=off), STEEL)
    worse = el.fatigue(of_history(mean + off + (size + off) * WAVE), STEEL)
    actual = np.max(worse.amplitude) / np.max(found.amplitude) - 1.0
    # With what may lie between 512 angles: (2 pi/512)^4 * 3/128 of the size, 5e-9 of the error.
    assert actual < found.error < actual * (1.0 + 1e-8)
    with pytest.raises(BadInput, match="not finite"):
        el.fatigue(of_history(np.full(64, np.nan)), STEEL)
    with pytest.raises(BadInput, match="StressResult"):
        el.fatigue(None, STEEL)
    with pytest.raises(BadInput, match="positive number"):
        el.Material(tensile_strength=-1.0, endurance_limit=1.0)
    with pytest.raises(BadInput, match="less than tensile_strength"):
        el.Material(tensile_strength=1.0, endurance_limit=2.0)


def test_compression_counts_as_no_mean_and_a_cycle_to_the_strength_is_no_life():
    found = el.fatigue(of_history(-300e6 + 150e6 * WAVE), STEEL)
    np.testing.assert_allclose(found.amplitude, 150e6, rtol=1e-12)
    assert np.all(found.damage == 0) and found.revolutions == np.inf
    found = el.fatigue(of_history(650e6 + 10e6 * WAVE), STEEL)
    assert np.all(found.safety == 0) and found.revolutions == 0.0
