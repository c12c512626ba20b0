"""Smith chapter 3: free motion of the follower caused by a clearance at a pin of the coupler."""

from functools import cache

import numpy as np
import pytest
from elastolink.runtime.linkages import FourBar, clearance_range
from seed_derivations import bd, c, clearance_series, cosine_change, l1, l2, l3, l4, phi
from seed_ledger import Ledger, hold, holds, latex, quoted
from seed_truth import CRANK_ROCKERS, LONG_CRANK, TURN, closure, motion, named

row = Ledger("Smith", __file__)
FIVE = CRANK_ROCKERS["5,1,5,2"]
POSITIONS = np.linspace(0.0, TURN, 25)[:-1]


def movement(lengths, theta2, clearance):
    """Return the least and the greatest follower angle less its nominal value."""
    found = clearance_range(FourBar(*lengths), clearance, theta2)
    return -float(found.below), float(found.above)


@cache
def played(lengths, theta2, clearance):
    """Return the triangles BCD, BC'D and BC''D; a longer coupler opens BDC and lowers theta4."""
    l1, l2, _, l4 = lengths
    pin = l2 * np.exp(1j * theta2) - l1
    theta3, theta4 = (angle[0] for angle in closure(lengths, theta2))
    phi = abs(np.angle(pin * np.exp(-1j * theta4)))
    low, high = movement(lengths, theta2, clearance)
    reached = {"BC_p": abs(pin - l4 * np.exp(1j * (theta4 + low)))}
    reached["BC_pp"] = abs(pin - l4 * np.exp(1j * (theta4 + high)))
    changes = {"dphi_p": -low, "dphi_pp": high, "dphi": high - low}
    angles = {"phi": phi, "phi_p": phi - low, "phi_pp": phi - high}
    mu = abs(np.angle(np.exp(1j * (theta4 - theta3))))
    sides = {"BD": abs(pin), "CD_p": l4, "c": clearance, "mu": mu}
    return {**named(lengths), **reached, **changes, **angles, **sides}


def turns(part=0.02, step=1, first=0):
    """Return positions of every linkage with a clearance that is a part of its crank."""
    for lengths in (LONG_CRANK, *CRANK_ROCKERS.values()):
        for theta2 in POSITIONS[first::step]:
            yield played(lengths, theta2, part * lengths[1])


def fig_10(clearance=0.1, theta2=0.0):
    """Return a position of the linkage of Fig. 10."""
    return played(LONG_CRANK, theta2, clearance)


row("3 cosine rule of the three triangles", check=holds(lambda: turns(step=3), tol=1e-8))
row(
    "3.1",
    check=holds(lambda: turns(step=3), tol=3e-6),
    derived=lambda: {"cos(phi) - cos(phi_p)": -cosine_change(1)},
)


@row("3.2")
def shorter_coupler(entry):
    hold(entry.corrected, *turns(step=3))
    quoted(entry.printed.sides(**fig_10(1.0))[0], "0.24375", "0.2475")
    quoted(entry.printed.sides(**played(FIVE, 1.0, 0.5))[0], "0.1343", "0.1308")


@row("3 small-angle cosines")
def small_angle_cosines(entry):
    point = fig_10()
    for (one, other), name in zip(entry.printed.sides(**point), ("dphi_p", "dphi_pp"), strict=True):
        dropped = -(point[name] ** 2) / 2 * np.cos(point["phi"])
        assert one - other == pytest.approx(dropped, rel=0.1)
    quoted(np.subtract(*entry.printed.sides(**point)[0]), "-2.9e-5")


@row(
    "3 delta phi' and delta phi''",
    derived=lambda: rf"\delta\phi' = {latex(clearance_series()[0] * c)} + O(c^2)",
)
def each_small_movement(entry):
    point = fig_10(0.5, np.pi)
    true, printed = entry.printed.sides(**point)[0]
    quoted([true, printed], "0.03126", "0.03202")
    printed = np.ravel(entry.printed.sides(**played(FIVE, 1.0, 0.5)))
    quoted(printed, "0.1419", "0.1446", "0.1345", "0.1309")
    first, second, third = (part.subs(numbers(point)) for part in clearance_series())
    quoted([first * 0.5], "0.03186")
    quoted([first * 0.5 * (1 + 0.5 / (4 * point["l3"]))], "0.03226")
    fifth = fig_10(0.1, np.pi)  # at a fifth of that clearance the next term is 1e-6
    expected = pytest.approx(fifth["dphi_p"], rel=2e-6)
    assert float(first * 0.1 + second * 0.01 + third * 0.001) == expected


def numbers(point):
    """Return the values of the derivation's symbols."""
    return {bd: point["BD"], phi: point["phi"], l3: point["l3"], l4: point["l4"]}


@row(
    "3.3",
    derived=lambda: (
        rf"\delta\phi = {latex(2 * clearance_series()[0] * c)} + "
        rf"{latex(2 * clearance_series()[2])}c^3 + O(c^5)"
    ),
)
def whole_movement_of_small_clearance(entry):
    for clearance, part in ((0.01, "1.0e-6"), (0.1, "1.0e-4"), (0.5, "2.6e-3")):
        point = fig_10(clearance)
        true, both, printed = entry.printed.sides(**point)[0]
        assert true == both
        quoted([(true - printed) / true], part)
        dropped = float(2 * clearance_series()[2].subs(numbers(point)) * clearance**3)
        assert true - printed == pytest.approx(dropped, rel=0.05)
    quoted([entry.printed.value(**played(FIVE, 1.0, 0.5))], "0.2755")


@cache
def stretched(l3=10.0, l4=10.0, clearance=1.0):
    """Return a stretched dead centre: the angle that the clearance leaves free, by a search."""
    angles = np.linspace(0.0, 0.4, 400001)
    from_b = np.abs(l3 + l4 - l4 * np.exp(1j * angles))
    assert from_b.min() == pytest.approx(l3), "never shorter than l3"
    free = angles[np.abs(from_b - l3) <= clearance / 2].max()
    return {"l3": l3, "l4": l4, "c": clearance, "BD": l3 + l4, "phi_p": free}


@row("3 exact extreme, phi = 0")
def stretched_dead_centre(entry):
    hold(entry.corrected, stretched(), stretched(12.0, 8.0, 0.5), tol=1e-6)
    hold(entry.printed[1], stretched(12.0, 8.0, 0.5))
    quoted(
        [stretched()["phi_p"], np.arccos(entry.printed.value(**stretched()))], "0.2269", "0.2252"
    )
    quoted([entry.printed.value(**stretched(12.0, 8.0, 0.5))], "0.981152")


@row("3 phi'' at phi = 0")
def no_shorter_coupler(entry):
    for sides, quote in ((stretched(), "1.0244"), (stretched(12.0, 8.0, 0.5), "1.0185547")):
        cosine = float(1 + cosine_change(-1).subs(numbers({**sides, "phi": 0})).subs(c, sides["c"]))
        hold(entry.corrected, {**sides, "phi_pp": np.emath.arccos(cosine)})
        quoted([cosine], quote)


# theta2 is where the diagonal stands at right angles to the follower.
RIGHT_ANGLED = (10.0, 2.0, 10.0, 6.0)
AT_RIGHT_ANGLE = np.arccos((10.0**2 + 2.0**2 - (10.0**2 - 6.0**2)) / (2 * 10.0 * 2.0))


row(
    "3 exact extreme, phi = 90 deg",
    check=holds(lambda: (played(RIGHT_ANGLED, AT_RIGHT_ANGLE, c) for c in (0.1, 1.0)), tol=1e-6),
)


@row("3 small clearance, phi = 90 deg")
def small_clearance_at_a_right_angle(entry):
    for clearance, part in ((0.1, "1.8e-5"), (1.0, "1.9e-3")):
        point = played(RIGHT_ANGLED, AT_RIGHT_ANGLE, clearance)
        true, sine, printed = entry.printed.sides(**point)[0]
        hold(entry.corrected, point, tol=1e-6)
        assert sine == pytest.approx(printed, rel=1e-6)
        quoted([(true - printed) / true], part)


@row("3 phi = 90 deg as a limiting case")
def right_angle_is_passed(_):
    passed = [np.degrees(played(FIVE, at, 0.01)["phi"]) for at in (np.pi, TURN / 18)]
    assert passed == pytest.approx([51.3, 105.65], abs=0.05)
    angle = np.degrees(played(RIGHT_ANGLED, AT_RIGHT_ANGLE, 0.1)["phi"])
    assert angle == pytest.approx(90.0, abs=1e-9)


row("3 sine rule of triangle BCD", check=holds(lambda: turns(1e-3, 4, 1)))


@row("3 angle from the transmission angle")
def movement_from_the_transmission_angle(entry):
    for point in turns(1e-3, 4, 1):
        hold(entry.corrected[0], point, tol=1e-4)
        hold(entry.corrected[1], point, tol=2e-2)
    point = fig_10()
    quoted([point["dphi_p"], point["dphi"]], "0.0252", "0.0503")
    quoted([entry.printed.value(**point)], "0.0503")
    quoted([entry.printed.value(**played(FIVE, 1.0, 0.5))], "0.2755")


def whole_turn(lengths, count=720):
    """Return crank angles [deg], the small-clearance movement for c/l4 = 1e-3, and mu [deg]."""
    m = motion(lengths, count=count)
    mu = m.transmission_angle
    return np.degrees(m.theta2), 1e-3 / np.sin(mu), np.degrees(mu)


@cache
def random_rockers(seed, count):
    """Return crank-rockers whose crank is nine tenths of the greatest."""
    rng = np.random.default_rng(seed)
    kinds = []
    for _ in range(count):
        frame, long, short = rng.uniform(2.0, 4.0, 3)
        crank = 0.9 * min(1.0, frame + long + short - 2 * max(frame, long, short))
        if crank >= 0.2:
            kinds.append((frame, crank, long, short))
    return kinds


@row("3 least movement at mu = 90 deg")
def least_movement(_):
    _, move, mu = whole_turn(LONG_CRANK)
    assert np.abs(mu[move.argmin()] - 90.0) < 0.5


@row("3 greatest movement at theta2 = 0")
def places_of_the_greatest_movement(_):
    degrees, move, mu = whole_turn(LONG_CRANK)
    assert degrees[move.argmax()] == 0.0
    assert [mu[0], mu[360]] == pytest.approx([11.48, 128.32], abs=0.01)
    assert move[360] > max(move[355], move[365])
    true = [np.ptp(movement(LONG_CRANK, at, 0.1)) for at in TURN * np.arange(12) / 12]
    assert int(np.argmax(true)) == 0 and true[6] > max(true[5], true[7])
    kinds = set()
    for lengths in random_rockers(3, 60):
        degrees, move, _ = whole_turn(lengths, 72)
        first = lengths[0] ** 2 + lengths[1] ** 2 < lengths[2] ** 2 + lengths[3] ** 2
        kinds.add(first)
        assert degrees[move.argmax()] == (0.0 if first else 180.0)
    assert kinds == {True, False}
    degrees, move, _ = whole_turn((10.0, 3.0, 6.0, 8.0))
    assert degrees[move.argmax()] == 180.0


@row("3 both sides of 90 deg")
def both_sides_of_a_right_angle(_):
    lengths = (10.0, 1.0, 6.0, 6.0)
    degrees, move, mu = whole_turn(lengths)
    assert [mu.min(), mu.max()] == pytest.approx([97.2, 132.9], abs=0.05)
    assert degrees[move.argmax()] == 180.0 and degrees[move.argmin()] == 0.0


@row(
    "3 transmission angle below 90 deg",
    derived=lambda: (
        rf"\cos\mu(180^\circ) = {latex((l3**2 + l4**2 - (l1 + l2) ** 2) / (2 * l3 * l4))} > 0"
    ),
)
def transmission_angle_on_one_side(entry):
    seen = {True: 0, False: 0}
    for lengths in random_rockers(4, 80):
        below = bool(whole_turn(lengths, 72)[2].max() < 90.0)
        seen[below] += 1
        ((one, other),) = entry.printed.sides(**named(lengths))
        assert below == (one < other)
    assert min(seen.values()) > 10


@row("3 least movement at theta2 = 180 deg")
def least_movement_then(_):
    for lengths in random_rockers(4, 80):
        degrees, move, mu = whole_turn(lengths, 72)
        assert mu.max() > 90.0 or degrees[move.argmin()] == 180.0


@row("3 clearance at either coupler joint")
def either_joint(_):
    """Clearance at C, against the crank's pin at 20001 places on the rim of its hole."""
    rim = np.exp(1j * np.linspace(0.0, TURN, 20001))
    for lengths in (LONG_CRANK, FIVE):
        l1, l2, l3, l4 = lengths
        for clearance in (0.01, 0.3):
            for theta2 in POSITIONS[::5]:
                pin = (l2 + clearance / 2 * rim) * np.exp(1j * theta2)
                gap = l1 - pin
                cosine = (np.abs(gap) ** 2 + l3**2 - l4**2) / (2 * np.abs(gap) * l3)
                tip = pin + l3 * np.exp(1j * (np.angle(gap) + np.arccos(cosine)))
                away = np.angle((tip - l1) * np.exp(-1j * closure(lengths, theta2)[1]))
                at_c = movement(lengths, theta2, clearance)
                assert (away.min(), away.max()) == pytest.approx(at_c, rel=1e-6)


test_row, test_falsified_row = row.tests()
