"""Frames: finite elements against the exact frequencies, slopes; Table 5.1 is in the ledger."""

from __future__ import annotations

from dataclasses import replace

import frame_truth
import numpy as np
import pytest
from elastolink.runtime.frequencies import (
    dynamic_stiffness,
    element_matrices,
    wittrick_williams,
)
from frame_truth import portal
from scipy.linalg import eigh


def element_frequencies(structure, first=None, **options):
    """Return the first frequencies, or all, as :func:`rounded_frequencies` does."""
    return rounded_frequencies(structure, first, **options)[0]


def rounded_frequencies(structure, first=None, **options):
    """Return the first frequencies, or all, and what rounding of the matrices does to each.

    Rayleigh's quotients in more digits take out the errors of the eigenvalue solver, which are of
    the size of the largest eigenvalue times the machine's precision: they enter squared.  What is
    left is the rounding of the entries of K and M themselves.  Entries off by eps of their size
    move a quotient by up to ``eps (|x|^T |K| |x| / x^T K x + |x|^T |M| |x| / x^T M x)`` of itself,
    and a frequency by half of that.
    """
    mass, stiffness, _ = element_matrices(structure, **options)
    vectors = eigh(stiffness, mass)[1][:, :first].astype(np.longdouble)
    pair = (stiffness, mass)
    forms = [np.sum(vectors * (matrix @ vectors), axis=0) for matrix in pair]
    sizes = [np.sum(abs(vectors) * (abs(matrix) @ abs(vectors)), axis=0) for matrix in pair]
    frequency = np.sqrt(forms[0] / forms[1]).astype(float)
    share = 0.5 * np.finfo(float).eps * (sizes[0] / forms[0] + sizes[1] / forms[1])
    return frequency, frequency * share.astype(float)


@pytest.fixture(scope="module")
def exact():
    return wittrick_williams(dynamic_stiffness(portal(), inextensible=True), count=21)


@pytest.mark.parametrize(
    ("kind", "order", "counts"), [("cubic", 4, (8, 16, 32)), ("internal_node", 8, (5, 7, 9))]
)
def test_finite_elements_converge_with_their_order(kind, order, counts, exact):
    """The first six frequencies from above, with slopes 4 and 8, as far as rounding lets it show.

    Rounding of the matrices of 7 quintic elements moves the first frequency by up to 2e-11, more
    than their discretisation does: Rayleigh's principle holds to that.
    """
    truth, bound = exact.frequencies[:6], exact.error[:6]
    errors, shares = [], []
    for count in counts:
        computed, rounding = rounded_frequencies(portal(count, kind), 6, inextensible=True)
        assert np.all(computed > truth - bound - rounding)
        errors.append(computed / truth - 1.0)
        shares.append((bound + rounding) / truth)
    for coarse, fine, share, one, two in zip(
        errors, errors[1:], shares[1:], counts, counts[1:], strict=False
    ):
        # A tenth of the slope is 0.2 or more of the error: rounding may be a twentieth.
        seen = share < 0.05 * np.abs(fine)
        slope = np.log(coarse[seen] / fine[seen]) / np.log(two / one)
        assert np.sum(seen) >= 3
        assert np.all(np.abs(slope - order) < 0.1 * order)


def test_dynamic_stiffness_is_the_limit(exact):
    """Sixteen quintic elements a bar: the first seven frequencies to 1e-10."""
    found = element_frequencies(portal(16, "internal_node"), 7, inextensible=True)
    np.testing.assert_allclose(found, exact.frequencies[:7], rtol=1e-10)


def test_inextensible_bars_are_the_limit_of_stiff_ones():
    """The change goes with 1/EA, as in any penalty."""
    rigid = wittrick_williams(dynamic_stiffness(portal(), inextensible=True), count=6).frequencies
    gaps = []
    for area in (1e-2, 1e-1):  # the mass per length stays
        structure = portal()
        beams = tuple(
            replace(beam, section=replace(beam.section, area=area, density=1.0 / area))
            for beam in structure.beams
        )
        found = wittrick_williams(dynamic_stiffness(replace(structure, beams=beams)), count=6)
        gaps.append(rigid / found.frequencies - 1.0)
    # The fourth is that of clamped bars: no stretch in it.
    moved = np.arange(6) != 3
    assert np.all(np.abs(gaps[1][moved]) < 1e-5)
    np.testing.assert_allclose(gaps[0][moved] / gaps[1][moved], 10.0, rtol=1e-2)


@pytest.mark.slow
def test_random_frames_against_finite_elements():
    """15 frames: the lowest frequencies of quintic elements come down on the exact ones."""
    rng = np.random.default_rng(55)
    for _ in range(15):
        state = rng.bit_generator.state
        structure = frame_truth.random_frame(rng)
        rng.bit_generator.state = state
        fine = frame_truth.random_frame(rng, elements=4, kind="internal_node")
        found = wittrick_williams(dynamic_stiffness(structure), count=6)
        reference = element_frequencies(fine, 6)
        assert found.passed
        np.testing.assert_allclose(found.frequencies, reference, rtol=5e-3)
        assert np.all(reference >= found.frequencies * (1 - 1e-7))
