"""Aannaque's Figs. 5.1 and 5.3 and Table 5.1: exact frequencies against finite elements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.families import Array
from .aannaque_models import FULL, beams
from .records import Drawn, Quoted, Table
from .style import COLOURS, crank_axis, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..beams import Structure
    from .model_comparison import ModelComparison


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(map(float, text.split()))


# Table 5.1.a and, of the columns of elements, 5.1.b.
_EXACT = _numbers(
    "56.603 223.405 364.376 394.637 798.420 974.976 1128.133 1713.310 2021.214 2135.532 2984.904 "
    "3321.571 3572.354 4596.701 5067.413 5273.455 6565.820 7062.693 7409.042 8874.718 9506.991"
)
_COLUMNS: dict[str, tuple[float, ...]] = {
    "4 elements": _numbers(
        "56.603 223.500 364.717 395.709 802.477 982.323 1138.522 1748.834 2065.320 2181.153 "
        "3328.206 3777.526 4166.017 5381.377 6243.021 6824.710 8597.032 9864.527 11024.125 "
        "12746.505 13849.266"
    ),
    "3 elements": _numbers(
        "56.605 223.701 365.411 396.801 810.153 994.177 1148.601 1919.682 2343.157 2584.211 "
        "3670.536 4431.450 5172.888 6614.060 7635.244"
    ),
    "2 elements": _numbers(
        "56.612 224.831 368.517 401.590 908.950 1186.629 1490.239 2385.624 3195.329"
    ),
    "1 element": _numbers("56.706 267.346 577.263"),
    "p-version 1": _numbers(
        "56.603 223.529 365.388 396.538 806.043 994.282 1155.056 2724.169 3974.050"
    ),
}
_ERRORS: dict[str, tuple[float, ...]] = {
    "4 elements": _numbers(
        "0.001 0.042 0.093 0.271 0.508 0.753 0.920 2.070 2.180 2.130 11.500 13.720 16.610 17.070 "
        "23.199 29.416 30.936 39.670 48.792 43.627 45.674"
    ),
    "3 elements": _numbers(
        "0.003 0.132 0.284 0.548 1.469 1.969 1.814 12.045 15.928 21.010 22.969 33.414 44.803 "
        "43.887 50.673"
    ),
    "2 elements": _numbers("0.016 0.638 1.136 1.761 13.843 21.708 32.097 39.240 58.089"),
    "1 element": _numbers("0.182 19.668 58.425"),
    "p-version 1": _numbers("0.000 0.055 0.277 0.481 0.954 1.980 2.386 59.000 96.616"),
}
# Rows (from 1) whose exact value is wrong: both are of bars with clamped ends, q = 0 in (5.20).
_WRONG = (4, 10)
# sqrt(EI/(rho A))/L^2 [rad/s]: fits all printed frequencies but those two.
_FACTOR = 17.66323
_SPAN = (20.0, 1200.0)
_MODES = ("first", "second", "third", "fourth")


def _portal(column: str = "1 element") -> Structure:
    """Return the frame of three equal bars with sqrt(EI/(rho A))/L^2 = 1 rad/s."""
    from ..beams import Section, frame

    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    held = ("x", "y", "rotation")
    return frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        bar,
        supports={"A": held, "D": held},
        elements=int(column[0]) if column[0].isdigit() else 1,
        kind="cubic" if column[0].isdigit() else "internal_node",
    )


def _problem(pieces: int = 1) -> Any:
    from ..frequencies import dynamic_stiffness

    shares = (1.0 / pieces,) * pieces
    cut = dict.fromkeys(("left", "beam", "right"), shares) if pieces > 1 else None
    return dynamic_stiffness(_portal(), inextensible=True, pieces=cut)


@lru_cache(maxsize=2)
def _exact(pieces: int = 1) -> Array:
    """Return the first 21 frequencies [rad/s]."""
    from ..frequencies import wittrick_williams

    return np.asarray(_FACTOR * wittrick_williams(_problem(pieces), count=21).frequencies)


@lru_cache(maxsize=8)
def _elements(column: str) -> Array:
    """Return all frequencies of a column's elements [rad/s]."""
    from scipy.linalg import eigh

    from ..frequencies import element_matrices

    mass, stiffness, _ = element_matrices(_portal(column), inextensible=True)
    return np.asarray(_FACTOR * np.sqrt(eigh(stiffness, mass, eigvals_only=True)))


def figure_5_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the logarithm of the determinant of D over the frequency, bars whole and halved."""
    from ..frequencies import log_determinant

    known = _exact()
    inside = known[known < _SPAN[1]]
    near = [
        center + side * np.geomspace(1e-5, 20.0, 60) for center in inside for side in (-1.0, 1.0)
    ]
    omega = np.unique(np.concatenate([np.linspace(*_SPAN, 1500), *near]))
    omega = omega[(omega > _SPAN[0]) & (omega < _SPAN[1])]
    for ax, pieces in zip(axes, (1, 2), strict=True):
        value = log_determinant(_problem(pieces), omega / _FACTOR)[0]
        for place, frequency in enumerate(inside, start=1):
            hidden = place in _WRONG
            line: dict[str, Any] = {
                "color": COLOURS[1] if hidden else "0.7",
                "lw": 0.9 if hidden else 0.6,
            }
            label = "nodes at rest" if hidden else "natural frequency"
            ax.axvline(frequency, ls=(0, (3, 2)), **line, label=label)
        name = "one element for each bar" if pieces == 1 else "two elements for each bar"
        ax.plot(omega, value, color=COLOURS[0], lw=1.0, label=r"$\log_{10}|\det D|$")
        panel_title(ax, name)
        ax.set_ylabel(r"$\log_{10}|\det D|$")
        ax.set_xlim(*_SPAN)
    axes[1].set_xlabel("frequency [rad/s]")
    legend_below([axes[0]])
    note = (
        "D of bars with EI = L = 1. The frame's data are not legible: bars that do not stretch and "
        "one factor of the frequencies, found from Table 5.1."
    )
    return Drawn(tuple(_determinant_rows()), (note,))


def _determinant_rows() -> list[Quoted]:
    from ..frequencies import log_determinant

    fourth = _exact()[3] / _FACTOR
    slopes = []
    for pieces in (1, 2):
        close, far = log_determinant(_problem(pieces), fourth * (1.0 + np.array([1e-7, 1e-5])))[0]
        slopes.append(float(close - far) / 2.0)
    return [
        Quoted(
            "order of det D at the fourth frequency, one element for each bar",
            0.0,
            -slopes[0],
            0.0,
            "'a pole': a negative order; -2, as all three bars swing by themselves there",
            "5.4.1",
            relation="<",
        ),
        Quoted(
            "the same, two elements for each bar",
            1.0,
            -slopes[1],
            1e-2,
            "'an ordinary natural frequency': a simple zero",
            "5.4.1",
        ),
        Quoted(
            "largest relative change of 21 frequencies by halving the bars",
            0.0,
            float(np.max(np.abs(_exact(2) / _exact() - 1.0))),
            1e-11,
            "'do not change': round-off",
            "5.4.1",
        ),
    ]


def figure_table_5_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the relative errors of Table 5.1.b, recomputed, with the printed ones."""
    ax, exact = axes[0], _exact()
    for place, (column, printed) in enumerate(_ERRORS.items()):
        ours = 100.0 * (_elements(column) / exact[: len(printed)] - 1.0)
        numbers = np.arange(1, len(ours) + 1)
        ax.semilogy(numbers, ours, "-", color=COLOURS[place], lw=1.0, label=column)
        shown = np.array(printed) > 0.0
        ax.plot(numbers[shown], np.array(printed)[shown], "o", color=COLOURS[place], ms=3.5)
    ax.plot([], [], "o", color="0.4", ms=3.5, label="printed")
    ax.axvline(4, color="0.6", lw=0.7, ls=(0, (1, 3)))
    ax.set_xticks(range(1, 22, 2))
    ax.set_xlabel("number of the frequency")
    ax.set_ylabel("error of the frequency [%]")
    legend_below([ax], columns=3)
    note = (
        "Lines: recomputed; points: printed. At the fourth frequency all printed errors are off, "
        "because their base is: the search for roots of det D stopped beside the pole. One factor "
        "between the computed frequencies and the printed ones fits all others to the last digit."
    )
    rows = (*_exact_rows(), *_element_rows(), *_error_rows())
    return Drawn(rows, (note,), (_table(),))


def _digit(values: Array) -> Array:
    """Return what three printed decimals may be off by; the roots were sought to 2.5e-7 more."""
    return np.asarray(1e-3 + 2.5e-7 * values)


def _exact_rows() -> list[Quoted]:
    ours, printed = _exact(), np.array(_EXACT)
    wrong = np.isin(np.arange(1, 22), _WRONG)
    gap = np.abs(ours - printed) / _digit(printed)
    rows = [
        Quoted(
            "19 exact frequencies, worst deviation over the last digit",
            0.0,
            float(np.max(gap[~wrong])),
            1.0,
            "1e-3 and 2.5e-7 of the value, the step of the search",
            "Table 5.1.a",
        )
    ]
    for number, root in zip(_WRONG, (4.730040744862704, 10.995607838001671), strict=True):
        rows.append(
            Quoted(
                f"exact frequency {number}",
                _EXACT[number - 1],
                float(ours[number - 1]),
                float(_digit(printed[number - 1])),
                f"root z = {root:.5f} of cos z cosh z = 1: a bar with clamped ends",
                "Table 5.1.a",
                unit="rad/s",
                differs="the frame's nodes are at rest, det D has a pole there, and the search "
                "for its sign did not converge to it",
            )
        )
    return rows


def _element_rows() -> list[Quoted]:
    rows = []
    for column, values in _COLUMNS.items():
        ours, printed = _elements(column), np.array(values)
        rows.append(
            Quoted(
                f"{len(printed)} frequencies of {column}, worst deviation over the last digit",
                0.0,
                float(np.max(np.abs(ours - printed) / _digit(printed))),
                1.0,
                "1e-3 and 2.5e-7 of the value",
                "Table 5.1.a",
            )
        )
    return rows


def _error_rows() -> list[Quoted]:
    rows, largest = [], 0.0
    for column, values in _ERRORS.items():
        printed = np.array(values)
        ours = 100.0 * (_elements(column) / _exact()[: len(printed)] - 1.0)
        coarse = np.round(printed, 2) == printed
        limit = np.where(coarse, 1e-2, 2e-3)
        others = np.arange(len(printed)) != 3
        rows.append(
            Quoted(
                f"errors of {column} but the fourth, worst deviation over the last digit",
                0.0,
                float(np.max((np.abs(ours - printed) / limit)[others])),
                1.0,
                "some are printed to two decimals, the others to three",
                "Table 5.1.b",
            )
        )
        largest = max(largest, float(np.max(ours)) if "element" in column else 0.0)
        if len(printed) > 3:
            rows.append(
                Quoted(
                    f"error of the fourth frequency, {column}",
                    float(printed[3]),
                    float(ours[3]),
                    2e-3,
                    "last digit",
                    "Table 5.1.b",
                    unit="%",
                    differs="its base, 394.637, is wrong",
                )
            )
    rows.append(
        Quoted(
            "largest error of cubic elements",
            50.0,
            largest,
            0.5,
            "'relative error of up to 50 %'",
            "5.4.1",
            unit="%",
            differs="the table itself has 58.4 % with one element and 58.1 % with two",
        )
    )
    return rows


def _table() -> Table:
    exact = _exact()
    rows = []
    for i in range(21):
        cells = [str(i + 1), f"{_EXACT[i]:.3f}", f"{exact[i]:.3f}"]
        cells += [
            f"{_elements(column)[i]:.3f}" if i < len(values) else ""
            for column, values in _COLUMNS.items()
        ]
        rows.append(tuple(cells))
    header = ("number", "exact, printed", "exact", *_COLUMNS)
    return Table("Natural frequencies of the portal frame [rad/s]", header, tuple(rows))


@lru_cache(maxsize=1)
def _linkage() -> ModelComparison:
    """Return three elements and the exact frequencies of the four-bar at 48 angles."""
    from .model_comparison import compare_models

    angles = np.radians(np.arange(0.0, 360.0, 7.5))
    return compare_models({"3 elements": beams(3, FULL)}, angles, 4)


def frequency_figure(mode: int) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the drawing of one natural frequency, three elements and exact, and their gap."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        found = _linkage()
        turned = np.degrees(np.append(found.theta, 2.0 * np.pi))
        styles = ((COLOURS[0], "-", "3 elements"), (COLOURS[1], "--", "dynamic stiffness"))
        for values, (colour, style, label) in zip(found.frequency, styles, strict=True):
            own = values[:, mode - 1]
            axes[0].plot(turned, np.append(own, own[0]), style, color=colour, label=label)
        gap = 100.0 * found.difference("3 elements")[:, mode - 1]
        axes[1].plot(turned, np.append(gap, gap[0]), color=COLOURS[2], label="difference")
        axes[0].set_ylabel(f"{_MODES[mode - 1]} natural\nfrequency [rad/s]")
        axes[1].set_ylabel("difference [%]")
        axes[1].set_ylim(0.0, 1.15 * float(np.max(gap)))
        for ax in axes:
            crank_axis(ax)
        axes[0].set_xlabel("")
        axes[1].set_xlabel("input angle $t_1$ [deg]")
        legend_below(axes)
        note = "The crank held; the follower's end turns freely, joint masses at both moving pins."
        return Drawn(_linkage_rows(mode, float(np.max(gap))), (note,))

    return draw


def _linkage_rows(mode: int, largest: float) -> tuple[Quoted, ...]:
    lower = float(np.min(_linkage().difference("3 elements")[:, mode - 1]))
    rows = [
        Quoted(
            f"least difference of three elements to exact, {_MODES[mode - 1]} frequency",
            0.0,
            100.0 * lower,
            0.0,
            "elements are too stiff: from above",
            "5.4.2",
            relation=">",
            unit="%",
        )
    ]
    if mode < 4:
        rows.append(
            Quoted(
                f"largest difference of three elements, {_MODES[mode - 1]} frequency",
                1.18,
                largest,
                0.0,
                "'adequate up to the fourth mode with a maximum relative error of 1.18 %'",
                "5.4.2",
                relation="<",
                unit="%",
            )
        )
        return tuple(rows)
    rows.append(
        Quoted(
            "largest difference of three elements up to the fourth frequency",
            1.18,
            100.0 * float(np.max(_linkage().difference("3 elements"))),
            0.005,
            "half of the last digit; 48 angles",
            "5.4.2",
            unit="%",
        )
    )
    return tuple(rows)
