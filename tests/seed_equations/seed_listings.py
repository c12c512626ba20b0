"""The programmes of Smith's appendices 2, 3 and 4, line by line in Python.

The transliteration keeps every fault; ``repair`` switches name the ones that can be mended.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import atan, cos, floor, sin, sqrt

import numpy as np

PI = 3.14159265


def forbar2(L2, L3, L4, steps=37, repair: Collection[str] = ()):
    """Appendix 2: one row per 10 degrees of crank angle for a frame of unit length.

    A row holds the crank angle [deg], coupler angle [deg, min], omega3, alpha3, follower angle
    [deg, min], omega4, alpha4.  Repair ``sine`` keeps small sines.
    """
    k = L3**2 - L2**2 - L4**2 - 1
    rows = []
    for i in range(steps):
        th2 = 0.174532925 * i
        a = 2 * L2 * L4 * cos(th2) - 2 * L4
        b = k + 2 * L2 * cos(th2)
        small = abs(sin(th2)) < 1e-3 and "sine" not in repair
        c = 0.0 if small else 2 * L2 * L4 * sin(th2)
        d = -a * b / (a**2 + c**2)
        e = (b**2 - c**2) / (a**2 + c**2)
        if c == 0:
            csth4 = d
        elif th2 < atan(1) * 4:
            csth4 = d + sqrt(d**2 - e)
        else:
            csth4 = d - sqrt(d**2 - e)
        csth3 = (1 - L2 * cos(th2) + L4 * csth4) / L3
        snth4 = sqrt(1 - csth4**2)
        snth3 = sqrt(1 - csth3**2)
        th4 = atan(snth4 / csth4)
        th3 = atan(snth3 / csth3)
        x1 = floor(th3 * 180 / 3.1415926)
        y1 = round((th3 * 180 / 3.1415926 - x1) * 60)
        x2 = floor(th4 * 180 / 3.1415926)
        y2 = round((th4 * 180 / 3.1415926 - x2) * 60)
        divisor = snth3 * csth4 - csth3 * snth4
        omega3 = L2 * (snth4 * cos(th2) - csth4 * sin(th2)) / (L3 * divisor)
        omega4 = -L2 * (snth3 * cos(th2) - csth3 * sin(th2)) / (L4 * -divisor)
        between = csth3 * csth4 + snth3 * snth4
        alpha3 = L2 * (csth4 * cos(th2) + snth4 * sin(th2)) - omega4**2 * L4
        alpha3 = (alpha3 + omega3**2 * between * L3) / (L3 * -divisor)
        alpha4 = L2 * (csth3 * cos(th2) + snth3 * sin(th2)) + omega3**2 * L3
        alpha4 = -(alpha4 - omega4**2 * between * L4) / (L4 * divisor)
        x1, x2 = (180 + x if x < 0 else x for x in (x1, x2))
        rows.append((10 * i, x1, y1, omega3, alpha3, x2, y2, omega4, alpha4))
    return rows


@dataclass(frozen=True)
class Fourier:
    """Coefficients as left in the arrays a and b, and the number of intervals when it stopped."""

    a: np.ndarray
    b: np.ndarray
    intervals: int


def fousim(x, y, f: Callable[[float], float], M, eps, repair: Collection[str] = ("last",), room=0):
    """Appendix 3: Fourier coefficients by Simpson's rule, the interval halved until it stops.

    Repair ``stop`` tests every coefficient, ``last`` leaves out the statement after the last loop,
    when m is M + 1; the arrays a and b have ``room`` for more than M + 1 elements.
    """
    A, B, C, D = (np.zeros(M + 1) for _ in range(4))
    m = np.arange(M + 1)
    h, n = (y - x) / 2, 1
    F, G = f(x), f(y)
    I0, J0 = F * np.cos(m * x) + G * np.cos(m * y), F * np.sin(m * x) + G * np.sin(m * y)
    I1, J1 = np.zeros(M + 1), np.zeros(M + 1)
    while True:
        for i in range(1, n + 1):
            place = x + (2 * i - 1) * h
            P = f(place)
            B = B + P * np.cos(m * place)
            D = D + P * np.sin(m * place)
        I2 = h * (I0 + 4 * B + 2 * A) / 3
        J2 = h * (J0 + 4 * D + 2 * C) / 3
        p = 0
        for j in range(M + 1):
            if abs(I2[j] - I1[j]) < eps and abs(J2[j] - J1[j]) < eps:
                if "stop" in repair:
                    continue
                break
            p = p + 1
        if p == 0:
            break
        I1, J1 = I2, J2
        A, C = A + B, C + D
        B, D = np.zeros(M + 1), np.zeros(M + 1)
        h, n = h / 2, 2 * n
    a, b = np.full((2, M + 1 + room), np.nan)
    a[: M + 1], b[: M + 1] = I2 / PI, J2 / PI
    if "last" not in repair:
        a[M + 1] = b[M + 1] = 0
    a[0] = a[0] / 2
    return Fourier(a, b, 2 * n)


@dataclass(frozen=True)
class HillData:
    """Input of appendix 4."""

    l1: float
    l2: float
    l3: float
    l4: float
    omega2: float = 1.0
    x0: float = 0.0
    y0: float = 0.0
    z0: float = 0.0
    m: int = 1
    lamsq: float = 4.0
    mu: float = 0.0


def hill_kinematics(th, data: HillData, repair: Collection[str] = ()):
    """Appendix 4, procedure f, first part: sines, cosines, speeds and accelerations.

    Its theta4 points from C to D.  Repair ``turns`` reduces the angle to one turn, ``sine`` keeps
    small sines; a root of a rounded negative number, an error in the original, becomes zero.
    """
    l1, l2, l3, l4, omega2 = data.l1, data.l2, data.l3, data.l4, data.omega2
    k = l3**2 - l1**2 - l2**2 - l4**2
    a = 2 * l2 * l4 * cos(th) - 2 * l1 * l4
    b = k + 2 * l1 * l2 * cos(th)
    small = abs(sin(th)) < 1e-3 and "sine" not in repair
    c = 0.0 if small else 2 * l2 * l4 * sin(th)
    d = a * b / (a**2 + c**2)
    e = (b**2 - c**2) / (a**2 + c**2)
    branch = th % (8 * atan(1)) if "turns" in repair else th
    root = sqrt(max(0.0, d**2 - e))
    if small:
        csth4 = d
    elif branch < 4 * atan(1):
        csth4 = d - root
    else:
        csth4 = d + root
    csth3 = (l1 - l2 * cos(th) - l4 * csth4) / l3
    snth4 = -sqrt(1 - csth4**2)
    snth3 = sqrt(1 - csth3**2)
    divisor = snth3 * csth4 - csth3 * snth4
    between = csth3 * csth4 + snth3 * snth4
    omega3 = omega2 * l2 * (snth4 * cos(th) - csth4 * sin(th)) / (l3 * divisor)
    omega4 = omega2 * l2 * (snth3 * cos(th) - csth3 * sin(th)) / (l4 * -divisor)
    alpha3 = omega2**2 * l2 * (csth4 * cos(th) + snth4 * sin(th)) + omega4**2 * l4
    alpha3 = (alpha3 + omega3**2 * between * l3) / (l3 * -divisor)
    alpha4 = omega2**2 * l2 * (csth3 * cos(th) + snth3 * sin(th)) + omega3**2 * l3
    alpha4 = (alpha4 + omega4**2 * between * l4) / (l4 * divisor)
    return csth3, snth3, csth4, snth4, omega3, omega4, alpha3, alpha4


def hill_parts(th, data: HillData, repair: Collection[str] = ()):
    """Appendix 4, procedure f, last statement: factor of y and right-hand side."""
    csth3, snth3, csth4, snth4, _, _, alpha3, alpha4 = hill_kinematics(th, data, repair)
    divisor = data.omega2**2 * (snth3 * csth4 - csth3 * snth4)
    factor = data.lamsq * (1 + data.mu * alpha4 / divisor)
    m, square = data.m, data.omega2**2
    if m // 2 * 2 - m != 0:
        swing = sin(th) * csth3 - cos(th) * snth3
        return factor, 4 * data.l2 * swing / (m * data.l3 * PI) - 2 * alpha3 / (m * square * PI)
    return factor, 2 * alpha3 / (m * square * PI)


def de_vogelaere(f, x0, y0, z0, h, outputs, repair: Collection[str] = (), stop=np.inf):
    """Appendix 4, main loop: y after each full step of two half steps h [rad].

    Repair ``slope`` starts from h*z0 in place of the printed h*x0, ``start`` evaluates f at x0 - h
    in place of the printed -h, ``end`` tests the size of y.  Returns angles and values.
    """
    x, p = x0, y0
    q = h * (z0 if "slope" in repair else x0)
    r = h**2 * f(x, p) / 3
    t = p - q + 3 * r / 2
    s = h**2 * f(x0 - h if "start" in repair else -h, t) / 3
    places, values = [], []
    for _ in range(outputs):
        q = q + r
        p = p + q
        s = p + r - s / 2
        x = x + h
        s = h**2 * f(x, s) / 3
        q = q + 4 * s
        p = p + q
        x = x + h
        r = h**2 * f(x, p) / 3
        q = q + r
        places.append(x)
        values.append(p)
        if (abs(p) if "end" in repair else p) > stop:
            break
    return np.array(places), np.array(values)


def first_step(lamsq):
    """Appendix 4: the half step h [deg], halved from 10 until 18/lambda is not exceeded."""
    h = 10.0
    while h > 18 / sqrt(lamsq):
        h = h / 2
    return h
