"""Emitted functions as compiled loops: the same operations, values, shapes and types."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import math
import pickle
import sys
import types
from pathlib import Path

import elastolink as el
import elastolink.generated
import numpy as np
import pytest
from compiled_loops import NEEDS_NUMBA, emitted
from elastolink.runtime.compiled import (
    compiled,
    compiled_function,
    compiled_module,
    layouts,
    store,
)
from elastolink.runtime.compiled.rewriting import loop_of
from elastolink.runtime.core.errors import BadInput

pytestmark = [
    pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning"),
    pytest.mark.usefixtures("loop_cache"),
    NEEDS_NUMBA,
]

SCENE = "smith_1972_5152_sixteenth_inch"


def _tuple(returned: object) -> tuple:
    return returned if isinstance(returned, tuple) else (returned,)


@pytest.fixture(scope="module")
def motion():
    return compiled_function(emitted("four_bar_kinematics").motion)


def _check(function, call, *arguments, **named) -> None:
    wanted, found = _tuple(function(*arguments, **named)), _tuple(call(*arguments, **named))
    assert len(found) == len(wanted)
    for one, other in zip(found, wanted, strict=True):
        assert type(one) is type(other)
        assert np.shape(one) == np.shape(other)
        assert getattr(one, "dtype", None) == getattr(other, "dtype", None)
        np.testing.assert_allclose(one, other, rtol=1e-13, atol=1e-13)


ANGLES = np.linspace(0.1, 6.0, 12)
LENGTHS = {"frame": 0.381, "crank": 0.0762, "coupler": 0.381, "follower": 0.1524}
SHAPES = {
    "a number": 0.7,
    "NumPy's number": np.float64(0.7),
    "no axis": np.array(0.7),
    "one point": np.array([0.7]),
    "one point with axes": np.array([[[0.7]]]),
    "an axis": ANGLES,
    "two axes": ANGLES.reshape(3, 4),
    "every other": np.linspace(0.1, 6.0, 24)[::2],
    "backwards": ANGLES[::-1],
    "transposed": ANGLES.reshape(3, 4).T,
    "of Fortran": np.asfortranarray(ANGLES.reshape(3, 4)),
    "spread": np.broadcast_to(ANGLES[:4], (3, 4)),
    "read only": np.frombuffer(ANGLES.tobytes()),
    "empty": np.empty(0),
    "empty with axes": np.empty((3, 0, 2)),
    "more than a block": np.linspace(-9.0, 9.0, 2 * layouts._BLOCK + 5),
    "other precision": ANGLES.astype(np.float32),
    "more precision": ANGLES.astype(np.longdouble),
    "whole": np.arange(4),
    "swapped bytes": ANGLES.astype(">f8"),
}


@pytest.mark.parametrize("kind", SHAPES)
def test_shapes_and_types_are_those_of_the_function(kind, motion) -> None:
    """Whatever the angle is given as, lengths being numbers."""
    for one in (1, 1.0, np.float64(1.0), np.array(1.0)):
        given = {**LENGTHS, "assembly": one, "winding": 0}
        _check(motion.function, motion, SHAPES[kind], **given)


def test_arguments_broadcast_against_each_other(motion) -> None:
    """Rows against columns, also through more than one block; outputs keep the axes they need."""
    wide = np.linspace(0.0, 6.0, layouts._BLOCK)
    for theta, crank in (
        (ANGLES[:, None], np.array([0.07, 0.08, 0.09])),
        (wide[None, :], np.array([[0.07], [0.08], [0.09]])),
        (np.array([0.7]), np.full((2, 1, 3), 0.07)),
        (np.float64(0.7), np.array([0.07])),
    ):
        _check(motion.function, motion, theta, **{**LENGTHS, "crank": crank}, assembly=1, winding=0)


def test_outputs_depend_on_what_they_depend_on() -> None:
    """Constants stay plain numbers; what does not see an array is no array."""
    module = emitted("beam_element_cubic")
    call, names = compiled_function(module.element), inspect.signature(module.element).parameters
    rng = np.random.default_rng(5)
    numbers = dict(zip(names, rng.uniform(0.5, 2.0, len(names)).tolist(), strict=True))
    _check(module.element, call, **numbers)
    for name in names:
        _check(module.element, call, **{**numbers, name: rng.uniform(0.5, 2.0, (2, 1, 3))})
        for other in names:
            both = {name: rng.uniform(0.5, 2.0, (4, 1)), other: rng.uniform(0.5, 2.0, 3)}
            _check(module.element, call, **{**numbers, **both})


def test_a_call_is_refused_as_the_function_refuses_it(motion) -> None:
    for arguments, named in (
        ((), {}),
        ((1.0,) * 9, {}),
        ((1.0,) * 7, {"frame": 1.0}),
        ((), {"a": 1}),
    ):
        with pytest.raises(TypeError) as wanted:
            motion.function(*arguments, **named)
        with pytest.raises(TypeError) as found:
            motion(*arguments, **named)
        assert str(found.value) == str(wanted.value)
    with pytest.raises(ValueError, match="broadcast"):
        motion(np.zeros(3), np.ones(2), 1.0, 1.0, 1.0, 1.0, 0.0)


def test_a_compiled_function_looks_like_the_function(motion) -> None:
    assert inspect.signature(motion) == inspect.signature(motion.function)
    assert motion.__doc__ == motion.function.__doc__
    assert motion.__name__ == "motion"
    assert compiled_function(motion.function) is motion
    assert compiled_function(motion) is motion
    assert pickle.loads(pickle.dumps(motion)) is motion


def test_the_same_call_gives_the_same_bytes(motion) -> None:
    """And a point has the value it has among others, wherever a block ends."""
    theta = np.linspace(-9.0, 9.0, layouts._BLOCK + 700)
    rest = (*LENGTHS.values(), 1.0, 0.0)
    whole = np.array(motion(theta, *rest))
    assert np.array_equal(whole, np.array(motion(theta.copy(), *rest)))
    parts = [np.array(motion(part, *rest)) for part in np.split(theta, 4)]
    assert np.array_equal(whole, np.concatenate(parts, axis=1))
    alone = [motion(float(value), *rest) for value in theta[::150]]
    assert np.array_equal(whole[:, ::150], np.array(alone).T)


# Emitted modules that are not like ours.
HEAD = """import numpy as np
FAMILY = "closed_form"
CONTENT = "{name}"
RETURNS = {{"f": ("y",)}}
def _namespace(array):
    return np
"""
ODD = {
    "def f(x):\n    for k in range(3):\n        x = x + k\n    return x": "line 8: for k in range",
    "def f(x):\n    xp = _namespace(x)\n    return xp.sum(x)": "line 9: xp.sum",
    "def f(x, y=2):\n    return x": "arguments that are not plain",
    "def f(*x):\n    return x[0]": "arguments that are not plain",
    "def f():\n    return 1.0": "no argument",
    "def f(x):\n    x + 1": "no value returned",
    "def f(x):\n    return x + other": "line 8: other",
    "def f(x):\n    return (x > 1) * x": "arithmetic with x > 1",
    "def f(x):\n    return x > 1": "a comparison returned",
    "def f(x):\n    xp = _namespace(x)\n    return xp.where(x, 1.0, x)": "a choice by x",
    "def f(x):\n    return np.sin(x)": "line 8: np.sin",
    "def f(x):\n    return x // 2": "line 8: x // 2",
    "def f(_k):\n    return _k": "_k",
}


def _module(folder: Path, text: str, name: str) -> types.ModuleType:
    path = folder / f"{name}.py"
    path.write_text(HEAD.format(name=name) + text + "\n")
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules[name] = module
    return module


@pytest.mark.parametrize("text", ODD)
def test_another_kind_of_function_is_refused(text, tmp_path) -> None:
    """In one line that tells where; nothing is compiled."""
    name = f"odd_{list(ODD).index(text)}"
    try:
        module = _module(tmp_path, text, name)
        with pytest.raises(BadInput) as refusal:
            compiled_function(module.f)
    finally:
        del sys.modules[name]
    assert f"{name}.f: found " in str(refusal.value)
    assert ODD[text] in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_function_that_was_not_emitted_is_refused() -> None:
    for other in (
        [1.0],
        None,
        math.sin,
        np.sin,
        len,
        "sin",
        _tuple,
    ):
        with pytest.raises(BadInput, match="expected a function of an emitted module"):
            compiled_function(other)
    for other in ({}, None, math):
        with pytest.raises(BadInput, match="expected an emitted module"):
            compiled_module(other)


def test_a_module_of_ones_own_is_compiled(tmp_path) -> None:
    """From any folder; constants and arguments come back as they are."""
    text = (
        "def f(x, n, t):\n    a = 3 / 2\n    del n\n    xp = _namespace(x)\n"
        "    return (a, a * 2, x, -x, x % 2, xp.where(t >= x, 1, x), 1 / x, a**2)"
    )
    module = _module(tmp_path, text, "own_module")
    try:
        call = compiled_function(module.f)
        for x in (1.5, 2, np.float64(0.7), np.array(0.7), ANGLES):
            _check(module.f, call, x, 1, np.array([0.5, 2.0])[:, None])
            _check(module.f, call, x, 1.0, 0.5)
        assert call(2.0, 1.0, 1.0)[0] == 1.5
        assert call(ANGLES, 1.0, 1.0)[2] is ANGLES
    finally:
        del sys.modules["own_module"]


def test_a_file_that_changed_is_refused(tmp_path) -> None:
    """The loop would be that of other equations."""
    module = _module(tmp_path, "def f(x):\n    return 2 * x", "changing")
    try:
        path = tmp_path / "changing.py"
        path.write_text(path.read_text().replace('"changing"', '"changed"'))
        with pytest.raises(BadInput, match="a file that changed since it was loaded"):
            compiled_function(module.f)
        path.unlink()
        with pytest.raises(BadInput, match="no source"):
            compiled_function(module.f)
    finally:
        del sys.modules["changing"]


def test_without_numba_the_extra_is_named(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    system = el.load_scene(SCENE).system()
    module = emitted("hill_plain")
    for ask in (
        lambda: compiled(system),
        lambda: compiled_function(module.scales),
        lambda: compiled_module(module),
    ):
        with pytest.raises(BadInput, match=r"pip install 'elastolink\[fast\]'") as refusal:
            ask()
        assert "\n" not in str(refusal.value)


def test_numba_that_shall_not_compile_is_refused(monkeypatch) -> None:
    import numba

    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    with pytest.raises(BadInput, match="unset NUMBA_DISABLE_JIT"):
        compiled(el.load_scene(SCENE).system())


def test_files_are_whole_and_right_ones_are_left_alone(loop_cache) -> None:
    """A damaged file is written again; numba takes a newer one for another function."""
    loop = loop_of(emitted("hill_plain").scales)
    store.compile_loop(loop)
    (path,) = store.folder().glob("hill_plain_scales_*.py")
    assert path.read_text() == loop.text
    assert store.folder().is_relative_to(loop_cache)
    before, made = path.stat().st_mtime_ns, store.compilations()
    store.compile_loop(loop)
    assert path.stat().st_mtime_ns == before
    assert store.compilations() == made
    path.write_text(loop.text[: len(loop.text) // 2])
    store.compile_loop(loop)
    assert path.read_text() == loop.text
    assert [p.name for p in store.folder().iterdir() if p.name.startswith(".")] == []


def test_a_folder_that_cannot_be_written_is_done_without(tmp_path, monkeypatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    run = store.compile_loop(loop_of(emitted("hill_plain").scales))
    out, wanted = np.empty(3), emitted("hill_plain").scales(2.0, 3.0, 0.5)
    places = np.zeros(12, dtype=np.int64)
    places[::2] = [0, 1, 2, 0, 1, 2]
    run(1, places, np.array([2.0, 3.0, 0.5]), out)
    assert out.tolist()[: len(_tuple(wanted))] == list(_tuple(wanted))
