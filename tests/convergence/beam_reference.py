"""Frequencies of beams in many digits, by characteristic equations and by power series."""

import mpmath
import numpy as np


def pinned(mode: int) -> float:
    """Return omega of a pinned beam of unit length, mass and stiffness."""
    return float((mode * mpmath.pi) ** 2)


def cantilever(mode: int) -> float:
    """Return omega of a clamped and free beam: ``1 + cos b cosh b = 0``, omega = b^2."""
    with mpmath.workdps(30):
        guess = (mode - mpmath.mpf(1) / 2) * mpmath.pi
        root = mpmath.findroot(lambda b: mpmath.cos(b) + 1 / mpmath.cosh(b), guess)
        return float(root**2)


def rotating(speed: float, axial: float, guess: float, digits: int = 40) -> float:
    """Return a frequency of a beam clamped at the axis about which it turns in its plane.

    With U cos(W t) along and V sin(W t) across, unit length, mass per length and EI, tension
    ``w^2 (1 - x^2)/2`` and EA = ``axial``:

        (W^2 + w^2) U + 2 w W V + EA U'' = 0,
        (W^2 + w^2) V + 2 w W U - V'''' + (w^2/2 (1 - x^2) V')' = 0,

    U = V = V' = 0 at the axis, U' = V'' = V''' = 0 at the tip.  The power series about the axis
    converges everywhere; three unknown coefficients, three conditions at the tip.
    """
    with mpmath.workdps(digits):
        w, stretch = mpmath.mpf(speed), mpmath.mpf(axial)

        def defect(omega):
            both, cross = omega**2 + w**2, 2 * w * omega
            columns = []
            for start in range(3):
                unknown = [mpmath.mpf(int(start == i)) for i in range(3)]
                a = [mpmath.mpf(0), unknown[0]]
                b = [mpmath.mpf(0), mpmath.mpf(0), unknown[1], unknown[2]]
                for k in range(120):
                    a.append(-(both * a[k] + cross * b[k]) / (stretch * (k + 2) * (k + 1)))
                    pull = (k + 2) * (k + 1) * b[k + 2] - k * (k + 1) * b[k]
                    side = both * b[k] + cross * a[k] + w**2 / 2 * pull
                    b.append(side / ((k + 4) * (k + 3) * (k + 2) * (k + 1)))
                columns.append(
                    (
                        mpmath.fsum(k * c for k, c in enumerate(a)),
                        mpmath.fsum(k * (k - 1) * c for k, c in enumerate(b)),
                        mpmath.fsum(k * (k - 1) * (k - 2) * c for k, c in enumerate(b)),
                    )
                )
            return mpmath.det(mpmath.matrix(columns))

        return float(mpmath.findroot(defect, mpmath.mpf(guess)))


def timoshenko(mode: int, ratio: float, slimness: float) -> float:
    """Return omega of a pinned beam with shear and rotary inertia, the lower branch.

    Unit length, mass and EI; ``ratio = EI/(k G A L^2)``, ``slimness = rho I/(rho A L^2)``.  With
    v = sin(n pi x), psi = c cos(n pi x) both equations of motion are algebraic.
    """
    with mpmath.workdps(30):
        n, shear, rotary = mode * mpmath.pi, 1 / mpmath.mpf(ratio), mpmath.mpf(slimness)
        # shear (n^2 v - n c) = W v,  n^2 c + shear (c - n v) = rotary W c,  W = omega^2
        total = shear * n**2 * rotary + n**2 + shear
        root = mpmath.sqrt(total**2 - 4 * rotary * shear * n**4)
        return float(mpmath.sqrt(2 * shear * n**4 / (total + root)))


def rigid_field(kind, start, end, turning):
    """Return the local nodal values of a field that is linear along an element, ``(..., n)``.

    From its components along and across at the two ends, and the matching turning.
    """
    first, last, angle = (np.asarray(item, dtype=float) for item in (start, end, turning))
    values = [first[..., 0], first[..., 1], angle, last[..., 0], last[..., 1], angle]
    if kind == "internal_node":
        values += [(first[..., 1] + last[..., 1]) / 2.0, angle]
    elif kind == "curvature":
        values += [np.zeros_like(angle)] * 2
    return np.stack(np.broadcast_arrays(*values), axis=-1)
