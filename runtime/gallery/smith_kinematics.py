"""Smith's Figs. 6, 7 and 27: motion of the follower, its harmonics, the coupler's end load."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..core.periodic_function import PeriodicFunction
from ..linkages import FourBar, FourBarMotion
from .records import Drawn, Quoted
from .smith_linkages import PROPORTIONS, Array, EndLoad, end_load, linkage_of
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CRANKS = (2.0, 4.0, 6.0, 8.0, 9.0, 9.9)
_LIMIT = (
    "The parallelogram, crank 10, is a change point at 0 and 180 deg and no crank-rocker: it is "
    "approached with crank 9.9. In the limit the open assembly follows the parallelogram for the "
    "first half turn only; for the second half the follower stands still on the frame, as a "
    "crank-rocker's follower cannot turn fully. The dashed line is the parallelogram itself."
)
_HALF_TURN = (
    "the limit of this family is the parallelogram for the first half turn alone; the follower of "
    "a crank-rocker has to come back"
)
# Distance from a limit (crank 0 or 10) at which it is read off; deviations are of its order.
_NEAR = 1e-7


def _follower(crank: float, theta: Array) -> FourBarMotion:
    return FourBar(frame=10.0, crank=crank, coupler=10.0, follower=10.0).motion(theta)


def _family(ax: Axes, value: Callable[[FourBarMotion], Array], label: str) -> None:
    """Draw one quantity of the follower for all cranks."""
    # Closer angles where the follower turns back within a few degrees.
    near = np.concatenate([np.linspace(0.0, 0.35, 701), np.linspace(0.35, 2 * pi - 0.35, 721)])
    theta = np.unique(np.concatenate([near, 2 * pi - near]))
    for crank, colour in zip(_CRANKS, COLOURS, strict=False):
        motion = _follower(crank, theta)
        ax.plot(np.degrees(theta), value(motion), color=colour, label=f"crank {crank:g}")
    crank_axis(ax)
    ax.set_ylabel(label)


def _limits(quantity: str, small: float, parallel: Callable[[Array], Array]) -> list[Quoted]:
    """Return the rows for the two ends of the range of crank lengths."""
    theta = np.radians(np.arange(10.0, 180.0, 10.0))
    back = theta + pi
    names = {"theta4": "output angle", "omega4": "output speed", "alpha4": "output acceleration"}
    scale = 180.0 / pi if quantity == "theta4" else 1.0
    unit = "deg" if quantity == "theta4" else ""
    name = names[quantity]

    def at(crank: float, angles: Array) -> Array:
        return scale * np.asarray(getattr(_follower(crank, angles), quantity))

    tiny = at(10.0 * _NEAR, np.concatenate([theta, back]))
    rows = [
        Quoted(
            f"{name} as the crank vanishes",
            small,
            float(tiny[np.argmax(np.abs(tiny - small))]),
            1e-4,
            "crank 1e-7 of the others",
            "2.5",
            unit=unit,
        )
    ]
    for angles, half, differs in ((theta, "first", ""), (back, "second", _HALF_TURN)):
        gap = np.abs(at(10.0 * (1.0 - _NEAR), angles) - scale * parallel(angles))
        rows.append(
            Quoted(
                f"{name} less the parallelogram's, {half} half turn",
                0.0,
                float(np.max(gap)),
                1e-3,
                "crank 1e-7 short of the others, 10 deg off the change points",
                "2.5",
                unit=unit,
                differs="" if quantity == "alpha4" else differs,
            )
        )
    return rows


def figure_6a(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's angle for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: np.degrees(motion.theta4), r"output angle $\theta_4$ [deg]")
    ax.plot([0, 360], [0, 360], "--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_yticks(range(0, 361, 60))
    legend_below([ax])
    return Drawn(tuple(_limits("theta4", 120.0, lambda theta: theta)), (_LIMIT,))


def figure_6b(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's speed for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: motion.omega4, r"output speed $\omega_4/\omega_2$")
    ax.axhline(1.0, ls="--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_ylim(-5.0, 1.5)
    legend_below([ax])
    deepest = _follower(9.9, np.zeros(1)).omega4[0]
    note = (
        f"The speed at 0 deg falls to {deepest:.0f} with crank 9.9, outside the picture: it is "
        "-crank/(frame - crank)."
    )
    return Drawn(tuple(_limits("omega4", 0.0, np.ones_like)), (_LIMIT, note))


def figure_6c(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's acceleration for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: motion.alpha4, r"output acceleration $\alpha_4/\omega_2^2$")
    ax.axhline(0.0, ls="--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_ylim(-8.0, 8.0)
    legend_below([ax])
    theta = np.linspace(0.0, 2 * pi, 36001)
    peaks = ", ".join(
        f"{np.max(np.abs(_follower(crank, theta).alpha4)):.3g} (crank {crank:g})"
        for crank in _CRANKS[3:]
    )
    note = (
        f"The caption prints l2 for the coupler's length, l3. Peaks outside the picture: {peaks}."
    )
    return Drawn(tuple(_limits("alpha4", 0.0, np.zeros_like)), (_LIMIT, note))


def figure_7(axes: Sequence[Axes]) -> Drawn:
    """Draw the harmonics of the follower's angle over the length of the crank."""
    cranks = np.linspace(0.25, 9.5, 38)
    series = [_harmonics(float(crank)) for crank in cranks]
    top = 8
    a = np.degrees([_padded(f.a, top) for f in series])
    b = np.degrees([_padded(f.b, top) for f in series])
    for ax, values, name in ((axes[0], a, "cosine $a_m$"), (axes[1], b, "sine $b_m$")):
        for m in range(1, 6):
            ax.plot(cranks, values[:, m], color=COLOURS[m - 1], label=f"m = {m}")
        ax.set_xlim(0.0, 10.0)
        ax.set_xlabel("crank length (other links 10)")
        ax.set_ylabel(f"{name} of $\\theta_4$ [deg]")
        ax.set_ylim(-60.0, 4.0)
    legend_below(axes[:1], columns=5)
    return Drawn(tuple(_harmonic_rows(a, b)), (_HARMONIC_NOTE,))


_HARMONIC_NOTE = (
    "The linkages are not stated; taken as the family of Fig. 6, frame = coupler = follower = 10, "
    "cranks from 0.25 to 9.5, m = 1 to 5."
)
_SWAPPED = (
    "the text's sine and cosine are interchanged: its statement holds for every crank and harmonic "
    "with the two words exchanged"
)


def _harmonics(crank: float) -> PeriodicFunction:
    return PeriodicFunction.from_callable(lambda theta: _follower(crank, theta).theta4)


def _padded(values: Array, top: int) -> Array:
    return np.pad(values, (0, max(0, top + 1 - len(values))))[: top + 1]


def _harmonic_rows(a: Array, b: Array) -> list[Quoted]:
    cosine, sine = (np.abs(values[:, 1:6]) for values in (a, b))
    total = np.hypot(cosine, sine)
    return [
        Quoted(
            "second harmonic over the first for the shortest crank",
            0.1,
            float(total[0, 1] / total[0, 0]),
            0.0,
            "'only the first is significant' read as a tenth",
            "2.6",
            relation="<",
        ),
        Quoted(
            "largest sine term above the first, over the largest first",
            0.25,
            float(np.max(sine[:, 1:]) / np.max(sine[:, 0])),
            0.0,
            "'only the first increases noticeably' read as a quarter",
            "2.6",
            relation="<",
            differs=_SWAPPED,
        ),
        Quoted(
            "the same of the cosine terms",
            0.25,
            float(np.max(cosine[:, 1:]) / np.max(cosine[:, 0])),
            0.0,
            "the statement with the words exchanged",
            "2.6",
            relation="<",
        ),
        Quoted(
            "least cosine term over the sine term of the same m",
            1.0,
            float(np.min(cosine / sine)),
            0.0,
            "'always greater'",
            "2.6",
            relation=">",
            differs=_SWAPPED,
        ),
        Quoted(
            "least sine term over the cosine term of the same m",
            1.0,
            float(np.min(sine / cosine)),
            0.0,
            "the statement with the words exchanged",
            "2.6",
            relation=">",
        ),
    ]


def end_load_figure(proportions: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws phi, f1, f2 and f3 of one linkage (Fig. 27)."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        theta = np.linspace(0.0, 2 * pi, 1441)
        parts = end_load(linkage_of(proportions), theta)
        ax = axes[0]
        for name, label, colour in (
            ("phi", r"$\varphi$", COLOURS[4]),
            ("f1", "$f_1$", COLOURS[1]),
            ("f2", "$f_2$", COLOURS[2]),
            ("f3", "$f_3$", COLOURS[0]),
        ):
            ax.plot(np.degrees(theta), getattr(parts, name), color=colour, label=label)
        crank_axis(ax)
        ax.set_ylabel("component of the end load")
        legend_below([ax])
        return Drawn(tuple(_END_LOAD_ROWS[proportions](proportions)))

    return draw


def _sizes(proportions: str) -> dict[str, float]:
    parts: EndLoad = end_load(linkage_of(proportions), np.linspace(0.0, 2 * pi, 2881))
    return {n: float(np.max(np.abs(getattr(parts, n)))) for n in ("phi", "f1", "f2", "f3")}


def _phi_row(proportions: str) -> Quoted:
    sizes = _sizes(proportions)
    return Quoted(
        "peak of phi over the largest of f1, f2, f3",
        1.0 / 3.0,
        sizes["phi"] / max(sizes["f1"], sizes["f2"], sizes["f3"]),
        0.0,
        "'comparatively small' read as a third",
        "6.2.2",
        relation="<",
    )


def _rows_2122(proportions: str) -> list[Quoted]:
    sizes = [_sizes(other) for other in PROPORTIONS]
    most = sum(size["f3"] == max(size.values()) for size in sizes)
    return [
        _phi_row(proportions),
        Quoted(
            "linkages of Fig. 27 in which f3 has the largest peak",
            len(PROPORTIONS) / 2,
            float(most),
            0.0,
            "'most often' read as more than half of the five",
            "6.2.2",
            relation=">",
        ),
    ]


def _rows_5152(proportions: str) -> list[Quoted]:
    linkage = linkage_of(proportions)
    eps2 = pi**2 * linkage.crank / (2 * linkage.coupler)
    return [
        _phi_row(proportions),
        Quoted(
            "eps1 of a uniform coupler",
            3.0,
            pi**2 / 3,
            0.3,
            "'approximate value': a tenth",
            "6.2.2",
        ),
        Quoted(
            "eps2 of a uniform coupler, (5,1,5,2)",
            1.0,
            eps2,
            0.0,
            "'all of which exceed unity'",
            "6.2.2",
            relation=">",
            differs="pi^2 l2/(2 l3) exceeds 1 only where the crank is longer than 0.2 of the "
            "coupler",
        ),
        Quoted(
            "eps3 over M4/M3, uniform links, l3 = l4",
            2.0,
            pi**2 / 3,
            0.2,
            "'approximate value': a tenth",
            "6.2.2",
            differs="pi^2/3 = 3.29, not 2",
        ),
    ]


def _rows_houben(proportions: str) -> list[Quoted]:
    sizes = _sizes(proportions)
    linkage = linkage_of(proportions)
    rows = [
        Quoted(
            f"peak of {name} over that of f3",
            0.05,
            sizes[name] / sizes["f3"],
            0.0,
            "'negligible' read as a twentieth",
            "6.2.2",
            relation="<",
        )
        for name in ("phi", "f1")
    ]
    return [
        *rows,
        Quoted(
            "peak of f2 over that of f3",
            1.0 / 3.0,
            sizes["f2"] / sizes["f3"],
            0.0,
            "'comparable' read as at least a third",
            "6.2.2",
            relation=">",
        ),
        Quoted(
            "eps2 of a uniform coupler, (54,0.4,54,3)",
            1.0,
            pi**2 * linkage.crank / (2 * linkage.coupler),
            0.0,
            "'all of which exceed unity'",
            "6.2.2",
            relation=">",
            differs="pi^2 l2/(2 l3) is 0.037 here, so that eps2 f2 is negligible after all; the "
            "text calls this figure 27(c), meaning 27(e)",
        ),
    ]


_END_LOAD_ROWS: dict[str, Callable[[str], list[Quoted]]] = {
    "(2,1,2,2)": _rows_2122,
    "(4,1,4,4)": lambda proportions: [_phi_row(proportions)],
    "(5,1,5,2)": _rows_5152,
    "(10,1,10,4)": lambda proportions: [_phi_row(proportions)],
    "(54,0.4,54,3)": _rows_houben,
}
