"""Tongues of coupled modes as series: orders, damping, checks, random systems, Smith's rig."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from edge_truth import rig
from elastolink.runtime.core.families import Term
from elastolink.runtime.stability import resonances, stability_edges, tongue
from periodic_systems import every_term, is_growing, system_of, wave

W2 = np.sqrt(5.3)
RANGE = (38.0, 95.0)


def _pair(first=((0.0, 1.0), (1.0, 0.0)), second=((0.0, 0.0), (0.0, 0.0)), **changes):
    """Return y'' + C y' + (diag(1, 5.3) + eps (first cos theta + second cos(2 theta + .4))) y."""
    return system_of(
        {"eps": 0.0, "d1": 0.0, "d2": 0.0, **changes},
        M=np.eye(2),
        K=[np.diag([1.0, 5.3]), ("eps", wave(first)), ("eps", wave(second, 2, 0.4))],
        C=[("d1", np.diag([1.0, 0.0])), ("d2", np.diag([0.0, 1.0]))],
    )


FULL = _pair(((0.4, 1.0), (1.0, -0.3)), ((0.2, 0.3), (0.3, 0.1)))


def _resonance(system, label, span=(0.3, 12.0), **options):
    return next(item for item in resonances(system, span, **options) if item.label == label)


SUM = _resonance(FULL, "w1 + w2 = w")


def _exact(system, found, **parameters):
    """Return the exact ends by bisection of the multipliers, all values at once; ``(2, nb)``."""
    # Undamped, multipliers leave the circle with a square root, and round-off is magnified so:
    # 1e-8 of growth is 1e-15 of speed.  Damped, they cross it.
    limit = 0.0 if len(parameters) > 1 else 1e-8
    middle = (found.lower + found.upper) / 2
    ends = []
    for end, side in ((found.lower, -1), (found.upper, 1)):
        inner, outer = middle.copy(), end + 0.4 * side * found.width
        assert np.all(is_growing(system, inner, limit, **parameters))
        assert not np.any(is_growing(system, outer, limit, **parameters))
        for _ in range(44):
            trial = (inner + outer) / 2
            grows = is_growing(system, trial, limit, **parameters)
            inner, outer = np.where(grows, trial, inner), np.where(grows, outer, trial)
        ends.append((inner + outer) / 2)
    return np.array(ends)


EPS = np.array([0.1, 0.05, 0.025])

CASES = {
    "principal": (FULL, "2 w1 = w", {}),
    "sum": (FULL, "w1 + w2 = w", {}),
    "sum, second harmonic": (FULL, "w1 + w2 = 2 w", {}),
    "principal, damped": (FULL, "2 w1 = w", {"d1": 0.05, "d2": 0.2}),
    "sum, damped": (FULL, "w1 + w2 = w", {"d1": 0.06, "d2": 0.18}),
    "periodic mass, sum": (every_term(), "w1 + w2 = w", {}),
    "periodic mass, sum, damped": (every_term(), "w1 + w2 = w", {"c": 0.2}),
    "difference, not conservative": (_pair(((0.3, 1.0), (-0.8, 0.2))), "w2 - w1 = w", {}),
    "difference, not conservative, damped": (
        _pair(((0.3, 1.0), (-0.8, 0.2)), ((0.2, 0.4), (0.1, -0.3))),
        "w2 - w1 = w",
        {"d1": 0.1, "d2": 0.2},
    ),
}


REST = sorted({*CASES} - {"principal", "periodic mass, sum, damped"})


def slow(*cases):
    return [pytest.param(case, marks=pytest.mark.slow) for case in cases]


def _series(system, label, order, damping):
    """Return tongues at values of eps, damping in proportion to it."""
    resonance = _resonance(system, label, (0.3, 20.0), highest=3)
    each = [
        tongue(system, resonance, order=order, eps=eps, **{d: s * eps for d, s in damping.items()})
        for eps in EPS
    ]
    fields = ("lower", "upper", "error", "width", "open")
    return SimpleNamespace(**{f: np.array([getattr(one, f) for one in each]) for f in fields})


@pytest.mark.parametrize("name", ["principal", *slow("periodic mass, sum, damped", *REST)])
def test_the_error_falls_with_the_first_power_left_out(name):
    system, label, damping = CASES[name]
    changed = {key: value * EPS for key, value in damping.items()}
    exact = _exact(system, _series(system, label, 6, damping), eps=EPS, **changed)
    for order in (1, 2, 3, 4):
        found = _series(system, label, order, damping)
        assert np.all(found.open)
        actual = np.abs(np.stack([found.lower, found.upper]) - exact)
        # Slopes are exact in the limit; the next power bends them by a share of eps.
        slopes = np.log2(actual[:, 1:-1] / actual[:, 2:])
        known = actual[:, 2:] > 1e-11
        assert np.all(slopes[known] > order + 1 - 0.35), (order, slopes)
        assert np.any(np.abs(slopes[known] - order - 1) < 0.25) or not np.any(known)
        worst = np.max(actual, axis=0)
        assert np.all(worst <= found.error + 1e-11)
        assert np.all(found.error <= 1e3 * worst + 1e-11)


def test_checks_pass_and_say_what_was_compared():
    system = every_term()
    resonance = _resonance(system, "w1 + w2 = w", (0.3, 20.0))
    found = tongue(system, resonance, parameter=("eps", EPS), c=0.005)
    assert found.passed, dict(found.checks)
    names = {"told apart", "error over half the width", "stable inside", "unstable outside"}
    assert set(found.checks) == names


def test_a_wrong_end_fails_the_checks():
    found = tongue(FULL, SUM, parameter=("eps", EPS), order=3)
    checks = found.checks._make
    wide = replace(found, upper=found.upper + 0.5 * found.width)
    assert not replace(checks, tongue=wide)()["stable inside"].passed
    narrow = replace(found, upper=found.upper - 0.5 * found.width)
    assert not replace(checks, tongue=narrow)()["unstable outside"].passed


@pytest.mark.smoke
def test_first_order_is_the_textbook_s():
    # Averaging by hand: |w - w1 - w2| < (d1 + d2)/(2 sqrt(d1 d2)) sqrt(eps^2/(4 w1 w2) - d1 d2).
    system = _pair()
    label, eps = "w1 + w2 = w", 1e-4
    resonance = _resonance(system, label)
    assert resonance.speed == pytest.approx(1 + W2, rel=1e-14)
    plain = tongue(system, resonance, parameter=("eps", eps), order=1)
    assert plain.width == pytest.approx(eps / np.sqrt(W2), rel=1e-8)
    for d1, d2 in ((1e-5, 1e-5), (2e-6, 2e-5), (1e-6, 4e-5)):
        widening = (d1 + d2) / (2 * np.sqrt(d1 * d2))
        half = widening * np.sqrt(eps**2 / (4 * W2) - d1 * d2)
        found = tongue(system, resonance, parameter=("eps", eps), order=1, d1=d1, d2=d2)
        # The formula's own error is of the next order in eps.
        assert found.width == pytest.approx(2 * half, rel=10 * widening * eps)


def test_damping_closes_a_tongue():
    system = _pair()
    resonance = _resonance(system, "w1 + w2 = w")
    # Closed from d1 d2 = eps^2/(4 w1 w2) on, to first order.
    critical = 1e-3 / (2 * np.sqrt(W2))
    for factor, opens in ((0.0, True), (0.9, True), (1.1, False)):
        drag = factor * critical
        found = tongue(system, resonance, parameter=("eps", 1e-3), d1=drag, d2=drag)
        assert found.open == opens
        assert np.isnan(found.lower) != opens
        assert (found.width == 0.0) != opens
        assert found.passed, dict(found.checks)


def test_equal_signatures_do_not_open():
    # The difference tongue of a definite conservative system (Krein).
    resonance = _resonance(FULL, "w2 - w1 = w")
    assert resonance.signatures == (1, 1)
    assert not resonance.opens
    found = tongue(FULL, resonance, parameter=("eps", [0.05, 0.1]), order=4)
    assert not np.any(found.open)
    np.testing.assert_array_equal(found.lower, found.upper)
    for eps, speed in zip((0.05, 0.1), found.lower, strict=True):
        near = speed * (1 + np.linspace(-0.05, 0.05, 101))
        assert not np.any(is_growing(FULL, near, 1e-9, eps=eps))


@pytest.mark.slow
def test_opposite_signatures_open_a_difference_tongue():
    # A gyroscopically stabilised pair: its slow mode has negative energy.
    system = system_of(
        {"eps": 0.0},
        M=np.eye(2),
        A=(None, np.array([[0.0, -1.5], [1.5, 0.0]]), -1),
        K=[np.diag([-0.5, -0.8]), ("eps", wave([[0.4, 0.9], [0.9, -0.3]], 1, 0.2))],
    )
    sums = _resonance(system, "w1 + w2 = w")
    assert sums.signatures == (-1, -1)
    assert not tongue(system, sums, parameter=("eps", 0.05), order=3).open
    difference = _resonance(system, "w2 - w1 = w")
    assert difference.signatures == (1, -1)
    found = tongue(system, difference, parameter=("eps", EPS), order=3)
    exact = _exact(system, found, eps=EPS)
    assert np.all(np.abs(np.stack([found.lower, found.upper]) - exact) <= found.error + 1e-11)


def test_neither_conservative_nor_reversible_without_damping_has_no_end():
    system = _pair(((0.3, 1.0), (-0.8, 0.2)), ((0.2, 0.4), (0.1, -0.3)))
    resonance = _resonance(system, "w2 - w1 = w", eps=0.08)
    assert resonance.signatures == (0, 0)
    found = tongue(system, resonance, parameter=("eps", 0.08), order=3)
    assert (found.lower, found.upper) == (0.0, np.inf)
    assert np.all(is_growing(system, np.linspace(1.2, 1.4, 21), 1e-6, eps=0.08))


def test_the_order_may_be_too_low_to_open_a_tongue():
    system = _pair(((1.0, 0.0), (0.0, 0.5)))
    resonance = _resonance(system, "2 w1 = 2 w")
    first = tongue(system, resonance, parameter=("eps", 0.05), order=1)
    assert not first.open
    assert first.lower == first.upper
    second = tongue(system, resonance, parameter=("eps", 0.05), order=2)
    assert second.open
    assert second.lower < second.upper
    assert first.error > second.error


def test_a_parameter_beside_other_periodic_parts():
    system = FULL.with_terms(Term("K", None, wave([[0.05, 0.0], [0.0, 0.0]])))
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", [[0.05], [0.1]]), order=3)
    assert found.lower.shape == (2, 1)
    assert found.passed, dict(found.checks)
    assert tongue(system, resonance, eps=0.1, order=3).lower == found.lower[1, 0]


def test_pictures_and_records():
    found = tongue(FULL, SUM, parameter=("eps", EPS))
    axes = found.plot()
    assert axes.get_ylabel() == "eps"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [found.label]
    assert tongue(FULL, SUM, eps=0.1).plot().get_xlabel() == "crank speed [rpm]"
    assert found.to_dict()["resonance"]["modes"] == [1, 2]


@pytest.mark.slow
def test_four_exponents_that_meet_exactly():
    # Two like oscillators, coupled: y1 + y2 and y1 - y2 are Mathieu's equation with +-eps.
    both, one = (
        system_of(
            {"eps": 0.0, "d": 0.0},
            M=np.eye(len(pull)),
            K=[np.eye(len(pull)), ("eps", wave(pull))],
            C=("d", np.eye(len(pull))),
        )
        for pull in ([[0.0, 1.0], [1.0, 0.0]], [[1.0]])
    )
    for drag in (0.0, 0.02):
        given = {"parameter": ("eps", 0.1), "order": 2, "d": drag}
        single = tongue(one, _resonance(one, "2 w1 = w"), **given)
        for label in ("2 w1 = w", "w1 + w2 = w"):
            found = tongue(both, _resonance(both, label), **given)
            assert (found.dimension, single.dimension) == (4, 2)
            np.testing.assert_allclose(found.lower, single.lower, rtol=1e-11)
            np.testing.assert_allclose(found.upper, single.upper, rtol=1e-11)
            assert found.passed


def test_units_of_mass_and_coordinates_do_not_matter():
    turn = np.diag([1e5, 1e-4])
    other = FULL.with_changed_terms(
        lambda term: replace(term, function=lambda theta: turn @ term(theta) @ turn)
    )
    given = {"parameter": ("eps", EPS), "order": 3, "d1": 0.004, "d2": 0.012}
    expected = tongue(FULL, SUM, **given)
    found = tongue(other, _resonance(other, "w1 + w2 = w"), **given)
    np.testing.assert_allclose(found.lower, expected.lower, rtol=1e-11)
    np.testing.assert_allclose(found.upper, expected.upper, rtol=1e-11)


def _system(squares, pull, damping):
    """Return y'' + C y' + (diag(squares) + eps pull cos theta) y = 0."""
    return system_of(
        {"eps": 0.0, "c": 1.0},
        M=np.eye(2),
        K=[np.diag(squares), ("eps", wave(pull))],
        C=("c", np.diag(damping)),
    )


def _near(second, damping):
    return _system((3.11**2, second**2), ((0.5, 0.4), (0.4, 0.5)), damping)


@pytest.mark.parametrize("damping", [(0.003, 0.013), *slow((0.013, 0.003), (0.001, 0.03))])
def test_unequal_damping_does_not_hide_a_tongue_beside_others(damping):
    # 2 w1, w1 + w2 and 2 w2 lie side by side; the motion is nearly all of the lightly damped mode.
    system = _near(3.551, damping)
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 0.12), order=3)
    assert found.dimension == 4
    assert found.open
    assert found.passed, dict(found.checks)
    ends = np.array([found.lower, found.upper]) + 3 * found.error * np.array([[-1.0], [1.0]])
    assert is_growing(system, ends, 0.0, eps=0.12).tolist() == [[False, True], [True, False]]


def test_damping_of_one_mode_alone_leaves_no_end_beside_others_either():
    system = _near(3.551, (0.01, 0.0))
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 0.12), order=3)
    assert found.dimension == 4
    assert (found.open, found.lower, found.upper) == (True, 0.0, np.inf)
    assert not found.passed


@pytest.mark.slow
def test_a_range_wrongly_said_to_be_closed_fails_the_checks():
    system = _near(3.551, (0.003, 0.013))
    resonance = _resonance(system, "w1 + w2 = w")
    narrow = tongue(system, resonance, eps=0.02, c=3.0, order=3)
    assert not narrow.open
    assert narrow.checks["told apart"].value == 0.0
    found = tongue(system, resonance, eps=0.12, order=3)
    assert found.open
    nan = np.array(np.nan)
    closed = replace(found, lower=nan, upper=nan, error=nan, open=np.array(False))
    assert replace(found.checks._make, tongue=closed)()["told apart"].value == 1.0


def test_a_series_out_of_its_depth_does_not_pass_a_closed_range():
    # The ends are beyond the detunings that a series of order 2 can tell of.
    system = _system((1.0, 5.3), ((0.0, 1.0), (1.0, 0.0)), (0.01, 0.03))
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 5.0), order=2)
    assert np.isnan(found.lower)
    assert is_growing(system, 1 + np.sqrt(5.3), 1e-3, eps=5.0)
    assert not found.passed


@pytest.fixture(scope="module", name="rig")
def _rig():
    """Smith, chapter 9, suggestion 1: what his theory of a single mode leaves out."""
    return rig(**{"model.modes": 2})


@pytest.fixture(scope="module")
def traced(rig):
    """Ends [rad/s] from tracing the multipliers, another route; known to 1e-10."""
    found = stability_edges(rig, RANGE)
    ends = zip(found.lower.tolist(), found.upper.tolist(), strict=True)
    return dict(zip(found.names, ends, strict=True))


def _traced(traced, resonance):
    return np.array(traced[resonance.kind, *sorted(resonance.modes), resonance.harmonic])


@pytest.mark.parametrize(
    ("label", "most"),
    [
        # The largest errors at order 4 [rad/s].
        ("2 w1 = 6 w", 0.08),
        ("w1 + w2 = 12 w", 0.04),
        pytest.param("w1 + w2 = 9 w", 0.3, marks=pytest.mark.slow),
    ],
)
def test_tongues_of_the_rig(rig, traced, label, most):
    resonance, errors = _resonance(rig, label, RANGE, highest=16), []
    exact = _traced(traced, resonance)
    for order in (2, 4):
        found = tongue(rig, resonance, order=order)
        actual = np.max(np.abs(np.array([found.lower, found.upper]) - exact))
        assert actual <= found.error
        errors.append(actual)
    assert found.error <= most
    assert np.all(np.diff(errors) < 0.0)
    # The mean equation alone is much farther off.
    assert errors[-1] < 0.6 * abs(resonance.speed - exact.mean())


@pytest.mark.slow
def test_four_exponents_of_the_rig_that_nearly_meet_are_treated_together(rig, traced):
    # 2 w1 = 4 w lies beside w1 + w2 = 10 w: alone the pair's series diverges.
    resonance = _resonance(rig, "w1 + w2 = 10 w", RANGE, highest=16)
    together = tongue(rig, resonance, order=6)
    assert together.dimension == 4
    assert abs(together.lower - _traced(traced, resonance)[0]) < 0.03
    assert together.open
    # Below order 4 the wide tongue of the first mode hides the other, and that is said.
    hidden = tongue(rig, resonance, order=2)
    assert np.isnan(hidden.lower)
    assert not hidden.checks["told apart"].passed
