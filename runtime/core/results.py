"""What every solver returns: values, method, error, self-checks, provenance."""

from __future__ import annotations

import io
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property, partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from .errors import BadInput, ElastolinkError, SelfCheckFailed, bad
from .files import Find, Keep, class_name, inline, inlined, pack, told, unpack, write_whole
from .tables import BROADCAST as BROADCAST
from .tables import LABELS, UNITS, by_name, labels_of, tables, with_unit

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

ErrorKind = Literal["bound", "estimate"]

# What a file of a result calls its record, and the number of the record's form.
_RECORD, _FORMAT = "elastolink", 1
# Every class of results that is defined, by its name in files.
_CLASSES: dict[str, type[Result]] = {}
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

    @property
    def share(self) -> float:
        """The value over the limit; infinite where it is no number, or passes a limit of 0."""
        if np.isnan(self.value):
            return float("inf")
        if self.limit > 0.0:
            return float(self.value / self.limit)
        return 0.0 if self.passed else float("inf")


def worst_checks(found: Iterable[Mapping[str, Check]]) -> dict[str, Check]:
    """Return of each self-check the one that came closest to its limit, or went beyond it most."""
    worst: dict[str, Check] = {}
    for checks in found:
        for name, check in checks.items():
            if name not in worst or check.share > worst[name].share:
                worst[name] = check
    return dict(sorted(worst.items()))


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

    def fields(self, names: Iterable[str]) -> dict[str, Any]:
        """Return values to be by name."""
        return {name: self.later(name) for name in names}


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
    ``mu_1``; :data:`BROADCAST` for arrays that broadcast with each other), or the arrays by their
    dimensions in ``arrays_along``, beside those of its base; and in ``exported`` the properties
    that leave with the fields: to JSON, CSV, NPZ.  ``column_units`` holds names of its arrays by
    their unit, where they are not among :data:`.tables.UNITS`.
    """

    method: str
    error: Any
    error_norm: str
    error_kind: ErrorKind = "estimate"
    checks: Mapping[str, Check] = field(default_factory=dict)
    provenance: Mapping[str, str] = field(default_factory=dict)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    arrays_along: ClassVar[Mapping[str, str]] = {}
    exported: ClassVar[tuple[str, ...]] = ()
    column_units: ClassVar[Mapping[str, str]] = {}

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
        _CLASSES[class_name(cls)] = cls
        if "arrays_along" in vars(cls):
            own = by_name(cls.arrays_along)
            cls.dimensions = {**cls.dimensions, **{name: tuple(own[name].split()) for name in own}}
        if "__repr__" not in vars(cls):
            cls.__repr__ = Result.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        """Return ten lines at most: method, arrays by shape and range, error and checks."""
        lines = [
            f"  {': '.join(row) if row[0] != 'and' else ' '.join(row)}" for row in self._rows()
        ]
        return "\n".join([f"{type(self).__name__}: {self.method}", *lines])

    def _rows(self) -> list[tuple[str, str]]:
        """Return what is shown of the result, by name."""
        arrays = {
            item.name: np.asarray(value)
            for item in fields(self)
            if item.name != "error" and isinstance(value := getattr(self, item.name), _NUMBERS)
        }
        shown, others = list(arrays)[:6], list(arrays)[6:]
        rows = [(name, _brief(arrays[name])) for name in shown]
        if others:
            rows.append(("and", ", ".join(others)))
        rows.append(("error", f"{_brief(np.asarray(self.error))} ({self.error_norm})"))
        checks = self.checks
        if isinstance(checks, DeferredChecks) and not checks.made:
            return [*rows, ("checks", "made when they are looked at")]
        failed = [name for name, check in checks.items() if not check.passed]
        return [*rows, ("checks", f"failed: {', '.join(failed)}" if failed else "passed")]

    def _repr_html_(self) -> str:
        """Return a table of the same, and the picture if there is one, for a notebook."""
        units = self.units_of_columns()
        cells = [(with_unit(name, units.get(name, "")), text) for name, text in self._rows()]
        body = "".join(f"<tr><th>{escape(k)}</th><td>{escape(v)}</td></tr>" for k, v in cells)
        title = escape(f"{type(self).__name__}: {self.method}")
        return f"<table><caption>{title}</caption>{body}</table>{self._picture()}"

    def _picture(self) -> str:
        """Return the picture as an element of HTML; empty where there is none."""
        if type(self).plot is Result.plot:
            return ""
        from .plotting import inline_picture

        try:
            return inline_picture(self.plot)
        except ElastolinkError:
            return ""

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
        saved = [item.name for item in fields(self) if item.metadata.get("saved", True)]
        for name in (*saved, *self.exported):
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

        All but CSV files come back by :func:`elastolink.load`.  Each file appears whole or not at
        all.  A CSV file is one table in long form, as ``pandas.read_csv`` reads it: one row for
        each point, units in the header, arrays of fewer dimensions repeated, the columns of an
        axis that no array gives counted from 0.  Arrays that have other axes stand in files beside
        it, ``edges.region_mode.csv`` beside ``edges.csv``.  In CSV and NetCDF a complex array
        stands as two, ``name_real`` and ``name_imag``.

        Raises ``BadInput`` if the ending is unknown or the folder cannot be written.
        """
        target = Path(path)
        if target.suffix == ".csv":
            for name, table in self._tables().items():
                ending = f".{name}.csv" if name else ".csv"
                write_whole(target.with_suffix(ending), table.encode())
            return target
        writers = {".npz": _npz, ".json": _json, ".nc": _netcdf}
        if target.suffix not in writers:
            expected = f"an ending of {sorted([*writers, '.csv'])}"
            raise bad("save", repr(target.suffix), expected, "rename the file")
        return write_whole(target, writers[target.suffix](self))

    def _dimensions(self) -> Mapping[str, tuple[str, ...]]:
        """Return the dimensions of the arrays; of a class whose arrays differ, of these."""
        return self.dimensions

    def _own_units(self) -> dict[str, str]:
        """Return the units that only the instance knows."""
        return {}

    def units_of_columns(self) -> dict[str, str]:
        """Return the units of the arrays by name; what has none is not there."""
        units = by_name(UNITS) | by_name(self.column_units) | self._own_units()
        return {name: units[name] for name in self.arrays() if units.get(name)}

    def _tables(self) -> dict[str, str]:
        """Return tables of comma-separated values; of a result without axes one row of all."""
        arrays = self.arrays()
        if not any(array.ndim for array in arrays.values()):
            for item in fields(self)[len(fields(Result)) :]:
                value = getattr(self, item.name)
                rows = value.items() if isinstance(value, Mapping) else [("", value)]
                for key, one in rows:
                    if isinstance(one, str) or (key and isinstance(one, _NUMBERS)):
                        arrays[f"{item.name} {key}".strip()] = np.asarray(one)
        dimensions = dict(self._dimensions())
        used = {label for labels in dimensions.values() for label in labels}
        for name, axes in LABELS.items():
            value, along = getattr(self, name, None), [axis for axis in axes if axis in used]
            if isinstance(value, tuple) and along and name not in arrays:
                arrays[name], dimensions[name] = np.asarray(value), (along[0],)
        return tables(arrays, dimensions, self.units_of_columns())

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
    arrays = result.arrays()
    names = {id(array): name for name, array in arrays.items()}

    def keep(path: str, array: np.ndarray[Any, Any]) -> dict[str, Any]:
        arrays[name := names.get(id(array), path)] = array
        return {**told(array), "in": name}

    record = _record(result, keep).encode()
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **{**arrays, _RECORD: np.array(record)})  # type: ignore[arg-type]
    return buffer.getvalue()


def _json(result: Result) -> bytes:
    plain = result.to_dict()
    names = {id(array): name for name, array in result.arrays().items()}

    def keep(path: str, array: np.ndarray[Any, Any]) -> dict[str, Any]:
        name = names.get(id(array), "")
        exact = array.dtype.kind in "biufU" and plain.get(name) == array.tolist()
        return {**told(array), "in": name} if exact else inline(path, array)

    plain[_RECORD] = _record(result, keep)
    return (json.dumps(plain, indent=1, sort_keys=True) + "\n").encode()


def _netcdf(result: Result) -> bytes:
    # The file format knows no complex numbers.
    data = _dataset(result, split=True)
    names = {id(array): name for name, array in result.arrays().items()}

    def keep(path: str, array: np.ndarray[Any, Any]) -> dict[str, Any]:
        name = names.get(id(array), "")
        exact = array.dtype.str in ("<f8", "<c16") and name
        return {**told(array), "in": name} if exact else inline(path, array)

    data[_RECORD] = ((), np.array(_record(result, keep).encode()))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "result.nc"
        data.to_netcdf(path)
        return path.read_bytes()


def _record(result: Result, keep: Keep) -> str:
    head = {"format": _FORMAT, "elastolink": _version()}
    return json.dumps({**head, "result": pack(result, keep)}, allow_nan=False)


def _read_npz(path: Path) -> tuple[Any, Find]:
    with path.open("rb") as stream, np.load(stream) as held:
        arrays = dict(held)
    return json.loads(arrays[_RECORD][()]), lambda tree: arrays[tree["in"]]


def _read_json(path: Path) -> tuple[Any, Find]:
    plain = json.loads(path.read_bytes())
    return json.loads(plain[_RECORD]), lambda tree: inlined(
        {**tree, "of": np.ravel(plain[tree["in"]])}
    )


def _read_netcdf(path: Path) -> tuple[Any, Find]:
    xr = _xarray("load")
    data = xr.load_dataset(path, decode_times=False, mask_and_scale=False)

    def find(tree: Mapping[str, Any]) -> np.ndarray[Any, Any]:
        array = np.empty(tree["shape"], tree["type"])
        if array.dtype.kind == "c":
            array.real, array.imag = (data[f"{tree['in']}_{part}"] for part in ("real", "imag"))
        else:
            array[...] = data[tree["in"]]
        return array

    return json.loads(data[_RECORD].values[()]), find


def _xarray(who: str) -> Any:
    try:
        import xarray
    except ImportError as missing:
        fix = "pip install 'elastolink[data]'"
        raise bad(who, "no xarray", "xarray installed", fix) from missing
    return xarray


def _dataset(result: Result, *, split: bool) -> xarray.Dataset:
    """Return the arrays with their dimensions; complex ones as two where they are to be split."""
    xr = _xarray("to_xarray")
    data: dict[str, Any] = {}
    sizes: dict[str, int] = {}
    arrays, units = result.arrays(), result.units_of_columns()
    known = labels_of(arrays, result._dimensions())
    for name, value in arrays.items():
        dims = known.get(name)
        if dims is None or any(
            sizes.get(k, n) != n for k, n in zip(dims, value.shape, strict=True)
        ):
            dims = tuple(f"{name}_{i}" for i in range(value.ndim))
        sizes |= dict(zip(dims, value.shape, strict=True))
        about = {"units": units[name]} if name in units else {}
        if split and np.iscomplexobj(value):
            data[f"{name}_real"] = (dims, value.real, about)
            data[f"{name}_imag"] = (dims, value.imag, about)
        else:
            data[name] = (dims, value, about)
    attributes = {"method": result.method, "error_norm": result.error_norm}
    return xr.Dataset(data, attrs={**attributes, **result.provenance})


def load(path: str | os.PathLike[str]) -> Result:
    """Return the result that :meth:`Result.save` wrote to an npz, JSON or NetCDF file.

    It is equal to the saved one in every number, text and check.  What a result keeps of its
    equations are functions, which no file holds: ``SteadyState.shapes``, ``ResponseCurve.source``
    and their like refuse to be used.  Nothing in the file is run: arrays are read without pickle,
    and classes are elastolink's own, or results that are defined already.

    Parameters
    ----------
    path : path
        The file, its ending that of its kind.

    Returns
    -------
    Result
        Of the class of the saved one.

    Raises
    ------
    BadInput
        If there is no such file, it is damaged or no file of a result, another version of
        elastolink wrote it with other fields, or it is a CSV file, which holds numbers alone.

    Examples
    --------
    >>> import elastolink as el
    >>> found = el.discriminant(el.PeriodicFunction(a=[0.0, 1.0]), lam2=[0.25, 1.0], mu=0.1)
    >>> print((el.load(found.save("half_trace.json")).value == found.value).all())
    True
    """
    if not isinstance(path, (str, os.PathLike)):
        raise bad("path", type(path).__name__, "a path", "name a file that save() wrote")
    source = Path(path)
    readers = {".npz": _read_npz, ".json": _read_json, ".nc": _read_netcdf}
    if source.suffix not in readers:
        expected = f"an ending of {sorted(readers)}; CSV files hold the numbers alone"
        raise bad("load", repr(source.suffix), expected, "save the result as npz")
    if not source.is_file():
        raise bad(str(source), "no such file", "a file that save() wrote", "correct the path")
    written = ""
    try:
        record, find = readers[source.suffix](source)
        written = f", of elastolink {record['elastolink']}"
        if record["format"] != _FORMAT:
            raise ValueError(f"format {record['format']}")
        result = unpack(record["result"], find, _CLASSES)
        if not isinstance(result, Result):
            raise TypeError(type(result).__name__)
    except BadInput:
        raise
    except Exception as damage:  # a damaged file fails in as many ways as it has bytes
        found = f"what cannot be read{written} ({type(damage).__name__}: {damage})"
        expected = f"a file that save() of elastolink {_version()} wrote"
        raise bad(str(source), found, expected, "save the result anew") from damage
    return result


def _version() -> str:
    from ... import __version__

    return __version__


def provenance(extra: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the provenance of a result: the versions in use, and what is known of its input.

    That is ``extra``: scene, module hash, changed parameters, lengths.
    """
    return {**(extra or {}), "elastolink": _version(), "numpy": np.__version__}
