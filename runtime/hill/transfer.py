"""Transfer matrices of Hill's equation as polynomials of its two parameters.

The equation u'' + (lam2 + mu f(theta)) u = 0 is cut into equal segments of the circle.  On each of
them the 2 x 2 transfer matrix is an entire function of (lam2, mu).  Its Taylor polynomial about a
point of the wanted box comes from Picard iteration, the double integral taken exactly on the
interpolant through Gauss-Legendre nodes; the segments are short enough for a total degree near
ten.  At any set of points the matrices then cost one matrix product, and their product round the
circle a few passes of element-wise arithmetic, over all points at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, lgamma, log, log2, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction, segment_values
from .checks import EPS, Array

Exponents = NDArray[np.int64]
Range = tuple[float, float]
HalfTraces = tuple[Array, Array, Exponents, Array]

_MOST_SEGMENTS = 2**16
_NODE_COUNTS = np.arange(8, 25)
# log (2q - 1)!! of them.
_LOG_DOUBLE_FACTORIALS = np.array(
    [lgamma(2 * q + 1) - q * log(2.0) - lgamma(q + 1) for q in _NODE_COUNTS]
)
# Neglected part of the interpolant; the end values see about its square (superconvergence).
_NODE_TAIL = 1e-9
# Largest sqrt(spread) * length and sqrt(size) * length of a segment: beyond these the Taylor
# polynomial, or the interpolant, needs more terms than a further halving costs.
_SPREAD, _SIZE = 1.8, 3.6


class Gauss(NamedTuple):
    """Gauss-Legendre nodes on [-1, 1] with the matrices that integrate twice from -1."""

    x: Array  # nodes, ``(q,)``
    inner: Array  # from values to the double integral at the nodes, ``(q, q)``
    ends: Array  # from values to the double and to the single integral at +1, ``(2, q)``


@lru_cache(maxsize=32)
def gauss(q: int) -> Gauss:
    """Return the nodes and integration matrices of order q."""
    # In extended precision: an error here would be the same on every segment.
    x = legendre.leggauss(q)[0].astype(np.longdouble)
    for _ in range(2):
        p = legendre.legvander(x, q + 1).T
        slope = q * (x * p[q] - p[q - 1]) / (x * x - 1)
        x = x - p[q] / slope
    n = np.arange(q + 1)[:, None]
    weights = 2 / ((1 - x * x) * slope**2)
    series = (2 * n[:q] + 1) * p[:q] * weights / 2
    # The integral of P_n from -1 is (P_{n+1} - P_{n-1}) / (2n+1), with P_{-1} = -1 for n = 0.
    once = (p[1:] - np.concatenate([-p[:1], p[:q]])) / (2 * n + 1)
    twice = np.concatenate([once[1:2] + once[:1], (once[2:] - once[:-2]) / (2 * n[1:q] + 1)])
    parts = (x, twice.T @ series, np.stack([weights * (1 - x), weights]))
    return Gauss(*(np.asarray(item, dtype=float) for item in parts))


@dataclass(frozen=True)
class Transfer:
    """The transfer matrices of all segments as polynomials over a box of parameters.

    ``table`` ``(4 * segments, monomials)`` holds entries (row, column, segment) by monomials
    ``xi^i eta^j`` of rising total degree, in the state ``(u, du/dx)``, x from -1 to 1 over a
    segment; ``xi = (lam2 - centre) / half-width`` and eta likewise, from ``lam2`` and ``mu``.
    ``truncation`` estimates the largest entry that is left out, ``f_error`` is that of f.  Over box
    and circle ``size`` is the largest ``|lam2 + mu f|``, ``floor`` the smallest ``lam2 + mu f``, at
    most 0, ``swing`` the largest ``|mu| sup|f|``; ``spread`` is how far lam2 and mu lead away from
    the point of expansion.
    """

    table: Array
    degree: int
    segments: int
    lam2: Range
    mu: Range
    truncation: float
    size: float
    spread: Range
    swing: float
    floor: float
    f_error: float

    @property
    def chunk(self) -> int:
        """How many points to evaluate at a time, so that the arrays stay in the cache."""
        return max(64, 2**17 // self.segments)

    def matrices(self, lam2: Array, mu: Array) -> Array:
        """Return the transfer matrices at points ``(n,)``, shape ``(2, 2, segments, n)``."""
        xi = (lam2 - self.lam2[0]) / self.lam2[1] if self.lam2[1] else np.zeros_like(lam2)
        eta = (mu - self.mu[0]) / self.mu[1] if self.mu[1] else np.zeros_like(mu)
        powers = np.empty((self.table.shape[1], lam2.size))
        powers[0] = 1.0
        start = 0
        for k in range(1, self.degree + 1):
            new = start + k
            np.multiply(powers[start:new], xi, out=powers[new : new + k])
            np.multiply(powers[new - 1], eta, out=powers[new + k])
            start = new
        return (self.table @ powers).reshape(2, 2, self.segments, lam2.size)

    def half_trace(self, lam2: Array, mu: Array) -> Array:
        """Return the half trace at points ``(n,)``."""
        out = np.empty(lam2.size)
        for begin in range(0, lam2.size, self.chunk):
            part = slice(begin, begin + self.chunk)
            blocks = _halved(self.matrices(lam2[part], mu[part]), 2)
            a, b = blocks[:, :, 0], blocks[:, :, 1]
            out[part] = 0.5 * np.einsum("ijn,jin->n", b, a)
        return out

    def half_trace_with_error(self, lam2: Array, mu: Array) -> HalfTraces:
        """Return half trace and error at points ``(n,)``, scaled against overflow.

        Value and error are to be multiplied by ``2**exponent``, 1 unless solutions grow beyond
        1e100.  Last, how far the product of the segments' determinants is from 1 (Liouville).
        """
        return in_parts(self._checked, lam2, mu, self.chunk)

    def _checked(self, lam2: Array, mu: Array) -> HalfTraces:
        m = self.matrices(lam2, mu)
        det = m[0, 0] * m[1, 1]
        det -= m[0, 1] * m[1, 0]
        det -= 1.0
        defect = np.abs(det.sum(axis=0))
        # The error of a trace is that of each segment times the monodromy matrix that starts at
        # it, so the monodromy is formed from several cuts of the circle, close enough together.
        cuts = min(self.segments, 2 ** max(3, ceil(log2(pi * sqrt(self.swing) + 1.0))))
        # Beyond exp(230) the squares of the entries would leave the range of doubles.
        turns, exponent = _all_cuts(m, cuts, scaled=2.0 * pi * sqrt(-self.floor) > 230.0)
        # Entries of a segment are good to units of their largest summands: 1, 1, 2 and the third
        # one's, small as the third entry itself may be.
        third = 2.0 * self.size * (pi / self.segments) ** 2
        norm = np.abs(turns[0, 0]) + np.abs(turns[1, 1])
        norm += third * np.abs(turns[0, 1]) + 2.0 * np.abs(turns[1, 0])
        amplification = norm.mean(axis=0)
        # A determinant computed from rounded entries is itself off by a few units.
        excess = np.maximum(defect - 4.0 * EPS * self.segments, 0.0)
        local = EPS * (8.0 + 1.2 * self.segments) + self.segments * self.truncation + excess
        # d(half trace) / d(lam2 + mu f) at one angle is half the entry (1, 2) from there.
        reply = np.abs(turns[0, 1]).mean(axis=0) * (pi * pi / self.segments)
        error = amplification * local + reply * (self.f_error * np.abs(mu))
        value = 0.5 * (turns[0, 0, 0] + turns[1, 1, 0])
        return value, error, exponent, defect


def in_parts(
    evaluate: Callable[[Array, Array], HalfTraces], lam2: Array, mu: Array, most: int
) -> HalfTraces:
    """Evaluate points ``(n,)`` by so many at a time."""
    starts = range(0, lam2.size, most)
    parts = [evaluate(lam2[k : k + most], mu[k : k + most]) for k in starts]
    value, error, exponent, defect = (np.concatenate(item) for item in zip(*parts, strict=True))
    return value, error, exponent, defect


def product(b: Array, a: Array) -> Array:
    """Return the 2 x 2 products ``b a``, both ``(2, 2, ...)``, element by element."""
    out: Array = b[:, 0, None] * a[0]
    out += b[:, 1, None] * a[1]
    return out


def _halved(m: Array, blocks: int) -> Array:
    """Multiply neighbours until ``blocks`` matrices round the circle are left."""
    while m.shape[2] > blocks:
        m = product(m[:, :, 1::2], m[:, :, 0::2])
    return m


def _all_cuts(m: Array, cuts: int, scaled: bool) -> tuple[Array, Exponents]:
    """Return the products once round the circle from every cut, and powers of two taken out."""
    # Where `scaled`, a power is taken out at every step; one exponent for all cuts.
    exponent: Exponents = np.zeros(m.shape[2:], dtype=np.int64)
    if not scaled:
        m, exponent = _halved(m, cuts), exponent[0]
    while m.shape[2] > cuts:
        m = product(m[:, :, 1::2], m[:, :, 0::2])
        m, exponent = normalised(m, exponent[1::2] + exponent[0::2])
    step = 1
    while step < m.shape[2]:
        # np.roll, at a fraction of its overhead.
        m = product(np.concatenate([m[:, :, step:], m[:, :, :step]], axis=2), m)
        if scaled:
            exponent = np.concatenate([exponent[step:], exponent[:step]]) + exponent
            m, exponent = normalised(m, exponent)
        step *= 2
    if not scaled:
        return m, exponent
    common = exponent.max(axis=0)
    return np.ldexp(m, np.maximum(exponent - common, -2000)), common


def normalised(m: Array, exponent: Exponents) -> tuple[Array, Exponents]:
    """Take a power of two out of matrices, and count it in their exponents."""
    _, shift = np.frexp(np.abs(m).max(axis=(0, 1)))
    return np.ldexp(m, -shift), exponent + shift


def transfer(f: PeriodicFunction, lam2: Range, mu: Range) -> Transfer:
    """Expand the transfer matrices over a box ``(low, high)`` of each parameter."""
    reach = max(abs(mu[0]), abs(mu[1]))
    short = f.truncated(0.02 * EPS / max(reach, 0.02))
    bound = float(np.sum(short.amplitudes))
    half_l, half_m = 0.5 * (lam2[1] - lam2[0]), 0.5 * (mu[1] - mu[0])
    size = max(abs(lam2[0]), abs(lam2[1])) + reach * bound
    floor = min(0.0, lam2[0] - reach * bound)
    centre_m = 0.5 * (mu[0] + mu[1])
    spread = half_l + reach * bound
    # Expanding about the middle of the mu range costs a solve per segment: only where it pays.
    if half_l + half_m * bound < 0.5 * spread and reach * bound > 1.0:
        spread = half_l + half_m * bound
    else:
        centre_m, half_m = 0.0, reach
    segments, q = _resolution(short, spread, size, reach)
    middle = (0.5 * (lam2[0] + lam2[1]), half_l), (centre_m, half_m)
    table, degree, truncation = _expand(short, *middle, segments, q)
    return Transfer(
        table=table,
        degree=degree,
        segments=segments,
        lam2=middle[0],
        mu=middle[1],
        truncation=truncation,
        size=size,
        spread=(half_l, half_m * bound),
        swing=reach * bound,
        floor=floor,
        f_error=short.error,
    )


def _resolution(f: PeriodicFunction, spread: float, size: float, reach: float) -> tuple[int, int]:
    """Choose the number of segments and of nodes in each."""
    wanted = 2.0 * pi * max(sqrt(spread) / _SPREAD, sqrt(size) / _SIZE, 1.0)
    if not wanted <= _MOST_SEGMENTS:
        expected = (
            f"at most {(_MOST_SEGMENTS * _SIZE / (2 * pi)) ** 2:.1g}, in boxes of "
            f"at most {(_MOST_SEGMENTS * _SPREAD / (2 * pi)) ** 2:.1g}"
        )
        fix = "scale the equation, or ask for a smaller range"
        raise bad("discriminant", f"|lam2 + mu f| up to {size:.3g}", expected, fix)
    segments = max(8, 2 ** ceil(log2(wanted)))
    weights = np.concatenate([[size], reach * f.amplitudes[1:]])
    waves = np.arange(weights.size, dtype=float)
    while True:
        length = 2.0 * pi / segments
        # Legendre coefficient q of exp(i x t) is at most x^q / (2q - 1)!!.
        x = 0.5 * length * (waves + sqrt(size))
        with np.errstate(under="ignore", over="ignore", divide="ignore"):
            logs = _NODE_COUNTS[:, None] * np.log(x) - _LOG_DOUBLE_FACTORIALS[:, None]
            tails = np.minimum(1.0, np.exp(logs)) @ weights * (0.25 * length**2)
        enough = np.flatnonzero(tails <= _NODE_TAIL)
        if enough.size:
            return segments, int(_NODE_COUNTS[enough[0]])
        if segments >= _MOST_SEGMENTS:
            found = f"a function with {f.harmonics} harmonics"
            raise bad("discriminant", found, "one that 65536 segments resolve", "truncate it")
        segments *= 2


def _expand(
    f: PeriodicFunction, lam2: Range, mu: Range, segments: int, q: int
) -> tuple[Array, int, float]:
    """Return the table of coefficients, its degree, and the size of what is left out."""
    rule = gauss(q)
    g = (pi / segments) ** 2
    values = segment_values(f, segments, tuple(rule.x.tolist()))
    onward, ends, base = _resolvents(rule, g, lam2[0], mu[0], values)
    # Level 0: the free motion from the two unit starts, driven by the base potential.
    free = np.stack([np.ones(q), 1.0 + rule.x])[:, None]
    source = free * base
    sources = [source]
    u = free + _applied(source, onward)
    weighted = mu[1] * values
    weight = g * (lam2[1] + float(np.abs(weighted).max()))
    for k in range(1, 41):
        source = np.empty((2 * (k + 1), segments, q))
        np.multiply(u, lam2[1], out=source[: 2 * k])
        source[2 * k :] = 0.0
        source[2:] += weighted * u
        sources.append(source)
        u = _applied(source, onward)
        # The whole of the next level is at most the last solution times this.
        largest = float(np.abs(u).max()) * weight * (k + 2)
        if largest <= 0.1 * EPS:
            break
    table = _applied(np.concatenate(sources), ends)
    table[0] += [1.0, 0.0]
    table[1] += [2.0, 1.0]
    table = table.reshape(-1, 2, segments, 2).transpose(3, 1, 2, 0).reshape(4 * segments, -1)
    left_out = 2.0 * largest + g * max(lam2[1], mu[1]) * _NODE_TAIL**2
    return np.ascontiguousarray(table), k, left_out


def _resolvents(
    rule: Gauss, g: float, lam2: float, mu: float, values: Array
) -> tuple[Array, Array, Array]:
    """Return the maps from a source to the solution at the nodes and at the end, and the base."""
    # The base potential at the point of expansion, (segments, q), is on the left-hand side: the
    # maps are one matrix each where it is constant, else one per segment.
    q = rule.x.size
    base = np.full(values.shape, lam2) if mu == 0.0 else lam2 + mu * values
    if mu == 0.0:
        resolvent = np.linalg.solve(np.eye(q) + (g * lam2) * rule.inner, rule.inner)
        ends = rule.ends - (g * lam2) * (rule.ends @ resolvent)
    else:
        left = np.eye(q) + g * rule.inner * base[:, None]
        resolvent = np.linalg.solve(left, np.broadcast_to(rule.inner, left.shape))
        ends = rule.ends - g * ((rule.ends * base[:, None]) @ resolvent)
    return -g * np.swapaxes(resolvent, -1, -2), -g * np.swapaxes(ends, -1, -2), base


def _applied(source: Array, matrix: Array) -> Array:
    """Apply one matrix, or one per segment, to sources ``(m, segments, q)``."""
    m, segments, q = source.shape
    if matrix.ndim == 2:
        return (source.reshape(-1, q) @ matrix).reshape(m, segments, -1)
    return np.swapaxes(np.swapaxes(source, 0, 1) @ matrix, 0, 1)
