"""Linear systems round a closed ring of nodes, solved by orthogonal elimination whatever grows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


def solve_ring(maps: Array, loads: Array) -> tuple[Array, Array]:
    """Solve ``y[k+1] = maps[k] y[k] + loads[k]`` round a ring, ``y[ns] = y[0]``.

    Neighbouring equations are joined by Householder reflections that eliminate the node between
    them, level by level, until one equation for the first node is left.  The product of the maps is
    never formed: growth within the ring and decay do no harm, only a ring that is nearly free to
    move as a whole (a multiplier near 1) does.

    Of maps ``(nb, ns, m, m)`` and loads ``(nb, ns, m)`` come nodes ``(nb, ns, m)``, NaN where the
    ring is singular, and an estimate ``(nb,)`` of the largest relative change of the nodes over a
    relative change of the maps, infinite there.
    """
    count, _, m = loads.shape
    left = -maps
    right = np.broadcast_to(np.eye(m), maps.shape)
    levels: list[tuple[Array, Array, Array, Array]] = []
    while left.shape[1] > 1:
        left, right, loads, level = _joined(left, right, loads)
        levels.append(level)
    closed = left[:, 0] + right[:, 0]
    inverse, singular = _inverse(closed)
    nodes: Array = (inverse @ loads[:, 0, :, None]).transpose(0, 2, 1)
    size = np.linalg.norm(left[:, 0], axis=(-2, -1)) + np.linalg.norm(right[:, 0], axis=(-2, -1))
    sensitivity = np.where(singular, np.inf, np.linalg.norm(inverse, axis=(-2, -1)) * size)
    for middle, back, ahead, load in reversed(levels):
        pairs = middle.shape[1]
        following = np.roll(nodes, -1, axis=1)[:, :pairs]
        first, alone = nodes[:, :pairs], nodes[:, pairs:]
        rest = load - _apply(back, first) - _apply(ahead, following)
        between = np.linalg.solve(middle, rest[..., None])[..., 0]
        both = np.stack([first, between], axis=2).reshape(count, -1, m)
        nodes = np.concatenate([both, alone], axis=1)
    nodes[singular] = np.nan
    return nodes, sensitivity


def _joined(
    left: Array, right: Array, loads: Array
) -> tuple[Array, Array, Array, tuple[Array, Array, Array, Array]]:
    """Eliminate every other node from ``left[k] y[k] + right[k] y[k+1] = loads[k]``."""
    # The last of an odd number stays as it is.
    m = left.shape[-1]
    even = left.shape[1] - left.shape[1] % 2
    rest = (left[:, even:], right[:, even:], loads[:, even:])
    left, right, loads = left[:, :even], right[:, :even], loads[:, :even]
    column = np.concatenate([right[:, 0::2], left[:, 1::2]], axis=-2)
    reflections, triangle = np.linalg.qr(column, mode="complete")
    turned = np.swapaxes(reflections, -1, -2)
    back = turned[..., :m] @ left[:, 0::2]
    ahead = turned[..., m:] @ right[:, 1::2]
    both = np.concatenate([loads[:, 0::2], loads[:, 1::2]], axis=-1)
    load = _apply(turned, both)
    level = (triangle[..., :m, :], back[..., :m, :], ahead[..., :m, :], load[..., :m])
    kept = (back[..., m:, :], ahead[..., m:, :], load[..., m:])
    joined = [np.concatenate([new, old], axis=1) for new, old in zip(kept, rest, strict=True)]
    return joined[0], joined[1], joined[2], level


def _apply(matrices: Array, vectors: Array) -> Array:
    value: Array = (matrices @ vectors[..., None])[..., 0]
    return value


def _inverse(matrices: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return inverses, of the unit matrix where singular, and which are singular."""
    spread = np.linalg.svd(matrices, compute_uv=False)
    singular = ~(spread[:, -1] > _EPS * spread[:, 0])
    usable = np.where(singular[:, None, None], np.eye(matrices.shape[-1]), matrices)
    inverse: Array = np.linalg.inv(usable).astype(np.float64)
    return inverse, singular
