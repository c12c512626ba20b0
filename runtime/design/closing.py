"""The least damping that closes regions of parametric instability."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import require_kind
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers
from ..stability import StabilityEdges

# Chebyshev nodes of the speeds over a region, how often they are taken, drawn together about the
# highest growth, and the degree of the polynomial through the last ones.
_NODES = np.cos(np.pi * (np.arange(11.0) + 0.5) / 11.0)
_ROUNDS, _DEGREE = 3, 8
# Wanted error of the multipliers; what the highest growth is known to, over that without the more
# of damping; doublings of the damping after which it is said to close nothing; decay by a unit of
# it that is none; growth that is none, over its error.
_RTOL, _KNOWN, _DOUBLINGS, _NOTHING, _TOLD = 1e-11, 1e-11, 40, 1e-10, 4.0


@dataclass(frozen=True, kw_only=True)
class ClosingDamping(Result):
    """The least values of a damping with which the speeds of unstable regions are stable.

    Attributes
    ----------
    name : str
        The parameter.
    region : tuple of str, length k
        The regions, by their labels.
    damping : ndarray, shape (k,)
        Its least value, of the unit of the parameter; NaN of regions without two ends, or
        whose growth is not told apart from none.
    speed, speed_error : ndarray, shape (k,)
        Speed [rad/s] at which the last motion stops growing, and its error.
    """

    name: str
    region: tuple[str, ...]
    damping: Array
    speed: Array
    speed_error: Array

    arrays_along: ClassVar = {"region": "damping speed speed_error error"}
    column_units: ClassVar = {"rad/s": "speed speed_error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the values as bars at the speeds."""
        ax = axes_or_new(ax)
        ax.vlines(self.speed * RPM, 0.0, self.damping, lw=3.0)
        ax.set(xlabel="crank speed [rpm]", ylabel=f"least {self.name.replace('_', ' ')}")
        return ax


def closing_damping(
    system: LinearPeriodic, edges: StabilityEdges, name: str = "damping"
) -> ClosingDamping:
    """Return the least damping that closes each region of parametric instability.

    With it no multiplier at a speed of the region is outside the unit circle.  The highest growth
    over the speeds is followed as the damping grows, until it is nought.  Of one or two modes that
    takes a tenth of a second for each region, of linkages of beams many minutes.

    Parameters
    ----------
    system : LinearPeriodic
        What the regions are of.
    edges : StabilityEdges
        Regions, from :func:`stability_edges`, with the damping that the system has.
    name : str
        The parameter that damps: ``damping`` of couplers, ``damping_ratio`` of linkages of beams.

    Returns
    -------
    ClosingDamping
        Its check: ``closed``, the growth that is left at the speeds, its error taken away.

    Raises
    ------
    BadInput
        If an argument is unusable, or the parameter does not damp.

    Notes
    -----
    Smith (7.50) has it to the first order for one mode; :func:`critical_damping` exactly.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> edges = el.stability_edges(system, (75.0, 85.0))
    >>> found = el.design.closing_damping(system, edges)
    >>> print(found.region, found.damping.round(3), found.speed.round(2))
    ('region 4 of mode 1',) [0.331] [79.69]
    """
    require_kind("system", system, LinearPeriodic, "take the .system() of a linear scene")
    require_kind("edges", edges, StabilityEdges, "take those of stability_edges")
    if not isinstance(name, str) or name not in system.parameters:
        raise bad("name", repr(name), f"one of {list(system.parameters)}", "name one that damps")
    rows = np.full((5, len(edges.lower)), np.nan)
    for i, (low, high) in enumerate(zip(edges.lower.tolist(), edges.upper.tolist(), strict=True)):
        if high > low:
            rows[:, i] = _closed(system, name, low, high)
    damping, speed, off, error, excess = rows
    return ClosingDamping(
        method="highest growth over the speeds, followed to nought",
        error=np.where(np.isfinite(damping), error, np.inf),
        error_norm="absolute, of the damping",
        checks={"closed": Check(float(np.nanmax(excess, initial=0.0)), 0.0)},
        provenance=provenance(system.provenance),
        name=name,
        region=edges.labels,
        damping=damping,
        speed=speed,
        speed_error=off,
    )


def _closed(system: LinearPeriodic, name: str, low: float, high: float) -> tuple[float, ...]:
    """Return the closing damping of a region, its speed, their errors, and what still grows."""
    from scipy.optimize import brentq

    own = system.parameters[name]

    def growth(value: float) -> float:
        return _highest(system.with_parameters(**{name: value}), low, high).growth

    def sum_of_decays(value: float) -> float:
        moved = system.with_parameters(**{name: value})
        found = floquet_multipliers(moved, 0.5 * (low + high), rtol=_RTOL)
        return float(np.mean(found.exponents.real))

    top = _highest(system, low, high)
    first = top.growth
    if not first > _TOLD * top.error:
        return (np.nan,) * 5
    # By Liouville's formula the mean of all exponents falls with the damping, in proportion.
    trial = max(abs(own), 1.0)
    rate = (sum_of_decays(own) - sum_of_decays(own + trial)) / trial
    step = first / rate if rate * trial > _NOTHING else np.inf
    for _ in range(_DOUBLINGS if np.isfinite(step) else 0):
        if growth(own + step) < 0.0:
            break
        step *= 2.0
    else:
        fix = "name one whose growth takes energy away"
        raise bad("name", f"{name}, which does not close it", "a parameter that damps", fix)
    value = float(brentq(growth, own, own + step, xtol=1e-14 * step, rtol=1e-13))
    top = _highest(system.with_parameters(**{name: value}), low, high)
    slope = (growth(value + 1e-3 * step) - top.growth) / (1e-3 * step)
    doubt = top.error + _KNOWN * first
    return value, top.speed, top.off, doubt / abs(slope), max(top.growth - doubt, 0.0)


class _Top(NamedTuple):
    speed: float
    growth: float  # in a turn, there
    error: float  # of the growth
    off: float  # of the speed


def _highest(system: LinearPeriodic, low: float, high: float) -> _Top:
    """Return where the growth over speeds is highest: of a polynomial about the highest sample."""
    for again in range(_ROUNDS):
        speeds = 0.5 * (low + high) - 0.5 * (high - low) * _NODES
        growth = _growth(system, speeds)[0]
        if again < _ROUNDS - 1:
            top = min(max(int(np.argmax(growth)), 1), len(speeds) - 2)
            low, high = float(speeds[top - 1]), float(speeds[top + 1])
    at = []
    for degree in (_DEGREE, _DEGREE - 1):
        fitted = Chebyshev.fit(speeds, growth, degree, domain=[low, high])
        roots = np.asarray(fitted.deriv().roots(), dtype=complex)
        flat: Array = np.real(roots[np.abs(np.imag(roots)) < 1e-6 * (high - low)])
        inside = np.append(flat[(flat > low) & (flat < high)], speeds[np.argmax(growth)])
        at.append(float(inside[np.argmax(fitted(inside))]))
    here, error = _growth(system, np.array(at[:1]))
    # What the errors of the growths do to the place where it is flat: of 100 random regions the
    # speed was off by up to 14 times that of one of them.
    bend = abs(float(fitted.deriv(2)(at[0])))
    blurred = 16.0 * float(error[0]) / (bend * (high - low)) if bend > 0.0 else high - low
    return _Top(at[0], float(here[0]), float(error[0]), abs(at[1] - at[0]) + blurred)


def _growth(system: LinearPeriodic, speeds: Array) -> tuple[Array, Array]:
    """Return the largest real part of the exponents at speeds, and its error."""
    found = floquet_multipliers(system, speeds, rtol=_RTOL)
    return found.exponents.real[:, 0], found.error[:, 0] / np.abs(found.multipliers[:, 0])
