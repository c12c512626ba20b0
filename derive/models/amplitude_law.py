"""How the frequency of an inextensible coupler falls with its amplitude, the crank held still.

``omega = omega_k (1 + kappa (A/l3)^2 + ...)``, A the amplitude of the k-th mode of the deflection.
The Lagrangian up to fourth order (:mod:`.inextensible_cubic`), averaged over a period of

    q_k = a cos(phi) + b0 + b2 cos(2 phi),    q_m = c0 + c2 cos(2 phi),    phi = omega t,

where b and c are of second order, is stationary in all of them; of the other modes each answers
for itself.  The harmonics k and m stay symbols: only those that meet by themselves, such as the
mean of ``cos^2``, have a product, and others that meet for some k and m are of higher order.
"""

from __future__ import annotations

import sympy as sp

from ..amplitudes import SMALL
from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..safe import UnsafeRewriting
from ..spec import ModelSpec
from ..staged import ClosedForm, Steps
from .beam_tangent_harmonics import integral
from .inextensible_coupler import (
    COUPLER,
    DENSITY,
    FOLLOWER,
    INERTIA,
    PULL,
    SLIDER,
    STIFFNESS,
    T,
)
from .inextensible_cubic import ACROSS, ALONG, by_u, closure_by_chord, energies, rigid_linkage

MODE, OTHER = sp.symbols("mode other", integer=True, positive=True)
_GAMMA, _MASS, _OMEGA = sp.symbols("transmission_angle driven_mass omega", positive=True)
_FIRST, _SECOND, _FOLLOWS = (sp.Function(name)(T) for name in ("first", "second", "follows"))
_OWN, _BESIDE = sp.symbols("b0 b2", real=True), sp.symbols("c0 c2", real=True)
_RESULTS = {
    "alone": "kappa of a coupler with this mode alone",
    "alone_by_angle": "Its derivative by the transmission angle",
    "beside": "What the other mode adds to kappa",
    "beside_by_angle": "Its derivative by the transmission angle",
}


def averaged(mechanism: str) -> sp.Expr:
    """Return the mean of the Lagrangian over a period, the crank held still."""
    linkage = rigid_linkage(mechanism)
    angle = {MODE: SMALL * _FIRST + SMALL**2 * _SECOND, OTHER: SMALL**2 * _FOLLOWS}
    bending = sp.Add(*(a**2 * integral("bending", n) / 2 for n, a in angle.items()))
    slopes = {symbol.name: value for symbol, value in closure_by_chord(linkage)}
    still = dict.fromkeys((ALONG, ACROSS, *PULL), sp.S.Zero)
    for f in linkage.rates:
        still |= {f: sp.S.Zero, by_u(f, 2): sp.S.Zero, by_u(f): slopes[by_u(f).func.__name__]}
    (own, twice), (mean, second) = _OWN, _BESIDE
    wave = sp.cos(2 * _OMEGA * T)
    motion = {_FIRST: sp.cos(_OMEGA * T), _SECOND: own + twice * wave}
    motion[_FOLLOWS] = mean + second * wave
    unbent = energies(linkage.end, angle).subs(still).doit()
    moving = (unbent - STIFFNESS / COUPLER * bending).subs(motion).doit()
    waves = sp.expand(moving.rewrite(sp.exp))
    return sp.Add(*(term for term in sp.Add.make_args(waves) if not term.has(T)))


def coefficients(mechanism: str) -> tuple[sp.Expr, sp.Expr]:
    """Return kappa with one mode, and what another one adds, in the linkage's own symbols."""
    mean = averaged(mechanism)
    square = mean.coeff(SMALL, 2)
    (stiffness,) = sp.solve(square, STIFFNESS)  # that of the frequency omega
    fourth = sp.expand(mean.coeff(SMALL, 4).subs(STIFFNESS, stiffness))
    unknowns = [*_OWN, *_BESIDE]
    if not sp.hessian(fourth, unknowns).is_diagonal():
        raise UnsafeRewriting("the second-order motions answer together")
    zero = dict.fromkeys(unknowns, sp.S.Zero)
    # d(mean)/da = 0: 2 d(square)/d(omega) (omega - omega_k) + 4 fourth = 0, at a = 1.
    scale = -2 * (sp.pi * MODE) ** 2 / (_OMEGA * square.diff(_OMEGA))

    def answer(unknown: sp.Symbol) -> sp.Expr:
        return -(fourth.diff(unknown).subs(zero) ** 2) / (2 * fourth.diff(unknown, 2))

    alone = fourth.subs(zero) + sp.Add(*map(answer, _OWN))
    beside = sp.Add(*map(answer, _BESIDE))
    return sp.factor(sp.simplify(scale * alone)), sp.factor(sp.simplify(scale * beside))


def law(mechanism: str) -> tuple[sp.Expr, sp.Expr]:
    """Return the coefficients in transmission angle and mass ratio, the same of both mechanisms."""
    solved = rigid_linkage(mechanism).solved
    # The transmission angle of a slider-crank is that with the guide's normal.
    four_bar = mechanism == "four_bar"
    names = ("sine_transmission", "cosine_transmission") if four_bar else ("cos3", "sin3")
    driven = _MASS * DENSITY * COUPLER
    table = {INERTIA: driven * FOLLOWER**2, SLIDER: driven}
    table |= {getattr(solved, n): f(_GAMMA) for n, f in zip(names, (sp.sin, sp.cos), strict=True)}
    alone, beside = (sp.simplify(value.subs(table)) for value in coefficients(mechanism))
    return alone, beside


def _form(spec: ModelSpec) -> ClosedForm:
    outputs: dict[str, sp.Expr] = {}
    for name, value in zip(("alone", "beside"), law("four_bar"), strict=True):
        outputs |= {name: value, f"{name}_by_angle": sp.factor(value.diff(_GAMMA))}
    return ClosedForm((_GAMMA, MODE, OTHER, _MASS), Steps(), tuple(outputs.items()))


def _describe(spec: ModelSpec) -> Description:
    shape = "ndarray, shape (...)"
    words = "Mass that C drives over that of the coupler: I4/l4^2, or the slider's"
    return Description(
        title="Frequency of an inextensible coupler against its amplitude, the crank held still",
        references=("Smith 9.6, further work 2",),
        arguments=(
            Argument(_GAMMA.name, shape, "rad", "Transmission angle"),
            Argument(MODE.name, "float", "", "Number k of the mode"),
            Argument(OTHER.name, shape, "", "Number m of another mode, which follows at 2 omega"),
            Argument(_MASS.name, "float", "", words),
        ),
        kernel="coefficients",
        summary="Return kappa of omega = omega_k (1 + kappa (A/l3)^2), A that of the deflection",
        results={name: Result(name, shape, "", meaning) for name, meaning in _RESULTS.items()},
        notes=(
            "kappa is the first coefficient and the sum of what all other modes add; they count "
            "only where coupler and follower do not meet at right angles.",
        ),
    )


MODEL = Model(mechanism="beam", formulations=("amplitude_law",), energies=_form, describe=_describe)
