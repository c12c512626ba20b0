"""What every result does: checks, JSON, CSV."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.results import Check, DeferredChecks, Result, provenance


@dataclass(frozen=True, kw_only=True)
class Sample(Result):
    x: np.ndarray
    y: np.ndarray
    table: np.ndarray
    odd: np.ndarray
    marks: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    dimensions: ClassVar = {"x": ("x",), "y": ("y",), "table": ("y", "x"), "odd": ("odd",)}
    exported: ClassVar = ("largest",)

    @property
    def largest(self):
        return float(np.nanmax(self.table))


def sample(**changes):
    given = {
        "method": "by hand",
        "error": 0.5,
        "error_norm": "absolute",
        "x": np.array([1.0, 2.0, 3.0]),
        "y": np.array([10.0, 20.0]),
        "table": np.array([[11.0, 12.0, 13.0], [21.0, 22.0, 23.0]]),
        "odd": np.array([7, 8]),
    }
    return Sample(**{**given, **changes})


def test_csv_repeats_what_has_fewer_dimensions_and_parts_what_does_not_fit(tmp_path):
    first = sample().save(tmp_path / "s.csv").read_text()
    second = (tmp_path / "s.odd.csv").read_text()
    assert first.splitlines() == [
        "x,y,table,largest,error",
        "1.0,10.0,11.0,23.0,0.5",
        "2.0,10.0,12.0,23.0,0.5",
        "3.0,10.0,13.0,23.0,0.5",
        "1.0,20.0,21.0,23.0,0.5",
        "2.0,20.0,22.0,23.0,0.5",
        "3.0,20.0,23.0,23.0,0.5",
    ]
    assert second.splitlines() == ["odd", "7", "8"]


def test_csv_turns_axes(tmp_path):
    class Turned(Sample):
        dimensions: ClassVar = {**Sample.dimensions, "odd": ("x", "y")}

    given = {item: getattr(sample(), item) for item in ("method", "error", "error_norm", "x", "y")}
    turned = Turned(**given, table=sample().table, odd=sample().table.T)
    header, *rows = turned.save(tmp_path / "t.csv").read_text().splitlines()
    i, j = header.split(",").index("table"), header.split(",").index("odd")
    assert len(rows) == 6
    assert all(row.split(",")[i] == row.split(",")[j] for row in rows)


def test_csv_keeps_batches_and_matrices_apart(tmp_path):
    """Two speeds with two multipliers each: equal lengths of axes that are not the same."""

    class Plain(Sample):
        dimensions: ClassVar = {}

    two = np.array([1.0, 2.0])
    plain = Plain(method="", error=0.0, error_norm="", x=two, y=two, table=np.eye(2), odd=two)
    first = plain.save(tmp_path / "p.csv").read_text().splitlines()
    second = (tmp_path / "p.axis_0_of_2x2_axis_1_of_2x2.csv").read_text().splitlines()
    assert second[0] == "axis_0_of_2x2,axis_1_of_2x2,table"
    assert first[:2] == ["x,y,odd,largest,error", "1.0,1.0,1.0,1.0,0.0"]


def test_csv_of_an_empty_axis_is_its_header(tmp_path):
    empty = el.discriminant(el.PeriodicFunction([0.0, 1.0]), np.zeros(0), 1.0)
    lines = empty.save(tmp_path / "e.csv").read_text().splitlines()
    assert len(lines) == 1 and "value" in lines[0].split(",")


def test_json_holds_mappings_and_exported_properties():
    found = sample(marks={"measured": (1.0, np.inf)}).to_dict()
    assert found["marks"] == {"measured": [1.0, None]}
    assert found["largest"] == 23.0


def test_netcdf_splits_complex_arrays(tmp_path):
    xarray = pytest.importorskip("xarray")
    path = sample(x=np.array([1.0 + 2.0j, -3.0j, 4.0])).save(tmp_path / "r.nc")
    with xarray.open_dataset(path) as kept:
        assert kept["x_real"].dims == kept["x_imag"].dims == ("x",)
        np.testing.assert_array_equal(kept["x_real"].values, [1.0, 0.0, 4.0])
        np.testing.assert_array_equal(kept["x_imag"].values, [2.0, -3.0, 0.0])
        np.testing.assert_array_equal(kept["table"].values, sample().table)
        assert "x" not in kept.variables


def test_it_is_shown_in_ten_lines_at_most():
    plain = sample(odd=np.array([7.0, np.nan, 9.0, 8.0, 1.0]), y=np.array([3.0 + 4.0j] * 6))
    assert repr(plain).split("\n") == [
        "Sample: by hand",
        "  x: [1., 2., 3.]",
        "  y: shape (6,), sizes 5 to 5",
        "  table: shape (2, 3) 11 to 23",
        "  odd: shape (5,) 1 to 9, 1 not finite",
        "  error: 0.5 (absolute)",
        "  checks: passed",
    ]
    failed = sample(checks={"loop": Check(2.0, 1.0), "trace": Check(0.0, 1.0)})
    assert repr(failed).endswith("\n  checks: failed: loop")


def test_systems_and_what_is_made_of_them_are_shown_in_a_few_lines():
    system = el.load_scene("smith_1972_5152_thirtysecond_inch", {"model.modes": 9}).system()
    system = system.with_parameters(damping=1.0)
    assert repr(system).startswith("LinearPeriodic(Y1/l3, Y2/l3, ..., Y9/l3; arrays M, ")
    motion, ready = el.steady_state(system, 30.0), el.prepare(system, (30.0, 31.0))
    assert repr(ready).startswith("Prepared: 30 to 31 rad/s, tables: 1, error: ")
    deferred = repr(motion)
    assert deferred.endswith("checks: made when they are looked at") and motion.passed
    assert repr(motion).endswith("checks: passed")
    for shown in (system, motion, ready, el.FourBar(0.3, 0.1, 0.3, 0.3).motion([0.0, 1.0])):
        assert len(repr(shown)) < 1000 and repr(shown).count("\n") < 10


def test_without_checks_it_passes_and_says_so():
    assert sample().passed and not sample().checks


def test_deferred_checks_are_made_once():
    calls = []

    def make():
        calls.append(1)
        return {"a": Check(2.0, 1.0)}

    found = sample(checks=DeferredChecks(make))
    assert not calls
    assert not found.passed and found.to_dict()["passed"] is False and len(found.checks) == 1
    assert len(calls) == 1


def test_provenance_names_versions():
    assert provenance()["numpy"] == np.__version__
    assert provenance({"scene": "x"})["scene"] == "x"


def test_what_comes_after_changes_no_answer():
    """Arrays of a result are its own: not those that were given, and read-only."""
    theta = np.linspace(0.0, 6.0, 7)
    linkage = el.FourBar(0.3, 0.1, 0.28, 0.25)
    motion = linkage.motion(theta)
    theta[0] = 9.0
    assert motion.theta2[0] == 0.0
    run = el.simulate(el.load_scene("mathieu").system(), 1.0, 1.0, initial=(np.array([1.0]), 0.0))
    for result in (motion, run):
        held = [value for value in vars(result).values() if isinstance(value, np.ndarray)]
        assert len(held) > 3 and not any(value.flags.writeable for value in held)
    with pytest.raises(ValueError, match="read-only"):
        motion.theta3[0] = 0.0
