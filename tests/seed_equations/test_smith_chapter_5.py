"""Smith chapter 5: balancing by counterweights, and the inertia of a balanced bar."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import minimize_scalar
from seed_derivations import K, L, M, balanced_bar, delta, h, rho
from seed_ledger import Ledger, hold, holds, latex, quoted, same
from seed_rigid import GRAVITY, SMITH_LENGTHS, Link, balanced, forces, smith_links
from seed_truth import CRANK_ROCKERS, DRAG_LINK, motion, named

row = Ledger("Smith", __file__)
SPEED = 10.0
CASES = ("a", "b", "c", "d")
# Round-off over the greatest force.
ZERO = 1e-12


def smith_case(case, **more):
    """Return the forces of a case of Fig. 20 with the data of Figs. 12-16, weights at 6 in."""
    return forces(SMITH_LENGTHS, balanced(case, smith_links(), **more), SPEED)


def peak(values):
    """Return the greatest magnitude."""
    return float(np.abs(values).max())


@row("5 only I and r change")
def the_mass_changes_as_well(_):
    links = balanced("c", smith_links())
    f = forces(SMITH_LENGTHS, links, SPEED)
    m = motion(SMITH_LENGTHS)
    at_crank_pin = -SMITH_LENGTHS[1] * SPEED**2 * np.exp(1j * m.theta2)
    assert links[1].along == pytest.approx(0.0, abs=1e-15)
    assert peak(f.f34 + links[1].mass * at_crank_pin - f.f23) < ZERO * peak(f.f23)
    old = f.f34 + smith_links()[1].mass * at_crank_pin
    assert links[1].mass == pytest.approx(2 * smith_links()[1].mass)
    assert [peak(f.f23), peak(old)] == pytest.approx([11.09, 9.84], abs=0.006)


@row("5 counterweights raise the inertia")
def counterweight_adds_inertia(entry):
    for cylinders in ({}, {"density": 0.3, "thickness": 0.5}):
        for case in CASES[1:]:
            links = balanced(case, smith_links(), **cylinders)
            changed = [a.inertia - b.inertia for a, b in zip(links, smith_links(), strict=True)]
            assert min(changed) >= 0 and max(changed) > 0.05
    rng = np.random.default_rng(5)
    for first, offset, radius in rng.uniform(0.1, 3.0, (20, 3)):
        added = Link.disc(first / offset, radius, -offset)
        assert added.along == pytest.approx(-first)
        hold(entry.corrected, {"DI": added.inertia, "S": first, "e": offset, "r_c": radius})


GENERAL = tuple(
    Link(m, s, inertia=i) for m, s, i in ((0.7, 1.3, 4.0), (1.1, 2.7, 9.0), (0.9, 2.6, 9.5))
)


@cache
def fig_20():
    """Return links and forces of the cases for three linkages, at uneven speed."""
    points = []
    for lengths in (SMITH_LENGTHS, CRANK_ROCKERS["5,1,5,2"], DRAG_LINK):
        point = named(lengths)
        for case in CASES:
            links = balanced(case, GENERAL, lengths, (2.0, 1.5, 2.5))
            f = forces(lengths, links, SPEED, unsteady=0.2)
            point[case] = (links, f, {"M3": links[1].mass, "a3_vec": f.a3})
        points.append(point)
    return points


def complete(case):
    """Return the check of the masses that balance wholly, and that no force is left."""

    def check(entry):
        for point in fig_20():
            links, f, _ = point[case]
            # The coupler of (d) keeps its own centre.
            masses = {f"m{k}": link.mass for k, link in enumerate(links, 2)}
            radii = {f"r{k}": link.along / link.mass for k, link in enumerate(links, 2)}
            hold(entry.corrected, {**point, **masses, **radii}, tol=1e-12)
            assert peak(f.shaking_force) < ZERO * peak(f.f12)
            assert peak(f.moment) > 0.1 * peak(point["a"][1].moment)

    return check


@row("Fig. 20 (b) balanced crank and follower")
def partial_balance(entry):
    for point in fig_20():
        _, f, left = point["b"]
        assert peak(f.shaking_force) > 0.05 * peak(point["a"][1].shaking_force)
        hold(entry.corrected, {**left, "F_b": f.shaking_force})


row("Fig. 20 (c) three counterweights", check=complete("c"))
row("Fig. 20 (d) two counterweights", check=complete("d"))


def equivalent():
    """Return two masses at B and C for the coupler of Figs. 12-16."""
    coupler = smith_links()[1]
    return Link(coupler.mass, coupler.along, inertia=coupler.along * SMITH_LENGTHS[2])


@row("5 two masses for the coupler")
def two_masses(_):
    crank, coupler, follower = smith_links()
    ratio = equivalent().inertia_about_centre / coupler.inertia_about_centre
    assert ratio == pytest.approx(2.94, abs=0.005)
    assert 6.0 * 6.0 / Link.uniform_bar(1.0, 12.0).inertia_about_centre == pytest.approx(3.0)
    true, other = smith_case("a"), forces(SMITH_LENGTHS, (crank, equivalent(), follower), SPEED)
    assert peak(true.shaking_force - other.shaking_force) < ZERO * peak(true.f41)
    assert peak(true.f34 - other.f34) > 0.1 * peak(true.f34)


@row("5 why the pin forces grow")
def why_the_pin_forces_grow(_):
    true = smith_case("a")
    near, far = (smith_case("d", offsets=(at, at, at)) for at in (0.001, 6.0))
    for name, growth in (("f23", 1.60), ("f34", 1.83), ("torque", 1.65)):
        unbalanced = peak(getattr(true, name))
        assert peak(getattr(near, name)) / unbalanced == pytest.approx(1.0, abs=2e-4)
        assert peak(getattr(far, name)) / unbalanced == pytest.approx(growth, abs=0.006)


@row("Fig. 21 half the force on the frame")
def half_the_force(entry):
    peaks = {f"F_{case}": peak(smith_case(case).shaking_force) for case in "ab"}
    assert list(peaks.values()) == pytest.approx([6.50, 3.45], abs=0.006)
    one, other = entry.printed.sides(**peaks)[0]
    assert one == pytest.approx(other, abs=0.05)


@row("Fig. 22 torque on the frame")
def torque_on_the_frame(entry):
    cases = {case: smith_case(case) for case in CASES}
    printed = {f"M_{case}": peak(f.f41.imag * SMITH_LENGTHS[0]) for case, f in cases.items()}
    true = {f"M_{case}": peak(f.moment) for case, f in cases.items()}
    rises, quotes = zip(*entry.printed.sides(**printed), strict=True)
    assert rises == pytest.approx([0.51, 0.59, 1.09], abs=0.006)
    assert rises == pytest.approx(quotes, abs=0.45)
    assert rises[0] == pytest.approx(quotes[0], abs=0.02)
    for one, other in entry.corrected.sides(**true):
        assert one == pytest.approx(other, abs=0.006)
    positive = [cases[case].f41.imag.max() for case in "ac"]
    assert positive[1] / positive[0] - 1 == pytest.approx(1.13, abs=0.006)


def bar_point(M, L, h, rho, delta):
    """Return the balanced bar's numbers under the document's letters."""
    given = {"M": M, "L": L, "h": h, "rho": rho, "delta": delta}
    symbols = {sp.Symbol(name, positive=True): value for name, value in given.items()}
    found = {name: float(form.subs(symbols)) for name, form in balanced_bar().items()}
    return {**given, **found, "e": delta * L}


@cache
def bars():
    """Return balanced bars of random sizes."""
    rng = np.random.default_rng(6)
    return [bar_point(*values) for values in rng.uniform(0.2, 0.95, (20, 5))]


UNIT = dict(zip(["M", "L", "h", "rho", "delta"], (1.0, 1.0, 1.0, 1.0, 0.5), strict=True))
row("5 conditions of the balanced link", check=holds(bars))


@row("5 inertia of a balanced link")
@row("5 inertia in terms of delta")
def inertia_of_the_balanced_bar(entry):
    hold(entry.corrected, bars)
    whole = {name: sp.Symbol(name, positive=True) for name in UNIT} | {"delta": delta}
    if entry.label.endswith("delta"):
        same(entry.corrected.value(**whole), balanced_bar()["I_G"])
    at, other = bar_point(**UNIT), bar_point(0.7, 1.3, 0.4, 0.9, 0.35)
    printed = [entry.printed.value(**point) for point in (at, other)]
    quotes = ("0.840", "1.139") if "m_c" in str(entry.printed) else ("0.902", "1.186")
    quoted([at["I_G"], *printed], "0.652", *quotes)


def stationary():
    """Return bars whose density makes the inertia stationary, by the machine's derivative."""
    density = sp.lambdify((M, L, h, delta), sp.solve(sp.diff(balanced_bar()["I_G"], delta), rho)[0])
    for mass, length, thickness, part in ((0.7, 1.3, 0.4, 0.35), (1.9, 0.8, 1.2, 0.62)):
        value = density(mass, length, thickness, part)
        point = {"M": mass, "L": length, "h": thickness, "rho": value, "delta": part}
        yield {**point, "K": mass / (2 * np.pi * length**2 * thickness * value)}


@row(
    "5 its derivative",
    derived=lambda: (
        r"\frac{\partial I_G}{\partial\delta} = "
        + latex(sp.factor(sp.diff(balanced_bar()["I_G"], delta)))
    ),
)
def derivative_of_the_inertia(entry):
    symbols = {"M": M, "L": L, "h": h, "rho": rho, "delta": delta}
    one, other, zero = entry.printed.sides(**symbols, I_G=balanced_bar()["I_G"])[0]
    same(one, other)
    for point in stationary():
        value = one.subs({symbol: point[name] for name, symbol in symbols.items()})
        assert float(value) == pytest.approx(float(zero), abs=1e-12)


row("5 rearranged condition", "5 K of delta", check=holds(stationary))


@row("5 condition on delta")
def quintic(entry):
    """Both forms vanish at the stationary bars, and are one polynomial."""
    for form in (entry.printed, entry.corrected):
        hold(form, stationary)
    one, other = (
        form[0].sides(delta=delta, K=K)[0][0] for form in (entry.printed, entry.corrected)
    )
    same(one, other)


@row("5 range of K")
def range_of_k(entry):
    second = sp.diff(balanced_bar()["I_G"], delta, 2).subs(delta, 1)
    mass = 2 * sp.pi * h * rho * L**2 * K
    same(second.subs(M, mass), mass * L**2 * (2 * K - 1))
    grid = np.linspace(1e-3, 1.0, 2001)
    values = grid**3 / (1 + grid**2)
    low, _, high = entry.printed.sides(K=0.0)[0]
    assert np.all(np.diff(values) > 0) and values[-1] == high
    assert values[0] == pytest.approx(low, abs=2e-9)
    for k, inside in ((0.05, True), (0.45, True), (0.55, False), (1.0, False)):
        inertia = sp.lambdify(
            delta, balanced_bar()["I_G"].subs({M: 1, L: 1, h: 1, rho: 1 / (2 * np.pi * k)})
        )
        assert bool(grid[np.argmin(inertia(grid))] < 0.999) is inside


@row("Fig. 23 minimum at delta = 1")
def minimum_at_one(entry):
    for k in (0.55, 1.0):
        point = bar_point(1.3, 0.7, 1.0, 1.3 / (2 * np.pi * 0.49 * k), 1.0)
        hold(entry.corrected, point, tol=1e-12)


@row("Fig. 23 minima A to E")
def minima_of_fig_23(entry):
    data = entry.printed.values(delta=0.5)
    places = list(entry.corrected.values()["delta"])
    inertias = []
    for density, place in zip(data["rho"], places, strict=True):
        sizes = {M: data["M"], L: data["L"], h: data["h"], rho: density}
        inertia = sp.lambdify(delta, balanced_bar()["I_G"].subs(sizes))
        least = minimize_scalar(inertia, bounds=(0.05, 1.0), method="bounded")
        assert least.x == pytest.approx(place, abs=6e-4)
        inertias.append(least.fun)
    low, _, high = entry.printed[4].sides(delta=0.5)[0]
    assert (low, high) == (0, 1)
    assert inertias == pytest.approx([0.664, 0.643, 0.606, 0.564, 0.524], abs=6e-4)
    assert 1 / (np.pi * 0.1) == pytest.approx(3.18, abs=0.005)


@row("5 pivots of the counterweights")
def pivots_of_the_counterweights(_):
    links = balanced("c", smith_links())
    follower_left = forces(SMITH_LENGTHS, (links[0], links[1], smith_links()[2]), SPEED)
    assert peak(follower_left.shaking_force) == pytest.approx(2.67, abs=0.006)


@row("5 offset of about 3 in.")
def offset_of_the_counterweights(entry):
    """The first moment of the follower's counterweight, and the least of all peaks."""

    def peak_at(offset, crank=None):
        offsets = (crank or offset, offset, offset)
        f = smith_case("d", offsets=offsets, density=0.283 / GRAVITY, thickness=0.5)
        assert peak(f.shaking_force) < ZERO * peak(f.f23)
        return peak(f.f23)

    peaks = [peak(smith_case("a").f23), *map(peak_at, (1.0, 3.0, 6.0))]
    assert peaks == pytest.approx([8.19, 20.15, 11.89, 13.44], abs=0.01)
    offsets = np.linspace(2.0, 4.0, 41)
    best = offsets[np.argmin([peak_at(offset) for offset in offsets])]
    data = {"W3": 1, "W4": 1, "r3": 6, "r4": 6, "l3": 12, "l4": 12, "h": 0.5, "rho": 0.283}
    for point in fig_20():
        links = {f"W{k}": GENERAL[k - 2].mass for k in (3, 4)}
        links |= {f"r{k}": GENERAL[k - 2].centre[0] for k in (3, 4)}
        first = GENERAL[2].along - point["d"][0][2].along
        assert entry.corrected.values(**point, **links, h=1, rho=1)["S"] == pytest.approx(first)
    cube, right = entry.corrected.sides(**data, e=best)[0]
    assert cube == pytest.approx(right, rel=0.02) and best == pytest.approx(3.0, abs=0.05)
    assert peak_at(3.0, crank=1.0) == pytest.approx(peak_at(3.0), rel=1e-12)


test_row, test_falsified_row = row.tests()
