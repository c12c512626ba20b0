"""The four-bar linkage with play at its joints: how far coupler and follower can turn, exactly.

With the crank held, play at the joints lets the distance that coupler or follower bridges vary by
the sum of the radial clearances.  The follower turns as if the coupler had a length between two
limits (Smith 3.1, 3.2), the coupler as if the follower had.  Both are one problem: in the triangle
on the diagonal BD, the angle between BD and the *turning* link, opposite the other one.
"""

from __future__ import annotations

import sympy as sp

from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..safe import UnsafeRewriting, bernstein_in_cosine
from ..spec import ModelSpec
from ..staged import ClosedForm, Step, Steps
from .four_bar import crank, frame, theta2

turning, opposite = sp.symbols("turning opposite", positive=True)
play = sp.Symbol("play", nonnegative=True)

_ARGUMENTS = (
    Argument("theta2", "ndarray or float, shape (...)", "rad", "Crank angle"),
    Argument("frame", "float", "m", "Length of the fixed link AD"),
    Argument("crank", "float", "m", "Length of the crank AB"),
    Argument("turning", "float", "m", "Length of the link whose range is asked for"),
    Argument("opposite", "float", "m", "Length of the link whose ends have play"),
    Argument("play", "float", "m", "Sum of the radial clearances: half of the diametral ones"),
)
_RESULTS = {
    "angle": "Angle between the diagonal BD and the turning link, without play",
    "opened": "By how much play can open this angle",
    "closed": "By how much play can close this angle",
    "small": "opened and closed together for a small clearance (Smith 3.3); infinite in line",
    "free": "Product of the outer triangles' areas; 0 where play brings the link into line",
}
_NEAR, _FAR, _STRAIGHT, _FOLDED = sp.symbols("near far straight folded", real=True)
_COS_HALF2, _SIN_HALF2, _DIAGONAL2 = sp.symbols("cos_half2 sin_half2 diagonal2", real=True)
_COSINE = sp.Symbol("cosine", real=True)


def cosine_difference() -> sp.Expr:
    """Return ``2 BD turning (cos(angle) - cos(other angle))`` by two lengths of the other side."""
    side, other = sp.symbols("r r_other", positive=True)
    # The closure (Smith 2.1) squared: |BD - turning e|^2 = r^2.
    twice = [_adjacent(length) for length in (side, other)]
    found = sp.factor(sp.expand(twice[0] - twice[1]))
    if found.free_symbols != {side, other}:
        raise UnsafeRewriting(f"{found} is not a matter of the two lengths alone")
    return found


def _adjacent(length: sp.Expr) -> sp.Expr:
    """Return ``2 BD turning cos(angle)`` where the other side has a length."""
    return _DIAGONAL2 + turning**2 - length**2


def _by_differences(extra: sp.Expr) -> sp.Expr:
    """Return the same, longer by ``extra``, the difference of two squares as a product."""
    form = _DIAGONAL2 - (_STRAIGHT + extra) * (_FOLDED + extra)
    back = form.subs({_STRAIGHT: opposite + turning, _FOLDED: opposite - turning})
    if sp.expand(back - _adjacent(opposite + extra)) != 0:
        raise UnsafeRewriting(f"{form} is not the product with the cosine")
    return form


def _sixteenth(extra: sp.Expr) -> sp.Expr:
    """Return ``(2 BD turning sin(angle))^2`` where the other side is longer by ``extra``.

    Sixteen times the square of the triangle's area, of two factors linear in the cosine of the
    crank angle.
    """
    square = sp.expand((frame - crank * _COSINE) ** 2 + crank**2 * (1 - _COSINE**2))
    outer, inner = sp.symbols("outer inner", real=True)
    product = (outer**2 - square) * (square - inner**2)
    side = opposite + extra
    back = product.subs({outer: side + turning, inner: side - turning})
    if sp.expand(back - (4 * square * turning**2 - (square + turning**2 - side**2) ** 2)) != 0:
        raise UnsafeRewriting("the area of the triangle is not that of its sides")
    sums = {frame: (_FAR + _NEAR) / 2, crank: (_FAR - _NEAR) / 2}
    form = bernstein_in_cosine(product, _COSINE, _COS_HALF2, _SIN_HALF2, sums)
    return form.subs({outer: _STRAIGHT + extra, inner: _FOLDED + extra})


def _tangent_of_half() -> None:
    """Prove ``tan((b - a)/2) = (cos a - cos b) / (sin a + sin b)``: no digit cancels in it."""
    a, b = sp.symbols("a b", real=True)
    claim = sp.sin((b - a) / 2) * (sp.sin(a) + sp.sin(b)) - sp.cos((b - a) / 2) * (
        sp.cos(a) - sp.cos(b)
    )
    if sp.expand(sp.expand(claim.rewrite(sp.exp))) != 0:
        raise UnsafeRewriting("the tangent of half a difference of angles")


def _closed_form(spec: ModelSpec) -> ClosedForm:
    _tangent_of_half()
    side, other = sorted(cosine_difference().free_symbols, key=str)
    squares: list[Step] = []
    sines: dict[str, sp.Symbol] = {}
    for name, extra in (("nominal", sp.S.Zero), ("longer", play), ("shorter", -play)):
        square = sp.Symbol(f"square_{name}", real=True)
        sines[name] = sp.Symbol(f"area_{name}", nonnegative=True)
        squares += [
            (square, _sixteenth(extra)),
            # Nothing where the three sides make no triangle.
            (sines[name], sp.sqrt((sp.Abs(square) + square) / 2)),
        ]
    lengths = (opposite, opposite + play, opposite - play)
    extras = (sp.S.Zero, play, -play)
    cosines = dict(zip(sines, map(_by_differences, extras), strict=True))
    angles = {name: sp.atan2(sines[name], cosines[name]) for name in sines}
    outputs = {"angle": angles["nominal"]}
    for output, name, sign, length in (
        ("opened", "longer", 1, lengths[1]),
        ("closed", "shorter", -1, lengths[2]),
    ):
        change = sp.factor(sign * cosine_difference().subs({side: opposite, other: length}))
        free = 2 * sp.atan2(change, sines["nominal"] + sines[name])
        # Where one of the two makes no triangle, its angle is 0 or pi.
        held = sign * (angles[name] - angles["nominal"])
        triangles = sines["nominal"] * sines[name] > 0
        outputs[output] = sp.Piecewise((free, triangles), (held, True))
    slope = cosine_difference().diff(other).subs({side: opposite, other: opposite})
    outputs["small"] = 2 * slope * play / sines["nominal"]
    outputs["free"] = sines["longer"] * sines["shorter"] / 16
    start = (
        (_NEAR, frame - crank),
        (_FAR, frame + crank),
        (_STRAIGHT, opposite + turning),
        (_FOLDED, opposite - turning),
        (_COS_HALF2, sp.cos(theta2 / 2) ** 2),
        (_SIN_HALF2, sp.sin(theta2 / 2) ** 2),
        (_DIAGONAL2, _NEAR**2 * _COS_HALF2 + _FAR**2 * _SIN_HALF2),
    )
    inputs = (theta2, frame, crank, turning, opposite, play)
    closed = ClosedForm(inputs, Steps((*start, *squares)), tuple(outputs.items()))
    return closed.only(spec.outputs or outputs)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Range that play at its joints gives the four-bar linkage, in closed form",
        references=("Smith (3.1)-(3.3)",),
        arguments=_ARGUMENTS,
        kernel="extremes",
        summary="Return the angle of a link from the diagonal BD, and how far play turns it",
        results={
            name: Result(name, "ndarray, shape (...)", "m^4" if name == "free" else "rad", meaning)
            for name, meaning in _RESULTS.items()
        },
        notes=(
            "For the follower, ``turning`` is the follower and ``opposite`` the coupler; for the "
            "coupler the other way round.",
            "An angle that play brings to 0 or pi stays there: the link lies along the diagonal, "
            "and may go on to the other assembly.",
        ),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=("clearance",),
    energies=_closed_form,
    describe=_describe,
)
