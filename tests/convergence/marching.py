"""Marching through a forced system with fixed steps of Gauss collocation."""

import numpy as np
from elastolink.runtime.core.collocation import gauss_maps
from elastolink.runtime.periodic.equation import equation_of


def marched(stages, system, speed, steps, turns, *, start=0.0, q=None, slope=None):
    """Return q ``(steps turns + 1, n)`` at the ends of even steps; from rest by default.

    Coefficients repeat with each turn of the crank; ``slope`` is dq/dtheta.
    """
    equation, n = equation_of(system, speed, {}, forcing=True), system.size
    step = 2 * np.pi / steps
    theta = start + step * np.arange(steps)
    maps = gauss_maps(stages, lambda angles: equation.generator(angles)[0], theta, step)
    rest = np.zeros(n)
    given = (np.atleast_2d(rest if values is None else values) for values in (q, slope))
    first = equation.states(np.array([start]), *given)
    states = [np.append(first, 1.0)]
    for _ in range(turns):
        for one in maps:
            states.append(one @ states[-1])
    return np.array(states)[:, :n] * equation.scale[0]


def wavy(theta):
    """A smooth 3 x 3 generator without any symmetry."""
    c, s = np.cos(theta), np.sin(2 * theta)
    out = np.zeros((len(theta), 3, 3))
    out[:, 0, 1] = 1.0 + 0.3 * c
    out[:, 1, 0] = -2.0 + s
    out[:, 1, 2] = c
    out[:, 2, 0] = 0.5 * s
    out[:, 2, 2] = -0.4 + 0.1 * c
    return out
