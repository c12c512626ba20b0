"""Aannaque 3.1-3.4: mobility, mechanical advantage, transmission angle, and the classes."""

import itertools

import numpy as np
import pytest
from seed_ledger import establishes
from seed_rigid import TABLE_3_2, motion, sweeps, turning_letters
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, closure

# Lengths stand here in the order frame, input, coupler, output: L4, L1, L2, L3 of the text.
WHOLE_NUMBERS = [
    lengths
    for lengths in itertools.product(range(1, 8), repeat=4)
    if 2 * max(lengths) < sum(lengths)
]


def excess(lengths):
    """Return s + l - p - q."""
    s, p, q, longest = sorted(lengths)
    return s + longest - p - q


@establishes(
    "Aannaque",
    "3.1 condition of the crank-rocker",
    printed=r"\text{crank-rocker: } s + \ell < p + q",
    verdict="agrees",
    derived=r"s + \ell < p + q \text{ and } L_1 = s",
    remark="Necessary, with = for a change point; not sufficient: (2,4,5,4.5) satisfies it and its "
    "output turns fully as well.",
)
@establishes(
    "Aannaque",
    "3.4 Grashof's theorem",
    printed=r"s + \ell \le p + q: \text{ at least one revolving link};\; "
    r"s + \ell > p + q: \text{ all links rock}",
    verdict="agrees",
    derived=r"\text{a link sweeps every angle to the frame} \iff s + \ell \le p + q",
    remark="Brute force over whole-number lengths below 8, input, coupler and output, each at "
    "721 angles, for 2121 linkages. The coupler "
    "counts: for s = coupler it alone revolves.",
)
def test_which_links_revolve():
    assert len(WHOLE_NUMBERS) == 2121
    for lengths in WHOLE_NUMBERS:
        letters = turning_letters(lengths)
        assert ("C" in letters) == (excess(lengths) <= 0), lengths
        if letters == "CRR" and excess(lengths) < 0:
            assert lengths[1] == min(lengths)
    rng = np.random.default_rng(7)
    for lengths in rng.uniform(1.0, 4.0, (300, 4)):
        if 2 * lengths.max() < lengths.sum():
            assert ("C" in turning_letters(lengths)) == (excess(lengths) < 0)
    assert excess(DRAG_LINK) < 0 and turning_letters(DRAG_LINK) == "CCC"


PRINTED_ROWS = {
    ("<", "s", 0): ("crank-crank-crank", "CCC"),
    ("<", "s", 1): ("crank-rocker-crank", "CRR"),
    ("<", "s", 2): ("rocker-crank-rocker", "RCR"),
    ("<", "s", 3): ("rocker-rocker-crank", "RRC"),
    (">", "l", 0): ("rocker-rocker-rocker", "RRR"),
    (">", "l", 1): ("rocker-rocker-rocker", "RRR"),
    (">", "l", 2): ("rocker-rocker-rocker", "RRR"),
    (">", "l", 3): ("rocker-rocker-rocker", "RRR"),
    ("=", "s", 0): ("crank-crank-crank", "CCC"),
    ("=", "s", 1): ("crank-rocker-rocker", "CRR"),
    ("=", "s", 2): ("rocker-crank-rocker", "RCR"),
    ("=", "s", 3): ("rocker-rocker-crank", "RRC"),
}


def flat_positions(lengths):
    """Return in how many ways the loop lies on one line."""
    frame, *others = lengths
    signs = itertools.product((1, -1), repeat=3)
    return sum(frame == sum(a * b for a, b in zip(choice, others, strict=True)) for choice in signs)


def row_of(lengths):
    """Return the key of Table 3.1 for lengths with at most one flat position."""
    relation = "<=>"[int(np.sign(excess(lengths))) + 1]
    end = max(lengths) if relation == ">" else min(lengths)
    assert lengths.count(end) == 1, "the mark of the class is never shared"
    return relation, "l" if relation == ">" else "s", lengths.index(end)


@establishes(
    "Aannaque",
    "Table 3.1 classes",
    printed=r"\text{14 classes: by } s \text{ for } <,\; \text{by } \ell \text{ for } >,\; "
    r"\text{by } s \text{ for } =,\; \text{and two more}",
    verdict="agrees",
    derived=r"\text{every linkage falls in exactly one}",
    remark="Equal lengths cause no doubt: two equal shortest links exclude <, two equal longest "
    "exclude >, and = with either is a double change point.",
)
@establishes(
    "Aannaque",
    "Table 3.1 names",
    printed=r"\text{row 2: Grashof crank-rocker-crank, GCRR}",
    verdict="slip",
    derived=r"\text{Grashof crank-rocker-rocker}",
    remark="The output does not turn: for (5,1,5,2) it swings through 61 deg. The symbol is right, "
    "and so are the other 11 names, against brute force.",
)
@establishes(
    "Aannaque",
    "Table 3.1 relations of the lengths",
    printed=r"\text{row 1: } \sim;\; \text{rows 2-4: } <;\; \text{5-8: } >;\; \text{9-14: } =",
    verdict="slip",
    derived=r"\text{row 1: } <",
    remark="The scan's row 1 has another sign: all 231 whole-number double cranks below 8 have s "
    "+ l < p + q. Row 5 and the text around it have 1 where the letter l belongs.",
)
@establishes(
    "Aannaque",
    "Table 3.1 double and triple change points",
    printed=r"\text{two equal pairs: CP2X};\; L_1 = L_2 = L_3 = L_4: \text{CP3X}",
    verdict="agrees",
    derived=r"\text{2 and 3 flat positions}",
)
def test_table_3_1():
    seen, double_cranks = set(), 0
    for lengths in WHOLE_NUMBERS:
        flat = flat_positions(lengths)
        pairs = sorted(lengths)
        if len(set(lengths)) == 1:
            assert flat == 3
        elif pairs[0] == pairs[1] and pairs[2] == pairs[3]:
            assert flat == 2
        else:
            assert flat == (excess(lengths) == 0)
            row = row_of(lengths)
            seen.add(row)
            name, letters = PRINTED_ROWS[row]
            turning = turning_letters(lengths)
            assert turning == letters
            double_cranks += row == ("<", "s", 0)
            spelled = "".join(word[0].upper() for word in name.split("-"))
            assert (spelled == turning) == (row != ("<", "s", 1))
    assert seen == set(PRINTED_ROWS)
    assert double_cranks == 231
    lengths = CRANK_ROCKERS["5,1,5,2"]
    assert turning_letters(lengths) == "CRR"
    swing = np.degrees(np.ptp(motion(lengths).theta4))
    assert swing == pytest.approx(61.0, abs=0.1)


@establishes(
    "Aannaque",
    "3.2",
    printed=r"\lambda_2 = 1 + \lambda_3 + \lambda_4,\; 1 = \lambda_2 + \lambda_3 + \lambda_4,\; "
    r"\lambda_3 = \lambda_2 + 1 + \lambda_4,\; \lambda_4 = \lambda_2 + \lambda_3 + 1",
    verdict="agrees",
    derived=r"\ell = s + p + q",
    remark="On a plane the loop closes in one flat position only; beyond it, in none.",
)
@establishes(
    "Aannaque",
    "3.4 distance of a base plane",
    printed=r"\lambda = \frac{\lambda_2 + \lambda_3 + \lambda_4}{\sqrt 3}",
    verdict="agrees",
    derived=r"\frac{(\lambda_2, \lambda_3, \lambda_4)\cdot(1, 1, 1)}{\lVert(1, 1, 1)\rVert}",
    remark="The distance from the origin along the normal lambda2 = lambda3 = lambda4.",
)
def test_planes_of_the_solution_space():
    rng = np.random.default_rng(8)
    angles = np.linspace(0.0, 2 * np.pi, 1441)
    for others in rng.uniform(0.5, 2.0, (12, 3)):
        for place in range(4):
            for factor, closes in ((0.995, True), (1.005, False)):
                lengths = np.insert(others, place, factor * others.sum())
                frame, first, second, third = lengths
                distance = np.abs(frame - first * np.exp(1j * angles))
                found = (abs(second - third) <= distance) & (distance <= second + third)
                assert bool(found.any()) is closes
    normal = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
    for point in rng.uniform(0.1, 3.0, (5, 3)):
        foot = (point @ normal) * normal
        assert foot[0] == pytest.approx(foot[2]) and (point - foot) @ normal == pytest.approx(0.0)
        assert np.linalg.norm(foot) == pytest.approx(point.sum() / np.sqrt(3.0))


def mobility(links, pins, slots=(), places=None, seed=9):
    """Return the dimension of the velocities that the pairs allow, ground being link 0.

    A pair is (i, j).  Places of the pins are arbitrary unless given; a slot keeps one direction.
    """
    rng = np.random.default_rng(seed)
    places = rng.uniform(-1.0, 1.0, (len(pins), 2)) if places is None else np.asarray(places)
    rows = []
    for (i, j), (x, y) in zip(pins, places, strict=True):
        rows += [pair_row(links, i, j, row) for row in ((1.0, 0.0, -y), (0.0, 1.0, x))]
    for i, j in slots:
        angle, x, y = rng.uniform(-1.0, 1.0, 3)
        normal = np.cos(angle), np.sin(angle), x * np.sin(angle) - y * np.cos(angle)
        rows.append(pair_row(links, i, j, normal))
    return 3 * (links - 1) - np.linalg.matrix_rank(np.array(rows), tol=1e-9)


def pair_row(links, i, j, values):
    """Return one condition on the relative velocity of two links."""
    row = np.zeros((links, 3))
    row[i], row[j] = values, -np.array(values)
    return row[1:].ravel()


CHAINS = {
    "three bars": (3, ((0, 1), (1, 2), (2, 0)), ()),
    "four bars": (4, ((0, 1), (1, 2), (2, 3), (3, 0)), ()),
    "five bars": (5, ((0, 1), (1, 2), (2, 3), (3, 4), (4, 0)), ()),
    "Watt": (6, ((0, 1), (1, 2), (2, 3), (3, 0), (2, 4), (4, 5), (5, 3)), ()),
    "quick return": (3, ((0, 1), (2, 0)), ((1, 2),)),
    "braced": (5, ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 2)), ()),
}
PARALLEL = (5, ((0, 1), (0, 2), (0, 3), (4, 1), (4, 2), (4, 3)))


@establishes(
    "Aannaque",
    "3.2 Kutzbach's criterion",
    printed=r"m = 3(k - 1) - 2j_1 - j_2",
    verdict="agrees",
    derived=r"m = 3(k - 1) - \operatorname{rank} J,\; \operatorname{rank} J \le 2j_1 + j_2",
    remark="Exact in general position, a lower bound otherwise. The pairs of two freedoms in a "
    "plane "
    "are pin and slot or rolling with slip, not cylinder pairs.",
)
@establishes(
    "Aannaque",
    "3.2 mobility of the four-bar",
    printed=r"m = 1",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "3.2 Gruebler's criterion",
    printed=r"1 = 3(k - 1) - 2j_1,\; 3k - 2j_1 - 4 = 0",
    verdict="agrees",
)
@pytest.mark.parametrize("name", CHAINS)
def test_mobility(name):
    links, pins, slots = CHAINS[name]
    count = 3 * (links - 1) - 2 * len(pins) - len(slots)
    assert mobility(links, pins, slots) == count
    assert count == {"three bars": 0, "five bars": 2, "braced": 0}.get(name, 1)
    if not slots:
        assert (3 * links - 2 * len(pins) - 4 == 0) == (count == 1)


@establishes(
    "Aannaque",
    "3.2 redundant constraints at m < 0",
    printed=r"m < 0: \text{ over-constrained, some constraints redundant}",
    verdict="agrees",
    derived=r"\operatorname{rank} J \le 3(k - 1) < 2j_1 + j_2",
    remark="-m of them at least. It need not be a structure for that: four equal parallel cranks.",
)
def test_redundant_constraints():
    both_diagonals = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 2), (1, 5), (5, 3))
    assert 3 * 5 - 2 * len(both_diagonals) == -1
    assert mobility(6, both_diagonals) == 0
    pins = tuple((end, crank) for end in (0, 5) for crank in (1, 2, 3, 4))
    pivots = np.array([0.0, 1.3, 2.0, 2.4])
    tips = pivots + 0.8 * np.exp(0.7j)
    places = np.column_stack([np.r_[pivots, tips.real], np.r_[0 * pivots, tips.imag]])
    assert 3 * 5 - 2 * len(pins) == -1
    assert mobility(6, pins, places=places) == 1


@establishes(
    "Aannaque",
    "3.2 no motion at m = 0",
    printed=r"m = 0: \text{ not deformable, a structure}",
    verdict="slip",
    derived=r"\text{true in general position: } \operatorname{rank} J = 2j_1 + j_2",
    remark="Three equal parallel cranks on one bar: k = 5, j1 = 6, m = 0, and it turns through 360 "
    "deg, mobility 1.",
)
@establishes(
    "Aannaque",
    "3.2 odd number of links",
    printed=r"\text{an odd number of links cannot have mobility } 1",
    verdict="slip",
    derived=r"3k = 2j_1 + 4 \text{ makes } k \text{ even: the count cannot be 1 for odd } k",
    remark="So in general position only: the same five links with three parallel cranks have "
    "mobility 1.",
)
def test_parallel_cranks():
    pivots = np.array([0.0, 1.3, 2.0])
    for angle in np.linspace(0.3, 6.0, 7):
        tips = pivots + 0.8 * np.exp(1j * angle)
        # Equal distances of the tips at each angle: one bar joins them through the whole turn.
        assert np.abs(np.diff(tips)) == pytest.approx(np.diff(pivots))
        places = np.column_stack([np.r_[pivots, tips.real], np.r_[0 * pivots, tips.imag]])
        assert mobility(*PARALLEL, places=places) == 1
    assert mobility(*PARALLEL) == 3 * 4 - 2 * 6 == 0
    odd = [3 * (k - 1) - 2 * j for k in (3, 5, 7, 9) for j in range(k, 3 * k)]
    assert 1 not in odd


def static_torques(theta2, theta3, theta4, lengths):
    """Return the torques of a unit pull in the coupler about A and about D."""
    _, l2, _, l4 = lengths
    pull = np.exp(1j * theta3)
    on_crank = l2 * np.imag(np.exp(-1j * theta2) * pull)
    on_follower = l4 * np.imag(np.exp(-1j * theta4) * pull)
    return on_crank, on_follower


@establishes(
    "Aannaque",
    "3.3 torques and speeds",
    printed=r"\frac{T_3}{T_1} = \frac{\omega_1}{\omega_3} \text{ without friction and inertia}",
    verdict="agrees",
    derived=r"T_1\omega_1 = T_3\omega_3",
)
@establishes(
    "Aannaque",
    "3.1",
    printed=r"\frac{T_3}{T_1} = \frac{\omega_1}{\omega_3} = \frac{L_3\sin\gamma}{L_4\sin\beta}",
    verdict="slip",
    derived=r"\frac{T_3}{T_1} = \frac{L_3\sin\gamma}{L_1\sin\beta},\; \beta = \widehat{OAB}",
    remark="The crank's length stands below, not the frame's. Table 3.2 at t1 = 180 deg: 4.22, "
    "printed 1.31. beta is the angle between crank and coupler (its figure is lost).",
)
@establishes(
    "Aannaque",
    "3.3 best force transmission at 90 deg",
    printed=r"\gamma = 90^\circ: \text{ most effective force transmission}",
    verdict="agrees",
    derived=r"T_3 = F L_3\sin\gamma",
    remark="For a given force in the coupler; the mechanical advantage has beta in it as well.",
)
@establishes(
    "Aannaque",
    "3.3 toggle at beta = 0 or 180 deg",
    printed=r"\beta = 0 \text{ or } 180^\circ: \text{ infinite mechanical advantage, toggle}",
    verdict="agrees",
    derived=r"\omega_3 = 0",
)
@establishes(
    "Aannaque",
    "3.3 mechanical advantage and transmission angle",
    printed=r"\gamma \text{ too small or too big: very small mechanical advantage}",
    verdict="agrees",
    remark="sin(gamma) is the factor; not where beta vanishes with it, at a change point.",
)
def test_mechanical_advantage():
    for lengths in (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], LONG_CRANK, DRAG_LINK):
        m = motion(lengths)
        on_crank, on_follower = static_torques(m.theta2, m.theta3, m.theta4, lengths)
        _, l1, _, l3 = lengths
        beta, gamma = m.theta3 - m.theta2, m.theta3 - m.theta4
        # on_crank omega1 = on_follower omega3: power through the coupler.
        assert np.abs(on_crank - on_follower * m.omega4).max() < 1e-8 * l3
        right = l3 * np.sin(gamma) / (l1 * np.sin(beta))
        usable = np.abs(np.sin(beta)) > 0.02
        assert np.allclose((on_follower / on_crank)[usable], right[usable])
        assert np.allclose(np.abs(on_follower), l3 * np.abs(np.sin(gamma)))
        assert np.all(np.abs(right[usable] * np.sin(beta)[usable]) <= l3 / l1)
    frame, l1, _, l3 = TABLE_3_2
    m = motion(TABLE_3_2)
    half = m.theta2.size // 2
    sines = np.abs(np.sin([m.theta3 - m.theta4, m.theta3 - m.theta2])[:, half])
    true, printed = 1 / abs(m.omega4[half]), l3 * sines[0] / (frame * sines[1])
    assert [true, printed] == pytest.approx([4.22, 1.31], abs=0.006)
    # Toggle: outer and inner dead centre of crank and coupler.
    for stretched in (1, -1):
        side = abs(TABLE_3_2[2] + stretched * l1)
        theta2 = np.arccos((frame**2 + side**2 - l3**2) / (2 * frame * side))
        theta2 += 0.0 if stretched > 0 else np.pi
        theta3, theta4 = (v[0] for v in closure(TABLE_3_2, theta2))
        on_crank, on_follower = static_torques(theta2, theta3, theta4, TABLE_3_2)
        assert abs(on_crank) < 1e-9 * abs(on_follower)


STUCK = (4.0, 3.0, 2.0, 2.0)


@establishes(
    "Aannaque",
    "3.3 extremes at 0 and 180 deg",
    printed=r"\gamma \text{ is critical (maximum or minimum) at } t_1 = 0 \text{ and } 180^\circ",
    verdict="agrees",
    derived=r"\frac{d\gamma}{dt_1} = \frac{L_1 L_4\sin t_1}{L_2 L_3\sin\gamma}",
    remark="For inputs that turn fully. A rocking input has its extreme 180 (or 0) deg where it "
    "stops: frame, input, coupler, output (4,3,2,2) at 68.0 deg.",
)
def test_extremes_of_the_transmission_angle():
    for lengths in (TABLE_3_2, CRANK_ROCKERS["5,1,5,2"], LONG_CRANK, DRAG_LINK):
        m = motion(lengths)
        frame, l1, l2, l3 = lengths
        gamma = np.abs(np.angle(np.exp(1j * (m.theta4 - m.theta3))))
        half = gamma.size // 2
        assert {int(gamma.argmin()), int(gamma.argmax())} == {0, half}
        slope = np.sign(np.sin(m.theta4 - m.theta3)) * (m.omega4 - m.omega3)
        derived = l1 * frame * np.sin(m.theta2) / (l2 * l3 * np.sin(gamma))
        assert np.abs(slope - derived).max() < 1e-7
    frame, crank, coupler, follower = STUCK
    assert not sweeps(crank, frame, (coupler, follower))
    stop = np.arccos((frame**2 + crank**2 - (coupler + follower) ** 2) / (2 * frame * crank))
    assert np.degrees(stop) == pytest.approx(68.0, abs=0.05)
    near = stop - np.array([1e-2, 1e-4, 1e-6])
    pins = np.abs(crank * np.exp(1j * near) - frame)
    cosine = (coupler**2 + follower**2 - pins**2) / (2 * coupler * follower)
    assert np.all(np.diff(np.arccos(cosine)) > 0)
    assert np.degrees(np.arccos(cosine[-1])) == pytest.approx(180.0, abs=0.2)
