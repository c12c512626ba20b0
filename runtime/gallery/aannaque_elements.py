"""Aannaque's Figs. 4.6.a to 4.6.d: more elements against higher polynomials."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from .aannaque_models import FULL, beams
from .records import Drawn, Quoted, Table
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .model_comparison import ModelComparison

ONE, TWO, THREE = "1 element", "2 elements", "3 elements"
INTERNAL, CURVATURE = "p-version 1", "p-version 2"
_ORDINALS = ("first", "second", "third", "fourth")
_STYLES = ("-", "-", "-", "--", "-.")


@lru_cache(maxsize=1)
def comparison() -> ModelComparison:
    """Return four frequencies of the five models at 120 crank angles."""
    from .model_comparison import compare_models

    models = {name: beams(count, FULL) for count, name in enumerate((ONE, TWO, THREE), start=1)}
    models[INTERNAL] = beams(1, FULL, kind="internal_node_beams")
    models[CURVATURE] = beams(1, FULL, kind="curvature_beams")
    return compare_models(models, np.radians(np.arange(0.0, 360.0, 3.0)), 4, exact=False)


def frequency_figure(mode: int) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the drawing of one natural frequency over the crank angle, five models."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax, found = axes[0], comparison()
        turned = np.degrees(np.append(found.theta, 2.0 * np.pi))
        for place, name in enumerate(found.names):
            values = found.frequency[place, :, mode - 1]
            label = f"{name}, {found.size[place]} freedoms"
            line: dict[str, Any] = {"ls": _STYLES[place], "color": COLOURS[place], "label": label}
            ax.plot(turned, np.append(values, values[0]), **line)
        crank_axis(ax)
        ax.set_xlabel("input angle $t_1$ [deg]")
        ax.set_ylabel(f"{_ORDINALS[mode - 1]} natural frequency [rad/s]")
        legend_below([ax], columns=3)
        note = (
            "The crank held. p-version 1: an inner node; p-version 2: curvatures at the ends, zero "
            "at all pins. Joint masses at both moving pins."
        )
        return Drawn(_rows(mode), (note,), (_table(),) if mode == 1 else ())

    return draw


def _mean(name: str, mode: int) -> float:
    found = comparison()
    return float(np.mean(found.frequency[found.names.index(name), :, mode - 1]))


def _ratio(name: str, reference: str, mode: int) -> float:
    """Return the largest ratio of a model's frequency to another's over the cycle."""
    return float(np.max(comparison().difference(name, reference)[:, mode - 1])) + 1.0


def _rows(mode: int) -> tuple[Quoted, ...]:
    rows = [_one_element(mode)] if mode in (1, 4) else []
    nth = _ORDINALS[mode - 1]
    rows += [
        Quoted(
            f"{nth} frequency of three elements over that of two, largest, less 1",
            0.0,
            _ratio(THREE, TWO, mode) - 1.0,
            0.0,
            "frequencies fall with the number of elements, none rises",
            "4.3",
            relation="<",
        ),
        Quoted(
            f"{nth} frequency of p-version 2 over that of one cubic element, largest",
            1.0,
            _ratio(CURVATURE, ONE, mode),
            0.0,
            "'in all cases the p-version 2 gives better results': from above, lower is better",
            "4.3",
            relation="<",
        ),
        Quoted(
            f"mean {nth} frequency of p-version 2 over that of p-version 1",
            1.0,
            _mean(CURVATURE, mode) / _mean(INTERNAL, mode),
            0.0,
            "'in all cases': read as better than p-version 1, too",
            "4.3",
            relation="<",
            differs="p-version 1 has 15 freedoms and is lower, that is nearer, in all four; with "
            "its 10 p-version 2 still beats two cubic elements of 18",
        ),
        Quoted(
            f"mean {nth} frequency of p-version 2 over that of three elements, less 1",
            0.0,
            _mean(CURVATURE, mode) / _mean(THREE, mode) - 1.0,
            0.005,
            "'almost the same result', read as half a per cent",
            "4.3",
        ),
    ]
    return (*rows, *_freedoms()) if mode == 1 else tuple(rows)


def _one_element(mode: int) -> Quoted:
    found = comparison()
    mean = 100.0 * float(np.mean(found.difference(ONE, THREE)[:, mode - 1]))
    return Quoted(
        f"mean difference of the {_ORDINALS[mode - 1]} frequency, one element to three",
        10.0 if mode == 1 else 26.0,
        mean,
        0.5,
        "half of the last digit",
        "4.3",
        unit="%",
    )


def _freedoms() -> list[Quoted]:
    size = dict(zip(comparison().names, comparison().size.tolist(), strict=True))
    return [
        Quoted(f"freedoms, {name}", printed, float(size[name]), 0.0, "a count", "4.3")
        for name, printed in ((THREE, 27.0), (CURVATURE, 10.0))
    ]


def _table() -> Table:
    found = comparison()
    rows = []
    for place, name in enumerate(found.names):
        means = found.frequency[place].mean(axis=0)
        rows.append((name, str(found.size[place]), *(f"{value:.2f}" for value in means)))
    header = ("model", "freedoms", *(f"{nth} [rad/s]" for nth in _ORDINALS))
    return Table("Mean natural frequencies over the cycle", header, tuple(rows))
