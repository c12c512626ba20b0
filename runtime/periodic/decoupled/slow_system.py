"""The slow modes of a stiff periodic system as a smaller linear periodic system of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...core.errors import BadInput, bad
from ...core.families import DAMPING, Array, LinearPeriodic, Term
from ...core.inputs import numbers, require_whole, speed_span
from ...core.trigonometric import interpolated
from ..equation import Equation, SampledSystem, at_geometry, sampled
from ..reduced import projections
from .riccati import Frames, moving_frames, plain_equation, slow_part
from .slow_modes import decoupling_error, frozen_frequencies, gap_choices, integrated

# Degrees in the speed squared that are tried, the part of an array left out that is enough, and
# that from which more degrees show round-off alone.
_DEGREES = (1, 2, 3, 4, 6, 8)
_SMALL, _ROUND_OFF = 1e-11, 1e-9
# Change of a monodromy matrix that ends the search for a gap, that ends it where better ones are
# dearer, and the largest that will do.
_PRECISE, _ENOUGH, _MOST = 1e-9, 1e-6, 1e-3
# How many times the work of the first choice that is good enough a better one may cost.
_DEARER = 10.0
# Gap above the slow modes, in turns a period, from which decoupling is worth a try.
_WORTH = 4.0
_FEWEST = 4
# Amplitude over the largest of its kind up to which a harmonic is round-off.
_NOISE = 4 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class SlowSystem:
    """The slow modes of a stiff system, with what leaving the others out costs.

    Attributes
    ----------
    system : LinearPeriodic
        Undamped: the exact motion of the slow modes, the fast ones following them, as arrays that
        are polynomials in the speed squared.  Damping enters to leading order.
    modes : int
        Number k of its freedoms.
    speed_range : tuple of float
        Speeds [rad/s] that it holds for.
    fit : float
        Largest error of an array by the polynomials, over the largest entry, at speeds between
        those they were made from.
    residual : float
        Change of a monodromy matrix that incomplete decoupling makes at the highest speed.
    degree : int
        Degree of the polynomials in the speed squared.
    """

    system: LinearPeriodic
    modes: int
    speed_range: tuple[float, float]
    fit: float
    residual: float
    degree: int

    @property
    def error(self) -> float:
        """Relative error of the exponents' turns, an estimate."""
        return self.fit + self.residual


def slow_system(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    modes: int | None = None,
    **parameters: float,
) -> SlowSystem:
    """Return the slow modes of a stiff system as a smaller linear periodic system.

    All that takes a :class:`LinearPeriodic` takes the result: multipliers, Krein signatures,
    ``stability_edges``.  Its coordinates are those of a moving basis; there is no forcing.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative but for damping.
    speed_range : pair of float
        Lowest and highest speed [rad/s] that the result shall hold for.
    modes : int, optional
        Number of slow modes.  By default the least of at least 4 with a relative change of the
        monodromy matrix below 1e-9 at the highest speed; where that takes over ten times the work
        of the first below 1e-6, the best until there; where none is below 1e-6, the best.
    **parameters : float
        Parameter values that replace the system's own; geometry too.

    Raises
    ------
    BadInput
        If an argument is unusable, the system is not conservative but for damping, no gap of the
        frequencies lets modes be left out with a change below 1e-3, or the arrays are no
        polynomials in the speed squared.
    """
    low, high = speed_span(speed_range)
    system, values = at_geometry(system, parameters)
    changed = {name: float(numbers(name, value)) for name, value in values.items()}
    calm = sampled(system.without(*DAMPING))
    top = plain_equation(calm, high, changed)
    if top.damped:
        raise bad(
            "system",
            "stiffness or centrifugal terms that are not symmetric",
            "a system conservative but for damping",
            "use floquet_multipliers or stability_chart",
        )
    chosen = _chosen(top, modes)
    degree, coefficients, fit = _fitted(calm, chosen, (low, high), changed)
    terms = _terms(coefficients, system.period, high)
    terms += _damping(system, chosen.frames, high, changed)
    reduced = LinearPeriodic(
        chosen.frames.modes,
        tuple(terms),
        period=system.period,
        labels=tuple(f"slow {i + 1}" for i in range(chosen.frames.modes)),
        provenance=system.changed_provenance(**changed),
    )
    return SlowSystem(reduced, chosen.frames.modes, (low, high), fit, chosen.change, degree)


@dataclass(frozen=True)
class _Choice:
    """A basis, the change of the matrix by incomplete decoupling, and the passes it takes."""

    frames: Frames
    change: float
    passes: int


def _chosen(top: Equation, modes: int | None) -> _Choice:
    frequency = frozen_frequencies(top)
    if modes is not None:
        return _tried(top, require_whole("modes", modes, 1, top.size - 1), frequency)
    best = _searched(top, frequency)
    if best is None or not best.change < _MOST:
        found = "no gap of the natural frequencies is wide enough to leave the modes above it out"
        if best is not None:
            found += f" (best: {best.frames.modes} modes, relative change {best.change:.1e})"
        raise bad(
            "speed_range",
            f"up to {float(top.speed[0]):.4g} rad/s, where {found}",
            "speeds far below a gap of the natural frequencies",
            "lower the speeds or use the whole system",
        )
    return best


def _searched(top: Equation, frequency: Array) -> _Choice | None:
    """Return the best choice that is not dear without need; None where there is none."""
    n = top.size
    work = np.max(frequency, axis=0) * np.arange(1, n + 1) ** 3.0
    least = _WORTH * 2 * np.pi / top.period * float(top.speed[0])
    best: _Choice | None = None
    dearest = np.inf
    for k, gap in gap_choices(frequency, min(_FEWEST, n - 1)):
        if work[k - 1] > dearest:
            break
        if gap < least:
            continue
        try:
            found = _tried(top, k, frequency)
        except BadInput:
            continue
        if best is None or found.change < best.change:
            best = found
        if found.change < _PRECISE:
            break
        if found.change < _ENOUGH:
            dearest = min(dearest, _DEARER * float(work[k - 1]))
    return best


def _tried(top: Equation, modes: int, frequency: Array) -> _Choice:
    frames = moving_frames(top, modes)
    slow = slow_part(top, frames)
    rate = float(np.max(frequency[:, modes - 1]) / top.speed[0])
    found = integrated(slow, top.period, rate, 1e-9)
    change = min(decoupling_error(slow, found, top.period), found.residual)
    return _Choice(frames, change, slow.passes)


def _arrays(equation: Equation, chosen: _Choice) -> dict[str, Array]:
    """Return M, A and R = K + Kg - w^2 B of the slow modes at one speed, each ``(nt, k, k)``."""
    slow, k = slow_part(equation, chosen.frames, chosen.passes), chosen.frames.modes
    size = np.concatenate([slow.scale[:k], 1.0 / slow.scale[:k]])
    plain = slow.generator * size[:, None] / size
    mass = np.linalg.inv(plain[..., :k, k:])
    gyro = -mass @ plain[..., :k, :k]
    push = plain[..., k:, :k] + np.swapaxes(gyro, -1, -2) @ plain[..., :k, k:] @ gyro
    rest = -(equation.speed[0] ** 2) * push
    return {
        "M": 0.5 * (mass + np.swapaxes(mass, -1, -2)),
        "A": gyro,
        "R": 0.5 * (rest + np.swapaxes(rest, -1, -2)),
    }


def _fitted(
    known: SampledSystem,
    chosen: _Choice,
    span: tuple[float, float],
    changed: Mapping[str, float],
) -> tuple[int, dict[str, list[Array]], float]:
    """Return the degree, the coefficients by powers of the speed squared, and the error."""
    low, high = (value**2 for value in span)
    best: tuple[int, dict[str, list[Array]], float] | None = None
    for degree in _DEGREES:
        # The last column of nodes between tells how well the others do.
        nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
        extra = np.array([-1.0, 0.37, 1.0])
        places = 0.5 * (low + high) + 0.5 * (high - low) * np.concatenate([nodes, extra])
        each = [
            _arrays(plain_equation(known, float(speed), changed), chosen)
            for speed in np.sqrt(places)
        ]
        found = {name: np.stack([arrays[name] for arrays in each]) for name in each[0]}
        unit = places / high
        vander = np.vander(unit, degree + 1, increasing=True)
        inverse = np.linalg.inv(vander[: degree + 1])
        coefficients, error = {}, 0.0
        for name, values in found.items():
            flat = values.reshape(len(places), -1)
            own = inverse @ flat[: degree + 1]
            gap = np.max(np.abs(vander[degree + 1 :] @ own - flat[degree + 1 :]))
            error = max(error, float(gap / np.max(np.abs(flat))))
            shape = values.shape[1:]
            coefficients[name] = [(row / high**j).reshape(shape) for j, row in enumerate(own)]
        better = best is None or error < 0.5 * best[2]
        if better:
            best = degree, coefficients, error
        # Enough is a hundredth of what decoupling leaves; a small error that stays is round-off.
        if error < max(_SMALL, 0.01 * chosen.change) or (not better and error < _ROUND_OFF):
            break
    if best is None or not best[2] < _MOST:
        raise bad(
            "system",
            "slow modes whose arrays are no polynomials in the speed squared",
            "terms with even powers of the speed, and speeds far below a gap of the frequencies",
            "lower the speeds or use the whole system",
        )
    return best


def _terms(coefficients: Mapping[str, list[Array]], period: float, high: float) -> list[Term]:
    """Return the terms of the reduced Lagrangian, all of them parts of one series."""
    named = [(n, 2 * j, v) for n in ("M", "A") for j, v in enumerate(coefficients[n])]
    first, *rest = coefficients["R"]
    named += [("K", 0, first), *(("B", 2 * j, -v) for j, v in enumerate(rest))]
    largest = {
        name: max(float(np.max(np.abs(v))) * high**p for n, p, v in named if n == name)
        for name in ("M", "A", "K", "B")
    }
    terms = []
    for name, power, values in named:
        # Small beside the largest of its kind at the highest speed, a harmonic does not count.
        top = float(np.max(np.abs(values))) * high**power
        noise = _NOISE * largest[name] / top if top else 1.0
        terms.append(Term(name, None, interpolated(values, period, noise), power=power))
    return terms


def _damping(
    system: LinearPeriodic, frames: Frames, speed: float, changed: Mapping[str, float]
) -> list[Term]:
    """Return the damping of the slow modes, without what the fast ones add by following."""
    sums: dict[str, Array] = {}
    basis, slope = (values[..., : frames.modes] for values in (frames.basis, frames.slope))
    for array in DAMPING:
        values = np.asarray(system.array(array, frames.theta, speed, **changed))
        for name, part in projections(array, values, basis, slope):
            sums[name] = sums[name] + part if name in sums else part
    return [
        Term(name, None, interpolated(values, system.period))
        for name, values in sums.items()
        if np.any(values)
    ]
