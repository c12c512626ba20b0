"""Quick-return mechanism with a flexible rod in Buckens' frame: constrained equations of motion.

The rod floats: its mean position R, its mean direction gamma and the amplitudes of its elastic
free-free modes are coordinates, the pin and the block are constraints.  Kinetic energy follows
from the position of a material point; the second-order foreshortening, which brings in the
centrifugal tension, is a term that a spec may leave out.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import sympy as sp

from ..describe import Description
from ..entries import ConstrainedSystem
from ..ir import Argument
from ..lagrange import variational_equations
from ..pipeline import Model
from ..projection.greens_identity import integral, primitive
from ..records import EquationsOfMotion, Lagrangian
from ..spec import Choices, ModelSpec
from ..staged import Steps
from . import free_free_modes as ff
from .block_sums import with_block_sums

TENSION = "tension"
_DIGITS = 40
_T = sp.Symbol("t", real=True)
_LENGTH, _MASS, _STIFFNESS = sp.symbols("length mass_per_length bending_stiffness", positive=True)
_CRANK, _FRAME, _SPEED = sp.symbols("crank frame speed", positive=True)
_R1, _R2, _GAMMA = (sp.Function(name)(_T) for name in ("R1", "R2", "gamma"))
_THETA = sp.Function("theta")(_T)
_S = ff.MIDDLE
_ENDS = (-ff.HALF, ff.HALF)
_ALONG = sp.Matrix([sp.cos(_GAMMA), sp.sin(_GAMMA)])
_ACROSS = sp.Matrix([-sp.sin(_GAMMA), sp.cos(_GAMMA)])


def amplitudes(modes: int) -> tuple[sp.Expr, ...]:
    """Return the coordinates of the modes, functions of time."""
    return tuple(sp.Function(f"f{i}")(_T) for i in range(1, modes + 1))


@lru_cache(maxsize=16)
def root(mode: int) -> sp.Float:
    """Return the root of a mode (1, 2, ...), from the characteristic function."""
    start = ((mode + sp.Rational(1, 2)) * sp.pi).evalf(_DIGITS)
    stable = ff.characteristic()
    (b,) = stable.free_symbols
    return sp.Float(sp.nsolve(stable, b, start, prec=_DIGITS + 10), _DIGITS + 5)


def parity(mode: int) -> int:
    """Return 1 for a mode that is even about the middle, -1 for an odd one."""
    return 1 if mode % 2 else -1


@lru_cache(maxsize=64)
def slope_integral(power: int, i: int, j: int) -> sp.Expr:
    """Return ``int s^power psi_i' psi_j' ds`` as a number; 0 exactly where the parities say so."""
    values = {
        ff.PARITY: sp.Integer(parity(i)),
        ff.OTHER_PARITY: sp.Integer(parity(j)),
    }
    form = ff.slope_integral(power, i == j).subs(values)
    if form == 0:  # no term at all
        return sp.S.Zero
    ends = {
        ff.SLOPE: ff.end_slope(ff.ROOT, sp.Integer(parity(i))),
        ff.OTHER_SLOPE: ff.end_slope(ff.OTHER, sp.Integer(parity(j))),
    }
    value = form.subs(ends).subs({ff.ROOT: root(i), ff.OTHER: root(j)})
    return sp.Float(value.evalf(_DIGITS + 5), _DIGITS)


@lru_cache(maxsize=1)
def shortening() -> tuple[sp.Expr, sp.Expr]:
    """Return ``int s alpha ds`` and ``alpha(-1/2)`` for ``alpha' = -w / 2`` and no mean.

    In the integrals ``w_0, w_1, w_2`` of w against 1, s and s^2.  By parts, ``int alpha = [s alpha]
    - int s alpha' = 0`` gives the mean of the end values, ``int alpha'`` their difference.
    """
    left, right = sp.symbols("left right")
    rate = [-ff.HALF * sp.Symbol(f"w_{power}") for power in range(3)]
    by_parts = _ENDS[1] * right - _ENDS[0] * left - rate[1]
    (ends,) = sp.linsolve([right - left - rate[0], by_parts], left, right)
    first = (_ENDS[1] ** 2 * ends[1] - _ENDS[0] ** 2 * ends[0] - rate[2]) / 2
    return sp.expand(first), sp.expand(ends[0])


@lru_cache(maxsize=64)
def _shortening_number(which: int, i: int, j: int) -> sp.Expr:
    values = {sp.Symbol(f"w_{power}"): slope_integral(power, i, j) for power in range(3)}
    return shortening()[which].subs(values).evalf(_DIGITS)


class Moments:
    """What integrals along the rod are made of: moments of the modes and of the foreshortening.

    The displacement is ``L sum f_i psi_i``, the foreshortening ``L sum f_i f_j alpha_ij`` with
    ``alpha_ij' = -psi_i' psi_j' / 2`` and no mean: R stays the mean position.
    """

    def __init__(self, modes: int, tension: bool) -> None:
        """Choose the number of modes and whether the rod shortens."""
        self.f = amplitudes(modes)
        self.tension = tension

    def of_modes(self, weight: sp.Expr) -> sp.Expr:
        """Return ``int weight sum f_i psi_i ds`` for a polynomial weight of degree 0 or 1."""
        b4 = sp.Symbol("b4", positive=True)
        form = primitive(weight, _S, (0,), (b4,))
        return integral(form, _S, _ENDS, _free_end) * sp.Add(*self.f)

    def of_products(self, left: tuple[sp.Expr, ...], right: tuple[sp.Expr, ...]) -> sp.Expr:
        """Return ``int sum l_i psi_i sum r_j psi_j ds``."""
        if _mixed_square() != 0:
            raise ArithmeticError(f"modes are not orthogonal: {_mixed_square()}")
        return sp.Add(*(a * b for a, b in zip(left, right, strict=True)))

    def bending(self) -> sp.Expr:
        """Return the integral of the squared curvature: by parts twice, of psi_i and psi_j'''' ."""
        scaled = tuple(sp.Symbol(f"stiffness_{i}") * f for i, f in enumerate(self.f, start=1))
        return self.of_products(self.f, scaled)

    def shortened(self, which: int) -> sp.Expr:
        """Return ``int s alpha ds`` (0) or alpha at the left end (1), summed over the modes."""
        return sp.Add(
            *(
                (1 if i == j else 2) * name * self.f[i - 1] * self.f[j - 1]
                for (i, j), name in self._pairs(which)
            )
        )

    def _pairs(self, which: int) -> list[tuple[tuple[int, int], sp.Symbol]]:
        """Return which products of amplitudes shorten the rod, with the names of their factors."""
        if not self.tension:
            return []
        word = ("inward", "retreat")[which]
        indices = range(1, len(self.f) + 1)
        return [
            ((i, j), sp.Symbol(f"{word}_{i}_{j}"))
            for i in indices
            for j in indices
            if i <= j and _shortening_number(which, i, j) != 0
        ]

    def numbers(self) -> Steps:
        """Return the numbers that the names stand for."""
        steps = [(sp.Symbol(f"stiffness_{i}"), root(i) ** 4) for i in range(1, len(self.f) + 1)]
        steps += [
            (name, _shortening_number(which, *pair))
            for which in (0, 1)
            for pair, name in self._pairs(which)
        ]
        return Steps(tuple(steps))


@lru_cache(maxsize=1)
def _mixed_square() -> sp.Expr:
    """Return ``int psi_i psi_j ds`` of two different modes."""
    constants = sp.symbols("b4 c4", positive=True)
    form = primitive(sp.S.One, _S, (0, 0), constants)
    return sp.simplify(integral(form, _S, _ENDS, _free_end))


def _free_end(mode: int, order: int, end: sp.Expr) -> sp.Expr:
    """Return derivatives of a mode at an end, whatever they are where they need not vanish."""
    return sp.Symbol(f"end_{mode}_{order}_{end > 0}") if order < 2 else sp.S.Zero


def kinetic_energy(moments: Moments) -> sp.Expr:
    """Return the kinetic energy to second order in the amplitudes, Beale & Scott (32)-(37).

    Squared velocity of ``r = R + (x + a) f1 + u f2``, in fields, then integrated term by term.
    """
    u, a = (sp.Function(name)(_S, _T) for name in ("u", "a"))
    small = sp.Symbol("small")
    place = sp.Matrix([_R1, _R2])
    place += _LENGTH * ((_S + small**2 * a) * _ALONG + small * u * _ACROSS)
    velocity = place.diff(_T)
    squared = sp.expand(velocity.dot(velocity))
    squared = _on_circle(sum(squared.coeff(small, order) for order in range(3)))
    total = sum(_integrated(term, u, a, moments) for term in sp.Add.make_args(squared))
    return sp.expand(_MASS * _LENGTH / 2 * total)


def _on_circle(expression: sp.Expr) -> sp.Expr:
    """Return an expanded polynomial in cos and sin of gamma with at most one sine in a product."""
    cosine, sine = sp.cos(_GAMMA), sp.sin(_GAMMA)
    return sp.expand(sp.expand(expression).subs(sine**2, 1 - cosine**2))


def _integrated(term: sp.Expr, u: sp.Expr, a: sp.Expr, moments: Moments) -> sp.Expr:
    """Return the integral over s of one product of s, u, a, their rates, and functions of time."""
    fields = (u, u.diff(_T), a, a.diff(_T))
    factor, parts = term.as_independent(_S, *fields, as_Add=False)
    powers = parts.as_powers_dict()
    weight = _S ** powers.pop(_S, 0)
    found = [item for item, power in powers.items() if item != 1 for _ in range(int(power))]
    rates = tuple(f.diff(_T) for f in moments.f)
    if not found:
        return factor * sp.integrate(weight, (_S, *_ENDS))
    if set(found) <= set(fields[:2]):
        sums = [moments.f if item == u else rates for item in found]
        if len(sums) == 1:
            value = moments.of_modes(weight)
            return factor * (value if found[0] == u else value.diff(_T))
        if weight == 1:
            return factor * moments.of_products(*sums)
    if found == [a] or found == [fields[3]]:
        first = {0: sp.S.Zero, 1: moments.shortened(0)}[sp.degree(weight, _S)]
        return factor * (first if found == [a] else first.diff(_T))
    raise ValueError(f"no moment for {term}")


def place_of_block() -> sp.Expr:
    """Return the distance of the block from the pin along f1: the first part of the loop (44)."""
    return _CRANK * sp.cos(_GAMMA - _THETA) + _FRAME * sp.cos(_GAMMA)


def constraints(moments: Moments) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Return the pin's two conditions and the block's, Beale & Scott (41)-(45)."""
    centre = sp.Matrix([_R1, _R2])
    left = moments.shortened(1)

    def deflection(value: Callable[[int], sp.Expr]) -> sp.Expr:
        return sp.Add(*(f * value(i) for i, f in enumerate(moments.f, start=1)))

    pinned = deflection(lambda i: parity(i) * ff.end_value())
    pin = centre + _LENGTH * ((-ff.HALF + left) * _ALONG + pinned * _ACROSS)
    place = place_of_block() / _LENGTH
    held = deflection(lambda i: sp.Function(f"psi_{i}")(place))
    turn = sp.Symbol("turn")  # gamma - theta
    crank = [sp.expand_trig(f(_GAMMA - turn)) for f in (sp.cos, sp.sin)]
    block = sp.Matrix([_CRANK * crank[0] + _FRAME, _CRANK * crank[1]])
    gap = centre + _LENGTH * held * _ACROSS - block
    conditions = (pin.dot(_ALONG), pin.dot(_ACROSS), gap.dot(_ACROSS))
    first, second, third = (_on_circle(c).subs(turn, _GAMMA - _THETA) for c in conditions)
    return first, second, third


def _energies(spec: ModelSpec) -> Lagrangian:
    if spec.modes is None:
        raise ValueError("modes: found None; expected a whole number from 1")
    moments = Moments(spec.modes, TENSION not in spec.drop)
    bending = _STIFFNESS / (2 * _LENGTH) * moments.bending()
    return Lagrangian(
        coordinates=(_R1, _R2, _GAMMA, *moments.f),
        t=_T,
        expression=kinetic_energy(moments) - bending,
        constraints=constraints(moments),
        prescribed={_THETA: _SPEED * _T},
    )


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    modes = spec.modes or 0
    numbers = Moments(modes, TENSION not in spec.drop).numbers()
    return with_block_sums(equations, variational_equations(equations), numbers, modes)


def _describe(spec: ModelSpec) -> Description:
    shape = "float or ndarray, shape (...)"
    count = spec.modes or 0
    arguments = [
        Argument("R1", shape, "m", "Mean position of the rod along the frame"),
        Argument("R2", shape, "m", "Mean position of the rod across the frame"),
        Argument("gamma", shape, "rad", "Mean direction of the rod"),
        Argument("t", shape, "s", "Time; the crank angle is speed t"),
    ]
    words = {"": "psi", "_d1": "psi'", "_d2": "psi''", "_d3": "psi'''"}
    for i in range(1, count + 1):
        arguments.append(Argument(f"f{i}", shape, "", f"Amplitude of mode {i}, in lengths"))
        arguments += [
            Argument(f"psi_{i}{end}", shape, "", f"{word} of mode {i} at the block")
            for end, word in words.items()
        ]
    return Description(
        title=f"Quick-return mechanism, flexible rod in Buckens' frame, {count} free-free modes",
        references=tuple(f"Beale & Scott ({r})" for r in ("29)-(33", "37)-(38", "40)-(49")),
        arguments=tuple(arguments),
        parameters=tuple(
            Argument(name, "float or ndarray", unit, meaning)
            for name, unit, meaning in (
                ("crank", "m", "Length of the crank"),
                ("frame", "m", "Distance from the pin to the centre of the crank"),
                ("length", "m", "Length of the rod"),
                ("bending_stiffness", "N m^2", "Bending stiffness of the rod"),
                ("mass_per_length", "kg/m", "Mass per length of the rod"),
                ("speed", "rad/s", "Speed of the crank"),
            )
        ),
        notes=(
            "The displacement across the mean direction is L sum f_i psi_i, with modes of unit "
            "square over unit length; they are passed in at the place of the block, "
            "(crank cos(gamma - speed t) + frame cos(gamma)) / length from the pin.",
            "Multipliers: force of the pin along and across the rod, force of the block, up to "
            "the signs that the constraints give them.",
        ),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("free_free",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
    choices=Choices(flexible=("rod",), drop=(TENSION,)),
)
