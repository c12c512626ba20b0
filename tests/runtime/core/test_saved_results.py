"""Every class of results: saved and loaded, as a table, in a notebook, as a picture."""

import gc
import json
import re
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path

import elastolink as el
import numpy as np
import pandas as pd
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.files import NotSaved
from elastolink.runtime.core.results import Check, Result
from every_result import MAKERS, made, result_classes
from fresh_process import python

# What a file cannot hold: functions, and what is made of them.
FUNCTIONS = {
    "FrameFrequencies": r"(modes\.\d+\.)?problem\..*",
    "Gallery": r"shown\.\d+\.entry\.draw",
    "PeriodicOrbit": "source",
    "ResponseCurve": r"source|(special_)?orbits\.\d+\.swept",
    "RunUp": "run",
    "SteadyState": "shapes",
}
# Those that take longer than half a second to make.
SLOW = {
    *[
        "Basins",
        "Campbell",
        "Certificate",
        "CoexistingMotions",
        "Identification",
        "QuietSpeeds",
        "RunningSpeed",
        "Stabilisation",
        "StressEffect",
        "TongueCurves",
        "Transient",
    ]
}
CASES = [pytest.param(kind, marks=pytest.mark.slow if kind in SLOW else ()) for kind in MAKERS]


def test_there_is_one_of_every_class():
    assert {kind.__name__ for kind in result_classes()} == set(MAKERS)


def differences(one, other, path=""):
    """Yield the places at which two values are not the same to the last bit."""
    if isinstance(other, NotSaved):
        yield f"{path} is not saved"
    elif isinstance(one, np.ndarray | np.generic):
        same = type(one) is type(other) or isinstance(one, np.memmap)
        same = same and one.dtype == other.dtype and one.shape == other.shape
        if same and one.dtype.kind in "cf":
            parts = [np.atleast_1d(v).ravel().view(f"f{v.dtype.alignment}") for v in (one, other)]
            one, other = (np.where(np.isnan(v), np.nan, v) for v in parts)  # NaN has many forms
        if not same or one.tobytes() != other.tobytes():
            yield path
    elif isinstance(one, Mapping):
        if list(one) != list(other):
            yield path
        for key in {*one} & {*other}:
            yield from differences(one[key], other[key], f"{path}.{key}")
    elif type(one) is not type(other):
        yield f"{path}: {type(other)} for {type(one)}"
    elif isinstance(one, list | tuple):
        if len(one) != len(other):
            yield path
        for i, (a, b) in enumerate(zip(one, other, strict=False)):
            yield from differences(a, b, f"{path}.{i}")
    elif is_dataclass(one):
        for item in fields(one):
            place = f"{path}.{item.name}" if path else item.name
            yield from differences(getattr(one, item.name), getattr(other, item.name), place)
    elif isinstance(one, float):
        if one.hex() != other.hex():
            yield path
    elif one != other:
        yield path


def comes_back(kind, result, tmp_path):
    """Check that files hold all of a result, to the last bit."""
    for ending in ("npz", "json", "nc"):
        loaded = el.load(result.save(tmp_path / f"result.{ending}"))
        for place in differences(result, loaded):
            assert re.fullmatch(f"({FUNCTIONS.get(kind)}) is not saved", place), (ending, place)
        assert list(differences(result.arrays(), loaded.arrays())) == []
        assert repr(loaded) == repr(result) and loaded.passed == result.passed
        assert loaded.to_dict() == result.to_dict()


def read_by_pandas(result, tmp_path):
    """Check that tables hold all arrays, under their names and units."""
    result.save(tmp_path / "result.csv")
    units, arrays = result.units_of_columns(), result.arrays()
    seen = set()
    for path in tmp_path.glob("result*.csv"):
        table = pd.read_csv(path)
        assert len(table) and not any("Unnamed" in str(name) for name in table.columns)
        for header in table.columns:
            name, _, unit = str(header).removesuffix("]").partition(" [")
            part = name.removesuffix("_real").removesuffix("_imag")
            name = part if part in arrays and np.iscomplexobj(arrays[part]) else name
            if name not in arrays:
                continue
            assert unit == units.get(name, "")
            seen.add(name)
            array, column = arrays[name], table[header]
            if array.dtype.kind == "U":
                assert {*map(str, column.fillna(""))} == {*array.ravel().tolist()}
                continue
            numbers = np.unique(array.imag if str(header).find("_imag") > 0 else array.real)
            read = np.unique(column.to_numpy().astype(numbers.dtype))
            # pandas is wrong by a unit in the last place now and then.
            np.testing.assert_allclose(read, numbers, rtol=1e-14, atol=1e-300)
    assert seen == {name for name, array in arrays.items() if array.size}


def shown_in_a_notebook(result):
    assert len(repr(result).splitlines()) <= 10
    page = result._repr_html_()
    assert page.startswith("<table>") and page.count("<tr>") <= 9 and "<th>error" in page
    drawn = type(result).plot is not Result.plot
    assert page.endswith('">' if drawn else "</table>") and page.count("<img") == drawn


def axes_are_named(axes):
    """Check that each axis with numbers says what they are."""
    for one in axes.figure.axes:
        for axis in (one.xaxis, one.yaxis):
            text = axis.get_label_text()
            ticks = [label.get_text() for label in axis.get_majorticklabels()]
            numbers = [tick for tick in ticks if re.fullmatch(r"[-−\d.]+|\$.*\$", tick)]
            assert text or not numbers or not axis.get_visible(), ticks
            assert "coordinate" not in text and not re.search(r", 1\b|\[1\]|\[\]|rad,", text)


@dataclass(frozen=True, kw_only=True)
class Odd(Result):
    values: object


def test_odd_values_come_back(tmp_path):
    given = {
        "numbers": (1, 2.5, -0.0, float("nan"), float("-inf"), 1e-300, 10**30, True, None),
        "complex": complex(-0.0, float("inf")),
        ("a", "b"): [np.float32(0.1), np.int8(3), np.bool_(True), np.complex128(1j)],
        "arrays": (
            np.array([[np.nan, np.inf], [-0.0, 0.1]]),
            np.zeros((0, 3)),
            np.array(["ä", ""]),
        ),
        "complex arrays": np.array([complex(np.nan, -np.inf), complex(-0.0, 0.0)], np.complex64),
        "turned": np.arange(6.0).reshape(2, 3).T,
        "place": Path("a/b"),
        "check": Check(0.5, 1.0),
    }
    odd = Odd(method="", error=np.float64(0.1), error_norm="", values=given)
    for ending in ("npz", "json", "nc"):
        loaded = el.load(odd.save(tmp_path / f"odd.{ending}"))
        assert type(loaded) is Odd and list(differences(odd, loaded)) == []
        assert not loaded.values["turned"].flags.writeable


def test_what_is_no_data_says_so_when_it_is_used(tmp_path):
    loaded = el.load(made("SteadyState").save(tmp_path / "state.npz"))
    with pytest.raises(BadInput, match="shapes: found a result that was loaded"):
        loaded.peak()
    lambdas = Odd(method="", error=0.0, error_norm="", values={"f": lambda x: x})
    loaded = el.load(lambdas.save(tmp_path / "f.json"))
    with pytest.raises(BadInput, match=r"values\.f: found a result that was loaded"):
        loaded.values["f"](1.0)


def test_a_fresh_process_loads_it_without_matplotlib_and_sympy(tmp_path):
    path = made("Classification").save(tmp_path / "class.npz")
    code = (
        f"import sys, elastolink as el; found = el.load({str(path)!r})\n"
        "print(type(found).__name__, {'matplotlib', 'sympy', 'pandas'} & {*sys.modules})"
    )
    assert python(code) == "Classification set()\n"


# xarray leaves files open that it cannot read.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("ending", ["npz", "json", "nc"])
def test_a_damaged_file_is_refused_in_one_line(tmp_path, ending):
    path = made("Mobility").save(tmp_path / f"m.{ending}")
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    for cut in rng.integers(0, len(whole) - 1, 20):
        path.write_bytes(whole[:cut])
        with pytest.raises(BadInput, match="a file that save") as refusal:
            el.load(path)
        assert "\n" not in str(refusal.value)
    del refusal
    gc.collect()


def test_other_files_are_refused(tmp_path):
    with pytest.raises(BadInput, match="CSV files hold the numbers alone"):
        el.load(made("Mobility").save(tmp_path / "m.csv"))
    with pytest.raises(BadInput, match="no such file"):
        el.load(tmp_path / "none.npz")
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    with pytest.raises(BadInput, match="cannot be read"):
        el.load(tmp_path / "other.npz")
    np.savez(tmp_path / "pickled.npz", elastolink=np.array([print], dtype=object))
    with pytest.raises(BadInput, match="allow_pickle"):
        el.load(tmp_path / "pickled.npz")


def changed(path, *pairs):
    """Write the record of a JSON file anew, with words replaced."""
    plain = json.loads(path.read_text())
    for before, after in pairs:
        assert before in plain["elastolink"]
        plain["elastolink"] = plain["elastolink"].replace(before, after)
    path.write_text(json.dumps(plain))
    return path


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('"format": 1', '"format": 2', "of elastolink .* .ValueError: format 2"),
        ('"gruebler"', '"grubler"', "fields .'grubler', 'gruebler'. of Mobility"),
        ("linkages.degrees_of_freedom:Mobility", "linkages.nowhere:Mobility", "nowhere"),
        ("elastolink.runtime.linkages.degrees_of_freedom:Mobility", "this:X", "class this:X"),
        ("degrees_of_freedom:Mobility", "degrees_of_freedom:np", "class .*:np"),
        ("elastolink.runtime.linkages.degrees_of_freedom:Mobility", "subprocess:Popen", "Popen"),
    ],
)
def test_files_of_other_versions_and_foreign_classes_are_refused(tmp_path, before, after, words):
    path = changed(made("Mobility").save(tmp_path / "m.json"), (before, after))
    with pytest.raises(BadInput, match=words) as refusal:
        el.load(path)
    assert "\n" not in str(refusal.value)


def test_no_module_is_imported_at_the_word_of_a_file(tmp_path):
    name = "elastolink.runtime.linkages.degrees_of_freedom:Mobility"
    path = changed(made("Mobility").save(tmp_path / "m.json"), (name, "antigravity:Result"))
    code = (
        "import sys, elastolink as el\n"
        f"try: el.load({str(path)!r})\n"
        "except el.BadInput: print('antigravity' in sys.modules)"
    )
    assert python(code) == "False\n"


def test_tables_that_do_not_fit_stand_in_files_beside(tmp_path):
    edges = made("StabilityEdges")
    edges.save(tmp_path / "edges.csv")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["edges.csv"]
    table = pd.read_csv(tmp_path / "edges.csv")
    assert list(table["lower [rad/s]"].unique()) == pytest.approx(edges.lower.tolist(), rel=1e-14)
    frequencies = made("NaturalFrequencies")
    frequencies.save(tmp_path / "f.csv")
    table = pd.read_csv(tmp_path / "f.csv")
    assert len(table) == frequencies.frequency.size
    wide = table["frequency [rad/s]"].to_numpy().reshape(frequencies.frequency.shape)
    np.testing.assert_allclose(wide, frequencies.frequency, rtol=1e-14)
    assert (tmp_path / "f.angle_coordinate_curve.csv").exists()


def test_the_zip_of_an_npz_holds_no_pickle(tmp_path):
    path = made("Flywheel").save(tmp_path / "f.npz")
    with zipfile.ZipFile(path) as held:
        assert all(b"'|O'" not in held.read(name)[:200] for name in held.namelist())
    assert list(differences(made("Flywheel"), replace(el.load(path)))) == []


def units_are_those_of_the_docstring(result):
    """Check that what the docstring says of one array, ``[m]``, is what its column says."""
    words, arrays, units = type(result).__doc__, result.arrays(), result.units_of_columns()
    text = re.split(r"\n\s+Attributes\n\s+-+\n", words)[-1].split("\n    Notes\n")[0]
    for block in re.split(r"\n(?=    \w)", text):
        names, colon, says = block.strip().partition(" : ")
        found = set(re.findall(r"\[([a-zA-Z][\w/^ ]*)\]", says)) - {"SI"}
        if colon and names in arrays and len(found) == 1:
            assert {units.get(names, "")} == found, names


@pytest.mark.parametrize("kind", CASES)
def test_each_result(kind, tmp_path):
    result = made(kind)
    comes_back(kind, result, tmp_path)
    read_by_pandas(result, tmp_path)
    shown_in_a_notebook(result)
    if type(result).plot is not Result.plot:
        axes_are_named(result.plot())
    if kind != "Sensitivities":  # of its value there are many units
        units_are_those_of_the_docstring(result)
