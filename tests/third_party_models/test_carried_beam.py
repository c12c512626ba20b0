"""The linear-periodic family on a finite basis: one module per number of modes."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.modules import find_module
from elastolink.runtime.systems import assemble

GEOMETRY = {"radius": 0.12, "rocking": 0.5, "length": 0.7}
PARAMETERS = {"bending_stiffness": 3.0, "mass_per_length": 0.4, "damping": 0.0, "tip_mass": 0.05}


def spec(modes: int, **changes) -> ModelSpec:
    return ModelSpec("carried_beam", "polynomial", flexible=("beam",), modes=modes, **changes)


@pytest.fixture(scope="module")
def beam(emit):
    def system(modes: int, **changes):
        found = emit("carried_beam", spec(modes))
        return assemble(
            found.module,
            geometry=GEOMETRY,
            parameters={**PARAMETERS, **changes},
            provenance=found.provenance,
        )

    return system


def by_quadrature(modes: int, theta: float, speed: float, acceleration: float):
    """Arrays of the second-order form from Newton's law in the beam's axes, by Gauss points.

    mu (y_tt - phi_t^2 y + phi_tt x + hub_y) = -EI y'''' + (N y')' and the tip's like; the tension
    is what the outer part needs to follow the hub: N = int_x^L mu (phi_t^2 s - hub_x) ds + tip.
    """
    p = {**PARAMETERS, **GEOMETRY}
    span, mu, tip = p["length"], p["mass_per_length"], p["tip_mass"]
    nodes, weights = np.polynomial.legendre.leggauss(24)
    x, weights = span * (nodes + 1) / 2, weights * span / 2
    phi = p["rocking"] * np.sin(theta)
    turn = p["rocking"] * np.cos(theta) * speed
    bend = p["rocking"] * (np.cos(theta) * acceleration - np.sin(theta) * speed**2)
    hub = p["radius"] * (
        acceleration * np.array([-np.sin(theta), np.cos(theta)])
        - speed**2 * np.array([np.cos(theta), np.sin(theta)])
    )
    along = hub @ [np.cos(phi), np.sin(phi)]
    across = hub @ [-np.sin(phi), np.cos(phi)]
    tension = mu * (turn**2 * (span**2 - x**2) / 2 - along * (span - x)) + tip * (
        turn**2 * span - along
    )
    powers = np.arange(2, modes + 2)[:, None]
    shape = span * (x / span) ** powers
    slope = powers * (x / span) ** (powers - 1)
    curvature = powers * (powers - 1) / span * (x / span) ** (powers - 2)
    end = np.full(modes, span)
    mass = mu * (shape * weights) @ shape.T + tip * np.outer(end, end)
    elastic = p["bending_stiffness"] * (curvature * weights) @ curvature.T
    stiffness = elastic + (slope * weights * tension) @ slope.T - turn**2 * mass
    force = -mu * (shape * weights) @ (bend * x + across) - tip * end * (bend * span + across)
    return mass, stiffness, force


@pytest.mark.parametrize("modes", [2, 3])
def test_arrays_against_quadrature(beam, modes):
    system = beam(modes)
    assert system.size == modes
    rng = np.random.default_rng(4)
    for theta, speed, acceleration in rng.normal(size=(6, 3)) * [3.0, 9.0, 40.0]:
        arrays = {
            name: system.array(name, theta, speed)[0]
            for name in ("M", "A", "B", "S", "K", "Kg", "f", "h", "g", "p")
        }
        mass, stiffness, force = by_quadrature(modes, theta, speed, acceleration)
        np.testing.assert_allclose(arrays["M"], mass, rtol=1e-13)
        np.testing.assert_array_equal(arrays["A"], 0.0)
        whole = arrays["K"] + arrays["Kg"] - speed**2 * arrays["B"] - acceleration * arrays["S"]
        np.testing.assert_allclose(whole, stiffness, rtol=1e-12, atol=1e-11)
        pushed = speed**2 * arrays["f"] + speed * arrays["h"] + acceleration * arrays["g"]
        np.testing.assert_allclose(pushed + arrays["p"], force, rtol=1e-12, atol=1e-12)


def test_each_count_has_its_own_module(emit, beam, tmp_path):
    names = {emit("carried_beam", spec(modes)).module.__name__ for modes in (2, 3)}
    assert len(names) == 2
    with pytest.raises(BadInput, match="4_modes"):
        find_module(spec(4), [tmp_path])
    module = emit("carried_beam", spec(2)).module
    with pytest.raises(BadInput, match="2, the module's own"):
        assemble(module, geometry=GEOMETRY, parameters=PARAMETERS, modes=3)


def test_stability_only_module_holds_no_forcing(emit):
    lean = emit("carried_beam", spec(2, outputs=("stability",))).module
    assert {array for array, *_ in lean.TERMS} <= {"M", "A", "B", "S", "C", "K", "Kg"}
    assert not hasattr(lean, "forcing_functions")
