"""Sums over the modes at the block, formed once: what keeps the emitted constrained code short."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ..entries import ConstrainedSystem
from ..external import external_values
from ..records import EquationsOfMotion, VariationalEquations
from ..safe import UnsafeRewriting
from ..staged import Step, Steps

_WORDS = ("value", "slope", "curvature", "third")
_ENDINGS = {"": "", "_dot": "_rate", "_ddot": "_second_rate"}


def with_block_sums(
    equations: EquationsOfMotion, variations: VariationalEquations, steps: Steps, modes: int
) -> ConstrainedSystem:
    """Write the equations in ``sum_i f_i psi_i'`` and the like, which many entries share.

    Parameters
    ----------
    equations, variations
        In coordinates ``f1, f2, ...`` and open functions ``psi_1, psi_2, ...``.
    steps : Steps
        Named numbers.
    modes : int
        How many.

    Raises
    ------
    UnsafeRewriting
        If an entry is not bilinear in amplitudes and modes.
    """
    matrices = {
        (kind, name): getattr(record, name)
        for kind, record in (("equations", equations), ("variations", variations))
        for name, value in vars(record).items()
        if isinstance(value, sp.ImmutableDenseMatrix)
    }
    opened = external_values(matrices.values())
    back = {symbol: item for item, symbol in opened.table.items()}
    sums = _Sums(modes)
    found: dict[str, dict[str, sp.ImmutableDenseMatrix]] = {"equations": {}, "variations": {}}
    for (kind, name), matrix in matrices.items():
        plain = opened.plain(matrix)
        found[kind][name] = sp.ImmutableDenseMatrix(plain.applyfunc(sums.grouped).xreplace(back))
    named = [(symbol, value.xreplace(back)) for symbol, value in sums.steps()]
    return ConstrainedSystem(
        replace(equations, **found["equations"]),
        replace(variations, **found["variations"]),
        steps.then(*named),
    )


class _Sums:
    """The sums that entries have been written in."""

    def __init__(self, modes: int) -> None:
        indices = range(1, modes + 1)
        self._modes = [
            [sp.Symbol(f"psi_{i}" + (f"_d{order}" if order else "")) for i in indices]
            for order in range(len(_WORDS))
        ]
        self._rates = {ending: [sp.Symbol(f"f{i}{ending}") for i in indices] for ending in _ENDINGS}
        self._used: dict[sp.Symbol, sp.Expr] = {}

    def steps(self) -> tuple[Step, ...]:
        """Return the sums, by name."""
        return tuple(sorted(self._used.items(), key=lambda item: item[0].name))

    def grouped(self, entry: sp.Expr) -> sp.Expr:
        """Return an entry with its terms in all modes alike as products of sums."""
        every = [symbol for row in self._modes for symbol in row]
        if not entry.free_symbols & set(every):
            return entry
        total = _without(entry, every)
        for order, row in enumerate(self._modes):
            total += self._of_order(order, [sp.diff(entry, symbol) for symbol in row])
        if sp.expand(total.xreplace(self._used) - entry) != 0:
            raise UnsafeRewriting(f"{entry} is not bilinear in amplitudes and modes")
        return total

    def _of_order(self, order: int, factors: Sequence[sp.Expr]) -> sp.Expr:
        amplitudes = [symbol for row in self._rates.values() for symbol in row]
        row = self._modes[order]
        total = sum(
            _without(factor, amplitudes) * mode for factor, mode in zip(factors, row, strict=True)
        )
        for ending, rates in self._rates.items():
            shared = [sp.diff(f, rate) for f, rate in zip(factors, rates, strict=True)]
            if not any(shared):
                continue
            name = sp.Symbol(f"{_WORDS[order]}{_ENDINGS[ending]}")
            self._used[name] = sp.Add(*(f * psi for f, psi in zip(rates, row, strict=True)))
            total += shared[0] * name
        return total


def _without(expression: sp.Expr, symbols: Sequence[sp.Symbol]) -> sp.Expr:
    return expression.xreplace(dict.fromkeys(symbols, sp.S.Zero))
