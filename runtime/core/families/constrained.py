"""Systems with holonomic constraints, in redundant coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from .emitted import Places, Values, array_function, parameter_values
from .linear_periodic import Array
from .multipliers import solve_multipliers

External = Callable[[Array, Array], ArrayLike]
Margin = Callable[[float, Array, Array], float]


class Guard(NamedTuple):
    """A condition under which a motion stops.

    Attributes
    ----------
    margin : callable
        ``margin(t, q, qd)``, positive while the motion may go on; ``q`` and ``qd`` of shape
        ``(n,)``.
    reason : str
        Why it stops, for the message: ``the slider left the rod's end``.
    """

    margin: Margin
    reason: str


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

    @classmethod
    def from_module(
        cls,
        module: ModuleType,
        parameters: Values,
        *,
        external: Mapping[str, External] | None = None,
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
            ``q (*batch, n)`` and ``t`` that return shape ``batch``.
        provenance : mapping, optional
            Where the module comes from.

        Raises
        ------
        BadInput
            If the module is of another family, or a parameter or external function is missing.
        """
        values = parameter_values(module, "constrained", parameters)
        given = dict(external or {})
        missing = sorted(set(module.EXTERNAL) - set(given))
        if missing:
            raise bad("external", f"none for {missing}", "a function of q and t each", "pass them")

        def at(name: str) -> _AtState:
            return _AtState(module, name, given, values)

        return cls(
            len(module.COORDINATES),
            len(module.MULTIPLIERS),
            at("dynamics"),
            at("constraints"),
            at("variations") if "variations" in module.ARRAYS else None,
            labels=module.COORDINATES,
            provenance=dict(provenance or {}),
        )

    def accelerations(self, q: Array, qd: Array, t: ArrayLike = 0.0) -> tuple[Array, Array]:
        """Solve for the accelerations and multipliers at a state that meets the constraints.

        Parameters
        ----------
        q, qd : ndarray, shape (*batch, n)
            Coordinates and velocities.
        t : array_like, shape batch
            Time [s].

        Returns
        -------
        qdd : ndarray, shape (*batch, n)
            Accelerations.
        multipliers : ndarray, shape (*batch, k)
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


@dataclass(frozen=True)
class _AtState:
    """An emitted function of the state's components as one of whole vectors."""

    module: ModuleType
    name: str
    given: Mapping[str, External]
    values: Mapping[str, ArrayLike]

    @cached_property
    def _single(self) -> tuple[Callable[..., object], _Places] | None:
        """The bare function and where its numbers go; None where parameters are arrays."""
        function = getattr(self.module, self.name, None)
        if function is None or not all(isinstance(v, float) for v in self.values.values()):
            return None
        return function, _Places.of(self.module.ARRAYS[self.name])

    @cached_property
    def _batched(self) -> Callable[..., Mapping[str, Array]]:
        return array_function(self.module, self.name)

    def with_functions(self, change: Callable[[ModuleType], ModuleType]) -> _AtState:
        """Return the same of a changed module, for example a compiled one."""
        return _AtState(change(self.module), self.name, self.given, self.values)

    def __call__(self, *arguments: ArrayLike) -> Mapping[str, Array]:
        """Evaluate at coordinates, more vectors, and time last."""
        *vectors, time = (np.asarray(argument, dtype=float) for argument in arguments)
        passed = {name: self.given[name](vectors[0], time) for name in self.module.EXTERNAL}
        alone = time.ndim == 0 and all(vector.ndim == 1 for vector in vectors)
        if alone and self._single is not None:
            # Plain floats are five times faster than arrays of no dimension.
            function, places = self._single
            state = [number for vector in vectors for number in vector.tolist()]
            try:
                return places.filled(function(*state, float(time), **passed, **self.values))
            except (OverflowError, ZeroDivisionError):
                pass  # plain floats refuse what arrays return as infinite
        columns = [vector[..., i] for vector in vectors for i in range(vector.shape[-1])]
        return self._batched(*columns, time, **passed, **self.values)


@dataclass(frozen=True)
class _Places:
    """Where the numbers of an emitted function go in one long vector, and its parts by name."""

    size: int
    target: NDArray[np.intp]
    source: tuple[int, ...]
    parts: tuple[tuple[str, int, int, tuple[int, int]], ...]

    @classmethod
    def of(cls, arrays: Places) -> _Places:
        target: list[int] = []
        source: list[int] = []
        parts = []
        start = 0
        for name, (shape, filled) in arrays.items():
            stop = start + shape[0] * shape[1]
            parts.append((name, start, stop, shape))
            target += [start + row * shape[1] + column for row, column, _ in filled]
            source += [position for _, _, position in filled]
            start = stop
        return cls(start, np.array(target, dtype=np.intp), tuple(source), tuple(parts))

    def filled(self, returned: object) -> dict[str, Array]:
        """Return the arrays by name."""
        entries = returned if isinstance(returned, tuple) else (returned,)
        whole: Array = np.zeros(self.size)
        whole[self.target] = [entries[i] for i in self.source]
        return {name: whole[a:b].reshape(shape) for name, a, b, shape in self.parts}
