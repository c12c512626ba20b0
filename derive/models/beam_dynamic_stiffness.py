"""Dynamic stiffness of a uniform beam, exact at every frequency, as emitted closed forms.

End forces over end displacements of a harmonic motion, their rates with the squared frequency (the
mass of the motion), shapes between the ends, and how many frequencies of the beam with held ends
lie below: what Wittrick and Williams' count of a frame's frequencies is made of.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..spec import ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms
from . import beam_frequency_functions as ff
from . import beam_frequency_shapes as shapes
from .beam_frequency_problem import B, Z


def _bending() -> KernelForm:
    outputs = tuple(ff.functions().items())
    form = ClosedForm((Z,), ff.steps().needed(e for _, e in outputs), outputs)
    return KernelForm("bending", "Return the frequency functions of bending", form)


def _bending_masses() -> tuple[KernelForm, KernelForm]:
    steps = ff.steps().then(
        *((ff.FUNCTIONS[name], form) for name, form in ff.functions().items()),
        (ff.SQUARED, Z**4),
    )
    words = {
        "bending_rates": "Return minus the rates of F1 to F6 with the squared frequency z^4",
        "bending_inertias": "Return what takes F1 to F6 from their static values, over z^4",
    }
    found = []
    for (name, summary), values in zip(words.items(), (ff.rates(), ff.inertias()), strict=True):
        needed = steps.needed(values.values())
        found.append(KernelForm(name, summary, ClosedForm((Z,), needed, tuple(values.items()))))
    return found[0], found[1]


def _axial() -> tuple[KernelForm, ...]:
    steps, functions, rates = ff.axial()
    _, inertias = ff.axial_inertias()
    return (
        KernelForm(
            "axial",
            "Return the frequency functions of the motion along the beam",
            ClosedForm((B,), steps.needed(functions.values()), tuple(functions.items())),
        ),
        KernelForm(
            "axial_rates",
            "Return minus the rates of F7 and F8 with the squared frequency b^2",
            ClosedForm((B,), steps.needed(rates.values()), tuple(rates.items())),
        ),
        KernelForm(
            "axial_inertias",
            "Return what takes F7 and F8 from their static values, over b^2",
            ClosedForm((B,), steps.needed(inertias.values()), tuple(inertias.items())),
        ),
    )


def _poles() -> tuple[KernelForm, KernelForm]:
    return (
        KernelForm(
            "bending_poles",
            "Return how many bending frequencies of the beam with held ends lie below z",
            ff.bending_poles(),
        ),
        KernelForm(
            "axial_poles",
            "Return how many axial frequencies of the beam with held ends lie below b",
            ff.axial_poles(),
        ),
    )


def _shapes() -> tuple[KernelForm, KernelForm]:
    return (
        KernelForm(
            "bending_shapes",
            "Return the deflection between the ends for unit displacements of the right end",
            shapes.bending_shapes(),
        ),
        KernelForm(
            "axial_shapes",
            "Return the displacement along the beam for a unit one of the right end",
            shapes.axial_shapes(),
        ),
    )


@lru_cache(maxsize=1)
def _kernels() -> KernelForms:
    return KernelForms((_bending(), *_bending_masses(), *_axial(), *_poles(), *_shapes()))


def _forms(spec: ModelSpec) -> KernelForms:
    return _kernels()


_SHAPE = "ndarray, shape (...)"
_WORDS: Mapping[str, str] = {
    "xi": "Place along the beam from its left end, in lengths: from 0 to 1",
    "z": "Length over wave length in bending, lambda L: z^4 = omega^2 rho A L^4 / (E I); above 0",
    "b": "The same along the beam, beta L: b^2 = omega^2 rho L^2 / E; above 0",
}
_ENDS = {
    "1": "moment at one end over rotation of the other [E I / L]",
    "2": "moment over rotation of the same end [E I / L]",
    "3": "moment at the right end over deflection of the left [E I / L^2]",
    "4": "moment over deflection of the right end [E I / L^2]",
    "5": "force at one end over deflection of the other [E I / L^3]",
    "6": "force over deflection of the same end [E I / L^3]",
    "7": "force along the beam over displacement of the same end [E A / L]",
    "8": "force along the beam at one end over displacement of the other [E A / L]",
}
_RESULTS: Mapping[str, str] = {
    **{f"F{i}": words[0].upper() + words[1:] for i, words in _ENDS.items()},
    **{f"G{i}": f"-dF{i}/d(z^4): in units of mass, rho A L times L^n" for i in "123456"},
    **{f"G{i}": f"-dF{i}/d(b^2): in units of the mass rho A L" for i in "78"},
    **{f"H{i}": f"(F{i}(0) - F{i}) / z^4: in units of mass, as G{i}" for i in "123456"},
    **{f"H{i}": f"(F{i}(0) - F{i}) / b^2: in units of the mass rho A L" for i in "78"},
    "bending_count": "Whole number, as a float",
    "axial_count": "Whole number, as a float",
    **{
        f"{kind}_{name}": f"{words}{'' if name == 'value' else ', its ' + name + ' along xi'}"
        for kind, words in (
            ("deflection", "Deflection for a unit deflection of the right end"),
            ("rotation", "Deflection for a unit slope by xi at the right end"),
            ("stretch", "Displacement for a unit one of the right end"),
        )
        for name in ("value", "slope", "curvature", "third")
    },
}


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Exact dynamic stiffness of a uniform beam",
        references=("Aannaque (5.1)-(5.19)", "Aannaque (B.1)-(B.17)"),
        arguments=tuple(Argument(name, _SHAPE, "", words) for name, words in _WORDS.items()),
        results={name: Result(name, _SHAPE, "", words) for name, words in _RESULTS.items()},
        notes=(
            "Forces and displacements in the order deflection and rotation of the left end, of the "
            "right end: rows (F6, -F4, F5, F3), (-F4, F2, -F3, F1), (F5, -F3, F6, F4), (F3, F1, "
            "F4, F2); along the beam (F7, F8), (F8, F7).  Nothing overflows and nothing cancels, "
            "from z = 1e-30 on.  A complex z (a section that loses energy) is welcome in bending "
            "and bending_rates.",
        ),
    )


MODEL = Model(
    mechanism="beam",
    formulations=("dynamic_stiffness",),
    energies=_forms,
    describe=_describe,
)
