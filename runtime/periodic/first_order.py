"""Canonical first-order form of a linear periodic system, with the crank angle as variable.

The state is y = (q, p) with p = M q' + A q, so no derivative of a coefficient occurs and the flow
is symplectic where the system is undamped.  Angle-dependent arrays are evaluated once for all
speeds and parameter values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, bad
from ..core.families import DAMPING, LinearPeriodic, Term
from ..core.inputs import numbers
from ..core.trigonometric import even_angles
from .equation import SPEED_POWER

Array = NDArray[np.float64]

# Arrays of like kind, whose harmonics are weighed together.
_KIND = {
    **{"M": "M", "A": "A", "B": "K", "C": "C", "D": "K", "K": "K", "Kg": "K"},
    **{"f": "f", "h": "f", "p": "f"},
}
# Decay over a step, in phases of one radian, that A-stable collocation still damps away.
_DECAY = 40.0
# Amplitude, over the largest, from which a harmonic has to be resolved.
_SEEN = 1e-6


@dataclass(frozen=True)
class CanonicalForm:
    """The system at given speeds and parameter values, ready to be sampled over the crank angle.

    Make it with :func:`canonical_form`.  Inside it the batch is flat.

    Attributes
    ----------
    system : LinearPeriodic
        The system.
    speed : ndarray
        Crank speeds [rad/s], shape ``(nb,)``.
    factors : ndarray
        Factor of each term, speed included, shape ``(number of terms, nb)``.
    batch : tuple of int
        Shape of the batch seen from outside.
    forced : bool
        Whether the generator carries a last component, always 1, through which forcing acts.
    """

    system: LinearPeriodic
    speed: Array
    factors: Array
    batch: tuple[int, ...]
    forced: bool

    @property
    def size(self) -> int:
        """Number of components of the state: 2n, and one more where forced."""
        return 2 * self.system.size + int(self.forced)

    @property
    def damped(self) -> bool:
        """True where some damping term is not zero."""
        rows = [row for row, term in enumerate(self.system.terms) if term.array in DAMPING]
        return any(np.any(self.factors[i]) and np.any(self.system.spectrum(i)) for i in rows)

    @cached_property
    def reach(self) -> int:
        """Highest harmonic of the period that a coefficient of the equation holds.

        An amplitude counts from 1e-6 of the largest of its array, or of the mass; at most 2048.
        """
        used = [
            (_KIND[term.array], factor, self.system.spectrum(row))
            for row, (term, factor) in enumerate(zip(self.system.terms, self.factors, strict=True))
            if _used(term, self.forced)
        ]
        size = max((len(amplitude) for *_, amplitude in used), default=1)
        total: dict[str, Array] = {}
        for kind, factor, amplitude in used:
            row = total.setdefault(kind, np.zeros(size))
            row[: len(amplitude)] += np.max(np.abs(factor), initial=0.0) * amplitude
        mass = float(np.max(total["M"])) if "M" in total else 0.0
        highest = 0
        for kind, row in total.items():
            top = max(float(np.max(row)), mass if kind in "AKC" else 0.0)
            kept = np.flatnonzero(row > _SEEN * top)
            highest = max(highest, int(kept[-1]) if len(kept) else 0)
        return highest

    @cached_property
    def conservative(self) -> bool:
        """True where the flow is symplectic: no damping, and B, K and Kg symmetric."""
        theta = even_angles(self.system.period, 8)
        found = [] if self.damped else [self.assemble(a, theta) for a in ("B", "K", "Kg")]
        return not self.damped and all(
            value is None
            or np.max(np.abs(value - np.swapaxes(value, -1, -2))) <= 1e-13 * np.max(np.abs(value))
            for value in found
        )

    def take(self, index: slice | NDArray[np.intp]) -> CanonicalForm:
        """Return the form for a part of the flat batch."""
        factors = self.factors[:, index]
        return replace(self, speed=self.speed[index], factors=factors, batch=(factors.shape[1],))

    def assemble(self, names: str | tuple[str, ...], theta: Array) -> Array | None:
        """Return the sum of arrays at crank angles; None where no term belongs to them.

        Parameters
        ----------
        names : str or tuple of str
            Arrays to add.
        theta : ndarray
            Crank angles [rad], shape ``(nt,)``.

        Returns
        -------
        ndarray or None
            Shape ``(nb, nt, n, n)``, or ``(nb, nt, n)``; nt is 1 where no term depends on the
            angle.
        """
        wanted = (names,) if isinstance(names, str) else names
        pairs = [
            (term, factor)
            for term, factor in zip(self.system.terms, self.factors, strict=True)
            if term.array in wanted and np.any(factor)
        ]
        if not pairs:
            return None
        angles = theta[:1] if all(term.constant for term, _ in pairs) else theta
        samples = np.stack([_sample(term, angles) for term, _ in pairs])
        factors = np.stack([factor for _, factor in pairs], axis=1)
        return self._combined(factors, samples)

    def _combined(self, factors: Array, samples: Array) -> Array:
        """Return the sums over the terms of factors ``(nb, k)`` times samples ``(k, nt, ...)``."""
        flat = factors @ samples.reshape(len(samples), -1)
        shaped: Array = flat.reshape(len(self.speed), *samples.shape[1:])
        return shaped

    def generator(self, theta: Array) -> Array:
        """Return L of y' = L(theta) y at crank angles.

        Parameters
        ----------
        theta : ndarray
            Crank angles [rad], shape ``(nt,)``.

        Returns
        -------
        ndarray
            Shape ``(nb, nt, m, m)`` in the scaled state (q/s, p s), s from :attr:`scale`.

        Raises
        ------
        BadInput
            If a mass matrix is not positive definite at one of the angles.
        """
        out = self.plain_generator(theta)
        scale = self.scale[:, None, :]
        out /= scale[..., :, None]
        out *= scale[..., None, :]
        return out

    def plain_generator(self, theta: Array) -> Array:
        """Return L as :meth:`generator` does, in the state (q, p) itself."""
        n = self.system.size
        # What the batch has in common is found once.
        flexibility = self._first_of_equal("M")._inverse_mass(theta)
        gyro = self._first_of_equal("A").assemble("A", theta)
        damping = self.assemble("C", theta)
        carried = self.assemble("D", theta)
        inertia = self.assemble("B", theta)
        stiffness = self.assemble(("K", "Kg"), theta)
        size = 2 * n + self.forced
        out = np.zeros((len(self.speed), len(theta), size, size))
        q, p = slice(0, n), slice(n, 2 * n)
        out[..., q, p] = flexibility
        if inertia is not None:
            out[..., p, q] += inertia
        for part in (stiffness, carried):
            if part is not None:
                out[..., p, q] -= part
        # q' = M^-1 (p - A q) enters p' through A^T - C.
        feedback: Array | None = None if damping is None else -damping
        if gyro is not None:
            transposed = np.matrix_transpose(gyro)
            feedback = transposed if feedback is None else feedback + transposed
            out[..., q, q] = -(flexibility @ gyro)
        if feedback is not None:
            through = feedback @ flexibility
            out[..., p, p] = through
            if gyro is not None:
                out[..., p, q] -= through @ gyro
        if self.forced:
            force = self.assemble(("f", "h", "p"), theta)
            if force is not None:
                out[..., p, -1] = force
        return out

    def _first_of_equal(self, array: str) -> CanonicalForm:
        """Return the form of the first member where all have an array in common, else itself."""
        rows = [
            factor
            for term, factor in zip(self.system.terms, self.factors, strict=True)
            if term.array == array
        ]
        same = len(self.speed) > 0 and all(np.all(row == row[0]) for row in rows)
        return self.take(slice(0, 1)) if same else self

    def require_mass(self, mass: Array | None) -> Array:
        """Return the mass matrix; raise :class:`BadInput` where the system has none."""
        if mass is None:
            raise bad(
                "LinearPeriodic.terms", "no mass term M", "a positive definite M", "add the term"
            )
        return mass

    def _inverse_mass(self, theta: Array) -> Array:
        mass = self.require_mass(self.assemble("M", theta))
        if mass.shape[-1] == 1:
            if not np.all(mass > 0):
                raise _bad_mass(mass)
            return 1.0 / mass
        try:
            np.linalg.cholesky(mass)
        except np.linalg.LinAlgError as indefinite:
            raise _bad_mass(mass) from indefinite
        inverse = np.asarray(np.linalg.inv(mass), dtype=np.float64)
        return inverse

    @cached_property
    def mean(self) -> Mapping[str, Array]:
        """Mean over the period of M, A, B, C, D and of the stiffness K + Kg; ``(nb, n, n)``."""
        theta = even_angles(self.system.period, 64)
        n = self.system.size
        found = {}
        for name in ("M", "A", "B", "C", "D", "K"):
            value = self.assemble(("K", "Kg") if name == "K" else name, theta)
            found[name] = np.zeros((len(self.speed), n, n)) if value is None else value.mean(axis=1)
        return found

    @cached_property
    def rate(self) -> Array:
        """Largest rate of change of the state per radian, to choose a step; shape ``(nb,)``."""
        turning = 2 * np.pi / self.system.period
        own = np.sqrt(self._spectral("K") + self._spectral("B") + self._spectral("D"))
        return np.maximum(turning, own + self._spectral("C") + self._spectral("A"))

    def _spectral(self, name: str) -> Array:
        """Return the spectral norm of a mean matrix in coordinates of unit mass."""
        if not np.any(self.mean[name]):
            return np.zeros(len(self.speed))
        cholesky = np.linalg.cholesky(self.mean["M"])
        half = np.linalg.solve(cholesky, self.mean[name])
        reduced = np.linalg.solve(cholesky, np.swapaxes(half, -1, -2))
        norm: Array = np.linalg.norm(reduced, ord=2, axis=(-2, -1)).astype(np.float64)
        return norm

    @cached_property
    def scale(self) -> Array:
        """Scale of each component of the state, shape ``(nb, m)``.

        Displacement and momentum of a harmonic oscillator of the mean mass and stiffness get like
        sizes; the scaling is symplectic.
        """
        mass = np.diagonal(self.mean["M"], axis1=-2, axis2=-1)
        stiffness = np.abs(np.diagonal(self.mean["K"], axis1=-2, axis2=-1))
        size = (mass * np.maximum(stiffness, mass)) ** -0.25
        # Powers of two make the scaling free of rounding.
        size = np.exp2(np.round(np.log2(size))).astype(np.float64)
        parts = [size, 1 / size]
        if self.forced:
            parts.append(np.ones((len(size), 1)))
        return np.concatenate(parts, axis=-1)


def canonical_form(
    system: LinearPeriodic,
    speed: ArrayLike,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    forcing: bool = False,
    probed: bool = True,
) -> CanonicalForm:
    """Return the canonical form of a system at speeds and parameter values that broadcast.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speed : array_like
        Crank speeds [rad/s], positive.
    parameters : mapping, optional
        Parameter values that replace the system's own.
    forcing : bool
        Whether forcing is carried along; it is left out where the system has none.
    probed : bool
        Whether each term is sampled beforehand, to refuse one that is not finite and a mass that
        is not symmetric; whoever leaves that out looks at what comes of it.

    Raises
    ------
    BadInput
        If a speed is not positive and finite, a parameter is unknown or not finite, shapes do not
        broadcast, or a mass matrix is not positive definite.
    """
    speeds = numbers("speed", speed)
    if not (np.all(np.isfinite(speeds)) and np.all(speeds > 0)):
        raise bad("speed", speed, "positive finite speeds [rad/s]", "leave out speeds <= 0")
    changes = {name: numbers(name, value) for name, value in (parameters or {}).items()}
    for name, value in changes.items():
        if not np.all(np.isfinite(value)):
            raise bad(name, value, "finite numbers", "correct the parameter")
    try:
        batch = np.broadcast_shapes(speeds.shape, *(v.shape for v in changes.values()))
    except ValueError as mismatch:
        shapes = {"speed": speeds.shape, **{k: v.shape for k, v in changes.items()}}
        raise bad(
            "speed and parameters", shapes, "shapes that broadcast", "add axes of length 1"
        ) from mismatch
    scales = system.scale_values(**changes)
    forced = forcing and any(term.array in ("f", "h", "p") for term in system.terms)
    if probed:
        for place, term in enumerate(system.terms):
            if _used(term, forced):
                system.spectrum(place)  # refuses terms that are not finite
    flat_speed = np.broadcast_to(speeds, batch).reshape(-1)
    factors = np.zeros((len(system.terms), len(flat_speed)))
    for row, term in zip(factors, system.terms, strict=True):
        if term.array in SPEED_POWER:
            scale = 1.0 if term.scale is None else scales[term.scale]
            power = SPEED_POWER[term.array] + term.power
            row[:] = np.broadcast_to(scale, batch).reshape(-1) * flat_speed**power
    form = CanonicalForm(system, flat_speed, factors, batch, forced)
    if probed:
        _check_mass(form)
    return form


def _check_mass(form: CanonicalForm) -> None:
    """Raise where the mass matrix is not symmetric and positive definite."""
    # Angles by the golden section share no symmetry with a wave.
    golden = form.system.period * (np.arange(16.0) * (np.sqrt(5) - 1) / 2 % 1.0)
    mass = form.require_mass(form.assemble("M", golden))
    asymmetry = np.max(np.abs(mass - np.swapaxes(mass, -1, -2)), initial=0.0)
    lowest = np.min(np.linalg.eigvalsh(mass)) if np.all(np.isfinite(mass)) else np.nan
    if not lowest > 0 or asymmetry > 1e-10 * np.max(np.abs(mass)):
        raise _bad_mass(mass)


def _bad_mass(mass: Array) -> BadInput:
    asymmetry = np.max(np.abs(mass - np.swapaxes(mass, -1, -2)))
    lowest = np.min(np.linalg.eigvalsh(mass)) if np.all(np.isfinite(mass)) else np.nan
    return bad(
        "mass matrix M",
        f"smallest eigenvalue {lowest:.3g}, asymmetry {asymmetry:.3g}",
        "a symmetric positive definite matrix at every angle and parameter value",
        "check masses, inertias and parameter values",
    )


def _used(term: Term, forced: bool) -> bool:
    """Return True where a term acts at constant speed, with forcing or without."""
    return term.array in SPEED_POWER and (forced or term.array not in ("f", "h", "p"))


def _sample(term: Term, theta: Array) -> Array:
    return np.asarray(term(theta), dtype=float)
