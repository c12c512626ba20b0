"""Smith chapter 6: the flexible coupler in its moving frame, its modes, end load and parameters."""

from functools import cache

import numpy as np
import pytest
import seed_derivations as machine
import seed_truth as truth
import sympy as sp
from seed_derivations import element_acceleration
from seed_formula import Formula
from seed_ledger import Ledger, hold, holds, latex, plain, quoted, same
from seed_rigid import Link, forces
from seed_rigs import RIGS, Rig, linkage_function, parts, speeds

row = Ledger("Smith", __file__)
MOTION = dict(l2=1.3, l3=4.0, omega2=1.7, omega3=-0.6, alpha3=0.9, theta2=0.8, theta3=0.3)
LOADS = dict(mu=0.7, EI=3.1, F_x=2.5, F_y=-1.2)
POINT = MOTION | LOADS
# A deflected shape and its rates: cubics through B.
SHAPES = [
    np.polynomial.Polynomial([0, *c])
    for c in ((0.3, -0.2, 0.11), (0.5, 0.4, -0.2), (-0.7, 0.1, 0.3))
]


def numeric(expression, *arguments, **more):
    """Return a derived expression as a function of x, or else of the arguments, in numbers."""
    values = {plain(name): value for name, value in {**POINT, **more}.items()}
    arguments = arguments or (machine.x,)
    known = {s: values[plain(s.name)] for s in expression.free_symbols if s not in arguments}
    return sp.lambdify(arguments, expression.subs(known))


@cache
def projected(m, n, **more):
    """Project the linear beam on sin(m pi x/l3), its deflection Y_n sin(n pi x/l3).

    Returns the coefficients of Y_n'' and Y_n and the right-hand side, divided by mu l3 / 2.
    """
    point = {**POINT, **more}
    nodes, weights = np.polynomial.legendre.leggauss(40)
    part, k = (1 + nodes) / 2, n * np.pi / point["l3"]
    s, c, test = np.sin(n * np.pi * part), np.cos(n * np.pi * part), np.sin(m * np.pi * part)
    names = (machine.y, machine.y_x, machine.y_xx, machine.y_xxxx, machine.y_t, machine.y_tt)
    beam = numeric(machine.equation(), machine.x, *names, **more)

    def along(Y, Y_tt):
        shape = (Y * s, Y * k * c, -Y * k**2 * s, Y * k**4 * s, 0, Y_tt * s)
        return weights @ (beam(point["l3"] * part, *shape) * test) / point["mu"]

    load = along(0, 0)
    return along(0, 1) - load, along(1, 0) - load, -load


@cache
def elements():
    """Return elements of the coupler: shapes, derived accelerations, moment of what lies beyond."""
    y, rate, second = SHAPES
    components, rates = element_acceleration()
    derived = [numeric(part, machine.x, machine.y, *rates) for part in components]

    def acceleration(place):
        return [part(place, y(place), rate(place), second(place)) for part in derived]

    def force(axis):
        return lambda place: -LOADS["mu"] * acceleration(place)[axis]

    def moment(place):
        """The moment about the element of all forces to its right, by cross products."""
        nodes, weights = np.polynomial.legendre.leggauss(20)
        half = (MOTION["l3"] - place) / 2
        beyond = place + half * (1 + nodes)
        arm = (beyond - place, y(beyond) - y(place))
        inertia = arm[0] * force(1)(beyond) - arm[1] * force(0)(beyond)
        pin = (MOTION["l3"] - place) * LOADS["F_y"] + y(place) * LOADS["F_x"]
        return pin + half * weights @ inertia

    curve = np.polynomial.Chebyshev.interpolate(np.vectorize(moment), 14, [0, MOTION["l3"]])
    points = []
    for x in (0.0, 1.1, 2.7):
        a_x, a_y = acceleration(x)
        values = {"a_x": a_x, "a_y": a_y, "f_x": force(0), "f_y": force(1)}
        values |= {"M": moment(x), "fourth": curve.deriv(2)(x) / LOADS["EI"]}
        points.append({**POINT, **values, "x": x})
    return points


def at_a_place():
    """Return elements, y standing for its value there."""
    y, rate, second = SHAPES
    for p in elements():
        here = {"y": y(p["x"]), "y_dot": rate(p["x"]), "y_ddot": second(p["x"])}
        yield {**p, **here, "f_x": p["f_x"](p["x"]), "f_y": p["f_y"](p["x"])}


def along():
    """Return elements, y standing for a function of the place, with the derivatives there."""
    y, rate, second = SHAPES
    for p in elements():
        slope, bend = (y.deriv(k)(p["x"]) for k in (1, 2))
        rates = {"y_dot": rate, "y_ddot": second(p["x"])}
        yield {**p, "y": y, **rates, "y_p": slope, "y_pp": bend, "y_p4": p["fourth"]}


row(
    "6.2.2 element accelerations",
    check=lambda entry: hold(entry.printed, at_a_place),
    derived=lambda: dict(zip(("a_x", "a_y"), element_acceleration()[0], strict=True)),
)
row("6.2", check=holds(at_a_place))


@row("6.1")
def moment_of_the_forces_beyond_x(entry):
    for p in along():
        hold(entry.corrected, {**p, "y_pp": p["M"] / p["EI"]})
    example = {"EI": 1, "l3": 1, "x": 0, "y": lambda x: x**2, "f_x": lambda x: 1.0}
    example |= {"F_y": 0.1, "F_x": 0.2, "f_y": lambda x: 1.0 + 0 * x, "y_pp": 0}
    printed, right = (form.value(**example) for form in (entry.printed, entry.corrected))
    assert printed - right == pytest.approx(2 / 3)
    quoted([printed, entry.printed.value(**{**example, "x": 0.3})], "0.9333", "0.5943")


def leibniz():
    """Return a function and two moving ends."""
    x = sp.Symbol("x", real=True)
    return [{"x": x, "p": x**2, "q": sp.sin(x), "f": lambda x, s: sp.exp(x * s) + x * s**2}]


row("6.2.2 differentiation under the integral", check=holds(leibniz))


def symbolic():
    """Return polynomials for the shape and for both forces."""
    x, y, f_x, f_y = sp.symbols("x y f_x f_y", real=True)
    shapes = {y: 3 * x - 2 * x**2 + x**3, f_x: 1 + 2 * x - x**2, f_y: 2 - 3 * x + x**3}
    point = {str(k): lambda s, v=v: v.subs(x, s) for k, v in shapes.items()}
    bends = {"y_p": shapes[y].diff(x), "y_pp": shapes[y].diff(x, 2)}
    return {**point, **bends, "x": x, "l3": sp.Integer(4)}


row("6.2.2 derivatives of both integrals", check=holds(lambda: [symbolic()]))
row("6.3", check=holds(along, tol=1e-8))
row("6.4", check=holds(along))
row("6.5", check=holds(along, tol=1e-8))


@row("6.6", derived=lambda: [machine.equation()])
def linear_equation(entry):
    """The slip apart, Hamilton's equation of the linear beam."""
    derived = dict(y=0.25, y_x=0.4, y_xx=-0.3, y_xxxx=0.8, y_t=0.2, y_tt=-0.5)
    true = numeric(machine.equation(), **derived)(1.1) / LOADS["mu"]
    names = ("y", "y_p", "y_pp", "y_p4", "y_dot", "y_ddot")
    point = {**POINT, "x": 1.1, **dict(zip(names, derived.values(), strict=True))}
    left, right = entry.printed.sides(**point)[0]
    slip = point["x"] * (point["omega3"] ** 2 - point["alpha3"])
    assert left - right - slip == pytest.approx(true, abs=1e-12)
    m = truth.motion(truth.CRANK_ROCKERS["5,1,5,2"])
    quoted([5 * np.abs(m.alpha3 - m.omega3**2).max()], "1.70")


Y = {1: 0.3, 2: -0.2, 3: 0.1}


@cache
def modal():
    """Return places of the coupler where Hamilton's equation holds for three sine modes."""
    tension, beam = machine.tension(), machine.equation()
    still = dict.fromkeys(("y", "y_x", "y_xx", "y_xxxx", "y_t", "y_tt"), 0)
    mu = LOADS["mu"]
    load = numeric(-beam, **still)
    tension, slope = numeric(tension), numeric(tension.diff(machine.x))
    forms = {"f1": tension, "f2": lambda x: -slope(x), "f3": load}
    functions = {name: lambda x, form=form: form(x) / mu for name, form in forms.items()}
    points = []
    for place in (0.7, 1.9, 3.1):
        k = {n: n * np.pi / POINT["l3"] for n in Y}
        s, c = ({n: f(k[n] * place) for n in Y} for f in (np.sin, np.cos))
        shape = {**still, "y": sum(Y[n] * s[n] for n in Y)}
        shape |= {"y_x": sum(Y[n] * k[n] * c[n] for n in Y)}
        shape |= {"y_xx": -sum(Y[n] * k[n] ** 2 * s[n] for n in Y)}
        shape |= {"y_xxxx": sum(Y[n] * k[n] ** 4 * s[n] for n in Y)}
        rest = numeric(beam, **shape)(place)
        Y_ddot = {1: (-rest / mu - 0.4 * s[2] + 0.5 * s[3]) / s[1], 2: 0.4, 3: -0.5}
        values = {name: f(place) for name, f in functions.items()}
        more = {"Y": Y, "Y_ddot": Y_ddot, "s": s, "c": c, "oo": 3, "functions": functions}
        points.append({**POINT, **values, **more, "x": place})
    return points


def shapes():
    """Return the sum of three modes with free functions of time."""
    t, length = sp.Symbol("t", real=True), sp.Symbol("l3", positive=True)
    x = sp.Symbol("x", real=True)

    def deflection(place, _):
        modes = (sp.Function(f"Y{n}")(t) * sp.sin(n * sp.pi * x / length) for n in (1, 2, 3))
        return sum(modes).subs(x, place)

    def bend(place, _):
        return deflection(x, t).diff(x, 2).subs(x, place)

    amplitude = lambda n, _: sp.Function(f"Y{n}")(t)  # noqa: E731
    return {"x": x, "t": t, "l3": length, "oo": 3, "y": deflection, "y_pp": bend, "Y": amplitude}


row("6.7", check=holds(lambda: [shapes()]))


row("6.8", check=holds(modal))


row(
    "6.9",
    check=holds(modal),
    derived=lambda: rf"\mu f_1 = {latex(machine.tension())},\; f_2 = -f_1'",
)


def pairs(last=4):
    return [{**POINT, "m": m, "n": n} for m in range(1, last) for n in range(1, last)]


row("6.10", check=holds(lambda: ({**p, "delta": lambda m, n: float(m == n)} for p in pairs(5))))
row(
    "6.2.2 integrals of inertia, stiffness and omega3^2",
    check=holds(lambda: ({**modal()[0], "m": m} for m in (1, 2))),
)


def loaded(m, **modes):
    """Return the point with functions of the place for f1 to f3, and given amplitudes."""
    point = modal()[0]
    amplitudes = dict({n: modes.get(f"Y{n}", 0.0) for n in range(5)})
    return {**point, **point["functions"], "m": m, "Y": amplitudes}


@row("6.2.2 f1 integral")
def integral_with_f1(entry):
    hold(entry.corrected, *(loaded(m, Y1=1.0, Y2=0.7, Y3=0.4) for m in (1, 2, 3)))
    quoted(entry.printed.sides(**loaded(1, Y1=1.0))[0], "15.09", "4.406")
    quoted(entry.printed.sides(**loaded(1, Y2=1.0))[0], "14.28", "0")
    quoted(entry.printed.sides(**loaded(2, Y2=1.0, Y1=0.2))[0], "60.53", "17.62")


@row("6.2.2 f2 integral")
def integral_with_f2(entry):
    hold(entry.corrected, *(loaded(m, Y1=1.0, Y2=0.7, Y3=0.4) for m in (1, 2, 3)))
    quoted(entry.printed.sides(**loaded(1, Y1=1.0))[0], "-0.36", "0")
    quoted(entry.printed.sides(**loaded(1, Y2=1.0))[0], "-5.36", "0")
    quoted(entry.printed.sides(**loaded(2, Y2=1.0, Y1=0.2))[0], "0.7112", "0")


row("6.2.2 f3 integral", check=holds(lambda: map(loaded, range(1, 6))))
# What (6.11) drops from the coefficient of mode m.
DROPPED = Formula(
    "m**2*pi**2*l2/(2*l3)*omega2**2*cos(theta2 - theta3) + omega3**2*(m**2*pi**2/3 - 1/4)"
)


@row(
    "6.11",
    derived=lambda: (
        r"\frac{\ddot Y_m}{\omega_2^2} + \left\{"
        + latex(machine.mode_coefficient()[0])
        + r" + \tfrac{F_x}{\mu\omega_2^2}(\tfrac{m\pi}{\ell_3})^2\right\}Y_m + "
        r"\text{coupling},\; \phi = \tfrac{\omega_3^2}{\omega_2^2};\; \text{mode 2 in mode 1: }"
        + latex(machine.coupling_coefficient(1, 2))
    ),
)
def equation_of_one_mode(entry):
    for m in (1, 2, 3):
        inertia, coefficient, right = projected(m, m)
        point = {**loaded(m), "Y": 0.4, "Y_ddot": 0.7}
        left, printed = entry.printed.sides(**point)[0]
        left += 0.4 * DROPPED.value(**point)
        same([left, printed], [inertia * 0.7 + coefficient * 0.4, right])
    assert abs(projected(1, 2)[1]) > 1.0
    for name, largest, kept in (("5,1,5,2", 1.127, 0.0676), ("10,1,10,4", 0.525, 0.01236)):
        point, complete = parts(RIGS[name], RIGS[name].inertias[0])
        load = sum(point[f"eps{k}"] * point[f"f{k}"] for k in (1, 2, 3))
        extra = complete - load + point["phi"]
        assert [np.abs(extra).max(), point["phi"].max()] == pytest.approx([largest, kept], rel=2e-3)


def test_arrays_of_the_modes_are_the_projected_equation():
    """What the cells of (6.11), (6.17) show; without the end load."""
    coefficient, phi = machine.mode_coefficient()
    phi_of_speeds = {phi: machine.omega3**2 / machine.omega2**2}
    square = POINT["omega2"] ** 2
    for m in (1, 2):
        _, ours, right = projected(m, m, F_x=0.0)
        shown = coefficient.subs({machine.mode: m, **phi_of_speeds}), machine.mode_forcing()
        both = [square * numeric(form, m=m)(0) for form in shown]
        same([both[0], POINT["l3"] * both[1]], [ours, right])
    coupling = machine.coupling_coefficient(1, 2)
    same(square * numeric(coupling)(0), projected(1, 2, F_x=0.0)[1])
    assert machine.mu not in coefficient.subs(machine.EI, 0).free_symbols


@row("6.2.2 coefficient as effective frequency")
def effective_frequency(entry):
    for m in (1, 2, 3):
        wave = m * np.pi / POINT["l3"]
        frequencies = {m: wave**2 * np.sqrt(POINT["EI"] / POINT["mu"])}
        loads = {m: POINT["EI"] * wave**2}
        point = {**loaded(m), "Omega": frequencies, "F_E": loads}
        same(entry.printed.value(**point) + DROPPED.value(**point), projected(m, m)[1])


@cache
def stationary():
    """Return the first natural frequencies of the coupler at rest, and a free vibration."""
    rest, points = {"omega2": 0, "omega3": 0, "F_x": 0}, []
    for m in (1, 2, 3):
        square = projected(m, m, **rest)[1]
        point = {"m": m, "Omega_m": np.sqrt(square), "Y": 0.3, "Y_ddot": -square * 0.3}
        points.append({**POINT, **point})
    return points


row("6.12", "6.13", check=holds(stationary))


@row("6.2.2 growth of the natural frequencies")
def growth_of_the_frequencies(entry):
    first, second, third = stationary()
    for point in (second, third):
        hold(entry.corrected, {**point, "Omega_1": first["Omega_m"]})
    ratio, printed = entry.printed.sides(**second, Omega_1=first["Omega_m"])[0]
    assert ratio == pytest.approx(4.0) and printed == 16


@row("6.2.2 Euler load")
def euler_load(entry):
    for m in (1, 2, 3):
        load = entry.printed.values(**POINT, m=m)["F_E"]
        rest = projected(m, m, omega2=0, omega3=0, F_x=-load)[1]
        assert rest == pytest.approx(0.0, abs=1e-12 * load)


INERTIA4, SPEED = 0.4, 3.0


def pin_force(lengths, coupler, inertia4, m, speed=1.0, assembly="open"):
    """Return the force of the follower on the coupler in fixed axes and in the coupler's."""
    links = (Link(), coupler, Link(inertia=inertia4))
    force = -forces(lengths, links, speed, assembly).f34
    return force, force * np.exp(-1j * m.theta3)


@cache
def newton():
    """Return the true force at C, by Newton and Euler."""
    points = []
    for lengths in truth.CRANK_ROCKERS.values():
        for assembly in ("open", "crossed"):
            coupler = Link(1.0, 0.65 * lengths[2], inertia=0.6 * lengths[2] ** 2)
            m = truth.motion(lengths, assembly)
            force, turned = pin_force(lengths, coupler, INERTIA4, m, SPEED, assembly)
            point = {"X43": force.real, "Y43": force.imag, "F_x": turned.real, "F_y": turned.imag}
            point |= {"I3": coupler.inertia, "I4": INERTIA4, "m3r3": coupler.along}
            point |= {"m3": 0.7, "r3": coupler.along / 0.7}
            points.append({**truth.turning(lengths, m, SPEED), **point})
    return points


row("6.2.2 X43 and Y43", check=holds(newton, tol=1e-8))
row("6.2.2 F_x", check=holds(newton, tol=1e-8))
row("6.14", check=holds(newton, tol=1e-8), derived=lambda: {"F_x": machine.pin_force()[0]})


@row("6.2.2 F_y", derived=lambda: {"F_y": machine.pin_force()[1]})
def force_across_the_coupler(entry):
    hold(entry.printed, *({**point, "F_y": -point["F_y"]} for point in newton()), tol=1e-8)


@cache
def rig_points(m=2):
    """Return the end load of each rig and its parameters, fitted to three functions of the angle.

    The coupler is uniform, the crank turns at unit speed.
    """
    points = []
    for name, rig in RIGS.items():
        mu, length = rig.mass_per_length, rig.lengths[2]
        coupler, turn = Link.uniform_bar(mu * length, length), truth.motion(rig.lengths)
        for inertia4 in rig.inertias:
            along = pin_force(rig.lengths, coupler, inertia4, turn)[1].real
            functions = truth.coupler_functions(turn)[1:]
            term = along * np.pi**2 / (mu * length**2)
            eps, *_ = np.linalg.lstsq(np.array(functions).T, term, rcond=None)
            assert np.abs(eps @ np.array(functions) - term).max() < 1e-8 * np.abs(term).max()
            point = {**truth.turning(rig.lengths, turn), "F_x": along, "mu": mu, "m": m}
            point |= dict(zip(("eps1", "eps2", "eps3"), eps, strict=True))
            point |= {"I3": coupler.inertia, "r3": length / 2, "k3": length / np.sqrt(3)}
            point |= {"I4": inertia4, "M3": coupler.mass, "M4": 0.02, "rig": name}
            points.append(point | {"k4": np.sqrt(inertia4 / 0.02)})
    return points


@row("6.15")
def force_of_the_follower_alone(entry):
    for point, size in zip(rig_points(), (0.1485, 0.0505, 0.0834, 0.0269), strict=True):
        true, printed = entry.printed.sides(**point)[0]
        assert np.abs(true - printed).max() / np.abs(true).max() == pytest.approx(size, abs=2e-4)


@row("6.2.2 F_x term of the coefficient")
def term_of_the_coefficient(entry):
    quick = {"omega2": 2.0}
    fast = [p | quick | {k: 4 * p[k] for k in ("alpha3", "alpha4", "F_x")} for p in rig_points()]
    hold(entry.corrected, *fast, tol=1e-8)
    literal = [p | {"I3": p["r3"], "alpha3": p["alpha3"] * p["I3"] / p["r3"]} for p in fast]
    hold(entry.printed, *literal, tol=1e-8)
    point = rig_points()[0]
    quoted([point["I3"], np.pi**2 * point["I3"] * point["l2"] / 15.0**2], "0.0139", "0.0018")
    one, other = entry.printed.sides(**point)[0]
    assert np.abs(one - other).max() > 0.02 * np.abs(one).max()


@row("6.2.2 epsilon1")
def first_parameter(entry):
    hold(entry.corrected, rig_points, tol=1e-8)
    for k in (0, 2, 3):
        hold(entry.printed[k], rig_points, tol=1e-8)
    quoted([entry.printed[1].value(**p) for p in rig_points()], *["49.348"] * 4)


@row("6.2.2 epsilon2")
def second_parameter(entry):
    for form in (entry.corrected, entry.printed[1], entry.printed[2]):
        hold(form, rig_points, tol=1e-8)
    hold(entry.printed[0], *({**p, "I3": p["r3"]} for p in rig_points()), tol=1e-8)
    quoted([rig_points()[0]["eps2"]], "0.987")
    assert entry.printed[2].sides(**rig_points()[0])[0][2] == np.pi**2 / 2


@row("6.2.2 epsilon3")
def third_parameter(entry):
    hold(entry.printed[0], rig_points, tol=1e-8)
    for p in rig_points():  # the same follower as a uniform bar
        hold(entry.printed[1], {**p, "M4": 3 * p["I4"] / p["l4"] ** 2}, tol=1e-8)
    quoted([p["eps3"] for p in rig_points()[:2]], "3.43", "11.23")


@row("6.2.2 epsilon3, uniform links of equal length")
def third_parameter_of_equal_links(entry):
    mass3, mass4, length = 0.7, 1.9, 2.3
    eps3 = mass4 * length**2 / 3 * np.pi**2 / (mass3 / length * length**2 * length)
    point = {"M3": mass3, "M4": mass4, "eps3": eps3}
    hold(entry.corrected, point)
    quoted([1 - entry.printed.value(**point) / eps3], "0.392")


@row("6.2.2 epsilons exceed one")
def sizes_of_the_parameters(entry):
    quoted([rig_points()[k]["eps2"] for k in (0, 2)], "0.987", "0.493")
    for point in rig_points():
        above = [one > other for one, other in entry.printed.sides(**point)]
        assert above == [True, False, True]
    assert [other for _, other in entry.printed.sides(**rig_points()[0])] == [1, 1, 1]
    quoted([2 / np.pi**2], "0.203")


@cache
def turns():
    """Return a turn of each crank-rocker at unit crank speed, with the coupler speed squared."""
    kinds = (*truth.CRANK_ROCKERS.values(), truth.LONG_CRANK)
    points = [truth.turning(lengths, truth.motion(lengths, count=1024)) for lengths in kinds]
    return [{**point, "phi": point["omega3"] ** 2} for point in points]


row("6.2.2 phi", check=holds(turns, tol=1e-8))


@row("6.2.2 phi below one")
def coupler_speed_squared(entry):
    largest = {}
    for point in turns():
        speed = point["omega3"]
        assert np.count_nonzero(np.diff(np.signbit(np.append(speed, speed[0])))) == 2
        largest[tuple(point[f"l{k}"] for k in (1, 2, 3, 4))] = point["phi"].max()
        assert point["phi"].min() == pytest.approx(entry.printed.values(phi=0)["phi_min"], abs=2e-4)
    names = ("5,1,5,2", "10,1,10,4", "4,1,4,4", "12,6,12,12")
    sizes = [largest[truth.CRANK_ROCKERS[name]] for name in names]
    quoted([*sizes, largest[truth.LONG_CRANK]], "0.068", "0.012", "0.13", "1.04", "16.1")
    below = [bool(np.less(*entry.printed[0].sides(phi=size)[0])) for size in sizes]
    assert below == [True, True, True, False] and entry.printed[0].sides(phi=0)[0][1] == 1


def kept(entry, point, m=1):
    """Return the periodic part of the coefficient of a printed equation: of U = 1, U'' = 0."""
    left = entry.printed[0].sides(**point, m=m, U=1.0, U_pp=0.0, lam=0.0, g=0.0)[0][0]
    return left


FAST = {"EI": 171.5, "mu": RIGS["5,1,5,2"].mass_per_length, "F_x": 0.02, "l2": 3.0, "l3": 15.0}
FAST |= {"omega2": 90.0, "omega3": 20.0, "alpha3": 1500.0, "theta2": 0.9, "theta3": 0.4}


def without_dimensions(m):
    """Return coefficient and right-hand side of mode m at 90 rad/s, the deflection over l3."""
    _, coefficient, right = projected(m, m, **FAST)
    speed = FAST["omega2"] ** 2
    return coefficient / speed, right / (FAST["l3"] * speed)


@row("6.16")
def equation_without_dimensions(entry):
    for m in (1, 2):
        coefficient, right = without_dimensions(m)
        extra = m**2 * np.pi**2 * 3.0 / 30 * np.cos(0.5)
        extra += (20.0 / 90.0) ** 2 * (m**2 * np.pi**2 / 3 - 0.25)
        point = {**FAST, "m": m, "U": 0.3, "U_pp": 0.7}
        left, printed = entry.corrected.sides(**point)[0]
        same(left + 0.3 * extra, 0.7 + 0.3 * coefficient)
        same([printed, entry.printed.sides(**point, omega1=1.0)[0][1]], [right, right])
        # With omega1 for the missing factors, the printed form is that of unit speed.
        slow = {**point, "EI": FAST["EI"] / 8100, "omega1": 8100.0 / 20.0}
        same(entry.printed.sides(**slow)[0][0], left)
    point = {**FAST, "m": 1, "U": 1, "U_pp": 0, "omega1": 1e9, "F_x": 0}
    printed = entry.printed.sides(**point)[0][0]
    quoted([printed, printed / 90.0**2], "26687", "3.3")


REGION_4 = {"5,1,5,2": {"6.18": (781.1, 772.0), "6.17": (785.1, 772.4), "whole": (769.1, 752.9)}}
REGION_4["10,1,10,4"] = {"6.17": (780.6, 780.0), "whole": (776.2, 775.3)}
SIZES = {  # of the complete mode less (6.17), of (6.17) less (6.18), of (6.18)
    ("5,1,5,2", 0.0058): (1.127, 0.566, 3.58),
    ("5,1,5,2", 0.0190): (1.127, 0.566, 11.73),
    ("10,1,10,4", 0.0058): (0.525, 0.0918, 1.157),
    ("10,1,10,4", 0.0190): (0.525, 0.0918, 3.790),
}


def definitions(entry):
    """Check lambda and g of (6.17) at the rig's speed."""
    for m in (1, 2):
        _, right = without_dimensions(m)
        point = {**FAST, "m": m}
        values = entry.printed.values(**point)
        same(values["g"], right)
        still = {**{k: FAST[k] for k in ("EI", "mu", "l3", "omega2")}, "m": m}
        square = still["EI"] / still["mu"] * (m * np.pi / 15.0) ** 4 / 90.0**2
        still |= dict.fromkeys(("eps1", "eps2", "eps3", "f1", "f2", "f3", "phi", "g"), 0)
        left = entry.printed[0].sides(**still, lam=values["lam"], U=1.0, U_pp=0.5)[0][0]
        same(left, square + 0.5)


@row(
    "6.17",
    derived=lambda: (
        r"\left\{"
        + latex(machine.mode_coefficient()[0])
        + r" + m^2\textstyle\sum\epsilon_i f_i\right\}U_m + \text{coupling},\; g_m = "
        + latex(machine.mode_forcing())
    ),
)
@row("6.18")
def dropped_terms_and_boundaries(entry):
    short = entry.label == "6.18"
    for (name, inertia4), sizes in SIZES.items():
        point, complete = parts(RIGS[name], inertia4)
        terms = [point[f"eps{k}"] * point[f"f{k}"] for k in (1, 2, 3)]
        rest, follower = terms[0] + terms[1] - point["phi"], terms[2]
        printed = kept(entry, point)
        same(printed, follower if short else rest + follower)
        found = [np.abs(form).max() for form in (complete - rest - follower, rest, follower)]
        assert found == pytest.approx(sizes, rel=2e-3)
        speed2 = 0 if short else point["phi"]
        same(kept(entry, point, 2) + speed2, 4 * (printed + speed2))
        limits = REGION_4[name] if inertia4 == 0.0058 else {}
        for what, function in ((entry.label, printed), ("whole", complete)):
            if what in limits:
                assert speeds(RIGS[name], function, 4) == pytest.approx(limits[what], abs=0.1)
    left = entry.printed[0].sides(
        **{**point, "eps3": 0, "eps1": 0, "eps2": 0, "phi": 0}, m=2, U=1.0, U_pp=0.5, lam=0.3, g=0
    )[0][0]
    same(left, 0.5 + 16 * 0.09)
    if short:
        return
    definitions(entry)
    point, complete = parts(Rig(truth.CRANK_ROCKERS["2,1,2,2"]), 1.0)
    printed = kept(entry, point)
    assert np.abs(printed - point["eps3"] * point["f3"]).max() == pytest.approx(6.6, abs=0.05)
    assert np.abs(complete - printed).max() == pytest.approx(4.5, abs=0.05)


@cache
def steps():
    """Return the natural frequencies of the first rig's coupler at rest, and steps at the limit.

    A wave sampled at the limit returns after twenty steps.
    """
    rig, speed, points = RIGS["5,1,5,2"], 40.0, []
    first = (np.pi / 15.0) ** 2 * np.sqrt(rig.stiffness / rig.mass_per_length)
    assert first == pytest.approx(rig.frequency, rel=1e-12)
    names = {"EI": rig.stiffness, "mu": rig.mass_per_length, "F_x": 0}
    still = {**names, "omega2": 0, "omega3": 0, "l3": 15}
    for m in (1, 2, 3):
        Omega_m = np.sqrt(projected(m, m, **still)[1])
        limit = truth.TURN / (20 * Omega_m)
        assert np.cos(20 * limit * Omega_m) == pytest.approx(1.0, abs=1e-12)
        point = {"m": m, "l": 15.0, **names, "Omega_m": Omega_m, "Omega": rig.frequency}
        point |= {"h_max": limit, "omega2": speed, "T": truth.TURN / speed, "lam": first / speed}
        points.append(point | {"Omega1": first, "h_deg": np.degrees(speed * limit)})
    return points


row("6.2.3.1 largest step", check=lambda entry: largest_step(entry))
row("6.2.3.1 h < 18/lambda", check=lambda entry: largest_step(entry, 1))
row("6.2.3.1 h < 18/lambda_m", check=lambda entry: largest_step(entry))


def largest_step(entry, count=3):
    """At the limit both sides of an inequality are equal; its definitions hold."""
    for point in steps()[:count]:
        for sides in entry.printed.sides(**{"h": point["h_max"], **point}):
            for other in sides[1:]:
                assert other == pytest.approx(sides[0], rel=1e-12)


@row("6.2.3.3 places of instability")
def places_of_instability(entry):
    f3 = linkage_function("5,1,5,2")
    limits = [truth.boundaries(0.05 * f3, n) for n in (1, 2, 3, 4)]
    for n, (low, high) in enumerate(limits, start=1):
        assert low - 1e-12 <= high
        middle, right = entry.corrected.sides(lam=np.sqrt(0.5 * (low + high)), n=n)[0]
        assert abs(middle - right) < 0.03
    left, printed = entry.printed.sides(lam=np.sqrt(middle))[0]
    assert left == pytest.approx(middle)
    quoted([printed], "2.47")
    assert limits[2][1] < printed < limits[3][0]


test_row, test_falsified_row = row.tests()
