"""The equation of a linear periodic system in ball arithmetic, and what its multipliers solve.

With theta the crank angle and u = 1/speed, the state z = (q, p) follows z' = L(theta, u) z.  Every
entry of L is a polynomial in u whose coefficients are analytic functions of theta; they are
evaluated on balls, that is numbers with a proved radius, and on power series of balls.

One revolution.  The period is cut into segments of half-width a.  About the middle of each the
fundamental matrix Y is a power series, whose terms follow from those of L.  Where |L| <= G in the
disc of radius R = 6 a, the k-th term is at most exp(G R) / 6^k on the segment (Cauchy), which
bounds the rest.  Of the matrices of the segments, and of their product, errors are bounded by
norms: the norm grows at most by the exponential of g, the integral of the largest eigenvalue of
the Hermitian part of L (Wazewski's inequality).

All speeds of a range.  The matrices of a segment and of the period are entire functions of u.
They are interpolated at J of Chebyshev's points, with an error of at most
4 m / (rho^(J-1) (rho - 1)) where m bounds the function in Bernstein's ellipse of parameter rho
(Trefethen, Approximation Theory and Approximation Practice, theorem 8.2): the exponential of g for
complex u.  Errors at the points grow by Lebesgue's constant, at most 1 + 2/pi log J.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, exp, expm1, inf, log, nextafter
from operator import add, mul, sub, truediv
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import VECTORS, Array, LinearPeriodic
from ..core.lazy import ModuleOnUse
from ..core.trigonometric import BETWEEN
from ..periodic.equation import SPEED_POWER

flint = ModuleOnUse("flint")
Balls = NDArray[Any]
# Radius of the discs over the half-width of a segment; segments at first, at the most; G R at most.
_REACH, _FEWEST, _MOST, _STEEP = 6, 64, 1024, 12.0
# Bits of bounds, of series and polynomials; points of interpolation of a segment, of coefficients.
_COARSE, _FINE, _POINTS, _NODES = 64, 160, 16, 24
# Goals for the errors of a segment and of the period; what is of no use; bounds of roundings.
_SMALL, _GOAL, _LARGE, _UP, _EPS = 1e-13, 1e-9, 1e-3, 1.0 + 1e-11, 2.0**-53
_ELLIPSES = (1.5, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0)


def _operation(operation: Callable[[Any, Any], Any]) -> Callable[[Ball, object], Any]:
    """Return an operation of a ball with another one, or with a number."""

    def method(ball: Ball, other: object) -> Any:
        if isinstance(other, Ball):
            return Ball(operation(ball.value, other.value))
        if isinstance(other, (int, float, np.integer)):
            return Ball(operation(ball.value, flint.arb(float(other))))
        return NotImplemented

    return method


class Ball:
    """A number or series of python-flint as an element of NumPy's object arrays.

    It has analytic operations only: a function that compares, asks for the truth of a number or
    takes absolute values fails.
    """

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        self.value = value

    __add__ = __radd__ = _operation(add)
    __mul__ = __rmul__ = _operation(mul)
    __sub__, __rsub__ = _operation(sub), _operation(lambda a, b: b - a)
    __truediv__, __rtruediv__ = _operation(truediv), _operation(lambda a, b: b / a)

    def __eq__(self, other: object) -> bool:
        raise TypeError("balls are not compared")

    def __bool__(self) -> bool:
        raise TypeError("a ball is neither true nor false")

    __hash__ = object.__hash__

    def __neg__(self) -> Ball:
        return Ball(-self.value)

    def __pow__(self, power: int) -> Any:
        if power != int(power):
            return NotImplemented
        product: Any = 1.0
        for _ in range(abs(int(power))):
            product = self * product
        return product if power >= 0 else 1.0 / product

    def sin(self) -> Ball:
        """Return the sine."""
        return Ball(self.value.sin())

    def cos(self) -> Ball:
        """Return the cosine."""
        return Ball(self.value.cos())

    def sqrt(self) -> Ball:
        """Return the root; of a complex ball that meets the branch cut no number."""
        analytic = {"analytic": True} if hasattr(self.value, "imag") else {}
        return Ball(self.value.sqrt(**analytic))


def _objects(balls: list[Ball]) -> Balls:
    """Return balls in a row."""
    row = np.empty(len(balls), dtype=object)
    row[:] = balls
    return row


def _inverse(matrix: Balls) -> Balls:
    """Return the inverses of ``(nt, n, n)``, by elimination without exchange of rows."""
    n = matrix.shape[-1]
    work = np.concatenate([matrix, 0.0 * matrix + np.eye(n)], axis=2)
    for k in range(n):
        work[:, k] = work[:, k] / work[:, k, k, None]
        for row in set(range(n)) - {k}:
            work[:, row] = work[:, row] - work[:, row, k, None] * work[:, k]
    return work[:, :, n:]


def _upper(value: Any) -> float:
    """Return a double above a real ball; infinity where it is no number."""
    found = nextafter(float(value.upper()), inf)
    return found if found < inf else inf


def _sizes(balls: Balls) -> Array:
    """Return bounds of absolute values."""
    return np.array([_upper(abs(ball.value)) for ball in balls.flat]).reshape(balls.shape)


def _part_sizes(parts: Mapping[int, Balls]) -> dict[int, Array]:
    return {power: _sizes(value) for power, value in parts.items()}


def _exp(value: float) -> float:
    return exp(value) if value < 700.0 else inf


_conjugate = np.frompyfunc(lambda ball: Ball(ball.value.conjugate()), 1, 1)


def _largest(parts: Mapping[int, Array], u: float) -> float:
    """Return a bound of |L| by the sizes of its parts, at inverse speeds up to u."""
    total: Any = sum(size * u**power for power, size in parts.items())
    found = float(np.max(np.sqrt(np.sum(total**2, axis=(1, 2))))) * _UP
    return found if found < inf else inf


def tilted(size: int, tilt: float) -> Array:
    """Return what a matrix is multiplied by, entry by entry, in tilted coordinates."""
    blocks = np.array([[1.0, tilt], [1.0 / tilt, 1.0]])
    return np.kron(blocks, np.ones((size // 2, size // 2)))


class Generator:
    """L of z' = L z by powers of u = 1/speed, in coordinates that balance it at one speed."""

    def __init__(self, system: LinearPeriodic, speed: float) -> None:
        self.size, self._system = system.size, system
        self._scales = system.scale_values()
        angles = system.period * np.arange(64.0) / 64.0
        fields = {name: self._mean(name, angles, speed) for name in ("M", "B", "K", "Kg", "D")}
        stiff = fields["K"] + fields["Kg"] + fields["D"] - fields["B"]
        squares, modes = scipy.linalg.eigh(0.5 * (stiff + stiff.T), fields["M"])
        self._unit: Array = modes / np.maximum(np.abs(squares), 1e-6) ** 0.25

    def _terms(self, name: str) -> list[tuple[int, float, Any]]:
        """Return power of u, factor and function of the terms of an array."""
        return [
            (
                -SPEED_POWER[name] - term.power,
                1.0 if term.scale is None else float(self._scales[term.scale]),
                term,
            )
            for term in self._system.terms
            if term.array == name and (term.scale is None or float(self._scales[term.scale]) != 0.0)
        ]

    def _mean(self, name: str, angles: Array, speed: float) -> Array:
        total = np.zeros((self.size, self.size))
        for power, factor, term in self._terms(name):
            total += factor * speed**-power * np.mean(term(angles), axis=0)
        return total

    def _field(self, name: str, theta: Balls) -> dict[int, Balls]:
        """Return an array at angles by powers of u, each ``(nt, n, n)``, or ``(1, n, n)``."""
        found: dict[int, Balls] = {}
        for power, factor, term in self._terms(name):
            some = theta[:1] if term.constant else theta
            values = term(some)
            if values.dtype != object:
                values = 0.0 * some[:, None, None] + values
            zero = 0.0 * theta[0]
            values = self._unit.T @ values @ (self._unit * (zero + factor))
            found[power] = found[power] + values if power in found else values
        return found

    def __call__(self, theta: Balls) -> dict[int, Balls]:
        """Return L at angles by powers of u, each ``(nt, 2n, 2n)``."""
        n, zero = self.size, 0.0 * theta[:, None, None]
        flexibility = _inverse(self._field("M", theta)[0])
        nothing = zero + np.zeros((n, n))
        turning = self._field("A", theta).get(0)
        parts = {0: np.block([[nothing, flexibility + nothing], [nothing, nothing]])}

        def add(power: int, block: tuple[slice, slice], value: Balls) -> None:
            if power not in parts:
                parts[power] = zero + np.zeros((2 * n, 2 * n))
            where = (slice(None), *block)
            parts[power][where] = parts[power][where] + value

        q, p = slice(None, n), slice(n, None)
        if turning is not None:
            back = np.swapaxes(turning, 1, 2) @ flexibility
            for block, value in (
                ((q, q), -flexibility @ turning),
                ((p, q), -back @ turning),
                ((p, p), back),
            ):
                add(0, block, value)
        for name, sign in (("B", 1.0), ("D", -1.0), ("K", -1.0), ("Kg", -1.0)):
            for power, value in self._field(name, theta).items():
                add(power, (p, q), sign * value)
        for power, value in self._field("C", theta).items():
            loss = value @ flexibility
            add(power, (p, p), -loss)
            if turning is not None:
                add(power, (p, q), loss @ turning)
        return parts


def require_analytic(system: LinearPeriodic) -> None:
    """Refuse functions of the angle that do not take balls, or are others on balls.

    At some angles the balls have to hold, and hold tightly, what the doubles are; doubles may be
    returned for balls by functions alone that do not depend on the angle.
    """
    angles = np.append(0.0, system.period * BETWEEN)
    for row, term in enumerate(system.terms):
        if term.array not in SPEED_POWER or term.constant or term.array in VECTORS:
            continue
        try:
            with flint.ctx.workprec(_FINE):
                term(_objects([Ball(flint.acb(0.1, 0.1))]))
                found = term(_objects([Ball(flint.acb(angle)) for angle in angles.tolist()]))
            if found.dtype == object:
                balls = (x.value.real.mid() if isinstance(x, Ball) else x for x in found.flat)
                values = np.array([float(x) for x in balls])
            elif len(system.spectrum(row)) == 1:
                values = np.ravel(found)
            else:
                raise TypeError("doubles of balls")
            doubles = np.ravel(np.broadcast_to(term(angles), found.shape))
            if not np.allclose(values, doubles, rtol=0, atol=1e-9 * np.max(np.abs(doubles))):
                raise TypeError("other values of balls")
        except (TypeError, ValueError, AttributeError) as error:
            told = f"term {term.array} ({term.scale}), whose function takes doubles only"
            expected = "arithmetic, sine, cosine and roots of the angle, as emitted modules have"
            fix = "choose another formulation, of the rod two_segment"
            raise bad("system", told, expected, fix) from error
        finally:
            term(np.zeros(1))


class Revolution:
    """The equation over a period: bounds of its coefficients, and their power series."""

    def __init__(self, system: LinearPeriodic, low: float, high: float) -> None:
        self._system, self.size = system, 2 * system.size
        self._generator = Generator(system, 0.5 * (low + high))
        turns = round(2.0 * np.pi / system.period)
        whole = turns > 0 and abs(turns * system.period / (2.0 * np.pi) - 1.0) < 1e-15
        with flint.ctx.workprec(_FINE):
            period = 2 * flint.arb.pi() / turns if whole else flint.arb(system.period)
        self._count = _FEWEST
        while True:
            with flint.ctx.workprec(_FINE):
                self._half = period / (2 * self._count)
            self._width, reach = _upper(self._half), _upper(_REACH * self._half)
            # The outermost squares first: where these meet a singularity the others need not be.
            self._steep = 0.0
            for row in reversed(range(_REACH // 2)):
                sizes = _part_sizes(self._parts(self._squares(row)))
                self._steep = max(self._steep, _largest(sizes, 1.0 / low) * reach)
                if self._steep > _STEEP:
                    break
            else:
                self._axis = self._parts(self._squares(None))
                self._axis_sizes = _part_sizes(self._axis)
                if all(np.all(np.isfinite(size)) for size in self._axis_sizes.values()):
                    return
            self._count *= 2
            if self._count > _MOST:
                found = "coefficients that cannot be bounded beside the real axis of the angle"
                fix = "choose another formulation, fewer modes, or a higher speed"
                raise bad("system", found, "analytic functions, modes not too fast", fix)

    def _parts(self, angles: Balls, digits: int = _COARSE) -> dict[int, Balls]:
        """Return the parts of L; no function of the system remembers balls afterwards."""
        try:
            with flint.ctx.workprec(digits):
                return self._generator(angles)
        finally:
            for term in self._system.terms:
                term(np.zeros(1))

    def _middles(self) -> list[Any]:
        return [(2 * k + 1) * self._half for k in range(self._count)]

    def _squares(self, row: int | None) -> Balls:
        """Return squares that cover the strip beside the real axis, or the segments of the axis."""
        side = self._half * flint.arb(0, 1)
        above = flint.arb(0) if row is None else (2 * row + 1) * self._half + side
        return _objects([Ball(flint.acb(middle + side, above)) for middle in self._middles()])

    @cached_property
    def _series(self) -> list[dict[int, list[Any]]]:
        """L on each segment as power series from -1 to 1, times its half-width."""
        # So many terms that the rest is the goal.
        order = ceil((self._steep - log(_SMALL)) / log(_REACH))
        before, flint.ctx.cap = flint.ctx.cap, order
        try:
            angles = [Ball(flint.arb_series([at, self._half])) for at in self._middles()]
            parts = self._parts(_objects(angles), _FINE)
        finally:
            flint.ctx.cap = before
        return [
            {power: self._matrices(value[k], order) for power, value in parts.items()}
            for k in range(self._count)
        ]

    def _matrices(self, entries: Balls, order: int) -> list[Any]:
        rows = [[ball.value.coeffs() for ball in row] for row in entries]
        return [
            flint.arb_mat([[c[k] if k < len(c) else 0 for c in row] for row in rows]) * self._half
            for k in range(order)
        ]

    def growth(self, middle: Any, radii: Sequence[float], tilt: float = 1.0) -> list[Array]:
        """Return bounds of log |Phi| and log |Phi^-1| by segment, for each radius.

        In discs about an inverse speed, in coordinates of which the first half is ``tilt**0.5``
        times larger, the other one as much smaller.
        """
        n = self.size // 2
        values = np.asarray(sum(part * Ball(middle**k) for k, part in self._axis.items()))
        values[:, :n, n:] *= Ball(flint.arb(tilt))
        values[:, n:, :n] *= Ball(1 / flint.arb(tilt))
        weights = tilted(self.size, tilt) * _UP
        hermitian = values + np.swapaxes(_conjugate(values), 1, 2)
        sizes = _sizes(hermitian)
        found = []
        for radius in radii:
            u = _upper(middle)
            change: Any = sum(
                power * radius * (u + radius) ** max(power - 1, 0) * _UP * part * weights
                for power, part in self._axis_sizes.items()
            )
            change = np.broadcast_to(change, sizes.shape)
            rates = np.max(np.sum(sizes + change + np.swapaxes(change, 1, 2), axis=2), axis=1)
            found.append(rates * self._width * _UP)
        return found

    def _matrix(self, segment: int, u: Any) -> Any:
        """Return the matrix of a segment for a ball u, without the rest of the series."""
        parts = self._series[segment]
        one = flint.arb_mat([[int(i == j) for j in range(self.size)] for i in range(self.size)])
        factors = {power: u**power for power in parts}
        order = len(parts[0])
        rates = [
            sum((of[k] * factors[power] for power, of in parts.items()), 0 * one)
            for k in range(order)
        ]
        terms = [one]
        for k in range(order - 1):
            following = rates[0] * terms[k]
            for i in range(1, k + 1):
                following += rates[i] * terms[k - i]
            terms.append(following * (flint.arb(1) / (k + 1)))
        even, odd = sum(terms[2::2], terms[0]), sum(terms[3::2], terms[1])
        return (even + odd) * (even - odd).inv()

    def series_rest(self, u: Any, radius: float) -> float:
        """Return a bound of what the series leave out of the matrix of a segment."""
        order = len(self._series[0][0])
        left = exp(self._steep - order * log(_REACH)) / (1.0 - 1.0 / _REACH) * _UP
        # The matrix of a segment is Y(1) Y(-1)^-1; both are at most e in norm.
        (rates,) = self.growth(u, [radius])
        e = _exp(0.5 * float(np.max(rates)))
        return left * e + 2.0 * left * e**2 * (e + left) if left * e < 0.5 else inf

    def over(self, low: float, high: float) -> Band | None:
        """Return the matrices of the segments over speeds; None where the range is too wide."""
        with flint.ctx.workprec(_FINE):
            place = _Place.of(low, high)
            bounds = [float(np.max(rates)) for rates in self.growth(place.middle, place.discs)]
            count, missed = _points(bounds, _SMALL)
            if count > _POINTS:
                return None
            nodes = [place.at(x) for x in _chebyshev(count)]
            balls = [[self._matrix(k, u).entries() for k in range(self._count)] for u in nodes]
        shape = (count, self._count, self.size, self.size)
        values = np.array([[[float(x.mid()) for x in row] for row in of] for of in balls])
        radius = max(_upper(x.rad()) for of in balls for row in of for x in row)
        largest = float(np.max(np.abs(values)))
        known = self.size * (radius + 2.0 * _EPS * largest)
        known += self.series_rest(place.middle, place.radius)
        summed = self.size * (count + 4) * _EPS * (largest + known)
        error = (missed + _lebesgue(count) * (known + summed)) * _UP
        return Band(self, place, values.reshape(shape), error)


@dataclass(frozen=True)
class _Place:
    """A range of u: middle and half-width as balls, and a bound of this."""

    middle: Any
    half: Any
    radius: float

    @classmethod
    def of(cls, low: float, high: float) -> _Place:
        """Return that of a range of speeds, a little wider."""
        ends = [flint.arb(1) / flint.arb(speed) for speed in (high, low)]
        half = (ends[1] - ends[0]) / 2 * (1 + flint.arb(2) ** -44)
        return cls((ends[1] + ends[0]) / 2, half, _upper(half))

    def at(self, x: Any) -> Any:
        """Return u at a coordinate from -1 to 1."""
        return self.middle + self.half * x

    @property
    def discs(self) -> list[float]:
        """Radii of discs that hold Bernstein's ellipses."""
        return [0.5 * self.radius * (rho + 1.0 / rho) * _UP for rho in _ELLIPSES]


def _chebyshev(count: int) -> list[Any]:
    return [flint.arb.cos_pi_fmpq(flint.fmpq(2 * j + 1, 2 * count)) for j in range(count)]


def _lebesgue(count: int) -> float:
    return 1.0 + 2.0 / np.pi * log(count) * _UP


def _points(bounds: Sequence[float], goal: float) -> tuple[int, float]:
    """Return how many points to interpolate at, and a bound of the error."""
    # From bounds of the logarithm of the function in Bernstein's ellipses.
    sizes = [bound + log(4.0 / (rho - 1.0)) for bound, rho in zip(bounds, _ELLIPSES, strict=True)]
    counts = [
        1 + max(2, ceil((size - log(goal)) / log(rho)))
        for size, rho in zip(sizes, _ELLIPSES, strict=True)
    ]
    best = int(np.argmin(counts))
    return counts[best], exp(sizes[best] - (counts[best] - 1) * log(_ELLIPSES[best])) * _UP


@dataclass(frozen=True)
class Band:
    """Matrices of the segments at points of interpolation, and a bound of the error between."""

    of: Revolution
    place: _Place
    values: Array  # (J, segments, m, m)
    error: float

    def over(self, low: float, high: float) -> Matrices | None:
        """Return the matrix of the period over speeds; None where the range is too wide."""
        with flint.ctx.workprec(_FINE):
            place, m = _Place.of(low, high), self.of.size
            tilt = float((place.middle / self.place.middle).mid())
            real, *wide = self.of.growth(place.middle, [place.radius, *place.discs], tilt)
            count, missed = _points([float(np.sum(rates)) * _UP for rates in wide], _GOAL)
            if count > _NODES or not np.sum(real) < -log(_GOAL) or not self.error < _LARGE:
                return None
            # Of the matrices in tilted coordinates, of these themselves, and of each product.
            largest = float(np.max(np.abs(self.values))) * _lebesgue(len(self.values)) + self.error
            each = max(tilt, 1.0 / tilt) * (self.error + 3.0 * m * _EPS * largest)
            each = each * _UP + 1.1 * m**2 * _EPS
            off = _exp(float(np.sum(real)) * _UP) * expm1(len(real) * each) * _UP
            values = [self._product(place.at(x), tilt) for x in _chebyshev(count)]
            with flint.ctx.workprec(2 * _FINE):  # powers lose digits
                nodes = _chebyshev(count)
                entries = [
                    [flint.arb_poly.interpolate(nodes, of.tolist()) for of in row]
                    for row in np.array(values).transpose(1, 2, 0)
                ]
            error = (missed + _lebesgue(count) * off) * _UP
            return Matrices(place, entries, error) if error < _LARGE else None

    def _product(self, u: Any, tilt: float) -> Array:
        """Return the matrix of the period at an inverse speed, in doubles."""
        count = len(self.values)
        x = (u - self.place.middle) / self.place.half
        waves = [x.chebyshev_t(k) * (2 if k else 1) / count for k in range(count)]
        angles = [flint.fmpq(2 * j + 1, 2 * count) for j in range(count)]
        weights = [
            float(sum(w * flint.arb.cos_pi_fmpq(k * a) for k, w in enumerate(waves)).mid())
            for a in angles
        ]
        segments = np.tensordot(np.array(weights), self.values, axes=1)
        total, *others = segments * tilted(self.of.size, tilt)
        for segment in others:
            total = segment @ total
        return np.asarray(total)


class Matrices:
    """The matrix of the period as polynomials of the inverse speed, and a bound of their error."""

    def __init__(self, place: _Place, entries: list[list[Any]], error: float) -> None:
        self._place, self._entries, self._error = place, entries, error

    def over(self, low: float, high: float) -> Balls:
        """Return polynomials on [-1, 1] whose values hold the matrices at speeds of a range."""
        with flint.ctx.workprec(_FINE):
            place = self._place
            ends = [(1 / flint.arb(w) - place.middle) / place.half for w in (low, high)]
            middle = ((ends[0] + ends[1]) / 2).mid()
            part = max(_upper(abs(end - middle)) for end in ends)
            shift, off = flint.arb_poly([middle, part]), flint.arb(0, self._error)
            found = np.empty((len(self._entries),) * 2, dtype=object)
            for i, row in enumerate(self._entries):
                for j, of in enumerate(row):
                    found[i, j] = of(shift) + off
            return found


def largest_modulus(matrices: Balls, x: float) -> float:
    """Return the largest modulus of the eigenvalues at a place of the range, in doubles."""
    return float(np.max(np.abs(np.linalg.eigvals(_middle(matrices, x)))))


def _middle(matrices: Balls, x: float) -> Array:
    return np.array([[float(of(x).mid()) for of in row] for row in matrices])


def all_inside(matrices: Balls, radius: float, x: float | None = None) -> bool | None:
    """Return whether all eigenvalues are below a radius; False where one is above; None if open.

    Proved for every speed of the range, or at a place x of it from -1 to 1.  With a symmetric P
    from the middle, ``S = radius^2 P - Phi^T P Phi`` is shown to be positive definite: its rows
    are dominated by their diagonal.  Then all are below if P is positive definite, too, and one is
    above if P is negative in some direction (Stein): else the sum of what S takes would be P.
    """
    size, middle = len(matrices), _middle(matrices, x or 0.0) / radius
    try:
        # S is the unit matrix there, times the square of the radius.
        solution = scipy.linalg.solve_discrete_lyapunov(middle.T, np.eye(size), method="direct")
        symmetric = 0.5 * (solution + solution.T)
        lowest = np.linalg.eigh(symmetric)[1][:, 0]
    except (np.linalg.LinAlgError, ValueError):
        return None
    with flint.ctx.workprec(_FINE):
        form, way = (np.frompyfunc(flint.arb, 1, 1)(part) for part in (symmetric, lowest))
        rest = form * flint.arb(radius) ** 2 - matrices.T @ form @ matrices
        span = flint.arb(0, 1) if x is None else flint.arb(x)
        for i, row in enumerate(rest):
            values = [of(span) for of in row]
            if not values[i] > sum(abs(value) for j, value in enumerate(values) if j != i):
                return None
        blocks = (flint.arb_mat(form[:k, :k].tolist()) for k in range(1, size + 1))
        if all(block.det() > 0 for block in blocks):
            return True
        return False if way @ form @ way < 0 else None
