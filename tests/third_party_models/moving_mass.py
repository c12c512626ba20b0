"""A mass that the crank slides along a string, whose mode shapes are passed in at its place.

The transverse place of the string is ``sum_k q_k shape_k``; the mass sits at ``s(theta) =
length/2 + travel sin theta``.  Only the values and slopes of the shapes at the mass are wanted, as
``shape_k`` and ``slope_k``, so that any shapes do, however they are evaluated.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

PARAMETERS = (
    au.scalar("modal_mass", "kg", "Mass of each mode without the slider"),
    au.scalar("stiffness", "N/m", "Stiffness of the first mode; that of mode k is k^2 times it"),
    au.scalar("slider_mass", "kg", "Sliding mass"),
    au.scalar("gravity", "m/s^2", "Gravity, across the string"),
)
modal_mass, stiffness, slider_mass, gravity = au.symbols(PARAMETERS)
t, theta, rate, acceleration, travel, place_speed = sp.symbols(
    "t theta rate acceleration travel place_speed", real=True
)


def _numbered(name: str, modes: int) -> tuple[sp.Symbol, ...]:
    return tuple(sp.Symbol(f"{name}_{k + 1}", real=True) for k in range(modes))


def _energies(spec: au.ModelSpec) -> au.Lagrangian:
    modes = range(1, spec.modes + 1)
    q = [sp.Function(f"q_{k}")(t) for k in modes]
    shapes = [sp.Function(f"shape_{k}")(t) for k in modes]
    carried = sp.Add(*(a * b for a, b in zip(q, shapes, strict=True)))
    energy = slider_mass / 2 * carried.diff(t) ** 2 - slider_mass * gravity * carried
    for k, coordinate in zip(modes, q, strict=True):
        energy += modal_mass / 2 * coordinate.diff(t) ** 2 - k**2 * stiffness / 2 * coordinate**2
    return au.Lagrangian(tuple(q), t, energy)


def _discretise(spec: au.ModelSpec, equations: au.EquationsOfMotion) -> au.StagedSystem:
    values, slopes = (_numbered(name, spec.modes) for name in ("shape", "slope"))
    chain = {value: slope * place_speed for value, slope in zip(values, slopes, strict=True)}
    crank = au.CrankMotion(theta, rate, acceleration, chain)
    followers = {sp.Function(value.name)(t): value for value in values}
    lagrangian = equations.lagrangian
    energy = au.in_crank_angle(lagrangian.expression, crank, t, followers)
    system = au.quadratic_form(energy, lagrangian.coordinates, crank, t)
    steps = au.Steps(((place_speed, travel * sp.cos(theta)),))
    return au.StagedSystem(
        system, steps, au.symbols(PARAMETERS), (theta, travel), external=(*values, *slopes)
    )


def _describe(spec: au.ModelSpec) -> au.Description:
    passed = [
        au.scalar(symbol.name, unit, f"{word} of mode shape {symbol.name[-1]} at the mass")
        for name, unit, word in (("shape", "", "Value"), ("slope", "1/m", "Slope"))
        for symbol in _numbered(name, spec.modes)
    ]
    return au.Description(
        title="Mass sliding along a string",
        references=("Lagrange",),
        arguments=(
            au.angle("theta", "Crank angle"),
            au.scalar("travel", "m", "Amplitude of the mass's place"),
            *passed,
        ),
        parameters=PARAMETERS,
    )


MODEL = au.Model(
    mechanism="moving_mass",
    formulations=("external_shapes",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
    choices=au.Choices(flexible=("string",)),
)
SPECS = (au.ModelSpec("moving_mass", "external_shapes", flexible=("string",), modes=2),)
