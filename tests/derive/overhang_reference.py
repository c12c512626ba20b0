"""Modes of the beam with an overhang from six conditions, in many digits.

Sine and hyperbolic sine from the pin up to the support, all four waves of ``beta eta`` beyond it;
the conditions are six linear equations.  Shares nothing with the package but the conditions.
"""

from functools import lru_cache

import mpmath
import numpy as np

DIGITS = 60


def _waves(phase, order):
    """Return sin, cos, sinh, cosh or a derivative of them."""
    (c, s), ch, sh = mpmath.cos_sin(phase), mpmath.cosh(phase), mpmath.sinh(phase)
    circular = ((s, c), (c, -s), (-s, -c), (-c, s))[order % 4]
    return (*circular, *((sh, ch) if order % 2 == 0 else (ch, sh)))


def conditions(xi, beta):
    """Return six rows on two waves before the support and four beyond it."""
    rows = []
    at, tip = beta * xi, beta
    for order in (0, 1, 2):
        sine, _, rise, _ = _waves(at, order)
        beyond = _waves(at, order)
        if order == 0:
            rows += [[sine, rise, 0, 0, 0, 0], [0, 0, *beyond]]
        else:
            rows.append([sine, rise, *(-w for w in beyond)])
    rows += [[0, 0, *_waves(tip, order)] for order in (2, 3)]
    return rows


def gauss(place, count):
    """Return nodes on both sides of the support, and weights."""
    s, w = np.polynomial.legendre.leggauss(count)
    s, w = (1 + s) / 2, w / 2
    rest = 1 - place
    return np.concatenate([place * s, place + rest * s]), np.concatenate([place * w, rest * w])


class Mode:
    """One mode in many digits, of unit square, positive at the tip."""

    def __init__(self, xi, beta):
        self.xi, self.beta = xi, beta
        rows = conditions(xi, beta)
        # At a root one of the six follows from the others; the tip is 1 instead.
        rows[2] = [0, 0, *_waves(beta, 0)]
        self.factors = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix([0, 0, 1, 0, 0, 0]))
        self.scale = 1 / mpmath.sqrt(product(self, self, (0, 0)))

    scale = 1

    def side(self, eta, order, beyond):
        """Return a derivative on one side of the support."""
        waves = _waves(self.beta * eta, order)
        parts = waves if beyond else (waves[0], waves[2])
        factors = self.factors[2:] if beyond else self.factors[:2]
        total = sum(f * w for f, w in zip(factors, parts, strict=True))
        return self.scale * self.beta**order * total


def product(one, two, orders, weight=lambda eta: 1):
    """Return the integral of a weight and derivatives of two modes."""
    total = 0
    for beyond, ends in ((False, (0, one.xi)), (True, (one.xi, 1))):
        total += mpmath.quad(
            lambda eta, beyond=beyond: (
                weight(eta) * one.side(eta, orders[0], beyond) * two.side(eta, orders[1], beyond)
            ),
            ends,
        )
    return total


def root(xi, start):
    """Return a root to many digits, by secants."""
    step = mpmath.mpf(start) * mpmath.mpf(10) ** -12
    return mpmath.findroot(
        lambda beta: mpmath.det(mpmath.matrix(conditions(xi, beta))) * mpmath.exp(-2 * beta),
        (mpmath.mpf(start), mpmath.mpf(start) + step),
        tol=mpmath.mpf(10) ** (2 - 2 * mpmath.mp.dps),
        verify=False,
    )


@lru_cache(maxsize=256)
def mode_at(xi, start):
    """Return the mode whose root is near a start, at a place given in many digits."""
    return Mode(xi, root(xi, start))


class Drift:
    """Central difference of a mode along the support's place, as a mode is used."""

    STEP = mpmath.mpf(10) ** -12

    def __init__(self, xi, start):
        self.before, self.after = (mode_at(xi + move, start) for move in (-self.STEP, self.STEP))

    def side(self, eta, order, beyond):
        """Return a derivative by eta on one side of the support."""
        before, after = (mode.side(eta, order, beyond) for mode in (self.before, self.after))
        return (after - before) / (2 * self.STEP)
