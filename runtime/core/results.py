"""What every solver returns: values, method, error, self-checks, provenance."""

from __future__ import annotations

import io
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from ..._files import write_whole as _write_whole
from .errors import SelfCheckFailed, bad

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

ErrorKind = Literal["bound", "estimate"]

# The dimensions of arrays that broadcast with each other, whatever their shapes.
BROADCAST = ("...",)
# Error of a motion, over its size, with which it is still given.
FAIR = 0.01
_NUMBERS = (bool, int, float, complex, np.ndarray, np.generic)


@dataclass(frozen=True)
class Check:
    """One self-check of a result."""

    value: float  # what was measured, for example ``|det(monodromy) - 1|``
    limit: float  # the largest value that passes

    @property
    def passed(self) -> bool:
        """True where the value is a number within the limit."""
        return bool(self.value <= self.limit)


@dataclass(frozen=True)
class Deferred:
    """A value to be: ``make()`` returns it; it must bear pickling where the result should."""

    make: Callable[[], Any]


class DeferredField:
    """Descriptor of a dataclass field that takes a value, or a :class:`Deferred` one.

    For error estimates that would take longer than the work whose error they measure.
    """

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, instance: object, value: object) -> None:
        """Keep what is given; called once, when the dataclass is made."""
        instance.__dict__[self._name] = value

    def __get__(self, instance: object | None, owner: type | None = None) -> Any:
        if instance is None:  # the dataclass asks for a default: there is none
            raise AttributeError(self._name)
        value = instance.__dict__[self._name]
        if isinstance(value, Deferred):
            value = instance.__dict__[self._name] = value.make()
        return value


@dataclass(frozen=True)
class DeferredGroup:
    """Fields that are computed together, when the first of them is looked at.

    ``make()`` returns the values by name; it must bear pickling where the result should.
    """

    make: Callable[[], Mapping[str, Any]]

    @cached_property
    def _made(self) -> Mapping[str, Any]:
        return self.make()

    def value(self, name: str) -> Any:
        """Return one value, having computed all of them."""
        return self._made[name]

    def later(self, name: str) -> Deferred:
        """Return one value to be."""
        return Deferred(partial(self.value, name))


class DeferredChecks(Mapping[str, Check]):
    """Self-checks that are made when they are first looked at, and then kept.

    For results so quick that a check would take longer than the work.  ``checks``, ``passed``,
    ``require``, ``to_dict`` and ``save`` to JSON look at them.  ``make()`` returns the checks by
    name; it and what it holds must bear pickling where the result should.
    """

    def __init__(self, make: Callable[[], Mapping[str, Check]]) -> None:
        self._make = make

    @cached_property
    def _checks(self) -> Mapping[str, Check]:
        # What the maker holds is needed no more.
        checks, self._make = self._make(), dict
        return checks

    @property
    def made(self) -> bool:
        """Whether they are made."""
        return "_checks" in vars(self)

    def __getitem__(self, name: str) -> Check:
        return self._checks[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._checks)

    def __len__(self) -> int:
        return len(self._checks)


@dataclass(frozen=True, kw_only=True)
class Result:
    """Base of every result.

    Attributes
    ----------
    method : str
        Name of the method that was used.
    error : float or ndarray
        Error of the main values, in the norm that ``error_norm`` names.
    error_norm : str
        In words: which quantity, absolute or relative, largest or entrywise.
    error_kind : {"estimate", "bound"}
        Whether it is proved or estimated.
    checks : mapping of str to Check
        Self-checks by name.
    provenance : mapping of str to str
        Scene, module hash, versions.

    Notes
    -----
    A class names the dimensions of its arrays in ``dimensions`` (extra axes count up: ``mu``,
    ``mu_1``; :data:`BROADCAST` for arrays that broadcast with each other), and in ``exported`` the
    properties that leave with the fields: to JSON, CSV, NPZ.
    """

    method: str
    error: Any
    error_norm: str
    error_kind: ErrorKind = "estimate"
    checks: Mapping[str, Check] = field(default_factory=dict)
    provenance: Mapping[str, str] = field(default_factory=dict)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    exported: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        """Make the arrays the result's own, and read-only: what comes after changes no answer."""
        for name, value in vars(self).items():
            if type(value) is np.ndarray and (value.flags.writeable or value.base is not None):
                own = value.copy()
                own.flags.writeable = False
                object.__setattr__(self, name, own)

    def __init_subclass__(cls, **given: Any) -> None:
        """Keep :meth:`__repr__` for every result, before a dataclass makes one of all digits."""
        super().__init_subclass__(**given)
        if "__repr__" not in vars(cls):
            cls.__repr__ = Result.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        """Return ten lines at most: method, arrays by shape and range, error and checks."""
        arrays = {
            item.name: np.asarray(value)
            for item in fields(self)
            if item.name != "error" and isinstance(value := getattr(self, item.name), _NUMBERS)
        }
        lines = [f"{type(self).__name__}: {self.method}"]
        shown, others = list(arrays)[:6], list(arrays)[6:]
        lines += [f"  {name}: {_brief(arrays[name])}" for name in shown]
        if others:
            lines.append(f"  and {', '.join(others)}")
        lines.append(f"  error: {_brief(np.asarray(self.error))} ({self.error_norm})")
        checks = self.checks
        if isinstance(checks, DeferredChecks) and not checks.made:
            lines.append("  checks: made when they are looked at")
        else:
            failed = [name for name, check in checks.items() if not check.passed]
            lines.append(f"  checks: {'failed: ' + ', '.join(failed) if failed else 'passed'}")
        return "\n".join(lines)

    @property
    def passed(self) -> bool:
        """True where no self-check failed; a result without any (``checks`` is empty) passes.

        Such a result rests on its error alone.
        """
        return all(check.passed for check in self.checks.values())

    def require(self) -> None:
        """Raise :class:`SelfCheckFailed` where a self-check failed."""
        failed = [
            f"{name}: {check.value:.3g} exceeds {check.limit:.3g}"
            for name, check in self.checks.items()
            if not check.passed
        ]
        if failed:
            raise SelfCheckFailed(f"{type(self).__name__}: " + "; ".join(failed))

    def arrays(self) -> dict[str, np.ndarray[Any, Any]]:
        """Return the numeric fields and exported properties by name.

        A tuple of numbers is among them where ``dimensions`` names its axis.
        """
        found: dict[str, np.ndarray[Any, Any]] = {}
        for name in (*(item.name for item in fields(self)), *self.exported):
            value = getattr(self, name)
            listed = isinstance(value, tuple) and name in self.dimensions
            if listed or isinstance(value, _NUMBERS):
                found[name] = np.asarray(value)
        return found

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON; NaN becomes None."""
        out: dict[str, Any] = {}
        for name in (*(item.name for item in fields(self)), *self.exported):
            value = _jsonable(getattr(self, name))
            if value is not None:
                out[name] = value
        out["checks"] = {
            name: {"value": _plain(np.asarray(c.value)), "limit": c.limit, "passed": c.passed}
            for name, c in self.checks.items()
        }
        out["provenance"] = dict(self.provenance)
        out["passed"] = self.passed
        return out

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the result into ``ax`` (a new one by default) and return the axes."""
        name, fix = type(self).__name__, "use its arrays instead"
        raise bad(name, "plot()", "a result with a picture", fix)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the result; the ending chooses npz, json, csv or nc (NetCDF).

        The file appears whole or not at all.  A CSV file has long form: one row for each point,
        arrays of fewer dimensions repeated, the columns of an axis that no array gives counted
        from 0.  Arrays that do not fit together stand in blocks, an empty line between them, each
        with a header of its own.  In NetCDF a complex array stands as two, ``name_real`` and
        ``name_imag``.

        Raises
        ------
        BadInput
            If the ending is unknown or the folder cannot be written.
        """
        target = Path(path)
        writers = {".npz": _npz, ".json": _json, ".csv": _csv, ".nc": _netcdf}
        if target.suffix not in writers:
            expected = f"an ending of {sorted(writers)}"
            raise bad("save", repr(target.suffix), expected, "rename the file")
        return write_whole(target, writers[target.suffix](self))

    def to_xarray(self) -> xarray.Dataset:
        """Return the numeric fields as an :class:`xarray.Dataset` (extra ``data``)."""
        return _dataset(self, split=False)


def _brief(array: np.ndarray[Any, Any]) -> str:
    """Return numbers where they are few, else their shape and range, of complex ones the sizes'."""
    if array.size <= 4:
        return np.array2string(array, precision=6, separator=", ").replace("\n", "")
    values, of = array, ""
    if np.iscomplexobj(array):
        values, of = np.abs(array), ", sizes"
    finite = values[np.isfinite(values)]
    if not finite.size:
        return f"shape {array.shape}, none finite"
    some = "" if finite.size == values.size else f", {values.size - finite.size} not finite"
    return f"shape {array.shape}{of} {np.min(finite):.6g} to {np.max(finite):.6g}{some}"


def write_whole(path: Path, content: bytes) -> Path:
    """Write a file whole or not at all; refuse a place that cannot be written."""
    try:
        return _write_whole(path, content)
    except OSError as refusal:
        found, fix = refusal.strerror or "an error", "choose another path"
        raise bad(str(path), found, "a writable place", fix) from refusal


def _jsonable(value: object) -> Any:
    """Return a field as JSON would have it; None for what has no such form."""
    if isinstance(value, str):
        return value
    if isinstance(value, _NUMBERS):
        return _plain(np.asarray(value))
    if isinstance(value, tuple) and all(isinstance(v, str | int | float) for v in value):
        return [v if isinstance(v, str) else _plain(np.asarray(v)) for v in value]
    if isinstance(value, Mapping):
        return {str(key): _jsonable(item) for key, item in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return {item.name: _jsonable(getattr(value, item.name)) for item in fields(value)}
    return None


def _plain(value: np.ndarray[Any, Any]) -> Any:
    if np.iscomplexobj(value):
        return {"real": _plain(value.real), "imag": _plain(value.imag)}
    if value.dtype.kind != "f":
        return value.tolist()
    nested = value.astype(object)
    nested[~np.isfinite(value)] = None
    return nested.tolist()


def _npz(result: Result) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **result.arrays())  # type: ignore[arg-type]
    return buffer.getvalue()


def _json(result: Result) -> bytes:
    return (json.dumps(result.to_dict(), indent=1, sort_keys=True) + "\n").encode()


def _csv(result: Result) -> bytes:
    arrays = result.arrays()
    axes = _axes(arrays, result.dimensions)
    wholes: list[dict[str, int]] = []
    for own in sorted(axes.values(), key=len, reverse=True):
        if not any(own.items() <= whole.items() for whole in wholes):
            wholes.append(own)
    return "\n".join(_block(arrays, axes, whole) for whole in wholes).encode()


def _axes(
    arrays: Mapping[str, np.ndarray[Any, Any]], dimensions: Mapping[str, tuple[str, ...]]
) -> dict[str, dict[str, int]]:
    """Return label and length of the axes of each array, less those of length 1.

    Arrays without declared dimensions belong together where their shapes are the same.
    """
    joined = [array.ndim for name, array in arrays.items() if dimensions.get(name) == BROADCAST]
    depth = max(joined, default=0)
    found = {}
    for name, array in arrays.items():
        n, names = array.ndim, dimensions.get(name, ())
        if names == BROADCAST:
            labels = tuple(f"axis_{depth - n + i}" for i in range(n))
        elif names:
            extra = tuple(f"{names[-1]}_{i}" for i in range(1, n - len(names) + 1))
            labels = (*names, *extra)[:n]
        else:
            shape = "x".join(map(str, array.shape))
            labels = tuple(f"axis_{i}_of_{shape}" for i in range(n))
        found[name] = {k: size for k, size in zip(labels, array.shape, strict=True) if size != 1}
    return found


def _block(
    arrays: Mapping[str, np.ndarray[Any, Any]],
    axes: Mapping[str, Mapping[str, int]],
    whole: Mapping[str, int],
) -> str:
    """Return header and rows of the arrays that broadcast to the axes of one of them."""
    shape = tuple(whole.values())
    arrays = {name: arrays[name] for name in arrays if axes[name].items() <= whole.items()}
    columns: dict[str, np.ndarray[Any, Any]] = {}
    for place, label in enumerate(whole):
        if not any(list(axes[name]) == [label] for name in arrays):
            columns[label] = np.indices(shape)[place].ravel()
    for name, array in arrays.items():
        own = [label for label in whole if label in axes[name]]
        # The order of an array's own axes may be another than that of the block.
        turned = array.squeeze().transpose([list(axes[name]).index(label) for label in own])
        spread = turned.reshape([whole[label] if label in own else 1 for label in whole])
        columns[name] = np.broadcast_to(spread, shape).ravel()
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [",".join(columns), *(",".join(map(repr, row)) for row in rows)]
    return "\n".join(lines) + "\n"


def _dataset(result: Result, *, split: bool) -> xarray.Dataset:
    """Return the arrays with their dimensions; complex ones as two where they are to be split."""
    try:
        import xarray as xr
    except ImportError as missing:
        fix = "pip install 'elastolink[data]'"
        raise bad("to_xarray", "no xarray", "xarray installed", fix) from missing
    data = {}
    for name, value in result.arrays().items():
        dims = result.dimensions.get(name)
        if dims is None or len(dims) != value.ndim or dims == BROADCAST:
            dims = tuple(f"{name}_{i}" for i in range(value.ndim))
        if split and np.iscomplexobj(value):
            data[f"{name}_real"], data[f"{name}_imag"] = (dims, value.real), (dims, value.imag)
        else:
            data[name] = (dims, value)
    attributes = {"method": result.method, "error_norm": result.error_norm}
    return xr.Dataset(data, attrs={**attributes, **result.provenance})


def _netcdf(result: Result) -> bytes:
    # The file format knows no complex numbers.
    data = _dataset(result, split=True)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "result.nc"
        data.to_netcdf(path)
        return path.read_bytes()


def provenance(extra: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the provenance of a result: the versions in use, and what is known of its input.

    That is ``extra``: scene, module hash, changed parameters, lengths.
    """
    from ... import __version__

    return {**(extra or {}), "elastolink": __version__, "numpy": np.__version__}
