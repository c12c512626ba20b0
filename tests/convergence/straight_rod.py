"""A straight elastic rod on a slider-crank, derived by hand: what its bending feels.

The numbers are those of docs/examples/slider_crank_rod.toml, in SI units.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss

CRANK, ROD, OFFSET, EI, MU, DAMPING = 0.06, 0.3, 0.01, 4.2, 0.471, 0.6


def rod_angle(theta):
    """Angle of the rod and its two derivatives by the crank angle, from crank sin + rod sin = e."""
    sine = (OFFSET - CRANK * np.sin(theta)) / ROD
    angle = np.arcsin(sine)
    slope = -CRANK * np.cos(theta) / (ROD * np.cos(angle))
    bend = (CRANK * np.sin(theta) / ROD + sine * slope**2) / np.cos(angle)
    return angle, slope, bend


def end_load(theta, slider):
    """Force on the rod's end C along the rod over omega2^2: slider, guide, moments about B."""
    angle, slope, bend = rod_angle(theta)
    pin = -CRANK * np.sin(theta - angle)  # acceleration of B across the rod
    slide = -CRANK * np.cos(theta) - ROD * (np.cos(angle) * slope**2 + np.sin(angle) * bend)
    across = MU * ROD**2 / 3.0 * bend + MU * ROD / 2.0 * pin
    return -slider * slide / np.cos(angle) + across * np.tan(angle)


def projected(theta, modes, slider):
    """Arrays H and f over omega2^2 at one angle, by quadrature, divided by the modal mass."""
    nodes, weights = leggauss(60)
    x, weights = ROD * (nodes + 1.0) / 2.0, ROD * weights / 2.0
    angle, slope, bend = rod_angle(theta)
    m = np.arange(1, modes + 1)[:, None]
    shape = ROD * np.sin(m * np.pi * x / ROD)
    rise = m * np.pi * np.cos(m * np.pi * x / ROD)
    carried = CRANK * np.cos(theta - angle) * (ROD - x)
    tension = end_load(theta, slider) + MU * (carried + slope**2 * (ROD**2 - x**2) / 2.0)
    modal_mass = MU * ROD**3 / 2.0
    stiffness = (weights * tension * rise) @ rise.T - MU * slope**2 * (weights * shape) @ shape.T
    load = MU * (CRANK * np.sin(theta - angle) - x * bend)
    return stiffness / modal_mass, shape @ (weights * load) / modal_mass
