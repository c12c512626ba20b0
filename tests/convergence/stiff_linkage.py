"""A four-bar linkage of bending bars, put together by hand: a stiff system for Floquet analysis."""

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.linkages import FourBar

# Aannaque's Table 4.1: metres, square metres, metres to the fourth.
LENGTHS = {"crank": 0.170, "coupler": 0.328, "follower": 0.525}
FRAME = 0.547
AREAS = {"crank": 157.5e-6, "coupler": 85.5e-6, "follower": 78.75e-6}
SECOND_MOMENTS = {"crank": 520.47e-12, "coupler": 83.34e-12, "follower": 65.12e-12}
MODULUS, DENSITY, JOINT_MASS = 210e9, 7850.0, 0.174
_QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


def element(length, area, second_moment):
    """Return mass, stiffness and W = int N^T J N of a beam element, by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(5)
    s = 0.5 * (nodes + 1.0)
    weights = 0.5 * weights * length
    zero = np.zeros_like(s)
    bend = np.array(
        [1 - 3 * s**2 + 2 * s**3, length * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3,
         length * (s**3 - s**2)]
    )  # fmt: skip
    curve = np.array([12 * s - 6, length * (6 * s - 4), 6 - 12 * s, length * (6 * s - 2)])
    curve /= length**2
    rows = [1 - s, zero, zero, s, zero, zero], [zero, bend[0], bend[1], zero, bend[2], bend[3]]
    shapes = np.moveaxis(np.array(rows), -1, 0)
    mass = DENSITY * area * np.einsum("g,gia,gib->ab", weights, shapes, shapes)
    turned = DENSITY * area * np.einsum("g,gia,ij,gjb->ab", weights, shapes, _QUARTER, shapes)
    stiffness = np.zeros((6, 6))
    transverse = [1, 2, 4, 5]
    stiffness[np.ix_(transverse, transverse)] = (
        MODULUS * second_moment * np.einsum("g,ag,bg->ab", weights, curve, curve)
    )
    stiffness[np.ix_([0, 3], [0, 3])] = (
        MODULUS * area / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    )
    return mass, stiffness, turned


def rotation(angle, order=0):
    """Return R of q_local = R q for angles ``(nt,)``, or its derivative; shape ``(nt, 6, 6)``."""
    c, s = np.cos(angle + order * np.pi / 2), np.sin(angle + order * np.pi / 2)
    out = np.zeros((len(angle), 6, 6))
    for k in (0, 3):
        out[:, k, k], out[:, k, k + 1] = c, s
        out[:, k + 1, k], out[:, k + 1, k + 1] = -s, c
        out[:, k + 2, k + 2] = 1.0 if order == 0 else 0.0
    return out


def numbering(elements):
    """Return the freedoms of the nodes of each link, -1 where held, and their number."""
    count = 0

    def fresh(number):
        nonlocal count
        count += number
        return list(range(count - number, count))

    pins = {name: fresh(2) for name in ("B", "C")}
    ends = {
        "crank": ([-1, -1, -1], pins["B"] + fresh(1)),
        "coupler": (pins["B"] + fresh(1), pins["C"] + fresh(1)),
        "follower": ([-1, -1, *fresh(1)], pins["C"] + fresh(1)),
    }
    return {
        name: [start, *(fresh(3) for _ in range(elements - 1)), end]
        for name, (start, end) in ends.items()
    }, count


def stiff_four_bar(elements=1, form="full", retardation=0.0, mass_drag=0.0, coupler=None):
    """Return the four-bar with flexible links as a LinearPeriodic.

    ``form="instantaneous"`` leaves out A, B and M'.  ``retardation`` is Kelvin and Voigt's [s],
    ``mass_drag`` a drag proportional to the mass [1/s].
    """
    lengths = {**LENGTHS, **({} if coupler is None else {"coupler": coupler})}
    linkage = FourBar(FRAME, lengths["crank"], lengths["coupler"], lengths["follower"])
    nodes, size = numbering(elements)

    def sums(theta):
        motion = linkage.motion(theta)
        one = np.ones_like(theta)
        angles = {"crank": theta, "coupler": motion.theta3, "follower": motion.theta4}
        rates = {"crank": one, "coupler": motion.omega3, "follower": motion.omega4}
        out = {name: np.zeros((len(theta), size, size)) for name in ("M", "A", "B", "K", "dM", "D")}
        for k in (0, 1, 2, 3):
            out["M"][:, k, k] += JOINT_MASS
        for name in LENGTHS:
            mass, stiffness, turned = element(
                lengths[name] / elements, AREAS[name], SECOND_MOMENTS[name]
            )
            r, rp = rotation(angles[name]), rotation(angles[name], 1)
            rt, rpt = np.swapaxes(r, -1, -2), np.swapaxes(rp, -1, -2)
            rate = rates[name][:, None, None]
            gyro = rt @ (mass @ rp + turned @ r)
            parts = {
                "M": rt @ mass @ r,
                "K": rt @ stiffness @ r,
                "A": rate * gyro,
                "B": rate**2
                * (rpt @ (mass @ rp + turned @ r) + rt @ (turned.T @ rp + mass @ r)),
                "dM": rate * (rpt @ mass @ r + rt @ mass @ rp),
                "D": rate * (rt @ stiffness @ rp),
            }  # fmt: skip
            for first, last in zip(nodes[name][:-1], nodes[name][1:], strict=True):
                index = np.array([*first, *last])
                free = np.flatnonzero(index >= 0)
                where = np.ix_(range(len(theta)), index[free], index[free])
                for key, value in parts.items():
                    out[key][where] += value[np.ix_(range(len(theta)), free, free)]
        return out

    def one(name, factor=1.0):
        return lambda theta: factor * sums(theta)[name]

    terms = [Term("M", None, one("M")), Term("K", None, one("K"))]
    if form == "full":
        terms += [Term("A", None, one("A")), Term("B", None, one("B"))]
    else:
        terms.append(Term("C", None, one("dM", -1.0), power=1))
    if retardation:
        terms.append(Term("C", None, one("K", retardation)))
        if form == "full":
            terms.append(Term("D", None, one("D", retardation)))
    if mass_drag:
        terms.append(Term("C", None, one("M", mass_drag)))
        if form == "full":
            # The drag acts on the velocity in space, M q' + A q.
            terms.append(Term("D", None, one("A", mass_drag)))
    return LinearPeriodic(size, tuple(terms), {}, lambda values: {})
