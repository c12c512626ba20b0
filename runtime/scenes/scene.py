"""A scene: the numbers of one machine, checked, in SI units, and read-only."""

from __future__ import annotations

import hashlib
import importlib
import inspect
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from ...derive.spec import INEXTENSIBLE, ModelSpec
from ..core.errors import bad, one_line
from ..core.units import describe
from .schema import Layout, Table
from .validation import nearest
from .writing import toml_text

if TYPE_CHECKING:
    from ..core.families import LinearPeriodic
    from ..linkages import Linkage
    from ..rigid import Machine

LINKAGES = {"four_bar": "FourBar", "slider_crank": "SliderCrank", "quick_return": "QuickReturn"}
_MISSING = object()


class ReadOnlyTable(Mapping[str, Any]):
    """A table of a scene that cannot be changed, its name known to messages.

    By key: floats in SI units, tuples of them, whole numbers and texts, and tables of the same.
    """

    __slots__ = ("_name", "_values")

    def __init__(self, name: str, values: Mapping[str, Any]) -> None:
        self._name = name
        self._values = {
            key: ReadOnlyTable(f"{name}.{key}", value) if type(value) is dict else value
            for key, value in values.items()
        }

    def __getitem__(self, key: str) -> Any:
        """Return one value; a wrong key is refused with the ones that there are."""
        if key not in self._values:
            raise MissingKeyError(f"{self._name}.{key}", sorted(self._values))
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"ReadOnlyTable({self._name!r}, {self._values!r})"


class MissingKeyError(KeyError):
    """A scene holds no such key."""

    def __init__(self, where: str, known: list[str]) -> None:
        super().__init__(where)
        self.where, self.known = where, known

    def __str__(self) -> str:
        """Say what was asked for and what there is."""
        fix = nearest(self.where.rpartition(".")[2], self.known, "use one of these")
        return f"{self.where}: found nothing; expected one of {self.known}; {fix}"


def _plain(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table, and those inside it, as dicts and lists."""
    plain: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            plain[key] = _plain(value)
        else:
            plain[key] = list(value) if isinstance(value, tuple) else value
    return plain


@dataclass(frozen=True)
class Scene:
    """The numbers of one machine, validated and in SI units.

    Made by :func:`load_scene`.  ``scene["links"]["crank"]`` and ``scene.get("links.crank")`` are
    the same float in metres.

    Attributes
    ----------
    name : str
        Built-in name, or the file's name without its ending.
    title : str
        One line.
    source : str
        Where the numbers come from.
    tables : mapping of str to ReadOnlyTable
        By name; what follows from the given quantities is filled in.
    layout : Layout
        What the scene's mechanism and formulation call for.
    document : mapping
        The tables as they were given, overrides among them, in the units of the file.
    given : mapping
        The same in SI units, defaults filled in and what follows from the numbers not.
    tolerances, deviations : ReadOnlyTable
        Half-widths of the bounds within which a number lies, and standard deviations, by dotted
        key, in SI units.
    """

    name: str
    title: str
    source: str
    tables: ReadOnlyTable
    layout: Layout
    document: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    given: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    tolerances: ReadOnlyTable = field(default_factory=partial(ReadOnlyTable, "tolerances", {}))
    deviations: ReadOnlyTable = field(default_factory=partial(ReadOnlyTable, "deviations", {}))

    def __getitem__(self, table: str) -> ReadOnlyTable:
        """Return one table."""
        found: ReadOnlyTable = self.tables[table]
        return found

    def __contains__(self, table: object) -> bool:
        """Return True where the scene has that table."""
        return table in self.tables

    def __hash__(self) -> int:
        return hash(self.digest())

    def __repr__(self) -> str:
        """Return name, title, formulation and the first numbers, on ten lines at the most."""
        model = self.model
        bends = f", bending: {', '.join(model['flexible'])}" if model.get("flexible") else ""
        lines = [
            f"Scene {self.name!r}: {one_line(self.title, 80)}",
            f"  {model['mechanism']}, formulation {model['formulation']!r}{bends}",
        ]
        for name, _, table in self.described():
            numbers = [
                f"{key} {describe(value, self.dimension(f'{name}.{key}') or 'dimensionless')}"
                for key, value in table.items()
                if isinstance(value, float)
            ]
            if numbers:
                more = ", ..." if len(numbers) > 4 else ""
                lines.append(f"  {name}: {', '.join(numbers[:4])}{more}")
        rest = ["  ..."] if len(lines) > 9 else []
        return "\n".join([*lines[:9], *rest])

    @property
    def model(self) -> ReadOnlyTable:
        """The ``[model]`` table, defaults filled in."""
        return self["model"]

    def get(self, key: str, default: Any = _MISSING) -> Any:
        """Return the value of a dotted key, in SI units.

        Parameters
        ----------
        key : str
            Table and key, for example ``"links.crank"`` or ``"loads.tool.couple"``.
        default : object, optional
            Returned where the scene holds no such key.

        Raises
        ------
        KeyError
            If the scene holds no such key and no default is given.
        """
        try:
            found: Any = self.tables
            for name in key.split("."):
                found = found[name]
            return found
        except MissingKeyError:
            if default is _MISSING:
                raise
            return default

    def described(self) -> Iterator[tuple[str, Table | None, Mapping[str, Any]]]:
        """Yield every table with its description; those under a name of their own one by one."""
        for name, table in self.tables.items():
            layout = self.layout.table(name)
            if layout is None or not layout.named:
                yield name, layout, table
                continue
            for inner, content in table.items():
                yield f"{name}.{inner}", layout, content

    def dimension(self, key: str) -> str | None:
        """Return the dimension of a dotted key, or None where it is no quantity."""
        table, _, name = key.partition(".")
        if table == "chart" and name.endswith("_range"):
            return self.layout.parameters.get(self.get(f"chart.{name[0]}"))
        found = self.layout.key(key)
        if found is None:
            # Masses that no file gives follow from other numbers.
            return "mass" if key.endswith(".mass") else None
        return found.dimension if found.kind in {"quantity", "quantities"} else None

    def to_dict(self) -> dict[str, Any]:
        """Return plain dicts, lists, numbers and strings, ready for JSON."""
        tables = {name: _plain(table) for name, table in self.tables.items()}
        for name in ("tolerances", "deviations"):
            if getattr(self, name):
                tables[name] = _plain(getattr(self, name))
        return {"name": self.name, "title": self.title, "source": self.source, **tables}

    def to_toml(self) -> str:
        """Return the scene as the text of a TOML file, in the units in which it was given.

        Loaded again under the same name it is an equal scene.
        """
        return toml_text(self.document)

    def digest(self) -> str:
        """Return 16 hexadecimal digits that stand for every number of the scene."""
        text = json.dumps(self.to_dict(), sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def model_spec(self) -> ModelSpec:
        """Return what is to be derived for this scene.

        The number of modes is left open where one emitted module serves any number.
        """
        table = {key: list(v) if isinstance(v, tuple) else v for key, v in self.model.items()}
        spec = ModelSpec.from_mapping(table).derived()
        return spec.with_(modes=None) if self.layout.closed_in_modes else spec

    def system(self) -> Any:
        """Return the family object that the solvers accept.

        Returns
        -------
        LinearPeriodic, Constrained or Nonlinear
            Which of them, the scene tells when the program runs, and no type checker can know.

        Raises
        ------
        BadInput
            If the scene is about rigid links alone, or its module was not emitted yet.
        """
        if not self.layout.system:
            found = f"formulation '{self.model['formulation']}', in which nothing vibrates"
            fix = "use kinematics or forces, or choose a scene with a flexible link"
            raise bad(f"scene {self.name}", found, "a scene with a flexible link", fix)
        module, _, function = self.layout.system.rpartition(".")
        # Imported when it is asked for.
        return getattr(importlib.import_module(f"..{module}", __package__), function)(self)

    def linear_system(self) -> LinearPeriodic:
        """Return the system of the scene for solvers that take the linear-periodic family alone.

        Raises
        ------
        BadInput
            As :meth:`system`, and if the scene's formulation is constrained or nonlinear.
        """
        from ..core.families import LinearPeriodic

        found = self.system()
        if not isinstance(found, LinearPeriodic):
            name = self.model["formulation"]
            given = f"formulation '{name}', whose equations are constrained"
            fix = f"--set model.formulation='{name}_linear', or see constrained_motion"
            fix += " and periodic_orbit"
            if self.layout.formulations == INEXTENSIBLE:
                given = f"formulation '{name}', whose equations are nonlinear"
                fix = "--set model.formulation=complete, or see response_curve"
            raise bad(f"scene {self.name}", given, "a linear formulation", fix)
        return found

    def mechanism(self) -> Linkage:
        """Return the linkage of the scene: lengths and assembly.

        Raises ``BadInput`` if the scene has no linkage.
        """
        kind = LINKAGES.get(self.model["mechanism"])
        # A scene of a model of the user's own declares its tables, in any formulation.
        if kind is None or not self.layout.formulations:
            found = f"mechanism '{self.model['mechanism']}'"
            fix = "choose a scene with a [links] table"
            raise bad(f"scene {self.name}", found, f"a linkage: one of {sorted(LINKAGES)}", fix)
        from .. import linkages as mechanisms

        made = getattr(mechanisms, kind)
        lengths = inspect.signature(made).parameters
        linkage: Linkage = made(**{k: v for k, v in self["links"].items() if k in lengths})
        return linkage

    def machine(self) -> Machine:
        """Return the linkage with its masses, loads, springs and weight.

        Raises ``BadInput`` if the scene has no linkage, a link bends, or no link has a mass.
        """
        from .rigid import machine

        return machine(self)
