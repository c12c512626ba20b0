"""A single vibrating mode as Hill's equation: which part is constant, which is periodic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, Term, require_system
from ..core.periodic_function import PeriodicFunction


@dataclass(frozen=True)
class HillForm:
    """``q'' + (c/w) q' + (k/w^2 + f(theta) + g(theta)/w^2) q = 0`` at crank speed w.

    Attributes
    ----------
    system : LinearPeriodic
        The system with one degree of freedom.
    inertial : tuple of (str or None, PeriodicFunction)
        Parts of f times the mass, with the parameter monomial that multiplies each.
    elastic : tuple of (str or None, PeriodicFunction)
        Parts of g times the mass, likewise.
    """

    system: LinearPeriodic
    inertial: tuple[tuple[str | None, PeriodicFunction], ...]
    elastic: tuple[tuple[str | None, PeriodicFunction], ...]

    def stiffness(self, **changes: float) -> float:
        """Return k [1/s^2], the square of the natural frequency without the periodic parts."""
        return self._entry("K", changes) / self._entry("M", changes)

    def damping(self, **changes: float) -> float:
        """Return c [1/s]; K of Smith (7.38) is ``c / (2 w)``."""
        return self._entry("C", changes) / self._entry("M", changes)

    def _entry(self, array: str, changes: Mapping[str, float]) -> float:
        return float(self.system.array(array, 0.0, **changes)[0, 0, 0])

    def function(self, speed: float, **changes: float) -> PeriodicFunction:
        """Return ``f + g / w^2`` at a speed [rad/s] and parameter values."""
        scales = self.system.scale_values(**changes)
        mass = self._entry("M", changes)
        total = PeriodicFunction()
        for parts, divisor in ((self.inertial, 1.0), (self.elastic, speed**2)):
            for scale, part in parts:
                factor = 1.0 if scale is None else float(scales[scale])
                total = total + part * (factor / (divisor * mass))
        return total


def is_hill(system: LinearPeriodic) -> bool:
    """Return True where the system is one mode with constant mass, damping and stiffness."""
    return (
        system.size == 1
        and not (system.has("A") or system.has("D"))
        and all(system.is_constant(name) for name in ("M", "C", "K"))
        and all(term.power == 0 for term in system.terms)
        and abs(system.period - 2 * np.pi) < 1e-15
    )


def hill_form(system: LinearPeriodic) -> HillForm:
    """Return the Hill form of a system with one mode (Smith 7.11, 7.38).

    Parameters
    ----------
    system : LinearPeriodic
        With one coordinate.

    Returns
    -------
    HillForm

    Raises
    ------
    BadInput
        If the system has several modes, or a mass or damping that changes over the cycle.

    Examples
    --------
    >>> import elastolink as el
    >>> form = el.hill_form(el.load_scene("smith_1972_5152_sixteenth_inch").system())
    >>> print(round(form.stiffness() ** 0.5, 2), form.damping())
    163.36 0.0
    """
    require_system(system)
    if not is_hill(system):
        expected = "one mode with constant mass, damping and stiffness"
        fix = "use floquet_multipliers or speed_boundaries"
        raise bad("system", f"{system.size} degrees of freedom", expected, fix)
    parts: dict[str, list[tuple[str | None, PeriodicFunction]]] = {"B": [], "Kg": []}
    for term in system.terms:
        if term.array in parts:
            sign = -1.0 if term.array == "B" else 1.0
            parts[term.array].append((term.scale, _series(term) * sign))
    return HillForm(system, tuple(parts["B"]), tuple(parts["Kg"]))


def _series(term: Term) -> PeriodicFunction:
    def entry(theta: Array) -> Array:
        return term(np.ravel(theta))[:, 0, 0].reshape(np.shape(theta))

    return PeriodicFunction.from_callable(entry)
