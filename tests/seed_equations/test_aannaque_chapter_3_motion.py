"""Aannaque 3.5-3.8: motion of the four-bar, its pin forces and torque, joint accelerations."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from seed_derivations import (
    FREUDENSTEIN,
    TURNS,
    alpha3,
    alpha4,
    closure_rows,
    freudenstein,
    half_angle_quadratic,
    omega3,
    omega4,
    rates,
)
from seed_formula import Formula
from seed_ledger import Ledger, hold, hold_derived, holds, latex, quoted, table
from seed_rigid import TABLE_3_2, Link, centres, forces, motion, rate
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, TURN, closure

row = Ledger("Aannaque", __file__)
KINDS = (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], CRANK_ROCKERS["2,1,2,2"], LONG_CRANK, DRAG_LINK)
CRANK_ANGLES = np.linspace(0.03, TURN - 0.02, 61)
SECTIONS = ((24.8e-3, 6.35e-3), (25e-3, 3.42e-3), (25e-3, 3.15e-3))
BARS = tuple(
    Link.bar(7850.0 * width * thick * length, length)
    for (width, thick), length in zip(SECTIONS, TABLE_3_2[1:], strict=True)
)


def named(lengths):
    """Return the lengths in this document's letters and Smith's, and the ratios of 3.4."""
    frame, l1, l2, l3 = lengths
    letters = {"L1": l1, "L2": l2, "L3": l3, "L4": frame}
    ratios = {"lam2": l2 / l1, "lam3": l3 / l1, "lam4": frame / l1}
    return letters | ratios | {f"l{k}": v for k, v in enumerate(lengths, 1)}


@cache
def placed(lengths, assembly):
    """Return a turn of a linkage by search."""
    t2, t3 = closure(lengths, CRANK_ANGLES, assembly)
    angles = {"t1": CRANK_ANGLES, "t2": t2, "t3": t3}
    angles |= {"theta2": CRANK_ANGLES, "theta3": t2, "theta4": t3, "gamma": t3 - t2}
    return {**named(lengths), **angles, "pm": -1 if assembly == "open" else 1}


@cache
def places():
    """Return a turn of each linkage in both assemblies."""
    return [placed(lengths, assembly) for lengths in KINDS for assembly in ("open", "crossed")]


row("3.3", "3.9", check=holds(places))
row("3.4", derived=lambda: closure_rows(0), check=holds(places))
row("3.5", derived=lambda: freudenstein()[:1], check=holds(places))


@row("3.7", derived=lambda: freudenstein()[1:])
def freudenstein_of_the_coupler(entry):
    hold_derived(entry, places)
    for point in places():
        # The sign of K1 in front of the cosine is the slip: with t2 + pi under it, it is right.
        left, right = entry.printed.sides(**point)[0]
        slip = 2 * point["L4"] / point["L1"] * np.cos(point["t2"])
        assert np.abs(left - right + slip).max() < 1e-10 and np.abs(slip).max() > 0.5
    point = named(TABLE_3_2) | {"t1": 1.0, "t2": closure(TABLE_3_2, 1.0)[0][0]}
    quoted([np.subtract(*entry.printed.sides(**point)[0])], "-3.06")


def turned(ours, theirs):
    """Return the greatest distance of two arrays of angles, full turns apart or not."""
    return np.abs(np.angle(np.exp(1j * (ours - theirs)))).max()


@cache
def constants(lengths, assembly):
    """Return a turn with K1 to K5, as defined below (3.5) and (3.7)."""
    point = placed(lengths, assembly)
    for label in ("3.5", "3.7"):
        values = Formula(table("Aannaque")[label]["printed"]).values(**point)
        point = {**point, **values}
    return point


def random_linkages():
    """Return crank-rockers whose K2 and K4 differ."""
    sizes = np.random.default_rng(10).uniform((2.0, 0.9, 0.9), (4.0, 1.3, 1.3), (20, 3))
    return [(frame, 0.5, frame * first, frame * second) for frame, first, second in sizes]


def quadratic_latex(coupler):
    """Return the quadratic of the half angle."""
    first, middle, last = (latex(part) for part in half_angle_quadratic(coupler))
    return rf"\left({first}\right)u^2 + \left({middle}\right)u + \left({last}\right) = 0"


def half_tangent(name):
    """Return the check of one of the two roots, in both assemblies."""

    def check(entry):
        for lengths in (*KINDS, *random_linkages()):
            for assembly in ("open", "crossed"):
                point = constants(lengths, assembly)
                given = {k: v for k, v in point.items() if k != name}
                assert turned(entry.printed.values(**given)[name], point[name]) < 1e-7

    return check


row(
    "3.6",
    derived=lambda: r"u = \tan\tfrac{t_3}{2}:\; " + quadratic_latex(0),
    check=half_tangent("t3"),
)
row(
    "3.8",
    derived=lambda: r"u = \tan\tfrac{t_2}{2}:\; " + quadratic_latex(1),
    check=half_tangent("t2"),
)


def test_quadratics_of_the_half_angle():
    """``(1 + cos) u^2 = 1 - cos`` and ``(1 + cos) u = sin``: no division where u is infinite."""
    for coupler, name in ((0, "t3"), (1, "t2")):
        parts = sp.lambdify((*FREUDENSTEIN, TURNS[0]), half_angle_quadratic(coupler))
        for point in places():
            first, middle, last = parts(*(point[f"L{k}"] for k in (1, 2, 3, 4)), CRANK_ANGLES)
            angle = point[name]
            rest = first * (1 - np.cos(angle)) + last * (1 + np.cos(angle))
            assert np.abs(rest + middle * np.sin(angle)).max() < 1e-9 * np.abs(first).max()


@row("3.5 two assemblies")
def two_assemblies(_):
    for lengths in KINDS:
        opened, crossed = (placed(lengths, assembly) for assembly in ("open", "crossed"))
        pin = lengths[1] * np.exp(1j * CRANK_ANGLES) - lengths[0]
        assert turned(crossed["t3"], np.angle(pin**2 * np.exp(-1j * opened["t3"]))) < 1e-7


def extremes(lengths):
    """Return the least and the greatest transmission angle by a turn, and where they are."""
    m = motion(lengths)
    gamma = np.arccos(np.cos(m.theta4 - m.theta3))
    assert int(gamma.argmin()) == 0 and int(gamma.argmax()) == gamma.size // 2
    return {**named(lengths), "gamma_min": gamma.min(), "gamma_max": gamma.max()}


@row("3.10")
def extremes_of_the_transmission_angle(entry):
    hold(entry.printed, *map(extremes, KINDS))
    rocking = named((4.0, 3.0, 2.0, 2.0)) | {"gamma_min": 0.0, "gamma_max": 0.0}
    quoted([entry.printed.sides(**rocking)[1][1]], "-5.1")


@row("3.5 transmission angle of Table 3.2")
def within_the_recommended_band(entry):
    found = extremes(TABLE_3_2)
    angles = {k: found[k] for k in ("gamma_min", "gamma_max")}
    hold(entry.printed, angles)
    quoted(np.degrees(list(angles.values())), "45.6", "112.3")
    limits = [entry.printed.sides(**angles)[0][k] for k in (0, 3)]
    assert np.degrees(limits) == pytest.approx([40.0, 140.0])


@cache
def motions():
    """Return angles, speeds and accelerations of each linkage at 2 rad/s."""
    points = []
    for lengths in KINDS:
        for assembly in ("open", "crossed"):
            m = motion(lengths, assembly, 1024)
            names = {f"t{k}": getattr(m, f"theta{k + 1}") for k in (1, 2, 3)}
            names |= {f"omega{k}": 2 * getattr(m, f"omega{k + 1}") for k in (1, 2, 3)}
            names |= {f"alpha{k}": 4 * getattr(m, f"alpha{k + 1}") for k in (1, 2, 3)}
            points.append({**named(lengths), **names, "smith": {**named(lengths), **vars(m)}})
    return points


@row("3.11", derived=lambda: {name: rates()[name] for name in (omega3, omega4, alpha3, alpha4)})
def rates_hold(entry):
    hold(entry.printed, motions, tol=1e-7)
    hold_derived(entry, *(point["smith"] for point in motions()), tol=1e-7)


@cache
def table_forces(unsteady=0.0):
    """Return the true forces of Table 3.2's uniform bars near 1 rad/s in the letters of 3.7."""
    f, m = forces(TABLE_3_2, BARS, unsteady=unsteady), motion(TABLE_3_2, unsteady=unsteady)
    inertia = [-k.mass * rate(p, 2) for k, p in zip(BARS, centres(TABLE_3_2, BARS, m), strict=True)]
    pins = {"F_01": f.f12, "F_12": f.f23, "F_23": f.f34, "F_03": -f.f41, "F_21": -f.f23}
    pins |= {f"F_{k}": v for k, v in enumerate(inertia, 1)} | {"F_32": -f.f34}
    point = named(TABLE_3_2) | {"C": f.torque, "omega1": m.omega2, "dE": f.energy_rate}
    for k, bar in enumerate(BARS, 1):
        point |= {f"t{k}": getattr(m, f"theta{k + 1}"), f"J{k}": bar.inertia_about_centre}
        point |= {f"alpha{k}": getattr(m, f"alpha{k + 1}")}
    for name, force in pins.items():
        point |= {f"{name}x": force.real, f"{name}y": force.imag}
    return point


row(
    "3.7 free-body equations of the input link",
    "3.7 free-body equations of coupler and follower",
    check=holds(lambda: [table_forces()]),
)
UNKNOWNS = [f"F_{pin}{axis}" for pin in ("01", "12", "23", "03") for axis in "xy"]


def samples(step, unsteady=0.0):
    """Return the same at single angles, for matrices."""
    point = table_forces(unsteady)
    return [{k: v[at] if np.ndim(v) else v for k, v in point.items()} for at in range(5, 512, step)]


@row("3.12")
def nine_equations(entry):
    """Two faults: the torque of row 3, and the sign of F12y in row 5; the crank's speed varies."""
    for point in samples(100, unsteady=0.2):
        left, right = entry.printed.sides(**point)[0]
        slips = np.array([0, 0, point["C"], 0, -2 * point["F_12y"], 0, 0, 0, 0])
        np.testing.assert_allclose(right - left, slips, atol=1e-9)
        hold(entry.corrected, point)
    wrong = []
    for point in samples(4):
        units = (dict.fromkeys(UNKNOWNS, 0.0) | {name: 1.0} for name in UNKNOWNS)
        columns = [entry.printed.sides(**{**point, **unit})[0][0] for unit in units]
        right = entry.printed.sides(**point)[0][1]
        found = np.linalg.solve(np.column_stack([*columns, np.eye(9)[2]]), right)
        wrong.append(found[8] - point["C"])
    peak = np.abs(table_forces()["C"]).max()
    assert np.abs(wrong).max() / peak == pytest.approx(2.63, abs=0.01)


@row("3.7 torque of the motor")
def torque_fluctuates(_):
    torque, speed, rate_ = (table_forces()[name] for name in ("C", "omega1", "dE"))
    assert abs(torque.mean()) < 1e-10 * np.abs(torque).max()
    assert np.abs(torque * speed - rate_).max() < 1e-9 * np.abs(torque).max()
    quoted([torque.min(), torque.max()], "-0.0105", "0.0071")


@cache
def joint_accelerations():
    """Return Table 3.2 at 2 rad/s with the accelerations of the joints by differentiation."""
    m = motion(TABLE_3_2)
    pin_a = TABLE_3_2[1] * np.exp(1j * m.theta2)
    a, b = rate(pin_a, 2), rate(pin_a + TABLE_3_2[2] * np.exp(1j * m.theta3), 2)
    found = {"q_Ax": a.real, "q_Ay": a.imag, "q_Bx": b.real, "q_By": b.imag, "q_t1": m.alpha2}
    found |= {"q_t2": m.alpha3, "q_t3": m.alpha4}
    speeds = {"omega1": 2 * m.omega2, "omega2": 2 * m.omega3, "t1": m.theta2, "t2": m.theta3}
    spins = {"alpha2": 4 * m.alpha3, "alpha3": 4 * m.alpha4}
    return {**named(TABLE_3_2), **{f"{k}_ddot": 4 * v for k, v in found.items()}, **speeds, **spins}


@row("3.13")
def accelerations_of_the_joints(entry):
    p = joint_accelerations()
    hold(entry.corrected, p, tol=1e-8)
    lost = p["L2"] * (np.sin(p["t2"]) - np.sin(p["t1"]))
    slips = [0.0] * 4 + [-p["alpha2"] * lost, -(p["omega2"] ** 2) * lost, 0.0]
    size = np.hypot(p["q_Bx_ddot"], p["q_By_ddot"]).max()
    for (true, printed), slip in zip(entry.printed.sides(**p), slips, strict=True):
        assert np.abs(true - printed - slip).max() < 1e-8 * size
    worst = [np.abs(slip).max() / size for slip in slips[4:6]]
    assert worst == pytest.approx([1.31, 0.53], abs=0.006)


test_row, test_falsified_row = row.tests()
