"""Characteristic exponents of the lowest modes of stiff periodic systems."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.collocation import gauss_maps
from ...core.errors import BadInput, bad
from ...core.families import LinearPeriodic
from ...core.results import Check, provenance
from ...core.trigonometric import even_angles
from .. import FloquetMultipliers
from ..equation import at_geometry
from ..first_order import CanonicalForm, canonical_form
from ..multipliers import conditions
from ..signatures import signatures_of
from ..transition import product
from .blocks import Slow, slow_part, symplectic_unit
from .fourier import PeriodicSeries
from .frames import Frames, gap_choices, held_modes, moving_frames

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Whole = NDArray[np.int64]

_EPS = float(np.finfo(float).eps)
# Gap above the slow modes, in turns a period, from which decoupling is worth a try.
_WORTH = 20.0
_PHASE = 3.0
# Nodes of the collocation.
_STAGES = 8
_STATIONS = 16
_MOST_SEGMENTS = 2**16
_BLOCK_FLOATS = 4_000_000
_USUAL = 4


@dataclass(frozen=True, kw_only=True)
class SlowMultipliers(FloquetMultipliers):
    """Floquet multipliers of the lowest modes of a stiff system.

    As :class:`FloquetMultipliers`, of m = ``count`` modes: all arrays over multipliers have the
    length 2m, two to a mode.  ``stable`` speaks of these modes alone.

    Attributes
    ----------
    mode : ndarray of int
        Mode of each multiplier, from 1, by rising ``frequency``; shape ``(*batch, 2m)``.  Where
        two modes share a motion the number is a matter of words.
    frequency : ndarray
        Mean frequency of each motion [rad/s]: twice its mean energy over its mean action; shape
        ``(*batch, 2m)``.
    retained : ndarray of int
        Number of modes that were integrated, the others following them; shape ``batch``.
    """

    mode: Whole
    frequency: Array
    retained: Whole

    exported: ClassVar[tuple[str, ...]] = ("stable", "growth")


def characteristic_exponents(
    system: LinearPeriodic,
    speed: ArrayLike,
    count: int | None = None,
    *,
    rtol: float = 1e-9,
    **parameters: float,
) -> SlowMultipliers:
    """Return the exponents and multipliers of the lowest modes, of stiff systems too.

    The modes far above do not have to be resolved: they are decoupled, exactly but for a residual
    that is measured, by a moving basis and a Riccati equation, and the rest is integrated as
    :func:`monodromy` does.  The least number of modes is kept that leaves the residual below
    ``rtol``; all of them where no gap of the frequencies is wide enough for the speed.

    Parameters
    ----------
    system : LinearPeriodic
        Of any size, damped or not; forcing plays no part.
    speed : array_like
        Crank speeds [rad/s], positive; functions of angle are shared by all.
    count : int, optional
        Number of modes wanted, the lowest; 4 by default, or all of fewer.
    rtol : float
        Wanted error of the multipliers' matrix, 1e-12 to 1e-2.
    **parameters : float
        Parameter values that replace the system's own, one number each; geometry too.

    Returns
    -------
    SlowMultipliers
        Its checks: ``decoupled``, the change that the residual makes, against ``rtol``;
        ``converged``, the error of the integration; ``symplectic`` where conservative; ``fast``,
        the largest mean growth of a mode left out, as if held, per radian.

    Raises
    ------
    BadInput
        If an argument is unusable or no number of segments up to 65536 suffices.
    """
    return SlowModes(system, parameters).exponents(speed, count, rtol=rtol)


class SlowModes:
    """The lowest modes of one system, whose moving bases are made once for all speeds.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    parameters : mapping
        Parameter values that replace the system's own, one number each; geometry too.

    Raises
    ------
    BadInput
        If a parameter is not one number or unknown.
    """

    def __init__(self, system: LinearPeriodic, parameters: Mapping[str, float]) -> None:
        for name, value in parameters.items():
            if np.ndim(value):
                raise bad(name, value, "one number", "call once for each value")
        self._system, self._changed = at_geometry(system, dict(parameters))
        self._store: _FrameStore | None = None

    def highest_frequency(self, speed: float, count: int | None = None) -> float:
        """Return the highest frequency of the wanted modes, crank held, at any angle [rad/s]."""
        wanted = self.wanted(count)
        if self._store is None:
            self._store = _FrameStore(canonical_form(self._system, speed, self._changed))
        return self._store.highest(wanted)

    @property
    def system(self) -> LinearPeriodic:
        """The system at the given parameter values."""
        own = {k: float(np.asarray(v)) for k, v in self._changed.items()}
        return self._system.with_parameters(**own) if own else self._system

    def wanted(self, count: int | None) -> int:
        """Return the number of modes wanted, refused where there are not as many."""
        n = self._system.size
        wanted = min(n, _USUAL) if count is None else int(count)
        if count is not None and (wanted != count or not 1 <= wanted <= n):
            raise bad("count", count, f"a whole number from 1 to {n}", "correct it")
        return wanted

    def exponents(
        self, speed: ArrayLike, count: int | None = None, *, rtol: float = 1e-9
    ) -> SlowMultipliers:
        """Return what :func:`characteristic_exponents` does."""
        system = self._system
        wanted = self.wanted(count)
        form, found = self._found(speed, wanted, rtol)
        shape, m = form.batch, 2 * wanted
        rows = [_lowest(one, form.conservative, wanted) for one in found]
        columns = [np.array([row[i] for row in rows]).reshape(*shape, m) for i in range(5)]
        logarithm, angle, error, level, signs = columns
        turning = np.where(np.abs(angle) == np.pi, 0.0, np.sin(angle))
        return SlowMultipliers(
            method=f"slow modes decoupled, Gauss-Legendre collocation of order {2 * _STAGES}",
            error=error,
            error_norm="absolute, of each multiplier",
            checks=_checks(found, rtol, form.conservative),
            provenance=provenance(system.changed_provenance(**self._changed)),
            speed=form.speed.reshape(shape),
            multipliers=np.exp(logarithm) * (np.cos(angle) + 1j * turning),
            exponents=logarithm + 1j * angle,
            period=system.period,
            signatures=signs.astype(np.int8),
            mode=np.broadcast_to(np.arange(m) // 2 + 1, (*shape, m)),
            frequency=level * form.speed.reshape(*shape, 1),
            retained=np.array([one.modes for one in found], dtype=np.int64).reshape(shape),
        )

    def motions(self, speed: float, count: int, *, rtol: float = 1e-9) -> SlowMonodromy:
        """Return the monodromy matrix of the slow part at one speed, with its ``states``.

        It holds at least ``count`` modes.

        Raises
        ------
        BadInput
            As :func:`characteristic_exponents`.
        """
        return self._found(speed, self.wanted(count), rtol, kept=True)[1][0]

    def _found(
        self, speed: ArrayLike, wanted: int, rtol: float, *, kept: bool = False
    ) -> tuple[CanonicalForm, list[SlowMonodromy]]:
        if not 1e-12 <= rtol <= 1e-2:
            raise bad("rtol", rtol, "a number from 1e-12 to 1e-2", "choose 1e-9")
        form = canonical_form(self._system, speed, self._changed)
        if self._store is None and len(form.speed):
            self._store = _FrameStore(form)
        return form, [
            _best(form, self._store, row, wanted, rtol, kept=kept)
            for row in range(len(form.speed))
            if self._store is not None
        ]


@dataclass(frozen=True)
class SlowMonodromy:
    """Monodromy matrix of the slow part at one speed.

    Attributes
    ----------
    matrix : ndarray
        Of the canonical slow coordinates, shape ``(2k, 2k)``.
    stations : ndarray
        Transition matrices from 0 to even angles, ``(ns, 2k, 2k)``.
    levels : ndarray
        Energy forms -J G there, symmetric parts, ``(ns, 2k, 2k)``.
    modes : int
        k.
    segments : int
        Collocation segments.
    integration, residual, rounding : float
        Parts of the error of the matrix, over its largest entry.
    drift : float
        Largest mean growth of the modes left out, crank held, per radian.
    states : ndarray or None
        (q, M q') of the canonical slow coordinates at those angles, ``(ns, 2n, 2k)``, where asked
        for.
    """

    matrix: Array
    stations: Array
    levels: Array
    modes: int
    segments: int
    integration: float
    residual: float
    rounding: float
    drift: float
    states: Array | None = None

    @property
    def error(self) -> float:
        """Largest error of an entry over the largest entry."""
        return min(self.integration + self.residual + self.rounding, 1.0)


class _FrameStore:
    """Moving bases by number of modes, made when first wanted; None where there is none."""

    def __init__(self, form: CanonicalForm) -> None:
        self._form = form.take(slice(0, 1))
        theta = even_angles(form.system.period, 256)
        self._frequency = held_modes(form, theta)[0]
        self._made: dict[int, Frames | None] = {}
        self._shared = all(term.power == 0 for term in form.system.terms if term.array == "M")

    def highest(self, k: int) -> float:
        """Return the highest of the k lowest frequencies at any angle [rad/s]."""
        return float(np.max(self._frequency[:, k - 1]))

    def choices(self, wanted: int, speed: float) -> list[int]:
        """Return numbers of modes worth a try at a speed, rising, all of them last."""
        turn = 2 * np.pi / self._form.system.period
        gaps = gap_choices(self._frequency, wanted)
        worth = [k for k, gap in gaps if gap > _WORTH * turn * speed]
        return [*worth, self._frequency.shape[1]]

    def at(self, k: int, own: CanonicalForm) -> Frames | None:
        """Return the basis for k slow modes; of one speed where the mass depends on it."""
        if k in self._made:
            return self._made[k]
        frames: Frames | None = None
        try:
            frames = moving_frames(self._form if self._shared else own, k)
        except BadInput:
            if k == own.system.size:
                raise
        if self._shared:
            self._made[k] = frames
        return frames


def _best(
    form: CanonicalForm,
    store: _FrameStore,
    row: int,
    wanted: int,
    rtol: float,
    *,
    kept: bool = False,
) -> SlowMonodromy:
    """Return the monodromy matrix with the fewest modes that decouple well enough."""
    own = form.take(slice(row, row + 1))
    speed, period = float(own.speed[0]), form.system.period
    last: SlowMonodromy | None = None
    for k in store.choices(wanted, speed):
        frames = store.at(k, own)
        if frames is None:
            continue
        slow = slow_part(own, frames)
        rate = store.highest(k) / speed
        last = integrated(slow, k, period, rate, rtol)
        if last.residual > 0.3 * rtol:
            left = decoupling_error(slow, last, period)
            last = replace(last, residual=left)
        if kept:
            last = replace(last, states=_states(own, frames, slow))
        if last.residual <= 0.3 * rtol:
            return last
    if last is None:
        raise bad("system", "no basis of its modes", "a regular mass and stiffness", "check them")
    return last


def _states(form: CanonicalForm, frames: Frames, slow: Slow) -> Array:
    """Return (q, M q') of the canonical slow coordinates at the stations, ``(ns, 2n, 2k)``."""
    every = slice(None, None, len(frames.theta) // _STATIONS)
    theta, basis, n = frames.theta[every], frames.basis[every], frames.basis.shape[-1]
    mass = form.require_mass(form.assemble("M", theta))[0]
    scale, embedding = slow.scale[0][:, None], slow.embedding[0, every]
    place = basis @ (scale * embedding[:, :n])
    # The momentum goes with the inverse of the transpose of the basis, which is M times the basis.
    momentum = mass @ basis @ (embedding[:, n:] / scale)
    gyro = form.assemble("A", theta)
    return np.concatenate([place, momentum if gyro is None else momentum - gyro[0] @ place], axis=1)


def decoupling_error(slow: Slow, found: SlowMonodromy, period: float) -> float:
    """Return the error of the matrix by incomplete decoupling: what the last pass changed.

    The multipliers of the last pass but one, whose error is larger, are compared, each divided by
    its condition number.  Where the first pass made it worse already there is nothing to compare
    with, and the error is 1.
    """
    if not slow.passes[0]:
        return 1.0
    series = PeriodicSeries.of(slow.before[0], period)
    coarse = np.linalg.eigvals(_stations(series, found.segments, period)[-1])
    values, vectors = np.linalg.eig(found.matrix)
    gap = np.min(np.abs(values[:, None] - coarse), axis=1)
    own = conditions(vectors.astype(complex)[None])[0]
    top = max(float(np.max(np.abs(found.matrix))), 1e-300)
    return float(np.max(gap / np.where(np.isfinite(own), own, 1.0))) / top


def integrated(slow: Slow, k: int, period: float, rate: float, rtol: float) -> SlowMonodromy:
    """Return the monodromy matrix of one slow part, the segments doubled until it rests."""
    generator = PeriodicSeries.of(slow.generator[0], period)
    number = _STATIONS
    while number < max(rate * period / _PHASE, generator.reach / 4):
        number *= 2
    before = _stations(generator, number, period)
    last = 1.0
    while True:
        number *= 2
        fine = _stations(generator, number, period)
        top = float(np.max(np.abs(fine[-1])))
        change = float(np.max(np.abs(fine[-1] - before[-1]))) / top
        gain = float(np.clip(change / last, 1e-3, 1.0)) if change < 1e-3 else 1.0
        stuck = change > 0.25 * last and change < 1e-3
        error = 2 * change if stuck else change * gain
        if error <= 0.3 * rtol or stuck or 2 * number > _MOST_SEGMENTS:
            break
        before, last = fine, change
    levels = -symplectic_unit(k) @ slow.generator[0, :: max(1, len(slow.generator[0]) // _STATIONS)]
    return SlowMonodromy(
        matrix=fine[-1],
        stations=fine[:-1],
        levels=0.5 * (levels + np.swapaxes(levels, -1, -2)),
        modes=k,
        segments=number,
        integration=error,
        residual=slow.change(period),
        rounding=period * float(slow.rounding[0]) + _EPS * (8.0 + 0.5 * number),
        drift=float(slow.drift[0]),
    )


def _stations(series: PeriodicSeries, segments: int, period: float) -> Array:
    """Return the transition matrices from 0 to even angles, the period's end among them."""
    step = period / segments
    each = segments // _STATIONS
    m = series.shape[-1]

    def generator(theta: Array) -> Array:
        return series(theta)[None]

    stretch = max(1, _BLOCK_FLOATS // (_STAGES * m) ** 2)
    whole = np.eye(m)
    rows = [whole]
    for station in range(_STATIONS):
        for left in range(0, each, stretch):
            first = station * each + left
            angles = step * np.arange(first, first + min(stretch, each - left), dtype=float)
            turned, power = product(gauss_maps(_STAGES, generator, angles, step))
            whole = np.ldexp(turned[0], power[0]) @ whole
        rows.append(whole)
    return np.stack(rows)


def _spectrum(matrices: Array, error: Array) -> tuple[Array, Array, Array]:
    """Return log modulus, argument and log error of the eigenvalues of matrices."""
    m = matrices.shape[-1]
    values, vectors = np.linalg.eig(matrices)
    values = values.astype(complex)
    condition = conditions(vectors)
    norm = np.linalg.norm(matrices, axis=(-2, -1))[:, None]
    top = np.max(np.abs(matrices), axis=(-2, -1))[:, None]
    shift = m * error[:, None] * top + 4 * m * _EPS * norm
    # Near a double eigenvalue the condition number explodes and the square root holds; near an
    # r-fold one the r-th root.
    radius = 2 * np.sqrt(norm * shift)
    distance = np.abs(values[:, :, None] - values[:, None, :])
    near = np.sum(distance <= radius[..., None], axis=-1)
    root = 2 * norm * (shift / norm) ** (1 / np.maximum(near, 2))
    uncertain = np.minimum(condition * shift, root)
    with np.errstate(divide="ignore"):
        logarithm = np.log(np.abs(values))
    return logarithm, np.angle(values), np.log(uncertain)


def _lowest(
    one: SlowMonodromy, conservative: bool, wanted: int
) -> tuple[Array, Array, Array, Array, Array]:
    """Return logarithm, argument, error, level and signature of the lowest modes' multipliers."""
    matrix = one.matrix[None]
    logarithm, angle, error = (values[0] for values in _spectrum(matrix, np.array([one.error])))
    values, vectors = np.linalg.eig(one.matrix)
    motion = one.stations @ vectors
    motion = motion / np.linalg.norm(motion, axis=1, keepdims=True)
    level = np.mean(np.real(np.einsum("sia,sij,sja->sa", motion.conj(), one.levels, motion)), 0)
    order = np.lexsort((-np.sign(angle), np.round(np.abs(angle), 9), np.round(level, 6)))
    order = order[: 2 * wanted]
    signs = np.zeros(len(values))
    if conservative:
        known = signatures_of(
            vectors[None].astype(complex), values[None].astype(complex), np.exp(error)[None]
        )
        signs = known[0].astype(float)
    return logarithm[order], angle[order], np.exp(error[order]), level[order], signs[order]


def _checks(found: list[SlowMonodromy], rtol: float, conservative: bool) -> Mapping[str, Check]:
    """Return the worst of a batch."""
    if not found:
        return {}
    checks = {
        "decoupled": Check(max(one.residual for one in found), rtol),
        "converged": Check(
            max(one.integration for one in found),
            max(rtol, *(100 * one.rounding for one in found)),
        ),
        "fast": Check(max(0.0, *(one.drift for one in found)), 1e-12),
    }
    if conservative:
        defects, limits = [], []
        for one in found:
            unit = symplectic_unit(one.modes)
            gap = one.matrix.T @ unit @ one.matrix - unit
            defects.append(float(np.linalg.norm(gap) / np.linalg.norm(one.matrix) ** 2))
            limits.append(16 * one.modes * max(one.rounding, 64 * _EPS))
        worst = int(np.argmax(np.array(defects) / np.array(limits)))
        checks["symplectic"] = Check(defects[worst], limits[worst])
    return checks
