"""De Vogelaere's method for second-order equations without first derivatives (Smith, appendix 4).

With h the *half* step, the values of y'' = f(theta, y) at -h, 0, h and 2h are used:

    y(h)   = y(0) + h y'(0) + h^2/6 (4 f(0) - f(-h)),
    y(2h)  = y(0) + 2h y'(0) + h^2/3 (2 f(0) + 4 f(h)),
    y'(2h) = y'(0) + h/3 (f(0) + 4 f(h) + f(2h)),

and f(h) serves the next step as its f(-h).  The state of the method is (y, h y', h^2 f(-h)).
"""

from __future__ import annotations

import numpy as np

from ..core.namespaces import identity, namespace_of
from .protocol import Array, Generator, OneStep, at_nodes

ORDER = 4


def maps(generator: Generator, theta: Array, half_step: float) -> Array:
    """Return the matrices that carry the method's state over each full step ``2 half_step``.

    Parameters
    ----------
    generator : callable
        From angles ``(nt,)`` to the matrices P of y'' = P(theta) y, shape ``(*batch, nt, n, n)``.
        Forcing enters as a last component of y that stays 1.
    theta : ndarray
        Left ends of the steps [rad], shape ``(ns,)``.
    half_step : float
        h, half of the distance between the ends of a step [rad].

    Returns
    -------
    ndarray
        Shape ``(*batch, ns, 3 n, 3 n)``, acting on (y, h y', h^2 f(-h)).
    """
    values = half_step**2 * at_nodes(generator, theta, half_step * np.arange(3.0))
    f0, f1, f2 = (values[..., k, :, :] for k in range(3))
    n = values.shape[-1]
    unit = identity(3 * n, values)
    y, slope, past = unit[:n, :], unit[n : 2 * n, :], unit[2 * n :, :]
    start = f0 @ y
    middle = f1 @ (y + slope + (4 * start - past) / 6)
    end = y + 2 * slope + (2 * start + 4 * middle) / 3
    end_slope = slope + (start + 4 * middle + f2 @ end) / 3
    found: Array = namespace_of(values).concat([end, end_slope, middle], axis=-2)
    return found


def start(generator: Generator, theta: float, half_step: float, y: Array, slope: Array) -> Array:
    """Return the method's first state from y and y' at the start.

    The value at -h comes from the Taylor polynomial y - h y' + h^2/2 y''; its third-order error
    leaves the order of the method at four.

    Parameters
    ----------
    generator : callable
        As in :func:`maps`.
    theta : float
        Crank angle at the start [rad].
    half_step : float
        h [rad].
    y, slope : ndarray
        y and dy/dtheta, shape ``(n,)``.

    Returns
    -------
    ndarray
        Shape ``(3 n,)``.
    """
    before, here = generator(np.array([theta - half_step, theta]))
    past = y - half_step * slope + half_step**2 / 2 * (here @ y)
    return np.concatenate([y, half_step * slope, half_step**2 * (before @ past)])


def _double(generator: Generator, theta: Array, step: float) -> Array:
    return maps(generator, theta, step / 2)


# The maps of this record act on the method's own state, see `maps`; `step` is the full step.
METHOD = OneStep("de_vogelaere", order=ORDER, maps=_double, explicit=True, symplectic=False)
