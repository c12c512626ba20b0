"""Commutator-free methods: products of exponentials of combinations of the moments.

Order 4 takes two exponentials; order 6 five, as four symmetric ones have six coefficients for seven
conditions.  One coefficient stays free: 0.168, where the error measured on a four-bar and on a
quick-return linkage is a tenth of that at 0.15 and 0.19; the others solve the conditions in 60
digits.
"""

from __future__ import annotations

from ..core.namespaces import carried, namespace_of
from .commutators import ExponentialProduct, combination, moments_of
from .expm import expm
from .protocol import Array, Generator, OneStep

CF4 = ExponentialProduct(
    name="cf4",
    order=4,
    factors=(
        combination((0, "1/2"), (1, "-1/3")),
        combination((0, "1/2"), (1, "1/3")),
    ),
)

CF6 = ExponentialProduct(
    name="cf6",
    order=6,
    factors=(
        combination(
            (0, "0.168"),
            (1, "-0.151640249151238525745243823912103117105645"),
            (2, "0.118920747453715577235731471736309351316934"),
        ),
        combination(
            (0, "0.37865534289418862492024666559367120841219"),
            (1, "-0.141940556321043319212067943074579923856109"),
            (2, "-0.130048754363324440605549885182934505966105"),
        ),
        combination(
            (0, "-0.0933106857883772498404933311873424168243809"),
            (2, "0.0222560138192177267396368268932503092983413"),
        ),
        combination(
            (0, "0.37865534289418862492024666559367120841219"),
            (1, "0.141940556321043319212067943074579923856109"),
            (2, "-0.130048754363324440605549885182934505966105"),
        ),
        combination(
            (0, "0.168"),
            (1, "0.151640249151238525745243823912103117105645"),
            (2, "0.118920747453715577235731471736309351316934"),
        ),
    ),
)


def commutator_free(product: ExponentialProduct) -> OneStep:
    """Return the one-step method of a product of exponentials: symplectic for undamped systems."""

    def maps(generator: Generator, theta: Array, step: float) -> Array:
        moments = moments_of(generator, theta, step, product.order // 2)
        xp = namespace_of(moments)
        flat = xp.reshape(moments, (*moments.shape[:-2], moments.shape[-1] ** 2))
        shape = (*moments.shape[:-3], len(product.factors), *moments.shape[-2:])
        factors = expm(xp.reshape(carried(product.weights, moments) @ flat, shape))
        flow: Array = factors[..., 0, :, :]
        for k in range(1, len(product.factors)):
            flow = factors[..., k, :, :] @ flow
        return flow

    return OneStep(product.name, order=product.order, maps=maps, explicit=False, symplectic=True)


METHODS = tuple(commutator_free(product) for product in (CF4, CF6))
