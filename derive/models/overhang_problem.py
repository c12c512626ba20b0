"""The boundary value problem of a beam pinned at one end and at a support, free at the other.

The general solution of ``e'''' = beta^4 e`` on both sides of the support and the conditions (3),
(4) of Beale & Scott give the shapes, and with them the characteristic equation: slope and moment
at the support agree from both sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import sympy as sp
from sympy.codegen.cfunctions import expm1

from ..safe import UnsafeRewriting
from .overhang_waves import CLOSE, HANG, REST, RISE, RUN, SINK, SPAN, SWITCH, Wave, proven

ORDERS = range(4)
_WAVES = (sp.sin, sp.cos, sp.sinh, sp.cosh)
# cosh y - sinh y -+ (cos y - sin y) where it is small with y, and its derivative.
LEAN, LEAN_SLOPE = sp.symbols("lean lean_slope", real=True)


@dataclass(frozen=True)
class Bay:
    """The shape between two supports but for a factor, stable.

    Attributes
    ----------
    shape : tuple of Expr
        Shape and three derivatives by the phase of the point.
    moved : tuple of Expr
        The same of its derivative by the phase of the support.
    """

    shape: tuple[sp.Expr, ...]
    moved: tuple[sp.Expr, ...]


@lru_cache(maxsize=2)
def plain_shape(free: bool) -> sp.Expr:
    """Return the shape of a bay as the boundary value problem has it, zero at the support.

    Parameters
    ----------
    free : bool
        True for the bay beyond the support, with neither moment nor shear force at its tip; False
        for the one between pin and support, at rest and without moment at the pin.  The first is
        without a divisor, for it has to remain when the bay shrinks to nothing; the factor of the
        sine in the second is 1.
    """
    point, support = (REST, HANG) if free else (RUN, SPAN)
    v = point.phase
    factors = dict(zip(_WAVES, sp.symbols("c1:5"), strict=True))
    shape = sp.Add(*(factor * wave(v) for wave, factor in factors.items()))
    conditions = [sp.diff(shape, v, k).subs(v, 0) for k in ((2, 3) if free else (0, 2))]
    conditions.append(shape.subs(v, support.phase))
    given = factors[sp.cos] if free else factors[sp.sin]
    unknowns = [factor for factor in factors.values() if factor is not given]
    (values,) = sp.linsolve(conditions, *unknowns)
    found = shape.subs(dict(zip(unknowns, values, strict=True))).subs(given, 1)
    return sp.expand(sp.fraction(sp.together(found))[0] if free else found)


@lru_cache(maxsize=1)
def before() -> Bay:
    """Return the bay between pin and support."""
    plain, a, x = plain_shape(False), SPAN.phase, RUN.phase
    shape = []
    for order in ORDERS:
        derived = sp.diff(plain, x, order)
        # Value and slope are small differences where both phases are small.
        write = Wave.by_excess if order < 2 else Wave.by_size
        above = write(RUN, write(SPAN, sp.expand(derived * sp.sinh(a))))
        above = _over(above, SPAN, RUN, RISE)
        shape.append(proven(above / SPAN.odd, derived))
    ratio = plain.coeff(sp.sinh(x))
    slope = SPAN.reduced(sp.diff(ratio, a) * sp.sinh(a) ** 2)
    moved = []
    for order in ORDERS:
        steep = _over(RUN.by_size(sp.diff(sp.sinh(x), x, order)), SPAN, RUN, RISE)
        form = scaled(slope, SPAN, True) / SPAN.odd * steep / SPAN.odd
        moved.append(proven(form, sp.diff(plain, a, 1, x, order)))
    return Bay(tuple(shape), tuple(moved))


@lru_cache(maxsize=1)
def beyond() -> Bay:
    """Return the bay beyond the support, over ``exp(beta (1 - xi)) / 2``."""
    plain, b, y = plain_shape(True), HANG.phase, REST.phase
    lean = {2: LEAN, 3: LEAN_SLOPE}
    shape, moved = [], []
    for order in ORDERS:
        derived = sp.diff(plain, y, order)
        # sinh b = cosh b - exp(-b): the growing parts stand together.
        split = sp.expand(derived.subs(sp.sinh(b), sp.cosh(b) - HANG.fade))
        grown = split.coeff(sp.cosh(b))
        rest = sp.expand(split - grown * sp.cosh(b))
        small = _over(REST.by_excess(HANG.circular(rest)), HANG, REST, SINK)
        known = sp.expand(REST.elementary(grown))
        form = HANG.even * lean.get(order, known) + small
        proven(form.subs(lean.get(order, known), known), 2 * HANG.fade * derived)
        shape.append(form)
        change = sp.diff(plain, b, 1, y, order) - derived  # also of the factor 2 exp(-b)
        rest = sp.expand(change.subs(sp.sinh(b), sp.cosh(b) - HANG.fade))
        form = _over(REST.by_excess(HANG.circular(rest)), HANG, REST, SINK)
        moved.append(proven(form, 2 * HANG.fade * change))
    return Bay(tuple(shape), tuple(moved))


@lru_cache(maxsize=1)
def beyond_from_support() -> sp.Expr:
    """Return the shape beyond the support by slope, moment and shear force there.

    For a point close to the support, where the other form is a difference.
    """
    plain, b, y, z = plain_shape(True), HANG.phase, REST.phase, CLOSE.phase
    moved = HANG.reduced(sp.expand(sp.expand_trig(plain.subs(y, b - z))))
    starts = [HANG.reduced((-1) ** k * sp.diff(plain, y, k).subs(y, b)) for k in ORDERS]
    # Solutions of y^(4) = y that start with one derivative 2 and the others 0.
    swing, turn, rise, grow = sp.sin(z), sp.cos(z), sp.sinh(z), sp.cosh(z)
    units = (swing + rise, grow - turn, rise - swing)
    form = sp.Add(*(start * unit / 2 for start, unit in zip(starts[1:], units, strict=True)))
    if starts[0] != 0 or CLOSE.reduced(HANG.reduced(sp.expand(form - moved))) != 0:
        raise UnsafeRewriting(f"{form} is not the shape beyond the support")
    return sp.Add(
        *(
            scaled(start, HANG, k == 1) * CLOSE.by_excess(unit) / 2
            for k, (start, unit) in enumerate(zip(starts[1:], units, strict=True))
        )
    )


def _over(expression: sp.Expr, support: Wave, point: Wave, between: sp.Symbol) -> sp.Expr:
    """Return ``2 exp(-support)`` times an expression that has ``exp(-point)`` as divisor."""
    found = sp.expand(2 * support.fade * expression)
    found = sp.expand(found.subs(support.fade, between * point.fade))
    return found.subs(between * point.fade, support.fade)


def scaled(expression: sp.Expr, wave: Wave, excess: bool = False) -> sp.Expr:
    """Return ``2 exp(-v)`` times a function of one phase that is linear in sinh v and cosh v.

    Parameters
    ----------
    expression : Expr
        The function.
    wave : Wave
        The phase.
    excess : bool
        True where it is a small difference at small phases.
    """
    write = wave.by_excess if excess else wave.by_size
    reduced = wave.reduced(expression)
    return proven(sp.expand(2 * wave.fade * write(reduced)), 2 * wave.fade * reduced)


def lean_steps() -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Return the definitions of what remains of the growing parts, small near the tip."""
    y, f = REST.phase, REST.fade
    direct = f - REST.cosine + REST.sine
    close = proven((REST.spread - REST.excess) / (2 * f), direct)
    return (
        (LEAN, sp.Piecewise((direct, y > SWITCH), (close, True))),
        (LEAN_SLOPE, -expm1(-y) + REST.sine - 2 * sp.sin(y / 2) ** 2),
    )
