"""Systems with holonomic constraints, in redundant coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from ..errors import bad
from .emitted import Values, array_function, parameter_values
from .linear_periodic import Array

External = Callable[[Array, Array], ArrayLike]


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
        ``M dqdd + damping dqd + stiffness dq = Phi_q^T dlam``.
    labels : tuple of str
        Names of the coordinates.
    provenance : mapping
        Module and options that the system was made from.
    """

    size: int
    constraints: int
    dynamics: Callable[[Array, Array, ArrayLike], Mapping[str, Array]]
    violation: Callable[[Array, ArrayLike], Mapping[str, Array]]
    variations: Callable[..., Mapping[str, Array]] | None = None
    labels: tuple[str, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)

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
            return _AtState(array_function(module, name), module.EXTERNAL, given, values)

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
        """
        a = self.dynamics(q, qd, t)
        n, k = self.size, self.constraints
        batch = a["mass"].shape[:-2]
        matrix = np.zeros((*batch, n + k, n + k))
        matrix[..., :n, :n] = a["mass"]
        matrix[..., :n, n:] = -np.swapaxes(a["jacobian"], -1, -2)
        matrix[..., n:, :n] = a["jacobian"]
        right = np.concatenate([a["forces"] - a["rest"], a["gamma"]], axis=-2)
        solved = np.linalg.solve(matrix, right)[..., 0]
        return solved[..., :n], solved[..., n:]


@dataclass(frozen=True)
class _AtState:
    """An emitted function of the state's components as one of whole vectors."""

    function: Callable[..., Mapping[str, Array]]
    external: tuple[str, ...]
    given: Mapping[str, External]
    values: Mapping[str, ArrayLike]

    def __call__(self, *arguments: ArrayLike) -> Mapping[str, Array]:
        """Evaluate at coordinates, more vectors, and time last."""
        *vectors, time = (np.asarray(argument, dtype=float) for argument in arguments)
        columns = [vector[..., i] for vector in vectors for i in range(vector.shape[-1])]
        passed = {name: self.given[name](vectors[0], time) for name in self.external}
        return self.function(*columns, time, **passed, **self.values)
