"""Surfaces of the multipliers of y'' + 2 K y' + (d + eps f(2 t)) y = 0 over d and eps."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import Result, provenance
from ..exact.matrix import hill_boundaries
from ..half_trace import check_function, discriminant, finite
from ..transfer import EPS
from .strutt import COSINE, count_of, damping_of, range_of, reaching

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Which = Literal["first", "second"]


@dataclass(frozen=True, kw_only=True)
class MultiplierSurfaces(Result):
    """Both multipliers over the plane of d and eps.

    Attributes
    ----------
    first, second : ndarray of complex, shape (n, m)
        Multipliers over the period pi: the first has the larger modulus or, of a pair on one
        circle, the positive imaginary part.
    error, second_error : ndarray, shape (n, m)
        Estimates of the absolute errors of either; next to a boundary they grow as a square root.
    d, eps : ndarray, shape (n, m)
        The parameters.
    damping : float
        K of 2 K y'.
    """

    first: NDArray[np.complex128] = field(repr=False)
    second: NDArray[np.complex128] = field(repr=False)
    second_error: Array = field(repr=False)
    d: Array = field(repr=False)
    eps: Array = field(repr=False)
    damping: float

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "first": ("d", "eps"),
        "second": ("d", "eps"),
        "error": ("d", "eps"),
        "second_error": ("d", "eps"),
        "d": ("d", "eps"),
        "eps": ("d", "eps"),
    }

    def plot(
        self,
        ax: Axes | None = None,
        which: Which = "first",
        limits: tuple[float, float] = (-1.0, 1.0),
    ) -> Axes:
        """Draw the real part of one multiplier as a surface, cut off at ``limits``.

        Parameters
        ----------
        ax : Axes, optional
            With three dimensions; a new one by default.
        which : {"first", "second"}
            Which multiplier.
        limits : tuple of float
            Ends of the vertical axis; values beyond are drawn at the ends.

        Raises
        ------
        BadInput
            If the axes are flat, or ``which`` is neither.
        """
        from matplotlib import colormaps

        from ...core.plotting import new_figure

        if which not in ("first", "second"):
            raise bad("which", repr(which), "'first' or 'second'", "correct it")
        if ax is None:
            ax = new_figure().add_subplot(projection="3d")
        space: Any = ax
        if not hasattr(space, "plot_surface"):
            raise bad("ax", "flat axes", "axes of three dimensions", "use projection='3d'")
        height = np.clip((self.first if which == "first" else self.second).real, *limits)
        share = (height[1:, 1:] + height[:-1, :-1] - 2.0 * limits[0]) / np.ptp(limits) / 2.0
        faces = colormaps["cividis"](0.15 + 0.8 * share)
        faces[..., :3] *= _light(self.d, self.eps, height)[..., None]
        drawn = space.plot_surface(
            self.d,
            self.eps,
            height,
            rstride=1,
            cstride=1,
            facecolors=faces,
            shade=False,
            linewidth=0.0,
            antialiased=False,
        )
        # By the nearest corner: thin ridges then hide what is behind them.
        drawn.set_zsort("max")
        space.set_zlim(*limits)
        space.set_xlabel("d")
        space.set_ylabel("ε")
        space.set_zlabel("real part")
        return ax


def _light(d: Array, eps: Array, height: Array) -> Array:
    """Return how bright each face of a surface is, lit from the front left and above."""
    place = np.stack([values / max(float(np.ptp(values)), 1e-300) for values in (d, eps, height)])
    place[2] *= 0.5
    along = place[:, 1:, 1:] - place[:, :-1, 1:]
    across = place[:, 1:, 1:] - place[:, 1:, :-1]
    normal = np.cross(along, across, axis=0)
    size = np.maximum(np.linalg.norm(normal, axis=0), 1e-300)
    upright = np.abs(normal[2]) / size
    facing = np.where(normal[2] < 0.0, -1.0, 1.0) * (0.7 * normal[0] - 0.5 * normal[1]) / size
    return np.asarray(np.clip(0.68 + 0.22 * upright + 0.25 * facing, 0.45, 1.0))


def multiplier_surfaces(
    d: ArrayLike,
    eps: ArrayLike,
    damping: float = 0.0,
    function: PeriodicFunction | None = None,
) -> MultiplierSurfaces:
    """Return both multipliers of y'' + 2 K y' + (d + eps f(2 t)) y = 0 over a grid.

    Parameters
    ----------
    d, eps : array_like, shape (n,) and (m,), or both (n, m)
        Values of the parameters: all pairs of two lines, or a grid such as
        :func:`boundary_fitted_grid` gives.
    damping : float
        K, at least zero.
    function : PeriodicFunction, optional
        f; by default the cosine.

    Raises
    ------
    BadInput
        If an argument is not finite, the shapes are others, or K is negative.

    Notes
    -----
    Aannaque 7.2.3, Figs. E.1 and E.2: eigenvalues of the monodromy matrix over the period pi.
    """
    f = COSINE if function is None else function
    check_function(f)
    k = damping_of(damping)
    across, along = finite("d", d), finite("eps", eps)
    if across.ndim == along.ndim == 1:
        across, along = across[:, None], along[None, :]
    elif across.ndim != 2 or across.shape != along.shape:
        shapes = f"shapes {across.shape} and {along.shape}"
        raise bad("d, eps", shapes, "two lines, or two grids of one shape", "reshape them")
    half = discriminant(f, 0.25 * across, 0.25 * along, 0.5 * k)
    across, along = np.broadcast_arrays(across, along)
    first, second, errors = _multipliers(half.value, half.error, float(np.exp(-2.0 * pi * k)))
    return MultiplierSurfaces(
        method="half trace on a grid",
        error=errors[0],
        error_norm="absolute, entrywise, of the first multiplier",
        checks=half.checks,
        provenance=provenance(),
        first=first,
        second=second,
        second_error=errors[1],
        d=across,
        eps=along,
        damping=k,
    )


def boundary_fitted_grid(
    d_range: tuple[float, float],
    eps: ArrayLike,
    damping: float = 0.0,
    function: PeriodicFunction | None = None,
    per_band: int = 20,
) -> tuple[Array, Array]:
    """Return a grid over (d, eps) that follows the lines on which both multipliers meet.

    Surfaces of multipliers have their kinks there; on this grid they are drawn sharp.

    Parameters
    ----------
    d_range : tuple of float
        Ends of d, the lower one first.
    eps : array_like, shape (m,)
        Values of eps.
    damping : float
        K, at least zero: the lines lie K^2 above the boundaries without damping.
    function : PeriodicFunction, optional
        f; by default the cosine.
    per_band : int
        Steps across each band, from 2.

    Returns
    -------
    d, eps : ndarray, shape (n, m)

    Raises
    ------
    BadInput
        If an argument is not finite or of the wrong shape, or K is negative.
    """
    f = COSINE if function is None else function
    check_function(f)
    low, high = range_of("d", d_range)
    along, k, steps = finite("eps", eps), damping_of(damping), count_of("per_band", per_band)
    if along.ndim != 1 or along.size == 0:
        raise bad("eps", f"shape {along.shape}", "a line of values", "pass a flat sequence")
    numbers = reaching(f, np.array([high]), along)
    found = hill_boundaries(f, 0.25 * along, numbers)
    lines = np.sort(np.concatenate([found.lower[1:], found.upper]), axis=0)
    edges = np.clip(4.0 * lines + k * k, low, high)
    ends = np.full((1, along.size), low), np.full((1, along.size), high)
    edges = np.concatenate([ends[0], edges, ends[1]])
    # Closer at the lines, where the multipliers change as a root.
    share = 0.5 - 0.5 * np.cos(pi * np.arange(steps) / steps)
    bands = [
        first + share[:, None] * (last - first)
        for first, last in pairwise(edges)
        if np.any(last > first)
    ]
    grid = np.concatenate([*bands, ends[1]])
    return grid, np.broadcast_to(along, grid.shape)


def _multipliers(
    half: Array, error: Array, product: float
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], tuple[Array, Array]]:
    """Return the roots of ``rho^2 - 2 half rho + product = 0`` and their errors."""
    edge = sqrt(product)
    square = (np.abs(half) - edge) * (np.abs(half) + edge)
    root = np.sqrt(np.abs(square))
    noise = (2.0 * np.abs(half) + error) * error + EPS * product
    # At a boundary the root is known to the square root of the noise alone.
    moved = error + np.minimum(np.sqrt(noise), noise / np.maximum(root, 1e-300))
    real = square >= 0.0
    sign = np.where(half < 0.0, -1.0, 1.0)
    large = half + sign * root
    first = np.where(real, large, half) + 1j * np.where(real, 0.0, root)
    small = product / np.where(real, large, 1.0)
    second = np.where(real, small, half) - 1j * np.where(real, 0.0, root)
    share = np.where(real, np.abs(small) / np.maximum(np.abs(large), 1e-300), 1.0)
    return first, second, (moved, moved * share + EPS * np.abs(second))
