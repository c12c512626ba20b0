"""One plain call each, unprepared, of systems from one to 27 freedoms, beside SciPy's DOP853.

    python tests/benchmarks/calls.py

Times are processor seconds of the first call and of the second, with the error that the call
reports.  SciPy integrates the same canonical equation for the monodromy matrix at rtol 1e-9; its
error is the difference to the engine's matrix at 1e-12, over the largest entry.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import Any

import elastolink as el
import numpy as np
from elastolink.runtime.periodic.equation import equation_of
from scipy.integrate import solve_ivp

SCENES: dict[str, tuple[str, dict[str, object], float]] = {
    "Smith, 1 mode": ("smith_1972_5152_sixteenth_inch", {}, 45.0),
    "Smith, 3 modes": ("smith_1972_5152_sixteenth_inch", {"model.modes": 3}, 45.0),
    "Beale's rod": ("beale_1992_flexible_rod", {}, 100.0),
    "four-bar, 9": ("aannaque_1996_table_4_1", {"mesh.elements": 1}, 30.0),
    "four-bar, 27": ("aannaque_1996_table_4_1", {}, 30.0),
}


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return processor seconds and the result."""
    start = time.process_time()
    result = call()
    return time.process_time() - start, result


def by_scipy(system: Any, speed: float) -> Any:
    """Return the scaled monodromy matrix by DOP853."""
    equation = equation_of(system, speed, {})
    m = 2 * equation.size

    def rate(theta: float, x: Any) -> Any:
        return (equation.generator(np.array([theta]))[0, 0] @ x.reshape(m, m)).ravel()

    ends = (0.0, equation.period)
    done = solve_ivp(rate, ends, np.eye(m).ravel(), method="DOP853", rtol=1e-9, atol=1e-12)
    return done.y[:, -1].reshape(m, m)


def main() -> None:
    """Print the table."""
    warnings.simplefilter("ignore")
    for name, (scene, changes, speed) in SCENES.items():
        system = el.load_scene(scene, overrides=changes).system()
        calls: dict[str, Callable[[], Any]] = {
            "floquet_multipliers": lambda s=system, w=speed: el.floquet_multipliers(
                s, w, rtol=1e-8
            ),
            "monodromy": lambda s=system, w=speed: el.monodromy(s, w, rtol=1e-8),
            "steady_state": lambda s=system, w=speed: el.steady_state(s, w, rtol=1e-6),
            "simulate": lambda s=system, w=speed: el.simulate(s, w, 2.0),
        }
        for label, call in calls.items():
            first, _ = timed(call)
            second, result = timed(call)
            error = float(np.max(result.error))
            print(
                f"{name:15s} {label:20s} {first:8.4f} {second:8.4f}  error {error:.1e}", flush=True
            )
        spent, matrix = timed(lambda s=system, w=speed: by_scipy(s, w))
        exact = el.monodromy(system, speed, rtol=1e-12)
        gap = np.max(np.abs(matrix - exact.scaled)) / np.max(np.abs(exact.scaled))
        print(f"{name:15s} {'SciPy, DOP853':20s} {spent:8.4f} {'':8s}  error {gap:.1e}", flush=True)


if __name__ == "__main__":
    main()
