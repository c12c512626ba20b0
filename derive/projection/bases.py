"""Mode bases that a field is expanded in: closed in the mode index, or a finite list."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import sympy as sp

from ..arrays import ArrayEntry, IndexedEntry, IndexedVector
from ..integrals import definite, mode_integral, mode_vector


class Basis(Protocol):
    """Shape functions that a field is expanded in."""

    @property
    def modes(self) -> int | None:
        """Number of functions; None where it is open."""

    def bilinear(
        self, weight: sp.Expr, orders: tuple[int, int], at: sp.Expr | None = None
    ) -> ArrayEntry:
        """Return ``int weight phi_m^(k) phi_n^(l) dx``, or the integrand at a point."""

    def single(self, weight: sp.Expr, order: int, at: sp.Expr | None = None) -> ArrayEntry:
        """Return ``int weight phi_m^(k) dx``, or the integrand at a point."""


@dataclass(frozen=True)
class IndexedBasis:
    """Shape functions ``amplitude * shape(x; m)``, m = 1, 2, ..., for any number of modes.

    Attributes
    ----------
    x : Symbol
        Running coordinate, from 0 to ``length``.
    length : Expr
        Length of the link.
    shape : Expr
        In x and m.
    m, n : Symbol
        Integer symbols of row and column.
    amplitude : Expr
        Unit of the coordinates: the field is ``amplitude * sum_m q_m shape(x; m)``.
    """

    x: sp.Symbol
    length: sp.Expr
    shape: sp.Expr
    m: sp.Symbol
    n: sp.Symbol
    amplitude: sp.Expr = sp.S.One

    @property
    def modes(self) -> int | None:
        """None: the number of modes is open."""
        return None

    def bilinear(
        self, weight: sp.Expr, orders: tuple[int, int], at: sp.Expr | None = None
    ) -> ArrayEntry:
        """Return ``int weight phi_m^(k) phi_n^(l) dx`` or its integrand at a point."""
        row = sp.diff(self.shape, self.x, orders[0])
        column = sp.diff(self.shape, self.x, orders[1]).subs(self.m, self.n)
        integrand = self.amplitude**2 * weight * row * column
        if at is None:
            return mode_integral(integrand, self.x, self.m, self.n, sp.S.Zero, self.length)
        value = integrand.subs(self.x, at)
        return IndexedEntry(value.subs(self.n, self.m), value, self.m, self.n)

    def single(self, weight: sp.Expr, order: int, at: sp.Expr | None = None) -> ArrayEntry:
        """Return ``int weight phi_m^(k) dx`` or its integrand at a point."""
        integrand = self.amplitude * weight * sp.diff(self.shape, self.x, order)
        if at is None:
            return mode_vector(integrand, self.x, self.m, sp.S.Zero, self.length)
        return IndexedVector(integrand.subs(self.x, at), self.m)


@dataclass(frozen=True)
class FiniteBasis:
    """A finite list of shape functions: polynomials times sin, cos, sinh, cosh, exp.

    Attributes
    ----------
    x : Symbol
        Running coordinate, from 0 to ``length``.
    length : Expr
        Length of the link.
    shapes : tuple of Expr
        The functions.
    amplitude : Expr
        Unit of the coordinates.
    """

    x: sp.Symbol
    length: sp.Expr
    shapes: tuple[sp.Expr, ...]
    amplitude: sp.Expr = sp.S.One

    @property
    def modes(self) -> int | None:
        """Number of functions."""
        return len(self.shapes)

    def bilinear(
        self, weight: sp.Expr, orders: tuple[int, int], at: sp.Expr | None = None
    ) -> ArrayEntry:
        """Return ``int weight phi_i^(k) phi_j^(l) dx`` or its integrand at a point."""
        rows = [sp.diff(shape, self.x, orders[0]) for shape in self.shapes]
        columns = [sp.diff(shape, self.x, orders[1]) for shape in self.shapes]
        factor = self.amplitude**2 * weight
        size = len(self.shapes)
        return sp.ImmutableDenseMatrix(
            size, size, lambda i, j: self._value(factor * rows[i] * columns[j], at)
        )

    def single(self, weight: sp.Expr, order: int, at: sp.Expr | None = None) -> ArrayEntry:
        """Return ``int weight phi_i^(k) dx`` or its integrand at a point."""
        factor = self.amplitude * weight
        shapes = [sp.diff(shape, self.x, order) for shape in self.shapes]
        return sp.ImmutableDenseMatrix(
            len(shapes), 1, lambda i, _: self._value(factor * shapes[i], at)
        )

    def _value(self, integrand: sp.Expr, at: sp.Expr | None) -> sp.Expr:
        if at is None:
            return definite(integrand, self.x, sp.S.Zero, self.length)
        return integrand.subs(self.x, at)


def sine_basis(x: sp.Symbol, length: sp.Expr, amplitude: sp.Expr | None = None) -> IndexedBasis:
    """Return the modes ``sin(m pi x / length)`` of a pinned beam.

    Parameters
    ----------
    x : Symbol
        Running coordinate.
    length : Expr
        Length of the link.
    amplitude : Expr, optional
        Unit of the coordinates; the length where it is not given.
    """
    m, n = sp.symbols("m n", integer=True, positive=True)
    shape = sp.sin(m * sp.pi * x / length)
    return IndexedBasis(x, length, shape, m, n, length if amplitude is None else amplitude)
