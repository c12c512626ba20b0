"""The rigid four-bar linkage: joint forces, torque, force and moment on the frame.

Forces need components of the links and derivatives by the crank angle, but no angle.  Written for
the vectors AB, BC and DC instead of their directions, the loop closure takes a third fewer
operations on arrays than the kinematics module and no inverse function.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache

import sympy as sp

from ..ir import Description
from ..pipeline import Model
from ..rigid.forces import CHOICES, SolvedMotion, description, forces, moments_of
from ..rigid.multibody import multibody_model
from ..rigid.planar import Body, Pin, PlanarLinkage, Vector, cross
from ..safe import UnsafeRewriting, bernstein_in_cosine, solve_cosine_sine
from ..spec import ModelSpec
from ..staged import KernelForms, Step, Steps
from .four_bar import ARGUMENTS, assembly, coupler, crank, follower, frame, theta2


@dataclass(frozen=True)
class LinkVectors:
    """The solved linkage: its symbols, and the steps that define them.

    Attributes
    ----------
    steps : Steps
        Definitions, in order.
    near, far, straight, folded : Symbol
        ``l1 - l2``, ``l1 + l2``, ``l3 + l4`` and ``l3 - l4``.
    half_tangent, cosine_squared, sine_squared, half_sine2 : Symbol
        Tangent, squared cosine and squared sine of half the crank angle; half the sine of all.
    rise, travel : Symbol
        ``l2 (1 - cos theta2)`` and ``l1`` times that.
    crank_x, crank_y, coupler_x, coupler_y, follower_x, follower_y : Symbol
        Components of AB, BC and DC.
    base_x : Symbol
        x component of BD; the other is ``-crank_y``.
    diagonal, p, q : Symbol
        ``BD^2 / 2``, and the scalar products of BD with BC and with CD.
    stretch, fold : Symbol
        ``((l3 + l4)^2 - BD^2) / 2`` and ``(BD^2 - (l3 - l4)^2) / 2``.
    area, inverse : Symbol
        ``BC x DC``, twice the area of BCD with the sign of the assembly; the reciprocal of
        ``DC x BC``.
    per_x, per_y : Symbol
        ``BD / BD^2``.
    lean : Symbol
        ``l1`` over the area.
    slip3, slip4, spread : Symbol
        ``1 - w3``, ``1 - w4`` and ``w4 - w3``, without cancellation.
    w3, w4, a3, a4 : Symbol
        First and second derivatives of the angles by the crank angle.
    dot : Symbol
        ``BC . CD``.
    pace : Symbol
        Logarithmic derivative of the area.
    facing : Symbol
        ``AB . BC``.
    """

    steps: Steps
    near: sp.Symbol
    far: sp.Symbol
    straight: sp.Symbol
    folded: sp.Symbol
    half_tangent: sp.Symbol
    cosine_squared: sp.Symbol
    sine_squared: sp.Symbol
    half_sine2: sp.Symbol
    rise: sp.Symbol
    travel: sp.Symbol
    crank_x: sp.Symbol
    crank_y: sp.Symbol
    coupler_x: sp.Symbol
    coupler_y: sp.Symbol
    follower_x: sp.Symbol
    follower_y: sp.Symbol
    base_x: sp.Symbol
    diagonal: sp.Symbol
    p: sp.Symbol
    q: sp.Symbol
    dot: sp.Symbol
    stretch: sp.Symbol
    fold: sp.Symbol
    area: sp.Symbol
    inverse: sp.Symbol
    per_x: sp.Symbol
    per_y: sp.Symbol
    lean: sp.Symbol
    slip3: sp.Symbol
    slip4: sp.Symbol
    spread: sp.Symbol
    w3: sp.Symbol
    w4: sp.Symbol
    a3: sp.Symbol
    a4: sp.Symbol
    pace: sp.Symbol
    facing: sp.Symbol

    @property
    def crank(self) -> Vector:
        """The vector AB."""
        return self.crank_x, self.crank_y

    @property
    def coupler(self) -> Vector:
        """The vector BC."""
        return self.coupler_x, self.coupler_y

    @property
    def follower(self) -> Vector:
        """The vector DC."""
        return self.follower_x, self.follower_y

    @property
    def products(self) -> dict[sp.Expr, sp.Expr]:
        """Products of components by the vector products that the steps hold already."""
        return {
            self.coupler_x * self.follower_y: self.area + self.coupler_y * self.follower_x,
            # AB x BC: what the closure says of the follower's speed.
            self.coupler_x * self.crank_x: self.facing - self.coupler_y * self.crank_y,
            self.coupler_y * self.crank_x: self.coupler_x * self.crank_y - self.area * self.w4,
            self.follower_y * self.crank_x: self.follower_x * self.crank_y - self.area * self.w3,
        }


@cache
def link_vectors() -> LinkVectors:
    """Solve the loop closure AB + BC = AD + DC (Smith 2.1), and differentiate it twice.

    Result: squares are sums of like-signed terms for every crank that turns fully.
    """
    names = [item.name for item in fields(LinkVectors) if item.name != "steps"]
    made = {name: sp.Symbol(name, real=True) for name in names}
    v = LinkVectors(Steps(), **made)
    start = (
        (v.near, frame - crank),
        (v.far, frame + crank),
        (v.straight, coupler + follower),
        (v.folded, coupler - follower),
        # One tangent takes less time than a sine and a cosine, and loses no digit of either.
        (v.half_tangent, sp.tan(theta2 / 2)),
        (v.cosine_squared, 1 / (1 + v.half_tangent**2)),
        (v.half_sine2, v.half_tangent * v.cosine_squared),
        (v.sine_squared, v.half_tangent * v.half_sine2),
        (v.rise, 2 * crank * v.sine_squared),
        (v.travel, frame * v.rise),
        (v.crank_x, crank - v.rise),
        (v.crank_y, 2 * crank * v.half_sine2),
    )
    steps = Steps((*start, *_positions(v), *_rates(v)))
    return LinkVectors(steps, **made)


def _positions(v: LinkVectors) -> tuple[Step, ...]:
    """Return the vectors BC and DC, from the triangle BCD."""
    cosine = sp.Symbol("cosine", real=True)
    sums = {
        frame: (v.far + v.near) / 2,
        crank: (v.far - v.near) / 2,
        coupler: (v.straight + v.folded) / 2,
        follower: (v.straight - v.folded) / 2,
    }
    diagonal = sp.expand((frame - crank * cosine) ** 2 + crank**2 * (1 - cosine**2)) / 2
    stretch = sp.expand((coupler + follower) ** 2 / 2 - diagonal)
    fold = sp.expand(diagonal - (coupler - follower) ** 2 / 2)
    excess = (coupler**2 - follower**2) / 2
    p, q = sp.expand(diagonal + excess), sp.expand(diagonal - excess)
    if sp.expand(2 * coupler**2 * diagonal - p**2 - stretch * fold) != 0:
        raise UnsafeRewriting("the area of the triangle BCD is not that of its sides")

    def by_travel(value: sp.Expr) -> sp.Expr:
        """Write what is linear in the cosine by its value at 0 and the travel from there."""
        slope = sp.cancel(-value.coeff(cosine, 1) / (frame * crank))
        return sp.factor(value.subs(cosine, 1).subs(sums)) + slope * v.travel

    base: Vector = sp.symbols("base_x base_y", real=True)
    vectors = []
    for product, length in ((v.p, coupler), (-v.q, follower)):
        solved = solve_cosine_sine(base[0], base[1], product / length, v.area / length)
        for part in solved[:2]:
            above = sp.expand(sp.cancel(part * length * (base[0] ** 2 + base[1] ** 2)))
            vectors.append(above.subs(dict(zip(base, (v.per_x, -v.per_y), strict=True))))
    squares = v.cosine_squared, v.sine_squared
    return (
        (v.base_x, v.near + v.rise),
        (v.diagonal, by_travel(diagonal)),
        (v.p, by_travel(p)),
        (v.q, by_travel(q)),
        (v.stretch, bernstein_in_cosine(2 * stretch, cosine, *squares, sums) / 2),
        (v.fold, by_travel(fold)),
        (v.area, assembly * sp.sqrt(v.stretch * v.fold)),
        (v.inverse, -1 / v.area),
        (v.per_x, v.base_x / (2 * v.diagonal)),
        (v.per_y, v.crank_y / (2 * v.diagonal)),
        *zip((*v.coupler, *v.follower), vectors, strict=True),
        # BC . CD, by the law of cosines: BD^2 = l3^2 + l4^2 + 2 BC . CD.
        (v.dot, by_travel(sp.expand(diagonal - (coupler**2 + follower**2) / 2))),
    )


def _turned(a: Vector) -> Vector:
    return -a[1], a[0]


def _rates(v: LinkVectors) -> tuple[Step, ...]:
    """Differentiate the loop closure twice by the crank angle and solve for the derivatives.

    Seen from the crank, the frame turns backward: ``1 - w`` follows as a product with the frame,
    ``w`` as one with the crank, so that neither loses digits where one of the two is short.
    """
    found: dict[sp.Symbol, sp.Expr] = {}
    for unknowns, known in (
        ((v.w3, v.w4), v.crank),
        ((-v.slip3, -v.slip4), (frame, sp.S.Zero)),
    ):
        rows = [
            k + unknowns[0] * c - unknowns[1] * f
            for k, c, f in zip(*map(_turned, (known, v.coupler, v.follower)), strict=True)
        ]
        names = [u if u.is_Symbol else -u for u in unknowns]
        matrix, right = sp.linear_eq_to_matrix(rows, names)
        below = sp.expand(matrix.det()).subs(
            v.coupler_x * v.follower_y, v.area + v.coupler_y * v.follower_x
        )
        below = sp.expand(below)
        above = matrix.adjugate() * right
        for name, value in zip(names, above, strict=True):
            found[name] = sp.expand(-sp.cancel(sp.expand(value) / below * v.area)) * v.inverse
    slips = {name: found[name].subs(v.inverse, -v.lean / frame) for name in (v.slip3, v.slip4)}
    gap = sp.expand(slips[v.slip3] - slips[v.slip4])
    spread = sp.factor(gap.subs(v.follower_y, v.crank_y + v.coupler_y))
    return (
        (v.lean, -frame * v.inverse),
        (v.slip3, slips[v.slip3]),
        (v.slip4, slips[v.slip4]),
        (v.spread, spread),
        (v.w3, found[v.w3]),
        (v.w4, v.w3 + v.spread),
        (v.pace, v.inverse * v.spread * v.dot),
        (v.facing, v.coupler_x * v.crank_x + v.coupler_y * v.crank_y),
        *_accelerations(v, slips[v.slip3]),
    )


def _accelerations(v: LinkVectors, slip3: sp.Expr) -> tuple[Step, ...]:
    """Differentiate the slip of the coupler, and the follower's speed times the area.

    Where C comes near A, ``1 - w3`` and ``w4`` are small, and so are both terms of either
    derivative; that of ``1 - w4`` would be the difference of two large ones.
    """
    changes = {
        v.crank_x: -v.crank_y,
        v.crank_y: v.crank_x,
        v.coupler_x: -v.w3 * v.coupler_y,
        v.coupler_y: v.w3 * v.coupler_x,
        v.follower_x: -v.w4 * v.follower_y,
        v.follower_y: v.w4 * v.follower_x,
        v.lean: -v.lean * v.pace,
    }

    def slope(value: sp.Expr) -> sp.Expr:
        return sp.expand(sum(sp.diff(value, name) * change for name, change in changes.items()))

    # The area BC x DC grows with the angle between the two.
    dot = sum(a * b for a, b in zip(v.coupler, v.follower, strict=True))
    if sp.expand(slope(cross(v.coupler, v.follower)) - (v.w4 - v.w3) * dot) != 0:
        raise UnsafeRewriting("the area does not grow with the angle at C")
    # The area times w4 is BC x AB, which grows with the angle at B.
    facing = sum(a * b for a, b in zip(v.coupler, v.crank, strict=True))
    if sp.expand(slope(cross(v.coupler, v.crank)) - (1 - v.w3) * facing) != 0:
        raise UnsafeRewriting("the area ABC does not grow with the angle at B")
    return (
        (v.a3, (-slope(slip3)).subs(slip3, v.slip3)),
        (v.a4, -v.inverse * v.slip3 * v.facing - v.pace * v.w4),
    )


t = sp.Symbol("t", real=True)
th2, th3, th4 = (sp.Function(name)(t) for name in ("th2", "th3", "th4"))
_ZERO = (sp.S.Zero, sp.S.Zero)


def linkage(spec: ModelSpec) -> PlanarLinkage:
    """Return bodies, joints and drive of the linkage ABCD (Smith Fig. 11)."""
    pin = crank * sp.cos(th2), crank * sp.sin(th2)
    pivot = frame, sp.S.Zero
    return PlanarLinkage(
        t,
        (
            Body("crank", th2, _ZERO, moments_of(2, spec)),
            Body("coupler", th3, pin, moments_of(3, spec)),
            Body("follower", th4, pivot, moments_of(4, spec)),
        ),
        (
            Pin(1, 2, _ZERO, _ZERO),
            Pin(2, 3, (crank, sp.S.Zero), _ZERO),
            Pin(3, 4, (coupler, sp.S.Zero), (follower, sp.S.Zero)),
            Pin(4, 1, _ZERO, pivot),
        ),
    )


def motion() -> SolvedMotion:
    """Return the kinematics as the forces use them."""
    v = link_vectors()
    return SolvedMotion(
        geometry=ARGUMENTS[1:],
        steps=v.steps,
        theta2=theta2,
        names={
            sp.cos(th2): v.crank_x / crank,
            sp.sin(th2): v.crank_y / crank,
            sp.cos(th3): v.coupler_x / coupler,
            sp.sin(th3): v.coupler_y / coupler,
            sp.cos(th4): v.follower_x / follower,
            sp.sin(th4): v.follower_y / follower,
        },
        rates={th2: (sp.S.One, sp.S.Zero), th3: (v.w3, v.a3), th4: (v.w4, v.a4)},
        differences=v.products,
        reciprocals={v.area: -v.inverse},
        groups=(v.area, v.facing),
        slips={v.w3: v.slip3, v.w4: v.slip4},
    )


def _forces(spec: ModelSpec) -> KernelForms:
    return forces(spec, linkage(spec), motion())


def _describe(spec: ModelSpec) -> Description:
    return description(
        spec,
        "the rigid four-bar linkage",
        ARGUMENTS[0],
        ARGUMENTS[1:],
        ("Smith (4.1)-(4.13)",),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=("forces",),
    energies=_forces,
    describe=_describe,
    choices=CHOICES,
)
MULTIBODY = multibody_model("four_bar", "the rigid four-bar linkage", linkage, ARGUMENTS[1:-1])
