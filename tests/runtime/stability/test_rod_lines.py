"""Monodromy matrices of the flexible rod: symplectic, by two methods, mirrored halves."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from edge_truth import flexible_rod
from elastolink.runtime.core.families import Term
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.stability.chart_lines import Lines, is_mirrored
from elastolink.runtime.stability.chart_sampling import Sampler
from elastolink.runtime.stability.invariants import from_sum, in_sum, weighed_characteristic
from elastolink.runtime.systems.rod import OverhangBasis, PolynomialBasis

BASES = {"polynomial": PolynomialBasis(3), "overhang": OverhangBasis(4)}
SPEEDS = np.array([500.0, 611.3, 1234.5, 4000.0])


def rod(**changes):
    return flexible_rod(PolynomialBasis(3), 0.2, **changes)


def line(system, reduced):
    """The invariants at some speeds, from one line of a chart at zero damping."""
    sampler = Sampler(system, ("speed", "damping"), (SPEEDS, np.array([0.0, 1e-9])), None, 1e-11)
    lines = Lines(sampler)
    lines.reduced = reduced
    values = sampler.transform("speed", SPEEDS)
    made = lines.line(0.0, float(values.min()), float(values.max()), None, 1.0)
    return made, made(values)[0][:, : system.size]


@pytest.mark.parametrize("reduced", [True, False])
@pytest.mark.parametrize("basis", BASES)
def test_lines_of_a_chart_agree_with_collocation_at_each_speed(basis, reduced):
    """Tables of half of the period, or of the whole of it."""
    system = flexible_rod(BASES[basis], 0.2)
    piece, found = line(system, reduced=reduced)
    assert piece.half is reduced
    direct = el.monodromy(system, SPEEDS, rtol=1e-13)
    wanted = weighed_characteristic(direct.scaled, system.size)[0]
    # Invariants move with the matrices, whose errors are below 1e-12 by either method.
    assert np.max(np.abs(found - wanted)) <= 1e-11 * np.max(np.abs(wanted))


def test_damping_is_never_taken_for_a_mirror_image():
    """A moving wave of stiffness has no mirrored half either."""
    skew = rod().with_terms(Term("Kg", None, lambda t: np.sin(t)[:, None, None] * np.eye(3)))
    assert is_mirrored(equation_of(rod(), 500.0))
    assert not is_mirrored(equation_of(rod(damping=20.0), 500.0))
    assert not is_mirrored(equation_of(skew, 500.0))


def test_too_many_segments_are_refused():
    with pytest.raises(el.BadInput, match=r"raise the (lowest )?speed"):
        el.stability_chart(rod(), ("speed", [1e-3, 1.0]), ("crank_ratio", [0.1, 0.2]))


def test_sums_and_coefficients_are_two_forms_of_one_polynomial():
    """Hand case: rho = exp(+-i a) has z = 2 cos a."""
    z = 2.0 * np.cos([0.3, 1.1, 2.9])
    polynomial = np.poly(z)[1:]
    whole = np.poly(np.exp(1j * np.array([0.3, 1.1, 2.9, -0.3, -1.1, -2.9]))).real
    assert np.allclose(from_sum(polynomial), whole[1:4], atol=1e-14)
    assert np.allclose(in_sum(whole[1:4]), polynomial, atol=1e-14)
