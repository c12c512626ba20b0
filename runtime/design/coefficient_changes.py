"""How the coefficients of a linear periodic system change with the numbers it is made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import Problem, bad, refuse
from ..core.families import Array, LinearPeriodic
from ..core.inputs import names_in_a_row
from ..periodic.adjoint import FieldWeights
from ..periodic.equation import FIELD, SPEED_POWER, sampled, waves
from ..scenes import Scene, with_numbers
from ..systems.closed_form import ClosedForm, closed_form

ComplexArray = NDArray[np.complex128]
# An array of the equation, and the extra power of the speed that a part of it carries.
Part = tuple[str, int]
Parts = dict[Part, Array]

SPEED = "speed"
PLACES = np.arange(-4.0, 5.0)
# Steps of the differences over the number: of parameters, in which coefficients are quotients of
# polynomials, and of others, which may be close to lengths that do not assemble.  Of a number that
# is 0 they are steps in its SI unit.
STEP, SMALL_STEP = 1e-2, 2e-3
# Steps off the real axis over the number; round-off of a derivative by them, over the largest (of
# 40 random couplers, some near a fold, the worst was off by 169 eps against 300 bits).
_IMAGINARY, _ROUNDED, _EPS = 1e-40, 256.0 * float(np.finfo(float).eps), float(np.finfo(float).eps)


class Effect(NamedTuple):
    """Derivatives of functionals by the numbers, ``(nb, functionals, k)``, and by the speed."""

    slope: ComplexArray
    error: Array  # by the derivatives of the coefficients
    bulk: Array  # what its parts would sum up to if they all had one sign
    by_speed: ComplexArray  # (nb, functionals)


@dataclass(frozen=True)
class Changes:
    """Fourier coefficients of the parts of the equation, and their derivatives by k numbers.

    Attributes
    ----------
    by : tuple of str
        Names of the numbers.
    number, step, doubt : ndarray
        Their values, shape ``(k,)``; steps by which coefficients are subtracted from each other,
        infinite where they are not; round-off over the derivatives there.
    parts : mapping
        By part, coefficients in the order of :func:`~.periodic.equation.waves`, ``(2 H + 1, ...)``.
    slopes, rough : mapping
        Derivatives by the numbers, ``(k, 2 H + 1, ...)``, of orders eight and six.
    harmonics : int
        Number H of harmonics.
    period : float
        Period [rad].
    """

    by: tuple[str, ...]
    number: Array
    step: Array
    doubt: Array
    parts: Mapping[Part, Array]
    slopes: Mapping[Part, Array]
    rough: Mapping[Part, Array]
    harmonics: int
    period: float

    def effect(self, weights: FieldWeights, speed: Array) -> Effect:
        """Return what the numbers do to functionals of members at speeds ``(nb,)``."""
        shape = (*weights.shape, len(self.by))
        total, by_speed = np.zeros(shape, dtype=complex), np.zeros(weights.shape, dtype=complex)
        error, bulk = np.zeros(shape), np.zeros(shape)
        table = self.table(weights.angles)
        fields = {FIELD[array][0] for array, _ in self._moving}
        sizes = {field: weights.sizes(field) for field in fields & set(weights.fields)}
        for part, (series, moving, change, off) in self._moving.items():
            field, sign = FIELD[part[0]]
            if field not in sizes:
                continue
            power = SPEED_POWER[part[0]] + part[1]
            pace = sign * speed[:, None] ** power
            waved = table[: 1 if series.shape[1] == 1 else None, : series.shape[1]]
            values = np.tensordot(series, waved, axes=(1, 1))
            found = weights.effect(field, values)
            if power:
                by_speed += power * pace / speed[:, None] * found[0]
            total[..., moving] += pace[..., None] * np.moveaxis(found[1:], 0, -1)
            # What is told of a sum's terms by their largest coefficient.
            largest = np.max(np.abs(values[0]), axis=-1).ravel()
            size = (np.abs(pace) * (sizes[field] @ largest))[..., None]
            bulk += size * change
            error += size * off
        fast = [i for i, name in enumerate(self.by) if name == SPEED]
        total[..., fast] = by_speed[..., None]
        bulk[..., fast] = np.abs(by_speed)[..., None]
        return Effect(total, error, bulk, by_speed)

    @cached_property
    def _moving(self) -> Mapping[Part, tuple[Array, NDArray[np.intp], Array, Array]]:
        """What moves with the numbers, by part.

        The coefficients, one of what is constant, then their derivatives that are not zero; by
        which numbers these are; by all numbers the largest derivative of a coefficient over the
        largest one, and its error.
        """
        found = {}
        for part, series in self.parts.items():
            top, slopes = float(_largest(series[None])[0]) or 1.0, self.slopes[part]
            change = _largest(slopes) / top
            moving, off = np.flatnonzero(change), np.zeros(len(change))
            gap = _largest(slopes[moving] - self.rough[part][moving])
            off[moving] = (gap + _largest(self.round_off(part, moving))) / top
            both = np.concatenate([series[None], slopes[moving]])
            found[part] = both if np.any(both[:, 1:]) else both[:, :1], moving, change, off
        return found

    def round_off(self, part: Part, places: NDArray[np.intp]) -> Array:
        """Return bounds of the round-off of a part's derivatives by some numbers, by their places.

        They are shaped as ``slopes``.
        """
        slopes, series = self.slopes[part][places], self.parts[part]
        step, doubt = (
            one[places].reshape(-1, *(1,) * series.ndim) for one in (self.step, self.doubt)
        )
        subtracted = np.abs(np.where(slopes, series, 0.0)) * (_EPS / step)
        return np.asarray(subtracted + doubt * np.abs(slopes))

    def table(self, angles: Array) -> Array:
        """Return the waves of the coefficients at angles [rad]."""
        return waves(self.harmonics, angles * (2.0 * np.pi / self.period))


def _largest(series: Array) -> Array:
    """Return the largest size of the coefficients of each of some series."""
    return np.asarray(np.max(np.abs(series), axis=tuple(range(1, series.ndim)), initial=0.0))


def series_at(table: Array, series: Array) -> Array:
    """Return sums of Fourier series ``(2 H + 1, ...)`` where the waves are ``(nt, 2 H + 1)``."""
    return np.asarray(np.tensordot(table, series, axes=1))


def coefficient_changes(
    machine: LinearPeriodic | Scene,
    system: LinearPeriodic,
    by: Sequence[str],
    held: Mapping[str, float] | None = None,
) -> Changes:
    """Return the derivatives of the coefficients of a system, by numbers of the machine.

    The system may differ from the machine's in parameters that are ``held``.  The numbers are
    ``speed``, names of parameters and of geometry of the system, and dotted keys where the machine
    is a scene.  Coefficients of couplers and of Hill's equation are differentiated by a step off
    the real axis, others by differences of eighth order, good to some 1e-13.
    """
    names = checked_names(machine, [SPEED, *system.parameters, *system.geometry], by)
    theta = _even_angles(system)
    terms = _terms(system, theta)
    scales = system.scales(system.parameters)
    parts = _parts(terms, scales)
    closed = closed_form(machine) if isinstance(machine, Scene) else None
    slopes = {part: np.zeros((len(names), *series.shape)) for part, series in parts.items()}
    rough = {part: zeros.copy() for part, zeros in slopes.items()}
    number, steps = np.ones(len(names)), np.full(len(names), np.inf)
    doubt = np.full(len(names), _ROUNDED)
    for i, name in enumerate(names):
        if name == SPEED:
            continue
        inner = name in system.parameters
        number[i] = value = number_of(machine, system, name)
        if closed is not None and not inner:
            assert isinstance(machine, Scene)
            for part, series in _complex_step(closed, machine, name, held or {}, theta).items():
                slopes[part][i] = rough[part][i] = series
            continue
        places, step, both = differences(value, STEP if inner else SMALL_STEP, below=inner)
        values = value + step * places
        if inner:
            # Not within its limits: a damping that is 0 goes below.
            others = system.scales({**system.parameters, name: values})
            mixed = {key: value for key, value in others.items() if np.ndim(value)}
            changed = [row for row in terms if row[1] in mixed]
            for weights, target in zip(both, (slopes, rough), strict=True):
                change = {key: weights @ (value - scales[key]) for key, value in mixed.items()}
                most = [abs(scales[k] / one) for k, one in change.items() if one]
                # Monomials err by a few round-offs.
                doubt[i] = 4.0 * _EPS / step * max(most, default=0.0)
                for part, series in _parts(changed, change).items():
                    target[part][i] = series
            continue
        steps[i], doubt[i] = step, 0.0
        made = [with_number(machine, system, name, float(one)) for one in values]
        made = [one.with_parameters(**(held or {})) for one in made]
        each = [_parts(_terms(one, theta), one.scales(one.parameters)) for one in made]
        for part, series in parts.items():
            moved = np.stack([other[part] for other in each]) - series
            for weights, target in zip(both, (slopes, rough), strict=True):
                target[part][i] = np.tensordot(weights, moved, axes=1)
    harmonics = len(theta) // 2 - 1
    return Changes(names, number, steps, doubt, parts, slopes, rough, harmonics, system.period)


def _complex_step(
    closed: ClosedForm, scene: Scene, name: str, held: Mapping[str, float], theta: Array
) -> Parts:
    """Return derivatives of the parts that change with a number of a scene.

    By a step off the real axis (Squire and Trapp 1998): nothing is subtracted.
    """
    value = scene.get(name)
    step = _IMAGINARY * (abs(value) or 1.0)
    moved = with_numbers(scene, {name: complex(value, step)}, checked=False)
    arrays = closed.arrays({**closed.numbers(moved), **held}, theta, SPEED_POWER)
    return {
        part: _series(np.broadcast_to(found.imag / step, (len(theta), *found.shape[1:])))
        for part, found in arrays.items()
        if np.iscomplexobj(found)
    }


def varying_parts(system: LinearPeriodic) -> Changes:
    """Return what the varying part of each array of the equation does, by the arrays' names."""
    theta = _even_angles(system)
    parts = _parts(_terms(system, theta), system.scales(system.parameters))
    names = tuple(dict.fromkeys(array for array, _ in parts))
    slopes = {}
    for (array, power), series in parts.items():
        own = (np.array(names) == array).reshape(-1, *(1,) * series.ndim)
        slopes[array, power] = own * np.concatenate([0.0 * series[:1], series[1:]])
    ones, harmonics = np.ones(len(names)), len(theta) // 2 - 1
    return Changes(names, ones, ones, 0.0 * ones, parts, slopes, slopes, harmonics, system.period)


def _even_angles(system: LinearPeriodic) -> Array:
    """Return angles [rad] that see all harmonics of the coefficients."""
    harmonics = sampled(system, forcing=True).harmonics
    if harmonics < 0:
        found, expected = "coefficients that are not smooth", "smooth functions of the angle"
        raise bad("sensitivities", found, expected, "round off their corners")
    count = max(64, 4 * (harmonics // 2 + 1))
    return np.asarray(system.period * np.arange(float(count)) / count)


def moved_systems(
    machine: LinearPeriodic | Scene, system: LinearPeriodic, name: str, speed: float
) -> tuple[list[tuple[LinearPeriodic, float]], tuple[Array, Array]]:
    """Return the system with other values of a number, each with its speed; weights of orders.

    The sums of what these tell by the weights are derivatives by the number, see
    :func:`differences`.
    """
    inner = name in (SPEED, *system.parameters)
    value = speed if name == SPEED else number_of(machine, system, name)
    places, step, weights = differences(value, STEP if inner else SMALL_STEP)
    values = (value + step * places).tolist()
    if name == SPEED:
        return [(system, one) for one in values], weights
    return [(with_number(machine, system, name, one), speed) for one in values], weights


def differences(
    value: float, part: float = SMALL_STEP, *, size: float = 1.0, below: bool = False
) -> tuple[Array, float, tuple[Array, Array]]:
    """Return places about a number, their step, and weights of the orders eight and six there.

    The step is a part of the number.  One that is 0 counts as of a size, and has places above it
    alone, unless ``below``.
    """
    places = PLACES if value or below else PLACES - PLACES[0]
    step = part * (abs(value) or size)
    fine, coarse = (difference_weights(tuple(places), unused) / step for unused in (0, 1))
    return places, step, (fine, coarse)


@cache
def difference_weights(places: tuple[float, ...], unused: int) -> Array:
    """Return the weights of values at places in the derivative at 0, some at either end unused."""
    used = np.array(places[unused : len(places) - unused])
    powers = np.vander(used, increasing=True).T
    return np.pad(np.linalg.solve(powers, np.eye(len(used))[1]), unused)


def number_of(machine: LinearPeriodic | Scene, system: LinearPeriodic, name: str) -> float:
    """Return a number by its name."""
    for known in (system.parameters, system.geometry):
        if name in known:
            return float(known[name])
    assert isinstance(machine, Scene)
    return float(machine.get(name))


def with_number(
    machine: LinearPeriodic | Scene, system: LinearPeriodic, name: str, value: float
) -> LinearPeriodic:
    """Return the system with another value of a number."""
    if name in system.parameters:
        return system.with_parameters(**{name: value})
    if name in system.geometry:
        return system.with_geometry(**{name: value})
    assert isinstance(machine, Scene)
    return with_numbers(machine, {name: value}).linear_system()


# A part, the monomial that multiplies it, and its Fourier coefficients.
_Terms = list[tuple[Part, str | None, Array]]


def _terms(system: LinearPeriodic, theta: Array) -> _Terms:
    """Return the terms of the equation by their Fourier coefficients; the next call finds them."""
    key = ("Fourier coefficients", len(theta))
    if key not in system.kept:
        found: _Terms = []
        for term in system.terms:
            if term.array in SPEED_POWER:
                found.append(((term.array, term.power), term.scale, _series(term(theta))))
        system.kept[key] = found
    terms: _Terms = system.kept[key]
    return terms


def _series(values: Array) -> Array:
    """Return the Fourier coefficients of values at even angles, which come first."""
    table = np.fft.rfft(values, axis=0)[: len(values) // 2] / len(values)
    waved = 2.0 * table[1:]
    return np.concatenate([table[:1].real, waved.real, -waved.imag])


def _parts(terms: _Terms, scales: Mapping[str, Array]) -> Parts:
    """Return the Fourier coefficients of the parts of the equation, for values of the monomials."""
    parts: Parts = {}
    for part, scale, series in terms:
        value = series if scale is None else scales[scale] * series
        parts[part] = parts[part] + value if part in parts else value
    return parts


def checked_names(machine: object, known: Sequence[str], by: Sequence[str]) -> tuple[str, ...]:
    """Return names of numbers: known ones, or dotted keys where the machine is a scene."""
    names = names_in_a_row("by", by)
    problems = []
    for name in names:
        if name in known:
            continue
        value: Any = machine.given if isinstance(machine, Scene) and "." in name else None
        for key in name.split("."):
            value = value.get(key) if isinstance(value, Mapping) else None
        if not isinstance(value, float):
            expected = f"one of {list(known)}"
            expected += ", or a key that the scene gives a number" * isinstance(machine, Scene)
            problems.append(Problem("by", repr(name), expected, "correct the name"))
    if not names or len(set(names)) < len(names):
        problems.append(Problem("by", repr(names), "different names, at least one", "mend it"))
    refuse(problems)
    return names
