"""Newton and Euler's equations of a planar linkage, solved joint by joint.

Each moving link has three equations; joint reactions and the drive's torque are the unknowns.  The
smallest set of equations that holds no more unknowns than equations is solved first, then the
next: for a four-bar linkage the moments of coupler and follower give the force in the pin
between them (Smith 4.7), and all else follows by substitution (4.8)-(4.11).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import sympy as sp

from ..staged import Step
from .planar import Joint, PlanarLinkage, Slide, Wrench, cross

TORQUE = sp.Symbol("torque", real=True)
Named = Callable[[sp.Expr], sp.Expr]


@dataclass(frozen=True)
class Reaction:
    """What one joint transmits from its first link to its second.

    ``joint``: which joint; ``x``, ``y``: components of the force; a frictionless slide has one
    unknown, along its normal; ``couple``: 0 for a pin; ``unknowns``: the unknowns in these.
    """

    joint: Joint
    x: sp.Expr
    y: sp.Expr
    couple: sp.Expr
    unknowns: tuple[sp.Symbol, ...]


def reactions(linkage: PlanarLinkage) -> tuple[Reaction, ...]:
    """Return the reaction of each joint, Smith's X_ij and Y_ij: link i upon link j."""
    found = []
    for joint in linkage.joints:
        pair = f"{joint.first}{joint.second}"
        if isinstance(joint, Slide):
            normal, couple = sp.symbols(f"normal{pair} couple{pair}", real=True)
            across = linkage.normal(joint)
            x, y = normal * across[0], normal * across[1]
            found.append(Reaction(joint, x, y, couple, (normal, couple)))
        else:
            x, y = sp.symbols(f"x{pair} y{pair}", real=True)
            found.append(Reaction(joint, x, y, sp.S.Zero, (x, y)))
    return tuple(found)


def wrench_symbols(linkage: PlanarLinkage) -> tuple[Wrench, ...]:
    """Return names for what the motion of each link takes, in its equations' right-hand sides."""
    return tuple(
        Wrench(*sp.symbols(f"push{n}_x push{n}_y push{n}_moment", real=True))
        for n in linkage.numbers
    )


def balances(linkage: PlanarLinkage) -> list[sp.Expr]:
    """Return three expressions a link, each to vanish: what acts on it less what it takes.

    Moments are about the link's first joint.  With :func:`.planar.inertia_wrench` for the symbols
    of :func:`wrench_symbols` these are Smith (4.4)-(4.6).
    """
    found = []
    for number, push in zip(linkage.numbers, wrench_symbols(linkage), strict=True):
        origin = linkage.body(number).origin
        total = [-part for part in push]
        for reaction in reactions(linkage):
            joint = reaction.joint
            sign = (joint.second == number) - (joint.first == number)
            if sign:
                at = linkage.place_on(joint, number)
                arm = at[0] - origin[0], at[1] - origin[1]
                total[0] += sign * reaction.x
                total[1] += sign * reaction.y
                total[2] += sign * (cross(arm, (reaction.x, reaction.y)) + reaction.couple)
        if number == linkage.driven:
            total[2] += TORQUE
        found += total
    return found


def solve(
    equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], divide: Named | None = None
) -> tuple[Step, ...]:
    """Solve linear equations block by block, the smallest first.

    ``equations``: each to vanish; linear in the unknowns; ``unknowns``: as many; ``divide``:
    determinant of a block to its reciprocal, for example in a name that is already there. Result:
    unknowns in the order of their solution, each by those before it. Raises ``ValueError`` if no
    order exists: the linkage is not statically determinate.
    """
    reciprocal = divide or (lambda determinant: 1 / determinant)
    left = [sp.expand(equation) for equation in equations]
    missing = set(unknowns)
    found: list[tuple[sp.Symbol, sp.Expr]] = []
    while missing:
        block = _smallest_block(left, missing)
        chosen = [u for u in unknowns if u in missing and any(left[i].has(u) for i in block)]
        matrix, right = sp.linear_eq_to_matrix([left[i] for i in block], chosen)
        factor = reciprocal(sp.expand(matrix.det(method="berkowitz")))
        cofactors = matrix.adjugate() * right
        found += [(u, sp.expand(c * factor)) for u, c in zip(chosen, cofactors, strict=True)]
        missing -= set(chosen)
        left = [equation for i, equation in enumerate(left) if i not in block]
    return tuple(found)


def _smallest_block(equations: Sequence[sp.Expr], missing: set[sp.Symbol]) -> tuple[int, ...]:
    held = [frozenset(equation.free_symbols & missing) for equation in equations]
    for size in range(1, len(equations) + 1):
        for block in combinations(range(len(equations)), size):
            if len(frozenset().union(*(held[i] for i in block))) == size and all(
                held[i] for i in block
            ):
                return block
    raise ValueError("the reactions of the joints are not determined by statics")


def unknowns_of(linkage: PlanarLinkage) -> tuple[sp.Symbol, ...]:
    """Return the unknowns of a linkage: those of its joints, then the torque."""
    joints = [symbol for reaction in reactions(linkage) for symbol in reaction.unknowns]
    return (*joints, TORQUE)


def shaking(linkage: PlanarLinkage) -> Wrench:
    """Return force on the frame and moment about the fixed origin by the momenta alone.

    ``-dP/dt`` and ``-dH_A/dt``, as sums over the links of what their motion takes.
    """
    total = [sp.S.Zero] * 3
    for number, push in zip(linkage.numbers, wrench_symbols(linkage), strict=True):
        origin = linkage.body(number).origin
        total[0] -= push.x
        total[1] -= push.y
        total[2] -= push.moment + cross(origin, (push.x, push.y))
    return Wrench(*total)


def virtual_power(linkage: PlanarLinkage, rate: Mapping[sp.Expr, sp.Expr], named: Named) -> sp.Expr:
    """Return the drive's torque by the power that the motion of the links takes.

    No joint force enters: ``torque = sum (d origin / d theta2 . force + w moment)``.

    ``linkage``: the mechanism; ``rate``: time derivative of each coordinate to its derivative by
    the crank angle; ``named``: applied to the coefficients, which are functions of the coordinates.
    """
    total = sp.S.Zero
    for number, push in zip(linkage.numbers, wrench_symbols(linkage), strict=True):
        body = linkage.body(number)
        for part, of in zip(push, (*body.origin, body.angle), strict=True):
            total += part * named(sp.sympify(of).diff(linkage.t).subs(rate))
    return sp.expand(total)
