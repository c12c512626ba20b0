"""Smith appendix 2: the kinematics programme FORBAR 2, run against searched loop closure."""

import numpy as np
import pytest
from seed_ledger import establishes
from seed_listings import forbar2
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, closure, motion


def scaled(lengths):
    """Return crank, coupler and follower for a frame of unit length, as the programme wants."""
    return [length / lengths[0] for length in lengths[1:]]


def deviations(lengths):
    """Return largest errors of omega3, alpha3, omega4, alpha4, theta3 [deg] and theta4 [deg]."""
    m = motion(lengths, count=720)
    worst = np.zeros(6)
    for th2, d3, m3, omega3, alpha3, d4, m4, omega4, alpha4 in forbar2(*scaled(lengths)):
        i = 2 * (th2 % 360)
        errors = (
            omega3 - m.omega3[i],
            alpha3 - m.alpha3[i],
            omega4 - m.omega4[i],
            alpha4 - m.alpha4[i],
            d3 + m3 / 60 - np.degrees(m.theta3[i]),
            d4 + m4 / 60 - np.degrees(m.theta4[i]),
        )
        worst = np.maximum(worst, np.abs(errors))
    return worst


@establishes(
    "Smith",
    "Appendix 2 formulas",
    printed=r"\text{csth4} = d \pm \sqrt{d^2 - e},\; \text{csth3},\; \omega_3, \omega_4, \alpha_3, "
    r"\alpha_4 \text{ from sines and cosines}",
    verdict="agrees",
    derived=r"\text{(2.2) with } D^2 = A^2 + C^2, + \text{ for } \theta_2 < \pi;\; (2.7);\; (2.10)",
    remark="Every sign right for the open assembly of a crank-rocker: speeds and accelerations to "
    "3e-7 (his pi/18 has nine digits), angles to half a minute of arc.",
)
@establishes(
    "Smith",
    "Appendix 2 quadrants",
    printed=r"\text{snth3} = +\sqrt{1 - \text{csth3}^2},\; \text{snth4} = +\sqrt{1 - "
    r"\text{csth4}^2},\; \theta = \arctan(\sin/\cos),\; +180 \text{ if negative}",
    verdict="agrees",
    derived=r"\sin\theta_3, \sin\theta_4 > 0 \text{ (2.2.1 quadrants)}",
    remark="For crank-rockers only, which is what 2.5 offers it for. For the drag link (2,4,5,4.5) "
    "it returns an omega4 that is off by up to 8.3; the arc tangent fails where a cosine is "
    "zero.",
)
def test_formulas():
    for lengths in (*CRANK_ROCKERS.values(), LONG_CRANK):
        worst = deviations(lengths)
        assert worst[:4].max() < 3.1e-7
        assert worst[4:].max() < 0.5 / 60 + 1e-4
    assert deviations(DRAG_LINK)[2] == pytest.approx(8.3, abs=0.1)


@establishes(
    "Smith",
    "Appendix 2 near sin(theta2) = 0",
    printed=r"c = 0 \text{ if } \lvert\sin\theta_2\rvert < 10^{-3}",
    verdict="approximation",
    derived=r"c = 2\ell_2\ell_4\sin\theta_2",
    remark="Needless, since d^2 - e only rounds below zero there; off its own grid of 10 deg it "
    "costs up to 2e-4 in cos(theta4) of (5,1,5,2). On the grid it changes nothing.",
)
def test_near_dead_centres():
    lengths = CRANK_ROCKERS["5,1,5,2"]
    l1, l2, l3, l4 = lengths
    theta2 = 9e-4
    _, theta4 = closure(lengths, theta2)
    A = 2 * l4 * (l2 * np.cos(theta2) - l1)
    B = l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * np.cos(theta2)
    assert abs(-B / A - np.cos(theta4[0])) == pytest.approx(2.1e-4, abs=1e-5)
    kept = np.array(forbar2(*scaled(lengths), steps=36, repair={"sine"})[1:18])
    assert np.abs(kept - np.array(forbar2(*scaled(lengths), steps=36)[1:18])).max() == 0
    # At theta2 = 0 and pi of the grid the sine is below 4e-9, and so is what is dropped.
    m = motion(lengths, count=720)
    rows = forbar2(*scaled(lengths))
    assert rows[18][7] == pytest.approx(m.omega4[360], abs=1e-8)


@establishes(
    "Smith",
    "Appendix 2 degrees and minutes",
    printed=r"y := (\theta - \operatorname{entier}\theta)\cdot 60 \text{ into an integer}",
    verdict="slip",
    derived=r"\text{round to minutes first, then carry}",
    remark="Assignment to an integer rounds, so that 60 minutes get printed: (5,1,5,2) at 120 deg.",
)
def test_sixty_minutes():
    rows = forbar2(*scaled(CRANK_ROCKERS["5,1,5,2"]))
    assert [row[0] for row in rows if 60 in (row[2], row[6])] == [120]
