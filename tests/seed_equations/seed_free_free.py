"""Free-free modes in many digits, by the textbook: hyperbolic functions and quadrature."""

from __future__ import annotations

from functools import cache

import mpmath

_DIGITS = 40


def parity(i):
    return 1 if i % 2 else -1


@cache
def root(i):
    """Return the i-th positive root of ``cos b cosh b = 1``."""
    with mpmath.workdps(_DIGITS):
        start = (i + mpmath.mpf(1) / 2) * mpmath.pi
        return mpmath.findroot(lambda b: mpmath.cos(b) * mpmath.cosh(b) - 1, start)


def mode(i, s, order=0):
    """Return a derivative of mode i of unit square, s from the middle of unit length."""
    b = root(i)
    turns = (mpmath.cos, mpmath.sin) if parity(i) > 0 else (mpmath.sin, mpmath.cos)
    rises = (mpmath.cosh, mpmath.sinh) if parity(i) > 0 else (mpmath.sinh, mpmath.cosh)
    first = -1 if parity(i) > 0 else 1  # sign of the first derivative of the circular one
    sign = (1, first, -1, -first)[order % 4]
    swing = sign * turns[order % 2](b * s) / turns[0](b / 2)
    return b**order * (swing + rises[order % 2](b * s) / rises[0](b / 2))


@cache
def integral(power, i, j, orders):
    """Return ``int s^power psi_i^(k) psi_j^(l) ds`` over the length, by quadrature."""
    with mpmath.workdps(_DIGITS):
        return mpmath.quad(
            lambda s: s**power * mode(i, s, orders[0]) * mode(j, s, orders[1]),
            mpmath.linspace(-0.5, 0.5, 5),
        )
