"""Coupler curves and their moving pictures: place, length, cusps, double points, cognates."""

import json
from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.linkages.curves import coupler_curve, sextic_residual
from elastolink.runtime.linkages.pictures import animate
from PIL import Image
from random_linkages import KINDS, random_linkage
from refusals import refused

CRANK_ROCKER = FourBar(2.0, 1.0, 2.0, 2.0)
CROSSED = FourBar(2.0, 1.0, 2.0, 2.0, "crossed")
DRAG_LINK = FourBar(2.0, 4.0, 4.5, 3.9)
TRIPLE_ROCKER = FourBar(2.0, 1.7, 1.0, 1.2)
DOUBLE_ROCKER = FourBar(2.0, 1.7, 1.0, 1.5)
INWARD_ROCKER = FourBar(3.0, 2.0, 1.0, 1.5)
TWO_RANGES = FourBar(3.0, 2.5, 1.0, 2.2)
SLIDER = SliderCrank(1.0, 3.0, 0.3)
ROD = QuickReturn(2.0, 1.0, 4.0)
ALL = [
    (CRANK_ROCKER, "coupler"),
    (DRAG_LINK, "follower"),
    (TRIPLE_ROCKER, "coupler"),
    (DOUBLE_ROCKER, "coupler"),
    (TWO_RANGES, "coupler"),
    (SLIDER, "slider"),
    (SliderCrank(2.0, 1.0, 0.3), "coupler"),
    (ROD, "rod"),
    (QuickReturn(1.0, 2.0, 4.0), "block"),
]


def complex_of(places):
    return np.asarray(places)[..., 0] + 1j * np.asarray(places)[..., 1]


@pytest.mark.parametrize(("linkage", "link"), ALL)
def test_agrees_with_the_motion_of_each_assembly(linkage, link):
    for circuit in (0, 1):
        try:
            curve = coupler_curve(linkage, 0.7, 0.4, link=link, circuit=circuit, points=64)
        except BadInput:
            assert circuit == 1
            continue
        assert curve.passed
        for branch in set(curve.branch):
            of = curve.branch == branch
            own = linkage
            if not isinstance(linkage, QuickReturn):
                own = replace(linkage, assembly="open" if branch > 0 else "crossed")
            motion = own.motion(curve.theta2[of])
            point = motion.point(link, 0.7, 0.4)
            # Towards a dead centre the emitted motion amplifies its round-off.
            loose = (1e-13 + 20 * motion.error)[:, None]
            assert np.all(np.abs(curve.position[of] - point.position) <= loose)
            for series, emitted in (
                (curve.velocity[of], point.velocity),
                (curve.acceleration[of], point.acceleration),
            ):
                size = np.maximum(1.0, np.max(np.abs(emitted), axis=1))[:, None]
                assert np.all(np.abs(series - emitted) <= loose * 200 * size**2)


@pytest.mark.smoke
@pytest.mark.parametrize("linkage", [CRANK_ROCKER, DRAG_LINK, SLIDER, ROD])
def test_the_crank_pin_runs_round_a_circle(linkage):
    crank = linkage.lengths["crank"]
    curve = coupler_curve(linkage, crank, link="crank")
    assert curve.length == pytest.approx(2 * np.pi * crank, rel=1e-14)
    assert curve.area == pytest.approx(np.pi * crank**2, rel=1e-14)
    assert curve.curvature == pytest.approx(np.full(720, 1 / crank), rel=1e-13)
    assert np.max(np.abs(curve.centre)) < 1e-14 * crank
    assert curve.slowest == pytest.approx(1.0, abs=1e-14)
    assert len(curve.cusp_theta2) == len(curve.double_theta2) == 0


@pytest.mark.parametrize("linkage", [TRIPLE_ROCKER, TWO_RANGES])
def test_a_swinging_crank_length_is_that_of_the_polygon(linkage):
    curve = coupler_curve(linkage, 0.7, 0.6)
    chords = []
    for count in (1_000, 2_000, 4_000):
        places = coupler_curve(linkage, 0.7, 0.6, points=count).position
        chords.append(np.sum(np.abs(np.diff(complex_of(places), append=complex_of(places[:1])))))
    # Chords fall short by terms of second and fourth order, which three of them cancel.
    coarse, fine = (4 * chords[1] - chords[0]) / 3, (4 * chords[2] - chords[1]) / 3
    assert curve.length == pytest.approx((16 * fine - coarse) / 15, rel=1e-11)


def test_arc_run_out_and_back():
    curve = coupler_curve(CRANK_ROCKER, 2.0, link="follower")
    motion = CRANK_ROCKER.motion(np.linspace(0, 2 * np.pi, 100_001))
    swing = np.ptp(motion.theta4)
    assert curve.length == pytest.approx(2 * 2.0 * swing, rel=1e-8)
    assert abs(curve.area) < 1e-14
    assert len(curve.cusp_theta2) == 2
    # At the ends crank and coupler lie in one line.
    ends = CRANK_ROCKER.motion(curve.cusp_theta2)
    assert np.sin(ends.theta3 - ends.theta2) == pytest.approx([0, 0], abs=1e-12)
    assert np.abs(curve.curvature) == pytest.approx(np.full(720, 0.5), rel=1e-9)


def pole_in_coupler(linkage, theta):
    """The instantaneous centre in the coupler's (the block's) axes: v + i w (z - origin) = 0."""
    name = "block" if isinstance(linkage, QuickReturn) else "coupler"
    at = linkage.motion(theta).link(name)
    arm = -complex(*at.velocity) / (1j * float(at.speed))
    return name, arm * np.exp(-1j * float(at.angle))


@pytest.mark.parametrize("linkage", [CRANK_ROCKER, CROSSED, DRAG_LINK, SLIDER, ROD])
@pytest.mark.parametrize("theta", [0.6, 4.5])
def test_cusp_where_the_point_is_the_pole(linkage, theta):
    name, place = pole_in_coupler(linkage, theta)
    curve = coupler_curve(linkage, place.real, place.imag, link=name)
    gaps = np.abs(np.exp(1j * (curve.cusp_theta2 - theta)) - 1)
    assert np.min(gaps, initial=9.0) < 1e-12
    at = linkage.motion(theta).point(name, place.real, place.imag)
    nearest = curve.cusp_position[np.argmin(gaps)]
    assert nearest == pytest.approx(at.position, abs=1e-12)
    assert not np.any(np.isnan(curve.curvature)) and not np.any(np.isnan(curve.centre))


@pytest.mark.parametrize("distance", [1e-3, 1e-9])
def test_near_a_cusp_the_path_has_a_loop_or_a_bend(distance):
    name, place = pole_in_coupler(CRANK_ROCKER, 0.6)
    at = CRANK_ROCKER.motion(0.6)
    # The moving centrode crosses the acceleration of its pole.
    turned = complex(*at.point(name, place.real, place.imag).acceleration)
    normal = turned / abs(turned) * np.exp(-1j * float(at.theta3))
    loops = 0
    for sign in (1, -1):
        point = place + sign * distance * normal
        curve = coupler_curve(CRANK_ROCKER, point.real, point.imag, link=name)
        assert len(curve.cusp_theta2) == 0
        assert 0.01 * distance < curve.slowest < 10 * distance
        apart = np.abs(np.exp(1j * np.diff(curve.double_theta2, axis=1)) - 1)
        near = np.abs(np.exp(1j * (curve.double_theta2[:, :1] - 0.6)) - 1)
        loops += int(np.sum((apart < 20 * np.sqrt(distance)) & (near < 20 * np.sqrt(distance))))
    # The point loops on one side of the centrode and bends on the other.
    assert loops == 1


def polyline_crossings(z):
    """Return where the segments between places of a closed path cross."""
    after = np.roll(z, -1)
    side = ((after - z).conj()[:, None] * (z[None] - z[:, None])).imag > 0
    parted = side != np.roll(side, -1, axis=1)
    i, j = np.nonzero(np.triu(parted & parted.T, k=2))
    apart = (j - i) % (len(z) - 1) > 0
    return 0.25 * (z + after)[i[apart]] + 0.25 * (z + after)[j[apart]]


@pytest.mark.parametrize("scenes", [6, pytest.param(45, marks=pytest.mark.slow)])
def test_double_points_are_where_the_path_crosses_itself(scenes):
    found = 0
    for seed in range(scenes):
        rng = np.random.default_rng(90 + seed)
        kind, link = KINDS[seed % 3], ("coupler", "coupler", "block")[seed % 3]
        linkage = random_linkage(rng, kind)
        place = rng.uniform((-2, -2), (3, 2)) * linkage.lengths.get(link, 1.0)
        for circuit in (0, 1):
            try:
                curve = coupler_curve(linkage, *place, link=link, circuit=circuit, points=1500)
            except BadInput:
                continue
            curve.require()
            path, doubles = (complex_of(at) for at in (curve.position, curve.double_position))
            chord, crossed = np.max(np.abs(np.diff(path))), polyline_crossings(path)
            apart = np.abs(np.sin(np.diff(curve.double_parameter, axis=1)[:, 0] / 2))
            # Of the smallest loops and the flattest crossings the chords know nothing.
            for p in doubles[(apart > 0.02) & (curve.crossing_angle > 0.02)]:
                assert np.min(np.abs(crossed - p), initial=9.0) < 2 * chord
                found += 1
            for p in crossed:
                assert np.min(np.abs(doubles - p), initial=9.0) < 2 * chord
    assert found >= scenes / 4


def test_the_sextic_refuses_other_points():
    curve = coupler_curve(CRANK_ROCKER, 1.0, 0.5)
    places = complex_of(curve.position)
    assert np.max(sextic_residual(CRANK_ROCKER.lengths, 1.0 + 0.5j, places)) < 1e-15
    assert np.max(sextic_residual(CRANK_ROCKER.lengths, 1.0 + 0.5j, places + 1e-6)) > 1e-8


@pytest.mark.parametrize(
    ("linkage", "along", "across"),
    [
        (CRANK_ROCKER, 1.0, -1.5),
        (DRAG_LINK, 1.0, 1.0),
        (INWARD_ROCKER, 0.7, 0.6),
        (DOUBLE_ROCKER, 0.7, 0.6),
    ],
)
def test_cognates_trace_the_same_curve(linkage, along, across):
    curve = coupler_curve(linkage, along, across)
    for cognate in curve.cognates():
        other = cognate.curve()
        assert other.length == pytest.approx(curve.length, rel=1e-10)
        assert abs(other.area) == pytest.approx(abs(curve.area), rel=1e-10, abs=1e-11)
        places = complex_of(cognate.placed(other.position))
        residual = sextic_residual(linkage.lengths, complex(along, across), places)
        assert np.max(residual) < 1e-13
        # The same circuit: each sample lies close to a sample of the first one.
        far = np.abs(places[::40, None] - complex_of(curve.position)[None])
        chord = np.max(np.abs(np.diff(complex_of(curve.position))))
        assert np.max(np.min(far, axis=1)) < chord
        doubles = np.sort_complex(np.round(complex_of(curve.double_position), 8))
        theirs = np.sort_complex(np.round(complex_of(cognate.placed(other.double_position)), 8))
        assert theirs == pytest.approx(doubles, abs=1e-7)


@pytest.mark.parametrize("unit", [1e-150, 1e150])
def test_unit_of_length(unit):
    lengths = [unit * value for value in INWARD_ROCKER.lengths.values()]
    curve = coupler_curve(FourBar(*lengths), 0.7 * unit, 0.6 * unit)
    plain = coupler_curve(INWARD_ROCKER, 0.7, 0.6)
    assert curve.length == pytest.approx(plain.length * unit, rel=1e-13)
    assert curve.double_position == pytest.approx(plain.double_position * unit, rel=1e-11)


@pytest.mark.parametrize(("detuned", "crossings"), [(-1e-6, 2), (1e-6, 0)])
def test_tacnode_of_a_symmetric_curve(detuned, crossings):
    """Coupler, follower and C-P of one length: P stays on a line through D that turns with DB.

    It is 2 l sin((g - mu)/2) from D, g the angle from CB to CP, mu the transmission angle: the same
    on the axis of symmetry at theta = 0 and pi where 2 g = 2 pi + mu(0) + mu(pi).  Both branches
    are at right angles to the axis there, and touch.
    """
    frame, crank, arm = 2.0, 0.8, 1.7
    least, greatest = (2.0 * np.arcsin((frame + s * crank) / (2.0 * arm)) for s in (-1, 1))
    angle = np.pi + 0.5 * (least + greatest) + detuned
    place = arm + arm * np.exp(1j * (np.pi + angle))
    curve = coupler_curve(FourBar(frame, crank, arm, arm), place.real, place.imag)
    assert np.linalg.norm(curve.position[0] - curve.position[360]) < 2e-6
    near = np.linalg.norm(curve.double_position - curve.position[0], axis=1) < 0.01
    assert np.count_nonzero(near & (curve.crossing_angle < 0.1)) == crossings


test_refusals = refused(
    lambda arguments, options: coupler_curve(*arguments, **options),
    [
        ((CRANK_ROCKER, 1.0), {"link": "rod"}, "link"),
        ((CRANK_ROCKER, float("nan")), {}, "along"),
        ((CRANK_ROCKER, 1.0), {"points": 3}, "points"),
        ((CRANK_ROCKER, 1.0), {"circuit": 2}, "circuit"),
        ((TRIPLE_ROCKER, 1.0), {"circuit": 1}, "circuit"),
        ((CRANK_ROCKER, 0.0), {"link": "crank"}, "pivot"),
        ((FourBar(2.0, 1.0, 2.0, 1.0), 1.0), {}, "change point"),
        ((QuickReturn(2.0, 1.0, 2.5), 1.0), {"link": "rod"}, "rod"),
    ],
)


test_refusals_of_cognates = refused(
    lambda linkage, along, link: coupler_curve(linkage, along, link=link).cognates(),
    [
        (SLIDER, 1.0, "coupler", "four-bar|FourBar"),
        (CRANK_ROCKER, 1.0, "follower", "coupler"),
        (CRANK_ROCKER, 0.0, "coupler", "joint"),
        (CRANK_ROCKER, 2.0, "coupler", "joint"),
    ],
)


def test_file_and_picture_have_the_double_points(tmp_path):
    curve = coupler_curve(INWARD_ROCKER, 0.7, 0.6, points=32)
    saved = json.loads(curve.save(tmp_path / "curve.json").read_text())
    assert len(saved["double_position"]) == 2 and saved["passed"]
    labels = [text.get_text() for text in curve.plot().get_legend().get_texts()]
    assert labels == ["point of the coupler", "double point"]


def test_frames_and_bytes_of_a_moving_picture(tmp_path):
    curve = coupler_curve(CRANK_ROCKER, 1.0, 0.5)
    first, second = (
        animate(CRANK_ROCKER, tmp_path / f"{name}.gif", curves=[curve], frames=4, fps=20)
        for name in ("one", "two")
    )
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
    curves = [coupler_curve(ROD, 0.5, 0.2, link="block"), coupler_curve(ROD, 4.0, link="rod")]
    animate(ROD, tmp_path / "rod.gif", curves=curves, frames=2)


@pytest.mark.parametrize(
    ("linkage", "path", "options", "word"),
    [
        (None, "a.gif", {}, "linkage"),
        (CRANK_ROCKER, "a.png", {}, "gif"),
        (CRANK_ROCKER, "missing/a.gif", {}, "writable"),
        (CRANK_ROCKER, "a.gif", {"frames": 1}, "frames"),
        (CRANK_ROCKER, "a.gif", {"fps": 0}, "fps"),
        (CRANK_ROCKER, "a.gif", {"curves": ["x"]}, "curves"),
        (CRANK_ROCKER, "a.gif", {"curves": [coupler_curve(SLIDER, 1.0)]}, "another linkage"),
    ],
)
def test_pictures_refused_write_nothing(tmp_path, linkage, path, options, word):
    with pytest.raises(BadInput, match=word):
        animate(linkage, tmp_path / path, **options)
    assert list(tmp_path.iterdir()) == []
