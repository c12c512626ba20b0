"""Elastic modes of a free-free beam, stable to any order, with their integrals in closed form.

The boundary value problem on ``-1/2 < s < 1/2`` splits into even and odd modes.  Everything that
grows is divided out before it is formed, and the characteristic equation replaces what would
cancel.  Integrals of slopes against 1, s and s^2 follow from Green's identity.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import sympy as sp

from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..projection.greens_identity import integral, primitive
from ..safe import UnsafeRewriting, vanishes
from ..spec import ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms, Steps

HALF = sp.Rational(1, 2)
MIDDLE = sp.Symbol("s", real=True)  # from the middle, in lengths
ETA, ROOT, PARITY, PHASE = sp.symbols("eta root parity phase", real=True)
OTHER, OTHER_PARITY = sp.symbols("other other_parity", real=True)
SLOPE, OTHER_SLOPE = sp.symbols("end_slope other_end_slope", real=True)
AMPLITUDE, WEIGHT = sp.symbols("amplitude weight", real=True)
OFFSET, START = sp.symbols("offset start", real=True)
_B = sp.Symbol("b", positive=True)
_SHAPES = {1: (sp.cos, sp.cosh), -1: (sp.sin, sp.sinh)}
_TURNED = {1: sp.sin, -1: sp.cos}  # the other trigonometric function
_CONSTANTS = sp.symbols("b4 c4", positive=True)  # b^4 of two modes


@lru_cache(maxsize=1)
def end_value() -> sp.Expr:
    """Return ``psi(1/2)`` of a mode with unit square: Green's identity needs no mode for it."""
    value, parity = sp.symbols("value parity")

    def at_end(_: int, order: int, end: sp.Expr) -> sp.Expr:
        slope = sp.Symbol("slope")
        kept = {0: value, 1: slope}.get(order, sp.S.Zero)  # psi'' = psi''' = 0 at a free end
        return kept if end > 0 else parity * (-1) ** order * kept

    form = primitive(sp.S.One, MIDDLE, (0, 0), (_CONSTANTS[0], _CONSTANTS[0]))
    square = sp.expand(integral(form, MIDDLE, (-HALF, HALF), at_end)).subs(parity**2, 1)
    return max(sp.solve(square - 1, value))


@lru_cache(maxsize=2)
def boundary_problem(parity: int) -> tuple[sp.Expr, sp.Expr]:
    """Solve the boundary value problem of one parity.

    ``parity``: 1 for even modes, -1 for odd ones. Returns ``shape``: mode in s and b, with ``psi''
    = 0`` at the ends and unit square on a root; ``characteristic``: ``psi'''`` at the end: vanishes
    on a root.
    """
    factors = sp.symbols("swing rise")
    shape = sum(c * f(_B * MIDDLE) for c, f in zip(factors, _SHAPES[parity], strict=True))
    ends = [sp.diff(shape, MIDDLE, order).subs(MIDDLE, HALF) for order in range(4)]
    (found,) = sp.linsolve([ends[0] - end_value(), ends[2]], *factors)
    values = dict(zip(factors, found, strict=True))
    return shape.subs(values), ends[3].subs(values)


@lru_cache(maxsize=1)
def characteristic() -> sp.Expr:
    """Return the characteristic function of all modes, ``cos b - 1 / cosh b`` up to its sign."""
    both = sp.S.One
    for parity, (swing, rise) in _SHAPES.items():
        scale = swing(_B / 2) * rise(_B / 2) / _B**3
        both *= sp.expand(boundary_problem(parity)[1] * scale)
    stable = sp.cos(_B) - 1 / sp.cosh(_B)
    ratio = (both / (stable * sp.cosh(_B))).rewrite(sp.exp)
    constant = sp.simplify(ratio)
    if constant.free_symbols:
        raise UnsafeRewriting(f"{both} is not {stable} but for a factor")
    return stable


def _defect() -> tuple[sp.Expr, sp.Expr]:
    """Return what vanishes at ``b = start + offset``, start an odd multiple of pi / 2, and slope.

    There ``cos b = parity sin offset``, so that the small offset keeps its digits.
    """
    decay = sp.exp(-(START + OFFSET))
    sine, cosine = sp.sin(START), sp.cos(START)
    wave = sp.expand_trig(sp.cos(START + OFFSET)).subs({cosine: 0, sine: -PARITY})
    stable = characteristic().subs(sp.cos(_B), wave).subs(1 / sp.cosh(_B), 2 * decay)
    # 1 / cosh = 2 e / (1 + e^2); multiplied by the parity, whose square is 1.
    stable = sp.expand(PARITY * wave).subs(PARITY**2, 1) - PARITY * 2 * decay / (1 + decay**2)
    return stable, sp.diff(stable, OFFSET)


def decay(root: sp.Expr = ROOT) -> sp.Expr:
    """Return ``exp(-b)``."""
    return sp.exp(-root)


def amplitude(root: sp.Expr, parity: sp.Expr) -> sp.Expr:
    """Return the modulus of the trigonometric part of a mode."""
    e = decay(root)
    return sp.sqrt(2 * (1 + e**2)) / (1 + parity * e)


def weight(root: sp.Expr, parity: sp.Expr) -> sp.Expr:
    """Return the factor of both decaying parts of a mode."""
    return 1 / (1 + parity * decay(root))


def end_slope(root: sp.Expr, parity: sp.Expr) -> sp.Expr:
    """Return ``psi'(1/2)`` of a mode."""
    e = decay(root)
    return 2 * root * (1 - parity * e) / (1 + parity * e)


def stable_shape() -> sp.Expr:
    """Return a mode in eta, in its constants: one wave and one decaying part from either end."""
    swing = sp.cos(ROOT * (ETA - HALF) - PHASE)
    return AMPLITUDE * swing + WEIGHT * (sp.exp(-ROOT * (1 - ETA)) + PARITY * sp.exp(-ROOT * ETA))


@lru_cache(maxsize=1)
def verify() -> None:
    """Verify the stable forms against the boundary value problem."""
    for parity, (swing, rise) in _SHAPES.items():
        shape, closing = boundary_problem(parity)
        ratio = sp.Symbol("ratio")  # tan(b/2) or cot(b/2): the other function over its own
        other = _TURNED[parity](_B / 2)
        (on_root,) = sp.solve(closing.subs(other, ratio * swing(_B / 2)), ratio)
        values = {ROOT: _B, PARITY: parity, ETA: MIDDLE + HALF}
        known = values | {AMPLITUDE: 0, WEIGHT: weight(ROOT, PARITY).subs(values)}
        risen = shape.coeff(rise(_B * MIDDLE)) * rise(_B * MIDDLE)
        swung = shape.coeff(swing(_B * MIDDLE))
        # 1 / cos^2 = 1 + tan^2, with the tangent that the characteristic equation gives
        squared = (swung * swing(_B / 2)) ** 2 * (1 + on_root**2)
        slope = sp.diff(shape, MIDDLE).subs(MIDDLE, HALF).subs(other, on_root * swing(_B / 2))
        checks = {
            "decaying parts": stable_shape().subs(known) - risen,
            "amplitude": amplitude(_B, sp.Integer(parity)) ** 2 - squared,
            "end slope": end_slope(_B, sp.Integer(parity)) - slope,
        }
        for name, difference in checks.items():
            if not vanishes(difference):
                raise UnsafeRewriting(f"{name} of parity {parity}: {difference} is not 0")


@lru_cache(maxsize=8)
def slope_integral(power: int, same: bool) -> sp.Expr:
    """Return ``int s^power psi_i' psi_j' ds`` in roots, parities and end slopes of the modes.

    ``power``: 0, 1 or 2; ``same``: true for i = j.
    """
    verify()
    modes = ((ROOT, PARITY), (ROOT, PARITY) if same else (OTHER, OTHER_PARITY))
    slopes = (SLOPE, OTHER_SLOPE)

    def at_end(mode: int, order: int, end: sp.Expr) -> sp.Expr:
        which = 0 if same else mode
        value = {0: end_value(), 1: slopes[which]}.get(order, sp.S.Zero)
        return value if end > 0 else modes[which][1] * (-1) ** order * value

    constants = (_CONSTANTS[0], _CONSTANTS[0] if same else _CONSTANTS[1])
    form = primitive(MIDDLE**power, MIDDLE, (1, 1), constants)
    found = sp.expand(integral(form, MIDDLE, (-HALF, HALF), at_end))
    found = found.subs({PARITY**2: 1, OTHER_PARITY**2: 1})
    roots = (ROOT, OTHER)
    values = {constant: root**4 for constant, root in zip(_CONSTANTS, roots, strict=True)}
    return sp.factor_terms(sp.factor(found).subs(values))


@lru_cache(maxsize=1)
def shortening() -> dict[str, sp.Expr]:
    """Return ``int s alpha ds`` (inward) and ``alpha(-1/2)`` (retreat) for ``alpha' = -w / 2``.

    In the integrals ``w_0, w_1, w_2`` of w against 1, s and s^2, alpha without mean.  By parts,
    ``int alpha = [s alpha] - int s alpha' = 0`` gives the mean of the end values, ``int alpha'``
    their difference.
    """
    left, right = sp.symbols("left right")
    rate = [-HALF * sp.Symbol(f"w_{power}") for power in range(3)]
    by_parts = HALF * right + HALF * left - rate[1]
    (ends,) = sp.linsolve([right - left - rate[0], by_parts], left, right)
    first = (HALF**2 * ends[1] - HALF**2 * ends[0] - rate[2]) / 2
    return {"inward": sp.expand(first), "retreat": sp.expand(ends[0])}


def shortening_number(name: str, same: bool) -> sp.Expr:
    """Return what a product of two modes' slopes adds to the foreshortening.

    ``name``: ``inward`` or ``retreat``; ``same``: true for a mode with itself.
    """
    slopes = {sp.Symbol(f"w_{power}"): slope_integral(power, same) for power in range(3)}
    value = shortening()[name].subs(slopes)
    return sp.factor_terms(sp.factor(value)) if name == "inward" or same else value


def _modes() -> KernelForm:
    """Return the modes and three derivatives, each wave and decaying part formed once."""
    place, near, far = sp.symbols("place near far", real=True)
    parts = sp.symbols("swing turn left right", real=True)
    swing, _, left, right = parts
    arguments = {place: ROOT * (ETA - HALF) - PHASE, near: ROOT * ETA, far: ROOT * (1 - ETA)}
    values = (sp.cos(place), sp.sin(place), sp.exp(-near), sp.exp(-far))
    names = dict(zip(values, parts, strict=True))
    rates = {
        part: sum(sp.diff(value, inner) * sp.diff(arguments[inner], ETA) for inner in arguments)
        for value, part in names.items()
    }
    shape = AMPLITUDE * swing + WEIGHT * (right + PARITY * left)
    written = shape.subs(dict(zip(parts, values, strict=True))).subs(arguments)
    if sp.expand(written - stable_shape()) != 0:
        raise UnsafeRewriting(f"{shape} is not the mode")
    outputs = []
    for order, name in enumerate(("value", "slope", "curvature", "third")):
        outputs.append((name, ROOT**order * shape))
        # What a derivative along eta makes of one root is the factor in front.
        found = sum(sp.diff(shape, part) * rates[part] / ROOT for part in parts)
        waves, decays = AMPLITUDE * sp.diff(found, AMPLITUDE), WEIGHT * sp.diff(found, WEIGHT)
        shape = (waves + decays).xreplace(names)
    return KernelForm(
        "modes",
        "Return modes and their derivatives along eta",
        ClosedForm(
            (ETA, ROOT, PHASE, PARITY, AMPLITUDE, WEIGHT),
            Steps((*arguments.items(), *zip(parts, values, strict=True))),
            tuple(outputs),
        ),
    )


def _forms(spec: ModelSpec) -> KernelForms:
    verify()  # before anything is emitted
    defect = tuple(zip(("defect", "defect_slope"), _defect(), strict=True))
    constants = (
        ("amplitude", amplitude(ROOT, PARITY)),
        ("weight", weight(ROOT, PARITY)),
        ("end_slope", end_slope(ROOT, PARITY)),
    )
    pairs, squares = (
        tuple(
            (name, value)
            for power, name in enumerate(("plain", "first", "second"))
            if (value := slope_integral(power, same)) != 0
        )
        + tuple((name, shortening_number(name, same)) for name in shortening())
        for same in (False, True)
    )
    return KernelForms(
        (
            KernelForm(
                "root_defect",
                "Return what vanishes at a root, and its slope",
                ClosedForm((OFFSET, START, PARITY), Steps(), defect),
            ),
            KernelForm(
                "mode_constants",
                "Return the constants of modes",
                ClosedForm((ROOT, PARITY), Steps(), constants),
            ),
            _modes(),
            KernelForm(
                "slope_products",
                "Return integrals of products of slopes of two different modes",
                ClosedForm(_OF_PAIRS, Steps(), pairs),
            ),
            KernelForm(
                "slope_squares",
                "Return integrals of squared slopes",
                ClosedForm((SLOPE,), Steps(), squares),
            ),
        )
    )


_OF_PAIRS = (ROOT, OTHER, SLOPE, OTHER_SLOPE, PARITY, OTHER_PARITY)
_SHAPE = "ndarray, shape (...)"
_WORDS: Mapping[str, tuple[str, str]] = {
    "eta": ("", "Place along the beam from its left end, in lengths"),
    "root": ("", "Root b of cos b cosh b = 1: the mode solves psi'''' = b^4 psi"),
    "parity": ("", "1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ..."),
    "phase": ("rad", "(i + 1) pi / 2 for mode i, or that less whole turns"),
    "other": ("", "Root of the other mode"),
    "other_parity": ("", "Parity of the other mode"),
    "end_slope": ("", "psi' of the mode at the right end"),
    "other_end_slope": ("", "psi' of the other mode at the right end"),
    "amplitude": ("", "Modulus of the wave in a mode"),
    "weight": ("", "Factor of the parts that decay from the ends"),
    "offset": ("", "Root less its start"),
    "start": ("", "(i + 1/2) pi for mode i"),
}
_RESULTS: Mapping[str, str] = {
    "defect": "sin(offset) - parity / cosh(root)",
    "defect_slope": "Its derivative with respect to the offset",
    "amplitude": "Modulus of the wave in a mode",
    "weight": "Factor of the parts that decay from the ends",
    "end_slope": "psi' of the mode at the right end",
    "value": "psi, of unit square over the beam",
    "slope": "psi'",
    "curvature": "psi''",
    "third": "psi'''",
    "plain": "int psi_i' psi_j' ds over -1/2 < s < 1/2",
    "first": "int s psi_i' psi_j' ds",
    "second": "int s^2 psi_i' psi_j' ds",
    "inward": "int s alpha ds of the foreshortening alpha' = -psi_i' psi_j' / 2 without mean",
    "retreat": "alpha at the left end",
}


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Elastic modes of a free-free beam",
        references=("Beale & Scott (28)", "Beale & Scott (34)-(36)", "Beale & Scott (39)"),
        arguments=tuple(
            Argument(name, _SHAPE, unit, meaning) for name, (unit, meaning) in _WORDS.items()
        ),
        results={name: Result(name, _SHAPE, "", words) for name, words in _RESULTS.items()},
        notes=(
            "The forms hold on the roots: the characteristic equation is used in them.  Nothing "
            "grows with the number of the mode but powers of its root.",
        ),
    )


MODEL = Model(
    mechanism="beam",
    formulations=("free_free_modes",),
    energies=_forms,
    describe=_describe,
)
