"""One solver's batch in fixed pieces on an executor, joined to the result that it gives itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.progress import bar
from ..core.results import Result, provenance
from .tasks import worst
from .workers import Workers

if TYPE_CHECKING:
    from ..floquet.monodromy_matrix import FloquetMultipliers
    from ..response.result import SteadyState

Array = NDArray[np.float64]
AnyArray = NDArray[Any]
# Points of a piece: few enough to share out, many enough to share what they have in common.
_MULTIPLIERS, _MOTIONS = 256, 64
_Item = dict[str, Array]


def multipliers_in_pieces(
    system: LinearPeriodic,
    speed: ArrayLike,
    parameters: Mapping[str, ArrayLike],
    options: Mapping[str, Any],
    executor: Executor,
) -> FloquetMultipliers:
    """Return :func:`~..floquet.monodromy_matrix.floquet_multipliers` of a batch, by an executor.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speed, parameters
        What broadcasts to the batch.
    options : mapping
        Further arguments.
    executor : Executor
        Does pieces of 256 points.

    Raises
    ------
    BadInput
        If an argument is unusable.
    """
    from ..floquet.krein import SignatureSource

    workers, items, batch = _cut(_MULTIPLIERS, system, speed, parameters, options, executor)
    found = _done(workers, _some_multipliers, items, False)
    sources = [part.source for part in found if part.source is not None]
    source = None
    if len(sources) == len(found):
        matrices = np.concatenate([s.matrices for s in sources])
        error = np.concatenate([s.error for s in sources])
        source = SignatureSource(
            matrices.reshape(*batch, *matrices.shape[1:]), error.reshape(batch)
        )
    first: FloquetMultipliers = found[0]
    joined: dict[str, Any] = _joined(found, batch, ("speed", "multipliers", "exponents", "error"))
    return replace(
        first,
        **joined,
        checks=worst(part.checks for part in found),
        provenance=provenance(system.changed_provenance(**parameters)),
        source=source,
    )


def steady_in_pieces(
    system: LinearPeriodic,
    speed: ArrayLike,
    parameters: Mapping[str, ArrayLike],
    options: Mapping[str, Any],
    executor: Executor,
    *,
    progress: bool = False,
) -> SteadyState:
    """Return :func:`~..response.steady_state.steady_state` of a batch, by an executor.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speed, parameters
        What broadcasts to the batch.
    options : mapping
        Further arguments.
    executor : Executor
        Does pieces of 64 motions.
    progress : bool
        Whether to show a progress bar.

    Raises
    ------
    BadInput
        If an argument is unusable.
    """
    workers, items, batch = _cut(_MOTIONS, system, speed, parameters, options, executor)
    found = _done(workers, _some_motions, items, progress)
    most = max(found, key=lambda part: len(part.theta))
    found = [_at_angles(part, len(most.theta)) for part in found]
    names = ["speed", "q", "qd", "error", "distance", "sensitivity"]
    changed: dict[str, Any] = {"multipliers": None, "stable": None}
    if all(part.multipliers is not None for part in found):
        # Of stiff systems each piece has its slow modes: those that all have.
        kept = min(part.multipliers.shape[-1] for part in found)
        found = [replace(part, multipliers=part.multipliers[..., :kept]) for part in found]
        names += ["multipliers", "stable"]
    if all(part.cycles is not None for part in found):
        names.append("cycles")
    changed |= _joined(found, batch, tuple(names))
    first: SteadyState = found[0]
    return replace(
        first,
        **changed,
        theta=most.theta,
        checks=worst(part.checks for part in found),
        provenance=provenance(system.changed_provenance(**parameters)),
        shapes=system.shapes,
    )


def _cut(
    together: int,
    system: LinearPeriodic,
    speed: ArrayLike,
    parameters: Mapping[str, ArrayLike],
    options: Mapping[str, Any],
    executor: Executor,
) -> tuple[Workers, list[_Item], tuple[int, ...]]:
    """Return workers, fixed pieces of the flat batch, and the batch's shape."""
    from ..floquet.first_order import at_geometry, numbers

    made, rest = at_geometry(system, parameters)
    given = {"speed": numbers("speed", speed)}
    given |= {name: numbers(name, value) for name, value in rest.items()}
    try:
        batch = np.broadcast_shapes(*(value.shape for value in given.values()))
    except ValueError as reason:
        shapes = {name: value.shape for name, value in given.items()}
        fix = "reshape them"
        raise bad("speed and parameters", shapes, "shapes that broadcast", fix) from reason
    flat = {name: np.broadcast_to(value, batch).ravel() for name, value in given.items()}
    count = len(flat["speed"])
    if not count:
        raise bad("speed", "no speed at all", "at least one speed [rad/s]", "give some")
    items = [
        {name: value[start : start + together] for name, value in flat.items()}
        for start in range(0, count, together)
    ]
    return Workers(executor, _told, made, dict(options)), items, batch


def _done(
    workers: Workers, solve: Callable[[Any, _Item], Result], items: list[_Item], progress: bool
) -> list[Any]:
    """Return the results of all pieces in their order."""
    found: dict[int, Result] = {}
    done = 0
    with bar(progress, sum(len(item["speed"]) for item in items)) as tick:
        for number, result in workers.run(solve, items):
            found[number] = result
            done += len(items[number]["speed"])
            if tick is not None:
                tick(done)
    return [found[number] for number in range(len(items))]


def _told(system: LinearPeriodic, options: dict[str, Any]) -> tuple[LinearPeriodic, dict[str, Any]]:
    return system, options


def _some_multipliers(
    told: tuple[LinearPeriodic, dict[str, Any]], item: _Item
) -> FloquetMultipliers:
    from ..floquet.monodromy_matrix import floquet_multipliers

    system, options = told
    values: dict[str, Any] = {**options, **item}
    return floquet_multipliers(system, **values)


def _some_motions(told: tuple[LinearPeriodic, dict[str, Any]], item: _Item) -> SteadyState:
    from ..response.steady_state import without_warning

    system, options = told
    rest = {name: value for name, value in item.items() if name != "speed"}
    found = without_warning(system, item["speed"], options, rest)
    # Its shapes are methods of the system, which need not travel back.
    return replace(found, shapes=None)


def _joined(
    found: list[Any], batch: tuple[int, ...], names: tuple[str, ...]
) -> dict[str, AnyArray]:
    """Return arrays of all pieces in the shape of the batch."""
    whole = {}
    for name in names:
        array = np.concatenate([getattr(part, name) for part in found])
        whole[name] = array.reshape(*batch, *array.shape[1:])
    return whole


def _at_angles(part: SteadyState, count: int) -> SteadyState:
    """Return motions at more even angles, by their Fourier series: exactly what they are."""
    had = len(part.theta)
    if had == count:
        return part
    return replace(part, q=_finer(part.q, count), qd=_finer(part.qd, count))


def _finer(values: Array, count: int) -> Array:
    had = values.shape[-2]
    series = np.fft.rfft(values, axis=-2)
    if had % 2 == 0:
        # The highest one stands for both signs of its harmonic.
        series[..., -1, :] *= 0.5
    found: Array = np.fft.irfft(series, n=count, axis=-2) * (count / had)
    return found
