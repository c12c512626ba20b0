"""Smith's chapter 9: the couplers, their calibration, the speeds observed and the damping."""

from functools import cache

import numpy as np
import sympy as sp
from seed_ledger import Ledger, hold, holds, quoted, same, truths
from seed_rigs import RIGS, critical, linkage_function, parts, speeds, thinner
from seed_truth import TURN, boundaries, fourier

row = Ledger("Smith", __file__)
INERTIA = {"I_1": 0.0058, "I_3": 0.0079, "I_6": 0.0149, "I_8": 0.0190}


@cache
def links():
    """Return the parameters of a uniform coupler and a follower by their dimensions."""
    rig = RIGS["5,1,5,2"]
    eps1, eps2, eps3 = rig.epsilon(0.0058)
    _, l2, l3, l4 = rig.lengths
    lengths = {"l2": l2, "l3": l3, "l4": l4, "r3": l3 / 2, "k3": l3 / 3**0.5}
    masses = {"M3": rig.mass_per_length * l3, "M4": 0.004, "k4": (0.0058 / 0.004) ** 0.5}
    return {"eps1": eps1, "eps2": eps2, "eps3": eps3} | lengths | masses


row("9.2 epsilon1", "9.2 epsilon3", check=holds(lambda: [links()]))


@row("9.2 epsilon2")
def crank_parameter(entry):
    hold(entry.corrected, links())
    quoted([entry.printed.value(**links()), links()["eps2"]], "0.0896", "0.987")


@row("9.4.1 inertias of the follower")
def spacing_of_the_inertias(entry):
    least, greatest = (entry.printed.value(1, pm=sign) for sign in (-1, 1))
    values, error = (least + greatest) / 2, (greatest - least) / 2
    quoted(1e4 * np.diff(values), "11", "10", "30", "21", "19", "15", "26")
    quoted(1e4 * error, "1", "2", "2", "3", "3", "4", "4", "5")
    quoted([values[0], np.diff(values).mean()], "0.0058", "0.00189")


@row("9.4.2 stiffness and frequency")
def stiffness_and_frequency(entry):
    """A strip of steel, 1/4 by 1/16 in, of 30e6 lbf/in^2 and 0.283 lbf/in^3, and 386.09 in/s^2."""
    given = entry.printed.values()
    width, height = 1 / 4, 1 / 16
    second, wave = width * height**3 / 12, (np.pi / given["l3"]) ** 2

    def frequency(stiffness, density):
        return wave * np.sqrt(stiffness / (density / 386.09 * width * height)) / TURN

    quoted([30e6 * second, frequency(30e6 * second, 0.283)], "152.6", "25.5")
    mass = given["EI"] * (wave / (TURN * given["f"])) ** 2
    quoted([given["EI"] / second, mass * 386.09 / (width * height)], "33.7e6", "0.294")
    same(frequency(given["EI"], mass * 386.09 / (width * height)), given["f"])


@row("9.4.2 frequency by thickness")
def proportion(entry):
    for thin in (2, 3):
        ratio = thinner("5,1,5,2", thin).frequency / RIGS["5,1,5,2"].frequency
        masses = thinner("5,1,5,2", thin).mass_per_length / RIGS["5,1,5,2"].mass_per_length
        same([ratio, masses], [thin / 4, thin / 4])
        hold(entry.printed, {"f": {1: ratio, 2: 1.0}, "h": {1: thin, 2: 4}})
    quoted([20 / 26], "0.77")


@cache
def shapes():
    """Return the deflections of a beam in its first mode and under a load in the middle."""
    x, length = sp.symbols("x l", positive=True)
    cubic = sp.Poly(sp.symbols("a:4"), x).as_expr()
    conditions = [cubic.subs(x, 0), cubic.diff(x, 2).subs(x, 0)]
    conditions += [cubic.diff(x).subs(x, length / 2), cubic.subs(x, length / 2) - 1]
    (found,) = sp.linsolve(conditions, sp.symbols("a:4"))
    static = cubic.subs(dict(zip(sp.symbols("a:4"), found, strict=True)))
    return {"x": x, "l": length, "y_1": sp.sin(sp.pi * x / length), "y_2": static}


@row("9.4.3 mode shapes of Fig. 45")
def mode_shapes(entry):
    hold(entry.printed, shapes())
    y, x, length = shapes()["y_1"], shapes()["x"], shapes()["l"]
    assert sp.simplify(y.diff(x, 4) / y - (sp.pi / length) ** 4) == 0
    assert y.subs(x, 0) == y.diff(x, 2).subs(x, 0) == y.diff(x).subs(x, length / 2) == 0


@row("9.4.3 difference at the gauges")
def gauges(entry):
    """Where the gauges are, of the deflections and of what they feel."""
    at = {shapes()["x"]: 0.1, shapes()["l"]: 1}
    mode, static = (shapes()[name] for name in ("y_1", "y_2"))
    same(entry.printed.value(0), float(1 - (static / mode).subs(at)))
    assert truths(entry.printed) == [True]
    quoted([entry.printed.value(0), entry.printed.value()], "0.042", "0.05")
    curved = [float(form.diff(shapes()["x"], 2).subs(at)) for form in (mode, static)]
    quoted([curved[0] / curved[1]], "1.27")


def observed(entry, name, sixty_fourths, *expected):
    """Compare observed speeds with those of the complete first mode, in percent of them."""
    rig = thinner(name, sixty_fourths)

    def ends(region, inertia):
        return speeds(rig, parts(rig, inertia)[1], region)

    functions = {
        "omega2": lambda n, i: np.mean(1 / ends(n, i) ** 2) ** -0.5,
        "low": lambda n, i: ends(n, i).min(),
        "high": lambda n, i: ends(n, i).max(),
    }
    found = [side for sides in entry.printed.sides(**functions, **INERTIA) for side in sides]
    quoted(found, *expected)


@row("9.5.3 speeds, (5,1,5,2), 1/32 in")
def thin_coupler(entry):
    theory = ("257.7", "250", "234.8", "220", "304.2", "300", "260", "274.1", "280")
    observed(entry, "5,1,5,2", 2, *theory)
    rig = thinner("5,1,5,2", 2)
    centres = []
    for inertia in (0.0058, 0.0190):
        load = rig.epsilon(inertia)[2] * linkage_function("5,1,5,2")
        first = 9 - fourier(load)[0].real
        centres += [boundaries(load, 6), [first, first]]
    means = [rig.frequency * 60 / TURN / np.mean(values) ** 0.5 for values in centres]
    quoted(means, "259.6", "263.4", "238.7", "271.6")


@row("9.5.3 speeds, (5,1,5,2), 3/64 in")
def middle_coupler(entry):
    found = [side for sides in entry.printed.sides(Omega=20 * 60) for side in sides]
    quoted(found, "300", "300", "400", "400", "480", "500", "600", "600")


@row("9.5.3 speeds, (5,1,5,2), 1/16 in")
def thick_coupler(entry):
    observed(entry, "5,1,5,2", 4, "923.2", "900")


@row("9.5.3 speeds, (10,1,10,4), 1/32 in")
def longer_linkage(entry):
    theory = ("383.5", "360", "378.9", "360", "491.0", "460", "505.8", "480", "454.6", "450")
    observed(entry, "10,1,10,4", 2, *theory)


@row("9.5.3 observed frequency")
def observed_frequency(entry):
    assert truths(entry.printed) == [True]
    quoted([entry.printed.value(0), entry.printed.value()], "0.0189", "0.02")


@row("9.5.4 unstable speeds")
def unstable_speeds(entry):
    """Where regions of a small load begin: the crank turns twice in n periods of the coupler."""
    for n in (1, 2, 3, 5):
        square = boundaries(1e-6 * linkage_function("5,1,5,2"), n)[0]
        hold(entry.printed, {"Omega": 6.6, "omega2": 6.6 / square**0.5, "n": n}, tol=1e-5)


@row("9.5.4 coupler-dependent terms")
def coupler_terms(entry):
    """By how much the follower's term exceeds the others at its least inertia."""
    quotients = []
    for name in RIGS:
        for sixty_fourths in (4, 2):
            point, _ = parts(thinner(name, sixty_fourths), 0.0058)
            sides = entry.printed.sides(**point)
            tenth = np.max(np.abs(point["eps3"] * point["f3"])) / 10
            same([limit for _, limit in sides], [tenth, tenth])
            quotients += [10 * limit / term for term, limit in sides]
    quoted(quotients, "6.1", "5.8", "12.2", "11.7", "8.0", "6.2", "16.0", "12.4")


@row("9.5.5 logarithmic decrements")
def decrements(entry):
    """The couplers are those of the figures and of the charts; the numbers are as printed."""
    printed = {1 / 32: 0.2, 3 / 64: 0.2, 1 / 16: 0.07}
    known = entry.corrected.sides(delta=lambda h: printed.get(h, 0.0))
    assert all(low < value < high for low, value, high in known)
    found = [s for sides in known for s in sides[::2]]
    quoted(found, "0.15", "0.30", "0.10", "0.27", "0.05", "0.10")
    numbers = [s for sides in entry.printed.sides(delta=lambda h: h) for s in sides]
    sizes = ("0.15", "0.03125", "0.30", "0.10", "0.015625", "0.27", "0.05", "0.0625", "0.10")
    quoted(numbers, *sizes)
    quoted(np.array([0.15, 0.30]) / TURN * 2.5, "0.06", "0.12")


@row("9.5.5 damping, Fig. 82", "9.5.5 damping, Fig. 85")
def damping(entry):
    """Against (7.51), which it is taken from, and the exact damping that closes the region."""
    name = "5,1,5,2" if entry.label.endswith("82") else "10,1,10,4"
    unit = thinner(name, 2).epsilon(1.0)[2]
    harmonics = np.abs(fourier(linkage_function(name)))
    first = {n: unit * harmonics[n] / n for n in range(1, 9)}
    sides = entry.printed.sides(K=first, I_4=0.0077)
    found = []
    for factor, value in sides[-2:]:
        (region,) = (n for n, other in first.items() if other == factor)
        inertia = value / factor
        found += [value, inertia, critical(name, unit * inertia, region)]
    if len(sides) == 3:
        quoted(sides[0], "0.0069", "0.0077", "0.0079")
        quoted(found, "0.02", "0.0077", "0.024", "0.01", "0.0136", "0.031")
    else:
        quoted(found, "0.005", "0.0131", "0.038", "0.02", "0.0067", "0.037")


test_row, test_falsified_row = row.tests()
