"""Nonlinear systems under a periodic drive, in coordinates without constraints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..errors import SelfCheckFailed, bad
from ..inputs import is_finite, require_whole
from .constrained import Constrained
from .linear_periodic import Array


class Drive(NamedTuple):
    """The angle of the crank and its rates; arrays that broadcast with the states.

    Of a system that no crank drives the angle is that of its periodic load.
    """

    angle: ArrayLike  # [rad]
    speed: ArrayLike  # [rad/s]
    acceleration: ArrayLike = 0.0  # [rad/s^2]


_NONE: Array = np.empty(0)


class Varied(NamedTuple):
    """What is left of the equations at states, and its derivatives by the state.

    ``mass``, ``damping``, ``stiffness`` are the derivatives by q'', q' and q, ``(*batch, n, n)``
    each, and empty where they were not asked for.
    """

    residual: Array  # (*batch, n)
    mass: Array = _NONE
    damping: Array = _NONE
    stiffness: Array = _NONE


class Equations(Protocol):
    """``r(q, q', q'', drive; parameters)``, which vanishes along a motion."""

    def __call__(
        self,
        q: Array,
        qd: Array,
        qdd: Array,
        drive: Drive,
        parameters: Mapping[str, float],
        derivatives: bool = True,
    ) -> Varied:
        """Return the residual at states ``(*batch, n)``, with its derivatives where wanted."""


@dataclass(frozen=True)
class Nonlinear:
    """``r(q, q', q'', theta, theta', theta''; parameters) = 0``, periodic in theta by 2 pi.

    Attributes
    ----------
    size : int
        Number n of coordinates.
    equations : callable
        See :class:`Equations`; time in seconds.
    parameters : mapping of str to float
        Numbers of the equations by name, in SI units; the speed of the drive is none of them.
    labels : tuple of str
        Names of the coordinates.
    deflection : callable or None
        ``(q, parameters)`` to the deflection that is shown, such as that of a link's middle, in
        ``unit``; shape batch.  By default the first coordinate.
    watch : callable or None
        ``q`` to the largest deflection over the length of the link, shape batch.
    unit : str
        Unit of the deflection.
    small : float
        Size of the coordinates, and of their rates by the drive's angle, below which their errors
        are absolute.
    limits : mapping of str to str
        Parameters that have to be ``positive`` or ``non-negative``.
    provenance : mapping
        Scene and module that the system was made from.
    """

    size: int
    equations: Equations
    parameters: Mapping[str, float] = field(default_factory=dict)
    labels: tuple[str, ...] = ()
    deflection: Callable[[Array, Mapping[str, float]], Array] | None = None
    watch: Callable[[Array], Array] | None = None
    unit: str = ""
    small: float = 1e-3
    limits: Mapping[str, str] = field(default_factory=dict)
    provenance: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_whole("size", self.size, 1, 1000)
        if not self.labels:
            object.__setattr__(self, "labels", tuple(f"q{i + 1}" for i in range(self.size)))

    def shown(self, q: Array, parameters: Mapping[str, float] | None = None) -> Array:
        """Return the deflection that is shown at states ``(*batch, n)``, shape batch."""
        if self.deflection is None:
            return q[..., 0]
        return self.deflection(q, self.parameters if parameters is None else parameters)

    def with_parameters(self, **changes: float) -> Nonlinear:
        """Return the system with other numbers.

        Raises ``BadInput`` for a name that is none, and for a value beyond its limit.
        """
        for name, value in changes.items():
            if name not in self.parameters:
                raise bad("parameters", name, f"one of {sorted(self.parameters)}", "correct it")
            limit = self.limits.get(name, "any")
            low = {"positive": np.nextafter(0.0, 1.0), "non-negative": 0.0}.get(limit, -np.inf)
            if not (is_finite(value) and value >= low):
                expected = "a finite number" if limit == "any" else f"a {limit} number"
                raise bad(name, repr(value), expected, "correct it")
        return replace(self, parameters={**self.parameters, **changes})


@dataclass(frozen=True)
class Reduced:
    """The equations of a constrained system in those of its coordinates that move freely.

    The constraints give the others, at all three levels; projected on the motions that they
    allow the equations lose the constraint forces, and the variational equations, emitted with
    the multipliers, give the exact derivatives: with ``J G = 0``, ``x' = G q' + b``::

        r = G^T (M x'' + c - Q),     dr/dq'' = G^T M G,
        dr/dq' = G^T (2 M G' + D G),     dr/dq = G^T (M G'' + D G' + K G).

    Attributes
    ----------
    make : callable
        ``(parameters, drive)`` to the constrained system, with variations, at these; its time is
        the drive's angle over the speed.
    free : tuple of int
        Places of the n free coordinates.
    held : tuple of int
        Places of the others, as many as there are constraints.
    guess : callable
        ``(q, drive, parameters)`` to the others near a state, ``(*batch, k)``.
    """

    make: Callable[[Mapping[str, float], Drive], Constrained]
    free: tuple[int, ...]
    held: tuple[int, ...]
    guess: Callable[[Array, Drive, Mapping[str, float]], Array]

    def __call__(
        self,
        q: Array,
        qd: Array,
        qdd: Array,
        drive: Drive,
        parameters: Mapping[str, float],
        derivatives: bool = True,
    ) -> Varied:
        """Return the residual at states ``(*batch, n)``, with its derivatives where wanted."""
        system, time = self.make(parameters, drive), _time(q, drive)
        x, at = self._closed(system, q, drive, parameters, time)
        basis, inverse = self._basis(at["jacobian"])
        if "velocity_rhs" not in at:  # which depends on the place alone
            at = system.dynamics(x, np.zeros_like(x), time)
        xd = (basis @ qd[..., None])[..., 0]
        xd[..., list(self.held)] += (inverse @ at["velocity_rhs"])[..., 0]
        terms = system.dynamics(x, xd, time)
        xdd = (basis @ qdd[..., None])[..., 0]
        xdd[..., list(self.held)] += (inverse @ terms["gamma"])[..., 0]
        left = terms["mass"] @ xdd[..., None] + terms["rest"] - terms["forces"]
        back = np.swapaxes(basis, -1, -2)
        residual = (back @ left)[..., 0]
        if not derivatives:
            return Varied(residual)
        assert system.variations is not None
        forces = np.swapaxes(inverse, -1, -2) @ left[..., list(self.held), :]
        varied = system.variations(x, xd, xdd, forces[..., 0], time)
        rate, change = np.zeros_like(basis), np.zeros_like(basis)
        rate[..., list(self.held), :] = -inverse @ (varied["jacobian_rate"] @ basis)
        turned = varied["jacobian_acceleration"] @ basis + 2.0 * varied["jacobian_rate"] @ rate
        change[..., list(self.held), :] = -inverse @ turned
        mass, damping = terms["mass"], varied["damping"]
        return Varied(
            residual,
            back @ mass @ basis,
            back @ (2.0 * mass @ rate + damping @ basis),
            back @ (mass @ change + damping @ rate + varied["stiffness"] @ basis),
        )

    def whole(self, q: Array, drive: Drive, parameters: Mapping[str, float]) -> Array:
        """Return all coordinates of the constrained system, ``(*batch, n + k)``."""
        system = self.make(parameters, drive)
        return self._closed(system, q, drive, parameters, _time(q, drive))[0]

    def _basis(self, jacobian: Array) -> tuple[Array, Array]:
        """Return G ``(*batch, n + k, n)``, and the inverse of the Jacobian by those held."""
        inverse: Array = np.asarray(np.linalg.inv(jacobian[..., list(self.held)]), dtype=np.float64)
        basis = np.zeros((*jacobian.shape[:-2], jacobian.shape[-1], len(self.free)))
        basis[..., list(self.free), np.arange(len(self.free))] = 1.0
        basis[..., list(self.held), :] = -inverse @ jacobian[..., list(self.free)]
        return basis, inverse

    def _closed(
        self,
        system: Constrained,
        q: Array,
        drive: Drive,
        parameters: Mapping[str, float],
        time: Array,
    ) -> tuple[Array, Mapping[str, Array]]:
        """Return coordinates on the constraints, and the arrays of the constraints there."""
        x = np.empty((*q.shape[:-1], len(self.free) + len(self.held)))
        x[..., list(self.free)] = q
        x[..., list(self.held)] = self.guess(q, drive, parameters)
        last = np.inf
        for _ in range(_CLOSING):
            at = system.violation(x, time)
            change = np.linalg.solve(at["jacobian"][..., list(self.held)], -at["constraints"])[
                ..., 0
            ]
            x[..., list(self.held)] += change
            size = float(np.max(np.abs(change), initial=0.0))
            # Newton squares what is left; a change that no longer falls is round-off.
            if size <= _CLOSE or (size <= 1e-10 and size >= 0.5 * last):
                return x, at
            last = size
        raise SelfCheckFailed("the loop of the linkage cannot be closed at a state")


def _time(q: Array, drive: Drive) -> Array:
    """Return the time since the drive's angle was 0, at its present speed; shape batch."""
    speed = np.asarray(drive.speed, dtype=float)
    angle = np.broadcast_to(np.asarray(drive.angle, dtype=float), q.shape[:-1])
    return np.asarray(np.divide(angle, speed, out=np.zeros(q.shape[:-1]), where=speed != 0.0))


# Corrections of the coordinates that close a loop, and the change (rad, m) that is the last.
_CLOSING, _CLOSE = 30, 1e-13
