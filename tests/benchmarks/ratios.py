"""Times beside the best peer at equal error: the peer's over ours.

    python tests/benchmarks/ratios.py [--only NAME ...] [--compare FILE] [--store FILE]

Problems, by ``system-task``: Smith's coupler with one mode (``hill``) and with three (``coupler``),
Beale & Scott's rod (``quick-return``), Aannaque's four-bar with nine freedoms (``four-bar``); a
``trajectory`` of ten revolutions (the four-bar: one), a ``monodromy`` matrix, a ``steady`` motion,
a stability ``chart`` of 400 x 250 points; and ``constrained-trajectory``, a revolution of the rod
in a floating frame.  ``--only`` takes those that contain a NAME.

Every contender runs at every setting, in turn, with one thread for BLAS; the time is the median of
the rounds in processor seconds.  Compilation, the peers' Fourier series and our ``prepare`` are
made beforehand; ``plain`` is the ratio of one call without ``prepare``.  The error is relative,
against Taylor series in extended precision (``taylor_truth``).  At each level of error the fastest
of ours and of the peers within it count.  ``--compare`` fails where a ratio has fallen by more
than 1.25.
"""

import argparse
import json
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any

import elastolink as el
import numpy as np
from elastolink.runtime.stability.invariants import weighed_characteristic
from peers import TOLERANCES, Solve, equation, flows, one_thread, peers_of, shortened
from scipy.integrate import solve_ivp

LEVELS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
ROUNDS = 5
FALL = 1.25
# Angles of a revolution at which motions are compared, and points of a chart that the peers solve.
EACH, SAMPLE = 32, 4
# Largest rate of the state [1/rad] from which a system is stiff.  The references are good to the
# second; of the stiff four-bar, whose mass matrix is inverted, to the third.
STIFF, DIGITS, STIFF_DIGITS = 100.0, 1e-16, 1e-11
# Seconds: no tighter setting beyond; timed once beyond; repeated in a round until they have passed.
LONGEST, ONCE, SHORT = 2.0, 1.0, 2e-3


Work = Callable[[], Any]


@dataclass
class Contender:
    """One way to solve a problem; ``prepare`` goes from a setting to the work that is timed.

    ``ours`` is ``plain`` or ``prepared``, empty of a peer; ``share`` is the part of the problem
    that the work does.
    """

    name: str
    prepare: Callable[[float], Work]
    settings: tuple[float, ...]
    ours: str = ""
    share: float = 1.0


@dataclass
class Problem:
    """Contenders, the error of what they return, and the least error that is known."""

    contenders: list[Contender]
    error: Callable[[Any], float]
    digits: float


@dataclass
class Run:
    """A contender at one setting."""

    contender: Contender
    work: Work
    error: float
    repeats: int
    times: list[float] = field(default_factory=list)

    @property
    def milliseconds(self) -> float:
        """Median time of the whole problem."""
        return 1e3 * float(np.median(self.times)) / self.contender.share


@dataclass(frozen=True)
class Case:
    """A system at a crank speed [rad/s], a start, and the axes of its chart."""

    system: Any
    speed: float
    turns: int = 10
    deflection: float = 1e-4
    chart: tuple[tuple[str, Any], ...] = ()

    @property
    def stiff(self) -> bool:
        """Whether its fastest mode turns very often in a revolution."""
        return equation(self.system, self.speed, forced=False).rate > STIFF

    def problem(
        self,
        error: Callable[[Any], float],
        plain: Callable[[float], Any],
        ready: Callable[[Any], Any],
        task: Callable[[Solve], Any],
        *,
        forced: bool,
    ) -> Problem:
        """Return the problem that a plain call, a prepared system and a peer's solver solve."""
        # Prepared for speeds of 1 to 2; a stiff system for its speed alone.
        near = self.speed if self.stiff else (self.speed / 2**0.5, self.speed * 2**0.5)
        options = {"samples": EACH, "forcing": forced, "compiled": find_spec("numba") is not None}
        short = shortened(equation(self.system, self.speed, forced=forced))

        def prepared(rtol: float) -> Work:
            return partial(ready, el.prepare(self.system, near, rtol=rtol, **options))

        def rival(peer: Any, setting: float) -> Work:
            return partial(task, peer(short, setting))

        contenders = [
            Contender("plain call", lambda rtol: partial(plain, rtol), LEVELS, "plain"),
            Contender("prepared", prepared, (1e-6, 1e-10, 1e-13), "prepared"),
        ]
        for name, (peer, settings) in peers_of(short).items():
            contenders.append(Contender(name, partial(rival, peer), settings))
        return Problem(contenders, error, STIFF_DIGITS if self.stiff else DIGITS)


def case(name: str) -> Case:
    """Return a system by name."""
    if name == "four-bar":
        scene = el.load_scene("aannaque_1996_table_4_1", overrides={"mesh.elements": 1})
        return Case(scene.system(), 40.0, turns=1, deflection=0.0)
    if name == "quick-return":
        changes = {"model.formulation": "polynomial", "model.modes": 3, "links.crank_ratio": 0.1}
        scene = el.load_scene("beale_1992_flexible_rod", overrides=changes)
        ratio = "crank_ratio", np.linspace(0.01, 0.2, 250)
        return Case(scene.system(), 1000.0, chart=(("speed", np.linspace(500, 4000, 400)), ratio))
    modes = {"hill": 1, "coupler": 3}[name]
    scene = el.load_scene("smith_1972_5152_sixteenth_inch", overrides={"model.modes": modes})
    inertia = "follower_inertia", np.linspace(5.65e-4, 2.26e-3, 250)
    return Case(scene.system(), 80.0, chart=(("speed", np.linspace(40, 150, 400)), inertia))


def relative(value: Any, truth: Any) -> float:
    """Return the largest deviation over the largest entry; infinite where a run ended early."""
    if value.shape != truth.shape:
        return float("inf")
    return float(np.max(np.abs(value - truth)) / np.max(np.abs(truth)))


def trajectory(made: Case) -> Problem:
    """Return the motion from a deflection, or from rest under the forcing."""
    forced = made.deflection == 0.0
    whole = equation(made.system, made.speed, forced=forced)
    first = np.zeros(made.system.size)
    first[0] = made.deflection
    start = whole.start(first, np.zeros_like(first))
    angles = np.linspace(0.0, 2 * np.pi * made.turns, made.turns * EACH + 1)
    maps = flows(whole, 1.0, round(EACH * whole.period / (2 * np.pi)))
    states = [start.astype(np.longdouble)]
    while len(states) < len(angles):
        states += list(maps[1:] @ states[-1])
    truth = whole.coordinates(np.array(states).astype(float))

    def plain(rtol: float) -> Any:
        options = {"initial": (first, 0.0), "samples": EACH, "forcing": forced}
        return el.simulate(made.system, made.speed, made.turns, rtol=rtol, **options)

    def ready(prepared: Any) -> Any:
        periods = round(2 * np.pi * made.turns / whole.period)
        return prepared.simulate(made.speed, periods, (first, 0.0))

    def error(value: Any) -> float:
        q = value.q if hasattr(value, "q") else whole.coordinates(value[:, :, 0])
        return relative(q, truth)

    def task(solve: Solve) -> Any:
        return solve(start[:, None], angles)

    return made.problem(error, plain, ready, task, forced=forced)


def monodromy(made: Case) -> Problem:
    """Return the monodromy matrix at one speed."""
    whole = equation(made.system, made.speed, forced=False)
    truth = flows(whole, 1.0, 1)[-1].astype(float)
    unit, ends = np.eye(whole.states), np.array([0.0, whole.period])

    def error(value: Any) -> float:
        if hasattr(value, "matrix"):
            value = np.ldexp(value.matrix, int(value.exponent)) / whole.scale[:, None] * whole.scale
        return relative(value, truth)

    return made.problem(
        error,
        lambda rtol: el.monodromy(made.system, made.speed, rtol=rtol),
        lambda prepared: prepared.monodromy(made.speed),
        lambda solve: solve(unit, ends)[-1],
        forced=False,
    )


def steady(made: Case) -> Problem:
    """Return the periodic motion at one speed; the peers shoot, with the whole matrix."""
    whole = equation(made.system, made.speed, forced=True)
    n, m = whole.size, whole.states - 1
    unit, angles = np.eye(m + 1), np.linspace(0.0, whole.period, EACH + 1)

    def closed(maps: Any) -> Any:
        """Return the states of the motion whose start repeats, solved in doubles and refined."""
        gap, pull = np.eye(m) - maps[-1][:m, :m], maps[-1][:m, m]
        first = np.zeros_like(pull)
        for _ in range(1 if maps.dtype == float else 6):
            rest = (pull - gap @ first).astype(float)
            first = first + np.linalg.solve(gap.astype(float), rest)
        return maps[:-1] @ np.append(first, np.ones_like(first[:1]))

    truth = closed(flows(whole, 1.0, EACH))[:, :n].astype(float) * whole.scale[:n]

    def error(value: Any) -> float:
        q = value.q if hasattr(value, "q") else whole.coordinates(value)
        return relative(q, truth)

    def plain(rtol: float) -> Any:
        return el.steady_state(made.system, made.speed, rtol=rtol, samples=EACH)

    def ready(prepared: Any) -> Any:
        return prepared.steady_state(made.speed)

    return made.problem(error, plain, ready, lambda s: closed(s(unit, angles)), forced=True)


def chart(made: Case) -> Problem:
    """Return a stability chart, without preparation; the peers solve some of its points."""
    x, y = made.chart
    draw = np.random.default_rng(7)
    columns, rows = (draw.integers(0, len(values), SAMPLE) for _, values in made.chart)
    points = []
    for column, row in zip(columns, rows, strict=True):
        change = {y[0]: float(y[1][row])}
        geometry = y[0] in made.system.geometry
        at = (made.system.with_geometry if geometry else made.system.with_parameters)(**change)
        points.append(equation(at, float(x[1][column]), forced=False))
    matrices = np.stack([flows(point, 1.0, 1)[-1].astype(float) for point in points])
    truth, _ = weighed_characteristic(matrices, made.system.size)
    size = np.maximum(1.0, np.max(np.abs(truth), axis=-1, keepdims=True))
    unit, ends = np.eye(2 * made.system.size), np.array([0.0, points[0].period])

    def error(value: Any) -> float:
        if hasattr(value, "invariants"):
            value = value.invariants[rows, columns]
            # Of one mode a chart keeps half the trace.
            value = -2.0 * value if made.system.size == 1 else value
        else:
            value, _ = weighed_characteristic(value, made.system.size)
        return float(np.max(np.abs(value - truth) / size))

    def ours(_: float) -> Work:
        return partial(el.stability_chart, made.system, x, y)

    def rival(peer: Any, setting: float) -> Work:
        solves = [peer(shortened(point), setting) for point in points]
        return lambda: np.stack([solve(unit, ends)[-1] for solve in solves])

    share = SAMPLE / (len(x[1]) * len(y[1]))
    contenders = [Contender("stability_chart", ours, (0.0,), "plain")]
    for name, (peer, settings) in peers_of(shortened(points[0])).items():
        contenders.append(Contender(name, partial(rival, peer), settings, share=share))
    return Problem(contenders, error, DIGITS)


def constrained() -> Problem:
    """Return a revolution of the rod in a floating frame with two modes.

    The reference is DOP853 at its tightest, good to its difference from ours at 1e-13.  Peers
    solve for the accelerations by the emitted functions.
    """
    changes = {"model.formulation": "free_free", "model.modes": 2}
    rod = el.load_scene("beale_1992_flexible_rod", overrides=changes).system()
    n, k = rod.size, rod.constraints
    march = partial(el.constrained_motion, rod, span=rod.period, samples=EACH)
    best = march(rtol=1e-13)
    start = np.concatenate([best.q[0], best.qd[0]])
    times = np.linspace(0.0, rod.period, EACH + 1)
    speeds = np.abs(best.qd[0]) + np.max(np.abs(best.q[0])) / rod.period
    units = np.concatenate([np.maximum(np.abs(best.q[0]), 1e-3), speeds])

    def rate(t: float, state: Any) -> Any:
        at = rod.dynamics(state[:n], state[n:], t)
        matrix = np.zeros((n + k, n + k))
        matrix[:n, :n], matrix[:n, n:] = at["mass"], -at["jacobian"].T
        matrix[n:, :n] = at["jacobian"]
        right = np.concatenate([at["forces"] - at["rest"], at["gamma"]])[:, 0]
        return np.concatenate([state[n:], np.linalg.solve(matrix, right)[:n]])

    def by_scipy(rtol: float) -> Any:
        options = {"rtol": max(rtol, 3e-14), "atol": 1e-2 * rtol * units, "t_eval": times}
        return solve_ivp(rate, times[[0, -1]], start, method="DOP853", **options).y.T[:, :n]

    def by_cvode(rtol: float) -> Any:
        from sksundae.cvode import CVODE

        def into(t: float, state: Any, out: Any) -> None:
            out[:] = rate(t, state)

        options = {"rtol": rtol, "atol": 1e-2 * rtol * units, "max_num_steps": 10**7}
        return np.asarray(CVODE(into, method="Adams", **options).solve(times, start).y)[:, :n]

    truth = by_scipy(3e-14)
    size = np.max(np.abs(truth), axis=0)
    size = np.maximum(size, 1e-3 * np.max(size))

    def error(value: Any) -> float:
        q = value.q if hasattr(value, "q") else value
        return float(np.max(np.abs(q - truth) / size)) if q.shape == truth.shape else float("inf")

    def contender(name: str, solve: Callable[[float], Any], ours: str = "") -> Contender:
        return Contender(name, lambda rtol: partial(solve, rtol), TOLERANCES[:-1], ours)

    contenders = [
        contender("constrained_motion", lambda rtol: march(rtol=rtol), "plain"),
        contender("SciPy DOP853", by_scipy),
    ]
    if find_spec("sksundae"):
        contenders.append(contender("CVODE", by_cvode))
    return Problem(contenders, error, max(DIGITS, error(best)))


TASKS = {"trajectory": trajectory, "monodromy": monodromy, "steady": steady, "chart": chart}
PROBLEMS: dict[str, Callable[[], Problem]] = {
    f"{system}-{task}": lambda system=system, made=made: made(case(system))
    for system, (task, made) in product(
        ("hill", "coupler", "quick-return", "four-bar"), TASKS.items()
    )
}
# A chart of the stiff four-bar would take the peers hours.
del PROBLEMS["four-bar-chart"]
PROBLEMS["constrained-trajectory"] = constrained


def timed(work: Callable[[], Any], repeats: int) -> float:
    """Return the processor seconds of one of several runs."""
    begin = time.process_time()
    for _ in range(repeats):
        work()
    return (time.process_time() - begin) / repeats


def runs_of(problem: Problem) -> Iterator[Run]:
    """Yield every contender at every setting, until one takes long or is refused."""
    for contender in problem.contenders:
        for setting in contender.settings:
            try:
                work = contender.prepare(setting)
                error = problem.error(work())
            except el.BadInput:
                break
            single = timed(work, 1)
            if np.isfinite(error):
                run = Run(contender, work, max(error, problem.digits), max(1, int(SHORT / single)))
                run.times += [single] if single >= ONCE else []
                yield run
            if single > LONGEST:
                break


def measured(problem: Problem) -> list[Run]:
    """Return the runs with their times, all in turn."""
    runs = list(runs_of(problem))
    for _, run in product(range(ROUNDS), runs):
        if not run.times or run.times[0] < ONCE:
            run.times.append(timed(run.work, run.repeats))
    return runs


def fastest(runs: list[Run], level: float) -> Run | None:
    """Return the fastest run within a level of error."""
    good = [run for run in runs if run.error <= level]
    return min(good, key=lambda run: run.milliseconds, default=None)


def report(name: str, runs: list[Run], stored: dict[str, float]) -> tuple[dict[str, float], bool]:
    """Print a line for each level; return the ratios, and whether one has fallen too far."""
    ratios, fallen = {}, False
    ours = [run for run in runs if run.contender.ours]
    for level in LEVELS:
        mine = fastest(ours, level)
        plain = fastest([run for run in ours if run.contender.ours == "plain"], level)
        peer = fastest([run for run in runs if not run.contender.ours], level)
        key = f"{level:.0e}"
        cells = [
            f"{run.contender.name:18s} {run.milliseconds:9.4g} {run.error:8.1e}"
            if run
            else f"{'-':18s} {'':9s} {'':8s}"
            for run in (mine, peer)
        ]
        line = f"{name:24s} {key}  {cells[0]}  {cells[1]}"
        if peer and mine:
            ratio = ratios[key] = float(f"{peer.milliseconds / mine.milliseconds:.4g}")
            line += f" {ratio:8.4g} {peer.milliseconds / plain.milliseconds if plain else 0.0:8.3g}"
        if key in stored and peer:
            short = ratios.get(key, 0.0) < stored[key] / FALL
            fallen |= short
            line += f" {stored[key]:8.4g}" + (" fallen" if short else "")
        print(line, flush=True)
    return ratios, fallen


def main() -> int:
    """Measure, print, compare and maybe store; return 1 where a ratio has fallen."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", nargs="+", default=[""], metavar="NAME", help="part of a name")
    parser.add_argument("--compare", type=Path, metavar="FILE", help="fail at a fallen ratio")
    parser.add_argument("--store", type=Path, metavar="FILE", help="enter the ratios in a file")
    options = parser.parse_args()
    one_thread()
    warnings.simplefilter("ignore")
    stored = json.loads(options.compare.read_text()) if options.compare else {}
    chosen = [name for name in PROBLEMS if any(part in name for part in options.only)]
    if not chosen:
        parser.error(f"--only: no problem of {', '.join(PROBLEMS)} contains {options.only}")
    side = f"{'ms':>9s} {'error':>8s}"
    print(
        f"{'problem':24s} {'level':5s}  {'ours':18s} {side}  {'best peer':18s} {side}"
        f" {'ratio':>8s} {'plain':>8s} {'stored':>8s}"
    )
    results = {
        name: report(name, measured(PROBLEMS[name]()), stored.get(name, {})) for name in chosen
    }
    if options.store:
        known = json.loads(options.store.read_text()) if options.store.exists() else {}
        known |= {name: ratios for name, (ratios, _) in results.items()}
        options.store.write_text(json.dumps(dict(sorted(known.items())), indent=1) + "\n")
    return int(any(fallen for _, fallen in results.values()))


if __name__ == "__main__":
    raise SystemExit(main())
