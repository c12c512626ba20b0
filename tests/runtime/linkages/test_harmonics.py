"""Harmonics by FFT: closed forms, aliasing, and dishonest functions."""

import numpy as np
import pytest
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.linkages.harmonic_analysis import harmonics
from refusals import refused

CRANK_ROCKER = FourBar(2.0, 1.0, 2.0, 2.0)
DRAG_LINK = FourBar(2.0, 4.0, 4.5, 3.9)


def test_secular_part_of_a_drag_link():
    found = harmonics((DRAG_LINK, "theta4"), order=20)
    m = np.arange(1, 21)
    assert found.secular == 1.0
    # Seen from the crank, frame and crank change places.
    assert found.b[1:] == pytest.approx(0.5**m / m, abs=float(found.error))
    theta = np.linspace(-9.0, 9.0, 101)
    gap = found(theta) - DRAG_LINK.motion(theta).theta4
    assert np.max(np.abs(gap)) <= found.remainder


@pytest.mark.parametrize("harmonic", [64, 1024, 4096])
def test_aliases(harmonic):
    found = harmonics(lambda t: 0.5 + np.sin(harmonic * t + 0.2), order=3)
    assert found.a == pytest.approx([0.5, 0, 0, 0], abs=float(found.error))
    assert float(found.error) < 1e-10


def test_a_narrow_peak():
    width = 0.005
    found = harmonics(lambda t: np.exp(-(((t % (2 * np.pi)) - 3.0) ** 2) / width**2), order=4)
    mean = width / (2 * np.sqrt(np.pi))
    assert abs(found.a[0] - mean) <= float(found.error)


@pytest.mark.parametrize(
    ("f", "a1", "b1"),
    [
        (lambda t: np.abs(np.sin(t - 0.3)), 0.0, 0.0),
        (lambda t: np.sign(np.sin(t - 0.3)), -4 * np.sin(0.3) / np.pi, 4 * np.cos(0.3) / np.pi),
    ],
)
def test_kinks_and_jumps_are_told(f, a1, b1):
    found = harmonics(f, order=6)
    assert not found.passed
    with pytest.raises(Exception, match="change on doubling"):
        found.require()
    for value, truth in ((found.a[1], a1), (found.b[1], b1)):
        assert abs(value - truth) <= float(found.error)
    # An accuracy that is in reach passes.
    assert harmonics(f, order=6, accuracy=1e-3).passed


def test_noise_is_told():
    def noisy(theta):
        # The same noise for the same number of angles.
        noise = np.random.default_rng(theta.size).normal(size=theta.shape)
        return np.cos(theta - 0.1) + 1e-7 * noise

    found = harmonics(noisy, order=6)
    assert not found.passed
    assert abs(found.a[1] - np.cos(0.1)) <= float(found.error) < 1e-6


def test_amplitude_phase_and_series():
    found = harmonics(lambda t: 2.0 + 3.0 * np.cos(2 * t - 0.4), order=3)
    assert found.amplitude == pytest.approx([2, 0, 3, 0], abs=1e-14)
    assert found.phase[2] == pytest.approx(0.4, abs=1e-14)
    assert found.series(np.array([0.2])) == pytest.approx([5.0], abs=1e-13)
    assert found.series.error == found.remainder
    assert found.to_dict()["amplitude"][2] == pytest.approx(3.0)
    assert len(found.plot().patches) == 6


test_refusals = refused(
    lambda source, options: harmonics(source, **options),
    [
        (3.0, {}, "source"),
        ((CRANK_ROCKER, "theta9"), {}, "theta9"),
        ((FourBar(2.0, 1.7, 1.0, 1.5), "theta4"), {}, "crank"),
        (np.sin, {"order": 0}, "order"),
        (np.sin, {"accuracy": 0.0}, "accuracy"),
        (lambda t: 0.3 * t, {}, "change of"),
        (lambda t: np.where(t > 3, np.nan, 1.0), {}, "not finite"),
        (lambda t: np.zeros(3), {}, "shape"),
    ],
)


@pytest.mark.parametrize("half", [5e-3, 5e-5])
@pytest.mark.parametrize("place", [1.0, 2.1275])
def test_a_pulse_between_samples_stays_within_its_error(half, place):
    found = harmonics(lambda t: (np.abs(np.mod(t, 2 * np.pi) - place) < half) * 1.0)
    m = np.arange(1, 9)
    size = np.append(half / np.pi, 2 * np.sin(m * half) / (m * np.pi))
    m = np.arange(9)
    gaps = np.abs([found.a - size * np.cos(m * place), found.b - size * np.sin(m * place)])
    assert np.max(gaps) <= float(found.error) < 1e-3


def test_a_constant_admits_what_its_samples_could_miss():
    # 131072 angles: a pulse as high as the function, between two of them.
    assert float(harmonics(lambda t: 3.0).error) >= 2 * 3.0 / 131072
    assert 0.0 < float(harmonics(np.zeros_like).error) < 1e-4
