"""What a scene may say: every table and key with its dimension, range and meaning, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ...derive.spec import BEAM_FORMULATIONS, DERIVED_AS, INEXTENSIBLE, NAMED_DROPS
from .beam_tables import (
    BEAM_DROPS,
    BEAM_PARAMETERS,
    DAMPING,
    FRAME,
    JOINTS,
    MATERIAL,
    MEMBERS,
    MESH,
    NODES,
    ROD,
    ROD_LINKS,
    ROD_PARAMETERS,
    beam_table,
)
from .linkage_tables import (
    ACTING_GRAVITY,
    COUPLER,
    FOUR_BAR_LENGTHS,
    GRAVITY,
    LINKS,
    MEASURED,
    OPERATION,
    QUICK_RETURN_LENGTHS,
    QUICK_RETURN_LINKS,
    SLIDER_CRANK_LENGTHS,
    SLIDER_CRANK_LINKS,
    chart_table,
    rigid_link,
    rigid_tables,
)
from .schema import Key, Layout, Table, not_negative, positive

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


def _rigid(mechanism: str, lengths: Table, links: tuple[str, ...]) -> Layout:
    """Return the layout of a linkage of rigid links."""
    tables = rigid_tables(lengths, links)
    return Layout(mechanism, ("kinematics", "forces"), tables, links=links)


RIGID_FOUR_BAR = replace(
    _rigid("four_bar", FOUR_BAR_LENGTHS, LINKS[1:]),
    outputs=("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle"),
)
SLIDER_CRANK = _rigid("slider_crank", SLIDER_CRANK_LENGTHS, SLIDER_CRANK_LINKS)
QUICK_RETURN = _rigid("quick_return", QUICK_RETURN_LENGTHS, QUICK_RETURN_LINKS)


def _coupler_tables(
    coupler: Table, gravity: Table, parameters: Mapping[str, str]
) -> tuple[Table, ...]:
    """Return the tables of a four-bar linkage whose coupler bends."""
    return (
        FOUR_BAR_LENGTHS,
        rigid_link("crank"),
        coupler,
        rigid_link("follower", inertia_required=True),
        gravity,
        OPERATION,
        MEASURED,
        chart_table(parameters),
    )


FLEXIBLE_COUPLER = Layout(
    "four_bar",
    ("complete", "printed", "reduced"),
    _coupler_tables(COUPLER, GRAVITY, _COUPLER_PARAMETERS),
    flexible=("coupler",),
    outputs=("stability", "forcing"),
    links=LINKS[1:],
    parameters=_COUPLER_PARAMETERS,
    closed_in_modes=True,
    system="systems.from_scene.coupler_system",
)

# What is uniform has no inertia of its own, and what is not straight when unloaded has a bow.
_UNIFORM_COUPLER = replace(
    COUPLER,
    keys=(
        *(key for key in COUPLER.keys if key.name not in ("inertia", "first_moment")),
        Key("bow", "deflection of its middle when unloaded", dimension="length", default=0.0),
    ),
)
_BENT_PARAMETERS = {
    name: dimension
    for name, dimension in _COUPLER_PARAMETERS.items()
    if name not in ("coupler_inertia", "coupler_first_moment")
}
INEXTENSIBLE_COUPLER = replace(
    FLEXIBLE_COUPLER,
    formulations=INEXTENSIBLE,
    tables=_coupler_tables(_UNIFORM_COUPLER, ACTING_GRAVITY, _BENT_PARAMETERS),
    outputs=("motion", "variations"),
    parameters=_BENT_PARAMETERS,
    closed_in_modes=False,
    system="systems.inextensible.inextensible_system",
)
INEXTENSIBLE_ROD = replace(
    INEXTENSIBLE_COUPLER,
    mechanism="slider_crank",
    tables=(
        SLIDER_CRANK_LENGTHS,
        rigid_link("crank"),
        _UNIFORM_COUPLER,
        Table(
            "slider",
            "the slider",
            (positive("mass", "mass of the slider", "mass", required=True),),
            required=True,
        ),
        ACTING_GRAVITY,
        OPERATION,
    ),
    links=SLIDER_CRANK_LINKS[:2],
    parameters={},
)

FLEXIBLE_ROD = Layout(
    "quick_return",
    tuple(name for mechanism, name in DERIVED_AS if mechanism == "quick_return"),
    (ROD_LINKS, ROD, OPERATION, chart_table(ROD_PARAMETERS)),
    flexible=("rod",),
    outputs=("stability", "forcing"),
    parameters=ROD_PARAMETERS,
    closed_in_modes=True,
    system="systems.from_scene.rod_of_scene",
    named_drops=NAMED_DROPS["quick_return", "moving_basis"],
)
FREE_FREE_ROD = replace(
    FLEXIBLE_ROD,
    formulations=("free_free",),
    outputs=("motion", "variations"),
    closed_in_modes=False,
    named_drops=NAMED_DROPS["quick_return", "free_free"],
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
                not_negative("damping", "K of Smith (7.38)", default=0.0),
            ),
            required=True,
        ),
        chart_table(_HILL_PARAMETERS),
    ),
    outputs=("stability",),
    parameters=_HILL_PARAMETERS,
    system="systems.from_scene.hill_system",
)

_BEAM_SYSTEM = "systems.beam_scenes.beams_of_scene"
_BEAM_TABLES = (MATERIAL, JOINTS, MESH, DAMPING, ACTING_GRAVITY, OPERATION)


def _beams(mechanism: str, geometry: Table, links: tuple[str, ...]) -> Layout:
    """Return the layout of a linkage all of whose links are beams."""
    lengths = {key.name for key in geometry.keys}
    parameters = {
        name: dimension
        for name, dimension in BEAM_PARAMETERS.items()
        if dimension != "length" or name in lengths
    }
    return Layout(
        mechanism,
        tuple(BEAM_FORMULATIONS),
        (geometry, *(beam_table(link) for link in links), *_BEAM_TABLES, chart_table(parameters)),
        flexible=links,
        parameters=parameters,
        closed_in_modes=True,
        system=_BEAM_SYSTEM,
        named_drops=BEAM_DROPS,
    )


FOUR_BAR_OF_BEAMS = _beams("four_bar", FOUR_BAR_LENGTHS, LINKS[1:])
SLIDER_CRANK_OF_BEAMS = _beams("slider_crank", SLIDER_CRANK_LENGTHS, SLIDER_CRANK_LINKS[:2])
FRAME_OF_BEAMS = Layout(
    "frame",
    tuple(BEAM_FORMULATIONS),
    (NODES, MEMBERS, FRAME, MATERIAL, MESH, DAMPING, ACTING_GRAVITY),
    closed_in_modes=True,
    system=_BEAM_SYSTEM,
    named_drops=BEAM_DROPS,
)

LAYOUTS = (
    RIGID_FOUR_BAR,
    FLEXIBLE_COUPLER,
    INEXTENSIBLE_COUPLER,
    SLIDER_CRANK,
    INEXTENSIBLE_ROD,
    QUICK_RETURN,
    FLEXIBLE_ROD,
    FREE_FREE_ROD,
    FOUR_BAR_OF_BEAMS,
    SLIDER_CRANK_OF_BEAMS,
    FRAME_OF_BEAMS,
    HILL,
)
