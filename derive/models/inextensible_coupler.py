"""The inextensible coupler of a four-bar or a slider-crank: geometrically exact equations.

The coupler BC keeps its length: with the angle phi of its tangent, its points are
``r(s) = B + l3 int_0^s (cos phi, sin phi) ds``.  A bent coupler is a shorter coupler, and whatever
shortens it accelerates coupler and follower: so the equations soften.  Kinetic energy is that of
the true positions, strain energy that of the true curvature.  The angle is taken at stations along
the coupler; the integrals along it are sums over pairs of stations, whose kernels follow from the
cosines ``cos(n pi s)`` that pass through the stations (``beam_tangent_harmonics``).

The loop is closed by constraints, whose multipliers are the force at C.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from ..entries import ConstrainedSystem
from ..ir import Argument, Description
from ..lagrange import variational_equations
from ..pipeline import Model
from ..records import EquationsOfMotion, Lagrangian
from ..spec import Choices, ModelSpec
from ..stations import EACH_STATION, Stations, closed_in_stations

STATIONS = Stations(
    "phi",
    ("tangent_x", "tangent_y"),
    ("end", "moment", "bow"),
    ("inertia", "bending", "drag"),
)
T = sp.Symbol("t", real=True)
THETA = sp.Function("theta")(T)
CRANK, COUPLER, DENSITY, STIFFNESS, DAMPING = sp.symbols(
    "crank coupler mass_per_length bending_stiffness damping", positive=True
)
_FRAME, FOLLOWER, INERTIA = sp.symbols("frame follower follower_inertia", positive=True)
_OFFSET, _MOMENT, *PULL = sp.symbols("offset follower_first_moment gravity_x gravity_y", real=True)
PIN = (CRANK * sp.cos(THETA), CRANK * sp.sin(THETA))
SLIDER = sp.Symbol("slider_mass", positive=True)


@dataclass(frozen=True)
class Driven:
    """What the end C of the coupler drives: its coordinate, energies, and the place of C."""

    coordinate: sp.Expr
    energy: sp.Expr
    place: tuple[sp.Expr, sp.Expr]


def driven(mechanism: str) -> Driven:
    """Return what the end C of a mechanism's coupler drives."""
    if mechanism == "slider_crank":
        position = sp.Function("x4")(T)
        energy = SLIDER * (position.diff(T) ** 2 / 2 + PULL[0] * position)
        return Driven(position, energy, (position, _OFFSET))
    psi = sp.Function("psi")(T)
    pull = PULL[0] * sp.cos(psi) + PULL[1] * sp.sin(psi)
    energy = INERTIA / 2 * psi.diff(T) ** 2 + _MOMENT * pull
    return Driven(psi, energy, (_FRAME + FOLLOWER * sp.cos(psi), FOLLOWER * sp.sin(psi)))


def lagrangian(mechanism: str, stations: int = 2) -> Lagrangian:
    """Return energies, constraints and damping of the coupler with a number of stations."""
    each = range(1, stations + 1)
    angles = [sp.Function(f"phi{i}")(T) for i in each]
    tangents = [(sp.cos(phi), sp.sin(phi)) for phi in angles]
    end = driven(mechanism)

    def along(name: str, values: list[sp.Expr]) -> sp.Expr:
        """Return an integral along the coupler."""
        return sp.Add(*(sp.Symbol(f"{name}_{i}") * v for i, v in zip(each, values, strict=True)))

    def twice(name: str, values: list[sp.Expr]) -> sp.Expr:
        """Return an integral along the coupler of a product of two integrals or derivatives."""
        pairs = [(i, j) for i in range(stations) for j in range(stations)]
        return sp.Add(
            *(STATIONS.pair(name, i + 1, j + 1) * values[i] * values[j] for i, j in pairs)
        )

    # (B' + l3 int t' ds)^2 / 2 in both directions; the pin alone moves as it is prescribed.
    energy = sp.S.Zero
    for axis in (0, 1):
        directions = [tangent[axis] for tangent in tangents]
        rates = [direction.diff(T) for direction in directions]
        energy += twice("inertia", rates) / 2 * COUPLER**2
        energy += COUPLER * PIN[axis].diff(T) * along("moment", rates)
        energy += PULL[axis] * COUPLER * along("moment", directions)
    bent = [phi - sp.Symbol(f"bow_{i}") for i, phi in zip(each, angles, strict=True)]
    strain = STIFFNESS / COUPLER * twice("bending", bent) / 2
    dissipation = DAMPING * COUPLER**3 * twice("drag", [phi.diff(T) for phi in angles]) / 2
    ends = [along("end", [tangent[axis] for tangent in tangents]) for axis in (0, 1)]
    return Lagrangian(
        coordinates=(end.coordinate, *angles),
        t=T,
        expression=end.energy + DENSITY * COUPLER * energy - strain,
        constraints=tuple(PIN[axis] + COUPLER * ends[axis] - end.place[axis] for axis in (0, 1)),
        forces={phi: -dissipation.diff(phi.diff(T)) for phi in angles},
    )


def _energies(spec: ModelSpec) -> Lagrangian:
    return lagrangian(spec.mechanism)


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    closed = closed_in_stations(STATIONS, equations, variational_equations(equations))
    return ConstrainedSystem(
        closed.equations, closed.variations, stations=STATIONS, blocks=closed.blocks
    )


def _describe(spec: ModelSpec) -> Description:
    shape = "float or ndarray, shape (N,)"
    driven = (
        Argument("x4", shape, "m", "Place of the slider's pin C along the guide")
        if spec.mechanism == "slider_crank"
        else Argument("psi", shape, "rad", "Follower angle")
    )
    angle = Argument("phi", EACH_STATION, "rad", "Angle of the coupler's tangent at the stations")
    found = described(spec.mechanism, "geometrically exact", [driven, angle], shape)
    vector, kernel = "ndarray, shape (Q, 1)", "ndarray, shape (Q, Q)"
    numbers = (
        Argument("tangent_x", EACH_STATION, "", "Cosine of phi"),
        Argument("tangent_y", EACH_STATION, "", "Sine of phi"),
        Argument("end", vector, "", "Weights of int f ds along the coupler, of unit length"),
        Argument("moment", vector, "", "Weights of int (1 - s) f ds"),
        Argument("bow", vector, "rad", "Angle of the unloaded coupler's tangent"),
        Argument("inertia", kernel, "", "int (int f) (int g) ds, integrals from the crank pin"),
        Argument("bending", kernel, "", "int f' g' ds"),
        Argument("drag", kernel, "", "int (int f) (int g) ds of what has no mean"),
    )
    return replace(
        found,
        arguments=(*found.arguments, *numbers),
        notes=(
            "The coupler's points are r(s) = B + coupler int (cos phi, sin phi) ds.  Arrays with a "
            "value at each of the Q stations have them on their first axis, all others one value "
            "there.",
            "Multipliers: force on C along x and y, up to its sign.",
        ),
    )


def described(mechanism: str, words: str, coordinates: list[Argument], shape: str) -> Description:
    """Return the description of a mechanism's coupler: its drive and parameters, without notes.

    ``words``: what is special to the equations; ``shape``: of the drive's angle and rates.
    """
    slider = mechanism == "slider_crank"
    name = "slider-crank" if slider else "four-bar linkage"
    lengths = (
        ("crank", "coupler", "offset") if slider else ("frame", "crank", "coupler", "follower")
    )
    meanings = {
        "frame": "Length of the frame",
        "crank": "Length of the crank",
        "coupler": "Length of the coupler",
        "follower": "Length of the follower",
        "offset": "Height of the guide over the crank's pivot",
    }
    parameters = [Argument(name, "float", "m", meanings[name]) for name in lengths]
    parameters += [
        Argument("bending_stiffness", "float", "N m^2", "EI of the coupler"),
        Argument("mass_per_length", "float", "kg/m", "mu of the coupler"),
        Argument("damping", "float", "N s/m^2", "Viscous damping of the coupler per length"),
        Argument("gravity_x", "float", "m/s^2", "Acceleration of gravity along x"),
        Argument("gravity_y", "float", "m/s^2", "Acceleration of gravity along y"),
    ]
    parameters += (
        [Argument("slider_mass", "float", "kg", "Mass of the slider")]
        if slider
        else [
            Argument("follower_inertia", "float", "kg m^2", "I4 of the follower about D"),
            Argument("follower_first_moment", "float", "kg m", "m4 r4 of the follower about D"),
        ]
    )
    return Description(
        title=f"Inextensible flexible coupler of a {name}, {words}",
        references=("Smith 9.6, further work 2",),
        arguments=(
            *coordinates,
            Argument("t", shape, "s", "Time"),
            Argument("theta", shape, "rad", "Crank angle"),
            Argument("theta_d1", shape, "rad/s", "Crank speed"),
            Argument("theta_d2", shape, "rad/s^2", "Crank acceleration"),
        ),
        parameters=tuple(parameters),
    )


def _model(mechanism: str) -> Model:
    return Model(
        mechanism=mechanism,
        formulations=("inextensible",),
        energies=_energies,
        describe=_describe,
        discretise=_discretise,
        closed_in_modes=True,
        choices=Choices(flexible=("coupler",)),
    )


FOUR_BAR = _model("four_bar")
SLIDER_CRANK = _model("slider_crank")
