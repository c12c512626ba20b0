"""Errors of critical speeds by the response and by Meissner's way, on random waving systems."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from elastolink.runtime.frequencies import critical_speeds
from honesty import over_scenes
from periodic_systems import system_of, wave
from scipy.optimize import brentq

HARMONICS = 24
PLACES = np.linspace(0.0, 1.0, 21)


def symmetric(rng, count):
    """Return a random symmetric matrix."""
    made = rng.standard_normal((count, count))
    return 0.5 * (made + made.T)


class Waving:
    """Mass, stiffness and force of a constant part and one wave each, with a constant drag."""

    def __init__(self, rng, count, drag):
        turned = np.eye(count) + 0.2 * rng.standard_normal((count, count))
        squares = np.sort(rng.uniform(2.0, 25.0, count))
        # In the coordinates of the modes a wave of a fifth of the lowest stays definite.
        of_mass = 0.1 * symmetric(rng, count) / count
        of_springs = 0.2 * squares[0] * symmetric(rng, count) / count
        inner = {"M": (np.eye(count), of_mass), "K": (np.diag(squares), of_springs)}
        self.waves = {
            name: (turned.T @ still @ turned, turned.T @ moved @ turned, *self._wave(rng))
            for name, (still, moved) in inner.items()
        }
        self.waves["f"] = (*rng.standard_normal((2, count)), *self._wave(rng))
        self.drag, self.count = drag * turned.T @ turned, count
        self.natural = np.sqrt(squares)
        self.powers = np.arange(1, count + 1)

    @staticmethod
    def _wave(rng):
        return int(rng.integers(1, 4)), float(rng.uniform(0.0, 6.0))

    @property
    def system(self):
        """The system, with a link whose deflection is watched."""
        arrays = {
            name: [lambda at, still=still: np.stack([still] * len(at)), wave(moved, order, phase)]
            for name, (still, moved, order, phase) in self.waves.items()
        }
        made = system_of(C=self.drag, **arrays)
        return replace(made, shape=lambda x: 1e-6 * np.asarray(x)[:, None] ** self.powers)

    def at(self, name, theta):
        """Return one of the arrays at crank angles."""
        still, moved, order, phase = self.waves[name]
        return still + np.cos(order * theta + phase).reshape(-1, *(1,) * moved.ndim) * moved

    def blocks(self, name):
        """Return what a matrix does to harmonics -H to H, ``(2H + 1, n, 2H + 1, n)``."""
        still, moved, order, phase = self.waves[name]
        size = 2 * HARMONICS + 1
        made = np.einsum("kl,ij->kilj", np.eye(size), still.astype(complex))
        made += np.einsum("kl,ij->kilj", np.eye(size, k=-order), 0.5 * np.exp(1j * phase) * moved)
        made += np.einsum("kl,ij->kilj", np.eye(size, k=order), 0.5 * np.exp(-1j * phase) * moved)
        return made


class Balance:
    """Motion of (w^2 M q' + w C q)' + K q = w^2 f as a dense harmonic balance, and its slope."""

    def __init__(self, scene):
        order = np.arange(-HARMONICS, HARMONICS + 1)
        size = len(order) * scene.count
        pairs = np.multiply.outer(order, order)[:, None, :, None]
        self.inertia = (-pairs * scene.blocks("M")).reshape(size, size)
        self.drag = np.kron(np.diag(1j * order), scene.drag)
        self.springs = scene.blocks("K").reshape(size, size)
        still, moved, turns, phase = scene.waves["f"]
        force = np.zeros((len(order), scene.count), dtype=complex)
        force[HARMONICS] += still
        force[HARMONICS + turns] += 0.5 * np.exp(1j * phase) * moved
        force[HARMONICS - turns] += 0.5 * np.exp(-1j * phase) * moved
        self.force = force.ravel()
        self.rows = PLACES[:, None] ** scene.powers

    def squares(self, w):
        """Return mean squares of the deflection at the places, and their slopes over the speed."""
        left = self.springs + w * self.drag + w**2 * self.inertia
        q = np.linalg.solve(left, w**2 * self.force)
        rate = 2.0 * w * self.force - (self.drag + 2.0 * w * self.inertia) @ q
        q, slope = (
            part.reshape(-1, self.rows.shape[1]) @ self.rows.T
            for part in (q, np.linalg.solve(left, rate))
        )
        return np.sum(np.abs(q) ** 2, axis=0), 2.0 * np.sum((q.conj() * slope).real, axis=0)

    def maximum(self, near, error):
        """Return the speed of the maximum near another one, at the place that moves most there."""
        place = int(np.argmax(self.squares(near)[0]))
        return top(lambda w: float(self.squares(w)[1][place]), near, error)


def top(slope, near, error):
    """Return where a slope falls through zero near a place, looked for within 1e-3 of it."""
    step = max(3.0 * error, 1e-8 * near)
    while not slope(near - step) > 0.0 > slope(near + step):
        step *= 2.0
        if step > 1e-3 * near:
            return np.inf
    return brentq(slope, near - step, near + step, xtol=1e-15 * near, rtol=1e-15)


def to_rounding(found, exact):
    """Return estimates and actual errors; below 4e-15 the places by balance are not known."""
    return found.error, np.maximum(np.abs(found.speed - exact), 4e-15 * found.speed)


@over_scenes(77, few=None, many=45)
def test_maxima_of_the_response_of_waving_systems(rng):
    scene = Waving(rng, int(rng.integers(1, 4)), float(10.0 ** rng.uniform(-2.5, -0.3)))
    low = scene.natural[0] * rng.uniform(0.4, 0.6)
    span = (low, low * rng.uniform(1.5, 3.0))
    found = critical_speeds(scene.system, span, method="response", speeds=61)
    if not len(found.speed):
        return None
    balance = Balance(scene)
    pairs = zip(found.speed.tolist(), found.error.tolist(), strict=True)
    return to_rounding(found, np.array([balance.maximum(*pair) for pair in pairs]))


def half_trace(levels, speed):
    """Return half the trace of ``y'' + (v/w)^2 y = 0`` with v constant in even intervals."""
    rate, step = levels / speed, 2.0 * np.pi / len(levels)
    c, s = np.cos(rate * step), np.sin(rate * step)
    whole = np.moveaxis(np.array([[c, s / rate], [-rate * s, c]]), -1, 0)
    while len(whole) > 1:
        whole = whole[1::2] @ whole[::2]
    return 0.5 * np.trace(whole[0])


@over_scenes(78, few=4, many=30)
def test_maxima_of_meissners_way(rng):
    """The error is that of the intervals: 1024 and 2048 of them, extrapolated, are the truth."""
    scene = Waving(rng, int(rng.integers(1, 4)), 0.0)
    low = scene.natural[0] * rng.uniform(0.2, 0.6)
    found = critical_speeds(scene.system, (low, 2.0 * low), method="meissner")
    places = []
    for count in (1024, 2048):
        theta = 2.0 * np.pi * np.arange(count) / count
        back = np.linalg.inv(np.linalg.cholesky(scene.at("M", theta)))
        levels = np.sqrt(np.linalg.eigvalsh(back @ scene.at("K", theta) @ back.mT))
        # The slope by a step along the imaginary axis, exact to the last digit.
        slopes = [lambda w, v=v: half_trace(v, w + 1e-30j).imag for v in levels.T]
        pairs = zip(found.mode - 1, found.speed.tolist(), found.error.tolist(), strict=True)
        places.append([top(slopes[mode], near, error) for mode, near, error in pairs])
    coarse, fine = np.array(places)
    return to_rounding(found, fine + (fine - coarse) / 3.0)
