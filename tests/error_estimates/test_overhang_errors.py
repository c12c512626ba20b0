"""Error estimates of the overhang modes' frequencies and Galerkin integrals, over random scenes."""

from __future__ import annotations

import mpmath
import numpy as np
import overhang_truth
import pytest
from elastolink.runtime.systems.rod import OverhangBasis
from galerkin_integrals import galerkin_integrals

SCENES = 200


def honest(figures, actual):
    """Assert the two rules: nearly always enough, and not idle."""
    figures, actual = np.asarray(figures), np.asarray(actual)
    assert np.mean(actual <= figures) >= 0.99
    assert np.median(figures / np.maximum(actual, figures * 1e-6)) <= 1e3


def random_place(rng):
    return float(rng.choice([rng.uniform(0.03, 1.0), 1.0 - 10.0 ** rng.uniform(-9, -1)]))


@pytest.mark.parametrize("scenes", [20, pytest.param(SCENES, marks=pytest.mark.slow)])
def test_frequencies(monkeypatch, scenes):
    monkeypatch.setattr(overhang_truth, "DIGITS", 120)
    rng = np.random.default_rng(81)
    figures, actual = [], []
    for _ in range(scenes):
        place, mode = random_place(rng), int(rng.integers(1, 21))
        rod = {
            name: float(10.0 ** rng.uniform(-3, 3))
            for name in ("length", "bending_stiffness", "mass_per_length")
        }
        found = OverhangBasis(mode).frequencies(place, **rod)
        with mpmath.workdps(120):
            beta = overhang_truth.exact_root(place, mode)
            length, stiffness, mass = (mpmath.mpf(value) for value in rod.values())
            exact = beta**2 * mpmath.sqrt(stiffness / mass) / length**2
            actual.append(float(abs(exact - float(found.frequencies[0, -1]))))
        figures.append(float(found.error[0, -1]))
    honest(figures, actual)


@pytest.mark.slow
def test_galerkin_integrals(monkeypatch):
    """The entries of b from end values in 150 digits and derivatives of the drift by differences.

    The drift of two modes is ``(R1 s2 + R2 s1) / (B1 - B2)`` by Green's identity; its derivative
    along xi and the integral of both drifts are what :mod:`overhang_truth` does not share.
    """
    monkeypatch.setattr(overhang_truth, "DIGITS", 100)
    rng = np.random.default_rng(82)
    figures, actual = [], []
    for _ in range(SCENES):
        eps, frame = rng.uniform(0.01, 0.6), float(rng.uniform(0.2, 3.0))
        length = float(frame * (1 + eps) * rng.uniform(1.01, 2.0))
        theta, modes = float(rng.uniform(0, 2 * np.pi)), int(rng.integers(1, 6))
        found = galerkin_integrals(theta, modes, crank_ratio=float(eps), frame=frame, length=length)
        k = modes - 1
        with mpmath.workdps(100):
            exact = exact_diagonal(theta, float(eps) * frame, frame, length, modes)
            actual.append(float(abs(exact - float(found.b_bar[0, k, k]))))
        figures.append(float(found.error[0]))
    honest(figures, actual)


def exact_diagonal(theta, crank, frame, length, mode):
    """Return ``int e d^2 e/dtheta^2 = -xi'^2 int (de/dxi)^2`` by quadrature in many digits."""
    angle, c, f = mpmath.mpf(theta), mpmath.mpf(crank), mpmath.mpf(frame)
    xi = mpmath.sqrt(f**2 + c**2 + 2 * f * c * mpmath.cos(angle)) / mpmath.mpf(length)
    speed = -f * c * mpmath.sin(angle) / (xi * mpmath.mpf(length) ** 2)
    beta = overhang_truth.exact_root(float(xi), mode)
    for _ in range(4):  # at the exact place
        slope = overhang_truth.slope_of(lambda at: overhang_truth.determinant(xi, at), beta)
        beta -= overhang_truth.determinant(xi, beta) / slope
    total = mpmath.mpf(0)
    nodes, weights = np.polynomial.legendre.leggauss(24 + 2 * mode)
    for side, start, end in (("before", 0, xi), ("beyond", xi, 1)):
        for node, weight in zip(nodes, weights, strict=True):
            eta = start + (end - start) * (1 + mpmath.mpf(float(node))) / 2
            value = overhang_truth.drift(xi, beta, eta, 0, side)
            total += (end - start) * mpmath.mpf(float(weight)) / 2 * value**2
    return -(speed**2) * total


def test_the_basis_at_a_place_that_is_a_node():
    """The figure of a root holds where both bays, held at the block, vibrate alike."""
    place = overhang_truth.NAMED["a node of slope"]
    roots = OverhangBasis(4).roots(np.array([place]))[0]
    for mode, root in enumerate(roots, start=1):
        exact = overhang_truth.exact_root(place, mode)
        assert abs(float(exact) - root) <= np.finfo(float).eps * root
