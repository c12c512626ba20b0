"""Equations closed in the stations of a link: against those of just so many, and hand cases."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
import stations_truth as truth
import sympy as sp
from derivations import loaded, model_of
from elastolink.derive.emission import emit
from elastolink.derive.lagrange import euler_lagrange, variational_equations
from elastolink.derive.models import inextensible_coupler as coupler
from elastolink.derive.pipeline import equations_of_motion, lower
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec
from elastolink.derive.stations import Stations, closed_in_stations
from elastolink.generated import beam_tangent_harmonics

MECHANISMS = ("four_bar", "slider_crank")
SPECS = {name: ModelSpec(name, "inextensible", flexible=("coupler",)) for name in MECHANISMS}
T = sp.Symbol("t", real=True)
PHI = [sp.Function(f"phi{i}")(T) for i in (1, 2)]
END = sp.symbols("end_1 end_2")
INERTIA = {(i, j): sp.Symbol(f"inertia_{i}_{j}") for i, j in ((1, 1), (1, 2), (2, 2))}


@pytest.mark.parametrize("count", [2, 4])
@pytest.mark.parametrize("module", truth.STATION_MODULES)
def test_other_numbers_of_stations_give_what_is_derived_for_them(module, count):
    """Three are compared in 80 digits, see test_accuracy.py."""
    for point in truth.station_points(module, count):
        exact = truth.explicit(module, count)({n: mpmath.mpf(v) for n, v in point.inputs.items()})
        for function, arrays in truth.FUNCTIONS.items():
            entries = truth.AtEachStation(module, function, count).entries(point.inputs)
            assert set(entries) == {n for n in exact if n.rsplit("_", 2)[0] in arrays}
            for array in arrays:
                values = {n: v for n, v in entries.items() if n.rsplit("_", 2)[0] == array}
                size = max(abs(float(exact[name])) for name in values)
                for name, value in values.items():
                    assert abs(value - float(exact[name])) <= 1e-14 * size, (name, point.name)


_BOTH = sp.Add(*(m * sp.cos(PHI[i - 1]) * sp.cos(PHI[j - 1]) for (i, j), m in INERTIA.items()))
REFUSED = {
    "a product of two stations without a kernel": (sp.cos(PHI[0]) * sp.cos(PHI[1]), "is no sum"),
    "numbers of stations for a kernel": (
        sp.Mul(*(e * sp.cos(p) for e, p in zip(END, PHI, strict=True))),
        "is no sum",
    ),
    "the pair counted once": (_BOTH, "pairs with itself in another way"),
    "a product of two kernels": (
        INERTIA[1, 2] ** 2 * sp.cos(PHI[0]) * sp.cos(PHI[1]),
        "joins two stations",
    ),
    "a function of both stations": (INERTIA[1, 2] * sp.exp(PHI[0] * PHI[1]), "joins two stations"),
}


def closed(extra: sp.Expr, mechanism: str = "slider_crank"):
    """Return the coupler with something added to its Lagrangian, closed in its stations."""
    plain = coupler.lagrangian(mechanism)
    equations = euler_lagrange(replace(plain, expression=plain.expression + extra))
    return closed_in_stations(coupler.STATIONS, equations, variational_equations(equations))


@pytest.mark.parametrize("case", REFUSED)
def test_energies_that_are_no_sums_over_pairs_are_refused(case):
    extra, words = REFUSED[case]
    with pytest.raises(UnsafeRewriting, match=words):
        closed(extra)


def test_stations_that_are_not_treated_alike_are_refused():
    """In an entry without an index; of a vector the entry of the first station is taken."""
    plain = coupler.lagrangian("slider_crank")
    uneven = (plain.constraints[0] + END[0] * sp.sin(PHI[0]), plain.constraints[1])
    equations = euler_lagrange(replace(plain, constraints=uneven))
    with pytest.raises(UnsafeRewriting, match="treats the stations differently"):
        closed_in_stations(coupler.STATIONS, equations, variational_equations(equations))


def test_a_mass_at_the_end_by_the_coupler_is_refused():
    """Its energy takes all angles with one weight each, ``end_1 end_2``, and no kernel."""
    place = sum(e * sp.cos(p) for e, p in zip(END, PHI, strict=True))
    with pytest.raises(UnsafeRewriting):
        closed(place.diff(T) ** 2 / 2)


def test_the_order_of_the_kernel_does_not_matter():
    assert Stations("phi", ("x", "y"), (), ("inertia",)).pair("inertia", 2, 1) == INERTIA[1, 2]


def changed(mechanism: str, extra: sp.Expr):
    """Return the emitted module of a coupler with something added to its Lagrangian alone."""
    spec = SPECS[mechanism]
    model = model_of(spec)
    plain = model.energies(spec)
    equations = equations_of_motion(replace(plain, expression=plain.expression + extra))
    return loaded(emit(lower(spec, model.discretise(spec, equations), model.describe(spec)), "0"))


def numbers_of(module, count: int = truth.COUNT, **changes: float) -> dict[str, np.ndarray | float]:
    """Return random arguments of the functions of a module, by name."""
    random, names = np.random.default_rng(11), {**module.QUANTITIES}
    size = {name: (count, count) for name in coupler.STATIONS.matrices}
    size |= {name: (count,) for name in (*coupler.STATIONS.vectors, "phi", "phi_dot", "phi_ddot")}
    more = ("phi_dot", "phi_ddot", *(f"{n}{e}" for n in ("psi", "x4") for e in ("_dot", "_ddot")))
    values = {n: random.uniform(0.5, 1.5, size.get(n, (1,))) for n in (*names, *more)}
    for name in coupler.STATIONS.matrices:
        values[name] = values[name] + values[name].T
    return values | changes


def called(module, function: str, numbers) -> dict[str, np.ndarray]:
    """Return what a function of a module returns, by name."""
    emitted = getattr(module, function)
    numbers = numbers | {"tangent_x": np.cos(numbers["phi"]), "tangent_y": np.sin(numbers["phi"])}
    taken = emitted.__code__.co_varnames[: emitted.__code__.co_argcount]
    values = emitted(*(numbers[name] for name in taken))
    return dict(zip(module.RETURNS[function], values, strict=True))


def agree(first, second, one, other) -> None:
    """Assert that two modules return the same, each with its numbers."""
    assert first.RETURNS == second.RETURNS and first.ARRAYS == second.ARRAYS
    for function in truth.FUNCTIONS:
        found, expected = called(first, function, one), called(second, function, other)
        for name, value in found.items():
            assert value == pytest.approx(expected[name], rel=1e-13), name


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_a_mass_added_at_the_end_is_inertia_and_weight_of_what_it_drives(mechanism):
    """A mass at C, on the follower's end or the slider, given to the Lagrangian alone."""
    mass, length = 0.37, 0.62
    driven = coupler.driven(mechanism)
    x, y = driven.place
    kinetic = (sp.diff(x, T) ** 2 + sp.diff(y, T) ** 2) / 2
    weight = sum(g * place for g, place in zip(coupler.PULL, driven.place, strict=True))
    extra = (kinetic + weight).subs(sp.Symbol("follower", positive=True), length) * mass
    module = changed(mechanism, extra)
    packaged = truth.emitted_module(f"{mechanism}_coupler_inextensible")
    if mechanism == "four_bar":
        one = numbers_of(packaged, follower=length)
        other = one | {
            "follower_inertia": one["follower_inertia"] + mass * length**2,
            "follower_first_moment": one["follower_first_moment"] + mass * length,
        }
    else:
        one = numbers_of(packaged)
        other = one | {"slider_mass": one["slider_mass"] + mass}
    agree(module, packaged, one, other)


def test_the_weight_of_follower_and_coupler_is_that_of_their_centres():
    """Straight and at rest: moments of the weights about the pins, by hand."""
    module = truth.emitted_module("four_bar_coupler_inextensible")
    count, psi, phi, g = 4, 1.1, 0.4, np.array([3.0, -9.0])
    still = dict.fromkeys(("theta_d1", "theta_d2", "bending_stiffness"), 0.0)
    numbers = numbers_of(module, count, **still, gravity_x=g[0], gravity_y=g[1])
    # int (1 - s) of a straight coupler: half its length.
    numbers |= {"moment": np.array([0.1, 0.1, 0.1, 0.2]), "phi_dot": np.zeros(count)}
    numbers |= {"psi": np.array([psi]), "phi": np.full(count, phi), "psi_dot": np.zeros(1)}
    rest = called(module, "dynamics", numbers)
    normal = {angle: np.array([-np.sin(angle), np.cos(angle)]) for angle in (psi, phi)}
    moment = numbers["follower_first_moment"] * (g @ normal[psi])
    assert rest["rest_1_1"] == pytest.approx(-moment, rel=1e-14)
    mass, length = numbers["mass_per_length"] * numbers["coupler"], numbers["coupler"]
    assert np.sum(rest["rest_2_1"]) == pytest.approx(
        -mass * length / 2 * (g @ normal[phi]), rel=1e-14
    )


def test_a_bow_is_where_the_coupler_bears_no_moment():
    """Moments are those of the angle from the bow: none there, and none by a rigid turn."""
    module = truth.emitted_module("slider_crank_coupler_inextensible")
    still = dict.fromkeys(("theta_d1", "theta_d2", "gravity_x", "gravity_y"), 0.0)
    numbers = numbers_of(module, **still, phi_dot=np.zeros(truth.COUNT))
    numbers["phi"] = numbers["bow"].copy()
    assert np.all(called(module, "dynamics", numbers)["rest_2_1"] == 0.0)
    bent = numbers["phi"] = numbers["bow"] + np.array([0.1, -0.2, 0.3])
    stiffness = numbers["bending_stiffness"] / numbers["coupler"]
    expected = stiffness * (bent - numbers["bow"]) @ numbers["bending"]
    assert called(module, "dynamics", numbers)["rest_2_1"] == pytest.approx(expected, rel=1e-14)


def test_the_integrals_of_harmonics_are_those_by_quadrature():
    """And two of them meet in none, which the model verifies as it is derived."""
    names = beam_tangent_harmonics.RETURNS["integrals"]
    for n in (1, 2, 3, 8):
        found = dict(zip(names, beam_tangent_harmonics.integrals(float(n)), strict=True))
        wave = n * mpmath.pi

        def angle(s, wave=wave):
            return mpmath.cos(wave * s)

        def place(s, wave=wave):
            return mpmath.sin(wave * s) / wave

        def bend(s, wave=wave):
            return -wave * mpmath.sin(wave * s)

        expected = {
            "moment": lambda s, f=angle: (1 - s) * f(s),
            "beside_mean": lambda s, f=place: s * f(s),
            "inertia": lambda s, f=place: f(s) ** 2,
            "bending": lambda s, f=bend: f(s) ** 2,
        }
        for name, integrand in expected.items():
            value = mpmath.quad(integrand, mpmath.linspace(0, 1, n + 1))
            assert found[name] == pytest.approx(float(value), rel=1e-14, abs=1e-15), (name, n)
