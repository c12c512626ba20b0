"""Aannaque's chapters 4 and 5: more elements, higher polynomials, exact frequencies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..beams import Section, Structure, frame
from ..core.families import Array
from ..frequencies import (
    dynamic_stiffness,
    element_matrices,
    log_determinant,
    wittrick_williams,
)
from .aannaque_models import FULL, ModelComparison, beams, compare_models
from .drawing import COLOURS, crank_axis, legend_below, panel_title
from .records import Drawn, Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ORDINALS = ("first", "second", "third", "fourth")


@lru_cache(maxsize=1)
def comparison() -> ModelComparison:
    """Return four frequencies of the five models at 120 crank angles."""
    models = {
        "1 element": beams(1, FULL),
        "2 elements": beams(2, FULL),
        "3 elements": beams(3, FULL),
        "p-version 1": beams(1, FULL, kind="internal_node_beams"),
        "p-version 2": beams(1, FULL, kind="curvature_beams"),
    }
    return compare_models(models, np.radians(np.arange(0.0, 360.0, 3.0)), 4, exact=False)


def elements(axes: Sequence[Axes], mode: int) -> Drawn:
    """Draw one natural frequency over the crank angle, five models (Fig. 4.6)."""
    ax, models = axes[0], comparison()
    turned = np.degrees(np.append(models.theta, 2.0 * np.pi))
    for place, (name, style) in enumerate(
        zip(models.names, ("-", "-", "-", "--", "-."), strict=True)
    ):
        curve = models.frequency[place, :, mode - 1]
        label = f"{name}, {models.size[place]} freedoms"
        ax.plot(turned, np.append(curve, curve[0]), style, color=COLOURS[place], label=label)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel(f"{_ORDINALS[mode - 1]} natural frequency [rad/s]")
    legend_below([ax], columns=3)
    mean = dict(zip(models.names, models.frequency.mean(axis=1)[:, mode - 1], strict=True))
    size = dict(zip(models.names, models.size.tolist(), strict=True))

    def gaps(name: str, reference: str) -> Array:
        """Frequencies of a model over those of another, less 1."""
        return models.difference(name, reference)[:, mode - 1]

    values: list[Value] = [
        float(np.max(gaps("3 elements", "2 elements"))),
        float(np.max(gaps("p-version 2", "1 element"))) + 1.0,
        mean["p-version 2"] / mean["p-version 1"],
        mean["p-version 2"] / mean["3 elements"] - 1.0,
    ]
    if mode in (1, 4):
        values.insert(0, 100.0 * float(np.mean(gaps("1 element", "3 elements"))))
    if mode > 1:
        return Drawn(values)
    rows = tuple(
        (name, str(size[name]), *(f"{value:.2f}" for value in frequencies.mean(axis=0)))
        for name, frequencies in zip(models.names, models.frequency, strict=True)
    )
    header = ("model", "freedoms", *(f"{nth} [rad/s]" for nth in _ORDINALS))
    table = Table("Mean natural frequencies over the cycle", header, rows)
    return Drawn([*values, size["3 elements"], size["p-version 2"]], tables=(table,))


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


def _portal(column: str = "1 element") -> Structure:
    """Return the frame of three equal bars with sqrt(EI/(rho A))/L^2 = 1 rad/s."""
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
    shares = (1.0 / pieces,) * pieces
    cut = dict.fromkeys(("left", "beam", "right"), shares) if pieces > 1 else None
    return dynamic_stiffness(_portal(), inextensible=True, pieces=cut)


@lru_cache(maxsize=2)
def _exact(pieces: int = 1) -> Array:
    """Return the first 21 frequencies [rad/s]."""
    return np.asarray(_FACTOR * wittrick_williams(_problem(pieces), count=21).frequencies)


@lru_cache(maxsize=8)
def _elements(column: str) -> Array:
    """Return all frequencies of a column's elements [rad/s]."""
    from scipy.linalg import eigh

    mass, stiffness, _ = element_matrices(_portal(column), inextensible=True)
    return np.asarray(_FACTOR * np.sqrt(eigh(stiffness, mass, eigvals_only=True)))


def figure_5_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the logarithm of the determinant of D over the frequency, bars whole and halved."""
    low, high = 20.0, 1200.0
    known = _exact()
    inside = known[known < high]
    near = [
        center + side * np.geomspace(1e-5, 20.0, 60) for center in inside for side in (-1.0, 1.0)
    ]
    omega = np.unique(np.concatenate([np.linspace(low, high, 1500), *near]))
    omega = omega[(omega > low) & (omega < high)]
    titles = ("one element for each bar", "two elements for each bar")
    for pieces, (ax, title) in enumerate(zip(axes, titles, strict=True), start=1):
        value = log_determinant(_problem(pieces), omega / _FACTOR)[0]
        for place, frequency in enumerate(inside, start=1):
            colour, width, label = ("0.7", 0.6, "natural frequency")
            if place in _WRONG:
                colour, width, label = (COLOURS[1], 0.9, "nodes at rest")
            ax.axvline(frequency, ls=(0, (3, 2)), color=colour, lw=width, label=label)
        ax.plot(omega, value, color=COLOURS[0], lw=1.0, label=r"$\log_{10}|\det D|$")
        panel_title(ax, title)
        ax.set_ylabel(r"$\log_{10}|\det D|$")
        ax.set_xlim(low, high)
    axes[1].set_xlabel("frequency [rad/s]")
    legend_below([axes[0]])
    orders = []
    for pieces in (1, 2):
        beside = known[3] / _FACTOR * (1.0 + np.array([1e-7, 1e-5]))
        close, far = log_determinant(_problem(pieces), beside)[0]
        orders.append(-float(close - far) / 2.0)
    return Drawn([*orders, np.max(np.abs(_exact(2) / known - 1.0))])


def table_5_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the relative errors of Table 5.1.b, recomputed, with the printed ones."""
    ax, exact = axes[0], _exact()
    for (column, printed), colour in zip(_ERRORS.items(), COLOURS, strict=False):
        errors = 100.0 * (_elements(column) / exact[: len(printed)] - 1.0)
        numbers = np.arange(1, len(errors) + 1)
        ax.semilogy(numbers, errors, "-", color=colour, lw=1.0, label=column)
        shown = np.array(printed) > 0.0
        ax.plot(numbers[shown], np.array(printed)[shown], "o", color=colour, ms=3.5)
    ax.plot([], [], "o", color="0.4", ms=3.5, label="printed")
    ax.axvline(4, color="0.6", lw=0.7, ls=(0, (1, 3)))
    ax.set_xticks(range(1, 22, 2))
    ax.set(xlabel="number of the frequency", ylabel="error of the frequency [%]")
    legend_below([ax], columns=3)
    rows = []
    for i in range(21):
        cells = [
            f"{_elements(column)[i]:.3f}" if i < len(values) else ""
            for column, values in _COLUMNS.items()
        ]
        rows.append((str(i + 1), f"{_EXACT[i]:.3f}", f"{exact[i]:.3f}", *cells))
    header = ("number", "exact, printed", "exact", *_COLUMNS)
    table = Table("Natural frequencies of the portal frame [rad/s]", header, tuple(rows))
    return Drawn([*_frequency_values(), *_error_values()], tables=(table,))


def _frequency_values() -> list[Value]:
    """Return the worst gaps to the printed frequencies over their last digit, and the wrong two."""

    def gaps(computed: Array, printed: Array) -> Array:
        # Three decimals are printed; the roots were sought to 2.5e-7 more.
        return np.asarray(np.abs(computed - printed) / (1e-3 + 2.5e-7 * printed))

    exact, wrong = _exact(), np.isin(np.arange(1, 22), _WRONG)
    values: list[Value] = [np.max(gaps(exact, np.array(_EXACT))[~wrong])]
    values += [exact[number - 1] for number in _WRONG]
    values += [np.max(gaps(_elements(name), np.array(col))) for name, col in _COLUMNS.items()]
    return values


def _error_values() -> list[Value]:
    """Return the worst gaps to the printed errors over their last digit, and the fourth errors."""
    values: list[Value] = []
    largest = 0.0
    for column, printed in _ERRORS.items():
        text = np.array(printed)
        errors = 100.0 * (_elements(column) / _exact()[: len(text)] - 1.0)
        limit = np.where(np.round(text, 2) == text, 1e-2, 2e-3)
        others = np.arange(len(text)) != 3
        values.append(np.max((np.abs(errors - text) / limit)[others]))
        if len(text) > 3:
            values.append(errors[3])
        if "element" in column:
            largest = max(largest, float(np.max(errors)))
    return [*values, largest]


@lru_cache(maxsize=1)
def _linkage() -> ModelComparison:
    """Return three elements and the exact frequencies of the four-bar at 48 angles."""
    angles = np.radians(np.arange(0.0, 360.0, 7.5))
    return compare_models({"3 elements": beams(3, FULL)}, angles, 4)


def exact_and_elements(axes: Sequence[Axes], mode: int) -> Drawn:
    """Draw one natural frequency, three elements and exact, and their gap (Fig. 5.3)."""
    models = _linkage()
    turned = np.degrees(np.append(models.theta, 2.0 * np.pi))
    styles = ((COLOURS[0], "-", "3 elements"), (COLOURS[1], "--", "dynamic stiffness"))
    for frequencies, (colour, style, label) in zip(models.frequency, styles, strict=True):
        values = frequencies[:, mode - 1]
        axes[0].plot(turned, np.append(values, values[0]), style, color=colour, label=label)
    gaps = 100.0 * models.difference("3 elements")
    gap = gaps[:, mode - 1]
    axes[1].plot(turned, np.append(gap, gap[0]), color=COLOURS[2], label="difference")
    axes[0].set_ylabel(f"{_ORDINALS[mode - 1]} natural\nfrequency [rad/s]")
    axes[1].set(ylabel="difference [%]", ylim=(0.0, 1.15 * float(np.max(gap))))
    for ax in axes:
        crank_axis(ax)
    axes[0].set_xlabel("")
    axes[1].set_xlabel("input angle $t_1$ [deg]")
    legend_below(axes)
    return Drawn([np.min(gap), np.max(gaps if mode == 4 else gap)])
