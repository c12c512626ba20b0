"""The implicit equation of a four-bar's coupler curve, and its double points in closed form.

With p the tracing point as a complex number, p = B + g u, and w = p - f seen from D, where u is the
direction of the coupler, g the place of the point in it and d = l3 - g, the two bars demand

    conj(p) g u + p conj(g) conj(u) = M,     M = |p|^2 + |g|^2 - l2^2
    conj(w) d u + w conj(d) conj(u) = -N,    N = |w|^2 + |d|^2 - l4^2

Eliminating u by |u| = 1 leaves |M w conj(d) + N p conj(g)|^2 = 4 Im(conj(p) g w conj(d))^2, of
degree six in the coordinates of p and containing both circular points threefold.  Where u is left
undecided both sides vanish: a double point.  The right side alone vanishes on the circle through
A, D and the third singular focus f g/l3; on it the left side is a cubic.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..core.errors import bad
from .circuits import Complex
from .four_bar import FourBar
from .linkage import Array


def sextic_residual(lengths: Mapping[str, float], place: complex, points: Complex) -> Array:
    """Return how far points miss the equation of the curve, over the size of its terms.

    Parameters
    ----------
    lengths : mapping of str to float
        Of the four-bar.
    place : complex
        The tracing point in the coupler's axes, along + i across, in the same unit.
    points : ndarray of complex, shape (n,)
        Places x + i y in the fixed frame.

    Returns
    -------
    ndarray, shape (n,)
        Zero on the curve of either assembly; of the order of round-off for computed points.
    """
    f, crank, coupler, follower = (
        lengths[name] for name in ("frame", "crank", "coupler", "follower")
    )
    rest = coupler - place
    w = points - f
    m = np.abs(points) ** 2 + abs(place) ** 2 - crank**2
    n = np.abs(w) ** 2 + abs(rest) ** 2 - follower**2
    left = m * w * np.conj(rest) + n * points * np.conj(place)
    right = 2.0 * (np.conj(points) * place * w * np.conj(rest)).imag
    size_m = np.abs(points) ** 2 + abs(place) ** 2 + crank**2
    size_n = np.abs(w) ** 2 + abs(rest) ** 2 + follower**2
    size = size_m * np.abs(w * rest) + size_n * np.abs(points * place)
    size = size + 2.0 * np.abs(points * place * w * rest)
    # Both sides are squares; their difference in the linear measure of a distance.
    return np.asarray(np.abs(np.abs(left) - np.abs(right)) / np.maximum(size, 1e-300))


@dataclass(frozen=True, eq=False)
class SexticNodes:
    """The real double points of a coupler curve of sixth degree.

    Attributes
    ----------
    position : ndarray, shape (k, 2)
        One or three places [m].
    crossing : ndarray of bool, shape (k,)
        True where two positions of the linkage - of any assembly - put the point there; the others
        are isolated points of the equation that no linkage reaches.
    """

    position: Array
    crossing: np.ndarray[tuple[int], np.dtype[np.bool_]]


def sextic_nodes(linkage: FourBar, along: float, across: float = 0.0) -> SexticNodes:
    """Return the double points of both circuits of a coupler curve from the roots of a cubic.

    Parameters
    ----------
    linkage : FourBar
        The four-bar; its assembly does not matter.
    along, across : float
        Place of the tracing point in the coupler's axes [m].

    Returns
    -------
    SexticNodes

    Raises
    ------
    BadInput
        If the point is a joint of the coupler: the equation falls apart into circles.
    """
    f, crank, coupler, follower = (float(linkage.lengths[name]) for name in linkage.names)
    place = complex(along, across)
    rest = coupler - place
    if min(abs(place), abs(rest)) <= 1e-12 * coupler:
        raise bad("along, across", "a joint of the coupler", "another point", "it traces a circle")
    # On the circle w = r conj(g) d p with r real, so p = f/(1 - r conj(g) d).
    product = np.conj(place) * rest
    q = np.array([abs(product) ** 2, -2.0 * product.real, 1.0])
    one = np.array([1.0, 0.0])
    first = np.polyadd([f**2], (abs(place) ** 2 - crank**2) * q)
    cubic = np.polyadd(
        abs(rest) ** 2 * np.polymul(one, first),
        np.polyadd([abs(product) ** 2 * f**2, 0.0, 0.0], (abs(rest) ** 2 - follower**2) * q),
    )
    roots = np.roots(cubic)
    real = roots[np.abs(roots.imag) <= 1e-7 * np.abs(roots)].real
    points = f / (1.0 - real * product)
    m = np.abs(points) ** 2 + abs(place) ** 2 - crank**2
    crossing = np.abs(m) < 2.0 * np.abs(points * place)
    return SexticNodes(np.stack([points.real, points.imag], axis=-1), crossing)
