"""The linear-periodic family on a finite basis: one module per number of modes."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.modules import find_module
from elastolink.runtime.systems import assemble

RADIUS, LENGTH, STIFFNESS, DENSITY, GRAVITY = 0.12, 0.7, 3.0, 0.4, 9.81
NUMBERS = {
    "geometry": {"radius": RADIUS, "length": LENGTH},
    "parameters": {"bending_stiffness": STIFFNESS, "mass_per_length": DENSITY, "gravity": GRAVITY},
}


def spec(modes: int, **changes) -> ModelSpec:
    return ModelSpec("turning_beam", "polynomial", flexible=("beam",), modes=modes, **changes)


@pytest.mark.parametrize("modes", [2, 3])
def test_arrays_against_quadrature(emit, modes):
    found = emit("turning_beam", spec(modes))
    system = assemble(found.module, **NUMBERS, provenance=found.provenance)
    assert system.size == modes
    nodes, weights = np.polynomial.legendre.leggauss(24)
    x, weights = LENGTH * (nodes + 1) / 2, weights * LENGTH / 2
    powers = np.arange(2, modes + 2)[:, None]
    shape = LENGTH * (x / LENGTH) ** powers
    slope = powers * (x / LENGTH) ** (powers - 1)
    curvature = powers * (powers - 1) / LENGTH * (x / LENGTH) ** (powers - 2)
    tension = DENSITY * ((RADIUS + LENGTH) ** 2 - (RADIUS + x) ** 2) / 2
    mass, theta = DENSITY * (shape * weights) @ shape.T, np.array([0.7])
    expected = {
        "M": mass,
        "K": STIFFNESS * (curvature * weights) @ curvature.T,
        "B": mass - (slope * weights * tension) @ slope.T,
        "g": -DENSITY * shape @ (weights * (RADIUS + x)),
        "p": -DENSITY * GRAVITY * np.cos(0.7) * shape @ weights,
    }
    for name in ("M", "A", "B", "S", "C", "D", "K", "Kg", "f", "h", "g", "p"):
        array = system.array(name, theta)[0]
        np.testing.assert_allclose(array, expected.get(name, 0.0 * array), rtol=1e-12)


def test_each_count_has_its_own_module(emit, tmp_path):
    names = {emit("turning_beam", spec(modes)).module.__name__ for modes in (2, 3)}
    assert len(names) == 2
    with pytest.raises(BadInput, match="4_modes"):
        find_module(spec(4), [tmp_path])
    module = emit("turning_beam", spec(2)).module
    with pytest.raises(BadInput, match="2, the module's own"):
        assemble(module, **NUMBERS, modes=3)


def test_stability_only_module_holds_no_forcing(emit):
    lean = emit("turning_beam", spec(2, outputs=("stability",))).module
    assert {array for array, *_ in lean.TERMS} <= {"M", "A", "B", "S", "C", "K", "Kg"}
    assert not hasattr(lean, "forcing_functions")
