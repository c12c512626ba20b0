"""Stresses at stations of a structure of beams as expressions of a few reduced coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.recovery import Recovery, recovery
from ..beams.recovery_forms import RIGID, LinearForm
from ..beams.stress import fibre_factors
from ..core.families import LinearPeriodic
from .balance import Balance, samples_table
from .condensed import Condensed
from .expressions import Expression, constant_part, recovered
from ..core.trigonometric import Array

# A part of the stress that is smaller than this, over the largest, is left out.
_NOTHING = 1e-10
# Times as many angles at which the largest stress is looked for, and how near to the largest of
# all, at the angles of the sweep, a row has to come to be looked at.
_FINER = 8
_NEAR = 0.6


@dataclass(frozen=True)
class Fibres:
    """Stresses of both outer fibres at stations, as a form of the motion.

    Attributes
    ----------
    form : LinearForm
        Stress [Pa]; rows are the stations, first all positive fibres, then the negative ones.
    links : tuple of str
        The beams with stations.
    link, place, sign : ndarray, shape (rows,)
        Which of them, x over its length, +1 or -1 for the fibre.
    """

    form: LinearForm
    links: tuple[str, ...]
    link: NDArray[np.int64]
    place: Array
    sign: Array


def fibres(
    system: LinearPeriodic,
    theta: Array,
    stations: int | Mapping[str, ArrayLike] | None,
    method: str,
) -> Fibres:
    """Return the stresses of the outer fibres at crank angles as a form of the motion.

    Raises
    ------
    BadInput
        If a station is unusable, or a beam with stations has no thickness.
    """
    found: Recovery = recovery(system, theta, stations, method)
    area, lever = fibre_factors(system, found.stations)
    axial, moment = found.forms["axial"], found.forms["moment"]
    parts = {}
    for key in dict.fromkeys((*axial.parts, *moment.parts)):
        tail = (1,) * (0 if key[0] == RIGID else 1)
        along = axial.parts.get(key, 0.0) * area.reshape(-1, *tail)
        across = moment.parts.get(key, 0.0) * lever.reshape(-1, *tail)
        # The positive fibre is pressed where the beam is hollow on its positive side.
        parts[key] = np.concatenate([along - across, along + across], axis=1)
    links = tuple(dict.fromkeys(station.beam for station in found.stations))
    link = np.array([links.index(station.beam) for station in found.stations])
    place = np.array([station.place for station in found.stations])
    sign = np.repeat([1.0, -1.0], len(place))
    return Fibres(LinearForm(parts), links, np.tile(link, 2), np.tile(place, 2), sign)


@dataclass(frozen=True)
class StressRows:
    """Stresses at even angles as an expression of the reduced coordinates.

    Attributes
    ----------
    keys : tuple of (int, int)
        Power of the speed and order of the derivative of each block of columns.
    columns : ndarray
        Shape ``(nt, rows, len(keys) m)``.
    still : mapping of int to ndarray
        What the forces alone give, by power of the speed, ``(nt, rows)``.
    table : ndarray
        The Fourier basis at the angles, ``(nt, 2 harmonics + 1)``.
    """

    keys: tuple[tuple[int, int], ...]
    columns: Array
    still: Mapping[int, Array]
    table: Array

    def values(self, balance: Balance, series: Array, speeds: Array, *, forced: bool) -> Array:
        """Return stresses ``(nt, rows, ns)`` of motions with Fourier series ``(d, ns)``.

        Parameters
        ----------
        balance : Balance
            Whose series they are.
        series : ndarray, shape (d, ns)
            Coefficients.
        speeds : ndarray, shape (ns,)
            Speeds [rad/s].
        forced : bool
            Whether what the forces alone give is added; not so for a change of the motion.
        """
        modes, count = balance.modes, len(speeds)
        table = self.table[:, : 2 * balance.harmonics + 1]
        at: dict[int, Array] = {}
        for order in dict.fromkeys(j for _, j in self.keys):
            rates = balance.derivatives(series, order).reshape(table.shape[1], modes * count)
            at[order] = (table @ rates).reshape(len(table), modes, count)
        followed = np.concatenate([at[j] * speeds**e for e, j in self.keys], axis=1)
        found = self.columns @ followed
        if forced:
            for power, rows in self.still.items():
                found += rows[..., None] * speeds**power
        return np.asarray(found)


def stress_rows(
    form: LinearForm,
    condensed: Condensed,
    harmonics: int,
    speeds: tuple[float, float],
    rate: float,
) -> StressRows:
    """Return stresses as an expression of the reduced coordinates of a condensed system.

    Parameters
    ----------
    form : LinearForm
        Stresses as a form of the motion, at the angles of the condensed system.
    condensed : Condensed
        The system.
    harmonics : int
        The most that a motion may have.
    speeds : pair of float
        Lowest and highest speed [rad/s], for what can be left out.
    rate : float
        Highest frequency [rad/s] that the motion may have.
    """
    period = condensed.period
    found = recovered(form, condensed.motion, period)
    keys = _needed(found, speeds, rate)
    still = constant_part(recovered(form, condensed.forced, period))
    for (name, power), rows in form.parts.items():
        if name == RIGID:
            still[power] = still.get(power, 0.0) + rows
    wave = 2.0 * np.pi / period
    return StressRows(
        keys=keys,
        columns=np.ascontiguousarray(np.concatenate([found[key] for key in keys], axis=2)),
        still=still,
        table=samples_table(condensed.theta, harmonics, wave),
    )


def _needed(
    found: Expression, speeds: tuple[float, float], rate: float
) -> tuple[tuple[int, int], ...]:
    """Return the keys that matter at some speed."""
    sizes = {
        (e, j): max(float(np.max(np.abs(v))) * w**e * (rate / w) ** j for w in speeds)
        for (e, j), v in found.items()
    }
    largest = max(sizes.values())
    return tuple(key for key, size in sizes.items() if size > _NOTHING * largest)


@dataclass(frozen=True)
class Peaks:
    """Largest stresses, each ``(links, ns)``: size [Pa], angle [rad], row, and error of the size.

    The error is what the parabola through three angles may miss, over the size.
    """

    size: Array
    theta: Array
    row: NDArray[np.int64]
    error: Array


def peaks(values: Array, link: NDArray[np.int64], links: int, period: float) -> Peaks:
    """Return the largest size of stresses ``(nt, rows, ns)`` of each link at each speed.

    Between the angles the Fourier series is taken at eight times as many, and a parabola between
    these.
    """
    count, _, speeds = values.shape
    coarse = np.max(np.abs(values), axis=0)
    size, theta, error = (np.zeros((links, speeds)) for _ in range(3))
    row = np.zeros((links, speeds), dtype=np.int64)
    for k in range(links):
        own = np.flatnonzero(link == k)
        rows, columns = np.nonzero(coarse[own] >= _NEAR * np.max(coarse[own], axis=0))
        wave = np.fft.rfft(values[:, own[rows], columns].T, axis=1)
        wave[:, -1] *= 0.5
        fine = np.abs(np.fft.irfft(wave, n=_FINER * count, axis=1)) * _FINER
        place = np.argmax(fine, axis=1)
        each = np.arange(len(place))
        before = fine[each, place - 1]
        at, after = fine[each, place], fine[each, (place + 1) % fine.shape[1]]
        bend = np.minimum(before - 2.0 * at + after, -np.finfo(float).tiny)
        shift = np.clip(0.5 * (before - after) / bend, -0.5, 0.5)
        top = at - 0.25 * (before - after) * shift
        # Of each speed the largest row, the first of equal ones.
        order = np.lexsort((rows, -top, columns))
        first = order[np.unique(columns[order], return_index=True)[1]]
        size[k] = top[first]
        theta[k] = (place[first] + shift[first]) % fine.shape[1] * (period / fine.shape[1])
        row[k] = own[rows[first]]
        error[k] = _missed(fine[first], place[first]) / size[k]
    return Peaks(size, theta, row, error)


def _missed(values: Array, place: NDArray[np.intp]) -> Array:
    """Return the most by which a parabola misses maxima of rows ``(k, angles)``, ``(k,)``.

    With s steps from the middle angle to the maximum, at most a half, the third difference counts
    ``s (1 - s^2)/6`` and the fourth ``s^2 (1 - s^2)/8``.
    """
    each, count = np.arange(len(place)), values.shape[1]
    around = np.array([values[each, (place + shift) % count] for shift in (-2, -1, 0, 1, 2)])
    third = np.array([-0.5, 1.0, 0.0, -1.0, 0.5]) @ around
    fourth = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) @ around
    return np.asarray(np.abs(third) / 16.0 + np.abs(fourth) * (3.0 / 128.0))
