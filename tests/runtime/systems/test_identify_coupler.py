"""The worked example that identifies a rig's coupler: its numbers, and what it finds again."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

FILE = Path(__file__).parents[3] / "docs" / "examples" / "identify_coupler.py"


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("identify_coupler", FILE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("formulation", ["reduced", "complete"])
def test_finds_what_made_the_speeds(example, formulation, monkeypatch):
    # Speeds computed from known values in place of the observed ones.
    rig = example.Rig(formulation)
    frequency, mass = 1.04 * rig.frequency, 0.85 * rig.mass
    speeds = rig.speeds(frequency, mass, example.OBSERVED)
    made = tuple((*row[:3], speed) for row, speed in zip(example.OBSERVED, speeds, strict=True))
    monkeypatch.setattr(example, "OBSERVED", made)
    found = example.identify(formulation)
    assert found["Omega/2 pi [Hz]"] == pytest.approx(frequency / (2.0 * np.pi), rel=1e-6)
    assert found["m [kg/m]"] == pytest.approx(mass, rel=1e-5)
    assert found["EI [N m^2]"] == pytest.approx(rig.stiffness(frequency, mass), rel=1e-5)
    assert found["scatter of the speeds"] < 1e-6


def test_smiths_rig(example):
    # The rig's own frequency is not quoted; 12.2 Hz fits the observations better than the 13 Hz
    # that follow from the thickness, and the mass agrees with the rig's within its deviation.
    found = example.identify("reduced")
    assert found["Omega/2 pi [Hz]"] == pytest.approx(12.0, abs=0.2)
    rig = example.Rig("reduced")
    assert abs(np.log(found["m [kg/m]"] / rig.mass)) < 2.0 * found["m's deviation"]
    assert found["one left out: m from"] < 0.7 * found["m [kg/m]"]
    assert found["one left out: K to"] > 3.0 * found["K to"]
    assert found["one left out: Omega to"] < 1.05 * found["one left out: Omega from"]
    assert 0.005 < found["K from"] < found["K to"] < 0.1
    assert found["scatter of the speeds"] < 0.02
