"""Monodromy matrices, motions and steady states from tables made beforehand."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import LINEAR_RANGE, bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers, require_between, require_whole
from ..core.results import Check, DeferredChecks, DeferredGroup, provenance
from .compiled import CompiledTable, require_numba
from .equation import SPEED_POWER, Equation, SampledSystem, at_geometry, equation_of, sampled
from .motion import Trajectory, one_number, simulate, start_values
from .multipliers import ROUNDED, Monodromy, eigenvalues, rounding_error
from .periodic_motion import LATER, SteadyState, peaks
from .tables import Table, flows_at, next_rung, octaves, table_of
from .transition import cheapest

# Error of a motion over its peak, from which it is integrated step by step.
_TRANSIENT = 1e-6
# Places of each table at which other segments tell its error, and the margin: with four the least
# of 300 errors of matrices told between them was 1.3 times the true one.
_TRIED, _MARGIN = (0.0, 0.382, 1.0), 6.0
_TINY = float(np.finfo(float).tiny)
# Largest state for which compiled loops win over NumPy's products.
_COMPILED = 12
# Error of a coordinate over its peak with which an answer still passes.
_FAIR = 1e-6
_METHOD = "prepared: segments by collocation, polynomials of the inverse speed"


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
    wanted : float
        The ``rtol`` that was asked for, or what round-off allows.
    errors : TableErrors
        Errors of monodromy and transition matrices at speeds that rise: six times the difference
        to other segments, and round-off.
    motion_error : ndarray
        Error of each coordinate of a periodic motion, over the size of its start and over what the
        closing of the ring magnifies, shape ``(n,)``.
    forced : bool
        Whether a force acts.
    scale : ndarray
        Units of the state, ``(m,)``.
    readout : ndarray
        From the scaled state to dq/dtheta at the angles, ``(samples, n, m)``.
    provenance : mapping of str to str
        Where the equations came from.
    compiled : tuple of CompiledTable
        The tables for numba, where it was asked for.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> ready = el.prepare(system, (70.0, 90.0))
    >>> print(ready.span, ready.monodromy(80.0).matrix.shape)
    (70.0, 90.0) (2, 2)
    """

    system: LinearPeriodic
    span: tuple[float, float]
    theta: Array
    tables: tuple[Table, ...]
    wanted: float
    errors: TableErrors
    motion_error: Array
    forced: bool
    scale: Array
    readout: Array
    provenance: Mapping[str, str]
    compiled: tuple[CompiledTable, ...] = ()

    def __repr__(self) -> str:
        """Return the system and the range in two lines."""
        low, high = self.span
        ready = f"tables: {len(self.tables)}, error: {self.error:.2g}"
        return f"{type(self).__name__}: {low:.6g} to {high:.6g} rad/s, {ready}\n  {self.system!r}"

    @property
    def error(self) -> float:
        """Largest error of a monodromy matrix in scaled variables, over its largest entry."""
        return float(np.max(self.errors.matrix))

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
        m = 2 * self.system.size
        scale = self.scale[:m]
        scaled = self._whole(speeds.reshape(-1))[:, :m, :m]
        error = self.errors.of_matrices(speeds.reshape(-1))
        matrix = scaled * scale[:, None] / scale
        return Monodromy(
            method=_METHOD,
            error=error.reshape(speeds.shape),
            error_norm="largest entry of the error, relative to the largest entry of the matrix, "
            "both in scaled variables",
            checks=DeferredChecks(partial(_converged, error, scaled, self.wanted)),
            provenance=self.provenance,
            speed=speeds,
            matrix=matrix.reshape(*speeds.shape, m, m),
            exponent=np.zeros(speeds.shape, dtype=np.int64),
            scale=np.broadcast_to(scale, (*speeds.shape, m)) if speeds.ndim else scale.copy(),
            segments=np.full(speeds.shape, self.tables[0].groups.shape[1], dtype=np.int64),
        )

    def simulate(
        self, speed: float, revolutions: int, initial: tuple[ArrayLike, ArrayLike]
    ) -> Trajectory:
        """Return the motion from a start at angle 0 over whole periods.

        The tables hold what is alive after a period.  A start that shakes modes which die within
        it is followed by :func:`~.motion.simulate` instead, at its default accuracy.

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
        count, n = _periods(revolutions), self.system.size
        states, sizes = self._march(given, self._start(given, initial), count)
        q = states[:, :n] * self.scale[:n]
        slope = np.empty_like(q)
        by_period = states[:-1].reshape(count, -1, states.shape[1])
        slope[:-1] = np.einsum("tij,rtj->rti", self.readout, by_period).reshape(-1, n)
        slope[-1] = self.readout[0] @ states[-1]
        theta = (self.system.period * np.arange(count)[:, None] + self.theta).reshape(-1)
        theta = np.append(theta, self.system.period * count)
        flow = self.errors.at(np.array([given]), self.errors.flow)[0]
        error = (count + 1) * np.sqrt(flow**2 @ sizes**2) * self.scale[:n] / peaks(q[None])[0]
        if not np.max(error) <= _TRANSIENT:
            turn = 2 * np.pi / self.system.period
            told: dict[str, Any] = {"initial": initial, "forcing": self.forced}
            samples = round(len(self.theta) * turn)
            return simulate(self.system, given, count / turn, samples=samples, **told)
        return Trajectory(
            method=_METHOD,
            error=error,
            error_norm="largest error of a coordinate over its peak",
            checks=DeferredChecks(partial(_checks, self.system, theta, q[None], error, None)),
            provenance=self.provenance,
            theta=theta,
            time=theta / given,
            q=q,
            qd=given * slope,
            speed=given,
            steps=int(self.tables[self._place(given)].groups.shape[1]),
            status=0,
            message="the end was reached",
            labels=self.system.labels,
        )

    def steady_state(self, speed: ArrayLike) -> SteadyState:
        """Return the periodic motion at speeds, with its multipliers.

        Parameters
        ----------
        speed : array_like
            Crank speeds [rad/s] within ``span``.

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
        flat, n, batch = speeds.reshape(-1), self.system.size, speeds.shape
        states, whole, reach = self._periodic(flat)
        q = states[..., :n] * self.scale[:n]
        slope = np.einsum("tij,stj->sti", self.readout, states)
        norm = np.abs(states[:, 0]).max(axis=1)
        sensitivity = reach * np.abs(whole).max(axis=(1, 2))
        error = ((reach + 1.0) * norm)[:, None] * self.motion_error * self.scale[:n] / peaks(q)
        wrong = error.max(axis=1)
        lost = ~(wrong < 1.0)
        if lost.any():
            q[lost], slope[lost], error[lost] = np.nan, np.nan, np.inf
        single = Check(float(wrong.max()), 1.0)
        later = DeferredGroup(partial(self._stability, flat, whole, batch))
        return SteadyState(
            method=_METHOD,
            error=error.reshape(*batch, n),
            error_norm="largest error of a coordinate over its peak",
            checks=DeferredChecks(partial(_checks, self.system, self.theta, q, error, single)),
            provenance=self.provenance,
            speed=speeds,
            theta=self.theta,
            q=q.reshape(*batch, -1, n),
            qd=(flat[:, None, None] * slope).reshape(*batch, -1, n),
            **later.fields(LATER),
            sensitivity=sensitivity.reshape(batch),
            period=self.system.period,
            labels=self.system.labels,
            reference_length=self.system.reference_length,
            shapes=self.system.shapes,
        )

    def _stability(
        self, speeds: Array, whole: Array, batch: tuple[int, ...]
    ) -> Mapping[str, NDArray[Any]]:
        m = 2 * self.system.size
        matrices = whole[:, :m, :m]
        size = self.errors.of_matrices(speeds) * np.max(np.abs(matrices), axis=(1, 2))
        values, error, _ = eigenvalues(matrices, size)
        # An error that says nothing leaves stability unproved.
        slack = np.where(error < 0.1, error, -error)
        stable = np.all(np.abs(values) <= 1.0 + slack, axis=-1)
        order = np.argsort(-np.abs(values), axis=-1, kind="stable")
        return {
            "multipliers": np.take_along_axis(values, order, axis=-1).reshape(*batch, m),
            "multiplier_error": np.take_along_axis(error, order, axis=-1).reshape(*batch, m),
            "stable": stable.reshape(batch),
            "distance": np.min(np.abs(values - 1.0), axis=-1).reshape(batch),
        }

    def _periodic(self, speeds: Array) -> tuple[Array, Array, Array]:
        """Return periodic states, the flow over the period, and the reach of the start."""
        if self.compiled and len(speeds) == 1:
            speed = float(speeds[0])
            one = self._compiled_at(speed).periodic(1.0 / speed, 1.0 / self.scale[-1])
            return one[0][None], one[1][None], np.array(one[2:3])
        flows, whole = self._flows(speeds)
        states, reach = closed(flows, whole, 1.0 / self.scale[-1])
        return states, whole, reach

    def _march(self, speed: float, first: Array, periods: int) -> tuple[Array, Array]:
        """Return the states of a motion, and the largest size of each component at the starts."""
        if self.compiled:
            return self._compiled_at(speed).march(1.0 / speed, first, periods)
        flows, whole = self._flows(np.array([speed]))
        starts = np.empty((periods + 1, len(first)))
        starts[0] = first
        for k in range(periods):
            starts[k + 1] = whole[0] @ starts[k]
        states = np.einsum("tij,rj->rti", flows[0], starts[:-1]).reshape(-1, len(first))
        return np.concatenate([states, starts[-1:]]), np.max(np.abs(starts), axis=0)

    def _start(self, speed: float, initial: tuple[ArrayLike, ArrayLike]) -> Array:
        n, (q, qd) = self.system.size, start_values(self.system, initial)
        # The scaled state is (q, p) / scale; the readout at angle 0 is linear in both.
        state = 1.0 / self.scale
        state[:n] = q / self.scale[:n]
        rest = qd / speed - self.readout[0, :, :n] @ state[:n]
        state[n : 2 * n] = np.linalg.solve(self.readout[0, :, n : 2 * n], rest)
        return state

    def _speeds(self, speed: ArrayLike, *, single: bool = False) -> Array:
        given = numbers("speed", speed)
        low, high = self.span
        inside = np.all((given >= low) & (given <= high)) if given.ndim else low <= given <= high
        if (single and given.ndim) or not inside:
            expected = f"{'one speed' if single else 'speeds'} from {low:.6g} to {high:.6g} rad/s"
            raise bad("speed", speed, expected, "prepare another range")
        return given

    def _place(self, speed: float) -> int:
        return bisect_left([1.0 / table.low for table in self.tables[:-1]], speed)

    def _compiled_at(self, speed: float) -> CompiledTable:
        return self.compiled[self._place(speed)]

    def _flows(self, speeds: Array) -> tuple[Array, Array]:
        m, nt = len(self.scale), len(self.theta)
        flows, whole = np.empty((len(speeds), nt, m, m)), np.empty((len(speeds), m, m))
        for table, members in self._parts(speeds):
            flows[members], whole[members] = table.flows(1.0 / speeds[members])
        return flows, whole

    def _whole(self, speeds: Array) -> Array:
        if self.compiled and len(speeds) == 1:
            speed = float(speeds[0])
            return self._compiled_at(speed).whole(1.0 / speed)[None]
        whole = np.empty((len(speeds), len(self.scale), len(self.scale)))
        for table, members in self._parts(speeds):
            matrices, exponent = table.products(1.0 / speeds[members])
            whole[members] = np.ldexp(matrices, exponent[:, None, None])
        return whole

    def _parts(self, speeds: Array) -> list[tuple[Table, NDArray[np.intp]]]:
        ends = np.array([1.0 / table.low for table in self.tables[:-1]])
        which = np.searchsorted(ends, speeds)
        parts = [(table, np.flatnonzero(which == k)) for k, table in enumerate(self.tables)]
        return [(table, members) for table, members in parts if len(members)]


def prepare(
    system: LinearPeriodic,
    speeds: tuple[float, float] | float,
    *,
    samples: int = 64,
    forcing: bool = True,
    rtol: float = 1e-10,
    compiled: bool = False,
    **parameters: float,
) -> Prepared:
    """Prepare a system for a range of speeds: each later answer takes micro- or milliseconds.

    The transition matrices of segments of the period are polynomials in the inverse speed, computed
    once.  What is left for one speed is to evaluate and to multiply them.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speeds : pair of float, or float
        Lowest and highest crank speed [rad/s]; or the only one.
    samples : int
        Angles of a period at which motions are given.
    forcing : bool
        Whether f, h and p act.
    rtol : float
        Wanted error of the transition matrices, over their largest entry or over 1, whichever is
        larger, 1e-13 to 1e-4.  Long periods with many oscillations may not reach it, because of
        round-off.
    compiled : bool
        Whether numba compiles what is left for one speed (extra ``fast``): the same answers to
        round-off, several times sooner, after some seconds of compilation in a process.
    **parameters : float
        Parameter and geometry values that replace the system's.

    Returns
    -------
    Prepared

    Raises
    ------
    BadInput
        If an argument is unusable, M or A carries a power of the speed, numba is wanted and
        missing, or the tables would take more than 480 MB for a range of 2 to 1.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> print(el.prepare(system, (70.0, 90.0)).monodromy(80.0).matrix.trace().round(4))
    2.0202
    """
    low, high = _ends(speeds)
    if compiled:
        require_numba()
    require_whole("samples", samples, 1, 4096, "take 64")
    require_between("rtol", rtol, 1e-13, 1e-4, "choose 1e-10")
    fix = "prepare once for each value"
    plain = {name: one_number(name, value, fix) for name, value in parameters.items()}
    made, inside = at_geometry(system, plain)
    _check_inertia(made)
    maker = TableMaker(sampled(made, forcing=forcing), (low * high) ** 0.5, inside)
    middle = maker.middle
    ranges = pairwise(octaves(low, high).tolist())
    tables = [maker.table(1.0 / b, 1.0 / a, samples, rtol) for a, b in ranges]
    theta, m = middle.period * np.arange(float(samples)) / samples, len(maker.scale)
    return Prepared(
        made.with_parameters(**{name: plain[name] for name in inside}) if inside else made,
        (low, high),
        theta,
        tuple(table for table, *_ in tables),
        max([rtol, *(50.0 * errors.rounding for _, errors, _ in tables)]),
        TableErrors.joined([errors for _, errors, _ in tables]),
        np.max([motion for *_, motion in tables], axis=0),
        middle.forced,
        maker.scale,
        maker.readout(theta),
        provenance(made.changed_provenance(**inside)),
        tuple(CompiledTable.of(t) for t, *_ in tables) if compiled and m <= _COMPILED else (),
    )


@dataclass(frozen=True)
class TableErrors:
    """Errors of tables at a few speeds, by rising speed; the ends of each table are among them."""

    speed: Array  # the speeds [rad/s], (k,)
    matrix: Array  # error of the monodromy matrix in scaled variables, over its largest entry, (k,)
    size: Array  # its largest entry, (k,)
    flow: Array  # error of the entries of the transition matrices that give coordinates, (k, n, m)
    rounding: float  # what round-off adds to a matrix, over its largest entry

    @classmethod
    def joined(cls, parts: list[TableErrors]) -> TableErrors:
        """Return the errors of tables by rising speed."""
        rows = [(part.speed, part.matrix, part.size, part.flow) for part in parts]
        speed, matrix, size, flow = map(np.concatenate, zip(*rows, strict=True))
        return cls(speed, matrix, size, flow, max(part.rounding for part in parts))

    @property
    def largest(self) -> float:
        """Largest error of a monodromy matrix, over its largest entry or over 1, the larger."""
        return float(np.max(self.matrix * np.minimum(self.size, 1.0)))

    def of_matrices(self, speeds: Array) -> Array:
        """Return errors of monodromy matrices over their largest entries, at speeds ``(ns,)``."""
        return self.at(speeds, self.matrix)

    def at(self, speeds: Array, errors: Array) -> Array:
        """Return errors ``(k, ...)`` at speeds ``(ns,)``, ``(ns, ...)``."""
        # Between two speeds they fall with a power of the speed, as the segments' phases do.
        if len(self.speed) == 1:
            return np.broadcast_to(errors, (len(speeds), *errors.shape[1:]))
        after = np.searchsorted(self.speed[1:-1], speeds) + 1
        low, high = self.speed[after - 1], self.speed[after]
        part = np.clip(np.log(speeds / low) / np.log(high / low), 0.0, 1.0)
        part = part.reshape(-1, *(1,) * (errors.ndim - 1))
        return np.asarray(errors[after - 1] ** (1.0 - part) * errors[after] ** part)


class TableMaker:
    """Makes the tables of one system, stiff or not, all in the units of its middle speed."""

    def __init__(
        self,
        known: SampledSystem,
        speed: float,
        parameters: Mapping[str, ArrayLike],
        *,
        stiff: bool = True,
    ) -> None:
        self.known, self.parameters, self.stiff = known, parameters, stiff
        middle = self.middle = equation_of(known, speed, parameters)
        unit = middle.scale[0]
        self.scale = np.concatenate([unit, 1.0 / unit, np.ones(int(middle.forced))])
        if middle.forced:
            # A power of two makes the column of the force as large as the others.
            largest, rate = float(middle.largest_force()[0]), float(np.max(middle.frequency)) + 1.0
            if largest > 0.0:
                self.scale[-1] = np.exp2(np.round(np.log2(rate / largest)))
        self.unit = self.scale[-1] if middle.forced else 1.0

    def equation(self, inverse: Array) -> Equation:
        """Return the equation at inverse speeds."""
        made = equation_of(self.known, 1.0 / inverse, self.parameters)
        made = replace(made, scale=np.broadcast_to(self.middle.scale, made.scale.shape))
        return made.with_force_unit(self.unit)

    def table(
        self, low: float, high: float, samples: int, rtol: float, nodes: int | None = None
    ) -> tuple[Table, TableErrors, Array]:
        """Return the table of a range of inverse speeds, and its errors by other segments.

        The last are those of periodic motions, as :class:`Prepared` has them.
        """
        slowest = self.equation(np.array([high]))
        n = slowest.size
        way, segments = cheapest(slowest, rtol / _MARGIN, samples, stiff=self.stiff)
        span = low, high
        table = table_of(
            self.equation, span, segments, way, 0.1 * rtol, samples=samples, nodes=nodes
        )
        # Segments are rounded, and the polynomials that they are made of.
        rounding = 2.0 * float(np.max(rounding_error(slowest, segments)))
        # By rising speed.
        tried = (low + np.array(_TRIED if high > low else _TRIED[:1]) * (high - low))[::-1]
        ours = table.flows(tried)
        theirs = flows_at(self.equation(tried), next_rung(segments), way, samples)
        size = np.max(np.abs(theirs[1][:, : 2 * n, : 2 * n]), axis=(1, 2))
        gap = np.max(np.abs(ours[1] - theirs[1])[:, : 2 * n, : 2 * n], axis=(1, 2))
        # Round-off of what has decayed is that of what is left, as each segment keeps its digits.
        gap /= np.maximum(size, _TINY)
        # What the polynomials may miss is in the gap, too, and no segments' error.
        beyond = np.maximum(_MARGIN * (gap - table.tail), gap)
        whole = ROUNDED * rounding + table.tail + beyond
        gaps = np.max(np.abs(ours[0] - theirs[0])[..., :n, :], axis=1)
        largest = np.max(np.abs(theirs[0][..., :n, :]), axis=(1, 2, 3))[:, None, None]
        flow = np.maximum(ROUNDED * rounding + table.tail * largest, _MARGIN * gaps)
        errors = TableErrors(1.0 / tried, whole, size, flow, rounding)
        motion = np.full(n, ROUNDED * rounding)
        if slowest.forced:
            states, reach = closed(*ours, 1.0 / self.scale[-1])
            wanted, _ = closed(*theirs, 1.0 / self.scale[-1])
            size = (reach + 1.0) * np.max(np.abs(wanted[:, 0]), axis=1)
            gaps = np.max(np.abs(states - wanted)[:, :, :n], axis=1) / size[:, None]
            motion = np.maximum(motion, _MARGIN * np.max(gaps, axis=0))
        return table, errors, motion

    def readout(self, theta: Array) -> Array:
        """Return the matrices from the scaled state to dq/dtheta at angles, ``(nt, n, m)``."""
        n, unit = self.middle.size, self.middle.scale[0]
        rows = self.middle.generator(theta)[0, :, :n]
        rows = np.broadcast_to(rows, (len(theta), *rows.shape[1:]))
        return np.asarray(rows * unit[:, None])


def closed(flows: Array, whole: Array, unit: float) -> tuple[Array, Array]:
    """Return periodic states ``(ns, nt, m)`` and the reach of the start.

    The reach is the largest sum of a row of ``(I - X)^-1``.
    """
    m = whole.shape[-1] - 1
    try:
        inverse = np.linalg.inv(np.eye(m) - whole[:, :m, :m])
    except np.linalg.LinAlgError as singular:
        found = f"motions that grow by up to {np.max(np.abs(whole)):.3g} in a period"
        fix = "keep away from speeds so unstable, or take steady_state() there"
        raise bad("speeds", found, "a periodic motion that is known", fix) from singular
    first = np.full((len(whole), m + 1), unit)
    first[:, :m] = (inverse @ whole[:, :m, m:])[..., 0] * unit
    states = (flows @ first[:, None, :, None])[..., 0]
    return states, np.max(np.sum(np.abs(inverse), axis=-1), axis=-1)


def _check_inertia(system: LinearPeriodic) -> None:
    """Refuse inertia that depends on the speed: rates follow from momenta alike at all."""
    for term in system.terms:
        if term.array in ("M", "A") and term.power and term.array in SPEED_POWER:
            found, fix = f"a term {term.array} with a power of the speed", "use simulate"
            raise bad("prepare", found, "inertia that does not depend on the speed", fix)


def _converged(error: Array, scaled: Array, wanted: float) -> Mapping[str, Check]:
    """Return the check of matrices ``(ns, m, m)`` whose errors are over their largest entries."""
    # Of what has decayed the absolute error is wanted, not its last digits.
    absolute = error * np.minimum(1.0, np.max(np.abs(scaled), axis=(1, 2)))
    return {"converged": Check(float(np.max(absolute, initial=0.0)), wanted)}


def _checks(
    system: LinearPeriodic, theta: Array, q: Array, error: Array, single: Check | None
) -> Mapping[str, Check]:
    """Return accuracy and linear range of motions ``(ns, nt, n)`` at angles ``(nt,)``."""
    largest = Check(float(np.max(error)), _FAIR)
    checks = {"accuracy": largest} if single is None else {"converged": largest, "single": single}
    deflection = system.largest_deflection(theta, q)
    if deflection is not None:
        checks["linear range"] = Check(deflection, LINEAR_RANGE)
    return checks


def _periods(revolutions: int) -> int:
    given = numbers("revolutions", revolutions)
    if given.ndim or not 1 <= given <= 10**6 or given != int(given):
        raise bad("revolutions", revolutions, "a whole number of periods", "use simulate")
    return int(given)


def _ends(speeds: tuple[float, float] | float) -> tuple[float, float]:
    given = np.atleast_1d(numbers("speeds", speeds))
    fits = given.shape in ((1,), (2,)) and np.all(np.isfinite(given)) and np.all(given > 0)
    if not fits or given[0] > given[-1]:
        raise bad("speeds", speeds, "a rising pair of positive speeds [rad/s]", "correct it")
    return float(given[0]), float(given[-1])
