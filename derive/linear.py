"""Linear periodic arrays read off the equations of motion of a discrete system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import sympy as sp

from .arrays import CrankMotion, DiscreteSystem
from .lagrange import NotRepresentable
from .records import EquationsOfMotion
from .variational import in_crank_angle

_STIFFNESS = {"K": (0, 0), "D": (1, 0), "H": (2, 0), "E": (0, 1)}
_FORCING = {"f": (2, 0), "h": (1, 0), "g": (0, 1), "p": (0, 0)}


def linear_periodic(
    equations: EquationsOfMotion,
    crank: CrankMotion,
    geometric: Iterable[sp.Symbol] = (),
    *,
    followers: Mapping[sp.Expr, sp.Expr] | None = None,
) -> DiscreteSystem:
    """Return the arrays of equations that are linear in the coordinates and velocities.

    Parameters
    ----------
    equations : EquationsOfMotion
        Without constraints.
    crank : CrankMotion
        Crank angle and rates.
    geometric : iterable of Symbol
        Stiffness terms that contain one of these symbols go to Kg instead of K.
    followers : mapping, optional
        Prescribed function of time to its value in plain symbols of the crank.

    Returns
    -------
    DiscreteSystem
        The gyroscopic matrix is held as ``A = (G - M' - its transpose) / 4``.

    Raises
    ------
    NotRepresentable
        If the equations are constrained or something is left over after reassembly.
    """
    if equations.constraints.rows:
        raise NotRepresentable("constrained equations are not a linear periodic system")
    q, qd = list(equations.coordinates), list(equations.velocities)

    def plain(matrix: sp.Matrix) -> sp.Matrix:
        values = followers or {}
        return matrix.applyfunc(lambda e: in_crank_angle(e, crank, equations.t, values).expand())

    mass, residual = plain(equations.mass), plain(equations.rest - equations.forces)
    found, forcing, damping, turning = _read_off(residual, q, qd, crank)
    slope = mass.applyfunc(crank.derivative)
    gyroscopic = turning - slope
    a = (gyroscopic - gyroscopic.T) / 4
    marks = set(geometric)
    stressed = found["K"].applyfunc(
        lambda e: sp.Add(*(i for i in sp.Add.make_args(e) if i.free_symbols & marks))
    )
    arrays = {
        "M": mass,
        "A": a,
        "B": a.applyfunc(crank.derivative) - found["H"],
        "S": a - found["E"],
        "C": damping + (gyroscopic + gyroscopic.T) * crank.rate / 2,
        "D": found["D"],
        "K": found["K"] - stressed,
        "Kg": stressed,
        **forcing,
    }
    frozen = {name: sp.ImmutableDenseMatrix(m.applyfunc(sp.expand)) for name, m in arrays.items()}
    return DiscreteSystem(crank, len(q), frozen, tuple(symbol.name for symbol in q))


def _read_off(
    residual: sp.Matrix, q: list[sp.Symbol], qd: list[sp.Symbol], crank: CrankMotion
) -> tuple[dict[str, sp.Matrix], dict[str, sp.Matrix], sp.Matrix, sp.Matrix]:
    """Return stiffness and forcing arrays by name, damping, and the factor of ``td qd``."""
    rates = (crank.rate, crank.acceleration)
    velocity, position = residual.jacobian(qd), residual.jacobian(q)
    at_rest = residual.subs(dict.fromkeys([*q, *qd], 0))
    found = {name: _part(position, rates, p) for name, p in _STIFFNESS.items()}
    forcing = {name: -_part(at_rest, rates, p) for name, p in _FORCING.items()}
    damping, turning = _part(velocity, rates, (0, 0)), _part(velocity, rates, (1, 0))
    back = (damping + turning * crank.rate) * sp.Matrix(qd)
    for name, (i, j) in _STIFFNESS.items():
        back += found[name] * rates[0] ** i * rates[1] ** j * sp.Matrix(q)
    for name, (i, j) in _FORCING.items():
        back -= forcing[name] * rates[0] ** i * rates[1] ** j
    lost = (residual - back).applyfunc(sp.expand)
    if any(item != 0 for item in lost):
        raise NotRepresentable(f"these terms have no place in the arrays: {list(lost)}")
    return found, forcing, damping, turning


def _part(
    matrix: sp.Matrix, rates: tuple[sp.Symbol, sp.Symbol], powers: tuple[int, int]
) -> sp.Matrix:
    return matrix.applyfunc(
        lambda e: sp.expand(e).coeff(rates[0], powers[0]).coeff(rates[1], powers[1])
    )
