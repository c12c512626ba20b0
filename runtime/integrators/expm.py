"""Exponential of a stack of small matrices by Taylor polynomials in few products, then squaring.

Products of small matrices cost a tenth to a fortieth of the solution of a system of their size, so
nothing is solved here.  A polynomial of degree 8 takes three products and one of degree 12 four
(Bader, Blanes and Casas, Mathematics 7 (2019) 1174, section 3); their coefficients are worked out
below from those of the exponential.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.namespaces import identity, namespace_of

Array = NDArray[np.float64]

# Largest 1-norm for which Taylor's polynomial of a degree is exact to double precision: its
# backward error, log(exp(-x) T(x)) with all signs made positive, is below u there.
_REACH = {4: 3.397e-4, 8: 4.991e-2, 12: 0.2996}
# Norm beyond which scaling would leave no digit.
_LARGEST = 1e15


def expm(matrices: Array) -> Array:
    """Return the exponentials of square matrices.

    The polynomial is exact to round-off where it is used, so that Hamiltonian matrices give
    matrices that are symplectic to round-off.

    Parameters
    ----------
    matrices : ndarray
        Shape ``(..., m, m)``, of any array namespace.

    Returns
    -------
    ndarray
        Same shape.  The whole stack is scaled alike, by its largest 1-norm; 2 x 2 matrices are
        taken in closed form.

    Raises
    ------
    BadInput
        If the largest 1-norm is not a number below 1e15.
    """
    xp = namespace_of(matrices)
    empty = 0 in matrices.shape
    norm = 0.0 if empty else float(xp.max(xp.sum(xp.abs(matrices), axis=-2)))
    if not norm < _LARGEST:
        raise bad("norm of a matrix exponent", norm, "a number below 1e15", "shorten the step")
    if matrices.shape[-1] == 2:
        return _two_by_two(matrices)
    degree = next((d for d, reach in _REACH.items() if norm <= reach), 12)
    halvings = max(0, int(np.ceil(np.log2(norm / _REACH[12])))) if degree == 12 else 0
    scaled = matrices / 2.0**halvings
    result: Array = {4: _fourth, 8: _eighth, 12: _twelfth}[degree](scaled)
    for _ in range(halvings):
        result = result @ result
    return result


def _two_by_two(matrices: Array) -> Array:
    """Return ``e^mu (cosh(s) I + sinh(s)/s (X - mu I))``, mu half the trace, s^2 = -det(X - mu)."""
    mean = 0.5 * (matrices[..., 0, 0] + matrices[..., 1, 1])
    half = 0.5 * (matrices[..., 0, 0] - matrices[..., 1, 1])
    upper, lower = matrices[..., 0, 1], matrices[..., 1, 0]
    square = half**2 + upper * lower
    xp = namespace_of(matrices)
    root = xp.sqrt(xp.abs(square))
    growing = square > 0
    nothing = xp.zeros_like(root)
    one = nothing + 1.0
    safe = xp.where(root > 0, root, one)
    grows = xp.where(growing, root, nothing)
    with np.errstate(over="ignore"):
        # e^mu cosh and e^mu sinh/s without a large factor times a small one.
        rise, size = xp.exp(mean + grows), xp.exp(mean)
        fall = xp.exp(-2.0 * grows)
        even = xp.where(growing, 0.5 * rise * (1.0 + fall), size * xp.cos(root))
        grown = -0.5 * rise * xp.expm1(-2.0 * grows) / safe
        turned = size * xp.where(root > 0, xp.sin(root) / safe, one)
    odd = xp.where(growing, grown, turned)
    first, last = even + odd * half, even - odd * half
    rows = [first, odd * upper, odd * lower, last]
    out: Array = xp.reshape(xp.stack(rows, axis=-1), matrices.shape)
    return out


def _fourth(x: Array) -> Array:
    square = x @ x
    inner = square / 24 + x / 6 + _constant(0.5, x)
    return square @ inner + x + _constant(1.0, x)


def _eighth(x: Array) -> Array:
    first, second = eighth_degree()
    square = x @ x
    fourth = square @ (first[0] * x + first[1] * square)
    left = first[2] * square + fourth
    right = second[1] * x + second[2] * square + second[3] * fourth + _constant(second[0], x)
    return left @ right + second[4] * square + x + _constant(1.0, x)


def _twelfth(x: Array) -> Array:
    inner, shift, middle, outer = twelfth_degree()
    square = x @ x
    cube = square @ x

    def cubic(c: tuple[float, ...]) -> Array:
        return c[1] * x + c[2] * square + c[3] * cube + _constant(c[0], x)

    root = cubic(inner)
    sixth = root @ root + cubic(shift)
    return sixth @ (sixth + cubic(middle)) + cubic(outer)


def _constant(value: float, like: Array) -> Array:
    constant: Array = value * identity(like.shape[-1], like)
    return constant


@cache
def eighth_degree() -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the coefficients of Taylor's polynomial of degree 8 in three products.

    With A2 = A A and A4 = A2 (x1 A + x2 A2) it is ``(x3 A2 + A4)(y0 + y1 A + y2 A2 + y3 A4)
    + y4 A2 + A + I``, and x3 = 2/3 is chosen.  Degrees 8 down to 3 then leave a quadratic equation
    for t = 1/x2.

    Returns
    -------
    tuple
        (x1, x2, x3) and (y0, ..., y4).
    """
    with localcontext() as context:
        context.prec = 50
        c = [Decimal(1) / factorial(k) for k in range(9)]
        x3 = Decimal(2) / 3
        r = c[7] / (2 * c[8])  # x1/x2, from degrees 8 and 7
        k2 = c[6] - r**2 * c[8]
        k1 = c[5] - r * k2
        leading, linear = -(x3**2) * c[8], x3 * (k2 - k1 / r)
        constant = c[3] / r + r * k1 - c[4]
        t = (-linear - (linear**2 - 4 * leading * constant).sqrt()) / (2 * leading)
        y3 = c[8] * t**2
        y2 = k2 * t - x3 * y3
        y1 = k1 * t
        y0 = (c[3] - x3 * y1) * t / r
        first, second = (r / t, 1 / t, x3), (y0, y1, y2, y3, c[2] - x3 * y0)
    return tuple(map(float, first)), tuple(map(float, second))


@cache
def twelfth_degree() -> tuple[tuple[float, ...], ...]:
    """Return the coefficients of Taylor's polynomial of degree 12 in four products.

    It is ``Q (Q + P) + R`` with ``Q = S^2 + T`` and cubic polynomials P, R, S, T.  For any s0, the
    polynomial s = Q + P/2 of degree 6 follows from degrees 12 to 7, P from degrees 6 to 4 (real
    for s0 > 2.51; 3 is chosen), and R from the rest.  The constants of P and S are free: 6 and 0
    make that of Q zero, so that nothing large cancels.

    Returns
    -------
    tuple
        Ascending coefficients of S, T, P and R.
    """
    with localcontext() as context:
        context.prec = 50
        zero = Decimal(0)
        c = [Decimal(1) / factorial(k) for k in range(13)]
        s = [Decimal(3)] + 6 * [zero]
        s[6] = c[12].sqrt()
        for k in range(5, 0, -1):
            known = sum((s[i] * s[6 + k - i] for i in range(k + 1, 6)), zero)
            s[k] = (c[6 + k] - known) / (2 * s[6])
        left = [c[k] - sum((s[i] * s[k - i] for i in range(k + 1)), zero) for k in range(7)]
        # P^2/4 = -left in degrees 6 to 4.
        p3 = 2 * (-left[6]).sqrt()
        p2 = -2 * left[5] / p3
        p1 = (-4 * left[4] - p2**2) / (2 * p3)
        p0 = 2 * s[0]
        p = (p0, p1, p2, p3)
        r = [left[k] + sum((p[i] * p[k - i] for i in range(k + 1)), zero) / 4 for k in range(4)]
        s3 = s[6].sqrt()
        s2 = s[5] / (2 * s3)
        s1 = (s[4] - s2**2) / (2 * s3)
        t = (zero, s[1] - p1 / 2, s[2] - p2 / 2 - s1**2, s[3] - p3 / 2 - 2 * s1 * s2)
        found = ((zero, s1, s2, s3), t, p, r)
    return tuple(tuple(map(float, row)) for row in found)
