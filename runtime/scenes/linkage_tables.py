"""Tables of linkages: lengths, masses, loads, springs, the drive, and the stability chart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .schema import Key, Table, choice, not_negative, positive, quantities

LINKS = ("frame", "crank", "coupler", "follower")
SLIDER_CRANK_LINKS = ("crank", "coupler", "slider")
QUICK_RETURN_LINKS = ("crank", "block", "rod")


def _length(name: str, meaning: str) -> Key:
    return positive(name, meaning, "length", required=True)


_CRANK = _length("crank", "length of the driven link")
_ASSEMBLY = choice(
    "assembly", "which of the two closed positions", "open", "crossed", default="open"
)
FOUR_BAR_LENGTHS = Table(
    "links",
    "lengths between the pins, and which of the two closures",
    (
        _length("frame", "distance between the fixed pivots"),
        _CRANK,
        _length("coupler", "length of the link between crank and follower"),
        _length("follower", "length of the link to the second fixed pivot"),
        _ASSEMBLY,
    ),
    required=True,
)
SLIDER_CRANK_LENGTHS = Table(
    "links",
    "lengths between the pins, and on which side of the crank pin the slider is",
    (
        _CRANK,
        _length("coupler", "length of the link between crank and slider"),
        Key(
            "offset",
            "distance of the slider's line from the crank pivot, to the left",
            dimension="length",
            default=0.0,
        ),
        _ASSEMBLY,
    ),
    required=True,
)
QUICK_RETURN_LENGTHS = Table(
    "links",
    "lengths between the pins, and of the rod",
    (
        _length("frame", "distance between the pivots of crank and rod"),
        _CRANK,
        _length("rod", "length of the rod, which a block on the crank pin slides along"),
    ),
    required=True,
)
_MASS_KEYS = (
    positive("mass", "mass of the link", "mass"),
    positive("weight", "weight of the link, at gravity.acceleration", "force"),
)
_INERTIA = positive("inertia", "about the link's first joint", "inertia")
_FIRST_MOMENT = Key(
    "first_moment",
    "mass times distance of its centre from the first joint",
    dimension="first_moment",
)
GRAVITY = Table(
    "gravity",
    "what turns a weight into a mass",
    (positive("acceleration", "acceleration of free fall", "acceleration", default=9.80665),),
)
OPERATION = Table(
    "operation",
    "how the machine runs",
    (
        positive("speed", "crank speed", "frequency"),
        quantities(
            "speed_range",
            "lowest and highest crank speed",
            "frequency",
            limit="positive",
            length=2,
            rising=True,
        ),
    ),
)
MEASURED = Table(
    "measured",
    "what was observed on the rig",
    (
        quantities("follower_inertias", "values tried", "inertia", limit="positive"),
        quantities("follower_inertia_tolerances", "their errors", "inertia", limit="non-negative"),
        positive("natural_frequency", "of the coupler", "frequency"),
        quantities("log_decrement", "lowest and highest", limit="non-negative", length=2),
        quantities("speeds", "crank speeds of resonances", "frequency", limit="positive"),
        Key(
            "regions", "region of instability of each, n in 2 Omega / n", "counts", limit="positive"
        ),
        quantities("inertias", "follower inertia of each", "inertia", limit="positive"),
    ),
)
COUPLER = Table(
    "coupler",
    "the flexible coupler",
    (
        positive(
            "bending_stiffness", "EI, in the plane of motion", "bending_stiffness", required=True
        ),
        positive("mass_per_length", "mass per length", "mass_per_length"),
        positive(
            "natural_frequency",
            "first frequency as a pinned beam at rest; gives mu = EI (pi/l3)^4 / Omega^2",
            "frequency",
        ),
        not_negative("damping", "distributed viscous damping", "damping_per_length"),
        not_negative("damping_ratio", "of the first mode at rest"),
        replace(_INERTIA, meaning="about the crank pin; a uniform bar's by default"),
        replace(_FIRST_MOMENT, meaning="about the crank pin; a uniform bar's by default"),
    ),
    required=True,
    exactly_one=(("mass_per_length", "natural_frequency"),),
    at_most_one=(("damping", "damping_ratio"),),
    elsewhere=("width", "thickness", "modulus", "density", "material", "area", "second_moment"),
    instead="give bending_stiffness, E w t^3 / 12 of a rectangle of width w and thickness t, and"
    " mass_per_length, rho w t, or natural_frequency",
)


def rigid_link(link: str, *, inertia_required: bool = False) -> Table:
    """Return the table of a rigid link of which mass and inertia are enough."""
    return Table(
        link,
        f"mass of the rigid {link}",
        (*_MASS_KEYS, replace(_INERTIA, required=inertia_required), _FIRST_MOMENT),
        required=inertia_required,
        at_most_one=(("mass", "weight"),),
    )


def _body(link: str) -> Table:
    """Return the table of a rigid link whose mass may lie anywhere."""
    return Table(
        link,
        f"mass of the {link}; where it lies and turns, in axes along the link at its first joint",
        (
            *_MASS_KEYS,
            positive("density", "density; with width and thickness it gives the mass", "density"),
            positive("width", "width of a bar across the plane", "length"),
            positive("thickness", "thickness of a bar in the plane", "length"),
            _INERTIA,
            positive("inertia_about_centre", "about the centre of mass", "inertia"),
            _FIRST_MOMENT,
            replace(
                _FIRST_MOMENT,
                name="transverse_moment",
                meaning="mass times distance of its centre from the link's line, to the left",
            ),
            Key(
                "centre_along",
                "distance of the centre of mass along the link; half way by default",
                dimension="length",
            ),
            Key(
                "centre_across",
                "distance of the centre of mass from the link's line, to the left",
                dimension="length",
            ),
        ),
        at_most_one=(
            ("mass", "weight", "density"),
            ("inertia", "inertia_about_centre"),
            ("first_moment", "centre_along"),
            ("transverse_moment", "centre_across"),
        ),
    )


def chart_table(parameters: Mapping[str, str]) -> Table:
    """Return the ``[chart]`` table of a mechanism whose charts may vary these parameters."""
    names = tuple(parameters)
    axes = []
    for axis in ("x", "y"):
        axes += [
            choice(axis, f"parameter along {axis}", *names),
            quantities(f"{axis}_range", "first and last value", length=2, rising=True, axis=True),
            Key(f"{axis}_points", "number of values", "count", default=201, least=2, most=20000),
        ]
    return Table("chart", "the stability chart that is drawn by default", tuple(axes))


ACTING_GRAVITY = replace(
    GRAVITY,
    meaning="what turns a weight into a mass; with a direction it also pulls at the links",
    keys=(
        *GRAVITY.keys,
        Key(
            "direction",
            "direction of the pull, from the x axis; left out, the linkage lies flat",
            dimension="angle",
        ),
    ),
)
_RIGID_OPERATION = replace(
    OPERATION,
    keys=(
        *OPERATION.keys,
        Key("acceleration", "crank acceleration", dimension="angular_acceleration", default=0.0),
    ),
)
_MOTOR = Table(
    "motor",
    "what drives the crank: a torque that falls in a straight line with speed, and a flywheel",
    (
        positive("stall_torque", "torque at rest", "moment"),
        positive("no_load_speed", "speed at which no torque is left", "frequency"),
        not_negative("flywheel", "inertia on the crank shaft", "inertia"),
    ),
)


def _acting(links: tuple[str, ...]) -> tuple[Table, ...]:
    """Return the tables of loads and springs on these moving links."""
    place = "in the link's axes, from its first joint"
    load = Table(
        "loads",
        "external loads, each under a name of its own",
        (
            choice("link", "link that it acts on", *links, required=True),
            Key("along", f"point of action along the link, {place}", dimension="length"),
            Key("across", f"point of action across the link, {place}", dimension="length"),
            quantities("force", "x and y component", "force", length=2),
            Key("couple", "anticlockwise", dimension="moment"),
            choice("axes", "axes of the force", "fixed", "link", default="fixed"),
        ),
        named=True,
    )
    ends = ("frame", *links)
    spring = Table(
        "springs",
        "springs and dampers between two points, each under a name of its own",
        (
            choice("first", "link of the first end", *ends, required=True),
            quantities("first_at", "point in that link's axes", "length", length=2),
            choice("second", "link of the second end", *ends, required=True),
            quantities("second_at", "point in that link's axes", "length", length=2),
            not_negative("stiffness", "stiffness", "stiffness"),
            not_negative("free_length", "length without force", "length"),
            Key("preload", "tension at the free length", dimension="force"),
            not_negative("damping", "viscous damping", "damping"),
        ),
        named=True,
    )
    torsion = Table(
        "torsion_springs",
        "torsion springs and dampers between two links, each under a name of its own",
        (
            choice("first", "one link", *ends, required=True),
            choice("second", "the other link", *ends, required=True),
            not_negative("stiffness", "stiffness", "rotational_stiffness"),
            Key("free_angle", "angle of the second against the first", dimension="angle"),
            Key("preload", "couple at the free angle", dimension="moment"),
            not_negative("damping", "viscous damping", "rotational_damping"),
        ),
        named=True,
    )
    return load, spring, torsion


def rigid_tables(geometry: Table, links: tuple[str, ...]) -> tuple[Table, ...]:
    """Return the tables of a linkage with three moving rigid links."""
    bodies = tuple(_body(link) for link in links)
    return (geometry, *bodies, *_acting(links), ACTING_GRAVITY, _RIGID_OPERATION, _MOTOR)
