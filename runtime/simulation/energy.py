"""Energy balance of a computed motion: an independent check of solver and equations."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..core.errors import BadInput
from ..core.results import Check
from ..integrators.tableau import gauss_tableau
from ..periodic.first_order import CanonicalForm
from .marching import cyclic
from .spring_form import periodic_derivative

Array = NDArray[np.float64]

# Given angles that the balance covers; a longer motion is checked over its beginning.
_MOST = 50_001
# Quadrature error of a spline up to which nothing better is looked for, and beyond which the given
# angles may miss waves altogether.
_FINE, _COARSE = 1e-8, 1e-4
# Error of the energy that comes of the motion's figure, for each coordinate.
_SHARE = 20.0
_ROUNDING = 1e-12
# Stages of the motion between given angles: of the one taken, and of the one it is compared with;
# the fastest mode turns by a radian in a step.
_STAGES, _FEWER = 8, 6
# Steps of it, and cubes of the stage equations that are solved, in all; floats of those solved
# together.
_STEPS, _WORK, _TOGETHER = 1000, 3e8, 2_000_000


def energy_balance(
    form: CanonicalForm, theta: Array, q: Array, slope: Array, error: float
) -> Check | None:
    """Compare the change of energy with the work done, over a computed motion.

    With L2 the Lagrangian per speed squared, ``H = q'^T dL2/dq' - L2`` obeys
    ``dH/dtheta = -(partial L2/partial theta) + q'^T Q``, Q the damping and the forcing.  The
    right-hand side is integrated by a spline through the given angles where they are close
    enough; else along motions that start from each given state and go on to the next angle, by
    Gauss collocation.  Its error is told by half the angles, or by fewer stages.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    theta : ndarray
        Crank angles [rad], evenly spaced, shape ``(nt,)``.
    q, slope : ndarray
        Coordinates and d/dtheta, shape ``(nt, n)``.
    error : float
        Error figure of the motion, relative.

    Returns
    -------
    Check or None
        Value: largest imbalance on the way, at the end for a spline, over the largest energy met.
        Limit: from the error figure and the quadrature's own error; None where that error is too
        large for the check to say anything, where a coefficient jumps, or where even the first
        interval would take too long.  Of a long motion the beginning is looked at so closely, the
        whole by the spline alone.
    """
    theta, q, slope = theta[:_MOST], q[:_MOST], slope[:_MOST]
    if len(theta) < 2:
        return None
    # Energies of a motion near the bound may overflow; there is no balance to check then.
    with np.errstate(over="ignore", invalid="ignore"):
        try:
            return _Balance(form, theta, q, slope, error).check()
        except BadInput:  # a coefficient with jumps has no derivative to balance with
            return None


class _Balance:
    """Energy, power and work along one motion."""

    def __init__(
        self, form: CanonicalForm, theta: Array, q: Array, slope: Array, error: float
    ) -> None:
        self.form, self.theta, self.q, self.slope = form, theta, q, slope
        self.step = float(theta[1] - theta[0])
        # Arrays repeat with every revolution of even angles.
        self.once = theta[: max(1, round(2 * pi / self.step))] if cyclic(form) else theta
        self.passed_on = _SHARE * len(form.system.labels) * error + _ROUNDING
        kinetic = 0.5 * _form(form, "M", self.once, slope, slope)
        potential = 0.5 * (
            _form(form, ("K", "Kg"), self.once, q, q) - _form(form, "B", self.once, q, q)
        )
        self.energy = kinetic + potential
        self.largest = float(np.max(np.abs(kinetic)) + np.max(np.abs(potential)))

    def check(self) -> Check | None:
        """Return the check; None where there is nothing to balance."""
        if not 0 < self.largest < np.inf:
            return None
        spline = self._by_spline()
        # Where the quadrature's share matters, the motion between the angles is worth finding.
        if spline is not None and spline[1] <= max(_FINE, 0.1 * self.passed_on):
            return self._judged(spline)
        between, whole = self._between()
        if spline is None or spline[1] > _COARSE or (between is not None and whole):
            return self._judged(between)
        found = [one for one in map(self._judged, (spline, between)) if one is not None]
        return max(found, key=lambda one: one.value / one.limit, default=None)

    def _judged(self, found: tuple[float, float] | None) -> Check | None:
        """Return the check of an imbalance and its quadrature error."""
        if found is None or not np.all(np.isfinite(found)):
            return None
        limit = found[1] + self.passed_on
        return Check(found[0], limit) if limit <= 0.1 else None

    def _by_spline(self) -> tuple[float, float] | None:
        """Return imbalance and quadrature error by splines; None where they miss waves."""
        # Two given angles a wave of the highest harmonic at the least.
        if len(self.theta) < 9 or self.form.reach * 2 * self.step > self.form.system.period:
            return None
        power = self._power(self.once, self.q, self.slope)
        if not np.all(np.isfinite(power)):
            return None
        fine = CubicSpline(self.theta, power).antiderivative()(self.theta)
        # The largest difference on the way, as the one at the end may be small by chance.
        coarse = CubicSpline(self.theta[::2], power[::2]).antiderivative()(self.theta[::2])
        off = abs(self.energy[-1] - self.energy[0] - fine[-1])
        return float(off) / self.largest, float(np.max(np.abs(coarse - fine[::2]))) / self.largest

    def _between(self) -> tuple[tuple[float, float] | None, bool]:
        """Return imbalance and quadrature error along the motions from each state to the next.

        And whether all given angles are covered.
        """
        form, stages = self.form, _STAGES * 2 * self.form.system.size
        fastest = max(float(form.rate[0]), form.reach * 2 * pi / form.system.period)
        steps = max(1, ceil(fastest * self.step))
        most = min(_STEPS, _WORK / float(stages) ** 3)
        intervals = min(len(self.theta) - 1, int(most / steps))
        if intervals < 1:
            return None, False
        together = max(1, int(_TOGETHER / stages**2))
        gained = np.diff(self.energy[: intervals + 1])
        imbalance = []
        for count in (_STAGES, _FEWER):
            work = [
                self._work(np.arange(k, min(k + together, intervals)), steps, count)
                for k in range(0, intervals, together)
            ]
            imbalance.append(np.cumsum(gained - np.concatenate(work)))
        off = float(np.max(np.abs(imbalance[0])))
        quadrature = float(np.max(np.abs(imbalance[0] - imbalance[1])))
        found = off / self.largest, quadrature / self.largest
        return found, intervals == len(self.theta) - 1

    def _work(self, own: NDArray[np.intp], steps: int, stages: int) -> Array:
        """Return the work done on the motions that start at some given states, ``(own,)``."""
        form, n = self.form, self.form.system.size
        tableau, h = gauss_tableau(stages), self.step / steps
        p = _form_times(form, "M", self.theta[own], self.slope[own])
        p = p + _form_times(form, "A", self.theta[own], self.q[own])
        state, work = np.concatenate([self.q[own], p], axis=1), np.zeros(len(own))
        for k in range(steps):
            nodes = ((self.theta[own] + k * h)[:, None] + h * tableau.c).ravel()
            whole = form.plain_generator(nodes)[0].reshape(len(own), stages, form.size, form.size)
            inner = whole[..., : 2 * n, : 2 * n]
            right = (inner @ state[:, None, :, None])[..., 0]
            if form.forced:
                right = right + whole[..., : 2 * n, -1]
            system = -h * np.einsum("ij,tirc->tirjc", tableau.a, inner)
            each, rows = np.arange(stages), np.arange(2 * n)
            system[:, each[:, None], rows, each[:, None], rows] += 1.0
            size = stages * 2 * n
            rates = np.linalg.solve(
                system.reshape(-1, size, size), right.reshape(-1, size, 1)
            ).reshape(right.shape)
            inside = state[:, None, :n] + h * np.einsum("ij,tjr->tir", tableau.a, rates[..., :n])
            power = self._power(nodes, inside.reshape(-1, n), rates[..., :n].reshape(-1, n))
            work += h * power.reshape(len(own), stages) @ tableau.b
            state = state + h * np.einsum("i,tir->tr", tableau.b, rates)
        return work

    @cached_property
    def _slopes(self) -> list[tuple[float, str, str, Callable[[Array], Array]]]:
        """Derivatives of the arrays, each with its factor and what stands left and right."""
        return [
            (sign, left, right, _derivative(self.form, names))
            for sign, names, left, right in (
                (-0.5, ("M",), "slope", "slope"),
                (-1.0, ("A",), "slope", "q"),
                (-0.5, ("B",), "q", "q"),
                (0.5, ("K", "Kg"), "q", "q"),
            )
            if not all(self.form.system.is_constant(name) for name in names)
        ]

    def _power(self, theta: Array, q: Array, slope: Array) -> Array:
        """Return ``-(partial L2/partial theta) + q'^T Q`` along a motion, theta its revolution."""
        form, total, given = self.form, np.zeros(len(q)), {"q": q, "slope": slope}
        for sign, left, right, derivative in self._slopes:
            total += sign * _double(derivative(theta)[0], given[left], given[right])
        total -= _form(form, "C", theta, slope, slope) + _form(form, "D", theta, slope, q)
        # Only the symmetric part of a stiffness has a potential.
        skew = () if form.conservative else ((0.5, ("B",)), (-0.5, ("K", "Kg")))
        for sign, names in skew:
            total += sign * _form(form, names, theta, slope, q)
            total -= sign * _form(form, names, theta, q, slope)
        force = form.assemble(("f", "h", "p"), theta) if form.forced else None
        if force is not None:
            total += np.einsum("ti,ti->t", _repeated(force[0], len(q)), slope)
        return total


def _form_times(form: CanonicalForm, name: str, theta: Array, right: Array) -> Array:
    """Return ``matrix right`` along a motion; zeros where there is no such matrix."""
    matrix = form.assemble(name, theta)
    if matrix is None:
        return np.zeros_like(right)
    return np.asarray((_repeated(matrix[0], len(right)) @ right[:, :, None])[:, :, 0])


def _form(
    form: CanonicalForm, names: str | tuple[str, ...], theta: Array, left: Array, right: Array
) -> Array:
    matrix = form.assemble(names, theta)
    if matrix is None:
        return np.zeros(len(left))
    return _double(matrix[0], left, right)


def _double(matrix: Array, left: Array, right: Array) -> Array:
    """Return ``left^T matrix right`` along a motion, the matrices repeating."""
    ahead = (_repeated(matrix, len(right)) @ right[:, :, None])[:, :, 0]
    value: Array = np.sum(left * ahead, axis=1)
    return value


def _repeated(value: Array, count: int) -> Array:
    if len(value) == 1:
        return np.broadcast_to(value, (count, *value.shape[1:]))
    return value if len(value) == count else value[np.arange(count) % len(value)]


def _derivative(form: CanonicalForm, names: tuple[str, ...]) -> Callable[[Array], Array]:
    n = form.system.size

    def function(theta: Array) -> Array:
        value = form.assemble(names, theta)
        if value is None:
            return np.zeros((1, len(theta), n, n))
        return np.broadcast_to(value, (1, len(theta), n, n))

    return periodic_derivative(function, form.system.period)
