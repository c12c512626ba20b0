"""Proved stability: enclosures hold what is computed otherwise, and no tongue is proved stable."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.design import certify
from elastolink.runtime.design.enclosures import Revolution

flint = pytest.importorskip("flint")
RPM = np.pi / 30.0
SMITH = "smith_1972_5152_sixteenth_inch"


def coupler(modes=1, damping=0.3, **changes):
    system = el.load_scene(SMITH, overrides={"model.modes": modes}).system()
    return system.with_parameters(damping=damping, **changes)


def mathieu(damping, depth=1.0):
    """Return q'' + 2 damping q' + (1 + depth cos theta) q = 0 over time, theta = speed t."""
    cosine = lambda theta: np.cos(theta)[:, None, None]  # noqa: E731
    one = np.eye(1)
    terms = (Term("M", None, one), Term("K", None, one), Term("K", "depth", cosine))
    values = {"depth": depth, "damping": 2.0 * damping}
    return LinearPeriodic(
        1, (*terms, Term("C", "damping", one)), parameters=values, scales=lambda given: given
    )


@pytest.mark.parametrize("modes", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_enclosed_matrices_hold_the_computed_multipliers(modes):
    system = coupler(modes)
    low, high = 340.0 * RPM, 350.0 * RPM
    matrices = Revolution(system, low, high).over(low, high).over(low, high)
    assert 0.0 < matrices._error < 1e-7
    for speed in np.random.default_rng(3).uniform(low, high, 5):
        point = matrices.over(speed, speed)
        found = flint.arb_mat([[of(flint.arb(0)) for of in row] for row in point]).charpoly()
        multipliers = el.floquet_multipliers(system, speed).multipliers
        for ball, wanted in zip(found.coeffs(), np.poly(multipliers)[::-1], strict=True):
            assert abs(float(ball.mid()) - wanted.real) <= float(ball.rad()) + 1e-11
            assert float(ball.rad()) < 1e-6


def test_a_range_without_tongues_is_proved_and_the_bound_is_close():
    found = certify(coupler(), (300.0 * RPM, 400.0 * RPM))
    assert found.stable and found.passed and len(found.proved) == 1
    assert found.proved[0] == pytest.approx([300.0 * RPM, 400.0 * RPM], rel=1e-15)
    speeds = np.linspace(*found.proved[0], 50)
    largest = np.max(np.abs(el.floquet_multipliers(coupler(), speeds).multipliers))
    assert largest < found.bound[0] < largest + 0.05


def covers(found, low, high):
    """Return whether the three kinds of intervals cover the range without a gap."""
    spans = sorted([*found.proved, *found.open, *found.unstable], key=lambda span: span[0])
    ends = [low, *(end for span in spans for end in span), high]
    return all(a == b for a, b in zip(ends[::2], ends[1::2], strict=True))


def proved_at(found, speed):
    return any(low <= speed <= high for low, high in found.proved)


@pytest.mark.parametrize("damping", [pytest.param(0.02, marks=pytest.mark.slow), 0.1])
def test_a_tongue_inside_is_found_to_its_ends(damping):
    system, span = coupler(damping=damping), (740.0 * RPM, 790.0 * RPM)
    edges = el.stability_edges(system, span)
    found = certify(system, span, resolution=0.05 * RPM)
    assert not found.stable and covers(found, *span)
    ends = [(a, b) for a, b in zip(edges.lower, edges.upper, strict=True) if a > span[0]]
    assert ends
    for lower, upper in ends:
        inside = np.linspace(lower, upper, 40)[1:-1]
        assert not any(proved_at(found, speed) for speed in inside)
        assert not proved_at(found, lower) and not proved_at(found, upper)
    assert len(found.unstable) and np.all(
        np.max(np.abs(el.floquet_multipliers(system, found.unstable.mean(axis=1)).multipliers), 1)
        > 1.0
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_narrow_tongues_of_random_equations_are_never_proved(seed):
    """The damping is chosen so that a tongue of the second order is all but closed."""
    rng = np.random.default_rng(seed)
    depth, speed = rng.uniform(0.2, 0.5), 1.0
    low, high = 0.9 * speed, 1.1 * speed

    def largest(damping):
        at = np.linspace(low, high, 400)
        moduli = np.max(np.abs(el.floquet_multipliers(mathieu(damping, depth), at).multipliers), 1)
        return float(np.max(moduli)), float(at[np.argmax(moduli)])

    wide, closed = 0.0, 0.2
    for _ in range(14):
        middle = 0.5 * (wide + closed)
        wide, closed = (middle, closed) if largest(middle)[0] > 1.0 else (wide, middle)
    top, at = largest(wide)
    assert 1.0 < top < 1.01
    found = certify(mathieu(wide, depth), (low, high), resolution=2e-3)
    assert not found.stable and not proved_at(found, at) and len(found.proved)
    assert certify(mathieu(1.5 * closed, depth), (low, high)).stable


def test_a_rod_on_polynomials_is_proved_and_one_on_overhang_modes_refused():
    def rod(formulation):
        overrides = {"model.modes": 1, "model.formulation": formulation, "rod.damping_ratio": 0.01}
        return el.load_scene("beale_1992_flexible_rod", overrides=overrides).system()

    assert certify(rod("two_segment"), (995.0, 1005.0)).stable
    with pytest.raises(el.BadInput, match=r"whose function takes doubles only; .*two_segment"):
        certify(rod("overhang"), (995.0, 1005.0))


def test_the_functions_of_a_system_forget_balls():
    system = coupler()
    certify(system, (300.0 * RPM, 310.0 * RPM))
    assert system.terms[1](np.linspace(0.0, 6.0, 128)).dtype == float


@pytest.mark.parametrize(
    ("system", "speeds", "words"),
    [
        (None, (30.0, 40.0), "system"),
        ("undamped", (30.0, 40.0), "no damping"),
        (4, (30.0, 40.0), "4 coordinates"),
        (1, (40.0, 30.0), "speed_range"),
        (1, (0.0, 30.0), "speed_range"),
        (1, "fast", "speed_range"),
    ],
)
def test_what_cannot_be_certified_is_refused(system, speeds, words):
    if system == "undamped":
        system = coupler(damping=0.0)
    elif isinstance(system, int):
        system = coupler(system)
    with pytest.raises(el.BadInput, match=words):
        certify(system, speeds)


@pytest.mark.parametrize("resolution", [0.0, -1.0, np.nan, "fine"])
def test_a_wrong_resolution_is_refused(resolution):
    with pytest.raises(el.BadInput, match="resolution"):
        certify(coupler(), (30.0, 40.0), resolution=resolution)


def test_what_compares_angles_is_refused():
    kink = Term("K", None, lambda theta: np.abs(np.sin(theta))[:, None, None])
    system = mathieu(0.1).with_terms(kink)
    with pytest.raises(el.BadInput, match="takes doubles only"):
        certify(system, (0.5, 0.6))


@pytest.mark.parametrize(
    "function",
    [
        lambda theta: np.where(0.0 * theta == 0.0, np.cos(theta), 0.0 * theta),
        lambda theta: np.where(0.0 * theta, 0.0 * theta, np.cos(theta)),
        lambda theta: np.zeros(len(theta)) if theta.dtype == object else np.cos(theta),
        lambda theta: 0.0 * theta if theta.dtype == object else np.cos(theta),
    ],
)
def test_a_function_that_is_another_on_balls_is_refused(function):
    """With cos theta the system is unstable in this range, without it stable."""
    one = np.eye(1)
    terms = (Term("M", None, one), Term("K", None, 4.0 * one), Term("C", None, 0.1 * one))
    wave = Term("K", None, lambda theta: function(theta)[:, None, None])
    with pytest.raises(el.BadInput, match="takes doubles only"):
        certify(LinearPeriodic(1, (*terms, wave)), (3.6, 5.6))


def test_without_flint_one_error(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "flint", None)
    with pytest.raises(el.BadInput, match="found no python-flint; expected it installed"):
        certify(coupler(), (30.0, 40.0))


@pytest.mark.slow
def test_it_is_drawn(tmp_path):
    axes = certify(coupler(damping=0.05), (750.0 * RPM, 770.0 * RPM), resolution=0.1).plot()
    assert axes.get_xlabel() == "crank speed [rpm]" and axes.get_legend() is not None
