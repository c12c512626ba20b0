"""Systems with holonomic constraints, in redundant coordinates."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..errors import bad
from ..inputs import require_whole
from .emitted import Places, Values, dropped_names, nothing, parameter_values, stacked
from .linear_periodic import Array
from .multipliers import solve_multipliers

External = Callable[[Array, Array], ArrayLike]
Margin = Callable[[float, Array, Array], float]


class Guard(NamedTuple):
    """A condition under which a motion stops."""

    margin: Margin  # ``margin(t, q, qd)``, positive while the motion may go on; q, qd (n,)
    reason: str  # why it stops, for the message: ``the slider left the rod's end``


@dataclass(frozen=True)
class Constrained:
    """``M(q, t) qdd + c(q, qd, t) = Phi_q^T lam + Q(q, qd, t)``,  ``Phi(q, t) = 0``.

    Attributes
    ----------
    size, constraints : int
        Number n of coordinates and k of constraints.
    dynamics : callable
        ``(q, qd, t)`` of shapes ``(*batch, n)``, ``(*batch, n)``, ``batch`` to a mapping with
        ``mass (n, n)``, ``rest (n, 1)``, ``forces (n, 1)``, ``jacobian (k, n)``,
        ``velocity_rhs (k, 1)``, ``gamma (k, 1)``, each behind ``batch``.
    violation : callable
        ``(q, t)`` to a mapping with ``constraints (k, 1)`` and ``jacobian (k, n)``.
    variations : callable or None
        ``(q, qd, qdd, lam, t)`` to a mapping with ``damping (n, n)`` and ``stiffness (n, n)`` of
        ``M dqdd + damping dqd + stiffness dq = Phi_q^T dlam``, and ``jacobian_rate (k, n)`` and
        ``jacobian_acceleration (k, n)``, the time derivatives of the Jacobian along the motion:
        ``J dqdd + 2 Jd dqd + Jdd dq = 0``.
    labels : tuple of str
        Names of the coordinates.
    provenance : mapping
        Module and options that the system was made from.
    period : float or None
        Period of its dependence on time [s].
    advance : ndarray, shape () or (n,)
        What the coordinates of a periodic motion gain over a period: 2 pi for a link that turns.
    reference : callable or None
        Times, shape batch, to coordinates and velocities ``(*batch, n)`` of a motion that meets
        the constraints: from it a motion starts, and near it a periodic one is sought.
    watch : callable or None
        ``(q, t)`` to the largest deflection over the length of the link, shape batch.
    guards : tuple of Guard
        Conditions beyond which the equations mean nothing.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "free_free", "model.modes": 2}
    >>> rod = el.load_scene("beale_1992_flexible_rod", changes).system()
    >>> print(rod.labels, rod.constraints)
    ('R1', 'R2', 'gamma', 'f1', 'f2') 3
    """

    size: int
    constraints: int
    dynamics: Callable[[Array, Array, ArrayLike], Mapping[str, Array]]
    violation: Callable[[Array, ArrayLike], Mapping[str, Array]]
    variations: Callable[..., Mapping[str, Array]] | None = None
    labels: tuple[str, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)
    period: float | None = None
    advance: ArrayLike = 0.0
    reference: Callable[[Array], tuple[Array, Array]] | None = None
    watch: Callable[[Array, Array], ArrayLike] | None = None
    guards: tuple[Guard, ...] = ()

    def __post_init__(self) -> None:
        require_whole("size", self.size, 1, 100_000)
        if not self.labels:
            object.__setattr__(self, "labels", tuple(f"q{i + 1}" for i in range(self.size)))

    @classmethod
    def from_module(
        cls,
        module: ModuleType,
        parameters: Values,
        *,
        external: Mapping[str, External] | None = None,
        modes: Values | None = None,
        drop: Collection[str] = (),
        provenance: Mapping[str, str] | None = None,
    ) -> Constrained:
        """Return the system of an emitted module at given parameter values.

        Parameters
        ----------
        module : module
            Emitted, with ``FAMILY = "constrained"``.
        parameters : mapping
            Its parameters, in SI units; arrays broadcast with the state.
        external : mapping, optional
            What the module wants passed in, by argument name (its ``EXTERNAL``): functions of
            ``q (*batch, n)`` and ``t`` that return shape ``batch``, or ``(*batch, N)`` where the
            module has one of each of N modes.
        modes : mapping, optional
            Numbers of the modes ``(N,)`` and of pairs of them ``(N, N)`` by name, for a module
            that serves any number of modes (its ``MODES``).
        drop : collection of str
            Terms to leave out (of the module's ``DROPS``): numbers of modes that vanish,
            constraints that are released.
        provenance : mapping, optional
            Where the module comes from.

        Raises
        ------
        BadInput
            If the module is of another family, if a parameter, external function or number of
            modes is missing, or if the module cannot drop a term.
        """
        values = parameter_values(module, "constrained", parameters)
        dropped = dropped_names(module, drop)
        values |= {name: 0.0 for name in dropped if name in values}
        given = dict(external or {})
        missing = sorted(set(module.EXTERNAL) - set(given))
        if missing:
            raise bad("external", f"none for {missing}", "a function of q and t each", "pass them")

        kept = [i for i, name in enumerate(module.MULTIPLIERS) if name not in dropped]
        if hasattr(module, "MODES"):
            numbers = _mode_numbers(module, modes or {}, dropped)
            count = len(numbers[module.MODES[1][0]])
            labels = (
                *module.COORDINATES[:-1],
                *(f"{module.MODES[0]}{i + 1}" for i in range(count)),
            )
        else:
            numbers, labels = {}, module.COORDINATES

        def at(name: str) -> _AtState:
            return _AtState(module, name, given, values, numbers, tuple(kept))

        return cls(
            len(labels),
            len(kept),
            at("dynamics"),
            at("constraints"),
            at("variations") if "variations" in module.ARRAYS else None,
            labels=labels,
            provenance=dict(provenance or {}),
        )

    def accelerations(self, q: Array, qd: Array, t: ArrayLike = 0.0) -> tuple[Array, Array]:
        """Solve for the accelerations and multipliers at a state that meets the constraints.

        Parameters
        ----------
        q, qd : ndarray, shape ``(*batch, n)``
            Coordinates and velocities.
        t : array_like, shape batch
            Time [s].

        Returns
        -------
        qdd : ndarray, shape ``(*batch, n)``
            Accelerations.
        multipliers : ndarray, shape ``(*batch, k)``
            Constraint forces ``lam``, with the sign of ``Phi_q^T lam`` on the right-hand side.

        Raises
        ------
        RedundantConstraints
            If the rows of the Jacobian depend on each other at a state, or the mass matrix leaves
            a motion that the constraints allow without inertia.
        """
        a = self.dynamics(q, qd, t)
        return solve_multipliers(
            a["mass"], a["jacobian"], (a["forces"] - a["rest"])[..., 0], a["gamma"][..., 0]
        )


# Arrays of an emitted module with a row for each constraint, beside its Jacobians.
_OF_CONSTRAINTS = ("constraints", "velocity_rhs", "gamma")
_OF_COORDINATES = 3  # vectors: coordinates, their rates, their accelerations; multipliers follow


def _mode_numbers(module: ModuleType, given: Values, dropped: Collection[str]) -> dict[str, Array]:
    """Return the numbers of modes and pairs, those of dropped terms being zero."""
    missing = sorted(set(module.MODES[1]) - set(given))
    if missing:
        raise bad("modes", f"none for {missing}", "numbers of each mode", "pass them")
    arrays = {name: np.asarray(given[name], dtype=float) for name in module.MODES[1]}
    return {name: array * (name not in dropped) for name, array in arrays.items()}


@dataclass(frozen=True)
class _AtState:
    """An emitted function of the state's components as one of whole vectors.

    Of a module for any number of modes the last coordinate is one of each mode, and ``numbers`` are
    what multiplies them; else there are none.  ``kept`` are the constraints that are not released.
    """

    module: ModuleType
    name: str
    given: Mapping[str, External]
    values: Mapping[str, ArrayLike]
    numbers: Mapping[str, Array]
    kept: tuple[int, ...]

    def __call__(self, *arguments: ArrayLike) -> Mapping[str, Array]:
        """Evaluate at coordinates, more vectors, and time last."""
        *vectors, time = (np.asarray(argument, dtype=float) for argument in arguments)
        places, blocks = self._layout
        row: tuple[Any, ...] | None = None
        batch: tuple[int, ...] = ()
        if self._plain and time.ndim == 0 and all(vector.ndim == 1 for vector in vectors):
            # Plain floats are several times faster than arrays of no dimension, but refuse what
            # these return as infinite.
            with suppress(OverflowError, ZeroDivisionError):
                row = self._row(vectors, time, np.ndarray.tolist)
        if row is None:
            shapes = [np.shape(value) for value in self.values.values()]
            shapes += [vector.shape[:-1] for vector in vectors]
            batch = np.broadcast_shapes(time.shape, *shapes)
            row = self._row(vectors, time, _columns)
        arrays = stacked(places, row, batch)
        first = len(self.module.COORDINATES) - 1
        for name, start, matrix in blocks:
            factor = np.asarray(row[start])[..., None, None]
            arrays[name][..., first:, first:] += factor * matrix
        return arrays

    @cached_property
    def _plain(self) -> bool:
        return all(isinstance(value, float) for value in self.values.values())

    @cached_property
    def _number_lists(self) -> list[Any]:
        return [array.tolist() for array in self.numbers.values()]

    def _row(
        self, vectors: list[Array], time: Array, listed: Callable[[Array], list[Any]]
    ) -> tuple[Any, ...]:
        """Call the function with vectors as lists of components, and write out what it returns."""
        first = len(self.module.COORDINATES) - 1
        taken: list[Any] = []
        for number, vector in enumerate(vectors):
            components = listed(vector)
            if self.numbers and number < _OF_COORDINATES:
                components = [*components[:first], components[first:]]
            taken += components
        taken.append(time[()] if time.ndim else float(time))
        for name in self.module.EXTERNAL:
            value = self.given[name](vectors[0], time)
            taken.append(listed(np.asarray(value)) if self.numbers else value)
        function = getattr(self.module, self.name, nothing)
        returned = function(*taken, *self.values.values(), *self._number_lists)
        if not isinstance(returned, tuple):
            return (returned,)
        if not self.numbers:
            return returned
        row: list[Any] = []
        for value in returned:
            row += value if isinstance(value, list) else [value]
        return tuple(row)

    @cached_property
    def _layout(self) -> tuple[Places, tuple[tuple[str, int, Array], ...]]:
        """Where the numbers go with all modes written out, and those that multiply matrices."""
        arrays = self.module.ARRAYS[self.name]
        if not self.numbers:
            written = {name: self._of_kept(name, *places) for name, places in arrays.items()}
            return written, ()
        first = len(self.module.COORDINATES) - 1
        matrices = {name: n if n.ndim == 2 else np.diag(n) for name, n in self.numbers.items()}
        count = len(next(iter(matrices.values())))
        # What is returned is written out in one row: a sequence has a place for each mode.
        sequences = {
            at
            for shape, filled in arrays.values()
            for i, j, at, *kind in filled
            if not kind and (first in (i, j) and first < shape[0 if i == first else 1])
        }
        size = 1 + max((at for _, filled in arrays.values() for _, _, at, *_ in filled), default=-1)
        starts = np.cumsum([0] + [count if at in sequences else 1 for at in range(size)])
        whole: dict[str, Any] = {}
        blocks = []
        for name, (shape, filled) in arrays.items():
            entries: list[tuple[int, int, int]] = []
            for i, j, at, *kind in filled:
                start = int(starts[at])
                if kind and kind[0] != "identity":
                    blocks.append((name, start, matrices[kind[0]]))
                elif kind:
                    entries += [(first + k, first + k, start) for k in range(count)]
                elif at in sequences:
                    rows = i == first < shape[0]
                    entries += [(i + k * rows, j + k * (not rows), start + k) for k in range(count)]
                else:
                    entries.append((i, j, start))
            full = tuple(n + count - 1 if n > first else n for n in shape)
            whole[name] = (full, tuple(entries))
        return whole, tuple(blocks)

    def _of_kept(self, name: str, shape: tuple[int, int], filled: Any) -> tuple[Any, Any]:
        """Return shape and places of an array without the rows of released constraints."""
        if name not in _OF_CONSTRAINTS and not name.startswith("jacobian"):
            return shape, filled
        rows = {row: place for place, row in enumerate(self.kept)}
        entries = tuple((rows[i], j, at) for i, j, at in filled if i in rows)
        return (len(rows), shape[1]), entries


def _columns(vectors: Array) -> list[Any]:
    """Return the components of vectors, each an array over the batch."""
    return [vectors[..., i] for i in range(vectors.shape[-1])]
