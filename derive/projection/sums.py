"""Arrays being summed up from coefficients of jets: which power of the crank's rate goes where."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

import sympy as sp

from ..arrays import ArrayEntry, BasisEntry, CrankMotion, IndexedEntry, IndexedVector
from ..lagrange import NotRepresentable
from ..variational import in_crank_angle

Powers: TypeAlias = tuple[int, int]
_STIFFNESS: dict[Powers, str] = {(0, 0): "K", (2, 0): "B", (0, 1): "S"}
_FORCING: dict[Powers, str] = {(2, 0): "f", (1, 0): "h", (0, 1): "g", (0, 0): "p"}


@dataclass
class ArraySum:
    """Arrays being summed up, by name."""

    crank: CrankMotion
    t: sp.Symbol
    followers: Mapping[sp.Expr, sp.Expr]
    geometric: tuple[sp.Symbol, ...]
    entries: dict[str, ArrayEntry] = field(default_factory=dict)

    def by_powers(self, weight: sp.Expr) -> dict[Powers, sp.Expr]:
        """Split a coefficient by powers of the crank's rate and acceleration."""
        plain = in_crank_angle(weight, self.crank, self.t, self.followers)
        rates = (self.crank.rate, self.crank.acceleration)
        split: dict[Powers, sp.Expr] = {}
        for term in sp.Add.make_args(sp.expand(plain)):
            rest, powers = term, [0, 0]
            for index, rate in enumerate(rates):
                rest, exponent = rest.as_coeff_exponent(rate)
                if rest.has(rate) or not (exponent.is_Integer and exponent >= 0):
                    raise NotRepresentable(f"{term} is no polynomial in {rates}")
                powers[index] = int(exponent)
            key = (powers[0], powers[1])
            split[key] = split.get(key, sp.S.Zero) + rest
        return {key: value for key, value in split.items() if value != 0}

    def add(self, name: str, entry: ArrayEntry) -> None:
        """Add to an array."""
        known = self.entries.get(name)
        self.entries[name] = entry if known is None else plus(known, entry)

    def stiffness(self, weight: sp.Expr, powers: Powers) -> list[tuple[str, sp.Expr]]:
        """Return where a displacement term of the force side goes, with its sign."""
        name = _STIFFNESS.get(powers)
        if name is None:
            raise NotRepresentable(f"stiffness {weight} with rate powers {powers} has no array")
        if name != "K":
            return [(name, weight)]
        terms = sp.Add.make_args(sp.expand(weight))
        moved = sp.Add(*(e for e in terms if self.geometric and e.has(*self.geometric)))
        parts = [("K", -sp.expand(weight - moved)), ("Kg", -moved)]
        return [(key, value) for key, value in parts if value != 0]

    def forcing(self, powers: Powers, what: sp.Expr) -> str:
        """Return where a force goes."""
        name = _FORCING.get(powers)
        if name is None:
            raise NotRepresentable(f"force {what} with rate powers {powers} has no array")
        return name


def plus(a: ArrayEntry, b: ArrayEntry) -> ArrayEntry:
    """Return the sum of two arrays of one kind."""
    if isinstance(a, IndexedEntry) and isinstance(b, IndexedEntry):
        return a.plus(b)
    if isinstance(a, IndexedVector) and isinstance(b, IndexedVector):
        return a.plus(b)
    if isinstance(a, BasisEntry) and isinstance(b, BasisEntry):
        return a.plus(b)
    return _explicit(a) + _explicit(b)


def _explicit(entry: ArrayEntry) -> sp.ImmutableDenseMatrix:
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        raise TypeError(f"{entry} is not an explicit matrix")
    return entry


def mapped(entry: ArrayEntry, function: Callable[[sp.Expr], sp.Expr]) -> ArrayEntry:
    """Return an array with a function applied to each entry."""
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        return entry.map(function)
    return entry.applyfunc(function)


def transposed(entry: ArrayEntry) -> ArrayEntry:
    """Return the transposed matrix."""
    return entry.transposed() if isinstance(entry, IndexedEntry) else _explicit(entry).T


def vanishes(entry: ArrayEntry) -> bool:
    """Return True where every entry vanishes identically."""
    if isinstance(entry, IndexedEntry | IndexedVector | BasisEntry):
        return entry.is_zero
    return all(item == 0 for item in entry)
