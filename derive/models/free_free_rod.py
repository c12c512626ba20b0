"""Quick-return mechanism with a flexible rod in Buckens' frame: constrained equations of motion.

The rod floats: its mean position R, its mean direction gamma and the amplitudes of its elastic
free-free modes are coordinates, the pin and the block are constraints.  Kinetic energy follows
from the position of a material point; the second-order foreshortening, which brings in the
centrifugal tension, is a term that a spec may leave out.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..entries import ConstrainedSystem
from ..ir import Argument, Description
from ..lagrange import euler_lagrange, variational_equations
from ..modal import COUNTED_MODES, EACH_MODE, Modes, closed_in_modes
from ..pipeline import Model
from ..projection.greens_identity import integral, primitive
from ..records import EquationsOfMotion, Lagrangian
from ..safe import UnsafeRewriting
from ..spec import Choices, ModelSpec
from ..staged import vanishing
from . import free_free_modes as ff

TENSION = "tension"
MODES = Modes("f", "psi", 4, ("left", "stiffness"), ("inward", "retreat"))
_T = sp.Symbol("t", real=True)
_LENGTH, _MASS, _STIFFNESS = sp.symbols("length mass_per_length bending_stiffness", positive=True)
_CRANK, _FRAME, _SPEED = sp.symbols("crank frame speed", positive=True)
_R1, _R2, _GAMMA = (sp.Function(name)(_T) for name in ("R1", "R2", "gamma"))
_THETA = sp.Function("theta")(_T)
_S = ff.MIDDLE
_BENT, _SHORTENED = (sp.Function(name)(_S, _T) for name in ("u", "a"))
_ENDS = (-ff.HALF, ff.HALF)
_ALONG = sp.Matrix([sp.cos(_GAMMA), sp.sin(_GAMMA)])
_ACROSS = sp.Matrix([-sp.sin(_GAMMA), sp.cos(_GAMMA)])


class Moments:
    """What integrals along the rod are made of: moments of the modes and of the foreshortening.

    The displacement is ``L sum f_i psi_i``, the foreshortening ``L sum f_i f_j alpha_ij`` with
    ``alpha_ij' = -psi_i' psi_j' / 2`` and no mean: R stays the mean position.
    """

    def __init__(self, modes: int, tension: bool) -> None:
        """Choose the number of modes and whether the rod shortens."""
        self.indices = range(1, modes + 1)
        self.f = tuple(sp.Function(f"f{i}")(_T) for i in self.indices)
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
        scaled = tuple(_number("stiffness", i) * self.f[i - 1] for i in self.indices)
        return self.of_products(self.f, scaled)

    def left(self) -> sp.Expr:
        """Return the deflection of the left end over the length."""
        return sp.Add(*(_number("left", i) * self.f[i - 1] for i in self.indices))

    def shortened(self, name: str) -> sp.Expr:
        """Return ``int s alpha ds`` (inward) or alpha at the left end (retreat) over the modes."""
        if not self.tension:
            return sp.S.Zero
        return sp.Add(
            *(
                _number(name, *sorted((i, j))) * self.f[i - 1] * self.f[j - 1]
                for i in self.indices
                for j in self.indices
            )
        )


def _number(name: str, *indices: int) -> sp.Symbol:
    return sp.Symbol("_".join([name, *map(str, indices)]))


@cache
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

    Squared velocity of ``r = R + (x + a) f1 + u f2``, integrated term by term.
    """
    total = sum(_integrated(term, moments) for term in sp.Add.make_args(_squared_velocity()))
    return sp.expand(_MASS * _LENGTH / 2 * total)


@cache
def _squared_velocity() -> sp.Expr:
    """Return the squared velocity of a point to second order in the fields."""
    small = sp.Symbol("small")
    place = sp.Matrix([_R1, _R2])
    place += _LENGTH * ((_S + small**2 * _SHORTENED) * _ALONG + small * _BENT * _ACROSS)
    velocity = place.diff(_T)
    squared = sp.expand(velocity.dot(velocity))
    return _on_circle(sum(squared.coeff(small, order) for order in range(3)))


def _on_circle(expression: sp.Expr) -> sp.Expr:
    """Return an expanded polynomial in cos and sin of gamma with at most one sine in a product."""
    cosine, sine = sp.cos(_GAMMA), sp.sin(_GAMMA)
    return sp.expand(sp.expand(expression).subs(sine**2, 1 - cosine**2))


def _integrated(term: sp.Expr, moments: Moments) -> sp.Expr:
    """Return the integral over s of one product of s, u, a, their rates, and functions of time."""
    u, a = _BENT, _SHORTENED
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
        first = {0: sp.S.Zero, 1: moments.shortened("inward")}[sp.degree(weight, _S)]
        return factor * (first if found == [a] else first.diff(_T))
    raise ValueError(f"no moment for {term}")


def place_of_block() -> sp.Expr:
    """Return the distance of the block from the pin along f1: the first part of the loop (44)."""
    return _CRANK * sp.cos(_GAMMA - _THETA) + _FRAME * sp.cos(_GAMMA)


def constraints(moments: Moments) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Return the pin's two conditions and the block's, Beale & Scott (41)-(45)."""
    centre = sp.Matrix([_R1, _R2])
    along = -ff.HALF + moments.shortened("retreat")
    pin = centre + _LENGTH * (along * _ALONG + moments.left() * _ACROSS)
    place = place_of_block() / _LENGTH
    held = sp.Add(*(f * sp.Function(f"psi_{i}")(place) for i, f in enumerate(moments.f, start=1)))
    turn = sp.Symbol("turn")  # gamma - theta
    crank = [sp.expand_trig(f(_GAMMA - turn)) for f in (sp.cos, sp.sin)]
    block = sp.Matrix([_CRANK * crank[0] + _FRAME, _CRANK * crank[1]])
    gap = centre + _LENGTH * held * _ACROSS - block
    conditions = (pin.dot(_ALONG), pin.dot(_ACROSS), gap.dot(_ACROSS))
    first, second, third = (_on_circle(c).subs(turn, _GAMMA - _THETA) for c in conditions)
    return first, second, third


def lagrangian(modes: int, tension: bool = True) -> Lagrangian:
    """Return energies and constraints of the rod with a number of modes."""
    moments = Moments(modes, tension)
    bending = _STIFFNESS / (2 * _LENGTH) * moments.bending()
    return Lagrangian(
        coordinates=(_R1, _R2, _GAMMA, *moments.f),
        t=_T,
        expression=kinetic_energy(moments) - bending,
        constraints=constraints(moments),
        prescribed={_THETA: _SPEED * _T},
    )


def _energies(spec: ModelSpec) -> Lagrangian:
    return lagrangian(1, TENSION not in spec.drop)


def _discretise(spec: ModelSpec, equations: EquationsOfMotion) -> ConstrainedSystem:
    two = euler_lagrange(lagrangian(2, TENSION not in spec.drop))
    one = (equations, variational_equations(equations))
    closed, variations, steps = closed_in_modes(MODES, one, (two, variational_equations(two)))
    dropped = {}
    if TENSION not in spec.drop:
        _verify_tension(equations)
        dropped = vanishing({TENSION: MODES.matrices})
    return ConstrainedSystem(closed, variations, steps, MODES, dropped)


def _verify_tension(one: EquationsOfMotion) -> None:
    """Verify that without the numbers of the foreshortening the rod is the one without tension."""
    rigid = euler_lagrange(lagrangian(1, tension=False))
    none = {sp.Symbol(f"{name}_1_1"): 0 for name in MODES.matrices}
    for name, matrix in vars(one).items():
        if isinstance(matrix, sp.ImmutableDenseMatrix):
            left = matrix.xreplace(none) - getattr(rigid, name)
            if any(sp.expand(entry) != 0 for entry in left):
                raise UnsafeRewriting(f"{name}: the tension does more than the foreshortening")


def _describe(spec: ModelSpec) -> Description:
    shape = "float or ndarray, shape (...)"
    each, pairs = f"{EACH_MODE}, each {shape}", "N by N floats"
    arguments = [
        Argument("R1", shape, "m", "Mean position of the rod along the frame"),
        Argument("R2", shape, "m", "Mean position of the rod across the frame"),
        Argument("gamma", shape, "rad", "Mean direction of the rod"),
        Argument("f", each, "", "Amplitudes of the modes, in lengths"),
        Argument("t", shape, "s", "Time; the crank angle is speed t"),
        *(
            Argument(name, each, "", f"{words} of the modes at the block")
            for name, words in zip(MODES.external, ("psi", "psi'", "psi''", "psi'''"), strict=True)
        ),
        Argument("left", f"{EACH_MODE} floats", "", "psi of the modes at the pin"),
        Argument("stiffness", f"{EACH_MODE} floats", "", "Fourth powers of the modes' roots"),
        Argument("inward", pairs, "", "int s alpha_ij ds of pairs of modes"),
        Argument("retreat", pairs, "", "alpha_ij of pairs of modes at the pin"),
    ]
    return Description(
        title="Quick-return mechanism, flexible rod in Buckens' frame, free-free modes",
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
            "(crank cos(gamma - speed t) + frame cos(gamma)) / length from the pin.  The "
            "foreshortening is L sum f_i f_j alpha_ij with alpha_ij' = -psi_i' psi_j' / 2 and no "
            "mean, s from the middle.",
            "Multipliers: force of the pin along and across the rod, force of the block, up to "
            "the signs that the constraints give them.",
            f"Operations are those with {COUNTED_MODES} modes.",
        ),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("free_free",),
    energies=_energies,
    describe=_describe,
    discretise=_discretise,
    closed_in_modes=True,
    choices=Choices(flexible=("rod",), drop=(TENSION,)),
)
