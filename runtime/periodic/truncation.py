"""Modal truncation: a large system on its lowest modes, the others following in equilibrium.

With q = Phi(theta) z + delta, Phi the lowest modes of the mechanism held still at each angle and
delta in the space of the others, the equation of the others is in leading order

    delta = F sum_k w^k (c1_k z' + c0_k z + s_k),        F = (K^-1 less what Phi has of it),

without their inertia and damping.  Put back into the equation of z it adds terms of the same
family, with powers of the speed: so few modes follow a linkage of beams to a millionth.  What is
left is answered statically afterwards (:meth:`TruncatedSystem.lift`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array, LinearPeriodic, Term
from ..core.trigonometric import differentiated, interpolated, resampled
from .equation import SPEED_POWER
from .moving_basis import MovingBasis, still_modes
from .reduced import projections, summed

ComplexArray = NDArray[np.complex128]

# Static corrections of a lifted motion: the first takes a hundredth, the second a hundredth of it.
_CORRECTIONS = 2


@dataclass(frozen=True)
class TruncatedSystem(LinearPeriodic):
    """A linear periodic system on its lowest modes; make it with :func:`truncated_on`."""

    # The system that was truncated, with its present parameters: they are fixed.
    full: LinearPeriodic | None = None
    # Even angles of a period [rad], shape (nt,).
    theta: Array = field(default_factory=partial(np.zeros, 0))
    # The modes Phi there, shape (nt, n, m).
    modes: Array = field(default_factory=partial(np.zeros, 0))
    flexibility: Array = field(default_factory=partial(np.zeros, 0))  # F there, shape (nt, n, n)
    compliance: Array = field(default_factory=partial(np.zeros, 0))  # K^-1 there, shape (nt, n, n)
    # The arrays of the full system there, by name and power of the speed in its force.
    arrays: Mapping[tuple[str, int], Array] = field(default_factory=dict)

    def lift(self, z: Array, speeds: Array) -> tuple[Array, Array]:
        """Return periodic motions of the whole system, and the static answer to what they leave.

        What the modes leave of the whole equation is answered statically by the others, twice; by
        all modes, what is left then: both ``(ns, nt, n)``.  The motions ``z`` of the truncated
        system are at even angles, ``(ns, any, m)``, at crank speeds [rad/s], ``(ns,)``.
        """
        # Arrays are applied to all motions at once: the motions are the last axis.
        reduced = np.moveaxis(resampled(np.moveaxis(z, 1, 0), len(self.theta)), 1, -1)
        q = self.modes @ reduced
        for _ in range(_CORRECTIONS):
            q = q + self.flexibility @ unmet_forces(self.arrays, self.period, q, speeds)
        rest = self.compliance @ unmet_forces(self.arrays, self.period, q, speeds)
        return np.moveaxis(q, -1, 0), np.moveaxis(rest, -1, 0)

    def unmet_free(self, z: ComplexArray, exponents: ComplexArray, speed: float) -> ComplexArray:
        """Return the forces that free motions, lifted, leave unmet of the whole equation.

        The motions are ``z(theta) exp(exponent theta)``, z at ``theta`` in columns, ``(nt, m, k)``,
        with exponents ``(k,)`` [1/rad] at a crank speed [rad/s]; the exponential function is left
        out of the forces too, ``(nt, n, k)``.
        """
        arrays = {key: values for key, values in self.arrays.items() if values.ndim == 3}
        q: ComplexArray = self.modes @ z
        for _ in range(_CORRECTIONS):
            q = q + self.flexibility @ unmet_forces(arrays, self.period, q, speed, exponents)
        return np.asarray(unmet_forces(arrays, self.period, q, speed, exponents))


def modes_offered(system: LinearPeriodic, least: int) -> list[int]:
    """Return the numbers of modes with a gap to the next frequency at every angle, rising."""
    squares = still_modes(system, 64).squares
    ratio = np.sqrt(np.min(squares[:, 1:] / squares[:, :-1], axis=0))
    # At every angle the first frequency left out is beyond the last one kept.
    numbers = [m for m in range(least, system.size) if ratio[m - 1] >= 1.02]
    return [*numbers, system.size]


def truncated_on(
    system: LinearPeriodic, basis: MovingBasis, arrays: Mapping[tuple[str, int], Array]
) -> TruncatedSystem:
    """Return a system on modes that are known, with its arrays at their angles."""
    period, phi, slope = system.period, basis.values, basis.slopes
    stiffness = sum(
        (v for (name, power), v in arrays.items() if name in ("K", "Kg") and power == 0),
        start=np.zeros_like(phi @ np.swapaxes(phi, -1, -2)),
    )
    across = np.swapaxes(phi, -1, -2)
    held = across @ stiffness @ phi
    compliance = np.asarray(np.linalg.inv(stiffness), dtype=np.float64)
    flexibility = _symmetric(compliance - phi @ np.linalg.solve(held, across))
    kept = (
        ((name, power - 2 - SPEED_POWER[name]), part)
        for (array, power), values in arrays.items()
        for name, part in projections(array, values, phi, slope)
    )
    followed = _followed(_couplings(arrays, phi, slope, period), flexibility, period)
    size = phi.shape[-1]
    return TruncatedSystem(
        size=size,
        terms=tuple(
            Term(name, None, interpolated(values, period), power)
            for (name, power), values in summed(chain(kept, followed)).items()
            if np.any(values)
        ),
        period=period,
        labels=tuple(f"mode {k + 1}" for k in range(size)),
        reference_length=system.reference_length,
        **basis.deflections_of(system),
        provenance={**system.provenance, "modes kept": str(size)},
        full=system,
        theta=basis.theta,
        modes=phi,
        flexibility=flexibility,
        compliance=compliance,
        arrays=arrays,
    )


def arrays_at(system: LinearPeriodic, theta: Array) -> dict[tuple[str, int], Array]:
    """Return the arrays of a system at angles, by array and power of the speed in its force.

    The power is that with which the array stands in the equation of motion in time: 2 for M, A, B
    and f, 1 for C, D and h, 0 for K, Kg and p, and what the term adds to it.
    """
    scales = system.scale_values()
    parts = (
        (
            (term.array, 2 + SPEED_POWER[term.array] + term.power),
            term(theta) * (1.0 if term.scale is None else float(scales[term.scale])),
        )
        for term in system.terms
        if term.array in SPEED_POWER
    )
    return summed((key, part) for key, part in parts if np.any(part))


def unmet_forces(
    arrays: Mapping[tuple[str, int], Array],
    period: float,
    q: Any,
    speeds: Array | float,
    exponents: ComplexArray | float = 0.0,
) -> Any:
    """Return forces less what motions ``(nt, n, ns)`` need, of the same shape.

    The arrays are those of :func:`arrays_at`, at the even angles of the motions, whose exponential
    functions are left out: with ``exponents`` [1/rad] that are not 0 they are complex.
    """
    slope = _slope(q, period, exponents)
    momentum, total = np.zeros_like(q), np.zeros_like(q)
    for (array, power), values in arrays.items():
        factor = speeds**power
        if values.ndim == 2:
            total += values[..., None] * factor
        elif array == "M":
            momentum += factor * (values @ slope)
        elif array == "A":
            momentum += factor * (values @ q)
            total += factor * (np.swapaxes(values, -1, -2) @ slope)
        elif array == "C":
            total -= factor * (values @ slope)
        else:
            total += (1.0 if array == "B" else -1.0) * factor * (values @ q)
    return total - _slope(momentum, period, exponents)


def _slope(q: Any, period: float, exponents: ComplexArray | float) -> Any:
    """Return the derivative by the angle of motions over their exponential functions."""
    if not np.iscomplexobj(q):
        return differentiated(q, period)
    both = differentiated(np.stack([q.real, q.imag], axis=-1), period)
    return both[..., 0] + 1j * both[..., 1] + exponents * q


def _couplings(
    arrays: Mapping[tuple[str, int], Array], phi: Array, slope: Array, period: float
) -> dict[int, list[Array]]:
    """Return by power of the speed what ties the modes left out to those kept.

    The others are pushed by ``rate z' + place z + load``, and push the kept ones back by
    ``back^T delta - (forth^T delta)'``: rate, place, forth and back, ``(nt, n, m)``, and load,
    ``(nt, n, 1)``.
    """
    m = phi.shape[-1]
    parts = (
        (power, np.concatenate(_coupling(array, values, phi, slope, period), axis=-1))
        for (array, power), values in arrays.items()
        if (array, power) not in (("K", 0), ("Kg", 0))
    )
    each = summed(parts)
    return {power: np.split(both, [m, 2 * m, 3 * m, 4 * m], -1) for power, both in each.items()}


def _coupling(
    array: str, values: Array, phi: Array, slope: Array, period: float
) -> tuple[Array, Array, Array, Array, Array]:
    """Return what one array has in them."""
    none, load = np.zeros_like(phi), np.zeros_like(phi[..., :1])
    if values.ndim == 2:
        return none, none, none, none, values[..., None]
    carried, moved, turned = values @ phi, values @ slope, np.swapaxes(values, -1, -2)
    if array == "C":
        return -carried, -moved, carried, differentiated(carried, period), load
    if array == "D":
        return none, -carried, none, -turned @ phi, load
    # What is conservative pushes back as it is pushed.
    rate, place = none, carried if array == "B" else -carried
    if array == "M":
        rate = -differentiated(carried, period) - moved
        place = -differentiated(moved, period)
    elif array == "A":
        rate = turned @ phi - carried
        place = turned @ slope - differentiated(carried, period)
    return rate, place, rate, place, load


def _followed(
    couplings: Mapping[int, list[Array]], flexibility: Array, period: float
) -> Iterator[tuple[tuple[str, int], Array]]:
    """Yield what the modes left out add to those kept, by array and extra power of the speed."""
    # For powers k and l of the speed, back_k F (rate_l z' + place_l z + load_l) less the derivative
    # of forth_k F (...).  Where both are conservative the parts go to M, A and B, so that the
    # truncated system stays conservative; else to C and D.
    for k, (*_, forwards, backwards, _) in couplings.items():
        forth, back = (np.swapaxes(part, -1, -2) @ flexibility for part in (forwards, backwards))
        for j, (rate, place, *_, load) in couplings.items():
            power, follows = k + j - 2, forth @ place
            yield ("f", power), (back @ load - differentiated(forth @ load, period))[..., 0]
            yield ("M", power), _symmetric(forth @ rate)
            if k == j and k != 1:
                yield ("A", power), follows
                yield ("B", power), _symmetric(back @ place)
            else:
                yield ("C", power + 1), follows - back @ rate
                yield ("D", power + 1), differentiated(follows, period) - back @ place


def _symmetric(matrices: Array) -> Array:
    return np.asarray(0.5 * (matrices + np.swapaxes(matrices, -1, -2)))
