"""Floquet multipliers of a constrained system in its redundant coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.inputs import require_kind
from ..core.plotting import Axes, multiplier_plane
from ..core.results import Check, Result, provenance
from .equations import EPS, Array
from .orbits import LEFT, OrbitSource, PeriodicOrbit, Shooting, Shot, Tangent

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class ConstrainedMultipliers(Result):
    """Floquet multipliers about a periodic motion: physical ones, and those of the constraints.

    The variation of the index-reduced equations moves 2n numbers, n coordinates and n velocities.
    Variations that meet the k constraints at position and velocity level stay so: restricted to
    them the flow has the 2(n - k) physical multipliers.  What is left over, violations of the
    constraints, obeys ``d2 Phi/dt2 = 0`` whatever the motion: 2k multipliers 1, in k Jordan
    blocks.

    Attributes
    ----------
    physical : ndarray of complex, shape (2(n - k),)
        By falling modulus, then by the size of the argument, upper half plane first.
    error : ndarray, shape (2(n - k),)
        Absolute error of each physical multiplier.
    others : ndarray of complex, shape (2k,)
        Eigenvalues of the flow on the violations, as computed; exactly they are 1.
    others_error : float
        How far from 1 rounding can drive eigenvalues in Jordan blocks of two: a square root.
    violation_defect : float
        Flow on the violations less its exact form, relative; free of that square root.
    monodromy : ndarray, shape (2n, 2n)
        Whole monodromy matrix in coordinates and velocities.
    reduced : ndarray, shape (2(n - k), 2(n - k))
        Monodromy matrix in an orthonormal basis of the tangent space, states scaled.
    basis : ndarray, shape (2n, 2(n - k))
        That basis, in coordinates and velocities.
    period : float
        Period [s].
    """

    physical: ComplexArray
    others: ComplexArray
    others_error: float
    violation_defect: float
    monodromy: Array
    reduced: Array
    basis: Array
    period: float

    arrays_along: ClassVar = {
        "multiplier": "physical error",
        "other": "others",
        "state state_1": "monodromy",
        "tangent tangent_1": "reduced",
        "state tangent": "basis",
    }
    exported: ClassVar[tuple[str, ...]] = ("stable", "largest", "growth")
    column_units: ClassVar = {"s": "period"}

    @property
    def multipliers(self) -> ComplexArray:
        """All 2n multipliers, the physical ones first."""
        return np.concatenate([self.physical, self.others])

    @property
    def largest(self) -> float:
        """Largest modulus of a physical multiplier."""
        return float(np.max(np.abs(self.physical), initial=0.0))

    @property
    def stable(self) -> bool:
        """True where no physical multiplier is outside the unit circle by more than its error.

        Never True where that is not known: an error of 0.1 or more says nothing, the multiplier
        then has to be inside by its error.
        """
        # Error from which a multiplier says nothing about stability.
        slack = np.where(self.error < 0.1, self.error, -self.error)
        return bool(np.all(np.abs(self.physical) <= 1.0 + slack))

    @property
    def growth(self) -> float:
        """Largest growth rate of the logarithm of a disturbance [1/s]."""
        return float(np.log(self.largest) / self.period) if self.largest > 0 else -np.inf

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw physical and constraint multipliers and the unit circle; return the axes."""
        ax = multiplier_plane(ax)
        ax.plot(self.physical.real, self.physical.imag, "o", markersize=4, label="physical")
        if len(self.others):
            x, y = self.others.real, self.others.imag
            ax.plot(x, y, "s", markersize=7, markerfacecolor="none", label="of the constraints")
            ax.legend(frameon=False, fontsize="small")
        return ax


def orbit_multipliers(orbit: PeriodicOrbit) -> ConstrainedMultipliers:
    """Return the Floquet multipliers about a periodic motion, in the system's own coordinates.

    Answers what Beale & Scott leave open in section 3.1: the coordinates stay those that refer to
    the ground, and nothing is linearised by hand.

    Parameters
    ----------
    orbit : PeriodicOrbit
        A motion that converged.

    Returns
    -------
    ConstrainedMultipliers
        Its checks: ``orbit``, the accuracy of the motion itself, whose error enters that of the
        multipliers where it is larger than was asked; ``accuracy`` of the monodromy matrix;
        ``violations``, the flow across the
        constraints against its exact form; ``tangent``, what the flow carries out of the tangent
        space; ``liouville``, the determinant against the integral of the divergence; where no
        forces act but the Lagrangian's, ``symplectic`` and ``reciprocal pairs``.

    Raises
    ------
    BadInput
        If the orbit did not converge.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "free_free", "model.modes": 2}
    >>> rod = el.load_scene("beale_1992_flexible_rod", changes).system()
    >>> found = el.orbit_multipliers(el.periodic_orbit(rod))
    >>> print(abs(found.physical).round(4), found.stable)
    [1. 1. 1. 1.] True
    """
    require_kind("orbit", orbit, PeriodicOrbit, "make one with periodic_orbit")
    if orbit.message:
        raise bad("orbit", orbit.message, "a periodic motion", "mend the shooting first")
    source, accuracy = orbit.source, orbit.checks["accuracy"]
    shooting, ring = source.shooting, source.fine.ring
    fine, coarse = (_Turn.of(shooting, shot) for shot in (source.fine, source.coarse))
    along = fine.tangent.along
    reduced, rough = fine.reduced, along.T @ coarse.whole @ along
    norm = float(np.linalg.norm(reduced))
    # A rounded coefficient turns all phases of a period alike; a fine step covers some 2.5 rad.
    rounding = EPS * (16.0 + 2.0 * len(ring.x)) * max(norm, 1.0)
    shift = float(np.linalg.norm(reduced - rough)) * LEFT + rounding
    if not accuracy.passed:
        # About a motion that is off by so much, the coefficients are off by that part or so.
        off = np.nan_to_num(accuracy.value, nan=1e6, posinf=1e6)
        shift += float(off) * (2 * np.pi + shooting.rate * ring.period) * max(norm, 1.0)
    physical, error = _eigenvalues(reduced, shift)
    others, defect, root = _of_violations(fine, ring.period, shooting.rate)
    columns = shooting.equations.columns
    units = np.concatenate([columns, columns * shooting.rate])
    checks = {
        "orbit": accuracy,
        "accuracy": Check(shift / max(norm, 1.0), 1e-6),
        "violations": Check(defect, 1e-9),
        "tangent": Check(fine.leak / max(norm, 1.0), 1e-9),
        "liouville": _liouville(fine, source.fine, shift),
    }
    if not np.any(source.fine.sweep.slopes.terms["forces"]):
        checks |= _conservative(fine, _symplectic_form(source), physical, error, shift)
    return ConstrainedMultipliers(
        method=f"variational equations along {len(ring.x)} Gauss-Legendre steps, "
        "restricted to the tangent space of the constraints",
        error=error,
        error_norm="absolute, of each physical multiplier",
        checks=checks,
        provenance=provenance(orbit.provenance),
        physical=physical,
        others=others,
        others_error=root,
        violation_defect=defect,
        monodromy=units[:, None] * fine.whole / units,
        reduced=reduced,
        basis=units[:, None] * along,
        period=ring.period,
    )


@dataclass(frozen=True)
class _Turn:
    """One turn of the variational equations: all of it, and within the constraints.

    ``steps`` are those within, ``leak`` is what leaves the tangent space.
    """

    whole: Array
    reduced: Array
    steps: Array
    leak: float
    tangent: Tangent

    @classmethod
    def of(cls, shooting: Shooting, shot: Shot) -> _Turn:
        maps, meeting = shot.sweep.maps, shooting.junctions(shot.ring)
        carried = maps @ meeting.along
        steps, leak = (
            np.swapaxes(np.roll(basis, -1, axis=0), -1, -2) @ carried
            for basis in (meeting.along, meeting.across)
        )
        whole, reduced = np.eye(maps.shape[-1]), np.eye(steps.shape[-1])
        for one, inner in zip(maps, steps, strict=True):
            whole, reduced = one @ whole, inner @ reduced
        return cls(
            whole,
            reduced,
            steps,
            float(np.max(np.abs(leak), initial=0.0)),
            Tangent(meeting.normals[0], meeting.along[0], meeting.across[0]),
        )


def _symplectic_form(source: OrbitSource) -> Array:
    """Return the form ``dq . dp' - dq' . dp`` at the start."""
    # With p = dL/dqd, D = M' + P - P^T where P = dp/dq: the antisymmetric part of the damping
    # matrix is all of P that the form needs.
    equations, ring = source.shooting.equations, source.fine.ring
    slopes = equations.linearised(ring.start[:1], ring.x[:1], ring.v[:1])
    columns, n = equations.columns, equations.n
    mass, damping = (
        columns[:, None] * array[0] * columns
        for array in (slopes.terms["mass"], slopes.variations["damping"])
    )
    form = np.zeros((2 * n, 2 * n))
    form[:n, :n] = (damping - damping.T) / (2.0 * source.shooting.rate)
    form[:n, n:], form[n:, :n] = mass, -mass
    return form


def _eigenvalues(matrix: Array, shift: float) -> tuple[ComplexArray, Array]:
    """Return the eigenvalues in a fixed order, each with its error from that of the matrix."""
    if not matrix.size:
        return np.zeros(0, dtype=complex), np.zeros(0)
    from ..periodic.multipliers import eigenvalues, multiplier_order

    values, error, _ = (part[0] for part in eigenvalues(matrix[None], np.array([shift])))
    with np.errstate(divide="ignore"):
        order = multiplier_order(np.log(np.abs(values)), np.angle(values))
    return values[order], error[order]


def _of_violations(turn: _Turn, period: float, rate: float) -> tuple[ComplexArray, float, float]:
    """Return the eigenvalues across the constraints, their defect, and what rounding may do."""
    normals, across = turn.tangent.normals, turn.tangent.across
    k = normals.shape[0] // 2
    if k == 0:
        return np.zeros(0, dtype=complex), 0.0, 0.0
    # Violations (Phi, dPhi/dt / rate) before and after: exactly [[1, period rate], [0, 1]].
    square = normals @ across
    carried = np.linalg.solve(square.T, (normals @ turn.whole @ across).T).T
    exact = np.eye(2 * k) + period * rate * np.eye(2 * k, k=k)
    size = float(np.linalg.norm(exact))
    away = float(np.linalg.norm(carried - exact))
    values = np.linalg.eigvals(across.T @ turn.whole @ across).astype(complex)
    # z = value - 1 of a disturbed block: |z|^2 <= (period rate + |z|) |disturbance|.
    disturbed = away + 16.0 * k * EPS * size * float(np.linalg.cond(square))
    reach = 2.0 * (np.sqrt(period * rate * disturbed) + disturbed)
    return values, away / size, float(reach)


def _liouville(turn: _Turn, shot: Shot, shift: float) -> Check:
    """Compare the determinant with the divergence of the index-reduced flow."""
    # The violations have determinant 1, so that of the whole is that of the physical part.
    trace = np.trace(shot.sweep.slopes.by_v, axis1=-2, axis2=-1)
    total = float(shot.ring.step * np.sum(trace @ shot.ring.points.b))
    sign, logarithm = np.linalg.slogdet(turn.steps)
    gap = abs(float(np.sum(logarithm)) - total) if np.prod(sign) > 0 else np.inf
    p = len(turn.reduced)
    return Check(gap, 8 * p * shift * max(1.0, float(np.linalg.norm(turn.reduced))) + 1e-12)


def _conservative(
    turn: _Turn, form: Array, physical: ComplexArray, error: Array, shift: float
) -> dict[str, Check]:
    """Check the form that the reduced flow keeps, and that multipliers come in reciprocal pairs."""
    along = turn.tangent.along
    form = along.T @ form @ along
    kept = turn.reduced.T @ form @ turn.reduced
    norm = float(np.linalg.norm(turn.reduced))
    defect = float(np.linalg.norm(kept - form) / (np.linalg.norm(form) * norm**2))
    gaps = np.abs(physical[:, None] * physical - 1.0)
    relative = error / np.maximum(np.abs(physical), np.finfo(float).tiny)
    partner = np.argmin(gaps, axis=-1)
    value = gaps[np.arange(len(physical)), partner]
    limit = 4 * (relative + relative[partner]) + 64 * EPS
    worst = int(np.argmax(value / limit))
    return {
        "symplectic": Check(defect, max(8 * len(along.T) * shift, 1e-12)),
        "reciprocal pairs": Check(float(value[worst]), float(limit[worst])),
    }
