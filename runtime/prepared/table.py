"""Transition matrices over the crank angle as polynomials of the inverse speed.

The period is cut into stretches that hardly turn the state; over each the solution is a power
series in the angle.  At a few Chebyshev nodes of the inverse speed it is found once; between them
polynomials give it to round-off, at the ends of the stretches and at the angles wanted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import bad
from ..floquet.first_order import SPEED_POWER, CanonicalForm, canonical_form, even_angles
from ..floquet.turn_series import by_powers, power_terms
from ..series import chebyshev

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# How far the fastest mode turns within a stretch [rad], and the fewest stretches.
_PHASE, _FEWEST = 3.0, 8
# How far it turns within the stretches that are kept, several of the former merged [rad].
_MERGED = 9.0
# Chebyshev nodes of the angle in a stretch, and of the inverse speed: first and most of them.
_ANGLES, _LEAVES, _MOST_LEAVES = 16, 16, 80
# Coefficients that polynomials may miss, and last terms of a power series.
_ROUGH, _ENDED = 64 * _EPS, 1e-14
_MOST_FLOATS = 40_000_000
_BLOCK_FLOATS = 2_000_000


@dataclass(frozen=True)
class Table:
    """Maps of one range of inverse speeds.

    Attributes
    ----------
    low, high : float
        Ends of the inverse speed [s/rad].
    stretches : ndarray
        Chebyshev coefficients of the matrices over the stretches, ``(leaves, count, m, m)``.
    inner : ndarray
        Those from the left end of its stretch to each wanted angle, ``(leaves, nt, m, m)``.
    within : ndarray of int
        The stretch of each wanted angle, ``(nt,)``.
    """

    low: float
    high: float
    stretches: Array
    inner: Array
    within: NDArray[np.intp]

    def flows(self, inverse: Array) -> tuple[Array, Array]:
        """Return flows from angle 0 to each wanted one, and over the period.

        Parameters
        ----------
        inverse : ndarray
            Inverse speeds, shape ``(ns,)``, of any array namespace.

        Returns
        -------
        ndarray, ndarray
            Of that namespace, shapes ``(ns, nt, m, m)`` and ``(ns, m, m)``.
        """
        weights = self._weights(inverse)
        products = self._products(weights)
        xp = products.__array_namespace__()
        inner = _mixed(weights, self.inner)
        found: Array = inner @ xp.take(products, xp.asarray(self.within), axis=1)
        return found, products[:, -1, ...]

    def whole(self, inverse: Array) -> Array:
        """Return the flows over the period, ``(ns, m, m)``."""
        return self._products(self._weights(inverse))[:, -1, ...]

    def _products(self, weights: Array) -> Array:
        """Return the flows to the ends of the stretches, ``(ns, k + 1, m, m)``, 0 first."""
        xp = weights.__array_namespace__()
        single = _mixed(weights, self.stretches)
        m = self.stretches.shape[-1]
        flow = xp.broadcast_to(xp.eye(m, dtype=weights.dtype), (single.shape[0], m, m))
        found = [flow]
        for k in range(single.shape[1]):
            flow = single[:, k, ...] @ flow
            found.append(flow)
        value: Array = xp.stack(found, axis=1)
        return value

    def _weights(self, inverse: Array) -> Array:
        """Return the Chebyshev polynomials at inverse speeds, ``(ns, leaves)``."""
        xp = inverse.__array_namespace__()
        count = len(self.stretches)
        if count == 1:
            one: Array = xp.ones_like(inverse)[:, None]
            return one
        half, middle = 0.5 * (self.high - self.low), 0.5 * (self.high + self.low)
        place = xp.clip((inverse - middle) / half, -1.0, 1.0)
        value: Array = xp.cos(xp.acos(place)[:, None] * xp.arange(count, dtype=inverse.dtype))
        return value


def _mixed(weights: Array, table: Array) -> Array:
    """Return weighted sums over the first axis of a table, in the namespace of the weights."""
    xp = weights.__array_namespace__()
    flat = xp.asarray(table.reshape(len(table), -1))
    value: Array = xp.reshape(weights @ flat, (-1, *table.shape[1:]))
    return value


class Maker:
    """Makes tables of one system.

    Parameters
    ----------
    form : CanonicalForm
        At one speed: gives the scale of the state, and whether forcing is carried along.
    theta : ndarray
        Wanted angles [rad] within a period, ``(nt,)``.
    parameters : mapping
        Of :func:`canonical_form`.

    Raises
    ------
    BadInput
        If a mass or gyroscopic term carries a power of the speed.
    """

    def __init__(self, form: CanonicalForm, theta: Array, parameters: dict[str, float]) -> None:
        self.system, self.forced, self.parameters = form.system, form.forced, parameters
        self.scale, self.theta = form.scale[0].copy(), theta
        powers = [
            -(SPEED_POWER[t.array] + t.power) for t in self.system.terms if t.array in SPEED_POWER
        ]
        inertia = [t for t in self.system.terms if t.array in "MA" and t.power]
        if inertia:
            # Rates follow from momenta by matrices that all speeds share.
            found, fix = f"a term {inertia[0].array} with a power of the speed", "use simulate"
            raise bad("prepare", found, "inertia that does not depend on the speed", fix)
        whole = all(p >= 0 and p == int(p) for p in powers)
        # The generator is a polynomial of the inverse speed of this degree, where it is one.
        self.degree = int(max(powers)) if whole else None

        if self.forced:
            self.scale[-1] = self._force_unit(form)

    def _force_unit(self, form: CanonicalForm) -> float:
        """Return a power of two that makes the force's column as large as the others."""
        values = self.generator(form, even_angles(self.system.period, 67))[0]
        largest = float(np.max(np.abs(values[:, :-1, -1])))
        if largest == 0.0:
            return 1.0
        rate = float(np.max(np.abs(values[:, :-1, :-1])))
        return float(np.exp2(np.round(np.log2(rate / largest))))

    def form_at(self, inverse: Array) -> CanonicalForm:
        """Return the canonical form at inverse speeds."""
        return canonical_form(
            self.system, 1.0 / inverse, self.parameters, forcing=self.forced, probed=False
        )

    def generator(self, form: CanonicalForm, theta: Array) -> Array:
        """Return L in the units of the state, ``(ns, nt, m, m)``."""
        value: Array = form.plain_generator(theta) / self.scale[:, None] * self.scale
        return value

    def stretches(self, low: float, high: float) -> int:
        """Return how many stretches the fastest mode asks for between two inverse speeds."""
        means = self.generator(
            self.form_at(np.array([low, high])), even_angles(self.system.period, 67)
        )
        m = 2 * self.system.size
        mean = means[..., :m, :m].mean(axis=1)
        rate = float(np.max(np.abs(np.linalg.eigvals(mean))))
        return max(_FEWEST, int(np.ceil(rate * self.system.period / _PHASE)))

    def table(self, low: float, high: float, *, fineness: float = 1.0) -> Table:
        """Return the table of a range of inverse speeds.

        Raises
        ------
        BadInput
            If it would not fit, or no number of stretches resolves the coefficients.
        """
        count = int(np.ceil(fineness * self.stretches(low, high)))
        leaves = 1 if low == high else _LEAVES
        while True:
            self._require_room(count, leaves)
            found = self._maps(count, leaves, low, high)
            if found is None:
                count = int(np.ceil(1.3 * count))
                continue
            stretches, inner, within = _merged(*found, self._together)
            analysis = chebyshev.analysis(leaves)
            stretches, inner = (
                (analysis @ part.reshape(leaves, -1)).reshape(part.shape)
                for part in (stretches, inner)
            )
            tail = 0.0
            if leaves > 1:
                tail = max(float(np.max(np.abs(part[-2:]))) for part in (stretches, inner))
            if tail <= _ROUGH or leaves >= _MOST_LEAVES:
                return Table(low, high, stretches, inner, within)
            leaves += 4

    @property
    def _together(self) -> int:
        """Stretches that are merged into one."""
        return max(1, int(_MERGED / _PHASE))

    def _require_room(self, count: int, leaves: int) -> None:
        m = len(self.scale)
        floats = leaves * (count + len(self.theta)) * m * m
        if floats > _MOST_FLOATS:
            raise bad(
                "prepare",
                f"tables of {8e-6 * floats:.3g} MB a range",
                f"at most {8e-6 * _MOST_FLOATS:.3g} MB",
                "raise the lowest speed, or prepare reduced_system(system, modes)",
            )

    def _maps(
        self, count: int, leaves: int, low: float, high: float
    ) -> tuple[Array, Array, NDArray[np.intp]] | None:
        """Return the maps at the nodes of the inverse speed; None where stretches are too long."""
        own = leaves if self.degree is None else min(leaves, self.degree + 1)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        form = self.form_at(middle + half * chebyshev.nodes(own))
        spread = chebyshev.basis(chebyshev.nodes(leaves), own).T @ chebyshev.analysis(own)
        m, width = len(self.scale), self.system.period / count
        within = np.minimum((self.theta / width).astype(np.intp), count - 1)
        together = max(1, _BLOCK_FLOATS // (leaves * _ANGLES * m * m))
        maps, inner = np.empty((leaves, count, m, m)), np.empty((leaves, len(self.theta), m, m))
        for start in range(0, count, together):
            stop = min(count, start + together)
            coefficients = self._coefficients(form, start, stop, width)
            if coefficients is None:
                return None
            terms, last = power_terms(np.tensordot(spread, coefficients, (1, 1)).swapaxes(0, 1))
            if last > _ENDED:
                return None
            series = np.stack(terms)
            sign = (-1.0) ** np.arange(len(series))
            begin = np.linalg.inv(np.tensordot(sign, series, 1))
            maps[:, start:stop] = np.sum(series, axis=0) @ begin
            wanted = np.flatnonzero((within >= start) & (within < stop))
            own_stretch = within[wanted] - start
            tau = 2.0 * (self.theta[wanted] / width - within[wanted]) - 1.0
            powers = tau ** np.arange(len(series))[:, None]
            values = np.einsum("kt,klt...->lt...", powers, series[:, :, own_stretch])
            inner[:, wanted] = values @ begin[:, own_stretch]
        return maps, inner, within

    def _coefficients(
        self, form: CanonicalForm, start: int, stop: int, width: float
    ) -> Array | None:
        """Return L by powers of the angle in stretches, ``(powers, own, stretches, m, m)``."""
        middles = (np.arange(start, stop) + 0.5) * width
        angles = middles[:, None] + 0.5 * width * chebyshev.nodes(_ANGLES)
        values = self.generator(form, angles.ravel())
        m = values.shape[-1]
        values = 0.5 * width * values.reshape(len(values), len(middles), _ANGLES, m * m)
        values = chebyshev.analysis(_ANGLES) @ values
        if float(np.max(np.abs(values[..., -2:, :]))) > _ROUGH:
            return None
        found: Array = np.moveaxis(by_powers(_ANGLES) @ values, 2, 0)
        return found.reshape(_ANGLES, len(values), len(middles), m, m)


def _merged(
    maps: Array, inner: Array, within: NDArray[np.intp], together: int
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Return the maps of several stretches in one, and those to the angles within it."""
    count = maps.shape[1]
    starts = np.arange(0, count, together)
    found = []
    inner = inner.copy()
    for start in starts:
        flow = maps[:, start]
        for k in range(start + 1, min(start + together, count)):
            own = within == k
            inner[:, own] = inner[:, own] @ flow[:, None]
            flow = maps[:, k] @ flow
        found.append(flow)
    return np.stack(found, axis=1), inner, within // together
