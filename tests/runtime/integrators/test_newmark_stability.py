"""Limits of stability of Newmark's scheme, and its maps in time."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.gallery.newmark_stability import newmark_limit, newmark_regions
from elastolink.runtime.integrators.newmark import (
    generalized_alpha_rule,
    newmark_rule,
    step_maps,
)


def _growth(rule, phase, damping=0.0):
    """Return the largest modulus of a multiplier of a step of one freedom."""
    one = np.ones((2, 1, 1))
    rate, force = 2 * damping * phase * one, np.zeros((2, 1))
    whole = step_maps(rule, one, rate, phase**2 * one, force, 1.0)[0]
    return float(np.max(np.abs(np.linalg.eigvals(whole[:-1, :-1]))))


@pytest.mark.parametrize(
    ("gamma", "beta", "limit"),
    [
        # Central differences; Fox and Goodwin; linear acceleration: 4/(1 - 4 beta), squared.
        (0.5, 0.0, 2.0),
        (0.5, 1.0 / 12.0, 6.0**0.5),
        (0.5, 1.0 / 6.0, 12.0**0.5),
        (0.5, 0.25, np.inf),
        (0.8, 0.4, np.inf),
        (0.4, 0.25, 0.0),
    ],
)
def test_known_limits(gamma, beta, limit):
    assert newmark_limit(gamma, beta) == pytest.approx(limit, rel=1e-12)


def test_the_limit_is_where_the_steps_begin_to_grow():
    random = np.random.default_rng(8)
    for _ in range(100):
        gamma, beta, damping = random.uniform(0.0, 1.0, 3) * (1.2, 0.5, 0.5)
        limit = float(newmark_limit(gamma, beta, damping))
        rule = newmark_rule(gamma, beta)
        if np.isinf(limit):
            assert _growth(rule, 1e3, damping) <= 1.0 + 1e-9
        else:
            assert _growth(rule, 0.999 * limit, damping) <= 1.0 + 1e-9
            assert _growth(rule, 1.01 * limit, damping) > 1.0


def test_damping_helps_below_gamma_one_half_and_not_at_one_half():
    # Without damping no step is short enough; with it some are.
    assert newmark_limit(0.4, 0.25) == 0.0 < newmark_limit(0.4, 0.25, 0.02)
    # At gamma = 1/2 the limit does not feel the damping.
    assert newmark_limit(0.5, 0.0, 0.3) == pytest.approx(2.0, rel=1e-12)


def test_the_map_has_four_regions():
    gamma = np.array([0.4, 0.6, 0.6, 0.6])
    beta = np.array([0.3, 0.2, 0.301, 0.4])
    assert newmark_regions(gamma, beta).tolist() == [0, 1, 2, 3]


def test_generalized_alpha_damps_what_it_does_not_resolve_by_its_parameter():
    for rho in (0.0, 0.3, 0.9, 1.0):
        rule = generalized_alpha_rule(rho)
        if rule.carries_acceleration:
            assert _growth(rule, 1e6) == pytest.approx(rho, abs=1e-3)
        # No step is unstable.
        for phase in np.geomspace(1e-2, 1e4, 50):
            assert _growth(rule, phase) <= 1.0 + 1e-9


def test_bad_parameters_are_refused():
    with pytest.raises(BadInput, match="gamma"):
        newmark_rule(-0.1, 0.25)
    with pytest.raises(BadInput, match="beta"):
        newmark_rule(0.5, 2.0)
    with pytest.raises(BadInput, match="rho_inf"):
        generalized_alpha_rule(1.5)
    with pytest.raises(BadInput, match="newmark_limit"):
        newmark_limit(0.5, np.nan)
