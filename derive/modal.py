"""Constrained equations closed in the mode indices: written down at one mode, verified at two.

Amplitudes of modes enter energies and constraints through sums over the modes and over pairs of
them, with one factor per index.  What the equations of one mode say with numbers, those of any
number of modes say with vectors and symmetric matrices: a product of an amplitude and a number of
its mode is a sum over the modes, an amplitude in the equation of a mode is a vector.  Two modes
hold every pair that can occur.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain, product
from typing import Any

import sympy as sp

from .external import external_values
from .records import EquationsOfMotion, VariationalEquations
from .safe import UnsafeRewriting
from .staged import Steps

IDENTITY = sp.Symbol("identity")
EACH_MODE = "sequence of N"  # how the shape of a vector begins
COUNTED_MODES = 2  # for which operations are counted
_ENDINGS = ("", "_dot", "_ddot")


class ModeSum(sp.Function):  # type: ignore[misc]
    """The sum over the modes of the products of two vectors."""

    nargs = 2


class ModeProduct(sp.Function):  # type: ignore[misc]
    """A symmetric matrix of the modes times a vector."""

    nargs = 2


@dataclass(frozen=True)
class Modes:
    """What bears an index for each mode.

    Attributes
    ----------
    amplitude : str
        Coordinate: ``f1``, ``f2``, ... where it is ``f``.
    shape : str
        Open function of each mode, ``psi_1``, ``psi_2``, ... where it is ``psi``.
    orders : int
        How many of the shapes' derivatives occur, the value among them.
    vectors, matrices : tuple of str
        Numbers ``left_1`` of each mode, and symmetric ones ``inward_1_2`` of each pair.
    """

    amplitude: str
    shape: str
    orders: int
    vectors: tuple[str, ...]
    matrices: tuple[str, ...]

    @property
    def numbers(self) -> tuple[str, ...]:
        """Names of the numbers of modes and pairs."""
        return self.vectors + self.matrices

    @property
    def external(self) -> tuple[str, ...]:
        """Names of the shapes and their derivatives."""
        return tuple(f"{self.shape}_d{k}" if k else self.shape for k in range(self.orders))

    def vector(self, i: int) -> dict[sp.Symbol, sp.Symbol]:
        """Return the entries of all vectors at mode i, by symbol of the vector."""
        found = {self.amplitude + ending: f"{self.amplitude}{i}{ending}" for ending in _ENDINGS}
        for name in self.external:
            found[name] = f"{self.shape}_{i}{name.removeprefix(self.shape)}"
        found |= {name: f"{name}_{i}" for name in self.vectors}
        return {sp.Symbol(name): sp.Symbol(at) for name, at in found.items()}

    def matrix(self, i: int, j: int) -> dict[sp.Symbol, sp.Expr]:
        """Return the entries of all matrices at a pair of modes; vectors stand on a diagonal."""
        first, second = sorted((i, j))
        found = {sp.Symbol(n): sp.Symbol(f"{n}_{first}_{second}") for n in self.matrices}
        found |= {sp.Symbol(n): sp.Symbol(f"{n}_{i}") * int(i == j) for n in self.vectors}
        return found | {IDENTITY: sp.Integer(i == j)}


def closed_in_modes(
    modes: Modes,
    one: tuple[EquationsOfMotion, VariationalEquations],
    two: tuple[EquationsOfMotion, VariationalEquations],
) -> tuple[EquationsOfMotion, VariationalEquations, Steps]:
    """Return the equations for any number of modes.

    ``modes``: what bears an index for each mode; the amplitudes are the last coordinates; ``one``,
    ``two``: the equations of one and of two modes, with variations. Result: with one coordinate for
    all the modes. A row or column of it holds vectors, its diagonal block a sum of numbers times
    matrices; ``steps``: sums over the modes, and products with matrices.
    """
    closing = _Closing(modes)
    equations, variations = (
        closing.record(single, pair) for single, pair in zip(one, two, strict=True)
    )
    return equations, variations, Steps(tuple(closing.steps.items()))


# Which of its rows and columns stand for coordinates.
_COORDINATES = {
    "mass": (True, True),
    "damping": (True, True),
    "stiffness": (True, True),
    "rest": (True, False),
    "forces": (True, False),
    "jacobian": (False, True),
    "jacobian_rate": (False, True),
    "jacobian_acceleration": (False, True),
    "constraints": (False, False),
    "velocity_rhs": (False, False),
    "gamma": (False, False),
}


def _opened(record: Any) -> dict[str, sp.ImmutableDenseMatrix]:
    """Return the matrices of a record, open functions as plain symbols."""
    matrices = {name: v for name, v in vars(record).items() if name in _COORDINATES}
    values = external_values(matrices.values())
    return {name: values.plain(matrix) for name, matrix in matrices.items()}


class _Closing:
    """Entries at one mode, rewritten for any number of modes."""

    def __init__(self, modes: Modes) -> None:
        self.modes = modes
        self.steps: dict[sp.Symbol, sp.Expr] = {}
        self._tables: dict[tuple[tuple[int, ...], int], dict[sp.Symbol, sp.Expr]] = {}
        self._amplitudes = {sp.Symbol(modes.amplitude + ending) for ending in _ENDINGS}
        self._vectors = {at: name for name, at in modes.vector(1).items()}
        self._matrices = {modes.matrix(1, 1)[n]: n for n in sp.symbols(modes.matrices)}
        self._known = [*self._vectors, *self._matrices]

    def record(self, one: Any, two: Any) -> Any:
        """Return equations or variations for any number of modes, from those of one and two."""
        changes: dict[str, Any] = {}
        known = _opened(two)
        for name, matrix in _opened(one).items():
            last = tuple(
                length - 1 if own else -1
                for length, own in zip(matrix.shape, _COORDINATES[name], strict=True)
            )
            changes[name] = sp.ImmutableDenseMatrix(
                *matrix.shape,
                lambda i, j, m=matrix, last=last: self._entry(
                    m[i, j], (i == last[0]) + (j == last[1])
                ),
            )
            self._verify(name, changes[name], last, known[name])
        for name in ("coordinates", "velocities", "accelerations"):
            symbols = getattr(one, name, ())
            changes[name] = tuple(self._vectors.get(symbol, symbol) for symbol in symbols)
        return replace(one, **{name: v for name, v in changes.items() if hasattr(one, name)})

    def _entry(self, entry: sp.Expr, free: int) -> sp.Expr:
        if not entry.free_symbols & set(self._known):
            return entry * IDENTITY if free == 2 else entry
        total = sp.S.Zero
        for powers in sp.Poly(entry, *self._known).monoms():
            factors = list(chain(*([s] * p for s, p in zip(self._known, powers, strict=True))))
            value = entry
            for symbol in factors:
                value = sp.diff(value, symbol)
            for power in powers:
                value /= sp.factorial(power)
            value = value.xreplace(dict.fromkeys(self._known, sp.S.Zero))
            total += value * self._factor(factors, free)
        return total

    def _factor(self, factors: list[sp.Symbol], free: int) -> sp.Expr:
        """Return what a product of amplitudes and numbers of one mode stands for."""
        vectors = [self._vectors[s] for s in factors if s in self._vectors]
        matrices = [self._matrices[s] for s in factors if s in self._matrices]
        held = [v for v in vectors if v in self._amplitudes]
        shape = (free, len(vectors), len(matrices))
        if shape in ((0, 0, 0), (1, 1, 0)):
            return sp.Mul(*vectors)
        if shape in ((2, 0, 0), (2, 0, 1), (2, 1, 0)) and not held:
            return sp.Mul(*matrices, *vectors, *([] if matrices or vectors else [IDENTITY]))
        if shape == (0, 2, 0) and held:
            return self._named(ModeSum(*vectors))
        if shape == (1, 1, 1) and held:
            return self._named(ModeProduct(*matrices, *held))
        if shape == (0, 2, 1) and len(held) == 2:
            product = self._named(ModeProduct(*matrices, held[0]))
            return self._named(ModeSum(held[1], product))
        if shape == (1, 2, 0) and len(held) == 1:
            return sp.Mul(*vectors)
        raise UnsafeRewriting(f"{sp.Mul(*factors)} in an entry with {free} indices is no sum")

    def _named(self, value: sp.Expr) -> sp.Symbol:
        name = sp.Symbol("_".join(argument.name for argument in value.args))
        self.steps[name] = value
        return name

    def _verify(
        self,
        name: str,
        closed: sp.ImmutableDenseMatrix,
        last: tuple[int, ...],
        two: sp.ImmutableDenseMatrix,
    ) -> None:
        """Compare a closed matrix at two modes with the one derived for two modes."""
        for place in product(range(two.rows), range(two.cols)):
            modes = [
                index - end + 1 for index, end in zip(place, last, strict=True) if 0 <= end <= index
            ]
            at = tuple(
                min(index, end) if end >= 0 else index
                for index, end in zip(place, last, strict=True)
            )
            value = closed[at].xreplace(self._at_two_modes(tuple(modes)))
            if sp.expand(value - two[place]) != 0:
                raise UnsafeRewriting(f"{name}: entry {place} of two modes is {two[place]}")

    def _at_two_modes(self, modes: tuple[int, ...]) -> dict[sp.Symbol, sp.Expr]:
        """Return what sums, vectors and matrices are at two modes, in an entry of given modes."""
        key = (modes, len(self.steps))
        if key in self._tables:
            return self._tables[key]
        table: dict[sp.Symbol, sp.Expr] = {}
        for symbol, step in self.steps.items():
            if isinstance(step, ModeSum):
                pairs = [[self._at(vector, i) for vector in step.args] for i in _TWO]
                table[symbol] = sp.Add(*(sp.Mul(*pair) for pair in pairs))
            elif len(modes) == 1:
                table[symbol] = self._at(symbol, modes[0])
        if len(modes) == 1:
            table |= self.modes.vector(modes[0])
        elif len(modes) == 2:
            table |= self.modes.matrix(*modes)
        self._tables[key] = table
        return table

    def _at(self, vector: sp.Symbol, i: int) -> sp.Expr:
        """Return the entry of a vector at a mode."""
        step = self.steps.get(vector)
        if step is None:
            return self.modes.vector(i)[vector]
        matrix, held = step.args
        return sp.Add(*(self.modes.matrix(i, j)[matrix] * self._at(held, j) for j in _TWO))


_TWO = (1, 2)
