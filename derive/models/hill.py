"""Hill's equation itself: one degree of freedom with a stiffness that the caller's f modulates.

y'' + 2 K y' + (lam2 + mu f(theta)) y = 0                                    (Smith 7.38)
"""

from __future__ import annotations

import sympy as sp

from ..arrays import CrankMotion
from ..bloch import HIGHEST_ORDER, LISTED_ORDER, Recursion
from ..ir import Argument, Description
from ..lagrange import linear_periodic
from ..pipeline import Model
from ..records import EquationsOfMotion, Lagrangian
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


def _recursion(spec: ModelSpec) -> Recursion:
    return Recursion(tuple(range(1, HIGHEST_ORDER + 1)), LISTED_ORDER)


_NOTES = (
    "An operator H + t V has a group of resonant states, on which H is one number, set to zero "
    "here.  With P the projector on them, (H + t V) Omega = Omega h and P Omega = P define the "
    "wave operator Omega and the effective operator h; equating powers of t gives h_k = P V "
    "Omega_(k-1) and Omega_k = R (V Omega_(k-1) - Omega_1 h_(k-1) - ... - Omega_(k-1) h_1), R "
    "being -1/H beyond the resonant states and zero on them.  The eigenvalues of h = t h_1 + t^2 "
    "h_2 + ... are those of H + t V.",
    "The algebra is the caller's.  Omega has as many columns as there are resonant states, r, and "
    "h is r x r: with plain matrices, start is the (size, r) basis of the resonant states, act(x) "
    "is V @ x, resolve(x) is R @ x, project(x) the resonant rows of x and combine(x, h) is x @ h.  "
    "For Hill's equation r is 2, or 1 in region 0, and a symmetry gives one column from the other: "
    "there a column may stand for the pair.  Where an operator is a polynomial in several "
    "parameters, a column of order k holds its homogeneous part of degree k.  All that is asked of "
    "columns is a difference.  Where the resonant states have different levels, with the matrix "
    "h_0, the same statements hold with resolve(x) the y beyond the resonant states that solves "
    "y h_0 - H y = (1 - P) x.",
    "WORDS lists the h_k written out: to each order the words and their coefficients.  An "
    "operation is one call of the algebra or one difference.",
)


def _describe_recursion(spec: ModelSpec) -> Description:
    return Description(
        title="Bloch's recursion for the levels of a resonant group of states",
        references=(
            "Smith (7.12)-(7.18), (7.42), (8.39)-(8.43), to any order and number of parameters",
        ),
        arguments=(
            Argument("start", "column", "", "The resonant states, ``Omega_0``"),
            Argument("act", "callable", "", "Applies V to a column, whose order rises by one"),
            Argument("resolve", "callable", "", "Applies R to a column"),
            Argument("project", "callable", "", "Takes P of a column, an effective operator"),
            Argument("combine", "callable", "", "Multiplies ``Omega_j`` by ``h_i``"),
        ),
        notes=_NOTES,
    )


RECURSION = Model(
    mechanism="hill",
    formulations=("recursion",),
    energies=_recursion,
    describe=_describe_recursion,
)
