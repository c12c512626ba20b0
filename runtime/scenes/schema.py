"""What can be said of a key, a table and a whole scene: the records that layouts are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Kind = Literal["quantity", "quantities", "count", "counts", "text", "texts"]
Range = Literal["any", "positive", "non-negative"]


@dataclass(frozen=True)
class Key:
    """One key of a table."""

    name: str
    meaning: str  # in one clause, for messages and for `elastolink show`
    kind: Kind = "quantity"  # a float; "count" is a whole number; the plurals are lists
    dimension: str = "dimensionless"  # of quantities, one of core.units.DIMENSIONS
    required: bool = False
    default: object = None  # where it is not given; None leaves it out
    limit: Range = "any"  # of a number, or of each number of a list
    choices: tuple[str, ...] = ()  # allowed texts; empty allows all
    length: int | None = None  # of a list, where it is fixed
    rising: bool = False  # whether a list must increase
    least: int | None = None  # smallest and largest count that make sense
    most: float | None = None
    axis: bool = False  # whether its dimension is that of the chart's axis


def positive(name: str, meaning: str, dimension: str = "dimensionless", **more: Any) -> Key:
    """Return the key of a quantity above 0; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, dimension=dimension, limit="positive", **more)


def not_negative(name: str, meaning: str, dimension: str = "dimensionless", **more: Any) -> Key:
    """Return the key of a quantity of 0 or more; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, dimension=dimension, limit="non-negative", **more)


def quantities(name: str, meaning: str, dimension: str = "dimensionless", **more: Any) -> Key:
    """Return the key of a list of quantities; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, "quantities", dimension, **more)


def choice(name: str, meaning: str, *choices: str, **more: Any) -> Key:
    """Return the key of one text of several; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, "text", choices=choices, **more)


@dataclass(frozen=True)
class Table:
    """One table of a scene."""

    name: str
    meaning: str
    keys: tuple[Key, ...]
    required: bool = False
    # Groups of keys that say the same thing in different ways.
    exactly_one: tuple[tuple[str, ...], ...] = ()
    at_most_one: tuple[tuple[str, ...], ...] = ()
    # Whether it holds any number of such tables, each under a name of its own: [springs.NAME].
    named: bool = False
    # Keys that tables of this name take elsewhere, and what takes their place here.
    elsewhere: tuple[str, ...] = ()
    instead: str = ""

    @property
    def heading(self) -> str:
        """How the table begins in a file."""
        return f"[{self.name}.NAME]" if self.named else f"[{self.name}]"

    def key(self, name: str) -> Key | None:
        """Return the key of that name, or None."""
        return next((key for key in self.keys if key.name == name), None)

    def rivals(self, name: str) -> tuple[str, ...]:
        """Return the other keys of the groups that ``name`` belongs to."""
        groups = (group for group in self.exactly_one + self.at_most_one if name in group)
        return tuple(other for group in groups for other in group if other != name)


def _names(name: str, meaning: str, choices: tuple[str, ...] = ()) -> Key:
    return Key(name, meaning, "texts", default=(), choices=choices)


@dataclass(frozen=True)
class Layout:
    """What a scene of one mechanism, in one group of formulations, holds."""

    mechanism: str
    formulations: tuple[str, ...]  # empty where any is allowed
    tables: tuple[Table, ...]  # all but [model]
    flexible: tuple[str, ...] = ()  # links that bend
    outputs: tuple[str, ...] = ()  # what may be wanted of the module; empty where anything may
    links: tuple[str, ...] = ()  # those that may be called balanced
    parameters: Mapping[str, str] = field(default_factory=dict)  # what a chart may vary, dimensions
    closed_in_modes: bool = False  # where one emitted module serves any number of modes
    system: str = ""  # what makes the system of a scene, below runtime; empty: nothing vibrates
    # Names for sets of terms left out, for model.drop.
    named_drops: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def model(self) -> Table:
        """The ``[model]`` table of this layout."""
        return Table(
            "model",
            "what is derived",
            (
                Key("mechanism", "kind of mechanism", "text", required=True),
                Key("formulation", "named assumptions", "text", required=True),
                _names("flexible", "links that bend", self.flexible),
                Key("modes", "number of modes", "count", limit="positive", most=1000),
                _names("drop", "physical terms left out"),
                _names(
                    "balanced", "links with their centre of mass at the first joint", self.links
                ),
                _names("outputs", "what the module is for; none means all", self.outputs),
            ),
            required=True,
        )

    def all_tables(self) -> tuple[Table, ...]:
        """Return every table, ``[model]`` first."""
        return (self.model, *self.tables)

    def table(self, name: str) -> Table | None:
        """Return the table of that name, or None."""
        return next((table for table in self.all_tables() if table.name == name), None)

    def key(self, where: str) -> Key | None:
        """Return the key that a dotted name stands for, ``loads.NAME.couple`` too, or None."""
        table, _, name = where.partition(".")
        known = self.table(table)
        if known and known.named:
            name = name.rpartition(".")[2]
        return known.key(name) if known else None
