"""The constrained problem: a flexible rod in a floating frame, from its undeformed state."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from importlib.util import find_spec
from typing import Any, cast

import numpy as np

from ...constrained import constrained_motion
from ...core.families import Constrained
from .equation import Array
from .exudyn_peer import Slope, integrated
from .method import Method, Problem, Work, patient
from .peers import TOLERANCES

NAME = "constrained-trajectory"
METHODS = ("collocation", "projection")
_EACH = 32
_RTOL = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
_TIGHT = 1e-14
# What the references in doubles may differ by at the least.
_DIGITS = 1e-13
# Peers with their settings, and the packages that they need.
_STEPS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
_PEERS = {
    "solve_ivp DOP853": (TOLERANCES, "scipy"),
    "solve_ivp Radau": (TOLERANCES, "scipy"),
    "CVODE": (TOLERANCES, "sksundae"),
    "Exudyn": (_STEPS, "exudyn"),
}


def problem(peers: Iterable[str], methods: Iterable[str] | None) -> Problem:
    """Return the problem of a revolution of the constrained rod.

    The reference is a run of collocation; its digits are those that it shares with one of explicit
    projected steps, both at 1e-14.  Peers get the accelerations of the emitted functions.
    """
    from ...scenes import load_scene
    from ...systems.rod import FreeFreeRod

    overrides = {"model.formulation": "free_free", "model.modes": 2}
    rod = cast(FreeFreeRod, load_scene("beale_1992_flexible_rod", overrides=overrides).system())
    start = rod.undeformed(0.0)
    times = np.linspace(0.0, 2.0 * np.pi / abs(rod.speed), _EACH + 1, dtype=np.float64)
    march = partial(constrained_motion, rod, samples=_EACH, guards=())
    truth = march(method="collocation", rtol=_TIGHT).q
    again = march(method="projection", rtol=_TIGHT).q
    size = np.max(np.abs(truth), axis=0)
    size = np.maximum(size, 1e-3 * np.max(size))

    def error(found: Any) -> float:
        q = found.q if hasattr(found, "q") else found
        return float(np.max(np.abs(q - truth) / size)) if q.shape == truth.shape else float("inf")

    def ours(method: str, rtol: float) -> Work:
        return partial(march, method=method, rtol=rtol)

    made = [
        Method(f"constrained_motion, {m}", partial(ours, m), _RTOL, ours=True)
        for m in METHODS
        if methods is None or m in set(methods)
    ]

    def theirs(peer: str, tolerance: float) -> Work:
        return lambda: _peer(peer, rod, *start, times, tolerance)

    absent = []
    for peer in peers:
        settings, package = _PEERS.get(peer, ((), ""))
        if not settings:
            absent.append(f"{peer}: needs the equation as a Fourier series")
        elif find_spec(package) is None:
            absent.append(f"{peer}: not installed")
        else:
            made.append(Method(peer, partial(theirs, peer), settings))
    digits = max(_DIGITS, error(again))
    title = "a revolution of the flexible rod of Beale & Scott in a floating frame, two modes"
    return Problem(NAME, title, error, digits, tuple(made), tuple(absent))


def _peer(
    name: str, system: Constrained, q: Array, qd: Array, times: Array, setting: float
) -> Array:
    """Return the coordinates by a general integrator of the accelerations."""
    n = system.size
    slope = patient(_slope(system))
    state = np.concatenate([q, qd])
    if name == "Exudyn":
        return integrated(slope, state, times, int(setting))[:, :n]
    speeds = np.abs(qd) + np.max(np.abs(q)) / times[-1]
    absolute = 1e-2 * setting * np.concatenate([np.maximum(np.abs(q), 1e-3), speeds])
    if name == "CVODE":
        return _sundials(slope, state, times, (setting, absolute))[:, :n]
    from scipy.integrate import solve_ivp

    scheme: Any = name.rpartition(" ")[2]
    found = solve_ivp(
        slope,
        (times[0], times[-1]),
        state,
        method=scheme,
        t_eval=times,
        rtol=max(setting, 3e-14),
        atol=absolute,
    )
    return np.asarray(found.y.T[:, :n])


def _sundials(slope: Slope, state: Array, times: Array, tolerances: tuple[float, Array]) -> Array:
    from sksundae.cvode import CVODE

    def into(t: float, state: Array, out: Array) -> None:
        out[:] = slope(t, state)

    rtol, atol = max(tolerances[0], 1e-15), tolerances[1]
    solver = CVODE(into, method="Adams", rtol=rtol, atol=atol, max_num_steps=10**7)
    return np.asarray(solver.solve(times, state).y)


def _slope(system: Constrained) -> Slope:
    """Return the function from time and state (q, qd) to its rate."""
    n = system.size

    def slope(t: float, state: Array) -> Array:
        at = system.dynamics(state[:n], state[n:], t)
        k = len(at["jacobian"])
        matrix = np.zeros((n + k, n + k))
        matrix[:n, :n], matrix[:n, n:] = at["mass"], -at["jacobian"].T
        matrix[n:, :n] = at["jacobian"]
        right = np.concatenate([at["forces"] - at["rest"], at["gamma"]])[:, 0]
        return np.concatenate([state[n:], np.linalg.solve(matrix, right)[:n]])

    return slope
