"""A linear periodic system on the lowest modes of its own mechanism, as a system of that family."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TypeVar

import numpy as np

from ..core.families import LinearPeriodic, Term
from ..core.trigonometric import Array, even_angles, interpolated, tail
from .moving_basis import RESOLVED, MovingBasis, moving_basis

Key = TypeVar("Key")

# Even angles from which the reduced arrays are interpolated.
_FEWEST, _MOST = 128, 2048
# Angles at which the arrays are compared with their definition, and how much worse they may be
# elsewhere.
_COMPARED, _ELSEWHERE = 61, 4.0
_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class ReducedSystem(LinearPeriodic):
    """A linear periodic system on a moving basis: ``q = Phi(theta) eta``.

    It keeps the quadratic Lagrangian, so that its flow is symplectic where the full one is, and
    all solvers of the family take it.

    Attributes
    ----------
    full : LinearPeriodic or None
        The system that was reduced.
    basis : MovingBasis or None
        Phi.
    """

    full: LinearPeriodic | None = None
    basis: MovingBasis | None = None

    @cached_property
    def error(self) -> float:
        """Largest error of an array beside its definition on the basis.

        Over the largest entry of the products that the array is the sum of.  An estimate, made when
        it is first looked at: the arrays are compared with the projections at angles that they were
        not made from.  What the modes left out would change is not in it; ``basis.kept`` and
        ``basis.left_out`` tell their distance.
        """
        assert self.full is not None and self.basis is not None
        theta = even_angles(self.period, _COMPARED) + 0.37 * self.period / _COMPARED
        phi, slope = self.basis(theta), self.basis.derivative(theta)
        gaps = {(term.array, term.scale, term.power): term(theta) for term in self.terms}
        sizes: dict[str, float] = {}
        for term in self.full.terms:
            for array, part in projections(term.array, term(theta), phi, slope):
                key = (array, term.scale, term.power)
                gaps[key] = gaps.get(key, 0.0) - part
                sizes[array] = max(sizes.get(array, 0.0), float(np.max(np.abs(part))))
        worst = max(
            float(np.max(np.abs(gap))) / (sizes[key[0]] or 1.0) for key, gap in gaps.items()
        )
        return _ELSEWHERE * worst + _EPS * self.full.size

    def lift(self, eta: Array, theta: Array) -> Array:
        """Return the full system's coordinates ``Phi eta``, ``(..., nt, n)``, at angles [rad].

        What the modes left out would add is missing.
        """
        assert self.basis is not None
        return np.asarray(np.einsum("tnm,...tm->...tn", self.basis(theta), eta))


def reduced_system(
    system: LinearPeriodic, modes: int, *, basis: MovingBasis | None = None
) -> ReducedSystem:
    """Return a system on its lowest natural modes, which move with the mechanism.

    With ``q = Phi(theta) eta``, ``qd = Phi etad + td Phi' eta``, the Lagrangian of the family
    keeps its form:

        M -> Phi^T M Phi,   A -> Phi^T (M Phi' + A Phi),
        B -> Phi'^T M Phi' + Phi'^T A Phi + (Phi'^T A Phi)^T + Phi^T B Phi,
        C -> Phi^T C Phi,   D -> Phi^T (C Phi' + D Phi),

    all other arrays as stiffnesses and forces.

    Parameters
    ----------
    system : LinearPeriodic
        The full system, damping and all.
    modes : int
        Number m of modes.  The best choice leaves a wide gap to the next frequency.
    basis : MovingBasis, optional
        Phi where it is known already.

    Returns
    -------
    ReducedSystem
        Of size m, with the parameters of the full system; the basis is that of its present
        parameter values.  Its arrays are trigonometric series to round-off.

    Raises
    ------
    BadInput
        If ``modes`` is no number from 1 to n, or the modes span no smooth periodic subspace.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> reduced = el.periodic.reduced_system(system, modes=3)
    >>> print(system.size, reduced.size, reduced.error < 1e-9)
    9 3 True
    """
    phi = moving_basis(system, modes) if basis is None else basis
    if phi.fixed:
        terms = tuple(replace(term, function=_on_fixed(term, phi.values)) for term in system.terms)
    else:
        terms = _moving_terms(system, phi)
    rebuild = None
    if system.rebuild is not None:
        rebuild = partial(_reduced_anew, system.rebuild, dict(system.parameters), modes)
    return ReducedSystem(
        size=phi.values.shape[-1],
        terms=terms,
        parameters=system.parameters,
        scales=system.scales,
        period=system.period,
        labels=tuple(f"eta{k + 1}" for k in range(phi.values.shape[-1])),
        reference_length=system.reference_length,
        provenance={**system.provenance, "modes kept": str(phi.values.shape[-1])},
        geometry=system.geometry,
        rebuild=rebuild,
        limits=system.limits,
        full=system,
        basis=phi,
        **phi.deflections_of(system),
    )


def _reduced_anew(
    rebuild: Callable[[Mapping[str, float]], LinearPeriodic],
    parameters: Mapping[str, float],
    modes: int,
    geometry: Mapping[str, float],
) -> LinearPeriodic:
    return reduced_system(replace(rebuild(geometry), parameters=dict(parameters)), modes)


def projections(array: str, values: Array, phi: Array, slope: Array) -> Iterator[tuple[str, Array]]:
    """Yield the arrays that one array of a system gives on a basis and its derivative.

    The array is one of ``M A B S C D K Kg f h g p``, its samples ``(nt, n, n)`` or ``(nt, n)``;
    ``phi`` and ``slope`` are Phi and Phi' there, ``(nt, n, m)``.
    """
    across = np.swapaxes(phi, -1, -2)
    if values.ndim == 2:
        yield array, (across @ values[..., None])[..., 0]
        return
    carried = values @ phi
    yield array, across @ carried
    turning = np.swapaxes(slope, -1, -2)
    if array == "M":
        yield "A", across @ (values @ slope)
        yield "B", turning @ (values @ slope)
    elif array == "A":
        both = turning @ carried
        yield "B", both + np.swapaxes(both, -1, -2)
    elif array == "C":
        yield "D", across @ (values @ slope)


def summed(parts: Iterable[tuple[Key, Array]]) -> dict[Key, Array]:
    """Return the sums of what has the same key."""
    sums: dict[Key, Array] = {}
    for key, part in parts:
        sums[key] = sums[key] + part if key in sums else part
    return sums


def _on_fixed(term: Term, values: Array) -> Callable[[Array], Array] | Array:
    projected = partial(_projected, term, values)
    return projected(np.zeros(1))[0] if term.constant else projected


def _projected(term: Term, values: Array, theta: Array) -> Array:
    _, found = next(projections(term.array, term(theta), values, np.zeros_like(values)))
    return found


def _moving_terms(system: LinearPeriodic, phi: MovingBasis) -> tuple[Term, ...]:
    """Return the terms on a moving basis, like ones put together, as trigonometric series."""
    count, before = max(_FEWEST, len(phi.theta)), np.inf
    while True:
        theta = even_angles(system.period, count)
        values, slope = phi(theta), phi.derivative(theta)
        found = summed(
            ((array, term.scale, term.power), part)
            for term in system.terms
            for array, part in projections(term.array, term(theta), values, slope)
        )
        worst = max(map(tail, found.values()), default=0.0)
        # What stays as it is by twice as many angles is the round-off of a stiff system.
        # More angles are worth it where the error falls to a tenth of what it was.
        if worst <= RESOLVED or worst > 0.1 * before or 2 * count > _MOST:
            break
        count, before = 2 * count, worst
    return tuple(
        Term(array, scale, interpolated(values, system.period, 4.0 * tail(values)), power)
        for (array, scale, power), values in found.items()
        if np.any(values)
    )
