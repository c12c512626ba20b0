"""Smith chapter 2 and appendix 1: position, velocity and acceleration of the four-bar linkage."""

from functools import cache

import numpy as np
import seed_truth as truth
import sympy as sp
from elastolink.runtime.linkages import FourBar
from seed_ledger import Ledger, hold, holds, is_zero, quoted

row = Ledger("Smith", __file__)
ROCKERS = (*truth.CRANK_ROCKERS.values(), truth.LONG_CRANK)
FIVE = truth.CRANK_ROCKERS["5,1,5,2"]


def placed(lengths, theta2, assembly="open"):
    """Return lengths and angles by search, and the other quantities of both triangles."""
    l1, l2, l3, l4 = lengths
    theta3, theta4 = truth.closure(lengths, theta2, assembly)
    pin = l2 * np.exp(1j * theta2) - l1
    BD = np.abs(pin)
    half = np.where(np.sin(theta2) > 0, 1.0, -1.0)
    return {
        **truth.named(lengths),
        **truth.vectors(lengths, (theta2, theta3, theta4)),
        **{"theta2": theta2, "theta3": theta3, "theta4": theta4, "BD": BD},
        "sin_theta4": np.sin(theta4),
        "A": 2 * l4 * (l2 * np.cos(theta2) - l1),
        "B": l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * np.cos(theta2),
        "C": 2 * l2 * l4 * np.sin(theta2),
        "ADB": np.arccos((l1**2 + BD**2 - l2**2) / (2 * l1 * BD)),
        "BDC": np.arccos((l4**2 + BD**2 - l3**2) / (2 * l4 * BD)),
        "pm": half if assembly == "open" else -half,
        "phi": np.pi - np.angle(pin),
        "lam": np.arccos(np.real(-pin / BD * np.exp(-1j * theta3))),
        "psi": np.arccos(np.real(pin / BD * np.exp(-1j * theta4))),
    }


@cache
def places(kinds=(*ROCKERS, truth.DRAG_LINK), assemblies=("open", "crossed")):
    """Return a turn of each linkage."""
    theta2 = np.linspace(0.05, truth.TURN - 0.04, 61)
    return [placed(lengths, theta2, assembly) for lengths in kinds for assembly in assemblies]


def rockers():
    """Return a turn of the linkages whose follower swings."""
    return places(ROCKERS)


def opened():
    """Return a turn of drag links and crank-rockers in the open assembly."""
    return places((truth.DRAG_LINK, truth.LONG_CRANK, truth.CRANK_ROCKERS["2,1,2,2"]), ("open",))


@cache
def motions():
    """Return lengths, angles, speeds and accelerations at even and uneven crank speed."""
    points = []
    for lengths in (FIVE, truth.CRANK_ROCKERS["2,1,2,2"], truth.DRAG_LINK):
        for assembly in ("open", "crossed"):
            for unsteady in (0.0, 0.3):
                m = truth.motion(lengths, assembly, unsteady=unsteady)
                turned = truth.vectors(lengths, (m.theta2, m.theta3, m.theta4))
                points.append({**truth.turning(lengths, m), **turned})
    return points


row("2.1", check=holds(places, tol=1e-12))


def divisor(point):
    """Return the point with D."""
    return {**point, "D": np.hypot(point["A"], point["C"])}


@row("2.2")
def divisor_and_sign_of_the_root(entry):
    for form in (entry.printed[0], entry.corrected):
        hold(form, *map(divisor, rockers()), tol=1e-8)
    both = [placed(FIVE, np.array([1.0]), assembly) for assembly in ("open", "crossed")]
    quoted([np.cos(p["theta4"][0]) for p in both], "0.2072", "-0.1636")
    quoted([entry.printed.sides(**p)[0][1][0] for p in both], "0.0102", "-0.0101")


row("2.3", check=holds(places))
row(
    "2.2.1 products of cosines and sines",
    check=lambda entry: hold(entry.printed, *map(divisor, rockers()), tol=2e-8),
)


@row("2.4")
def angles_of_both_triangles(entry):
    for form in (entry.printed, entry.corrected):
        hold(form, *rockers())
        for point in rockers():
            one, other = form.sides(**{**point, "pm": -point["pm"]})[0]
            assert np.abs(one - other).max() > 0.05


@row("2.2.1 crossed angle")
def crossed_angle(entry):
    point = placed(FIVE, np.array([1.0]), "crossed")
    point["theta4_p"] = point["theta4"] % truth.TURN
    hold(entry.corrected, point)
    quoted(np.ravel(entry.printed.sides(**point)), "-1.41", "1.41")


@row("2.2.1 quadrants")
def follower_stays_on_its_side(_):
    rng = np.random.default_rng(2)
    theta2 = np.linspace(0.03, truth.TURN - 0.02, 25)
    for _ in range(300):
        others = rng.uniform(1.0, 4.0, 3)
        slack = others.sum() - 2 * others.max()
        if slack < 0.1:
            continue
        crank = rng.uniform(0.05, 0.98) * min(others.min(), slack)
        lengths = (others[0], crank, others[1], others[2])
        for assembly, sign in (("open", 1.0), ("crossed", -1.0)):
            assert np.all(sign * np.sin(truth.closure(lengths, theta2, assembly)) > 0)
    sine = np.sin(truth.closure(truth.DRAG_LINK, theta2)[1])
    assert sine.min() < -0.9 and sine.max() > 0.9


def same_turn(point):
    """Return the point with theta3 and theta4 in the turn of the document's."""
    nominal = {"theta3": point["lam"] - point["phi"], "theta4": np.pi - point["phi"] - point["psi"]}
    turns = {k: np.round((v - point[k]) / truth.TURN) for k, v in nominal.items()}
    return {**point, **{k: point[k] + truth.TURN * turns[k] for k in nominal}}


row("2.2.2 phi", check=holds(opened, tol=1e-7))
row("2.2.2 lambda and psi", check=holds(opened))
row("2.2.2 theta3 and theta4", check=holds(lambda: map(same_turn, places(assemblies=("open",)))))


row("2.5", "2.6", "2.7", check=holds(motions))


@row("Fig. 5 instantaneous centre")
def instantaneous_centre(entry):
    """The centre lies on the line of the crank and on the line of the follower."""
    point = motions()[0]
    crank, follower = (point[name] / abs(point[name]) for name in ("l2_vec", "l4_vec"))
    # Where l2 u2 + s u2 = l1 + r u4, s along the crank.
    s = np.imag((point["l1"] - point["l2_vec"]) * np.conj(follower)) / np.imag(
        crank * np.conj(follower)
    )
    hold(entry.printed, {**point, "BI": s})
    hold(entry.corrected, {**point, "BI": s, "l1": 1.0})


row("2.8", "2.9", "2.10", check=holds(motions))


@row("2.5 limits of the crank length")
def limits_of_the_crank_length(entry):
    short = truth.motion((1.0, 1e-6, 1.0, 1.0))
    first = {"theta4_0": short.theta4, "omega4_0": short.omega4, "alpha4_0": short.alpha4}
    theta2 = np.linspace(0.5, 2.6, 30)
    rhomb = FourBar(1.0, 1.0 - 1e-9, 1.0, 1.0)
    second = {**truth.rates(rhomb.motion(theta2)), "alpha2": 0.0}
    for one, other in entry.printed.sides(**first, **second):
        assert np.abs(one - other).max() < 1e-3
    assert np.abs(short.theta4 - 120 * np.pi / 180).max() < 1.2e-6
    _, crossed = truth.closure(rhomb.lengths.values(), theta2, "crossed")
    assert np.abs(crossed - theta2).min() > 0.4


@row("Appendix 1 coupler angle")
def coupler_angle(entry):
    for point in places():
        cosine, sine = (side / point["l3"] for _, side in entry.printed.sides(**point))
        hold(entry.printed, point)
        assert np.abs(cosine + 1j * sine - np.exp(1j * point["theta3"])).max() < 1e-12


row("A.1", "A.2", "A.3", "A.4", "A.5", "Appendix 1 regrouped (A.5)", "A.7", check=holds(places))


def ratios(point):
    """Return the point with the ratios by which (A.5) is cos(theta2 - theta4)."""
    one = np.cos(point["theta2"] - point["theta4"])
    columns = np.array([np.cos(point["theta2"]), np.cos(point["theta4"]), 1 + 0 * one]).T
    (minus_R1, R2, R3), *_ = np.linalg.lstsq(columns, one, rcond=None)
    return {**point, "R1": -minus_R1, "R2": R2, "R3": R3}


row("Appendix 1 ratios R1, R2, R3", check=holds(lambda: map(ratios, places()), tol=1e-7))


@row("A.6")
def freudenstein(entry):
    hold(entry.corrected, *map(ratios, places()))
    point = placed(FIVE, np.array([1.0])) | {"R1": 2.5, "R2": 5.0, "R3": 1.25}
    quoted(np.ravel(entry.printed.sides(**point)), "-0.9352", "0.9352")


@row("A.8")
def roots_of_the_quadratic(entry):
    hold(entry.printed, *map(divisor, rockers()), tol=1e-8)
    A, B, C = sp.symbols("A B C", real=True)
    for sign in (1, -1):
        root = entry.printed.sides(A=A, B=B, C=C, D=sp.sqrt(A**2 + C**2), pm=sign, theta4=A)[0][1]
        assert is_zero((A * root + B) ** 2 - C**2 * (1 - root**2))


test_row, test_falsified_row = row.tests()
