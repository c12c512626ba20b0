"""Modes of a beam with an overhang: pinned at an end and at a support.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation overhang_modes.
Equations: Beale & Scott (3)-(6); Beale & Scott (8)-(11).

The tip of no mode is at rest, and no mode starts without slope at the pin: the sign that makes the
tip positive is continuous as the support moves, and the slope at the pin of mode n then has the
sign of (-1)^n.

Cost per evaluation:
    characteristic: 123 operations
    end_values: 301 operations
    modes_before: 101 operations
    drift_before: 142 operations
    modes_beyond: 216 operations
    drift_beyond: 251 operations
    pair_integrals: 72 operations
    own_integrals: 127 operations
Content hash 1cdada9c5355a40a7ce158baf323bcc0; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "characteristic", "end_values", "modes_before", "drift_before", "modes_beyond", "drift_beyond",
    "pair_integrals", "own_integrals",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"overhang_modes","mechanism":"quick_retu'
    'rn","modes":null,"outputs":[]}'
)
CONTENT = "1cdada9c5355a40a7ce158baf323bcc0"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "beta": ("", "Root: the mode solves e'''' = beta^4 e"),
    "place": ("", "Place xi of the support, in lengths from the pin; above 0, to 1"),
    "residual": ("", "Vanishes on a root, and changes its sign there"),
    "residual_slope": ("", "Its derivative by beta"),
    "left_amplitude": ("", "Factor of the wave between pin and support"),
    "right_amplitude": ("", "Factor of the shape beyond the support"),
    "left_growth": ("", "Derivative of the left amplitude by xi, over it"),
    "right_growth": ("", "Derivative of the right amplitude by xi, over it"),
    "rate": ("", "Derivative of beta by xi, over beta"),
    "span_rate": ("", "Derivative of beta xi by xi"),
    "hang_rate": ("", "Derivative of beta (1 - xi) by xi"),
    "root_slope": ("", "e' at the pin"),
    "root_shear": ("", "e''' at the pin"),
    "slope": ("", "e' at the support"),
    "moment": ("", "e'' at the support"),
    "shear": ("", "e''' before the support"),
    "reaction": ("", "Jump of e''' at the support, beyond less before"),
    "tip": ("", "e at the tip"),
    "tip_slope": ("", "e' at the tip"),
    "root_slope_drift": ("", "de'/dxi at the pin"),
    "root_shear_drift": ("", "de'''/dxi at the pin"),
    "slope_drift": ("", "de'/dxi at the support, eta fixed"),
    "moment_drift": ("", "de''/dxi before the support, eta fixed"),
    "shear_drift": ("", "de'''/dxi before the support, eta fixed"),
    "reaction_drift": ("", "Jump of de'''/dxi at the support, eta fixed, beyond less before"),
    "tip_drift": ("", "de/dxi at the tip"),
    "tip_slope_drift": ("", "de'/dxi at the tip"),
    "eta": ("", "Place of a point along the beam, in lengths from the pin"),
    "value": ("", "e, of unit square over the beam, positive at the tip"),
    "slope_along": ("", "e'"),
    "curvature": ("", "e''"),
    "third": ("", "e'''"),
    "drift": ("", "de/dxi at a fixed point"),
    "drift_slope": ("", "Its first derivative along the beam"),
    "drift_curvature": ("", "Its second derivative along the beam"),
    "beta_1": ("", "Of mode 1: Root: the mode solves e'''' = beta^4 e"),
    "slope_1": ("", "Of mode 1: e' at the support"),
    "moment_1": ("", "Of mode 1: e'' at the support"),
    "reaction_1": ("", "Of mode 1: Jump of e''' at the support, beyond less before"),
    "tip_1": ("", "Of mode 1: e at the tip"),
    "slope_drift_1": ("", "Of mode 1: de'/dxi at the support, eta fixed"),
    "reaction_drift_1": (
        "", "Of mode 1: Jump of de'''/dxi at the support, eta fixed, beyond less before",
    ),
    "beta_2": ("", "Of mode 2: Root: the mode solves e'''' = beta^4 e"),
    "slope_2": ("", "Of mode 2: e' at the support"),
    "moment_2": ("", "Of mode 2: e'' at the support"),
    "reaction_2": ("", "Of mode 2: Jump of e''' at the support, beyond less before"),
    "tip_2": ("", "Of mode 2: e at the tip"),
    "slope_drift_2": ("", "Of mode 2: de'/dxi at the support, eta fixed"),
    "reaction_drift_2": (
        "", "Of mode 2: Jump of de'''/dxi at the support, eta fixed, beyond less before",
    ),
    "drift_12": ("", "int e_1 de_2/dxi; with the modes exchanged, its negative"),
    "drift_drift_12": ("", "int de_1/dxi de_2/dxi"),
    "bending_drift_12": ("", "int e_1'' de_2''/dxi; with the modes exchanged, its negative"),
    "tension_12": ("", "int (1 - eta^2)/2 e_1' e_2'"),
    "drift_rate_12": ("", "Derivative of drift_12 by xi"),
    "drift_drift": ("", "int (de/dxi)^2"),
    "bending_drift": ("", "int e'' de''/dxi"),
    "tension": ("", "int (1 - eta^2)/2 e'^2"),
    "moment_integral": ("", "int eta e"),
    "mean": ("", "int e"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "characteristic": ("residual", "residual_slope"),
    "end_values": (
        "left_amplitude", "right_amplitude", "left_growth", "right_growth", "rate", "span_rate",
        "hang_rate", "root_slope", "root_shear", "slope", "moment", "shear", "reaction", "tip",
        "tip_slope", "root_slope_drift", "root_shear_drift", "slope_drift", "moment_drift",
        "shear_drift", "reaction_drift", "tip_drift", "tip_slope_drift",
    ),
    "modes_before": ("value", "slope_along", "curvature", "third"),
    "drift_before": ("drift", "drift_slope", "drift_curvature"),
    "modes_beyond": ("value", "slope_along", "curvature", "third"),
    "drift_beyond": ("drift", "drift_slope", "drift_curvature"),
    "pair_integrals": (
        "drift_12", "drift_drift_12", "bending_drift_12", "tension_12", "drift_rate_12",
    ),
    "own_integrals": ("drift_drift", "bending_drift", "tension", "moment_integral", "mean"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def characteristic(beta, place):
    """Return what vanishes on a root, over growing factors, and its slope along beta.

    beta, place : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    span = beta * place
    span_square = span**2
    span_fourth = span_square**2
    span_sine = xp.sin(span)
    span_cosine = xp.cos(span)
    span_fade = xp.exp(-span)
    x1 = 2 * span
    span_odd = -xp.expm1(-x1)
    span_even = span_fade**2 + 1
    x2 = 2 * span_sine
    span_excess = (
        xp.where((span > 3 / 2), span_odd - x2 * span_fade, x1 * span_fade * span_square *
        (span_fourth * (span_fourth * (span_fourth * (span_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del span_fourth, span_square, x1
    span_spread = 4 * span_fade * xp.sin(span / 2)**2 + xp.expm1(-span)**2
    x3 = 1 - place
    hang = x3 * beta
    hang_square = hang**2
    hang_fourth = hang_square**2
    hang_sine = xp.sin(hang)
    hang_cosine = xp.cos(hang)
    hang_fade = xp.exp(-hang)
    x5 = 2 * hang
    hang_odd = -xp.expm1(-x5)
    hang_even = hang_fade**2 + 1
    x6 = 2 * hang_sine
    hang_excess = (
        xp.where((hang > 3 / 2), hang_odd - x6 * hang_fade, x5 * hang_fade * hang_square *
        (hang_fourth * (hang_fourth * (hang_fourth * (hang_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del span, span_fade, hang_fourth, hang_square, x5
    x7 = 4 * hang_fade
    hang_spread = x7 * xp.sin(hang / 2)**2 + xp.expm1(-hang)**2
    x8 = 2 * hang_cosine
    x9 = x8 * hang_even + x7
    del hang_fade, hang, x7
    x10 = x2 * span_odd
    x11 = span_cosine * span_excess - span_sine * span_spread
    del span_excess, span_sine, span_spread
    x12 = x8 * hang_excess - x6 * hang_spread
    del hang_excess, hang_spread, x8
    return (
        x10 * x9 - x11 * x12,
        (
            place * ((x10 + x11) * x12 - x9 * (x10 - 2 * span_cosine * span_odd - x2 * span_even))
            + x3 * (x10 * (2 * hang_cosine * hang_odd - x6 * hang_even - x9) + x11 * (4 * hang_odd
            * hang_sine + x12))
        ),
    )


def end_values(beta, place):
    """Return amplitudes of modes of unit square, their growth, and values at the ends.

    beta, place : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    span = beta * place
    span_square = span**2
    span_fourth = span_square**2
    span_sine = xp.sin(span)
    span_cosine = xp.cos(span)
    span_fade = xp.exp(-span)
    x1 = 2 * span
    span_odd = -xp.expm1(-x1)
    span_even = span_fade**2 + 1
    x2 = 2 * span_sine
    x3 = x2 * span_fade
    span_excess = (
        xp.where((span > 3 / 2), span_odd - x3, x1 * span_fade * span_square * (span_fourth *
        (span_fourth * (span_fourth * (span_fourth / 60822550204416000 + 1 / 653837184000) + 1 /
        19958400) + 1 / 2520) + 1 / 3))
    )
    del span_fourth, span_square, x1
    span_spread = 4 * span_fade * xp.sin(span / 2)**2 + xp.expm1(-span)**2
    x4 = 1 - place
    hang = x4 * beta
    hang_square = hang**2
    hang_fourth = hang_square**2
    hang_sine = xp.sin(hang)
    hang_cosine = xp.cos(hang)
    hang_fade = xp.exp(-hang)
    x6 = 2 * hang
    hang_odd = -xp.expm1(-x6)
    hang_even = hang_fade**2 + 1
    hang_excess = (
        xp.where((hang > 3 / 2), hang_odd - 2 * hang_fade * hang_sine, x6 * hang_fade * hang_square
        * (hang_fourth * (hang_fourth * (hang_fourth * (hang_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del span, hang_fourth, hang_square, x6
    x7 = 4 * hang_fade
    hang_spread = x7 * xp.sin(hang / 2)**2 + xp.expm1(-hang)**2
    x8 = 1 / span_odd
    x9 = span_cosine * span_excess
    x10 = x9 - span_sine * span_spread
    x11 = x10 * x8
    before_slope = x11
    before_moment = -x2
    before_slope_rate = x8 * (-before_slope * span_even - x2 * span_odd)
    before_moment_rate = -2 * span_cosine
    x12 = 2 * hang_even
    del hang_fade, hang, hang_even
    beyond_slope = x12 * hang_cosine + x7
    beyond_moment = 2 * hang_sine * hang_spread - 2 * hang_cosine * hang_excess
    x13 = x12 * hang_sine
    beyond_slope_rate = 2 * hang_cosine * hang_odd - beyond_slope - x13
    beyond_moment_rate = 4 * hang_odd * hang_sine - beyond_moment
    x14 = 2 * hang_odd
    del hang_excess, hang_spread, hang_odd
    x15 = x7 * hang_sine
    x16 = x14 + x15
    end = x16
    x17 = x7 * hang_cosine + x12
    end_rate = x17 - end
    dot = before_moment * beyond_moment + before_slope * beyond_slope
    square = before_moment**2 + before_slope**2
    other = beyond_moment**2 + beyond_slope**2
    free = x4
    del x12, x7, x4
    x18 = end**2
    x19 = free / 4
    x20 = 1 / span_odd**2
    x21 = span_odd + x3
    x22 = x20 * x21 * span_excess
    size = xp.sqrt(x22 * place * dot**2 / 2 + x18 * x19 * square**2)
    x23 = 1 / size
    left_amplitude = x23 * dot
    right_amplitude = x23 * square
    del size, dot, x23
    x24 = right_amplitude**2
    x25 = x18 * x24
    x26 = x25 / 4
    x27 = left_amplitude**2
    x28 = x27 / 2
    x29 = x22 * x28
    rate = x26 - x29
    span_rate = x26 * beta
    x30 = span_excess * beta
    hang_rate = -x20 * x21 * x28 * x30
    ratio = x3 * x8
    x31 = 2 * span_fade
    ratio_rate = x10 * x20 * x31
    turn = (
        (-beyond_moment * beyond_moment_rate - beyond_slope * beyond_slope_rate) * hang_rate /
        other + span_rate * (before_moment * before_moment_rate + before_slope * before_slope_rate)
        / square
    )
    del span_excess, x3, before_moment, before_moment_rate, before_slope, before_slope_rate
    del beyond_moment, beyond_moment_rate, beyond_slope, beyond_slope_rate, other, square
    x32 = x19 * x24 * end * end_rate * hang_rate
    del end, end_rate, x19
    x33 = x22 * x27 / 4
    left_growth = (
        x27 * ratio * ratio_rate * span_rate * place / 2 - x26 * free * turn + x18 * x24 / 8 - x32
        - x33
    )
    del x22, free, x18, x24, x26, x27
    right_growth = (
        x28 * ratio * ratio_rate * span_rate * place + x29 * turn * place + x25 / 8 - x32 - x33
    )
    del ratio, ratio_rate, turn, x25, x28, x29, x32, x33
    x34 = x8 * left_amplitude
    root_slope = x30 * x34
    x35 = beta**3
    x36 = x34 * x35
    root_shear = -x21 * x36
    del x8, x30, x21
    x37 = left_amplitude * beta
    slope = x11 * x37
    x38 = beta**2
    moment = -x2 * x38 * left_amplitude
    shear = x36 * (-span_cosine * span_odd - span_even * span_sine)
    del x11, x2, span_cosine, span_odd, x36
    x39 = x14 * hang_sine
    shear_beyond = -x35 * x39 * right_amplitude
    reaction = shear_beyond - shear
    tip = x16 * right_amplitude
    x40 = right_amplitude * beta
    tip_slope = x17 * x40
    x41 = x20 * span_rate
    del hang_sine, x16, x20
    x42 = x41 * (2 * span_fade * span_sine * span_spread - x31 * x9)
    root_slope_drift = left_growth * root_slope + rate * root_slope + x37 * x42
    x43 = 3 * rate
    x44 = x35 * left_amplitude
    root_shear_drift = left_growth * root_shear + x43 * root_shear + x42 * x44
    del span_fade, x31, x42
    x45 = x41 * (span_even * span_sine * span_spread - x9 * span_even)
    del span_even, span_sine, span_spread, x41, x9
    slope_drift = left_growth * slope + rate * (moment * place + slope) + x37 * x45
    moment_drift = (
        left_growth * moment + rate * (2 * moment + shear * place) - x10 * x34 * x38 * span_rate
    )
    del x37, x10, x34, x38
    shear_drift = left_growth * shear + x43 * shear + x44 * x45
    x46 = hang_rate * right_amplitude
    shear_drift_beyond = (
        right_growth * shear_beyond + x43 * shear_beyond - x35 * x46 * (x14 * hang_cosine + x13 -
        x39)
    )
    del x44, x45, hang_cosine, shear_beyond, x13, x35, x39, x43
    reaction_drift = shear_drift_beyond - shear_drift
    x47 = x17 - x14
    del shear_drift_beyond, x14, x17
    tip_drift = right_growth * tip + x46 * (x47 - x15)
    tip_slope_drift = (-x15 - x47) * x40 * hang_rate + rate * tip_slope + right_growth * tip_slope
    del x46, x15, x40, x47
    return (
        left_amplitude, right_amplitude, left_growth, right_growth, rate, span_rate, hang_rate,
        root_slope, root_shear, slope, moment, shear, reaction, tip, tip_slope, root_slope_drift,
        root_shear_drift, slope_drift, moment_drift, shear_drift, reaction_drift, tip_drift,
        tip_slope_drift,
    )


def modes_before(beta, eta, place, left_amplitude):
    """Return modes up to the support and their derivatives along eta.

    beta, eta, place, left_amplitude : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    run = beta * eta
    run_square = run**2
    run_fourth = run_square**2
    run_sine = xp.sin(run)
    run_cosine = xp.cos(run)
    run_fade = xp.exp(-run)
    x1 = 2 * run
    run_odd = -xp.expm1(-x1)
    run_even = run_fade**2 + 1
    run_excess = (
        xp.where((run > 3 / 2), run_odd - 2 * run_fade * run_sine, x1 * run_fade * run_square *
        (run_fourth * (run_fourth * (run_fourth * (run_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del run_fourth, run_square, x1
    run_spread = 4 * run_fade * xp.sin(run / 2)**2 + xp.expm1(-run)**2
    span = beta * place
    span_square = span**2
    span_fourth = span_square**2
    span_sine = xp.sin(span)
    span_fade = xp.exp(-span)
    x2 = 2 * span
    span_odd = -xp.expm1(-x2)
    span_excess = (
        xp.where((span > 3 / 2), span_odd - 2 * span_fade * span_sine, x2 * span_fade * span_square
        * (span_fourth * (span_fourth * (span_fourth * (span_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del run, run_fade, span, span_fade, span_fourth, span_square, x2
    rise = xp.exp((eta - place) * beta)
    x3 = rise * span_sine
    x4 = left_amplitude / span_odd
    return (
        x4 * (run_sine * span_excess - x3 * run_excess),
        x4 * beta * (run_cosine * span_excess - x3 * run_spread),
        x4 * beta**2 * (-x3 * run_odd - run_sine * span_odd),
        x4 * beta**3 * (-run_cosine * span_odd - x3 * run_even),
    )


def drift_before(beta, eta, place, left_amplitude, left_growth, rate, span_rate):
    """Return the derivatives of modes up to the support along the support's place xi.

    beta to span_rate : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    x0 = beta * eta
    run = x0
    run_square = run**2
    run_fourth = run_square**2
    run_sine = xp.sin(run)
    run_cosine = xp.cos(run)
    run_fade = xp.exp(-run)
    x2 = 2 * run
    run_odd = -xp.expm1(-x2)
    run_even = run_fade**2 + 1
    run_excess = (
        xp.where((run > 3 / 2), run_odd - 2 * run_fade * run_sine, x2 * run_fade * run_square *
        (run_fourth * (run_fourth * (run_fourth * (run_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del run_fourth, run_square, x2
    run_spread = 4 * run_fade * xp.sin(run / 2)**2 + xp.expm1(-run)**2
    span = beta * place
    span_square = span**2
    span_fourth = span_square**2
    span_sine = xp.sin(span)
    span_cosine = xp.cos(span)
    span_fade = xp.exp(-span)
    x4 = 2 * span
    span_odd = -xp.expm1(-x4)
    span_excess = (
        xp.where((span > 3 / 2), span_odd - 2 * span_fade * span_sine, x4 * span_fade * span_square
        * (span_fourth * (span_fourth * (span_fourth * (span_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del run, run_fade, span_fourth, span_square, x4
    span_spread = 4 * span_fade * xp.sin(span / 2)**2 + xp.expm1(-span)**2
    rise = xp.exp((eta - place) * beta)
    x5 = rise * span_sine
    x6 = left_amplitude / span_odd
    x7 = x6 * left_growth
    x8 = (
        left_amplitude * rise * span_rate * (span_sine * span_spread - span_cosine * span_excess) /
        span_odd**2
    )
    del span, span_fade, rise, span_cosine, span_sine, span_spread
    x9 = x8 * run_odd
    x10 = run_cosine * span_excess - x5 * run_spread
    x11 = x10 * beta
    x12 = x6 * eta
    x13 = beta**2
    x14 = x13 * (-x5 * run_odd - run_sine * span_odd)
    return (
        x0 * x10 * x6 * rate + x7 * (run_sine * span_excess - x5 * run_excess) + x9,
        x8 * run_even * beta + rate * (x11 * x6 + x12 * x14) + x11 * x7,
        (
            rate * (x12 * beta**3 * (-run_cosine * span_odd - x5 * run_even) + 2 * x14 * x6) + x13
            * x9 + x14 * x7
        ),
    )


def modes_beyond(beta, eta, place, right_amplitude):
    """Return modes beyond the support and their derivatives along eta.

    beta, eta, place, right_amplitude : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    rest = beta * (1 - eta)
    rest_square = rest**2
    rest_fourth = rest_square**2
    rest_sine = xp.sin(rest)
    rest_cosine = xp.cos(rest)
    rest_fade = xp.exp(-rest)
    x1 = 2 * rest
    rest_odd = -xp.expm1(-x1)
    x2 = (rest > 3 / 2)
    rest_excess = (
        xp.where(x2, rest_odd - 2 * rest_fade * rest_sine, x1 * rest_fade * rest_square *
        (rest_fourth * (rest_fourth * (rest_fourth * (rest_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del rest_fourth, rest_odd, rest_square, x1
    x3 = xp.expm1(-rest)
    x4 = xp.sin(rest / 2)**2
    rest_spread = 4 * x4 * rest_fade + x3**2
    hang = beta * (1 - place)
    hang_square = hang**2
    hang_fourth = hang_square**2
    hang_sine = xp.sin(hang)
    hang_cosine = xp.cos(hang)
    hang_fade = xp.exp(-hang)
    x6 = 2 * hang
    hang_odd = -xp.expm1(-x6)
    x7 = hang_fade**2
    hang_even = x7 + 1
    hang_excess = (
        xp.where((hang > 3 / 2), hang_odd - 2 * hang_fade * hang_sine, x6 * hang_fade * hang_square
        * (hang_fourth * (hang_fourth * (hang_fourth * (hang_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del rest, hang_fourth, hang_square, x6
    x8 = 4 * hang_fade
    hang_spread = x8 * xp.sin(hang / 2)**2 + xp.expm1(-hang)**2
    x9 = beta * (eta - place)
    x10 = (x9 > 3 / 2)
    close = xp.where(x10, 3 / 2, x9)
    close_square = close**2
    close_fourth = close_square**2
    close_sine = xp.sin(close)
    close_fade = xp.exp(-close)
    x12 = 2 * close
    close_odd = -xp.expm1(-x12)
    x13 = 2 * close_sine
    close_excess = (
        xp.where((close > 3 / 2), close_odd - x13 * close_fade, x12 * close_fade * close_square *
        (close_fourth * (close_fourth * (close_fourth * (close_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del hang, close_sine, close_fourth, close_odd, close_square, x12
    close_spread = 4 * close_fade * xp.sin(close / 2)**2 + xp.expm1(-close)**2
    sink = xp.exp(-x9)
    x14 = rest_fade + rest_sine
    lean = xp.where(x2, x14 - rest_cosine, (rest_spread - rest_excess) / (2 * rest_fade))
    del close, x9, x2
    lean_slope = rest_sine - x3 - 2 * x4
    x16 = 4 * x7
    del x3, x4, x7
    x17 = x8 * hang_cosine
    x18 = rest_excess * sink
    x19 = rest_spread * sink
    x20 = x18 * hang_cosine + x19 * hang_fade - hang_sine * rest_spread * sink
    x21 = 1 / close_fade
    x22 = x21 * close_excess / 2
    del rest_spread, close_fade, close_excess
    x23 = 2 * hang_cosine
    x24 = x19 * hang_cosine + x18 * hang_fade - hang_sine * rest_excess * sink
    del hang_cosine, rest_excess, sink, x18, x19
    return (
        (
            right_amplitude * xp.where(x10, hang_even * (rest_cosine + rest_fade - rest_sine) + 4 *
            hang_fade * hang_sine * rest_cosine - x16 * rest_cosine - x17 * rest_sine - x20, x21 *
            close_spread * (2 * hang_sine * hang_spread - x23 * hang_excess) / 4 - x22 * hang_odd *
            hang_sine + (x13 + x22) * (x23 * hang_even + x8) / 2)
        ),
        ((rest_cosine + x14) * hang_even + x17 * rest_cosine + x24) * right_amplitude * beta,
        right_amplitude * beta**2 * (hang_even * lean - x20),
        (
            (x16 * rest_sine - hang_even * lean_slope - 4 * hang_fade * hang_sine * rest_sine +
            x24) * right_amplitude * beta**3
        ),
    )


def drift_beyond(beta, eta, place, right_amplitude, right_growth, rate, hang_rate):
    """Return the derivatives of modes beyond the support along the support's place xi.

    beta to hang_rate : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(beta)
    rest = beta * (1 - eta)
    rest_square = rest**2
    rest_fourth = rest_square**2
    rest_sine = xp.sin(rest)
    rest_cosine = xp.cos(rest)
    rest_fade = xp.exp(-rest)
    x1 = 2 * rest
    rest_odd = -xp.expm1(-x1)
    x2 = (rest > 3 / 2)
    rest_excess = (
        xp.where(x2, rest_odd - 2 * rest_fade * rest_sine, x1 * rest_fade * rest_square *
        (rest_fourth * (rest_fourth * (rest_fourth * (rest_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del rest_fourth, rest_odd, rest_square, x1
    x3 = xp.expm1(-rest)
    x4 = xp.sin(rest / 2)**2
    rest_spread = 4 * x4 * rest_fade + x3**2
    hang = beta * (1 - place)
    hang_square = hang**2
    hang_fourth = hang_square**2
    hang_sine = xp.sin(hang)
    hang_cosine = xp.cos(hang)
    hang_fade = xp.exp(-hang)
    x6 = 2 * hang
    hang_odd = -xp.expm1(-x6)
    x7 = hang_fade**2
    hang_even = x7 + 1
    hang_excess = (
        xp.where((hang > 3 / 2), hang_odd - 2 * hang_fade * hang_sine, x6 * hang_fade * hang_square
        * (hang_fourth * (hang_fourth * (hang_fourth * (hang_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del rest, hang_fourth, hang_square, x6
    x8 = 4 * hang_fade
    hang_spread = x8 * xp.sin(hang / 2)**2 + xp.expm1(-hang)**2
    x9 = beta * (eta - place)
    x10 = (x9 > 3 / 2)
    close = xp.where(x10, 3 / 2, x9)
    close_square = close**2
    close_fourth = close_square**2
    close_sine = xp.sin(close)
    close_fade = xp.exp(-close)
    x12 = 2 * close
    close_odd = -xp.expm1(-x12)
    x13 = 2 * close_sine
    close_excess = (
        xp.where((close > 3 / 2), close_odd - x13 * close_fade, x12 * close_fade * close_square *
        (close_fourth * (close_fourth * (close_fourth * (close_fourth / 60822550204416000 + 1 /
        653837184000) + 1 / 19958400) + 1 / 2520) + 1 / 3))
    )
    del hang, close_sine, close_fourth, close_odd, close_square, x12
    close_spread = 4 * close_fade * xp.sin(close / 2)**2 + xp.expm1(-close)**2
    sink = xp.exp(-x9)
    x14 = rest_fade + rest_sine
    lean = xp.where(x2, x14 - rest_cosine, (rest_spread - rest_excess) / (2 * rest_fade))
    del close, x9, x2
    lean_slope = rest_sine - x3 - 2 * x4
    x16 = x8 * rest_cosine
    x17 = x16 * hang_cosine
    x18 = 4 * x7
    del x3, x4, x7
    x19 = x18 * rest_sine
    x20 = x8 * rest_sine
    x23 = rest_spread * sink
    x24 = x23 * hang_sine
    x21 = rest_excess * sink
    del rest_spread, rest_excess, sink
    x25 = x21 * hang_cosine + x23 * hang_fade
    x26 = x25 - x24
    x22 = x21 * hang_sine
    x27 = x23 * hang_cosine + x21 * hang_fade
    x28 = x22 + x26 + x27
    x29 = x18 * rest_cosine
    del x21, x23, x18
    x30 = x16 * hang_sine
    x31 = x20 * hang_cosine + x29 - x30
    x32 = hang_rate * right_amplitude
    x33 = x27 - x22
    del x16, x22, x27
    x34 = x17 + x33
    x35 = right_amplitude * beta
    x36 = x35 * (hang_even * (-rest_cosine - x14) - x34)
    x37 = 1 / close_fade
    x38 = x37 * close_excess / 2
    del x14, close_fade, close_excess
    x39 = 2 * hang_cosine
    x40 = right_amplitude * right_growth
    x41 = beta**2
    x42 = hang_even * lean - x26
    x43 = x41 * x42
    x44 = x43 * right_amplitude
    x45 = (
        right_amplitude * beta**3 * (hang_even * lean_slope + 4 * hang_fade * hang_sine * rest_sine
        - x19 - x33)
    )
    del hang_cosine, lean, hang_fade, lean_slope, x33
    return (
        (
            rate * (x36 - x36 * eta) + x32 * (x20 * hang_sine + x17 + x19 + x28 + x31) + x40 *
            xp.where(x10, hang_even * (rest_cosine + rest_fade - rest_sine) - x26 - x31, x37 *
            close_spread * (2 * hang_sine * hang_spread - x39 * hang_excess) / 4 - x38 * hang_odd *
            hang_sine + (x13 + x38) * (x39 * hang_even + x8) / 2)
        ),
        (
            (-x24 - x25 - x29 - x30 - x34) * x35 * hang_rate + rate * (x41 * x42 * right_amplitude
            * eta - x36 - x44) - x36 * right_growth
        ),
        rate * (2 * x44 - x45 * eta + x45) + x28 * x32 * x41 + x40 * x43,
    )


def pair_integrals(
    place, beta_1, slope_1, moment_1, reaction_1, tip_1, slope_drift_1, reaction_drift_1, beta_2,
    slope_2, moment_2, reaction_2, tip_2, slope_drift_2, reaction_drift_2,
):
    """Return integrals over two different modes.

    place to reaction_drift_2 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    gap = (beta_1 + beta_2) * (beta_1 - beta_2) * (beta_1**2 + beta_2**2)
    x0 = 1 / gap
    x1 = reaction_1 * slope_2
    x2 = reaction_2 * slope_1
    x3 = x1 + x2
    x4 = reaction_1 * slope_drift_2 + reaction_drift_2 * slope_1
    x5 = reaction_1 * slope_1
    x6 = reaction_2 * slope_2
    x7 = 1 / gap**2
    x8 = 2 * x3 * x7
    x9 = beta_1**4
    x10 = x2 * x9
    x11 = beta_2**4
    x12 = x1 * x11
    x13 = moment_1 * reaction_2
    x14 = moment_2 * reaction_1
    x15 = 3 * place
    return (
        x0 * x3,
        x0 * (reaction_2 * slope_drift_1 + reaction_drift_1 * slope_2 - x4) + x8 * (x5 + x6),
        x0 * (x10 + x12),
        (
            x0 * (place + 1) * (place - 1) * (x13 - x14) / 2 + x7 * (-4 * x11 * x9 * tip_1 * tip_2
            - x1 * x9 * place - x11 * x2 * place - x10 * x15 - x12 * x15)
        ),
        (
            x0 * (reaction_2 * slope_drift_1 + reaction_drift_1 * slope_2 + x13 + x14 + x4) + x8 *
            (x5 - x6)
        ),
    )


def own_integrals(
    place, beta, root_shear, slope, moment, shear, reaction, tip, tip_slope, slope_drift,
    moment_drift, reaction_drift, tip_drift, tip_slope_drift, rate,
):
    """Return integrals over one mode, and over one mode and itself.

    place to rate : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = rate / 4
    x1 = rate**2
    x2 = tip**2
    x3 = tip_slope**2 / 12
    x4 = 1 / beta**4
    x5 = reaction / 4
    x6 = reaction * slope
    x7 = moment * reaction
    x8 = reaction**2
    x9 = x8 * place
    x10 = reaction * place
    x11 = place / 2
    x12 = place**2
    x13 = x0 * x12
    x14 = x5 * shear
    x15 = place**3
    return (
        (
            x0 * tip * tip_slope_drift - x1 * tip * tip_slope / 4 + tip_drift**2 / 4 - x0 *
            tip_drift * tip_slope - x1 * x2 + x1 * x3 + x4 * (x1 * x12 * moment * reaction / 4 -
            x13 * moment * reaction_drift + moment_drift * reaction * place / 2 + x12 *
            moment_drift * rate * reaction / 4 - x7 * rate * place + reaction_drift * slope_drift *
            place / 2 - x11 * rate * reaction_drift * slope - 3 * x10 * rate * slope_drift / 2 -
            x12 * x14 * rate - 17 * x6 * rate / 4 - x1 * x15 * reaction * shear / 6 + 3 *
            reaction_drift * slope / 4 - x5 * slope_drift - x1 * x11 * x6 - x1 * x15 * x8 / 12 -
            x13 * x8 - x9 / 4)
        ),
        -x6,
        (
            5 * x2 / 16 + x3 + x4 * (moment * reaction / 8 - x14 * place - x6 * place / 8 + x15 *
            reaction * shear / 12 - x12 * x7 / 8 + x15 * x8 / 24 - x9 / 8)
        ),
        -x10 * x4, x4 * (-reaction - root_shear),
    )
