"""Nonlinear systems under a periodic drive, in coordinates without constraints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple, Protocol

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

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> from elastolink.runtime.core.families import Varied
    >>> def duffing(q, qd, qdd, drive, parameters, derivatives=True):
    ...     rest = qdd + 0.05 * qd + q + 0.05 * q**3 - 0.3 * np.cos(drive.angle)[..., None]
    ...     one = np.ones((*rest.shape, 1))
    ...     return Varied(rest, one, 0.05 * one, 1.0 + 0.15 * q[..., None] ** 2)
    >>> curve = el.response_curve(el.Nonlinear(1, duffing), "speed", (0.8, 1.6))
    >>> print(curve.special, curve.special_value.round(2))
    ('fold', 'fold') [1.33 1.13]
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
    """

    # (parameters, drive) to the constrained system, with variations, at these; its time is the
    # drive's angle over the speed.
    make: Callable[[Mapping[str, float], Drive], Constrained]
    free: tuple[int, ...]  # places of the n free coordinates
    held: tuple[int, ...]  # places of the others, as many as there are constraints
    # (q, drive, parameters) to the others near a state, (*batch, k).
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
        system, time, held, free = self.make(parameters, drive), _time(q, drive), *self._places
        x, at, inverse = self._closed(system, q, drive, parameters, time)
        basis = np.zeros((*x.shape, len(self.free)))
        basis[..., list(self.free), np.arange(len(self.free))] = 1.0
        basis[..., held, :] = follow = -inverse @ at["jacobian"][..., free]
        if "velocity_rhs" not in at:  # which depends on the place alone
            at = system.dynamics(x, np.zeros_like(x), time)
        xd, xdd = np.empty_like(x), np.empty_like(x)
        xd[..., free], xdd[..., free] = qd, qdd
        rate = follow @ qd[..., None] + inverse @ at["velocity_rhs"]
        xd[..., held] = rate[..., 0]
        terms = system.dynamics(x, xd, time)
        rate = follow @ qdd[..., None] + inverse @ terms["gamma"]
        xdd[..., held] = rate[..., 0]
        left = terms["mass"] @ xdd[..., None] + terms["rest"] - terms["forces"]
        back = basis.mT
        residual = (back @ left)[..., 0]
        if not derivatives:
            return Varied(residual)
        assert system.variations is not None
        forces = inverse.mT @ left[..., held, :]
        varied = system.variations(x, xd, xdd, forces[..., 0], time)
        turning = varied["jacobian_rate"]
        rate, change = np.zeros_like(basis), np.zeros_like(basis)
        rate[..., held, :] = turned = -inverse @ (turning @ basis)
        changed = varied["jacobian_acceleration"] @ basis + 2.0 * turning[..., held] @ turned
        change[..., held, :] = -inverse @ changed
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

    @cached_property
    def _places(self) -> tuple[Any, Any]:
        """Places of the coordinates held and free, slices where they stand together."""
        together = (
            slice(each[0], each[-1] + 1) if each and np.all(np.diff(each) == 1) else list(each)
            for each in (self.held, self.free)
        )
        held, free = together
        return held, free

    def _closed(
        self,
        system: Constrained,
        q: Array,
        drive: Drive,
        parameters: Mapping[str, float],
        time: Array,
    ) -> tuple[Array, Mapping[str, Array], Array]:
        """Return coordinates on the constraints, and the arrays of the constraints there."""
        # And the inverse of the Jacobian by the coordinates held, (*batch, k, k).
        held, free = self._places
        x = np.empty((*q.shape[:-1], len(self.free) + len(self.held)))
        x[..., free] = q
        x[..., held] = self.guess(q, drive, parameters)
        last = np.inf
        for _ in range(CLOSING):
            at = system.violation(x, time)
            inverse: Array = np.asarray(np.linalg.inv(at["jacobian"][..., held]), dtype=np.float64)
            change = (inverse @ at["constraints"])[..., 0]
            x[..., held] -= change
            size = float(np.max(np.abs(change), initial=0.0))
            if is_last(size, last):
                return x, at, inverse
            last = size
        raise SelfCheckFailed("the loop of the linkage cannot be closed at a state")


def _time(q: Array, drive: Drive) -> Array:
    """Return the time since the drive's angle was 0, at its present speed; shape batch."""
    speed = np.asarray(drive.speed, dtype=float)
    angle = np.broadcast_to(np.asarray(drive.angle, dtype=float), q.shape[:-1])
    return np.asarray(np.divide(angle, speed, out=np.zeros(q.shape[:-1]), where=speed != 0.0))


# Corrections of the coordinates that close a loop, and the change (rad, m) that is the last.
CLOSING, _CLOSE = 30, 1e-13


def is_last(size: float, before: float) -> bool:
    """Return True where a correction that closes a loop, after one before, leaves round-off."""
    # Newton squares what is left; a change that no longer falls is round-off.
    return size <= _CLOSE or (size <= 1e-10 and size >= 0.5 * before)
