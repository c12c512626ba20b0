"""Aannaque (4.1)-(4.14): shape functions, Hamilton's principle, strain energy, stiffness."""

import sympy as sp
from elastolink.derive.models import beam_elements as elements
from elastolink.derive.models.beam_shapes import t, u, v
from elastolink.derive.variational import hamilton
from seed_elements import EA, EI, L, arrays, integral, letters, same, shape_rows, symmetric, x, zeta
from seed_ledger import establishes

AXIAL, BENT = slice(0, 2), slice(2, 6)
PRINTED_CUBICS = sp.Matrix(
    [
        [
            1 - 3 * zeta**2 + 2 * zeta**3,
            L * (zeta - 2 * zeta**2 + zeta**3),
            3 * zeta**2 - 2 * zeta**3,
            L * (-(zeta**2) + zeta**3),
        ]
    ]
)


def by_x(row, order=1):
    return row.diff(zeta, order) / L**order


@establishes(
    "Aannaque",
    "4.1",
    printed=r"u(x) = \sum_{i=1}^{n} a_i x^{i-1}",
    verdict="agrees",
    derived=r"\text{as many coefficients as nodal values, and these determine them}",
)
@establishes(
    "Aannaque",
    "4.2",
    printed=r"u(x) = a_1 + a_2 x",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.5",
    printed=r"v(x) = a_3 + a_4 x + a_5 x^2 + a_6 x^3",
    verdict="agrees",
)
def test_polynomials_are_determined_by_the_nodal_values():
    """One polynomial for any nodal values; and static solutions without load are such."""
    for count, conditions in ((2, [(0, 0), (0, 1)]), (4, [(k, e) for e in (0, 1) for k in (0, 1)])):
        a = sp.symbols(f"a1:{count + 1}")
        trial = sum(c * x**i for i, c in enumerate(a))
        rows = [sp.diff(trial, x, order).subs(x, end * L) for order, end in conditions]
        matrix = sp.Matrix([[sp.diff(row, c) for c in a] for row in rows])
        assert sp.simplify(matrix.det()) != 0
    equations = hamilton(elements.beam_action("cubic")).equations
    still = {elements.turn: 0, **dict.fromkeys((*elements.forces, *elements.loads), 0)}
    a = sp.symbols("a1:7")
    stretched, bent = a[0] + a[1] * x, sum(c * x**i for i, c in enumerate(a[2:]))
    for item in (u, v):
        assert (
            sp.expand(equations[item].subs({u: stretched, v: bent}).doit().subs(still).doit()) == 0
        )
    assert t not in stretched.free_symbols


@establishes(
    "Aannaque",
    "4.3",
    printed=r"u = [1 - \xi \quad \xi]\,q_1,\; \xi = x/L",
    verdict="agrees",
    derived=lambda: letters(shape_rows("cubic")[0][:, AXIAL]),
)
@establishes(
    "Aannaque",
    "4.4",
    printed=r"\varepsilon = B_1 q_1,\; B_1 = \frac{1}{L}[-1 \quad 1]",
    verdict="agrees",
    derived=lambda: letters(by_x(shape_rows("cubic")[0][:, AXIAL])),
)
@establishes(
    "Aannaque",
    "4.6",
    printed=r"v(x) = N_2(x)\,q_2",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.2.1 cubic shape functions",
    printed=r"[1 - 3\xi^2 + 2\xi^3 \quad L(\xi - 2\xi^2 + \xi^3) \quad 3\xi^2 - 2\xi^3 \quad "
    r"L(-\xi^2 + \xi^3)]",
    verdict="agrees",
    derived=lambda: letters(shape_rows("cubic")[1][:, BENT]),
)
def test_linear_and_cubic_shapes():
    along, across = shape_rows("cubic")
    assert same(along, [[1 - zeta, zeta, 0, 0, 0, 0]])
    assert same(by_x(along)[:, AXIAL], sp.Matrix([[-1, 1]]) / L)
    assert same(across[:, BENT], PRINTED_CUBICS)
    assert same(across[:, AXIAL], [[0, 0]])


@establishes(
    "Aannaque",
    "4.7",
    printed=r"\delta\int_{t_1}^{t_2}(T - U)\,dt = 0,\; \delta q(t_1) = \delta q(t_2) = 0",
    verdict="agrees",
    remark="U holds the potential of external forces; others add their virtual work.",
)
def test_hamiltons_principle_gives_the_known_equations_of_rod_and_beam():
    """A frame at rest, no axial force: the wave equation and the beam equation with loads."""
    action = elements.beam_action("cubic")
    found = hamilton(action).equations
    rest = {elements.turn: 0, **dict.fromkeys(elements.forces, 0)}
    rho, s = elements.density, x / L
    load = dict(zip(("px1", "px2", "py1", "py2"), elements.loads, strict=True))
    rod = EA * u.diff(x, 2) - rho * u.diff(t, 2) + load["px1"] * (1 - s) + load["px2"] * s
    beam = -EI * v.diff(x, 4) - rho * v.diff(t, 2) + load["py1"] * (1 - s) + load["py2"] * s
    assert sp.simplify(found[u].subs(rest).doit() - rod) == 0
    assert sp.simplify(found[v].subs(rest).doit() - beam) == 0


@establishes(
    "Aannaque",
    "4.8",
    printed=r"U_{int} = \frac12\int_0^L EA\,u_x^2\,dx + \frac12\int_0^L EI_z\,v_{xx}^2\,dx",
    verdict="agrees",
    remark="Without shear and without the axial force's work, which 4.2.6 adds.",
)
@establishes(
    "Aannaque",
    "4.9",
    printed=r"U_{int} = \frac12 q_1^T\left(\int EA\,B_1^T B_1 dx\right)q_1 + "
    r"\frac12 q_2^T\left(\int EI_z B_2^T B_2 dx\right)q_2",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.10",
    printed=r"v_{xx} = N_2''(x)\,q_2 = B_2 q_2",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "4.11",
    printed=r"K_1 = \int_0^L EA\,B_1^T B_1\,dx,\; K_2 = \int_0^L EI_z B_2^T B_2\,dx",
    verdict="agrees",
)
def test_stiffness_is_the_energy_of_the_strains():
    along, across = shape_rows("cubic")
    stiffness = arrays("cubic")["stiffness"]
    first, second = by_x(along)[:, AXIAL], by_x(across, 2)[:, BENT]
    assert same(stiffness[AXIAL, AXIAL], integral(first, EA * L))
    assert same(stiffness[BENT, BENT], integral(second, EI * L))
    q = sp.Matrix(sp.symbols("q1:7"))
    stretch, bend = (by_x(along) * q)[0], (by_x(across, 2) * q)[0]
    stored = (integral(sp.Matrix([[stretch]]), EA * L) + integral(sp.Matrix([[bend]]), EI * L))[
        0
    ] / 2
    assert sp.simplify(stored - (q.T * stiffness * q)[0] / 2) == 0


@establishes(
    "Aannaque",
    "4.12",
    printed=r"K_1 = \frac{EA}{\;}\begin{bmatrix}1 & -1\\-1 & 1\end{bmatrix}",
    verdict="not legible",
    derived=lambda: letters(arrays("cubic")["stiffness"][AXIAL, AXIAL]),
    remark="The scan has a fraction bar and no denominator; L belongs there.",
)
@establishes(
    "Aannaque",
    "4.13",
    printed=r"K_2 = \frac{EI_z}{L^3}\begin{bmatrix}12 & 6L & -12 & 6L\\ & 4L^2 & -6L & 2L^2\\ "
    r"& & 12 & -6L\\ & & & 4L^2\end{bmatrix}",
    verdict="agrees",
    derived=lambda: letters(arrays("cubic")["stiffness"][BENT, BENT]),
)
@establishes(
    "Aannaque",
    "4.14",
    printed=r"K = \begin{bmatrix}K_1 & \\ & K_2\end{bmatrix}",
    verdict="agrees",
    remark="The scan shows the blocks one above the other. Both axial displacements come first.",
)
def test_stiffness_matrices():
    stiffness = arrays("cubic")["stiffness"]
    assert same(stiffness[AXIAL, AXIAL], EA / L * sp.Matrix([[1, -1], [-1, 1]]))
    printed = symmetric(
        [[12, 6 * L, -12, 6 * L], [4 * L**2, -6 * L, 2 * L**2], [12, -6 * L], [4 * L**2]]
    )
    assert same(stiffness[BENT, BENT], EI / L**3 * printed)
    assert stiffness[AXIAL, BENT].is_zero_matrix
