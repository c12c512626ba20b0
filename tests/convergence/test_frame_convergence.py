"""Frames: finite elements against the exact frequencies; Table 5.1 is in the ledger."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.frequencies import dynamic_stiffness, element_matrices, wittrick_williams
from frame_truth import portal
from scipy.linalg import eigh


def element_frequencies(structure, first, **options):
    """Return the first frequencies; Rayleigh's quotients take out the solver's errors."""
    mass, stiffness, _ = element_matrices(structure, **options)
    vectors = eigh(stiffness, mass)[1][:, :first].astype(np.longdouble)
    elastic, inert = (np.sum(vectors * (form @ vectors), axis=0) for form in (stiffness, mass))
    return np.sqrt(elastic / inert).astype(float)


@pytest.fixture(scope="module")
def exact():
    return wittrick_williams(dynamic_stiffness(portal(), inextensible=True), count=21)


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
