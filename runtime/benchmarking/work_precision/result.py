"""What a work-precision benchmark returns: points, the fastest at each level, table and plot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...core.results import Result
from ..records import padded
from .method import Point, fastest

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEVELS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
# The loosest level at which a single trajectory may be lost to a peer, with its reason.
_ALLOWED = 1e-11


@dataclass(frozen=True)
class Lead:
    """The best of ours and of the peers on one problem at one level of error.

    Attributes
    ----------
    problem : str
        Its name.
    level : float
        Largest error allowed.
    ours, peer : Point or None
        The fastest within the level; None where none gets there.
    """

    problem: str
    level: float
    ours: Point | None
    peer: Point | None

    @property
    def ratio(self) -> float:
        """How many times ours the peer takes: infinite where no peer gets there, 0 where not we."""
        if self.ours is None:
            return 0.0 if self.peer is not None else float("nan")
        if self.peer is None:
            return float("inf")
        return self.peer.milliseconds / self.ours.milliseconds

    @property
    def lost(self) -> bool:
        """True where a peer is ahead."""
        return self.ratio < 1.0

    @property
    def excused(self) -> bool:
        """True of a single trajectory below 1e-11."""
        return self.problem.endswith("trajectory") and self.level < _ALLOWED


@dataclass(frozen=True, kw_only=True)
class WorkPrecision(Result):
    """Run time against error of every contender on every problem.

    Attributes
    ----------
    points : tuple of Point
        Every method at every setting.
    titles : mapping of str to str
        What each problem is.
    absent : tuple of str
        Peers left out, each with its reason.
    """

    points: tuple[Point, ...]
    titles: Mapping[str, str]
    absent: tuple[str, ...]

    @property
    def leads(self) -> tuple[Lead, ...]:
        """The best of ours and of the peers on each problem at each level."""
        return leads(self.points, self.titles)

    @property
    def losses(self) -> tuple[Lead, ...]:
        """Where a peer is ahead, unexcused."""
        return tuple(lead for lead in self.leads if lead.lost and not lead.excused)

    def of(self, problem: str) -> tuple[Point, ...]:
        """Return the points of one problem."""
        return tuple(p for p in self.points if p.problem == problem)

    def table(self) -> str:
        """Return the table as text: a line for each problem and level, then the losses."""
        head = ("problem", "error", "ours", "ms", "best peer", "ms", "peer over ours")
        rows = [_row(lead) for lead in self.leads]
        text = padded(head, rows)
        text += [f"{name}: {title}" for name, title in self.titles.items()]
        text += [f"left out: {reason}" for reason in self.absent]
        return "\n".join(text)

    def full_table(self) -> str:
        """Return every point as text."""
        head = ("problem", "method", "setting", "ms", "error", "s beforehand")
        rows = [
            (
                p.problem,
                p.method,
                f"{p.setting:g}",
                f"{p.milliseconds:.4g}",
                f"{p.error:.1e}",
                f"{p.preparation:.2g}",
            )
            for p in self.points
        ]
        return "\n".join(padded(head, rows))

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        out = super().to_dict()
        out["points"] = [vars(p) for p in self.points]
        out["ratios"] = ratios(self.leads)
        return out

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw time over error, a line for each method; several problems side by side.

        Given axes take the first problem alone.
        """
        from ...core.plotting import axes_or_new

        if ax is None and len(self.titles) > 1:
            from matplotlib.figure import Figure

            return self.draw_on(Figure(layout="constrained"))
        ax = axes_or_new(ax)
        self._draw(ax, next(iter(self.titles)))
        return ax

    def draw_on(self, figure: Figure) -> Axes:
        """Draw all problems side by side on an empty figure; return the first axes."""
        names = tuple(self.titles)
        columns = min(3, len(names))
        rows = -(-len(names) // columns)
        figure.set_size_inches(6.4 * columns, 4.0 * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        for place, name in zip(grid.flat, names, strict=False):
            self._draw(place, name)
        for place in grid.flat[len(names) :]:
            place.set_axis_off()
        first: Axes = grid[0, 0]
        return first

    def _draw(self, ax: Axes, problem: str) -> None:
        own = self.of(problem)
        for method in dict.fromkeys(p.method for p in own):
            line = sorted((p.error, p.milliseconds) for p in own if p.method == method)
            ours = next(p.ours for p in own if p.method == method)
            style = {"marker": "o" if ours else "s", "linestyle": "-" if ours else "--"}
            ax.loglog(*zip(*line, strict=True), label=method, markersize=3, linewidth=0.9, **style)
        ax.invert_xaxis()
        ax.set_title(problem, fontsize=9)
        ax.set_xlabel("error")
        ax.set_ylabel("time [ms]")
        # Beside the lines, of which there are many.
        ax.legend(fontsize=5, loc="center left", bbox_to_anchor=(1.0, 0.5))


def leads(points: Iterable[Point], problems: Iterable[str]) -> tuple[Lead, ...]:
    """Return the best of ours and of the peers on each problem at each level."""
    every = tuple(points)
    found = []
    for name in problems:
        own = [p for p in every if p.problem == name]
        for level in LEVELS:
            mine, other = (fastest(own, level, ours=side) for side in (True, False))
            if mine is not None or other is not None:
                found.append(Lead(name, level, mine, other))
    return tuple(found)


def ratios(found: Iterable[Lead]) -> dict[str, dict[str, float]]:
    """Return by problem and level how many times ours the best peer takes, where both get there."""
    out: dict[str, dict[str, float]] = {}
    for lead in found:
        if lead.ours is not None and lead.peer is not None:
            out.setdefault(lead.problem, {})[f"{lead.level:.0e}"] = float(f"{lead.ratio:.4g}")
    return out


def _row(lead: Lead) -> tuple[str, ...]:
    def cells(point: Point | None) -> tuple[str, str]:
        return ("-", "-") if point is None else (point.method, f"{point.milliseconds:.3g}")

    ratio = {float("inf"): "no peer", 0.0: "not reached"}.get(lead.ratio, f"{lead.ratio:.3g}")
    mark = " lost" if lead.lost and not lead.excused else ""
    return (
        lead.problem,
        f"{lead.level:.0e}",
        *cells(lead.ours),
        *cells(lead.peer),
        ratio + mark,
    )
