"""Transition matrices over the crank angle as polynomials of the inverse speed.

Of stretches of the period, and from their left ends to the angles wanted.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..floquet.first_order import SPEED_POWER, CanonicalForm, canonical_form, even_angles
from ..stretches import Equation, Tabulated, mixed, solved

Array = NDArray[np.float64]

# How far the fastest mode turns within a stretch [rad], the fewest stretches, and how many are
# multiplied into one.
_PHASE, _FEWEST, _TOGETHER = 3.0, 8, 3
# Numbers in a table.
_MOST_FLOATS = 40_000_000


@dataclass(frozen=True)
class Table(Tabulated):
    """The solution over one range of inverse speeds [s/rad].

    Attributes
    ----------
    inner : ndarray
        Chebyshev coefficients of the matrices from the left end of its stretch to each wanted
        angle, ``(leaves, nt, m, m)``.
    within : ndarray of int
        The stretch of each wanted angle, ``(nt,)``.
    """

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
        weights = self.weights(inverse)
        products = self._products(weights)
        xp = products.__array_namespace__()
        inner = mixed(weights, self.inner)
        found: Array = inner @ xp.take(products, xp.asarray(self.within), axis=1)
        return found, products[:, -1, ...]

    def whole(self, inverse: Array) -> Array:
        """Return the flows over the period, ``(ns, m, m)``."""
        return self._products(self.weights(inverse))[:, -1, ...]

    def _products(self, weights: Array) -> Array:
        """Return the flows to the ends of the stretches, ``(ns, k + 1, m, m)``, 0 first."""
        xp = weights.__array_namespace__()
        single = mixed(weights, self.stretches)
        m = self.stretches.shape[-1]
        flow = xp.broadcast_to(xp.eye(m, dtype=weights.dtype), (single.shape[0], m, m))
        found = [flow]
        for k in range(single.shape[1]):
            flow = single[:, k, ...] @ flow
            found.append(flow)
        value: Array = xp.stack(found, axis=1)
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
        equation = Equation(
            lambda inverse: partial(self.generator, self.form_at(inverse)),
            len(self.scale),
            low,
            high,
            self.system.period,
            degree=self.degree,
            together=_TOGETHER,
            angles=self.theta,
            name="prepare",
            fix="raise the lowest speed, or prepare reduced_system(system, modes)",
            most_floats=_MOST_FLOATS,
        )
        count = int(np.ceil(fineness * self.stretches(low, high)))
        found = solved(equation, count, fineness=fineness)
        return Table(low, high, found.stretches, found.inner, found.within)
