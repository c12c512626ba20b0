"""Beale & Scott's integrals (8)-(11) on the exact modes, against quadrature in many digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.systems.rod import OverhangBasis
from galerkin_integrals import galerkin_integrals
from overhang_reference import DIGITS, mode_at, product

ROD = {"crank_ratio": 0.2, "frame": 0.59997, "length": 1.0}


class Turned:
    """A derivative of a mode by the crank angle, by central differences of step 1e-12."""

    STEP = mpmath.mpf(10) ** -12

    def __init__(self, theta, start, order):
        self.order = order
        self.xi = self.block(theta)
        self.modes = [mode_at(self.block(theta + k * self.STEP), start) for k in (-1, 0, 1)]

    @staticmethod
    def block(theta):
        """Return x1/L from the triangle of frame, crank and rod."""
        frame = mpmath.mpf(ROD["frame"])
        crank = mpmath.mpf(ROD["crank_ratio"] * ROD["frame"])
        square = frame**2 + crank**2 + 2 * frame * crank * mpmath.cos(theta)
        return mpmath.sqrt(square) / mpmath.mpf(ROD["length"])

    def side(self, eta, order, beyond):
        """Return the derivative on one side of the block."""
        behind, here, ahead = (mode.side(eta, order, beyond) for mode in self.modes)
        if self.order == 1:
            return (ahead - behind) / (2 * self.STEP)
        return (ahead - 2 * here + behind) / self.STEP**2


@pytest.mark.slow
def test_all_four_integrals_in_many_digits():
    theta = 1.1
    found = galerkin_integrals(theta, 2, **ROD)
    with mpmath.workdps(DIGITS):
        xi = Turned.block(mpmath.mpf(theta))
        starts = [float(start) for start in found.roots[0]]
        modes = [mode_at(xi, start) for start in starts]
        for n, start in enumerate(starts):
            first, second = (Turned(mpmath.mpf(theta), start, order) for order in (1, 2))
            for k, mode in enumerate(modes):
                a = 2 * product(mode, first, (0, 0))
                b = product(mode, second, (0, 0))
                assert abs(float(a) - found.a_bar[0, k, n]) < 2e-14
                assert abs(float(b) - found.b_bar[0, k, n]) < found.error[0]
            moment = product(modes[n], modes[n], (0, 0))
            assert abs(float(moment) - found.delta[0, n]) < 1e-15
            arm = mpmath.quad(lambda x, m=modes[n]: x * m.side(x, 0, False), (0, xi))
            arm += mpmath.quad(lambda x, m=modes[n]: x * m.side(x, 0, True), (xi, 1))
            assert abs(float(arm) - found.g_bar[0, n]) < 2e-15


def test_the_rate_of_a_is_b_and_first_derivatives():
    """``d(a/2)/dtheta = b + int e_k' e_n'`` (' by theta), from samples over a whole turn."""
    count = 512
    theta = 2 * np.pi * np.arange(count) / count
    found = galerkin_integrals(theta, 4, **ROD)
    wave = np.fft.fftfreq(count, 1 / count)[:, None, None]
    rate = np.fft.ifft(1j * wave * np.fft.fft(found.a_bar / 2, axis=0), axis=0).real
    both = OverhangBasis(4).array("drift_drift", found.place)
    eps = ROD["crank_ratio"]
    speed = -(ROD["frame"] ** 2) * eps * np.sin(theta) / (found.place * ROD["length"] ** 2)
    expected = found.b_bar + (speed**2)[:, None, None] * both
    np.testing.assert_allclose(rate, expected, rtol=0, atol=1e-11)


def test_the_symmetric_part_of_b_needs_no_second_derivative():
    found = galerkin_integrals(np.linspace(0.0, 6.0, 7), 3, **ROD)
    symmetric = found.b_bar + np.swapaxes(found.b_bar, 1, 2)
    assert np.all(np.linalg.eigvalsh(symmetric) < 1e-13)
    assert np.all(np.trace(found.b_bar, axis1=1, axis2=2)[1:] < 0)
    np.testing.assert_array_equal(found.a_bar, -np.swapaxes(found.a_bar, 1, 2))
