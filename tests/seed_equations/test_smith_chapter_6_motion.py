"""Smith (6.1)-(6.6): the flexible coupler in the frame that moves with its chord."""

from functools import cache

import numpy as np
import pytest
import seed_machine as machine
import sympy as sp
from seed_derivations import element_acceleration, linear_beam
from seed_ledger import Ledger, hold, holds, quoted
from seed_truth import CRANK_ROCKERS, motion

row = Ledger("Smith", __file__)
MOTION = dict(l2=1.3, l3=4.0, omega2=1.7, omega3=-0.6, alpha3=0.9, theta2=0.8, theta3=0.3)
LOADS = dict(mu=0.7, EI=3.1, F_x=2.5, F_y=-1.2)
# A deflected shape and its rates: cubics through B.
SHAPES = [
    np.polynomial.Polynomial([0, *c])
    for c in ((0.3, -0.2, 0.11), (0.5, 0.4, -0.2), (-0.7, 0.1, 0.3))
]


@cache
def _acceleration():
    """Return the derived accelerations as a function of x, y, its rate and its second rate."""
    components, (y_t, y_tt) = element_acceleration()
    symbols = [*sp.symbols("x y", real=True), y_t, y_tt]
    values = {f"ell_{i}": MOTION[f"l{i}"] for i in (2, 3)}
    values |= {f"{n}_{i}": v for n, i, v in ((k[:-1], k[-1], v) for k, v in MOTION.items())}
    known = {s: values[s.name] for c in components for s in c.free_symbols if s not in symbols}
    return sp.lambdify(symbols, [c.subs(known) for c in components])


@cache
def elements():
    """Return elements of the coupler: shapes, derived accelerations, moment of what lies beyond."""
    y, rate, second = SHAPES

    def acceleration(place):
        return _acceleration()(place, y(place), rate(place), second(place))

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
        points.append({**MOTION, **LOADS, **values, "x": x})
    return points


def plain():
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
    check=lambda entry: hold(entry.printed, plain),
    derived=lambda: dict(zip(("a_x", "a_y"), element_acceleration()[0], strict=True)),
)
row("6.2", check=holds(plain))


@row("6.1")
def moment_of_the_forces_beyond_x(entry):
    for p in along():
        hold(entry.corrected, {**p, "y_pp": p["M"] / p["EI"]})
    example = {"EI": 1, "l3": 1, "x": 0, "y": lambda x: x**2, "f_x": lambda x: 1.0}
    example |= {"F_y": 0.1, "F_x": 0.2, "f_y": lambda x: 1.0 + 0 * x, "y_pp": 0}
    printed, right = (form.value(**example) for form in (entry.printed, entry.corrected))
    assert printed - right == pytest.approx(2 / 3)
    quoted([printed, entry.printed.value(**{**example, "x": 0.3})], "0.9333", "0.5943")


row("6.2.2 differentiation under the integral", check=holds(lambda: [leibniz()]))


def leibniz():
    """Return a function and two moving ends."""
    x = sp.Symbol("x", real=True)
    return {"x": x, "p": x**2, "q": sp.sin(x), "f": lambda x, s: sp.exp(x * s) + x * s**2}


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
    symbols = [s for s in linear_beam()["symbols"]]
    names = ("y_p", "y_pp", "y_p4", "y_dot", "y_ddot")
    values = dict(zip(names, (0.4, -0.3, 0.8, 0.2, -0.5), strict=True)) | {"y": 0.25, "x": 1.1}
    table = {str(s): values[n] for s, n in zip(symbols, names, strict=True)}
    point = {**MOTION, **LOADS, **values}
    by_symbol = {**table, **{k: v for k, v in point.items() if k not in names}}
    rest = linear_beam()["equation"]
    known = {s: by_symbol.get(s.name) or by_symbol[_short(s.name)] for s in rest.free_symbols}
    true = float(rest.subs(known)) / LOADS["mu"]
    left, right = entry.printed.sides(**point)[0]
    slip = point["x"] * (point["omega3"] ** 2 - point["alpha3"])
    assert left - right - slip == pytest.approx(true, abs=1e-12)
    assert float(machine.equation().subs(known)) == pytest.approx(true * LOADS["mu"], abs=1e-12)
    m = motion(CRANK_ROCKERS["5,1,5,2"])
    quoted([5 * np.abs(m.alpha3 - m.omega3**2).max()], "1.70")


def _short(name):
    return name.replace("ell_", "l").replace("_", "")


test_row, test_falsified_row = row.tests()
