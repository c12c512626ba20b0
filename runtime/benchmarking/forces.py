"""Benchmark of the rigid linkage: every force at a million crank positions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ..core.errors import bad
from ..core.results import Check
from ..linkages import FourBar
from ..rigid import Machine, MassDistribution, RigidForces, rigid_forces
from ..rigid.evaluation import Output
from .records import Benchmark, Contender, Row, compare, missing, one_thread
from .rigid_by_hand import (
    Data,
    Values,
    forces_by_hand,
    forces_by_solving,
    forces_in_blocks,
    reference,
)

_SPEED = 10.0
# A sixteenth of the angles for the nine equations, whose matrices fill 650 bytes an angle.
_SHARE = 16
_EXUDYN_STEPS = 4000
_COMPARED = 400
_UNIT = np.finfo(float).eps / 2
# Lengths; the second one comes within 0.002 rad of toggle, the third almost folds on its frame.
# There the shaking moment is what remains, 1e-6 of them, of the moments of coupler and follower.
_LINKAGES = {
    "(12, 6, 12, 12)": (12.0, 6.0, 12.0, 12.0),
    "(10, 6 - 1e-5, 8, 8), near toggle": (10.0, 6.0 - 1e-5, 8.0, 8.0),
    "(10, 10 - 1e-5, 10, 10), near a change point": (10.0, 10.0 - 1e-5, 10.0, 10.0),
}
# Which of two errors of a few units is the larger is chance: over 80 sets of angles our largest for
# the first linkage ran from 1.1 to 2.4, that of the form by hand from 1.1 to 4.2.
_CHANCE = 4.0
_OUTPUTS: tuple[Output, ...] = ("torque", "shaking_force", "shaking_moment", "pins")


def benchmark_forces(angles: int = 1_000_000, rounds: int = 7) -> Benchmark:
    """Time all pin forces, torque, shaking force and moment of a four-bar linkage.

    Parameters
    ----------
    angles : int
        Number of crank positions over one revolution.
    rounds : int
        How often each contender runs, in turn.

    Returns
    -------
    Benchmark
        ``error`` is our largest error in units of ``u (|f| + sum_i |x_i df/dx_i|)``, u = 2^-53,
        over every force at 400 positions, those nearest to toggle among them.  The check is that
        no rival's is smaller for any of the linkages, unless ours is below 4, where the order of
        two errors is chance.

    Raises
    ------
    BadInput
        If a number is less than 1, or there are fewer than 1000 positions.

    Notes
    -----
    The closed form by hand follows Smith (2.2)-(4.13) in NumPy, once over whole arrays and once
    in blocks that fit the cache.  The nine equations are set up in a batch and solved by
    ``numpy.linalg.solve``.  Exudyn turns the crank once by its index-2 trapezoidal rule; its time
    for a step is scaled to the number of positions.  The reference is in extended precision.
    """
    if angles < 1000 or rounds < 1:
        found = f"{angles}, {rounds}"
        raise bad("benchmark_forces", found, "at least 1000 angles and 1 round", "take more")
    return one_thread(_measure, angles, rounds)


def _measure(angles: int, rounds: int) -> Benchmark:
    rows: list[Row] = []
    worst, against = 0.0, 0.0
    for name, lengths in _LINKAGES.items():
        problem = _Problem(name, lengths, angles)
        ours, *rivals = compare(name, problem.contenders(), rounds)
        worst = max(worst, ours.error)
        against = max(against, ours.error / max(_CHANCE, min(row.error for row in rivals)))
        rows += [ours, *rivals, *problem.exudyn(ours.milliseconds)]
        if name == next(iter(_LINKAGES)):
            rows += problem.fewer(rounds)
    return Benchmark(
        method="interleaved timing",
        error=worst,
        error_norm="forces, in u (|f| + sum |x df/dx|), worst of all outputs",
        checks={"error over the best rival's, or over 4": Check(against, 1.0)},
        title=f"All forces of a four-bar linkage at {angles} crank positions",
        rows=tuple(rows),
    )


class _Problem:
    """One linkage of uniform bars at constant speed."""

    def __init__(self, name: str, lengths: tuple[float, float, float, float], angles: int) -> None:
        self.name = name
        frame, crank, coupler, follower = lengths
        moving = (crank, coupler, follower)
        masses = [0.1 * length for length in moving]
        bars = [MassDistribution.uniform_bar(*pair) for pair in zip(masses, moving, strict=True)]
        linkage = FourBar(frame, crank, coupler, follower)
        self.machine = Machine(linkage, dict(zip(linkage.links, bars, strict=True)))
        self.data = Data(
            np.array(lengths),
            np.array([bar.along for bar in bars]),
            np.array([bar.inertia for bar in bars]),
            np.array([bar.mass for bar in bars]),
            _SPEED,
        )
        # Half a step off the ends, so that no angle has an exact sine.
        self.theta = (np.arange(angles) + 0.5) * (2.0 * np.pi / angles)
        sine = np.abs(np.sin(linkage.motion(self.theta).transmission_angle))
        spread = np.linspace(0, angles - 1, _COMPARED // 2).astype(int)
        self.chosen = np.unique(np.concatenate([spread, np.argsort(sine)[: _COMPARED // 2]]))
        self.value, self.scale = reference(self.theta[self.chosen], self.data)

    def ours(self) -> RigidForces:
        return rigid_forces(self.machine, self.theta, _SPEED)

    def error(self, found: RigidForces) -> float:
        pins = np.concatenate(
            [np.moveaxis(pin, -1, 0) for pin in (found.f12, found.f23, found.f34, found.f41)]
        )
        frame = np.moveaxis(found.shaking_force, -1, 0)
        rows = (pins, found.torque[None], frame, found.shaking_moment[None])
        return self._deviation(np.concatenate(rows)[:, self.chosen])

    def _deviation(self, rows: Values) -> float:
        return float(np.max(np.abs(rows - self.value) / (_UNIT * self.scale)))

    def contenders(self) -> list[Contender]:
        def rival(name: str, function: Callable[..., Values], share: int = 1) -> Contender:
            theta = self.theta[: self.theta.size // share]
            judge = lambda _: self._deviation(function(self.theta[self.chosen], self.data))  # noqa: E731
            return Contender(name, partial(function, theta, self.data), judge, 1.0 / share)

        return [
            Contender("elastolink", self.ours, self.error),
            rival("closed form by hand, in blocks", forces_in_blocks),
            rival("closed form by hand", forces_by_hand),
            rival("nine equations, numpy.linalg.solve", forces_by_solving, _SHARE),
        ]

    def fewer(self, rounds: int) -> list[Row]:
        """Time ourselves again, with fewer outputs."""
        contenders = [Contender("elastolink, everything", self.ours, self.error)]
        for output in _OUTPUTS:
            work = partial(rigid_forces, self.machine, self.theta, _SPEED, outputs=(output,))
            contenders.append(Contender(f"elastolink, {output} alone", work, lambda _: np.nan))
        return compare(self.name, contenders, rounds)

    def exudyn(self, ours: float) -> list[Row]:
        """Return the row of Exudyn: one revolution, its time a step taken for each position."""
        import time

        try:
            from .exudyn_linkage import simulate_revolution

            simulate_revolution(self.machine, _SPEED, 100)
        except ImportError:
            return [missing(self.name, "Exudyn", "not installed (extra benchmark)")]
        begin = time.perf_counter()
        run = simulate_revolution(self.machine, _SPEED, _EXUDYN_STEPS)
        spent = 1e3 * (time.perf_counter() - begin) * self.theta.size / _EXUDYN_STEPS
        exact, scale = reference(run.theta, self.data)
        joints = np.moveaxis(run.joints[:3], -1, 1).reshape(6, -1)
        gap = np.abs(joints - exact[:6])
        note = f"{_EXUDYN_STEPS} steps, index-2 trapezoidal; pin forces within "
        note += f"{float(np.max(gap) / np.max(np.abs(exact[:6]))):.1e} of the largest"
        error = float(np.max(gap / (_UNIT * scale[:6])))
        return [Row(self.name, "Exudyn", spent, error, spent / ours, sampled=True, note=note)]
