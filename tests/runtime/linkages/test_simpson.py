"""Smith's procedure of appendix 3: what it finds, where it stops too early, what it costs."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.linkages.harmonic_analysis import harmonics
from elastolink.runtime.linkages.simpson import simpson_harmonics

CRANK_ROCKER = FourBar(2.0, 1.0, 2.0, 2.0)


@pytest.mark.parametrize("stop", ["printed", "every"])
def test_finds_the_follower_of_a_crank_rocker(stop):
    found = simpson_harmonics((CRANK_ROCKER, "theta4"), order=6, stop=stop)
    m = np.arange(1, 7)
    assert found.passed
    assert found.b[1:] == pytest.approx(-(0.5**m) / m, abs=1e-6)


def test_the_printed_rule_listens_to_the_mean_alone():
    early = simpson_harmonics(lambda t: np.cos(3 * t), order=5)
    assert early.evaluations == 9
    assert early.a == pytest.approx([0, -1 / 3, 0, 1, 0, 1], abs=1e-12)
    assert not early.passed
    assert float(early.error) == pytest.approx(1.0, abs=1e-12)
    whole = simpson_harmonics(lambda t: np.cos(3 * t), order=5, stop="every")
    assert whole.passed
    assert whole.a == pytest.approx([0, 0, 0, 1, 0, 0], abs=1e-6)


@pytest.mark.parametrize("stop", ["printed", "every"])
@pytest.mark.parametrize("f", [np.sin, lambda t: np.sin(t) + 0.3 * np.sin(4 * t)])
def test_a_sine_series_stops_at_once(f, stop):
    found = simpson_harmonics(f, order=4, stop=stop)
    assert found.evaluations == 3
    assert np.max(np.abs(found.b)) < 1e-14
    assert not found.passed
    assert float(found.error) == pytest.approx(1.0, abs=1e-12)


def test_two_sums_that_agree_stop_it_too():
    # Zero at 0, pi/2, pi ... and, at 8 intervals, as large above as below: a sum of zero again.
    found = simpson_harmonics(lambda t: np.sin(2 * t) ** 2 * np.cos(2 * t), order=6, stop="every")
    exact = harmonics(lambda t: np.sin(2 * t) ** 2 * np.cos(2 * t), order=6)
    assert found.evaluations == 3
    assert float(found.error) == pytest.approx(np.max(np.abs(exact.a)), abs=1e-12)
    assert not found.passed


def test_cost_against_the_fft():
    # To 1e-12 the procedure needs more angles, for Simpson's rule is the poorer of its two sums.
    def f(t):
        return 1.0 / (1.2 - np.cos(t))

    slow = simpson_harmonics(f, order=4, accuracy=1e-11, stop="every")
    exact = 2 / np.sqrt(1.2**2 - 1) * (1.2 - np.sqrt(1.2**2 - 1)) ** np.arange(5)
    exact[0] /= 2
    assert slow.a == pytest.approx(exact, abs=1e-11)
    trapezoid = np.fft.rfft(f(2 * np.pi * np.arange(64) / 64)).real / 32
    simpson = simpson_harmonics(f, order=4, accuracy=0.02, stop="every")
    assert simpson.evaluations == 65
    # With the same 64 intervals.
    assert np.max(np.abs(trapezoid[1:5] - exact[1:])) < 1e-3 * np.max(np.abs(simpson.a - exact))


def test_what_never_settles_ends():
    found = simpson_harmonics(
        lambda t: np.sign(np.sin(t - 0.3)), order=2, accuracy=1e-9, stop="every"
    )
    assert found.evaluations == 2**17 + 1
    assert not found.checks["intervals"].passed


@pytest.mark.parametrize(
    ("options", "word"), [({"stop": "never"}, "stop"), ({"order": 0}, "order")]
)
def test_refusals(options, word):
    with pytest.raises(BadInput, match=word):
        simpson_harmonics(np.sin, **options)
