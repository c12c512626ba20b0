"""Integrals along a beam whose tangent is a sum of cosines ``cos(n pi s)``, s from 0 to 1.

With the tangent ``p(s) = a_0 + sum a_n cos(n pi s)`` the place of a point is the integral of p from
the beginning; the integrals of the place, of its square, and of the squared curvature are closed
in n, and two different harmonics meet in no integral.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..integrals import antiderivative, definite
from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..safe import UnsafeRewriting
from ..spec import ModelSpec
from ..staged import ClosedForm, Steps

_S = sp.Symbol("s", real=True)
_N, _MORE = (sp.Symbol(name, integer=True, positive=True) for name in ("n", "k"))
_RESULTS = {
    "moment": ("", "int (1 - s) cos(n pi s) ds"),
    "beside_mean": ("", "int s (int cos(n pi s)) ds, the pair of harmonics 0 and n"),
    "inertia": ("", "int (int cos(n pi s))^2 ds, the pair of n with itself"),
    "bending": ("", "int (d/ds cos(n pi s))^2 ds"),
}


def _along(integrand: sp.Expr) -> sp.Expr:
    return sp.simplify(definite(integrand, _S))


@cache
def integrals() -> dict[str, sp.Expr]:
    """Return the integrals of the harmonic n, by name."""
    one, other = (sp.cos(n * sp.pi * _S) for n in (_N, _N + _MORE))
    place, beside = (antiderivative(p, _S) for p in (one, other))
    for pair in (place * beside, one.diff(_S) * other.diff(_S)):
        if (met := _along(pair)) != 0:
            raise UnsafeRewriting(f"two harmonics meet in an integral: {met}")
    return {
        "moment": _along((1 - _S) * one),
        "beside_mean": _along(_S * place),
        "inertia": _along(place**2),
        "bending": _along(one.diff(_S) ** 2),
    }


def integral(name: str, n: sp.Expr) -> sp.Expr:
    """Return an integral of a harmonic; of the mean, n = 0, ``moment`` and ``inertia``."""
    if n == 0:
        return {"moment": _along(1 - _S), "inertia": _along(_S**2)}[name]
    return integrals()[name].subs(_N, n)


def _form(spec: ModelSpec) -> ClosedForm:
    return ClosedForm((_N,), Steps(), tuple(integrals().items()))


def _describe(spec: ModelSpec) -> Description:
    shape = "ndarray, shape (...)"
    return Description(
        title="Integrals along a beam whose tangent is a sum of cosines",
        references=("Smith 9.6, further work 2",),
        arguments=(Argument("n", shape, "", "Number of the harmonic, from 1"),),
        kernel="integrals",
        summary="Return the integrals of one harmonic",
        results={name: Result(name, shape, *words) for name, words in _RESULTS.items()},
    )


MODEL = Model(
    mechanism="beam",
    formulations=("tangent_harmonics",),
    energies=_form,
    describe=_describe,
)
