"""Aannaque 3.5-3.8: motion of the four-bar, its pin forces and torque, joint accelerations."""

import numpy as np
import pytest
import sympy as sp
from seed_derivations import (
    ANGLES,
    LENGTHS,
    SPEEDS,
    alpha3,
    alpha4,
    closure_rows,
    omega3,
    omega4,
    rates,
)
from seed_derivations import alpha2 as crank_acceleration
from seed_ledger import establishes
from seed_rigid import TABLE_3_2, Link, centres, forces, motion, rate
from seed_rigid_derivations import FREUDENSTEIN, TURNS, freudenstein, half_angle_quadratic
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, TURN, closure

KINDS = (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], CRANK_ROCKERS["2,1,2,2"], LONG_CRANK, DRAG_LINK)
CRANK_ANGLES = np.linspace(0.03, TURN - 0.02, 61)
DENSITY = 7850.0
SECTIONS = ((24.8e-3, 6.35e-3), (25e-3, 3.42e-3), (25e-3, 3.15e-3))
BARS = tuple(
    Link.bar(DENSITY * width * thick * length, length)
    for (width, thick), length in zip(SECTIONS, TABLE_3_2[1:], strict=True)
)


def constants(lengths):
    """Return K1 to K5 as printed below (3.5) and (3.7)."""
    frame, l1, l2, l3 = lengths
    lam2, lam3, lam4 = l2 / l1, l3 / l1, frame / l1
    return (
        lam4,
        lam4 / lam3,
        (1 - lam2**2 + lam3**2 + lam4**2) / (2 * lam3),
        lam4 / lam2,
        (lam3**2 - lam4**2 - 1 - lam2**2) / (2 * lam2),
    )


def latex_pair(*names):
    """Return derived rates in the letters of Smith's chapter 2."""
    return ",\\; ".join(f"{sp.latex(name)} = {sp.latex(rates()[name])}" for name in names)


@establishes(
    "Aannaque",
    "3.3",
    printed=r"L_1 e^{it_1} + L_2 e^{it_2} = L_3 e^{it_3} + L_4",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "3.4",
    printed=r"L_1\cos t_1 + L_2\cos t_2 - L_3\cos t_3 = L_4,\; "
    r"L_1\sin t_1 + L_2\sin t_2 - L_3\sin t_3 = 0",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{sp.latex(row)} = 0" for row in closure_rows(0)),
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_loop_closure(assembly):
    for lengths in KINDS:
        frame, l1, l2, l3 = lengths
        t2, t3 = closure(lengths, CRANK_ANGLES, assembly)
        gap = l1 * np.exp(1j * CRANK_ANGLES) + l2 * np.exp(1j * t2) - l3 * np.exp(1j * t3) - frame
        assert np.abs(gap).max() < 1e-12 * sum(lengths)
        values = (CRANK_ANGLES, t2, t3)
        derived = sp.lambdify((*LENGTHS, *ANGLES), closure_rows(0))(*lengths, *values)
        assert np.abs(derived).max() < 1e-12 * sum(lengths)


@establishes(
    "Aannaque",
    "3.5",
    printed=r"K_1\cos t_3 - K_2\cos t_1 + K_3 = \cos(t_1 - t_3),\; K_1 = \lambda_4,\; "
    r"K_2 = \frac{\lambda_4}{\lambda_3},\; K_3 = \frac{1 - \lambda_2^2 + \lambda_3^2 + "
    r"\lambda_4^2}{2\lambda_3}",
    verdict="agrees",
    derived=lambda: sp.latex(freudenstein()[0]) + " = 0",
)
@establishes(
    "Aannaque",
    "3.7",
    printed=r"K_4\cos t_1 - K_1\cos t_2 + K_5 = \cos(t_1 - t_2),\; K_4 = \frac{\lambda_4}"
    r"{\lambda_2},\; K_5 = \frac{\lambda_3^2 - \lambda_4^2 - 1 - \lambda_2^2}{2\lambda_2}",
    verdict="slip",
    derived=lambda: sp.latex(freudenstein()[1]) + " = 0",
    remark="+ K1 cos(t2). Table 3.2, open, t1 = 1: left less right side is -3.06 as printed, 0 "
    "with "
    "the plus. (3.8) was solved from the right form.",
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_freudenstein(assembly):
    for lengths in KINDS:
        k1, k2, k3, k4, k5 = constants(lengths)
        t1 = CRANK_ANGLES
        t2, t3 = closure(lengths, t1, assembly)
        follower = k1 * np.cos(t3) - k2 * np.cos(t1) + k3 - np.cos(t1 - t3)
        coupler = k4 * np.cos(t1) + k1 * np.cos(t2) + k5 - np.cos(t1 - t2)
        size = max(k1, k3, k4, -k5)
        assert max(np.abs(follower).max(), np.abs(coupler).max()) < 1e-12 * size
        assert np.abs(coupler - 2 * k1 * np.cos(t2)).max() > 0.5
        symbols = (*FREUDENSTEIN, *TURNS)
        derived = sp.lambdify(symbols, freudenstein())(*lengths[1:], lengths[0], t1, t2, t3)
        assert np.abs(derived).max() < 1e-12 * size
    t1 = 1.0
    k1, _, _, k4, k5 = constants(TABLE_3_2)
    t2 = closure(TABLE_3_2, t1)[0][0]
    residual = k4 * np.cos(t1) - k1 * np.cos(t2) + k5 - np.cos(t1 - t2)
    assert residual == pytest.approx(-3.06, abs=0.005)


def half_tangents(lengths, t1):
    """Return (3.6) and (3.8): follower and coupler angles, upper and lower sign."""
    k1, k2, k3, k4, k5 = constants(lengths)
    cosine, sine = np.cos(t1), np.sin(t1)
    found = []
    for first, last in (
        ((1 - k2) * cosine + k3 - k1, k1 + k3 - (1 + k2) * cosine),
        ((1 + k4) * cosine + k5 - k1, k1 + (k4 - 1) * cosine + k5),
    ):
        root = np.sqrt(4 * sine**2 - 4 * first * last)
        found += [2 * np.arctan((2 * sine + sign * root) / (2 * first)) for sign in (1, -1)]
    return found


def quadratic_latex(coupler):
    """Return the quadratic of the half angle."""
    first, middle, last = (sp.latex(part) for part in half_angle_quadratic(coupler))
    return rf"\left({first}\right)u^2 + \left({middle}\right)u + \left({last}\right) = 0"


def turned(ours, theirs):
    """Return the greatest distance of two arrays of angles, full turns apart or not."""
    return np.abs(np.angle(np.exp(1j * (ours - theirs)))).max()


@establishes(
    "Aannaque",
    "3.6",
    printed=r"t_3 = 2\tan^{-1}\left(\frac{2\sin t_1 \pm \sqrt{4\sin^2 t_1 - 4[(1 - K_2)\cos t_1 + "
    r"K_3 - K_1][K_1 + K_3 - (1 + K_2)\cos t_1]}}{2[(1 - K_2)\cos t_1 + K_3 - K_1]}\right)",
    verdict="agrees",
    derived=lambda: r"u = \tan\tfrac{t_3}{2}:\; " + quadratic_latex(0),
    remark="Both roots. The lower sign is the open assembly throughout the turn, the upper one "
    "the crossed. Divides by zero where t3 = 180 deg, which drag links pass.",
)
@establishes(
    "Aannaque",
    "3.8",
    printed=r"t_2 = 2\tan^{-1}\left(\frac{2\sin t_1 \pm \sqrt{4\sin^2 t_1 - 4[(1 + K_4)\cos t_1 + "
    r"K_5 - K_1][K_1 + (K_4 - 1)\cos t_1 + K_5]}}{2[K_5 - K_1 + (1 + K_4)\cos t_1]}\right)",
    verdict="agrees",
    derived=lambda: r"u = \tan\tfrac{t_2}{2}:\; " + quadratic_latex(1),
    remark="Both roots; the same sign as in (3.6) gives the same assembly.",
)
@establishes(
    "Aannaque",
    "3.5 two assemblies",
    printed=r"\text{two solutions for one input angle}",
    verdict="agrees",
    derived=r"\text{mirror images in } AC",
)
def test_both_roots():
    rng = np.random.default_rng(10)
    shapes = rng.uniform((2.0, 0.9, 0.9), (4.0, 1.3, 1.3), (20, 3))
    random = [(frame, 0.5, frame * first, frame * second) for frame, first, second in shapes]
    for lengths in (*KINDS, *random):
        upper3, lower3, upper2, lower2 = half_tangents(lengths, CRANK_ANGLES)
        for assembly, t3, t2 in (("open", lower3, lower2), ("crossed", upper3, upper2)):
            coupler, follower = closure(lengths, CRANK_ANGLES, assembly)
            assert turned(t3, follower) < 1e-7
            assert turned(t2, coupler) < 1e-7
        for coupler, angles in ((0, (upper3, lower3)), (1, (upper2, lower2))):
            parts = sp.lambdify((*FREUDENSTEIN, TURNS[0]), half_angle_quadratic(coupler))(
                *lengths[1:], lengths[0], CRANK_ANGLES
            )
            for angle in angles:
                # (1 + cos) u^2 = 1 - cos and (1 + cos) u = sin: no division where u is infinite.
                rest = parts[0] * (1 - np.cos(angle)) + parts[2] * (1 + np.cos(angle))
                assert np.abs(rest + parts[1] * np.sin(angle)).max() < 1e-9 * np.abs(parts[0]).max()
        pin = lengths[1] * np.exp(1j * CRANK_ANGLES) - lengths[0]
        mirrored = np.angle(pin**2 * np.exp(-1j * lower3))
        assert turned(upper3, mirrored) < 1e-7


@establishes(
    "Aannaque",
    "3.9",
    printed=r"\cos\gamma = \frac{L_2^2 + L_3^2 + 2L_1 L_4\cos t_1 - L_1^2 - L_4^2}{2L_2 L_3}",
    verdict="agrees",
    derived=r"AC^2 = L_1^2 + L_4^2 - 2L_1 L_4\cos t_1 = L_2^2 + L_3^2 - 2L_2 L_3\cos\gamma",
)
@establishes(
    "Aannaque",
    "3.10",
    printed=r"\cos\gamma_{min} = \frac{L_2^2 + L_3^2 + 2L_1 L_4 - L_1^2 - L_4^2}{2L_2 L_3},\; "
    r"\cos\gamma_{max} = \frac{L_2^2 + L_3^2 - 2L_1 L_4 - L_1^2 - L_4^2}{2L_2 L_3}",
    verdict="agrees",
    derived=r"\gamma_{min} \text{ at } t_1 = 0,\; \gamma_{max} \text{ at } 180^\circ",
    remark="For an input that turns fully. For frame, input, coupler, output (4,3,2,2) the "
    "second is "
    "-5.1, no cosine: the extreme is 180 deg.",
)
@establishes(
    "Aannaque",
    "3.5 transmission angle of Table 3.2",
    printed=r"\text{maximum at } 180^\circ, \text{ minimum at } 0, \text{ within } "
    r"40\text{-}140^\circ",
    verdict="agrees",
    derived=r"45.6^\circ \le \gamma \le 112.3^\circ",
)
def test_transmission_angle():
    for lengths in KINDS:
        frame, l1, l2, l3 = lengths
        for assembly in ("open", "crossed"):
            t2, t3 = closure(lengths, CRANK_ANGLES, assembly)
            middle = l2**2 + l3**2 - l1**2 - frame**2
            printed = (middle + 2 * l1 * frame * np.cos(CRANK_ANGLES)) / (2 * l2 * l3)
            assert np.abs(printed - np.cos(t3 - t2)).max() < 1e-11
        m = motion(lengths)
        gamma = np.arccos(np.cos(m.theta4 - m.theta3))
        extremes = [(middle + sign * 2 * l1 * frame) / (2 * l2 * l3) for sign in (1, -1)]
        assert np.cos([gamma.min(), gamma.max()]) == pytest.approx(extremes, abs=1e-11)
        assert int(gamma.argmin()) == 0 and int(gamma.argmax()) == gamma.size // 2
    m = motion(TABLE_3_2)
    gamma = np.degrees(np.arccos(np.cos(m.theta4 - m.theta3)))
    assert [gamma.min(), gamma.max()] == pytest.approx([45.6, 112.3], abs=0.05)
    assert pytest.approx(-5.1, abs=0.03) == (4 + 4 - 24 - 9 - 16) / 8


@establishes(
    "Aannaque",
    "3.11",
    printed=r"\frac{\omega_2}{\omega_1} = -\frac{L_1\sin(t_3 - t_1)}{L_2\sin(t_3 - t_2)},\; "
    r"\frac{\omega_3}{\omega_1} = -\frac{L_1\sin(t_2 - t_1)}{L_3\sin(t_3 - t_2)},\; "
    r"\alpha_2 = \frac{L_1\omega_1^2\cos(t_3 - t_1) + L_2\omega_2^2\cos(t_3 - t_2) - L_3\omega_3^2}"
    r"{L_2\sin(t_3 - t_2)},\; \alpha_3 = \frac{L_1\omega_1^2\cos(t_2 - t_1) - L_3\omega_3^2"
    r"\cos(t_2 - t_3) + L_2\omega_2^2}{L_3\sin(t_3 - t_2)}",
    verdict="agrees",
    derived=lambda: latex_pair(omega3, omega4, alpha3, alpha4),
    remark="At constant input speed, all signs. The derived forms are in Smith's letters: one "
    "subscript higher, theta for t, and with the term of the crank's acceleration.",
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_rates(assembly):
    for lengths in KINDS:
        _, l1, l2, l3 = lengths
        m = motion(lengths, assembly, 1024)
        t1, t2, t3, w1, w2, w3 = m.theta2, m.theta3, m.theta4, m.omega2, m.omega3, m.omega4
        divisor = np.sin(t3 - t2)
        printed = (
            -l1 * np.sin(t3 - t1) / (l2 * divisor),
            -l1 * np.sin(t2 - t1) / (l3 * divisor),
            (l1 * w1**2 * np.cos(t3 - t1) + l2 * w2**2 * np.cos(t3 - t2) - l3 * w3**2)
            / (l2 * divisor),
            (l1 * w1**2 * np.cos(t2 - t1) - l3 * w3**2 * np.cos(t2 - t3) + l2 * w2**2)
            / (l3 * divisor),
        )
        symbols = (*LENGTHS, *ANGLES, *SPEEDS, crank_acceleration)
        values = (*lengths, t1, t2, t3, w1, w2, w3, 0.0 * w1)
        for name, ours, true in zip(
            (omega3, omega4, alpha3, alpha4), printed, (w2, w3, m.alpha3, m.alpha4), strict=True
        ):
            scale = np.abs(true).max()
            assert np.abs(ours - true).max() < 1e-7 * scale
            derived = sp.lambdify(symbols, rates()[name])(*values)
            assert np.abs(derived - true).max() < 1e-7 * scale


def table_forces():
    """Return the true forces of Table 3.2's uniform bars at 1 rad/s, inertia forces and motion."""
    f, m = forces(TABLE_3_2, BARS), motion(TABLE_3_2)
    inertia = [-k.mass * rate(p, 2) for k, p in zip(BARS, centres(TABLE_3_2, BARS, m), strict=True)]
    return f, inertia, m


@establishes(
    "Aannaque",
    "3.7 free-body equations of the input link",
    printed=r"F_{01x} + F_{21x} + F_{1x} = 0,\; F_{01y} + F_{21y} + F_{1y} = 0,\; "
    r"C + (F_{01x} - F_{21x})\frac{L_1}{2}\sin t_1 + (F_{21y} - F_{01y})\frac{L_1}{2}\cos t_1 = 0",
    verdict="agrees",
    derived=r"F_1 = -m_1 a_1 \text{ (inertia force)}",
    remark="For a uniform bar at constant speed.",
)
@establishes(
    "Aannaque",
    "3.7 free-body equations of coupler and follower",
    printed=r"\text{(in Figs. 3.11.b and c)}",
    verdict="not legible",
    derived=r"F_{12} + F_{32} + F_2 = 0,\; F_{23} + F_{03} + F_3 = 0,\; \text{moments: rows 6 "
    r"and 9 "
    r"of (3.12)}",
    remark="They went with the figures; (3.12) repeats them.",
)
def test_free_bodies():
    f, inertia, m = table_forces()
    f01, f21 = f.f12, -f.f23
    assert np.abs(f01 + f21 + inertia[0]).max() < 1e-9 * np.abs(f01).max()
    half = TABLE_3_2[1] / 2
    moment = f.torque + (f01 - f21).real * half * np.sin(m.theta2)
    moment += (f21 - f01).imag * half * np.cos(m.theta2)
    assert np.abs(moment).max() < 1e-9 * np.abs(f.torque).max()
    assert np.abs(f.f23 - f.f34 + inertia[1]).max() < 1e-9 * np.abs(f01).max()
    assert np.abs(f.f34 - f.f41 + inertia[2]).max() < 1e-9 * np.abs(f01).max()


def printed_system(lengths, m, inertia, alphas, fifth=1.0):
    """Return (3.12) for the unknowns F01, F12, F23, F03 (x, y each) and C, with C's column put "
    "back.

    ``fifth`` is the entry of row 5, column 4: +1 as printed.
    """
    _, *bars = lengths
    count = m.theta2.size
    matrix, right = np.zeros((count, 9, 9)), np.zeros((count, 9))
    for i, (bar, angle) in enumerate(zip(bars, (m.theta2, m.theta3, m.theta4), strict=True)):
        sine, cosine = bar / 2 * np.sin(angle), bar / 2 * np.cos(angle)
        row, column = 3 * i, 2 * i
        matrix[:, row, column] = matrix[:, row + 1, column + 1] = -1.0
        matrix[:, row, column + 2] = matrix[:, row + 1, column + 3] = 1.0 if i < 2 else -1.0
        near = np.stack([sine, -cosine], axis=-1)
        matrix[:, row + 2, column : column + 2] = near if i < 2 else -near
        matrix[:, row + 2, column + 2 : column + 4] = near
        right[:, row], right[:, row + 1] = inertia[i].real, inertia[i].imag
        right[:, row + 2] = BARS[i].inertia_about_centre * alphas[i]
    matrix[:, 2, 8] = 1.0
    matrix[:, 4, 3] = fifth
    return np.linalg.solve(matrix, right[..., None])[..., 0]


@establishes(
    "Aannaque",
    "3.12",
    printed=r"9\times 9;\; \text{rows 1-3: } (-1, 0, 1, 0),\, (0, -1, 0, 1),\, \tfrac{L_1}{2}"
    r"(\sin t_1, -\cos t_1, \sin t_1, -\cos t_1);\; \text{row 5: } (0, 0, 0, 1, 0, 1, 0, 0);\; "
    r"\ldots;\; \text{right side } F_{1x} \ldots J_3\alpha_3",
    verdict="slip",
    derived=r"\text{unknowns } F_{01}, F_{12}, F_{23}, F_{03}, C;\; \text{row 5: } "
    r"(0, 0, 0, -1, 0, 1, 0, 0, 0);\; \text{row 3, column 9: } 1;\; \text{right side } F_{1x}, "
    r"F_{1y}, J_1\alpha_1 = 0, F_{2x}, F_{2y}, J_2\alpha_2, F_{3x}, F_{3y}, J_3\alpha_3",
    remark="Two faults: the column of C is lost (9 equations, 8 columns), and row 5 has +1 for "
    "-1 in column 4. The other rows hold for the unknowns named here. Table 3.2: with the "
    "printed +1 the torque is wrong by 263 percent of its peak.",
)
def test_nine_equations():
    f, inertia, m = table_forces()
    alphas = (m.alpha2, m.alpha3, m.alpha4)
    true = np.stack(
        [v for pin in (f.f12, f.f23, f.f34, -f.f41) for v in (pin.real, pin.imag)] + [f.torque], -1
    )
    right = printed_system(TABLE_3_2, m, inertia, alphas, fifth=-1.0)
    assert np.abs(right - true).max() < 1e-9 * np.abs(true).max()
    printed = printed_system(TABLE_3_2, m, inertia, alphas)
    wrong = np.abs(printed - true)[:, 8].max() / np.abs(true[:, 8]).max()
    assert wrong == pytest.approx(2.63, abs=0.006)


@establishes(
    "Aannaque",
    "3.7 torque of the motor",
    printed=r"\text{the torque fluctuates and can become negative}",
    verdict="agrees",
    derived=r"\oint T\,dt_1 = 0 \text{ at constant speed}",
    remark="From inertia alone it must become negative, its mean being zero. Table 3.2: from "
    "-0.0105 to 0.0071 N m at 1 rad/s.",
)
def test_torque_fluctuates():
    f, _, m = table_forces()
    assert abs(f.torque.mean()) < 1e-10 * np.abs(f.torque).max()
    assert np.abs(f.torque * m.omega2 - f.energy_rate).max() < 1e-9 * np.abs(f.torque).max()
    assert [f.torque.min(), f.torque.max()] == pytest.approx([-0.0105, 0.0071], abs=6e-5)


@establishes(
    "Aannaque",
    "3.13",
    printed=r"\ddot q_{Bx} = -L_1\omega_1^2\cos t_1 - L_2\omega_2^2\cos t_2 - L_2\alpha_2\sin t_1,"
    r"\; \ddot q_{By} = -L_1\omega_1^2\sin t_1 - L_2\omega_2^2\sin t_1 + L_2\alpha_2\cos t_2,\; "
    r"\ddot q_A = -L_1\omega_1^2(\cos t_1, \sin t_1)",
    verdict="slip",
    derived=r"\ddot q_{Bx} = \ldots - L_2\alpha_2\sin t_2,\; "
    r"\ddot q_{By} = \ldots - L_2\omega_2^2\sin t_2 + \ldots",
    remark="t2 for t1 twice. Table 3.2: the printed components are wrong by up to 131 and 53 "
    "percent of the greatest acceleration of B. The other five lines are right.",
)
def test_joint_accelerations():
    m = motion(TABLE_3_2)
    _, l1, l2, _ = TABLE_3_2
    t1, t2, w2, a2 = m.theta2, m.theta3, m.omega3, m.alpha3
    pin_a = l1 * np.exp(1j * t1)
    true_a, true_b = rate(pin_a, 2), rate(pin_a + l2 * np.exp(1j * t2), 2)
    size = np.abs(true_b).max()
    assert np.abs(true_a + l1 * (np.cos(t1) + 1j * np.sin(t1))).max() < 1e-9 * size
    assert np.abs(m.alpha2).max() < 1e-9
    wrong = []
    for angle in (t2, t1):
        along = -l1 * np.cos(t1) - l2 * w2**2 * np.cos(t2) - l2 * a2 * np.sin(angle)
        across = -l1 * np.sin(t1) - l2 * w2**2 * np.sin(angle) + l2 * a2 * np.cos(t2)
        wrong.append([np.abs(along - true_b.real).max(), np.abs(across - true_b.imag).max()])
    assert max(wrong[0]) < 1e-8 * size
    assert np.array(wrong[1]) / size == pytest.approx([1.31, 0.53], abs=0.006)
