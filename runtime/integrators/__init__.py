"""Integrators for linear periodic systems, by name; the crank angle is the independent variable."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from . import de_vogelaere, gauss_legendre, kutta_merson, magnus4, rk4
from .expm import expm
from .newmark import SECOND_ORDER
from .protocol import Generator, OneStep
from .tableau import ExplicitTableau, GaussTableau, gauss_tableau, rooted_trees

METHODS: Mapping[str, OneStep] = MappingProxyType(
    {
        method.name: method
        for method in (
            de_vogelaere.METHOD,
            gauss_legendre.METHOD,
            kutta_merson.METHOD,
            magnus4.METHOD,
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
    "GaussTableau",
    "Generator",
    "OneStep",
    "expm",
    "gauss_tableau",
    "rooted_trees",
]
