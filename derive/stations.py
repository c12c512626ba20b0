"""Constrained equations closed in the stations along a link: derived at two, valid for any number.

A link that bends far is described by the angle of its tangent at stations along it.  Its energies
and constraints are sums over the stations, and over pairs of them with symmetric kernels, such as
``inertia_1_2 cos(phi1 - phi2) phi1_dot phi2_dot``.  What two stations say with numbers, any number
of them says with vectors and matrices: a factor of the other station becomes a product with the
kernel, a sum over both a sum over all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import sympy as sp

from .records import EquationsOfMotion, VariationalEquations
from .safe import UnsafeRewriting

_ENDINGS = ("", "_dot", "_ddot")
EACH_STATION = "ndarray, shape (Q, N)"  # the shape of what has a value at each station
_Kernels: TypeAlias = dict[tuple[sp.Expr, sp.Symbol], sp.Expr]


class StationSum(sp.Function):  # type: ignore[misc]
    """The sum over the stations of an expression that has a value at each."""

    nargs = 1


class StationProduct(sp.Function):  # type: ignore[misc]
    """A symmetric kernel of the stations times an expression that has a value at each."""

    nargs = 2


@dataclass(frozen=True)
class Stations:
    """What bears an index for each station.

    Attributes
    ----------
    angle : str
        Coordinate: ``phi1``, ``phi2``, ... where it is ``phi``; the last one of the closed system.
    tangent : tuple of str
        Its cosine and its sine, which all functions are handed.
    vectors, matrices : tuple of str
        Numbers ``end_1`` of each station, and symmetric ones ``inertia_1_2`` of each pair.
    """

    angle: str
    tangent: tuple[str, str]
    vectors: tuple[str, ...]
    matrices: tuple[str, ...]

    @property
    def numbers(self) -> tuple[str, ...]:
        """Names of the numbers of stations and pairs."""
        return self.vectors + self.matrices

    def at(self, i: int) -> dict[sp.Symbol, sp.Symbol]:
        """Return the symbol of a whole vector by its entry at station i."""
        entries = {f"{self.angle}{i}{ending}": self.angle + ending for ending in _ENDINGS}
        entries |= {f"{name}_{i}": name for name in self.vectors}
        return {sp.Symbol(entry): sp.Symbol(name) for entry, name in entries.items()}

    def pair(self, name: str, i: int, j: int) -> sp.Symbol:
        """Return the entry of a kernel at two stations."""
        return sp.Symbol("_".join([name, *map(str, sorted((i, j)))]))


@dataclass(frozen=True)
class Block:
    """A matrix over the stations: ``diag(diagonal) + sum diag(left) kernel diag(right)``."""

    diagonal: sp.Expr
    products: tuple[tuple[sp.Expr, sp.Symbol, sp.Expr], ...]

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """The diagonal and the factors of the products."""
        return (
            self.diagonal,
            *(side for left, _, right in self.products for side in (left, right)),
        )

    def with_each(self, change: Callable[[sp.Expr], sp.Expr]) -> Block:
        """Return the matrix with every expression changed."""
        products = ((change(left), kernel, change(right)) for left, kernel, right in self.products)
        return Block(change(self.diagonal), tuple(products))


@dataclass(frozen=True)
class StationArrays:
    """Arrays of the equations with the angles as one last coordinate.

    Attributes
    ----------
    equations : EquationsOfMotion
    variations : VariationalEquations
        Rows and columns of the last coordinate hold vectors over the stations; the entry where
        both meet is zero here and stands in ``blocks``.
    blocks : mapping
        Array name to its matrix over the stations.
    """

    equations: EquationsOfMotion
    variations: VariationalEquations
    blocks: dict[str, Block]


def closed_in_stations(
    stations: Stations, equations: EquationsOfMotion, variations: VariationalEquations
) -> StationArrays:
    """Return the equations for any number of stations from those of two.

    The angles at both stations are the last two coordinates.  Raises ``UnsafeRewriting`` where an
    entry is no sum over stations and pairs of them.
    """
    closing = _Closing(stations)
    blocks: dict[str, Block] = {}
    closed_equations = closing.record(equations, blocks)
    return StationArrays(closed_equations, closing.record(variations, blocks), blocks)


# Which of its rows and columns stand for coordinates.
_BY_ROW = ("mass", "damping", "stiffness", "rest", "forces")
_BY_COLUMN = ("mass", "damping", "stiffness", "jacobian", "jacobian_rate", "jacobian_acceleration")


class _Closing:
    """Entries at two stations, rewritten for any number."""

    def __init__(self, stations: Stations) -> None:
        self.stations = stations
        self._own = [stations.at(i) for i in (1, 2)]
        self._second = {b: a for a, b in zip(*self._own, strict=True)}  # 2 -> 1
        self._kernels = {
            stations.pair(name, i, j): (sp.Symbol(name), (i, j))
            for name in stations.matrices
            for i, j in ((1, 1), (1, 2), (2, 2))
        }
        angle, tangent = sp.Symbol(stations.angle), map(sp.Symbol, stations.tangent)
        self._tangent = dict(zip((sp.cos(angle), sp.sin(angle)), tangent, strict=True))
        self._second |= {
            stations.pair(name, 2, 2): stations.pair(name, 1, 1) for name in stations.matrices
        }

    def record(self, two: Any, blocks: dict[str, Block]) -> Any:
        """Return equations or variations with one coordinate for all stations."""
        changes: dict[str, Any] = {}
        for name, matrix in vars(two).items():
            if isinstance(matrix, sp.ImmutableDenseMatrix):
                changes[name] = self._matrix(name, matrix, blocks)
        for name in ("coordinates", "velocities", "accelerations"):
            if symbols := getattr(two, name, ()):
                changes[name] = (*symbols[:-2], self._own[0][symbols[-2]])
        return replace(two, **changes)

    def _matrix(
        self, name: str, matrix: sp.ImmutableDenseMatrix, blocks: dict[str, Block]
    ) -> sp.ImmutableDenseMatrix:
        rows, columns = name in _BY_ROW, name in _BY_COLUMN
        if not matrix.rows or not matrix.cols:
            return matrix[: matrix.rows - rows, : matrix.cols - columns]
        last = matrix.rows - 2 if rows else matrix.rows, matrix.cols - 2 if columns else matrix.cols
        if rows and columns:
            blocks[name] = self._block(matrix[-2:, -2:])

        def entry(i: int, j: int) -> sp.Expr:
            if i == last[0] and j == last[1]:
                return sp.S.Zero
            if i == last[0] or j == last[1]:
                return self._vector(matrix[i, j])
            return self._scalar(matrix[i, j])

        shape = matrix.rows - rows, matrix.cols - columns
        return sp.ImmutableDenseMatrix(*shape, entry)

    def _parts(
        self, term: sp.Expr
    ) -> tuple[sp.Expr, sp.Expr, sp.Expr, tuple[sp.Symbol, tuple[int, int]] | None]:
        """Return the factors of a product by station 1, station 2 and none, and its kernel."""
        own: list[list[sp.Expr]] = [[], [], []]
        kernel = None
        for factor in sp.Mul.make_args(term):
            used = factor.free_symbols
            if factor in self._kernels and kernel is None:
                kernel = self._kernels[factor]
                continue
            places = [i for i in (0, 1) if used & self._own[i].keys()]
            if len(places) > 1 or used & self._kernels.keys():
                raise UnsafeRewriting(f"{factor} joins two stations")
            own[places[0] if places else 2].append(factor)
        first, second, rest = (sp.Mul(*factors) for factors in own)
        return first, second, rest, kernel

    def _expanded(self, entry: sp.Expr) -> Iterable[sp.Expr]:
        """Yield the terms of an entry, each a product of factors of one station each."""
        opened = sp.expand(sp.expand_trig(entry))
        return [] if opened == 0 else sp.Add.make_args(opened)

    def _whole(self, entry: sp.Expr) -> sp.Expr:
        return entry.xreplace(self._own[0]).xreplace(self._own[1]).xreplace(self._tangent)

    def _scalar(self, entry: sp.Expr) -> sp.Expr:
        """Return an entry without an index: what has one is summed over the stations."""
        sums, alone = [sp.S.Zero, sp.S.Zero], sp.S.Zero
        for term in self._expanded(entry):
            first, second, rest, kernel = self._parts(term)
            if kernel is not None or (first != 1 and second != 1):
                raise UnsafeRewriting(f"{term} is no sum over the stations")
            if first == second:
                alone += rest
            else:
                sums[first == 1] += term
        if sp.expand(sums[1].xreplace(self._second) - sums[0]) != 0:
            raise UnsafeRewriting(f"{entry} treats the stations differently")
        total = StationSum(sp.factor_terms(self._whole(sums[0]))) if sums[0] != 0 else sp.S.Zero
        return alone + total

    def _vector(self, entry: sp.Expr) -> sp.Expr:
        """Return an entry with the index of station 1."""
        products: _Kernels = {}
        local: dict[sp.Expr, sp.Expr] = {}  # by the factor of the station
        same = sp.S.Zero
        for term in self._expanded(entry):
            first, second, rest, kernel = self._parts(term)
            if kernel is None and second == 1:
                local[first] = local.get(first, sp.S.Zero) + rest
            elif kernel is not None and kernel[1] == (1, 1) and second == 1:
                same += term
            elif kernel is not None and kernel[1] == (1, 2):
                _add(products, (first, kernel[0]), second * rest)
            else:
                raise UnsafeRewriting(f"{term} is no sum over pairs of stations")
        self._verify(products, same)
        return self._local(local) + self._total(products)

    def _local(self, factors: dict[sp.Expr, sp.Expr]) -> sp.Expr:
        """Return the sum of factors of a station times what has no index, taken together."""
        return sp.Add(
            *(self._whole(first) * sp.factor_terms(rest) for first, rest in factors.items())
        )

    def _total(self, products: _Kernels) -> sp.Expr:
        """Return the sum of factors of a station times kernels times those of the other."""
        return sp.Add(
            *(
                self._whole(left) * StationProduct(kernel, sp.factor_terms(self._whole(right)))
                for (left, kernel), right in products.items()
            )
        )

    def _verify(self, products: _Kernels, same: sp.Expr) -> None:
        """Verify that a station pairs with itself as with the other."""
        for (left, kernel), right in products.items():
            own = self.stations.pair(kernel.name, 1, 1)
            same -= own * left * right.xreplace(self._second)
        if sp.expand(sp.expand_trig(same)) != 0:
            raise UnsafeRewriting(f"{same}: a station pairs with itself in another way")

    def _block(self, matrix: sp.Matrix) -> Block:
        """Return the matrix of the stations from the one of two."""
        beside: _Kernels = {}
        for term in self._expanded(matrix[0, 1]):
            first, second, rest, kernel = self._parts(term)
            if kernel is None or kernel[1] != (1, 2):
                raise UnsafeRewriting(f"{term} has no kernel")
            _add(beside, (first, kernel[0]), second * rest)
        within: _Kernels = {}
        local: dict[sp.Expr, sp.Expr] = {}
        same = sp.S.Zero
        for term in self._expanded(matrix[0, 0]):
            first, second, rest, kernel = self._parts(term)
            if kernel is None and second == 1:
                local[first] = local.get(first, sp.S.Zero) + rest
            elif kernel is not None and kernel[1] == (1, 1) and second == 1:
                same += term
            elif kernel is not None and kernel[1] == (1, 2):
                _add(within, (first, kernel[0]), second * rest)
            else:
                raise UnsafeRewriting(f"{term} is no sum over pairs of stations")
        both = dict(beside)
        for key, right in within.items():
            _add(both, key, right)
        self._verify(both, same)
        diagonal = self._local(local) + self._total(within)
        pairs = (
            (self._whole(left), kernel, sp.factor_terms(self._whole(right)))
            for (left, kernel), right in beside.items()
        )
        return Block(diagonal, tuple(pairs))


def _add(products: _Kernels, key: tuple[sp.Expr, sp.Symbol], value: sp.Expr) -> None:
    products[key] = sp.expand(products.get(key, sp.S.Zero) + value)
