"""What a sceptical reading of the beams, their frequencies and their commands turned up."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.beams import (
    Section,
    frame,
    linkage_system,
)
from elastolink.runtime.cli import main
from elastolink.runtime.frequencies import (
    frequency_exponents,
)
from elastolink.runtime.linkages import FourBar

STEEL = {"modulus": 210e9, "density": 7850.0}
BAR = Section.rectangle(0.02, 0.005, poisson=0.3, **STEEL)
FOUR_BAR = FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
BARS = dict.fromkeys(("crank", "coupler", "follower"), BAR)
CLAMP = ("x", "y", "rotation")
PORTAL = "aannaque_1996_portal_frame"
ELASTIC = ("--set", "frame.axial=elastic")


def cantilever(**changes):
    given = {
        "places": {"A": (0.0, 0.0), "B": (0.0, 1.0)},
        "members": {"a": ("A", "B")},
        "sections": BAR,
        "supports": {"A": CLAMP},
    }
    given |= changes
    return frame(given.pop("places"), given.pop("members"), given.pop("sections"), **given)


def test_a_torsion_damper_bends_the_end_of_a_beam():
    # Its moment needs a curvature at the end: without damper, spring or inertia there is none.
    found = {}
    for name, values in (("bare", {}), ("damped", {"damping": {"rotation": 0.1}})):
        found[name] = cantilever(kind="curvature", elements=1, nodes={"B": values}).labels
    assert set(found["damped"]) - set(found["bare"]) == {"B.a.curvature"}


@pytest.mark.slow
def test_shear_stiffness_goes_with_the_area():
    # Area, second moment, mass and shear stiffness are all proportional to the width: a linkage
    # without lumped masses whose links are all as much wider has the same frequencies.
    stubby = Section.rectangle(0.02, 0.05, poisson=0.3, **STEEL)
    system = linkage_system(FOUR_BAR, dict.fromkeys(BARS, stubby), elements=1, kind="timoshenko")
    found = frequency_exponents(system, count=2)
    widths = [k for k, row in enumerate(found.rows) if row.endswith("width")]
    assert len(widths) == 3
    total = np.sum(found.exponent[widths], axis=0)
    assert np.all(np.abs(total) <= np.sum(found.error[widths], axis=0))


def told(capsys, *arguments):
    status = main(list(arguments))
    out, err = capsys.readouterr()
    return status, out, err


def test_stress_of_a_frame_needs_no_speed(capsys):
    force = ("--set", 'nodes.B.force=["100 N", "0 N"]')
    status, out, _ = told(capsys, "stress", PORTAL, *ELASTIC, *force, "--limit", "250 MPa")
    # Built-in portal of equal bars, force F along the beam: Kleinlogel's base moment 2 F L/7 for
    # k = 1, half on each side, over the section's modulus b t^2/6; the axial parts are below 1 %.
    moment, modulus = 2.0 / 7.0 * 100.0, 0.02 * 0.01183**2 / 6.0
    first = next(line for line in out.splitlines() if line.startswith("left")).split()
    assert status == 0
    assert float(first[1]) == pytest.approx(moment / modulus / 1e6, rel=0.02)
    # Pushed to the right, the left column is drawn on its left, the positive side of A to B.
    assert first[4] == "positive"
    assert told(capsys, "stress", PORTAL, *ELASTIC)[0] == 0
    status, _, err = told(capsys, "stress", PORTAL, *ELASTIC, "--speed", "3 rad/s")
    assert status == 2 and "no crank" in err


@pytest.mark.parametrize(
    "arguments",
    [
        ("critical-speeds", "--range", "3:4"),
        ("campbell", "--range", "3:4"),
        ("steady-state", "--speed", "3 rad/s"),
        ("running-speed", "--range", "3:4", "--limit", "250 MPa"),
        ("run-through", "--from", "1 rad/s", "--to", "2 rad/s", "--time", "1 s"),
    ],
)
def test_a_frame_has_no_crank(capsys, arguments):
    status, _, err = told(capsys, arguments[0], PORTAL, *arguments[1:])
    assert status == 2 and "no crank" in err and len(err.splitlines()) == 1
