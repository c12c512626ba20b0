"""Axes of a chart along which Hill's equation keeps its function, or scales it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ...core.families import Array
from ...core.periodic_function import PeriodicFunction
from ...hill import HillForm

# Values that show a proportional dependence, and angles at which functions are compared.
_PROBES = (1.0, 2.0, 5.0, 0.37)
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 17)

PlainAxes = tuple[int, PeriodicFunction, Callable[[Array], Array], Callable[[Array], Array]]


def plain_axes(form: HillForm, names: tuple[str, str]) -> PlainAxes | None:
    """Return how two axes amount to ``y'' + (lam2 + mu f) y = 0``, where they do.

    Parameters
    ----------
    form : HillForm
        Without damping.
    names : tuple of str
        ``"speed"`` or parameters.

    Returns
    -------
    tuple or None
        Which axis carries lam2 (0 or 1), the function f, and the maps from the values of that
        axis to lam2 and from the values of the other one to mu; None where f is not simply
        proportional to the other parameter, or lam2 not the speed's or a parameter of its own.
    """
    for which in (0, 1):
        along, other = names[which], names[1 - which]
        if other == "speed" or (along == "speed" and form.elastic):
            continue
        if not leaves_function_alone(form, along):
            continue
        unit = form.function(1.0, **{other: 1.0})
        at = unit(_ANGLES)
        if not all(
            np.allclose(form.function(1.0, **{other: v})(_ANGLES), v * at, rtol=1e-14, atol=0.0)
            for v in _PROBES
        ):
            continue
        stiffness = form.stiffness()
        if any(form.stiffness(**{other: v}) != stiffness for v in _PROBES):
            continue
        if along == "speed":
            return which, unit, partial(_over_square, stiffness), np.asarray
        if is_stiffness(form, along):
            return which, unit, np.asarray, np.asarray
    return None


def _over_square(stiffness: float, speed: Array) -> Array:
    return stiffness / speed**2


def is_stiffness(form: HillForm, name: str) -> bool:
    """Return True where a parameter is the constant stiffness itself."""
    if name not in form.system.parameters:
        return False
    probe = [form.stiffness(**{name: v}) for v in _PROBES]
    return bool(np.allclose(probe, _PROBES, rtol=1e-14)) and leaves_function_alone(form, name)


def leaves_function_alone(form: HillForm, name: str) -> bool:
    """Return True where an axis changes the constant stiffness and damping but not f."""
    if name == "speed":
        return not form.elastic
    parts = {scale for scale, _ in (*form.inertial, *form.elastic)}
    parts |= {term.scale for term in form.system.terms if term.array == "M"}
    own = form.system.parameters[name]
    base = form.system.scale_values()
    return all(
        np.all(base[scale] == form.system.scale_values(**{name: value})[scale])
        for scale in parts
        if scale is not None
        for value in (own + 1.0, 2.0 * abs(own) + 3.0)
    )
