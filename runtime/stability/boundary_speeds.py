"""Crank speeds at which a linear periodic system has a periodic or antiperiodic motion.

A motion ``q = sum_k q_k exp(i kappa_k 2 pi theta/T)`` with whole kappa is periodic (multiplier +1),
with half-odd kappa antiperiodic (multiplier -1).  The weak form of the Lagrangian,

    w^2 [d M d + d A - A^T d - B] q + w (C d + D) q + (K + Kg) q = 0,   d = d/dtheta,

needs no derivative of a coefficient, and is symmetric where the system is undamped: its Fourier
matrices, one for each power of the speed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import ceil
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers_in_a_row, require_between, speed_span
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, DeferredChecks, Result, provenance
from ..periodic import Monodromy, monodromy
from ..periodic.equation import SPEED_POWER, equation_of, sampled

ComplexArray = NDArray[np.complex128]


# Fourier coefficients ``(2 r + 1, n, n)``, for harmonics -r to r of the period, of the terms of one
# array that carry one power of the speed.
Waves = Mapping[tuple[str, int], ComplexArray]


def waves(system: LinearPeriodic, parameters: Mapping[str, ArrayLike]) -> Waves:
    """Return the Fourier coefficients of the terms that act at constant speed without forcing.

    A parameter that is not one number is refused, and a term not smooth enough to have a series.
    """
    for name, value in parameters.items():
        if np.ndim(value) != 0 or not np.isfinite(np.asarray(value, dtype=float)):
            raise bad(name, value, "one finite number", "treat one parameter value at a time")
    scales = system.scale_values(**parameters)
    known = sampled(system)
    if known.harmonics < 0:
        given = "a function whose Fourier series does not end"
        fix = "check it for jumps and kinks"
        raise bad("LinearPeriodic.terms", given, "smooth periodic functions", fix)
    # Harmonics from 0 on, like terms added up.
    sums: dict[tuple[str, int], ComplexArray] = {}
    for place, term in enumerate(system.terms):
        factor = 1.0 if term.scale is None else float(scales[term.scale])
        if term.array not in SPEED_POWER or term.array in "fhp" or factor == 0.0:
            continue
        series = known.series.get(place)
        if series is None:
            series = np.asarray(term(np.zeros(1)), dtype=float)
        half = len(series) // 2
        key = term.array, 2 + SPEED_POWER[term.array] + term.power
        total = sums.setdefault(
            key, np.zeros((known.harmonics + 1, system.size, system.size), dtype=complex)
        )
        total[0] += factor * series[0]
        total[1 : half + 1] += 0.5 * factor * (series[1 : half + 1] - 1j * series[half + 1 :])
    found = {}
    for key, total in sums.items():
        size = np.max(np.abs(total), axis=(1, 2))
        # Below this, over the largest, the last harmonics are round-off.
        reach = int(np.flatnonzero(size > 4e-16 * np.max(size))[-1]) if np.any(size) else 0
        upper = total[: reach + 1]
        found[key] = np.concatenate([np.conj(upper[:0:-1]), upper])
    return found


def real_matrices(
    found: Waves, size: int, period: float, harmonics: int, multiplier: int
) -> dict[int, Array]:
    """Return the matrices of the equation by power of the speed, in a real basis.

    The basis is, per coordinate, ``1`` (periodic motions only), then ``sqrt(2) cos`` and
    ``sqrt(2) sin`` of each harmonic, ordered by harmonic and, within it, by coordinate.
    """
    highest = harmonics if multiplier == 1 else harmonics - 0.5
    kappa = np.arange(-highest, highest + 0.25, dtype=np.float64)
    rate: Array = 2 * np.pi / period * kappa
    count = len(kappa)
    totals: dict[int, ComplexArray] = {}
    for (array, exponent), coefficients in found.items():
        total = totals.setdefault(exponent, np.zeros((count, size, count, size), dtype=complex))
        for shift, block in enumerate(coefficients, start=-(len(coefficients) // 2)):
            # Row k, column l = k - shift.
            rows = np.arange(max(0, shift), min(count, count + shift))
            columns = rows - shift
            left, right = (rate[index][:, None, None] for index in (rows, columns))
            total[rows, :, columns, :] += _entry(array, block, left, right)
    return {exponent: _in_real_basis(total) for exponent, total in totals.items()}


def _entry(array: str, block: ComplexArray, left: Array, right: Array) -> ComplexArray:
    """Return the entries that one harmonic of one array adds; left, right are -i d/dtheta."""
    if array == "M":
        return -left * right * block
    if array == "A":
        return 1j * (left * block - right * block.T)
    if array == "B":
        return -block
    if array == "C":
        return 1j * right * block
    return block


def _in_real_basis(total: ComplexArray) -> Array:
    """Carry a matrix ``(K, n, K, n)``, kappa rising, to cosines and sines; ``(K n, K n)``."""
    # The entries at -kappa, -lambda are conjugate to those at kappa, lambda, so the rows of
    # positive kappa say everything.
    count, n = total.shape[:2]
    middle, odd = divmod(count, 2)
    rows = total[middle + odd :]
    same, cross = rows[:, :, middle + odd :], rows[:, :, :middle][:, :, ::-1]
    out = np.empty((count, n, count, n))
    cosine, sine = slice(odd, None, 2), slice(odd + 1, None, 2)
    out[cosine, :, cosine] = (same + cross).real
    out[sine, :, sine] = (same - cross).real
    out[cosine, :, sine] = (same - cross).imag
    out[sine, :, cosine] = -(same + cross).imag
    if odd:
        root = np.sqrt(2.0)
        above, beside = total[middle, :, middle + 1 :], rows[:, :, middle]
        out[0, :, 0] = total[middle, :, middle].real
        out[0, :, cosine], out[0, :, sine] = root * above.real, root * above.imag
        out[cosine, :, 0], out[sine, :, 0] = root * beside.real, -root * beside.imag
    return out.reshape(count * n, count * n)


Matrices = dict[int, Array]

_EPS = float(np.finfo(float).eps)
_MOST_ROWS = 4000
# Relative distance up to which roots are told apart within their own span.
_NEARLY_DOUBLE = 1e-6
# Widest gaps between boundaries whose middles are test speeds.
_GAPS = 14


@dataclass(frozen=True, kw_only=True)
class SpeedBoundaries(Result):
    """Speeds at which a Floquet multiplier is exactly +1 or -1.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], rising, shape ``(k,)``; a double one occurs twice.
    multiplier : ndarray of int
        +1 or -1, shape ``(k,)``.
    error : ndarray
        Absolute error of each speed [rad/s], shape ``(k,)``.
    cosine, sine : ndarray
        The motion itself, ``q(theta) = sum_j cosine[j] cos(kappa_j x) + sine[j] sin(kappa_j x)``
        with x = 2 pi theta/period and kappa_j = j (multiplier +1) or j + 1/2 (-1); each
        ``(k, harmonics + 1, n)``, scaled to a sum of squares of 1.
    harmonics : int
        Highest harmonic that was used.
    period : float
        Period of the coefficients [rad].
    """

    speed: Array
    multiplier: NDArray[np.int64]
    cosine: Array
    sine: Array
    harmonics: int
    period: float

    arrays_along: ClassVar = {
        "boundary": "speed multiplier error",
        "boundary harmonic coordinate": "cosine sine",
    }
    column_units: ClassVar = {"rad/s": "error", "rad": "period"}

    def motion(self, index: int, theta: ArrayLike) -> Array:
        """Return the motion of one boundary at crank angles ``(nt,)``, shape ``(nt, n)``."""
        angles = np.atleast_1d(np.asarray(theta, dtype=float))
        shift = 0.0 if self.multiplier[index] == 1 else 0.5
        kappa = 2 * np.pi / self.period * (np.arange(self.cosine.shape[1]) + shift)
        phase = angles[:, None] * kappa
        return np.asarray(np.cos(phase) @ self.cosine[index] + np.sin(phase) @ self.sine[index])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the boundaries as lines over the speed and return the axes."""
        ax = axes_or_new(ax)
        for sign, colour in ((1, "C0"), (-1, "C1")):
            for speed in self.speed[self.multiplier == sign]:
                ax.axvline(speed * RPM, color=colour, linewidth=0.8)
            ax.plot([], [], color=colour, label=f"multiplier {sign:+d}")
        ax.set(xlabel="crank speed [rpm]", yticks=[])
        ax.legend()
        return ax


def speed_boundaries(
    system: LinearPeriodic,
    multiplier: int | Sequence[int] = (1, -1),
    *,
    speed_range: tuple[float, float],
    rtol: float = 1e-11,
    **parameters: float,
) -> SpeedBoundaries:
    """Return the speeds at which a periodic or antiperiodic motion exists.

    These are the boundaries of the simple unstable regions of each mode and, where single modes
    meet +1 or -1 in another way, of divergence.  Combination resonances, where multipliers leave
    the unit circle in conjugate pairs, have no such motion and do not appear.

    The Fourier matrix of the truncated problem is a polynomial in the speed.  Undamped systems
    give a symmetric definite problem, linear in the speed squared; damping or other powers of the
    speed give a companion problem of which the real roots count.  Every root is refined on the
    polynomial itself, and the truncation is raised until no root moves.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    multiplier : int or sequence of int
        +1, -1 or both.
    speed_range : pair of float
        Lowest and highest speed [rad/s], the lowest positive: boundaries accumulate at zero.
    rtol : float
        Relative change of a speed at which the truncation is enough.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    SpeedBoundaries
        Its checks: ``truncation``, how far a larger truncation moves a speed, relatively;
        ``parity``, the number of test speeds at which integration contradicts the count of
        boundaries; ``monodromy``, the smallest singular value of (monodromy matrix - multiplier),
        relative to the matrix, from integration, at up to 256 of the boundaries.

    Raises
    ------
    BadInput
        If an argument is unusable, or the lowest speed needs a larger matrix than 4000 rows.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> found = el.speed_boundaries(system, speed_range=(75.0, 85.0))
    >>> print(found.speed.round(2), found.multiplier)
    [78.84 80.54] [1 1]
    """
    signs = numbers_in_a_row("multiplier", multiplier)
    if not np.all(np.isin(signs, (1, -1))):
        raise bad("multiplier", multiplier, "+1, -1 or both", "correct it")
    low, high = speed_span(speed_range)
    require_between("rtol", rtol, 1e-14, 1.0, "choose 1e-11")
    rate = float(equation_of(system, low, parameters).rate()[0])
    found = waves(system, parameters)
    reach = max(len(coefficients) // 2 for coefficients in found.values())
    usual = ceil(rate * system.period / (2 * np.pi)) + reach + 6
    most = _MOST_ROWS // (2 * system.size)

    def matrices(sign: int, harmonics: int) -> Matrices:
        if harmonics > most:
            given = f"a lowest speed of {low:.4g} rad/s, which needs {harmonics} harmonics"
            fix = "raise the lowest speed or leave out the highest modes"
            raise bad("speed_range", given, f"at most {most}", fix)
        return real_matrices(found, system.size, system.period, harmonics, sign)

    parts = [
        _converged(partial(matrices, sign), sign, (low, high), usual, rtol)
        for sign in sorted({int(sign) for sign in signs}, reverse=True)
    ]
    return _result(system, parts, (low, high), rtol, parameters)


@dataclass(frozen=True)
class _Roots:
    """Roots of one truncation, with their vectors in the real basis, ``(k, m)``.

    ``truncation`` is the largest relative change by a larger truncation.
    """

    multiplier: int
    harmonics: int
    speed: Array
    error: Array
    vectors: Array
    truncation: float = 0.0

    def columns(self, size: int, harmonics: int) -> tuple[Array, ...]:
        """Return speeds, errors, multipliers, and cosines and sines ``(k, harmonics + 1, n)``."""
        blocks = self.vectors.reshape(len(self.speed), self.vectors.shape[1] // size, size)
        first = 1 if self.multiplier == 1 else 0
        last = first + (blocks.shape[1] - first) // 2
        cosine, sine = np.zeros((2, len(blocks), harmonics + 1, size))
        cosine[:, :first] = blocks[:, :first]
        cosine[:, first:last] = np.sqrt(2) * blocks[:, first::2]
        sine[:, first:last] = np.sqrt(2) * blocks[:, first + 1 :: 2]
        return self.speed, self.error, np.full(len(blocks), self.multiplier), cosine, sine


def _converged(
    matrices: Callable[[int], Matrices],
    sign: int,
    span: tuple[float, float],
    harmonics: int,
    rtol: float,
) -> _Roots:
    """Raise the truncation until no root moves and none appears."""
    coarse, before = _roots(matrices(harmonics), sign, harmonics, span), np.inf
    while True:
        harmonics = harmonics + max(6, harmonics // 4)
        fine = _roots(matrices(harmonics), sign, harmonics, span)
        if len(fine.speed) == len(coarse.speed):
            change = np.abs(fine.speed - coarse.speed)
            moved = float(np.max(change / fine.speed, initial=0.0))
            if moved <= rtol:
                # The change is the coarse truncation's error; the fine one's falls on as it fell.
                left = min(max(moved / before, 0.1), 1.0) if before > 0.0 else 1.0
                return replace(fine, error=fine.error + left * change, truncation=moved)
            before = moved
        coarse = fine


def _roots(matrices: Matrices, sign: int, harmonics: int, span: tuple[float, float]) -> _Roots:
    low, high = span
    lowest = min(matrices)
    matrices = {power - lowest: matrix for power, matrix in matrices.items()}
    even = all(power % 2 == 0 for power in matrices)
    unit = float(np.sqrt(low * high))
    stride = 2 if even else 1
    degree = max(matrices) // stride
    zero = np.zeros_like(next(iter(matrices.values())))
    levels = [matrices.get(stride * j, zero) * unit ** (stride * j) for j in range(degree + 1)]
    symmetric = even and all(
        np.max(np.abs(level - level.T)) <= 1e-13 * np.max(np.abs(level), initial=1e-300)
        for level in levels
    )
    inverse, vectors = inverse_roots(levels, symmetric)
    with np.errstate(divide="ignore", invalid="ignore"):
        # A pair so close to the real axis is a double real root.
        real = (np.abs(inverse.imag) <= 1e-6 * np.abs(inverse)) & (inverse.real > 0)
        speed = np.where(real, unit * np.abs(inverse) ** (-1 / stride), np.inf)
    near = (speed >= low * (1 - 1e-3)) & (speed <= high * (1 + 1e-3))
    index = np.flatnonzero(near)
    index = index[np.argsort(speed[index], kind="stable")]
    start = None if vectors is None else vectors[:, index].T
    imaginary = np.abs(inverse.imag[index] / inverse[index]) * speed[index] / stride
    refined, error, motions = _refined(matrices, speed[index], start, symmetric)
    inside = (refined >= low) & (refined <= high)
    order = np.flatnonzero(inside)[np.argsort(refined[inside], kind="stable")]
    return _Roots(sign, harmonics, refined[order], (error + imaginary)[order], motions[order])


def inverse_roots(
    levels: list[Array], symmetric: bool
) -> tuple[NDArray[np.complex128], Array | None]:
    """Return all 1/x with ``sum_j levels[j] x^j`` singular, and vectors where symmetric."""
    import scipy.linalg

    if len(levels) < 2:
        return np.zeros(0, dtype=complex), None
    if symmetric and len(levels) == 2 and _definite(levels[0]):
        reals, vectors = scipy.linalg.eigh(-(levels[1] + levels[1].T) / 2, levels[0])
        return reals.astype(np.complex128), vectors
    m = len(levels[0])
    degree = len(levels) - 1
    # (levels[0] y^d + levels[1] y^(d-1) + ...) v = 0 with y = 1/x; state (y^(d-1) v, ..., v).
    right = np.eye(degree * m)
    right[:m, :m] = levels[0]
    left = np.zeros((degree * m, degree * m))
    left[:m] = -np.concatenate(levels[1:], axis=1)
    left[m:, :-m] = np.eye((degree - 1) * m)
    if np.linalg.cond(levels[0]) < 1e8:
        left[:m] = np.linalg.solve(levels[0], left[:m])
        return scipy.linalg.eigvals(left).astype(complex), None
    values = scipy.linalg.eigvals(left, right)
    return np.where(np.isfinite(values), values, 0).astype(complex), None


def _definite(matrix: Array) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True


def _refined(
    matrices: Matrices, speed: Array, start: Array | None, symmetric: bool
) -> tuple[Array, Array, Array]:
    """Refine roots on the polynomial itself; return speeds, errors and motions."""
    m = len(next(iter(matrices.values())))
    if len(speed) == 0:
        return speed, speed, np.zeros((0, m))
    if start is None:
        at_roots = (sum(root**power * each for power, each in matrices.items()) for root in speed)
        pairs = [_null_vectors(np.asarray(matrix), symmetric) for matrix in at_roots]
        right, left = (np.array(vectors) for vectors in zip(*pairs, strict=True))
    else:
        right = left = _apart(matrices, speed, start)
    value, slope, size = np.zeros((3, len(speed)))
    for power, matrix in matrices.items():
        form = np.einsum("ki,ki->k", left @ matrix, right)
        value += speed**power * form
        slope += power * speed ** (power - 1.0) * form
        size += speed**power * np.einsum("ki,ki->k", np.abs(left) @ np.abs(matrix), np.abs(right))
    with np.errstate(divide="ignore", invalid="ignore"):
        step = -value / slope
        # A step that is not small means a double root, where the quotient has no meaning.
        small = np.abs(step) < 1e-6 * speed
        left_over = np.where(small, step * step / speed, np.abs(step))
        error = left_over + 4 * _EPS * size / np.abs(slope) + 4 * _EPS * speed
    refined = np.where(small, speed + step, speed)
    return refined, error, right / np.linalg.norm(right, axis=1, keepdims=True)


def _apart(matrices: Matrices, speed: Array, vectors: Array) -> Array:
    """Turn the vectors of roots that nearly coincide so that each belongs to a root of its own."""
    # The decomposition of the whole problem mixes them; within their span it is a small one.
    import scipy.linalg

    turned = np.array(vectors)
    cuts = np.flatnonzero(np.diff(speed) > _NEARLY_DOUBLE * speed[1:]) + 1
    for group in np.split(np.arange(len(speed)), cuts):
        if len(group) < 2:
            continue
        own, at = vectors[group], float(np.mean(speed[group]))
        level, slope = np.zeros((2, len(group), len(group)))
        for power, matrix in matrices.items():
            form = own @ matrix @ own.T
            level += at**power * form
            slope += power * at ** (power - 1.0) * form
        sign = np.sign(np.trace(slope))
        if not _definite(sign * slope):
            continue
        shifts, mix = scipy.linalg.eigh(-sign * level, sign * slope)
        if np.max(np.abs(shifts)) <= _NEARLY_DOUBLE * at:
            turned[group] = mix.T @ own
    return turned


def _null_vectors(matrix: Array, symmetric: bool) -> tuple[Array, Array]:
    """Return right and left null vectors of a nearly singular matrix by inverse iteration."""
    import scipy.linalg

    m = len(matrix)
    norm = np.max(np.abs(matrix))
    # A tiny shift keeps the factors regular where the root is exact.
    factors = scipy.linalg.lu_factor(matrix + 4 * _EPS * norm * np.eye(m), check_finite=False)
    pair = []
    for transposed in (0, 1):
        vector = np.cos(np.arange(m) * 1.7 + 0.3)
        for _ in range(3):
            vector = scipy.linalg.lu_solve(factors, vector, trans=transposed, check_finite=False)
            vector /= np.linalg.norm(vector)
        pair.append(vector)
    return pair[0], pair[0] if symmetric else pair[1]


def _result(
    system: LinearPeriodic,
    parts: list[_Roots],
    span: tuple[float, float],
    limit: float,
    parameters: Mapping[str, float],
) -> SpeedBoundaries:
    harmonics = max(part.harmonics for part in parts)
    columns = zip(*(part.columns(system.size, harmonics) for part in parts), strict=True)
    speed, error, sign, cosine, sine = (np.concatenate(column) for column in columns)
    order = np.argsort(speed, kind="stable")
    result = SpeedBoundaries(
        method="eigenvalues of the Fourier matrix",
        error=error[order],
        error_norm="absolute, of each speed [rad/s]",
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=speed[order],
        multiplier=sign[order],
        cosine=cosine[order],
        sine=sine[order],
        harmonics=harmonics,
        period=system.period,
    )
    truncation = Check(max(part.truncation for part in parts), limit)
    found = [(part.multiplier, part.speed) for part in parts]
    given = system, found, span, dict(parameters)
    return replace(result, checks=DeferredChecks(partial(_checks, truncation, given, result)))


def _checks(
    truncation: Check,
    given: tuple[LinearPeriodic, list[tuple[int, Array]], tuple[float, float], dict[str, float]],
    boundaries: SpeedBoundaries,
) -> dict[str, Check]:
    checks = {"truncation": truncation, "parity": parity(*given)}
    if not len(boundaries.speed):
        return checks
    system, _, _, parameters = given
    pick = np.unique(np.linspace(0, len(boundaries.speed) - 1, 256).round().astype(int))
    speed, sign = boundaries.speed[pick], boundaries.multiplier[pick]
    matrices = monodromy(system, speed, **parameters)
    value = _smallest(matrices, sign)
    turning = 2 * equation_of(system, speed, parameters).rate() * system.period
    width = matrices.matrix.shape[-1]
    limit = 8 * width * (matrices.error + (1 + turning) * boundaries.error[pick] / speed)
    # Most that a singular value, relative to the matrix, may be and still count as zero.
    limit = np.minimum(limit, 0.01)
    worst = int(np.argmax(value / limit))
    return {**checks, "monodromy": Check(float(value[worst]), float(limit[worst]))}


def parity(
    system: LinearPeriodic,
    found: Sequence[tuple[int, Array]],
    span: tuple[float, float],
    parameters: Mapping[str, float],
) -> Check:
    """Count the contradictions between boundaries and signs of det(monodromy - multiplier).

    The determinant changes sign with every boundary, a double one counted twice.  It is taken at
    the ends of the range and in the widest gaps between boundaries.
    """
    wrong = 0
    for sign, boundaries in found:
        rising = np.sort(boundaries)
        speed = _test_speeds(rising, span)
        matrices = monodromy(system, speed, **parameters)
        shift = np.full(len(speed), sign)
        signs = np.linalg.slogdet(_shifted(matrices, shift))[0]
        sure = _smallest(matrices, shift) > 100 * matrices.error
        count = np.searchsorted(rising, speed)
        expected = np.where(count % 2 == 0, 1.0, -1.0)
        agreed = (signs * expected)[sure]
        # The sign at the lowest speed is not known beforehand: the majority stands for it.
        wrong += int(min(np.sum(agreed > 0), np.sum(agreed < 0)))
    return Check(float(wrong), 0.0)


def _test_speeds(boundaries: Array, span: tuple[float, float]) -> Array:
    """Return the ends of the range and the middles of the widest gaps, in logarithms."""
    marks = np.log(np.concatenate([[span[0]], boundaries, [span[1]]]))
    while len(marks) <= _GAPS:
        widest = int(np.argmax(np.diff(marks)))
        middle = (marks[widest] + marks[widest + 1]) / 2
        marks = np.insert(marks, widest + 1, middle)
    widths = np.diff(marks)
    widest_gaps = np.sort(np.argsort(-widths, kind="stable")[:_GAPS])
    middles = (marks[widest_gaps] + marks[widest_gaps + 1]) / 2
    return np.concatenate([[span[0]], np.exp(middles), [span[1]]])


def _shifted(matrices: Monodromy, sign: NDArray[np.int64]) -> Array:
    unit = np.eye(matrices.matrix.shape[-1])
    shrink = np.ldexp(1.0, -matrices.exponent)[:, None, None]
    return np.asarray(matrices.scaled - shrink * (sign[:, None, None] * unit))


def _smallest(matrices: Monodromy, sign: NDArray[np.int64]) -> Array:
    """Return the smallest singular value of (matrix - multiplier) over the matrix."""
    norm = np.linalg.norm(matrices.scaled, axis=(-2, -1))
    return np.asarray(np.linalg.svd(_shifted(matrices, sign), compute_uv=False)[:, -1] / norm)
