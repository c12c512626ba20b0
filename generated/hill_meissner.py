"""Meissner's equation: Hill's equation with a piecewise constant coefficient.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism hill, formulation meissner.
Equations: Aannaque (7.9); Aannaque (7.11).

The matrix that carries (y, y') over all intervals has the determinant 1; so J^2 - 1 =
half_difference^2 + upper lower, which keeps its digits where J is near 1 or -1.

Of two intervals, over half a turn from the middle of the first to the middle of the second: J_2 -
1 = 2 y1' y2 and J_2 + 1 = 2 y1 y2'.

Cost per evaluation:
    interval: 27 operations
    two_intervals: 15 operations
    three_intervals: 46 operations
    four_intervals: 117 operations
    one_more_interval: 20 operations
    half_turn: 13 operations
Content hash 40c7459fd1db72d202ae7c249d266f63; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "interval", "two_intervals", "three_intervals", "four_intervals", "one_more_interval",
    "half_turn",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"meissner","mechanism":"hill","modes":nu'
    'll,"outputs":[]}'
)
CONTENT = "40c7459fd1db72d202ae7c249d266f63"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "level": ("", "Coefficient q = v^2 of y, of either sign"),
    "length": ("rad", "Length t of the interval"),
    "cosine": ("", "cos v t, the hyperbolic one where the level is negative"),
    "sine": ("", "sin(v t) / v, likewise; t where the level is zero"),
    "c1": ("", "cos v t of interval 1"),
    "s1": ("", "sin(v t) / v of interval 1"),
    "q1": ("", "Level v^2 of interval 1"),
    "c2": ("", "cos v t of interval 2"),
    "s2": ("", "sin(v t) / v of interval 2"),
    "q2": ("", "Level v^2 of interval 2"),
    "half_trace": ("", "Half the sum of the diagonal: J of Meissner"),
    "half_difference": ("", "Half the difference of the diagonal, first entry less second"),
    "upper": ("", "Entry above the diagonal: y from y'"),
    "lower": ("", "Entry below the diagonal: y' from y"),
    "c3": ("", "cos v t of interval 3"),
    "s3": ("", "sin(v t) / v of interval 3"),
    "q3": ("", "Level v^2 of interval 3"),
    "c4": ("", "cos v t of interval 4"),
    "s4": ("", "sin(v t) / v of interval 4"),
    "q4": ("", "Level v^2 of interval 4"),
    "half_trace_before": ("", "Before it, half the sum of the diagonal: J of Meissner"),
    "half_difference_before": (
        "", "Before it, half the difference of the diagonal, first entry less second",
    ),
    "upper_before": ("", "Before it, entry above the diagonal: y from y'"),
    "lower_before": ("", "Before it, entry below the diagonal: y' from y"),
    "y1": ("", "The solution that starts as (1, 0)"),
    "y2": ("", "The solution that starts as (0, 1)"),
    "y1_slope": ("", "Slope of y1"),
    "y2_slope": ("", "Slope of y2"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "interval": ("cosine", "sine"),
    "two_intervals": ("half_trace", "half_difference", "upper", "lower"),
    "three_intervals": ("half_trace", "half_difference", "upper", "lower"),
    "four_intervals": ("half_trace", "half_difference", "upper", "lower"),
    "one_more_interval": ("half_trace", "half_difference", "upper", "lower"),
    "half_turn": ("y1", "y2", "y1_slope", "y2_slope"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def interval(level, length):
    """Return cos v t and sin(v t) / v of an interval of length t with level v^2.

    level, length : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(level)
    x0 = level / 2
    x1 = xp.abs(level)
    turn = length * xp.sqrt(x0 + x1 / 2)
    rise = length * xp.sqrt(x1 / 2 - x0)
    no_turn = xp.asarray((turn == 0), dtype=xp.float64)
    no_rise = xp.asarray((rise == 0), dtype=xp.float64)
    return (
        xp.cos(turn) * xp.cosh(rise),
        (
            length * (no_rise + xp.sinh(rise) / (no_rise + rise)) * (no_turn + xp.sin(turn) /
            (no_turn + turn))
        ),
    )


def two_intervals(c1, s1, q1, c2, s2, q2):
    """Return J_2 and the other parts of the matrix over 2 intervals.

    c1, s1, q1, c2, s2, q2 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = s1 * s2 / 2
    x1 = c1 * s2
    x2 = c2 * s1
    return c1 * c2 - x0 * (q1 + q2), x0 * (q2 - q1), x1 + x2, -x2 * q1 - x1 * q2


def three_intervals(c1, s1, q1, c2, s2, q2, c3, s3, q3):
    """Return J_3 and the other parts of the matrix over 3 intervals.

    c1 to q3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = c1 * s2
    x1 = s3 / 2
    x2 = x0 * x1
    x3 = c2 * s1
    x4 = x1 * x3
    x5 = s1 * s2
    x6 = x5 * c3 / 2
    x8 = c1 * c2 * s3
    x9 = x0 * c3
    x10 = x3 * c3
    del x1, x0, x3
    return (
        c1 * c2 * c3 - x2 * (q2 + q3) - x4 * (q1 + q3) - x6 * (q1 + q2),
        x2 * (q3 - q2) + x4 * (q3 - q1) + x6 * (q2 - q1), x10 - x5 * q2 * s3 + x8 + x9,
        q1 * q3 * s1 * s2 * s3 - x10 * q1 - x9 * q2 - x8 * q3,
    )


def four_intervals(c1, s1, q1, c2, s2, q2, c3, s3, q3, c4, s4, q4):
    """Return J_4 and the other parts of the matrix over 4 intervals.

    c1 to q4 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = c1 * c2
    x1 = s3 * s4
    x2 = x1 / 2
    x3 = x0 * x2
    x4 = c3 * s4
    x5 = c1 * s2
    x6 = x5 / 2
    x7 = x4 * x6
    x8 = c4 * s3
    x9 = x6 * x8
    x10 = c2 * s1
    x11 = x10 / 2
    x12 = x11 * x4
    x13 = x11 * x8
    x14 = c3 * c4
    x15 = s1 * s2
    x16 = x14 * x15 / 2
    x17 = q1 * q3
    x18 = q2 * q4
    x21 = x0 * x4
    x22 = x0 * x8
    del x6, x11, x0
    x23 = x14 * x5
    x24 = x10 * x14
    x25 = x1 * q3
    x26 = x15 * q2
    return (
        (
            c1 * c2 * c3 * c4 + s1 * s2 * s3 * s4 * (x17 + x18) / 2 - x12 * (q1 + q4) - x13 * (q1 +
            q3) - x16 * (q1 + q2) - x3 * (q3 + q4) - x7 * (q2 + q4) - x9 * (q2 + q3)
        ),
        (
            x12 * (q4 - q1) + x13 * (q3 - q1) + x15 * x2 * (x17 - x18) + x16 * (q2 - q1) + x3 * (q4
            - q3) + x7 * (q4 - q2) + x9 * (q3 - q2)
        ),
        x21 - x10 * x25 + x22 + x23 + x24 - x25 * x5 - x26 * x4 - x26 * x8,
        (
            c1 * q2 * q4 * s2 * s3 * s4 + c2 * q1 * q4 * s1 * s3 * s4 + c3 * q1 * q4 * s1 * s2 * s4
            + c4 * q1 * q3 * s1 * s2 * s3 - x24 * q1 - x23 * q2 - x22 * q3 - x21 * q4
        ),
    )


def one_more_interval(
    half_trace_before, half_difference_before, upper_before, lower_before, c1, s1, q1,
):
    """Return the parts of a matrix after one more interval.

    half_trace_before to q1 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = s1 / 2
    x1 = x0 * lower_before
    x2 = x0 * q1 * upper_before
    x3 = half_trace_before * s1
    x4 = half_difference_before * s1
    return (
        c1 * half_trace_before + x1 - x2, c1 * half_difference_before + x1 + x2,
        c1 * upper_before + x3 - x4, c1 * lower_before - x3 * q1 - x4 * q1,
    )


def half_turn(c1, s1, q1, c2, s2, q2):
    """Return the normalised solutions half a turn from the middle of the first of two intervals.

    c1, s1, q1, c2, s2, q2 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = c1 * c2
    x1 = s1 * s2
    x2 = c1 * s2
    x3 = c2 * s1
    return x0 - x1 * q1, x2 + x3, -x3 * q1 - x2 * q2, x0 - x1 * q2
