"""Aannaque's Fig. 6.6 and Tables 6.1 to 6.3: operations of the algorithms, printed and counted."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..periodic import cycles_to_settle
from .aannaque_steady_state import march
from .operation_counts import TABLE_6_2, TABLE_6_3, operation_count, printed_count
from .records import Drawn, Quoted, Table
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_NAMES = {
    "time_marching": "time marching",
    "transition_matrix": "algorithm 1",
    "closed_form": "algorithm 2",
}
_FREEDOMS = 9
_RATIOS = (0.02, 0.06)


def _cycles(ratio: float) -> int:
    """Return the cycles to a change of 1e-4 over the peak at 62 rad/s."""
    values = march(ratio=ratio)[1]
    return int(cycles_to_settle(values[np.argmax(np.abs(values))], 1e-4))


def figure_6_6(axes: Sequence[Axes]) -> Drawn:
    """Draw the operations over the intervals: algorithms 1 and 2, and marching at two dampings."""
    intervals = np.array([90, 180, 360, 540, 720])
    lines = [
        ("transition_matrix", 1, "algorithm 1", COLOURS[0]),
        ("closed_form", 1, "algorithm 2", COLOURS[1]),
    ]
    for ratio, colour in zip(_RATIOS, COLOURS[2:], strict=False):
        label = rf"time marching, $\zeta$ = {ratio:g}, {_cycles(ratio)} cycles"
        lines.append(("time_marching", _cycles(ratio), label, colour))
    for ax, storage in zip(axes, (True, False), strict=True):
        for name, cycles, label, colour in lines:
            printed, counted = (
                [1e-6 * _operations(kind, name, int(n), cycles, storage) for n in intervals]
                for kind in ("printed", "counted")
            )
            ax.plot(intervals, printed, "o-", ms=3, color=colour, label=label)
            ax.plot(intervals, counted, "--", lw=0.9, color=colour)
        ax.plot([], [], "--", lw=0.9, color="0.4", label="counted here")
        ax.set_xlabel("intervals")
        panel_title(ax, "matrices stored" if storage else "no storage")
        ax.set_ylim(bottom=0.0)
    axes[0].set_ylabel("operations [million]")
    legend_below([axes[0]], columns=3)
    note = (
        "Points: the formulas of Table 6.1 with 9 freedoms; dashed: counted from the steps of the "
        "algorithms here. The second damping ratio is not legible: 6 %. Cycles of marching by a "
        "change of 1e-4 at 62 rad/s."
    )
    return Drawn(tuple(_algorithm_rows()), (note,))


def _operations(kind: str, name: str, intervals: int, cycles: int, storage: bool) -> float:
    more: dict[str, Any] = {"intervals": intervals, "freedoms": _FREEDOMS, "cycles": cycles}
    if kind == "printed":
        return float(printed_count(name, storage=storage, **more))
    return float(operation_count(name, storage=storage, **more).operations)


def _algorithm_rows() -> list[Quoted]:
    rows = []
    for kind in ("printed", "counted"):
        words = "the printed formulas" if kind == "printed" else "the count"
        rows.append(
            Quoted(
                f"operations of algorithm 1 over those of algorithm 2, largest, by {words}",
                1.0,
                _largest_ratio(kind),
                0.0,
                "'always computationally more efficient'; 1 to 100 freedoms",
                "6.8",
                relation="<",
            )
        )
    doubled = _operations("counted", "transition_matrix", 1440, 1, True)
    rows.append(
        Quoted(
            "operations with twice 720 intervals over those with 720, algorithm 1",
            2.0,
            doubled / _operations("counted", "transition_matrix", 720, 1, True),
            0.01,
            "'linear with respect to the number of intervals', but for the one solution",
            "6.8",
        )
    )
    rows.append(
        Quoted(
            "cycles from which marching with storage costs more than algorithm 1, n = 10",
            5.0,
            _break_even(10),
            0.0,
            "Table 6.2: less with 5 cycles, more with 100",
            "6.8",
            relation=">",
        )
    )
    rows.append(
        Quoted(
            "that number with 50 freedoms over that with 10",
            1.0,
            _break_even(50) / _break_even(10),
            0.0,
            "'this drops if n decreases'",
            "6.8",
            relation=">",
        )
    )
    return rows


def _largest_ratio(kind: str) -> float:
    """Return the most operations of algorithm 1 over those of algorithm 2."""
    ratios = []
    for n in (1, 2, 9, 27, 100):
        for big in (90, 720):
            more: dict[str, Any] = {"intervals": big, "freedoms": n}
            one, two = (
                printed_count(name, **more)
                if kind == "printed"
                else operation_count(name, **more).operations
                for name in ("transition_matrix", "closed_form")
            )
            ratios.append(one / two)
    return max(ratios)


def _break_even(freedoms: int) -> float:
    more: dict[str, Any] = {"intervals": 720, "freedoms": freedoms}
    wanted = printed_count("transition_matrix", **more)
    cycles = 1
    while printed_count("time_marching", cycles=cycles, **more) < wanted:
        cycles += 1
    return float(cycles)


def figure_table_6_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the counted operations over those of the printed formulas."""
    freedoms = np.unique(np.round(np.geomspace(3, 300, 25)).astype(int))
    rows = []
    for ax, storage in zip(axes, (True, False), strict=True):
        for (name, label), colour in zip(_NAMES.items(), COLOURS, strict=False):
            ratio = [_ratio(name, int(n), storage) for n in freedoms]
            ax.semilogx(freedoms, ratio, color=colour, label=label)
            words = "stored" if storage else "no storage"
            rows.append((label, words, *(f"{_ratio(name, n, storage):.3f}" for n in (9, 27, 300))))
        ax.axhline(1.0, color="0.5", lw=0.8)
        ax.set_xlabel("freedoms $n$")
        panel_title(ax, "matrices stored" if storage else "no storage")
    axes[0].set_ylabel("counted over printed operations")
    legend_below([axes[0]])
    note = (
        "720 intervals, 5 cycles of marching. The printed cost of a marched cycle, 4 n^2 for each "
        "interval, is half of a product with a matrix of order 2n."
    )
    table = Table(
        "Counted over printed operations",
        ("algorithm", "matrices", "n = 9", "n = 27", "n = 300"),
        tuple(rows),
    )
    return Drawn(tuple(_leading_rows()), (note,), (table,))


def _ratio(name: str, freedoms: int, storage: bool = True) -> float:
    more: dict[str, Any] = {"intervals": 720, "freedoms": freedoms, "cycles": 5, "storage": storage}
    return operation_count(name, **more).operations / printed_count(name, **more)


def _leading_rows() -> list[Quoted]:
    reasons = {
        "time_marching": "fewer solutions with each mass matrix: 52/3 n^3 in place of 22 n^3",
        "transition_matrix": "100/3 n^3 in place of 38 n^3",
        "closed_form": "164/3 n^3 in place of 62 n^3",
    }
    return [
        Quoted(
            f"counted over printed operations, {label}, many freedoms",
            1.0,
            _ratio(name, 300),
            0.05,
            "5 %",
            "Table 6.1",
            differs=reasons[name],
        )
        for name, label in _NAMES.items()
    ]


def figure_table_6_2(axes: Sequence[Axes]) -> Drawn:
    """Draw the entries of Table 6.2 and those of the printed formulas."""
    ax = axes[0]
    places = np.arange(len(TABLE_6_2))
    computed = np.array([_row_6_2(*key) for key in TABLE_6_2])
    printed = np.array(list(TABLE_6_2.values()), dtype=float)
    for column, colour in zip(range(6), COLOURS, strict=False):
        name = list(_NAMES.values())[column % 3]
        label = f"{name}, {'stored' if column < 3 else 'no storage'}"
        shift = places + 0.12 * (column - 2.5)
        ax.semilogy(shift, computed[:, column], "_", color=colour, ms=9, mew=2, label=label)
        ax.semilogy(shift, printed[:, column], "o", color=colour, ms=3)
    names = [f"N {big}\nn {n}\n$n_c$ {cycles}" for big, n, cycles in TABLE_6_2]
    ax.set_xticks(places, names)
    ax.set_ylabel("operations [million]")
    legend_below([ax], columns=3)
    gap = float(np.max(np.abs(printed / computed - 1.0)))
    row = Quoted(
        "48 entries, largest relative deviation from the formulas of Table 6.1",
        0.0,
        gap,
        5.0e-3,
        "three digits: half a unit of 100",
        "Table 6.2",
    )
    note = "Bars: the formulas of Table 6.1; points: the printed entries."
    return Drawn((row,), (note,))


def _row_6_2(big: int, n: int, cycles: int) -> list[float]:
    more: dict[str, Any] = {"intervals": big, "freedoms": n, "cycles": cycles}
    return [
        1e-6 * printed_count(name, storage=storage, **more)
        for storage in (True, False)
        for name in _NAMES
    ]


def figure_table_6_3(axes: Sequence[Axes]) -> Drawn:
    """Draw the operations of the Fourier series and of algorithm 1 over the harmonics."""
    harmonics = np.arange(1, 31)
    for ax, n in zip(axes, (10, 50), strict=True):
        for big, colour in ((90, COLOURS[0]), (720, COLOURS[1])):
            more: dict[str, Any] = {"intervals": big, "freedoms": n}
            series = [_series(int(h), **more) for h in harmonics]
            ax.semilogy(harmonics, series, color=colour, label=f"Fourier series, N = {big}")
            one = 1e-6 * printed_count("transition_matrix", **more)
            ax.axhline(one, color=colour, ls="--", lw=0.9, label=f"algorithm 1, N = {big}")
            points = [(h, v[0]) for (b, h, k), v in TABLE_6_3.items() if (b, k) == (big, n)]
            ax.plot(*np.transpose(points), "o", color=colour, ms=4)
        ax.set_xlabel("harmonics")
        panel_title(ax, f"{n} freedoms")
    axes[0].set_ylabel("operations [million]")
    axes[1].plot([], [], "o", color="0.4", ms=4, label="printed, Fourier series")
    legend_below([axes[1]], columns=3)
    note = "Lines: the printed formulas; points: the entries of Table 6.3."
    return Drawn(tuple(_fourier_rows()), (note,))


def _series(harmonics: int, *, intervals: int, freedoms: int) -> float:
    more: dict[str, Any] = {"intervals": intervals, "freedoms": freedoms, "harmonics": harmonics}
    return 1e-6 * printed_count("harmonic_balance", **more)


def _fourier_rows() -> list[Quoted]:
    rows = []
    for (big, harmonics, n), (entry, first) in TABLE_6_3.items():
        value = _series(harmonics, intervals=big, freedoms=n)
        # Three digits are printed; of 1200 two are meant.
        tolerance = 0.5 * 10.0 ** (np.floor(np.log10(entry)) - (1 if entry == 1200 else 2))
        wrong = abs(value - entry) > tolerance
        rows.append(
            Quoted(
                f"Fourier series, N = {big}, N_h = {harmonics}, n = {n}",
                entry,
                value,
                float(tolerance),
                "half of the last digit",
                "Table 6.3",
                unit="million",
                differs="not what the printed formula gives" if wrong else "",
            )
        )
        one = 1e-6 * printed_count("transition_matrix", intervals=big, freedoms=n)
        rows.append(
            Quoted(
                f"algorithm 1, N = {big}, N_h = {harmonics}, n = {n}",
                first,
                one,
                float(0.5 * 10.0 ** (np.floor(np.log10(first)) - 2)),
                "half of the last digit",
                "Table 6.3",
                unit="million",
            )
        )
    return rows
