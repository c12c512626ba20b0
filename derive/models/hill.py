"""Hill's equation itself: one degree of freedom with a stiffness that the caller's f modulates.

y'' + 2 K y' + (lam2 + mu f(theta)) y = 0                                    (Smith 7.38)
"""

from __future__ import annotations

import sympy as sp

from ..describe import Description
from ..ir import Argument
from ..linear import linear_periodic
from ..pipeline import Model
from ..records import CrankMotion, EquationsOfMotion, Lagrangian
from ..separation import StagedSystem
from ..spec import ModelSpec
from ..staged import Steps

t = sp.Symbol("t", real=True)
theta, rate, acceleration = sp.symbols("theta theta_rate theta_acceleration", real=True)
lam2, mu, damping, f = sp.symbols("lam2 mu damping f", real=True)
y = sp.Function("y")(t)


def _energies(spec: ModelSpec) -> Lagrangian:
    return Lagrangian(
        coordinates=(y,),
        t=t,
        expression=y.diff(t) ** 2 / 2 - (lam2 + mu * f) * y**2 / 2,
        forces={y: -2 * damping * y.diff(t)},
    )


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> StagedSystem:
    crank = CrankMotion(theta, rate, acceleration, {})
    system = linear_periodic(equations, crank, geometric=(mu,))
    return StagedSystem(system, Steps(), (lam2, mu, damping), (theta,), (f,))


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Hill's equation with viscous damping",
        references=("Smith (7.11)", "Smith (7.38)"),
        arguments=(
            Argument("theta", "ndarray or float, shape (...)", "rad", "Independent variable"),
        ),
        parameters=(
            Argument("lam2", "float", "1/s^2", "Constant part of the stiffness"),
            Argument("mu", "float", "1/s^2", "Factor of the periodic part f"),
            Argument("damping", "float", "1/s", "K of 2 K y'"),
        ),
        notes=("The caller supplies f as a function of the angle, by the name 'f'.",),
    )


MODEL = Model(
    mechanism="hill",
    formulations=("plain",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
)
