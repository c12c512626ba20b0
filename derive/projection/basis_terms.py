"""What a module says of integrals over shapes that are passed in: their table and functions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

import sympy as sp

from ..arrays import BasisIntegral, BasisProduct
from ..describe import Description
from ..ir import Argument, BasisRow, Kernel, Result
from ..lowering import lower_kernel
from ..staged import Steps

BasisFactor: TypeAlias = BasisIntegral | BasisProduct


def basis_rows(factors: Iterable[BasisFactor]) -> tuple[BasisRow, ...]:
    """Return the definitions of all integrals that the terms and their products need, once each.

    Raises
    ------
    ValueError
        If two different integrals bear one name.
    """
    found: dict[str, BasisRow] = {}
    for integral in _integrals(factors):
        row = BasisRow(
            integral.name,
            _coefficients(integral),
            integral.row,
            integral.column,
            None if integral.at is None else float(integral.at),
        )
        if found.setdefault(integral.name, row) != row:
            raise ValueError(f"two integrals are called {integral.name}")
    return tuple(found.values())


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


def basis_kernels(
    factors: Iterable[BasisFactor], place: sp.Symbol, steps: Steps, description: Description
) -> tuple[Kernel, ...]:
    """Return the function that gives the place xi, and the one that gives products of vectors.

    Parameters
    ----------
    factors : iterable of BasisIntegral or BasisProduct
        What the terms need.
    place : Symbol
        The step that is xi.
    steps : Steps
        Closed forms of what follows the crank.
    description : Description
        Words of the arguments.
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
    outputs = [
        (Result(p.name, "ndarray, shape (..., N, N)", "", f"Entries {p.form}"), p.form)
        for p in products
    ]
    summary = "Return the matrices that are made of products of integrals"
    return lower_kernel("basis_products", summary, list(arguments.values()), Steps(), outputs)
