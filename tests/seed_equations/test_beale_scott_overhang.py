"""Beale & Scott (5), (6), (8)-(11): Galerkin's integrals on the modes with an overhang."""

import numpy as np
import sympy as sp
from elastolink.derive.models.overhang_integrals import (
    DRIFT,
    MODE,
    Ends,
    eta,
    gap_step,
    in_roots,
    pair_integral,
    single_integral,
    square_integral,
)
from elastolink.runtime.systems.rod import OverhangBasis
from galerkin_integrals import galerkin_integrals
from seed_ledger import establishes

PAPER = "Beale & Scott"
ROD = {"crank_ratio": 0.2, "frame": 0.59997, "length": 1.0}
PAIR = (Ends.of("_k"), Ends.of("_n"))
theta = sp.Symbol("theta", real=True)


def projected():
    """Return the coefficients of f'', f', f when a trial term meets d^2 w / dtheta^2."""
    f, e, test = sp.Function("f")(theta), sp.Function("e")(eta, theta), sp.Function("e_k")(eta)
    whole = sp.expand(test * sp.diff(f * e, theta, 2))
    return {order: whole.coeff(sp.diff(f, theta, order)) for order in (2, 1)} | {
        0: whole.subs({sp.diff(f, theta, k): 0 for k in (1, 2)}).coeff(f)
    }, (e, test)


def sampled(count=4, angles=9):
    """Return the integrals at some angles, and nodes, weights, modes and drifts at each."""
    found = galerkin_integrals(np.linspace(0.2, 6.0, angles), count, **ROD)
    basis = OverhangBasis(count)
    s, w = np.polynomial.legendre.leggauss(40)
    s, w = (1 + s) / 2, w / 2
    rows = []
    for xi in found.place:
        x = np.concatenate([xi * s, xi + (1 - xi) * s])
        weights = np.concatenate([xi * w, (1 - xi) * w])
        at = np.array([xi])
        rows.append((x, weights, basis.shapes(x, at)[0], basis.drift(x, at)[0]))
    return found, rows


def speed(found):
    """Return d(x1/L)/dtheta."""
    crank = ROD["crank_ratio"] * ROD["frame"]
    return -ROD["frame"] * crank * np.sin(found.theta) / (found.place * ROD["length"] ** 2)


@establishes(
    PAPER,
    "5",
    printed=r"w_{T1} = \sum_{n=1}^N f_n(\theta)e_{n1}(\eta,\theta)",
    verdict="agrees",
)
@establishes(
    PAPER,
    "6",
    printed=r"w_{T2} = \sum_{n=1}^N f_n(\theta)e_{n2}(\eta,\theta)",
    verdict="agrees",
    remark="Both with the same f_n: the modes and their slopes and moments are continuous at the "
    "block at every angle. The modes are fixed but for a sign, which these equations leave open; "
    "positive at the tip it is continuous, for no tip of a mode is ever at rest.",
)
def test_trial_functions_are_admissible_at_every_angle():
    basis = OverhangBasis(6)
    places = np.linspace(0.05, 0.999, 60)
    for place in places[::6]:
        xi = np.array([place])
        around = np.array([place, np.nextafter(place, 1.0)])
        assert np.max(np.abs(basis.shapes(around, xi)[0])) < 1e-13
        for order in (1, 2):
            before, beyond = basis.shapes(around, xi, order)[0]
            assert np.max(np.abs(beyond - before) / basis.roots(xi)[0] ** order) < 1e-13
    assert np.all(basis.shapes(np.array([1.0]), places)[:, 0] > 0)


@establishes(
    PAPER,
    "8",
    printed=r"\Delta_{kk} = \int_0^{\bar l} e_{k1}e_{k1}\,d\eta + "
    r"\int_{\bar l}^1 e_{k2}e_{k2}\,d\eta",
    verdict="agrees",
    derived=r"\Delta_{kk} = \tfrac14 e_k(1)^2 + \frac{\bar l\,R_k\,e_k'(\bar l)}{2\beta_k^4},\; "
    r"R = e'''(\bar l^+) - e'''(\bar l^-)",
    remark="The integrals off the diagonal, absent from (7), vanish by Green's identity. Modes "
    "are scaled here so that it is 1.",
)
def test_delta():
    assert pair_integral(sp.S.One, (MODE, 0), (MODE, 0), PAIR) == 0
    one = Ends.of()
    slope, reaction, tip = sp.symbols("slope reaction tip", real=True)
    place = sp.Symbol("place", positive=True)
    closed = tip**2 / 4 + place * reaction * slope / (2 * one.beta**4)
    assert sp.expand(square_integral((MODE, 0), (MODE, 0), 0, one) - closed) == 0
    coefficients, (e, test) = projected()
    assert coefficients[2] == e * test
    found, rows = sampled()
    for k, (_, weights, modes, _) in enumerate(rows):
        np.testing.assert_allclose((modes.T * weights) @ modes, np.diag(found.delta[k]), atol=1e-13)


@establishes(
    PAPER,
    "9",
    printed=r"\bar a_{kn} = 2\left(\int_0^{\bar l} e_{k1}\frac{\partial e_{n1}}{\partial\theta}"
    r"d\eta + \int_{\bar l}^1 e_{k2}\frac{\partial e_{n2}}{\partial\theta}d\eta\right)",
    verdict="agrees",
    derived=r"\bar a_{kn} = 2\bar l'\,\frac{R_k s_n + R_n s_k}{\beta_k^4 - \beta_n^4},\; "
    r"\bar a_{kk} = 0,\; s = e'(\bar l)",
    remark="The integral that grew unwieldy is four end values: slopes and reactions at the block. "
    "It is antisymmetric.",
)
def test_a():
    closed = in_roots(pair_integral(sp.S.One, (MODE, 0), (DRIFT, 0), PAIR), PAIR)
    s, r = sp.symbols("slope_k slope_n", real=True), sp.symbols("reaction_k reaction_n", real=True)
    gap = gap_step(PAIR)[0]
    assert sp.expand(closed - (r[0] * s[1] + r[1] * s[0]) / gap) == 0
    coefficients, (e, test) = projected()
    assert sp.expand(coefficients[1] - 2 * test * sp.diff(e, theta)) == 0
    found, rows = sampled()
    for k, (_, weights, modes, drifts) in enumerate(rows):
        expected = 2 * speed(found)[k] * (modes.T * weights) @ drifts
        np.testing.assert_allclose(found.a_bar[k], expected, atol=2e-13)


@establishes(
    PAPER,
    "10",
    printed=r"\bar b_{kn} = \int_0^{\bar l} e_{k1}\frac{\partial^2 e_{n1}}{\partial\theta^2}d\eta "
    r"+ \int_{\bar l}^1 e_{k2}\frac{\partial^2 e_{n2}}{\partial\theta^2}d\eta",
    verdict="agrees",
    derived=r"\bar b_{kn} = \tfrac12\bar a_{kn}' - \bar l'^2\int_0^1 "
    r"\frac{\partial e_k}{\partial\bar l}\frac{\partial e_n}{\partial\bar l}d\eta",
    remark="Only this second-order form of the equations wants second derivatives of the modes. "
    "The first term is antisymmetric; b + b^T is the integral of first derivatives, times -2 "
    "l'^2. In the variables (q, p) neither b nor its second derivatives occur.",
)
def test_b():
    coefficients, (e, test) = projected()
    assert sp.expand(coefficients[0] - test * sp.diff(e, theta, 2)) == 0
    found, rows = sampled()
    step = 1e-4
    ahead, behind = (galerkin_integrals(found.theta + k * step, 4, **ROD).a_bar for k in (1, -1))
    for k, (_, weights, _, drifts) in enumerate(rows):
        both = speed(found)[k] ** 2 * (drifts.T * weights) @ drifts
        symmetric = found.b_bar[k] + found.b_bar[k].T
        np.testing.assert_allclose(symmetric, -2 * both, atol=2e-13)
        # The central difference errs by a sixth of the third derivative times 1e-8.
        rate = (ahead[k] - behind[k]) / (4 * step)
        np.testing.assert_allclose(found.b_bar[k], rate - both, atol=3e-5)


@establishes(
    PAPER,
    "11",
    printed=r"\bar g_k = \int_0^{\bar l}\eta e_{k1}\,d\eta + \int_{\bar l}^1\eta e_{k2}\,d\eta",
    verdict="agrees",
    derived=r"\bar g_k = -\bar l R_k/\beta_k^4",
    remark="The moment of the inertia forces about the pin is that of the block's reaction.",
)
def test_g():
    one = Ends.of()
    place, reaction = sp.Symbol("place", positive=True), sp.Symbol("reaction", real=True)
    assert sp.expand(single_integral(eta, 0, one) + place * reaction / one.beta**4) == 0
    found, rows = sampled()
    for k, (x, weights, modes, _) in enumerate(rows):
        np.testing.assert_allclose(found.g_bar[k], (weights * x) @ modes, atol=1e-14)
