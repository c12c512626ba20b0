"""The flexible rod by Newton's law in many digits: an independent way to its linear equations.

A basis of plain polynomials, the place of every point of the rod in the ground's axes, and
d'Alembert's principle with accelerations by finite differences.  Nothing is taken from the package.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import mpmath
import numpy as np
import periodic_systems
from numpy.polynomial.legendre import leggauss
from sympy.integrals.quadrature import gauss_legendre

DIGITS = 80


class PlainBasis:
    """Shapes ``eta^k (eta - xi)``, k = 1 ... n, smooth across the block."""

    def __init__(self, size):
        self.size = size
        self.labels = tuple(f"q{k}" for k in range(1, size + 1))

    def shapes(self, x, place, derivative=0):
        """Return shape ``(nt, nx, n)``; ``derivative`` by eta."""
        return self._power(x, place, derivative, 1) - place[:, None, None] * self._power(
            x, place, derivative, 0
        )

    def drifts(self, x, place, derivative=0):
        """Return the derivatives by xi, likewise."""
        return -self._power(x, place, derivative, 0)

    def _power(self, x, place, derivative, more):
        columns = []
        for k in range(1, self.size + 1):
            one = np.polynomial.Polynomial.basis(k + more)
            columns.append((one.deriv(derivative) if derivative else one)(x))
        return np.broadcast_to(np.stack(columns, -1), (len(place), len(x), self.size))

    def array(self, name, place):
        """Return the integrals of the protocol by quadrature, exact for these polynomials."""
        nodes, weights = leggauss(self.size + 4)
        x, w = (nodes + 1) / 2, weights / 2
        e, d = self.shapes(x, place), self.drifts(x, place)
        bent, slope = self.shapes(x, place, 2), self.shapes(x, place, 1)

        def product(left, right, weight=w):
            return np.einsum("x,txi,txj->tij", weight, left, right)

        table = {
            "overlap": lambda: product(e, e),
            "drift": lambda: product(e, d),
            "drift_drift": lambda: product(d, d),
            "bending": lambda: product(bent, bent),
            "bending_drift": lambda: product(bent, self.drifts(x, place, 2)),
            "tension": lambda: product(slope, slope, w * (1 - x**2) / 2),
            "moment": lambda: np.einsum("x,txi->ti", w * x, e),
            "mean": lambda: np.einsum("x,txi->ti", w, e),
        }
        return table[name]()


@dataclass(frozen=True)
class Rod:
    """Numbers of one rod; ``taut``: bending shortens it along the line."""

    frame: float
    crank: float
    length: float
    bending_stiffness: float
    mass_per_length: float
    damping: float
    internal_damping: float
    taut: bool

    def line(self, theta):
        """Return the block's distance from the pin and the line's direction, in mpmath numbers."""
        reach = self.frame + self.crank * mpmath.expj(theta)
        return abs(reach), reach / abs(reach)

    def residual(self, crank_angle, coordinates):
        """Return ``int m a . dr/dq_i + dV/dq_i - Q_i`` at time 0, to vanish in a motion.

        Crank angle and coordinates are functions of time.
        """
        with mpmath.workdps(DIGITS):
            step = mpmath.mpf(10) ** -12
            times = [k * step for k in range(-4, 5)]
            size = len(coordinates(mpmath.mpf(0)))
            total = [mpmath.mpf(0)] * size
            for eta, weight in zip(*_gauss(2 * size + 6), strict=True):
                dx = weight * self.length
                states = [self._point(eta, crank_angle(t), coordinates(t)) for t in times]
                now = states[4]
                acceleration = _second([s.place for s in states], step)
                rate = _first([s.deflection for s in states], step)
                bent_rate = _first([s.curvature for s in states], step)
                for i, (across, along, bent) in enumerate(now.virtual):
                    moved = (across * 1j - along) * now.direction
                    push = acceleration.real * moved.real + acceleration.imag * moved.imag
                    total[i] += dx * self.mass_per_length * push
                    total[i] += dx * self.damping * rate * across
                    moment = self.bending_stiffness * now.curvature
                    moment += self.internal_damping * bent_rate
                    total[i] += dx * moment * bent
            return total

    def _point(self, eta, theta, q):
        slide, direction = self.line(theta)
        xi = slide / self.length
        length = self.length

        def field(at, derivative):
            return [_shape(k, at, xi, derivative) for k in range(1, len(q) + 1)]

        deflection = length * mpmath.fdot(q, field(eta, 0))
        shortening, alongs = mpmath.mpf(0), [mpmath.mpf(0)] * len(q)
        if self.taut:
            # u = -int_0^x v_x^2/2, and its derivative by each coordinate.
            for node, weight in zip(*_gauss(len(q) + 2), strict=True):
                slopes = field(node * eta, 1)
                slope = mpmath.fdot(q, slopes)
                shortening += weight * eta * length * slope**2 / 2
                alongs = [
                    a + weight * eta * length * slope * s
                    for a, s in zip(alongs, slopes, strict=True)
                ]
        place = (eta * length - shortening + 1j * deflection) * direction
        virtual = [
            (length * e, a, b / length)
            for e, a, b in zip(field(eta, 0), alongs, field(eta, 2), strict=True)
        ]
        curvature = mpmath.fdot(q, field(eta, 2)) / length
        return _State(place, direction, deflection, curvature, virtual)


@dataclass(frozen=True)
class _State:
    place: complex
    direction: complex
    deflection: float
    curvature: float
    virtual: list


def _shape(k, eta, xi, derivative):
    """Return a derivative of ``eta^k (eta - xi)``."""
    first = mpmath.ff(k + 1, derivative) * eta ** (k + 1 - derivative)
    second = mpmath.ff(k, derivative) * eta ** (k - derivative) if derivative <= k else 0
    return first - xi * second


@cache
def _gauss(count):
    """Return Gauss nodes and weights on [0, 1] in many digits."""
    nodes, weights = gauss_legendre(count, DIGITS)
    return [(1 + mpmath.mpf(x)) / 2 for x in nodes], [mpmath.mpf(w) / 2 for w in weights]


def _first(values, step):
    """Return the first derivative by nine points; error of order 8 in the step."""
    half = (mpmath.mpf(1) / 280, -mpmath.mpf(4) / 105, mpmath.mpf(1) / 5, -mpmath.mpf(4) / 5)
    weights = (*half, 0, *(-w for w in half[::-1]))
    return mpmath.fsum(w * v for w, v in zip(weights, values, strict=True)) / step


def _second(values, step):
    """Return the second derivative by nine points; error of order 8 in the step."""
    half = (-mpmath.mpf(1) / 560, mpmath.mpf(8) / 315, -mpmath.mpf(1) / 5, mpmath.mpf(8) / 5)
    weights = (*half, -mpmath.mpf(205) / 72, *half[::-1])
    return mpmath.fsum(w * v for w, v in zip(weights, values, strict=True)) / step**2


def linear_forces(rod, size, theta, rate, acceleration):
    """Return the matrices of q, qd, qdd and the force of the rod, by Newton's law alone."""

    def crank(t):
        return theta + rate * t + acceleration * t**2 / 2

    def pushed(which, power, amount):
        def coordinates(t):
            return [amount * t**power if i == which else mpmath.mpf(0) for i in range(size)]

        return rod.residual(crank, coordinates)

    with mpmath.workdps(DIGITS):
        small = mpmath.mpf(10) ** -10
        found = []
        for power in range(3):
            columns = []
            for which in range(size):
                # What is quadratic in the deflection drops out.
                ends = zip(pushed(which, power, small), pushed(which, power, -small), strict=True)
                factor = 2 * small * (2 if power == 2 else 1)
                columns.append([float((up - down) / factor) for up, down in ends])
            found.append(np.array(columns).T)
        force = -np.array([float(r) for r in pushed(0, 0, mpmath.mpf(0))])
    return (*found, force)


def second_order(system, theta, rate, acceleration):
    """Return the matrices of q, qd, qdd and the force of a system at one angle."""
    return [part[0] for part in periodic_systems.second_order(system, theta, rate, acceleration)]
