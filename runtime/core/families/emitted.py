"""From an emitted module to what the families are made of: checked parameters, named arrays."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from types import ModuleType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..errors import bad
from .linear_periodic import Array

Places: TypeAlias = Mapping[str, tuple[tuple[int, int], tuple[tuple[int, int, int], ...]]]
Values: TypeAlias = Mapping[str, ArrayLike]


def check_module(module: ModuleType, family: str, given: Values) -> tuple[str, ...]:
    """Return the parameter names of a module of a family, having checked that none is missing."""
    found = getattr(module, "FAMILY", None)
    if found != family:
        raise bad(module.__name__, f"family {found}", family, "ask for a model of that family")
    names: tuple[str, ...] = module.PARAMETERS
    missing = sorted(set(names) - set(given))
    if missing:
        raise bad("parameters", f"none for {missing}", "a value each", "supply them")
    return names


def parameter_values(module: ModuleType, family: str, given: Values) -> dict[str, Any]:
    """Return the module's parameters as floats, or as arrays where a sweep gives arrays."""
    names = check_module(module, family, given)
    arrays = {name: np.asarray(given[name], dtype=float) for name in names}
    return {name: value if value.ndim else float(value) for name, value in arrays.items()}


def dropped_names(module: ModuleType, drop: Collection[str]) -> tuple[Any, ...]:
    """Return what vanishes or changes in a module, by its ``DROPS``, where terms are left out."""
    if not drop:
        return ()
    known = getattr(module, "DROPS", {})
    terms = tuple(sorted(drop))
    if terms not in known:
        raise bad("drop", terms, f"one of {sorted(known)}", "ask for a module without these terms")
    return tuple(known[terms])


def array_function(module: ModuleType, name: str) -> Callable[..., dict[str, Array]]:
    """Return an emitted function of explicit entries as one that returns arrays.

    It takes the arguments of the emitted function, which broadcast, and returns the arrays by name,
    each of shape ``(*batch, rows, columns)``.  A function that is not emitted because all its
    entries are zero gives zeros; one that the module does not know is refused.
    """
    known = getattr(module, "ARRAYS", {})
    if name not in known:
        found = f"no function {name} of arrays"
        raise bad(module.__name__, found, f"one of {sorted(known)}", "correct it")
    places: Places = known[name]
    function: Callable[..., object] = getattr(module, name, nothing)

    def arrays(*arguments: ArrayLike, **named: ArrayLike) -> dict[str, Array]:
        given = (*arguments, *named.values())
        shapes = [np.shape(item) for item in given if not isinstance(item, float)]
        batch = np.broadcast_shapes(*shapes) if any(shapes) else ()
        return stacked(places, function(*arguments, **named), batch)

    return arrays


def nothing(*arguments: object, **named: object) -> tuple[()]:
    """Return no entries: what a function would that was not emitted since all of them are zero."""
    return ()


def stacked(places: Places, returned: object, batch: tuple[int, ...] = ()) -> dict[str, Array]:
    """Return the arrays ``(*batch, rows, columns)`` of an emitted function by name.

    ``places`` gives the shape of each and the ``(row, column, position in what was returned)`` of
    its entries, which broadcast to ``batch``; all others are zero.
    """
    entries = returned if isinstance(returned, tuple) else (returned,)
    arrays = {}
    for name, (shape, filled) in places.items():
        array: Array = np.zeros((*batch, *shape))
        for row, column, position in filled:
            array[..., row, column] = entries[position]
        arrays[name] = array
    return arrays
