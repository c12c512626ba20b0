"""Perturbation series of principal and combination tongues against exact multipliers."""

from __future__ import annotations

import matplotlib
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.floquet import floquet_multipliers
from elastolink.runtime.stability import resonances, tongue
from elastolink.runtime.hill.boundaries import hill_boundaries
from periodic_systems import is_growing, named, wave

matplotlib.use("Agg")

W2 = np.sqrt(5.3)


def _pair(first=((0.0, 1.0), (1.0, 0.0)), second=((0.0, 0.0), (0.0, 0.0)), **changes):
    """Return y'' + C y' + (diag(1, 5.3) + eps (first cos theta + second cos(2 theta + .4))) y."""
    values = {"eps": 0.0, "d1": 0.0, "d2": 0.0, **changes}
    terms = (
        Term("M", None, np.eye(2)),
        Term("K", None, np.diag([1.0, 5.3])),
        Term("K", "eps", wave(first)),
        Term("K", "eps", wave(second, 2, 0.4)),
        Term("C", "d1", np.diag([1.0, 0.0])),
        Term("C", "d2", np.diag([0.0, 1.0])),
    )
    return LinearPeriodic(2, terms, values, named(values))


FULL = _pair(((0.4, 1.0), (1.0, -0.3)), ((0.2, 0.3), (0.3, 0.1)))


def _whole(**changes):
    """Two modes with periodic mass, Coriolis, centrifugal and axial terms, all times eps."""
    values = {"eps": 0.0, "c": 0.0, **changes}
    terms = (
        Term("M", None, np.array([[2.0, 0.3], [0.3, 1.0]])),
        Term("M", "eps", wave([[0.3, 0.1], [0.1, 0.2]], 1, 0.3)),
        Term("A", None, np.array([[0.1, -0.2], [0.3, 0.0]])),
        Term("A", "eps", wave([[0.1, 0.2], [-0.1, 0.1]], 2, 1.0)),
        Term("B", None, np.array([[0.1, 0.05], [0.05, -0.2]])),
        Term("B", "eps", wave([[0.2, 0.1], [0.1, -0.3]])),
        Term("K", None, np.array([[20.0, 3.0], [3.0, 9.0]])),
        Term("Kg", "eps", wave([[2.0, 1.0], [1.0, 3.0]], 1, -0.4)),
        Term("C", "c", np.array([[0.4, 0.1], [0.1, 0.3]])),
    )
    return LinearPeriodic(2, terms, values, named(values))


def _resonance(system, label, span=(0.3, 12.0), **options):
    return next(item for item in resonances(system, span, **options) if item.label == label)


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
    "second mode": (FULL, "2 w2 = w", {}),
    "sum": (FULL, "w1 + w2 = w", {}),
    "sum, second harmonic": (FULL, "w1 + w2 = 2 w", {}),
    "principal, damped": (FULL, "2 w1 = w", {"d1": 0.05, "d2": 0.2}),
    "sum, damped": (FULL, "w1 + w2 = w", {"d1": 0.06, "d2": 0.18}),
    "periodic mass": (_whole(), "2 w1 = w", {}),
    "periodic mass, sum": (_whole(), "w1 + w2 = w", {}),
    "periodic mass, sum, damped": (_whole(), "w1 + w2 = w", {"c": 0.2}),
    "difference, not conservative": (
        _pair(((0.3, 1.0), (-0.8, 0.2))),
        "w2 - w1 = w",
        {},
    ),
    "difference, not conservative, damped": (
        _pair(((0.3, 1.0), (-0.8, 0.2)), ((0.2, 0.4), (0.1, -0.3))),
        "w2 - w1 = w",
        {"d1": 0.1, "d2": 0.2},
    ),
}


def _series(system, label, order, damping, eps=EPS):
    """Return the tongue at values of eps, damping in proportion to it."""
    unit = {name: value * EPS[0] for name, value in damping.items()}
    return tongue(
        system,
        _resonance(system, label, (0.3, 20.0), highest=2),
        parameter=("eps", eps),
        order=order,
        damping_factor=eps / EPS[0],
        **unit,
    )


@pytest.mark.parametrize("name", CASES)
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


@pytest.mark.parametrize("name", ["sum", "periodic mass, sum, damped"])
def test_checks_pass_and_say_what_was_compared(name):
    system, label, damping = CASES[name]
    found = _series(system, label, 2, damping)
    assert found.passed, dict(found.checks)
    assert set(found.checks) == {
        "told apart",
        "error over half the width",
        "stable inside",
        "unstable outside",
    }
    assert found.expansion == "parameter"
    assert len(found.operators) == 1


def test_a_wrong_end_fails_the_checks():
    from dataclasses import replace

    system, label, damping = CASES["sum"]
    found = _series(system, label, 3, damping)
    checks = found.checks._make
    wide = replace(found, upper=found.upper + 0.5 * found.width)
    assert not replace(checks, tongue=wide)()["stable inside"].passed
    narrow = replace(found, upper=found.upper - 0.5 * found.width)
    assert not replace(checks, tongue=narrow)()["unstable outside"].passed


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


def test_unequal_damping_widens_a_combination_tongue():
    system, eps = _pair(), 0.1
    resonance = _resonance(system, "w1 + w2 = w")
    plain = tongue(system, resonance, parameter=("eps", eps))
    equal = tongue(system, resonance, parameter=("eps", eps), d1=0.01, d2=0.01)
    unequal = tongue(system, resonance, parameter=("eps", eps), d1=0.002, d2=0.02)
    assert equal.width < plain.width < unequal.width
    assert unequal.width == pytest.approx(1.739 * plain.width, rel=0.03)
    # The multipliers say the same: speeds that are stable without damping are not with it.
    between = np.array([(plain.lower + unequal.lower) / 2, (plain.upper + unequal.upper) / 2])
    assert not np.any(is_growing(system, between, 1e-9, eps=eps))
    assert np.all(is_growing(system, between, 1e-4, eps=eps, d1=0.002, d2=0.02))
    assert not np.any(is_growing(system, between, 0.0, eps=eps, d1=0.02, d2=0.02))


def test_damping_of_one_mode_alone_leaves_no_end():
    system = _pair()
    resonance = _resonance(system, "w1 + w2 = w")
    found = tongue(system, resonance, parameter=("eps", 0.1), order=1, d1=0.01)
    assert found.open
    assert (found.lower, found.upper, found.error) == (0.0, np.inf, np.inf)
    assert not found.passed


def test_damping_closes_a_tongue():
    system = _pair()
    resonance = _resonance(system, "w1 + w2 = w")
    factors = np.array([0.0, 0.9, 1.1])
    # Closed from d1 d2 = eps^2/(4 w1 w2) on, to first order.
    critical = 1e-3 / (2 * np.sqrt(W2))
    given = {"d1": critical, "d2": critical}
    found = tongue(system, resonance, parameter=("eps", 1e-3), damping_factor=factors, **given)
    assert found.open.tolist() == [True, True, False]
    assert np.isnan(found.lower[2])
    assert found.width[2] == 0.0
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


def test_opposite_signatures_open_a_difference_tongue():
    # A gyroscopically stabilised pair: its slow mode has negative energy.
    terms = (
        Term("M", None, np.eye(2)),
        Term("A", None, np.array([[0.0, -1.5], [1.5, 0.0]]), power=-1),
        Term("K", None, np.diag([-0.5, -0.8])),
        Term("K", "eps", wave([[0.4, 0.9], [0.9, -0.3]], 1, 0.2)),
    )
    system = LinearPeriodic(2, terms, {"eps": 0.0}, named(["eps"]))
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


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_a_single_mode_gives_the_boundaries_of_hill_s_equation(n, damping):
    f = PeriodicFunction(a=[0.2, 1.0, 0.3], b=[0.0, 0.4, -0.2])
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", "lam2", np.eye(1)),
        Term("B", "mu", lambda theta: -f(theta)[:, None, None]),
        Term("C", "drag", 2 * np.eye(1), power=1),
    )
    values = {"lam2": 1.0, "mu": 0.0, "drag": 0.0}
    system = LinearPeriodic(1, terms, values, named(values))
    label = f"2 w1 = {n} w" if n > 1 else "2 w1 = w"
    resonance = _resonance(system, label, (0.01, 4.0), detuning="lam2")
    assert resonance.speed == pytest.approx(n * n / 4, rel=1e-13)
    # Without a coefficient c_n damping of first order closes the region.
    drag = 0.0 if n == 3 else damping
    mu = np.array([-0.04, 0.02, 0.04])
    for order in (2, 3, 4):
        found = tongue(
            system,
            resonance,
            parameter=("mu", mu),
            order=order,
            drag=drag,
            damping_factor=np.abs(mu),
        )
        exact = hill_boundaries(f, mu, (n,), damping=drag * np.abs(mu))
        gap = np.maximum(np.abs(found.lower - exact.lower[0]), np.abs(found.upper - exact.upper[0]))
        assert np.all(found.open)
        assert np.all(gap <= found.error)
        assert np.all(found.error <= 30 * gap + 1e-14)
        # Halving mu divides the larger error by the first power left out, at the least.
        assert gap[2] > 2 ** (order + 1 - 0.4) * gap[1] or gap[2] < 1e-12
    assert found.passed, dict(found.checks)


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


def test_truncations_keep_the_pairs_of_a_conservative_system():
    resonance = _resonance(_whole(), "w1 + w2 = w")
    found = tongue(_whole(), resonance, parameter=("eps", 0.4), order=3)
    operator = found.operators[0]
    ends = found.centres[0] / np.array([found.lower, found.upper]) - 1
    sigma = np.linspace(-0.1, 0.1, 41)
    powers = sigma[:, None] ** np.arange(6)
    values = np.linalg.eigvals(np.tensordot(powers, operator.polynomials(1.0, 0.0, 5), axes=1))
    # s and -conj s: the real parts cancel, whatever the size of what is left out.
    np.testing.assert_allclose(np.sum(values.real, axis=1), 0.0, atol=1e-14)
    stable = values[np.abs(sigma - np.mean(ends)) > 0.6 * np.ptp(ends)]
    assert 10 < len(stable) < 41
    np.testing.assert_allclose(stable.real, 0.0, atol=1e-13)


def test_exponents_of_the_operator_approach_the_exact_ones():
    damping = {"c": 0.3}
    resonance = _resonance(_whole(), "w1 + w2 = w")
    errors = []
    for size in (0.2, 0.1, 0.05):
        found = tongue(
            _whole(), resonance, parameter=("eps", size), order=1, damping_factor=size, **damping
        )
        operator, sigma = found.operators[0], 0.3 * size
        matrix = sum(sigma**k * value for k, value in enumerate(operator.polynomials(1, size, 3)))
        told = np.exp(2 * np.pi * (operator.centre + np.linalg.eigvals(matrix)))
        exact = floquet_multipliers(
            _whole(), found.centres[0] / (1 + sigma), eps=size, c=0.3 * size
        ).multipliers
        errors.append(np.max(np.min(np.abs(told[:, None] - exact), axis=1)))
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(slopes, 4.0, atol=0.25)


def test_a_parameter_beside_other_periodic_parts_expands_about_the_mean():
    more = Term("K", None, wave([[0.05, 0.0], [0.0, 0.0]]))
    system = _pair(((0.4, 1.0), (1.0, -0.3))).with_terms(more)
    resonance = _resonance(system, "w1 + w2 = w")
    values = np.array([[0.05], [0.1]])
    found = tongue(system, resonance, parameter=("eps", values), damping_factor=[0.0, 1.0], order=3)
    assert found.expansion == "periodic"
    assert found.lower.shape == (2, 2)
    assert len(found.operators) == 2
    assert found.passed, dict(found.checks)
    alone = tongue(system, resonance, eps=0.1, order=3)
    assert alone.lower.shape == ()
    assert alone.lower == found.lower[1, 1]


def test_pictures_and_records():
    resonance = _resonance(FULL, "w1 + w2 = w")
    found = tongue(FULL, resonance, parameter=("eps", EPS))
    axes = found.plot()
    assert axes.get_ylabel() == "eps"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [found.label]
    alone = tongue(FULL, resonance, eps=0.1)
    assert alone.plot().get_xlabel() == "crank speed [rpm]"
    record = found.to_dict()
    assert record["resonance"]["modes"] == [1, 2]
    np.testing.assert_array_equal(record["width"], found.width)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"order": 0}, "order"),
        ({"order": 9}, "order"),
        ({"merge": 0.7}, "merge"),
        ({"merge": "near"}, "merge"),
        ({"damping_factor": -1.0}, "damping_factor"),
        ({"damping_factor": [1.0, 2.0]}, "broadcast"),
        ({"damping": 1.0}, "damping"),
        ({"parameter": ("eps", [0.1, np.nan, 0.2])}, "finite"),
        ({"parameter": ("epsilon", 0.1)}, "epsilon"),
        ({"parameter": "eps"}, "pair"),
        ({"eps": 0.1}, "once"),
        ({"d3": 0.1}, "d3"),
    ],
)
def test_bad_input(changes, words):
    resonance = _resonance(FULL, "w1 + w2 = w")
    given = {"parameter": ("eps", [0.1, 0.2, 0.3]), **changes}
    with pytest.raises(BadInput, match=words):
        tongue(FULL, resonance, **given)


def test_a_resonance_that_does_not_fit_is_refused():
    from dataclasses import replace

    resonance = _resonance(FULL, "w1 + w2 = w")
    with pytest.raises(BadInput, match="modes"):
        tongue(FULL, replace(resonance, modes=(1, 3)), parameter=("eps", 0.1))
    with pytest.raises(BadInput, match="a Resonance"):
        tongue(FULL, "w1 + w2 = w", parameter=("eps", 0.1))
    with pytest.raises(BadInput, match="no such resonance"):
        tongue(FULL, replace(resonance, harmonic=30), parameter=("eps", 0.1))


def test_four_exponents_that_meet_exactly():
    # Two like oscillators, coupled: y1 + y2 and y1 - y2 are Mathieu's equation with +-eps.
    terms = (
        Term("M", None, np.eye(2)),
        Term("K", None, np.eye(2)),
        Term("K", "eps", wave([[0.0, 1.0], [1.0, 0.0]])),
        Term("C", "d", np.eye(2)),
    )
    both = LinearPeriodic(2, terms, {"eps": 0.0, "d": 0.0}, named(["eps", "d"]))
    one = LinearPeriodic(
        1,
        (
            Term("M", None, np.eye(1)),
            Term("K", None, np.eye(1)),
            Term("K", "eps", wave([[1.0]])),
            Term("C", "d", np.eye(1)),
        ),
        {"eps": 0.0, "d": 0.0},
        named(["eps", "d"]),
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


@pytest.mark.parametrize("units", [(1e-6, 1e-6), (1e5, 1e-4)])
def test_units_of_mass_and_coordinates_do_not_matter(units):
    turn = np.diag(units)
    terms = []
    for term in FULL.terms:
        old = term.function
        new = (
            (lambda theta, old=old: turn @ old(theta) @ turn)
            if callable(old)
            else turn @ old @ turn
        )
        terms.append(Term(term.array, term.scale, new, term.power))
    other = LinearPeriodic(2, tuple(terms), FULL.parameters, FULL.scales)
    given = {"parameter": ("eps", EPS), "order": 3, "d1": 0.004, "d2": 0.012}
    expected = tongue(FULL, _resonance(FULL, "w1 + w2 = w"), **given)
    found = tongue(other, _resonance(other, "w1 + w2 = w"), **given)
    np.testing.assert_allclose(found.lower, expected.lower, rtol=1e-11)
    np.testing.assert_allclose(found.upper, expected.upper, rtol=1e-11)
