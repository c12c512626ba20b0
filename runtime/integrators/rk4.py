"""The classical fourth-order Runge-Kutta method with fixed step."""

from __future__ import annotations

from fractions import Fraction

from .explicit import explicit_maps
from .protocol import Array, Generator, OneStep
from .tableau import ExplicitTableau

TABLEAU = ExplicitTableau(
    name="rk4",
    c=(Fraction(0), Fraction(1, 2), Fraction(1, 2), Fraction(1)),
    a=(
        (),
        (Fraction(1, 2),),
        (Fraction(0), Fraction(1, 2)),
        (Fraction(0), Fraction(0), Fraction(1)),
    ),
    b=(Fraction(1, 6), Fraction(1, 3), Fraction(1, 3), Fraction(1, 6)),
    order=4,
)


def maps(generator: Generator, theta: Array, step: float) -> Array:
    """Return the matrices that carry the state over each step; see :class:`OneStep`."""
    return explicit_maps(TABLEAU, generator, theta, step)


METHOD = OneStep("rk4", order=4, maps=maps, explicit=True, symplectic=False)
