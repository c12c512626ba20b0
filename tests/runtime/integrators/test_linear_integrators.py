"""What integrators for linear systems keep: symplecticity, reversal, batches, zero, forcing."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.integrators import METHODS

SYMPLECTIC = sorted(name for name, method in METHODS.items() if method.symplectic)
NYSTROEM = ("srkn4", "srkn6")
N = 2
UNIT = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(N))
THETA = np.array([0.0, 0.4, 0.8])


def _split(theta):
    """q' = U(theta) p, p' = V(theta) q with symmetric U and V."""
    c, s = np.cos(theta), np.sin(2 * theta)
    out = np.zeros((len(theta), 2 * N, 2 * N))
    out[:, 0, 2], out[:, 1, 3] = 1.0 + 0.2 * c, 1.5
    out[:, 0, 3] = out[:, 1, 2] = 0.3 * s
    out[:, 2, 0], out[:, 3, 1] = -6.0 + 2 * s, -9.0 + c
    out[:, 2, 1] = out[:, 3, 0] = 0.8 * c
    return out


def _hamiltonian(theta):
    """The same with Coriolis terms; the split form for methods that need it is `_split`."""
    out = _split(theta)
    gyro = np.array([[0.2, -0.7], [0.9, 0.1]]) * np.cos(theta)[:, None, None]
    out[:, :N, :N] -= gyro
    out[:, N:, N:] += np.swapaxes(gyro, -1, -2)
    return out


def _generator(name):
    return _split if name in NYSTROEM else _hamiltonian


@pytest.mark.parametrize("name", SYMPLECTIC)
@pytest.mark.parametrize("step", [0.05, 0.4, 1.3])
def test_undamped_steps_are_symplectic_to_round_off(name, step):
    matrices = METHODS[name].maps(_generator(name), THETA, step)
    defect = np.swapaxes(matrices, -1, -2) @ UNIT @ matrices - UNIT
    size = np.max(np.abs(matrices), axis=(-2, -1))
    assert np.all(np.max(np.abs(defect), axis=(-2, -1)) < 1e-14 * np.maximum(size, 1.0) ** 2)
    np.testing.assert_allclose(np.linalg.det(matrices), 1.0, atol=1e-13 * np.max(size) ** 2)


@pytest.mark.parametrize("name", SYMPLECTIC)
def test_symmetric_methods_undo_their_own_step(name):
    step = 0.4
    ahead = METHODS[name].maps(_generator(name), THETA, step)
    back = METHODS[name].maps(_generator(name), THETA + step, -step)
    np.testing.assert_allclose(
        back @ ahead, np.broadcast_to(np.eye(2 * N), ahead.shape), atol=3e-14
    )


@pytest.mark.parametrize("name", NYSTROEM)
def test_a_batch_of_split_systems_gives_the_steps_of_its_members(name):
    def batch(theta):
        return np.stack([_split(theta), 2 * _split(theta)])

    maps = METHODS[name].maps(batch, THETA, 0.1)
    for index, factor in enumerate((1, 2)):
        alone = METHODS[name].maps(lambda at, f=factor: f * _split(at), THETA, 0.1)
        np.testing.assert_allclose(maps[index], alone, rtol=1e-14, atol=1e-16)


@pytest.mark.parametrize("name", NYSTROEM)
def test_split_methods_refuse_what_they_cannot_step(name):
    with pytest.raises(BadInput, match=f"{name}: found damping, Coriolis"):
        METHODS[name].maps(_hamiltonian, THETA, 0.1)

    def growing(theta):
        out = np.zeros((len(theta), 5, 5))
        out[:, :4, :4] = _split(theta)
        out[:, 4, 4] = 1.0
        return out

    with pytest.raises(BadInput, match="Coriolis"):
        METHODS[name].maps(growing, THETA, 0.1)


@pytest.mark.parametrize("name", sorted(set(METHODS) - {"de_vogelaere"}))
def test_nothing_moves_where_the_generator_is_zero(name):
    for size in (2, 3, 4):
        maps = METHODS[name].maps(lambda theta, m=size: np.zeros((len(theta), m, m)), THETA, 0.3)
        np.testing.assert_array_equal(maps, np.broadcast_to(np.eye(size), maps.shape))


@pytest.mark.parametrize("name", sorted(set(METHODS) - {"de_vogelaere", "rk4", "kutta_merson"}))
def test_forcing_through_the_constant_component(name):
    # q'' = -w^2 q + 1 with w = 3: a turn about the static deflection.
    def forced(theta):
        out = np.zeros((len(theta), 3, 3))
        out[:, 0, 1], out[:, 1, 0], out[:, 1, 2] = 1.0, -9.0, 1.0
        return out

    steps, state = 40, np.array([0.0, 0.0, 1.0])
    for matrix in METHODS[name].maps(forced, 0.05 * np.arange(steps), 0.05):
        state = matrix @ state
    exact = (1 - np.cos(6.0)) / 9, np.sin(6.0) / 3, 1.0
    allowed = {"srkn4": 1e-8, "srkn6": 1e-11, "gauss_legendre4": 1e-4, "gauss_legendre6": 1e-7}
    np.testing.assert_allclose(state, exact, atol=allowed.get(name, 2e-10))


@pytest.mark.parametrize("name", ["magnus4", "magnus6", "magnus8", "cf4", "cf6"])
def test_scalar_equations_are_solved_by_the_quadrature_alone(name):
    # Coefficients that commute: the exponent is the integral, by Gauss's rule of the same order.
    def scalar(theta):
        return np.exp(np.sin(theta))[:, None, None] * np.array([[0.0, 1.0], [-1.0, 0.0]])

    order = METHODS[name].order
    step = 0.2
    matrices = METHODS[name].maps(scalar, np.zeros(1), step)[0]
    x, w = np.polynomial.legendre.leggauss(order // 2)
    angle = step / 2 * (w @ np.exp(np.sin(step / 2 * (1 + x))))
    turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(matrices, turned, atol=2e-16)
