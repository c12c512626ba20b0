"""One plain call each, unprepared, of systems from one to 27 freedoms, beside SciPy and heyoka.

    python tests/benchmarks/calls.py [WORD ...]

Each system stands there undamped and with modal damping of 0.2 and 2 %; ``WORD`` picks those whose
name contains it.  Times are processor seconds of the first call and of the second, with the error
that the call reports.  Beside the undamped ones the peers integrate the same canonical equation for
the monodromy matrix: SciPy's DOP853 at rtol 1e-9, and heyoka at 1e-9 where the mass matrix is
constant, its compilation in the first call.  Their error is the difference to the engine's matrix
at 1e-12, over the largest entry.
"""

import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

import elastolink as el
import numpy as np
from peers import by_heyoka, by_scipy, equation, one_thread, shortened

SCENES: dict[str, tuple[str, dict[str, object], float]] = {
    "Smith, 1 mode": ("smith_1972_5152_sixteenth_inch", {}, 45.0),
    "Smith, 3 modes": ("smith_1972_5152_sixteenth_inch", {"model.modes": 3}, 45.0),
    "Beale's rod": ("beale_1992_flexible_rod", {}, 100.0),
    "four-bar, 9": ("aannaque_1996_table_4_1", {"mesh.elements": 1}, 30.0),
    "four-bar, 27": ("aannaque_1996_table_4_1", {}, 30.0),
}
RATIOS = (0.0, 0.002, 0.02)


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return processor seconds and the result."""
    start = time.process_time()
    result = call()
    return time.process_time() - start, result


def damped(system: Any, ratio: float) -> Any:
    """Return the system with the damping ratio in each mode instead of its own."""
    if "damping_ratio" in system.parameters:
        return system.with_parameters(damping_ratio=ratio)
    return el.with_modal_damping(system, ratio)


def measure(name: str, label: str, call: Callable[[], Any], error: Callable[[Any], Any]) -> None:
    """Print a line: the first call, the second, the error."""
    first, _ = timed(call)
    second, result = timed(call)
    worst = float(np.max(error(result)))
    print(f"{name:22s} {label:20s} {first:8.4f} {second:8.4f}  error {worst:.1e}", flush=True)


def peers(name: str, system: Any, speed: float) -> None:
    """Print the lines of the peers."""
    series = shortened(equation(system, speed, forced=False))
    exact = el.monodromy(system, speed, rtol=1e-12).scaled
    ends, solvers = np.array([0.0, series.period]), {}

    def error(matrix: Any) -> float:
        return float(np.max(np.abs(matrix - exact)) / np.max(np.abs(exact)))

    def call(by: Any) -> Any:
        if by not in solvers:
            solvers[by] = by(series, 1e-9)
        return solvers[by](np.eye(series.states), ends)[-1]

    measure(name, "SciPy, DOP853", lambda: call(by_scipy), error)
    if system.is_constant("M"):
        measure(name, "heyoka", lambda: call(by_heyoka), error)


def main() -> None:
    """Print the table."""
    one_thread()
    warnings.simplefilter("ignore")
    for scene_name, (scene, changes, speed) in SCENES.items():
        if sys.argv[1:] and not any(word in scene_name for word in sys.argv[1:]):
            continue
        plain = el.load_scene(scene, overrides=changes).system()
        for ratio in RATIOS:
            system, name = damped(plain, ratio), f"{scene_name}, {100 * ratio:g} %"
            calls: dict[str, Callable[[Any, float], Any]] = {
                "floquet_multipliers": lambda s, w: el.floquet_multipliers(s, w, rtol=1e-8),
                "monodromy": lambda s, w: el.monodromy(s, w, rtol=1e-8),
                "steady_state": lambda s, w: el.steady_state(s, w, rtol=1e-6),
                "simulate": lambda s, w: el.simulate(s, w, 2.0),
            }
            for label, call in calls.items():
                measure(name, label, lambda f=call, s=system, w=speed: f(s, w), lambda r: r.error)
            if not ratio:
                peers(name, system, speed)


if __name__ == "__main__":
    main()
