"""Frames under stress: no frequency missed, many modes, tiny and huge members, soft springs."""

import frame_truth
import numpy as np
import pytest
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.frequencies import dynamic_stiffness, element_matrices, wittrick_williams
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigvalsh

CLAMPED = ("x", "y", "rotation")


def element_count(structure, omega):
    """Return how many frequencies of the finite elements lie below: signs of K - omega^2 M."""
    mass, stiffness, _ = element_matrices(structure)
    matrix = stiffness - omega**2 * mass
    scale = 1.0 / np.sqrt(np.abs(np.diagonal(stiffness)))
    return int(np.sum(eigvalsh(matrix * np.outer(scale, scale)) < 0.0))


@pytest.mark.slow
@settings(max_examples=10, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.floats(0.1, 0.9))
def test_counts_miss_nothing(seed, share):
    """Between two frequencies the count is the number, for exact members and for fine elements."""
    structure = frame_truth.random_frame(np.random.default_rng(seed))
    fine = frame_truth.random_frame(np.random.default_rng(seed), 6, "internal_node")
    problem = dynamic_stiffness(structure)
    found = wittrick_williams(problem, count=9)
    assert found.passed
    omega = found.frequencies
    for k in range(len(omega) - 1):
        if omega[k + 1] > omega[k] * 1.03 and omega[k] > 0.0:
            trial = omega[k] ** (1 - share) * omega[k + 1] ** share
            trial = min(max(trial, omega[k] * 1.01), omega[k + 1] * 0.99)
            assert problem.count(trial) == k + 1
            assert element_count(fine, trial) == k + 1


@pytest.mark.slow
@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1))
def test_pieces_change_nothing(seed):
    """Members in unequal pieces: the same frequencies within the bounds."""
    rng = np.random.default_rng(seed)
    problem = dynamic_stiffness(frame_truth.random_frame(rng))
    pieces = {}
    for beam in problem.structure.beams:
        cut = float(rng.uniform(0.2, 0.8))
        pieces[beam.name] = (cut, 1.0 - cut)
    whole = wittrick_williams(problem, count=8)
    parts = wittrick_williams(problem.divided(pieces), count=8)
    assert whole.passed and parts.passed
    apart = np.abs(whole.frequencies - parts.frequencies)
    assert np.all(apart <= whole.error + parts.error)
    np.testing.assert_array_equal(whole.multiplicity, parts.multiplicity)


def test_members_of_very_different_size():
    """A member of 1e-4 of the other's length and 1e-9 of its mass takes no digit away."""
    bar = Section.rectangle(0.02, 0.01, modulus=2e11, density=7800.0)
    pin = Section.rectangle(1e-5, 1e-5, modulus=2e11, density=7800.0)
    structure = frame(
        {"A": (0, 0), "B": (1, 0), "C": (1, 1e-4)},
        {"long": ("A", "B"), "short": ("B", "C")},
        {"long": bar, "short": pin},
        supports={"A": CLAMPED},
    )
    alone = frame({"A": (0, 0), "B": (1, 0)}, {"long": ("A", "B")}, bar, supports={"A": CLAMPED})
    found = wittrick_williams(dynamic_stiffness(structure), count=6)
    bare = wittrick_williams(dynamic_stiffness(alone), count=6)
    assert found.passed
    assert np.all(found.error <= 1e-11 * found.frequencies)
    ratio = 1e-4 * pin.area / bar.area
    np.testing.assert_allclose(found.frequencies, bare.frequencies, rtol=5 * ratio)
    assert np.all(found.frequencies < bare.frequencies)


@pytest.mark.parametrize("stiffness", [1e-9, 1e-3, 1e12])
def test_springs_from_next_to_nothing_to_rigid(stiffness):
    """A free bar on a soft spring: sqrt(k / m) where the spring is soft, along its axis."""
    bar = Section.rectangle(0.02, 0.01, modulus=2e11, density=7800.0)
    structure = frame(
        {"A": (0, 0), "B": (1, 0)},
        {"bar": ("A", "B")},
        bar,
        supports={"A": ("y", "rotation")},
        nodes={"B": {"stiffness": {"x": stiffness}}},
    )
    found = wittrick_williams(dynamic_stiffness(structure), count=3)
    assert found.passed
    mass = bar.mass_per_length
    if stiffness < 1.0:
        assert found.frequencies[0] == pytest.approx(np.sqrt(stiffness / mass), rel=1e-8)
    assert np.all(found.error <= 1e-10 * found.frequencies)


def test_a_pole_of_all_members_at_once():
    """Six equal bars in a row, clamped: q = 0 at the bar's own frequency, and its neighbours."""
    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    places = {f"N{k}": (float(k), 0.0) for k in range(7)}
    members = {f"m{k}": (f"N{k}", f"N{k + 1}") for k in range(6)}
    held = {name: ("x", "y") for name in places} | {"N0": CLAMPED, "N6": CLAMPED}
    structure = frame(places, members, bar, supports=held)
    found = wittrick_williams(dynamic_stiffness(structure, inextensible=True), count=13)
    assert found.passed
    # Multi-span bars: six modes from pinned to clamped, the sixth that of a clamped bar.
    assert np.all(np.diff(found.frequencies[:6]) > 0)
    assert found.frequencies[0] > np.pi**2
    assert found.frequencies[5] == pytest.approx(4.730040744862704**2, rel=1e-12)
    assert found.frequencies[11] == pytest.approx(7.853204624095838**2, rel=1e-12)
