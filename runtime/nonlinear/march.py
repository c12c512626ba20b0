"""Marching in time, a revolution at once: motions from given states, several runs side by side."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.families import Array
from .orbit import STAGES, Lost, remaining, sizes_of, taken
from .segments import Motion, NotFinite, Problem, Ramp, chained, sweep

# Newton's iteration of a revolution: how many corrections, after how many none may be large, and
# what it may leave, over the wanted error.
_ITERATIONS, _PATIENCE, _LEFT = 12, 5, 0.03


@dataclass(frozen=True)
class Marcher:
    """What marches a system revolution by revolution."""

    problem: Problem
    rtol: float = 1e-8  # wanted error of a revolution, relative to its size
    most: int = 768  # steps of a revolution at the most

    def revolution(
        self, value: float, states: Array, guess: Motion | None = None, ramp: Ramp | None = None
    ) -> Motion:
        """Return the motion over a revolution from states ``(runs, 2n)`` at its beginning.

        ``guess``: the revolution before.  On as many steps as its error wants.  Raises `Lost`
        where it cannot be found.
        """
        runs = len(states)
        motion = self._guess(states, guess)
        while True:
            found = self._solved(value, states, motion, ramp)
            steps = len(motion.x) // runs
            if found is not None and unresolved(found) <= self.rtol:
                return found
            if 2 * steps > self.most:
                raise Lost("a revolution cannot be computed from its beginning")
            if found is not None:
                motion = _finer(found, int(np.ceil(1.4 * steps)))
            else:
                motion = self._guess(states, None, 2 * steps)

    def _guess(self, states: Array, before: Motion | None, steps: int = 0) -> Motion:
        """Return a first motion: that of the revolution before, or one that goes straight on."""
        runs, n = len(states), states.shape[1] // 2
        if before is not None and before.runs == runs:
            return replace(before, begin=0.0)
        # Six steps of a revolution at first, for each coordinate.
        steps = steps or 6 * max(n, 1)
        x, v = (np.repeat(part, steps, axis=0) for part in (states[:, :n], states[:, n:]))
        return Motion(1, x, 0.0 * v, np.zeros((runs * steps, STAGES, n)), runs=runs)

    @np.errstate(all="ignore")  # what is not finite ends it
    def _solved(
        self, value: float, states: Array, motion: Motion, ramp: Ramp | None
    ) -> Motion | None:
        """Return the motion from the states, by Newton's iteration; None where it fails."""
        runs, size = states.shape
        m = len(motion.x) // runs
        before = np.inf
        for count in range(_ITERATIONS):
            try:
                swept = sweep(self.problem, value, motion, periodic=False, ramp=ramp)
            except (NotFinite, np.linalg.LinAlgError):
                return None
            maps = swept.maps.reshape(runs, m, size, size).swapaxes(0, 1)
            loads = swept.loads.reshape(runs, m, size, 1).swapaxes(0, 1)
            whole, added = chained(maps, loads)
            first = (states - motion.states.reshape(runs, m, size)[:, 0])[..., None]
            change = (whole[:-1] @ first + added[:-1])[..., 0].swapaxes(0, 1).reshape(-1, size)
            own = sizes_of(motion.x, motion.v, self.problem.system.small)
            scale = np.maximum(own, sizes_of(states[:, : size // 2], states[:, size // 2 :]))
            large = float(np.max(np.abs(change) / scale))
            if not np.isfinite(large) or (count > _PATIENCE and large > 1.0):
                return None
            part = 1.0 if large <= 1.0 else max(1.0 / large, 0.1)
            motion = taken(motion, swept, change, 0.0, part)
            left = remaining(large, before, _LEFT * self.rtol)
            if np.isfinite(left):
                return replace(motion, left=left, map=whole[-1])
            before = large
        return None


def from_rest(marcher: Marcher, value: float) -> Motion:
    """Return the last of some revolutions that begin at rest.

    Raises `Lost` or `NotFinite` where they cannot be computed.
    """
    motion = None
    state = np.zeros((1, 2 * marcher.problem.system.size))
    # Revolutions from rest to a motion that Newton's iteration does not find from there.
    for _ in range(30):
        motion = marcher.revolution(value, state, motion)
        state = end(motion)
    assert motion is not None
    return motion


def end(motion: Motion) -> Array:
    """Return the states at the end of a motion, ``(runs, 2n)``."""
    n = motion.x.shape[1]
    return motion.ends().reshape(motion.runs, -1, 2 * n)[:, -1]


def unresolved(motion: Motion) -> float:
    """Return what series of the accelerations and iteration lack, as a share of the motion."""
    h, left, falls = _series_ends(motion)
    # Integrated twice over a step, and the square of what falls: Gauss points integrate it away.
    rate = max(float(np.max(np.abs(motion.v))), 1e-300)
    return float((h * left / STAGES / rate) * min(falls, 1.0)) + motion.left


def between_ends(motion: Motion) -> float:
    """Return what coordinates within the steps lack beside :func:`unresolved`, as a share.

    There the terms beyond the series' last ones, that fall on as these do, are not integrated away.
    """
    h, left, falls = _series_ends(motion)
    size = max(float(np.max(np.abs(motion.x))), 1e-300)
    return float((h / STAGES) ** 2 * left / size * min(falls, 1.0) ** (2.0 / (STAGES - 2)))


def _series_ends(motion: Motion) -> tuple[float, float, float]:
    """Return the step, the largest of the last terms of the accelerations, and how they fell."""
    terms = np.abs(motion.points.series @ motion.a)
    left = float(np.max(terms[:, -2:]))
    return motion.step, left, left / max(float(np.max(terms[:, 0])), 1e-300)


def _finer(motion: Motion, steps: int) -> Motion:
    """Return the motion on more steps."""
    return Motion.together([motion.run(i).resampled(steps, STAGES) for i in range(motion.runs)])
