"""The derived kinematics of the linkages: nothing idle, and no rewriting that does not hold.

The digits of every output are those of ``emitted_accuracy``, against the closed loops.
"""

from __future__ import annotations

import pytest
import sympy as sp
from elastolink.derive.models import four_bar, quick_return, slider_crank
from elastolink.derive.safe import UnsafeRewriting, bernstein_in_cosine, root_of_parts
from elastolink.derive.spec import ModelSpec

MODELS = {"four_bar": four_bar, "slider_crank": slider_crank, "quick_return": quick_return}
a, b, d, s, cosine, root = sp.symbols("a b d s cosine root")


@pytest.mark.parametrize("name", MODELS)
def test_each_step_serves_an_output(name):
    """So that nothing idle is emitted; the forces use the sines and cosines that are left over."""
    closed = MODELS[name].MODEL.energies(ModelSpec(name, "kinematics"))
    assert closed.steps == closed.steps.needed(value for _, value in closed.outputs)


def test_a_rewriting_that_does_not_hold_is_refused():
    k = slider_crank.kinematics()
    with pytest.raises(UnsafeRewriting):
        slider_crank._by_ends(k, k.sin2**2)
    with pytest.raises(UnsafeRewriting, match="is not linear in cosine"):
        bernstein_in_cosine(a + b * cosine**2, cosine, *sp.symbols("upper lower"))
    with pytest.raises(UnsafeRewriting, match="is not"):
        root_of_parts((s - d, s + d), (a, b), root, s**2 + d**2)
