"""``elastolink stress``, ``running-speed`` and ``critical-speeds`` of a light linkage of beams."""

import numpy as np
import pytest
from command_runs import run, shown

LIGHT = """
[model]
mechanism = "four_bar"
formulation = "cubic_beams"
flexible = ["crank", "coupler", "follower"]
[links]
frame = "300 mm"
crank = "60 mm"
coupler = "260 mm"
follower = "200 mm"
assembly = "open"
[material]
modulus = "70 GPa"
density = "2700 kg/m**3"
[section]
area = "60 mm**2"
second_moment = "80 mm**4"
thickness = "4 mm"
[mesh]
elements = 1
[damping]
ratio = 0.02
"""


@pytest.fixture
def scene(tmp_path):
    place, section = tmp_path / "light.toml", LIGHT[LIGHT.index("area") : LIGHT.index("[mesh]")]
    links = "".join(f"[{link}]\n{section}" for link in ("crank", "coupler", "follower"))
    place.write_text(LIGHT.replace("[section]\n" + section, links))
    return place


@pytest.mark.slow
def test_every_link_has_its_own_maxima_of_the_stress(capsys, scene):
    _, out, _ = run(capsys, "stress", scene, "--speed", "120:260:141")
    rows = [line.split() for line in out.splitlines() if line[:1].isdigit()][1:]
    starred = np.array([[cell.endswith("*") for cell in row[1:]] for row in rows])
    assert np.all(np.any(starred, axis=0)) and np.all(np.any(starred, axis=1))
    # Some maxima of one link are no maxima of another.
    assert np.any(np.sum(starred, axis=1) < 3)


@pytest.mark.slow
def test_no_running_speed_is_named_below_all_limiting_critical_speeds(capsys, scene):
    out = shown(capsys, "running-speed", scene, "--range", "20:60", "--limit", "200 MPa")
    assert out.startswith("no quiet speed beyond a limiting critical speed in this range")
    assert "within the limit from 20 to 60 rad/s" in out and "running speed:" not in out


def test_a_range_without_maxima_of_the_response_says_so(capsys, scene):
    out = shown(capsys, "critical-speeds", scene, "--range", "20:22", "--method", "response")
    assert "none of this kind" in out and "elastolink stress" in out


def test_what_a_link_may_bear_is_the_options_or_the_scenes(capsys, scene):
    def factors(*more):
        rows = shown(capsys, "stress", scene, "--speed", "30 rad/s", *more).splitlines()[1:4]
        return {row.split()[0]: row.split()[-1] for row in rows}

    assert set(factors().values()) == {"-"}
    option = factors("--limit", "250 MPa")
    given = factors("--set", "material.limit_stress=250 MPa")
    assert option == given
    own = factors("--set", "material.limit_stress=250 MPa", "--set", "crank.limit_stress=500 MPa")
    assert float(own["crank"]) == pytest.approx(2.0 * float(given["crank"]), rel=1e-3)
    assert own["coupler"] == given["coupler"]
