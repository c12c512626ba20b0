"""Emitted ranges of play: Smith (3.1)-(3.3), trial of the pin, and the run time's own route.

The measure of every output at all points is that of ``emitted_accuracy``.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.generated import four_bar_clearance

NAMES = four_bar_clearance.RETURNS["extremes"]


def emitted(theta, play, lengths):
    with np.errstate(divide="ignore"):
        values = four_bar_clearance.extremes(theta, **lengths, play=play)
    return dict(zip(NAMES, values, strict=True))


@pytest.mark.parametrize("base, angle", [(20.0, 0.0), (4.0, np.pi)])
def test_links_in_line(base, angle):
    """At a dead position the range is one-sided; the link may leave on either side of the line."""
    own, other, clearance = (10.0, 10.0, 1.0) if angle == 0.0 else (6.0, 10.0, 1.0)
    lengths = {"frame": base + 1.0, "crank": 1.0, "turning": own, "opposite": other}
    found = emitted(0.0, clearance / 2, lengths)
    assert found["angle"] == pytest.approx(angle, abs=1e-15)
    assert found["free"] == 0.0 and np.isinf(found["small"])
    change = (other * clearance + (1 if angle == 0.0 else -1) * clearance**2 / 4) / (2 * base * own)
    moved, held = ("opened", "closed") if angle == 0.0 else ("closed", "opened")
    assert found[held] == 0.0
    # 1 - cos = change, by the half-angle.
    assert found[moved] == pytest.approx(2 * np.arcsin(np.sqrt(change / 2)), rel=1e-14)
