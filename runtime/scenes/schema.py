"""What can be said of a key, a table and a whole scene: the records that layouts are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Kind = Literal["quantity", "quantities", "count", "counts", "text", "texts"]
Range = Literal["any", "positive", "non-negative"]


@dataclass(frozen=True)
class Key:
    """One key of a table.

    Attributes
    ----------
    name : str
        As it stands in the file.
    meaning : str
        In one clause, for messages and for ``elastolink show``.
    kind : str
        ``"quantity"`` (a float), ``"quantities"`` (a list of them), ``"count"`` (a whole number),
        ``"counts"``, ``"text"`` or ``"texts"``.
    dimension : str
        One of :data:`elastolink.runtime.core.units.DIMENSIONS`; matters for quantities alone.
    required : bool
        Whether it must be given.
    default : object
        Value where it is not given; None leaves it out.
    limit : {"any", "positive", "non-negative"}
        Allowed range of a number, or of each number of a list.
    choices : tuple of str
        Allowed texts; empty allows all.
    length : int or None
        Length of a list, where it is fixed.
    rising : bool
        Whether a list must increase.
    least, most : int or None
        Smallest and largest count that make sense.
    """

    name: str
    meaning: str
    kind: Kind = "quantity"
    dimension: str = "dimensionless"
    required: bool = False
    default: object = None
    limit: Range = "any"
    choices: tuple[str, ...] = ()
    length: int | None = None
    rising: bool = False
    least: int | None = None
    most: float | None = None


def positive(name: str, meaning: str, dimension: str = "dimensionless", **more: Any) -> Key:
    """Return the key of a quantity above 0; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, dimension=dimension, limit="positive", **more)


def not_negative(name: str, meaning: str, dimension: str = "dimensionless", **more: Any) -> Key:
    """Return the key of a quantity of 0 or more; ``more`` are further fields of :class:`Key`."""
    return Key(name, meaning, dimension=dimension, limit="non-negative", **more)


@dataclass(frozen=True)
class Table:
    """One table of a scene.

    Attributes
    ----------
    name : str
        As it stands in the file.
    meaning : str
        In one clause.
    keys : tuple of Key
        What it may hold.
    required : bool
        Whether it must be given.
    exactly_one, at_most_one : tuple of tuple of str
        Groups of keys that say the same thing in different ways.
    named : bool
        Whether it holds any number of tables of this kind, each under a name of its own:
        ``[springs.NAME]``.
    """

    name: str
    meaning: str
    keys: tuple[Key, ...]
    required: bool = False
    exactly_one: tuple[tuple[str, ...], ...] = ()
    at_most_one: tuple[tuple[str, ...], ...] = ()
    named: bool = False

    def key(self, name: str) -> Key | None:
        """Return the key of that name, or None."""
        return next((key for key in self.keys if key.name == name), None)

    def rivals(self, name: str) -> tuple[str, ...]:
        """Return the other keys of the groups that ``name`` belongs to."""
        groups = (group for group in self.exactly_one + self.at_most_one if name in group)
        return tuple(other for group in groups for other in group if other != name)


@dataclass(frozen=True)
class Layout:
    """What a scene of one mechanism, in one group of formulations, holds.

    Attributes
    ----------
    mechanism : str
        As in ``[model]``.
    formulations : tuple of str
        As in ``[model]``; empty where any is allowed.
    tables : tuple of Table
        All but ``[model]``.
    flexible : tuple of str
        Links that bend.
    outputs : tuple of str
        What may be wanted of the module; empty where anything may.
    links : tuple of str
        Links that may be called balanced.
    parameters : mapping of str to str
        Names that a chart may vary, with their dimensions.
    closed_in_modes : bool
        True where one emitted module serves any number of modes.
    named_drops : mapping of str to tuple of str
        Names for sets of terms left out, for ``model.drop``.
    """

    mechanism: str
    formulations: tuple[str, ...]
    tables: tuple[Table, ...]
    flexible: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    links: tuple[str, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    closed_in_modes: bool = False
    named_drops: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def model(self) -> Table:
        """The ``[model]`` table of this layout."""
        return Table(
            "model",
            "what is derived; read by both sides",
            (
                Key("mechanism", "kind of mechanism", "text", required=True),
                Key("formulation", "named assumptions", "text", required=True),
                Key("flexible", "links that bend", "texts", default=(), choices=self.flexible),
                Key("modes", "number of modes", "count", limit="positive", most=1000),
                Key("drop", "physical terms left out", "texts", default=()),
                Key(
                    "balanced",
                    "links with the centre of mass at their first joint",
                    "texts",
                    default=(),
                    choices=self.links,
                ),
                Key(
                    "outputs",
                    "what the module is for; none means all",
                    "texts",
                    default=(),
                    choices=self.outputs,
                ),
            ),
            required=True,
        )

    def all_tables(self) -> tuple[Table, ...]:
        """Return every table, ``[model]`` first."""
        return (self.model, *self.tables)

    def table(self, name: str) -> Table | None:
        """Return the table of that name, or None."""
        return next((table for table in self.all_tables() if table.name == name), None)
