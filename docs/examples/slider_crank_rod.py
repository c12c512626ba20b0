"""A slider-crank whose connecting rod bends: a uniform rod BC, pinned to the crank and the slider.

The crank AB turns by ``theta2``, the chord BC by ``theta3``; C slides at the height ``offset``.
"""

import sympy as sp
from elastolink.derive import authoring as au

GEOMETRY = (
    au.angle("theta2", "Crank angle"),
    au.scalar("crank", "m", "Length of the crank AB"),
    au.scalar("rod", "m", "Length of the rod BC"),
    au.scalar("offset", "m", "Height of the guide of C above the axis A"),
)
PARAMETERS = (
    au.scalar("bending_stiffness", "N m^2", "EI of the rod"),
    au.scalar("mass_per_length", "kg/m", "Mass of the rod per length"),
    au.scalar("damping", "N s/m^2", "Viscous damping of the rod per length"),
    au.scalar("slider_mass", "kg", "Mass of the slider"),
)
theta2, crank, rod, offset = au.symbols(GEOMETRY)
stiffness, density, damping, slider = au.symbols(PARAMETERS)
x, t, rate, acceleration, sine3 = sp.symbols("x t rate acceleration sine3", real=True)
th2, th3, s, end_load = (sp.Function(name)(t) for name in ("th2", "theta3", "s", "end_load"))
y, u, tension = (sp.Function(name)(x, t) for name in ("y", "u", "N"))


def action(spec):
    """Return kinetic less bending energy in the rod's axes; N keeps the length of the bent rod."""
    along = crank * th2.diff(t) * sp.sin(th3 - th2) + u.diff(t) - th3.diff(t) * y
    across = crank * th2.diff(t) * sp.cos(th3 - th2) + y.diff(t) + th3.diff(t) * (x + u)
    energy = density / 2 * (along**2 + across**2) - stiffness / 2 * y.diff(x, 2) ** 2
    return au.ActionDensity(
        x=x,
        t=t,
        length=rod,
        fields=(y, u, tension),
        density=energy - tension * (u.diff(x) + y.diff(x) ** 2 / 2),
        force_density={y: -damping * y.diff(t)},
        end_forces=(au.EndForce(rod, u, 0, end_load),),
        essential=(au.Essential(0, y, 0), au.Essential(rod, y, 0), au.Essential(0, u, 0)),
        orders={y: 1, u: 2, tension: 0},
    )


def rigid(energies):
    """Return Lagrange's equations of the straight rod and the slider; X, Y act on the rod at C."""
    straight = sp.expand(energies.density.subs({y: 0, u: 0}).doit())
    energy = au.definite(straight, x, 0, rod) + slider / 2 * s.diff(t) ** 2
    run, rise = (crank * trig(th2) + rod * trig(th3) for trig in (sp.cos, sp.sin))
    return au.euler_lagrange(au.Lagrangian((th3, s), t, energy, (run - s, rise - offset)))


def discretise(spec, equations):
    """Eliminate the tension, project on sine modes, divide by the modal mass."""
    motion = au.driven_motion(
        rigid(equations.action), th2, au.CrankMotion(theta2, rate, acceleration)
    )
    theta3 = sp.Symbol("theta3")
    load = motion.forces[0] * sp.cos(theta3) + motion.forces[1] * sp.sin(theta3)
    axial = au.linearise(equations.equations[u], equations.action.orders, 0)
    held = au.solve_tension(axial, tension, x, rod, end_load)
    linear = au.hamilton(au.quadratic_action(equations.action, {tension: held}, (u,)))
    followers = {th2: theta2, th3: theta3, end_load: load}
    system = au.project(linear, y, au.sine_basis(x, rod), motion.crank, followers=followers)
    angles = (
        (sine3, (offset - crank * sp.sin(theta2)) / rod),
        (theta3, sp.atan2(sine3, sp.sqrt((1 - sine3) * (1 + sine3)))),
    )
    steps = au.Steps(angles).then(*motion.steps.steps)
    return au.StagedSystem(
        au.mass_normalised(system), steps, au.symbols(PARAMETERS), au.symbols(GEOMETRY)
    )


def describe(spec):
    """Return the words of the emitted module."""
    title = "Slider-crank with a connecting rod that bends"
    return au.Description(title, ("Hamilton's principle",), GEOMETRY, parameters=PARAMETERS)


MODEL = au.Model(
    mechanism="slider_crank",
    formulations=("complete",),
    energies=action,
    describe=describe,
    discretise=discretise,
    closed_in_modes=True,
    choices=au.Choices(flexible=("rod",)),
)
SPECS = (au.ModelSpec("slider_crank", "complete", flexible=("rod",)),)
