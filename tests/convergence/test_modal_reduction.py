"""Reduction to moving modes: what it keeps exactly, and how fast it converges with the modes.

References: the full system's own multipliers, and its motion by Fourier collocation of the
equations in second-order form, which shares nothing with the harmonic balance of the reduction.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.benchmarking.curve_rivals import SecondOrder, collocated
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic import moving_basis, reduced_system
from elastolink.runtime.reduction.balance import balance, samples_table
from elastolink.runtime.reduction.condensed import condense
from elastolink.runtime.reduction.residuals import corrected_motion, motion_of

# Enough for subspaces whose next frequency comes within a tenth.
ANGLES = 512
SCENE = "aannaque_1996_table_4_1"


def linkage(elements=1, ratio=0.02):
    overrides = {"mesh.elements": elements, "damping.ratio": ratio}
    return el.load_scene(SCENE, overrides=overrides).system()


@pytest.fixture(scope="module")
def damped():
    return linkage()


def test_the_basis_is_smooth_periodic_and_orthonormal(damped):
    basis = moving_basis(damped, 4)
    theta = np.linspace(0.0, 4.0 * np.pi, 37)
    phi = basis(theta)
    mass = damped.array("M", theta)
    unit = np.swapaxes(phi, 1, 2) @ mass @ phi
    assert np.max(np.abs(unit - np.eye(4))) < 1e-11
    assert np.max(np.abs(basis(theta + 2.0 * np.pi) - phi)) < 1e-12 * np.max(np.abs(phi))
    # Central differences of order two: the error is that of the step, 1e-5 squared, and round-off.
    step = 1e-5
    slope = (basis(theta + step) - basis(theta - step)) / (2.0 * step)
    assert np.max(np.abs(slope - basis.derivative(theta))) < 1e-8 * np.max(np.abs(phi))


def test_the_basis_spans_the_lowest_modes_where_they_cross_or_not(damped):
    """K and M on the basis have the lowest frequencies, whatever the crossings within."""
    basis = moving_basis(damped, 4)
    theta = np.array([0.3, 1.7, 4.4])
    phi = basis(theta)
    small = np.swapaxes(phi, 1, 2) @ damped.array("K", theta) @ phi
    mass, stiffness = damped.array("M", theta), damped.array("K", theta)
    for k in range(3):
        wanted = np.sort(np.linalg.eigvals(np.linalg.solve(mass[k], stiffness[k])).real)[:4]
        assert np.linalg.eigvalsh(small[k]) == pytest.approx(wanted, rel=1e-8)


@pytest.mark.slow
def test_all_modes_are_the_system_itself(damped):
    full = el.floquet_multipliers(damped, 62.0)
    whole = el.floquet_multipliers(reduced_system(damped, 9), 62.0)
    large = np.abs(full.multipliers) > 1e-6
    wanted = np.sort_complex(full.multipliers[large])
    found = np.sort_complex(whole.multipliers[np.abs(whole.multipliers) > 1e-6])
    assert np.max(np.abs(found - wanted)) < 1e-8


@pytest.mark.slow
def test_multipliers_of_fewer_modes_approach_those_of_the_full_system(damped):
    """What a mode more changes falls; with 8 of 9 the rest is of the size of its own coupling."""
    wanted = np.sort(np.abs(el.floquet_multipliers(damped, 62.0).multipliers))[::-1][:8]
    errors = []
    for modes in (4, 8):
        found = el.floquet_multipliers(reduced_system(damped, modes), 62.0).multipliers
        errors.append(np.max(np.abs(np.sort(np.abs(found))[::-1][:8] - wanted)))
    assert errors[0] < 1e-3
    assert errors[1] < 0.3 * errors[0]


def test_an_undamped_reduced_system_stays_symplectic():
    """Outside its bands every multiplier of the reduced system is on the circle to round-off."""
    reduced = reduced_system(linkage(ratio=0.0), 4)
    found = np.abs(el.floquet_multipliers(reduced, 45.0).multipliers)
    assert np.max(np.abs(np.sort(found) * np.sort(found)[::-1] - 1.0)) < 1e-9


def test_what_cannot_be_reduced_is_refused(damped):
    for modes in (0, 10, 2.5, True):
        with pytest.raises(BadInput, match="modes"):
            reduced_system(damped, modes)


def test_another_geometry_gets_modes_of_its_own(damped):
    changed = reduced_system(damped, 4).with_geometry(coupler=0.636)
    wanted = reduced_system(damped.with_geometry(coupler=0.636), 4)
    theta = np.array([0.4, 2.0])
    assert changed.array("K", theta) == pytest.approx(wanted.array("K", theta), rel=1e-9)


def motion_errors(system, modes, answers, speed, harmonics=40):
    """Return the error of q over its peak: as condensed, and corrected by the full equation."""
    basis = moving_basis(system, modes, angles=ANGLES)
    condensed = condense(system, basis, answers=answers)
    equation = balance(condensed, harmonics)
    x = np.linalg.solve(equation.taylor(speed)[0], equation.load(speed))
    table = samples_table(condensed.theta, harmonics, 1.0)
    if answers:
        motions = corrected_motion(condensed, equation, x, speed, table)
    else:
        motions = (motion_of(condensed, equation, x, speed, table),)
    truth = collocated(SecondOrder(system, 97), speed)
    wave = np.fft.rfft(truth, axis=0)
    truth = np.fft.irfft(wave, n=ANGLES, axis=0) * (ANGLES / 97)
    return [np.max(np.abs(q - truth)) / np.max(np.abs(truth)) for q in motions]


def test_the_error_falls_with_every_static_answer(damped):
    """Each is worth the square of a frequency ratio: some 290 rad/s excited, 1700 left out."""
    errors = [motion_errors(damped, 4, answers, 40.0)[0] for answers in (0, 1, 2)]
    assert errors[0] < 1e-2
    assert errors[0] > 10.0 * errors[1]
    assert errors[1] > 5.0 * errors[2]


def test_the_full_equation_corrects_what_is_left(damped):
    before, after = motion_errors(damped, 4, 2, 40.0)
    assert after < 0.5 * before


def test_three_elements_reduce_as_well_and_better_with_more_modes():
    full = linkage(elements=3)
    errors = [motion_errors(full, m, 2, 40.0)[0] for m in (4, 6)]
    assert errors[0] < 2e-4
    assert errors[1] < 0.2 * errors[0]
