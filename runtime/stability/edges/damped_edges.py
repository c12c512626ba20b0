"""Ends of unstable regions with damping: crossings of the circle, labelled as without damping."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ...core.families import LinearPeriodic
from ...periodic import monodromy
from ...periodic.multipliers import conditions
from .crossings import Crossings, Span
from .pair_roots import perturbation_size
from .phase_events import phase_grid
from .regions import Regions

Array = NDArray[np.float64]
Index = NDArray[np.intp]
_Growth = Callable[[Index, Array], tuple[Array, Array]]

# Places at which growth is looked for, in half widths from the middle of the undamped region.
_PLACES = np.linspace(-1.5, 1.5, 13)
_PARABOLAS = 4
# Arguments [rad] that count as that of the pair in any case.
_NEAR = 0.1
# Cost of a label: of another kind of multiplier, in half widths, and the most that is taken.
_OTHER_KIND, _FAR = 100.0, 20.0
_LIKE_WIDTH, _LOWER = 0.2, 0.05


def damped_regions(
    system: LinearPeriodic,
    undamped: Regions,
    span: tuple[float, float],
    rtol: float,
    parameters: Mapping[str, float],
) -> Regions:
    """Return the unstable regions of a damped system.

    Parameters
    ----------
    system : LinearPeriodic
        With damping.
    undamped : Regions
        Without: where narrow regions are looked for, and whence the labels are taken.
    span : pair of float
        The range [rad/s].
    rtol : float
        Of the monodromy matrices.
    parameters : mapping
        Parameter values that replace the system's own.
    """
    begin, end = np.maximum(undamped.begin, span[0]), np.minimum(undamped.end, span[1])
    undamped = undamped.take(np.flatnonzero(end - begin > 4 * undamped.error))
    begin, end = np.maximum(undamped.begin, span[0]), np.minimum(undamped.end, span[1])
    phase = np.angle(undamped.multiplier)

    def growth(which: Index, speed: Array) -> tuple[Array, Array]:
        return _growth(system, speed, phase[which], rtol, parameters)

    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    ends = np.unique(np.concatenate([span, begin, end]))
    more = np.concatenate(
        [
            _highest(growth, middle, half),
            (middle[:, None] + half[:, None] * _PLACES).ravel(),
            0.5 * (ends[1:] + ends[:-1]),
        ]
    )
    more = more[(more > span[0]) & (more < span[1])]
    speed = phase_grid(system, span, parameters, more)
    speed[[0, -1]] = span
    spans = Crossings(system, parameters, rtol, speed).spans()
    return labelled([s for s in spans if not s.upper - s.lower <= 0.0], undamped)


def labelled(spans: list[Span], undamped: Regions) -> Regions:
    """Give each the label of the undamped region it is most like, none twice; 0 where none is."""
    from scipy.optimize import linear_sum_assignment

    k = len(spans)
    begin, end = np.array([s.begin for s in spans]), np.array([s.end for s in spans])
    turn = np.array([s.multiplier for s in spans], dtype=complex)
    lows, highs = undamped.begin, undamped.end
    size = (end - begin)[:, None] + (highs - lows) + 1e-12 * end[:, None]
    cost = np.abs((end + begin)[:, None] - (highs + lows)) / size
    cost = cost + 2 * np.abs(np.angle(turn[:, None] / _upper(undamped.multiplier)))
    # Of two that lie alike the one of like width, then that of the lower, stronger harmonic.
    ratio = np.log((end - begin + 1e-15 * end)[:, None] / (highs - lows + 1e-15 * highs))
    cost = cost + _LIKE_WIDTH * np.abs(ratio) + _LOWER * undamped.harmonic
    real = np.array([s.multiplier.imag == 0.0 for s in spans], dtype=bool)
    principal = np.array([kind == "principal" for kind in undamped.kind], dtype=bool)
    cost = cost + _OTHER_KIND * (real[:, None] != principal)
    pairs = [(r, c) for r, c in zip(*linear_sum_assignment(cost), strict=True) if cost[r, c] < _FAR]
    modes, harmonic = np.zeros((k, 2), dtype=np.int64), np.zeros(k, dtype=np.int64)
    detuning = np.full(k, np.nan)
    kind = ["principal" if flag else "sum" for flag in real]
    for row, column in pairs:
        modes[row], harmonic[row] = undamped.modes[column], undamped.harmonic[column]
        detuning[row], kind[row] = undamped.detuning[column], undamped.kind[column]
    return Regions(
        np.array([s.lower for s in spans]),
        np.array([s.upper for s in spans]),
        np.array([s.error for s in spans]),
        turn,
        modes,
        harmonic,
        detuning,
        begin,
        end,
        tuple(kind),
    )


def _upper(turn: NDArray[np.complex128]) -> NDArray[np.complex128]:
    value: NDArray[np.complex128] = turn.real + 1j * np.abs(turn.imag)
    return value


def _highest(growth: _Growth, middle: Array, half: Array) -> Array:
    """Return where growth is greatest about the undamped regions."""
    k, places = len(middle), len(_PLACES)
    rows = np.arange(k)
    speed = np.maximum(middle[:, None] + half[:, None] * _PLACES, 1e-3 * middle[:, None])
    value, _ = growth(np.repeat(rows, places), speed.ravel())
    value = value.reshape(k, places)
    best = np.clip(np.argmax(value, axis=1), 1, places - 2) if k else rows
    x = np.stack([speed[rows, best + s] for s in (-1, 0, 1)])
    g = np.stack([value[rows, best + s] for s in (-1, 0, 1)])
    for _ in range(_PARABOLAS):
        place = _vertex(x, g)
        new, _ = growth(rows, place)
        x, g = _three(x, g, place, new)
    found: Array = x[np.argmax(g, axis=0), rows]
    return found


def _growth(
    system: LinearPeriodic,
    speed: Array,
    phase: Array,
    rtol: float,
    parameters: Mapping[str, float],
) -> tuple[Array, Array]:
    """Return the largest log modulus of the multipliers near a phase, and its error."""
    if not len(speed):
        return np.zeros(0), np.zeros(0)
    result = monodromy(system, speed, rtol=rtol, **parameters)
    matrices = np.ldexp(result.scaled, result.exponent[:, None, None])
    values, vectors = np.linalg.eig(matrices)
    away = np.abs(np.angle(values * np.exp(-1j * phase)[:, None]))
    with np.errstate(divide="ignore"):
        logarithm = np.log(np.abs(values))
    # Those that the undamped pair has become, whatever else grows at another argument.
    second = np.sort(away, axis=-1)[:, 1:2]
    logarithm = np.where(away <= np.maximum(second, _NEAR), logarithm, -np.inf)
    chosen = np.argmax(logarithm, axis=-1)
    rows = np.arange(len(speed))
    own = conditions(vectors.astype(complex))[rows, chosen]
    noise = own * perturbation_size(matrices, result.error) / np.abs(values[rows, chosen])
    return logarithm[rows, chosen], np.minimum(noise, 1.0)


def _vertex(x: Array, g: Array) -> Array:
    """Return where a parabola through three points is greatest, within them."""
    with np.errstate(divide="ignore", invalid="ignore"):
        left, right = (g[1] - g[0]) / (x[1] - x[0]), (g[2] - g[1]) / (x[2] - x[1])
        curve = (right - left) / (x[2] - x[0])
        place = 0.5 * (x[0] + x[1]) - 0.5 * left / curve
    usable = np.isfinite(place) & (curve < 0)
    place = np.where(usable, place, 0.5 * (x[1] + x[2]))
    margin = 1e-2 * (x[2] - x[0])
    value: Array = np.clip(place, x[0] + margin, x[2] - margin)
    return value


def _three(x: Array, g: Array, place: Array, value: Array) -> tuple[Array, Array]:
    """Return the greatest of four points and its neighbours."""
    four = np.concatenate([x, place[None]])
    order = np.argsort(four, axis=0, kind="stable")
    four = np.take_along_axis(four, order, axis=0)
    values = np.take_along_axis(np.concatenate([g, value[None]]), order, axis=0)
    top = np.clip(np.argmax(values, axis=0), 1, 2)
    rows = np.arange(four.shape[1])
    chosen = [(four[top + s, rows], values[top + s, rows]) for s in (-1, 0, 1)]
    return np.stack([c[0] for c in chosen]), np.stack([c[1] for c in chosen])
