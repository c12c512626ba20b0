"""Forces of a rigid planar linkage in closed form: from its description to one set of functions.

Joint forces and torque by Newton and Euler, the torque alone by virtual power, the shaking force
and moment by the momenta: every function takes the cheapest of the three ways, and holds no step
that it does not need.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import sympy as sp

from ..ir import Argument, Description, Result, array_results
from ..spec import Choices, ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms, Step, Steps, vanishing
from .newton_euler import (
    TORQUE,
    balances,
    reactions,
    shaking,
    solve,
    unknowns_of,
    virtual_power,
    wrench_symbols,
)
from .planar import STRAIGHT, Body, MassMoments, PlanarLinkage, Slide, inertia_wrench

STEADY = "crank_acceleration"
CHOICES = Choices(drop=(STRAIGHT, STEADY))
speed, acceleration = sp.symbols("speed acceleration", real=True)
_SQUARE = sp.Symbol("square", real=True)
_MOMENTS = ("mass", "along", "across", "inertia")
_PUSHES = ("fx", "fy", "couple")
_Tidy: TypeAlias = Callable[[sp.Expr], sp.Expr]
_Inputs: TypeAlias = tuple[sp.Symbol, ...]


def moments_of(number: int, spec: ModelSpec) -> MassMoments:
    """Return the symbols of a link's mass: total, first moments, inertia about its first joint."""
    mass, along, across, inertia = (sp.Symbol(f"{n}{number}", real=True) for n in _MOMENTS)
    return MassMoments(mass, along, sp.S.Zero if STRAIGHT in spec.drop else across, inertia)


@dataclass(frozen=True)
class SolvedMotion:
    """Kinematics of a linkage in closed form, as its forces use them.

    ``geometry``: arguments behind the crank angle; ``steps``: sines, cosines, derivatives by the
    crank angle; ``theta2``: crank angle; ``names``: sines, cosines and places of the coordinates,
    functions of time, by the steps' symbols; ``rates``: first and second derivative of each
    coordinate by the crank angle; ``differences``: products of sines and cosines by those of
    differences of angles, where steps have these; ``reciprocals``: quantities whose reciprocal the
    steps hold, and the reciprocal; ``groups``: products of vectors; power and moment of momentum
    are collected by these; ``slips``: derivatives w by the crank angle, and the steps for ``1 - w``
    that do not cancel.
    """

    geometry: tuple[Argument, ...]
    steps: Steps
    theta2: sp.Symbol
    names: Mapping[sp.Expr, sp.Expr]
    rates: Mapping[sp.Expr, tuple[sp.Expr, sp.Expr]]
    differences: Mapping[sp.Expr, sp.Expr]
    reciprocals: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)
    groups: tuple[sp.Expr, ...] = ()
    slips: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict)

    def named(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression in the coordinates by the steps' symbols."""
        result = sp.expand(sp.sympify(expression).xreplace(self.names))
        for product, value in self.differences.items():
            result = sp.expand(result.subs(product, value))
        return result


@dataclass(frozen=True)
class _Forces:
    """The parts of which the functions are made."""

    spec: ModelSpec
    linkage: PlanarLinkage
    motion: SolvedMotion

    @property
    def steady(self) -> bool:
        return STEADY in self.spec.drop

    def inertia_steps(self) -> Steps:
        """Return the kinematics, and what the motion of each link takes."""
        steps = [(_SQUARE, speed**2), *self._scaled(), *self._rates()]
        for body, push in zip(self.linkage.bodies, wrench_symbols(self.linkage), strict=True):
            for symbol in push:
                value = self._by_moments([body], self._pushes[symbol], sp.factor_terms)
                steps.append((symbol, value))
        return self.motion.steps.then(*steps)

    @cached_property
    def _pushes(self) -> dict[sp.Symbol, sp.Expr]:
        """What the motion of each link takes, by the steps."""
        links = zip(self.linkage.bodies, wrench_symbols(self.linkage), strict=True)
        return {
            symbol: self._in_steps(part)
            for body, push in links
            for symbol, part in zip(push, inertia_wrench(body, self.linkage.t), strict=True)
        }

    def load_steps(self) -> Steps:
        """Return the kinematics, and the loads in place of what the motion takes."""
        steps = []
        for number, push in zip(self.linkage.numbers, wrench_symbols(self.linkage), strict=True):
            for symbol, name in zip(push, _PUSHES, strict=True):
                steps.append((symbol, -sp.Symbol(f"{name}{number}", real=True)))
        return self.motion.steps.then(*steps)

    def _scales(self) -> dict[sp.Symbol, sp.Expr]:
        """Return names for the moments times the square of the speed, at constant speed."""
        if not self.steady:
            return {}
        every = [value for body in self.linkage.bodies for value in vars(body.moments).values()]
        return {sp.Symbol(f"{value}_s", real=True): value for value in every if value != 0}

    def _scaled(self) -> list[Step]:
        return [(symbol, _SQUARE * value) for symbol, value in self._scales().items()]

    def _rates(self) -> list[Step]:
        """Return squared speeds and accelerations; at constant speed over the speed squared."""
        return [
            (symbol, value)
            for coordinate in self.motion.rates
            for symbol, value in self._rates_of(coordinate)
            if not (value.is_number or value.is_Symbol)
        ]

    def _rates_of(self, coordinate: sp.Expr) -> tuple[Step, Step]:
        """Return squared speed and acceleration of a coordinate, with the names of both."""
        first, second = self.motion.rates[coordinate]
        spin, turn = rate_symbols(coordinate)
        if self.steady:
            return (spin, first**2), (turn, second)
        return (spin, _SQUARE * first**2), (turn, _SQUARE * second + acceleration * first)

    def _in_steps(self, expression: sp.Expr) -> sp.Expr:
        """Return time derivatives by the names of :meth:`_rates_of`, all else by the steps."""
        t = self.linkage.t
        result = sp.expand(expression)
        plain: dict[sp.Symbol, sp.Expr] = {}
        for coordinate in self.motion.rates:
            spin, turn = rate_symbols(coordinate)
            own = self._rates_of(coordinate)
            plain |= {name: value for name, value in own if value.is_number or value.is_Symbol}
            rate = sp.Symbol(f"rate_{coordinate.func.__name__}")
            result = result.subs(coordinate.diff(t, 2), turn).subs(coordinate.diff(t), rate)
            result = sp.expand(result).subs(rate**2, spin)
            if result.has(rate):
                raise ValueError(f"speed of {coordinate} is not squared in {expression}")
        return sp.expand(self.motion.named(result).subs(plain))

    def _by_moments(self, bodies: Iterable[Body], value: sp.Expr, tidy: _Tidy) -> sp.Expr:
        """Collect by mass, first moments and inertia, so that each meets an array once."""
        scaled = {moment: name for name, moment in self._scales().items()}
        parts, rest = [], sp.expand(value)
        for body in bodies:
            for moment in vars(body.moments).values():
                if moment != 0:
                    factor = rest.coeff(moment)
                    parts.append(scaled.get(moment, moment) * tidy(factor))
                    rest = sp.expand(rest - moment * factor)
        return sp.Add(*parts, rest)

    def joint_steps(self) -> Steps:
        """Return reactions and torque by what acts on the links."""
        equations = [self.motion.named(equation) for equation in balances(self.linkage)]
        found = solve(equations, unknowns_of(self.linkage), self._reciprocal)
        named = self.motion.named
        return Steps(tuple((symbol, sp.factor_terms(named(value))) for symbol, value in found))

    def _reciprocal(self, determinant: sp.Expr) -> sp.Expr:
        known = {value: 1 / name for value, name in self.motion.reciprocals.items()}
        return 1 / sp.factor(self.motion.named(determinant)).xreplace(known)

    def joint_outputs(self) -> dict[str, sp.Expr]:
        """Return components of the reactions, and the couple of a sliding joint."""
        forces: dict[str, sp.Expr] = {}
        couples: dict[str, sp.Expr] = {}
        for reaction in reactions(self.linkage):
            pair = f"{reaction.joint.first}{reaction.joint.second}"
            forces[f"x{pair}"] = self.motion.named(reaction.x)
            forces[f"y{pair}"] = self.motion.named(reaction.y)
            if isinstance(reaction.joint, Slide):
                couples[f"couple{pair}"] = reaction.couple
        return {**forces, **couples}

    def momentum_outputs(self) -> dict[str, sp.Expr]:
        """Return force on the frame and its moment, by the momenta."""
        parts = (self.motion.named(part) for part in shaking(self.linkage))
        return dict(zip(_SHAKING, parts, strict=True))

    def power_torque(self) -> sp.Expr:
        """Return the torque by virtual power, collected by the moments of the masses."""
        rates = {c.diff(self.linkage.t): first for c, (first, _) in self.motion.rates.items()}
        return self._whole(virtual_power(self.linkage, rates, self.motion.named))

    def momentum_moment(self) -> sp.Expr:
        """Return the moment on the frame by the moment of momentum, collected likewise."""
        return self._whole(self.motion.named(shaking(self.linkage).moment))

    def _whole(self, total: sp.Expr) -> sp.Expr:
        """Insert what links on moving pins take: terms that cancel exactly never arise."""
        pushes: dict[sp.Symbol, sp.Expr] = {}
        spins = {rate_symbols(c)[0]: self._rates_of(c)[0][1] for c in self.motion.rates}
        t, carried = self.linkage.t, []
        for body, push in zip(self.linkage.bodies, wrench_symbols(self.linkage), strict=True):
            if sp.Matrix(body.origin).has(t):
                carried.append(body)
                pushes |= {symbol: self._pushes[symbol] for symbol in push}
        value = self.motion.named(sp.expand(total).subs(pushes)).subs(spins)
        return self._by_moments(carried, value, self._without_slips)

    def _without_slips(self, value: sp.Expr) -> sp.Expr:
        """Collect by the products of vectors, and write each ``w - 1`` that appears as a slip."""
        slips = {w - 1: -slip for w, slip in self.motion.slips.items()}
        parts, rest = [], sp.expand(value)
        for group in self.motion.groups:
            factor = rest.coeff(group)
            rest = sp.expand(rest - group * factor)
            parts.append(group * sp.factor(factor).subs(slips))
        return sp.factor_terms(sp.Add(*parts, sp.factor_terms(rest)))


_SHAKING = ("shaking_x", "shaking_y", "shaking_moment")


def rate_symbols(coordinate: sp.Expr) -> tuple[sp.Symbol, sp.Symbol]:
    """Return the names of the squared speed and the acceleration of a coordinate."""
    name = coordinate.func.__name__
    return sp.Symbol(f"spin_{name}", real=True), sp.Symbol(f"turn_{name}", real=True)


def forces(spec: ModelSpec, linkage: PlanarLinkage, motion: SolvedMotion) -> KernelForms:
    """Return the functions of a linkage's forces.

    ``spec``: ``drop`` may name the crank's acceleration and the masses' places across the links;
    ``linkage``: bodies, joints and drive; ``motion``: its kinematics in closed form.
    """
    parts = _Forces(spec, linkage, motion)
    drive = (speed,) if parts.steady else (speed, acceleration)
    geometry = tuple(sp.Symbol(a.name, real=True) for a in motion.geometry)
    masses = tuple(
        moment for body in linkage.bodies for moment in vars(body.moments).values() if moment != 0
    )
    inputs = (motion.theta2, *drive, *geometry, *masses)
    inertia, joints = parts.inertia_steps(), parts.joint_steps()
    momenta, pins = parts.momentum_outputs(), parts.joint_outputs()
    loads = {**pins, "torque": TORQUE, **momenta}
    momenta["shaking_moment"] = parts.momentum_moment()
    whole = {**pins, "torque": parts.power_torque(), **momenta}
    solved = inertia.then(*joints.steps)
    loaded = parts.load_steps().then(*joints.steps)
    wrenches = tuple(
        sp.Symbol(f"{name}{number}", real=True) for number in linkage.numbers for name in _PUSHES
    )

    def form(
        name: str, steps: Steps, outputs: Mapping[str, sp.Expr], of: _Inputs = inputs
    ) -> KernelForm:
        closed = ClosedForm(of, steps.needed(outputs.values()), tuple(outputs.items()))
        return KernelForm(name, _SUMMARIES[name], closed)

    dropped = {}
    if not spec.drop:
        across = tuple(moment.name for moment in masses if moment.name.startswith(STRAIGHT))
        dropped = vanishing({STRAIGHT: across, STEADY: (acceleration.name,)})
    frame_moment = {name: momenta[name] for name in _SHAKING[2:]}
    frame_force = {name: momenta[name] for name in _SHAKING[:2]}
    return KernelForms(
        (
            form("forces", solved, whole),
            form("pin_forces", solved, pins),
            form("driving_torque", inertia, {"torque": whole["torque"]}),
            form("shaking_force", inertia, frame_force),
            form("shaking_moment", inertia, frame_moment),
            form("load_forces", loaded, loads, (motion.theta2, *geometry, *wrenches)),
        ),
        dropped,
    )


_SUMMARIES = {
    "forces": "Return every joint force, the torque, and the force and moment on the frame",
    "pin_forces": "Return every joint force",
    "driving_torque": "Return the torque on the crank, by virtual power",
    "shaking_force": "Return the force on the frame, the change of momentum",
    "shaking_moment": "Return the moment on the frame about A, the change of moment of momentum",
    "load_forces": "Return what external loads alone call forth",
}


_DRIVE = (
    Argument("speed", "float or ndarray, shape (...)", "rad/s", "Crank speed"),
    Argument("acceleration", "float or ndarray, shape (...)", "rad/s^2", "Crank acceleration"),
)
MOMENT_WORDS = (
    ("mass", "kg", "Mass of link"),
    ("along", "kg m", "First moment along link"),
    ("across", "kg m", "First moment across link"),
    ("inertia", "kg m^2", "Inertia, about its first joint, of link"),
)
LOAD_WORDS = (
    ("fx", "N", "Force along x at the first joint of link"),
    ("fy", "N", "Force along y at the first joint of link"),
    ("couple", "N m", "Couple on link"),
)


def description(
    spec: ModelSpec,
    mechanism: str,
    theta2: Argument,
    geometry: Sequence[Argument],
    references: tuple[str, ...],
    sliding: str = "",
) -> Description:
    """Return the words of a module of forces.

    ``spec``: what the module is; ``mechanism``: its linkage, in words; ``theta2``: crank angle;
    ``geometry``: lengths and assembly; ``references``: equations of the documents; ``sliding``: the
    pair of links of a sliding joint, if there is one.
    """
    arguments = [theta2, *_DRIVE, *geometry]
    for words in (MOMENT_WORDS, LOAD_WORDS):
        arguments += [
            Argument(f"{name}{n}", "float or ndarray", unit, f"{meaning} {n}")
            for n in (2, 3, 4)
            for name, unit, meaning in words
        ]
    restrictions = [words for key, words in _RESTRICTIONS if key in spec.drop]
    return Description(
        title=f"Forces of {mechanism} in closed form",
        references=references,
        arguments=tuple(arguments),
        results=_results(sliding),
        notes=(
            "Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first "
            "joint along the link.  The forces are linear in masses, moments and inertias: at unit "
            "values of one of these they are the derivatives by it.",
            *restrictions,
        ),
    )


def _results(sliding: str) -> dict[str, Result]:
    """Return the words of everything that the functions return."""
    found: dict[str, tuple[str, str]] = {}
    for pair in ("12", "23", "34", "41"):
        for axis in ("x", "y"):
            found[axis + pair] = "N", f"Force of link {pair[0]} on link {pair[1]} along {axis}"
    if sliding:
        found[f"couple{sliding}"] = "N m", f"Couple of link {sliding[0]} on link {sliding[1]}"
    found |= {
        "torque": ("N m", "Torque of the drive on the crank, anticlockwise"),
        "shaking_x": ("N", "Force on the frame along x"),
        "shaking_y": ("N", "Force on the frame along y"),
        "shaking_moment": ("N m", "Moment on the frame about A, the drive's reaction in it"),
    }
    return array_results(found)


_RESTRICTIONS = (
    ("crank_acceleration", "For a crank of constant speed."),
    ("across", "For links whose masses lie along their lines."),
)
