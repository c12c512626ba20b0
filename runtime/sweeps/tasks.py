"""What a sweep can do at its points: the solvers that take many at once, or any function."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import partial
from importlib import import_module
from itertools import pairwise
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LINEAR_RANGE, ElastolinkError, bad, deflections_beyond
from ..core.families import Array, LinearPeriodic
from ..core.results import Check, Result, worst_checks
from ..core.units import DIMENSIONS
from ..scenes import Scene, with_numbers
from ..scenes.tolerances import flat

if TYPE_CHECKING:
    from ..periodic import FloquetMultipliers, SteadyState

AnyArray = NDArray[Any]

# What the numbers of a point can bring about; other errors, of a disk or a program, end the sweep.
_FAILURES = (ElastolinkError, ArithmeticError, LookupError, RuntimeError, ValueError)


@dataclass(frozen=True)
class Piece:
    """Arrays at a run of the grid's points, or at all of them, and what a result says of itself."""

    arrays: Mapping[str, AnyArray]  # (points, ...) each
    method: str
    error: float  # the largest of the points; NaN where there is none
    error_norm: str
    checks: Mapping[str, Check]  # the worst of each
    # Errors of the points that have no answer, by their place in the run; no arrays where all fail.
    failures: Mapping[int, str] = field(default_factory=dict)

    def about(self) -> dict[str, Any]:
        """Return all but the arrays, ready for JSON, which has no word for infinity."""
        pairs = {name: [_json(c.value), _json(c.limit)] for name, c in self.checks.items()}
        return {
            "method": self.method,
            "error": _json(self.error),
            "error_norm": self.error_norm,
            "checks": pairs,
            "failures": sorted(self.failures.items()),
        }

    @classmethod
    def from_about(cls, arrays: Mapping[str, AnyArray], about: Mapping[str, Any]) -> Piece:
        """Undo :meth:`about`."""
        checks = {name: Check(*map(float, pair)) for name, pair in about["checks"].items()}
        told = about["method"], float(about["error"]), about["error_norm"], checks
        return cls(arrays, *told, dict(about.get("failures", ())))

    @classmethod
    def joined(cls, arrays: Mapping[str, AnyArray], parts: Sequence[Piece | Result]) -> Piece:
        """Return what holds for all parts, failures excepted, with the arrays of all."""
        methods = dict.fromkeys(m for part in parts for m in part.method.split("; ") if m)
        return cls(
            arrays,
            "; ".join(methods),
            _largest([_largest(part.error) for part in parts]),
            next((part.error_norm for part in parts if part.error_norm), ""),
            worst_checks(part.checks for part in parts),
        )


def _json(number: float) -> float | str:
    return float(number) if np.isfinite(number) else str(float(number))


# Subject, values along each axis of a piece, further arguments, wanted arrays.
Outputs = tuple[str, ...] | None
Run = Callable[[Any, Mapping[str, Array], Mapping[str, Any], Outputs], Piece]


@dataclass(frozen=True)
class Task:
    """A way to work out a piece."""

    name: str  # in a manifest
    run: Run
    chunk: int  # points of a piece unless told otherwise
    rows: bool = False  # whether a piece wants its last axis whole
    outputs: Outputs = None  # arrays that are kept unless told otherwise; None for all
    # Of the user's, which takes a scene as it is; a store knows it by its content.
    function: Callable[..., Any] | None = None


def _largest(error: object) -> float:
    """Return the largest error estimate that is a number; NaN where there is none."""
    values = np.asarray(error, dtype=float)
    values = values[~np.isnan(values)]
    return float(np.max(values)) if values.size else float("nan")


def blank(shape: tuple[int, ...], kind: np.dtype[Any]) -> AnyArray:
    """Return an array of what stands where there is no answer: NaN, or an empty text."""
    return np.full(shape, np.nan, kind) if kind.kind in "fc" else np.zeros(shape, kind)


def holding(kind: np.dtype[Any], failures: Collection[object]) -> np.dtype[Any]:
    """Return the type of an output, which must hold NaN where points have failed."""
    return np.dtype(float) if failures and kind.kind in "biu" else kind


def _told(error: Exception) -> str:
    """Return the line of a point's error."""
    kind = "" if isinstance(error, ElastolinkError) else f"{type(error).__name__}: "
    return kind + "; ".join(str(error).splitlines())


def _of_result(arrays: Mapping[str, AnyArray], *results: Result) -> Piece:
    joined = Piece.joined(arrays, results)
    return replace(joined, method=results[0].method) if results else joined


def _chart(
    system: LinearPeriodic, axes: Mapping[str, Array], options: Mapping[str, Any], outputs: Outputs
) -> Piece:
    """Return the chart of a piece; where points cannot be built, charts of the blocks of others."""
    try:
        return _of_result(*_block(system, axes, options, outputs))
    except _FAILURES:
        # Points whose values make no system.
        failures = _each(lambda made, **speed: 0.0, system, axes, {}, None).failures
        if not failures:
            raise
    built = np.ones(tuple(map(len, axes.values())), bool)
    built.flat[list(failures)] = False
    numbers = np.arange(built.size).reshape(built.shape)
    blocks, charts = [], []
    for place in _blocks(built):
        part = {name: axes[name][run] for name, run in zip(axes, place, strict=True)}
        arrays, chart = _block(system, part, options, outputs)
        blocks.append((numbers[place].ravel(), arrays))
        charts.append(chart)
    return replace(_of_result(_spread(blocks, failures), *charts), failures=failures)


def _block(
    system: LinearPeriodic, axes: Mapping[str, Array], options: Mapping[str, Any], outputs: Outputs
) -> tuple[dict[str, AnyArray], Result]:
    """Return the arrays of a chart, ``(points, ...)``, and the chart; one value may stand alone."""
    from ..stability import stability_chart

    # A chart wants two values along an axis: beside a single one stands one next to it.
    (y, along_y), (x, along_x) = (
        (name, v if len(v) > 1 else np.append(v, v + 1e-9 * (np.abs(v) + 1e-9)))
        for name, v in axes.items()
    )
    told = {"boundaries": False, **options}
    chart = stability_chart(system, x=(x, along_x), y=(y, along_y), **told)
    kept = tuple(slice(len(values)) for values in axes.values())
    arrays = {
        name: getattr(chart, name)[kept]
        for name in ("stable", "largest", "slack", "undecided", "kind", "invariants")
    }
    flat = {k: v.reshape(-1, *v.shape[2:]) for k, v in arrays.items()}
    return _wanted(flat, outputs), chart


def _blocks(built: NDArray[np.bool_]) -> list[tuple[slice, slice]]:
    """Return the blocks of a map: rows that are alike, and the runs of true values in them."""
    found = []
    turns = np.flatnonzero(np.any(built[1:] != built[:-1], axis=1)) + 1
    for first, end in pairwise((0, *turns.tolist(), len(built))):
        ends = np.flatnonzero(np.diff(built[first].astype(int), prepend=0, append=0))
        found += [(slice(first, end), slice(*run)) for run in ends.reshape(-1, 2).tolist()]
    return found


def _by_geometry(
    solver: str,
    arrays_of: Callable[[Any], dict[str, AnyArray]],
    subject: LinearPeriodic | Scene,
    axes: Mapping[str, Array],
    options: Mapping[str, Any],
    outputs: Outputs,
) -> Piece:
    """Call a solver of :mod:`..periodic` with all points of a piece, or once for each geometry."""
    # Of a scene its numbers are the geometry.
    from .. import periodic

    values = _points(axes)
    made_for = scene_numbers(subject) if isinstance(subject, Scene) else subject.geometry
    shapes = [name for name in values if name in made_for]
    count = prod(len(axis) for axis in axes.values())
    table = np.stack([values[name] for name in shapes], axis=-1) if shapes else np.zeros((count, 0))
    failures: dict[int, str] = {}
    found: list[tuple[NDArray[np.intp], dict[str, AnyArray], Result]] = []

    def solve(own: NDArray[np.intp]) -> None:
        """Solve at points of one geometry; where they are refused, at each half of them."""
        geometry = dict(zip(shapes, table[own[0]].tolist(), strict=True))
        rest = {name: value[own] for name, value in values.items() if name not in shapes}
        # Answers have an axis of points also where nothing but the geometry varies.
        told = dict(options) if rest else {**options, "speed": np.full(len(own), options["speed"])}
        try:
            made = _moved(subject, geometry)
            made = made.linear_system() if isinstance(made, Scene) else made
            # Its check tells.
            with deflections_beyond():
                result = getattr(periodic, solver)(made, **rest, **told)
        except _FAILURES as error:
            if len(own) == 1:
                failures[int(own[0])] = _told(error)
                return
            for half in np.array_split(own, 2):
                solve(half)
            return
        found.append((own, _wanted(arrays_of(result), outputs), result))

    for shape in np.unique(table, axis=0):
        solve(np.flatnonzero(np.all(table == shape, axis=1)))
    arrays = _spread([(own, each) for own, each, _ in found], failures)
    return replace(_of_result(arrays, *(each for _, _, each in found)), failures=failures)


def _spread(
    found: Sequence[tuple[NDArray[np.intp], Mapping[str, AnyArray]]], failures: Mapping[int, str]
) -> dict[str, AnyArray]:
    """Return the arrays of all points from those of some, by their places, the others blank."""
    count = len(failures) + sum(len(places) for places, _ in found)
    spread = {}
    for name, first in (found[0][1] if found else {}).items():
        kind = np.result_type(*(arrays[name] for _, arrays in found))
        spread[name] = blank((count, *first.shape[1:]), holding(kind, failures))
        for places, arrays in found:
            spread[name][places] = arrays[name]
    return spread


def _points(axes: Mapping[str, Array]) -> dict[str, Array]:
    mesh = np.meshgrid(*axes.values(), indexing="ij")
    return {name: part.ravel() for name, part in zip(axes, mesh, strict=True)}


def _of_multipliers(found: FloquetMultipliers) -> dict[str, AnyArray]:
    return {
        "multipliers": found.multipliers,
        "multiplier_error": np.asarray(found.error),
        "error": np.max(found.error, axis=-1),
        "stable": np.asarray(found.stable),
        "growth": np.max(found.exponents.real, axis=-1),
    }


def _of_motion(found: SteadyState) -> dict[str, AnyArray]:
    if not deflects(found):
        return {
            "peak": np.max(np.abs(found.q), axis=-2),
            "rms": np.sqrt(np.mean(found.q**2, axis=-2)),
            "error": np.asarray(found.error),
        }
    return {
        "peak": found.peak(),
        "rms": np.sqrt(np.mean(found.deflection() ** 2, axis=-1)),
        "error": np.max(found.error, axis=-1),
    }


def deflects(moving: LinearPeriodic | SteadyState) -> bool:
    """Return whether coordinates stand for deflections: whether there are mode shapes."""
    shapes = moving.shapes
    return shapes is not None and shapes(np.ones(1), np.zeros(1)) is not None


def output_units(task: Task, system: object) -> dict[str, str]:
    """Return the units of what a solver of many points gives of a system, by name."""
    if task.name == "steady_state" and isinstance(system, LinearPeriodic) and deflects(system):
        return {"peak": "m", "rms": "m"}
    if task.name == "floquet_multipliers" and isinstance(system, LinearPeriodic):
        return {"growth": "per turn" if np.isclose(system.period, 2.0 * np.pi) else "per period"}
    return {}


def _each(
    function: Callable[..., Any],
    subject: Any,
    axes: Mapping[str, Array],
    options: Mapping[str, Any],
    outputs: Outputs,
    made_of: Callable[[Scene], object] | None = None,
) -> Piece:
    own = _own_values(function, subject, tuple(axes))
    arrays: list[dict[str, AnyArray]] = []
    results: list[Result] = []
    failures: dict[int, str] = {}
    beyond: list[float] = []
    rows = zip(*(values.tolist() for values in _points(axes).values()), strict=True)
    for place, row in enumerate(rows):
        point = dict(zip(axes, row, strict=True))
        try:
            made = _moved(subject, {name: point.pop(name) for name in own})
            if made_of is not None and isinstance(made, Scene):
                made = made_of(made)
            with deflections_beyond() as large:
                answer = function(made, **point, **options)
            beyond += large
        except _FAILURES as error:
            failures[place] = _told(error)
            continue
        arrays.append(_wanted(_arrays_of(answer), outputs))
        if isinstance(answer, Result):
            results.append(answer)
    good = np.setdiff1d(np.arange(len(arrays) + len(failures)), list(failures))
    names = arrays[0] if arrays else ()
    stacked = {name: _stacked(name, [found.get(name) for found in arrays]) for name in names}
    joined = _spread([(good, stacked)], failures)
    checks = {"linear range": Check(max(beyond), LINEAR_RANGE)} if beyond else {}
    if results or not arrays:
        found = _of_result(joined, *results)
        return replace(found, checks=worst_checks([found.checks, checks]), failures=failures)
    name = getattr(function, "__name__", "function")
    return Piece(joined, name, float("nan"), "none: the function gives none", checks, failures)


def _own_values(
    function: Callable[..., Any], subject: Any, names: tuple[str, ...]
) -> tuple[str, ...]:
    """Return which values are the subject's own, and not arguments of the function."""
    try:
        arguments = list(inspect.signature(function).parameters.values())[1:]
    except (TypeError, ValueError):
        return ()
    plain = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    taken = {item.name for item in arguments if item.kind in plain}
    known: set[str] = set()
    if isinstance(subject, LinearPeriodic):
        known = {*subject.parameters, *subject.geometry}
    elif isinstance(subject, Scene):
        known = scene_numbers(subject)
    elif is_dataclass(subject) and not isinstance(subject, type):
        known = {item.name for item in fields(subject) if item.init}
    own = tuple(name for name in names if name not in taken and name in known)
    left = [name for name in names if name not in taken and name not in known]
    if left and not any(item.kind is inspect.Parameter.VAR_KEYWORD for item in arguments):
        expected = f"some of {sorted(taken | known)}"
        raise bad("values", f"axes {left}", expected, "correct the names")
    return own


def scene_numbers(scene: Scene) -> set[str]:
    """Return the dotted keys of the numbers that a scene gives."""
    return {key for key, value in flat(scene.given) if isinstance(value, float)}


def axis_dimensions(scene: Scene) -> dict[str, str]:
    """Return by name the dimensions of what may be swept of a scene and of its system."""
    own = {key: scene.dimension(key) or "dimensionless" for key in scene_numbers(scene)}
    return {"speed": "frequency", **scene.layout.parameters, **own}


def axis_units(subject: object) -> dict[str, str]:
    """Return by name the SI units of what may be swept, as far as they are known."""
    known = axis_dimensions(subject) if isinstance(subject, Scene) else {"speed": "frequency"}
    units = {name: DIMENSIONS[dimension].si for name, dimension in known.items()}
    return {name: unit.replace("**", "^").replace("*", " ") for name, unit in units.items()}


def _moved(subject: Any, values: dict[str, float]) -> Any:
    if not values:
        return subject
    if isinstance(subject, Scene):
        return with_numbers(subject, values)
    if not isinstance(subject, LinearPeriodic):
        return replace(subject, **values)
    shapes = {name: value for name, value in values.items() if name in subject.geometry}
    made = subject.with_geometry(**shapes) if shapes else subject
    numbers = {name: value for name, value in values.items() if name not in shapes}
    return made.with_parameters(**numbers) if numbers else made


def _wanted(arrays: dict[str, AnyArray], outputs: Outputs) -> dict[str, AnyArray]:
    if outputs is None:
        return arrays
    missing = [name for name in outputs if name not in arrays]
    if missing:
        raise bad("outputs", missing, f"some of {sorted(arrays)}", "correct the names")
    return {name: arrays[name] for name in outputs}


def _arrays_of(answer: Any) -> dict[str, AnyArray]:
    if isinstance(answer, Result):
        return answer.arrays()
    if isinstance(answer, Mapping):
        return {str(name): np.asarray(value) for name, value in answer.items()}
    return {"value": np.asarray(answer)}


def _stacked(name: str, values: list[AnyArray | None]) -> AnyArray:
    shapes = {None if value is None else value.shape for value in values}
    kinds = {None if value is None else value.dtype.kind for value in values}
    if len(shapes) > 1 or kinds & {"O", None}:
        found = f"shapes {sorted(map(str, shapes))}" if len(shapes) > 1 else "no numbers"
        fix = "name the outputs that have one, as outputs=(...), or return such"
        raise bad(f"output {name!r}", found, "numbers of one shape at every point", fix)
    return np.stack([value for value in values if value is not None])


NAMED: Mapping[str, Task] = {
    "stability_chart": Task(
        "stability_chart",
        _chart,
        1_000_000,
        rows=True,
        outputs=("stable", "largest", "slack", "undecided", "kind"),
    ),
    "floquet_multipliers": Task(
        "floquet_multipliers", partial(_by_geometry, "floquet_multipliers", _of_multipliers), 2048
    ),
    "steady_state": Task("steady_state", partial(_by_geometry, "steady_state", _of_motion), 64),
}


def task_of(what: str | Callable[..., Any]) -> Task:
    """Return the task that a name or a function stands for."""
    if isinstance(what, str):
        if what in NAMED:
            return NAMED[what]
        public = import_module(__name__.partition(".")[0])
        function = getattr(public, what, None) if what in public.__all__ else None
        if not callable(function) or isinstance(function, type):
            from ..scenes.validation import nearest

            known = [name for name in public.__all__ if name[:1].islower()]
            fix = nearest(what, known, "name one of these")
            expected = "the name of a public function, or a function"
            raise bad("sweep", repr(what), expected, fix)
        return Task(what, partial(_each, function, made_of=Scene.system), 16)
    if not callable(what):
        fix = "give 'stability_chart', or a function of your own"
        raise bad("sweep", repr(what)[:60], "a name or a function", fix)
    name = f"{getattr(what, '__module__', '')}.{getattr(what, '__qualname__', repr(what))}"
    return Task(name, partial(_each, what), 16, function=what)
