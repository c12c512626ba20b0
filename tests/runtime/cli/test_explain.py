"""``elastolink explain``: each figure against what it claims to count."""

import json
from importlib import import_module
from pathlib import Path

import elastolink as el
import elastolink.generated
import numpy as np
import pytest
from elastolink.runtime.cli import main, probe
from elastolink.runtime.cli.explanation import Explanation, explain, read_cost
from elastolink.runtime.core.errors import BadInput
from fresh_process import python

GENERATED = Path(elastolink.generated.__path__[0])
RIG = "smith_1972_5152_sixteenth_inch"


@pytest.fixture(scope="module")
def coupler():
    return explain(el.load_scene(RIG))


@pytest.fixture(scope="module")
def slider():
    return explain("slider_crank_example")


def skipped_arrays(found):
    """Return the arrays that are absent or zero, and never added up."""
    return {name for name, kind in found.array_kinds.items() if kind in {"absent", "zero"}}


def test_sizes_and_counts_are_those_of_the_emitted_files(coupler):
    assert list(coupler.emitted) == ["four_bar_coupler_complete"]
    use = coupler.emitted["four_bar_coupler_complete"]
    path = GENERATED / "four_bar_coupler_complete.py"
    assert use.size == path.stat().st_size
    module = import_module("elastolink.generated.four_bar_coupler_complete")
    assert set(use.functions) == set(module.__all__)
    assert use.operations == sum(use.functions.values())
    files = [file for file in GENERATED.glob("*.py") if file.stem != "__init__"]
    assert coupler.packaged[0] == len(files)
    assert coupler.packaged[1] == sum(file.stat().st_size for file in files)


def test_arrays_are_told_apart_as_the_system_has_them(coupler):
    system = el.load_scene(RIG).system()
    theta = np.linspace(0.0, 2 * np.pi, 17)
    for array, kind in coupler.array_kinds.items():
        values = system.array(array, theta)
        assert (kind == "absent") == (not system.has(array))
        if kind in {"absent", "zero"}:
            assert not np.any(values)
        else:
            assert (kind == "constant") == bool(np.ptp(values, axis=0).max() == 0.0)
    assert coupler.array_kinds["M"] == "constant" and coupler.array_kinds["B"] == "periodic"
    assert skipped_arrays(coupler) >= {"A", "Kg", "C"}


def test_what_a_sweep_shares_is_every_term_that_acts_at_constant_speed(coupler):
    system = el.load_scene(RIG).system()
    acting = [term for row, term in enumerate(system.terms) if np.any(system.spectrum(row))]
    assert coupler.samples == sum(t.array not in {"S", "g", "C"} for t in acting)
    steady = {key: names for key, names in coupler.powers.items() if key != "acceleration"}
    assert sum(map(len, steady.values())) <= coupler.samples
    assert {name[0] for name in coupler.powers["acceleration"]} == {"S", "g"}
    # Twice the highest harmonic and more, or the product of samples would alias.
    assert coupler.angles > 2 * coupler.harmonics > 0


def test_nothing_of_the_symbolic_side_loads_and_nothing_twice(coupler, slider):
    for found in (coupler, slider):
        assert found.passed
        loaded = {name for stage in found.stages.values() for name in stage.heavy}
        assert not loaded & {"sympy", "matplotlib", "mpmath"}
    assert not any(stage.heavy for stage in coupler.stages.values())
    assert not slider.stages["scene"].heavy
    # And a question only what the ones before it did not.
    assert list(coupler.stages) == ["scene", "system", "floquet_multipliers", "steady_state"]
    asked = [stage for name, stage in slider.stages.items() if name.startswith("rigid_forces")]
    assert asked[0].modules > 0 and not any(stage.modules for stage in asked[1:])
    assert slider.stages["scene"].scipy < 20 and slider.stages["motion"].scipy == 0


def test_each_force_alone_calls_its_own_function(slider):
    functions = {
        "pins": "pin_forces",
        "torque": "driving_torque",
        "shaking_force": "shaking_force",
        "shaking_moment": "shaking_moment",
    }
    whole = slider.stages["rigid_forces everything"]
    (used,) = (name for name in slider.emitted if "forces" in name)
    assert whole.calls == {f"{used}.forces": 1}
    for output, function in functions.items():
        stage = slider.stages[f"rigid_forces {output}"]
        assert stage.calls == {f"{used}.{function}": 1}
        assert stage.points == {f"{used}.{function}": 64}
        assert stage.operations == 64 * slider.emitted[used].functions[function]
    # One module serves every machine at every speed.
    use = slider.emitted[used]
    assert use.dropped == () and use.kept == ("across", "crank_acceleration")
    assert use.operations == use.full_operations and use.size == use.full_size


@pytest.mark.slow
def test_a_general_module_says_which_terms_the_scene_drops():
    changes = {"model.formulation": "free_free", "model.modes": 2, "model.drop": ["as_printed"]}
    rod = explain("beale_1992_flexible_rod", changes)
    use = rod.emitted["quick_return_rod_free_free"]
    assert rod.terms == {"tension": "dropped"}
    assert use.dropped == ("tension",) and use.kept == ()
    assert (use.size, use.operations) == (use.full_size, use.full_operations)
    lines = rod.lines()
    at = next(i for i, line in enumerate(lines) if "quick_return_rod_free_free:" in line)
    assert lines[at + 1].strip() == "without tension" and "with every term" not in lines[at]
    # Of a module for any number of modes, what the modes fill counts as one entry.
    filled, entries = rod.array_kinds["dynamics.mass"].split(" of ")
    assert 0 < int(filled) < int(entries)


@pytest.mark.slow
def test_the_formulation_tells_what_it_leaves_out():
    found = explain(RIG, {"model.formulation": "reduced", "model.modes": 2})
    (use,) = found.emitted.values()
    assert set(use.left_out) == {"axial_inertia", "coupler_end_load", "spin"}
    assert any("left out by the formulation" in line for line in found.lines())


def test_the_command_prints_text_json_and_a_picture(capsys, tmp_path):
    picture = tmp_path / "explained.svg"
    assert main(["explain", "mathieu", "--json", "--plot", str(picture)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["array_kinds"]["Kg"] == "periodic" and found["passed"] is True
    assert found["stages"]["system"]["modules"] > 0
    assert found["emitted"]["hill_plain"]["operations"] == 0
    assert picture.read_text().startswith("<?xml")
    assert main(["explain", "mathieu", "--set", "parameters.damping=0.1"]) == 0
    out = capsys.readouterr().out
    assert all(f"\n{part}" in out for part in ("derivation", "emission", "import", "evaluation"))
    assert "speed^1: C: damping" in out and max(map(len, out.splitlines())) < 1000


def test_what_cannot_be_explained_is_refused():
    with pytest.raises(BadInput, match="a built-in scene"):
        explain("no_such_scene")
    with pytest.raises(BadInput, match="load the scene with them"):
        explain(el.load_scene("mathieu"), {"parameters.mu": 0.1})
    # A term may be dropped only where its module was made; the message tells how to make it.
    with pytest.raises(BadInput, match=r"regenerate-equations .*--spec"):
        explain(RIG, {"model.drop": ["spin"]})
    with pytest.raises(BadInput, match="no operation counts"):
        read_cost(Path(probe.__file__))


@pytest.mark.slow
def test_a_machine_without_masses_is_explained_as_far_as_it_goes():
    found = explain("smith_1972_2122")
    assert "no mass" in found.stages["machine"].refused
    assert list(found.emitted) == ["four_bar_kinematics"]
    assert found.stages["motion"].points == {"four_bar_kinematics.motion": 64}


def test_what_the_command_loads_is_not_counted_as_the_scene_s():
    code = (
        "import sys, elastolink.runtime.core.lazy, elastolink.runtime.scenes as scenes\n"
        "scenes.load_scene('mathieu')\n"
        "print(sum(name.startswith('elastolink') for name in sys.modules))"
    )
    assert explain("mathieu").stages["scene"].modules == int(python(code))


@pytest.mark.slow
def test_linkages_of_beams_are_explained_too():
    found = explain("aannaque_1996_table_4_1", {"mesh.elements": 1})
    assert isinstance(found, Explanation)
    assert {"beam_element_cubic", "four_bar_kinematics"} <= set(found.emitted)
    assert found.terms == {"geometric_stiffness": "kept", "turning": "kept"}
    # One element for each of three links.
    assert found.stages["system"].calls["beam_element_cubic.element"] == 3
    less = explain("aannaque_1996_table_4_1", {"mesh.elements": 1, "model.drop": ["as_printed"]})
    assert set(less.terms.values()) == {"dropped"}
    assert less.samples < found.samples
    assert skipped_arrays(less) > skipped_arrays(found)
