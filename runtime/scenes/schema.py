"""What a scene may say: every table and key with its dimension, range and meaning, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

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
        One of :data:`elastolink.runtime.units.DIMENSIONS`; matters for quantities alone.
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
    most: int | None = None


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
    """

    name: str
    meaning: str
    keys: tuple[Key, ...]
    required: bool = False
    exactly_one: tuple[tuple[str, ...], ...] = ()
    at_most_one: tuple[tuple[str, ...], ...] = ()

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
    """

    mechanism: str
    formulations: tuple[str, ...]
    tables: tuple[Table, ...]
    flexible: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    links: tuple[str, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    closed_in_modes: bool = False

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


LINKS = ("frame", "crank", "coupler", "follower")


def _length(link: str, meaning: str) -> Key:
    return Key(link, meaning, dimension="length", required=True, limit="positive")


_GEOMETRY = Table(
    "links",
    "lengths between the pins, and which of the two closures",
    (
        _length("frame", "distance between the fixed pivots"),
        _length("crank", "length of the driven link"),
        _length("coupler", "length of the link between crank and follower"),
        _length("follower", "length of the link to the second fixed pivot"),
        Key("assembly", "closure", "text", default="open", choices=("open", "crossed")),
    ),
    required=True,
)
_MASS_KEYS = (
    Key("mass", "mass of the link", dimension="mass", limit="positive"),
    Key(
        "weight", "weight of the link, at gravity.acceleration", dimension="force", limit="positive"
    ),
)
_INERTIA = Key("inertia", "about the link's first joint", dimension="inertia", limit="positive")
_FIRST_MOMENT = Key(
    "first_moment",
    "mass times distance of its centre from the first joint",
    dimension="first_moment",
)
_GRAVITY = Table(
    "gravity",
    "what turns a weight into a mass",
    (
        Key(
            "acceleration",
            "acceleration of free fall",
            dimension="acceleration",
            default=9.80665,
            limit="positive",
        ),
    ),
)
_SPEED = Key("speed", "crank speed", dimension="frequency", limit="positive")
_OPERATION = Table(
    "operation",
    "how the machine runs",
    (
        _SPEED,
        Key(
            "speed_range",
            "lowest and highest crank speed",
            "quantities",
            "frequency",
            limit="positive",
            length=2,
            rising=True,
        ),
    ),
)
_MEASURED = Table(
    "measured",
    "what was observed on the rig",
    (
        Key("follower_inertias", "values tried", "quantities", "inertia", limit="positive"),
        Key(
            "follower_inertia_tolerances",
            "uncertainty of each",
            "quantities",
            "inertia",
            limit="non-negative",
        ),
        Key("natural_frequency", "of the coupler", dimension="frequency", limit="positive"),
        Key("log_decrement", "lowest and highest", "quantities", limit="non-negative", length=2),
        Key("speeds", "crank speeds of resonances", "quantities", "frequency", limit="positive"),
        Key(
            "regions", "region of instability of each, n in 2 Omega / n", "counts", limit="positive"
        ),
        Key("inertias", "follower inertia of each", "quantities", "inertia", limit="positive"),
    ),
)
_COUPLER = Table(
    "coupler",
    "the flexible coupler",
    (
        Key(
            "bending_stiffness",
            "EI, in the plane of motion",
            dimension="bending_stiffness",
            required=True,
            limit="positive",
        ),
        Key("mass_per_length", "mass per length", dimension="mass_per_length", limit="positive"),
        Key(
            "natural_frequency",
            "first frequency as a pinned beam at rest; gives mu = EI (pi/l3)^4 / Omega^2",
            dimension="frequency",
            limit="positive",
        ),
        Key(
            "damping",
            "distributed viscous damping",
            dimension="damping_per_length",
            limit="non-negative",
        ),
        Key("damping_ratio", "of the first mode at rest", limit="non-negative"),
        replace(_INERTIA, meaning="about the crank pin; a uniform bar's by default"),
        replace(_FIRST_MOMENT, meaning="about the crank pin; a uniform bar's by default"),
    ),
    required=True,
    exactly_one=(("mass_per_length", "natural_frequency"),),
    at_most_one=(("damping", "damping_ratio"),),
)


def _rigid(link: str, *, inertia_required: bool = False) -> Table:
    return Table(
        link,
        f"mass of the rigid {link}",
        (*_MASS_KEYS, replace(_INERTIA, required=inertia_required), _FIRST_MOMENT),
        required=inertia_required,
        at_most_one=(("mass", "weight"),),
    )


def chart_table(parameters: Mapping[str, str]) -> Table:
    """Return the ``[chart]`` table of a mechanism whose charts may vary these parameters."""
    names = tuple(parameters)
    axes = []
    for axis in ("x", "y"):
        axes += [
            Key(axis, f"parameter along {axis}", "text", choices=names),
            Key(f"{axis}_range", "first and last value", "quantities", length=2, rising=True),
            Key(
                f"{axis}_points",
                "number of values",
                "count",
                default=201,
                limit="positive",
                least=2,
                most=20000,
            ),
        ]
    return Table("chart", "the stability chart that is drawn by default", tuple(axes))


_COUPLER_PARAMETERS = {
    "speed": "frequency",
    "follower_inertia": "inertia",
    "bending_stiffness": "bending_stiffness",
    "mass_per_length": "mass_per_length",
    "damping": "damping_per_length",
    "coupler_inertia": "inertia",
    "coupler_first_moment": "first_moment",
}
_HILL_PARAMETERS = {"lam2": "dimensionless", "mu": "dimensionless", "damping": "dimensionless"}

RIGID_FOUR_BAR = Layout(
    "four_bar",
    ("kinematics",),
    (
        _GEOMETRY,
        _rigid("crank"),
        _rigid("coupler"),
        _rigid("follower"),
        _GRAVITY,
        _OPERATION,
    ),
    outputs=(
        "theta3",
        "theta4",
        "omega3",
        "omega4",
        "alpha3",
        "alpha4",
        "transmission_angle",
    ),
    links=LINKS[1:],
)

FLEXIBLE_COUPLER = Layout(
    "four_bar",
    ("complete", "printed", "reduced"),
    (
        _GEOMETRY,
        _rigid("crank"),
        _COUPLER,
        _rigid("follower", inertia_required=True),
        _GRAVITY,
        _OPERATION,
        _MEASURED,
        chart_table(_COUPLER_PARAMETERS),
    ),
    flexible=("coupler",),
    outputs=("stability", "forcing"),
    links=LINKS[1:],
    parameters=_COUPLER_PARAMETERS,
    closed_in_modes=True,
)

HILL = Layout(
    "hill",
    ("plain",),
    (
        Table(
            "function",
            "f(theta) = a[0] + sum over m of a[m] cos(m theta) + b[m] sin(m theta)",
            (
                Key("a", "cosine coefficients, a[0] the mean", "quantities", required=True),
                Key("b", "sine coefficients, b[0] unused and zero", "quantities"),
            ),
            required=True,
        ),
        Table(
            "parameters",
            "of y'' + 2 damping y' + (lam2 + mu f) y = 0",
            (
                Key("lam2", "square of the natural frequency over the crank speed", required=True),
                Key("mu", "factor of the function", required=True),
                Key("damping", "K of Smith (7.38)", default=0.0, limit="non-negative"),
            ),
            required=True,
        ),
        chart_table(_HILL_PARAMETERS),
    ),
    outputs=("stability",),
    parameters=_HILL_PARAMETERS,
)

LAYOUTS = (RIGID_FOUR_BAR, FLEXIBLE_COUPLER, HILL)
