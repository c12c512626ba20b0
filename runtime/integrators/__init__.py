"""Integrators for linear periodic systems, by name; the crank angle is the independent variable."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from . import commutator_free, de_vogelaere, gauss_legendre, kutta_merson, magnus, nystroem, rk4
from .commutators import ExponentialProduct, MagnusExponent
from .expm import expm
from .newmark import SECOND_ORDER
from .nystroem import KickDrift
from .protocol import Generator, OneStep
from .radau import RadauTableau, legendre_integrals, radau_tableau
from .tableau import ExplicitTableau, GaussTableau, gauss_tableau, rooted_trees

METHODS: Mapping[str, OneStep] = MappingProxyType(
    {
        method.name: method
        for method in (
            de_vogelaere.METHOD,
            *gauss_legendre.METHODS,
            kutta_merson.METHOD,
            *magnus.METHODS,
            *commutator_free.METHODS,
            *nystroem.METHODS,
            rk4.METHOD,
        )
    }
)
SCIPY_METHODS = ("RK45", "DOP853", "Radau", "BDF", "LSODA")

__all__ = [
    "METHODS",
    "SCIPY_METHODS",
    "SECOND_ORDER",
    "ExplicitTableau",
    "ExponentialProduct",
    "GaussTableau",
    "Generator",
    "KickDrift",
    "MagnusExponent",
    "OneStep",
    "RadauTableau",
    "expm",
    "gauss_tableau",
    "legendre_integrals",
    "radau_tableau",
    "rooted_trees",
]
