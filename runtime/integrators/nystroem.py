"""Symplectic Runge-Kutta-Nystroem methods: kicks and drifts of a split system, explicit.

For ``q' = U(theta) p, p' = V(theta) q + f(theta)`` a kick moves p at a fixed angle and a drift
moves q and the angle.  With B the kick and A the drift, ``[B, [B, [B, A]]] = 0`` as A is quadratic
in p and B's force depends on q and the angle alone; that spares two of six conditions of order 5.
The coefficients are those of Blanes and Moan (J. Comput. Appl. Math. 142 (2002) 313) with the free
ones set to four digits and the others solved from the conditions in 60 digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from ..core.errors import SelfCheckFailed, bad
from ..core.namespaces import any_entry, carried, identity, namespace_of, weighted_sum
from .lie_series import LieSeries, letters, one
from .protocol import Array, Generator, OneStep, at_nodes

# What rounding coefficients to 40 digits leaves of an order condition.
_PROVED = Fraction(1, 10**38)
# Gauss points of a drift where U varies: exact to order 6 of the step.
_POINTS, _WEIGHTS = (np.array(part) / 2 for part in np.polynomial.legendre.leggauss(3))
_POINTS = _POINTS + 0.5


@dataclass(frozen=True)
class KickDrift:
    """A symmetric sequence of kicks and drifts that begins and ends with a kick.

    Attributes
    ----------
    name : str
        Name of the method.
    order : int
        Order of the method.
    first_kicks, first_drifts : tuple of Fraction
        Coefficients of the first half.  Those in the middle follow: the kicks and the drifts sum
        to 1 each.
    """

    name: str
    order: int
    first_kicks: tuple[Fraction, ...]
    first_drifts: tuple[Fraction, ...]

    @cached_property
    def kicks(self) -> tuple[Fraction, ...]:
        """All coefficients of kicks, one more than of drifts."""
        half = self.first_kicks
        if len(self.first_drifts) == len(half):
            middle: tuple[Fraction, ...] = (Fraction(1, 2) - sum(half, Fraction(0)),) * 2
        else:
            middle = (1 - 2 * sum(half, Fraction(0)),)
        return (*half, *middle, *half[::-1])

    @cached_property
    def drifts(self) -> tuple[Fraction, ...]:
        """All coefficients of drifts."""
        half = self.first_drifts
        if len(self.first_kicks) == len(half):
            middle: tuple[Fraction, ...] = (1 - 2 * sum(half, Fraction(0)),)
        else:
            middle = (Fraction(1, 2) - sum(half, Fraction(0)),) * 2
        return (*half, *middle, *half[::-1])

    def verify(self) -> None:
        """Prove the order: the logarithm of the sequence against A + B, word by word.

        Raises
        ------
        SelfCheckFailed
            If a condition of the declared order fails by more than 1e-38, or all of the next hold.
        """
        limit = self.order + 1
        drift, kick = letters((1, 1), limit)
        flow = one((1, 1), limit)
        for k, value in enumerate(self.kicks):
            flow = flow @ kick.times(value).exp()
            if k < len(self.drifts):
                flow = flow @ drift.times(self.drifts[k]).exp()
        defect = _without_triple_kicks(flow.log() - drift - kick, drift, kick)
        largest = [defect.largest(weight) for weight in range(1, limit + 1)]
        failed = [k + 1 for k, size in enumerate(largest[:-1]) if size > _PROVED]
        if failed:
            raise SelfCheckFailed(
                f"{self.name}: declared order {self.order}, a condition of {failed[0]} fails"
            )
        if largest[-1] <= _PROVED:
            raise SelfCheckFailed(
                f"{self.name}: declared order {self.order}, and all of the next hold too"
            )


def _without_triple_kicks(series: LieSeries, drift: LieSeries, kick: LieSeries) -> LieSeries:
    """Take out of a Lie series all that holds [B, [B, [B, A]]], up to weight 5.

    Each element taken out is the only one left that has its word.
    """
    vanishing = kick.commutator(kick.commutator(kick.commutator(drift)))
    for element, word in (
        (vanishing, (1, 1, 1, 0)),
        (drift.commutator(vanishing), (0, 1, 1, 1, 0)),
        (kick.commutator(vanishing), (1, 1, 1, 1, 0)),
    ):
        if word in series.terms:
            series = series - element.times(series.terms[word] / element.terms[word])
    return series


SRKN4 = KickDrift(
    name="srkn4",
    order=4,
    first_kicks=tuple(
        map(
            Fraction,
            (
                "0.083",
                "0.395634097243661755844244256291977350612864",
                "-0.0387226235150682492277332322257034024145181",
            ),
        )
    ),
    first_drifts=tuple(map(Fraction, ("0.2453", "0.6049"))),
)

SRKN6 = KickDrift(
    name="srkn6",
    order=6,
    first_kicks=tuple(
        map(
            Fraction,
            (
                "0.0415",
                "0.197752797989799291419027842858850789281404",
                "-0.0399694014786345651934546443771331771301329",
                "0.0750407283831673136449162658251057831749683",
                "-0.0114475590383767223614715756931050086313203",
            ),
        )
    ),
    first_drifts=tuple(
        map(
            Fraction,
            (
                "0.1232",
                "0.2906",
                "-0.127827889492943171078939463573582102476112",
                "-0.245736903476690632413818490166034546761611",
                "0.3572",
            ),
        )
    ),
)


def kick_drift(scheme: KickDrift) -> OneStep:
    """Return the one-step method of a sequence of kicks and drifts.

    Raises
    ------
    BadInput
        By its ``maps``, where q' depends on q or p' on p: with damping or Coriolis terms.
    """
    kicks, drifts = (np.array([float(v) for v in part]) for part in (scheme.kicks, scheme.drifts))
    places = np.concatenate([[0.0], np.cumsum(drifts)])

    def maps(generator: Generator, theta: Array, step: float) -> Array:
        values = at_nodes(generator, theta, step * places)
        m = values.shape[-1]
        n = m // 2
        rates = (values[..., :n, :n], values[..., n : 2 * n, n : 2 * n], values[..., 2 * n :, :])
        xp = namespace_of(values)
        if any(any_entry(part) for part in rates):
            raise bad(
                scheme.name,
                "damping, Coriolis or other first derivatives",
                "q' = U(theta) p, p' = V(theta) q + f(theta)",
                "use magnus6, magnus8 or gauss_legendre, or leave the terms out",
            )
        carry = _drifts(generator, theta, step, values[..., :n, n : 2 * n], places, drifts)
        unit = identity(m, values)
        lead = values.shape[:-3]
        q, p = (xp.broadcast_to(unit[own, :], (*lead, n, m)) for own in (slice(n), slice(n, 2 * n)))
        for k, kick in enumerate(kicks):
            push = values[..., k, n : 2 * n, :n] @ q
            if m > 2 * n:
                push = push + values[..., k, n : 2 * n, -1:] * unit[-1, :]
            p = p + float(step * kick) * push
            if k < len(drifts):
                q = q + carry[..., k, :, :] @ p
        rest = [xp.broadcast_to(unit[2 * n :, :], (*lead, 1, m))] if m > 2 * n else []
        out: Array = xp.concat([q, p, *rest], axis=-2)
        return out

    return OneStep(scheme.name, order=scheme.order, maps=maps, explicit=True, symplectic=True)


def _drifts(
    generator: Generator,
    theta: Array,
    step: float,
    flexibility: Array,
    places: Array,
    drifts: Array,
) -> Array:
    """Return the integrals of U over the drifts, ``(*batch, ns, drifts, n, n)``."""
    lengths = (step * drifts)[:, None, None]
    xp = namespace_of(flexibility)
    lengths = carried(lengths, flexibility)
    if xp.all(flexibility == flexibility[..., :1, :1, :, :]):
        even: Array = flexibility[..., :-1, :, :] * lengths
        return even
    n = flexibility.shape[-1]
    nodes = places[:-1, None] + drifts[:, None] * _POINTS
    values = at_nodes(generator, theta, step * nodes.ravel())[..., :n, n : 2 * n]
    grouped = xp.reshape(values, (*values.shape[:-3], len(drifts), len(_POINTS), n, n))
    means: Array = weighted_sum(_WEIGHTS, grouped) * lengths
    return means


METHODS = tuple(kick_drift(scheme) for scheme in (SRKN4, SRKN6))
