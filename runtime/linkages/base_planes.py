"""Barker's solution space: base planes and the regions of the classes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.inputs import is_finite, require_whole
from ..core.plotting import ABOVE, Axes, axes_or_new
from ..core.results import Result, provenance
from .classification import SYMBOLS, classify, number_of_signs
from .linkage import Array

# Of the plane: to the right more output, upwards more frame.
_AXES = np.array([[-1.0, 1.0, 0.0], [-1.0, -1.0, 2.0]]) / np.sqrt([[2.0], [6.0]])
# A mark so near the middle of a symbol, over the size of the plane, would cover it; the symbol
# then moves so many points.
_WIDE, _HIGH, _STEP = 0.08, 0.05, 16.0


@dataclass(frozen=True, kw_only=True)
class BasePlane(Result):
    """One base plane: lambda_2 + lambda_3 + lambda_4 = sqrt(3) lam (Aannaque 3.4, Fig. 3.5).

    The ratios are coupler, output and frame over the input link, in this order.

    Attributes
    ----------
    lam : float
        Distance of the plane from the origin.
    x, y : ndarray
        Coordinates in the plane: (lambda_3 - lambda_2)/sqrt(2) and
        (2 lambda_4 - lambda_2 - lambda_3)/sqrt(6).
    numbers : ndarray of int, shape (len(y), len(x))
        Row of Barker's table at each point, 0 where no linkage exists.
    regions : mapping of str to ndarray, shape (n, 3)
        Corners of the region of each class, as ratios; none that rounding cannot tell from empty.
    outline : ndarray, shape (n, 3)
        Corners of all that can close: zero-mobility planes and vanishing links.
    """

    lam: float
    x: Array
    y: Array
    numbers: NDArray[np.int64]
    regions: Mapping[str, Array]
    outline: Array

    arrays_along: ClassVar = {"x": "x", "y": "y", "y x": "numbers", "corner ratio": "outline"}

    @property
    def shares(self) -> dict[str, float]:
        """Share of each class in the area of the plane where linkages exist."""
        whole, _ = _area_and_centroid(self.outline)
        parts = {symbol: _area_and_centroid(part)[0] for symbol, part in self.regions.items()}
        return {symbol: part / whole for symbol, part in parts.items()}

    def plot(self, ax: Axes | None = None, *, mark: Sequence[float] | None = None) -> Axes:
        """Draw regions and borders with the symbols of the classes; ``mark`` is one linkage."""
        ax = axes_or_new(ax)
        for symbol, corners in self.regions.items():
            flat = corners @ _AXES.T
            colour = "#cfe0ee" if symbol.startswith("G") else "#f2c6a8"
            ax.fill(flat[:, 0], flat[:, 1], facecolor=colour, edgecolor="#444444", lw=0.8)
            x, y = _area_and_centroid(corners)[1]
            shift = (0.0, self._aside((x, y), mark))
            ax.annotate(symbol, (x, y), shift, **{**ABOVE, "va": "center", "fontsize": 9})
        if mark is not None:
            at = _AXES @ np.asarray(mark)
            ax.plot(*at, "o", color="#8c2d04", mfc="none", ms=9, label="this linkage")
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), fontsize=8, frameon=False)
        x, y = r"$(\lambda_3-\lambda_2)/\sqrt{2}$", r"$(2\lambda_4-\lambda_2-\lambda_3)/\sqrt{6}$"
        ax.set(aspect="equal", xlabel=x, ylabel=y, title=rf"base plane $\lambda$ = {self.lam:.4g}")
        return ax

    def _aside(self, place: tuple[float, float], mark: Sequence[float] | None) -> float:
        """Return how far a symbol moves up or down [points] to leave the mark free."""
        if mark is None:
            return 0.0
        off = (_AXES @ np.asarray(mark) - place) / np.ptp(self.outline @ _AXES.T, axis=0)
        if abs(off[0]) > _WIDE or abs(off[1]) > _HIGH:
            return 0.0
        return -_STEP if off[1] >= 0.0 else _STEP


def base_plane(lam: float, points: int = 201) -> BasePlane:
    """Return one base plane of Barker's solution space (Aannaque 3.4).

    ``lam`` is (coupler + output + frame)/(sqrt(3) input), above 1/sqrt(3), where the input link
    would be as long as the other three together; the region map has at least 2 ``points`` in each
    direction.  A plane in which no linkage lies is refused.
    """
    least = 3.0**-0.5
    if not (is_finite(lam) and least < lam < 1e100):
        raise bad("lam", repr(lam), f"a finite number above {least:.6g}", "no linkage lies there")
    require_whole("points", points, 2, 5000)
    total = float(lam) * 3.0**0.5
    # The triangle of positive ratios, less what the zero-mobility planes cut off.
    outline = total * np.eye(3)
    for i in range(3):
        outline = _clipped(outline, i, (1.0 + total) / 2.0, -1.0)
    flat = outline @ _AXES.T
    x, y = (np.linspace(flat[:, i].min(), flat[:, i].max(), points) for i in range(2))
    ratios = total / 3.0 + x[None, :, None] * _AXES[0] + y[:, None, None] * _AXES[1]
    inside = np.all(ratios > 0, axis=-1)
    numbers = np.zeros(inside.shape, dtype=np.int64)
    coupler, output, frame = ratios[inside].T
    numbers[inside] = classify(np.stack([frame, np.ones_like(frame), coupler, output], -1))
    # Of 600 planes in 50 digits no corner was off by more than a sixteenth of it.
    error = 16.0 * np.finfo(float).eps * max(total, 1.0)
    return BasePlane(
        lam=float(lam),
        x=x,
        y=y,
        numbers=numbers,
        regions=_regions(outline, total, error),
        outline=outline,
        method="half-planes of the signs of three sums; exact classes at the points",
        error=error,
        error_norm="corners of regions and outline, absolute, worst",
        error_kind="bound",
        provenance=provenance({"lam": repr(float(lam))}),
    )


def _regions(outline: Array, total: float, error: float) -> dict[str, Array]:
    """Return the region of each class: on either side of (total - 1)/2 for each ratio."""
    # One whose middle is no farther from its borders than rounding moves them is left out.
    half = (total - 1.0) / 2.0
    regions = {}
    for code in range(8):
        sides = [1.0 if code >> i & 1 else -1.0 for i in range(3)]
        corners = outline
        for i, side in enumerate(sides):
            corners = _clipped(corners, i, half, side)
        # Ratios coupler, output, frame against S_2 (frame), S_3 (output), S_4 (coupler).
        signs = (int(sides[2]), -int(sides[1]), -int(sides[0]))
        if len(corners) < 3:
            continue
        # Both the borders and the edges of the outline that lie next to them count.
        middle = corners.mean(axis=0)
        room = min(np.abs(middle - half).min(), middle.min(), ((1.0 + total) / 2.0 - middle).min())
        if room > error:
            regions[SYMBOLS[number_of_signs(signs)]] = corners
    return dict(sorted(regions.items()))


def _clipped(corners: Array, axis: int, at: float, side: float) -> Array:
    """Return the part of a convex polygon where side (coordinate - at) >= 0."""
    kept = []
    for here, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        low, high = side * (here[axis] - at), side * (after[axis] - at)
        if low >= 0:
            kept.append(here)
        if low * high < 0:
            cut = here + (after - here) * (low / (low - high))
            cut[axis] = at
            kept.append(cut)
    return np.array(kept).reshape(-1, 3)


def _area_and_centroid(corners: Array) -> tuple[float, Array]:
    """Return the area of a polygon of the plane, and its centroid in the plane."""
    here = corners @ _AXES.T
    after = np.roll(here, -1, axis=0)
    cross = here[:, 0] * after[:, 1] - after[:, 0] * here[:, 1]
    return float(abs(cross.sum()) / 2.0), cross @ (here + after) / (3.0 * cross.sum())
