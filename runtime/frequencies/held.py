"""A mechanism with its crank held: natural frequencies, their means over a turn, buckling."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import numbers_in_a_row
from ..core.maxima import narrowed, summits
from ..core.trigonometric import even_angles
from ..periodic.moving_basis import flexible_modes

_EPS = float(np.finfo(float).eps)


class HeldModes(NamedTuple):
    """Natural frequencies and shapes at crank angles."""

    frequency: Array  # natural frequencies [rad/s], rising, (nt, n)
    shape: Array  # columns of unit modal mass, (nt, n, n)
    mass: Array  # M, (nt, n, n)
    error: Array  # round-off of the frequencies [rad/s], (nt, n)


@dataclass(frozen=True)
class HeldCrank:
    """A system with its crank held, under the axial forces of a crank speed [rad/s]."""

    system: LinearPeriodic
    parameters: Mapping[str, float]
    speed: float = 0.0

    def arrays(self, theta: Array) -> tuple[Array, Array]:
        """Return M and K + Kg at crank angles."""
        mass = self.system.array("M", theta, **self.parameters)
        stiffness = self.system.array("K", theta, **self.parameters)
        if self.system.has("Kg"):
            added = self.system.array("Kg", theta, self.speed, **self.parameters)
            stiffness = stiffness + added
        return mass, stiffness

    def modes(self, theta: Array) -> HeldModes:
        """Return natural frequencies and shapes at crank angles ``(nt,)`` [rad].

        A mass or stiffness that is not positive definite at some angle is refused.
        """
        mass, stiffness = self.arrays(theta)
        try:
            _, shape = flexible_modes(mass, stiffness)
        except np.linalg.LinAlgError:
            raise _indefinite(mass, stiffness, theta) from None
        # Rayleigh's quotients: what the shapes are wrong by enters squared; what is left is the
        # round-off of the sums.
        size, kinetic = np.abs(shape), np.sum(shape * (mass @ shape), axis=1)
        square = np.sum(shape * (stiffness @ shape), axis=1) / kinetic
        summed = np.sum(size * (np.abs(stiffness) @ size), axis=1)
        summed += square * np.sum(size * (np.abs(mass) @ size), axis=1)
        shape, frequency = shape / np.sqrt(kinetic)[:, None, :], np.sqrt(square)
        order = np.argsort(square, axis=1, kind="stable")
        return HeldModes(
            np.take_along_axis(frequency, order, axis=1),
            np.take_along_axis(shape, order[:, None, :], axis=2),
            mass,
            np.take_along_axis(_EPS * summed / (kinetic * frequency), order, axis=1),
        )


def held_frequencies(
    system: LinearPeriodic, theta: Array, parameters: Mapping[str, float], speed: float = 0.0
) -> tuple[Array, Array]:
    """Return natural frequencies [rad/s] at crank angles and their round-off, ``(nt, n)`` each."""
    held = HeldCrank(system, parameters, speed).modes(theta)
    return held.frequency, held.error


def _indefinite(mass: Array, stiffness: Array, theta: Array) -> BadInput:
    """Return the refusal of the mass, or else of the stiffness, with its smallest eigenvalue."""
    both = (matrix + np.swapaxes(matrix, -1, -2) for matrix in (mass, stiffness))
    of_mass, of_stiffness = (np.min(np.linalg.eigvalsh(matrix / 2), axis=-1) for matrix in both)
    name, lowest = "mass M", of_mass
    if np.min(of_mass) > 0.0:
        name, lowest = "stiffness K + Kg", of_stiffness
    angle = theta[np.argmin(lowest)]
    found = f"smallest eigenvalue {np.min(lowest):.3g} at crank angle {angle:.6g}"
    fix = "check the parameters; a rigid or buckled motion has no natural frequency"
    return bad(name, found, "a positive definite matrix at every angle", fix)


def crank_angles(system: LinearPeriodic, theta: ArrayLike | None) -> Array:
    """Return checked crank angles; 361 over a period by default."""
    if theta is None:
        return np.linspace(0.0, system.period, 361)
    angles = numbers_in_a_row("theta", theta, " [rad]")
    # Beyond that an angle has no digit left of its place in the period.
    largest = np.max(np.abs(angles))
    if largest > 1e12:
        raise bad("theta", f"{largest:g}", "angles up to 1e12 rad", "take whole periods off")
    return angles


def assurance(first: Array, second: Array, mass: Array, *, squared: bool = True) -> Array:
    """Return the mass-weighted assurance of shapes (columns), or its root with a sign.

    ``(u^T M v)^2 / (u^T M u  v^T M v)``: 1 of the same shape, 0 of shapes without a common part.
    """
    product = np.swapaxes(first, -1, -2) @ mass @ second
    one = np.einsum("...ik,...ij,...jk->...k", first, mass, first)
    other = np.einsum("...ik,...ij,...jk->...k", second, mass, second)
    root: Array = product / np.sqrt(one[..., :, None] * other[..., None, :])
    return root**2 if squared else root


# Crank angles to values and their round-off, both (nt, k).
Values = Callable[[Array], tuple[Array, Array]]

# Nodes of a panel by both rules, and how often one is halved.
_NODES = (10, 16)
_HALVINGS = 24


def cycle_mean(
    values: Values, period: float, breaks: Sequence[float] = (), *, enough: float = 1e-12
) -> tuple[Array, Array]:
    """Return means over the period and their errors, ``(k,)`` each, to a relative ``enough``.

    By the trapezoidal rule, which converges geometrically where the values are analytic.  Where
    that is slow, by Gauss-Legendre panels that end at the given ``breaks`` and are halved where
    their error is: near a veering the values are analytic in a narrow strip, at a crossing their
    order changes.
    """
    before: Array | float = np.inf
    for count in (64, 128, 256) if len(breaks) else (64, 128, 256, 512, 1024):
        value, error = values(even_angles(period, count))
        # Row by row a plain sum would add a round-off for every angle.
        found = np.array([math.fsum(column) for column in value.T]) / count
        rounding = error.mean(axis=0) + _EPS * np.abs(found)
        change = np.abs(found - before)
        if np.all(change <= enough * np.abs(found) + rounding):
            return found, change + rounding
        before = found
    return _by_panels(values, period, breaks, enough)


def mean_frequencies(
    system: LinearPeriodic,
    count: int,
    enough: float,
    speed: float = 0.0,
    parameters: Mapping[str, float] | None = None,
) -> tuple[Array, Array]:
    """Return the means of the lowest frequencies over the period and their errors [rad/s]."""

    def lowest(theta: Array) -> tuple[Array, Array]:
        frequency, error = held_frequencies(system, theta, parameters or {}, speed)
        return frequency[:, :count], error[:, :count]

    return cycle_mean(lowest, system.period, enough=enough)


def _by_panels(
    values: Values, period: float, breaks: Sequence[float], enough: float
) -> tuple[Array, Array]:
    """Return means by panels, each halved until two rules agree."""
    inner = np.unique(np.asarray(breaks, dtype=float) % period)
    start = float(inner[0]) if len(inner) else 0.0
    ends = np.concatenate([inner, start + period * np.arange(13) / 12])
    ends = np.unique(np.clip(ends, start, start + period))
    panels = np.stack([ends[:-1], ends[1:]], axis=1)
    total: Array | float = 0.0
    error: Array | float = 0.0
    for step in range(_HALVINGS + 1):
        coarse, _ = _panel_integrals(values, panels, _NODES[0])
        fine, rounding = _panel_integrals(values, panels, _NODES[1])
        gap = np.abs(fine - coarse)
        share = (panels[:, 1] - panels[:, 0])[:, None] / period
        allowed = enough * np.abs(fine) + rounding + 0.1 * enough * share * np.max(np.abs(fine))
        # Panels open at once, beyond which their error is added instead.
        last = step == _HALVINGS or len(panels) > 48
        good = np.all(gap <= allowed, axis=1) | last
        total = total + np.sum(fine[good], axis=0)
        error = error + np.sum(gap[good] + rounding[good], axis=0)
        if np.all(good):
            break
        rest = panels[~good]
        middle = rest.mean(axis=1)
        panels = np.concatenate(
            [np.stack([rest[:, 0], middle], axis=1), np.stack([middle, rest[:, 1]], axis=1)]
        )
    return np.asarray(total / period), np.asarray(error / period)


def _panel_integrals(values: Values, panels: Array, nodes: int) -> tuple[Array, Array]:
    """Return the integral over each panel and its round-off, ``(panels, k)``."""
    place, weight = np.polynomial.legendre.leggauss(nodes)
    half = 0.5 * (panels[:, 1] - panels[:, 0])[:, None]
    theta = panels.mean(axis=1)[:, None] + half * place
    both = np.reshape(values(theta.ravel()), (2, *theta.shape, -1))
    found, rounding = np.einsum("pn,vpnk->vpk", half * weight, both)
    return found, rounding + 4 * _EPS * np.abs(found)


@dataclass(frozen=True)
class Buckling:
    """Least crank speed at which ``K + Kg`` is singular at some crank angle."""

    speed: float  # [rad/s]; inf where no speed buckles the mechanism
    angle: float  # crank angle [rad]


def buckling_speed(system: LinearPeriodic, **parameters: float) -> Buckling:
    """Return the least crank speed at which the axial forces buckle the held mechanism.

    Beyond it a link that is pressed has, over a part of the turn, no natural frequency: frozen
    analyses end there.  The moving mechanism need not be unstable, as it passes that part quickly.
    The speed is exact to round-off at its angle, which is the worst one to 1e-6 of the period.

    Parameters
    ----------
    system : LinearPeriodic
        Whose geometric stiffness grows with the square of the speed, constant loads aside.
    **parameters : float
        Parameters to change.

    Returns
    -------
    Buckling
        The speed [rad/s], inf where none buckles it, and the crank angle [rad].

    Raises
    ------
    BadInput
        If the system is of another kind, a parameter is unknown or unusable, or the stiffness at
        rest is not positive definite at some angle.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.frequencies.buckling_speed(system)
    >>> print(round(float(found.speed), 1), round(found.angle, 2))
    88.3 0.66
    """
    require_system(system)
    if not system.has("Kg"):
        return Buckling(np.inf, 0.0)
    theta = even_angles(system.period, 256)
    near = theta[summits(_softening(system, theta, parameters))]

    def softening(places: Array) -> Array:
        return _softening(system, places.ravel(), parameters).reshape(places.shape)

    low, high = narrowed(softening, near - theta[1], near + theta[1], 15)
    angles = 0.5 * (low + high)
    reached = _softening(system, angles, parameters)
    best = int(np.argmax(reached))
    speed = 1.0 / np.sqrt(reached[best]) if reached[best] > 0.0 else np.inf
    return Buckling(speed, float(angles[best]) % system.period)


def _softening(system: LinearPeriodic, theta: Array, parameters: dict[str, float]) -> Array:
    """Return, at each angle, the largest eigenvalue of -(what a unit speed adds) over K."""
    mass, resting = HeldCrank(system, parameters).arrays(theta)
    added = HeldCrank(system, parameters, 1.0).arrays(theta)[1] - resting
    try:
        half = np.linalg.inv(np.linalg.cholesky(resting))
    except np.linalg.LinAlgError:
        raise _indefinite(mass, resting, theta) from None
    reduced = -half @ added @ np.swapaxes(half, -1, -2)
    return np.asarray(np.linalg.eigvalsh(0.5 * (reduced + np.swapaxes(reduced, -1, -2)))[:, -1])
