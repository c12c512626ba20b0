"""Dynamic stiffness of a uniform beam on two pins, in its end rotations, with its pole count."""

from __future__ import annotations

from typing import Any

import sympy as sp
from elastolink.derive import authoring as au

x, t = sp.symbols("x t", real=True)
PARAMETERS = (
    au.scalar("bending_stiffness", "N m^2", "EI"),
    au.scalar("mass_per_length", "kg/m", "mu"),
    au.scalar("length", "m", "Length of the beam"),
)
stiffness, density, length = sp.symbols("bending_stiffness mass_per_length length", positive=True)
frequency, wave, phase, guarded = sp.symbols("frequency wave phase guarded", positive=True)
w = sp.Function("w")(x, t)


def _action(spec: au.ModelSpec) -> au.ActionDensity:
    return au.ActionDensity(
        x=x,
        t=t,
        length=length,
        fields=(w,),
        density=density / 2 * w.diff(t) ** 2 - stiffness / 2 * w.diff(x, 2) ** 2,
        essential=(au.Essential(sp.S.Zero, w, 0), au.Essential(length, w, 0)),
    )


def _solutions(equations: au.FieldEquations) -> list[sp.Expr]:
    """Return four solutions ``W(x)`` of the field equation at one frequency, none above 1."""
    exponent = sp.Symbol("r")
    trial = sp.exp(exponent * x) * sp.cos(frequency * t)
    condition = (equations.equations[w].subs(w, trial).doit() / trial).expand()
    omega = wave**2 * sp.sqrt(stiffness / density)
    roots = set(sp.roots(sp.Poly(condition.subs(frequency, omega), exponent)))
    if roots != {wave, -wave, sp.I * wave, -sp.I * wave}:
        raise ArithmeticError(f"unexpected exponents {roots}")
    decaying = [sp.exp(-wave * x), sp.exp(-wave * (length - x))]
    return [sp.cos(wave * x), sp.sin(wave * x), *decaying]


def _discretise(spec: au.ModelSpec, equations: au.FieldEquations) -> au.TranscendentalSystem:
    """Hold both ends at rotations, and return the moments that this takes."""
    cos, sin, decay = sp.symbols("cos_phase sin_phase decay", real=True)
    plain = {sp.cos(wave * length): cos, sp.sin(wave * length): sin, sp.exp(-wave * length): decay}
    solutions = _solutions(equations)
    ends = (sp.S.Zero, length)

    def row(operator: sp.Expr, at: sp.Expr) -> list[sp.Expr]:
        values = (operator.subs(w, solution).doit().subs(x, at) for solution in solutions)
        return [sp.expand(value, power_exp=False).xreplace(plain) for value in values]

    held = sp.Matrix([row(item, at) for item in (w, w.diff(x)) for at in ends])
    moments = sp.Matrix([row(-equations.condition(at, w, 1), at) for at in ends])
    determinant = _on_circle(held.det(method="berkowitz"), cos, sin)
    whole = (moments * held.adjugate())[:, 2:].applyfunc(lambda e: _on_circle(e, cos, sin))
    # What vanishes at the frequencies of the clamped beam, positive below the first.
    clamped = 2 * decay - cos * (1 + decay**2)
    scale = sp.cancel(determinant / clamped)
    if scale.has(cos, sin, decay):
        raise ArithmeticError(f"{determinant} is not a multiple of {clamped}")
    near, far = (sp.cancel(entry * wave / (scale * stiffness * wave**2)) for entry in whole[0, :])
    if whole != sp.Matrix([[whole[0, 0], whole[0, 1]], [whole[0, 1], whole[0, 0]]]):
        raise ArithmeticError(f"{whole} is not symmetric in the ends")
    names = sp.symbols("near far pole", real=True)
    values = [
        _everywhere(value, order, {cos: sp.cos, sin: sp.sin, decay: lambda p: sp.exp(-p)})
        for value, order in ((near, 3), (far, 3), (clamped, 4))
    ]
    turns = sp.floor(phase / sp.pi)
    sign = sp.Piecewise((sp.S.One, names[2] > 0), (-sp.S.One, True))
    steps = au.Steps(
        (
            (phase, length * sp.sqrt(frequency * sp.sqrt(density / stiffness))),
            (guarded, sp.Piecewise((phase, phase > 1), (sp.S.One, True))),
            (cos, sp.cos(guarded)),
            (sin, sp.sin(guarded)),
            (decay, sp.exp(-guarded)),
            *zip(names, values, strict=True),
        )
    )
    direct, carried = (stiffness / length * name / names[2] for name in names[:2])
    return au.TranscendentalSystem(
        frequency=frequency,
        matrix=sp.ImmutableDenseMatrix([[direct, carried], [carried, direct]]),
        poles=turns - (1 - (-1) ** turns * sign) / 2,
        steps=steps,
    )


def _everywhere(value: sp.Expr, order: int, functions: dict[sp.Symbol, Any]) -> sp.Expr:
    """Divide by ``phase^order``, in a power series where the closed form loses its digits."""
    entire = value.subs({symbol: function(phase) for symbol, function in functions.items()})
    series = au.taylor(entire * sp.exp(phase) / 2, phase, 5).value
    plain = value / guarded**order
    return sp.Piecewise((plain, phase > 1), (sp.expand(series / phase**order), True))


def _on_circle(expression: sp.Expr, cos: sp.Symbol, sin: sp.Symbol) -> sp.Expr:
    return sp.factor(sp.rem(sp.expand(expression), cos**2 + sin**2 - 1, cos))


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Dynamic stiffness of a pinned beam",
        references=("Wittrick and Williams 1971",),
        parameters=PARAMETERS,
    )


MODEL = au.Model(
    mechanism="pinned_beam",
    formulations=("dynamic_stiffness",),
    energies=_action,
    describe=_describe,
    discretise=_discretise,
)
SPECS = (au.ModelSpec("pinned_beam", "dynamic_stiffness"),)
