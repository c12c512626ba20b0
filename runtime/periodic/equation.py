"""The equation of a linear periodic system at given speeds, sampled once over the period.

The state is (q, p) with p = M q' + A q and the crank angle as variable, so that no derivative of a
coefficient occurs and the flow is symplectic where the system is undamped:

    p' = (A^T - C/w) q' + N q + F,   N = B - D/w - (K + Kg)/w^2,   F = f + h/w + p_ext/w^2.

Every array is a sum of terms, factor times function of angle.  The functions are sampled at even
angles until their Fourier series have ended, and interpolated from there: however many segments,
speeds or refinements follow, no function is evaluated again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, bad
from ..core.families import Array, LinearPeriodic, Term, require_system
from ..core.inputs import numbers
from ..core.trigonometric import BETWEEN

# Power of the speed that an array carries once d/dt = speed * d/dtheta and the equation has been
# divided by speed^2; S and g act only when the crank accelerates.
SPEED_POWER = {
    **{"M": 0, "A": 0, "B": 0, "C": -1, "D": -1, "K": -2, "Kg": -2},
    **{"f": 0, "h": -1, "p": -2},
}
# The field of the equation that an array belongs to, and its sign there.
FIELD = {
    **{"M": ("mass", 1.0), "A": ("gyroscopic", 1.0), "C": ("damping", 1.0)},
    **{"B": ("stiffness", 1.0), "D": ("stiffness", -1.0), "K": ("stiffness", -1.0)},
    **{"Kg": ("stiffness", -1.0), "f": ("force", 1.0), "h": ("force", 1.0), "p": ("force", 1.0)},
}
# Even angles to begin with, by the number of coordinates up to which, so that a narrow wave of a
# small system is seen; and at the most.  A Fourier series has ended where its last quarter is
# below the first bound, or as large as the quarter before and below the second: round-off.
_FIRST, _MOST = {4: 256, 12: 192}, 4096
_FEWEST = 64
_ENDED, _ROUNDING = 16.0 * float(np.finfo(float).eps), 1e-12
# Amplitude over the largest from which the nodes of a method have to see a harmonic.
_SEEN = 1e-6
# Places of the period at which frozen modes are computed, and the most members times modes cubed
# for which each member has its own; angles whose waves are kept.
_PLACES, _EACH, _KEPT = 8, 2_000_000, 1024


@dataclass(frozen=True)
class Field:
    """One array of the equation for all members: constant part, and varying terms by factor."""

    constant: Array | None  # shape (nb, n, n), or (nb, n) for the force
    factors: Array  # of the varying terms, shape (nb, k)
    # Fourier coefficients of the varying terms, as waves multiplies them, shape (k, 2 H + 1, n, n).
    series: Array
    terms: tuple[Term, ...]  # the varying terms themselves

    def take(self, members: slice | NDArray[np.intp]) -> Field:
        """Return the field of some members."""
        constant = None if self.constant is None else self.constant[members]
        return replace(self, constant=constant, factors=self.factors[members])

    def at(self, table: Array | None, angles: Array) -> Array:
        """Return the field at angles [rad], shape ``(nb, nt, ...)``; nt is 1 where it is constant.

        ``table`` holds :func:`waves` at the angles, ``(nt, 2 H + 1)``; without it the terms, which
        are not smooth, are evaluated anew.
        """
        if not self.terms:
            return cast(Array, self.constant)[:, None]
        count, places, nb = len(self.terms), len(angles), len(self.factors)
        if table is None:
            values = np.stack([term(angles) for term in self.terms])
            shape = values.shape[2:]
            total = self.factors @ values.reshape(count, -1)
        else:
            shape, used = self.series.shape[2:], self.series.shape[1]
            series = self.series.reshape(count, -1)
            if nb <= count:
                mixed = (self.factors @ series).reshape(nb, used, -1)
                total = table[:, :used] @ mixed
            else:
                values = table[:, :used] @ series.reshape(count, used, -1)
                total = self.factors @ values.reshape(count, -1)
        out: Array = total.reshape(nb, places, *shape)
        if self.constant is not None:
            out += self.constant[:, None]
        return out

    def mean(self) -> Array:
        """Return the mean over the period, shape ``(nb, ...)``."""
        if not self.terms:
            return cast(Array, self.constant)
        first = self.series[:, 0]
        value: Array = (self.factors @ first.reshape(len(first), -1)).reshape(-1, *first.shape[1:])
        return value if self.constant is None else value + self.constant


@dataclass(frozen=True)
class Equation:
    """The equation of a batch of members: one system at speeds and parameter values.

    Make it with :func:`equation_of`.  Inside it the batch is flat.
    """

    system: LinearPeriodic
    speed: Array  # crank speeds [rad/s], shape (nb,)
    batch: tuple[int, ...]  # shape of the batch seen from outside
    # mass, gyroscopic, damping, stiffness, force: those that are not zero.
    fields: Mapping[str, Field]
    # Harmonics H that the Fourier series of the terms have; -1 where these are not smooth.
    harmonics: int
    reach: int  # highest harmonic that the nodes of a method have to see
    # Unit of each coordinate, powers of two, (nb, n): q and p of an oscillator of the mean mass and
    # stiffness get like sizes in (q/scale, p scale), and no rounding is added.
    scale: Array
    # Of frozen modes, (nb, n): the largest frequency [1/rad] over the period, of the symmetric part
    # of the stiffness field beside the mass, and the mean decay of the amplitude in a period.  They
    # choose the number of segments; whether it was enough is seen afterwards.
    frequency: Array
    decay: Array
    fastest: Array  # the largest of their rates, (nb,)
    damped: bool  # whether something takes energy out or puts it in: damping, or forces that turn

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.system.size

    @property
    def period(self) -> float:
        """Period of the coefficients [rad]."""
        return self.system.period

    @property
    def rates(self) -> Array:
        """With which frozen modes turn or fall [1/rad], ``(nb, n)``: an overdamped one's larger."""
        loss = np.abs(self.decay) / self.period
        # The root of the difference of their squares, which may overflow.
        over = np.sqrt(np.maximum(loss - self.frequency, 0.0)) * np.sqrt(loss + self.frequency)
        return np.asarray(np.maximum(self.frequency, loss + over))

    @property
    def forced(self) -> bool:
        """True where a force acts."""
        return "force" in self.fields

    def take(self, members: slice | NDArray[np.intp]) -> Equation:
        """Return the equation of some members."""
        speed = self.speed[members]
        fields = {name: field.take(members) for name, field in self.fields.items()}
        return replace(
            self,
            speed=speed,
            batch=speed.shape,
            fields=fields,
            scale=self.scale[members],
            frequency=self.frequency[members],
            decay=self.decay[members],
            fastest=self.fastest[members],
        )

    def with_force_unit(self, unit: float) -> Equation:
        """Return the equation whose state has 1/unit for the 1 that the force acts on."""
        if not self.forced:
            return self
        force = self.fields["force"]
        constant = None if force.constant is None else unit * force.constant
        scaled = replace(force, constant=constant, factors=unit * force.factors)
        return replace(self, fields={**self.fields, "force": scaled})

    def with_slow_modes(self, most: float) -> Equation:
        """Return the equation whose segments suit modes of at most a frequency [1/rad]."""
        return replace(
            self, frequency=np.minimum(self.frequency, most), decay=np.zeros_like(self.decay)
        )

    def largest_force(self) -> Array:
        """Return the largest entry of the force, shape ``(nb,)``; 0 where none acts."""
        if not self.forced:
            return np.zeros(len(self.speed))
        values = self.at("force", self.even_angles())
        return np.asarray(np.max(np.abs(values), axis=(1, 2)))

    def even_angles(self) -> Array:
        """Return angles that divide the period evenly and see every harmonic, from 0 [rad]."""
        count = _MOST if self.harmonics < 0 else max(_FEWEST, 4 * (self.harmonics // 2 + 1))
        return self.period * np.arange(float(count)) / count

    def at(self, name: str, angles: Array, table: Array | None = None) -> Array:
        """Return a scaled field at angles [rad], shape ``(nb, nt, n, n)`` or ``(nb, nt, n)``.

        ``table`` holds :func:`waves` at these angles, where it is at hand.
        """
        if table is None and self.harmonics >= 0 and self.fields[name].terms:
            table = waves(self.harmonics, angles * (2 * np.pi / self.period))
        value = self.fields[name].at(table, angles)
        unit = self.scale[:, None, :]
        if name == "force":
            return value * unit
        return value * (unit[..., :, None] * unit[..., None, :])

    def slope(self, name: str, angles: Array) -> Array:
        """Return the derivative of a matrix field of the first member, ``(nt, n, n)``."""
        field, order = self.fields[name].take(slice(0, 1)), np.arange(1.0, self.harmonics + 1.0)
        table = waves(self.harmonics, angles * (2 * np.pi / self.period))
        cosines, sines = table[:, 1 : self.harmonics + 1], table[:, self.harmonics + 1 :]
        turned = np.concatenate([0.0 * table[:, :1], -order * sines, order * cosines], axis=1)
        turned *= 2 * np.pi / self.period
        if not field.terms:
            return np.zeros((len(angles), self.size, self.size))
        value = replace(field, constant=None).at(turned, angles)[0]
        unit = self.scale[0]
        return np.asarray(value * (unit[:, None] * unit))

    def mean(self, name: str) -> Array:
        """Return the mean of a field in scaled coordinates, ``(nb, n, n)``; zeros without it."""
        n = self.size
        if name not in self.fields:
            return np.zeros((len(self.speed), n, n))
        unit = self.scale
        return self.fields[name].mean() * unit[:, :, None] * unit[:, None, :]

    def rate(self) -> Array:
        """Return the largest rate of change of the state per radian by mean arrays, ``(nb,)``."""
        inverse = np.linalg.inv(np.linalg.cholesky(self.mean("mass")))
        stiffness, damping, turning = (
            np.linalg.norm(
                inverse @ self.mean(name) @ np.swapaxes(inverse, -1, -2), ord=2, axis=(-2, -1)
            )
            for name in ("stiffness", "damping", "gyroscopic")
        )
        rate = np.sqrt(stiffness) + damping + turning
        return np.asarray(np.maximum(2 * np.pi / self.period, rate))

    def cholesky_of_mass(self, angles: Array) -> Array:
        """Return the Cholesky factors of the scaled mass at angles, ``(nb, nt, n, n)``.

        A mass matrix that is not symmetric and positive definite is refused.
        """
        mass = self.at("mass", angles)
        gap = np.max(np.abs(mass - np.swapaxes(mass, -1, -2)), initial=0.0)
        if not gap <= 1e-10 * np.max(np.abs(mass), initial=0.0):
            raise _bad_mass(f"asymmetry {gap:.3g}")
        try:
            return np.asarray(np.linalg.cholesky(mass), dtype=np.float64)
        except np.linalg.LinAlgError:
            lowest = float(np.min(np.linalg.eigvalsh(mass)))
            raise _bad_mass(f"smallest eigenvalue {lowest:.3g}") from None

    def frozen_modes(self, angles: Array) -> tuple[Array, Array]:
        """Return the modes at angles as if the crank were held, in scaled coordinates.

        Of the mass and the symmetric part of the stiffness field: squared frequencies [1/rad^2],
        rising, ``(nb, nt, n)``, and modes of unit mass in columns, ``(nb, nt, n, n)``; nt is 1
        where the two arrays are constant.
        """
        return _modes(self.cholesky_of_mass(angles), -self.stiffness(angles))

    def stiffness(self, angles: Array) -> Array:
        """Return the stiffness field at angles; zeros where there is none."""
        if "stiffness" in self.fields:
            return self.at("stiffness", angles)
        return np.zeros((len(self.speed), 1, self.size, self.size))

    def generator(self, angles: Array) -> Array:
        """Return L of y' = L y in the scaled state (q/scale, p scale), and 1 where forced.

        At angles [rad], ``(nt,)``; shape ``(nb, nt, m, m)``, m = 2n or 2n + 1.
        """
        n, count, places = self.size, len(self.speed), len(angles)
        mass = np.broadcast_to(self.at("mass", angles), (count, places, n, n))
        flexibility = np.linalg.inv(mass)
        out = np.zeros((count, places, 2 * n + self.forced, 2 * n + self.forced))
        out[..., :n, n : 2 * n] = flexibility
        if "stiffness" in self.fields:
            out[..., n : 2 * n, :n] = self.at("stiffness", angles)
        feedback = self.feedback(angles)
        if "gyroscopic" in self.fields:
            out[..., :n, :n] = -flexibility @ self.at("gyroscopic", angles)
        if feedback is not None:
            out[..., n : 2 * n, n : 2 * n] = feedback @ flexibility
            out[..., n : 2 * n, :n] += feedback @ out[..., :n, :n]
        if self.forced:
            out[..., n : 2 * n, 2 * n] = self.at("force", angles)
        return out

    def feedback(
        self, angles: Array, table: Array | None = None, gyroscopic: Array | None = None
    ) -> Array | None:
        """Return A^T - C/w, by which rates act on the momenta; None where there is none."""
        if gyroscopic is None and "gyroscopic" in self.fields:
            gyroscopic = self.at("gyroscopic", angles, table)
        value = None if gyroscopic is None else np.swapaxes(gyroscopic, -1, -2)
        if "damping" in self.fields:
            damping = self.at("damping", angles, table)
            value = -damping if value is None else value - damping
        return value

    def states(self, angles: Array, q: Array, slope: Array) -> Array:
        """Return scaled states of the first member ``(nt, 2n)`` from coordinates and dq/dtheta."""
        place, rate = q / self.scale[0], slope / self.scale[0]
        momentum = (self.at("mass", angles)[0] @ rate[..., None])[..., 0]
        if "gyroscopic" in self.fields:
            momentum += (self.at("gyroscopic", angles)[0] @ place[..., None])[..., 0]
        return np.concatenate([place, momentum], axis=-1)

    def divergence(self) -> Array:
        """Return the integral of the trace of L over a period, ``(nb,)``; Liouville's exponent."""
        if "damping" not in self.fields:
            return np.zeros(len(self.speed))
        angles = self.even_angles()
        mass, damping = self.at("mass", angles), self.at("damping", angles)
        if self.size == 1:
            trace = (damping / mass)[..., 0, 0]
        else:
            trace = np.trace(np.linalg.solve(mass, damping), axis1=-2, axis2=-1)
        value: Array = -self.period * np.mean(trace, axis=1)
        return value


@dataclass(frozen=True)
class SampledSystem:
    """A system with the Fourier series of its terms, for equations at any speeds and parameters.

    Make it with :func:`sampled`.
    """

    system: LinearPeriodic
    forcing: bool  # whether the force is taken along
    series: Mapping[int, Array]  # series of the terms that vary, by place among the terms
    harmonics: int  # harmonics that they have; -1 where they are not smooth
    reach: int  # highest harmonic that has a millionth of the largest amplitude of its term


def sampled(system: LinearPeriodic, *, forcing: bool = False) -> SampledSystem:
    """Return a system with its terms sampled; a term of wrong shape or not finite is refused."""
    varying = [
        place
        for place, term in enumerate(system.terms)
        if _acts(term, forcing) and not term.constant
    ]
    return _sampled(system, forcing, varying)


def _sampled(system: LinearPeriodic, forcing: bool, varying: Sequence[int]) -> SampledSystem:
    """Return a system with some of its terms sampled; the next call at other speeds finds them."""
    key = ("Fourier series", *varying)
    if key not in system.kept:
        system.kept[key] = fourier_series(system, [system.terms[place] for place in varying])
    series, harmonics, reach = system.kept[key]
    return SampledSystem(system, forcing, dict(zip(varying, series, strict=True)), harmonics, reach)


def _acts(term: Term, forcing: bool) -> bool:
    return term.array in SPEED_POWER and (forcing or term.array not in "fhp")


def equation_of(
    system: LinearPeriodic | SampledSystem,
    speed: ArrayLike,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    forcing: bool = False,
) -> Equation:
    """Return the equation of a system at positive speeds [rad/s] and parameters that broadcast.

    A sampled system is not evaluated again and knows whether forces act.  Parameters replace the
    system's own; geometry too, one number each, where the system can be made anew for it, but not
    of a sampled one.  ``forcing`` takes the force along, where the system has one.

    Refused are speeds that are not positive and finite, parameters that are unknown or not finite,
    shapes that do not broadcast, terms that are not finite or of wrong shape, and mass matrices
    that are not symmetric and positive definite.
    """
    if isinstance(system, SampledSystem):
        known, changes = system, dict(parameters or {})
    else:
        system, changes = at_geometry(system, parameters or {})
        known = None
    plain = system.system if isinstance(system, SampledSystem) else system
    speeds, values, batch = _batch(speed, changes)
    scales = plain.scale_values(**values)
    flat = np.broadcast_to(speeds, batch).reshape(-1)
    factors: dict[int, Array] = {}
    for place, term in enumerate(plain.terms):
        if not _acts(term, known.forcing if known else forcing):
            continue
        scale = 1.0 if term.scale is None else scales[term.scale]
        power = SPEED_POWER[term.array] + term.power
        if np.ndim(scale):
            scale = np.broadcast_to(scale, batch).reshape(-1)
        factor = scale * flat**power
        if np.any(factor):
            factors[place] = FIELD[term.array][1] * factor
    if not any(plain.terms[place].array == "M" for place in factors):
        raise bad("LinearPeriodic.terms", "no mass term M", "a positive definite M", "add the term")
    if known is None:
        varying = [place for place in factors if not plain.terms[place].constant]
        known = _sampled(plain, forcing, varying)
    fields = _fields(known, factors)
    waves_of, ones = (known.harmonics, known.reach), np.ones((len(flat), plain.size))
    raw = Equation(plain, flat, batch, fields, *waves_of, ones, ones, ones, flat, damped=False)
    scaled = replace(raw, scale=_scale(raw))
    _check_mass(scaled)
    frequency, decay, damped = _rates(scaled)
    made = replace(scaled, frequency=frequency, decay=decay, damped=damped)
    return replace(made, fastest=np.max(made.rates, axis=1, initial=0.0))


def _batch(
    speed: ArrayLike, parameters: Mapping[str, ArrayLike]
) -> tuple[Array, dict[str, Array], tuple[int, ...]]:
    speeds = numbers("speed", speed)
    # The squares of others, or the inverse ones, times a mass or a stiffness may be no numbers.
    if not np.all((speeds >= 1e-100) & (speeds <= 1e100)):
        raise bad("speed", speed, "positive finite speeds [rad/s]", "leave out speeds <= 0")
    values = {name: numbers(name, value) for name, value in parameters.items()}
    for name, value in values.items():
        if not np.all(np.isfinite(value)):
            raise bad(name, value, "finite numbers", "correct the parameter")
    try:
        batch = np.broadcast_shapes(speeds.shape, *(v.shape for v in values.values()))
    except ValueError as mismatch:
        shapes = {"speed": speeds.shape, **{k: v.shape for k, v in values.items()}}
        fix = "add axes of length 1"
        raise bad("speed and parameters", shapes, "shapes that broadcast", fix) from mismatch
    return speeds, values, batch


def at_geometry(
    system: LinearPeriodic, values: Mapping[str, ArrayLike]
) -> tuple[LinearPeriodic, dict[str, ArrayLike]]:
    """Return the system made for the geometry among some values, and the other values.

    What is no linear periodic system is refused, and geometry that is not one number.
    """
    require_system(system)
    rest = {name: value for name, value in values.items() if name not in system.geometry}
    changes = {}
    for name in values.keys() - rest.keys():
        value = numbers(name, values[name])
        if value.ndim:
            found = f"shape {value.shape}"
            fix = "call once for each value, or take it as an axis of stability_chart"
            raise bad(name, found, "one number: the system is made anew for each geometry", fix)
        changes[name] = float(value)
    return (system.with_geometry(**changes) if changes else system), rest


def fourier_series(system: LinearPeriodic, terms: Sequence[Term]) -> tuple[list[Array], int, int]:
    """Return the Fourier series of terms, and how many harmonics they have; -1 where not smooth.

    The terms are sampled at even angles, doubled until every series has ended and gives the term at
    angles between: no wave was mistaken for another.  The coefficients are in the order of
    :func:`waves`, ``(2 H + 1, n, n)`` or ``(2 H + 1, n)``, H the same for all; the last number is
    the highest harmonic that has a millionth of the largest amplitude of its term.
    """
    if not terms:
        return [], 0, 0
    first = next((count for size, count in _FIRST.items() if system.size <= size), _FEWEST)
    angles = np.concatenate([BETWEEN, np.arange(float(first)) / first])
    values = _rows(system, terms, system.period * angles)
    between, table = values[: len(BETWEEN)], values[len(BETWEEN) :]
    shapes = [(system.size,) * (1 if term.array in "fhp" else 2) for term in terms]
    widths = np.array([int(np.prod(shape)) for shape in shapes])
    done: dict[int, Array] = {}
    reach, open_ = 0, np.arange(len(terms))
    while True:
        count, firsts = len(table), np.cumsum(widths[open_]) - widths[open_]
        spectrum = np.fft.rfft(table, axis=0) / count
        amplitude = np.maximum.reduceat(np.abs(spectrum), firsts, axis=1)
        tops = np.max(amplitude, axis=0)
        tops = np.where(tops > 0.0, tops, 1.0)
        quarter = len(amplitude) // 4
        before = np.max(amplitude[2 * quarter : 3 * quarter], axis=0) / tops
        tails = np.max(amplitude[3 * quarter :], axis=0) / tops
        last = 2 * count > _MOST
        ended = (tails <= _ENDED) | ((tails <= _ROUNDING) & ((tails > 0.1 * before) | last))
        if np.any(ended):
            noise = np.maximum(2.0 * tails, _ENDED / 8.0) * tops
            seen = np.where(ended, amplitude > noise, False)
            harmonics = int(np.max(np.nonzero(seen)[0], initial=0))
            waved = spectrum[1 : harmonics + 1]
            series = np.concatenate([spectrum[:1].real, 2.0 * waved.real, -2.0 * waved.imag])
            gaps = np.abs(waves(harmonics, 2 * np.pi * BETWEEN) @ series - between)
            ended &= np.maximum.reduceat(np.max(gaps, axis=0), firsts) <= 1e-10 * tops
            far = np.nonzero(amplitude[:, ended] > _SEEN * tops[ended])[0]
            reach = max(reach, int(np.max(far, initial=0)))
            for k in np.flatnonzero(ended):
                done[int(open_[k])] = series[:, firsts[k] : firsts[k] + widths[open_[k]]]
        if len(done) == len(terms):
            highest = max(len(part) for part in done.values()) // 2
            made = [_extended(done[k], highest).reshape(-1, *shapes[k]) for k in range(len(terms))]
            return made, highest, reach
        # Terms whose series have not ended are sampled twice as densely, the others no more.
        columns = np.repeat(~ended, widths[open_])
        if last:
            # The mean alone: units of the coordinates are chosen by it.
            for k in np.flatnonzero(~ended):
                done[int(open_[k])] = spectrum[:1, firsts[k] : firsts[k] + widths[open_[k]]].real
            return [done[k][:1].reshape(1, *shapes[k]) for k in range(len(terms))], -1, _MOST // 2
        open_, between, table = open_[~ended], between[:, columns], table[:, columns]
        wanted = system.period * (np.arange(float(count)) + 0.5) / count
        new = _rows(system, [terms[k] for k in open_], wanted)
        table = np.stack([table, new], axis=1).reshape(2 * count, -1)


def _extended(series: Array, harmonics: int) -> Array:
    """Return a series in the order of :func:`waves` with more harmonics, zero."""
    own = len(series) // 2
    if own == harmonics:
        return series
    out = np.zeros((2 * harmonics + 1, series.shape[1]))
    out[: own + 1], out[harmonics + 1 : harmonics + own + 1] = series[: own + 1], series[own + 1 :]
    return out


def waves(harmonics: int, phase: Array) -> Array:
    """Return ``1, cos k phase ..., sin k phase ...``, shape ``(nt, 2 harmonics + 1)``.

    Those of the last few sets of at most ``_KEPT`` angles are kept.
    """
    if len(phase) > _KEPT:
        return _waves(harmonics, phase)
    return _kept_waves(harmonics, phase.tobytes())


@lru_cache(maxsize=24)
def _kept_waves(harmonics: int, phase: bytes) -> Array:
    table = _waves(harmonics, np.frombuffer(phase))
    table.flags.writeable = False
    return table


def _waves(harmonics: int, phase: Array) -> Array:
    powers = np.empty((len(phase), harmonics), dtype=complex)
    powers[:, :1] = np.exp(1j * phase)[:, None]
    known = 1
    while known < harmonics:
        # Errors grow with the order, as those of cos(k phase) do by the rounding of k phase.
        part = powers[:, known : 2 * known]
        np.multiply(powers[:, : part.shape[1]], powers[:, known - 1 : known], out=part)
        known *= 2
    return np.concatenate([np.ones((len(phase), 1)), powers.real, powers.imag], axis=1)


def _rows(system: LinearPeriodic, terms: Sequence[Term], angles: Array) -> Array:
    """Return the values of all terms beside each other, one row per angle, finite."""
    values = [_checked(system, term, angles).reshape(len(angles), -1) for term in terms]
    return np.concatenate(values, axis=1)


def _checked(system: LinearPeriodic, term: Term, angles: Array) -> Array:
    """Return the values of a term; refuse what is not finite, or of a wrong shape."""
    values = np.asarray(term(angles), dtype=float)
    expected = (len(angles),) + (system.size,) * (1 if term.array in "fhp" else 2)
    where = f"term {term.array} ({term.scale})"
    if values.shape != expected:
        fix = "make the function return one array per angle"
        raise bad(where, f"shape {values.shape} for {len(angles)} angles", f"{expected}", fix)
    if not np.all(np.isfinite(values)):
        finite = np.all(np.isfinite(values.reshape(len(values), -1)), axis=1)
        found = f"a value that is not finite at crank angle {angles[int(np.argmin(finite))]:.6g}"
        fix = "check the function, its domain and the geometry"
        raise bad(where, found, "finite numbers at every angle", fix)
    return values


def _fields(known: SampledSystem, factors: Mapping[int, Array]) -> dict[str, Field]:
    """Return the fields that terms with given factors make up; what is zero is left out."""
    system, fields = known.system, {}
    values = {
        place: _checked(system, system.terms[place], np.zeros(1))[0]
        if system.terms[place].constant
        else known.series[place]
        for place in factors
    }
    acting = [place for place in factors if known.harmonics < 0 or np.any(values[place])]
    for name in ("mass", "gyroscopic", "damping", "stiffness", "force"):
        members = [place for place in acting if FIELD[system.terms[place].array][0] == name]
        if not members:
            continue
        varying = [place for place in members if not system.terms[place].constant]
        fixed = [
            np.multiply.outer(factors[place], values[place])
            for place in members
            if system.terms[place].constant
        ]
        each = [factors[place] for place in varying]
        fields[name] = Field(
            sum(fixed[1:], start=fixed[0]) if fixed else None,
            np.stack(each, axis=1) if each else np.zeros((len(factors[members[0]]), 0)),
            np.array([values[place] for place in varying]),
            tuple(system.terms[place] for place in varying),
        )
    return fields


def _scale(equation: Equation) -> Array:
    mass = np.diagonal(equation.mean("mass"), axis1=-2, axis2=-1)
    stiffness = np.abs(np.diagonal(equation.mean("stiffness"), axis1=-2, axis2=-1))
    if not np.all(mass > 0):
        raise _bad_mass(f"a diagonal entry of {float(np.min(mass)):.3g} in the mean")
    size = (mass * np.maximum(stiffness, mass)) ** -0.25
    return np.exp2(np.round(np.log2(size)))


def _check_mass(equation: Equation) -> None:
    """Refuse a mass that is not positive definite at some angle, at every member that differs."""
    field = equation.fields["mass"]
    parts = [field.factors] + ([] if field.constant is None else [field.constant])
    same = all(bool(np.all(part == part[:1])) for part in parts)
    chosen = equation.take(slice(0, 1)) if same else equation
    chosen.cholesky_of_mass(equation.even_angles() if field.terms else np.zeros(1))


def _rates(equation: Equation) -> tuple[Array, Array, bool]:
    """Return frequencies and decays of frozen modes, and whether the system is damped."""
    count = len(equation.speed)
    if count * _PLACES * equation.size**3 <= _EACH or count == 1:
        return _frozen(equation)
    chosen = np.unique(np.linspace(0, count - 1, 7).astype(np.intp))
    chosen = np.argsort(equation.speed, kind="stable")[chosen]
    frequency, decay, damped = _frozen(equation.take(chosen))
    gaps = np.abs(np.log(equation.speed[:, None] / equation.speed[chosen]))
    nearest = np.argmin(gaps, axis=1)
    ratio = (equation.speed[chosen][nearest] / equation.speed)[:, None]
    return frequency[nearest] * ratio, decay[nearest] * ratio, damped


def _frozen(equation: Equation) -> tuple[Array, Array, bool]:
    """Return :func:`_rates` with modes of every member."""
    angles = equation.period * np.arange(float(_PLACES)) / _PLACES
    damped = "damping" in equation.fields
    shape = (len(equation.speed), equation.size)
    if "stiffness" not in equation.fields:
        return np.zeros(shape), np.zeros(shape), damped
    stiffness = -equation.at("stiffness", angles)
    turned = np.swapaxes(stiffness, -1, -2)
    gap = np.max(np.abs(stiffness - turned), initial=0.0)
    damped |= bool(gap > 1e-13 * np.max(np.abs(stiffness), initial=0.0))
    squares, shapes = _modes(equation.cholesky_of_mass(angles), stiffness)
    frequency = np.sqrt(np.max(np.abs(squares), axis=1))
    if "damping" not in equation.fields:
        return frequency, np.zeros(shape), damped
    through = equation.at("damping", angles) @ shapes
    decay = 0.5 * np.mean(np.sum(shapes * through, axis=-2), axis=1) * equation.period
    return frequency, decay, damped


def _modes(cholesky: Array, stiffness: Array) -> tuple[Array, Array]:
    """Return squared frequencies and modes of unit mass, from Cholesky's factors of the mass."""
    inverse = np.linalg.inv(cholesky)
    back = np.swapaxes(inverse, -1, -2)
    symmetric = 0.5 * (stiffness + np.swapaxes(stiffness, -1, -2))
    squares, modes = np.linalg.eigh(inverse @ symmetric @ back)
    return squares, back @ modes


def _bad_mass(found: str) -> BadInput:
    expected = "a symmetric positive definite matrix at every angle and parameter value"
    return bad("mass matrix M", found, expected, "check masses, inertias and parameter values")
