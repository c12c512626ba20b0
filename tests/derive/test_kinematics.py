"""The derived kinematics of the linkages: nothing idle, and no rewriting that does not hold.

The digits of every output are those of ``emitted_accuracy``, against the closed loops.
"""

import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import four_bar, quick_return, slider_crank
from elastolink.derive.safe import UnsafeRewriting, bernstein_in_cosine, root_of_parts
from elastolink.derive.spec import ModelSpec
from elastolink.generated import four_bar_clearance

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


@pytest.mark.parametrize(
    ("base", "angle", "lengths"), [(20.0, 0.0, (10.0, 10.0)), (4.0, np.pi, (6.0, 10.0))]
)
def test_play_of_links_in_line(base, angle, lengths):
    """At a dead position the range is one-sided; the link may leave on either side of the line."""
    (own, other), play, sign = lengths, 0.5, 1 if angle == 0.0 else -1
    with np.errstate(divide="ignore"):
        values = four_bar_clearance.extremes(0.0, base + 1.0, 1.0, own, other, play)
    found = dict(zip(four_bar_clearance.RETURNS["extremes"], values, strict=True))
    assert found["angle"] == pytest.approx(angle, abs=1e-15)
    assert found["free"] == 0.0 and np.isinf(found["small"])
    moved, held = ("opened", "closed")[::sign]
    assert found[held] == 0.0
    # 1 - cos = change, by the half-angle.
    change = (2 * other * play + sign * play**2) / (2 * base * own)
    assert found[moved] == pytest.approx(2 * np.arcsin(np.sqrt(change / 2)), rel=1e-14)
