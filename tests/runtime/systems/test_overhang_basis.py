"""The rod's overhang modes: every root, orthonormality to mode 60, drift, integrals."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.systems.rod import OverhangBasis
from elastolink.runtime.systems.rod.overhang import root_count
from overhang_reference import DIGITS, Drift, gauss
from overhang_truth import NAMED

EPS = float(np.finfo(float).eps)
PLACES = np.array(
    [*sorted(NAMED.values()), *np.random.default_rng(60).uniform(0.03, 1.0, 8), 0.1, 0.999999]
)


def roots_at(place, modes):
    return OverhangBasis(modes).roots(np.atleast_1d(place))


def defect(modes, weights):
    """Return the largest entry of each mode's row of the Gram matrix less the identity."""
    gram = (modes.T * weights) @ modes
    return np.max(np.abs(gram - np.eye(gram.shape[0])), axis=1)


def test_every_root_is_found_and_counted():
    roots = roots_at(PLACES, 60)
    assert np.all(np.diff(roots, axis=1) > 1.5)  # the closest approach is 1.557, at xi = 0.452
    number = np.arange(60)
    places = PLACES[:, None]
    assert np.array_equal(root_count(places, roots * (1 + 1e-14)), number + 1 + 0 * places)
    assert np.array_equal(root_count(places, roots * (1 - 1e-14)), number + 0 * places)


def test_roots_at_the_ends_of_the_rod():
    """On two pins n pi; with the block at the pin, those of a cantilever."""
    on_pins = roots_at(1.0, 100)[0]
    np.testing.assert_allclose(on_pins, np.arange(1, 101) * np.pi, rtol=2 * EPS)
    clamped = roots_at(1e-7, 3)[0]
    # Relative change with the short bay's length: of the order xi.
    cantilever = [1.8751040687119611, 4.694091132974175, 7.854757438237613]
    np.testing.assert_allclose(clamped, cantilever, rtol=3e-6)


def test_roots_do_not_depend_on_their_company():
    alone = np.concatenate([roots_at(place, 9) for place in PLACES])
    np.testing.assert_allclose(roots_at(PLACES, 30)[:, :9], alone, rtol=4 * EPS)


@pytest.mark.parametrize("place", PLACES[::2])
def test_modes_are_orthonormal_to_mode_60(place):
    x, weights = gauss(place, 230)
    modes = OverhangBasis(60).shapes(x, np.array([place]))[0]
    assert np.max(defect(modes, weights)) < 1e-12
    curvatures = OverhangBasis(60).shapes(x, np.array([place]), 2)[0]
    beta = roots_at(place, 60)[0]
    assert np.max(defect(curvatures / beta**2, weights)) < 1e-11


def test_the_sign_is_that_of_the_tip():
    ends = OverhangBasis(60).end_values(np.linspace(0.01, 0.999, 400))
    assert np.all(ends["tip"] > 0)
    assert np.all(np.sign(ends["root_slope"]) == (-1.0) ** np.arange(1, 61))


def test_drift_against_differences_in_many_digits():
    """A central difference with the step 1e-12 errs by 1e-24 times the third derivative."""
    place = NAMED["a node of slope"]
    basis, xi = OverhangBasis(3), np.array([place])
    x = np.array([0.1, 0.7 * place, 0.5 * (1 + place), 1.0])
    for order in (0, 2):
        found = basis.drift(x, xi, order)[0]
        for mode, start in enumerate(basis.roots(xi)[0]):
            with mpmath.workdps(DIGITS):
                moved = Drift(mpmath.mpf(place), float(start))
                exact = [float(moved.side(mpmath.mpf(eta), order, eta > place)) for eta in x]
            size = start ** (order + 1)
            np.testing.assert_allclose(found[:, mode], exact, rtol=0, atol=1e-13 * size)


PRODUCTS = {
    "overlap": (("e", 0), ("e", 0)),
    "drift": (("e", 0), ("f", 0)),
    "drift_drift": (("f", 0), ("f", 0)),
    "bending": (("e", 2), ("e", 2)),
    "bending_drift": (("e", 2), ("f", 2)),
    "tension": (("e", 1), ("e", 1)),
}


def by_quadrature(basis, name, place, count):
    """Return an array from the shapes at Gauss nodes on both sides of the block."""
    xi = np.array([place])
    x, weights = gauss(place, count)
    sources = {"e": basis.shapes, "f": basis.drift}
    if name in ("moment", "mean"):
        mode = basis.shapes(x, xi)[0]
        return (weights * (x if name == "moment" else 1.0)) @ mode
    if name == "tension":
        weights = weights * (1 - x) * (1 + x) / 2
    one, two = (sources[kind](x, xi, order)[0] for kind, order in PRODUCTS[name])
    return (one.T * weights) @ two


@pytest.mark.parametrize("place", PLACES[::3])
def test_closed_forms_against_quadrature(place):
    """All arrays to mode 60, each entry over the product of the sizes of its two factors."""
    basis, xi = OverhangBasis(60), np.array([place])
    beta = basis.roots(xi)[0]
    for name in (*PRODUCTS, "moment", "mean"):
        found = basis.array(name, xi)[0]
        exact = by_quadrature(basis, name, place, 230)
        # Each derivative of a mode along eta or xi makes an array grow by beta.
        power = sum(order + (kind == "f") for kind, order in PRODUCTS.get(name, ())) / 2
        size = np.outer(beta**power, beta**power) if found.ndim == 2 else np.ones_like(beta)
        assert np.max(np.abs(found - exact) / size) < 1e-12, name


def test_drift_rate_is_the_derivative_of_the_drift():
    """Chebyshev interpolation of the drift over a stretch of places, differentiated."""
    basis = OverhangBasis(6)
    nodes = np.cos(np.pi * (np.arange(129) + 0.5) / 129)
    series = np.polynomial.chebyshev.Chebyshev
    drift = basis.array("drift", 0.5 + 0.04 * nodes).reshape(129, -1)
    at = np.array([0.465, 0.5, 0.53])
    found = basis.drift_rate(at).reshape(3, -1)
    for entry in range(36):
        fit = series.fit(nodes, drift[:, entry], 128, domain=[-1, 1])
        exact = fit.deriv()((at - 0.5) / 0.04) / 0.04
        np.testing.assert_allclose(found[:, entry], exact, rtol=0, atol=3e-9)


def test_an_array_is_remembered_and_not_to_be_changed():
    basis, places = OverhangBasis(3), np.linspace(0.4, 0.8, 5)
    assert basis.array("drift", places) is basis.array("drift", places.copy())
    with pytest.raises(ValueError, match="read-only"):
        basis.array("drift", places)[...] = 0.0


def test_frequencies_of_the_flexible_rod():
    """At xi = 1 those of a beam on two pins, (n pi)^2 sqrt(EI / (m L^4))."""
    rod = {"length": 1.0, "bending_stiffness": 0.7e11 * 0.5208e-6, "mass_per_length": 7.15}
    found = OverhangBasis(3).frequencies([0.5, 1.0], **rod)
    speed = np.sqrt(rod["bending_stiffness"] / rod["mass_per_length"])
    expected = (np.arange(1, 4) * np.pi) ** 2 * speed
    np.testing.assert_allclose(found.frequencies[1], expected, rtol=1e-14)
    assert found.passed and found.frequencies.shape == found.error.shape == (2, 3)
    found.plot()


def test_modes_so_high_that_exponentials_underflow():
    """Orthonormal by quadrature, without a warning."""
    place, basis = np.array([0.6]), OverhangBasis(400)
    s, weights = np.polynomial.legendre.leggauss(1000)
    found = np.zeros((400, 400))
    with np.errstate(all="raise", under="ignore"):
        for start, end in ((0.0, 0.6), (0.6, 1.0)):
            mode = basis.shapes(start + (end - start) * (1 + s) / 2, place)[0]
            found += (end - start) / 2 * (mode.T * weights) @ mode
    np.testing.assert_allclose(found, np.eye(400), rtol=0, atol=1e-11)
