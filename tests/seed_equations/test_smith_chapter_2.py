"""Smith chapter 2: position, velocity and acceleration of the four-bar linkage."""

import numpy as np
import pytest
import sympy as sp
from seed_derivations import (
    ANGLES,
    LENGTHS,
    SPEEDS,
    alpha2,
    alpha3,
    alpha4,
    closure_rows,
    follower_cosine,
    follower_quadratic,
    omega3,
    omega4,
    rates,
)
from seed_ledger import establishes
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, TURN, closure, motion

EVERY_KIND = [*CRANK_ROCKERS.values(), LONG_CRANK, DRAG_LINK]
TIGHT = 1e-9


def abc(lengths, theta2):
    """Return A, B, C as printed below (2.2)."""
    l1, l2, l3, l4 = lengths
    return (
        2 * l4 * (l2 * np.cos(theta2) - l1),
        l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * np.cos(theta2),
        2 * l2 * l4 * np.sin(theta2),
    )


def both_cosines(lengths, theta2, divisor):
    """Return both values of (2.2), with ``divisor`` in place of its D^2."""
    A, B, C = abc(lengths, theta2)
    middle = -A * B / divisor
    root = np.sqrt((A * B / divisor) ** 2 - (B**2 - C**2) / divisor)
    return middle + root, middle - root


def at(expression, m, lengths):
    """Evaluate a derived expression along a motion."""
    symbols = (*LENGTHS, *ANGLES, *SPEEDS, alpha2)
    values = (*lengths, m.theta2, m.theta3, m.theta4, m.omega2, m.omega3, m.omega4, m.alpha2)
    return sp.lambdify(symbols, expression)(*values)


@establishes(
    "Smith",
    "2.1",
    printed=r"\vec\ell_2 + \vec\ell_3 = \vec\ell_1 + \vec\ell_4",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{sp.latex(row)} = 0" for row in closure_rows(0)),
    remark="Closes to round-off for crank-rockers, a long crank and a drag link, both assemblies.",
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
@pytest.mark.parametrize("lengths", EVERY_KIND)
def test_loop_closes(lengths, assembly):
    l1, l2, l3, l4 = lengths
    theta2 = np.linspace(0.01, TURN, 97)
    theta3, theta4 = closure(lengths, theta2, assembly)
    gap = l2 * np.exp(1j * theta2) + l3 * np.exp(1j * theta3) - l1 - l4 * np.exp(1j * theta4)
    assert np.abs(gap).max() < 1e-12 * sum(lengths)


@establishes(
    "Smith",
    "2.2",
    printed=r"\cos\theta_4 = -\frac{AB}{D^2} \pm \sqrt{\left(\frac{AB}{D^2}\right)^2 "
    r"- \frac{B^2 - C^2}{D^2}},\; D = A^2 + C^2",
    verdict="slip",
    derived=lambda: (
        r"\cos\theta_4 \in "
        + sp.latex(set(follower_cosine()[0]))
        + r",\; D^2 = A^2 + C^2; \text{ open: } +C"
    ),
    remark="D in the definition must be D^2. For (5,1,5,2) at 1 rad the true cosines are 0.2072 "
    "(open) and -0.1636; the printed D gives 0.0102 and -0.0101. The sign belongs to the assembly "
    "and to the half turn: + for the open one while sin(theta2) > 0, - in the other half.",
)
def test_divisor_and_sign_of_the_root():
    for lengths in (*CRANK_ROCKERS.values(), LONG_CRANK):
        theta2 = np.linspace(0.05, TURN - 0.04, 61)
        A, _, C = abc(lengths, theta2)
        plus, minus = both_cosines(lengths, theta2, A**2 + C**2)
        for assembly, upper in (("open", theta2 < np.pi), ("crossed", theta2 > np.pi)):
            _, theta4 = closure(lengths, theta2, assembly)
            assert np.abs(np.where(upper, plus, minus) - np.cos(theta4)).max() < 1e-8
    lengths = CRANK_ROCKERS["5,1,5,2"]
    A, _, C = abc(lengths, 1.0)
    true = [np.cos(closure(lengths, 1.0, assembly)[1][0]) for assembly in ("open", "crossed")]
    assert true == pytest.approx([0.2072, -0.1636], abs=5e-5)
    printed = both_cosines(lengths, 1.0, (A**2 + C**2) ** 2)
    assert printed == pytest.approx([0.0102, -0.0101], abs=5e-5)


@establishes(
    "Smith",
    "2.3",
    printed=r"A\cos\theta_4 + B + C\sin\theta_4 = 0",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{k} = {sp.latex(v)}" for k, v in follower_quadratic().items()),
    remark="Its two solutions are the two assemblies; the cosine alone does not settle the sine.",
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_linear_equation_in_cosine_and_sine(assembly):
    theta2 = np.linspace(1e-3, TURN, 50)
    for lengths in EVERY_KIND:
        _, theta4 = closure(lengths, theta2, assembly)
        A, B, C = abc(lengths, theta2)
        residual = A * np.cos(theta4) + B + C * np.sin(theta4)
        assert np.abs(residual).max() < 1e-12 * sum(lengths) ** 2
        derived = sp.lambdify([*LENGTHS, ANGLES[0]], list(follower_quadratic().values()))
        for ours, theirs in zip(derived(*lengths, theta2), (A, B, C), strict=True):
            assert np.allclose(ours, theirs, rtol=1e-13, atol=1e-12)


def triangle_angles(lengths, theta2):
    """Return angles ADB and BDC, both in (0, pi)."""
    l1, l2, l3, l4 = lengths
    pin = l2 * np.exp(1j * theta2) - l1
    diagonal = np.abs(pin)
    adb = np.arccos((l1**2 + diagonal**2 - l2**2) / (2 * l1 * diagonal))
    bdc = np.arccos((l4**2 + diagonal**2 - l3**2) / (2 * l4 * diagonal))
    return adb, bdc


@establishes(
    "Smith",
    "2.2.1 products of cosines and sines",
    printed=r"-\frac{AB}{D^2} = -\cos\widehat{ADB}\cos\widehat{BDC},\; "
    r"\sqrt{\cdots} = \sin\widehat{ADB}\sin\widehat{BDC}",
    verdict="agrees",
    derived=r"-\cos\widehat{ADB}\cos\widehat{BDC} \pm \sin\widehat{ADB}\sin\widehat{BDC}",
)
@establishes(
    "Smith",
    "2.4",
    printed=r"\cos\theta_4 = -\cos(\widehat{ADB} \pm \widehat{BDC})",
    verdict="agrees",
    derived=r"\cos\theta_4 = -\cos(\widehat{BDC} + s\,\widehat{ADB}),\; s = \pm 1 "
    r"\text{ as } \sin\theta_2 \gtrless 0 \text{ (open), reversed (crossed)}",
    remark="The + sign is the open assembly only while sin(theta2) > 0; the text ties it to the "
    "assembly alone.",
)
@pytest.mark.parametrize("lengths", [*CRANK_ROCKERS.values(), LONG_CRANK])
def test_angles_of_both_triangles(lengths):
    theta2 = np.linspace(0.05, TURN - 0.04, 61)
    adb, bdc = triangle_angles(lengths, theta2)
    A, B, C = abc(lengths, theta2)
    D2 = A**2 + C**2
    first, second = np.cos(adb) * np.cos(bdc), np.sin(adb) * np.sin(bdc)
    assert np.abs(A * B / D2 - first).max() < TIGHT
    assert np.abs((A * B / D2) ** 2 - (B**2 - C**2) / D2 - second**2).max() < TIGHT
    half = np.where(theta2 < np.pi, 1.0, -1.0)
    for assembly, sign in (("open", half), ("crossed", -half)):
        _, theta4 = closure(lengths, theta2, assembly)
        assert np.abs(np.cos(theta4) + np.cos(bdc + sign * adb)).max() < TIGHT
        wrong = np.cos(theta4) + np.cos(bdc - sign * adb)
        assert np.abs(wrong).max() > 0.05


@establishes(
    "Smith",
    "2.2.1 crossed angle",
    printed=r"\widehat{ADB} - \widehat{BDC} = \widehat{ADC'} = \theta_4' - \pi",
    verdict="slip",
    derived=r"\widehat{BDC} - \widehat{ADB} = \theta_4' - \pi",
    remark="The difference is turned round. (5,1,5,2) at theta2 = 1, crossed: theta4' - pi = 1.41, "
    "printed difference -1.41. The cosine in (2.4) does not notice.",
)
def test_crossed_angle():
    lengths = CRANK_ROCKERS["5,1,5,2"]
    adb, bdc = triangle_angles(lengths, np.array([1.0]))
    _, crossed = closure(lengths, 1.0, "crossed")
    beyond = np.angle(np.exp(1j * (crossed - np.pi)))
    assert (bdc - adb)[0] == pytest.approx(beyond[0], abs=TIGHT)
    assert (adb - bdc)[0] == pytest.approx(-1.41, abs=0.005)
    assert beyond[0] > 0


@establishes(
    "Smith",
    "2.2.1 quadrants",
    printed=r"\text{open: } \theta_4 \in \text{1st or 2nd quadrant; crossed: 3rd or 4th}",
    verdict="agrees",
    derived=r"\sin\theta_4 \gtrless 0 \text{ throughout the turn of a crank-rocker}",
    remark="Held on 300 random crank-rockers, for theta3 as well: neither link is ever parallel to "
    "the frame. It fails for drag links, as his 2.2.2 says.",
)
def test_follower_stays_on_its_side():
    rng = np.random.default_rng(2)
    theta2 = np.linspace(0.03, TURN - 0.02, 25)
    for _ in range(300):
        others = rng.uniform(1.0, 4.0, 3)
        slack = others.sum() - 2 * others.max()
        if slack < 0.1:
            continue
        crank = rng.uniform(0.05, 0.98) * min(others.min(), slack)
        lengths = (others[0], crank, others[1], others[2])
        for assembly, sign in (("open", 1.0), ("crossed", -1.0)):
            theta3, theta4 = closure(lengths, theta2, assembly)
            assert np.all(sign * np.sin(theta4) > 0)
            assert np.all(sign * np.sin(theta3) > 0)
    _, theta4 = closure(DRAG_LINK, theta2)
    assert np.sin(theta4).min() < -0.9 and np.sin(theta4).max() > 0.9


def drag_link_angles(lengths, theta2):
    """Return sines and cosines of phi, lambda, psi as printed in 2.2.2."""
    l1, l2, l3, l4 = lengths
    diagonal = np.abs(l2 * np.exp(1j * theta2) - l1)
    sin_phi = l2 / diagonal * np.sin(theta2)
    cos_phi = np.sqrt(np.maximum(0.0, 1 - sin_phi**2))
    cos_phi = np.where(l2 * np.cos(theta2) > l1, -cos_phi, cos_phi)
    cos_lambda = (l3**2 - l4**2 + diagonal**2) / (2 * l3 * diagonal)
    cos_psi = (l4**2 - l3**2 + diagonal**2) / (2 * l4 * diagonal)
    return sin_phi, cos_phi, cos_lambda, cos_psi


@establishes(
    "Smith",
    "2.2.2 phi",
    printed=r"\sin\phi = \frac{\ell_2}{BD}\sin\theta_2,\; \cos\phi = \pm\sqrt{1 - \sin^2\phi},\; "
    r"- \text{ if } \ell_2\cos\theta_2 > \ell_1",
    verdict="agrees",
    derived=r"\phi = \operatorname{atan2}(\ell_2\sin\theta_2,\; \ell_1 - \ell_2\cos\theta_2)",
    remark="The square root costs half of the digits near phi = 90 deg; atan2 does not.",
)
@establishes(
    "Smith",
    "2.2.2 lambda and psi",
    printed=r"\cos\lambda = \frac{\ell_3^2 - \ell_4^2 + BD^2}{2\ell_3 BD},\; "
    r"\cos\psi = \frac{\ell_4^2 - \ell_3^2 + BD^2}{2\ell_4 BD}",
    verdict="agrees",
    derived=r"\lambda = \widehat{CBD},\; \psi = \widehat{BDC} \text{ of triangle } BCD",
    remark="The text names the triangle ECD; it is BCD.",
)
def test_drag_link_triangle():
    theta2 = np.linspace(0.0, TURN, 200)
    for lengths in (DRAG_LINK, LONG_CRANK, CRANK_ROCKERS["2,1,2,2"]):
        l1, l2, _, _ = lengths
        theta3, theta4 = closure(lengths, theta2 + 1e-3)
        sin_phi, cos_phi, cos_lambda, cos_psi = drag_link_angles(lengths, theta2 + 1e-3)
        pin = l2 * np.exp(1j * (theta2 + 1e-3)) - l1
        phi = np.pi - np.angle(pin)
        assert np.abs(sin_phi - np.sin(phi)).max() < TIGHT
        assert np.abs(cos_phi - np.cos(phi)).max() < 1e-7
        back, forth = -pin / np.abs(pin), np.exp(1j * theta3)
        assert np.abs(cos_lambda - np.real(back * np.conj(forth))).max() < TIGHT
        outward = pin / np.abs(pin) * np.exp(-1j * theta4)
        assert np.abs(cos_psi - outward.real).max() < TIGHT


@establishes(
    "Smith",
    "2.2.2 theta3 and theta4",
    printed=r"\theta_3 = \lambda - \phi,\; \sin\theta_4 = \sin(\phi + \psi),\; "
    r"\cos\theta_4 = -\cos(\phi + \psi)",
    verdict="agrees",
    derived=r"\theta_3 = \lambda - \phi,\; \theta_4 = \pi - (\phi + \psi)",
    remark="Right in all four quadrants for the open assembly, crank-rockers included.",
)
@pytest.mark.parametrize("lengths", EVERY_KIND)
def test_drag_link_angles(lengths):
    theta2 = np.linspace(1e-3, TURN, 200)
    theta3, theta4 = closure(lengths, theta2)
    sin_phi, cos_phi, cos_lambda, cos_psi = drag_link_angles(lengths, theta2)
    sin_lambda, sin_psi = np.sqrt(1 - cos_lambda**2), np.sqrt(1 - cos_psi**2)
    printed = (
        sin_lambda * cos_phi - cos_lambda * sin_phi,
        cos_lambda * cos_phi + sin_lambda * sin_phi,
        sin_phi * cos_psi + cos_phi * sin_psi,
        -cos_phi * cos_psi + sin_phi * sin_psi,
    )
    true = (np.sin(theta3), np.cos(theta3), np.sin(theta4), np.cos(theta4))
    for ours, theirs in zip(true, printed, strict=True):
        assert np.abs(ours - theirs).max() < 1e-6


@establishes(
    "Smith",
    "2.5",
    printed=r"i\omega_2\vec\ell_2 + i\omega_3\vec\ell_3 - i\omega_4\vec\ell_4 = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "2.6",
    printed=r"\ell_2\omega_2\cos\theta_2 + \ell_3\omega_3\cos\theta_3 - \ell_4\omega_4\cos\theta_4 "
    r"= 0,\; \text{and with sines}",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{sp.latex(row)} = 0" for row in closure_rows(1)),
)
@establishes(
    "Smith",
    "2.7",
    printed=r"\omega_3 = -\omega_2\frac{\ell_2\sin(\theta_2 - \theta_4)}"
    r"{\ell_3\sin(\theta_3 - \theta_4)},\; "
    r"\omega_4 = -\omega_2\frac{\ell_2\sin(\theta_2 - \theta_3)}{\ell_4\sin(\theta_3 - \theta_4)}",
    verdict="agrees",
    derived=lambda: ",\\; ".join(
        f"{sp.latex(k)} = {sp.latex(rates()[k])}" for k in (omega3, omega4)
    ),
    remark="Against spectral derivatives of the searched angles, at uneven crank speed too.",
)
@pytest.mark.parametrize("unsteady", [0.0, 0.3])
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_velocities(assembly, unsteady):
    for lengths in (CRANK_ROCKERS["5,1,5,2"], CRANK_ROCKERS["2,1,2,2"], DRAG_LINK):
        _, l2, l3, l4 = lengths
        m = motion(lengths, assembly, 1024, unsteady)
        links = ((l2, m.theta2, m.omega2), (l3, m.theta3, m.omega3), (-l4, m.theta4, m.omega4))
        total = sum(1j * length * rate * np.exp(1j * angle) for length, angle, rate in links)
        assert np.abs(total).max() < TIGHT * l3
        divisor = np.sin(m.theta3 - m.theta4)
        printed3 = -m.omega2 * l2 * np.sin(m.theta2 - m.theta4) / (l3 * divisor)
        printed4 = -m.omega2 * l2 * np.sin(m.theta2 - m.theta3) / (l4 * divisor)
        assert np.abs(printed3 - m.omega3).max() < TIGHT
        assert np.abs(printed4 - m.omega4).max() < TIGHT
        assert np.allclose(at(rates()[omega3], m, lengths), m.omega3, atol=TIGHT)
        assert np.allclose(at(rates()[omega4], m, lengths), m.omega4, atol=TIGHT)


@establishes(
    "Smith",
    "Fig. 5 instantaneous centre",
    printed=r"\ell_2\omega_2 = -BI\,\omega_3,\; "
    r"\frac{BI}{\sin(\pi + \theta_3 - \theta_4)} = \frac{\ell_3}{\sin(\theta_4 - \theta_2)}",
    verdict="agrees",
    derived=r"BI = \ell_3\frac{\sin(\theta_3 - \theta_4)}{\sin(\theta_2 - \theta_4)}",
    remark="BI is measured from B towards A when positive.",
)
def test_instantaneous_centre():
    lengths = CRANK_ROCKERS["5,1,5,2"]
    l1, l2, l3, _ = lengths
    m = motion(lengths)
    printed = l3 * np.sin(np.pi + m.theta3 - m.theta4) / np.sin(m.theta4 - m.theta2)
    assert np.abs(printed * m.omega3 + l2 * m.omega2).max() < 1e-7
    # The centre lies on the line of the crank and on the line of the follower.
    centre = (l2 + printed) * np.exp(1j * m.theta2)
    off_line = np.imag((centre - l1) * np.exp(-1j * m.theta4))
    assert np.abs(off_line / np.abs(centre)).max() < TIGHT


@establishes(
    "Smith",
    "2.8",
    printed=r"(i\alpha_2 - \omega_2^2)\vec\ell_2 + (i\alpha_3 - \omega_3^2)\vec\ell_3 "
    r"- (i\alpha_4 - \omega_4^2)\vec\ell_4 = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "2.9",
    printed=r"-\ell_2(\alpha_2\sin\theta_2 + \omega_2^2\cos\theta_2) "
    r"- \ell_3(\alpha_3\sin\theta_3 + \omega_3^2\cos\theta_3) "
    r"+ \ell_4(\alpha_4\sin\theta_4 + \omega_4^2\cos\theta_4) = 0,\; "
    r"\ell_2(\alpha_2\cos\theta_2 - \omega_2^2\sin\theta_2) + \cdots = 0",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{sp.latex(row)} = 0" for row in closure_rows(2)),
)
@establishes(
    "Smith",
    "2.10",
    printed=r"\alpha_3 = \frac{\omega_3}{\omega_2}\alpha_2 - \frac{\omega_2^2\ell_2\cos(\theta_2 - "
    r"\theta_4) + \omega_3^2\ell_3\cos(\theta_3 - \theta_4) - \omega_4^2\ell_4}"
    r"{\ell_3\sin(\theta_3 - \theta_4)},\; \alpha_4 = \frac{\omega_4}{\omega_2}\alpha_2 - "
    r"\frac{\omega_2^2\ell_2\cos(\theta_2 - \theta_3) - \omega_4^2\ell_4\cos(\theta_3 - \theta_4) "
    r"+ \omega_3^2\ell_3}{\ell_4\sin(\theta_3 - \theta_4)}",
    verdict="agrees",
    derived=lambda: ",\\; ".join(
        f"{sp.latex(k)} = {sp.latex(rates()[k])}" for k in (alpha3, alpha4)
    ),
    remark="All signs right, the terms in alpha2 included.",
)
@pytest.mark.parametrize("unsteady", [0.0, 0.3])
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_accelerations(assembly, unsteady):
    for lengths in (CRANK_ROCKERS["5,1,5,2"], CRANK_ROCKERS["2,1,2,2"], DRAG_LINK):
        _, l2, l3, l4 = lengths
        m = motion(lengths, assembly, 1024, unsteady)
        total = (
            (1j * m.alpha2 - m.omega2**2) * l2 * np.exp(1j * m.theta2)
            + (1j * m.alpha3 - m.omega3**2) * l3 * np.exp(1j * m.theta3)
            - (1j * m.alpha4 - m.omega4**2) * l4 * np.exp(1j * m.theta4)
        )
        assert np.abs(total).max() < 1e-6 * l3
        between = m.theta3 - m.theta4
        bracket3 = (
            m.omega2**2 * l2 * np.cos(m.theta2 - m.theta4)
            + m.omega3**2 * l3 * np.cos(between)
            - m.omega4**2 * l4
        )
        bracket4 = (
            m.omega2**2 * l2 * np.cos(m.theta2 - m.theta3)
            - m.omega4**2 * l4 * np.cos(between)
            + m.omega3**2 * l3
        )
        printed3 = m.omega3 / m.omega2 * m.alpha2 - bracket3 / (l3 * np.sin(between))
        printed4 = m.omega4 / m.omega2 * m.alpha2 - bracket4 / (l4 * np.sin(between))
        scale = max(1.0, np.abs(m.alpha3).max(), np.abs(m.alpha4).max())
        assert np.abs(printed3 - m.alpha3).max() < 1e-7 * scale
        assert np.abs(printed4 - m.alpha4).max() < 1e-7 * scale
        assert np.abs(at(rates()[alpha3], m, lengths) - m.alpha3).max() < 1e-7 * scale
        assert np.abs(at(rates()[alpha4], m, lengths) - m.alpha4).max() < 1e-7 * scale


@establishes(
    "Smith",
    "2.5 limits of the crank length",
    printed=r"\ell_2 \to 0: \theta_4 \to 120^\circ,\; \omega_4, \alpha_4 \to 0;\quad "
    r"\ell_2 \to \ell_1: \theta_4 = \theta_2,\; \omega_4 = \omega_2,\; \alpha_4 = \alpha_2",
    verdict="agrees",
    derived=r"\ell_1 = \ell_3 = \ell_4",
    remark="With l2 = 10^-6 l1 the follower stays within 1.2e-6 rad of 120 deg. The rhomb is "
    "reached away from its change point theta2 = pi, and only in the open assembly.",
)
def test_limits_of_the_crank_length():
    short = motion((1.0, 1e-6, 1.0, 1.0))
    assert np.abs(short.theta4 - np.radians(120.0)).max() < 1.2e-6
    assert np.abs(short.omega4).max() < 1.2e-6
    theta2 = np.linspace(0.5, 2.6, 30)
    _, theta4 = closure((1.0, 1.0 - 1e-9, 1.0, 1.0), theta2)
    assert np.abs(theta4 - theta2).max() < 1e-7
    _, crossed = closure((1.0, 1.0 - 1e-9, 1.0, 1.0), theta2, "crossed")
    assert np.abs(crossed - theta2).min() > 0.4
