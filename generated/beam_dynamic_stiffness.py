"""Exact dynamic stiffness of a uniform beam.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam, formulation dynamic_stiffness.
Equations: Aannaque (5.1)-(5.19); Aannaque (B.1)-(B.17).

Forces and displacements in the order deflection and rotation of the left end, of the right end:
rows (F6, -F4, F5, F3), (-F4, F2, -F3, F1), (F5, -F3, F6, F4), (F3, F1, F4, F2); along the beam
(F7, F8), (F8, F7).  Nothing overflows and nothing cancels, from z = 1e-30 on.  A complex z (a
section that loses energy) is welcome in bending and bending_rates.

Cost per evaluation:
    bending: 113 operations
    bending_rates: 252 operations
    bending_inertias: 230 operations
    axial: 5 operations
    axial_rates: 57 operations
    axial_inertias: 47 operations
    bending_poles: 48 operations
    axial_poles: 12 operations
    bending_shapes: 506 operations
    axial_shapes: 8 operations
Content hash 042425bc4eef3f29b82e118ec81036da; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "bending", "bending_rates", "bending_inertias", "axial", "axial_rates", "axial_inertias",
    "bending_poles", "axial_poles", "bending_shapes", "axial_shapes",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"dynamic_stiffness","mechanism":"beam","'
    'modes":null,"outputs":[]}'
)
CONTENT = "042425bc4eef3f29b82e118ec81036da"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "z": (
        "",
        "Length over wave length in bending, lambda L: z^4 = omega^2 rho A L^4 / (E I); above 0",
    ),
    "F1": ("", "Moment at one end over rotation of the other [E I / L]"),
    "F2": ("", "Moment over rotation of the same end [E I / L]"),
    "F3": ("", "Moment at the right end over deflection of the left [E I / L^2]"),
    "F4": ("", "Moment over deflection of the right end [E I / L^2]"),
    "F5": ("", "Force at one end over deflection of the other [E I / L^3]"),
    "F6": ("", "Force over deflection of the same end [E I / L^3]"),
    "G1": ("", "-dF1/d(z^4): in units of mass, rho A L times L^n"),
    "G2": ("", "-dF2/d(z^4): in units of mass, rho A L times L^n"),
    "G3": ("", "-dF3/d(z^4): in units of mass, rho A L times L^n"),
    "G4": ("", "-dF4/d(z^4): in units of mass, rho A L times L^n"),
    "G5": ("", "-dF5/d(z^4): in units of mass, rho A L times L^n"),
    "G6": ("", "-dF6/d(z^4): in units of mass, rho A L times L^n"),
    "H1": ("", "(F1(0) - F1) / z^4: in units of mass, as G1"),
    "H2": ("", "(F2(0) - F2) / z^4: in units of mass, as G2"),
    "H3": ("", "(F3(0) - F3) / z^4: in units of mass, as G3"),
    "H4": ("", "(F4(0) - F4) / z^4: in units of mass, as G4"),
    "H5": ("", "(F5(0) - F5) / z^4: in units of mass, as G5"),
    "H6": ("", "(F6(0) - F6) / z^4: in units of mass, as G6"),
    "b": ("", "The same along the beam, beta L: b^2 = omega^2 rho L^2 / E; above 0"),
    "F7": ("", "Force along the beam over displacement of the same end [E A / L]"),
    "F8": ("", "Force along the beam at one end over displacement of the other [E A / L]"),
    "G7": ("", "-dF7/d(b^2): in units of the mass rho A L"),
    "G8": ("", "-dF8/d(b^2): in units of the mass rho A L"),
    "H7": ("", "(F7(0) - F7) / b^2: in units of the mass rho A L"),
    "H8": ("", "(F8(0) - F8) / b^2: in units of the mass rho A L"),
    "bending_count": ("", "Whole number, as a float"),
    "axial_count": ("", "Whole number, as a float"),
    "xi": ("", "Place along the beam from its left end, in lengths: from 0 to 1"),
    "deflection_value": ("", "Deflection for a unit deflection of the right end"),
    "deflection_slope": (
        "", "Deflection for a unit deflection of the right end, its slope along xi",
    ),
    "deflection_curvature": (
        "", "Deflection for a unit deflection of the right end, its curvature along xi",
    ),
    "deflection_third": (
        "", "Deflection for a unit deflection of the right end, its third along xi",
    ),
    "rotation_value": ("", "Deflection for a unit slope by xi at the right end"),
    "rotation_slope": (
        "", "Deflection for a unit slope by xi at the right end, its slope along xi",
    ),
    "rotation_curvature": (
        "", "Deflection for a unit slope by xi at the right end, its curvature along xi",
    ),
    "rotation_third": (
        "", "Deflection for a unit slope by xi at the right end, its third along xi",
    ),
    "stretch_value": ("", "Displacement for a unit one of the right end"),
    "stretch_slope": ("", "Displacement for a unit one of the right end, its slope along xi"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "bending": ("F1", "F2", "F3", "F4", "F5", "F6"),
    "bending_rates": ("G1", "G2", "G3", "G4", "G5", "G6"),
    "bending_inertias": ("H1", "H2", "H3", "H4", "H5", "H6"),
    "axial": ("F7", "F8"),
    "axial_rates": ("G7", "G8"),
    "axial_inertias": ("H7", "H8"),
    "bending_poles": ("bending_count",),
    "axial_poles": ("axial_count",),
    "bending_shapes": (
        "deflection_value", "deflection_slope", "deflection_curvature", "deflection_third",
        "rotation_value", "rotation_slope", "rotation_curvature", "rotation_third",
    ),
    "axial_shapes": ("stretch_value", "stretch_slope"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def bending(z):
    """Return the frequency functions of bending.

    z : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(z)
    x0 = z**2
    full_square = x0
    full_fourth = full_square**2
    full_sine = xp.sin(z)
    full_cosine = xp.cos(z)
    full_fade = xp.exp(-z)
    x2 = 2 * z
    full_odd = -xp.expm1(-x2)
    full_even = full_fade**2 + 1
    x3 = 2 * full_fade
    x4 = x3 * full_sine
    x5 = (z > 3 / 2)
    full_excess = (
        xp.where(x5, full_odd - x4, x2 * full_fade * full_square * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth / 60822550204416000 + 1 / 653837184000) + 1 / 19958400) + 1 /
        2520) + 1 / 3))
    )
    x6 = z / 2
    full_spread = 4 * full_fade * xp.sin(x6)**2 + xp.expm1(-z)**2
    del full_square, x2, full_fade
    x7 = full_cosine * full_odd
    x8 = z**3
    full_lag = (
        xp.where(x5, full_even * full_sine - x7, x3 * x8 * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        full_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del full_cosine, full_fourth, x3, x5
    part = x6
    part_square = part**2
    part_fourth = part_square**2
    part_sine = xp.sin(part)
    part_cosine = xp.cos(part)
    part_fade = xp.exp(-part)
    part_odd = -xp.expm1(-2 * part)
    part_even = part_fade**2 + 1
    x9 = part_cosine * part_odd
    del x6, part_square, part_cosine, part_odd
    x10 = part_even * part_sine
    part_lag = (
        xp.where((part > 3 / 2), x10 - x9, 2 * part_fade * part**3 * (part_fourth * (part_fourth *
        (part_fourth * (part_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        part_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del part_even, part_sine, part, part_fade, part_fourth
    divisor = (x10 + x9) * part_lag
    del part_lag, x10, x9
    x11 = 1 / divisor
    x12 = x11 * z
    x13 = x0 * x11
    return (
        x12 * full_excess, x12 * full_lag, x13 * full_spread, -x13 * full_odd * full_sine,
        x11 * (-x8 * full_odd - x4 * x8), x11 * (x8 * full_even * full_sine + x7 * x8),
    )


def bending_rates(z):
    """Return minus the rates of F1 to F6 with the squared frequency z^4.

    z : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(z)
    x0 = z**2
    full_square = x0
    full_fourth = full_square**2
    full_sine = xp.sin(z)
    full_cosine = xp.cos(z)
    full_fade = xp.exp(-z)
    x2 = 2 * z
    full_odd = -xp.expm1(-x2)
    x3 = full_fade**2
    full_even = x3 + 1
    x4 = 2 * full_fade
    x5 = x4 * full_sine
    x6 = (z > 3 / 2)
    full_excess = (
        xp.where(x6, full_odd - x5, x2 * full_fade * full_square * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth / 60822550204416000 + 1 / 653837184000) + 1 / 19958400) + 1 /
        2520) + 1 / 3))
    )
    x7 = z / 2
    full_spread = 4 * full_fade * xp.sin(x7)**2 + xp.expm1(-z)**2
    del full_square, x2, full_fade
    x8 = full_cosine * full_odd
    x9 = z**3
    full_lag = (
        xp.where(x6, full_even * full_sine - x8, x4 * x9 * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        full_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del full_cosine, full_fourth, x4, x6
    part = x7
    part_square = part**2
    part_fourth = part_square**2
    part_sine = xp.sin(part)
    part_cosine = xp.cos(part)
    part_fade = xp.exp(-part)
    part_odd = -xp.expm1(-2 * part)
    part_even = part_fade**2 + 1
    x10 = part_cosine * part_odd
    del x7, part_square, part_cosine, part_odd
    x11 = part_even * part_sine
    part_lag = (
        xp.where((part > 3 / 2), x11 - x10, 2 * part_fade * part**3 * (part_fourth * (part_fourth *
        (part_fourth * (part_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        part_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del part_even, part_sine, part, part_fade, part_fourth
    divisor = (x10 + x11) * part_lag
    del part_lag, x10, x11
    x12 = 1 / divisor
    x13 = x12 * z
    F1 = x13 * full_excess
    F2 = x13 * full_lag
    del full_excess, full_lag, x13
    x14 = x0 * x12
    F3 = x14 * full_spread
    F4 = -x14 * full_odd * full_sine
    del x0, full_spread, x14
    F5 = x12 * (-x9 * full_odd - x5 * x9)
    F6 = x12 * (x9 * full_even * full_sine + x8 * x9)
    del full_odd, x5, full_even, full_sine, x12, x8, x9
    squared = z**4
    x15 = 0.25 / squared
    x16 = (z > 3)
    x17 = 16 * x3 * squared**2 / divisor**2
    return (
        (
            xp.where(x16, x15 * (F1 * F2 - F1 - F3), x17 * (squared * (squared * (squared *
            (squared * (squared * (squared * (-2.0548142442844968e-33 * squared -
            1.8005135167445779e-29) + 6.883785612312857e-24) - 7.695617105298339e-20) -
            1.986653517934213e-15) + 1.4975695641480474e-11) + 1.8093189389485687e-08) -
            4.96031746031746e-05))
        ),
        (
            xp.where(x16, x15 * (F1**2 - F2), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (squared * (9.541832112181293e-36 * squared -
            4.415432142042188e-31) + 1.3623534226497048e-26) - 2.6718387055347685e-22) +
            3.1655041652350515e-18) - 2.0543758940135468e-14) + 7.137352816365162e-11) -
            8.907416314823723e-08) + 6.613756613756614e-05))
        ),
        (
            xp.where(x16, x15 * (-2 * F3 - F1 * F4), x17 * (squared * (squared * (squared *
            (squared * (squared * (squared * (6.5097610477289365e-28 - 3.6917649890414174e-32 *
            squared) + 7.75662514423695e-23) - 1.4909765218441706e-18) - 1.2072981506720998e-14) +
            1.3541852441764257e-10) + 2.08767569878681e-08) - 0.00021494708994708995))
        ),
        (
            xp.where(x16, x15 * (-2 * F4 - F1 * F3), x17 * (squared * (squared * (squared *
            (squared * (squared * (squared * (squared * (8.610092676982267e-30 -
            2.051493904118978e-34 * squared) - 2.384118489636983e-25) + 4.141349993578891e-21) -
            4.273430623067319e-17) + 2.362532278115579e-13) - 6.780485175546904e-10) +
            6.680562236117792e-07) - 0.00036375661375661375))
        ),
        (
            xp.where(x16, x15 * (F3 * F4 - 3 * F5), x17 * (squared * (squared * (squared * (squared
            * (squared * (squared * (5.47825699172011e-31 * squared - 2.0966847551168006e-26) -
            6.898707927581399e-22) + 2.0677137315788984e-17) + 3.833117802795993e-14) -
            1.0449849239531779e-09) + 3.2567740901074235e-07) + 0.0008928571428571428))
        ),
        (
            xp.where(x16, x15 * (F3**2 - 3 * F6), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (squared * (squared * (6.46216676739527e-33 -
            1.1565581359885352e-37 * squared) - 2.4539294610554336e-28) + 6.079038431162972e-24) -
            9.320504046223947e-20) + 8.325751275318753e-16) - 3.909707817261742e-12) +
            9.07259505143103e-09) - 7.215007215007215e-06) + 0.0025793650793650793))
        ),
    )


def bending_inertias(z):
    """Return what takes F1 to F6 from their static values, over z^4.

    z : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(z)
    x0 = z**2
    full_square = x0
    full_fourth = full_square**2
    full_sine = xp.sin(z)
    full_cosine = xp.cos(z)
    full_fade = xp.exp(-z)
    x2 = 2 * z
    full_odd = -xp.expm1(-x2)
    full_even = full_fade**2 + 1
    x3 = 2 * full_fade
    x4 = x3 * full_sine
    x5 = (z > 3 / 2)
    full_excess = (
        xp.where(x5, full_odd - x4, x2 * full_fade * full_square * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth / 60822550204416000 + 1 / 653837184000) + 1 / 19958400) + 1 /
        2520) + 1 / 3))
    )
    x6 = z / 2
    x7 = 4 * full_fade
    del full_square, x2, full_fade
    full_spread = x7 * xp.sin(x6)**2 + xp.expm1(-z)**2
    x8 = full_cosine * full_odd
    x9 = z**3
    full_lag = (
        xp.where(x5, full_even * full_sine - x8, x3 * x9 * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        full_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del full_cosine, full_fourth, x3, x5
    part = x6
    part_square = part**2
    part_fourth = part_square**2
    part_sine = xp.sin(part)
    part_cosine = xp.cos(part)
    part_fade = xp.exp(-part)
    part_odd = -xp.expm1(-2 * part)
    part_even = part_fade**2 + 1
    x10 = part_cosine * part_odd
    del x6, part_square, part_cosine, part_odd
    x11 = part_even * part_sine
    part_lag = (
        xp.where((part > 3 / 2), x11 - x10, 2 * part_fade * part**3 * (part_fourth * (part_fourth *
        (part_fourth * (part_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        part_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del part_even, part_sine, part, part_fade, part_fourth
    divisor = (x10 + x11) * part_lag
    del part_lag, x10, x11
    x12 = 1 / divisor
    x13 = x12 * z
    F1 = x13 * full_excess
    F2 = x13 * full_lag
    del divisor, full_excess, full_lag, x13
    x14 = x0 * x12
    F3 = x14 * full_spread
    F4 = -x14 * full_odd * full_sine
    del x0, full_spread, x14
    F5 = x12 * (-x9 * full_odd - x4 * x9)
    F6 = x12 * (x9 * full_even * full_sine + x8 * x9)
    del full_odd, x4, full_even, full_sine, x8, x9
    squared = z**4
    x15 = 1 / squared
    x16 = (z > 4)
    x17 = x12 * x7 * squared
    return (
        (
            xp.where(x16, x15 * (2 - F1), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (7.046040375558577e-37 * squared - 2.4918402101431583e-31) +
            5.364586836151427e-26) - 6.6403587929160076e-21) + 4.1267588938054134e-16) -
            1.3000178344093688e-11) + 1.0855913633691412e-07) - 0.0005952380952380953))
        ),
        (
            xp.where(x16, x15 * (4 - F2), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (3.486873719142247e-30 - 1.1275213015767104e-35 * squared) -
            6.448524631218267e-25) + 6.601677091209701e-20) - 3.3671721970173254e-15) +
            7.341277182547023e-11) - 5.344449788894234e-07) + 0.0007936507936507937))
        ),
        (
            xp.where(x16, x15 * (6 - F3), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (2.1107152829208108e-36 * squared - 7.509572131592974e-31) +
            1.5873351951723187e-25) - 2.069471041287416e-20) + 1.1064975041956348e-15) -
            4.8177131510464846e-11) + 1.252605419272086e-07) - 0.0025793650793650793))
        ),
        (
            xp.where(x16, x15 * (-6 - F4), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (2.1986665380745853e-34 * squared - 6.102029008498931e-29) +
            9.995213178388313e-24) - 8.912264073133096e-19) + 3.8722480265699245e-14) -
            6.974213323419673e-10) + 4.008337341670675e-06) - 0.004365079365079365))
        ),
        (
            xp.where(x16, x15 * (-12 - F5), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (1.60747407992544e-30 - 4.1130415247049443e-36 * squared) -
            2.5795672871706863e-25) + 5.918300361064946e-20) + 2.8607810658252667e-16) +
            2.340032101936864e-10) + 1.954064454064454e-06) + 0.010714285714285714))
        ),
        (
            xp.where(x16, x15 * (12 - F6), x17 * (squared * (squared * (squared * (squared *
            (squared * (squared * (squared * (1.9038257013847919e-38 * squared -
            7.543117507548193e-33) + 1.851529944864533e-27) - 2.6374465741682713e-22) +
            2.0003081586365392e-17) - 7.172076779646903e-13) + 1.0204375283740363e-08) -
            4.329004329004329e-05) + 0.030952380952380953))
        ),
    )


def axial(b):
    """Return the frequency functions of the motion along the beam.

    b : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(b)
    sine = xp.sin(b)
    cosine = xp.cos(b)
    x0 = b / sine
    return x0 * cosine, -x0


def axial_rates(b):
    """Return minus the rates of F7 and F8 with the squared frequency b^2.

    b : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(b)
    x0 = b**2
    square = x0
    sine = xp.sin(b)
    cosine = xp.cos(b)
    x1 = b / 2
    x2 = 1 / sine**2
    x3 = x2 / b
    x4 = (b > 1)
    x5 = x0 * x2
    return (
        (
            xp.where(x4, x3 * (x1 - cosine * sine / 2), x5 * (square * (square * (square * (square
            * (square * (square * (square * (square * (square * (8.11214080967848e-17 * square -
            1.0261858124243278e-14) + 1.0774951030455441e-12) - 9.212583131039402e-11) +
            6.264556529106794e-09) - 3.2888921777810664e-07) + 1.282667949334616e-05) -
            0.0003527336860670194) + 0.006349206349206349) - 0.06666666666666667) +
            0.3333333333333333))
        ),
        (
            xp.where(x4, x3 * (sine / 2 - x1 * cosine), x5 * (square * (square * (square * (square
            * (square * (square * (square * (7.398571721961897e-17 * square -
            2.2491658034764165e-14) + 5.353014612273871e-12) - 9.635426302092969e-10) +
            1.252605419272086e-07) - 1.1022927689594357e-05) + 0.0005952380952380953) -
            0.016666666666666666) + 0.16666666666666666))
        ),
    )


def axial_inertias(b):
    """Return what takes F7 and F8 from their static values, over b^2.

    b : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(b)
    square = b**2
    sine = xp.sin(b)
    cosine = xp.cos(b)
    x0 = 1 / square
    x1 = b / sine
    x2 = (b > 1)
    return (
        (
            xp.where(x2, x0 * (1 - x1 * cosine), x1 * (square * (square * (square * (square *
            (square * (square * (square * (1.4797143443923793e-16 * square - 4.498331606952833e-14)
            + 1.0706029224547743e-11) - 1.9270852604185937e-09) + 2.505210838544172e-07) -
            2.2045855379188714e-05) + 0.0011904761904761906) - 0.03333333333333333) +
            0.3333333333333333))
        ),
        (
            xp.where(x2, x0 * (x1 - 1), x1 * (square * (square * (square * (square * (square *
            (square * (square * (8.22063524662433e-18 * square - 2.8114572543455206e-15) +
            7.647163731819816e-13) - 1.6059043836821613e-10) + 2.505210838544172e-08) -
            2.7557319223985893e-06) + 0.0001984126984126984) - 0.008333333333333333) +
            0.16666666666666666))
        ),
    )


def bending_poles(z):
    """Return how many bending frequencies of the beam with held ends lie below z.

    z : ndarray, shape (...)
    Returns ndarray, shape (...).
    """
    xp = _namespace(z)
    part = z / 2
    part_square = part**2
    part_fourth = part_square**2
    part_sine = xp.sin(part)
    part_cosine = xp.cos(part)
    part_fade = xp.exp(-part)
    part_odd = -xp.expm1(-2 * part)
    part_even = part_fade**2 + 1
    x0 = part_cosine * part_odd
    del part_square, part_cosine, part_odd
    x1 = part_even * part_sine
    part_lag = (
        xp.where((part > 3 / 2), x1 - x0, 2 * part_fade * part**3 * (part_fourth * (part_fourth *
        (part_fourth * (part_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        part_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del part_even, part_sine, part, part_fade, part_fourth
    divisor = (x0 + x1) * part_lag
    del part_lag, x0, x1
    whole = xp.floor(0.3183098861837907 * z)
    turned = 1 - 2 * (whole % 2)
    return turned * (-1 + 2 * xp.asarray((divisor > 0), dtype=xp.float64)) / 2 + whole - 1 / 2


def axial_poles(b):
    """Return how many axial frequencies of the beam with held ends lie below b.

    b : ndarray, shape (...)
    Returns ndarray, shape (...).
    """
    xp = _namespace(b)
    nearest = xp.floor(0.3183098861837907 * b + 1 / 2)
    turned = 1 - 2 * (nearest % 2)
    short = -turned * xp.sin(b)
    return nearest - xp.asarray((short > 0), dtype=xp.float64)


def bending_shapes(z, xi):
    """Return the deflection between the ends for unit displacements of the right end.

    z, xi : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(z)
    x0 = z**2
    full_square = x0
    full_fourth = full_square**2
    full_sine = xp.sin(z)
    full_cosine = xp.cos(z)
    full_fade = xp.exp(-z)
    x2 = 2 * z
    full_odd = -xp.expm1(-x2)
    full_even = full_fade**2 + 1
    x3 = 2 * full_fade
    x4 = x3 * full_sine
    x5 = (z > 3 / 2)
    full_excess = (
        xp.where(x5, full_odd - x4, x2 * full_fade * full_square * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth / 60822550204416000 + 1 / 653837184000) + 1 / 19958400) + 1 /
        2520) + 1 / 3))
    )
    x6 = z / 2
    full_spread = 4 * full_fade * xp.sin(x6)**2 + xp.expm1(-z)**2
    del full_square, x2, full_fade
    x7 = full_cosine * full_odd
    x8 = z**3
    full_lag = (
        xp.where(x5, full_even * full_sine - x7, x3 * x8 * (full_fourth * (full_fourth *
        (full_fourth * (full_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        full_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del full_cosine, full_fourth, x3, x5
    part = x6
    part_square = part**2
    part_fourth = part_square**2
    part_sine = xp.sin(part)
    part_cosine = xp.cos(part)
    part_fade = xp.exp(-part)
    part_odd = -xp.expm1(-2 * part)
    part_even = part_fade**2 + 1
    x9 = part_cosine * part_odd
    del part_square, part_cosine, part_odd
    x10 = part_even * part_sine
    part_lag = (
        xp.where((part > 3 / 2), x10 - x9, 2 * part_fade * part**3 * (part_fourth * (part_fourth *
        (part_fourth * (part_fourth * (8.417930492543313e-15 - 1.5844025018903282e-19 *
        part_fourth) - 1.957673915345873e-10) + 1.60333493666827e-06) - 0.0031746031746031746) +
        0.6666666666666666))
    )
    del part_even, part_sine, part, part_fade, part_fourth
    divisor = (x10 + x9) * part_lag
    del part_lag, x10, x9
    x11 = 1 / divisor
    x12 = x11 * z
    F1 = x12 * full_excess
    F2 = x12 * full_lag
    del divisor, full_excess, full_lag, x12
    x13 = x0 * x11
    F3 = x13 * full_spread
    F4 = -x13 * full_odd * full_sine
    F5 = x11 * (-x8 * full_odd - x4 * x8)
    del full_spread, x13, full_odd, x4
    F6 = x11 * (x8 * full_even * full_sine + x7 * x8)
    del full_even, full_sine, x11, x7
    squared = z**4
    rest = 1 - xi
    phase_right = rest * z
    phase_left = xi * z
    nearer = phase_left - phase_right
    fourth_right = phase_right**4
    fourth_left = phase_left**4
    fade_right = xp.exp(-phase_right)
    fade_left = xp.exp(-phase_left)
    swing_right = xp.cos(phase_right)
    swing_left = xp.cos(phase_left)
    turn_right = xp.sin(phase_right)
    turn_left = xp.sin(phase_left)
    x15 = swing_right / 2
    x16 = 1 / x0
    x17 = x15 * F4
    x18 = x16 * x17
    x19 = 1 / x8
    x20 = turn_right / 2
    x21 = x19 * x20
    x22 = fade_left / 4
    x23 = x22 * F5
    x24 = x19 * x23
    x25 = fade_right / 4
    x26 = x25 * F6
    x27 = x19 * x26
    x28 = x25 * F4
    x29 = x16 * x28
    x30 = x22 * F3
    x31 = x16 * x30 + x25
    x32 = (phase_right > 1)
    x33 = rest**2
    x34 = (
        fourth_right * (fourth_right * (fourth_right * (fourth_right / 6402373705728000 + 1 /
        87178291200) + 1 / 3628800) + 1 / 720) + 1 / 2
    )
    x35 = x33 * x34
    x36 = x35 * F4
    x37 = (
        rest**3 * (fourth_right * (fourth_right * (fourth_right * (fourth_right /
        121645100408832000 + 1 / 1307674368000) + 1 / 39916800) + 1 / 5040) + 1 / 6)
    )
    x38 = (
        fourth_right * (fourth_right * (fourth_right / 20922789888000 + 1 / 479001600) + 1 / 40320)
        + 1 / 24
    )
    x39 = x38 * fourth_right + 1
    x40 = (nearer > 0)
    del swing_right, phase_right, nearer
    x41 = swing_left / 2
    x42 = x41 * F3
    x43 = x16 * x42
    x45 = turn_left / 2
    x46 = x45 * F5
    x47 = (phase_left > 1)
    x48 = xi**2
    x49 = (
        fourth_left * (fourth_left * (fourth_left * (fourth_left / 6402373705728000 + 1 /
        87178291200) + 1 / 3628800) + 1 / 720) + 1 / 2
    )
    x50 = x48 * x49
    x51 = xi**3
    x52 = (
        fourth_left * (fourth_left * (fourth_left * (fourth_left / 121645100408832000 + 1 /
        1307674368000) + 1 / 39916800) + 1 / 5040) + 1 / 6
    )
    x53 = x51 * x52
    x54 = x6 * turn_right
    x55 = x15 * F6
    x56 = 1 / z
    x57 = x20 * x56
    x58 = x57 * F4
    x59 = x28 * x56
    x60 = x25 * z
    x61 = x30 * x56
    x62 = x60 - x61
    x63 = x16 * x23 - x16 * x26 + x59 + x62
    x64 = (
        rest * (fourth_right * (fourth_right * (fourth_right * (fourth_right / 355687428096000 + 1
        / 6227020800) + 1 / 362880) + 1 / 120) + 1)
    )
    x65 = x64 * F4
    x66 = x37 * squared
    x67 = x45 * F3
    x68 = x41 * F5
    x69 = (
        fourth_left * (fourth_left * (fourth_left * (fourth_left / 355687428096000 + 1 /
        6227020800) + 1 / 362880) + 1 / 120) + 1
    )
    x70 = x69 * xi
    x71 = x28 - x23 * x56 - x26 * x56
    x72 = x0 * x25 + x30
    x73 = x72 - x0 * x15
    del phase_left, rest, x0
    x74 = x39 * F4
    x75 = x42 + x72
    x76 = (
        fourth_left * (fourth_left * (fourth_left * (fourth_left / 20922789888000 + 1 / 479001600)
        + 1 / 40320) + 1 / 24) + 1
    )
    del x42, x72, fourth_left
    x77 = x30 * z
    x78 = x6 * turn_left
    x79 = x15 * F2
    x80 = x22 * F1
    x81 = x16 * x80 - x16 * F2 * fade_right / 4 - x56 * fade_right / 4 + x19 * x28 + x19 * x30
    del x6, x22, x30
    x82 = x25 * x56 * F2 - x29 + x31 + x56 * x80
    x83 = x60 * F2 - x28 + x80 * z
    return (
        (
            xp.where(x40, xp.where(x32, x15 - x21 * F6 - x18 - x24 - x27 + x29 + x31, x37 * F6 +
            x36 + x39), xp.where(x47, x16 * F3 * fade_left / 4 + fade_right / 4 - x19 * x46 - x24 -
            x27 + x29 - x43, x50 * F3 + x53 * F5))
        ),
        (
            xp.where(x40, xp.where(x32, x16 * x55 + x54 - x58 + x63, -x35 * F6 - x65 - x66),
            xp.where(x47, x56 * x67 - x16 * x68 + x63, x70 * F3 + x50 * F5))
        ),
        (
            xp.where(x40, xp.where(x32, x57 * F6 + x17 + x71 + x73, x64 * F6 + x35 * squared +
            x74), xp.where(x47, x46 * x56 + x71 + x75, x76 * F3 + x70 * F5))
        ),
        (
            xp.where(x40, xp.where(x32, F4 * fade_right * z / 4 + F4 * turn_right * z / 2 + F5 *
            fade_left / 4 + x8 * fade_right / 4 - x20 * x8 - x26 - x55 - x77, -x66 * F4 - x39 * F6
            - x64 * squared), xp.where(x47, x60 * F4 - x78 * F3 + x23 + x25 * x8 - x26 + x68 - x77,
            x53 * F3 * squared + x76 * F5))
        ),
        (
            xp.where(x40, xp.where(x32, -x21 * F4 - x16 * x79 - x57 - x81, x35 * F2 + x37 * F4 -
            x64), xp.where(x47, x16 * F1 * swing_left / 2 - x19 * x67 - x81, x51 * x52 * F3 - x50 *
            F1))
        ),
        (
            xp.where(x40, xp.where(x32, x15 - x57 * F2 + x18 + x82, x38 * fourth_right - x64 * F2 -
            x36 + 1), xp.where(x47, x82 - x45 * x56 * F1 - x43, x48 * x49 * F3 - x70 * F1))
        ),
        (
            xp.where(x40, xp.where(x32, x25 * F2 + x54 + x58 - x59 + x62 + x79 - x80, x39 * F2 +
            x65 - x66), xp.where(x47, F2 * fade_right / 4 - x41 * F1 + x56 * F3 * turn_left / 2 +
            fade_right * z / 4 - x59 - x61 - x80, x69 * F3 * xi - x76 * F1))
        ),
        (
            xp.where(x40, xp.where(x32, x54 * F2 - x17 + x73 + x83, x33 * x34 * squared - x66 * F2
            - x74), xp.where(x47, x78 * F1 + x75 + x83, x76 * F3 - x53 * F1 * squared))
        ),
    )


def axial_shapes(b, xi):
    """Return the displacement along the beam for a unit one of the right end.

    b, xi : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(b)
    x0 = 1 / xp.sin(b)
    x1 = xi * b
    return x0 * xp.sin(x1), x0 * b * xp.cos(x1)
