"""Smith appendix 3: the procedure FOUSIM for Fourier coefficients."""

import numpy as np
import pytest
from scipy.integrate import quad
from seed_ledger import establishes
from seed_listings import fousim
from seed_truth import TURN


def wave(z):
    """A function with every harmonic, neither even nor odd, of mean value 0.7 at least."""
    return 0.7 + np.cos(z) / (1.5 - np.sin(z)) + 0.2 * np.sin(2 * z)


def by_quadrature(f, m):
    """Return the mean for m = 0, else the cosine and sine coefficient, by adaptive quadrature."""
    scale = TURN if m == 0 else np.pi
    a = quad(lambda z: f(z) * np.cos(m * z), 0, TURN, epsabs=1e-13, limit=400)[0] / scale
    b = quad(lambda z: f(z) * np.sin(m * z), 0, TURN, epsabs=1e-13, limit=400)[0] / scale
    return a, b


@establishes(
    "Smith",
    "Appendix 3 heading",
    printed=r"f(z) = \frac{a_0}{2} + \sum_{m=1}^M(a_m\cos mz + b_m\sin mz)",
    verdict="slip",
    derived=r"f(z) = a_0 + \sum_{m=1}^M(a_m\cos mz + b_m\sin mz)",
    remark="Its last statement halves a[0], so that a[0] is the mean, as (7.20) needs. Read by the "
    "heading, a constant 0.7 would come back as 0.35.",
)
@establishes(
    "Smith",
    "Appendix 3 quadrature",
    printed=r"I = \tfrac h3\{I_0 + 4\textstyle\sum_{\text{odd}} + 2\sum_{\text{even}}\},\; "
    r"h \to \tfrac h2",
    verdict="agrees",
    derived=r"\text{Simpson's rule}",
    remark="Right to 3e-9, the digits of its pi, once it has not stopped too early.",
)
def test_coefficients():
    found = fousim(0.0, TURN, wave, 6, 1e-10, {"stop"})
    for m in range(7):
        a, b = by_quadrature(wave, m)
        assert found.a[m] == pytest.approx(a, abs=3e-9)
        assert found.b[m] == pytest.approx(b, abs=3e-9)
    constant = fousim(0.0, TURN, lambda z: 0.7, 2, 1e-10, {"stop"})
    assert constant.a[0] == pytest.approx(0.7, abs=1e-8)


@establishes(
    "Smith",
    "Appendix 3 stopping rule",
    printed=r"\text{for } m: \text{ if converged then goto } L3 \text{ else } p := p + 1;\; "
    r"L3: \text{ stop if } p = 0",
    verdict="slip",
    derived=r"\text{count every coefficient that has not converged; stop if none}",
    remark="The jump leaves at the first coefficient that has converged, so only m = 0 can stop "
    "it, and does alone. f = cos 3z stops at 8 intervals with a1 = -1/3 and a5 = 1 in place of "
    "zeros; with every coefficient tested it is right to 1e-8.",
)
def test_stopping_rule():
    early = fousim(0.0, TURN, lambda z: np.cos(3 * z), 5, 1e-6)
    assert early.intervals == 8
    assert early.a[[1, 3, 5]] == pytest.approx([-1 / 3, 1.0, 1.0], abs=1e-6)
    full = fousim(0.0, TURN, lambda z: np.cos(3 * z), 5, 1e-6, {"stop"})
    assert full.intervals == 64
    assert full.a == pytest.approx([0, 0, 0, 1, 0, 0], abs=1e-8)
    assert full.b == pytest.approx(np.zeros(6), abs=1e-8)


@pytest.mark.parametrize("repair", [set(), {"stop"}])
def test_a_series_that_vanishes_at_the_first_places_stops_at_once(repair):
    """It starts from zero and two intervals, and compares once: any sine series, and more."""
    for f in (np.sin, lambda z: np.sin(2 * z) ** 2 * np.cos(2 * z)):
        early = fousim(0.0, TURN, f, 6, 1e-6, repair)
        assert early.intervals == 2
        assert max(np.max(np.abs(early.a)), np.max(np.abs(early.b))) < 1e-12


@establishes(
    "Smith",
    "Appendix 3 interval",
    printed=r"f \text{ periodic in the range } x \le z \le y",
    verdict="slip",
    derived=r"y - x = 2\pi",
    remark="The sums are divided by pi and use cos mz whatever the range: over [0, pi] the "
    "function 0.7 + cos 2z gives a0 = 0.35 and a sine coefficient b1 = 0.23.",
)
def test_interval():
    half = fousim(0.0, np.pi, lambda z: 0.7 + np.cos(2 * z), 4, 1e-8, {"stop"})
    assert half.a[0] == pytest.approx(0.35, abs=1e-6)
    assert half.b[1] == pytest.approx(0.2334, abs=1e-4)
    moved = fousim(-1.0, TURN - 1.0, wave, 3, 1e-10, {"stop"})
    assert moved.a[1] == pytest.approx(by_quadrature(wave, 1)[0], abs=1e-8)


@establishes(
    "Smith",
    "Appendix 3 last lines",
    printed=r"\text{if } m > M \text{ then } a[m] := b[m] := 0",
    verdict="slip",
    derived=r"\text{nothing}",
    remark="After the loop m is undefined in Algol 60, M + 1 in practice: the statement would "
    "write one place beyond arrays of M + 1 elements. No coefficient depends on it.",
)
def test_statement_after_the_loop():
    count = 3
    found = fousim(0.0, TURN, wave, count, 1e-9, {"stop"})
    assert found.a.size == count + 1
    with pytest.raises(IndexError):
        found.a[count + 1] = 0.0
