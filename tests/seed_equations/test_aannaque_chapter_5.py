"""Aannaque chapter 5: exact displacement functions, dynamic stiffness, Wittrick and Williams."""

from __future__ import annotations

import mpmath
import numpy as np
import sympy as sp
from elastolink.derive.models import beam_frequency_functions as ff
from elastolink.derive.models.beam_frequency_problem import Z
from elastolink.derive.series import taylor
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.frequencies import (
    dynamic_stiffness,
    element_matrices,
    wittrick_williams,
)
from scipy.linalg import eigvalsh
from seed_frequency import (
    INERTIA,
    A,
    E,
    L,
    axial,
    bending,
    beta,
    end_force,
    field_equations,
    lam,
    number,
    omega,
    rho,
    t,
    u,
    v,
    vanishes,
    x,
)
from seed_ledger import establishes

PAPER = "Aannaque"
V, U = sp.Function("V")(x), sp.Function("U")(x)
PHASE = sp.Symbol("varphi", real=True)
C = sp.symbols("c_1:7")
WAVES = (sp.sin(lam * x), sp.cos(lam * x), sp.sinh(lam * x), sp.cosh(lam * x))
LAM4 = rho * A * omega**2 / (E * INERTIA)
BETA2 = rho * omega**2 / E
CLAMPED = ("x", "y", "rotation")


def motion(shape):
    return shape * sp.sin(omega * t + PHASE)


@establishes(
    PAPER,
    "5.1",
    printed=r"EI v_{xxxx} + \rho A v_{tt} = 0",
    verdict="agrees",
    remark="Without shear and rotary inertia, as the text says.",
)
@establishes(PAPER, "5.2", printed=r"v(x,t) = V(x)\sin(\omega t + \varphi)", verdict="agrees")
@establishes(PAPER, "5.3", printed=r"V'''' - \lambda^4 V = 0", verdict="agrees")
@establishes(PAPER, "5.4", printed=r"\lambda^4 = \rho A\omega^2/(EI)", verdict="agrees")
@establishes(
    PAPER,
    "5.5",
    printed=r"V = c_1\sin\lambda x + c_2\cos\lambda x + c_3\sinh\lambda x + c_4\cosh\lambda x",
    verdict="agrees",
    remark="The growing functions lose all digits of a mode at lambda L of about 37 and overflow "
    "at 710; decaying exponentials from both ends serve to 1e4.",
)
def test_bending_waves():
    equation = field_equations().equations[v]
    assert sp.expand(equation + E * INERTIA * v.diff(x, 4) + rho * A * v.diff(t, 2)) == 0
    held = equation.subs(v, motion(V)).doit() / motion(1)
    assert sp.simplify(held + E * INERTIA * (V.diff(x, 4) - LAM4 * V)) == 0
    for wave in WAVES:
        assert sp.expand(wave.diff(x, 4) - lam**4 * wave) == 0
    wronskian = sp.Matrix(4, 4, lambda i, j: WAVES[j].diff(x, i).subs(x, 0))
    assert sp.simplify(wronskian.det()) != 0


@establishes(PAPER, "5.6", printed=r"EA u_{xx} = \rho A u_{tt}", verdict="agrees")
@establishes(PAPER, "5.7", printed=r"u(x,t) = U(x)\sin(\omega t + \varphi)", verdict="agrees")
@establishes(PAPER, "5.8", printed=r"U'' + \beta^2 U = 0", verdict="agrees")
@establishes(PAPER, "5.9", printed=r"\beta^2 = \rho\omega^2/E", verdict="agrees")
@establishes(PAPER, "5.10", printed=r"U = c_5\sin\beta x + c_6\cos\beta x", verdict="agrees")
@establishes(PAPER, "5.11", printed=r"\beta = \lambda^2\sqrt{I/A}", verdict="agrees")
def test_waves_along_the_beam():
    equation = field_equations().equations[u]
    assert sp.expand(equation - E * A * u.diff(x, 2) + rho * A * u.diff(t, 2)) == 0
    held = equation.subs(u, motion(U)).doit() / motion(1)
    assert sp.simplify(held - E * A * (U.diff(x, 2) + BETA2 * U)) == 0
    for wave in (sp.sin(beta * x), sp.cos(beta * x)):
        assert sp.expand(wave.diff(x, 2) + beta**2 * wave) == 0
    assert sp.simplify(BETA2 - LAM4 * INERTIA / A) == 0


def printed_matrix():
    """Return (5.12) as printed."""
    s, c, sh, ch = (wave.subs(x, L) for wave in WAVES)
    return sp.Matrix(
        [
            [0, 1, 0, 0, 0, 0],
            [sp.sin(beta * L), sp.cos(beta * L), 0, 0, 0, 0],
            [0, 0, 0, 1, 0, 1],
            [0, 0, lam, 0, lam, 0],
            [0, 0, s, c, sh, ch],
            [0, 0, lam * c, -lam * s, lam * ch, lam * sh],
        ]
    )


def ends():
    """Return u and v and their slopes at the ends in the six constants."""
    stretch = C[4] * sp.sin(beta * x) + C[5] * sp.cos(beta * x)
    bend = sum(c * wave for c, wave in zip(C[:4], WAVES, strict=True))
    values = [stretch.subs(x, 0), stretch.subs(x, L)]
    for place in (0, L):
        values += [bend.subs(x, place), bend.diff(x).subs(x, place)]
    return sp.Matrix(values), stretch, bend


@establishes(
    PAPER,
    "5.12",
    printed=r"q = A\,(c_1, c_2, c_3, c_4, c_5, c_6)^T",
    verdict="slip",
    derived=r"q = A\,(c_5, c_6, c_1, c_2, c_3, c_4)^T",
    remark="The first two columns belong to the motion along the beam, c5 and c6 of (5.10). Read "
    "as printed, c2 = 1 alone would move the first joint along the beam by 1 instead of across it.",
)
@establishes(PAPER, "5.13", printed=r"q = A c", verdict="agrees")
def test_constants_from_the_ends():
    values, _, _ = ends()
    right = sp.Matrix([C[4], C[5], *C[:4]])
    assert sp.expand(values - printed_matrix() * right) == sp.zeros(6, 1)
    alone = {c: int(c == C[1]) for c in C}
    assert (printed_matrix() * sp.Matrix(C)).subs(alone)[0] == 1
    assert values.subs(alone)[0] == 0 and values.subs(alone)[2] == 1


def forces():
    """Return the six end forces in the constants, from Hamilton's natural conditions."""
    _, stretch, bend = ends()
    found = [end_force(u, 0, 0).subs(u, stretch).doit().subs(x, 0)]
    found.append(end_force(u, 0, L).subs(u, stretch).doit().subs(x, L))
    for place in (0, L):
        moved = (end_force(v, order, place).subs(v, bend) for order in (0, 1))
        found += [force.doit().subs(x, place) for force in moved]
    return sp.Matrix(found)


@establishes(PAPER, "5.14", printed=r"D q = f,\; D = K - \omega^2 M", verdict="agrees")
@establishes(
    PAPER,
    "5.15",
    printed=r"f^T = E[A U'(0), -A U'(L), I V'''(0), -I V''(0), -I V'''(L), I V''(L)]",
    verdict="slip",
    derived=r"E[-A U'(0), A U'(L), I V'''(0), -I V''(0), -I V'''(L), I V''(L)]",
    remark="The axial signs are those of the forces on the joints. As printed a static bar pulled "
    "by 1 at x = L shortens by L/(EA): the stiffness of a bar would be negative.",
)
def test_end_forces():
    stretch, bend = sp.Function("U")(x), sp.Function("V")(x)
    expected = {(u, 0, 0): -E * A * stretch.diff(x), (u, 0, L): E * A * stretch.diff(x)}
    expected |= {
        (v, 0, 0): E * INERTIA * bend.diff(x, 3),
        (v, 1, 0): -E * INERTIA * bend.diff(x, 2),
    }
    expected |= {
        (v, 0, L): -E * INERTIA * bend.diff(x, 3),
        (v, 1, L): E * INERTIA * bend.diff(x, 2),
    }
    for (field, order, place), value in expected.items():
        shape = stretch if field == u else bend
        assert sp.expand(end_force(field, order, place).subs(field, shape).doit() - value) == 0
    # A static bar: U = x q / L; the printed force at L is -EA q / L.
    assert end_force(u, 0, L).subs(u, x / L).doit() == E * A / L


def printed_stiffness():
    """Return (5.18) for a beam of length 1, over EA and over EI, with the functions F."""
    f = bending() | axial()
    along = sp.Matrix([[f["F7"], f["F8"]], [f["F8"], f["F7"]]])
    rows = [
        [f["F6"], -f["F4"], f["F5"], f["F3"]],
        [-f["F4"], f["F2"], -f["F3"], f["F1"]],
        [f["F5"], -f["F3"], f["F6"], f["F4"]],
        [f["F3"], f["F1"], f["F4"], f["F2"]],
    ]
    return along, sp.Matrix(rows)


@establishes(
    PAPER,
    "5.18",
    printed=r"D = \mathrm{diag}(EA[F_7, F_8; F_8, F_7], EI[F_6, -F_4, F_5, F_3; ...])",
    verdict="agrees",
    remark="With the F of Appendix B for lengths 1, F7 and F8 with the other sign there. The "
    "scan's last row is the symmetric one.",
)
def test_dynamic_stiffness():
    values, _, _ = ends()
    unit = {L: 1}
    along, across = printed_stiffness()
    whole = sp.diag(E * A * along, E * INERTIA * across)
    constants = values.jacobian(sp.Matrix(C)).subs(unit)
    acting = forces().jacobian(sp.Matrix(C)).subs(unit)
    difference = whole * constants - acting
    assert all(vanishes(entry) for entry in difference)


@establishes(
    PAPER,
    "5.16",
    printed=r"M = -\partial D/\partial\omega^2",
    verdict="agrees",
    remark="Proved here for the bar and for a beam's ends by the integrals of their shapes.",
)
@establishes(PAPER, "5.17", printed=r"K = D + \omega^2 M", verdict="agrees")
@establishes(
    PAPER,
    "5.19",
    printed=r"M = \mathrm{diag}(EA[G_7, G_8; G_8, G_7], ...)",
    verdict="not legible",
    derived=r"M = \rho A\,\mathrm{diag}([G_7, G_8; G_8, G_7], [G_6, -G_4, G_5, G_3; ...])",
    remark="Half of the matrix is lost. What is left has EA for rho A: -dD/d omega^2 brings rho/E "
    "along the beam and rho A/(EI) across it.",
)
def test_mass_by_the_theorem_of_richards_and_leung():
    """``-dD/d(omega^2) = int rho A N^T N dx`` with the exact shapes, at beta = 1.3, lambda = 2."""
    shape = sp.sin(beta * x) / sp.sin(beta)
    other = sp.sin(beta * (1 - x)) / sp.sin(beta)
    for name, second in (("F7", shape), ("F8", other)):
        rate = -axial()[name].diff(beta) / (2 * beta)
        product = sp.lambdify((x, beta), shape * second, "mpmath")
        integral = mpmath.quad(lambda place, f=product: f(place, mpmath.mpf("1.3")), [0, 1])
        assert abs(number(rate, beta="1.3") - integral) < 1e-14
    with mpmath.workdps(20):
        assert_mass_of_the_beam(mpmath.mpf(2))


def assert_mass_of_the_beam(at):
    """Compare the derivatives of the stiffness with integrals of the shapes, by quadrature."""
    waves = [sp.lambdify((x, lam), wave, "mpmath") for wave in WAVES]
    slopes = [sp.lambdify((x, lam), wave.diff(x), "mpmath") for wave in WAVES]
    rows = [[f(place, at) for f in group] for place in (0, 1) for group in (waves, slopes)]
    inverse = mpmath.inverse(mpmath.matrix(rows))
    _, across = printed_stiffness()
    for i in range(4):
        for j in range(i, 4):
            entry = sp.lambdify(lam, across[i, j], "mpmath")
            rate = -mpmath.diff(entry, at) / (4 * at**3)
            product = mpmath.quad(
                lambda place, i=i, j=j: (
                    _shape(waves, inverse, i, place, at) * _shape(waves, inverse, j, place, at)
                ),
                [0, 1],
            )
            assert abs(rate - product) < 1e-15


def _shape(waves, inverse, column, place, at):
    return sum(wave(place, at) * inverse[k, column] for k, wave in enumerate(waves))


@establishes(
    PAPER,
    "5.2.2 power series of the matrices",
    printed=r"M = \rho A L[...] + ...,\quad K = ...",
    verdict="not legible",
    derived=r"F_6 = 12 - \tfrac{13}{35}z^4 - \tfrac{59}{161700}z^8 - ...,\; z = \lambda L",
    remark="The constant terms are the matrices of the cubic element, as the text says; the next "
    "ones of K are positive, of M too.",
)
def test_power_series_begins_with_the_cubic_element():
    from elastolink.runtime.beams import element_arrays

    z = sp.Symbol("z", positive=True)
    above, divisor = ff.numerators()
    below = taylor(divisor, Z, 4).value
    series = {
        name: sp.series((taylor(form, Z, 4).value / below).subs(Z, z), z, 0, 9).removeO()
        for name, form in above.items()
    }
    assert series["F6"] == 12 - sp.Rational(13, 35) * z**4 - sp.Rational(59, 161700) * z**8
    cubic = element_arrays(
        "cubic", length=1.0, mass_per_length=1.0, axial_stiffness=1.0, bending_stiffness=1.0
    )
    places = {
        "F6": (1, 1, 1),
        "F4": (1, 2, -1),
        "F5": (1, 4, 1),
        "F3": (1, 5, 1),
        "F2": (2, 2, 1),
        "F1": (2, 5, 1),
    }
    for name, (row, column, sign) in places.items():
        assert abs(sign * series[name].coeff(z, 0) - cubic.stiffness[row, column]) < 1e-14
        assert abs(-sign * series[name].coeff(z, 4) - cubic.mass[row, column]) < 1e-14


def portal(elements=1):
    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    return frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        bar,
        supports={"A": CLAMPED, "D": CLAMPED},
        elements=elements,
    )


@establishes(PAPER, "5.20", printed=r"D(\omega) q = 0", verdict="agrees")
@establishes(
    PAPER,
    "5.21",
    printed=r"J(\omega_0) = J_0(\omega_0) + s\{D(\omega_0)\}",
    verdict="agrees",
    remark="Against the count of 20 elements a bar at 40 frequencies. At the portal frame's fourth "
    "frequency J0 alone jumps, by three, and s falls by two: q = 0 there.",
)
def test_count_of_wittrick_and_williams():
    problem = dynamic_stiffness(portal(), inextensible=True)
    mass, stiffness, _ = element_matrices(portal(20), inextensible=True)
    reference = np.sqrt(eigvalsh(stiffness, mass))
    trials = np.linspace(1.0, 300.0, 40)
    for trial in trials:
        near = np.min(np.abs(reference - trial)) < 1e-3 * trial
        assert near or problem.count(trial) == np.sum(reference < trial)
    found = wittrick_williams(problem, count=5)
    fourth = found.frequencies[3]
    np.testing.assert_allclose(fourth, 4.730040744862704**2, rtol=1e-13)
    assert np.max(np.abs(found.vectors()[3])) < 1e-12
    below, above = fourth * (1 - 1e-6), fourth * (1 + 1e-6)
    assert problem.poles(above) - problem.poles(below) == 3
    assert problem.count(above) - problem.count(below) == 1
