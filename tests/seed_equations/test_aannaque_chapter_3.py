"""Aannaque chapter 3: mobility, classes, transmission angle, motion, pin forces and torque."""

import itertools
from functools import cache

import numpy as np
import pytest
from elastolink.runtime.linkages import classify, mobility
from seed_ledger import Ledger, hold, holds, quoted, truths
from seed_rigid import TABLE_3_2, Link, forces, plane
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, TURN, closure, motion

row = Ledger("Aannaque", __file__)
# Lengths stand here in the order frame, input, coupler, output: L4, L1, L2, L3 of the text.
WHOLE_NUMBERS = [
    lengths
    for lengths in itertools.product(range(1, 8), repeat=4)
    if 2 * max(lengths) < sum(lengths)
]


kind = cache(classify)


def turning(lengths):
    """Return C or R for input, coupler and output: which of them turns fully about the frame."""
    return "".join("C" if full else "R" for full in kind(lengths).turns.values())


def excess(lengths):
    """Return s + l - p - q."""
    s, p, q, longest = sorted(lengths)
    return s + longest - p - q


@row("3.1 condition of the crank-rocker", "3.4 Grashof's theorem")
def which_links_revolve(entry):
    """The coupler counts."""
    assert len(WHOLE_NUMBERS) == 2121
    for lengths in WHOLE_NUMBERS:
        letters = turning(lengths)
        held = truths(entry.printed, **dict(zip("spql", sorted(lengths), strict=True)))
        if entry.label.startswith("3.1"):
            change_point = excess(lengths) == 0
            assert letters != "CRR" or change_point or (held[0] and lengths[1] == min(lengths))
            assert held[0] == (excess(lengths) < 0)
        else:
            assert held == ["C" in letters, "C" not in letters], lengths
    assert excess(DRAG_LINK) < 0 and turning(DRAG_LINK) == "CCC"


# Symbols of Table 3.1 with the initials of the printed names.
PRINTED_NAMES = {"GCCC": "CCC", "GCRR": "CRC", "GRCR": "RCR", "GRRC": "RRC"}
PRINTED_NAMES |= {f"RRR{k}": "RRR" for k in (1, 2, 3, 4)}
PRINTED_NAMES |= {"CPCCC": "CCC", "CPCRR": "CRR", "CPRCR": "RCR", "CPRRC": "RRC"}


def flat_positions(lengths):
    """Return in how many ways the loop lies on one line."""
    frame, *others = lengths
    signs = itertools.product((1, -1), repeat=3)
    return sum(frame == sum(a * b for a, b in zip(choice, others, strict=True)) for choice in signs)


@row(
    "Table 3.1 classes", "Table 3.1 names", "Table 3.1 relations of the lengths",
    "Table 3.1 double and triple change points",
)  # fmt: skip
def classes(_):
    symbols = {lengths: kind(lengths).symbol for lengths in WHOLE_NUMBERS}
    assert set(symbols.values()) == {*PRINTED_NAMES, "CP2X", "CP3X"}
    for lengths, symbol in symbols.items():
        flat = {"CP2X": 2, "CP3X": 3}.get(symbol, int(symbol.startswith("CP")))
        assert flat_positions(lengths) == flat
        if symbol in PRINTED_NAMES:
            assert (PRINTED_NAMES[symbol] == turning(lengths)) == (symbol != "GCRR")
    double_cranks = [lengths for lengths, symbol in symbols.items() if symbol == "GCCC"]
    assert len(double_cranks) == 231 and max(map(excess, double_cranks)) < 0
    assert turning(CRANK_ROCKERS["5,1,5,2"]) == "CRR"
    swing = np.degrees(np.ptp(motion(CRANK_ROCKERS["5,1,5,2"]).theta4))
    assert swing == pytest.approx(61.0, abs=0.1)


@row("3.2")
def planes_of_the_solution_space(entry):
    rng = np.random.default_rng(8)
    for others in rng.uniform(0.5, 2.0, (12, 3)):
        for place in range(4):
            frame, first, second, third = np.insert(others, place, others.sum())
            ratios = {f"lam{k}": v / first for k, v in ((2, second), (3, third), (4, frame))}
            on = [abs(a - b) < 1e-12 for a, b in entry.printed.sides(**ratios)]
            assert on == [k == {0: 3, 1: 1, 2: 0, 3: 2}[place] for k in range(4)]


@row("3.4 distance of a base plane")
def distance_of_a_base_plane(entry):
    normal = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
    for point in np.random.default_rng(8).uniform(0.1, 3.0, (5, 3)):
        foot = (point @ normal) * normal
        assert foot[0] == pytest.approx(foot[2]) and (point - foot) @ normal == pytest.approx(0.0)
        ratios = dict(zip(("lam2", "lam3", "lam4"), point, strict=True))
        hold(entry.printed, {**ratios, "lam": np.linalg.norm(foot)})


# Links and pins of chains; the mobility that they have.
CHAINS = {
    "three bars": (3, ("01", "12", "20"), 0),
    "four bars": (4, ("01", "12", "23", "30"), 1),
    "five bars": (5, ("01", "12", "23", "34", "40"), 2),
    "Watt": (6, ("01", "12", "23", "30", "24", "45", "53"), 1),
    "braced": (5, ("01", "12", "23", "30", "04", "42"), 0),
}
PARALLEL = ("01", "02", "03", "41", "42", "43")


def rank_of(pins, places=None):
    """Return Kutzbach's count and the mobility by rank; the pins lie anywhere unless given."""
    places = np.random.default_rng(9).uniform(-1, 1, (len(pins), 2)) if places is None else places
    found = mobility(pins, coordinates=places)
    return found.kutzbach, found.instantaneous


def cranks(pivots, angle=0.7):
    """Return the places of the pins of parallel cranks, pivots first."""
    tips = pivots + 0.8 * np.exp(1j * angle)
    return np.column_stack([np.r_[pivots, tips.real], np.r_[0 * pivots, tips.imag]])


@row("3.2 Kutzbach's criterion", "3.2 Gruebler's criterion", "3.2 mobility of the four-bar")
def mobilities(entry):
    for name, (links, pins, count) in CHAINS.items():
        assert rank_of(pins)[1] == count
        given = {"k": links, "j1": len(pins), "j2": 0}
        if "four-bar" in entry.label:
            assert name != "four bars" or entry.printed.values()["m"] == count
        elif "Kutzbach" in entry.label:
            assert entry.printed.values(**given)["m"] == count
            # A quick return: crank, and a rod that slides on its pin.
            assert entry.printed.values(k=3, j1=2, j2=1)["m"] == 1
        else:
            (one, many), (rest, zero) = entry.printed.sides(**given)
            assert many - one == rest - zero == count - 1


@row("3.2 redundant constraints at m < 0")
def redundant_constraints(_):
    assert rank_of(("01", "12", "23", "30", "04", "42", "15", "53")) == (-1, 0)
    pins = [end + crank for end in "05" for crank in "1234"]
    assert rank_of(pins, cranks(np.array([0.0, 1.3, 2.0, 2.4]))) == (-1, 1)


@row("3.2 no motion at m = 0", "3.2 odd number of links")
def parallel_cranks(_):
    for angle in np.linspace(0.3, 6.0, 7):
        assert rank_of(PARALLEL, cranks(np.array([0.0, 1.3, 2.0]), angle)) == (0, 1)
    assert rank_of(PARALLEL) == (0, 0)
    assert 1 not in [3 * (k - 1) - 2 * j for k in (3, 5, 7, 9) for j in range(k, 3 * k)]


@cache
def advantages():
    """Return speeds, angles, and the torques of a unit pull in the coupler about A and D."""
    points = []
    for lengths in (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], LONG_CRANK, DRAG_LINK):
        m = motion(lengths)
        frame, l1, l2, l3 = lengths
        pull = np.exp(1j * m.theta3)
        torques = {"T1": l1 * np.imag(np.exp(-1j * m.theta2) * pull)}
        torques |= {"T3": l3 * np.imag(np.exp(-1j * m.theta4) * pull)}
        angles = {"beta": m.theta3 - m.theta2, "gamma": m.theta3 - m.theta4, "t1": m.theta2}
        usable = np.abs(np.sin(angles["beta"])) > 0.02
        values = {**torques, **angles, "omega1": m.omega2, "omega3": m.omega4}
        values = {k: v[usable & (np.abs(m.omega4) > 1e-2)] for k, v in values.items()}
        points.append({**values, "L1": l1, "L2": l2, "L3": l3, "L4": frame})
    return points


row("3.3 torques and speeds", check=holds(advantages, tol=1e-6))


@row("3.1")
def mechanical_advantage(entry):
    hold(entry.corrected, advantages, tol=1e-6)
    for point in advantages():
        hold(entry.printed, {**point, "L4": point["L1"]}, tol=1e-6)
    m = motion(TABLE_3_2)
    half = m.theta2.size // 2
    beta, gamma = (m.theta3 - angle for angle in (m.theta2, m.theta4))
    point = {"L4": TABLE_3_2[0], "L3": TABLE_3_2[3], "beta": beta[half], "gamma": gamma[half]}
    printed = entry.printed.sides(**point, T1=1, T3=1, omega1=1, omega3=1)[0][2]
    quoted([1 / abs(m.omega4[half]), abs(printed)], "4.22", "1.31")


@row("3.3 best force transmission at 90 deg", "3.3 mechanical advantage and transmission angle")
def factor_of_the_transmission_angle(entry):
    for point in advantages():
        hold(entry.corrected, {**point, "F": 1.0, "T3": np.abs(point["T3"])})


@row("3.3 toggle at beta = 0 or 180 deg")
def toggle(_):
    """Outer and inner dead centre of crank and coupler."""
    frame, l1, l2, l3 = TABLE_3_2
    for stretched in (1, -1):
        side = abs(l2 + stretched * l1)
        theta2 = np.arccos((frame**2 + side**2 - l3**2) / (2 * frame * side))
        theta2 += 0.0 if stretched > 0 else np.pi
        theta3, theta4 = (v[0] for v in closure(TABLE_3_2, theta2))
        on_crank, on_follower = np.sin(theta3 - theta2), np.sin(theta3 - theta4)
        assert abs(on_crank) < 1e-9 * abs(on_follower)


@row("3.3 extremes at 0 and 180 deg")
def extremes_of_the_transmission_angle(entry):
    for lengths in (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], LONG_CRANK, DRAG_LINK):
        m = motion(lengths)
        gamma = m.transmission_angle
        assert {int(gamma.argmin()), int(gamma.argmax())} == {0, gamma.size // 2}
        slope = np.sign(np.sin(m.theta4 - m.theta3)) * (m.omega4 - m.omega3)
        names = dict(zip(("L4", "L1", "L2", "L3"), lengths, strict=True))
        point = {**names, "t1": m.theta2, "gamma": gamma, "D": lambda *_, s=slope: s}
        hold(entry.corrected, point, tol=1e-7)
    frame, crank, coupler, follower = 4.0, 3.0, 2.0, 2.0
    assert turning((frame, crank, coupler, follower))[0] == "R"
    stop = np.arccos((frame**2 + crank**2 - (coupler + follower) ** 2) / (2 * frame * crank))
    assert np.degrees(stop) == pytest.approx(68.0, abs=0.05)


KINDS = (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], CRANK_ROCKERS["2,1,2,2"], LONG_CRANK, DRAG_LINK)
CRANK_ANGLES = np.linspace(0.03, TURN - 0.02, 61)
SECTIONS = ((24.8e-3, 6.35e-3), (25e-3, 3.42e-3), (25e-3, 3.15e-3))
BARS = tuple(
    Link.uniform_bar(7850.0 * width * thick * length, length)
    for (width, thick), length in zip(SECTIONS, TABLE_3_2[1:], strict=True)
)


def letters(lengths):
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
    return {**letters(lengths), **angles, "pm": -1 if assembly == "open" else 1}


@cache
def places():
    """Return a turn of each linkage in both assemblies."""
    return [placed(lengths, assembly) for lengths in KINDS for assembly in ("open", "crossed")]


row("3.3", "3.4", "3.5", "3.9", check=holds(places))


@row("3.7")
def freudenstein_of_the_coupler(entry):
    hold(entry.corrected, places)
    point = letters(TABLE_3_2) | {"t1": 1.0, "t2": closure(TABLE_3_2, 1.0)[0][0]}
    quoted([np.subtract(*entry.printed.sides(**point)[0])], "-3.06")


def turned(ours, theirs):
    """Return the greatest distance of two arrays of angles, full turns apart or not."""
    return np.abs(np.angle(np.exp(1j * (ours - theirs)))).max()


@cache
def constants(lengths, assembly):
    """Return a turn with K1 to K5, as defined below (3.5) and (3.7)."""
    point = placed(lengths, assembly)
    for label in ("3.5", "3.7"):
        values = row.cell(label).values(**point)
        point = {**point, **values}
    return point


def half_tangent(name):
    """Return the check of one of the two roots, in both assemblies."""

    def check(entry):
        for lengths in KINDS:
            for assembly in ("open", "crossed"):
                point = constants(lengths, assembly)
                given = {k: v for k, v in point.items() if k != name}
                assert turned(entry.printed.values(**given)[name], point[name]) < 1e-7

    return check


row("3.6", check=half_tangent("t3"))
row("3.8", check=half_tangent("t2"))


@row("3.5 two assemblies")
def two_assemblies(_):
    for lengths in KINDS:
        opened, crossed = (placed(lengths, assembly) for assembly in ("open", "crossed"))
        pin = lengths[1] * np.exp(1j * CRANK_ANGLES) - lengths[0]
        assert turned(crossed["t3"], np.angle(pin**2 * np.exp(-1j * opened["t3"]))) < 1e-7


def extremes(lengths):
    """Return the least and the greatest transmission angle by a turn, and where they are."""
    m = motion(lengths)
    gamma = m.transmission_angle
    assert int(gamma.argmin()) == 0 and int(gamma.argmax()) == gamma.size // 2
    return {**letters(lengths), "gamma_min": gamma.min(), "gamma_max": gamma.max()}


@row("3.10")
def extremes_of_the_angle(entry):
    hold(entry.printed, *map(extremes, KINDS))
    rocking = letters((4.0, 3.0, 2.0, 2.0)) | {"gamma_min": 0.0, "gamma_max": 0.0}
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
            m = motion(lengths, assembly)
            names = {f"t{k}": getattr(m, f"theta{k + 1}") for k in (1, 2, 3)}
            names |= {f"omega{k}": 2 * getattr(m, f"omega{k + 1}") for k in (1, 2, 3)}
            names |= {f"alpha{k}": 4 * getattr(m, f"alpha{k + 1}") for k in (1, 2, 3)}
            points.append({**letters(lengths), **names})
    return points


row("3.11", check=holds(motions))


@cache
def table_forces(unsteady=0.0):
    """Return the true forces of Table 3.2's uniform bars near 1 rad/s in the letters of 3.7."""
    f, m = forces(TABLE_3_2, BARS, unsteady=unsteady), motion(TABLE_3_2, unsteady=unsteady)
    inertia = [-bar.mass * a for bar, a in zip(BARS, (f.a2, f.a3, f.a4), strict=True)]
    pins = {"F_01": f.f12, "F_12": f.f23, "F_23": f.f34, "F_03": -f.f41, "F_21": -f.f23}
    pins |= {f"F_{k}": v for k, v in enumerate(inertia, 1)} | {"F_32": -f.f34}
    point = letters(TABLE_3_2) | {"C": f.torque, "omega1": m.omega2}
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
    torque = table_forces()["C"]
    assert abs(torque.mean()) < 1e-10 * np.abs(torque).max()
    quoted([torque.min(), torque.max()], "-0.0105", "0.0071")


@cache
def joint_accelerations():
    """Return Table 3.2 at 2 rad/s with the accelerations of the joints."""
    m = motion(TABLE_3_2)
    ends = (("crank", TABLE_3_2[1]), ("follower", TABLE_3_2[3]))
    a, b = (plane(m.point(*end).acceleration) for end in ends)
    found = {"q_Ax": a.real, "q_Ay": a.imag, "q_Bx": b.real, "q_By": b.imag, "q_t1": m.alpha2}
    found |= {"q_t2": m.alpha3, "q_t3": m.alpha4}
    speeds = {"omega1": 2 * m.omega2, "omega2": 2 * m.omega3, "t1": m.theta2, "t2": m.theta3}
    spins = {"alpha2": 4 * m.alpha3, "alpha3": 4 * m.alpha4}
    found = {f"{name}_ddot": 4 * value for name, value in found.items()}
    return {**letters(TABLE_3_2), **found, **speeds, **spins}


@row("3.13")
def accelerations_of_the_joints(entry):
    p = joint_accelerations()
    hold(entry.corrected, p, tol=1e-8)
    lost = p["L2"] * (np.sin(p["t2"]) - np.sin(p["t1"]))
    slips = [0.0] * 4 + [-p["alpha2"] * lost, -(p["omega2"] ** 2) * lost, 0.0]
    size = np.hypot(p["q_Bx_ddot"], p["q_By_ddot"]).max()
    for (true, printed), slip in zip(entry.printed.sides(**p), slips, strict=True):
        assert np.abs(true - printed - slip).max() < 1e-8 * size
    quoted([np.abs(slip).max() / size for slip in slips[4:6]], "1.31", "0.53")


test_row, test_falsified_row = row.tests()
