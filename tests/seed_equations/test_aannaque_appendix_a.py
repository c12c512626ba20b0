"""Aannaque (A.1)-(A.8): the two elements of the p-version."""

from functools import cache

import mpmath
import numpy as np
import scipy.linalg
import sympy as sp
from elastolink.runtime.beams.elements import element_arrays
from seed_elements import EI, L, arrays, integral, letters, rho, same, shape_rows, symmetric, zeta
from seed_ledger import establishes

R = sp.Rational
z2, z3, z4, z5 = (zeta**k for k in (2, 3, 4, 5))
PRINTED_SHAPES = sp.Matrix(
    [
        [
            1 - 23 * z2 + 66 * z3 - 68 * z4 + 24 * z5,
            L * (zeta - 6 * z2 + 13 * z3 - 12 * z4 + 4 * z5),
            16 * z2 - 32 * z3 + 16 * z4,
            L * (-8 * z2 + 32 * z3 - 40 * z4 + 16 * z5),
            7 * z2 - 34 * z3 + 52 * z4 - 24 * z5,
            L * (-z2 + 5 * z3 - 8 * z4 + 4 * z5),
        ]
    ]
)
PRINTED_STRAINS = sp.Matrix(
    [
        [
            -46 + 396 * zeta - 816 * z2 + 480 * z3,
            L * (-12 + 78 * zeta - 144 * z2 + 80 * z3),
            32 - 192 * zeta + 192 * z2,
            L * (-16 + 192 * zeta - 480 * z2 + 320 * z3),
            14 - 204 * zeta + 624 * z2 - 480 * z3,
            L * (-2 + 30 * zeta - 96 * z2 + 80 * z3),
        ]
    ]
)


@cache
def printed_mass():
    return symmetric(
        [
            [
                *(R(523, 3465), R(19, 2310) * L, R(4, 63), -R(8, 693) * L),
                *(R(131, 6930), -R(29, 13860) * L),
            ],
            [R(2, 3465) * L**2, R(2, 315) * L, -(L**2) / 1155, R(29, 13860) * L, -(L**2) / 4620],
            [R(128, 315), 0, R(4, 63), -R(2, 315) * L],
            [R(32, 3465) * L**2, R(8, 693) * L, -(L**2) / 1155],
            [R(523, 3465), -R(19, 2310) * L],
            [R(2, 3465) * L**2],
        ]
    )


@cache
def printed_stiffness():
    return symmetric(
        [
            [
                *(R(5092, 35), R(1138, 35) * L, -R(512, 5), R(384, 7) * L),
                *(-R(1508, 35), R(242, 35) * L),
            ],
            [
                *(R(322, 35) * L**2, -R(128, 5) * L, R(64, 7) * L**2),
                *(-R(242, 35) * L, R(38, 35) * L**2),
            ],
            [R(1024, 5), 0, -R(512, 5), R(128, 5) * L],
            [R(256, 7) * L**2, -R(384, 7) * L, R(64, 7) * L**2],
            [R(5092, 35), -R(1138, 35) * L],
            [R(332, 35) * L**2],
        ]
    )


@establishes(
    "Aannaque",
    "A.1",
    printed=r"N^T = [1 - 23\zeta^2 + 66\zeta^3 - 68\zeta^4 + 24\zeta^5,\; "
    r"L(\zeta - 6\zeta^2 + 13\zeta^3 - 12\zeta^4 + 4\zeta^5),\; 16\zeta^2 - 32\zeta^3 + 16\zeta^4,"
    r"\; L(-8\zeta^2 + 32\zeta^3 - 40\zeta^4 + 16\zeta^5),\; 7\zeta^2 - 34\zeta^3 + 52\zeta^4 - "
    r"24\zeta^5,\; L(-\zeta^2 + 5\zeta^3 - 8\zeta^4 + 4\zeta^5)]",
    verdict="agrees",
    derived=lambda: letters(shape_rows("internal_node")[1]),
    remark="Deflection and rotation at the first end, in the middle, at the second end.",
)
@establishes(
    "Aannaque",
    "A.2",
    printed=r"B^T = [-46 + 396\zeta - 816\zeta^2 + 480\zeta^3,\; \dots]",
    verdict="slip",
    derived=r"B = \frac{d^2 N}{dx^2} = \frac{1}{L^2}\frac{d^2 N}{d\zeta^2}",
    remark="All six are second derivatives by zeta; by x, as the text has it, a factor 1/L^2 is "
    "missing: 9.3 for the coupler of 0.328 m. (A.4) has it.",
)
def test_shapes_of_the_element_with_an_inner_node():
    found = shape_rows("internal_node")[1]
    assert same(found, PRINTED_SHAPES)
    assert same(found.diff(zeta, 2), PRINTED_STRAINS)
    curvature = found.diff(zeta, 2) / L**2
    assert same(arrays("internal_node")["stiffness"], integral(curvature, EI * L))
    assert 9.25 < 0.328**-2 < 9.35


@establishes(
    "Aannaque",
    "A.3",
    printed=r"M = \rho AL\begin{bmatrix}\frac{523}{3465} & \frac{19L}{2310} & \frac{4}{63} & "
    r"\frac{-8L}{693} & \frac{131}{6930} & \frac{-29L}{13860}\\ & \frac{2L^2}{3465} & \dots"
    r"\end{bmatrix}",
    verdict="agrees",
    derived=lambda: letters(arrays("internal_node")["mass"]),
)
def test_mass_matrix_with_an_inner_node():
    assert same(arrays("internal_node")["mass"], rho * L * printed_mass())


@establishes(
    "Aannaque",
    "A.4",
    printed=r"K = \frac{EI}{L^3}\begin{bmatrix}\frac{5092}{35} & \dots\\ & \frac{322L^2}{35} & "
    r"\dots\\ & & & & & \frac{332L^2}{35}\end{bmatrix}",
    verdict="slip",
    derived=r"K_{22} = K_{66} = \frac{332}{35}\frac{EI}{L}",
    remark="Entry (2, 2) reads 322 for 332; the other 20 are right. By the printed matrix a rigid "
    "rotation stores -EI/(7 L) of strain energy per rotation squared, and the first frequency of a "
    "pinned beam falls from 9.8725 to 9.5705 (exact: 9.8696).",
)
def test_stiffness_matrix_with_an_inner_node():
    derived, printed = arrays("internal_node")["stiffness"], EI / L**3 * printed_stiffness()
    wrong = [
        (i, j) for i in range(6) for j in range(i, 6) if sp.simplify(derived[i, j] - printed[i, j])
    ]
    assert wrong == [(1, 1)]
    assert sp.simplify(derived[1, 1] - R(332, 35) * EI / L) == 0
    turned = sp.Matrix([0, 1, L / 2, 1, L, 1])
    assert (derived * turned).applyfunc(sp.simplify).is_zero_matrix
    assert sp.simplify((turned.T * printed * turned)[0] / 2 + EI / (7 * L)) == 0
    unit = {L: 1, EI: 1, rho: 1}
    held = [1, 2, 3, 5]
    mass = np.array((rho * L * printed_mass()).subs(unit).extract(held, held), dtype=float)
    lowest = [
        scipy.linalg.eigvalsh(np.array(k.subs(unit).extract(held, held), dtype=float), mass)[0]
        for k in (derived, printed)
    ]
    np.testing.assert_allclose(np.sqrt(lowest), (9.8725, 9.5705), atol=5e-5)


def lost(kind_at_middle):
    """Return the third shape's value and the curvature at its first end, on a unit length."""
    shape = kind_at_middle.subs(L, 1)
    return shape.subs(zeta, R(1, 2)), sp.diff(shape, zeta, 2).subs(zeta, 0)


_REPEATED = "Printed is the element with an inner node once more, to the letter."


@establishes(
    "Aannaque",
    "A.5",
    printed=r"N^T = [1 - 23\zeta^2 + 66\zeta^3 - 68\zeta^4 + 24\zeta^5,\; \dots]",
    verdict="slip",
    derived=lambda: letters(shape_rows("curvature")[1]),
    remark=_REPEATED + " Its first shape has the curvature -46/L^2 at the end where only the "
    "deflection is 1; that of the right one is 0.",
)
@establishes(
    "Aannaque",
    "A.6",
    printed=r"B^T = [-46 + 396\zeta - 816\zeta^2 + 480\zeta^3,\; \dots]",
    verdict="slip",
    derived=lambda: letters((shape_rows("curvature")[1].diff(zeta, 2) / L**2).applyfunc(sp.factor)),
    remark=_REPEATED + " Right: -60 zeta + 180 zeta^2 - 120 zeta^3 for the first, over L^2.",
)
def test_shapes_of_the_element_with_curvatures():
    found = shape_rows("curvature")[1]
    nodal = [(order, end) for end in (0, 1) for order in (0, 1, 2)]
    for row, (order, end) in enumerate(nodal):
        values = (found.diff(zeta, order) / L**order).subs(zeta, end)
        assert same(values, sp.eye(6)[row, :])
    assert PRINTED_STRAINS[0].subs(zeta, 0) == -46
    first = sp.expand(found[0].diff(zeta, 2))
    assert first == -60 * zeta + 180 * z2 - 120 * z3
    assert lost(PRINTED_SHAPES[2]) == (1, 32)
    assert lost(found[2]) == (R(1, 64), 1)


@establishes(
    "Aannaque",
    "A.7",
    printed=r"M = \rho AL\begin{bmatrix}\frac{523}{3465} & \dots\end{bmatrix}",
    verdict="slip",
    derived=lambda: letters(arrays("curvature")["mass"]),
    remark=_REPEATED + " Entry (1, 1) is 181/462, not 523/3465: 0.392 and 0.151.",
)
@establishes(
    "Aannaque",
    "A.8",
    printed=r"K = \frac{EI}{L^3}\begin{bmatrix}\frac{5092}{35} & \dots\end{bmatrix}",
    verdict="slip",
    derived=lambda: letters(arrays("curvature")["stiffness"]),
    remark=_REPEATED + " Entry (1, 1) is 120/7, not 5092/35: 17.1 and 145.5.",
)
def test_matrices_of_the_element_with_curvatures():
    """From the derived shapes by other integration; and they belong to the printed ones' space."""
    row = shape_rows("curvature")[1]
    mass, stiffness = (arrays("curvature")[name] for name in ("mass", "stiffness"))
    assert same(mass, integral(row, rho * L))
    assert same(stiffness, integral(row.diff(zeta, 2), EI / L**3))
    assert mass[0, 0] == R(181, 462) * rho * L
    assert stiffness[0, 0] == R(120, 7) * EI / L**3
    change = sp.Matrix(
        [
            [(shape / L**k).subs(zeta, at) for shape in row.diff(zeta, k)]
            for at in (0, R(1, 2), 1)
            for k in (0, 1)
        ]
    )
    assert same(change.T * printed_mass() * change * rho * L, mass)
    mended = printed_stiffness().copy()
    mended[1, 1] = R(332, 35) * L**2
    assert same(change.T * mended * change * EI / L**3, stiffness)


def test_emitted_elements_hold_the_same_numbers():
    """The slips are not in the package: a pinned beam of one element, within 0.03 %."""
    for kind in ("internal_node", "curvature"):
        found = element_arrays(
            kind, length=1.0, mass_per_length=1.0, axial_stiffness=1.0, bending_stiffness=1.0
        )
        kept = [i for i in range(8) if i not in (0, 1, 3, 4)]
        lowest = scipy.linalg.eigvalsh(
            found.stiffness[np.ix_(kept, kept)], found.mass[np.ix_(kept, kept)]
        )[0]
        assert abs(np.sqrt(lowest) / float(mpmath.pi**2) - 1) < 3e-4
