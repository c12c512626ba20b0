"""Beam elements in many digits: polynomials by their coefficients, nodal conditions solved anew.

Nothing here comes from the derivation: the deflection is a list of coefficients of powers of x,
energies are sums of products of coefficients, and the rotation of Timoshenko's section is
``v' + EI/(k G A) v'''`` because the shear force ``k G A (v' - psi) = -EI psi''`` is constant.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from functools import lru_cache

import mpmath
import numpy as np
from judging import Exact, Point, exact_at

KINDS = ("cubic", "internal_node", "curvature", "timoshenko")
MODULES = (*(f"beam_element_{kind}" for kind in KINDS), *(f"beam_shapes_{kind}" for kind in KINDS))
SANDWICH = "beam_section_sandwich"
_ELEMENT = ("length", "mass_per_length", "axial_stiffness", "bending_stiffness")
_SHEAR = ("shear_stiffness", "rotary_inertia")
# Nodal values: (displacement, derivatives, place over the length), in the order of the arrays.
_ENDS = [(name, k, at) for at in (0, 1) for name, k in (("u", 0), ("v", 0), ("v", 1))]
_MORE = {
    "internal_node": [("v", 0, mpmath.mpf(1) / 2), ("v", 1, mpmath.mpf(1) / 2)],
    "curvature": [("v", 2, 0), ("v", 2, 1)],
}


def derivative(c, order=1):
    """Return the coefficients of a derivative."""
    for _ in range(order):
        c = [k * value for k, value in enumerate(c)][1:]
    return c


def value(c, x):
    """Return the polynomial with coefficients c at x."""
    return mpmath.polyval(c[::-1], x) if c else mpmath.mpf(0)


def product(a, b, weight=0):
    """Return ``int_0^1 x^weight a b dx`` of two polynomials on the unit length."""
    terms = itertools.product(enumerate(a), enumerate(b))
    return mpmath.fsum(p * q / (i + j + weight + 1) for (i, p), (j, q) in terms)


def shapes(kind, length, ratio=0):
    """Return coefficients in xi = x/length of u, v and the section's rotation, per nodal value.

    ``ratio`` is EI/(k G A length^2); derivatives are by xi, the rotation is by x.
    """
    nodal = _ENDS + _MORE.get(kind, [])
    u, v, turn = ([[mpmath.mpf(0)]] * len(nodal) for _ in range(3))
    for i, (name, _, at) in enumerate(nodal):
        if name == "u":
            u[i] = [mpmath.mpf(1 - at), mpmath.mpf(2 * at - 1)]
    places = [i for i, n in enumerate(nodal) if n[0] == "v"]
    size = len(places)
    rows = mpmath.matrix(size, size)
    for row, i in enumerate(places):
        _, order, at = nodal[i]
        for k in range(size):
            power = [mpmath.mpf(0)] * k + [mpmath.mpf(1)]
            found = value(derivative(power, order), mpmath.mpf(at)) / length**order
            if order == 1:
                found += ratio * value(derivative(power, 3), mpmath.mpf(at)) / length
            rows[row, k] = found
    inverse = rows**-1
    for column, i in enumerate(places):
        v[i] = [inverse[k, column] for k in range(size)]
        slope = [c / length for c in derivative(v[i])]
        third = [ratio * c / length for c in derivative(v[i], 3)]
        third += [mpmath.mpf(0)] * (len(slope) - len(third))
        turn[i] = [a + b for a, b in zip(slope, third, strict=True)]
    return u, v, turn


def sheared(v, turn, length):
    """Return the coefficients of the angle of shear, ``v' - psi``."""
    pairs = itertools.zip_longest(derivative(v), turn, fillvalue=mpmath.mpf(0))
    return [slope / length - rotation for slope, rotation in pairs]


def element(kind, numbers):
    """Return every array of an element by name, as nested dictionaries of numbers."""
    length, mass = numbers["length"], numbers["mass_per_length"]
    bending, rotary = numbers["bending_stiffness"], numbers.get("rotary_inertia", 0)
    shear = numbers.get("shear_stiffness")
    ratio = bending / (shear * length**2) if shear else 0
    u, v, turn = shapes(kind, length, ratio)
    n = range(len(v))
    found = {}
    for i, j in itertools.product(n, n):
        both = product(u[i], u[j]) + product(v[i], v[j])
        found["centripetal", i, j] = mass * length * both
        found["mass", i, j] = mass * length * both + rotary * length * product(turn[i], turn[j])
        cross = product(v[i], u[j]) - product(u[i], v[j])
        found["coupling", i, j] = mass * length * cross
        axial = product(derivative(u[i]), derivative(u[j])) / length
        bent = product(derivative(turn[i]), derivative(turn[j])) / length
        stiffness = numbers["axial_stiffness"] * axial + bending * bent
        if shear:
            angles = [sheared(v[k], turn[k], length) for k in (i, j)]
            stiffness += shear * length * product(*angles)
        found["stiffness", i, j] = stiffness
        for p in range(3):
            slopes = product(derivative(v[i]), derivative(v[j]), p) / length
            found[f"geometric_{p}", i, j] = slopes
    ends = ([mpmath.mpf(1), mpmath.mpf(-1)], [mpmath.mpf(0), mpmath.mpf(1)])
    for i, (column, (shape, end)) in itertools.product(
        n, enumerate((s, e) for s in (u, v) for e in ends)
    ):
        found["load", i, column] = length * product(shape[i], end)
    return _named(found)


def _named(found):
    return {f"{name}_{i + 1}_{j + 1}": entry for (name, i, j), entry in found.items()}


def shape_values(kind, numbers):
    """Return every shape and derivative at a place by name."""
    length, place = numbers["length"], numbers["xi"]
    ratio = 0
    if kind == "timoshenko":
        ratio = numbers["bending_stiffness"] / (numbers["shear_stiffness"] * length**2)
    u, v, turn = shapes(kind, length, ratio)
    orders = {"v": 0, "slope": 1, "curvature": 2, "third": 3}
    found = {}
    for i in range(len(v)):
        found["u", 0, i] = value(u[i], place)
        found["strain", 0, i] = value(derivative(u[i]), place) / length
        for name, k in orders.items():
            found[name, 0, i] = value(derivative(v[i], k), place) / length**k
        for k, name in enumerate(("rotation", "rotation_slope", "rotation_second")):
            found[name, 0, i] = value(derivative(turn[i], k), place) / length**k
    return _named(found)


def sandwich(numbers):
    """Return the stiffness of a sandwich: the stretchings minimise the energy, complex modulus.

    Unknowns are the displacements of the two faces of the core, not of the mid-lines.
    """
    k, width = numbers["wave_number"], numbers["width"]
    h1, h2, h3 = (numbers[f"{name}_thickness"] for name in ("base", "core", "cover"))
    e1, e3 = numbers["base_modulus"], numbers["cover_modulus"]

    def bent(modulus):
        """Eliminate the faces' displacements a, c from the energy of the deflection sin kx."""
        # Strain at distance s from the face: -k (face + or - s k) sin kx.
        hessian, load, rest = mpmath.zeros(2, 2), mpmath.zeros(2, 1), mpmath.mpf(0)
        for i, (young, h, side) in enumerate(((e1, h1, 1), (e3, h3, -1))):
            # int_0^h (face + side s k)^2 ds, s measured away from the core
            hessian[i, i] += young * k**2 * h
            load[i] += young * k**2 * side * k * h**2 / 2
            rest += young * k**2 * k**2 * h**3 / 3
        # Shear (c - a)/h2 + k over the height h2.
        hessian += modulus / h2 * mpmath.matrix([[1, -1], [-1, 1]])
        load += modulus * k * mpmath.matrix([-1, 1])
        rest += modulus * h2 * k**2
        solved = mpmath.lu_solve(hessian, load)
        return width * (rest - (load.T * solved)[0]) / k**4

    whole = bent(numbers["core_shear_modulus"] * mpmath.mpc(1, numbers["core_loss"]))
    slack = bent(mpmath.mpf(0))
    middle = (h1 + h3) / 2 + h2
    joint = e1 * h1 * e3 * h3 / (e1 * h1 + e3 * h3) * middle**2
    return {
        "bending_stiffness": whole.real,
        "loss_factor": whole.imag / whole.real,
        "slack": slack,
        "bonded": slack + width * joint,
    }


def _draw(random, names, low=-6, high=6):
    return {name: float(10.0 ** random.uniform(low, high)) for name in names}


def _element_points(kind) -> Iterator[Point]:
    random = np.random.default_rng(601)
    names = _ELEMENT + (_SHEAR if kind == "timoshenko" else ())
    for i in range(25):
        yield Point(f"random {i}", _draw(random, names))
    if kind == "timoshenko":
        # Ratios at which an entry changes its sign, and the two limits.
        for ratio in (1 / 6, 1 / 60, 0.0833, 1e-12, 1e12):
            inputs = _draw(random, names, -1, 1)
            shear = inputs["bending_stiffness"] / (ratio * inputs["length"] ** 2)
            inputs["shear_stiffness"] = shear
            yield Point(f"shear ratio {ratio:.3g}", inputs)


def _roots(kind) -> list[float]:
    """Return where shapes of unit length change sign inside, to double precision."""
    found = set()
    with mpmath.workdps(30):
        for c in shapes(kind, mpmath.mpf(1))[1]:
            for k in range(4):
                coefficients = np.array([float(a) for a in derivative(c, k)])
                for root in np.roots(np.trim_zeros(coefficients, "b")[::-1]):
                    if abs(root.imag) < 1e-6 and 0 < root.real < 1:
                        found.add(round(float(root.real), 12))
    return sorted(found)


def _shape_points(kind) -> Iterator[Point]:
    random = np.random.default_rng(602)
    more = ("bending_stiffness", "shear_stiffness") if kind == "timoshenko" else ()
    places = [0.0, 1.0, 0.5, 1e-9, 1.0 - 2.0**-40, 0.5 + 2.0**-40, *_roots(kind)]
    places += list(random.uniform(0.0, 1.0, 15))
    for place in places:
        inputs = {"xi": float(place), **_draw(random, ("length", *more))}
        yield Point(f"xi = {place:.6g}", inputs)


def _sandwich_points() -> Iterator[Point]:
    random = np.random.default_rng(603)
    layers = [f"{name}_thickness" for name in ("base", "core", "cover")]
    names = [*layers, "wave_number", "width", "base_modulus", "cover_modulus", "core_shear_modulus"]
    for i in range(40):
        yield Point(f"random {i}", _draw(random, [*names, "core_loss"]))
    for loss in (0.0, 1e-9):
        yield Point(f"loss {loss:g}", {**_draw(random, names, -1, 1), "core_loss": loss})


@lru_cache(maxsize=16)
def exact_beams(module: str) -> tuple[Exact, ...]:
    """Return the exact values of one emitted module at random and nasty points."""
    if module == SANDWICH:
        return tuple(exact_at(sandwich, point) for point in _sandwich_points())
    kind = module.split("_", 2)[2]
    if module.startswith("beam_element"):
        points, reference = _element_points(kind), element
    else:
        points, reference = _shape_points(kind), shape_values

    def chopped(numbers):
        """What cancels exactly leaves some 1e-80 of its terms: zero."""
        values = reference(kind, numbers)
        return {name: mpmath.chop(entry, mpmath.mpf(10) ** -65) for name, entry in values.items()}

    return tuple(exact_at(chopped, point) for point in points)
