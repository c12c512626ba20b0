"""Stretches of the angle solved at Chebyshev nodes of one variable, until nothing is missed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..core import chebyshev
from ..core.errors import bad
from .power_series import ENDED, MOST_TERMS, stretch_maps
from .tabulated import coefficients, nodes, running_products

Array = NDArray[np.float64]
# From angles (nt,) to L of y' = L y, (n, nt, m, m).
Generator = Callable[[Array], Array]

# Chebyshev nodes of the angle in a stretch, and of the variable to begin with; the most of them.
_ANGLES, _LEAVES, _MOST_LEAVES = 16, 16, 80
MOST_STRETCHES = 2**17
# How much of the coefficients and of the series in the variable may be missed.
_ROUGH = 64 * float(np.finfo(float).eps)
# Part of the largest coefficients below which the last ones are left out.
_NONE = float(np.finfo(float).eps)
_BLOCK_FLOATS = 1_000_000
_NO_ANGLES = np.zeros(0)


@dataclass(frozen=True)
class Equation:
    """``y' = L(theta, x) y`` from angle 0 on, for all x between two ends.

    Attributes
    ----------
    generators : callable
        From values of x ``(n,)`` to L as a function of angles: ``(nt,)`` to ``(n, nt, m, m)``.
    size : int
        m.
    low, high : float
        Ends of x; ``low`` may equal ``high``.
    span : float
        The angle that has to be solved for [rad].
    degree : int or None
        Of L in x where it is known to be a polynomial.
    together : int
        Stretches that are multiplied into one that is kept.
    angles : ndarray
        Rising angles within the span at which the solution is wanted too [rad], ``(nt,)``.
    name, fix : str
        Of the caller and what helps, for messages.
    most_stretches : int
        Most of them; with so many, coefficients may be rough.
    most_floats : float
        Largest table.
    """

    generators: Callable[[Array], Generator]
    size: int
    low: float
    high: float
    span: float
    degree: int | None = None
    together: int = 1
    angles: Array = field(default_factory=_NO_ANGLES.copy)
    name: str = "stability_chart"
    fix: str = "raise the lowest speed or leave out the highest modes"
    most_stretches: int = MOST_STRETCHES
    most_floats: float = np.inf


@dataclass(frozen=True)
class Flows:
    """The solution as Chebyshev series.

    Attributes
    ----------
    stretches : ndarray
        Coefficients of the matrices of the kept stretches, ``(leaves, count, m, m)``.
    inner : ndarray
        Those from the left end of its stretch to each wanted angle, ``(leaves, nt, m, m)``.
    within : ndarray of int
        The stretch of each wanted angle, ``(nt,)``.
    missed : float
        What the series leave out, summed over the stretches, relative to the matrices.
    """

    stretches: Array
    inner: Array
    within: NDArray[np.intp]
    missed: float


def solved(
    equation: Equation, count: int, leaves: int | None = None, *, fineness: float = 1.0
) -> Flows:
    """Return the solution of an equation, nodes and stretches added until nothing is missed.

    Parameters
    ----------
    equation : Equation
        The equation.
    count : int
        Stretches to begin with.
    leaves : int, optional
        Chebyshev nodes of the variable to begin with.
    fineness : float
        Factor that ``count`` holds: another one gives another solution, to compare.

    Raises
    ------
    BadInput
        If the table is too large or no number of stretches is enough.
    """
    leaves = 1 if equation.low == equation.high else leaves or _LEAVES
    before = np.inf
    while True:
        count, at_nodes = _resolved(equation, count, leaves, fineness)
        stretches, inner = coefficients(at_nodes.stretches), coefficients(at_nodes.inner)
        tail = 0.0
        if leaves > 1:
            tail = max(float(np.max(np.abs(p[-2:]), initial=0.0)) for p in (stretches, inner))
        # Round-off, where more nodes did not halve it.
        if tail <= _ROUGH or tail >= 0.5 * before or leaves >= _MOST_LEAVES:
            missed = (ENDED + at_nodes.missed + tail) * count
            return Flows(stretches, inner, at_nodes.within, missed)
        before, leaves = tail, leaves + leaves // 4


def _resolved(equation: Equation, count: int, leaves: int, fineness: float) -> tuple[int, Flows]:
    """Return values at the nodes and their number of stretches, raised until those do."""
    first, most = count, equation.most_stretches
    while not isinstance(found := _at_nodes(equation, count, leaves), Flows):
        if count >= most:
            what = f"terms too large for {count} stretches"
            raise bad(equation.name, what, "a motion that is slower", equation.fix)
        count = min(int(np.ceil(found * count)), most)
    if count > first and fineness != 1.0:
        # Found so, the number hardly depends on where it began; another fineness is to give
        # another one.
        more = min(int(np.ceil(fineness * count)), most)
        again = _at_nodes(equation, more, leaves)
        if isinstance(again, Flows):
            return more, again
    return count, found


def _at_nodes(equation: Equation, count: int, leaves: int) -> Flows | float:
    """Return the solution at nodes of the variable; where stretches are too long, by how much."""
    _require_room(equation, count, leaves)
    # A generator that is a polynomial of the variable is known from few of its values.
    own = leaves if equation.degree is None else min(leaves, equation.degree + 1)
    generator = equation.generators(nodes(equation.low, equation.high, own))
    spread = chebyshev.basis(chebyshev.nodes(leaves), own).T @ chebyshev.analysis(own)
    width = equation.span / count
    within = np.minimum((equation.angles / width).astype(np.intp), count - 1)
    places, slot = _places(equation.angles / width, within, count)
    m = equation.size
    together = max(1, _BLOCK_FLOATS // (leaves * MOST_TERMS * m * m))
    maps, inner = np.empty((leaves, count, m, m)), np.empty((leaves, len(within), m, m))
    rough = 0.0
    for start in range(0, count, together):
        block = slice(start, min(count, start + together))
        middles: Array = width * np.arange(block.start + 0.5, block.stop)
        series, left_out = _coefficients(generator, middles, 0.5 * width)
        if left_out > _ROUGH and count < equation.most_stretches:
            # Coefficients with high harmonics: what polynomials miss falls like a power of the
            # width.
            factor = 1.1 * (left_out / _ROUGH) ** (1.0 / (_ANGLES - 1))
            return float(np.clip(factor, 1.15, 2.0))
        if own < leaves:
            series = (spread @ series.reshape(own, -1)).reshape(leaves, *series.shape[1:])
        found = stretch_maps(series, places[block])
        if found is None:
            return 2.0
        rough = max(rough, left_out)
        maps[:, block] = found[:, :, -1]
        wanted = np.flatnonzero((within >= block.start) & (within < block.stop))
        inner[:, wanted] = found[:, within[wanted] - start, slot[wanted]]
    return _merged(maps, inner, within, equation.together, rough)


def _require_room(equation: Equation, count: int, leaves: int) -> None:
    floats = leaves * (count + len(equation.angles)) * equation.size**2
    if floats > equation.most_floats:
        raise bad(
            equation.name,
            f"tables of {8e-6 * floats:.3g} MB a range",
            f"at most {8e-6 * equation.most_floats:.3g} MB",
            equation.fix,
        )


def _places(turned: Array, within: NDArray[np.intp], count: int) -> tuple[Array, NDArray[np.intp]]:
    """Return places wanted in each stretch, its end last, and the column of each angle."""
    slot = np.arange(len(within)) - np.searchsorted(within, within)
    places = np.ones((count, int(np.max(slot, initial=-1)) + 2))
    places[within, slot] = 2.0 * (turned - within) - 1.0
    return places, slot


def _coefficients(generator: Generator, middles: Array, half: float) -> tuple[Array, float]:
    """Return L times half a stretch by powers of the place, and what polynomials miss.

    Shape ``(own, stretches, m, powers m)``, side by side.
    """
    angles = middles[:, None] + half * chebyshev.nodes(_ANGLES)
    values = generator(angles.ravel())
    own, _, m, _ = values.shape
    values = half * values.reshape(own, len(middles), _ANGLES, m * m)
    # In two steps: the coefficients by Chebyshev polynomials fall, and with them the round-off
    # of those by powers.
    values = chebyshev.analysis(_ANGLES) @ values
    left_out = float(np.max(np.abs(values[..., -2:, :])))
    values = _by_powers(_ANGLES) @ values
    sizes = np.max(np.abs(values), axis=(0, 1, 3))
    used = chebyshev.length(sizes, _NONE * float(np.max(sizes)))
    values = values[:, :, :used].reshape(own, len(middles), used, m, m)
    return np.moveaxis(values, 2, 3).reshape(own, len(middles), m, used * m), left_out


def _by_powers(count: int) -> Array:
    """Return the matrix from coefficients by Chebyshev polynomials to those by powers."""
    table = np.zeros((count, count))  # T_k by powers, column k
    table[0, 0] = table[1, 1] = 1.0
    for k in range(2, count):
        table[1:, k] = 2.0 * table[:-1, k - 1]
        table[:, k] -= table[:, k - 2]
    return table


def _merged(
    maps: Array, inner: Array, within: NDArray[np.intp], together: int, rough: float
) -> Flows:
    """Return the matrices of several stretches in one, and those to the angles within it."""
    count = maps.shape[1]
    running = running_products(maps, together)
    later = np.flatnonzero(within % together)
    inner[:, later] = inner[:, later] @ running[:, within[later] - 1]
    last = np.append(np.arange(together - 1, count - 1, together), count - 1)
    return Flows(np.ascontiguousarray(running[:, last]), inner, within // together, rough)
