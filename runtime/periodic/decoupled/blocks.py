"""The slow part of a stiff periodic system, decoupled from the fast modes by a Riccati equation.

In the moving basis q = Phi(theta) eta the state (eta, p) obeys y' = L(theta) y.  Ordered by slow
(s) and fast (f) components, motions without fast oscillation lie in a moving space y_f = W y_s,

    W' = L_fs + L_ff W - W L_ss - W L_sf W,

and obey y_s' = (L_ss + L_sf W) y_s, exactly.  W is found by iteration: the equation is solved at
each angle as if its coefficients rested, and what W' and the rest leave is put right.  Each pass
gains the ratio of the coefficients' rate of change to the gap of the frequencies, down to a
residual that is exponentially small in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..first_order import CanonicalForm
from .frames import Frames, angle_slope, stiffness_in

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_PASSES = 40
# Share of the sampled harmonics of W that is kept: an iteration amplifies the rounding beyond.
_KEPT = 3


@dataclass(frozen=True)
class Slow:
    """Slow parts of a batch of speeds, at even crank angles.

    Attributes
    ----------
    generator : ndarray
        G of z' = G z, z canonical and scaled, shape ``(nb, nt, 2k, 2k)``.
    before : ndarray
        The same of the last pass but one, whose error is larger.
    embedding : ndarray
        State (eta, p) = embedding z, scaled, slow components first, ``(nb, nt, 2n, 2k)``.
    scale : ndarray
        Sizes of eta, ``(nb, n)``: the plain state is (eta scale, p / scale).
    residual : ndarray
        Largest entry of the Riccati equation's residual, shape ``(nb,)``.
    coupling : ndarray
        Largest size of L_sf over the gap, by which the residual enters, ``(nb,)``.
    drift : ndarray
        Largest mean real part of the fast frozen exponents, per radian, ``(nb,)``.
    rounding : ndarray
        Size of the round-off of G's entries, ``(nb,)``.
    passes : ndarray of int
        Steps of the Riccati equation's iteration that were worth their while, ``(nb,)``.
    """

    generator: Array
    before: Array
    embedding: Array
    scale: Array
    residual: Array
    coupling: Array
    drift: Array
    rounding: Array
    passes: NDArray[np.int64]

    def change(self, period: float) -> float:
        """Return the largest relative change of a monodromy matrix by the residual."""
        return float(np.max(self.residual * np.maximum(self.coupling, 1e-3))) * period


@dataclass(frozen=True)
class Modal:
    """Arrays of the Lagrangian in the moving basis, at unit mass, for a batch of speeds.

    Each of shape ``(nb, nt, n, n)`` and divided by the power of the speed that makes it
    dimensionless in theta; ``drag`` C, ``carried`` D, ``stiffness`` K + Kg.
    """

    gyro: Array
    inertia: Array
    stiffness: Array
    drag: Array | None
    carried: Array | None


def modal_arrays(form: CanonicalForm, frames: Frames) -> Modal:
    """Return the Lagrangian's arrays in a moving basis.

    The mass of the whole batch has to be the one that made the basis.
    """
    theta, basis, slope = frames.theta, frames.basis, frames.slope
    one = form.take(slice(0, 1))
    mass = one.require_mass(one.assemble("M", theta))[0]
    across = np.swapaxes(basis, -1, -2)
    gyro = (across @ mass @ slope)[None]
    inertia = (np.swapaxes(slope, -1, -2) @ mass @ slope)[None]
    own = form.assemble("A", theta)
    if own is not None:
        inner = np.swapaxes(slope, -1, -2) @ own @ basis
        gyro = gyro + stiffness_in(basis, own)
        inertia = inertia + inner + np.swapaxes(inner, -1, -2)
    centrifugal = form.assemble("B", theta)
    if centrifugal is not None:
        inertia = inertia + stiffness_in(basis, centrifugal)
    stiffness = form.assemble(("K", "Kg"), theta)
    held = np.zeros((1, 1, form.system.size, form.system.size)) if stiffness is None else stiffness
    drag, carried = form.assemble("C", theta), form.assemble("D", theta)
    pulled = None if carried is None else stiffness_in(basis, carried)
    if drag is not None:
        extra = across @ drag @ slope
        pulled = extra if pulled is None else pulled + extra
    held = stiffness_in(basis, held)
    if form.conservative:
        # Rounding must not feed energy.
        held = 0.5 * (held + np.swapaxes(held, -1, -2))
        inertia = 0.5 * (inertia + np.swapaxes(inertia, -1, -2))
    return Modal(gyro, inertia, held, None if drag is None else stiffness_in(basis, drag), pulled)


def slow_part(form: CanonicalForm, frames: Frames, most: int = _PASSES) -> Slow:
    """Return the slow parts of a batch of speeds, one speed at a time.

    With ``most`` steps of the iteration, the number that the highest speed bears, the result is as
    smooth in the speed as the steps are; each speed's own best number would make it jump.
    """
    modal = modal_arrays(form, frames)
    found = [_one(form, frames, modal, row, most) for row in range(len(form.speed))]
    columns = [np.stack(part) for part in zip(*found, strict=True)]
    return Slow(*columns)


def _row(values: Array | None, row: int) -> Array | float:
    """Return one member of a batch whose members may all be the same."""
    return 0.0 if values is None else values[min(row, len(values) - 1)]


def _one(
    form: CanonicalForm, frames: Frames, modal: Modal, row: int, most: int
) -> tuple[Array | float, ...]:
    n, k = frames.basis.shape[-1], frames.modes
    count, speed = len(frames.theta), form.speed[row]
    level = np.sqrt(np.abs(frames.level)) / speed
    scale = np.maximum(level, 1.0) ** -0.5
    gyro = _row(modal.gyro, row)
    drag, carried = _row(modal.drag, row), _row(modal.carried, row)
    whole = np.zeros((count, 2 * n, 2 * n))
    feedback = np.swapaxes(gyro, -1, -2) - drag
    whole[:, :n, :n], whole[:, :n, n:] = -gyro, np.eye(n)
    whole[:, n:, :n] = (
        _row(modal.inertia, row) - _row(modal.stiffness, row) - carried - feedback @ gyro
    )
    whole[:, n:, n:] = feedback
    size = np.concatenate([scale, 1.0 / scale])
    whole = whole / size[:, None] * size
    slow, fast = np.arange(k), np.arange(k, n)
    order = np.concatenate([slow, n + slow, fast, n + fast])
    parts = whole[:, order[:, None], order]
    if k == n:
        generator, embedding = parts, np.broadcast_to(np.eye(2 * n), parts.shape)
        before = generator
        residual, gap, drift, passes = 0.0, np.inf, -np.inf, 0
    else:
        riccati = _Riccati(form, frames, modal, row, parts, scale)
        w, coarse, residual, passes = riccati.solve(most)
        generator, embedding = _canonical(parts, w, k, form.system.period)
        before = _canonical(parts, coarse, k, form.system.period)[0]
        gap, drift = riccati.gap, riccati.drift
    if form.conservative:
        generator, before = _hamiltonian(generator), _hamiltonian(before)
    back = np.argsort(order)
    across = np.linalg.norm(parts[:, : 2 * k, 2 * k :], axis=(-2, -1))
    coupling = float(np.max(across, initial=0.0))
    # Rounding differs from angle to angle and entry to entry: its mean is what acts.
    stiff = modal.stiffness[min(row, len(modal.stiffness) - 1), ..., :k, :k]
    held = float(np.max(np.abs(stiff) * scale[:k, None] * scale[:k]))
    rounding = _EPS * (held + _cancelled(form, frames, scale, row) / np.sqrt(n * count))
    return (
        generator,
        before,
        embedding[:, back],
        scale,
        residual,
        coupling / max(gap, 1e-300),
        drift,
        rounding,
        passes,
    )


def symplectic_unit(n: int) -> Array:
    """Return J = [[0, I], [-I, 0]], shape ``(2n, 2n)``."""
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))


def _hamiltonian(generator: Array) -> Array:
    """Return the part of a generator that is J times a symmetric matrix."""
    unit = symplectic_unit(generator.shape[-1] // 2)
    energy = -unit @ generator
    value: Array = unit @ (0.5 * (energy + np.swapaxes(energy, -1, -2)))
    return value


def _cancelled(form: CanonicalForm, frames: Frames, scale: Array, row: int) -> float:
    """Return the size of the terms whose sum is the slow stiffness, which sets its rounding."""
    every = slice(None, None, max(1, len(frames.theta) // 16))
    held = form.take(slice(row, row + 1)).assemble(("K", "Kg"), frames.theta[every])
    if held is None:
        return 0.0
    slow = np.abs(frames.basis[every, :, : frames.modes]) * scale[: frames.modes]
    return float(np.max(stiffness_in(slow, np.abs(held[0]))))


class _Riccati:
    """The iteration for W at one speed."""

    def __init__(
        self,
        form: CanonicalForm,
        frames: Frames,
        modal: Modal,
        row: int,
        parts: Array,
        scale: Array,
    ) -> None:
        k = frames.modes
        s = slice(0, 2 * k)
        f = slice(2 * k, None)
        self._ss, self._sf = parts[:, s, s], parts[:, s, f]
        self._fs, self._ff = parts[:, f, s], parts[:, f, f]
        self._period, self._k = form.system.period, k
        stiffness = np.broadcast_to(
            _row(modal.stiffness, row), (len(frames.theta), *frames.basis.shape[1:])
        )
        low, self._turn_s = np.linalg.eigh(_even(stiffness[:, :k, :k]))
        high, self._turn_f = np.linalg.eigh(_even(stiffness[:, k:, k:]))
        self._low, self._high = low, high
        drag = _row(modal.drag, row)
        self._drag = np.zeros_like(high)
        if modal.drag is not None:
            own = np.broadcast_to(drag, stiffness.shape)[:, k:, k:]
            self._drag = np.einsum("tia,tij,tja->ta", self._turn_f, own, self._turn_f)
        self._scale_s, self._scale_f = scale[:k], scale[k:]
        root = np.sqrt(np.maximum(high, 0.0))
        self.gap = float(np.min(root[:, 0] - np.sqrt(np.maximum(low[:, -1], 0.0))))
        self.drift = float(np.max(-np.mean(self._drag, axis=0) / 2, initial=-np.inf))
        self._kept = len(frames.theta) // _KEPT

    def solve(self, most: int) -> tuple[Array, Array, float, int]:
        """Return W, ``(nt, 2(n - k), 2k)``, the one before it, its residual and its passes."""
        w = np.zeros_like(self._fs)
        best, before, least, passes = w, w, np.inf, 0
        for number in range(most + 1):
            residual = self._residual(w)
            size = float(np.max(np.abs(residual), initial=0.0))
            if not size < least:
                break
            gain = size / least
            before, best, least, passes = best, w, size, number
            if number == most or (gain > 0.5 and least < 1e-11):
                break
            w = w + self._filtered(self._step(residual))
        return best, before, least, passes

    def _residual(self, w: Array) -> Array:
        return (
            angle_slope(w, self._period) - self._fs - self._ff @ w + w @ (self._ss + self._sf @ w)
        )

    def _filtered(self, w: Array) -> Array:
        spectrum = np.fft.rfft(w, axis=0)
        spectrum[self._kept + 1 :] = 0.0
        value: Array = np.fft.irfft(spectrum, n=len(w), axis=0)
        return value

    def _step(self, residual: Array) -> Array:
        """Return X of F X - X S = residual, F and S the frozen oscillators without coupling.

        With S^2 = -low, F^2 = -high - drag F:  (F^2 + low) X = F R + R S.
        """
        nf, k = self._high.shape[1], self._k
        # To plain oscillators: displacement in the frozen modes, momentum in theirs.
        blocks = residual.reshape(-1, 2, nf, 2, k)
        blocks = np.moveaxis(blocks, 2, 3)
        size_f = np.stack([self._scale_f, 1.0 / self._scale_f])
        size_s = np.stack([self._scale_s, 1.0 / self._scale_s])
        plain = blocks * size_f[:, None, :, None] / size_s[None, :, None, :]
        turned = np.swapaxes(self._turn_f, -1, -2)[:, None, None] @ plain
        turned = turned @ self._turn_s[:, None, None]
        high, low = self._high[:, :, None], self._low[:, None, :]
        drag = self._drag[:, :, None]
        (qq, qp), (pq, pp) = (
            (turned[:, 0, 0], turned[:, 0, 1]),
            (turned[:, 1, 0], turned[:, 1, 1]),
        )
        # F = [[0, 1], [-high, -drag]] from the left, S = [[0, 1], [-low, 0]] from the right.
        left = ((pq, pp), (-high * qq - drag * pq, -high * qp - drag * pp))
        right = ((-low * qp, qq), (-low * pp, pq))
        top = [left[0][j] + right[0][j] for j in (0, 1)]
        under = [left[1][j] + right[1][j] for j in (0, 1)]
        # (low - high - drag F)^-1 = (a + drag (drag + F)) / (a^2 + ...) by Cayley and Hamilton.
        a = low - high
        determinant = a * a + drag * drag * low
        out = np.empty_like(turned)
        for j in (0, 1):
            out[:, 0, j] = ((a + drag * drag) * top[j] + drag * under[j]) / determinant
            out[:, 1, j] = (-drag * high * top[j] + a * under[j]) / determinant
        out = self._turn_f[:, None, None] @ out @ np.swapaxes(self._turn_s, -1, -2)[:, None, None]
        out = out / size_f[:, None, :, None] * size_s[None, :, None, :]
        value: Array = np.moveaxis(out, 3, 2).reshape(residual.shape)
        return value


def _even(matrix: Array) -> Array:
    value: Array = 0.5 * (matrix + np.swapaxes(matrix, -1, -2))
    return value


def _canonical(parts: Array, w: Array, k: int, period: float) -> tuple[Array, Array]:
    """Return the generator of canonical slow coordinates and their embedding.

    The columns (1, W) carry the form W^T J W + J; the inverse root of J^-1 times it makes them
    canonical.  It is a polynomial limit of it, so it is as smooth.
    """
    unit_s = symplectic_unit(k)
    unit_f = symplectic_unit((parts.shape[-1] - 2 * k) // 2)
    form = np.eye(2 * k) - unit_s @ (np.swapaxes(w, -1, -2) @ unit_f @ w)
    turn = _inverse_root(form)
    columns = np.concatenate([np.broadcast_to(np.eye(2 * k), form.shape), w], axis=-2)
    embedding = columns @ turn
    plain = parts[:, : 2 * k, : 2 * k] + parts[:, : 2 * k, 2 * k :] @ w
    generator: Array = np.linalg.solve(turn, plain @ turn - angle_slope(turn, period)).astype(
        np.float64
    )
    return generator, embedding


def _inverse_root(matrix: Array) -> Array:
    """Return the inverse of the principal square root by Denman and Beavers' iteration."""
    y, z = np.array(matrix), np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    for _ in range(40):
        y, z = 0.5 * (y + np.linalg.inv(z)), 0.5 * (z + np.linalg.inv(y))
        if np.max(np.abs(z @ matrix @ z - np.eye(matrix.shape[-1]))) < 64 * _EPS:
            break
    return z
