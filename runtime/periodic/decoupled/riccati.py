"""The slow part of a stiff periodic system, decoupled from the fast modes by a Riccati equation.

In a moving basis q = Phi(theta) eta the state (eta, p) obeys y' = L(theta) y.  Ordered by slow
(s) and fast (f) components, motions without fast oscillation lie in a moving space y_f = W y_s,

    W' = L_fs + L_ff W - W L_ss - W L_sf W,

and obey y_s' = (L_ss + L_sf W) y_s, exactly.  W is found by iteration: the equation is solved at
each angle as if its coefficients rested, and what W' and the rest leave is put right.  Each pass
gains the ratio of the coefficients' rate of change to the gap of the frequencies, down to a
residual that is exponentially small in it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.trigonometric import differentiated, even_angles
from ..equation import Equation, SampledSystem, equation_of
from ..moving_basis import StillModes, carried_basis
from ..reduced import projections

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Even angles, and upper harmonics of the bases over the largest that count as round-off.
_FEWEST, _MOST, _TAIL = 64, 2048, 1e-13
_PASSES = 40
# Share of the sampled harmonics of W that is kept: an iteration amplifies the rounding beyond.
_KEPT = 3


def plain_equation(
    known: SampledSystem, speed: float, parameters: Mapping[str, float] | None = None
) -> Equation:
    """Return the equation at one speed [rad/s], its coordinates in their own units."""
    found = equation_of(known, np.array([speed]), parameters)
    return replace(found, scale=np.ones_like(found.scale))


@dataclass(frozen=True)
class Frames:
    """Smooth periodic bases of the slow and of the fast modes, frozen at even crank angles.

    A single mode is not smooth where its frequency meets a neighbour's; the span of the lowest k
    is, as long as a gap stays open above them.

    Attributes
    ----------
    theta : ndarray
        The angles [rad], shape ``(nt,)``.
    basis, slope : ndarray
        The k slow columns, then the fast ones, orthonormal by the mass, and their derivative by
        the angle, shape ``(nt, n, n)``.
    modes : int
        Number k of slow modes.
    """

    theta: Array
    basis: Array
    slope: Array
    modes: int


def moving_frames(equation: Equation, modes: int) -> Frames:
    """Return smooth bases of the lowest modes of one equation, and of the rest.

    Refused where a span is not periodic, or no number of angles resolves its basis: the frequency
    of mode k + 1 comes too near to that of mode k.
    """
    n, period, count = equation.size, equation.period, _FEWEST
    while count < 4 * equation.reach:
        count *= 2
    while True:
        theta = even_angles(period, count)
        found, shapes = equation.frozen_modes(theta)
        squares = np.broadcast_to(np.maximum(found[0], 0.0), (count, n))
        shapes, mass = (
            np.broadcast_to(values[0], (count, n, n))
            for values in (shapes, equation.at("mass", theta))
        )
        halves = [carried_basis(period, modes, StillModes(theta, squares, shapes, mass))]
        if modes < n:
            fast = StillModes(theta, squares[:, ::-1], shapes[:, :, ::-1], mass)
            halves.append(carried_basis(period, n - modes, fast))
        rough = max(half.tail for half in halves)
        if rough <= _TAIL or 2 * count > _MOST:
            break
        count *= 2
    if rough > _TAIL:
        gap = float(np.min(np.diff(np.sqrt(squares), axis=1)[:, modes - 1 : modes], initial=np.inf))
        raise bad(
            "modes",
            f"{modes}, where the natural frequencies of modes {modes} and {modes + 1} come within "
            f"{gap * equation.speed[0]:.3g} rad/s of each other",
            "a number of modes with a gap above them",
            "choose another number",
        )
    basis, slope = (
        np.concatenate([getattr(half, name) for half in halves], axis=-1)
        for name in ("values", "slopes")
    )
    return Frames(theta, basis, slope, modes)


@dataclass(frozen=True)
class SlowPart:
    """The slow part at one speed, at even crank angles.

    Attributes
    ----------
    generator : ndarray
        G of z' = G z, z canonical and scaled, shape ``(nt, 2k, 2k)``.
    before : ndarray
        The same of the last pass but one, whose error is larger.
    embedding : ndarray
        State (eta, p) = embedding z, scaled, slow components first, ``(nt, 2n, 2k)``.
    scale : ndarray
        Sizes of eta, ``(n,)``: the plain state is (eta scale, p / scale).
    change : float
        Largest relative change of a monodromy matrix by the residual of the Riccati equation.
    rounding : float
        Size of the round-off of G's entries.
    passes : int
        Steps of the iteration that were worth their while.
    """

    generator: Array
    before: Array
    embedding: Array
    scale: Array
    change: float
    rounding: float
    passes: int


def slow_part(equation: Equation, frames: Frames, most: int = _PASSES) -> SlowPart:
    """Return the slow part of one equation.

    With ``most`` steps of the iteration, the number that the highest speed bears, the result is as
    smooth in the speed as the steps are; each speed's own best number would make it jump.
    """
    n, k, count = equation.size, frames.modes, len(frames.theta)
    modal = _modal(equation, frames)
    stiffness = -modal["B"] + modal.get("D", 0.0)
    if not equation.damped:
        # Rounding must not feed energy.
        stiffness = _even(stiffness)
    gyro, drag = modal["A"], modal.get("C", np.zeros((n, n)))
    level = np.mean(np.abs(np.diagonal(stiffness, axis1=-2, axis2=-1)), axis=0)
    scale = np.maximum(np.sqrt(level), 1.0) ** -0.5
    feedback = np.swapaxes(gyro, -1, -2) - drag
    whole = np.zeros((count, 2 * n, 2 * n))
    whole[:, :n, :n], whole[:, :n, n:] = -gyro, np.eye(n)
    whole[:, n:, :n], whole[:, n:, n:] = -stiffness - feedback @ gyro, feedback
    size = np.concatenate([scale, 1.0 / scale])
    whole = whole / size[:, None] * size
    slow, fast = np.arange(k), np.arange(k, n)
    order = np.concatenate([slow, n + slow, fast, n + fast])
    parts = whole[:, order[:, None], order]
    generator, before, embedding = parts, parts, np.broadcast_to(np.eye(2 * n), parts.shape)
    change, passes = 0.0, 0
    if k < n:
        riccati = _Riccati(equation.period, k, parts, stiffness, drag, scale)
        w, coarse, residual, passes = riccati.solve(most)
        generator, embedding = _canonical(parts, w, k, equation.period)
        before = _canonical(parts, coarse, k, equation.period)[0]
        across = float(np.max(np.linalg.norm(parts[:, : 2 * k, 2 * k :], axis=(-2, -1))))
        change = residual * max(across / max(riccati.gap, 1e-300), 1e-3) * equation.period
    if not equation.damped:
        generator, before = _hamiltonian(generator), _hamiltonian(before)
    # Rounding differs from angle to angle and entry to entry: its mean is what acts.
    held = float(np.max(np.abs(stiffness[:, :k, :k]) * scale[:k, None] * scale[:k]))
    rounding = _EPS * (held + _cancelled(equation, frames, scale[:k]) / np.sqrt(n * count))
    embedding = embedding[:, np.argsort(order)]
    return SlowPart(generator, before, embedding, scale, change, rounding, passes)


def _modal(equation: Equation, frames: Frames) -> dict[str, Array]:
    """Return A, B, C and D in the moving basis, where the mass is 1, for one turn's angles."""
    fields = (("mass", "M"), ("gyroscopic", "A"), ("damping", "C"), ("stiffness", "B"))
    found: dict[str, Array] = {}
    for field, array in fields:
        if field in equation.fields:
            values = equation.at(field, frames.theta)[0]
            for name, part in projections(array, values, frames.basis, frames.slope):
                found[name] = found[name] + part if name in found else part
    return found


def symplectic_unit(n: int) -> Array:
    """Return J = [[0, I], [-I, 0]], shape ``(2n, 2n)``."""
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))


def _hamiltonian(generator: Array) -> Array:
    """Return the part of a generator that is J times a symmetric matrix."""
    unit = symplectic_unit(generator.shape[-1] // 2)
    value: Array = unit @ _even(-unit @ generator)
    return value


def _cancelled(equation: Equation, frames: Frames, scale: Array) -> float:
    """Return the size of the terms whose sum is the slow stiffness, which sets its rounding."""
    if "stiffness" not in equation.fields:
        return 0.0
    every = slice(None, None, max(1, len(frames.theta) // 16))
    held = np.abs(equation.at("stiffness", frames.theta[every])[0])
    slow = np.abs(frames.basis[every, :, : frames.modes]) * scale
    return float(np.max(np.swapaxes(slow, -1, -2) @ held @ slow))


class _Riccati:
    def __init__(
        self, period: float, k: int, parts: Array, stiffness: Array, drag: Array, scale: Array
    ) -> None:
        s, f = slice(0, 2 * k), slice(2 * k, None)
        self._ss, self._sf = parts[:, s, s], parts[:, s, f]
        self._fs, self._ff = parts[:, f, s], parts[:, f, f]
        self._period, self._k = period, k
        self._low, self._turn_s = np.linalg.eigh(_even(stiffness[:, :k, :k]))
        self._high, self._turn_f = np.linalg.eigh(_even(stiffness[:, k:, k:]))
        fast = np.broadcast_to(drag, stiffness.shape)[:, k:, k:]
        self._drag = np.einsum("tia,tij,tja->ta", self._turn_f, fast, self._turn_f)
        self._scale_s, self._scale_f = scale[:k], scale[k:]
        root = np.sqrt(np.maximum(self._high, 0.0))
        self.gap = float(np.min(root[:, 0] - np.sqrt(np.maximum(self._low[:, -1], 0.0))))
        self._kept = len(parts) // _KEPT

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
        slope = differentiated(w, self._period)
        value: Array = slope - self._fs - self._ff @ w + w @ (self._ss + self._sf @ w)
        return value

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
    plain = parts[:, : 2 * k, : 2 * k] + parts[:, : 2 * k, 2 * k :] @ w
    generator = np.linalg.solve(turn, plain @ turn - differentiated(turn, period))
    return np.asarray(generator, dtype=np.float64), columns @ turn


def _inverse_root(matrix: Array) -> Array:
    """Return the inverse of the principal square root by Denman and Beavers' iteration."""
    y, z = np.array(matrix), np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    for _ in range(40):
        y, z = 0.5 * (y + np.linalg.inv(z)), 0.5 * (z + np.linalg.inv(y))
        if np.max(np.abs(z @ matrix @ z - np.eye(matrix.shape[-1]))) < 64 * _EPS:
            break
    return z
