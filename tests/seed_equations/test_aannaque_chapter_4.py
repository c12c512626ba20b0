"""Aannaque chapter 4 and appendix A: beam elements at rest and moving, assembled, stiffened."""

from functools import cache

import numpy as np
import pytest
import scipy.linalg
import sympy as sp
from beam_reference import rigid_field
from elastolink.derive.models import beam_elements as elements
from elastolink.derive.models import beam_shapes
from elastolink.derive.models.beam_shapes import t, u, v
from elastolink.derive.variational import hamilton
from elastolink.generated import beam_shapes_cubic
from elastolink.runtime.beams.elements import element_arrays
from elastolink.runtime.core.families.emitted import array_function
from elastolink.runtime.linkages import FourBar
from scipy.integrate import solve_ivp
from seed_ledger import Ledger, by_differences, hold, holds, point_by_point, quoted, same

row = Ledger("Aannaque", __file__)
x, L = beam_shapes.x, beam_shapes.length
zeta = sp.Symbol("zeta", real=True)
rho, EA, EI = elements.density, elements.axial, beam_shapes.bending
# Axial displacements first, then deflection and rotation node by node; the inner node between.
ORDERS = {
    "cubic": ("u1", "u2", "v1", "r1", "v2", "r2"),
    "internal_node": ("v1", "r1", "v3", "r3", "v2", "r2"),
    "curvature": ("v1", "r1", "k1", "v2", "r2", "k2"),
}


@cache
def places(kind: str) -> list[int]:
    """Return where the document's nodal values stand among those of the element."""
    labels = [value.label for value in beam_shapes.nodal_values(kind)]
    return [labels.index(name) for name in ORDERS[kind]]


@cache
def shape_rows(kind: str) -> tuple[sp.Matrix, sp.Matrix]:
    """Return the derived shapes of u and v as rows, functions of zeta, in the document's order."""
    found = beam_shapes.field_shapes(kind)
    rows = []
    for item in (beam_shapes.u, beam_shapes.v):
        values = [sp.expand(sp.sympify(e).subs(x, zeta * L)) for e in found[item]]
        rows.append(sp.Matrix([[values[i] for i in places(kind)]]))
    return rows[0], rows[1]


def integral(row: sp.Matrix, factor: sp.Expr) -> sp.Matrix:
    """Return ``int_0^1 factor row^T row dzeta`` of a row of polynomials."""

    def moments(product: sp.Expr) -> sp.Expr:
        powers = sp.Poly(product, zeta).all_coeffs()[::-1]
        return factor * sp.Add(*(c / (k + 1) for k, c in enumerate(powers)))

    return (row.T * row).applyfunc(moments)


@cache
def arrays(kind: str) -> dict[str, sp.Matrix]:
    """Return the matrices by name: energies of the derived shapes."""
    along, across = shape_rows(kind)
    strains = [row.diff(zeta, k) / L**k for row, k in ((along, 1), (across, 2), (across, 1))]
    return {
        "mass": integral(along, rho * L) + integral(across, rho * L),
        "stiffness": integral(strains[0], EA * L) + integral(strains[1], EI * L),
        "geometric_0": integral(strains[2], L),
    }


def letters(expression: object) -> str:
    """Return LaTeX with the document's letters."""
    names = {L: "L", rho: r"\rho A", EA: "EA", EI: "EI"}
    names = {symbol: sp.Symbol(name) for symbol, name in names.items()}
    return sp.latex(sp.sympify(expression).subs(names))


AXIAL, BENT = slice(0, 2), slice(2, 6)
SIZES = {L: 0.4, EA: 1.9, EI: 2.3, rho: 0.7}
LENGTH, DENSITY = SIZES[L], SIZES[rho]


@cache
def derived(kind):
    """Return the derived matrices in numbers, and the rows of shapes as functions of the place.

    ``("v", 2)`` is the second derivative by x of the row of v.
    """
    forms = arrays(kind)
    numbers = {k: np.array(forms[k].subs(SIZES), dtype=float) for k in ("mass", "stiffness")}
    for name, part in zip("uv", shape_rows(kind), strict=True):
        for order in range(3):
            form = part.diff(zeta, order) / L**order if order else part
            function = sp.lambdify(zeta, form.subs(SIZES))
            numbers[name, order] = lambda s, f=function: np.array(f(s / LENGTH), dtype=float)
    return numbers


@cache
def cubic():
    """Return places of a beam in the document's letters, for free nodal values."""
    d, q = derived("cubic"), np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.7])
    stiffness = d["stiffness"]
    common = {
        "u_x": lambda s: (d["u", 1](s) @ q)[0],
        "v": lambda s: (d["v", 0](s) @ q)[0],
        "v_xx": lambda s: (d["v", 2](s) @ q)[0],
        "B1": lambda s: d["u", 1](s)[:, AXIAL],
        "B2": lambda s: d["v", 2](s)[:, BENT],
        "N2": lambda s: d["v", 0](s)[:, BENT],
        "N2_pp": lambda s: d["v", 2](s)[:, BENT],
        **{"K": stiffness, "K1": stiffness[AXIAL, AXIAL], "K2": stiffness[BENT, BENT]},
        **{"q1": q[AXIAL], "q2": q[BENT], "U_int": q @ stiffness @ q / 2, "Int": point_by_point},
        **{"L": LENGTH, "EA": SIZES[EA], "EI_z": SIZES[EI]},
    }
    there = [
        {"x": s, "u": (d["u", 0](s) @ q)[0], "eps": (d["u", 1](s) @ q)[0]} for s in (0.1, 0.33)
    ]
    return [common | place for place in there]


def polynomial(count, item, first=1):
    """Return the check of a polynomial: determined by the nodal values, and a solution at rest."""

    def check(entry):
        a = sp.symbols(f"a{first}:{first + count}")
        names = {f"a{k}": c for k, c in enumerate(a, first)} | {"a": dict(enumerate(a, 1))}
        trial = entry.printed.value(**names, n=sp.Integer(count), x=x)
        same(trial, sum(c * x**k for k, c in enumerate(a)))
        ends = [sp.diff(trial, x, k).subs(x, e * L) for e in (0, 1) for k in range(count // 2)]
        assert sp.simplify(sp.Matrix(ends).jacobian(a).det()) != 0
        still = {elements.turn: 0, **dict.fromkeys((*elements.forces, *elements.loads), 0)}
        values = {u: trial, v: 0} if item is u else {u: 0, v: trial}
        equation = hamilton(elements.beam_action("cubic")).equations[item]
        assert sp.expand(equation.subs(values).doit().subs(still).doit()) == 0

    return check


def shape_check(kind, columns=slice(None), order=0):
    """Return the check of printed shapes or their second derivatives, functions of zeta."""

    def check(entry):
        for s in (0.1, 0.3, 0.85):
            true = derived(kind)["v", order](s * LENGTH)[0, columns] * LENGTH**order
            same(np.ravel(entry.printed.value(L=LENGTH, zeta=s, xi=s, N_T=0, B_T=0)), true, 1e-9)

    return check


def latex_of(kind, name, rows=slice(None), columns=slice(None)):
    """Return what shows a derived matrix."""
    return lambda: letters(arrays(kind)[name][rows, columns])


row("4.1", "4.2", check=polynomial(2, u))
row("4.5", check=polynomial(4, v, first=3))
row("4.3", derived=lambda: letters(shape_rows("cubic")[0][:, AXIAL]), check=holds(cubic))


@row("4.4", derived=lambda: letters(shape_rows("cubic")[0][:, AXIAL].diff(zeta) / L))
def strain(entry):
    hold(entry.printed, *({k: v for k, v in p.items() if k != "B1"} for p in cubic()))


row("4.6", "4.8", "4.9", "4.11", "4.14", check=holds(cubic))


@row("4.10")
def curvature(entry):
    there = [{**p, **{k: p[k](p["x"]) for k in ("B2", "v_xx")}} for p in cubic()]
    hold(entry.printed, *there)


row(
    "4.2.1 cubic shape functions",
    derived=lambda: letters(shape_rows("cubic")[1][:, BENT]),
    check=shape_check("cubic", BENT),
)


@row("4.7")
def hamiltons_principle(_):
    """A frame at rest, no axial force: the wave equation and the beam equation with loads."""
    found = hamilton(elements.beam_action("cubic")).equations
    rest = {elements.turn: 0, **dict.fromkeys(elements.forces, 0)}
    s, loads = x / L, dict(zip(("px1", "px2", "py1", "py2"), elements.loads, strict=True))
    rod = EA * u.diff(x, 2) - rho * u.diff(t, 2) + loads["px1"] * (1 - s) + loads["px2"] * s
    beam = -EI * v.diff(x, 4) - rho * v.diff(t, 2) + loads["py1"] * (1 - s) + loads["py2"] * s
    assert sp.simplify(found[u].subs(rest).doit() - rod) == 0
    assert sp.simplify(found[v].subs(rest).doit() - beam) == 0


@row("4.12", derived=latex_of("cubic", "stiffness", AXIAL, AXIAL))
def lost_denominator(entry):
    hold(entry.printed, *({**point, "hole": LENGTH} for point in cubic()))


row("4.13", derived=latex_of("cubic", "stiffness", BENT, BENT), check=holds(cubic))

# Appendix A: the elements of the p-version.


def matrix(entry):
    """Return a printed matrix at the sizes of the test."""
    return entry.printed.value(L=LENGTH, rhoA=SIZES[rho], EI=SIZES[EI])


row(
    "A.1",
    derived=lambda: letters(shape_rows("internal_node")[1]),
    check=shape_check("internal_node"),
)


@row("A.2")
def strains_by_zeta(entry):
    shape_check("internal_node", order=2)(entry)
    quoted([0.328**-2], "9.3")


@row("A.3", derived=latex_of("internal_node", "mass"))
def mass_with_an_inner_node(entry):
    same(matrix(entry), derived("internal_node")["mass"], 1e-9)


@row("A.4")
def stiffness_with_an_inner_node(entry):
    true, printed = derived("internal_node")["stiffness"], matrix(entry)
    wrong = np.argwhere(np.abs(printed - true) > 1e-9 * np.abs(true).max())
    assert wrong.tolist() == [[1, 1]]
    hold(entry.corrected, {"EI": SIZES[EI], "L": LENGTH, "K_22": true[1, 1], "K_66": true[5, 5]})
    turned = np.array([0, 1, LENGTH / 2, 1, LENGTH, 1])
    assert turned @ printed @ turned / 2 == pytest.approx(-SIZES[EI] / (7 * LENGTH))
    kept, unit = np.ix_([1, 2, 3, 5], [1, 2, 3, 5]), {L: 1, EI: 1, rho: 1}
    mass, right = (
        np.array(arrays("internal_node")[k].subs(unit), dtype=float) for k in ("mass", "stiffness")
    )
    both = (right, entry.printed.value(L=1, EI=1))
    squares = [scipy.linalg.eigvalsh(stiffness[kept], mass[kept])[0] for stiffness in both]
    quoted(np.sqrt(squares), "9.8725", "9.5705")


def curvatures(name, quotes=()):
    """Return the check of a repeated form: the one before to the letter, so not the right one.

    ``quotes`` are entry (1, 1) of the right and of the printed matrix without L, rho A and EI.
    """

    def check(entry):
        before = {"A.5": "A.1", "A.6": "A.2", "A.7": "A.3", "A.8": "A.4"}[entry.label]
        assert str(entry.printed) == str(row.cell(before))
        if quotes:
            unit = entry.printed.value(L=1, rhoA=1, EI=1)[0, 0]
            right = arrays("curvature")[name].subs({L: 1, EI: 1, rho: 1})[0, 0]
            quoted([right, unit], *quotes)

    return check


row("A.5", check=curvatures("v"), derived=lambda: letters(shape_rows("curvature")[1]))
row(
    "A.6",
    check=curvatures("v"),
    derived=lambda: letters((shape_rows("curvature")[1].diff(zeta, 2) / L**2).applyfunc(sp.factor)),
)
row("A.7", check=curvatures("mass", ("0.392", "0.151")), derived=latex_of("curvature", "mass"))
row(
    "A.8",
    check=curvatures("stiffness", ("17.1", "145.5")),
    derived=latex_of("curvature", "stiffness"),
)


STIFFNESSES = {"axial_stiffness": 2e5, "bending_stiffness": 9.0}
ELEMENT = element_arrays("cubic", length=LENGTH, mass_per_length=DENSITY, **STIFFNESSES)
J = np.array([[0.0, -1.0], [1.0, 0.0]])
# The document's order: both axial displacements first.
ORDER = np.array([0, 3, 1, 2, 4, 5])
TIME = 0.37


def turn(angle):
    """Return T of (4.15): components along and across the element to those along X and Y."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def rotation(angle):
    """Return R of (4.26), nodal values in the element's own order: ground to local."""
    whole = np.eye(6)
    for node in (0, 3):
        whole[node : node + 2, node : node + 2] = turn(angle).T
    return whole


def shapes(place):
    """Return N at a place, shape (2, 6)."""
    found = array_function(beam_shapes_cubic, "shapes")(place / LENGTH, LENGTH)
    return np.concatenate([found["u"], found["v"]])


def path(t):
    """Return origin, angle and local nodal values at a time: any smooth functions."""
    origin = np.array([0.3 * np.sin(2 * t), 0.2 * np.cos(3 * t)])
    angle = 0.4 + 1.1 * t + 0.3 * np.sin(1.7 * t)
    return origin, angle, 1e-2 * np.sin(np.arange(1, 7) + np.arange(2, 8) * t)


def derivative(function, t=TIME, order=1):
    """Return a derivative by the time."""
    return by_differences(function, t, order)


def still(place, t):
    """Return the ground position of a point of the undeformed element."""
    origin, angle, _ = path(t)
    return origin + turn(angle) @ [place, 0.0]


def position(place, t):
    """Return the ground position of a point of the element."""
    _, angle, q = path(t)
    return still(place, t) + turn(angle) @ (shapes(place) @ q)


def rigid(t, order):
    """Return nodal values of the rigid velocity or acceleration, components along the element."""
    _, angle, _ = path(t)
    ends = [turn(angle).T @ derivative(lambda s, a=a: still(a, s), t, order) for a in (0.0, LENGTH)]
    return rigid_field("cubic", *ends, derivative(lambda s: path(s)[1], t, order))


@cache
def moving():
    """Return the moving element in the document's letters, all rates by differences."""
    _, angle, q = path(TIME)
    T = turn(angle)
    T_dot, T_ddot = (derivative(lambda s: turn(path(s)[1]), TIME, k) for k in (1, 2))
    w, wd = (derivative(lambda s: path(s)[1], TIME, k) for k in (1, 2))
    q_dot, q_ddot = (derivative(lambda s: path(s)[2], TIME, k) for k in (1, 2))
    m, c = ELEMENT.mass, ELEMENT.coupling
    velocity, acceleration = rigid(TIME, 1), rigid(TIME, 2)

    def ground_speed(place):
        return derivative(lambda s: position(place, s))

    def push(place):
        force = T.T @ derivative(lambda s: position(place, s), TIME, 2)
        return DENSITY * force @ shapes(place)

    names = {"T": T, "T_dot": T_dot, "T_ddot": T_ddot, "N": shapes, "rhoA": DENSITY, "L": LENGTH}
    names |= {"q": q, "q_dot": q_dot, "q_ddot": q_ddot, "theta": angle, "Int": point_by_point}
    names |= {"qr_dot": velocity, "a_r": acceleration, "r_dot": ground_speed}
    names["K"] = ELEMENT.stiffness
    names |= {"M": m, "M_c": w * c, "M_a": wd * c - w**2 * m, "theta_dot": w, "theta_ddot": wd}
    names |= {"qr_ddot": derivative(lambda s: rigid(s, 1))}
    names |= {"p": point_by_point(push, 0.0, LENGTH, False) + ELEMENT.stiffness @ q}
    speed = point_by_point(lambda s: ground_speed(s) @ ground_speed(s), 0.0, LENGTH, False)
    return names | {"E_kin": DENSITY * speed / 2}


@cache
def points():
    """Return points of the element, where d is the vector from the moving origin."""
    found = []
    for place in (0.1, 0.33):
        rigid_speed = derivative(lambda s, a=place: still(a, s))
        d, d_dot = (shapes(place) @ moving()[name] for name in ("q", "q_dot"))
        values = {"r": position(place, TIME), "r0": still(place, TIME), "r0_dot": rigid_speed}
        values |= {"r_dot": moving()["r_dot"](place), "d": d, "d_dot": d_dot, "N": shapes(place)}
        found.append({**moving(), **values})
    return found


row("4.15", "4.16", "4.17", "4.18", check=holds(points, tol=1e-8))
row("4.19", check=holds(lambda: [moving()], tol=1e-8))
row("4.22", check=holds(lambda: [moving()], tol=1e-7))


@row("4.20")
def kinetic_energy_has_six_terms(entry):
    hold(entry.corrected, moving(), tol=1e-8)
    quoted([entry.printed.value(**moving()) / moving()["E_kin"]], "0.7832")


@row("4.21")
def equation_of_the_moving_element(entry):
    p = moving()
    hold(entry.corrected, p, tol=1e-7)
    hold(entry.printed, {**p, "qr_ddot": p["a_r"]}, tol=1e-7)
    lost = p["M"] @ (p["qr_ddot"] - p["a_r"])
    assert np.linalg.norm(lost) > 0.05 * np.linalg.norm(p["M"] @ p["a_r"])
    # The bar of the remark: constant local velocities, yet an acceleration towards its end.
    steady = rigid_field("cubic", [0.0, 0.0], [-1.0, 0.0], 0.0)
    assert (ELEMENT.mass @ steady)[3] == pytest.approx(-DENSITY * LENGTH / 3)


def consistent():
    """Return the mass matrix of the cubic element in the document's order."""
    mass = ELEMENT.mass[np.ix_(ORDER, ORDER)]
    return {"M": mass, "M1": mass[:2, :2], "M2": mass[2:, 2:], "rhoA": DENSITY, "L": LENGTH}


row("4.23", "4.24", check=holds(lambda: [consistent()]))


@row("4.25")
def change_of_axes(entry):
    """A vector of length 2 along the element, and one across."""
    c, s = np.cos(0.7), np.sin(0.7)
    hold(entry.printed, {"theta": 0.7, "x_e": 2.0, "y_e": 0.0, "X": 2 * c, "Y": 2 * s})
    hold(entry.printed, {"theta": 0.7, "x_e": 0.0, "y_e": 3.0, "X": -3 * s, "Y": 3 * c})


@row("4.26")
def rotation_of_the_element(entry):
    """Nodal values of a vector field that turns with the element."""
    q_g = np.random.default_rng(1).normal(size=6)
    q = (rotation(0.7) @ q_g)[ORDER]
    hold(entry.printed, {"theta": 0.7, "q_g": q_g[ORDER], "q": q})


@cache
def grounded():
    """Return the same motion along fixed axes, its ground values differentiated as they are."""
    R = rotation(path(TIME)[1])
    R_dot, R_ddot = (derivative(lambda s: rotation(path(s)[1]), TIME, k) for k in (1, 2))

    def values(t):
        return rotation(path(t)[1]).T @ path(t)[2]

    def undeformed(t):
        angle = path(t)[1]
        return np.concatenate([still(0.0, t), [angle], still(LENGTH, t), [angle]])

    names = {"R": R, "R_dot": R_dot, "R_ddot": R_ddot, "q_g": values(TIME)}
    names |= {"q_g_dot": derivative(values), "q_g_ddot": derivative(values, TIME, 2)}
    names |= {"qgr_ddot": derivative(undeformed, TIME, 2), "p_g": R.T @ moving()["p"]}
    names |= {k: moving()[k] for k in ("M", "K", "M_c", "M_a")}
    return names | row.cell("4.28").values(**names)


row("4.27", check=holds(lambda: [grounded()], tol=1e-7))


@row("4.28")
def matrices_along_fixed_axes(entry):
    """From the energy: G = M' + A - A^T with A = R^T M R' + R^T W R, and what is left of (4.27)."""
    p = grounded()
    energy = p["R"].T @ p["M"] @ p["R_dot"] + p["R"].T @ p["M_c"] @ p["R"]
    slope = p["R_dot"].T @ p["M"] @ p["R"] + p["R"].T @ p["M"] @ p["R_dot"]
    given = {k: v for k, v in p.items() if k not in ("M_g", "K_g", "M_gc", "M_ga")}
    values = entry.printed.values(**given)
    same(values["M_gc"], slope + energy - energy.T, 1e-8)
    hold(row.cell("4.27"), {**given, **values}, tol=1e-7)
    stretched = p["R"].T @ ELEMENT.stiffness @ p["R"]
    same(values["K_g"], stretched)


@cache
def two_bars():
    """Return two bars at +-45 degrees pinned to each other, held at their feet but free to turn.

    Shared: x, y of the tip; own rotations at the feet and at the tip.
    """
    angles = (np.pi / 4, 3 * np.pi / 4)
    columns = [{2: 2, 3: 0, 4: 1, 5: 3}, {2: 4, 3: 0, 4: 1, 5: 5}]
    q = np.random.default_rng(3).normal(size=6)
    selectors, masses, stiffnesses, places = {}, {}, {}, []
    for e, (angle, chosen) in enumerate(zip(angles, columns, strict=True), 1):
        selectors[e] = np.zeros((6, 6))
        for line, column in chosen.items():
            selectors[e][line, column] = 1.0
        r = rotation(angle)
        masses[e], stiffnesses[e] = (r.T @ k @ r for k in (ELEMENT.mass, ELEMENT.stiffness))
        places.append(np.array([0.0 if k not in chosen else q[chosen[k]] for k in range(6)]))
    local = [rotation(angle) @ place for angle, place in zip(angles, places, strict=True)]
    energies = [sum(v @ k @ v for v in local) for k in (ELEMENT.mass, ELEMENT.stiffness)]
    return {"L_e": selectors, "M_e": masses, "K_e": stiffnesses, "q": q, "n": 2}, places, energies


@row("4.29")
def shared_displacements(entry):
    names, places, _ = two_bars()
    for e, place in enumerate(places, 1):
        hold(entry.printed, {"L_e": names["L_e"][e], "q": names["q"], "q_e": place})


@row("4.30")
def assembly(entry):
    """Energies add up."""
    names, _, energies = two_bars()
    gyroscopic = {"M_ce": names["K_e"], "M_ae": names["M_e"]}
    found = entry.printed.values(**names, **gyroscopic)
    q = names["q"]
    same([found["M_c"], found["M_a"]], [found["K"], found["M"]])
    np.testing.assert_allclose([q @ found[k] @ q for k in ("M", "K")], energies, rtol=1e-12)


def whole():
    """Return the single element as a mechanism: forces from outside alone, (4.28) its matrices."""
    p = grounded()
    names = {"M": p["M_g"], "K": p["K_g"], "M_c": p["M_gc"], "M_a": p["M_ga"], "p_ext": p["p_g"]}
    names |= {"q": p["q_g"], "q_dot": p["q_g_dot"], "q_ddot": p["q_g_ddot"]}
    return names | {"qr_ddot": p["qgr_ddot"]}


row("4.31", check=holds(lambda: [whole()], tol=1e-7))


@row("2.1")
def equation_of_a_mechanism(entry):
    """That of a single element, with damping and forces that balance it."""
    p, C = whole(), np.random.default_rng(4).normal(size=(6, 6))
    hold(entry.printed, {**p, "C": C, "p": p["p_ext"] + C @ p["q_dot"]}, tol=1e-7)


# Table 4.1: the follower, 0.525 m; its first frequency pinned at both ends, 168 rad/s.
FOLLOWER = {"mass": 7850.0 * 78.75e-6, "bending": 210e9 * 65.12e-12, "length": 0.525}
LINKAGE = FourBar(frame=0.547, crank=0.170, coupler=0.328, follower=0.525)
SPEED = 62.0


@cache
def follower():
    """Return the follower's first frequency, largest speed and acceleration at 62 rad/s."""
    motion = LINKAGE.motion(np.linspace(0.0, 2 * np.pi, 721))
    wave = np.pi / FOLLOWER["length"]
    frequency = wave**2 * np.sqrt(FOLLOWER["bending"] / FOLLOWER["mass"])
    rates = np.abs(motion.omega4).max(), np.abs(motion.alpha4).max()
    return frequency, SPEED * rates[0], SPEED**2 * rates[1]


@cache
def pinned(count, *names):
    """Return arrays of a pinned beam without stretch, of unit length, mass and stiffness."""
    unit = {"mass_per_length": 1.0, "axial_stiffness": 1.0, "bending_stiffness": 1.0}
    found = element_arrays("cubic", length=1.0 / count, **unit)
    whole = np.zeros((len(names), 2 * count + 2, 2 * count + 2))
    bent = np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    for e in range(count):
        at = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
        for array, name in zip(whole, names, strict=True):
            array[at] += getattr(found, name).reshape(-1, 6, 6)[0][bent]
    kept = [i for i in range(2 * count + 2) if i not in (0, 2 * count)]
    return [array[np.ix_(kept, kept)] for array in whole]


@row("4.32")
def terms_on_the_right_side_are_not_known(entry):
    p = whole()
    known = p["p_ext"] - p["M"] @ p["qr_ddot"] - p["M_c"] @ p["q_dot"] - p["M_a"] @ p["q"]
    damped = {**p, "C": 0.1 * p["M"], "f_p": known + 0.1 * p["M"] @ p["q_dot"]}
    hold(entry.printed, damped, tol=1e-7)
    frequency, speed, rate = follower()
    assert [frequency, speed, rate] == pytest.approx([168.4, 28.07, 2360.0], rel=0.01)
    # M_a = wd W - w^2 M: in a mode, w^2 M over K is (w/omega)^2.
    assert (speed / frequency) ** 2 == pytest.approx(0.0278, rel=0.02)


SPIN = 0.2
SQUARES = np.array([1.0, 9.0])


def modes(t):
    """Return the modes of two springs, 1 and 9, whose axes turn at the rate SPIN."""
    return turn(SPIN * t)


@cache
def springs(t=0.7):
    """Return a motion of unit mass on the turning springs, seen from the ground and in modes."""
    phi, phi_dot = modes(t), SPIN * modes(t) @ J
    q, q_dot = np.array([1.0, 0.3]), np.array([0.2, -0.1])
    M, C = np.eye(2), np.array([[0.03, 0.01], [0.01, 0.05]])
    K = phi @ np.diag(SQUARES) @ phi.T
    f = np.array([0.4, -0.6])
    eta = phi.T @ q
    eta_dot = phi.T @ (q_dot - phi_dot @ eta)
    q_ddot = f - C @ q_dot - K @ q
    phi_ddot = SPIN**2 * phi @ J @ J
    eta_ddot = phi.T @ (q_ddot - 2 * phi_dot @ eta_dot - phi_ddot @ eta)
    names = {"q": q, "q_dot": q_dot, "q_ddot": q_ddot, "M": M, "C": C, "K": K, "f_p": f}
    names |= {"Phi": phi, "Phi_dot": phi_dot, "Phi_ddot": phi_ddot, "Omega": np.diag(SQUARES)}
    return names | {"eta": eta, "eta_dot": eta_dot, "eta_ddot": eta_ddot}


row("4.33", check=holds(lambda: [springs()]))


@row("4.34")
def rates_of_modal_coordinates(entry):
    hold(entry.corrected, springs())
    constant = {"Phi_dot": np.zeros((2, 2)), "Phi_ddot": np.zeros((2, 2))}
    still = {**springs(), **constant}
    still |= {"q_dot": still["Phi"] @ still["eta_dot"], "q_ddot": still["Phi"] @ still["eta_ddot"]}
    hold(entry.printed, still)
    frequency, speed, _ = follower()
    assert speed / frequency == pytest.approx(0.1667, rel=0.02)


@row("4.35")
def modal_equation_of_a_structure_that_turns(entry):
    """Each equation is solved for the acceleration and run for a turn of the springs."""
    hold(entry.corrected, springs())
    names = {**springs(), "C": np.zeros((2, 2)), "f_p": np.zeros(2)}
    still = {**springs(), "eta_ddot": springs()["eta_ddot"]}
    rest = springs()["Phi"].T @ (
        springs()["f_p"] - springs()["C"] @ springs()["Phi"] @ springs()["eta_dot"]
    )
    hold(entry.printed, {**still, "eta_ddot": rest - SQUARES * springs()["eta"]})

    def run(form, first):
        def rates(t, y):
            turned = {"Phi": modes(t), "Phi_dot": SPIN * modes(t) @ J}
            turned |= {"Phi_ddot": SPIN**2 * modes(t) @ J @ J, "eta": y[:2], "eta_dot": y[2:]}
            left, right = form.sides(**{**names, **turned, "eta_ddot": np.zeros(2)})[0]
            return np.concatenate([y[2:], right - left])

        end, tight = 2 * np.pi / SPIN, {"method": "DOP853", "rtol": 1e-9, "atol": 1e-10}
        y = solve_ivp(rates, (0, end), np.concatenate([start, first]), **tight).y[:, -1]
        return modes(end) @ y[:2]

    start, rate = np.array([1.0, 0.3]), np.array([0.2, -0.1])
    complete = run(entry.corrected, rate - SPIN * J @ start)
    lost = np.linalg.norm(run(entry.printed, rate) - complete) / np.linalg.norm(complete)
    assert lost == pytest.approx(0.96, rel=0.01)


@row("4.36")
def damping_that_leaves_the_modes_apart(entry):
    mass, stiffness = pinned(4, "mass", "stiffness")
    values, phi = scipy.linalg.eigh(stiffness, mass)
    omega = np.sqrt(values)
    modal = mass @ phi @ np.diag(2 * 0.02 * omega) @ phi.T @ mass
    point = np.zeros_like(mass)
    point[1, 1] = 1.0

    def commutes(c):
        one = c @ np.linalg.solve(mass, stiffness)
        return np.linalg.norm(one - one.T) / np.linalg.norm(one)

    for c, apart in ((modal, True), (0.3 * mass + 1e-4 * stiffness, True), (point, False)):
        names = {"phi_n": phi[:, 0], "phi_m": phi[:, 2], "C": c}
        product, zero = entry.printed[0].sides(**names)[0]
        assert bool(abs(product - zero) < 1e-9 * np.linalg.norm(c)) is apart
        assert bool(commutes(c) < 1e-9) is apart
    hold(entry.printed[1], {"phi_n": phi[:, 1], "C": modal, "alpha_n": 2 * 0.02 * omega[1]})


@row("4.37")
def strain_of_a_deflected_beam(entry):
    """The printed second order is that of the true stretch."""
    a, b, small = sp.symbols("a b small", real=True)
    stretch = sp.sqrt((1 + small * a) ** 2 + (small * b) ** 2) - 1
    series = sp.series(stretch, small, 0, 3).removeO()
    q, slope = sp.Matrix([small]), sp.Matrix([[b]])
    _, printed = entry.printed.sides(eps=0, B1=sp.Matrix([[a]]), q=q, B_n=slope)[0]
    same(sp.Matrix(printed), sp.Matrix([[series]]))


@row("4.38", "4.39")
def geometric_stiffness(entry):
    """The derived matrix; and the load of Euler from above, 12 instead of pi^2 with one element."""
    slope = arrays("cubic")["geometric_0"][2:, 2:]
    numbers = np.array(slope.subs(L, LENGTH), dtype=float)
    values = {"L": LENGTH, "f_a": 1.7, "K_n": 1.7 * numbers, "Int": point_by_point}

    def B_n(place):
        row_ = by_differences(lambda s: shapes(s)[1], place, h=1e-4)
        return row_[None, [1, 2, 4, 5]]

    hold(entry.printed or entry.corrected, {**values, "B_n": B_n}, tol=1e-8)
    for count, expected, margin in ((1, 12.0, 1e-12), (8, np.pi**2, 1e-4)):
        stiffness, geometric = pinned(count, "stiffness", "geometric")
        load = 1 / scipy.linalg.eigvalsh(geometric, stiffness)[-1]
        assert load == pytest.approx(expected, rel=margin)
        assert load >= np.pi**2


def free():
    """Return the first modes of a pinned beam, near the exact ones, scaled to det K = 1."""
    mass, stiffness = pinned(6, "mass", "stiffness")
    size = np.linalg.det(stiffness) ** (1 / len(stiffness))
    mass, stiffness = mass / size, stiffness / size
    values, phi = scipy.linalg.eigh(stiffness, mass)
    exact = np.pi**2 * np.arange(1, 4) ** 2
    assert np.all(np.sqrt(values[:3]) >= exact) and np.sqrt(values[0]) < 1.0001 * exact[0]
    for value, mode in zip(values[:3], phi.T, strict=False):
        yield {"K": stiffness, "M": mass, "omega": np.sqrt(value), "q": mode}


@row("4.40")
def free_vibration(entry):
    for point in free():
        left, zero = entry.printed.sides(**point)[0]
        assert np.abs(left - zero).max() < 1e-9 * np.abs(point["K"] @ point["q"]).max() + 1e-9


@row("4.41")
def characteristic_equation(entry):
    """The determinant changes its sign at each frequency."""
    for point in free():
        near = [{**point, "omega": factor * point["omega"]} for factor in (0.999, 1.001)]
        signs = [np.subtract(*entry.corrected.sides(**at)[0]) for at in near]
        assert signs[0] * signs[1] < 0


test_row, test_falsified_row = row.tests()
