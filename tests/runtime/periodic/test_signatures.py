"""Krein signatures: hand cases, Krein's theorem, and the motion of multipliers on the circle."""

import numpy as np
import pytest
import scipy.linalg
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.signatures import signatures_of
from periodic_systems import coupled_pair


def symplectic_unit(n):
    """Return J = [[0, I], [-I, 0]]."""
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))


def _rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def _joined(*blocks):
    """Direct sum of 2 x 2 symplectic matrices, state (q1, q2, ..., p1, p2, ...)."""
    n = len(blocks)
    out = np.zeros((2 * n, 2 * n))
    for i, block in enumerate(blocks):
        out[np.ix_([i, n + i], [i, n + i])] = block
    return out


def signed(matrix, error=1e-14):
    """Return the multipliers of a symplectic matrix and their signatures."""
    values, vectors = np.linalg.eig(np.asarray(matrix, dtype=float))
    values, vectors = values.astype(complex)[None], vectors.astype(complex)[None]
    return values[0], signatures_of(vectors, values, np.full(values.shape, error))[0]


def sign_of(spectrum, value):
    gap = np.abs(spectrum[0] - value)
    assert np.min(gap) < 1e-9
    return int(spectrum[1][np.argmin(gap)])


def test_multiple_multipliers_are_decided_where_the_form_is_definite():
    """A definite double one stays on the circle under every small Hamiltonian; Gelfand, Lidskii."""
    rng = np.random.default_rng(3)
    for second, stays in ((0.9, True), (-0.9, False)):
        matrix = _joined(_rotation(0.9), _rotation(second))
        assert np.all(np.abs(signed(matrix)[1]) == int(stays))
        left = 0
        for _ in range(50):
            push = rng.normal(size=(4, 4))
            moved = matrix @ scipy.linalg.expm(0.01 * symplectic_unit(2) @ (push + push.T))
            left += np.max(np.abs(np.linalg.eigvals(moved))) > 1 + 1e-6
        assert (left == 0) if stays else (left > 5)


@pytest.mark.parametrize("value", [1.0, -1.0])
def test_at_plus_and_minus_one_and_off_the_circle_there_is_none(value):
    """Conjugates meet there, which have opposite signatures, whatever the energy."""
    values, signs = signed(_joined(value * np.eye(2), _rotation(0.4)))
    assert np.all(signs[np.abs(values - value) < 1e-9] == 0)
    assert sign_of((values, signs), np.exp(0.4j)) == 1
    off = signed(_joined(np.diag([1.3, 1 / 1.3]), _rotation(0.4)))[1]
    assert sorted(off.tolist()) == [-1, 0, 0, 1]


def test_equal_signatures_pass_and_opposite_ones_leave():
    """Symmetric coupling: the difference w2 - w1 is harmless, the sum w1 + w2 opens a tongue."""
    system = coupled_pair(0.02)
    apart = np.linspace(-0.012, 0.012, 25)
    difference = floquet_multipliers(system, 1.3 + apart)
    upper = difference.multipliers.imag > 0
    assert np.all(difference.stable)
    # The two that meet, exp(2 pi i 2.3/1.3) and exp(2 pi i/1.3), lie in the lower half plane.
    assert np.all(difference.signatures[upper] == -1)
    assert np.all(difference.signatures[~upper] == 1)
    total = floquet_multipliers(system, 3.3 + apart)
    assert 5 < np.sum(~total.stable) < 20
    outside = total.stable
    upper = total.multipliers.imag > 0
    for row in np.flatnonzero(outside):
        assert sorted(total.signatures[row][upper[row]].tolist()) == [-1, 1]
    assert np.all(total.signatures[~outside] == 0)


def test_damped_and_circulatory_systems_have_no_signatures():
    for system in (coupled_pair(0.02, damping=0.1), coupled_pair(0.02, sign=-1.0)):
        assert np.all(floquet_multipliers(system, [2.0, 3.0]).signatures == 0)


def _flow(first, second, push, amount):
    """Return the flow over a turn of a Hamiltonian that is constant over each half of it."""
    unit = np.pi * symplectic_unit(len(push) // 2)
    halves = (first + amount * push, second + 3 * amount * push)
    return scipy.linalg.expm(unit @ halves[1]) @ scipy.linalg.expm(unit @ halves[0])


@pytest.mark.parametrize("n", [1, 2, 3])
def test_signature_tells_the_direction_of_motion(n):
    """Random Hamiltonians, a random positive definite one added: multipliers by differences."""
    rng = np.random.default_rng(100 + n)
    checked = 0
    for _ in range(12):
        base = rng.normal(size=(2 * n, 2 * n)) * 0.4
        first = (base + base.T) / 2 + np.diag(rng.choice([-0.6, 0.6], 2 * n))
        base = rng.normal(size=(2 * n, 2 * n)) * 0.1
        second = first + (base + base.T) / 2
        base = rng.normal(size=(2 * n, 2 * n))
        push = base @ base.T / (2 * n) + 0.05 * np.eye(2 * n)
        found = signed(_flow(first, second, push, 0.0), 1e-10)
        lower, higher = (np.linalg.eigvals(_flow(first, second, push, a)) for a in (-1e-6, 1e-6))
        for value, sign in zip(*found, strict=True):
            if sign == 0:
                continue
            ends = [e[np.argmin(np.abs(e - value))] for e in (lower, higher)]
            turn = np.angle(ends[1] / ends[0])
            if abs(turn) < 1e-3:
                assert np.sign(turn) == sign
                checked += 1
    assert checked >= 8


def test_an_undecided_sign_is_left_open():
    """Two rotations a hair apart: an error beyond the gap leaves the pair together."""
    near = _joined(_rotation(0.9), _rotation(-0.9 - 1e-7))
    assert np.all(np.abs(signed(near)[1]) == 1)
    assert np.all(signed(near, 1e-6)[1] == 0)
