"""Bloch's recursion for the boundaries of Hill's equation, to any order, as an emitted module."""

from __future__ import annotations

from ..describe import Description
from ..ir import Argument
from ..perturbation.bloch import HIGHEST_ORDER, LISTED_ORDER, Recursion
from ..pipeline import Model
from ..spec import ModelSpec


def _recursion(spec: ModelSpec) -> Recursion:
    return Recursion(tuple(range(1, HIGHEST_ORDER + 1)), LISTED_ORDER)


_NOTES = (
    "An operator H + t V has a group of resonant states, on which H is one number, set to zero "
    "here.  With P the projector on them, (H + t V) Omega = Omega h and P Omega = P define the "
    "wave operator Omega and the effective operator h; equating powers of t gives h_k = P V "
    "Omega_(k-1) and Omega_k = R (V Omega_(k-1) - Omega_1 h_(k-1) - ... - Omega_(k-1) h_1), R "
    "being -1/H beyond the resonant states and zero on them.  The eigenvalues of h = t h_1 + t^2 "
    "h_2 + ... are those of H + t V.",
    "The algebra is the caller's.  Omega has as many columns as there are resonant states, r, and "
    "h is r x r: with plain matrices, start is the (size, r) basis of the resonant states, act(x) "
    "is V @ x, resolve(x) is R @ x, project(x) the resonant rows of x and combine(x, h) is x @ h.  "
    "For Hill's equation r is 2, or 1 in region 0, and a symmetry gives one column from the other: "
    "there a column may stand for the pair.  Where an operator is a polynomial in several "
    "parameters, a column of order k holds its homogeneous part of degree k.  All that is asked of "
    "columns is a difference.  Where the resonant states have different levels, with the matrix "
    "h_0, the same statements hold with resolve(x) the y beyond the resonant states that solves "
    "y h_0 - H y = (1 - P) x.",
    "WORDS lists the h_k written out: to each order the words and their coefficients.  An "
    "operation is one call of the algebra or one difference.",
)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Bloch's recursion for the levels of a resonant group of states",
        references=(
            "Smith (7.12)-(7.18), (7.42), (8.39)-(8.43), to any order and number of parameters",
        ),
        arguments=(
            Argument("start", "column", "", "The resonant states, ``Omega_0``"),
            Argument("act", "callable", "", "Applies V to a column, whose order rises by one"),
            Argument("resolve", "callable", "", "Applies R to a column"),
            Argument("project", "callable", "", "Takes P of a column, an effective operator"),
            Argument("combine", "callable", "", "Multiplies ``Omega_j`` by ``h_i``"),
        ),
        notes=_NOTES,
    )


MODEL = Model(
    mechanism="hill",
    formulations=("recursion",),
    energies=_recursion,
    describe=_describe,
)
