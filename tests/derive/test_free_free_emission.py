"""The emitted rods in Buckens' frame: short code, and sums that are formed once."""

from __future__ import annotations

import importlib
import re

import pytest
import sympy as sp
from elastolink.derive.models.block_sums import _Sums
from elastolink.derive.safe import UnsafeRewriting

# Operations of constraints, dynamics and variations with the tension, at most.
COUNTS = {1: (50, 145, 260), 3: (100, 250, 400), 5: (180, 420, 600)}


@pytest.mark.parametrize(("modes", "most"), COUNTS.items())
def test_operations_of_a_rod(modes, most):
    name = f"elastolink.generated.quick_return_rod_free_free_{modes}_modes"
    text = importlib.import_module(name).__doc__
    found = [int(n) for n in re.findall(r"\w+: (\d+) operations", text)]
    assert len(found) == 3
    assert all(a <= b for a, b in zip(found, most, strict=True))


@pytest.mark.parametrize("modes", [1, 4])
def test_numbers_and_symmetry_are_used(modes):
    """No integral of an odd product is a term; without tension the frame's mass is plain."""
    name = f"elastolink.generated.quick_return_rod_free_free_{modes}_modes"
    module, bare = (importlib.import_module(name + end) for end in ("", "_without_tension"))
    assert module.COORDINATES == bare.COORDINATES
    assert module.MULTIPLIERS == ("lam_1", "lam_2", "lam_3")
    jacobian = dict(((i, j), k) for i, j, k in module.ARRAYS["constraints"]["jacobian"][1])
    assert (0, 3) in jacobian  # the pin comes nearer as the rod bends
    assert all((0, 2 + i) not in _filled(bare) for i in range(1, modes + 1))
    assert module.EXTERNAL == bare.EXTERNAL
    assert len(module.EXTERNAL) == 4 * modes


def _filled(module):
    return {(i, j) for i, j, _ in module.ARRAYS["constraints"]["jacobian"][1]}


def test_sums_over_the_modes():
    f, g, psi, chi = sp.symbols("f1 f2 psi_1_d1 psi_2_d1")
    turn, lone = sp.symbols("turn lone")
    sums = _Sums(2)
    entry = turn * (f * psi + g * chi) + lone * psi + sp.sin(turn)
    found = sums.grouped(entry)
    ((name, value),) = sums.steps()
    assert (name.name, value) == ("slope", f * psi + g * chi)
    assert found == turn * name + lone * psi + sp.sin(turn)
    assert sums.grouped(turn**2) == turn**2


@pytest.mark.parametrize("entry", ["psi_1**2", "f1**2*psi_1", "f1*psi_1 + 2*f2*psi_2"])
def test_what_is_no_sum_over_the_modes_is_refused(entry):
    with pytest.raises(UnsafeRewriting, match="bilinear"):
        _Sums(2).grouped(sp.sympify(entry))
