"""Krein signatures: hand cases, Krein's theorem, and the motion of multipliers on the circle."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import floquet_multipliers, monodromy
from elastolink.runtime.stability.krein import krein_signatures


def symplectic_unit(n):
    """Return J = [[0, I], [-I, 0]]."""
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))


def _scales(values):
    return {name: np.asarray(value, dtype=float) for name, value in values.items()}


def _pair(coupling: float, sign: float = 1.0, squares=(1.0, 2.3**2), damping=0.0) -> LinearPeriodic:
    """Two oscillators, coupled by cos theta; ``sign`` is the Hamiltonian sign of the second."""
    matrix = coupling * np.array([[0.0, 1.0], [sign, 0.0]])
    terms = (
        Term("M", None, np.eye(2)),
        Term("K", None, np.diag(squares)),
        Term("Kg", None, lambda theta: np.cos(theta)[:, None, None] * matrix),
        Term("C", "c", np.eye(2)),
    )
    return LinearPeriodic(2, terms, {"c": damping}, _scales)


def _rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def _joined(*blocks):
    """Direct sum of 2 x 2 symplectic matrices, state (q1, q2, ..., p1, p2, ...)."""
    n = len(blocks)
    out = np.zeros((2 * n, 2 * n))
    for i, block in enumerate(blocks):
        out[np.ix_([i, n + i], [i, n + i])] = block
    return out


def _signs_of(found, value):
    gap = np.abs(found.multipliers - value)
    assert np.min(gap) < 1e-9
    return int(found.signatures[np.argmin(gap)])


# Hand cases ----------------------------------------------------------------------------------


def test_oscillator_turns_anticlockwise_with_positive_sign():
    """q = exp(i w t), p = i w q: kappa = 2 w > 0, over |x|^2 = 1 + w^2."""
    w, speed = 1.3, 4.1
    terms = (Term("M", None, np.eye(1)), Term("K", None, w**2 * np.eye(1)))
    result = monodromy(LinearPeriodic(1, terms, {}, lambda v: {}), speed)
    found = krein_signatures(result.matrix, result.error)
    turn = np.exp(2j * np.pi * w / speed)
    assert _signs_of(found, turn) == 1
    assert _signs_of(found, np.conj(turn)) == -1
    # p is the momentum over the speed: theta is the time.
    expected = 2 * (w / speed) / (1 + (w / speed) ** 2)
    at = np.argmin(np.abs(found.multipliers - turn))
    assert abs(found.form[at] - expected) <= found.error[at]
    assert found.error[at] < 1e-10
    assert found.inertia[at].tolist() == [1, 0]
    assert found.passed


def test_two_uncoupled_oscillators_one_of_negative_energy():
    angles = (0.7, 2.0)
    found = krein_signatures(_joined(_rotation(angles[0]), _rotation(-angles[1])))
    assert _signs_of(found, np.exp(0.7j)) == 1
    assert _signs_of(found, np.exp(-2.0j)) == 1
    assert _signs_of(found, np.exp(2.0j)) == -1


def test_double_multipliers_have_the_inertia_of_their_subspace():
    equal = krein_signatures(_joined(_rotation(0.9), _rotation(0.9)))
    assert np.all(np.abs(equal.signatures) == 1)
    upper = equal.multipliers.imag > 0
    assert np.all(equal.signatures[upper] == 1)
    assert np.all(equal.inertia[upper] == [2, 0])
    opposite = krein_signatures(_joined(_rotation(0.9), _rotation(-0.9)))
    assert np.all(opposite.signatures == 0)
    assert np.all(opposite.inertia == [1, 1])
    # A definite double multiplier stays on the circle under every small Hamiltonian; Krein,
    # Gelfand, Lidskii.  An indefinite one does not.
    rng = np.random.default_rng(3)
    for matrix, stays in (
        (_joined(_rotation(0.9), _rotation(0.9)), True),
        (_joined(_rotation(0.9), _rotation(-0.9)), False),
    ):
        left = 0
        for _ in range(50):
            push = rng.normal(size=(4, 4))
            moved = matrix @ scipy.linalg.expm(0.01 * symplectic_unit(2) @ (push + push.T))
            left += np.max(np.abs(np.linalg.eigvals(moved))) > 1 + 1e-6
        assert (left == 0) if stays else (left > 5)


@pytest.mark.parametrize("value", [1.0, -1.0])
def test_at_plus_and_minus_one_the_form_is_indefinite(value):
    """Conjugates meet there, which have opposite signatures, whatever the energy."""
    found = krein_signatures(_joined(value * np.eye(2), _rotation(0.4)))
    at = np.abs(found.multipliers - value) < 1e-9
    assert at.sum() == 2
    assert np.all(found.signatures[at] == 0)
    assert np.all(found.inertia[at] == [1, 1])
    assert _signs_of(found, np.exp(0.4j)) == 1


def test_off_the_circle_there_is_none():
    found = krein_signatures(_joined(np.diag([1.3, 1 / 1.3]), _rotation(0.4)))
    assert sorted(found.signatures.tolist()) == [-1, 0, 0, 1]
    assert np.all(found.inertia[found.signatures == 0] == 0)


# Krein's theorem -----------------------------------------------------------------------------


def test_equal_signatures_pass_and_opposite_ones_leave():
    """Symmetric coupling: the difference w2 - w1 is harmless, the sum w1 + w2 opens a tongue."""
    system = _pair(0.02)
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


def test_multipliers_have_the_signatures_in_their_own_order():
    system = _pair(0.3)
    speeds = np.array([[1.9, 2.6], [4.0, 5.0]])
    values = floquet_multipliers(system, speeds)
    result = monodromy(system, speeds)
    alone = krein_signatures(result.scaled, result.error)
    assert values.signatures.shape == values.multipliers.shape
    assert np.allclose(alone.multipliers, values.multipliers, atol=1e-9)
    np.testing.assert_array_equal(alone.signatures, values.signatures)
    assert np.all(np.sum(values.signatures, axis=-1) == 0)


def test_damped_and_circulatory_systems_have_no_signatures():
    for system in (_pair(0.02, damping=0.1), _pair(0.02, sign=-1.0)):
        assert np.all(floquet_multipliers(system, [2.0, 3.0]).signatures == 0)


# An independent route: the motion on the circle --------------------------------------------------


def _flow(potential, wave, push, amount, steps=400):
    """Return the flow of J (S0 + cos S1 + amount (2 + sin) S2) over a turn, by Runge-Kutta."""
    unit = symplectic_unit(len(potential) // 2)

    def rate(theta):
        total = potential + np.cos(theta) * wave + amount * (2 + np.sin(theta)) * push
        return unit @ total

    h = 2 * np.pi / steps
    state = np.eye(len(potential))
    for k in range(steps):
        first, middle, last = (rate(h * (k + part)) for part in (0.0, 0.5, 1.0))
        k1 = first @ state
        k2 = middle @ (state + h / 2 * k1)
        k3 = middle @ (state + h / 2 * k2)
        k4 = last @ (state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state


@pytest.mark.parametrize("n", [1, 2, 3])
def test_signature_tells_the_direction_of_motion(n):
    """Random Hamiltonians, a random positive definite one added: multipliers by differences."""
    rng = np.random.default_rng(100 + n)
    checked = 0
    for _ in range(12):
        base = rng.normal(size=(2 * n, 2 * n)) * 0.4
        potential = (base + base.T) / 2 + np.diag(rng.choice([-0.6, 0.6], 2 * n))
        base = rng.normal(size=(2 * n, 2 * n)) * 0.1
        wave = (base + base.T) / 2
        base = rng.normal(size=(2 * n, 2 * n))
        push = base @ base.T / (2 * n) + 0.05 * np.eye(2 * n)
        matrix = _flow(potential, wave, push, 0.0)
        found = krein_signatures(matrix, 1e-9)
        lower, higher = (np.linalg.eigvals(_flow(potential, wave, push, a)) for a in (-1e-6, 1e-6))
        for value, sign in zip(found.multipliers, found.signatures, strict=True):
            if sign == 0:
                continue
            ends = [e[np.argmin(np.abs(e - value))] for e in (lower, higher)]
            turn = np.angle(ends[1] / ends[0])
            if abs(turn) < 1e-3:
                assert np.sign(turn) == sign
                checked += 1
    assert checked >= 8


def test_an_undecided_sign_is_left_open():
    """Two rotations a hair apart: a matrix error beyond the gap leaves the pair together."""
    near = _joined(_rotation(0.9), _rotation(-0.9 - 1e-7))
    sharp, blunt = krein_signatures(near), krein_signatures(near, 1e-6)
    assert np.all(np.abs(sharp.signatures) == 1)
    assert np.all(blunt.signatures == 0)
    assert np.all(blunt.inertia == [1, 1])


def test_a_decided_sign_survives_every_error_within_the_figure():
    """Matrices at the edge of a tongue, moved by symplectic errors of the stated size."""
    system = _pair(0.02)
    rng = np.random.default_rng(11)
    size, tried = 1e-6, 0
    for speed in 3.3 + np.linspace(-0.014, 0.014, 41):
        matrix = monodromy(system, speed).scaled
        relative = size / np.max(np.abs(matrix)) * 2
        found = krein_signatures(matrix, relative)
        exact = krein_signatures(matrix)
        for _ in range(5):
            push = rng.uniform(-1, 1, size=(4, 4))
            turn = symplectic_unit(2) @ (push + push.T)
            moved = matrix @ scipy.linalg.expm(size / 8 * turn)
            other = krein_signatures(moved)
            for value, sign in zip(found.multipliers, found.signatures, strict=True):
                if sign != 0:
                    at = np.argmin(np.abs(other.multipliers - value))
                    assert other.signatures[at] == sign
                    tried += 1
        assert np.all((found.signatures == 0) | (found.signatures == exact.signatures))
    assert tried > 200


@pytest.mark.parametrize(
    ("matrix", "word"),
    [
        (np.eye(3), "shape"),
        (np.zeros((2, 4)), "shape"),
        (np.full((2, 2), np.nan), "finite"),
        (0.5 * np.eye(2), "symplectic"),
        (np.diag([1j, -1j]), "real numbers"),
        ("abc", "real numbers"),
        ([["a", "b"], ["c", "d"]], "real numbers"),
        ([[1.0, 0.0], [0.0]], "unequal length"),
        (np.diag([1e200, 1e-200]), "size 1e[+]200"),
    ],
)
def test_bad_matrices_are_one_clear_line(matrix, word):
    with pytest.raises(BadInput, match=word) as caught:
        krein_signatures(matrix)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("error", "word"),
    [
        (-1.0, "negative"),
        (np.nan, "missing"),
        ("small", "real numbers"),
        ([1.0, 2.0], "broadcasts"),
    ],
)
def test_bad_errors_are_one_clear_line(error, word):
    with pytest.raises(BadInput, match=word) as caught:
        krein_signatures(np.eye(2), error)
    assert "\n" not in str(caught.value)


def test_an_error_without_bound_leaves_every_sign_open():
    found = krein_signatures([_rotation(0.3), _rotation(0.3)], [1e-12, np.inf])
    assert np.all(np.abs(found.signatures[0]) == 1)
    assert np.all(found.signatures[1] == 0)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("exponent", [-330, -60, 60, 330])
def test_large_entries_make_no_missing_figures(exponent):
    """Shears, and growth far beyond the round-off of the rest; powers of two are exact."""
    shear = np.array([[1.0, 2.0**exponent], [0.0, 1.0]])
    growth = np.diag([2.0**exponent, 2.0**-exponent])
    for matrix in (shear, growth, _joined(shear, _rotation(0.4)), _joined(growth, growth)):
        found = krein_signatures(matrix)
        assert not np.any(np.isnan(found.error))
        assert np.all(np.isfinite(found.multipliers))
        if matrix is growth:
            assert np.all(found.signatures == 0)
