"""Sweeps over a grid of values, piece by piece, on any executor, from and to a store; the cost."""

from __future__ import annotations

import os
import re
import time
import tracemalloc
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, ElastolinkWarning, bad, warn_of_large_deflection
from ..core.families import LinearPeriodic
from ..core.inputs import require_mapping, require_whole
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Result, provenance
from ..core.tables import with_unit
from ..core.workers import check_executor, check_workers, run_on
from ..scenes import Scene
from .pieces import Grid, grid_of
from .requests import request_of
from .store import Store
from .tasks import (
    NAMED,
    AnyArray,
    Outputs,
    Piece,
    Task,
    axis_units,
    blank,
    holding,
    output_units,
    scene_numbers,
    task_of,
)

if TYPE_CHECKING:
    import xarray


_NUMBER = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
# The axis of the multipliers of a point, and which outputs are true or false.
_MULTIPLIERS = ("multipliers", "multiplier_error")
_TRUTHS = ("stable", "undecided")


@dataclass(frozen=True, kw_only=True)
class Sweep(Result):
    """Arrays over all combinations of values.

    Attributes
    ----------
    what : str
        What was worked out.
    axes : mapping of str to ndarray
        Values along each axis [SI], the last running fastest.
    outputs : mapping of str to ndarray
        Shape ``(*grid, ...)``, the grid having the lengths of the axes; of a folder read-only maps
        of its files.
    pieces : int
        How many pieces there were.
    resumed : int
        How many of them were in the store beforehand.
    store : Path or None
        Where it is kept.
    damaged : tuple of str
        What of the store was not as it had been written, and was done anew.
    failures : mapping of int to str
        Errors of the points that could not be worked out, by their place in the flattened grid.
    units : mapping of str to str
        Units of axes and outputs by name, as far as they are known.
    error : float
        Largest error estimate of the pieces, in the norm of what was worked out; NaN where that has
        none.
    """

    what: str
    axes: Mapping[str, NDArray[np.float64]]
    outputs: Mapping[str, AnyArray]
    pieces: int
    resumed: int = 0
    store: Path | None = None
    damaged: tuple[str, ...] = ()
    failures: Mapping[int, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> AnyArray:
        """Return one array by name.

        Raises ``BadInput`` if there is none of that name.
        """
        if name not in self.outputs:
            fix = "choose one of these"
            raise bad("sweep", f"output {name!r}", f"one of {sorted(self.outputs)}", fix)
        return self.outputs[name]

    def point(self, place: int) -> dict[str, float]:
        """Return the values along each axis at a place in the flattened grid, as of a failure.

        Raises ``BadInput`` if the grid has no such place.
        """
        shape = tuple(map(len, self.axes.values()))
        at = require_whole("place", place, 0, prod(shape) - 1, "give one of the failures")
        places = np.unravel_index(at, shape)
        pairs = zip(self.axes.items(), places, strict=True)
        return {name: float(values[k]) for (name, values), k in pairs}

    def reasons(self) -> dict[str, tuple[int, ...]]:
        """Return the places of failures by error, the most frequent first.

        Errors that differ in their numbers alone stand under the first of them.
        """
        alike: dict[str, list[int]] = {}
        for place, told in self.failures.items():
            alike.setdefault(_NUMBER.sub("", told), []).append(place)
        ordered = sorted(alike.values(), key=len, reverse=True)
        return {self.failures[places[0]]: tuple(places) for places in ordered}

    def arrays(self) -> dict[str, AnyArray]:
        """Return the values of the axes, as ``axis_NAME``, and the outputs."""
        axes = {f"axis_{name}": values for name, values in self.axes.items()}
        return {**axes, **self.outputs}

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings; of what a store holds shapes and types alone."""
        if self.store is None:
            return super().to_dict()
        out = replace(self, axes={}, outputs={}, store=None).to_dict()
        out["axes"] = {
            name: {"first": float(axis[0]), "last": float(axis[-1]), "count": len(axis)}
            for name, axis in self.axes.items()
        }
        out["outputs"] = {
            name: {"shape": list(array.shape), "type": array.dtype.name}
            for name, array in self.outputs.items()
        }
        return {**out, "store": str(self.store)}

    def _dimensions(self) -> dict[str, tuple[str, ...]]:
        names = tuple(self.axes)
        found = {f"axis_{name}": (name,) for name in names} | {
            name: (*names, *(f"{name}_{i}" for i in range(array.ndim - len(names))))
            for name, array in self.outputs.items()
        }
        if self.what == "floquet_multipliers":
            found |= {name: (*names, "multiplier") for name in _MULTIPLIERS if name in found}
        return found

    def _tables(self) -> dict[str, str]:
        """Return the table of all points, one row each, and those of outputs of several numbers."""
        # Where points have failed it has a column of errors.
        shape = tuple(map(len, self.axes.values()))
        outputs = {name: np.asarray(array) for name, array in self.outputs.items()}
        if self.failures:
            told = np.array([self.failures.get(place, "") for place in range(prod(shape))])
            outputs = {"failure": told.reshape(shape), **outputs}
            for name in _TRUTHS if self.what in NAMED else ():
                if name in outputs:
                    truths = np.where(outputs[name] == 1, "True", "False")
                    outputs[name] = np.where(np.isnan(outputs[name]), "", truths)
        labels = self._dimensions()
        groups: dict[str, dict[str, AnyArray]] = {}
        for name, array in outputs.items():
            single = array.size == prod(shape)
            ending = "" if single else "_".join(labels[name])
            groups.setdefault(ending, {})[name] = array
        if "" not in groups:
            return super()._tables()
        return {
            ending: Result._tables(replace(self, outputs=some, failures={}))[""]
            for ending, some in groups.items()
        }

    def _own_units(self) -> dict[str, str]:
        named = {f"axis_{name}" if name in self.axes else name: u for name, u in self.units.items()}
        return {"axis_speed": "rad/s", **named}

    def to_xarray(self) -> xarray.Dataset:
        """Return the outputs over their axes as an :class:`xarray.Dataset` (extra ``data``)."""
        plain = super().to_xarray()
        labels = self._dimensions()
        about = {name: {"units": unit} for name, unit in self.units.items()}
        data = {name: (labels[name], a, about.get(name)) for name, a in self.outputs.items()}
        coordinates = {name: (name, v, about.get(name)) for name, v in self.axes.items()}
        return type(plain)(data, coords=coordinates, attrs=plain.attrs)

    def plot(self, ax: Axes | None = None, *, output: str | None = None) -> Axes:
        """Draw an output over one axis, or as a map over two, and return the axes.

        A line marks where ``growth`` is 0: it parts stable from unstable points.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        output : str, optional
            Which one; by default the first that has one number at each point.

        Raises
        ------
        BadInput
            If there are more than two axes, or no such output.
        """
        if len(self.axes) > 2:
            raise bad("Sweep.plot", f"{len(self.axes)} axes", "one or two", "use the outputs")
        plain = [name for name, array in self.outputs.items() if array.ndim == len(self.axes)]
        usual = "stable" if "stable" in plain else (plain or list(self.outputs))[0]
        name = usual if output is None else output
        ax = axes_or_new(ax)
        # Most points along an axis of a picture; of more, evenly chosen ones are drawn.
        thin = [slice(None, None, -(-len(v) // 1200)) for v in self.axes.values()]
        values = [axis[part] for axis, part in zip(self.axes.values(), thin, strict=True)]
        shown = np.asarray(self[name][tuple(thin)])
        units = {"speed": "rad/s", **self.units}
        for place, key in enumerate(self.axes):
            if units.get(key) == "rad/s" and key.endswith("speed"):
                values[place], units[key] = RPM * values[place], "rpm"
        *labels, told = (with_unit(key, units.get(key, "")) for key in (*self.axes, name))
        ax.set_xlabel(labels[-1])
        if len(labels) == 1:
            ax.plot(values[0], shown.reshape(len(shown), -1), linewidth=0.9)
            if name == "growth":
                ax.axhline(0.0, color="k", linewidth=0.8)
            ax.set_ylabel(told)
            return ax
        if shown.shape[2:] == (1,):
            shown = shown[..., 0]
        if shown.ndim != 2:
            fix = "draw a part of it by yourself"
            raise bad("Sweep.plot", f"output {name!r} of several numbers", "one at each point", fix)
        ax.set_ylabel(labels[0])
        if shown.dtype == bool:
            # Grey where it is false, as the unstable part of a chart.
            grey: dict[str, Any] = {"cmap": "gray", "vmin": -4.0, "vmax": 1.0}
            ax.pcolormesh(values[1], values[0], shown.astype(float), shading="nearest", **grey)
            ax.set_title(f"white: {name}")
            return ax
        mesh = ax.pcolormesh(values[1], values[0], shown.astype(float), shading="nearest")
        ax.figure.colorbar(mesh, ax=ax, label=told)
        if name == "growth" and np.nanmin(shown) <= 0.0 < np.nanmax(shown):
            level = shown
            if "stable" in self.outputs:
                # Of stable motions without damping the growth is 0 but for its error.
                level = np.where(self["stable"][tuple(thin)] == 1, np.minimum(shown, 0.0), shown)
            if min(level.shape) > 1 and np.nanmax(level) > 0.0:
                ax.contour(values[1], values[0], level, [0.0], colors="k", linewidths=0.9)
                ax.set_title("black line: growth 0")
        return ax


# Kinds of types that the arrays of pieces may have beside each other.
_REAL = set("biuf")


def sweep(
    what: str | Callable[..., Any],
    subject: object,
    values: Mapping[str, ArrayLike],
    *,
    options: Mapping[str, object] | None = None,
    outputs: tuple[str, ...] | None = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: bool = False,
) -> Sweep:
    """Work out something at all combinations of values, in pieces that do not know each other.

    The borders of the pieces follow from the values and ``chunk`` alone: the same sweep gives the
    same bytes by any executor, number of workers and order, and after any interruption.

    Parameters
    ----------
    what : str or callable
        ``"stability_chart"`` (two axes: the first along y, the second along x),
        ``"floquet_multipliers"`` (with ``growth``, the logarithm of the largest modulus: of the
        growth in a period), ``"steady_state"`` (peak and rms [m] of the deflection at
        ``SteadyState.place``; of each coordinate where there are no mode shapes), which take all
        points of a piece at once; the name of any other public function; or a function of your
        own, called at one point after another as ``what(subject, **values, **options)``, which
        returns a number, an array, a mapping of such or a result.
    subject : object
        A system or scene for those of the first kind, else the first argument of the function.
    values : mapping
        Values along each axis [SI] by name, the last running fastest: ``"speed"`` and parameters
        or geometry of the system; of other functions their arguments, and numbers of the subject
        that it can be made anew for.  Of a scene such are its numbers by their dotted keys
        (``"links.coupler"``), for all but charts.
    options : mapping, optional
        Further arguments.
    outputs : tuple of str, optional
        Which arrays are kept; by default all, of ``"stability_chart"`` all but ``invariants``.
    executor : concurrent.futures.Executor, optional
        Threads, processes (:func:`process_pool`, loky's) or Dask's ``client.get_executor()``; what
        is swept must bear pickling for all but threads, functions of a script or a notebook by
        cloudpickle, of the extra ``cluster``.
    chunk : int, optional
        About how many points a piece has, which bounds the memory of each worker.  A chart's
        piece has at least two whole rows.
    store : path, optional
        Where finished pieces are kept: a folder, at the end with one ``.npy`` file per array, or
        a path ending in ``.npz``.  The same sweep goes on from there after it was killed, or
        gives what is complete there; what was damaged since is told as ``damaged`` and done anew.
        A function of one's own is known by its content and by the functions and constants of its
        file that it uses.  One process at a time works on a store.
    progress : bool
        Whether to show a progress bar with the time left.

    Returns
    -------
    Sweep
        ``outputs`` by name, shape ``(*grid, ...)``; of a folder they are maps of its files.  Its
        error is the largest of the pieces, its checks are the worst of each.  A point that cannot
        be worked out (of a chart: that makes no system) is NaN (or an empty text), its error among
        the ``failures``; whole numbers and truths become floats then.  :meth:`Sweep.point` gives
        the values there, :meth:`Sweep.reasons` the failures by error.

    Warns
    -----
    ElastolinkWarning
        If points have failed: how many.
    LinearRangeWarning
        If a deflection passes 5 % of the reference length at any point: once, in place of the
        warnings of all points.

    Raises
    ------
    BadInput
        If an argument is unusable, the store holds another request, or no point can be worked out.
    WorkersLost
        If the executor's workers end; with a store the finished pieces are kept.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> values = {"damping": [0.0, 0.5], "speed": [75.0, 80.0, 85.0]}
    >>> print(el.sweep("floquet_multipliers", system, values).outputs["stable"])
    [[ True False  True]
     [ True  True  True]]
    """
    plan = planned(what, subject, values, options, outputs, chunk)
    check_executor(executor)
    if store is None:
        found = _in_memory(plan, executor, progress)
    else:
        if not isinstance(store, str | os.PathLike):
            raise bad("store", repr(store), "a path", "give a folder or a .npz file")
        found = _through_store(plan, executor, Path(store), progress)
    if "linear range" in found.checks:
        warn_of_large_deflection(found.checks["linear range"].value)
    return found


@dataclass(frozen=True)
class Plan:
    """A sweep whose arguments have been checked: what, with what, where, and what is kept."""

    task: Task
    subject: Any
    grid: Grid
    options: Mapping[str, object]
    outputs: Outputs
    units: Mapping[str, str]  # of axes and outputs, as far as they are known

    def piece(self, number: int) -> Piece:
        """Work out one piece."""
        return self.task.run(self.subject, self.grid.values(number), self.options, self.outputs)


def planned(
    what: str | Callable[..., Any],
    subject: object,
    values: Mapping[str, ArrayLike],
    options: Mapping[str, object] | None,
    outputs: tuple[str, ...] | None,
    chunk: int | None,
) -> Plan:
    """Return the plan of a sweep."""
    task = task_of(what)
    grid = grid_of(values, task.chunk if chunk is None else chunk, rows=task.rows)
    require_mapping("options", {} if options is None else options, "say options={'speed': 50.0}")
    told = dict(options or {})
    known = axis_units(subject)
    if isinstance(subject, Scene) and task.function is None:
        made: object = subject.linear_system() if task.name in NAMED else subject.system()
        # A scene whose numbers are axes becomes a system at each point.
        numbers = set() if task.rows else scene_numbers(subject) & {*grid.names}
    else:
        made, numbers = subject, set()
    if task.name in NAMED:
        _check_axes(task, made, grid, told, numbers)
    units = {name: known[name] for name in grid.names if known.get(name)}
    units |= output_units(task, made)
    if not numbers:
        subject = made
    both = sorted(set(told) & set(grid.names))
    if both:
        raise bad("options", both, "arguments that are no axis", "leave them out there")
    if outputs is not None and (isinstance(outputs, str) or not outputs):
        fix = 'give a tuple, as ("stable",)'
        raise bad("outputs", repr(outputs), "names of arrays", fix)
    kept = task.outputs if outputs is None else tuple(outputs)
    return Plan(task, subject, grid, told, kept, units)


def _check_axes(
    task: Task, subject: object, grid: Grid, told: Mapping[str, object], numbers: set[str]
) -> None:
    """Refuse a subject or axes that a solver of linear periodic systems cannot take."""
    if not isinstance(subject, LinearPeriodic):
        fix = "give scene.system() or a scene"
        raise bad(task.name, type(subject).__name__, "a linear periodic system", fix)
    known = ["speed", *sorted({*subject.parameters, *subject.geometry})]
    unknown = sorted({*grid.names} - {*known} - numbers)
    if unknown:
        raise bad("values", f"axes {unknown}", f"some of {known}", "correct the names")
    if task.rows:
        rising = all(np.all(np.diff(axis) > 0) for axis in grid.axes)
        if len(grid.names) != 2 or min(grid.shape) < 2 or not rising:
            expected = "two axes of at least two rising values each"
            raise bad("values", f"axes of {grid.shape} values", expected, "correct them")
    elif "speed" not in (*grid.names, *told):
        fix = "make it an axis, or give options={'speed': ...} in rad/s"
        raise bad(task.name, "no speed", "a crank speed", fix)


def _pieces(
    plan: Plan, executor: Executor | None, wanted: list[int], progress: bool
) -> Iterator[tuple[int, Piece]]:
    points = plan.grid.points
    sizes = [plan.grid.run(number) for number in wanted]
    done = points - sum(run.stop - run.start for run in sizes)
    with bar(progress, points, begun=done, unit=" points") as tick:
        for place, piece in run_on(executor, plan.piece, wanted):
            yield wanted[place], piece
            done += sizes[place].stop - sizes[place].start
            tick(done)


class Summary:
    """What is told of all pieces, whatever order they come in."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid
        self._parts: dict[int, Piece] = {}
        self._kinds: dict[str, tuple[tuple[int, ...], np.dtype[Any]]] = {}
        self.failures: dict[int, str] = {}

    @property
    def shapes(self) -> dict[str, tuple[tuple[int, ...], str]]:
        """Shape at a point and type of every array; refused where no point has an answer."""
        if not self._kinds:
            raise _no_answer(self.failures, self._grid.points)
        return {
            name: (rest, holding(kind, self.failures).str)
            for name, (rest, kind) in self._kinds.items()
        }

    def add(self, number: int, piece: Piece) -> None:
        """Take in a piece; refuse one whose arrays are not like those of the others."""
        start = self._grid.run(number).start
        self.failures |= {start + place: told for place, told in piece.failures.items()}
        self._parts[number] = replace(piece, arrays={}, failures={})
        if not piece.arrays:
            return
        found = {name: (array.shape[1:], array.dtype) for name, array in piece.arrays.items()}
        held = self._kinds or found
        # A piece with failures holds as floats, for NaN, what others hold as whole numbers.
        alike = found.keys() == held.keys() and all(
            rest == held[name][0]
            and (kind == held[name][1] or {kind.kind, held[name][1].kind} <= _REAL)
            for name, (rest, kind) in found.items()
        )
        if not alike:
            given = f"{sorted(found.items())} in one piece, {sorted(held.items())} in another"
            fix = "name the outputs that have them, as outputs=(...)"
            raise bad("outputs", given, "arrays of the same names, shapes and types", fix)
        self._kinds = {
            name: (rest, np.result_type(kind, held[name][1]))
            for name, (rest, kind) in found.items()
        }

    def whole(self, arrays: Mapping[str, AnyArray]) -> Piece:
        """Return the arrays of all pieces with what holds for all of them."""
        parts = [self._parts[number] for number in sorted(self._parts)]
        return replace(Piece.joined(arrays, parts), failures=dict(sorted(self.failures.items())))


def _no_answer(failures: Mapping[int, str], points: int) -> BadInput:
    """Return the complaint about a sweep, or a piece of it, all of whose points failed."""
    first = failures[min(failures)]
    found = f"errors at all of {points} points"
    return bad("sweep", found, "an answer at one of them", f"the first error: {first}")


def _in_memory(plan: Plan, executor: Executor | None, progress: bool) -> Sweep:
    grid = plan.grid
    summary = Summary(grid)
    arrays: dict[str, AnyArray] = {}
    for number, piece in _pieces(plan, executor, list(range(grid.pieces)), progress):
        summary.add(number, piece)
        for name, array in piece.arrays.items():
            kind = np.dtype(summary.shapes[name][1])
            if name not in arrays:
                arrays[name] = np.empty((grid.points, *array.shape[1:]), dtype=kind)
            arrays[name] = arrays[name].astype(kind, copy=False)
            arrays[name][grid.run(number)] = array
    whole, failed = {}, list(summary.failures)
    for name, (rest, final) in sorted(summary.shapes.items()):
        array = arrays[name].astype(final, copy=False)
        array[failed] = blank(rest, array.dtype)
        whole[name] = array.reshape(*grid.shape, *rest)
    return _assembled(plan, summary.whole(whole), None, 0)


def _through_store(plan: Plan, executor: Executor | None, place: Path, progress: bool) -> Sweep:
    request = request_of(plan.task, plan.subject, plan.grid, plan.options, plan.outputs)
    kept, summary, wanted = Store(place, request, plan.grid), Summary(plan.grid), []
    done = kept.finished()
    if done is not None:
        return _assembled(plan, done, place, plan.grid.pieces)
    with kept.opened():
        for number in range(plan.grid.pieces):
            piece = kept.read(number)
            if piece is None:
                wanted.append(number)
            else:
                summary.add(number, piece)
        for number, piece in _pieces(plan, executor, wanted, progress):
            summary.add(number, piece)
            kept.write(number, piece)
        joined = kept.join(summary.shapes, summary.whole({}))
    found = _assembled(plan, joined, place, plan.grid.pieces - len(wanted))
    return replace(found, damaged=tuple(kept.damaged))


def _assembled(plan: Plan, whole: Piece, place: Path | None, resumed: int) -> Sweep:
    known = plan.subject.provenance if isinstance(plan.subject, LinearPeriodic) else {}
    method = whole.method
    if whole.failures:
        failed = f"{len(whole.failures)} of {plan.grid.points} points failed"
        method = f"{method}; {failed}"
        told = f"{failed}, see its failures; the first: {whole.failures[min(whole.failures)]}"
        warnings.warn(f"sweep: {told}", ElastolinkWarning, stacklevel=4)
    return Sweep(
        method=method,
        error=whole.error,
        error_norm=whole.error_norm,
        checks=whole.checks,
        provenance=provenance(known),
        what=plan.task.name,
        axes=dict(zip(plan.grid.names, plan.grid.axes, strict=True)),
        outputs=whole.arrays,
        pieces=plan.grid.pieces,
        resumed=resumed,
        store=place,
        failures=dict(whole.failures),
        units={k: u for k, u in plan.units.items() if k in (*plan.grid.names, *whole.arrays)},
    )


@dataclass(frozen=True)
class SweepEstimate:
    """Time and memory of a sweep, from working out one of its pieces."""

    points: int
    pieces: int
    seconds: float  # of the whole sweep, each worker having a core of its own
    bytes: int  # of the outputs, in memory or in the store
    piece_bytes: int  # most memory that a worker held beside its subject during that piece
    workers: int

    def __str__(self) -> str:
        """Return it as one line."""
        return (
            f"{self.points} points in {self.pieces} pieces: about {self.seconds:.3g} s with "
            f"{self.workers} worker{'s' * (self.workers > 1)}, {self.bytes / 1e6:.3g} MB of "
            f"outputs, {self.piece_bytes / 1e6:.3g} MB for each worker"
        )


def estimate_sweep(
    what: str | Callable[..., Any],
    subject: object,
    values: Mapping[str, ArrayLike],
    *,
    options: Mapping[str, object] | None = None,
    outputs: tuple[str, ...] | None = None,
    chunk: int | None = None,
    workers: int = 1,
) -> SweepEstimate:
    """Return what :func:`sweep` of the same arguments would cost, from doing its middle piece.

    Where all points of that fail, the next one that has an answer is taken.  The piece is done
    twice: once for the memory, and again for the time.  Where some points are far dearer than
    others, low speeds for one, the time is no better than to a small factor.

    Parameters
    ----------
    what, subject, values, options, outputs, chunk
        As :func:`sweep`.
    workers : int
        How many work at once.

    Returns
    -------
    SweepEstimate
        Its ``seconds`` and ``bytes`` are those of the whole sweep.

    Raises
    ------
    BadInput
        As :func:`sweep`.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> values = {"damping": [0.0, 0.5], "speed": [75.0, 80.0, 85.0]}
    >>> cost = el.sweeps.estimate_sweep("floquet_multipliers", system, values, workers=2)
    >>> print(cost.points, cost.pieces)
    6 1
    """
    check_workers(workers)
    plan = planned(what, subject, values, options, outputs, chunk)
    already = tracemalloc.is_tracing()
    if not already:
        tracemalloc.start()
    try:
        # The middle one first, then those beside it.
        for step in range(plan.grid.pieces):
            number = plan.grid.pieces // 2 + (step + 1) // 2 * (-1) ** step
            before = tracemalloc.get_traced_memory()[0]
            tracemalloc.reset_peak()
            piece = plan.piece(number)
            peak = tracemalloc.get_traced_memory()[1] - before
            if piece.arrays:
                break
    finally:
        if not already:
            tracemalloc.stop()
    if not piece.arrays:
        raise _no_answer(piece.failures, plan.grid.points)
    run = plan.grid.run(number)
    begin = time.perf_counter()
    plan.piece(number)
    seconds = time.perf_counter() - begin
    share = plan.grid.points / (run.stop - run.start)
    held = sum(int(np.asarray(array).nbytes) for array in piece.arrays.values())
    at_once = min(workers, plan.grid.pieces)
    return SweepEstimate(
        points=plan.grid.points,
        pieces=plan.grid.pieces,
        seconds=seconds * share / at_once,
        bytes=round(held * share),
        piece_bytes=int(peak),
        workers=workers,
    )
