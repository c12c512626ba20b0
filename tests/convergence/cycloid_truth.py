"""The bead on a cycloid in closed form: its steady motion and its two multipliers."""

from dataclasses import dataclass

import mpmath as mp
import numpy as np


@dataclass(frozen=True)
class Cycloid:
    """Numbers of one bead; ``numbers`` as the emitted module wants them."""

    mass: float
    radius: float
    gravity: float
    drag: float
    force: float
    speed: float

    @property
    def numbers(self) -> dict[str, float]:
        return dict(vars(self))

    @property
    def period(self) -> float:
        return 2.0 * np.pi / self.speed

    def arc(self, t: np.ndarray) -> np.ndarray:
        """Steady arc length and speed, shape (nt, 2)."""
        own = self.gravity / (4.0 * self.radius)
        reply = self.force / (self.mass * (own - self.speed**2) + 1j * self.drag * self.speed)
        turned = reply * np.exp(1j * self.speed * t)
        return np.stack([turned.real, (1j * self.speed * turned).real], axis=-1)

    def state(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities of the steady motion, shape (nt, 3)."""
        s, v = self.arc(t).T
        half = np.arcsin(s / (4.0 * self.radius))
        turning = v / (2.0 * self.radius * np.cos(half))
        across = self.radius * (1.0 + np.cos(2 * half))
        q = np.stack(
            [
                self.radius * (2 * half + np.sin(2 * half)),
                self.radius * (1 - np.cos(2 * half)),
                2 * half,
            ],
            axis=-1,
        )
        qd = np.stack(
            [across * turning, self.radius * np.sin(2 * half) * turning, turning], axis=-1
        )
        return q, qd

    def multipliers(self) -> np.ndarray:
        """Both multipliers from 30 digits, the inputs taken as exact doubles."""
        with mp.workdps(30):
            loss = mp.mpf(self.drag) / (2 * mp.mpf(self.mass))
            own = mp.mpf(self.gravity) / (4 * mp.mpf(self.radius))
            root = mp.sqrt(mp.mpc(loss**2 - own))
            period = mp.mpf(self.period)
            return np.array([complex(mp.exp((-loss + sign * root) * period)) for sign in (1, -1)])
