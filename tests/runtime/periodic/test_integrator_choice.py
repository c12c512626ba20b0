"""The method that a simulation takes by itself, and the comparison that stands behind it."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.integrators import METHODS
from elastolink.runtime.integrators.comparison import Work, fastest, flow, work_against_error
from elastolink.runtime.simulation import simulate


def _rows(count, stiffness):
    def turning(theta):
        wave = 1 + 0.3 * np.cos(theta)[:, None, None]
        return stiffness * wave * np.diag(np.arange(1.0, count + 1))

    return LinearPeriodic(
        count,
        (
            Term("M", None, np.eye(count)),
            Term("K", None, turning),
            Term("C", None, 0.1 * np.eye(count)),
            Term("f", None, lambda t: np.cos(t)[:, None] * np.ones(count)),
        ),
        {},
        lambda values: {},
    )


@pytest.mark.parametrize(
    ("count", "stiffness", "rtol"),
    [(2, 4.0, 1e-6), (2, 4.0, None), (2, 4e4, 1e-6), (9, 4e3, 1e-6), (9, 4e3, 1e-11)],
)
def test_the_automatic_method(count, stiffness, rtol):
    system = _rows(count, stiffness)
    run = simulate(system, 1.0, 0.25, rtol=rtol)
    assert run.method == "power_series"
    assert run.passed, run.checks
    assert np.max(run.error) <= (1e-9 if rtol is None else rtol)
    assert simulate(system, 1.0, 0.25, steps=360).method == "gauss_legendre"


def test_work_against_error_of_a_coupler():
    system = el.load_scene("smith_1972_5152_thirtysecond_inch").system()
    form = canonical_form(system, [18.0, 22.0])
    exact = flow(METHODS["gauss_legendre16"], form, 48)
    methods = [METHODS[name] for name in ("magnus4", "magnus8", "srkn6")]
    rows = work_against_error(form, methods, (32, 64, 128), exact, repeats=1)
    assert [(row.method, row.steps) for row in rows[:3]] == [
        ("magnus4", 32),
        ("magnus4", 64),
        ("magnus4", 128),
    ]
    for first in (0, 3, 6):
        errors = [row.error for row in rows[first : first + 3]]
        assert errors[0] > 5 * errors[1] > 25 * errors[2] > 0
        assert all(row.seconds > 0 for row in rows)
    assert {row.method for row in fastest(rows, 1e-8)} <= {"magnus8", "srkn6"}


def test_a_refused_method_has_no_error():
    def turned(theta):
        return np.array([[0.0, 1.0], [-1.0, 0.0]]) * np.cos(theta)[:, None, None]

    system = LinearPeriodic(
        2,
        (Term("M", None, np.eye(2)), Term("A", None, turned), Term("K", None, np.eye(2))),
        {},
        lambda values: {},
    )
    form = canonical_form(system, 1.0)
    exact = flow(METHODS["gauss_legendre16"], form, 8)
    (row,) = work_against_error(form, [METHODS["srkn4"]], (8,), exact)
    assert row.error == np.inf
    assert fastest([row, Work("other", 8, 1e-3, 1.0)], 1e-2) == (Work("other", 8, 1e-3, 1.0),)
