"""What a sweep gives: arrays over its grid, and a picture of one or two of its axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.plotting import Axes, axes_or_new
from ..core.results import Result

if TYPE_CHECKING:
    import xarray

AnyArray = NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class Sweep(Result):
    """Arrays over all combinations of values.

    Attributes
    ----------
    what : str
        What was worked out.
    axes : mapping of str to ndarray
        Values along each axis [SI], the last running fastest.
    outputs : mapping of str to ndarray
        Shape ``(*grid, ...)``, the grid having the lengths of the axes; of a folder read-only maps
        of its files.
    pieces : int
        How many pieces there were.
    resumed : int
        How many of them were in the store beforehand.
    store : Path or None
        Where it is kept.
    damaged : tuple of str
        What of the store was not as it had been written, and was done anew.
    failures : mapping of int to str
        Errors of the points that could not be worked out, by their place in the flattened grid.
    error : float
        Largest error estimate of the pieces, in the norm of what was worked out; NaN where that has
        none.
    """

    what: str
    axes: Mapping[str, NDArray[np.float64]]
    outputs: Mapping[str, AnyArray]
    pieces: int
    resumed: int = 0
    store: Path | None = None
    damaged: tuple[str, ...] = ()
    failures: Mapping[int, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> AnyArray:
        """Return one array by name.

        Raises
        ------
        BadInput
            If there is none of that name.
        """
        if name not in self.outputs:
            fix = "choose one of these"
            raise bad("sweep", f"output {name!r}", f"one of {sorted(self.outputs)}", fix)
        return self.outputs[name]

    def arrays(self) -> dict[str, AnyArray]:
        """Return the values of the axes, as ``axis_NAME``, and the outputs."""
        axes = {f"axis_{name}": values for name, values in self.axes.items()}
        return {**axes, **self.outputs}

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings; of what a store holds shapes and types alone."""
        if self.store is None:
            return super().to_dict()
        out = replace(self, axes={}, outputs={}, store=None).to_dict()
        out["axes"] = {
            name: {"first": float(axis[0]), "last": float(axis[-1]), "count": len(axis)}
            for name, axis in self.axes.items()
        }
        out["outputs"] = {
            name: {"shape": list(array.shape), "type": array.dtype.name}
            for name, array in self.outputs.items()
        }
        return {**out, "store": str(self.store)}

    def to_xarray(self) -> xarray.Dataset:
        """Return the outputs over their axes as an :class:`xarray.Dataset` (extra ``data``)."""
        plain = super().to_xarray()
        names = tuple(self.axes)
        data = {
            name: ((*names, *(f"{name}_{i}" for i in range(array.ndim - len(names)))), array)
            for name, array in self.outputs.items()
        }
        coordinates = {name: (name, values) for name, values in self.axes.items()}
        return type(plain)(data, coords=coordinates, attrs=plain.attrs)

    def plot(self, ax: Axes | None = None, *, output: str | None = None) -> Axes:
        """Draw an output over one axis, or as a map over two, and return the axes.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        output : str, optional
            Which one; by default the first that has one number at each point.

        Raises
        ------
        BadInput
            If there are more than two axes, or no such output.
        """
        if len(self.axes) > 2:
            raise bad("Sweep.plot", f"{len(self.axes)} axes", "one or two", "use the outputs")
        plain = [name for name, array in self.outputs.items() if array.ndim == len(self.axes)]
        usual = "stable" if "stable" in plain else (plain or list(self.outputs))[0]
        name = usual if output is None else output
        ax = axes_or_new(ax)
        # Most points along an axis of a picture; of more, evenly chosen ones are drawn.
        thin = [slice(None, None, -(-len(v) // 1200)) for v in self.axes.values()]
        values = [axis[part] for axis, part in zip(self.axes.values(), thin, strict=True)]
        shown = np.asarray(self[name][tuple(thin)])
        labels = list(self.axes)
        ax.set_xlabel(labels[-1])
        if len(labels) == 1:
            ax.plot(values[0], shown.reshape(len(shown), -1), linewidth=0.9)
            ax.set_ylabel(name)
            return ax
        if shown.ndim != 2:
            fix = "draw a part of it by yourself"
            raise bad("Sweep.plot", f"output {name!r} of several numbers", "one at each point", fix)
        ax.set_ylabel(labels[0])
        if shown.dtype == bool:
            # Grey where it is false, as the unstable part of a chart.
            grey: dict[str, Any] = {"cmap": "gray", "vmin": -4.0, "vmax": 1.0}
            ax.pcolormesh(values[1], values[0], shown.astype(float), shading="nearest", **grey)
            ax.set_title(f"white: {name}")
            return ax
        mesh = ax.pcolormesh(values[1], values[0], shown.astype(float), shading="nearest")
        ax.figure.colorbar(mesh, ax=ax, label=name)
        return ax
