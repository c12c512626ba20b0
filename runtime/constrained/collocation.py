"""Collocation over long windows: all nodes of a window are evaluated at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..core.collocation import gauss_tableau
from ..core.errors import bad
from .equations import SMALL, Array, Equations, Linearised, NoConvergence, State

# Terms at the end of the series of the accelerations whose size and fall decide a window's length.
_TAIL = 2
# A factor of the length of the next window, and bounds of it.
_CAUTION, _SHORTER, _LONGER = 0.9, 0.2, 3.0
# Some five minutes of windows of the rod.
_MOST_WINDOWS = 100_000
# Steps, tried ones too, after which the pace is judged.
_JUDGED = 500


@dataclass(frozen=True)
class Nodes:
    """Gauss points of [0, 1], and Lobatto's points between them, with the ends.

    Both together integrate to degree 2s, and show what a polynomial through values at the Gauss
    points lacks: its next Legendre term is zero at the ones and extremal at the others.
    """

    # c, b: (s,): Gauss points and weights
    c: Array
    b: Array
    # once, twice: (s, s): integrals from 0 to the points of the polynomial, and twofold ones
    once: Array
    twice: Array
    series: Array  # (s, s): Legendre terms of the polynomial
    all: Array  # (2s + 1,): Gauss points, then Lobatto's
    # values, all_once, all_twice: (2s + 1, s): the polynomial at all points, its integral
    # from 0 and the twofold one
    values: Array
    all_once: Array
    all_twice: Array
    # terms_once, terms_twice: (2s + 1, s + 2): integrals of Legendre terms from 0 to all
    # points, and twofold ones
    terms_once: Array
    terms_twice: Array
    # (s + 2, 2s + 1): Legendre terms of a function by its values at all points
    project: Array
    smooth: Array  # (s, 2s + 1): the first s of these terms at the Gauss points


@lru_cache(maxsize=64)
def nodes(count: int) -> Nodes:
    """Return the nodes of a number of stages, at least 2."""
    legendre = np.polynomial.legendre
    tableau = gauss_tableau(count)
    highest = np.eye(count + 1)[-1]
    inner = np.sort(legendre.legroots(legendre.legder(highest)).real)
    lobatto = np.concatenate([[-1.0], 0.5 * (inner - inner[::-1]), [1.0]])
    # With these parts of both the square of the next Legendre polynomial comes out right.
    part = count / (2.0 * count + 1.0)
    weights = part / (count * (count + 1) * legendre.legval(lobatto, highest) ** 2)
    weights = np.concatenate([(1.0 - part) * tableau.b, weights])
    every = np.concatenate([tableau.c, 0.5 * (1.0 + lobatto)])
    at = legendre.legvander(2.0 * every - 1.0, count + 3)
    degrees = 2.0 * np.arange(count + 2)[:, None] + 1.0
    series: Array = degrees[:count] * tableau.b * at[:count, :count].T
    project: Array = degrees * weights * at[:, : count + 2].T
    once, twice = _integrals(count + 2)
    by_once, by_twice = at[:, :-1] @ once, at @ twice
    return Nodes(
        c=tableau.c,
        b=tableau.b,
        once=tableau.a,
        twice=by_twice[:count, :count] @ series,
        series=series,
        all=every,
        values=at[:, :count] @ series,
        all_once=by_once[:, :count] @ series,
        all_twice=by_twice[:, :count] @ series,
        terms_once=by_once,
        terms_twice=by_twice,
        project=project,
        smooth=at[:count, :count] @ project[:count],
    )


@lru_cache(maxsize=64)
def _integrals(count: int) -> tuple[Array, Array]:
    legendre = np.polynomial.legendre
    once = np.asarray(legendre.legint(np.eye(count), scl=0.5, lbnd=-1.0), dtype=np.float64)
    return once, np.asarray(legendre.legint(once, scl=0.5, lbnd=-1.0), dtype=np.float64)


def stage_matrix(by_x: Array, by_v: Array, h: float, points: Nodes) -> Array:
    """Return the matrix of ``a - (what a does to the accelerations)`` at the nodes of steps.

    From derivatives of the accelerations at the nodes, ``(*batch, s, n, n)``, and the length h of
    the steps: ``(*batch, s n, s n)``, rows and columns nodes, then coordinates.
    """
    *lead, s, n, _ = by_x.shape
    blocks = (-h * h * points.twice)[:, None, :, None] * by_x[..., None, :]
    blocks -= (h * points.once)[:, None, :, None] * by_v[..., None, :]
    matrix: Array = blocks.reshape(*lead, s * n, s * n)
    matrix[..., np.arange(s * n), np.arange(s * n)] += 1.0
    return matrix


def at_places(part: Array, count: int) -> Array:
    """Return what Legendre terms have at parts of a step, ``(nt, 3, count)``.

    Their twofold integral from 0, their integral and their value.
    """
    # Chebyshev polynomials have the shortest recurrence: most of the time is overhead.
    values = np.polynomial.chebyshev.chebvander(2.0 * part - 1.0, count + 1)
    return np.asarray(values @ _by_chebyshev(count)).reshape(-1, 3, count)


@lru_cache(maxsize=64)
def _by_chebyshev(count: int) -> Array:
    """Return twofold integrals, integrals and values of Legendre terms, side by side."""
    # By Chebyshev polynomials, (count + 2, 3 count).
    once, twice = _integrals(count)
    terms = np.concatenate(
        [twice, np.pad(once, ((0, 1), (0, 0))), np.eye(count + 2, count)], axis=1
    )
    found: Array = np.polynomial.chebyshev.chebinterpolate(
        lambda x: np.polynomial.legendre.legvander(x, count + 1) @ terms, count + 1
    )
    return found


@dataclass(frozen=True)
class Tolerance:
    """How exact the steps are to be."""

    rtol: float  # relative tolerance of the error of one step
    # place, speed: sizes of scaled coordinates and velocities that are added to their own ones
    place: float
    speed: float


class StoppedEarly(ArithmeticError):  # noqa: N818 - reads as what it is
    """The integration cannot go on; the message says why."""


@dataclass(frozen=True)
class _Units:
    """Sizes that a window's errors are relative to, of coordinates and velocities, ``(n,)``."""

    place: Array
    speed: Array

    def of(self, place: Array, speed: Array) -> float:
        """Return the largest relative size of changes ``(..., n)``."""
        most = max(
            float(np.max(np.abs(place) / self.place, initial=0.0)),
            float(np.max(np.abs(speed) / self.speed, initial=0.0)),
        )
        return most if np.isfinite(most) else np.inf


class _TooLong(ArithmeticError):  # noqa: N818 - reads as what it is
    """A window that misses its tolerance by a factor; with its terms where they are settled."""

    def __init__(self, size: float, terms: Array | None) -> None:
        super().__init__("the window is too long")
        self.size, self.terms = size, terms


@dataclass(frozen=True)
class _Window:
    """A window of collocation that was solved; everything is scaled."""

    before: State  # its beginning
    h: float  # length [s]
    points: Nodes  # its nodes
    terms: Array  # (s, n): Legendre terms of the accelerations
    # (2s + 1, n): accelerations of the motion at all points less those of the series; not yet
    # at the ends
    defect: Array
    size: float  # what the series leaves away, over the tolerance
    left: float  # what the iteration may have left, relative
    units: _Units  # what relative sizes are relative to
    slopes: Linearised  # how the accelerations vary along the window
    unwind: Callable[[Array], Array]  # solves the linearised window for accelerations at the nodes

    def end(self) -> tuple[Array, Array]:
        """Return coordinates and velocities at the end."""
        x, v = _gain(self.h, self.terms)
        return self.before.x + self.h * self.before.v + x, self.before.v + v


def _gain(h: float, terms: Array) -> tuple[Array, Array]:
    """Return what Legendre terms of the accelerations add to coordinates and velocities."""
    return h * h * (0.5 * terms[0] - terms[1] / 6.0), h * terms[0]


@dataclass(frozen=True)
class Step:
    """One window of a motion, and the error along it, linearised about the motion; scaled.

    The error begins with that of the windows before and is driven by what the series of the
    accelerations lacks, measured at the ends and between the nodes: forces that jump show there
    too.
    """

    window: _Window
    after: State  # its end, on the constraints
    begin: tuple[Array, Array] | None  # errors at the beginning, (n,) each, where they are known
    # carried, local: (s + 2, n): Legendre terms of the accelerations that these bring, and
    # those that the window adds
    carried: Array
    local: Array

    @classmethod
    def of(cls, window: _Window, after: State, begin: tuple[Array, Array] | None) -> Step:
        """Return a window with the error along it."""
        points, slopes, h, terms = window.points, window.slopes, window.h, window.terms
        x, v = begin or (np.zeros_like(after.x), np.zeros_like(after.x))
        defect = window.defect.copy()
        defect[len(terms)] = window.before.a - (-1.0) ** np.arange(len(terms)) @ terms
        defect[-1] = after.a - np.sum(terms, axis=0)
        lacking = points.project @ defect
        # What this adds first is of high degree, small at the nodes: it counts by its projection.
        by_x, by_v = (
            np.tensordot(points.values, slope, axes=1) for slope in (slopes.by_x, slopes.by_v)
        )
        place, speed = h * h * (points.terms_twice @ lacking), h * (points.terms_once @ lacking)
        local = points.smooth @ (by_x @ place[..., None] + by_v @ speed[..., None])[..., 0]
        ahead = x + h * points.c[:, None] * v
        carried = (slopes.by_x @ ahead[..., None])[..., 0] + slopes.by_v @ v
        both = np.tensordot(points.series, window.unwind(np.stack([carried, local], -1)), axes=1)
        carried, local = np.moveaxis(both, -1, 0)
        lacking[:-2] += local
        return cls(window, after, begin, np.concatenate([carried, np.zeros((2, len(x)))]), lacking)

    @property
    def added(self) -> float:
        """What the window itself adds to the error by its end, relative."""
        return self.window.units.of(*_gain(self.window.h, self.local))

    @property
    def error(self) -> Array:
        """Largest error estimate of the coordinates inside, ``(n,)``."""
        h, points, units = self.window.h, self.window.points, self.window.units
        if self.begin is None:
            return np.full_like(self.after.x, np.inf)
        x, v = self.begin
        carried, local = (
            h * h * (points.terms_twice @ part) for part in (self.carried, self.local)
        )
        error = np.abs(x + h * points.all[:, None] * v + carried) + np.abs(local)
        return np.asarray(np.max(error, axis=0) + self.window.left * units.place)

    def error_at_end(self, equations: Equations) -> tuple[Array, Array] | None:
        """Return the error at the end, on the constraints; None where it is not known.

        Where a force jumps the sign of what a window adds is not known, nor that of what its
        iteration left: all is taken to go one way.
        """
        if self.begin is None:
            return None
        h, left, units, after = self.window.h, self.window.left, self.window.units, self.after
        (x, v), local = _gain(h, self.carried), _gain(h, self.local)
        x, v = self.begin[0] + h * self.begin[1] + x, self.begin[1] + v
        x = x + np.copysign(np.abs(local[0]) + left * units.place, x)
        v = v + np.copysign(np.abs(local[1]) + left * units.speed, v)
        try:
            x, v = equations.nearest(after.t, after.x + x, after.v + v)
        except NoConvergence:
            return None
        return x - after.x, v - after.v

    @property
    def inner(self) -> Array:
        """Times inside at which to look for what stops a motion."""
        return np.asarray(self.window.before.t + self.window.h * self.window.points.c[2:-1:3])

    def at(self, t: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities at times inside, not yet on the constraints."""
        before, h, terms = self.window.before, self.window.h, self.window.terms
        part = (t - before.t) / h
        values = at_places(part, len(terms)) @ terms
        twice, once = values[:, 0], values[:, 1]
        return before.x + h * part[:, None] * before.v + h * h * twice, before.v + h * once


def _solved(
    equations: Equations,
    before: State,
    h: float,
    points: Nodes,
    guess: Array,
    tolerance: Tolerance,
    near: float,
) -> _Window:
    """Return a window of collocation, its accelerations at the nodes by Newton's iteration."""
    # Within `near` of the solution the derivatives are kept.
    t, rtol = before.t + h * points.c, tolerance.rtol
    a, last = guess, np.inf
    slopes: Linearised | None = None
    for _ in range(25):
        x = before.x + h * (points.c[:, None] * before.v + h * (points.twice @ a))
        v = before.v + h * (points.once @ a)
        fresh = slopes is None
        if slopes is None:
            slopes = equations.linearised(t, x, v)
            exact, unwind = slopes.a, _unwinding(slopes, h, points)
        else:
            exact = equations.accelerations(t, x, v)[0]
        change = unwind(exact - a)
        a = a + change
        reach, fast = np.max(np.abs(x), axis=0), np.max(np.abs(v), axis=0)
        units = _Units(
            reach + max(tolerance.place, SMALL * float(np.max(reach))),
            fast + max(tolerance.speed, float(np.max(fast))),
        )
        size = units.of(h * h * (points.twice @ change), h * (points.once @ change))
        if not size < 1e6:
            break
        part = min(10.0 * size if fresh else size / last, 1.0)
        tail, fall = _tail(points.series @ a, h, units)
        # The terms that are not there fall on as those before them.
        over = tail * fall / rtol
        # Before its last correction the iteration may leave this part of the tolerance.
        if (part < 0.5 and size * part <= 0.1 * rtol) or (size <= 1e-9 and part >= 0.25):
            if over > 1.0:
                raise _TooLong(over, points.series @ a)
            # What is wrong at the nodes goes with the last correction, between them too.
            x = before.x + h * (points.all[:, None] * before.v + h * (points.all_twice @ a))
            v = before.v + h * (points.all_once @ a)
            exact = equations.accelerations(before.t + h * points.all, x, v)[0]
            defect = exact - points.values @ exact[: len(a)]
            change = unwind(exact[: len(a)] - a)
            terms = points.series @ (a + change)
            left = min(part * units.of(h * h * change, h * change), size)
            return _Window(before, h, points, terms, defect, over, left, units, slopes, unwind)
        # What the iteration has not settled yet is no sign of a window that is too long.
        if tail * fall > max(30.0 * rtol, size if size < 1e-2 else 0.1):
            raise _TooLong(over, None)
        if size > 2.0 * last and last < 1e-2 and fresh:
            break
        if size > near or (part > 0.2 and not fresh):
            slopes = None
        last = size
    raise NoConvergence("the window does not converge")


def _tail(terms: Array, h: float, units: _Units) -> tuple[float, float]:
    """Return the size of the last terms, as errors, and over that of the ones before."""
    # P_k integrated once is below 1/k, twice below 1/k^2, over an interval of length 2.
    once = h / (2.0 * len(terms))
    before, last = (
        units.of(once * once * part, once * part)
        for part in (terms[-2 * _TAIL : -_TAIL], terms[-_TAIL:])
    )
    return last, min(1.0, last / before) if before > 0.0 else 1.0


def _unwinding(slopes: Linearised, h: float, points: Nodes) -> Callable[[Array], Array]:
    """Return the solver of ``change - (its effect on the accelerations) = defect``."""
    # The defects are of shape (s, n), or (s, n, m) for several at once.
    from scipy.linalg.lapack import dgetrf, dgetrs

    # The transpose is in the order of columns, so that nothing is copied.
    factors, pivots, wrong = dgetrf(
        stage_matrix(slopes.by_x, slopes.by_v, h, points).T, overwrite_a=1
    )
    if wrong != 0:
        raise NoConvergence("the matrix of the window is singular")

    def unwind(right: Array) -> Array:
        solved, _ = dgetrs(factors, pivots, right.reshape(len(pivots), -1), trans=1)
        return np.asarray(solved, dtype=np.float64).reshape(right.shape)

    return unwind


def collocation(
    equations: Equations, start: State, end: float, tolerance: Tolerance
) -> Iterator[Step]:
    """March in long windows of Gauss collocation, each end projected onto the constraints.

    A window has many nodes and spans what would be tens of explicit steps; its nodes are
    evaluated in one call of the emitted functions, whose cost hardly depends on their number.
    The windows are as long as the end of the Legendre series of the accelerations allows.

    Beside the motion goes its error, linearised inside the windows and projected at their ends.
    """
    # An evaluation costs nearly the same for few nodes and many, the solution of a window the third
    # power of nodes times coordinates: fastest on the rod of 1 to 5 modes with 24 down to 20 nodes.
    points = nodes(int(np.clip(160 // max(equations.n, 1), 8, 24)))
    # A looser tolerance makes no window cheaper.
    tolerance = replace(tolerance, rtol=min(tolerance.rtol, 1e-4))
    s, rtol = len(points.c), tolerance.rtol
    h = _first(equations, start, end, rtol, s)
    state, guess = start, None
    begin: tuple[Array, Array] | None = (np.zeros(equations.n), np.zeros(equations.n))
    judged = start.t
    for count in range(_MOST_WINDOWS):
        if count and count % _JUDGED == 0:
            if (end - state.t) * _JUDGED > _MOST_WINDOWS * (state.t - judged):
                raise StoppedEarly(
                    f"at the pace of the last {_JUDGED} steps the end is more than "
                    f"{_MOST_WINDOWS} steps away: shorten the span"
                )
            judged = state.t
        t = state.t + h if state.t + 1.1 * h < end else end
        h = t - state.t
        if not h > 4e-16 * max(abs(state.t), abs(end)):
            raise StoppedEarly(
                "the step became too short: the constraints lose their rank, or the motion diverges"
            )
        try:
            first = np.tile(state.a, (s, 1)) if guess is None else guess
            # A Newton correction of this relative size leaves derivatives that need not be made
            # anew; what they are off lets error estimates grow with the number of windows, so that
            # it is less where there are more than the next number.
            near = 1e-3 * min(1.0, 30.0 * h / (end - start.t))
            window = _solved(equations, state, h, points, first, tolerance, near)
            step = Step.of(window, equations.state(t, *window.end()), begin)
            if step.added > rtol:
                # How much shorter a window becomes in which a force jumps.
                raise _TooLong(2.0**s, window.terms)
        except _TooLong as reason:
            part = max(_SHORTER, _CAUTION * reason.size ** (-1.0 / s))
            spread = np.polynomial.legendre.legvander(2.0 * part * points.c - 1.0, s - 1)
            h, guess = h * part, None if reason.terms is None else spread @ reason.terms
            continue
        except NoConvergence:
            h, guess = h * _SHORTER, None
            continue
        yield step
        if t >= end:
            return
        begin, state, guess = step.error_at_end(equations), step.after, None
        h *= min(_LONGER, _CAUTION * max(window.size, 1e-300) ** (-1.0 / s))
    raise StoppedEarly(f"{_MOST_WINDOWS} steps were not enough: shorten the span")


def _first(equations: Equations, start: State, end: float, rtol: float, s: int) -> float:
    """Return the length of the first window, from the fastest motion that the state allows."""
    n, span = equations.n, end - start.t
    slopes = equations.linearised(np.array([start.t]), start.x[None], start.v[None])
    matrix = np.eye(2 * n, k=n)
    matrix[n:, :n], matrix[n:, n:] = slopes.by_x[0], slopes.by_v[0]
    rate = float(np.max(np.abs(np.linalg.eigvals(matrix)), initial=0.0))
    # Term k of the Legendre series of exp(i z x) is about (e z / 2 k)^k.
    reach = 1.5 * 4.0 * s / np.e * rtol ** (1.0 / s)
    if span * rate > _MOST_WINDOWS * reach:
        found = f"{span:g} s, which hold {span * rate:.2g} rad of the fastest vibration"
        expected = f"at most {_MOST_WINDOWS * reach:.2g} rad, {_MOST_WINDOWS} steps"
        raise bad("span", found, expected, "shorten it, or take fewer or softer modes")
    return min(reach / rate, span) if rate > 0.0 else span
