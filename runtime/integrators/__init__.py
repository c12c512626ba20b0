"""Collocation with any number of stages: coefficients that prove themselves, and step matrices."""

from .collocation import (
    CollocationTableau,
    gauss_maps,
    gauss_tableau,
    legendre_integrals,
    radau_tableau,
)

__all__ = [
    "CollocationTableau",
    "gauss_maps",
    "gauss_tableau",
    "legendre_integrals",
    "radau_tableau",
]
