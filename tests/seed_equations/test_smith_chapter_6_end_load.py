"""Smith (6.14)-(6.18): end load of the coupler, its parameters, and the reduced equation."""

from functools import cache

import numpy as np
import pytest
import seed_machine as machine
import sympy as sp
from seed_derivations import l3, omega2, omega3, projected
from seed_ledger import Ledger, hold, hold_derived, holds, latex, quoted, same
from seed_rigs import RIGS, Rig, linkage_function, parts, speeds
from seed_truth import (
    CRANK_ROCKERS,
    LONG_CRANK,
    TURN,
    boundaries,
    coupler_functions,
    motion,
    named,
    pin_force_on_coupler,
)

row = Ledger("Smith", __file__)
MASSES, PLACES = (0.2, 0.5, 0.3), (0.3, 1.1, 1.9)
INERTIA4, SPEED = 0.4, 3.0


@cache
def newton():
    """Return the true force at C in fixed axes and in the coupler's, for coupler and follower."""
    points = []
    for lengths in CRANK_ROCKERS.values():
        for assembly in ("open", "crossed"):
            places = [place * lengths[2] / 2 for place in PLACES]
            force, m = pin_force_on_coupler(lengths, INERTIA4, MASSES, places, SPEED, assembly)
            turned = force * np.exp(-1j * m.theta3)
            first = sum(a * b for a, b in zip(MASSES, places, strict=True))
            second = sum(a * b**2 for a, b in zip(MASSES, places, strict=True))
            point = {"X43": force.real, "Y43": force.imag, "F_x": turned.real, "F_y": turned.imag}
            point |= {"I3": second, "I4": INERTIA4, "m3": 0.7, "r3": first / 0.7, "m3r3": first}
            rates = {"alpha3": SPEED**2 * m.alpha3, "alpha4": SPEED**2 * m.alpha4}
            angles = {"theta2": m.theta2, "theta3": m.theta3, "theta4": m.theta4}
            points.append({**named(lengths), **point, **rates, **angles, "omega2": SPEED})
    return points


row("6.2.2 X43 and Y43", check=holds(newton, tol=1e-8))
row("6.2.2 F_x", check=holds(newton, tol=1e-8))
row("6.14", check=holds(newton, tol=1e-8), derived=lambda: {"F_x": machine.pin_force()[0]})


@row("6.2.2 F_y", derived=lambda: {"F_y": machine.pin_force()[1]})
def force_across_the_coupler(entry):
    hold_derived(entry, newton, tol=1e-8)
    hold(entry.printed, *({**point, "F_y": -point["F_y"]} for point in newton()), tol=1e-8)


@cache
def rig_points(m=2):
    """Return the end load of each rig and its parameters, fitted to three functions of the angle.

    The coupler is uniform, the crank turns at unit speed.
    """
    places, weights = np.polynomial.legendre.leggauss(3)
    points = []
    for name, rig in RIGS.items():
        mu, coupler = rig.mass_per_length, rig.lengths[2]
        masses, at = mu * coupler / 2 * weights, coupler / 2 * (1 + places)
        for inertia4 in rig.inertias:
            force, turn = pin_force_on_coupler(rig.lengths, inertia4, masses, at)
            along = np.real(force * np.exp(-1j * turn.theta3))
            functions = coupler_functions(turn)[1:]
            term = along * np.pi**2 / (mu * coupler**2)
            eps, *_ = np.linalg.lstsq(np.array(functions).T, term, rcond=None)
            assert np.abs(eps @ np.array(functions) - term).max() < 1e-8 * np.abs(term).max()
            point = {**named(rig.lengths), **vars(turn), "F_x": along, "mu": mu, "m": m}
            point |= dict(zip(("eps1", "eps2", "eps3"), eps, strict=True))
            point |= {"I3": masses @ at**2, "r3": coupler / 2, "k3": coupler / np.sqrt(3)}
            point |= {"I4": inertia4, "M3": mu * coupler, "M4": 0.02, "rig": name}
            points.append(point | {"k4": np.sqrt(inertia4 / 0.02)})
    return points


@row("6.15")
def force_of_the_follower_alone(entry):
    for point, size in zip(rig_points(), (0.1485, 0.0505, 0.0834, 0.0269), strict=True):
        true, printed = entry.printed.sides(**point)[0]
        assert np.abs(true - printed).max() / np.abs(true).max() == pytest.approx(size, abs=2e-4)


@row("6.2.2 F_x term of the coefficient")
def term_of_the_coefficient(entry):
    fast = [
        {
            **p,
            "omega2": 2.0,
            "alpha3": 4 * p["alpha3"],
            "alpha4": 4 * p["alpha4"],
            "F_x": 4 * p["F_x"],
        }
        for p in rig_points()
    ]
    hold(entry.corrected, *fast, tol=1e-8)
    hold(
        entry.printed,
        *({**p, "I3": p["r3"], "alpha3": p["alpha3"] * p["I3"] / p["r3"]} for p in fast),
        tol=1e-8,
    )
    point = rig_points()[0]
    quoted([point["I3"], np.pi**2 * point["I3"] * point["l2"] / 15.0**2], "0.0139", "0.0018")
    one, other = entry.printed.sides(**point)[0]
    assert np.abs(one - other).max() > 0.02 * np.abs(one).max()


@row("6.2.2 epsilon1")
def first_parameter(entry):
    hold(entry.corrected, rig_points, tol=1e-8)
    for k in (0, 2, 3):
        hold(entry.printed[k], rig_points, tol=1e-8)
    quoted([entry.printed[1].value(**p) for p in rig_points()], *["49.348"] * 4)


@row("6.2.2 epsilon2")
def second_parameter(entry):
    for form in (entry.corrected, entry.printed[1], entry.printed[2]):
        hold(form, rig_points, tol=1e-8)
    hold(entry.printed[0], *({**p, "I3": p["r3"]} for p in rig_points()), tol=1e-8)
    quoted([rig_points()[0]["eps2"]], "0.987")
    assert entry.printed[2].sides(**rig_points()[0])[0][2] == np.pi**2 / 2


@row("6.2.2 epsilon3")
def third_parameter(entry):
    hold(entry.printed[0], rig_points, tol=1e-8)
    for p in rig_points():  # the same follower as a uniform bar
        hold(entry.printed[1], {**p, "M4": 3 * p["I4"] / p["l4"] ** 2}, tol=1e-8)
    quoted([p["eps3"] for p in rig_points()[:2]], "3.43", "11.23")


@row("6.2.2 epsilon3, uniform links of equal length")
def third_parameter_of_equal_links(entry):
    mass3, mass4, length = 0.7, 1.9, 2.3
    eps3 = mass4 * length**2 / 3 * np.pi**2 / (mass3 / length * length**2 * length)
    point = {"M3": mass3, "M4": mass4, "eps3": eps3}
    hold(entry.corrected, point)
    quoted([1 - entry.printed.value(**point) / eps3], "0.392")


@row("6.2.2 epsilons exceed one")
def sizes_of_the_parameters(entry):
    quoted([rig_points()[k]["eps2"] for k in (0, 2)], "0.987", "0.493")
    for point in rig_points():
        above = [one > other for one, other in entry.printed.sides(**point)]
        assert above == [True, False, True]
    assert [other for _, other in entry.printed.sides(**rig_points()[0])] == [1, 1, 1]
    quoted([2 / np.pi**2], "0.203")


@cache
def turns():
    """Return a turn of each crank-rocker at unit crank speed, with the coupler speed squared."""
    kinds = (*CRANK_ROCKERS.values(), LONG_CRANK)
    moved = [(lengths, motion(lengths, count=1024)) for lengths in kinds]
    return [{**named(k), **vars(m), "phi": m.omega3**2} for k, m in moved]


row("6.2.2 phi", check=holds(turns, tol=1e-8))


@row("6.2.2 phi below one")
def coupler_speed_squared(entry):
    largest = {}
    for point in turns():
        speed = point["omega3"]
        assert np.count_nonzero(np.diff(np.signbit(np.append(speed, speed[0])))) == 2
        largest[tuple(point[f"l{k}"] for k in (1, 2, 3, 4))] = point["phi"].max()
        assert point["phi"].min() == pytest.approx(entry.printed.values(phi=0)["phi_min"], abs=2e-4)
    names = ("5,1,5,2", "10,1,10,4", "4,1,4,4", "12,6,12,12")
    sizes = [largest[CRANK_ROCKERS[name]] for name in names]
    quoted([*sizes, largest[LONG_CRANK]], "0.068", "0.012", "0.13", "1.04", "16.1")
    below = [bool(np.less(*entry.printed[0].sides(phi=size)[0])) for size in sizes]
    assert below == [True, True, True, False] and entry.printed[0].sides(phi=0)[0][1] == 1


def kept(entry, point, m=1):
    """Return the periodic part of the coefficient of a printed equation: of U = 1, U'' = 0."""
    left = entry.printed[0].sides(**point, m=m, U=1.0, U_pp=0.0, lam=0.0, g=0.0)[0][0]
    return left


FAST = {"EI": 171.5, "mu": RIGS["5,1,5,2"].mass_per_length, "F_x": 0.02, "l2": 3.0, "l3": 15.0}
FAST |= {"omega2": 90.0, "omega3": 20.0, "alpha3": 1500.0, "theta2": 0.9, "theta3": 0.4}


def without_dimensions(m):
    """Return coefficient and right-hand side of mode m at 90 rad/s, the deflection over l3."""
    _, coefficient, right = projected(m, m)

    def number(form):
        names = {s: s.name.replace("ell_", "l").replace("_", "") for s in form.free_symbols}
        return float(form.subs({s: FAST.get(s.name, FAST.get(n)) for s, n in names.items()}))

    speed = FAST["omega2"] ** 2
    return number(coefficient) / speed, number(right) / (FAST["l3"] * speed)


@row("6.16")
def equation_without_dimensions(entry):
    for m in (1, 2):
        coefficient, right = without_dimensions(m)
        extra = m**2 * np.pi**2 * 3.0 / 30 * np.cos(0.5)
        extra += (20.0 / 90.0) ** 2 * (m**2 * np.pi**2 / 3 - 0.25)
        point = {**FAST, "m": m, "odd": lambda k: k % 2 == 1, "U": 0.3, "U_pp": 0.7}
        left, printed = entry.corrected.sides(**point)[0]
        same(left + 0.3 * extra, 0.7 + 0.3 * coefficient)
        same([printed, entry.printed.sides(**point, omega1=1.0)[0][1]], [right, right])
        # With omega1 for the missing factors, the printed form is that of unit speed.
        slow = {**point, "EI": FAST["EI"] / 8100, "omega1": 8100.0 / 20.0}
        same(entry.printed.sides(**slow)[0][0], left)
    point = {**FAST, "m": 1, "odd": lambda k: True, "U": 1, "U_pp": 0, "omega1": 1e9, "F_x": 0}
    printed = entry.printed.sides(**point)[0][0]
    quoted([printed, printed / 90.0**2], "26687", "3.3")


REGION_4 = {"5,1,5,2": {"6.18": (781.1, 772.0), "6.17": (785.1, 772.4), "whole": (769.1, 752.9)}}
REGION_4["10,1,10,4"] = {"6.17": (780.6, 780.0), "whole": (776.2, 775.3)}
SIZES = {  # of the complete mode less (6.17), of (6.17) less (6.18), of (6.18)
    ("5,1,5,2", 0.0058): (1.127, 0.566, 3.58),
    ("5,1,5,2", 0.0190): (1.127, 0.566, 11.73),
    ("10,1,10,4", 0.0058): (0.525, 0.0918, 1.157),
    ("10,1,10,4", 0.0190): (0.525, 0.0918, 3.790),
}


def definitions(entry):
    """Check lambda and g of (6.17) at the rig's speed."""
    for m in (1, 2):
        _, right = without_dimensions(m)
        point = {**FAST, "m": m, "odd": lambda k: k % 2 == 1}
        values = entry.printed.values(**point)
        same(values["g"], right)
        still = {**{k: FAST[k] for k in ("EI", "mu", "l3", "omega2")}, "m": m}
        square = still["EI"] / still["mu"] * (m * np.pi / 15.0) ** 4 / 90.0**2
        left = entry.printed[0].sides(
            **still,
            lam=values["lam"],
            U=1.0,
            U_pp=0.5,
            phi=0,
            g=0,
            **dict.fromkeys(("eps1", "eps2", "eps3", "f1", "f2", "f3"), 0),
        )[0][0]
        same(left, square + 0.5)


@row(
    "6.17",
    derived=lambda: (
        r"\left\{"
        + latex(machine.mode_coefficient()[0])
        + r" + m^2\textstyle\sum\epsilon_i f_i\right\}U_m + \text{coupling},\; g_m = "
        + latex(machine.mode_forcing())
    ),
)
@row("6.18")
def dropped_terms_and_boundaries(entry):
    short = entry.label == "6.18"
    for (name, inertia4), (missing, kept_too, follower) in SIZES.items():
        point, complete = parts(RIGS[name], inertia4)
        printed = kept(entry, point)
        if short:
            assert np.abs(printed).max() == pytest.approx(follower, rel=2e-3)
            missed = (
                complete - printed - (point["eps1"] * point["f1"] + point["eps2"] * point["f2"])
            )
            missed += point["phi"]
        else:
            missed = complete - printed
            rest = printed - point["eps3"] * point["f3"]
            assert np.abs(rest).max() == pytest.approx(kept_too, rel=2e-3)
            quick = kept(entry, point, 2) + point["phi"]
            same(quick, 4 * (printed + point["phi"]))
        assert np.abs(missed).max() == pytest.approx(missing, rel=2e-3)
        limits = REGION_4[name] if inertia4 == 0.0058 else {}
        for what, function in ((entry.label, printed), ("whole", complete)):
            if what in limits:
                assert speeds(RIGS[name], function, 4) == pytest.approx(limits[what], abs=0.1)
    left = entry.printed[0].sides(
        **{**point, "eps3": 0, "eps1": 0, "eps2": 0, "phi": 0}, m=2, U=1.0, U_pp=0.5, lam=0.3, g=0
    )[0][0]
    same(left, 0.5 + 16 * 0.09)
    if short:
        quick = kept(entry, point, 2)
        return same(quick, 4 * kept(entry, point))
    definitions(entry)
    point, complete = parts(Rig(CRANK_ROCKERS["2,1,2,2"]), 1.0)
    printed = kept(entry, point)
    assert np.abs(printed - point["eps3"] * point["f3"]).max() == pytest.approx(6.6, abs=0.05)
    assert np.abs(complete - printed).max() == pytest.approx(4.5, abs=0.05)


@cache
def steps():
    """Return the natural frequencies of the first rig's coupler at rest, and steps at the limit.

    A wave sampled at the limit returns after twenty steps.
    """
    rig, speed, points = RIGS["5,1,5,2"], 40.0, []
    first = (np.pi / 15.0) ** 2 * np.sqrt(rig.stiffness / rig.mass_per_length)
    assert first == pytest.approx(rig.frequency, rel=1e-12)
    names = {"EI": rig.stiffness, "mu": rig.mass_per_length, "F_x": 0}
    still = {sp.Symbol(n, real=True): v for n, v in names.items()} | {omega2: 0, omega3: 0, l3: 15}
    for m in (1, 2, 3):
        Omega_m = np.sqrt(float(projected(m, m)[1].subs(still)))
        limit = TURN / (20 * Omega_m)
        assert np.cos(20 * limit * Omega_m) == pytest.approx(1.0, abs=1e-12)
        point = {"m": m, "l": 15.0, **names, "Omega_m": Omega_m, "Omega": rig.frequency}
        point |= {"h_max": limit, "omega2": speed, "T": TURN / speed, "lam": first / speed}
        points.append(point | {"Omega1": first, "h_deg": np.degrees(speed * limit)})
    return points


row("6.2.3.1 largest step", check=lambda entry: largest_step(entry))
row("6.2.3.1 h < 18/lambda", check=lambda entry: largest_step(entry, 1))
row("6.2.3.1 h < 18/lambda_m", check=lambda entry: largest_step(entry))


def largest_step(entry, count=3):
    """At the limit both sides of an inequality are equal; its definitions hold."""
    for point in steps()[:count]:
        for sides in entry.printed.sides(**{"h": point["h_max"], **point}):
            for other in sides[1:]:
                assert other == pytest.approx(sides[0], rel=1e-12)


@row("6.2.3.3 places of instability")
def places_of_instability(entry):
    f3 = linkage_function("5,1,5,2")
    limits = [boundaries(0.05 * f3, n) for n in (1, 2, 3, 4)]
    for n, (low, high) in enumerate(limits, start=1):
        assert low - 1e-12 <= high
        middle, right = entry.corrected.sides(lam=np.sqrt(0.5 * (low + high)), n=n)[0]
        assert abs(middle - right) < 0.03
    left, printed = entry.printed.sides(lam=np.sqrt(middle))[0]
    assert left == pytest.approx(middle)
    quoted([printed], "2.47")
    assert limits[2][1] < printed < limits[3][0]


test_row, test_falsified_row = row.tests()
