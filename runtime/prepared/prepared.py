"""Monodromy matrices, motions and steady states from tables made beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import ceil, log

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.results import Check, DeferredChecks, provenance
from ..floquet.first_order import at_geometry, canonical_form, even_angles, numbers
from ..floquet.monodromy_matrix import Monodromy
from ..response.result import SteadyState
from ..simulation.trajectory import Trajectory
from .checks import motion_checks
from .compiled import CompiledTable, require_numba
from .table import Array, Maker, Table

_EPS = float(np.finfo(float).eps)
# Ratio of the speeds of one table.
_RATIO = 2.0
# Another solution, on other stretches, at these places of each table tells its error.
_FINENESS, _TRIED, _MARGIN = 1.37, (0.0, 0.29, 0.618, 1.0), 4.0
_REACHED = "the end was reached"


@dataclass(frozen=True)
class Prepared:
    """A linear periodic system, prepared for a range of speeds; make it with :func:`prepare`.

    Attributes
    ----------
    system : LinearPeriodic
        The system.
    span : pair of float
        Lowest and highest speed [rad/s].
    theta : ndarray
        Angles of a period at which motions are given [rad], ``(samples,)``.
    tables : tuple of Table
        By rising speed.
    figure : float
        Error of a flow over the largest entry of the flows, in scaled variables: four times the
        difference to a solution on other stretches, and round-off.
    forced : bool
        Whether forcing acts.
    scale : ndarray
        Units of the state, ``(m,)``.
    readout : ndarray
        From the scaled state to dq/dtheta at the angles, ``(samples, n, m)``.
    provenance : mapping of str to str
        Where the equations came from.
    compiled : tuple of CompiledTable
        The tables for numba, where it was asked for.
    """

    system: LinearPeriodic
    span: tuple[float, float]
    theta: Array
    tables: tuple[Table, ...]
    figure: float
    forced: bool
    scale: Array
    readout: Array
    provenance: Mapping[str, str]
    compiled: tuple[CompiledTable, ...] = ()

    def monodromy(self, speed: ArrayLike) -> Monodromy:
        """Return the monodromy matrices of the canonical variables at speeds.

        Parameters
        ----------
        speed : array_like
            Crank speeds [rad/s] within ``span``.

        Returns
        -------
        Monodromy
            As :func:`elastolink.monodromy` gives it, with the check ``converged``.

        Raises
        ------
        BadInput
            If a speed is outside the range.
        """
        speeds = self._speeds(speed)
        flat = speeds.reshape(-1)
        m = 2 * self.system.size
        whole = self._whole(flat)[:, :m, :m]
        scale = self.scale[:m]
        matrix = whole * scale[:, None] / scale
        error = np.full(speeds.shape, self.figure)
        return Monodromy(
            method="power series of stretches, polynomials of the inverse speed",
            error=error,
            error_norm="largest entry of the error, relative to the largest entry of the matrix, "
            "both in scaled variables",
            checks={"converged": Check(self.figure, 1e-9)},
            provenance=self.provenance,
            speed=speeds,
            matrix=matrix.reshape(*speeds.shape, m, m),
            exponent=np.zeros(speeds.shape, dtype=np.int64),
            scale=np.broadcast_to(scale, (*speeds.shape, m)),
            segments=np.full(speeds.shape, self.tables[0].stretches.shape[1], dtype=np.int64),
        )

    def transitions(self, speed: Array) -> tuple[Array, Array]:
        """Return the transition matrices of the scaled state, in the array namespace of the speeds.

        Parameters
        ----------
        speed : array of any namespace
            Crank speeds [rad/s] within ``span``, shape ``(ns,)``, double precision.

        Returns
        -------
        array, array
            From angle 0 to each of ``theta``, ``(ns, samples, m, m)``, and over the period,
            ``(ns, m, m)``; the state is ``(q, p)``, and 1 where forcing acts, over ``scale``.

        Raises
        ------
        BadInput
            If a speed is outside the range, or the range has more than one table (it spans more
            than 2 to 1) and the speeds are of another namespace than NumPy's.
        """
        if isinstance(speed, np.ndarray):
            return self._flows(np.atleast_1d(self._speeds(speed)))
        xp = speed.__array_namespace__()
        low, high = self.span
        if not bool(xp.all((speed >= low) & (speed <= high))):
            raise bad("speed", "some", f"{low:.6g} to {high:.6g} rad/s", "prepare another range")
        if len(self.tables) > 1:
            found, fix = f"{len(self.tables)} tables", "prepare a range of 2 to 1"
            raise bad("transitions", found, "one, for another array namespace", fix)
        return self.tables[0].flows(1.0 / speed)

    def simulate(
        self, speed: float, revolutions: int, initial: tuple[ArrayLike, ArrayLike]
    ) -> Trajectory:
        """Return the motion from a start at angle 0 over whole periods.

        Parameters
        ----------
        speed : float
            Crank speed [rad/s] within ``span``.
        revolutions : int
            Number of periods.
        initial : pair of array_like
            Coordinates and their time derivatives at the start, each broadcasting to ``(n,)``.

        Returns
        -------
        Trajectory
            At ``theta`` of every period and at the end; its check ``accuracy`` looks at the error,
            ``linear range`` at the deflection, when they are asked for.

        Raises
        ------
        BadInput
            If an argument is unusable.
        """
        given = float(self._speeds(speed, single=True))
        count = self._periods(revolutions)
        n = self.system.size
        states, largest = self._march(given, self._start(given, initial), count)
        q = states[:, :n] * self.scale[:n]
        slope = np.empty_like(q)
        by_period = states[:-1].reshape(count, -1, states.shape[1])
        slope[:-1] = np.einsum("tij,rtj->rti", self.readout, by_period).reshape(-1, n)
        slope[-1] = self.readout[0] @ states[-1]
        theta = (self.system.period * np.arange(count)[:, None] + self.theta).reshape(-1)
        theta = np.append(theta, self.system.period * count)
        gone = (count + 2) * self.figure * largest
        peak = np.max(np.abs(q), axis=0)
        error = gone * self.scale[:n] / np.where(peak > 0.0, peak, 1.0)
        return Trajectory(
            method="prepared: power series of stretches, polynomials of the inverse speed",
            error=error,
            error_norm="largest error of a coordinate over its own peak",
            checks=DeferredChecks(partial(motion_checks, self.system, theta, q[None], error)),
            provenance=self.provenance,
            theta=theta,
            time=theta / given,
            q=q,
            qd=given * slope,
            speed=given,
            steps=int(self._table_of(given).stretches.shape[1]),
            status=0,
            message=_REACHED,
            labels=self.system.labels,
        )

    def steady_state(self, speed: ArrayLike, *, stability: bool = True) -> SteadyState:
        """Return the periodic motion at speeds, with its multipliers.

        Parameters
        ----------
        speed : array_like
            Crank speeds [rad/s] within ``span``.
        stability : bool
            Whether the multipliers are computed.

        Returns
        -------
        SteadyState
            Its checks ``converged``, ``single`` and ``linear range``, as
            :func:`elastolink.steady_state` gives them, are made when they are asked for; nothing
            warns.

        Raises
        ------
        BadInput
            If a speed is outside the range, or nothing acts on the system.
        """
        if not self.forced:
            raise bad("steady_state", "a system without forcing", "f, h or p", "add a force")
        speeds = self._speeds(speed)
        flat = speeds.reshape(-1)
        n = self.system.size
        states, whole, reach, size = self._periodic(flat)
        q = states[..., :n] * self.scale[:n]
        slope = np.einsum("tij,stj->sti", self.readout, states)
        norm = np.max(np.abs(states[:, 0]), axis=1)
        sensitivity = reach * np.max(np.abs(whole), axis=(1, 2))
        wrong = (sensitivity + 1.0) * self.figure * size * norm
        peak = np.max(np.abs(q), axis=1)
        error = wrong[:, None] * self.scale[:n] / np.where(peak > 0.0, peak, 1.0)
        lost = wrong >= norm
        q[lost], slope[lost], error[lost] = np.nan, np.nan, np.inf
        single = Check(float(np.max(wrong / norm)), 1.0)
        checks = DeferredChecks(partial(motion_checks, self.system, self.theta, q, error, single))
        batch = speeds.shape
        multipliers, stable, distance = self._stability(whole, batch, wanted=stability)
        return SteadyState(
            method="prepared: power series of stretches, polynomials of the inverse speed",
            error=error.reshape(*batch, n),
            error_norm="largest error of a coordinate over its own peak",
            checks=checks,
            provenance=self.provenance,
            speed=speeds,
            theta=self.theta,
            q=q.reshape(*batch, -1, n),
            qd=(flat[:, None, None] * slope).reshape(*batch, -1, n),
            multipliers=multipliers,
            stable=stable,
            distance=distance,
            sensitivity=sensitivity.reshape(batch),
            period=self.system.period,
            labels=self.system.labels,
            reference_length=self.system.reference_length,
            shapes=self.system.shapes,
        )

    def _stability(
        self, whole: Array, batch: tuple[int, ...], *, wanted: bool
    ) -> tuple[NDArray[np.complex128] | None, NDArray[np.bool_] | None, Array]:
        """Return multipliers, whether all are inside the unit circle, and their distance from 1."""
        if not wanted:
            return None, None, np.full(batch, np.nan)
        m = 2 * self.system.size
        values, vectors = np.linalg.eig(whole[:, :m, :m])
        values = values.astype(complex)
        order = np.argsort(-np.abs(values), axis=-1, kind="stable")
        values = np.take_along_axis(values, order, axis=-1)
        size = np.linalg.cond(vectors) * self.figure * np.max(np.abs(whole), axis=(1, 2))
        # An error that says nothing leaves stability unproved.
        stable = np.abs(values[:, 0]) <= 1.0 + np.where(size < 0.1, size, -size)
        distance = np.min(np.abs(values - 1.0), axis=-1)
        return values.reshape(*batch, m), stable.reshape(batch), distance.reshape(batch)

    def _periodic(self, speeds: Array) -> tuple[Array, Array, Array, Array]:
        """Return periodic states, flows over the period, reach of the start, size of the flows."""
        if self.compiled and len(speeds) == 1:
            speed = float(speeds[0])
            one = self._compiled_at(speed).periodic(1.0 / speed, 1.0 / self.scale[-1])
            return one[0][None], one[1][None], np.array(one[2:3]), np.array(one[3:])
        flows, whole = self._flows(speeds)
        m = 2 * self.system.size
        inverse: Array = np.linalg.inv(np.eye(m) - whole[:, :m, :m]).astype(np.float64)
        first: Array = np.full((len(speeds), m + 1), 1.0 / self.scale[-1])
        first[:, :m] = (inverse @ whole[:, :m, m:])[..., 0] / self.scale[-1]
        states = (flows @ first[:, None, :, None])[..., 0]
        reach = np.max(np.sum(np.abs(inverse), axis=-1), axis=-1)
        return states, whole, reach, np.max(np.abs(flows), axis=(1, 2, 3))

    def _march(self, speed: float, first: Array, periods: int) -> tuple[Array, float]:
        """Return the states of a motion, and what the error of a flow does to them at the most."""
        if self.compiled:
            states, start, flow = self._compiled_at(speed).march(1.0 / speed, first, periods)
            return states, start * flow
        flows, whole = self._flows(np.array([speed]))
        starts = np.empty((periods + 1, len(first)))
        starts[0] = first
        for k in range(periods):
            starts[k + 1] = whole[0] @ starts[k]
        states = np.einsum("tij,rj->rti", flows[0], starts[:-1]).reshape(-1, len(first))
        largest = float(np.max(np.abs(starts)) * np.max(np.abs(flows)))
        return np.concatenate([states, starts[-1:]]), largest

    def _start(self, speed: float, initial: tuple[ArrayLike, ArrayLike]) -> Array:
        n = self.system.size
        if not isinstance(initial, (tuple, list)) or len(initial) != 2:
            raise bad("initial", initial, "a pair (q, qd)", "give coordinates and time derivatives")
        parts = []
        for part in initial:
            values = numbers("initial", part)
            if values.shape not in ((), (1,), (n,)) or not np.all(np.isfinite(values)):
                raise bad("initial", part, f"{n} finite numbers", "one per coordinate")
            parts.append(np.broadcast_to(values, (n,)))
        # The scaled state is (q, p) / scale; the readout at angle 0 is linear in both.
        state = 1.0 / self.scale
        state[:n] = parts[0] / self.scale[:n]
        rest = parts[1] / speed - self.readout[0, :, :n] @ state[:n]
        state[n : 2 * n] = np.linalg.solve(self.readout[0, :, n : 2 * n], rest)
        return state

    def _speeds(self, speed: ArrayLike, *, single: bool = False) -> Array:
        given = numbers("speed", speed)
        low, high = self.span
        if (single and given.ndim) or not np.all((given >= low) & (given <= high)):
            expected = f"{'one speed' if single else 'speeds'} from {low:.6g} to {high:.6g} rad/s"
            raise bad("speed", speed, expected, "prepare another range")
        return given

    @staticmethod
    def _periods(revolutions: int) -> int:
        given = numbers("revolutions", revolutions)
        if given.ndim or not 1 <= given <= 10**6 or given != int(given):
            raise bad("revolutions", revolutions, "a whole number of periods", "use simulate")
        return int(given)

    def _table_of(self, speed: float) -> Table:
        return next((t for t in self.tables if speed <= 1.0 / t.low), self.tables[-1])

    def _compiled_at(self, speed: float) -> CompiledTable:
        return next((t for t in self.compiled if speed <= 1.0 / t.low), self.compiled[-1])

    def _flows(self, speeds: Array) -> tuple[Array, Array]:
        if len(speeds) == 1:
            return self._table_of(float(speeds[0])).flows(1.0 / speeds)
        m, nt = len(self.scale), len(self.theta)
        flows, whole = np.empty((len(speeds), nt, m, m)), np.empty((len(speeds), m, m))
        for table, own in self._parts(speeds):
            flows[own], whole[own] = table.flows(1.0 / speeds[own])
        return flows, whole

    def _whole(self, speeds: Array) -> Array:
        if len(speeds) == 1:
            speed = float(speeds[0])
            if self.compiled:
                return self._compiled_at(speed).whole(1.0 / speed)[None]
            return self._table_of(speed).whole(1.0 / speeds)
        found = np.empty((len(speeds), len(self.scale), len(self.scale)))
        for table, own in self._parts(speeds):
            found[own] = table.whole(1.0 / speeds[own])
        return found

    def _parts(self, speeds: Array) -> list[tuple[Table, NDArray[np.intp]]]:
        ends = np.array([1.0 / table.low for table in self.tables[:-1]])
        which = np.searchsorted(ends, speeds)
        parts = [(table, np.flatnonzero(which == k)) for k, table in enumerate(self.tables)]
        return [(table, own) for table, own in parts if len(own)]


def prepare(
    system: LinearPeriodic,
    speeds: tuple[float, float] | float,
    *,
    samples: int = 64,
    forcing: bool = True,
    compiled: bool = False,
    **parameters: float,
) -> Prepared:
    """Prepare a system for a range of speeds: each later answer takes microseconds.

    The transition matrices of short stretches of the period are power series in the angle and
    polynomials in the inverse speed, found once.  What is left for one speed is to evaluate and to
    multiply them.

    Parameters
    ----------
    system : LinearPeriodic
        The system; a stiff one, whose fastest modes turn thousands of times in a period, first
        through :func:`elastolink.reduced_system`.
    speeds : pair of float, or float
        Lowest and highest crank speed [rad/s]; or the only one.
    samples : int
        Angles of a period at which motions are given.
    forcing : bool
        Whether f, h and p act.
    compiled : bool
        Whether numba compiles what is left for one speed (extra ``fast``): the same answers to
        round-off, several times sooner, after some seconds of compilation in a process.
    **parameters : float
        Parameter and geometry values that replace the system's own.

    Returns
    -------
    Prepared

    Raises
    ------
    BadInput
        If an argument is unusable, M or A carries a power of the speed, numba is wanted and
        missing, or the tables would take more than 320 MB for a range of 2 to 1.

    Examples
    --------
    >>> ready = prepare(system, (40.0, 150.0))      # doctest: +SKIP
    >>> ready.monodromy(80.0).matrix                # doctest: +SKIP
    """
    low, high = _ends(speeds)
    if compiled:
        require_numba()
    if not (isinstance(samples, (int, np.integer)) and 1 <= samples <= 4096):
        raise bad("samples", repr(samples), "a whole number from 1 to 4096", "take 64")
    made, rest = at_geometry(system, parameters)
    plain = {name: _one(name, value) for name, value in rest.items()}
    middle = (low * high) ** 0.5
    form = canonical_form(made, middle, plain, forcing=forcing)
    theta = even_angles(made.period, samples)
    maker = Maker(form, theta, plain)
    count = max(1, ceil(log(high / low) / log(_RATIO) - 1e-9))
    ends = low * (high / low) ** (np.arange(count + 1) / count)
    ends[[0, -1]] = low, high
    ranges = [(1.0 / b, 1.0 / a) for a, b in pairwise(ends.tolist())]
    tables = tuple(maker.table(*own) for own in ranges)
    figure = max(_figure(maker, table) for table in tables)
    return Prepared(
        made.with_parameters(**plain) if plain else made,
        (low, high),
        theta,
        tables,
        figure,
        form.forced,
        maker.scale,
        _readout(maker, middle),
        provenance(made.changed_provenance(**plain)),
        tuple(CompiledTable.of(table) for table in tables) if compiled else (),
    )


def _figure(maker: Maker, table: Table) -> float:
    """Return the error of a table, by another solution at some of its speeds."""
    worst = 0.0
    for place in _TRIED if table.high > table.low else _TRIED[:1]:
        inverse = table.low + place * (table.high - table.low)
        other = maker.table(inverse, inverse, fineness=_FINENESS)
        at = np.array([inverse])
        ours, theirs = (
            np.concatenate([f, w[:, None]], 1) for f, w in (table.flows(at), other.flows(at))
        )
        worst = max(worst, float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs))))
    return _MARGIN * worst + 16.0 * _EPS


def _readout(maker: Maker, speed: float) -> Array:
    """Return the matrices from the scaled state to dq/dtheta at the angles, ``(nt, n, m)``."""
    n = maker.system.size
    rows = maker.form_at(np.array([1.0 / speed])).plain_generator(maker.theta)[0, :, :n]
    value: Array = rows * maker.scale
    return value


def _ends(speeds: tuple[float, float] | float) -> tuple[float, float]:
    given = np.atleast_1d(numbers("speeds", speeds))
    fits = given.shape in ((1,), (2,)) and np.all(np.isfinite(given)) and np.all(given > 0)
    if not fits or given[0] > given[-1]:
        raise bad("speeds", speeds, "a rising pair of positive speeds [rad/s]", "correct it")
    return float(given[0]), float(given[-1])


def _one(name: str, value: ArrayLike) -> float:
    given = numbers(name, value)
    if given.ndim:
        raise bad(name, f"shape {given.shape}", "one number", "prepare once for each value")
    return float(given)
