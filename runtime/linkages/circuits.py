"""A linkage's whole closed motion by one regular parameter, through dead centres of the crank too.

The crank angle is no parameter where the crank comes to rest: speeds grow without bound there.
With ``q = sin^2(psi/2)``, psi the crank angle from the frame line (from the downward normal of the
guide for a slider-crank), the loop closes where ``(q - q1)(q2 - q)`` is not negative, and the two
assemblies differ in the sign of its root.  A parameter s that makes the root an analytic function
of s - a multiple of cos s - runs out on one assembly and back on the other without a break.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import factorial, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad, shown
from ..core.inputs import is_whole
from .linkage import Array, Limits, Linkage

Complex = NDArray[np.complex128]


def planar(value: ArrayLike) -> Array:
    """Return complex numbers as components, shape (..., 2)."""
    number = np.asarray(value, dtype=complex)
    return np.stack([number.real, number.imag], axis=-1)


@dataclass(frozen=True, eq=False)
class Taylor:
    """Series ``sum_k c[k] h^k`` about many places; ``c`` has shape (order + 1, places).

    Numbers mix with series; all series of one expression have the same order.
    """

    c: Complex

    def __add__(self, other: Taylor | complex) -> Taylor:
        if isinstance(other, Taylor):
            return Taylor(self.c + other.c)
        total = self.c.copy()
        total[0] += other
        return Taylor(total)

    __radd__ = __add__

    def __neg__(self) -> Taylor:
        return Taylor(-self.c)

    def __sub__(self, other: Taylor | complex) -> Taylor:
        return self + (-other)

    def __rsub__(self, other: complex) -> Taylor:
        return -self + other

    def __mul__(self, other: Taylor | complex) -> Taylor:
        if not isinstance(other, Taylor):
            return Taylor(self.c * other)
        out = self.c[0] * other.c
        for k in range(1, len(out)):
            out[k:] += self.c[k] * other.c[:-k]
        return Taylor(out)

    __rmul__ = __mul__

    def __truediv__(self, other: Taylor | complex) -> Taylor:
        if not isinstance(other, Taylor):
            return Taylor(self.c / other)
        out = np.zeros_like(self.c)
        for k in range(len(out)):
            known = np.sum(out[:k] * other.c[k:0:-1], axis=0)
            out[k] = (self.c[k] - known) / other.c[0]
        return Taylor(out)

    def sqrt(self) -> Taylor:
        """Return the root, of positive real part."""
        out = np.zeros_like(self.c)
        out[0] = np.sqrt(self.c[0])
        for k in range(1, len(out)):
            known = np.sum(out[1:k] * out[k - 1 : 0 : -1], axis=0)
            out[k] = (self.c[k] - known) / (2.0 * out[0])
        return Taylor(out)

    def derivative(self, k: int) -> Complex:
        """Return the ``k``-th derivative at the places."""
        return np.asarray(factorial(k) * self.c[k])


def cosine_sine(s: Array, order: int, rate: float = 1.0) -> tuple[Taylor, Taylor]:
    """Return ``cos(rate s)`` and ``sin(rate s)`` about the places ``s``."""
    cos, sin = np.cos(rate * s), np.sin(rate * s)
    cycle = ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))
    sizes = [rate**k / factorial(k) for k in range(order + 1)]
    rows = [[sizes[k] * cycle[k % 4][i] for k in range(order + 1)] for i in range(2)]
    return Taylor(np.array(rows[0], dtype=complex)), Taylor(np.array(rows[1], dtype=complex))


@dataclass(frozen=True)
class Placed:
    """A moving link along the circuit: place of its first joint and the unit vector along it."""

    origin: Taylor
    direction: Taylor


@dataclass(frozen=True, eq=False)
class Circuit:
    """One closed motion of a linkage, parameter s of period 2 pi.

    Lengths are scaled by a power of two (``scale``), so that their squares are safe.

    Its number is 0 or 1.  Where the crank turns fully: 0 the linkage's assembly, 1 the other one.
    Where the crank swings in two separate ranges: 0 the upper one (psi from 0 to pi), 1 the lower
    one.  Where it swings in one range there is one circuit, through both assemblies.
    """

    linkage: Linkage
    number: int = 0

    @property
    def scale(self) -> float:
        """The power of two by which the lengths are divided."""
        return float(2.0**-self.linkage.scale)

    @cached_property
    def sizes(self) -> Mapping[str, float]:
        """The lengths over ``scale``."""
        return dict(self.linkage.unit_lengths)

    @cached_property
    def limits(self) -> Limits:
        """Where the loop can close."""
        return self.linkage.limits

    @cached_property
    def swings(self) -> tuple[bool, bool]:
        """Whether the crank is stopped by the lower limit, and by the upper one."""
        return self.limits.q1 > 0, self.limits.one_less_q2 > 0

    @property
    def turns(self) -> bool:
        """True where the crank turns fully."""
        return not any(self.swings)

    def check(self) -> None:
        """Raise BadInput for a change point or a circuit that the linkage has not."""
        last = int(self.swings[0] == self.swings[1])
        if self.linkage.mechanism == "quick_return":
            # A block that leaves the rod has no closed motion; there is one assembly.
            self.linkage.require_full_turn()
            last = 0
        if self.limits.q1 == 0 or self.limits.one_less_q2 == 0:
            kind, fix = type(self.linkage).__name__, "change a length by a little"
            found = "a change point: the links come into one line and may leave it two ways"
            raise bad(kind, found, "a linkage whose circuits do not meet", fix)
        if not is_whole(self.number, 0, last):
            has = "0 to 1" if last else "0, the only one"
            raise bad("circuit", shown(self.number), has, "choose another circuit")

    @property
    def _branch(self) -> float:
        branch = float(self.linkage.branch)
        return branch if self.number == 0 else -branch

    def _drive(self, s: Array, order: int) -> tuple[Taylor, Taylor, Taylor]:
        """Return cos(psi/2), sin(psi/2) and the signed root of (q - q1)(q2 - q)."""
        lim = self.limits
        lower, upper = self.swings
        if not (lower or upper):
            half_cos, half_sin = cosine_sine(s, order, 0.5)
            above = half_sin * half_sin - lim.q1
            below = half_cos * half_cos - lim.one_less_q2
            return half_cos, half_sin, self._branch * (above * below).sqrt()
        cos, sin = cosine_sine(s, order)
        if lower and upper:
            # 1 + sin s without cancellation at the lower end, 1 - sin s at the upper one.
            rise_cos, rise_sin = cosine_sine(s + pi / 2, order, 0.5)
            width = lim.q2 - lim.q1
            sine = (lim.q1 + width * (rise_sin * rise_sin)).sqrt()
            cosine = (lim.one_less_q2 + width * (rise_cos * rise_cos)).sqrt()
            side = 1.0 if self.number == 0 else -1.0
            return cosine, side * sine, 0.5 * width * cos
        if lower:
            k = sqrt(lim.one_less_q1)
            cosine = -k * sin
            sine = (lim.q1 + (k * cos) * (k * cos)).sqrt()
            return cosine, sine, k * cos * (cosine * cosine - lim.one_less_q2).sqrt()
        k = sqrt(lim.q2)
        sine = k * sin
        cosine = (lim.one_less_q2 + (k * cos) * (k * cos)).sqrt()
        return cosine, sine, k * cos * (sine * sine - lim.q1).sqrt()

    def crank_angle(self, s: Array) -> Array:
        """Return the crank angle [rad]; s itself, where the crank turns."""
        if self.turns:
            return s + self.linkage.fold_axis
        cosine, sine, _ = self._drive(s, 0)
        half = np.arctan2(sine.c[0].real, cosine.c[0].real)
        return np.asarray(self.linkage.fold_axis + 2.0 * half)

    def parameter(self, crank: complex, branch: float) -> float | None:
        """Return where the crank has a direction on an assembly; None on another circuit."""
        psi = float(np.angle(crank * (1j if self.linkage.fold_axis else 1.0)))
        lim, (lower, upper) = self.limits, self.swings
        if self.turns:
            return psi if branch == self._branch else None
        cosine, sine = np.cos(psi / 2), np.sin(psi / 2)
        if lower and upper:
            if (sine < 0) != (self.number == 1):
                return None
            level = 2.0 * (sine**2 - lim.q1) / (lim.q2 - lim.q1) - 1.0
        elif lower:
            level = -cosine * np.sign(sine) / sqrt(lim.one_less_q1)
        else:
            level = sine / sqrt(lim.q2)
        s = float(np.arcsin(np.clip(level, -1.0, 1.0)))
        return s if branch > 0 else pi - s

    def branch(self, s: Array) -> Array:
        """Return +1 where the assembly is open, -1 where it is crossed."""
        if self.turns:
            return np.full(s.shape, self._branch)
        return np.where(np.cos(s) >= 0, 1.0, -1.0)

    def links(self, s: Array, order: int) -> dict[str, Placed]:
        """Return the moving links along the circuit; lengths are over ``scale``."""
        size = self.sizes
        cosine, sine, root = self._drive(s, order)
        kind, half = self.linkage.mechanism, cosine + 1j * sine
        # exp(-i pi/2) has no exact cosine.
        crank = half * half * (-1j if kind == "slider_crank" else 1.0)
        zero = Taylor(np.zeros_like(crank.c))
        pin = size["crank"] * crank
        placed = {"crank": Placed(zero, crank)}
        if kind == "quick_return":
            near, far = size["frame"] - size["crank"], size["frame"] + size["crank"]
            square = far**2 * (cosine * cosine) + near**2 * (sine * sine)
            along = far * (cosine * cosine) + near * (sine * sine)
            rod = (along + 1j * _imag(pin)) / square.sqrt()
            return placed | {"block": Placed(pin, rod), "rod": Placed(zero - size["frame"], rod)}
        if kind == "slider_crank":
            c, m, e = size["crank"], size["coupler"], size["offset"]
            raised = e - c * (sine * sine - cosine * cosine)
            along = 2.0 * c * root
            level = Taylor(pin.c.real.astype(complex)) + along
            placed["coupler"] = Placed(pin, (along + 1j * raised) / m)
            placed["slider"] = Placed(level + 1j * e, zero + 1.0)
            return placed
        f, c, m, n = (size[k] for k in ("frame", "crank", "coupler", "follower"))
        near, far = f - c, f + c
        square = near**2 * (cosine * cosine) + far**2 * (sine * sine)
        # D - B, each part without cancellation.
        to_pivot = (near * (cosine * cosine) + far * (sine * sine)) - 1j * _imag(pin)
        beside = 2.0 * f * c * root
        middle = 0.5 * (square + (m - n) * (m + n))
        opposite = 0.5 * (square - (m - n) * (m + n))
        placed["coupler"] = Placed(pin, to_pivot * (middle + 1j * beside) / (m * square))
        placed["follower"] = Placed(zero + f, to_pivot * (1j * beside - opposite) / (n * square))
        return placed

    def path(self, s: Array, link: str, place: complex, order: int) -> Taylor:
        """Return the path of a point of a link, ``place`` in the link's frame over ``scale``."""
        at = self.links(s, order)[link]
        return at.origin + place * at.direction

    def joints(self, s: Array) -> dict[str, Complex]:
        """Return the places of the joints A, B, C, D (where there are such) in true lengths."""
        links, places = self.links(s, 0), {}
        for link, letters in self.linkage.bars.items():
            at = links[link]
            places[letters[0]] = at.origin.c[0]
            if len(letters) == 2:
                places[letters[1]] = (at.origin + self.sizes[link] * at.direction).c[0]
        return {name: self.scale * place for name, place in sorted(places.items())}


def _imag(series: Taylor) -> Taylor:
    return Taylor(series.c.imag.astype(complex))
