"""The linear system of the flexible rod: Newton's law, tension and frame, damping, geometry."""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import DAMPING, Term
from elastolink.runtime.hill.form import is_hill
from elastolink.runtime.stability import resonances, tongue
from elastolink.runtime.systems import rod_system
from free_free_loads import ROD
from numpy.polynomial.legendre import leggauss
from periodic_systems import second_order
from plain_basis import PlainBasis

PRINTED = ("frame", "tension")
NUMBERS = {
    "crank_ratio": 0.3,
    "frame": 0.6,
    "length": 1.3,
    "bending_stiffness": 40.0,
    "mass_per_length": 2.5,
    "damping": 3.0,
    "internal_damping": 0.07,
}
FLEXIBLE = {"crank_ratio": 0.2, **ROD}


LONG_CRANK = {**NUMBERS, "crank_ratio": 1.5, "frame": 0.4}  # the rod turns round


def by_newton(numbers, basis, theta, speed, acceleration, taut):
    """Return the matrices of q, qd, qdd and the force of the rod, in axes that turn with the line.

    m (v_tt + x phi_tt - phi_t^2 v) + c v_t + EI v + c_i v_t = (N v')' in its weak form, with
    N = m phi_t^2 (L^2 - x^2)/2 and v = L sum q_k e_k(x/L, xi); the basis is linear in xi.
    """
    frame, length, mass = (numbers[name] for name in ("frame", "length", "mass_per_length"))
    arm = numbers["crank_ratio"] * frame * np.exp(1j * theta)
    # The block from the pin, z = slide exp(i phi), differentiated in time.
    z, first = frame + arm, 1j * speed * arm / (frame + arm)
    second = (1j * acceleration - speed**2) * arm / z - first**2
    turn, bend = first.imag, second.imag
    place = np.array([abs(z) / length])
    moved, moved2 = place * first.real, place * (second.real + first.real**2)
    nodes, weights = leggauss(basis.size + 4)
    eta = (nodes + 1) / 2
    e, slope, bent = (basis.shapes(eta, place, order)[0] for order in (0, 1, 2))
    d, bent_d = basis.drifts(eta, place)[0], basis.drifts(eta, place, 2)[0]

    def integral(left, right, weight=1.0):
        return length**3 * (left.T * (weights / 2 * weight)) @ right

    drag, loss = numbers["damping"], numbers["internal_damping"] / length**4
    stiffness = mass * (moved2 * integral(e, d) - turn**2 * integral(e, e))
    stiffness += numbers["bending_stiffness"] / length**4 * integral(bent, bent)
    stiffness += moved * (drag * integral(e, d) + loss * integral(bent, bent_d))
    if taut:
        stiffness += mass * turn**2 * integral(slope, slope, (1 - eta**2) / 2)
    damping = (
        2 * mass * moved * integral(e, d) + drag * integral(e, e) + loss * integral(bent, bent)
    )
    return stiffness, damping, mass * integral(e, e), -mass * bend * integral(e, eta)


@pytest.mark.parametrize("drop", [(), PRINTED])
@pytest.mark.parametrize("rates", [(5.0, 11.0), (7.0, 0.0)])
@pytest.mark.parametrize(
    ("numbers", "theta"), [(NUMBERS, 0.9), (LONG_CRANK, 0.9), (LONG_CRANK, 2.8)]
)
def test_equations_are_newtons_law(numbers, theta, rates, drop):
    basis = PlainBasis(2)
    found = second_order(rod_system(basis, **numbers, drop=drop), theta, *rates)
    exact = by_newton(numbers, basis, theta, *rates, taut=not drop)
    unit = numbers["mass_per_length"] * numbers["length"] ** 3
    for matrix, expected in zip(found, exact, strict=True):
        size = np.max(np.abs(expected / unit))
        np.testing.assert_allclose(matrix[0], expected / unit, rtol=0, atol=1e-11 * size)


def tension_from_frame(basis, place):
    """Return ``int (1 - eta^2)/2 u_i' u_j'``, u from the straight line of least squares."""
    nodes, weights = leggauss(basis.size + 4)
    x, w = (nodes + 1) / 2, weights / 2
    line = np.stack([np.ones_like(x), x], -1)
    projector = np.linalg.solve(line.T @ (w[:, None] * line), (w[:, None] * line).T)
    fitted = projector @ basis.shapes(x, place)
    slopes = basis.shapes(x, place, 1) - fitted[:, 1:2, :]
    return np.einsum("x,txi,txj->tij", w * (1 - x**2) / 2, slopes, slopes)


def test_tension_is_that_from_the_frame_and_the_frames_own():
    basis, theta = PlainBasis(4), np.linspace(0.0, 2 * np.pi, 9)
    made = {
        drop: rod_system(basis, **NUMBERS, drop=drop).array("B", theta)
        for drop in ((), PRINTED, ("tension",), ("frame",))
    }
    linkage = el.QuickReturn(
        frame=NUMBERS["frame"],
        crank=NUMBERS["crank_ratio"] * NUMBERS["frame"],
        rod=NUMBERS["length"],
    )
    motion = linkage.motion(theta)
    place, square = motion.slide / NUMBERS["length"], motion.omega4[:, None, None] ** 2
    size = np.max(square) * np.max(np.abs(basis.array("tension", place)))
    from_line = square * basis.array("tension", place)
    from_frame = square * tension_from_frame(basis, place)
    for found, expected in (
        (made[PRINTED] - made[()], from_line),
        (made[PRINTED] - made[("frame",)], from_frame),
        (made[("tension",)] - made[()], from_frame),
    ):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * size)
    assert np.max(np.abs(from_line - from_frame)) > 0.1 * size


def test_damping_through_d_alone_counts_as_damping():
    system = rod_system(PlainBasis(2), **{**FLEXIBLE, "damping": 1.0}).without("C")
    assert system.is_damped()
    assert not system.without(*DAMPING).is_damped()
    one = rod_system(PlainBasis(1), **{**FLEXIBLE, "damping": 1.0}).without("A")
    constant = Term("M", None, np.ones((1, 1)))
    still = replace(one.without("A", "M", "C", "K"), terms=(constant, *one.without("M").terms))
    assert not is_hill(still)


def test_geometry_that_cannot_be_changed():
    system = rod_system(PlainBasis(1), **FLEXIBLE)
    with pytest.raises(BadInput, match="crank_ratio"):
        system.with_geometry(crank=0.1)
    with pytest.raises(BadInput, match="eps = 1"):
        system.with_geometry(crank_ratio=1.0)


def test_integrals_are_found_once_for_all_terms():
    class Counting(PlainBasis):
        calls = 0

        def array(self, name, place):
            Counting.calls += 1
            return super().array(name, place)

    system = rod_system(Counting(2), **FLEXIBLE, drop=("frame",))
    Counting.calls = 0
    theta = np.linspace(0.0, 1.0, 7)
    for name in ("M", "A", "B", "C", "D", "K", "f", "g"):
        system.array(name, theta)
    assert Counting.calls == 8  # each name once


def test_a_rod_that_just_reaches_the_block():
    """0.1 + 0.2 is more than 0.3 in doubles, which is no reason to refuse the rod."""
    numbers = {**FLEXIBLE, "frame": 0.2, "crank_ratio": 0.5, "length": 0.3}
    assert 0.5 * 0.2 + 0.2 > 0.3
    system = rod_system("overhang", 2, **numbers)
    assert np.all(np.isfinite(system.array("K", np.zeros(1))))


def test_a_tongue_sees_internal_damping():
    """Internal damping on a mode that changes with the block: ends to order 6, exact ends."""
    numbers = {**FLEXIBLE, "crank_ratio": 0.05, "internal_damping": 1.0}
    system, span = rod_system("overhang", 1, **numbers), (1500.0, 1900.0)
    (resonance,) = resonances(system, span)
    exact = el.stability_edges(system, span)
    found = tongue(system, resonance, order=6)
    without = tongue(system.without("D"), resonance, order=6)
    for end in ("lower", "upper"):
        value, truth = getattr(found, end), getattr(exact, end)[0]
        assert abs(value - truth) < found.error
        assert abs(getattr(without, end) - truth) > 30 * found.error
