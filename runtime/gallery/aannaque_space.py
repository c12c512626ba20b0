"""Aannaque's Figs. 3.4 and 3.5: zero-mobility planes and base planes of the solution space."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from ..linkages.base_planes import BasePlane, base_plane
from ..linkages.classification import SYMBOLS, classify
from .records import Drawn, Quoted, Table
from .sketches import Array, write
from .style import COLOURS, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SPACE_LAMBDA = 1.5
# Below, at and above the plane through the linkage of four equal links.
_PLANES = (1.0, sqrt(3.0), 3.0)
_DIRECTIONS = np.vstack([np.ones(3), 2.0 * np.eye(3) - 1.0])
_OFFSETS = np.array([1.0, 1.0, 1.0, 1.0])
_NAMES = (
    r"$1=\lambda_2+\lambda_3+\lambda_4$",
    r"$\lambda_2=1+\lambda_3+\lambda_4$",
    r"$\lambda_3=\lambda_2+1+\lambda_4$",
    r"$\lambda_4=\lambda_2+\lambda_3+1$",
)


def figure_3_4(axes: Sequence[Axes]) -> Drawn:
    """Draw the solution space up to a base plane, seen obliquely."""
    ax = axes[0]
    plane = base_plane(_SPACE_LAMBDA)
    total = sqrt(3.0) * _SPACE_LAMBDA
    ax.set_axis_off()
    ax.set_aspect("equal")
    far, near = 0.5 * (total + 1.0), 0.5 * (total - 1.0)
    for i in range(3):
        corners = np.full((3, 3), 0.0)
        corners[:, i] = 1.0, far, far
        corners[1, (i + 1) % 3] = near
        corners[2, (i + 2) % 3] = near
        _face(ax, corners, COLOURS[i], 0.30)
        _call(ax, corners.mean(axis=0), _NAMES[i + 1], ((-96, -14), (96, -14), (104, 44))[i])
    _face(ax, np.eye(3), COLOURS[3], 0.45)
    _call(ax, np.full(3, 1.0 / 3.0), _NAMES[0], (-172, 62))
    _face(ax, plane.outline, "0.55", 0.25)
    _call(ax, total * np.array([0.08, 0.46, 0.46]), "base plane", (84, 20))
    for i, axis in enumerate(np.eye(3)):
        ends = np.array([np.zeros(3), 1.25 * far * axis]) @ _VIEW.T
        ax.plot(*ends.T, color="0.3", lw=0.9, zorder=1)
        write(ax, ends[1], rf"$\lambda_{i + 2}$", 8.0 * ends[1] / np.hypot(*ends[1]), fontsize=11)
    foot = np.full(3, _SPACE_LAMBDA / sqrt(3.0))
    line = np.array([np.zeros(3), foot]) @ _VIEW.T
    ax.plot(*line.T, "--", color="0.2", lw=1.0, zorder=8)
    ax.plot(*line[1], "o", color="0.2", ms=3.5, zorder=8)
    write(ax, line[1], r"$\lambda$", (8.0, 8.0), fontsize=11)
    note = (
        "The base plane's place is not stated; drawn at lambda = 1.5. The space lies between the "
        "four planes and the three coordinate planes, and goes on without end above."
    )
    return Drawn(tuple(_space_rows(plane)), (note,))


def _view() -> Array:
    """Return the projection of the three axes on the paper, the third upwards."""
    turn, tilt = np.radians(38.0), np.radians(24.0)
    right = [-np.sin(turn), np.cos(turn), 0.0]
    up = [-np.cos(turn) * np.sin(tilt), -np.sin(turn) * np.sin(tilt), np.cos(tilt)]
    return np.array([right, up])


_VIEW = _view()


def _face(ax: Axes, corners: Array, colour: str, alpha: float) -> None:
    flat = corners @ _VIEW.T
    ax.fill(*flat.T, facecolor=colour, alpha=alpha, edgecolor="none", zorder=2)
    ax.fill(*flat.T, facecolor="none", edgecolor=colour, lw=1.1, zorder=3)


def _call(ax: Axes, place: Array, text: str, shift: tuple[float, float]) -> None:
    """Name a face from outside, with a thin line to it."""
    x, y = _VIEW @ place
    ax.annotate(
        text,
        (float(x), float(y)),
        xytext=shift,
        textcoords="offset points",
        ha="center",
        va="center",
        arrowprops={"arrowstyle": "-", "color": "0.4", "lw": 0.7},
        zorder=9,
    )


def _beside(step: float) -> Array:
    """Return ratios a step off the four zero-mobility planes, shape (n, 3); inwards positive."""
    generator = np.random.default_rng(34)
    found = []
    for normal, offset in zip(_DIRECTIONS, _OFFSETS, strict=True):
        # A point of the plane: free ratios first, then the one that closes it.
        own = int(np.argmax(normal))
        part = generator.dirichlet(np.ones(3), 500)
        if np.all(normal > 0):
            place = part
        else:
            place = generator.uniform(0.05, 3.0, (500, 3))
            place[:, own] = 0.0
            place[:, own] = offset + place.sum(axis=1)
        inwards = normal if np.all(normal > 0) else -normal
        found.append(place + step * inwards)
    return np.concatenate(found)


def _linkages(ratios: Array) -> Array:
    """Return frame, input, coupler, output of ratios lambda_2, lambda_3, lambda_4."""
    coupler, output, frame = ratios.T
    return np.stack([frame, np.ones_like(frame), coupler, output], axis=-1)


def _space_rows(plane: BasePlane) -> list[Quoted]:
    inside, outside = (np.mean(classify(_linkages(_beside(step))) > 0) for step in (1e-6, -1e-6))
    ratios = plane.outline
    gaps = np.abs(ratios @ _DIRECTIONS.T - _OFFSETS)
    distance = np.abs(ratios @ np.full(3, 1.0 / sqrt(3.0)) - plane.lam)
    random = "2000 points, 500 of each plane, moved 1e-6 off it"
    return [
        Quoted(
            "share of linkages just inside the zero-mobility planes that exist",
            1.0,
            float(inside),
            0.0,
            random,
            "3.4",
        ),
        Quoted("the same just outside the planes (3.2)", 0.0, float(outside), 0.0, random, "3.4"),
        Quoted(
            "corners of the base plane off the zero-mobility planes",
            0.0,
            float(np.max(np.min(gaps, axis=1))),
            1e-12,
            "round-off",
            "3.4",
        ),
        Quoted(
            "corners' distance from the origin along the normal, less lambda",
            0.0,
            float(np.max(distance)),
            1e-12,
            "round-off",
            "3.4",
        ),
    ]


def figure_3_5(axes: Sequence[Axes]) -> Drawn:
    """Draw three base planes with the class of each region."""
    planes = [base_plane(lam) for lam in _PLANES]
    titles = (r"$\lambda<\sqrt{3}$", r"$\lambda=\sqrt{3}$", r"$\lambda>\sqrt{3}$")
    for ax, plane, title in zip(axes, planes, titles, strict=True):
        plane.plot(ax)
        for text in ax.texts:
            text.set_fontsize(7.0)
        ax.grid(visible=False)
        for axis in (ax.xaxis, ax.yaxis):
            axis.label.set_fontsize(8.0)
        panel_title(ax, f"{title}: {plane.lam:.4g}")
        ax.set_title("")
    note = (
        "The three values are not legible; the picture changes its kind at lambda = sqrt(3), the "
        "plane of four equal links, so one value below it, that one, and one above it are drawn. "
        "Lines are change points, and where all three meet is the triple change point."
    )
    shares = Table(
        "Share of each class in the area of the plane",
        ("class", *(f"lambda = {plane.lam:.4g}" for plane in planes)),
        tuple(
            (symbol, *(f"{plane.shares.get(symbol, 0.0):.4f}" for plane in planes))
            for symbol in SYMBOLS[1:9]
        ),
    )
    return Drawn(tuple(_plane_rows(planes)), (note,), (shares,))


def _plane_rows(planes: Sequence[BasePlane]) -> list[Quoted]:
    sums = [sum(plane.shares.values()) for plane in planes]
    seen = {symbol for plane in planes for symbol in plane.regions}
    four_equal = int(classify(np.ones((1, 4)))[0])
    counted = [
        abs(np.mean(plane.numbers[plane.numbers > 0] == SYMBOLS.index(symbol)) - share)
        for plane in planes
        for symbol, share in plane.shares.items()
    ]
    return [
        Quoted(
            "mechanism classes of Table 3.1", 14.0, float(len(SYMBOLS) - 1), 0.0, "a count", "3.4"
        ),
        Quoted(
            "classes with a region of their own in these planes",
            8.0,
            float(len(seen)),
            0.0,
            "rows 1 to 8 of Table 3.1; change points are lines and points",
            "3.4",
        ),
        Quoted(
            "farthest sum of the regions' areas from the whole plane's",
            0.0,
            float(max(abs(value - 1.0) for value in sums)),
            1e-12,
            "each region is of one type, and together they are all",
            "3.4",
        ),
        Quoted(
            "regions' areas less the share of points classified so, worst",
            0.0,
            float(max(counted)),
            0.02,
            "201 points each way: two rows of points at a border of unit length",
            "3.4",
        ),
        Quoted(
            "row of Table 3.1 of the centre of the plane lambda = sqrt(3)",
            14.0,
            float(four_equal),
            0.0,
            "four equal lengths",
            "3.4",
        ),
    ]
