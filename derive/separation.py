"""Separation: every array as a sum of scale (parameters) x function of angle x modal array.

All points of a sweep then share the functions of angle, whatever the parameters and the speed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeAlias, TypeVar

import sympy as sp

from .arrays import (
    MATRICES,
    BasisEntry,
    BasisIntegral,
    BasisProduct,
    DiscreteSystem,
    IndexedEntry,
    IndexedVector,
)
from .ir import Argument, Description, Kernel, ModuleSpec, Result, Table, drops_table
from .lowering import lower_kernel
from .spec import ModelSpec
from .staged import Steps

_Value = TypeVar("_Value")
BasisFactor: TypeAlias = BasisIntegral | BasisProduct


class NotSeparable(ValueError):  # noqa: N818 - reads as what it is
    """A term mixes parameters and angle in a way that no product of the two gives."""


@dataclass(frozen=True)
class StagedSystem:
    """A discrete system with what is needed to evaluate it.

    Attributes
    ----------
    system : DiscreteSystem
        The arrays.
    steps : Steps
        Closed forms of the quantities that follow the crank.
    parameters : tuple of Symbol
        Inertial and elastic parameters; every other symbol is angle, geometry or mode index.
    geometry : tuple of Symbol
        Arguments of the functions of angle, the angle first.
    external : tuple of Symbol
        Quantities that the caller evaluates at the angle and passes in.
    place : Symbol or None
        The step that is the parameter xi of shapes that the caller passes in.
    dropped : mapping
        Terms that a caller may leave out, to the system without them.
    """

    system: DiscreteSystem
    steps: Steps
    parameters: tuple[sp.Symbol, ...]
    geometry: tuple[sp.Symbol, ...]
    external: tuple[sp.Symbol, ...] = ()
    place: sp.Symbol | None = None
    dropped: Mapping[tuple[str, ...], DiscreteSystem] = field(default_factory=dict)


@dataclass(frozen=True)
class _Modal:
    """One modal array: a closed entry (m, n), a closed vector (m), or explicit numbers."""

    diagonal: sp.Expr
    off_diagonal: sp.Expr
    explicit: sp.ImmutableDenseMatrix | None = None


@dataclass(frozen=True)
class _Group:
    array: str
    scale: sp.Expr
    angle: sp.Expr
    modal: _Modal | BasisFactor


@dataclass(frozen=True)
class _Stages:
    """Which symbols belong to which stage."""

    angle: frozenset[sp.Symbol]
    parameters: frozenset[sp.Symbol]
    modal: frozenset[sp.Symbol]

    @classmethod
    def of(cls, staged: StagedSystem, indices: Iterable[sp.Symbol]) -> _Stages:
        follows = {staged.geometry[0], *staged.external}
        for symbol, value in staged.steps.steps:
            if value.free_symbols & follows:
                follows.add(symbol)
        return cls(frozenset(follows), frozenset(staged.parameters), frozenset(indices))

    def split(self, term: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """Return the scale, angle and modal factors of a product."""
        scale, angle, modal, geometry = (sp.Integer(1),) * 4
        for factor in sp.Mul.make_args(term):
            symbols = factor.free_symbols
            stages = [symbols & s for s in (self.parameters, self.angle, self.modal)]
            if sum(bool(s) for s in stages) > 1:
                raise NotSeparable(f"{factor} mixes {sorted(map(str, symbols))}")
            if stages[0]:
                scale *= factor
            elif stages[1]:
                angle *= factor
            elif stages[2] or not symbols:
                modal *= factor
            else:
                geometry *= factor
        if angle == 1:
            return scale * geometry, angle, modal
        return scale, angle * geometry, modal


def _collect(stages: _Stages, expression: sp.Expr) -> dict[tuple[sp.Expr, sp.Expr], sp.Expr]:
    parts: dict[tuple[sp.Expr, sp.Expr], sp.Expr] = {}
    for term in sp.Add.make_args(sp.expand(expression)):
        if term == 0:
            continue
        # Denominators in the mode numbers come expanded; factored, they split by stage.
        scale, angle, modal = stages.split(sp.factor(term) if stages.modal else term)
        parts[scale, angle] = parts.get((scale, angle), sp.Integer(0)) + modal
    return parts


def _groups(staged: StagedSystem, system: DiscreteSystem) -> list[_Group]:
    """Separate every array; terms that share scale and modal array are added up."""
    groups: list[_Group] = []
    for name, entry in system.arrays.items():
        if isinstance(entry, IndexedEntry | IndexedVector):
            groups += _closed_groups(staged, name, entry)
        elif isinstance(entry, BasisEntry):
            groups += _basis_groups(staged, name, entry)
        else:
            groups += _explicit_groups(staged, name, entry)
    return groups


def _closed_groups(
    staged: StagedSystem, name: str, entry: IndexedEntry | IndexedVector
) -> list[_Group]:
    if isinstance(entry, IndexedVector):
        stages = _Stages.of(staged, (entry.m,))
        diagonal, off = _collect(stages, entry.entry), {}
    else:
        stages = _Stages.of(staged, (entry.m, entry.n))
        diagonal, off = _collect(stages, entry.diagonal), _collect(stages, entry.off_diagonal)
    found: dict[tuple[sp.Expr, _Modal, bool], sp.Expr] = {}
    for scale, angle in _ordered({**diagonal, **off}):
        on, beside = diagonal.get((scale, angle), 0), off.get((scale, angle), 0)
        if on == beside == 0:
            continue
        modal, factor = _normalised(sp.sympify(on), sp.sympify(beside), constant=angle == 1)
        key = (scale, modal, angle == 1)
        found[key] = found.get(key, sp.Integer(0)) + factor * angle
    return [
        _Group(name, scale, angle, modal)
        for (scale, modal, _), angle in found.items()
        if angle != 0
    ]


def _basis_groups(staged: StagedSystem, name: str, entry: BasisEntry) -> list[_Group]:
    stages = _Stages.of(staged, ())
    groups = []
    for value, factor in entry.terms:
        for (scale, angle), number in _collect(stages, value).items():
            if angle == 1:
                groups.append(_Group(name, number * scale, angle, factor))
            else:
                groups.append(_Group(name, scale, number * angle, factor))
    return groups


def _normalised(diagonal: sp.Expr, off: sp.Expr, *, constant: bool) -> tuple[_Modal, sp.Expr]:
    """Return the modal array without its number and sign, and that number.

    A constant term keeps its number: as a function of angle it would no longer be constant.
    """
    diagonal, off = _tidy(diagonal), _tidy(off)
    if constant:
        return _Modal(diagonal, off), sp.Integer(1)
    lead = diagonal if diagonal != 0 else off
    factor, _ = lead.as_coeff_Mul()
    if not factor.is_Rational:
        factor = sp.Integer(1)
    return _Modal(diagonal / factor, off / factor), factor


def _tidy(expression: sp.Expr) -> sp.Expr:
    """Return a modal entry in one factored form, signs ``(-1)^m`` of two modes joined."""
    if expression.is_polynomial(*expression.free_symbols):
        return sp.expand(expression)
    return sp.powsimp(sp.factor(expression), combine="exp")


def _explicit_groups(
    staged: StagedSystem, name: str, matrix: sp.ImmutableDenseMatrix
) -> list[_Group]:
    stages = _Stages.of(staged, ())
    parts: dict[tuple[sp.Expr, sp.Expr], sp.Matrix] = {}
    for i in range(matrix.rows):
        for j in range(matrix.cols):
            for key, number in _collect(stages, matrix[i, j]).items():
                parts.setdefault(key, sp.zeros(*matrix.shape))[i, j] += number
    found: dict[tuple[sp.Expr, sp.ImmutableDenseMatrix, bool], sp.Expr] = {}
    for scale, angle in _ordered(parts):
        numbers = sp.ImmutableDenseMatrix(parts[scale, angle])
        # One sign of each matrix, so that functions of angle which differ in sign alone share it.
        negative = angle != 1 and next(item for item in numbers if item != 0) < 0
        sign = -1 if negative else 1
        shared = (scale, sign * numbers, angle == 1)
        found[shared] = found.get(shared, sp.Integer(0)) + sign * angle
    zero = sp.Integer(0)
    return [_Group(name, s, angle, _Modal(zero, zero, e)) for (s, e, _), angle in found.items()]


def _ordered(keys: Iterable[tuple[sp.Expr, sp.Expr]]) -> list[tuple[sp.Expr, sp.Expr]]:
    return sorted(keys, key=lambda key: (key[0].sort_key(), key[1].sort_key()))


class _Names(Generic[_Value]):
    """Distinct expressions of one stage and the names under which they are emitted."""

    def __init__(
        self,
        prefix: str,
        telling: frozenset[sp.Symbol] | None = None,
        external: tuple[sp.Symbol, ...] = (),
    ) -> None:
        self.prefix, self.telling, self.external = prefix, telling, external
        self.table: dict[_Value, str] = {}

    def __call__(self, value: _Value) -> str:
        if value not in self.table:
            self.table[value] = self._fresh(value)
        return self.table[value]

    def _fresh(self, value: _Value) -> str:
        count = len(self.table) + 1
        if not isinstance(value, sp.Expr) or self.telling is None:
            return f"{self.prefix}{count}"
        if value in self.external:
            return str(value)
        upper, lower = sp.fraction(sp.together(value))
        telling = value.free_symbols & self.telling or value.free_symbols
        parts = [_words(side.free_symbols & telling) for side in (upper, lower)]
        name = self.prefix + ("_over_".join(part for part in parts if part) or "number")
        while name in self.table.values():
            name = f"{name}_{count}"
        return name


def _words(symbols: Iterable[sp.Symbol]) -> str:
    return "_".join(sorted(symbol.name for symbol in symbols))


# Which emitted function gives the functions of angle of an array: what acts only while the crank
# accelerates, and forcing, stand apart, so that a constant-speed stability chart skips both.
_KERNELS = {
    "angle_functions": (("M", "A", "B", "C", "D", "K", "Kg"), "in the matrices"),
    "acceleration_functions": (("S",), "that act while the crank accelerates"),
    "forcing_functions": (("f", "h", "p"), "in the forcing"),
    "acceleration_forcing_functions": (("g",), "in the forcing while the crank accelerates"),
}
_KERNEL_OF = {array: name for name, (arrays, _) in _KERNELS.items() for array in arrays}


def lower_linear_periodic(
    spec: ModelSpec, staged: StagedSystem, description: Description
) -> ModuleSpec:
    """Return the module of a linear-periodic system: stages as functions, terms as a table.

    ``spec``: the model; ``staged``: arrays and the closed forms that they need; ``description``:
    words, units and arguments. Raises ``NotSeparable`` if an array is not a sum of products of
    parameters, functions of angle and modal arrays.
    """
    stages = _Stages.of(staged, ())
    scale_name: _Names[Any] = _Names("", stages.parameters)
    modal_name: _Names[tuple[_Modal, bool]] = _Names("modal_")
    angle_names: dict[str, _Names[Any]] = {
        kernel: _Names(kernel.removesuffix("functions"), stages.angle, staged.external)
        for kernel in _KERNELS
    }

    def row(group: _Group) -> tuple[object, ...]:
        angle_name = angle_names[_KERNEL_OF[group.array]]
        return (
            group.array,
            0,
            None if group.scale == 1 else scale_name(group.scale),
            None if group.angle == 1 else angle_name(group.angle),
            modal_name((group.modal, group.array in MATRICES))
            if isinstance(group.modal, _Modal)
            else group.modal.name,
        )

    groups = _groups(staged, staged.system)
    rows = [row(group) for group in groups]
    dropped = {}
    for terms, system in staged.dropped.items():
        others = _groups(staged, system)
        left = [row(group) for group in others]
        dropped[terms] = (
            tuple(r for r in rows if r not in left),
            tuple(r for r in left if r not in rows),
        )
        groups += others
    kernels = [_scales_kernel(scale_name, staged, description)]
    for kernel, (_, words) in _KERNELS.items():
        if set(angle_names[kernel].table) - set(staged.external):
            summary = f"Return the functions of angle {words}"
            kernels.append(_angle_kernel(kernel, summary, angle_names[kernel], staged, description))
    modal_kernels, tables = _modal(modal_name, staged)
    factors = [group.modal for group in groups if not isinstance(group.modal, _Modal)]
    if staged.place is not None:
        modal_kernels += _basis_kernels(factors, staged.place, staged.steps, description)
    external = Table("EXTERNAL", tuple(symbol.name for symbol in staged.external))
    return ModuleSpec(
        spec=spec,
        family="linear_periodic",
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=(*(k for k in kernels if k.results), *modal_kernels),
        parameters=description.parameters,
        tables=(
            external,
            *tables,
            *_basis_table(factors),
            Table("TERMS", tuple(rows), _TERMS),
            *drops_table(dropped),
        ),
    )


_TERMS = (
    "Separated terms: array, extra power of the crank speed, scale, function of angle, and modal "
    "array or integral over the shapes."
)


def _scales_kernel(names: _Names[Any], staged: StagedSystem, description: Description) -> Kernel:
    by_name = {argument.name: argument for argument in description.arguments}
    used = set().union(*(value.free_symbols for value in names.table), set())
    arguments = [
        *description.parameters,
        *(by_name[s.name] for s in staged.geometry if s in used and s.name in by_name),
    ]
    outputs = [
        (Result(name, "float or ndarray", "", ""), value) for value, name in names.table.items()
    ]
    return lower_kernel(
        "scales", "Return the factors made of parameters", arguments, Steps(), outputs
    )


def _angle_kernel(
    name: str, summary: str, names: _Names[Any], staged: StagedSystem, description: Description
) -> Kernel:
    outputs = [
        (Result(key, "ndarray, shape (...)", "", ""), value)
        for value, key in names.table.items()
        if value not in staged.external
    ]
    kept = staged.steps.needed([value for value in names.table])
    used = set().union(
        *(v.free_symbols for _, v in kept.steps), *(v.free_symbols for v in names.table)
    )
    arguments = [
        argument
        for argument in description.arguments
        if argument.name == staged.geometry[0].name or sp.Symbol(argument.name) in _plain(used)
    ]
    return lower_kernel(name, summary, arguments, staged.steps, outputs)


def _plain(symbols: Iterable[sp.Symbol]) -> set[sp.Symbol]:
    """Return symbols of the same names without assumptions, for comparison by name."""
    return {sp.Symbol(symbol.name) for symbol in symbols}


def _modal(
    names: _Names[tuple[_Modal, bool]], staged: StagedSystem
) -> tuple[tuple[Kernel, ...], tuple[Table, ...]]:
    """Return the kernels of closed modal arrays and the tables of explicit ones."""
    m, n = sp.symbols("m n", integer=True, positive=True)
    for entry in staged.system.arrays.values():
        if isinstance(entry, IndexedEntry):
            m, n = entry.m, entry.n
        elif isinstance(entry, IndexedVector):
            m = entry.m
    index = Argument("m", "ndarray, shape (N, 1)", "", "Mode numbers of the rows, from 1")
    column = Argument("n", "ndarray, shape (1, N)", "", "Mode numbers of the columns, from 1")
    apart = sp.Symbol("apart")
    matrices, vectors, tables = [], [], []
    for (modal, matrix), name in names.table.items():
        if modal.explicit is not None:
            tables.append(Table(name.upper(), _numbers(modal.explicit, column=not matrix)))
        elif matrix:
            off = modal.off_diagonal.subs(m - n, apart).subs(n - m, -apart)
            value = sp.Piecewise((modal.diagonal, sp.Eq(m, n)), (off, True))
            matrices.append((Result(name, "ndarray, shape (N, N)", "", ""), value))
        else:
            vectors.append((Result(name, "ndarray, shape (N,)", "", ""), modal.diagonal))
    kernels = []
    if matrices:
        # The difference of two mode numbers divides; on the diagonal it is not used.
        guard = Steps(((apart, sp.Piecewise((sp.Integer(1), sp.Eq(m, n)), (m - n, True))),))
        summary = "Return the modal arrays of the matrices"
        kernels.append(lower_kernel("modal_matrices", summary, (index, column), guard, matrices))
    if vectors:
        flat = Argument("m", "ndarray, shape (N,)", "", index.meaning)
        summary = "Return the modal arrays of the forcing"
        kernels.append(lower_kernel("modal_vectors", summary, (flat,), Steps(), vectors))
    return tuple(kernels), tuple(tables)


def _numbers(matrix: sp.ImmutableDenseMatrix, *, column: bool) -> tuple[Any, ...]:
    rows = [tuple(float(sp.N(item, 40)) for item in matrix.row(i)) for i in range(matrix.rows)]
    return tuple(row[0] for row in rows) if column else tuple(rows)


def _basis_table(factors: Iterable[BasisFactor]) -> tuple[Table, ...]:
    """Return the definitions of all integrals that the terms and their products need, once each.

    Raises ``ValueError`` if two different integrals bear one name.
    """
    found: dict[str, tuple[object, ...]] = {}
    for integral in _integrals(factors):
        row = (
            integral.name,
            _coefficients(integral),
            integral.row,
            integral.column,
            None if integral.at is None else float(integral.at),
        )
        if found.setdefault(integral.name, row) != row:
            raise ValueError(f"two integrals are called {integral.name}")
    return (Table("BASIS", tuple(found.values()), _INTEGRALS),) if found else ()


_INTEGRALS = (
    "Integrals over shapes e_i(eta; xi) that are passed in: name, coefficients of the weight by "
    "powers of eta, derivatives by eta and xi of the first and of the second factor, and the eta "
    "of a value that is no integral."
)


def _integrals(factors: Iterable[BasisFactor]) -> Iterable[BasisIntegral]:
    for factor in factors:
        if isinstance(factor, BasisIntegral):
            yield factor
        else:
            yield from factor.rows.values()
            yield from factor.columns.values()


def _coefficients(integral: BasisIntegral) -> tuple[float, ...]:
    coefficients = sp.Poly(integral.weight, integral.eta).all_coeffs()[::-1]
    return tuple(float(c) for c in coefficients)


def _basis_kernels(
    factors: Iterable[BasisFactor], place: sp.Symbol, steps: Steps, description: Description
) -> tuple[Kernel, ...]:
    """Return the function that gives the place xi, and the one that gives products of vectors.

    ``factors``: what the terms need; ``place``: the step that is xi; ``steps``: closed forms of
    what follows the crank; ``description``: words of the arguments.
    """
    used = {place.name}.union(*({s.name for s in v.free_symbols} for _, v in _chain(place, steps)))
    arguments = [a for a in description.arguments if a.name in used]
    if description.arguments[0] not in arguments:
        arguments.insert(0, description.arguments[0])
    words = "Place of the support as a fraction of the length"
    result = Result(place.name, "ndarray, shape (...)", "", words)
    summary = "Return the place of the support, on which the shapes depend"
    kernels = [lower_kernel(place.name, summary, arguments, steps, [(result, place)])]
    products = {f.name: f for f in factors if isinstance(f, BasisProduct)}
    if products:
        kernels.append(_products_kernel(list(products.values())))
    return tuple(kernels)


def _chain(place: sp.Symbol, steps: Steps) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    return steps.needed([place]).steps


def _products_kernel(products: list[BasisProduct]) -> Kernel:
    arguments: dict[str, Argument] = {}
    for shape, end in (("(..., N, 1)", "rows"), ("(..., 1, N)", "columns")):
        for product in products:
            for symbol, integral in getattr(product, end).items():
                words = f"The vector {integral.name}, along the {end}"
                arguments[symbol.name] = Argument(symbol.name, f"ndarray, shape {shape}", "", words)
    outputs = [(Result(p.name, "ndarray, shape (..., N, N)", "", ""), p.form) for p in products]
    summary = "Return the matrices that are made of products of integrals"
    return lower_kernel("basis_products", summary, list(arguments.values()), Steps(), outputs)
