"""Energy balance of a motion: what the energy gained against the power that went in."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from ..core.results import Check
from .equation import Equation

Array = NDArray[np.float64]

# Phase of a mode between given angles from which they do not tell its part of an integral.
_MOST_PHASE = 0.5
# Decay of the amplitude, as a power of e, from which a mode is dead.
_DEAD = 20.0


def energy_balance(
    equation: Equation, theta: Array, q: Array, slope: Array, error: float
) -> Check | None:
    """Return the defect of the energy balance over its largest term; None where angles are too few.

    With v = dq/dtheta the energy is ``E = v^T M v/2 - q^T N_s q/2``, N_s the symmetric part of N,
    and ``dE/dtheta = v^T (N - N_s) q - v^T C v/w + v^T F - v^T A' q - v^T M' v/2 - q^T N_s' q/2``.
    The angles ``theta`` [rad], ``(nt,)``, are even but for the last; q and ``slope``, which is v,
    have shape ``(nt, n)``, and ``error`` is that of the motion over its peak.
    """
    if len(theta) < 10 or equation.harmonics < 0:
        return None
    step = float(theta[1] - theta[0])
    # Modes too fast for the angles have to be dead: the balance begins where the last of them is.
    fast = step * equation.frequency[0] > _MOST_PHASE
    decay = float(np.min(equation.decay[0], initial=np.inf, where=fast))
    dead = _DEAD / max(decay, 1e-300) * equation.period / step
    begin = ceil(min(dead, len(theta)))
    even = 4 * ((len(theta) - 2 - begin) // 4) + 1
    if even < 9:
        return None
    part = slice(begin, begin + even)
    theta, q, slope = theta[part], q[part], slope[part]
    unit = equation.scale[0]
    place, rate = q / unit, slope / unit
    power = np.zeros(even)
    energy = 0.5 * _form(equation.at("mass", theta)[0], rate, rate)
    power -= 0.5 * _form(equation.slope("mass", theta), rate, rate)
    if "stiffness" in equation.fields:
        stiffness = equation.at("stiffness", theta)[0]
        energy -= 0.5 * _form(stiffness, place, place)
        turned = stiffness - np.swapaxes(stiffness, -1, -2)
        power += 0.5 * _form(turned, rate, place)
        power -= 0.5 * _form(equation.slope("stiffness", theta), place, place)
    if "gyroscopic" in equation.fields:
        power -= _form(equation.slope("gyroscopic", theta), rate, place)
    if "damping" in equation.fields:
        power -= _form(equation.at("damping", theta)[0], rate, rate)
    if equation.forced:
        power += np.sum(equation.at("force", theta)[0] * rate, axis=-1)
    fine, coarse = _simpson(power, step), _simpson(power[::2], 2.0 * step)
    # Boole's rule.
    work = fine + (fine - coarse) / 15.0
    size = float(np.max(np.abs(energy))) + step * float(np.sum(np.abs(power)))
    if not 0.0 < size < np.inf:
        return None
    defect = abs(float(energy[-1] - energy[0]) - work) / size
    # Simpson's rule on twice the step is in error by far more than Boole's.
    return Check(defect, 20.0 * error + abs(work - coarse) / size + 1e-12)


def _form(matrices: Array, left: Array, right: Array) -> Array:
    value: Array = np.sum(left * (matrices @ right[..., None])[..., 0], axis=-1)
    return value


def _simpson(values: Array, step: float) -> float:
    inner = 4.0 * float(np.sum(values[1:-1:2])) + 2.0 * float(np.sum(values[2:-1:2]))
    return step / 3.0 * (float(values[0] + values[-1]) + inner)
