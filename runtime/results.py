"""What every solver returns: values, method, error figure, self-checks, provenance."""

from __future__ import annotations

import io
import json
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from .._files import write_whole as _write_whole
from .errors import SelfCheckFailed, bad

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

ErrorKind = Literal["bound", "estimate"]


@dataclass(frozen=True)
class Check:
    """One self-check of a result.

    Attributes
    ----------
    value : float
        What was measured, for example ``|det(monodromy) - 1|``.
    limit : float
        The largest value that passes.
    """

    value: float
    limit: float

    @property
    def passed(self) -> bool:
        """True where the value is a number within the limit."""
        return bool(self.value <= self.limit)


@dataclass(frozen=True, kw_only=True)
class Result:
    """Base of every result.

    Attributes
    ----------
    method : str
        Name of the method that was used.
    error : float or ndarray
        Error figure of the main values, in the norm that ``error_norm`` names.
    error_norm : str
        In words: which quantity, absolute or relative, largest or entrywise.
    error_kind : {"estimate", "bound"}
        Whether the figure is proved or estimated.
    checks : mapping of str to Check
        Self-checks by name.
    provenance : mapping of str to str
        Scene, module hash, versions.
    """

    method: str
    error: Any
    error_norm: str
    error_kind: ErrorKind = "estimate"
    checks: Mapping[str, Check] = field(default_factory=dict)
    provenance: Mapping[str, str] = field(default_factory=dict)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    @property
    def passed(self) -> bool:
        """True where every self-check passed."""
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
        """Return the numeric fields by name."""
        found: dict[str, np.ndarray[Any, Any]] = {}
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, (bool, int, float, complex, np.ndarray, np.generic)):
                found[item.name] = np.asarray(value)
        return found

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON; NaN becomes None."""
        out: dict[str, Any] = {}
        for item in fields(self):
            value = _jsonable(getattr(self, item.name))
            if value is not None:
                out[item.name] = value
        out["checks"] = {
            name: {"value": _plain(np.asarray(c.value)), "limit": c.limit, "passed": c.passed}
            for name, c in self.checks.items()
        }
        out["provenance"] = dict(self.provenance)
        out["passed"] = self.passed
        return out

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the result into ``ax`` (a new one by default) and return the axes."""
        raise bad(
            type(self).__name__, "plot()", "a result with a picture", "use its arrays instead"
        )

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the result; the ending chooses npz, json, csv or nc (NetCDF).

        The file appears whole or not at all.

        Raises
        ------
        BadInput
            If the ending is unknown or the folder cannot be written.
        """
        target = Path(path)
        writers = {".npz": _npz, ".json": _json, ".csv": _csv, ".nc": _netcdf}
        if target.suffix not in writers:
            raise bad(
                "save", repr(target.suffix), f"an ending of {sorted(writers)}", "rename the file"
            )
        return write_whole(target, writers[target.suffix](self))

    def to_xarray(self) -> xarray.Dataset:
        """Return the numeric fields as an :class:`xarray.Dataset` (extra ``data``)."""
        try:
            import xarray as xr
        except ImportError as missing:
            raise bad(
                "to_xarray", "no xarray", "xarray installed", "pip install 'elastolink[data]'"
            ) from missing
        data = {}
        for name, value in self.arrays().items():
            dims = self.dimensions.get(name)
            if dims is None or len(dims) != value.ndim:
                dims = tuple(f"{name}_{i}" for i in range(value.ndim))
            data[name] = (dims, value)
        attributes = {"method": self.method, "error_norm": self.error_norm}
        return xr.Dataset(data, attrs={**attributes, **self.provenance})


def write_whole(path: Path, content: bytes) -> Path:
    """Write a file so that it appears whole or not at all.

    Raises
    ------
    BadInput
        If the folder does not exist or cannot be written.
    """
    try:
        return _write_whole(path, content)
    except OSError as refusal:
        raise bad(
            str(path), refusal.strerror or "an error", "a writable place", "choose another path"
        ) from refusal


def _jsonable(value: object) -> Any:
    """Return a field as JSON would have it; None for what has no such form."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool | int | float | complex | np.ndarray | np.generic):
        return _plain(np.asarray(value))
    if isinstance(value, tuple) and all(isinstance(v, str | int | float) for v in value):
        return list(value)
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
    columns = {name: np.ravel(value) for name, value in result.arrays().items()}
    longest = max((len(column) for column in columns.values()), default=0)
    rows = [",".join(columns)]
    rows += [
        ",".join(repr(c[i].item()) if i < len(c) else "" for c in columns.values())
        for i in range(longest)
    ]
    return ("\n".join(rows) + "\n").encode()


def _netcdf(result: Result) -> bytes:
    data = result.to_xarray()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "result.nc"
        data.to_netcdf(path)
        return path.read_bytes()
