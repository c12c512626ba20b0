"""A response curve beside shooting with SciPy's DOP853, at equal error.

    python tests/benchmarks/response.py

Smith's (10,1,10,4) rig with an inextensible coupler, through both folds of its half-speed
resonance.  The curve comes with its folds, multipliers and errors; shooting is given states of the
curve to begin with and does one correction at some of them, with the equations of the variation
for the multipliers: its time is scaled to as many points as the curve has.  The error of either is
the distance of its multipliers from those on more steps, relative to the largest.
"""

import time

import elastolink as el
import numpy as np
from elastolink.runtime.core.families import Drive, Nonlinear
from elastolink.runtime.nonlinear.orbit import STAGES
from peers import one_thread
from scipy.integrate import solve_ivp

RPM = np.pi / 30.0
RANGE = (340.0 * RPM, 370.0 * RPM)
DECREMENT = 0.2
SHOT = 2  # points at which the peer shoots
RTOL = 1e-8  # of the peer


def system_of(modes: int) -> Nonlinear:
    """Return the rig with so many modes of its coupler, by its measured decrement."""
    changes = {"model.formulation": "inextensible", "model.modes": modes}
    system = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    numbers = system.parameters
    mass, stiffness = numbers["mass_per_length"], numbers["bending_stiffness"]
    own = (np.pi / numbers["coupler"]) ** 2 * np.sqrt(stiffness / mass)
    return system.with_parameters(damping=DECREMENT * mass * own / np.pi)


def turned(system: Nonlinear, speed: float, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the state ``(q, dq/dtheta)`` after a turn, and its derivative by the first."""
    n = system.size

    def rates(theta: float, y: np.ndarray) -> np.ndarray:
        q, v, varied = y[:n], y[n : 2 * n], y[2 * n :].reshape(2 * n, 2 * n)
        drive = Drive(theta, speed)
        left = system.equations(q, speed * v, np.zeros(n), drive, system.parameters)
        both = np.column_stack([left.residual, left.stiffness, speed * left.damping])
        solved = -np.linalg.solve(left.mass, both) / speed**2
        # The stiffness at no acceleration lacks what the mass matrix adds: by differences.
        found = system.equations(q, speed * v, speed**2 * solved[:, 0], drive, system.parameters)
        by_state = -np.linalg.solve(left.mass, found.stiffness) / speed**2
        down = by_state @ varied[:n] + solved[:, n + 1 :] @ varied[n:]
        return np.concatenate([v, solved[:, 0], varied[n:].ravel(), down.ravel()])

    begun = np.concatenate([state, np.eye(2 * n).ravel()])
    solved = solve_ivp(
        rates, (0.0, 2.0 * np.pi), begun, method="DOP853", rtol=RTOL, atol=1e-3 * RTOL
    )
    end = solved.y[:, -1]
    return end[: 2 * n], end[2 * n :].reshape(2 * n, 2 * n)


def off(values: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest distance of multipliers from the exact ones, relative."""
    gaps = [np.min(np.abs(exact - value)) for value in values]
    return float(np.max(gaps) / np.max(np.abs(exact)))


def main() -> None:
    """Print a table."""
    one_thread()
    for modes in (1, 3):
        system = system_of(modes)
        el.response_curve(system, "speed", (RANGE[0], 1.01 * RANGE[0]))  # modules loaded
        start = time.process_time()
        curve = el.response_curve(system, "speed", RANGE)
        ours = time.process_time() - start
        solver, errors, theirs, seconds = curve.source, [], [], 0.0
        for i in np.linspace(1, len(curve.orbits) - 2, SHOT).astype(int):
            orbit = curve.orbits[i]
            fine = orbit.motion.resampled(2 * len(orbit.motion.x), STAGES)
            exact = solver.corrected(orbit.value, fine, orbit.tangent)[0].multipliers
            errors.append(off(orbit.multipliers, exact))
            start = time.process_time()
            state = orbit.motion.states[0]
            end, matrix = turned(system, orbit.value, state)
            np.linalg.solve(np.eye(len(state)) - matrix, end - state)
            seconds += time.process_time() - start
            theirs.append(off(np.linalg.eigvals(matrix), exact))
        points = len(curve.orbits)
        print(
            f"{modes} modes, {points} points, special {', '.join(curve.special)}: {ours:.2f} s, "
            f"multipliers off by {max(errors):.1e}; shooting: {seconds * points / SHOT:.1f} s, "
            f"off by {max(theirs):.1e}; ratio {seconds * points / SHOT / ours:.0f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
