"""Results as tables of comma-separated values, and the units of their columns."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

# The dimensions of arrays that broadcast with each other, whatever their shapes.
BROADCAST = ("...",)

AnyArray = NDArray[Any]
# Label and length of each axis of an array.
Axes = Mapping[str, int]

# Units of names that mean the same wherever they occur: the names by their unit.
UNITS: Mapping[str, str] = {
    "rad/s": (
        "speed speeds scan_speed jump_speed crossing_speed crossing_error frequency frequencies "
        "tracked mean_frequency natural_frequency mean mean_error branch_mean branch_mean_error "
        "held running buckling omega2"
    ),
    "rad/s^2": "alpha2 acceleration",
    "rad": "theta theta2 angle transmission_angle at_least at_greatest crank_ranges",
    "s": "time t",
    "Hz": "hertz",
    "Pa": "quasi_static largest_stress",
    "N m": "torque moment mean_torque motor_torque",
    "J": "energy energy_fluctuation strain springs stiffening kinetic",
    "kg m^2": "inertia flywheel",
}

# Fields that name the places along an axis, and the axes that they may name.
LABELS: Mapping[str, tuple[str, ...]] = {
    "links": ("link", "station"),
    "labels": ("coordinate",),
    "rows": ("row",),
    "units": ("row",),
    "outputs": ("output",),
    "parameters": ("parameter",),
    "numbers": ("number",),
    "directions": ("direction",),
    "kind": ("point",),
    **{name: (name,) for name in ("unknown", "by", "region")},
}


def by_name(names: Mapping[str, str]) -> dict[str, str]:
    """Return by name what names stand under: their unit, or their axes."""
    return {name: what for what, some in names.items() for name in some.split()}


def with_unit(name: str, unit: str) -> str:
    """Return ``name [unit]``, the name alone of what has none."""
    return f"{name} [{unit}]" if unit else name


def tables(
    arrays: Mapping[str, AnyArray],
    dimensions: Mapping[str, tuple[str, ...]],
    units: Mapping[str, str],
) -> dict[str, str]:
    """Return tables by name; the first, without a name, holds the first array that has axes.

    There is a table for each set of axes that is no part of another one, with a row for each point
    and a column for each array that has some of the axes; in the first one what has none is
    repeated.  An axis along which no array lies alone is counted from 0.
    """
    axes = _axes(arrays, dimensions)
    order = list(arrays)
    filled = (axes[n] for n in order if n != "error" and axes[n] and arrays[n].size)
    main = next(filled, axes.get("error", {}))
    wholes: list[Axes] = [main] if 0 in main.values() else []
    for own in sorted(axes.values(), key=len, reverse=True):
        if 0 not in own.values() and not any(own.items() <= whole.items() for whole in wholes):
            wholes.append(own)
    wholes.sort(key=list(axes.values()).index)
    begun = next(whole for whole in wholes if main.items() <= whole.items())
    found = {"": _table(arrays, axes, begun, units, [n for n in order if not axes[n]])}
    for whole in wholes:
        if whole is not begun:
            found["_".join(whole)] = _table(arrays, axes, whole, units, [])
    return found


def labels_of(
    arrays: Mapping[str, AnyArray], dimensions: Mapping[str, tuple[str, ...]]
) -> dict[str, tuple[str, ...]]:
    """Return the labels of each array's axes, of those that declare them or have none."""
    declared = {name: dimensions.get(name, ()) for name in arrays}
    # How many axes stand for the dots of BROADCAST.
    dotted = {
        name: arrays[name].ndim - len(names) + 1
        for name, names in declared.items()
        if names[:1] == BROADCAST
    }
    most, found = max(dotted.values(), default=0), {}
    for name, names in declared.items():
        n = arrays[name].ndim
        if name in dotted:
            lead = (f"axis_{i}" for i in range(most - dotted[name], most))
            found[name] = (*lead, *names[1:])
        elif names or not n:
            extra = (f"{names[-1]}_{i}" for i in range(1, n - len(names) + 1))
            found[name] = (*names, *extra)[:n]
    return found


def _axes(
    arrays: Mapping[str, AnyArray], dimensions: Mapping[str, tuple[str, ...]]
) -> dict[str, Axes]:
    """Return label and length of the axes of each array, less those of length 1."""
    # Arrays without declared dimensions belong together where their shapes are the same.
    known, found = labels_of(arrays, dimensions), dict[str, Axes]()
    for name, array in arrays.items():
        shape = "x".join(map(str, array.shape))
        alike = tuple(f"axis_{i}_of_{shape}" for i in range(array.ndim))
        pairs = zip(known.get(name, alike), array.shape, strict=True)
        found[name] = {label: size for label, size in pairs if size != 1}
    return found


def _table(
    arrays: Mapping[str, AnyArray],
    axes: Mapping[str, Axes],
    whole: Axes,
    units: Mapping[str, str],
    single: list[str],
) -> str:
    """Return header and rows of the arrays that broadcast to some axes."""
    shape = tuple(whole.values())
    chosen = [n for n in arrays if n in single or (axes[n] and axes[n].items() <= whole.items())]
    # What names a point stands first, and how well it is known last.
    places = (next((n for n in chosen if list(axes[n]) == [k]), "") for k in whole)
    named = [name for name in places if name and name != "error"]
    chosen = sorted(chosen, key=lambda name: (name == "error", name not in named))
    columns: dict[str, AnyArray] = {}
    for place, label in enumerate(whole):
        if not any(list(axes[name]) == [label] for name in chosen):
            name = f"{label}_number" if label in arrays else label
            columns[name] = np.indices(shape)[place].ravel()
    for name in chosen:
        own = [label for label in whole if label in axes[name]]
        # The order of an array's own axes may be another than that of the table.
        turned = arrays[name].squeeze().transpose([list(axes[name]).index(k) for k in own])
        spread = turned.reshape([whole[label] if label in own else 1 for label in whole])
        column = np.broadcast_to(spread, shape).ravel()
        if np.iscomplexobj(column):
            columns[with_unit(f"{name}_real", units.get(name, ""))] = column.real
            columns[with_unit(f"{name}_imag", units.get(name, ""))] = column.imag
        else:
            columns[with_unit(name, units.get(name, ""))] = column
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    rows.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
    return text.getvalue()
