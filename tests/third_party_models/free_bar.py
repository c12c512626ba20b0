"""Dynamic stiffness of a uniform bar in the displacements of its ends, with its pole count."""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

x, t = sp.symbols("x t", real=True)
PARAMETERS = (
    au.scalar("axial_stiffness", "N", "EA"),
    au.scalar("mass_per_length", "kg/m", "mu"),
    au.scalar("length", "m", "Length of the bar"),
)
stiffness, density, length = sp.symbols("axial_stiffness mass_per_length length", positive=True)
frequency, phase, guarded, ratio = sp.symbols("frequency phase guarded ratio", positive=True)
u = sp.Function("u")(x, t)


def _action(spec: au.ModelSpec) -> au.ActionDensity:
    density_ = density / 2 * u.diff(t) ** 2 - stiffness / 2 * u.diff(x) ** 2
    return au.ActionDensity(x=x, t=t, length=length, fields=(u,), density=density_)


def _discretise(spec: au.ModelSpec, equations: au.FieldEquations) -> au.TranscendentalSystem:
    """Move each end by 1 at one frequency, and return the forces that this takes."""
    omega = phase / length * sp.sqrt(stiffness / density)
    solutions = [wave(phase * x / length) for wave in (sp.cos, sp.sin)]
    for solution in solutions:
        residual = equations.equations[u].subs(u, solution * sp.cos(omega * t)).doit()
        if sp.simplify(residual) != 0:
            raise ArithmeticError(f"{solution} does not solve the field equation")
    ends = (sp.S.Zero, length)
    moved = sp.Matrix([[solution.subs(x, at) for solution in solutions] for at in ends])
    forces = sp.Matrix(
        [
            [
                -equations.condition(at, u, 0).subs(u, solution).doit().subs(x, at)
                for solution in solutions
            ]
            for at in ends
        ]
    )
    # The sine over its phase in a power series where the quotient would be 0/0.
    series = sp.expand(au.taylor(sp.sin(phase), phase, 10).value / phase)
    steps = au.Steps(
        (
            (phase, length * frequency * sp.sqrt(density / stiffness)),
            (guarded, sp.Piecewise((phase, phase > 1), (sp.S.One, True))),
            (ratio, sp.Piecewise((sp.sin(guarded) / guarded, phase > 1), (series, True))),
        )
    )
    matrix = (forces * moved.inv()).applyfunc(sp.simplify).subs(sp.sin(phase), ratio * phase)
    return au.TranscendentalSystem(
        frequency=frequency,
        matrix=sp.ImmutableDenseMatrix(matrix.subs(sp.tan(phase), ratio * phase / sp.cos(phase))),
        poles=sp.floor(phase / sp.pi),
        steps=steps,
    )


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Dynamic stiffness of a free bar",
        references=("Wittrick and Williams 1971",),
        parameters=PARAMETERS,
    )


MODEL = au.Model(
    mechanism="free_bar",
    formulations=("dynamic_stiffness",),
    energies=_action,
    describe=_describe,
    discretise=_discretise,
)
SPECS = (au.ModelSpec("free_bar", "dynamic_stiffness"),)
