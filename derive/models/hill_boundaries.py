"""First-order stability boundaries of Hill's equation as an emitted closed form."""

from __future__ import annotations

from ..describe import Description
from ..ir import Argument, Result
from ..perturbation.first_order import a0, an, bn, damping, first_order, mu, n
from ..pipeline import Model
from ..spec import ModelSpec
from ..staged import ClosedForm, Steps

_SHAPE = "ndarray, shape (...)"


def _closed_form(spec: ModelSpec) -> ClosedForm:
    boundaries = first_order()
    outputs = (
        ("centre", boundaries.centre),
        ("half_width_squared", boundaries.half_width_squared),
    )
    return ClosedForm((n, mu, a0, an, bn, damping), Steps(), outputs)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="First-order stability boundaries of Hill's equation",
        references=("Smith (7.23), (7.25)", "Smith (7.46), (7.49)"),
        arguments=(
            Argument("n", "ndarray or float, shape (...)", "", "Number of the region, from 1"),
            Argument("mu", "ndarray or float, shape (...)", "", "Parameter that multiplies f"),
            Argument("a0", "float or ndarray", "", "Mean of f"),
            Argument("an", "float or ndarray", "", "Cosine coefficient n of f"),
            Argument("bn", "float or ndarray", "", "Sine coefficient n of f"),
            Argument("damping", "float or ndarray", "", "K of 2 K y'"),
        ),
        kernel="first_order",
        summary="Return the centre and half width of region n in lam2",
        results={
            "centre": Result("centre", _SHAPE, "", "Mean of the two boundaries in lam2"),
            "half_width_squared": Result(
                "half_width_squared",
                _SHAPE,
                "",
                "Square of half their distance; negative where damping has closed the tongue",
            ),
        },
    )


MODEL = Model(
    mechanism="hill",
    formulations=("boundaries_first_order",),
    energies=_closed_form,
    describe=_describe,
)
