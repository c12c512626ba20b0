"""Unstable bands of stiff systems over the speed, from Krein collisions of the slow modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...errors import bad
from ...families import DAMPING, LinearPeriodic
from ...results import Check, provenance
from ..boundary_speeds import speed_span
from ..edges.checks import edge_checks
from ..edges.damped_edges import damped_regions
from ..edges.mended import mended
from ..edges.mode_labels import averaged_modes, principal_labels
from ..edges.pair_roots import Edges, PairFunction, refined_edges
from ..edges.phase_events import Events, meetings, sampled_phases
from ..edges.regions import Regions, joined
from ..edges.tracing import StabilityEdges, combined_regions
from ..speed_tables import tabulated
from .reduced import SlowSystem, slow_system

Array = NDArray[np.float64]

_MARGIN = 1.05
# Sine of the argument up to which two multipliers meet at +-1.
_REAL = 1e-4


def unstable_bands(
    system: LinearPeriodic | SlowSystem,
    speed_range: tuple[float, float],
    modes: int | None = None,
    *,
    rtol: float = 1e-11,
    thorough: bool = False,
    **parameters: float,
) -> StabilityEdges:
    """Return the unstable bands of the slow modes of a stiff system in a range of speeds.

    As :func:`stability_edges`, which needs matrices of all harmonics of all modes, but on the
    decoupled slow modes, and from their multipliers alone: principal bands begin and end where a
    mode's own two multipliers meet at +1 or -1, combination bands where those of two modes with
    opposite Krein signatures meet elsewhere.  Bands in which a mode that was left out takes part
    are not looked for: their harmonics are the gap over the speed and more, and they are as
    narrow as the coefficients' harmonics of that number are small.

    Parameters
    ----------
    system : LinearPeriodic or SlowSystem
        Conservative but for damping; or what :func:`slow_system` made of it.
    speed_range : pair of float
        Lowest and highest speed [rad/s], the lowest positive.
    modes : int, optional
        Number of slow modes, see :func:`slow_system`.
    rtol : float
        Wanted error of the monodromy matrices.
    thorough : bool
        Whether, undamped, each crossing of the circle is looked for where bands that single pairs
        make contradict the number of multipliers off it (check ``verdicts``), because more than
        two meet: ten times as dear.
    **parameters : float
        Parameter values that replace the system's own; geometry too.

    Returns
    -------
    StabilityEdges
        Its errors hold what decoupling costs; its further check ``decoupled`` is that relative
        error of the exponents.

    Raises
    ------
    BadInput
        As :func:`slow_system`, or if the range needs more than 40 000 samples.
    """
    low, high = speed_span(speed_range)
    if not 1e-13 <= rtol <= 1e-6:
        raise bad("rtol", rtol, "a number from 1e-13 to 1e-6", "choose 1e-11")
    span = (low / _MARGIN, high * _MARGIN)
    if not isinstance(system, SlowSystem):
        slow = slow_system(system, span, modes, **parameters)
    else:
        slow = system
    if low < slow.speed_range[0] or high > slow.speed_range[1]:
        raise bad(
            "speed_range",
            f"{low:.4g} to {high:.4g} rad/s",
            f"speeds within {slow.speed_range[0]:.4g} to {slow.speed_range[1]:.4g} rad/s",
            "make the slow system for a wider range",
        )
    span = max(span[0], slow.speed_range[0]), min(span[1], slow.speed_range[1])
    own = slow.system
    damped = own.is_damped()
    # Thousands of matrices are asked for.
    sharp = tabulated(own.without(*DAMPING), span)
    own = tabulated(own, span) if damped else sharp
    pairs = _Pairs(sharp, span, rtol)
    regions = pairs.regions()
    if damped:
        regions = damped_regions(own, regions, span, rtol, {})
    regions = regions.overlapping(low, high)
    checks = edge_checks(own, regions, (low, high), {})
    if thorough and not damped and not all(check.passed for check in checks.values()):
        regions = pairs.mended().overlapping(low, high)
        checks = edge_checks(own, regions, (low, high), {})
    checks["decoupled"] = Check(slow.error, 1e-3)
    return StabilityEdges(
        method="modulus 1 of a multiplier of the slow modes"
        if damped
        else "gap of multipliers of opposite Krein signature, slow modes",
        error=regions.error + slow.error * regions.end,
        error_norm="absolute, of either end [rad/s]",
        checks=checks,
        provenance=provenance(own.provenance),
        lower=regions.lower,
        upper=regions.upper,
        multiplier=regions.multiplier,
        modes=regions.modes,
        harmonic=regions.harmonic,
        detuning=regions.detuning,
        kind=regions.kind,
        least_width=pairs.least,
        speed_range=(low, high),
    )


class _Pairs:
    """The bands of a conservative system, from pairs of its multipliers that meet.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    span : pair of float
        The range [rad/s].
    rtol : float
        Of the monodromy matrices.
    """

    def __init__(self, system: LinearPeriodic, span: tuple[float, float], rtol: float) -> None:
        self._system, self._span, self._rtol = system, span, rtol
        samples = sampled_phases(system, span, {}, rtol, np.zeros(0))
        function = PairFunction(system, {}, rtol)
        own = meetings(samples, principal=True)
        edges = refined_edges(function, own)
        self._principal = _principal(system, own, edges)
        self._events = meetings(samples)
        pairs = refined_edges(function, self._events)
        self._combined = combined_regions(system, self._events, pairs, {})
        self._usable = np.abs(np.sin(pairs.phase)) > _REAL
        # Width that each pair was searched down to.
        self.least = float(np.max(np.concatenate([edges.least, pairs.least]), initial=0.0))

    def regions(self) -> Regions:
        """Return the bands as single pairs make them."""
        return joined(self._principal, self._combined.take(np.flatnonzero(self._usable)))

    def mended(self) -> Regions:
        """Return the bands that agree with the number of multipliers off the circle: dear."""
        ends = [self._principal.lower, self._principal.upper, self._combined.lower]
        near = np.concatenate([*ends, self._combined.upper, self._events.inside])
        where = self._span, near
        found = mended(self._system, self._combined, self._usable, where, self._rtol, {})
        return joined(self._principal, found)


def _principal(system: LinearPeriodic, events: Events, edges: Edges) -> Regions:
    """Return the bands in which a mode's own multipliers meet, with labels."""
    kept = np.abs(np.sin(edges.phase)) <= np.sqrt(_REAL)
    index = np.flatnonzero(kept)
    lower, upper, phase = edges.lower[index], edges.upper[index], edges.phase[index]
    reach = events.reach[index]
    middle = np.where(np.isfinite(lower + upper), 0.5 * (lower + upper), np.mean(reach, axis=1))
    real = np.where(np.cos(phase) > 0, 1.0, -1.0)
    mode, number, off = principal_labels(averaged_modes(system, middle, {}), real)
    return Regions(
        lower,
        upper,
        edges.error[index],
        real.astype(complex),
        np.stack([mode, mode], axis=1),
        number,
        off,
        np.where(np.isfinite(lower), lower, reach[:, 0]),
        np.where(np.isfinite(upper), upper, reach[:, 1]),
        ("principal",) * len(index),
    )
