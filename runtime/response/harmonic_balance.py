"""Steady states by harmonic balance: Fourier series of the motion and of all coefficients.

With ``q = sum_k q_k exp(i k nu theta)``, nu = 2 pi / period, the equation
``M q'' + G q' + H q = F`` becomes ``sum_l (H_{k-l} + i nu l G_{k-l} - (nu l)^2 M_{k-l}) q_l = F_k``
(Aannaque, section 6.4, with the series of every coefficient).  High modes that the motion does not
excite cost nothing: the harmonics are those of the motion, however stiff the system is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.results import Check
from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm
from ..simulation.second_order import Series, even_count, series_of
from .balance_matrix import real_matrix
from .checks import check_memory
from .request import Found, Request, peaks, whole_option
from .slow_balance import Balanced, balanced_slowly
from .steering import harmonics_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
_FIRST = 8
_MARGIN = 4.0
# Error over the wanted one from which on fewer harmonics are tried next.
_AMPLE = 1e-2
# Change from fewer harmonics up to which the falling off of the series is counted on.
_FINE = 1e-4
# Unknowns up to which harmonics are added: a matrix of 200 MiB.
_MOST_UNKNOWNS = 5000
# Floats of the coefficients of the speeds taken together.
_FLOATS = 2**23


@dataclass(frozen=True)
class Balance:
    """One balanced motion.

    Attributes
    ----------
    coefficients : ndarray of complex
        Harmonics 0 to k of q, shape ``(k + 1, n)``.
    rounding : ndarray
        Error of each coordinate that round-off leaves, absolute, shape ``(n,)``.
    condition : float
        Condition number of the equations, in scaled coordinates; inf where singular.
    """

    coefficients: ComplexArray
    rounding: Array
    condition: float


def by_harmonic_balance(request: Request) -> Found:
    """Return periodic motions by harmonic balance."""
    form, n = request.form, request.form.system.size
    fixed = whole_option(request.options, "harmonics", 1, 2000)
    _check_unknowns(fixed, n)
    count = even_count(form.system)
    nu = 2 * np.pi / form.system.period
    scale = form.scale[:, :n]
    # Of a given number of harmonics two are compared: what it leaves out may be large.
    slow = _slowly(request) if fixed is None else [None] * len(form.speed)
    together = 1 if any(slow) else max(1, _FLOATS // (4 * count * n * n))
    balances: list[Balance] = []
    errors = np.full((len(form.speed), n), np.inf)
    harmonics = _FIRST if fixed is None else fixed
    for begin in range(0, len(form.speed), together):
        known = slow[begin]
        if known is not None:
            waves = harmonics_of(known.motion, len(known.motion) // 2)
            balances.append(Balance(waves, known.rounding, known.condition))
            errors[begin] = known.error
            continue
        part = form.take(slice(begin, begin + together))
        for own, series in enumerate(series_of(part, count)):
            place = begin + own
            problem = _Problem(series, scale[place], nu)
            found, errors[place], harmonics = _adapted(problem, harmonics, request.rtol, fixed)
            balances.append(found)
            if request.tick is not None:
                request.tick(place + 1)
    return _found(request, form, balances, errors, nu)


def _slowly(request: Request) -> list[Balanced | None]:
    """Return the motions that slow modes steer to, one for each of the batch."""
    form = request.form
    out: list[Balanced | None] = []
    first: int | None = None
    for place in range(len(form.speed)):
        found = None
        # Where a system is not stiff at the first speed it is not at the others.
        if place == 0 or out[0] is not None:
            one = form.take(slice(place, place + 1))
            found = balanced_slowly(one, request.rtol, first)
        if found is not None:
            first = len(found.motion)
            first -= first // 5 if np.max(found.error) <= _AMPLE * request.rtol else 0
            if request.tick is not None:
                request.tick(place + 1)
        out.append(found)
    return out


def _check_unknowns(fixed: int | None, n: int) -> None:
    if fixed is not None and (2 * fixed + 1) * n > 2 * _MOST_UNKNOWNS:
        raise bad(
            "option harmonics",
            f"{fixed} of {n} coordinates",
            f"at most {_MOST_UNKNOWNS // n}",
            "lower it",
        )


def _found(
    request: Request, form: CanonicalForm, balances: list[Balance], errors: Array, nu: float
) -> Found:
    most = max(len(balance.coefficients) for balance in balances)
    nt = 2 ** int(np.ceil(np.log2(max(request.samples, 4 * most))))
    check_memory(form, nt)
    q = np.empty((len(balances), nt, form.system.size))
    slope = np.empty_like(q)
    floor = np.empty_like(errors)
    condition = np.array([balance.condition for balance in balances])
    for place, balance in enumerate(balances):
        waves = balance.coefficients
        turned = (1j * nu * np.arange(len(waves)))[:, None] * waves
        q[place] = np.fft.irfft(waves * nt, n=nt, axis=0)
        slope[place] = np.fft.irfft(turned * nt, n=nt, axis=0)
        floor[place] = balance.rounding
    size = peaks(q)
    doubt = _EPS * np.where(np.isfinite(condition), condition, 1 / _EPS)
    lost = ~np.isfinite(condition) | (16 * doubt >= 1.0) | ~np.all(np.isfinite(q), axis=(1, 2))
    q[lost], slope[lost], errors[lost], condition[lost] = np.nan, np.nan, np.inf, np.inf
    with np.errstate(invalid="ignore"):
        allowed = np.minimum(np.maximum(request.rtol, 4 * floor / size), 1e-2)
    return Found(
        method="harmonic balance",
        theta=even_angles(form.system.period, nt),
        q=q,
        slope=slope,
        error=errors,
        allowed=allowed,
        sensitivity=condition,
        checks={"single": Check(16 * float(np.max(doubt)), 1.0)},
    )


@dataclass(frozen=True)
class _Problem:
    series: Series
    scale: Array
    nu: float

    @cached_property
    def highest(self) -> float:
        """Harmonic that the highest mode of the mean equation answers to most."""
        mean = self.series.mass[0].real, self.series.stiffness[0].real
        squares = np.linalg.eigvals(np.linalg.solve(*mean)).real
        return float(np.sqrt(max(float(np.max(squares)), 0.0))) / self.nu


def _adapted(
    problem: _Problem, harmonics: int, rtol: float, fixed: int | None
) -> tuple[Balance, Array, int]:
    """Return a motion with as many harmonics as it needs, its error, and those to begin with.

    Two numbers of harmonics are compared; where the series falls off, the finer one is nearer to
    the truth by as much as its last harmonics are smaller than the last of the coarser one, once
    both reach beyond the highest mode.
    """
    n = len(problem.scale)
    fine = harmonics if fixed is None else fixed
    coarse = max(1, (2 * fine) // 3)
    before = balanced(problem, coarse)
    while True:
        found = balanced(problem, fine)
        error = _error(problem, before, found)
        # Nor do they lessen what coefficients that are not smooth leave.
        wanted = max(rtol, problem.series.aliased)
        ended = bool(np.all(error <= wanted)) or not np.isfinite(found.condition)
        # What round-off alone leaves no number of harmonics lessens.
        size = _sizes(found)
        ended |= bool(np.all(error <= np.maximum(rtol, 2 * _MARGIN * found.rounding / size)))
        more = (3 * fine) // 2 + 2
        if ended or fixed is not None or (2 * more + 1) * n > _MOST_UNKNOWNS:
            # The next motion begins with as many, with fewer where they were more than enough.
            enough = bool(np.all(error <= _AMPLE * rtol)) and coarse >= _FIRST
            return found, error + problem.series.aliased, coarse if enough else fine
        before, coarse, fine = found, fine, more


def _sizes(found: Balance) -> Array:
    count = max(64, 4 * len(found.coefficients))
    return peaks(np.fft.irfft(found.coefficients * count, n=count, axis=0))


def _error(problem: _Problem, before: Balance, found: Balance) -> Array:
    """Return the error of each coordinate over its peak."""
    if not (np.isfinite(found.condition) and np.isfinite(before.condition)):
        return np.full(len(problem.scale), np.inf)
    size = _sizes(found)
    waves, old = found.coefficients, len(before.coefficients)
    gap = waves.copy()
    gap[:old] -= before.coefficients
    difference = np.abs(gap[0]) + 2 * np.sum(np.abs(gap[1:]), axis=0)
    ends = [np.max(np.abs(part), axis=0) for part in (waves[-3:], waves[max(0, old - 3) : old])]
    # Where the series does not yet fall off a change says little of the next; nor does it below
    # the highest mode: the harmonics ahead may meet a resonance.
    gain = 2.0
    if np.max(difference / size) < _FINE and problem.highest < len(before.coefficients):
        # The coordinate whose series falls off least speaks for all.
        fallen = np.max(ends[0] / np.maximum(ends[1], _EPS * size))
        gain = float(np.clip(_MARGIN * fallen, 0.15, 1.0))
    beyond = _beyond(problem, waves)
    error: Array = (difference * gain + _MARGIN * beyond + _MARGIN * found.rounding) / size
    # The coefficients are rounded as well, which the equations themselves do not show.
    floor = _MARGIN * _EPS * float(np.sqrt(found.condition))
    return error + floor


def _beyond(problem: _Problem, waves: ComplexArray) -> Array:
    """Return what the harmonics left out amount to: the residual over the mean equation.

    So a forcing or a coupling that meets a resonance above the last harmonic is not overlooked.
    """
    series, nu = problem.series, problem.nu
    reach, last = len(series.mass) - 1, len(waves) - 1
    highest = max(last + reach, len(series.force) - 1)
    if highest == last:
        return np.zeros(waves.shape[1])
    nt = 2 ** int(np.ceil(np.log2(2 * highest + 2)))
    rate = (1j * nu * np.arange(len(waves)))[:, None]
    motion = [np.fft.irfft(w * nt, n=nt, axis=0) for w in (waves, rate * waves, rate**2 * waves)]
    total = np.zeros((nt, waves.shape[1]))
    for part, values in zip((series.stiffness, series.rate, series.mass), motion, strict=True):
        arrays = np.fft.irfft(part * nt, n=nt, axis=0)
        total += np.einsum("tij,tj->ti", arrays, values)
    rest = -np.fft.rfft(total, axis=0)[last + 1 : highest + 1] / nt
    own = series.force[last + 1 :]
    rest[: len(own)] += own
    kappa = (nu * np.arange(last + 1, highest + 1))[:, None, None]
    mean = series.stiffness[0] + 1j * kappa * series.rate[0] - kappa**2 * series.mass[0]
    s = problem.scale
    scaled = np.linalg.solve(mean * (s[:, None] * s), (s * rest)[..., None])[..., 0]
    left: Array = 2 * np.sum(np.abs(scaled * s), axis=0)
    return left


def balanced(problem: _Problem, harmonics: int) -> Balance:
    """Solve the balance of harmonics 0 to a number."""
    from scipy.linalg import lapack

    n, s = len(problem.scale), problem.scale
    matrix = real_matrix(problem.series, harmonics, problem.nu, s)
    load = np.zeros((harmonics + 1, n), dtype=complex)
    own = min(harmonics + 1, len(problem.series.force))
    load[:own] = problem.series.force[:own] * s
    right = np.concatenate([load.real.ravel(), load.imag[1:].ravel()])
    norm = float(np.linalg.norm(matrix, np.inf))
    # The transpose lies in memory as LAPACK wants it.
    factors, pivots, singular = lapack.dgetrf(matrix.T)
    condition = np.inf
    if not singular and np.all(np.isfinite(factors)):
        reciprocal, _ = lapack.dgecon(factors, norm)
        condition = 1.0 / reciprocal if reciprocal > 0 else np.inf
    if not np.isfinite(condition):
        nothing = np.full((harmonics + 1, n), np.nan + 0j)
        return Balance(nothing, np.full(n, np.inf), np.inf)
    solution, _ = lapack.dgetrs(factors, pivots, right, trans=1)
    change, _ = lapack.dgetrs(factors, pivots, right - matrix @ solution, trans=1)
    waves = _complex(solution + change, harmonics, n) * s
    moved = np.abs(_complex(change, harmonics, n)) * s
    rounding = moved[0] + 2 * np.sum(moved[1:], axis=0)
    # Entries are rounded too, which the second look at the equations does not see.
    return Balance(waves, rounding, condition)


def _complex(values: Array, harmonics: int, n: int) -> ComplexArray:
    middle = (harmonics + 1) * n
    out = values[:middle].reshape(harmonics + 1, n).astype(complex)
    out[1:] += 1j * values[middle:].reshape(harmonics, n)
    return out
