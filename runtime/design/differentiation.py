"""Derivatives of answers by the numbers of a machine, from one adjoint equation for all numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import require_between
from ..core.plotting import Axes, axes_or_new
from ..core.results import BROADCAST, Check, Result, provenance
from ..frequencies.natural import NaturalFrequencies
from ..linkages.linkage import Motion
from ..periodic.adjoint import field_weights
from ..periodic.equation import Equation, equation_of
from ..periodic.multipliers import (
    FloquetMultipliers,
    floquet_multipliers,
    multiplier_order,
    rounding_error,
)
from ..periodic.periodic_motion import SteadyState, steady_state
from ..periodic.transition import (
    Method,
    choose,
    product,
    refined,
    segments_from,
)
from ..recovery.stresses import StressResult
from ..rigid.forces import RigidForces
from ..scenes import Scene
from ..stability import StabilityEdges
from .closing import ClosingDamping
from .coefficient_changes import (
    SPEED,
    Changes,
    Effect,
    coefficient_changes,
    series_at,
    varying_parts,
)
from .rigid_answers import RigidAnswer, rigid_slopes
from .stress_rows import StressRow, slopes_in_one_state

if TYPE_CHECKING:
    from ..core.families import Nonlinear
    from ..nonlinear.response import ResponseCurve

ComplexArray = NDArray[np.complex128]
Machine: TypeAlias = "LinearPeriodic | Nonlinear | Scene"
Answer: TypeAlias = (
    "FloquetMultipliers | StabilityEdges | NaturalFrequencies | SteadyState | ResponseCurve"
    " | StressResult | ClosingDamping | RigidAnswer"
)

# Round-off of a derivative, over itself, from which multipliers or frequencies count as one; the
# least that a derivative is told against, over what its parts are in sum; the error of a peak's
# angle over that of the motion, over its peak; and what round-off of a sum's terms leaves, over all
# of them without signs.
_COLLIDED, _CANCELLED, _ANGLE, _SUMMED = 1e-6, 1e-6, 2.0, 4.0 * 2.0**-52
# Entries of vectors at all nodes that are handled at once (measured on a hundred speeds and one
# to five modes, with damping and without: 2^17 takes up to a third longer, 2^13 two thirds); angles
# of a period at which the motion is told whose stresses are differentiated.
_TOGETHER, _SAMPLES = 1 << 15, 512


@dataclass(frozen=True, kw_only=True)
class Sensitivities(Result):
    """Derivatives of an answer by numbers of the machine.

    Attributes
    ----------
    by : tuple of str
        Names of the k numbers.
    number : ndarray, shape (k,)
        Their values [SI]; of the speed NaN where there are several.
    answer : str
        What was differentiated, and its unit.
    value : ndarray, shape S
        The answer: multipliers ``(*batch, 2n)``; ends of regions ``(regions, 2)`` [rad/s]; natural
        frequencies along their curves ``(nt, count)`` [rad/s]; peaks of coordinates, with their
        sign, ``(*batch, n)``; largest stress of each beam, with its sign, ``(beams,)``; least
        damping of each region, ``(regions,)``; of a rigid machine each row that ``answer`` names,
        at the angles.
    derivative, error : ndarray, shape (*S, k)
        Derivatives, per SI unit of each number, and their errors.  NaN where there is none: of
        ends that are missing, of closed regions, of points where branches cross.
    collided : ndarray of bool, shape S
        Where multipliers or frequencies are so close that they have no derivatives of their own:
        those given are of their mean.
    """

    by: tuple[str, ...]
    number: Array
    answer: str
    value: NDArray[Any]
    derivative: NDArray[Any]
    collided: NDArray[np.bool_]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("value", "collided"), BROADCAST),
        **dict.fromkeys(("derivative", "error", "relative"), ("...", "by")),
        "number": ("by",),
    }
    exported: ClassVar[tuple[str, ...]] = ("relative",)

    @property
    def relative(self) -> NDArray[Any]:
        """Change of the answer, over its size, for a change of each number, over itself."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.derivative * self.number / np.abs(self.value)[..., None])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest relative change of the answer by each number as bars."""
        ax = axes_or_new(ax)
        sizes = np.abs(self.relative).reshape(-1, len(self.by))
        ax.barh(self.by, np.max(np.where(np.isfinite(sizes), sizes, 0.0), axis=0, initial=0.0))
        answer = self.answer.partition(" [")[0]
        ax.set(xlabel=f"change of {answer} for 1 % more of the number [%]")
        return ax


def sensitivities(
    machine: Machine, answer: Answer, by: Sequence[str], *, rtol: float = 1e-9
) -> Sensitivities:
    """Return the derivatives of an answer by numbers of the machine, lengths included.

    They are those of the equations that the answer was computed from: the adjoint of the
    collocation over the period says what changes of the coefficients do, however many numbers there
    are; the coefficients' own derivatives are those of the emitted functions.  Natural frequencies
    change by ``u^T (dK - w^2 dM) u / 2 w``; ends of unstable regions as the speed at which X - rho
    is singular; peaks of a motion at the angle at which they are.

    Parameters
    ----------
    machine : LinearPeriodic or Scene
        What the answer is of.
    answer : FloquetMultipliers, StabilityEdges, NaturalFrequencies, SteadyState, StressResult, \
ClosingDamping, ResponseCurve, Motion or RigidForces
        What :func:`floquet_multipliers`, :func:`stability_edges`, :func:`natural_frequencies`,
        :func:`steady_state`, :func:`stress`, :func:`closing_damping`, :func:`response_curve`, the
        mechanism's ``motion`` or :func:`rigid_forces` returned for it, without changed parameters.
    by : sequence of str
        Numbers: ``speed`` (not of ends), parameters and geometry of the system, and, where the
        machine is a scene, its dotted keys, such as ``links.coupler``: what the scene gives stays
        as given, what follows from it follows.
    rtol : float
        Wanted error of the derivatives by each number over the largest of them, 1e-12 to 1e-3; of
        a response curve they are as good as its motions, of a rigid machine as doubles allow.

    Returns
    -------
    Sensitivities
        Its check: ``converged``, the largest error over the largest derivative by its number.

    Raises
    ------
    BadInput
        If an argument is unusable, a name is no number of the machine, the answer is of another
        kind or of a system of another size, or coefficients are not smooth.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> edges = el.stability_edges(system, (75.0, 85.0))
    >>> slopes = el.design.sensitivities(system, edges, ["bending_stiffness"])
    >>> print(slopes.answer, slopes.relative.round(3))
    ends of unstable regions [rad/s] [[[0.5]
      [0.5]]]
    """
    require_between("rtol", rtol, 1e-12, 1e-3, "try 1e-9")
    if isinstance(answer, Motion | RigidForces):
        return _of_a_rigid_machine(machine, answer, by)
    if not isinstance(answer, tuple(_KINDS)):
        return _of_a_curve(machine, answer, by)
    system = machine.linear_system() if isinstance(machine, Scene) else machine
    if not isinstance(system, LinearPeriodic):
        fix = "take the .system() of a linear scene"
        raise bad("machine", type(machine).__name__, "a Scene or a linear system", fix)
    own = {SPEED, answer.name} if isinstance(answer, ClosingDamping) else {SPEED}
    if not isinstance(answer, FloquetMultipliers | SteadyState | StressResult) and own & {*by}:
        found = ", ".join(sorted(own & {*by}))
        raise bad("by", found, "numbers that the answer depends on", f"leave the {found} out")
    source = machine if isinstance(machine, Scene) else system
    changes = coefficient_changes(source, system, by)
    name, differentiate = _KINDS[type(answer)]
    if isinstance(answer, StressResult | ClosingDamping):
        differentiate = partial(differentiate, source)
    value, derivative, error, collided = differentiate(system, answer, changes, rtol)
    number = changes.number.copy()
    if SPEED in by and isinstance(answer, FloquetMultipliers | SteadyState | StressResult):
        speeds = np.unique(answer.speed)
        number[changes.by.index(SPEED)] = speeds[0] if len(speeds) == 1 else np.nan
    return Sensitivities(
        method="adjoint of the equation that the answer solves",
        error=error,
        error_norm="absolute, of each derivative",
        checks={"converged": Check(_worst(derivative, error), max(1e-6, rtol))},
        provenance=provenance(system.provenance),
        by=changes.by,
        number=number,
        answer=name,
        value=value,
        derivative=derivative,
        collided=collided,
    )


def _of_a_rigid_machine(machine: Machine, answer: RigidAnswer, by: Sequence[str]) -> Sensitivities:
    rows, value, derivative, error = rigid_slopes(machine, answer, by)
    assert isinstance(machine, Scene)
    return Sensitivities(
        method="differences of eighth order of the closed form",
        error=error,
        error_norm="absolute, of each derivative",
        checks={"converged": Check(_worst(derivative, error), 1e-6)},
        provenance=provenance(answer.provenance),
        by=tuple(by),
        number=np.array([machine.get(name) for name in by]),
        answer=", ".join(rows),
        value=value,
        derivative=derivative,
        collided=np.zeros(value.shape, dtype=bool),
    )


def _of_a_curve(machine: Machine, answer: Any, by: Sequence[str]) -> Sensitivities:
    """Return the derivatives of the special points of a response curve."""
    # What stays in the linear range imports nothing of this.
    from ..nonlinear.response import ResponseCurve
    from .special_points import special_numbers, special_slopes

    if not isinstance(answer, ResponseCurve):
        known = (
            "multipliers, ends of regions, natural frequencies, a steady state, its stresses, a "
        )
        known += "response curve, a rigid motion or its forces"
        raise bad("answer", type(answer).__name__, known, "differentiate one of these")
    numbers = special_numbers(machine, answer, by)
    derivative, error = special_slopes(answer, numbers)
    unit = "rad/s" if answer.parameter == "speed" else "SI"
    return Sensitivities(
        method="motions that close, or leave the unit circle, along the branch",
        error=error,
        error_norm="absolute, of each derivative",
        checks={"converged": Check(_worst(derivative, error), 1e-6)},
        provenance=provenance(answer.source.problem.system.provenance),
        by=tuple(by),
        number=np.array([number.value for number in numbers]),
        answer=f"{answer.parameter} at special points [{unit}]",
        value=answer.special_value,
        derivative=derivative,
        collided=np.zeros(error.shape[:1], dtype=bool),
    )


def _worst(derivative: NDArray[Any], error: Array) -> float:
    """Return the largest error over the largest derivative by the same number."""
    known = np.isfinite(error)
    sizes = np.where(known, np.abs(derivative), 0.0)
    largest = np.max(sizes, axis=tuple(range(error.ndim - 1)), initial=0.0)
    gaps = np.divide(error, largest, out=np.zeros(error.shape), where=known & (largest > 0.0))
    return float(np.max(gaps, initial=0.0))


def feeding_of(system: LinearPeriodic, edges: StabilityEdges) -> tuple[str, ...]:
    """Return for each region the array whose varying part does most for its width.

    By the derivatives of both ends; for a region that has none the name is empty.
    """
    changes = varying_parts(system)
    _, slope, *_ = _of_edges(system, edges, changes, 1e-6)
    shares = np.abs(slope[:, 1] - slope[:, 0])
    return tuple(
        changes.by[int(np.argmax(row))] if np.all(np.isfinite(row)) else "" for row in shares
    )


# Value, derivative, error and where two answers have collided.
_Found = tuple[NDArray[Any], NDArray[Any], Array, NDArray[np.bool_]]


class _Rows(NamedTuple):
    """Functionals of the derivative of a transition matrix, and what is made of them."""

    rows: ComplexArray  # (nb, functionals, m)
    states: ComplexArray  # (nb, functionals, m)
    # To derivatives and their errors, parts and round-off over the largest, ``(nb, answers, k)``.
    finished: Callable[[Effect], tuple[NDArray[Any], Array, Array, Array]]


@dataclass(frozen=True)
class _Adjoint:
    """Derivatives of what transition matrices of the period from an angle tell."""

    changes: Changes
    rows: Callable[[Equation, ComplexArray, int], _Rows]  # of members, their matrices, segments
    rtol: float
    begin: float = 0.0

    def solved(self, equation: Equation) -> tuple[NDArray[Any], ...]:
        """Return derivatives, errors, and round-off over the largest, ``(nb, answers, k)``."""
        way, rtol = choose(equation, self.rtol), self.rtol
        members, shares, _ = refined(equation, way, rtol, partial(self._solve, way), _distance)
        slope, error, top, shake, unit = (np.array(one) for one in zip(*members, strict=True))
        error = error + shares.reshape(slope.shape) * unit + shake * top
        return slope, error, shake

    def _solve(self, way: Method, equation: Equation, count: int) -> tuple[NDArray[Any], ...]:
        """Solve for some members at a time, whose nodes stay in the cache."""
        members, entries = len(equation.speed), 2 * equation.size**2 * way.stages * count
        pieces = min(members, -(-members * entries // _TOGETHER))
        if pieces == 1:
            return self._solved_part(way, equation, count)
        some = np.array_split(np.arange(members), pieces)
        parts = [self._solved_part(way, equation.take(one), count) for one in some]
        return tuple(np.concatenate(each) for each in zip(*parts, strict=True))

    def _solved_part(self, way: Method, equation: Equation, count: int) -> tuple[NDArray[Any], ...]:
        h = equation.period / count
        left = self.begin + h * np.arange(float(count))
        segments = segments_from(equation, left, h, way, slopes=True)
        matrix, power = product(segments.maps)
        found = self.rows(equation, np.ldexp(matrix, power[:, None, None]), count)
        rows, states = found.rows, found.states
        weights = field_weights(equation, way, segments, rows, states, begin=self.begin)
        effect = self.changes.effect(weights, equation.speed)
        slope, error, bulk, shake = found.finished(effect)
        top = np.maximum(np.abs(slope), _CANCELLED * bulk)
        top = np.maximum(np.max(top, axis=1, keepdims=True), np.finfo(float).tiny)
        # No rung is nearer to another than round-off.
        unit = top * np.maximum(1.0, 4.0 * shake / self.rtol)
        return slope, error, top, np.broadcast_to(shake, slope.shape), unit


def _distance(
    coarse: tuple[NDArray[Any], ...], fine: tuple[NDArray[Any], ...]
) -> tuple[Array, Array]:
    """Return the differences of derivatives, over the largest or round-off; and none besides."""
    gap = (np.abs(fine[0] - coarse[0]) / fine[4]).reshape(len(fine[0]), -1)
    return gap, np.zeros(gap.shape)


def _of_multipliers(
    system: LinearPeriodic, answer: FloquetMultipliers, changes: Changes, rtol: float
) -> _Found:
    equation, shape = equation_of(system, answer.speed), answer.multipliers.shape
    slope, error, shake = _Adjoint(changes, _eigenvectors, rtol).solved(equation)
    collided = np.max(shake, axis=-1) > _COLLIDED
    some = np.flatnonzero(np.any(collided, axis=1))
    if some.size:
        own, off, _ = _Adjoint(changes, _subspaces, rtol).solved(equation.take(some))
        where = collided[some][..., None]
        slope[some] = np.where(where, own, slope[some])
        error[some] = np.where(where, off, error[some])
    turned = [one.reshape(*shape, -1) for one in (slope, error)]
    return answer.multipliers, turned[0], turned[1], collided.reshape(shape)


def _eigenvectors(equation: Equation, matrix: ComplexArray, count: int) -> _Rows:
    values, vectors = _eigen(matrix)
    rows = _dual(vectors)
    shake, _ = _shaken(equation, matrix, count, values, rows, vectors)
    # One of two conjugate multipliers tells of both.
    kept = np.flatnonzero(np.any(values.imag >= 0.0, axis=0))
    gaps = np.abs(values[:, :, None] - values[:, None, kept].conj())
    source, own = np.argmin(gaps, axis=-1)[..., None], np.zeros(values.shape[1], dtype=bool)
    source[:, kept, 0], own[kept] = np.arange(len(kept)), True

    def finished(found: Effect) -> tuple[NDArray[Any], Array, Array, Array]:
        slope = np.take_along_axis(found.slope, source, 1)
        error, bulk = (np.take_along_axis(one, source, 1) for one in (found.error, found.bulk))
        slope = np.where(own[:, None], slope, slope.conj())
        return slope, error, bulk, shake[..., None]

    return _Rows(rows[:, kept], vectors.mT[:, kept], finished)


def _dual(vectors: ComplexArray) -> ComplexArray:
    """Return the rows that belong to columns; of what coincides to the last digit no error."""
    return np.asarray(np.linalg.pinv(vectors), dtype=complex)


def _eigen(matrix: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return multipliers in their order, and the vectors as columns."""
    values, vectors = (one.astype(complex) for one in np.linalg.eig(matrix))
    with np.errstate(divide="ignore"):
        order = multiplier_order(np.log(np.abs(values)), np.angle(values))
    values = np.take_along_axis(values, order, -1)
    return values, np.take_along_axis(vectors, order[:, None, :], -1)


def _shaken(
    equation: Equation,
    matrix: ComplexArray,
    count: int,
    values: ComplexArray,
    rows: ComplexArray,
    vectors: ComplexArray,
    alike: NDArray[np.bool_] | None = None,
) -> tuple[Array, Array]:
    """Return round-off of derivatives over the largest, and that by each other multiplier.

    Vectors err by round-off over the distance of the others, but those that are taken as one.
    """
    alike = np.eye(values.shape[1], dtype=bool) if alike is None else alike
    distance = np.where(alike, np.inf, np.abs(values[:, :, None] - values[:, None, :]))
    norm = np.linalg.norm(matrix, ord=2, axis=(-2, -1))[:, None, None]
    size = np.linalg.norm(rows, axis=-1) * np.linalg.norm(vectors, axis=-2)
    rounding = rounding_error(equation, count)[:, None, None] * size[..., None]
    each = rounding * norm / np.maximum(distance, np.finfo(float).eps * norm)
    return rounding[..., 0] + np.max(each, axis=-1), each


def _together(near: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which of m belong together, ``(..., m, m)``, by neighbours of neighbours."""
    m = near.shape[-1]
    links = np.linalg.matrix_power((near | near.mT) + np.eye(m), m)
    return np.asarray(links > 0.0)


def _subspaces(equation: Equation, matrix: ComplexArray, count: int) -> _Rows:
    """Return the functionals of the means of multipliers that coincide.

    These alone are smooth: with bases V of what belongs to them and W of the dual, ``W V = 1``,
    their mean moves by the trace of ``W dX V`` over their number.
    """
    from scipy.linalg import schur

    values, vectors = _eigen(matrix)
    each = _shaken(equation, matrix, count, values, _dual(vectors), vectors)[1]
    alike = _together(each > 0.5 * _COLLIDED)
    for one, close, own, columns in zip(matrix, alike, values, vectors, strict=True):
        for group in np.unique(close, axis=0):
            if np.sum(group) > 1:
                middle = np.mean(own[group])
                reach = 1.5 * np.max(np.abs(own[group] - middle)) + np.finfo(float).eps

                def within(value: complex, middle: complex = middle, reach: float = reach) -> bool:
                    return abs(value - middle) <= reach

                _, basis, known = schur(one, "complex", sort=within)
                if known == np.sum(group):
                    columns[:, group] = basis[:, :known]
    rows = _dual(vectors)
    shake, _ = _shaken(equation, matrix, count, values, rows, vectors, alike)
    mean = alike / np.sum(alike, axis=-1, keepdims=True)

    def finished(found: Effect) -> tuple[NDArray[Any], Array, Array, Array]:
        return mean @ found.slope, mean @ found.error, mean @ found.bulk, shake[..., None]

    return _Rows(rows, vectors.mT, finished)


def _of_edges(
    system: LinearPeriodic, answer: StabilityEdges, changes: Changes, rtol: float
) -> _Found:
    ends = np.stack([answer.lower, answer.upper], axis=1)
    known = np.isfinite(ends) & (answer.width > 0.0)[:, None]
    derivative = np.full((*ends.shape, len(changes.by)), np.nan)
    error = np.full(derivative.shape, np.inf)
    if np.any(known):
        adjoint = _Adjoint(changes, _null_vectors, rtol)
        slope, own, _ = adjoint.solved(equation_of(system, ends[known]))
        derivative[known], error[known] = slope[:, 0], own[:, 0]
        # An end that is off by a part of half the width has as much of the other end's derivative.
        apart = np.abs(np.diff(derivative, axis=1))
        off = np.divide(answer.error, answer.width, out=np.zeros(len(ends)), where=known[:, 0])
        error += 2.0 * off[:, None, None] * np.where(np.isfinite(apart), apart, 0.0)
    return ends, derivative, error, np.isfinite(ends) & ~known


def _null_vectors(equation: Equation, matrix: ComplexArray, count: int) -> _Rows:
    """Return null vectors x and y of X - rho on both sides, at speeds where a region ends.

    Without damping two multipliers meet there, y x = 0: the speed moves by the ratio of y dX x by
    number and by speed.  With damping rho is alone, and its modulus moves by the real part of
    y dX x / rho y x.  Round-off turns x and y towards the next vectors, which in a narrow region
    tell nearly the same.
    """
    rho = np.array([_at_edge(np.linalg.eigvals(one), equation.damped) for one in matrix])
    left, sizes, right = np.linalg.svd(matrix - rho[:, None, None] * np.eye(matrix.shape[-1]))
    rows, states = left[:, :, [-1, -1, -2]].mT.conj(), right[:, [-1, -2, -1]].conj()
    turned = rounding_error(equation, count) * sizes[:, 0] / sizes[:, -2]

    def finished(found: Effect) -> tuple[NDArray[Any], Array, Array, Array]:
        unit = found.by_speed[:, 0]
        if equation.damped:
            unit = rho * np.einsum("bi,bi->b", rows[:, 0], states[:, 0])
        slopes = np.real(found.slope / unit[:, None, None])
        paces = np.real(found.by_speed / unit[:, None])[..., None]
        moved = -slopes[:, :1] / paces[:, :1]
        aside = np.sum(np.abs(slopes[:, 1:] + moved * paces[:, 1:]), axis=1, keepdims=True)
        size = np.abs(unit[:, None, None] * paces[:, :1])
        shake = turned[:, None, None] * aside / np.abs(paces[:, :1])
        bulk = found.bulk[:, :1] / size
        top = np.maximum(np.abs(moved), _CANCELLED * bulk)
        least = 0.25 * rounding_error(equation, count)[:, None, None]
        shake = least + np.divide(shake, top, out=np.zeros(top.shape), where=top > 0.0)
        return moved, 0.5 * found.error[:, :1] / size + _SUMMED * bulk, bulk, shake

    return _Rows(rows, states, finished)


def _at_edge(values: ComplexArray, damped: bool) -> complex:
    """Return the multiplier on the unit circle where a region begins."""
    if damped:
        return complex(values[np.argmin(np.abs(np.log(np.abs(values))))])
    distance = np.abs(values[:, None] - values[None, :]) + 4.0 * np.eye(len(values))
    i, j = np.unravel_index(np.argmin(distance), distance.shape)
    middle = values[i] + values[j]
    return complex(middle / abs(middle))


def _of_peaks(system: LinearPeriodic, answer: SteadyState, changes: Changes, rtol: float) -> _Found:
    # The angle of a peak is to be known as well as its derivatives.
    fine = steady_state(system, answer.speed, rtol=1e-11)
    motions, errors = fine.q.reshape(-1, *fine.q.shape[-2:]), fine.error.reshape(-1, system.size)
    count, n = len(motions), system.size
    value, derivative = np.empty((count, n)), np.full((count, n, len(changes.by)), np.nan)
    error = np.full(derivative.shape, np.inf)
    for i, speed in enumerate(answer.speed.ravel()):
        equation = equation_of(system, speed, forcing=True)
        for j in range(n):
            angle, value[i, j] = _peak(motions[i, :, j], answer.period)
            if np.isfinite(angle):
                rows = partial(_at_angle, partial(_coordinate, j, angle), _ANGLE * errors[i, j])
                slope, own, _ = _Adjoint(changes, rows, rtol, angle).solved(equation)
                derivative[i, j], error[i, j] = slope[0, 0].real, own[0, 0]
    shape = answer.error.shape
    turned = [one.reshape(*shape, -1) for one in (derivative, error)]
    return value.reshape(shape), turned[0], turned[1], np.zeros(shape, dtype=bool)


def _peak(values: Array, period: float) -> tuple[float, float]:
    """Return the angle of the largest size of a motion and its value there, by its series."""
    if not np.all(np.isfinite(values)):
        return np.nan, np.nan
    count, place = len(values), int(np.argmax(np.abs(values)))
    series = np.fft.rfft(values) / count
    series[1:] *= 2.0
    order = 1j * np.arange(len(series)) * 2.0 * np.pi / period
    angle = start = period * place / count
    for _ in range(50):
        wave = series * np.exp(order * angle)
        slope, bend = (float(np.sum(order**k * wave).real) for k in (1, 2))
        step = -slope / bend if bend else 0.0
        angle = min(max(angle + step, start - period / count), start + period / count)
        if abs(step) < 1e-14 * period:
            break
    return angle % period, float(np.sum(series * np.exp(order * angle)).real)


def _coordinate(index: int, angle: float, equation: Equation) -> Array:
    """Return a coordinate and its rate as rows of the scaled state, ``(nb, 2, m)``."""
    m, unit = 2 * equation.size, equation.scale[:, index, None]
    rate = equation.generator(np.array([angle]))[:, 0, index, :m]
    return np.stack([unit * np.eye(m)[index], unit * rate], axis=1)


def _at_angle(
    told: Callable[[Equation], Array],
    off: float,
    equation: Equation,
    matrix: ComplexArray,
    count: int,
) -> _Rows:
    """Return what is told of the state at the beginning of a period: of ``(1 - X)^-1 z``.

    A peak's angle is known to ``off`` [rad]: what that does, the derivatives of the rate tell.
    """
    m = 2 * equation.size
    closing = np.eye(m) - matrix[:, :m, :m]
    state = np.ones((len(matrix), 1, m + 1), dtype=complex)
    state[:, 0, :m] = np.linalg.solve(closing, matrix[:, :m, m:])[..., 0]
    rows = np.zeros((len(matrix), 2, m + 1), dtype=complex)
    rows[..., :m] = np.linalg.solve(closing.mT, told(equation).mT).mT
    shake = 2.0 * rounding_error(equation, count) * np.linalg.cond(closing)

    def finished(found: Effect) -> tuple[NDArray[Any], Array, Array, Array]:
        error = found.error[:, :1] + off * np.abs(found.slope[:, 1:])
        return found.slope[:, :1], error, found.bulk[:, :1], shake[:, None, None]

    return _Rows(rows, np.repeat(state, 2, axis=1), finished)


def _of_stresses(
    machine: LinearPeriodic | Scene,
    system: LinearPeriodic,
    answer: StressResult,
    changes: Changes,
    rtol: float,
) -> _Found:
    """Return the derivatives of the largest stress of each beam in a steady motion."""
    if answer.period is None:
        fix = "give stress a speed or a SteadyState"
        raise bad("answer", "stresses of another motion", "those of a steady motion", fix)
    # The angle of a peak is to be known as well as its derivatives.
    fine = steady_state(system, answer.speed, rtol=1e-11, samples=_SAMPLES)
    equation = equation_of(system, answer.speed, forcing=True)
    peaks = answer.maxima
    value, share, told = np.empty(len(peaks)), np.empty((len(peaks), 1)), []
    slope, error = np.empty((2, len(peaks), len(changes.by)))
    for i, (link, peak) in enumerate(peaks.items()):
        row = StressRow(link, peak.place, peak.fibre, answer.method)
        history, doubt = row.history(system, fine)
        angle, value[i] = _peak(history, answer.period)
        told.append((row, angle))
        share[i] = doubt / abs(value[i])
        rows = partial(_at_angle, partial(row.rows, system, angle), _ANGLE * share[i, 0])
        found, own, _ = _Adjoint(changes, rows, rtol, angle).solved(equation)
        slope[i], error[i] = found[0, 0].real, own[0, 0]
    direct, rough = slopes_in_one_state(machine, system, fine, told, changes.by)
    error += rough + share * np.abs(direct)
    return value, slope + direct, error, np.zeros(value.shape, dtype=bool)


def _of_closing(
    machine: LinearPeriodic | Scene,
    system: LinearPeriodic,
    answer: ClosingDamping,
    changes: Changes,
    rtol: float,
) -> _Found:
    """Return the derivatives of the damping at which the highest growth over the speeds is nought.

    The speed is that of the highest growth: the growth does not change with it.
    """
    slope = np.full((len(answer.damping), len(changes.by)), np.nan)
    error = np.full(slope.shape, np.inf)
    for i in np.flatnonzero(np.isfinite(answer.damping)).tolist():
        held = {answer.name: float(answer.damping[i])}
        moved, by = system.with_parameters(**held), [*changes.by, answer.name]
        own = coefficient_changes(machine, moved, by, held)
        # At the speed, and as far beside it as it may be off.
        speeds = answer.speed[i] + np.array([0.0, answer.speed_error[i]])
        found = floquet_multipliers(moved, speeds, rtol=1e-11)
        value, by_number, doubt, _ = _of_multipliers(moved, found, own, rtol)
        growth, doubt = np.real(by_number[:, 0] / value[:, :1]), doubt[0, 0] / np.abs(value[0, 0])
        slopes = -growth[:, :-1] / growth[:, -1:]
        slope[i], rate = slopes[0], abs(growth[0, -1])
        error[i] = (doubt[:-1] + np.abs(slope[i]) * doubt[-1]) / rate
        error[i] += np.abs(slopes[1] - slopes[0])
        error[i] += answer.error[i] * np.abs(slope[i] / answer.damping[i])
    return answer.damping, slope, error, np.isnan(answer.damping)


def _of_frequencies(
    system: LinearPeriodic, answer: NaturalFrequencies, changes: Changes, rtol: float
) -> _Found:
    """Return the derivatives along the curves, ``u^T (dK + dKg - w^2 dM) u / 2 w``."""
    shapes, values = answer.shape, answer.tracked
    table, speed = changes.table(answer.theta), answer.speed
    slope, rough, size, off = (np.zeros((*values.shape, len(changes.by))) for _ in range(4))
    for array, power in changes.parts:
        if array not in ("M", "K", "Kg") or (array == "Kg" and speed == 0.0 and power > 0):
            continue
        pace = speed**power if array == "Kg" else 1.0
        factor = -0.5 * values if array == "M" else 0.5 * pace / values

        def of(change: Array, shapes: Array = shapes, factor: Array = factor) -> Array:
            return np.asarray(factor * np.einsum("tik,tij,tjk->tk", shapes, change, shapes))

        for i in range(len(changes.by)):
            change = changes.slopes[array, power][i]
            moved = series_at(table, change)
            slope[..., i] += of(moved)
            rough[..., i] += of(series_at(table, changes.rough[array, power][i]))
            size[..., i] += np.abs(of(np.abs(moved), np.abs(shapes)))
            rounded = series_at(np.abs(table), changes.round_off((array, power), np.array([i]))[0])
            off[..., i] += np.abs(of(rounded, np.abs(shapes)))
    distance = np.abs(values[:, :, None] - values[:, None, :]) / values[:, :, None]
    distance = np.maximum(distance, np.finfo(float).eps)
    own = answer.error / values
    alike = _together(own[:, :, None] / distance > _COLLIDED)
    distance[alike] = np.inf
    shake = own * (1.0 + 1.0 / np.min(distance, axis=-1))
    error = np.abs(slope - rough) + off + (np.finfo(float).eps + shake[..., None]) * size
    # Of those that coincide the mean is smooth.
    mean = alike / np.sum(alike, axis=-1, keepdims=True)
    return values, mean @ slope, mean @ error, np.sum(alike, axis=-1) > 1


_KINDS: Mapping[type, tuple[str, Callable[..., _Found]]] = {
    FloquetMultipliers: ("multipliers", _of_multipliers),
    StabilityEdges: ("ends of unstable regions [rad/s]", _of_edges),
    NaturalFrequencies: ("natural frequencies [rad/s]", _of_frequencies),
    SteadyState: ("peaks of the coordinates", _of_peaks),
    StressResult: ("largest stress of each beam [Pa]", _of_stresses),
    ClosingDamping: ("least damping that closes a region", _of_closing),
}
