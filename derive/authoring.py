"""What the file of a mechanism of one's own needs, under one roof.

::

    from elastolink.derive import authoring as au
"""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from .arrays import CrankMotion, DiscreteSystem
from .driven import DrivenMotion, driven_motion
from .entries import ConstrainedSystem, MatrixForm, TranscendentalSystem
from .integrals import antiderivative, definite
from .ir import Argument, Description, Result
from .lagrange import euler_lagrange, linear_periodic, quadratic_form, variational_equations
from .pipeline import Model
from .projection.assumed_modes import assumed_modes, assumed_shapes
from .projection.bases import FiniteBasis, IndexedBasis, sine_basis
from .projection.galerkin import mass_normalised, project
from .projection.moving_basis import Moments, MovingShapes, project_moving
from .records import (
    ActionDensity,
    EndForce,
    EquationsOfMotion,
    Essential,
    FieldEquations,
    Lagrangian,
    PointTerm,
    Support,
)
from .separation import StagedSystem
from .series import taylor
from .spec import Choices, ModelSpec
from .staged import ClosedForm, Steps
from .variational import (
    hamilton,
    in_crank_angle,
    linearise,
    quadratic_action,
    solve_end_value,
    solve_tension,
)

__all__ = [
    "ActionDensity",
    "Argument",
    "Choices",
    "ClosedForm",
    "ConstrainedSystem",
    "CrankMotion",
    "Description",
    "DiscreteSystem",
    "DrivenMotion",
    "EndForce",
    "EquationsOfMotion",
    "Essential",
    "FieldEquations",
    "FiniteBasis",
    "IndexedBasis",
    "Lagrangian",
    "MatrixForm",
    "Model",
    "ModelSpec",
    "Moments",
    "MovingShapes",
    "PointTerm",
    "Result",
    "StagedSystem",
    "Steps",
    "Support",
    "TranscendentalSystem",
    "angle",
    "antiderivative",
    "assumed_modes",
    "assumed_shapes",
    "definite",
    "driven_motion",
    "euler_lagrange",
    "hamilton",
    "in_crank_angle",
    "linear_periodic",
    "linearise",
    "mass_normalised",
    "project",
    "project_moving",
    "quadratic_action",
    "quadratic_form",
    "scalar",
    "sine_basis",
    "solve_end_value",
    "solve_tension",
    "symbols",
    "taylor",
    "variational_equations",
]


def angle(name: str, meaning: str) -> Argument:
    """Return the argument that stands for an angle: an array [rad] of any shape."""
    return Argument(name, "array_like, shape (...)", "rad", meaning)


def scalar(name: str, unit: str, meaning: str) -> Argument:
    """Return an argument that is one number."""
    return Argument(name, "float", unit, meaning)


def symbols(arguments: Iterable[Argument]) -> tuple[sp.Symbol, ...]:
    """Return the real symbols that stand for arguments, by name."""
    return tuple(sp.Symbol(argument.name, real=True) for argument in arguments)
