"""Moving pictures: frames, bytes, what is drawn where, and refusals before any work."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank, pictures
from elastolink.runtime.linkages.circuits import Circuit
from elastolink.runtime.linkages.curves import coupler_curve
from elastolink.runtime.linkages.pictures import animate
from PIL import Image

FOUR_BAR = FourBar(2.0, 1.0, 2.0, 2.0)
ROCKER = FourBar(3.0, 2.0, 1.0, 1.5)
SLIDER = SliderCrank(1.0, 3.0, 0.3)
ROD = QuickReturn(2.0, 1.0, 4.0)


@pytest.mark.parametrize(
    ("linkage", "link"), [(FOUR_BAR, "coupler"), (ROCKER, "coupler"), (SLIDER, "coupler")]
)
def test_frames_and_bytes(tmp_path, linkage, link):
    curve = coupler_curve(linkage, 1.0, 0.5, link=link)
    first = animate(linkage, tmp_path / "one.gif", curves=[curve], frames=4, fps=20)
    second = animate(linkage, tmp_path / "two.gif", curves=[curve], frames=4, fps=20)
    assert first.read_bytes() == second.read_bytes()
    with Image.open(first) as picture:
        assert picture.n_frames == 4
        assert picture.info["duration"] == 50
        assert picture.info["loop"] == 0
        stills = []
        for i in range(4):
            picture.seek(i)
            stills.append(np.asarray(picture.convert("RGB")))
    assert all(np.any(stills[0] != still) for still in stills[1:])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one.gif", "two.gif"]


def test_the_bars_are_those_of_the_motion():
    for s in np.linspace(0.1, 6.0, 7):
        motion = FOUR_BAR.motion(s)
        drawn = pictures._bars(Circuit(FOUR_BAR), s)
        joints = {name: complex(*np.asarray(place)) for name, place in motion.joints.items()}
        assert drawn["crank"] == pytest.approx([joints["A"], joints["B"]], abs=1e-14)
        assert drawn["coupler"] == pytest.approx([joints["B"], joints["C"]], abs=1e-14)
        assert drawn["follower"] == pytest.approx([joints["D"], joints["C"]], abs=1e-14)


def test_slider_and_block_keep_their_place():
    drawn = pictures._bars(Circuit(SLIDER), 0.7)
    corners = drawn["slider"][:-1]
    assert np.mean(corners) == pytest.approx(drawn["coupler"][1], abs=1e-14)
    assert np.mean(corners).imag == pytest.approx(0.3, abs=1e-15)
    drawn = pictures._bars(Circuit(ROD), 0.7)
    corners = drawn["block"][:-1]
    assert np.mean(corners) == pytest.approx(drawn["crank"][1], abs=1e-14)
    # Two sides of the block run along the rod.
    along = np.angle(drawn["rod"][1] - drawn["rod"][0])
    assert np.angle(corners[0] - corners[1]) == pytest.approx(along, abs=1e-14)
    assert abs(drawn["rod"][1] - drawn["rod"][0]) == pytest.approx(4.0, abs=1e-14)


def test_quick_return_with_two_paths(tmp_path):
    curves = [coupler_curve(ROD, 0.5, 0.2, link="block"), coupler_curve(ROD, 4.0, link="rod")]
    path = animate(ROD, tmp_path / "rod.gif", curves=curves, frames=2)
    assert path.read_bytes()[:6] == b"GIF89a"


@pytest.mark.parametrize(
    ("path", "options", "word"),
    [
        ("a.png", {}, "gif"),
        ("missing/a.gif", {}, "writable"),
        ("a.gif", {"frames": 1}, "frames"),
        ("a.gif", {"fps": 0}, "fps"),
        ("a.gif", {"circuit": 2}, "circuit"),
        ("a.gif", {"curves": ["x"]}, "curves"),
        ("a.gif", {"curves": [coupler_curve(SLIDER, 1.0)]}, "another linkage"),
    ],
)
def test_refusals_write_nothing(tmp_path, path, options, word):
    with pytest.raises(BadInput, match=word):
        animate(FOUR_BAR, tmp_path / path, **options)
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_picture_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "old.gif"
    path.write_bytes(b"old")

    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(pictures._Film, "picture", stop)
    with pytest.raises(KeyboardInterrupt):
        animate(FOUR_BAR, path, frames=3)
    assert path.read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 1
